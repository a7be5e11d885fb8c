//! The answer in words: peaks with their uncertainty, and the cases that have none.

use std::fmt::Write;

use super::html::escaped;
use crate::report::number::with_error;
use crate::report::peaks;
use crate::report::words::without_result;
use crate::sweep::plan::SweepPlan;
use crate::sweep::search::run::Outcome;

/// Peaks as a list, largest first; where there are none, why.
pub(super) fn peaks(plan: &SweepPlan, outcome: &Outcome) -> String {
    if outcome.peaks.is_empty() {
        let problems = outcome.peak_problems.iter();
        let problems = problems.map(|problem| format!("Peak not located: {problem}"));
        let mut why: Vec<String> = problems.collect();
        if why.is_empty() && !outcome.interrupted {
            why.push(peaks::none(plan, outcome).to_owned());
        }
        return format!("<p class=\"peaks\">{}</p>", escaped(&why.join("\n")));
    }
    let mut html = String::from("<ul class=\"peaks\">\n");
    for peak in peaks::all(plan, outcome, with_error) {
        let what = if peak.is_largest {
            "Peak"
        } else {
            "Lower peak"
        };
        // Writing to a String cannot fail.
        let _ = writeln!(
            html,
            "<li>{what}: <strong>{}</strong> per cycle at {} = <strong>{}</strong>{}</li>",
            escaped(&peak.loss),
            peak.symbol,
            escaped(&peak.frequency),
            escaped(&peak.under)
        );
    }
    html.push_str("</ul>");
    html
}

/// Warnings as a list; nothing where there are none.
pub(super) fn warned(warnings: impl IntoIterator<Item = impl std::fmt::Display>) -> String {
    let lines = warnings.into_iter();
    let lines: String = lines
        .map(|warning| format!("<li>{}</li>\n", escaped(&warning.to_string())))
        .collect();
    if lines.is_empty() {
        return String::new();
    }
    format!("<div class=\"warnings\">\n<p>To be kept in mind:</p>\n<ul>\n{lines}</ul>\n</div>")
}

/// What has no result or could not be located, each with its reason; nothing where there is no such thing.
pub(super) fn problems(plan: &SweepPlan, outcome: &Outcome) -> String {
    let cases = without_result(plan.figures.frequency_unit, outcome);
    let peaks = outcome.peak_problems.iter();
    let lines: Vec<String> = cases
        .chain(peaks.map(|why| format!("A peak was not located: {why}")))
        .chain(outcome.interrupted.then(|| {
            "The sweep was interrupted: the cases that are missing here were not computed."
                .to_owned()
        }))
        .map(|line| format!("<li>{}</li>\n", escaped(&line)))
        .collect();
    if lines.is_empty() {
        return String::new();
    }
    format!(
        "<div class=\"problems\">\n<p>Without a result, and so not drawn:</p>\n<ul>\n{}</ul>\n</div>",
        lines.concat()
    )
}
