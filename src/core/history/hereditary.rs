//! What time marching asks of the body's past, however it is kept.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::rule::{DirectWeights, Stage, Step, TimeRule};

/// Everything that the past of a body keeps, lent so that no copy is made of what may fill much of the memory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PastState<'a> {
    /// Values per node, in every part any number of fields one after another.
    pub nodal: Vec<Cow<'a, [f64]>>,
    /// The steps taken, where the past is kept in full.
    pub steps: Cow<'a, [Step<DirectWeights>]>,
}

/// The past of a body: gives the hereditary part of the next instant, and takes in its pressure.
///
/// With q = A p + H the hereditary integral of C(t-s) dp(s) at the end of a step, p the unknown pressure there.
pub trait Hereditary {
    /// What a step does to the past.
    type Weights;

    /// The step of `step_s` seconds, zero for a jump of the drive.
    fn weights(&self, step_s: f64, rule: TimeRule) -> Step<Self::Weights>;

    /// The stages of such a step: more than one where one would ring.
    fn stages(&self, step_s: f64, rule: TimeRule) -> Vec<Stage<Self::Weights>>;

    /// First half of a step: writes H (1/Pa times the unit of the pressure) per node.
    fn predict(&mut self, step: &Step<Self::Weights>, old_pressure: &[f64], history: &mut [f64]);

    /// Second half of a step: takes in the new pressure.
    fn commit(&mut self, step: &Step<Self::Weights>, new_pressure: &[f64]);

    /// The shortest time (s) at which the compliance changes, where there is one.
    fn shortest_time_s(&self) -> Option<f64>;

    /// Everything it keeps, for [`Hereditary::restore`].
    fn state(&self) -> PastState<'_>;

    /// Goes back to what a past of the same compliance kept. False, and nothing done, where the state is none of this
    /// compliance on this number of nodes.
    fn restore(&mut self, state: PastState<'_>) -> bool;
}
