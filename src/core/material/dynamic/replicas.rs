//! Replicas of a fitted series: what the noise of the data leaves open, as materials drawn at random, and the band they make.
//!
//! A parametric bootstrap (B. Efron and R. J. Tibshirani, *An Introduction to the Bootstrap*, Chapman and Hall 1993, section 6.5):
//! the best spectrum of any number of branches is measured again at the frequencies and temperatures of the data, with their noise;
//! the isotherms are shifted again, and a series is fitted again. The noise is what the best spectrum leaves of the data, or the
//! errors of the file where these are larger. The spectrum has as much structure as the data allow, and the series of few branches
//! has lost it again. Where isotherms lie beside the curve as a whole, by more than the noise of their points explains (the material
//! is not thermorheologically simple, or its temperature or clamping is not what it should be), their levels and tilts are drawn
//! again as well. The times of a replica lie on a grid of their own, so that what a series of few branches smooths away shows as a
//! difference.

use rayon::prelude::*;

use super::master_curve::{self, MasterCurve};
use super::prony::{self, PronyFit};
use super::{Choices, DynamicData, DynamicError, DynamicPoint, Isotherm, master_points};
use crate::material::Relaxation;
use crate::numerics::random::Noise;

/// Standard deviations of the error of a single value, which the truth is within in 95 % of cases.
pub const POINTWISE_DEVIATIONS: f64 = 2.0;

/// Standard deviations of a band, which the truth is within at all frequencies at once. At ten to twenty frequencies that err on their own, about as many as a master curve has decades,
/// the whole curve lies within three of them in 95 % of cases. A quarter more is for structure of the spectrum that the data do not
/// resolve, and that is in no replica: of 200 seeded synthetic solids (3 to 30 branches, 8 to 20 isotherms, 0.5 to 3 % of noise) the
/// whole loss curve of 84 % lay within three, of 97 % within 3.5, of 98.5 % within these, which were 2.8 times the noise on average.
pub const SIMULTANEOUS_DEVIATIONS: f64 = 3.75;

/// Fewest replicas that a band is made of.
const FEWEST: usize = 2;

/// A material that the data allow as well.
#[derive(Debug, Clone, PartialEq)]
pub struct Replica {
    /// The series at the reference temperature.
    pub relaxation: Relaxation,
    /// The shift factors that belong to it, where there are any.
    pub master: Option<MasterCurve>,
}

/// The error (95 %) of a value of the material itself, from the values of its replicas: twice the root mean square of their
/// differences, which contains what the fit smooths away beside what the noise leaves open. Pointwise: of one number on its own, a loss
/// at a frequency or a peak. `None` where there are fewer than two replicas, or one of them has no value.
pub fn error(value: f64, replicas: &[f64]) -> Option<f64> {
    half_width(POINTWISE_DEVIATIONS, value, replicas)
}

/// Half width of the simultaneous band (95 %) about a curve at one of its points: the same with 3.75 in place of two, so that the truth
/// lies within it at all frequencies at once.
pub fn band(value: f64, replicas: &[f64]) -> Option<f64> {
    half_width(SIMULTANEOUS_DEVIATIONS, value, replicas)
}

fn half_width(deviations: f64, value: f64, replicas: &[f64]) -> Option<f64> {
    if replicas.len() < FEWEST {
        return None;
    }
    let squares: f64 = replicas.iter().map(|other| (other - value).powi(2)).sum();
    let half_width = deviations * (squares / replicas.len() as f64).sqrt();
    half_width.is_finite().then_some(half_width)
}

/// Draws the replicas asked for; the same seed gives the same ones, whatever number of threads there is. One whose noise leaves
/// no master curve or no series is left out.
///
/// # Errors
/// [`DynamicError`] of the first, where none of them is left.
pub fn draw(
    data: &DynamicData,
    master: Option<&MasterCurve>,
    fit: &PronyFit,
    choices: &Choices,
) -> Result<Vec<Replica>, DynamicError> {
    let spectrum = prony::spectrum(&master_points(data, master), fit)?;
    let model = Model::new(data, master, fit, &spectrum);
    let replica = |number: usize| {
        let mut random = Noise::stream(choices.seed, number as u64);
        let measured = model.measured_again(data, &mut random)?;
        let master = match master {
            Some(master) => Some(master_curve::refined_from(&measured, master, choices)?),
            None => None,
        };
        let points = master_points(&measured, master.as_ref());
        let relaxation = prony::refitted(&points, fit, random.uniform())?;
        Ok(Replica { relaxation, master })
    };
    let drawn: Vec<Result<Replica, DynamicError>> =
        (0..choices.replicas).into_par_iter().map(replica).collect();
    let (drawn, failed): (Vec<_>, Vec<_>) = drawn.into_iter().partition(Result::is_ok);
    match failed.into_iter().next() {
        Some(Err(error)) if drawn.is_empty() => Err(error),
        _ => drawn.into_iter().collect(),
    }
}

