//! Indenters of any shape in contact: against closed forms, against one another, and under shifts and reflections; and their
//! way through sweep files.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::common::pmma;
use contact_dma::contact::axisymmetric::{Axisymmetric as Springs, Edge};
use contact_dma::contact::half_space::convolution::Convolution;
use contact_dma::contact::half_space::grid::Grid;
use contact_dma::contact::half_space::{HalfSpace, SolverSettings};
use contact_dma::contact::{ContactError, Engine, Instant, Prescribed, Solution};
use contact_dma::engine::domain;
use contact_dma::history::{March, TimeRule};
use contact_dma::indenter::{
    Asperities, Asperity, Cone, Ellipsoid, HeightMap, Indenter, MapEdge, MapQuantity, PowerLaw,
    Profile, Roughness, Shifted, Sphere,
};
use contact_dma::input::document::Document;
use contact_dma::input::sweep_file;
use contact_dma::reference::elastic::{ConeContact, Hertz};
use contact_dma::reference::elliptic::EllipticHertz;
use contact_dma::reference::power_law::PowerLawContact;
use contact_dma::sweep::case::Setup;
use contact_dma::sweep::plan::resolved;
use contact_dma::sweep::record::{CaseRecord, Status};

const LOAD_N: f64 = 10.0;
const COMPLIANCE_PER_PA: f64 = 4e-10;

/// An elastic contact and its pressure field.
struct Elastic {
    grid: Grid,
    pressure_pa: Vec<f64>,
    solution: Solution,
}

fn engine(indenter: &dyn Indenter, grid: Grid, tolerance: f64) -> HalfSpace {
    let settings = SolverSettings {
        tolerance,
        ..SolverSettings::default()
    };
    let operator = Arc::new(Convolution::new(grid).unwrap());
    let engine = HalfSpace::new(operator, domain::gaps_m(indenter, &grid), true, settings);
    if indenter.ends_in_data() {
        engine.ending_in_data()
    } else {
        engine
    }
}

/// The first domain that a sweep would try.
fn first_grid(indenter: &dyn Indenter, compliance_per_pa: f64, cells: usize) -> Grid {
    domain::grid(&indenter.domain(LOAD_N, compliance_per_pa), cells, 0).unwrap()
}

fn try_solve(indenter: &dyn Indenter, grid: Grid, load_n: f64) -> Result<Elastic, ContactError> {
    solve_to(1e-10, indenter, grid, load_n)
}

fn solve_to(
    tolerance: f64,
    indenter: &dyn Indenter,
    grid: Grid,
    load_n: f64,
) -> Result<Elastic, ContactError> {
    let mut engine = engine(indenter, grid, tolerance);
    let mut pressure_pa = vec![0.0; grid.cells()];
    let history = vec![0.0; grid.cells()];
    let instant = Instant {
        history: &history,
        compliance_per_pa: COMPLIANCE_PER_PA,
        prescribed: Prescribed::LoadN(load_n),
    };
    let solution = engine.solve(&instant, &mut pressure_pa)?;
    Ok(Elastic {
        grid,
        pressure_pa,
        solution,
    })
}

fn solve(indenter: &dyn Indenter, grid: Grid) -> Elastic {
    try_solve(indenter, grid, LOAD_N).unwrap()
}

impl Elastic {
    fn peak_pa(&self) -> f64 {
        self.pressure_pa.iter().copied().fold(0.0, f64::max)
    }

    /// Semi-axes of an ellipsoidal pressure, whose mean squares of x and y are a^2 / 5 and b^2 / 5.
    fn semi_axes_m(&self) -> (f64, f64) {
        semi_axes_m(&self.grid, &self.pressure_pa)
    }

    /// Load carried by the cells that are chosen by their centre.
    fn load_n(&self, chosen: impl Fn(f64, f64) -> bool) -> f64 {
        let cells = self.pressure_pa.iter().enumerate();
        let sum: f64 = cells
            .filter(|(cell, _)| {
                let (x, y) = self.grid.center(*cell);
                chosen(x, y)
            })
            .map(|(_, p)| p)
            .sum();
        sum * self.grid.cell_area_m2()
    }
}

fn semi_axes_m(grid: &Grid, pressure: &[f64]) -> (f64, f64) {
    let (mut x2, mut y2, mut sum) = (0.0, 0.0, 0.0);
    for (cell, p) in pressure.iter().enumerate() {
        let (x, y) = grid.center(cell);
        x2 += p * x * x;
        y2 += p * y * y;
        sum += p;
    }
    ((5.0 * x2 / sum).sqrt(), (5.0 * y2 / sum).sqrt())
}

