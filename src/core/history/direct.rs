//! The hereditary integral by direct summation over the whole past, for any compliance function.
//!
//! Where C(t) is no sum of exponentials (a table used as it is, a power law), every instant sums over all earlier ones:
//! N steps cost of order N^2, and storage grows by one pressure field per step. In pressure space, before any elastic operator:
//! with dp_k the increment over step k, from t_(k-1) to t_k,
//!
//! ```text
//! linear rule     q_n = sum over k <= n of dp_k * mean of C over lags t_n - t_k ... t_n - t_(k-1)
//! constant rule   q_n = sum over k <= n of dp_k * C(t_n - t_k)
//! ```
//!
//! The first is exact for a pressure linear within every step, and of second order otherwise; the second is the rule of
//! S. Spinu, Advances in Tribology 2018, 9432894, and of first order. A jump of the drive is a step of length zero. In a
//! damped step ([`Hereditary::stages`]) part of the increment comes at the step's begin, where it counts with C(t_n - t_(k-1)).

use std::borrow::Cow;

use super::hereditary::{Hereditary, PastState};
use super::rule::{DirectWeights, Stage, Step, TimeRule};
use crate::material::interpolant::Interpolant;

/// A contact compliance C(t) as the direct sum needs it.
pub trait ComplianceFunction: Send {
    /// C (1/Pa) at a lag (s), not negative.
    fn compliance_per_pa(&self, lag_s: f64) -> f64;

    /// Mean of C (1/Pa) over lags from `from_s` to `to_s`; C itself where the two are equal. Asked for short intervals at long
    /// lags: to be computed without a difference of integrals.
    fn mean_per_pa(&self, from_s: f64, to_s: f64) -> f64;

    /// The shortest time (s) at which C changes, where there is one.
    fn shortest_time_s(&self) -> Option<f64>;
}

impl ComplianceFunction for Interpolant {
    fn compliance_per_pa(&self, lag_s: f64) -> f64 {
        self.value(lag_s)
    }

    fn mean_per_pa(&self, from_s: f64, to_s: f64) -> f64 {
        self.mean(from_s, to_s)
    }

    fn shortest_time_s(&self) -> Option<f64> {
        Interpolant::shortest_time_s(self)
    }
}

/// A step of the direct sum.
type DirectStep = Step<DirectWeights>;

impl DirectStep {
    /// What a unit increment of this step has become (1/Pa) when `lag_s` have passed since the step's end.
    fn weight_per_pa(&self, compliance: &impl ComplianceFunction, lag_s: f64) -> f64 {
        let begun_s = lag_s + self.step_s;
        let by_rule = match self.weights.rule {
            TimeRule::Linear => compliance.mean_per_pa(lag_s, begun_s),
            TimeRule::Constant => compliance.compliance_per_pa(lag_s),
        };
        match self.weights.at_once {
            0.0 => by_rule,
            at_once => by_rule + at_once * (compliance.compliance_per_pa(begun_s) - by_rule),
        }
    }
}

/// The whole past of every node.
#[derive(Debug, Clone)]
pub struct DirectMemory<C> {
    compliance: C,
    nodes: usize,
    /// Steps taken, and the increment of the pressure over each: step-major, `nodes` values each.
    steps: Vec<DirectStep>,
    increments: Vec<f64>,
    /// The pressure at the end of the last step.
    last: Vec<f64>,
}

impl<C: ComplianceFunction> DirectMemory<C> {
    /// The undisturbed state of `nodes` nodes under this contact compliance.
    pub fn new(compliance: C, nodes: usize) -> Self {
        Self::with_room_for(compliance, nodes, 0)
    }

    /// The same, with room for a number of steps, so that none of them allocates.
    pub fn with_room_for(compliance: C, nodes: usize, steps: usize) -> Self {
        Self {
            compliance,
            nodes,
            steps: Vec::with_capacity(steps),
            increments: Vec::with_capacity(steps * nodes),
            last: vec![0.0; nodes],
        }
    }
}

impl<C: ComplianceFunction> Hereditary for DirectMemory<C> {
    type Weights = DirectWeights;

