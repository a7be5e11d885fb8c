//! index.html: the figures with their claims in one page, in the frame that all pages have.

use std::fmt::Write;

use serde::Serialize;

use super::claim::COLUMNS;
use super::statement::Count;
use super::wording::{self, EXPLANATION, FIGURE_13};
use super::{Claim, Figure, ReproductionError, SCENARIOS, SWEEPS};
use crate::report::page::Pictures;
use crate::report::page::frame::{Frame, Input, InputFile};
use crate::report::page::html::{escaped, filled, json_for_script};
use crate::sweep::plan::resolved;

const MAIN: &str = include_str!("page.html");
const SCRIPT: &str = include_str!("page.js");

/// What the script of the page knows.
#[derive(Serialize)]
struct Data<'a> {
    kind: &'static str,
    /// `claims.csv`.
    csv: &'a str,
}

/// The page, once the figures have gone by.
pub(super) fn page(
    figures: &[Figure],
    pictures: &Pictures,
    claims: &[u8],
) -> Result<String, ReproductionError> {
    let sections: String = figures
        .iter()
        .map(|figure| section(figure, pictures))
        .collect();
    let main = filled(
        MAIN,
        &[
            ("count", &escaped(&Count::of(figures).text())),
            ("disagreements", &disagreements(figures)),
            ("contents", &contents(figures)),
            ("explanation", &paragraphs(EXPLANATION)),
            ("figures", &sections),
        ],
    )?;
    let names: Vec<(String, &str)> = SCENARIOS
        .iter()
        .chain(&SWEEPS)
        .filter(|(name, _)| figures.iter().any(|f| name.starts_with(&f.name())))
        .map(|(name, text)| (format!("{name}.toml"), *text))
        .collect();
    let inputs: String = names.iter().map(|(_, text)| *text).collect();
    let data = Data {
        kind: "reproduction",
        csv: &String::from_utf8_lossy(claims),
    };
    let frame = Frame {
        title: "The computed figures of Spinu 2018",
        asked: "Viscoelastic Contact Simulation under Harmonic Cyclic Load, Advances in Tribology 2018, 9432894: figure by \
                figure, by two engines"
            .to_owned(),
        main,
        input: Input {
            hashes: vec![("exactly these inputs", resolved::hash(&inputs))],
            files: names
                .iter()
                .map(|(name, text)| InputFile { name, text })
                .collect(),
            text: "The scenario and sweep files behind these figures, which are built into the program: \
                   <code>contact-dma reproduce</code> gives this page again. Each also runs by itself, with \
                   <code>contact-dma simulate FILE</code> where it has segments and <code>contact-dma sweep FILE</code> where \
                   it has a sweep.",
        },
        data: json_for_script(&data)?,
        script: &[SCRIPT],
    };
    Ok(frame.page()?)
}

/// Nothing where everything agrees.
fn disagreements(figures: &[Figure]) -> String {
    let lines = wording::disagreeing(figures);
    if lines.is_empty() {
        return String::new();
    }
    let items: String = lines
        .iter()
        .map(|line| format!("<li>{}</li>\n", readable(line)))
        .collect();
    let more = match figures.iter().any(|figure| figure.number == 13) {
        true => paragraphs(FIGURE_13),
        false => String::new(),
    };
    format!("<div class=\"problems\">\n<p>What disagrees:</p>\n<ul>\n{items}</ul>\n</div>\n{more}")
}

