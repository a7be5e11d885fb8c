//! What a sweep prints at its end: the table, the peaks, and what went wrong. At most 80 columns.

use std::fmt::{self, Write};

use super::figure;
use super::figure::units::Units;
use crate::history::Work;
use crate::quantity::{Dimension, format_human};
use crate::report::number::{one_digit, power_of_ten, with_error_on_terminal};
use crate::sweep::plan::{DriveAxis, SweepPlan};
use crate::sweep::record::warning;
use crate::sweep::record::{CaseRecord, Status};
use crate::sweep::search::peak::Peak;
use crate::sweep::search::run::Outcome;

/// One line per case: frequency, loss with its error, phase, cycles, status; an absent value is a dash. A sweep of two axes
/// has one line per drive instead: its cases are too many to be read.
pub fn table(plan: &SweepPlan, outcome: &Outcome) -> String {
    match &plan.axis {
        Some(axis) => drives(plan, axis, outcome),
        None => cases(&outcome.records),
    }
}

fn cases(records: &[CaseRecord]) -> String {
    let mut text =
        String::from(" ω / rad/s   loss / cycle              phase / deg   cycles   status\n");
    for record in records {
        let loss = Measured::loss(record.energy_loss_j(), record.energy_loss_error_j());
        let analysis = record.result.as_ref().map(|r| &r.analysis);
        let phase = analysis.map(|a| format!("{:.4}", a.phase_lag_rad.to_degrees()));
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:>10}   {loss}   {:>11}   {:>6}   {}",
            frequency(record.angular_frequency_rad_per_s),
            phase.unwrap_or_else(|| "-".to_owned()),
            record.cycles,
            record.status.name()
        );
    }
    text
}

/// Each drive with its highest peak.
fn drives(plan: &SweepPlan, axis: &DriveAxis, outcome: &Outcome) -> String {
    let name = axis.varied.name();
    let mut text = format!("{name:>10}   converged    loss / cycle, peak           ω / rad/s\n");
    let units = Units::default();
    for curve in figure::curve::curves(plan, outcome, &units) {
        let value = axis.varied.value(&curve.drive);
        let value = units.drive_value(curve.drive.control(), value);
        let of_curve = |peak: &&Peak| {
            peak.drive_mean == Some(curve.drive.mean())
                && peak.drive_amplitude == Some(curve.drive.amplitude())
        };
        // The peaks are in order, the largest first.
        let peak = outcome.peaks.iter().find(of_curve);
        let loss = Measured::loss(
            peak.map(|p| p.energy_loss_j),
            peak.and_then(|p| p.energy_loss_error_j),
        );
        let at = peak.map(|p| frequency(p.angular_frequency_rad_per_s));
        let count = format!("{} of {}", curve.results().len(), curve.records.len());
        let _ = writeln!(
            text,
            "{value:>10}   {count:>9}   {loss}     {:>10}",
            at.unwrap_or_else(|| "-".to_owned())
        );
    }
    text
}

/// A number with its error, as two columns to be read together: `3.5090 µJ ± 0.0003`.
struct Measured {
    value: Option<String>,
    error: Option<String>,
}

impl Measured {
    fn loss(loss_j: Option<f64>, error_j: Option<f64>) -> Self {
        Self::new(loss_j, error_j, Dimension::Energy)
    }

    /// With as many digits as the error leaves certain, but at least three and at most seven.
    fn new(value: Option<f64>, error: Option<f64>, dimension: Dimension) -> Self {
        let (Some(value), Some(error)) = (value, error.filter(|error| *error > 0.0)) else {
            let value = value.map(|value| format_human(value, dimension, 4));
            return Self { value, error: None };
        };
        let digits = power_of_ten(value)
            .saturating_sub(power_of_ten(one_digit(error)))
            .saturating_add(1);
        let digits = digits.clamp(3, 7) as usize;
        let text = format_human(value, dimension, digits);
        // The unit with its prefix is what makes the number of the value.
        let number = text.split(' ').next().and_then(|n| n.parse::<f64>().ok());
        let unit = number.map_or(1.0, |number| value / number);
        Self {
            error: Some(rounded_up(error / unit)),
            value: Some(text),
        }
    }
}

/// The number so rounded, in fixed notation where that takes no more than six decimals.
fn rounded_up(error: f64) -> String {
    let error = one_digit(error);
    match power_of_ten(error) {
        0.. => format!("{error:.0}"),
        power @ -6.. => format!("{error:.*}", -power as usize),
        _ => format!("{error:.0e}"),
    }
}

impl fmt::Display for Measured {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.value.as_deref().unwrap_or("-");
        match &self.error {
            Some(error) => write!(f, "{value:>12} ± {error:<8}"),
            None => write!(f, "{value:>12}{:11}", ""),
        }
    }
}

/// Peaks, largest first; where there are none, why. Of a sweep of two axes the largest alone: each drive has its own.
pub fn peaks(plan: &SweepPlan, outcome: &Outcome) -> String {
    let mut text = String::new();
    let shown = match plan.axis {
        Some(_) => outcome.peaks.len().min(1),
        None => outcome.peaks.len(),
    };
    for (rank, peak) in outcome.peaks.iter().take(shown).enumerate() {
        let what = if rank == 0 { "Peak" } else { "Lower peak" };
        let under = plan.axis.as_ref().and_then(|axis| {
            let value = peak.drive(axis.varied)?;
            let value = Units::default().drive_value(plan.drive.control(), value);
            Some(format!(", {} {value}", axis.varied.name()))
        });
        let _ = writeln!(
            text,
            "{what}: {} at ω = {}{}",
            with_error_on_terminal(
                peak.energy_loss_j,
                peak.energy_loss_error_j,
                Dimension::Energy
            ),
            with_error_on_terminal(
                peak.angular_frequency_rad_per_s,
                Some(peak.angular_frequency_uncertainty_rad_per_s),
                Dimension::AngularFrequency,
            ),
            under.unwrap_or_default()
        );
    }
    for problem in &outcome.peak_problems {
        let line = format!("Peak not located: {problem}");
        text.push_str(&wrapped(&line, 80, "", "  "));
    }
    if text.is_empty() && !outcome.interrupted {
        text.push_str(no_peak(plan, outcome));
    }
    text
}

