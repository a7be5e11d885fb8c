//! Sweep files: from a document to a finished plan, every default filled in, every problem reported where it stands.

mod conditions;

use super::axis::{self, Axis};
use super::diagnostic::{Diagnostics, Problems};
use super::document::reader::TableReader;
use super::document::{Document, block};
use super::figures_block::{self, Figures};
use super::given::Given;
use super::keys::drive::{
    ANGULAR_FREQUENCY, DRIVE_AXIS, FREQUENCY, INDENTER_AXIS, LAYER_AXIS, MATERIAL_AXIS,
};
use super::{harmonic_block, keys, solver_block};
use crate::engine::SolverPlan;
use crate::figures::elastic::ElasticScale;
use crate::quantity::{Dimension, FrequencyUnit};
use crate::sweep::plan::REFINE;
use crate::sweep::plan::axes::MOST as MOST_AXES;
use crate::sweep::plan::axes::PAIRS;
use crate::sweep::plan::figures::FigurePlan;
use crate::sweep::plan::{CyclePlan, SweepPlan};
use conditions::Blocks;

const MAX_CASES: usize = SweepPlan::MAX_CASES;

/// The plan that a sweep file asks for.
///
/// # Errors
/// Everything that is wrong with the file, at once, each problem with its place and what to write instead.
pub fn plan(document: &Document) -> Result<SweepPlan, Diagnostics> {
    plan_with(document, &Given::default())
}

/// The same, with values for blocks that the file leaves out.
///
/// # Errors
/// As [`plan`].
pub fn plan_with(document: &Document, given: &Given) -> Result<SweepPlan, Diagnostics> {
    document.read_whole(|root| {
        let problems = root.problems();
        let title = root.value(&keys::TITLE);
        let prescribed = harmonic_block::prescribed(root);
        let sweep = root.table(&keys::SWEEP);
        let sweep = sweep.and_then(|table| read(table, prescribed.dimension()));
        let sweep = sweep.as_ref();
        let blocks = Blocks::read(root, sweep, given);
        let cycle = root.table_or(&keys::CYCLE, CyclePlan::default(), |mut t| {
            let to_accuracy = t.place_of("accuracy").is_some();
            block::read(t, to_accuracy.then_some(&CyclePlan::TO_AN_ACCURACY))
        });
        let layer = blocks.layer.iter().flatten().next();
        let is_layer = layer.is_some_and(Option::is_some);
        let default = blocks.indenter.as_deref().and_then(|indenters| {
            // Cells can do what springs cannot.
            let mut all = indenters.iter();
            let on_cells = all.find(|indenter| indenter.axisymmetric().is_none());
            let indenter = on_cells.or(indenters.first())?;
            Some(SolverPlan::of(indenter.as_ref(), is_layer))
        });
        let solver = solver_block::read(root, is_layer, default.unwrap_or_default());
        let frequencies = sweep.map(|sweep| sweep.angular_frequencies_rad_per_s.as_slice());
        let given_in = sweep.map(|sweep| sweep.given_in).unwrap_or_default();
        let figures = root.table_or(&keys::FIGURES, Figures::of_unit(given_in), |t| {
            figures_block::of_sweep(t, (frequencies, given_in))
        });
        let (figures, cycle) = (figures?, cycle?);
        let sweep = sweep?;
        let (base, axes) = blocks.into_plan(sweep)?;
        let mut plan = SweepPlan {
            title: title?,
            base,
            axes,
            solver: solver?,
            angular_frequencies_rad_per_s: sweep.angular_frequencies_rad_per_s.clone(),
            refine: sweep.refine,
            cycle,
            figures: FigurePlan::default(),
        };
        let scale = || ElasticScale::of_sweep(&plan).map(drop);
        plan.figures = figures.checked(scale, problems)?;
        Some(plan)
    })
}

/// The `[sweep]` block.
struct Sweep {
    angular_frequencies_rad_per_s: Vec<f64>,
    given_in: FrequencyUnit,
    axes: Vec<Axis>,
    pairs: bool,
    refine: bool,
}

