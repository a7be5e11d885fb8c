//! Lengths and strides at which the transforms run fast.

/// Odd factors of the transform lengths considered. Times a power of two they make lengths at most a quarter apart, all of
/// them well served by rustfft's AVX code.
const ODD_FACTORS: [usize; 6] = [3, 5, 7, 9, 11, 27];

/// Cost of a column per point if its length has an odd factor, relative to a power of two: measured around 400 points.
const COLUMN_COST_OF_ODD_FACTOR: f64 = 1.15;

/// The same for a row. Its length is also the number of columns, whose transforms take three quarters of the time and cost
/// the same however many there are, so a long row is not worth its faster transform.
const ROW_COST_OF_ODD_FACTOR: f64 = 1.06;

/// The length of at least `minimum` that is cheapest, if a length with an odd factor costs `cost_of_odd_factor` times as
/// much per point as a power of two.
fn fast_length(minimum: usize, cost_of_odd_factor: f64) -> usize {
    let mut best = minimum.next_power_of_two();
    let mut best_cost = best as f64;
    for factor in ODD_FACTORS {
        let length = factor * minimum.div_ceil(factor).next_power_of_two();
        let cost = cost_of_odd_factor * length as f64;
        if cost < best_cost {
            (best, best_cost) = (length, cost);
        }
    }
    best
}

/// Half the length of a row of this many cells before padding.
pub(super) fn fast_row_half(cells: usize) -> usize {
    fast_length(cells.div_ceil(2), ROW_COST_OF_ODD_FACTOR)
}

/// Length of a column of at least this many values.
pub(super) fn fast_column(minimum: usize) -> usize {
    fast_length(minimum, COLUMN_COST_OF_ODD_FACTOR)
}

/// The least side of a window, in cells.
const LEAST_WINDOW: usize = 16;

/// The side of the window of a grid of `cells` per side that holds at least `needed`: one of few lengths, at most an eighth
/// apart, whose transforms run fast with and without padding; the whole grid where it is hardly larger.
pub(in super::super) fn window_length(needed: usize, cells: usize) -> usize {
    let needed = needed.max(LEAST_WINDOW);
    let fast = |factor: &usize| {
        let length = 2 * factor * needed.div_ceil(2 * factor).next_power_of_two();
        (length >= needed).then_some(length)
    };
    let best = std::iter::once(&1)
        .chain(&ODD_FACTORS)
        .filter_map(fast)
        .min();
    match best {
        Some(length) if length + length / 16 < cells => length,
        _ => cells,
    }
}

/// The number of complex elements, at least `length`, by which to space parallel lines in memory: whole cache lines, but
/// not a power of two, at which neighbouring lines would compete for the same few places of the cache.
pub(super) fn conflict_free_stride(length: usize) -> usize {
    const CACHE_LINE: usize = 4;
    let stride = length.next_multiple_of(CACHE_LINE);
    if stride.is_multiple_of(16 * CACHE_LINE) {
        stride + CACHE_LINE
    } else {
        stride
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_long_enough_and_never_twice_too_long() {
        for minimum in 1..3000 {
            for cost in [COLUMN_COST_OF_ODD_FACTOR, ROW_COST_OF_ODD_FACTOR] {
                let length = fast_length(minimum, cost);
                assert!(length >= minimum);
                assert!(length < 2 * minimum);
                let odd = length >> length.trailing_zeros();
                assert!(
                    odd == 1 || ODD_FACTORS.contains(&odd),
                    "{minimum}: {length}"
                );
            }
        }
    }

    #[test]
    fn a_power_of_two_is_taken_where_it_is_close() {
        let column = |minimum| fast_length(minimum, COLUMN_COST_OF_ODD_FACTOR);
        assert_eq!(column(1), 1);
        assert_eq!(column(300), 320);
        assert_eq!(column(399), 432);
        assert_eq!(column(440), 512);
        assert_eq!(column(511), 512);
        let row = |minimum| fast_length(minimum, ROW_COST_OF_ODD_FACTOR);
        assert_eq!(row(100), 108);
        assert_eq!(row(125), 128);
        assert_eq!(row(128), 128);
    }

    #[test]
    fn windows_are_few_hold_what_they_must_and_are_hardly_larger() {
        let mut lengths: Vec<usize> = (1..2000)
            .map(|needed| window_length(needed, 4096))
            .collect();
        for (needed, &length) in (1..2000).zip(&lengths) {
            assert!(
                length >= needed && length <= needed.max(16) * 5 / 4,
                "{needed}: {length}"
            );
        }
        lengths.dedup();
        assert!(lengths.len() < 50, "{}", lengths.len());
        // Near the size of the grid, or beyond it, the grid itself.
        assert_eq!(window_length(95, 100), 100);
        assert_eq!(window_length(100, 100), 100);
        assert_eq!(window_length(5, 10), 10);
    }

    #[test]
    fn strides_are_whole_cache_lines_and_no_large_power_of_two() {
        for length in 1..2000 {
            let stride = conflict_free_stride(length);
            assert!(stride >= length && stride < length + 8);
            assert!(stride.is_multiple_of(4) && !stride.is_multiple_of(64));
        }
    }
}
