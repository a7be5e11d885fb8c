//! One instant on the half-space: minimise the complementary energy over p >= 0.
//!
//! An instant is solved in a window about the contact ([`active_set`](super::active_set)), to which the starting pressure and the history show the
//! way; that nothing touches the indenter beyond it is proved ([`outside`]) or, failing that, checked by a convolution on the
//! whole grid, and the window grows until it holds the contact. Where the fast way makes too little progress, a slower one on
//! the whole grid goes on from there ([`PolonskyKeer`]). The answer is a function of gap, instant and starting pressure alone:
//! nothing is carried from one instant to the next but memory already allocated. Everything that decides when to stop is a
//! ratio: the answer does not change with the user's units.

mod area;
mod frame;
mod outside;
mod tangent;
mod windows;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use frame::Frame;
use outside::OutsideGapBound;
use windows::Windows;

use super::active_set::{ActiveSet, Scratches, Work};
use super::convolution::{Convolution, ConvolutionError};
use super::instant::{Imposed, SolverSettings};
use super::passes;
use super::polonsky_keer::{InstantProblem, PolonskyKeer, Residual};
use crate::contact::surface::{PressureLine, Response, Surface};
use crate::contact::{ContactError, Engine, Instant, Prescribed, Solution, sums, surface_of_cells};

/// The half-space engine of one gap field.
pub struct HalfSpace {
    operator: Arc<Convolution>,
    settings: SolverSettings,
    gap_m: Vec<f64>,
    bounded_pressure: bool,
    /// Whether every contact is a disc.
    round_contact: bool,
    /// Whether contacts are rough, of many patches.
    many_patches: bool,
    /// Radius of the indenter's face over that of the disc with the area of the cells under it, where it ends in a rim.
    radius_ratio: f64,
    /// Steps of an instant after which the fast way is left for the safe one.
    fast_steps: usize,
    /// Cells inside the grid in which contact is an error, because the gap beside them is not known.
    end_of_data: Vec<usize>,
    fields: ActiveSet,
    scratches: Scratches,
    /// In a window that holds pressure and history: the history, the source of displacement A p + H, and the displacement.
    history: Vec<f64>,
    source: Vec<f64>,
    lift_m: Vec<f64>,
    /// Gaps beyond the windows met so far.
    outside_bounds: Vec<OutsideGapBound>,
    safeguard: Option<Box<PolonskyKeer>>,
    /// The windows of pressure and history of the instant last solved.
    windows: Option<Windows>,
    convolutions: u64,
    safeguarded: u64,
    interrupt: Option<Arc<AtomicBool>>,
}

/// An instant solved.
struct InstantResult {
    approach_m: f64,
    pressure_sum: f64,
    steps: usize,
}

impl HalfSpace {
    /// An engine for this gap field (m, one value per cell of the operator's grid; infinite where there is no indenter).
    ///
    /// `bounded_pressure` says whether the shape has a finite pressure maximum. Contact in the outermost cells of the grid is
    /// an error: what lies beyond is unknown. On a mirrored grid every field is that of the quarter, loads and areas are those of
    /// the whole surface.
    pub fn new(
        operator: Arc<Convolution>,
        gap_m: Vec<f64>,
        bounded_pressure: bool,
        settings: SolverSettings,
    ) -> Self {
        Self {
            settings,
            bounded_pressure,
            round_contact: false,
            many_patches: false,
            radius_ratio: 1.0,
            fast_steps: usize::MAX,
            end_of_data: Vec::new(),
            fields: ActiveSet::default(),
            scratches: Scratches::default(),
            history: Vec::new(),
            source: Vec::new(),
            lift_m: Vec::new(),
            outside_bounds: Vec::new(),
            safeguard: None,
            windows: None,
            convolutions: 0,
            safeguarded: 0,
            interrupt: None,
            operator,
            gap_m,
        }
    }

    /// The same engine solving every instant by its slow, safe way alone: what the fast one is checked against.
    pub fn by_safeguard_alone(self) -> Self {
        self.by_safeguard_after(0)
    }

    /// The same engine leaving the fast way for the safe one after this many steps of every instant that takes more: what happens
    /// where the fast one stalls, at will.
    pub fn by_safeguard_after(mut self, steps: usize) -> Self {
        self.fast_steps = steps;
        self
    }

    /// The same engine for a convex body of revolution on a half-space, whose contact is always a disc.
    pub fn in_round_contact(mut self) -> Self {
        self.round_contact = true;
        self
    }

