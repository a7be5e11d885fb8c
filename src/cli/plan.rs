//! `contact-dma plan`: what a sweep file would compute, and about what that costs.

use std::path::PathBuf;

use clap::Args;

use serde_json::{Value, json};

use super::failure::{Ended, Failure};
use super::meant_for;
use super::memory::{free_here, megabytes};
use super::output::{OutputFormat, tell};
use crate::engine::EngineKind;
use crate::figures::paper::drawing_bytes;
use crate::input::sweep_file;
use crate::quantity::{Dimension, format_human};
use crate::report::machine;
use crate::report::number::{four_digits, two_digits, varied as varied_value};
use crate::report::table::Cell;
use crate::report::text::{Column, Table, Text};
use crate::report::words::nodes;
use crate::sweep::case::Setup;
use crate::sweep::plan::{Axes, AxisValues, Condition, SweepPlan};
use crate::sweep::share::cost::Cost;

#[derive(Debug, Args)]
pub(super) struct PlanFlags {
    /// The sweep file (TOML); - reads standard input, from which paths start in the working folder
    file: PathBuf,
    /// Change one key of the sweep file; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Choose steps and nodes so that the relative error of every loss is below this value; same as
    /// --set cycle.accuracy=X
    #[arg(long, value_name = "X")]
    accuracy: Option<f64>,
}

/// Cases listed before the rest is counted.
const LISTED: usize = 100;

/// Runs the command.
pub(super) fn run(flags: &PlanFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let set = with_accuracy(&flags.set, flags.accuracy)?;
    let plan = sweep_file::plan(&meant_for::open(&meant_for::SWEEP, &flags.file, &set)?)?;
    show(&Setup::new(plan).map_err(Failure::input)?, format)
}

/// Changes of keys, with that of `--accuracy`.
///
/// # Errors
/// The accuracy is given by both.
pub(super) fn with_accuracy(set: &[String], accuracy: Option<f64>) -> Result<Vec<String>, Failure> {
    let is_accuracy = |set: &String| set.trim_start().starts_with("cycle.accuracy=");
    if accuracy.is_some() && set.iter().any(is_accuracy) {
        let both = "--accuracy X is --set cycle.accuracy=X: give one of the two";
        return Err(Failure::input(both));
    }
    let accuracy = accuracy.map(|a| format!("cycle.accuracy={a:?}"));
    Ok(set.iter().cloned().chain(accuracy).collect())
}

/// Prints cases and cost of a sweep.
pub(super) fn show(setup: &Setup, format: OutputFormat) -> Result<Ended, Failure> {
    let cost = Cost::of(setup, drawing_bytes(&setup.plan().figures, 1)).map_err(Failure::input)?;
    let found = || Ok(to_json(setup, &cost));
    tell(format, false, found, || Ok(text(setup, &cost)))
}

fn text(setup: &Setup, cost: &Cost) -> Text {
    let plan = setup.plan();
    let free = free_here();
    let refined = match plan.refine {
        true => ", added frequencies not",
        false => "",
    };
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let cases = match cost.cases.len() {
        1 => "1 case".to_owned(),
        cases => format!("{cases} cases"),
    };
    let mut text = Text::from(format!("{}\n\n", plan.title));
    text.append(table(plan, cost));
    text.append(format!(
        "\n{cases} on {} ({} engine), {} steps per cycle.\n\
         Time: about {} on one thread, about {} on {processors}, peaks and figures included{refined};\n\
         from cases tried here, {} per step.\n\
         Memory: about {} on {processors}{free}. Disk: about {}.\n\
         Shards: {} (more would take less than about ten minutes each, and save little time).",
        nodes(&plan.solver, plan.base.contact.indenter.as_ref()),
        plan.solver.engine.name(),
        plan.cycle.steps,
        spoken(cost.on_threads_s(1)),
        spoken(cost.on_threads_s(processors)),
        spoken(cost.step_s),
        megabytes(cost.on_threads_bytes(processors)),
        megabytes(cost.disk_bytes),
        cost.shards(),
    ));
    text
}

