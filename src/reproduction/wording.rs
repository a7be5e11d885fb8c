//! What README.md and the page say alike: how to read the numbers, what disagrees. Written with `**` and `*`, as in README.md.

use super::{Figure, Verdict};

/// How to read the numbers.
pub(super) const EXPLANATION: &str = "\
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

/// What is to be said of figure 13 besides.
pub(super) const FIGURE_13: &str = "\
Figure 13 in particular. *Agrees*: there is one largest value at a few mrad/s, followed by a decay that levels off. *Does not*:
the paper calls the quantity the area enclosed by the hysteresis loop, and no stabilised loop has such areas: they vanish at
both ends of the frequency axis, are largest at 0.00844 rad/s and have a second maximum at 0.0757 rad/s, near the two maxima
of the loss compliance. *Why*: the drawn curve stays above 0.9 of its maximum, as the work does that is counted from first
touch on: it contains the carrier step and the creep of the hold, which are much larger than a loop. That work, to the second
maximum of the load, has its maximum near the paper's and falls to 0.91 at 0.3 rad/s. What exactly was integrated in the paper
is not said there.
";

/// A sentence for each claim that disagrees with the paper.
pub(super) fn disagreeing(figures: &[Figure]) -> Vec<String> {
    let claims = figures.iter().flat_map(|figure| &figure.claims);
    claims
        .filter(|claim| claim.judged() == Verdict::Disagrees)
        .map(|claim| {
            format!(
                "Figure {}, {}: the paper has {}, computed is {}{}{}.",
                claim.figure,
                claim.quantity,
                claim.paper,
                claim.exact_text(),
                if claim.note.is_empty() { "" } else { "; " },
                claim.note
            )
        })
        .collect()
}
