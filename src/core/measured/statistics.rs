//! Means of a few numbers that may be correlated, and the interval that holds the truth 95 times in 100.

use serde::{Deserialize, Serialize};

/// A mean with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    pub value: f64,
    /// Standard error of the mean; `None` where nothing tells it.
    pub standard_error: Option<f64>,
    /// Half the width of the interval of 95 %, with Student's factor.
    pub error: Option<f64>,
}

/// A standard error and its degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandardError {
    pub value: f64,
    pub freedom: f64,
}

impl StandardError {
    /// Half the width of the interval of 95 %.
    pub fn half_width(self) -> f64 {
        student(self.freedom) * self.value
    }

    /// Whether it is larger than one that is known well by more than 1 in 20 by chance: chi squared over its degrees of freedom by the
    /// cube root of E. B. Wilson and M. M. Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684.
    fn is_beyond(self, known: Self) -> bool {
        const NORMAL_OF_ONE_SIDE: f64 = 1.644_853_626_951_472;
        let part = 2.0 / (9.0 * self.freedom);
        let limit = (1.0 - part + NORMAL_OF_ONE_SIDE * part.sqrt()).powi(3);
        self.value > known.value * limit.sqrt()
    }
}

impl Estimate {
    /// The mean of cycles. Its uncertainty is told twice: by how the cycles scatter, and by the noise of the samples. Few cycles scatter
    /// little by chance, and a noise that is not white scatters more than its samples say. The interval is the wider one. The standard
    /// error, which weighs a datum in a fit, is that of the noise unless the cycles scatter by more than chance lets them: the larger one of
    /// both would be too large on average, and chi squared of a fit too small.
    pub fn of(values: &[f64], from_noise: Option<StandardError>) -> Option<Self> {
        let value = mean(values)?;
        let scatter = scatter(values);
        let standard_error = match (scatter, from_noise) {
            (Some(scatter), Some(noise)) if !scatter.is_beyond(noise) => Some(noise.value),
            (scatter, noise) => scatter.or(noise).map(|error| error.value),
        };
        let half_widths = (scatter.into_iter().chain(from_noise)).map(StandardError::half_width);
        Some(Self {
            value,
            standard_error,
            error: half_widths.max_by(f64::total_cmp),
        })
    }
}

/// `None` of nothing.
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Standard error of a mean from the scatter of the values, in their order: neighbours that are alike count for less than one each.
/// `None` of fewer than two.
pub fn scatter(values: &[f64]) -> Option<StandardError> {
    let center = mean(values)?;
    let count = values.len();
    if count < 2 {
        return None;
    }
    let n = count as f64;
    let deviation = |i: usize| values[i] - center;
    let product = |lag: usize| {
        (lag..count)
            .map(|i| deviation(i) * deviation(i - lag))
            .sum::<f64>()
    };
    let squares = product(0);
    // The first lags that agree; correlations of few values are noise themselves.
    let mut alike = 1.0;
    for lag in 1..=count / 4 {
        let correlation = product(lag) / squares;
        if correlation.is_nan() || correlation <= 0.0 {
            break;
        }
        alike += 2.0 * (1.0 - lag as f64 / n) * correlation;
    }
    let independent = (n / alike).max(2.0);
    Some(StandardError {
        value: (squares / (n - 1.0) * alike / n).sqrt(),
        freedom: independent - 1.0,
    })
}

/// Student's factor: two-sided, 95 % (G. W. Hill, Algorithm 396, Communications of the ACM 13, 1970). Below three degrees of freedom
/// those of whole numbers.
pub fn student(freedom: f64) -> f64 {
    quantile(freedom, 0.05, NORMAL)
}

/// The same of the normal distribution: of a standard deviation that is known.
pub const NORMAL: f64 = 1.959_963_984_540_054;

/// The same for a chance of 1 in 400, by which trends are judged.
pub(super) fn student_of_trend(freedom: f64) -> f64 {
    quantile(freedom, 0.0025, 3.023_341_439_739_154)
}

