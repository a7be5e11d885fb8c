//! Figure 6: the contact radius on a Maxwell half-space under three loads that rise or fall, to and past its extrema.

use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

use super::by_engine::{By, cell_m, simulate};
use super::claim::Value;
use super::look::{Member, spread};
use super::number::datum;
use super::{Claim, Figure, Measure, Plans, ReproductionError, Scale, Verdict, series_of};
use crate::reference::step_load::maxwell_falling_ramp_cubed_radius;
use crate::reference::transient::maxwell_half_sine_cubed_radius;
use crate::report::chart::{Axis, Chart, LegendPlace, Series};
use crate::report::table::Table;

/// (time / tau, contact radius / a_H).
type Signal = Vec<(f64, f64)>;

/// One loading case.
struct Case {
    number: usize,
    file: &'static str,
    law: &'static str,
    /// Time that is 1 on the paper's axis, in tau.
    axis: f64,
    exact: Exact,
    extrema: &'static [Extremum],
}

/// An extremum of the contact radius between two times (tau).
struct Extremum {
    what: &'static str,
    between: [f64; 2],
    is_largest: bool,
    /// Time / tau and radius / a_H where there is a closed form.
    known: Option<(f64, f64)>,
}

enum Exact {
    ClosedForm(fn(f64) -> f64),
    Refined,
}

const CASES: [Case; 3] = [
    Case {
        number: 1,
        file: "figure-06-case-1",
        law: "W = W₀ (1 − t/2τ)",
        axis: 2.0,
        exact: Exact::ClosedForm(|s| maxwell_falling_ramp_cubed_radius(s).cbrt()),
        extrema: &[Extremum {
            what: "largest",
            between: [0.5, 1.5],
            is_largest: true,
            // (5/4)^(1/3).
            known: Some((1.0, 1.077217345015942)),
        }],
    },
    Case {
        number: 2,
        file: "figure-06-case-2",
        law: "W = W₀ (1 + (2 − t/τ)³)/9",
        axis: 2.0,
        exact: Exact::Refined,
        extrema: &[
            // The contact still holds what it held at once, relaxed: (a/a_H)^3 = exp(s) W/W0, least where W' + W = 0.
            Extremum {
                what: "smallest (first)",
                between: [0.5, 2.0],
                is_largest: false,
                known: Some((1.3472963553338606, 0.8174817472142365)),
            },
            Extremum {
                what: "largest (second)",
                between: [2.0, 2.9],
                is_largest: true,
                known: None,
            },
        ],
    },
    Case {
        number: 3,
        file: "figure-06-case-3",
        law: "W = W₀ sin(t/τ)",
        axis: PI,
        exact: Exact::ClosedForm(|s| maxwell_half_sine_cubed_radius(s).cbrt()),
        extrema: &[Extremum {
            what: "largest",
            between: [1.5, 3.0],
            is_largest: true,
            // (1 + sqrt 2)^(1/3).
            known: Some((0.75 * PI, 1.3415037626305777)),
        }],
    },
];

/// A case, computed.
struct Computed {
    exact: Signal,
    springs: Signal,
    cells: Signal,
    /// Side of a cell in Hertz radii.
    cell: f64,
}

/// The figure.
pub(super) fn figures(
    plans: &Plans,
    interrupt: &AtomicBool,
) -> Result<Vec<Figure>, ReproductionError> {
    let mut table = Table::new(
        "figure-06.csv",
        &["loading_case", "source", "time_tau", "contact_radius_a_h"],
    )?;
    let (mut series, mut claims) = (Vec::<Series>::new(), Vec::new());
    let mut side = 0;
    for (step, case) in CASES.iter().enumerate() {
        side = plans.scenario(case.file)?.solver.cells;
        let computed = compute(case, plans, interrupt)?;
        let member = Member { step, of: 3 };
        let exact = spread(&computed.exact, 301);
        let springs = spread(&computed.springs, 31);
        for (source, signal) in [
            ("exact", &exact),
            ("axisymmetric", &springs),
            ("half-space", &computed.cells),
        ] {
            for (time, radius) in signal {
                let cells = [datum(*time), datum(*radius)];
                let [time, radius] = cells;
                table.row(&[case.number.to_string(), source.to_owned(), time, radius])?;
            }
        }
        let drawn = |signal: &Signal| signal.iter().map(|(t, a)| (t / case.axis, *a)).collect();
        let label = format!("case {}: {}", case.number, case.law);
        series.push(member.line(drawn(&exact)).label(label));
        series.extend(member.engines(drawn(&springs), drawn(&computed.cells), side));
        claims.extend(case_claims(case, &computed));
    }
    let chart = Chart::new(
        Axis::linear("time t / 2τ (cases 1, 2), t / πτ (case 3)").range(0.0, 1.5),
        Axis::linear("contact radius a / Hertz radius").range(0.0, 1.4),
    )
    .all_series(series)
    .legend(LegendPlace::Above);
    Ok(vec![Figure {
        number: 6,
        caption: format!(
            "Contact radius on a Maxwell half-space. Lines: closed form (cases 1 and 3) and the refined axisymmetric engine \
             (case 2). Symbols: computed, {side} × {side} cells. Case 2 is followed beyond the paper's range, to the end of \
             its load."
        ),
        panels: vec![chart],
        data: table.finish()?,
        claims,
    }])
}

