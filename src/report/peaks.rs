//! The peaks of a sweep in words, for terminal, page and captions.

use super::number::{self, at_frequency, plain, with_error};
use crate::quantity::Dimension;
use crate::sweep::plan::{AxisValues, SweepPlan};
use crate::sweep::search::peak::Peak;
use crate::sweep::search::run::Outcome;

/// A peak in words.
pub struct PeakWords {
    pub is_largest: bool,
    /// `3.5090 ± 0.0003 µJ`.
    pub loss: String,
    pub symbol: char,
    /// `(8.440 ± 0.003) × 10⁻³ rad/s`.
    pub frequency: String,
    /// Where the data behind the material are noisy, how much of both errors is numerical: `; of these errors ± 0.2 nJ and ± 10⁻⁶ rad/s
    /// are numerical, the rest is that of the material`.
    pub material: String,
    /// Of several curves which: `, amplitude 5 N`.
    pub under: String,
    /// Of the largest, how many of other curves are as large: `; those of 5 other curves are equal to it within their errors`.
    equals: String,
}

impl PeakWords {
    /// What it is among the peaks.
    pub fn name(&self) -> &'static str {
        match self.is_largest {
            true => "Peak",
            false => "Lower peak",
        }
    }

    /// `3.5090 ± 0.0003 µJ at ω = (8.440 ± 0.003) × 10⁻³ rad/s, amplitude 5 N`.
    pub fn sentence(&self) -> String {
        let (loss, symbol, frequency) = (&self.loss, self.symbol, &self.frequency);
        format!("{loss} at {symbol} = {frequency}{}", self.circumstances())
    }

    /// What follows the numbers: which curve it is, what its errors are made of, and which others are as high.
    pub fn circumstances(&self) -> String {
        format!("{}{}{}", self.under, self.material, self.equals)
    }
}

/// Peaks that are listed; of many curves there are too many to be read.
const SHOWN: usize = 20;

/// The highest peaks, the largest first.
pub fn all(plan: &SweepPlan, outcome: &Outcome) -> Vec<PeakWords> {
    let unit = plan.figures.frequency_unit;
    let words = |(rank, peak): (usize, &Peak)| PeakWords {
        is_largest: rank == 0,
        loss: with_error(
            peak.energy_loss_j,
            with_material(peak.energy_loss_error_j, peak.energy_loss_material_error_j),
            Dimension::Energy,
        ),
        symbol: unit.symbol(),
        frequency: with_error(
            unit.of(peak.angular_frequency_rad_per_s),
            with_material(
                Some(peak.angular_frequency_uncertainty_rad_per_s),
                peak.angular_frequency_material_error_rad_per_s,
            )
            .map(|error| unit.of(error)),
            unit.dimension(),
        ),
        under: under(plan, &peak.varied),
        material: of_material(plan, peak).unwrap_or_default(),
        equals: match rank {
            0 => equals(&outcome.peaks),
            _ => String::new(),
        },
    };
    let peaks = outcome.peaks.iter().take(SHOWN);
    peaks.enumerate().map(words).collect()
}

/// Where the peaks are that [`all`] leaves out; nothing where there are none.
pub fn rest(outcome: &Outcome) -> Option<String> {
    let rest = outcome.peaks.len().saturating_sub(SHOWN);
    (rest > 0).then(|| format!("{rest} lower peaks more are in summary.json."))
}

/// The numerical error and that of the material together.
fn with_material(numerical: Option<f64>, material: Option<f64>) -> Option<f64> {
    match (numerical, material) {
        (None, None) => None,
        (numerical, material) => Some(numerical.unwrap_or(0.0) + material.unwrap_or(0.0)),
    }
}

fn of_material(plan: &SweepPlan, peak: &Peak) -> Option<String> {
    let unit = plan.figures.frequency_unit;
    peak.energy_loss_material_error_j?;
    let loss = plain(peak.energy_loss_error_j?, Dimension::Energy, 1);
    let omega = peak.angular_frequency_uncertainty_rad_per_s;
    let frequency = plain(unit.of(omega), unit.dimension(), 1);
    Some(format!(
        "; of these errors ± {loss} and ± {frequency} are numerical, the rest is that of the material"
    ))
}

/// The error of the material moves all curves of it together, and tells none of them from another.
fn equals(peaks: &[Peak]) -> String {
    let Some((largest, others)) = peaks.split_first() else {
        return String::new();
    };
    let error_j = |peak: &Peak| peak.energy_loss_error_j.unwrap_or(0.0);
    let is_equal = |peak: &&Peak| {
        peak.varied != largest.varied
            && (largest.energy_loss_j - peak.energy_loss_j).abs()
                <= error_j(largest) + error_j(peak)
    };
    match others.iter().filter(is_equal).count() {
        0 => String::new(),
        1 => "; that of another curve is equal to it within their errors".to_owned(),
        many => format!("; those of {many} other curves are equal to it within their errors"),
    }
}

/// `, temperature 25 °C`: what axes vary of it; nothing where there are none.
fn under(plan: &SweepPlan, values: &AxisValues) -> String {
    let over = plan.axes.as_ref().map_or(&[][..], |axes| &axes.over);
    let words = over.iter().zip(values.all()).map(|(varied, value)| {
        let value = number::varied(varied, *value);
        format!(", {} {value}", varied.name())
    });
    words.collect()
}

/// The same; of a sweep of two axes the largest alone: each curve has its own.
pub fn shown(plan: &SweepPlan, outcome: &Outcome) -> Vec<PeakWords> {
    let mut peaks = all(plan, outcome);
    if plan.axes.is_some() {
        peaks.truncate(1);
    }
    peaks
}

/// Why there is no peak; of cases at one frequency, which one loses the most.
pub fn none(plan: &SweepPlan, outcome: &Outcome) -> String {
    // An attracted contact does not tell its branches.
    let tells_branches = plan.cycle.at_cycle.is_none() && !plan.is_attracted();
    let is_elastic = tells_branches && outcome.branches() == 0;
    let frequencies = plan.angular_frequencies_rad_per_s.len();
    let why = if !outcome.records.iter().any(|r| r.status.has_result()) {
        "No peak: no case converged."
    } else if is_elastic {
        "No peak: the material has no branches; an elastic body loses nothing."
    } else if let (1, Some(most)) = (frequencies, largest_case(plan, outcome)) {
        return most;
    } else if frequencies < 3 {
        "No peak: it takes at least three frequencies to enclose one."
    } else {
        "No peak inside the sweep: the loss is largest at one of its ends. Widen the sweep."
    };
    why.to_owned()
}

/// The case of the largest loss, among several that differ in something else than the frequency.
fn largest_case(plan: &SweepPlan, outcome: &Outcome) -> Option<String> {
    plan.axes.as_ref()?;
    let losses = outcome.records.iter();
    let losses = losses.filter_map(|record| Some((record, record.energy_loss_j()?)));
    let (record, loss_j) = losses.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let error_j = with_material(
        record.energy_loss_error_j(),
        record.energy_loss_material_error_j(),
    );
    let (unit, omega) = (
        plan.figures.frequency_unit,
        record.angular_frequency_rad_per_s,
    );
    Some(format!(
        "Largest loss: {} at {}{}",
        with_error(loss_j, error_j, Dimension::Energy),
        at_frequency(unit, omega, 4),
        under(plan, &record.varied)
    ))
}
