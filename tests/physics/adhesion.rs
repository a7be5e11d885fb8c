//! A sphere that is attracted, by the theory of Derjaguin, Muller and Toporov: closed forms of Hertz under the load and the attraction.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use contact_dma::drive::{Control, HistoryError, Segment, SegmentedDrive};
use contact_dma::prelude::*;
use contact_dma::simulation::scenario::ScenarioPlan;
use contact_dma::simulation::{Simulation, SimulationEnd, SimulationOutcome};
use contact_dma::sweep::plan::adhesion::AdhesionPlan;
use contact_dma::sweep::record::CaseResult;
use contact_dma::sweep::record::error_bars::Quantity;

use crate::common::zener_material;

const RADIUS_M: f64 = 1e-6;
const WORK: f64 = 0.05;
/// 2 pi w R.
const PULL_OFF_N: f64 = TAU * WORK * RADIUS_M;

fn sweep(material: Material, (mean_n, amplitude_n): (f64, f64)) -> Sweep {
    let drive = HarmonicDrive::load(mean_n, amplitude_n).unwrap();
    Sweep::new(material, Sphere::new(RADIUS_M).unwrap(), drive)
}

fn solved(sweep: Sweep) -> CaseResult {
    let record = sweep.case_at_hz(1.0 / TAU).unwrap();
    assert_eq!(record.status.name(), "converged", "{:?}", record.message);
    record.result.unwrap()
}

/// Of an elastic solid, and its contact compliance (1/Pa).
fn elastic() -> (Material, f64) {
    let solid = Relaxation::new(3e9, vec![]).unwrap();
    let material = Material::from_relaxation(solid, ModulusKind::Longitudinal, 0.4).unwrap();
    (material, (1.0 - 0.16) / 3e9)
}

#[test]
fn radius_and_approach_are_those_of_hertz_with_the_attraction_down_to_the_pull_off_load() {
    let (_, compliance) = elastic();
    let hertz_m = |load_n: f64| (0.75 * (load_n + PULL_OFF_N) * RADIUS_M * compliance).cbrt();
    // Down to no load, half of the pull, and nearly all of it.
    for part in [0.0, 0.5, 0.999] {
        let amplitude_n = PULL_OFF_N;
        let mean_n = amplitude_n - part * PULL_OFF_N;
        let sweep = sweep(elastic().0, (mean_n, amplitude_n)).without_error_bars();
        let result = solved(sweep.springs(800).unwrap().attracted(WORK).unwrap());
        let load_n = &result.cycle.samples.load_n;
        for (k, load_n) in load_n.iter().enumerate() {
            let radius_m = result.cycle.samples.contact_radius_m[k];
            let exact_m = hertz_m(*load_n);
            // Springs over the widest contact: their width is what a radius is known to.
            let spacing_m = hertz_m(mean_n + amplitude_n) / 800.0;
            assert!((radius_m - exact_m).abs() < 1.5 * spacing_m, "{part} {k}");
            let approach_m = result.cycle.samples.approach_m[k];
            let deepest_m = hertz_m(mean_n + amplitude_n).powi(2) / RADIUS_M;
            assert!((approach_m - exact_m * exact_m / RADIUS_M).abs() < 1e-5 * deepest_m);
        }
        let least_n = load_n.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((least_n + part * PULL_OFF_N).abs() < 1e-3 * PULL_OFF_N);
        assert_eq!(result.contact_duty.part, 1.0);
        assert_eq!(result.analysis.energy_loss_j, 0.0);
    }
}

#[test]
fn the_loop_is_that_of_the_load_and_the_attraction_together() {
    let (mean_n, amplitude_n) = (0.2 * PULL_OFF_N, 0.9 * PULL_OFF_N);
    let attracted = sweep(zener_material(), (mean_n, amplitude_n)).attracted(WORK);
    let attracted = solved(attracted.unwrap());
    let pressed = solved(sweep(zener_material(), (mean_n + PULL_OFF_N, amplitude_n)));
    let (one, other) = (&attracted.analysis, &pressed.analysis);
    // But for the rounding of one load taken off another.
    assert!((one.energy_loss_j / other.energy_loss_j - 1.0).abs() < 1e-12);
    assert!((one.phase_lag_rad / other.phase_lag_rad - 1.0).abs() < 1e-12);
    assert!((one.load_mean_n - mean_n).abs() < 1e-12 * PULL_OFF_N);
    assert!((other.load_mean_n - one.load_mean_n - PULL_OFF_N).abs() < 1e-12 * PULL_OFF_N);
    assert!((attracted.approach_m.maximum / pressed.approach_m.maximum - 1.0).abs() < 1e-12);
    // The attraction is constant and dissipates nothing.
    let bar_j = attracted.errors.as_ref().unwrap().of(Quantity::EnergyLoss);
    let bar_j = bar_j.unwrap();
    assert!((attracted.dissipated_j() - one.energy_loss_j).abs() < bar_j);
    let cells = sweep(zener_material(), (mean_n, amplitude_n))
        .cells(64)
        .unwrap();
    let cells = solved(cells.attracted(WORK).unwrap());
    let of_cells_j = cells
        .errors
        .as_ref()
        .unwrap()
        .of(Quantity::EnergyLoss)
        .unwrap();
    let apart_j = (cells.analysis.energy_loss_j - one.energy_loss_j).abs();
    assert!(apart_j < bar_j + of_cells_j, "{apart_j:e}");
    assert!(attracted.tabor_parameter.is_some() && pressed.tabor_parameter.is_none());
}

