//! What an identification costs over the solution of the cycles that it is made from: losses and phases of a solid of three branches
//! under a sphere at twelve frequencies over five decades, W = 10 N + 5 N sin(omega t), solved in 200 steps on 200 springs.
//! Prints one JSON line.
//!
//!     cargo bench --bench identification

mod common;

use std::error::Error;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use common::{LOAD_N, RADIUS_M};
use contact_dma::drive::HarmonicDrive;
use contact_dma::identify::data::{Datum, Measurements, Number};
use contact_dma::identify::{Driven, IdentifyPlan, identify};
use contact_dma::indenter::{Indenter, Sphere};
use contact_dma::material::{Material, ModulusKind, Relaxation, RelaxationBranch};
use contact_dma::sweep::Sweep;
use contact_dma::sweep::plan::SweepPlan;

const POISSON: f64 = 0.35;

fn main() -> Result<(), Box<dyn Error>> {
    let branch = |modulus_pa, time_s| RelaxationBranch { modulus_pa, time_s };
    let branches = vec![branch(2e6, 0.05), branch(1e6, 1.0), branch(3e6, 20.0)];
    let relaxation = Relaxation::new(1e6, branches)?;
    let indenter: Arc<dyn Indenter> = Arc::new(Sphere::new(RADIUS_M)?);
    let drive = HarmonicDrive::load(LOAD_N, 0.5 * LOAD_N)?;
    let material = Material::from_relaxation(relaxation, ModulusKind::Longitudinal, POISSON)?;
    let mut plan = SweepPlan::new(material, Arc::clone(&indenter), drive);
    (plan.cycle.steps, plan.solver.springs, plan.cycle.error_bars) = (200, 200, false);
    let omegas = (0..12).map(|k| 10_f64.powf(5.0 * f64::from(k) / 11.0 - 2.5));
    let sweep = Sweep::from(plan).angular_frequencies_rad_per_s(omegas)?;
    let clock = Instant::now();
    let records = sweep.solve()?.records;
    let cycles_s = clock.elapsed().as_secs_f64();
    let mut data = Vec::new();
    for (row, record) in (1..).zip(&records) {
        for number in [Number::EnergyLoss, Number::PhaseLag] {
            let result = record.result.as_ref().ok_or("a cycle was not found")?;
            data.push(Datum {
                place: record.angular_frequency_rad_per_s,
                drive: Some(drive),
                row,
                number,
                value: number.of(result).ok_or("a number is undefined")?,
                error: None,
            });
        }
    }
    let measured = Measurements::new(data)?;
    let plan = IdentifyPlan::new(POISSON, indenter, Driven::Cycles(drive), measured);
    let clock = Instant::now();
    let found = identify(&plan, &AtomicBool::new(false))?;
    let identification_s = clock.elapsed().as_secs_f64();
    println!(
        "{{\"branches\": {}, \"cycles_s\": {cycles_s:.3}, \"identification_s\": {identification_s:.3}, \"ratio\": {:.1}}}",
        found.relaxation.branches().len(),
        identification_s / cycles_s
    );
    Ok(())
}
