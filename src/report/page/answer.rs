//! The answer in words: peaks with their uncertainty, and the cases that have none.

use maud::{Markup, html};

use super::question::list;
use crate::quantity::Dimension;
use crate::report::number::{plain, with_error};
use crate::report::terminal;
use crate::sweep::plan::SweepPlan;
use crate::sweep::plan::resolved::drive_dimension;
use crate::sweep::search::run::Outcome;

/// Peaks as a list, largest first; where there are none, why.
pub(super) fn peaks(plan: &SweepPlan, outcome: &Outcome) -> Markup {
    if outcome.peaks.is_empty() {
        let why = terminal::peaks(plan, outcome);
        return html! { p class="peaks" { (why.trim()) } };
    }
    let lines = outcome.peaks.iter().enumerate().map(|(rank, peak)| {
        let what = if rank == 0 { "Peak" } else { "Lower peak" };
        let loss = with_error(
            peak.energy_loss_j,
            peak.energy_loss_error_j,
            Dimension::Energy,
        );
        let omega = with_error(
            peak.angular_frequency_rad_per_s,
            Some(peak.angular_frequency_uncertainty_rad_per_s),
            Dimension::AngularFrequency,
        );
        let varied = plan.axis.as_ref().and_then(|axis| {
            use crate::sweep::plan::Varied;
            let value = match axis.varied {
                Varied::Amplitude => peak.drive_amplitude,
                Varied::Mean => peak.drive_mean,
            }?;
            let value = plain(value, drive_dimension(plan.drive.control()), 4);
            Some(format!(", {} {value}", axis.varied.name()))
        });
        html! {
            li { (what) ": " strong { (loss) } " per cycle at ω = " strong { (omega) } (varied.unwrap_or_default()) }
        }
    });
    html! { ul class="peaks" { @for line in lines { (line) } } }
}

/// Warnings as a list; nothing where there are none.
pub(super) fn warned(warnings: impl IntoIterator<Item = impl std::fmt::Display>) -> Markup {
    let lines: Vec<String> = warnings.into_iter().map(|w| w.to_string()).collect();
    html! {
        @if !lines.is_empty() {
            div class="warnings" { p { "To be kept in mind:" } (list(&lines)) }
        }
    }
}

/// What has no result or could not be located, each with its reason; nothing where there is no such thing.
pub(super) fn problems(outcome: &Outcome) -> Markup {
    let cases = outcome.records.iter().filter(|r| r.result.is_none());
    let cases = cases.map(|r| {
        format!(
            "ω = {} rad/s: {}: {}",
            terminal::frequency(r.angular_frequency_rad_per_s),
            r.status.name(),
            r.message.as_deref().unwrap_or("no reason recorded")
        )
    });
    let peaks = outcome.peak_problems.iter();
    let lines: Vec<String> = cases
        .chain(peaks.map(|why| format!("A peak was not located: {why}")))
        .chain(outcome.interrupted.then(|| {
            "The sweep was interrupted: the cases that are missing here were not computed."
                .to_owned()
        }))
        .collect();
    html! {
        @if !lines.is_empty() {
            div class="problems" { p { "Without a result, and so not drawn:" } (list(&lines)) }
        }
    }
}
