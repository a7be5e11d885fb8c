//! The `[material]` block of a sweep file.

use std::path::Path;

use super::diagnostic::{Location, Problems};
use super::document::Located;
use super::document::kind::{Scalar, Tables};
use super::document::reader::TableReader;
use super::document::row::{AnyRow, Optional, Required, Row};
use super::keys;
use super::keys::material::{
    BRANCH_COMPLIANCE, BRANCH_MODULUS, BRANCH_TIME, BULK_MODULUS, COMPLIANCE, CREEP,
    CREEP_ALTERNATIVE, CREEP_BRANCHES, DYNAMIC, ELASTIC_BODY, ELASTIC_POISSON_RATIO, ELEMENT_TIME,
    EQUILIBRIUM, FRACTIONAL, INSTANTANEOUS, ISOTHERMS, KELVIN_SPRING, KELVIN_VOIGT, LIBRARY,
    LIBRARY_POISSON_RATIO, MAXWELL, MAXWELL_MODULUS, MEASURED, MEASURED_TABLE, MODULUS, NAME,
    POISSON_RATIO, RELAXATION, RELAXATION_ALTERNATIVE, RELAXATION_BRANCHES, SPRING, VISCOSITY,
    YOUNG, ZENER,
};
use super::material_fractional;
use super::material_table::{self, DirectSum, TableMaterial};
use super::{material_dynamic, material_temperature};
use crate::material::classical::{KelvinVoigt, Maxwell, Zener};
use crate::material::library::LibraryEntry;
use crate::material::sampled::Sampled;
use crate::material::{
    Compressibility, Creep, CreepBranch, Material, MaterialError, ModulusKind, Relaxation, library,
};
use crate::sweep::plan::body_material::BodyMaterial;

/// A way to give a material.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    Library,
    Elastic,
    Relaxation,
    Creep,
    Maxwell,
    Zener,
    KelvinVoigt,
    Fractional,
    Isotherms,
    Dynamic,
    Measured,
}

/// The ways to give a material; exactly one of them.
static FORMS: [(&dyn AnyRow, Form); 11] = [
    (&LIBRARY, Form::Library),
    (&ELASTIC_BODY, Form::Elastic),
    (&RELAXATION, Form::Relaxation),
    (&CREEP, Form::Creep),
    (&MAXWELL, Form::Maxwell),
    (&ZENER, Form::Zener),
    (&KELVIN_VOIGT, Form::KelvinVoigt),
    (&FRACTIONAL, Form::Fractional),
    (&ISOTHERMS, Form::Isotherms),
    (&DYNAMIC, Form::Dynamic),
    (&MEASURED_TABLE, Form::Measured),
];

/// Reads the block as a series, which every material but samples used directly is; files are looked for in `folder`. `None`
/// where a problem was reported.
pub(crate) fn read(
    root: &mut TableReader<'_>,
    folder: &Path,
    direct_sum: DirectSum,
    problems: &Problems,
) -> Option<Located<Material>> {
    read_body(root, folder, direct_sum, problems).and_then(series_of)
}

/// A material as the series that it is; `None` for samples.
pub(super) fn series_of(body: Located<BodyMaterial>) -> Option<Located<Material>> {
    let series = body.value.series().cloned()?;
    Some(body.map(|_| series))
}

/// Reads the block; files are looked for in `folder`. `None` where a problem was reported.
pub(crate) fn read_body(
    root: &mut TableReader<'_>,
    folder: &Path,
    direct_sum: DirectSum,
    problems: &Problems,
) -> Option<Located<BodyMaterial>> {
    let block = root.table(&keys::MATERIAL)?;
    read_over(block, folder, direct_sum, None, problems).map(|(body, _)| body)
}

