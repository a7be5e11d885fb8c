//! The half-space under a surface that repeats itself without end, such as a patch of a rough one: loads up to full contact, and no edge.
//!
//! The displacement of a pressure wave of wave number q is 2 C p / |q| (H. M. Stanley, T. Kato, J. Tribol. 119 (1997) 481), so that
//! transforms of one period, without padding, are all there is to it. The mean pressure lowers a half-space by an infinite amount,
//! which is left out: displacements are measured from the mean plane of the surface, and the approach is that of the indenter to that
//! plane since first touch. It has a bound, the mean gap, at which contact is full.
//!
//! An instant is solved by the conjugate gradients of I. A. Polonsky and L. M. Keer (Wear 231 (1999) 206) under a prescribed mean pressure.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

pub use super::convolution::PeriodicOperator;
use super::convolution::Scratch;
use super::solver::SolverSettings;
use crate::contact::surface::{PressureLine, Response, Surface};
use crate::contact::{
    ContactError, Engine, Instant, Prescribed, Solution, go_on, highest, sums, surface_of_cells,
};

/// The engine of one gap field that repeats itself.
pub struct Periodic {
    operator: Arc<PeriodicOperator>,
    settings: SolverSettings,
    gap_m: Vec<f64>,
    scratch: Scratch,
    /// The gap that history leaves without pressure, gap under load, search direction, what the operator makes of it.
    open_m: Vec<f64>,
    residual_m: Vec<f64>,
    direction: Vec<f64>,
    response_m: Vec<f64>,
    interrupt: Option<Arc<AtomicBool>>,
}

/// Rounding of a displacement, as a part of the largest: some units in the last place.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// How far a pressure is from the solution.
struct Residual {
    approach_m: f64,
    /// The mean |gap| in contact, weighted by the pressure, the deepest penetration outside, and what either may be (m).
    inside_m: f64,
    penetration_m: f64,
    allowed_m: f64,
    /// The mean gap in contact (m).
    mean_m: f64,
}

impl Periodic {
    /// An engine for this gap field (m, one value per cell of one period).
    pub fn new(operator: Arc<PeriodicOperator>, gap_m: Vec<f64>, settings: SolverSettings) -> Self {
        let field = || vec![0.0; gap_m.len()];
        Self {
            scratch: Scratch::default(),
            open_m: field(),
            residual_m: field(),
            direction: field(),
            response_m: field(),
            interrupt: None,
            settings,
            operator,
            gap_m,
        }
    }

    /// The gap of an undeformed period and what the history has left of the surface; the convolutions that took.
    fn open_gap(&mut self, history: &[f64]) -> Result<usize, ContactError> {
        if history.iter().all(|h| *h == 0.0) {
            self.open_m.copy_from_slice(&self.gap_m);
            return Ok(0);
        }
        (self.operator).apply(history, &mut self.open_m, &mut self.scratch)?;
        for (u, gap) in self.open_m.iter_mut().zip(&self.gap_m) {
            *u += gap;
        }
        Ok(1)
    }

    /// The pressure of this sum (Pa) over the cells: the approach (m), the iterations and the convolutions it took.
    fn press(
        &mut self,
        compliance_per_pa: f64,
        sum_pa: f64,
        pressure: &mut [f64],
    ) -> Result<(f64, usize, usize), ContactError> {
        start(sum_pa, pressure);
        self.direction.fill(0.0);
        let (mut before, mut conjugate) = (1.0, 0.0);
        let mut last = (f64::INFINITY, 0.0);
        for step in 0..=self.settings.max_iterations {
            go_on(self.interrupt.as_deref())?;
            let residual = self.assess(compliance_per_pa, sum_pa, pressure)?;
            let (inside_m, allowed_m) = (residual.inside_m, residual.allowed_m);
            if inside_m <= allowed_m && residual.penetration_m <= allowed_m {
                return Ok((residual.approach_m, step, step * 2 + 1));
            }
            last = (inside_m.max(residual.penetration_m), allowed_m);
            let mut square = 0.0;
            for (p, r) in pressure.iter().zip(&mut self.residual_m) {
                *r -= residual.mean_m;
                if *p > 0.0 {
                    square += *r * *r;
                }
            }
            let beta = conjugate * square / before;
            before = square;
            let nodes = pressure.iter().zip(&self.residual_m);
            for ((p, r), t) in nodes.zip(&mut self.direction) {
                *t = if *p > 0.0 { r + beta * *t } else { 0.0 };
            }
            let scratch = &mut self.scratch;
            (self.operator).apply(&self.direction, &mut self.response_m, scratch)?;
            conjugate = self.descend(compliance_per_pa, pressure);
            let sum = sums::sum(pressure);
            if sum > 0.0 {
                let scale = sum_pa / sum;
                pressure.iter_mut().for_each(|p| *p *= scale);
            } else {
                start(sum_pa, pressure);
            }
        }
        Err(ContactError::NotConverged {
            iterations: self.settings.max_iterations,
            residual: last.0,
            tolerance: last.1,
        })
    }

