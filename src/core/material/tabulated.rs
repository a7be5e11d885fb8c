//! A measured creep compliance or relaxation modulus: samples over time, checked, and a function between them.
//!
//! Used directly, the samples are made monotone (see below) and joined by power laws (see [`Interpolant`]); before the first
//! sample and beyond the last one the function keeps their value, so that nothing faster or slower than the data is invented.
//! [`super::fit`] makes a series of exponentials of them.
//!
//! # What a passive material can do
//!
//! A creep compliance never falls and a relaxation modulus never rises. Real data do, by noise. They are judged as they are
//! fitted: where there are more than forty samples per decade of time, by the means of groups of a fortieth decade.
//!
//! - *Noise*: a value on the wrong side of an earlier one by up to [`NOISE_LIMIT`], or [`REVERSAL_SCATTER`] times the scatter
//!   of the samples about their neighbours, but no more than [`REVERSAL_LIMIT`]. Kept, and reported as [`TableWarning::Noise`].
//! - *A trend*: what remains when isolated values are passed over. The median of five or more consecutive values (fewer in a
//!   table of less than ten) must not be on the wrong side of an earlier one by more than [`TREND_FLOOR`] and
//!   [`TREND_SCATTER`] times their scatter. Refused.
//!
//! For the direct hereditary sum noise must not be left in the function: with a pressure p that is never negative, the
//! displacement `C(0) p(t) + integral of C'(s) p(t - s) ds` is never negative where C never falls, and the sums that stand for
//! it keep that, since the mean of C over longer lags is never the smaller. So the samples are replaced by the monotone
//! sequence nearest to them in the sense of least squares (isotonic regression by pooling adjacent violators: M. Ayer, H. D.
//! Brunk, G. M. Ewing, W. T. Reid and E. Silverman, Annals of Mathematical Statistics 26 (1955) 641). Samples that are
//! monotone stay as they are.

mod course;
pub mod keys;

use super::interpolant::Interpolant;
use super::{MaterialError, MaterialFunction, ModulusKind};
use crate::numerics::order;
use crate::quantity::{Dimension, format_si};

pub use course::{NOISE_LIMIT, REVERSAL_LIMIT, REVERSAL_SCATTER, TREND_FLOOR, TREND_SCATTER};

/// Fewest samples: one more than an instantaneous value, one branch and its time take.
pub const FEWEST_SAMPLES: usize = 4;

/// Samples per decade beyond which they are averaged.
const GROUPS_PER_DECADE: f64 = 40.0;

/// Most samples whose noise averages out in a group.
const INDEPENDENT: usize = 100;

/// Largest rounding that is believed from the digits of the values: one digit in all of them is rather an example.
const COARSEST: f64 = 0.01;

/// Values whose digits are looked at.
const ENOUGH_VALUES: usize = 1000;

/// Why samples are no creep compliance or relaxation modulus. `row` counts samples from 1.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    #[error("the table has no samples; it takes at least {FEWEST_SAMPLES}")]
    Empty,

    #[error("the table has too few samples, {found}; it takes at least {FEWEST_SAMPLES}")]
    TooFew { found: usize },

    #[error("there are {times} times but {values} values")]
    Lengths { times: usize, values: usize },

    #[error("the time of row {row} is {time_s:?} s: it must be finite and not negative")]
    Time { row: usize, time_s: f64 },

    #[error(
        "the time of row {row}, {time_s} s, does not come after that of the row before, {before_s} s: times must increase"
    )]
    TimeOrder {
        row: usize,
        time_s: f64,
        before_s: f64,
    },

    #[error("the {} of row {row} is {value:?}: it must be finite and greater than zero", name(*function))]
    Value {
        function: MaterialFunction,
        row: usize,
        value: f64,
    },

    #[error(
        "the {} {} by {:.1} % from row {earlier_row} to row {row}, which no passive material does; up to {:.0} % is taken for noise",
        name(*function), wrong_way(*function), 100.0 * share, 100.0 * limit
    )]
    Reversal {
        function: MaterialFunction,
        earlier_row: usize,
        row: usize,
        share: f64,
        limit: f64,
    },

    #[error(
        "the {} {} steadily, by {:.2} % from about row {earlier_row} to about row {row}, which no passive material does; its scatter of {:.2} % does not explain it",
        name(*function), wrong_way(*function), 100.0 * share, 100.0 * scatter
    )]
    Trend {
        function: MaterialFunction,
        earlier_row: usize,
        row: usize,
        share: f64,
        /// Standard deviation of the samples about their neighbours, as a share.
        scatter: f64,
    },
}

