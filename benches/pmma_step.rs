//! The yardstick against other programs: PMMA under a sphere, step load of 10 N, 200 steps of 1 s, half-space engine on a
//! domain of four contact radii, tolerance 1e-8, one thread. Prints one JSON line.
//!
//!     cargo bench --bench pmma_step -- [CELLS] [STEPS]

use std::sync::Arc;
use std::time::Instant;

use contact_dma::contact::Prescribed;
use contact_dma::contact::half_space::convolution::Convolution;
use contact_dma::contact::half_space::grid::Grid;
use contact_dma::contact::half_space::{HalfSpace, SolverSettings};
use contact_dma::history::{March, TimeRule};
use contact_dma::indenter::{Indenter, Sphere};
use contact_dma::material::library;
use contact_dma::reference::transient::step_load_contact_radius_m;

const RADIUS_M: f64 = 0.01;
const LOAD_N: f64 = 10.0;
const STEP_S: f64 = 1.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Cargo adds `--bench`.
    let numbers: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    let cells = numbers.first().copied().unwrap_or(256);
    let steps = numbers.get(1).copied().unwrap_or(200);

    let entry = library::find("pmma").ok_or("pmma is not in the library")?;
    let compliance = entry.material()?.contact_compliance()?;
    let relaxed = compliance.equilibrium_compliance().ok_or("a fluid")?;
    let contact_m = (0.75 * LOAD_N * RADIUS_M * relaxed).cbrt();
    let sphere = Sphere::new(RADIUS_M)?;

    let settings = SolverSettings {
        tolerance: 1e-8,
        ..SolverSettings::default()
    };

    let started = Instant::now();
    let grid = Grid::square(cells, 4.0 * contact_m / cells as f64)?;
    let operator = Arc::new(Convolution::new(grid)?);
    let gap = |cell| {
        let (x_m, y_m) = operator.grid().center(cell);
        sphere.gap_m(x_m, y_m)
    };
    let gaps = (0..operator.grid().cells()).map(gap).collect();
    let mut engine = HalfSpace::new(operator, gaps, true, settings);
    let mut march = March::new(&mut engine, compliance.clone(), TimeRule::Linear);
    march.jump(Prescribed::LoadN(LOAD_N))?;
    let weights = march.weights(STEP_S);
    let (mut approach_error, mut radius_error) = (0.0_f64, 0.0_f64);
    for step in 1..=steps {
        let found = march.step(&weights, Prescribed::LoadN(LOAD_N))?;
        let time_s = step as f64 * STEP_S;
        let exact_m = step_load_contact_radius_m(RADIUS_M, LOAD_N, &compliance, time_s);
        approach_error =
            approach_error.max((found.approach_m * RADIUS_M / exact_m.powi(2) - 1.0).abs());
        radius_error = radius_error.max((found.contact_radius_m / exact_m - 1.0).abs());
    }
    let wall_s = started.elapsed().as_secs_f64();
    let iterations = march.work().iterations as f64 / steps as f64;
    let convolutions = engine.convolutions() as f64 / steps as f64;
    println!(
        "{{\"cells\": {cells}, \"steps\": {steps}, \"wall_s\": {wall_s:.3}, \"iterations_per_step\": {iterations:.1}, \
         \"convolutions_per_step\": {convolutions:.1}, \"largest_relative_approach_error\": {approach_error:.1e}, \
         \"largest_relative_radius_error\": {radius_error:.1e}, \"peak_mib\": {:.1}}}",
        peak_mib()
    );
    Ok(())
}

/// Largest resident size of this process so far, where the system tells (Linux).
fn peak_mib() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let kib = line.and_then(|l| l.trim().trim_end_matches(" kB").parse::<f64>().ok());
    kib.unwrap_or(f64::NAN) / 1024.0
}
