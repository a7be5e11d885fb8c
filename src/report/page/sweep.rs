//! The sections of the page of a sweep.

use maud::{Markup, html};

use super::sweep_data::VariedData;
use super::{FIGURES, Pictures, answer, cases_table, how, moduli, question, scroll, section};
use crate::report::chart::Scale;
use crate::report::figure::curve::Abscissa;
use crate::report::figure::quantity::Spread;
use crate::report::rigid_indenter;
use crate::report::warnings;
use crate::sweep::plan::{AxisValue, Block, SweepPlan};
use crate::sweep::search::run::Outcome;

const NOTHING: &str = "No case has a result: there is nothing to draw.";

/// Of a result, and of what of its cases the page shows.
pub(super) fn sections(
    plan: &SweepPlan,
    (outcome, shown): (&Outcome, &Outcome),
    pictures: &Pictures,
) -> Markup {
    html! {
        (curve(plan, outcome, pictures))
        (cycle())
        (loops(pictures))
        section aria-labelledby="branches-heading" class="live" id="branches-section" {
            h2 id="branches-heading" { "Which branch dissipates" }
            p {
                "Energy per cycle that each branch of the creep compliance dissipates, from the memory of the material alone; \
                 the sum equals the area of the loop but for the discretisation."
            }
            div id="branches" class="plot tall" {}
        }
        (pictures.gallery(&FIGURES))
        (all_cases(plan, shown, outcome.records.len()))
        (section("asked-heading", "What was asked", html! {
            (question::sweep(plan))
            h3 class="live" { "Moduli of " (of_which(plan)) }
            (moduli("live grid"))
        }))
        (section("how-heading", "How the numbers were obtained", how::sweep(plan, outcome)))
    }
}

/// The material whose moduli are drawn: of a list the first.
fn of_which(plan: &SweepPlan) -> &str {
    let all = plan.each_of(Block::Material);
    let first = all.first().and_then(|(name, _)| *name);
    first.unwrap_or("the material")
}

fn curve(plan: &SweepPlan, outcome: &Outcome, pictures: &Pictures) -> Markup {
    let (over, varied) = VariedData::of_sweep(plan);
    let varied: Vec<String> = varied.into_iter().map(|varied| varied.name).collect();
    let varied = varied.join(", ");
    let is_log = match Abscissa::of(plan) {
        Abscissa::Frequency => true,
        Abscissa::Axis(axis) => is_spread(plan, axis),
    };
    html! {
        section aria-labelledby="answer" class="answer" {
            h2 id="answer" { "Energy loss per cycle" }
            (answer::peaks(plan, outcome))
            (answer::problems(plan, outcome))
            (answer::warned(warnings::over_cases(&outcome.records, plan.figures.frequency_unit)))
            @if let Some(note) = rigid_indenter::note(plan, outcome) {
                p class="hint" { "Note: " (note) "." }
            }
            div class="live controls" role="group" aria-label="Curve" id="curve-controls" {
                label { "Curve of " select id="quantity" {} }
                label id="drive-choice" hidden { (varied) " " select id="drive" {} }
                label { input type="checkbox" id="log-x" checked[is_log]; " log " (over.name) }
                label { input type="checkbox" id="log-y"; " log values" }
            }
            div id="curve" class="live plot tall" {}
            p class="live hint" {
                span id="bars" {}
                " Rings mark the peaks. Click a point, or use the arrow keys on the curve or the list below, to choose a \
                 case."
            }
            (pictures.still("energy-loss", NOTHING))
        }
    }
}

/// Whether the values of an axis are seen together on a logarithmic scale alone.
fn is_spread(plan: &SweepPlan, axis: usize) -> bool {
    let conditions = plan.conditions().iter();
    let values = conditions.filter_map(|condition| condition.values.get(axis));
    Spread::of_values(values.map(AxisValue::as_number).collect()) == Scale::Log
}

/// One cycle, which the script fills.
fn cycle() -> Markup {
    let plots = [
        ("Hysteresis loop", "loop"),
        ("Load and approach over the cycle", "phase"),
        ("Contact radius over the cycle", "radius"),
        ("Peak pressure over the cycle", "pressure"),
        ("Harmonics", "harmonics"),
        ("Pressure over the contact", "profile"),
    ];
    html! {
        section aria-labelledby="cycle-heading" class="live" id="cycle" {
            h2 id="cycle-heading" { "The cycle of one case" }
            div class="controls" role="group" aria-label="Choice of the case" id="case-controls" {
                button type="button" id="previous" { "← Lower" }
                label { "Case " select id="case" {} }
                button type="button" id="next" { "Higher →" }
                button type="button" id="keep" { "Keep this loop" }
            }
            p id="spoken" aria-live="polite" {}
            div class="grid" {
                @for (heading, id) in plots { div { h3 { (heading) } div id=(id) class="plot" {} } }
                div id="profile-y-part" {
                    h3 { "Pressure over the contact, along y" } div id="profile-y" class="plot" {}
                }
                div { h3 { "Work density along a line" } div id="work" class="plot" {} }
                div id="map-part" { h3 { "Where the work goes in" } div id="surface" class="plot" {} }
            }
            p class="hint" id="lines-how" {}
            h3 { "Its numbers" }
            section class="scroll" tabindex="0" aria-label="Numbers of the chosen case" {
                table id="facts" {
                    thead {
                        tr {
                            th scope="col" class="text" { "quantity" }
                            th scope="col" { "value" }
                            th scope="col" { "error estimate" }
                        }
                    }
                    tbody {}
                }
            }
        }
    }
}

fn loops(pictures: &Pictures) -> Markup {
    let content = html! {
        div class="live controls" role="group" aria-label="Loops" id="loops-controls" {
            label { input type="checkbox" id="normalised"; " centred and scaled to the largest amplitude" }
            button type="button" id="clear" { "Keep none" }
        }
        div id="loops" class="live plot tall" {}
        ul id="kept" class="live chips" {}
        (pictures.still("loops", NOTHING))
    };
    section("loops-heading", "Loops side by side", content)
}

fn all_cases(plan: &SweepPlan, outcome: &Outcome, all: usize) -> Markup {
    let shown = outcome.records.len();
    let content = html! {
        @if plan.is_small() {
            (super::copying("Copy as CSV", "Download sweep.csv"))
            p class="live hint" {
                "Activate a heading to sort by it. The CSV has every column, in the order shown, to the last digit."
            }
        } @else {
            p class="hint" {
                @if shown < all { "This page shows " (shown) " of " (all) " cases. " }
                "All cases, to the last digit, are in " a href="sweep.csv" { "sweep.csv" } " beside this page."
            }
            div class="live controls" role="group" aria-label="Pages of the table" id="pages" {
                button type="button" id="page-before" { "← Before" }
                span id="page-place" role="status" {}
                button type="button" id="page-after" { "After →" }
            }
        }
        (scroll("Table", cases_table::table(plan, outcome)))
    };
    section("table-heading", "All cases", content)
}
