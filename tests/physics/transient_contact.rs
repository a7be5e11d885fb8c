//! Transient contacts of a sphere against closed forms: steps, ramps and half sines of the load.
//!
//! Sources: E. H. Lee and J. R. M. Radok, J. Appl. Mech. 27 (1960) 438; T. C. T. Ting, J. Appl. Mech. 33 (1966) 845; the cases
//! of S. Spinu, Advances in Tribology 2018, 9432894, figures 4 to 7.

use std::f64::consts::PI;

use crate::common::{half_space, maxwell, observed_order, pmma, relative, springs, zener};
use contact_dma::contact::axisymmetric::Axisymmetric;
use contact_dma::contact::{Engine, Prescribed, Solution};
use contact_dma::history::{March, TimeRule};
use contact_dma::indenter::Sphere;
use contact_dma::material::Creep;
use contact_dma::reference::transient::{
    maxwell_half_sine_cubed_radius, step_load_contact_radius_m,
};

const RADIUS_M: f64 = 0.01;
const LOAD_N: f64 = 10.0;

fn sphere() -> Sphere {
    Sphere::new(RADIUS_M).unwrap()
}

/// Contact radius and peak pressure of the first instant under `LOAD_N`.
fn hertz(compliance: &Creep) -> (f64, f64) {
    let a = step_load_contact_radius_m(RADIUS_M, LOAD_N, compliance, 0.0);
    (a, 1.5 * LOAD_N / (PI * a * a))
}

struct Sample {
    time_s: f64,
    solution: Solution,
    pressure: Vec<f64>,
}

/// From rest: a jump to the load at time 0, then a step to each of these times.
fn follow(
    engine: &mut dyn Engine,
    compliance: &Creep,
    times_s: &[f64],
    load_n: impl Fn(f64) -> f64,
) -> Vec<Sample> {
    let mut march = March::new(engine, compliance.clone(), TimeRule::Linear);
    let solution = march.jump(Prescribed::LoadN(load_n(0.0))).unwrap();
    let pressure = march.pressure().to_vec();
    let mut samples = vec![Sample {
        time_s: 0.0,
        solution,
        pressure,
    }];
    let mut before_s = 0.0;
    for &time_s in times_s {
        let weights = march.weights(time_s - before_s);
        let solution = march
            .step(&weights, Prescribed::LoadN(load_n(time_s)))
            .unwrap();
        let pressure = march.pressure().to_vec();
        samples.push(Sample {
            time_s,
            solution,
            pressure,
        });
        before_s = time_s;
    }
    samples
}

/// `count` times from `end_s / count` to `end_s`.
fn equal(end_s: f64, count: usize) -> Vec<f64> {
    (1..=count)
        .map(|i| end_s * i as f64 / count as f64)
        .collect()
}

/// `count` times from `first_s` to `end_s`, equally far apart in their logarithms.
fn logarithmic(first_s: f64, end_s: f64, count: usize) -> Vec<f64> {
    let growth = (end_s / first_s).powf(1.0 / (count - 1) as f64);
    let mut times: Vec<f64> = (0..count)
        .map(|i| first_s * growth.powi(i as i32))
        .collect();
    times[count - 1] = end_s;
    times
}

/// A material under a step load: first and last time, and by how many spring widths the contact radius may be off.
///
/// The radius is where delta - G - H, drawn straight between two springs, passes zero; but at the edge of a contact whose
/// growth slows down it has a kink, its slope inside being down to kappa = C(0)/C(end) of that outside, so that the straight
/// line is off by up to (1 - sqrt(kappa))/(1 + sqrt(kappa)) spring widths. A Maxwell body grows at a constant rate: no kink,
/// and three times what was seen.
struct Step {
    name: &'static str,
    compliance: Creep,
    first_s: f64,
    end_s: f64,
    widths: f64,
}

