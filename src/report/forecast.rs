//! What a sweep or a history would compute, and what that costs, before it is computed.

use serde_json::{Value, json};

use super::machine;
use super::number::{four_digits, megabytes, two_digits, varied as varied_value};
use super::table::Cell;
use super::text::{Column, Table, Text};
use super::words::nodes;
use crate::engine::EngineKind;
use crate::quantity::{Dimension, format_human};
use crate::simulation::Simulation;
use crate::sweep::case::Setup;
use crate::sweep::plan::{Axes, AxisValues, Condition, SweepPlan};
use crate::sweep::share::cost::Cost;

/// Cases listed before the rest is counted.
const LISTED: usize = 100;

/// What a sweep would compute and what that costs, to be read; `free` says what memory is free.
pub fn sweep_text(setup: &Setup, cost: &Cost, free: &str) -> Text {
    let plan = setup.plan();
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

/// What a sweep would compute, and what that costs, as one object.
pub fn of_sweep(setup: &Setup, cost: &Cost) -> Value {
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

/// What a history would compute, as one object.
pub fn of_history(simulation: &Simulation) -> Value {
    let steps = simulation.schedule().moments.len();
    json!({
        "title": simulation.plan().title,
        "engine": simulation.plan().solver.engine.name(),
        "time_steps": steps,
        "time_steps_for_errors": simulation.moments() - steps,
        "memory_bytes": simulation.predicted_memory_bytes(),
    })
}

/// What a history would compute, and about the memory it takes, to be read; `free` says what is free.
pub fn history_text(simulation: &Simulation, free: &str) -> String {
    let plan = simulation.plan();
    format!(
        "{}\n\n{} time steps on {} ({} engine){}.\nMemory: about {}{free}.\n",
        plan.title,
        simulation.schedule().moments.len(),
        nodes(&plan.solver, plan.contact.indenter.as_ref()),
        plan.solver.engine.name(),
        match simulation.moments() - simulation.schedule().moments.len() {
            0 => String::new(),
            more => format!(";\n{more} more, most on fewer nodes, for the errors"),
        },
        megabytes(simulation.predicted_memory_bytes()),
    )
}
