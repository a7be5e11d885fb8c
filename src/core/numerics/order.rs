//! Medians and monotone sequences.

/// The median: of an even number of values the mean of the two in the middle, of none 0.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => 0.0,
        even if even % 2 == 0 => 0.5 * (sorted[middle - 1] + sorted[middle]),
        _ => sorted[middle],
    }
}

/// The median, of an even number of values the upper one of the two in the middle; `None` of nothing.
pub fn upper_median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    let middle = values.len() / 2;
    let is_any = !values.is_empty();
    is_any.then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The monotone sequence nearest to the values, each of this weight, by pooling those that are out of order (M. Ayer and others, Ann.
/// Math. Statist. 26 (1955) 641).
pub fn isotonic(
    values: &[f64],
    weights: &[f64],
    out_of_order: impl Fn(f64, f64) -> bool,
) -> Vec<f64> {
    // Mean, weight and number of the values of every pool.
    let mut pools: Vec<(f64, f64, usize)> = Vec::new();
    for (&value, &weight) in values.iter().zip(weights) {
        let mut pool = (value, weight, 1);
        while let Some(&(mean, weight, count)) = pools.last()
            && out_of_order(mean, pool.0)
        {
            let both = weight + pool.1;
            let mean = mean + (pool.0 - mean) * (pool.1 / both);
            pool = (mean, both, count + pool.2);
            pools.pop();
        }
        pools.push(pool);
    }
    let values = pools
        .iter()
        .flat_map(|&(mean, _, count)| std::iter::repeat_n(mean, count));
    values.collect()
}

/// The neighbours of a place among ascending ones, and the share of the way from the first to the second; the end twice where it lies
/// outside. There is one at least.
pub(crate) fn bracket(places: &[f64], x: f64) -> (usize, usize, f64) {
    let last = places.len().saturating_sub(1);
    match places.partition_point(|&place| place < x) {
        0 => (0, 0, 0.0),
        next if next > last => (last, last, 0.0),
        next => {
            let (left, right) = (places[next - 1], places[next]);
            (next - 1, next, (x - left) / (right - left))
        }
    }
}