/// What is exceeded with this chance on both sides together, of which `normal` is the limit for many degrees of freedom.
fn quantile(freedom: f64, chance: f64, normal: f64) -> f64 {
    use std::f64::consts::{FRAC_PI_2, PI};
    if freedom < 2.0 {
        let angle = chance * FRAC_PI_2;
        return angle.cos() / angle.sin();
    }
    if freedom < 3.0 {
        return (2.0 / (chance * (2.0 - chance)) - 2.0).sqrt();
    }
    let n = freedom.min(1e9);
    let a = 1.0 / (n - 0.5);
    let b = 48.0 / (a * a);
    let mut c = ((20_700.0 * a / b - 98.0) * a - 16.0) * a + 96.36;
    let d = ((94.5 / (b + c) - 3.0) / b + 1.0) * (a * 0.5 * PI).sqrt() * n;
    let mut y = (d * chance).powf(2.0 / n);
    if y > 0.05 + a {
        let x = -normal;
        y = x * x;
        if n < 5.0 {
            c += 0.3 * (n - 4.5) * (x + 0.6);
        }
        c += (((0.05 * d * x - 5.0) * x - 7.0) * x - 2.0) * x + b;
        y = (((((0.4 * y + 6.3) * y + 36.0) * y + 94.5) / c - y - 3.0) / b + 1.0) * x;
        y = (a * y * y).exp_m1();
    } else {
        y = ((1.0 / (((n + 6.0) / (n * y) - 0.089 * d - 0.822) * (n + 2.0) * 3.0)
            + 0.5 / (n + 4.0))
            * y
            - 1.0)
            * (n + 1.0)
            / (n + 2.0)
            + 1.0 / y;
    }
    (n * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn student_factors_are_those_of_the_tables() {
        for (freedom, factor) in [
            (1.0, 12.7062),
            (2.0, 4.3027),
            (3.0, 3.1824),
            (4.0, 2.7764),
            (5.0, 2.570_58),
            (9.0, 2.2622),
            (10.0, 2.228_14),
            (21.0, 2.079_61),
            (30.0, 2.0423),
            (120.0, 1.9799),
            (1e7, 1.9600),
        ] {
            // The tables have five digits, and the algorithm keeps them.
            assert!((student(freedom) / factor - 1.0).abs() < 2e-4, "{freedom}");
        }
        assert!((student(1e5) / NORMAL - 1.0).abs() < 1e-4);
        assert!((student_of_trend(1e8) - 3.0233).abs() < 1e-3);
        assert!((student_of_trend(4.0) / 6.7583 - 1.0).abs() < 5e-3);
    }

    #[test]
    fn alternating_values_count_fully_and_alike_neighbours_for_less() {
        let white: Vec<f64> = (0..40).map(|i| f64::from(i % 2)).collect();
        let blocks: Vec<f64> = (0..40).map(|i| f64::from(i / 5 % 2)).collect();
        let (white, blocks) = (scatter(&white).unwrap(), scatter(&blocks).unwrap());
        assert!((white.value - (10.0_f64 / 39.0 / 40.0).sqrt()).abs() < 1e-15);
        assert_eq!(white.freedom, 39.0);
        assert!(blocks.value > 1.5 * white.value && blocks.freedom < 20.0);
        assert_eq!(scatter(&[1.0]), None);
        assert_eq!(Estimate::of(&[], None), None);
    }

    #[test]
    fn the_wider_interval_counts() {
        let noise = StandardError {
            value: 0.1,
            freedom: 1e6,
        };
        let narrow = Estimate::of(&[1.0, 1.0, 1.0], Some(noise)).unwrap();
        assert_eq!(narrow.standard_error, Some(0.1));
        let wide = Estimate::of(&[0.0, 1.0, 2.0], Some(noise)).unwrap();
        assert!((wide.standard_error.unwrap() - 1.0 / 3.0_f64.sqrt()).abs() < 1e-15);
    }
}
