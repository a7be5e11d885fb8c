//! Rows and columns of one product shared among the threads of a pool.
//!
//! Work is halved as long as there are lanes for more threads; whoever of the pool is idle takes a half. Outside a pool, in a
//! pool of one thread and on small grids all stays on the thread that asked: there, waking another costs more than it saves.

use std::ops::Range;

use crate::numerics::threads::{Fields, both};

/// Panels into which columns are split at most: more threads than this cannot share one product.
pub(super) const PANELS: usize = 8;

/// Cells of a grid from which on it is shared.
const FEWEST_CELLS: usize = 1 << 14;

/// Panels of a grid of this many cells. They do not depend on the threads, so that work space fits whoever uses it.
pub(super) fn panels(cells: usize) -> usize {
    if cells < FEWEST_CELLS { 1 } else { PANELS }
}

/// How many threads may share a product on a grid of this many cells here and now.
pub(super) fn threads(cells: usize) -> usize {
    match rayon::current_thread_index() {
        Some(_) => rayon::current_num_threads().min(panels(cells)),
        None => 1,
    }
}

/// Does pieces of work on fields counted in them, in as many parts as there are lanes.
pub(super) fn in_parts<F: Fields, L: Send, E: Send>(
    pieces: Range<usize>,
    fields: F,
    lanes: &mut [L],
    leaf: impl Fn(Range<usize>, F, &mut L) -> Result<(), E> + Copy + Send + Sync,
) -> Result<(), E> {
    if lanes.len() > 1 && pieces.len() > 1 {
        let half = lanes.len() / 2;
        let at = pieces.len() * half / lanes.len();
        let middle = pieces.start + at;
        let (lanes, others) = lanes.split_at_mut(half);
        let (fields, rest) = fields.cut(at);
        let (a, b) = both(
            || in_parts(pieces.start..middle, fields, lanes, leaf),
            || in_parts(middle..pieces.end, rest, others, leaf),
        );
        return a.and(b);
    }
    match lanes.first_mut() {
        Some(lane) => leaf(pieces, fields, lane),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_piece_is_done_once_however_many_lanes_there_are() {
        for lanes in 1..10 {
            for length in [1, 2, 7, 64] {
                let mut pieces = vec![0; length];
                let mut lanes = vec![0_usize; lanes];
                in_parts(
                    0..length,
                    &mut pieces[..],
                    &mut lanes,
                    |numbers, pieces, lane| {
                        assert_eq!(numbers.len(), pieces.len());
                        *lane += pieces.len();
                        pieces
                            .iter_mut()
                            .zip(numbers)
                            .for_each(|(piece, number)| *piece += 1 + number);
                        Ok::<(), ()>(())
                    },
                )
                .unwrap();
                assert!(
                    pieces
                        .iter()
                        .enumerate()
                        .all(|(number, &piece)| piece == 1 + number)
                );
                assert_eq!(lanes.iter().sum::<usize>(), length);
            }
        }
    }
}
