//! The page of an identified material: what was found and how well, the figures, the block.

use maud::{Markup, html};

use super::Pictures;
use super::frame::{Frame, Input, InputFile};
use super::html::json_for_script;
use super::plain::{Data, SCRIPT, shown};
use super::question::list;
use crate::quantity::format_human;
use crate::report::ReportError;
use crate::report::figure::Figure;
use crate::report::identify::{IdentifyReport, dimension};
use crate::report::number::{digits, scientific};
use crate::sweep::plan::resolved;

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
    let main = html! {
        section aria-labelledby="answer" class="answer" {
            h2 id="answer" { "The material" }
            (list(&report.lines()))
            h3 { "Moduli and times" }
            section class="scroll" tabindex="0" aria-label="Moduli and times, may be scrolled" { (unknowns(report)) }
            @for figure in figures { (shown(figure, pictures)) }
            h3 { "Number of branches" }
            section class="scroll" tabindex="0" aria-label="Numbers of branches, may be scrolled" { (candidates(report)) }
            h3 { "Correlations" }
            section class="scroll" tabindex="0" aria-label="Correlations, may be scrolled" { (correlations(report)) }
        }
    };
    let title = &report.plan.title;
    let frame = Frame {
        title,
        asked: match report.plan.measurements.is_history() {
            true => "which solid has this history",
            false => "which solid has these cycles",
        }
        .to_owned(),
        main,
        input: Input {
            hashes: vec![("exactly this material", resolved::hash(block))],
            files: vec![InputFile {
                name: "material.toml",
                text: block,
            }],
            text: "The material as a block of a sweep file, every number exact.",
        },
        script: &[SCRIPT],
        data: json_for_script(&Data { kind: "identify" })?,
    };
    Ok(frame.page())
}

fn unknowns(report: &IdentifyReport<'_>) -> Markup {
    html! {
        table {
            thead { tr { th { "" } th { "value" } th { "95 % from" } th { "to" } th { "determined" } } }
            tbody {
                @for unknown in &report.found.unknowns {
                    @let value = |value: f64| format_human(value, dimension(unknown), 4);
                    tr {
                        td { (unknown.name) }
                        td { (value(unknown.value)) }
                        td { (value(unknown.value / unknown.factor)) }
                        td { (value(unknown.value * unknown.factor)) }
                        td { @if unknown.is_determined { "yes" } @else { "no" } }
                    }
                }
            }
        }
    }
}

fn candidates(report: &IdentifyReport<'_>) -> Markup {
    let chosen = report.found.relaxation.branches().len();
    html! {
        table {
            thead { tr {
                th { "branches" } th { "χ²" } th { "Akaike" } th { "Schwarz" } th { "weight" } th { "" }
            } }
            tbody {
                @for c in &report.found.candidates {
                    tr {
                        td { (c.branches) }
                        td { (scientific(c.chi_squared, 3)) }
                        td { (digits(Some(c.akaike).filter(|a| a.is_finite()), 3)) }
                        td { (digits(Some(c.schwarz).filter(|s| s.is_finite()), 3)) }
                        td { (scientific(c.weight, 2)) }
                        td {
                            @if c.branches == chosen { "chosen" }
                            @else if c.has_close_times { "two times are one" }
                        }
                    }
                }
            }
        }
    }
}

fn correlations(report: &IdentifyReport<'_>) -> Markup {
    let names: Vec<&str> = report
        .found
        .unknowns
        .iter()
        .map(|u| u.name.as_str())
        .collect();
    html! {
        table {
            thead { tr { th { "" } @for name in &names { th { (name) } } } }
            tbody {
                @for (name, row) in names.iter().zip(&report.found.correlations) {
                    tr { td { (name) } @for value in row { td { (format!("{value:.2}")) } } }
                }
            }
        }
    }
}
