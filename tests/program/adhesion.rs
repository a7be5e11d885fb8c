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

/// A sphere of 1 um on a solid that stiffens tenfold, under loads or pulled off in every cycle.
fn attracted(drive: &str, frequencies: &str) -> String {
    let solid = "[material]\npoisson_ratio = 0.5\n[material.zener]\nspring = \"10 MPa\"\nkelvin_spring = \"1.1111 MPa\"\ntime = \"10 s\"\n";
    let contact = "[indenter]\nshape = \"sphere\"\nradius = \"1 um\"\n[adhesion]\nwork = \"50 mJ/m^2\"\nrange = \"40 nm\"\n";
    format!("title = \"t\"\n{solid}{contact}[drive]\n{drive}\n{frequencies}")
}

const LOAD: &str = "mean = \"80 nN\"\namplitude = \"60 nN\"";
const SWEEP: &str = "[sweep]\nangular_frequency = { from = \"1e-3 rad/s\", to = \"10 rad/s\", points = 5, spacing = \"log\" }\n[cycle]\nsteps = 64\n[solver]\nsprings = 100\n";

#[test]
fn a_sweep_of_an_attracted_sphere_tells_the_parts_of_its_loss_and_solid_and_attraction_are_found_from_it()
 {
    let place = Place::new();
    place.put("load.toml", attracted(LOAD, SWEEP));
    place.done("sweep load.toml --quiet --out swept");
    let table = place.table("swept/sweep.csv");
    for row in 0..5 {
        let of = |name: &str| table.number(row, name);
        let parts = of("bulk_loss_j") + of("edge_loss_j") + of("jump_loss_j");
        assert!((parts / of("energy_loss_j") - 1.0).abs() < 1e-12);
        assert!(of("zone_radius_max_m") > of("contact_radius_max_m"));
        assert!(of("energy_loss_error_j") > 0.0 && of("edge_loss_error_j") > 0.0);
    }
    // From a moving edge to a pinned one.
    let [slow, fast] =
        [0, 4].map(|row| table.number(row, "edge_loss_j") / table.number(row, "energy_loss_j"));
    assert!(slow > 0.4 && fast < 0.05, "{slow} {fast}");
    assert!(table.number(0, "tabor_parameter") > 4.0 * table.number(4, "tabor_parameter"));
    for figure in ["loss-parts", "stiffness"] {
        assert!(
            place.has(&format!("swept/figures/{figure}.svg")),
            "{figure}"
        );
    }
    // What is drawn again is what was drawn.
    let drawn = place.bytes("swept/figures/loss-parts.svg");
    place.done("report swept --quiet");
    assert_eq!(place.bytes("swept/figures/loss-parts.svg"), drawn);
    let known = attracted(
        LOAD,
        "[identify]\ndata = \"swept\"\nbranches = 1\nattraction = \"work-and-range\"\n",
    );
    let solid = known.find("[material.zener]").unwrap()..known.find("[indenter]").unwrap();
    // From another attraction on.
    let guessed = known.replace(&known[solid], "");
    let guessed = guessed.replace("50 mJ", "40 mJ").replace("40 nm", "50 nm");
    place.put("identify.toml", guessed);
    place.done("identify identify.toml --quiet --out found");
    let found = place.json("found/summary.json");
    let unknown = |name: &str| {
        let all = found["unknowns"].as_array().unwrap().iter();
        let one = all.clone().find(|unknown| unknown["name"] == name);
        one.unwrap()["value"].as_f64().unwrap()
    };
    // Shear moduli of 10 and 1 MPa, and the time of relaxation.
    for (name, expected) in [
        ("g_inf", 3e6),
        ("g_1", 27e6),
        ("tau_1", 1.0),
        ("work", 0.05),
        ("range", 40e-9),
    ] {
        let off = unknown(name) / expected - 1.0;
        assert!(off.abs() < 0.01, "{name}: {off}");
    }
}

#[test]
fn a_force_distance_curve_tells_its_pull_off_and_jumps_and_its_folder_keeps_them() {
    let place = Place::new();
    let curve = "control = \"approach\"\nsegments = [{ kind = \"step\", to = \"-200 nm\", duration = \"1 s\" }, { kind = \"ramp\", to = \"100 nm\", duration = \"3 s\" }, { kind = \"ramp\", to = \"-800 nm\", duration = \"9 s\" }]\n";
    place.put("curve.toml", attracted(curve, "[solver]\nsprings = 100\n"));
    place.done("simulate curve.toml --quiet --out curve");
    let summary = place.json("curve/summary.json");
    let pull_n = summary["separation"]["pull_n"].as_f64().unwrap();
    let loads: Vec<f64> = place.table("curve/history.csv").numbers("load_n");
    let least_n = loads.iter().copied().fold(0.0, f64::min);
    assert_eq!(pull_n, -least_n);
    // Above the 3/2 pi w R of an elastic sphere, since it is pulled off faster than it relaxes.
    assert!(pull_n > 2.0 * 1.5 * std::f64::consts::PI * 0.05 * 1e-6);
    assert!(summary["separation"]["work_j"].as_f64().unwrap() > 0.0);
    let jumps = summary["jumps"].as_array().unwrap().len();
    assert!(jumps >= 1);
    place.done("report curve --quiet");
    assert_eq!(
        place.json("curve/summary.json")["separation"],
        summary["separation"]
    );
    assert_eq!(place.json("curve/summary.json")["jumps"], summary["jumps"]);
}