/// The column of the table in which an error stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableColumn {
    Time,
    Value,
}

impl TableError {
    /// Row (from 1) and column of the error, where it has a place.
    pub fn place(&self) -> Option<(usize, TableColumn)> {
        match *self {
            Self::Empty | Self::TooFew { .. } | Self::Lengths { .. } => None,
            Self::Time { row, .. } | Self::TimeOrder { row, .. } => Some((row, TableColumn::Time)),
            Self::Value { row, .. } | Self::Reversal { row, .. } | Self::Trend { row, .. } => {
                Some((row, TableColumn::Value))
            }
        }
    }
}

/// `creep compliance` or `relaxation modulus`.
pub(super) fn name(function: MaterialFunction) -> &'static str {
    match function {
        MaterialFunction::Creep => "creep compliance",
        MaterialFunction::Relaxation => "relaxation modulus",
    }
}

fn wrong_way(function: MaterialFunction) -> &'static str {
    match function {
        MaterialFunction::Creep => "falls",
        MaterialFunction::Relaxation => "rises",
    }
}

/// What is odd about samples that are used all the same.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableWarning {
    /// Samples on the wrong side of an earlier one: how many, by how much at most, and where (row from 1).
    #[error(
        "{samples} {} on the wrong side of an earlier one: the {} {} by up to {:.2} % (row {row}), taken for noise",
        if *samples == 1 { "sample is" } else { "samples are" }, name(*function), wrong_way(*function), 100.0 * largest_share
    )]
    Noise {
        function: MaterialFunction,
        samples: usize,
        largest_share: f64,
        row: usize,
    },
    /// Rows of the table in which a number is missing.
    #[error(
        "{rows} {} passed over: a number is empty or marked as missing",
        if *rows == 1 { "row" } else { "rows" }
    )]
    Missing { rows: usize },
    /// More than a decade without a sample.
    #[error(
        "no sample between {} and {}, {:.1} decades: branches with times in there are guessed",
        seconds(*from_s), seconds(*to_s), (to_s / from_s).log10()
    )]
    Gap { from_s: f64, to_s: f64 },
    /// Less than a decade of time.
    #[error(
        "the data cover {:.2} decades of time only, {} to {}: they say little about other times",
        (to_s / from_s).log10(), seconds(*from_s), seconds(*to_s)
    )]
    Short { from_s: f64, to_s: f64 },
}

impl TableWarning {
    /// Whether this limits what the samples can be used for, rather than telling how they were read.
    pub fn is_warning(&self) -> bool {
        !matches!(self, Self::Missing { .. })
    }
}

/// A time in four digits, as short as it can be written.
pub(super) fn seconds(time_s: f64) -> String {
    let rounded = format!("{time_s:.3e}").parse().unwrap_or(time_s);
    format_si(rounded, Dimension::Time)
}

/// Checked samples of a creep compliance (1/Pa) or a relaxation modulus (Pa) over time (s).
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    function: MaterialFunction,
    kind: ModulusKind,
    curve: Interpolant,
    groups: Groups,
    warnings: Vec<TableWarning>,
}

/// Samples, those closer together than a fortieth decade averaged: geometric mean of times, mean of values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Groups {
    pub(super) times_s: Vec<f64>,
    pub(super) values: Vec<f64>,
    /// Place of the first sample of every group, and of the end.
    starts: Vec<usize>,
}

