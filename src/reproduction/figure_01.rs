//! Figure 1: the relaxation modulus of PMMA, which a flat punch held still reads from its load; and the creep function.

use std::sync::atomic::AtomicBool;

use super::by_engine::{By, simulate};
use super::claim::Value;
use super::look::{Member, SPRINGS, cells_label, evenly, spread};
use super::number::datum;
use super::{Claim, Figure, Measure, Plans, ReproductionError, Stated, series_of};
use crate::material::Material;
use crate::report::chart::{Axis, Chart, LegendPlace};
use crate::report::table::Table;
use crate::sweep::history::SimulationOutcome;

const MEGA: f64 = 1e-6;

/// The figure.
pub(super) fn figures(
    plans: &Plans,
    interrupt: &AtomicBool,
) -> Result<Vec<Figure>, ReproductionError> {
    let plan = plans.scenario("figure-01")?;
    let material = series_of(plan)?;
    let relaxation = material
        .relaxation()
        .ok_or_else(|| ReproductionError::Unfit("PMMA has a relaxation modulus".to_owned()))?;
    let modulus = |time_s: f64| MEGA * relaxation.modulus(time_s);
    let springs = held(&simulate(plan, By::Springs, interrupt)?, modulus(0.0));
    let cells = held(&simulate(plan, By::Cells, interrupt)?, modulus(0.0));

    let line: Vec<(f64, f64)> = evenly(0.0, 1000.0, 200)
        .into_iter()
        .map(|t| (t, modulus(t)))
        .collect();
    let mut table = Table::new(
        "figure-01.csv",
        &["source", "time_s", "relaxation_modulus_mpa"],
    )?;
    let parts = [
        ("closed form", &line),
        ("axisymmetric", &springs),
        ("half-space", &cells),
    ];
    for (source, points) in parts {
        for (time_s, value) in points {
            table.row(&[source.to_owned(), datum(*time_s), datum(*value)])?;
        }
    }
    let member = Member { step: 0, of: 2 };
    let seen = Member { step: 1, of: 2 };
    let chart = Chart::new(
        Axis::linear("time t / s").range(0.0, 1000.0),
        Axis::linear("relaxation modulus Ψ / MPa").range(1900.0, 2500.0),
    )
    .series(member.line(line).label("Prony series, equation (8)"))
    .series(seen.springs(spread(&springs, 60)).label(SPRINGS))
    .series(
        seen.cells(spread(&cells, 34))
            .label(cells_label(plan.solver.cells)),
    )
    .legend(LegendPlace::TopRight);
    Ok(vec![Figure {
        number: 1,
        caption: "Relaxation modulus of PMMA. Line: the Prony series. Symbols: read from the load under a flat punch that is \
                  pressed in at once and held still."
            .to_owned(),
        panels: vec![chart],
        data: table.finish()?,
        claims: claims(material, &modulus, &springs, &cells)?,
        statements: Vec::new(),
    }])
}

/// (time, relaxation modulus in MPa): the load relative to the first, which is that of Psi(0).
fn held(outcome: &SimulationOutcome, first_mpa: f64) -> Vec<(f64, f64)> {
    let first_n = outcome.rows.first().map_or(1.0, |row| row.load_n);
    let rows = outcome.rows.iter();
    rows.map(|row| (row.time_s, first_mpa * row.load_n / first_n))
        .collect()
}

fn claims(
    material: &Material,
    modulus: &dyn Fn(f64) -> f64,
    springs: &[(f64, f64)],
    cells: &[(f64, f64)],
) -> Result<Vec<Claim>, ReproductionError> {
    let last = |points: &[(f64, f64)]| points.last().map(|point| point.1);
    let computed = |quantity: &str, exact: Option<f64>, springs, cells| Claim {
        figure: 1,
        quantity: quantity.to_owned(),
        exact: Value::ClosedForm(exact),
        axisymmetric: springs,
        half_space: cells,
        // Held exactly but for the error of the time steps.
        measure: Measure::relative(exact, 1e-3, 1e-3),
        stated: Stated::default(),
        note: String::new(),
    };
    let mut claims = vec![
        Claim {
            axisymmetric: None,
            half_space: None,
            note: "the scale of the computed loads".to_owned(),
            ..computed("Ψ(0) / MPa", Some(modulus(0.0)), None, None)
        },
        computed(
            "Ψ(1000 s) / MPa",
            Some(modulus(1000.0)),
            last(springs),
            last(cells),
        ),
    ];
    let creep = material.shear_creep_function()?;
    let mut constants = vec![(
        "final compliance / MPa⁻¹".to_owned(),
        creep.equilibrium_compliance(),
    )];
    for (branch, place) in creep.branches().iter().zip(["fast", "slow"]) {
        constants.push((
            format!("{place} term / MPa⁻¹"),
            Some(branch.compliance_per_pa),
        ));
        constants.push((
            format!("{place} rate / s⁻¹"),
            Some(branch.time_s.recip() * MEGA),
        ));
    }
    for (quantity, value) in constants {
        let exact = value.map(|value| value / MEGA);
        claims.push(Claim {
            note: "from Ψ by conversion".to_owned(),
            ..computed(&format!("creep function Φ: {quantity}"), exact, None, None)
        });
    }
    Ok(claims)
}
