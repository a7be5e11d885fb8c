//! How the half-space engine works: how many convolutions it takes, that its fast way and its safe one agree, that its windows
//! lose nothing.

use crate::prelude::*;
use crate::shapes::roughness;
use contact_dma::reference::transient::step_load_contact_radius_m;

const RADIUS_M: f64 = 0.01;
const LOAD_N: f64 = 10.0;

/// The contact of the sphere under a load held for ever (m).
fn relaxed_radius_m(load_n: f64) -> f64 {
    let relaxed = pmma().equilibrium_compliance().unwrap();
    hertz_radius_m(RADIUS_M, load_n, relaxed)
}

/// A load that swings about its mean, at a step of so many a cycle, by half of the mean.
fn swinging(step: usize, steps: usize) -> Prescribed {
    let angle = TAU * step as f64 / steps as f64;
    Prescribed::LoadN(LOAD_N * (1.0 + 0.5 * angle.sin()))
}

/// A march on PMMA under the mean load.
fn marched(engine: &mut HalfSpace, load_n: f64) -> March<'_> {
    let mut march = March::new(engine, pmma(), TimeRule::Linear);
    march.jump(Prescribed::LoadN(load_n)).unwrap();
    march
}

// Work.

#[test]
fn a_cycle_on_pmma_takes_fewer_than_ten_convolutions_per_step() {
    let half_width_m = 1.1 * relaxed_radius_m(1.5 * LOAD_N);
    // Steps per cycle, mean convolutions per step seen.
    for (steps, seen) in [(100, 7.4), (200, 6.3)] {
        let mut engine = half_space(&ball(RADIUS_M), half_width_m, 128);
        let mut march = marched(&mut engine, LOAD_N);
        let before = march.work().convolutions;
        let weights = march.weights(TAU / 0.01 / steps as f64);
        for step in 1..=steps {
            march.step(&weights, swinging(step, steps)).unwrap();
        }
        let mean = (march.work().convolutions - before) as f64 / steps as f64;
        println!("{steps} steps: {mean:.2} convolutions per step");
        assert!(mean < 10.0 && mean < 1.15 * seen, "{steps} steps: {mean}");
        assert_eq!(engine.safeguarded_instants(), 0);
    }
}

#[test]
fn the_two_thousandth_step_costs_what_the_first_ones_do() {
    const PER_CYCLE: usize = 100;
    let half_width_m = 1.1 * relaxed_radius_m(1.5 * LOAD_N);
    let mut engine = half_space(&ball(RADIUS_M), half_width_m, 64);
    let mut march = marched(&mut engine, LOAD_N);
    let weights = march.weights(TAU / 0.01 / PER_CYCLE as f64);
    let cycle = |_| {
        let before = march.work().convolutions;
        for step in 1..=PER_CYCLE {
            march.step(&weights, swinging(step, PER_CYCLE)).unwrap();
        }
        march.work().convolutions - before
    };
    let cycles: Vec<u64> = (0..20).map(cycle).collect();
    // The past is in memory variables, of which there are as many as ever; the first cycle still creeps.
    assert!(cycles[19] as f64 <= 1.1 * cycles[0] as f64, "{cycles:?}");
}

#[test]
fn a_held_load_takes_a_few_convolutions_per_step() {
    let mut engine = half_space(&ball(RADIUS_M), 2.0 * relaxed_radius_m(LOAD_N), 128);
    let mut march = March::new(&mut engine, pmma(), TimeRule::Linear);
    let first = march.jump(Prescribed::LoadN(LOAD_N)).unwrap();
    let weights = march.weights(1.0);
    for _ in 0..200 {
        march.step(&weights, Prescribed::LoadN(LOAD_N)).unwrap();
    }
    let mean = (march.work().convolutions - first.convolutions as u64) as f64 / 200.0;
    println!("{mean:.2} convolutions per step after {first:?}");
    // 3.2 were seen, and 6 in the first instant.
    below!(mean, 4.0);
    assert!(first.convolutions < 40 && first.iterations < 12);
    assert_eq!(march.work().convolutions, engine.convolutions());
}

// The fast way against the safe one.

/// The same cells in contact, and the edge between cells where their pressures, settled to a millionth of the peak, put it: a
/// few millionths of a cell of some ten to hundred in the radius. And the approach to the tolerance of 1e-8 on either side.
#[track_caller]
fn assert_same(one: &Solution, other: &Solution) {
    near!(one.approach_m, other.approach_m, 2e-8);
    near!(one.contact_radius_m, other.contact_radius_m, 1e-7);
}

