//! The work of the indenter over a history: closed forms at jumps and ramps, loops that close, what the branches dissipate, error bars.

use crate::common::solids;
use crate::prelude::*;
use contact_dma::drive::{Fineness, SegmentedDrive};
use contact_dma::simulation::SimulationOutcome;
use contact_dma::simulation::scenario::ScenarioPlan;
use contact_dma::simulation::work::{self, HistoryWork};

fn plan(
    material: Material,
    indenter: Arc<dyn Indenter>,
    control: Control,
    segments: Vec<Segment>,
) -> ScenarioPlan {
    let drive = SegmentedDrive::new(control, segments).unwrap();
    ScenarioPlan::new(material, indenter, drive)
}

fn last_j(outcome: &SimulationOutcome) -> f64 {
    outcome.rows.last().unwrap().work_j.unwrap()
}

fn maxwell_material() -> Material {
    let body = classical::maxwell(1e9, 1.0).unwrap();
    Material::from_relaxation(body, ModulusKind::Shear, 0.5).unwrap()
}

#[test]
fn a_step_of_load_takes_two_fifths_at_once_and_all_of_what_creeps() {
    for (material, creep) in [(zener_material(), zener()), (maxwell_material(), maxwell())] {
        for engine in [EngineKind::Axisymmetric, EngineKind::HalfSpace] {
            let segments = vec![step(5.0, 3.0)];
            let mut plan = plan(material.clone(), sphere(0.01), Control::Load, segments);
            (plan.solver.engine, plan.solver.cells) = (engine, 64);
            let tolerance = match engine {
                EngineKind::Axisymmetric => 1e-4,
                EngineKind::HalfSpace => 5e-3,
            };
            let outcome = simulated(plan);
            let approach_m = |t: f64| {
                let a = hertz_radius_m(0.01, 5.0, creep.compliance(t));
                a * a / 0.01
            };
            let at_once_j = 0.4 * 5.0 * approach_m(0.0);
            near!(outcome.rows[0].work_j.unwrap(), at_once_j, tolerance);
            let exact_j = at_once_j + 5.0 * (approach_m(3.0) - approach_m(0.0));
            near!(last_j(&outcome), exact_j, tolerance, "{engine:?}");
        }
    }
}

#[test]
fn a_jump_between_two_loads_is_a_difference_of_elastic_energies() {
    // An elastic body takes 2/5 W delta on any way to a load, jumps up and down and onto an indenter that was clear of it included.
    let elastic = solid(1e6, &[], 0.3);
    let segments = vec![
        step(1.0, 1.0),
        step(4.0, 1.0),
        step(0.0, 1.0),
        step(3.0, 1.0),
        ramp(2.0, 1.0),
    ];
    let outcome = simulated(plan(elastic, sphere(0.01), Control::Load, segments));
    for row in &outcome.rows {
        let exact_j = 0.4 * row.load_n * row.approach_m.unwrap_or(0.0);
        assert!(
            (row.work_j.unwrap() - exact_j).abs() < 3e-4 * 0.4 * 4.0 * 1e-3,
            "{row:?} {exact_j}"
        );
    }
}

#[test]
fn a_cone_pressed_in_at_a_constant_rate_takes_the_integral_of_its_load() {
    // Lee and Radok: W = (2/pi) tan(alpha) * integral of E(t-s) d(delta^2), of an elastic body E delta^2.
    let elastic = solid(1e6, &[], 0.3);
    let segments = vec![ramp(1e-4, 2.0)];
    let outcome = simulated(plan(elastic, cone(1.2), Control::Approach, segments));
    for row in outcome.rows.iter().skip(20) {
        let exact_j = row.load_n * row.approach_m.unwrap() / 3.0;
        near!(row.work_j.unwrap(), exact_j, 2e-3, "{row:?}");
    }
    near!(
        last_j(&outcome),
        outcome.rows.last().unwrap().load_n * 1e-4 / 3.0,
        1e-4
    );
}

/// Triangle of approach, and back to where the indenter is clear of the surface.
fn triangle(springs: usize) -> ScenarioPlan {
    let segments = vec![ramp(1e-5, 20.0), ramp(0.0, 20.0)];
    let mut plan = plan(pmma_material(), sphere(0.01), Control::Approach, segments);
    plan.solver.springs = springs;
    plan
}

#[test]
fn a_triangle_of_approach_dissipates_the_area_of_its_loop() {
    let outcome = simulated(triangle(400));
    let work = HistoryWork::of(&triangle(400), &outcome).unwrap();
    let pairs = outcome.rows.windows(2);
    let area_j: f64 = pairs
        .map(|p| {
            0.5 * (p[0].load_n + p[1].load_n)
                * (p[1].approach_m.unwrap() - p[0].approach_m.unwrap())
        })
        .sum();
    near!(work.dissipated_j().unwrap(), area_j, 1e-12);
    assert!(area_j > 0.0 && work.dissipated_error_j().unwrap() < 0.05 * area_j);
    // What is still pressed in stores a part.
    let segments = vec![ramp(1e-5, 20.0)];
    let held = plan(pmma_material(), sphere(0.01), Control::Approach, segments);
    let work = HistoryWork::of(&held, &simulated(held.clone())).unwrap();
    assert!(work.dissipated_j().is_none() && work.stored.unwrap().contains("stored"));
}

