//! What a comparison says on the terminal and in a table.

use super::{Comparison, PeakComparison, Place};
use crate::quantity::FrequencyUnit;
use crate::report::number::{four_digits, scientific};
use crate::report::table::{Cell, cells, csv_leading};
use crate::report::text::{Column, Table, Text};
use crate::report::words::case;
use crate::sweep::search::peak::Peak;

/// Names of cases shown before the rest is counted.
const NAMED: usize = 10;

impl Comparison {
    /// The whole finding.
    pub fn text(&self) -> Text {
        let mut text = Text::from(format!("{} cases in both results", self.compared));
        self.name(&mut text, "missing in the new result", &self.missing);
        self.name(&mut text, "only in the new result", &self.added);
        for (what, columns) in [
            ("missing in the new result", &self.missing_columns),
            ("only in the new result", &self.added_columns),
        ] {
            if !columns.is_empty() {
                text.paragraph(format!("columns {what}: {}", columns.join(", ")));
            }
        }
        for (place, old, new) in self.statuses.iter().take(NAMED) {
            text.line(format!("{}: {old} before, {new} now", self.words(place)));
        }
        if self.compared > 0 {
            text.blank();
            text.append(self.table_of_columns());
        }
        for peak in &self.peaks {
            text.line(peak_words(self.unit, peak));
        }
        if let Some(reason) = &self.peaks_not_compared {
            text.paragraph(format!("peaks: not compared, {reason}"));
        }
        text
    }

    fn table_of_columns(&self) -> Table {
        let columns = [
            Column::left(" column", 22),
            Column::left("largest difference,\nrelative to the larger", 30),
            Column::right("beyond\ntolerance", 9),
            Column::right("of these\nin bars", 12),
        ];
        let mut table = Table::new(1, columns);
        for column in &self.columns {
            let largest = match &column.largest {
                Some((share, place)) => format!(
                    "{share:.1e}{} at {} = {}",
                    if column.is_absolute { " abs." } else { "" },
                    self.unit.symbol(),
                    four_digits(self.unit.of(place.angular_frequency_rad_per_s))
                ),
                None => "none".to_owned(),
            };
            let [beyond, within] = [column.beyond, column.within_bars].map(|n| n.to_string());
            table.row([format!(" {}", column.name), largest, beyond, within]);
            for (number, what) in [
                (column.absent, "without a value in one of the two"),
                (
                    column.not_judged,
                    "not judged: other steps or nodes, no error bars",
                ),
            ] {
                if number > 0 {
                    table.remark(format!("   {number} {what}"));
                }
            }
        }
        table
    }

    /// What axes vary of a case, in words that others follow; before a number stands `axis`.
    pub(in crate::report) fn varied_words(&self, place: &Place, axis: &str) -> String {
        let words = |value: Cell| match value {
            Cell::Number(number) => format!("{axis}{number}, "),
            name => format!("{}, ", name.text()),
        };
        self.varied(place).into_iter().map(words).collect()
    }

    /// A case in words.
    pub(in crate::report) fn words(&self, place: &Place) -> String {
        format!(
            "{} ({}mean {}, amplitude {})",
            case(self.unit, place.angular_frequency_rad_per_s),
            self.varied_words(place, "axis "),
            place.drive_mean,
            place.drive_amplitude
        )
    }

    fn name(&self, text: &mut Text, what: &str, places: &[Place]) {
        if places.is_empty() {
            return;
        }
        text.line(format!("{} cases {what}:", places.len()));
        for place in places.iter().take(NAMED) {
            text.line(format!("  {}", self.words(place)));
        }
        if places.len() > NAMED {
            text.line(format!("  and {} more", places.len() - NAMED));
        }
    }

    /// `comparison.csv`: the curves of the energy loss and their difference.
    pub fn table(&self) -> Vec<u8> {
        let curve = self.curve.iter();
        let axes = curve
            .map(|point| point.place.varied.all().len())
            .max()
            .unwrap_or(0);
        // The first is `varied` alone, as where there is one.
        let varied = (1..=axes).map(|k| match k {
            1 => "varied".to_owned(),
            k => format!("varied_{k}"),
        });
        let numbers = [
            "drive_mean",
            "drive_amplitude",
            "angular_frequency_rad_per_s",
            "baseline_energy_loss_j",
            "new_energy_loss_j",
            "relative_difference",
            "error_bars_j",
        ];
        let columns: Vec<String> = varied.chain(numbers.map(str::to_owned)).collect();
        let rows = self.curve.iter().map(|point| {
            let mut varied = self.varied(&point.place);
            varied.resize(axes, Cell::Absent);
            let numbers: [Cell; 7] = cells![
                point.place.drive_mean,
                point.place.drive_amplitude,
                point.place.angular_frequency_rad_per_s,
                point.baseline_j,
                point.new_j,
                point.relative_difference(),
                point.error_j,
            ];
            varied.into_iter().chain(numbers).collect::<Vec<Cell>>()
        });
        csv_leading(self.unit, &columns, rows)
    }
}

impl super::CurvePoint {
    /// By what share of the baseline the new loss is larger.
    pub fn relative_difference(&self) -> Option<f64> {
        let (old, new) = self.baseline_j.zip(self.new_j)?;
        (old != 0.0).then(|| new / old - 1.0)
    }
}

/// A pair of peaks in words.
pub(in crate::report) fn peak_words(unit: FrequencyUnit, peak: &PeakComparison) -> String {
    let omega = |peak: &Peak| {
        let value = four_digits(unit.of(peak.angular_frequency_rad_per_s));
        format!("{value} {}", unit.name())
    };
    match (&peak.baseline, &peak.new) {
        (Some(old), Some(new)) => {
            let ratio = |a: f64, b: f64| {
                let percent = 100.0 * (b / a - 1.0);
                let sign = if percent > 0.0 { "+" } else { "" };
                format!("{sign}{}", scientific(percent, 2))
            };
            format!(
                "peak at {}: moved by {} %, its loss by {} %{}",
                omega(old),
                ratio(
                    old.angular_frequency_rad_per_s,
                    new.angular_frequency_rad_per_s
                ),
                ratio(old.energy_loss_j, new.energy_loss_j),
                if peak.differs { ": differs" } else { "" }
            )
        }
        (Some(old), None) => format!("peak at {}: missing in the new result", omega(old)),
        (None, Some(new)) => format!("peak at {}: only in the new result", omega(new)),
        (None, None) => String::new(),
    }
}
