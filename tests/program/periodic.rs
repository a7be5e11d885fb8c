//! `edge = "periodic"` in the files: a patch of a rough surface that repeats itself, and what is refused.

#![cfg(feature = "cli")]

use std::fs;

use crate::program::{program, write};
use tempfile::TempDir;

const ROUGH: &str = "shape = \"rough\"\ncells = 32\nspacing = \"2 um\"\nhurst_exponent = 0.8\nrms_height = \"50 nm\"\n\
                     cut_off_wavelength = \"8 um\"\nseed = 3\nedge = \"periodic\"";

const ONE: &str = "angular_frequency = [\"0.01 rad/s\"]";

fn sweep(indenter: &str, rest: &str) -> String {
    format!(
        "title = \"t\"\n[material]\nlibrary = \"pmma\"\n[indenter]\n{indenter}\n[drive]\nmean = \"0.1 N\"\namplitude = \"0.05 N\"\n\
         [sweep]\n{ONE}\n[cycle]\nsteps = 20\nerror_bars = false\n{rest}"
    )
}

fn run(folder: &TempDir, text: &str, out: &str) -> std::process::Output {
    let file = write(folder, "periodic.toml", text);
    let mut command = program();
    command.args(["sweep", &file, "--quiet", "--out"]);
    command.arg(folder.path().join(out)).output().unwrap()
}

#[test]
fn a_patch_that_repeats_itself_is_pressed_beyond_what_its_edge_would_allow() {
    let folder = TempDir::new().unwrap();
    let text = sweep(ROUGH, "");
    assert_eq!(run(&folder, &text, "out").status.code(), Some(0));
    let read =
        |out: &str, name: &str| fs::read_to_string(folder.path().join(out).join(name)).unwrap();
    let resolved = read("out", "resolved.toml");
    assert!(resolved.contains("edge = \"periodic\""));
    assert_eq!(run(&folder, &resolved, "again").status.code(), Some(0));
    assert_eq!(read("again", "sweep.csv"), read("out", "sweep.csv"));
    // 24 MPa on average: the contact of a single patch reaches its edge.
    let single = text.replace("\nedge = \"periodic\"", "");
    let ended = run(&folder, &single, "single");
    assert_eq!(ended.status.code(), Some(3));
}

#[test]
fn a_mean_pressure_is_the_load_over_the_area_of_a_period() {
    let folder = TempDir::new().unwrap();
    let load = "mean = \"0.1 N\"\namplitude = \"0.05 N\"";
    // A patch of 64 by 64 um.
    let area_m2 = (32.0 * 2e-6) * (32.0 * 2e-6);
    let pressure = format!(
        "control = \"pressure\"\nmean = {:?}\namplitude = {:?}",
        0.1 / area_m2,
        0.05 / area_m2
    );
    let text = sweep(ROUGH, "");
    let of = |text: &str, out: &str| {
        assert_eq!(run(&folder, text, out).status.code(), Some(0));
        let csv = fs::read_to_string(folder.path().join(out).join("sweep.csv")).unwrap();
        let row = csv.lines().nth(1).unwrap().to_owned();
        let place = csv
            .lines()
            .next()
            .unwrap()
            .split(',')
            .position(|name| name == "energy_loss_j");
        let loss: f64 = row.split(',').nth(place.unwrap()).unwrap().parse().unwrap();
        loss
    };
    let (by_load, by_pressure) = (
        of(&text, "load"),
        of(&text.replace(load, &pressure), "pressure"),
    );
    assert!(
        (by_pressure / by_load - 1.0).abs() < 1e-12,
        "{by_pressure} {by_load}"
    );
    // The resolved file tells the load, and is the same sweep again.
    let resolved = folder.path().join("pressure/resolved.toml");
    let resolved = fs::read_to_string(resolved).unwrap();
    assert!(resolved.contains("control = \"load\""), "{resolved}");
    assert_eq!(of(&resolved, "pressure"), by_pressure);
    // As an axis too.
    let axis = format!("{ONE}\ndrive.mean = [\"20 MPa\", \"30 MPa\"]");
    let over = text.replace(load, &pressure).replace(ONE, &axis);
    assert_eq!(run(&folder, &over, "over").status.code(), Some(0));
    let csv = fs::read_to_string(folder.path().join("over/sweep.csv")).unwrap();
    let (head, row) = (csv.lines().next().unwrap(), csv.lines().nth(1).unwrap());
    let mean = head
        .split(',')
        .position(|name| name == "drive_mean")
        .unwrap();
    let mean_n: f64 = row.split(',').nth(mean).unwrap().parse().unwrap();
    assert!((mean_n / (20e6 * area_m2) - 1.0).abs() < 1e-12, "{mean_n}");
}

#[test]
fn every_kind_of_segment_may_be_a_mean_pressure() {
    let area_m2 = (32.0 * 2e-6) * (32.0 * 2e-6);
    let folder = TempDir::new().unwrap();
    let of = |control: &str, one: f64, out: &str| {
        let unit = if control == "load" { "N" } else { "Pa" };
        let history = format!(
            "title = \"t\"\n[material]\nlibrary = \"pmma\"\n[indenter]\n{ROUGH}\n[drive]\ncontrol = \"{control}\"\n\
             segments = [\n{{ kind = \"ramp\", to = \"{one:?} {unit}\", duration = \"1 s\" }},\n\
             {{ kind = \"step\", to = \"{:?} {unit}\", duration = \"1 s\" }},\n\
             {{ kind = \"sine\", mean = {one:?}, amplitude = {:?}, frequency = 1, cycles = 1 }},\n\
             {{ kind = \"polynomial\", coefficients = [{one:?}, {:?}], duration = \"1 s\" }},\n\
             {{ kind = \"table\", times = [0, 1], values = [{one:?}, {:?}] }}]\n\
             [time]\nstep = \"0.1 s\"\n[output]\nerror_bars = false\n",
            0.5 * one,
            0.2 * one,
            0.1 * one,
            0.7 * one,
        );
        let file = write(&folder, "history.toml", &history);
        let mut command = program();
        command.args(["simulate", &file, "--quiet", "--out"]);
        let out = folder.path().join(out);
        let done = command.arg(&out).output().unwrap();
        assert_eq!(done.status.code(), Some(0), "{done:?}");
        let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
        assert!(read("resolved.toml").contains("control = \"load\""));
        let csv = read("history.csv");
        let place = csv
            .lines()
            .next()
            .unwrap()
            .split(',')
            .position(|name| name == "approach_m");
        let rows = csv.lines().skip(1);
        let approach = |row: &str| row.split(',').nth(place.unwrap()).unwrap().parse::<f64>();
        rows.filter_map(|row| approach(row).ok())
            .collect::<Vec<f64>>()
    };
    let (by_load, by_pressure) = (
        of("load", 0.1, "load"),
        of("pressure", 0.1 / area_m2, "pressure"),
    );
    assert!(by_load.len() == by_pressure.len() && by_load.len() > 40);
    for (load, pressure) in by_load.iter().zip(&by_pressure) {
        // Rounding of the loads, through the tolerance of an instant.
        assert!(
            (load - pressure).abs() < 1e-6 * load.abs() + 1e-15,
            "{load:e} {pressure:e}"
        );
    }
}
