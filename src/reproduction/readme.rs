//! README.md: the figures with their claims, readable where the repository is.

use super::claim::{COLUMNS, rows};
use super::statement::counted;
use super::{Figure, Judged, Verdict};

const OPENING: &str = include_str!("opening.md");

/// How to read the numbers, with `**` and `*`.
pub(super) const EXPLANATION: &str = include_str!("explanation.md");

/// A sentence for each statement of the paper that disagrees.
pub(super) fn disagreeing(figures: &[Figure]) -> Vec<String> {
    let statements = figures.iter().flat_map(|figure| {
        let statements = figure.statements.iter();
        statements.map(move |statement| (figure.number, statement))
    });
    statements
        .filter(|(_, statement)| statement.verdict == Verdict::Disagrees)
        .map(
            |(
                number,
                Judged {
                    paper,
                    computed,
                    note,
                    ..
                },
            )| {
                let note = match note.is_empty() {
                    true => String::new(),
                    false => format!(" ({note})"),
                };
                format!("Figure {number}: \u{201c}{paper}\u{201d} Computed: {computed}{note}.")
            },
        )
        .collect()
}

/// The page: opening, explanation, what disagrees, then figure by figure.
pub(super) fn text(figures: &[Figure]) -> String {
    let mut text = format!(
        "{OPENING}{EXPLANATION}\n**{}.** All values: [claims.csv](claims.csv); the statements, and how each is held against the \
         values: [figures.toml](../../sweeps/spinu-2018/figures.toml).\n",
        counted(figures)
    );
    let lines = disagreeing(figures);
    if !lines.is_empty() {
        text.push_str("\n## What disagrees\n\n");
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
    let row = |cells: &[&str]| format!("| {} |\n", cells.join(" | "));
    let statements = figure.statements.iter().map(|statement| {
        let kind = if statement.is_number { "yes" } else { "" };
        row(&[&statement.paper, kind, statement.verdict.name()])
    });
    let claims = rows(&figure.claims).map(|cells| row(&cells.each_ref().map(|cell| &cell[..])));
    format!(
        "\n## Figure {number}\n\n![Figure {number}](figures/{name}.png)\n\n{caption} Data: [{name}.csv](figures/{name}.csv); \
         [SVG](figures/{name}.svg).\n\n{}|---|---|---|\n{}\n{}|{}\n{}",
        row(&["the paper states", "number", "verdict"]),
        statements.collect::<String>(),
        row(&COLUMNS.map(|(column, _)| column)),
        "---|".repeat(COLUMNS.len()),
        claims.collect::<String>()
    )
}
