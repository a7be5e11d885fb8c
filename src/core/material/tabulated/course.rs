//! The course of samples: noise told from what no passive material does, by the rules in [`super`]; and the times that they leave out.

use super::{Groups, TableError, TableWarning, rounding};
use crate::material::MaterialFunction;
use crate::numerics::order::median;

/// Share by which one value may be on the wrong side of an earlier one, however small the scatter.
pub const NOISE_LIMIT: f64 = 0.10;

/// How many standard deviations of the scatter it may: the range of a thousand normal deviates is below 8.
pub const REVERSAL_SCATTER: f64 = 8.0;

/// And the largest share in any case.
pub const REVERSAL_LIMIT: f64 = 0.30;

/// Share by which medians may be on the wrong side, however small the scatter: rounding of the data, drift of an instrument.
pub const TREND_FLOOR: f64 = 0.005;

/// And how many standard deviations of the scatter they may. Pure scatter about a constant, which is the hardest case, was
/// refused in fewer than one of a thousand simulated tables of ten samples or more.
pub const TREND_SCATTER: f64 = 6.0;

/// Fewest consecutive values whose median stands for them.
const RUN: usize = 5;

/// Deviations too few for their median to mean anything.
const FEW: usize = 10;

/// Decades without a sample that are worth a warning, and decades of data that are enough not to get one.
const WIDE_GAP: f64 = 1.0;
const ENOUGH_DECADES: f64 = 1.0;

/// ln C or -ln E: what must not fall.
fn rising(function: MaterialFunction, values: &[f64]) -> Vec<f64> {
    match function {
        MaterialFunction::Creep => values.iter().map(|v| v.ln()).collect(),
        MaterialFunction::Relaxation => values.iter().map(|v| -v.ln()).collect(),
    }
}

/// What a fall of the logarithm is as a share.
fn share(fall: f64) -> f64 {
    -(-fall).exp_m1()
}

/// Samples on the wrong side of an earlier one.
pub(super) fn noise(function: MaterialFunction, values: &[f64]) -> Option<TableWarning> {
    let mut highest = f64::NEG_INFINITY;
    let (mut samples, mut largest, mut row) = (0, 0.0, 0);
    for (index, value) in rising(function, values).into_iter().enumerate() {
        if value < highest {
            samples += 1;
            if highest - value > largest {
                (largest, row) = (highest - value, index + 1);
            }
        }
        highest = highest.max(value);
    }
    (samples > 0).then(|| TableWarning::Noise {
        function,
        samples,
        largest_share: share(largest),
        row,
    })
}

/// Tells noise from what no passive material does.
pub(super) fn check(
    function: MaterialFunction,
    times_s: &[f64],
    values: &[f64],
    groups: &Groups,
) -> Result<(), TableError> {
    let (scatter, of_few) = scatter(times_s, &rising(function, values));
    // Where all change is rounded away, samples do not scatter.
    let scatter = scatter.max(rounding(values));
    let rising = rising(function, &groups.values);
    let deviations: Vec<f64> = groups.weights().iter().map(|w| 1.0 / w).collect();
    // Few samples say little about their scatter, and what is looked for is part of it.
    let known = if of_few { 0.0 } else { scatter };
    let most = |deviation: f64| {
        let by_scatter = share(REVERSAL_SCATTER * known * deviation);
        by_scatter.clamp(NOISE_LIMIT, REVERSAL_LIMIT)
    };
    let limit = |deviation| -(-most(deviation)).ln_1p();
    if let Some((size, from, to)) = fall_beyond(&rising, &deviations, limit) {
        return Err(TableError::Reversal {
            function,
            earlier_row: groups.starts[from] + 1,
            row: groups.starts[to] + 1,
            share: share(size),
            limit: most(deviations[from].max(deviations[to])),
        });
    }
    let mut run = RUN.min(rising.len() / 2).max(1);
    while run == 1 || 2 * run <= rising.len() {
        let stride = (run / RUN).max(1);
        let starts: Vec<usize> = (0..=rising.len() - run).step_by(stride).collect();
        let medians = starts.iter().map(|&i| median(&rising[i..i + run]));
        let medians: Vec<f64> = medians.collect();
        let largest = |i: &usize| deviations[*i..i + run].iter().copied().fold(0.0, f64::max);
        let deviations: Vec<f64> = starts.iter().map(largest).collect();
        let averaged = (RUN.min(run) as f64 / run as f64).sqrt();
        let limit =
            |deviation: f64| TREND_FLOOR.max(TREND_SCATTER * scatter * deviation * averaged);
        if let Some((size, from, to)) = fall_beyond(&medians, &deviations, limit) {
            let row = |place: usize| groups.starts[starts[place] + run / 2] + 1;
            return Err(TableError::Trend {
                function,
                earlier_row: row(from),
                row: row(to),
                share: share(size),
                scatter,
            });
        }
        run *= 2;
    }
    Ok(())
}

/// The largest fall among those beyond their limit, which is that of the larger of the two deviations: its size, from where and to
/// where.
fn fall_beyond(
    values: &[f64],
    deviations: &[f64],
    limit: impl Fn(f64) -> f64,
) -> Option<(f64, usize, usize)> {
    let limits: Vec<f64> = deviations.iter().map(|&d| limit(d)).collect();
    let pairs = (1..values.len()).flat_map(|to| (0..to).map(move |from| (from, to)));
    let falls = pairs.map(|(from, to)| (values[from] - values[to], from, to));
    let beyond = falls.filter(|&(size, from, to)| size > limits[from].max(limits[to]));
    beyond.reduce(|worst, fall| if fall.0 > worst.0 { fall } else { worst })
}

/// Standard deviation of the samples about the chord between their neighbours, and whether these are few: from the median, so that
/// outliers do not count, except where there are too few samples for that.
fn scatter(times_s: &[f64], values: &[f64]) -> (f64, bool) {
    let deviations: Vec<f64> = times_s
        .windows(3)
        .zip(values.windows(3))
        .filter(|(t, _)| t[0] > 0.0)
        .map(|(t, v)| {
            let share = (t[1] / t[0]).ln() / (t[2] / t[0]).ln();
            let deviation = v[1] - (1.0 - share) * v[0] - share * v[2];
            // What three independent samples of unit variance give.
            deviation.abs() / (1.0 + share * share + (1.0 - share).powi(2)).sqrt()
        })
        .collect();
    if deviations.len() < FEW {
        let squares: f64 = deviations.iter().map(|d| d * d).sum();
        return ((squares / deviations.len().max(1) as f64).sqrt(), true);
    }
    // The median of the magnitude of a normal variable is 0.6745 of its standard deviation.
    (median(&deviations) / 0.6745, false)
}

/// Gaps and shortness.
pub(super) fn coverage(times_s: &[f64]) -> Vec<TableWarning> {
    let positive = &times_s[times_s.partition_point(|&t| t <= 0.0)..];
    let wide = |from_s: f64, to_s: f64| (to_s / from_s).log10() > WIDE_GAP * (1.0 + 1e-12);
    let gaps = positive
        .windows(2)
        .filter(|pair| wide(pair[0], pair[1]))
        .map(|pair| TableWarning::Gap {
            from_s: pair[0],
            to_s: pair[1],
        });
    let mut warnings: Vec<_> = gaps.collect();
    if let (Some(&from_s), Some(&to_s)) = (positive.first(), positive.last())
        && (to_s / from_s).log10() < ENOUGH_DECADES * (1.0 - 1e-12)
    {
        warnings.push(TableWarning::Short { from_s, to_s });
    }
    warnings
}
