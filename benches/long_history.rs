//! What a step costs late in a history over what it costs early: PMMA under a sphere, W = 10 N + 5 N sin(0.01 rad/s t), 100 steps
//! per cycle, half-space engine on a domain of four radii of the relaxed contact under the largest load, tolerance 1e-8, one
//! thread. The steps compared, forty each, have the same places in their cycles; the later ones follow them by 20 cycles.
//! Prints one JSON line.
//!
//!     cargo bench --bench long_history -- [CELLS]

mod common;

use std::f64::consts::TAU;

use common::{LOAD_N, engine, hertz_radius_m, numbers, pmma, timed};
use contact_dma::contact::{ContactError, Prescribed};
use contact_dma::history::{March, TimeRule};

const PER_CYCLE: usize = 100;
const CYCLES: usize = 20;
const EARLY: std::ops::Range<usize> = 1..41;

fn main() -> Result<(), ContactError> {
    let cells = numbers().first().copied().unwrap_or(256);
    let compliance = pmma();
    let relaxed = compliance.equilibrium_compliance().unwrap_or(f64::NAN);
    let mut engine = engine(cells, 4.0 * hertz_radius_m(1.5 * LOAD_N, relaxed));
    let mut march = March::new(&mut engine, compliance, TimeRule::Linear);
    march.jump(Prescribed::LoadN(LOAD_N))?;
    let weights = march.weights(TAU / 0.01 / PER_CYCLE as f64);
    let mut cost = |steps: std::ops::Range<usize>| -> Result<(f64, u64), ContactError> {
        let before = march.work().convolutions;
        let (seconds, done) = timed(|| {
            for step in steps {
                let angle = TAU * step as f64 / PER_CYCLE as f64;
                let load = Prescribed::LoadN(LOAD_N * (1.0 + 0.5 * angle.sin()));
                march.step(&weights, load)?;
            }
            Ok(())
        });
        done.map(|()| (seconds, march.work().convolutions - before))
    };
    let later = CYCLES * PER_CYCLE;
    let early = cost(EARLY)?;
    cost(EARLY.end..EARLY.start + later)?;
    let late = cost(EARLY.start + later..EARLY.end + later)?;
    let per_step_ms = |(seconds, _): (f64, u64)| 1e3 * seconds / EARLY.len() as f64;
    println!(
        "{{\"cells\": {cells}, \"early_step_ms\": {:.3}, \"late_step_ms\": {:.3}, \"ratio\": {:.3}, \"early_convolutions\": {}, \
         \"late_convolutions\": {}}}",
        per_step_ms(early),
        per_step_ms(late),
        late.0 / early.0,
        early.1,
        late.1
    );
    Ok(())
}
