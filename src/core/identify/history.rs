//! Measured histories: what a step, a ramp and a hold leave of approach or load, by the exact model and by one that needs no contact.
//!
//! While a contact grows, W C of an elastic body becomes the convolution of the load with the creep compliance, and the load of an
//! elastic body the convolution of E with its load per modulus (E. H. Lee and J. R. M. Radok, J. Appl. Mech. 27, 1960, 438):
//!
//! ```text
//! F(delta(t)) = integral of C(t - s) dW(s),      W(t) = integral of E(t - s)/(1 - nu^2) dF(delta(s)),      dF/d(delta) = 2 a(delta)
//! ```
//!
//! Both are exact for a body of revolution as long as the contact does not shrink, and close to it afterwards. What is missing then, or
//! where F is no power of the approach, as it is taken to be here, is in the factors that the exact model gives.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::drive::{Control, Schedule, SegmentedDrive, Steps};
use crate::identify::data::{Datum, Number};
use crate::identify::linear::{PowerContact, product_m2};
use crate::identify::series::Point;
use crate::identify::{Driven, IdentifyError, IdentifyPlan};
use crate::material::{Creep, MaterialError, Relaxation};
use crate::simulation::between::values_at;
use crate::simulation::scenario::ScenarioPlan;
use crate::simulation::{HistoryRow, Simulation, SimulationEnd, SimulationOutcome};

/// A history without its contact.
pub(super) struct LinearHistory<'a> {
    plan: &'a IdentifyPlan,
    control: Control,
    /// Largest load (N), and the contact about it; none before it is linearised, or where the approach is prescribed.
    largest_n: f64,
    contact: Option<PowerContact>,
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
        let convolved = |value: f64| match drive.control() {
            Control::Load => value,
            Control::Approach => product_m2(plan.contact.indenter.as_ref(), value),
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
            largest_n: drive.maximum(),
            contact: None,
        })
    }

    /// Linearises about a contact of this compliance (1/Pa) at rest.
    pub(super) fn about(&mut self, compliance_per_pa: f64) {
        let indenter = self.plan.contact.indenter.as_ref();
        self.contact = match self.control {
            Control::Load => Some(PowerContact::new(
                indenter,
                self.largest_n,
                compliance_per_pa,
            )),
            Control::Approach => None,
        };
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
                let contact = self.contact?;
                let approach = |product: &f64| contact.approach_m(*product);
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
                let faded = -(-ratio).exp_m1();
                // (1 - exp(-r))/r, which is 1 for a jump.
                let part = if ratio > 0.0 { faded / ratio } else { 1.0 };
                *state = *state * (1.0 - faded) + change * part;
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
