//! The half-space under a surface that repeats itself without end, such as a patch of a rough one: loads up to full contact, and no edge.
//!
//! The displacement of a pressure wave of wave number q is 2 C p / |q| (H. M. Stanley, T. Kato, J. Tribol. 119 (1997) 481), so that
//! transforms of one period, without padding, are all there is to it. The mean pressure lowers a half-space by an infinite amount,
//! which is left out: displacements are measured from the mean plane of the surface, and the approach is that of the indenter to that
//! plane since first touch. It has a bound, the mean gap, at which contact is full.
//!
//! An instant is solved by the conjugate gradients of I. A. Polonsky and L. M. Keer (Wear 231 (1999) 206) under a prescribed mean pressure.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};

use super::grid::Grid;
use super::solver::SolverSettings;
use crate::contact::surface::{Along, CellSurface, PressureLine, Response, Surface};
use crate::contact::{ContactError, Engine, Instant, Prescribed, Solution, sums};

/// The operator on one period: displacement of every cell per unit of compliance, its mean taken off.
pub struct PeriodicOperator {
    grid: Grid,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    down: Arc<dyn Fft<f64>>,
    up: Arc<dyn Fft<f64>>,
    /// 2/|q| (m) over the cells of a period, column by column of the half spectrum; 0 at q = 0.
    kernel: Vec<f64>,
}

/// Work space of one thread.
struct Scratch {
    row: Vec<f64>,
    /// Half spectrum, column by column.
    spectrum: Vec<Complex<f64>>,
    line: Vec<Complex<f64>>,
    of_rows: Vec<Complex<f64>>,
    of_columns: Vec<Complex<f64>>,
}

impl PeriodicOperator {
    /// Of a grid that is one period.
    pub fn new(grid: Grid) -> Self {
        let (nx, ny) = (grid.cells_x(), grid.cells_y());
        let (mut real, mut complex) = (RealFftPlanner::new(), FftPlanner::new());
        let wave_number = |k: usize, cells: usize, spacing_m: f64| {
            let signed = if 2 * k > cells {
                k as f64 - cells as f64
            } else {
                k as f64
            };
            std::f64::consts::TAU * signed / (cells as f64 * spacing_m)
        };
        let mut kernel = Vec::with_capacity((nx / 2 + 1) * ny);
        for kx in 0..=nx / 2 {
            for ky in 0..ny {
                let q = wave_number(kx, nx, grid.spacing_x_m()).hypot(wave_number(
                    ky,
                    ny,
                    grid.spacing_y_m(),
                ));
                // Transforms there and back multiply by the number of cells.
                kernel.push(if q > 0.0 {
                    2.0 / (q * grid.cells() as f64)
                } else {
                    0.0
                });
            }
        }
        Self {
            forward: real.plan_fft_forward(nx),
            inverse: real.plan_fft_inverse(nx),
            down: complex.plan_fft_forward(ny),
            up: complex.plan_fft_inverse(ny),
            kernel,
            grid,
        }
    }

    fn scratch(&self) -> Scratch {
        let (nx, ny) = (self.grid.cells_x(), self.grid.cells_y());
        let zero = Complex::new(0.0, 0.0);
        let of_rows = self
            .forward
            .get_scratch_len()
            .max(self.inverse.get_scratch_len());
        let of_columns = self
            .down
            .get_inplace_scratch_len()
            .max(self.up.get_inplace_scratch_len());
        Scratch {
            row: vec![0.0; nx],
            spectrum: vec![zero; (nx / 2 + 1) * ny],
            line: vec![zero; nx / 2 + 1],
            of_rows: vec![zero; of_rows],
            of_columns: vec![zero; of_columns],
        }
    }

