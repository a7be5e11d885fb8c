//! Sweep files: from a document to a finished plan, every default filled in, every problem reported where it stands.

use super::diagnostic::{Diagnostics, Problems};
use super::document::{Document, Form, Located, TableReader};
use super::figures_block::{self, Figures};
use super::material_table::DirectSum;
use super::{harmonic_block, indenter_block, material_block};
use crate::drive::HarmonicDrive;
use crate::history::TimeRule;
use crate::indenter::Indenter;
use crate::material::Material;
use crate::quantity::{Dimension, FrequencyUnit};
use crate::sweep::figures::figure_plan::FigurePlan;
use crate::sweep::plan::instant_tolerance;
use crate::sweep::plan::{CyclePlan, DriveAxis, EngineKind, Method, SolverPlan, SweepPlan, Varied};
use crate::sweep::scales::elastic::ElasticScale;

const MAX_POINTS: usize = SweepPlan::MAX_POINTS;
const MAX_CASES: usize = SweepPlan::MAX_CASES;

/// The plan that a sweep file asks for.
///
/// # Errors
/// Everything that is wrong with the file, at once, each problem with its place and what to write instead.
pub fn plan(document: &Document) -> Result<SweepPlan, Diagnostics> {
    let problems = Problems::new();
    let mut root = document.root(&problems);
    let title = root.string("title");
    let material =
        material_block::read(&mut root, document.folder(), DirectSum::Refused, &problems)
            .and_then(|m| for_contact(&problems, m));
    let indenter = root
        .table("indenter")
        .and_then(|t| indenter_block::read(t, document.folder(), &problems));
    let drive = root
        .table("drive")
        .and_then(|t| harmonic_block::read(t, &problems));
    let sweep = root
        .table("sweep")
        .and_then(|t| axes(t, drive.as_ref(), &problems));
    let cycle = optional(&mut root, "cycle", CyclePlan::default(), |t| {
        cycle(t, &problems)
    });
    let default = default_solver(indenter.as_deref());
    let solver = optional(&mut root, "solver", default, |t| {
        solver(t, default, &problems)
    });
    let frequencies = sweep.as_ref();
    let frequencies = frequencies.map(|axes| axes.angular_frequencies_rad_per_s.as_slice());
    let given_in = sweep.as_ref().map(|axes| axes.given_in);
    let given_in = given_in.unwrap_or_default();
    let figures = optional(&mut root, "figures", Figures::of_unit(given_in), |t| {
        figures_block::of_sweep(t, (frequencies, given_in), &problems)
    });
    root.finish();
    let plan = (|| {
        let axes = sweep?;
        let figures = figures?;
        let mut plan = SweepPlan {
            title: title?.value,
            material: material?,
            indenter: indenter?,
            drive: drive?,
            angular_frequencies_rad_per_s: axes.angular_frequencies_rad_per_s,
            axis: axes.drives,
            refine: axes.refine,
            cycle: cycle?,
            solver: solver?,
            figures: FigurePlan::default(),
        };
        let scale = || ElasticScale::of_sweep(&plan).map(drop);
        plan.figures = figures.checked(scale, &problems)?;
        Some(plan)
    })();
    problems.into_result(plan)
}

/// The solver where the file asks for none: springs where the indenter allows them, cells elsewhere.
pub(crate) fn default_solver(indenter: Option<&dyn Indenter>) -> SolverPlan {
    indenter.map_or_else(SolverPlan::default, SolverPlan::of_indenter)
}

