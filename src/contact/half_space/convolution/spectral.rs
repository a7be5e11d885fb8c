//! A product in Fourier space of a field on a grid with a spectrum that is real and even in both directions.
//!
//! Only rows that carry values are transformed; each block of columns goes forward, through the multiplication and back while
//! it is in cache; the spectrum is stored for half the frequencies and carries the scale of the inverse transform; only the
//! rows asked for are transformed back.

use std::ops::Range;
use std::sync::Arc;

use num_complex::Complex;
use realfft::FftError;
use rustfft::{Fft, FftPlanner};

use super::super::grid::Grid;
use super::length::{conflict_free_stride, fast_column};

const ZERO: Complex<f64> = Complex { re: 0.0, im: 0.0 };

/// Side of the tiles in which rows are turned into columns: four complex numbers fill a cache line.
const TILE: usize = 4;
/// Columns transformed together: one tile. Wider blocks were measured to be no faster, and need more cache.
const BLOCK_COLUMNS: usize = TILE;

/// How a row is transformed. Plans are immutable; buffers are the caller's.
pub(super) trait Row {
    /// Length of the row on which the transform acts, that is of the period.
    fn period(&self) -> usize;

    /// Number of frequencies kept.
    fn bins(&self) -> usize;

    /// Frequency of a bin as a real even function sees it, and how often it occurs in the sum of the inverse transform as
    /// this type takes it.
    fn frequency_and_weight(&self, bin: usize) -> (usize, f64);

    /// Length of the buffer for one real row.
    fn buffer_length(&self) -> usize;

    /// Length of the work space of the transforms.
    fn work_length(&self) -> usize;

    /// Transforms `row` into `bins`, not scaled.
    fn forward(
        &self,
        row: &[f64],
        bins: &mut [Complex<f64>],
        buffer: &mut [f64],
        work: &mut [Complex<f64>],
    ) -> Result<(), FftError>;

    /// Transforms `bins`, which it overwrites, back into `row`, not scaled.
    fn inverse(
        &self,
        bins: &mut [Complex<f64>],
        row: &mut [f64],
        buffer: &mut [f64],
        work: &mut [Complex<f64>],
    ) -> Result<(), FftError>;
}

/// Sizes of the transformed grid and of the buffers on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shape {
    pub(super) cells_x: usize,
    pub(super) cells_y: usize,
    /// Frequencies kept per row, that is columns.
    columns: usize,
    /// Length of a transformed column.
    pub(super) column_length: usize,
    /// Elements from one row of the spectra to the next.
    row_stride: usize,
    /// Elements from one column of a block to the next.
    column_stride: usize,
    /// Rows of the spectra: those of the grid, filled up to whole tiles.
    rows: usize,
}

impl Shape {
    /// Columns padded to at least twice their length, as free space needs it.
    pub(super) fn new(grid: &Grid, columns: usize) -> Self {
        let column_length = fast_column(2 * grid.cells_y() - 1);
        Self::with_columns(grid, columns, column_length)
    }

    /// Columns of at least this length.
    pub(super) fn with_columns(grid: &Grid, columns: usize, column_length: usize) -> Self {
        let rows = grid.cells_y().next_multiple_of(TILE);
        Self {
            cells_x: grid.cells_x(),
            cells_y: grid.cells_y(),
            columns,
            column_length,
            row_stride: conflict_free_stride(columns.next_multiple_of(BLOCK_COLUMNS)),
            column_stride: conflict_free_stride(column_length.max(rows)),
            rows,
        }
    }

    pub(super) fn cells(&self) -> usize {
        self.cells_x * self.cells_y
    }
}

/// Work space of one thread for one shape of grid; from [`super::Convolution::scratch`].
#[derive(Clone)]
pub struct Scratch {
    pub(super) shape: Shape,
    /// The transformed rows, row by row.
    pub(super) spectra: Vec<Complex<f64>>,
    /// The columns being transformed, column by column.
    pub(super) block: Vec<Complex<f64>>,
    /// One row.
    pub(super) real: Vec<f64>,
    /// What the transforms themselves ask for.
    pub(super) work: Vec<Complex<f64>>,
}

impl std::fmt::Debug for Scratch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Scratch")
            .field("shape", &self.shape)
            .finish_non_exhaustive()
    }
}

