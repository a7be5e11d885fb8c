//! A fitted series as text: how well it fits, what was assumed, its branches.

use std::fmt::Write;

use super::words::wrapped_line;
use crate::material::Material;
use crate::material::fit::{Fit, FitReport, FittedSeries};
use crate::quantity::{Dimension, format_human};

/// Misfit, notes and warnings, wrapped; ends with a line end.
pub fn text(report: &FitReport) -> String {
    let report = report.to_string();
    report.lines().map(wrapped_line).collect()
}

/// The same of a material, where it was fitted.
pub fn fitted(material: &Material) -> Option<String> {
    material.origin.fit.as_ref().map(text)
}

/// How well a series stands for the model that was given; empty where none was. Ends with a line end.
pub fn approximation(material: &Material) -> String {
    let known = material.origin.approximation.as_ref();
    known.map_or_else(String::new, |known| wrapped_line(&format!("{known}.")))
}

/// The parameters of the series, to be read; exact ones are in the material block.
pub fn branches(fit: &Fit) -> String {
    let (limit, rows, names, flow): (_, Vec<(String, f64)>, _, _) = match fit.series() {
        FittedSeries::Creep(creep) => {
            let compliance = |value| format_human(value, Dimension::Compliance, 5);
            let limit = compliance(creep.instantaneous_compliance());
            let branches = creep.branches().iter();
            (
                format!("Instantaneous compliance: {limit}\n"),
                branches
                    .map(|b| (compliance(b.compliance_per_pa), b.time_s))
                    .collect(),
                ["compliance", "retardation time"],
                creep.viscosity_pa_s(),
            )
        }
        FittedSeries::Relaxation(relaxation) => {
            let modulus = |value| format_human(value, Dimension::Stress, 5);
            let limit = modulus(relaxation.equilibrium_modulus());
            let branches = relaxation.branches().iter();
            (
                format!("Equilibrium modulus: {limit}\n"),
                branches
                    .map(|b| (modulus(b.modulus_pa), b.time_s))
                    .collect(),
                ["modulus", "relaxation time"],
                None,
            )
        }
    };
    let mut text = limit;
    // Writing to a String cannot fail.
    if let Some(viscosity) = flow {
        let viscosity = format_human(viscosity, Dimension::Viscosity, 5);
        let _ = writeln!(text, "Viscosity: {viscosity}");
    }
    if !rows.is_empty() {
        let [strength, time] = names;
        let _ = writeln!(text, "Branch {strength:>18} {time:>18}");
    }
    for (index, (strength, time_s)) in rows.iter().enumerate() {
        let time = format_human(*time_s, Dimension::Time, 5);
        let _ = writeln!(text, "{:>6} {strength:>18} {time:>18}", index + 1);
    }
    text
}
