//! What terminal, pages and captions say alike of cases, drives and settings, as plain text.

use std::cmp::Ordering;

use super::number::{self, four_digits, plain, scientific};
use crate::drive::HarmonicDrive;
use crate::engine::{EngineKind, SolverPlan};
use crate::indenter::{Indenter, Setting, Value};
use crate::material::{Compressibility, Material, Relaxation};
use crate::quantity::{Dimension, FrequencyUnit, format_human};
use crate::simulation::work::{HistoryWork, Separation};
use crate::sweep::plan::adhesion::{AdhesionModel, AdhesionPlan};
use crate::sweep::plan::{Block, Condition, SweepPlan, Varied};
use crate::sweep::search::run::Outcome;

/// A case by its frequency (rad/s): `ω = 0.01000 rad/s`.
pub fn case(unit: FrequencyUnit, angular_frequency_rad_per_s: f64) -> String {
    let value = four_digits(unit.of(angular_frequency_rad_per_s));
    format!("{} = {value} {}", unit.symbol(), unit.name())
}

/// The cases without a result, each with the reason.
pub fn without_result(unit: FrequencyUnit, outcome: &Outcome) -> impl Iterator<Item = String> {
    let cases = outcome.records.iter().filter(|r| r.result.is_none());
    cases.map(move |r| {
        let (case, status) = (case(unit, r.angular_frequency_rad_per_s), r.status.name());
        let why = r.message.as_deref().unwrap_or("no reason recorded");
        format!("{case}: {status}: {why}")
    })
}

/// What is prescribed, with the range of what an axis varies: `load 10 N ± 0.1 N to 10 N`.
pub fn drive_line(drive: &HarmonicDrive, plan: &SweepPlan) -> String {
    let dimension = drive.control().dimension();
    let value = |value| plain(value, dimension, 4);
    let range = |is_varied: fn(&Varied) -> bool| {
        let axes = plan.axes.as_ref()?;
        let axis = axes.over.iter().position(is_varied)?;
        let (least, largest) = number::range(axes.numbers_of(axis));
        Some(format!("{} to {}", value(least), value(largest)))
    };
    let mean = range(Varied::is_mean).unwrap_or_else(|| value(drive.mean()));
    let amplitude = range(Varied::is_amplitude).unwrap_or_else(|| value(drive.amplitude()));
    let lifts_off = |drive: &HarmonicDrive| drive.loaded_part().is_some_and(|part| part < 1.0);
    let held = match plan.conditions().iter().any(|c| lifts_off(&c.drive)) {
        true => ", held at zero where that is a pull",
        false => "",
    };
    let period_m2 = plan.base.contact.indenter.period_area_m2();
    let pressure = period_m2.filter(|_| plan.axes.is_none()).map(|area_m2| {
        let [mean, amplitude] = [drive.mean(), drive.amplitude()]
            .map(|load_n| plain(load_n / area_m2, Dimension::Stress, 4));
        format!(", a mean pressure of {mean} ± {amplitude}")
    });
    let (name, pressure) = (drive.control().name(), pressure.unwrap_or_default());
    format!("{name} {mean} ± {amplitude}{held}{pressure}")
}

/// The work of the indenter over a history, and what becomes of it.
pub fn work(work: &HistoryWork) -> String {
    let value = number::with_error(work.work_j, work.error_j, Dimension::Energy);
    let becomes = work
        .stored
        .unwrap_or("all of it is dissipated by the time the surface has recovered");
    format!("{value}; {becomes}")
}

/// The pull of surfaces that attract one another, and the work of it where they part.
pub fn separation(separation: &Separation) -> String {
    let (pull_n, error_n) = (separation.pull_n, separation.pull_error_n);
    let pull = number::with_error(pull_n, error_n, Dimension::Force);
    match separation.work_j {
        Some(work_j) => {
            let work = number::with_error(work_j, separation.work_error_j, Dimension::Energy);
            format!("Pull-off at {pull}; work of separation {work}.")
        }
        None => format!("Largest pull {pull}; the surfaces stay together."),
    }
}

/// The attraction of the indenter, where there is any: `a work of adhesion of 0.05 J/m² (range 0.3 nm)`.
pub fn adhesion_line(adhesion: Option<AdhesionPlan>) -> Option<String> {
    let adhesion = adhesion?;
    let work = number::six_digits(adhesion.work_j_per_m2);
    let how = match adhesion.model {
        AdhesionModel::Maugis => {
            format!(
                "range {}",
                format_human(adhesion.range_m(), Dimension::Length, 4)
            )
        }
        limit => limit.name().to_uppercase(),
    };
    Some(format!("a work of adhesion of {work} J/m² ({how})"))
}

/// Blocks of a list that are told one by one, at most.
const TOLD: usize = 4;

