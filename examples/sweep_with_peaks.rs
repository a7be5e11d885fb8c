//! A frequency sweep of a material of one's own, its peaks, and a table of the losses: `cargo run --example sweep_with_peaks`.

use std::error::Error;
use std::io::{self, Write};

use contact_dma::prelude::*;

/// A solid that relaxes from 3 GPa to 1 GPa about 1 s, indented by a blunt cone.
pub fn outcome() -> Result<Outcome, Box<dyn Error>> {
    let branch = RelaxationBranch {
        modulus_pa: 2e9,
        time_s: 1.0,
    };
    let solid = Relaxation::new(1e9, vec![branch])?;
    let solid = Material::from_relaxation(solid, ModulusKind::Longitudinal, 0.35)?;
    let drive = HarmonicDrive::load(1.0, 0.4)?; // mean and amplitude, N
    let frequencies_hz = (-8..=8).map(|i| 0.3 * 10_f64.powf(f64::from(i) / 4.0));
    let sweep = Sweep::new(solid, Cone::new(1.4)?, drive).frequencies_hz(frequencies_hz)?;
    Ok(sweep.solve()?)
}

/// Writes a row per frequency; an undefined value is an empty cell.
pub fn write_csv(outcome: &Outcome, out: impl Write) -> Result<(), Box<dyn Error>> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(["frequency_hz", "energy_loss_j", "energy_loss_error_j"])?;
    for record in &outcome.records {
        let loss = (record.energy_loss_j(), record.energy_loss_error_j());
        table.serialize((record.frequency_hz(), loss.0, loss.1))?;
    }
    Ok(table.flush()?)
}

pub fn main() -> Result<(), Box<dyn Error>> {
    let outcome = outcome()?;
    write_csv(&outcome, io::stdout())?;
    for peak in &outcome.peaks {
        let (loss_j, omega) = (peak.energy_loss_j, peak.angular_frequency_rad_per_s);
        println!("# peak: {loss_j:.4e} J at {omega:.4} rad/s");
    }
    Ok(())
}
