//! Engines for an indenter, on a domain: how large it must be, the operator all engines share, and a larger one where the contact reaches the
//! edge after all.

pub mod domain;
pub mod growing;
pub mod instant_tolerance;
mod layered;
mod solver;
mod springs;

pub(crate) use solver::{CELLS, TOLERANCE};
pub use solver::{EngineKind, SolverPlan};

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use crate::contact::axisymmetric::{self, Axisymmetric};
use crate::contact::half_space::convolution::Convolution;
use crate::contact::half_space::grid::Grid;
use crate::contact::half_space::layer::{Layer, LayerInfluence};
use crate::contact::half_space::periodic::{Periodic, PeriodicOperator};
use crate::contact::half_space::{CellField, HalfSpace, SolverSettings};
use crate::contact::{Engine, Prescribed};
use crate::drive::{Control, HarmonicDrive};
use crate::engine::domain::{FEWEST_ACROSS, GROWTH};
use crate::engine::growing::Layout;
use crate::indenter::{self, Domain, Indenter};

/// Why there is no engine for an indenter.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EngineError {
    #[error(
        "the {shape} {reason}; the axisymmetric engine cannot treat it (set solver.engine = \"half-space\")"
    )]
    NotAxisymmetric { shape: &'static str, reason: String },
    #[error(
        "a layer couples all of its surface, and the springs of the axisymmetric engine do not know one another: set solver.engine = \
         \"half-space\", whose cells do"
    )]
    SpringsOnLayer,
    #[error(
        "a layer is solved with a Poisson ratio that does not depend on time, and that of a material with a bulk modulus does: write \
         poisson_ratio in place of bulk_modulus"
    )]
    LayerOfBulkModulus,
    #[error(
        "an attraction within a range moves the edge of the contact within a step, which the springs of the axisymmetric engine follow and \
         cells do not: set solver.engine = \"axisymmetric\", or adhesion.model = \"dmt\" for a small, stiff sphere"
    )]
    AttractedCells,
    #[error(
        "the edge of a {shape} stays where it is, and an attraction within a range moves it: leave out [adhesion]"
    )]
    AttractedRim { shape: &'static str },
    #[error(
        "the memory of a contact whose edge an attraction moves is that of branches: set material.table.evaluation = \"fit\""
    )]
    AttractedSamples,
    #[error(
        "the surface is not computed where an attraction moves the edge of the contact: leave out output.profiles_at and \
         output.fields_at"
    )]
    AttractedSurface,
    #[error(
        "a surface that repeats itself is solved on the half-space alone: leave out [layer], or edge = \"periodic\""
    )]
    PeriodicOnLayer,
    #[error(
        "a surface that repeats itself is pressed by a load: its approach is counted from the mean plane, and has a bound. Write \
         control = \"load\""
    )]
    PeriodicUnderApproach,
    #[error("the half-space grid cannot be built: {0}")]
    Grid(String),
    #[error(
        "the contact reached the edge of its domain, which is so narrow that of {cells} cells along it fewer than {FEWEST_ACROSS} lie across \
         it: give {needed} cells or more (solver.cells), or solve parts of an indenter that lie far apart one by one"
    )]
    TooFewAcross { cells: usize, needed: usize },
    #[error(
        "the contact reached the edge of the computational domain (half width {half_width_m:.3e} m), beyond which the shape of \
         the indenter is not known: give a larger map or a longer profile, or a smaller load"
    )]
    EndOfData { half_width_m: f64 },
}

/// The least half width of a domain.
const SMALLEST_M: f64 = 1e-12;
/// Room beyond the largest contact expected.
const SPRING_ROOM: f64 = 1.02;
/// How many enlargements of the domain there may be before a contact counts as failed.
pub const MAX_GROWTHS: usize = 12;

/// The largest contact that a drive can make.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestContact {
    pub control: Control,
    /// The largest load (N) or approach (m) of the drive.
    pub maximum: f64,
    /// The largest contact compliance that a load meets (1/Pa).
    pub compliance_per_pa: f64,
}

