//! `summary.json` of a material made of dynamic data.

use serde::Serialize;
use serde_json::{Value, json};

use super::DynamicReport;
use super::tables::celsius;
use crate::material::dynamic::shift_law::{Arrhenius, ShiftLaw, Wlf};
use crate::report::ReportError;

#[derive(Serialize)]
struct Summary<'a> {
    files: &'a [String],
    format: &'a str,
    format_found_by: &'a str,
    notes: &'a [String],
    modulus: &'static str,
    points: usize,
    isotherms: usize,
    /// `None` where the file names no temperature.
    reference_temperature_c: Option<f64>,
    wlf: Option<Value>,
    arrhenius: Option<Value>,
    preferred_law: Option<&'static str>,
    /// About one where the data are thermorheologically simple.
    simplicity: Option<f64>,
    /// About one where storage and loss modulus belong to one another.
    kramers_kronig: Option<f64>,
    /// Relative standard deviations of the noise; where the file gives errors, how many times larger than these it is.
    storage_noise: f64,
    loss_noise: f64,
    storage_relative_rms: f64,
    loss_relative_rms: f64,
    branches: usize,
    equilibrium_modulus_pa: f64,
    window_rad_per_s: (f64, f64),
    replicas: usize,
    warnings: Vec<String>,
    program: &'a str,
    program_version: &'a str,
}

/// The summary as an object; what is undefined is null.
///
/// # Errors
/// [`ReportError::Table`] where it is no JSON.
pub fn summary(report: &DynamicReport<'_>) -> Result<Value, ReportError> {
    let DynamicReport { source, data, made } = report;
    let master = made.master.as_ref();
    let summary = Summary {
        files: &source.files,
        format: &source.format,
        format_found_by: &source.how,
        notes: &source.notes,
        modulus: made.kind.name(),
        points: data.points().count(),
        isotherms: data.isotherms().len(),
        reference_temperature_c: report.reference_temperature_k().map(celsius),
        wlf: master.and_then(|m| m.wlf).as_ref().map(wlf),
        arrhenius: master.and_then(|m| m.arrhenius).as_ref().map(arrhenius),
        preferred_law: master.and_then(|m| m.preferred).map(|law| match law {
            ShiftLaw::Wlf(_) => Wlf::NAME,
            ShiftLaw::Arrhenius(_) => Arrhenius::NAME,
        }),
        simplicity: master.and_then(|m| m.simplicity),
        kramers_kronig: made.fit.kramers_kronig,
        storage_noise: made.fit.noise.0,
        loss_noise: made.fit.noise.1,
        storage_relative_rms: made.fit.storage_rms,
        loss_relative_rms: made.fit.loss_rms,
        branches: report.relaxation().branches().len(),
        equilibrium_modulus_pa: report.relaxation().equilibrium_modulus(),
        window_rad_per_s: made.fit.window_rad_per_s,
        replicas: made.replicas.len(),
        warnings: report.warnings(),
        program: env!("CARGO_PKG_NAME"),
        program_version: env!("CARGO_PKG_VERSION"),
    };
    serde_json::to_value(summary).map_err(|error| ReportError::Table {
        name: "summary.json",
        reason: error.to_string(),
    })
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
            })
            .unwrap()
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
