//! The half-space under a surface that repeats itself without end, such as a patch of a rough one: loads up to full contact, and no edge.
//!
//! The displacement of a pressure wave of wave number q is 2 C p / |q| (H. M. Stanley, T. Kato, J. Tribol. 119 (1997) 481), so that
//! transforms of one period, without padding, are all there is to it. The mean pressure lowers a half-space by an infinite amount,
//! which is left out: displacements are measured from the mean plane of the surface, and the approach is that of the indenter to that
//! plane since first touch. It has a bound, the mean gap, at which contact is full.
//!
//! An instant is solved by the conjugate gradients of I. A. Polonsky and L. M. Keer (`PolonskyKeer`) under a prescribed mean pressure.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

pub use super::convolution::PeriodicOperator;
use super::instant::{Imposed, SolverSettings};
use super::polonsky_keer::{InstantProblem, PolonskyKeer, Residual};
use crate::contact::surface::{PressureLine, Response, Surface};
use crate::contact::{
    ContactError, Engine, Instant, Prescribed, Solution, highest, sums, surface_of_cells,
};

/// The engine of one gap field that repeats itself.
pub struct Periodic {
    operator: Arc<PeriodicOperator>,
    settings: SolverSettings,
    gap_m: Vec<f64>,
    solver: PolonskyKeer,
    interrupt: Option<Arc<AtomicBool>>,
}

impl Periodic {
    /// An engine for this gap field (m, one value per cell of one period).
    pub fn new(operator: Arc<PeriodicOperator>, gap_m: Vec<f64>, settings: SolverSettings) -> Self {
        Self {
            solver: PolonskyKeer::new(gap_m.len()),
            interrupt: None,
            settings,
            operator,
            gap_m,
        }
    }
}

impl Engine for Periodic {
    fn gap_m(&self) -> &[f64] {
        &self.gap_m
    }

    fn starts_from_guess(&self) -> bool {
        true
    }

    fn tolerate(&mut self, tolerance: f64) {
        self.settings.tolerance = tolerance;
    }

    fn interrupted_by(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = Some(flag);
    }

    fn solve(
        &mut self,
        instant: &Instant<'_>,
        pressure: &mut [f64],
    ) -> Result<Solution, ContactError> {
        let load_n = match instant.prescribed.check()? {
            Prescribed::LoadN(load_n) => load_n,
            Prescribed::ApproachM(value) => {
                return Err(ContactError::Drive {
                    what: "approach",
                    value,
                    also: ", and a surface that repeats itself takes a load alone",
                });
            }
        };
        let area_m2 = self.operator.grid().cell_area_m2();
        let given = InstantProblem {
            operator: &|p, u, scratch| self.operator.apply(p, u, scratch),
            reference_m: Residual::displacement_range_m,
            settings: self.settings,
            gap_m: &self.gap_m,
            compliance: instant.compliance_per_pa,
            imposed: Imposed::PressureSum(load_n / area_m2),
            interrupt: self.interrupt.as_deref(),
        };
        let solver = &mut self.solver;
        solver.convolutions = 0;
        solver.prepare_free_gap(&given, instant.history)?;
        let (approach_m, iterations) = if load_n == 0.0 {
            pressure.fill(0.0);
            (sums::least(&solver.free_gap_m), 0)
        } else {
            let (residual, iterations) = solver.iterate(&given, pressure, 0)?;
            (residual.mean_approach_m(), iterations)
        };
        let touching = pressure.iter().filter(|p| **p > 0.0).count() as f64;
        Ok(Solution {
            load_n,
            approach_m,
            contact_radius_m: (touching * area_m2 / std::f64::consts::PI).sqrt(),
            iterations,
            convolutions: solver.convolutions,
        })
    }

    fn peak_pressure_pa(
        &mut self,
        pressure: &[f64],
        _solution: &Solution,
    ) -> Result<Option<f64>, ContactError> {
        Ok(Some(highest(pressure)))
    }

    /// None: without an edge there is no punch that is as stiff.
    fn tangent_radius_m(
        &mut self,
        _pressure: &[f64],
        _solution: &Solution,
    ) -> Result<(f64, usize), ContactError> {
        Ok((0.0, 0))
    }

    fn pressure_lines(&self, pressure: &[f64], _solution: &Solution) -> Vec<PressureLine> {
        PressureLine::through_centre(self.operator.grid(), pressure)
    }

    fn elastic_displacement(
        &mut self,
        pressure: &[f64],
        displacement: &mut [f64],
    ) -> Result<usize, ContactError> {
        (self.operator).apply(pressure, displacement, &mut self.solver.scratch)?;
        Ok(1)
    }

    fn load_per_nodal_pressure(&self, _node: usize) -> f64 {
        self.operator.grid().cell_area_m2()
    }

    fn surface(&mut self, response: &Response<'_>) -> Result<Surface, ContactError> {
        let grid = *self.operator.grid();
        surface_of_cells(self, &grid, response)
    }
}
