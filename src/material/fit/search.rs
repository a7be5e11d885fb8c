//! The search for few branches: non-negative least squares on a grid of times, neighbours merged, times refined, and
//! branches taken away as long as the data do not miss them. Dimensionless: values are relative to a value of the table.

use nalgebra::{DMatrix, DVector};

use crate::material::GivenFace;
use crate::material::nnls::{NnlsError, least_squares, nnls};

/// Times per decade of the grid on which two times next to one another mean one between them, and of the grids that are
/// tried where the spectrum is broad.
const FINE_GRID: f64 = 5.0;
const COARSE_GRIDS: [f64; 3] = [1.0, 1.5, 2.0];

/// Relative misfit below which an improvement is not noticeable.
pub(super) const NOTICEABLE: f64 = 1e-4;

/// Iterations of one refinement, and the relative decrease of the sum of squares at which it ends: while branches are
/// counted, and at the end.
const ROUGHLY: (usize, f64) = (30, 1e-3);
const CLOSELY: (usize, f64) = (200, 1e-10);

/// Branches that are worth merging pair by pair, all at once.
const MANY: usize = 8;

/// Branches are taken away one by one; this many ways are tried to the end, the likeliest first.
const TRIED: usize = 3;

/// What is fitted, and within which limits.
pub(super) struct Search<'a> {
    pub(super) face: GivenFace,
    /// Times in s, and values.
    pub(super) times_s: &'a [f64],
    pub(super) values: &'a [f64],
    /// Shortest and longest branch time.
    pub(super) limits_s: (f64, f64),
    /// Whether the series has a term that grows with time.
    pub(super) flow: bool,
}

/// A branch: strength and time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Branch {
    pub(super) strength: f64,
    pub(super) time_s: f64,
}

/// `constant + sum of strength * basis(t / time) + flow_per_s * t`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    pub(super) constant: f64,
    pub(super) branches: Vec<Branch>,
    pub(super) flow_per_s: f64,
}

/// What a branch contributes at x = t / time: `1 - exp(-x)` to a creep compliance, `exp(-x)` to a relaxation modulus.
fn basis(face: GivenFace, x: f64) -> f64 {
    match face {
        GivenFace::Creep => -(-x).exp_m1(),
        GivenFace::Relaxation => (-x).exp(),
    }
}

/// Its derivative with respect to the logarithm of the branch time.
fn basis_slope(face: GivenFace, x: f64) -> f64 {
    match face {
        GivenFace::Creep => -x * (-x).exp(),
        GivenFace::Relaxation => x * (-x).exp(),
    }
}

impl Series {
    /// The value at a time.
    pub(super) fn value(&self, face: GivenFace, time_s: f64) -> f64 {
        let branches = self.branches.iter();
        let delayed: f64 = branches
            .map(|b| b.strength * basis(face, time_s / b.time_s))
            .sum();
        self.constant + delayed + self.flow_per_s * time_s
    }

    /// The value that is approached without flow.
    pub(super) fn equilibrium(&self, face: GivenFace) -> f64 {
        match face {
            GivenFace::Creep => {
                self.constant + self.branches.iter().map(|b| b.strength).sum::<f64>()
            }
            GivenFace::Relaxation => self.constant,
        }
    }

    fn times_s(&self) -> Vec<f64> {
        self.branches.iter().map(|b| b.time_s).collect()
    }
}

