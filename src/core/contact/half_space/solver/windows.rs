//! An instant in windows of the grid: the contact's, which grows until it holds all of it, and that of what moves the surface.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use super::super::active_set::{Elastic, InstantOfCells, IterateState, Scratches, Work};
use super::super::convolution::{Convolution, ConvolutionError, WindowOperators};
use super::super::grid::Grid;
use super::super::influence::Influence;
use super::super::instant::{Imposed, ROUNDING, hertz_guess, start};
use super::super::passes;
use super::frame::Frame;
use super::outside::{Moments, OutsideGapBound, first_centre};
use super::{HalfSpace, InstantResult, sums};
use crate::contact::{ContactError, Instant};

/// Where an instant is solved, and where its sources of displacement are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Windows {
    pub(super) contact: Frame,
    pub(super) source: Frame,
}

/// Windows whose surroundings are remembered.
const REMEMBERED_BOUNDS: usize = 32;

/// The half-space in a window of a grid.
struct Window<'a> {
    whole: &'a Convolution,
    operators: WindowOperators,
}

impl Elastic for Window<'_> {
    fn grid(&self) -> &Grid {
        self.operators.convolution.grid()
    }

    fn displace(
        &self,
        pressure: &[f32],
        displacement: &mut [f32],
        scratch: &mut Scratches,
    ) -> Result<(), ConvolutionError> {
        let scratch = &mut scratch.changes;
        (self.operators.convolution).apply_nearly(pressure, displacement, scratch)
    }

    fn unit_m(&self) -> f64 {
        self.operators.convolution.unit_m()
    }

    fn precondition(
        &self,
        gap: &[f32],
        pressure: &mut [f32],
        rows: Range<usize>,
        scratch: &mut Scratches,
    ) -> Result<(), ConvolutionError> {
        let scratch = &mut scratch.preconditioner;
        (self.operators.preconditioner).apply(gap, pressure, rows, scratch)
    }

    /// The displacement that a disc of as widely spread pressures causes at least.
    fn load(&self, pressure: &[f64], _gap_m: &[f64], compliance_per_pa: f64) -> (f64, f64) {
        let grid = self.whole.grid();
        let step_y = grid.spacing_y_m() / grid.spacing_x_m();
        let first = first_centre(grid);
        let moments = Moments::of(pressure, self.grid().cells_x(), (first, first), step_y);
        let pressure_sum = moments.sum();
        if pressure_sum <= 0.0 {
            return (pressure_sum, 0.0);
        }
        let moments = moments.of_all_copies(grid);
        let bound = moments.mean_displacement_lower_bound(step_y) * grid.spacing_y_m();
        let own_m = match self.whole.layer() {
            None => bound,
            // Of a disc under uniform pressure the radius, in which waves of its own length are counted.
            Some(layer) => {
                let (_, spread) = moments.centre_and_spread(step_y);
                let radius_m = (2.0 * spread).sqrt() * grid.spacing_x_m();
                bound * layer.softening(layer.thickness_m / radius_m).min(1.0)
            }
        };
        (pressure_sum, compliance_per_pa * own_m)
    }
}

impl HalfSpace {
    /// Solves in windows about the contact. `None` where the fast way leads nowhere.
    pub(super) fn solve_in_windows(
        &mut self,
        instant: &Instant<'_>,
        imposed: Imposed,
        pressure: &mut [f64],
        work: &mut Work,
    ) -> Result<Option<InstantResult>, ContactError> {
        let grid = *self.operator.grid();
        let row = grid.cells_x();
        let mut guess = Frame::of(pressure, row);
        if guess.is_none() {
            self.guess_as_hertz(instant, imposed, pressure, work)?;
            guess = Frame::of(pressure, row);
        }
        let rows = guess.map_or(0..grid.cells_y(), |loaded| loaded.rows());
        let loaded = rows.start * row..rows.end * row;
        let gap_m = &self.gap_m[loaded.clone()];
        start(imposed.target_sum(), gap_m, &mut pressure[loaded]);
        let history = Frame::of(instant.history, row);
        let mut contact = match Frame::of(pressure, row) {
            Some(loaded) => Frame::with_room(&loaded, &grid),
            None => Frame::whole(&grid),
        };
        loop {
            let windows = self.enter(instant, contact, history, pressure);
            let solved = self.solve_in_window(windows, instant, imposed, work)?;
            contact.scatter(&self.fields.pressure, row, pressure);
            let Some(state) = solved else {
                return Ok(None);
            };
            let loaded = Frame::of(&self.fields.pressure, contact.cells_x);
            let loaded = loaded.map(|loaded| loaded.moved(&contact));
            let touched = loaded.filter(|loaded| contact.is_touched_by(loaded, &grid));
            let beyond = match touched {
                Some(loaded) => Some(Frame::with_room(&loaded, &grid)),
                None => self.penetration_beyond(windows, instant, &state, work)?,
            };
            let wider = contact.holding(beyond, &grid);
            if wider == contact {
                return Ok(Some(InstantResult {
                    approach_m: state.approach_m,
                    pressure_sum: state.pressure_sum,
                    steps: work.steps,
                }));
            }
            contact = wider;
        }
    }

