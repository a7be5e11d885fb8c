//! One case of a sweep: the stabilised cycle at the resolution asked for, and at coarser ones for its error bars.

pub(crate) mod accuracy;
mod attracted;
pub mod checkpoint;
mod cycles;
mod edge_layer;
mod levels;
mod lift_off;
mod outside_model;
mod pressure;
mod recording;
mod replicas;
mod solid;
mod stabilise;
mod tangent_radius;

use std::cell::RefCell;
use std::collections::HashMap;
use std::hash::{Hash, Hasher};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::contact::ContactError;
use crate::drive::{Control, HarmonicDrive};
use crate::engine::EngineKind;
use crate::engine::instant_tolerance;
use crate::engine::{EngineBuilder, EngineError, LargestContact};
use crate::material::{Creep, Material};
use crate::sweep::case::checkpoint::Checkpoints;
use crate::sweep::case::levels::{Effort, Levels};
pub use crate::sweep::case::recording::sample;
use crate::sweep::case::solid::Solid;
use crate::sweep::case::stabilise::{CaseError, Contact, Stabilised, Wanted};
use crate::sweep::plan::check::check_positive;
use crate::sweep::plan::layer::LayerPlan;
pub use crate::sweep::plan::setup::SetupError;
use crate::sweep::plan::{Case, Condition, CyclePlan, SweepPlan};
use crate::sweep::record::{CaseRecord, CaseResult, Status};
use crate::sweep::store::entry::Purpose;

/// What all cases of a sweep share.
pub struct Setup {
    plan: SweepPlan,
    solids: Mutex<Solids>,
    engines: Mutex<HashMap<EngineKey, Arc<EngineBuilder>>>,
    /// Ends an instant under way, where the engine's instants are long.
    interrupt: Option<Arc<AtomicBool>>,
}

/// Solids by the address of their material, which is kept so that no other takes its place.
type Solids = HashMap<usize, (Arc<Material>, Arc<Solid>)>;

/// What engines differ in.
#[derive(Debug, Clone, Copy, PartialEq)]
struct EngineKey {
    /// Its address.
    indenter: usize,
    /// Springs or cells.
    nodes: usize,
    /// The largest value of the drive.
    largest: f64,
    relaxed_per_pa: f64,
    poisson_ratio: Option<f64>,
    layer: Option<LayerPlan>,
}

/// Every number is one, as the plan was checked.
impl Eq for EngineKey {}

impl Hash for EngineKey {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.indenter, self.nodes).hash(state);
        [self.largest, self.relaxed_per_pa]
            .map(f64::to_bits)
            .hash(state);
    }
}

/// Steps per cycle, and springs or cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Resolution {
    pub steps: usize,
    pub nodes: usize,
}

impl Resolution {
    pub fn of(record: &CaseRecord) -> Self {
        Self {
            steps: record.steps,
            nodes: record.nodes,
        }
    }
}

/// What a case is solved for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Aim {
    pub wanted: Wanted,
    /// In place of the resolution of the plan: that of cases nearby, whose error bars hold for this one too.
    pub at: Option<Resolution>,
}

impl Aim {
    /// All that the sweep's plan asks for.
    pub const PLAN: Self = Self {
        wanted: Wanted::Everything,
        at: None,
    };

    /// The loss alone, as this resolution gives it, between cases whose error bars hold for it too.
    pub fn loss(at: Resolution) -> Self {
        Self {
            wanted: Wanted::Loss,
            at: Some(at),
        }
    }

    /// Where the record belongs.
    pub fn purpose(self) -> Purpose {
        match self.wanted {
            Wanted::Everything => Purpose::Sweep,
            Wanted::Numbers | Wanted::Loss => Purpose::Peak,
        }
    }
}

impl Setup {
    /// Checks the plan against the physics and prepares what the cases share.
    ///
    /// # Errors
    /// [`SetupError`] where a value is out of its range, the material cannot make a contact or has no stabilised cycle, or the engine cannot treat the
    /// indenter.
    pub fn new(mut plan: SweepPlan) -> Result<Self, SetupError> {
        plan.check()?;
        plan.solver = (plan.solver).on_own_cells(plan.base.contact.indenter.as_ref());
        let setup = Self {
            solids: Mutex::default(),
            engines: Mutex::default(),
            interrupt: None,
            plan,
        };
        for condition in setup.plan.conditions() {
            setup.engines(condition, setup.plan.solver.nodes())?;
        }
        Ok(setup)
    }

    /// The same, with the flag handed to [`Setup::run`] known to the engines too, so that it is heard within an instant.
    #[must_use]
    pub fn interrupted_by(mut self, flag: Arc<AtomicBool>) -> Self {
        self.interrupt = Some(flag);
        self
    }

    /// The plan.
    pub fn plan(&self) -> &SweepPlan {
        &self.plan
    }

