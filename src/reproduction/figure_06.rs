//! Figure 6: the contact radius on a Maxwell half-space under three loads that rise or fall, to and past its extrema.

use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

use super::by_engine::{By, ByEngine, simulate};
use super::curves::{Member, extremum, spread};
use super::number::Data;
use super::{Claim, Figure, Measure, Plans, Result, Scale, Source, series_of};
use crate::reference::step_load::maxwell_falling_ramp_cubed_radius;
use crate::reference::transient::maxwell_half_sine_cubed_radius;
use crate::report::chart::{Axis, Chart, LegendPlace};
use crate::report::table::cells;

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
    signals: ByEngine<Signal>,
    /// Cells per side, and the side of one in Hertz radii.
    cells: usize,
    cell: f64,
}

/// The figure.
pub(super) fn figures(plans: &Plans, interrupt: &AtomicBool) -> Result<Vec<Figure>> {
    let mut data = Data::new(&["loading_case", "source", "time_tau", "contact_radius_a_h"]);
    let mut claims = Vec::new();
    let mut chart = Chart::new(
        Axis::linear("time t / 2τ (cases 1, 2), t / πτ (case 3)").range(0.0, 1.5),
        Axis::linear("contact radius a / Hertz radius").range(0.0, 1.4),
    )
    .legend(LegendPlace::Above);
    let mut side = 0;
    for (step, case) in CASES.iter().enumerate() {
        let computed = compute(case, plans, interrupt)?;
        side = computed.cells;
        let signals = &computed.signals;
        let exact = spread(&signals.exact, 301);
        let springs = spread(&signals.axisymmetric, 31);
        let number = case.number;
        data.points(&cells![number, "exact"], &exact);
        data.points(&cells![number, "axisymmetric"], &springs);
        data.points(&cells![number, "half-space"], &signals.half_space);
        let member = Member { step, of: 3 };
        let drawn = |signal: &Signal| signal.iter().map(|(t, a)| (t / case.axis, *a)).collect();
        let label = format!("case {number}: {}", case.law);
        let (springs, cells) = (drawn(&springs), drawn(&signals.half_space));
        chart = chart
            .series(member.line(drawn(&exact)).label(label))
            .series(member.springs(springs))
            .series(member.cells(cells, side));
        for extremum in case.extrema {
            claims.extend(extremum_claims(case, &computed, extremum));
        }
        claims.push(deviation_claim(case, &computed));
    }
    let caption = format!(
        "Contact radius on a Maxwell half-space. Lines: closed form (cases 1 and 3) and the refined axisymmetric engine \
         (case 2). Symbols: computed, {side} × {side} cells. Case 2 is followed beyond the paper's range, to the end of \
         its load."
    );
    Ok(vec![Figure::new(6, caption, vec![chart], data, claims)])
}

fn compute(case: &Case, plans: &Plans, interrupt: &AtomicBool) -> Result<Computed> {
    let plan = plans.scenario(case.file)?;
    let load_n = plan.drive.maximum();
    let scale = Scale::new(series_of(plan)?, plan.contact.indenter.as_ref(), load_n)?;
    let hertz_m = scale.contact_radius_m;
    let signal = |by| -> Result<(Signal, f64)> {
        let outcome = simulate(plan, by, interrupt)?;
        let rows = outcome.rows.iter();
        let signal = rows.map(|row| (row.time_s, row.contact_radius_m / hertz_m));
        Ok((signal.collect(), outcome.domain_half_width_m))
    };
    let (springs, _) = signal(By::Springs)?;
    let (on_cells, half_width_m) = signal(By::Cells)?;
    let exact = match case.exact {
        Exact::ClosedForm(radius) => springs.iter().map(|(t, _)| (*t, radius(*t))).collect(),
        Exact::Refined => signal(By::RefinedSprings)?.0,
    };
    let cells = plan.solver.cells;
    Ok(Computed {
        signals: ByEngine::of(exact, [springs, on_cells]),
        cells,
        cell: 2.0 * half_width_m / cells as f64 / hertz_m,
    })
}

/// The value of an extremum and its time.
fn extremum_claims(case: &Case, computed: &Computed, wanted: &Extremum) -> [Claim; 2] {
    // Radii from springs are smooth to 1e-5: samples a tenth of tau apart. Those of cells are counted.
    let reach = ByEngine::of(20, [10, 2]);
    let mut found = computed.signals.as_ref().zip(reach).map(|(signal, reach)| {
        let [from, to] = wanted.between;
        extremum(signal, |t| t > from && t < to, wanted.is_largest, reach)
    });
    let source = match wanted.known {
        Some(_) => Source::ClosedForm,
        None => Source::Refined,
    };
    found.exact = wanted.known.or(found.exact);
    let (number, what) = (case.number, wanted.what);
    let radius = Claim::new(
        format!("case {number}: {what} contact radius / a_H"),
        source,
        found.map(|found| found.map(|(_, radius)| radius)),
        Measure::absolute("of a_H", 5e-4, 0.5 * computed.cell),
    );
    let when = Claim::new(
        format!("case {number}: time of the {what} contact radius / τ"),
        source,
        found.map(|found| found.map(|(time, _)| time)),
        // A flat extremum: within a time step of the half-space engine, a tenth of it for springs.
        Measure::absolute("of τ", 0.01, 0.1),
    );
    [radius, when]
}

/// Largest difference of the contact radius from the exact one at the same time.
fn deviation_claim(case: &Case, computed: &Computed) -> Claim {
    let signals = &computed.signals;
    let deviations = [&signals.axisymmetric, &signals.half_space].map(|signal| {
        let differences = signal.iter().filter_map(|(t, a)| {
            let exact = signals.exact.iter().find(|e| (e.0 - t).abs() < 1e-9)?;
            Some((a - exact.1).abs())
        });
        Some(differences.fold(0.0, f64::max))
    });
    let half_a_cell = 0.5 * computed.cell;
    let quantity = format!(
        "case {}: contact radius, largest error at any time",
        case.number
    );
    let measure = Measure::absolute("of a_H", 2e-3, half_a_cell);
    Claim::difference(quantity, deviations, measure)
        .note(format!("half a cell is {half_a_cell:.4} a_H"))
}
