//! README.md: the figures with their claims, readable where the repository is.

use std::fmt::Write;

use super::Figure;
use super::claim::COLUMNS;
use super::statement::Count;
use super::wording::{self, EXPLANATION, FIGURE_13};

const OPENING: &str = "\
# The computed figures of Spinu 2018

S. Spinu, *Viscoelastic Contact Simulation under Harmonic Cyclic Load*, Advances in Tribology 2018, 9432894
([doi:10.1155/2018/9432894](https://doi.org/10.1155/2018/9432894)), figure by figure. This folder is written by

```sh
contact-dma reproduce
```

from the scenario and sweep files in `sweeps/spinu-2018/`, each of which also runs by itself (`contact-dma simulate FILE`,
`contact-dma sweep FILE`). A test holds every byte of it to what the command writes. Figures 2 and 3 of the paper are
flowcharts.

";

/// The page: opening, explanation, what disagrees, then figure by figure.
pub(super) fn text(figures: &[Figure]) -> String {
    let mut text = format!("{OPENING}{EXPLANATION}");
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "\n**{}.** All values: [claims.csv](claims.csv); the statements, and how each is held against the values: \
         [claims.toml](../../sweeps/spinu-2018/claims.toml).",
        Count::of(figures).text()
    );
    disagreements(&mut text, figures);
    for figure in figures {
        section(&mut text, figure);
    }
    text
}

fn disagreements(text: &mut String, figures: &[Figure]) {
    let disagreeing = wording::disagreeing(figures);
    if disagreeing.is_empty() {
        return;
    }
    text.push_str("\n## What disagrees\n\n");
    for line in disagreeing {
        let _ = writeln!(text, "- {line}");
    }
    if figures.iter().any(|figure| figure.number == 13) {
        let _ = write!(text, "\n{FIGURE_13}");
    }
}

fn section(text: &mut String, figure: &Figure) {
    let name = figure.name();
    let _ = writeln!(
        text,
        "\n## Figure {}\n\n![Figure {}](figures/{name}.png)\n\n{} Data: [{name}.csv](figures/{name}.csv); [SVG](figures/{name}.svg).\n",
        figure.number, figure.number, figure.caption
    );
    text.push_str("| the paper states | number | verdict |\n|---|---|---|\n");
    for statement in &figure.statements {
        let kind = if statement.is_number { "yes" } else { "" };
        let _ = writeln!(
            text,
            "| {} | {kind} | {} |",
            statement.paper,
            statement.verdict.name()
        );
    }
    text.push('\n');
    let _ = writeln!(
        text,
        "| {} |\n|{}",
        COLUMNS.join(" | "),
        "---|".repeat(COLUMNS.len())
    );
    let mut above = None;
    for claim in &figure.claims {
        let _ = writeln!(text, "| {} |", claim.cells_below(above).join(" | "));
        above = Some(claim);
    }
}
