//! The `[material]` block of a sweep file.

use std::path::Path;

use super::diagnostic::Problems;
use super::document::{Located, TableReader};
use super::material_table::{self, DirectSum, TableMaterial};
use crate::material::classical::{KelvinVoigt, Maxwell, Zener};
use crate::material::sampled::Sampled;
use crate::material::{
    Creep, CreepBranch, Material, MaterialError, ModulusKind, Relaxation, RelaxationBranch, library,
};
use crate::quantity::Dimension;
use crate::sweep::plan::body_material::BodyMaterial;

/// A way to give a material.
#[derive(Debug, Clone, Copy)]
enum Form {
    Library,
    Table(TableForm),
}

/// A way that is a table of its own.
#[derive(Debug, Clone, Copy)]
enum TableForm {
    Relaxation,
    Creep,
    Maxwell,
    Zener,
    KelvinVoigt,
    Measured,
}

/// The ways to give a material; exactly one of them.
const FORMS: [(&str, Form); 7] = [
    ("library", Form::Library),
    ("relaxation", Form::Table(TableForm::Relaxation)),
    ("creep", Form::Table(TableForm::Creep)),
    ("maxwell", Form::Table(TableForm::Maxwell)),
    ("zener", Form::Table(TableForm::Zener)),
    ("kelvin_voigt", Form::Table(TableForm::KelvinVoigt)),
    ("table", Form::Table(TableForm::Measured)),
];

pub(crate) const KINDS: [(&str, ModulusKind); 2] = [
    ("longitudinal", ModulusKind::Longitudinal),
    ("shear", ModulusKind::Shear),
];

/// Twice as many as a fit gives.
const MAX_ALTERNATIVES: usize = 8;

/// More branches than any fit resolves are a mistake in the file.
const MAX_BRANCHES: usize = 1000;

/// Reads the block as a series, which every material but samples used directly is; files are looked for in `folder`. `None`
/// where a problem was reported.
pub(crate) fn read(
    root: &mut TableReader<'_>,
    folder: &Path,
    direct_sum: DirectSum,
    problems: &Problems,
) -> Option<Located<Material>> {
    let body = read_body(root, folder, direct_sum, problems)?;
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
    let mut block = root.table("material")?;
    let name = block.optional_string("name");
    let poisson_ratio = block.optional_number("poisson_ratio");
    if let Some(nu) = &poisson_ratio
        && !(nu.value > -1.0 && nu.value <= 0.5)
    {
        problems
            .at(nu, "a Poisson ratio lies above -1 and not above 0.5")
            .help("an incompressible material has poisson_ratio = 0.5");
        return None;
    }
    let asked_for_nu = block.has("poisson_ratio");
    let chosen = block.one_of(&FORMS);
    let measured = measured(&mut block, problems, chosen);
    let material = match chosen {
        Some((_, Form::Library)) => {
            let nu = poisson_ratio.map(|nu| nu.value);
            from_library(&mut block, problems, nu).map(BodyMaterial::from)
        }
        Some((key, Form::Table(form))) => {
            let material = from_block(&mut block, folder, direct_sum, problems, (key, form));
            match (material, &poisson_ratio) {
                (Some(build), Some(nu)) => at_block(&mut block, problems, key, build(nu.value)),
                (_, None) if !asked_for_nu => {
                    // Asks for the key, which reports it as missing.
                    block.number("poisson_ratio");
                    None
                }
                _ => None,
            }
        }
        None => None,
    };
    let place = chosen.and_then(|(key, _)| block.key_location(key));
    if chosen.is_some() {
        block.finish();
    }
    let mut value = material?;
    if let Some(window_s) = measured? {
        value = value.measured(window_s);
    }
    if let Some(name) = name {
        value = value.named(name.value);
    }
    Some(Located {
        value,
        path: "material".to_owned(),
        location: place?,
    })
}

fn from_library(
    block: &mut TableReader<'_>,
    problems: &Problems,
    poisson_ratio: Option<f64>,
) -> Option<Material> {
    let name = block.string("library")?;
    let Some(entry) = library::find(&name.value) else {
        let report = problems.at(
            &name,
            format!("no material \"{}\" in the library", name.value),
        );
        match library::suggest(&name.value) {
            Some(near) => report.help(format!("write \"{near}\"")),
            None => report.help("`contact-dma material list` names all of them"),
        };
        return None;
    };
    let material = at_block(block, problems, "library", entry.material())?;
    match (poisson_ratio, material.relaxation()) {
        (Some(nu), Some(relaxation)) => {
            let other = Material::from_relaxation(relaxation.clone(), material.kind(), nu);
            at_block(block, problems, "library", other)
                .map(|m| m.named(entry.title).measured(entry.measured_window_s))
        }
        _ => Some(material),
    }
}

