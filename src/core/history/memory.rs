//! Memory variables of every node, carried over time steps by the weights of the rule.

use std::borrow::Cow;
use std::ops::Range;

use multiversion::multiversion;

use super::cycle_sums::CycleSums;
use super::hereditary::{Hereditary, PastState};
use super::rule::{Recursion, Stage, StepWeights, TimeRule, compliances, rings};
use crate::contact::sums;
use crate::material::Creep;
use crate::numerics::threads::{Fields, in_pieces};

/// Memory variables of every node.
#[derive(Debug, Clone)]
pub struct Memory {
    nodes: usize,
    compliance: Creep,
    /// Whether steps are to be taken in two stages.
    rings: bool,
    /// What each field adds to the hereditary integral.
    compliances: Vec<f64>,
    /// One after another, `nodes` values each: the memory of every branch and, where there is a flow term, the integral of the
    /// pressure over time.
    fields: Vec<f64>,
    /// Where asked for by [`Memory::begin_cycle`].
    cycle: Option<CycleSums>,
}

impl Memory {
    /// The undisturbed state of `nodes` nodes under this contact compliance C(t) (1/Pa).
    pub fn new(compliance: Creep, nodes: usize) -> Self {
        let compliances: Vec<f64> = compliances(&compliance).collect();
        Self {
            nodes,
            fields: vec![0.0; nodes * compliances.len()],
            compliances,
            cycle: None,
            rings: rings(&compliance),
            compliance,
        }
    }

    /// The contact compliance C(t).
    pub fn compliance(&self) -> &Creep {
        &self.compliance
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
        &self.fields[..self.nodes * self.compliance.branches().len()]
    }

    fn variables_mut(&mut self) -> &mut [f64] {
        &mut self.fields[..self.nodes * self.compliance.branches().len()]
    }

    /// Every field: the memory variables of one branch after another and, where there is a flow term, the integral of the pressure.
    pub(super) fn each(&self) -> impl Iterator<Item = &[f64]> {
        self.fields.chunks_exact(self.nodes.max(1))
    }

    pub(super) fn each_mut(&mut self) -> impl Iterator<Item = &mut [f64]> {
        self.fields.chunks_exact_mut(self.nodes.max(1))
    }

    /// The hereditary integral of the instant last taken in, of this pressure.
    pub(super) fn hereditary(&self, pressure: &[f64]) -> Vec<f64> {
        let at_once = self.compliance.instantaneous_compliance();
        let mut hereditary: Vec<f64> = pressure.iter().map(|p| at_once * p).collect();
        for (field, per_pa) in self.each().zip(&self.compliances) {
            sums::add_scaled(&mut hereditary, *per_pa, field);
        }
        hereditary
    }

    /// The compliance after all branches have relaxed, without flow.
    pub(super) fn relaxed_compliance_per_pa(&self) -> f64 {
        let branches = self.compliance.branches().iter();
        let delayed: f64 = branches.map(|b| b.compliance_per_pa).sum();
        self.compliance.instantaneous_compliance() + delayed
    }

    /// Every branch remembers this pressure as if it had always been there.
    pub(super) fn fill_all_branches(&mut self, pressure: &[f64]) {
        let nodes = self.nodes;
        for memory in self.variables_mut().chunks_exact_mut(nodes) {
            memory.copy_from_slice(pressure);
        }
    }

    /// Takes over variables as [`Memory::variables`] gave them.
    pub(super) fn recall(&mut self, variables: &[f64]) {
        self.variables_mut().copy_from_slice(variables);
    }

    /// Every field with its weights in a step and what it adds to the hereditary integral, the sums over a cycle among them.
    fn fields<'s>(
        &'s mut self,
        step: &'s StepWeights,
    ) -> impl Iterator<Item = (&'s mut [f64], &'s Recursion, f64)> {
        let fields = self.fields.chunks_exact_mut(self.nodes).zip(&step.weights);
        let fields = fields.zip(&self.compliances);
        let of_cycle = self.cycle.iter_mut().flat_map(|sums| sums.fields(step));
        let fields = fields.map(|((field, weights), per_pa)| (field, weights, *per_pa));
        fields.chain(of_cycle.map(|(field, weights)| (field, weights, 0.0)))
    }
}

