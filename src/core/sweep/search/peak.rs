//! Peaks of the loss over frequency: bracketed by the samples of the sweep, then refined by solving between them.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::numerics::grid::logarithmic;
use crate::sweep::plan::{AxisValues, Condition};

/// A local maximum of the energy loss.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    pub angular_frequency_rad_per_s: f64,
    pub energy_loss_j: f64,
    /// By how much (rad/s) the last refinement and the error bars of the losses move the frequency.
    pub angular_frequency_uncertainty_rad_per_s: f64,
    /// Error (J) of the loss there, where the losses have error bars.
    pub energy_loss_error_j: Option<f64>,
    /// Errors of frequency (rad/s) and loss (J) that come from the noise of the data which the material was fitted to, where it has
    /// replicas: no part of the two above, which are numerical.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angular_frequency_material_error_rad_per_s: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy_loss_material_error_j: Option<f64>,
    /// The numbers (SI units) that other axes than the frequency vary.
    #[serde(default, skip_serializing_if = "AxisValues::is_empty")]
    pub varied: AxisValues,
    /// Mean and amplitude of the drive (N or m) there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive_mean: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive_amplitude: Option<f64>,
}

impl Peak {
    /// Whether it is one of the curve under this condition: those of the only curve do not say which it is.
    pub fn is_of(&self, condition: &Condition) -> bool {
        self.varied == condition.values
    }
}

/// A point of the curve: angular frequency (rad/s), energy loss (J).
pub type Point = (f64, f64);

/// Why a bracketed peak has no refined value.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PeakError {
    #[error(
        "the loss at {angular_frequency_rad_per_s:e} rad/s, needed to locate a peak, could not be computed: {reason}"
    )]
    Case {
        angular_frequency_rad_per_s: f64,
        reason: String,
    },
    #[error(
        "the peak near {angular_frequency_rad_per_s:e} rad/s did not settle to the accuracy asked for"
    )]
    NotSettled { angular_frequency_rad_per_s: f64 },
}

/// A loss and its error (J), where it has one.
pub type Loss = (f64, Option<f64>);

/// Computes the losses at several frequencies (rad/s), or says in its own terms why there are none.
pub type Losses<'a, E> = dyn Fn(&[f64]) -> Result<Vec<Loss>, E> + 'a;

/// Accuracy to which a peak's frequency is located, relative.
pub const RELATIVE_ACCURACY: f64 = 1e-3;

/// Points per refinement: a quartic through five.
const STENCIL: usize = 5;
/// Half width of the first stencil in ln(omega), at most. Wide enough that errors of 1e-6 in the losses move the vertex by less
/// than the accuracy, narrow enough that a quartic follows a relaxation peak, whose width in ln(omega) is of order 1.
const HALF_WIDTH: f64 = 0.3;
const ROUNDS: usize = 6;

/// Width of a bracket, in decades, from which its losses may have several humps.
const WIDEST: f64 = 1.0;
/// Cases per decade that find them: a relaxation is as wide as a decade at half its height, and no closer ones are distinguished.
const PER_DECADE: f64 = 3.0;

/// Triples of neighbours whose middle has the larger loss: each brackets a peak. The ends of a sweep are no peaks.
pub fn brackets(curve: &[Point]) -> Vec<[Point; 3]> {
    curve
        .windows(3)
        .filter(|w| w[1].1 > w[0].1 && w[1].1 >= w[2].1)
        .map(|w| [w[0], w[1], w[2]])
        .collect()
}

/// The brackets of every maximum inside a bracket. One that is wide is sampled anew, with losses of one resolution.
///
/// # Errors
/// Those of `losses`.
pub fn brackets_within<E>(
    bracket: &[Point; 3],
    losses: &Losses<'_, E>,
) -> Result<Vec<[Point; 3]>, E> {
    let decades = bracket.map(|(omega, _)| omega.log10());
    if decades[2] - decades[0] <= WIDEST {
        return Ok(vec![*bracket]);
    }
    let [first, middle, last] = bracket.map(|(omega, _)| omega);
    let mut omegas = logarithmic(first, middle, PER_DECADE, usize::MAX);
    omegas.pop();
    omegas.extend(logarithmic(middle, last, PER_DECADE, usize::MAX));
    let computed = losses(&omegas)?;
    let points = omegas.into_iter().zip(computed);
    let curve: Vec<Point> = points.map(|(omega, (loss, _))| (omega, loss)).collect();
    Ok(brackets(&curve))
}