impl Groups {
    fn of(times: &[f64], values: &[f64]) -> Self {
        // A table of exactly forty per decade stays as it is, whatever rounding does to its times.
        let width = 10_f64.powf(1.0 / GROUPS_PER_DECADE) * (1.0 - 1e-9);
        let (mut grouped, mut start) = ((Vec::new(), Vec::new()), 0);
        let mut starts = vec![0];
        while start < times.len() {
            let close = times[start..].partition_point(|&t| t < width * times[start]);
            let end = start + close.max(1);
            let count = (end - start) as f64;
            let logarithms = times[start..end].iter().map(|t| (t / times[start]).ln());
            grouped.0.push(match end - start {
                1 => times[start],
                _ => times[start] * (logarithms.sum::<f64>() / count).exp(),
            });
            let shares = values[start..end].iter().map(|v| v / count);
            grouped.1.push(shares.sum());
            starts.push(end);
            start = end;
        }
        Self {
            times_s: grouped.0,
            values: grouped.1,
            starts,
        }
    }

    /// How many samples there are in each group.
    fn counts(&self) -> Vec<f64> {
        let counts = self.starts.windows(2).map(|pair| pair[1] - pair[0]);
        counts.map(|count| count as f64).collect()
    }

    /// The standard deviation of a sample over that of each group.
    pub(super) fn weights(&self) -> Vec<f64> {
        let most = INDEPENDENT as f64;
        let counts = self.counts().into_iter();
        counts.map(|count| count.min(most).sqrt()).collect()
    }
}

impl Tabulated {
    /// Samples of `function`, a quantity of `kind`; times in s, values in 1/Pa or Pa.
    ///
    /// # Errors
    /// [`TableError`], naming the row: no or too few samples; a time that is not finite, negative or not after the one
    /// before; a value that is not finite and positive; a course that no passive material can have.
    pub fn new(
        function: MaterialFunction,
        kind: ModulusKind,
        times_s: Vec<f64>,
        values: Vec<f64>,
    ) -> Result<Self, TableError> {
        check_samples(function, &times_s, &values)?;
        let groups = Groups::of(&times_s, &values);
        course::check(function, &times_s, &values, &groups)?;
        let mut warnings: Vec<_> = course::noise(function, &values).into_iter().collect();
        warnings.extend(course::coverage(&times_s));
        Ok(Self {
            function,
            kind,
            curve: Interpolant::through(times_s, values),
            groups,
            warnings,
        })
    }

    /// The same samples, read from a table with this number of further rows in which a number is missing.
    #[must_use]
    pub fn with_rows_passed_over(mut self, rows: usize) -> Self {
        if rows > 0 {
            self.warnings.push(TableWarning::Missing { rows });
        }
        self
    }

    /// Whether the samples are a creep compliance or a relaxation modulus.
    pub fn function(&self) -> MaterialFunction {
        self.function
    }

    /// Whether they are shear or longitudinal.
    pub fn kind(&self) -> ModulusKind {
        self.kind
    }

    /// Times of the samples (s), strictly increasing.
    pub fn times_s(&self) -> &[f64] {
        self.curve.times_s()
    }

    /// Values of the samples, in 1/Pa (creep compliance) or Pa (relaxation modulus).
    pub fn values(&self) -> &[f64] {
        self.curve.values()
    }

    /// The function through the samples.
    pub fn curve(&self) -> &Interpolant {
        &self.curve
    }

    /// First positive and last time of a sample (s).
    pub fn window_s(&self) -> (f64, f64) {
        let last_s = self.curve.last_time_s();
        (self.curve.shortest_time_s().unwrap_or(last_s), last_s)
    }

    /// The samples as they are fitted.
    pub(super) fn groups(&self) -> &Groups {
        &self.groups
    }

