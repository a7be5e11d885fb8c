//! What a march dissipates, and how much of it in which relaxation branch.
//!
//! A branch of the compliance is a spring C_j beside a dashpot; the dashpot takes
//!
//! ```text
//! C_j/lambda_j * integral over time of <d, B d>,      d = p - m_j
//! ```
//!
//! with <a, b> the sum over the surface of a pressure and a displacement, and B the elastic operator. Over a stabilised cycle
//! the sum over the branches is the area of the loop, by another route: nothing here knows of the loop. Within a step the
//! integral is exact for the pressure the time rule assumes, at any ratio of step to retardation time.

use super::displaced::Displaced;
use super::memory::Memory;
use super::rule::TimeRule;
use crate::contact::{Engine, sums};

/// Energies of a number of equal steps, added up.
pub struct Dissipation {
    nodes: usize,
    branches: Vec<Branch>,
    rule: TimeRule,
    /// What the state of the march displaces.
    pub(super) displaced: Displaced,
    /// d at the start of the step. Branch-major.
    deviation: Vec<f64>,
    /// At the start of the step, and at that of its last stage, which is at this fraction of it.
    start: Pressed,
    last: Pressed,
    passed: f64,
}

/// A pressure, and the displacement by it.
#[derive(Debug, Default)]
struct Pressed {
    pressure: Vec<f64>,
    displacement: Vec<f64>,
}

impl Pressed {
    fn set(&mut self, pressure: &[f64], displaced: &Displaced) {
        pressure.clone_into(&mut self.pressure);
        displaced.of_pressure.clone_into(&mut self.displacement);
    }
}

/// One branch: compliance (1/Pa), energy so far (J), <d, B d> at the start of the step, and the integrals over a step of the products of
/// exp(-t/lambda) and (1 - exp(-t/lambda)) lambda/step, in units of lambda.
#[derive(Debug, Clone, Copy)]
struct Branch {
    compliance_per_pa: f64,
    energy_j: f64,
    at_start: f64,
    decaying: f64,
    mixed: f64,
    growing: f64,
}

impl Dissipation {
    /// Nothing dissipated yet, in steps of `step_s` from a state on that displaces this.
    pub(super) fn new(displaced: Displaced, step_s: f64, rule: TimeRule) -> Self {
        let (nodes, memory) = (displaced.of_pressure.len(), &displaced.memory);
        let branches = memory.compliance().branches().iter();
        Self {
            nodes,
            rule,
            deviation: vec![0.0; memory.variables().len()],
            branches: branches
                .map(|branch| Branch::new(branch.compliance_per_pa, step_s / branch.time_s))
                .collect(),
            displaced,
            start: Pressed::default(),
            last: Pressed::default(),
            passed: 0.0,
        }
    }

    /// Energy (J) that each branch dissipated, in the order of the compliance's branches.
    pub fn branch_energies_j(&self) -> Vec<f64> {
        self.branches.iter().map(|b| b.energy_j).collect()
    }

    /// Takes in the state at the start of a step.
    pub(super) fn begin(&mut self, engine: &dyn Engine, pressure: &[f64], memory: &Memory) {
        let displaced = &mut self.displaced;
        self.start.set(pressure, displaced);
        let deviations = self.deviation.chunks_exact_mut(self.nodes);
        let memories = memory.variables().chunks_exact(self.nodes);
        let branches = self.branches.iter_mut().zip(deviations.zip(memories));
        for (number, (branch, (deviation, memory))) in branches.enumerate() {
            deviation.copy_from_slice(pressure);
            sums::add_scaled(deviation, -1.0, memory);
            branch.at_start = engine.work(deviation, displaced.of_deviation(number));
        }
    }

    /// Takes in the start of a stage, at this fraction of the step.
    pub(super) fn passes(&mut self, fraction: f64, pressure: &[f64]) {
        self.passed = fraction;
        self.last.set(pressure, &self.displaced);
    }

