//! Memory variables of every node, and the weights that carry them over a time step of any length.

use std::ops::Range;

use multiversion::multiversion;

use super::cycle_sums::CycleSums;
use super::hereditary::{Hereditary, PastState, Stage, TimeRule};
use crate::contact::sums;
use crate::material::Creep;
use crate::numerics::roots::bisect;

/// Weights of one branch over one step: m <- decay m + old p_old + new p_new.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BranchWeights {
    pub decay: f64,
    pub old: f64,
    pub new: f64,
}

/// What a step of one length does to the memory; computed once per step length, used for every node.
#[derive(Debug, Clone, PartialEq)]
pub struct StepWeights {
    step_s: f64,
    branches: Vec<BranchWeights>,
    flow_old_s: f64,
    flow_new_s: f64,
    compliance_per_pa: f64,
}

impl StepWeights {
    /// Weights of a step of `step_s` seconds, zero for a jump, of this contact compliance.
    pub fn new(compliance: &Creep, step_s: f64, rule: TimeRule) -> Self {
        let branches = compliance.branches().iter();
        let weights = branches
            .map(|branch| BranchWeights::new(step_s / branch.time_s, rule))
            .collect();
        let flow_s = match rule {
            TimeRule::Linear => (0.5 * step_s, 0.5 * step_s),
            TimeRule::Constant => (step_s, 0.0),
        };
        Self::of(compliance, step_s, weights, flow_s)
    }

    fn of(
        compliance: &Creep,
        step_s: f64,
        branches: Vec<BranchWeights>,
        (flow_old_s, flow_new_s): (f64, f64),
    ) -> Self {
        let of_branches = compliance.branches().iter().zip(&branches);
        let delayed: f64 = of_branches
            .map(|(branch, weights)| branch.compliance_per_pa * weights.new)
            .sum();
        let flow = compliance
            .viscosity_pa_s()
            .map_or(0.0, |eta| flow_new_s / eta);
        Self {
            step_s,
            branches,
            flow_old_s,
            flow_new_s,
            compliance_per_pa: compliance.instantaneous_compliance() + delayed + flow,
        }
    }

