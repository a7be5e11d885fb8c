//! What a sweep prints at its end: the table, the peaks, and what went wrong. At most 80 columns.

use std::fmt::Write;

use crate::quantity::{Dimension, format_human};
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::{CaseRecord, Status};
use crate::sweep::run::Outcome;

/// One line per case: frequency, loss, phase, cycles, status; an absent value is a dash.
pub fn table(records: &[CaseRecord]) -> String {
    let mut text = String::from(" ω / rad/s   loss / cycle   phase / deg   cycles   status\n");
    for record in records {
        let analysis = record.result.as_ref().map(|r| &r.analysis);
        let loss = analysis.map(|a| format_human(a.energy_loss_j, Dimension::Energy, 4));
        let phase = analysis.map(|a| format!("{:.4}", a.phase_lag_rad.to_degrees()));
        let dash = || "-".to_owned();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:>10}   {:>12}   {:>11}   {:>6}   {}",
            frequency(record.angular_frequency_rad_per_s),
            loss.unwrap_or_else(dash),
            phase.unwrap_or_else(dash),
            record.cycles,
            record.status.name()
        );
    }
    text
}

/// Peaks, largest first; where there are none, why.
pub fn peaks(plan: &SweepPlan, outcome: &Outcome) -> String {
    let mut text = String::new();
    for (rank, peak) in outcome.peaks.iter().enumerate() {
        let what = if rank == 0 { "Peak" } else { "Lower peak" };
        let _ = writeln!(
            text,
            "{what}: {} at ω = {}",
            format_human(peak.energy_loss_j, Dimension::Energy, 4),
            format_human(
                peak.angular_frequency_rad_per_s,
                Dimension::AngularFrequency,
                4
            )
        );
    }
    for problem in &outcome.peak_problems {
        let _ = writeln!(text, "Peak not located: {problem}");
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
    } else if plan.angular_frequencies_rad_per_s.len() < 3 {
        "No peak: it takes at least three frequencies to enclose one.\n"
    } else {
        "No peak inside the sweep: the loss is largest at one of its ends. Widen the sweep.\n"
    }
}

/// Cases without a result, with the reason.
pub fn problems(outcome: &Outcome) -> String {
    let mut text = String::new();
    for record in outcome.records.iter().filter(|r| r.result.is_none()) {
        let _ = writeln!(
            text,
            "ω = {} rad/s: {}: {}",
            frequency(record.angular_frequency_rad_per_s),
            record.status.name(),
            record.message.as_deref().unwrap_or("no reason recorded")
        );
    }
    text
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