/// Locates the maximum inside a bracket.
///
/// # Errors
/// Those of `losses`, and [`PeakError`] where the iteration does not settle; no value is then returned.
pub fn refine<E: From<PeakError>>(bracket: &[Point; 3], losses: &Losses<'_, E>) -> Result<Peak, E> {
    let logarithms = bracket.map(|(omega, _)| omega.ln());
    let (lower, upper) = (logarithms[0], logarithms[2]);
    let mut centre =
        vertex(&logarithms, &bracket.map(|(_, loss)| loss)).map_or(logarithms[1], |v| v.0);
    let mut half_width = HALF_WIDTH.min(0.5 * (upper - lower));
    for _ in 0..ROUNDS {
        centre = centre.clamp(lower, upper);
        let abscissae: Vec<f64> = (0..STENCIL)
            .map(|i| centre + half_width * (2.0 * i as f64 / (STENCIL - 1) as f64 - 1.0))
            .collect();
        let omegas: Vec<f64> = abscissae.iter().map(|x| x.exp()).collect();
        let computed = losses(&omegas)?;
        let values: Vec<f64> = computed.iter().map(|(loss, _)| *loss).collect();
        let Some((next, loss)) = vertex(&abscissae, &values) else {
            // No maximum inside the stencil: move to its best point and look again.
            let best = (0..STENCIL).max_by(|&a, &b| values[a].total_cmp(&values[b]));
            centre = best.map_or(centre, |i| abscissae[i]);
            continue;
        };
        let moved = (next - centre).abs();
        centre = next;
        if moved < 0.5 * RELATIVE_ACCURACY {
            let omega = next.exp();
            let (shift, error) = shift_and_error(&abscissae, &computed, next);
            // Of losses without errors no more is known than what is asked for, however little the last round moved.
            let moved = match error {
                Some(_) => moved,
                None => 0.5 * RELATIVE_ACCURACY,
            };
            return Ok(Peak {
                angular_frequency_rad_per_s: omega,
                energy_loss_j: loss,
                angular_frequency_uncertainty_rad_per_s: omega * (moved + shift),
                energy_loss_error_j: error,
                ..Peak::default()
            });
        }
        half_width = (0.5 * half_width).max(0.1);
    }
    Err(E::from(PeakError::NotSettled {
        angular_frequency_rad_per_s: centre.exp(),
    }))
}

/// By how much the errors move a vertex found at `at`, and the error of the loss there. Errors of one discretisation vary
/// slowly over frequency: it is their slope that moves the vertex, up or down.
fn shift_and_error(abscissae: &[f64], computed: &[Loss], at: f64) -> (f64, Option<f64>) {
    let Some(errors) = computed
        .iter()
        .map(|(_, e)| *e)
        .collect::<Option<Vec<f64>>>()
    else {
        return (0.0, None);
    };
    let largest = errors.iter().copied().fold(0.0, f64::max);
    let shifted = |sign: f64| {
        let values = computed.iter().zip(&errors);
        let values: Vec<f64> = values.map(|((loss, _), e)| loss + sign * e).collect();
        vertex(abscissae, &values).map_or(0.0, |(x, _)| (x - at).abs())
    };
    (shifted(1.0).max(shifted(-1.0)), Some(largest))
}

