//! Memory variables of every node, and the weights that carry them over a time step of any length.

use std::ops::Range;

use super::loaded::Loaded;
use crate::material::Creep;

/// How the pressure is taken to vary within a time step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TimeRule {
    /// Linear between the two instants: second order, exact for the kernel at any step length.
    #[default]
    Linear,
    /// Held at its old value, then jumping to the new one: first order. The rule of S. Spinu, Advances in Tribology 2018,
    /// 9432894, equation (24).
    Constant,
}

/// Weights of one branch over one step: m <- decay m + old p_old + new p_new.
#[derive(Debug, Clone, Copy, PartialEq)]
struct BranchWeights {
    decay: f64,
    old: f64,
    new: f64,
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
        let branches: Vec<_> = compliance
            .branches()
            .iter()
            .map(|branch| BranchWeights::new(step_s / branch.time_s, rule))
            .collect();
        let (flow_old_s, flow_new_s) = match rule {
            TimeRule::Linear => {
                // Beyond twice the time in which the flow relaxes a pressure, the trapezium rings without end.
                let old_s = (0.5 * step_s).min(flow_relaxation_s(compliance));
                (old_s, step_s - old_s)
            }
            TimeRule::Constant => (step_s, 0.0),
        };
        let delayed: f64 = compliance
            .branches()
            .iter()
            .zip(&branches)
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