fn steps() -> [Step; 3] {
    let kink = |compliance: &Creep| {
        let root =
            compliance.instantaneous_compliance() / compliance.equilibrium_compliance().unwrap();
        (1.0 - root.sqrt()) / (1.0 + root.sqrt())
    };
    [
        Step {
            name: "Maxwell",
            compliance: maxwell(),
            first_s: 1e-3,
            end_s: 3.0,
            widths: 0.005,
        },
        Step {
            name: "Zener",
            widths: kink(&zener()),
            compliance: zener(),
            first_s: 1e-3,
            end_s: 5.0,
        },
        Step {
            name: "PMMA",
            widths: kink(&pmma()),
            compliance: pmma(),
            first_s: 1e-2,
            end_s: 1000.0,
        },
    ]
}

impl Step {
    fn last_radius_m(&self) -> f64 {
        step_load_contact_radius_m(RADIUS_M, LOAD_N, &self.compliance, self.end_s)
    }

    fn run(&self, engine: &mut dyn Engine, times_s: &[f64]) -> Vec<Sample> {
        follow(engine, &self.compliance, times_s, |_| LOAD_N)
    }
}

#[test]
fn a_step_load_on_springs_follows_lee_and_radok_at_all_times_and_with_any_steps() {
    const SPRINGS: usize = 400;
    for step in steps() {
        let half_width_m = 1.02 * step.last_radius_m();
        let width_m = half_width_m / SPRINGS as f64;
        for times in [
            logarithmic(step.first_s, step.end_s, 20),
            logarithmic(step.first_s, step.end_s, 200),
            equal(step.end_s, 20),
            equal(step.end_s, 200),
        ] {
            for sample in step.run(&mut springs(&sphere(), half_width_m, SPRINGS), &times) {
                let Sample {
                    time_s, solution, ..
                } = sample;
                let a = step_load_contact_radius_m(RADIUS_M, LOAD_N, &step.compliance, time_s);
                // The midpoint rule is off by at most (dx/a)^2 / 6 of the approach; the time rule by nothing, because it is
                // exact for the load, which is the sum over the springs.
                let bound = (width_m / a).powi(2) / 6.0;
                let approach = relative(solution.approach_m, a * a / RADIUS_M);
                assert!(
                    approach.abs() < 1.01 * bound,
                    "{} {time_s} s: {approach:e}",
                    step.name
                );
                let radius = (solution.contact_radius_m - a).abs() / width_m;
                assert!(
                    radius < step.widths,
                    "{} {time_s} s: {radius} widths",
                    step.name
                );
            }
        }
    }
}

#[test]
fn the_approach_under_a_step_load_does_not_depend_on_the_steps_that_led_there() {
    for step in steps() {
        let last = |engine: &mut dyn Engine, times: &[f64]| {
            step.run(engine, times).last().unwrap().solution.approach_m
        };
        let half_width_m = 1.15 * step.last_radius_m();
        let mut row = springs(&sphere(), half_width_m, 100);
        let once = last(&mut row, &[step.end_s]);
        for times in [
            equal(step.end_s, 100),
            logarithmic(step.first_s, step.end_s, 30),
        ] {
            // A hundred steps' roundings.
            assert!(
                relative(last(&mut row, &times), once).abs() < 1e-12,
                "{}",
                step.name
            );
        }
        let mut cells = half_space(&sphere(), half_width_m, 32);
        let once = last(&mut cells, &[step.end_s]);
        let often = last(&mut cells, &logarithmic(step.first_s, step.end_s, 10));
        // The solver's tolerance of 1e-8, in each of eleven instants.
        assert!(relative(often, once).abs() < 1e-7, "{}", step.name);
    }
}

