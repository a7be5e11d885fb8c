//! A sweep that adds frequencies where its own do not resolve the curve, and a sweep of two axes.

#![cfg(feature = "cli")]

use std::collections::HashMap;

use crate::program::{pmma_sweep, program, write};
use tempfile::TempDir;

/// Six points over five decades.
const FEW: &str = r#"[sweep]
angular_frequency = { from = "1e-4 rad/s", to = "10 rad/s", points = 6 }
[cycle]
steps = 64
[solver]
springs = 100
"#;

/// Rows of the sweep's table after a run with these keys changed.
fn rows(set: &[&str]) -> Vec<HashMap<String, String>> {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "few.toml", &pmma_sweep(FEW));
    let mut command = program();
    command.args(["sweep", &file, "--quiet", "--no-figures", "--out"]);
    command.arg(folder.path().join("out"));
    for key in set {
        command.args(["--set", key]);
    }
    command.assert().success();
    let table = folder.path().join("out/sweep.csv");
    let mut table = csv::Reader::from_path(table).unwrap();
    let rows = table.deserialize();
    rows.map(|row| row.unwrap()).collect()
}

fn number(row: &HashMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap()
}

#[test]
fn frequencies_are_added_about_the_peaks_and_stand_in_their_order() {
    let planned = rows(&[]);
    let refined = rows(&["sweep.refine=true"]);
    assert_eq!(planned.len(), 6);
    let omega = |row: &HashMap<String, String>| number(row, "angular_frequency_rad_per_s");
    assert!(
        refined
            .windows(2)
            .all(|pair| omega(&pair[0]) < omega(&pair[1]))
    );
    // The spectrum of PMMA lies between 1e-3 and 1 rad/s: there, and not at the ends, points are added.
    let inside = |row: &&HashMap<String, String>| (1e-3..1.0).contains(&omega(row));
    let added = refined.iter().filter(inside).count();
    assert!(added >= 8, "{added} points inside");
    assert!(refined.len() < 40, "{} points", refined.len());
    // Both peaks and the valley between them, which six points do not show, are there.
    let losses: Vec<f64> = refined
        .iter()
        .map(|row| number(row, "energy_loss_j"))
        .collect();
    let peaks = losses.windows(3).filter(|w| w[1] > w[0] && w[1] > w[2]);
    assert_eq!(peaks.count(), 2, "{losses:?}");
}

#[test]
fn a_second_run_finds_the_frequencies_that_the_first_has_added() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "few.toml", &pmma_sweep(FEW));
    let out = folder.path().join("out");
    let run = || {
        let mut command = program();
        command.args(["sweep", &file, "--quiet", "--no-figures", "--out"]);
        command.arg(&out).args(["--set", "sweep.refine=true"]);
        command.assert().success();
        let run = std::fs::read(out.join("run.json")).unwrap();
        let run: serde_json::Value = serde_json::from_slice(&run).unwrap();
        ["cases_computed", "cases_found"].map(|key| run[key].as_u64().unwrap())
    };
    let [computed, found] = run();
    assert!(computed > 6 && found == 0, "{computed} {found}");
    assert_eq!(run(), [0, computed]);
}

#[test]
fn every_frequency_is_solved_under_every_amplitude() {
    let rows = rows(&["sweep.drive.amplitude=[\"1 N\", \"2 N\"]"]);
    assert_eq!(rows.len(), 12);
    for (small, large) in rows[..6].iter().zip(&rows[6..]) {
        assert_eq!(number(small, "drive_amplitude"), 1.0);
        assert_eq!(number(large, "drive_amplitude"), 2.0);
        let ratio = number(large, "energy_loss_j") / number(small, "energy_loss_j");
        // The loss grows as the square of a small amplitude: within 1 % at a fifth of the mean.
        assert!((ratio / 4.0 - 1.0).abs() < 0.01, "{ratio}");
    }
}
