//! How noisy dynamic data are, from the scatter of each isotherm about a smooth curve of its own.
//!
//! Two curves are tried, and what scatters less about one of them is believed: a polynomial for each modulus, which knows nothing of
//! the other and cannot follow a single branch, and a non-negative series through both, which follows whatever a linear
//! viscoelastic material does.

use super::one_curve::OneCurve;
use super::{DynamicData, DynamicPoint, Isotherm};
use crate::numerics::nnls::least_squares;
use nalgebra::{DMatrix, DVector};

/// Relative standard deviation of storage and loss modulus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    pub storage: f64,
    pub loss: f64,
}

/// What is assumed where no isotherm has points enough to show its scatter.
const UNKNOWN: f64 = 0.01;

/// Below this the series that stands for the master curve is no better than the data.
const LEAST: f64 = 2e-4;

/// Share of the values that must be left as degrees of freedom for a series to show their scatter.
const FREE: f64 = 0.25;

/// Highest power of the logarithm of the frequency in the curve of an isotherm.
const HIGHEST_POWER: usize = 6;

impl Noise {
    /// From the scatter of all isotherms together.
    pub fn of(data: &DynamicData) -> Self {
        let polynomials = Self {
            storage: pooled(data, |point| point.storage_modulus_pa),
            loss: pooled(data, |point| point.loss_modulus_pa),
        };
        // Both moduli weigh the same: a series that is weighted by what it found follows one of them ever more closely.
        let alike = Self {
            storage: UNKNOWN,
            loss: UNKNOWN,
        };
        let series = alike.about_series(data);
        Self {
            storage: polynomials.storage.min(series.storage),
            loss: polynomials.loss.min(series.loss),
        }
    }

    /// The scatter about a series for each isotherm, weighted by the noise assumed. Which of the moduli a series takes its
    /// degrees of freedom from, the projection onto its columns tells; a loss modulus that it
    /// does little but repeat is taken to be no better than the storage modulus.
    fn about_series(&self, data: &DynamicData) -> Self {
        let mut squares = [0.0, 0.0];
        let mut all = 0.0;
        let mut freedom = [0.0, 0.0];
        for isotherm in data.isotherms() {
            let state = OneCurve::new(&[isotherm], self, 0, false).at(&[0.0], &[]);
            let points = isotherm.points.len() as f64;
            all += points;
            for part in 0..2 {
                squares[part] += points * state.relative[part].powi(2);
                freedom[part] += points - state.taken[part];
            }
        }
        let level = |part: usize| (squares[part] / freedom[part].max(1.0)).sqrt().max(LEAST);
        let (storage, loss) = (level(0), level(1));
        let shown = |part: usize| freedom[part] >= FREE * all;
        Self {
            storage: if shown(0) { storage } else { f64::INFINITY },
            loss: if shown(1) { loss } else { loss.max(storage) },
        }
    }

    /// Relative standard deviations of a point: its own, where the file gave them.
    pub fn of_point(&self, point: &DynamicPoint) -> (f64, f64) {
        let own = |error: f64, value: f64| {
            let relative = error / value;
            (relative.is_finite() && relative > 0.0).then_some(relative.max(LEAST))
        };
        let (storage, loss) = point.errors_pa.unwrap_or_default();
        (
            own(storage, point.storage_modulus_pa).unwrap_or(self.storage),
            own(loss, point.loss_modulus_pa).unwrap_or(self.loss),
        )
    }
}

fn pooled(data: &DynamicData, value: fn(&DynamicPoint) -> f64) -> f64 {
    let scatters = data.isotherms().iter().filter_map(|i| scatter(i, value));
    let (squares, freedom) = scatters.fold((0.0, 0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
    match freedom {
        0 => UNKNOWN,
        _ => (squares / freedom as f64).sqrt().max(LEAST),
    }
}

/// Sum of squares about a polynomial in the logarithm of the frequency through the logarithm of the modulus, of the degree that the
/// corrected criterion of Akaike prefers, and its degrees of freedom.
fn scatter(isotherm: &Isotherm, value: fn(&DynamicPoint) -> f64) -> Option<(f64, usize)> {
    let points = &isotherm.points;
    let count = points.len();
    let x: Vec<f64> = points
        .iter()
        .map(|p| p.angular_frequency_rad_per_s.ln())
        .collect();
    let (first, last) = (x.first()?, x.last()?);
    let y = DVector::from_iterator(count, points.iter().map(|p| value(p).ln()));
    let unit = |x: f64| 2.0 * (x - first) / (last - first).max(f64::MIN_POSITIVE) - 1.0;
    let of_degree = |degree: usize| {
        let matrix = DMatrix::from_fn(count, degree + 1, |i, j| unit(x[i]).powi(j as i32));
        let squares = (&y - &matrix * least_squares(&matrix, &y)?).norm_squared();
        // Coefficients and the variance.
        let unknowns = (degree + 2) as f64;
        let n = count as f64;
        let correction = match n - unknowns - 1.0 {
            left if left > 0.0 => 2.0 * unknowns * (unknowns + 1.0) / left,
            _ => return None,
        };
        let criterion = n * (squares / n).max(f64::MIN_POSITIVE).ln() + 2.0 * unknowns + correction;
        Some((criterion, squares, count - degree - 1))
    };
    let fits = (1..=HIGHEST_POWER).filter_map(of_degree);
    let best = fits.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((best.1, best.2))
}
