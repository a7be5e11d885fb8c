//! A material as the blocks of a sweep file that give the same material again.

use crate::material::{Compressibility, Material, MaterialFunction, Relaxation};
use crate::quantity::Dimension;
use crate::sweep::plan::resolved::{entry, numbers, quoted, toml_string};

/// The material as the block of a sweep file that gives the same material again.
pub fn material_text(material: &Material) -> String {
    let head = head_text(material);
    if material.origin.temperature_k.is_some() {
        return head + &isotherm_text(material);
    }
    let kind = material.kind().name();
    let function = match given_relaxation(material) {
        Some(_) => format!("\n[material.relaxation]\nmodulus = \"{kind}\"\n"),
        None => format!("\n[material.creep]\ncompliance = \"{kind}\"\n"),
    };
    let bulk = material.compressibility().bulk_modulus();
    let bulk = bulk.filter(|bulk| !bulk.branches().is_empty());
    let bulk = bulk.map(|bulk| format!("\n[material.bulk_modulus]\n{}", relaxation_text(bulk)));
    let alternatives = material.origin.alternatives.iter();
    // There may be dozens, so the branches of each are one line.
    let alternatives = alternatives.map(|other| {
        let series = series_text(other).replace("[\n    ", "[");
        let series = series.replace(",\n    ", ", ").replace(",\n]", "]");
        format!("\n[[material.alternative]]\n{series}")
    });
    [
        head,
        measured_text(material),
        function,
        series_text(material),
        replicas_text(material),
        bulk.unwrap_or_default(),
        alternatives.collect(),
    ]
    .concat()
}

/// The same of a material at every temperature of these, the first of which counts where none is asked for.
pub(super) fn text_over_temperatures<'a>(materials: impl Iterator<Item = &'a Material>) -> String {
    let mut each: Vec<&Material> = Vec::new();
    for material in materials {
        let is_known =
            |other: &&Material| other.origin.temperature_k == material.origin.temperature_k;
        if !each.iter().any(is_known) {
            each.push(material);
        }
    }
    let head = each.first().map(|first| head_text(first));
    head.into_iter()
        .chain(each.into_iter().map(isotherm_text))
        .collect()
}

/// The same of a material whose Poisson ratio is not known: a comment in its place says what to write.
pub fn material_text_without_poisson_ratio(material: &Material) -> String {
    let lines = material_text(material);
    let lines = lines.lines().map(|line| match line.starts_with("poisson_ratio = ") {
        true => "# poisson_ratio = 0.4   # not known: write that of the material before the block goes into a sweep\n".to_owned(),
        false => format!("{line}\n"),
    });
    lines.collect()
}

/// What stands above the numbers: name, Poisson ratio and temperature.
fn head_text(material: &Material) -> String {
    let known = compressibility_line(material.compressibility());
    let known = known.map(|line| line + "\n").unwrap_or_default();
    let name = entry("name", material.name().map(toml_string));
    format!("[material]\n{name}{known}{}", temperature_text(material))
}

/// The key of a Poisson ratio, or of a bulk modulus that is constant in time.
pub(crate) fn compressibility_line(compressibility: &Compressibility) -> Option<String> {
    if let Some(nu) = compressibility.poisson_ratio() {
        return Some(format!("poisson_ratio = {nu:?}"));
    }
    let bulk_pa = compressibility.constant_bulk_modulus_pa()?;
    Some(format!(
        "bulk_modulus = {}",
        quoted(bulk_pa, Dimension::Stress)
    ))
}

fn temperature_text(material: &Material) -> String {
    let temperature = material.origin.temperature_k;
    entry(
        "temperature",
        temperature.map(|k| quoted(k, Dimension::Temperature)),
    )
}

fn isotherm_text(material: &Material) -> String {
    let law = material.origin.shift.as_ref();
    [
        "\n[[material.isotherm]]\n".to_owned(),
        temperature_text(material),
        entry(
            "wlf",
            law.map(|law| format!("[{:?}, {:?}]", law.c1, law.c2_k)),
        ),
        measured_text(material),
        isotherms_text(material),
        format!("modulus = \"{}\"\n", material.kind().name()),
        series_text(material),
        replicas_text(material),
    ]
    .concat()
}

fn measured_text(material: &Material) -> String {
    let window = material.origin.measured_window_s.map(|(first_s, last_s)| {
        let [first, last] = [first_s, last_s].map(|time_s| quoted(time_s, Dimension::Time));
        format!("[{first}, {last}]")
    });
    entry("measured", window)
}

fn isotherms_text(material: &Material) -> String {
    let ends = material.origin.isotherms_k.map(|(lowest_k, highest_k)| {
        let ends = [lowest_k, highest_k].map(|k| quoted(k, Dimension::Temperature));
        format!("[{}, {}]", ends[0], ends[1])
    });
    entry("measured_temperatures", ends)
}

/// The replicas, as bare numbers: there may be hundreds.
fn replicas_text(material: &Material) -> String {
    let replicas = material
        .origin
        .replicas
        .iter()
        .filter_map(Material::relaxation);
    let rows: String = replicas
        .map(|replica| {
            let branches = || replica.branches().iter();
            format!(
                "    {{ equilibrium = {:?}, moduli = {}, times = {} }},\n",
                replica.equilibrium_modulus(),
                numbers(branches().map(|branch| branch.modulus_pa)),
                numbers(branches().map(|branch| branch.time_s))
            )
        })
        .collect();
    entry(
        "replicas",
        (!rows.is_empty()).then(|| format!("[\n{rows}]")),
    )
}

/// The relaxation modulus of a material that was given by it.
fn given_relaxation(material: &Material) -> Option<&Relaxation> {
    let given = material.given() == MaterialFunction::Relaxation;
    material.relaxation().filter(|_| given)
}

/// The numbers of the function that was given.
fn series_text(material: &Material) -> String {
    if let Some(relaxation) = given_relaxation(material) {
        return relaxation_text(relaxation);
    }
    let creep = material.creep();
    let instantaneous = quoted(creep.instantaneous_compliance(), Dimension::Compliance);
    let viscosity = creep.viscosity_pa_s();
    let viscosity = viscosity.map(|value| quoted(value, Dimension::Viscosity));
    let branches = creep.branches().iter();
    let branches = branches.map(|b| (b.compliance_per_pa, b.time_s));
    format!(
        "instantaneous = {instantaneous}\n{}{}",
        entry("viscosity", viscosity),
        branches_text("compliance", Dimension::Compliance, branches)
    )
}

fn relaxation_text(relaxation: &Relaxation) -> String {
    let equilibrium = quoted(relaxation.equilibrium_modulus(), Dimension::Stress);
    let branches = relaxation.branches().iter();
    let branches = branches.map(|b| (b.modulus_pa, b.time_s));
    let branches = branches_text("modulus", Dimension::Stress, branches);
    format!("equilibrium = {equilibrium}\n{branches}")
}

fn branches_text(
    key: &str,
    dimension: Dimension,
    branches: impl Iterator<Item = (f64, f64)>,
) -> String {
    let row = |(strength, time_s)| {
        let (strength, time) = (quoted(strength, dimension), quoted(time_s, Dimension::Time));
        format!("    {{ {key} = {strength}, time = {time} }},\n")
    };
    format!("branches = [\n{}]\n", branches.map(row).collect::<String>())
}
