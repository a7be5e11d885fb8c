//! A Prony series through storage and loss modulus, no modulus negative.
//!
//! `E' = g_inf + sum g_i x_i^2/(1 + x_i^2)` and `E'' = sum g_i x_i/(1 + x_i^2)` with `x_i = omega tau_i` are fitted together, each
//! point relative to its size, or to its errors where the file gives them. First by non-negative least squares on ten times per
//! decade, a little wider than `1/omega` of the data (M. Baumgaertel and H. H. Winter, Rheologica Acta 28 (1989) 511): what this
//! leaves is the noise, of both moduli on its own. Then neighbours are merged, times and moduli refined together, and branches
//! taken away as long as the criterion of Akaike with the correction for few data falls.
//!
//! # Solid or fluid
//!
//! The equilibrium modulus is fitted with the rest. Where it comes out as nothing, the material is a fluid only if the data
//! resolve that: the loss modulus is above the storage modulus at the lowest frequency, and [`LEFT`] of the storage modulus
//! there, held as an equilibrium modulus, makes chi squared worse by more than [`ALLOWED`], with no time longer than
//! `1/omega`. Otherwise it is a solid, of half the largest equilibrium modulus that the data allow.
//!
//! # Consistency after Kramers and Kronig
//!
//! Storage and loss modulus of a passive material are given by one non-negative spectrum. Spectra over the band and two
//! decades more at both ends are fitted to the storage modulus alone and to the loss modulus alone; what they leave, with the
//! degrees of freedom they take counted, is the noise of both. The number is what a spectrum fitted to both leaves (root mean
//! square per degree of freedom), in units of this noise: about one for consistent data, whatever their noise.

mod rows;

use super::DynamicPoint;
use crate::material::spectrum::{Branch, Search, Series};
use crate::material::{MaterialError, Relaxation, RelaxationBranch};
use crate::numerics::nnls::NnlsError;
pub(super) use rows::errors_known;
use rows::{Part, Rows, SPECTRUM};

/// By how much chi squared may be higher for a series that fits about as well (two standard deviations).
pub const ALLOWED: f64 = 4.0;

/// Share of the storage modulus at the lowest frequency that is an equilibrium modulus worth having.
pub const LEFT: f64 = 0.2;

/// Share of it below which an equilibrium modulus counts as none.
const NOTHING: f64 = 1e-3;

/// Factor by which branch times lie beyond one over the angular frequencies of the data: the loss of a branch falls to a third
/// there. What lies farther out shows as a constant, or not at all.
const BEYOND: f64 = 3.0;

/// The same for the consistency after Kramers and Kronig, where anything passive may be; and times per decade there.
const FAR_BEYOND: f64 = 100.0;
const COARSE: f64 = 5.0;

/// Degrees of freedom below which the noise of one modulus alone is not known.
const FEWEST_FREE: usize = 3;

/// Halvings of the logarithm of a ratio of 1/[`NOTHING`].
const HALVINGS: usize = 8;

/// A series fitted to dynamic data at one temperature, or on a master curve.
#[derive(Debug, Clone, PartialEq)]
pub struct PronyFit {
    pub relaxation: Relaxation,
    /// Relative residuals of storage and loss modulus (fit / data - 1), point by point.
    pub residuals: Vec<(f64, f64)>,
    /// Their root mean squares.
    pub storage_rms: f64,
    pub loss_rms: f64,
    /// Relative standard deviations of the noise of storage and loss modulus: what the best non-negative spectrum leaves. Where
    /// the file gives errors, how many times larger than these it is.
    pub noise: (f64, f64),
    /// Lowest and highest angular frequency of the data: outside, the series is an extrapolation.
    pub window_rad_per_s: (f64, f64),
    /// Misfit of the best passive material to storage and loss modulus together, in units of what it leaves of each alone:
    /// consistency after Kramers and Kronig; about one for consistent data. `None` where there are too few points to say.
    pub kramers_kronig: Option<f64>,
}

