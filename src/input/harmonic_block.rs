//! The `[drive]` block of a sweep file: an oscillating load or approach.

use super::diagnostic::{Location, Problems};
use super::document::Located;
use super::document::reader::TableReader;
use super::keys::DRIVE;
use crate::drive::harmonic::{AMPLITUDE, HOLD, MEAN};
use crate::drive::{Control, DriveError, HarmonicDrive, PHASE, PRESCRIBES, Prescribed};

/// What the block prescribes, where it says so; what is wrong with it is told when it is read.
pub(super) fn prescribed(root: &mut TableReader<'_>) -> Prescribed {
    let unheard = Problems::new();
    let table = root.parsed(&DRIVE);
    let prescribed = table.and_then(|table| {
        let place = root.as_ref().clone();
        TableReader::new(table, place, String::new(), &unheard).value(&PRESCRIBES)
    });
    prescribed.unwrap_or(Prescribed::Load)
}

/// What a block is read for.
#[derive(Clone, Copy, Default)]
pub(super) struct Pressed {
    /// The area (m^2) over which a mean pressure is a load; `None` of what has no period.
    pub(super) area_m2: Option<f64>,
    /// Whether the indenter is attracted, so that the drive may pull it.
    pub(super) is_attracted: bool,
}

/// What is prescribed, in whose dimension values are read from now on, and what a value is multiplied by to be a load or an approach: the area (m^2) of the period that a mean pressure
/// acts on, where there is one; `None` where there should be, which is reported.
pub(super) fn scaled(
    table: &mut TableReader<'_>,
    area_m2: Option<f64>,
) -> Option<(Prescribed, Option<f64>)> {
    let place = table.key_location(&PRESCRIBES);
    let place: &Location = place.as_ref().unwrap_or(table.as_ref());
    let (place, problems) = (place.clone(), table.problems());
    let prescribed: Prescribed = table.value(&PRESCRIBES)?;
    table.choose(prescribed.dimension());
    if prescribed != Prescribed::Pressure {
        return Some((prescribed, Some(1.0)));
    }
    if area_m2.is_none() {
        problems
            .at(
                &place,
                "a mean pressure is that of a surface which repeats itself",
            )
            .because("the indenter has no area to share a load")
            .help("write `edge = \"periodic\"` in [indenter], or give loads");
    }
    Some((prescribed, area_m2))
}

/// Reads the block; `None` where a problem was reported.
pub(super) fn read(mut table: TableReader<'_>, pressed: Pressed) -> Option<HarmonicDrive> {
    let problems = table.problems();
    let (prescribed, factor) = scaled(&mut table, pressed.area_m2)?;
    let (control, factor) = (prescribed.control(), factor?);
    let make = match pressed.is_attracted {
        true => HarmonicDrive::unattracted,
        false => HarmonicDrive::new,
    };
    let mean: Option<Located<f64>> = table.read(&MEAN);
    let amplitude: Option<Located<f64>> = table.read(&AMPLITUDE);
    let (phase_rad, hold_s) = (table.value(&PHASE), table.value(&HOLD));
    table.finish();
    let (mean, amplitude) = (mean?, amplitude?);
    let (scaled_mean, scaled_amplitude) = (factor * mean.value, factor * amplitude.value);
    let made = make(control, scaled_mean, scaled_amplitude, phase_rad?, hold_s?);
    if let Err(DriveError::NoTouch { .. }) = made {
        problems
            .at(&mean, "the indenter never touches the surface")
            .because("with the amplitude not above zero")
            .label(&amplitude, "the amplitude")
            .help(match control {
                Control::Load => "a load is positive where the indenter is pressed down; mean and amplitude together must be, too",
                Control::Approach => "an approach is positive into the body and zero at first touch",
            });
        return None;
    }
    problems.accept(&mean, made)
}
