//! The pressure over the contact at a few instants of the recorded cycle: where the drive is greatest, least, and at its mean
//! on the way down and up.

use crate::contact::ContactError;
use crate::drive::HarmonicDrive;
use crate::history::March;
use crate::sweep::record::{PressureProfile, Quarter};

/// Profiles of one cycle, taken as its steps go by.
pub(crate) struct Pressures {
    /// The time step of each instant, counted from 1.
    steps: [(Quarter, usize); 4],
    profiles: Vec<PressureProfile>,
}

impl Pressures {
    /// Nothing taken yet of a cycle in this many steps.
    pub(crate) fn new(drive: &HarmonicDrive, steps: usize) -> Self {
        Self {
            steps: Quarter::ALL.map(|quarter| (quarter, nearest_step(quarter, drive, steps))),
            profiles: Vec::with_capacity(Quarter::ALL.len()),
        }
    }

    /// Takes in the instant at the end of a step.
    pub(crate) fn see(
        &mut self,
        march: &mut March<'_>,
        step: usize,
        time_s: f64,
    ) -> Result<(), ContactError> {
        let Self { steps, profiles } = self;
        for (quarter, _) in steps.iter().filter(|(_, at)| *at == step) {
            march.observe(&mut |engine, pressure, solution| {
                profiles.push(PressureProfile {
                    quarter: *quarter,
                    time_s,
                    load_n: solution.load_n,
                    approach_m: solution.approach_m,
                    contact_radius_m: solution.contact_radius_m,
                    lines: engine.pressure_lines(pressure, solution),
                });
                Ok(())
            })?;
        }
        Ok(())
    }

    /// The profiles, in the order of [`Quarter::ALL`] whatever the phase of the drive.
    pub(crate) fn finished(mut self) -> Vec<PressureProfile> {
        self.profiles.sort_by_key(|profile| profile.quarter);
        self.profiles
    }
}

/// The step of the cycle, from 1 to `steps`, whose end is nearest to the quarter. The end of the cycle, which is its start
/// again, is the nearer of the two to the stabilised one.
fn nearest_step(quarter: Quarter, drive: &HarmonicDrive, steps: usize) -> usize {
    let turn = match quarter {
        Quarter::Greatest => 0.25,
        Quarter::MeanFalling => 0.5,
        Quarter::Least => 0.75,
        Quarter::MeanRising => 0.0,
    };
    let fraction = (turn - drive.phase_rad() / std::f64::consts::TAU).rem_euclid(1.0);
    // A fraction of the cycle: between 0 and the number of steps.
    match (fraction * steps as f64).round() as usize % steps.max(1) {
        0 => steps,
        step => step,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::Control;

    #[test]
    fn the_instants_are_where_the_drive_has_its_extremes_and_its_mean() {
        for phase_rad in [0.0, 0.4, 1.6, 3.2, 6.0, -2.0, 100.0] {
            for steps in [8, 50, 200] {
                let drive = HarmonicDrive::new(Control::Load, 10.0, 5.0, phase_rad, 0.0).unwrap();
                let value = |step: usize| drive.value(step as f64 / steps as f64);
                let at = |quarter| nearest_step(quarter, &drive, steps);
                for step in 1..=steps {
                    // Two steps at equal distances from an extreme differ by rounding.
                    assert!(value(at(Quarter::Greatest)) > value(step) - 1e-12);
                    assert!(value(at(Quarter::Least)) < value(step) + 1e-12);
                }
                // Half a step from the mean at most.
                let half = 5.0 * (std::f64::consts::PI / steps as f64).sin() + 1e-12;
                for (quarter, sign) in [(Quarter::MeanFalling, -1.0), (Quarter::MeanRising, 1.0)] {
                    let step = at(quarter);
                    assert!((1..=steps).contains(&step));
                    assert!((value(step) - 10.0).abs() <= half, "{phase_rad} {steps}");
                    assert!(sign * (value(step + 1) - value(step - 1)) > 0.0);
                }
            }
        }
    }
}
