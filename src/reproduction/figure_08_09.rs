//! Figures 8 and 9: how cycles from rest come to repeat one another.

use std::sync::atomic::AtomicBool;

use super::by_engine::{ByEngine, both};
use super::curves::{Member, SPRINGS, cells_label, extremum, spread};
use super::cycles::{Cycles, STEPS_ON_CELLS, cycles_to};
use super::number::{Data, short};
use super::{Claim, Figure, Measure, Plans, ReproductionError, Result, Scale, Source};
use crate::report::chart::{Axis, Chart, LegendPlace, LineStyle, Marker, Series};
use crate::report::table::{Cell, cells};
use crate::simulation::scenario::{ScenarioPlan, resolved_text};
use crate::simulation::{HistoryRow, SimulationOutcome};

/// A history on springs and on cells, so many of the latter per side.
#[derive(Clone)]
struct History {
    computed: [SimulationOutcome; 2],
    side: usize,
}

fn history(plan: &ScenarioPlan, interrupt: &AtomicBool) -> Result<History> {
    Ok(History {
        computed: both(plan, interrupt)?,
        side: plan.solver.cells,
    })
}

/// Both figures.
pub(super) fn figures(
    plans: &Plans,
    cycles: &Cycles<'_>,
    interrupt: &AtomicBool,
) -> Result<Vec<Figure>> {
    let slow = history(plans.scenario("figure-08-a")?, interrupt)?;
    let (fast_plan, ninth) = (plans.scenario("figure-08-b")?, plans.scenario("figure-09")?);
    let fast = history(fast_plan, interrupt)?;
    let last = match resolved_text(fast_plan) == resolved_text(ninth) {
        true => fast.clone(),
        false => history(ninth, interrupt)?,
    };
    Ok(vec![
        figure_8(&slow, &fast, cycles)?,
        figure_9(&last, cycles)?,
    ])
}

fn figure_8(slow: &History, fast: &History, cycles: &Cycles<'_>) -> Result<Figure> {
    let scale = &cycles.scale;
    let columns = ["f", "source", "time_tau", "approach_delta_h", "load_w0"];
    let mut data = Data::new(&columns);
    let mut panels = Vec::new();
    for (f, part, history) in [("0.1", 'a', slow), ("1", 'b', fast)] {
        let [by_springs, by_cells] = &history.computed;
        // 64 points per cycle as a line, 16 as symbols.
        let cycles_shown = by_cells.rows.len() / STEPS_ON_CELLS;
        let mut drawn = |outcome: &SimulationOutcome, source: &str, per_cycle: usize| {
            let rows = spread(&outcome.rows, per_cycle * cycles_shown + 1);
            let mut points = Vec::new();
            for row in &rows {
                let Some(approach_m) = row.approach_m else {
                    continue;
                };
                let point = (approach_m / scale.approach_m, row.load_n / scale.load_n);
                data.row(cells![f, source, row.time_s, point.0, point.1]);
                points.push(point);
            }
            Ok::<_, ReproductionError>(points)
        };
        let springs = drawn(by_springs, "axisymmetric", 64)?;
        let cells = drawn(by_cells, "half-space", 16)?;
        let [member, seen] = [0, 1].map(|step| Member { step, of: 3 });
        panels.push(
            Chart::new(
                Axis::linear("approach δ / Hertz approach").range(0.0, 1.6),
                Axis::linear(format!("({part}) load W / W₀, f = {f}")).range(0.0, 1.0),
            )
            .series(member.line(springs).label(SPRINGS))
            .series(
                seen.cells(cells, history.side)
                    .label(cells_label(history.side)),
            )
            .legend(LegendPlace::TopLeft)
            .size(800, 480),
        );
    }
    let caption = "Load against approach on a Zener half-space from rest; (a) f = 0.1, four cycles, (b) f = 1, eight cycles.";
    Ok(Figure::new(8, caption, panels, data, claims_8(cycles)))
}

fn claims_8(cycles: &Cycles<'_>) -> Vec<Claim> {
    let note = format!(
        "half-space engine on {0} × {0} cells, {STEPS_ON_CELLS} steps per cycle",
        cycles.cells_from_rest
    );
    let claim = |f: f64, distances: &ByEngine<Vec<f64>>, (part, percent): (f64, &str)| {
        let quantity = format!(
            "cycles until the approach is nowhere {percent} of its largest from the stabilised loop, f = {}",
            short(f)
        );
        let values = distances.as_ref().map(|d| cycles_to(d, part));
        let measure = Measure::absolute("cycles", 0.0, 0.0);
        Claim::new(quantity, Source::Count, values, measure).note(note.clone())
    };
    let mut claims = Vec::new();
    for (f, distances) in &cycles.from_rest {
        claims.extend([(0.01, "1 %"), (0.001, "0.1 %")].map(|part| claim(*f, distances, part)));
    }
    claims
}

type Signal = fn(&HistoryRow, &Scale) -> Option<f64>;