/// The spectrum at every point of the data, and how far a measurement is from it.
struct Model {
    isotherms: Vec<[Modelled; 2]>,
    /// Of storage and loss modulus.
    common: [Common; 2],
}

/// A modulus of an isotherm.
struct Modelled {
    /// Values of the spectrum (Pa), and the relative noise of each.
    values: Vec<(f64, f64)>,
    residuals: Residuals,
}

/// Level and tilt that an isotherm has beside the spectrum, each with the variance that the noise of its points gives it.
type Residuals = [(f64, f64); 2];

/// Level and tilt that all points of an isotherm have in common beyond their noise (relative standard deviations): nothing where the
/// data lie on one curve.
type Common = [f64; 2];

/// Place of a point in its isotherm: -1 to 1.
fn place(index: usize, count: usize) -> f64 {
    match count {
        0 | 1 => 0.0,
        _ => 2.0 * index as f64 / (count - 1) as f64 - 1.0,
    }
}

impl Model {
    fn new(
        data: &DynamicData,
        master: Option<&MasterCurve>,
        fit: &PronyFit,
        spectrum: &Relaxation,
    ) -> Self {
        let shift = |index: usize| match master.and_then(|master| master.shifts.get(index)) {
            Some(shift) => (10_f64.powf(shift.log10_a_t), shift.b_t),
            None => (1.0, 1.0),
        };
        let errors_known = prony::errors_known(data.points());
        let isotherms = data.isotherms().iter().enumerate();
        let isotherms: Vec<[Modelled; 2]> = isotherms
            .map(|(index, isotherm)| {
                let noise = (fit.noise, errors_known);
                modelled(isotherm, shift(index), spectrum, noise)
            })
            .collect();
        let common = [0, 1].map(|part| common(isotherms.iter().map(|both| both[part].residuals)));
        Self { isotherms, common }
    }

    /// The same measurement with other noise.
    fn measured_again(
        &self,
        data: &DynamicData,
        random: &mut Noise,
    ) -> Result<DynamicData, DynamicError> {
        let mut sets = Vec::with_capacity(self.isotherms.len());
        for (isotherm, both) in data.isotherms().iter().zip(&self.isotherms) {
            let [storage, loss] =
                [0, 1].map(|part| both[part].measured_again(self.common[part], random));
            let moduli = storage.into_iter().zip(loss);
            let points = isotherm.points.iter().zip(moduli);
            let point =
                |(point, (storage_modulus_pa, loss_modulus_pa)): (&DynamicPoint, _)| DynamicPoint {
                    storage_modulus_pa,
                    loss_modulus_pa,
                    ..*point
                };
            sets.push(points.map(point).collect());
        }
        Ok(DynamicData::new(data.kind(), sets)?)
    }
}

/// Storage and loss modulus of the spectrum at the points of an isotherm.
fn modelled(
    isotherm: &Isotherm,
    (a_t, b_t): (f64, f64),
    spectrum: &Relaxation,
    (noise, errors_known): ((f64, f64), bool),
) -> [Modelled; 2] {
    [0, 1].map(|part| {
        let noise = <[f64; 2]>::from(noise)[part];
        let points = isotherm.points.iter();
        let measured = points.map(|p| [p.storage_modulus_pa, p.loss_modulus_pa][part]);
        let measured: Vec<f64> = measured.collect();
        let points = isotherm.points.iter().zip(&measured);
        let values = points.map(|(point, value)| {
            let errors = point.errors_pa.filter(|_| errors_known);
            let relative = errors.map_or(noise, |errors| {
                noise.max(1.0) * <[f64; 2]>::from(errors)[part] / value
            });
            let modulus = spectrum.complex_modulus(a_t * point.angular_frequency_rad_per_s);
            ([modulus.re, modulus.im][part] / b_t, relative)
        });
        let values: Vec<(f64, f64)> = values.collect();
        let residuals = residuals(&values, &measured);
        Modelled { values, residuals }
    })
}

/// Least squares of level and tilt, which are orthogonal for points at even places.
fn residuals(values: &[(f64, f64)], measured: &[f64]) -> Residuals {
    let count = values.len();
    let (mut level, mut tilt, mut places) = ((0.0, 0.0), (0.0, 0.0), 0.0);
    for (index, ((value, noise), measured)) in values.iter().zip(measured).enumerate() {
        let (residual, place) = ((measured / value).ln(), place(index, count));
        level.0 += residual / count as f64;
        tilt.0 += residual * place;
        places += place * place;
        level.1 += (noise / count as f64).powi(2);
        tilt.1 += (noise * place).powi(2);
    }
    if places > 0.0 {
        tilt = (tilt.0 / places, tilt.1 / (places * places));
    }
    [level, tilt]
}

