//! `index.html`: everything about a result in one page that needs no network, no other file and, for its figures and tables,
//! not even its own script. Template, style and script are files beside this one.

mod answer;
mod cases_table;
mod compact;
pub mod comparison;
pub mod drawing;
pub mod frame;
pub(super) mod how;
pub mod html;
pub mod material;
mod pictures;
pub(super) mod question;
mod simulation;
mod surface_data;
mod sweep_data;

pub use pictures::Pictures;

use super::ReportError;
use crate::report::quantities;
use crate::sweep::history::SimulationOutcome;
use crate::sweep::history::outside_model;
use crate::sweep::plan::SweepPlan;
use crate::sweep::plan::resolved;
use crate::sweep::plan::scenario::{self, ScenarioPlan};
use crate::sweep::record::warning;
use crate::sweep::search::run::Outcome;
use frame::{Frame, HEAT, Input, InputFile, MODULI, PLOT, TABLE};
use html::{filled, json_for_script};

const SWEEP: &str = include_str!("sweep.html");
const SIMULATION: &str = include_str!("simulation.html");
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
    let branches = outcome.retardation_times_s().len();
    let unit = plan.figures.frequency_unit;
    let csv = quantities::sweep(&outcome.records, branches, unit);
    let csv = String::from_utf8_lossy(&csv);
    let data = sweep_data::SweepData::new(plan, outcome, &csv);
    let main = filled(
        SWEEP,
        &[
            ("answer", &answer::peaks(plan, outcome)),
            ("problems", &answer::problems(plan, outcome)),
            (
                "warnings",
                &answer::warned(warning::over_cases(&outcome.records, unit)),
            ),
            (
                "varied",
                plan.axis.as_ref().map_or("", |axis| axis.varied.name()),
            ),
            ("curve_figure", &static_figure(pictures, "energy-loss")),
            ("loops_figure", &static_figure(pictures, "loops")),
            ("table", &cases_table::table(plan, outcome)),
            ("question", &question::sweep(plan)),
            ("how", &how::sweep(plan, outcome)),
        ],
    )?;
    let text = resolved::resolved_text(plan);
    let frame = Frame {
        title: &plan.title,
        asked: question::line(plan),
        main,
        input: Input {
            hashes: vec![("exactly this input", hash.to_owned())],
            files: vec![InputFile {
                name: "resolved.toml",
                text: &text,
            }],
            text: "The sweep file with every default written out. <code>contact-dma sweep resolved.toml</code> gives these \
                   results again, under the same hash.",
        },
        data: json_for_script(&data)?,
        script: &[PLOT, HEAT, TABLE, MODULI, SWEEP_SCRIPT],
    };
    frame.page()
}

/// The page of one history, whose figure has gone by.
///
/// # Errors
/// [`ReportError`] naming the part that could not be made.
pub fn simulation(
    plan: &ScenarioPlan,
    outcome: &SimulationOutcome,
    pictures: &Pictures,
    hash: &str,
) -> Result<String, ReportError> {
    let figure = pictures.inline("history").unwrap_or_else(|| {
        "<p>The history has no two times: there is nothing to draw.</p>".to_owned()
    });
    let main = filled(
        SIMULATION,
        &[
            ("answer", &simulation::answer(outcome)),
            ("problems", &simulation::problems(outcome)),
            (
                "warnings",
                &answer::warned(outside_model::warnings(plan, outcome)),
            ),
            ("figure", &figure),
            ("question", &simulation::question(plan)),
            ("how", &simulation::how(plan, outcome)),
        ],
    )?;
    let text = scenario::resolved_text(plan);
    let frame = Frame {
        title: &plan.title,
        asked: simulation::line(plan),
        main,
        input: Input {
            hashes: vec![("exactly this input", hash.to_owned())],
            files: vec![InputFile {
                name: "resolved.toml",
                text: &text,
            }],
            text: "The scenario with every default written out. <code>contact-dma simulate resolved.toml</code> gives these \
                   results again, under the same hash.",
        },
        data: json_for_script(&simulation::SimulationData::new(plan, outcome))?,
        script: &[PLOT, HEAT, MODULI, SIMULATION_SCRIPT],
    };
    frame.page()
}

/// A figure for a reader without script; a sentence where there is nothing to draw.
fn static_figure(pictures: &Pictures, name: &str) -> String {
    pictures
        .inline(name)
        .unwrap_or_else(|| "<p>No case has a result: there is nothing to draw.</p>".to_owned())
}