fn compute(
    case: &Case,
    plans: &Plans,
    interrupt: &AtomicBool,
) -> Result<Computed, ReproductionError> {
    let plan = plans.scenario(case.file)?;
    let scale = Scale::new(
        series_of(plan)?,
        plan.indenter.as_ref(),
        plan.drive.maximum(),
    )?;
    let hertz_m = scale.contact_radius_m;
    let signal = |by| -> Result<(Signal, f64), ReproductionError> {
        let outcome = simulate(plan, by, interrupt)?;
        let rows = outcome.rows.iter();
        let signal = rows.map(|row| (row.time_s, row.contact_radius_m / hertz_m));
        Ok((signal.collect(), cell_m(&outcome, plan.solver.cells)))
    };
    let (springs, _) = signal(By::Springs)?;
    let (cells, cell_m) = signal(By::Cells)?;
    let exact = match case.exact {
        Exact::ClosedForm(radius) => springs.iter().map(|(t, _)| (*t, radius(*t))).collect(),
        Exact::Refined => signal(By::RefinedSprings)?.0,
    };
    Ok(Computed {
        exact,
        springs,
        cells,
        cell: cell_m / hertz_m,
    })
}

/// The extremum of a signal: when, from a parabola through samples `reach` apart, and the extreme sample.
fn find(signal: &Signal, extremum: &Extremum, reach: usize) -> Option<(f64, f64)> {
    let sign = if extremum.is_largest { 1.0 } else { -1.0 };
    let [from, to] = extremum.between;
    let (best, _) = signal
        .iter()
        .enumerate()
        .filter(|(_, (t, _))| *t > from && *t < to)
        .max_by(|a, b| (sign * a.1.1).total_cmp(&(sign * b.1.1)))?;
    let (time, value) = *signal.get(best)?;
    let before = signal.get(best.checked_sub(reach)?)?;
    let after = signal.get(best + reach)?;
    let curvature = before.1 - 2.0 * value + after.1;
    let shift = 0.25 * (after.0 - before.0) * (before.1 - after.1) / curvature;
    Some((time + shift, value))
}

fn case_claims(case: &Case, computed: &Computed) -> Vec<Claim> {
    let mut claims: Vec<Claim> = Vec::new();
    for extremum in case.extrema {
        claims.extend(extremum_claims(case, computed, extremum));
    }
    claims.push(Claim {
        figure: 6,
        quantity: format!(
            "case {}: contact radius, largest error at any time",
            case.number
        ),
        paper: PAPER.to_owned(),
        exact: Value::Difference,
        axisymmetric: Some(computed.deviation(&computed.springs)),
        half_space: Some(computed.deviation(&computed.cells)),
        measure: Measure::absolute("of a_H", 2e-3, 0.5 * computed.cell),
        verdict: Verdict::Agrees,
        note: format!("half a cell is {:.4} a_H", 0.5 * computed.cell),
    });
    claims
}

const PAPER: &str = "matches Ting's solution; drawn";

/// The value of an extremum and its time.
fn extremum_claims(case: &Case, computed: &Computed, extremum: &Extremum) -> [Claim; 2] {
    // Radii from springs are smooth to 1e-5: samples a tenth of tau apart. Those of cells are counted.
    let springs = find(&computed.springs, extremum, 10);
    let cells = find(&computed.cells, extremum, 2);
    let [time, value] = match (extremum.known, find(&computed.exact, extremum, 20)) {
        (Some((time, value)), _) => [Some(time), Some(value)].map(Value::ClosedForm),
        (None, found) => [found.map(|f| f.0), found.map(|f| f.1)].map(Value::Refined),
    };
    let radius = Claim {
        figure: 6,
        quantity: format!(
            "case {}: {} contact radius / a_H",
            case.number, extremum.what
        ),
        paper: PAPER.to_owned(),
        exact: value,
        axisymmetric: springs.map(|found| found.1),
        half_space: cells.map(|found| found.1),
        measure: Measure::absolute("of a_H", 5e-4, 0.5 * computed.cell),
        verdict: Verdict::Agrees,
        note: String::new(),
    };
    let when = Claim {
        quantity: format!(
            "case {}: time of the {} contact radius / τ",
            case.number, extremum.what
        ),
        paper: "extrema of radius and load need not coincide".to_owned(),
        exact: time,
        axisymmetric: springs.map(|found| found.0),
        half_space: cells.map(|found| found.0),
        // A flat extremum: within a time step of the half-space engine, a tenth of it for springs.
        measure: Measure::absolute("of τ", 0.01, 0.1),
        ..radius.clone()
    };
    [radius, when]
}

impl Computed {
    /// Largest difference of the contact radius from the exact one.
    fn deviation(&self, signal: &Signal) -> f64 {
        let exact = |t: f64| {
            let near = |e: &&(f64, f64)| (e.0 - t).abs() < 1e-9;
            self.exact.iter().find(near).map(|e| e.1)
        };
        let differences = signal
            .iter()
            .filter_map(|(t, a)| Some((a - exact(*t)?).abs()));
        differences.fold(0.0, f64::max)
    }
}
