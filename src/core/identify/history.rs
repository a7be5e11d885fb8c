//! Measured histories: what a step, a ramp and a hold leave of approach or load, by the exact model and by one that needs no contact.
//!
//! While a contact grows, W C of an elastic body becomes the convolution of the load with the creep compliance, and the load of an
//! elastic body the convolution of E with its load per modulus (E. H. Lee and J. R. M. Radok, J. Appl. Mech. 27, 1960, 438):
//!
//! ```text
//! F(delta(t)) = integral of C(t - s) dW(s),      W(t) = integral of E(t - s)/(1 - nu^2) dF(delta(s)),      dF/d(delta) = 2 a(delta)
//! ```
//!
//! Both are exact for a body of revolution as long as the contact does not shrink, and close to it afterwards: what is missing is in
//! the factors that the exact model gives.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::drive::{Control, Schedule, SegmentedDrive, Steps};
use crate::identify::data::{Datum, Number};
use crate::identify::series::Point;
use crate::identify::{Driven, IdentifyError, IdentifyPlan};
use crate::indenter::Indenter;
use crate::material::{Creep, MaterialError, Relaxation};
use crate::simulation::between::values_at;
use crate::simulation::scenario::ScenarioPlan;
use crate::simulation::{HistoryRow, Simulation, SimulationEnd, SimulationOutcome};

/// Load per modulus and approach of an elastic contact, between points that are joined by powers.
struct Elastic {
    /// Logarithms of approaches (m) and of F (m^2), ascending.
    ln_approach: Vec<f64>,
    ln_load: Vec<f64>,
}

impl Elastic {
    /// From a hundredth of an atom to a metre.
    const RANGE_M: (f64, f64) = (1e-12, 1.0);
    const PER_DECADE: f64 = 20.0;

    fn new(indenter: &dyn Indenter) -> Self {
        let (low, high) = Self::RANGE_M;
        let count = ((high / low).log10() * Self::PER_DECADE) as i32;
        let approach = |k: i32| low * 10_f64.powf(f64::from(k) / Self::PER_DECADE);
        let half_width = |k: i32| indenter.half_widths_under_approach_m(approach(k)).0;
        let (mut ln_approach, mut ln_load) = (Vec::new(), Vec::new());
        // From nothing to the first point a power, half of it for a cone and all for a punch.
        let mut load = 1.5 * approach(0) * half_width(0);
        for k in 0..=count {
            if k > 0 {
                load += (half_width(k) + half_width(k - 1)) * (approach(k) - approach(k - 1));
            }
            if load.is_finite() && load > 0.0 {
                ln_approach.push(approach(k).ln());
                ln_load.push(load.ln());
            }
        }
        Self {
            ln_approach,
            ln_load,
        }
    }

    /// F (m^2) of an approach (m); 0 above the surface.
    fn load(&self, approach_m: f64) -> f64 {
        match approach_m > 0.0 {
            true => between(&self.ln_approach, &self.ln_load, approach_m.ln()).exp(),
            false => 0.0,
        }
    }

    /// The approach (m) of F (m^2).
    fn approach_m(&self, load: f64) -> f64 {
        match load > 0.0 {
            true => between(&self.ln_load, &self.ln_approach, load.ln()).exp(),
            false => 0.0,
        }
    }
}

/// The straight line through the two points about `at`, or the two at the end that it lies beyond.
fn between(x: &[f64], y: &[f64], at: f64) -> f64 {
    let above = x.partition_point(|x| *x < at);
    let above = above.clamp(1, x.len().saturating_sub(1).max(1));
    match (x.get(above - 1..=above), y.get(above - 1..=above)) {
        (Some([a, b]), Some([of_a, of_b])) if b > a => of_a + (of_b - of_a) * (at - a) / (b - a),
        _ => f64::NAN,
    }
}

