//! Which number of branches the data ask for.

use crate::identify::noise::{Knowledge, is_missed};
use crate::identify::selection::{CLOSELY, Linearised};
use crate::identify::series::Point;
use crate::numerics::levenberg_marquardt::{Problem, minimise};

/// By how much a criterion must fall for one branch more: odds of seven to one.
const EVIDENCE: f64 = 4.0;

/// One number of branches that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    pub branches: usize,
    /// Sum of squared residuals, each in its standard deviation.
    pub chi_squared: f64,
    /// The criteria: lower is better.
    pub akaike: f64,
    pub schwarz: f64,
    /// Akaike weight: how probable this number of branches is beside the others.
    pub weight: f64,
    /// Whether two of its times are one.
    pub has_close_times: bool,
    pub(super) point: Point,
}

impl Candidate {
    /// A series with the criteria of H. Akaike, with the correction for few data, and of G. Schwarz; still without its weight.
    fn new(point: Point, linearised: &Linearised<'_>) -> Self {
        // The noise may have been estimated since the series was found.
        let residuals = linearised.residuals(&point);
        let chi_squared = residuals.map_or(f64::INFINITY, |r| r.norm_squared());
        let n = linearised.plan.measurements.data().len() as f64;
        let unknowns = point.0.len() as f64;
        // Where no error is known, one more unknown is the noise.
        let (misfit, unknowns) = match linearised.noise.knowledge {
            Knowledge::None => {
                let least = linearised.noise.least_scale().powi(2);
                (n * (chi_squared / n).max(least).ln(), unknowns + 1.0)
            }
            Knowledge::All | Knowledge::Some => (chi_squared, unknowns),
        };
        let free = n - unknowns - 1.0;
        let corrected = match free > 0.0 {
            true => 2.0 * unknowns * (1.0 + (unknowns + 1.0) / free),
            false => f64::INFINITY,
        };
        Self {
            branches: point.branches(),
            chi_squared,
            akaike: misfit + corrected,
            schwarz: misfit + unknowns * n.ln(),
            weight: 0.0,
            has_close_times: point.has_close_times(),
            point,
        }
    }
}

/// All of these series with their weights.
pub(super) fn candidates(linearised: &Linearised<'_>, series: &[Point]) -> Vec<Candidate> {
    let candidates = series.iter();
    let mut candidates: Vec<Candidate> = candidates
        .map(|point| Candidate::new(point.clone(), linearised))
        .collect();
    let all = candidates.iter().map(|c| c.akaike);
    let best = all.clone().fold(f64::INFINITY, f64::min);
    let weight = |akaike: f64| (0.5 * (best - akaike)).exp();
    let sum: f64 = all.map(weight).filter(|w| w.is_finite()).sum();
    for candidate in &mut candidates {
        let weight = weight(candidate.akaike) / sum;
        candidate.weight = if weight.is_finite() { weight } else { 0.0 };
    }
    candidates
}

/// A number that is missed by more than this many of its errors, and without which a series meets all others, is an outlier.
const OUTLIER: f64 = 5.0;

/// Leaves out a datum without which a series of at most the `chosen` number of branches meets the data, as the one with all of them does
/// not: whether there is one. Only an error that was given tells.
pub(super) fn leave_out_outlier(
    linearised: &mut Linearised<'_>,
    all: &[Candidate],
    chosen: usize,
) -> bool {
    let data = linearised.plan.measurements.data();
    let misses = |candidate: &Candidate, numbers: usize| {
        let free = numbers.saturating_sub(candidate.point.0.len());
        is_missed(candidate.chi_squared / free.max(1) as f64, free)
    };
    let is_known = linearised.noise.knowledge != Knowledge::None;
    let is_first = linearised.noise.left_out().is_none();
    if !(is_known && is_first && misses(&all[chosen], data.len())) {
        return false;
    }
    let is_asked = linearised.plan.branches.is_some();
    let fewest = if is_asked { chosen } else { 0 };
    for (fewer, simple) in all.iter().enumerate().take(chosen + 1).skip(fewest) {
        let relative = linearised.relative(&simple.point).into_iter();
        let scaled = relative.zip(&linearised.noise.relative).zip(data);
        let known = scaled.enumerate().filter(|(_, (_, d))| d.error.is_some());
        let sizes = known.map(|(place, ((off, error), _))| (place, (off / error).abs()));
        let Some((place, _)) = sizes
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|(_, size)| *size > OUTLIER)
        else {
            continue;
        };
        linearised.noise.leave_out(Some(place));
        let refined = all.iter().map(|candidate| {
            let found = minimise(linearised, &candidate.point, CLOSELY);
            found.map_or_else(|| candidate.point.clone(), |found| found.unknowns.sorted())
        });
        let refined: Vec<Point> = refined.collect();
        let without = candidates(linearised, &refined);
        if (is_asked || choose(&without) <= fewer) && !misses(&without[fewer], data.len() - 1) {
            return true;
        }
        linearised.noise.leave_out(None);
    }
    false
}

/// The smaller of the numbers that the two criteria ask for, among those whose times are apart.
pub(super) fn choose(candidates: &[Candidate]) -> usize {
    let best = |score: fn(&Candidate) -> f64| {
        let evident = |c: &Candidate| score(c) + EVIDENCE * c.branches as f64;
        let all = candidates.iter().enumerate();
        let apart = all.filter(|(_, c)| !c.has_close_times);
        let best = apart.min_by(|a, b| evident(a.1).total_cmp(&evident(b.1)));
        best.map_or(0, |(place, _)| place)
    };
    best(|c| c.akaike).min(best(|c| c.schwarz))
}
