//! The half-space under a surface that repeats itself without end, such as a patch of a rough one: loads up to full contact, and no edge.
//!
//! The displacement of a pressure wave of wave number q is 2 C p / |q| (H. M. Stanley, T. Kato, J. Tribol. 119 (1997) 481), so that
//! transforms of one period, without padding, are all there is to it. The mean pressure lowers a half-space by an infinite amount,
//! which is left out: displacements are measured from the mean plane of the surface, and the approach is that of the indenter to that
//! plane since first touch. It has a bound, the mean gap, at which contact is full.
//!
//! Transforms of one period invert the operator as well, all but its mean, so that conjugate gradients on a contact are done in a few
//! steps (`ActiveSet`). The first pressures are guessed on coarser cells. What is not solved like that, the slower conjugate
//! gradients of I. A. Polonsky and L. M. Keer (`PolonskyKeer`) solve.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::active_set::{ActiveSet, Elastic, InstantOfCells, Scratches, Work, over_blocks};
use super::convolution::ConvolutionError;
pub use super::convolution::PeriodicOperator;
use super::grid::Grid;
use super::instant::{Imposed, ROUNDING, SolverSettings, start};
use super::passes;
use super::polonsky_keer::{InstantProblem, PolonskyKeer, Residual, lift_free_gap};
use crate::contact::surface::{PressureLine, Response, Surface};
use crate::contact::{ContactError, Engine, Instant, Prescribed, Solution, sums, surface_of_cells};
use crate::numerics::threads::in_pieces;

/// The engine of one gap field that repeats itself.
pub struct Periodic {
    operator: Arc<PeriodicOperator>,
    settings: SolverSettings,
    gap_m: Vec<f64>,
    /// Gap under the history alone, before the approach is taken off: g + B H (m).
    free_gap_m: Vec<f64>,
    /// Steps of an instant after which the fast way is left for the safe one.
    fast_steps: usize,
    fields: ActiveSet,
    scratches: Scratches,
    safeguard: Option<Box<PolonskyKeer>>,
    interrupt: Option<Arc<AtomicBool>>,
}

/// Cells along a side from which on coarser ones guess the pressures, and how well they know them.
const FEWEST_CELLS: usize = 32;
const TOLERANCE_OF_A_GUESS: f64 = 1e-3;

impl Periodic {
    /// An engine for this gap field (m, one value per cell of one period).
    pub fn new(operator: Arc<PeriodicOperator>, gap_m: Vec<f64>, settings: SolverSettings) -> Self {
        Self {
            free_gap_m: gap_m.clone(),
            fast_steps: usize::MAX,
            fields: ActiveSet::default(),
            scratches: Scratches::default(),
            safeguard: None,
            interrupt: None,
            settings,
            operator,
            gap_m,
        }
    }

    /// The same engine solving every instant by its slow, safe way alone: what the fast one is checked against.
    pub fn by_safeguard_alone(mut self) -> Self {
        self.fast_steps = 0;
        self
    }