impl Scratch {
    /// Work space that fits nothing yet.
    pub(crate) fn empty() -> Self {
        let nothing = Shape {
            cells_x: 0,
            cells_y: 0,
            columns: 0,
            column_length: 0,
            row_stride: 0,
            column_stride: 0,
            rows: 0,
        };
        Self {
            shape: nothing,
            spectra: Vec::new(),
            block: Vec::new(),
            real: Vec::new(),
            work: Vec::new(),
        }
    }
}

/// Plans and spectrum.
pub(super) struct SpectralProduct<R> {
    pub(super) shape: Shape,
    pub(super) row: R,
    column_forward: Arc<dyn Fft<f64>>,
    column_inverse: Arc<dyn Fft<f64>>,
    /// `column_length / 2 + 1` values per column.
    pub(super) spectrum: Vec<f64>,
}

impl<R: Row> SpectralProduct<R> {
    /// Plans for this shape; `spectrum` has `column_length / 2 + 1` values for every bin of `row`.
    pub(super) fn new(shape: Shape, row: R, spectrum: Vec<f64>) -> Self {
        let mut planner = FftPlanner::new();
        Self {
            shape,
            row,
            column_forward: planner.plan_fft_forward(shape.column_length),
            column_inverse: planner.plan_fft_inverse(shape.column_length),
            spectrum,
        }
    }

    /// Bytes of the spectrum.
    pub(super) fn bytes(&self) -> usize {
        self.spectrum.capacity() * size_of::<f64>()
    }

    /// Work space for one thread.
    pub(super) fn scratch(&self) -> Scratch {
        let mut scratch = Scratch::empty();
        self.fit(&mut scratch);
        scratch
    }

    /// Makes work space of any shape fit this one. Allocates only what it never held before.
    pub(super) fn fit(&self, scratch: &mut Scratch) {
        if scratch.shape == self.shape {
            return;
        }
        let work = self
            .row
            .work_length()
            .max(self.column_forward.get_inplace_scratch_len())
            .max(self.column_inverse.get_inplace_scratch_len());
        let shape = self.shape;
        scratch.shape = shape;
        resize(&mut scratch.spectra, shape.rows * shape.row_stride, ZERO);
        resize(
            &mut scratch.block,
            BLOCK_COLUMNS * shape.column_stride,
            ZERO,
        );
        resize(&mut scratch.real, self.row.buffer_length(), 0.0);
        resize(&mut scratch.work, work, ZERO);
    }

    /// The product of the spectrum with `field`, in the rows `wanted` of `image`; the other rows of `image` stay as they are.
    /// The scratch must fit.
    pub(super) fn apply(
        &self,
        field: &[f64],
        image: &mut [f64],
        wanted: Range<usize>,
        scratch: &mut Scratch,
    ) -> Result<(), FftError> {
        let cells_x = self.shape.cells_x;
        let Some(loaded) = loaded_rows(field, cells_x) else {
            image[wanted.start * cells_x..wanted.end * cells_x].fill(0.0);
            return Ok(());
        };
        self.transform_rows(field, loaded.clone(), scratch)?;
        self.multiply_columns(loaded, wanted.clone(), scratch);
        self.recover_rows(image, wanted, scratch)
    }

    /// Transforms the loaded rows of the field into the spectra.
    fn transform_rows(
        &self,
        field: &[f64],
        loaded: Range<usize>,
        scratch: &mut Scratch,
    ) -> Result<(), FftError> {
        let rows = field.chunks_exact(self.shape.cells_x);
        let spectra = scratch.spectra.chunks_exact_mut(self.shape.row_stride);
        for (row, bins) in rows.zip(spectra).take(loaded.end).skip(loaded.start) {
            let bins = &mut bins[..self.shape.columns];
            self.row
                .forward(row, bins, &mut scratch.real, &mut scratch.work)?;
        }
        Ok(())
    }

