//! Figures 8 and 9: how cycles from rest come to repeat one another.

use std::sync::atomic::AtomicBool;

use super::by_engine::{By, simulate};
use super::claim::Value;
use super::cycles::{Cycles, FromRest};
use super::look::{Member, SPRINGS, cells_label, spread};
use super::number::{datum, optional_datum, short};
use super::{Claim, Figure, Measure, Plans, ReproductionError, Scale, Stated};
use crate::report::chart::{Axis, Chart, LegendPlace, LineStyle, Marker, Series};
use crate::report::table::Table;
use crate::sweep::history::{HistoryRow, SimulationOutcome};
use crate::sweep::plan::scenario::{ScenarioPlan, resolved_text};

/// A history by both engines.
#[derive(Clone)]
struct History {
    springs: SimulationOutcome,
    cells: SimulationOutcome,
    side: usize,
}

fn history(plan: &ScenarioPlan, interrupt: &AtomicBool) -> Result<History, ReproductionError> {
    Ok(History {
        springs: simulate(plan, By::Springs, interrupt)?,
        cells: simulate(plan, By::Cells, interrupt)?,
        side: plan.solver.cells,
    })
}

/// Both figures.
pub(super) fn figures(
    plans: &Plans,
    cycles: &Cycles,
    interrupt: &AtomicBool,
) -> Result<Vec<Figure>, ReproductionError> {
    let slow = history(plans.scenario("figure-08-a")?, interrupt)?;
    let (fast_plan, ninth) = (plans.scenario("figure-08-b")?, plans.scenario("figure-09")?);
    let fast = history(fast_plan, interrupt)?;
    let last = if resolved_text(fast_plan) == resolved_text(ninth) {
        fast.clone()
    } else {
        history(ninth, interrupt)?
    };
    Ok(vec![
        figure_8(&slow, &fast, cycles)?,
        figure_9(&last, cycles)?,
    ])
}

fn figure_8(slow: &History, fast: &History, cycles: &Cycles) -> Result<Figure, ReproductionError> {
    let scale = &cycles.scale;
    let mut table = Table::new(
        "figure-08.csv",
        &["f", "source", "time_tau", "approach_delta_h", "load_w0"],
    )?;
    let mut panels = Vec::new();
    for (f, part, history) in [("0.1", 'a', slow), ("1", 'b', fast)] {
        let loop_of = |outcome: &SimulationOutcome, count: usize| -> Vec<(f64, [f64; 2])> {
            let rows: Vec<_> = outcome.rows.iter().collect();
            let rows = spread(&rows, count).into_iter();
            rows.filter_map(|row| {
                let approach = row.approach_m? / scale.approach_m;
                Some((row.time_s, [approach, row.load_n / scale.load_n]))
            })
            .collect()
        };
        // 64 points per cycle as a line, 16 as symbols.
        let cycles_shown = history.cells.rows.len() / super::cycles::STEPS_ON_CELLS;
        let springs = loop_of(&history.springs, 64 * cycles_shown + 1);
        let cells = loop_of(&history.cells, 16 * cycles_shown + 1);
        for (source, points) in [("axisymmetric", &springs), ("half-space", &cells)] {
            for (time, [approach, load]) in points {
                let [time, approach, load] = [*time, *approach, *load].map(datum);
                table.row(&[f.to_owned(), source.to_owned(), time, approach, load])?;
            }
        }
        let points = |points: &[(f64, [f64; 2])]| -> Vec<(f64, f64)> {
            points.iter().map(|(_, [d, w])| (*d, *w)).collect()
        };
        let member = Member { step: 0, of: 3 };
        let seen = Member { step: 1, of: 3 };
        panels.push(
            Chart::new(
                Axis::linear("approach δ / Hertz approach").range(0.0, 1.6),
                Axis::linear(format!("({part}) load W / W₀, f = {f}")).range(0.0, 1.0),
            )
            .series(member.line(points(&springs)).label(SPRINGS))
            .series(seen.cells(points(&cells)).label(cells_label(history.side)))
            .legend(LegendPlace::TopLeft)
            .size(800, 480),
        );
    }
    Ok(Figure {
        number: 8,
        caption: "Load against approach on a Zener half-space from rest; (a) f = 0.1, four cycles, (b) f = 1, eight cycles."
            .to_owned(),
        panels,
        data: table.finish()?,
        claims: cycle_claims(cycles),
        statements: Vec::new(),
    })
}