    /// A first guess: the pressures of the same surface in cells of twice the width, which guess theirs likewise.
    fn guess_on_coarser_cells(
        &self,
        compliance_per_pa: f64,
        load_n: f64,
        pressure: &mut [f64],
    ) -> Result<(), ContactError> {
        let grid = self.operator.grid();
        let (cells_x, cells_y) = (grid.cells_x(), grid.cells_y());
        let is_halved = cells_x.is_multiple_of(2) && cells_y.is_multiple_of(2);
        if !is_halved || cells_x.min(cells_y) < FEWEST_CELLS {
            return Ok(());
        }
        let (half_x, half_y) = (cells_x / 2, cells_y / 2);
        let spacing_m = [grid.spacing_x_m(), grid.spacing_y_m()].map(|spacing_m| 2.0 * spacing_m);
        let Ok(coarser) = Grid::new(half_x, half_y, spacing_m[0], spacing_m[1]) else {
            return Ok(());
        };
        let under = |cell: usize| cell / cells_x / 2 * half_x + cell % cells_x / 2;
        let mut gap_m = vec![0.0; half_x * half_y];
        for (cell, gap) in self.free_gap_m.iter().enumerate() {
            gap_m[under(cell)] += 0.25 * gap;
        }
        let settings = SolverSettings {
            tolerance: self.settings.tolerance.max(TOLERANCE_OF_A_GUESS),
            ..self.settings
        };
        let mut engine = Self::new(Arc::new(PeriodicOperator::new(coarser)), gap_m, settings);
        engine.interrupt.clone_from(&self.interrupt);
        let none = vec![0.0; half_x * half_y];
        let mut guess = none.clone();
        let instant = Instant {
            history: &none,
            compliance_per_pa,
            prescribed: Prescribed::LoadN(load_n),
        };
        match engine.solve(&instant, &mut guess) {
            Err(ContactError::Interrupted) => return Err(ContactError::Interrupted),
            // Without a guess the iteration begins at a uniform pressure.
            Err(_) => return Ok(()),
            Ok(_) => {}
        }
        for (cell, p) in pressure.iter_mut().enumerate() {
            *p = guess[under(cell)];
        }
        Ok(())
    }

    /// The instant the fast way; `None` where that leads nowhere. The pressure is where it ended.
    fn solve_fast(
        &mut self,
        compliance_per_pa: f64,
        target_sum: f64,
        noise_m: f64,
        pressure: &mut [f64],
        work: &mut Work,
    ) -> Result<Option<f64>, ContactError> {
        start(Some(target_sum), &self.gap_m, pressure);
        self.fields.fit(pressure.len());
        passes::copy(pressure, &mut self.fields.pressure);
        loop {
            let fields = &mut self.fields;
            let scratch = &mut self.scratches.convolution;
            (self.operator).apply(&fields.pressure, &mut fields.gap_m, scratch)?;
            work.count_fresh_gap();
            let cells = pressure.len();
            let gaps_m = (&mut fields.gap_m[..], &self.free_gap_m[..]);
            in_pieces(cells, gaps_m, |_, (gap_m, free_gap_m)| {
                for (gap, free) in gap_m.iter_mut().zip(free_gap_m) {
                    *gap = free + compliance_per_pa * *gap;
                }
            });
            let level_m = passes::largest(&fields.gap_m);
            let period = Period {
                operator: &self.operator,
                free_gap_m: &self.free_gap_m,
            };
            let problem = InstantOfCells {
                elastic: &period,
                compliance_per_pa,
                target_sum: Some(target_sum),
                approach_m: None,
                tolerance: self.settings.tolerance,
                fast_steps: self.fast_steps,
                noise_m: noise_m + ROUNDING * level_m,
                has_patches: true,
            };
            let steps = self.settings.max_iterations;
            let solved = fields.solve(&problem, steps, &mut self.scratches, work)?;
            passes::copy(&fields.pressure, pressure);
            if solved.is_none_or(|state| work.is_exact(&state, problem.tolerance)) {
                return Ok(solved.map(|state| state.approach_m));
            }
            // Single precision has piled up in a gap carried along by recursion: judge a fresh one.
        }
    }

    /// The instant the slow, safe way, from the pressure given.
    fn solve_safely(
        &mut self,
        instant: &Instant<'_>,
        target_sum: f64,
        pressure: &mut [f64],
        work: &mut Work,
    ) -> Result<f64, ContactError> {
        let given = InstantProblem {
            operator: &|p, u, scratch| self.operator.apply(p, u, scratch),
            reference_m: Residual::displacement_range_m,
            settings: self.settings,
            gap_m: &self.gap_m,
            compliance: instant.compliance_per_pa,
            imposed: Imposed::PressureSum(target_sum),
            interrupt: self.interrupt.as_deref(),
        };
        let solved =
            PolonskyKeer::take_over(&mut self.safeguard, &given, instant.history, pressure, work);
        let Some((residual, steps)) = solved? else {
            return Ok(sums::least(&self.free_gap_m));
        };
        work.steps = steps;
        Ok(residual.mean_approach_m())
    }
}

