//! What a plan may say: the ranges of its values, known here to everyone who reads or builds one, and the check that every plan
//! passes before anything is computed from it.

use crate::quantity::block::{Block, Refused};
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::plan::{Condition, SweepPlan};

/// Why a plan is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    #[error("the sweep has no frequency; give at least one")]
    NoFrequency,
    #[error("the {what} is {value} {unit}; it must be positive and finite")]
    NotPositive {
        what: &'static str,
        value: f64,
        unit: &'static str,
    },
    #[error(
        "the {what} {value} does not follow {before} in ascending order; give each once, the smallest first"
    )]
    Order {
        what: String,
        before: f64,
        value: f64,
    },
    #[error(
        "an axis of the sweep has no value, or a condition without one; give at least one, and each its own"
    )]
    NoCondition,
    #[error(
        "{cases} cases are more than a sweep may have, {}",
        SweepPlan::MAX_CASES
    )]
    Cases { cases: usize },
    #[error(transparent)]
    Block(#[from] Refused),
    #[error(
        "the model of the adhesion does not know this: \"dmt\" is of a sphere under a prescribed load, \"jkr\" of a sphere, \"maugis\" of a \
         body of revolution"
    )]
    AdhesionOfOther,
}

impl SweepPlan {
    /// Frequencies, or values of a second axis, beyond this number are a slip of the pen rather than a wish; so are cases.
    pub const MAX_POINTS: usize = 100_000;
    pub const MAX_CASES: usize = 1_000_000;

    /// Checks every value that is not checked where it is made: frequencies and second axis, the blocks `[cycle]` and `[solver]`.
    ///
    /// # Errors
    /// [`PlanError`] with the first value that is refused.
    pub fn check(&self) -> Result<(), PlanError> {
        match self.angular_frequencies_rad_per_s.is_empty() {
            true => Err(PlanError::NoFrequency),
            false => self.check_values(),
        }
    }

    /// The same of a plan that may still lack its frequencies.
    pub(crate) fn check_values(&self) -> Result<(), PlanError> {
        let omegas = &self.angular_frequencies_rad_per_s;
        omegas
            .iter()
            .try_for_each(|omega| check_positive("angular frequency", *omega, "rad/s"))?;
        check_order("angular frequency (rad/s)", omegas)?;
        if let Some(axes) = &self.axes {
            let lacks_one = |c: &Condition| c.values.all().len() != axes.over.len();
            let is_empty = axes.over.is_empty() || axes.conditions.is_empty();
            if is_empty || axes.conditions.iter().any(lacks_one) {
                return Err(PlanError::NoCondition);
            }
            if let [varied] = &axes.over[..] {
                let values = axes.conditions.iter().flat_map(|c| c.values.all());
                let values: Vec<f64> = values.map(|value| value.as_number()).collect();
                check_order(&varied.key, &values)?;
            }
        }
        let cases = self.conditions().len().saturating_mul(omegas.len());
        if cases > Self::MAX_CASES {
            return Err(PlanError::Cases { cases });
        }
        let mut contacts = self.conditions().iter().map(|c| &c.contact);
        contacts.try_for_each(ContactPlan::check)?;
        self.base.contact.check()?;
        self.cycle.check()?;
        Ok(self.solver.check_used()?)
    }
}

/// Refuses a value in this unit that is not positive and finite.
pub(crate) fn check_positive(
    what: &'static str,
    value: f64,
    unit: &'static str,
) -> Result<(), PlanError> {
    match value.is_finite() && value > 0.0 {
        true => Ok(()),
        false => Err(PlanError::NotPositive { what, value, unit }),
    }
}

fn check_order(what: &str, values: &[f64]) -> Result<(), PlanError> {
    let falls = |pair: &&[f64]| pair[0] >= pair[1];
    match values.windows(2).find(falls) {
        Some(pair) => Err(PlanError::Order {
            what: what.to_owned(),
            before: pair[0],
            value: pair[1],
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::drive::{Control, HarmonicDrive};
    use crate::indenter::Sphere;
    use crate::material::library;
    use crate::sweep::plan::{Axes, Varied};

    /// What is said of a plan with this change.
    fn refused(change: impl FnOnce(&mut SweepPlan)) -> Option<String> {
        let drive = HarmonicDrive::new(Control::Load, 10.0, 5.0, 0.0, 0.0).unwrap();
        let material = library::find("pmma").unwrap().material().unwrap();
        let mut plan = SweepPlan::new(material, Arc::new(Sphere::new(0.01).unwrap()), drive);
        plan.angular_frequencies_rad_per_s = vec![0.1, 1.0];
        assert_eq!(plan.check(), Ok(()));
        change(&mut plan);
        plan.check().err().map(|error| error.to_string())
    }

    #[test]
    fn what_cannot_be_computed_is_refused_with_its_value() {
        let omegas = |values: &[f64]| {
            let values = values.to_vec();
            refused(|plan| plan.angular_frequencies_rad_per_s = values).unwrap()
        };
        assert!(omegas(&[]).contains("no frequency"));
        assert!(omegas(&[-0.5, 1.0]).contains("-0.5 rad/s"));
        assert!(omegas(&[1.0, f64::NAN]).contains("NaN"));
        assert!(omegas(&[1.0, f64::INFINITY]).contains("inf"));
        assert!(omegas(&[1.0, 0.25]).contains("0.25 does not follow 1"));
        assert!(omegas(&[1.0, 1.0]).contains("give each once"));
        let steps = refused(|plan| plan.cycle.steps = 0).unwrap();
        assert_eq!(
            steps,
            "cycle.steps = 0; it must be an integer from 8 to 1000000"
        );
        assert!(refused(|plan| plan.cycle.max_cycles = 0).is_some());
        assert!(refused(|plan| plan.cycle.tolerance = f64::NAN).is_some());
        assert!(refused(|plan| plan.cycle.accuracy = Some(1.0)).is_some());
        assert!(refused(|plan| plan.solver.springs = 9).is_some());
        assert!(refused(|plan| plan.solver.tolerance = Some(0.0)).is_some());
        // Cells of an engine that has none say nothing.
        assert_eq!(refused(|plan| plan.solver.cells = 0), None);
        let axis = |amplitudes: &[f64]| {
            let varied = Varied::amplitude(Control::Load);
            refused(|plan| {
                let axis = Axes::of_drive(plan, varied, amplitudes.iter().copied());
                plan.axes = Some(axis.unwrap());
            })
        };
        assert!(axis(&[]).unwrap().contains("no value"));
        assert!(axis(&[4.0, 2.0]).is_some());
        assert_eq!(axis(&[2.0, 4.0]), None);
    }
}
