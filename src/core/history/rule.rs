//! How the pressure varies within a time step, and what a step of any length then does to the past.

use serde::{Deserialize, Serialize};

use crate::contact::Prescribed;
use crate::material::Creep;
use crate::numerics::roots::bisect;
use crate::words;

words! {
    /// How the pressure is taken to vary within a time step.
    #[derive(Default, Serialize, Deserialize)]
    pub enum TimeRule {
        /// Linear within a step: second order, exact for the kernel at any step length. Between the two instants for bodies in
        /// which that does not ring; for the others in two stages, see [`StepWeights::damped_stages`].
        #[default]
        Linear = "linear",
        /// Held at its old value, then jumping to the new one: first order. The rule of S. Spinu, Advances in Tribology 2018,
        /// 9432894, equation (24).
        Constant = "constant",
    }
}

/// A stage of a step: one instant is solved for each.
#[derive(Debug, Clone, PartialEq)]
pub struct Stage<W = Vec<Recursion>> {
    /// The fraction of the step at which the stage ends. An approach is prescribed as it is there.
    pub end: f64,
    /// The fraction of the step at which the pressure is the one found. A load is prescribed as it is there.
    pub pressure_at: f64,
    pub weights: Step<W>,
}

impl<W> Stage<W> {
    /// A step in one stage.
    pub fn whole(weights: Step<W>) -> Self {
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

/// What a step of one length does; computed once for as many equal steps as there are, and used for every node.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Step<W> {
    /// Its length (s).
    pub step_s: f64,
    /// A (1/Pa): the compliance that multiplies the pressure at the end of the step.
    pub compliance_per_pa: f64,
    pub(super) weights: W,
}

/// A step of the direct sum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DirectWeights {
    pub(super) rule: TimeRule,
    /// The part of the increment that comes at the step's begin.
    pub(super) at_once: f64,
}

/// Weights of one memory variable over one step: m <- decay m + old p_old + new p_new.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recursion {
    pub(super) decay: f64,
    pub(super) old: f64,
    pub(super) new: f64,
}

/// A step of the recursion: the weights of every branch of the compliance, then those of the integral of the pressure over time (s).
pub type StepWeights = Step<Vec<Recursion>>;

/// What the memory variables of a compliance add to the hereditary integral, in the order of [`StepWeights`]: compliances of branches (1/Pa),
/// then the fluidity (1/(Pa s)), where there is one.
pub(super) fn compliances(compliance: &Creep) -> impl Iterator<Item = f64> {
    let branches = compliance.branches().iter().map(|b| b.compliance_per_pa);
    branches.chain(compliance.viscosity_pa_s().map(f64::recip))
}

impl StepWeights {
    /// Weights of a step of `step_s` seconds, zero for a jump, of this contact compliance.
    pub fn new(compliance: &Creep, step_s: f64, rule: TimeRule) -> Self {
        let flow_s = match rule {
            TimeRule::Linear => (0.5 * step_s, 0.5 * step_s),
            TimeRule::Constant => (step_s, 0.0),
        };
        let branch = |time_s| Recursion::new(step_s / time_s, rule);
        Self::of(compliance, step_s, branch, flow_s)
    }

    /// The step whose weights are those of `branch` at each retardation time (s), and `flow_s` of the old and the new pressure in their
    /// integral.
    fn of(
        compliance: &Creep,
        step_s: f64,
        branch: impl Fn(f64) -> Recursion,
        (old, new): (f64, f64),
    ) -> Self {
        let branches = compliance.branches().iter().map(|b| branch(b.time_s));
        let decay = 1.0;
        let weights: Vec<_> = branches.chain([Recursion { decay, old, new }]).collect();
        let delayed = compliances(compliance).zip(&weights);
        let delayed: f64 = delayed.map(|(per_pa, w)| per_pa * w.new).sum();
        Self {
            step_s,
            compliance_per_pa: compliance.instantaneous_compliance() + delayed,
            weights,
        }
    }

    /// By how much a pressure that is one too high makes the next one too low, at least: what the old pressure left, over A.
    fn ringing(&self, compliance: &Creep) -> f64 {
        let fields = compliances(compliance).zip(&self.weights);
        let left: f64 = fields.map(|(per_pa, w)| per_pa * w.old).sum();
        left / self.compliance_per_pa
    }

