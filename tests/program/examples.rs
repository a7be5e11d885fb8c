//! The files under sweeps/: each states its question, and each runs through the program, on coarse grids.

use crate::prelude::*;

/// The figures of the paper, with a test of their own.
const SKIPPED: &str = "spinu-2018";

fn all() -> Vec<PathBuf> {
    let sweeps = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps");
    let all = below(&sweeps, "toml").into_iter();
    all.filter(|path| !path.starts_with(sweeps.join(SKIPPED)))
        .collect()
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
        let is_question = first.iter().all(|line| line.starts_with("# "));
        assert!(is_question && first.concat().ends_with('?'), "{path:?}");
    }
}

#[test]
fn every_example_runs_to_its_end() {
    let place = Place::new();
    for path in all() {
        let text = fs::read_to_string(&path).unwrap();
        let command = command(&text);
        let out = path.file_stem().unwrap().display();
        let mut run = format!("{command} '{}' --quiet --out {out}", path.display());
        let is_curve = text.contains("\ncurve = ");
        // An identification is coarse by itself, and a periodic surface brings its own cells.
        for (is_of, set) in [
            (!is_curve, "solver.cells=24"),
            (command != "identify", "solver.springs=100"),
            (command == "sweep", "cycle.steps=40"),
            (text.contains("edge = \"periodic\""), "indenter.cells=32"),
            (text.contains("\nreplicas"), "material.dynamic.replicas=2"),
        ] {
            if is_of {
                run += &format!(" --set {set}");
            }
        }
        let run = place.done(&run);
        assert_eq!(run.stdout + &run.stderr, "");
        let summary = place.json(&format!("{out}/summary.json"));
        match command {
            "simulate" => {
                assert_eq!(summary["status"], "done", "{out}");
                // Where an attraction moves the edge there are no profiles, and the pull is told.
                let has_profiles = place.has(&format!("{out}/figures/profiles.csv"));
                assert!(has_profiles != summary["separation"].is_object(), "{out}");
            }
            "identify" if is_curve => {
                let law = match path.ends_with("identify-sticky-curve.toml") {
                    true => "standard-solid",
                    false => "power-law",
                };
                assert_eq!(summary["law"], law, "{out}");
            }
            "identify" => {
                let branches = 3 - usize::from(path.ends_with("identify-creep.toml"));
                assert_eq!(summary["branches"], branches, "{out}");
            }
            _ => assert!(!summary["peaks"].as_array().unwrap().is_empty()),
        }
    }
}

#[test]
fn a_file_is_run_by_the_command_it_is_meant_for_and_not_by_the_other() {
    let place = Place::new();
    for path in all() {
        let text = fs::read_to_string(&path).unwrap();
        let (other, expected) = match command(&text) {
            "sweep" => ("simulate", "run `contact-dma sweep "),
            "identify" => ("simulate", "run `contact-dma identify "),
            _ => ("sweep", "run `contact-dma simulate "),
        };
        // The folder holds nothing, so that even a run would leave no trace beside the examples.
        let told = place.refused(&format!("{other} '{}'", path.display()));
        says(&told, &[expected]);
    }
}

#[test]
fn the_noisy_table_gives_the_loss_of_the_material_it_was_made_from() {
    let place = Place::new();
    let sweeps = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps");
    let loss = |name: &str| {
        let file = sweeps.join(format!("{name}.toml"));
        place.done(&format!(
            "sweep '{}' --quiet --set sweep.angular_frequency=[0.00844] --out {name}",
            file.display()
        ));
        let table = place.table(&format!("{name}/sweep.csv"));
        table.number(0, "energy_loss_j")
    };
    let off = loss("tabulated-creep") / loss("pmma") - 1.0;
    println!("{off:e}");
    // 1 % of noise over 41 samples, on a creep compliance that rises by a quarter: the loss lives on the rise.
    assert!(off.abs() < 0.05, "{off:e}");
    // The comment of the example is what a reader goes by.
    let text = fs::read_to_string(sweeps.join("tabulated-creep.csv")).unwrap();
    assert!(text.starts_with("# Synthetic"));
}
