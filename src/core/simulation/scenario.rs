//! A scenario as it will be run: one drive history, every default filled in, every value checked; and its resolved text.

use std::sync::Arc;

use crate::block_with_defaults;
use crate::drive::SegmentedDrive;
use crate::engine::{CELLS, EngineKind, SolverPlan};
use crate::indenter::Indenter;
use crate::quantity::Dimension;
use crate::quantity::block::Block as _;
use crate::quantity::key::{Entries, Kind, quantity};
use crate::quantity::setting::{Table, Value, document};
use crate::simulation::body_material::BodyMaterial;
use crate::sweep::plan::check::PlanError;
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::plan::figures::FigurePlan;
use crate::sweep::plan::resolved::indenter_material_text;

/// Everything a simulation needs to know. Two equal plans give equal results, bit for bit.
#[derive(Debug, Clone)]
pub struct ScenarioPlan {
    pub title: String,
    pub contact: ContactPlan<BodyMaterial>,
    pub drive: SegmentedDrive,
    pub solver: SolverPlan,
    /// Time step (s); `None`: chosen from drive and material.
    pub step_s: Option<f64>,
    pub output: OutputPlan,
    /// How the figures look; no part of the results.
    pub figures: FigurePlan,
}

impl ScenarioPlan {
    /// A history without a title, everything else at its default.
    pub fn new(
        material: impl Into<BodyMaterial>,
        indenter: Arc<dyn Indenter>,
        drive: SegmentedDrive,
    ) -> Self {
        let solver = SolverPlan::of(indenter.as_ref(), false);
        Self::of(ContactPlan::new(material.into(), indenter), solver, drive)
    }

    /// The same of a contact that is known, solved like this.
    pub fn of(
        contact: ContactPlan<BodyMaterial>,
        solver: SolverPlan,
        drive: SegmentedDrive,
    ) -> Self {
        Self {
            title: String::new(),
            solver,
            contact,
            drive,
            step_s: None,
            output: OutputPlan::default(),
            figures: FigurePlan::default(),
        }
    }
}

impl ScenarioPlan {
    /// Checks every value that is not checked where it is made. Times are checked with the time steps, by
    /// [`crate::simulation::Simulation::new`].
    ///
    /// # Errors
    /// [`PlanError`] with the first value that is refused.
    pub fn check(&self) -> Result<(), PlanError> {
        self.output.check()?;
        self.contact.check()?;
        Ok(self.solver.check_used()?)
    }
}

/// More of them fill memory and disk before they are looked at.
const TIMES: Kind = Kind::Numbers(
    quantity(Dimension::Time),
    Entries {
        number: 0..=10_000,
        ..Entries::ANY
    },
);

block_with_defaults! {
    /// What is written in addition to the history.
    pub struct OutputPlan in "output" {
        /// Times at which profiles along a radius, or along the axes of the grid, are written.
        profiles_at_s: Vec<f64> = Vec::new() => "profiles_at", TIMES, chosen;
        /// Times at which whole fields are written, as `.npy` and as `.vti` for ParaView.
        fields_at_s: Vec<f64> = Vec::new() => "fields_at", TIMES, chosen;
        /// Whether the history is repeated with fewer steps and nodes to estimate the error of every row.
        error_bars: bool = true => "error_bars", Kind::Flag;
        /// Axisymmetric engine: cells per side of these fields, which are revolved.
        field_cells: usize = 128 => "field_cells", Kind::Integer(CELLS);
    }
}

/// The plan as the text of a scenario file that gives the same plan again; tables are written out.
pub fn resolved_text(plan: &ScenarioPlan) -> String {
    // By name, so that what is added to a plan and not written here, and so not hashed, does not compile.
    let ScenarioPlan {
        title,
        contact,
        drive,
        solver,
        step_s,
        output,
        figures,
    } = plan;
    let material = &contact.material;
    let is_on_springs = solver.engine == EngineKind::Axisymmetric;
    let solver = solver.table_for(contact.indenter.as_ref());
    let contact = contact.blocks(material.indenter_material().map(indenter_material_text));
    let step = step_s.map(|step_s| Value::Quantity(step_s, Dimension::Time));
    let time = Table::new("time").with_some("step", step).unless_empty();
    let output = output.settings();
    let output = output.filter(|setting| is_on_springs || setting.key != "field_cells");
    let output = Table::new(OutputPlan::NAME).and(output);
    let blocks = [
        material.text(),
        contact.layer,
        contact.indenter,
        drive.table().toml(),
        contact.adhesion,
        time.map_or(String::new(), |time| time.toml()),
        output.toml(),
        solver.toml(),
        figures.text(),
    ];
    document(title, blocks)
}
