//! The half-space operator on a grid: displacement of every cell by the pressure on all cells, in O(N log N).
//!
//! `displacement = B * pressure` is a discrete convolution with the influence coefficients of [`super::influence`]. It is
//! done by Fourier transforms on a grid padded with zeros to at least `2n - 1` cells per direction, which keeps the
//! periodic images apart and so is exactly free space, to rounding (DC-FFT: Liu, Wang & Liu, *Wear* 243 (2000) 101).
//!
//! What makes it fast: only rows that carry load are transformed, at half length and without touching their padding
//! (`padded_row`); each block of columns goes forward, through the multiplication and back while it is in cache; the
//! spectrum of `B` is real because `B` is even, is stored for half the frequencies, and carries the scale of the inverse
//! transform; only the rows of the grid proper are transformed back.
//!
//! On a mirrored grid the transforms are cosine transforms of a quarter of the cells (`mirrored`).
//!
//! A [`Convolution`] is immutable and shared between threads, a [`Scratch`] belongs to one thread. A result depends on
//! the pressure alone, never on what the scratch held before.

mod continuation;
mod even_column;
mod length;
mod mirrored;
mod padded_row;
mod period;
mod periodic_row;
mod preconditioner;
mod shared;
mod spectral;

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use contact_dma_transforms::Precision;
use realfft::FftError;
use thiserror::Error;

use super::grid::Grid;
use super::influence::Influence;
use super::layer::{Layer, LayerInfluence};
pub(super) use continuation::{Continuation, SQUARE, each_square};
use even_column::EvenColumn;
pub(super) use length::window_length;
use mirrored::{MirroredColumn, MirroredRow};
use padded_row::PaddedRow;
pub use period::PeriodicOperator;
pub use preconditioner::Preconditioner;
pub use spectral::Scratch;
use spectral::SpectralProduct;

/// Why a convolution cannot be set up or applied.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConvolutionError {
    /// The pressure does not have one value per cell.
    #[error(
        "cannot apply the half-space operator to {found} pressures: give one per cell of the grid, that is {expected}"
    )]
    PressureLength {
        /// Values given.
        found: usize,
        /// Cells of the grid.
        expected: usize,
    },
    /// The displacement does not have one value per cell.
    #[error(
        "cannot write the displacement into {found} values: give one per cell of the grid, that is {expected}"
    )]
    DisplacementLength {
        /// Values given.
        found: usize,
        /// Cells of the grid.
        expected: usize,
    },
    /// A Fourier transform refused the buffers planned for it.
    #[error(
        "cannot transform a row of the padded grid with the buffers planned for it: this is a defect of the program, \
         please report it with the number of cells"
    )]
    Transform(#[from] FftError),
}

/// The half-space operator of one grid. Its spectra are shared with every other operator of as many cells of the same shape that is in
/// use: what a load on a half-space does is proportional to the size of the cells.
#[derive(Clone)]
pub struct Convolution {
    grid: Grid,
    /// Length (m) of a cell of this grid along x, per cell of the shared operators.
    scale_m: f64,
    operators: Arc<Operators>,
}

/// What an operator of single precision may be off by, at most, as a part of the largest displacement it gives. Seen were 1.3e-6, of
/// pressures that make white noise of 2000 x 1500 cells.
pub(super) const SINGLE: f64 = 2e-6;

/// Plans and spectrum of a grid whose cells have the length 1 along x; of the grid itself, where that lies on a layer, whose
/// thickness is a length of its own.
struct Operators {
    grid: Grid,
    /// The layer that the grid lies on, where it is no half-space.
    layer: Option<Arc<LayerInfluence>>,
    product: SpectralProduct,
    /// The same in single precision.
    nearly: SpectralProduct<f32>,
    /// What windows of this grid need, by their cells along x and y, built when first asked for.
    windows: Mutex<Vec<CachedWindow>>,
}

/// Operators of half-spaces in use.
static IN_USE: Mutex<Vec<Weak<Operators>>> = Mutex::new(Vec::new());

impl Operators {
    fn on(grid: &Grid, layer: Option<Arc<LayerInfluence>>) -> Result<Arc<Self>, ConvolutionError> {
        if layer.is_some() {
            return Ok(Arc::new(Self::new(*grid, layer)?));
        }
        let unit = grid.in_cells();
        let is_this = |operators: &Self| operators.grid == unit;
        in_use(&IN_USE, is_this, || Self::new(unit, None))
    }

    fn new(grid: Grid, layer: Option<Arc<LayerInfluence>>) -> Result<Self, ConvolutionError> {
        let (product, nearly) = free_space(&grid, layer.clone())?;
        Ok(Self {
            grid,
            product,
            nearly,
            layer,
            windows: Mutex::default(),
        })
    }

