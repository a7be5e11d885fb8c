//! A material as the blocks of a sweep file that give the same material again.

use crate::material::keys::{
    AtTemperature, BULK_MODULUS, COMPLIANCE, CREEP, CREEP_BRANCHES, EQUILIBRIUM, INSTANTANEOUS,
    MEASURED, MEASURED_TEMPERATURES, MODULUS, NAME, POISSON_RATIO, RELAXATION,
    RELAXATION_ALTERNATIVE, RELAXATION_BRANCHES, REPLICAS, Replica, TEMPERATURE, VISCOSITY,
};
use crate::material::{Compressibility, Material, MaterialFunction, Relaxation};
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
    let kind = material.kind();
    let function = match given_relaxation(material) {
        Some(_) => Table::new(RELAXATION.name).and(MODULUS.setting(kind)),
        None => Table::new(CREEP.name).and(COMPLIANCE.setting(kind)),
    };
    let function = function.and(series(material, Value::Tables));
    let bulk = material.compressibility().bulk_modulus();
    let bulk = bulk.filter(|bulk| !bulk.branches().is_empty());
    let bulk = bulk.map(|bulk| Table::new(BULK_MODULUS.name).and(relaxation(bulk, Value::Tables)));
    let alternatives = material.origin.alternatives.iter();
    // There may be dozens, so the branches of each are one line.
    let alternatives = alternatives.map(|other| {
        let alternative = Table::new(RELAXATION_ALTERNATIVE.name).listed();
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
        .and(NAME.setting(material.name().map(str::to_owned)))
        .and(compressibility(material.compressibility()))
        .and(TEMPERATURE.setting(material.origin.temperature_k))
}

/// A Poisson ratio, or a bulk modulus that is constant in time.
pub(crate) fn compressibility(compressibility: &Compressibility) -> Option<Setting> {
    if let Some(nu) = compressibility.poisson_ratio() {
        return POISSON_RATIO.setting(nu);
    }
    BULK_MODULUS.setting(compressibility.constant_bulk_modulus_pa())
}

fn isotherm(material: &Material) -> Table {
    let origin = &material.origin;
    let at = |temperature_k| AtTemperature {
        temperature_k,
        wlf: origin.shift.map(|law| vec![law.c1, law.c2_k]),
        activation_energy: None,
    };
    let at = origin.temperature_k.map(|kelvin| at(kelvin).table());
    let ends_k = origin.isotherms_k.map(|(low, high)| vec![low, high]);
    at.unwrap_or_else(|| Table::new(AtTemperature::NAME))
        .listed()
        .and(measured(material))
        .and(MEASURED_TEMPERATURES.setting(ends_k))
        .and(MODULUS.setting(material.kind()))
        .and(series(material, Value::Tables))
        .and(replicas(material))
}

fn measured(material: &Material) -> Option<Setting> {
    let window_s = material.origin.measured_window_s;
    MEASURED.setting(window_s.map(|(first, last)| vec![first, last]))
}

/// The replicas, as bare numbers: there may be hundreds.
fn replicas(material: &Material) -> Option<Setting> {
    let replicas = material.origin.replicas.iter();
    let replicas = replicas.filter_map(Material::relaxation).map(|replica| {
        let branches = || replica.branches().iter();
        let replica = Replica {
            equilibrium_pa: replica.equilibrium_modulus(),
            moduli_pa: branches().map(|branch| branch.modulus_pa).collect(),
            times_s: branches().map(|branch| branch.time_s).collect(),
        };
        replica.settings().map(Setting::bare).collect()
    });
    let rows: Vec<_> = replicas.collect();
    REPLICAS.setting((!rows.is_empty()).then_some(Value::Tables(rows)))
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
    let branches = creep.branches().iter().map(|b| b.settings().collect());
    let settings = [
        INSTANTANEOUS.setting(creep.instantaneous_compliance()),
        VISCOSITY.setting(creep.viscosity_pa_s()),
        CREEP_BRANCHES.setting(rows(branches.collect())),
    ];
    settings.into_iter().flatten().collect()
}

fn relaxation(relaxation: &Relaxation, rows: Rows) -> Vec<Setting> {
    let branches = relaxation.branches().iter();
    let branches = branches.map(|b| b.settings().collect());
    let settings = [
        EQUILIBRIUM.setting(relaxation.equilibrium_modulus()),
        RELAXATION_BRANCHES.setting(rows(branches.collect())),
    ];
    settings.into_iter().flatten().collect()
}
