//! README.md: the figures with their claims, readable where the repository is.

use std::fmt::Write;

use super::claim::Value;
use super::{Claim, Figure, Verdict};

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

**Units** are the paper's: lengths in Hertz contact radii a_H, approaches in δ_H = a_H²/R, pressures in Hertz peak pressures
p_H, loads in W₀, times in τ, all Hertz values at W₀ and the instantaneous compliance. Concretely: G = G_K = 1 MPa, ν = 1/2,
τ = 1 s, R = 10 mm, W₀ = 10 mN, which keeps slopes small (a_H = 0.266 mm). PMMA: R = 10 mm, W₀ = 10 N, W_A = 5 N, 500 s of rest.

**Exact** values are closed forms where there are any (Hertz; Lee and Radok; Ting; the stabilised maxima of radius and
approach), elsewhere the axisymmetric engine refined: twice the springs, and half to a quarter of the time steps.
**Axisymmetric** are 800 to 1600 springs and time steps a tenth of those of the half-space engine, or 400 springs and 200 steps
per cycle. **Half-space** are 256 × 256 cells; long histories from rest (figures 1, 8 and 9, first touch in 13) stand on
128 × 128, and the many cycles that a count of cycles takes on 64 × 64.
Errors are relative for losses and energies, otherwise in the unit of the quantity. Required are: pressures within 0.01 p_H
but within two cells of the edge of the contact, radii within half a cell, losses within 0.2 %; a test asserts it for
every row.
";

/// The page.
pub(super) fn text(figures: &[Figure]) -> String {
    let mut text = OPENING.to_owned();
    let claims = || figures.iter().flat_map(|figure| &figure.claims);
    let count = |verdict| claims().filter(|claim| claim.verdict == verdict).count();
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "\n**{} claims**: {} agree with the paper, {} disagree, {} are not stated there. As a table: [claims.csv](claims.csv).",
        claims().count(),
        count(Verdict::Agrees),
        count(Verdict::Disagrees),
        count(Verdict::NotStated)
    );
    disagreements(&mut text, figures);
    for figure in figures {
        section(&mut text, figure);
    }
    text
}

fn disagreements(text: &mut String, figures: &[Figure]) {
    let claims = figures.iter().flat_map(|figure| &figure.claims);
    let disagreeing: Vec<&Claim> = claims
        .filter(|claim| claim.verdict == Verdict::Disagrees)
        .collect();
    if disagreeing.is_empty() {
        return;
    }
    text.push_str("\n## What disagrees\n\n");
    for claim in disagreeing {
        let _ = writeln!(
            text,
            "- Figure {}, {}: the paper has {}, computed is {}{}{}.",
            claim.figure,
            claim.quantity,
            claim.paper,
            claim.exact_text(),
            if claim.note.is_empty() { "" } else { "; " },
            claim.note
        );
    }
    if figures.iter().any(|figure| figure.number == 13) {
        text.push_str(FIGURE_13);
    }
}

const FIGURE_13: &str = "
Figure 13 in particular. *Agrees*: there is one largest value at a few mrad/s, followed by a decay that levels off. *Does not*:
the paper calls the quantity the area enclosed by the hysteresis loop, and no stabilised loop has such areas: they vanish at
both ends of the frequency axis, are largest at 0.00844 rad/s and have a second maximum at 0.0757 rad/s, near the two maxima
of the loss compliance. *Why*: the drawn curve stays above 0.9 of its maximum, as the work does that is counted from first
touch on: it contains the carrier step and the creep of the hold, which are much larger than a loop. That work, to the second
maximum of the load, has its maximum near the paper's and falls to 0.91 at 0.3 rad/s. What exactly was integrated in the paper
is not said there.
";

fn section(text: &mut String, figure: &Figure) {
    let name = figure.name();
    let _ = writeln!(
        text,
        "\n## Figure {}\n\n![Figure {}]({name}.png)\n\n{} Data: [{name}.csv]({name}.csv); [SVG]({name}.svg).\n",
        figure.number, figure.number, figure.caption
    );
    text.push_str(
        "| quantity | the paper | exact | axisymmetric | half-space | errors | verdict | note |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for claim in &figure.claims {
        let errors = [claim.axisymmetric, claim.half_space]
            .map(|value| claim.error_text(value))
            .into_iter()
            .filter(|text| !text.is_empty())
            .collect::<Vec<_>>()
            .join(", ");
        let exact = match claim.exact {
            Value::Difference => String::new(),
            Value::ClosedForm(_) => claim.exact_text(),
            Value::Refined(_) | Value::Count(_) => format!("{} (refined)", claim.exact_text()),
        };
        let cells = [
            &claim.quantity,
            &claim.paper,
            &exact,
            &claim.value_text(claim.axisymmetric),
            &claim.value_text(claim.half_space),
            &if errors.is_empty() {
                errors
            } else {
                format!("{errors} {}", claim.measure.unit_name)
            },
            &claim.verdict.name().to_owned(),
            &claim.note,
        ];
        let cells: Vec<&str> = cells.iter().map(|cell| cell.as_str()).collect();
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
}