impl Hereditary for Memory {
    type Weights = Vec<Recursion>;

    fn weights(&self, step_s: f64, rule: TimeRule) -> StepWeights {
        StepWeights::new(&self.compliance, step_s, rule)
    }

    fn stages(&self, step_s: f64, rule: TimeRule) -> Vec<Stage> {
        match self.rings && rule == TimeRule::Linear && step_s > 0.0 {
            true => StepWeights::damped_stages(&self.compliance, step_s).into(),
            false => vec![Stage::whole(self.weights(step_s, rule))],
        }
    }

    /// Ages the memory by everything that is known before the new pressure is.
    fn predict(&mut self, step: &StepWeights, old_pressure: &[f64], history: &mut [f64]) {
        let fields = (self.fields(step)).map(|(values, weights, per_pa)| Fading {
            values,
            weights: (weights.decay, weights.old, per_pa),
        });
        let mut fields = fields.peekable();
        in_pieces(history.len(), &mut *history, |_, history| history.fill(0.0));
        while fields.peek().is_some() {
            let together: [Fading<'_>; TOGETHER] =
                std::array::from_fn(|_| fields.next().unwrap_or_default());
            let pieces = (old_pressure, &mut *history, together);
            in_pieces(old_pressure.len(), pieces, |_, piece| {
                let (old_pressure, history, mut fields) = piece;
                for block in blocks(history.len()) {
                    let fields = fields.iter_mut().filter(|field| !field.values.is_empty());
                    for Fading { values, weights } in fields {
                        let (values, old) =
                            (&mut values[block.clone()], &old_pressure[block.clone()]);
                        fade(values, old, *weights, &mut history[block.clone()]);
                    }
                }
            });
        }
    }

    fn commit(&mut self, step: &StepWeights, new_pressure: &[f64]) {
        for (field, weights, _) in self.fields(step) {
            if weights.new != 0.0 {
                in_pieces(new_pressure.len(), (field, new_pressure), |_, piece| {
                    sums::add_scaled(piece.0, weights.new, piece.1);
                });
            }
        }
    }

    fn shortest_time_s(&self) -> Option<f64> {
        // Branches are sorted by time.
        self.compliance.branches().first().map(|b| b.time_s)
    }

    /// Memory variables, then what has flowed.
    fn state(&self) -> PastState<'_> {
        PastState {
            nodal: vec![Cow::Borrowed(&self.fields)],
            steps: Cow::Borrowed(&[]),
        }
    }

    fn restore(&mut self, state: PastState<'_>) -> bool {
        let Ok([fields]) = <[_; 1]>::try_from(state.nodal) else {
            return false;
        };
        let fits = state.steps.is_empty() && fields.len() == self.fields.len();
        if fits {
            self.fields = fields.into_owned();
        }
        fits
    }
}

/// Fields that are passed over together: as many as a body usually has.
const TOGETHER: usize = 8;

/// A field in a step: what it fades by, takes in of the old pressure, and adds to the hereditary integral; none by default.
#[derive(Default)]
struct Fading<'s> {
    values: &'s mut [f64],
    weights: (f64, f64, f64),
}

impl Fields for Fading<'_> {
    fn cut(self, at: usize) -> (Self, Self) {
        let weights = self.weights;
        let (values, rest) = self.values.cut(at);
        let piece = |values| Self { values, weights };
        (piece(values), piece(rest))
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
    use super::super::rule::linear_weight;
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
            q = weights.compliance_per_pa * p + history[0];
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
            assert_eq!(weights.compliance_per_pa, 1.0);
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
                force = (shortening(time + end * step) - history[0]) / weights.compliance_per_pa;
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
                    q = weights.compliance_per_pa * last + history[0];
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
                                (shortening(time) - history[0]) / stage.weights.compliance_per_pa;
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
