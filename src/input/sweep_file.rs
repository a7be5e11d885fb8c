//! Sweep files: from a document to a finished plan, every default filled in, every problem reported where it stands.

use std::path::Path;
use std::sync::Arc;

use super::axis::Swept;
use super::diagnostic::{Diagnostics, Problems};
use super::document::kind::Table;
use super::document::reader::TableReader;
use super::document::row::{Required, Row};
use super::document::{Document, Located};
use super::figures_block::{self, Figures};
use super::keys;
use super::keys::drive::{
    ANGULAR_FREQUENCY, DRIVE_AXIS, FREQUENCY, INDENTER_AXIS, MATERIAL_AXIS, REFINE,
};
use super::keys::material::TEMPERATURE;
use super::keys::settings::{
    CYCLE_ACCURACY, CYCLE_ERROR_BARS, CYCLE_STEPS, CYCLE_TOLERANCE, ENGINE, MAX_CYCLES, METHOD,
    SOLVER_CELLS, SOLVER_SPRINGS, SOLVER_TOLERANCE, TIME_RULE,
};
use super::material_table::DirectSum;
use super::{harmonic_block, indenter_block, material_block};
use crate::drive::HarmonicDrive;
use crate::indenter::Indenter;
use crate::material::Material;
use crate::quantity::{Dimension, FrequencyUnit};
use crate::sweep::figures::figure_plan::FigurePlan;
use crate::sweep::plan::body_material::BodyMaterial;
use crate::sweep::plan::resolved::drive_dimension;
use crate::sweep::plan::{Block, Condition, CyclePlan, SecondAxis, SolverPlan, SweepPlan, Varied};
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
    let controlled = drive_dimension(harmonic_block::control(&mut root));
    let sweep = root
        .table(&keys::SWEEP)
        .and_then(|t| axes(t, controlled, &problems));
    let swept = sweep.as_ref().and_then(|sweep| sweep.swept.as_ref());
    let file = File {
        folder: document.folder(),
        swept,
        problems: &problems,
    };
    let material = file.material(&mut root);
    let indenter = file.block(&mut root, &keys::INDENTER, Block::Indenter, |t| {
        indenter_block::read(t, document.folder(), &problems)
    });
    let drive = file.block(&mut root, &keys::DRIVE, Block::Drive, |t| {
        harmonic_block::read(t, &problems)
    });
    let cycle = root.table_or(&keys::CYCLE, CyclePlan::default(), cycle);
    let default = default_solver(indenter.as_ref().map(|(own, _)| own.as_ref()));
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
        let (figures, cycle, solver) = (figures?, cycle?, solver?);
        let (material, indenter, drive) = (material?, indenter?, drive?);
        let axis = file.axis((&material, &indenter, &drive));
        let sweep = sweep.as_ref()?;
        let mut plan = SweepPlan {
            title: title?,
            material: material.0,
            indenter: indenter.0,
            drive: drive.0,
            angular_frequencies_rad_per_s: sweep.angular_frequencies_rad_per_s.clone(),
            axis,
            refine: sweep.refine,
            cycle,
            solver,
            figures: FigurePlan::default(),
        };
        let scale = || ElasticScale::of_sweep(&plan).map(drop);
        plan.figures = figures.checked(scale, &problems)?;
        Some(plan)
    })();
    problems.into_result(plan)
}

/// What a block says, and what it says with each value of an axis in place of its own; none where the axis is not of this block.
type Over<T> = (T, Vec<T>);

/// Material, indenter and drive.
type Blocks<'a> = (
    &'a Over<Arc<Material>>,
    &'a Over<Arc<dyn Indenter>>,
    &'a Over<HarmonicDrive>,
);

/// What the blocks of a file have in common.
struct File<'a> {
    folder: &'a Path,
    swept: Option<&'a (Block, Swept)>,
    problems: &'a Problems,
}

