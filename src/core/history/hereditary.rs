//! What time marching asks of the body's past, however it is kept.

use serde::{Deserialize, Serialize};

use crate::contact::Prescribed;

/// How the pressure is taken to vary within a time step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum TimeRule {
    /// Linear within a step: second order, exact for the kernel at any step length. Between the two instants for bodies in
    /// which that does not ring; for the others in two stages, see [`StepWeights::damped_stages`](super::StepWeights::damped_stages).
    #[default]
    Linear,
    /// Held at its old value, then jumping to the new one: first order. The rule of S. Spinu, Advances in Tribology 2018,
    /// 9432894, equation (24).
    Constant,
}

impl TimeRule {
    /// As files call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Constant => "constant",
        }
    }
}

/// A stage of a step: one instant is solved for each.
#[derive(Debug, Clone, PartialEq)]
pub struct Stage<S> {
    /// The fraction of the step at which the stage ends. An approach is prescribed as it is there.
    pub end: f64,
    /// The fraction of the step at which the pressure is the one found. A load is prescribed as it is there.
    pub pressure_at: f64,
    pub weights: S,
}

impl<S> Stage<S> {
    /// A step in one stage.
    pub fn whole(weights: S) -> Self {
        Self {
            end: 1.0,
            pressure_at: 1.0,
            weights,
        }
    }

    /// What is prescribed in the stage, of a drive given at fractions of the step.
    pub fn prescribed(&self, drive: impl Fn(f64) -> Prescribed) -> Prescribed {
        match drive(self.end) {
            Prescribed::LoadN(_) => drive(self.pressure_at),
            approach => approach,
        }
    }
}

/// A step of the direct sum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DirectStep {
    pub(super) step_s: f64,
    pub(super) rule: TimeRule,
    pub(super) compliance_per_pa: f64,
    /// The part of the increment that comes at the step's begin.
    pub(super) at_once: f64,
}

/// Everything that the past of a body keeps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PastState {
    /// Values per node, in every part any number of fields one after another.
    pub nodal: Vec<Vec<f64>>,
    /// The steps taken, where the past is kept in full.
    pub steps: Vec<DirectStep>,
}

/// The past of a body: gives the hereditary part of the next instant, and takes in its pressure.
///
/// With q = A p + H the hereditary integral of C(t-s) dp(s) at the end of a step, p the unknown pressure there.
pub trait Hereditary {
    /// What a step of one length does, computed once for as many equal steps as there are.
    type Step;

    /// The step of `step_s` seconds, zero for a jump of the drive.
    fn weights(&self, step_s: f64, rule: TimeRule) -> Self::Step;

    /// The stages of such a step: more than one where one would ring.
    fn stages(&self, step_s: f64, rule: TimeRule) -> Vec<Stage<Self::Step>> {
        vec![Stage::whole(self.weights(step_s, rule))]
    }

    /// A (1/Pa) of a step.
    fn compliance_per_pa(step: &Self::Step) -> f64;

    /// Length (s) of a step.
    fn step_s(step: &Self::Step) -> f64;

    /// First half of a step: writes H (1/Pa times the unit of the pressure) per node.
    fn predict(&mut self, step: &Self::Step, old_pressure: &[f64], history: &mut [f64]);

    /// Second half of a step: takes in the new pressure.
    fn commit(&mut self, step: &Self::Step, new_pressure: &[f64]);

    /// The shortest time (s) at which the compliance changes, where there is one.
    fn shortest_time_s(&self) -> Option<f64>;

    /// Everything it keeps, for [`Hereditary::restore`].
    fn state(&self) -> PastState;

    /// Goes back to what a past of the same compliance kept. False, and nothing done, where the state is none of this
    /// compliance on this number of nodes.
    fn restore(&mut self, state: &PastState) -> bool;
}
