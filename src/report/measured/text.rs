//! What the terminal says of measured loops, in at most 80 columns.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::MeasuredRow;
use super::columns::drift;
use crate::measured::drift::DriftModel;
use crate::measured::{Estimate, MeasuredLoop, Quantity};
use crate::quantity::{Dimension, format_human};
use crate::report::number::{Measured, four_digits};
use crate::report::words::wrapped;

/// Files with the same finding that are named before the rest is counted.
const NAMED: usize = 3;

/// One line a record: frequency, loss and phase with half their intervals of 95 %, cycles that count, file.
pub fn table(rows: &[MeasuredRow]) -> String {
    let mut text =
        "    f / Hz   loss / cycle           phase / deg        cycles   file\n".to_owned();
    for row in rows {
        let measured = row.measured.as_ref();
        let hz = measured.map(|m| four_digits(m.frequency.hz));
        let loss = row.mean(Quantity::EnergyLoss);
        let loss = loss.map(|mean| with_error(mean.value, mean.error, Dimension::Energy));
        let phase = degrees(row);
        let cycles = measured.map(|m| format!("{} of {}", m.used.len(), m.cycles.len()));
        let dash = || "-".to_owned();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:>10}   {:<20}   {:<16}   {:>8}   {}",
            hz.unwrap_or_else(dash),
            loss.unwrap_or_else(dash),
            phase.unwrap_or_else(dash),
            cycles.unwrap_or_else(dash),
            short(&row.file),
        );
    }
    text.push_str(
        "After ± stands half the interval of 95 %, from scatter of cycles and noise of samples.\n",
    );
    wrapped_last(text)
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
    let pascal = |mean: Option<Estimate>| match mean {
        Some(mean) => with_error(mean.value, mean.error, Dimension::Stress),
        None => "-".to_owned(),
    };
    let rows: Vec<&MeasuredRow> = rows
        .iter()
        .filter(|row| row.mean(Quantity::LossModulus).is_some())
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    let mut text =
        "\n    f / Hz   modulus   formula               bias      without bias\n".to_owned();
    for row in rows {
        let measured = row.measured.as_ref();
        let hz = measured.map_or(String::new(), |m| four_digits(m.frequency.hz));
        let unbiased = measured.and_then(|m| m.unbiased);
        let line = |name, formula, bias: Option<f64>, corrected| {
            let bias = bias.map_or("-".to_owned(), |bias| {
                format!("{:+.2} %", 100.0 * (bias - 1.0))
            });
            format!(
                "{name:<7}   {:<19}   {bias:>7}   {}\n",
                pascal(formula),
                pascal(corrected)
            )
        };
        let storage = line(
            "E'",
            row.mean(Quantity::StorageModulus),
            unbiased.map(|u| u.storage_bias),
            unbiased.map(|u| u.storage_modulus_pa),
        );
        let loss = line(
            "E''",
            row.mean(Quantity::LossModulus),
            unbiased.map(|u| u.loss_bias),
            unbiased.map(|u| u.loss_modulus_pa),
        );
        let _ = write!(text, "{hz:>10}   {storage}{:>10}   {loss}", "");
    }
    text
}

/// The last line of a table wrapped.
fn wrapped_last(text: String) -> String {
    let trimmed = text.trim_end();
    match trimmed.rsplit_once('\n') {
        Some((table, last)) => format!("{table}\n{}", wrapped(last, 80, "", "")),
        None => text,
    }
}

/// The end of a path, as much as a line has room for.
fn short(file: &str) -> String {
    const ROOM: usize = 12;
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let length = name.chars().count();
    match length <= ROOM {
        true => name.to_owned(),
        false => format!(
            "…{}",
            name.chars().skip(length + 1 - ROOM).collect::<String>()
        ),
    }
}

fn with_error(value: f64, error: Option<f64>, dimension: Dimension) -> String {
    match Measured::new(value, error, dimension) {
        Some(measured) => {
            let tens = measured.tens();
            let Measured {
                value, error, unit, ..
            } = measured;
            format!("{value} ± {error}{tens} {unit}")
        }
        None => format_human(value, dimension, 4),
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
        for finding in row.measured.iter().flat_map(|m| &m.findings) {
            let files = kinds.entry(finding.code()).or_default();
            files.push((&row.file, finding.to_string()));
        }
        if let Some(reason) = &row.reason {
            kinds
                .entry("failed")
                .or_default()
                .push((&row.file, reason.clone()));
        }
    }
    let mut text = String::new();
    for files in kinds.values() {
        for (file, sentence) in files.iter().take(NAMED) {
            text.push_str(&wrapped(
                &format!("warning: {}: {sentence}", short(file)),
                80,
                "",
                "  ",
            ));
        }
        if files.len() > NAMED {
            let _ = writeln!(text, "  the like of {} more files", files.len() - NAMED);
        }
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
    lines.push(match (measured.first_stabilised, measured.used.len()) {
        (Some(first), used) => {
            format!("Stabilised from cycle {first} on; {used} of {all} cycles count in the means.")
        }
        (None, _) => format!("Not stabilised within {all} cycles."),
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
