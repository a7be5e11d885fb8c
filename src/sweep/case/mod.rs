//! One case of a sweep: the stabilised cycle at the resolution asked for, and at coarser ones for its error bars.

pub mod checkpoint;
mod edge_layer;
mod outside_model;
mod pressure;
mod replicas;
mod solid;
mod stabilise;
mod tangent_radius;

use std::collections::HashMap;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::contact::{ContactError, Engine};
use crate::drive::{Control, DriveError, HarmonicDrive};
use crate::history::{Work, order_of_steps};
use crate::material::{Creep, Material, MaterialError};
use crate::sweep::case::checkpoint::Checkpoints;
use crate::sweep::case::edge_layer::EdgeLayer;
use crate::sweep::case::solid::Solid;
#[cfg(feature = "report")]
pub(crate) use crate::sweep::case::stabilise::sample;
use crate::sweep::case::stabilise::{CaseError, Contact, Stabilised, Wanted};
use crate::sweep::engine::{EngineBuilder, EngineError, LargestContact};
use crate::sweep::plan::check::{PlanError, check_frequency};
use crate::sweep::plan::instant_tolerance;
use crate::sweep::plan::{Case, Condition, CyclePlan, EngineKind, SweepPlan};
use crate::sweep::record::error_bars::{Bar, ErrorBars, InNodes, Ladder, Pair, Quantity};
use crate::sweep::record::{CaseRecord, CaseResult, Status};
use crate::sweep::store::archive::Purpose;

/// Why a sweep cannot be set up.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SetupError {
    #[error(transparent)]
    Plan(#[from] PlanError),
    #[error(transparent)]
    Drive(#[from] DriveError),
    #[error(transparent)]
    Material(#[from] MaterialError),
    #[error(
        "the material is a fluid: under a mean load it creeps without end, and no stabilised cycle exists; give it an \
         equilibrium modulus above zero"
    )]
    Fluid,
    #[error(transparent)]
    Engine(#[from] EngineError),
}

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

/// What engines differ in: the indenter by its address, the largest value of the drive, the relaxed compliance and the layer bit for
/// bit, and the number of springs or cells.
type EngineKey = (usize, [u64; 7], usize);

/// Steps per cycle, and springs or cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::sweep) struct Resolution {
    pub steps: usize,
    pub nodes: usize,
}

/// What a case is solved for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::sweep) enum Aim {
    /// All that the sweep's plan asks for.
    Plan,
    /// The numbers of the cycle alone, at the resolution of the plan.
    Numbers,
    /// The loss alone, as this resolution gives it, between cases whose error bars hold for it too.
    Loss(Resolution),
}

impl Aim {
    /// Where the record belongs.
    pub fn purpose(self) -> Purpose {
        match self {
            Self::Plan => Purpose::Sweep,
            Self::Numbers | Self::Loss(_) => Purpose::Peak,
        }
    }
}

/// Results on one number of nodes, by the number of steps: the finest last.
struct Solved {
    nodes: usize,
    cycles: Vec<(usize, Stabilised)>,
}

/// The domain last tried: half width (m), and how often it was enlarged.
#[derive(Debug, Clone, Copy, Default)]
struct Domain {
    half_width_m: f64,
    growths: usize,
}

/// Fewest steps and nodes that a coarser resolution may have: below, a cycle has no shape, and its error says nothing.
const FEWEST_STEPS: usize = 8;
const FEWEST_NODES: usize = 12;

