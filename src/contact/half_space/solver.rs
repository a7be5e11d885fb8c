//! One instant on the half-space: conjugate gradients with contact-set updates (I. A. Polonsky and L. M. Keer, Wear 231
//! (1999) 206; the approach-controlled variant without mean-gap correction and load rescaling is that of S. Spinu,
//! Advances in Tribology 2018, 9432894, figure 2).
//!
//! The iteration minimises the complementary energy over p >= 0. It is started from the pressure of the last instant. While
//! no cell enters or leaves the contact, the displacement follows the pressure by the product already computed for the
//! search direction, so that an iteration costs one convolution; where the contact changes, it costs two. Everything that
//! decides when to stop is a ratio: the answer does not change with the user's units.

mod residual;

use std::sync::Arc;

use residual::{Fields, Residual};

use super::convolution::{Convolution, ConvolutionError, Scratch};
use crate::contact::surface::{CellSurface, Response, Surface};
use crate::contact::{ContactError, Engine, Instant, Prescribed, Solution};

/// When the iteration stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverSettings {
    /// Largest allowed pressure-weighted mean |gap| inside the contact, and largest penetration outside, both relative to
    /// the pressure-weighted mean displacement that the instant's own pressure causes. Where that displacement is tiny beside
    /// what earlier pressures have left (a load about to vanish), rounding of the latter is allowed on top.
    pub tolerance: f64,
    /// Iterations after which an instant counts as not converged.
    pub max_iterations: usize,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            max_iterations: 2000,
        }
    }
}

/// The half-space engine of one gap field.
pub struct HalfSpace {
    operator: Arc<Convolution>,
    scratch: Scratch,
    settings: SolverSettings,
    gap_m: Vec<f64>,
    bounded_pressure: bool,
    /// B H: the displacement that history left.
    history_displacement_m: Vec<f64>,
    /// Cells inside the grid in which contact is an error, because the gap beside them is not known.
    end_of_data: Vec<usize>,
    /// g + B H: the gap under no pressure, before the approach is taken off.
    free_gap_m: Vec<f64>,
    /// B p, without the compliance.
    displacement: Vec<f64>,
    /// B t.
    response: Vec<f64>,
    direction: Vec<f64>,
    /// What rounding leaves in a gap (m).
    noise_m: f64,
    convolutions: u64,
}

/// Rounding of a convolution and of the gaps made from it, as a part of the largest displacement: some units in the last
/// place.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// The state of the iteration between two passes.
struct Progress {
    previous_squared_gap: f64,
    /// Whether the next direction may be conjugate to the last.
    conjugate: bool,
    /// Whether the displacement is a fresh convolution rather than carried along by recursion.
    exact: bool,
}

impl HalfSpace {
    /// An engine for this gap field (m, one value per cell of the operator's grid; infinite where there is no indenter).
    ///
    /// `bounded_pressure` says whether the shape has a finite pressure maximum. Contact in the outermost cells of the grid is
    /// an error: what lies beyond is unknown.
    pub fn new(
        operator: Arc<Convolution>,
        gap_m: Vec<f64>,
        bounded_pressure: bool,
        settings: SolverSettings,
    ) -> Self {
        let cells = operator.grid().cells();
        let scratch = operator.scratch();
        Self {
            scratch,
            settings,
            bounded_pressure,
            history_displacement_m: vec![0.0; cells],
            end_of_data: Vec::new(),
            free_gap_m: vec![0.0; cells],
            displacement: vec![0.0; cells],
            response: vec![0.0; cells],
            direction: vec![0.0; cells],
            noise_m: 0.0,
            convolutions: 0,
            operator,
            gap_m,
        }
    }

    /// The same engine for a shape whose data end where its gap is infinite: contact beside such a cell is an error too.
    pub fn ending_in_data(mut self) -> Self {
        let grid = *self.operator.grid();
        let (nx, ny) = (grid.cells_x(), grid.cells_y());
        let unknown = |cell: usize| !self.gap_m[cell].is_finite();
        let beside_unknown = |cell: &usize| {
            let (x, y) = (cell % nx, cell / nx);
            let rows = y.saturating_sub(1)..=(y + 1).min(ny - 1);
            let mut neighbours = rows.flat_map(|y| {
                let columns = x.saturating_sub(1)..=(x + 1).min(nx - 1);
                columns.map(move |x| y * nx + x)
            });
            !unknown(*cell) && neighbours.any(unknown)
        };
        self.end_of_data = (0..grid.cells()).filter(beside_unknown).collect();
        self
    }

