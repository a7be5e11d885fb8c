//! What the terminal says of measured loops.

use std::collections::BTreeMap;

use super::MeasuredRow;
use super::columns::drift;
use crate::measured::drift::DriftModel;
use crate::measured::{Estimate, Finding, MeasuredLoop, Quantity};
use crate::quantity::{Dimension, format_human};
use crate::report::number::{Measured, four_digits};
use crate::report::text::{Column, Table, Text};
use crate::sweep::record::Status;

/// Files with the same finding that are named before the rest is counted.
const NAMED: usize = 3;

/// What is printed at the end: of a single record what was done with it, the tables, and what is to be known.
pub fn text(rows: &[MeasuredRow]) -> Text {
    let mut text = Text::default();
    if let [row] = rows
        && let Some(measured) = &row.measured
    {
        text = record(measured).into_iter().collect();
        text.blank();
    }
    text.append(table(rows));
    text.append_apart(moduli(rows));
    text.append(findings(rows));
    text
}

/// One line a record: frequency, loss and phase with half their intervals of 95 %, cycles that count, file.
fn table(rows: &[MeasuredRow]) -> Text {
    let columns = [
        Column::right("f / Hz", 10),
        Column::left("loss / cycle", 20),
        Column::left("phase / deg", 16),
        Column::right("cycles", 8).leaves_first(),
        Column::left("file", 0).stays(),
    ];
    let mut table = Table::new(3, columns);
    for row in rows {
        let measured = row.measured.as_ref();
        let loss = row.mean(Quantity::EnergyLoss);
        let cells = [
            measured.map(|m| four_digits(m.frequency.hz)),
            loss.map(|mean| with_error(mean, Dimension::Energy)),
            degrees(row),
            measured.map(|m| format!("{} of {}", m.used.len(), m.cycles.len())),
            Some(short(&row.file)),
        ];
        table.row(cells.map(or_dash));
    }
    let mut text = Text::from(table);
    text.paragraph("The number after ± is half the width of the 95 % interval, from the scatter of the cycles and the noise of the samples.");
    text
}

fn or_dash(text: Option<String>) -> String {
    text.unwrap_or_else(|| "-".to_owned())
}

/// Phase lag and half its interval in degrees.
fn degrees(row: &MeasuredRow) -> Option<String> {
    let mean = row.mean(Quantity::PhaseLag)?;
    Some(angle(
        mean.value.to_degrees(),
        mean.error.map(f64::to_degrees),
    ))
}

/// The same with its unit, a dash where there is none.
pub fn phase(row: &MeasuredRow) -> String {
    degrees(row).map_or("–".to_owned(), |degrees| format!("{degrees}°"))
}

/// Moduli, where there are some: by the formula, and without its bias. Both, so that the bias is seen.
fn moduli(rows: &[MeasuredRow]) -> Text {
    let pascal = |mean: Option<Estimate>| or_dash(mean.map(|m| with_error(m, Dimension::Stress)));
    let columns = [
        Column::right("f / Hz", 10),
        Column::left("modulus", 7).stays(),
        Column::left("formula", 19),
        Column::right("bias   ", 7),
        Column::left("without bias", 0),
    ];
    let mut table = Table::new(3, columns);
    for row in rows {
        let (Some(measured), Some(_)) = (&row.measured, row.mean(Quantity::LossModulus)) else {
            continue;
        };
        let unbiased = measured.unbiased.as_ref();
        let storage = unbiased.map(|u| (u.storage_bias, u.storage_modulus_pa));
        let loss = unbiased.map(|u| (u.loss_bias, u.loss_modulus_pa));
        for (hz, name, formula, unbiased) in [
            (
                four_digits(measured.frequency.hz),
                "E'",
                Quantity::StorageModulus,
                storage,
            ),
            (String::new(), "E''", Quantity::LossModulus, loss),
        ] {
            let percent = |(bias, _): (f64, _)| format!("{:+.2} %", 100.0 * (bias - 1.0));
            table.row([
                hz,
                name.to_owned(),
                pascal(row.mean(formula)),
                or_dash(unbiased.map(percent)),
                pascal(unbiased.map(|(_, modulus)| modulus)),
            ]);
        }
    }
    table.into()
}