fn off(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

fn largest_difference(one: &[f64], other: &[f64]) -> f64 {
    let pairs = one.iter().zip(other);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

// Ellipses.

#[test]
fn an_elliptic_contact_converges_to_hertz() {
    let ellipsoid = Ellipsoid::new(0.1, 0.01).unwrap();
    let exact = EllipticHertz {
        radius_x_m: 0.1,
        radius_y_m: 0.01,
        load_n: LOAD_N,
        compliance_per_pa: COMPLIANCE_PER_PA,
    }
    .contact();
    let errors = |cells| {
        let found = solve(&ellipsoid, first_grid(&ellipsoid, COMPLIANCE_PER_PA, cells));
        let (a, b) = found.semi_axes_m();
        [
            off(found.solution.approach_m, exact.approach_m),
            off(found.peak_pa(), exact.peak_pressure_pa),
            off(a, exact.semi_axis_x_m),
            off(b, exact.semi_axis_y_m),
        ]
    };
    let (coarse, fine) = (errors(24), errors(96));
    // At 96 cells for the longer axis: what was measured, with a factor of two for other ways of rounding the contact's rim.
    for (error, bound) in fine.into_iter().zip([5e-5, 3e-4, 1e-4, 1e-4]) {
        assert!(error < bound, "{fine:?}");
    }
    // A rim of cells that are in or out makes the order irregular between 1.5 and 2: over two halvings the mean of approach
    // and peak pressure is regular enough.
    let order = 0.25 * ((coarse[0] * coarse[1]) / (fine[0] * fine[1])).log2();
    assert!(order > 1.4, "{order}");
}

#[test]
fn the_pressure_under_an_ellipsoid_is_an_ellipsoid_along_the_right_axes() {
    let ellipsoid = Ellipsoid::new(0.01, 0.04).unwrap();
    let found = solve(&ellipsoid, first_grid(&ellipsoid, COMPLIANCE_PER_PA, 64));
    let exact = EllipticHertz {
        radius_x_m: 0.01,
        radius_y_m: 0.04,
        load_n: LOAD_N,
        compliance_per_pa: COMPLIANCE_PER_PA,
    }
    .contact();
    assert!(exact.semi_axis_y_m > exact.semi_axis_x_m);
    for (cell, p) in found.pressure_pa.iter().enumerate() {
        let (x, y) = found.grid.center(cell);
        // Where the square root is steep a cell straddles it; inside, the error is of second order.
        let inside = exact.pressure_pa(1.06 * x, 1.06 * y) > 0.0;
        let difference = (p - exact.pressure_pa(x, y)).abs() / exact.peak_pressure_pa;
        assert!(
            difference < if inside { 0.01 } else { 0.2 },
            "{x} {y} {difference}"
        );
    }
}

#[test]
fn under_a_step_load_on_pmma_an_ellipse_keeps_its_shape_and_grows_with_the_creep_compliance() {
    let creep = pmma();
    let relaxed = creep.equilibrium_compliance().unwrap();
    let ellipsoid = Ellipsoid::new(0.05, 0.01).unwrap();
    let grid = first_grid(&ellipsoid, relaxed, 96);
    let mut engine = engine(&ellipsoid, grid, 1e-8);
    let mut march = March::new(&mut engine, creep.clone(), TimeRule::Linear);
    let first = march.jump(Prescribed::LoadN(LOAD_N)).unwrap();
    let shape = |march: &March<'_>| {
        let (a, b) = semi_axes_m(&grid, march.pressure());
        a / b
    };
    let exact = EllipticHertz {
        radius_x_m: 0.05,
        radius_y_m: 0.01,
        load_n: LOAD_N,
        compliance_per_pa: creep.compliance(0.0),
    }
    .contact();
    let ratio = exact.semi_axis_x_m / exact.semi_axis_y_m;
    // The discretisation of the contact, as in the elastic test.
    assert!(off(shape(&march), ratio) < 3e-4);
    assert!(off(first.approach_m, exact.approach_m) < 1e-4);
    let (mut time_s, mut largest) = (0.0, (0.0_f64, 0.0_f64));
    for step_s in [0.5, 1.0, 2.0, 4.0, 8.0, 15.0, 30.0, 60.0, 120.0, 240.0] {
        let weights = march.weights(step_s);
        time_s += step_s;
        let found = march.step(&weights, Prescribed::LoadN(LOAD_N)).unwrap();
        let growth = (creep.compliance(time_s) / creep.compliance(0.0)).powf(2.0 / 3.0);
        largest.0 = largest
            .0
            .max(off(found.approach_m, growth * exact.approach_m));
        largest.1 = largest.1.max(off(shape(&march), ratio));
    }
    // In exact terms C(t) alone scales the problem. Space as above, and the time steps, through which the pressure is linear,
    // add less.
    assert!(largest.0 < 1e-4, "{largest:?}");
    assert!(largest.1 < 3e-4, "{largest:?}");
}

// Several contacts.

#[test]
fn two_equal_spheres_far_apart_carry_half_each_and_press_each_other_down() {
    let radius_m = 0.01;
    let single = Hertz {
        radius_m,
        load_n: 0.5 * LOAD_N,
        compliance_per_pa: COMPLIANCE_PER_PA,
    };
    let apart_m = 8.0 * single.contact_radius_m();
    let sphere = |center_x_m| Asperity {
        center_x_m,
        center_y_m: 0.0,
        radius_m,
        height_m: 0.0,
    };
    let pair = Asperities::new(vec![sphere(-0.5 * apart_m), sphere(0.5 * apart_m)]).unwrap();
    let grid = first_grid(&pair, COMPLIANCE_PER_PA, 256);
    assert_eq!(grid.spacing_x_m(), grid.spacing_y_m());
    assert!(grid.cells_y() < grid.cells_x() / 3);
    let found = solve(&pair, grid);
    let (left, right) = (found.load_n(|x, _| x < 0.0), found.load_n(|x, _| x > 0.0));
    // Symmetric but for the order of the sums within transforms and iterations.
    assert!(off(left, 0.5 * LOAD_N) < 1e-9 && off(right, 0.5 * LOAD_N) < 1e-9);
    // Each contact sinks with the dent that the other one makes where it stands. The curvature of the dent changes that by
    // some (a/d)^2 of it, 0.05 / 64 / 10 of the approach at d = 8 a, and the contact has 26 cells across: 1e-4 each.
    let dent_m = single.displacement_m(apart_m);
    let expected = single.approach_m() + dent_m;
    assert!(dent_m > 0.05 * expected);
    assert!(off(found.solution.approach_m, expected) < 2e-4);
}

#[test]
fn a_lower_asperity_comes_into_contact_when_the_load_is_large_enough() {
    let high = Asperity {
        center_x_m: -4e-4,
        center_y_m: 0.0,
        radius_m: 0.01,
        height_m: 5e-6,
    };
    let low = Asperity {
        center_x_m: 4e-4,
        height_m: 0.0,
        ..high
    };
    let pair = Asperities::new(vec![low, high]).unwrap();
    // Alone, the high one approaches by 5 um at W = 4 sqrt(R) delta^1.5 / (3 C) = 3.73 N.
    for (load_n, both) in [(3.0, false), (10.0, true)] {
        let domain = pair.domain(load_n, COMPLIANCE_PER_PA);
        let grid = domain::grid(&domain, 96, 0).unwrap();
        let found = try_solve(&pair, grid, load_n).unwrap();
        let right_n = found.load_n(|x, _| x > 0.0);
        assert_eq!(right_n > 0.0, both);
        assert!(right_n < 0.5 * load_n);
    }
}

// Shifts and reflections.

#[test]
fn a_shift_by_whole_cells_shifts_the_answer() {
    let ellipsoid = Arc::new(Ellipsoid::new(0.02, 0.01).unwrap());
    // A power of two, so that the offset is exact: 15 um, for a contact of 0.7 mm.
    let grid = Grid::square(80, 2.0_f64.powi(-16)).unwrap();
    let (cells_x, cells_y) = (7_usize, 12_usize);
    let shifted = Shifted::new(
        Arc::clone(&ellipsoid) as _,
        cells_x as f64 * grid.spacing_x_m(),
        -(cells_y as f64) * grid.spacing_y_m(),
    )
    .unwrap();
    let exactly = |indenter| solve_to(1e-13, indenter, grid, LOAD_N).unwrap();
    let (plain, moved) = (exactly(ellipsoid.as_ref()), exactly(&shifted));
    let peak = plain.peak_pa();
    let mut largest = 0.0_f64;
    for (cell, p) in plain.pressure_pa.iter().enumerate().filter(|c| *c.1 > 0.0) {
        let (x, y) = (cell % 80 + cells_x, cell / 80 - cells_y);
        largest = largest.max((moved.pressure_pa[y * 80 + x] - p).abs() / peak);
    }
    let approach = off(moved.solution.approach_m, plain.solution.approach_m);
    // The same gaps bit for bit, but transforms and sums round a shifted field differently, and the iteration then takes
    // another way to its tolerance of 1e-13; the pressure feels it more than the approach, by the 80 cells of the grid.
    assert!(largest < 1e-11 && approach < 1e-12, "{largest} {approach}");
    let radius = off(
        moved.solution.contact_radius_m,
        plain.solution.contact_radius_m,
    );
    assert!(radius < 1e-11, "{radius}");
}

fn roughness(cells: usize) -> Roughness {
    Roughness {
        cells,
        spacing_m: 6.4e-5 / cells as f64,
        hurst_exponent: 0.8,
        rms_height_m: 3e-7,
        roll_off_wavelength_m: Some(2e-5),
        cut_off_wavelength_m: 4e-6,
        seed: 2018,
        sphere_radius_m: Some(1e-4),
        edge: MapEdge::Unknown,
    }
}

fn own_grid(indenter: &dyn Indenter) -> Grid {
    first_grid(indenter, COMPLIANCE_PER_PA, 0)
}

/// On a smooth sphere of 0.1 mm this load makes a contact of a quarter of the map's width.
const ROUGH_LOAD_N: f64 = 0.02;

#[test]
fn a_transposed_or_flipped_surface_gives_the_transposed_or_flipped_answer() {
    let n = 64;
    let rough = roughness(n).map().unwrap();
    let transpose = |index: usize| index % n * n + index / n;
    let flip = |index: usize| index / n * n + (n - 1 - index % n);
    let spacing = (6.4e-5 / n as f64, 6.4e-5 / n as f64);
    let map = |order: &dyn Fn(usize) -> usize| {
        let values = (0..n * n).map(|i| rough.gaps_m()[order(i)]).collect();
        let gap = MapQuantity::Gap;
        HeightMap::new((n, n), spacing, values, gap, MapEdge::Unknown).unwrap()
    };
    let plain = try_solve(&rough, own_grid(&rough), ROUGH_LOAD_N).unwrap();
    let peak = plain.peak_pa();
    for order in [&transpose as &dyn Fn(usize) -> usize, &flip] {
        let other = map(order);
        let other = try_solve(&other, own_grid(&other), ROUGH_LOAD_N).unwrap();
        let back: Vec<f64> = (0..n * n).map(|i| other.pressure_pa[order(i)]).collect();
        let difference = largest_difference(&back, &plain.pressure_pa) / peak;
        // Sums in another order, over some hundred iterations: far below what the tolerance of 1e-10 leaves open.
        assert!(difference < 1e-8, "{difference}");
        let radius = off(
            other.solution.contact_radius_m,
            plain.solution.contact_radius_m,
        );
        assert!(radius < 1e-8, "{radius:e}");
    }
}

#[test]
fn a_rough_contact_on_pmma_is_complementary_and_grows_as_the_body_creeps() {
    let creep = pmma();
    let rough = roughness(96).map().unwrap();
    let grid = own_grid(&rough);
    let gaps_m = domain::gaps_m(&rough, &grid);
    let mut engine = engine(&rough, grid, 1e-9);
    let mut areas = Vec::new();
    let mut march = March::new(&mut engine, creep.clone(), TimeRule::Linear);
    let mut compliance_per_pa = 0.0;
    // A jump, then steps of growing length.
    for step_s in [0.0, 1.0, 2.0, 5.0, 10.0, 30.0, 100.0, 300.0] {
        let weights = march.weights(step_s);
        compliance_per_pa = weights.compliance_per_pa;
        let load = Prescribed::LoadN(ROUGH_LOAD_N);
        let solution = march.step(&weights, load).unwrap();
        assert!(march.pressure().iter().all(|&p| p >= 0.0));
        assert!(off(solution.load_n, ROUGH_LOAD_N) < 1e-12);
        areas.push(std::f64::consts::PI * solution.contact_radius_m.powi(2));
    }
    let pressure_pa = march.pressure().to_vec();
    let approach_m = march.solution().unwrap().approach_m;
    // The gap after the last instant, from the engine's own displacement.
    let displacement_m = engine.displacement_m(compliance_per_pa).unwrap();
    let (mut misfit, mut work, mut lowest_m) = (0.0, 0.0, 0.0_f64);
    for ((p, u_m), gap_m) in pressure_pa.iter().zip(&displacement_m).zip(&gaps_m) {
        let h_m = gap_m + u_m - approach_m;
        misfit += p * h_m.abs();
        work += p * u_m;
        lowest_m = lowest_m.min(h_m);
    }
    let patches = patches(&pressure_pa, 96);
    // The solver's tolerance: 1e-9 of the displacement, of which the approach is a little more.
    assert!(misfit < 1e-9 * work, "{misfit} {work}");
    assert!(lowest_m > -1e-8 * approach_m);
    assert!(areas.windows(2).all(|pair| pair[0] < pair[1]), "{areas:?}");
    assert!(patches > 1);
    let smooth = Hertz {
        radius_m: 1e-4,
        load_n: ROUGH_LOAD_N,
        compliance_per_pa: creep.compliance(0.0),
    };
    assert!(areas[0] < std::f64::consts::PI * smooth.contact_radius_m().powi(2));
}

#[test]
fn a_rough_contact_that_creeps_does_not_depend_on_the_order_of_the_cells() {
    let n = 48;
    let rough = roughness(n).map().unwrap();
    let transpose = |index: usize| index % n * n + index / n;
    let flip = |index: usize| index / n * n + (n - 1 - index % n);
    let same = |index: usize| index;
    let spacing = (6.4e-5 / n as f64, 6.4e-5 / n as f64);
    // Pressure and contact radius at the end of a step load on PMMA, in the order of the plain surface.
    let crept = |order: &dyn Fn(usize) -> usize| {
        let values = (0..n * n).map(|i| rough.gaps_m()[order(i)]).collect();
        let gap = MapQuantity::Gap;
        let map = HeightMap::new((n, n), spacing, values, gap, MapEdge::Unknown).unwrap();
        let mut engine = engine(&map, own_grid(&map), 1e-11);
        let mut march = March::new(&mut engine, pmma(), TimeRule::Linear);
        for step_s in [0.0, 3.0, 10.0, 50.0, 200.0] {
            let weights = march.weights(step_s);
            march
                .step(&weights, Prescribed::LoadN(ROUGH_LOAD_N))
                .unwrap();
        }
        let back: Vec<f64> = (0..n * n).map(|i| march.pressure()[order(i)]).collect();
        (back, march.solution().unwrap().contact_radius_m)
    };
    let (plain, radius_m) = crept(&same);
    let peak = plain.iter().copied().fold(0.0, f64::max);
    for order in [&transpose as &dyn Fn(usize) -> usize, &flip] {
        let (other, its_radius_m) = crept(order);
        let difference = largest_difference(&other, &plain) / peak;
        // As in the elastic test, through five instants.
        assert!(difference < 1e-8, "{difference:e}");
        assert!(off(its_radius_m, radius_m) < 1e-8);
    }
}

/// Number of contact patches whose cells join along sides, on a square grid of `n` cells per side.
fn patches(pressure: &[f64], n: usize) -> usize {
    let mut open: Vec<bool> = pressure.iter().map(|&p| p > 0.0).collect();
    let mut count = 0;
    while let Some(start) = open.iter().position(|&cell| cell) {
        count += 1;
        let mut reached = vec![start];
        while let Some(cell) = reached.pop() {
            if std::mem::take(&mut open[cell]) {
                // The border is never in contact, so that every neighbour is on the grid.
                reached.extend([cell - 1, cell + 1, cell - n, cell + n]);
            }
        }
    }
    count
}

#[test]
fn a_surface_whose_contact_reaches_its_border_says_so_and_one_with_a_rim_does_not() {
    let flat = Roughness {
        sphere_radius_m: None,
        ..roughness(48)
    };
    let open = flat.map().unwrap();
    assert!(matches!(
        try_solve(&open, own_grid(&open), 5.0),
        Err(ContactError::ReachedEdge { .. })
    ));
    let edge = MapEdge::Rim;
    let rim = Roughness { edge, ..flat }.map().unwrap();
    let found = try_solve(&rim, own_grid(&rim), 5.0).unwrap();
    assert!(off(found.load_n(|_, _| true), 5.0) < 1e-9);
    // Moved by whole cells the border of the data lies inside the grid, and still counts.
    let moved = Shifted::new(Arc::new(open), 3.0 * 6.4e-5 / 48.0, 0.0).unwrap();
    assert!(matches!(
        try_solve(&moved, own_grid(&moved), 5.0),
        Err(ContactError::ReachedEdge { .. })
    ));
}

// Bodies of revolution.

/// Load, approach, contact radius and peak pressure by the axisymmetric engine.
fn springs(indenter: &dyn Indenter, springs: usize) -> (Solution, Option<f64>) {
    let body = indenter.axisymmetric().unwrap();
    let half_m = 1.02 * indenter.elastic_half_width_m(LOAD_N, COMPLIANCE_PER_PA);
    let width_m = half_m / springs as f64;
    let gaps = (0..springs)
        .map(|i| body.transformed_gap_m((i as f64 + 0.5) * width_m))
        .collect();
    let mut engine = Springs::new(width_m, gaps, Edge::Open, body.has_bounded_pressure());
    let history = vec![0.0; springs];
    let instant = Instant {
        history: &history,
        compliance_per_pa: COMPLIANCE_PER_PA,
        prescribed: Prescribed::LoadN(LOAD_N),
    };
    let mut force = vec![0.0; springs];
    let solution = engine.solve(&instant, &mut force).unwrap();
    let peak = engine.peak_pressure_pa(&force, &solution).unwrap();
    (solution, peak)
}

#[test]
fn power_laws_meet_galin_and_sneddon_in_both_engines() {
    for exponent in [1.5, 2.0, 4.0] {
        let law = PowerLaw::new(exponent, 4e-4, 8e-6).unwrap();
        let exact = PowerLawContact {
            exponent,
            radius_m: 4e-4,
            height_m: 8e-6,
            load_n: LOAD_N,
            compliance_per_pa: COMPLIANCE_PER_PA,
        };
        assert!(
            off(
                law.elastic_half_width_m(LOAD_N, COMPLIANCE_PER_PA),
                exact.contact_radius_m()
            ) < 1e-12
        );
        let error = |count| off(springs(&law, count).0.approach_m, exact.approach_m());
        let (coarse, fine) = (error(100), error(400));
        let grid = first_grid(&law, COMPLIANCE_PER_PA, 96);
        let cells = solve(&law, grid);
        let cell_error = off(cells.solution.approach_m, exact.approach_m());
        // Midpoint rule over a kinked sum: second order, irregular by where the edge falls within a spring.
        assert!(fine < 5e-7 * exponent && fine < 0.3 * coarse);
        // Stepped pressure on 87 cells per diameter: 1e-5 to 4e-5 were measured.
        assert!(cell_error < 1e-4, "{exponent}: {cell_error}");
        let (_, peak) = springs(&law, 400);
        if exponent <= 2.0 {
            // Up to 2 the pressure is largest on the axis. Below 2 it has a cusp there, which springs of width h blunt by
            // sqrt(h/a) in 1.5: 3 %.
            let bound = if exponent < 2.0 { 0.04 } else { 1e-4 };
            let expected = exact.axis_pressure_pa().unwrap();
            assert!(off(peak.unwrap(), expected) < bound, "{exponent}");
        }
    }
}

#[test]
fn exponent_2_gives_the_answer_of_the_sphere_and_exponent_1_that_of_the_cone() {
    let law = PowerLaw::new(2.0, 1e-3, 5e-5).unwrap();
    let sphere = Sphere::new(0.01).unwrap();
    let sharp = PowerLaw::new(1.0, 1e-3, 1e-4).unwrap();
    let cone = Cone::new(10.0_f64.atan()).unwrap();
    let pairs: [(&dyn Indenter, &dyn Indenter); 2] = [(&law, &sphere), (&sharp, &cone)];
    for (one, other) in pairs {
        // Roundings of powers and of the gamma function, 1e-15, through either engine.
        let ((a, _), (b, _)) = (springs(one, 200), springs(other, 200));
        assert!(off(a.approach_m, b.approach_m) < 1e-13);
        let grid = first_grid(other, COMPLIANCE_PER_PA, 48);
        let (a, b) = (solve(one, grid), solve(other, grid));
        assert!(off(a.solution.approach_m, b.solution.approach_m) < 1e-12);
        assert!(largest_difference(&a.pressure_pa, &b.pressure_pa) < 1e-10 * b.peak_pa());
    }
}

#[test]
fn tabulated_profiles_give_the_answers_of_the_shapes_they_were_taken_from() {
    let sphere = Sphere::new(0.01).unwrap();
    let cone = Cone::new(1.5).unwrap();
    let shapes: [&dyn Indenter; 2] = [&sphere, &cone];
    for shape in shapes {
        let contact_m = shape.elastic_half_width_m(LOAD_N, COMPLIANCE_PER_PA);
        let points: Vec<(f64, f64)> = (0..=30)
            .map(|i| 2.0 * contact_m * f64::from(i) / 30.0)
            .map(|r| (r, shape.gap_m(r, 0.0)))
            .collect();
        let profile = Profile::new(&points).unwrap();
        let ((a, peak), (b, its_peak)) = (springs(&profile, 200), springs(shape, 200));
        assert!(off(a.approach_m, b.approach_m) < 1e-12);
        assert_eq!(peak.is_some(), its_peak.is_some());
        let grid = first_grid(shape, COMPLIANCE_PER_PA, 48);
        let (a, b) = (solve(&profile, grid), solve(shape, grid));
        assert!(off(a.solution.approach_m, b.solution.approach_m) < 1e-12);
        assert!(largest_difference(&a.pressure_pa, &b.pressure_pa) < 1e-10 * b.peak_pa());
    }
    let exact = ConeContact {
        half_angle_rad: 1.5,
        load_n: LOAD_N,
        compliance_per_pa: COMPLIANCE_PER_PA,
    };
    assert!(off(springs(&cone, 400).0.approach_m, exact.approach_m()) < 1e-5);
}

#[test]
fn a_profile_that_ends_too_soon_says_so_in_both_engines() {
    let sphere = Sphere::new(0.01).unwrap();
    let contact_m = sphere.elastic_half_width_m(LOAD_N, COMPLIANCE_PER_PA);
    let table: Vec<(f64, f64)> = (0..=10)
        .map(|i| 0.9 * contact_m * f64::from(i) / 10.0)
        .map(|r| (r, sphere.gap_m(r, 0.0)))
        .collect();
    let profile = Profile::new(&table).unwrap();
    assert_eq!(
        profile.elastic_half_width_m(LOAD_N, COMPLIANCE_PER_PA),
        profile.end_m()
    );
    // A grid far wider than the table: it ends inside.
    let grid = Grid::square(64, 4.0 * contact_m / 64.0).unwrap();
    assert!(matches!(
        try_solve(&profile, grid, LOAD_N),
        Err(ContactError::ReachedEdge { .. })
    ));
    let folder = tempfile::TempDir::new().unwrap();
    let lines: Vec<String> = table.iter().map(|(r, g)| format!("{r:e},{g:e}")).collect();
    write(
        folder.path(),
        "tip.csv",
        &format!("r_m,gap_m\n{}\n", lines.join("\n")),
    );
    for engine in ["axisymmetric", "half-space"] {
        let block = "shape = \"profile\"\nfile = \"tip.csv\"";
        let record = run(
            folder.path(),
            block,
            &format!("engine = \"{engine}\"\ncells = 32"),
        );
        assert_eq!(record.status, Status::Failed);
        let message = record.message.unwrap();
        assert!(
            message.contains("give a larger map or a longer profile"),
            "{message}"
        );
        assert_eq!(record.domain_half_width_m, profile.end_m());
    }
}

// Sweep files.

fn write(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).unwrap();
}