/// One line per case.
fn table(plan: &SweepPlan, cost: &Cost) -> Table {
    let unit = plan.figures.frequency_unit;
    let memory = megabytes(cost.memory_bytes);
    // What an axis varies of something else than the drive takes the place of the drive, which is then the same for all.
    let own: Vec<_> = plan.axes.iter().flat_map(Axes::own_columns).collect();
    let of_drive = [
        Column::right("drive mean", 10),
        Column::right("amplitude", 9),
    ];
    let names: Vec<String> = own.iter().map(|(_, varied)| varied.name()).collect();
    let varying = match own.is_empty() {
        true => of_drive.into(),
        false => vec![Column::right(names.join(", "), 22)],
    };
    let of_case = |Condition { values, drive, .. }: &Condition| match own.is_empty() {
        true => vec![short(drive.mean()), short(drive.amplitude())],
        false => {
            let own = own.iter();
            let own = own.filter_map(|(axis, of)| Some(varied_value(of, values.get(*axis)?)));
            vec![own.collect::<Vec<_>>().join(", ")]
        }
    };
    let frequency = format!("{} / {}", unit.symbol(), unit.name());
    let first = [Column::right("case", 5), Column::right(frequency, 10)];
    let last = [
        Column::right("cycles", 6).leaves_first(),
        Column::right("about", 7),
        Column::left("memory", 0).leaves_first(),
    ];
    let mut table = Table::new(3, first.into_iter().chain(varying).chain(last));
    for case in cost.cases.iter().take(LISTED) {
        let first = [
            case.case.index.to_string(),
            four_digits(unit.of(case.case.angular_frequency_rad_per_s)),
        ];
        let last = [
            format!("{:.0}", case.cycles.ceil()),
            spoken(case.time_s),
            memory.clone(),
        ];
        let cells = first.into_iter().chain(of_case(&case.case.condition));
        table.row(cells.chain(last));
    }
    if cost.cases.len() > LISTED {
        table.remark(format!("  and {} more", cost.cases.len() - LISTED));
    }
    table
}

/// A number in at most six digits, with an exponent where it would otherwise have many zeros.
fn short(value: f64) -> String {
    let value: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    match value.abs() {
        1e-4..1e7 | 0.0 => value.to_string(),
        _ => format!("{value:e}"),
    }
}

/// A time in the unit that people would use for it.
fn spoken(time_s: f64) -> String {
    let (unit_s, unit) = match time_s {
        ..120.0 => return format_human(time_s, Dimension::Time, 2),
        ..7200.0 => (60.0, "min"),
        ..172_800.0 => (3600.0, "h"),
        _ => (86_400.0, "days"),
    };
    format!("{} {unit}", two_digits(time_s / unit_s))
}

/// The values of axes, blocks of a list by their names; of one axis alone its value, of none nothing.
fn varied(plan: &SweepPlan, values: &AxisValues) -> Value {
    let over = plan.axes.iter().flat_map(|axes| &axes.over);
    let values = over.zip(values.all());
    let told = values.map(|(varied, value)| machine::value(Cell::of_axis(varied, Some(*value))));
    let mut told: Vec<_> = told.collect();
    match told.len() {
        0 | 1 => told.pop().unwrap_or_default(),
        _ => told.into(),
    }
}

/// What a sweep would compute, and what that costs.
fn to_json(setup: &Setup, cost: &Cost) -> Value {
    let plan = setup.plan();
    let own = plan.base.contact.indenter.own_cells();
    let (springs, cells) = match (plan.solver.engine, own) {
        (EngineKind::Axisymmetric, _) => (Some(plan.solver.springs), None),
        (EngineKind::HalfSpace, Some((x, y))) => (None, Some([x, y])),
        (EngineKind::HalfSpace, None) => (None, Some([plan.solver.cells; 2])),
    };
    let cases = cost.cases.iter().map(|case| {
        json!({
            "index": case.case.index,
            "angular_frequency_rad_per_s": case.case.angular_frequency_rad_per_s,
            "varied": varied(plan, &case.case.condition.values),
            "drive_mean": case.case.condition.drive.mean(),
            "drive_amplitude": case.case.condition.drive.amplitude(),
            "cycles": case.cycles.ceil() as u64,
            "time_s": case.time_s,
        })
    });
    json!({
        "title": plan.title,
        "engine": plan.solver.engine.name(),
        "springs": springs,
        "cells": cells,
        "steps_per_cycle": plan.cycle.steps,
        "cases": cases.collect::<Vec<_>>(),
        "time_on_one_thread_s": cost.on_threads_s(1),
        "time_of_peaks_s": cost.peaks_s,
        "time_of_figures_s": cost.report_s,
        "disk_bytes": cost.disk_bytes,
        "time_per_step_s": cost.step_s,
        "memory_per_thread_bytes": cost.memory_bytes,
        "memory_of_results_bytes": cost.results_bytes,
        "useful_shards": cost.shards(),
    })
}