/// A contact of some hundred patches on 2 % of a rough surface of 512 x 512 cells.
#[test]
fn a_rough_surface_takes_few_iterations_and_has_the_answer_of_the_safe_way() {
    let rough = Roughness {
        cut_off_wavelength_m: 1e-6,
        ..roughness(512)
    };
    let grid = Grid::square(512, rough.spacing_m).unwrap();
    let gaps = rough.map().unwrap().gaps_m().to_vec();
    let load = Prescribed::LoadN(0.02);
    let operator = Arc::new(Convolution::new(grid).unwrap());
    let new = || {
        let settings = SolverSettings::default();
        HalfSpace::new(Arc::clone(&operator), gaps.clone(), true, settings)
    };
    let mut fast = new();
    let (found, pressure) = first_touch(&mut fast, 4e-10, load).unwrap();
    let share = pressure.iter().filter(|p| **p > 0.0).count() as f64 / pressure.len() as f64;
    assert!((share - 0.02).abs() < 0.005, "{share}");
    println!("{found:?}, {share:.4} in contact");
    // 23 iterations were seen, and 43 convolutions.
    assert!(found.iterations < 27 && found.convolutions < 130);
    assert_eq!(fast.safeguarded_instants(), 0);

    let mut safe = new().by_safeguard_alone();
    let (expected, exact) = first_touch(&mut safe, 4e-10, load).unwrap();
    // Gaps that are settled to 1e-8 leave the pressure of single cells settled to some hundred times that, and with it the
    // edge of the contact, in cells.
    assert_same(&found, &expected);
    let peak = largest(exact.iter().copied());
    below!(largest_difference(&pressure, &exact), 1e-5 * peak);

    let (found, pressure) = first_touch(&mut new().in_many_patches(), 4e-10, load).unwrap();
    // 12 and 21 were seen.
    assert!(found.iterations < 16 && found.convolutions < 30);
    assert_same(&found, &expected);
    below!(largest_difference(&pressure, &exact), 1e-5 * peak);
}

/// A map may be of anything.
#[test]
fn a_ball_taken_for_many_patches_takes_as_many_steps() {
    let (load, approach) = (Prescribed::LoadN(LOAD_N), Prescribed::ApproachM(1e-6));
    for (cells, control) in [(64, load), (150, load), (64, approach), (256, approach)] {
        let new = || half_space(&ball(RADIUS_M), 2.0 * relaxed_radius_m(LOAD_N), cells);
        let (one, _) = first_touch(&mut new(), 4e-10, control).unwrap();
        let (many, _) = first_touch(&mut new().in_many_patches(), 4e-10, control).unwrap();
        assert_same(&many, &one);
        let counts = (many.iterations, one.iterations);
        assert!(counts.0 <= counts.1 + 1, "{cells} {control:?} {counts:?}");
    }
}

/// Two asperities of different height, off the middle.
fn pair() -> Asperities {
    let high = asperity((-2.6e-4, 1e-4), 2e-3, 4e-6);
    let low = asperity((3e-4, -1.5e-4), 2e-3, 0.0);
    Asperities::new(vec![low, high]).unwrap()
}

fn soft() -> Creep {
    creep(1e-9, &[(1e-9, 0.3), (4e-9, 20.0)], None)
}

/// Loads and approaches of a march through so many random jumps and steps.
fn random_history(engine: &mut HalfSpace, seed: u64) -> Vec<(f64, f64)> {
    let mut march = March::new(engine, soft(), TimeRule::Linear);
    let mut random = Random(seed);
    let mut found = Vec::new();
    for _ in 0..25 {
        let size = random.unit();
        let prescribed = match random.count(0, 5) {
            0 => Prescribed::LoadN(0.0),
            1 | 2 => Prescribed::LoadN(2.0 * size),
            3 => Prescribed::LoadN(2.0 * 10_f64.powf(-4.0 * size)),
            _ => Prescribed::ApproachM(1.5e-5 * size),
        };
        found.push(march.jump(prescribed).unwrap());
        let weights = march.weights(random.power_of_ten(-2.0, 1.0));
        for _ in 0..4 {
            found.push(march.step(&weights, prescribed).unwrap());
        }
    }
    found.iter().map(|s| (s.load_n, s.approach_m)).collect()
}

