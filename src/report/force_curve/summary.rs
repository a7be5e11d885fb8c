//! `summary.json` of force curves.

use serde_json::{Map, Value, json};

use super::{ATTRACTION, CurvesReport, Found};
use crate::report::identify::tables::row;
use crate::report::laws::{self, estimate};

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
    let known = &report.plan.fit.contact.material.compressibility;
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
    let nuisances: Map<String, Value> = (fit.nuisances.iter())
        .map(|(nuisance, value)| (nuisance.name().to_owned(), estimate(value)))
        .collect();
    let adhesion: Map<String, Value> = (ATTRACTION.iter().zip(&fit.attraction))
        .map(|((name, ..), value)| ((*name).to_owned(), estimate(value)))
        .collect();
    let moduli = bands
        .iter()
        .map(|(omega, band)| row(*omega, band, fit.window_rad_per_s));
    let value = json!({
        "curve": curve.name,
        "status": "converged",
        "contact_point_m": estimate(&fit.contact_point_m),
        "adhesion": adhesion,
        "instrument": nuisances,
        "samples": curve.time_s.len(),
        "ensemble": fit.ensemble.len(),
        "points": fit.points.time_s.len(),
        "noise_n": fit.points.noise_n,
        "degrees_of_freedom": fit.laws.degrees_of_freedom,
        "reduced_chi_squared": fit.laws.reduced_chi_squared,
        "intervals_widened_by": fit.laws.inflation,
        "retraction_left_out": fit.is_pulled,
        "window_rad_per_s": fit.window_rad_per_s,
        "moduli": moduli.collect::<Vec<_>>(),
    });
    let mut summary = laws::summary(&fit.laws);
    if let Value::Object(object) = value {
        summary.extend(object);
    }
    summary
}