/// What the mean squares have beyond those that the noise explains.
fn common(residuals: impl Iterator<Item = Residuals> + Clone) -> Common {
    let count = residuals.clone().count().max(1) as f64;
    [0, 1].map(|which| {
        let excess = residuals.clone().map(|residuals| {
            let (value, variance) = residuals[which];
            value * value - variance
        });
        (excess.sum::<f64>() / count).max(0.0).sqrt()
    })
}

impl Modelled {
    /// Other moduli (Pa) of this model. Logarithmic, so that none of them is negative.
    fn measured_again(&self, common: Common, random: &mut Noise) -> Vec<f64> {
        let [level, tilt] = common.map(|common| common * random.normal());
        let count = self.values.len();
        let values = self.values.iter().enumerate();
        values
            .map(|(index, (value, noise))| {
                let common = level + tilt * place(index, count);
                value * (common + noise * random.normal()).exp()
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::dynamic::characterise;
    use crate::material::dynamic::synthetic::{measurement, noise_of};
    use num_complex::Complex;

    fn from_environment(name: &str, default: u64) -> u64 {
        let asked = std::env::var(name).ok();
        asked.map_or(default, |text| text.parse().unwrap())
    }

    /// Loss compliance, to which the energy loss of a sphere is proportional at a small amplitude.
    fn loss_compliance(relaxation: &Relaxation, omega: f64) -> f64 {
        let modulus: Complex<f64> = relaxation.complex_modulus(omega);
        modulus.im / modulus.norm_sqr()
    }

    /// `REPLICA_CASES=200 REPLICA_SEED=1 cargo test --lib replicas -- --nocapture` tries and prints as many as asked for.
    #[test]
    fn the_loss_curve_of_random_solids_lies_in_its_band() {
        let (cases, first) = (
            from_environment("REPLICA_CASES", 4),
            from_environment("REPLICA_SEED", 0),
        );
        let (mut inside, mut points_inside, mut points) = (0, 0, 0);
        for seed in first..first + cases {
            let made = measurement(seed, noise_of(seed));
            let choices = Choices {
                reference_temperature_k: Some(made.law.reference_temperature_k),
                replicas: 50,
                seed,
                ..Choices::default()
            };
            let start = std::time::Instant::now();
            let alone = characterise(
                &made.data,
                &Choices {
                    replicas: 0,
                    ..choices.clone()
                },
            )
            .unwrap();
            let first_s = start.elapsed().as_secs_f64();
            let found = characterise(&made.data, &choices).unwrap();
            let seconds = start.elapsed().as_secs_f64() - 2.0 * first_s;
            assert_eq!(alone.fit, found.fit);
            let (lowest, highest) = found.fit.window_rad_per_s;
            let mut worst = (0.0_f64, 0.0);
            let mut widths = 0.0;
            for step in 0..=40 {
                let omega = lowest * (highest / lowest).powf(f64::from(step) / 40.0);
                let value = loss_compliance(&found.fit.relaxation, omega);
                let replicas = found.replicas.iter();
                let others: Vec<f64> = replicas
                    .map(|replica| loss_compliance(&replica.relaxation, omega))
                    .collect();
                let half_width = band(value, &others).unwrap();
                let ratio = (loss_compliance(&made.truth, omega) - value).abs() / half_width;
                widths += half_width / value / 41.0;
                if ratio > worst.0 {
                    worst = (ratio, f64::from(step) / 40.0);
                }
                points += 1;
                let pointwise = error(value, &others).unwrap() / half_width;
                points_inside += u32::from(ratio <= pointwise);
            }
            inside += u32::from(worst.0 <= 1.0);
            println!(
                "{seed}: noise {:.3} {:.2} {:.2}; {} isotherms; branches {} of {}; {} replicas; worst {:.2} at {:.2}; band {:.1} noise; fit {first_s:.2} s, replicas {seconds:.2} s",
                made.noise,
                found.fit.noise.0 / made.noise,
                found.fit.noise.1 / made.noise,
                made.data.isotherms().len(),
                found.fit.relaxation.branches().len(),
                made.truth.branches().len(),
                found.replicas.len(),
                worst.0,
                worst.1,
                widths / made.noise
            );
        }
        println!(
            "{inside} of {cases} curves in their bands, {points_inside} of {points} points within their errors"
        );
        assert!(f64::from(inside) >= 0.95 * cases as f64);
        // Points of a curve are much alike, and four curves are few.
        assert!(f64::from(points_inside) >= 0.85 * f64::from(points));
    }

    #[test]
    fn a_seed_gives_the_same_replicas_on_any_number_of_threads() {
        let made = measurement(2, 0.01);
        let drawn = |threads: usize, seed: u64| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let choices = Choices {
                replicas: 4,
                seed,
                ..Choices::default()
            };
            let found = pool
                .build()
                .unwrap()
                .install(|| characterise(&made.data, &choices));
            found.unwrap()
        };
        let one = drawn(1, 7);
        assert_eq!(one, drawn(3, 7));
        assert_ne!(one.replicas, drawn(1, 8).replicas);
        // Fewer of them are the first of more.
        assert_eq!(one.replicas.len(), 4);
        let at = |found: &crate::material::dynamic::Characterisation| {
            let temperature_k = found.temperature_k.map(|own| own + 3.0);
            let own = found.material(temperature_k, 0.4).unwrap();
            (own, found.replica_materials(temperature_k, 0.4).unwrap())
        };
        let (own, others) = at(&one);
        assert_eq!(others.len(), 4);
        let a_t = 10_f64.powf(
            one.master
                .as_ref()
                .unwrap()
                .log10_a_t(one.temperature_k.unwrap() + 3.0)
                .unwrap(),
        );
        let (lowest, highest) = one.fit.window_rad_per_s;
        assert_eq!(
            own.origin.measured_window_s,
            Some((a_t / highest, a_t / lowest))
        );
        let omega = 2.0;
        let (shifted, own) = (
            own.longitudinal_complex_modulus(omega),
            one.fit.relaxation.complex_modulus(a_t * omega),
        );
        assert!((shifted / own - 1.0).norm() < 1e-12);
    }

    #[test]
    fn a_temperature_that_the_data_do_not_know_is_refused() {
        let made = measurement(1, 0.01);
        let one = made.data.isotherms()[0].points.clone();
        let data = DynamicData::new(made.data.kind(), vec![one.clone()]).unwrap();
        let found = characterise(&data, &Choices::default()).unwrap();
        let own = one[0].temperature_k;
        assert_eq!(found.temperature_k, own);
        assert!(found.material(own, 0.3).is_ok() && found.material(None, 0.3).is_ok());
        let error = found
            .material(own.map(|t| t + 5.0), 0.3)
            .unwrap_err()
            .to_string();
        assert!(error.contains("alone"), "{error}");
    }

    #[test]
    fn a_band_needs_two_values_that_are_numbers() {
        assert_eq!(band(1.0, &[2.0]), None);
        assert_eq!(band(1.0, &[2.0, f64::NAN]), None);
        assert_eq!(band(1.0, &[2.0, 0.0]), Some(SIMULTANEOUS_DEVIATIONS));
        assert_eq!(error(1.0, &[2.0, 0.0]), Some(POINTWISE_DEVIATIONS));
    }

    #[test]
    fn what_isotherms_have_in_common_is_found_where_there_is_something() {
        let made = measurement(4, 0.01);
        let given = made.data.isotherms().iter().map(|isotherm| {
            let temperature_k = isotherm.temperature_k.unwrap();
            (temperature_k, made.law.log10_a_t(temperature_k).unwrap())
        });
        let choices = Choices {
            shift: master_curve::ShiftChoice::Given(given.collect()),
            ..Choices::default()
        };
        let common = |deviation: f64| {
            let mut random = Noise(3);
            let sets = made.data.isotherms().iter().map(|isotherm| {
                let factor = (deviation * random.normal()).exp();
                let scaled = |point: &DynamicPoint| DynamicPoint {
                    storage_modulus_pa: factor * point.storage_modulus_pa,
                    loss_modulus_pa: factor * point.loss_modulus_pa,
                    ..*point
                };
                isotherm.points.iter().map(scaled).collect()
            });
            let data = DynamicData::new(made.data.kind(), sets.collect()).unwrap();
            let found = characterise(&data, &choices).unwrap();
            let points = master_points(&data, found.master.as_ref());
            let spectrum = prony::spectrum(&points, &found.fit).unwrap();
            Model::new(&data, found.master.as_ref(), &found.fit, &spectrum).common
        };
        // The mean of ten points with 1 % of noise is off by 0.3 %; of levels 10 % apart, the spectrum follows some.
        assert!(
            common(0.0).iter().all(|c| c[0] < 0.004),
            "{:?}",
            common(0.0)
        );
        let common = common(0.1);
        assert!(common.iter().any(|c| c[0] > 0.03), "{common:?}");
        assert!(common.iter().all(|c| c[0] < 0.2), "{common:?}");
    }
}
