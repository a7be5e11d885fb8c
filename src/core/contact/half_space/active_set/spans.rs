//! The cells of a contact, as runs along the rows of a window: a field on them is stored without gaps.
//!
//! A large window is cut into blocks of whole rows, which idle threads of the pool share. Where blocks begin depends on the window
//! alone, and what is summed is summed block by block: results are the same for any number of threads.

use std::ops::Range;

use super::super::convolution::SQUARE;
use crate::contact::sums::sum;
use crate::numerics::threads::{Fields, both, each_item};

/// Blocks of a large window at most.
const BLOCKS: usize = 8;

/// Cells of a window from which on it is cut.
const FEWEST_CELLS: usize = 1 << 16;

/// Runs of cells in ascending order; none goes on from one block into the next.
#[derive(Debug, Default)]
pub(super) struct Spans {
    /// Of every block.
    found: Vec<Found>,
    /// Cells of the contact before every block, and of all of them.
    before: Vec<usize>,
    cut: Cut,
}

/// How a window is cut into blocks.
#[derive(Debug, Clone, Copy, Default)]
struct Cut {
    /// Cells of the window.
    window: usize,
    /// Cells of a block; the last one may have fewer.
    block: usize,
}

impl Cut {
    /// Of a window of rows of this many cells; no square of cells in two blocks.
    fn new(window: usize, cells_x: usize) -> Self {
        let rows = window / cells_x.max(1);
        let is_cut = window >= FEWEST_CELLS && rows >= BLOCKS;
        let block = match is_cut {
            true => rows.div_ceil(BLOCKS).next_multiple_of(SQUARE) * cells_x,
            false => window,
        };
        Self { window, block }
    }

    fn blocks(self) -> usize {
        self.window.div_ceil(self.block.max(1)).max(1)
    }

    fn cells(self, number: usize) -> Range<usize> {
        let start = number * self.block;
        start..(start + self.block).min(self.window)
    }
}

/// The runs of one block.
#[derive(Debug, Default)]
pub(super) struct Found {
    runs: Vec<Range<usize>>,
    cells: usize,
}

impl Found {
    /// Adds a cell of the block beyond all cells so far.
    pub(super) fn push(&mut self, cell: usize) {
        self.cells += 1;
        match self.runs.last_mut() {
            Some(run) if run.end == cell => run.end += 1,
            _ => self.runs.push(cell..cell + 1),
        }
    }
}

/// What a function of the cells of a block comes to for every block of a window of rows of `cells_x` cells.
pub(in super::super) fn over_blocks<const N: usize>(
    window: usize,
    cells_x: usize,
    leaf: impl Fn(Range<usize>) -> [f64; N] + Sync,
) -> OfBlocks<N> {
    let cut = Cut::new(window, cells_x);
    let (mut values, blocks) = ([[0.0; N]; BLOCKS], cut.blocks());
    each_item(
        &mut values[..blocks],
        &mut [(); BLOCKS],
        |number, value, ()| {
            *value = leaf(cut.cells(number));
        },
    );
    OfBlocks { values, blocks }
}

/// A run: its cells in the window and in a field of the contact, counted from the beginning of its block.
pub(super) struct Run {
    pub(super) window: Range<usize>,
    pub(super) contact: Range<usize>,
}

/// A block of the window.
#[derive(Debug, Clone)]
pub(super) struct Block<'a> {
    runs: &'a [Range<usize>],
    /// Its cells in the window, and in a field of the contact.
    pub(super) window: Range<usize>,
    pub(super) contact: Range<usize>,
}

impl Block<'_> {
    pub(super) fn runs(&self) -> impl Iterator<Item = Run> + '_ {
        let mut at = 0;
        self.runs.iter().map(move |run| {
            let start = at;
            at += run.len();
            Run {
                window: run.start - self.window.start..run.end - self.window.start,
                contact: start..at,
            }
        })
    }

    /// Its cells that are in no run, counted from its beginning.
    pub(super) fn others(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let starts = std::iter::once(0).chain(self.runs().map(|run| run.window.end));
        let ends = self.runs().map(|run| run.window.start);
        starts
            .zip(ends.chain(std::iter::once(self.window.len())))
            .map(|(start, end)| start..end)
    }
}

/// What every block came to.
pub(in super::super) struct OfBlocks<const N: usize> {
    values: [[f64; N]; BLOCKS],
    blocks: usize,
}