impl PronyFit {
    /// Standard deviations (Pa) of both moduli of a point: a multiple of its errors where it has some, otherwise a part of the moduli, of which
    /// less than `least` is not believed.
    pub(crate) fn deviations_pa(&self, point: &DynamicPoint, least: f64) -> [f64; 2] {
        let noise = [self.noise.0, self.noise.1];
        let sizes = match point.errors_pa {
            Some((storage, loss)) => return [noise[0] * storage, noise[1] * loss],
            None => [point.storage_modulus_pa, point.loss_modulus_pa],
        };
        [0, 1].map(|part| noise[part].max(least) * sizes[part])
    }
}

/// Why no series was fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PronyError {
    #[error(transparent)]
    LeastSquares(#[from] NnlsError),
    #[error(transparent)]
    Material(#[from] MaterialError),
}

/// Fits a series with at most this number of branches, or as many as the data resolve.
///
/// # Errors
/// [`PronyError`].
pub fn fit(points: &[DynamicPoint], branches: Option<usize>) -> Result<PronyFit, PronyError> {
    let (rows, spectrum) = weighed(points)?;
    let spectrum = rest(&rows, spectrum)?;
    let limits_s = limits(&rows, BEYOND);
    let linear = rows.linear(spectrum.constant > 0.0);
    let score = |series: &Series| corrected_akaike(&rows, series);
    let search = Search {
        linear: &linear,
        limits_s,
        score: &score,
        slack: 0.0,
        frees_constant: false,
    };
    let merged = spectrum.runs_merged(SPECTRUM);
    let series = match branches {
        None => search.closely(&search.fewest(&merged)?)?,
        Some(branches) => {
            let solid = spectrum.constant > 0.0;
            let constant = if solid { rows.lowest()[0] } else { 0.0 };
            let even = search.closely(&rows.guess(branches, limits_s, constant))?;
            let reduced = search.at_most(&merged, branches)?;
            match linear.squares(&even) < linear.squares(&reduced) {
                true => even,
                false => reduced,
            }
        }
    };
    let relaxation = rows.relaxation(&series)?;
    let residuals = residuals(points, &relaxation);
    let rms = |part: fn(&(f64, f64)) -> f64| {
        let squares: f64 = residuals.iter().map(|both| part(both).powi(2)).sum();
        (squares / residuals.len() as f64).sqrt()
    };
    Ok(PronyFit {
        storage_rms: rms(|both| both.0),
        loss_rms: rms(|both| both.1),
        residuals,
        relaxation,
        noise: rows.noise.into(),
        window_rad_per_s: rows.window(),
        kramers_kronig: kramers_kronig(points)?,
    })
}

/// The criterion of H. Akaike with the correction for few data (C. M. Hurvich and C.-L. Tsai, Biometrika 76 (1989) 297),
/// the noise being known: lower is better.
fn corrected_akaike(rows: &Rows, series: &Series) -> f64 {
    let (count, parameters) = (rows.count() as f64, series.parameters() as f64);
    let free = count - parameters - 1.0;
    if free <= 0.0 {
        return f64::INFINITY;
    }
    rows.chi_squared(series) + 2.0 * parameters * (1.0 + (parameters + 1.0) / free)
}

/// The best spectrum of any number of branches on five times per decade, which lie this share of a step beyond those of the limits:
/// quickly, with the noise of a fit to points that are much alike, and a solid if that is one.
pub(super) fn refitted(
    points: &[DynamicPoint],
    like: &PronyFit,
    offset: f64,
) -> Result<Relaxation, PronyError> {
    let rows = Rows::like(points, like);
    let (shortest, longest) = limits(&rows, BEYOND);
    let step = 10_f64.powf(offset / COARSE);
    let limits_s = (shortest * step, longest * step);
    let series = spectrum_like(&rows, like, limits_s, COARSE)?;
    Ok(rows.relaxation(&series)?)
}

/// The best spectrum of any number of branches through the points of a fit, with its noise; a solid if that is one.
pub(super) fn spectrum(points: &[DynamicPoint], fit: &PronyFit) -> Result<Relaxation, PronyError> {
    let rows = Rows::like(points, fit);
    let series = spectrum_like(&rows, fit, limits(&rows, BEYOND), SPECTRUM)?;
    Ok(rows.relaxation(&series)?)
}

fn spectrum_like(
    rows: &Rows,
    fit: &PronyFit,
    (shortest, longest): (f64, f64),
    per_decade: f64,
) -> Result<Series, NnlsError> {
    if fit.relaxation.is_fluid() {
        let (slowest, _) = rows.window();
        let times = Rows::grid((shortest, 1.0 / slowest), per_decade);
        return rows.strengths(&times, (false, 0.0));
    }
    let times = Rows::grid((shortest, longest), per_decade);
    let solid = rows.strengths(&times, (true, 0.0))?;
    let storage = rows.lowest()[0];
    match solid.constant > NOTHING * storage {
        true => Ok(solid),
        false => held_solid(rows, storage),
    }
}

/// Rows in units of the noise, and the best spectrum.
pub(super) fn weighed(points: &[DynamicPoint]) -> Result<(Rows, Series), NnlsError> {
    let mut rows = Rows::new(points);
    let times = Rows::grid(limits(&rows, BEYOND), SPECTRUM);
    let mut spectrum = rows.strengths(&times, (true, 0.0))?;
    for _ in 0..2 {
        rows = rows.with_noise_from(&spectrum);
        spectrum = rows.strengths(&times, (true, 0.0))?;
    }
    Ok((rows, spectrum))
}

/// Shortest and longest branch time (s), this factor beyond the band.
fn limits(rows: &Rows, beyond: f64) -> (f64, f64) {
    let (lowest, highest) = rows.window();
    (1.0 / (beyond * highest), beyond / lowest)
}

/// The spectrum of a solid, or of a fluid where the data resolve one.
fn rest(rows: &Rows, spectrum: Series) -> Result<Series, NnlsError> {
    let [storage, loss] = rows.lowest();
    if spectrum.constant > NOTHING * storage || rows.omegas.is_empty() {
        return Ok(spectrum);
    }
    let times = Rows::grid((limits(rows, BEYOND).0, 1.0 / rows.window().0), SPECTRUM);
    let with = |held: f64| rows.strengths(&times, (false, held));
    let fluid = with(0.0)?;
    let allowed = rows.chi_squared(&fluid) + ALLOWED;
    if loss > storage && rows.chi_squared(&with(LEFT * storage)?) > allowed {
        return Ok(fluid);
    }
    held_solid(rows, storage)
}

/// A solid of half the largest equilibrium modulus that the data allow; `storage` is their modulus at the lowest frequency.
fn held_solid(rows: &Rows, storage: f64) -> Result<Series, NnlsError> {
    let (lowest, _) = rows.window();
    let times = Rows::grid((limits(rows, BEYOND).0, 1.0 / lowest), COARSE);
    let with = |held: f64| rows.strengths(&times, (false, held));
    let allowed = rows.chi_squared(&with(0.0)?) + ALLOWED;
    let (mut least, mut most) = (NOTHING * storage, storage);
    for _ in 0..HALVINGS {
        let middle = (least * most).sqrt();
        match rows.chi_squared(&with(middle)?) <= allowed {
            true => least = middle,
            false => most = middle,
        }
    }
    with(0.5 * least)
}

/// Consistency of storage and loss modulus, see above.
fn kramers_kronig(points: &[DynamicPoint]) -> Result<Option<f64>, NnlsError> {
    let rows = Rows::new(points);
    let times = Rows::grid(limits(&rows, FAR_BEYOND), COARSE);
    let alone = |part: Part| rows.only(part).strengths(&times, (part != Part::Loss, 0.0));
    let alone = [alone(Part::Storage)?, alone(Part::Loss)?];
    let Some(rows) = rows.with_noise_of_each(&alone, FEWEST_FREE) else {
        return Ok(None);
    };
    let both = rows.strengths(&times, (true, 0.0))?;
    let free = rows.count().saturating_sub(both.strengths());
    let variance = rows.chi_squared(&both) / free.max(1) as f64;
    Ok((free >= FEWEST_FREE).then(|| variance.sqrt()))
}

/// Fit / data - 1 of both moduli, point by point.
fn residuals(points: &[DynamicPoint], relaxation: &Relaxation) -> Vec<(f64, f64)> {
    let residual = |point: &DynamicPoint| {
        let modulus = relaxation.complex_modulus(point.angular_frequency_rad_per_s);
        (
            modulus.re / point.storage_modulus_pa - 1.0,
            modulus.im / point.loss_modulus_pa - 1.0,
        )
    };
    points.iter().map(residual).collect()
}

impl Rows {
    /// A series in SI units.
    pub(super) fn relaxation(&self, series: &Series) -> Result<Relaxation, MaterialError> {
        let branch = |branch: &Branch| RelaxationBranch {
            modulus_pa: branch.strength * self.reference_pa,
            time_s: branch.time_s,
        };
        let branches = series.branches.iter().map(branch);
        let branches = branches.filter(|branch| branch.modulus_pa > 0.0).collect();
        Relaxation::new(series.constant * self.reference_pa, branches)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::dynamic::synthetic::{isotherm, noise_of, solid};
    use crate::material::synthetic::{Noise, log_spaced};

    fn from_environment(name: &str, default: u64) -> u64 {
        let asked = std::env::var(name).ok();
        asked.map_or(default, |text| text.parse().unwrap())
    }

    /// A random solid over 3 to 15 decades, measured at one temperature.
    fn measured(seed: u64, noise: f64) -> (Relaxation, Vec<DynamicPoint>) {
        let mut random = Noise(seed);
        let decades = 3.0 + (13.0 * random.uniform()).floor();
        let window = (10_f64.powf(-decades / 2.0), 10_f64.powf(decades / 2.0));
        let truth = solid(&mut random, window);
        let frequencies = log_spaced(window.0, window.1, 10);
        let points = isotherm(&truth, 300.0, 1.0, &frequencies, noise, &mut random);
        (truth, points)
    }

    /// Root mean squares of the relative errors of storage and loss modulus over the band.
    fn errors(fit: &PronyFit, truth: &Relaxation, points: &[DynamicPoint]) -> (f64, f64) {
        let exact = points.iter().map(|point| {
            let modulus = truth.complex_modulus(point.angular_frequency_rad_per_s);
            DynamicPoint {
                storage_modulus_pa: modulus.re,
                loss_modulus_pa: modulus.im,
                ..*point
            }
        });
        let exact: Vec<DynamicPoint> = exact.collect();
        let errors = residuals(&exact, &fit.relaxation);
        let mean = |part: fn(&(f64, f64)) -> f64| {
            let squares: f64 = errors.iter().map(|both| part(both).powi(2)).sum();
            (squares / errors.len() as f64).sqrt()
        };
        (mean(|both| both.0), mean(|both| both.1))
    }

    /// `PRONY_CASES=300 cargo test --lib prony -- --nocapture` tries and prints as many as asked for.
    #[test]
    fn the_series_of_random_solids_is_closer_to_the_truth_than_the_noise() {
        for seed in 0..from_environment("PRONY_CASES", 6) {
            let noise = noise_of(seed);
            let (truth, points) = measured(seed, noise);
            let start = std::time::Instant::now();
            let fit = fit(&points, None).unwrap();
            let seconds = start.elapsed().as_secs_f64();
            let (storage, loss) = errors(&fit, &truth, &points);
            println!(
                "{seed}: {} points, noise {noise}: {:.2} {:.2} of it; branches {} of {}; errors {:.2} {:.2}; consistency {:.2}; {seconds:.2} s",
                points.len(),
                fit.noise.0 / noise,
                fit.noise.1 / noise,
                fit.relaxation.branches().len(),
                truth.branches().len(),
                storage / noise,
                loss / noise,
                fit.kramers_kronig.unwrap_or(-1.0)
            );
            assert!(!fit.relaxation.is_fluid(), "seed {seed}");
            assert!(
                storage < noise && loss < noise,
                "seed {seed}: {storage} {loss}"
            );
        }
    }

    /// Noise-free points of a series.
    fn exact(truth: &Relaxation, frequencies: &[f64]) -> Vec<DynamicPoint> {
        isotherm(truth, 300.0, 1.0, frequencies, 0.0, &mut Noise(1))
    }

    fn of(equilibrium_pa: f64, branches: &[(f64, f64)]) -> Relaxation {
        let branch = |&(modulus_pa, time_s): &(f64, f64)| RelaxationBranch { modulus_pa, time_s };
        Relaxation::new(equilibrium_pa, branches.iter().map(branch).collect()).unwrap()
    }

    #[test]
    fn clean_data_give_back_their_branches() {
        let truth = of(1e6, &[(1e9, 1e-3), (2e8, 0.05), (3e7, 20.0)]);
        let fit = fit(&exact(&truth, &log_spaced(1e-3, 1e4, 10)), None).unwrap();
        assert_eq!(fit.relaxation.branches().len(), 3, "{fit:?}");
        // Misfits of 1e-4 count as none.
        assert!(fit.storage_rms < 1e-4 && fit.loss_rms < 1e-4);
        for (found, exact) in fit.relaxation.branches().iter().zip(truth.branches()) {
            assert!((found.modulus_pa / exact.modulus_pa - 1.0).abs() < 1e-3);
            assert!((found.time_s / exact.time_s - 1.0).abs() < 1e-3);
        }
        assert!((fit.relaxation.equilibrium_modulus() / 1e6 - 1.0).abs() < 1e-3);
        assert_eq!(fit.window_rad_per_s, (1e-3, 1e4));
    }

    #[test]
    fn units_make_no_difference() {
        let (_, points) = measured(3, 0.01);
        let scaled = |point: &DynamicPoint| DynamicPoint {
            angular_frequency_rad_per_s: 1e6 * point.angular_frequency_rad_per_s,
            storage_modulus_pa: 1e-9 * point.storage_modulus_pa,
            loss_modulus_pa: 1e-9 * point.loss_modulus_pa,
            ..*point
        };
        let others: Vec<DynamicPoint> = points.iter().map(scaled).collect();
        let (own, other) = (fit(&points, None).unwrap(), fit(&others, None).unwrap());
        assert_eq!(
            own.relaxation.branches().len(),
            other.relaxation.branches().len()
        );
        for point in &points {
            let omega = point.angular_frequency_rad_per_s;
            let own = own.relaxation.complex_modulus(omega);
            let other = 1e9 * other.relaxation.complex_modulus(1e6 * omega);
            // Rounding, as far as ill-conditioned times enlarge it.
            assert!((other / own - 1.0).norm() < 1e-4, "{omega}");
        }
    }

    #[test]
    fn more_noise_gives_no_more_branches() {
        let mut sums = [0; 3];
        for seed in 0..4 {
            for (sum, noise) in sums.iter_mut().zip([0.003, 0.01, 0.03]) {
                let (_, points) = measured(seed, noise);
                *sum += fit(&points, None).unwrap().relaxation.branches().len();
            }
        }
        assert!(sums[0] >= sums[1] && sums[1] >= sums[2], "{sums:?}");
    }

    #[test]
    fn a_loss_modulus_that_does_not_belong_to_the_storage_modulus_shows() {
        for seed in 0..4 {
            let (_, points) = measured(seed, 0.01);
            let consistency = |points: &[DynamicPoint]| {
                let fit = fit(points, None).unwrap();
                fit.kramers_kronig.unwrap()
            };
            // A hundred degrees of freedom or so: 7 % is one standard deviation.
            assert!((consistency(&points) - 1.0).abs() < 0.25, "seed {seed}");
            let scaled = |point: &DynamicPoint| DynamicPoint {
                loss_modulus_pa: 1.5 * point.loss_modulus_pa,
                ..*point
            };
            let wrong: Vec<DynamicPoint> = points.iter().map(scaled).collect();
            assert!(consistency(&wrong) > 5.0, "seed {seed}");
        }
    }

    #[test]
    fn a_number_of_branches_that_is_asked_for_is_kept() {
        let (truth, points) = measured(4, 0.01);
        for branches in [0, 1, 5, 20] {
            let found = fit(&points, Some(branches)).unwrap();
            let count = found.relaxation.branches().len();
            assert!(count <= branches, "{count}");
            assert!(count >= branches.min(5));
            assert!(!found.relaxation.is_fluid());
        }
        let (storage, loss) = errors(&fit(&points, Some(20)).unwrap(), &truth, &points);
        assert!(storage < 0.01 && loss < 0.01);
    }

    #[test]
    fn a_fluid_is_one_where_the_data_resolve_it_and_a_solid_elsewhere() {
        let melt = of(0.0, &[(1e5, 1e-2), (2e4, 0.3), (3e3, 5.0)]);
        let mut random = Noise(5);
        let mut measured = |frequencies: &[f64]| {
            let points = isotherm(&melt, 450.0, 1.0, frequencies, 0.01, &mut random);
            fit(&points, None).unwrap().relaxation
        };
        assert!(measured(&log_spaced(1e-2, 1e3, 10)).is_fluid());
        // The storage modulus is above the loss modulus all over the band.
        assert!(!measured(&log_spaced(200.0, 2e4, 10)).is_fluid());
    }

    #[test]
    fn hardly_any_data_and_odd_ones_give_a_solid_too() {
        let zener = of(1e6, &[(1e6, 1.0)]);
        let steep = of(1.0, &[(1e10, 1e-3)]);
        let wide: Vec<(f64, f64)> = (0..=10)
            .map(|k| (10_f64.powi(k), 10_f64.powi(-k)))
            .collect();
        let elastic = of(1e9, &[(1e3, 1.0)]);
        let few = [0.5, 1.0, 2.0];
        let many = log_spaced(1e-3, 1e3, 5);
        let repeated = [many.clone(), many.clone()].concat();
        for (name, truth, frequencies) in [
            ("three points", &zener, few.to_vec()),
            ("one frequency", &zener, vec![1.0; 3]),
            ("steep", &steep, log_spaced(1e-2, 1e6, 10)),
            ("ten decades", &of(1.0, &wide), log_spaced(1e-2, 1e12, 5)),
            ("elastic", &elastic, many),
            ("repeated", &zener, repeated),
        ] {
            for noise in [0.0, 0.02] {
                let points = isotherm(truth, 300.0, 1.0, &frequencies, noise, &mut Noise(2));
                let fit = fit(&points, None).unwrap();
                assert!(!fit.relaxation.is_fluid(), "{name}");
                // Two and a half standard deviations where each point is its own fit.
                let most = 2.5 * noise + 1e-3;
                assert!(
                    fit.storage_rms < most && fit.loss_rms < most,
                    "{name}: {fit:?}"
                );
                let (storage, loss) = errors(&fit, truth, &points);
                assert!(storage < most && loss < most, "{name}: {storage} {loss}");
            }
        }
    }
}