    /// The solid that the material of a condition is, made once.
    ///
    /// # Errors
    /// As [`Setup::new`], of a condition that is none of the plan.
    pub(crate) fn solid(&self, condition: &Condition) -> Result<Arc<Solid>, SetupError> {
        let key = Arc::as_ptr(&condition.contact.material).addr();
        let mut solids = locked(&self.solids);
        if let Some((_, solid)) = solids.get(&key) {
            return Ok(Arc::clone(solid));
        }
        let solid = Arc::new(Solid::new(&condition.contact.material)?);
        let kept = (Arc::clone(&condition.contact.material), Arc::clone(&solid));
        solids.insert(key, kept);
        Ok(solid)
    }

    /// Engines for a condition with this many springs or cells, built once.
    ///
    /// # Errors
    /// As [`Setup::new`].
    pub fn engines(
        &self,
        condition: &Condition,
        nodes: usize,
    ) -> Result<Arc<EngineBuilder>, SetupError> {
        let relaxed_per_pa = self.solid(condition)?.relaxed_per_pa;
        let key = EngineKey {
            indenter: Arc::as_ptr(&condition.contact.indenter).addr(),
            nodes,
            // Zero has a sign, of which a hash knows.
            largest: condition.drive.maximum() + condition.drive.pull_off_n() + 0.0,
            relaxed_per_pa,
            poisson_ratio: condition.contact.material.poisson_ratio(),
            layer: condition.contact.layer,
        };
        let mut engines = locked(&self.engines);
        if let Some(builder) = engines.get(&key) {
            return Ok(Arc::clone(builder));
        }
        let builder = Arc::new(self.new_engines(condition, relaxed_per_pa, nodes)?);
        engines.insert(key, Arc::clone(&builder));
        Ok(builder)
    }

    /// Tolerance of an instant of a cycle.
    pub(crate) fn instant_tolerance(
        &self,
        compliance: &Creep,
        drive: &HarmonicDrive,
        angular_frequency_rad_per_s: f64,
        cycle_tolerance: f64,
    ) -> f64 {
        let omega = angular_frequency_rad_per_s;
        let needed = || instant_tolerance::for_cycle(compliance, drive, omega, cycle_tolerance);
        self.plan.solver.tolerance.unwrap_or_else(needed)
    }

    fn new_engines(
        &self,
        condition: &Condition,
        relaxed_per_pa: f64,
        nodes: usize,
    ) -> Result<EngineBuilder, EngineError> {
        condition
            .contact
            .check_attraction(self.plan.solver.engine)?;
        let largest = LargestContact::of(&condition.drive, relaxed_per_pa);
        let solver = self.plan.solver.with_nodes(nodes);
        let layer = LayerPlan::for_body(
            condition.contact.layer,
            condition.contact.material.poisson_ratio(),
        )?;
        EngineBuilder::on(
            layer,
            Arc::clone(&condition.contact.indenter),
            solver,
            largest,
        )
    }

    /// Engines for a case: those of its drive, with springs laid out for its cycle.
    fn engines_of_case(
        &self,
        contact: &Contact<'_>,
        nodes: usize,
    ) -> Result<Arc<EngineBuilder>, SetupError> {
        let drive = &contact.condition.drive;
        // On the way to the stabilised cycle the contact may be smaller than it ever is in that.
        let is_transient = contact.cycle.at_cycle.is_some();
        if is_transient || self.plan.solver.engine == EngineKind::HalfSpace {
            return self.engines(contact.condition, nodes);
        }
        let relaxed = contact.solid.relaxed_per_pa;
        let under = |maximum: f64| LargestContact {
            maximum: maximum + drive.pull_off_n(),
            ..LargestContact::of(drive, relaxed)
        };
        let compliance = &contact.solid.compliance;
        let answer = compliance.complex_compliance(contact.angular_frequency_rad_per_s);
        // |C*| / C_inf under load control, |E*| / E_inf under approach control.
        let (always, largest) = match drive.control() {
            // The largest contact grows without falling until it is reached (E. H. Lee and J. R. M. Radok, J. Appl. Mech. 27
            // (1960) 438); the least is that of the least load held for ever.
            Control::Load => (
                drive.mean() - drive.amplitude(),
                drive.true_mean() + drive.above_true_mean() * answer.norm() / relaxed,
            ),
            // A spring is always in contact where the force of the mean is larger than its oscillation.
            Control::Approach => (
                drive.mean() - drive.amplitude() * relaxed / answer.norm(),
                drive.maximum(),
            ),
        };
        let builder = self.new_engines(contact.condition, relaxed, nodes)?;
        Ok(Arc::new(builder.over_cycle(
            [always, drive.true_mean(), largest].map(under),
        )))
    }

    /// Runs one case to its record; `None` where it was interrupted.
    pub fn run(&self, case: &Case, interrupt: &AtomicBool) -> Option<CaseRecord> {
        self.run_for(Aim::PLAN, None, case, interrupt)
    }

    /// As [`Setup::run`], for the numbers of the cycle alone: no error bars, no fields, no replicas of the material.
    pub fn numbers(&self, case: &Case, interrupt: &AtomicBool) -> Option<CaseRecord> {
        let aim = Aim {
            wanted: Wanted::Numbers,
            at: None,
        };
        self.run_for(aim, None, case, interrupt)
    }

