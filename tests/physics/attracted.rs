//! A sphere that is attracted within a range: the elastic contact of Maugis, the limits of the viscoelastic one, and random solids.
//!
//! `SOLIDS=200 cargo test --release --test physics attracted::random -- --nocapture` tries as many as the guide on validation quotes.

use crate::common::bars::{self, Judged};
use crate::common::solids::{frequencies, solid_of_ratio};
use crate::prelude::*;
use contact_dma::reference::adhesive::Maugis;

const RADIUS_M: f64 = 1e-6;
const WORK: f64 = 0.05;
/// Modulus of the relaxed contact.
const RELAXED_PA: f64 = 1e6;
const PI_W_R: f64 = PI * WORK * RADIUS_M;

/// A material of this contact modulus at rest, and branches (Pa, s) above it.
fn material(branches: &[(f64, f64)]) -> Material {
    let own = 1.0 - 0.45 * 0.45;
    let branches: Vec<_> = branches.iter().map(|(pa, s)| (own * pa, *s)).collect();
    material_of(series(own * RELAXED_PA, &branches), 0.45)
}

/// The sphere of a Tabor number on the relaxed body.
fn maugis(tabor_number: f64) -> Maugis {
    Maugis::of_tabor_number(tabor_number, RADIUS_M, 1.0 / RELAXED_PA, WORK)
}

fn attraction(tabor_number: f64) -> AdhesionPlan {
    AdhesionPlan {
        stress_pa: Some(maugis(tabor_number).stress_pa),
        ..AdhesionPlan::of_work(WORK)
    }
}

fn sweep(material: Material, drive: HarmonicDrive, tabor_number: f64) -> Sweep {
    let sweep = Sweep::new(material, ball(RADIUS_M), drive);
    sweep.attracted(attraction(tabor_number)).unwrap()
}

/// Contact radius at which Maugis' contact bears a load, on the stable branch.
fn radius_under_m(sphere: &Maugis, load_n: f64) -> f64 {
    let (mut low_m, mut high_m) = (0.2 * RADIUS_M, 2.0 * RADIUS_M);
    for _ in 0..100 {
        let middle_m = 0.5 * (low_m + high_m);
        match sphere.contact(middle_m).load_n < load_n {
            true => low_m = middle_m,
            false => high_m = middle_m,
        }
    }
    low_m
}

#[test]
fn an_elastic_sphere_is_that_of_maugis_and_loses_nothing() {
    for tabor_number in [0.3, 1.0, 3.0] {
        let drive = HarmonicDrive::load(0.5 * PI_W_R, 1.0 * PI_W_R).unwrap();
        let result = solved(
            sweep(material(&[]), drive, tabor_number).without_error_bars(),
            1.0,
        );
        let sphere = maugis(tabor_number);
        let samples = &result.cycle.samples;
        for (k, load_n) in samples.load_n.iter().enumerate() {
            let exact = sphere.contact(samples.contact_radius_m[k]);
            below!((load_n - exact.load_n).abs(), 1e-7 * PI_W_R);
            below!((samples.approach_m[k] - exact.approach_m).abs(), 1e-15);
        }
        assert_eq!(result.loss_j(), 0.0);
        let parts = result.attracted().unwrap();
        assert!(parts.jumps.is_empty() && parts.pull_n > 0.49 * PI_W_R);
    }
}

#[test]
fn an_elastic_sphere_that_comes_off_loses_what_its_jumps_do() {
    let drive = HarmonicDrive::approach(-0.05e-6, 0.3e-6).unwrap();
    let result = solved(sweep(material(&[]), drive, 5.0).steps(2000).unwrap(), 1.0);
    let parts = result.attracted().unwrap();
    near!(parts.jump_loss_j(), result.loss_j(), 5e-3);
    below!(result.edge_loss_j().unwrap().abs(), result.bar_j());
    assert!(parts.snap_in().unwrap().approach_m > parts.snap_off().unwrap().approach_m + 0.05e-6);
    // The least load that an elastic contact bears.
    let sphere = maugis(5.0);
    let radii_m = (1..4000).map(|k| 3e-4 * f64::from(k) * RADIUS_M);
    let least_n = radii_m
        .map(|a| sphere.contact(a).load_n)
        .fold(0.0, f64::min);
    near!(parts.pull_n, -least_n, 1e-4);
}