#[test]
fn the_work_converges_at_second_order_in_the_step() {
    let finer = [1, 2, 4];
    let work = |parts| {
        let simulation = Simulation::with_fineness(triangle(800), Fineness::Split(parts)).unwrap();
        last_j(&followed(&simulation))
    };
    let exact_j = work(32);
    let errors = finer.map(|parts| relative(work(parts), exact_j));
    let order = observed_order(&finer, &errors);
    println!("{errors:?}, order {order:.2}");
    assert!(order > 1.7, "{errors:?} {order}");
}

#[test]
fn cycles_of_a_stabilised_sine_take_their_number_of_energy_losses() {
    const OMEGA: f64 = 0.1;
    let sine = Segment::Sine {
        mean: 10.0,
        amplitude: 5.0,
        angular_frequency_rad_per_s: OMEGA,
        phase_rad: 0.0,
        cycles: 30.0,
    };
    let outcome = simulated(plan(
        pmma_material(),
        sphere(0.01),
        Control::Load,
        vec![sine],
    ));
    let at = |cycle: f64| {
        let time_s = cycle * TAU / OMEGA;
        let row = outcome
            .rows
            .iter()
            .position(|row| row.time_s > time_s * (1.0 - 1e-9))
            .unwrap();
        (
            outcome.rows[row].work_j.unwrap(),
            outcome.errors[row].work_j.unwrap(),
        )
    };
    let ((from_j, _), (to_j, error_j)) = (at(20.0), at(30.0));
    let swept = result(&with_bars(pmma_plan(sphere(0.01), 5.0)), OMEGA);
    let ten_j = 10.0 * swept.loss_j();
    println!(
        "{} {ten_j} +- {error_j} +- {}",
        to_j - from_j,
        10.0 * swept.bar_j()
    );
    assert!((to_j - from_j - ten_j).abs() < error_j + 10.0 * swept.bar_j());
}

#[test]
fn the_work_of_random_histories_lies_within_its_error_bars() {
    let seed = from_environment("SEED", 1);
    let mut random = Random(seed);
    let (mut inside, mut all, mut ratios) = (0, 0, Vec::new());
    for _ in 0..from_environment("CASES", 20) {
        let material = solids::solid_of_ratio(&mut random, 1.5);
        let segments = |random: &mut Random| {
            let mut segment = || {
                let (to, duration_s) = (random.between(0.0, 2.0), random.power_of_ten(-2.0, 2.0));
                match random.count(0, 2) {
                    0 => step(to, duration_s),
                    1 => ramp(to, duration_s),
                    _ => ramp(0.0, duration_s),
                }
            };
            vec![ramp(1.0, 1.0), segment(), segment(), segment()]
        };
        let indenter = match random.count(0, 1) {
            0 => sphere(0.01),
            _ => cone(1.3),
        };
        let mut plan = plan(material, indenter, Control::Load, segments(&mut random));
        plan.solver.springs = 100;
        let found = simulated(plan.clone());
        plan.solver.springs = 800;
        let finer = Simulation::with_fineness(plan, Fineness::Split(8)).unwrap();
        let exact = followed(&finer)
            .rows
            .into_iter()
            .zip(&finer.schedule().in_full);
        let exact = exact.filter_map(|(row, place)| place.map(|_| row));
        for ((row, errors), exact) in found.rows.iter().zip(&found.errors).zip(exact) {
            let off_j = (row.work_j.unwrap() - exact.work_j.unwrap()).abs();
            let bar_j = errors.work_j.unwrap();
            all += 1;
            inside += usize::from(off_j <= bar_j);
            if off_j > 0.0 {
                ratios.push(bar_j / off_j);
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    let share = f64::from(inside as u32) / f64::from(all as u32);
    println!(
        "{share:.4} of {all} rows inside, median bar over error {:.1}",
        ratios[ratios.len() / 2]
    );
    assert!(share > 0.98, "{share}");
}

#[test]
fn rows_of_an_earlier_version_tell_the_work_up_to_the_first_jump_under_load() {
    let segments = vec![ramp(1.0, 1.0), ramp(2.0, 1.0), step(1.0, 1.0)];
    let plan = plan(zener_material(), sphere(0.01), Control::Load, segments);
    let mut rows = simulated(plan.clone()).rows;
    let known: Vec<Option<f64>> = rows.iter().map(|row| row.work_j).collect();
    rows.iter_mut().for_each(|row| row.work_j = None);
    work::fill_in(&plan, &mut rows);
    let jump = rows
        .windows(2)
        .position(|pair| pair[0].time_s == pair[1].time_s)
        .unwrap();
    for (place, (row, known)) in rows.iter().zip(known).enumerate() {
        match place <= jump {
            true => assert!((row.work_j.unwrap() - known.unwrap()).abs() <= 1e-12 * known.unwrap()),
            false => assert_eq!(row.work_j, None),
        }
    }
}