    /// Fills `pressure`, zero so far, with Hertz' pressure on the gap that the history leaves.
    fn guess_as_hertz(
        &mut self,
        instant: &Instant<'_>,
        imposed: Imposed,
        pressure: &mut [f64],
        work: &mut Work,
    ) -> Result<(), ContactError> {
        let mut gap_m = self.gap_m.clone();
        if instant.history.iter().any(|h| *h != 0.0) {
            let scratch = &mut self.scratches.convolution;
            (self.operator).apply(instant.history, &mut gap_m, scratch)?;
            work.convolutions += 1;
            passes::add(&mut gap_m, &self.gap_m);
        }
        let cell_m = self.nodal_area_m2().sqrt();
        hertz_guess(imposed, &gap_m, instant.compliance_per_pa, cell_m, pressure);
        Ok(())
    }

    /// Takes pressure and history into the windows.
    pub(super) fn enter(
        &mut self,
        instant: &Instant<'_>,
        contact: Frame,
        history: Option<Frame>,
        pressure: &[f64],
    ) -> Windows {
        let grid = self.operator.grid();
        let row = grid.cells_x();
        let source = contact.holding(history, grid);
        self.fields.fit(contact.cells());
        contact.gather(pressure, row, &mut self.fields.pressure);
        for field in [&mut self.history, &mut self.source, &mut self.lift_m] {
            field.resize(source.cells(), 0.0);
        }
        source.gather(instant.history, row, &mut self.history);
        let windows = Windows { contact, source };
        self.windows = Some(windows);
        windows
    }

    /// Solves in the window entered.
    fn solve_in_window(
        &mut self,
        windows: Windows,
        instant: &Instant<'_>,
        imposed: Imposed,
        work: &mut Work,
    ) -> Result<Option<IterateState>, ContactError> {
        let contact = windows.contact;
        let operator = Arc::clone(&self.operator);
        let elastic = Window {
            whole: &operator,
            operators: operator.window(contact.cells_x, contact.cells_y)?,
        };
        loop {
            let largest_m = self.lift_gap(windows, instant.compliance_per_pa)?;
            work.count_fresh_gap();
            let level_m = imposed.approach_m().unwrap_or(largest_m).abs();
            let problem = InstantOfCells {
                elastic: &elastic,
                compliance_per_pa: instant.compliance_per_pa,
                target_sum: imposed.target_sum(),
                approach_m: imposed.approach_m(),
                tolerance: self.settings.tolerance,
                fast_steps: self.fast_steps,
                noise_m: ROUNDING * (largest_m + level_m),
                has_patches: self.many_patches,
            };
            let steps = self.settings.max_iterations;
            let solved = self
                .fields
                .solve(&problem, steps, &mut self.scratches, work)?;
            if solved.is_none_or(|state| work.is_exact(&state, problem.tolerance)) {
                return Ok(solved);
            }
            // Single precision has piled up in a gap carried along by recursion: judge a fresh one.
        }
    }

