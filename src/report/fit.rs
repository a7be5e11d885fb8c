//! A fitted series as text: how well it fits, what was assumed, its branches.

use super::text::{Column, Table, Text};
use crate::material::fit::{Fit, FitReport, FittedSeries};
use crate::material::{Material, Relaxation};
use crate::quantity::{Dimension, format_human};

/// Misfit, notes and warnings.
pub fn text(report: &FitReport) -> Text {
    report.to_string().lines().collect()
}

/// What is to be said of where a material comes from: how its table was fitted, or how well its series stands for the model that was
/// given; empty where neither was.
pub fn origin(material: &Material) -> Text {
    let origin = &material.origin;
    let model = origin.approximation.iter().map(|known| format!("{known}."));
    let mut text = origin.fit.as_ref().map(text).unwrap_or_default();
    text.append(model.collect::<Text>());
    text
}

/// The parameters of the series, to be read; exact ones are in the material block.
pub fn branches(fit: &Fit) -> Text {
    let creep = match fit.series() {
        FittedSeries::Relaxation(relaxation) => return relaxation_branches(relaxation),
        FittedSeries::Creep(creep) => creep,
    };
    let compliance = |value| format_human(value, Dimension::Compliance, 5);
    let limit = compliance(creep.instantaneous_compliance());
    let mut text = Text::from(format!("Instantaneous compliance: {limit}"));
    if let Some(viscosity) = creep.viscosity_pa_s() {
        let viscosity = format_human(viscosity, Dimension::Viscosity, 5);
        text.line(format!("Viscosity: {viscosity}"));
    }
    let branches = creep.branches().iter();
    let branches = branches.map(|b| (compliance(b.compliance_per_pa), b.time_s));
    text.append(table(["compliance", "retardation time"], branches));
    text
}

/// Equilibrium modulus and branches, to be read.
pub fn relaxation_branches(relaxation: &Relaxation) -> Text {
    let modulus = |value| format_human(value, Dimension::Stress, 5);
    let limit = modulus(relaxation.equilibrium_modulus());
    let mut text = Text::from(format!("Equilibrium modulus: {limit}"));
    let branches = relaxation.branches().iter();
    let branches = branches.map(|b| (modulus(b.modulus_pa), b.time_s));
    text.append(table(["modulus", "relaxation time"], branches));
    text
}

/// Branches, each with its time (s); nothing where there is none.
fn table([strength, time]: [&str; 2], branches: impl Iterator<Item = (String, f64)>) -> Text {
    let columns = [
        Column::right("Branch", 6),
        Column::right(strength, 18),
        Column::right(time, 18),
    ];
    let mut table = Table::new(1, columns);
    for (index, (strength, time_s)) in branches.enumerate() {
        let time = format_human(time_s, Dimension::Time, 5);
        table.row([(index + 1).to_string(), strength, time]);
    }
    table.into()
}