/// Both to the tolerance of 1e-8, in each instant and in those that history remembers.
#[track_caller]
fn assert_alike(found: &[(f64, f64)], safe: &[(f64, f64)], what: &str) {
    for of in [|s: &(f64, f64)| s.0, |s: &(f64, f64)| s.1] {
        let [found, safe] = [found, safe].map(|all| all.iter().map(of).collect::<Vec<_>>());
        let scale = largest(safe.iter().copied());
        below!(largest_difference(&found, &safe), 1e-7 * scale, "{what}");
    }
}

#[test]
fn both_ways_follow_any_history_alike_on_any_shape() {
    let shapes: [Arc<dyn Indenter>; 4] = [
        Arc::new(pair()),
        Arc::new(Ellipsoid::new(0.004, 0.001).unwrap()),
        punch(2e-4),
        Arc::new(Shifted::new(sphere(2e-3), 2e-4, -1e-4).unwrap()),
    ];
    for (seed, shape) in (1..).zip(&shapes) {
        for cells in [48, 51] {
            let spacing = |side_m: f64| side_m / cells as f64;
            let grid = Grid::new(cells, cells - 5, spacing(1.6e-3), spacing(1.7e-3)).unwrap();
            let new = || cells_on(shape.as_ref(), grid);
            let fast = random_history(&mut new(), seed);
            let safe = random_history(&mut new().by_safeguard_alone(), seed);
            assert_alike(&fast, &safe, &format!("{shape:?}, {cells} cells"));
        }
    }
}

#[test]
fn where_the_fast_way_is_left_within_an_instant_the_safe_one_ends_it_alike() {
    let grid = Grid::new(48, 43, 3.3e-5, 3.9e-5).unwrap();
    let safe = random_history(&mut cells_on(&pair(), grid).by_safeguard_alone(), 5);
    for steps in [1, 2, 4] {
        let mut engine = cells_on(&pair(), grid).by_safeguard_after(steps);
        let left = random_history(&mut engine, 5);
        assert!(engine.safeguarded_instants() > 20, "{steps} steps");
        assert_alike(&left, &safe, &format!("{steps} steps"));
    }
}

// The guess.

/// Guesses that have nothing, or too much, to do with the answer.
fn guesses(exact: &[f64], grid: &Grid) -> Vec<(&'static str, Vec<f64>)> {
    let peak = largest(exact.iter().copied());
    let (nx, cells) = (grid.cells_x(), grid.cells());
    let with = |changes: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let cells = exact.iter().enumerate();
        cells.map(|(cell, p)| p + peak * changes(cell)).collect()
    };
    let alone = |of: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..cells).map(of).collect() };
    let at_border = |cell: usize| {
        let (x, y) = (cell % nx, cell / nx);
        let is_border = x == 0 || y == 0 || x == nx - 1 || y == grid.cells_y() - 1;
        f64::from(u8::from(is_border))
    };
    let mut random = Random(3);
    let [noise, sparse] = [0, 1].map(|_| (0..cells).map(|_| random.unit()).collect::<Vec<_>>());
    let one = |at: usize, share: f64| move |cell: usize| if cell == at { share } else { 0.0 };
    let spike = |v: f64| if v < 0.02 { 1e9 * v } else { 0.0 };
    vec![
        ("the answer", exact.to_vec()),
        ("1e-9 in a border cell", with(&one(nx / 2, 1e-9))),
        ("1e-15 in a corner", with(&one(cells - 1, 1e-15))),
        ("1e-4 in a border cell", with(&one(nx * 3, 1e-4))),
        (
            "1e-12 in all of the border",
            with(&|cell| 1e-12 * at_border(cell)),
        ),
        ("1e-10 of noise", with(&|cell| 1e-10 * noise[cell])),
        ("1e-300 everywhere", with(&|_| 1e-300)),
        ("noise alone", noise.clone()),
        ("a few spikes", alone(&|cell| spike(sparse[cell]))),
        ("a border alone", alone(&at_border)),
        ("below zero", alone(&|cell| -noise[cell])),
        ("nothing", vec![0.0; cells]),
    ]
}