/// The end of a path, as much as a line has room for.
fn short(file: &str) -> String {
    const ROOM: usize = 12;
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    match name.chars().count() {
        length if length <= ROOM => name.to_owned(),
        length => "…"
            .chars()
            .chain(name.chars().skip(length + 1 - ROOM))
            .collect(),
    }
}

fn with_error(mean: Estimate, dimension: Dimension) -> String {
    match Measured::new(mean.value, mean.error, dimension) {
        Some(m) => format!(
            "{}{tens} ± {}{tens} {}",
            m.value,
            m.error,
            m.unit,
            tens = m.tens()
        ),
        None => format_human(mean.value, dimension, 4),
    }
}

/// An angle with as many decimals as its error has.
fn angle(degrees: f64, error: Option<f64>) -> String {
    let Some(error) = error.filter(|error| error.is_finite() && *error > 0.0) else {
        return format!("{degrees:.4}");
    };
    let decimals = (-error.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{degrees:.decimals$} ± {error:.decimals$}")
}

/// What was told apart, and what is to be known: one line for each kind, whatever the number of files.
fn findings(rows: &[MeasuredRow]) -> Text {
    let mut kinds: BTreeMap<&str, Vec<(&str, String)>> = BTreeMap::new();
    for row in rows {
        let failed = row.reason.iter().map(|reason| ("failed", reason.clone()));
        let found = row
            .findings()
            .map(|finding| (finding.code(), finding.to_string()));
        for (kind, sentence) in found.chain(failed) {
            kinds.entry(kind).or_default().push((&row.file, sentence));
        }
    }
    let mut text = Text::default();
    for files in kinds.values() {
        for (file, sentence) in files.iter().take(NAMED) {
            text.paragraph(format!("warning: {}: {sentence}", short(file)));
        }
        if files.len() > NAMED {
            text.line(format!("  the like of {} more files", files.len() - NAMED));
        }
    }
    text
}

/// Of every file that has no mean its name, whole, and why.
pub fn without_mean(rows: &[MeasuredRow]) -> Text {
    let mut text = Text::default();
    for row in rows.iter().filter(|row| row.status() != Status::Converged) {
        let changes = |finding: &&Finding| matches!(finding, Finding::NotStabilised { .. });
        let why = row.findings().find(changes).map(Finding::to_string);
        let why = row.reason.clone().or(why);
        let why = why.unwrap_or_else(|| "no cycle counts in a mean".to_owned());
        text.line(format!("{}: {}: {why}", row.file, row.status().name()));
    }
    text
}

/// What was done with a single record, in sentences.
pub fn record(measured: &MeasuredLoop) -> Vec<String> {
    let sampling = &measured.sampling;
    let frequency = &measured.frequency;
    let how = match frequency.standard_error_hz {
        Some(error) => format!("found, ± {:.1e} Hz", 1.96 * error),
        None if frequency.is_given => "given".to_owned(),
        None => "found".to_owned(),
    };
    let mut lines = vec![format!(
        "{} samples over {}, {:.1} a cycle; frequency {:.7} Hz ({how}).",
        sampling.samples,
        format_human(sampling.duration_s, Dimension::Time, 4),
        measured.points_per_cycle,
        frequency.hz,
    )];
    let drifts = [("load", Dimension::Force), ("approach", Dimension::Length)];
    for ((name, dimension), found) in drifts.into_iter().zip(&measured.drifts) {
        if found.model != DriftModel::None {
            let change = format_human(found.change, dimension, 3);
            let model = drift(found.model);
            lines.push(format!(
                "Drift of the {name}: {model}; {change} over the record, taken off."
            ));
        }
    }
    let all = measured.cycles.len();
    let used = measured.used.len();
    lines.push(match measured.first_stabilised {
        Some(first) => {
            format!("Stabilised from cycle {first} on; {used} of {all} cycles count in the means.")
        }
        None => format!("Not stabilised within {all} cycles."),
    });
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_has_the_decimals_of_its_error() {
        assert_eq!(angle(5.123_456, Some(0.0123)), "5.12 ± 0.01");
        assert_eq!(angle(5.123_456, None), "5.1235");
        assert_eq!(short("a/b/loop.csv"), "loop.csv");
        assert_eq!(short("a-long-name-of-a-file.csv").chars().count(), 12);
    }
}