    /// The two stages of a step in which nothing rings.
    ///
    /// Over the step the pressure is linear through its values at a third of the step and at the end, the nodes of the two-stage
    /// Radau IIA method (E. Hairer and G. Wanner, Solving Ordinary Differential Equations II, section IV.5), so that the pressure
    /// before the step has no weight. The first stage only serves to find the former. In it the pressure is constant, and what
    /// that gives is the pressure at a place within the stage: at its end where the body answers like a spring, in its middle
    /// where the stage is long beside the relaxation and the body answers like a dashpot. How long the stage is follows from
    /// that: between a third and two thirds of the step, such that the place is the third. The second stage replaces what the
    /// first did to the memory.
    ///
    /// The rule is exact for a pressure that is constant within a step, of third order where steps resolve the relaxation and of
    /// second where they do not, and rings by 0.03 a step at the most. A load is prescribed where the pressure belongs, an
    /// approach where the stage ends.
    pub fn damped_stages(compliance: &Creep, step_s: f64) -> [Stage; 2] {
        let first_end = first_stage_end(compliance, step_s);
        let first = |z: f64| Recursion {
            decay: (-first_end * z).exp(),
            old: 0.0,
            new: -(-first_end * z).exp_m1(),
        };
        let rest = 1.0 - FIRST_NODE;
        let second = |z: f64| {
            let decay = (-(1.0 - first_end) * z).exp();
            let (constant, linear) = (-(-z).exp_m1(), linear_weight(z));
            Recursion {
                decay,
                old: (constant - linear) / rest - decay * first(z).new,
                new: (linear - FIRST_NODE * constant) / rest,
            }
        };
        let (half_s, first_s) = (0.5 * step_s, first_end * step_s);
        let second_flow_s = (
            half_s / rest - first_s,
            (half_s - FIRST_NODE * step_s) / rest,
        );
        let first = |time_s| first(step_s / time_s);
        let second_s = (1.0 - first_end) * step_s;
        [
            Stage {
                end: first_end,
                pressure_at: FIRST_NODE,
                weights: Self::of(compliance, first_s, first, (0.0, first_s)),
            },
            Stage::whole(Self::of(
                compliance,
                second_s,
                |time_s| second(step_s / time_s),
                second_flow_s,
            )),
        ]
    }
}

impl Recursion {
    /// The exponential recursion of the hereditary integral (R. L. Taylor, K. S. Pister and G. L. Goudreau, Int. J. Numer. Meth.
    /// Engng 2 (1970) 45). With z = step/lambda and e = exp(-z): new = 1 - (1 - e)/z and old = (1 - e)/z - e under the linear rule.
    fn new(z: f64, rule: TimeRule) -> Self {
        let decay = (-z).exp();
        let grown = -(-z).exp_m1();
        match rule {
            TimeRule::Constant => Self {
                decay,
                old: grown,
                new: 0.0,
            },
            TimeRule::Linear => {
                let new = linear_weight(z);
                Self {
                    decay,
                    old: grown - new,
                    new,
                }
            }
        }
    }
}

/// Where the pressure of the first stage of a damped step belongs, as a fraction of the step.
const FIRST_NODE: f64 = 1.0 / 3.0;

/// Where the first stage of a damped step ends, as a fraction of the step.
///
/// A pressure that is linear over a stage and one that is constant give the same shortening at its end where the constant is
/// the linear one's value at the fraction 1 - rho of the stage, rho being what the linear rule's old pressures weigh beside A of
/// the constant one.
fn first_stage_end(compliance: &Creep, step_s: f64) -> f64 {
    /// Halvings of the interval; the order of the rule feels no more.
    const HALVINGS: u32 = 24;
    let place = |end: f64| {
        let (mut old, mut all) = (0.0, compliance.instantaneous_compliance());
        for branch in compliance.branches() {
            let z = end * step_s / branch.time_s;
            let constant = -(-z).exp_m1();
            old += branch.compliance_per_pa * (constant - linear_weight(z));
            all += branch.compliance_per_pa * constant;
        }
        if let Some(eta) = compliance.viscosity_pa_s() {
            old += 0.5 * end * step_s / eta;
            all += end * step_s / eta;
        }
        end * (1.0 - old / all)
    };
    let is_before = |end: f64| place(end) <= FIRST_NODE;
    let (low, high) = bisect(FIRST_NODE, 2.0 * FIRST_NODE, HALVINGS, is_before);
    0.5 * (low + high)
}

/// Above this a pressure that is linear over a step rings too long for a body.
const LARGEST_RINGING: f64 = 0.25;

/// The highest order in the time steps to be believed of a march on this compliance by the linear rule. In stages it is the third
/// where steps resolve the relaxation and the second where they do not, and what is seen of it may lie on either side.
pub fn order_of_steps(compliance: &Creep) -> f64 {
    match rings(compliance) {
        true => 2.5,
        false => 2.0,
    }
}

/// Whether steps of some length make a pressure that is linear within each of them ring: where one step is too high the next is
/// too low. That of a trapezium, it does so where steps are long beside the time in which a pressure relaxes, which is shorter
/// than the retardation time by the ratio of the moduli.
pub(crate) fn rings(compliance: &Creep) -> bool {
    const PER_DECADE: f64 = 6.0;
    if compliance.viscosity_pa_s().is_some() {
        return true;
    }
    let branches = compliance.branches();
    let (Some(first), Some(last)) = (branches.first(), branches.last()) else {
        return false;
    };
    let decades = (last.time_s / first.time_s).log10() + 2.0;
    let steps = 0..=(PER_DECADE * decades) as i32;
    let step_s = |k: i32| 0.1 * first.time_s * 10_f64.powf(f64::from(k) / PER_DECADE);
    let ringing =
        |k: i32| StepWeights::new(compliance, step_s(k), TimeRule::Linear).ringing(compliance);
    steps.map(ringing).any(|ringing| ringing > LARGEST_RINGING)
}

/// 1 - (1 - exp(-z))/z, by its Taylor series where the difference would lose digits.
pub(crate) fn linear_weight(z: f64) -> f64 {
    // At z = 0.3 the difference loses less than one digit; ten terms of the series leave 0.3^10 / 11! = 1e-13 of the first.
    if z > 0.3 {
        return 1.0 + (-z).exp_m1() / z;
    }
    let (mut term, mut sum) = (0.5 * z, 0.0);
    for n in 3..=13 {
        sum += term;
        term *= -z / f64::from(n);
    }
    sum
}
