//! The half-space engine on a quarter of a surface that is even in x and in y, against the whole of it.

use crate::prelude::*;
use contact_dma::contact::surface::{CellSurface, Response, Surface};

/// Far below what is compared: the two stop at different iterates.
const TOLERANCE: f64 = 1e-12;

/// Gap (m) at a place, by its name.
type Shape = (&'static str, fn(f64, f64) -> f64);

const SHAPES: [Shape; 4] = [
    ("sphere", |x, y| 50.0 * (x * x + y * y)),
    ("ellipsoid", |x, y| 80.0 * x * x + 30.0 * y * y),
    ("punch", |x, y| match x.hypot(y) <= 2e-4 {
        true => 0.0,
        false => f64::INFINITY,
    }),
    // A contact that does not hold the origin: four of them.
    ("ring", |x, y| {
        50.0 * (x.abs() - 2e-4).powi(2) + 50.0 * (y.abs() - 2e-4).powi(2)
    }),
];

fn engine(grid: Grid, gap: fn(f64, f64) -> f64) -> HalfSpace {
    let gaps_m = (0..grid.cells()).map(|cell| {
        let (x_m, y_m) = grid.center(cell);
        gap(x_m, y_m)
    });
    let operator = Arc::new(Convolution::new(grid).unwrap());
    HalfSpace::new(operator, gaps_m.collect(), true, to_tolerance(TOLERANCE))
}

struct Solved {
    solution: Solution,
    surface: CellSurface,
    peak_pa: f64,
}

/// A loading, then an instant whose history is part of what the first pressed in.
fn solve_twice(engine: &mut HalfSpace, prescribed: [Prescribed; 2]) -> [Solved; 2] {
    const COMPLIANCE: f64 = 1e-9;
    let mut pressure = vec![0.0; engine.nodes()];
    let mut history = vec![0.0; engine.nodes()];
    prescribed.map(|prescribed| {
        let instant = Instant {
            history: &history,
            compliance_per_pa: COMPLIANCE,
            prescribed,
        };
        let solution = engine.solve(&instant, &mut pressure).unwrap();
        let surface = engine.surface(&Response {
            pressure: &pressure,
            history: &history,
            compliance_per_pa: COMPLIANCE,
            contact_radius_m: solution.contact_radius_m,
        });
        let Ok(Surface::Cells(surface)) = surface else {
            panic!("a surface of cells");
        };
        let peak_pa = engine.peak_pressure_pa(&pressure, &solution).unwrap();
        for (h, p) in history.iter_mut().zip(&pressure) {
            *h = 0.4 * COMPLIANCE * p;
        }
        Solved {
            solution,
            surface,
            peak_pa: peak_pa.unwrap(),
        }
    })
}

fn assert_alike(name: &str, a: &Solved, b: &Solved) {
    let (one, other) = (&a.solution, &b.solution);
    // Stopped at the tolerance, the pressure is known to some ten thousand times it at single cells of the border.
    const ALIKE: f64 = 1e4 * TOLERANCE;
    for (a, b) in [
        (one.load_n, other.load_n),
        (one.approach_m, other.approach_m),
        (one.contact_radius_m, other.contact_radius_m),
        (a.peak_pa, b.peak_pa),
    ] {
        let is_alike = (a - b).abs() <= ALIKE * b.abs();
        assert!(is_alike, "{name}: {one:?} {other:?}");
    }
    let (a, b) = (&a.surface, &b.surface);
    assert_eq!(a.grid, b.grid);
    for (a, b) in [
        (&a.pressure_pa, &b.pressure_pa),
        (&a.displacement_m, &b.displacement_m),
    ] {
        let allowed = ALIKE * largest(b.iter().copied());
        assert!(largest_difference(a, b) <= allowed, "{name}");
    }
}

#[test]
fn a_quarter_has_the_contact_of_the_whole() {
    // More cells along x; the windows are smaller than the grid.
    let whole = Grid::new(144, 120, 1e-5, 1e-5).unwrap();
    let quarter = whole.quarter().unwrap();
    let drives = [
        [Prescribed::LoadN(3.0), Prescribed::LoadN(1.0)],
        [Prescribed::ApproachM(3e-6), Prescribed::ApproachM(1.7e-6)],
        [Prescribed::LoadN(2.0), Prescribed::LoadN(0.0)],
    ];
    for (name, gap) in SHAPES {
        for drive in drives {
            let own = solve_twice(&mut engine(quarter, gap), drive);
            let expected = solve_twice(&mut engine(whole, gap), drive);
            for (own, expected) in own.iter().zip(&expected) {
                assert_alike(name, own, expected);
            }
        }
    }
}

#[test]
fn the_safe_way_has_the_same_contact_on_a_quarter() {
    let quarter = Grid::square(64, 1.5e-5).unwrap().quarter().unwrap();
    let drive = [Prescribed::LoadN(3.0), Prescribed::ApproachM(1.7e-6)];
    let fast = solve_twice(&mut engine(quarter, SHAPES[1].1), drive);
    let mut safe = engine(quarter, SHAPES[1].1).by_safeguard_alone();
    let safe = solve_twice(&mut safe, drive);
    for (fast, safe) in fast.iter().zip(&safe) {
        assert_alike("safe way", fast, safe);
    }
}

#[test]
fn contact_at_the_outer_border_is_an_error_and_at_the_axes_is_none() {
    let quarter = Grid::square(32, 1e-5).unwrap().quarter().unwrap();
    let mut engine = engine(quarter, SHAPES[0].1);
    let mut solve = |load_n| first_touch(&mut engine, 1e-9, Prescribed::LoadN(load_n));
    assert!(solve(0.1).is_ok());
    let error = solve(50.0).unwrap_err().to_string();
    assert!(error.contains("half width 1.600e-4 m"), "{error}");
}
