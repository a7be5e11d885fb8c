//! A material from measured cycles: random solids are found again from losses and phases with 1 % of noise, to within their bands.
//!
//! `IDENTIFY=50 SEED=1 cargo test --release --test physics identification -- --nocapture` tries as many as asked for, and prints what
//! the guide quotes; without it a few are tried.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use crate::common::from_environment;
use crate::common::solids::Random;
use contact_dma::drive::HarmonicDrive;
use contact_dma::engine::{EngineKind, SolverPlan};
use contact_dma::identify::data::{Datum, Measurements, Number};
use contact_dma::identify::{Driven, Identified, IdentifyError, IdentifyPlan, identify};
use contact_dma::indenter::{Cone, Indenter, Sphere};
use contact_dma::material::{Material, ModulusKind, Relaxation, RelaxationBranch};
use contact_dma::sweep::Sweep;
use contact_dma::sweep::plan::{CyclePlan, SweepPlan};

const POISSON: f64 = 0.35;

/// Twelve frequencies over five decades about 1 rad/s.
fn frequencies() -> Vec<f64> {
    (0..12)
        .map(|k| 10_f64.powf(5.0 * f64::from(k) / 11.0 - 2.5))
        .collect()
}

/// One to four branches with times within the band, a factor of five apart at least; each of 10 to 1000 % of the equilibrium modulus.
fn solid(random: &mut Random) -> Relaxation {
    let count = random.count(1, 4);
    let mut times: Vec<f64> = Vec::new();
    while times.len() < count {
        let time = random.between(-2.3, 2.3);
        if times.iter().all(|other| (time - other).abs() > 0.7) {
            times.push(time);
        }
    }
    let equilibrium_pa = random.power_of_ten(5.0, 9.0);
    let branches = times.into_iter().map(|time| RelaxationBranch {
        modulus_pa: equilibrium_pa * random.power_of_ten(-1.0, 1.0),
        time_s: 10_f64.powf(time),
    });
    Relaxation::new(equilibrium_pa, branches.collect()).unwrap()
}

/// What is measured, and how well.
struct Experiment {
    quantities: Vec<Number>,
    noise: f64,
    with_errors: bool,
}

impl Experiment {
    fn losses_and_phases(noise: f64, with_errors: bool) -> Self {
        Self {
            quantities: vec![Number::EnergyLoss, Number::PhaseLag],
            noise,
            with_errors,
        }
    }

    /// The plan of an identification of cycles computed far finer than it will compute them.
    fn plan(
        &self,
        truth: &Relaxation,
        (indenter, drive): (Arc<dyn Indenter>, HarmonicDrive),
        resolution: Option<(CyclePlan, SolverPlan)>,
        random: &mut Random,
    ) -> IdentifyPlan {
        let material =
            Material::from_relaxation(truth.clone(), ModulusKind::Longitudinal, POISSON).unwrap();
        let mut sweep = SweepPlan::new(material, Arc::clone(&indenter), drive);
        (
            sweep.cycle.steps,
            sweep.cycle.tolerance,
            sweep.solver.springs,
        ) = (200, 1e-6, 200);
        sweep.cycle.error_bars = false;
        if let Some((cycle, solver)) = resolution {
            (sweep.cycle, sweep.solver) = (cycle, solver);
        }
        let sweep = Sweep::from(sweep)
            .angular_frequencies_rad_per_s(frequencies())
            .unwrap();
        let records = sweep.solve().unwrap().records;
        let mut data = Vec::new();
        for (row, record) in (1..).zip(&records) {
            for quantity in &self.quantities {
                let exact = quantity.of(record.result.as_ref().unwrap()).unwrap();
                data.push(Datum {
                    place: record.angular_frequency_rad_per_s,
                    drive: Some(drive),
                    row,
                    number: *quantity,
                    value: exact * (1.0 + self.noise * random.normal()),
                    error: self.with_errors.then_some(self.noise * exact),
                });
            }
        }
        let measurements = Measurements::new(data).unwrap();
        IdentifyPlan::new(POISSON, indenter, Driven::Cycles(drive), measurements)
    }
}

fn sphere() -> (Arc<dyn Indenter>, HarmonicDrive) {
    (
        Arc::new(Sphere::new(0.01).unwrap()),
        HarmonicDrive::load(10.0, 5.0).unwrap(),
    )
}

fn found(plan: &IdentifyPlan) -> Result<Identified, IdentifyError> {
    identify(plan, &AtomicBool::new(false))
}

