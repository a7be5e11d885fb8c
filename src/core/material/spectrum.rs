//! The search for a spectrum of few branches, whatever the data are: tables of creep and relaxation, storage and loss modulus.
//!
//! Data are a sum of a constant, of branches, each of its strength and time, and of a flow. At given times the strengths are a linear
//! problem, solved with none of them negative on a grid of times ([`Linear::strengths`]); the grid alone gives more branches than the data
//! hold (M. Baumgaertel and H. H. Winter, Rheologica Acta 28 (1989) 511). So neighbours are merged, times refined together with the
//! strengths, and branches taken away one by one as long as a score allows it ([`Search::fewest`]).

use nalgebra::{DMatrix, DVector};

use crate::numerics::levenberg_marquardt::{Ending, Problem, minimise};
use crate::numerics::nnls::{NnlsError, nnls};

/// Number of branches from which on it is worth merging pair by pair, all at once.
const MANY: usize = 8;

/// Branches are taken away one by one; this many ways are tried to the end, the likeliest first.
const TRIED: usize = 3;

/// Ridge of the quick comparison of candidates, beside columns of unit length.
const RIDGE: f64 = 1e-12;

/// Iterations of a refinement, and the relative decrease of the sum of squares at which it ends: while branches are counted, and at the
/// end.
const ROUGHLY: Ending = Ending {
    iterations: 30,
    enough: 1e-3,
};
const CLOSELY: Ending = Ending {
    iterations: 200,
    enough: 1e-10,
};

/// A branch of a series: strength (of any unit) and time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Branch {
    pub strength: f64,
    pub time_s: f64,
}

/// `constant + sum of strength * basis + flow_per_s * t`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    pub constant: f64,
    /// Ascending in time.
    pub branches: Vec<Branch>,
    pub flow_per_s: f64,
}

impl Series {
    /// The same with other branches.
    fn with(&self, branches: Vec<Branch>) -> Self {
        Self { branches, ..*self }
    }

    pub fn times_s(&self) -> Vec<f64> {
        self.branches.iter().map(|b| b.time_s).collect()
    }

    /// Values chosen to fit where the times are given.
    pub fn strengths(&self) -> usize {
        let others = [self.constant, self.flow_per_s];
        self.branches.len() + others.iter().filter(|value| **value > 0.0).count()
    }

    /// Values chosen to fit: strengths and times.
    pub fn parameters(&self) -> usize {
        self.strengths() + self.branches.len()
    }
}

/// What a branch of strength one and of this time (s) contributes to a row, and its derivative by the logarithm of the time.
type Basis<'a> = dyn Fn(usize, f64) -> [f64; 2] + Sync + 'a;

/// Data as rows in which strengths are linear, each in its standard deviation.
pub(super) struct Linear<'a> {
    pub basis: Box<Basis<'a>>,
    /// One over the standard deviation of each row.
    pub scales: Vec<f64>,
    /// The values, scaled.
    pub values: DVector<f64>,
    /// What a constant, and a flow of one per second, contribute to each row, scaled; a flow only where there may be one.
    pub constant: DVector<f64>,
    pub flow: Option<DVector<f64>>,
    /// Whether the constant is one of the unknowns.
    pub has_constant: bool,
}

impl Linear<'_> {
    /// Columns of the constant, of branches of these times (s), and of the flow, those that there are.
    pub fn matrix(&self, times_s: &[f64]) -> DMatrix<f64> {
        let branch = |&time_s: &f64| {
            let rows = self.scales.iter().enumerate();
            let column = rows.map(|(row, scale)| (self.basis)(row, time_s)[0] * scale);
            DVector::from_iterator(self.scales.len(), column)
        };
        let constant = self.has_constant.then(|| self.constant.clone());
        let columns = constant.into_iter().chain(times_s.iter().map(branch));
        let columns: Vec<_> = columns.chain(self.flow.clone()).collect();
        match columns.is_empty() {
            true => DMatrix::zeros(self.scales.len(), 0),
            false => DMatrix::from_columns(&columns),
        }
    }

    /// The series of the unknowns that belong to [these columns](Self::matrix); branches of strength zero are left out.
    pub fn series(&self, times_s: &[f64], unknowns: &DVector<f64>) -> Series {
        let first = usize::from(self.has_constant);
        let branches = unknowns.iter().skip(first).zip(times_s);
        let branches = branches.map(|(&strength, &time_s)| Branch { strength, time_s });
        Series {
            constant: if self.has_constant { unknowns[0] } else { 0.0 },
            branches: branches.filter(|branch| branch.strength > 0.0).collect(),
            flow_per_s: self
                .flow
                .as_ref()
                .map_or(0.0, |_| unknowns[first + times_s.len()]),
        }
    }

    /// The best strengths at given times (s), none negative, beside a constant that is held.
    pub fn strengths(&self, times_s: &[f64], held: f64) -> Result<Series, NnlsError> {
        let values = &self.values - held * &self.constant;
        let mut series = self.series(times_s, &nnls(&self.matrix(times_s), &values)?);
        series.constant += held;
        Ok(series)
    }

    /// What the series makes of the rows less what they are.
    fn residuals(&self, series: &Series) -> DVector<f64> {
        let mut residuals = series.constant * &self.constant - &self.values;
        for (row, scale) in self.scales.iter().enumerate() {
            let branches = series.branches.iter();
            let delayed: f64 = branches
                .map(|b| b.strength * (self.basis)(row, b.time_s)[0])
                .sum();
            residuals[row] += delayed * scale;
        }
        if let Some(flow) = &self.flow {
            residuals.axpy(series.flow_per_s, flow, 1.0);
        }
        residuals
    }

    /// The sum of squares.
    pub fn squares(&self, series: &Series) -> f64 {
        self.residuals(series).norm_squared()
    }

    /// The same with the best strengths of either sign at these times: a quick measure of what a candidate can do.
    fn quick_squares(&self, series: &Series) -> f64 {
        let matrix = self.matrix(&series.times_s());
        let right = matrix.tr_mul(&self.values);
        let mut normal = matrix.tr_mul(&matrix);
        for place in 0..normal.ncols() {
            normal[(place, place)] *= 1.0 + RIDGE;
        }
        normal.cholesky().map_or(f64::INFINITY, |factors| {
            self.values.norm_squared() - right.dot(&factors.solve(&right))
        })
    }
}

