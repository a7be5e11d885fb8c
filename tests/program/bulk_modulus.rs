//! `bulk_modulus` in place of `poisson_ratio` in the files: what comes of it, and what is refused.

#![cfg(feature = "cli")]

use std::fs;

use crate::program::{program, write};
use tempfile::TempDir;

fn sweep(material: &str) -> String {
    format!(
        "title = \"t\"\n[material]\n{material}\n[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n[drive]\nmean = \"1 N\"\n\
         amplitude = \"0.1 N\"\n[sweep]\nangular_frequency = [\"0.1 rad/s\", \"10 rad/s\"]\n[cycle]\nsteps = 20\nerror_bars = false\n"
    )
}

const SERIES: &str = "relaxation = { modulus = \"KIND\", equilibrium = \"2 MPa\", branches = [{ modulus = \"900 MPa\", time = \"1 s\" }] }";

fn series(kind: &str) -> String {
    SERIES.replace("KIND", kind)
}

/// Exit code, and what was told on standard error, on one line.
fn told(text: &str, command: &str) -> (Option<i32>, String) {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "bulk.toml", text);
    let mut run = program();
    run.args(["material", command, &file]);
    if command == "export" {
        run.args(["--to", "abaqus"]);
    }
    let output = run.output().unwrap();
    let text = [output.stdout, output.stderr].concat();
    let words = String::from_utf8_lossy(&text)
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    (output.status.code(), words)
}

#[test]
fn a_resolved_sweep_of_either_kind_of_moduli_gives_the_same_losses_again() {
    for kind in ["shear", "longitudinal"] {
        let folder = TempDir::new().unwrap();
        let text = sweep(&format!("bulk_modulus = \"3 GPa\"\n{}", series(kind)));
        let file = write(&folder, "bulk.toml", &text);
        let run = |file: &str, out: &str| {
            let out = folder.path().join(out);
            let mut command = program();
            command.args(["sweep", file, "--quiet", "--no-figures", "--out"]);
            command.arg(&out).assert().success();
            let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
            (read("sweep.csv"), read("resolved.toml"))
        };
        let (table, resolved) = run(&file, "one");
        assert!(
            resolved.contains("bulk_modulus = \"3000000000 Pa\""),
            "{resolved}"
        );
        assert!(!resolved.contains("poisson_ratio"));
        let again = write(&folder, "again.toml", &resolved);
        assert_eq!(run(&again, "two"), (table, resolved));
    }
}

#[test]
fn the_material_shows_how_its_poisson_ratio_grows() {
    let block = format!(
        "[material]\nbulk_modulus = \"3 GPa\"\n{}\n",
        series("shear")
    );
    let (code, told) = told(&block, "show");
    assert_eq!(code, Some(0), "{told}");
    assert!(told.contains("Bulk modulus 3 GPa"), "{told}");
    // (3K - 2G)/(2(3K + G)) of 902 MPa and of 2 MPa.
    assert!(
        told.contains(" 0 0.3634") && told.contains("inf 0.4997"),
        "{told}"
    );
}

#[test]
fn an_export_that_needs_a_poisson_ratio_says_so() {
    let block = format!(
        "[material]\nbulk_modulus = \"3 GPa\"\n{}\n",
        series("shear")
    );
    let (code, told) = told(&block, "export");
    assert_eq!(code, Some(2), "{told}");
    assert!(told.contains("needs a Poisson ratio"), "{told}");
}
