//! A material from a measured history: random solids are found again from creep, relaxation and a ramp with 1 % of noise, to within
//! their bands. `IDENTIFY=50 SEED=1 cargo test --release --test physics histories -- --nocapture` tries as many as asked for.

use crate::identified::{self, EXACT, Noise, found, inside, off_by, series_at};
use crate::prelude::*;
use contact_dma::identify::data::{Measurements, Reading};
use contact_dma::identify::{Driven, Identified, IdentifyError, IdentifyPlan};

const POISSON: f64 = 0.4;
/// Times measured, first and last, and how many, spread evenly over their logarithms.
const FIRST_S: f64 = 0.5;
const LAST_S: f64 = 1000.0;
const TIMES: usize = 60;

/// One to three branches with times within the window, a factor of eight apart at least; each of 20 to 300 % of the equilibrium modulus.
fn random_series(random: &mut Random) -> Relaxation {
    let count = random.count(1, 3);
    let times = loop {
        let mut times: Vec<f64> = (0..count).map(|_| random.between(0.2, 2.3)).collect();
        times.sort_by(f64::total_cmp);
        if times.windows(2).all(|pair| pair[1] - pair[0] > 0.9) {
            break times;
        }
    };
    series_at(random, times, (-0.7, 0.5))
}

/// A load or approach that is reached within a fifth of a second and held; the same with a second, lower hold.
fn held(control: Control, to: f64) -> SegmentedDrive {
    SegmentedDrive::new(control, vec![ramp(to, 0.2), ramp(to, LAST_S)]).unwrap()
}

fn in_two_holds(to: f64) -> SegmentedDrive {
    let (first, second) = ([ramp(to, 5.0), ramp(to, 100.0)], 0.4 * to);
    let segments = [&first[..], &[ramp(second, 5.0), ramp(second, LAST_S)]].concat();
    SegmentedDrive::new(Control::Load, segments).unwrap()
}

/// What is measured of a solid: the history computed on more springs than the identification has, with noise.
fn plan(
    truth: &Relaxation,
    (indenter, drive): (Arc<dyn Indenter>, SegmentedDrive),
    noise: Noise,
    random: &mut Random,
) -> IdentifyPlan {
    let material = material_of(truth.clone(), POISSON);
    let mut scenario = ScenarioPlan::new(material, Arc::clone(&indenter), drive.clone());
    let solver = IdentifyPlan::solver(indenter.as_ref(), false);
    if solver.engine == EngineKind::HalfSpace {
        scenario.solver = solver;
    }
    let times_s = log_spaced(FIRST_S, LAST_S, TIMES);
    let measured = identified::of_history(scenario, &times_s, noise, random);
    IdentifyPlan::new(POISSON, indenter, Driven::History(drive), measured)
}

/// Points of E' and E'' inside their bands, of how many; the largest relative error of E*, over the window of the times.
fn judged(truth: &Relaxation, found: &Identified) -> (usize, usize, f64) {
    let (low, high) = found.window_rad_per_s;
    let omegas = log_spaced(low, high, 25);
    let (inside, of) = inside(truth, found, &omegas);
    (inside, of, off_by(truth, found, &omegas))
}

#[test]
fn random_solids_are_found_from_creep_and_relaxation_with_noise() {
    let count = from_environment("IDENTIFY", 16);
    let seed = from_environment("SEED", 2018);
    let (mut inside, mut all, mut worst, mut too_many) = (0, 0, 0.0_f64, 0);
    for k in 0..count {
        let mut random = Random(seed + 1000 * k);
        let truth = random_series(&mut random);
        // Loads that press by some per cent of the radius.
        let load_n = 1e-8 * truth.equilibrium_modulus();
        let experiment = match k % 4 {
            0 => (sphere(1e-3), held(Control::Load, load_n)),
            1 => (sphere(1e-3), held(Control::Approach, 1e-5)),
            2 => (cone(1.2), held(Control::Load, load_n)),
            _ => (sphere(1e-3), in_two_holds(load_n)),
        };
        let noise = Noise::of(0.01, k % 2 == 0);
        let plan = plan(&truth, experiment, noise, &mut random);
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
    let truth = series(3e7, &[(2e7, 3.0), (1e7, 90.0)]);
    for (control, to) in [(Control::Load, 0.3), (Control::Approach, 1e-5)] {
        let experiment = (sphere(1e-3), held(control, to));
        let plan = plan(&truth, experiment, EXACT, &mut Random(1));
        let found = found(&plan).unwrap();
        // 64 springs in place of 400.
        below!(judged(&truth, &found).2, 2e-3, "{control:?}");
        assert_eq!(found.relaxation.branches().len(), 2);
    }
}

#[test]
fn cells_find_the_solid_as_springs_do() {
    let truth = series(1e7, &[(2e7, 10.0)]);
    let ellipsoid: Arc<dyn Indenter> = Arc::new(Ellipsoid::new(1e-3, 2e-3).unwrap());
    let experiment = (ellipsoid, held(Control::Load, 0.1));
    let noise = Noise::of(0.01, true);
    let mut plan = plan(&truth, experiment, noise, &mut Random(3));
    plan.branches = Some(1);
    let (inside, all, worst) = judged(&truth, &found(&plan).unwrap());
    assert!(10 * inside >= 9 * all, "{inside} of {all}");
    below!(worst, 0.02);
}

#[test]
fn a_history_that_never_changes_and_one_that_no_solid_has_are_refused() {
    let drive = SegmentedDrive::new(Control::Load, vec![step(0.1, 100.0)]).unwrap();
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
    let indenter = sphere(1e-3);
    let measurements = Measurements::of_history(&drive, &rows(|t| 1e-6 / t)).unwrap();
    let mut plan = IdentifyPlan::new(POISSON, indenter, Driven::History(drive), measurements);
    plan.solver.springs = 40;
    let told = found(&plan);
    assert!(matches!(told, Err(IdentifyError::Contradiction { .. })));
}