    /// As [`Setup::run`], from the checkpoints that an earlier run of the same case has left; the record is the same, bit for
    /// bit. An interruption leaves new ones.
    pub fn run_from(
        &self,
        checkpoints: &Checkpoints,
        case: &Case,
        interrupt: &AtomicBool,
    ) -> Option<CaseRecord> {
        self.run_for(Aim::PLAN, Some(checkpoints), case, interrupt)
    }

    /// As [`Setup::run_from`], for what the record is wanted for.
    pub(crate) fn run_for(
        &self,
        aim: Aim,
        checkpoints: Option<&Checkpoints>,
        case: &Case,
        interrupt: &AtomicBool,
    ) -> Option<CaseRecord> {
        let mut cycle = self.plan.cycle;
        let mut nodes = self.plan.solver.nodes();
        if let Some(accuracy) = cycle.accuracy {
            cycle.tolerance = cycle.tolerance.min(0.1 * accuracy);
        }
        if let Some(at) = aim.at {
            (cycle.steps, nodes) = (at.steps, at.nodes);
        }
        if aim.wanted != Wanted::Everything {
            (cycle.error_bars, cycle.accuracy) = (false, None);
        }
        let mut effort = Effort::at(Resolution {
            steps: cycle.steps,
            nodes,
        });
        let ended = self.solve(aim, (case, cycle), (checkpoints, interrupt), &mut effort);
        if let Err(CaseError::Contact(ContactError::Interrupted)) = ended {
            if let Some(checkpoints) = checkpoints {
                checkpoints.flush();
            }
            return None;
        }
        Some(self.record(case, cycle, effort, ended))
    }

    fn solve(
        &self,
        aim: Aim,
        (case, cycle): (&Case, CyclePlan),
        (checkpoints, interrupt): (Option<&Checkpoints>, &AtomicBool),
        effort: &mut Effort,
    ) -> Result<Stabilised, CaseError> {
        check_positive(
            "angular frequency",
            case.angular_frequency_rad_per_s,
            "rad/s",
        )
        .map_err(SetupError::from)?;
        let solid = self.solid(&case.condition)?;
        let contact = Contact {
            solid: &solid,
            compliance: &solid.compliance,
            condition: &case.condition,
            angular_frequency_rad_per_s: case.angular_frequency_rad_per_s,
            time_rule: self.plan.solver.time_rule,
            cycle,
            interrupt,
            checkpoints,
            marches_at_last: true,
            wanted: aim.wanted,
        };
        let mut levels = Levels {
            setup: self,
            contact,
            effort,
            attracted: RefCell::default(),
            found: RefCell::default(),
        };
        let mut found = match cycle.accuracy {
            Some(accuracy) => levels.within_accuracy(accuracy)?,
            None => levels.at_resolution()?,
        };
        if aim.wanted == Wanted::Everything
            && let Some(result) = &mut found.result
        {
            let (losses_j, note) = levels.replica_losses_j(result.analysis.energy_loss_j)?;
            result.replica_losses_j = losses_j;
            found.message = found.message.or(note);
        }
        Ok(found)
    }

    /// The record of a case that ended like this.
    fn record(
        &self,
        case: &Case,
        cycle: CyclePlan,
        effort: Effort,
        ended: Result<Stabilised, CaseError>,
    ) -> CaseRecord {
        let (found, error) = match ended {
            Ok(found) => (found, None),
            Err(error) => (Stabilised::none(cycle.method), Some(error.to_string())),
        };
        let not_finite = || {
            let is_finite = found.result.as_ref().is_none_or(CaseResult::is_finite);
            (!is_finite).then(|| CaseResult::NOT_FINITE.to_owned())
        };
        let error = error.or_else(not_finite);
        let mut result = found.result.filter(|_| error.is_none());
        if let (Some(result), false) = (&mut result, self.plan.is_small()) {
            result.cycle.round_profiles();
        }
        let (condition, omega) = (&case.condition, case.angular_frequency_rad_per_s);
        let at = effort.at;
        let wants_bars = cycle.error_bars || cycle.accuracy.is_some();
        let of_case = (omega, at.steps);
        CaseRecord {
            index: case.index,
            angular_frequency_rad_per_s: omega,
            varied: condition.values,
            drive_mean: condition.drive.mean(),
            drive_amplitude: condition.drive.amplitude(),
            status: match (&error, &result, cycle.at_cycle) {
                (Some(_), _, _) => Status::Failed,
                (None, Some(_), None) => Status::Converged,
                (None, Some(_), Some(_)) => Status::Transient,
                (None, None, _) => Status::NotConverged,
            },
            message: error.or(found.message),
            warnings: outside_model::warnings(
                &self.plan.solver,
                condition,
                of_case,
                result.as_ref(),
                wants_bars,
            ),
            method: found.method,
            steps: at.steps,
            nodes: at.nodes,
            cycles: found.cycles,
            steady_distance: found.distance.filter(|distance| distance.is_finite()),
            domain_half_width_m: match effort.domain_half_width_m.is_finite() {
                true => effort.domain_half_width_m,
                false => 0.0,
            },
            domain_enlarged: effort.domain_enlarged,
            work: effort.work,
            result,
        }
    }
}

/// What a lock protects, whatever became of the thread that held it, since entries are made before they are put in.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
