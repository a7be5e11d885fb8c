//! What was asked: material, indenter, drive, as lists of names and values.

use maud::{Markup, Render, html};

use crate::indenter::{Indenter, Value};
use crate::material::{Compressibility, Material, MaterialFunction};
use crate::quantity::Dimension;
use crate::report::caption;
use crate::report::number::plain;
use crate::report::words;
use crate::sweep::plan::layer::LayerPlan;
use crate::sweep::plan::{Block, Condition, SweepPlan};

/// A list of names and values being written.
#[derive(Default)]
pub(super) struct Facts(Vec<(String, Markup)>);

impl Facts {
    /// Adds a fact.
    pub(super) fn add(&mut self, name: &str, value: impl Render) {
        self.0.push((name.to_owned(), value.render()));
    }

    /// The list.
    pub(super) fn html(self) -> Markup {
        html! {
            dl {
                @for (name, value) in self.0 { dt { (name) } dd { (value) } }
            }
        }
    }
}

/// Lines as a list; what stands between back-ticks is code.
pub(super) fn list(lines: impl IntoIterator<Item = impl AsRef<str>>) -> Markup {
    let words = |line: &str| {
        let parts = line.split('`').map(str::to_owned).enumerate();
        html! {
            @for (place, part) in parts {
                @if place % 2 == 1 { code { (part) } } @else { (part) }
            }
        }
    };
    html! {
        ul {
            @for line in lines { li { (words(line.as_ref())) } }
        }
    }
}

/// One line: material, indenter, drive, frequencies.
pub(super) fn line(plan: &SweepPlan) -> String {
    let omegas = &plan.angular_frequencies_rad_per_s;
    let unit = plan.figures.frequency_unit;
    let range = match (omegas.first(), omegas.last()) {
        (Some(one), Some(_)) if omegas.len() == 1 => {
            format!(
                "one frequency, {}",
                plain(unit.of(*one), unit.dimension(), 3)
            )
        }
        (Some(first), Some(last)) => format!(
            "{} frequencies from {} to {}",
            omegas.len(),
            plain(unit.of(*first), unit.dimension(), 3),
            plain(unit.of(*last), unit.dimension(), 3)
        ),
        _ => "no frequency".to_owned(),
    };
    let material = words::each_of(plan, Block::Material, |_, c| {
        let name = c.contact.material.name();
        name.unwrap_or("A material of its own").to_owned()
    });
    let shape = |_: Option<&str>, c: &Condition| format!("a {}", c.contact.indenter.shape());
    let indenter = words::each_of(plan, Block::Indenter, shape);
    let layer = caption::layer(plan.base.contact.layer, &[]);
    let drive = words::drive_line(&plan.base.drive, plan);
    let varied = words::varied_line(plan).map_or(String::new(), |line| format!("; {line}"));
    format!("{material}{layer}, under {indenter}; {drive}; {range}{varied}")
}

/// The section of a sweep.
pub(super) fn sweep(plan: &SweepPlan) -> Markup {
    let mut drive = Facts::default();
    drive.add("control", plan.base.drive.control().name());
    drive.add(
        "mean ± amplitude",
        words::drive_line(&plan.base.drive, plan),
    );
    if let Some(attraction) = words::adhesion_line(plan.base.contact.adhesion) {
        drive.add("attraction", attraction);
    }
    drive.add(
        "phase",
        plain(plan.base.drive.phase_rad(), Dimension::Angle, 4),
    );
    let hold = plain(plan.base.drive.hold_s(), Dimension::Time, 4);
    drive.add("rest before the oscillation", hold);
    if let Some(line) = words::varied_line(plan) {
        drive.add("other axes", line);
    }
    parts(
        html! {
            (each_of(plan, Block::Material, |condition| material(&condition.contact.material)))
            (body(plan.base.contact.layer))
        },
        each_of(plan, Block::Indenter, |condition| {
            indenter_body(
                condition.contact.indenter.as_ref(),
                Some(&condition.contact.material),
            )
        }),
        drive.html(),
    )
}

/// Blocks of a list that are shown; all are in resolved.toml.
const SHOWN: usize = 8;

