//! `index.html`: everything about a result in one page that needs no network and, for its main figures and tables, neither another
//! file nor its own script; further figures it shows from `figures/`. Style and script are files beside this one.

mod answer;
mod cases_table;
mod compact;
pub mod comparison;
pub mod dynamic;
pub mod force_curve;
pub mod frame;
pub(super) mod how;
mod html;
pub mod identify;
pub mod material;
pub mod measured;
mod pictures;
mod plain;
pub(super) mod question;
mod simulation;
mod surface_data;
mod sweep;
mod sweep_data;
mod thinned;

pub use pictures::Pictures;
pub use thinned::shown;

use super::ReportError;
use super::profile_lines::Profile;
use crate::simulation::SimulationOutcome;
use crate::simulation::scenario::{self, ScenarioPlan};
use crate::sweep::plan::SweepPlan;
use crate::sweep::plan::resolved;
use crate::sweep::search::run::Outcome;
use crate::sweep::store::RESOLVED;
use frame::{Frame, HEAT, Input, MODULI, PLOT, TABLE};
use maud::{Markup, html};

const SWEEP_SCRIPT: &str = include_str!("sweep.js");
const SIMULATION_SCRIPT: &str = include_str!("simulation.js");

/// Figures of a sweep that its page shows where there is no script.
pub const FIGURES: [&str; 2] = ["energy-loss", "loops"];

/// The page of a sweep, whose figures have gone by.
///
/// # Errors
/// [`ReportError`] naming the part that could not be made.
pub fn sweep(
    plan: &SweepPlan,
    outcome: &Outcome,
    pictures: &Pictures,
    hash: &str,
) -> Result<String, ReportError> {
    let (shown, table) = thinned::of_page(plan, outcome)?;
    let csv = String::from_utf8_lossy(&table);
    let data = sweep_data::SweepData::new(plan, &shown, &csv);
    let text = resolved::resolved_text(plan);
    let frame = Frame {
        title: &plan.title,
        asked: question::line(plan),
        main: sweep::sections(plan, (outcome, &shown), pictures),
        input: Input::of_file(
            ("exactly this input", hash.to_owned()),
            (RESOLVED, &text),
            "The sweep file with every default written out. <code>contact-dma sweep resolved.toml</code> gives these \
             results again, under the same hash.",
        ),
        script: &[PLOT, HEAT, TABLE, MODULI, SWEEP_SCRIPT],
    };
    frame.page(&data)
}

/// The page of one history, whose figure has gone by.
///
/// # Errors
/// [`ReportError`] naming the part that could not be made.
pub fn simulation(
    plan: &ScenarioPlan,
    (outcome, profiles): (&SimulationOutcome, &[Profile]),
    pictures: &Pictures,
    hash: &str,
) -> Result<String, ReportError> {
    let text = scenario::resolved_text(plan);
    let frame = Frame {
        title: &plan.title,
        asked: simulation::line(plan),
        main: simulation::sections(plan, outcome, pictures),
        input: Input::of_file(
            ("exactly this input", hash.to_owned()),
            (RESOLVED, &text),
            "The scenario with every default written out. <code>contact-dma simulate resolved.toml</code> gives these \
             results again, under the same hash.",
        ),
        script: &[PLOT, HEAT, MODULI, SIMULATION_SCRIPT],
    };
    frame.page(&simulation::SimulationData::new(plan, outcome, profiles))
}

/// A section under its heading, of this id.
fn section(id: &str, heading: &str, content: Markup) -> Markup {
    html! {
        section aria-labelledby=(id) { h2 id=(id) { (heading) } (content) }
    }
}

/// What may be wider than the page.
fn scroll(what: &str, table: Markup) -> Markup {
    let label = format!("{what}, may be scrolled");
    html! { section class="scroll" tabindex="0" aria-label=(label) { (table) } }
}

/// Where the script draws the moduli of the material.
fn moduli(class: &str) -> Markup {
    html! {
        div class=(class) { div id="moduli" class="plot" {} div id="tangent" class="plot" {} }
    }
}

/// Buttons that give the CSV behind a table.
fn copying(copy: &str, download: &str) -> Markup {
    html! {
        div class="live controls" role="group" aria-label="Table" {
            button type="button" id="copy" { (copy) }
            button type="button" id="download-csv" { (download) }
            span id="copied" role="status" {}
        }
    }
}
