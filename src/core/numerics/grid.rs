//! Grids of places that are evenly spaced in their logarithms, as times and frequencies of a spectrum are.

/// Steps of a grid with this many places per decade between two positive places, one at least.
fn steps(from: f64, to: f64, per_decade: f64, most: usize) -> usize {
    let steps = ((to / from).log10() * per_decade).ceil();
    // What is no number is one step.
    (steps.max(1.0) as usize).min(most)
}

/// Places evenly spaced in their logarithms, both ends among them: at least this many per decade, as long as that takes no more than the
/// most steps.
pub fn logarithmic(from: f64, to: f64, per_decade: f64, most: usize) -> Vec<f64> {
    in_steps(from, to, steps(from, to, per_decade, most))
}

/// The same in a number of steps.
pub fn in_steps(from: f64, to: f64, steps: usize) -> Vec<f64> {
    let place = |i: usize| from * (to / from).powf(i as f64 / steps as f64);
    // The end as it is, without the rounding of a power.
    (0..steps).map(place).chain([to]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_holds_its_ends_and_has_the_density_asked_for() {
        let grid = logarithmic(1e-2, 1e3, 4.0, 1000);
        assert_eq!((grid.len(), grid[0]), (21, 1e-2));
        assert!(grid[20] == 1e3 && (grid[2] / grid[0] - 10_f64.sqrt()).abs() < 1e-14);
        assert_eq!(logarithmic(1.0, 1e9, 10.0, 5).len(), 6);
        assert_eq!(logarithmic(2.0, 2.0, 10.0, 5), [2.0, 2.0]);
    }
}