    fn weights(&self, step_s: f64, rule: TimeRule) -> DirectStep {
        let mut step = DirectStep {
            step_s,
            compliance_per_pa: 0.0,
            weights: DirectWeights { rule, at_once: 0.0 },
        };
        step.compliance_per_pa = step.weight_per_pa(&self.compliance, 0.0);
        step
    }

    /// One stage. Where the linear rule would ring, what the step leaves of the old pressure is kept below half of what the new one does at
    /// once, which makes it of first order there. The constant rule does not ring, and stays as it is.
    fn stages(&self, step_s: f64, rule: TimeRule) -> Vec<Stage<DirectWeights>> {
        let mut step = self.weights(step_s, rule);
        let old = self.compliance.compliance_per_pa(step_s) - step.compliance_per_pa;
        let allowed = 0.5 * self.compliance.compliance_per_pa(0.0);
        if rule == TimeRule::Linear && old > allowed {
            step.weights.at_once = 1.0 - allowed / old;
            step.compliance_per_pa += step.weights.at_once * old;
        }
        vec![Stage::whole(step)]
    }

    fn predict(&mut self, step: &DirectStep, old_pressure: &[f64], history: &mut [f64]) {
        self.last.copy_from_slice(old_pressure);
        // The new increment is the new pressure, which A multiplies, less the old one.
        for (h, &p) in history.iter_mut().zip(old_pressure) {
            *h = -step.compliance_per_pa * p;
        }
        // Lags are summed from the present backwards: a short step stays exact however long the past.
        let mut lag_s = step.step_s;
        let past = self.increments.chunks_exact(self.nodes.max(1));
        for (increment, taken) in past.zip(&self.steps).rev() {
            let weight = taken.weight_per_pa(&self.compliance, lag_s);
            for (h, &dp) in history.iter_mut().zip(increment) {
                *h += weight * dp;
            }
            lag_s += taken.step_s;
        }
    }

    fn commit(&mut self, step: &DirectStep, new_pressure: &[f64]) {
        self.steps.push(*step);
        let change = new_pressure.iter().zip(&self.last);
        self.increments.extend(change.map(|(new, old)| new - old));
    }

    fn shortest_time_s(&self) -> Option<f64> {
        self.compliance.shortest_time_s()
    }

    fn state(&self) -> PastState<'_> {
        PastState {
            nodal: [&self.increments, &self.last]
                .map(|field| Cow::Borrowed(&field[..]))
                .into(),
            steps: Cow::Borrowed(&self.steps),
        }
    }

    fn restore(&mut self, state: PastState<'_>) -> bool {
        let Ok([increments, last]) = <[_; 2]>::try_from(state.nodal) else {
            return false;
        };
        let fits = increments.len() == state.steps.len() * self.nodes && last.len() == self.nodes;
        if fits {
            self.steps = state.steps.into_owned();
            // Into the room there is for those to come.
            increments.as_ref().clone_into(&mut self.increments);
            self.last = last.into_owned();
        }
        fits
    }
}

#[cfg(test)]
mod tests {
    use super::super::rule::StepWeights;
    use super::*;
    use crate::history::Memory;
    use crate::material::{
        Creep, CreepBranch, MaterialFunction, ModulusKind, library, tabulated::Tabulated,
    };

    impl ComplianceFunction for Creep {
        fn compliance_per_pa(&self, lag_s: f64) -> f64 {
            self.compliance(lag_s)
        }

        fn mean_per_pa(&self, from_s: f64, to_s: f64) -> f64 {
            let delayed = self.branches().iter().map(|branch| {
                let (from, length) = (from_s / branch.time_s, (to_s - from_s) / branch.time_s);
                // Mean of exp(-x) over the interval.
                let left = if length > 0.0 {
                    (-from).exp() * (-(-length).exp_m1() / length)
                } else {
                    (-from).exp()
                };
                branch.compliance_per_pa * (1.0 - left)
            });
            let flow = self
                .viscosity_pa_s()
                .map_or(0.0, |eta| 0.5 * (from_s + to_s) / eta);
            self.instantaneous_compliance() + delayed.sum::<f64>() + flow
        }

        fn shortest_time_s(&self) -> Option<f64> {
            self.branches().first().map(|branch| branch.time_s)
        }
    }

