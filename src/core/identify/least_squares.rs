//! Least squares by the method of K. Levenberg (Quart. Appl. Math. 2 (1944) 164) and D. W. Marquardt (J. SIAM 11 (1963) 431).

use nalgebra::{DMatrix, DVector};

use crate::identify::series::Point;

/// Residuals, each in its standard deviation, as functions of the unknowns.
pub(super) trait Problem {
    /// `None` where the unknowns cannot be tried.
    fn residuals(&self, unknowns: &Point) -> Option<DVector<f64>>;

    /// Derivatives of the residuals, a column for each unknown.
    fn derivatives(&self, unknowns: &Point) -> Option<DMatrix<f64>>;

    /// The nearest value that this unknown may have.
    fn clamp(&self, place: usize, value: f64) -> f64;
}

/// When it ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ending {
    pub(super) iterations: usize,
    /// The decrease of the sum of squares, relative, that is no longer worth a step.
    pub(super) enough: f64,
}

/// Where it ended.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    pub(super) unknowns: Point,
    pub(super) residuals: DVector<f64>,
}

impl Solution {
    pub(super) fn squares(&self) -> f64 {
        self.residuals.norm_squared()
    }
}

/// Largest step of an unknown: farther out the derivatives mean nothing.
const LARGEST_STEP: f64 = 1.5;

/// The sum of squares below which residuals are rounding.
const ROUNDING: f64 = 1e-16;

/// The least squares solution next to a start; `None` where the start cannot be tried.
pub(super) fn minimise(problem: &impl Problem, start: &Point, ending: Ending) -> Option<Solution> {
    let clamped = |unknowns: &mut dyn Iterator<Item = f64>| {
        let all = unknowns.enumerate();
        Point(
            all.map(|(place, value)| problem.clamp(place, value))
                .collect(),
        )
    };
    let unknowns = clamped(&mut start.0.iter().copied());
    let mut best = Solution {
        residuals: problem.residuals(&unknowns)?,
        unknowns,
    };
    let mut damping = 1e-2;
    for _ in 0..ending.iterations {
        let Some(matrix) = problem.derivatives(&best.unknowns) else {
            break;
        };
        let gradient = matrix.tr_mul(&best.residuals);
        let normal = matrix.tr_mul(&matrix);
        let before = best.squares();
        while damping < 1e10 {
            let trial = step(&normal, &gradient, damping).map(|step| {
                let moved = best.unknowns.0.iter().zip(step.iter());
                clamped(&mut moved.map(|(v, step)| v - step.clamp(-LARGEST_STEP, LARGEST_STEP)))
            });
            let residuals = trial.as_ref().and_then(|trial| problem.residuals(trial));
            if let (Some(unknowns), Some(residuals)) = (trial, residuals)
                && residuals.norm_squared() < before
            {
                (best.unknowns, best.residuals) = (unknowns, residuals);
                damping = (0.1 * damping).max(1e-12);
                break;
            }
            damping *= 10.0;
        }
        let after = best.squares();
        if before - after <= ending.enough * before || after < ROUNDING {
            break;
        }
    }
    Some(best)
}

fn step(normal: &DMatrix<f64>, gradient: &DVector<f64>, damping: f64) -> Option<DVector<f64>> {
    let mut damped = normal.clone();
    let largest = (0..normal.ncols()).fold(0.0_f64, |a, k| a.max(normal[(k, k)]));
    for k in 0..normal.ncols() {
        // What has no effect at all stays where it is.
        damped[(k, k)] += damping * normal[(k, k)].max(1e-12 * largest);
    }
    Some(damped.cholesky()?.solve(gradient)).filter(|step| step.iter().all(|s| s.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// H. H. Rosenbrock's valley (Comput. J. 3 (1960) 175): its end is at (1, 1).
    struct Valley;

    impl Problem for Valley {
        fn residuals(&self, Point(x): &Point) -> Option<DVector<f64>> {
            Some(DVector::from_vec(vec![
                10.0 * (x[1] - x[0] * x[0]),
                1.0 - x[0],
            ]))
        }
        fn derivatives(&self, Point(x): &Point) -> Option<DMatrix<f64>> {
            Some(DMatrix::from_row_slice(
                2,
                2,
                &[-20.0 * x[0], 10.0, -1.0, 0.0],
            ))
        }
        fn clamp(&self, _: usize, value: f64) -> f64 {
            value.clamp(-2.0, 2.0)
        }
    }

    #[test]
    fn the_end_of_a_curved_valley_is_found() {
        let ending = Ending {
            iterations: 100,
            enough: 1e-12,
        };
        let found = minimise(&Valley, &Point(vec![-1.2, 1.0]), ending).unwrap();
        assert!(
            found.squares() < 1e-15 && (found.unknowns.0[0] - 1.0).abs() < 1e-7,
            "{found:?}"
        );
    }
}