/// What the paper states, figure by figure.
fn contents(figures: &[Figure]) -> String {
    let mut html = String::from(
        "<table class=\"claims\">\n<thead><tr><th scope=\"col\" class=\"text\">figure</th>\
         <th scope=\"col\" class=\"text\">the paper states</th><th scope=\"col\" class=\"text\">kind</th>\
         <th scope=\"col\" class=\"text\">verdict</th></tr></thead>\n<tbody>\n",
    );
    for figure in figures {
        let mut name = format!(
            "<a href=\"#{}\">Figure {}</a>",
            figure.name(),
            figure.number
        );
        for statement in &figure.statements {
            let kind = if statement.is_number {
                "number"
            } else {
                "words"
            };
            // Writing to a String cannot fail.
            let _ = writeln!(
                html,
                "<tr><th scope=\"row\">{name}</th><td class=\"text wide\">{}</td><td class=\"text\">{kind}</td>\
                 <td class=\"text\">{}</td></tr>",
                readable(&statement.paper),
                statement.verdict.name()
            );
            name = format!("Figure {}", figure.number);
        }
    }
    html.push_str("</tbody>\n</table>");
    html
}

fn section(figure: &Figure, pictures: &Pictures) -> String {
    let name = figure.name();
    let picture = pictures.inline(&name).unwrap_or_default();
    let above = std::iter::once(None).chain(figure.claims.iter().map(Some));
    let rows = figure.claims.iter().zip(above);
    let rows: String = rows.map(|(claim, above)| row(claim, above)).collect();
    let heads: String = COLUMNS
        .iter()
        .map(|column| format!("<th scope=\"col\"{}>{column}</th>", kind(column)))
        .collect();
    format!(
        "<section aria-labelledby=\"{name}\" class=\"reproduced\">\n<h2 id=\"{name}\">Figure {number}</h2>\n\
         <figure class=\"scroll\" tabindex=\"0\" aria-label=\"Figure {number}, may be scrolled\">{picture}</figure>\n<p>{caption}</p>\n\
         <section class=\"scroll\" tabindex=\"0\" aria-label=\"Numbers of figure {number}, may be scrolled\">\n\
         <table class=\"claims\">\n<thead><tr>{heads}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table>\n</section>\n</section>\n",
        number = figure.number,
        caption = readable(&figure.caption),
    )
}

fn row(claim: &Claim, above: Option<&Claim>) -> String {
    let cells = claim.cells_below(above);
    let mut html = format!("<tr data-verdict=\"{}\">", claim.judged().name());
    for (column, cell) in COLUMNS.iter().zip(&cells) {
        let cell = readable(cell);
        let _ = match *column {
            "quantity" => write!(html, "<th scope=\"row\">{cell}</th>"),
            column => write!(html, "<td{}>{cell}</td>", kind(column)),
        };
    }
    html + "</tr>\n"
}

/// Columns of words stand on the left.
fn kind(column: &str) -> &'static str {
    match column {
        "quantity" | "verdict" => " class=\"text\"",
        "the paper" | "note" => " class=\"text wide\"",
        _ => "",
    }
}

/// Paragraphs parted by empty lines, with `**` and `*` as in README.md.
fn paragraphs(text: &str) -> String {
    let paragraphs = text.trim().split("\n\n");
    let marked = |text: &str| emphasised(&emphasised(&readable(text), "**", "strong"), "*", "em");
    paragraphs
        .map(|text| format!("<p>{}</p>\n", marked(text)))
        .collect()
}

/// Escaped, and an index such as that of a_H set as one.
fn readable(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    let escaped = escaped(text);
    let mut parts = escaped.split('_');
    html.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let letters = part.chars().take_while(|c| c.is_alphabetic()).count();
        match part.chars().next() {
            Some(index) if letters == 1 && index.is_ascii_uppercase() => {
                let rest = part.strip_prefix(index).unwrap_or_default();
                html.push_str(&format!("<sub>{index}</sub>{rest}"));
            }
            _ => html.push_str(&format!("_{part}")),
        }
    }
    html
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
            paragraphs("**Units** are *a* < b,\nand\n\nmore\n"),
            "<p><strong>Units</strong> are <em>a</em> &lt; b,\nand</p>\n<p>more</p>\n"
        );
        assert_eq!(
            readable("a_H²/R, δ_H, energy_loss_j"),
            "a<sub>H</sub>²/R, δ<sub>H</sub>, energy_loss_j"
        );
    }
}
