//! The energy loss of PMMA under a sphere at one load frequency, with its error: `cargo run --example one_frequency`.

use std::error::Error;

use contact_dma::prelude::*;

/// Energy loss per cycle and its error (J).
pub fn loss(frequency_hz: f64) -> Result<(f64, f64), Box<dyn Error>> {
    let pmma = library::find("pmma").ok_or("not in the library")?;
    let drive = HarmonicDrive::load(10.0, 5.0)?; // mean and amplitude, N
    let record =
        Sweep::new(pmma.material()?, Sphere::new(0.01)?, drive).case_at_hz(frequency_hz)?;
    let loss_j = record.energy_loss_j().ok_or("no stabilised cycle")?;
    Ok((loss_j, record.energy_loss_error_j().ok_or("no error bar")?))
}

pub fn main() -> Result<(), Box<dyn Error>> {
    let (loss_j, error_j) = loss(1.3e-3)?;
    println!("energy loss: {loss_j:.5e} J per cycle, to within {error_j:.1e} J");
    Ok(())
}