impl LargestContact {
    /// That of a body as soft as this: no history within the drive's range makes a larger one than its maximum held for ever.
    pub(crate) fn of(drive: &HarmonicDrive, compliance_per_pa: f64) -> Self {
        Self {
            control: drive.control(),
            maximum: drive.maximum() + drive.pull_off_n(),
            compliance_per_pa,
        }
    }
}

/// Makes engines of one kind for one indenter.
pub struct EngineBuilder {
    indenter: Arc<dyn Indenter>,
    solver: SolverPlan,
    /// What the body is in place of a half-space, where it is a layer.
    layer: Option<Arc<LayerInfluence>>,
    /// Half width of the largest contact (m), with room for springs.
    half_width_m: f64,
    domain: Domain,
    /// Half widths (m) of the part of the surface that is always in contact during a cycle, of the contact under the mean, and of
    /// the largest in it, where they are known beforehand.
    extremes_m: Option<[f64; 3]>,
    /// The cells of the domain before it is enlarged, where the engine has any, and their operator once it is needed.
    grid: Option<Grid>,
    operator: Mutex<Option<Arc<Convolution>>>,
    /// That of one period, where the indenter repeats itself.
    period: OnceLock<Arc<PeriodicOperator>>,
}

impl EngineBuilder {
    /// Engines for contacts up to the largest.
    ///
    /// # Errors
    /// [`EngineError`] where the engine cannot treat the indenter or its grid cannot be built.
    pub fn new(
        indenter: Arc<dyn Indenter>,
        solver: SolverPlan,
        largest: LargestContact,
    ) -> Result<Self, EngineError> {
        Self::on(None, indenter, solver, largest)
    }

    /// The same on a layer, where there is one.
    ///
    /// # Errors
    /// As [`EngineBuilder::new`]; springs, which a layer would couple.
    pub fn on(
        layer: Option<Layer>,
        indenter: Arc<dyn Indenter>,
        solver: SolverPlan,
        largest: LargestContact,
    ) -> Result<Self, EngineError> {
        if indenter.is_periodic() {
            if layer.is_some() {
                return Err(EngineError::PeriodicOnLayer);
            }
            if largest.control == Control::Approach {
                return Err(EngineError::PeriodicUnderApproach);
            }
        }
        if layer.is_some() && solver.engine == EngineKind::Axisymmetric {
            return Err(EngineError::SpringsOnLayer);
        }
        let layer = layer.map(|layer| Arc::new(LayerInfluence::new(layer)));
        let mut domain = contact_domain(indenter.as_ref(), largest);
        if let Some(layer) = &layer {
            domain = layered::contact_domain(layer, indenter.as_ref(), domain, largest)?;
        }
        let mut half_width_m = contact_half_width_m(indenter.as_ref(), largest);
        if solver.engine == EngineKind::Axisymmetric
            && body_of_revolution(indenter.as_ref())?
                .contact_limit_m()
                .is_none()
        {
            half_width_m *= SPRING_ROOM;
        }
        Self::on_domain(indenter, solver, layer, (domain, half_width_m))
    }

    /// On a domain, or with springs for contacts up to a half width (m).
    fn on_domain(
        indenter: Arc<dyn Indenter>,
        solver: SolverPlan,
        layer: Option<Arc<LayerInfluence>>,
        (domain, half_width_m): (Domain, f64),
    ) -> Result<Self, EngineError> {
        let mut builder = Self {
            indenter,
            solver,
            layer,
            half_width_m,
            domain,
            extremes_m: None,
            grid: None,
            operator: Mutex::default(),
            period: OnceLock::new(),
        };
        if solver.engine == EngineKind::HalfSpace {
            builder.grid = Some(builder.grid(0)?);
        }
        Ok(builder)
    }

    /// The same for a stabilised cycle with these contacts: always there, under the mean, and largest. Springs are then dense
    /// where the edge of the contact moves, and end where it turns.
    #[must_use]
    pub fn over_cycle(mut self, contacts: [LargestContact; 3]) -> Self {
        let width_m = |contact: LargestContact| match contact.maximum > 0.0 {
            true => contact_half_width_m(self.indenter.as_ref(), contact),
            false => 0.0,
        };
        self.extremes_m = Some(contacts.map(width_m));
        self
    }