    /// Convolutions computed so far: the unit in which this engine's work is counted.
    pub fn convolutions(&self) -> u64 {
        self.convolutions
    }

    /// The surface displacement u = B (A p + H) in metres of the instant last solved, one value per cell.
    pub fn displacement_m(&self, compliance_per_pa: f64) -> impl Iterator<Item = f64> + '_ {
        let fields = self.displacement.iter().zip(&self.history_displacement_m);
        fields.map(move |(u, history)| compliance_per_pa * u + history)
    }

    /// free gap = g + B H.
    fn prepare_free_gap(&mut self, history: &[f64]) -> Result<(), ContactError> {
        self.operator
            .apply(history, &mut self.history_displacement_m, &mut self.scratch)?;
        self.convolutions += 1;
        let mut largest_m = 0.0_f64;
        let fields = self.gap_m.iter().zip(&self.history_displacement_m);
        for (free, (gap, displacement)) in self.free_gap_m.iter_mut().zip(fields) {
            largest_m = largest_m.max(displacement.abs());
            *free = gap + displacement;
        }
        self.noise_m = ROUNDING * largest_m;
        Ok(())
    }

    fn refresh_displacement(&mut self, pressure: &[f64]) -> Result<(), ContactError> {
        self.operator
            .apply(pressure, &mut self.displacement, &mut self.scratch)?;
        self.convolutions += 1;
        Ok(())
    }

    /// The starting pressure: the guess made non-negative and scaled to the load, or, without a guess, the load spread
    /// evenly over the indenter.
    fn start(&self, target_sum: Option<f64>, pressure: &mut [f64]) {
        for (p, gap) in pressure.iter_mut().zip(&self.gap_m) {
            *p = if gap.is_finite() { p.max(0.0) } else { 0.0 };
        }
        let Some(target) = target_sum else { return };
        let sum: f64 = pressure.iter().sum();
        if sum > 0.0 {
            let scale = target / sum;
            pressure.iter_mut().for_each(|p| *p *= scale);
            return;
        }
        let finite = self.free_gap_m.iter().filter(|g| g.is_finite());
        let count = finite.count().max(1);
        let value = target / count as f64;
        for (p, free) in pressure.iter_mut().zip(&self.free_gap_m) {
            *p = if free.is_finite() { value } else { 0.0 };
        }
    }

    /// Conjugate direction t = gap + beta t inside the contact, 0 outside; returns the sum of gap * t.
    fn update_direction(
        &mut self,
        compliance: f64,
        residual: &Residual,
        beta: f64,
        pressure: &[f64],
    ) -> f64 {
        let mut product = 0.0;
        let fields = self.free_gap_m.iter().zip(&self.displacement);
        for ((t, &p), (&free, &u)) in self.direction.iter_mut().zip(pressure).zip(fields) {
            *t = if p > 0.0 {
                let gap = free + compliance * u - residual.approach_m;
                let next = gap + beta * *t;
                product += gap * next;
                next
            } else {
                0.0
            };
        }
        product
    }

    /// The direction of the cells that penetrate without carrying pressure; returns the sum of gap * t.
    fn penetrating_direction(
        &mut self,
        compliance: f64,
        residual: &Residual,
        pressure: &[f64],
    ) -> f64 {
        let mut product = 0.0;
        let fields = self.free_gap_m.iter().zip(&self.displacement);
        for ((t, &p), (&free, &u)) in self.direction.iter_mut().zip(pressure).zip(fields) {
            *t = if p > 0.0 {
                0.0
            } else {
                (free + compliance * u - residual.approach_m).min(0.0)
            };
            product += *t * *t;
        }
        product
    }

    /// Step length along the direction: sum(gap t) / sum(r t), with r = A B t less, under load control, its mean over the
    /// contact. `None` where there is no curvature.
    fn step_length(
        &mut self,
        compliance: f64,
        product: f64,
        load_controlled: bool,
        pressure: &[f64],
    ) -> Result<Option<f64>, ContactError> {
        self.operator
            .apply(&self.direction, &mut self.response, &mut self.scratch)?;
        self.convolutions += 1;
        let (mut sum, mut weighted, mut total, mut cells) = (0.0, 0.0, 0.0, 0usize);
        for ((&t, &r), &p) in self.direction.iter().zip(&self.response).zip(pressure) {
            weighted += r * t;
            if p > 0.0 {
                sum += r;
                total += t;
                cells += 1;
            }
        }
        let mean = if load_controlled {
            sum / cells.max(1) as f64
        } else {
            0.0
        };
        let curvature = compliance * (weighted - mean * total);
        Ok((curvature > 0.0).then(|| product / curvature))
    }

    /// p <- p - step t, clipped at 0; penetrating cells outside join the contact. Returns whether any joined, whether any left.
    fn move_pressure(
        &mut self,
        compliance: f64,
        approach_m: f64,
        step: f64,
        pressure: &mut [f64],
    ) -> (bool, bool) {
        let (mut joined, mut left) = (false, false);
        let fields = self.free_gap_m.iter().zip(&self.displacement);
        for ((p, &t), (&free, &u)) in pressure.iter_mut().zip(&self.direction).zip(fields) {
            if *p > 0.0 {
                *p -= step * t;
                if *p <= 0.0 {
                    *p = 0.0;
                    left = true;
                }
            } else {
                let gap = free + compliance * u - approach_m;
                if gap < 0.0 {
                    *p = -step * gap;
                    joined = true;
                }
            }
        }
        (joined, left)
    }

    /// One pass: direction, step, projection, load. False where the direction has no curvature, and nothing moved.
    fn advance(
        &mut self,
        compliance: f64,
        target_sum: Option<f64>,
        residual: &Residual,
        progress: &mut Progress,
        pressure: &mut [f64],
    ) -> Result<bool, ContactError> {
        let beta = if progress.conjugate {
            residual.squared_gap / progress.previous_squared_gap
        } else {
            0.0
        };
        let mut product = self.update_direction(compliance, residual, beta, pressure);
        progress.previous_squared_gap = residual.squared_gap;
        let load_controlled = target_sum.is_some();
        let mut step = self.step_length(compliance, product, load_controlled, pressure)?;
        if step.is_none() && residual.penetration_m > 0.0 {
            // Nothing is in contact, or the contact is settled (a single cell that carries the load always is) while others
            // penetrate: these show the way.
            product = self.penetrating_direction(compliance, residual, pressure);
            step = self.step_length(compliance, product, false, pressure)?;
        }
        let Some(step) = step else {
            return Ok(false);
        };
        let (joined, left) = self.move_pressure(compliance, residual.approach_m, step, pressure);
        let scale = rescale(target_sum, pressure);
        if joined || left {
            self.refresh_displacement(pressure)?;
        } else {
            for (u, r) in self.displacement.iter_mut().zip(&self.response) {
                *u = scale * (*u - step * r);
            }
        }
        progress.exact = joined || left;
        progress.conjugate = !joined;
        Ok(true)
    }

    /// The iteration. Returns the residual at the end and the iterations taken.
    fn iterate(
        &mut self,
        compliance: f64,
        target_sum: Option<f64>,
        approach_m: Option<f64>,
        pressure: &mut [f64],
    ) -> Result<(Residual, usize), ContactError> {
        self.start(target_sum, pressure);
        self.refresh_displacement(pressure)?;
        self.direction.fill(0.0);
        let mut progress = Progress {
            previous_squared_gap: 1.0,
            conjugate: false,
            exact: true,
        };
        let tolerance = self.settings.tolerance;
        let (mut relative, mut iterations) = (f64::INFINITY, 0);
        for iteration in 0..self.settings.max_iterations {
            let fields = Fields {
                pressure,
                free_gap_m: &self.free_gap_m,
                displacement: &self.displacement,
            };
            let residual = Residual::of(&fields, compliance, approach_m);
            if residual.cells == 0 && target_sum.is_some() {
                // A step has emptied the contact, which has a load to carry: begin again.
                self.start(target_sum, pressure);
                self.refresh_displacement(pressure)?;
                (progress.exact, progress.conjugate) = (true, false);
                continue;
            }
            let noise_m = self.noise_m + ROUNDING * residual.approach_m.abs();
            relative = residual.relative(tolerance, noise_m);
            if relative <= tolerance {
                if progress.exact {
                    return Ok((residual, iteration));
                }
                // Rounding piles up in a displacement carried along by recursion: judge a fresh one.
                self.refresh_displacement(pressure)?;
                progress.exact = true;
                continue;
            }
            iterations = iteration + 1;
            if !self.advance(compliance, target_sum, &residual, &mut progress, pressure)? {
                break;
            }
        }
        Err(ContactError::NotConverged {
            iterations,
            residual: relative,
            tolerance,
        })
    }

    /// Whether any cell on the border of the grid or of the data carries pressure.
    fn touches_edge(&self, pressure: &[f64]) -> bool {
        let (nx, ny) = (
            self.operator.grid().cells_x(),
            self.operator.grid().cells_y(),
        );
        let row = |iy: usize| (0..nx).any(|ix| pressure[iy * nx + ix] > 0.0);
        let column = |ix: usize| (0..ny).any(|iy| pressure[iy * nx + ix] > 0.0);
        let border = row(0) || row(ny - 1) || column(0) || column(nx - 1);
        border || self.end_of_data.iter().any(|&cell| pressure[cell] > 0.0)
    }

    fn out_of_contact(&mut self, pressure: &mut [f64]) -> Solution {
        pressure.fill(0.0);
        self.displacement.fill(0.0);
        Solution {
            load_n: 0.0,
            approach_m: self
                .free_gap_m
                .iter()
                .copied()
                .fold(f64::INFINITY, f64::min),
            contact_radius_m: 0.0,
            iterations: 0,
        }
    }
}

