//! `summary.json` of a material made of dynamic data.

use serde_json::{Value, json};

use super::DynamicReport;
use super::tables::celsius;
use crate::material::dynamic::shift_law::{Arrhenius, ShiftLaw, Wlf};
use crate::report::laws::{Beside, extended};

/// The summary as an object; what is undefined is null.
pub fn summary(report: &DynamicReport<'_>) -> Value {
    let DynamicReport {
        source,
        data,
        made,
        beside,
    } = report;
    let (master, fit) = (made.master.as_ref(), &made.fit);
    let preferred = master.and_then(|m| m.preferred).map(|law| match law {
        ShiftLaw::Wlf(_) => Wlf::NAME,
        ShiftLaw::Arrhenius(_) => Arrhenius::NAME,
    });
    let summary = json!({
        "files": source.files,
        "format": source.format,
        "format_found_by": source.how,
        "notes": source.notes,
        "modulus": made.kind.name(),
        "points": data.points().count(),
        "isotherms": data.isotherms().len(),
        "reference_temperature_c": report.reference_temperature_k().map(celsius),
        "wlf": master.and_then(|m| m.wlf).as_ref().map(wlf),
        "arrhenius": master.and_then(|m| m.arrhenius).as_ref().map(arrhenius),
        "preferred_law": preferred,
        // About one where the data are thermorheologically simple, and where storage and loss modulus belong to one another.
        "simplicity": master.and_then(|m| m.simplicity),
        "kramers_kronig": fit.kramers_kronig,
        // Relative standard deviations; where the file gives errors, how many times larger than these the noise is.
        "storage_noise": fit.noise.0,
        "loss_noise": fit.noise.1,
        "storage_relative_rms": fit.storage_rms,
        "loss_relative_rms": fit.loss_rms,
        "branches": report.relaxation().branches().len(),
        "equilibrium_modulus_pa": report.relaxation().equilibrium_modulus(),
        "window_rad_per_s": fit.window_rad_per_s,
        "replicas": made.replicas.len(),
        "warnings": report.warnings(),
        "program": env!("CARGO_PKG_NAME"),
        "program_version": env!("CARGO_PKG_VERSION"),
    });
    extended(summary, beside.map(Beside::summary))
}

fn wlf(law: &Wlf) -> Value {
    json!({
        "c1": law.c1,
        "c1_error": law.c1_error,
        "c2_k": law.c2_k,
        "c2_error_k": law.c2_error_k,
        "reference_temperature_c": celsius(law.reference_temperature_k),
    })
}

fn arrhenius(law: &Arrhenius) -> Value {
    json!({
        "activation_energy_j_per_mol": law.activation_energy_j_per_mol,
        "activation_energy_error_j_per_mol": law.activation_energy_error_j_per_mol,
        "reference_temperature_c": celsius(law.reference_temperature_k),
    })
}

/// The summary with what else the files hold, as it is printed.
pub fn printed(report: &DynamicReport<'_>, block: &str, shifting: Option<&str>) -> Value {
    let mut value = summary(report);
    let shifts = report.made.master.as_ref().map(|master| {
        let shifts = master.shifts.iter().map(|shift| {
            json!({
                "temperature_c": celsius(shift.temperature_k),
                "log10_a_t": shift.log10_a_t,
                "log10_a_t_error": shift.log10_a_t_error,
                "b_t": shift.b_t,
            })
        });
        shifts.collect::<Vec<_>>()
    });
    value["shift_factors"] = json!(shifts);
    value["relaxation"] = json!(report.relaxation());
    value["material_toml"] = block.into();
    value["shifting_toml"] = shifting.into();
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::dynamic::Characterisation;
    use crate::report::dynamic::tests::{measured, source};

    #[test]
    fn the_summary_has_every_number_and_null_where_there_is_none() {
        let (data, mut made) = measured();
        let source = source();
        let report = |made: &Characterisation| {
            summary(&DynamicReport {
                source: &source,
                data: &data,
                made,
                beside: None,
            })
        };
        let all = report(&made);
        assert_eq!(all["points"], 45);
        assert_eq!(all["isotherms"], 5);
        assert_eq!(all["reference_temperature_c"], 25.0);
        assert_eq!(all["wlf"]["c2_k"], 60.0);
        assert_eq!(all["preferred_law"], "wlf");
        assert_eq!(all["branches"], 2);
        assert_eq!(all["replicas"], 50);
        assert!(all["warnings"].as_array().unwrap().is_empty());
        made.master = None;
        let none = report(&made);
        for key in ["wlf", "arrhenius", "preferred_law", "simplicity"] {
            assert!(none[key].is_null(), "{key}");
        }
    }
}
