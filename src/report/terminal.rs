//! What a sweep prints at its end: the table, the peaks, and what went wrong.

use std::fmt::Display;
use std::path::Path;

use serde_json::{Value, json};

use super::figure;
use super::figure::units::Units;
use super::fit;
use super::number::{Measured, four_digits};
use super::peaks;
use super::rigid_indenter;
use super::text::{Column, Table, Text};
use super::words::without_result;
use crate::history::Work;
use crate::quantity::{Dimension, FrequencyUnit, format_human};
use crate::report::warnings;
use crate::sweep::plan::{Axes, AxisValues, Block, Case, Condition, SweepPlan, Varied};
use crate::sweep::record::CaseRecord;
use crate::sweep::search::run::Outcome;
use crate::sweep::share::shard::Shard;

/// Title, materials where they come from data, the table, peaks, what went wrong, and which files were left out.
pub fn text(plan: &SweepPlan, outcome: &Outcome, left_out: &[String]) -> Text {
    let mut text = Text::from(format!("{}\n\n", plan.title));
    for (_, condition) in plan.each_of(Block::Material) {
        let origin = fit::origin(&condition.contact.material);
        if !origin.is_empty() {
            text.append(origin);
            text.blank();
        }
    }
    text.append(table(plan, outcome));
    for part in [
        peaks(plan, outcome),
        problems(plan, outcome),
        warnings_of_sweep(plan, outcome),
        left_out.join("\n").into(),
    ] {
        text.append_apart(part);
    }
    if outcome.interrupted {
        text.append(format!(
            "\nInterrupted: {} of {} cases are done. The same command continues with the others.",
            outcome.records.len(),
            plan.cases().len()
        ));
    }
    text
}

/// One line per case: frequency, or at one frequency what axes vary, loss with its error, phase, cycles, status; an absent value is a
/// dash. A sweep of several frequencies and another axis has one line per value of that instead: its cases are too many to be read.
fn table(plan: &SweepPlan, outcome: &Outcome) -> Text {
    match &plan.axes {
        Some(axes) if plan.angular_frequencies_rad_per_s.len() > 1 => {
            conditions(plan, axes, outcome)
        }
        Some(axes) => cases(&axes_head(axes), &outcome.records, |record| {
            axes_values(axes, &record.varied)
        }),
        None => {
            let unit = plan.figures.frequency_unit;
            cases(&frequency_head(unit), &outcome.records, |record| {
                four_digits(unit.of(record.angular_frequency_rad_per_s))
            })
        }
    }
}

/// What axes vary: `temperature, radius`, and values of it: `25 °C, 1 mm`.
fn axes_head(axes: &Axes) -> String {
    let names: Vec<String> = axes.over.iter().map(Varied::name).collect();
    names.join(", ")
}

fn axes_values(axes: &Axes, values: &AxisValues) -> String {
    let values = axes.over.iter().zip(values.all());
    let values = values.map(|(varied, value)| Units::default().varied_value(varied, *value));
    values.collect::<Vec<_>>().join(", ")
}

/// The head of a column of frequencies: `ω / rad/s`.
fn frequency_head(unit: FrequencyUnit) -> String {
    format!("{} / {}", unit.symbol(), unit.name())
}

fn cases(head: &str, records: &[CaseRecord], first: impl Fn(&CaseRecord) -> String) -> Text {
    let has_material_error = (records.iter()).any(|r| r.energy_loss_material_error_j().is_some());
    // Both would make the lines too long.
    let fourth = match has_material_error {
        true => Column::right("material", 8),
        false => Column::right("cycles", 6).leaves_first(),
    };
    let columns = [
        Column::right(head, 10),
        Column::left("loss / cycle", 23),
        Column::right("phase / deg", 11),
        fourth,
        Column::left("status", 0).stays(),
    ];
    let mut table = Table::new(3, columns);
    for record in records {
        let phase = record.result.as_ref().map(|r| r.analysis.phase_lag_rad);
        table.row([
            first(record),
            loss(record.energy_loss_j(), record.energy_loss_error_j()),
            or_dash(phase.map(|rad| format!("{:.4}", rad.to_degrees()))),
            match has_material_error {
                true => or_dash(material_error(record)),
                false => record.cycles.to_string(),
            },
            record.status.name().to_owned(),
        ]);
    }
    let mut text = Text::from(table);
    if has_material_error {
        text.line("Beside the loss: numerical error; material: 95 % from the noise of its data.");
    }
    text
}

fn or_dash(text: Option<String>) -> String {
    text.unwrap_or_else(|| "-".to_owned())
}

/// The uncertainty of a loss that comes from the material, relative: `± 4.2 %`.
fn material_error(record: &CaseRecord) -> Option<String> {
    let loss_j = record.energy_loss_j()?;
    let error_j = record.energy_loss_material_error_j()?;
    (loss_j != 0.0).then(|| format!("± {:.1} %", 100.0 * (error_j / loss_j).abs()))
}

/// Each value of the second axis with its highest peak.
fn conditions(plan: &SweepPlan, axes: &Axes, outcome: &Outcome) -> Text {
    let unit = plan.figures.frequency_unit;
    let curves = figure::curve::curves(plan, outcome, &Units::default());
    let columns = [
        Column::right(axes_head(axes), 10),
        Column::right("converged", 9).stays(),
        Column::left(" loss / cycle, peak", 23),
        Column::right(frequency_head(unit), 12),
    ];
    let mut table = Table::new(3, columns);
    for curve in &curves {
        let peak = outcome.highest_peak(&curve.condition);
        let error_j = peak.and_then(|p| p.energy_loss_error_j);
        let at = peak.map(|p| four_digits(unit.of(p.angular_frequency_rad_per_s)));
        table.row([
            axes_values(axes, &curve.condition.values),
            format!("{} of {}", curve.results().len(), curve.records.len()),
            loss(peak.map(|p| p.energy_loss_j), error_j),
            or_dash(at),
        ]);
    }
    table.into()
}