/// A pressure too small to weigh in any mean, in a cell at the border, is no contact there.
#[test]
fn the_answer_does_not_depend_on_the_guess() {
    let shapes: [(Box<dyn Indenter>, Grid); 3] = [
        (Box::new(pair()), Grid::new(48, 43, 3.3e-5, 3.9e-5).unwrap()),
        (
            Box::new(Ellipsoid::new(0.004, 0.001).unwrap()),
            Grid::square(40, 2.5e-5).unwrap(),
        ),
        (
            Box::new(ball(RADIUS_M)),
            Grid::square(64, 3.0e-5).unwrap().quarter().unwrap(),
        ),
    ];
    for (shape, grid) in &shapes {
        for prescribed in [Prescribed::LoadN(1.0), Prescribed::ApproachM(1e-5)] {
            let new = || cells_on(shape.as_ref(), *grid);
            let (expected, exact) = first_touch(&mut new(), 1e-9, prescribed).unwrap();
            for (what, guess) in guesses(&exact, grid) {
                for steps in [usize::MAX, 0] {
                    let mut pressure = guess.clone();
                    let mut engine = new().by_safeguard_after(steps);
                    let found = solve_from(&mut engine, 1e-9, prescribed, &mut pressure);
                    let found = found.unwrap_or_else(|e| panic!("{what}: {e}"));
                    // The tolerance of 1e-8 on either side, and of what it leaves between cells: as above.
                    near!(found.load_n, expected.load_n, 5e-8, "{what}");
                    near!(found.approach_m, expected.approach_m, 5e-8, "{what}");
                    let radius_m = expected.contact_radius_m;
                    near!(found.contact_radius_m, radius_m, 3e-7, "{what}");
                }
            }
        }
    }
}

// Windows.

#[test]
fn a_contact_that_opens_beyond_the_window_is_found() {
    // The high asperity alone, then both at once: the window of the guess knows nothing of the low one.
    for cells in [64, 97] {
        let grid = Grid::square(cells, 1.4e-3 / cells as f64).unwrap();
        let mut engine = cells_on(&pair(), grid);
        let compliance_per_pa = 1e-9;
        let (_, mut pressure) =
            first_touch(&mut engine, compliance_per_pa, Prescribed::LoadN(0.05)).unwrap();
        let right = |pressure: &[f64]| {
            let cells = pressure.iter().enumerate();
            let right = cells.filter(|(cell, _)| grid.center(*cell).0 > 0.0);
            right.map(|(_, p)| p).sum::<f64>()
        };
        assert_eq!(right(&pressure), 0.0);
        let load = Prescribed::LoadN(4.0);
        let found = solve_from(&mut engine, compliance_per_pa, load, &mut pressure).unwrap();
        assert!(right(&pressure) > 0.0);
        let mut safe = cells_on(&pair(), grid).by_safeguard_alone();
        let (expected, _) = first_touch(&mut safe, compliance_per_pa, load).unwrap();
        assert_same(&found, &expected);
    }
}

/// What noise in a measured creep curve may leave of the past: sources that lift the surface, here up to the indenter beyond
/// the window of the contact.
#[test]
fn a_surface_that_the_past_has_lifted_is_met_beyond_the_window_too() {
    let cells = 96;
    let grid = Grid::square(cells, 2e-5).unwrap();
    let compliance_per_pa = 4e-10;
    for (lift_per_pa, met) in [(-0.1, false), (-0.2, true), (-0.3, true), (-0.45, true)] {
        let mut history = vec![0.0; grid.cells()];
        for iy in 44..52 {
            history[iy * cells + 84..iy * cells + 92].fill(lift_per_pa);
        }
        let solve = |engine: &mut HalfSpace| {
            let instant = Instant {
                history: &history,
                compliance_per_pa,
                prescribed: Prescribed::LoadN(LOAD_N),
            };
            let mut pressure = vec![0.0; grid.cells()];
            // A guess that knows of the contact in the middle alone.
            press_in_the_middle(&mut pressure, grid);
            let found = engine.solve(&instant, &mut pressure).unwrap();
            let right = (0..grid.cells()).filter(|c| c % cells > 80);
            (found, right.map(|c| pressure[c]).sum::<f64>())
        };
        let (fast, right) = solve(&mut cells_on(&ball(RADIUS_M), grid));
        let (safe, expected) = solve(&mut cells_on(&ball(RADIUS_M), grid).by_safeguard_alone());
        assert_eq!((right > 0.0, expected > 0.0), (met, met));
        assert_same(&fast, &safe);
    }
}

