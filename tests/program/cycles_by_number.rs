//! The n-th cycle of a sweep, and the cycles of a history, as files, tables, pages and messages show them.

#![cfg(feature = "cli")]

use std::fs;

use crate::program::{SVG_ALONE, pmma_sweep, program, write};
use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;

const THREE: &str =
    "[sweep]\nangular_frequency = [\"0.004 rad/s\", \"0.02 rad/s\", \"0.1 rad/s\"]\n";
const SECOND: &str =
    "[cycle]\nmethod = \"march\"\nat_cycle = 2\nsteps = 64\n[solver]\nsprings = 60\n";

#[test]
fn the_second_cycle_of_every_frequency_is_a_result_and_says_what_it_is() {
    let folder = TempDir::new().unwrap();
    let text = pmma_sweep(&format!("{THREE}{SECOND}"))
        .replace("amplitude = ", "hold = \"50 s\"\namplitude = ");
    let file = write(&folder, "second.toml", &text);
    let out = folder.path().join("out");
    let mut command = program();
    command.args(["sweep", &file, "--out"]).arg(&out);
    command
        .args(SVG_ALONE)
        .assert()
        .success()
        .stdout(contains("transient"));
    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    assert_eq!(table.matches(",transient,").count(), 3);
    let summary: Value =
        serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["cases"]["transient"], 3);
    assert_eq!(summary["cases"]["converged"], 0);
    let caption = fs::read_to_string(out.join("loops.caption.txt")).unwrap();
    assert!(caption.contains("Cycle 2 from the beginning"), "{caption}");
    // The resolved file gives the same plan again.
    let resolved = fs::read_to_string(out.join("resolved.toml")).unwrap();
    assert!(resolved.contains("at_cycle = 2"), "{resolved}");
    let page = fs::read_to_string(out.join("index.html")).unwrap();
    assert!(page.contains("number 2 after the hold"));
}

#[test]
fn a_history_has_a_table_of_its_cycles() {
    let folder = TempDir::new().unwrap();
    let segments = r#"
        { kind = "step", to = "10 N", duration = "20 s" },
        { kind = "sine", mean = "10 N", amplitude = "5 N", angular_frequency = "0.5 rad/s", cycles = 3 },
        { kind = "sine", mean = "10 N", amplitude = "2 N", angular_frequency = "2 rad/s", cycles = 2.5 },
        { kind = "sine", mean = "2 N", amplitude = "2 N", angular_frequency = "2 rad/s", cycles = 1 },"#;
    let text = format!(
        "title = \"cycles\"\n[material]\nlibrary = \"pmma\"\n[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n[drive]\ncontrol = \"load\"\n\
         segments = [{segments}\n]\n[solver]\nsprings = 60\n"
    );
    let out = folder.path().join("out");
    let simulate = |text: &str, more: &[&str]| {
        let file = write(&folder, "history.toml", text);
        let mut command = program();
        command
            .args(["simulate", &file, "--out"])
            .arg(&out)
            .args(SVG_ALONE);
        command.args(more).assert().success()
    };
    let assert = simulate(&text, &[]);
    assert
        .stdout(contains("Loss in segment 2"))
        .stdout(contains("  cycle 3: "));
    let table = fs::read_to_string(out.join("cycles.csv")).unwrap();
    let column = |name: &str| {
        table
            .lines()
            .next()
            .unwrap()
            .split(',')
            .position(|n| n == name)
            .unwrap()
    };
    let (loss, error) = (column("energy_loss_j"), column("energy_loss_error_j"));
    let rows: Vec<Vec<&str>> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect())
        .collect();
    let numbers: Vec<(&str, &str)> = rows.iter().map(|row| (row[0], row[1])).collect();
    assert_eq!(
        numbers,
        [
            ("2", "1"),
            ("2", "2"),
            ("2", "3"),
            ("3", "1"),
            ("3", "2"),
            ("4", "1")
        ]
    );
    for row in &rows {
        let (loss, error): (f64, f64) = (row[loss].parse().unwrap(), row[error].parse().unwrap());
        assert!(loss > 0.0 && error > 0.0 && error < 0.05 * loss, "{row:?}");
    }
    assert!(out.join("cycle-losses.svg").exists());
    assert!(
        fs::read_to_string(out.join("index.html"))
            .unwrap()
            .contains("Cycle by cycle")
    );
    let printed = simulate(&text, &["--format", "json"])
        .get_output()
        .stdout
        .clone();
    let json: Value = serde_json::from_slice(&printed).unwrap();
    assert_eq!(json["cycles"].as_array().unwrap().len(), 6);
    // A history without a sine takes them away again.
    simulate(&without_sines(&text), &["--force"]);
    assert!(!out.join("cycles.csv").exists() && !out.join("cycle-losses.svg").exists());
}

/// The same history with its sines as steps.
fn without_sines(text: &str) -> String {
    let text = text.replace("kind = \"sine\", mean", "kind = \"step\", to");
    let line = |line: &str| match line.split_once(", amplitude") {
        Some((head, _)) => format!("{head}, duration = \"5 s\" }},"),
        None => line.to_owned(),
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}