/// Maximum (position, value) of the polynomial through the points, where it lies between the outer ones.
pub fn vertex(abscissae: &[f64], values: &[f64]) -> Option<Point> {
    let (first, last) = (abscissae.first()?, abscissae.last()?);
    let centre = 0.5 * (first + last);
    let half = 0.5 * (last - first);
    let scale = values.iter().fold(0.0_f64, |s, v| s.max(v.abs()));
    let count = abscissae.len();
    let powers = DMatrix::from_fn(count, count, |row, column| {
        ((abscissae[row] - centre) / half).powi(column as i32)
    });
    let right = DVector::from_iterator(count, values.iter().map(|v| v / scale));
    let coefficients = powers.lu().solve(&right)?;
    let derivative = |x: f64, order: usize| -> f64 {
        (order..count)
            .map(|k| {
                let factor: f64 = (0..order).map(|j| (k - j) as f64).product();
                coefficients[k] * factor * x.powi((k - order) as i32)
            })
            .sum()
    };
    let mut x = (0..=64)
        .map(|i| f64::from(i) / 32.0 - 1.0)
        .max_by(|a, b| derivative(*a, 0).total_cmp(&derivative(*b, 0)))?;
    for _ in 0..20 {
        let curvature = derivative(x, 2);
        if curvature >= 0.0 {
            return None;
        }
        x -= derivative(x, 1) / curvature;
    }
    (x.abs() < 1.0).then(|| (centre + half * x, derivative(x, 0) * scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A relaxation peak with a shoulder.
    fn loss(omega: f64) -> f64 {
        let debye = |x: f64| x / (1.0 + x * x);
        debye(omega / 0.01) + 0.2 * debye(omega / 0.2)
    }

    fn sampled(from: f64, ratio: f64, points: usize) -> Vec<Point> {
        (0..points)
            .map(|i| from * ratio.powi(i as i32))
            .map(|omega| (omega, loss(omega)))
            .collect()
    }

    #[test]
    fn a_peak_is_found_to_the_accuracy_stated_wherever_the_samples_fall() {
        // The maximum of the curve, by bisection of its derivative.
        let slope = |omega: f64| {
            let d = |x: f64| (1.0 - x * x) / (1.0 + x * x).powi(2);
            d(omega / 0.01) / 0.01 + 0.2 * d(omega / 0.2) / 0.2
        };
        let (mut low, mut high) = (0.005, 0.05);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if slope(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        for start in [1.0e-4, 1.1e-4, 1.3e-4, 1.45e-4] {
            for ratio in [1.2, 10f64.powf(0.1), 2.0, 4.0] {
                let brackets = brackets(&sampled(start, ratio, 60));
                assert_eq!(brackets.len(), 1);
                let exact = |omegas: &[f64]| Ok(omegas.iter().map(|&o| (loss(o), None)).collect());
                let peak = refine::<PeakError>(&brackets[0], &exact).unwrap();
                let relative = peak.angular_frequency_rad_per_s / low - 1.0;
                assert!(relative.abs() < RELATIVE_ACCURACY, "{relative}");
                assert!((peak.energy_loss_j / loss(low) - 1.0).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn every_hump_of_a_wide_bracket_is_bracketed_and_a_narrow_one_stays_as_it_is() {
        // Four relaxations of which the bracket shows one hump.
        let loss = |omega: f64| {
            let debye = |x: f64| x / (1.0 + x * x);
            let humps = [(1e-4, 0.5), (3e-2, 1.0), (2.0, 0.9), (1e3, 0.2)];
            humps
                .iter()
                .map(|(at, height)| height * debye(omega / at))
                .sum::<f64>()
        };
        let losses = |omegas: &[f64]| -> Result<Vec<Loss>, PeakError> {
            Ok(omegas.iter().map(|&omega| (loss(omega), None)).collect())
        };
        let wide = [1e-6, 1.0, 1e5].map(|omega| (omega, loss(omega)));
        let found = brackets_within(&wide, &losses).unwrap();
        let mut peaks: Vec<Peak> = (found.iter())
            .map(|bracket| refine(bracket, &losses).unwrap())
            .collect();
        assert_eq!(peaks.len(), 4);
        peaks.sort_by(|a, b| b.energy_loss_j.total_cmp(&a.energy_loss_j));
        assert!((peaks[0].angular_frequency_rad_per_s / 3e-2 - 1.0).abs() < 0.1);
        let narrow = [0.01, 0.03, 0.09].map(|omega| (omega, loss(omega)));
        assert_eq!(brackets_within(&narrow, &losses).unwrap(), vec![narrow]);
    }

    #[test]
    fn noise_of_a_millionth_in_the_losses_does_not_move_the_peak_beyond_the_accuracy() {
        let clean = |omegas: &[f64]| Ok(omegas.iter().map(|&o| (loss(o), None)).collect());
        let noisy = |omegas: &[f64]| {
            let jitter = |o: f64| 1.0 + 1e-6 * (1e9 * o).sin();
            Ok(omegas
                .iter()
                .map(|&o| (loss(o) * jitter(o), None))
                .collect())
        };
        let bracket = brackets(&sampled(1e-4, 10f64.powf(0.1), 41))[0];
        let (a, b) = (
            refine::<PeakError>(&bracket, &clean).unwrap(),
            refine::<PeakError>(&bracket, &noisy).unwrap(),
        );
        let moved = a.angular_frequency_rad_per_s - b.angular_frequency_rad_per_s;
        assert!(moved.abs() < RELATIVE_ACCURACY * a.angular_frequency_rad_per_s);
        assert!(moved.abs() < b.angular_frequency_uncertainty_rad_per_s);
    }

    #[test]
    fn errors_of_the_losses_become_an_uncertainty_of_the_peak() {
        // A true curve that lies above the computed one by a part that grows with frequency.
        let part = |omega: f64| 1e-3 * (omega / 0.01).sqrt();
        let computed = |omegas: &[f64]| {
            let point = |&o: &f64| (loss(o), Some(part(o) * loss(o)));
            Ok(omegas.iter().map(point).collect())
        };
        let truth = |omegas: &[f64]| {
            let point = |&o: &f64| (loss(o) * (1.0 + part(o)), None);
            Ok(omegas.iter().map(point).collect())
        };
        let bracket = brackets(&sampled(1e-4, 10f64.powf(0.1), 41))[0];
        let found = refine::<PeakError>(&bracket, &computed).unwrap();
        let exact = refine::<PeakError>(&bracket, &truth).unwrap();
        let away = (found.angular_frequency_rad_per_s - exact.angular_frequency_rad_per_s).abs();
        assert!(away > 0.0 && away <= found.angular_frequency_uncertainty_rad_per_s);
        let error_j = found.energy_loss_error_j.unwrap();
        assert!((found.energy_loss_j - exact.energy_loss_j).abs() <= error_j);
        assert_eq!(exact.energy_loss_error_j, None);
    }

    #[test]
    fn a_rising_curve_has_no_peak_and_a_failing_case_gives_none() {
        let rising: Vec<Point> = (1..20).map(|i| (f64::from(i), f64::from(i))).collect();
        assert!(brackets(&rising).is_empty());
        let bracket = brackets(&sampled(1e-4, 2.0, 20))[0];
        let failing = |omegas: &[f64]| {
            Err(PeakError::Case {
                angular_frequency_rad_per_s: omegas[0],
                reason: "no".into(),
            })
        };
        assert!(refine(&bracket, &failing).is_err());
    }
}
