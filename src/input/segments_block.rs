//! The `[drive]` block of a scenario file: a history of segments, and how each kind of them is read.

use std::f64::consts::TAU;

use super::data_file;
use super::diagnostic::{Location, Problems};
use super::document::Located;
use super::document::reader::TableReader;
use super::drive_table;
use super::harmonic_block::scaled;
use crate::drive::segment::{
    COEFFICIENTS, CYCLES, DURATION, FILE, KIND, SINE_AMPLITUDE, SINE_ANGULAR_FREQUENCY,
    SINE_FREQUENCY, SINE_MEAN, SegmentKind, TARGET, TIMES, VALUES,
};
use crate::drive::segments::SEGMENTS;
use crate::drive::{Control, HistoryError, PHASE, Segment, SegmentProblem, SegmentedDrive};

/// Reads the block; `None` where a problem was reported. `pull_off_n` is the attraction (N) of an indenter under such a control, `None`
/// where a problem was reported; `area_m2` that of a period, where the surface repeats itself.
pub(super) fn read(
    mut table: TableReader<'_>,
    pull_off_n: impl FnOnce(Control) -> Option<f64>,
    area_m2: Option<f64>,
) -> Option<SegmentedDrive> {
    let problems = table.problems();
    let (prescribed, factor) = scaled(&mut table, area_m2)?;
    let control = prescribed.control();
    let reader = Reader {
        control,
        factor: factor.unwrap_or(1.0),
    };
    let all = table.tables(&SEGMENTS, |segment| reader.segment(segment));
    table.finish();
    let (all, pull_off_n, _) = (all?, pull_off_n(control)?, factor?);
    let (segments, places): (Vec<_>, Vec<_>) = all.value.into_iter().unzip();
    SegmentedDrive::attracted(control, segments, pull_off_n)
        .map_err(|error| report(problems, &error, &all.location, &places))
        .ok()
}

fn report(problems: &Problems, error: &HistoryError, whole: &Location, places: &[Location]) {
    let HistoryError::Segment { segment, problem } = error else {
        problems.at(whole, error.to_string()).help(
            "for example segments = [{ kind = \"step\", to = \"10 N\", duration = \"200 s\" }]",
        );
        return;
    };
    let place = places.get(*segment).unwrap_or(whole);
    let told = problems.at(place, format!("segment {}: {problem}", segment + 1));
    if let SegmentProblem::Pull { pull_off_n, .. } = problem {
        let (because, load) = match *pull_off_n > 0.0 {
            true => (
                "pulls harder than the attraction",
                "the pull-off load itself",
            ),
            false => ("takes the load below zero", "zero"),
        };
        told.because(because).help(format!(
            "a load of {load} is allowed: the indenter is then out of contact"
        ));
    }
}

/// A segment, and where the part of it stands that most of its problems come from.
type Placed = (Segment, Location);

struct Reader {
    control: Control,
    /// What the drive's values are multiplied by.
    factor: f64,
}

impl Reader {
    fn segment(&self, mut table: TableReader<'_>) -> Option<Placed> {
        let kind = table.value(&KIND)?;
        let placed = match kind {
            SegmentKind::Step | SegmentKind::Ramp => self.to(&mut table, kind),
            SegmentKind::Polynomial => self.polynomial(&mut table),
            SegmentKind::Sine => self.sine(&mut table),
            SegmentKind::Table => self.table(&mut table),
        };
        table.finish();
        placed
    }

    fn to(&self, table: &mut TableReader<'_>, kind: SegmentKind) -> Option<Placed> {
        let to: Option<Located<f64>> = table.read(&TARGET);
        let duration_s = table.value(&DURATION);
        let Located {
            value, location, ..
        } = to?;
        let (to, duration_s) = (self.factor * value, duration_s?);
        let segment = match kind {
            SegmentKind::Step => Segment::Step { to, duration_s },
            _ => Segment::Ramp { to, duration_s },
        };
        Some((segment, location))
    }

    fn sine(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        let mean: Option<f64> = table.value(&SINE_MEAN);
        let amplitude: Option<Located<f64>> = table.read(&SINE_AMPLITUDE);
        let either = [
            (&SINE_ANGULAR_FREQUENCY, (&SINE_ANGULAR_FREQUENCY, 1.0)),
            (&SINE_FREQUENCY, (&SINE_FREQUENCY, TAU)),
        ];
        let frequency = table.one_of(&either);
        let frequency =
            frequency.and_then(|(key, to_angular)| Some(table.value::<f64>(key)? * to_angular));
        let (phase_rad, cycles) = (table.value(&PHASE), table.value(&CYCLES));
        let amplitude = amplitude?;
        let segment = Segment::Sine {
            mean: self.factor * mean?,
            amplitude: self.factor * amplitude.value,
            angular_frequency_rad_per_s: frequency?,
            phase_rad: phase_rad?,
            cycles: cycles?,
        };
        Some((segment, amplitude.location))
    }

    fn table(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        if table.one_of(&[(&FILE, true), (&TIMES, false)])? {
            // Those of a file are loads or approaches, as its header says.
            let file: Located<String> = table.read(&FILE)?;
            let parse = |name: &str, bytes: &[u8]| drive_table::parse(name, bytes, self.control);
            let made = data_file::made_of(&file, table.folder(), table.problems(), parse);
            let (times_s, values) = made?;
            return Some((Segment::Table { times_s, values }, file.location));
        }
        let times = table.value(&TIMES);
        let values: Option<Located<Vec<f64>>> = table.read(&VALUES);
        let (times_s, values) = (times?, values?);
        let segment = Segment::Table {
            times_s,
            values: self.scaled(values.value),
        };
        Some((segment, values.location))
    }

    fn polynomial(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        let coefficients: Option<Located<Vec<f64>>> = table.read(&COEFFICIENTS);
        let duration_s = table.value(&DURATION);
        let coefficients = coefficients?;
        let segment = Segment::Polynomial {
            coefficients: self.scaled(coefficients.value),
            duration_s: duration_s?,
        };
        Some((segment, coefficients.location))
    }

    fn scaled(&self, values: Vec<f64>) -> Vec<f64> {
        values
            .into_iter()
            .map(|value| self.factor * value)
            .collect()
    }
}