    /// The same step for a body that settles after a jump or kink of the drive: the old pressure never counts for more than
    /// half of the body's instantaneous answer to it.
    ///
    /// A pressure linear in time makes the rule that of a trapezium, which rings where a step is long beside the time in
    /// which a spring's force relaxes: the force that one step puts too high the next puts too low. After a jump, steps grow
    /// that long on purpose, while a growing contact still takes in springs that relax fast. There the part of the old
    /// pressure's weight that makes it ring is shifted to the new one. A constant pressure remains exact, and so does, under
    /// a held load, the contact radius, which depends on the sum of the forces alone; where nothing would ring, nothing
    /// changes.
    #[must_use]
    pub fn settling(mut self, compliance: &Creep) -> Self {
        let viscosity = compliance.viscosity_pa_s();
        let flow = viscosity.map_or(0.0, |eta| self.flow_old_s / eta);
        let delayed = compliance.branches().iter().zip(&self.branches);
        let delayed: f64 = delayed.map(|(b, w)| b.compliance_per_pa * w.old).sum();
        let allowed = 0.5 * compliance.instantaneous_compliance();
        if delayed + flow <= allowed {
            return self;
        }
        let shifted = 1.0 - allowed / (delayed + flow);
        for weights in &mut self.branches {
            let shift = shifted * weights.old;
            weights.old -= shift;
            weights.new += shift;
        }
        let shift_s = shifted * self.flow_old_s;
        self.flow_old_s -= shift_s;
        self.flow_new_s += shift_s;
        self.compliance_per_pa += shifted * (delayed + flow);
        self
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
    /// With z = step/lambda and e = exp(-z): new = 1 - (1 - e)/z and old = (1 - e)/z - e under the linear rule.
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

/// The time in which flow relaxes a pressure once all branches have followed: viscosity times their compliance; infinite
/// without flow.
fn flow_relaxation_s(compliance: &Creep) -> f64 {
    let delayed = compliance.branches().iter().map(|b| b.compliance_per_pa);
    let followed = compliance.instantaneous_compliance() + delayed.sum::<f64>();
    compliance
        .viscosity_pa_s()
        .map_or(f64::INFINITY, |eta| eta * followed)
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
    /// Beyond these nodes there is nothing to remember.
    loaded: Loaded,
    /// Branch-major: the memory of branch j fills `nodes` values from `j * nodes`.
    branches: Vec<f64>,
    /// Integral of the pressure over time per node; empty without a flow term.
    flow: Vec<f64>,
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
            loaded: Loaded::default(),
            branches: vec![0.0; nodes * compliance.branches().len()],
            flow,
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
        self.find_loaded();
    }

    /// Takes over variables as [`Memory::variables`] gave them.
    pub(super) fn recall(&mut self, variables: &[f64]) {
        self.branches.copy_from_slice(variables);
        self.find_loaded();
    }

    /// Memory variables, then what has flowed.
    pub(super) fn state(&self) -> [&[f64]; 2] {
        [&self.branches, &self.flow]
    }

    /// Takes over what [`Memory::state`] gave; false, and nothing done, where it is of other nodes or branches.
    pub(super) fn restore(&mut self, state: &[Vec<f64>]) -> bool {
        let [branches, flow] = state else {
            return false;
        };
        let fits = branches.len() == self.branches.len() && flow.len() == self.flow.len();
        if fits {
            self.flow.copy_from_slice(flow);
            self.recall(branches);
        }
        fits
    }

    /// After the variables were written from outside.
    fn find_loaded(&mut self) {
        self.loaded = Loaded::default();
        for memory in self.branches.chunks_exact(self.nodes) {
            self.loaded.extend(memory);
        }
        self.loaded.extend(&self.flow);
    }

    /// First half of a step: ages the memory by everything that is known before the new pressure is, and writes the
    /// hereditary part H (1/Pa times the unit of the pressure) per node.
    pub fn predict(&mut self, weights: &StepWeights, old_pressure: &[f64], history: &mut [f64]) {
        self.loaded.extend(old_pressure);
        let loaded = self.loaded.range();
        history[..loaded.start].fill(0.0);
        history[loaded.end..].fill(0.0);
        let eta = self.compliance.viscosity_pa_s();
        for block in blocks(loaded) {
            let (old_pressure, history) =
                (&old_pressure[block.clone()], &mut history[block.clone()]);
            history.fill(0.0);
            let chunks = self.branches.chunks_exact_mut(self.nodes);
            let branches = self.compliance.branches().iter().zip(&weights.branches);
            for (memory, (branch, w)) in chunks.zip(branches) {
                let compliance = branch.compliance_per_pa;
                let nodes = memory[block.clone()].iter_mut().zip(old_pressure);
                for ((m, &p), h) in nodes.zip(history.iter_mut()) {
                    *m = w.decay * *m + w.old * p;
                    *h += compliance * *m;
                }
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

    /// Second half of a step: takes in the new pressure.
    pub fn commit(&mut self, weights: &StepWeights, new_pressure: &[f64]) {
        self.loaded.extend(new_pressure);
        for block in blocks(self.loaded.range()) {
            let new_pressure = &new_pressure[block.clone()];
            let chunks = self.branches.chunks_exact_mut(self.nodes);
            for (memory, w) in chunks.zip(&weights.branches) {
                if w.new != 0.0 {
                    for (m, &p) in memory[block.clone()].iter_mut().zip(new_pressure) {
                        *m += w.new * p;
                    }
                }
            }
            if weights.flow_new_s != 0.0 && !self.flow.is_empty() {
                for (m, &p) in self.flow[block].iter_mut().zip(new_pressure) {
                    *m += weights.flow_new_s * p;
                }
            }
        }
    }
}

/// The nodes in blocks of which several fields stay in the fastest cache while all branches pass over them.
fn blocks(nodes: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    const BLOCK: usize = 1024;
    let end = nodes.end;
    nodes
        .step_by(BLOCK)
        .map(move |start| start..(start + BLOCK).min(end))
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

    /// The force of a spring held at a shortening of 1 from a jump on, marched with these steps.
    fn relaxing(creep: &Creep, steps: &[f64], settling: bool) -> Vec<f64> {
        let mut memory = Memory::new(creep.clone(), 1);
        let mut forces = vec![0.0];
        for &step in [0.0].iter().chain(steps) {
            let weights = StepWeights::new(creep, step, TimeRule::Linear);
            let weights = if settling {
                weights.settling(creep)
            } else {
                weights
            };
            let mut history = [0.0];
            let last = forces[forces.len() - 1];
            memory.predict(&weights, &[last], &mut history);
            let force = (1.0 - history[0]) / weights.compliance_per_pa();
            memory.commit(&weights, &[force]);
            forces.push(force);
        }
        forces
    }

    #[test]
    fn a_settling_step_far_longer_than_the_relaxation_does_not_ring() {
        let strong = CreepBranch {
            compliance_per_pa: 1000.0,
            time_s: 1.0,
        };
        let solid = Creep::new(1.0, vec![strong], None).unwrap();
        // The relaxation time is 1/1001 s: a step of 0.1 s is a hundred of them.
        let ringing = relaxing(&solid, &[0.1; 20], false);
        assert!(ringing.iter().any(|f| *f < 0.0));
        let held = relaxing(&solid, &[0.1; 20], true);
        assert!(held.iter().all(|f| *f >= 0.0));
        assert!(
            held[2..]
                .windows(2)
                .all(|pair| pair[1] <= pair[0] * (1.0 + 1e-9))
        );
        // It comes to rest at the equilibrium of 1/1001.
        assert!((held[21] * 1001.0 - 1.0).abs() < 1e-2);
        let fluid = Creep::new(1.0, Vec::new(), Some(1.0)).unwrap();
        let flowing = relaxing(&fluid, &[50.0; 10], false);
        assert!(flowing.iter().all(|f| *f >= 0.0) && flowing[11] < 1e-9);
    }

    #[test]
    fn where_nothing_rings_a_settling_step_is_the_same_step() {
        for step in [0.0, 1e-3, 1.0, 1e3] {
            let mild = CreepBranch {
                compliance_per_pa: 0.9,
                time_s: 3.0,
            };
            let creep = Creep::new(1.0, vec![mild], None).unwrap();
            let weights = StepWeights::new(&creep, step, TimeRule::Linear);
            assert_eq!(weights.clone().settling(&creep), weights);
        }
        // A constant pressure is exact with and without.
        let creep = two_branches();
        let mut memory = Memory::new(creep.clone(), 1);
        let mut history = [0.0];
        for step in [0.0, 5.0, 20.0, 300.0] {
            let weights = StepWeights::new(&creep, step, TimeRule::Linear).settling(&creep);
            let old = if step == 0.0 { 0.0 } else { 1.0 };
            memory.predict(&weights, &[old], &mut history);
            memory.commit(&weights, &[1.0]);
            let q = weights.compliance_per_pa() + history[0];
            let time: f64 = [0.0, 5.0, 20.0, 300.0]
                .iter()
                .take_while(|s| **s <= step)
                .sum();
            assert!((q / creep.compliance(time) - 1.0).abs() < 1e-13, "{time}");
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
