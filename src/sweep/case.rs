//! One case of a sweep: hold, march to the stabilised cycle, record it.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::contact::{ContactError, Engine, Prescribed};
use crate::cycle::{self, BranchChange, Extrema, Loop, LoopError};
use crate::history::{March, StepWeights};
use crate::material::{Creep, MaterialError};
use crate::sweep::engines::{self, AsContactError, EngineBuilder, EngineError, LargestContact};
use crate::sweep::plan::SweepPlan;
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
    #[error(transparent)]
    Engine(#[from] EngineError),
}

/// What all cases of a sweep share.
pub struct Setup {
    plan: SweepPlan,
    compliance: Creep,
    engines: EngineBuilder,
}

/// How a case ended early, other than by a record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
enum CaseError {
    #[error(transparent)]
    Contact(#[from] ContactError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    Loop(#[from] LoopError),
    #[error("interrupted")]
    Interrupted,
}

impl AsContactError for CaseError {
    fn as_contact_error(&self) -> Option<&ContactError> {
        match self {
            Self::Contact(error) => Some(error),
            _ => None,
        }
    }
}

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
        // No history within the drive's range makes a larger contact than its maximum held for ever.
        let largest = LargestContact {
            control: plan.drive.control(),
            maximum: plan.drive.maximum(),
            compliance_per_pa: relaxed,
        };
        Ok(Self {
            engines: EngineBuilder::new(plan.indenter.clone(), plan.solver, largest)?,
            compliance,
            plan,
        })
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
            domain_half_width_m: self.engines.half_width_m(),
            domain_enlarged: 0,
            iterations: 0,
            result: None,
        };
        let mut domain = (record.domain_half_width_m, 0);
        let ended = self.engines.on_a_large_enough_domain(
            |half_width_m, growths| domain = (half_width_m, growths),
            |engine| self.march(engine, &mut record, interrupt),
        );
        (record.domain_half_width_m, record.domain_enlarged) = domain;
        match ended {
            Ok(()) => {}
            Err(CaseError::Interrupted) => return None,
            Err(error) => record.message = Some(error.to_string()),
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
        let mean = engines::prescribed(drive.control(), drive.mean());
        march.jump(mean)?;
        march.hold(drive.hold_s(), mean)?;
        march.jump(self.prescribed(0.0))?;

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

    /// What the drive asks for at this fraction of a cycle.
    fn prescribed(&self, cycle_fraction: f64) -> Prescribed {
        let drive = &self.plan.drive;
        engines::prescribed(drive.control(), drive.value(cycle_fraction))
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
            contact_radius_m: not_negative(extrema(&samples.contact_radius_m)?),
            peak_pressure_pa: peaks.as_deref().and_then(Extrema::of).map(not_negative),
            analysis,
            samples,
        })
    }
}

/// Extrema of what cannot be negative: where a contact opens or closes, a parabola through samples may go below zero.
fn not_negative(extrema: Extrema) -> Extrema {
    Extrema {
        minimum: extrema.minimum.max(0.0),
        ..extrema
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
            march.step(&self.weights, self.setup.prescribed(fraction))?;
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
        engine.check_assumptions(pressure, solution)?;
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