fn cycle_claims(cycles: &Cycles) -> Vec<Claim> {
    let mut claims = Vec::new();
    for from_rest in &cycles.from_rest {
        for (part, percent) in [(0.01, "1 %"), (0.001, "0.1 %")] {
            let count = |losses: &[f64]| FromRest::cycles_to(losses, part);
            claims.push(Claim {
                figure: 8,
                quantity: format!(
                    "cycles until the approach is nowhere {percent} of its largest from the stabilised loop, f = {}",
                    short(from_rest.f)
                ),
                exact: Value::Count(count(&from_rest.refined)),
                axisymmetric: count(&from_rest.springs),
                half_space: count(&from_rest.cells),
                measure: Measure::absolute("cycles", 0.0, 0.0),
                stated: Stated::default(),
                note: format!(
                    "half-space engine on {0} × {0} cells, {1} steps per cycle",
                    cycles.cells_from_rest,
                    super::cycles::STEPS_ON_CELLS
                ),
            });
        }
    }
    claims
}

type Signal = fn(&HistoryRow, &Scale) -> Option<f64>;

const SIGNALS: [(&str, &str, Signal); 4] = [
    ("load / W₀", "load_w0", |row, scale| {
        Some(row.load_n / scale.load_n)
    }),
    (
        "approach / Hertz approach",
        "approach_delta_h",
        |row, scale| Some(row.approach_m? / scale.approach_m),
    ),
    (
        "contact radius / Hertz radius",
        "contact_radius_a_h",
        |row, scale| Some(row.contact_radius_m / scale.contact_radius_m),
    ),
    (
        "peak pressure / Hertz peak pressure",
        "peak_pressure_p_h",
        |row, scale| Some(row.peak_pressure_pa? / scale.pressure_pa),
    ),
];

fn figure_9(history: &History, cycles: &Cycles) -> Result<Figure, ReproductionError> {
    let scale = &cycles.scale;
    let shown = |outcome: &SimulationOutcome, count: usize| -> Vec<HistoryRow> {
        let rows: Vec<HistoryRow> = outcome
            .rows
            .iter()
            .filter(|row| row.time_s > 6.0 - 1e-9)
            .copied()
            .collect();
        spread(&rows, count)
    };
    let (springs, cells) = (shown(&history.springs, 257), shown(&history.cells, 33));
    let mut columns = vec!["source", "time_tau"];
    columns.extend(SIGNALS.map(|(_, column, _)| column));
    let mut table = Table::new("figure-09.csv", &columns)?;
    for (source, rows) in [("axisymmetric", &springs), ("half-space", &cells)] {
        for row in rows {
            let mut line = vec![source.to_owned(), datum(row.time_s)];
            line.extend(SIGNALS.map(|(_, _, signal)| optional_datum(signal(row, scale))));
            table.row(&line)?;
        }
    }
    let mut chart = Chart::new(
        Axis::linear("time t / τ").range(6.0, 8.0),
        Axis::linear("contact parameters, normalised").range(0.0, 1.4),
    )
    .legend(LegendPlace::Above);
    for (step, (name, _, signal)) in SIGNALS.into_iter().enumerate() {
        let points = |rows: &[HistoryRow]| -> Vec<Option<(f64, f64)>> {
            let rows = rows.iter();
            rows.map(|row| Some((row.time_s, signal(row, scale)?)))
                .collect()
        };
        chart = chart
            .series(
                Series::line(points(&springs))
                    .color(step)
                    .style(LineStyle::nth(step))
                    .label(name),
            )
            .series(
                Series::scatter(points(&cells))
                    .color(step)
                    .marker(Marker::nth(step)),
            );
    }
    Ok(Figure {
        number: 9,
        caption: format!(
            "Zener half-space, f = 1, seventh and eighth cycle from rest. Lines: axisymmetric engine. Symbols: half-space engine, \
             {0} × {0} cells. The paper's caption says f = 0.1, with eight cycles in eight τ: that is f = 1.",
            history.side
        ),
        panels: vec![chart],
        data: table.finish()?,
        claims: claims_9(history, cycles)?,
        statements: Vec::new(),
    })
}

