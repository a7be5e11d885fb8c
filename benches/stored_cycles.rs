//! What all cycles of a large sweep cost as one archive for NumPy, over its tables alone: `report --cycles` reads every cycle of the
//! folder, of 500 cases in 200 steps, and should take as long as it takes to read and write them once. Prints one JSON line.
//!
//!     cargo bench --bench stored_cycles

use std::error::Error;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

const CASES: usize = 500;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::TempDir::new()?;
    let frequencies = format!(
        "sweep.angular_frequency={{ from = \"1e-3 rad/s\", to = \"1 rad/s\", points = {CASES} }}"
    );
    let sweep = "sweep sweeps/pmma.toml --no-figures --set cycle.error_bars=false --set";
    let sweep_s = timed(sweep, &[&frequencies, "--out"], folder.path())?;
    let report = "report --no-figures";
    let tables_s = timed(report, &[], folder.path())?;
    let with_cycles_s = timed(report, &["--cycles"], folder.path())?;
    let megabytes = std::fs::metadata(folder.path().join("cases/cycles.npz"))?.len() / 1_000_000;
    println!(
        "{{\"cases\": {CASES}, \"sweep_s\": {sweep_s:.3}, \"tables_s\": {tables_s:.3}, \"with_cycles_s\": {with_cycles_s:.3}, \
         \"megabytes\": {megabytes}, \"ratio\": {:.1}}}",
        with_cycles_s / tables_s
    );
    Ok(())
}

/// How long the program takes (s) with these arguments, of which the folder is the last.
fn timed(words: &str, more: &[&str], folder: &Path) -> Result<f64, Box<dyn Error>> {
    let clock = Instant::now();
    let status = Command::new(env!("CARGO_BIN_EXE_contact-dma"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(words.split(' '))
        .args(more)
        .arg(folder)
        .arg("--quiet")
        .stdout(Stdio::null())
        .status()?;
    match status.success() {
        true => Ok(clock.elapsed().as_secs_f64()),
        false => Err(format!("{words} ended with {status}").into()),
    }
}
