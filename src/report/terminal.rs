//! What a sweep prints at its end: the table, the peaks, and what went wrong. At most 80 columns.

use std::fmt::{Display, Write};

use super::figure;
use super::figure::units::Units;
use super::number::{Measured, four_digits, with_error_on_terminal};
use super::peaks;
use super::rigid_indenter;
use super::words::{without_result, wrapped};
use crate::history::Work;
use crate::quantity::{Dimension, FrequencyUnit, format_human};
use crate::sweep::plan::{Axes, Condition, SweepPlan, Varied};
use crate::sweep::record::CaseRecord;
use crate::sweep::record::warning;
use crate::sweep::search::run::Outcome;

/// One line per case: frequency, loss with its error, phase, cycles, status; an absent value is a dash. A sweep of two axes
/// has one line per value of the second instead: its cases are too many to be read.
pub fn table(plan: &SweepPlan, outcome: &Outcome) -> String {
    match &plan.axes {
        Some(axes) => conditions(plan, axes, outcome),
        None => cases(plan.figures.frequency_unit, &outcome.records),
    }
}

/// The head of a column of frequencies: `ω / rad/s`.
fn frequency_head(unit: FrequencyUnit) -> String {
    format!("{} / {}", unit.symbol(), unit.name())
}

fn cases(unit: FrequencyUnit, records: &[CaseRecord]) -> String {
    let has_material_error = (records.iter()).any(|r| r.energy_loss_material_error_j().is_some());
    // Both would make the lines too long.
    let fourth = if has_material_error {
        "material"
    } else {
        "cycles"
    };
    let mut text = format!(
        "{:>10}   loss / cycle              phase / deg   {fourth:>6}   status\n",
        frequency_head(unit)
    );
    for record in records {
        let loss = loss(record.energy_loss_j(), record.energy_loss_error_j());
        let analysis = record.result.as_ref().map(|r| &r.analysis);
        let phase = analysis.map(|a| format!("{:.4}", a.phase_lag_rad.to_degrees()));
        let fourth = match has_material_error {
            true => format!(
                "{:>8}",
                material_error(record).unwrap_or_else(|| "-".to_owned())
            ),
            false => format!("{:>6}", record.cycles),
        };
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:>10}   {loss}   {:>11}   {fourth}   {}",
            four_digits(unit.of(record.angular_frequency_rad_per_s)),
            phase.unwrap_or_else(|| "-".to_owned()),
            record.status.name()
        );
    }
    if has_material_error {
        text.push_str(
            "Beside the loss: numerical error; material: uncertainty from its data's noise.\n",
        );
    }
    text
}

/// The uncertainty of a loss that comes from the material, relative: `± 4.2 %`.
fn material_error(record: &CaseRecord) -> Option<String> {
    let (loss_j, error_j) = (
        record.energy_loss_j()?,
        record.energy_loss_material_error_j()?,
    );
    (loss_j != 0.0).then(|| format!("± {:.1} %", 100.0 * (error_j / loss_j).abs()))
}

/// Each value of the second axis with its highest peak.
fn conditions(plan: &SweepPlan, axes: &Axes, outcome: &Outcome) -> String {
    let names: Vec<String> = axes.over.iter().map(Varied::name).collect();
    let name = names.join(", ");
    let unit = plan.figures.frequency_unit;
    let units = Units::default();
    let curves = figure::curve::curves(plan, outcome, &units);
    let value = |condition: &Condition| {
        let values = axes.over.iter().zip(condition.values.all());
        let values = values.map(|(varied, value)| units.varied_value(varied, *value));
        values.collect::<Vec<_>>().join(", ")
    };
    let values: Vec<String> = curves.iter().map(|curve| value(&curve.condition)).collect();
    let lengths = values
        .iter()
        .chain([&name])
        .map(|text| text.chars().count());
    let width = lengths.max().unwrap_or(0).max(10);
    let mut text = format!(
        "{name:>width$}   converged    loss / cycle, peak          {:>10}\n",
        frequency_head(unit)
    );
    for (curve, value) in curves.iter().zip(values) {
        let peak = outcome.highest_peak(&curve.condition);
        let loss = loss(
            peak.map(|p| p.energy_loss_j),
            peak.and_then(|p| p.energy_loss_error_j),
        );
        let at = peak.map(|p| four_digits(unit.of(p.angular_frequency_rad_per_s)));
        let count = format!("{} of {}", curve.results().len(), curve.records.len());
        let _ = writeln!(
            text,
            "{value:>width$}   {count:>9}   {loss}     {:>10}",
            at.unwrap_or_else(|| "-".to_owned())
        );
    }
    text
}

