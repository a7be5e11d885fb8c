//! Measurements of known materials for tests: Prony series, isotherms shifted by a known law, noise from a seed.

use super::shift_law::Wlf;
use super::{DynamicData, DynamicPoint};
use crate::material::synthetic::Noise;
use crate::material::{ModulusKind, Relaxation, RelaxationBranch};

/// A measurement, and what it was made of.
pub(super) struct Measurement {
    pub(super) data: DynamicData,
    /// At the reference temperature of the law.
    pub(super) truth: Relaxation,
    pub(super) law: Wlf,
    /// Relative standard deviation of storage and loss modulus.
    pub(super) noise: f64,
}

/// Seeds 0, 1, 2 and so on: noise of 0.5, 1 and 3 % in turn.
pub(super) fn noise_of(seed: u64) -> f64 {
    [0.005, 0.01, 0.03][(seed % 3) as usize]
}

/// A solid of 3 to 30 branches in 8 to 20 isotherms of 10 points over three decades, a WLF law, every value with this noise.
/// The frequencies of neighbours overlap by one to two and a half of their three decades, after shifting.
pub(super) fn measurement(seed: u64, noise: f64) -> Measurement {
    let mut random = Noise(seed.wrapping_mul(0x9e37_79b9).wrapping_add(17));
    let count = 8 + (13.0 * random.uniform()) as usize;
    let step_k = 3.0 + 5.0 * random.uniform();
    let coldest_k = 230.0 + 80.0 * random.uniform();
    let temperatures: Vec<f64> = (0..count).map(|i| coldest_k + step_k * i as f64).collect();
    let law = law(&mut random, &temperatures);
    let frequencies: Vec<f64> = (0..10)
        .map(|i| std::f64::consts::TAU * 10_f64.powf(-1.0 + i as f64 / 3.0))
        .collect();
    let log10_a_t = |t: &f64| law.log10_a_t(*t).unwrap();
    let window = (
        frequencies[0] * 10_f64.powf(log10_a_t(&temperatures[count - 1])),
        frequencies[9] * 10_f64.powf(log10_a_t(&temperatures[0])),
    );
    let truth = solid(&mut random, window);
    let sets = temperatures.iter().map(|&temperature_k| {
        let a_t = 10_f64.powf(log10_a_t(&temperature_k));
        isotherm(&truth, temperature_k, a_t, &frequencies, noise, &mut random)
    });
    let data = DynamicData::new(ModulusKind::Longitudinal, sets.collect()).unwrap();
    Measurement {
        data,
        truth,
        law,
        noise,
    }
}

/// Constants at the middle temperature; the two coldest isotherms are 0.5 to 2 decades apart.
fn law(random: &mut Noise, temperatures: &[f64]) -> Wlf {
    let reference_temperature_k = temperatures[temperatures.len() / 2];
    let above = |t: f64| t - reference_temperature_k;
    let c2_k = above(temperatures[0]).abs() + random.log_uniform(20.0, 100.0);
    let steepest = random.log_uniform(0.5, 2.0);
    let unit = |t: f64| -above(t) / (c2_k + above(t));
    Wlf {
        reference_temperature_k,
        c1: steepest / (unit(temperatures[0]) - unit(temperatures[1])),
        c2_k,
        c1_error: 0.0,
        c2_error_k: 0.0,
    }
}

/// 3 to 30 branches about evenly over the window, the modulus rising from a rubber's by a factor of 10 to 3000.
pub(super) fn solid(random: &mut Noise, window_rad_per_s: (f64, f64)) -> Relaxation {
    let count = 3 + (28.0 * random.uniform()) as usize;
    let equilibrium_pa = random.log_uniform(3e5, 3e7);
    let ratio = random.log_uniform(10.0, 3000.0);
    let (lowest, highest) = (window_rad_per_s.0.log10(), window_rad_per_s.1.log10());
    let branches = (0..count).map(|i| {
        let place = (i as f64 + random.uniform()) / count as f64;
        RelaxationBranch {
            modulus_pa: equilibrium_pa * ratio.powf(place) * random.log_uniform(0.3, 3.0)
                / count as f64
                * ratio.ln(),
            time_s: 10_f64.powf(-(lowest + place * (highest - lowest))),
        }
    });
    Relaxation::new(equilibrium_pa, branches.collect()).unwrap()
}

/// The material at `a_t` times these frequencies, each modulus with this noise.
pub(super) fn isotherm(
    truth: &Relaxation,
    temperature_k: f64,
    a_t: f64,
    frequencies: &[f64],
    noise: f64,
    random: &mut Noise,
) -> Vec<DynamicPoint> {
    let point = |&angular_frequency_rad_per_s: &f64| {
        let modulus = truth.complex_modulus(a_t * angular_frequency_rad_per_s);
        let mut noisy = |value: f64| value * (1.0 + noise * random.normal());
        DynamicPoint {
            temperature_k: Some(temperature_k),
            angular_frequency_rad_per_s,
            storage_modulus_pa: noisy(modulus.re),
            loss_modulus_pa: noisy(modulus.im),
            errors_pa: None,
        }
    };
    frequencies.iter().map(point).collect()
}

#[test]
fn measurements_are_the_same_in_every_run_and_as_noisy_as_they_say() {
    let mut squares = 0.0;
    let mut count = 0.0;
    for seed in 0..30 {
        let made = measurement(seed, noise_of(seed));
        assert_eq!(made.data, measurement(seed, noise_of(seed)).data);
        assert!((8..=20).contains(&made.data.isotherms().len()));
        assert!((3..=30).contains(&made.truth.branches().len()));
        for point in made.data.points() {
            let a_t = 10_f64.powf(made.law.log10_a_t(point.temperature_k.unwrap()).unwrap());
            let exact = made
                .truth
                .complex_modulus(a_t * point.angular_frequency_rad_per_s);
            let storage = (point.storage_modulus_pa / exact.re - 1.0) / made.noise;
            let loss = (point.loss_modulus_pa / exact.im - 1.0) / made.noise;
            squares += storage * storage + loss * loss;
            count += 2.0;
        }
    }
    // Some 8000 squares of normal deviates: their mean is one to 1.6 %; four of these.
    assert!((squares / count - 1.0_f64).abs() < 0.065);
}
