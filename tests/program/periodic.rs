//! `edge = "periodic"` in the files: a patch of a rough surface that repeats itself, and what is refused.

#![cfg(feature = "cli")]

use std::fs;

use crate::program::{program, write};
use tempfile::TempDir;

const ROUGH: &str = "shape = \"rough\"\ncells = 32\nspacing = \"2 um\"\nhurst_exponent = 0.8\nrms_height = \"50 nm\"\n\
                     cut_off_wavelength = \"8 um\"\nseed = 3\nedge = \"periodic\"";

fn sweep(indenter: &str, rest: &str) -> String {
    format!(
        "title = \"t\"\n[material]\nlibrary = \"pmma\"\n[indenter]\n{indenter}\n[drive]\nmean = \"0.1 N\"\namplitude = \"0.05 N\"\n\
         [sweep]\nangular_frequency = [\"0.01 rad/s\"]\n[cycle]\nsteps = 20\nerror_bars = false\n{rest}"
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
fn what_a_surface_without_an_edge_cannot_have_is_refused() {
    let sphere = format!("{ROUGH}\nsphere_radius = \"1 mm\"");
    let under =
        |drive: &str| sweep(ROUGH, "").replace("mean = \"0.1 N\"\namplitude = \"0.05 N\"", drive);
    for (text, part) in [
        (sweep(&sphere, ""), "does not repeat itself"),
        (
            sweep(ROUGH, "[layer]\nthickness = \"1 mm\"\n"),
            "half-space alone",
        ),
        (
            under("control = \"approach\"\nmean = \"50 nm\"\namplitude = \"10 nm\""),
            "pressed by a load",
        ),
        (
            sweep(ROUGH, "[solver]\nengine = \"axisymmetric\"\n"),
            "not a body of revolution",
        ),
    ] {
        let folder = TempDir::new().unwrap();
        let output = run(&folder, &text, "out");
        let told = String::from_utf8_lossy(&output.stderr)
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(part), "{part}: {told}");
    }
}