/// Points of E' and E'' inside their bands, of how many; the largest relative error of E*.
fn against(truth: &Relaxation, found: &Identified) -> (usize, usize, f64) {
    let (mut inside, mut worst) = (0, 0.0_f64);
    let omegas = frequencies();
    for omega in &omegas {
        let exact = truth.complex_modulus(*omega);
        let band = found.band(*omega);
        let within = |own: f64, exact: f64, factor: f64| (own / exact).ln().abs() <= factor.ln();
        inside += usize::from(within(band.storage_pa, exact.re, band.storage_factor));
        inside += usize::from(within(band.loss_pa, exact.im, band.loss_factor));
        let off = found.relaxation.complex_modulus(*omega) - exact;
        worst = worst.max(off.norm() / exact.norm());
    }
    (inside, 2 * omegas.len(), worst)
}

#[test]
fn random_solids_are_found_within_their_bands_from_losses_and_phases_with_noise() {
    found_within_their_bands(sphere(), from_environment("IDENTIFY", 24));
}

#[test]
fn and_so_they_are_under_a_prescribed_approach() {
    let (indenter, _) = sphere();
    let drive = HarmonicDrive::approach(2e-5, 1e-5).unwrap();
    found_within_their_bands((indenter, drive), from_environment("IDENTIFY", 8));
}

fn found_within_their_bands(of: (Arc<dyn Indenter>, HarmonicDrive), solids: u64) {
    let seed = from_environment("SEED", 2018);
    let (mut inside, mut all, mut too_many, mut far, mut failed) = (0, 0, 0, 0_u64, 0);
    for number in 0..solids {
        let mut random = Random(seed.wrapping_mul(1_000_003).wrapping_add(number));
        let truth = solid(&mut random);
        let experiment = Experiment::losses_and_phases(0.01, number % 2 == 0);
        let plan = experiment.plan(&truth, of.clone(), None, &mut random);
        let start = Instant::now();
        let found = match found(&plan) {
            Ok(found) => found,
            Err(error) => {
                println!("{number}: {error}\n{truth:?}");
                failed += 1;
                continue;
            }
        };
        let seconds = start.elapsed().as_secs_f64();
        let (within, of, worst) = against(&truth, &found);
        (inside, all) = (inside + within, all + of);
        let branches = [truth.branches().len(), found.relaxation.branches().len()];
        too_many += usize::from(branches[1] > branches[0]);
        far += u64::from(worst > 0.03);
        println!(
            "{number}: {} of {} branches, {within} of {of} inside, off by {:.2} % at most, chi squared {:.2}, {seconds:.1} s",
            branches[1],
            branches[0],
            100.0 * worst,
            found.reduced_chi_squared
        );
        assert!(seconds < 20.0, "solid {number} took {seconds} s");
    }
    println!(
        "inside {inside} of {all}; {too_many} with too many branches; {far} off by more than 3 %"
    );
    assert!(
        inside as f64 >= 0.9 * f64::from(all as u32),
        "{inside} of {all}"
    );
    assert_eq!(failed, 0);
    // One of fifty under a prescribed approach, whose contact opens in most cycles, has a twin that fits as well.
    assert!(50 * far <= solids, "{far} of {solids}");
    // Where the noise has to be estimated, one solid of fifty gets a branch too many.
    assert!(50 * too_many <= solids as usize, "{too_many} of {solids}");
}

#[test]
fn exact_cycles_give_the_solid_back() {
    for seed in 0..3 {
        let mut random = Random(77 + seed);
        let truth = solid(&mut random);
        let experiment = Experiment::losses_and_phases(0.0, false);
        let (indenter, drive) = sphere();
        // As coarse as the model begins with, which it takes for exact: off by the error of that resolution. And far finer, 200 steps and
        // springs in place of 64: off by what its correction of second order leaves.
        let own = (
            IdentifyPlan::CYCLE,
            IdentifyPlan::solver(indenter.as_ref(), false),
        );
        for (resolution, within) in [(Some(own), 1e-3), (None, 2e-4)] {
            let under = (Arc::clone(&indenter), drive);
            let plan = experiment.plan(&truth, under, resolution, &mut random);
            let found = found(&plan).unwrap();
            let (_, _, worst) = against(&truth, &found);
            let branches = [truth.branches().len(), found.relaxation.branches().len()];
            println!("{seed}: {branches:?}, off by {worst:.1e}");
            assert_eq!(branches[0], branches[1]);
            assert!(worst < within, "{worst:e}");
        }
    }
}