fn sweep_text(indenter: &str, solver: &str) -> String {
    format!(
        "title = \"shapes\"\n[material]\nlibrary = \"pmma\"\n[indenter]\n{indenter}\n[drive]\nmean = \"10 N\"\n\
         amplitude = \"5 N\"\n[sweep]\nangular_frequency = [\"0.01 rad/s\"]\n[cycle]\nsteps = 10\ntolerance = 1e-2\n\
         [solver]\n{solver}\n"
    )
}

fn setup(folder: &Path, indenter: &str, solver: &str) -> Setup {
    let document = Document::parse("sweep.toml", &sweep_text(indenter, solver)).unwrap();
    let plan = sweep_file::plan(&document.in_folder(folder)).unwrap();
    Setup::new(plan).unwrap()
}

fn run(folder: &Path, indenter: &str, solver: &str) -> CaseRecord {
    let setup = setup(folder, indenter, solver);
    setup
        .run(&setup.plan().cases()[0], &AtomicBool::new(false))
        .unwrap()
}

/// A paraboloid of 10 mm on 24 x 20 points, as a matrix of heights.
fn heights() -> (Vec<Vec<f64>>, f64) {
    let spacing = 5e-5;
    let at = |i: usize, n: usize| (i as f64 - 0.5 * (n - 1) as f64) * spacing;
    let row = |y: usize| {
        let columns = 0..24;
        columns
            .map(|x| 3e-6 - (at(x, 24).powi(2) + at(y, 20).powi(2)) / 0.02)
            .collect()
    };
    ((0..20).map(row).collect(), spacing)
}

