//! Master curves of known materials.
//!
//! `CASES=200 SEED=0 cargo test --release --lib master_curve -- --nocapture` tries as many as asked for and prints what came out.

use super::*;
use crate::material::dynamic::shift_law;
use crate::material::dynamic::synthetic::{Measurement, isotherm, measurement, noise_of, solid};
use crate::material::{ModulusKind, synthetic};

fn from_environment(name: &str, default: u64) -> u64 {
    let asked = std::env::var(name).ok();
    asked.map_or(default, |text| text.parse().expect("a whole number"))
}

/// Errors of all factors (decades), and their stated errors.
fn errors(made: &Measurement, curve: &MasterCurve) -> Vec<(f64, f64)> {
    let law = |t: f64| made.law.log10_a_t(t).unwrap();
    let zero = law(curve.reference_temperature_k);
    let error = |s: &ShiftFactor| {
        let error = s.log10_a_t - (law(s.temperature_k) - zero);
        (error.abs(), s.log10_a_t_error.unwrap())
    };
    curve.shifts.iter().map(error).collect()
}

/// Largest of one of the two.
fn worst(errors: &[(f64, f64)], which: impl Fn(&(f64, f64)) -> f64) -> f64 {
    errors.iter().map(which).fold(0.0, f64::max)
}

fn free(data: &DynamicData) -> MasterCurve {
    shift(data, &Choices::default()).unwrap()
}

/// Cases of this noise: how many have every factor within 0.03 decades, and the shares of factors within two stated errors, and of
/// WLF constants within three.
fn tried(noise: impl Fn(u64) -> f64) -> (u64, f64, f64) {
    let (first, cases) = (from_environment("SEED", 0), from_environment("CASES", 6));
    let (mut close, mut inside, mut factors, mut constants) = (0, 0, 0, 0);
    for seed in first..first + cases {
        let made = measurement(seed, noise(seed));
        let curve = free(&made.data);
        let errors = errors(&made, &curve);
        let wlf = curve.wlf.unwrap();
        let within =
            |value: f64, truth: f64, error: f64| usize::from((value - truth).abs() < 3.0 * error);
        constants += within(wlf.c1, made.law.c1, wlf.c1_error);
        constants += within(wlf.c2_k, made.law.c2_k, wlf.c2_error_k);
        assert!(
            matches!(curve.preferred, Some(ShiftLaw::Wlf(_))),
            "seed {seed}"
        );
        let simple = |w: &MasterCurveWarning| !matches!(w, MasterCurveWarning::NotSimple { .. });
        assert!(
            curve.warnings.iter().all(simple),
            "seed {seed}: {:?}",
            curve.simplicity
        );
        let (error, stated) = (worst(&errors, |e| e.0), worst(&errors, |e| e.1));
        println!(
            "seed {seed}, noise {}: worst error {error:.4} decades, largest stated {stated:.4}, simplicity {:.2}, {:?}",
            made.noise,
            curve.simplicity.unwrap(),
            curve.warnings
        );
        close += u64::from(error < 0.03);
        // The reference itself has no error.
        inside += errors
            .iter()
            .filter(|e| e.1 > 0.0 && e.0 < 2.0 * e.1)
            .count();
        factors += errors.len() - 1;
    }
    let share = |part: usize, whole: usize| part as f64 / whole as f64;
    let shares = (
        close,
        share(inside, factors),
        share(constants, 2 * cases as usize),
    );
    println!(
        "of {cases} cases: within 0.03 decades, within two errors, constants within three: {shares:?}"
    );
    shares
}

#[test]
fn factors_at_one_per_cent_of_noise_are_within_three_hundredths_of_a_decade() {
    let (close, inside, constants) = tried(|_| 0.01);
    // Of the seeds 0 to 199 two missed, by 0.0315 and 0.0374 with stated errors of 0.0156 and 0.0189.
    assert!(close as f64 >= 0.8 * from_environment("CASES", 6) as f64);
    // Errors of neighbours hang together: few cases are far fewer independent ones.
    assert!(inside > 0.85, "{inside}");
    assert!(constants > 0.9, "{constants}");
}

