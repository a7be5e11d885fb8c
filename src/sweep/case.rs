//! One case of a sweep: hold, march to the stabilised cycle, record it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::contact::axisymmetric::{self, Axisymmetric};
use crate::contact::half_space::convolution::Convolution;
use crate::contact::half_space::{HalfSpace, SolverSettings};
use crate::contact::{ContactError, Engine, Prescribed};
use crate::cycle::{self, BranchChange, Extrema, Loop, LoopError};
use crate::history::{March, StepWeights};
use crate::indenter::{self, Domain};
use crate::material::{Creep, MaterialError};
use crate::sweep::domain::{self, GROWTH};
use crate::sweep::plan::{EngineKind, SweepPlan};
use crate::sweep::record::{CaseRecord, CaseResult, Status};

/// Why a sweep cannot be set up.
#[derive(Debug, Clone, thiserror::Error)]
pub enum SetupError {
    #[error(transparent)]
    Material(#[from] MaterialError),
    #[error(
        "the material is a fluid: under a mean load it creeps without end, and no stabilised cycle exists; give it an \
         equilibrium modulus above zero"
    )]
    Fluid,
    #[error(
        "the {shape} {reason}; the axisymmetric engine cannot treat it (set solver.engine = \"half-space\")"
    )]
    NotAxisymmetric { shape: &'static str, reason: String },
    #[error("the half-space grid cannot be built: {0}")]
    Grid(String),
}

/// What all cases of a sweep share.
pub struct Setup {
    plan: SweepPlan,
    compliance: Creep,
    half_width_m: f64,
    domain: Domain,
    operator: Option<Arc<Convolution>>,
}