fn csv_text(rows: &[Vec<f64>]) -> String {
    let line = |row: &Vec<f64>| {
        let cells: Vec<String> = row.iter().map(|z| format!("{z:e}")).collect();
        cells.join(",") + "\n"
    };
    rows.iter().map(line).collect()
}

/// The same as columns x_m, y_m, z_m, far from the origin.
fn points_text(rows: &[Vec<f64>], spacing_m: f64) -> String {
    let mut text = "x_m,y_m,z_m\n".to_owned();
    for (y, row) in rows.iter().enumerate() {
        for (x, z) in row.iter().enumerate() {
            let (x, y) = (1.0 + x as f64 * spacing_m, y as f64 * spacing_m);
            text += &format!("{x:e},{y:e},{z:e}\n");
        }
    }
    text
}

fn scaled(rows: &[Vec<f64>], factor: f64) -> Vec<Vec<f64>> {
    let row = |row: &Vec<f64>| row.iter().map(|z| factor * z).collect();
    rows.iter().map(row).collect()
}

/// As numpy.save writes a C-ordered array of doubles.
fn npy_bytes(rows: &[Vec<f64>]) -> Vec<u8> {
    let (ny, nx) = (rows.len(), rows[0].len());
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({ny}, {nx}), }}");
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(format!("{header:<117}\n").as_bytes());
    bytes.extend(rows.iter().flatten().flat_map(|z| z.to_le_bytes()));
    bytes
}

