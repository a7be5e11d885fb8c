//! Few branches through a table: the [search](crate::material::spectrum) from several starts, and series that differ in what the data
//! leave open. Dimensionless: values are relative to a value of the table.

use nalgebra::DVector;

use super::{NOTICEABLE, PRICE};
use crate::material::MaterialFunction;
use crate::material::spectrum::{self, Linear, Series};
use crate::numerics::grid;
use crate::numerics::nnls::{NnlsError, nnls};

/// Times per decade of the grid on which two times next to one another mean one between them, and of the grids that are
/// tried where the spectrum is broad.
const FINE_GRID: f64 = 5.0;
const COARSE_GRIDS: [f64; 3] = [1.0, 1.5, 2.0];

/// Times per decade of the spectra that say what the data determine, and most times in any grid.
const SPECTRUM: f64 = 10.0;
const MOST_TIMES: usize = 1000;

/// How much heavier than a sample a condition weighs that must be met: to rounding times its square.
const CONDITION: f64 = 1e4;

/// Halvings of the logarithm of a ratio of ten or so: to a thousandth.
const HALVINGS: usize = 12;

/// Difference of two scores at which both series have substantial support (K. P. Burnham and D. R. Anderson, *Model Selection
/// and Multimodel Inference*, Springer 2002, section 2.6).
const ABOUT_EQUAL: f64 = 2.0;

/// What is fitted, and within which limits.
pub(super) struct Search<'a> {
    pub(super) function: MaterialFunction,
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

/// What a branch contributes at x = t / time, and its derivative with respect to the logarithm of the branch time: `1 - exp(-x)` to a creep
/// compliance, `exp(-x)` to a relaxation modulus.
fn basis(function: MaterialFunction, x: f64) -> [f64; 2] {
    match function {
        MaterialFunction::Creep => [-(-x).exp_m1(), -x * (-x).exp()],
        MaterialFunction::Relaxation => [(-x).exp(), x * (-x).exp()],
    }
}

impl Series {
    /// The value at a time.
    pub(super) fn value(&self, function: MaterialFunction, time_s: f64) -> f64 {
        let branches = self.branches.iter();
        let delayed: f64 = branches
            .map(|b| b.strength * basis(function, time_s / b.time_s)[0])
            .sum();
        self.constant + delayed + self.flow_per_s * time_s
    }

    /// The value in question; of the loss, the part of the branches.
    pub(super) fn open(&self, function: MaterialFunction, open: Open) -> f64 {
        let branches = self.branches.iter();
        let delayed: f64 = branches
            .map(|b| b.strength * open.of_branch(function, b.time_s))
            .sum();
        self.constant * open.of_constant() + delayed
    }
}

impl Open {
    /// How much of a constant is part of the value.
    fn of_constant(self) -> f64 {
        f64::from(!matches!(self, Self::Loss(_)))
    }

    /// How much of the strength of a branch of this time is.
    fn of_branch(self, function: MaterialFunction, time_s: f64) -> f64 {
        match self {
            Self::Loss(omega) => {
                let x = omega * time_s;
                x / (1.0 + x * x)
            }
            Self::Equilibrium => f64::from(function == MaterialFunction::Creep),
            Self::Instantaneous => f64::from(function == MaterialFunction::Relaxation),
        }
    }
}

impl Search<'_> {
    /// The series with the fewest branches among those that score about best, as far as they are found: from grids of several
    /// widths and from the times of another series, branches merged and left out.
    pub(super) fn run(&self, other: &[f64]) -> Result<Series, NnlsError> {
        let linear = self.linear();
        let score = |series: &Series| self.score(series);
        let search = spectrum::Search {
            linear: &linear,
            limits_s: self.limits_s,
            score: &score,
            slack: ABOUT_EQUAL,
            frees_constant: true,
        };
        let on_grid = |per_decade: f64| linear.strengths(&self.grid(per_decade), 0.0);
        let gridded = on_grid(FINE_GRID)?;
        let mut found = vec![
            search.fewest(&gridded.runs_merged(FINE_GRID))?,
            search.fewest(&linear.strengths(&self.within_limits(other), 0.0)?)?,
        ];
        for per_decade in COARSE_GRIDS {
            found.push(search.fewest(&on_grid(per_decade)?)?);
        }
        if found.iter().all(|series| self.misfit(series) > self.noise) {
            found.push(search.fewest(&gridded)?);
        }
        let lowest = found.iter().map(score);
        let about_best = lowest.fold(f64::INFINITY, f64::min) + ABOUT_EQUAL;
        found.retain(|series| score(series) <= about_best);
        let best = found.into_iter().min_by(|l, r| {
            let by_branches = l.branches.len().cmp(&r.branches.len());
            by_branches.then(score(l).total_cmp(&score(r)))
        });
        // The lowest score is never above itself.
        search.closely(&best.unwrap_or(gridded))
    }

    /// The values as sums of strengths, each relative to itself and by its weight.
    fn linear(&self) -> Linear<'_> {
        let creep = self.function == MaterialFunction::Creep;
        let scales = self.weights.iter().zip(self.values);
        let scales: Vec<f64> = scales.map(|(weight, value)| weight / value).collect();
        let flow = scales.iter().zip(self.times_s).map(|(scale, t)| scale * t);
        Linear {
            values: DVector::from_row_slice(self.weights),
            constant: DVector::from_row_slice(&scales),
            flow: (creep && self.flow).then(|| DVector::from_iterator(scales.len(), flow)),
            has_constant: creep || !self.flow,
            scales,
            basis: Box::new(|row, time_s| basis(self.function, self.times_s[row] / time_s)),
        }
    }

    fn strengths(&self, times_s: &[f64]) -> Result<Series, NnlsError> {
        self.linear().strengths(times_s, 0.0)
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
        let linear = self.linear();
        let samples = linear.matrix(&times);
        let row = samples.nrows();
        let mut matrix = samples.resize_vertically(row + 1, 0.0);
        let first = usize::from(linear.has_constant);
        if linear.has_constant {
            matrix[(row, 0)] = CONDITION / value * open.of_constant();
        }
        for (place, &time_s) in times.iter().enumerate() {
            matrix[(row, first + place)] =
                CONDITION / value * open.of_branch(self.function, time_s);
        }
        let right = linear.values.push(CONDITION);
        Ok(linear.series(&times, &nnls(&matrix, &right)?))
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
        let free = self
            .values
            .len()
            .saturating_sub(spectrum.strengths())
            .max(1);
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
        let parameters = series.parameters();
        if parameters >= self.values.len() {
            return f64::INFINITY;
        }
        self.chi_squared(series) + PRICE * parameters as f64
    }

    /// The weighted sum of squares of the relative misfit.
    pub(super) fn squares(&self, series: &Series) -> f64 {
        let samples = self.times_s.iter().zip(self.values).zip(self.weights);
        samples
            .map(|((&t, v), weight)| (weight * (series.value(self.function, t) / v - 1.0)).powi(2))
            .sum()
    }

    /// What the sum of squares would be for a misfit of one everywhere.
    fn weight(&self) -> f64 {
        self.weights.iter().map(|weight| weight * weight).sum()
    }

    fn grid(&self, per_decade: f64) -> Vec<f64> {
        let (shortest, longest) = self.limits_s;
        grid::logarithmic(shortest, longest, per_decade, MOST_TIMES)
    }
}