#[test]
fn stated_errors_hold_at_every_noise() {
    let (_, inside, constants) = tried(noise_of);
    assert!(inside > 0.85, "{inside}");
    assert!(constants > 0.9, "{constants}");
}

#[test]
fn units_of_the_modulus_and_the_order_of_the_isotherms_do_not_matter() {
    let made = measurement(3, 0.01);
    let curve = free(&made.data);
    let sets = made.data.isotherms().iter().rev().map(|isotherm| {
        let scaled = isotherm.points.iter().rev().map(|point| DynamicPoint {
            storage_modulus_pa: 1e-6 * point.storage_modulus_pa,
            loss_modulus_pa: 1e-6 * point.loss_modulus_pa,
            ..*point
        });
        scaled.collect()
    });
    let other = free(&DynamicData::new(ModulusKind::Longitudinal, sets.collect()).unwrap());
    for (one, other) in curve.shifts.iter().zip(&other.shifts) {
        assert_eq!(one.temperature_k, other.temperature_k);
        // What rounding makes of the end of a refinement.
        assert!((one.log10_a_t - other.log10_a_t).abs() < 1e-5);
    }
}

#[test]
fn another_reference_temperature_adds_a_constant() {
    let made = measurement(3, 0.01);
    let curve = free(&made.data);
    let law = curve.wlf.unwrap();
    let (coldest, hottest) = (
        curve.shifts[0].temperature_k,
        curve.shifts.last().unwrap().temperature_k,
    );
    // An isotherm's own, between two, below and above all.
    for reference in [
        curve.shifts[4].temperature_k,
        curve.shifts[4].temperature_k + 1.3,
        coldest - 2.0,
        hottest + 10.0,
    ] {
        let choices = Choices {
            reference_temperature_k: Some(reference),
            ..Choices::default()
        };
        let other = shift(&made.data, &choices).unwrap();
        assert_eq!(other.reference_temperature_k, reference);
        let constant = curve.log10_a_t(reference).unwrap();
        for (one, other) in curve.shifts.iter().zip(&other.shifts) {
            // The same minimum from another isotherm held: far below the errors.
            assert!((one.log10_a_t - other.log10_a_t - constant).abs() < 1e-3);
        }
        assert!(other.log10_a_t(reference).unwrap().abs() < 1e-9);
        // Constants at that temperature: c1 c2 stays and c2 grows by the difference.
        let wlf = other.wlf.unwrap();
        let difference = reference - law.reference_temperature_k;
        assert!((wlf.c2_k - law.c2_k - difference).abs() < 0.3 * wlf.c2_error_k);
        assert!((wlf.c1 * wlf.c2_k / (law.c1 * law.c2_k) - 1.0).abs() < 0.01);
    }
}

/// Isotherms of a solid whose factors are given by a function.
fn made_by(seed: u64, temperatures_k: &[f64], log10_a_t: impl Fn(f64) -> f64) -> DynamicData {
    let mut random = synthetic::Noise(seed);
    let frequencies = synthetic::log_spaced(0.1, 100.0, 3);
    let last = temperatures_k[temperatures_k.len() - 1];
    let window = (
        0.1 * 10_f64.powf(log10_a_t(last)),
        100.0 * 10_f64.powf(log10_a_t(temperatures_k[0])),
    );
    let truth = solid(&mut random, window);
    let sets = temperatures_k.iter().map(|&t| {
        isotherm(
            &truth,
            t,
            10_f64.powf(log10_a_t(t)),
            &frequencies,
            0.01,
            &mut random,
        )
    });
    DynamicData::new(ModulusKind::Shear, sets.collect()).unwrap()
}

