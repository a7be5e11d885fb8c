//! The `[drive]` block of a scenario file: a history of segments.

use std::path::Path;

use super::data_file;
use super::diagnostic::{Location, Problems};
use super::document::{Located, TableReader};
use super::drive_table;
use super::harmonic_block::{CONTROLS, FREQUENCIES, dimension};
use super::table_source::{TABLE_SOURCES, TableSource};
use crate::drive::{Control, HistoryError, Segment, SegmentProblem, SegmentedDrive};
use crate::quantity::Dimension;

/// More segments than this belong into a table.
const MAX_SEGMENTS: usize = 10_000;

#[derive(Debug, Clone, Copy)]
enum Kind {
    Step,
    Ramp,
    Polynomial,
    Sine,
    Table,
}

const KINDS: [(&str, Kind); 5] = [
    ("step", Kind::Step),
    ("ramp", Kind::Ramp),
    ("polynomial", Kind::Polynomial),
    ("sine", Kind::Sine),
    ("table", Kind::Table),
];

/// A segment, and where the part of it stands that most of its problems come from.
struct Placed {
    segment: Segment,
    place: Location,
}

/// Reads the block; `None` where a problem was reported. Files are looked for in `folder`.
pub(super) fn read(
    mut table: TableReader<'_>,
    folder: &Path,
    problems: &Problems,
) -> Option<SegmentedDrive> {
    let control = table.choice_of_or("control", &CONTROLS, Control::Load)?;
    let segments = table.tables("segments");
    table.finish();
    let segments = segments?;
    let whole = segments.location.clone();
    if segments.value.len() > MAX_SEGMENTS {
        problems
            .at(&whole, format!("{} segments are too many", segments.value.len()))
            .help(format!(
                "give at most {MAX_SEGMENTS}, or a table: {{ kind = \"table\", file = \"drive.csv\" }}"
            ));
        return None;
    }
    let reader = Reader {
        control: control.value,
        folder,
        problems,
    };
    // All segments are read, so that all problems are reported.
    let all: Vec<_> = segments
        .value
        .into_iter()
        .map(|t| reader.segment(t))
        .collect();
    let all: Vec<Placed> = all.into_iter().collect::<Option<_>>()?;
    let (segments, places): (Vec<_>, Vec<_>) =
        all.into_iter().map(|p| (p.segment, p.place)).unzip();
    SegmentedDrive::new(control.value, segments)
        .map_err(|error| report(problems, &error, &whole, &places))
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
    if let SegmentProblem::Pull { .. } = problem {
        told.because("takes the load below zero")
            .help("a load of zero is allowed: the indenter is then out of contact");
    }
}

struct Reader<'a> {
    control: Control,
    folder: &'a Path,
    problems: &'a Problems,
}

impl Reader<'_> {
    fn segment(&self, mut table: TableReader<'_>) -> Option<Placed> {
        let kind = table.choice_of("kind", &KINDS)?.value;
        let placed = match kind {
            Kind::Step => self.to(&mut table, |to, duration_s| Segment::Step {
                to,
                duration_s,
            }),
            Kind::Ramp => self.to(&mut table, |to, duration_s| Segment::Ramp {
                to,
                duration_s,
            }),
            Kind::Polynomial => self.polynomial(&mut table),
            Kind::Sine => self.sine(&mut table),
            Kind::Table => self.table(&mut table),
        };
        table.finish();
        placed
    }

    fn to(
        &self,
        table: &mut TableReader<'_>,
        build: impl FnOnce(f64, f64) -> Segment,
    ) -> Option<Placed> {
        let to = table.quantity("to", dimension(self.control));
        let duration = self.duration(table);
        let to = to?;
        Some(Placed {
            segment: build(to.value, duration?),
            place: to.location,
        })
    }

    fn duration(&self, table: &mut TableReader<'_>) -> Option<f64> {
        self.positive(table.quantity("duration", Dimension::Time), "a duration")
    }

    fn positive(&self, value: Option<Located<f64>>, what: &str) -> Option<f64> {
        let value = value?;
        if value.value > 0.0 {
            return Some(value.value);
        }
        self.problems
            .at(&value, format!("{what} must be above zero"));
        None
    }

    fn polynomial(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        let coefficients = table.numbers("coefficients");
        let duration = self.duration(table);
        let coefficients = coefficients?;
        Some(Placed {
            segment: Segment::Polynomial {
                coefficients: coefficients.value.iter().map(|c| c.value).collect(),
                duration_s: duration?,
            },
            place: coefficients.location,
        })
    }

    fn sine(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        let mean = table.quantity("mean", dimension(self.control));
        let amplitude = table.quantity("amplitude", dimension(self.control));
        let place = amplitude.as_ref().map(|a| a.location.clone());
        let amplitude = self.positive(amplitude, "an amplitude");
        let key = table.one_of(&FREQUENCIES);
        let frequency = key.and_then(|(key, (dimension, to_angular))| {
            let value = self.positive(table.quantity(key, dimension), "a frequency");
            value.map(|value| value * to_angular)
        });
        let phase = table.quantity_or("phase", Dimension::Angle, 0.0);
        let cycles = self.positive(table.number("cycles"), "the number of cycles");
        Some(Placed {
            segment: Segment::Sine {
                mean: mean?.value,
                amplitude: amplitude?,
                angular_frequency_rad_per_s: frequency?,
                phase_rad: phase?.value,
                cycles: cycles?,
            },
            place: place?,
        })
    }

    fn table(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        match table.one_of(&TABLE_SOURCES)?.1 {
            TableSource::File => self.table_of_file(table),
            TableSource::WrittenOut => self.table_written_out(table),
        }
    }

    fn table_written_out(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        let times = table.quantities("times", Dimension::Time);
        let values = table.quantities("values", dimension(self.control));
        let (times, values) = (times?, values?);
        let plain = |list: &[Located<f64>]| list.iter().map(|v| v.value).collect();
        Some(Placed {
            segment: Segment::Table {
                times_s: plain(&times.value),
                values: plain(&values.value),
            },
            place: values.location,
        })
    }

    fn table_of_file(&self, table: &mut TableReader<'_>) -> Option<Placed> {
        let file = table.string("file")?;
        let (name, bytes) = data_file::named(&file, self.folder, self.problems)?;
        let table = drive_table::parse(&name, &bytes, self.control);
        let (times_s, values) = data_file::accepted(table, &file, self.problems)?;
        Some(Placed {
            segment: Segment::Table { times_s, values },
            place: file.location,
        })
    }
}
