//! A product in Fourier space of a field on a grid with a spectrum that is real and even in both directions.
//!
//! Only rows that carry values are transformed; each block of columns goes forward, through the multiplication and back while
//! it is in cache; the spectrum is stored once and carries the scale of the inverse transform; only the rows asked for are
//! transformed back. How a row and a column are transformed is left to [`Row`] and [`Column`].
//!
//! On a grid that is large enough, idle threads of the pool in which it runs take part ([`super::shared`]): rows and columns do
//! not know of one another, so that the result is the same to the last bit, whoever computes them.

use std::ops::Range;

use contact_dma_transforms::Precision;
use num_complex::Complex;
use realfft::FftError;

use super::super::grid::Grid;
use super::ConvolutionError;
use super::length::conflict_free_stride;
use super::shared::{self, PANELS, in_parts};
use crate::numerics::threads::{Fields, Rows};

/// Nothing, as a complex number.
pub(super) fn zero<T: Precision>() -> Complex<T> {
    Complex::new(T::zero(), T::zero())
}

/// Side of the tiles in which rows are turned into columns: four complex numbers fill a cache line.
const TILE: usize = 4;
/// Columns transformed together: one tile. Wider blocks were measured to be no faster, and need more cache.
const BLOCK_COLUMNS: usize = TILE;

/// How a row is transformed. Plans are immutable; buffers are the caller's.
pub(super) trait Row<T>: Send + Sync {
    /// Length of the row on which the transform acts, that is of the period.
    fn period(&self) -> usize;

    /// Number of frequencies kept.
    fn bins(&self) -> usize;

    /// Length of the buffer for one real row.
    fn buffer_length(&self) -> usize;

    /// Length of the work space of the transforms.
    fn work_length(&self) -> usize;

    /// Transforms `row` into `bins`, not scaled.
    fn forward(
        &self,
        row: &[T],
        bins: &mut [Complex<T>],
        buffer: &mut [T],
        work: &mut [Complex<T>],
    ) -> Result<(), FftError>;

    /// Transforms `bins`, which it overwrites, back into `row`, not scaled.
    fn inverse(
        &self,
        bins: &mut [Complex<T>],
        row: &mut [T],
        buffer: &mut [T],
        work: &mut [Complex<T>],
    ) -> Result<(), FftError>;
}

/// How a column of bins is multiplied by its part of the spectrum. Plans are immutable; buffers are the caller's.
pub(super) trait Column<T>: Send + Sync {
    /// Length on which the transform acts.
    fn length(&self) -> usize;

    /// Length after which a column repeats.
    fn period(&self) -> usize;

    /// Length of the work space.
    fn work_length(&self) -> usize;

    /// The product, of which the rows `wanted` must be right, of a column that has values in the rows `loaded` alone; what it
    /// holds elsewhere is to be taken for zero.
    fn multiply(
        &self,
        column: &mut [Complex<T>],
        loaded: &Range<usize>,
        wanted: &Range<usize>,
        kernel: &[T],
        work: &mut [Complex<T>],
    );
}

/// Sizes of the transformed grid and of the buffers on it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Shape {
    cells_x: usize,
    cells_y: usize,
    /// Frequencies kept per row, that is columns.
    columns: usize,
    /// Length of a transformed column.
    column_length: usize,
    /// Columns of a panel; the last one may have fewer.
    panel_columns: usize,
    /// Elements from one row of a panel to the next.
    row_stride: usize,
    /// Elements from one column of a block to the next.
    column_stride: usize,
    /// Rows of the spectra: those of the grid, filled up to whole tiles.
    rows: usize,
}