/// A loss with its error, as two columns to be read together: `3.5090 µJ ± 0.0003`.
fn loss(loss_j: Option<f64>, error_j: Option<f64>) -> String {
    let energy = Dimension::Energy;
    match loss_j.and_then(|loss_j| Measured::new(loss_j, error_j, energy)) {
        Some(measured) => {
            let tens = measured.tens();
            let value = format!("{}{tens} {}", measured.value, measured.unit);
            let error = measured.error + &tens;
            format!("{value:>12} ± {error:<8}")
        }
        None => {
            let value = loss_j.map(|loss_j| format_human(loss_j, energy, 4));
            format!("{:>12}{:11}", value.as_deref().unwrap_or("-"), "")
        }
    }
}

/// Peaks, largest first; where there are none, why. Of a sweep of two axes the largest alone: each curve has its own.
pub fn peaks(plan: &SweepPlan, outcome: &Outcome) -> Text {
    let mut text = Text::default();
    for peak in peaks::shown(plan, outcome) {
        text.paragraph(format!("{}: {}", peak.name(), peak.sentence()));
    }
    for problem in &outcome.peak_problems {
        text.paragraph(format!("Peak not located: {problem}"));
    }
    if text.is_empty() && !outcome.interrupted {
        text.line(peaks::none(plan, outcome));
    }
    text
}

/// What the cases of the table cost, coarser resolutions too.
pub fn work(outcome: &Outcome) -> String {
    let mut work = Work::default();
    for record in &outcome.records {
        work += record.work;
    }
    let instants = work.instants;
    let iterations = work.iterations as f64 / instants.max(1) as f64;
    let each = work.convolutions_per_instant().unwrap_or_default();
    let convolutions = match work.convolutions {
        0 => String::new(),
        _ => format!(", {each:.1} convolutions an instant"),
    };
    format!("Work: {instants} instants, {iterations:.1} iterations an instant{convolutions}")
}

/// Cases without a result, with the reason.
pub fn problems(plan: &SweepPlan, outcome: &Outcome) -> Text {
    without_result(plan.figures.frequency_unit, outcome).collect()
}

/// What lies outside the model, or was not estimated: one line for each kind, whatever the number of cases.
fn warnings_of_sweep(plan: &SweepPlan, outcome: &Outcome) -> Text {
    let unit = plan.figures.frequency_unit;
    let mut text = warned(warnings::over_cases(&outcome.records, unit));
    if let Some(note) = rigid_indenter::note(plan, outcome) {
        text.paragraph(format!("note: {note}"));
    }
    text
}

/// Warnings, one after another.
pub fn warned(warnings: impl IntoIterator<Item = impl Display>) -> Text {
    let lines = warnings.into_iter();
    lines.map(|warning| format!("warning: {warning}")).collect()
}

/// What a shard has done that is not the last of its sweep.
#[derive(Debug, Clone, Copy)]
pub struct ShardDone {
    pub shard: Shard,
    /// Cases that are done, of so many of the shard.
    pub done: usize,
    pub own: usize,
    /// Cases of all shards that are missing.
    pub missing: usize,
    pub interrupted: bool,
}

impl ShardDone {
    /// As one object.
    pub fn to_json(&self) -> Value {
        json!({
            "shard": self.shard.to_string(),
            "cases_done": self.done,
            "cases_of_shard": self.own,
            "cases_missing": self.missing,
            "interrupted": self.interrupted,
        })
    }

    /// To be read; its records are in this folder.
    pub fn text(&self, folder: &Path) -> String {
        let Self {
            shard,
            done,
            own,
            missing,
            interrupted,
        } = self;
        let next = match interrupted {
            true => "Interrupted: the same command goes on from here.".to_owned(),
            false => format!(
                "{missing} cases of the other shards are missing in this folder. The process that ends last locates the peaks and \
                 draws the\nfigures; where the shards have folders of their own, `contact-dma merge` does."
            ),
        };
        let folder = folder.display();
        format!("Shard {shard}: {done} of {own} cases are done. {next}\n\nRecords in {folder}")
    }
}

/// The cases that are in none of the parts of a sweep, and that those that are there are in this folder.
pub fn lacking(missing: &[Case], of: usize, folder: &Path) -> String {
    /// Cases named before the rest is counted.
    const NAMED: usize = 10;
    let mut text = format!(
        "{} of {of} cases are in none of the parts:\n",
        missing.len()
    );
    for case in missing.iter().take(NAMED) {
        let Condition { values, drive, .. } = &case.condition;
        let values = values.all().iter();
        let value: String = values
            .map(|value| format!("axis {}, ", value.as_number()))
            .collect();
        text.push_str(&format!(
            "  case {}: ω = {:e} rad/s ({value}mean {}, amplitude {})\n",
            case.index,
            case.angular_frequency_rad_per_s,
            drive.mean(),
            drive.amplitude()
        ));
    }
    if missing.len() > NAMED {
        text.push_str(&format!("  and {} more\n", missing.len() - NAMED));
    }
    text.push_str(&format!(
        "What there is has been copied to {}: merge again with the rest, or run the sweep there",
        folder.display()
    ));
    text
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
        // Where no prefix reaches, the power of ten is that of both.
        assert_eq!(joule(5.1442e-40, Some(2.8e-43)), "5.144e-40 J ± 0.003e-40");
    }
}
