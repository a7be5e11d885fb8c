//! Figure 1: the relaxation modulus of PMMA, which a flat punch held still reads from its load; and the creep function.

use std::sync::atomic::AtomicBool;

use super::by_engine::both;
use super::curves::{Member, curve, spread};
use super::number::Data;
use super::{
    ByEngine, Claim, Figure, Measure, Plans, ReproductionError, Result, Source, series_of,
};
use crate::material::Creep;
use crate::report::chart::{Axis, Chart, LegendPlace};
use crate::report::table::cells;

const MEGA: f64 = 1e-6;

/// The figure.
pub(super) fn figures(plans: &Plans, interrupt: &AtomicBool) -> Result<Vec<Figure>> {
    let plan = plans.scenario("figure-01")?;
    let material = series_of(plan)?;
    let relaxation = material
        .relaxation()
        .ok_or_else(|| ReproductionError::Unfit("PMMA has a relaxation modulus".to_owned()))?;
    let modulus_mpa = |time_s: f64| MEGA * relaxation.modulus(time_s);
    // The load relative to the first, which is that of Psi(0).
    let [springs, cells] = both(plan, interrupt)?.map(|outcome| -> Vec<(f64, f64)> {
        let first_n = outcome.rows.first().map_or(1.0, |row| row.load_n);
        let held = |load_n| modulus_mpa(0.0) * load_n / first_n;
        let rows = outcome.rows.iter();
        rows.map(|row| (row.time_s, held(row.load_n))).collect()
    });
    let line = curve(0.0, 1000.0, 200, modulus_mpa);
    let mut data = Data::new(&["source", "time_s", "relaxation_modulus_mpa"]);
    data.points(&cells!["closed form"], &line);
    data.points(&cells!["axisymmetric"], &springs);
    data.points(&cells!["half-space"], &cells);
    let last = [&springs, &cells].map(|points| points.last().map(|point| point.1));
    let values = [0.0, 1000.0].map(modulus_mpa);
    let claims = claims(values, last, &material.shear_creep_function()?);

    let [member, seen] = [0, 1].map(|step| Member { step, of: 2 });
    let chart = Chart::new(
        Axis::linear("time t / s").range(0.0, 1000.0),
        Axis::linear("relaxation modulus Ψ / MPa").range(1900.0, 2500.0),
    )
    .series(member.line(line).label("Prony series, equation (8)"))
    .series(seen.springs(spread(&springs, 60)))
    .series(seen.cells(spread(&cells, 34), plan.solver.cells))
    .legend(LegendPlace::TopRight);
    let caption = "Relaxation modulus of PMMA. Line: the Prony series. Symbols: read from the load under a flat punch that is \
                   pressed in at once and held still.";
    Ok(vec![Figure::new(1, caption, vec![chart], data, claims)])
}

/// The modulus (MPa) at 0 and 1000 s, what both engines read of the latter, and the constants of the creep function.
fn claims([first, last]: [f64; 2], computed: [Option<f64>; 2], creep: &Creep) -> Vec<Claim> {
    let claim = |quantity: String, exact, computed| {
        // Held exactly but for the error of the time steps.
        let measure = Measure::relative(1e-3, 1e-3);
        let values = ByEngine::of(exact, computed);
        Claim::new(quantity, Source::ClosedForm, values, measure)
    };
    let constant = |quantity: &str, exact: Option<f64>| {
        let quantity = format!("creep function Φ: {quantity}");
        claim(quantity, exact, [None, None]).note("from Ψ by conversion")
    };
    let per_mpa = |per_pa: f64| Some(per_pa / MEGA);
    let mut claims = vec![
        claim("Ψ(0) / MPa".to_owned(), Some(first), [None, None])
            .note("the scale of the computed loads"),
        claim("Ψ(1000 s) / MPa".to_owned(), Some(last), computed),
        constant(
            "final compliance / MPa⁻¹",
            creep.equilibrium_compliance().and_then(per_mpa),
        ),
    ];
    for (branch, place) in creep.branches().iter().zip(["fast", "slow"]) {
        let [term, rate] = [
            per_mpa(branch.compliance_per_pa),
            Some(branch.time_s.recip()),
        ];
        claims.push(constant(&format!("{place} term / MPa⁻¹"), term));
        claims.push(constant(&format!("{place} rate / s⁻¹"), rate));
    }
    claims
}
