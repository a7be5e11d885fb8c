//! The page of an identified material: what was found and how well, the figures, the block.

use maud::{Markup, html};

use super::question::list;
use super::{Pictures, force_curve, plain, scroll};
use crate::quantity::format_human;
use crate::report::ReportError;
use crate::report::figure::Figure;
use crate::report::identify::{IdentifyReport, dimension};
use crate::report::laws::named;
use crate::report::number::{digits, scientific};

/// The page; the pictures of the figures have gone by, `block` is the `[material]` block.
///
/// # Errors
/// [`ReportError`] naming the part that could not be made.
pub fn page(
    report: &IdentifyReport<'_>,
    figures: &[Figure],
    block: &str,
    pictures: &Pictures,
) -> Result<String, ReportError> {
    let content = html! {
        (list(report.lines()))
        @if let Some(law) = report.found.law() {
            h3 { "Parameters" }
            (scroll("Parameters", force_curve::parameters(&named(law))))
        } @else {
            h3 { "Moduli and times" }
            (scroll("Moduli and times", unknowns(report)))
        }
        (pictures.whole(figures))
        @if let Some(laws) = &report.found.laws {
            h3 { "Laws" }
            (scroll("Laws", force_curve::laws(laws)))
        }
        h3 { "Number of branches" }
        (scroll("Numbers of branches", candidates(report)))
        @if report.found.law().is_none() {
            h3 { "Correlations" }
            (scroll("Correlations", correlations(report)))
        }
    };
    let asked = match report.plan.measurements.is_history() {
        true => "which solid has this history",
        false => "which solid has these cycles",
    };
    let title = (&report.plan.title[..], asked.to_owned());
    let input = plain::found_material(block);
    plain::page("identify", title, ("The material", content), input)
}

fn unknowns(report: &IdentifyReport<'_>) -> Markup {
    let rows = report.found.unknowns.iter().map(|unknown| {
        let value = |value: f64| format_human(value, dimension(unknown), 4);
        let determined = if unknown.is_determined { "yes" } else { "no" };
        vec![
            unknown.name.clone(),
            value(unknown.value),
            value(unknown.value / unknown.factor),
            value(unknown.value * unknown.factor),
            determined.to_owned(),
        ]
    });
    plain::table(&["", "value", "95 % from", "to", "determined"], rows)
}

fn candidates(report: &IdentifyReport<'_>) -> Markup {
    let chosen = report.found.relaxation.branches().len();
    let rows = report.found.candidates.iter().map(|c| {
        let what = match c.branches == chosen {
            true => "chosen",
            false if c.has_close_times => "two times are one",
            false => "",
        };
        vec![
            c.branches.to_string(),
            scientific(c.chi_squared, 3),
            digits(Some(c.akaike).filter(|a| a.is_finite()), 3),
            digits(Some(c.schwarz).filter(|s| s.is_finite()), 3),
            scientific(c.weight, 2),
            what.to_owned(),
        ]
    });
    let headings = ["branches", "χ²", "Akaike", "Schwarz", "weight", ""];
    plain::table(&headings, rows)
}

fn correlations(report: &IdentifyReport<'_>) -> Markup {
    let unknowns = report.found.unknowns.iter();
    let names = unknowns.map(|unknown| unknown.name.as_str());
    let rows = names.clone().zip(&report.found.correlations);
    let rows = rows.map(|(name, row)| {
        let values = row.iter().map(|value| format!("{value:.2}"));
        [name.to_owned()].into_iter().chain(values).collect()
    });
    let headings: Vec<&str> = [""].into_iter().chain(names.clone()).collect();
    plain::table::<String>(&headings, rows)
}
