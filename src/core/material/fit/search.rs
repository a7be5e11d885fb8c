//! The search for few branches: non-negative least squares on a grid of times, neighbours merged, times refined, and
//! branches taken away as long as the data do not miss them. Dimensionless: values are relative to a value of the table.

use nalgebra::{DMatrix, DVector};

use super::{NOTICEABLE, PRICE};
use crate::material::MaterialFunction;
use crate::material::branches::{Branch, MANY, TRIED, fewer, halved, merge_runs};
use crate::numerics::nnls::{NnlsError, least_squares, nnls};

/// Times per decade of the grid on which two times next to one another mean one between them, and of the grids that are
/// tried where the spectrum is broad.
const FINE_GRID: f64 = 5.0;
const COARSE_GRIDS: [f64; 3] = [1.0, 1.5, 2.0];

/// Times per decade of the spectra that say what the data determine, and most times in any grid.
const SPECTRUM: f64 = 10.0;
const MOST_TIMES: f64 = 1000.0;

/// How much heavier than a sample a condition weighs that must be met: to rounding times its square.
const CONDITION: f64 = 1e4;

/// Halvings of the logarithm of a ratio of ten or so: to a thousandth.
const HALVINGS: usize = 12;

/// Difference of two scores at which both series have substantial support (K. P. Burnham and D. R. Anderson, *Model Selection
/// and Multimodel Inference*, Springer 2002, section 2.6).
const ABOUT_EQUAL: f64 = 2.0;

/// Iterations of one refinement, and the relative decrease of the sum of squares at which it ends: while branches are
/// counted, and at the end.
const ROUGHLY: (usize, f64) = (30, 1e-3);
const CLOSELY: (usize, f64) = (200, 1e-10);

/// What is fitted, and within which limits.
pub(super) struct Search<'a> {
    pub(super) face: MaterialFunction,
    /// Times in s, values, and how much heavier than a single sample each of them weighs.
    pub(super) times_s: &'a [f64],
    pub(super) values: &'a [f64],
    pub(super) weights: &'a [f64],
    /// Shortest and longest branch time.
    pub(super) limits_s: (f64, f64),
    /// Whether the series is that of a fluid: a creep compliance with a term that grows with time, a relaxation modulus
    /// without a constant.
    pub(super) flow: bool,
    /// Relative standard deviation of the noise.
    pub(super) noise: f64,
}

/// A value of a series that data over a limited time leave open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Open {
    /// At time zero.
    Instantaneous,
    /// The one that is approached without flow.
    Equilibrium,
    /// The loss modulus or loss compliance at this angular frequency.
    Loss(f64),
}

/// A column of the least squares problem.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Column {
    Constant,
    Branch(f64),
    Flow,
}

/// `constant + sum of strength * basis(t / time) + flow_per_s * t`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    pub(super) constant: f64,
    pub(super) branches: Vec<Branch>,
    pub(super) flow_per_s: f64,
}

/// What a branch contributes at x = t / time: `1 - exp(-x)` to a creep compliance, `exp(-x)` to a relaxation modulus.
fn basis(face: MaterialFunction, x: f64) -> f64 {
    match face {
        MaterialFunction::Creep => -(-x).exp_m1(),
        MaterialFunction::Relaxation => (-x).exp(),
    }
}

/// Its derivative with respect to the logarithm of the branch time.
fn basis_slope(face: MaterialFunction, x: f64) -> f64 {
    match face {
        MaterialFunction::Creep => -x * (-x).exp(),
        MaterialFunction::Relaxation => x * (-x).exp(),
    }
}

impl Series {
    /// The value at a time.
    pub(super) fn value(&self, face: MaterialFunction, time_s: f64) -> f64 {
        let branches = self.branches.iter();
        let delayed: f64 = branches
            .map(|b| b.strength * basis(face, time_s / b.time_s))
            .sum();
        self.constant + delayed + self.flow_per_s * time_s
    }

    /// The value in question; of the loss, the part of the branches.
    pub(super) fn open(&self, face: MaterialFunction, open: Open) -> f64 {
        let branches = self.branches.iter();
        let delayed: f64 = branches
            .map(|b| b.strength * open.weight(face, Column::Branch(b.time_s)))
            .sum();
        self.constant * open.weight(face, Column::Constant) + delayed
    }

    /// The same with other branches.
    fn with(&self, branches: Vec<Branch>) -> Self {
        Self { branches, ..*self }
    }

