//! How far a cycle is from the stabilised one.
//!
//! The change from one cycle to the next is not that distance: with retardation time lambda and period T what remains
//! shrinks by exp(-T/lambda) per cycle, so that at T << lambda a cycle that hardly moves may still be far away. The memory
//! variables tell: if one cycle changes a branch's memory by dm, the sum of all changes to come is dm / (1 - exp(-T/lambda)).

/// How one branch's memory changed over a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BranchChange {
    /// Retardation time of the branch (s).
    pub retardation_time_s: f64,
    /// Largest change over the nodes between the two ends of the cycle, in the unit of the scale.
    pub largest_change: f64,
}

/// Estimated distance to the stabilised cycle, relative to `scale` (the largest nodal pressure of the cycle): the largest
/// over the branches of |change| / (1 - exp(-T/lambda)). `None` where there is no scale to compare with.
pub fn steady_distance(changes: &[BranchChange], period_s: f64, scale: f64) -> Option<f64> {
    let remaining = |change: &BranchChange| {
        change.largest_change / -(-period_s / change.retardation_time_s).exp_m1()
    };
    let distance = changes.iter().map(remaining).fold(0.0, f64::max) / scale;
    (scale > 0.0 && distance.is_finite()).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_of_a_relaxing_memory_is_what_is_left_of_it() {
        // m(n) = m* (1 - exp(-n T/lambda)): the change of any cycle tells the distance at its beginning.
        for period_over_lambda in [1e-6, 0.01, 1.0, 50.0] {
            let memory = |cycle: f64| -(-cycle * period_over_lambda).exp_m1();
            let change = BranchChange {
                retardation_time_s: 3.0,
                largest_change: memory(8.0) - memory(7.0),
            };
            let distance = steady_distance(&[change], 3.0 * period_over_lambda, 2.0);
            let left = 0.5 * (1.0 - memory(7.0));
            // The change is a difference of numbers near 1: 1e-16 over it.
            assert!((distance.unwrap() - left).abs() < 1e-9);
        }
    }

    #[test]
    fn without_a_scale_there_is_no_distance() {
        assert_eq!(steady_distance(&[], 1.0, 0.0), None);
        assert_eq!(steady_distance(&[], 1.0, 1.0), Some(0.0));
    }
}
