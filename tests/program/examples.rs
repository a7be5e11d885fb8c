//! The files under sweeps/: each states its question, and each runs through the program, on coarse grids.

#![cfg(feature = "cli")]

use std::fs;
use std::path::{Path, PathBuf};

use crate::program::program;
use tempfile::TempDir;

/// The figures of the paper, with a test of their own.
const SKIPPED: &str = "spinu-2018";

/// All TOML files below a folder.
fn examples(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with(SKIPPED) {
            found.extend(examples(&path));
        } else if path.extension().is_some_and(|e| e == "toml") {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn all() -> Vec<PathBuf> {
    examples(&Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps"))
}

/// `sweep`, `identify` or `simulate`.
fn command(text: &str) -> &'static str {
    let has = |header: &str| text.lines().any(|line| line.trim() == header);
    if has("[sweep]") {
        "sweep"
    } else if has("[identify]") {
        "identify"
    } else {
        "simulate"
    }
}

#[test]
fn every_example_opens_with_its_question() {
    let all = all();
    assert!(all.len() >= 12, "{all:?}");
    for path in all {
        let text = fs::read_to_string(&path).unwrap();
        let first: Vec<&str> = text.lines().take_while(|line| line.len() > 1).collect();
        assert!(
            first.iter().all(|line| line.starts_with("# ")) && first.concat().ends_with('?'),
            "{}",
            path.display()
        );
    }
}

#[test]
fn every_example_runs_to_its_end() {
    let folder = TempDir::new().unwrap();
    for path in all() {
        let text = fs::read_to_string(&path).unwrap();
        let command = command(&text);
        let out = folder.path().join(path.file_stem().unwrap());
        // An identification is coarse by itself, and a periodic surface brings its own cells.
        let mut coarse = match command {
            "identify" => Vec::new(),
            _ => vec!["--set", "solver.springs=100"],
        };
        if command == "sweep" {
            coarse.extend(["--set", "cycle.steps=40"]);
        }
        if text.contains("edge = \"periodic\"") {
            coarse.extend(["--set", "indenter.cells=32"]);
        }
        if text.contains("\nreplicas = ") {
            coarse.extend(["--set", "material.dynamic.replicas=2"]);
        }
        program()
            .arg(command)
            .arg(&path)
            .args(["--quiet", "--set", "solver.cells=24"])
            .args(&coarse)
            .arg("--out")
            .arg(&out)
            .assert()
            .success()
            .stdout("")
            .stderr("");
        let summary = fs::read(out.join("summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
        if command == "simulate" {
            assert_eq!(summary["status"], "done", "{}", path.display());
            assert!(out.join("profiles.csv").is_file(), "{}", path.display());
        } else if command == "identify" {
            let branches = if path.ends_with("identify-creep.toml") {
                2
            } else {
                3
            };
            assert_eq!(summary["branches"], branches, "{}", path.display());
        } else {
            assert!(!summary["peaks"].as_array().unwrap().is_empty());
        }
    }
}

#[test]
fn a_file_is_run_by_the_command_it_is_meant_for_and_not_by_the_other() {
    let folder = TempDir::new().unwrap();
    for path in all() {
        let text = fs::read_to_string(&path).unwrap();
        let (other, expected) = match command(&text) {
            "sweep" => ("simulate", "run `contact-dma sweep "),
            "identify" => ("simulate", "run `contact-dma identify "),
            _ => ("sweep", "run `contact-dma simulate "),
        };
        // The folder holds nothing, so that even a run would leave no trace beside the examples.
        let assert = program()
            .current_dir(folder.path())
            .arg(other)
            .arg(&path)
            .assert()
            .code(2);
        let stderr = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        assert!(stderr.contains(expected), "{stderr}");
    }
}

#[test]
fn the_noisy_table_gives_the_loss_of_the_material_it_was_made_from() {
    let folder = TempDir::new().unwrap();
    let sweeps = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps");
    let loss = |name: &str| -> f64 {
        let out = folder.path().join(name);
        program()
            .args([
                "sweep",
                "--quiet",
                "--set",
                "sweep.angular_frequency=[0.00844]",
            ])
            .arg(sweeps.join(format!("{name}.toml")))
            .arg("--out")
            .arg(&out)
            .assert()
            .success();
        let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
        let mut rows = csv::Reader::from_reader(table.as_bytes());
        let column = rows
            .headers()
            .unwrap()
            .iter()
            .position(|h| h == "energy_loss_j");
        let row = rows.records().next().unwrap().unwrap();
        row[column.unwrap()].parse().unwrap()
    };
    let off = loss("tabulated-creep") / loss("pmma") - 1.0;
    println!("{off:e}");
    // 1 % of noise over 41 samples, on a creep compliance that rises by a quarter: the loss lives on the rise.
    assert!(off.abs() < 0.05, "{off:e}");
    // The comment of the example is what a reader goes by.
    let text = fs::read_to_string(sweeps.join("tabulated-creep.csv")).unwrap();
    assert!(text.starts_with("# Synthetic"));
}
