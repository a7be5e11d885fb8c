//! The page of a material made of dynamic data: what was read, the figures, the shift factors, the block.

use maud::{Markup, html};

use super::Pictures;
use super::frame::{Frame, Input, InputFile};
use super::html::json_for_script;
use super::plain::{Data, SCRIPT, shown};
use super::question::list;
use crate::material::dynamic::master_curve::MasterCurve;
use crate::quantity::celsius;
use crate::report::ReportError;
use crate::report::dynamic::DynamicReport;
use crate::report::figure::Figure;
use crate::report::number::digits;
use crate::report::words::listed;
use crate::sweep::plan::resolved;

/// The page; the pictures of the figures have gone by, `block` is the `[material]` block.
///
/// # Errors
/// [`ReportError`] naming the part that could not be made.
pub fn page(
    report: &DynamicReport<'_>,
    figures: &[Figure],
    block: &str,
    pictures: &Pictures,
) -> Result<String, ReportError> {
    let main = html! {
        section aria-labelledby="answer" class="answer" {
            h2 id="answer" { "The material" }
            (list(&report.lines()))
            @for figure in figures { (shown(figure, pictures)) }
            @if let Some(master) = &report.made.master {
                h3 { "Shift factors" }
                (shifts(master))
            }
        }
    };
    let at = match report.reference_temperature_k() {
        Some(temperature_k) => format!(" at {}", celsius(temperature_k)),
        None => String::new(),
    };
    let frame = Frame {
        title: &format!("Fit to {}", listed(&report.source.files)),
        asked: format!("a series{at} from storage and loss modulus over frequency"),
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
        data: json_for_script(&Data { kind: "dynamic" })?,
    };
    Ok(frame.page())
}

/// A dash stands for an error that is not known.
fn shifts(master: &MasterCurve) -> Markup {
    html! {
        table {
            thead { tr { th { "T" } th { "log₁₀ a_T" } th { "standard error" } } }
            tbody {
                @for shift in &master.shifts {
                    tr {
                        td { (celsius(shift.temperature_k)) }
                        td { (digits(Some(shift.log10_a_t), 5)) }
                        td { (digits(shift.log10_a_t_error, 2)) }
                    }
                }
            }
        }
    }
}
