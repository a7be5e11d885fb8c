//! `[adhesion]` in a sweep file: what comes of it, and what is refused.

#![cfg(feature = "cli")]

use std::fs;

use crate::program::{program, write};
use tempfile::TempDir;

fn sweep(indenter: &str, drive: &str, rest: &str) -> String {
    format!(
        "title = \"t\"\n[material]\nlibrary = \"pmma\"\n[indenter]\n{indenter}\n[drive]\n{drive}\n[adhesion]\nwork = \"50 mJ/m^2\"\n\
         {rest}[cycle]\nsteps = 20\nerror_bars = false\n"
    )
}

const SPHERE: &str = "shape = \"sphere\"\nradius = \"100 nm\"";
/// 2 pi w R is 31.4 nN.
const PULL: &str = "mean = \"-5 nN\"\namplitude = \"20 nN\"";
const ONE: &str = "[sweep]\nangular_frequency = [\"0.01 rad/s\"]\n";

#[test]
fn a_load_may_be_a_pull_and_the_resolved_file_says_why() {
    let folder = TempDir::new().unwrap();
    let run = |text: &str, out: &str| {
        let file = write(&folder, "adhesion.toml", text);
        let out = folder.path().join(out);
        let mut command = program();
        command.args(["sweep", &file, "--quiet", "--out"]).arg(&out);
        command.assert().success();
        let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
        (read("sweep.csv"), read("resolved.toml"), read("index.html"))
    };
    let (table, resolved, page) = run(&sweep(SPHERE, PULL, ONE), "one");
    assert!(resolved.contains("[adhesion]\nwork = \"0.05 J/m^2\"\nequilibrium_distance = "));
    assert!(page.contains("a work of adhesion of 0.05 J/m² (DMT)"));
    // Tabor's parameter of a tip of 100 nm on a polymer.
    assert!(table.contains("tabor-parameter"), "{table}");
    assert_eq!(run(&resolved, "two").0, table);
    // A larger sphere is attracted more: each value of an axis has its own pull-off load.
    let radii = format!("{ONE}indenter.radius = [\"100 nm\", \"300 nm\"]\n");
    let (over, ..) = run(&sweep(SPHERE, PULL, &radii), "over");
    let loss = |table: &str, row: usize| {
        let mut rows = csv::Reader::from_reader(table.as_bytes());
        let at = rows
            .headers()
            .unwrap()
            .iter()
            .position(|c| c == "energy_loss_j");
        rows.records().nth(row).unwrap().unwrap()[at.unwrap()].to_owned()
    };
    assert_eq!(loss(&over, 0), loss(&table, 0));
    assert_ne!(loss(&over, 1), loss(&table, 0));
}
