//! Error bars: the same case on coarser steps and nodes tells how wrong it may be.
//!
//! With values Q at step h and q at step r h, an error of order p leaves (Q - q)/(r^p - 1) of the difference
//! (L. F. Richardson, Phil. Trans. R. Soc. A 210 (1911) 307). Where a third, coarser value is at hand it gives the order
//! observed, which is trusted up to 2 alone, and guards against a difference that vanishes by accident. Steps and nodes are
//! coarsened apart from each other, so that their errors cannot hide each other.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::indenter::{Axisymmetric, Indenter};
use crate::numerics::polynomial::richardson;
use crate::sweep::record::CaseResult;
pub use crate::sweep::record::quantity::Quantity;
use crate::sweep::record::quantity::{Convergence, EdgeRule, InSteps};

/// Where the contact ends on cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Edge {
    /// Anywhere: it moves over the cells in the course of a cycle, and the pressure falls to zero there.
    Smooth,
    /// At an edge of the indenter that is sharp, or nearly so, and stays where it is: the pressure is singular there as far as cells can
    /// tell, and the cells a staircase.
    Sharp,
    /// At the rim of the indenter, to which the cells are fitted (`engine::domain`); the loss goes as this power of its
    /// radius at most.
    Rim { power: f64 },
}

impl Edge {
    /// That of an indenter on the half-space or on a layer, at a contact of this radius on cells of this width (m).
    pub fn of(indenter: &dyn Indenter, on_layer: bool, radius_m: f64, cell_m: f64) -> Self {
        if indenter.rim().is_some() {
            // A thin incompressible layer is as stiff as the fourth power of the radius, a half-space as the first.
            let power = if on_layer { 4.0 } else { 1.0 };
            return Self::Rim { power };
        }
        let is_sharp = match indenter.axisymmetric() {
            Some(body) => is_steep(body, radius_m + cell_m, cell_m),
            None => !indenter.pressure_is_bounded(),
        };
        match is_sharp {
            true => Self::Sharp,
            false => Self::Smooth,
        }
    }
}

/// Whether the transformed gap at the edge of a contact, of this radius (m), grows from nothing within a few cells of this width (m), so
/// that cells cannot tell the edge from a sharp one.
fn is_steep(body: &dyn Axisymmetric, radius_m: f64, cell_m: f64) -> bool {
    const FEW: f64 = 3.0;
    /// Part of the radius over which the slope is taken.
    const PART: f64 = 1e-3;
    let end_m = radius_m.min(body.known_radius_m().unwrap_or(f64::INFINITY));
    let gap_m = body.transformed_gap_m(end_m);
    let rise_m = gap_m - body.transformed_gap_m((1.0 - PART) * end_m);
    gap_m * PART * end_m < FEW * cell_m * rise_m
}

/// What is believed of an error in the nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InNodes {
    /// The highest order of what is smooth in them.
    order: f64,
    /// By what the estimate for the loss is multiplied, and that for any other quantity.
    safety: (f64, f64),
    /// Width (m) of the cells, where the edge of the contact lies between two of them, and the kind of edge.
    cells: Option<(f64, Edge)>,
}

impl InNodes {
    /// On springs, which end where the edge of the contact turns.
    pub const SPRINGS: Self = Self {
        order: 2.0,
        safety: (SAFETY, SAFETY),
        cells: None,
    };

    /// On springs through which attracted edges move: each that an edge reaches within a step is a kink. The factor is from random solids
    /// (`tests/physics/attracted.rs`).
    pub const ATTRACTED: Self = Self {
        order: 1.0,
        safety: (2.0, 2.0),
        ..Self::SPRINGS
    };

    /// On cells of this width (m). Every quantity feels where the edge of the contact lies between two of them, least what a whole
    /// cycle and the whole contact make; for the loss that is predicted (`InNodes::edge_error`), and the difference between grids,
    /// most of which is the coarser one's own edge, tells the rest. Both factors of smooth contacts are from random solids on 48
    /// cells (`tests/physics/random_solids.rs`), whose figures are in the guide on validation; an edge that does not move has no
    /// average over its places.
    pub fn cells(width_m: f64, edge: Edge) -> Self {
        let (order, of_loss) = match edge {
            Edge::Smooth => (1.5, 0.2),
            Edge::Rim { .. } => (1.5, 1.0),
            Edge::Sharp => (1.0, SAFETY),
        };
        Self {
            order,
            safety: (of_loss, 3.0),
            cells: Some((width_m, edge)),
        }
    }