/// A history without its contact.
pub(super) struct LinearHistory<'a> {
    plan: &'a IdentifyPlan,
    control: Control,
    elastic: Elastic,
    /// Length (s) and values at beginning and end of every step of what is convolved: load (N), or F (m^2).
    steps: Vec<(f64, f64, f64)>,
    /// For each datum how many steps lead to it.
    ends: Vec<usize>,
}

impl<'a> LinearHistory<'a> {
    /// The history of a plan; `None` where its data lie outside the drive.
    pub(super) fn new(plan: &'a IdentifyPlan, drive: &SegmentedDrive) -> Option<Self> {
        let times: Vec<f64> = (plan.measurements.data().iter())
            .map(Datum::time_s)
            .collect();
        let chosen = Steps::Chosen {
            shortest_time_s: None,
        };
        let schedule = Schedule::new(drive, chosen, &times).ok()?;
        let elastic = Elastic::new(plan.contact.indenter.as_ref());
        let convolved = |value: f64| match drive.control() {
            Control::Load => value,
            Control::Approach => elastic.load(value),
        };
        let mut before = 0.0;
        let steps = schedule.moments.iter().map(|moment| {
            let value = convolved(moment.value);
            (moment.step_s, std::mem::replace(&mut before, value), value)
        });
        Some(Self {
            control: drive.control(),
            steps: steps.collect(),
            ends: schedule.requested.iter().map(|moment| moment + 1).collect(),
            plan,
            elastic,
        })
    }

    /// The number of every datum; `None` where the pair has no compliance.
    pub(super) fn numbers(&self, point: &Point) -> Option<Vec<f64>> {
        let known = &self.plan.contact.material;
        let nu = known.compressibility.poisson_ratio();
        Some(match (self.control, &known.indenter_material, nu) {
            (Control::Approach, None, Some(nu)) => {
                let loads = self.convolved(point.equilibrium_pa(), &point.branches_pa_s());
                loads.iter().map(|load| load / (1.0 - nu * nu)).collect()
            }
            (Control::Approach, ..) => {
                let modulus = self.compliance(point)?.to_relaxation().ok()?;
                let branches = modulus.branches().iter();
                let branches: Vec<_> = branches.map(|b| (b.modulus_pa, b.time_s)).collect();
                self.convolved(modulus.equilibrium_modulus(), &branches)
            }
            (Control::Load, ..) => {
                let creep = self.compliance(point)?;
                let branches = || creep.branches().iter();
                let late: f64 = branches().map(|b| b.compliance_per_pa).sum();
                let falling = branches().map(|b| (-b.compliance_per_pa, b.time_s));
                let falling: Vec<_> = falling.collect();
                let products = self.convolved(creep.instantaneous_compliance() + late, &falling);
                let approach = |product: &f64| self.elastic.approach_m(*product);
                products.iter().map(approach).collect()
            }
        })
    }

    /// The contact compliance (1/Pa) of the pair; `None` where it has none.
    fn compliance(&self, point: &Point) -> Option<Creep> {
        let pair = self.plan.material(&point.relaxation().ok()?).ok()?;
        pair.contact_compliance().ok()
    }

    /// The convolution of the steps with `constant` + sum of w exp(-t/tau), at every datum.
    fn convolved(&self, constant: f64, branches: &[(f64, f64)]) -> Vec<f64> {
        let mut states = vec![0.0; branches.len()];
        let mut after = Vec::with_capacity(self.steps.len());
        for (step_s, before, value) in &self.steps {
            let change = value - before;
            let mut sum = constant * value;
            for ((weight, time_s), state) in branches.iter().zip(&mut states) {
                let ratio = step_s / time_s;
                // (1 - exp(-r))/r, which is 1 for a jump.
                let part = if ratio > 0.0 {
                    -(-ratio).exp_m1() / ratio
                } else {
                    1.0
                };
                *state = *state * (-ratio).exp() + change * part;
                sum += weight * *state;
            }
            after.push(sum);
        }
        let at = |end: &usize| after.get(end - 1).copied().unwrap_or(f64::NAN);
        self.ends.iter().map(at).collect()
    }
}