impl File<'_> {
    /// The axis, where it is of this block.
    fn swept(&self, block: Block) -> Option<&Swept> {
        let (of, swept) = self.swept?;
        (*of == block).then_some(swept)
    }

    /// Reads a block: once, and once more for each value of the axis. Where the block leaves out what the axis varies, the first
    /// value counts.
    fn block<T: Clone>(
        &self,
        root: &mut TableReader<'_>,
        row: &Row<Table, Required>,
        block: Block,
        read: impl Fn(TableReader<'_>) -> Option<T>,
    ) -> Option<Over<T>> {
        let parsed = root.parsed(row);
        let own = root.table(row)?;
        let (Some(swept), Some(parsed)) = (self.swept(block), parsed) else {
            return Some((read(own)?, Vec::new()));
        };
        let place = own.as_ref().clone();
        let with = |value: &f64| {
            let table = swept.put_into(parsed, *value);
            let name = block.name().to_owned();
            read(TableReader::new(&table, place.clone(), name, self.problems))
        };
        let is_given = parsed.entries.contains_key(swept.key);
        let given = if is_given { Some(read(own)?) } else { None };
        let each: Option<Vec<T>> = swept.values.value.iter().map(with).collect();
        let each = each?;
        Some((given.or_else(|| each.first().cloned())?, each))
    }

    fn material(&self, root: &mut TableReader<'_>) -> Option<Over<Arc<Material>>> {
        let for_contact = |material| for_contact(self.problems, material).map(Arc::new);
        let over = |t: TableReader<'_>, axis| {
            material_block::read_over(t, self.folder, DirectSum::Refused, axis, self.problems)
        };
        let of_series = |body: Located<BodyMaterial>| {
            let series = body.value.series().cloned()?;
            Some(body.map(|_| series))
        };
        match self.swept(Block::Material) {
            // One fit gives the material at every temperature.
            Some(swept) if swept.key == TEMPERATURE.name => {
                let (body, each) = over(root.table(&keys::MATERIAL)?, Some(&swept.values))?;
                let place = body.location.clone();
                let at = |material: Material| {
                    for_contact(Located {
                        value: material,
                        path: "material".to_owned(),
                        location: place.clone(),
                    })
                };
                let each: Vec<_> = each.into_iter().map(at).collect::<Option<_>>()?;
                Some((each.first()?.clone(), each))
            }
            _ => self.block(root, &keys::MATERIAL, Block::Material, |t| {
                for_contact(of_series(over(t, None)?.0)?)
            }),
        }
    }

    /// The second axis, where there is one.
    fn axis(&self, (material, indenter, drive): Blocks<'_>) -> Option<SecondAxis> {
        let (block, swept) = self.swept?;
        let values = swept.values.value.iter().enumerate();
        let conditions = values.map(|(k, value)| Condition {
            value: Some(*value),
            material: Arc::clone(material.1.get(k).unwrap_or(&material.0)),
            indenter: Arc::clone(indenter.1.get(k).unwrap_or(&indenter.0)),
            drive: *drive.1.get(k).unwrap_or(&drive.0),
        });
        Some(SecondAxis {
            varied: Varied {
                block: *block,
                key: swept.key,
                dimension: swept.dimension,
            },
            conditions: conditions.collect(),
        })
    }
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
    swept: Option<(Block, Swept)>,
    refine: bool,
}

fn axes(mut table: TableReader<'_>, controlled: Dimension, problems: &Problems) -> Option<Axes> {
    let frequencies = frequencies(&mut table);
    let refine = table.value(&REFINE);
    let mut all = Vec::new();
    let mut is_whole = true;
    for row in [&MATERIAL_AXIS, &INDENTER_AXIS, &DRIVE_AXIS] {
        match table.value(&row.of(controlled)) {
            Some(swept) => all.extend(swept.map(|swept| (row.kind.block, swept))),
            None => is_whole = false,
        }
    }
    table.finish();
    if let [(_, one), (_, other), ..] = all.as_slice() {
        problems
            .at(&one.key_location, "a sweep has one second axis")
            .because("one axis")
            .label(&other.key_location, "another")
            .help("remove all but one, or make several sweeps of it");
        return None;
    }
    let (frequencies, given_in) = frequencies?;
    let swept = all.pop();
    if let Some((_, swept)) = &swept {
        let cases = swept.values.value.len() * frequencies.len();
        if cases > MAX_CASES {
            problems
                .at(
                    &swept.key_location,
                    format!("{cases} cases are more than a sweep may have, {MAX_CASES}"),
                )
                .help("make several sweeps of it");
            return None;
        }
    }
    is_whole.then_some(())?;
    Some(Axes {
        angular_frequencies_rad_per_s: frequencies,
        given_in,
        swept,
        refine: refine?,
    })
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

pub(super) fn cycle(mut table: TableReader<'_>) -> Option<CyclePlan> {
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
