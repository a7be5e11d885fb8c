//! index.html: the figures with their claims in one page, in the frame that all pages have.

use maud::{Markup, PreEscaped, Render, html};

use super::claim::{COLUMNS, rows};
use super::readme::EXPLANATION;
use super::statement::{self, Judged, counted, disagreeing};
use super::{Figure, ReproductionError, SCENARIOS, SWEEPS};
use crate::report::page::Pictures;
use crate::report::page::frame::{Frame, Input};
use crate::sweep::plan::resolved;

const SCRIPT: &str = include_str!("page.js");

/// The page, once the pictures are drawn, with the text of `claims.csv`.
pub(super) fn page(
    figures: &[Figure],
    pictures: &Pictures,
    claims: &[u8],
) -> Result<String, ReproductionError> {
    let main = html! {
        section aria-labelledby="answer" class="answer" {
            h2 id="answer" { "What agrees with the paper" }
            p class="peaks" { (counted(figures)) "." }
            (disagreements(figures))
            h3 { "Statement by statement" }
            (contents(figures))
        }
        section aria-labelledby="reading-heading" {
            h2 id="reading-heading" { "How to read the numbers" }
            (paragraphs(EXPLANATION))
            (controls())
        }
        @for figure in figures { (section(figure, pictures)) }
    };
    let files = SCENARIOS.iter().chain(&SWEEPS);
    let files: Vec<(String, &str)> = files
        .filter(|(name, _)| figures.iter().any(|f| name.starts_with(&f.name())))
        .map(|(name, text)| (format!("{name}.toml"), *text))
        .collect();
    let inputs: String = files.iter().map(|(_, text)| *text).collect();
    let frame = Frame {
        title: "The computed figures of Spinu 2018",
        asked: "Viscoelastic Contact Simulation under Harmonic Cyclic Load, Advances in Tribology 2018, 9432894: figure by \
                figure, by two engines"
            .to_owned(),
        main,
        input: Input {
            hashes: vec![("exactly these inputs", resolved::hash(&inputs))],
            files: files.iter().map(|(name, text)| (&name[..], *text)).collect(),
            text: "The scenario and sweep files behind these figures, which are built into the program: \
                   <code>contact-dma reproduce</code> gives this page again. Each also runs by itself, with \
                   <code>contact-dma simulate FILE</code> where it has segments and <code>contact-dma sweep FILE</code> where \
                   it has a sweep.",
        },
        script: &[SCRIPT],
    };
    let csv = String::from_utf8_lossy(claims);
    Ok(frame.page(&serde_json::json!({ "kind": "reproduction", "csv": csv }))?)
}

fn controls() -> Markup {
    let choices = [
        ("", "every number"),
        ("agrees", "what agrees"),
        ("disagrees", "what disagrees"),
        ("not stated", "what the paper does not state"),
    ];
    html! {
        div class="live controls" role="group" aria-label="Numbers shown" {
            label {
                "Show "
                select id="verdict" { @for (value, text) in choices { option value=(value) { (text) } } }
            }
            button type="button" id="copy" { "Copy all as CSV" }
            button type="button" id="download-csv" { "Download claims.csv" }
            span id="copied" role="status" {}
        }
    }
}

/// Nothing where everything agrees.
fn disagreements(figures: &[Figure]) -> Markup {
    let lines = disagreeing(figures);
    html! {
        @if !lines.is_empty() {
            div class="problems" {
                p { "What disagrees:" }
                ul { @for line in &lines { li { (readable(line)) } } }
            }
            @for text in figures.iter().filter_map(|figure| figure.discussion.as_deref()) { (paragraphs(text)) }
        }
    }
}

/// What the paper states, figure by figure.
fn contents(figures: &[Figure]) -> Markup {
    let [paper, kind, verdict] = Judged::COLUMNS;
    let rows = statement::all(figures).map(|(figure, one)| {
        let link = html! { a href={ "#" (figure.name()) } { "Figure " (figure.number) } };
        let cells = one.cells().map(readable);
        (None, [vec![link], cells.to_vec()].concat())
    });
    table("Statements", &["figure", paper, kind, verdict], rows)
}

fn section(figure: &Figure, pictures: &Pictures) -> Markup {
    let (name, number) = (figure.name(), figure.number);
    let claims = figure.claims.iter().zip(rows(&figure.claims));
    let claims = claims.map(|(claim, cells)| {
        let cells = cells.iter().map(|cell| readable(cell)).collect();
        (Some(claim.judged().name()), cells)
    });
    html! {
        section aria-labelledby=(name) class="reproduced" {
            h2 id=(name) { "Figure " (number) }
            figure class="scroll" tabindex="0" aria-label={ "Figure " (number) ", may be scrolled" } {
                @if let Some(picture) = pictures.inline(&name) { (picture) }
            }
            p { (readable(&figure.caption)) }
            (table(&format!("Numbers of figure {number}"), &COLUMNS.map(|(column, _)| column), claims))
        }
    }
}

/// A table with the verdicts of its rows, by which they are chosen, where there are any. Columns of words stand on the left.
fn table(
    what: &str,
    headings: &[&str],
    rows: impl Iterator<Item = (Option<&'static str>, Vec<Markup>)>,
) -> Markup {
    let class = |place: usize| match headings[place] {
        "the paper" | "the paper states" | "note" => Some("text wide"),
        "figure" | "quantity" | "kind" | "verdict" => Some("text"),
        _ => None,
    };
    html! {
        section class="scroll" tabindex="0" aria-label={ (what) ", may be scrolled" } {
            table class="claims" {
                thead { tr { @for (k, heading) in headings.iter().enumerate() { th scope="col" class=[class(k)] { (heading) } } } }
                tbody {
                    @for (verdict, cells) in rows {
                        tr data-verdict=[verdict] {
                            @for (k, cell) in cells.iter().enumerate() {
                                @if k == 0 { th scope="row" { (cell) } } @else { td class=[class(k)] { (cell) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Paragraphs parted by empty lines, with `**` and `*` as in README.md.
fn paragraphs(text: &str) -> Markup {
    let marked = |text: &str| {
        let strong = emphasised(&readable(text).into_string(), "**", "strong");
        PreEscaped(emphasised(&strong, "*", "em"))
    };
    html! { @for text in text.trim().split("\n\n") { p { (marked(text)) } } }
}

/// Escaped, and the indices of quantities set as such.
fn readable(text: &str) -> Markup {
    let escaped = text.render().into_string();
    let set = |text: String, index: &str| {
        text.replace(&format!("_{index}"), &format!("<sub>{index}</sub>"))
    };
    PreEscaped(["H", "K", "A"].into_iter().fold(escaped, set))
}

/// What stands between each pair of `mark` within an element of that name.
fn emphasised(text: &str, mark: &str, element: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for (place, part) in text.split(mark).enumerate() {
        match place % 2 {
            0 => html.push_str(part),
            _ => html.push_str(&format!("<{element}>{part}</{element}>")),
        }
    }
    html
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_become_elements_and_the_rest_is_escaped() {
        assert_eq!(
            paragraphs("**Units** are *a* < b,\nand\n\nmore\n").into_string(),
            "<p><strong>Units</strong> are <em>a</em> &lt; b,\nand</p><p>more</p>"
        );
        assert_eq!(
            readable("a_H²/R, δ_H, energy_loss_j").into_string(),
            "a<sub>H</sub>²/R, δ<sub>H</sub>, energy_loss_j"
        );
    }
}
