//! The program as a user meets it: output, messages, exit codes, files.

use crate::prelude::*;
use std::process::Command as Process;

/// A sweep of three frequencies that takes a moment.
const SMALL: &str = include_str!("../inputs/three.toml");

fn place() -> Place {
    Place::with("small.toml", SMALL)
}

#[test]
fn a_sweep_prints_its_table_and_leaves_every_file() {
    let place = place();
    let run = place.done("sweep small.toml");
    run.says(&["loss / cycle", "converged", "Peak: ", "at ω = (8.4"])
        .says(&["Results in reports/small"]);
    place.has_all(
        "reports/small",
        "sweep.csv summary.json resolved.toml figures/energy-loss.csv figures/energy-loss.svg figures/energy-loss.png figures/energy-loss@2x.png figures/loops.csv \
         figures/loops.svg figures/loops.png figures/loops@2x.png cases/loops/0.csv cases/loops/2.csv cases/pressures/1.csv cases/work/1.csv cases/cycles.npz",
    );
    let table = place.table("reports/small/sweep.csv");
    assert_eq!(table.cells("status"), ["converged"; 3]);
    let [loss, error] = table.row(1, ["energy_loss_j", "energy_loss_error_j"]);
    assert!(error > 0.0 && error < 0.01 * loss);
    near!(loss, 3.5e-6, 0.01);
    let summary = place.json("reports/small/summary.json");
    let omega = &summary["peaks"][0]["angular_frequency_rad_per_s"];
    near!(omega.as_f64().unwrap(), 0.00844, 2e-3);
    assert_eq!(summary["cases"]["converged"], 3);
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let place = place();
    let threads = ["1", "2", "3"];
    for threads in threads {
        let run = format!("sweep small.toml --quiet --threads {threads} --out {threads}");
        let run = place.done(&run);
        assert_eq!(run.stdout + &run.stderr, "");
    }
    for name in ["sweep.csv", "summary.json", "figures/energy-loss.png"] {
        place.are_same(&threads, name);
    }
}

#[test]
fn the_resolved_sweep_is_a_sweep_file_with_the_same_results() {
    let place = place();
    place.done("sweep small.toml --quiet --no-figures --out first");
    place.done("sweep first/resolved.toml --quiet --no-figures --out second");
    for name in ["resolved.toml", "sweep.csv", "summary.json"] {
        place.are_same(&["first", "second"], name);
    }
}

#[test]
fn a_fractional_material_becomes_a_series_that_the_resolved_file_holds() {
    let block = "poisson_ratio = 0.4\n[material.fractional]\nmodulus = \"longitudinal\"\nstiffness = \"1 GPa\"\ntime = \"1 s\"\n\
                 exponent = 0.5\nband = [\"1e-3 rad/s\", \"10 rad/s\"]\nmodel = \"zener\"\nequilibrium = \"1 MPa\"\n";
    let text = SMALL.replace("library = \"pmma\"", block);
    let place = Place::with("zener.toml", &text);
    let within = ["fractional Zener model as a series of"];
    let sweep = place.done("sweep zener.toml --no-figures --out out");
    sweep.says(&within);
    let measured =
        "measured = [\"0.1 s\", \"1000 s\"]\n\n[material.relaxation]\nmodulus = \"longitudinal\"";
    // The modulus at rest is the model's own.
    let parts = [measured, "equilibrium = \"1000000 Pa\""];
    says(&place.text("out/resolved.toml"), &parts);
    place.done("material show zener.toml").says(&within);
    let json = place.done("material show zener.toml --format json").json();
    for error in ["error", "loss_error"] {
        let error = json["approximation"][error].as_f64().unwrap();
        assert!(error > 0.0 && error < 1e-3, "{json}");
    }
    // The error of the loss, of which the series has its part, is that of the resolved file too.
    place.done("sweep out/resolved.toml --no-figures --out again");
    place.are_same(&["out", "again"], "sweep.csv");
    // As the classical solid of one branch where the exponent is one.
    let classical = text.replace("exponent = 0.5", "exponent = 1.0");
    place.swept(&classical);
    let branch = "branches = [\n    { modulus = \"1000000000 Pa\", time = \"1 s\" },\n]";
    says(&place.text("out/resolved.toml"), &[branch]);
}

#[test]
fn an_unwritable_folder_says_so() {
    let place = place();
    // A file where the folder should be: unwritable even for root.
    let told = place.ends("sweep small.toml --out small.toml/out", 1);
    says(&told, &["small.toml/out", "cannot create the folder"]);
}

