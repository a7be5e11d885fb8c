//! A material as the blocks of a sweep file that give the same material again.

use crate::material::{Compressibility, Material, MaterialFunction, Relaxation};
use crate::quantity::Dimension;
use crate::quantity::block::Block as _;
use crate::quantity::setting::{Setting, Table, Value};

/// The material as the block of a sweep file that gives the same material again.
pub fn material_text(material: &Material) -> String {
    material_table(material).toml()
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

/// The block of [`material_text`].
pub(super) fn material_table(material: &Material) -> Table {
    if material.origin.temperature_k.is_some() {
        return table_over_temperatures([material].into_iter());
    }
    let kind = material.kind().name();
    let function = match given_relaxation(material) {
        Some(_) => Table::new("relaxation").with("modulus", kind),
        None => Table::new("creep").with("compliance", kind),
    };
    let function = function.and(series(material, Value::Tables));
    let bulk = material.compressibility().bulk_modulus();
    let bulk = bulk.filter(|bulk| !bulk.branches().is_empty());
    let bulk = bulk.map(|bulk| Table::new("bulk_modulus").and(relaxation(bulk, Value::Tables)));
    let alternatives = material.origin.alternatives.iter();
    // There may be dozens, so the branches of each are one line.
    let alternatives = alternatives.map(|other| {
        let alternative = Table::new("alternative").listed();
        alternative.and(series(other, Value::TablesInLine))
    });
    head(material)
        .and(measured(material))
        .above([function.and(replicas(material))])
        .above(bulk)
        .above(alternatives)
}

/// The same of a material at every temperature of these, the first of which counts where none is asked for.
pub(super) fn table_over_temperatures<'a>(materials: impl Iterator<Item = &'a Material>) -> Table {
    let mut each: Vec<&Material> = Vec::new();
    for material in materials {
        let is_known =
            |other: &&Material| other.origin.temperature_k == material.origin.temperature_k;
        if !each.iter().any(is_known) {
            each.push(material);
        }
    }
    let head = each.first().map(|first| head(first));
    let head = head.unwrap_or_else(|| Table::new("material"));
    head.above(each.into_iter().map(isotherm))
}

/// What stands above the numbers: name, Poisson ratio and temperature.
fn head(material: &Material) -> Table {
    Table::new("material")
        .with_some("name", material.name())
        .and(compressibility(material.compressibility()))
        .with_some("temperature", temperature(material))
}

/// A Poisson ratio, or a bulk modulus that is constant in time.
pub(crate) fn compressibility(compressibility: &Compressibility) -> Option<Setting> {
    if let Some(nu) = compressibility.poisson_ratio() {
        return Some(Setting::new("poisson_ratio", nu));
    }
    let bulk_pa = compressibility.constant_bulk_modulus_pa()?;
    let bulk = Value::Quantity(bulk_pa, Dimension::Stress);
    Some(Setting::new("bulk_modulus", bulk))
}

fn temperature(material: &Material) -> Option<Value> {
    let temperature_k = material.origin.temperature_k?;
    Some(Value::Quantity(temperature_k, Dimension::Temperature))
}

fn isotherm(material: &Material) -> Table {
    let origin = &material.origin;
    let law = origin
        .shift
        .map(|law| Value::Numbers(vec![law.c1, law.c2_k]));
    let ends = origin.isotherms_k.map(|(lowest_k, highest_k)| {
        Value::Quantities(vec![lowest_k, highest_k], Dimension::Temperature)
    });
    Table::new("isotherm")
        .listed()
        .with_some("temperature", temperature(material))
        .with_some("wlf", law)
        .and(measured(material))
        .with_some("measured_temperatures", ends)
        .with("modulus", material.kind().name())
        .and(series(material, Value::Tables))
        .and(replicas(material))
}

fn measured(material: &Material) -> Option<Setting> {
    let (first_s, last_s) = material.origin.measured_window_s?;
    let window = Value::Quantities(vec![first_s, last_s], Dimension::Time);
    Some(Setting::new("measured", window))
}

/// The replicas, as bare numbers: there may be hundreds.
fn replicas(material: &Material) -> Option<Setting> {
    let replicas = material.origin.replicas.iter();
    let replicas = replicas.filter_map(Material::relaxation).map(|replica| {
        let branches = || replica.branches().iter();
        let moduli = branches().map(|branch| branch.modulus_pa).collect();
        let times = branches().map(|branch| branch.time_s).collect();
        vec![
            Setting::new("equilibrium", replica.equilibrium_modulus()),
            Setting::new("moduli", Value::Numbers(moduli)),
            Setting::new("times", Value::Numbers(times)),
        ]
    });
    let rows: Vec<_> = replicas.collect();
    (!rows.is_empty()).then(|| Setting::new("replicas", Value::Tables(rows)))
}

/// The relaxation modulus of a material that was given by it.
fn given_relaxation(material: &Material) -> Option<&Relaxation> {
    let given = material.function() == MaterialFunction::Relaxation;
    material.relaxation().filter(|_| given)
}

/// How the branches of a series are written.
type Rows = fn(Vec<Vec<Setting>>) -> Value;

/// The numbers of the function that was given.
fn series(material: &Material, rows: Rows) -> Vec<Setting> {
    if let Some(given) = given_relaxation(material) {
        return relaxation(given, rows);
    }
    let creep = material.creep();
    let instantaneous = creep.instantaneous_compliance();
    let instantaneous = Value::Quantity(instantaneous, Dimension::Compliance);
    let viscosity = creep.viscosity_pa_s();
    let viscosity = viscosity.map(|value| Value::Quantity(value, Dimension::Viscosity));
    let viscosity = viscosity.map(|viscosity| Setting::new("viscosity", viscosity));
    let branches = creep.branches().iter().map(|b| b.settings().collect());
    let mut settings = vec![Setting::new("instantaneous", instantaneous)];
    settings.extend(viscosity);
    settings.push(Setting::new("branches", rows(branches.collect())));
    settings
}

fn relaxation(relaxation: &Relaxation, rows: Rows) -> Vec<Setting> {
    let equilibrium = Value::Quantity(relaxation.equilibrium_modulus(), Dimension::Stress);
    let branches = relaxation.branches().iter();
    let branches = branches.map(|b| b.settings().collect());
    vec![
        Setting::new("equilibrium", equilibrium),
        Setting::new("branches", rows(branches.collect())),
    ]
}
