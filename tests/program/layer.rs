//! A layer in sweep and scenario files: what is refused, and what is told of it.

#![cfg(feature = "cli")]

use std::fs;

use crate::program::program;
use contact_dma::quantity::{Dimension, format_si};
use tempfile::TempDir;

const SWEEP: &str = "title = \"t\"\n[material]\nlibrary = \"pmma\"\n[layer]\nthickness = \"10 um\"\nbase = \"frictionless\"\n\
                     [indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n[drive]\nmean = \"10 N\"\namplitude = \"1 N\"\n\
                     [sweep]\nangular_frequency = [\"0.01 rad/s\"]\n[cycle]\nsteps = 20\nerror_bars = false\n";

#[test]
fn a_layer_is_solved_on_cells_where_nothing_else_is_asked_for() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("layer.toml");
    fs::write(&file, SWEEP).unwrap();
    let run = |set: &str| {
        let mut command = program();
        command
            .arg("sweep")
            .arg(&file)
            .args(["--quiet", "--set", set]);
        command
            .arg("--out")
            .arg(folder.path().join("out"))
            .output()
            .unwrap()
    };
    assert_eq!(run("solver.cells=24").status.code(), Some(0));
    let out = folder.path().join("out");
    let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
    let thickness = format_si(1e-5, Dimension::Length);
    let block = format!("[layer]\nthickness = \"{thickness}\"\nbase = \"frictionless\"\n");
    assert!(read("resolved.toml").contains(&block));
    assert!(read("index.html").contains("a layer on a rigid base without friction"));
    // 10 N press a sphere of 10 mm in by more than a micrometre of ten.
    assert!(read("sweep.csv").contains("deep-in-layer"));
}

#[test]
fn a_base_that_yields_is_told() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("layer.toml");
    let out = folder.path().join("out");
    let sweep = |block: &str, set: &str| {
        fs::write(&file, SWEEP.replace("base = \"frictionless\"", block)).unwrap();
        let mut command = program();
        command
            .arg("sweep")
            .arg(&file)
            .args(["--quiet", "--set", set]);
        command.arg("--out").arg(&out).output().unwrap()
    };
    let both = "base_modulus_ratio = 4\nbase_poisson_ratio = 0.4";
    let done = sweep(both, "solver.cells=24");
    assert_eq!(done.status.code(), Some(0), "{done:?}");
    let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
    assert!(read("resolved.toml").contains("base_modulus_ratio = 4.0\nbase_poisson_ratio = 0.4\n"));
    assert!(read("index.html").contains("bonded to a base of 4 times its shear modulus"));
    // Other numbers of the base are another sweep.
    let other = sweep(&both.replace('4', "5"), "solver.cells=24");
    assert_ne!(other.status.code(), Some(0));
}
