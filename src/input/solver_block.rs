//! The `[solver]` block; and what a layer excludes: springs, and an indenter that yields.

use super::document::block;
use super::document::reader::TableReader;
use super::keys;
use crate::engine::{EngineError, EngineKind, SolverPlan};

/// Reads the `[solver]` block of a file, which may have a layer; without the block this default counts. `None` where a problem was
/// reported.
pub(super) fn read(
    root: &mut TableReader<'_>,
    is_layer: bool,
    default: SolverPlan,
) -> Option<SolverPlan> {
    root.table_or(&keys::SOLVER, default, |mut table| {
        let (place, problems) = (table.place_of("engine"), table.problems());
        let solver = block::read(table, Some(&default))?;
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