    /// Standard deviation of the rounding of the values as they were written, as a share of them: a unit of the last digit
    /// over the root of twelve. All are taken to have as many digits as the longest, or as many decimals as the longest,
    /// whichever is coarser.
    pub fn rounding(&self) -> f64 {
        rounding(self.values())
    }

    /// What is odd about the samples.
    pub fn warnings(&self) -> &[TableWarning] {
        &self.warnings
    }

    /// The creep compliance (1/Pa) of the table's own kind, without a fit, which never falls: the samples made monotone, or,
    /// for a relaxation modulus made monotone, the solution D of `integral from 0 to t of E(t - s) dD(s) = 1` (I. L. Hopkins and R. W. Hamming, Journal of
    /// Applied Physics 28 (1957) 906), with D linear between instants four times as dense as the samples. That takes a sum over
    /// all earlier instants at each, and so the samples in their groups: a fortieth of a decade is far finer than any relaxation.
    pub fn creep_curve(&self) -> Interpolant {
        match self.function {
            MaterialFunction::Creep => {
                let weights = vec![1.0; self.values().len()];
                let monotone = isotonic(self.function, self.values(), &weights);
                Interpolant::through(self.times_s().to_vec(), monotone)
            }
            MaterialFunction::Relaxation => {
                let groups = &self.groups;
                let monotone = isotonic(self.function, &groups.values, &groups.counts());
                creep_of(&Interpolant::through(groups.times_s.clone(), monotone))
            }
        }
    }

    /// The contact compliance C(t) = (1 - nu^2) D(t) = (1 - nu) J(t)/2 without a fit, in 1/Pa, for the direct hereditary sum.
    ///
    /// # Errors
    /// A Poisson ratio outside -1 < nu <= 1/2, or a compliance beyond the range of a double.
    pub fn contact_compliance(&self, poisson_ratio: f64) -> Result<Interpolant, MaterialError> {
        super::Compressibility::PoissonRatio(poisson_ratio).checked()?;
        let nu = poisson_ratio;
        self.creep_curve().scaled(match self.kind {
            ModulusKind::Shear => 0.5 * (1.0 - nu),
            ModulusKind::Longitudinal => (1.0 - nu) * (1.0 + nu),
        })
    }
}

/// Everything that can be said of one sample and the one before.
fn check_samples(
    function: MaterialFunction,
    times_s: &[f64],
    values: &[f64],
) -> Result<(), TableError> {
    if times_s.len() != values.len() {
        let (times, values) = (times_s.len(), values.len());
        return Err(TableError::Lengths { times, values });
    }
    let mut before: Option<f64> = None;
    for (index, (&time_s, &value)) in times_s.iter().zip(values).enumerate() {
        let row = index + 1;
        if !(time_s.is_finite() && time_s >= 0.0) {
            return Err(TableError::Time { row, time_s });
        }
        if let Some(before_s) = before.filter(|&before_s| time_s <= before_s) {
            return Err(TableError::TimeOrder {
                row,
                time_s,
                before_s,
            });
        }
        if !(value.is_finite() && value > 0.0) {
            return Err(TableError::Value {
                function,
                row,
                value,
            });
        }
        before = Some(time_s);
    }
    match times_s.len() {
        0 => Err(TableError::Empty),
        found if found < FEWEST_SAMPLES => Err(TableError::TooFew { found }),
        _ => Ok(()),
    }
}

/// See [`Tabulated::rounding`].
fn rounding(values: &[f64]) -> f64 {
    let stride = values.len().div_ceil(ENOUGH_VALUES).max(1);
    let values = || values.iter().step_by(stride);
    let written: Vec<(i32, i32)> = values().map(|&v| written(v)).collect();
    let digits = written.iter().map(|(first, last)| first - last).max();
    let decimals = written.iter().map(|(_, last)| *last).min();
    let (digits, decimals) = (digits.unwrap_or(0), decimals.unwrap_or(0));
    let squares = values().zip(&written).map(|(value, (first, _))| {
        let unit = 10_f64.powi((first - digits).max(decimals));
        (unit / value).powi(2) / 12.0
    });
    let mean = squares.sum::<f64>() / written.len().max(1) as f64;
    mean.sqrt().min(COARSEST)
}

