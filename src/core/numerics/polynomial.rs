//! Polynomials through samples, and what is left of an error that falls like a power of the step.

/// Lagrange's polynomial through all samples.
pub fn lagrange(places: &[f64], values: &[f64], at: f64) -> f64 {
    let weight = |i: usize| -> f64 {
        let others = places.iter().enumerate().filter(|(j, _)| *j != i);
        others
            .map(|(_, other)| (at - other) / (places[i] - other))
            .product()
    };
    (0..places.len()).map(|i| values[i] * weight(i)).sum()
}

/// What is left of an error of which refining `ratio` times took `first` away, and `second.1` times `second.0` before (L. F. Richardson,
/// Phil. Trans. A 226 (1927) 299). Without the latter the order is not seen, and the lowest counts.
pub fn richardson(
    first: f64,
    ratio: f64,
    second: Option<(f64, f64)>,
    (lowest, highest): (f64, f64),
) -> f64 {
    let Some((second, second_ratio)) = second else {
        return first / (ratio.powf(lowest) - 1.0);
    };
    if first == 0.0 && second == 0.0 {
        return 0.0;
    }
    let order = ((second / first).ln() / second_ratio.ln()).clamp(lowest, highest);
    // Where the finer difference vanishes by accident, the coarser one says what to expect.
    let expected = second / (second_ratio.powf(highest) - 1.0) / ratio.powf(highest);
    (first / (ratio.powf(order) - 1.0)).max(expected)
}
