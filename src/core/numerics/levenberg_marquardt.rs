//! Least squares by the method of K. Levenberg (Quart. Appl. Math. 2 (1944) 164) and D. W. Marquardt (J. SIAM 11 (1963) 431).

use nalgebra::{DMatrix, DVector};

/// Residuals, each in its standard deviation, as functions of the unknowns.
pub trait Problem {
    /// Numbers in the order of the columns of derivatives.
    type Unknowns: Clone + AsRef<[f64]> + From<Vec<f64>>;

    /// `None` where the unknowns cannot be tried.
    fn residuals(&self, unknowns: &Self::Unknowns) -> Option<DVector<f64>>;

    /// Derivatives of the residuals, a column for each unknown.
    fn derivatives(&self, unknowns: &Self::Unknowns) -> Option<DMatrix<f64>>;

    /// The same where the residuals are known, for problems that need them.
    fn derivatives_at(&self, found: &Solution<Self::Unknowns>) -> Option<DMatrix<f64>> {
        self.derivatives(&found.unknowns)
    }

    /// The nearest value that this unknown may have.
    fn clamp(&self, place: usize, value: f64) -> f64;
}

/// A column of derivatives, by the difference of the residuals this step of an unknown to either side.
pub fn central_difference(
    unknowns: &[f64],
    place: usize,
    step: f64,
    residuals: &impl Fn(Vec<f64>) -> Option<DVector<f64>>,
) -> Option<DVector<f64>> {
    let at = |off: f64| {
        let mut moved = unknowns.to_vec();
        moved[place] += off;
        residuals(moved)
    };
    Some((at(step)? - at(-step)?) / (2.0 * step))
}

/// When it ends.
#[derive(Debug, Clone, Copy)]
pub struct Ending {
    pub iterations: usize,
    /// The decrease of the sum of squares, relative, that is no longer worth a step.
    pub enough: f64,
}

/// Where it ended.
#[derive(Debug, Clone)]
pub struct Solution<U> {
    pub unknowns: U,
    pub residuals: DVector<f64>,
}

impl<U> Solution<U> {
    pub fn squares(&self) -> f64 {
        self.residuals.norm_squared()
    }
}

/// Largest step of an unknown: farther out the derivatives mean nothing.
const LARGEST_STEP: f64 = 1.5;

/// How steps are taken.
struct Way {
    /// By how much damping falls after a step that succeeds, and rises after one that does not.
    easier: f64,
    harder: f64,
    /// A step is not tried from which less than this part of a decrease that is enough is expected.
    promising: f64,
    /// Whether steps are bent.
    along_valleys: bool,
}

const STRAIGHT: Way = Way {
    easier: 0.1,
    harder: 10.0,
    promising: 0.0,
    along_valleys: false,
};
const ALONG_VALLEYS: Way = Way {
    easier: 0.2,
    harder: 3.0,
    promising: 0.1,
    along_valleys: true,
};

/// How far along a step its curvature is taken, and by how much of the step one may bend it.
const PROBED: f64 = 0.1;
const BENT: f64 = 0.375;

/// The sum of squares below which residuals are rounding.
const ROUNDING: f64 = 1e-26;

/// The least squares solution next to a start; `None` where the start cannot be tried.
pub fn minimise<P: Problem>(
    problem: &P,
    start: &P::Unknowns,
    ending: Ending,
) -> Option<Solution<P::Unknowns>> {
    search(problem, start, ending, STRAIGHT)
}

/// The same with steps that follow the curvature of a valley (M. K. Transtrum, B. B. Machta and J. P. Sethna, Phys. Rev. E 83 (2011)
/// 036701, section VIII): where several unknowns do nearly the same, a step costs the residuals once more, and most steps are saved.
pub fn minimise_along_valleys<P: Problem>(
    problem: &P,
    start: &P::Unknowns,
    ending: Ending,
) -> Option<Solution<P::Unknowns>> {
    search(problem, start, ending, ALONG_VALLEYS)
}