impl<const N: usize> OfBlocks<N> {
    fn used(&self, which: usize) -> impl Iterator<Item = f64> + '_ {
        self.values[..self.blocks].iter().map(move |own| own[which])
    }

    pub(in super::super) fn total(&self, which: usize) -> f64 {
        self.used(which).sum()
    }

    pub(in super::super) fn least(&self, which: usize) -> f64 {
        self.used(which).fold(f64::INFINITY, f64::min)
    }
}

impl Spans {
    /// Finds the contact anew on a window of rows of `cells_x` cells: `leaf` adds those of the cells of a block that are in it.
    pub(super) fn find<const N: usize>(
        &mut self,
        window: usize,
        cells_x: usize,
        leaf: impl Fn(Range<usize>, &mut Found) -> [f64; N] + Sync,
    ) -> OfBlocks<N> {
        let cut = Cut::new(window, cells_x);
        let (mut values, blocks) = ([[0.0; N]; BLOCKS], cut.blocks());
        self.cut = cut;
        self.found.resize_with(blocks, Found::default);
        each_item(&mut self.found, &mut values, |number, found, value| {
            found.runs.clear();
            found.cells = 0;
            *value = leaf(cut.cells(number), found);
        });
        self.before.clear();
        self.before.push(0);
        let mut cells = 0;
        self.before.extend(self.found.iter().map(|found| {
            cells += found.cells;
            cells
        }));
        OfBlocks { values, blocks }
    }