impl Shape {
    /// The shape of this many columns of this length on a grid.
    fn new(grid: &Grid, columns: usize, column_length: usize) -> Self {
        let rows = grid.cells_y().next_multiple_of(TILE);
        let panels = shared::panels(grid.cells());
        let panel_columns = columns.div_ceil(panels).next_multiple_of(BLOCK_COLUMNS);
        Self {
            cells_x: grid.cells_x(),
            cells_y: grid.cells_y(),
            columns,
            column_length,
            panel_columns,
            row_stride: conflict_free_stride(panel_columns),
            column_stride: conflict_free_stride(column_length.max(rows)),
            rows,
        }
    }

    fn cells(&self) -> usize {
        self.cells_x * self.cells_y
    }

    /// Elements of a panel.
    fn panel(&self) -> usize {
        self.rows * self.row_stride
    }
}

/// Work space of one thread that asks and those of its pool that help it, empty until a product makes it fit its grid.
#[derive(Clone, Default)]
pub struct Scratch<T = f64> {
    shape: Shape,
    /// The transformed rows: panel by panel of columns, row by row in each.
    spectra: Vec<Complex<T>>,
    /// One for every thread that may take part.
    lanes: Vec<Lane<T>>,
}

/// Work space of one thread.
#[derive(Clone, Default)]
struct Lane<T> {
    /// The columns being transformed, column by column.
    block: Vec<Complex<T>>,
    /// One row, and its transform.
    real: Vec<T>,
    bins: Vec<Complex<T>>,
    /// What the transforms themselves ask for.
    work: Vec<Complex<T>>,
}

impl<T> std::fmt::Debug for Scratch<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Scratch")
            .field("shape", &self.shape)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
impl Scratch {
    /// How many threads may share a product that has it.
    pub(super) fn lanes(&self) -> usize {
        self.lanes.len()
    }

    /// Fills it with what no result may show.
    pub(super) fn spoil(&mut self) {
        let bad = Complex::new(f64::NAN, f64::INFINITY);
        self.spectra.fill(bad);
        for lane in &mut self.lanes {
            lane.real.fill(f64::NAN);
            for values in [&mut lane.block, &mut lane.bins, &mut lane.work] {
                values.fill(bad);
            }
        }
    }
}

/// A product ready to be applied: plans and spectrum.
pub(super) struct SpectralProduct<T = f64> {
    shape: Shape,
    row: Box<dyn Row<T>>,
    column: Box<dyn Column<T>>,
    /// For every bin of a row, what its column is multiplied by.
    spectrum: Vec<T>,
}

impl<T: Precision> SpectralProduct<T> {
    /// The product with this spectrum on this grid.
    pub(super) fn new(
        grid: &Grid,
        row: impl Row<T> + 'static,
        column: impl Column<T> + 'static,
        spectrum: Vec<f64>,
    ) -> Self {
        Self {
            shape: Shape::new(grid, row.bins(), column.length()),
            row: Box::new(row),
            column: Box::new(column),
            spectrum: spectrum.into_iter().map(T::of).collect(),
        }
    }

    /// Length of the period along x and y.
    pub(super) fn periods(&self) -> (usize, usize) {
        (self.row.period(), self.column.period())
    }

    pub(super) fn spectrum(&self) -> &[T] {
        &self.spectrum
    }

    /// Makes work space of any shape fit, for the threads there are. Allocates only what it never held before.
    pub(super) fn fit(&self, scratch: &mut Scratch<T>) {
        let threads = shared::threads(self.shape.cells());
        if scratch.shape == self.shape && scratch.lanes.len() == threads {
            return;
        }
        let shape = self.shape;
        scratch.shape = shape;
        let panels = shape.columns.div_ceil(shape.panel_columns);
        resize(&mut scratch.spectra, panels * shape.panel(), zero());
        scratch.lanes.resize_with(threads, Lane::default);
        let work = self.row.work_length().max(self.column.work_length());
        for lane in &mut scratch.lanes {
            resize(&mut lane.block, BLOCK_COLUMNS * shape.column_stride, zero());
            resize(&mut lane.real, self.row.buffer_length(), T::zero());
            resize(&mut lane.bins, shape.columns, zero());
            resize(&mut lane.work, work, zero());
        }
    }