const SIGNALS: [(&str, Signal); 4] = [
    ("load / W₀", |row, scale| Some(row.load_n / scale.load_n)),
    ("approach / Hertz approach", |row, scale| {
        Some(row.approach_m? / scale.approach_m)
    }),
    ("contact radius / Hertz radius", |row, scale| {
        Some(row.contact_radius_m / scale.contact_radius_m)
    }),
    ("peak pressure / Hertz peak pressure", |row, scale| {
        Some(row.peak_pressure_pa? / scale.pressure_pa)
    }),
];

fn figure_9(history: &History, cycles: &Cycles<'_>) -> Result<Figure> {
    let scale = &cycles.scale;
    let shown = |outcome: &SimulationOutcome, count: usize| -> Vec<HistoryRow> {
        let rows = outcome.rows.iter().copied();
        let rows: Vec<HistoryRow> = rows.filter(|row| row.time_s > 6.0 - 1e-9).collect();
        spread(&rows, count)
    };
    let [by_springs, by_cells] = &history.computed;
    let (springs, cells) = (shown(by_springs, 257), shown(by_cells, 33));
    let mut data = Data::new(&[
        "source",
        "time_tau",
        "load_w0",
        "approach_delta_h",
        "contact_radius_a_h",
        "peak_pressure_p_h",
    ]);
    for (source, rows) in [("axisymmetric", &springs), ("half-space", &cells)] {
        for row in rows {
            let signals = SIGNALS.map(|(_, signal)| Cell::from(signal(row, scale)));
            data.row(cells![source, row.time_s].into_iter().chain(signals));
        }
    }
    let mut chart = Chart::new(
        Axis::linear("time t / τ").range(6.0, 8.0),
        Axis::linear("contact parameters, normalised").range(0.0, 1.4),
    )
    .legend(LegendPlace::Above);
    for (step, (name, signal)) in SIGNALS.into_iter().enumerate() {
        let points = |rows: &[HistoryRow]| -> Vec<Option<(f64, f64)>> {
            let point = |row: &HistoryRow| Some((row.time_s, signal(row, scale)?));
            rows.iter().map(point).collect()
        };
        let line = Series::line(points(&springs)).style(LineStyle::nth(step));
        let symbols = Series::scatter(points(&cells)).marker(Marker::nth(step));
        chart = chart
            .series(line.color(step).label(name))
            .series(symbols.color(step));
    }
    let caption = format!(
        "Zener half-space, f = 1, seventh and eighth cycle from rest. Lines: axisymmetric engine. Symbols: half-space engine, \
         {0} × {0} cells. The paper's caption says f = 0.1, with eight cycles in eight τ: that is f = 1.",
        history.side
    );
    let claims = claims_9(history, cycles)?;
    Ok(Figure::new(9, caption, vec![chart], data, claims))
}

fn claims_9(history: &History, cycles: &Cycles<'_>) -> Result<Vec<Claim>> {
    let change = |outcome: &SimulationOutcome| {
        let approach = |row: &HistoryRow| row.approach_m.map(|d| d / cycles.scale.approach_m);
        let rows = &outcome.rows;
        let per_cycle = (rows.len() - 1) / 8;
        let [eighth, seventh] = [7, 6].map(|cycle| rows.iter().skip(cycle * per_cycle));
        let differences = eighth
            .zip(seventh)
            .filter_map(|(b, a)| Some((approach(b)? - approach(a)?).abs()));
        Some(differences.fold(0.0, f64::max))
    };
    let lag = |outcome: &SimulationOutcome| {
        let rows = outcome.rows.iter();
        let signal = rows.filter_map(|row| Some((row.time_s, row.approach_m?)));
        let signal: Vec<(f64, f64)> = signal.collect();
        let (time, _) = extremum(&signal, |time| time > 7.1 && time < 7.9, true, 1)?;
        // The load has its maximum in the middle of the cycle.
        Some(time - 7.5)
    };
    let maxima_of_load = |outcome: &SimulationOutcome| {
        let maxima = outcome.rows.windows(3).filter(|rows| {
            let [before, here, after] = [0, 1, 2].map(|k| rows[k].load_n);
            here > before && here >= after
        });
        Some(maxima.count() as f64)
    };
    let computed =
        |read: &dyn Fn(&SimulationOutcome) -> Option<f64>| history.computed.each_ref().map(read);
    let closed_lag = Some(cycles.case(1.0)?.closed.lag);
    Ok(vec![
        Claim::difference(
            "approach in the eighth cycle less that in the seventh, largest difference / δ_H",
            computed(&change),
            Measure::absolute("of δ_H", 1e-3, 1e-3),
        ),
        Claim::new(
            "maximum of the approach after that of the load / τ, f = 1",
            Source::ClosedForm,
            ByEngine::of(closed_lag, computed(&lag)),
            Measure::absolute("of a cycle", 1e-3, 2e-3),
        )
        .note(format!(
            "arg C*/ω; half-space engine on {0} × {0} cells; what is left of the start after eight cycles counts in both",
            history.side
        )),
        Claim::new(
            "cycles within eight τ",
            Source::Count,
            ByEngine::of(Some(8.0), computed(&maxima_of_load)),
            Measure::absolute("cycles", 0.0, 0.0),
        )
        .note("f = 1; with f = 0.1 there would be 0.8 cycles"),
    ])
}