#[test]
fn other_columns_other_shapes_and_a_prescribed_approach_serve_as_well() {
    let cone: Arc<dyn Indenter> = Arc::new(Cone::new(1.2).unwrap());
    let under_load = HarmonicDrive::load(10.0, 8.0).unwrap();
    let under_approach = HarmonicDrive::approach(2e-5, 1e-5).unwrap();
    let (indenter, _) = sphere();
    use Number::{
        ApproachMax, ContactRadiusMax, EnergyLoss, LossModulus, PhaseLag, StorageModulus,
    };
    let cases = [
        (&indenter, under_load, vec![EnergyLoss, ApproachMax]),
        (&cone, under_load, vec![EnergyLoss, PhaseLag]),
        (&indenter, under_approach, vec![EnergyLoss, PhaseLag]),
        (
            &indenter,
            under_load,
            vec![StorageModulus, LossModulus, ContactRadiusMax],
        ),
    ];
    let (mut inside, mut all) = (0, 0);
    for (number, (indenter, drive, quantities)) in cases.into_iter().enumerate() {
        let mut random = Random(500 + number as u64);
        let truth = solid(&mut random);
        let experiment = Experiment {
            quantities,
            noise: 0.005,
            with_errors: number % 2 == 1,
        };
        let plan = experiment.plan(&truth, (Arc::clone(indenter), drive), None, &mut random);
        let found = found(&plan).unwrap();
        let (within, of, worst) = against(&truth, &found);
        (inside, all) = (inside + within, all + of);
        let branches = [truth.branches().len(), found.relaxation.branches().len()];
        println!("{number}: {branches:?}, {within} of {of} inside, off by {worst:.1e}");
        assert!(branches[1] <= branches[0]);
    }
    // Bands of 95 %, whose points of one solid go together: of four solids one may be off.
    assert!(4 * inside >= 3 * all, "{inside} of {all}");
}

#[test]
fn cells_serve_as_springs_do() {
    let branch = RelaxationBranch {
        modulus_pa: 3e7,
        time_s: 0.7,
    };
    let truth = Relaxation::new(1e7, vec![branch]).unwrap();
    let (indenter, drive) = sphere();
    let cycle = CyclePlan {
        steps: 24,
        ..IdentifyPlan::CYCLE
    };
    let solver = SolverPlan {
        engine: EngineKind::HalfSpace,
        cells: 16,
        ..IdentifyPlan::solver(indenter.as_ref(), false)
    };
    let experiment = Experiment::losses_and_phases(0.0, false);
    let resolution = Some((cycle, solver));
    let mut plan = experiment.plan(&truth, (indenter, drive), resolution, &mut Random(1));
    (plan.cycle, plan.solver, plan.branches) = (cycle, solver, Some(1));
    let found = found(&plan).unwrap();
    let (_, _, worst) = against(&truth, &found);
    println!("cells: off by {worst:.1e}");
    // The same cells made the data: what is left are cells that enter and leave the contact under the steps of the derivatives.
    assert!(worst < 3e-3, "{worst:e}");
}

#[test]
fn what_the_data_leave_open_is_named() {
    // A branch a hundred times slower than the slowest cycle shows as a slope of the loss, g / (omega tau), and nothing else.
    let slow = RelaxationBranch {
        modulus_pa: 4e8,
        time_s: 2e4,
    };
    let fast = RelaxationBranch {
        modulus_pa: 2e8,
        time_s: 1.0,
    };
    let truth = Relaxation::new(1e8, vec![slow, fast]).unwrap();
    let experiment = Experiment::losses_and_phases(0.01, true);
    let mut plan = experiment.plan(&truth, sphere(), None, &mut Random(3));
    plan.branches = Some(2);
    let found = found(&plan).unwrap();
    println!("{:#?} {:?}", found.undetermined, found.unknowns);
    assert!(!found.undetermined.is_empty());
    let open = &found.undetermined.last().unwrap().parts;
    assert!(open.iter().any(|(name, _)| name == "tau_2"), "{open:?}");
    assert!(found.unknowns.iter().any(|unknown| !unknown.is_determined));
    // The fast branch is known all the same.
    assert!(found.unknowns[2].is_determined && (found.unknowns[2].value - 1.0).abs() < 0.1);
}