/// Scales the pressure to the prescribed sum; returns the factor, 1 where nothing is prescribed.
fn rescale(target_sum: Option<f64>, pressure: &mut [f64]) -> f64 {
    let Some(target) = target_sum else { return 1.0 };
    let sum: f64 = pressure.iter().sum();
    if sum <= 0.0 {
        return 1.0;
    }
    let scale = target / sum;
    pressure.iter_mut().for_each(|p| *p *= scale);
    scale
}

impl From<ConvolutionError> for ContactError {
    fn from(error: ConvolutionError) -> Self {
        Self::Operator {
            reason: error.to_string(),
        }
    }
}

impl Engine for HalfSpace {
    fn nodes(&self) -> usize {
        self.gap_m.len()
    }

    fn solve(
        &mut self,
        instant: &Instant<'_>,
        pressure: &mut [f64],
    ) -> Result<Solution, ContactError> {
        let prescribed = instant.prescribed.check()?;
        self.prepare_free_gap(instant.history)?;
        let cell_area_m2 = self.operator.grid().cell_area_m2();
        let (target_sum, approach_m) = match prescribed {
            Prescribed::LoadN(0.0) => return Ok(self.out_of_contact(pressure)),
            Prescribed::LoadN(load_n) => (Some(load_n / cell_area_m2), None),
            Prescribed::ApproachM(approach_m) => {
                // Where the free surface is clear of the indenter, no pressure is the solution, whatever the guess.
                if self.free_gap_m.iter().all(|&free| free >= approach_m) {
                    let clear = self.out_of_contact(pressure);
                    return Ok(Solution {
                        approach_m,
                        ..clear
                    });
                }
                (None, Some(approach_m))
            }
        };
        let compliance = instant.compliance_per_pa;
        let (residual, iterations) = self.iterate(compliance, target_sum, approach_m, pressure)?;
        if self.touches_edge(pressure) {
            let grid = self.operator.grid();
            let half_width_m = 0.5 * grid.cells_x() as f64 * grid.spacing_x_m();
            return Err(ContactError::ReachedEdge { half_width_m });
        }
        // Weighted by the pressure, the mean gap left by the iteration counts only in second order.
        let found = || residual.lifted / residual.pressure_sum;
        Ok(Solution {
            load_n: residual.pressure_sum * cell_area_m2,
            approach_m: approach_m.unwrap_or_else(found),
            contact_radius_m: (residual.cells as f64 * cell_area_m2 / std::f64::consts::PI).sqrt(),
            iterations,
        })
    }