/// The same of the block alone, with the material at each temperature (K) of an axis, where there is one.
pub(super) fn read_over(
    mut block: TableReader<'_>,
    folder: &Path,
    direct_sum: DirectSum,
    axis: Option<&Located<Vec<f64>>>,
    problems: &Problems,
) -> Option<(Located<BodyMaterial>, Vec<Material>)> {
    let name = block.value(&NAME);
    let Some(form) = block.one_of(&FORMS) else {
        // What else belongs to the table is open, but for this.
        block.read(&LIBRARY_POISSON_RATIO);
        return None;
    };
    let place = FORMS.iter().find(|(_, other)| *other == form);
    let place = place.and_then(|(row, _)| block.key_location(*row))?;
    let read = match form {
        Form::Isotherms | Form::Dynamic => {
            let known = match form {
                Form::Isotherms => material_temperature::isotherms(&mut block, problems),
                _ => (block.table(&DYNAMIC))
                    .and_then(|table| material_dynamic::read(table, folder, problems)),
            };
            let nu = block.value(&POISSON_RATIO);
            material_temperature::read(&mut block, known, nu, axis, &place, problems)
                .map(|(material, each)| (material.into(), each))
        }
        Form::Library => library(&mut block, axis, &place, problems),
        _ => {
            let body = at_one_temperature(&mut block, folder, direct_sum, problems, (form, &place));
            let none_asked = material_temperature::refuse(&mut block, axis, problems);
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
    Some((body, each))
}

/// A material that does not depend on the temperature.
fn at_one_temperature(
    block: &mut TableReader<'_>,
    folder: &Path,
    direct_sum: DirectSum,
    problems: &Problems,
    (form, place): (Form, &Location),
) -> Option<BodyMaterial> {
    let refused = |error: MaterialError| {
        problems.at(place, error.to_string());
    };
    let body = match form {
        Form::Elastic => block.table(&ELASTIC_BODY).and_then(|mut table| {
            let (modulus_pa, nu) = (table.value(&YOUNG), table.value(&ELASTIC_POISSON_RATIO));
            table.finish();
            let made = library::elastic(modulus_pa?, nu?).map_err(refused);
            Some(made.ok()?.into())
        }),
        _ => {
            let build = from_block(block, folder, direct_sum, problems, form);
            let compressibility = compressibility(block, problems);
            build.and_then(|build| build(compressibility?).map_err(refused).ok())
        }
    };
    let measured = measured(block, problems, form);
    let body = body?;
    Some(match measured? {
        Some(window_s) => body.measured(window_s),
        None => body,
    })
}

/// The Poisson ratio, or the bulk modulus in its place; `None` where a problem was reported.
pub(super) fn compressibility(
    block: &mut TableReader<'_>,
    problems: &Problems,
) -> Option<Compressibility> {
    let Some(place) = block.key_location(&BULK_MODULUS) else {
        return block.value(&POISSON_RATIO).map(Compressibility::from);
    };
    if let Some(other) = block.key_location(&POISSON_RATIO) {
        block.value(&POISSON_RATIO);
        problems
            .at(&place, "`bulk_modulus` takes the place of `poisson_ratio`")
            .label(&other, "given here")
            .help("keep the one that you know");
        return None;
    }
    block.value(&BULK_MODULUS).map(Compressibility::BulkModulus)
}

/// A material of the library, at each temperature of an axis where it knows several.
fn library(
    block: &mut TableReader<'_>,
    axis: Option<&Located<Vec<f64>>>,
    place: &Location,
    problems: &Problems,
) -> Option<(BodyMaterial, Vec<Material>)> {
    let entry = library_entry(block, problems);
    let poisson_ratio = block.value(&LIBRARY_POISSON_RATIO);
    let untimed = measured(block, problems, Form::Library);
    let refused = |error: MaterialError| {
        problems.at(place, error.to_string());
    };
    let (entry, poisson_ratio, _) = (entry?, poisson_ratio?, untimed?);
    let material = entry.material().map_err(refused).ok()?;
    let poisson_ratio = poisson_ratio.or(material.poisson_ratio());
    if let Some(known) = material_temperature::shifting(&material) {
        let read =
            material_temperature::read(block, Some(known), poisson_ratio, axis, place, problems);
        let named = |material: Material| material.named(entry.title);
        return read.map(|(own, each)| (named(own).into(), each.into_iter().map(named).collect()));
    }
    if !material_temperature::refuse(block, axis, problems) {
        return None;
    }
    let material = match (poisson_ratio, material.relaxation()) {
        (Some(nu), Some(relaxation)) => {
            let other = Material::from_relaxation(relaxation.clone(), material.kind(), nu);
            entry.describe(other.map_err(refused).ok()?)
        }
        _ => material,
    };
    Some((material.into(), Vec::new()))
}

fn library_entry(
    block: &mut TableReader<'_>,
    problems: &Problems,
) -> Option<&'static LibraryEntry> {
    let name = block.read(&LIBRARY)?;
    let entry = library::find(&name.value);
    if entry.is_none() {
        let unknown = format!("no material \"{}\" in the library", name.value);
        let report = problems.at(&name, unknown);
        match library::suggest(&name.value) {
            Some(near) => report.help(format!("write \"{near}\"")),
            None => report.help("`contact-dma material list` names all of them"),
        };
    }
    entry
}

/// The times between which a user's own series was measured; `None` where a problem was reported.
fn measured(
    block: &mut TableReader<'_>,
    problems: &Problems,
    form: Form,
) -> Option<Option<(f64, f64)>> {
    let says_itself = matches!(
        form,
        Form::Library | Form::Elastic | Form::Fractional | Form::Measured
    );
    if let (true, Some(place)) = (says_itself, block.key_location(&MEASURED)) {
        problems
            .at(&place, "this material says itself when it was measured")
            .help("leave out `measured`");
        return None;
    }
    measured_window(block, problems)
}

/// The times of a `measured`, where there is one; `None` where a problem was reported.
pub(super) fn measured_window(
    table: &mut TableReader<'_>,
    problems: &Problems,
) -> Option<Option<(f64, f64)>> {
    let Some(times) = table.read(&MEASURED)? else {
        return Some(None);
    };
    if let [first, last] = times.value.as_slice()
        && last.value > first.value
    {
        return Some(Some((first.value, last.value)));
    }
    problems
        .at(
            &times,
            "`measured` takes the first and the last time of the test",
        )
        .help("write measured = [\"0.1 s\", \"1000 s\"]");
    None
}

/// A material but for its Poisson ratio or bulk modulus.
type Build = Box<dyn FnOnce(Compressibility) -> Result<BodyMaterial, MaterialError>>;

/// The same of a series.
type SeriesBuild = Box<dyn FnOnce(Compressibility) -> Result<Material, MaterialError>>;

fn from_block(
    block: &mut TableReader<'_>,
    folder: &Path,
    direct_sum: DirectSum,
    problems: &Problems,
    form: Form,
) -> Option<Build> {
    let mut table = block.table(match form {
        Form::Library | Form::Elastic | Form::Isotherms | Form::Dynamic => return None,
        Form::Relaxation => &RELAXATION,
        Form::Creep => &CREEP,
        Form::Maxwell => &MAXWELL,
        Form::Zener => &ZENER,
        Form::KelvinVoigt => &KELVIN_VOIGT,
        Form::Fractional => &FRACTIONAL,
        Form::Measured => &MEASURED_TABLE,
    })?;
    let build: Option<Build> = match form {
        Form::Library | Form::Elastic | Form::Isotherms | Form::Dynamic => None,
        Form::Relaxation => {
            let kind = table.value(&MODULUS);
            let replicas = material_temperature::replicas(&mut table, problems);
            let read = |table: &mut TableReader<'_>| relaxation(table, kind);
            let build = with_alternatives(block, &mut table, &RELAXATION_ALTERNATIVE, read);
            build.and_then(|build| Some(with_replicas(build, kind?, replicas?)))
        }
        Form::Creep => {
            let kind = table.value(&COMPLIANCE);
            let read = |table: &mut TableReader<'_>| creep(table, kind);
            with_alternatives(block, &mut table, &CREEP_ALTERNATIVE, read).map(series)
        }
        Form::Measured => {
            material_table::read(&mut table, folder, direct_sum, problems).map(of_table)
        }
        Form::Fractional => material_fractional::read(&mut table, problems).map(series),
        Form::Maxwell => element(&mut table, &MAXWELL_MODULUS)
            .map(|(modulus, time)| series(move |nu| Maxwell::new(modulus, time)?.material(nu))),
        Form::KelvinVoigt => element(&mut table, &SPRING)
            .map(|(spring, time)| series(move |nu| KelvinVoigt::new(spring, time)?.material(nu))),
        Form::Zener => {
            let (spring, unit) = (table.value(&SPRING), element(&mut table, &KELVIN_SPRING));
            spring.zip(unit).map(|(spring, (kelvin_spring, time))| {
                series(move |nu| Zener::new(spring, kelvin_spring, time)?.material(nu))
            })
        }
    };
    table.finish();
    build
}

/// A series, and the others beside it that fit the same data.
fn with_alternatives(
    block: &mut TableReader<'_>,
    own: &mut TableReader<'_>,
    alternatives: &Row<Tables, Optional>,
    read: impl Fn(&mut TableReader<'_>) -> Option<SeriesBuild>,
) -> Option<SeriesBuild> {
    let build = read(own);
    let others = block.optional_tables(alternatives, |mut table| {
        let other = read(&mut table);
        table.finish();
        other
    });
    let (build, others) = (build?, others?);
    Some(Box::new(move |nu| {
        let others = others.into_iter().map(|other| other(nu.clone()));
        let others: Result<Vec<Material>, _> = others.collect();
        Ok(build(nu)?.with_alternatives(others?))
    }))
}

/// A series, and what the noise of its data leaves open.
fn with_replicas(build: SeriesBuild, kind: ModulusKind, replicas: Vec<Relaxation>) -> Build {
    series(move |nu| {
        let replica = |relaxation| Material::from_relaxation(relaxation, kind, nu.clone());
        let replicas: Result<_, _> = replicas.into_iter().map(replica).collect();
        Ok(build(nu)?.with_replicas(replicas?))
    })
}

fn series(
    build: impl FnOnce(Compressibility) -> Result<Material, MaterialError> + 'static,
) -> Build {
    Box::new(move |nu| build(nu).map(BodyMaterial::from))
}

fn of_table(table: TableMaterial) -> Build {
    match table {
        TableMaterial::Fitted(fit) => series(move |nu| fit.material(nu)),
        TableMaterial::Direct(data) => Box::new(move |compressibility: Compressibility| {
            let nu = compressibility.poisson_ratio();
            let nu = nu.ok_or(MaterialError::NoPoissonRatio {
                what: "a table with evaluation = \"direct\"",
            })?;
            Sampled::new(data, nu).map(BodyMaterial::from)
        }),
    }
}

/// A modulus and a time.
fn element(table: &mut TableReader<'_>, modulus: &Row<Scalar, Required>) -> Option<(f64, f64)> {
    let (modulus_pa, time_s) = (table.value(modulus), table.value(&ELEMENT_TIME));
    modulus_pa.zip(time_s)
}

fn relaxation(table: &mut TableReader<'_>, kind: Option<ModulusKind>) -> Option<SeriesBuild> {
    let equilibrium = table.value(&EQUILIBRIUM);
    let branches = branches(table, &RELAXATION_BRANCHES, &BRANCH_MODULUS);
    let (kind, equilibrium, branches) = (kind?, equilibrium?, branches?);
    Some(Box::new(move |nu| {
        let relaxation = material_temperature::prony(equilibrium, branches)?;
        Material::from_relaxation(relaxation, kind, nu)
    }))
}

fn creep(table: &mut TableReader<'_>, kind: Option<ModulusKind>) -> Option<SeriesBuild> {
    let instantaneous = table.value(&INSTANTANEOUS);
    let viscosity = table.value(&VISCOSITY);
    let branches = branches(table, &CREEP_BRANCHES, &BRANCH_COMPLIANCE);
    let (instantaneous, viscosity) = (instantaneous?, viscosity?);
    let (kind, branches) = (kind?, branches?);
    Some(Box::new(move |nu| {
        let branch = |(compliance_per_pa, time_s)| CreepBranch {
            compliance_per_pa,
            time_s,
        };
        let branches = branches.into_iter().map(branch).collect();
        Material::from_creep(Creep::new(instantaneous, branches, viscosity)?, kind, nu)
    }))
}

/// The branches of a series: (modulus or compliance, time).
pub(super) fn branches(
    table: &mut TableReader<'_>,
    branches: &Row<Tables, Required>,
    strength: &Row<Scalar, Required>,
) -> Option<Vec<(f64, f64)>> {
    let branches = table.tables(branches, |mut branch| {
        let (strength, time_s) = (branch.value(strength), branch.value(&BRANCH_TIME));
        branch.finish();
        Some((strength?, time_s?))
    });
    branches.map(|branches| branches.value)
}
