//! The `[material]` block of a sweep file.

use std::sync::Arc;

use super::diagnostic::Location;
use super::document::reader::TableReader;
use super::document::{Located, block};
use super::keys;
use super::keys::material::{
    BULK_EQUILIBRIUM, BULK_MODULUS, COMPLIANCE, CREEP, CREEP_ALTERNATIVE, CREEP_BRANCHES, DYNAMIC,
    ELASTIC_BODY, EQUILIBRIUM, Elastic, FORMS, FRACTIONAL, Form, INSTANTANEOUS, KELVIN_VOIGT,
    KelvinVoigt, LIBRARY, LIBRARY_POISSON_RATIO, MAXWELL, MEASURED, MEASURED_TABLE, MODULUS,
    Maxwell, NAME, POISSON_RATIO, RELAXATION, RELAXATION_ALTERNATIVE, RELAXATION_BRANCHES,
    VISCOSITY, ZENER, Zener,
};
use super::material_dynamic::DynamicFit;
use super::material_fractional;
use super::material_table::{self, DirectSum, TableMaterial};
use super::{material_dynamic, material_temperature};
use crate::material::classical::{kelvin_voigt, maxwell, zener};
use crate::material::library::LibraryEntry;
use crate::material::sampled::Sampled;
use crate::material::{
    Compressibility, Creep, Material, MaterialError, ModulusKind, Relaxation, library,
};
use crate::quantity::block::Block;
use crate::quantity::key::Key;
use crate::simulation::body_material::BodyMaterial;

/// Reads the block as a series, which every material but samples used directly is. `None` where a problem was reported.
pub(crate) fn read(root: &mut TableReader<'_>, direct_sum: DirectSum) -> Option<Located<Material>> {
    read_body(root, direct_sum).and_then(series_of)
}

/// A material as the series that it is; `None` for samples.
pub(super) fn series_of(body: Located<BodyMaterial>) -> Option<Located<Material>> {
    let series = body.value.series().cloned()?;
    Some(body.map(|_| series))
}

/// Reads the block. `None` where a problem was reported.
pub(crate) fn read_body(
    root: &mut TableReader<'_>,
    direct_sum: DirectSum,
) -> Option<Located<BodyMaterial>> {
    let block = root.table(&keys::MATERIAL)?;
    read_over(block, direct_sum, None).map(|(body, _)| body)
}

/// The same of the block alone, with the material at each temperature (K) of an axis, where there is one.
pub(super) fn read_over(
    block: TableReader<'_>,
    direct_sum: DirectSum,
    axis: Option<&Located<Vec<f64>>>,
) -> Option<(Located<BodyMaterial>, Vec<Material>)> {
    read_with_fit(block, direct_sum, axis).map(|(body, each, _)| (body, each))
}

/// The material, that at each temperature of an axis, and what was made of dynamic data.
type WithFit = (
    Located<BodyMaterial>,
    Vec<Material>,
    Option<Arc<DynamicFit>>,
);

/// The same with what was made of dynamic data, where the material is of such.
pub(super) fn read_with_fit(
    mut block: TableReader<'_>,
    direct_sum: DirectSum,
    axis: Option<&Located<Vec<f64>>>,
) -> Option<WithFit> {
    let mut fit = None;
    let name: Option<Option<String>> = block.value(&NAME);
    let forms = FORMS.each_ref().map(|form| (&form.0, form));
    let Some((key, form)) = block.one_of(&forms) else {
        // What else belongs to the table is open, but for this.
        block.value::<Option<f64>>(&LIBRARY_POISSON_RATIO);
        return None;
    };
    let (place, form) = (block.key_location(key)?, *form);
    let read = match form {
        Form::Isotherms | Form::Dynamic => {
            let known = match form {
                Form::Isotherms => material_temperature::isotherms(&mut block),
                _ => {
                    fit = block.table(&DYNAMIC).and_then(material_dynamic::read);
                    fit.as_ref().map(DynamicFit::at_temperature)
                }
            };
            let nu = block.value(&POISSON_RATIO);
            material_temperature::read(&mut block, known, nu, axis, &place)
                .map(|(material, each)| (material.into(), each))
        }
        Form::Library => library(&mut block, axis, &place),
        _ => {
            let body = at_one_temperature(&mut block, direct_sum, (form, &place));
            let none_asked = material_temperature::refuse(&mut block, axis);
            body.filter(|_| none_asked).map(|body| (body, Vec::new()))
        }
    };
    block.finish();
    let ((mut value, mut each), name) = (read?, name?);
    if let Some(name) = name {
        value = value.named(&name);
        each = each.into_iter().map(|at| at.named(&name)).collect();
    }
    let body = Located {
        value,
        path: "material".to_owned(),
        location: place,
    };
    Some((body, each, fit))
}