    /// Writes the gap under this pressure, from the mean plane of the surface and less the approach, as the residual.
    fn assess(
        &mut self,
        compliance_per_pa: f64,
        sum_pa: f64,
        pressure: &[f64],
    ) -> Result<Residual, ContactError> {
        let residual_m = &mut self.residual_m;
        (self.operator).apply(pressure, residual_m, &mut self.scratch)?;
        let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
        for (r, open) in residual_m.iter_mut().zip(&self.open_m) {
            let elastic = compliance_per_pa * *r;
            (least, largest) = (least.min(elastic), largest.max(elastic));
            *r = open + elastic;
        }
        // Weighted by the pressure, what is left of the gap counts in second order only.
        let approach_m = sums::dot(pressure, residual_m) / sum_pa;
        residual_m.iter_mut().for_each(|r| *r -= approach_m);
        let (mut misfit, mut penetration_m) = (0.0, 0.0_f64);
        let (mut touching, mut mean) = (0.0, 0.0);
        for (p, r) in pressure.iter().zip(residual_m.iter()) {
            if *p > 0.0 {
                misfit += p * r.abs();
                (touching, mean) = (touching + 1.0, mean + r);
            } else {
                penetration_m = penetration_m.max(-r);
            }
        }
        let rounding = ROUNDING * largest.abs().max(least.abs()).max(approach_m.abs());
        Ok(Residual {
            approach_m,
            inside_m: misfit / sum_pa,
            penetration_m,
            allowed_m: self.settings.tolerance * (largest - least) + rounding,
            mean_m: mean / touching,
        })
    }

    /// One step down along the direction. Returns 1 where the next direction may be conjugate to this one, 0 where cells have come
    /// into contact.
    fn descend(&self, compliance_per_pa: f64, pressure: &mut [f64]) -> f64 {
        let (mut touching, mut mean) = (0.0, 0.0);
        for (p, q) in pressure.iter().zip(&self.response_m) {
            if *p > 0.0 {
                (touching, mean) = (touching + 1.0, mean + compliance_per_pa * q);
            }
        }
        mean /= touching;
        let (mut along, mut curvature) = (0.0, 0.0);
        let nodes = self.residual_m.iter().zip(&self.direction);
        let steps = nodes.clone().zip(&self.response_m);
        for (p, ((r, t), q)) in pressure.iter().zip(steps) {
            if *p > 0.0 {
                along += r * t;
                curvature += (compliance_per_pa * q - mean) * t;
            }
        }
        let step = if curvature > 0.0 {
            along / curvature
        } else {
            0.0
        };
        let mut conjugate = 1.0;
        for (p, (r, t)) in pressure.iter_mut().zip(nodes) {
            *p = (*p - step * t).max(0.0);
            if *p == 0.0 && *r < 0.0 {
                *p = -step * r;
                conjugate = 0.0;
            }
        }
        conjugate
    }
}

/// The guess made non-negative and scaled to the sum; an even pressure without one.
fn start(sum_pa: f64, pressure: &mut [f64]) {
    pressure.iter_mut().for_each(|p| *p = p.max(0.0));
    let sum = sums::sum(pressure);
    let even = sum_pa / pressure.len() as f64;
    let scale = sum_pa / sum;
    match scale.is_finite() {
        true => pressure.iter_mut().for_each(|p| *p *= scale),
        false => pressure.fill(even),
    }
}

impl Engine for Periodic {
    fn nodes(&self) -> usize {
        self.gap_m.len()
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
        let convolutions = self.open_gap(instant.history)?;
        let area_m2 = self.operator.grid().cell_area_m2();
        if load_n == 0.0 {
            pressure.fill(0.0);
            return Ok(Solution {
                load_n,
                approach_m: sums::least(&self.open_m),
                contact_radius_m: 0.0,
                iterations: 0,
                convolutions,
            });
        }
        let (approach_m, iterations, more) =
            self.press(instant.compliance_per_pa, load_n / area_m2, pressure)?;
        let touching = pressure.iter().filter(|p| **p > 0.0).count() as f64;
        Ok(Solution {
            load_n,
            approach_m,
            contact_radius_m: (touching * area_m2 / std::f64::consts::PI).sqrt(),
            iterations,
            convolutions: convolutions + more,
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
        self.operator.grid().pressure_lines(pressure)
    }

    fn elastic_displacement(
        &mut self,
        pressure: &[f64],
        displacement: &mut [f64],
    ) -> Result<usize, ContactError> {
        (self.operator).apply(pressure, displacement, &mut self.scratch)?;
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