#[test]
fn a_step_load_on_the_half_space_follows_lee_and_radok() {
    const CELLS: usize = 64;
    for step in steps() {
        let half_width_m = 1.15 * step.last_radius_m();
        let cell_m = 2.0 * half_width_m / CELLS as f64;
        for times in [
            logarithmic(step.first_s, step.end_s, 12),
            equal(step.end_s, 12),
        ] {
            for sample in step.run(&mut half_space(&sphere(), half_width_m, CELLS), &times) {
                let Sample {
                    time_s, solution, ..
                } = sample;
                let a = step_load_contact_radius_m(RADIUS_M, LOAD_N, &step.compliance, time_s);
                let share = cell_m / a;
                // Discretisation only, of second order in the cell: 0.055 (cell/a)^2 was seen at most.
                let approach = relative(solution.approach_m, a * a / RADIUS_M);
                assert!(
                    approach.abs() < 0.1 * share * share,
                    "{} {time_s} s: {approach:e} {}",
                    step.name,
                    approach / share / share
                );
                // Cells are counted: 0.25 of a cell was seen at most.
                let radius = (solution.contact_radius_m - a).abs() / cell_m;
                assert!(radius < 0.5, "{} {time_s} s: {radius} cells", step.name);
            }
        }
    }
}

#[test]
fn a_march_in_small_steps_profits_from_the_last_pressure() {
    let [.., step] = steps();
    let half_width_m = 1.15 * step.last_radius_m();
    let mut engine = half_space(&sphere(), half_width_m, 64);
    let samples = step.run(&mut engine, &equal(100.0, 100));
    let (first, rest) = samples.split_first().unwrap();
    let iterations: usize = rest.iter().map(|s| s.solution.iterations).sum();
    let (first, mean) = (first.solution.iterations, iterations as f64 / 100.0);
    // 17.4 iterations per step and 2078 convolutions in all were seen, after 29 iterations in the first instant.
    assert!(
        engine.convolutions() < 2500,
        "{} convolutions",
        engine.convolutions()
    );
    assert!(
        mean < 21.0,
        "{mean} iterations per step, {first} in the first"
    );
}

/// Largest error of a/a_H before and after the contact's maximum, under W_0 sin s on a Maxwell body.
fn half_sine_errors(engine: &mut dyn Engine, steps: usize) -> (f64, f64) {
    let compliance = maxwell();
    let (hertz_m, _) = hertz(&compliance);
    let (mut rising, mut falling) = (0.0_f64, 0.0_f64);
    for sample in follow(engine, &compliance, &equal(3.0, steps), |s| {
        LOAD_N * s.sin()
    }) {
        let exact = maxwell_half_sine_cubed_radius(sample.time_s).cbrt();
        let error = (sample.solution.contact_radius_m / hertz_m - exact).abs();
        if sample.time_s < 0.75 * PI {
            rising = rising.max(error);
        } else {
            falling = falling.max(error);
        }
    }
    (rising, falling)
}

#[test]
fn a_half_sine_on_a_maxwell_body_follows_ting_past_the_maximum_of_the_contact() {
    let half_width_m = 1.36 * hertz(&maxwell()).0;
    let counts = [200, 400, 800, 1600];
    let (mut rising, mut falling) = (vec![], vec![]);
    for count in counts {
        let mut engine = springs(&sphere(), half_width_m, count);
        let errors = half_sine_errors(&mut engine, count / 4);
        rising.push(errors.0);
        falling.push(errors.1);
    }
    println!("rising {rising:?}, falling {falling:?}");
    for errors in [rising, falling] {
        // Second order in the step and in the approach, first in what the kink at the edge leaves of the radius.
        let order = observed_order(&counts, &errors);
        assert!((1.2..2.1).contains(&order), "order {order}");
        // Twice what was seen.
        assert!(errors[3] < 3e-5);
    }
}