    /// The product of the spectrum with `field`, in the rows `wanted` of `image`; the other rows of `image` stay as they are.
    /// The scratch may be of any shape.
    pub(super) fn apply(
        &self,
        field: &[T],
        image: &mut [T],
        wanted: Range<usize>,
        scratch: &mut Scratch<T>,
    ) -> Result<(), ConvolutionError> {
        let shape = &self.shape;
        let expected = shape.cells();
        if field.len() != expected {
            let found = field.len();
            return Err(ConvolutionError::PressureLength { found, expected });
        }
        if image.len() != expected {
            let found = image.len();
            return Err(ConvolutionError::DisplacementLength { found, expected });
        }
        self.fit(scratch);
        let cells = |rows: &Range<usize>| rows.start * shape.cells_x..rows.end * shape.cells_x;
        let Some(loaded) = loaded_rows(field, shape.cells_x) else {
            image[cells(&wanted)].fill(T::zero());
            return Ok(());
        };
        let (spectra, lanes) = (&mut scratch.spectra[..], &mut scratch.lanes[..]);
        let mut panels = spectra.chunks_exact_mut(shape.panel());
        let panels = std::array::from_fn(|_| panels.next().unwrap_or_default());
        let (_, panels) = Rows(panels, shape.row_stride).cut(loaded.start);
        self.transform_rows(&field[cells(&loaded)], panels, lanes)?;
        self.multiply_panels(spectra, &loaded, &wanted, lanes)?;
        Ok(self.recover_rows(spectra, wanted.start, &mut image[cells(&wanted)], lanes)?)
    }

    /// Transforms rows of the field into rows of the panels.
    fn transform_rows(
        &self,
        field: &[T],
        panels: Rows<[&mut [Complex<T>]; PANELS]>,
        lanes: &mut [Lane<T>],
    ) -> Result<(), FftError> {
        let shape = &self.shape;
        let rows = field.len() / shape.cells_x;
        let fields = (Rows(field, shape.cells_x), panels);
        in_parts(
            0..rows,
            fields,
            lanes,
            |_, (Rows(field, _), Rows(mut panels, _)), lane| {
                let bins = &mut lane.bins[..shape.columns];
                for (iy, row) in field.chunks_exact(shape.cells_x).enumerate() {
                    (self.row).forward(row, bins, &mut lane.real, &mut lane.work)?;
                    let parts = bins.chunks(shape.panel_columns);
                    for (panel, part) in panels.iter_mut().zip(parts) {
                        panel[iy * shape.row_stride..][..part.len()].copy_from_slice(part);
                    }
                }
                Ok(())
            },
        )
    }

    /// Multiplies the two-dimensional spectrum, panel by panel of columns.
    fn multiply_panels(
        &self,
        spectra: &mut [Complex<T>],
        loaded: &Range<usize>,
        wanted: &Range<usize>,
        lanes: &mut [Lane<T>],
    ) -> Result<(), FftError> {
        let panel = self.shape.panel();
        let panels = spectra.len() / panel.max(1);
        in_parts(
            0..panels,
            Rows(spectra, panel),
            lanes,
            |indices, Rows(panels, _), lane| {
                for (index, panel) in indices.zip(panels.chunks_exact_mut(panel)) {
                    self.multiply_columns(index, panel, loaded, wanted, lane);
                }
                Ok(())
            },
        )
    }