/// The history that a solid has under the drive of a plan.
pub(super) fn followed(
    plan: &IdentifyPlan,
    drive: &SegmentedDrive,
    series: &Relaxation,
    interrupt: &AtomicBool,
) -> Result<SimulationOutcome, IdentifyError> {
    // A trial that the bulk modulus does not allow.
    let material = plan.material(series).map_err(|error| match error {
        MaterialError::SmallBulkModulus { .. } => IdentifyError::NoHistory(error.to_string()),
        error => error.into(),
    })?;
    let mut scenario = ScenarioPlan::of(
        plan.contact.with_material(material.into()),
        plan.solver,
        drive.clone(),
    );
    scenario.output.error_bars = false;
    let simulation = Simulation::new(scenario);
    let simulation = simulation.map_err(|error| IdentifyError::NoHistory(error.to_string()))?;
    let outcome = simulation.run(interrupt, &|_, _| {});
    match outcome.ended {
        _ if interrupt.load(Ordering::Relaxed) => Err(IdentifyError::Interrupted),
        SimulationEnd::Failed(why) => Err(IdentifyError::NoHistory(why)),
        SimulationEnd::Interrupted => Err(IdentifyError::Interrupted),
        SimulationEnd::Done => Ok(outcome),
    }
}

/// What is measured under a control.
pub(super) fn response(control: Control) -> (Number, fn(&HistoryRow) -> Option<f64>) {
    match control {
        Control::Load => (Number::Approach, |row| row.approach_m),
        Control::Approach => (Number::Load, |row| Some(row.load_n)),
    }
}

/// The computed number of every datum of a history, for one solid.
pub(super) fn numbers(
    plan: &IdentifyPlan,
    drive: &SegmentedDrive,
    series: &Relaxation,
    interrupt: &AtomicBool,
) -> Result<Vec<f64>, IdentifyError> {
    let outcome = followed(plan, drive, series, interrupt)?;
    let data = plan.measurements.data();
    let times: Vec<f64> = data.iter().map(Datum::time_s).collect();
    let (_, value) = response(drive.control());
    let found = values_at(drive, &outcome.rows, &times, value).into_iter();
    let defined = found
        .zip(data)
        .map(|(number, datum)| number.ok_or_else(|| datum.undefined()));
    defined.collect()
}

impl Driven {
    /// What is prescribed.
    pub fn control(&self) -> Control {
        match self {
            Self::Cycles(drive) => drive.control(),
            Self::History(drive) => drive.control(),
        }
    }

    /// The drive of a history.
    pub fn history(&self) -> Option<&SegmentedDrive> {
        match self {
            Self::Cycles(_) => None,
            Self::History(drive) => Some(drive),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indenter::{Cone, FlatPunch, Sphere};

    #[test]
    fn an_elastic_contact_is_that_of_hertz_sneddon_and_a_punch() {
        let sphere = Elastic::new(&Sphere::new(0.01).unwrap());
        // 4/3 sqrt(R) delta^(3/2), by the trapezium rule on a grid of 12 %.
        let hertz = 4.0 / 3.0 * (0.01_f64 * 1e-5_f64.powi(3)).sqrt();
        assert!((sphere.load(1e-5) / hertz - 1.0).abs() < 2e-3);
        assert!((sphere.approach_m(hertz) / 1e-5 - 1.0).abs() < 2e-3);
        let punch = Elastic::new(&FlatPunch::new(1e-3).unwrap());
        assert!((punch.load(1e-5) / (2e-3 * 1e-5) - 1.0).abs() < 2e-3);
        let half_angle = 70_f64.to_radians();
        let cone = Elastic::new(&Cone::new(half_angle).unwrap());
        let sneddon = 2.0 / std::f64::consts::PI * half_angle.tan() * 1e-10;
        assert!((cone.load(1e-5) / sneddon - 1.0).abs() < 3e-3);
        assert_eq!(cone.load(-1.0), 0.0);
    }
}
