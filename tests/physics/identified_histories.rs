//! A material from a measured history: random solids are found again from creep, relaxation and a ramp with 1 % of noise, to within
//! their bands. `IDENTIFY=50 SEED=1 cargo test --release --test physics histories -- --nocapture` tries as many as asked for.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::common::from_environment;
use crate::common::solids::Random;
use contact_dma::engine::EngineKind;
use contact_dma::identify::data::{Measurements, Reading};
use contact_dma::identify::{Driven, Identified, IdentifyError, IdentifyPlan, identify};
use contact_dma::prelude::*;
use contact_dma::simulation::between::values_at;

const POISSON: f64 = 0.4;
/// Times measured, first and last, and how many, spread evenly over their logarithms.
const FIRST_S: f64 = 0.5;
const LAST_S: f64 = 1000.0;
const TIMES: usize = 60;

/// One to three branches with times within the window, a factor of eight apart at least; each of 20 to 300 % of the equilibrium modulus.
fn solid(random: &mut Random) -> Relaxation {
    let count = random.count(1, 3);
    let times = loop {
        let mut times: Vec<f64> = (0..count).map(|_| random.between(0.2, 2.3)).collect();
        times.sort_by(f64::total_cmp);
        if times.windows(2).all(|pair| pair[1] - pair[0] > 0.9) {
            break times;
        }
    };
    let equilibrium_pa = random.power_of_ten(5.0, 9.0);
    let branches = times.into_iter().map(|time| RelaxationBranch {
        modulus_pa: equilibrium_pa * random.power_of_ten(-0.7, 0.5),
        time_s: 10_f64.powf(time),
    });
    Relaxation::new(equilibrium_pa, branches.collect()).unwrap()
}

fn ramp(to: f64, duration_s: f64) -> Segment {
    Segment::Ramp { to, duration_s }
}

/// A load or approach that is reached within a fifth of a second and held; the same with a second, lower hold.
fn held(control: Control, to: f64) -> SegmentedDrive {
    SegmentedDrive::new(control, vec![ramp(to, 0.2), ramp(to, LAST_S)]).unwrap()
}

fn in_two_holds(to: f64) -> SegmentedDrive {
    let segments = vec![
        ramp(to, 5.0),
        ramp(to, 100.0),
        ramp(0.4 * to, 5.0),
        ramp(0.4 * to, LAST_S),
    ];
    SegmentedDrive::new(Control::Load, segments).unwrap()
}

/// What is measured of a solid: the history computed on more springs than the identification has, with noise.
fn plan(
    truth: &Relaxation,
    (indenter, drive): (Arc<dyn Indenter>, SegmentedDrive),
    (noise, with_errors): (f64, bool),
    random: &mut Random,
) -> IdentifyPlan {
    let kind = ModulusKind::Longitudinal;
    let material = Material::from_relaxation(truth.clone(), kind, POISSON).unwrap();
    let mut scenario = ScenarioPlan::new(material, Arc::clone(&indenter), drive.clone());
    scenario.output.error_bars = false;
    let solver = IdentifyPlan::solver(indenter.as_ref(), false);
    if solver.engine == EngineKind::HalfSpace {
        scenario.solver = solver;
    }
    let outcome = Simulation::new(scenario).unwrap();
    let outcome = outcome.run(&AtomicBool::new(false), &|_, _| {});
    let ratio = (LAST_S / FIRST_S).powf(1.0 / (TIMES - 1) as f64);
    let times: Vec<f64> = (0..TIMES).map(|k| FIRST_S * ratio.powi(k as i32)).collect();
    let value = match drive.control() {
        Control::Load => |row: &contact_dma::simulation::HistoryRow| row.approach_m,
        Control::Approach => |row: &contact_dma::simulation::HistoryRow| Some(row.load_n),
    };
    let exact = values_at(&drive, &outcome.rows, &times, value);
    let readings = times
        .iter()
        .zip(exact)
        .enumerate()
        .map(|(row, (time_s, exact))| {
            let exact = exact.unwrap();
            Reading {
                row: row + 1,
                time_s: *time_s,
                value: exact * (1.0 + noise * random.normal()),
                error: with_errors.then_some(noise * exact),
            }
        });
    let readings: Vec<Reading> = readings.collect();
    let measurements = Measurements::of_history(&drive, &readings).unwrap();
    IdentifyPlan::new(POISSON, indenter, Driven::History(drive), measurements)
}

fn found(plan: &IdentifyPlan) -> Result<Identified, IdentifyError> {
    identify(plan, &AtomicBool::new(false))
}

/// Points of E' and E'' inside their bands, of how many; the largest relative error of E*, over the window of the times.
fn judged(truth: &Relaxation, found: &Identified) -> (usize, usize, f64) {
    let (mut inside, mut all, mut worst) = (0, 0, 0.0_f64);
    let (low, high) = found.window_rad_per_s;
    for k in 0..=24 {
        let omega = low * (high / low).powf(f64::from(k) / 24.0);
        let exact = truth.complex_modulus(omega);
        let band = found.band(omega);
        let is_inside = |own: f64, factor: f64, exact: f64| (exact / own).ln().abs() <= factor.ln();
        inside += usize::from(is_inside(band.storage_pa, band.storage_factor, exact.re));
        inside += usize::from(is_inside(band.loss_pa, band.loss_factor, exact.im));
        all += 2;
        let apart = (band.storage_pa - exact.re).hypot(band.loss_pa - exact.im);
        worst = worst.max(apart / exact.norm());
    }
    (inside, all, worst)
}

