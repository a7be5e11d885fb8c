//! What was asked: material, indenter, drive, as lists of names and values.

use std::fmt::Write;

use super::html::escaped;
use crate::drive::HarmonicDrive;
use crate::indenter::{Indenter, Parameter, Value};
use crate::material::{Material, MaterialFunction, ModulusKind};
use crate::quantity::Dimension;
use crate::report::number::plain;
use crate::sweep::plan::resolved::drive_dimension;
use crate::sweep::plan::{SweepPlan, Varied};

/// A list of names and values being written.
#[derive(Default)]
pub(super) struct Facts {
    html: String,
}

impl Facts {
    /// Adds a fact; both texts are escaped.
    pub(super) fn add(&mut self, name: &str, value: &str) {
        // Writing to a String cannot fail.
        let _ = writeln!(
            self.html,
            "<dt>{}</dt><dd>{}</dd>",
            escaped(name),
            escaped(value)
        );
    }

    /// Adds a fact of several lines.
    pub(super) fn add_list(&mut self, name: &str, values: &[String]) {
        let items: Vec<String> = values
            .iter()
            .map(|value| format!("<li>{}</li>", escaped(value)))
            .collect();
        let _ = writeln!(
            self.html,
            "<dt>{}</dt><dd><ul>{}</ul></dd>",
            escaped(name),
            items.concat()
        );
    }

    /// The list.
    pub(super) fn html(self) -> String {
        format!("<dl>\n{}</dl>\n", self.html)
    }
}

/// One line: material, indenter, drive, frequencies.
pub(super) fn line(plan: &SweepPlan) -> String {
    let omegas = &plan.angular_frequencies_rad_per_s;
    let range = match (omegas.first(), omegas.last()) {
        (Some(first), Some(last)) => format!(
            "{} frequencies from {} to {}",
            omegas.len(),
            plain(*first, Dimension::AngularFrequency, 3),
            plain(*last, Dimension::AngularFrequency, 3)
        ),
        _ => "no frequency".to_owned(),
    };
    format!(
        "{}, under a {}; {}; {range}",
        plan.material.name().unwrap_or("A material of its own"),
        plan.indenter.shape(),
        drive_line(&plan.drive, plan)
    )
}

/// What is prescribed, with the range of what a second axis varies: `load 10 N ± 0.1 N to 10 N`.
pub(in crate::report) fn drive_line(drive: &HarmonicDrive, plan: &SweepPlan) -> String {
    let dimension = drive_dimension(drive.control());
    let value = |value| plain(value, dimension, 4);
    let varied = plan.axis.as_ref().map(|axis| axis.varied);
    let range = || {
        let ends = plan.drives().first().zip(plan.drives().last());
        ends.zip(varied).map_or(String::new(), |((a, b), varied)| {
            format!("{} to {}", value(varied.value(a)), value(varied.value(b)))
        })
    };
    let mean = match varied {
        Some(Varied::Mean) => range(),
        _ => value(drive.mean()),
    };
    let amplitude = match varied {
        Some(Varied::Amplitude) => range(),
        _ => value(drive.amplitude()),
    };
    format!("{} {mean} ± {amplitude}", drive.control().name())
}

/// The section of a sweep.
pub(super) fn sweep(plan: &SweepPlan) -> String {
    let mut drive = Facts::default();
    drive.add("control", plan.drive.control().name());
    drive.add("mean ± amplitude", &drive_line(&plan.drive, plan));
    drive.add("phase", &plain(plan.drive.phase_rad(), Dimension::Angle, 4));
    drive.add(
        "rest before the oscillation",
        &plain(plan.drive.hold_s(), Dimension::Time, 4),
    );
    format!(
        "<h3>Material</h3>\n{}<h3>Indenter</h3>\n{}<h3>Drive</h3>\n{}",
        material(&plan.material),
        indenter(plan.indenter.as_ref()),
        drive.html()
    )
}

/// A material's series as given.
pub(super) fn material(material: &Material) -> String {
    let mut facts = Facts::default();
    if let Some(name) = material.name() {
        facts.add("name", name);
    }
    facts.add("Poisson ratio", &format!("{}", material.poisson_ratio()));
    let kind = match material.kind() {
        ModulusKind::Longitudinal => "longitudinal",
        ModulusKind::Shear => "shear",
    };
    let time = |time_s| plain(time_s, Dimension::Time, 5);
    match (material.given(), material.relaxation()) {
        (MaterialFunction::Relaxation, Some(relaxation)) => {
            let modulus = |value| plain(value, Dimension::Stress, 6);
            facts.add("given as", &format!("{kind} relaxation modulus"));
            facts.add("equilibrium", &modulus(relaxation.equilibrium_modulus()));
            let branches = relaxation.branches().iter();
            let lines = branches.map(|b| format!("{}, {}", modulus(b.modulus_pa), time(b.time_s)));
            facts.add_list(
                "branches: modulus, relaxation time",
                &lines.collect::<Vec<_>>(),
            );
        }
        _ => {
            let creep = material.creep();
            let compliance = |value| plain(value, Dimension::Compliance, 6);
            facts.add("given as", &format!("{kind} creep compliance"));
            facts.add(
                "instantaneous",
                &compliance(creep.instantaneous_compliance()),
            );
            if let Some(viscosity) = creep.viscosity_pa_s() {
                facts.add("viscosity", &plain(viscosity, Dimension::Viscosity, 6));
            }
            let branches = creep.branches().iter();
            let lines = branches
                .map(|b| format!("{}, {}", compliance(b.compliance_per_pa), time(b.time_s)));
            facts.add_list(
                "branches: compliance, retardation time",
                &lines.collect::<Vec<_>>(),
            );
        }
    }
    if let Some(fit) = material.fit() {
        let lines: Vec<String> = fit.to_string().lines().map(str::to_owned).collect();
        facts.add_list("fitted to data", &lines);
    }
    facts.html()
}

/// An indenter's shape and settings.
pub(super) fn indenter(indenter: &dyn Indenter) -> String {
    let mut facts = Facts::default();
    facts.add("shape", indenter.shape());
    for parameter in indenter.parameters() {
        match &parameter.value {
            Value::Tables(tables) => {
                let lines: Vec<String> = tables.iter().map(|table| row(table)).collect();
                facts.add_list(&named(parameter.key), &lines);
            }
            value => facts.add(&named(parameter.key), &text(value)),
        }
    }
    facts.html()
}

/// A key as words.
fn named(key: &str) -> String {
    key.replace('_', " ")
}

/// Settings in one line: `radius 10 mm, height 1 µm`.
pub(in crate::report) fn row(table: &[Parameter]) -> String {
    let entries: Vec<String> = table
        .iter()
        .map(|p| format!("{} {}", named(p.key), text(&p.value)))
        .collect();
    entries.join(", ")
}

fn text(value: &Value) -> String {
    match value {
        Value::Quantity(value, dimension) => plain(*value, *dimension, 6),
        Value::Quantities(values, dimension) => {
            let texts: Vec<String> = values
                .iter()
                .map(|value| plain(*value, *dimension, 6))
                .collect();
            texts.join(", ")
        }
        Value::Number(number) => number.to_string(),
        Value::Integer(integer) => integer.to_string(),
        Value::Text(text) => text.clone(),
        Value::Tables(tables) => format!("{} of them", tables.len()),
    }
}
