//! How much memory a march with the half-space engine takes, known before any of it is taken.

use super::convolution;
use super::grid::Grid;

/// Fields of one value per cell that engine and march hold, whatever the material: gap (1), pressure, gap under load, operand and
/// result of an operator (4), history, sources and displacement (3), fields on the contact alone (5: a contact
/// that fills its window takes two thirds of them, and they grow in leaps), pressure and history of the march (2), pressures extrapolated from (2).
const FIELDS: f64 = 1.0 + 4.0 + 3.0 + 5.0 + 2.0 + 2.0;

/// Memory (bytes) that marching in time takes on a grid, with so many memory variables per cell (retardation times, and one for
/// a flow term): operator, engine, march and memory, for a contact that fills the grid up to the room the program leaves about
/// it. Smaller contacts take less. To be held against what the machine has; within 20 %.
///
/// Not in it are the safeguard's fields, should it ever be needed (a fifth more), and what reports make of the results.
pub fn predicted_memory_bytes_on(grid: &Grid, branches: usize) -> u64 {
    let field = (grid.cells() * size_of::<f64>()) as f64;
    let fields = (FIELDS + branches as f64) * field;
    let operator = convolution::predicted_bytes(grid) as f64;
    (fields + operator) as u64
}

/// The same on a square grid of so many cells per side, of which no symmetry is known.
pub fn predicted_memory_bytes(cells: usize, branches: usize) -> u64 {
    // Every number of cells for which memory could be had makes a grid.
    let grid = Grid::square(cells, 1.0);
    grid.map_or(u64::MAX, |grid| predicted_memory_bytes_on(&grid, branches))
}