    /// What the place of the edge between two cells leaves in a quantity, absolute.
    ///
    /// A disc of radius a, put down at random on cells of width h, covers so many cells that their number is off by 0.82 (a/h)^(1/2)
    /// (root of the mean square: D. G. Kendall, Quart. J. Math. 19 (1948) 1); half of that, relative, is in the radius, and in the
    /// stiffness at this radius, of which loss and harmonics are made. An edge that moves over m cells in a cycle averages the
    /// stiffness over 1 + 2 m places. The factor of 3 holds the worst places of the edge, which all small amplitudes on the same
    /// number of cells have in common. At a rim the number of cells is right, and three times what their uneven staircase leaves
    /// in the radius counts.
    fn edge_error(self, quantity: Quantity, result: &CaseResult) -> f64 {
        let Some((cell_m, edge)) = self.cells else {
            return 0.0;
        };
        let radius_m = result.contact_radius_m;
        // A contact of less than a cell has no edge that lies between two.
        let part = |radius_m: f64| (radius_m / cell_m).max(1.0).powf(-1.5);
        let rule = quantity.row().edge;
        if let Edge::Rim { power } = edge {
            let relative = power * 3.0 * 0.024 * part(radius_m.maximum);
            return match rule {
                EdgeRule::Loss | EdgeRule::AtRim => {
                    relative * quantity.of(result).map_or(0.0, f64::abs)
                }
                EdgeRule::Harmonic | EdgeRule::Radius(_) | EdgeRule::Nothing => 0.0,
            };
        }
        // A sharp edge, which averages over no places, has the whole width by which a staircase is less stiff than its area.
        let staircase = match edge {
            Edge::Sharp => 0.1155 * cell_m / radius_m.maximum.max(cell_m),
            Edge::Smooth | Edge::Rim { .. } => 0.0,
        };
        let relative = |radius_m: f64| 3.0 * 0.13 * part(radius_m);
        let places = 1.0 + 2.0 * (radius_m.maximum - radius_m.minimum) / cell_m;
        let averaged = relative(0.5 * (radius_m.minimum + radius_m.maximum)) / places;
        match rule {
            EdgeRule::Loss => (averaged + staircase) * quantity.of(result).map_or(0.0, f64::abs),
            EdgeRule::Harmonic => averaged,
            EdgeRule::Radius(of) => relative(of(&radius_m)) * of(&radius_m),
            EdgeRule::AtRim | EdgeRule::Nothing => 0.0,
        }
    }

    fn safety_of(self, quantity: Quantity) -> f64 {
        let (of_loss, of_others) = self.safety;
        match quantity.row().edge {
            EdgeRule::Loss => of_loss,
            EdgeRule::Harmonic | EdgeRule::Radius(_) | EdgeRule::AtRim | EdgeRule::Nothing => {
                of_others
            }
        }
    }

    /// The lowest and the highest order in the nodes that are believed.
    fn orders(self, quantity: Quantity) -> (f64, f64) {
        match quantity.row().in_nodes {
            Convergence::Smooth => (LOWEST_SMOOTH_ORDER, self.order),
            Convergence::Local => (0.3, 1.0),
        }
    }
}

/// The lowest and the highest order in the time steps that are believed, the latter of what the whole cycle makes as given.
fn orders_in_steps(quantity: Quantity, of_cycle: f64) -> (f64, f64) {
    let highest = match quantity.row().in_steps {
        InSteps::OfCycle => of_cycle,
        InSteps::Extreme => of_cycle.min(2.0),
    };
    (LOWEST_SMOOTH_ORDER, highest)
}

/// Estimated errors, absolute, in the units of the quantities.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorBars {
    bars: BTreeMap<Quantity, Bar>,
}

/// The parts of an error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bar {
    /// From the time steps.
    pub steps: f64,
    /// From springs or cells.
    pub nodes: f64,
    /// From the distance to the stabilised cycle.
    pub steady: f64,
    /// From what the data leave open of which the material was fitted.
    pub material: f64,
}

impl Bar {
    /// The whole: parts of unknown sign add up.
    pub fn total(self) -> f64 {
        self.steps + self.nodes + self.steady + self.material
    }
}

/// Two levels that differ in one resolution alone: their results, or their places among levels.
#[derive(Debug, Clone, Copy)]
pub struct Pair<T> {
    pub finer: T,
    pub coarser: T,
    /// How many times finer: steps over steps, or nodes over nodes.
    pub ratio: f64,
}

/// What is known of the error from one resolution: the pair at the result, and, where there is one, the next coarser pair.
#[derive(Debug, Clone, Copy)]
pub struct Refinements<T> {
    pub first: Pair<T>,
    pub second: Option<Pair<T>>,
}

impl<T> Refinements<T> {
    /// The error of the finest, from the differences of both pairs and the lowest and the highest order believed.
    pub(crate) fn error(&self, first: f64, second: Option<f64>, orders: (f64, f64)) -> f64 {
        let ratio = self.second.as_ref().map(|pair| pair.ratio);
        richardson(first, self.first.ratio, second.zip(ratio), orders)
    }
}

/// By what the estimate is multiplied: of 200 random cases, this leaves the true error inside the bar in 95 of 100 and more
/// (`tests/physics/error_bars.rs`), without making the bar useless.
pub(crate) const SAFETY: f64 = 1.5;