    fn peak_pressure_pa(
        &mut self,
        pressure: &[f64],
        _solution: &Solution,
    ) -> Result<Option<f64>, ContactError> {
        let peak = pressure.iter().copied().fold(0.0, f64::max);
        Ok(self.bounded_pressure.then_some(peak))
    }

    fn elastic_displacement(
        &mut self,
        pressure: &[f64],
        displacement: &mut [f64],
    ) -> Result<(), ContactError> {
        self.operator
            .apply(pressure, displacement, &mut self.scratch)?;
        self.convolutions += 1;
        Ok(())
    }

    fn load_per_nodal_pressure(&self) -> f64 {
        self.operator.grid().cell_area_m2()
    }

    fn surface(&mut self, response: &Response<'_>) -> Result<Surface, ContactError> {
        let nodes = response.pressure.iter().zip(response.history);
        let hereditary: Vec<f64> = nodes
            .map(|(p, h)| response.compliance_per_pa * p + h)
            .collect();
        let mut displacement_m = vec![0.0; self.gap_m.len()];
        self.operator
            .apply(&hereditary, &mut displacement_m, &mut self.scratch)?;
        self.convolutions += 1;
        Ok(Surface::Cells(CellSurface {
            grid: *self.operator.grid(),
            pressure_pa: response.pressure.to_vec(),
            displacement_m,
        }))
    }
}