fn no_peak(plan: &SweepPlan, outcome: &Outcome) -> &'static str {
    let converged = outcome.count(Status::Converged);
    if converged == 0 {
        "No peak: no case converged.\n"
    } else if outcome.retardation_times_s().is_empty() {
        "No peak: the material has no branches; an elastic body loses nothing.\n"
    } else if plan.angular_frequencies_rad_per_s.len() < 3 {
        "No peak: it takes at least three frequencies to enclose one.\n"
    } else {
        "No peak inside the sweep: the loss is largest at one of its ends. Widen the sweep.\n"
    }
}

/// What the cases of the table cost, coarser resolutions too.
pub fn work(outcome: &Outcome) -> String {
    let mut work = Work::default();
    for record in &outcome.records {
        work += record.work;
    }
    let instants = work.instants.max(1) as f64;
    let mut text = format!(
        "Work: {} instants, {:.1} iterations an instant",
        work.instants,
        work.iterations as f64 / instants
    );
    if work.convolutions > 0 {
        let _ = write!(
            text,
            ", {:.1} convolutions an instant",
            work.convolutions_per_instant().unwrap_or_default()
        );
    }
    text.push('\n');
    text
}

/// Cases without a result, with the reason.
pub fn problems(outcome: &Outcome) -> String {
    let mut text = String::new();
    for record in outcome.records.iter().filter(|r| r.result.is_none()) {
        let line = format!(
            "ω = {} rad/s: {}: {}",
            frequency(record.angular_frequency_rad_per_s),
            record.status.name(),
            record.message.as_deref().unwrap_or("no reason recorded")
        );
        text.push_str(&wrapped(&line, 80, "", "  "));
    }
    text
}

/// What lies outside the model, or was not estimated: one line for each kind, whatever the number of cases.
pub fn warnings_of_sweep(outcome: &Outcome) -> String {
    warned(warning::over_cases(&outcome.records))
}

/// Warnings, one after another.
pub fn warned(warnings: impl IntoIterator<Item = impl fmt::Display>) -> String {
    let lines = warnings.into_iter();
    lines
        .map(|warning| wrapped(&format!("warning: {warning}"), 80, "", "  "))
        .collect()
}

/// A paragraph in lines of at most so many columns, as far as its words allow; `first` stands before the first line, `next` before
/// the others.
pub fn wrapped(text: &str, columns: usize, first: &str, next: &str) -> String {
    let mut lines = vec![first.to_owned()];
    let mut is_empty = true;
    for word in text.split_whitespace() {
        let line = lines.last().map_or(0, |line| line.chars().count());
        if !is_empty && line + 1 + word.chars().count() > columns {
            lines.push(next.to_owned());
            is_empty = true;
        }
        if let Some(line) = lines.last_mut() {
            if !is_empty {
                line.push(' ');
            }
            line.push_str(word);
            is_empty = false;
        }
    }
    lines.join("\n") + "\n"
}

/// Four digits, with an exponent where the number is small or large.
pub fn frequency(value: f64) -> String {
    if (0.01..1e4).contains(&value) {
        format!(
            "{:.*}",
            (3 - value.log10().floor() as i32).max(0) as usize,
            value
        )
    } else {
        format!("{value:.3e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paragraphs_are_wrapped_between_words() {
        assert_eq!(wrapped("a bb  ccc d", 6, "", " "), "a bb\n ccc d\n");
        assert_eq!(
            wrapped("longer than that", 4, "- ", "  "),
            "- longer\n  than\n  that\n"
        );
        assert_eq!(wrapped("", 9, "    ", ""), "    \n");
    }

    #[test]
    fn a_number_of_the_table_has_the_digits_that_its_error_leaves_it() {
        let joule = |value, error| {
            let text = Measured::loss(Some(value), error).to_string();
            text.trim().to_owned()
        };
        assert_eq!(joule(3.50901e-6, Some(2.8e-10)), "3.5090 µJ ± 0.0003");
        assert_eq!(joule(3.50901e-6, Some(2.8e-9)), "3.509 µJ ± 0.003");
        assert_eq!(joule(91.47e-9, Some(9.6e-11)), "91.5 nJ ± 0.1");
        assert_eq!(joule(91.47e-9, None), "91.47 nJ");
        assert_eq!(joule(91.47e-9, Some(0.0)), "91.47 nJ");
        // Beyond seven digits the error is told with an exponent.
        assert_eq!(joule(3.50901e-6, Some(2.8e-15)), "3.509010 µJ ± 3e-9");
        assert_eq!(joule(3.5e-6, Some(5e-6)), "3.50 µJ ± 5");
    }

    #[test]
    fn errors_are_rounded_up_never_down() {
        for (error, text) in [
            (0.31, "0.4"),
            (0.3, "0.3"),
            (0.91, "1"),
            (12.0, "20"),
            (9.5e-8, "1e-7"),
        ] {
            assert_eq!(rounded_up(error), text);
        }
    }
}