/// By what the largest difference that another material makes is multiplied: that material is off, too, by a little.
const MATERIAL_SAFETY: f64 = 1.25;

/// What rounding leaves over the instants of a cycle, relative.
pub(crate) const ROUNDING: f64 = 1e-12;

/// The lowest order believed, in the time steps and in the nodes of what is smooth in them: that of the constant rule.
const LOWEST_SMOOTH_ORDER: f64 = 1.0;

impl ErrorBars {
    /// Errors of `result` from its coarser versions in steps and in nodes, from its distance to the stabilised cycle, and from the
    /// differences that other materials make which the data do not tell from this one. The order is the highest believed.
    pub fn estimate(
        result: &CaseResult,
        (steps, order_in_steps): (&Refinements<&CaseResult>, f64),
        (nodes, believed): (&Refinements<&CaseResult>, InNodes),
        steady_distance: f64,
        alternatives: &[(&CaseResult, &CaseResult)],
    ) -> Self {
        let of_material = |quantity: Quantity| {
            let difference = |(own, other): &(&CaseResult, &CaseResult)| {
                Some((quantity.of(own)? - quantity.of(other)?).abs())
            };
            alternatives
                .iter()
                .filter_map(difference)
                .fold(0.0, f64::max)
        };
        let bar = |quantity: Quantity| {
            Some(Bar {
                steps: SAFETY * error(quantity, steps, orders_in_steps(quantity, order_in_steps))?,
                nodes: believed.safety_of(quantity)
                    * error(quantity, nodes, believed.orders(quantity))?
                    + believed.edge_error(quantity, result),
                steady: (steady_distance + ROUNDING) * quantity.scale(result)?,
                material: MATERIAL_SAFETY * of_material(quantity),
            })
        };
        let bars = Quantity::ALL
            .into_iter()
            .filter_map(|quantity| Some((quantity, bar(quantity)?)))
            .collect();
        Self { bars }
    }

    /// The same for a quantity that may be this much more wrong, which no difference between resolutions told.
    #[must_use]
    pub fn wider(mut self, quantity: Quantity, excess: f64) -> Self {
        if let Some(bar) = self.bars.get_mut(&quantity) {
            bar.steps += excess;
        }
        self
    }

    /// The same for a quantity that is known to be wrong by as much as this.
    #[must_use]
    pub fn at_least(self, quantity: Quantity, error: f64) -> Self {
        let excess = error - self.of(quantity).unwrap_or(error);
        self.wider(quantity, excess.max(0.0))
    }

    /// The error of a quantity.
    pub fn of(&self, quantity: Quantity) -> Option<f64> {
        self.bar(quantity).map(Bar::total)
    }

    /// Its parts.
    pub fn bar(&self, quantity: Quantity) -> Option<Bar> {
        self.bars.get(&quantity).copied()
    }
}

/// Error of the finest value of a refinement; `None` where a value is absent.
fn error(
    quantity: Quantity,
    refinement: &Refinements<&CaseResult>,
    orders: (f64, f64),
) -> Option<f64> {
    let difference = |pair: &Pair<&CaseResult>| {
        let (finer, coarser) = (quantity.of(pair.finer)?, quantity.of(pair.coarser)?);
        Some((finer - coarser).abs())
    };
    let second = match &refinement.second {
        Some(pair) => Some(difference(pair)?),
        None => None,
    };
    Some(refinement.error(difference(&refinement.first)?, second, orders))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error and estimate for a value that approaches 1 like h^order, on the steps h, 2 h and 4 h.
    fn estimate(order: f64, h: f64) -> (f64, f64) {
        let value = |h: f64| 1.0 + h.powf(order);
        let first = value(2.0 * h) - value(h);
        let second = value(4.0 * h) - value(2.0 * h);
        (
            h.powf(order),
            richardson(first, 2.0, Some((second, 2.0)), (0.3, 2.0)),
        )
    }

    #[test]
    fn an_error_of_any_order_up_to_the_second_is_told_exactly() {
        for order in [0.4, 1.0, 1.5, 2.0] {
            let (error, estimate) = estimate(order, 1e-2);
            // Differences of numbers near 1.
            assert!((estimate / error - 1.0).abs() < 1e-9, "{order}");
        }
    }

    #[test]
    fn an_error_of_higher_order_is_told_too_large() {
        let (error, high) = estimate(3.0, 1e-2);
        assert!(high > error);
    }

    #[test]
    fn a_difference_that_vanishes_by_accident_does_not_make_the_error_vanish() {
        let estimate = richardson(0.0, 2.0, Some((1e-3, 2.0)), (1.0, 2.0));
        assert!((estimate - 1e-3 / 12.0).abs() < 1e-18);
        assert_eq!(richardson(0.0, 2.0, Some((0.0, 2.0)), (1.0, 2.0)), 0.0);
        assert_eq!(richardson(3.0, 2.0, None, (1.0, 2.0)), 3.0);
    }
}