impl Setup {
    /// Checks the plan against the physics and prepares what the cases share.
    ///
    /// # Errors
    /// [`SetupError`] where a value is out of its range, the material cannot make a contact or has no stabilised cycle, or the engine cannot treat the
    /// indenter.
    pub fn new(mut plan: SweepPlan) -> Result<Self, SetupError> {
        plan.check()?;
        plan.contact = plan.contact.on_own_cells();
        let setup = Self {
            solids: Mutex::default(),
            engines: Mutex::default(),
            interrupt: None,
            plan,
        };
        for condition in setup.plan.conditions().iter() {
            setup.engines(condition, setup.plan.contact.solver.nodes())?;
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
    pub(in crate::sweep) fn solid(&self, condition: &Condition) -> Result<Arc<Solid>, SetupError> {
        let key = Arc::as_ptr(&condition.material).addr();
        let mut solids = whole(&self.solids);
        if let Some((_, solid)) = solids.get(&key) {
            return Ok(Arc::clone(solid));
        }
        let solid = Arc::new(Solid::new(&condition.material)?);
        let kept = (Arc::clone(&condition.material), Arc::clone(&solid));
        solids.insert(key, kept);
        Ok(solid)
    }

    /// Engines for a condition with so many springs or cells, built once.
    ///
    /// # Errors
    /// As [`Setup::new`].
    pub fn engines(
        &self,
        condition: &Condition,
        nodes: usize,
    ) -> Result<Arc<EngineBuilder>, SetupError> {
        let relaxed_per_pa = self.solid(condition)?.relaxed_per_pa;
        let indenter = Arc::as_ptr(&condition.indenter).addr();
        let layer = condition.layer;
        let base = layer.and_then(|layer| layer.yielding);
        let numbers = [
            condition.drive.maximum() + condition.drive.pull_off_n(),
            relaxed_per_pa,
            layer.map_or(0.0, |layer| layer.thickness_m),
            layer.map_or(0.0, |layer| f64::from(layer.base as u8)),
            base.map_or(0.0, |base| base.modulus_ratio),
            base.map_or(0.0, |base| base.poisson_ratio),
            condition.material.poisson_ratio().unwrap_or(f64::NAN),
        ];
        let numbers = numbers.map(f64::to_bits);
        let key = (indenter, numbers, nodes);
        let mut engines = whole(&self.engines);
        if let Some(builder) = engines.get(&key) {
            return Ok(Arc::clone(builder));
        }
        let builder = Arc::new(self.new_engines(condition, relaxed_per_pa, nodes)?);
        engines.insert(key, Arc::clone(&builder));
        Ok(builder)
    }

    /// Tolerance of an instant of a cycle.
    pub(in crate::sweep) fn instant_tolerance(
        &self,
        compliance: &Creep,
        drive: &HarmonicDrive,
        angular_frequency_rad_per_s: f64,
        cycle_tolerance: f64,
    ) -> f64 {
        let omega = angular_frequency_rad_per_s;
        let needed = || instant_tolerance::of_a_cycle(compliance, drive, omega, cycle_tolerance);
        self.plan.contact.solver.tolerance.unwrap_or_else(needed)
    }

    fn new_engines(
        &self,
        condition: &Condition,
        relaxed_per_pa: f64,
        nodes: usize,
    ) -> Result<EngineBuilder, EngineError> {
        // No history within the drive's range makes a larger contact than its maximum held for ever.
        let largest = LargestContact {
            control: condition.drive.control(),
            maximum: condition.drive.maximum() + condition.drive.pull_off_n(),
            compliance_per_pa: relaxed_per_pa,
        };
        let solver = self.plan.contact.solver.with_nodes(nodes);
        let layer = condition.layer.map(|layer| {
            let poisson_ratio = condition.material.poisson_ratio();
            let poisson_ratio = poisson_ratio.ok_or(EngineError::LayerOfConstantBulkModulus)?;
            Ok::<_, EngineError>(layer.of_material(poisson_ratio))
        });
        let layer = layer.transpose()?;
        EngineBuilder::on(layer, Arc::clone(&condition.indenter), solver, largest)
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
        if is_transient || self.plan.contact.solver.engine == EngineKind::HalfSpace {
            return self.engines(contact.condition, nodes);
        }
        let of_drive = |maximum: f64, compliance_per_pa| LargestContact {
            control: drive.control(),
            maximum: maximum + drive.pull_off_n(),
            compliance_per_pa,
        };
        let relaxed = contact.solid.relaxed_per_pa;
        let answer = contact
            .solid
            .compliance
            .complex_compliance(contact.angular_frequency_rad_per_s);
        // |C*| / C_inf under load control, |E*| / E_inf under approach control.
        let mean = of_drive(drive.true_mean(), relaxed);
        let (always, largest) = match drive.control() {
            // The largest contact grows without falling until it is reached (E. H. Lee and J. R. M. Radok, J. Appl. Mech. 27
            // (1960) 438); the least is that of the least load held for ever.
            Control::Load => (
                of_drive(drive.mean() - drive.amplitude(), relaxed),
                of_drive(
                    drive.true_mean() + drive.above_true_mean() * answer.norm() / relaxed,
                    relaxed,
                ),
            ),
            // A spring is always in contact where the force of the mean is larger than its oscillation.
            Control::Approach => (
                of_drive(
                    drive.mean() - drive.amplitude() * relaxed / answer.norm(),
                    relaxed,
                ),
                of_drive(drive.maximum(), relaxed),
            ),
        };
        let builder = self.new_engines(contact.condition, relaxed, nodes)?;
        Ok(Arc::new(builder.over_cycle([always, mean, largest])))
    }

    /// An engine of its own for a condition with so many springs or cells, on the domain before it is enlarged.
    pub(in crate::sweep) fn engine(
        &self,
        condition: &Condition,
        nodes: usize,
    ) -> Result<Box<dyn Engine>, SetupError> {
        Ok(self.engines(condition, nodes)?.engine(0)?)
    }

    /// Runs one case to its record; `None` where it was interrupted.
    pub fn run(&self, case: &Case, interrupt: &AtomicBool) -> Option<CaseRecord> {
        self.run_from(&Checkpoints::none(), case, interrupt)
    }

    /// As [`Setup::run`], for the numbers of the cycle alone: no error bars, no fields, no replicas of the material.
    pub fn numbers(&self, case: &Case, interrupt: &AtomicBool) -> Option<CaseRecord> {
        self.run_for(Aim::Numbers, &Checkpoints::none(), case, interrupt)
    }

    /// As [`Setup::run`], from the checkpoints that an earlier run of the same case has left; the record is the same, bit for
    /// bit. An interruption leaves new ones.
    pub fn run_from(
        &self,
        checkpoints: &Checkpoints,
        case: &Case,
        interrupt: &AtomicBool,
    ) -> Option<CaseRecord> {
        self.run_for(Aim::Plan, checkpoints, case, interrupt)
    }

    /// As [`Setup::run_from`], for what the record is wanted for.
    pub(in crate::sweep) fn run_for(
        &self,
        aim: Aim,
        checkpoints: &Checkpoints,
        case: &Case,
        interrupt: &AtomicBool,
    ) -> Option<CaseRecord> {
        let mut cycle = self.plan.cycle;
        let mut nodes = self.plan.contact.solver.nodes();
        if let Some(accuracy) = cycle.accuracy {
            cycle.tolerance = cycle.tolerance.min(0.1 * accuracy);
        }
        if let Aim::Loss(at) = aim {
            (cycle.steps, nodes) = (at.steps, at.nodes);
        }
        if aim != Aim::Plan {
            (cycle.error_bars, cycle.accuracy) = (false, None);
        }
        let mut record = CaseRecord {
            index: case.index,
            angular_frequency_rad_per_s: case.angular_frequency_rad_per_s,
            varied: case.condition.values,
            drive_mean: case.condition.drive.mean(),
            drive_amplitude: case.condition.drive.amplitude(),
            status: Status::Failed,
            message: None,
            warnings: Vec::new(),
            method: cycle.method,
            steps: cycle.steps,
            nodes,
            cycles: 0,
            steady_distance: None,
            domain_half_width_m: 0.0,
            domain_enlarged: 0,
            work: Work::default(),
            result: None,
        };
        let ended = self.solve_case(aim, (case, cycle), (checkpoints, interrupt), &mut record);
        match ended {
            Ok(()) => {}
            Err(CaseError::Interrupted) => {
                checkpoints.flush();
                return None;
            }
            Err(error) => {
                record.result = None;
                record.status = Status::Failed;
                record.message = Some(error.to_string());
            }
        }
        if let (Some(adhesion), Some(result)) = (&self.plan.contact.adhesion, &mut record.result)
            && let Ok(solid) = self.solid(&case.condition)
        {
            let omega = case.angular_frequency_rad_per_s;
            let modulus_pa = solid.compliance.complex_compliance(omega).norm().recip();
            let pull_off_n = case.condition.drive.pull_off_n();
            result.tabor_parameter = Some(adhesion.tabor_parameter(pull_off_n, modulus_pa));
        }
        let solver = &self.plan.contact.solver;
        record.warnings =
            outside_model::warnings(solver, &case.condition, &record, cycle.error_bars);
        if let (Some(result), false) = (&mut record.result, self.plan.is_small()) {
            result.cycle.round_profiles();
        }
        Some(record)
    }

    fn solve_case(
        &self,
        aim: Aim,
        (case, cycle): (&Case, CyclePlan),
        (checkpoints, interrupt): (&Checkpoints, &AtomicBool),
        record: &mut CaseRecord,
    ) -> Result<(), CaseError> {
        check_frequency(case.angular_frequency_rad_per_s)?;
        let condition = &case.condition;
        let solid = self.solid(condition)?;
        let contact = Contact {
            solid: &solid,
            compliance: &solid.compliance,
            condition,
            angular_frequency_rad_per_s: case.angular_frequency_rad_per_s,
            time_rule: self.plan.contact.solver.time_rule,
            cycle,
            interrupt,
            checkpoints,
            marches_at_last: true,
            wanted: match aim {
                Aim::Plan => Wanted::Everything,
                Aim::Numbers => Wanted::Numbers,
                Aim::Loss(_) => Wanted::Loss,
            },
        };
        match cycle.accuracy {
            Some(accuracy) => self.to_accuracy(&contact, accuracy, record)?,
            None => self.at_resolution(&contact, record)?,
        }
        match aim {
            Aim::Plan => self.add_replicas(&contact, record),
            Aim::Numbers | Aim::Loss(_) => Ok(()),
        }
    }

    /// Solves at the record's own resolution, and at coarser ones where error bars are wanted.
    fn at_resolution(
        &self,
        contact: &Contact<'_>,
        record: &mut CaseRecord,
    ) -> Result<(), CaseError> {
        let fine = Resolution {
            steps: record.steps,
            nodes: record.nodes,
        };
        let bars = contact.cycle.error_bars && self.can_be_coarsened(contact, fine)?;
        let mut steps = vec![fine.steps];
        if bars {
            // From coarse to fine: each number of steps starts the next from its memory.
            steps.insert(0, fine.steps / 2);
            if self.plan.contact.solver.engine == EngineKind::Axisymmetric {
                steps.insert(0, fine.steps / 4);
            }
        }
        let mut domain = Domain::default();
        let solved = self.solve(contact, fine.nodes, &steps, &mut domain);
        (record.domain_half_width_m, record.domain_enlarged) =
            (domain.half_width_m, domain.growths);
        let mut solved = solved?;
        record.take(&mut solved, contact.cycle.at_cycle);
        if record.result.is_none() || !bars {
            return Ok(());
        }
        let errors = self.error_bars(contact, record, &mut solved)?;
        if let Some(result) = &mut record.result {
            result.errors = errors;
            if result.errors.is_none() {
                record.message.get_or_insert_with(|| {
                    "no error bars: no coarser resolution stabilised".to_owned()
                });
            }
        }
        Ok(())
    }

    /// Error bars of a record's result, from what is coarser in steps on the same nodes and coarser in nodes at the same steps.
    /// Where a coarser resolution does not stabilise, one between it and the result takes its place; the order of the error is then
    /// not seen, and the lowest believed is taken. `None` where that fails too.
    fn error_bars(
        &self,
        contact: &Contact<'_>,
        record: &mut CaseRecord,
        solved: &mut Solved,
    ) -> Result<Option<ErrorBars>, CaseError> {
        let (steps, nodes) = (record.steps, record.nodes);
        let between = |fine: usize| 4 * (3 * fine / 16).max(1);
        let mut middle = steps / 2;
        if solved.result(middle).is_none() {
            middle = between(steps);
            let more = self.coarser(contact, nodes, &[middle], record)?;
            solved.cycles.extend(more.cycles);
        }
        if solved.result(middle).is_none() {
            return Ok(None);
        }
        let [half, quarter] = self.coarser_nodes(nodes);
        let mut on_half =
            self.coarser(contact, half, &self.steps_of_coarse(steps, middle), record)?;
        if on_half.result(middle).is_none() {
            on_half = self.coarser(contact, between(nodes), &[middle], record)?;
        }
        let on_quarter = match quarter >= FEWEST_NODES && on_half.nodes == half {
            true => Some(self.coarser(contact, quarter, &[middle], record)?),
            false => None,
        };
        let others = self.of_alternatives(contact, (on_half.nodes, middle), record)?;
        let missing = others.iter().filter(|other| other.result(middle).is_none());
        let missing = missing.count();
        if missing > 0 {
            record.message.get_or_insert_with(|| {
                format!(
                    "the error bars leave out {missing} of the {} materials that fit the data as well: no stabilised cycle was found with them",
                    contact.solid.alternatives.len()
                )
            });
        }
        let own = on_half.result(middle);
        let others = others
            .iter()
            .filter_map(|other| own.zip(other.result(middle)));
        let others: Vec<_> = others.collect();
        let Some(result) = &record.result else {
            return Ok(None);
        };
        // How far a cycle is from the stabilised one is an error of that one alone.
        let of_stabilised = contact.cycle.at_cycle.is_none();
        let distance = record.steady_distance.filter(|_| of_stabilised);
        let mut distance = distance.unwrap_or(0.0);
        if self.plan.contact.solver.engine == EngineKind::HalfSpace {
            distance += instant_tolerance::SHARE * contact.cycle.tolerance;
        }
        let on = [&*solved, &on_half];
        let of_cycle = (distance, others.as_slice());
        let in_nodes = match self.plan.contact.solver.engine {
            EngineKind::Axisymmetric => InNodes::SPRINGS,
            EngineKind::HalfSpace => {
                InNodes::cells(2.0 * record.domain_half_width_m / record.nodes as f64)
            }
        };
        let bars = error_bars(
            (result, steps, middle),
            of_cycle,
            (order_of_steps(&contact.solid.compliance), in_nodes),
            on,
            on_quarter.as_ref(),
        );
        let indenter = contact.condition.indenter.as_ref();
        let relaxation = contact.solid.relaxation.as_ref();
        let layer = relaxation.and_then(|relaxation| EdgeLayer::new(indenter, relaxation));
        Ok(bars.map(|bars| match layer {
            Some(layer) => bars.with_higher_peak(layer.higher_peak_pa(result)),
            None => bars,
        }))
    }

    /// The case at a coarse resolution with each of the materials that the data leave possible.
    fn of_alternatives(
        &self,
        contact: &Contact<'_>,
        (nodes, steps): (usize, usize),
        record: &mut CaseRecord,
    ) -> Result<Vec<Solved>, CaseError> {
        // Checkpoints are of the material itself.
        let checkpoints = Checkpoints::none();
        let with = |compliance| Contact {
            compliance,
            checkpoints: &checkpoints,
            ..*contact
        };
        let alternatives = contact.solid.alternatives.iter();
        alternatives
            .map(|compliance| self.coarser(&with(compliance), nodes, &[steps], record))
            .collect()
    }

    /// A coarser resolution, whose work the record counts; without a result where it fails.
    fn coarser(
        &self,
        contact: &Contact<'_>,
        nodes: usize,
        steps: &[usize],
        record: &mut CaseRecord,
    ) -> Result<Solved, CaseError> {
        let contact = Contact {
            wanted: contact.wanted.min(Wanted::Numbers),
            ..*contact
        };
        let solved = match self.solve(&contact, nodes, steps, &mut Domain::default()) {
            Err(CaseError::Interrupted) => return Err(CaseError::Interrupted),
            Err(_) => Solved {
                nodes,
                cycles: Vec::new(),
            },
            Ok(solved) => solved,
        };
        record.work += solved.work();
        Ok(solved)
    }

    /// Numbers of nodes coarser than this one. On cells, ratios that put the edge of the contact elsewhere between two of them
    /// each time; springs end where the edge turns, whatever their number.
    fn coarser_nodes(&self, nodes: usize) -> [usize; 2] {
        match self.plan.contact.solver.engine {
            EngineKind::Axisymmetric => [nodes / 2, nodes / 4],
            EngineKind::HalfSpace => [5 * nodes / 9, 3 * nodes / 10],
        }
    }

    /// Steps on fewer nodes: as many as the difference between the two needs, and those that tell the order in the steps
    /// where the full number of nodes is too dear for it.
    fn steps_of_coarse(&self, steps: usize, middle: usize) -> Vec<usize> {
        match self.plan.contact.solver.engine {
            EngineKind::HalfSpace if middle == steps / 2 => vec![steps / 4, middle],
            _ => vec![middle],
        }
    }

    /// Whether a coarser resolution exists and means the same contact: an indenter on its own cells has no coarser one.
    fn can_be_coarsened(
        &self,
        contact: &Contact<'_>,
        fine: Resolution,
    ) -> Result<bool, SetupError> {
        let engines = self.engines(contact.condition, fine.nodes)?;
        Ok(fine.steps / 4 >= FEWEST_STEPS
            && fine.nodes / 2 >= FEWEST_NODES
            && !engines.has_cells_of_its_own())
    }

    /// Chooses steps and nodes such that the error of the loss stays below `accuracy` of it, at the least cost.
    fn to_accuracy(
        &self,
        contact: &Contact<'_>,
        accuracy: f64,
        record: &mut CaseRecord,
    ) -> Result<(), CaseError> {
        /// Each refinement is foretold from the last one's error; where an error falls more slowly than foretold, it takes more.
        const ROUNDS: usize = 8;
        (record.steps, record.nodes) = match self.plan.contact.solver.engine {
            EngineKind::Axisymmetric => (64, 64),
            EngineKind::HalfSpace => (48, 64),
        };
        let mut contact = *contact;
        contact.cycle.error_bars = true;
        let (mut work, mut failure) = (Work::default(), None);
        for _ in 0..ROUNDS {
            let ended = self.at_resolution(&contact, record);
            work += record.work;
            record.work = work;
            let next = match (ended, Self::loss_and_bar(record)) {
                (Err(error), _) if error.may_be_of_the_resolution() => {
                    failure = Some(error.to_string());
                    Self::twice(record)
                }
                (Err(error), _) => return Err(error),
                (Ok(()), None) => {
                    failure = record.message.clone();
                    Self::twice(record)
                }
                (Ok(()), Some((loss_j, bar))) => {
                    failure = None;
                    let allowed_j = accuracy * loss_j.abs();
                    if bar.total() <= allowed_j {
                        return Ok(());
                    }
                    // Half of what is allowed for each, of which the distance to the stabilised cycle takes its part from both.
                    let share_j = (0.5 * (allowed_j - bar.steady)).max(0.1 * allowed_j);
                    Resolution {
                        steps: finer(record.steps, bar.steps, share_j),
                        nodes: finer(record.nodes, bar.nodes, share_j),
                    }
                }
            };
            let limit = self.finest();
            if next.steps > limit.steps || next.nodes > limit.nodes {
                break;
            }
            (record.steps, record.nodes) = (next.steps, next.nodes);
        }
        if let Some(failure) = failure {
            record.miss(&failure);
            return Ok(());
        }
        let reached = record.energy_loss_error_j().zip(record.energy_loss_j());
        let reached = reached.map_or(f64::INFINITY, |(error, loss)| (error / loss).abs());
        record.miss(&format!(
            "the error of the loss is {reached:.1e} of it at {} steps and {} nodes, above the accuracy {accuracy:.1e}",
            record.steps, record.nodes
        ));
        Ok(())
    }

    /// The loss (J) of a record and its bar, where it has both.
    fn loss_and_bar(record: &CaseRecord) -> Option<(f64, Bar)> {
        let result = record.result.as_ref()?;
        let bar = result.errors.as_ref()?.bar(Quantity::EnergyLoss)?;
        Some((result.analysis.energy_loss_j, bar))
    }

    /// Twice the resolution at which a record has no result, or no error of it.
    fn twice(record: &CaseRecord) -> Resolution {
        Resolution {
            steps: 2 * record.steps,
            nodes: 2 * record.nodes,
        }
    }

    /// Beyond this an accuracy counts as out of reach.
    fn finest(&self) -> Resolution {
        match self.plan.contact.solver.engine {
            EngineKind::Axisymmetric => Resolution {
                steps: 20_000,
                nodes: 6_400,
            },
            EngineKind::HalfSpace => Resolution {
                steps: 4_000,
                nodes: 1_024,
            },
        }
    }

    /// The case on so many nodes, in each of the numbers of steps, every one started from the memory of the last. Only the last
    /// has to succeed.
    fn solve(
        &self,
        contact: &Contact<'_>,
        nodes: usize,
        steps: &[usize],
        domain: &mut Domain,
    ) -> Result<Solved, CaseError> {
        let engines = self.engines_of_case(contact, nodes)?;
        let cycles = engines.on_a_large_enough_domain(
            0,
            |half_width_m, growths| {
                *domain = Domain {
                    half_width_m,
                    growths,
                }
            },
            |engine| {
                if let Some(flag) = &self.interrupt {
                    engine.interrupted_by(Arc::clone(flag));
                }
                let needed = self.instant_tolerance(
                    &contact.solid.compliance,
                    &contact.condition.drive,
                    contact.angular_frequency_rad_per_s,
                    contact.cycle.tolerance,
                );
                engine.tolerate(needed);
                if self.plan.contact.solver.engine == EngineKind::HalfSpace
                    && self.plan.contact.solver.tolerance.is_none()
                    && let Some(tighter) = instant_tolerance::tighter(needed)
                {
                    match contact.searching_alone().in_steps(engine, steps) {
                        Ok(found)
                            if found.len() == steps.len()
                                && found.iter().all(|(_, cycle)| cycle.result.is_some()) =>
                        {
                            return Ok(found);
                        }
                        Ok(_) => engine.tolerate(tighter),
                        // No tolerance of the cycle's will do: it is marched as it is.
                        Err(CaseError::Contact(ContactError::NotConverged { .. })) => {}
                        Err(error) => return Err(error),
                    }
                }
                contact.in_steps(engine, steps)
            },
        )?;
        Ok(Solved { nodes, cycles })
    }
}

impl Solved {
    /// The result in so many steps.
    fn result(&self, steps: usize) -> Option<&CaseResult> {
        let (_, cycle) = self.cycles.iter().find(|(s, _)| *s == steps)?;
        cycle.result.as_ref()
    }

    fn work(&self) -> Work {
        let mut work = Work::default();
        for (_, cycle) in &self.cycles {
            work += cycle.work;
        }
        work
    }
}

impl CaseRecord {
    /// Takes over what was found in the most steps; leaves the coarser results where they are.
    fn take(&mut self, solved: &mut Solved, at_cycle: Option<usize>) {
        self.work = solved.work();
        let Some((_, finest)) = solved.cycles.last_mut() else {
            return;
        };
        self.method = finest.method;
        self.cycles = finest.cycles;
        self.steady_distance = finest.distance;
        self.message = finest.message.take();
        self.result = finest.result.take();
        self.status = match (&self.result, at_cycle) {
            (Some(_), None) => Status::Converged,
            (Some(_), Some(_)) => Status::Transient,
            (None, _) => Status::NotConverged,
        };
    }

    /// There is no result of the accuracy asked for, and so no result.
    fn miss(&mut self, why: &str) {
        self.result = None;
        self.status = Status::NotConverged;
        self.message = Some(why.to_owned());
    }
}

/// Nodes or steps that bring an error of second order down to what is allowed, with a little to spare; divisible by four, as
/// coarser ones are halves and quarters.
fn finer(now: usize, error: f64, allowed: f64) -> usize {
    const SPARE: f64 = 1.1;
    let factor = SPARE * (error / allowed).sqrt();
    if factor <= 1.0 {
        return now;
    }
    // One foretelling is not trusted further than this.
    const LARGEST: f64 = 8.0;
    let wanted = now as f64 * factor.min(LARGEST);
    4 * (wanted / 4.0).ceil() as usize
}

/// What a lock protects: whole, whatever became of the thread that held it, since entries are made before they are put in.
fn whole<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Error bars of the finest result, from what is coarser in steps on the same nodes and coarser in nodes at the same steps, from
/// its distance to the stabilised cycle and from pairs of results for the material and an alternative. `None` where one of them has no result.
fn error_bars(
    (result, steps, middle): (&CaseResult, usize, usize),
    (distance, alternatives): (f64, &[(&CaseResult, &CaseResult)]),
    (order_in_steps, believed): (f64, InNodes),
    [solved, half]: [&Solved; 2],
    quarter: Option<&Solved>,
) -> Option<ErrorBars> {
    let coarsest = steps / 4;
    let pair = |finer, coarser, [fine, coarse]: [usize; 2]| Pair {
        finer,
        coarser,
        ratio: fine as f64 / coarse as f64,
    };
    // Where the fewest steps were not taken on all nodes, they were on half of them.
    let second = [solved, half].into_iter().find_map(|on| {
        let results = on.result(middle).zip(on.result(coarsest));
        results.map(|(m, c)| pair(m, c, [middle, coarsest]))
    });
    let on_middle = solved.result(middle)?;
    let in_steps = Ladder {
        first: pair(result, on_middle, [steps, middle]),
        second: second.filter(|_| middle == steps / 2),
    };
    let on_half = half.result(middle)?;
    let in_nodes = Ladder {
        first: pair(on_middle, on_half, [solved.nodes, half.nodes]),
        second: quarter.and_then(|quarter| {
            let on_quarter = quarter.result(middle)?;
            Some(pair(on_half, on_quarter, [half.nodes, quarter.nodes]))
        }),
    };
    Some(ErrorBars::estimate(
        result,
        (&in_steps, order_in_steps),
        (&in_nodes, believed),
        distance,
        alternatives,
    ))
}