fn read(mut table: TableReader<'_>, controlled: Dimension) -> Option<Sweep> {
    let problems = table.problems();
    let frequencies = frequencies(&mut table);
    let refine = table.value(&REFINE);
    let pairs = table.value(&PAIRS);
    let (mut axes, mut is_whole) = (Vec::new(), true);
    for key in [MATERIAL_AXIS, LAYER_AXIS, INDENTER_AXIS, DRIVE_AXIS] {
        let found = axis::read(&mut table, &key, controlled, pairs.unwrap_or(false));
        is_whole &= found.is_some();
        axes.extend(found.into_iter().flatten());
    }
    table.finish();
    let ((frequencies, given_in), pairs) = (frequencies?, pairs?);
    check_axes(&axes, pairs, frequencies.len(), problems)?;
    is_whole.then_some(())?;
    if pairs {
        in_order_of_numbers(&mut axes);
    }
    Some(Sweep {
        angular_frequencies_rad_per_s: frequencies,
        given_in,
        axes,
        pairs,
        refine: refine?,
    })
}

/// Puts pairs in ascending order of their numbers, and what is listed beside them in the same order.
fn in_order_of_numbers(axes: &mut [Axis]) {
    let pairs = axes.first().map_or(0, Axis::count);
    let numbers: Vec<_> = axes.iter().filter_map(Axis::numbers).collect();
    let of_pair = |k: usize| numbers.iter().map(move |numbers| numbers.value[k]);
    let mut order: Vec<usize> = (0..pairs).collect();
    order.sort_by(|a, b| {
        let order = of_pair(*a).partial_cmp(of_pair(*b));
        order.unwrap_or(std::cmp::Ordering::Equal)
    });
    axes.iter_mut().for_each(|axis| axis.reorder(&order));
}

/// What axes must not be together.
fn check_axes(axes: &[Axis], pairs: bool, frequencies: usize, problems: &Problems) -> Option<()> {
    let (Some(first), Some(last)) = (axes.first(), axes.last()) else {
        return Some(());
    };
    if axes.len() > MOST_AXES {
        let what = format!("a sweep has at most {MOST_AXES} axes besides the frequency");
        problems
            .at(&last.key, what)
            .help("remove one, or make several sweeps of it");
        return None;
    }
    let differs = |axis: &&Axis| pairs && axis.count() != first.count();
    if let Some(other) = axes.iter().find(differs) {
        let what = "pairs need as many values on every axis";
        problems
            .at(&other.key, what)
            .because(format!("{} values", other.count()))
            .label(&first.key, format!("{} values", first.count()))
            .help("give as many, or remove `pairs` for all combinations");
        return None;
    }
    let conditions = match pairs {
        true => first.count(),
        false => axes.iter().map(Axis::count).fold(1, usize::saturating_mul),
    };
    let cases = conditions.saturating_mul(frequencies);
    if cases > MAX_CASES {
        problems
            .at(
                &last.key,
                format!("{cases} cases are more than a sweep may have, {MAX_CASES}"),
            )
            .help("make several sweeps of it");
        return None;
    }
    Some(())
}

/// Angular frequencies in rad/s, ascending, and the unit they are given in.
fn frequencies(table: &mut TableReader<'_>) -> Option<(Vec<f64>, FrequencyUnit)> {
    let in_hz = (&FREQUENCY, std::f64::consts::TAU, FrequencyUnit::Hz);
    let keys = [
        (
            &ANGULAR_FREQUENCY,
            (&ANGULAR_FREQUENCY, 1.0, FrequencyUnit::RadPerS),
        ),
        (&FREQUENCY, in_hz),
    ];
    let (row, to_angular, given_in) = table.one_of(&keys)?;
    let values: Vec<f64> = table.value(row)?;
    let values = values.into_iter().map(|value| value * to_angular);
    Some((values.collect(), given_in))
}