#[test]
fn data_with_an_activation_energy_prefer_arrhenius() {
    let energy = 150e3;
    let law = |t: f64| {
        energy / shift_law::GAS_CONSTANT * (1.0 / t - 1.0 / 300.0) / std::f64::consts::LN_10
    };
    for seed in 0..5 {
        let temperatures: Vec<f64> = (0..9).map(|i| 270.0 + 8.0 * f64::from(i)).collect();
        let curve = free(&made_by(seed, &temperatures, law));
        let found = curve.arrhenius.unwrap();
        let error =
            (found.activation_energy_j_per_mol - energy) / found.activation_energy_error_j_per_mol;
        // Five draws: beyond three and a half errors once in four hundred runs, and the seeds are given.
        assert!(error.abs() < 3.5, "seed {seed}: {found:?}");
        assert!(
            matches!(curve.preferred, Some(ShiftLaw::Arrhenius(_))),
            "seed {seed}: {:?}",
            curve.wlf
        );
    }
}

fn wlf(temperature_k: f64) -> f64 {
    -12.0 * (temperature_k - 320.0) / (70.0 + temperature_k - 320.0)
}

fn shifted(data: &DynamicData, choice: ShiftChoice) -> MasterCurve {
    let choices = Choices {
        shift: choice,
        ..Choices::default()
    };
    shift(data, &choices).unwrap()
}

#[test]
fn given_factors_are_used_interpolated_and_missed() {
    let temperatures: Vec<f64> = (0..8).map(|i| 305.0 + 5.0 * f64::from(i)).collect();
    let data = made_by(1, &temperatures, wlf);
    // Given in another order, one isotherm of them left out and the last a third of a kelvin off; zero at 320 K.
    let given = |last: f64| -> Vec<(f64, f64)> {
        let kept = temperatures.iter().rev().filter(|t| **t != 330.0);
        kept.map(|&t| (if t == 340.0 { last } else { t }, wlf(t)))
            .collect()
    };
    let curve = shifted(&data, ShiftChoice::Given(given(339.7)));
    assert_eq!(curve.reference_temperature_k, 320.0);
    for factor in &curve.shifts {
        assert_eq!(factor.log10_a_t_error, None);
        // A cubic over ten kelvin of a hyperbola, and a third of a kelvin at 0.1 decades each.
        assert!(
            (factor.log10_a_t - wlf(factor.temperature_k)).abs() < 0.05,
            "{factor:?}"
        );
    }
    let choices = Choices {
        shift: ShiftChoice::Given(given(339.0)),
        ..Choices::default()
    };
    let missed = shift(&data, &choices).unwrap_err();
    assert_eq!(
        missed,
        MasterCurveError::NoFactor {
            temperature_k: 340.0
        }
    );
}

#[test]
fn no_shift_leaves_the_data_as_they_are() {
    let temperatures = [300.0, 310.0, 320.0];
    let data = made_by(2, &temperatures, |_| 0.0);
    let curve = shifted(&data, ShiftChoice::None);
    assert!(
        curve
            .shifts
            .iter()
            .all(|s| s.log10_a_t == 0.0 && s.log10_a_t_error.is_none() && s.b_t == 1.0)
    );
    assert_eq!(curve.points.len(), data.points().count());
    assert_eq!(
        (curve.wlf, curve.arrhenius, curve.preferred),
        (None, None, None)
    );
}

#[test]
fn a_law_that_is_chosen_is_refined_with_the_curve() {
    let temperatures: Vec<f64> = (0..9).map(|i| 300.0 + 5.0 * f64::from(i)).collect();
    let data = made_by(4, &temperatures, wlf);
    let curve = shifted(&data, ShiftChoice::Wlf);
    let law = curve.wlf.unwrap();
    for factor in &curve.shifts {
        assert!((factor.log10_a_t - law.log10_a_t(factor.temperature_k).unwrap()).abs() < 1e-9);
    }
    // Constants at 320 K, the middle isotherm.
    assert_eq!(law.reference_temperature_k, 320.0);
    assert!((law.c1 - 12.0).abs() < 3.0 * law.c1_error, "{law:?}");
    assert!((law.c2_k - 70.0).abs() < 3.0 * law.c2_error_k, "{law:?}");
    let curve = shifted(&data, ShiftChoice::Arrhenius);
    assert!(matches!(curve.preferred, Some(ShiftLaw::Arrhenius(_))));
    assert!(
        curve
            .warnings
            .iter()
            .any(|w| matches!(w, MasterCurveWarning::NoLaw { .. }))
    );
}