    /// Multiplies a panel, block by block of columns: it enters with the loaded rows only and leaves with the rows wanted.
    fn multiply_columns(
        &self,
        index: usize,
        panel: &mut [Complex<T>],
        loaded: &Range<usize>,
        wanted: &Range<usize>,
        lane: &mut Lane<T>,
    ) {
        let shape = &self.shape;
        let kernel_length = self.spectrum.len() / shape.columns;
        let own =
            index * shape.panel_columns..((index + 1) * shape.panel_columns).min(shape.columns);
        let Some(spectrum) =
            (self.spectrum).get(own.start * kernel_length..own.end * kernel_length)
        else {
            return;
        };
        let block = &mut lane.block[..];
        let kernels = spectrum.chunks(BLOCK_COLUMNS * kernel_length);
        let tiles = |rows: &Range<usize>| (rows.start / TILE * TILE..rows.end).step_by(TILE);
        for (first, kernels) in (0..).step_by(BLOCK_COLUMNS).zip(kernels) {
            for row in tiles(loaded) {
                let at = row * shape.row_stride + first;
                let to = shape.column_stride;
                transpose_tile(panel, at, shape.row_stride, block, row, to);
            }
            let columns = block.chunks_exact_mut(shape.column_stride);
            for (column, kernel) in columns.zip(kernels.chunks_exact(kernel_length)) {
                (self.column).multiply(column, loaded, wanted, kernel, &mut lane.work);
            }
            for row in tiles(wanted) {
                let at = row * shape.row_stride + first;
                let from = shape.column_stride;
                transpose_tile(block, row, from, panel, at, shape.row_stride);
            }
        }
    }

    /// Transforms the rows from `first` on back.
    fn recover_rows(
        &self,
        spectra: &[Complex<T>],
        first: usize,
        image: &mut [T],
        lanes: &mut [Lane<T>],
    ) -> Result<(), FftError> {
        let shape = &self.shape;
        let rows = image.len() / shape.cells_x;
        in_parts(
            first..first + rows,
            Rows(image, shape.cells_x),
            lanes,
            |rows, Rows(image, _), lane| {
                let bins = &mut lane.bins[..shape.columns];
                for (iy, row) in rows.zip(image.chunks_exact_mut(shape.cells_x)) {
                    let panels = spectra.chunks_exact(shape.panel());
                    for (part, panel) in bins.chunks_mut(shape.panel_columns).zip(panels) {
                        part.copy_from_slice(&panel[iy * shape.row_stride..][..part.len()]);
                    }
                    (self.row).inverse(bins, row, &mut lane.real, &mut lane.work)?;
                }
                Ok(())
            },
        )
    }
}

/// Exactly `length` values, of any content.
fn resize<V: Copy>(values: &mut Vec<V>, length: usize, filler: V) {
    if values.capacity() < length {
        values.clear();
        values.reserve_exact(length);
    }
    values.resize(length, filler);
}

/// First to last row with a value other than zero; `None` if there is none. NaN counts as a value, so it is not lost.
fn loaded_rows<T: Precision>(field: &[T], cells_x: usize) -> Option<Range<usize>> {
    // Looking at a whole row at once is faster than stopping at its first value.
    let loaded = |row: &[T]| (row.iter()).fold(false, |any, &value| any | (value != T::zero()));
    let first = field.chunks_exact(cells_x).position(loaded)?;
    let last = field.chunks_exact(cells_x).rposition(loaded)?;
    Some(first..last + 1)
}

/// Copies the tile at `from[at]`, whose lines lie `stride` apart, transposed to `to[to_at]`. Whole tiles, because writing
/// full cache lines is what keeps the transposition cheap.
#[inline(always)]
fn transpose_tile<T: Precision>(
    from: &[Complex<T>],
    at: usize,
    stride: usize,
    to: &mut [Complex<T>],
    to_at: usize,
    to_stride: usize,
) {
    let mut tile = [[zero(); TILE]; TILE];
    for (line, values) in tile.iter_mut().enumerate() {
        // Of known length: never a call of a copying function.
        if let Some(from) = from[at + line * stride..].first_chunk() {
            *values = *from;
        }
    }
    for line in 0..TILE {
        if let Some(to) = to[to_at + line * to_stride..].first_chunk_mut() {
            *to = std::array::from_fn::<_, TILE, _>(|k| tile[k][line]);
        }
    }
}