    /// Multiplies the two-dimensional spectrum, block by block of columns: the spectra enter with the loaded rows only and
    /// leave with the rows wanted.
    fn multiply_columns(&self, loaded: Range<usize>, wanted: Range<usize>, scratch: &mut Scratch) {
        let shape = &self.shape;
        let half_length = shape.column_length / 2 + 1;
        let (spectra, block) = (&mut scratch.spectra[..], &mut scratch.block[..]);
        let kernels = self.spectrum.chunks(BLOCK_COLUMNS * half_length);
        let tiles = |rows: &Range<usize>| (rows.start / TILE * TILE..rows.end).step_by(TILE);
        for (first, kernels) in (0..).step_by(BLOCK_COLUMNS).zip(kernels) {
            for row in tiles(&loaded) {
                let at = row * shape.row_stride + first;
                let to = shape.column_stride;
                transpose_tile(spectra, at, shape.row_stride, block, row, to);
            }
            let columns = block.chunks_exact_mut(shape.column_stride);
            for (column, kernel) in columns.zip(kernels.chunks_exact(half_length)) {
                let column = &mut column[..shape.column_length];
                column[..loaded.start].fill(ZERO);
                column[loaded.end..].fill(ZERO);
                self.column_forward
                    .process_with_scratch(column, &mut scratch.work);
                multiply_by_even(column, kernel);
                self.column_inverse
                    .process_with_scratch(column, &mut scratch.work);
            }
            for row in tiles(&wanted) {
                let at = row * shape.row_stride + first;
                let from = shape.column_stride;
                transpose_tile(block, row, from, spectra, at, shape.row_stride);
            }
        }
    }

    /// Transforms the wanted rows back.
    fn recover_rows(
        &self,
        image: &mut [f64],
        wanted: Range<usize>,
        scratch: &mut Scratch,
    ) -> Result<(), FftError> {
        let rows = image.chunks_exact_mut(self.shape.cells_x);
        let spectra = scratch.spectra.chunks_exact_mut(self.shape.row_stride);
        for (row, bins) in rows.zip(spectra).take(wanted.end).skip(wanted.start) {
            let bins = &mut bins[..self.shape.columns];
            self.row
                .inverse(bins, row, &mut scratch.real, &mut scratch.work)?;
        }
        Ok(())
    }
}

/// Exactly `length` values, of any content.
fn resize<T: Copy>(values: &mut Vec<T>, length: usize, filler: T) {
    if values.capacity() < length {
        values.clear();
        values.reserve_exact(length);
    }
    values.resize(length, filler);
}

/// First to last row with a value other than zero; `None` if there is none. NaN counts as a value, so it is not lost.
fn loaded_rows(field: &[f64], cells_x: usize) -> Option<Range<usize>> {
    let loaded = |row: &[f64]| row.iter().any(|&value| value != 0.0);
    let first = field.chunks_exact(cells_x).position(loaded)?;
    let last = field.chunks_exact(cells_x).rposition(loaded)?;
    Some(first..last + 1)
}

/// Copies the tile at `from[at]`, whose lines lie `stride` apart, transposed to `to[to_at]`. Whole tiles, because writing
/// full cache lines is what keeps the transposition cheap.
#[inline(always)]
fn transpose_tile(
    from: &[Complex<f64>],
    at: usize,
    stride: usize,
    to: &mut [Complex<f64>],
    to_at: usize,
    to_stride: usize,
) {
    let mut tile = [[ZERO; TILE]; TILE];
    for (line, values) in tile.iter_mut().enumerate() {
        let start = at + line * stride;
        values.copy_from_slice(&from[start..start + TILE]);
    }
    let transposed: [[Complex<f64>; TILE]; TILE] =
        std::array::from_fn(|line| std::array::from_fn(|k| tile[k][line]));
    for (line, values) in transposed.iter().enumerate() {
        let start = to_at + line * to_stride;
        to[start..start + TILE].copy_from_slice(values);
    }
}

/// Multiplies frequency `k` and its mirror image `length - k` by `even[k]`.
fn multiply_by_even(column: &mut [Complex<f64>], even: &[f64]) {
    let (Some((zero, others)), Some((even_zero, even))) =
        (column.split_first_mut(), even.split_first())
    else {
        return;
    };
    *zero *= even_zero;
    let pairs = others.len() / 2;
    let (lower, upper) = others.split_at_mut(pairs);
    let mirrored = upper.iter_mut().rev();
    for ((a, b), factor) in lower.iter_mut().zip(mirrored).zip(even) {
        *a *= factor;
        *b *= factor;
    }
    // An even length has one frequency that is its own mirror image; `upper` is then one longer than `lower`.
    if upper.len() > pairs
        && let (Some(middle), Some(factor)) = (upper.first_mut(), even.get(pairs))
    {
        *middle *= factor;
    }
}