/// A material that does not depend on the temperature.
fn at_one_temperature(
    block: &mut TableReader<'_>,
    direct_sum: DirectSum,
    (form, place): (Form, &Location),
) -> Option<BodyMaterial> {
    let problems = block.problems();
    let body = match form {
        Form::Elastic => elements(block, &ELASTIC_BODY).map(|body: Elastic| {
            library::elastic(body.modulus_pa, body.poisson_ratio).map(BodyMaterial::from)
        }),
        _ => from_block(block, direct_sum, form),
    };
    let body = body.and_then(|made| problems.accept(place, made));
    let measured = measured(block, form);
    let body = body?;
    Some(match measured? {
        Some(window_s) => body.measured(window_s),
        None => body,
    })
}

/// The Poisson ratio, or the bulk modulus in its place; `None` where a problem was reported.
pub(super) fn compressibility(block: &mut TableReader<'_>) -> Option<Compressibility> {
    let Some(place) = block.key_location(&BULK_MODULUS) else {
        let poisson_ratio: Option<f64> = block.value(&POISSON_RATIO);
        return poisson_ratio.map(Compressibility::from);
    };
    if let Some(other) = block.key_location(&POISSON_RATIO) {
        block.value::<f64>(&POISSON_RATIO);
        let report =
            (block.problems()).at(&place, "`bulk_modulus` takes the place of `poisson_ratio`");
        report
            .label(&other, "given here")
            .help("keep the one that you know");
        return None;
    }
    bulk_modulus(block).map(Compressibility::BulkModulus)
}

/// The bulk modulus, constant in time, or the series of one that relaxes; `None` where a problem was reported.
fn bulk_modulus(block: &mut TableReader<'_>) -> Option<Relaxation> {
    let place = block.value_place(BULK_MODULUS.name)?;
    let made = match block.parsed(&BULK_MODULUS) {
        None => Relaxation::new(block.value(&BULK_MODULUS)?, Vec::new()),
        Some(_) => table_of(block, &BULK_MODULUS, |table| {
            let equilibrium: Option<f64> = table.value(&BULK_EQUILIBRIUM);
            let branches = branches(table, &RELAXATION_BRANCHES);
            Some(Relaxation::new(equilibrium?, branches?))
        })?,
    };
    block.problems().accept(&place, made)
}

/// The Poisson ratio of a body that has no bulk modulus: it gives in to nothing at once. `None` where a problem was reported.
fn poisson_ratio_alone(block: &mut TableReader<'_>) -> Option<Compressibility> {
    if let Some(place) = block.key_location(&BULK_MODULUS) {
        let message = "a Kelvin-Voigt body is given with its Poisson ratio";
        (block.problems().at(&place, message))
            .because("without instantaneous compliance no bulk modulus goes with it")
            .help("write `poisson_ratio = 0.4` in place of `bulk_modulus`");
        return None;
    }
    let poisson_ratio: Option<f64> = block.value(&POISSON_RATIO);
    poisson_ratio.map(Compressibility::from)
}