    /// Whether the cells are those of the indenter, whatever number of them was asked for.
    pub fn has_cells_of_its_own(&self) -> bool {
        self.solver.engine == EngineKind::HalfSpace && matches!(self.domain, Domain::Cells { .. })
    }

    /// The same on a domain this many times as wide, where the indenter's data reach so far.
    ///
    /// # Errors
    /// [`EngineError::Grid`].
    pub(crate) fn scaled(&self, factor: f64) -> Result<Self, EngineError> {
        let domain = domain::scaled(&self.domain, factor);
        let (indenter, layer) = (Arc::clone(&self.indenter), self.layer.clone());
        let sizes = (domain, factor * self.half_width_m);
        Self::on_domain(indenter, self.solver, layer, sizes)
    }

    /// How often the domain can be halved and still hold a contact no larger than this: not at all, where the contact might not
    /// grow outwards from there.
    pub(crate) fn halvings_to(&self, first: LargestContact) -> usize {
        /// Room beyond the first contact, whose size is an estimate.
        const ROOM: f64 = 1.15;
        let own = matches!(self.domain, Domain::Cells { .. });
        let ends =
            body_of_revolution(&*self.indenter).is_ok_and(|body| body.contact_limit_m().is_some());
        let is_fixed = match self.solver.engine {
            EngineKind::Axisymmetric => ends,
            EngineKind::HalfSpace => {
                // A small domain about the origin holds the first contact only if that is where the indenter is lowest.
                // How large it is on a layer is not known beforehand.
                own || self.layer.is_some()
                    || self.indenter.gap_m(0.0, 0.0) > 0.0
                    || !growing::is_convex_within(&*self.indenter, self.half_width_m())
            }
        };
        if is_fixed {
            return 0;
        }
        let wanted_m = ROOM * contact_half_width_m(self.indenter.as_ref(), first);
        let halvings = (self.half_width_m() / wanted_m).log2();
        // Nothing or no number where either width is zero.
        (halvings.max(0.0) as usize).min(MAX_GROWTHS)
    }

    /// Where the nodes are.
    pub(crate) fn layout(&self) -> Layout {
        match self.grid {
            Some(grid) => Layout::Cells(grid),
            None => Layout::Springs {
                springs: self.solver.springs,
                width_m: self.half_width_m() / self.solver.springs as f64,
            },
        }
    }

    /// Number of nodes of an engine, on a domain of any size.
    pub fn nodes(&self) -> usize {
        match &self.grid {
            Some(grid) => grid.cells(),
            None => self.solver.springs,
        }
    }

    /// Cells of the whole surface, where the engine has any.
    pub fn surface_cells(&self) -> usize {
        self.grid.map_or(0, |grid| grid.whole().cells())
    }

    /// Memory (bytes) that a march of an engine takes with this many memory variables per node; that of springs is a guess on the
    /// safe side.
    pub fn predicted_memory_bytes(&self, branches: usize) -> u64 {
        /// Fields of springs in engine and march.
        const FIELDS: usize = 12;
        match &self.grid {
            Some(grid) => {
                let field = CellField {
                    grid: *grid,
                    is_periodic: self.indenter.is_periodic(),
                    is_map: self.indenter.own_cells().is_some(),
                };
                field.memory_bytes(branches)
            }
            None => {
                let springs = self.solver.springs;
                // The table of roots of the pressure: half a square.
                let numbers = springs * springs / 2 + springs * (FIELDS + branches);
                (size_of::<f64>() * numbers) as u64
            }
        }
    }

    /// Half width of the domain before it is enlarged (m).
    pub fn half_width_m(&self) -> f64 {
        self.enlarged_half_width_m(0).0
    }

    /// Half width (m) of the domain enlarged `growths` times, and whether a further enlargement would enlarge it.
    pub(crate) fn enlarged_half_width_m(&self, growths: usize) -> (f64, bool) {
        if self.solver.engine == EngineKind::HalfSpace {
            let half_width_m = domain::half_width_m(&self.domain, growths);
            return (half_width_m, domain::can_grow(&self.domain, growths));
        }
        let wanted_m = self.half_width_m * GROWTH.powi(growths as i32);
        let known_m = (self.indenter.axisymmetric()).and_then(|body| body.known_radius_m());
        match known_m.filter(|known_m| *known_m <= wanted_m) {
            Some(known_m) => (known_m, false),
            None => (wanted_m, true),
        }
    }

