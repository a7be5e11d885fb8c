//! Scenario files: from a document to a finished plan of one drive history.

use super::diagnostic::{Diagnostics, Problems};
use super::document::reader::TableReader;
use super::document::{Document, Located, block};
use super::figures_block::{self, Figures};
use super::given::Given;
use super::keys;
use super::material_table::DirectSum;
use super::{bodies_block, material_block, segments_block, solver_block};
use crate::drive::SegmentedDrive;
use crate::engine::{EngineKind, SolverPlan};
use crate::figures::elastic::ElasticScale;
use crate::indenter::Indenter;
use crate::material::Material;
use crate::quantity::Dimension::Time;
use crate::quantity::key::{Kind, quantity};
use crate::quantity::{Dimension, format_human};
use crate::simulation::body_material::BodyMaterial;
use crate::simulation::scenario::{OutputPlan, ScenarioPlan};
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::plan::figures::FigurePlan;
use contact_dma_core::block;

block! {
    /// Time steps of a history.
    pub(crate) struct TimePlan in "time" {
        /// Time step; left out: chosen from drive and material.
        step_s: Option<f64> = None => "step",
            Kind::Number(quantity(Time).above_zero().or_else("leave it out, and steps are chosen from drive and material"));
    }
}

/// The plan that a scenario file asks for.
///
/// # Errors
/// Everything that is wrong with the file, at once, each problem with its place and what to write instead.
pub fn plan(document: &Document) -> Result<ScenarioPlan, Diagnostics> {
    plan_with(document, &Given::default())
}

/// The same, with values for blocks that the file leaves out.
///
/// # Errors
/// As [`plan`].
pub fn plan_with(document: &Document, given: &Given) -> Result<ScenarioPlan, Diagnostics> {
    document.read_whole(|root| {
        let problems = root.problems();
        let title = root.value(&keys::TITLE);
        let material = match (&given.material, root.key_location(&keys::MATERIAL)) {
            (Some(given), None) => Some(root.in_place_of("material", given.clone())),
            _ => material_block::read_body(root, DirectSum::Taken),
        };
        let bodies = bodies_block::read(root);
        let layer = bodies.as_ref().and_then(|bodies| bodies.layer);
        let material = material.zip(bodies.as_ref());
        let material = material
            .and_then(|(m, bodies)| for_contact(problems, m, bodies.indenter_material.clone()));
        let indenter = given.indenter(root);
        let drive = root.table(&keys::HISTORY).and_then(|t| {
            let pull_off_n = |control| bodies.as_ref()?.pull_off_n(indenter.as_deref(), control);
            let area_m2 = indenter.as_deref().and_then(Indenter::period_area_m2);
            segments_block::read(t, pull_off_n, area_m2)
        });
        let time = TimePlan { step_s: None };
        let time = root.table_or(&keys::TIME, time, |t| block::read(t, None));
        let default = indenter
            .as_deref()
            .map(|indenter| SolverPlan::of(indenter, layer.is_some()));
        let solver = solver_block::read(root, layer.is_some(), default.unwrap_or_default());
        let output = root.table_or(&keys::OUTPUT, OutputPlan::default(), |t| {
            output(t, drive.as_ref(), solver.as_ref())
        });
        let default = Figures::default();
        let figures = root.table_or(&keys::SCENARIO_FIGURES, default, figures_block::read)?;
        let mut plan = ScenarioPlan {
            title: title?,
            contact: ContactPlan {
                material: material?,
                layer,
                indenter: indenter?,
                adhesion: bodies?.adhesion(),
            },
            drive: drive?,
            solver: solver?,
            step_s: time?.step_s,
            output: output?,
            figures: FigurePlan::default(),
        };
        let scale = || ElasticScale::of_scenario(&plan).map(drop);
        plan.figures = figures.checked(scale, problems)?;
        Some(plan)
    })
}

/// Refuses materials that cannot be in contact. A fluid can: a history ends before its creep does.
fn for_contact(
    problems: &Problems,
    material: Located<BodyMaterial>,
    indenter_material: Option<Material>,
) -> Option<BodyMaterial> {
    problems.accept(&material, material.value.check_contact())?;
    match (indenter_material, &material.value) {
        (None, _) => Some(material.value),
        (Some(indenter), BodyMaterial::Series(own)) => Some(own.clone().against(indenter).into()),
        (Some(_), BodyMaterial::Samples(_)) => {
            let what = "samples taken as they are press a rigid indenter only";
            problems
                .at(&material, what)
                .help("leave out [indenter.material], or set material.table.evaluation = \"fit\"");
            None
        }
    }
}

fn output(
    mut table: TableReader<'_>,
    drive: Option<&SegmentedDrive>,
    solver: Option<&SolverPlan>,
) -> Option<OutputPlan> {
    let problems = table.problems();
    let field_cells = table.place_of("field_cells");
    let places = ["profiles_at", "fields_at"].map(|key| table.places_in(key));
    let output: OutputPlan = block::read(table, None)?;
    if let (Some(solver), Some(place)) = (solver, field_cells)
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
    let Some(end_s) = drive.map(SegmentedDrive::duration_s) else {
        return Some(output);
    };
    // Durations are added up: the end may differ from the time written by rounding.
    let is_outside = |time_s: f64| !(0.0..=end_s * (1.0 + 1e-12)).contains(&time_s);
    let mut fine = true;
    for (times_s, places) in [&output.profiles_at_s, &output.fields_at_s]
        .iter()
        .zip(&places)
    {
        for (_, place) in times_s.iter().zip(places).filter(|(t, _)| is_outside(**t)) {
            let end = format_human(end_s, Dimension::Time, 6);
            problems
                .at(place, "this time is not within the drive's history")
                .because(format!("the history lasts from 0 s to {end}"));
            fine = false;
        }
    }
    fine.then_some(output)
}