/// A material of the library, at each temperature of an axis where it knows several.
fn library(
    block: &mut TableReader<'_>,
    axis: Option<&Located<Vec<f64>>>,
    place: &Location,
) -> Option<(BodyMaterial, Vec<Material>)> {
    let problems = block.problems();
    let entry = library_entry(block);
    let poisson_ratio: Option<Option<f64>> = block.value(&LIBRARY_POISSON_RATIO);
    let untimed = measured(block, Form::Library);
    let (entry, poisson_ratio, _) = (entry?, poisson_ratio?, untimed?);
    let material = problems.accept(place, entry.material())?;
    let poisson_ratio = poisson_ratio.or(material.poisson_ratio());
    if let Some(known) = material_temperature::shifting(&material) {
        let read = material_temperature::read(block, Some(known), poisson_ratio, axis, place);
        let named = |material: Material| material.named(entry.title);
        return read.map(|(own, each)| (named(own).into(), each.into_iter().map(named).collect()));
    }
    if !material_temperature::refuse(block, axis) {
        return None;
    }
    let material = match (poisson_ratio, material.relaxation()) {
        (Some(nu), Some(relaxation)) => {
            let other = Material::from_relaxation(relaxation.clone(), material.kind(), nu);
            entry.describe(problems.accept(place, other)?)
        }
        _ => material,
    };
    Some((material.into(), Vec::new()))
}

