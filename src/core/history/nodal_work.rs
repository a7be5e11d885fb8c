//! The work that an indenter does at every node of the surface, over a number of equal steps.
//!
//! Where the indenter touches, the surface moves with it: the work at a node is the integral of p d(delta) for as long as the node is
//! in contact. Between two instants at which it is, a trapezium is right to second order. The edge of the contact passes a node between
//! two instants, and a trapezium over the whole step would add one tooth per step to the density of the work along the surface,
//! of the size of the work itself where little of it is lost.
//!
//! A node that is met within a step is in contact for the last part f of it, and its pressure rises from zero in that part alone. The
//! gap g that it had at the start of the step and the penetration d that its pressure p has prevented at the end tell f:
//!
//! ```text
//! f = d / (d + g),      d = B_0 (q - q_free),      p' = (q - q_free) / A(f h)
//! ```
//!
//! with B_0 what a node does to itself, q the hereditary integral at the end of the step of length h, q_free what it would be there
//! without any pressure in the step, and A(t) the compliance for a pressure that grows linearly over the time t: that over the
//! whole step would make the pressure too low. The work is p'/2 for the travel f d(delta). A node that is left within the step is in
//! contact for its first part f, as long as it takes its pressure to fall from p to zero on its way to the pull that would have
//! kept the gap closed which it has at the end.
//!
//! What this takes off the trapezia is the work of nodes at the edge, whose pressure curves most. So that the sum over all nodes stays
//! the area of the polygon through the loop, all work is multiplied by one factor in the end, which tends to one with the second
//! order of the step.

use super::memory::Memory;
use super::rule::linear_weight;
use crate::contact::{ContactError, Engine, sums};
use crate::material::Creep;

/// Work of a number of equal steps of a cycle, added up per node.
pub struct NodalWork {
    compliance: Creep,
    step_s: f64,
    /// The part of itself that each branch loses in a step without pressure.
    forgotten: Vec<f64>,
    /// B_0: displacement of a node by its own pressure (per unit of both compliance and pressure).
    own: f64,
    /// Approach (m) and load (N) at the beginning.
    began: Option<(f64, f64)>,
    last: Option<WorkInstant>,
    /// Integral of p d(delta) per node, and what of the trapezia (J) it leaves out.
    work: Vec<f64>,
    left_out_j: f64,
}

/// An instant: the approach (m), and nodal values.
struct WorkInstant {
    approach_m: f64,
    pressure: Vec<f64>,
    /// The hereditary integral q; once work has been added up to here, q_free at the end of the next step.
    hereditary: Vec<f64>,
    gap_m: Vec<f64>,
}

impl NodalWork {
    /// No work yet on a body of this contact compliance, in steps of `step_s` over `nodes` nodes.
    pub fn new(compliance: &Creep, nodes: usize, step_s: f64) -> Self {
        let branches = compliance.branches().iter();
        Self {
            forgotten: branches.map(|b| -(-step_s / b.time_s).exp_m1()).collect(),
            compliance: compliance.clone(),
            step_s,
            own: 0.0,
            began: None,
            last: None,
            work: vec![0.0; nodes],
            left_out_j: 0.0,
        }
    }

    /// Takes in an instant of this approach, hereditary integral q and displacement B q (m): that at the beginning, then that at the end of
    /// every step. Returns the convolutions that took.
    pub(super) fn see(
        &mut self,
        engine: &mut dyn Engine,
        (approach_m, pressure): (f64, &[f64]),
        (hereditary, memory): (Vec<f64>, &Memory),
        displacement_m: Vec<f64>,
    ) -> Result<usize, ContactError> {
        let mut convolutions = 0;
        let mut gap_m = displacement_m;
        for (gap, initial) in gap_m.iter_mut().zip(engine.gap_m()) {
            *gap += initial - approach_m;
        }
        let mut instant = WorkInstant {
            approach_m,
            pressure: pressure.to_vec(),
            hereditary,
            gap_m,
        };
        match self.last.take() {
            Some(start) => self.add(engine, &start, &instant),
            None => {
                self.began = Some((approach_m, load_n(engine, pressure)));
                convolutions += self.find_own(engine)?;
            }
        }
        let branches = self.compliance.branches().iter().zip(&self.forgotten);
        let memories = memory.variables().chunks_exact(pressure.len().max(1));
        for ((branch, forgotten), memory) in branches.zip(memories) {
            let forgotten = -branch.compliance_per_pa * forgotten;
            sums::add_scaled(&mut instant.hereditary, forgotten, memory);
        }
        self.last = Some(instant);
        Ok(convolutions)
    }

