//! A fitted series as text: how well it fits, what was assumed, its branches.

use std::fmt::Write;

use super::words::wrapped;
use crate::material::Material;
use crate::material::fit::{Fit, FitReport, FittedSeries};
use crate::quantity::{Dimension, format_human};

/// Misfit, notes and warnings, wrapped; ends with a line end.
pub fn text(report: &FitReport) -> String {
    let report = report.to_string();
    report.lines().map(wrapped_line).collect()
}

/// How well a series stands for the model that was given; empty where none was. Ends with a line end.
pub fn approximation(material: &Material) -> String {
    let known = material.approximation();
    known.map_or_else(String::new, |known| wrapped_line(&format!("{known}.")))
}

/// One line of at most 80 columns broken between words, what follows the first set in by two.
pub(super) fn wrapped_line(line: &str) -> String {
    wrapped(line, 80, "", "  ")
}

/// The parameters of the series, to be read; exact ones are in the material block.
pub fn branches(fit: &Fit) -> String {
    let (limit, limit_name, rows, strength_name, time_name, flow);
    match fit.series() {
        FittedSeries::Creep(creep) => {
            let compliance = |value| format_human(value, Dimension::Compliance, 5);
            limit = compliance(creep.instantaneous_compliance());
            limit_name = "Instantaneous compliance";
            let branches = creep.branches().iter();
            rows = branches
                .map(|b| (compliance(b.compliance_per_pa), b.time_s))
                .collect::<Vec<_>>();
            (strength_name, time_name) = ("compliance", "retardation time");
            flow = creep.viscosity_pa_s();
        }
        FittedSeries::Relaxation(relaxation) => {
            let modulus = |value| format_human(value, Dimension::Stress, 5);
            limit = modulus(relaxation.equilibrium_modulus());
            limit_name = "Equilibrium modulus";
            let branches = relaxation.branches().iter();
            rows = branches
                .map(|b| (modulus(b.modulus_pa), b.time_s))
                .collect();
            (strength_name, time_name) = ("modulus", "relaxation time");
            flow = None;
        }
    }
    let mut text = format!("{limit_name}: {limit}\n");
    // Writing to a String cannot fail.
    if let Some(viscosity) = flow {
        let viscosity = format_human(viscosity, Dimension::Viscosity, 5);
        let _ = writeln!(text, "Viscosity: {viscosity}");
    }
    if !rows.is_empty() {
        let _ = writeln!(text, "Branch {strength_name:>18} {time_name:>18}");
    }
    for (index, (strength, time_s)) in rows.iter().enumerate() {
        let time = format_human(*time_s, Dimension::Time, 5);
        let _ = writeln!(text, "{:>6} {strength:>18} {time:>18}", index + 1);
    }
    text
}