    /// The same engine for a map, which may be rough: in contacts of many patches, cells of negative pressure wait where that is faster.
    pub fn in_many_patches(mut self) -> Self {
        self.many_patches = true;
        self
    }

    /// The same engine for a face that ends in a rim of this radius (m), outside of which the gap is infinite: contact radii are
    /// those of the face, where the cells under it have another area.
    pub fn ending_at_rim(mut self, radius_m: f64) -> Self {
        let cells = self.gap_m.iter().filter(|gap| gap.is_finite()).count();
        let area_m2 = cells as f64 * self.nodal_area_m2();
        self.radius_ratio = radius_m / (area_m2 / std::f64::consts::PI).sqrt();
        self
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

    /// Convolutions computed so far, in windows or on the whole grid: the unit in which this engine's work is counted.
    pub fn convolutions(&self) -> u64 {
        self.convolutions
    }

    /// Instants that the slow, safe way had to solve.
    pub fn safeguarded_instants(&self) -> u64 {
        self.safeguarded
    }

    /// The surface displacement u = B (A p + H) in metres of the instant last solved, one value per cell of the operator's grid.
    ///
    /// # Errors
    /// [`ContactError::Operator`] where a transform fails.
    pub fn displacement_m(&self, compliance_per_pa: f64) -> Result<Vec<f64>, ContactError> {
        let grid = self.operator.grid();
        let mut displacement_m = vec![0.0; grid.cells()];
        if let Some(windows) = &self.windows {
            let mut source = self.history.clone();
            let part = windows.source.part(&windows.contact);
            let row = windows.source.cells_x;
            part.add_scaled(&self.fields.pressure, compliance_per_pa, row, &mut source);
            let mut sources = vec![0.0; grid.cells()];
            (windows.source).scatter(&source, grid.cells_x(), &mut sources);
            let (operator, mut scratch) = (&self.operator, self.operator.scratch());
            operator.apply(&sources, &mut displacement_m, &mut scratch)?;
        }
        Ok(displacement_m)
    }

    /// Solves on the whole grid by the safe way.
    fn solve_safely(
        &mut self,
        instant: &Instant<'_>,
        imposed: Imposed,
        pressure: &mut [f64],
        work: &mut Work,
    ) -> Result<InstantResult, ContactError> {
        self.safeguarded += 1;
        let given = InstantProblem {
            operator: &|p, u, scratch| self.operator.apply(p, u, scratch),
            reference_m: Residual::weighted_displacement_m,
            settings: self.settings,
            gap_m: &self.gap_m,
            compliance: instant.compliance_per_pa,
            imposed,
            interrupt: self.interrupt.as_deref(),
        };
        let solved =
            PolonskyKeer::take_over(&mut self.safeguard, &given, instant.history, pressure, work);
        let found = match solved? {
            None => {
                pressure.fill(0.0);
                InstantResult {
                    approach_m: imposed.approach_m().unwrap_or(0.0),
                    pressure_sum: 0.0,
                    steps: work.steps,
                }
            }
            Some((residual, steps)) => InstantResult {
                approach_m: imposed
                    .approach_m()
                    .unwrap_or_else(|| residual.mean_approach_m()),
                pressure_sum: residual.pressure_sum,
                steps,
            },
        };
        let whole = Frame::whole(self.operator.grid());
        self.enter(instant, whole, None, pressure);
        Ok(found)
    }

    /// Area (m2) of the surface cells that one cell of the grid stands for.
    fn nodal_area_m2(&self) -> f64 {
        let grid = self.operator.grid();
        grid.copies() as f64 * grid.cell_area_m2()
    }

    /// Area under pressure of the instant last solved, in cells of the grid.
    fn contact_area_cells(&self) -> f64 {
        self.windows.as_ref().map_or(0.0, |windows| {
            let grid = self.operator.grid();
            area::contact_area_cells(grid, &windows.contact, &self.fields.pressure)
        })
    }

    /// Whether any cell on the border of the grid or of the data carries pressure; the axes of a mirrored grid are no border.
    fn touches_edge(&self, pressure: &[f64]) -> bool {
        let grid = self.operator.grid();
        let (nx, ny) = (grid.cells_x(), grid.cells_y());
        let row = |iy: usize| (0..nx).any(|ix| pressure[iy * nx + ix] > 0.0);
        let column = |ix: usize| (0..ny).any(|iy| pressure[iy * nx + ix] > 0.0);
        let first = !grid.is_mirrored() && (row(0) || column(0));
        let border = row(ny - 1) || column(nx - 1) || first;
        border || self.end_of_data.iter().any(|&cell| pressure[cell] > 0.0)
    }

    /// No load: the approach at which the indenter just touches the surface that history left.
    fn out_of_contact(
        &mut self,
        instant: &Instant<'_>,
        pressure: &mut [f64],
        work: &mut Work,
    ) -> Result<InstantResult, ContactError> {
        pressure.fill(0.0);
        let grid = *self.operator.grid();
        let history = Frame::of(instant.history, grid.cells_x());
        let window = match &history {
            Some(loaded) => Frame::with_room(loaded, &grid),
            None => Frame::whole(&grid),
        };
        let windows = self.enter(instant, window, history, pressure);
        self.lift_gap(windows, instant.compliance_per_pa)?;
        work.convolutions += 1;
        let mut approach_m = passes::least(&self.fields.gap_m);
        if window != Frame::whole(&grid) && !self.is_clear_beyond(windows, approach_m) {
            approach_m = passes::least(&self.whole_gap(windows, work)?);
        }
        Ok(InstantResult {
            approach_m,
            pressure_sum: 0.0,
            steps: 0,
        })
    }

    /// The pressure of what the drive imposes, however it is found.
    fn find(
        &mut self,
        instant: &Instant<'_>,
        prescribed: Prescribed,
        pressure: &mut [f64],
        work: &mut Work,
    ) -> Result<InstantResult, ContactError> {
        let imposed = match prescribed {
            Prescribed::LoadN(0.0) => return self.out_of_contact(instant, pressure, work),
            Prescribed::LoadN(load_n) => Imposed::PressureSum(load_n / self.nodal_area_m2()),
            Prescribed::ApproachM(approach_m) => Imposed::ApproachM(approach_m),
        };
        if self.fast_steps > 0
            && let Some(found) = self.solve_in_windows(instant, imposed, pressure, work)?
        {
            return Ok(found);
        }
        self.solve_safely(instant, imposed, pressure, work)
    }
}

impl From<ConvolutionError> for ContactError {
    fn from(error: ConvolutionError) -> Self {
        Self::Operator {
            reason: error.to_string(),
        }
    }
}

impl Engine for HalfSpace {
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
        let prescribed = instant.prescribed.check()?;
        let mut work = Work::until(self.interrupt.clone());
        let found = self.find(instant, prescribed, pressure, &mut work);
        self.convolutions += work.convolutions as u64;
        let found = found?;
        let grid = self.operator.grid();
        if self.touches_edge(pressure) {
            let whole = grid.whole();
            let half_width_m = 0.5 * whole.cells_x() as f64 * whole.spacing_x_m();
            return Err(ContactError::ReachedEdge { half_width_m });
        }
        let area_m2 = self.nodal_area_m2();
        let contact_area_m2 = self.contact_area_cells() * area_m2;
        Ok(Solution {
            load_n: found.pressure_sum * area_m2,
            approach_m: found.approach_m,
            contact_radius_m: self.radius_ratio * (contact_area_m2 / std::f64::consts::PI).sqrt(),
            iterations: found.steps,
            convolutions: work.convolutions,
        })
    }

