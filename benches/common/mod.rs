//! What the plain benches share: CPU time, memory, and PMMA under a sphere.

#![allow(dead_code)] // Each bench uses its own part.

use std::sync::Arc;
use std::time::Instant;

use contact_dma::contact::half_space::convolution::Convolution;
use contact_dma::contact::half_space::grid::Grid;
use contact_dma::contact::half_space::{HalfSpace, SolverSettings};
use contact_dma::indenter::{Indenter, Sphere};
use contact_dma::material::{Creep, library};

pub const RADIUS_M: f64 = 0.01;
pub const LOAD_N: f64 = 10.0;

/// CPU seconds of the calling thread so far, where the system tells (Linux); else the time on the clock.
pub fn cpu_s(since: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|t| t.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| since.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// CPU seconds that this takes, and what it gives.
pub fn timed<T>(run: impl FnOnce() -> T) -> (f64, T) {
    let clock = Instant::now();
    let before = cpu_s(clock);
    let result = run();
    (cpu_s(clock) - before, result)
}

/// Largest resident size (MiB) of this process so far, where the system tells (Linux).
pub fn peak_mib() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let kib = line.and_then(|l| l.trim().trim_end_matches(" kB").parse::<f64>().ok());
    kib.unwrap_or(f64::NAN) / 1024.0
}

/// Contact compliance of PMMA.
pub fn pmma() -> Creep {
    let entry = library::find("pmma").expect("in the library");
    let material = entry.material().expect("a tested entry");
    material
        .contact_compliance()
        .expect("has an instantaneous compliance")
}

/// Contact radius (m) of the sphere on a body of this compliance.
pub fn hertz_radius_m(load_n: f64, compliance_per_pa: f64) -> f64 {
    (0.75 * load_n * RADIUS_M * compliance_per_pa).cbrt()
}

/// The half-space engine under the sphere on a square domain of so many cells, of which it needs a quarter, as it has in the
/// program.
pub fn engine(cells: usize, width_m: f64) -> HalfSpace {
    let grid = Grid::square(cells, width_m / cells as f64).expect("a valid grid");
    let grid = grid.quarter().unwrap_or(grid);
    let operator = Arc::new(Convolution::new(grid).expect("plannable"));
    let sphere = Sphere::new(RADIUS_M).expect("a positive radius");
    let gap = |cell| {
        let (x_m, y_m) = grid.center(cell);
        sphere.gap_m(x_m, y_m)
    };
    let gaps = (0..grid.cells()).map(gap).collect();
    HalfSpace::new(operator, gaps, true, SolverSettings::default())
}

/// The numbers among the arguments; Cargo adds `--bench`.
pub fn numbers() -> Vec<usize> {
    std::env::args().filter_map(|a| a.parse().ok()).collect()
}
