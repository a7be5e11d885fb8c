//! How much memory a march on cells takes.
//!
//! All of it is fields of one number per cell, and few of them, counted here in fields of eight bytes a cell.
//!
//! ```text
//! march         pressure, history, and the two pressures before, which help to foresee the next            4
//! body          a memory variable for every retardation time, and one for a flow term                      1 each
//! instant       pressure, gap; operand and result of an operator in single precision                       3
//!               on cells in contact: residual, preconditioned now and before, direction, constant          5
//! half-space    gap; history, sources and displacement in their window                                     4
//!               spectra of windows that the contact has outgrown                                          2
//! period        gap, and that under the history                                                            2
//! operator      spectrum and work space on the grid filled up with zeros (period: on the grid itself)      3 (1.25)
//!               the same in single precision, for changes of a gap                                         1.5 (0.625)
//! inverse       the same on the grid itself, in single precision                                           0.625
//! patches       of squares of cells: weights, values, sums, and their operator                             0.15
//! map           heights of the surface, of rough ones and those of files                                   1
//! ```
//!
//! Of a quarter of cells, the operators take 6, 3 and 1 fields. A checkpoint is written from where all these are. Not counted are the fields of the safeguard, should it ever be needed (a fifth more).

use super::convolution::numbers_of_operators;
use super::grid::Grid;

/// Fields of march and instant.
const OF_ALL: usize = 4 + 3 + 5;
/// Those that a half-space has beside, and a period.
const OF_HALF_SPACE: usize = 4 + 2;
const OF_PERIOD: usize = 2;

/// What a march on cells is on.
#[derive(Debug, Clone, Copy)]
pub struct CellField {
    pub grid: Grid,
    /// Whether the surface repeats itself.
    pub is_periodic: bool,
    /// Whether its heights are kept.
    pub is_map: bool,
}

impl CellField {
    /// Memory (bytes) that marching in time takes with this many memory variables per cell: operators, engine, march and body, for a
    /// contact that fills the grid up to the room the program leaves about it. Smaller contacts take less. To be held against what the
    /// machine has; within 20 %.
    pub fn memory_bytes(&self, branches: usize) -> u64 {
        let (cells, whole) = (self.grid.cells(), self.grid.whole().cells());
        let (engine, (exact, inverse)) = match self.is_periodic {
            true => {
                let (x, y) = (self.grid.cells_x(), self.grid.cells_y());
                let numbers = (x / 2 + 1) * (y / 2 + 1 + 2 * y);
                (OF_PERIOD, (numbers, numbers))
            }
            false => (OF_HALF_SPACE, numbers_of_operators(&self.grid)),
        };
        let map = if self.is_map { whole } else { 0 };
        let has_patches = self.is_map || self.is_periodic;
        let patches = if has_patches { cells / 4 } else { 0 };
        let doubles = (OF_ALL + engine + branches) * cells + map + patches + exact;
        let singles = exact + inverse;
        (size_of::<f64>() * doubles + size_of::<f32>() * singles) as u64
    }
}
