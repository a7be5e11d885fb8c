//! The `[drive]` block of a sweep file: an oscillating load or approach.

use super::diagnostic::Problems;
use super::document::reader::TableReader;
use super::keys::DRIVE;
use super::keys::drive::{AMPLITUDE, CONTROL, HOLD, MEAN, PHASE};
use crate::drive::{Control, DriveError, HarmonicDrive};
use crate::sweep::plan::resolved::drive_dimension;

/// What the block controls, where it says so; what is wrong with it is told when it is read.
pub(super) fn control(root: &mut TableReader<'_>) -> Control {
    let unheard = Problems::new();
    let table = root.parsed(&DRIVE);
    let control = table.and_then(|table| {
        let place = root.as_ref().clone();
        TableReader::new(table, place, String::new(), &unheard).value(&CONTROL)
    });
    control.unwrap_or(Control::Load)
}

/// Reads the block; `None` where a problem was reported.
pub(crate) fn read(table: TableReader<'_>, problems: &Problems) -> Option<HarmonicDrive> {
    read_with(table, problems, HarmonicDrive::new)
}

/// The same of an indenter that is attracted, which a drive may pull.
pub(super) fn read_attracted(table: TableReader<'_>, problems: &Problems) -> Option<HarmonicDrive> {
    read_with(table, problems, HarmonicDrive::unattracted)
}

fn read_with(
    mut table: TableReader<'_>,
    problems: &Problems,
    make: fn(Control, f64, f64, f64, f64) -> Result<HarmonicDrive, DriveError>,
) -> Option<HarmonicDrive> {
    let control = table.value(&CONTROL)?;
    let dimension = drive_dimension(control);
    let mean = table.read(&MEAN.of(dimension));
    let amplitude = table.read(&AMPLITUDE.of(dimension));
    let (phase_rad, hold_s) = (table.value(&PHASE), table.value(&HOLD));
    table.finish();
    let (mean, amplitude, phase_rad, hold_s) = (mean?, amplitude?, phase_rad?, hold_s?);
    match make(control, mean.value, amplitude.value, phase_rad, hold_s) {
        Ok(drive) => Some(drive),
        Err(DriveError::NoTouch { .. }) => {
            problems
                .at(&mean, "the indenter never touches the surface")
                .because("with the amplitude not above zero")
                .label(&amplitude, "the amplitude")
                .help(match control {
                    Control::Load => "a load is positive where the indenter is pressed down; mean and amplitude together must be, too",
                    Control::Approach => "an approach is positive into the body and zero at first touch",
                });
            None
        }
        Err(error) => {
            problems.at(&mean, error.to_string());
            None
        }
    }
}