    fn window(&self, cells: (usize, usize)) -> Result<CachedWindow, ConvolutionError> {
        let windows = || self.windows.lock().unwrap_or_else(PoisonError::into_inner);
        let known = |windows: &[CachedWindow]| windows.iter().find(|w| w.cells == cells).cloned();
        if let Some(window) = known(&windows()) {
            return Ok(window);
        }
        // On a layer this takes long: those who ask for other windows do not wait.
        let grid = self.grid.part(cells.0, cells.1);
        let layer = self.layer.as_ref().map(|influence| influence.layer());
        let window = CachedWindow {
            cells,
            operators: match cells == (self.grid.cells_x(), self.grid.cells_y()) {
                true => None,
                false => Some(Self::on(&grid, self.layer.clone())?),
            },
            preconditioner: Arc::new(Preconditioner::on(&grid, layer)?),
        };
        let mut windows = windows();
        // What another thread has built meanwhile is the same.
        Ok(known(&windows).unwrap_or_else(|| {
            windows.push(window.clone());
            window
        }))
    }
}

/// What a window needs.
#[derive(Clone)]
struct CachedWindow {
    cells: (usize, usize),
    /// `None` of the whole grid, whose operators exist already.
    operators: Option<Arc<Operators>>,
    preconditioner: Arc<Preconditioner>,
}

/// What solves a contact in a window of a grid: the half-space restricted to it, and what nearly inverts that; from
/// [`Convolution::window`].
pub struct WindowOperators {
    pub convolution: Convolution,
    pub preconditioner: Arc<Preconditioner>,
}

/// The one of those in use that `is_this`; a new one, where there is none.
fn in_use<T, E>(
    all: &Mutex<Vec<Weak<T>>>,
    is_this: impl Fn(&T) -> bool,
    new: impl FnOnce() -> Result<T, E>,
) -> Result<Arc<T>, E> {
    let lock = || all.lock().unwrap_or_else(PoisonError::into_inner);
    let find = |all: &[Weak<T>]| {
        let mut in_use = all.iter().filter_map(Weak::upgrade);
        in_use.find(|one| is_this(one))
    };
    if let Some(found) = find(&lock()) {
        return Ok(found);
    }
    let new = Arc::new(new()?);
    let mut all = lock();
    // What another thread has built meanwhile is the same.
    Ok(find(&all).unwrap_or_else(|| {
        all.retain(|one| one.strong_count() > 0);
        all.push(Arc::downgrade(&new));
        new
    }))
}

impl Convolution {
    /// Plans the transforms of this grid and computes the spectrum of its influence coefficients, unless an operator in use has
    /// them. Takes about as long as five applications.
    ///
    /// # Errors
    /// [`ConvolutionError::Transform`] if a planned transform refuses its own buffers, which would be a defect.
    pub fn new(grid: Grid) -> Result<Self, ConvolutionError> {
        Self::on(grid, None)
    }

    /// The same on a layer, where there is one.
    ///
    /// # Errors
    /// As [`Convolution::new`].
    pub fn on(grid: Grid, layer: Option<Arc<LayerInfluence>>) -> Result<Self, ConvolutionError> {
        Ok(Self::of(grid, Operators::on(&grid, layer)?))
    }

    fn of(grid: Grid, operators: Arc<Operators>) -> Self {
        Self {
            grid,
            scale_m: grid.spacing_x_m() / operators.grid.spacing_x_m(),
            operators,
        }
    }

    /// The grid this operator belongs to.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The layer it is of, where the body is no half-space.
    pub fn layer(&self) -> Option<&Layer> {
        let layer = self.operators.layer.as_ref();
        layer.map(|influence| influence.layer())
    }

    /// Cells per row and per column of the padded grid on which the transforms run.
    pub fn padded_cells(&self) -> (usize, usize) {
        self.operators.product.periods()
    }

    /// Work space, for one thread that asks and those of its pool that help it.
    pub fn scratch(&self) -> Scratch {
        let mut scratch = Scratch::default();
        self.operators.product.fit(&mut scratch);
        scratch
    }

    /// The operators of a window of this many cells of this grid, at most the grid itself. Built when first asked for, then
    /// shared by all who hold this operator: what they compute does not depend on who asked first.
    ///
    /// # Errors
    /// As [`Convolution::new`].
    pub fn window(
        &self,
        cells_x: usize,
        cells_y: usize,
    ) -> Result<WindowOperators, ConvolutionError> {
        let grid = self.grid.part(cells_x, cells_y);
        let window = (self.operators).window((grid.cells_x(), grid.cells_y()))?;
        let operators = window.operators.as_ref().unwrap_or(&self.operators);
        Ok(WindowOperators {
            convolution: Self::of(grid, Arc::clone(operators)),
            preconditioner: window.preconditioner,
        })
    }