/// The times between which a user's own series was measured; `None` where a problem was reported.
fn measured(
    block: &mut TableReader<'_>,
    problems: &Problems,
    chosen: Option<(&str, Form)>,
) -> Option<Option<(f64, f64)>> {
    if !block.has("measured") {
        return Some(None);
    }
    let times = block.quantities("measured", Dimension::Time)?;
    if let Some((key, Form::Library | Form::Table(TableForm::Measured))) = chosen {
        problems
            .at(&times, format!("`{key}` says itself when it was measured"))
            .help("leave out `measured`");
        return None;
    }
    match times.value.as_slice() {
        [first, last] if first.value > 0.0 && last.value > first.value => {
            Some(Some((first.value, last.value)))
        }
        _ => {
            problems
                .at(
                    &times,
                    "`measured` takes the first and the last time of the test, above zero",
                )
                .help("write measured = [\"0.1 s\", \"1000 s\"]");
            None
        }
    }
}

/// A material but for its Poisson ratio.
type Build = Box<dyn FnOnce(f64) -> Result<BodyMaterial, MaterialError>>;

/// The same of a series.
type SeriesBuild = Box<dyn FnOnce(f64) -> Result<Material, MaterialError>>;

fn from_block(
    block: &mut TableReader<'_>,
    folder: &Path,
    direct_sum: DirectSum,
    problems: &Problems,
    (key, form): (&str, TableForm),
) -> Option<Build> {
    let mut table = block.table(key)?;
    let build: Option<Build> = match form {
        TableForm::Relaxation => {
            let kind = table.choice_of("modulus", &KINDS).map(|kind| kind.value);
            with_alternatives(block, &mut table, problems, |table| {
                relaxation(table, problems, kind)
            })
        }
        TableForm::Creep => {
            let kind = table.choice_of("compliance", &KINDS).map(|kind| kind.value);
            with_alternatives(block, &mut table, problems, |table| {
                creep(table, problems, kind)
            })
        }
        TableForm::Measured => {
            material_table::read(&mut table, folder, direct_sum, problems).map(of_table)
        }
        TableForm::Maxwell => {
            pair(&mut table, problems, "modulus").map(|[modulus, time]| -> Build {
                Box::new(move |nu| series(Maxwell::new(modulus, time)?.material(nu)))
            })
        }
        TableForm::KelvinVoigt => {
            pair(&mut table, problems, "spring").map(|[spring, time]| -> Build {
                Box::new(move |nu| series(KelvinVoigt::new(spring, time)?.material(nu)))
            })
        }
        TableForm::Zener => zener(&mut table, problems),
    };
    table.finish();
    build
}