#[test]
fn both_engines_follow_the_half_sine_past_the_maximum_of_the_contact() {
    const CELLS: usize = 64;
    let compliance = maxwell();
    let (hertz_m, _) = hertz(&compliance);
    let half_width_m = 1.5 * hertz_m;
    let times = equal(3.0, 30);
    let load_n = |s: f64| LOAD_N * s.sin();
    let mut row = springs(&sphere(), half_width_m, 1600);
    let exact = follow(&mut row, &compliance, &times, load_n);
    let mut cells = half_space(&sphere(), half_width_m, CELLS);
    let found = follow(&mut cells, &compliance, &times, load_n);
    let largest_m = exact
        .iter()
        .fold(0.0_f64, |l, s| l.max(s.solution.approach_m));
    let cell_m = 2.0 * half_width_m / CELLS as f64;
    let (mut worst_approach, mut worst_radius) = (0.0_f64, 0.0_f64);
    for (exact, found) in exact.iter().zip(&found).skip(1) {
        let error_m = (found.solution.approach_m - exact.solution.approach_m).abs();
        worst_approach = worst_approach.max(error_m / largest_m);
        let radius_m = hertz_m * maxwell_half_sine_cubed_radius(found.time_s).cbrt();
        let error_m = (found.solution.contact_radius_m - radius_m).abs();
        worst_radius = worst_radius.max(error_m / cell_m);
    }
    println!("approach {worst_approach:e}, radius {worst_radius} cells");
    // The same steps, so that the grid alone tells them apart; three times what was seen.
    assert!(worst_approach < 2e-4, "{worst_approach:e}");
    // Cells are counted: a quarter of a cell was seen.
    assert!(worst_radius < 0.5, "{worst_radius} cells");
}

/// A pressure profile, in units of the peak pressure and the contact radius of the first instant.
struct Profile {
    radii: Vec<f64>,
    pressures: Vec<f64>,
}

impl Profile {
    fn of(engine: &mut Axisymmetric, sample: &Sample, compliance: &Creep) -> Self {
        let (hertz_m, hertz_pa) = hertz(compliance);
        let edge_m = sample.solution.contact_radius_m;
        let mut pressures = vec![0.0; engine.nodes() + 1];
        let contact = engine.pressure_profile_pa(&sample.pressure, edge_m, &mut pressures);
        pressures.truncate(contact + 1);
        let inside = (0..contact).map(|spring| engine.position_m(spring) / hertz_m);
        let radii = std::iter::once(0.0)
            .chain(inside)
            .chain([edge_m / hertz_m])
            .collect();
        pressures.push(0.0);
        pressures.iter_mut().for_each(|p| *p /= hertz_pa);
        Self { radii, pressures }
    }

    /// Linear between the springs.
    fn at(&self, radius: f64) -> f64 {
        let next = self.radii.iter().position(|&r| r > radius).unwrap();
        let (r, p) = (
            &self.radii[next - 1..=next],
            &self.pressures[next - 1..=next],
        );
        p[0] + (p[1] - p[0]) * (radius - r[0]) / (r[1] - r[0])
    }

    /// Integral over the contact, in units of the load: (2 pi/W) integral of p r dr = 3 integral of p r dr here.
    fn load(&self) -> f64 {
        let edges = self.radii.windows(2).zip(self.pressures.windows(2));
        let moment = edges.map(|(r, p)| 0.5 * (p[0] * r[0] + p[1] * r[1]) * (r[1] - r[0]));
        3.0 * moment.sum::<f64>()
    }
}

/// Profiles under a step load at these times (s), which must be among 500 equal steps.
fn step_load_profiles(compliance: &Creep, times_s: &[f64]) -> Vec<Profile> {
    let end_s = times_s[times_s.len() - 1];
    let largest_m = step_load_contact_radius_m(RADIUS_M, LOAD_N, compliance, end_s);
    let mut engine = springs(&sphere(), 1.02 * largest_m, 800);
    let samples = follow(&mut engine, compliance, &equal(end_s, 500), |_| LOAD_N);
    let wanted = times_s.iter().map(|&time_s| {
        let near = |sample: &&Sample| (sample.time_s - time_s).abs() < 1e-9 * end_s;
        samples.iter().find(near).unwrap()
    });
    wanted
        .map(|sample| Profile::of(&mut engine, sample, compliance))
        .collect()
}