/// The pressure of a flat patch at the origin.
fn press_in_the_middle(pressure: &mut [f64], grid: Grid) {
    for (cell, p) in pressure.iter_mut().enumerate() {
        let (x_m, y_m) = grid.center(cell);
        *p = f64::from(u8::from(x_m.hypot(y_m) < 1e-4));
    }
}

#[test]
fn the_size_of_the_domain_about_a_contact_changes_nothing() {
    // Cells of the same size: 64 about the contact, and more and more around them.
    let spacing_m = 2.3 * relaxed_radius_m(LOAD_N) / 64.0;
    let march = |cells: usize| {
        let mut engine = cells_on(&ball(RADIUS_M), Grid::square(cells, spacing_m).unwrap());
        let mut march = marched(&mut engine, LOAD_N);
        let weights = march.weights(8.0);
        let step = |_| march.step(&weights, Prescribed::LoadN(LOAD_N)).unwrap();
        (0..10).map(step).collect::<Vec<_>>()
    };
    let expected = march(64);
    for cells in [80, 128, 300] {
        for (found, expected) in march(cells).iter().zip(&expected) {
            assert_same(found, expected);
        }
    }
}

#[test]
fn an_engine_that_has_solved_something_else_gives_the_same_answer_to_the_last_bit() {
    let half_width_m = 1.3 * relaxed_radius_m(LOAD_N);
    let run = |engine: &mut HalfSpace| {
        let mut march = marched(engine, 0.3 * LOAD_N);
        let weights = march.weights(3.0);
        for step in 1..20 {
            let load = Prescribed::LoadN(LOAD_N * (0.3 + 0.03 * f64::from(step)));
            march.step(&weights, load).unwrap();
        }
        let bits = march.pressure().iter().map(|p| p.to_bits());
        bits.collect::<Vec<_>>()
    };
    let expected = run(&mut half_space(&ball(RADIUS_M), half_width_m, 64));
    let mut used = half_space(&ball(RADIUS_M), half_width_m, 64);
    for load_n in [0.0, 1e-3, LOAD_N, 0.0] {
        first_touch(&mut used, 1e-10, Prescribed::LoadN(load_n)).unwrap();
    }
    assert_eq!(run(&mut used), expected);
    assert_eq!(run(&mut used), expected);
}

// Accuracy.

#[test]
fn radius_and_approach_follow_lee_and_radok_to_a_thousandth_at_every_step() {
    let compliance = pmma();
    let mut engine = half_space(&ball(RADIUS_M), 2.0 * relaxed_radius_m(LOAD_N), 256);
    let mut march = March::new(&mut engine, compliance.clone(), TimeRule::Linear);
    let mut found = vec![(0.0, march.jump(Prescribed::LoadN(LOAD_N)).unwrap())];
    let weights = march.weights(1.0);
    for step in 1..=200 {
        let solution = march.step(&weights, Prescribed::LoadN(LOAD_N)).unwrap();
        found.push((f64::from(step), solution));
    }
    for (time_s, solution) in found {
        let exact_m = step_load_contact_radius_m(RADIUS_M, LOAD_N, &compliance, time_s);
        // A thousandth is 0.06 of a cell; half of it was seen.
        near!(solution.contact_radius_m, exact_m, 1e-3, "{time_s} s");
        // Of second order in the cell, 1/60 of the radius; 1.5e-5 was seen.
        let approach_m = exact_m * exact_m / RADIUS_M;
        near!(solution.approach_m, approach_m, 3e-5, "{time_s} s");
    }
}

#[test]
fn the_march_on_cells_is_of_second_order_in_the_step() {
    // Half a cycle of the load, on the same grid, against very small steps.
    let half_width_m = 1.1 * relaxed_radius_m(1.5 * LOAD_N);
    let end = |steps: usize| {
        let mut engine = half_space(&ball(RADIUS_M), half_width_m, 32);
        let mut march = marched(&mut engine, LOAD_N);
        let weights = march.weights(0.5 * TAU / 0.03 / steps as f64);
        for step in 1..=steps {
            march.step(&weights, swinging(step, 2 * steps)).unwrap();
        }
        march.solution().unwrap().approach_m
    };
    let exact_m = end(640);
    let counts = [10, 20, 40, 80];
    let errors = counts.map(|steps| relative(end(steps), exact_m));
    let order = observed_order(&counts, &errors);
    // Up to the instants at which cells enter and leave, and the reference's own error of 1/64 of the last.
    assert!((order - 2.0).abs() < 0.25, "order {order}: {errors:?}");
}