/// A series, and the others beside it that fit the same data.
fn with_alternatives(
    block: &mut TableReader<'_>,
    own: &mut TableReader<'_>,
    problems: &Problems,
    read: impl Fn(&mut TableReader<'_>) -> Option<SeriesBuild>,
) -> Option<Build> {
    let build = read(own);
    let mut others = Vec::new();
    if block.has("alternative") {
        let tables = block.tables("alternative")?;
        if tables.value.len() > MAX_ALTERNATIVES {
            problems
                .at(
                    &tables,
                    format!("{} alternatives are too many", tables.value.len()),
                )
                .help(format!("give at most {MAX_ALTERNATIVES}"));
            return None;
        }
        for mut table in tables.value {
            others.push(read(&mut table));
            table.finish();
        }
    }
    let build = build?;
    let others: Vec<SeriesBuild> = others.into_iter().collect::<Option<_>>()?;
    Some(Box::new(move |nu| {
        let others: Result<Vec<Material>, _> = others.into_iter().map(|other| other(nu)).collect();
        Ok(build(nu)?.with_alternatives(others?).into())
    }))
}

fn series(material: Result<Material, MaterialError>) -> Result<BodyMaterial, MaterialError> {
    material.map(BodyMaterial::from)
}

fn of_table(table: TableMaterial) -> Build {
    match table {
        TableMaterial::Fitted(fit) => Box::new(move |nu| series(fit.material(nu))),
        TableMaterial::Direct(data) => {
            Box::new(move |nu| Sampled::new(data, nu).map(BodyMaterial::from))
        }
    }
}

/// A modulus under this key, and a time.
fn pair(table: &mut TableReader<'_>, problems: &Problems, key: &str) -> Option<[f64; 2]> {
    let modulus = positive(
        problems,
        table.quantity(key, Dimension::Stress),
        "a modulus",
        ELASTIC,
    );
    let time = table.quantity("time", Dimension::Time);
    let time = positive(problems, time, "a time", ELASTIC);
    Some([modulus?, time?])
}

fn zener(table: &mut TableReader<'_>, problems: &Problems) -> Option<Build> {
    let spring = positive(
        problems,
        table.quantity("spring", Dimension::Stress),
        "a modulus",
        ELASTIC,
    );
    let [kelvin_spring, time] = pair(table, problems, "kelvin_spring")?;
    let spring = spring?;
    Some(Box::new(move |nu| {
        series(Zener::new(spring, kelvin_spring, time)?.material(nu))
    }))
}

fn relaxation(
    table: &mut TableReader<'_>,
    problems: &Problems,
    kind: Option<ModulusKind>,
) -> Option<SeriesBuild> {
    let equilibrium = table.quantity("equilibrium", Dimension::Stress);
    let equilibrium = not_negative(problems, equilibrium, "an equilibrium modulus");
    let branches = branches(table, problems, "modulus", Dimension::Stress);
    let (kind, equilibrium, branches) = (kind?, equilibrium?, branches?);
    Some(Box::new(move |nu| {
        let branches = branches
            .into_iter()
            .map(|(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s })
            .collect();
        let relaxation = Relaxation::new(equilibrium, branches)?;
        Material::from_relaxation(relaxation, kind, nu)
    }))
}

fn creep(
    table: &mut TableReader<'_>,
    problems: &Problems,
    kind: Option<ModulusKind>,
) -> Option<SeriesBuild> {
    let instantaneous = table.quantity("instantaneous", Dimension::Compliance);
    let instantaneous = not_negative(problems, instantaneous, "an instantaneous compliance");
    let viscosity = match table.optional_quantity("viscosity", Dimension::Viscosity) {
        Some(viscosity) => Some(positive(
            problems,
            Some(viscosity),
            "a viscosity",
            "leave the key out for a solid",
        )?),
        None => None,
    };
    let branches = branches(table, problems, "compliance", Dimension::Compliance);
    let (kind, instantaneous, branches) = (kind?, instantaneous?, branches?);
    Some(Box::new(move |nu| {
        let branches = branches
            .into_iter()
            .map(|(compliance_per_pa, time_s)| CreepBranch {
                compliance_per_pa,
                time_s,
            })
            .collect();
        let creep = Creep::new(instantaneous, branches, viscosity)?;
        Material::from_creep(creep, kind, nu)
    }))
}

/// The `branches` of a series: (modulus or compliance, time).
fn branches(
    table: &mut TableReader<'_>,
    problems: &Problems,
    key: &str,
    dimension: Dimension,
) -> Option<Vec<(f64, f64)>> {
    let tables = table.tables("branches")?;
    if tables.value.len() > MAX_BRANCHES {
        problems
            .at(
                &tables,
                format!("{} branches are too many", tables.value.len()),
            )
            .help(format!("give at most {MAX_BRANCHES}"));
        return None;
    }
    let read = |mut branch: TableReader<'_>| {
        let strength = positive(
            problems,
            branch.quantity(key, dimension),
            &format!("a {key}"),
            "leave out a branch that is not there",
        );
        let time = branch.quantity("time", Dimension::Time);
        let time = positive(
            problems,
            time,
            "a time",
            "leave out a branch that is not there",
        );
        branch.finish();
        Some((strength?, time?))
    };
    // All branches are read, so that all problems are reported.
    let all: Vec<_> = tables.value.into_iter().map(read).collect();
    all.into_iter().collect()
}

/// What to write where an element of a model with few of them has no strength or no time.
const ELASTIC: &str =
    "for a body without this element write a [material.relaxation] block with the branches it has";

fn positive(
    problems: &Problems,
    value: Option<Located<f64>>,
    what: &str,
    help: &str,
) -> Option<f64> {
    let value = value?;
    if value.value > 0.0 {
        return Some(value.value);
    }
    problems
        .at(&value, format!("{what} must be above zero"))
        .help(help);
    None
}

fn not_negative(problems: &Problems, value: Option<Located<f64>>, what: &str) -> Option<f64> {
    let value = value?;
    if value.value >= 0.0 {
        return Some(value.value);
    }
    problems.at(&value, format!("{what} cannot be negative"));
    None
}

/// What the material room refuses, reported at the block it came from.
fn at_block<M>(
    block: &mut TableReader<'_>,
    problems: &Problems,
    key: &str,
    material: Result<M, MaterialError>,
) -> Option<M> {
    match material {
        Ok(material) => Some(material),
        Err(error) => {
            if let Some(place) = block.key_location(key) {
                problems.at(&place, error.to_string());
            }
            None
        }
    }
}
