//! Cycles by their number: the n-th after a rest of given length, as an experiment has it, against the closed form of a punch on a
//! standard linear solid, against the same history followed step by step, and against the stabilised cycle it comes to.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use contact_dma::cycle::{LoopAnalysis, analyse_open};
use contact_dma::material::Creep;
use contact_dma::prelude::*;
use contact_dma::simulation::cycles::HistoryCycle;
use contact_dma::sweep::record::Status;
use contact_dma::sweep::record::error_bars::Quantity;

use crate::common::{pmma_material, zener, zener_material};

const PUNCH_RADIUS_M: f64 = 1e-3;
const MEAN_N: f64 = 10.0;
const AMPLITUDE_N: f64 = 5.0;

fn drive(hold_s: f64) -> HarmonicDrive {
    HarmonicDrive::new(Control::Load, MEAN_N, AMPLITUDE_N, 0.0, hold_s).unwrap()
}

/// The approach (m) of a round punch under a mean held from time 0 on, to which a sine is added after the hold: delta = 1/(2a) times the
/// convolution of C with the load, branch by branch.
fn approach_m(compliance: &Creep, (hold_s, omega): (f64, f64), since_s: f64) -> f64 {
    let (sine, cosine) = (omega * since_s).sin_cos();
    let of_mean = MEAN_N * compliance.compliance(hold_s + since_s);
    let of_branch = |branch: &CreepBranch| {
        let tau = omega * branch.time_s;
        let decayed = tau * (-since_s / branch.time_s).exp();
        branch.compliance_per_pa * (sine - tau * cosine + decayed) / (1.0 + tau * tau)
    };
    let branches: f64 = compliance.branches().iter().map(of_branch).sum();
    let of_sine = AMPLITUDE_N * (compliance.instantaneous_compliance() * sine + branches);
    (of_mean + of_sine) / (2.0 * PUNCH_RADIUS_M)
}

/// The n-th cycle of the closed form, in as many samples as leave no doubt.
fn exact(compliance: &Creep, (hold_s, omega): (f64, f64), number: usize) -> LoopAnalysis {
    const SAMPLES: usize = 4096;
    let period_s = TAU / omega;
    let times = (0..=SAMPLES).map(|k| period_s * k as f64 / SAMPLES as f64);
    let first_s = (number - 1) as f64 * period_s;
    let loads = times
        .clone()
        .map(|t| MEAN_N + AMPLITUDE_N * (omega * t).sin());
    let approaches = times.map(|t| approach_m(compliance, (hold_s, omega), first_s + t));
    analyse_open(&loads.collect::<Vec<_>>(), &approaches.collect::<Vec<_>>()).unwrap()
}

fn case(sweep: Sweep, omega: f64) -> CaseRecord {
    sweep.case_at_hz(omega / TAU).unwrap()
}

#[test]
fn any_cycle_of_a_punch_is_that_of_the_closed_form_within_its_error() {
    for (hold_s, omega, number) in [
        (0.0, 1.0, 1),
        (0.0, 1.0, 3),
        (0.7, 0.3, 2),
        (3.0, 10.0, 1),
        (3.0, 10.0, 7),
        (20.0, 0.03, 1),
    ] {
        let punch = FlatPunch::new(PUNCH_RADIUS_M).unwrap();
        let sweep = Sweep::new(zener_material(), punch, drive(hold_s))
            .springs(40)
            .unwrap();
        let record = case(sweep.at_cycle(number).unwrap(), omega);
        assert_eq!((record.status, record.cycles), (Status::Transient, number));
        let result = record.result.as_ref().unwrap();
        let exact = exact(&zener(), (hold_s, omega), number);
        let error = (result.analysis.energy_loss_j / exact.energy_loss_j - 1.0).abs();
        let bar = record.energy_loss_error_j().unwrap() / exact.energy_loss_j;
        // 200 steps of a second-order rule; in the slowest case a step is as long as the retardation time.
        assert!(
            error < bar && bar < 2e-3,
            "{hold_s} {omega} {number}: {error:e} {bar:e}"
        );
        let phase_bar = result
            .errors
            .as_ref()
            .unwrap()
            .of(Quantity::PhaseLag)
            .unwrap();
        let phase_error = (result.analysis.phase_lag_rad - exact.phase_lag_rad).abs();
        assert!(
            phase_error < phase_bar,
            "{hold_s} {omega} {number}: {phase_error:e} {phase_bar:e}"
        );
        // What a branch dissipates is not the area of an open loop.
        assert!(result.branches.is_empty());
        let mean_m = result.analysis.approach_mean_m;
        assert!((mean_m / exact.approach_mean_m - 1.0).abs() < 1e-4);
    }
}