    /// The displacement (m per 1/Pa) of every cell by these pressures (Pa).
    fn apply(
        &self,
        pressure: &[f64],
        displacement: &mut [f64],
        scratch: &mut Scratch,
    ) -> Result<(), ContactError> {
        let refused = |error: realfft::FftError| ContactError::Operator {
            reason: error.to_string(),
        };
        let (nx, ny) = (self.grid.cells_x(), self.grid.cells_y());
        let Scratch {
            row,
            spectrum,
            line,
            of_rows,
            of_columns,
        } = scratch;
        for (y, values) in pressure.chunks_exact(nx).enumerate() {
            row.copy_from_slice(values);
            let done = self.forward.process_with_scratch(row, line, of_rows);
            done.map_err(refused)?;
            for (x, value) in line.iter().enumerate() {
                spectrum[x * ny + y] = *value;
            }
        }
        for (column, kernel) in spectrum
            .chunks_exact_mut(ny)
            .zip(self.kernel.chunks_exact(ny))
        {
            self.down.process_with_scratch(column, of_columns);
            column
                .iter_mut()
                .zip(kernel)
                .for_each(|(value, k)| *value *= k);
            self.up.process_with_scratch(column, of_columns);
        }
        for (y, values) in displacement.chunks_exact_mut(nx).enumerate() {
            for (x, value) in line.iter_mut().enumerate() {
                *value = spectrum[x * ny + y];
            }
            // Of a real field; rounding alone is imaginary there.
            line[0].im = 0.0;
            if nx.is_multiple_of(2) {
                line[nx / 2].im = 0.0;
            }
            let done = self.inverse.process_with_scratch(line, values, of_rows);
            done.map_err(refused)?;
        }
        Ok(())
    }
}

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

