//! A load that is raised, held and removed, and how the surface creeps and recovers: `cargo run --example one_history`.

use std::error::Error;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use contact_dma::prelude::*;
use contact_dma::simulation::{SimulationEnd, SimulationOutcome};

/// 10 N within 1 s, held for 100 s, removed within 1 s, and 100 s of rest.
pub fn outcome() -> Result<SimulationOutcome, Box<dyn Error>> {
    let ramp = |to, duration_s| Segment::Ramp { to, duration_s };
    let segments = vec![
        ramp(10.0, 1.0),
        ramp(10.0, 100.0),
        ramp(0.0, 1.0),
        ramp(0.0, 100.0),
    ];
    let drive = SegmentedDrive::new(Control::Load, segments)?;
    let pmma = library::find("pmma").ok_or("not in the library")?;
    let sphere = Arc::new(Sphere::new(0.01)?);
    let plan = ScenarioPlan::new(pmma.material()?, sphere, drive);
    let outcome = Simulation::new(plan)?.run(&AtomicBool::new(false), &|_, _| {});
    match &outcome.ended {
        SimulationEnd::Failed(why) => Err(why.clone().into()),
        _ => Ok(outcome),
    }
}

pub fn main() -> Result<(), Box<dyn Error>> {
    println!("time (s), load (N), approach (m)");
    for row in outcome()?.rows {
        match row.approach_m {
            Some(approach_m) => println!("{:9.3} {:7.3} {approach_m:.4e}", row.time_s, row.load_n),
            None => println!("{:9.3} {:7.3} clear of the surface", row.time_s, row.load_n),
        }
    }
    Ok(())
}