fn search<P: Problem>(
    problem: &P,
    start: &P::Unknowns,
    ending: Ending,
    way: Way,
) -> Option<Solution<P::Unknowns>> {
    let clamped = |unknowns: &mut dyn Iterator<Item = f64>| {
        let all = unknowns.enumerate();
        let all = all.map(|(place, value)| problem.clamp(place, value));
        P::Unknowns::from(all.collect())
    };
    let unknowns = clamped(&mut start.as_ref().iter().copied());
    let mut best = Solution {
        residuals: problem.residuals(&unknowns)?,
        unknowns,
    };
    let mut damping = 1e-2;
    for _ in 0..ending.iterations {
        let Some(matrix) = problem.derivatives_at(&best) else {
            break;
        };
        let gradient = matrix.tr_mul(&best.residuals);
        let normal = matrix.tr_mul(&matrix);
        let before = best.squares();
        let moved = |step: &DVector<f64>| {
            let moved = best.unknowns.as_ref().iter().zip(step.iter());
            clamped(&mut moved.map(|(v, step)| v + step.clamp(-LARGEST_STEP, LARGEST_STEP)))
        };
        while damping < 1e10 {
            let straight = step(&normal, &gradient, damping);
            let expected = straight.as_ref().map(|step| -step.dot(&gradient));
            if expected.is_some_and(|less| less <= way.promising * ending.enough * before) {
                break;
            }
            let trial = straight.map(|straight| {
                let bend = |ahead: DVector<f64>| {
                    let slope = (ahead - &best.residuals) / PROBED;
                    let curvature = (slope - &matrix * &straight) * (2.0 / PROBED);
                    let bend = 0.5 * step(&normal, &matrix.tr_mul(&curvature), damping)?;
                    (bend.norm() <= BENT * straight.norm()).then_some(bend)
                };
                let probed = way.along_valleys.then(|| moved(&(PROBED * &straight)));
                let ahead = probed.and_then(|probed| problem.residuals(&probed));
                match ahead.and_then(bend) {
                    Some(bend) => moved(&(straight + bend)),
                    None => moved(&straight),
                }
            });
            let residuals = trial.as_ref().and_then(|trial| problem.residuals(trial));
            if let (Some(unknowns), Some(residuals)) = (trial, residuals)
                && residuals.norm_squared() < before
            {
                (best.unknowns, best.residuals) = (unknowns, residuals);
                damping = (way.easier * damping).max(1e-12);
                break;
            }
            damping *= way.harder;
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
    Some(-damped.cholesky()?.solve(gradient)).filter(|step| step.iter().all(|s| s.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// H. H. Rosenbrock's valley (Comput. J. 3 (1960) 175): its end is at (1, 1).
    struct Valley;

    impl Problem for Valley {
        type Unknowns = Vec<f64>;

        fn residuals(&self, x: &Vec<f64>) -> Option<DVector<f64>> {
            Some(DVector::from_vec(vec![
                10.0 * (x[1] - x[0] * x[0]),
                1.0 - x[0],
            ]))
        }
        fn derivatives(&self, x: &Vec<f64>) -> Option<DMatrix<f64>> {
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

    /// After how many steps the end is found.
    fn steps_to_the_end(
        search: impl Fn(&Valley, &Vec<f64>, Ending) -> Option<Solution<Vec<f64>>>,
    ) -> usize {
        let found = |iterations| {
            let enough = 1e-12;
            let ending = Ending { iterations, enough };
            let found = search(&Valley, &vec![-1.2, 1.0], ending).unwrap();
            found.squares() < 1e-15 && (found.unknowns[0] - 1.0).abs() < 1e-7
        };
        (1..100).find(|steps| found(*steps)).unwrap()
    }

    #[test]
    fn the_end_of_a_curved_valley_is_found_and_sooner_along_its_curve() {
        let straight = steps_to_the_end(minimise);
        let bent = steps_to_the_end(minimise_along_valleys);
        assert!(3 * bent < 2 * straight, "{bent} {straight}");
    }
}