#[test]
fn isotherms_that_do_not_meet_are_named() {
    // Four decades apart, of three each.
    let data = made_by(5, &[300.0, 310.0, 320.0], |t| {
        if t < 305.0 { 4.0 } else { -0.1 * (t - 310.0) }
    });
    let curve = free(&data);
    let named = MasterCurveWarning::NoOverlap {
        lower_k: 300.0,
        upper_k: 310.0,
    };
    assert_eq!(
        curve
            .warnings
            .iter()
            .filter(|w| matches!(w, MasterCurveWarning::NoOverlap { .. }))
            .collect::<Vec<_>>(),
        [&named]
    );
}

#[test]
fn vertical_shifts_are_found_with_the_horizontal_ones() {
    let temperatures: Vec<f64> = (0..9).map(|i| 300.0 + 5.0 * f64::from(i)).collect();
    let moved = made_by(6, &temperatures, wlf);
    let sets = moved.isotherms().iter().map(|isotherm| {
        let b_t = 320.0 / isotherm.temperature_k.unwrap();
        let points = isotherm.points.iter().map(|point| DynamicPoint {
            storage_modulus_pa: point.storage_modulus_pa / b_t,
            loss_modulus_pa: point.loss_modulus_pa / b_t,
            ..*point
        });
        points.collect()
    });
    let data = DynamicData::new(ModulusKind::Shear, sets.collect()).unwrap();
    let choices = Choices {
        vertical_shift: true,
        ..Choices::default()
    };
    let curve = shift(&data, &choices).unwrap();
    for factor in &curve.shifts {
        let error = (factor.log10_a_t - wlf(factor.temperature_k)).abs();
        assert!(
            error <= 3.0 * factor.log10_a_t_error.unwrap(),
            "{factor:?}, {error}"
        );
    }
}

#[test]
fn replicas_start_from_what_was_found() {
    let made = measurement(3, 0.01);
    let curve = free(&made.data);
    let again = refined_from(&made.data, &curve, &Choices::default()).unwrap();
    for (one, other) in curve.shifts.iter().zip(&again.shifts) {
        // The same minimum, to the step at which a refinement ends.
        assert!((one.log10_a_t - other.log10_a_t).abs() < 1e-3);
    }
}

#[test]
fn few_points_and_a_single_isotherm_do_no_harm() {
    let data = made_by(7, &[300.0, 310.0, 320.0], |t| -0.05 * (t - 310.0));
    let few = |isotherms: usize, points: usize| {
        let sets = data.isotherms().iter().take(isotherms);
        let sets = sets.map(|isotherm| isotherm.points.iter().take(points).copied().collect());
        DynamicData::new(ModulusKind::Shear, sets.collect()).unwrap()
    };
    for (isotherms, points) in [(3, 1), (2, 2), (1, 3), (2, 3), (3, 4)] {
        for vertical_shift in [false, true] {
            for shift_choice in [
                ShiftChoice::Free,
                ShiftChoice::Arrhenius,
                ShiftChoice::Wlf,
                ShiftChoice::None,
            ] {
                let choices = Choices {
                    vertical_shift,
                    shift: shift_choice,
                    ..Choices::default()
                };
                if let Ok(curve) = shift(&few(isotherms, points), &choices) {
                    assert!(curve.shifts.iter().all(|s| s.log10_a_t.is_finite()));
                }
            }
        }
    }
}