#[test]
fn the_same_height_map_comes_from_a_matrix_from_points_and_from_npy() {
    let folder = tempfile::TempDir::new().unwrap();
    let (rows, spacing) = heights();
    write(folder.path(), "map.csv", &csv_text(&rows));
    fs::write(folder.path().join("map.npy"), npy_bytes(&rows)).unwrap();
    write(folder.path(), "points.csv", &points_text(&rows, spacing));
    let approach = |block: &str| {
        let setup = setup(folder.path(), block, "tolerance = 1e-9");
        let indenter = &setup.plan().base.contact.indenter;
        let record = setup
            .run(&setup.plan().cases()[0], &AtomicBool::new(false))
            .unwrap();
        assert_eq!(record.status, Status::Converged, "{:?}", record.message);
        let gaps: Vec<f64> = (0..24)
            .map(|x| indenter.gap_m((f64::from(x) - 11.5) * spacing, 0.5 * spacing))
            .collect();
        (record.result.unwrap().approach_m.maximum, gaps)
    };
    let map = "shape = \"height-map\"\n";
    let matrix = approach(&format!("{map}file = \"map.csv\"\nspacing = \"50 um\""));
    let npy = approach(&format!(
        "{map}file = \"map.npy\"\nspacing = [\"50 um\", \"50 um\"]"
    ));
    let by_points = approach(&format!("{map}file = \"points.csv\""));
    assert_eq!(matrix, npy);
    // The spacing comes from coordinates of 1 m written to their last digit: 1e-16 / 1e-3 of it.
    assert!(off(by_points.0, matrix.0) < 1e-10);
    assert_eq!(by_points.1, matrix.1);
    // The map is a sphere's but for the tip: the highest points stand half a cell off the axis in both directions, and the
    // least gap counts as 0. For the rest, 15 cells over the contact: twice what was measured.
    let sphere = run(
        folder.path(),
        "shape = \"sphere\"\nradius = \"10 mm\"",
        "engine = \"axisymmetric\"",
    );
    let tip_m = 2.0 * (0.5 * spacing).powi(2) / 0.02;
    let difference = off(matrix.0, sphere.result.unwrap().approach_m.maximum - tip_m);
    assert!(difference < 2e-3, "{difference}");
}