/// The blocks of a list under their names, or the one that there is.
fn each_of(plan: &SweepPlan, block: Block, show: impl Fn(&Condition) -> Markup) -> Markup {
    let all = plan.each_of(block);
    html! {
        @for (name, condition) in all.iter().take(SHOWN) {
            @if let Some(name) = name { h4 { (name) } }
            (show(condition))
        }
        @if all.len() > SHOWN { p { (all.len() - SHOWN) " more are in resolved.toml." } }
    }
}

/// Material, indenter and drive under their headings.
pub(super) fn parts(material: Markup, indenter: Markup, drive: Markup) -> Markup {
    html! {
        h3 { "Material" } (material)
        h3 { "Indenter" } (indenter)
        h3 { "Drive" } (drive)
    }
}

/// What the body is, where it is no half-space.
pub(super) fn body(layer: Option<LayerPlan>) -> Markup {
    let Some(layer) = layer else {
        return Markup::default();
    };
    let mut facts = Facts::default();
    facts.add("body", format!("a layer {}", layer.lies(|_| false)));
    facts.add("thickness", plain(layer.thickness_m, Dimension::Length, 6));
    if let Some(base) = layer.yielding() {
        facts.add("Poisson ratio of the base", base.poisson_ratio.to_string());
    }
    facts.html()
}

/// A material's series as given.
pub(super) fn material(material: &Material) -> Markup {
    let mut facts = Facts::default();
    if let Some(name) = material.name() {
        facts.add("name", name);
    }
    match material.compressibility() {
        Compressibility::PoissonRatio(nu) => facts.add("Poisson ratio", nu.to_string()),
        Compressibility::BulkModulus(bulk) => {
            facts.add("bulk modulus", words::bulk_modulus(bulk, 6));
        }
    }
    let kind = material.kind().name();
    let time = |time_s| plain(time_s, Dimension::Time, 5);
    match (material.function(), material.relaxation()) {
        (MaterialFunction::Relaxation, Some(relaxation)) => {
            let modulus = |value| plain(value, Dimension::Stress, 6);
            facts.add("given as", format!("{kind} relaxation modulus"));
            facts.add("equilibrium", modulus(relaxation.equilibrium_modulus()));
            let branches = relaxation.branches().iter();
            let lines = branches.map(|b| format!("{}, {}", modulus(b.modulus_pa), time(b.time_s)));
            facts.add("branches: modulus, relaxation time", list(lines));
        }
        _ => {
            let creep = material.creep();
            let compliance = |value| plain(value, Dimension::Compliance, 6);
            let instantaneous = creep.instantaneous_compliance();
            facts.add("given as", format!("{kind} creep compliance"));
            facts.add("instantaneous", compliance(instantaneous));
            if let Some(viscosity) = creep.viscosity_pa_s() {
                facts.add("viscosity", plain(viscosity, Dimension::Viscosity, 6));
            }
            let branches = creep.branches().iter();
            let lines = branches
                .map(|b| format!("{}, {}", compliance(b.compliance_per_pa), time(b.time_s)));
            facts.add("branches: compliance, retardation time", list(lines));
        }
    }
    if let Some(fit) = material.origin.fit.as_ref() {
        facts.add("fitted to data", list(fit.to_string().lines()));
    }
    facts.html()
}

/// The indenter that presses on this material, with its own where it is not rigid.
pub(super) fn indenter_body(shape: &dyn Indenter, pressed: Option<&Material>) -> Markup {
    html! {
        (indenter(shape))
        @if let Some(own) = pressed.and_then(Material::indenter_material) { (material(own)) }
    }
}

/// An indenter's shape and settings.
fn indenter(indenter: &dyn Indenter) -> Markup {
    let mut facts = Facts::default();
    facts.add("shape", indenter.shape());
    for parameter in indenter.parameters() {
        let name = words::named(&parameter.key);
        match &parameter.value {
            Value::Tables(tables) => {
                facts.add(&name, list(tables.iter().map(|table| words::row(table))));
            }
            value => facts.add(&name, words::value(value)),
        }
    }
    facts.html()
}