    /// Displacement of every cell's centre, in m per 1/Pa of contact compliance, by `pressure` (Pa), both row by row
    /// over [`Convolution::grid`]. The scratch is made to fit, which allocates only what it never held before. Rows without load
    /// above and below the loaded ones cost nothing.
    ///
    /// The rounding error is a few units in the last place of the largest displacement. On one machine the result is the
    /// same to the last bit for the same pressure; another processor may round differently.
    ///
    /// # Errors
    /// [`ConvolutionError`] if a slice does not have one value per cell. `displacement` is then untouched.
    pub fn apply(
        &self,
        pressure: &[f64],
        displacement: &mut [f64],
        scratch: &mut Scratch,
    ) -> Result<(), ConvolutionError> {
        let rows = 0..self.grid.cells_y();
        (self.operators.product).apply(pressure, displacement, rows, scratch)?;
        if self.scale_m != 1.0 {
            displacement.iter_mut().for_each(|u| *u *= self.scale_m);
        }
        Ok(())
    }

    /// The same in single precision, to [`SINGLE`], in units of [`Convolution::unit_m`].
    pub(super) fn apply_nearly(
        &self,
        pressure: &[f32],
        displacement: &mut [f32],
        scratch: &mut Scratch<f32>,
    ) -> Result<(), ConvolutionError> {
        let rows = 0..self.grid.cells_y();
        (self.operators.nearly).apply(pressure, displacement, rows, scratch)
    }

    /// What a displacement in single precision is counted in (m).
    pub(super) fn unit_m(&self) -> f64 {
        self.scale_m
    }
}

/// The product with the spectrum of the influence coefficients, far enough from its periodic images, in double and in single precision.
fn free_space(
    grid: &Grid,
    layer: Option<Arc<LayerInfluence>>,
) -> Result<(SpectralProduct, SpectralProduct<f32>), FftError> {
    let influence = Influence::on(grid, layer);
    if grid.is_mirrored() {
        let cells = (2 * grid.cells_x(), 2 * grid.cells_y());
        let product = mirrored(grid, &influence, cells, |_, value| value)?;
        let (row, column) = mirrored_transforms(cells);
        let nearly = SpectralProduct::new(grid, row, column, product.spectrum().to_vec());
        return Ok((product, nearly));
    }
    let (cells_x, length) = (grid.cells_x(), length::fast_column(2 * grid.cells_y() - 1));
    let row = PaddedRow::<f64>::new(cells_x);
    let coefficient = |x, y| influence.coefficient_m(x, y);
    let spectrum = even_column::spectrum(coefficient, &row, length, |_, value| value)?;
    let single = (PaddedRow::new(cells_x), EvenColumn::new(length));
    let nearly = SpectralProduct::new(grid, single.0, single.1, spectrum.clone());
    let product = SpectralProduct::new(grid, row, EvenColumn::new(length), spectrum);
    Ok((product, nearly))
}

/// The product with a function of frequency and spectrum of the influence coefficients on a mirrored grid, filled up with zeros to at
/// least this many cells along x and y.
fn mirrored<T: Precision>(
    grid: &Grid,
    influence: &Influence,
    cells: (usize, usize),
    function: impl Fn((usize, usize), f64) -> f64,
) -> Result<SpectralProduct<T>, FftError> {
    let (row, column) = mirrored_transforms(cells);
    let spectrum = mirrored::spectrum(influence, &row, &column, function)?;
    Ok(SpectralProduct::new(grid, row, column, spectrum))
}

/// Transforms of a mirrored grid filled up with zeros to at least this many cells along x and y.
fn mirrored_transforms<T: Precision>(
    (cells_x, cells_y): (usize, usize),
) -> (MirroredRow<T>, MirroredColumn<T>) {
    let half = |cells: usize| 2 * length::fast_row_half(cells);
    (
        MirroredRow::new(half(cells_x)),
        MirroredColumn::new(half(cells_y)),
    )
}