#[test]
fn results_of_another_sweep_are_replaced_only_when_asked_and_what_changed_is_told() {
    let place = place();
    let sweep = "sweep small.toml --quiet --no-figures --out out";
    let other = format!("{sweep} --set cycle.steps=48");
    place.done(sweep);
    let before = place.files("out");
    let told = place.refused(&other);
    says(&told, &["--force", "- steps = 50", "+ steps = 48"]);
    assert!(!told.contains("radius"), "{told}");
    assert!(place.files("out") == before);
    place.done(sweep);
    assert_eq!(place.bytes("out/sweep.csv"), before["sweep.csv"]);
    place.done(&format!("{other} --force"));
    assert_ne!(place.bytes("out/sweep.csv"), before["sweep.csv"]);
    // Records of the other sweep are gone.
    assert_eq!(place.files("out/records").len(), 1);
}

/// Of three frequencies the last one is not stabilised in so many cycles.
const FEW_CYCLES: &str = "sweep small.toml --set 'sweep.angular_frequency=[0.002, 0.004, 1.0]' --set cycle.method=march --set cycle.max_cycles=4";

#[test]
fn a_case_that_does_not_converge_has_no_loss_and_does_not_stop_the_others() {
    let place = place();
    let run = place.run(FEW_CYCLES).ended(3);
    run.says(&["not-converged", "estimated distance"]);
    let table = place.table("reports/small/sweep.csv");
    assert_eq!(table.number(2, "angular_frequency_rad_per_s"), 1.0);
    assert_eq!(table.found("energy_loss_j")[2], None);
    assert_eq!(table.cells("status")[2], "not-converged");
    assert!(
        !place.has("reports/small/cases/loops/2.csv")
            && place.has("reports/small/cases/loops/1.csv")
    );
}

#[test]
fn a_narrow_terminal_still_says_which_case_has_no_result() {
    let place = place();
    for (columns, left_out) in [
        ("80", ""),
        ("60", "left out in 60 columns: phase / deg, cycles"),
        ("40", "left out in 40 columns: loss / cycle,"),
    ] {
        let line = format!("{FEW_CYCLES} --no-figures");
        let text = place.run_in(&line, &[("COLUMNS", columns)]).ended(3).stdout;
        let table: Vec<&str> = text.split("\n\n").nth(1).unwrap().lines().collect();
        assert!(table[0].ends_with("status"), "{text}");
        assert!(table[1].ends_with("converged") && table[1].trim().starts_with("2.000e-3"));
        assert!(table[3].ends_with("not-converged") && table[3].trim().starts_with("1.000"));
        assert!(text.contains(left_out), "{text}");
        assert_eq!(text.contains("left out"), columns < "80");
    }
}

#[test]
fn a_sweep_in_which_nothing_converges_still_ends_cleanly() {
    let place = place();
    let run = place.run("sweep small.toml --set cycle.max_cycles=1 --set cycle.tolerance=1e-12");
    run.ended(3).says(&["no case converged"]);
    assert!(place.has("reports/small/summary.json"));
    assert!(!place.has("reports/small/figures/energy-loss.svg"));
}

#[test]
fn materials_are_listed_and_shown() {
    let place = Place::new();
    place.done("material list").says(&["pmma", "Narasimhan"]);
    // Equation (10) of the paper.
    place.done("material show PMMA").says(&[
        "Φ(t) = 6.9944e-4",
        "- 6.1742e-5 exp(-0.100641 t)",
        "- 8.3804e-5 exp(-0.00746991 t)",
        "E(0) = 2491.44 MPa",
    ]);
}

#[test]
fn a_material_is_drawn_into_a_folder() {
    let place = Place::new();
    place.done("material show pmma --out out");
    place.has_all(
        "out",
        "figures/moduli.svg figures/moduli.png figures/moduli.csv figures/relaxation.svg figures/relaxation@2x.png",
    );
    // Figure 1 of the paper: from 2491.44 MPa down to 1973.05 at 1000 s.
    let curve = place.table("out/figures/relaxation.csv").rows;
    let number = |cell: &String| cell.parse::<f64>().unwrap();
    let (first, last) = (&curve[0], &curve[curve.len() - 1]);
    assert_eq!(number(&last[0]), 1000.0);
    near!(number(&first[1]), 2491.4388e6, 1e-9);
    near!(number(&last[1]), 1973.05e6, 5e-6);
}

#[test]
fn a_material_that_is_refused_for_contact_can_still_be_looked_at() {
    let kelvin = "[material]\npoisson_ratio = 0.4\n[material.kelvin_voigt]\nspring = \"1 MPa\"\ntime = \"2 s\"\n";
    let place = Place::with("kelvin.toml", kelvin);
    let shown = place.done("material show kelvin.toml --out figures");
    shown.says(&["none: without an instantaneous compliance"]);
}

