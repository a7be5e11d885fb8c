//! Sweep files: from a document to a finished plan, every default filled in, every problem reported where it stands.

use super::diagnostic::{Diagnostics, Problems};
use super::document::reader::TableReader;
use super::document::{Document, Located};
use super::figures_block::{self, Figures};
use super::keys;
use super::keys::drive::{ANGULAR_FREQUENCY, AXIS, AXIS_AMPLITUDE, AXIS_MEAN, FREQUENCY, REFINE};
use super::keys::settings::{
    CYCLE_ACCURACY, CYCLE_ERROR_BARS, CYCLE_STEPS, CYCLE_TOLERANCE, ENGINE, MAX_CYCLES, METHOD,
    SOLVER_CELLS, SOLVER_SPRINGS, SOLVER_TOLERANCE, TIME_RULE,
};
use super::material_table::DirectSum;
use super::{harmonic_block, indenter_block, material_block};
use crate::drive::HarmonicDrive;
use crate::indenter::Indenter;
use crate::material::Material;
use crate::quantity::FrequencyUnit;
use crate::sweep::figures::figure_plan::FigurePlan;
use crate::sweep::plan::resolved::drive_dimension;
use crate::sweep::plan::{CyclePlan, DriveAxis, SolverPlan, SweepPlan, Varied};
use crate::sweep::scales::elastic::ElasticScale;

const MAX_CASES: usize = SweepPlan::MAX_CASES;

/// The plan that a sweep file asks for.
///
/// # Errors
/// Everything that is wrong with the file, at once, each problem with its place and what to write instead.
pub fn plan(document: &Document) -> Result<SweepPlan, Diagnostics> {
    let problems = Problems::new();
    let mut root = document.root(&problems);
    let title = root.value(&keys::TITLE);
    let material =
        material_block::read(&mut root, document.folder(), DirectSum::Refused, &problems)
            .and_then(|m| for_contact(&problems, m));
    let indenter = root
        .table(&keys::INDENTER)
        .and_then(|t| indenter_block::read(t, document.folder(), &problems));
    let drive = root
        .table(&keys::DRIVE)
        .and_then(|t| harmonic_block::read(t, &problems));
    let sweep = root
        .table(&keys::SWEEP)
        .and_then(|t| axes(t, drive.as_ref(), &problems));
    let cycle = root.table_or(&keys::CYCLE, CyclePlan::default(), cycle);
    let default = default_solver(indenter.as_deref());
    let solver = root.table_or(&keys::SOLVER, default, |t| solver(t, default));
    let frequencies = sweep.as_ref();
    let frequencies = frequencies.map(|axes| axes.angular_frequencies_rad_per_s.as_slice());
    let given_in = sweep.as_ref().map(|axes| axes.given_in);
    let given_in = given_in.unwrap_or_default();
    let figures = root.table_or(&keys::FIGURES, Figures::of_unit(given_in), |t| {
        figures_block::of_sweep(t, (frequencies, given_in), &problems)
    });
    root.finish();
    let plan = (|| {
        let axes = sweep?;
        let figures = figures?;
        let mut plan = SweepPlan {
            title: title?,
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
pub(super) fn default_solver(indenter: Option<&dyn Indenter>) -> SolverPlan {
    indenter.map_or_else(SolverPlan::default, SolverPlan::of_indenter)
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
                    None if material.value.approximation().is_some() => {
                        "write model = \"zener\" with an equilibrium modulus above zero, or follow one history with \
                         `contact-dma simulate`"
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
    let frequencies = frequencies(&mut table);
    let place = table.key_location(&AXIS);
    let refine = table.value(&REFINE);
    let drives = table.table_or(&AXIS, None, |t| varied(t, drive?, problems).map(Some));
    table.finish();
    let ((frequencies, given_in), drives) = (frequencies?, drives?);
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
        refine: refine?,
    })
}

/// The drives of a second axis: `drive.amplitude` or `drive.mean`, as a list or a range.
fn varied(
    mut table: TableReader<'_>,
    drive: &HarmonicDrive,
    problems: &Problems,
) -> Option<DriveAxis> {
    let axes = [
        (&AXIS_AMPLITUDE as _, (&AXIS_AMPLITUDE, Varied::Amplitude)),
        (&AXIS_MEAN as _, (&AXIS_MEAN, Varied::Mean)),
    ];
    let (row, varied) = table.one_of(&axes)?;
    let location = table.key_location(row);
    let values = table.value(&row.of(drive_dimension(drive.control())));
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
fn frequencies(table: &mut TableReader<'_>) -> Option<(Vec<f64>, FrequencyUnit)> {
    let keys = [
        (
            &ANGULAR_FREQUENCY as _,
            (&ANGULAR_FREQUENCY, 1.0, FrequencyUnit::RadPerS),
        ),
        (
            &FREQUENCY as _,
            (&FREQUENCY, std::f64::consts::TAU, FrequencyUnit::Hz),
        ),
    ];
    let (row, to_angular, given_in) = table.one_of(&keys)?;
    let values = table.value(row)?.into_iter();
    Some((values.map(|value| value * to_angular).collect(), given_in))
}

fn cycle(mut table: TableReader<'_>) -> Option<CyclePlan> {
    let steps = table.value(&CYCLE_STEPS);
    let method = table.value(&METHOD);
    let tolerance = table.value(&CYCLE_TOLERANCE);
    let max_cycles = table.value(&MAX_CYCLES);
    let error_bars = table.value(&CYCLE_ERROR_BARS);
    let accuracy = table.value(&CYCLE_ACCURACY);
    table.finish();
    Some(CyclePlan {
        steps: steps?,
        method: method?,
        tolerance: tolerance?,
        max_cycles: max_cycles?,
        error_bars: error_bars?,
        accuracy: accuracy?,
    })
}

pub(super) fn solver(mut table: TableReader<'_>, default: SolverPlan) -> Option<SolverPlan> {
    let engine = table.value(&ENGINE);
    let cells = table.value(&SOLVER_CELLS);
    let springs = table.value(&SOLVER_SPRINGS);
    let tolerance = table.value(&SOLVER_TOLERANCE);
    let time_rule = table.value(&TIME_RULE);
    table.finish();
    Some(SolverPlan {
        engine: engine?.unwrap_or(default.engine),
        time_rule: time_rule?,
        springs: springs?,
        cells: cells?,
        tolerance: tolerance?,
    })
}
