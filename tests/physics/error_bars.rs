//! Error bars hold what they promise: over random cases the true error lies inside the bar nearly always, and the bar is not
//! much larger than the error.

use crate::common::bars::{self, Judged};
use crate::common::solids::spread_solid;
use crate::prelude::*;

/// One to three branches about a decade apart, whose moduli add up to between a twentieth and a hundred times the equilibrium modulus.
fn material(random: &mut Random) -> Material {
    let count = 1 + (3.0 * random.unit()) as usize;
    let ratio = random.power_of_ten(-1.3, 2.0);
    spread_solid(random, count, (1e8, ratio), (1.0, 0.4))
}

fn shape(random: &mut Random) -> Arc<dyn Indenter> {
    match (4.0 * random.unit()) as usize {
        0 => sphere(0.01),
        1 => cone(1.2),
        2 => punch(1e-3),
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
    (plan.cycle.steps, plan.cycle.tolerance) = (steps, tolerance);
    (plan.cycle.error_bars, plan.solver.springs) = (error_bars, springs);
    let record = run_case(&plan, omega);
    let message = record.message.as_deref();
    let disc = message.is_none_or(|m| !m.contains("disc"));
    assert_eq!(record.status == Status::Converged, disc, "{message:?}");
    record.result
}

/// Bars over errors: at second order, four times as fine is off by a sixteenth of the error itself.
fn judged(plan: &SweepPlan, omega: f64) -> Option<Judged> {
    let found = solved(plan, omega, (100, 200), 1e-4, true)?;
    let exact = solved(plan, omega, (400, 800), 1e-8, false)?;
    let mut judged = Judged::new(&found, &exact, format!("{omega:e} rad/s, {plan:?}"));
    for (_, ratio) in &mut judged.ratios {
        *ratio *= 15.0 / 16.0;
    }
    Some(judged)
}

#[test]
fn the_true_error_lies_inside_the_bar_and_the_bar_is_not_much_larger() {
    let mut random = Random(2018);
    let cases: Vec<_> = (0..205).map(|_| case(&mut random)).collect();
    let found = cases
        .par_iter()
        .filter_map(|(plan, omega)| judged(plan, *omega));
    let found: Vec<_> = found.collect();
    assert!(found.len() >= 200, "{} cases", found.len());
    bars::check("springs", &found, |_, of| 0.05 * of, 5.0);
}

#[test]
fn an_accuracy_asked_for_is_reached_and_not_much_exceeded() {
    let mut plan = pmma_plan(sphere(0.01), 5.0);
    for omega in [1e-3, 0.0084, 0.5] {
        let exact = solved(&plan, omega, (1600, 1600), 1e-8, false).unwrap();
        let mut work = Vec::new();
        for accuracy in [1e-2, 1e-3, 1e-4] {
            plan.cycle.accuracy = Some(accuracy);
            let record = run_case(&plan, omega);
            let loss_j = record.energy_loss_j().unwrap();
            let bar = record.energy_loss_error_j().unwrap() / loss_j;
            let error = (loss_j / exact.analysis.energy_loss_j - 1.0).abs();

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
    let mut plan = pmma_plan(sphere(0.01), 5.0);
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
    let mut plan = pmma_plan(sphere(0.01), 5.0);
    plan.cycle.accuracy = Some(1e-8);
    let record = run_case(&plan, 0.0084);
    assert_eq!(record.status, Status::NotConverged);
    assert!(record.result.is_none());
    assert!(record.message.unwrap().contains("above the accuracy"));
}