    fn block(&self, number: usize) -> Block<'_> {
        Block {
            runs: &self.found[number].runs,
            window: self.cut.cells(number),
            contact: self.before[number]..self.before[number + 1],
        }
    }

    /// What a function of every block comes to.
    pub(super) fn over<const N: usize>(
        &self,
        leaf: impl Fn(&Block<'_>) -> [f64; N] + Sync,
    ) -> OfBlocks<N> {
        self.on_contact([], |block, []| leaf(block))
    }

    /// Does something to the part that every block has of fields of the contact.
    pub(super) fn on_contact<const C: usize, const N: usize>(
        &self,
        contact: [&mut [f64]; C],
        leaf: impl Fn(&Block<'_>, [&mut [f64]; C]) -> [f64; N] + Sync,
    ) -> OfBlocks<N> {
        let none: [&mut [f64]; 0] = [];
        self.each(none, contact, |block, [], contact| leaf(block, contact))
    }

    /// Does something to every block: to its part of fields of the window, of either precision, and of fields of the contact.
    pub(super) fn each<T: Send, const W: usize, const C: usize, const N: usize>(
        &self,
        window: [&mut [T]; W],
        contact: [&mut [f64]; C],
        leaf: impl Fn(&Block<'_>, [&mut [T]; W], [&mut [f64]; C]) -> [f64; N] + Sync,
    ) -> OfBlocks<N> {
        let blocks = self.found.len();
        let mut values = [[0.0; N]; BLOCKS];
        let fields = (window, contact);
        self.each_of(0..blocks, fields, &mut values[..blocks], &leaf);
        OfBlocks { values, blocks }
    }

    fn each_of<T: Send, const W: usize, const C: usize, const N: usize>(
        &self,
        blocks: Range<usize>,
        (window, contact): ([&mut [T]; W], [&mut [f64]; C]),
        values: &mut [[f64; N]],
        leaf: &(impl Fn(&Block<'_>, [&mut [T]; W], [&mut [f64]; C]) -> [f64; N] + Sync),
    ) {
        if let [value] = values {
            *value = leaf(&self.block(blocks.start), window, contact);
            return;
        }
        let middle = usize::midpoint(blocks.start, blocks.end);
        let (values, others) = values.split_at_mut(middle - blocks.start);
        let (first, from) = (blocks.start * self.cut.block, self.before[blocks.start]);
        let (window, window_rest) = window.cut(middle * self.cut.block - first);
        let (contact, contact_rest) = contact.cut(self.before[middle] - from);
        let these = || self.each_of(blocks.start..middle, (window, contact), values, leaf);
        let those = || {
            self.each_of(
                middle..blocks.end,
                (window_rest, contact_rest),
                others,
                leaf,
            )
        };
        both(these, those);
    }

    /// Gives every block its squares of a field with one value for every square of a window of rows of `cells_x` cells.
    pub(super) fn each_of_squares(
        &self,
        squares: &mut [f32],
        cells_x: usize,
        leaf: impl Fn(&Block<'_>, &mut [f32]) + Sync,
    ) {
        let rows = (self.cut.block / cells_x.max(1)).div_ceil(SQUARE);
        let mut parts = squares.chunks_mut((rows * cells_x.div_ceil(SQUARE)).max(1));
        let mut parts: [&mut [f32]; BLOCKS] =
            std::array::from_fn(|_| parts.next().unwrap_or_default());
        let blocks = self.found.len();
        each_item(
            &mut parts[..blocks],
            &mut [(); BLOCKS],
            |number, part, ()| {
                leaf(&self.block(number), part);
            },
        );
    }

    /// Writes a field of the window into one of the contact, and sums it.
    pub(super) fn gather(&self, window: &[f32], values: &mut [f64]) -> OfBlocks<1> {
        self.on_contact([values], |block, [values]| {
            let window = &window[block.window.clone()];
            for run in block.runs() {
                let both = values[run.contact].iter_mut().zip(&window[run.window]);
                both.for_each(|(to, from)| *to = f64::from(*from));
            }
            [sum(values)]
        })
    }

    /// Number of cells.
    pub(super) fn cells(&self) -> usize {
        self.before.last().copied().unwrap_or(0)
    }

    /// Rows of `cells_x` cells from the first to the last that has a cell.
    pub(super) fn rows(&self, cells_x: usize) -> Range<usize> {
        let runs = || self.found.iter().flat_map(|found| &found.runs);
        let first = runs().next().map_or(0, |run| run.start / cells_x);
        let last = (self.found.iter().rev()).find_map(|found| found.runs.last());
        first..last.map_or(0, |run| run.end.div_ceil(cells_x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spans(window: usize, cells_x: usize, chosen: &[usize]) -> Spans {
        let mut spans = Spans::default();
        spans.find(window, cells_x, |cells, found| {
            let own = chosen.iter().filter(|cell| cells.contains(cell));
            own.for_each(|&cell| found.push(cell));
            []
        });
        spans
    }

    #[test]
    fn runs_and_the_rest_make_up_the_window() {
        let chosen = [0, 1, 4, 5, 6, 11];
        let spans = spans(12, 4, &chosen);
        assert_eq!((spans.cells(), spans.rows(4)), (6, 0..3));
        let block = spans.block(0);
        let inside: Vec<usize> = block.runs().flat_map(|run| run.window).collect();
        assert_eq!(inside, chosen);
        let outside: Vec<usize> = block.others().flatten().collect();
        assert_eq!(outside, [2, 3, 7, 8, 9, 10]);
        let mut window = [0.0; 12];
        let mut contact = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        spans.each(
            [&mut window],
            [&mut contact],
            |block, [window], [contact]| {
                for run in block.runs() {
                    window[run.window].copy_from_slice(&contact[run.contact]);
                }
                []
            },
        );
        assert_eq!((window[6], window[7], window[11]), (5.0, 0.0, 6.0));
    }

    #[test]
    fn blocks_of_a_large_window_have_every_cell_once_for_any_number_of_threads() {
        let (window, cells_x) = (300 * 300, 300);
        // Nothing in some blocks, and a run over the end of one.
        let chosen: Vec<usize> = (0..window)
            .filter(|cell| cell % 7 < 4 && !(20_000..45_000).contains(cell) && *cell < 80_000)
            .collect();
        let spans = spans(window, cells_x, &chosen);
        assert_eq!(spans.found.len(), BLOCKS);
        let values: Vec<f64> = chosen.iter().map(|cell| (*cell as f64).sqrt()).collect();
        let run = || {
            let (mut field, mut contact) = (vec![0.0; window], values.clone());
            let found = spans.each([&mut field], [&mut contact], |block, [field], [contact]| {
                assert_eq!(field.len(), block.window.len());
                assert_eq!(contact.len(), block.contact.len());
                for run in block.runs() {
                    field[run.window].copy_from_slice(&contact[run.contact]);
                }
                let others: usize = block.others().map(|cells| cells.len()).sum();
                [contact.iter().sum::<f64>(), others as f64]
            });
            assert_eq!(found.total(1) as usize, window - chosen.len());
            for (cell, value) in chosen.iter().zip(&values) {
                assert_eq!(field[*cell], *value);
            }
            found.total(0).to_bits()
        };
        let alone = run();
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            assert_eq!(pool.build().unwrap().install(run), alone);
        }
    }

    #[test]
    fn without_cells_all_is_outside() {
        let spans = spans(5, 5, &[]);
        assert_eq!(spans.block(0).others().flatten().count(), 5);
        assert_eq!(spans.rows(3), 0..0);
    }
}