/// A loss with its error, as two columns to be read together: `3.5090 µJ ± 0.0003`.
fn loss(loss_j: Option<f64>, error_j: Option<f64>) -> String {
    let energy = Dimension::Energy;
    match loss_j.and_then(|loss_j| Measured::new(loss_j, error_j, energy)) {
        Some(measured) => {
            let value = format!("{}{} {}", measured.value, measured.tens(), measured.unit);
            format!("{value:>12} ± {:<8}", measured.error)
        }
        None => {
            let value = loss_j.map(|loss_j| format_human(loss_j, energy, 4));
            format!("{:>12}{:11}", value.as_deref().unwrap_or("-"), "")
        }
    }
}

/// Peaks, largest first; where there are none, why. Of a sweep of two axes the largest alone: each curve has its own.
pub fn peaks(plan: &SweepPlan, outcome: &Outcome) -> String {
    let mut text = String::new();
    for peak in peaks::shown(plan, outcome, with_error_on_terminal) {
        let what = if peak.is_largest {
            "Peak"
        } else {
            "Lower peak"
        };
        let _ = writeln!(text, "{what}: {}", peak.sentence());
    }
    for problem in &outcome.peak_problems {
        let line = format!("Peak not located: {problem}");
        text.push_str(&wrapped(&line, 80, "", "  "));
    }
    if text.is_empty() && !outcome.interrupted {
        let _ = writeln!(text, "{}", peaks::none(plan, outcome));
    }
    text
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
pub fn problems(plan: &SweepPlan, outcome: &Outcome) -> String {
    let lines = without_result(plan.figures.frequency_unit, outcome);
    lines.map(|line| wrapped(&line, 80, "", "  ")).collect()
}

/// What lies outside the model, or was not estimated: one line for each kind, whatever the number of cases.
pub fn warnings_of_sweep(plan: &SweepPlan, outcome: &Outcome) -> String {
    let unit = plan.figures.frequency_unit;
    let note = rigid_indenter::note(plan, outcome);
    let note = note.map(|note| wrapped(&format!("note: {note}"), 80, "", "  "));
    warned(warning::over_cases(&outcome.records, unit)) + &note.unwrap_or_default()
}

/// Warnings, one after another.
pub fn warned(warnings: impl IntoIterator<Item = impl Display>) -> String {
    let lines = warnings.into_iter();
    lines
        .map(|warning| wrapped(&format!("warning: {warning}"), 80, "", "  "))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_of_the_table_has_the_digits_that_its_error_leaves_it() {
        let joule = |value, error| {
            let text = loss(Some(value), error);
            text.trim().to_owned()
        };
        assert_eq!(joule(3.50901e-6, Some(2.8e-10)), "3.5090 µJ ± 0.0003");
        assert_eq!(joule(3.50901e-6, Some(2.8e-9)), "3.509 µJ ± 0.003");
        assert_eq!(joule(91.47e-9, Some(9.6e-11)), "91.5 nJ ± 0.1");
        assert_eq!(joule(91.47e-9, None), "91.47 nJ");
        assert_eq!(joule(91.47e-9, Some(0.0)), "91.47 nJ");
        // Beyond six decimals an error is not followed.
        assert_eq!(joule(3.50901e-6, Some(2.8e-15)), "3.509010 µJ ± 0.000001");
        assert_eq!(joule(3.4e-6, Some(5e-6)), "3 µJ ± 5");
    }
}
