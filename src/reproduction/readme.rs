//! README.md: the figures with their claims, readable where the repository is.

use super::Figure;
use super::claim::{COLUMNS, rows};
use super::statement::{Judged, counted, disagreeing};

const OPENING: &str = include_str!("opening.md");

/// How to read the numbers, with `**` and `*`.
pub(super) const EXPLANATION: &str = include_str!("explanation.md");

/// The page: opening, explanation, what disagrees, then figure by figure.
pub(super) fn text(figures: &[Figure]) -> String {
    let mut text = format!(
        "{OPENING}{EXPLANATION}\n**{}.** All values: [claims.csv](claims.csv); the statements, and how each is held against the \
         values: [figures.toml](../../sweeps/spinu-2018/figures.toml).\n",
        counted(figures)
    );
    let lines = disagreeing(figures);
    if !lines.is_empty() {
        text += "\n## What disagrees\n\n";
        text.extend(lines.iter().map(|line| format!("- {line}\n")));
        let discussions = figures
            .iter()
            .filter_map(|figure| figure.discussion.as_ref());
        text.extend(discussions.map(|discussion| format!("\n{discussion}")));
    }
    text.extend(figures.iter().map(section));
    text
}

fn section(figure: &Figure) -> String {
    let Figure {
        number, caption, ..
    } = figure;
    let name = figure.name();
    let statements = figure.statements.iter().map(Judged::cells);
    format!(
        "\n## Figure {number}\n\n![Figure {number}](figures/{name}.png)\n\n{caption} Data: [{name}.csv](figures/{name}.csv); \
         [SVG](figures/{name}.svg).\n\n{}\n{}",
        table(Judged::COLUMNS, statements),
        table(COLUMNS.map(|(column, _)| column), rows(&figure.claims))
    )
}

fn table<C: AsRef<str>, const N: usize>(
    headings: [&str; N],
    rows: impl Iterator<Item = [C; N]>,
) -> String {
    let row = |cells: [&str; N]| format!("| {} |\n", cells.join(" | "));
    let rows: String = rows
        .map(|cells| row(cells.each_ref().map(AsRef::as_ref)))
        .collect();
    format!("{}|{}\n{rows}", row(headings), "---|".repeat(N))
}
