//! A sphere that is attracted, by the theory of Derjaguin, Muller and Toporov: closed forms of Hertz under the load and the attraction.

use crate::prelude::*;
use contact_dma::drive::HistoryError;
use contact_dma::simulation::SimulationOutcome;

const RADIUS_M: f64 = 1e-6;
const WORK: f64 = 0.05;
/// 2 pi w R.
const PULL_OFF_N: f64 = TAU * WORK * RADIUS_M;
const DMT: AdhesionPlan = AdhesionPlan {
    work_j_per_m2: WORK,
    range_m: None,
    stress_pa: None,
    model: AdhesionModel::Dmt,
};

fn sweep(material: Material, (mean_n, amplitude_n): (f64, f64)) -> Sweep {
    let drive = HarmonicDrive::load(mean_n, amplitude_n).unwrap();
    Sweep::new(material, ball(RADIUS_M), drive)
}

/// At 1 rad/s.
fn at_one(sweep: Sweep) -> CaseResult {
    solved(sweep, 1.0)
}

/// An elastic solid, and the contact that it makes under the load and the attraction together.
fn elastic() -> Material {
    solid(3e9, &[], 0.4)
}

fn hertz(load_n: f64) -> Hertz {
    Hertz {
        radius_m: RADIUS_M,
        load_n: load_n + PULL_OFF_N,
        compliance_per_pa: (1.0 - 0.16) / 3e9,
    }
}

/// Contact radius and approach under a load on 800 springs over the widest contact: their width is what a radius is known to.
fn assert_hertz(load_n: f64, radius_m: f64, approach_m: Option<f64>, largest_n: f64) {
    let (exact, widest) = (hertz(load_n), hertz(largest_n));
    let spacing_m = widest.contact_radius_m() / 800.0;
    below!((radius_m - exact.contact_radius_m()).abs(), 1.5 * spacing_m);
    if let Some(approach_m) = approach_m {
        let off_m = (approach_m - exact.approach_m()).abs();
        below!(off_m, 1e-5 * widest.approach_m(), "{load_n:e} N");
    }
}

#[test]
fn radius_and_approach_are_those_of_hertz_with_the_attraction_down_to_the_pull_off_load() {
    // Down to no load, half of the pull, and nearly all of it.
    for part in [0.0, 0.5, 0.999] {
        let amplitude_n = PULL_OFF_N;
        let mean_n = amplitude_n - part * PULL_OFF_N;
        let sweep = sweep(elastic(), (mean_n, amplitude_n)).without_error_bars();
        let result = at_one(sweep.springs(800).unwrap().attracted(DMT).unwrap());
        let samples = &result.cycle.samples;
        let load_n = &samples.load_n;
        for (k, load_n) in load_n.iter().enumerate() {
            let (radius_m, approach_m) = (samples.contact_radius_m[k], samples.approach_m[k]);
            assert_hertz(*load_n, radius_m, Some(approach_m), mean_n + amplitude_n);
        }
        let least_n = load_n.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((least_n + part * PULL_OFF_N).abs() < 1e-3 * PULL_OFF_N);
        assert_eq!(result.contact_duty.part, 1.0);
        assert_eq!(result.loss_j(), 0.0);
    }
}

#[test]
fn the_loop_is_that_of_the_load_and_the_attraction_together() {
    let (mean_n, amplitude_n) = (0.2 * PULL_OFF_N, 0.9 * PULL_OFF_N);
    let attracted = sweep(zener_material(), (mean_n, amplitude_n)).attracted(DMT);
    let attracted = at_one(attracted.unwrap());
    let pressed = at_one(sweep(zener_material(), (mean_n + PULL_OFF_N, amplitude_n)));
    let (one, other) = (&attracted.analysis, &pressed.analysis);
    // But for the rounding of one load taken off another.
    near!(one.energy_loss_j, other.energy_loss_j, 1e-12);
    near!(one.phase_lag_rad, other.phase_lag_rad, 1e-12);
    assert!((one.load_mean_n - mean_n).abs() < 1e-12 * PULL_OFF_N);
    assert!((other.load_mean_n - one.load_mean_n - PULL_OFF_N).abs() < 1e-12 * PULL_OFF_N);
    assert!((attracted.approach_m.maximum / pressed.approach_m.maximum - 1.0).abs() < 1e-12);
    // The attraction is constant and dissipates nothing.
    let off_j = attracted.dissipated_j() - attracted.loss_j();
    below!(off_j.abs(), attracted.bar_j());
    let cells = sweep(zener_material(), (mean_n, amplitude_n)).cells(64);
    let cells = at_one(cells.unwrap().attracted(DMT).unwrap());
    let apart_j = (cells.loss_j() - attracted.loss_j()).abs();
    below!(apart_j, attracted.bar_j() + cells.bar_j());
    assert!(attracted.tabor_parameter().is_some() && pressed.tabor_parameter().is_none());
}