/// A search among series.
pub(super) struct Search<'a> {
    pub linear: &'a Linear<'a>,
    /// Shortest and longest branch time (s).
    pub limits_s: (f64, f64),
    /// How good a series is: lower is better.
    pub score: &'a (dyn Fn(&Series) -> f64 + Sync),
    /// By how much the score may rise above the lowest met, for a branch less.
    pub slack: f64,
    /// Whether the constant may come to be nothing, or what was nothing something.
    pub frees_constant: bool,
}

impl Search<'_> {
    /// The series with the fewest branches that is to be had from this one by merging and leaving out branches, as long as the score stays
    /// about as low as it was.
    pub fn fewest(&self, start: &Series) -> Result<Series, NnlsError> {
        let mut best = self.refined(start, ROUGHLY)?;
        // By halves while that costs nothing, then one by one.
        while best.branches.len() >= MANY {
            let half = self.refined(&best.with(halved(&best.branches)), ROUGHLY)?;
            if (self.score)(&half) > (self.score)(&best) {
                break;
            }
            best = half;
        }
        let mut lowest = (self.score)(&best);
        while let Some(simpler) = self.simpler(&best, lowest + self.slack)? {
            lowest = lowest.min((self.score)(&simpler));
            best = simpler;
        }
        Ok(best)
    }

    /// The series of this number of branches at most that is to be had by taking them away one by one.
    pub fn at_most(&self, start: &Series, branches: usize) -> Result<Series, NnlsError> {
        let mut reduced = self.refined(start, ROUGHLY)?;
        while reduced.branches.len() > branches
            && let Some(simpler) = self.simpler(&reduced, f64::INFINITY)?
        {
            reduced = simpler;
        }
        self.closely(&reduced)
    }

    /// A series refined to the end.
    pub fn closely(&self, series: &Series) -> Result<Series, NnlsError> {
        self.refined(series, CLOSELY)
    }

    /// The best series with a branch less, if its score is no more than this.
    fn simpler(&self, series: &Series, limit: f64) -> Result<Option<Series>, NnlsError> {
        let mut candidates: Vec<(f64, Series)> = fewer(&series.branches)
            .map(|branches| series.with(branches))
            .filter(|candidate| candidate.strengths() > 0)
            .map(|candidate| (self.linear.quick_squares(&candidate), candidate))
            .collect();
        candidates.sort_by(|left, right| left.0.total_cmp(&right.0));
        for (_, candidate) in candidates.into_iter().take(TRIED) {
            let refined = self.refined(&candidate, ROUGHLY)?;
            if (self.score)(&refined) <= limit {
                return Ok(Some(refined));
            }
        }
        Ok(None)
    }

    /// Times and strengths improved together.
    fn refined(&self, series: &Series, ending: Ending) -> Result<Series, NnlsError> {
        let mut start = series.clone();
        if self.frees_constant {
            start = self.linear.strengths(&series.times_s(), 0.0)?;
        }
        let refinement = Refinement {
            search: self,
            start: &start,
        };
        let found = minimise(&refinement, &refinement.unknowns(), ending);
        let mut best = found.map_or(start.clone(), |found| refinement.series(&found.unknowns));
        best.branches
            .sort_by(|left, right| left.time_s.total_cmp(&right.time_s));
        if !self.frees_constant {
            return Ok(best);
        }
        let polished = self.linear.strengths(&best.times_s(), 0.0)?;
        // Where the strengths are ill determined, rounding may make the polish the worse of the two.
        let is_better = self.linear.squares(&polished) <= self.linear.squares(&best);
        Ok(if is_better { polished } else { best })
    }
}