#[test]
fn the_pressure_under_a_step_load_on_a_maxwell_body_hollows_out_as_the_exact_solution_does() {
    // Time; p(0)/p_H and p(a_H)/p_H computed independently to half a unit of the last digit.
    let expected = [
        (0.5, 0.71915, 0.4019),
        (1.0, 0.52613, 0.4057),
        (2.0, 0.30629, 0.3157),
    ];
    let profiles = step_load_profiles(&maxwell(), &expected.map(|row| row.0));
    for ((time_s, centre, ring), profile) in expected.into_iter().zip(&profiles) {
        let (at_centre, at_ring) = (profile.pressures[0], profile.at(1.0));
        println!("{time_s}: {at_centre} {at_ring} {}", profile.load());
        assert!(
            (at_centre - centre).abs() < 1e-5,
            "{time_s} s: p(0) {at_centre}"
        );
        // Where the first contact ended the profile has a vertical tangent, which springs round off.
        assert!(
            (at_ring - ring).abs() < 1.5e-4,
            "{time_s} s: p(a_H) {at_ring}"
        );
        // A trapezium rule over two square-root edges.
        assert!(
            (profile.load() - 1.0).abs() < 1e-4,
            "{time_s} s: {}",
            profile.load()
        );
    }
}

#[test]
fn the_pressure_under_a_step_load_on_a_zener_body_levels_off_as_the_exact_solution_does() {
    // Computed independently to half a unit of the last digit.
    let expected = [(0.2, 0.8870), (0.5, 0.7772), (1.0, 0.6873), (5.0, 0.6300)];
    let profiles = step_load_profiles(&zener(), &expected.map(|row| row.0));
    for ((time_s, centre), profile) in expected.into_iter().zip(&profiles) {
        println!("{time_s}: {} {}", profile.pressures[0], profile.load());
        assert!(
            (profile.pressures[0] - centre).abs() < 6e-5,
            "{time_s} s: {}",
            profile.pressures[0]
        );
        assert!(
            (profile.load() - 1.0).abs() < 1e-4,
            "{time_s} s: {}",
            profile.load()
        );
    }
}

/// (s, a/a_H) on a Maxwell body under this load in units of `LOAD_N`, s in relaxation times.
fn maxwell_radii(
    engine: &mut dyn Engine,
    end: f64,
    steps: usize,
    load: fn(f64) -> f64,
) -> Vec<(f64, f64)> {
    let compliance = maxwell();
    let (hertz_m, _) = hertz(&compliance);
    let samples = follow(engine, &compliance, &equal(end, steps), |s| {
        LOAD_N * load(s)
    });
    samples
        .iter()
        .map(|s| (s.time_s, s.solution.contact_radius_m / hertz_m))
        .collect()
}

#[test]
fn under_a_falling_ramp_the_contact_on_a_maxwell_body_still_grows_for_a_while() {
    let ramp = |s: f64| 1.0 - 0.5 * s;
    let half_width_m = 1.15 * hertz(&maxwell()).0;
    let radii = maxwell_radii(&mut springs(&sphere(), half_width_m, 1600), 2.0, 100, ramp);
    for (s, radius) in &radii {
        let growing = 1.0 + 0.5 * s - 0.25 * s * s;
        if *s <= 1.0 {
            // Lee and Radok while the contact grows. Twice what was seen.
            assert!((radius.powi(3) - growing).abs() < 5e-5, "s = {s}: {radius}");
        } else {
            // From the maximum on the contact shrinks faster than that formula, down to nothing under no load.
            assert!(radius.powi(3) < growing + 5e-5, "s = {s}: {radius}");
        }
    }
    let largest = radii.iter().fold(0.0_f64, |l, r| l.max(r.1));
    assert!((largest - 1.25_f64.cbrt()).abs() < 1e-5, "{largest}");
    assert_eq!(radii[100].1, 0.0);
    const CELLS: usize = 64;
    let half_width_m = 1.2 * hertz(&maxwell()).0;
    let cell = 2.4 / CELLS as f64;
    let found = maxwell_radii(
        &mut half_space(&sphere(), half_width_m, CELLS),
        2.0,
        20,
        ramp,
    );
    for ((s, radius), exact) in found.iter().zip(radii.iter().step_by(5)) {
        // Cells are counted; steps of a tenth leave far less than that.
        assert!(
            (radius - exact.1).abs() < 0.5 * cell,
            "s = {s}: {radius} {}",
            exact.1
        );
    }
}

