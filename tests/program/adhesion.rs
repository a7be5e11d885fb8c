//! `[adhesion]` in a sweep file: what comes of it, and what is refused.

use crate::prelude::*;

/// A sphere of 100 nm, whose pull 2 pi w R is 31.4 nN.
const PULL: &str = include_str!("../inputs/adhesion.toml");

#[test]
fn a_load_may_be_a_pull_and_the_resolved_file_says_why() {
    let place = Place::new();
    let run = |text: &str, out: &str| {
        place.put("adhesion.toml", text);
        place.done(&format!("sweep adhesion.toml --quiet --out {out}"));
        place.table(&format!("{out}/sweep.csv"))
    };
    let table = run(PULL, "one");
    let resolved = place.text("one/resolved.toml");
    assert!(resolved.contains("[adhesion]\nwork = \"0.05 J/m^2\"\nmodel = \"dmt\""));
    let work = "a work of adhesion of 0.05 J/m² (DMT)";
    says(&place.text("one/index.html"), &[work]);
    // Tabor's parameter of a tip of 100 nm on a polymer.
    says(table.cells("warnings")[0], &["tabor-parameter"]);
    assert_eq!(run(&resolved, "two"), table);
    // A larger sphere is attracted more: each value of an axis has its own pull-off load.
    let radii = "[sweep]\nindenter.radius = [\"100 nm\", \"300 nm\"]";
    let over = run(&PULL.replace("[sweep]", radii), "over");
    let (over, own) = (over.cells("energy_loss_j"), table.cells("energy_loss_j"));
    assert_eq!(over[0], own[0]);
    assert_ne!(over[1], own[0]);
}
