//! A scenario as it will be run: one drive history, every default filled in, every value checked; and its resolved text.

use std::sync::Arc;

use crate::drive::{Control, Segment, SegmentedDrive};
use crate::engine::{EngineKind, SolverPlan};
use crate::indenter::Indenter;
use crate::quantity::Dimension;
use crate::simulation::body_material::BodyMaterial;
use crate::sweep::plan::check::{PlanError, check_count};
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::plan::figures::FigurePlan;
use crate::sweep::plan::resolved::{self, entry, numbers, quoted};

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
        let cells = self.output.field_cells;
        check_count("cells of a field", cells, &SolverPlan::CELLS)?;
        self.contact.check()?;
        self.solver.check()
    }
}

/// What is written beside the history.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputPlan {
    /// Times (s) at which profiles along a radius, or along the axes of the grid, are kept.
    pub profiles_at_s: Vec<f64>,
    /// Times (s) at which whole fields are kept.
    pub fields_at_s: Vec<f64>,
    /// Axisymmetric engine: cells per side of the square on which fields are given; the half-space engine has its own.
    pub field_cells: usize,
    /// Whether the history is to be followed at coarser resolutions too, which tells the errors of its rows.
    pub error_bars: bool,
}

impl OutputPlan {
    /// What counts where nothing is asked for.
    pub const DEFAULT: Self = Self {
        profiles_at_s: Vec::new(),
        fields_at_s: Vec::new(),
        field_cells: 128,
        error_bars: true,
    };
}

impl Default for OutputPlan {
    fn default() -> Self {
        Self::DEFAULT
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
    let OutputPlan {
        profiles_at_s,
        fields_at_s,
        field_cells,
        error_bars,
    } = output;
    let material = &contact.material;
    let solver_text = resolved::solver_text(solver, contact.indenter.as_ref());
    let contact = contact.blocks(
        material
            .indenter_material()
            .map(resolved::indenter_material_text),
    );
    let blocks = material.text() + &contact.layer + &contact.indenter;
    let step =
        step_s.map(|step_s| format!("\n[time]\nstep = {}\n", quoted(step_s, Dimension::Time)));
    let times = |times_s: &[f64]| {
        let times: Vec<String> = times_s
            .iter()
            .map(|t| quoted(*t, Dimension::Time))
            .collect();
        format!("[{}]", times.join(", "))
    };
    let cells = (solver.engine == EngineKind::Axisymmetric).then(|| field_cells.to_string());
    [
        resolved::opening_text(title, &blocks),
        history_text(drive),
        contact.adhesion,
        step.unwrap_or_default(),
        format!(
            "\n[output]\nprofiles_at = {}\nfields_at = {}\nerror_bars = {error_bars}\n{}\n",
            times(profiles_at_s),
            times(fields_at_s),
            entry("field_cells", cells)
        ),
        solver_text,
        figures.text(),
    ]
    .concat()
}

/// The `[drive]` block of a history, with an empty line before it.
pub(crate) fn history_text(drive: &SegmentedDrive) -> String {
    let control = drive.control();
    let segments = drive.segments().iter();
    let segments =
        segments.map(|segment| format!("    {{ {} }},\n", segment_text(segment, control)));
    format!(
        "\n[drive]\ncontrol = \"{}\"\nsegments = [\n{}]\n",
        control.name(),
        segments.collect::<String>()
    )
}

/// The keys of a segment as they stand within the braces of an inline table.
fn segment_text(segment: &Segment, control: Control) -> String {
    let value = |value: f64| quoted(value, resolved::drive_dimension(control));
    let time = |time_s: f64| quoted(time_s, Dimension::Time);
    let list = |values: &[f64]| numbers(values.iter().copied());
    match segment {
        Segment::Step { to, duration_s } => format!(
            "kind = \"step\", to = {}, duration = {}",
            value(*to),
            time(*duration_s)
        ),
        Segment::Ramp { to, duration_s } => format!(
            "kind = \"ramp\", to = {}, duration = {}",
            value(*to),
            time(*duration_s)
        ),
        Segment::Polynomial {
            coefficients,
            duration_s,
        } => format!(
            "kind = \"polynomial\", coefficients = {}, duration = {}",
            list(coefficients),
            time(*duration_s)
        ),
        Segment::Sine {
            mean,
            amplitude,
            angular_frequency_rad_per_s,
            phase_rad,
            cycles,
        } => format!(
            "kind = \"sine\", mean = {}, amplitude = {}, angular_frequency = {}, phase = {}, cycles = {cycles:?}",
            value(*mean),
            value(*amplitude),
            quoted(*angular_frequency_rad_per_s, Dimension::AngularFrequency),
            quoted(*phase_rad, Dimension::Angle)
        ),
        Segment::Table { times_s, values } => format!(
            "kind = \"table\", times = {}, values = {}",
            list(times_s),
            list(values)
        ),
    }
}
