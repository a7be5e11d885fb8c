//! Rows and columns of one product shared among the threads of a pool.
//!
//! Work is halved as long as there are lanes for more threads; whoever of the pool is idle takes a half. Outside a pool, in a
//! pool of one thread and on small grids all stays on the thread that asked: there, waking another costs more than it saves.

use crate::numerics::threads::both;

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

/// The same rows of every panel.
pub(super) struct Panels<'a, T>([&'a mut [T]; PANELS]);

impl<'a, T> Panels<'a, T> {
    pub(super) fn new(mut panels: impl Iterator<Item = &'a mut [T]>) -> Self {
        Self(std::array::from_fn(|_| panels.next().unwrap_or_default()))
    }

    /// The elements of every panel before a place, and from it on.
    pub(super) fn split_at(self, at: usize) -> (Self, Self) {
        let mut rest = <[&mut [T]; PANELS]>::default();
        let mut rests = rest.iter_mut();
        let first = self.0.map(|panel| {
            let (before, after) = panel.split_at_mut(at.min(panel.len()));
            if let Some(rest) = rests.next() {
                *rest = after;
            }
            before
        });
        (Self(first), Self(rest))
    }

    pub(super) fn iter_mut(&mut self) -> impl Iterator<Item = &mut [T]> {
        self.0.iter_mut().map(|panel| &mut **panel)
    }
}

/// Does `length` pieces of work, in as many parts as there are lanes. `split` cuts the work before a piece.
pub(super) fn in_parts<W: Send, L: Send, E: Send>(
    work: W,
    length: usize,
    lanes: &mut [L],
    split: impl Fn(W, usize) -> (W, W) + Copy + Send + Sync,
    leaf: impl Fn(W, &mut L) -> Result<(), E> + Copy + Send + Sync,
) -> Result<(), E> {
    if lanes.len() > 1 && length > 1 {
        let half = lanes.len() / 2;
        let at = length * half / lanes.len();
        let (lanes, others) = lanes.split_at_mut(half);
        let (work, rest) = split(work, at);
        let (a, b) = both(
            || in_parts(work, at, lanes, split, leaf),
            || in_parts(rest, length - at, others, split, leaf),
        );
        return a.and(b);
    }
    match lanes.first_mut() {
        Some(lane) => leaf(work, lane),
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
                    &mut pieces[..],
                    length,
                    &mut lanes,
                    |pieces, at| pieces.split_at_mut(at),
                    |pieces, lane| {
                        *lane += pieces.len();
                        pieces.iter_mut().for_each(|piece| *piece += 1);
                        Ok::<(), ()>(())
                    },
                )
                .unwrap();
                assert!(pieces.iter().all(|&piece| piece == 1));
                assert_eq!(lanes.iter().sum::<usize>(), length);
            }
        }
    }

    #[test]
    fn panels_are_cut_at_the_same_place() {
        let mut values: Vec<usize> = (0..12).collect();
        let panels = Panels::new(values.chunks_exact_mut(4));
        let (mut before, mut after) = panels.split_at(1);
        let firsts: Vec<usize> = before.iter_mut().flatten().map(|v| *v).collect();
        assert_eq!(firsts, [0, 4, 8]);
        assert_eq!(after.iter_mut().flatten().count(), 9);
    }
}
