//! The `[layer]` block: the body is a layer on a rigid base, which springs cannot treat.

use super::diagnostic::Problems;
use super::document::Located;
use super::document::reader::TableReader;
use super::keys;
use super::keys::layer::{BASE, THICKNESS};
use super::keys::settings::ENGINE;
use super::sweep_file::solver;
use crate::material::Material;
use crate::sweep::engine::EngineError;
use crate::sweep::plan::layer::LayerPlan;
use crate::sweep::plan::{EngineKind, SolverPlan};

/// Reads the block; `None` where a problem was reported.
pub(super) fn read(mut table: TableReader<'_>) -> Option<LayerPlan> {
    let (thickness_m, base) = (table.value(&THICKNESS), table.value(&BASE));
    table.finish();
    Some(LayerPlan {
        thickness_m: thickness_m?,
        base: base?,
    })
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
    counterbody: Option<&Option<Located<Material>>>,
    problems: &Problems,
) {
    if let (Some(Some(_)), Some(place)) = (counterbody, root.key_location(&keys::LAYER)) {
        problems
            .at(&place, "a layer is pressed by a rigid indenter only")
            .because("and [indenter.material] makes it yield")
            .help("leave out one of the two");
    }
}