    /// The work per node, in the unit of the nodal pressure times a metre, that adds up to the area of the polygon through the loop.
    pub(super) fn of_loop(&self, engine: &dyn Engine) -> Vec<f64> {
        // The line from the last sample to the first closes the polygon.
        let closing = self.began.zip(self.last.as_ref()).map(|(began, last)| {
            let loads_n = began.1 + load_n(engine, &last.pressure);
            0.5 * loads_n * (began.0 - last.approach_m)
        });
        let added_j = self.left_out_j + closing.unwrap_or(0.0);
        // Of a body that loses nothing both are rounding.
        let factor = Some(1.0 + added_j / load_n(engine, &self.work));
        let factor = factor.filter(|factor| factor.is_finite() && *factor > 0.0);
        let factor = factor.unwrap_or(1.0);
        self.work.iter().map(|work| factor * work).collect()
    }

    fn find_own(&mut self, engine: &mut dyn Engine) -> Result<usize, ContactError> {
        let mut unit = vec![0.0; engine.nodes()];
        let mut displacement = unit.clone();
        // Of the cells of a quarter, the last is the farthest from its images.
        if let Some(last) = unit.last_mut() {
            *last = 1.0;
        }
        let convolutions = engine.elastic_displacement(&unit, &mut displacement)?;
        self.own = displacement.last().copied().unwrap_or_default();
        Ok(convolutions)
    }

    /// Adds the work of a step.
    fn add(&mut self, engine: &dyn Engine, start: &WorkInstant, end: &WorkInstant) {
        let travel_m = end.approach_m - start.approach_m;
        let pressures = start.pressure.iter().zip(&end.pressure);
        for (node, (&old, &new)) in pressures.enumerate() {
            let part = match (old > 0.0, new > 0.0) {
                (true, true) => 1.0,
                (false, true) => self.part_of_met(node, start, end),
                (true, false) => {
                    let pressed_m = self.own * self.compliance_over(1.0) * old;
                    part(pressed_m, end.gap_m[node])
                }
                (false, false) => continue,
            };
            let trapezium = 0.5 * (old + new) * travel_m;
            self.work[node] += part * trapezium;
            self.left_out_j += engine.load_per_nodal_pressure(node) * (1.0 - part) * trapezium;
        }
    }

    /// The part of its trapezium that is the work of a node met within the step: f p'/p.
    fn part_of_met(&self, node: usize, start: &WorkInstant, end: &WorkInstant) -> f64 {
        let pressed = end.hereditary[node] - start.hereditary[node];
        let part = part(self.own * pressed, start.gap_m[node]);
        part * pressed / (self.compliance_over(part) * end.pressure[node])
    }

    /// A (1/Pa) for a pressure that grows linearly over this part of a step.
    fn compliance_over(&self, part: f64) -> f64 {
        let time_s = part * self.step_s;
        let branches = self.compliance.branches().iter();
        let delayed = branches.map(|b| b.compliance_per_pa * linear_weight(time_s / b.time_s));
        let flown = (self.compliance.viscosity_pa_s()).map(|eta| 0.5 * time_s / eta);
        self.compliance.instantaneous_compliance() + delayed.chain(flown).sum::<f64>()
    }
}

/// The load of a nodal pressure.
fn load_n(engine: &dyn Engine, pressure: &[f64]) -> f64 {
    let nodes = pressure.iter().enumerate();
    nodes
        .map(|(node, p)| engine.load_per_nodal_pressure(node) * p)
        .sum()
}

/// d / (d + g), of lengths that rounding may have made negative.
fn part(pressed_m: f64, gap_m: f64) -> f64 {
    match pressed_m > 0.0 {
        true => pressed_m / (pressed_m + gap_m.max(0.0)),
        false => 0.0,
    }
}
