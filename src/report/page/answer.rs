//! The answer in words: peaks with their uncertainty, and the cases that have none.

use maud::{Markup, html};

use super::question::list;
use crate::report::peaks;
use crate::report::words::without_result;
use crate::sweep::plan::SweepPlan;
use crate::sweep::search::run::Outcome;

/// Peaks as a list, largest first; where there are none, why.
pub(super) fn peaks(plan: &SweepPlan, outcome: &Outcome) -> Markup {
    if outcome.peaks.is_empty() {
        let problems = outcome.peak_problems.iter();
        let problems = problems.map(|problem| format!("Peak not located: {problem}"));
        let mut why: Vec<String> = problems.collect();
        if why.is_empty() && !outcome.interrupted {
            why.push(peaks::none(plan, outcome));
        }
        return html! { p class="peaks" { (why.join("\n")) } };
    }
    html! {
        ul class="peaks" {
            @for peak in peaks::all(plan, outcome) {
                li {
                    (peak.name()) ": "
                    strong { (peak.loss) } " per cycle at " (peak.symbol) " = " strong { (peak.frequency) } (peak.circumstances())
                }
            }
            @if let Some(rest) = peaks::rest(outcome) { li { (rest) } }
        }
    }
}

/// Lines under a title; nothing where there are none.
fn told(class: &str, title: &str, lines: impl Iterator<Item = String>) -> Markup {
    let mut lines = lines.peekable();
    html! {
        @if lines.peek().is_some() {
            div class=(class) { p { (title) } (list(lines)) }
        }
    }
}

/// Warnings as a list; nothing where there are none.
pub(super) fn warned(warnings: impl IntoIterator<Item = impl std::fmt::Display>) -> Markup {
    let lines = warnings.into_iter().map(|w| w.to_string());
    told("warnings", "To be kept in mind:", lines)
}

/// What has no result or could not be located, each with its reason; nothing where there is no such thing.
pub(super) fn problems(plan: &SweepPlan, outcome: &Outcome) -> Markup {
    let peaks = outcome.peak_problems.iter();
    let peaks = peaks.map(|why| format!("A peak was not located: {why}"));
    let interrupted = outcome.interrupted.then(|| {
        "The sweep was interrupted: the cases that are missing here were not computed.".to_owned()
    });
    let lines = without_result(plan.figures.frequency_unit, outcome);
    let lines = lines.chain(peaks).chain(interrupted);
    told("problems", "Without a result, and so not drawn:", lines)
}
