//! What the half-space engine costs, from one convolution to a sweep, and by how much its fast way is ahead of its safe one.
//! CPU time of one thread; every ratio is taken within this one run.
//!
//!     cargo bench --bench half_space -- [CELLS]

mod common;

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use common::{LOAD_N, RADIUS_M, engine, hertz_radius_m, numbers, pmma, timed};
use contact_dma::contact::half_space::HalfSpace;
use contact_dma::contact::half_space::convolution::Convolution;
use contact_dma::contact::half_space::grid::Grid;
use contact_dma::contact::{Engine, Instant, Prescribed};
use contact_dma::drive::HarmonicDrive;
use contact_dma::engine::EngineKind;
use contact_dma::history::{March, TimeRule};
use contact_dma::indenter::Sphere;
use contact_dma::material::library;
use contact_dma::sweep::case::Setup;
use contact_dma::sweep::plan::SweepPlan;

/// Width (m) of a domain of four radii of the largest contact under this load.
fn width_m(load_n: f64) -> f64 {
    let relaxed = pmma().equilibrium_compliance().unwrap_or(f64::NAN);
    4.0 * hertz_radius_m(load_n, relaxed)
}

/// CPU seconds of one convolution of a load that fills a disc across the grid.
fn convolution_s(cells: usize) -> f64 {
    let grid = Grid::square(cells, 1.0).expect("a valid grid");
    let operator = Convolution::new(grid).expect("plannable");
    let mut scratch = operator.scratch();
    let radius = 0.4 * cells as f64;
    let load = |cell| {
        let (x, y) = grid.center(cell);
        (1.0 - (x * x + y * y) / (radius * radius)).max(0.0).sqrt()
    };
    let pressure: Vec<f64> = (0..grid.cells()).map(load).collect();
    let mut displacement = vec![0.0; grid.cells()];
    let count = (1 << 22) / grid.cells() + 3;
    let (seconds, ()) = timed(|| {
        for _ in 0..count {
            operator
                .apply(&pressure, &mut displacement, &mut scratch)
                .expect("fields of the grid's size");
        }
    });
    seconds / count as f64
}

/// CPU seconds and convolutions of a first instant.
fn first_instant(engine: &mut HalfSpace) -> (f64, u64) {
    let history = vec![0.0; engine.nodes()];
    let mut pressure = history.clone();
    let instant = Instant {
        history: &history,
        compliance_per_pa: pmma().instantaneous_compliance(),
        prescribed: Prescribed::LoadN(LOAD_N),
    };
    let before = engine.convolutions();
    let (seconds, solved) = timed(|| engine.solve(&instant, &mut pressure));
    solved.expect("converges");
    (seconds, engine.convolutions() - before)
}

/// CPU seconds and convolutions of so many steps under W_0 (1 + share sin(angle)), after the jump to W_0.
fn steps(engine: &mut HalfSpace, count: usize, step_s: f64, share: f64) -> (f64, u64) {
    let mut march = March::new(engine, pmma(), TimeRule::Linear);
    march.jump(Prescribed::LoadN(LOAD_N)).expect("converges");
    let before = march.work().convolutions;
    let weights = march.weights(step_s);
    let (seconds, ()) = timed(|| {
        for step in 1..=count {
            let angle = TAU * step as f64 / count as f64;
            let load = Prescribed::LoadN(LOAD_N * (1.0 + share * angle.sin()));
            march.step(&weights, load).expect("converges");
        }
    });
    (seconds, march.work().convolutions - before)
}

/// CPU seconds of one case of a sweep of the half-space engine.
fn case_s(cells: usize) -> f64 {
    let entry = library::find("pmma").expect("in the library");
    let sphere = Sphere::new(RADIUS_M).expect("a positive radius");
    let drive = HarmonicDrive::load(LOAD_N, 0.5 * LOAD_N).expect("a valid drive");
    let pmma = entry.material().expect("a tested entry");
    let mut plan = SweepPlan::new(pmma, Arc::new(sphere), drive);
    plan.angular_frequencies_rad_per_s = vec![0.01];
    plan.cycle.error_bars = false;
    plan.solver.engine = EngineKind::HalfSpace;
    plan.solver.cells = cells;
    let setup = Setup::new(plan).expect("a valid plan");
    let [case] = &setup.plan().cases()[..] else {
        panic!("one frequency")
    };
    let (seconds, record) = timed(|| setup.run(case, &AtomicBool::new(false)));
    record.expect("not interrupted");
    seconds
}

fn line(what: &str, fast: (f64, u64), safe: (f64, u64), count: usize) {
    let per = |(seconds, convolutions): (f64, u64)| {
        let count = count as f64;
        (1e3 * seconds / count, convolutions as f64 / count)
    };
    let (fast, safe) = (per(fast), per(safe));
    println!(
        "{what:<34} {:>9.2} ms {:>6.1} {:>9.2} ms {:>6.1} {:>7.1} x",
        fast.0,
        fast.1,
        safe.0,
        safe.1,
        safe.0 / fast.0
    );
}

fn main() {
    let cells = numbers().first().copied().unwrap_or(256);
    let window = cells * 5 / 8;
    let (whole_s, part_s) = (convolution_s(cells), convolution_s(window));
    println!(
        "convolution: {cells} cells per side {:.3} ms, the window of {window} {:.3} ms, {:.1} x",
        1e3 * whole_s,
        1e3 * part_s,
        whole_s / part_s
    );
    println!(
        "\nCPU time and convolutions           fast way             safe way            ratio"
    );
    let new = || engine(cells, width_m(LOAD_N));
    line(
        "first instant",
        first_instant(&mut new()),
        first_instant(&mut new().by_safeguard_alone()),
        1,
    );
    let held = steps(&mut new(), 50, 1.0, 0.0);
    let safe = steps(&mut new().by_safeguard_alone(), 50, 1.0, 0.0);
    line("step of 1 s under a held load", held, safe, 50);
    let new = || engine(cells / 2, width_m(1.5 * LOAD_N));
    let step_s = TAU / 0.01 / 100.0;
    let cycle = steps(&mut new(), 100, step_s, 0.5);
    let safe = steps(&mut new().by_safeguard_alone(), 100, step_s, 0.5);
    let what = format!("step of a cycle, {} cells", cells / 2);
    line(&what, cycle, safe, 100);
    println!(
        "\ncase of a sweep to its stabilised cycle, {} cells: {:.2} s",
        cells / 4,
        case_s(cells / 4)
    );
    println!(
        "convolutions' share of the steps under a held load: {:.0} %",
        100.0 * held.1 as f64 * part_s / held.0
    );
}