/// A small oscillation about a mean load: its stiffness over that of a punch of the mean radius, and its loss over the punch's.
fn beside_a_punch(tabor_number: f64, omega: f64, part: f64) -> (f64, f64) {
    let drive = HarmonicDrive::load(0.5 * PI_W_R, part * PI_W_R).unwrap();
    let solid = material(&[(9e6, 1.0)]);
    let compliance = solid
        .contact_compliance()
        .unwrap()
        .complex_compliance(omega);
    let sweep = sweep(solid, drive, tabor_number).steps(200).unwrap();
    let result = solved(sweep.without_error_bars(), omega);
    let radius_m = &result.cycle.samples.contact_radius_m;
    let mean_m = radius_m[1..].iter().sum::<f64>() / (radius_m.len() - 1) as f64;
    let first = &result.analysis.harmonics[0];
    let stiffness = first.load_amplitude_n / first.approach_amplitude_m;
    let punch_j = PI * first.load_amplitude_n.powi(2) * -compliance.im / (2.0 * mean_m);
    let loss = result.loss_j() / punch_j;
    (stiffness * compliance.norm() / (2.0 * mean_m), loss)
}

#[test]
fn a_fast_oscillation_is_that_of_a_flat_punch_and_a_slow_one_that_of_the_elastic_contact() {
    // What the zone yields besides vanishes with its width.
    for (tabor_number, off) in [(3.24, 2e-3), (10.0, 2e-4), (20.0, 1e-4)] {
        let (stiffness, loss) = beside_a_punch(tabor_number, 100.0, 1e-3);
        below!((stiffness - 1.0).abs(), off);
        below!((loss - 1.0).abs(), off);
    }
    for (tabor_number, omega) in [(3.24, 1e-5), (10.0, 1e-6)] {
        let (stiffness, _) = beside_a_punch(tabor_number, omega, 1e-2);
        let sphere = maugis(tabor_number);
        let radius_m = radius_under_m(&sphere, 0.5 * PI_W_R);
        let [below, above] = [-1e-4, 1e-4].map(|part: f64| sphere.contact((1.0 + part) * radius_m));
        let tangent = (above.load_n - below.load_n) / (above.approach_m - below.approach_m);
        let elastic = tangent / (2.0 * radius_m * RELAXED_PA);
        near!(stiffness, elastic, 1e-3);
        // That of Johnson, Kendall and Roberts at this load.
        below!((elastic - 0.646).abs(), 0.03);
    }
}

/// The pull-off load (N) of an indenter that was pressed into a relaxed body by 20 nm and is pulled off by so much in this time (s), and the
/// largest contact radius.
fn pulled_off(indenter: Arc<dyn Indenter>, tabor_number: f64, time_s: f64) -> (f64, f64) {
    let segments = vec![step(20e-9, 1e4), ramp(-600e-9, time_s)];
    let drive = SegmentedDrive::attracted(Control::Approach, segments, f64::INFINITY).unwrap();
    let mut plan = ScenarioPlan::new(material(&[(9e6, 1.0)]), indenter, drive);
    plan.contact.adhesion = Some(attraction(tabor_number));
    plan.output.error_bars = false;
    let outcome = simulated(plan);
    let radii_m = outcome.rows.iter().map(|row| row.contact_radius_m);
    (
        outcome.separation.unwrap().pull_n,
        radii_m.fold(0.0, f64::max),
    )
}