/// A period under pressure, and the gap it would have without.
pub(super) struct Period<'a> {
    pub(super) operator: &'a PeriodicOperator,
    pub(super) free_gap_m: &'a [f64],
}

impl Elastic for Period<'_> {
    fn grid(&self) -> &Grid {
        self.operator.grid()
    }

    fn displace(
        &self,
        pressure: &[f32],
        displacement: &mut [f32],
        scratch: &mut Scratches,
    ) -> Result<(), ConvolutionError> {
        (self.operator).apply_nearly(pressure, displacement, &mut scratch.changes)
    }

    fn unit_m(&self) -> f64 {
        1.0
    }

    fn precondition(
        &self,
        gap: &[f32],
        pressure: &mut [f32],
        rows: Range<usize>,
        scratch: &mut Scratches,
    ) -> Result<(), ConvolutionError> {
        (self.operator).apply_inverse(gap, pressure, rows, &mut scratch.preconditioner)
    }

    /// Without its mean, a displacement is as large as the distance between its extremes.
    fn load(&self, pressure: &[f64], gap_m: &[f64], _compliance_per_pa: f64) -> (f64, f64) {
        let free_gap_m = self.free_gap_m;
        let found = over_blocks(pressure.len(), self.grid().cells_x(), |cells| {
            let (mut least_m, mut largest_m) = (f64::INFINITY, f64::NEG_INFINITY);
            for (gap, free) in gap_m[cells.clone()].iter().zip(&free_gap_m[cells.clone()]) {
                let lift_m = gap - free;
                (least_m, largest_m) = (least_m.min(lift_m), largest_m.max(lift_m));
            }
            [sums::sum(&pressure[cells]), least_m, -largest_m]
        });
        (found.total(0), -found.least(2) - found.least(1))
    }
}

impl Engine for Periodic {
    fn gap_m(&self) -> &[f64] {
        &self.gap_m
    }

    fn starts_from_guess(&self) -> bool {
        true
    }

    fn tolerance(&self) -> Option<f64> {
        Some(self.settings.tolerance)
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
        let mut work = Work::until(self.interrupt.clone());
        let scratch = &mut self.scratches.convolution;
        let displace = |q: &[f64], u: &mut [f64]| self.operator.apply(q, u, scratch);
        let (gap_m, free_gap_m) = (&self.gap_m, &mut self.free_gap_m);
        let noise_m = lift_free_gap(instant.history, gap_m, free_gap_m, displace)?;
        work.convolutions += usize::from(noise_m.is_some());
        let noise_m = noise_m.unwrap_or(0.0);
        let approach_m = if load_n == 0.0 {
            pressure.fill(0.0);
            passes::least(&self.free_gap_m)
        } else {
            let (target_sum, compliance) = (load_n / area_m2, instant.compliance_per_pa);
            if self.fast_steps > 0 && pressure.iter().all(|p| *p <= 0.0) {
                self.guess_on_coarser_cells(compliance, load_n, pressure)?;
            }
            match self.solve_fast(compliance, target_sum, noise_m, pressure, &mut work)? {
                Some(approach_m) => approach_m,
                None => self.solve_safely(instant, target_sum, pressure, &mut work)?,
            }
        };
        let touching = passes::positive(pressure);
        Ok(Solution {
            load_n,
            approach_m,
            contact_radius_m: (touching * area_m2 / std::f64::consts::PI).sqrt(),
            iterations: work.steps,
            convolutions: work.convolutions,
        })
    }

    fn peak_pressure_pa(
        &mut self,
        pressure: &[f64],
        _solution: &Solution,
    ) -> Result<Option<f64>, ContactError> {
        Ok(Some(passes::largest(pressure)))
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
        (self.operator).apply(pressure, displacement, &mut self.scratches.convolution)?;
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
