//! Contacts that are not one disc about the origin: found wherever they lie, and read as moduli by their own stiffness.

use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::common::{
    on_cells, pmma_material, run_case, sphere_of_10_mm as sphere, springs, sweep_plan,
};
use contact_dma::contact::{Engine, Instant, Prescribed};
use contact_dma::drive::{Control, HarmonicDrive, Segment, SegmentedDrive};
use contact_dma::engine::EngineKind;
use contact_dma::indenter::{Asperities, Asperity, Ellipsoid, Indenter, Profile, Shifted, Sphere};
use contact_dma::simulation::scenario::ScenarioPlan;
use contact_dma::simulation::{Simulation, SimulationEnd, SimulationOutcome};

fn bump(center_x_m: f64) -> Asperity {
    Asperity {
        center_x_m,
        center_y_m: 0.0,
        radius_m: 0.01,
        height_m: 0.0,
    }
}

/// Shapes whose lowest points lie 1 mm off the axis, and the number of spheres of 10 mm that each is.
fn off_the_axis() -> [(Arc<dyn Indenter>, f64); 2] {
    [
        (Arc::new(Shifted::new(sphere(), 1e-3, 0.0).unwrap()), 1.0),
        (
            Arc::new(Asperities::new(vec![bump(-1e-3), bump(1e-3)]).unwrap()),
            2.0,
        ),
    ]
}

#[test]
fn a_contact_off_the_axis_is_found_under_approach_and_under_load_control() {
    let mut alone = sweep_plan(pmma_material(), sphere(), 10.0, 5.0);
    alone.base.drive = HarmonicDrive::new(Control::Approach, 5e-6, 2e-6, 0.0, 0.0).unwrap();
    let alone_n = run_case(&alone, 0.01).result.unwrap().analysis;
    for (shape, count) in off_the_axis() {
        let load = on_cells(sweep_plan(pmma_material(), shape, 10.0, 5.0), 96, 48);
        let mut approach = load.clone();
        approach.base.drive = alone.base.drive;
        let found = run_case(&load, 0.01);
        assert!(found.result.is_some(), "{:?}", found.message);
        let found = run_case(&approach, 0.01);
        let result = found
            .result
            .unwrap_or_else(|| panic!("{:?}", found.message));
        // Each sphere has a tenth of the cells for its contact, and the other one, seven contact radii away, takes a
        // tenth of the load.
        let ratio = result.analysis.energy_loss_j / alone_n.energy_loss_j / count;
        assert!((0.8..1.1).contains(&ratio), "{count}: {ratio}");
    }
}

#[test]
fn a_ring_off_the_axis_is_found_under_approach_control() {
    let ring = [
        (0.0, 1e-5),
        (0.5e-3, 3e-6),
        (1e-3, 0.0),
        (1.5e-3, 3e-6),
        (2e-3, 1e-5),
    ];
    let ring: Arc<dyn Indenter> = Arc::new(Profile::new(&ring).unwrap());
    let mut plan = on_cells(sweep_plan(pmma_material(), ring, 10.0, 5.0), 64, 48);
    plan.base.drive = HarmonicDrive::new(Control::Approach, 1e-6, 5e-7, 0.0, 0.0).unwrap();
    let found = run_case(&plan, 0.01);
    assert!(
        found.energy_loss_j().is_some_and(|loss_j| loss_j > 0.0),
        "{:?}",
        found.message
    );
}

fn simulated(shape: Arc<dyn Indenter>, approach_m: f64, cells: usize) -> SimulationOutcome {
    let ramp = Segment::Ramp {
        to: approach_m,
        duration_s: 1.0,
    };
    let drive = SegmentedDrive::new(Control::Approach, vec![ramp]).unwrap();
    let mut plan = ScenarioPlan::new(pmma_material(), shape, drive);
    plan.step_s = Some(0.1);
    plan.solver.engine = EngineKind::HalfSpace;
    plan.solver.cells = cells;
    let simulation = Simulation::new(plan).unwrap();
    simulation.run(&AtomicBool::new(false), &|_, _| {})
}

#[test]
fn a_history_that_presses_in_and_meets_nothing_is_an_error() {
    for (shape, _) in off_the_axis() {
        let found = simulated(shape, 5e-6, 64);
        assert_eq!(found.ended, SimulationEnd::Done);
        assert!(found.rows.last().unwrap().load_n > 1.0);
    }
    // A contact of 0.01 mm, 5 mm away, between cells of 0.6 mm.
    let far = Arc::new(Shifted::new(sphere(), 5e-3, 0.0).unwrap());
    let missed = simulated(far, 1e-8, 16);
    let SimulationEnd::Failed(why) = missed.ended else {
        panic!("{:?}", missed.ended)
    };
    assert!(
        why.contains("1.000e-8 m") && why.contains("solver.cells"),
        "{why}"
    );
}