    /// Gap before the approach is taken off in the window of the contact, g + B (A p + H). Returns the largest displacement (m).
    pub(super) fn lift_gap(
        &mut self,
        windows: Windows,
        compliance_per_pa: f64,
    ) -> Result<f64, ContactError> {
        let Windows { contact, source } = windows;
        self.gather_source(windows, compliance_per_pa);
        let operators = self.operator.window(source.cells_x, source.cells_y)?;
        let scratch = &mut self.scratches.convolution;
        (operators.convolution).apply(&self.source, &mut self.lift_m, scratch)?;
        let largest_m = passes::largest(&self.lift_m);
        let part = source.part(&contact);
        let gap_m = &mut self.fields.gap_m;
        contact.gather(&self.gap_m, self.operator.grid().cells_x(), gap_m);
        part.add_part(&self.lift_m, source.cells_x, gap_m);
        Ok(largest_m)
    }

    /// A p + H in the window of the sources.
    fn gather_source(&mut self, Windows { contact, source }: Windows, compliance_per_pa: f64) {
        passes::copy(&self.history, &mut self.source);
        let part = source.part(&contact);
        let (pressure, row) = (&self.fields.pressure, source.cells_x);
        part.add_scaled(pressure, compliance_per_pa, row, &mut self.source);
    }

    /// Where cells beyond the window of the contact penetrate; `None` where none does.
    fn penetration_beyond(
        &mut self,
        windows: Windows,
        instant: &Instant<'_>,
        state: &IterateState,
        work: &mut Work,
    ) -> Result<Option<Frame>, ContactError> {
        let grid = *self.operator.grid();
        if windows.contact == Frame::whole(&grid) {
            return Ok(None);
        }
        self.gather_source(windows, instant.compliance_per_pa);
        if self.is_clear_beyond(windows, state.approach_m) {
            return Ok(None);
        }
        let gap_m = self.whole_gap(windows, work)?;
        let allowed_m = state.approach_m - self.settings.tolerance * state.reference_m;
        Ok(Frame::of_cells(&gap_m, grid.cells_x(), |gap| {
            gap < allowed_m
        }))
    }

    /// Whether the sources certainly keep the surface beyond a window below the indenter at this approach; nothing is certain of a
    /// layer.
    pub(super) fn is_clear_beyond(&mut self, windows: Windows, approach_m: f64) -> bool {
        // A layer yields less than a half-space, and rises in places.
        if self.operator.layer().is_some() {
            return false;
        }
        let Windows { contact, source } = windows;
        let grid = self.operator.grid();
        let step_y = grid.spacing_y_m() / grid.spacing_x_m();
        let first = first_centre(grid);
        let corner = (source.x as f64 + first, source.y as f64 + first);
        // The hereditary part of a noisy table may lift the surface in places.
        let (mut lifting, mut sources) = (0.0, Cow::Borrowed(&self.source[..]));
        if passes::least(&self.source) < 0.0 {
            lifting = -sums::sums(&self.source, &self.source, |q, _| [q.min(0.0)])[0];
            sources = self.source.iter().map(|q| q.max(0.0)).collect();
        }
        let moments = Moments::of(&sources, source.cells_x, corner, step_y);
        let moments = moments.of_all_copies(grid);
        let lift_m = grid.copies() as f64 * lifting * Influence::new(grid).coefficient_m(0, 0);
        let bounds = &mut self.outside_bounds;
        let known = bounds.iter().position(|bound| *bound.frame() == contact);
        let at = known.unwrap_or_else(|| {
            if bounds.len() >= REMEMBERED_BOUNDS {
                bounds.clear();
            }
            bounds.push(OutsideGapBound::new(grid, &self.gap_m, contact));
            bounds.len() - 1
        });
        bounds[at].are_clear(&moments, approach_m + lift_m, grid)
    }

    /// The gap before the approach is taken off, of the whole grid.
    pub(super) fn whole_gap(
        &mut self,
        windows: Windows,
        work: &mut Work,
    ) -> Result<Vec<f64>, ContactError> {
        let grid = self.operator.grid();
        let (mut sources, mut gap_m) = (vec![0.0; grid.cells()], vec![0.0; grid.cells()]);
        (windows.source).scatter(&self.source, grid.cells_x(), &mut sources);
        let scratch = &mut self.scratches.convolution;
        self.operator.apply(&sources, &mut gap_m, scratch)?;
        work.convolutions += 1;
        passes::add(&mut gap_m, &self.gap_m);
        Ok(gap_m)
    }
}
