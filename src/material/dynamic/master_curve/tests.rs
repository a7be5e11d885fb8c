//! Master curves of known materials.
//!
//! `CASES=200 SEED=0 cargo test --release --lib master_curve -- --nocapture` tries as many as asked for and prints what came out.

use super::*;
use crate::material::dynamic::synthetic::{Measurement, measurement};

fn from_environment(name: &str, default: u64) -> u64 {
    let asked = std::env::var(name).ok();
    asked.map_or(default, |text| text.parse().expect("a whole number"))
}

/// Errors of all factors, and their stated errors.
fn errors(made: &Measurement, curve: &MasterCurve) -> Vec<(f64, f64)> {
    let law = |t: f64| made.law.log10_a_t(t).unwrap();
    let zero = law(curve.reference_temperature_k);
    let error = |s: &ShiftFactor| {
        let error = s.log10_a_t - (law(s.temperature_k) - zero);
        (error, s.log10_a_t_error.unwrap())
    };
    curve.shifts.iter().map(error).collect()
}

#[test]
fn study() {
    let noise = from_environment("NOISE", 10) as f64 / 1000.0;
    let from = from_environment("SEED", 0);
    let (mut inside, mut all, mut good) = (0, 0, 0);
    for seed in from..from + from_environment("CASES", 20) {
        let made = measurement(seed, noise);
        let begun = std::time::Instant::now();
        let chain = neighbours::chain(made.data.isotherms(), &Noise::of(&made.data), false);
        let t1 = begun.elapsed().as_secs_f64();
        let curve = shift(&made.data, &Choices::default()).unwrap();
        let t2 = begun.elapsed().as_secs_f64() - t1;
        let begun = std::time::Instant::now();
        let _ = refined_from(&made.data, &curve, &Choices::default()).unwrap();
        let t3 = begun.elapsed().as_secs_f64();
        let errors = errors(&made, &curve);
        let middle = errors.len() / 2;
        let chain_worst = curve
            .shifts
            .iter()
            .enumerate()
            .map(|(i, s)| {
                let law = |t: f64| made.law.log10_a_t(t).unwrap();
                (chain[i] - chain[middle] - law(s.temperature_k)
                    + law(curve.reference_temperature_k))
                .abs()
            })
            .fold(0.0, f64::max);
        let worst = errors.iter().map(|e| e.0.abs()).fold(0.0, f64::max);
        let ratio = errors
            .iter()
            .filter(|e| e.1 > 0.0)
            .map(|e| e.0.abs() / e.1)
            .fold(0.0, f64::max);
        inside += errors
            .iter()
            .filter(|e| e.1 > 0.0 && e.0.abs() < 2.0 * e.1)
            .count();
        all += errors.len() - 1;
        good += usize::from(worst < 0.03);
        let biggest = errors.iter().map(|e| e.1).fold(0.0, f64::max);
        let wlf = curve.wlf.map(|w| {
            (
                (w.c1 - made.law.c1) / w.c1_error,
                (w.c2_k - made.law.c2_k) / w.c2_error_k,
            )
        });
        let n = Noise::of(&made.data);
        println!(
            "{seed:4} {:2} iso {:2} br chain {chain_worst:.3} worst {worst:.3} stated {biggest:.3} ratio {ratio:5.1} simp {:.2} noise {:.4} {:.4} wlf {wlf:.2?} {} {:?} t {t1:.3} {t2:.3} {t3:.3}",
            errors.len(),
            made.truth.branches().len(),
            curve.simplicity.unwrap(),
            n.storage,
            n.loss,
            matches!(curve.preferred, Some(ShiftLaw::Wlf(_))),
            curve.warnings
        );
    }
    println!(
        "within 2 errors {:.3}, cases within 0.03 {good}",
        inside as f64 / all as f64
    );
}
