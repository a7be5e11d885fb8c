//! `summary.json` of force curves.

use serde_json::{Map, Value, json};

use super::{CurvesReport, Found};
use crate::force_curve::{Estimate, FittedLaw};
use crate::material::law::Law;
use crate::report::identify::tables::{MODULI, with_ends};

/// The summary as an object; what is undefined is null.
pub fn summary(report: &CurvesReport<'_>) -> Value {
    let mut summary = match report.single() {
        Some(found) => of_curve(found),
        None => {
            let curves = report.curves().iter().map(|(curve, found)| match found {
                Ok(found) => Value::Object(of_curve(found)),
                Err(error) => {
                    json!({ "curve": curve.name, "status": "failed", "message": error.to_string() })
                }
            });
            let mut all = Map::new();
            all.insert("curves".into(), curves.collect());
            all
        }
    };
    let known = &report.plan.fit.compressibility;
    for (key, value) in [
        ("title", json!(report.plan.title)),
        ("of", json!("force-curves")),
        ("laws_asked", json!(report.plan.laws)),
        ("fitted", json!(report.found().count())),
        ("failed", json!(report.missing().len())),
        ("poisson_ratio", json!(known.poisson_ratio())),
        ("bulk_modulus_pa", json!(known.constant_bulk_modulus_pa())),
        ("program", json!(env!("CARGO_PKG_NAME"))),
        ("program_version", json!(env!("CARGO_PKG_VERSION"))),
    ] {
        summary.insert(key.to_owned(), value);
    }
    Value::Object(summary)
}

fn of_curve(found: &Found<'_>) -> Map<String, Value> {
    let Found { curve, fit, bands } = found;
    let estimate = |estimate: &Estimate| json!({ "value": estimate.value, "low": estimate.low, "high": estimate.high });
    let law = fit.law();
    let names = law.form.parameters().into_iter().map(|p| p.name);
    let parameters: Map<String, Value> = names.zip(law.parameters.iter().map(estimate)).collect();
    let laws = fit.laws.iter().map(|law: &FittedLaw| {
        json!({
            "law": law.form.law.name(),
            "branches": (law.form.law == Law::Series).then_some(law.form.branches),
            "weight": law.weight,
            "schwarz": law.schwarz,
            "chi_squared": law.chi_squared,
        })
    });
    let nuisances: Map<String, Value> = (fit.nuisances.iter())
        .map(|(nuisance, value)| (nuisance.name().to_owned(), estimate(value)))
        .collect();
    let moduli = bands.iter().map(|(omega, band)| {
        let values = with_ends(*omega, band).map(Value::from);
        let names = MODULI.map(str::to_owned);
        names
            .into_iter()
            .zip(values)
            .collect::<Map<String, Value>>()
    });
    let value = json!({
        "curve": curve.name,
        "status": "converged",
        "law": law.form.law.name(),
        "laws": laws.collect::<Vec<_>>(),
        "law_is_told_from_others": found.others().next().is_none(),
        "parameters": parameters,
        "contact_point_m": estimate(&fit.contact_point_m),
        "instrument": nuisances,
        "samples": curve.time_s.len(),
        "ensemble": fit.ensemble.len(),
        "points": fit.points.time_s.len(),
        "noise_n": fit.points.noise_n,
        "degrees_of_freedom": fit.degrees_of_freedom,
        "reduced_chi_squared": fit.reduced_chi_squared,
        "intervals_widened_by": fit.inflation,
        "retraction_left_out": fit.is_pulled,
        "window_rad_per_s": fit.window_rad_per_s,
        "moduli": moduli.collect::<Vec<_>>(),
    });
    match value {
        Value::Object(object) => object,
        _ => Map::new(),
    }
}