/// A table that may be left out, with every default.
pub(crate) fn optional<T>(
    root: &mut TableReader<'_>,
    key: &str,
    default: T,
    read: impl FnOnce(TableReader<'_>) -> Option<T>,
) -> Option<T> {
    if root.has(key) {
        root.optional_table(key).and_then(read)
    } else {
        Some(default)
    }
}

/// Refuses materials that cannot be in contact, or whose contact has no stabilised cycle.
fn for_contact(problems: &Problems, material: Located<Material>) -> Option<Material> {
    match material.value.contact_compliance() {
        Err(error) => {
            problems.at(&material, error.to_string());
            None
        }
        Ok(compliance) if compliance.is_fluid() => {
            problems
                .at(
                    &material,
                    "this material is a fluid, and a sweep looks for a stabilised cycle",
                )
                .because("creeps without end under a mean load")
                .help(match material.value.fit() {
                    Some(_) => {
                        "write `flow = false` in [material.table] for the solid that fits best, or follow one history \
                         with `contact-dma simulate`"
                    }
                    None => "give it an equilibrium modulus above zero, or leave out its viscosity",
                });
            None
        }
        Ok(_) => Some(material.value),
    }
}

/// The `[sweep]` block.
struct Axes {
    angular_frequencies_rad_per_s: Vec<f64>,
    given_in: FrequencyUnit,
    drives: Option<DriveAxis>,
    refine: bool,
}

fn axes(
    mut table: TableReader<'_>,
    drive: Option<&HarmonicDrive>,
    problems: &Problems,
) -> Option<Axes> {
    let frequencies = frequencies(&mut table, problems);
    let place = table.key_location("drive");
    let refine = table.boolean_or("refine", false);
    let varied = match table.has("drive") {
        true => Some(
            table
                .table("drive")
                .and_then(|t| varied(t, drive?, problems)),
        ),
        false => None,
    };
    table.finish();
    let drives = match varied {
        Some(axis) => Some(axis?),
        None => None,
    };
    let (frequencies, given_in) = frequencies?;
    let cases = drives.as_ref().map_or(1, |axis| axis.drives.len()) * frequencies.len();
    if cases > MAX_CASES
        && let Some(place) = place
    {
        problems
            .at(
                &place,
                format!("{cases} cases are more than a sweep may have, {MAX_CASES}"),
            )
            .help("make several sweeps of it");
        return None;
    }
    Some(Axes {
        angular_frequencies_rad_per_s: frequencies,
        given_in,
        drives,
        refine: refine?.value,
    })
}

/// The drives of a second axis: `drive.amplitude` or `drive.mean`, as a list or a range.
fn varied(
    mut table: TableReader<'_>,
    drive: &HarmonicDrive,
    problems: &Problems,
) -> Option<DriveAxis> {
    let (key, varied) =
        table.one_of(&[("amplitude", Varied::Amplitude), ("mean", Varied::Mean)])?;
    let dimension = harmonic_block::dimension(drive.control());
    let location = table.key_location(key);
    let values = match table.form(key) {
        Some(Form::Table) => table
            .table(key)
            .and_then(|t| range(t, problems, key, dimension)),
        _ => list(&mut table, problems, key, dimension),
    };
    table.finish();
    let (values, location) = (values?, location?);
    let mut drives = Vec::with_capacity(values.len());
    for value in values {
        match varied.drive(drive, value) {
            Ok(drive) => drives.push(drive),
            Err(error) => {
                problems.at(&location, error.to_string());
                return None;
            }
        }
    }
    Some(DriveAxis { varied, drives })
}

/// Angular frequencies in rad/s, ascending, and the unit they are given in.
fn frequencies(
    table: &mut TableReader<'_>,
    problems: &Problems,
) -> Option<(Vec<f64>, FrequencyUnit)> {
    let (key, (dimension, to_angular)) = table.one_of(&harmonic_block::FREQUENCIES)?;
    let values = match table.form(key) {
        Some(Form::Table) => table
            .table(key)
            .and_then(|t| range(t, problems, key, dimension)),
        _ => list(table, problems, key, dimension),
    };
    let given_in = match dimension {
        Dimension::Frequency => FrequencyUnit::Hz,
        _ => FrequencyUnit::RadPerS,
    };
    let angular = values?.into_iter().map(|value| value * to_angular);
    Some((angular.collect(), given_in))
}

fn list(
    table: &mut TableReader<'_>,
    problems: &Problems,
    key: &str,
    dimension: Dimension,
) -> Option<Vec<f64>> {
    let what = spoken(key);
    let mut list = table.quantities(key, dimension)?;
    if list.value.is_empty() || list.value.len() > MAX_POINTS {
        let message = if list.value.is_empty() {
            "the sweep is empty".to_owned()
        } else {
            format!("a sweep has at most {MAX_POINTS} points")
        };
        let example = format!("{key} = [\"{}\"]", dimension.example());
        problems
            .at(&list, message)
            .help(format!("give at least one {what}, for example {example}"));
        return None;
    }
    let mut fine = true;
    for value in list.value.iter().filter(|v| v.value <= 0.0) {
        problems.at(value, format!("every {what} must be above zero"));
        fine = false;
    }
    list.value.sort_by(|a, b| a.value.total_cmp(&b.value));
    for pair in list.value.windows(2).filter(|p| p[0].value == p[1].value) {
        problems
            .at(&pair[1], format!("this {what} is listed twice"))
            .label(&pair[0], "the other one");
        fine = false;
    }
    fine.then(|| list.value.into_iter().map(|v| v.value).collect())
}

/// A key as a word of a sentence.
fn spoken(key: &str) -> String {
    key.replace('_', " ")
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Spacing {
    Logarithmic,
    Linear,
}

const SPACINGS: [(&str, Spacing); 2] = [("log", Spacing::Logarithmic), ("linear", Spacing::Linear)];

fn range(
    mut table: TableReader<'_>,
    problems: &Problems,
    key: &str,
    dimension: Dimension,
) -> Option<Vec<f64>> {
    let from = table.quantity("from", dimension);
    let to = table.quantity("to", dimension);
    let points = table.positive_integer("points", 1..=MAX_POINTS);
    let spacing = table.choice_of_or("spacing", &SPACINGS, Spacing::Logarithmic);
    table.finish();
    let (from, to, points, spacing) = (from?, to?, points?, spacing?);
    let what = spoken(key);
    if from.value <= 0.0 {
        problems.at(&from, format!("every {what} must be above zero"));
        return None;
    }
    if points.value == 1 && to.value == from.value {
        return Some(vec![from.value]);
    }
    if to.value <= from.value {
        problems
            .at(&to, "the sweep ends before it begins")
            .because("not above the first point")
            .label(&from, "its first point");
        return None;
    }
    if points.value < 2 {
        problems
            .at(&points, "a range needs at least 2 points, its two ends")
            .help("for one point write a list with one entry");
        return None;
    }
    Some(spaced(from.value, to.value, points.value, spacing.value))
}

/// `points` values from `from` to `to`, both exact.
fn spaced(from: f64, to: f64, points: usize, spacing: Spacing) -> Vec<f64> {
    let last = points - 1;
    let between = |a: f64, b: f64, i: usize| a + (b - a) * i as f64 / last as f64;
    (0..points)
        .map(|i| match i {
            0 => from,
            _ if i == last => to,
            _ => match spacing {
                // Through decimal logarithms, so that decades come out as written.
                Spacing::Logarithmic => 10_f64.powf(between(from.log10(), to.log10(), i)),
                Spacing::Linear => between(from, to, i),
            },
        })
        .collect()
}

fn cycle(mut table: TableReader<'_>, problems: &Problems) -> Option<CyclePlan> {
    let default = CyclePlan::default();
    let steps = table.positive_integer_or("steps", CyclePlan::STEPS, default.steps);
    let methods = [Method::Direct, Method::March].map(|m| (m.name(), m));
    let method = table.choice_of_or("method", &methods, default.method);
    let tolerance = tolerance(&mut table, problems, default.tolerance);
    let max_cycles =
        table.positive_integer_or("max_cycles", CyclePlan::MAX_CYCLES, default.max_cycles);
    let error_bars = table.boolean_or("error_bars", default.error_bars);
    let accuracy = match table.has("accuracy") {
        true => Some(accuracy(&mut table, problems)),
        false => None,
    };
    table.finish();
    let accuracy = match accuracy {
        Some(accuracy) => Some(accuracy?),
        None => default.accuracy,
    };
    Some(CyclePlan {
        steps: steps?.value,
        method: method?.value,
        tolerance: tolerance?,
        max_cycles: max_cycles?.value,
        error_bars: error_bars?.value,
        accuracy,
    })
}

pub(crate) fn solver(
    mut table: TableReader<'_>,
    default: SolverPlan,
    problems: &Problems,
) -> Option<SolverPlan> {
    let engines = [EngineKind::Axisymmetric, EngineKind::HalfSpace].map(|e| (e.name(), e));
    let engine = table.choice_of_or("engine", &engines, default.engine);
    let cells = table.positive_integer_or("cells", SolverPlan::CELLS, default.cells);
    let springs = table.positive_integer_or("springs", SolverPlan::SPRINGS, default.springs);
    let tolerance = match table.has("tolerance") {
        true => tolerance(&mut table, problems, instant_tolerance::OF_A_HISTORY).map(Some),
        false => Some(default.tolerance),
    };
    let rules = [
        ("linear", TimeRule::Linear),
        ("constant", TimeRule::Constant),
    ];
    let time_rule = table.choice_of_or("time_rule", &rules, default.time_rule);
    table.finish();
    Some(SolverPlan {
        engine: engine?.value,
        time_rule: time_rule?.value,
        springs: springs?.value,
        cells: cells?.value,
        tolerance: tolerance?,
    })
}

/// A relative accuracy of the loss: below 1, and above what the finest resolution could reach.
fn accuracy(table: &mut TableReader<'_>, problems: &Problems) -> Option<f64> {
    let accuracy = table.number("accuracy")?;
    if CyclePlan::ACCURACY.contains(&accuracy.value) {
        return Some(accuracy.value);
    }
    problems
        .at(&accuracy, "an accuracy lies between 1e-8 and 1")
        .help("for example accuracy = 1e-3, a thousandth of the loss");
    None
}

/// A relative tolerance: below 1, and above what rounding leaves.
fn tolerance(table: &mut TableReader<'_>, problems: &Problems, default: f64) -> Option<f64> {
    let tolerance = table.number_or("tolerance", default)?;
    if CyclePlan::TOLERANCE.contains(&tolerance.value) {
        return Some(tolerance.value);
    }
    problems
        .at(&tolerance, "a tolerance lies between 1e-13 and 1")
        .help(format!("for example tolerance = {default:e}"));
    None
}
