//! The `[layer]` block: the body is a layer on a base, which springs cannot treat.

use super::diagnostic::Problems;
use super::document::reader::TableReader;
use super::keys;
use super::keys::layer::{BASE, BASE_MODULUS_RATIO, BASE_POISSON_RATIO, THICKNESS};
use super::keys::settings::ENGINE;
use super::sweep_file::solver;
use crate::contact::half_space::layer::{Base, YieldingBase};
use crate::sweep::engine::EngineError;
use crate::sweep::plan::layer::LayerPlan;
use crate::sweep::plan::{EngineKind, SolverPlan};

/// Reads the block; `None` where a problem was reported.
pub(super) fn read(mut table: TableReader<'_>, problems: &Problems) -> Option<LayerPlan> {
    let (thickness_m, base) = (table.value(&THICKNESS), table.value(&BASE));
    let yielding = yielding(&mut table, base, problems);
    table.finish();
    Some(LayerPlan {
        thickness_m: thickness_m?,
        base: base?,
        yielding: yielding?,
    })
}

/// What the base is made of, where it is not rigid.
fn yielding(
    table: &mut TableReader<'_>,
    base: Option<Base>,
    problems: &Problems,
) -> Option<Option<YieldingBase>> {
    let modulus_ratio = table.value(&BASE_MODULUS_RATIO);
    let poisson_ratio = table.value(&BASE_POISSON_RATIO);
    let (modulus_ratio, poisson_ratio) = (modulus_ratio?, poisson_ratio?);
    let place = table.key_location(&BASE_MODULUS_RATIO);
    let place = place.or_else(|| table.key_location(&BASE_POISSON_RATIO));
    let alone = |problem: &str, help: &str| {
        if let Some(place) = &place {
            problems.at(place, problem).help(help);
        }
        None
    };
    match (modulus_ratio, poisson_ratio) {
        (None, None) => Some(None),
        (Some(_), Some(_)) if base == Some(Base::Frictionless) => alone(
            "a base that yields is one that the layer is bonded to",
            "write `base = \"bonded\"`, or leave out base_modulus_ratio and base_poisson_ratio",
        ),
        (Some(modulus_ratio), Some(poisson_ratio)) => Some(Some(YieldingBase {
            modulus_ratio,
            poisson_ratio,
        })),
        (Some(_), None) => alone(
            "a base that yields has a Poisson ratio too",
            "add `base_poisson_ratio = 0.4`, that of the base",
        ),
        (None, Some(_)) => alone(
            "a rigid base has no Poisson ratio",
            "add `base_modulus_ratio = 4`, the shear modulus of the base over that of the layer, or leave out `base_poisson_ratio`",
        ),
    }
}

/// Reads the `[solver]` block of a file with such a body; `None` where a problem was reported.
pub(super) fn solver_on(
    is_layer: bool,
    mut table: TableReader<'_>,
    default: SolverPlan,
    problems: &Problems,
) -> Option<SolverPlan> {
    let place = table.key_location(&ENGINE);
    let solver = solver(table, default)?;
    if let (true, EngineKind::Axisymmetric, Some(place)) = (is_layer, solver.engine, place) {
        problems
            .at(&place, "springs cannot treat a layer")
            .because(EngineError::SpringsOnLayer.to_string())
            .help("write `engine = \"half-space\"`, or leave it out");
        return None;
    }
    Some(solver)
}

/// Refuses an indenter that yields on a layer: how far each yields under one pressure is then not the same but for a factor.
pub(super) fn refuse_second_body(
    root: &mut TableReader<'_>,
    has_counterbody: bool,
    problems: &Problems,
) {
    if let (true, Some(place)) = (has_counterbody, root.key_location(&keys::LAYER)) {
        problems
            .at(&place, "a layer is pressed by a rigid indenter only")
            .because("and [indenter.material] makes it yield")
            .help("leave out one of the two");
    }
}
