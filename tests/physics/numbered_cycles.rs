//! Cycles by their number: the n-th after a rest of given length, as an experiment has it, against the closed form of a punch on a
//! standard linear solid, against the same history followed step by step, and against the stabilised cycle it comes to.

use crate::prelude::*;
use contact_dma::cycle::{LoopAnalysis, analyse_open};
use contact_dma::simulation::cycles::HistoryCycle;

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
    let load_n = |t: f64| MEAN_N + AMPLITUDE_N * (omega * t).sin();
    let loads = times.clone().map(load_n);
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
        let sweep = Sweep::new(zener_material(), punch, drive(hold_s));
        let sweep = sweep.springs(40).unwrap().at_cycle(number);
        let record = case(sweep.unwrap(), omega);
        assert_eq!((record.status, record.cycles), (Status::Transient, number));
        let result = record.result.as_ref().unwrap();
        let exact = exact(&zener(), (hold_s, omega), number);
        let (found, what) = (&result.analysis, format!("{hold_s} {omega} {number}"));
        let bar_j = result.bar_j();
        let off_j = (found.energy_loss_j - exact.energy_loss_j).abs();
        below!(off_j, bar_j, "{what}");
        // 200 steps of a second-order rule; in the slowest case a step is as long as the retardation time.
        below!(bar_j, 2e-3 * exact.energy_loss_j, "{what}");
        let off_rad = (found.phase_lag_rad - exact.phase_lag_rad).abs();
        below!(off_rad, result.bar(Quantity::PhaseLag), "{what}");
        // What a branch dissipates is not the area of an open loop.
        assert!(result.branches.is_empty());
        near!(found.approach_mean_m, exact.approach_mean_m, 1e-4);
    }
}

/// The cycles of a mean held and then an oscillation, as `simulate` follows them.
fn cycles_of_history(
    material: Material,
    hold_s: f64,
    (omega, cycles): (f64, f64),
) -> Vec<HistoryCycle> {
    let held = step(MEAN_N, hold_s);
    let sine = Segment::Sine {
        mean: MEAN_N,
        amplitude: AMPLITUDE_N,
        angular_frequency_rad_per_s: omega,
        phase_rad: 0.0,
        cycles,
    };
    let drive = SegmentedDrive::new(Control::Load, vec![held, sine]).unwrap();
    simulated(ScenarioPlan::new(material, sphere(0.01), drive)).cycles
}

#[test]
fn a_cycle_by_its_number_is_the_one_of_the_history_within_the_errors_of_both() {
    let (hold_s, omega) = (100.0, 0.02);
    let cycles = cycles_of_history(pmma_material(), hold_s, (omega, 4.5));
    assert_eq!(cycles.len(), 4);
    for cycle in &cycles {
        let numbers = cycle.numbers.as_ref().unwrap();
        let sphere = ball(0.01);
        let sweep = Sweep::new(pmma_material(), sphere, drive(hold_s));
        let record = case(sweep.at_cycle(cycle.number).unwrap(), omega);
        let result = record.result.as_ref().unwrap();
        let bar = |quantity| result.bar(quantity);
        let close = |name: &str, of_both: [(f64, f64); 2]| {
            let [(a, bar_a), (b, bar_b)] = of_both;
            let what = format!("{name} of cycle {}", cycle.number);
            below!((a - b).abs(), bar_a + bar_b, "{what}");
            below!(bar_a, 3e-3 * a.abs(), "{what}");
            below!(bar_b, 1e-2 * b.abs(), "{what}");
        };
        let (own, followed, error) = (&result.analysis, &numbers.analysis, &cycle.errors);
        let [error_j, error_rad, error_pa] = [
            error.energy_loss_j,
            error.phase_lag_rad,
            error.storage_modulus_pa,
        ]
        .map(Option::unwrap);
        let loss = (own.energy_loss_j, bar(Quantity::EnergyLoss));
        close("loss", [loss, (followed.energy_loss_j, error_j)]);
        let phase = (own.phase_lag_rad, bar(Quantity::PhaseLag));
        close("phase", [phase, (followed.phase_lag_rad, error_rad)]);
        let storage_pa = result.storage_modulus_pa.unwrap();
        let storage = (storage_pa, bar(Quantity::StorageModulus));
        close("E'", [storage, (numbers.moduli_pa.unwrap().0, error_pa)]);
    }
    // The approach still creeps, less with every cycle.
    let change_m = |cycle: &HistoryCycle| cycle.numbers.as_ref().unwrap().approach_change_m;
    let changes: Vec<f64> = cycles.iter().map(change_m).collect();
    assert!(changes.windows(2).all(|w| w[1] < w[0]) && changes[3] > 0.0);
}

#[test]
fn a_late_cycle_is_the_stabilised_one() {
    let sphere = || ball(0.01);
    let omega = 0.5;
    let stabilised = case(Sweep::new(zener_material(), sphere(), drive(0.0)), omega);
    let late = Sweep::new(zener_material(), sphere(), drive(30.0));
    let late = case(late.at_cycle(6).unwrap(), omega);
    // Six cycles and the hold are a hundred retardation times of 1 s.
    let [a, b] = [&stabilised, &late].map(|record| record.energy_loss_j().unwrap());
    let bars = [&stabilised, &late].map(|record| record.energy_loss_error_j().unwrap());
    below!((a - b).abs(), bars[0] + bars[1]);
    assert!(late.steady_distance.unwrap() < 1e-10);
    assert_eq!(late.status, Status::Transient);
}