/// The unknowns of a series, all as logarithms: its constant and its flow where it has them, strengths, times.
struct Refinement<'a> {
    search: &'a Search<'a>,
    start: &'a Series,
}

impl Refinement<'_> {
    fn has_constant(&self) -> bool {
        self.start.constant > 0.0
    }

    fn has_flow(&self) -> bool {
        self.start.flow_per_s > 0.0
    }

    fn unknowns(&self) -> Vec<f64> {
        let Series {
            constant,
            branches,
            flow_per_s,
        } = self.start;
        let constant = self.has_constant().then_some(*constant);
        let flow_per_s = self.has_flow().then_some(*flow_per_s);
        let all = constant.into_iter().chain(flow_per_s);
        let all = all.chain(branches.iter().map(|branch| branch.strength));
        let all = all.chain(branches.iter().map(|branch| branch.time_s));
        all.map(f64::ln).collect()
    }

    fn series(&self, unknowns: &[f64]) -> Series {
        let mut values = unknowns.iter().map(|unknown| unknown.exp());
        let mut next = |is_there: bool| match is_there {
            true => values.next().unwrap_or(0.0),
            false => 0.0,
        };
        let (constant, flow_per_s) = (next(self.has_constant()), next(self.has_flow()));
        let values: Vec<f64> = values.collect();
        let (strengths, times_s) = values.split_at(values.len() / 2);
        let branches = strengths.iter().zip(times_s);
        Series {
            constant,
            branches: branches
                .map(|(&strength, &time_s)| Branch { strength, time_s })
                .collect(),
            flow_per_s,
        }
    }
}

impl Problem for Refinement<'_> {
    type Unknowns = Vec<f64>;

    fn residuals(&self, unknowns: &Vec<f64>) -> Option<DVector<f64>> {
        Some(self.search.linear.residuals(&self.series(unknowns)))
    }

    fn derivatives(&self, unknowns: &Vec<f64>) -> Option<DMatrix<f64>> {
        let (linear, series) = (self.search.linear, self.series(unknowns));
        let count = series.branches.len();
        let first = unknowns.len() - 2 * count;
        let mut matrix = DMatrix::zeros(linear.scales.len(), unknowns.len());
        if self.has_constant() {
            matrix.set_column(0, &(series.constant * &linear.constant));
        }
        if let (true, Some(flow)) = (self.has_flow(), &linear.flow) {
            matrix.set_column(first - 1, &(series.flow_per_s * flow));
        }
        for (place, branch) in series.branches.iter().enumerate() {
            for (row, scale) in linear.scales.iter().enumerate() {
                let [value, slope] = (linear.basis)(row, branch.time_s);
                matrix[(row, first + place)] = branch.strength * value * scale;
                matrix[(row, first + count + place)] = branch.strength * slope * scale;
            }
        }
        Some(matrix)
    }

    fn clamp(&self, place: usize, value: f64) -> f64 {
        let count = self.start.branches.len();
        let (shortest, longest) = self.search.limits_s;
        let others = usize::from(self.has_constant()) + usize::from(self.has_flow());
        match place >= others + count {
            true => value.clamp(shortest.ln(), longest.ln()),
            false => value,
        }
    }
}

/// Two branches as one: strengths added, times averaged as logarithms with the strengths as weights.
pub(super) fn joined(left: Branch, right: Branch) -> Branch {
    let strength = left.strength + right.strength;
    let share = right.strength / strength;
    Branch {
        strength,
        time_s: left.time_s * (right.time_s / left.time_s).powf(share),
    }
}

impl Series {
    /// With the branches on neighbouring times of a grid of this many per decade as one: a time between two grid times shows as both.
    pub fn runs_merged(&self, per_decade: f64) -> Self {
        let adjacent = 10_f64.powf(1.01 / per_decade);
        let mut branches: Vec<Branch> = Vec::new();
        let mut last_s = 0.0;
        for &branch in &self.branches {
            match branches.last_mut() {
                Some(run) if branch.time_s <= last_s * adjacent => *run = joined(*run, branch),
                _ => branches.push(branch),
            }
            last_s = branch.time_s;
        }
        self.with(branches)
    }
}

/// Every two neighbours as one.
fn halved(branches: &[Branch]) -> Vec<Branch> {
    let pairs = branches.chunks(2);
    pairs
        .filter_map(|pair| pair.iter().copied().reduce(joined))
        .collect()
}

/// Every list with one branch less: two neighbours merged, or one left out.
fn fewer(branches: &[Branch]) -> impl Iterator<Item = Vec<Branch>> {
    let with_two_as_one = (1..branches.len()).map(|right| {
        let mut rest = branches.to_vec();
        let branch = rest.remove(right);
        rest[right - 1] = joined(rest[right - 1], branch);
        rest
    });
    let without = (0..branches.len()).map(|left_out| {
        let mut rest = branches.to_vec();
        rest.remove(left_out);
        rest
    });
    with_two_as_one.chain(without)
}