#[test]
fn a_load_below_the_pull_off_load_and_what_has_none_are_refused() {
    let of = |mean_n: f64, amplitude_n: f64| sweep(elastic(), (mean_n, amplitude_n));
    let told = |sweep: Sweep| sweep.attracted(DMT).unwrap_err().to_string();
    assert!(told(of(0.1 * PULL_OFF_N, 1.2 * PULL_OFF_N)).contains("comes off"));
    let drive = HarmonicDrive::load(1.0, 0.5).unwrap();
    let cone = Sweep::new(elastic(), Cone::new(1.2).unwrap(), drive);
    assert!(told(cone).contains("sphere"));
    let approach = HarmonicDrive::approach(1e-9, 5e-10).unwrap();
    let approach = Sweep::new(elastic(), ball(RADIUS_M), approach);
    assert!(told(approach).contains("prescribed load"));
    for work in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let dmt = AdhesionPlan {
            work_j_per_m2: work,
            ..DMT
        };
        assert!(of(1e-6, 1e-7).attracted(dmt).is_err(), "{work}");
    }
}

fn history(segments: Vec<Segment>) -> Result<SegmentedDrive, HistoryError> {
    SegmentedDrive::attracted(Control::Load, segments, PULL_OFF_N)
}

/// Attracted from the beginning of a history on.
fn attracted(material: Material, segments: Vec<Segment>) -> SimulationOutcome {
    let drive = history(segments).unwrap();
    let mut plan = ScenarioPlan::new(material, sphere(RADIUS_M), drive);
    plan.contact.adhesion = Some(DMT);
    (plan.solver.springs, plan.output.error_bars) = (800, false);
    simulated(plan)
}

#[test]
fn a_history_is_that_of_hertz_with_the_attraction_from_first_touch_to_pull_off() {
    let outcome = attracted(
        elastic(),
        vec![ramp(PULL_OFF_N, 2.0), ramp(-PULL_OFF_N, 2.0)],
    );
    for row in &outcome.rows {
        assert_hertz(row.load_n, row.contact_radius_m, row.approach_m, PULL_OFF_N);
    }
    let [first, last] = [outcome.rows.first(), outcome.rows.last()].map(Option::unwrap);
    // It jumps into contact under no load, and under the pull it only touches.
    assert_eq!(first.load_n, 0.0);
    assert!(first.contact_radius_m > 0.0);
    assert!((last.load_n + PULL_OFF_N).abs() < 1e-14 * PULL_OFF_N);
    assert_eq!(last.contact_radius_m, 0.0);
    assert!(last.approach_m.unwrap() < 1e-5 * hertz(PULL_OFF_N).approach_m());
    let further = history(vec![ramp(PULL_OFF_N, 2.0), ramp(-1.01 * PULL_OFF_N, 2.0)]);
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
    let outcome = attracted(material(), vec![sine]);
    let last = outcome.cycles.last().unwrap().numbers.as_ref().unwrap();
    let own = sweep(material(), (mean, amplitude)).without_error_bars();
    let own = at_one(own.springs(800).unwrap().attracted(DMT).unwrap());
    // Both take 200 steps of a second-order rule a cycle; twelve cycles after a solid of one time have settled.
    near!(last.analysis.energy_loss_j, own.loss_j(), 1e-4);
    let off_n = last.analysis.load_mean_n - own.analysis.load_mean_n;
    below!(off_n.abs(), 1e-6 * PULL_OFF_N);
}
