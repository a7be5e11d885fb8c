//! Tabulated materials taken as they are: the direct hereditary sum through the program, beside the fitted series.

#![cfg(feature = "cli")]

use std::fs;
use std::path::Path;

use crate::program::{program, write};
use contact_dma::material::library;
use predicates::prelude::*;
use predicates::str::contains;
use tempfile::TempDir;

/// Creep compliance of PMMA, twenty samples per decade from 0.1 s to 1000 s, off by up to 0.5 % either way.
fn creep_csv() -> String {
    let material = library::find("pmma").unwrap().material().unwrap();
    let row = |i: i32| {
        let time_s = 0.1 * 10_f64.powf(f64::from(i) / 20.0);
        // Fractional parts of multiples of the golden ratio: even, and without order.
        let noise = 5e-3 * (2.0 * (f64::from(i) * 0.618_033_988_749_895).fract() - 1.0);
        let value = material.creep().compliance(time_s) * (1.0 + noise);
        format!("{time_s},{value:.5e}\n")
    };
    let rows: String = (0..=80).map(row).collect();
    format!("time_s,creep_compliance_per_pa\n{rows}")
}

/// A step, an unloading to zero, and a sine: the contact opens and is met again.
const SCENARIO: &str = r#"title = "tabulated"

[material]
poisson_ratio = 0.38

[material.table]
file = "creep.csv"
quantity = "creep"
modulus = "longitudinal"

[indenter]
shape = "sphere"
radius = "10 mm"

[drive]
segments = [
    { kind = "step", to = "10 N", duration = "100 s" },
    { kind = "ramp", to = 0, duration = "10 s" },
    { kind = "sine", mean = "5 N", amplitude = "5 N", angular_frequency = "0.05 rad/s", phase = "-90 deg", cycles = 2 },
]

[solver]
springs = 200
"#;

fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    write(&folder, "creep.csv", &creep_csv());
    write(&folder, "scenario.toml", SCENARIO);
    folder
}

/// Runs `simulate`; what it printed.
fn simulate(folder: &TempDir, file: &str, out: &str, flags: &[&str]) -> String {
    let mut command = program();
    command
        .current_dir(folder.path())
        .args(["simulate", file, "--out", out]);
    for flag in flags {
        command.args(["--set", flag]);
    }
    let assert = command.assert().success();
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

/// (time, approach, contact radius) at every instant in contact.
fn history(folder: &TempDir, out: &str) -> Vec<[f64; 3]> {
    let text = fs::read_to_string(folder.path().join(out).join("history.csv")).unwrap();
    let cell = |line: &str, k: usize| line.split(',').nth(k).unwrap().parse::<f64>();
    let rows = text.lines().skip(1);
    rows.filter_map(|line| {
        let approach_m = cell(line, 2).ok()?;
        Some([cell(line, 0).unwrap(), approach_m, cell(line, 3).unwrap()])
    })
    .collect()
}

fn summary(folder: &TempDir, out: &str) -> serde_json::Value {
    let bytes = fs::read(folder.path().join(out).join("summary.json")).unwrap();
    serde_json::from_slice(&bytes).unwrap()
}

/// The largest misfit, relative to the data, in what was printed.
fn reported_misfit(printed: &str) -> f64 {
    let words = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    let (_, misfit) = words.split_once("Misfit relative to the data").unwrap();
    let (before, _) = misfit.split_once("% at most").unwrap();
    0.01 * before
        .split_whitespace()
        .last()
        .unwrap()
        .parse::<f64>()
        .unwrap()
}

const DIRECT: &str = "material.table.evaluation=direct";

#[test]
fn fit_and_direct_sum_agree_within_what_fit_and_interpolation_leave_open() {
    let folder = folder();
    let fitted = simulate(&folder, "scenario.toml", "fit", &["time.step=1 s"]);
    let direct = simulate(
        &folder,
        "scenario.toml",
        "direct",
        &["time.step=1 s", DIRECT],
    );
    let words = direct.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains("No fit: 81 samples") && words.contains("by the direct hereditary sum"),
        "{direct}"
    );
    assert!(direct.lines().all(|line| line.chars().count() <= 80));
    let misfit = reported_misfit(&fitted);
    assert_eq!(
        summary(&folder, "fit")["hereditary_integral"],
        "fitted series"
    );
    assert_eq!(
        summary(&folder, "direct")["hereditary_integral"],
        "direct sum"
    );
    let (a, b) = (history(&folder, "fit"), history(&folder, "direct"));
    assert_eq!(a.len(), b.len());
    let largest = |k: usize| a.iter().map(|row| row[k]).fold(0.0, f64::max);
    let apart = |k: usize, end_s: f64| {
        let pairs = a.iter().zip(&b).filter(|(a, _)| a[0] <= end_s);
        pairs.map(|(a, b)| (a[k] - b[k]).abs()).fold(0.0, f64::max) / largest(k)
    };
    let (held, whole, radius) = (apart(1, 100.0), apart(1, 400.0), apart(2, 400.0));
    println!(
        "{fitted}\n{direct}\napproach {held:.2e} apart in the hold, {whole:.2e} at all times, radius {radius:.2e}; misfit \
         {misfit:.2e}"
    );
    // Under the first load the approach goes with the power 2/3 of the compliance. A load taken off adds its own share of the
    // misfit to that of the load put on. The radius goes with 1/3.
    assert!(held < misfit && radius < misfit, "{held:e} {radius:e}");
    assert!(whole < 2.0 * misfit, "{whole:e}");
    // They are not the same computation.
    assert!(held > 0.01 * misfit, "{held:e}");
}

