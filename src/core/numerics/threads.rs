//! The parts of one instant, shared among the threads of a pool.
//!
//! Such a part takes some ten to some hundred microseconds. A thread of the pool that finds nothing to do sleeps after less than that,
//! and waking it takes as long again: of a grid of 1024 x 1024 cells a tenth of the time went into it. So who has done its part stays
//! awake for a while, and who waits for the part of another does so awake. What is computed does not depend on it.

use std::cell::Cell;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long a thread stays awake with nothing to do: some times as long as waking one takes.
const AWAKE: Duration = Duration::from_micros(200);

/// Pieces of a field at most, and values from which on it is cut: below, sharing costs more than it saves.
const PIECES: usize = 8;
const FEWEST_VALUES: usize = 1 << 16;

thread_local! {
    /// How many halves this thread waits for, and whether it is awake without work: in neither case is it to stay awake for more.
    static WAITS: Cell<usize> = const { Cell::new(0) };
    static IS_LOOKING: Cell<bool> = const { Cell::new(false) };
}

/// Both, at the same time in a pool of several threads.
pub(crate) fn both<A: Send, B: Send>(
    these: impl FnOnce() -> A + Send,
    those: impl FnOnce() -> B + Send,
) -> (A, B) {
    if rayon::current_thread_index().is_none() || rayon::current_num_threads() < 2 {
        return (these(), those());
    }
    let (is_taken, is_done) = (AtomicBool::new(false), AtomicBool::new(false));
    WAITS.set(WAITS.get() + 1);
    let found = rayon::join_context(
        |_| {
            let found = these();
            let begun = Instant::now();
            let is_under_way =
                || is_taken.load(Ordering::Relaxed) && !is_done.load(Ordering::Relaxed);
            while is_under_way() && begun.elapsed() < AWAKE {
                std::hint::spin_loop();
            }
            found
        },
        |context| {
            is_taken.store(context.migrated(), Ordering::Relaxed);
            let found = those();
            is_done.store(true, Ordering::Relaxed);
            if context.migrated() && WAITS.get() == 0 && !IS_LOOKING.get() {
                rayon::spawn(stay_awake);
            }
            found
        },
    );
    WAITS.set(WAITS.get() - 1);
    found
}

/// Looks for work of the pool, and does it, until there has been none for a while.
fn stay_awake() {
    if WAITS.get() > 0 || IS_LOOKING.replace(true) {
        return;
    }
    let mut idle_since = Instant::now();
    while idle_since.elapsed() < AWAKE {
        match rayon::yield_now() {
            Some(rayon::Yield::Executed) => idle_since = Instant::now(),
            _ => std::hint::spin_loop(),
        }
    }
    IS_LOOKING.set(false);
}

/// Fields of one length, which can be cut before a place of all; an empty one is none.
pub(crate) trait Fields: Send + Sized {
    fn cut(self, at: usize) -> (Self, Self);
}

impl<T: Sync> Fields for &[T] {
    fn cut(self, at: usize) -> (Self, Self) {
        match self.is_empty() {
            true => (self, self),
            false => self.split_at(at),
        }
    }
}

impl<T: Send> Fields for &mut [T] {
    fn cut(self, at: usize) -> (Self, Self) {
        match self.is_empty() {
            true => (self, Self::default()),
            false => self.split_at_mut(at),
        }
    }
}

impl<A: Fields, B: Fields> Fields for (A, B) {
    fn cut(self, at: usize) -> (Self, Self) {
        let (a, b) = (self.0.cut(at), self.1.cut(at));
        ((a.0, b.0), (a.1, b.1))
    }
}

impl<A: Fields, B: Fields, C: Fields> Fields for (A, B, C) {
    fn cut(self, at: usize) -> (Self, Self) {
        let (first, (c, c_rest)) = ((self.0, self.1).cut(at), self.2.cut(at));
        let ((a, b), (a_rest, b_rest)) = first;
        ((a, b, c), (a_rest, b_rest, c_rest))
    }
}

impl<A: Fields + Default, const N: usize> Fields for [A; N] {
    fn cut(mut self, at: usize) -> (Self, Self) {
        let rests = self.each_mut().map(|fields| {
            let (first, rest) = std::mem::take(fields).cut(at);
            *fields = first;
            rest
        });
        (self, rests)
    }
}

/// Fields counted in rows of this many values.
pub(crate) struct Rows<A>(pub(crate) A, pub(crate) usize);

impl<A: Fields> Fields for Rows<A> {
    fn cut(self, at: usize) -> (Self, Self) {
        let (rows, rest) = self.0.cut(at * self.1);
        (Self(rows, self.1), Self(rest, self.1))
    }
}

