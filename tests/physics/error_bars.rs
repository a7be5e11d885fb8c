//! Error bars hold what they promise: over random cases the true error lies inside the bar nearly always, and the bar is not
//! much larger than the error.

use std::sync::Arc;

use crate::common::solids::Random;
use crate::common::{run_case, sweep_plan};
use contact_dma::indenter::{Cone, FlatPunch, Indenter, PowerLaw, Sphere};
use contact_dma::material::{Material, ModulusKind, Relaxation, RelaxationBranch};
use contact_dma::sweep::plan::SweepPlan;
use contact_dma::sweep::record::error_bars::Quantity;
use contact_dma::sweep::record::{CaseResult, Status};
use rayon::prelude::*;

/// One to three branches whose moduli add up to between a twentieth and a hundred times the equilibrium modulus.
fn material(random: &mut Random) -> Material {
    let count = 1 + (3.0 * random.unit()) as usize;
    let ratio = random.power_of_ten(-1.3, 2.0);
    let branches = (0..count)
        .map(|i| RelaxationBranch {
            modulus_pa: 1e8 * ratio / count as f64,
            // About a decade apart, anywhere in it.
            time_s: 10_f64.powf(i as f64 + random.between(-0.4, 0.4)),
        })
        .collect();
    let relaxation = Relaxation::new(1e8, branches).unwrap();
    Material::from_relaxation(relaxation, ModulusKind::Longitudinal, 0.4).unwrap()
}

fn shape(random: &mut Random) -> Arc<dyn Indenter> {
    match (4.0 * random.unit()) as usize {
        0 => Arc::new(Sphere::new(0.01).unwrap()),
        1 => Arc::new(Cone::new(1.2).unwrap()),
        2 => Arc::new(FlatPunch::new(1e-3).unwrap()),
        _ => Arc::new(PowerLaw::new(random.between(1.2, 4.0), 1e-3, 1e-4).unwrap()),
    }
}

/// A random case: the plan, and the angular frequency.
fn case(random: &mut Random) -> (SweepPlan, f64) {
    let mean_n = random.power_of_ten(-1.0, 2.0);
    let amplitude_n = mean_n * random.power_of_ten(-2.0, 0.0);
    let plan = sweep_plan(material(random), shape(random), mean_n, amplitude_n);
    (plan, random.power_of_ten(-3.5, 3.0))
}

/// What a plan comes to in so many steps and springs; `None` where the contact does not stay a disc, which springs refuse.
fn solved(
    plan: &SweepPlan,
    omega: f64,
    (steps, springs): (usize, usize),
    tolerance: f64,
    error_bars: bool,
) -> Option<CaseResult> {
    let mut plan = plan.clone();
    plan.cycle.steps = steps;
    plan.cycle.tolerance = tolerance;
    plan.cycle.error_bars = error_bars;
    plan.solver.springs = springs;
    let record = run_case(&plan, omega);
    let disc = record
        .message
        .as_deref()
        .is_none_or(|m| !m.contains("disc"));
    assert_eq!(
        record.status == Status::Converged,
        disc,
        "{:?}",
        record.message
    );
    record.result
}

/// Bar over true error of every quantity.
fn ratios(plan: &SweepPlan, omega: f64) -> Option<Vec<(Quantity, f64)>> {
    let found = solved(plan, omega, (100, 200), 1e-4, true)?;
    let exact = solved(plan, omega, (400, 800), 1e-8, false)?;
    let errors = found.errors.as_ref().unwrap();
    let of = |quantity: Quantity| {
        // At second order, four times as fine is off by a sixteenth of the error itself.
        let error = (quantity.of(&found)? - quantity.of(&exact)?) * 16.0 / 15.0;
        Some((quantity, errors.of(quantity)? / error.abs()))
    };
    Some(Quantity::ALL.into_iter().filter_map(of).collect())
}

#[test]
fn the_true_error_lies_inside_the_bar_and_the_bar_is_not_much_larger() {
    let mut random = Random(2018);
    let cases: Vec<_> = (0..205).map(|_| case(&mut random)).collect();
    let found: Vec<_> = cases
        .par_iter()
        .filter_map(|(plan, omega)| ratios(plan, *omega))
        .collect();
    assert!(found.len() >= 200, "{} cases", found.len());
    for quantity in Quantity::ALL {
        let of = |ratios: &Vec<(Quantity, f64)>| {
            let found = ratios.iter().find(|(q, _)| *q == quantity)?;
            Some(found.1)
        };
        let mut ratios: Vec<f64> = found.iter().filter_map(of).collect();
        ratios.sort_by(f64::total_cmp);
        let inside = ratios.iter().filter(|r| **r >= 1.0).count() as f64;
        let share = inside / ratios.len() as f64;
        let median = ratios[ratios.len() / 2];
        println!("{quantity:?}: {share:.3} inside, median {median:.2}");
        assert!(share >= 0.95, "{quantity:?}: {share}");
        if quantity == Quantity::EnergyLoss {
            assert!(median <= 5.0, "median {median}");
        }
    }
}

#[test]
fn an_accuracy_asked_for_is_reached_and_not_much_exceeded() {
    let mut plan = sweep_plan(
        crate::common::pmma_material(),
        Arc::new(Sphere::new(0.01).unwrap()),
        10.0,
        5.0,
    );
    for omega in [1e-3, 0.0084, 0.5] {
        let exact = solved(&plan, omega, (1600, 1600), 1e-8, false).unwrap();
        let mut work = Vec::new();
        for accuracy in [1e-2, 1e-3, 1e-4] {
            plan.cycle.accuracy = Some(accuracy);
            let record = run_case(&plan, omega);
            let loss_j = record.energy_loss_j().unwrap();
            let bar = record.energy_loss_error_j().unwrap() / loss_j;
            let error = (loss_j / exact.analysis.energy_loss_j - 1.0).abs();
            println!(
                "{omega} rad/s: {accuracy:e} asked, bar {bar:.1e}, error {error:.1e}, {} steps, {} springs",
                record.steps, record.nodes
            );
            assert!(bar <= accuracy && error <= bar);
            work.push(record.steps * record.nodes);
        }
        plan.cycle.accuracy = None;
        // Two orders of accuracy cost one order of steps and one of springs at second order, times the factor that the
        // foretelling may be off by; never less for more.
        assert!(work[0] <= work[1] && work[1] < work[2]);
        assert!(work[2] < 200 * work[0], "{work:?}");
    }
}

#[test]
fn the_steps_of_the_plan_are_the_fewest_that_an_accuracy_takes() {
    let sphere = Arc::new(Sphere::new(0.01).unwrap());
    let mut plan = sweep_plan(crate::common::pmma_material(), sphere, 10.0, 5.0);
    plan.cycle.accuracy = Some(1e-2);
    for steps in [32, 500] {
        plan.cycle.steps = steps;
        let record = run_case(&plan, 0.0084);
        assert_eq!(record.status, Status::Converged);
        assert!(record.steps >= steps && record.steps < 200.max(2 * steps));
    }
}

#[test]
fn an_accuracy_out_of_reach_gives_no_number() {
    let mut plan = sweep_plan(
        crate::common::pmma_material(),
        Arc::new(Sphere::new(0.01).unwrap()),
        10.0,
        5.0,
    );
    plan.cycle.accuracy = Some(1e-8);
    let record = run_case(&plan, 0.0084);
    assert_eq!(record.status, Status::NotConverged);
    assert!(record.result.is_none());
    assert!(record.message.unwrap().contains("above the accuracy"));
}