impl Periodic {
    /// An engine for this gap field (m, one value per cell of one period).
    pub fn new(operator: Arc<PeriodicOperator>, gap_m: Vec<f64>, settings: SolverSettings) -> Self {
        let field = || vec![0.0; gap_m.len()];
        Self {
            scratch: operator.scratch(),
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

    fn apply(&mut self, pressure: &[f64], displacement: &mut [f64]) -> Result<(), ContactError> {
        self.operator
            .apply(pressure, displacement, &mut self.scratch)
    }

    /// The gap of an undeformed period and what the history has left of the surface.
    fn open_gap(&mut self, history: &[f64]) -> Result<usize, ContactError> {
        if history.iter().all(|h| *h == 0.0) {
            self.open_m.copy_from_slice(&self.gap_m);
            return Ok(0);
        }
        let mut left_m = std::mem::take(&mut self.open_m);
        let applied = self.apply(history, &mut left_m);
        left_m
            .iter_mut()
            .zip(&self.gap_m)
            .for_each(|(u, gap)| *u += gap);
        self.open_m = left_m;
        applied.map(|()| 1)
    }

    /// The pressure of this sum (Pa) over the cells: the approach (m), the iterations and the convolutions it took.
    fn press(
        &mut self,
        compliance_per_pa: f64,
        sum_pa: f64,
        pressure: &mut [f64],
    ) -> Result<(f64, usize, usize), ContactError> {
        start(sum_pa, pressure);
        let mut residual_m = std::mem::take(&mut self.residual_m);
        let mut direction = std::mem::take(&mut self.direction);
        let mut response_m = std::mem::take(&mut self.response_m);
        let fields = (&mut residual_m, &mut direction, &mut response_m);
        let ended = self.iterate(compliance_per_pa, sum_pa, pressure, fields);
        (self.residual_m, self.direction, self.response_m) = (residual_m, direction, response_m);
        ended
    }

    fn iterate(
        &mut self,
        compliance_per_pa: f64,
        sum_pa: f64,
        pressure: &mut [f64],
        (residual_m, direction, response_m): (&mut Vec<f64>, &mut Vec<f64>, &mut Vec<f64>),
    ) -> Result<(f64, usize, usize), ContactError> {
        direction.fill(0.0);
        let (mut before, mut conjugate) = (1.0, 0.0);
        let mut last = (f64::INFINITY, 0.0);
        for step in 0..=self.settings.max_iterations {
            if self
                .interrupt
                .as_ref()
                .is_some_and(|flag| flag.load(Ordering::Relaxed))
            {
                return Err(ContactError::Interrupted);
            }
            // The gap under this pressure, from the mean plane of the surface.
            self.apply(pressure, residual_m)?;
            let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
            for (r, open) in residual_m.iter_mut().zip(&self.open_m) {
                let elastic = compliance_per_pa * *r;
                (least, largest) = (least.min(elastic), largest.max(elastic));
                *r = open + elastic;
            }
            // Weighted by the pressure, what is left of the gap counts in second order only.
            let approach_m = sums::dot(pressure, residual_m) / sum_pa;
            residual_m.iter_mut().for_each(|r| *r -= approach_m);
            let (mut misfit, mut penetration, mut square) = (0.0, 0.0_f64, 0.0);
            let (mut touching, mut mean) = (0.0, 0.0);
            for (p, r) in pressure.iter().zip(residual_m.iter()) {
                if *p > 0.0 {
                    misfit += p * r.abs();
                    (touching, mean) = (touching + 1.0, mean + r);
                } else {
                    penetration = penetration.max(-r);
                }
            }
            let rounding = ROUNDING * largest.abs().max(least.abs()).max(approach_m.abs());
            let allowed = self.settings.tolerance * (largest - least) + rounding;
            last = ((misfit / sum_pa).max(penetration), allowed);
            if misfit / sum_pa <= allowed && penetration <= allowed {
                return Ok((approach_m, step, step * 2 + 1));
            }
            let mean = mean / touching;
            for (p, r) in pressure.iter().zip(residual_m.iter_mut()) {
                *r -= mean;
                if *p > 0.0 {
                    square += *r * *r;
                }
            }
            let beta = conjugate * square / before;
            before = square;
            for ((p, r), t) in pressure
                .iter()
                .zip(residual_m.iter())
                .zip(direction.iter_mut())
            {
                *t = if *p > 0.0 { r + beta * *t } else { 0.0 };
            }
            self.apply(direction, response_m)?;
            conjugate = descend(
                compliance_per_pa,
                pressure,
                residual_m,
                (direction, response_m),
            );
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

/// One step down along the direction. Returns 1 where the next direction may be conjugate to this one, 0 where cells have come into
/// contact.
fn descend(
    compliance_per_pa: f64,
    pressure: &mut [f64],
    residual_m: &[f64],
    (direction, response_m): (&[f64], &[f64]),
) -> f64 {
    let (mut touching, mut mean) = (0.0, 0.0);
    for (p, q) in pressure.iter().zip(response_m) {
        if *p > 0.0 {
            (touching, mean) = (touching + 1.0, mean + compliance_per_pa * q);
        }
    }
    mean /= touching;
    let (mut along, mut curvature) = (0.0, 0.0);
    for (((p, r), t), q) in pressure
        .iter()
        .zip(residual_m)
        .zip(direction)
        .zip(response_m)
    {
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
    for ((p, r), t) in pressure.iter_mut().zip(residual_m).zip(direction) {
        *p = (*p - step * t).max(0.0);
        if *p == 0.0 && *r < 0.0 {
            *p = -step * r;
            conjugate = 0.0;
        }
    }
    conjugate
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
        let area_m2 = self.operator.grid.cell_area_m2();
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
        Ok(Some(pressure.iter().copied().fold(0.0, f64::max)))
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
        let grid = &self.operator.grid;
        let line = |along, places: Vec<(f64, [usize; 2])>| PressureLine {
            along,
            position_m: places.iter().map(|(position_m, _)| *position_m).collect(),
            pressure_pa: places
                .iter()
                .map(|(_, [a, b])| Some(0.5 * (pressure[*a] + pressure[*b])))
                .collect(),
        };
        vec![
            line(Along::X, grid.centre_row()),
            line(Along::Y, grid.centre_column()),
        ]
    }

    fn elastic_displacement(
        &mut self,
        pressure: &[f64],
        displacement: &mut [f64],
    ) -> Result<usize, ContactError> {
        self.apply(pressure, displacement)?;
        Ok(1)
    }

    fn load_per_nodal_pressure(&self, _node: usize) -> f64 {
        self.operator.grid.cell_area_m2()
    }

    fn surface(&mut self, response: &Response<'_>) -> Result<Surface, ContactError> {
        let nodes = response.pressure.iter().zip(response.history);
        let source: Vec<f64> = nodes
            .map(|(p, h)| response.compliance_per_pa * p + h)
            .collect();
        let mut displacement_m = vec![0.0; source.len()];
        self.apply(&source, &mut displacement_m)?;
        Ok(Surface::Cells(CellSurface {
            grid: self.operator.grid,
            pressure_pa: response.pressure.to_vec(),
            displacement_m,
        }))
    }
}
