//! Records of measured loops as an instrument would give them, made of exact cycles of PMMA under a sphere with noise and drift of
//! known size: `cargo run --release --example measured_loops` writes those of `sweeps/measured-loops`.

use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write;

use contact_dma::prelude::*;

/// Frequencies (Hz), a file each.
pub const FREQUENCIES_HZ: [f64; 4] = [3e-4, 1.3e-3, 5e-3, 2e-2];
/// Standard deviation of the noise of both signals over their amplitudes.
pub const NOISE: f64 = 0.005;
/// Drift of the approach over the record, in its amplitudes.
pub const DRIFT: f64 = 0.2;
/// Samples in a cycle, and cycles in a record: neither a whole number.
const POINTS: f64 = 40.3;
const CYCLES: f64 = 12.4;

/// Random numbers from a seed: splitmix64, and Box and Muller.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}

/// A record as the text of a file, and the energy loss (J) of the exact cycle in it.
pub fn record(hz: f64, seed: u64) -> Result<(String, f64), Box<dyn Error>> {
    let pmma = library::find("pmma").ok_or("not in the library")?;
    let drive = HarmonicDrive::load(10.0, 5.0)?; // mean and amplitude, N
    let sweep = Sweep::new(pmma.material()?, Sphere::new(0.01)?, drive).without_error_bars();
    let case = sweep.steps(200)?.springs(200)?.case_at_hz(hz)?;
    let result = case.result.ok_or("no stabilised cycle")?;
    let analysis = &result.analysis;
    // The harmonics of the exact cycle, at any angle of the load; those beyond the fifth are below a part in ten thousand.
    let exact_m = |angle: f64| {
        let waves = analysis.harmonics.iter().zip(1..).map(|(harmonic, n)| {
            let angle = f64::from(n) * angle + harmonic.approach_phase_rad;
            harmonic.approach_amplitude_m * angle.sin()
        });
        analysis.approach_mean_m + waves.sum::<f64>()
    };
    let amplitude_m = analysis
        .harmonics
        .first()
        .ok_or("no harmonics")?
        .approach_amplitude_m;
    let mut random = Random(seed);
    let mut text = format!(
        "# Synthetic: the exact cycle of PMMA under a sphere of 10 mm at {hz} Hz, load 10 N ± 5 N, with white noise of {NOISE} of\n\
         # the amplitudes on both signals and a drift of {DRIFT} amplitudes of the depth; examples/measured_loops.rs wrote it.\n\
         Time (s),Load (N),Depth (um)\n"
    );
    for i in 0..(POINTS * CYCLES) as usize {
        let turns = i as f64 / POINTS;
        let load_n = 10.0 + 5.0 * ((TAU * turns).sin() + NOISE * random.normal());
        let drift = DRIFT * turns / CYCLES + NOISE * random.normal();
        let approach_m = exact_m(TAU * turns) + amplitude_m * drift;
        writeln!(
            text,
            "{:.3},{load_n:.5},{:.6}",
            turns / hz,
            1e6 * approach_m
        )?;
    }
    Ok((text, analysis.energy_loss_j))
}

pub fn main() -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all("sweeps/measured-loops")?;
    for (seed, hz) in (1..).zip(FREQUENCIES_HZ) {
        let (text, loss_j) = record(hz, seed)?;
        let file = format!("sweeps/measured-loops/{hz}-hz.csv");
        std::fs::write(&file, text)?;
        println!("{file}: {loss_j:.5e} J per cycle");
    }
    Ok(())
}