    /// Takes in the pressure at the end of a step. Within the step the pressure is linear through its values at the start of the last
    /// stage and at the end.
    pub(super) fn end(&mut self, engine: &dyn Engine, pressure: &[f64]) {
        // What is at the start of the last stage becomes the change over the step; at the start, by how much more the line has there.
        let (rule, passed) = (self.rule, self.passed);
        let line = |last: &mut [f64], start: &mut [f64], end: &[f64]| {
            for ((last, start), end) in last.iter_mut().zip(start).zip(end) {
                // Under the constant rule the pressure stays as it was until the step is over.
                let change = match rule {
                    TimeRule::Linear => (end - *last) / (1.0 - passed),
                    TimeRule::Constant => 0.0,
                };
                *start = *last - passed * change - *start;
                *last = change;
            }
        };
        let (last, start) = (&mut self.last, &mut self.start);
        line(&mut last.pressure, &mut start.pressure, pressure);
        let displacement = &self.displaced.of_pressure;
        line(
            &mut last.displacement,
            &mut start.displacement,
            displacement,
        );
        let (change, more) = (&self.last, &self.start);
        let changing = engine.work(&change.pressure, &change.displacement);
        let mixed = engine.work(&change.pressure, &more.displacement);
        let more_alone = engine.work(&more.pressure, &more.displacement);
        let deviations = self.deviation.chunks_exact(self.nodes);
        for (branch, deviation) in self.branches.iter_mut().zip(deviations) {
            let decaying =
                branch.at_start + 2.0 * engine.work(deviation, &more.displacement) + more_alone;
            let mixed = mixed + engine.work(deviation, &change.displacement);
            branch.energy_j += branch.compliance_per_pa
                * (branch.decaying * decaying
                    + 2.0 * branch.mixed * mixed
                    + branch.growing * changing);
        }
    }
}

impl Branch {
    /// With z = step/lambda, over tau from 0 to z: the integrals of e^(-2 tau), e^(-tau) (1 - e^(-tau)) / z and
    /// (1 - e^(-tau))^2 / z^2.
    fn new(compliance_per_pa: f64, z: f64) -> Self {
        let grown = -(-z).exp_m1();
        Self {
            compliance_per_pa,
            energy_j: 0.0,
            at_start: 0.0,
            decaying: -0.5 * (-2.0 * z).exp_m1(),
            mixed: 0.5 * grown * grown / z,
            growing: growing_weight(z),
        }
    }
}

/// [z - 2 (1 - e^-z) + (1 - e^-2z)/2] / z^2, by its Taylor series where the difference would lose digits.
fn growing_weight(z: f64) -> f64 {
    // At z = 0.5 the difference loses less than two digits; the series is the sum over n of (-1)^n (2^n - 2)/(n + 1)! z^(n-1),
    // whose 20th term is below 1e-18 of the first there.
    if z > 0.5 {
        return (z + 2.0 * (-z).exp_m1() - 0.5 * (-2.0 * z).exp_m1()) / (z * z);
    }
    let (mut power, mut factorial, mut sum) = (z, 6.0, 0.0);
    for n in 2..=20_i32 {
        sum += (2_f64.powi(n) - 2.0) / factorial * power;
        power *= -z;
        factorial *= f64::from(n + 2);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_are_the_integrals_they_stand_for_at_any_step() {
        for z in [1e-9, 1e-3, 0.1, 0.499, 0.501, 3.0, 40.0, 1e5] {
            let branch = Branch::new(1.0, z);
            // Simpson's rule in s with tau = z s^4, which resolves the fast start of long steps.
            let integral = |f: &dyn Fn(f64) -> f64| {
                let n = 20_000;
                let g = |k: i32| {
                    let s = f64::from(k) / f64::from(n);
                    f(z * s.powi(4)) * 4.0 * z * s.powi(3)
                };
                let inner: f64 = (1..n)
                    .map(|k| if k % 2 == 1 { 4.0 } else { 2.0 } * g(k))
                    .sum();
                (g(0) + inner + g(n)) / (3.0 * f64::from(n))
            };
            let grown = |t: f64| -(-t).exp_m1() / z;
            for (weight, expected) in [
                (branch.decaying, integral(&|t| (-2.0 * t).exp())),
                (branch.mixed, integral(&|t| (-t).exp() * grown(t))),
                (branch.growing, integral(&|t| grown(t).powi(2))),
            ] {
                // Simpson's own error at 20000 points, largest for the longest step.
                assert!(
                    (weight / expected - 1.0).abs() < 1e-9,
                    "{z}: {weight} {expected}"
                );
            }
        }
    }
}
