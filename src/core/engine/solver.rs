//! Which engine solves a contact, and how fine.

use std::ops::RangeInclusive;

use crate::history::TimeRule;
use crate::indenter::Indenter;
use crate::quantity::block::{Block, Refused};
use crate::quantity::key::{Kind, Limits, tolerance};
use crate::quantity::setting::Table;
use crate::{block_with_defaults, words};

words! {
    /// The two contact engines. Every `match` names both, so that a third would be met everywhere.
    pub enum EngineKind {
        Axisymmetric = "axisymmetric",
        HalfSpace = "half-space",
    }
}

/// Cells along a side.
pub(crate) const CELLS: RangeInclusive<usize> = 8..=4096;
/// Tolerances: below 1, and above what rounding leaves.
pub(crate) const TOLERANCE: Limits = Limits::of(1e-13..1.0);

block_with_defaults! {
    /// Contact engine and its resolution.
    #[derive(Copy)]
    pub struct SolverPlan in "solver" {
        /// The contact engine; left out: the axisymmetric one if the indenter is a convex body of revolution.
        engine: EngineKind = EngineKind::Axisymmetric => "engine", Kind::Word(EngineKind::WORDS), chosen;
        /// Half-space engine: cells along the longer side of the domain; a height map has its own.
        cells: usize = 128 => "cells", Kind::Integer(CELLS);
        /// Axisymmetric engine: springs over the domain.
        springs: usize = 400 => "springs", Kind::Integer(10..=10_000);
        /// Half-space engine: tolerance at one instant; left out: chosen so that its effect on the loss is a tenth of `cycle.tolerance`.
        tolerance: Option<f64> = None => "tolerance", Kind::Number(tolerance("1e-10").within(TOLERANCE));
        /// `linear`: second order, in two stages where one would oscillate; `constant`: the first-order rule of the base paper.
        time_rule: TimeRule = TimeRule::Linear => "time_rule", Kind::Word(TimeRule::WORDS);
    }
}

impl SolverPlan {
    /// Everything at its default: springs where the indenter allows them and the body is no layer, cells elsewhere.
    pub fn of(indenter: &dyn Indenter, on_layer: bool) -> Self {
        let engine = match (indenter.axisymmetric(), on_layer) {
            (Some(_), false) => EngineKind::Axisymmetric,
            _ => EngineKind::HalfSpace,
        };
        Self {
            engine,
            ..Self::DEFAULT
        }
    }

    /// Checks the values that the engine uses.
    ///
    /// # Errors
    /// [`Refused`] with the first that is wrong.
    pub(crate) fn check_used(&self) -> Result<(), Refused> {
        let used = match self.engine {
            EngineKind::Axisymmetric => Self {
                cells: Self::DEFAULT.cells,
                ..*self
            },
            EngineKind::HalfSpace => Self {
                springs: Self::DEFAULT.springs,
                ..*self
            },
        };
        used.check()
    }

    /// As a resolved file has it: an indenter that brings its cells has no other number of them.
    pub(crate) fn table_for(&self, indenter: &dyn Indenter) -> Table {
        let brings_cells = indenter.own_cells().is_some();
        let used = self
            .settings()
            .filter(|s| s.key != "cells" || !brings_cells);
        Table::new(Self::NAME).and(used)
    }

    /// Nodes along the contact's radius (springs) or the domain's longer side (cells), whichever the engine has.
    pub fn nodes(&self) -> usize {
        match self.engine {
            EngineKind::Axisymmetric => self.springs,
            EngineKind::HalfSpace => self.cells,
        }
    }

    /// The same with the cells that an indenter brings, where it brings any.
    #[must_use]
    pub fn on_own_cells(mut self, indenter: &dyn Indenter) -> Self {
        if let Some((cells_x, cells_y)) = indenter.own_cells() {
            self.cells = cells_x.max(cells_y);
        }
        self
    }

    /// The same engine with another number of them.
    #[must_use]
    pub fn with_nodes(mut self, nodes: usize) -> Self {
        match self.engine {
            EngineKind::Axisymmetric => self.springs = nodes,
            EngineKind::HalfSpace => self.cells = nodes,
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::indenter::{HeightMap, MapEdge, MapQuantity, Shifted, Sphere};

    #[test]
    fn the_cells_of_a_map_are_those_of_the_plan_whatever_was_asked_for() {
        let heights = (0..200 * 150).map(|i| 1e-9 * f64::from(i % 7)).collect();
        let map = HeightMap::new(
            (200, 150),
            (1e-6, 1e-6),
            heights,
            MapQuantity::Gap,
            MapEdge::Unknown,
        )
        .unwrap();
        let map: Arc<dyn Indenter> = Arc::new(map);
        let sphere: Arc<dyn Indenter> = Arc::new(Sphere::new(0.01).unwrap());
        let moved = |inner: &Arc<dyn Indenter>| Shifted::new(Arc::clone(inner), 1e-6, 0.0).unwrap();
        let cells = |indenter: &dyn Indenter| SolverPlan::default().on_own_cells(indenter).cells;
        assert_eq!([cells(map.as_ref()), cells(&moved(&map))], [200, 200]);
        assert_eq!([cells(sphere.as_ref()), cells(&moved(&sphere))], [128, 128]);
    }
}