    fn peak_pressure_pa(
        &mut self,
        pressure: &[f64],
        _solution: &Solution,
    ) -> Result<Option<f64>, ContactError> {
        Ok(self.bounded_pressure.then(|| passes::largest(pressure)))
    }

    fn tangent_radius_m(
        &mut self,
        pressure: &[f64],
        solution: &Solution,
    ) -> Result<(f64, usize), ContactError> {
        match self.round_contact || solution.contact_radius_m == 0.0 {
            true => Ok((solution.contact_radius_m, 0)),
            false => self.punch_radius_m(pressure),
        }
    }

    fn pressure_lines(&self, pressure: &[f64], _solution: &Solution) -> Vec<PressureLine> {
        PressureLine::through_centre(self.operator.grid(), pressure)
    }

    fn elastic_displacement(
        &mut self,
        pressure: &[f64],
        displacement: &mut [f64],
    ) -> Result<usize, ContactError> {
        let scratch = &mut self.scratches.convolution;
        self.operator.apply(pressure, displacement, scratch)?;
        self.convolutions += 1;
        Ok(1)
    }

    fn load_per_nodal_pressure(&self, _node: usize) -> f64 {
        self.nodal_area_m2()
    }

    fn work(&self, pressure: &[f64], displacement: &[f64]) -> f64 {
        self.nodal_area_m2() * sums::dot(pressure, displacement)
    }

    fn surface(&mut self, response: &Response<'_>) -> Result<Surface, ContactError> {
        let grid = *self.operator.grid();
        surface_of_cells(self, &grid, response)
    }
}
