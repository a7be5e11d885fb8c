//! Sweeps whose indenter leaves the surface for a part of every cycle, under either control.

use crate::prelude::*;

const MEAN_N: f64 = 5.0;
const AMPLITUDE_N: f64 = 10.0;

fn tapping() -> HarmonicDrive {
    HarmonicDrive::load(MEAN_N, AMPLITUDE_N).unwrap()
}

/// Loss (J) of a punch of this radius: while it rests on the surface without load, that is flat under it, so that the approach is
/// linear in the load all the time, and each harmonic of the load dissipates pi n |W_n|^2 |Im C*(n omega)|/(2a).
fn punch_loss_j(material: &Material, radius_m: f64, omega: f64) -> f64 {
    const SAMPLES: usize = 1 << 16;
    let drive = tapping();
    let compliance = material.contact_compliance().unwrap();
    let of_harmonic = |n: usize| {
        let at = |k: usize| (k as f64 + 0.5) / SAMPLES as f64;
        let sum = |wave: fn(f64) -> f64| -> f64 {
            let values = (0..SAMPLES).map(|k| drive.value(at(k)) * wave(TAU * n as f64 * at(k)));
            values.sum::<f64>() * 2.0 / SAMPLES as f64
        };
        let amplitude_2 = sum(f64::sin).powi(2) + sum(f64::cos).powi(2);
        let lossy = -compliance.complex_compliance(n as f64 * omega).im;
        PI * n as f64 * amplitude_2 * lossy / (2.0 * radius_m)
    };
    // Amplitudes fall as 1/n^2, terms as 1/n^4 at the least.
    (1..=60).map(of_harmonic).sum()
}

#[test]
fn a_punch_that_is_lifted_off_loses_what_the_harmonics_of_its_load_do() {
    let radius_m = 1e-3;
    for omega in [0.1, 1.0, 8.0] {
        let exact = punch_loss_j(&zener_material(), radius_m, omega);
        let sweep = |steps| {
            let punch = FlatPunch::new(radius_m).unwrap();
            let sweep = Sweep::new(zener_material(), punch, tapping());
            sweep.springs(40).unwrap().steps(steps).unwrap()
        };
        let result = solved(sweep(200), omega);
        below!((result.loss_j() - exact).abs(), result.bar_j());
        below!(result.bar_j(), 5e-3 * exact, "{omega}");
        assert!((result.contact_duty.part - 2.0 / 3.0).abs() < 1e-15);
        assert_eq!(result.contact_duty.error, 0.0);
        assert_eq!(result.storage_modulus_pa, None);
        // The load leaves zero somewhere within a step, wherever that is: halving steps four times is an order of two on average.
        let error = |steps| {
            let result = solved(sweep(steps).without_error_bars(), omega);
            relative(result.loss_j(), exact).abs()
        };
        let order = (error(50) / error(800)).log2() / 4.0;
        assert!(order > 1.7, "{omega}: {order}");
    }
}

fn under_a_sphere(drive: HarmonicDrive) -> Sweep {
    Sweep::new(zener_material(), ball(0.01), drive)
}

#[test]
fn a_tapping_sphere_dissipates_the_area_of_its_loop_within_the_error_of_both_engines() {
    for omega in [0.3, 1.0, 4.0] {
        let springs = solved(under_a_sphere(tapping()), omega);
        let (loss_j, own_j) = (springs.loss_j(), springs.bar_j());
        below!((springs.dissipated_j() - loss_j).abs(), own_j, "{omega}");
        let fine = under_a_sphere(tapping()).without_error_bars();
        let fine = solved(fine.springs(1600).unwrap().steps(3200).unwrap(), omega);
        below!((fine.loss_j() - loss_j).abs(), own_j, "{omega}");
        below!(own_j, 5e-3 * loss_j, "{omega}");
        let cells = solved(under_a_sphere(tapping()).cells(64).unwrap(), omega);
        let apart_j = (cells.loss_j() - loss_j).abs();
        below!(apart_j, cells.bar_j() + own_j, "{omega}");
        below!(apart_j, 5e-3 * loss_j, "{omega}");
    }
}

#[test]
fn the_direct_search_finds_the_cycle_that_marching_comes_to() {
    let [direct, marched] = [Method::Direct, Method::March].map(|method| {
        let sweep = under_a_sphere(tapping()).without_error_bars();
        let mut plan = sweep.frequencies_hz([0.1]).unwrap().into_plan();
        (plan.cycle.tolerance, plan.cycle.method) = (1e-7, method);
        loss_j(&plan, 0.1 * TAU)
    });
    // Both are as near to the stabilised cycle as the tolerance says.
    near!(direct, marched, 1e-6);
}

#[test]
fn the_deeper_the_load_would_pull_the_shorter_the_contact_down_to_none() {
    let mut last = f64::INFINITY;
    for mean_n in [8.0, 0.0, -5.0, -9.9] {
        let drive = HarmonicDrive::load(mean_n, AMPLITUDE_N).unwrap();
        let result = solved(under_a_sphere(drive).without_error_bars(), 1.0);
        let loss_j = result.loss_j();
        assert!(0.0 < loss_j && loss_j < last, "{mean_n}: {loss_j:e}");
        near!(result.dissipated_j(), loss_j, 0.05, "{mean_n}");
        last = loss_j;
    }
}

#[test]
fn the_part_in_contact_under_an_approach_lies_within_its_error() {
    let drive = HarmonicDrive::approach(2e-6, 4e-6).unwrap();
    let at = |steps| {
        let sweep = under_a_sphere(drive).without_error_bars();
        solved(sweep.steps(steps).unwrap(), 1.0).contact_duty
    };
    let (coarse, fine) = (at(100), at(3200));
    assert_eq!(coarse.error, 0.01);
    // An elastic surface follows all the way down to the undisturbed one; this one is left behind on the way up.
    assert!(fine.part < 2.0 / 3.0 && fine.part > 0.5, "{fine:?}");
    assert!((coarse.part - fine.part).abs() <= coarse.error + fine.error);
    let always = HarmonicDrive::approach(8e-6, 2e-6).unwrap();
    let sweep = Sweep::new(pmma_material(), ball(0.01), always);
    let result = solved(sweep.without_error_bars(), 1e-3);
    let duty = result.contact_duty;
    assert_eq!((duty.part, duty.error), (1.0, 0.0));
    assert!(result.storage_modulus_pa.is_some());
}