/// The blocks of a list in words, or the one that there is; of many only how many.
pub fn each_of(
    plan: &SweepPlan,
    block: Block,
    words: impl Fn(Option<&str>, &Condition) -> String,
) -> String {
    let all = plan.each_of(block);
    if all.len() > TOLD {
        return format!("{} {}s", all.len(), block.name());
    }
    let mut told: Vec<String> = all.iter().map(|(name, c)| words(*name, c)).collect();
    told.dedup();
    listed(&told)
}

/// What axes vary besides mean and amplitude, and from where to where: `radius of the indenter 1 mm to 10 mm`.
pub fn varied_line(plan: &SweepPlan) -> Option<String> {
    let axes = plan.axes.as_ref()?;
    let line = |(axis, varied): (usize, &Varied)| {
        // The blocks of a list are told where the block would be.
        if varied.is_whole() {
            return None;
        }
        let (least, largest) = number::range(axes.numbers_of(axis));
        let [least, largest] = [least, largest].map(|value| number::varied_number(varied, value));
        Some(format!("{} {least} to {largest}", varied.words()))
    };
    let lines: Vec<String> = axes.own_columns().filter_map(line).collect();
    (!lines.is_empty()).then(|| lines.join(", "))
}

/// The number of replicas that the material has, of several materials the most.
pub fn replicas(plan: &SweepPlan) -> usize {
    let materials = plan.each_of(Block::Material).into_iter();
    let counts = materials.map(|(_, condition)| condition.contact.material.origin.replicas.len());
    counts.max().unwrap_or(0)
}

/// How a material changes its volume: `Poisson ratio 0.38`, `bulk modulus 3 GPa`, `bulk modulus 5 GPa relaxing to 3 GPa`.
pub fn compressibility(material: &Material) -> String {
    match material.compressibility() {
        Compressibility::PoissonRatio(nu) => format!("Poisson ratio {nu}"),
        Compressibility::BulkModulus(bulk) => format!("bulk modulus {}", bulk_modulus(bulk, 4)),
    }
}

/// A bulk modulus, from where to where it relaxes, if it does.
pub fn bulk_modulus(bulk: &Relaxation, digits: usize) -> String {
    let modulus = |value| plain(value, Dimension::Stress, digits);
    let at_rest = modulus(bulk.equilibrium_modulus());
    let at_once = modulus(bulk.instantaneous_modulus());
    match bulk.branches() {
        [] => at_rest,
        _ => format!("{at_once} relaxing to {at_rest}"),
    }
}

/// A key as words.
pub fn named(key: &str) -> String {
    key.replace('_', " ")
}

/// Settings in one line: `radius 10 mm, height 1 µm`.
pub fn row(table: &[Setting]) -> String {
    let entry = |p: &Setting| format!("{} {}", named(&p.key), value(&p.value));
    table.iter().map(entry).collect::<Vec<_>>().join(", ")
}

/// A setting as text.
pub fn value(value: &Value) -> String {
    match value {
        Value::Quantity(value, dimension) => plain(*value, *dimension, 6),
        Value::Quantities(values, dimension) => {
            let texts = values.iter().map(|value| plain(*value, *dimension, 6));
            texts.collect::<Vec<_>>().join(", ")
        }
        Value::Number(number) => number.to_string(),
        Value::Integer(integer) => integer.to_string(),
        Value::Text(text) => text.clone(),
        Value::Tables(tables) => format!("{} of them", tables.len()),
        other => other.toml(),
    }
}

/// The nodes of an engine, in words.
pub fn nodes(solver: &SolverPlan, indenter: &dyn Indenter) -> String {
    match (solver.engine, indenter.own_cells()) {
        (EngineKind::Axisymmetric, _) => format!("{} springs", solver.springs),
        (EngineKind::HalfSpace, Some((x, y))) => format!("{x} x {y} cells of the map"),
        (EngineKind::HalfSpace, None) => format!("{0} x {0} cells", solver.cells),
    }
}

/// What the nodes of an engine are called.
pub fn nodes_name(engine: EngineKind) -> &'static str {
    match engine {
        EngineKind::Axisymmetric => "springs",
        EngineKind::HalfSpace => "cells per side",
    }
}

/// Smallest and largest of some values; `decimals` 0 prints whole numbers, others that many significant digits.
pub fn range(values: impl Iterator<Item = f64>, digits: usize) -> String {
    let (low, high) = number::range(values);
    let text = |value: f64| match digits {
        0 => format!("{value:.0}"),
        _ => scientific(value, digits),
    };
    match low.partial_cmp(&high) {
        Some(Ordering::Less) => format!("{} to {}", text(low), text(high)),
        Some(Ordering::Equal) => text(low),
        _ => "not estimated".to_owned(),
    }
}

/// Items of a list as words: `a`, `a and b`, `a, b and c`.
pub fn listed(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_read_as_words() {
        let items = |count: usize| -> Vec<String> {
            ["a", "b", "c"]
                .iter()
                .take(count)
                .map(|item| (*item).to_owned())
                .collect()
        };
        let listed: Vec<String> = (0..=3).map(|count| listed(&items(count))).collect();
        assert_eq!(listed, ["", "a", "a and b", "a, b and c"]);
    }
}