/// How a case ended early, other than by a record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
enum CaseError {
    #[error(transparent)]
    Contact(#[from] ContactError),
    #[error(transparent)]
    Loop(#[from] LoopError),
    #[error("interrupted")]
    Interrupted,
}

/// Room beyond the largest contact expected.
const SPRING_ROOM: f64 = 1.02;
/// How many enlargements of the domain there may be before a case counts as failed.
const MAX_GROWTHS: usize = 12;

impl Setup {
    /// Checks the plan against the physics and prepares what the cases share.
    ///
    /// # Errors
    /// [`SetupError`] where the material cannot make a contact or has no stabilised cycle, or the engine cannot treat the
    /// indenter.
    pub fn new(plan: SweepPlan) -> Result<Self, SetupError> {
        let compliance = plan.material.contact_compliance()?;
        let relaxed = compliance
            .equilibrium_compliance()
            .ok_or(SetupError::Fluid)?;
        // No load history within the drive's range makes a larger contact than its maximum held for ever.
        let largest_n = plan.drive.maximum_n();
        let mut setup = Self {
            half_width_m: plan.indenter.elastic_half_width_m(largest_n, relaxed),
            domain: plan.indenter.domain(largest_n, relaxed),
            operator: None,
            compliance,
            plan,
        };
        match setup.plan.solver.engine {
            EngineKind::Axisymmetric => {
                if setup.body()?.contact_limit_m().is_none() {
                    setup.half_width_m *= SPRING_ROOM;
                }
            }
            EngineKind::HalfSpace => {
                let operator = setup.operator(0);
                setup.operator = Some(Arc::new(operator.map_err(SetupError::Grid)?));
            }
        }
        Ok(setup)
    }

    /// The plan.
    pub fn plan(&self) -> &SweepPlan {
        &self.plan
    }

    /// Predicted cost of a case, in cycles: a high frequency needs many to forget the start.
    pub fn predicted_cycles(&self, angular_frequency_rad_per_s: f64) -> f64 {
        let slowest_s = self
            .compliance
            .branches()
            .iter()
            .map(|b| b.time_s)
            .fold(0.0, f64::max);
        let cycles_to_forget = slowest_s * angular_frequency_rad_per_s / std::f64::consts::TAU;
        let to_tolerance = -self.plan.cycle.tolerance.ln();
        (2.0 + cycles_to_forget * to_tolerance).min(self.plan.cycle.max_cycles as f64)
    }

    fn operator(&self, growths: usize) -> Result<Convolution, String> {
        let grid = domain::grid(&self.domain, self.plan.solver.cells, growths);
        Convolution::new(grid.map_err(|e| e.to_string())?).map_err(|e| e.to_string())
    }

    /// The indenter as the axisymmetric engine sees it.
    fn body(&self) -> Result<&dyn indenter::Axisymmetric, SetupError> {
        let indenter = self.plan.indenter.as_ref();
        let refusal = || SetupError::NotAxisymmetric {
            shape: indenter.shape(),
            reason: indenter.not_axisymmetric_because(),
        };
        indenter.axisymmetric().ok_or_else(refusal)
    }

    /// Half width (m) of the domain enlarged `growths` times, and whether a further enlargement would enlarge it.
    fn half_width_m(&self, growths: usize) -> (f64, bool) {
        let known_m = match self.plan.solver.engine {
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

    /// An engine on a domain enlarged `growths` times.
    fn engine(&self, growths: usize) -> Result<Box<dyn Engine>, SetupError> {
        let indenter = self.plan.indenter.as_ref();
        let bounded = indenter.pressure_is_bounded();
        match self.plan.solver.engine {
            EngineKind::Axisymmetric => {
                let body = self.body()?;
                let springs = self.plan.solver.springs;
                let width_m = self.half_width_m(growths).0 / springs as f64;
                let gaps = (0..springs)
                    .map(|i| body.transformed_gap_m((i as f64 + 0.5) * width_m))
                    .collect();
                let edge = match body.contact_limit_m() {
                    Some(_) => axisymmetric::Edge::Rim,
                    None => axisymmetric::Edge::Open,
                };
                Ok(Box::new(Axisymmetric::new(width_m, gaps, edge, bounded)))
            }
            EngineKind::HalfSpace => {
                let operator = match &self.operator {
                    Some(shared) if growths == 0 => Arc::clone(shared),
                    _ => Arc::new(self.operator(growths).map_err(SetupError::Grid)?),
                };
                let gaps = domain::gaps_m(indenter, operator.grid());
                let settings = SolverSettings {
                    tolerance: self.plan.solver.tolerance,
                    ..SolverSettings::default()
                };
                let engine = HalfSpace::new(operator, gaps, bounded, settings);
                Ok(Box::new(if indenter.ends_in_data() {
                    engine.ending_in_data()
                } else {
                    engine
                }))
            }
        }
    }

    /// Runs one case to its record; `None` where it was interrupted.
    pub fn run(
        &self,
        index: usize,
        angular_frequency_rad_per_s: f64,
        interrupt: &AtomicBool,
    ) -> Option<CaseRecord> {
        let mut record = CaseRecord {
            index,
            angular_frequency_rad_per_s,
            status: Status::Failed,
            message: None,
            cycles: 0,
            steady_distance: None,
            domain_half_width_m: self.half_width_m(0).0,
            domain_enlarged: 0,
            iterations: 0,
            result: None,
        };
        for growths in 0..=MAX_GROWTHS {
            record.domain_enlarged = growths;
            let (half_width_m, can_grow) = self.half_width_m(growths);
            let mut engine = match self.engine(growths) {
                Ok(engine) => engine,
                Err(error) => {
                    record.message = Some(error.to_string());
                    return Some(record);
                }
            };
            record.domain_half_width_m = half_width_m;
            match self.march(engine.as_mut(), &mut record, interrupt) {
                Ok(()) => return Some(record),
                Err(CaseError::Interrupted) => return None,
                Err(CaseError::Contact(ContactError::ReachedEdge { .. }))
                    if can_grow && growths < MAX_GROWTHS => {}
                Err(CaseError::Contact(error @ ContactError::ReachedEdge { .. })) if !can_grow => {
                    record.message = Some(format!(
                        "{error}, beyond which the shape of the indenter is not known: give a larger map or a longer profile, \
                         or a smaller load"
                    ));
                    return Some(record);
                }
                Err(error) => {
                    record.message = Some(error.to_string());
                    return Some(record);
                }
            }
        }
        Some(record)
    }

    fn march(
        &self,
        engine: &mut dyn Engine,
        record: &mut CaseRecord,
        interrupt: &AtomicBool,
    ) -> Result<(), CaseError> {
        let SweepPlan { drive, cycle, .. } = &self.plan;
        let rule = self.plan.solver.time_rule;
        let mut march = March::new(engine, self.compliance.clone(), rule);
        let mean = Prescribed::LoadN(drive.mean_n());
        march.jump(mean)?;
        march.hold(drive.hold_s(), mean)?;
        march.jump(Prescribed::LoadN(drive.load_n(0.0)))?;

        let period_s = std::f64::consts::TAU / record.angular_frequency_rad_per_s;
        let mut cycles = Cycles {
            setup: self,
            weights: march.weights(period_s / cycle.steps as f64),
            period_s,
            start: Vec::new(),
        };
        record.cycles = 0;
        while record.cycles < cycle.max_cycles {
            record.cycles += 1;
            let distance = cycles.run(&mut march, interrupt, None)?;
            record.steady_distance = distance;
            if distance.is_some_and(|d| d <= cycle.tolerance) {
                let mut samples = Loop::default();
                record.cycles += 1;
                record.steady_distance = cycles.run(&mut march, interrupt, Some(&mut samples))?;
                record.result = Some(self.result(samples)?);
                record.status = Status::Converged;
                record.iterations = march.iterations();
                return Ok(());
            }
        }
        record.iterations = march.iterations();
        record.status = Status::NotConverged;
        record.message = Some(match record.steady_distance {
            Some(distance) => format!(
                "after {} cycles the estimated distance to the stabilised cycle is {distance:.1e}, above the tolerance {:.1e}",
                record.cycles, cycle.tolerance
            ),
            None => format!("no pressure arose in {} cycles", record.cycles),
        });
        Ok(())
    }

    fn result(&self, samples: Loop) -> Result<CaseResult, LoopError> {
        let analysis = cycle::analyse(&samples.load_n, &samples.approach_m)?;
        let radii = &samples.contact_radius_m;
        // The mean over the period counts the seam once.
        let mean_radius_m =
            radii.iter().skip(1).sum::<f64>() / radii.len().saturating_sub(1).max(1) as f64;
        let moduli =
            analysis.equivalent_moduli_pa(mean_radius_m, self.plan.material.poisson_ratio());
        let peaks: Option<Vec<f64>> = samples.peak_pressure_pa.iter().copied().collect();
        let extrema = |signal: &[f64]| {
            Extrema::of(signal).ok_or(LoopError::TooFewSamples {
                samples: 0,
                needed: 1,
            })
        };
        Ok(CaseResult {
            storage_modulus_pa: moduli.map(|m| m.0),
            loss_modulus_pa: moduli.map(|m| m.1),
            approach_m: extrema(&samples.approach_m)?,
            contact_radius_m: extrema(&samples.contact_radius_m)?,
            peak_pressure_pa: peaks.as_deref().and_then(Extrema::of),
            analysis,
            samples,
        })
    }
}

/// Cycles of one case.
struct Cycles<'a> {
    setup: &'a Setup,
    weights: StepWeights,
    period_s: f64,
    /// Memory variables at the start of the cycle.
    start: Vec<f64>,
}

impl Cycles<'_> {
    /// Marches one cycle; samples it where asked to. Returns the estimated distance to the stabilised cycle.
    fn run(
        &mut self,
        march: &mut March<'_>,
        interrupt: &AtomicBool,
        mut samples: Option<&mut Loop>,
    ) -> Result<Option<f64>, CaseError> {
        let drive = &self.setup.plan.drive;
        let steps = self.setup.plan.cycle.steps;
        self.start.clear();
        self.start.extend_from_slice(march.memory().variables());
        let mut scale = 0.0_f64;
        if let Some(samples) = samples.as_deref_mut() {
            sample(march, samples, 0.0)?;
        }
        for step in 1..=steps {
            if interrupt.load(Ordering::Relaxed) {
                return Err(CaseError::Interrupted);
            }
            let fraction = step as f64 / steps as f64;
            march.step(&self.weights, Prescribed::LoadN(drive.load_n(fraction)))?;
            scale = march.pressure().iter().fold(scale, |s, &p| s.max(p));
            if let Some(samples) = samples.as_deref_mut() {
                sample(march, samples, fraction * self.period_s)?;
            }
        }
        let changes = self.changes(march);
        Ok(cycle::steady_distance(&changes, self.period_s, scale))
    }

    fn changes(&self, march: &March<'_>) -> Vec<BranchChange> {
        let nodes = march.pressure().len();
        let end = march.memory().variables();
        let chunks = self.start.chunks_exact(nodes).zip(end.chunks_exact(nodes));
        chunks
            .zip(march.memory().compliance().branches())
            .map(|((before, after), branch)| BranchChange {
                retardation_time_s: branch.time_s,
                largest_change: before
                    .iter()
                    .zip(after)
                    .fold(0.0, |largest: f64, (b, a)| largest.max((a - b).abs())),
            })
            .collect()
    }
}

/// Appends the present instant to a loop.
fn sample(march: &mut March<'_>, samples: &mut Loop, time_s: f64) -> Result<(), ContactError> {
    march.observe(&mut |engine, pressure, solution| {
        samples.time_s.push(time_s);
        samples.load_n.push(solution.load_n);
        samples.approach_m.push(solution.approach_m);
        samples.contact_radius_m.push(solution.contact_radius_m);
        samples
            .peak_pressure_pa
            .push(engine.peak_pressure_pa(pressure, solution)?);
        Ok(())
    })
}