impl Search<'_> {
    /// The series that explains the data with the fewest branches.
    pub(super) fn run(&self) -> Result<Series, NnlsError> {
        let gridded = self.strengths(&self.grid(FINE_GRID))?;
        let mut best = self.refined(&merge_runs(&gridded), ROUGHLY)?;
        for per_decade in COARSE_GRIDS {
            if self.misfit(&best) <= NOTICEABLE {
                break;
            }
            let coarse = self.strengths(&self.grid(per_decade))?;
            let coarse = self.refined(&coarse, ROUGHLY)?;
            if self.score(&coarse) < self.score(&best) {
                best = coarse;
            }
        }
        if self.score(&gridded) < self.score(&best) {
            best = gridded;
        }
        // By halves while that costs nothing, then one by one.
        while best.branches.len() >= MANY {
            let half = self.refined(&halved(&best), ROUGHLY)?;
            if self.score(&half) > self.score(&best) {
                break;
            }
            best = half;
        }
        while let Some(simpler) = self.simpler(&best)? {
            best = simpler;
        }
        self.refined(&best, CLOSELY)
    }

    /// Root mean square of the relative misfit.
    pub(super) fn misfit(&self, series: &Series) -> f64 {
        (self.squares(series) / self.values.len() as f64).sqrt()
    }

    /// The information criterion of G. Schwarz, Annals of Statistics 6 (1978) 461: lower is better. Misfits that nobody
    /// would notice count as equal; a series with as many parameters as there are data explains nothing.
    pub(super) fn score(&self, series: &Series) -> f64 {
        let count = self.values.len();
        let flows = usize::from(series.flow_per_s > 0.0);
        let parameters = usize::from(series.constant > 0.0) + 2 * series.branches.len() + flows;
        if parameters >= count {
            return f64::INFINITY;
        }
        let variance = self.squares(series) / count as f64 + NOTICEABLE * NOTICEABLE;
        count as f64 * variance.ln() + parameters as f64 * (count as f64).ln()
    }

    /// A series with a branch less that scores no worse, if there is one.
    fn simpler(&self, series: &Series) -> Result<Option<Series>, NnlsError> {
        let mut candidates: Vec<(f64, Series)> = fewer(series)
            .into_iter()
            .map(|candidate| (self.quick_squares(&candidate), candidate))
            .collect();
        candidates.sort_by(|left, right| left.0.total_cmp(&right.0));
        let limit = self.score(series);
        for (_, candidate) in candidates.into_iter().take(TRIED) {
            let refined = self.refined(&candidate, ROUGHLY)?;
            if self.score(&refined) <= limit {
                return Ok(Some(refined));
            }
        }
        Ok(None)
    }

    fn squares(&self, series: &Series) -> f64 {
        let pairs = self.times_s.iter().zip(self.values);
        pairs
            .map(|(&t, v)| (series.value(self.face, t) / v - 1.0).powi(2))
            .sum()
    }

    /// Sum of squares with the best strengths of either sign at these times: a quick measure of what a candidate can do.
    fn quick_squares(&self, series: &Series) -> f64 {
        let matrix = self.matrix(&series.times_s());
        let ones = DVector::from_element(self.values.len(), 1.0);
        least_squares(&matrix, &ones).map_or(f64::INFINITY, |strengths| {
            (ones - matrix * strengths).norm_squared()
        })
    }

    fn grid(&self, per_decade: f64) -> Vec<f64> {
        let (shortest, longest) = self.limits_s;
        let steps = ((longest / shortest).log10() * per_decade).ceil().max(1.0);
        (0..=steps as usize)
            .map(|i| shortest * (longest / shortest).powf(i as f64 / steps))
            .collect()
    }

    /// Columns over the data, each divided by the value there: constant, branches, flow (per last time).
    fn matrix(&self, times_s: &[f64]) -> DMatrix<f64> {
        let columns = 1 + times_s.len() + usize::from(self.flow);
        DMatrix::from_fn(self.values.len(), columns, |row, column| {
            let time_s = self.times_s[row];
            let basis = match column.checked_sub(1).map(|branch| times_s.get(branch)) {
                None => 1.0,
                Some(Some(branch_s)) => basis(self.face, time_s / branch_s),
                Some(None) => time_s / self.last_s(),
            };
            basis / self.values[row]
        })
    }

    fn last_s(&self) -> f64 {
        self.times_s.last().copied().unwrap_or(1.0)
    }

    /// The best strengths at given times, none negative; branches of strength zero are left out.
    fn strengths(&self, times_s: &[f64]) -> Result<Series, NnlsError> {
        let ones = DVector::from_element(self.values.len(), 1.0);
        let found = nnls(&self.matrix(times_s), &ones)?;
        let branches = times_s.iter().zip(found.iter().skip(1));
        Ok(Series {
            constant: found[0],
            branches: branches
                .filter(|(_, strength)| **strength > 0.0)
                .map(|(&time_s, &strength)| Branch { strength, time_s })
                .collect(),
            flow_per_s: if self.flow {
                found[times_s.len() + 1] / self.last_s()
            } else {
                0.0
            },
        })
    }

    /// Times and strengths improved together (K. Levenberg 1944, D. W. Marquardt 1963), then the best strengths.
    fn refined(
        &self,
        series: &Series,
        (iterations, enough): (usize, f64),
    ) -> Result<Series, NnlsError> {
        let mut best = self.strengths(&series.times_s())?;
        let mut squares = self.squares(&best);
        let mut damping = 1e-3;
        for _ in 0..iterations {
            let Some(step) = self.step(&best, damping) else {
                break;
            };
            let trial = self.moved(&best, &step);
            let trial_squares = self.squares(&trial);
            if trial_squares < squares {
                let settled = squares - trial_squares < enough * squares;
                (best, squares) = (trial, trial_squares);
                damping = (0.1 * damping).max(1e-15);
                if settled {
                    break;
                }
            } else {
                damping *= 10.0;
                if damping > 1e6 {
                    break;
                }
            }
        }
        best.branches
            .sort_by(|left, right| left.time_s.total_cmp(&right.time_s));
        let polished = self.strengths(&best.times_s())?;
        // Where the strengths are ill determined, rounding may make the polish the worse of the two.
        Ok(if self.squares(&polished) <= squares {
            polished
        } else {
            best
        })
    }

    /// The damped step in (constant, ln strength and ln time of every branch, flow).
    fn step(&self, series: &Series, damping: f64) -> Option<DVector<f64>> {
        let (rows, branches) = (self.values.len(), series.branches.len());
        let columns = 1 + 2 * branches + usize::from(self.flow);
        let mut matrix = DMatrix::zeros(rows + columns, columns);
        let mut right = DVector::zeros(rows + columns);
        for (row, (&time_s, value)) in self.times_s.iter().zip(self.values).enumerate() {
            matrix[(row, 0)] = 1.0 / value;
            for (place, branch) in series.branches.iter().enumerate() {
                let (x, strength) = (time_s / branch.time_s, branch.strength / value);
                matrix[(row, 1 + place)] = strength * basis(self.face, x);
                matrix[(row, 1 + branches + place)] = strength * basis_slope(self.face, x);
            }
            if self.flow {
                matrix[(row, columns - 1)] = time_s / self.last_s() / value;
            }
            right[row] = 1.0 - series.value(self.face, time_s) / value;
        }
        for column in 0..columns {
            let length = matrix.column(column).rows(0, rows).norm();
            matrix[(rows + column, column)] = damping.sqrt() * length.max(f64::MIN_POSITIVE);
        }
        least_squares(&matrix, &right)
    }

    fn moved(&self, series: &Series, step: &DVector<f64>) -> Series {
        // A factor of e at a time: the linearisation means nothing farther out.
        let factor = |step: f64| step.clamp(-1.0, 1.0).exp();
        let count = series.branches.len();
        let branches = series.branches.iter().enumerate();
        Series {
            constant: (series.constant + step[0]).max(0.0),
            branches: branches
                .map(|(place, branch)| Branch {
                    strength: branch.strength * factor(step[1 + place]),
                    time_s: (branch.time_s * factor(step[1 + count + place]))
                        .clamp(self.limits_s.0, self.limits_s.1),
                })
                .collect(),
            flow_per_s: if self.flow {
                (series.flow_per_s + step[1 + 2 * count] / self.last_s()).max(0.0)
            } else {
                0.0
            },
        }
    }
}

