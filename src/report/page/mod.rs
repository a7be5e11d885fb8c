//! `index.html`: everything about a result in one page that needs no network, no other file and, for its figures and tables,
//! not even its own script. Template, style and script are files beside this one.

mod answer;
mod cases_table;
mod compact;
mod how;
mod html;
pub mod material;
mod number;
mod pictures;
mod question;
mod simulation;
mod sweep_data;

pub use pictures::Pictures;

use super::ReportError;
use crate::report::table;
use crate::sweep::plan::SweepPlan;
use crate::sweep::resolved;
use crate::sweep::run::Outcome;
use crate::sweep::scenario::{self, ScenarioPlan};
use crate::sweep::simulate::SimulationOutcome;
use html::{data_link, escaped, filled, json_for_script};

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
const SWEEP: &str = include_str!("sweep.html");
const SIMULATION: &str = include_str!("simulation.html");

/// The script, in the order in which its parts use each other.
const SCRIPT: [&str; 8] = [
    include_str!("core.js"),
    include_str!("plot.js"),
    include_str!("heat.js"),
    include_str!("table.js"),
    include_str!("material.js"),
    include_str!("sweep.js"),
    include_str!("simulation.js"),
    include_str!("start.js"),
];

/// What every page has: the parts around its own.
struct Frame<'a> {
    title: &'a str,
    /// One line under the title.
    asked: String,
    /// HTML of the page's own sections.
    main: String,
    /// The input as a file: its text, name, hash, and what to do with it, as HTML.
    file: &'a str,
    file_name: &'a str,
    hash: &'a str,
    file_text: &'a str,
    /// JSON for the script.
    data: String,
}

impl Frame<'_> {
    fn page(&self) -> Result<String, ReportError> {
        filled(
            PAGE,
            &[
                ("title", &escaped(self.title)),
                ("asked", &escaped(&self.asked)),
                ("main", &self.main),
                ("version", env!("CARGO_PKG_VERSION")),
                ("hash", &escaped(self.hash)),
                ("file_text", self.file_text),
                ("file_name", self.file_name),
                ("file_link", &data_link("text/plain", self.file)),
                ("file", &escaped(self.file)),
                ("style", STYLE),
                ("data", &self.data),
                ("script", &SCRIPT.concat()),
            ],
        )
    }
}

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
    let csv = table::sweep(&outcome.records, branches)?;
    let csv = String::from_utf8_lossy(&csv);
    let data = sweep_data::SweepData::new(plan, outcome, &csv);
    let main = filled(
        SWEEP,
        &[
            ("answer", &answer::peaks(plan, outcome)),
            ("problems", &answer::problems(outcome)),
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
    let frame = Frame {
        title: &plan.title,
        asked: question::line(plan),
        main,
        file: &resolved::resolved_text(plan),
        file_name: "resolved.toml",
        hash,
        file_text: "The sweep file with every default written out. <code>contact-dma sweep resolved.toml</code> gives these \
                    results again, under the same hash.",
        data: json_for_script(&data)?,
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
            ("figure", &figure),
            ("question", &simulation::question(plan)),
            ("how", &simulation::how(plan, outcome)),
        ],
    )?;
    let frame = Frame {
        title: &plan.title,
        asked: simulation::line(plan),
        main,
        file: &scenario::resolved_text(plan),
        file_name: "resolved.toml",
        hash,
        file_text: "The scenario with every default written out. <code>contact-dma simulate resolved.toml</code> gives these \
                    results again, under the same hash.",
        data: json_for_script(&simulation::SimulationData::new(plan, outcome))?,
    };
    frame.page()
}

/// A figure for a reader without script; a sentence where there is nothing to draw.
fn static_figure(pictures: &Pictures, name: &str) -> String {
    pictures
        .inline(name)
        .unwrap_or_else(|| "<p>No case has a result: there is nothing to draw.</p>".to_owned())
}