    /// Why a domain enlarged `growths` times, whose edge the contact has reached, is not enlarged further.
    pub(crate) fn not_enlarged(&self, growths: usize) -> Option<EngineError> {
        let (half_width_m, can_grow) = self.enlarged_half_width_m(growths);
        if !can_grow {
            return Some(EngineError::EndOfData { half_width_m });
        }
        let cells = self.solver.cells;
        let needed = domain::fewest_cells(&self.domain, growths)?;
        let is_narrow = self.solver.engine == EngineKind::HalfSpace && cells < needed;
        is_narrow.then_some(EngineError::TooFewAcross { cells, needed })
    }

    /// The cells of fields: the grid that the half-space engine would have on a domain enlarged `growths` times, with this
    /// many cells per side.
    ///
    /// # Errors
    /// [`EngineError::Grid`].
    pub fn field_grid(&self, cells: usize, growths: usize) -> Result<Grid, EngineError> {
        let grid = domain::grid(&self.domain, cells, growths);
        grid.and_then(|grid| domain::fitted_to_rim(grid, self.indenter.as_ref()))
            .map_err(|e| EngineError::Grid(e.to_string()))
    }

    /// An engine on a domain enlarged `growths` times.
    ///
    /// # Errors
    /// As [`EngineBuilder::new`].
    pub fn engine(&self, growths: usize) -> Result<Box<dyn Engine>, EngineError> {
        Ok(match self.solver.engine {
            EngineKind::Axisymmetric => Box::new(self.springs(growths)?),
            EngineKind::HalfSpace => match (self.indenter.is_periodic(), self.grid) {
                (true, Some(grid)) => Box::new(self.periodic(grid)),
                _ => Box::new(self.half_space(growths)?),
            },
        })
    }

    fn springs(&self, growths: usize) -> Result<Axisymmetric, EngineError> {
        let body = body_of_revolution(&*self.indenter)?;
        let springs = self.solver.springs;
        let end_m = self.enlarged_half_width_m(growths).0;
        let extremes_m = self.extremes_m.filter(|_| growths == 0);
        let places_m = springs::places_m(end_m, extremes_m, springs);
        let edge = match body.contact_limit_m() {
            Some(_) => axisymmetric::Edge::Rim,
            None => axisymmetric::Edge::Open,
        };
        let bounded = self.indenter.pressure_is_bounded();
        let gap_m = |x_m| body.transformed_gap_m(x_m);
        let springs = Axisymmetric::between(&places_m, gap_m, edge, bounded);
        Ok(springs.singular_at(body.singular_radii_m()))
    }

    fn half_space(&self, growths: usize) -> Result<HalfSpace, EngineError> {
        let operator = self.operator(growths)?;
        let gaps = domain::gaps_m(self.indenter.as_ref(), operator.grid());
        let bounded = self.indenter.pressure_is_bounded();
        let mut engine = HalfSpace::new(operator, gaps, bounded, self.settings());
        if self.layer.is_none() && self.indenter.axisymmetric().is_some() {
            engine = engine.in_round_contact();
        }
        if self.indenter.own_cells().is_some() {
            engine = engine.in_many_patches();
        }
        if let Some(rim) = self.indenter.rim() {
            engine = engine.ending_at_rim(rim.radius_m);
        }
        Ok(if self.indenter.ends_in_data() {
            engine.ending_in_data()
        } else {
            engine
        })
    }

    fn periodic(&self, grid: Grid) -> Periodic {
        let gaps = domain::gaps_m(self.indenter.as_ref(), &grid);
        let built = || PeriodicOperator::shared(grid);
        let operator = self.period.get_or_init(built);
        Periodic::new(Arc::clone(operator), gaps, self.settings())
    }