/// Powers of ten of the first and the last digit of a number as it was written, but for the rounding of a change of unit.
fn written(value: f64) -> (i32, i32) {
    let first = value.log10().floor() as i32;
    let same = |decimals: &usize| {
        let rounded: f64 = format!("{value:.decimals$e}").parse().unwrap_or(value);
        (rounded / value - 1.0).abs() < 1e-14
    };
    let decimals = (0..16).find(same).unwrap_or(16);
    (first, first - decimals as i32)
}

/// The monotone sequence nearest to the values, each of this weight: rising for a creep compliance, falling for a relaxation modulus.
fn isotonic(function: MaterialFunction, values: &[f64], weights: &[f64]) -> Vec<f64> {
    order::isotonic(values, weights, |before, after| match function {
        MaterialFunction::Creep => before > after,
        MaterialFunction::Relaxation => before < after,
    })
}

/// The creep compliance that belongs to a relaxation modulus which never rises. It never falls: what was put on so far holds
/// less of the load at every next instant.
fn creep_of(modulus: &Interpolant) -> Interpolant {
    const DENSITY: usize = 4;
    let samples = modulus.times_s();
    let mut times = vec![0.0];
    for pair in std::iter::once([0.0, samples[0]]).chain(samples.windows(2).map(|p| [p[0], p[1]])) {
        for part in 1..=DENSITY {
            let share = part as f64 / DENSITY as f64;
            let time = match (pair[0] > 0.0, part == DENSITY) {
                (_, true) => pair[1],
                (true, _) => pair[0] * (pair[1] / pair[0]).powf(share),
                (false, _) => pair[1] * share,
            };
            if times.last().is_some_and(|&last| time > last) {
                times.push(time);
            }
        }
    }
    let initial = 1.0 / modulus.value(0.0);
    let mut increments: Vec<f64> = Vec::with_capacity(times.len());
    let mut compliances = vec![initial];
    let mut compliance = initial;
    for &now in &times[1..] {
        let step = increments.len();
        let past: f64 = increments
            .iter()
            .zip(times.windows(2))
            .map(|(increment, t)| increment * modulus.mean(now - t[1], now - t[0]))
            .sum();
        let missing = 1.0 - initial * modulus.value(now) - past;
        // Less than nothing is missing by rounding alone.
        let increment = (missing / modulus.mean(0.0, now - times[step])).max(0.0);
        increments.push(increment);
        compliance += increment;
        compliances.push(compliance);
    }
    Interpolant::through(times, compliances)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::library;
    use crate::material::synthetic::{Noise, log_spaced};

    fn creep(times: &[f64], values: &[f64]) -> Result<Tabulated, TableError> {
        Tabulated::new(
            MaterialFunction::Creep,
            ModulusKind::Shear,
            times.to_vec(),
            values.to_vec(),
        )
    }

    fn message(times: &[f64], values: &[f64]) -> String {
        creep(times, values).unwrap_err().to_string()
    }

    #[test]
    fn every_bad_sample_is_refused_by_its_row() {
        let good = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(creep(&[], &[]), Err(TableError::Empty));
        assert!(message(&[1.0], &[1.0]).contains("too few samples, 1; it takes at least 4"));
        assert!(message(&good, &good[..3]).contains("4 times but 3 values"));
        for bad in [f64::NAN, f64::INFINITY, -1.0] {
            assert!(message(&[bad, 2.0, 3.0, 4.0], &good).contains("time of row 1"));
            assert!(message(&good, &[1.0, 2.0, bad, 4.0]).contains("compliance of row 3"));
        }
        assert!(message(&good, &[0.0, 2.0, 3.0, 4.0]).contains("row 1 is 0"));
        let error = creep(&[1.0, 3.0, 3.0, 4.0], &good).unwrap_err();
        assert!(error.to_string().contains("row 3, 3 s"));
        assert_eq!(error.place(), Some((3, TableColumn::Time)));
        assert!(message(&[1.0, 3.0, 2.0, 4.0], &good).contains("times must increase"));
        assert!(
            creep(&[0.0, 1.0, 2.0, 20.0], &good)
                .unwrap()
                .warnings()
                .is_empty()
        );
    }

    #[test]
    fn a_creep_compliance_that_falls_and_a_relaxation_modulus_that_rises_are_refused() {
        let times = log_spaced(1.0, 1e3, 10);
        for (slope, words) in [(-0.5, "falls by"), (-0.01, "falls steadily")] {
            let falling: Vec<f64> = times.iter().map(|t| t.powf(slope)).collect();
            let text = message(&times, &falling);
            assert!(text.contains(words), "{text}");
            let rising = falling.iter().map(|v| 1.0 / v).collect();
            let error = Tabulated::new(
                MaterialFunction::Relaxation,
                ModulusKind::Shear,
                times.clone(),
                rising,
            );
            assert!(error.unwrap_err().to_string().contains("rises"));
        }
        // The same with noise of a third of what it falls by in all.
        let mut noise = Noise(5);
        let falling: Vec<f64> = times
            .iter()
            .map(|t| t.powf(-0.01) * (1.0 + 0.003 * noise.normal()))
            .collect();
        assert!(message(&times, &falling).contains("steadily"));
    }

    #[test]
    fn an_isolated_sample_is_noise_up_to_the_limit_and_no_further() {
        let times = log_spaced(1.0, 1e3, 10);
        let mut values: Vec<f64> = times.iter().map(|t| 1.0 + 1e-3 * t.ln()).collect();
        let clean = values[17];
        values[17] = 0.93 * clean;
        let table = creep(&times, &values).unwrap();
        let [
            TableWarning::Noise {
                samples,
                row,
                largest_share,
                ..
            },
        ] = table.warnings()
        else {
            panic!("{:?}", table.warnings())
        };
        assert_eq!((*samples, *row), (1, 18));
        // 7 % below its own course, and a little less below the sample before.
        assert!((largest_share - 0.07).abs() < 1e-3);
        values[17] = 0.88 * clean;
        assert_eq!(
            creep(&times, &values).unwrap_err().place(),
            Some((18, TableColumn::Value))
        );
    }

    #[test]
    fn scatter_about_a_constant_is_not_taken_for_a_trend() {
        // A constant is the hardest case: nothing rises. One in 10 000 may be refused; here none of 400.
        let mut noise = Noise(1);
        for count in [4, 6, 10, 40, 200] {
            let times: Vec<f64> = (1..=count).map(f64::from).collect();
            for _ in 0..80 {
                let values: Vec<f64> = times.iter().map(|_| 1.0 + 0.01 * noise.normal()).collect();
                assert!(creep(&times, &values).is_ok(), "{count}");
            }
        }
    }

    #[test]
    fn many_noisy_samples_are_judged_in_groups_and_a_trend_among_them_is_found() {
        // Two per cent of noise on 5,994 samples: somewhere one is 14 % above an earlier one.
        let times: Vec<f64> = (1..=5994).map(f64::from).collect();
        let sampled = |drift: f64| {
            let mut noise = Noise(11);
            let value = |&t: &f64| {
                let modulus = 1e6 + 1e5 * (-t / 50.0_f64).exp();
                modulus * (1.0 + drift * (t / 5994.0)) * (1.0 + 0.02 * noise.normal())
            };
            let values = times.iter().map(value).collect();
            Tabulated::new(
                MaterialFunction::Relaxation,
                ModulusKind::Shear,
                times.clone(),
                values,
            )
        };
        let table = sampled(0.0).unwrap();
        let [TableWarning::Noise { largest_share, .. }] = table.warnings() else {
            panic!("{:?}", table.warnings())
        };
        assert!(*largest_share > 0.1);
        let message = sampled(0.1).unwrap_err().to_string();
        assert!(message.contains("rises steadily") && message.contains("from about row"));
        // Sparse samples of three per cent, flat for two decades: judged by their scatter.
        let mut noise = Noise(12);
        let times = log_spaced(1.0, 1e4, 30);
        let values = times.iter().map(|t| {
            let modulus = 1.0 + (-t / 30.0_f64).exp();
            modulus * (1.0 + 0.03 * noise.normal())
        });
        let values = values.collect();
        assert!(
            Tabulated::new(
                MaterialFunction::Relaxation,
                ModulusKind::Shear,
                times,
                values
            )
            .is_ok()
        );
    }

    #[test]
    fn the_rounding_of_the_values_is_read_from_their_digits() {
        let of = |values: &[f64]| creep(&[1.0, 2.0, 3.0, 4.0], values).unwrap().rounding();
        let unit = |values: &[f64; 4], units: [f64; 4]| {
            let squares = values
                .iter()
                .zip(units)
                .map(|(v, unit)| (unit / v).powi(2) / 12.0);
            (squares.sum::<f64>() / 4.0).sqrt()
        };
        // Three digits, in units that leave rounding behind; and three decimals.
        let digits = [0.0985, 0.0996, 0.101, 0.12];
        let per_pa = digits.map(|v| v * 1e-9);
        let expected = unit(&digits, [1e-4, 1e-4, 1e-3, 1e-3]);
        assert!((of(&per_pa) / expected - 1.0).abs() < 1e-12);
        let decimals = [0.985, 0.996, 1.013, 1.1];
        assert!((of(&decimals) / unit(&decimals, [1e-3; 4]) - 1.0).abs() < 1e-12);
        // All digits of a double: next to nothing. One digit: no more than is believed.
        assert!(of(&[0.1_f64.sqrt(), 0.2_f64.sqrt(), 1.0, 2.0]) < 1e-13);
        assert_eq!(of(&[1.0, 2.0, 3.0, 4.0]), COARSEST);
    }

    #[test]
    fn what_goes_into_the_direct_sum_never_falls_and_is_the_samples_where_they_do_not() {
        let mut noise = Noise(3);
        let times = log_spaced(1.0, 1e3, 20);
        for function in [MaterialFunction::Creep, MaterialFunction::Relaxation] {
            let table = |noise: &mut dyn FnMut() -> f64| {
                let value = |t: f64| match function {
                    MaterialFunction::Creep => 2.0 - (-t / 10.0).exp(),
                    MaterialFunction::Relaxation => 1.0 + (-t / 10.0).exp(),
                };
                let values = times
                    .iter()
                    .map(|&t| value(t) * (1.0 + 0.02 * noise()))
                    .collect();
                Tabulated::new(function, ModulusKind::Shear, times.clone(), values).unwrap()
            };
            let clean = table(&mut || 0.0);
            let ones = vec![1.0; times.len()];
            assert_eq!(isotonic(function, clean.values(), &ones), clean.values());
            let noisy = table(&mut || noise.normal());
            let curve = noisy.creep_curve();
            assert!(curve.values().windows(2).all(|pair| pair[0] <= pair[1]));
            // Pooling keeps the mean.
            let sum = |values: &[f64]| values.iter().sum::<f64>();
            let ratio = sum(&isotonic(function, noisy.values(), &ones)) / sum(noisy.values());
            assert!((ratio - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn gaps_and_short_data_are_pointed_out() {
        let gappy = creep(&[0.0, 1.0, 2.0, 50.0, 500.0], &[1.0, 1.0, 1.1, 1.2, 1.3]).unwrap();
        assert_eq!(
            gappy.warnings(),
            [TableWarning::Gap {
                from_s: 2.0,
                to_s: 50.0
            }]
        );
        assert!(
            gappy.warnings()[0]
                .to_string()
                .contains("between 2 s and 50 s")
        );
        let short = creep(&[0.0, 1.0, 2.0, 9.0], &[1.0, 1.0, 1.1, 1.2]).unwrap();
        assert!(matches!(short.warnings(), [TableWarning::Short { .. }]));
        assert!(short.warnings()[0].to_string().contains("0.95 decades"));
    }

    #[test]
    fn a_tabulated_relaxation_modulus_becomes_the_creep_compliance_of_the_material_without_a_fit() {
        let material = library::find("pmma").unwrap().material().unwrap();
        let relaxation = material.relaxation().unwrap();
        let error = |per_decade, first| {
            let mut times = log_spaced(0.01, 1e4, per_decade);
            if first {
                times.insert(0, 0.0);
            }
            let values = times.iter().map(|&t| relaxation.modulus(t)).collect();
            let table =
                Tabulated::new(MaterialFunction::Relaxation, material.kind(), times, values);
            let curve = table.unwrap().creep_curve();
            log_spaced(0.01, 9e3, 37)
                .iter()
                .map(|&t| (curve.value(t) / material.creep().compliance(t) - 1.0).abs())
                .fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(10, false), error(20, true));
        println!("creep from tabulated relaxation: {coarse:e} {fine:e}");
        // Power laws between ten samples per decade miss the modulus of PMMA by 3e-4 (measured); what is done with them
        // must not be worse, and is of second order. The time before the first sample costs 0.01/8.93/10.
        assert!(coarse < 3e-4, "{coarse:e}");
        assert!(fine < 0.3 * coarse, "{fine:e}");
    }

    #[test]
    fn many_samples_at_equal_steps_cost_no_more_than_a_fortieth_decade_apart() {
        let (equilibrium, stiffness, time_s) = (1.0, 3.0, 20.0);
        let count = 40_000;
        let times: Vec<f64> = (0..count).map(|i| 0.05 * f64::from(i)).collect();
        let modulus = |t: f64| equilibrium + stiffness * (-t / time_s).exp();
        let values = times.iter().map(|&t| modulus(t)).collect();
        let (function, kind) = (MaterialFunction::Relaxation, ModulusKind::Shear);
        let curve = Tabulated::new(function, kind, times, values)
            .unwrap()
            .creep_curve();
        // 4.6 decades, the first one and a half of them sparse, four instants for each.
        let instants = curve.times_s().len();
        assert!(instants < 4 * 5 * 40, "{instants}");
        // D = 1/E_inf - (1/E_inf - 1/E_0) exp(-t/lambda), with lambda = tau E_0/E_inf.
        let lambda = time_s * (equilibrium + stiffness) / equilibrium;
        for t in log_spaced(0.05, 1999.0, 17) {
            let left = 1.0 - 1.0 / (equilibrium + stiffness);
            let exact = 1.0 - left * (-t / lambda).exp();
            let error = (curve.value(t) / exact - 1.0).abs();
            // Between the first two instants, where a power law stands for a straight line.
            assert!(error < 2e-4, "{t}: {error:e}");
        }
    }

    #[test]
    fn the_contact_compliance_is_that_of_the_material() {
        let material = library::find("pmma").unwrap().material().unwrap();
        let times = log_spaced(0.1, 1e3, 10);
        let values = times
            .iter()
            .map(|&t| material.creep().compliance(t))
            .collect();
        let table =
            Tabulated::new(MaterialFunction::Creep, material.kind(), times, values).unwrap();
        let contact = table
            .contact_compliance(material.poisson_ratio().unwrap())
            .unwrap();
        let exact = material.contact_compliance().unwrap();
        for &t in table.times_s() {
            assert!((contact.value(t) / exact.compliance(t) - 1.0).abs() < 1e-14);
        }
        assert!(table.contact_compliance(0.7).is_err());
    }
}
