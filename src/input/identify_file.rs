//! Identification files: from a document, and the table that it names, to what an identification needs to know.

use std::path::Path;

use super::bodies_block::Bodies;
use super::data_file;
use super::diagnostic::{Diagnostic, Diagnostics, Problems};
use super::document::reader::TableReader;
use super::document::{Document, Located};
use super::given::Given;
use super::harmonic_block::Pressed;
use super::keys;
use super::keys::drive::SEGMENTS;
use super::keys::identify::{
    DATA, IDENTIFY, IDENTIFY_BRANCHES, KNOWN_MATERIAL, MEASURED_DRIVE, MODEL_CYCLE, MODEL_SOLVER,
};
use super::keys::material::BULK_MODULUS;
use super::sweep_file::cycle;
use super::{
    bodies_block, harmonic_block, layer_block, material_block, measured_history, measured_table,
    segments_block,
};
use crate::identify::data::Measurements;
use crate::identify::{Driven, IdentifyPlan, Sought};
use crate::indenter::Indenter;
use crate::material::{Compressibility, Relaxation};
use crate::sweep::plan::SolverPlan;
use crate::sweep::plan::contact::ContactPlan;

/// The table of results in a folder of a sweep or of an analysis.
const TABLE: &str = "sweep.csv";

/// The plan that an identification file asks for.
///
/// # Errors
/// Everything that is wrong with the file, at once, each problem with its place and what to write instead.
pub fn plan(document: &Document) -> Result<IdentifyPlan, Diagnostics> {
    plan_with(document, &Given::default())
}

/// The same, with an indenter for the block that the file leaves out.
///
/// # Errors
/// As [`plan`].
pub fn plan_with(document: &Document, given: &Given) -> Result<IdentifyPlan, Diagnostics> {
    let problems = Problems::new();
    let mut root = document.root(&problems);
    let title = root.value(&keys::TITLE);
    let compressibility = root.table(&KNOWN_MATERIAL);
    let compressibility = compressibility.and_then(|t| known_material(t, &problems));
    let bodies = bodies_block::read(&mut root, document.folder(), &problems);
    let indenter = given.indenter(&mut root, document.folder(), &problems);
    let drive = root.table(&MEASURED_DRIVE).and_then(|t| {
        let against = (bodies.as_ref(), indenter.as_deref());
        driven(t, against, document.folder(), &problems)
    });
    let measured = root.table(&IDENTIFY);
    let measured =
        measured.and_then(|t| measured_block(t, document.folder(), drive.as_ref(), &problems));
    let cycle = root.table_or(&MODEL_CYCLE, IdentifyPlan::CYCLE, |t| cycle(t, &problems));
    let layer = bodies.as_ref().and_then(|bodies| bodies.layer);
    let default = indenter.as_ref();
    let default = default.map_or_else(SolverPlan::default, |indenter| {
        IdentifyPlan::solver(indenter.as_ref(), layer)
    });
    let solver = root.table_or(&MODEL_SOLVER, default, |t| {
        layer_block::solver_on(layer.is_some(), t, default, &problems)
    });
    root.finish();
    let plan = (|| {
        let (data, measurements, branches) = measured?;
        let (counterbody, adhesion) = bodies.map(|of| (of.counterbody, of.adhesion))?;
        Some(IdentifyPlan {
            title: title?,
            contact: ContactPlan {
                material: Sought {
                    compressibility: compressibility?,
                    counterbody,
                },
                layer,
                indenter: indenter?,
                adhesion,
                solver: solver?,
            },
            drive: drive?,
            branches,
            measurements,
            data,
            cycle: cycle?,
        })
    })();
    problems.into_result(plan)
}

/// The `[drive]` block: a history where it has segments, an oscillation where not.
fn driven(
    mut table: TableReader<'_>,
    (bodies, indenter): (Option<&Bodies<'_>>, Option<&dyn Indenter>),
    folder: &Path,
    problems: &Problems,
) -> Option<Driven> {
    let area_m2 = indenter.and_then(Indenter::period_area_m2);
    if table.has(&SEGMENTS) {
        let pull_off_n = |control| bodies?.pull_off_n(indenter, control);
        let bodies = (pull_off_n, area_m2);
        return segments_block::read(table, folder, bodies, problems).map(Driven::History);
    }
    let attraction = bodies.and_then(Bodies::attraction);
    let pressed = Pressed {
        area_m2,
        is_attracted: attraction.is_some(),
    };
    let own = harmonic_block::read(table, pressed, problems)?;
    let drive = match attraction {
        Some(attraction) => attraction.drive(indenter?, &own)?,
        None => own,
    };
    Some(Driven::Cycles(drive))
}

fn known_material(mut table: TableReader<'_>, problems: &Problems) -> Option<Compressibility> {
    let known = material_block::compressibility(&mut table, problems);
    let place = table.key_location(&BULK_MODULUS);
    table.finish();
    let is_relaxing = |bulk: &Relaxation| !bulk.branches().is_empty();
    match (place, known?) {
        (Some(place), Compressibility::BulkModulus(bulk)) if is_relaxing(&bulk) => {
            problems
                .at(&place, "an unknown material has a bulk modulus that is constant in time")
                .because("what is sought is its modulus in tension, which says nothing beside one that relaxes too")
                .help("write `bulk_modulus = \"3 GPa\"`");
            None
        }
        (_, known) => Some(known),
    }
}

/// The `[identify]` block: measurements, and how many branches.
fn measured_block(
    mut table: TableReader<'_>,
    folder: &Path,
    drive: Option<&Driven>,
    problems: &Problems,
) -> Option<(String, Measurements, Option<usize>)> {
    let data = table.read(&DATA);
    let branches = table.value(&IDENTIFY_BRANCHES);
    table.finish();
    let data = data?;
    let file = match data.path_from(folder).is_dir() {
        true => Located {
            value: Path::new(&data.value).join(TABLE).display().to_string(),
            path: data.path,
            location: data.location,
        },
        false => data,
    };
    let (name, bytes) = data_file::named(&file, folder, problems)?;
    // Without a drive, which was reported, rows without one of their own mean nothing.
    let found = match drive? {
        Driven::Cycles(drive) => {
            let rows = measured_table::parse(&name, &bytes, *drive);
            let (cycles, data) = data_file::accepted(rows, &file, problems)?;
            Measurements::new(cycles, data)
        }
        Driven::History(drive) => {
            let rows = measured_history::parse(&name, &bytes, drive);
            let rows = data_file::accepted(rows, &file, problems)?;
            Measurements::of_history(drive, &rows)
        }
    };
    let measurements = found.map_err(|error| {
        let refused = Diagnostic::at(&file.location, format!("{name}: {error}"));
        problems.extend(refused.into());
    });
    Some((name, measurements.ok()?, branches?.flatten()))
}
