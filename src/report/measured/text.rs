//! What the terminal says of measured loops, in at most 80 columns.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::MeasuredRow;
use super::columns::drift;
use crate::measured::drift::DriftModel;
use crate::measured::{Estimate, Finding, MeasuredLoop, Quantity};
use crate::quantity::{Dimension, format_human};
use crate::report::number::{Measured, four_digits};
use crate::report::words::wrapped_line;
use crate::sweep::record::Status;

/// Files with the same finding that are named before the rest is counted.
const NAMED: usize = 3;

/// One line a record: frequency, loss and phase with half their intervals of 95 %, cycles that count, file.
pub fn table(rows: &[MeasuredRow]) -> String {
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
    let mut text = format!(
        "{:>10}   {:<20}   {:<16}   {:>8}   file\n",
        "f / Hz", "loss / cycle", "phase / deg", "cycles"
    );
    for row in rows {
        let measured = row.measured.as_ref();
        let loss = row.mean(Quantity::EnergyLoss);
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:>10}   {:<20}   {:<16}   {:>8}   {}",
            or_dash(measured.map(|m| four_digits(m.frequency.hz))),
            or_dash(loss.map(|mean| with_error(mean, Dimension::Energy))),
            or_dash(degrees(row)),
            or_dash(measured.map(|m| format!("{} of {}", m.used.len(), m.cycles.len()))),
            short(&row.file),
        );
    }
    let meaning = "The number after ± is half the width of the 95 % interval, from the scatter of the cycles and the noise of the samples.";
    text + &wrapped_line(meaning)
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
pub fn moduli(rows: &[MeasuredRow]) -> String {
    let pascal = |mean: Option<Estimate>| {
        mean.map_or("-".to_owned(), |mean| with_error(mean, Dimension::Stress))
    };
    let mut text = String::new();
    for row in rows {
        let (Some(measured), Some(_)) = (&row.measured, row.mean(Quantity::LossModulus)) else {
            continue;
        };
        if text.is_empty() {
            text.push_str(
                "\n    f / Hz   modulus   formula               bias      without bias\n",
            );
        }
        let mut hz = four_digits(measured.frequency.hz);
        let [storage, loss] = [
            measured
                .unbiased
                .map(|u| (u.storage_bias, u.storage_modulus_pa)),
            measured.unbiased.map(|u| (u.loss_bias, u.loss_modulus_pa)),
        ];
        for (name, formula, unbiased) in [
            ("E'", Quantity::StorageModulus, storage),
            ("E''", Quantity::LossModulus, loss),
        ] {
            let percent = |(bias, _): (f64, _)| format!("{:+.2} %", 100.0 * (bias - 1.0));
            let _ = writeln!(
                text,
                "{hz:>10}   {name:<7}   {:<19}   {:>7}   {}",
                pascal(row.mean(formula)),
                unbiased.map_or("-".to_owned(), percent),
                pascal(unbiased.map(|(_, modulus)| modulus)),
            );
            hz.clear();
        }
    }
    text
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
pub fn findings(rows: &[MeasuredRow]) -> String {
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
    let mut text = String::new();
    for files in kinds.values() {
        for (file, sentence) in files.iter().take(NAMED) {
            let warning = format!("warning: {}: {sentence}", short(file));
            text.push_str(&wrapped_line(&warning));
        }
        if files.len() > NAMED {
            let _ = writeln!(text, "  the like of {} more files", files.len() - NAMED);
        }
    }
    text
}

/// Of every file that has no mean its name, whole, and why.
pub fn without_mean(rows: &[MeasuredRow]) -> String {
    let without = rows.iter().filter(|row| row.status() != Status::Converged);
    let lines = without.map(|row| {
        let changes = |finding: &&Finding| matches!(finding, Finding::NotStabilised { .. });
        let why = row.findings().find(changes).map(Finding::to_string);
        let why = row.reason.clone().or(why);
        let why = why.unwrap_or_else(|| "no cycle counts in a mean".to_owned());
        format!("{}: {}: {why}\n", row.file, row.status().name())
    });
    lines.collect()
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