/// At a small amplitude, a loop's moduli are those of the material, whatever the shape of the contact.
#[test]
fn moduli_of_a_contact_of_any_shape_are_the_materials_at_small_amplitude() {
    let omega = 0.02;
    let material = pmma_material();
    let exact = material.longitudinal_complex_modulus(omega);
    let far = vec![bump(-2e-3), bump(2e-3)];
    let shapes: [(Arc<dyn Indenter>, f64); 3] = [
        (sphere(), 1.0),
        (Arc::new(Asperities::new(far).unwrap()), 1.41),
        (Arc::new(Ellipsoid::new(1.0, 0.01).unwrap()), 1.56),
    ];
    for (shape, by_area) in shapes {
        let mut plan = on_cells(sweep_plan(material.clone(), shape, 10.0, 1e-3), 96, 48);
        plan.cycle.tolerance = 1e-5;
        let found = run_case(&plan, omega);
        let result = found
            .result
            .unwrap_or_else(|| panic!("{:?}", found.message));
        let (storage, loss) = (
            result.storage_modulus_pa.unwrap() / exact.re,
            result.loss_modulus_pa.unwrap() / exact.im,
        );
        println!("{by_area}: {storage} {loss}");
        // By the area, today's definition for a disc, a sphere is right to the error of its radius, 1/40 of a cell in 40.
        // By the stiffness of the cells themselves what is left are the tolerances and the steps, 0.2 % in E''.
        let allowed = if by_area == 1.0 { 3e-3 } else { 1e-3 };
        assert!((storage - 1.0).abs() < allowed, "{by_area}: {storage}");
        assert!((loss - 1.0).abs() < 5e-3, "{by_area}: {loss}");
    }
}

/// The stiffness of a punch on cells is that of a disc without a systematic error, and the mean over discs of any size is
/// better than that of one.
#[test]
fn the_tangent_radius_of_a_disc_is_its_radius() {
    let radius_m = 0.01;
    for (cells, one, mean) in [(32, 1.3e-2, 2e-3), (64, 5e-3, 7e-4)] {
        let errors: Vec<f64> = (0..24)
            .map(|k| {
                let contact_m = 1e-4 * (0.8 + 0.2 * f64::from(k) / 24.0);
                let load_n = contact_m.powi(3) / (0.75 * radius_m * 4e-10);
                let sphere = Sphere::new(radius_m).unwrap();
                let mut engine = crate::common::half_space(&sphere, 1.1e-4, cells);
                let load = Prescribed::LoadN(load_n);
                let (solution, pressure) =
                    crate::common::first_touch(&mut engine, 4e-10, load).unwrap();
                let found = engine.tangent_radius_m(&pressure, &solution).unwrap();
                found.0 / contact_m - 1.0
            })
            .collect();
        let largest = errors.iter().fold(0.0_f64, |a, e| a.max(e.abs()));
        let average = errors.iter().sum::<f64>() / errors.len() as f64;
        // Seen: 1.1e-2 and 3.6e-4, 3.5e-3 and 6e-5.
        assert!(
            largest < one && average.abs() < mean,
            "{cells}: {largest:e} {average:e}"
        );
    }
}

/// A flat end, an edge at 0.2 mm, then straight up.
#[test]
fn below_a_flat_end_the_pressure_is_finite_and_unbounded_at_its_edge_alone() {
    let (edge_m, slope, compliance_per_pa) = (2e-4, 0.02, 4e-10);
    let points: Vec<_> = (0..=20)
        .map(|k| 5e-5 * f64::from(k))
        .map(|r_m| (r_m, slope * (r_m - edge_m).max(0.0)))
        .collect();
    let profile = Profile::new(&points).unwrap();
    let body = profile.axisymmetric().unwrap();
    assert_eq!(body.singular_radii_m(), [edge_m]);
    let mut engine = springs(&profile, 6e-4, 4000).singular_at(body.singular_radii_m());
    let history = vec![0.0; 4000];
    let mut force = history.clone();
    let instant = Instant {
        history: &history,
        compliance_per_pa,
        prescribed: Prescribed::LoadN(10.0),
    };
    let solution = engine.solve(&instant, &mut force).unwrap();
    assert_eq!(engine.peak_pressure_pa(&force, &solution), Ok(None));
    let line = engine.pressure_lines(&force, &solution).remove(0);
    // p(0) = (1/pi C) times the integral of G'(x)/x from the edge b to a, with G = slope x acos(b/x) and x = b cosh(t).
    let end = (solution.contact_radius_m / edge_m).acosh();
    let panels = 20_000;
    let integrand = |t: f64| (t.cosh().recip().acos() + t.sinh().recip()) * t.tanh();
    let middles = (0..panels).map(|k| integrand((f64::from(k) + 0.5) / f64::from(panels) * end));
    let integral = middles.sum::<f64>() * end / f64::from(panels);
    let expected = slope * integral / (PI * compliance_per_pa);
    let axis = line.pressure_pa[0].unwrap();
    // Springs meet the root in G at the edge to the power 1/2 of their width, weighed by the width.
    assert!(
        (axis / expected - 1.0).abs() < 5e-3,
        "{axis:e} {expected:e}"
    );
    assert!(line.pressure_pa.iter().all(Option::is_some));
    // Told of an apex instead, the engine says what it said before.
    let line = engine
        .singular_at(vec![0.0])
        .pressure_lines(&force, &solution)
        .remove(0);
    assert_eq!(line.pressure_pa[0], None);
}

#[test]
fn a_contact_that_the_cells_across_it_are_too_few_for_says_how_many_would_do() {
    let apart = |half_m: f64, cells: usize| {
        let bumps = Asperities::new(vec![bump(-half_m), bump(half_m)]).unwrap();
        let plan = sweep_plan(pmma_material(), Arc::new(bumps), 1.0, 0.5);
        run_case(&on_cells(plan, cells, 32), 0.01)
    };
    let failed = apart(1e-2, 64).message.unwrap();
    assert!(failed.contains("solver.cells"), "{failed}");
    let needed = failed.split("give ").nth(1).unwrap();
    let needed: usize = needed.split(' ').next().unwrap().parse().unwrap();
    let found = apart(1e-2, needed);
    assert!(needed > 64 && found.result.is_some(), "{:?}", found.message);
}
