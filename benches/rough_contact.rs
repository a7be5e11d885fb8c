//! The first instant of a rough surface that repeats itself on an elastic body, from a hundredth in contact to all but a thousandth: steps,
//! convolutions, time on the clock and peak memory. Wavelengths go from four cells to a quarter of the side.
//!
//!     cargo bench --bench rough_contact -- [CELLS] [THREADS] [safe]
//!
//! `safe` takes the conjugate gradients of Polonsky and Keer alone, which other programs have.

mod common;

use std::sync::Arc;
use std::time::Instant as Clock;

use common::{numbers, peak_mib};
use contact_dma::contact::half_space::SolverSettings;
use contact_dma::contact::half_space::grid::Grid;
use contact_dma::contact::half_space::periodic::{Periodic, PeriodicOperator};
use contact_dma::contact::{Engine, Instant, Prescribed};
use contact_dma::indenter::{MapEdge, Roughness};

const SPACING_M: f64 = 1e-6;
const COMPLIANCE_PER_PA: f64 = 1e-9;

/// Parts in contact and, of E* times the root mean square slope, the mean pressures under which B. N. J. Persson (J. Chem. Phys. 115
/// (2001) 3840) expects them.
const PARTS: [(f64, f64); 6] = [
    (0.01, 0.0063),
    (0.1, 0.063),
    (0.5, 0.34),
    (0.9, 0.82),
    (0.99, 1.29),
    (0.999, 1.65),
];

/// Gaps (m), and the root mean square slope between neighbours.
fn surface(cells: usize, hurst_exponent: f64) -> (Vec<f64>, f64) {
    let roughness = Roughness {
        cells,
        spacing_m: SPACING_M,
        hurst_exponent,
        rms_height_m: 1e-7,
        cut_off_wavelength_m: 4.0 * SPACING_M,
        seed: 7,
        edge: MapEdge::Periodic,
        roll_off_wavelength_m: Some(0.25 * cells as f64 * SPACING_M),
        sphere_radius_m: None,
    };
    let map = roughness
        .map()
        .expect("wavelengths between two cells and the side");
    let gaps_m = map.gaps_m().to_vec();
    let squares = (0..gaps_m.len()).map(|cell| {
        let (x, y) = (cell % cells, cell / cells);
        let right = gaps_m[y * cells + (x + 1) % cells] - gaps_m[cell];
        let up = gaps_m[(y + 1) % cells * cells + x] - gaps_m[cell];
        (right * right + up * up) / (SPACING_M * SPACING_M)
    });
    let slope = (squares.sum::<f64>() / gaps_m.len() as f64).sqrt();
    (gaps_m, slope)
}

fn main() {
    let numbers = numbers();
    let cells = numbers.first().copied().unwrap_or(256);
    let threads = numbers.get(1).copied().unwrap_or(1);
    let is_safe = std::env::args().any(|argument| argument == "safe");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let pool = pool.build().expect("a pool of threads");
    let grid = Grid::square(cells, SPACING_M).expect("a valid grid");
    let operator = Arc::new(PeriodicOperator::new(grid));
    let settings = SolverSettings {
        max_iterations: 100_000,
        ..SolverSettings::default()
    };
    println!("{cells} x {cells} cells, {threads} threads\n");
    println!("Hurst exponent | expected | in contact | steps | convolutions | time, s | peak, MiB");
    for hurst_exponent in [0.2, 0.5, 0.8] {
        let (gaps_m, slope) = surface(cells, hurst_exponent);
        for (expected, share) in PARTS {
            let engine = Periodic::new(Arc::clone(&operator), gaps_m.clone(), settings);
            let mut engine = match is_safe {
                true => engine.by_safeguard_alone(),
                false => engine,
            };
            let history = vec![0.0; engine.nodes()];
            let mut pressure = history.clone();
            let load_n =
                share * slope / COMPLIANCE_PER_PA * grid.cells() as f64 * grid.cell_area_m2();
            let instant = Instant {
                history: &history,
                compliance_per_pa: COMPLIANCE_PER_PA,
                prescribed: Prescribed::LoadN(load_n),
            };
            let clock = Clock::now();
            let found = pool.install(|| engine.solve(&instant, &mut pressure));
            let seconds = clock.elapsed().as_secs_f64();
            let found = found.expect("converges");
            let touching = pressure.iter().filter(|p| **p > 0.0).count();
            println!(
                "{hurst_exponent} | {expected} | {:.4} | {} | {} | {seconds:.3} | {:.0}",
                touching as f64 / grid.cells() as f64,
                found.iterations,
                found.convolutions,
                peak_mib()
            );
        }
    }
}