fn claims_9(history: &History, cycles: &Cycles) -> Result<Vec<Claim>, ReproductionError> {
    let scale = &cycles.scale;
    let change = |outcome: &SimulationOutcome| {
        let approach = |row: &HistoryRow| row.approach_m.map(|d| d / scale.approach_m);
        let rows = &outcome.rows;
        let per_cycle = (rows.len() - 1) / 8;
        let eighth = rows.iter().skip(7 * per_cycle);
        let seventh = rows.iter().skip(6 * per_cycle);
        let differences = eighth
            .zip(seventh)
            .filter_map(|(b, a)| Some((approach(b)? - approach(a)?).abs()));
        differences.fold(0.0, f64::max)
    };
    let lag = |outcome: &SimulationOutcome| {
        let eighth = outcome
            .rows
            .iter()
            .filter(|row| row.time_s > 7.1 && row.time_s < 7.9);
        let signal: Vec<(f64, f64)> = eighth
            .filter_map(|row| Some((row.time_s, row.approach_m?)))
            .collect();
        // The load has its maximum in the middle of the cycle.
        Some(vertex(&signal)? - 7.5)
    };
    let case = cycles.case(1.0)?;
    let claim = |quantity: &str, exact, springs, cells, measure, note: &str| Claim {
        figure: 9,
        quantity: quantity.to_owned(),
        exact,
        axisymmetric: springs,
        half_space: cells,
        measure,
        stated: Stated::default(),
        note: note.to_owned(),
    };
    let note = format!(
        "arg C*/ω; half-space engine on {0} × {0} cells; what is left of the start after eight cycles counts in both",
        history.side
    );
    Ok(vec![
        claim(
            "approach in the eighth cycle less that in the seventh, largest difference / δ_H",
            Value::Difference,
            Some(change(&history.springs)),
            Some(change(&history.cells)),
            Measure::absolute("of δ_H", 1e-3, 1e-3),
            "",
        ),
        claim(
            "maximum of the approach after that of the load / τ, f = 1",
            Value::ClosedForm(Some(case.closed.lag)),
            lag(&history.springs),
            lag(&history.cells),
            Measure::absolute("of a cycle", 1e-3, 2e-3),
            &note,
        ),
        claim(
            "cycles within eight τ",
            Value::Count(Some(8.0)),
            Some(cycles_within(&history.springs)),
            Some(cycles_within(&history.cells)),
            Measure::absolute("cycles", 0.0, 0.0),
            "f = 1; with f = 0.1 there would be 0.8 cycles",
        ),
    ])
}

/// Maxima of the load in a history.
fn cycles_within(outcome: &SimulationOutcome) -> f64 {
    let maxima = outcome.rows.windows(3).filter(|rows| {
        let [before, here, after] = [rows[0].load_n, rows[1].load_n, rows[2].load_n];
        here > before && here >= after
    });
    maxima.count() as f64
}

/// Where a signal has its maximum: the vertex of the parabola through the largest of equally spaced samples and its
/// neighbours.
fn vertex(signal: &[(f64, f64)]) -> Option<f64> {
    let best = (0..signal.len()).max_by(|&a, &b| signal[a].1.total_cmp(&signal[b].1))?;
    let (time, here) = *signal.get(best)?;
    let (before, after) = (signal.get(best.checked_sub(1)?)?, signal.get(best + 1)?);
    let curvature = before.1 - 2.0 * here + after.1;
    Some(time + 0.25 * (after.0 - before.0) * (before.1 - after.1) / curvature)
}