#[test]
fn random_solids_are_found_from_creep_and_relaxation_with_noise() {
    let count = from_environment("IDENTIFY", 16);
    let seed = from_environment("SEED", 2018);
    let (mut inside, mut all, mut worst, mut too_many) = (0, 0, 0.0_f64, 0);
    for k in 0..count {
        let mut random = Random(seed + 1000 * k);
        let truth = solid(&mut random);
        let sphere: Arc<dyn Indenter> = Arc::new(Sphere::new(1e-3).unwrap());
        let cone: Arc<dyn Indenter> = Arc::new(Cone::new(1.2).unwrap());
        // Loads that press by some per cent of the radius.
        let load_n = 1e-8 * truth.equilibrium_modulus();
        let experiment = match k % 4 {
            0 => (sphere, held(Control::Load, load_n)),
            1 => (sphere, held(Control::Approach, 1e-5)),
            2 => (cone, held(Control::Load, load_n)),
            _ => (sphere, in_two_holds(load_n)),
        };
        let plan = plan(&truth, experiment, (0.01, k % 2 == 0), &mut random);
        let found = found(&plan).unwrap_or_else(|error| panic!("{k}: {error}"));
        let (of_inside, of_all, of_worst) = judged(&truth, &found);
        let branches = found.relaxation.branches().len();
        println!(
            "{k}: {of_inside} of {of_all}, worst {of_worst:.4}, branches {branches} of {}, chi2 {:.2}",
            truth.branches().len(),
            found.reduced_chi_squared
        );
        inside += of_inside;
        all += of_all;
        worst = worst.max(of_worst);
        too_many += usize::from(branches > truth.branches().len());
    }
    println!("{inside} of {all} inside, worst {worst:.4}, {too_many} with too many branches");
    assert!(inside as f64 >= 0.9 * all as f64, "{inside} of {all}");
    assert!(worst < 0.1, "{worst}");
    assert!(too_many as f64 <= 0.05 * count as f64);
}

#[test]
fn exact_data_give_the_solid_back() {
    let branches = vec![
        RelaxationBranch {
            modulus_pa: 2e7,
            time_s: 3.0,
        },
        RelaxationBranch {
            modulus_pa: 1e7,
            time_s: 90.0,
        },
    ];
    let truth = Relaxation::new(3e7, branches).unwrap();
    let sphere: Arc<dyn Indenter> = Arc::new(Sphere::new(1e-3).unwrap());
    for (control, to) in [(Control::Load, 0.3), (Control::Approach, 1e-5)] {
        let mut random = Random(1);
        let experiment = (Arc::clone(&sphere), held(control, to));
        let plan = plan(&truth, experiment, (0.0, false), &mut random);
        let found = found(&plan).unwrap();
        let (_, _, worst) = judged(&truth, &found);
        // 64 springs in place of 400.
        assert!(
            worst < 2e-3 && found.relaxation.branches().len() == 2,
            "{control:?}: {worst:e}"
        );
    }
}

#[test]
fn cells_find_the_solid_as_springs_do() {
    let branch = RelaxationBranch {
        modulus_pa: 2e7,
        time_s: 10.0,
    };
    let truth = Relaxation::new(1e7, vec![branch]).unwrap();
    let ellipsoid: Arc<dyn Indenter> = Arc::new(Ellipsoid::new(1e-3, 2e-3).unwrap());
    let mut random = Random(3);
    let experiment = (ellipsoid, held(Control::Load, 0.1));
    let mut plan = plan(&truth, experiment, (0.01, true), &mut random);
    plan.branches = Some(1);
    let found = found(&plan).unwrap();
    let (inside, all, worst) = judged(&truth, &found);
    assert!(
        inside as f64 >= 0.9 * all as f64 && worst < 0.02,
        "{inside} {all} {worst}"
    );
}

#[test]
fn a_history_that_never_changes_and_one_that_no_solid_has_are_refused() {
    let drive = SegmentedDrive::new(
        Control::Load,
        vec![Segment::Step {
            to: 0.1,
            duration_s: 100.0,
        }],
    );
    let drive = drive.unwrap();
    let rows = |value: fn(f64) -> f64| -> Vec<Reading> {
        let row = |k: usize| Reading {
            row: k + 1,
            time_s: 1.0 + k as f64,
            value: value(1.0 + k as f64),
            error: None,
        };
        (0..40).map(row).collect()
    };
    let flat = Measurements::of_history(&drive, &rows(|_| 1e-6));
    assert!(matches!(flat, Err(IdentifyError::Flat { .. })));
    // A surface that comes up under a constant load.
    let indenter: Arc<dyn Indenter> = Arc::new(Sphere::new(1e-3).unwrap());
    let measurements = Measurements::of_history(&drive, &rows(|t| 1e-6 / t)).unwrap();
    let mut plan = IdentifyPlan::new(POISSON, indenter, Driven::History(drive), measurements);
    plan.solver.springs = 40;
    assert!(matches!(
        found(&plan),
        Err(IdentifyError::Contradiction { .. })
    ));
}