#[test]
fn the_resolved_sweep_gives_every_shape_again() {
    let folder = tempfile::TempDir::new().unwrap();
    let (rows, spacing) = heights();
    write(folder.path(), "map.csv", &csv_text(&rows));
    write(folder.path(), "um.csv", &csv_text(&scaled(&rows, 1e6)));
    write(folder.path(), "points.csv", &points_text(&rows, spacing));
    write(
        folder.path(),
        "tip.csv",
        "r_m,gap_m\n0,0\n1e-4,1e-6\n5e-4,1.2e-5\n2e-3,2e-4\n",
    );
    for block in [
        "shape = \"ellipsoid\"\nradius_x = \"30 mm\"\nradius_y = \"0.1 m\"",
        "shape = \"power-law\"\nexponent = 1.5\nradius = \"1 mm\"\nheight = \"20 um\"",
        "shape = \"profile\"\nfile = \"tip.csv\"",
        "shape = \"height-map\"\nfile = \"map.csv\"\nspacing = \"50 um\"\nedge = \"rim\"\nquantity = \"gap\"",
        "shape = \"height-map\"\nfile = \"um.csv\"\nspacing = [\"50 um\", \"40 um\"]\nheight_unit = \"µm\"\nlevel = \"plane\"",
        "shape = \"height-map\"\nfile = \"points.csv\"\nlevel = \"mean\"",
        "shape = \"asperities\"\nasperities = [{ center = [\"1 um\", 0.0], radius = \"3 mm\" },\n\
         { center = [\"-1 mm\", \"0.3 mm\"], radius = \"2 mm\", height = \"-1 um\" }]\noffset = [\"1 um\", \"-2 um\"]",
        "shape = \"rough\"\ncells = 32\nspacing = \"1 um\"\nhurst_exponent = 0.7\nrms_height = \"10 nm\"\n\
         cut_off_wavelength = \"4 um\"\nroll_off_wavelength = \"16 um\"\nseed = 7\nsphere_radius = \"1 mm\"",
        "shape = \"sphere\"\nradius = \"3 mm\"\noffset = [0.0, \"0.1 mm\"]",
    ] {
        let plan = setup(folder.path(), block, "").plan().clone();
        let text = resolved::resolved_text(&plan);
        // From another folder: the paths are whole.
        let document = Document::parse("resolved.toml", &text).unwrap();
        let again = sweep_file::plan(&document).unwrap_or_else(|e| panic!("{text}\n{e}"));
        assert_eq!(resolved::resolved_text(&again), text);
        // A map's own cells are those of the set-up.
        let again = Setup::new(again).unwrap().plan().clone();
        assert_eq!(again.solver, plan.solver);
        for (x, y) in [(0.0, 0.0), (3e-6, -7e-6), (2e-4, 1e-4), (1.0, 1.0)] {
            assert_eq!(
                again.base.contact.indenter.gap_m(x, y),
                plan.base.contact.indenter.gap_m(x, y)
            );
        }
    }
}