#[test]
fn under_a_cubic_load_the_contact_on_a_maxwell_body_shrinks_grows_and_shrinks_again() {
    let cubic = |s: f64| (1.0 + (2.0 - s).powi(3)) / 9.0;
    let half_width_m = 1.1 * hertz(&maxwell()).0;
    let radii = maxwell_radii(&mut springs(&sphere(), half_width_m, 3200), 3.0, 300, cubic);
    let (first, last) = radii.split_at(200);
    let lowest = first.iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    let highest = last.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    // While the contact shrinks from the first instant on, every spring still in contact has been so throughout, and its force
    // is the Hertz force of then, relaxed: (a/a_H)^3 = exp(s) W/W_0. That has its minimum where W' + W = 0, which is
    // u^3 - 3 u^2 + 1 = 0 with u = 2 - s, at s = 1.3473.
    let minimum = 1.347_296;
    let falling = |s: f64| (s.exp() * cubic(s)).cbrt();
    for (s, radius) in radii.iter().filter(|r| r.0 < minimum) {
        // Three times what was seen.
        assert!((radius - falling(*s)).abs() < 1e-5, "s = {s}: {radius}");
    }
    assert!((lowest.1 - falling(minimum)).abs() < 2e-5, "{lowest:?}");
    // The extrema are flat: an error of 1e-5 in the radius moves them by 0.006, and steps are 0.01 apart.
    assert!((lowest.0 - minimum).abs() < 0.015, "{lowest:?}");
    // Computed independently to the digits given.
    assert!((highest.1 - 0.910).abs() < 1e-4, "{highest:?}");
    assert!((highest.0 - 2.52).abs() < 0.015, "{highest:?}");
}

#[test]
fn after_unloading_a_maxwell_body_keeps_its_dent_for_ever_and_a_zener_body_forgets_it() {
    // Unloaded after two times; looked at 1 and 20 times after that. The dent is the displacement at the centre.
    let dents = |compliance: &Creep| {
        let half_width_m = 1.1 * step_load_contact_radius_m(RADIUS_M, LOAD_N, compliance, 2.0);
        let mut engine = half_space(&sphere(), half_width_m, 33);
        let mut march = March::new(&mut engine, compliance.clone(), TimeRule::Linear);
        march.jump(Prescribed::LoadN(LOAD_N)).unwrap();
        march.hold(2.0, Prescribed::LoadN(LOAD_N)).unwrap();
        let (mut dents, mut last) = (vec![], 0.0);
        for step_s in [0.0, 1.0, 19.0] {
            let weights = march.weights(step_s);
            let solution = march.step(&weights, Prescribed::LoadN(0.0)).unwrap();
            assert_eq!((solution.load_n, solution.contact_radius_m), (0.0, 0.0));
            last = weights.compliance_per_pa;
            dents.push(solution.approach_m);
        }
        drop(march);
        let centre_m = engine.displacement_m(last).unwrap()[33 * 16 + 16];
        (dents, centre_m)
    };
    let (maxwell_dents, left_m) = dents(&maxwell());
    // Nothing moves a dashpot without a load: a rounding per step.
    assert!(left_m > 0.0 && relative(maxwell_dents[2], maxwell_dents[0]).abs() < 1e-12);
    let (zener_dents, left_m) = dents(&zener());
    // Every displacement decays like exp(-t), 2.1e-9 of it at 20; 3 for the roundings of the convolution.
    assert!(left_m.abs() < 3.0 * (-20.0_f64).exp() * zener_dents[0]);
    assert!(zener_dents[1] < zener_dents[0] && zener_dents[2].abs() < 1e-8 * zener_dents[0]);
}