    fn settings(&self) -> SolverSettings {
        // By name, so that a key of `[solver]` that nothing uses does not compile.
        let SolverPlan {
            tolerance,
            engine: _,
            cells: _,
            springs: _,
            time_rule: _,
        } = self.solver;
        SolverSettings {
            tolerance: tolerance.unwrap_or(instant_tolerance::OF_A_HISTORY),
            max_iterations: SolverSettings::default().max_iterations,
        }
    }

    /// The cells that the engine solves for: a quarter of the domain where that holds all of it.
    fn grid(&self, growths: usize) -> Result<Grid, EngineError> {
        let grid = self.field_grid(self.solver.cells, growths)?;
        if self.indenter.is_periodic() {
            return Ok(grid);
        }
        Ok(domain::quarter_of(self.indenter.as_ref(), &grid).unwrap_or(grid))
    }

    /// The operator on a domain enlarged `growths` times; before it is enlarged, one for all engines.
    fn operator(&self, growths: usize) -> Result<Arc<Convolution>, EngineError> {
        let built = |grid| {
            Convolution::on(grid, self.layer.clone()).map_err(|e| EngineError::Grid(e.to_string()))
        };
        match self.grid {
            Some(grid) if growths == 0 => {
                let mut shared = self.operator.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some(operator) = &*shared {
                    return Ok(Arc::clone(operator));
                }
                let operator = Arc::new(built(grid)?);
                Ok(Arc::clone(shared.insert(operator)))
            }
            _ => Ok(Arc::new(built(self.grid(growths)?)?)),
        }
    }
}

/// The indenter as a body of revolution, which springs take.
///
/// # Errors
/// [`EngineError::NotAxisymmetric`] of another.
pub(crate) fn body_of_revolution(
    indenter: &dyn Indenter,
) -> Result<&dyn indenter::Axisymmetric, EngineError> {
    let refusal = || EngineError::NotAxisymmetric {
        shape: indenter.shape(),
        reason: indenter.not_axisymmetric_because(),
    };
    indenter.axisymmetric().ok_or_else(refusal)
}

/// A value of a drive as what it prescribes at an instant.
pub fn prescribed(control: Control, value: f64) -> Prescribed {
    match control {
        Control::Load => Prescribed::LoadN(value),
        Control::Approach => Prescribed::ApproachM(value),
    }
}

/// Half the side (m) of the square that no contact leaves while a drive stays below its maximum; for springs, the radius about
/// the indenter's own axis.
fn contact_half_width_m(indenter: &dyn Indenter, largest: LargestContact) -> f64 {
    let maximum = largest.maximum;
    match (largest.control, indenter.axisymmetric()) {
        (Control::Load, _) => indenter.elastic_half_width_m(maximum, largest.compliance_per_pa),
        (Control::Approach, Some(body)) => indenter::radius_under_approach_m(body, maximum),
        (Control::Approach, None) => {
            let (x_m, y_m) = indenter.half_widths_under_approach_m(maximum);
            x_m.max(y_m)
        }
    }
}

/// The domain that holds the largest contact: under load control the indenter's own, under approach control as far as the
/// approach reaches, unless the indenter comes with cells of its own.
fn contact_domain(indenter: &dyn Indenter, largest: LargestContact) -> Domain {
    let mut domain = indenter.domain(largest.maximum.max(0.0), largest.compliance_per_pa);
    if let Control::Approach = largest.control
        && let Domain::Around { half_widths_m, .. } = &mut domain
    {
        let (x_m, y_m) = indenter.half_widths_under_approach_m(largest.maximum);
        // Cells have a length, also where no contact is to be expected.
        *half_widths_m = (x_m.max(SMALLEST_M), y_m.max(SMALLEST_M));
    }
    domain
}

/// Why a drive that presses the indenter in to this approach (m) came to no contact at all.
pub(crate) fn missed_contact(approach_m: f64) -> String {
    format!(
        "the indenter is pressed in by up to {approach_m:.3e} m and yet no cell came into contact: its lowest point lies between \
         cells that are too large for so small a contact (give more solver.cells; if the indenter lies off the origin, a smaller \
         offset, since the cells reach from there to it)"
    )
}