/// Numbers, spectrum and work space of one thread alike, that the operator of a grid takes, and those of its preconditioner.
pub(super) fn numbers_of_operators(grid: &Grid) -> (usize, usize) {
    let (x, y) = (grid.cells_x(), grid.cells_y());
    let row = |cells: usize| 2 * length::fast_row_half(cells);
    if grid.is_mirrored() {
        // Complex numbers at half the frequencies.
        let of = |x: usize, length_y: usize| x * (length_y + y);
        return (of(row(2 * x), row(2 * y)), of(row(x), row(y)));
    }
    let of = |columns: usize, length_y: usize| columns * (length_y / 2 + 1 + 2 * y);
    let half = row(x);
    (
        of(half + 1, length::fast_column(2 * y - 1)),
        of(half / 2 + 1, length::fast_column(y)),
    )
}

impl fmt::Debug for Convolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Convolution")
            .field("grid", &self.grid)
            .field("padded_cells", &self.padded_cells())
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::love::rectangle_displacement_m;
    use super::*;

    /// Odd, even, prime, square, flat and tall grids, with square and oblong cells.
    const SHAPES: [(usize, usize, f64, f64); 10] = [
        (1, 1, 1.0, 1.0),
        (2, 3, 1.0, 1.0),
        (1, 9, 0.5, 1.0),
        (9, 1, 0.5, 1.0),
        (7, 7, 1.0, 1.0),
        (8, 8, 1.0e-6, 1.0e-6),
        (13, 32, 1.0, 1.7),
        (31, 17, 3.0e-3, 1.0e-3),
        (64, 48, 1.0, 1.0),
        (61, 67, 1.0, 0.9),
    ];

    fn convolution(
        (cells_x, cells_y, spacing_x, spacing_y): (usize, usize, f64, f64),
    ) -> Convolution {
        Convolution::new(Grid::new(cells_x, cells_y, spacing_x, spacing_y).unwrap()).unwrap()
    }

    fn displacement(convolution: &Convolution, pressure: &[f64]) -> Vec<f64> {
        let mut displacement = vec![f64::NAN; pressure.len()];
        convolution
            .apply(pressure, &mut displacement, &mut convolution.scratch())
            .unwrap();
        displacement
    }

    /// Reproducible values in [-1, 1) (linear congruential generator of Knuth's MMIX).
    fn random(count: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        (0..count)
            .map(|_| {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
            })
            .collect()
    }

    fn dot(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    fn norm(a: &[f64]) -> f64 {
        dot(a, a).sqrt()
    }

    fn bits(values: &[f64]) -> Vec<u64> {
        values.iter().map(|value| value.to_bits()).collect()
    }

    #[test]
    fn a_loaded_cell_moves_every_cell_by_its_influence_coefficient() {
        for shape in SHAPES {
            let convolution = convolution(shape);
            let grid = *convolution.grid();
            let influence = Influence::new(&grid);
            let cells = grid.cells();
            for loaded in [0, cells / 2, cells - 1] {
                let mut pressure = vec![0.0; cells];
                pressure[loaded] = 1.0;
                let found = displacement(&convolution, &pressure);
                let (x, y) = (loaded % grid.cells_x(), loaded / grid.cells_x());
                // The rounding of the transforms is relative to the largest displacement, that of the cell itself.
                let tolerance = 8.0 * f64::EPSILON * influence.coefficient_m(0, 0);
                for (index, value) in found.iter().enumerate() {
                    let offset_x = x.abs_diff(index % grid.cells_x());
                    let offset_y = y.abs_diff(index / grid.cells_x());
                    let expected = influence.coefficient_m(offset_x, offset_y);
                    assert!(
                        (value - expected).abs() < tolerance,
                        "{shape:?}, {loaded}, {index}"
                    );
                }
            }
        }
    }

    fn single(values: &[f64]) -> Vec<f32> {
        values.iter().map(|value| *value as f32).collect()
    }

    /// The largest difference of two fields over the largest value of the first.
    fn largest_off(exact: &[f64], nearly: &[f32]) -> f64 {
        let size = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let off = exact.iter().zip(nearly);
        let off = off.map(|(a, b)| (a - f64::from(*b)).abs());
        size(&mut { off }) / size(&mut exact.iter().map(|u| u.abs()))
    }

    #[test]
    fn single_precision_is_as_exact_as_it_says_of_noise_and_of_what_undoes_noise() {
        let larger = [(300, 200, 1.0, 1.0), (512, 64, 2.0e-6, 1.0e-6)];
        let grids = SHAPES.into_iter().chain(larger);
        let grids =
            grids.map(|(x, y, along_x, along_y)| Grid::new(x, y, along_x, along_y).unwrap());
        let quarters = [Grid::square(96, 1e-6), Grid::square(400, 3.0)];
        let quarters = quarters.map(|grid| grid.unwrap().quarter().unwrap());
        let mut worst = 0.0_f64;
        for (seed, grid) in grids.chain(quarters).enumerate() {
            let convolution = Convolution::new(grid).unwrap();
            let noise = random(grid.cells(), seed as u64);
            let mut undoing = vec![0.0; grid.cells()];
            let (rows, mut scratch) = (0..grid.cells_y(), Scratch::default());
            let window = convolution.window(grid.cells_x(), grid.cells_y()).unwrap();
            let preconditioner = window.preconditioner;
            preconditioner
                .apply(&single(&noise), &mut undoing, rows.clone(), &mut scratch)
                .unwrap();
            // The noise as it was before it was rounded.
            let double = |values: &[f32]| values.iter().map(|v| f64::from(*v)).collect();
            for pressure in [&noise, &double(&undoing)] {
                let exact_m = displacement(&convolution, pressure).into_iter();
                let exact: Vec<f64> = exact_m.map(|u| u / convolution.unit_m()).collect();
                let mut nearly = vec![f32::NAN; grid.cells()];
                convolution
                    .apply_nearly(&single(pressure), &mut nearly, &mut scratch)
                    .unwrap();
                worst = worst.max(largest_off(&exact, &nearly));
            }
            if grid.is_mirrored() {
                continue;
            }
            let period = PeriodicOperator::new(grid);
            (period.apply_inverse(&single(&noise), &mut undoing, rows, &mut scratch)).unwrap();
            for pressure in [&noise, &double(&undoing)] {
                let (mut exact, mut nearly) =
                    (vec![0.0; grid.cells()], vec![f32::NAN; grid.cells()]);
                (period.apply(pressure, &mut exact, &mut Scratch::default())).unwrap();
                (period.apply_nearly(&single(pressure), &mut nearly, &mut scratch)).unwrap();
                // The mean of one cell alone, which is left out, is all there is of it.
                if grid.cells() > 1 {
                    worst = worst.max(largest_off(&exact, &nearly));
                }
            }
        }
        assert!(worst > 0.05 * SINGLE && worst < 0.7 * SINGLE, "{worst:e}");
    }

    #[test]
    fn cells_of_one_shape_have_one_operator_whatever_their_length_and_leave_nothing_behind() {
        // Of a shape that no other test has.
        let of = |spacing_m: f64| convolution((46, 27, 0.7 * spacing_m, spacing_m));
        let unit = of(1.0);
        let pressure = random(46 * 27, 3);
        let expected = displacement(&unit, &pressure);
        for spacing_m in [3.1e-7, 1.3e-5, 0.1, 2.9e3] {
            let other = of(spacing_m);
            assert!(
                Arc::ptr_eq(&unit.operators, &other.operators),
                "{spacing_m}"
            );
            for (u, expected) in displacement(&other, &pressure).iter().zip(&expected) {
                // A few roundings.
                let expected = spacing_m * expected;
                assert!(
                    (u - expected).abs() <= 1e-15 * expected.abs(),
                    "{spacing_m}"
                );
            }
        }
        let left = Arc::downgrade(&unit.operators);
        drop(unit);
        assert!(left.upgrade().is_none());
    }

    #[test]
    fn far_from_a_loaded_cell_the_surface_moves_as_under_a_point_load() {
        let convolution = convolution((257, 129, 1.0, 1.0));
        let grid = *convolution.grid();
        let mut pressure = vec![0.0; grid.cells()];
        let origin = grid.cells() / 2;
        pressure[origin] = 1.0;
        let found = displacement(&convolution, &pressure);
        for (index, value) in found.iter().enumerate() {
            let (x, y) = grid.center(index);
            let r = x.hypot(y);
            if r >= 8.0 {
                let point_load = grid.cell_area_m2() / (PI * r);
                // Multipole expansion: 1/(24 r^2) and, for r >= 8, under 1 % of that from the next term.
                assert!((value / point_load - 1.0) * r * r < 1.01 / 24.0, "{x}, {y}");
                assert!((value / point_load - 1.0) * r * r > 0.99 / 24.0, "{x}, {y}");
            }
        }
    }

    #[test]
    fn a_uniform_pressure_moves_the_surface_as_under_one_rectangle() {
        for shape in [
            (7, 7, 1.0, 1.0),
            (31, 17, 3.0e-3, 1.0e-3),
            (61, 67, 1.0, 0.9),
            (255, 5, 1.0, 1.0),
        ] {
            let convolution = convolution(shape);
            let grid = *convolution.grid();
            let found = displacement(&convolution, &vec![1.0; grid.cells()]);
            let half_x = 0.5 * grid.cells_x() as f64 * grid.spacing_x_m();
            let half_y = 0.5 * grid.cells_y() as f64 * grid.spacing_y_m();
            for index in [grid.cells() / 2, 0, grid.cells_x() - 1, grid.cells() / 3] {
                let (x, y) = grid.center(index);
                let expected = rectangle_displacement_m(x, y, half_x, half_y);
                // Rounding of the transforms, a few units in the last place of the largest displacement, which is no
                // more than some three times that of a corner.
                assert!(
                    (found[index] - expected).abs() < 2e-14 * expected,
                    "{shape:?}, {index}"
                );
            }
        }
    }

    /// A mirrored grid of this many cells, with a field, and both unfolded.
    fn quarter_and_whole(
        (cells_x, cells_y, spacing_x, spacing_y): (usize, usize, f64, f64),
    ) -> (Grid, Vec<f64>, Grid, Vec<f64>) {
        let whole = Grid::new(2 * cells_x, 2 * cells_y, spacing_x, spacing_y).unwrap();
        let quarter = whole.quarter().unwrap();
        let field = random(quarter.cells(), 11);
        let unfolded = quarter.unfolded(&field);
        (quarter, field, whole, unfolded)
    }

    #[test]
    fn threads_that_share_a_product_do_not_change_a_bit_of_it() {
        for grid in [
            Grid::new(150, 131, 1.0, 1.2).unwrap(),
            Grid::new(300, 262, 1.0, 1.2).unwrap().quarter().unwrap(),
        ] {
            let convolution = Convolution::new(grid).unwrap();
            let pressure = random(grid.cells(), 7);
            let alone = displacement(&convolution, &pressure);
            for threads in [1, 2, 3, 12] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
                let shared = (pool.build().unwrap()).install(|| {
                    assert!(convolution.scratch().lanes() == threads.min(shared::PANELS));
                    displacement(&convolution, &pressure)
                });
                assert_eq!(bits(&shared), bits(&alone), "{threads} threads");
            }
        }
    }

    #[test]
    fn on_a_mirrored_grid_a_quarter_of_the_cells_has_the_displacement_of_the_whole() {
        for shape in SHAPES {
            let (quarter, mut field, whole, _) = quarter_and_whole(shape);
            // Rows without load at either end, as in a window about a ring.
            for row in [0, quarter.cells_y() - 1] {
                if quarter.cells_y() > 4 {
                    field[row * quarter.cells_x()..][..quarter.cells_x()].fill(0.0);
                }
            }
            let own = displacement(&Convolution::new(quarter).unwrap(), &field);
            let expected = Convolution::new(whole).unwrap();
            let expected = displacement(&expected, &quarter.unfolded(&field));
            let largest = expected.iter().fold(0.0_f64, |l, u| l.max(u.abs()));
            for (a, b) in quarter.unfolded(&own).iter().zip(&expected) {
                // Rounding of two transforms, relative to what the field's largest parts make of it.
                assert!((a - b).abs() < 2e-14 * largest, "{shape:?} {a} {b}");
            }
        }
    }

    #[test]
    fn on_a_mirrored_grid_the_preconditioner_is_that_of_the_whole() {
        // Lengths at which both repeat after the same number of cells.
        for shape in [(32, 32, 1.0, 1.0), (48, 16, 1.0, 2.5), (64, 96, 3.0, 2.0)] {
            let (quarter, field, whole, unfolded) = quarter_and_whole(shape);
            let applied = |grid: &Grid, field: &[f64]| {
                let mut image = vec![0.0; grid.cells()];
                let mut scratch = Scratch::default();
                Preconditioner::on(grid, None)
                    .unwrap()
                    .apply(&single(field), &mut image, 0..grid.cells_y(), &mut scratch)
                    .unwrap();
                image.into_iter().map(f64::from).collect::<Vec<f64>>()
            };
            let own = quarter.unfolded(&applied(&quarter, &field));
            let expected = applied(&whole, &unfolded);
            let largest = expected.iter().fold(0.0_f64, |l, u| l.max(u.abs()));
            for (a, b) in own.iter().zip(&expected) {
                // Some roundings of single precision.
                let allowed = 16.0 * f64::from(f32::EPSILON) * largest;
                assert!((a - b).abs() < allowed, "{shape:?} {a} {b}");
            }
        }
    }

    #[test]
    fn the_operator_is_symmetric() {
        for (seed, shape) in (1..).zip(SHAPES) {
            let convolution = convolution(shape);
            let p = random(convolution.grid().cells(), seed);
            let q = random(convolution.grid().cells(), seed + 100);
            let (bp, bq) = (
                displacement(&convolution, &p),
                displacement(&convolution, &q),
            );
            // Both products carry the rounding of one application, relative to the size of what they multiply.
            let size = norm(&q) * norm(&bp) + norm(&p) * norm(&bq);
            assert!(
                (dot(&q, &bp) - dot(&p, &bq)).abs() < 1e-14 * size,
                "{shape:?}"
            );
        }
    }

    #[test]
    fn the_operator_is_positive_definite() {
        for shape in SHAPES {
            let convolution = convolution(shape);
            let cells_x = convolution.grid().cells_x();
            let cells = convolution.grid().cells();
            // The checkerboard is the stiffest pressure the grid holds, hence the smallest energy.
            let checkerboard = (0..cells)
                .map(|i| {
                    if (i % cells_x + i / cells_x).is_multiple_of(2) {
                        1.0
                    } else {
                        -1.0
                    }
                })
                .collect();
            for p in [
                checkerboard,
                random(cells, 3),
                random(cells, 4),
                random(cells, 5),
            ] {
                let energy = dot(&p, &displacement(&convolution, &p));
                let of_single_cells =
                    dot(&p, &p) * Influence::new(convolution.grid()).coefficient_m(0, 0);
                // The least of these, the checkerboard, has 0.52 of the energy of independent cells if the cells are
                // square and 0.43 if they are 3:1.
                assert!(
                    energy > 0.4 * of_single_cells,
                    "{shape:?}: {}",
                    energy / of_single_cells
                );
            }
        }
    }

    #[test]
    fn the_operator_is_linear() {
        for (seed, shape) in (1..).zip(SHAPES) {
            let convolution = convolution(shape);
            let cells = convolution.grid().cells();
            let (p, q) = (random(cells, seed), random(cells, seed + 50));
            let both: Vec<f64> = p.iter().zip(&q).map(|(p, q)| 3.0 * p - 0.25 * q).collect();
            let found = displacement(&convolution, &both);
            let (bp, bq) = (
                displacement(&convolution, &p),
                displacement(&convolution, &q),
            );
            let difference: Vec<f64> = (0..cells)
                .map(|i| found[i] - (3.0 * bp[i] - 0.25 * bq[i]))
                .collect();
            // Three applications' rounding.
            assert!(
                norm(&difference) < 4e-15 * (3.0 * norm(&bp) + norm(&bq)),
                "{shape:?}"
            );
        }
    }

    #[test]
    fn moving_the_load_by_whole_cells_moves_the_displacement() {
        let convolution = convolution((37, 29, 1.0, 1.2));
        let cells_x = 37;
        let (patch_x, patch_y) = (9, 6);
        let patch = random(patch_x * patch_y, 7);
        let placed = |at_x: usize, at_y: usize| {
            let mut pressure = vec![0.0; convolution.grid().cells()];
            for (iy, row) in patch.chunks_exact(patch_x).enumerate() {
                let start = (at_y + iy) * cells_x + at_x;
                pressure[start..start + patch_x].copy_from_slice(row);
            }
            displacement(&convolution, &pressure)
        };
        let (one, other) = (placed(2, 3), placed(19, 20));
        let largest = one.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        for iy in 0..29 - 17 {
            for ix in 0..37 - 17 {
                let moved = other[(iy + 17) * cells_x + ix + 17];
                // Rounding of two applications, relative to the largest displacement.
                assert!(
                    (one[iy * cells_x + ix] - moved).abs() < 4e-15 * largest,
                    "{ix}, {iy}"
                );
            }
        }
    }

    #[test]
    fn mirrored_loads_give_mirrored_displacements() {
        for shape in SHAPES {
            let convolution = convolution(shape);
            let p = random(convolution.grid().cells(), 11);
            let turned: Vec<f64> = p.iter().rev().copied().collect();
            let u = displacement(&convolution, &p);
            let mut v = displacement(&convolution, &turned);
            v.reverse();
            let difference: Vec<f64> = u.iter().zip(&v).map(|(u, v)| u - v).collect();
            // Two applications' rounding.
            assert!(norm(&difference) < 4e-15 * norm(&u), "{shape:?}");
        }
    }

    #[test]
    fn a_result_depends_on_the_pressure_alone() {
        for shape in SHAPES {
            let convolution = convolution(shape);
            let cells = convolution.grid().cells();
            let mut pressure = random(cells, 21);
            // Some rows without load, so that skipping them is part of the test.
            let cells_x = convolution.grid().cells_x();
            pressure[..cells / 3 / cells_x * cells_x].fill(0.0);
            let expected = bits(&displacement(&convolution, &pressure));

            let mut scratch = convolution.scratch();
            scratch.spoil();
            let mut found = vec![f64::NAN; cells];
            convolution
                .apply(&pressure, &mut found, &mut scratch)
                .unwrap();
            assert_eq!(bits(&found), expected, "poisoned, {shape:?}");

            let others = [vec![f64::NAN; cells], random(cells, 22), vec![1.0; cells]];
            for other in others {
                convolution.apply(&other, &mut found, &mut scratch).unwrap();
                convolution
                    .apply(&pressure, &mut found, &mut scratch)
                    .unwrap();
                assert_eq!(bits(&found), expected, "after another load, {shape:?}");
            }
        }
    }

    #[test]
    fn threads_share_one_convolution_and_agree_to_the_last_bit() {
        let convolution = convolution((31, 17, 1.0, 1.0));
        let pressure = random(31 * 17, 5);
        let expected = bits(&displacement(&convolution, &pressure));
        std::thread::scope(|scope| {
            let run = || bits(&displacement(&convolution, &pressure));
            for thread in [scope.spawn(run), scope.spawn(run)] {
                assert_eq!(thread.join().unwrap(), expected);
            }
        });
    }

    #[test]
    fn no_pressure_moves_nothing() {
        for shape in SHAPES {
            let convolution = convolution(shape);
            let found = displacement(&convolution, &vec![0.0; convolution.grid().cells()]);
            assert!(found.iter().all(|&u| u == 0.0));
            let negative_zero = displacement(&convolution, &vec![-0.0; convolution.grid().cells()]);
            assert!(negative_zero.iter().all(|&u| u == 0.0));
        }
    }

    #[test]
    fn a_pressure_that_is_no_number_is_not_hidden() {
        let convolution = convolution((8, 8, 1.0, 1.0));
        let mut pressure = vec![0.0; 64];
        pressure[27] = f64::NAN;
        assert!(
            displacement(&convolution, &pressure)
                .iter()
                .all(|u| u.is_nan())
        );
    }

    #[test]
    fn wrong_lengths_are_refused_and_a_foreign_scratch_is_made_to_fit() {
        let convolution = convolution((8, 6, 1.0, 1.0));
        let mut scratch = convolution.scratch();
        let mut u = vec![7.0; 48];
        assert!(matches!(
            convolution.apply(&[1.0; 47], &mut u, &mut scratch),
            Err(ConvolutionError::PressureLength {
                found: 47,
                expected: 48
            })
        ));
        assert!(matches!(
            convolution.apply(&[1.0; 48], &mut u[..40], &mut scratch),
            Err(ConvolutionError::DisplacementLength {
                found: 40,
                expected: 48
            })
        ));
        assert!(u.iter().all(|&u| u == 7.0));
        let expected = bits(&displacement(&convolution, &[1.0; 48]));
        // Spacing is no part of the shape: scratch space may be shared between grids of the same numbers of cells.
        for shape in [(6, 8, 1.0, 1.0), (8, 6, 0.5, 0.5), (3, 70, 1.0, 1.0)] {
            let mut foreign = self::convolution(shape).scratch();
            convolution.apply(&[1.0; 48], &mut u, &mut foreign).unwrap();
            assert_eq!(bits(&u), expected, "{shape:?}");
        }
    }

    #[test]
    fn the_padding_keeps_periodic_images_apart() {
        let padded = |grid: Grid| Convolution::new(grid).unwrap().padded_cells();
        for cells in 1..300 {
            assert!(padded(Grid::new(cells, 1, 1.0, 1.0).unwrap()).0 >= 2 * cells - 1);
            assert!(padded(Grid::new(1, cells, 1.0, 1.0).unwrap()).1 >= 2 * cells - 1);
            let mirrored = Grid::new(2, 2 * cells, 1.0, 1.0).unwrap().quarter();
            assert!(padded(mirrored.unwrap()).1 >= 4 * cells - 1);
        }
    }

    #[test]
    fn a_window_is_built_once_and_never_larger_than_the_grid() {
        let grid = Grid::new(50, 40, 1.0, 1.0).unwrap();
        let whole = Convolution::new(grid).unwrap();
        let [window, again] = [(); 2].map(|()| whole.window(32, 28).unwrap());
        assert_eq!(window.convolution.grid().cells(), 32 * 28);
        let operators = |window: &WindowOperators| Arc::as_ptr(&window.convolution.operators);
        assert_eq!(operators(&window), operators(&again));
        assert!(Arc::ptr_eq(&window.preconditioner, &again.preconditioner));
        let all = whole.window(80, 80).unwrap();
        assert_eq!(operators(&all), Arc::as_ptr(&whole.operators));
    }
}
