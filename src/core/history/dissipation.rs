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

use super::memory::Memory;
use super::rule::TimeRule;
use crate::contact::{ContactError, Engine};
use crate::material::Creep;

/// Energies of a number of equal steps, added up.
pub struct Dissipation {
    nodes: usize,
    branches: Vec<Branch>,
    rule: TimeRule,
    /// Memory at the start of the step; then d there. Branch-major.
    deviation: Vec<f64>,
    /// Pressure at the start of the last stage, at this fraction of the step; then that at the start of the step.
    passed: f64,
    pressure: Vec<f64>,
    /// Its change over the step.
    change: Vec<f64>,
    /// B applied to d of one branch and to the change.
    of_deviation: Vec<f64>,
    of_change: Vec<f64>,
}

/// One branch: compliance (1/Pa), energy so far (J), and the integrals over a step of the products of
/// exp(-t/lambda) and (1 - exp(-t/lambda)) lambda/step, in units of lambda.
#[derive(Debug, Clone, Copy)]
struct Branch {
    compliance_per_pa: f64,
    energy_j: f64,
    decaying: f64,
    mixed: f64,
    growing: f64,
}

impl Dissipation {
    /// Nothing dissipated yet by a body of this contact compliance, seen through steps of `step_s` over `nodes` nodes.
    pub fn new(compliance: &Creep, nodes: usize, step_s: f64, rule: TimeRule) -> Self {
        let branches: Vec<Branch> = compliance
            .branches()
            .iter()
            .map(|branch| Branch::new(branch.compliance_per_pa, step_s / branch.time_s))
            .collect();
        Self {
            nodes,
            rule,
            deviation: vec![0.0; nodes * branches.len()],
            branches,
            passed: 0.0,
            pressure: vec![0.0; nodes],
            change: vec![0.0; nodes],
            of_deviation: vec![0.0; nodes],
            of_change: vec![0.0; nodes],
        }
    }

    /// Energy (J) that each branch dissipated, in the order of the compliance's branches.
    pub fn branch_energies_j(&self) -> Vec<f64> {
        self.branches.iter().map(|b| b.energy_j).collect()
    }

    /// Takes in the state at the start of a step.
    pub(super) fn begin(&mut self, memory: &Memory) {
        self.deviation.copy_from_slice(memory.variables());
    }

    /// Takes in the pressure at the start of a stage, at this fraction of the step.
    pub(super) fn passes(&mut self, fraction: f64, pressure: &[f64]) {
        self.passed = fraction;
        self.pressure.copy_from_slice(pressure);
    }

    /// Takes in the pressure at the end of a step; returns the convolutions that took. Within the step the pressure is linear
    /// through its values at the start of the last stage and at the end.
    pub(super) fn end(
        &mut self,
        engine: &mut dyn Engine,
        pressure: &[f64],
    ) -> Result<usize, ContactError> {
        let (passed, rule) = (self.passed, self.rule);
        for ((start, change), end) in self.pressure.iter_mut().zip(&mut self.change).zip(pressure) {
            // Under the constant rule the pressure stays as it was until the step is over.
            *change = match rule {
                TimeRule::Linear => (end - *start) / (1.0 - passed),
                TimeRule::Constant => 0.0,
            };
            *start -= passed * *change;
        }
        for deviation in self.deviation.chunks_exact_mut(self.nodes) {
            for (d, p) in deviation.iter_mut().zip(&self.pressure) {
                *d = p - *d;
            }
        }
        let mut convolutions = engine.elastic_displacement(&self.change, &mut self.of_change)?;
        let changing = engine.work(&self.change, &self.of_change);
        let deviations = self.deviation.chunks_exact(self.nodes);
        for (branch, deviation) in self.branches.iter_mut().zip(deviations) {
            convolutions += engine.elastic_displacement(deviation, &mut self.of_deviation)?;
            let decaying = engine.work(deviation, &self.of_deviation);
            let mixed = engine.work(&self.change, &self.of_deviation);
            branch.energy_j += branch.compliance_per_pa
                * (branch.decaying * decaying
                    + 2.0 * branch.mixed * mixed
                    + branch.growing * changing);
        }
        Ok(convolutions)
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