#[test]
fn a_tilted_map_in_micrometres_is_the_map_that_it_is_without_tilt_in_metres() {
    let folder = tempfile::TempDir::new().unwrap();
    let (rows, spacing) = heights();
    let tilted =
        |y: usize, x: usize| 1e6 * (rows[y][x] + spacing * (0.05 * x as f64 - 0.1 * y as f64));
    let tilted: Vec<Vec<f64>> = (0..20)
        .map(|y| (0..24).map(|x| tilted(y, x)).collect())
        .collect();
    write(folder.path(), "map.csv", &csv_text(&rows));
    write(folder.path(), "um.csv", &csv_text(&scaled(&rows, 1e6)));
    write(folder.path(), "tilted.csv", &csv_text(&tilted));
    let plan = |rest: &str| {
        let block = format!("shape = \"height-map\"\nspacing = \"50 um\"\n{rest}");
        setup(folder.path(), &block, "cells = 64").plan().clone()
    };
    let plain = plan("file = \"map.csv\"");
    // The map has the cells it has, and the plan says so.
    assert_eq!(plain.solver.cells, 24);
    assert!(!resolved::resolved_text(&plain).contains("\ncells ="));
    for rest in [
        "file = \"um.csv\"\nheight_unit = \"um\"",
        "file = \"um.csv\"\nheight_unit = \"um\"\nlevel = \"mean\"",
        "file = \"tilted.csv\"\nheight_unit = \"um\"\nlevel = \"plane\"",
    ] {
        let other = plan(rest);
        for (x, y) in [(0.0, 0.0), (1e-4, -2e-4), (-5e-4, 4.7e-4)] {
            let difference =
                other.base.contact.indenter.gap_m(x, y) - plain.base.contact.indenter.gap_m(x, y);
            // Rounding of heights of 200 um, before the tilt is taken out.
            assert!(difference.abs() < 1e-18, "{rest}: {difference:e}");
        }
    }
}

