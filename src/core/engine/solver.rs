//! Which engine solves a contact, and how fine.

use crate::history::TimeRule;
use crate::indenter::Indenter;

/// Which engine, and how fine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverPlan {
    pub engine: EngineKind,
    pub time_rule: TimeRule,
    /// Axisymmetric engine: springs over the domain.
    pub springs: usize,
    /// Half-space engine: cells along the longer side of the domain; those of the indenter where it is a map.
    pub cells: usize,
    /// Half-space engine: tolerance of one instant, see [`crate::contact::half_space::SolverSettings`]; where none is given, what
    /// the loss asks for, see [`crate::engine::instant_tolerance`].
    pub tolerance: Option<f64>,
}

/// The two contact engines. Every `match` names both, so that a third would be met everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EngineKind {
    Axisymmetric,
    HalfSpace,
}

impl EngineKind {
    /// The name as written in a sweep file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Axisymmetric => "axisymmetric",
            Self::HalfSpace => "half-space",
        }
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

impl SolverPlan {
    /// What counts where nothing is asked for.
    pub const DEFAULT: Self = Self {
        engine: EngineKind::Axisymmetric,
        time_rule: TimeRule::Linear,
        springs: 400,
        cells: 128,
        tolerance: None,
    };
}

impl Default for SolverPlan {
    fn default() -> Self {
        Self::DEFAULT
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
