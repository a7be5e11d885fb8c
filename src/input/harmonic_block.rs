//! The `[drive]` block of a sweep file: an oscillating load or approach.

use super::diagnostic::Problems;
use super::document::{Located, TableReader};
use crate::drive::{Control, HarmonicDrive};
use crate::quantity::Dimension;

/// The two controls, as written in a file.
pub(crate) const CONTROLS: [(&str, Control); 2] =
    [("load", Control::Load), ("approach", Control::Approach)];

/// Reads the block; `None` where a problem was reported.
pub(crate) fn read(mut table: TableReader<'_>, problems: &Problems) -> Option<HarmonicDrive> {
    let control = table.choice_of_or("control", &CONTROLS, Control::Load)?;
    let dimension = dimension(control.value);
    let mean = table.quantity("mean", dimension);
    let amplitude = table.quantity("amplitude", dimension);
    let phase = table.quantity_or("phase", Dimension::Angle, 0.0);
    let hold = table.quantity_or("hold", Dimension::Time, 0.0);
    table.finish();
    let what = control.value.name();
    let fine = [
        control.value == Control::Approach || above_zero(problems, &mean, &format!("mean {what}")),
        above_zero(problems, &amplitude, &format!("{what} amplitude")),
        not_negative(problems, &hold),
    ];
    let (mean, amplitude, phase, hold) = (mean?, amplitude?, phase?, hold?);
    if fine.contains(&false) || !is_in_reach(control.value, problems, &mean, &amplitude) {
        return None;
    }
    let drive = HarmonicDrive::new(
        control.value,
        mean.value,
        amplitude.value,
        phase.value,
        hold.value,
    );
    drive
        .map_err(|error| {
            problems.at(&mean, error.to_string());
        })
        .ok()
}

/// The keys of a frequency: the dimension of each, and the factor from it to rad/s.
pub(crate) const FREQUENCIES: [(&str, (Dimension, f64)); 2] = [
    ("angular_frequency", (Dimension::AngularFrequency, 1.0)),
    ("frequency", (Dimension::Frequency, std::f64::consts::TAU)),
];

/// The dimension of the drive's values.
pub(crate) fn dimension(control: Control) -> Dimension {
    match control {
        Control::Load => Dimension::Force,
        Control::Approach => Dimension::Length,
    }
}

fn above_zero(problems: &Problems, value: &Option<Located<f64>>, what: &str) -> bool {
    match value {
        Some(value) if value.value <= 0.0 => {
            problems.at(value, format!("the {what} must be above zero"));
            false
        }
        _ => true,
    }
}

fn not_negative(problems: &Problems, hold: &Option<Located<f64>>) -> bool {
    match hold {
        Some(hold) if hold.value < 0.0 => {
            problems.at(hold, "the hold cannot be negative");
            false
        }
        _ => true,
    }
}

/// Refuses a load that pulls and an approach that never touches.
fn is_in_reach(
    control: Control,
    problems: &Problems,
    mean: &Located<f64>,
    amplitude: &Located<f64>,
) -> bool {
    match control {
        Control::Load if amplitude.value > mean.value => {
            problems
                .at(amplitude, "the load would become a pull for part of each cycle")
                .because("larger than the mean")
                .label(mean, "the mean")
                .help("a contact without adhesion cannot carry a pull: choose an amplitude of at most the mean");
            false
        }
        Control::Approach if mean.value + amplitude.value <= 0.0 => {
            problems
                .at(mean, "the indenter never touches the surface")
                .because("with the amplitude not above zero")
                .label(amplitude, "the amplitude")
                .help("an approach is positive into the body and zero at first touch");
            false
        }
        _ => true,
    }
}