    /// Any function of the lag (s), in 1/Pa, with means by quadrature: smooth on the scale of `shortest_time_s` near lag zero,
    /// and on that of the lag itself beyond.
    #[derive(Debug, Clone, Copy)]
    struct Quadrature<F> {
        compliance_per_pa: F,
        shortest_time_s: f64,
    }

    /// Nodes on (0, 1) and weights of the Gauss-Legendre rule of five points, exact for polynomials of degree nine.
    const GAUSS: [(f64, f64); 5] = [
        (0.046_910_077_030_668_004, 0.118_463_442_528_094_54),
        (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
        (0.5, 0.284_444_444_444_444_44),
        (0.769_234_655_052_841_6, 0.239_314_335_249_683_23),
        (0.953_089_922_969_332, 0.118_463_442_528_094_54),
    ];

    impl<F: Fn(f64) -> f64 + Send> ComplianceFunction for Quadrature<F> {
        fn compliance_per_pa(&self, lag_s: f64) -> f64 {
            (self.compliance_per_pa)(lag_s)
        }

        fn mean_per_pa(&self, from_s: f64, to_s: f64) -> f64 {
            if to_s <= from_s {
                return (self.compliance_per_pa)(from_s);
            }
            // Pieces that double in length, the first as long as the function is smooth.
            let (mut sum, mut from) = (0.0, from_s);
            while from < to_s {
                let length = from.max(self.shortest_time_s).min(to_s - from);
                let value = |&(x, weight): &(f64, f64)| {
                    weight * (self.compliance_per_pa)(from + x * length)
                };
                sum += length * GAUSS.iter().map(value).sum::<f64>();
                let next = from + length;
                from = if next > from { next } else { to_s };
            }
            sum / (to_s - from_s)
        }

        fn shortest_time_s(&self) -> Option<f64> {
            Some(self.shortest_time_s)
        }
    }

    fn pmma() -> Creep {
        let material = library::find("pmma").unwrap().material().unwrap();
        material.contact_compliance().unwrap()
    }

    /// q at every instant, of three nodes whose pressures rise, oscillate and jump.
    fn march<M: Hereditary>(memory: M, rule: TimeRule, steps: &[f64]) -> Vec<f64> {
        let weights = |memory: &M, step_s| memory.weights(step_s, rule);
        march_with(memory, weights, steps)
    }

    fn march_with<M: Hereditary>(
        mut memory: M,
        weights: impl Fn(&M, f64) -> Step<M::Weights>,
        steps: &[f64],
    ) -> Vec<f64> {
        let pressure = |time: f64, jumps: f64| {
            [
                time,
                1e2 * (0.05 * time).sin(),
                50.0 * jumps * (-time / 40.0).exp(),
            ]
        };
        let (mut time, mut jumps) = (0.0, 0.0);
        let mut p = [0.0; 3];
        let mut q = Vec::new();
        for &step in steps {
            let weights = weights(&memory, step);
            let mut history = [f64::NAN; 3];
            memory.predict(&weights, &p, &mut history);
            time += step;
            jumps += f64::from(step == 0.0);
            p = pressure(time, jumps);
            memory.commit(&weights, &p);
            let a = weights.compliance_per_pa;
            q.extend(history.iter().zip(p).map(|(h, p)| h + a * p));
        }
        q
    }

    fn largest_difference(left: &[f64], right: &[f64]) -> f64 {
        let scale = right.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let differences = left.iter().zip(right).map(|(a, b)| (a - b).abs());
        differences.fold(0.0, f64::max) / scale
    }

    /// Equal steps; and unequal ones over eight decades with jumps among them.
    fn step_lists() -> [Vec<f64>; 2] {
        let unequal = (0..200).map(|i| match i % 9 {
            0 => 0.0,
            k => 1e-5 * 10_f64.powf(0.9 * f64::from(k)) * (1.0 + 0.3 * f64::from(i % 7)),
        });
        [vec![2.5; 200], unequal.collect()]
    }

    #[test]
    fn the_direct_sum_and_the_recursion_agree_on_pmma_whatever_the_steps() {
        let flowing = Creep::new(3e-10, pmma().branches().to_vec(), Some(1e12)).unwrap();
        for compliance in [pmma(), flowing] {
            for steps in step_lists() {
                for rule in [TimeRule::Linear, TimeRule::Constant] {
                    let direct = march(DirectMemory::new(compliance.clone(), 3), rule, &steps);
                    let recursive = march(Memory::new(compliance.clone(), 3), rule, &steps);
                    let difference = largest_difference(&direct, &recursive);
                    println!("{rule:?} {difference:e}");
                    // 200 steps of a few roundings each.
                    assert!(difference < 1e-13, "{rule:?} {difference:e}");
                }
            }
        }
    }

    #[test]
    fn the_constant_rule_is_not_damped_on_a_body_that_relaxes_strongly() {
        let branch = CreepBranch {
            compliance_per_pa: 1e-7,
            time_s: 0.3,
        };
        let creep = Creep::new(1e-9, vec![branch], None).unwrap();
        let steps = [0.1; 60];
        let direct = march_with(
            DirectMemory::new(creep.clone(), 3),
            |memory, step_s| {
                let [stage] = memory
                    .stages(step_s, TimeRule::Constant)
                    .try_into()
                    .unwrap();
                stage.weights
            },
            &steps,
        );
        let recursive = march(Memory::new(creep, 3), TimeRule::Constant, &steps);
        let difference = largest_difference(&direct, &recursive);
        assert!(difference < 1e-13, "{difference:e}");
    }

    #[test]
    fn damped_steps_of_a_body_that_relaxes_strongly_leave_a_held_pressure_exact_and_do_not_ring() {
        let branch = |compliance_per_pa, time_s| CreepBranch {
            compliance_per_pa,
            time_s,
        };
        let branches = vec![branch(5e-9, 0.02), branch(4e-7, 3.0)];
        let creep = Creep::new(1e-9, branches, None).unwrap();
        let damped = |memory: &DirectMemory<Creep>, step_s| {
            let [stage] = memory.stages(step_s, TimeRule::Linear).try_into().unwrap();
            stage.weights
        };
        let mut held = DirectMemory::new(creep.clone(), 1);
        let (mut time, mut last, mut history) = (0.0, 0.0, [0.0]);
        for step in [0.0, 0.5, 7.0, 40.0] {
            let weights = damped(&held, step);
            held.predict(&weights, &[last], &mut history);
            (time, last) = (time + step, 2.0);
            held.commit(&weights, &[last]);
            let q = weights.compliance_per_pa * last + history[0];
            assert!((q / (2.0 * creep.compliance(time)) - 1.0).abs() < 1e-14);
        }
        // The force of a spring whose shortening is held falls to what the equilibrium leaves of it.
        let mut relaxing = DirectMemory::new(creep.clone(), 1);
        let (mut force, mut forces) = (0.0, Vec::new());
        for step in [vec![0.0], vec![0.1; 200]].concat() {
            let weights = damped(&relaxing, step);
            relaxing.predict(&weights, &[force], &mut history);
            force = (1e-9 - history[0]) / weights.compliance_per_pa;
            relaxing.commit(&weights, &[force]);
            forces.push(force);
        }
        assert!(forces.iter().all(|f| *f > 0.0));
        assert!((forces[200] * creep.equilibrium_compliance().unwrap() / 1e-9 - 1.0).abs() < 0.05);
    }

    #[test]
    fn a_function_with_means_by_quadrature_is_as_good() {
        let compliance = pmma();
        let closure = Quadrature {
            compliance_per_pa: |lag_s| compliance.compliance(lag_s),
            shortest_time_s: 5.0,
        };
        for steps in step_lists() {
            let direct = march(DirectMemory::new(closure, 3), TimeRule::Linear, &steps);
            let exact = march(Memory::new(compliance.clone(), 3), TimeRule::Linear, &steps);
            // Five points over half a retardation time: error of order 0.5^10/10!, relative to 0.1 of the compliance.
            assert!(largest_difference(&direct, &exact) < 1e-10);
        }
    }

    #[test]
    fn a_power_law_meets_its_closed_form_under_a_ramp() {
        // C = t^n and p = t: q = t^(n+1)/(n+1), at any step length, because the pressure is linear.
        let n = 0.25;
        let closure = Quadrature {
            compliance_per_pa: |lag_s: f64| lag_s.powf(n),
            shortest_time_s: 1e-12,
        };
        let mut memory = DirectMemory::new(closure, 1);
        let (mut time, mut p) = (0.0, 0.0);
        for step in [0.1, 1e-3, 4.0, 0.5, 20.0] {
            let weights = memory.weights(step, TimeRule::Linear);
            let mut history = [0.0];
            memory.predict(&weights, &[p], &mut history);
            time += step;
            p = time;
            memory.commit(&weights, &[p]);
            let q = weights.compliance_per_pa * p + history[0];
            // Five points over a factor of two in the lag.
            assert!(
                (q / (time.powf(n + 1.0) / (n + 1.0)) - 1.0).abs() < 1e-8,
                "{q}"
            );
        }
    }

    #[test]
    fn the_linear_rule_is_of_second_order_and_the_constant_rule_of_first() {
        let exact = {
            let steps = vec![100.0 / 3200.0; 3200];
            *march(Memory::new(pmma(), 3), TimeRule::Linear, &steps)
                .iter()
                .nth_back(1)
                .unwrap()
        };
        for (rule, expected) in [(TimeRule::Linear, 2.0), (TimeRule::Constant, 1.0)] {
            let error = |count: usize| {
                let steps = vec![100.0 / count as f64; count];
                let q = march(DirectMemory::new(pmma(), 3), rule, &steps);
                (q.iter().nth_back(1).unwrap() - exact).abs()
            };
            let order = (error(100) / error(200)).log2();
            // The reference is 256 times as accurate as the finer of the two.
            assert!((order - expected).abs() < 0.05, "{rule:?} {order}");
        }
    }

    #[test]
    fn a_held_pressure_creeps_with_the_table() {
        let times: Vec<f64> = (0..=40)
            .map(|i| 0.1 * 10_f64.powf(f64::from(i) / 10.0))
            .collect();
        let values = times.iter().map(|&t| pmma().compliance(t)).collect();
        let table =
            Tabulated::new(MaterialFunction::Creep, ModulusKind::Shear, times, values).unwrap();
        let curve = table.curve().clone();
        let mut memory = DirectMemory::with_room_for(curve.clone(), 1, 4);
        let (mut time, mut p) = (0.0, 0.0);
        for step in [0.0, 0.3, 7.0, 2000.0] {
            let weights = memory.weights(step, TimeRule::Linear);
            let mut history = [0.0];
            memory.predict(&weights, &[p], &mut history);
            time += step;
            p = 3.0;
            memory.commit(&weights, &[p]);
            let q = weights.compliance_per_pa * p + history[0];
            assert!((q / (3.0 * curve.value(time)) - 1.0).abs() < 1e-14);
        }
        let PastState { nodal, steps } = memory.state();
        assert_eq!((nodal.concat().len(), steps.len()), (5, 4));
    }

    #[test]
    fn means_of_a_series_are_exact_over_short_and_long_lags() {
        let branch = CreepBranch {
            compliance_per_pa: 2.0,
            time_s: 3.0,
        };
        let creep = Creep::new(1.0, vec![branch], Some(10.0)).unwrap();
        // Closed form of the integral from 0 to t.
        let integral = |t: f64| 3.0 * t + 6.0 * (-t / 3.0_f64).exp_m1() + 0.05 * t * t;
        for (a, b) in [(0.0, 1.0), (1.0, 2.0), (0.0, 100.0), (5.0, 50.0)] {
            let exact = (integral(b) - integral(a)) / (b - a);
            assert!((creep.mean_per_pa(a, b) / exact - 1.0).abs() < 1e-14);
        }
        // A millionth of a second, a week later: the mean is the value there, to every digit.
        let (a, b) = (6e5, 6e5 + 1e-6);
        assert!((creep.mean_per_pa(a, b) / creep.compliance(a) - 1.0).abs() < 1e-11);
        assert_eq!(creep.mean_per_pa(2.0, 2.0), creep.compliance(2.0));
        let weights = StepWeights::new(&creep, 0.7, TimeRule::Linear);
        assert!((creep.mean_per_pa(0.0, 0.7) / weights.compliance_per_pa - 1.0).abs() < 1e-14);
    }
}