    pub(super) fn times_s(&self) -> Vec<f64> {
        self.branches.iter().map(|b| b.time_s).collect()
    }
}

impl Open {
    /// How much of a strength is part of the value.
    fn weight(self, face: MaterialFunction, column: Column) -> f64 {
        match (self, column) {
            (Self::Loss(omega), Column::Branch(time_s)) => {
                let x = omega * time_s;
                x / (1.0 + x * x)
            }
            (Self::Loss(_), _) | (_, Column::Flow) => 0.0,
            (_, Column::Constant) => 1.0,
            (Self::Equilibrium, _) => f64::from(face == MaterialFunction::Creep),
            (Self::Instantaneous, _) => f64::from(face == MaterialFunction::Relaxation),
        }
    }
}

impl Search<'_> {
    /// The series with the fewest branches among those that score about best, as far as they are found: from grids of several
    /// widths and from the times of another series, branches merged and left out.
    pub(super) fn run(&self, other: &[f64]) -> Result<Series, NnlsError> {
        let gridded = self.strengths(&self.grid(FINE_GRID))?;
        let mut found = vec![
            self.fewest(&gridded.with(merge_runs(&gridded.branches, FINE_GRID)))?,
            self.fewest(&self.strengths(&self.within_limits(other))?)?,
        ];
        for per_decade in COARSE_GRIDS {
            let coarse = self.strengths(&self.grid(per_decade))?;
            found.push(self.fewest(&coarse)?);
        }
        if found.iter().all(|series| self.misfit(series) > self.noise) {
            found.push(self.fewest(&gridded)?);
        }
        let lowest = found.iter().map(|series| self.score(series));
        let about_best = lowest.fold(f64::INFINITY, f64::min) + ABOUT_EQUAL;
        found.retain(|series| self.score(series) <= about_best);
        let best = found.into_iter().min_by(|l, r| {
            let by_branches = l.branches.len().cmp(&r.branches.len());
            by_branches.then(self.score(l).total_cmp(&self.score(r)))
        });
        // The lowest score is never above itself.
        self.refined(&best.unwrap_or(gridded), CLOSELY)
    }

    /// The series with the fewest branches that is to be had from this one by merging and leaving out branches, as long as
    /// the score stays about as low as it was.
    fn fewest(&self, start: &Series) -> Result<Series, NnlsError> {
        let mut best = self.refined(start, ROUGHLY)?;
        // By halves while that costs nothing, then one by one.
        while best.branches.len() >= MANY {
            let half = self.refined(&best.with(halved(&best.branches)), ROUGHLY)?;
            if self.score(&half) > self.score(&best) {
                break;
            }
            best = half;
        }
        let mut lowest = self.score(&best);
        while let Some(simpler) = self.simpler(&best, lowest + ABOUT_EQUAL)? {
            lowest = lowest.min(self.score(&simpler));
            best = simpler;
        }
        Ok(best)
    }

    /// The best series of any number of branches, on a fine grid and at further times within the limits.
    pub(super) fn spectrum(&self, further: &[f64]) -> Result<Series, NnlsError> {
        self.strengths(&self.spectrum_times(further))
    }

    /// The best series of any number of branches on a grid whose times lie this share of a step beyond those of the fine one.
    pub(super) fn spectrum_on(&self, offset: f64) -> Result<Series, NnlsError> {
        let step = 10_f64.powf((offset - 0.5) / FINE_GRID);
        let times: Vec<f64> = self
            .grid(FINE_GRID)
            .iter()
            .map(|time_s| time_s * step)
            .collect();
        self.strengths(&times)
    }

    fn spectrum_times(&self, further: &[f64]) -> Vec<f64> {
        let mut times = self.grid(SPECTRUM);
        times.extend(self.within_limits(further));
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    fn within_limits(&self, times_s: &[f64]) -> Vec<f64> {
        let (shortest, longest) = self.limits_s;
        let within = |time_s: &f64| (shortest..=longest).contains(time_s);
        times_s.iter().copied().filter(within).collect()
    }

    /// The best series of any number of branches of which one value is given.
    pub(super) fn with_open(
        &self,
        open: Open,
        value: f64,
        further: &[f64],
    ) -> Result<Series, NnlsError> {
        let times = self.spectrum_times(further);
        let columns = self.columns(&times);
        let samples = self.matrix(&columns);
        let row = samples.nrows();
        let mut matrix = samples.resize_vertically(row + 1, 0.0);
        for (place, column) in columns.iter().enumerate() {
            matrix[(row, place)] = CONDITION / value * open.weight(self.face, *column);
        }
        let right = self.right().push(CONDITION);
        Ok(self.series(&columns, &nnls(&matrix, &right)?))
    }

    /// The series of which a value lies as far from `from` towards `limit` as is possible with no more than these squares; `None`
    /// where hardly any other value is. Both values are positive.
    pub(super) fn farthest(
        &self,
        open: Open,
        (from, limit): (f64, f64),
        squares: f64,
        further: &[f64],
    ) -> Result<Option<Series>, NnlsError> {
        let (mut near, mut far) = (0.0, 1.0);
        let mut best = None;
        let mut share = 1.0;
        for _ in 0..=HALVINGS {
            let series = self.with_open(open, from * (limit / from).powf(share), further)?;
            if self.squares(&series) <= squares {
                near = share;
                best = Some(series);
                if near == far {
                    break;
                }
            } else {
                far = share;
            }
            share = 0.5 * (near + far);
        }
        Ok(best)
    }

    /// Root mean square of the relative misfit.
    pub(super) fn misfit(&self, series: &Series) -> f64 {
        (self.squares(series) / self.weight()).sqrt()
    }

    /// The standard deviation of the noise: what the best spectrum leaves, whose strengths have taken away their part.
    pub(super) fn residual(&self) -> Result<f64, NnlsError> {
        let spectrum = self.spectrum(&[])?;
        let strengths = parameters(&spectrum) - spectrum.branches.len();
        let free = self.values.len().saturating_sub(strengths).max(1);
        Ok((self.squares(&spectrum) / free as f64).sqrt())
    }

    /// The sum of squares in units of the variance of the noise; what is not noticeable makes no difference.
    pub(super) fn chi_squared(&self, series: &Series) -> f64 {
        let unnoticed = self.weight() * NOTICEABLE * NOTICEABLE;
        self.squares(series).max(unnoticed) / (self.noise * self.noise)
    }

    /// The criterion of C. L. Mallows, Technometrics 15 (1973) 661, which is that of H. Akaike where the noise is known: lower
    /// is better. A series with as many parameters as there are data explains nothing.
    pub(super) fn score(&self, series: &Series) -> f64 {
        let parameters = parameters(series);
        if parameters >= self.values.len() {
            return f64::INFINITY;
        }
        self.chi_squared(series) + PRICE * parameters as f64
    }

    /// A series with a branch less that scores no more than this, if there is one.
    fn simpler(&self, series: &Series, limit: f64) -> Result<Option<Series>, NnlsError> {
        let mut candidates: Vec<(f64, Series)> = fewer(&series.branches)
            .map(|branches| series.with(branches))
            .map(|candidate| (self.quick_squares(&candidate), candidate))
            .collect();
        candidates.sort_by(|left, right| left.0.total_cmp(&right.0));
        for (_, candidate) in candidates.into_iter().take(TRIED) {
            let refined = self.refined(&candidate, ROUGHLY)?;
            if self.score(&refined) <= limit {
                return Ok(Some(refined));
            }
        }
        Ok(None)
    }

    /// The weighted sum of squares of the relative misfit.
    pub(super) fn squares(&self, series: &Series) -> f64 {
        let samples = self.times_s.iter().zip(self.values).zip(self.weights);
        samples
            .map(|((&t, v), weight)| (weight * (series.value(self.face, t) / v - 1.0)).powi(2))
            .sum()
    }

    /// What the sum of squares would be for a misfit of one everywhere.
    fn weight(&self) -> f64 {
        self.weights.iter().map(|weight| weight * weight).sum()
    }

    /// The right side of the least squares problem.
    fn right(&self) -> DVector<f64> {
        DVector::from_row_slice(self.weights)
    }

    /// Sum of squares with the best strengths of either sign at these times: a quick measure of what a candidate can do.
    fn quick_squares(&self, series: &Series) -> f64 {
        let matrix = self.matrix(&self.columns(&series.times_s()));
        let right = self.right();
        least_squares(&matrix, &right).map_or(f64::INFINITY, |strengths| {
            (right - matrix * strengths).norm_squared()
        })
    }

    fn grid(&self, per_decade: f64) -> Vec<f64> {
        let (shortest, longest) = self.limits_s;
        let steps = ((longest / shortest).log10() * per_decade)
            .ceil()
            .clamp(1.0, MOST_TIMES);
        (0..=steps as usize)
            .map(|i| shortest * (longest / shortest).powf(i as f64 / steps))
            .collect()
    }

    /// Constant, branches, flow (per last time), those of them that there are.
    fn columns(&self, times_s: &[f64]) -> Vec<Column> {
        let creep = self.face == MaterialFunction::Creep;
        let constant = (creep || !self.flow).then_some(Column::Constant);
        let flow = (creep && self.flow).then_some(Column::Flow);
        let branches = times_s.iter().map(|&time_s| Column::Branch(time_s));
        constant.into_iter().chain(branches).chain(flow).collect()
    }

    /// A column at a time.
    fn basis(&self, column: Column, time_s: f64) -> f64 {
        match column {
            Column::Constant => 1.0,
            Column::Branch(branch_s) => basis(self.face, time_s / branch_s),
            Column::Flow => time_s / self.last_s(),
        }
    }

    /// Columns over the data, each divided by the value there and weighted.
    fn matrix(&self, columns: &[Column]) -> DMatrix<f64> {
        DMatrix::from_fn(self.values.len(), columns.len(), |row, place| {
            self.basis(columns[place], self.times_s[row]) * self.weights[row] / self.values[row]
        })
    }

    /// The series of these strengths; branches of strength zero are left out.
    fn series(&self, columns: &[Column], strengths: &DVector<f64>) -> Series {
        let mut series = Series {
            constant: 0.0,
            branches: Vec::new(),
            flow_per_s: 0.0,
        };
        for (column, &strength) in columns.iter().zip(strengths) {
            match *column {
                Column::Constant => series.constant = strength,
                Column::Branch(time_s) if strength > 0.0 => {
                    series.branches.push(Branch { strength, time_s });
                }
                Column::Branch(_) => {}
                Column::Flow => series.flow_per_s = strength / self.last_s(),
            }
        }
        series
    }

    fn last_s(&self) -> f64 {
        self.times_s.last().copied().unwrap_or(1.0)
    }

    /// The best strengths at given times, none negative.
    fn strengths(&self, times_s: &[f64]) -> Result<Series, NnlsError> {
        let columns = self.columns(times_s);
        let strengths = nnls(&self.matrix(&columns), &self.right())?;
        Ok(self.series(&columns, &strengths))
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

    /// The damped step in (constant, ln strength of every branch, flow) and then ln time of every branch.
    fn step(&self, series: &Series, damping: f64) -> Option<DVector<f64>> {
        let own = self.columns(&series.times_s());
        let (rows, strengths) = (self.values.len(), own.len());
        let columns = strengths + series.branches.len();
        let mut matrix = DMatrix::zeros(rows + columns, columns);
        let mut right = DVector::zeros(rows + columns);
        for (row, &time_s) in self.times_s.iter().enumerate() {
            let (value, weight) = (self.values[row] / self.weights[row], self.weights[row]);
            let mut branch = 0;
            for (place, &column) in own.iter().enumerate() {
                matrix[(row, place)] = self.basis(column, time_s) / value;
                if let Column::Branch(branch_s) = column {
                    let strength = series.branches[branch].strength;
                    matrix[(row, place)] *= strength;
                    matrix[(row, strengths + branch)] =
                        strength / value * basis_slope(self.face, time_s / branch_s);
                    branch += 1;
                }
            }
            right[row] = weight - series.value(self.face, time_s) / value;
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
        let own = self.columns(&series.times_s());
        let mut moved = series.clone();
        let mut branches = moved.branches.iter_mut().enumerate();
        for (place, column) in own.iter().enumerate() {
            match column {
                Column::Constant => moved.constant = (series.constant + step[place]).max(0.0),
                Column::Flow => {
                    let flow_per_s = series.flow_per_s + step[place] / self.last_s();
                    moved.flow_per_s = flow_per_s.max(0.0);
                }
                Column::Branch(_) => {
                    if let Some((number, branch)) = branches.next() {
                        branch.strength *= factor(step[place]);
                        branch.time_s = (branch.time_s * factor(step[own.len() + number]))
                            .clamp(self.limits_s.0, self.limits_s.1);
                    }
                }
            }
        }
        moved
    }
}

/// Values of a series that were chosen to fit.
fn parameters(series: &Series) -> usize {
    usize::from(series.constant > 0.0)
        + 2 * series.branches.len()
        + usize::from(series.flow_per_s > 0.0)
}