/// Does something to pieces of fields of this length, no value of which has to do with another.
pub(crate) fn in_pieces<F: Fields>(
    length: usize,
    fields: F,
    leaf: impl Fn(Range<usize>, F) + Sync,
) {
    in_rows(length, 1, fields, leaf);
}

/// The same, of fields counted in rows of `width` values.
pub(crate) fn in_rows<F: Fields>(
    rows: usize,
    width: usize,
    fields: F,
    leaf: impl Fn(Range<usize>, F) + Sync,
) {
    let piece = match rows * width < FEWEST_VALUES {
        true => rows,
        false => rows.div_ceil(PIECES),
    };
    halve(0..rows, piece.max(1), fields, &leaf);
}

/// Does something to every item with the value of the same place; the items may take long, so that each is a piece of its own.
pub(crate) fn each_item<T: Send, V: Send>(
    items: &mut [T],
    values: &mut [V],
    leaf: impl Fn(usize, &mut T, &mut V) + Sync,
) {
    halve(
        0..items.len(),
        1,
        (items, values),
        &|numbers, (items, values)| {
            for ((number, item), value) in numbers.zip(items).zip(values) {
                leaf(number, item, value);
            }
        },
    );
}

fn halve<F: Fields>(
    values: Range<usize>,
    piece: usize,
    fields: F,
    leaf: &(impl Fn(Range<usize>, F) + Sync),
) {
    if values.len() <= piece {
        leaf(values, fields);
        return;
    }
    let half = values.len().div_ceil(piece) / 2 * piece;
    let middle = values.start + half;
    let (fields, rest) = fields.cut(half);
    both(
        || halve(values.start..middle, piece, fields, leaf),
        || halve(middle..values.end, piece, rest, leaf),
    );
}

#[cfg(test)]
mod tests {
    use std::panic::AssertUnwindSafe;
    use std::sync::atomic::AtomicUsize;

    use rayon::prelude::*;

    use super::*;

    fn pool(threads: usize) -> rayon::ThreadPool {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap()
    }

    #[test]
    fn every_value_is_met_once_at_its_place_however_many_threads_there_are() {
        for threads in [1, 2, 5] {
            for length in [
                0,
                1,
                7,
                FEWEST_VALUES - 1,
                FEWEST_VALUES,
                3 * FEWEST_VALUES + 5,
            ] {
                let places: Vec<usize> = (0..length).collect();
                let (mut found, mut met) = (vec![0; length], vec![0; length]);
                let fields = (&places[..], &mut found[..], &mut met[..]);
                let leaf =
                    |values: Range<usize>, (places, found, met): (&[usize], &mut [_], &mut [_])| {
                        assert_eq!(places, values.collect::<Vec<_>>());
                        found.copy_from_slice(places);
                        met.iter_mut().for_each(|met| *met += 1);
                    };
                pool(threads).install(|| in_pieces(length, fields, leaf));
                assert_eq!(found, places);
                assert!(met.iter().all(|met| *met == 1), "{threads} {length}");
            }
        }
    }

    #[test]
    fn rows_of_several_fields_are_cut_at_one_place_and_what_is_none_stays_so() {
        let mut values: Vec<usize> = (0..12).collect();
        let mut parts = values.chunks_exact_mut(4);
        let fields: [&mut [usize]; 5] = std::array::from_fn(|_| parts.next().unwrap_or_default());
        let (Rows(before, _), Rows(after, _)) = Rows(fields, 2).cut(1);
        assert_eq!(before.concat(), [0, 1, 4, 5, 8, 9]);
        assert_eq!(after.concat(), [2, 3, 6, 7, 10, 11]);
    }

    #[test]
    fn who_waits_awake_still_takes_part_in_what_others_have_to_do() {
        // Halves within halves, and cases beside one another, more than there are threads.
        let sum = |from: usize| {
            let cells = AtomicUsize::new(0);
            let mut field = vec![from; FEWEST_VALUES];
            for _ in 0..50 {
                in_pieces(FEWEST_VALUES, &mut field[..], |values, field| {
                    field.iter_mut().for_each(|value| *value += 1);
                    cells.fetch_add(values.len(), Ordering::Relaxed);
                });
            }
            field.iter().sum::<usize>() + cells.into_inner()
        };
        let alone: Vec<usize> = (0..7).map(sum).collect();
        for threads in [2, 3, 8] {
            let found: Vec<usize> =
                pool(threads).install(|| (0..7).into_par_iter().map(sum).collect());
            assert_eq!(found, alone);
        }
    }

    #[test]
    fn what_halves_panic_with_is_passed_on_and_the_pool_goes_on() {
        let pool = pool(2);
        let panicked = std::panic::catch_unwind(AssertUnwindSafe(|| {
            pool.install(|| both(|| 1, || panic!("a half")))
        }));
        assert!(panicked.is_err());
        assert_eq!(pool.install(|| both(|| 1, || 2)), (1, 2));
    }
}