#[test]
fn the_resolved_scenario_shows_the_samples_and_gives_the_same_history_again_without_the_table() {
    let folder = folder();
    simulate(&folder, "scenario.toml", "first", &[DIRECT]);
    fs::remove_file(folder.path().join("creep.csv")).unwrap();
    let resolved = fs::read_to_string(folder.path().join("first/resolved.toml")).unwrap();
    assert!(
        resolved.contains("evaluation = \"direct\"\ntimes = [0.1, "),
        "{resolved}"
    );
    simulate(&folder, "first/resolved.toml", "second", &[]);
    for name in ["resolved.toml", "history.csv", "summary.json"] {
        let read = |out: &str| fs::read_to_string(folder.path().join(out).join(name)).unwrap();
        assert_eq!(read("first"), read("second"), "{name}");
    }
    // The same samples, fitted.
    let fitted = simulate(
        &folder,
        "first/resolved.toml",
        "third",
        &["material.table.evaluation=fit"],
    );
    assert!(fitted.contains("Fit of 2 branches"), "{fitted}");
}

#[test]
fn steps_chosen_by_the_program_are_as_good_with_samples_as_steps_that_are_four_times_shorter() {
    let folder = folder();
    for (out, flags) in [
        ("chosen", vec![DIRECT]),
        ("short", vec![DIRECT, "time.step=0.25 s"]),
    ] {
        simulate(&folder, "scenario.toml", out, &flags);
    }
    let (chosen, short) = (history(&folder, "chosen"), history(&folder, "short"));
    let largest = short.iter().map(|row| row[1]).fold(0.0, f64::max);
    let mut compared = 0;
    for row in &chosen {
        if let Some(other) = short.iter().rfind(|other| (other[0] - row[0]).abs() < 1e-9) {
            let off = (row[1] - other[1]).abs() / largest;
            assert!(off < 2e-4, "{row:?} {other:?}");
            compared += 1;
        }
    }
    assert!(compared > 5, "{compared}");
}

#[test]
fn the_half_space_engine_takes_samples_too() {
    let folder = folder();
    let short = "drive.segments=[{ kind = \"step\", to = 10, duration = 100 }, { kind = \"ramp\", to = 2, duration = 20 }]";
    let step = "time.step=5 s";
    let cells = ["solver.engine=half-space", "solver.cells=32"];
    simulate(&folder, "scenario.toml", "springs", &[DIRECT, short, step]);
    simulate(
        &folder,
        "scenario.toml",
        "cells",
        &[&[DIRECT, short, step], &cells[..]].concat(),
    );
    let (a, b) = (history(&folder, "springs"), history(&folder, "cells"));
    for (a, b) in a.iter().zip(&b) {
        // 32 cells across: the engines are this far apart on a series as well.
        assert!((a[1] / b[1] - 1.0).abs() < 1e-3, "{a:?} {b:?}");
    }
}

#[test]
fn a_sweep_says_why_it_cannot_take_samples_directly_and_what_to_write() {
    let folder = folder();
    let head = SCENARIO.split("[drive]").next().unwrap();
    let head = head.replace("modulus =", "evaluation = \"direct\"\nmodulus =");
    let rest = "[drive]\nmean = 10\namplitude = 5\n[sweep]\nangular_frequency = [0.01]\n[cycle]\nsteps = 20\n";
    write(&folder, "sweep.toml", &format!("{head}{rest}"));
    let assert = program()
        .current_dir(folder.path())
        .args(["sweep", "sweep.toml"])
        .assert()
        .code(2);
    let stderr = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
    let words = stderr.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "sweep.toml:9:14",
        "stabilised cycle is found from the memory variables of a series (Prony form)",
        "evaluation = \"fit\"",
        "contact-dma simulate",
    ] {
        assert!(words.contains(part), "{part} is missing in:\n{stderr}");
    }
    // Looked at, the material is the fit; the sweep itself takes it as well.
    program()
        .current_dir(folder.path())
        .args(["material", "show", "sweep.toml"])
        .assert()
        .success()
        .stdout(contains("Misfit relative to the data"));
    program()
        .current_dir(folder.path())
        .args([
            "sweep",
            "sweep.toml",
            "--set",
            "material.table.evaluation=fit",
        ])
        .assert()
        .success();
}

#[test]
fn a_history_too_long_for_the_direct_sum_is_refused_with_advice() {
    let folder = folder();
    program()
        .current_dir(folder.path())
        .args(["simulate", "scenario.toml", "--set", DIRECT])
        .args(["--set", "time.step=5 ms"])
        .assert()
        .code(2)
        .stderr(
            contains("too many for the direct sum")
                .and(contains("longer [time] step"))
                .and(contains("evaluation = \"fit\"")),
        );
    assert!(!Path::new(folder.path()).join("reports").exists());
}
