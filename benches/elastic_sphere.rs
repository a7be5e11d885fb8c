//! One elastic contact from no guess, beside other programs: a sphere under 10 N on a domain of four contact radii, tolerance
//! 1e-8, one thread. Prints one JSON line.
//!
//!     cargo bench --bench elastic_sphere -- [CELLS]

mod common;

use common::{LOAD_N, RADIUS_M, engine, hertz_radius_m, numbers, peak_mib, timed};
use contact_dma::contact::{ContactError, Engine, Instant, Prescribed};

/// 1/E* of a body with E = 1973 MPa and a Poisson ratio of 0.38 (1/Pa).
const COMPLIANCE_PER_PA: f64 = (1.0 - 0.38 * 0.38) / 1.973e9;

fn main() -> Result<(), ContactError> {
    let cells = numbers().first().copied().unwrap_or(512);
    let exact_m = hertz_radius_m(LOAD_N, COMPLIANCE_PER_PA);
    let (cpu_s, found) = timed(|| {
        let mut engine = engine(cells, 4.0 * exact_m);
        let history = vec![0.0; engine.nodes()];
        let mut pressure = history.clone();
        let instant = Instant {
            history: &history,
            compliance_per_pa: COMPLIANCE_PER_PA,
            prescribed: Prescribed::LoadN(LOAD_N),
        };
        engine.solve(&instant, &mut pressure)
    });
    let found = found?;
    println!(
        "{{\"cells\": {cells}, \"cpu_s\": {cpu_s:.3}, \"iterations\": {}, \"convolutions\": {}, \
         \"relative_approach_error\": {:.2e}, \"relative_radius_error\": {:.2e}, \"peak_mib\": {:.1}}}",
        found.iterations,
        found.convolutions,
        (found.approach_m * RADIUS_M / exact_m.powi(2) - 1.0).abs(),
        (found.contact_radius_m / exact_m - 1.0).abs(),
        peak_mib()
    );
    Ok(())
}
