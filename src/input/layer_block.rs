//! The `[layer]` block: the body is a layer on a base, which springs cannot treat; and with it `[solver]`.

use super::document::reader::TableReader;
use super::keys;
use super::keys::layer::{BASE, BASE_MODULUS_RATIO, BASE_POISSON_RATIO, THICKNESS};
use super::keys::settings::{ENGINE, SOLVER_CELLS, SOLVER_SPRINGS, SOLVER_TOLERANCE, TIME_RULE};
use crate::contact::half_space::layer::{Base, YieldingBase};
use crate::engine::EngineError;
use crate::engine::{EngineKind, SolverPlan};
use crate::sweep::plan::layer::LayerPlan;

/// Reads the block; `None` where a problem was reported.
pub(super) fn read(mut table: TableReader<'_>) -> Option<LayerPlan> {
    let (thickness_m, base) = (table.value(&THICKNESS), table.value(&BASE));
    let yielding = yielding(&mut table, base);
    table.finish();
    Some(LayerPlan {
        thickness_m: thickness_m?,
        base: base?,
        yielding: yielding?,
    })
}

/// What the base is made of, where it is not rigid.
fn yielding(table: &mut TableReader<'_>, base: Option<Base>) -> Option<Option<YieldingBase>> {
    let modulus_ratio = table.value(&BASE_MODULUS_RATIO);
    let poisson_ratio = table.value(&BASE_POISSON_RATIO);
    let (problem, help) = match (modulus_ratio?, poisson_ratio?) {
        (None, None) => return Some(None),
        (Some(_), Some(_)) if base == Some(Base::Frictionless) => (
            "a base that yields is one that the layer is bonded to",
            "write `base = \"bonded\"`, or leave out base_modulus_ratio and base_poisson_ratio",
        ),
        (Some(modulus_ratio), Some(poisson_ratio)) => {
            return Some(Some(YieldingBase {
                modulus_ratio,
                poisson_ratio,
            }));
        }
        (Some(_), None) => (
            "a base that yields has a Poisson ratio too",
            "add `base_poisson_ratio = 0.4`, that of the base",
        ),
        (None, Some(_)) => (
            "a rigid base has no Poisson ratio",
            "add `base_modulus_ratio = 4`, the shear modulus of the base over that of the layer, or leave out `base_poisson_ratio`",
        ),
    };
    let place = table.key_location(&BASE_MODULUS_RATIO);
    let place = place.or_else(|| table.key_location(&BASE_POISSON_RATIO))?;
    table.problems().at(&place, problem).help(help);
    None
}

/// Reads the `[solver]` block of a file, which may have a layer; without the block this default counts. `None` where a problem was
/// reported.
pub(super) fn solver(
    root: &mut TableReader<'_>,
    is_layer: bool,
    default: SolverPlan,
) -> Option<SolverPlan> {
    root.table_or(&keys::SOLVER, default, |mut table| {
        let (place, problems) = (table.key_location(&ENGINE), table.problems());
        let engine = table.value(&ENGINE);
        let cells = table.value(&SOLVER_CELLS);
        let springs = table.value(&SOLVER_SPRINGS);
        let tolerance = table.value(&SOLVER_TOLERANCE);
        let time_rule = table.value(&TIME_RULE);
        table.finish();
        let solver = SolverPlan {
            engine: engine?.unwrap_or(default.engine),
            time_rule: time_rule?,
            springs: springs?,
            cells: cells?,
            tolerance: tolerance?,
        };
        if let (true, EngineKind::Axisymmetric, Some(place)) = (is_layer, solver.engine, place) {
            problems
                .at(&place, "springs cannot treat a layer")
                .because(EngineError::SpringsOnLayer.to_string())
                .help("write `engine = \"half-space\"`, or leave it out");
            return None;
        }
        Some(solver)
    })
}

/// Refuses an indenter that yields on a layer: how far each yields under one pressure is then not the same but for a factor.
pub(super) fn refuse_second_body(root: &mut TableReader<'_>, has_indenter_material: bool) {
    if let (true, Some(place)) = (has_indenter_material, root.key_location(&keys::LAYER)) {
        root.problems()
            .at(&place, "a layer is pressed by a rigid indenter only")
            .because("and [indenter.material] makes it yield")
            .help("leave out one of the two");
    }
}
