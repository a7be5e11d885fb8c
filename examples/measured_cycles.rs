//! Synthetic measurements for `contact-dma identify`: losses and phases of a known solid with 1 % of noise, as the table
//! `sweeps/identify-polymer.csv`: `cargo run --release --example measured_cycles > sweeps/identify-polymer.csv`.

use std::error::Error;

use contact_dma::prelude::*;

/// Relative standard deviation of losses and phases.
const NOISE: f64 = 0.01;

/// What the measurement is made of: moduli (Pa) and times (s).
pub const EQUILIBRIUM_PA: f64 = 20e6;
pub const BRANCHES: [(f64, f64); 3] = [(150e6, 3e-3), (90e6, 0.1), (40e6, 4.0)];

/// SplitMix64 (G. L. Steele, D. Lea and C. H. Flood, OOPSLA 2014), and the transform of Box and Muller.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.unit()).cos()
    }
}

/// The solid.
pub fn solid() -> Result<Material, Box<dyn Error>> {
    let branches = BRANCHES.map(|(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s });
    let relaxation = Relaxation::new(EQUILIBRIUM_PA, branches.into())?;
    Ok(Material::from_relaxation(
        relaxation,
        ModulusKind::Longitudinal,
        0.45,
    )?)
}

/// The table, as text.
pub fn table() -> Result<String, Box<dyn Error>> {
    let sweep = Sweep::new(solid()?, Sphere::new(2e-3)?, HarmonicDrive::load(0.2, 0.1)?);
    let hz = (0..12).map(|k| 10_f64.powf(5.0 * f64::from(k) / 11.0 - 2.0));
    let outcome = sweep.without_error_bars().frequencies_hz(hz)?.solve()?;
    let mut text = "# Synthetic: examples/measured_cycles.rs. A sphere of 2 mm under 0.2 N ± 0.1 N; every loss and phase has normal noise\n\
                    # of 1 % of itself, and the errors say so.\n\
                    frequency_hz,energy_loss_j,energy_loss_error_j,phase_lag_rad,phase_lag_error_rad\n"
        .to_owned();
    let mut random = Random(2018);
    for record in &outcome.records {
        let result = record.result.as_ref().ok_or("no stabilised cycle")?;
        let mut noisy = |exact: f64| exact * (1.0 + NOISE * random.normal());
        let loss_j = noisy(result.analysis.energy_loss_j);
        let phase_rad = noisy(result.analysis.phase_lag_rad);
        text += &format!(
            "{:.5e},{loss_j:.4e},{:.1e},{phase_rad:.4e},{:.1e}\n",
            record.frequency_hz(),
            NOISE * loss_j,
            NOISE * phase_rad
        );
    }
    Ok(text)
}

pub fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", table()?);
    Ok(())
}