#[test]
fn help_has_examples_and_completions_are_made() {
    let place = Place::new();
    #[cfg(target_os = "linux")]
    for arguments in [&["--help"][..], &["material", "list"]] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full");
        let mut command = Process::new(assert_cmd::cargo::cargo_bin("contact-dma"));
        command.args(arguments).stdout(full.unwrap());
        let ended = command.output().unwrap();
        assert_eq!(ended.status.code(), Some(1), "{arguments:?}");
        assert!(String::from_utf8_lossy(&ended.stderr).contains("No space left"));
    }
    place.done("sweep --help").says(&["Examples:", "--set"]);
    for shell in ["bash", "zsh", "fish"] {
        let script = place.done(&format!("completions {shell}"));
        script.says(&["contact-dma"]);
    }
}

#[test]
fn a_sweep_file_may_come_from_standard_input() {
    let creep = "Time [min];D [1/MPa];Creep compliance [1/MPa]\n0,1;1;1,0e0\n1;2;1,1\n10;3;1,5\n100;4;1,6\n";
    let place = Place::with("creep.csv", creep);
    let table = "[material]\npoisson_ratio = 0.4\n[material.table]\nfile = \"creep.csv\"\nquantity = \"creep\"\nmodulus = \"shear\"";
    let text = SMALL.replace("[material]\nlibrary = \"pmma\"", table);
    let run = |line: &str, text: &str| place.run_on(line, text);
    let plan = run("plan -", &text).ended(0);
    plan.says(&["3 cases on 100 springs"]);
    run("material show -", &text).ended(0);
    run("sweep - --quiet --no-figures", &text).ended(0);
    assert!(place.has("reports/stdin/sweep.csv"));
    run("sweep - --quiet --out there", SMALL).ended(0);
    assert!(place.has("there/figures/energy-loss.svg"));
    let wrong = run("sweep -", &SMALL.replace("radius", "raduis")).ended(2);
    says(&wrong.stderr, &["--> standard input:", "`radius`"]);
    let wrong = run("simulate -", SMALL).ended(2);
    says(&wrong.stderr, &["a sweep"]);
}

#[test]
fn tables_alone_are_written_where_no_figures_are_asked_for_and_drawn_elsewhere_later() {
    let place = place();
    let names = |folder: &str| {
        let entries = fs::read_dir(place.path(folder)).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let sweep = "sweep small.toml --quiet --out source";
    place.done(sweep);
    assert!(place.has("source/index.html"));
    place.done(&format!("{sweep} --no-figures"));
    // Of the earlier run nothing is left.
    for name in ["index.html", "figures/energy-loss.svg", "figures/loops.csv"] {
        assert!(!place.has(&format!("source/{name}")), "{name}");
    }
    let table = place.path("source/sweep.csv");
    let modified = || fs::metadata(&table).unwrap().modified().unwrap();
    let (before, written) = (names("source"), modified());
    let report = "report source --quiet --out drawn";
    place.done(&format!("{report} --set 'figures.formats=[\"svg\"]'"));
    assert_eq!((names("source"), modified()), (before, written));
    assert!(place.has("drawn/index.html") && place.has("drawn/figures/energy-loss.svg"));
    assert!(!place.has("drawn/figures/energy-loss.png") && !place.has("drawn/records"));
    let is_same = || place.bytes("drawn/sweep.csv") == place.bytes("source/sweep.csv");
    assert!(is_same());
    says(&place.text("drawn/resolved.toml"), &["formats = [\"svg\"]"]);
    // Of another sweep nothing is replaced unasked.
    let other = "sweep small.toml --quiet --no-figures --out drawn --set cycle.steps=40";
    place.refused(other);
    place.done(&format!("{other} --force"));
    assert!(place.refused(report).contains("--force"));
    place.done(&format!("{report} --force"));
    assert!(is_same());
}

#[test]
fn a_narrow_terminal_gets_narrow_tables() {
    let place = place();
    for (line, columns) in [
        ("sweep small.toml --no-figures", 80),
        ("sweep small.toml --no-figures", 50),
        ("plan small.toml", 60),
        ("material show pmma", 60),
        ("material list", 40),
    ] {
        let run = place.run_in(line, &[("COLUMNS", &columns.to_string())]);
        let text = run.ended(0).stdout;
        assert!(!text.is_empty());
        for line in text.lines() {
            // A word that is longer stays whole.
            let is_one_word = line.trim().split(' ').count() == 1;
            assert!(line.chars().count() <= columns || is_one_word, "{text}");
        }
        let is_whole = line.starts_with("material") || columns == 80;
        assert!(is_whole || text.contains("left out in"), "{text}");
    }
}

#[test]
fn a_large_number_is_printed_with_an_exponent() {
    let plan = place().done("plan small.toml --set 'drive.mean=1e30 N'");
    says(&plan.stdout, &["1e30"]);
    assert!(!words(&plan.stdout).contains("000000000"));
}