/// The cycles of a mean held and then an oscillation, as `simulate` follows them.
fn followed(material: Material, hold_s: f64, (omega, cycles): (f64, f64)) -> Vec<HistoryCycle> {
    let held = Segment::Step {
        to: MEAN_N,
        duration_s: hold_s,
    };
    let sine = Segment::Sine {
        mean: MEAN_N,
        amplitude: AMPLITUDE_N,
        angular_frequency_rad_per_s: omega,
        phase_rad: 0.0,
        cycles,
    };
    let drive = SegmentedDrive::new(Control::Load, vec![held, sine]).unwrap();
    let sphere = Arc::new(Sphere::new(0.01).unwrap());
    let plan = ScenarioPlan::new(material, sphere, drive);
    let outcome = Simulation::new(plan).unwrap();
    outcome.run(&AtomicBool::new(false), &|_, _| {}).cycles
}

#[test]
fn a_cycle_by_its_number_is_the_one_of_the_history_within_the_errors_of_both() {
    let (hold_s, omega) = (100.0, 0.02);
    let cycles = followed(pmma_material(), hold_s, (omega, 4.5));
    assert_eq!(cycles.len(), 4);
    for cycle in &cycles {
        let numbers = cycle.numbers.as_ref().unwrap();
        let sphere = Sphere::new(0.01).unwrap();
        let sweep = Sweep::new(pmma_material(), sphere, drive(hold_s));
        let record = case(sweep.at_cycle(cycle.number).unwrap(), omega);
        let result = record.result.as_ref().unwrap();
        let errors = result.errors.as_ref().unwrap();
        let bar = |quantity| errors.of(quantity).unwrap();
        let close = |name: &str, (a, b): (f64, f64), (bar_a, bar_b): (f64, f64)| {
            let apart = (a - b).abs();
            assert!(
                apart < bar_a + bar_b,
                "{name} of cycle {}: {a:e} {b:e}, {apart:e} {bar_a:e} {bar_b:e}",
                cycle.number
            );
            assert!(
                bar_a < 3e-3 * a.abs() && bar_b < 1e-2 * b.abs(),
                "{name}: {bar_a:e} {bar_b:e} of {a:e}"
            );
        };
        let (own, followed) = (&result.analysis, &numbers.analysis);
        close(
            "loss",
            (own.energy_loss_j, followed.energy_loss_j),
            (
                bar(Quantity::EnergyLoss),
                cycle.errors.energy_loss_j.unwrap(),
            ),
        );
        close(
            "phase",
            (own.phase_lag_rad, followed.phase_lag_rad),
            (bar(Quantity::PhaseLag), cycle.errors.phase_lag_rad.unwrap()),
        );
        close(
            "E'",
            (
                result.storage_modulus_pa.unwrap(),
                numbers.moduli_pa.unwrap().0,
            ),
            (
                bar(Quantity::StorageModulus),
                cycle.errors.storage_modulus_pa.unwrap(),
            ),
        );
    }
    // The approach still creeps, less with every cycle.
    let changes: Vec<f64> = cycles
        .iter()
        .map(|cycle| cycle.numbers.as_ref().unwrap().approach_change_m)
        .collect();
    assert!(
        changes.windows(2).all(|w| w[1] < w[0]) && changes[3] > 0.0,
        "{changes:?}"
    );
}

#[test]
fn a_late_cycle_is_the_stabilised_one() {
    let sphere = || Sphere::new(0.01).unwrap();
    let omega = 0.5;
    let stabilised = case(Sweep::new(zener_material(), sphere(), drive(0.0)), omega);
    let late = Sweep::new(zener_material(), sphere(), drive(30.0));
    let late = case(late.at_cycle(6).unwrap(), omega);
    // Six cycles and the hold are a hundred retardation times of 1 s.
    let (a, b) = (
        stabilised.energy_loss_j().unwrap(),
        late.energy_loss_j().unwrap(),
    );
    let bars = stabilised.energy_loss_error_j().unwrap() + late.energy_loss_error_j().unwrap();
    assert!((a - b).abs() < bars, "{a:e} {b:e} {bars:e}");
    assert!(late.steady_distance.unwrap() < 1e-10);
    assert_eq!(late.status, Status::Transient);
}