    /// By how much a pressure that is one too high makes the next one too low, at least: what the old pressure left, over A.
    fn ringing(&self, compliance: &Creep) -> f64 {
        let branches = compliance.branches().iter().zip(&self.branches);
        let left: f64 = branches.map(|(b, w)| b.compliance_per_pa * w.old).sum();
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
    pub fn damped_stages(compliance: &Creep, step_s: f64) -> [Stage<Self>; 2] {
        let first_end = first_stage_end(compliance, step_s);
        let first = |z: f64| BranchWeights {
            decay: (-first_end * z).exp(),
            old: 0.0,
            new: -(-first_end * z).exp_m1(),
        };
        let rest = 1.0 - FIRST_NODE;
        let second = |z: f64| {
            let decay = (-(1.0 - first_end) * z).exp();
            let (constant, linear) = (-(-z).exp_m1(), linear_weight(z));
            BranchWeights {
                decay,
                old: (constant - linear) / rest - decay * first(z).new,
                new: (linear - FIRST_NODE * constant) / rest,
            }
        };
        let stage = |length: f64, weights: &dyn Fn(f64) -> BranchWeights, flow_s: (f64, f64)| {
            let branches = compliance.branches().iter();
            let weights = branches.map(|b| weights(step_s / b.time_s)).collect();
            Self::of(compliance, length * step_s, weights, flow_s)
        };
        let (half_s, first_s) = (0.5 * step_s, first_end * step_s);
        let second_flow_s = (
            half_s / rest - first_s,
            (half_s - FIRST_NODE * step_s) / rest,
        );
        [
            Stage {
                end: first_end,
                pressure_at: FIRST_NODE,
                weights: stage(first_end, &first, (0.0, first_s)),
            },
            Stage {
                end: 1.0,
                pressure_at: 1.0,
                weights: stage(1.0 - first_end, &second, second_flow_s),
            },
        ]
    }

    /// Length of the step (s).
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// A (1/Pa): the compliance that multiplies the pressure at the end of the step.
    pub fn compliance_per_pa(&self) -> f64 {
        self.compliance_per_pa
    }
}

impl BranchWeights {
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
fn rings(compliance: &Creep) -> bool {
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
fn linear_weight(z: f64) -> f64 {
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

/// Memory variables and last pressure of every node.
#[derive(Debug, Clone)]
pub struct Memory {
    nodes: usize,
    compliance: Creep,
    /// Whether steps are to be taken in two stages.
    rings: bool,
    /// Branch-major: the memory of branch j fills `nodes` values from `j * nodes`.
    branches: Vec<f64>,
    /// Integral of the pressure over time per node; empty without a flow term.
    flow: Vec<f64>,
    /// Where asked for by [`Memory::begin_cycle`].
    cycle: Option<CycleSums>,
}

impl Memory {
    /// The undisturbed state of `nodes` nodes under this contact compliance C(t) (1/Pa).
    pub fn new(compliance: Creep, nodes: usize) -> Self {
        let flow = if compliance.viscosity_pa_s().is_some() {
            vec![0.0; nodes]
        } else {
            Vec::new()
        };
        Self {
            nodes,
            branches: vec![0.0; nodes * compliance.branches().len()],
            flow,
            cycle: None,
            rings: rings(&compliance),
            compliance,
        }
    }

    /// The contact compliance C(t).
    pub fn compliance(&self) -> &Creep {
        &self.compliance
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        (self.branches.len() + self.flow.len()) * size_of::<f64>()
    }

    /// Begins sums over a cycle, of this branch.
    pub(crate) fn begin_cycle(&mut self, branch: usize) {
        self.cycle = Some(CycleSums::new(branch, self.nodes));
    }

    /// The sums since [`March::begin_cycle`](super::March::begin_cycle), where it asked for any.
    pub fn cycle_sums(&self) -> Option<&CycleSums> {
        self.cycle.as_ref()
    }

    /// Memory variables, branch-major, in the unit of the nodal pressure.
    pub fn variables(&self) -> &[f64] {
        &self.branches
    }

    /// The compliance after all branches have relaxed, without flow.
    pub(super) fn relaxed_compliance_per_pa(&self) -> f64 {
        let branches = self.compliance.branches().iter();
        let delayed: f64 = branches.map(|b| b.compliance_per_pa).sum();
        self.compliance.instantaneous_compliance() + delayed
    }

    /// Every branch remembers this pressure as if it had always been there.
    pub(super) fn fill_all_branches(&mut self, pressure: &[f64]) {
        for memory in self.branches.chunks_exact_mut(self.nodes) {
            memory.copy_from_slice(pressure);
        }
    }

    /// Takes over variables as [`Memory::variables`] gave them.
    pub(super) fn recall(&mut self, variables: &[f64]) {
        self.branches.copy_from_slice(variables);
    }
}

impl Hereditary for Memory {
    type Step = StepWeights;

    fn weights(&self, step_s: f64, rule: TimeRule) -> StepWeights {
        StepWeights::new(&self.compliance, step_s, rule)
    }

    fn stages(&self, step_s: f64, rule: TimeRule) -> Vec<Stage<StepWeights>> {
        match self.rings && rule == TimeRule::Linear && step_s > 0.0 {
            true => StepWeights::damped_stages(&self.compliance, step_s).into(),
            false => vec![Stage::whole(self.weights(step_s, rule))],
        }
    }

    fn compliance_per_pa(step: &StepWeights) -> f64 {
        step.compliance_per_pa
    }

    fn step_s(step: &StepWeights) -> f64 {
        step.step_s
    }

    /// Ages the memory by everything that is known before the new pressure is.
    fn predict(&mut self, weights: &StepWeights, old_pressure: &[f64], history: &mut [f64]) {
        let eta = self.compliance.viscosity_pa_s();
        for block in blocks(self.nodes) {
            let (old_pressure, history) =
                (&old_pressure[block.clone()], &mut history[block.clone()]);
            history.fill(0.0);
            let chunks = self.branches.chunks_exact_mut(self.nodes);
            let branches = self.compliance.branches().iter().zip(&weights.branches);
            for (memory, (branch, w)) in chunks.zip(branches) {
                let weights = (w.decay, w.old, branch.compliance_per_pa);
                fade(&mut memory[block.clone()], old_pressure, weights, history);
            }
            if let Some(cycle) = &mut self.cycle {
                let weights = (&weights.branches[..], weights.flow_old_s);
                cycle.predict(&block, weights, old_pressure);
            }
            if let Some(eta) = eta {
                let nodes = self.flow[block].iter_mut().zip(old_pressure);
                for ((m, &p), h) in nodes.zip(history.iter_mut()) {
                    *m += weights.flow_old_s * p;
                    *h += *m / eta;
                }
            }
        }
    }

    fn commit(&mut self, weights: &StepWeights, new_pressure: &[f64]) {
        for block in blocks(self.nodes) {
            let new_pressure = &new_pressure[block.clone()];
            let chunks = self.branches.chunks_exact_mut(self.nodes);
            for (memory, w) in chunks.zip(&weights.branches) {
                if w.new != 0.0 {
                    sums::add_scaled(&mut memory[block.clone()], w.new, new_pressure);
                }
            }
            if let Some(cycle) = &mut self.cycle {
                let weights = (&weights.branches[..], weights.flow_new_s);
                cycle.commit(&block, weights, new_pressure);
            }
            if weights.flow_new_s != 0.0 && !self.flow.is_empty() {
                for (m, &p) in self.flow[block].iter_mut().zip(new_pressure) {
                    *m += weights.flow_new_s * p;
                }
            }
        }
    }

    fn shortest_time_s(&self) -> Option<f64> {
        // Branches are sorted by time.
        self.compliance.branches().first().map(|b| b.time_s)
    }

    /// Memory variables, then what has flowed.
    fn state(&self) -> PastState {
        PastState {
            nodal: vec![self.branches.clone(), self.flow.clone()],
            steps: Vec::new(),
        }
    }

    fn restore(&mut self, state: &PastState) -> bool {
        let [branches, flow] = &state.nodal[..] else {
            return false;
        };
        let fits = state.steps.is_empty()
            && branches.len() == self.branches.len()
            && flow.len() == self.flow.len();
        if fits {
            self.flow.copy_from_slice(flow);
            self.recall(branches);
        }
        fits
    }
}

/// Memory that decays and takes in the old pressure, and its part of the history.
#[multiversion(targets("x86_64+avx2"))]
fn fade(
    memory: &mut [f64],
    old_pressure: &[f64],
    (decay, old, compliance): (f64, f64, f64),
    history: &mut [f64],
) {
    let nodes = memory.iter_mut().zip(old_pressure);
    for ((m, &p), h) in nodes.zip(history.iter_mut()) {
        *m = decay * *m + old * p;
        *h += compliance * *m;
    }
}

/// The nodes in blocks of which several fields stay in the fastest cache while all branches pass over them.
fn blocks(nodes: usize) -> impl Iterator<Item = Range<usize>> {
    const BLOCK: usize = 1024;
    let starts = (0..nodes).step_by(BLOCK);
    starts.map(move |start| start..(start + BLOCK).min(nodes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Creep, CreepBranch};

    fn two_branches() -> Creep {
        let branch = |compliance_per_pa, time_s| CreepBranch {
            compliance_per_pa,
            time_s,
        };
        Creep::new(1.0, vec![branch(0.5, 0.1), branch(2.0, 30.0)], Some(40.0)).unwrap()
    }

    /// q(t) for p = t^power / time, marched with the given steps; one node.
    fn march(rule: TimeRule, steps: &[f64], pressure: impl Fn(f64) -> f64) -> f64 {
        let mut memory = Memory::new(two_branches(), 1);
        let (mut time, mut p, mut q) = (0.0, 0.0, 0.0);
        for &step in steps {
            let weights = StepWeights::new(memory.compliance(), step, rule);
            let mut history = [0.0];
            memory.predict(&weights, &[p], &mut history);
            time += step;
            p = pressure(time);
            memory.commit(&weights, &[p]);
            q = weights.compliance_per_pa() * p + history[0];
        }
        q
    }

    #[test]
    fn a_pressure_linear_in_time_is_exact_at_any_step_length() {
        // q(t) for p = t: integral of C from 0 to t.
        let creep = two_branches();
        let t: f64 = 50.0;
        let exact = creep.instantaneous_compliance() * t
            + creep
                .branches()
                .iter()
                .map(|b| b.compliance_per_pa * (t + b.time_s * (-t / b.time_s).exp_m1()))
                .sum::<f64>()
            + 0.5 * t * t / 40.0;
        for steps in [
            vec![50.0],
            vec![1e-3, 0.999, 9.0, 40.0],
            vec![0.5; 100],
            vec![1e-9, 1e-6, 50.0 - 1e-6 - 1e-9],
        ] {
            let q = march(TimeRule::Linear, &steps, |t| t);
            // 100 roundings of 1e-16.
            assert!((q / exact - 1.0).abs() < 1e-13, "{q} {exact}");
        }
    }

    #[test]
    fn a_jump_is_a_step_of_length_zero_and_meets_the_instantaneous_compliance_alone() {
        for rule in [TimeRule::Linear, TimeRule::Constant] {
            let weights = StepWeights::new(&two_branches(), 0.0, rule);
            assert_eq!(weights.compliance_per_pa(), 1.0);
            assert_eq!(march(rule, &[0.0], |_| 3.0), 3.0);
        }
    }

    #[test]
    fn a_held_pressure_creeps_with_the_compliance_under_both_rules() {
        // A jump, then unequal steps at constant pressure: both rules are exact.
        let expected = two_branches().compliance(12.0);
        for rule in [TimeRule::Linear, TimeRule::Constant] {
            let q = march(rule, &[0.0, 1e-4, 0.2, 1.7999, 10.0], |_| 1.0);
            assert!((q / expected - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn the_linear_rule_is_of_second_order_and_the_constant_rule_of_first() {
        let order = |rule| {
            // The shortest retardation time is 0.1: steps well below it, or the order is not yet seen.
            let errors: Vec<f64> = [800, 1600, 400_000]
                .into_iter()
                .map(|n| march(rule, &vec![10.0 / n as f64; n], |t| (0.7 * t).sin()))
                .collect();
            ((errors[0] - errors[2]) / (errors[1] - errors[2]))
                .abs()
                .log2()
        };
        // The last level is no exact value, and the shortest retardation time is but eight steps: less than 0.05 together.
        assert!((order(TimeRule::Linear) - 2.0).abs() < 0.05);
        assert!((order(TimeRule::Constant) - 1.0).abs() < 0.05);
    }

    fn strong() -> Creep {
        let branch = CreepBranch {
            compliance_per_pa: 1000.0,
            time_s: 1.0,
        };
        Creep::new(1.0, vec![branch], None).unwrap()
    }

    /// The force of a spring whose shortening is given over time, marched with these steps from a jump on; in stages where the
    /// body asks for them, or in one.
    fn forces(
        creep: &Creep,
        steps: &[f64],
        in_stages: bool,
        shortening: impl Fn(f64) -> f64,
    ) -> Vec<f64> {
        let mut memory = Memory::new(creep.clone(), 1);
        let (mut force, mut time, mut forces) = (0.0, 0.0, Vec::new());
        for &step in [0.0].iter().chain(steps) {
            let stages = match in_stages {
                true => memory.stages(step, TimeRule::Linear),
                false => vec![Stage::whole(StepWeights::new(
                    creep,
                    step,
                    TimeRule::Linear,
                ))],
            };
            for Stage { end, weights, .. } in stages {
                let mut history = [0.0];
                memory.predict(&weights, &[force], &mut history);
                force = (shortening(time + end * step) - history[0]) / weights.compliance_per_pa();
                memory.commit(&weights, &[force]);
            }
            time += step;
            forces.push(force);
        }
        forces
    }

    #[test]
    fn steps_far_longer_than_the_relaxation_do_not_ring() {
        // The relaxation time is 1/1001 s: a step of 0.1 s is a hundred of them.
        let ringing = forces(&strong(), &[0.1; 20], false, |_| 1.0);
        assert!(ringing.iter().any(|f| *f < 0.0));
        let held = forces(&strong(), &[0.1; 20], true, |_| 1.0);
        // What is left of the jump falls by 0.03 a step; it comes to rest at the equilibrium of 1/1001.
        let rest = 1.0 / 1001.0;
        for (step, force) in held.iter().enumerate().skip(1) {
            assert!(
                (force - rest).abs() < 0.1_f64.powi(step as i32) + 1e-5,
                "{step}: {force}"
            );
        }
        let fluid = Creep::new(1.0, Vec::new(), Some(1.0)).unwrap();
        let flowing = forces(&fluid, &[50.0; 12], true, |_| 1.0);
        assert!(flowing[12].abs() < 0.1_f64.powi(12));
    }

    #[test]
    fn a_mild_body_is_marched_in_single_steps_and_a_strong_one_or_a_fluid_in_stages() {
        let stages = |compliance_per_pa: f64, viscosity: Option<f64>| {
            let branch = CreepBranch {
                compliance_per_pa,
                time_s: 3.0,
            };
            let creep = Creep::new(1.0, vec![branch], viscosity).unwrap();
            Memory::new(creep, 1).stages(0.3, TimeRule::Linear).len()
        };
        assert_eq!(
            [stages(1.0, None), stages(3.0, None), stages(0.1, Some(1e9))],
            [1, 2, 2]
        );
        let memory = Memory::new(strong(), 1);
        assert_eq!(memory.stages(0.0, TimeRule::Linear).len(), 1);
        assert_eq!(memory.stages(1.0, TimeRule::Constant).len(), 1);
    }

    #[test]
    fn stages_are_exact_for_a_constant_pressure_and_for_one_linear_in_time() {
        let creep = two_branches();
        for pressure in [|_: f64| 1.0, |t: f64| 2.0 + 0.3 * t] {
            let mut memory = Memory::new(creep.clone(), 1);
            let jump = StepWeights::new(&creep, 0.0, TimeRule::Linear);
            let mut history = [0.0];
            memory.predict(&jump, &[0.0], &mut history);
            memory.commit(&jump, &[pressure(0.0)]);
            let (mut time, mut last, mut q) = (0.0, pressure(0.0), 0.0);
            for step in [1e-3, 5.0, 0.2, 300.0] {
                for Stage {
                    pressure_at,
                    weights,
                    ..
                } in StepWeights::damped_stages(&creep, step)
                {
                    memory.predict(&weights, &[last], &mut history);
                    last = pressure(time + pressure_at * step);
                    memory.commit(&weights, &[last]);
                    q = weights.compliance_per_pa() * last + history[0];
                }
                time += step;
            }
            // Integral of C(t-s) dp(s): the jump, and the slope times the integral of C.
            let slope = pressure(1.0) - pressure(0.0);
            let integral = creep.instantaneous_compliance() * time
                + creep
                    .branches()
                    .iter()
                    .map(|b| b.compliance_per_pa * (time + b.time_s * (-time / b.time_s).exp_m1()))
                    .sum::<f64>()
                + 0.5 * time * time / 40.0;
            let exact = pressure(0.0) * creep.compliance(time) + slope * integral;
            assert!((q / exact - 1.0).abs() < 1e-13, "{q} {exact}");
        }
    }

    #[test]
    fn stages_are_of_third_order_where_steps_resolve_the_relaxation_and_of_second_where_not() {
        // Largest error of the force over the last three quarters of the time, of a smooth course and of one after a jump.
        let courses: [fn(f64) -> f64; 2] = [|t| (0.7 * t).sin(), |t| 1.0 + 0.5 * (0.7 * t).sin()];
        for shortening in courses {
            for (ratio, steps, expected) in [(1.0, 80, 3.0), (10.0, 160, 3.0), (1e5, 80, 2.0)] {
                let branch = CreepBranch {
                    compliance_per_pa: ratio,
                    time_s: 1.0,
                };
                let creep = Creep::new(1.0, vec![branch], None).unwrap();
                let run = |n: usize| {
                    let mut memory = Memory::new(creep.clone(), 1);
                    let (mut force, mut found) = (0.0, vec![0.0]);
                    let stages = StepWeights::damped_stages(&creep, 8.0 / n as f64);
                    for step in 0..n {
                        for stage in &stages {
                            let mut history = [0.0];
                            memory.predict(&stage.weights, &[force], &mut history);
                            let time = 8.0 * (step as f64 + stage.end) / n as f64;
                            force =
                                (shortening(time) - history[0]) / stage.weights.compliance_per_pa();
                            memory.commit(&stage.weights, &[force]);
                        }
                        found.push(force);
                    }
                    found
                };
                let exact = run(20_480);
                let error = |n: usize| {
                    let errors = run(n).into_iter().enumerate().skip(n / 4);
                    errors
                        .map(|(step, force)| (force - exact[step * 20_480 / n]).abs())
                        .fold(0.0, f64::max)
                };
                let order = (error(steps) / error(2 * steps)).log2();
                assert!(
                    (order - expected).abs() < 0.1,
                    "ratio {ratio}: order {order}"
                );
            }
        }
    }

    #[test]
    fn the_linear_weight_is_smooth_where_series_and_difference_meet() {
        let (below, above) = (
            linear_weight(0.3 * (1.0 - 1e-12)),
            linear_weight(0.3 * (1.0 + 1e-12)),
        );
        assert!((below - above).abs() < 1e-12);
        // First terms of the series: z/2 - z^2/6.
        assert!((linear_weight(1e-8) - (0.5e-8 - 1e-16 / 6.0)).abs() < 1e-23);
        assert_eq!(linear_weight(0.0), 0.0);
        assert!((linear_weight(1e9) - 1.0).abs() < 1e-8);
    }
}
