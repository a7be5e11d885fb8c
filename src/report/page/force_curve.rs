//! The page of laws that were found from force curves.

use maud::{Markup, html};

use super::frame::Input;
use super::question::list;
use super::{Pictures, plain, scroll};
use crate::force_curve::resolved::resolved_text;
use crate::identify::laws::Laws;
use crate::report::ReportError;
use crate::report::figure::Figure;
use crate::report::force_curve::CurvesReport;
use crate::report::laws::Named;
use crate::report::number::scientific;
use crate::sweep::plan::resolved::hash;

/// The page; the pictures of the figures have gone by, `block` is the `[material]` block, where there is one.
///
/// # Errors
/// [`ReportError`] naming the part that could not be made.
pub fn page(
    report: &CurvesReport<'_>,
    figures: &[Figure],
    block: Option<&str>,
    pictures: &Pictures,
) -> Result<String, ReportError> {
    let parameters = report.single().map(|found| parameters(&found.named()));
    let laws = report.single().map(|found| laws(&found.fit.laws));
    let content = html! {
        (list(report.lines()))
        @if let Some(parameters) = parameters {
            h3 { "Parameters" }
            (scroll("Parameters", parameters))
        }
        (pictures.whole(figures))
        @if let Some(laws) = laws {
            h3 { "Laws" }
            (scroll("Laws", laws))
        }
    };
    let title = (
        &report.plan.title[..],
        "which law has this force curve".to_owned(),
    );
    let resolved = resolved_text(report.plan);
    let input = match block {
        Some(block) => plain::found_material(block),
        None => Input::of_file(
            ("exactly these curves", hash(&resolved)),
            ("resolved.toml", &resolved),
            "What was asked for, every default written out.",
        ),
    };
    plain::page("identify", title, ("The law", content), input)
}

/// Numbers with their intervals.
pub(super) fn parameters(all: &[Named]) -> Markup {
    let rows = all.iter().map(|named| {
        let name = named.name.clone();
        [name].into_iter().chain(named.texts()).collect()
    });
    plain::table::<String>(&["", "value", "95 % from", "to"], rows)
}

/// Laws with their weights.
pub(super) fn laws(laws: &Laws) -> Markup {
    let rows = laws.all.iter().map(|law| {
        vec![
            law.form.in_words(),
            scientific(law.chi_squared, 3),
            scientific(law.schwarz, 4),
            scientific(law.weight, 2),
        ]
    });
    plain::table(&["law", "\u{3c7}\u{b2}", "Schwarz", "weight"], rows)
}
