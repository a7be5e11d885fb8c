//! Scenario files: from a document to a finished plan of one drive history.

use super::diagnostic::{Diagnostics, Problems};
use super::document::{Document, Located, TableReader};
use super::figures_block::{self, Figures};
use super::material_table::DirectSum;
use super::sweep_file::{default_solver, optional, solver};
use super::{indenter_block, material_block, segments_block};
use crate::drive::SegmentedDrive;
use crate::quantity::{Dimension, format_human};
use crate::sweep::figures::figure_plan::FigurePlan;
use crate::sweep::plan::body_material::BodyMaterial;
use crate::sweep::plan::scenario::{OutputPlan, ScenarioPlan};
use crate::sweep::plan::{EngineKind, SolverPlan};
use crate::sweep::scales::elastic::ElasticScale;

/// More surfaces than this fill memory and disk before they are looked at.
const MAX_SURFACES: usize = 10_000;

/// The plan that a scenario file asks for.
///
/// # Errors
/// Everything that is wrong with the file, at once, each problem with its place and what to write instead.
pub fn plan(document: &Document) -> Result<ScenarioPlan, Diagnostics> {
    let problems = Problems::new();
    let mut root = document.root(&problems);
    let title = root.string("title");
    let material =
        material_block::read_body(&mut root, document.folder(), DirectSum::Taken, &problems)
            .and_then(|m| for_contact(&problems, m));
    let indenter = root
        .table("indenter")
        .and_then(|t| indenter_block::read(t, document.folder(), &problems));
    let drive = root
        .table("drive")
        .and_then(|t| segments_block::read(t, document.folder(), &problems));
    let step_s = optional(&mut root, "time", None, |t| time(t, &problems));
    let default = default_solver(indenter.as_deref());
    let solver = optional(&mut root, "solver", default, |t| {
        solver(t, default, &problems)
    });
    let output = optional(&mut root, "output", OutputPlan::default(), |t| {
        output(t, &problems, drive.as_ref(), solver.as_ref())
    });
    let figures = optional(&mut root, "figures", Figures::default(), |t| {
        figures_block::read(t, &problems)
    });
    root.finish();
    let plan = (|| {
        let figures = figures?;
        let mut plan = ScenarioPlan {
            title: title?.value,
            material: material?,
            indenter: indenter?,
            drive: drive?,
            step_s: step_s?,
            output: output?,
            solver: solver?,
            figures: FigurePlan::default(),
        };
        let scale = || ElasticScale::of_scenario(&plan).map(drop);
        plan.figures = figures.checked(scale, &problems)?;
        Some(plan)
    })();
    problems.into_result(plan)
}

/// Refuses materials that cannot be in contact. A fluid can: a history ends before its creep does.
fn for_contact(problems: &Problems, material: Located<BodyMaterial>) -> Option<BodyMaterial> {
    match material.value.check_contact() {
        Ok(()) => Some(material.value),
        Err(error) => {
            problems.at(&material, error.to_string());
            None
        }
    }
}

/// The time step, where one is given.
fn time(mut table: TableReader<'_>, problems: &Problems) -> Option<Option<f64>> {
    if !table.has("step") {
        table.finish();
        return Some(None);
    }
    let step = table.optional_quantity("step", Dimension::Time);
    table.finish();
    let step = step?;
    if step.value > 0.0 {
        return Some(Some(step.value));
    }
    problems
        .at(&step, "a time step must be above zero")
        .help("leave it out, and steps are chosen from drive and material");
    None
}

fn output(
    mut table: TableReader<'_>,
    problems: &Problems,
    drive: Option<&SegmentedDrive>,
    solver: Option<&SolverPlan>,
) -> Option<OutputPlan> {
    let profiles = times(&mut table, problems, "profiles_at", drive);
    let fields = times(&mut table, problems, "fields_at", drive);
    let place = table.key_location("field_cells");
    let default = OutputPlan::default().field_cells;
    let field_cells = table.positive_integer_or("field_cells", SolverPlan::CELLS, default);
    let error_bars = table.boolean_or("error_bars", OutputPlan::default().error_bars);
    table.finish();
    if let (Some(solver), Some(place)) = (solver, place)
        && solver.engine == EngineKind::HalfSpace
    {
        problems
            .at(
                &place,
                "the half-space engine gives fields on its own cells",
            )
            .help("remove `field_cells`, and set solver.cells");
        return None;
    }
    Some(OutputPlan {
        profiles_at_s: profiles?,
        fields_at_s: fields?,
        field_cells: field_cells?.value,
        error_bars: error_bars?.value,
    })
}

/// Times within the history, in the order in which they are written.
fn times(
    table: &mut TableReader<'_>,
    problems: &Problems,
    key: &str,
    drive: Option<&SegmentedDrive>,
) -> Option<Vec<f64>> {
    if !table.has(key) {
        return Some(Vec::new());
    }
    let list = table.optional_quantities(key, Dimension::Time)?;
    if list.value.len() > MAX_SURFACES {
        problems
            .at(&list, format!("{} times are too many", list.value.len()))
            .help(format!("give at most {MAX_SURFACES}"));
        return None;
    }
    let mut fine = true;
    if let Some(end_s) = drive.map(SegmentedDrive::duration_s) {
        // Durations are added up: the end may differ from the time written by rounding.
        let outside = |t: &&Located<f64>| !(0.0..=end_s * (1.0 + 1e-12)).contains(&t.value);
        for time in list.value.iter().filter(outside) {
            let end = format_human(end_s, Dimension::Time, 6);
            problems
                .at(time, "this time is not within the drive's history")
                .because(format!("the history lasts from 0 s to {end}"));
            fine = false;
        }
    }
    fine.then(|| list.value.into_iter().map(|t| t.value).collect())
}
