//! Cost of one instant and of one cycle, both engines.

use std::hint::black_box;
use std::sync::Arc;

use contact_dma::contact::axisymmetric::{Axisymmetric, Edge};
use contact_dma::contact::half_space::convolution::Convolution;
use contact_dma::contact::half_space::grid::Grid;
use contact_dma::contact::half_space::{HalfSpace, SolverSettings};
use contact_dma::contact::{Engine, Instant, Prescribed};
use contact_dma::history::{March, TimeRule};
use contact_dma::indenter::{Axisymmetric as _, Indenter, Sphere};
use contact_dma::material::{Creep, library};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};

const RADIUS_M: f64 = 0.01;
const MEAN_N: f64 = 10.0;
const AMPLITUDE_N: f64 = 5.0;

fn pmma() -> Creep {
    let entry = library::find("pmma").expect("in the library");
    let material = entry.material().expect("a tested entry");
    material
        .contact_compliance()
        .expect("has an instantaneous compliance")
}

fn largest_radius_m(compliance: &Creep) -> f64 {
    let relaxed = compliance.equilibrium_compliance().expect("a solid");
    (0.75 * (MEAN_N + AMPLITUDE_N) * RADIUS_M * relaxed).cbrt()
}

fn springs(count: usize) -> Axisymmetric {
    let sphere = Sphere::new(RADIUS_M).expect("a positive radius");
    let width_m = 1.02 * largest_radius_m(&pmma()) / count as f64;
    let gap = |i| sphere.transformed_gap_m((f64::from(i) + 0.5) * width_m);
    Axisymmetric::new(
        width_m,
        (0..count as u32).map(gap).collect(),
        Edge::Open,
        true,
    )
}

fn cells(count: usize) -> HalfSpace {
    let sphere = Sphere::new(RADIUS_M).expect("a positive radius");
    let spacing_m = 2.2 * largest_radius_m(&pmma()) / count as f64;
    let grid = Grid::square(count, spacing_m).expect("a valid grid");
    let operator = Arc::new(Convolution::new(grid).expect("plannable"));
    let gap = |cell| {
        let (x_m, y_m) = operator.grid().center(cell);
        sphere.gap_m(x_m, y_m)
    };
    let gaps = (0..operator.grid().cells()).map(gap).collect();
    HalfSpace::new(operator, gaps, true, SolverSettings::default())
}

/// The first instant, from no guess.
fn instant(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("instant");
    group.sample_size(20);
    let mut engines: [(&str, Box<dyn Engine>); 3] = [
        ("400 springs", Box::new(springs(400))),
        ("64 x 64 cells", Box::new(cells(64))),
        ("128 x 128 cells", Box::new(cells(128))),
    ];
    for (name, engine) in &mut engines {
        let history = vec![0.0; engine.nodes()];
        let instant = Instant {
            history: &history,
            compliance_per_pa: pmma().instantaneous_compliance(),
            prescribed: Prescribed::LoadN(MEAN_N),
        };
        group.bench_function(*name, |bencher| {
            bencher.iter_batched_ref(
                || vec![0.0; history.len()],
                |pressure| black_box(engine.solve(&instant, pressure)).expect("converges"),
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

/// One cycle of 100 steps at 0.01 rad/s, after the carrier load.
fn cycle(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("cycle of 100 steps");
    group.sample_size(10);
    let mut engines: [(&str, Box<dyn Engine>); 2] = [
        ("400 springs", Box::new(springs(400))),
        ("64 x 64 cells", Box::new(cells(64))),
    ];
    for (name, engine) in &mut engines {
        group.bench_function(*name, |bencher| {
            bencher.iter(|| {
                let mut march = March::new(engine.as_mut(), pmma(), TimeRule::Linear);
                march.jump(Prescribed::LoadN(MEAN_N)).expect("converges");
                let weights = march.weights(std::f64::consts::TAU / 0.01 / 100.0);
                for step in 1..=100 {
                    let angle = std::f64::consts::TAU * f64::from(step) / 100.0;
                    let load = Prescribed::LoadN(MEAN_N + AMPLITUDE_N * angle.sin());
                    black_box(march.step(&weights, load)).expect("converges");
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, instant, cycle);
criterion_main!(benches);
