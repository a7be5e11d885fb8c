//! Pages on which nothing moves: the figures are the same with a script and without.

use maud::{Markup, Render, html};
use serde::Serialize;

use super::frame::{Frame, Input};
use crate::report::ReportError;
use crate::sweep::plan::resolved;

/// What the script knows.
#[derive(Serialize)]
struct Data {
    kind: &'static str,
}

/// The page of a result of this kind, with a title, what was asked, and one section under a heading.
pub(super) fn page(
    kind: &'static str,
    (title, asked): (&str, String),
    (heading, content): (&str, Markup),
    input: Input<'_>,
) -> Result<String, ReportError> {
    let frame = Frame {
        title,
        asked,
        main: html! {
            section aria-labelledby="answer" class="answer" { h2 id="answer" { (heading) } (content) }
        },
        input,
        script: &["function start() {}\n"],
    };
    frame.page(&Data { kind })
}

/// The material that was found, as a block of a sweep file.
pub(super) fn found_material(block: &str) -> Input<'_> {
    Input::of_file(
        ("exactly this material", resolved::hash(block)),
        ("material.toml", block),
        "The material as a block of a sweep file, every number exact.",
    )
}

/// A table with these headings.
pub(super) fn table<C: Render>(
    headings: &[&str],
    rows: impl IntoIterator<Item = Vec<C>>,
) -> Markup {
    html! {
        table {
            thead { tr { @for heading in headings { th { (heading) } } } }
            tbody { @for row in rows { tr { @for cell in row { td { (cell) } } } } }
        }
    }
}
