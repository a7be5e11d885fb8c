//! The yardstick against other programs: PMMA under a sphere, step load of 10 N, 200 steps of 1 s, half-space engine on a
//! domain of four contact radii, tolerance 1e-8, one thread. Prints one JSON line.
//!
//!     cargo bench --bench pmma_step -- [CELLS] [STEPS] [constant]
//!
//! `constant` takes the first-order rule of the base paper.

mod common;

use common::{LOAD_N, RADIUS_M, engine, hertz_radius_m, numbers, peak_mib, pmma, timed};
use contact_dma::contact::{ContactError, Prescribed};
use contact_dma::history::{March, TimeRule};
use contact_dma::reference::transient::step_load_contact_radius_m;

const DURATION_S: f64 = 200.0;

/// What a run came to.
struct Run {
    iterations: u64,
    convolutions: u64,
    /// Largest relative errors over all steps.
    approach_error: f64,
    radius_error: f64,
    /// Mean relative error of the radius over all steps.
    mean_radius_error: f64,
}

fn run(cells: usize, steps: usize, rule: TimeRule) -> Result<Run, ContactError> {
    let compliance = pmma();
    let relaxed = compliance.equilibrium_compliance().unwrap_or(f64::NAN);
    let mut engine = engine(cells, 4.0 * hertz_radius_m(LOAD_N, relaxed));
    let mut march = March::new(&mut engine, compliance.clone(), rule);
    march.jump(Prescribed::LoadN(LOAD_N))?;
    let step_s = DURATION_S / steps as f64;
    let weights = march.weights(step_s);
    let (mut approach_error, mut radius_error, mut sum) = (0.0_f64, 0.0_f64, 0.0);
    for step in 1..=steps {
        let found = march.step(&weights, Prescribed::LoadN(LOAD_N))?;
        let time_s = step as f64 * step_s;
        let exact_m = step_load_contact_radius_m(RADIUS_M, LOAD_N, &compliance, time_s);
        let approach = found.approach_m * RADIUS_M / exact_m.powi(2) - 1.0;
        approach_error = approach_error.max(approach.abs());
        let radius = (found.contact_radius_m / exact_m - 1.0).abs();
        radius_error = radius_error.max(radius);
        sum += radius;
    }
    Ok(Run {
        iterations: march.work().iterations,
        convolutions: march.work().convolutions,
        approach_error,
        radius_error,
        mean_radius_error: sum / steps as f64,
    })
}

fn main() -> Result<(), ContactError> {
    let numbers = numbers();
    let cells = numbers.first().copied().unwrap_or(256);
    let steps = numbers.get(1).copied().unwrap_or(200);
    let rule = match std::env::args().any(|a| a == "constant") {
        true => TimeRule::Constant,
        false => TimeRule::Linear,
    };
    let (cpu_s, found) = timed(|| run(cells, steps, rule));
    let found = found?;
    println!(
        "{{\"cells\": {cells}, \"steps\": {steps}, \"cpu_s\": {cpu_s:.4}, \"iterations_per_step\": {:.2}, \
         \"convolutions_per_step\": {:.2}, \"largest_relative_approach_error\": {:.2e}, \
         \"largest_relative_radius_error\": {:.2e}, \"mean_relative_radius_error\": {:.2e}, \"peak_mib\": {:.1}}}",
        found.iterations as f64 / steps as f64,
        found.convolutions as f64 / steps as f64,
        found.approach_error,
        found.radius_error,
        found.mean_radius_error,
        peak_mib()
    );
    Ok(())
}
