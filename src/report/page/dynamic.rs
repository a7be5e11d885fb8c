//! The page of a material made of dynamic data: what was read, the figures, the shift factors, the block.

use maud::{Markup, html};

use super::Pictures;
use super::plain;
use super::question::list;
use crate::material::dynamic::master_curve::MasterCurve;
use crate::quantity::celsius;
use crate::report::ReportError;
use crate::report::dynamic::DynamicReport;
use crate::report::figure::Figure;
use crate::report::number::digits;
use crate::report::words::listed;

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
    let content = html! {
        (list(report.lines()))
        (pictures.whole(figures))
        @if let Some(master) = &report.made.master { h3 { "Shift factors" } (shifts(master)) }
    };
    let at = report.reference_temperature_k();
    let at = at.map_or(String::new(), |t_k| format!(" at {}", celsius(t_k)));
    let title = format!("Fit to {}", listed(&report.source.files));
    let asked = format!("a series{at} from storage and loss modulus over frequency");
    let input = plain::found_material(block);
    plain::page("dynamic", (&title, asked), ("The material", content), input)
}

/// A dash stands for an error that is not known.
fn shifts(master: &MasterCurve) -> Markup {
    let rows = master.shifts.iter().map(|shift| {
        vec![
            celsius(shift.temperature_k),
            digits(Some(shift.log10_a_t), 5),
            digits(shift.log10_a_t_error, 2),
        ]
    });
    plain::table(&["T", "log₁₀ a_T", "standard error"], rows)
}