fn library_entry(block: &mut TableReader<'_>) -> Option<&'static LibraryEntry> {
    let name: Located<String> = block.read(&LIBRARY)?;
    let entry = library::find(&name.value);
    if entry.is_none() {
        let unknown = format!("no material \"{}\" in the library", name.value);
        let report = block.problems().at(&name, unknown);
        let near = library::suggest(&name.value);
        let near = near.map_or(String::new(), |near| format!("write \"{near}\"; "));
        report.help(format!("{near}the library has {}", library::names()));
    }
    entry
}

/// The times between which a user's own series was measured; `None` where a problem was reported.
fn measured(block: &mut TableReader<'_>, form: Form) -> Option<Option<(f64, f64)>> {
    if let (false, Some(place)) = (form.goes_with(&MEASURED), block.key_location(&MEASURED)) {
        block
            .problems()
            .at(&place, "this material says itself when it was measured")
            .help("leave out `measured`");
        return None;
    }
    measured_window(block)
}

/// The times of a `measured`, where there is one; `None` where a problem was reported.
pub(super) fn measured_window(table: &mut TableReader<'_>) -> Option<Option<(f64, f64)>> {
    let Some(times) = table.read_if::<Vec<f64>>(&MEASURED)? else {
        return Some(None);
    };
    if let [first, last] = times.value[..]
        && last > first
    {
        return Some(Some((first, last)));
    }
    let what = "`measured` takes the first and the last time of the test";
    let report = table.problems().at(&times, what);
    report.help("write measured = [\"0.1 s\", \"1000 s\"]");
    None
}

/// What is read of a table below, which has no other keys.
fn table_of<T>(
    block: &mut TableReader<'_>,
    key: &Key,
    read: impl FnOnce(&mut TableReader<'_>) -> Option<T>,
) -> Option<T> {
    let mut table = block.table(key)?;
    let made = read(&mut table);
    table.finish();
    made
}

/// The table below of a body of few elements.
fn elements<B: Block>(block: &mut TableReader<'_>, key: &Key) -> Option<B> {
    block.table(key).and_then(|table| block::read(table, None))
}

/// A material that has a Poisson ratio or a bulk modulus beside its table.
fn from_block(
    block: &mut TableReader<'_>,
    direct_sum: DirectSum,
    form: Form,
) -> Option<Result<BodyMaterial, MaterialError>> {
    if matches!(form, Form::Relaxation | Form::Creep) {
        // Messages list it before those that are read first.
        block.has(&RELAXATION_ALTERNATIVE);
    }
    let nu = match form {
        Form::KelvinVoigt => poisson_ratio_alone(block),
        _ => compressibility(block),
    };
    let made = match form {
        Form::Library | Form::Elastic | Form::Isotherms | Form::Dynamic => return None,
        Form::Relaxation => {
            let keys = [&RELAXATION, &MODULUS, &RELAXATION_ALTERNATIVE];
            let replicas = material_temperature::replicas;
            of_series(
                block,
                nu,
                keys,
                (relaxation, replicas, Material::from_relaxation),
            )?
        }
        Form::Creep => {
            let keys = [&CREEP, &COMPLIANCE, &CREEP_ALTERNATIVE];
            let no_replicas = |_: &mut TableReader<'_>| Some(Vec::new());
            of_series(block, nu, keys, (creep, no_replicas, Material::from_creep))?
        }
        Form::Measured => {
            let table = table_of(block, &MEASURED_TABLE, |table| {
                material_table::read(table, direct_sum)
            });
            match (table?, nu?) {
                (TableMaterial::Fitted(fit), nu) => fit.material(nu),
                (TableMaterial::Direct(data), nu) => {
                    let what = "a table with evaluation = \"direct\"";
                    let nu = nu.poisson_ratio();
                    let nu = nu.ok_or(MaterialError::NoPoissonRatio { what });
                    let sampled = nu.and_then(|nu| Sampled::new(data, nu));
                    return Some(sampled.map(BodyMaterial::from));
                }
            }
        }
        Form::Fractional => {
            let build = table_of(block, &FRACTIONAL, material_fractional::read);
            build?(nu?)
        }
        Form::Maxwell => {
            let body: Option<Maxwell> = elements(block, &MAXWELL);
            let (body, nu) = (body?, nu?);
            maxwell(body.modulus_pa, body.time_s)
                .and_then(|body| Material::from_relaxation(body, ModulusKind::Shear, nu))
        }
        Form::KelvinVoigt => {
            let body: Option<KelvinVoigt> = elements(block, &KELVIN_VOIGT);
            let (body, nu) = (body?, nu?);
            kelvin_voigt(body.spring_pa, body.time_s)
                .and_then(|body| Material::from_creep(body, ModulusKind::Shear, nu))
        }
        Form::Zener => {
            let body: Option<Zener> = elements(block, &ZENER);
            let (body, nu) = (body?, nu?);
            zener(body.spring_pa, body.kelvin_spring_pa, body.time_s)
                .and_then(|body| Material::from_creep(body, ModulusKind::Shear, nu))
        }
    };
    Some(made.map(BodyMaterial::from))
}

/// A series of one function of a material: how it is read, how its replicas are, and the material that it makes.
type Series<S> = (
    fn(&mut TableReader<'_>) -> Option<Result<S, MaterialError>>,
    fn(&mut TableReader<'_>) -> Option<Vec<S>>,
    fn(S, ModulusKind, Compressibility) -> Result<Material, MaterialError>,
);

/// The material of a series, with what the noise of its data leaves open and the others that fit the same data.
fn of_series<S>(
    block: &mut TableReader<'_>,
    nu: Option<Compressibility>,
    [key, kind, others]: [&Key; 3],
    (series, replicas, made_of): Series<S>,
) -> Option<Result<Material, MaterialError>> {
    let own = table_of(block, key, |table| {
        let kind = table.value(kind);
        let own = series(table);
        let replicas = replicas(table);
        Some((own?, kind?, replicas?))
    });
    let others = block.tables(others, |mut table| {
        let other = series(&mut table);
        table.finish();
        other
    });
    let ((own, kind, replicas), others, nu) = (own?, others?.value, nu?);
    let material = |series: Result<S, _>| made_of(series?, kind, nu.clone());
    let others = others.into_iter().map(material).collect::<Result<_, _>>();
    let replicas = replicas.into_iter().map(|replica| material(Ok(replica)));
    let replicas = replicas.collect::<Result<_, _>>();
    Some(material(own).and_then(|mut own| {
        own.origin.alternatives = others?;
        own.origin.replicas = replicas?;
        Ok(own)
    }))
}

fn relaxation(table: &mut TableReader<'_>) -> Option<Result<Relaxation, MaterialError>> {
    let equilibrium: Option<f64> = table.value(&EQUILIBRIUM);
    let branches = branches(table, &RELAXATION_BRANCHES);
    Some(Relaxation::new(equilibrium?, branches?))
}

fn creep(table: &mut TableReader<'_>) -> Option<Result<Creep, MaterialError>> {
    let (instantaneous, viscosity) = (table.value(&INSTANTANEOUS), table.value(&VISCOSITY));
    let branches = branches(table, &CREEP_BRANCHES);
    Some(Creep::new(instantaneous?, branches?, viscosity?))
}

/// The branches of a series.
pub(super) fn branches<B: Block>(table: &mut TableReader<'_>, key: &Key) -> Option<Vec<B>> {
    let branches = table.tables(key, |branch| block::read(branch, None));
    branches.map(|branches| branches.value)
}
