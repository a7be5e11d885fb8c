//! Synthetic measurements for `contact-dma identify`: losses and phases of a known solid with 1 % of noise, as the table
//! `sweeps/identify-polymer.csv`: `cargo run --release --example measured_cycles > sweeps/identify-polymer.csv`; and the creep of a
//! slower one under a constant load, `... --example measured_cycles creep > sweeps/identify-creep.csv`.

use std::error::Error;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use contact_dma::prelude::*;
use contact_dma::simulation::between::values_at;

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

/// The solid that creeps: moduli (Pa) and times (s).
pub const SOFT_EQUILIBRIUM_PA: f64 = 4e6;
pub const SLOW_BRANCHES: [(f64, f64); 2] = [(3e6, 2.0), (2e6, 60.0)];

/// 20 mN within 0.5 s, held for 600 s, under a sphere of 1 mm: 120 rows with 0.5 % of noise, ever farther apart.
pub fn creep_table() -> Result<String, Box<dyn Error>> {
    const CREEP_NOISE: f64 = 5e-3;
    let branches =
        SLOW_BRANCHES.map(|(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s });
    let relaxation = Relaxation::new(SOFT_EQUILIBRIUM_PA, branches.into())?;
    let material = Material::from_relaxation(relaxation, ModulusKind::Longitudinal, 0.49)?;
    let ramp = |to, duration_s| Segment::Ramp { to, duration_s };
    let drive = SegmentedDrive::new(Control::Load, vec![ramp(0.02, 0.5), ramp(0.02, 600.0)])?;
    let plan = ScenarioPlan::new(material, Arc::new(Sphere::new(1e-3)?), drive.clone());
    let outcome = Simulation::new(plan)?.run(&AtomicBool::new(false), &|_, _| {});
    let times: Vec<f64> = (0..120)
        .map(|k| 0.2 * 3000_f64.powf(f64::from(k) / 119.0))
        .collect();
    let exact = values_at(&drive, &outcome.rows, &times, |row| row.approach_m);
    let mut text = "# Synthetic: examples/measured_cycles.rs. A sphere of 1 mm under 20 mN, reached within 0.5 s; every approach has normal\n\
                    # noise of 0.5 % of itself.\n\
                    time_s,approach_um\n"
        .to_owned();
    let mut random = Random(1847);
    for (time_s, exact_m) in times.iter().zip(exact) {
        let noisy_m = exact_m.ok_or("no approach")? * (1.0 + CREEP_NOISE * random.normal());
        text += &format!("{time_s:.4},{:.4}\n", 1e6 * noisy_m);
    }
    Ok(text)
}

pub fn main() -> Result<(), Box<dyn Error>> {
    let text = match std::env::args().nth(1).as_deref() {
        Some("creep") => creep_table()?,
        _ => table()?,
    };
    print!("{text}");
    Ok(())
}