/// Two branches as one: strengths added, times averaged as logarithms with the strengths as weights.
fn merged(left: Branch, right: Branch) -> Branch {
    let strength = left.strength + right.strength;
    let share = right.strength / strength;
    Branch {
        strength,
        time_s: left.time_s * (right.time_s / left.time_s).powf(share),
    }
}

/// Branches on neighbouring times of the grid as one: a time between two grid times shows as both.
fn merge_runs(series: &Series) -> Series {
    let adjacent = 10_f64.powf(1.01 / FINE_GRID);
    let mut branches: Vec<Branch> = Vec::new();
    let mut last_s = 0.0;
    for &branch in &series.branches {
        match branches.last_mut() {
            Some(run) if branch.time_s <= last_s * adjacent => *run = merged(*run, branch),
            _ => branches.push(branch),
        }
        last_s = branch.time_s;
    }
    Series {
        branches,
        ..series.clone()
    }
}

/// Every two neighbours as one.
fn halved(series: &Series) -> Series {
    let pairs = series.branches.chunks(2);
    Series {
        branches: pairs
            .filter_map(|pair| pair.iter().copied().reduce(merged))
            .collect(),
        ..series.clone()
    }
}

/// Every series with one branch less: two neighbours merged, or one left out.
fn fewer(series: &Series) -> Vec<Series> {
    let branches = &series.branches;
    let with = |branches: Vec<Branch>| Series {
        branches,
        ..series.clone()
    };
    let joined = (1..branches.len()).map(|right| {
        let mut rest = branches.clone();
        let branch = rest.remove(right);
        rest[right - 1] = merged(rest[right - 1], branch);
        with(rest)
    });
    let without = (0..branches.len()).map(|left_out| {
        let mut rest = branches.clone();
        rest.remove(left_out);
        with(rest)
    });
    joined.chain(without).collect()
}
