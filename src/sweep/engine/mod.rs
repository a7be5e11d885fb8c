//! Engines on a domain: how large it must be, the operator all engines share, and a larger one where the contact reaches the
//! edge after all.

pub mod domain;
pub mod growing;
mod layered;
pub mod slope;

use std::sync::{Arc, Mutex, PoisonError};

use crate::contact::axisymmetric::{self, Axisymmetric};
use crate::contact::half_space::convolution::Convolution;
use crate::contact::half_space::grid::Grid;
use crate::contact::half_space::layer::{Layer, LayerInfluence};
use crate::contact::half_space::periodic::{Periodic, PeriodicOperator};
use crate::contact::half_space::{HalfSpace, SolverSettings, predicted_memory_bytes};
use crate::contact::{ContactError, Engine, Prescribed};
use crate::drive::Control;
use crate::indenter::{self, Domain, Indenter};
use crate::sweep::engine::domain::GROWTH;
use crate::sweep::engine::growing::Layout;
use crate::sweep::plan::instant_tolerance;
use crate::sweep::plan::{EngineKind, SolverPlan};

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
        "a layer is solved with a Poisson ratio that does not depend on time, and the material has a constant bulk modulus: write \
         poisson_ratio in place of bulk_modulus"
    )]
    LayerOfConstantBulkModulus,
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
    period: Mutex<Option<Arc<PeriodicOperator>>>,
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
        let half_width_m = contact_half_width_m(indenter.as_ref(), largest);
        let mut builder = Self {
            domain,
            indenter,
            solver,
            layer,
            half_width_m,
            extremes_m: None,
            grid: None,
            operator: Mutex::new(None),
            period: Mutex::new(None),
        };
        match solver.engine {
            EngineKind::Axisymmetric => {
                if builder.body()?.contact_limit_m().is_none() {
                    builder.half_width_m *= SPRING_ROOM;
                }
            }
            EngineKind::HalfSpace => {
                builder.grid = Some(builder.grid(0)?);
            }
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
    pub(in crate::sweep) fn scaled(&self, factor: f64) -> Result<Self, EngineError> {
        let domain = domain::scaled(&self.domain, factor);
        let mut builder = Self {
            indenter: Arc::clone(&self.indenter),
            solver: self.solver,
            layer: self.layer.clone(),
            half_width_m: factor * self.half_width_m,
            extremes_m: None,
            domain,
            grid: None,
            operator: Mutex::new(None),
            period: Mutex::new(None),
        };
        if self.grid.is_some() {
            builder.grid = Some(builder.grid(0)?);
        }
        Ok(builder)
    }

    /// How often the domain can be halved and still hold a contact no larger than this: not at all, where the contact might not
    /// grow outwards from there.
    pub(in crate::sweep) fn halvings_to(&self, first: LargestContact) -> usize {
        /// Room beyond the first contact, whose size is an estimate.
        const ROOM: f64 = 1.15;
        let own = matches!(self.domain, Domain::Cells { .. });
        let ends = self
            .body()
            .is_ok_and(|body| body.contact_limit_m().is_some());
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

    /// Half width (m) of the domain, and whether it can be wider.
    pub(in crate::sweep) fn reach(&self) -> (f64, bool) {
        self.enlarged_half_width_m(0)
    }

    /// Where the nodes are.
    pub(in crate::sweep) fn layout(&self) -> Layout {
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

    /// Memory (bytes) that a march of an engine takes with so many memory variables per node; that of springs is a guess on the
    /// safe side.
    pub fn predicted_memory_bytes(&self, branches: usize) -> u64 {
        /// Fields of springs in engine and march.
        const FIELDS: usize = 12;
        match &self.grid {
            Some(grid) => predicted_memory_bytes(grid, branches),
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
    fn enlarged_half_width_m(&self, growths: usize) -> (f64, bool) {
        let known_m = match self.solver.engine {
            EngineKind::HalfSpace => {
                let half_width_m = domain::half_width_m(&self.domain, growths);
                return (half_width_m, domain::can_grow(&self.domain, growths));
            }
            EngineKind::Axisymmetric => self.body().ok().and_then(|body| body.known_radius_m()),
        };
        let wanted_m = self.half_width_m * GROWTH.powi(growths as i32);
        match known_m {
            Some(known_m) if known_m <= wanted_m => (known_m, false),
            _ => (wanted_m, true),
        }
    }

    /// The cells of fields: the grid that the half-space engine would have on a domain enlarged `growths` times, with this
    /// many cells per side.
    ///
    /// # Errors
    /// [`EngineError::Grid`].
    pub fn field_grid(&self, cells: usize, growths: usize) -> Result<Grid, EngineError> {
        domain::grid(&self.domain, cells, growths).map_err(|e| EngineError::Grid(e.to_string()))
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

    /// Calls `run` with an engine, on ever larger domains as long as it reports that the contact reached the edge; the first is
    /// enlarged `growths` times. `started` hears the half width (m) of each domain and how often it was enlarged.
    ///
    /// # Errors
    /// What `run` or the building of an engine ends with.
    pub fn on_a_large_enough_domain<T, E>(
        &self,
        mut growths: usize,
        mut started: impl FnMut(f64, usize),
        mut run: impl FnMut(&mut dyn Engine) -> Result<T, E>,
    ) -> Result<T, E>
    where
        E: From<EngineError> + AsContactError,
    {
        loop {
            let mut engine = self.engine(growths)?;
            let (half_width_m, can_grow) = self.enlarged_half_width_m(growths);
            started(half_width_m, growths);
            let error = match run(engine.as_mut()) {
                Err(error) if reached_edge(&error) => error,
                ended => return ended,
            };
            if !can_grow {
                return Err(EngineError::EndOfData { half_width_m }.into());
            }
            if growths >= MAX_GROWTHS {
                return Err(error);
            }
            growths += 1;
        }
    }

    fn body(&self) -> Result<&dyn indenter::Axisymmetric, EngineError> {
        let refusal = || EngineError::NotAxisymmetric {
            shape: self.indenter.shape(),
            reason: self.indenter.not_axisymmetric_because(),
        };
        self.indenter.axisymmetric().ok_or_else(refusal)
    }

    fn springs(&self, growths: usize) -> Result<Axisymmetric, EngineError> {
        let body = self.body()?;
        let springs = self.solver.springs;
        let end_m = self.enlarged_half_width_m(growths).0;
        let extremes_m = self.extremes_m.filter(|_| growths == 0);
        let places_m = spring_places_m(end_m, extremes_m, springs);
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
        Ok(if self.indenter.ends_in_data() {
            engine.ending_in_data()
        } else {
            engine
        })
    }

    fn periodic(&self, grid: Grid) -> Periodic {
        let gaps = domain::gaps_m(self.indenter.as_ref(), &grid);
        let mut shared = self.period.lock().unwrap_or_else(PoisonError::into_inner);
        let operator = shared.get_or_insert_with(|| Arc::new(PeriodicOperator::new(grid)));
        Periodic::new(Arc::clone(operator), gaps, self.settings())
    }

    fn settings(&self) -> SolverSettings {
        SolverSettings {
            tolerance: (self.solver.tolerance).unwrap_or(instant_tolerance::OF_A_HISTORY),
            ..SolverSettings::default()
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

/// Errors that may be those of an instant.
pub trait AsContactError {
    /// The instant's error, where this is one.
    fn as_contact_error(&self) -> Option<&ContactError>;
}

fn reached_edge(error: &impl AsContactError) -> bool {
    matches!(
        error.as_contact_error(),
        Some(ContactError::ReachedEdge { .. })
    )
}

/// A value of a drive as what it prescribes at an instant.
pub fn prescribed(control: Control, value: f64) -> Prescribed {
    match control {
        Control::Load => Prescribed::LoadN(value),
        Control::Approach => Prescribed::ApproachM(value),
    }
}

/// Where springs begin and end, from the axis to `end_m`. Where the contacts between which a cycle swings are known, half of the
/// springs or more lie where the edge of the contact moves, so that however little it moves they resolve it, and it turns
/// where one of them ends, whatever their number: errors of different numbers of springs then differ by their order alone. Half
/// of these lie beyond the contact under the mean: above the spectrum a strongly relaxing body hardly lets the edge move there,
/// and the force falls to zero, and the pressure has its peak, within as little.
fn spring_places_m(end_m: f64, extremes_m: Option<[f64; 3]>, springs: usize) -> Vec<f64> {
    /// Of the springs within the largest contact, the most that lie where contact never ends.
    const FIXED: f64 = 0.5;
    /// Parts of the largest contact narrower than this have no springs of their own.
    const NARROWEST: f64 = 1e-12;
    let evenly = |from_m: f64, to_m: f64, count: usize| {
        let width_m = (to_m - from_m) / count as f64;
        (0..count).map(move |i| from_m + i as f64 * width_m)
    };
    let uniform = || evenly(0.0, end_m, springs).chain([end_m]).collect();
    let Some([always_m, mean_m, largest_m]) = extremes_m else {
        return uniform();
    };
    let is_narrow = |from_m: f64, to_m: f64| to_m - from_m <= NARROWEST * largest_m;
    if largest_m >= end_m || is_narrow(mean_m, largest_m) || is_narrow(always_m, mean_m) {
        return uniform();
    }
    let count = |part: f64| (springs as f64 * part).round() as usize;
    let fixed = count((always_m / largest_m).min(FIXED));
    let always_m = if fixed > 0 { always_m } else { 0.0 };
    let beyond = (springs - fixed) / 2;
    let mut places_m: Vec<f64> = evenly(0.0, always_m, fixed)
        .chain(evenly(always_m, mean_m, springs - fixed - beyond))
        .chain(evenly(mean_m, largest_m, beyond))
        .chain([largest_m])
        .collect();
    // Past the largest, for what discretisation adds, springs grow as fast as they may.
    let (mut place_m, mut width_m) = (largest_m, (largest_m - mean_m) / beyond as f64);
    while place_m < end_m {
        place_m = (place_m + width_m).min(end_m);
        width_m *= 2.0;
        places_m.push(place_m);
    }
    places_m
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
    let own = indenter.domain(largest.maximum.max(0.0), largest.compliance_per_pa);
    match (largest.control, own) {
        (
            Control::Approach,
            Domain::Around {
                cell_aspect_ratio,
                limit_m,
                ..
            },
        ) => {
            let (half_width_x_m, half_width_y_m) =
                indenter.half_widths_under_approach_m(largest.maximum);
            Domain::Around {
                // Cells have a length, also where no contact is to be expected.
                half_width_x_m: half_width_x_m.max(SMALLEST_M),
                half_width_y_m: half_width_y_m.max(SMALLEST_M),
                cell_aspect_ratio,
                limit_m,
            }
        }
        (_, own) => own,
    }
}

/// Why a drive that presses the indenter in to this approach (m) came to no contact at all.
pub(in crate::sweep) fn missed_contact(approach_m: f64) -> String {
    format!(
        "the indenter is pressed in by up to {approach_m:.3e} m and yet no cell came into contact: its lowest point lies between \
         cells that are too large for so small a contact (give more solver.cells; if the indenter lies off the origin, a smaller \
         offset, since the cells reach from there to it)"
    )
}