#[test]
fn a_load_below_the_pull_off_load_and_what_has_none_are_refused() {
    let (material, _) = elastic();
    let of = |mean_n: f64, amplitude_n: f64| sweep(material.clone(), (mean_n, amplitude_n));
    let told = |sweep: Sweep| sweep.attracted(WORK).unwrap_err().to_string();
    assert!(told(of(0.1 * PULL_OFF_N, 1.2 * PULL_OFF_N)).contains("comes off"));
    let drive = HarmonicDrive::load(1.0, 0.5).unwrap();
    let cone = Sweep::new(material.clone(), Cone::new(1.2).unwrap(), drive);
    assert!(told(cone).contains("sphere"));
    let approach = HarmonicDrive::approach(1e-9, 5e-10).unwrap();
    let approach = Sweep::new(material.clone(), Sphere::new(RADIUS_M).unwrap(), approach);
    assert!(told(approach).contains("prescribed load"));
    for work in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(of(1e-6, 1e-7).attracted(work).is_err(), "{work}");
    }
}

fn history(segments: Vec<Segment>) -> Result<SegmentedDrive, HistoryError> {
    SegmentedDrive::attracted(Control::Load, segments, PULL_OFF_N)
}

/// Attracted from the beginning of a history on.
fn followed(material: Material, segments: Vec<Segment>) -> SimulationOutcome {
    let indenter = Arc::new(Sphere::new(RADIUS_M).unwrap());
    let mut plan = ScenarioPlan::new(material, indenter, history(segments).unwrap());
    plan.contact.adhesion = Some(AdhesionPlan {
        work_j_per_m2: WORK,
        equilibrium_distance_m: AdhesionPlan::EQUILIBRIUM_DISTANCE_M,
    });
    plan.solver.springs = 800;
    plan.output.error_bars = false;
    let simulation = Simulation::new(plan).unwrap();
    let outcome = simulation.run(&AtomicBool::new(false), &|_, _| {});
    assert_eq!(outcome.ended, SimulationEnd::Done);
    outcome
}

fn ramp(to: f64) -> Segment {
    Segment::Ramp {
        to,
        duration_s: 2.0,
    }
}

#[test]
fn a_history_is_that_of_hertz_with_the_attraction_from_first_touch_to_pull_off() {
    let (material, compliance) = elastic();
    let outcome = followed(material, vec![ramp(PULL_OFF_N), ramp(-PULL_OFF_N)]);
    let hertz_m = |load_n: f64| (0.75 * (load_n + PULL_OFF_N) * RADIUS_M * compliance).cbrt();
    let widest_m = hertz_m(PULL_OFF_N);
    for row in &outcome.rows {
        let exact_m = hertz_m(row.load_n);
        assert!((row.contact_radius_m - exact_m).abs() < 1.5 * widest_m / 800.0);
        if let Some(approach_m) = row.approach_m {
            let off = (approach_m - exact_m * exact_m / RADIUS_M).abs();
            assert!(off < 1e-5 * widest_m * widest_m / RADIUS_M, "{row:?}");
        }
    }
    let [first, last] = [outcome.rows.first(), outcome.rows.last()].map(Option::unwrap);
    // It jumps into contact under no load, and under the pull it only touches.
    assert_eq!(first.load_n, 0.0);
    assert!(first.contact_radius_m > 0.0);
    assert!((last.load_n + PULL_OFF_N).abs() < 1e-14 * PULL_OFF_N);
    assert_eq!(last.contact_radius_m, 0.0);
    assert!(last.approach_m.unwrap() < 1e-5 * widest_m * widest_m / RADIUS_M);
    let further = history(vec![ramp(PULL_OFF_N), ramp(-1.01 * PULL_OFF_N)]);
    let refused = further.unwrap_err().to_string();
    assert!(refused.contains("comes off the surface at"), "{refused}");
}

#[test]
fn cycles_of_a_history_with_attraction_are_those_of_a_sweep() {
    let material = zener_material;
    let (mean, amplitude) = (0.2 * PULL_OFF_N, 0.9 * PULL_OFF_N);
    let sine = Segment::Sine {
        mean,
        amplitude,
        angular_frequency_rad_per_s: 1.0,
        phase_rad: 0.0,
        cycles: 12.0,
    };
    let outcome = followed(material(), vec![sine]);
    let last = outcome.cycles.last().unwrap().numbers.as_ref().unwrap();
    let own = sweep(material(), (mean, amplitude)).without_error_bars();
    let own = solved(own.springs(800).unwrap().attracted(WORK).unwrap());
    // Both take 200 steps of a second-order rule a cycle; twelve cycles after a solid of one time have settled.
    let off = last.analysis.energy_loss_j / own.analysis.energy_loss_j - 1.0;
    assert!(off.abs() < 1e-4, "{off:e}");
    let off = last.analysis.load_mean_n - own.analysis.load_mean_n;
    assert!(off.abs() < 1e-6 * PULL_OFF_N, "{off:e}");
}