#[test]
fn a_punch_comes_off_between_the_loads_of_kendall_at_both_ends_of_the_modulus() {
    // Whose rim is round a little, and the contact a little smaller in the end.
    let punch = || Arc::new(PowerLaw::new(100.0, RADIUS_M, 1e-6).unwrap());
    let [slow, fast] = [1e5, 1e-5].map(|time_s| pulled_off(punch(), 6.0, time_s));
    let kendall_n =
        |modulus_pa: f64, radius_m: f64| (8.0 * PI * radius_m.powi(3) * WORK * modulus_pa).sqrt();
    near!(slow.0, kendall_n(RELAXED_PA, slow.1), 0.1);
    near!(fast.0, kendall_n(10.0 * RELAXED_PA, fast.1), 0.1);
}

/// Random solids under loads between half a pull-off and five times its size, or an approach about the surface.
fn cases(random: &mut Random, solids: usize) -> Vec<(SweepPlan, f64)> {
    let plans = (0..solids).flat_map(|_| {
        let solid = solid_of_ratio(random, 4.0);
        let relaxed = solid
            .contact_compliance()
            .unwrap()
            .equilibrium_compliance()
            .unwrap();
        let tabor_number = random.power_of_ten(-1.0, 0.7);
        let relaxed_sphere = Maugis::of_tabor_number(tabor_number, RADIUS_M, relaxed, WORK);
        let (least_n, most_n) = (-0.5 * PI_W_R, random.between(0.0, 5.0) * PI_W_R);
        let omegas = frequencies(&solid);
        let adhesion = AdhesionPlan {
            stress_pa: Some(relaxed_sphere.stress_pa),
            ..AdhesionPlan::of_work(WORK)
        };
        let (mean_n, amplitude_n) = (0.5 * (least_n + most_n), 0.5 * (most_n - least_n));
        let drive = HarmonicDrive::unattracted(Control::Load, mean_n, amplitude_n, 0.0, 0.0);
        let plan = with(sweep_plan(solid, sphere(RADIUS_M), 1.0, 0.5), |plan| {
            plan.base.drive = drive.unwrap().attracted_by(f64::INFINITY).unwrap();
            plan.base.contact.adhesion = Some(adhesion);
        });
        omegas.into_iter().map(move |omega| (plan.clone(), omega))
    });
    plans.collect()
}

#[test]
fn random_solids_have_a_result_whose_loss_lies_inside_its_bar() {
    let solids = from_environment("SOLIDS", 2) as usize;
    let times = from_environment("TIMES", 2) as usize;
    let mut random = Random(from_environment("SEED", 2026));
    let cases = cases(&mut random, solids);
    let judged = cases.par_iter().enumerate().map(|(place, (plan, omega))| {
        let what = format!("{place}: {omega:e} rad/s");
        let found = run_case(&with_bars(plan.clone()), *omega);
        let exact = with(plan.clone(), |exact| {
            exact.cycle.steps *= times;
            exact.cycle.error_bars = false;
            exact.solver.springs *= times;
        });
        let exact = run_case(&exact, *omega);
        let missing = |message: Option<String>| format!("{what}: {}", message.unwrap_or_default());
        let found = found.result.ok_or_else(|| missing(found.message))?;
        let exact = exact
            .result
            .ok_or_else(|| format!("finer {}", missing(exact.message)))?;
        Ok(Judged::new(&found, &exact, what))
    });
    let judged: Vec<Result<Judged, String>> = judged.collect();
    let (found, failed): (Vec<_>, Vec<_>) = judged.into_iter().partition(Result::is_ok);
    for why in failed.iter().filter_map(|case| case.as_ref().err()) {
        println!("FAILED {why}");
    }
    assert!(failed.is_empty(), "{} of {}", failed.len(), cases.len());
    let found: Vec<Judged> = found.into_iter().flatten().collect();
    let share = |quantity| match quantity {
        Quantity::EnergyLoss => 0.05,
        _ => 0.25,
    };
    bars::check(
        "attracted",
        &found,
        |quantity, of| share(quantity) * of,
        50.0,
    );
}
