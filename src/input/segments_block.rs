//! The `[drive]` block of a scenario file: a history of segments.

use std::path::Path;

use super::data_file;
use super::diagnostic::{Location, Problems};
use super::document::plain;
use super::document::reader::TableReader;
use super::drive_table;
use super::harmonic_block::per_value;
use super::keys::drive::{
    COEFFICIENTS, CYCLES, DURATION, FILE, KIND, PHASE, PRESCRIBES, SEGMENTS, SINE_AMPLITUDE,
    SINE_ANGULAR_FREQUENCY, SINE_FREQUENCY, SINE_MEAN, SegmentKind, TARGET, TIMES, VALUES,
};
use crate::drive::{Control, HistoryError, Segment, SegmentProblem, SegmentedDrive};
use crate::quantity::Dimension;

/// A segment, and where the part of it stands that most of its problems come from.
struct Placed {
    segment: Segment,
    place: Location,
}

/// Reads the block; `None` where a problem was reported. Files are looked for in `folder`. `pull_off_n` is the attraction (N) of an
/// indenter under such a control, `None` where a problem was reported; `area_m2` that of a period, where the surface repeats itself.
pub(super) fn read(
    mut table: TableReader<'_>,
    folder: &Path,
    (pull_off_n, area_m2): (impl FnOnce(Control) -> Option<f64>, Option<f64>),
    problems: &Problems,
) -> Option<SegmentedDrive> {
    let place = table.key_location(&PRESCRIBES);
    let place = place.unwrap_or_else(|| table.as_ref().clone());
    let prescribed = table.value(&PRESCRIBES)?;
    let control = prescribed.control();
    let factor = per_value(prescribed, area_m2, &place, problems);
    let reader = Reader {
        control,
        dimension: prescribed.dimension(),
        factor: factor.unwrap_or(1.0),
        folder,
        problems,
    };
    let all = table.tables(&SEGMENTS, |segment| reader.segment(segment));
    table.finish();
    let (all, pull_off_n, _) = (all?, pull_off_n(control)?, factor?);
    let (segments, places): (Vec<_>, Vec<_>) =
        all.value.into_iter().map(|p| (p.segment, p.place)).unzip();
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
    match problem {
        SegmentProblem::Pull { pull_off_n, .. } if *pull_off_n > 0.0 => {
            told.because("pulls harder than the attraction").help(
                "a load of the pull-off load itself is allowed: the indenter is then out of contact",
            );
        }
        SegmentProblem::Pull { .. } => {
            told.because("takes the load below zero")
                .help("a load of zero is allowed: the indenter is then out of contact");
        }
        _ => {}
    }
}

struct Reader<'a> {
    control: Control,
    /// Of the drive's values.
    dimension: Dimension,
    /// What these are multiplied by.
    factor: f64,
    folder: &'a Path,
    problems: &'a Problems,
}

impl Reader<'_> {
    fn segment(&self, mut table: TableReader<'_>) -> Option<Placed> {
        let placed = match table.value(&KIND)? {
            SegmentKind::Step => self.to(&mut table, |to, duration_s| Segment::Step {
                to,
                duration_s,
            }),
            SegmentKind::Ramp => self.to(&mut table, |to, duration_s| Segment::Ramp {
                to,
                duration_s,
            }),
            SegmentKind::Polynomial => self.polynomial(&mut table),
            SegmentKind::Sine => self.sine(&mut table),
            SegmentKind::Table => self.table(&mut table),
        };
        table.finish();
        placed
    }

    fn to(
        &self,
        table: &mut TableReader<'_>,
        build: impl FnOnce(f64, f64) -> Segment,
    ) -> Option<Placed> {
        let to = table.read(&TARGET.of(self.dimension));
        let duration_s = table.value(&DURATION);
        let to = to?;
        Some(Placed {
            segment: build(self.factor * to.value, duration_s?),
            place: to.location,
        })
    }

    fn sine(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        let mean = table.value(&SINE_MEAN.of(self.dimension));
        let amplitude = table.read(&SINE_AMPLITUDE.of(self.dimension));
        let frequencies = [
            (&SINE_ANGULAR_FREQUENCY as _, (&SINE_ANGULAR_FREQUENCY, 1.0)),
            (
                &SINE_FREQUENCY as _,
                (&SINE_FREQUENCY, std::f64::consts::TAU),
            ),
        ];
        let chosen = table.one_of(&frequencies);
        let frequency = chosen.and_then(|(row, to_angular)| Some(table.value(row)? * to_angular));
        let (phase_rad, cycles) = (table.value(&PHASE), table.value(&CYCLES));
        let amplitude = amplitude?;
        Some(Placed {
            segment: Segment::Sine {
                mean: self.factor * mean?,
                amplitude: self.factor * amplitude.value,
                angular_frequency_rad_per_s: frequency?,
                phase_rad: phase_rad?,
                cycles: cycles?,
            },
            place: amplitude.location,
        })
    }

    fn table(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        match table.one_of(&[(&FILE, true), (&TIMES, false)])? {
            true => self.table_of_file(table),
            false => self.table_written_out(table),
        }
    }

    fn table_written_out(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        let times = table.value(&TIMES);
        let values = table.read(&VALUES.of(self.dimension));
        let (times, values) = (times?, values?);
        Some(Placed {
            segment: Segment::Table {
                times_s: plain(times),
                values: self.scaled(plain(values.value)),
            },
            place: values.location,
        })
    }

    /// Those of a file are loads or approaches, as its header says.
    fn table_of_file(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        let file = table.read(&FILE)?;
        let (name, bytes) = data_file::named(&file, self.folder, self.problems)?;
        let table = drive_table::parse(&name, &bytes, self.control);
        let (times_s, values) = data_file::accepted(table, &file, self.problems)?;
        Some(Placed {
            segment: Segment::Table { times_s, values },
            place: file.location,
        })
    }

    fn polynomial(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        let coefficients = table.read(&COEFFICIENTS);
        let duration_s = table.value(&DURATION);
        let coefficients = coefficients?;
        Some(Placed {
            segment: Segment::Polynomial {
                coefficients: self.scaled(plain(coefficients.value)),
                duration_s: duration_s?,
            },
            place: coefficients.location,
        })
    }

    fn scaled(&self, values: Vec<f64>) -> Vec<f64> {
        values
            .into_iter()
            .map(|value| self.factor * value)
            .collect()
    }
}