#[test]
fn a_file_that_changed_since_the_resolved_sweep_was_written_is_refused() {
    let folder = tempfile::TempDir::new().unwrap();
    write(folder.path(), "map.csv", &csv_text(&heights().0));
    let block = "shape = \"height-map\"\nfile = \"map.csv\"\nspacing = \"50 um\"";
    let plan = setup(folder.path(), block, "").plan().clone();
    let text = resolved::resolved_text(&plan);
    let mut other = heights().0;
    other[3][3] += 1e-9;
    write(folder.path(), "map.csv", &csv_text(&other));
    let document = Document::parse("resolved.toml", &text).unwrap();
    let message = sweep_file::plan(&document).unwrap_err().to_string();
    for part in [
        "is not the file it was",
        "SHA-256 now is",
        "remove `sha256`",
    ] {
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn the_engine_is_chosen_by_the_shape_and_a_wrong_choice_is_explained() {
    use contact_dma::engine::EngineKind;
    let folder = tempfile::TempDir::new().unwrap();
    write(
        folder.path(),
        "ring.csv",
        "r_m,gap_m\n0,1e-6\n1e-4,0\n2e-4,1e-6\n1e-3,5e-5\n",
    );
    write(
        folder.path(),
        "tip.csv",
        "r_m,gap_m\n0,0\n1e-4,1e-6\n1e-3,5e-5\n",
    );
    let ellipsoid = "shape = \"ellipsoid\"\nradius_x = \"30 mm\"\nradius_y = \"10 mm\"";
    let (ring, tip) = (
        "shape = \"profile\"\nfile = \"ring.csv\"",
        "shape = \"profile\"\nfile = \"tip.csv\"",
    );
    for (block, engine) in [
        (ellipsoid, EngineKind::HalfSpace),
        (ring, EngineKind::HalfSpace),
        (tip, EngineKind::Axisymmetric),
        ("shape = \"sphere\"\nradius = 1", EngineKind::Axisymmetric),
    ] {
        let setup = setup(folder.path(), block, "cells = 16");
        assert_eq!(setup.plan().solver.engine, engine, "{block}");
    }
    for (block, because) in [
        (ellipsoid, "two different radii"),
        (ring, "not convex from r = 0e0 m"),
    ] {
        let text = sweep_text(block, "engine = \"axisymmetric\"");
        let document = Document::parse("sweep.toml", &text).unwrap();
        let plan = sweep_file::plan(&document.in_folder(folder.path())).unwrap();
        let message = Setup::new(plan).err().unwrap().to_string();
        assert!(message.contains(because), "{message}");
        assert!(message.contains("solver.engine = \"half-space\""));
    }
}

#[test]
fn a_ring_makes_a_ring_of_contact() {
    let ring: Vec<(f64, f64)> = (0..=40)
        .map(|i| 2e-5 * f64::from(i))
        .map(|r| (r, (r - 3e-4).powi(2) / 0.02))
        .collect();
    let ring = Profile::new(&ring).unwrap();
    let grid = domain::grid(&ring.domain(1.0, COMPLIANCE_PER_PA), 96, 0).unwrap();
    let found = try_solve(&ring, grid, 1.0).unwrap();
    assert_eq!(found.load_n(|x, y| x.hypot(y) < 2e-4), 0.0);
    assert!(off(found.load_n(|x, y| x.hypot(y) < 4e-4), 1.0) < 1e-9);
}
