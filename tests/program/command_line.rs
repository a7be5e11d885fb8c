//! The program as a user meets it: output, messages, exit codes, files.

#![cfg(feature = "cli")]

use crate::program::{Place, pmma_sweep, words};
use crate::segments;
use std::fs;
use std::process::{Command as Process, Stdio};
use std::time::{Duration, Instant};

const FREQUENCIES: &str = r#"["0.004 rad/s", "0.008 rad/s", "0.02 rad/s"]"#;

/// A sweep of three frequencies that takes a moment.
fn small() -> String {
    pmma_sweep(&format!(
        "[sweep]\nangular_frequency = {FREQUENCIES}\n[cycle]\nsteps = 50\n[solver]\nsprings = 100\n"
    ))
}

fn place() -> Place {
    Place::with("small.toml", &small())
}

#[test]
fn a_sweep_prints_its_table_and_leaves_every_file() {
    let place = place();
    place.done("sweep small.toml").says(&[
        "loss / cycle",
        "converged",
        "Peak: ",
        "at ω = (8.4",
        "Results in reports/small",
    ]);
    for name in "sweep.csv summary.json resolved.toml energy-loss.csv energy-loss.svg energy-loss.png energy-loss@2x.png loops.csv \
                 loops.svg loops.png loops@2x.png loops/0.csv loops/2.csv pressures/1.csv work/1.csv cycles.npz"
        .split_whitespace()
    {
        assert!(place.has(&format!("reports/small/{name}")), "{name}");
    }
    let table = place.table("reports/small/sweep.csv");
    assert_eq!(table.cells("status"), ["converged"; 3]);
    let loss = table.number(1, "energy_loss_j");
    let error = table.number(1, "energy_loss_error_j");
    assert!(error > 0.0 && error < 0.01 * loss);
    assert!((loss / 3.5e-6 - 1.0).abs() < 0.01);
    let summary = place.json("reports/small/summary.json");
    let omega = &summary["peaks"][0]["angular_frequency_rad_per_s"];
    assert!((omega.as_f64().unwrap() / 0.00844 - 1.0).abs() < 2e-3);
    assert_eq!(summary["cases"]["converged"], 3);
}

#[test]
fn the_printed_table_fits_eighty_columns() {
    let place = place();
    for line in ["sweep small.toml", "material show pmma"] {
        let said = place.done(line).stdout;
        assert!(
            said.lines().all(|line| line.chars().count() <= 80),
            "{said}"
        );
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let place = place();
    let results = ["1", "2", "3"].map(|threads| {
        let run = format!("sweep small.toml --quiet --threads {threads} --out {threads}");
        let run = place.done(&run);
        assert_eq!(run.stdout + &run.stderr, "");
        ["sweep.csv", "summary.json", "energy-loss.png"]
            .map(|name| place.bytes(&format!("{threads}/{name}")))
    });
    assert_eq!(results[0], results[1]);
    assert_eq!(results[0], results[2]);
}

#[test]
fn the_resolved_sweep_is_a_sweep_file_with_the_same_results() {
    let place = place();
    place.done("sweep small.toml --quiet --no-figures --out first");
    place.done("sweep first/resolved.toml --quiet --no-figures --out second");
    for name in ["resolved.toml", "sweep.csv", "summary.json"] {
        let [first, second] = ["first", "second"].map(|out| place.text(&format!("{out}/{name}")));
        assert_eq!(first, second);
    }
}

#[test]
fn a_fractional_material_becomes_a_series_that_the_resolved_file_holds() {
    let block = "poisson_ratio = 0.4\n[material.fractional]\nmodulus = \"longitudinal\"\nstiffness = \"1 GPa\"\ntime = \"1 s\"\n\
                 exponent = 0.5\nband = [\"1e-3 rad/s\", \"10 rad/s\"]\nmodel = \"zener\"\nequilibrium = \"1 MPa\"\n";
    let text = small().replace("library = \"pmma\"", block);
    let place = Place::with("zener.toml", &text);
    let within = ["fractional Zener model as a series of"];
    place
        .done("sweep zener.toml --no-figures --out out")
        .says(&within);
    let resolved = place.text("out/resolved.toml");
    let measured =
        "measured = [\"0.1 s\", \"1000 s\"]\n\n[material.relaxation]\nmodulus = \"longitudinal\"";
    assert!(resolved.contains(measured), "{resolved}");
    // The modulus at rest is the model's own.
    assert!(
        resolved.contains("equilibrium = \"1000000 Pa\""),
        "{resolved}"
    );
    place.done("material show zener.toml").says(&within);
    let json = place.done("material show zener.toml --format json").json();
    for error in ["error", "loss_error"] {
        let error = json["approximation"][error].as_f64().unwrap();
        assert!(error > 0.0 && error < 1e-3, "{json}");
    }
    // The error of the loss, of which the series has its part, is that of the resolved file too.
    place.done("sweep out/resolved.toml --no-figures --out again");
    assert_eq!(place.text("again/sweep.csv"), place.text("out/sweep.csv"));
    // As the classical solid of one branch where the exponent is one.
    let classical = text.replace("exponent = 0.5", "exponent = 1.0");
    place.swept(&classical);
    let resolved = place.text("out/resolved.toml");
    let branch = "branches = [\n    { modulus = \"1000000000 Pa\", time = \"1 s\" },\n]";
    assert!(resolved.contains(branch), "{resolved}");
}

#[test]
fn segments_beside_a_sweep_are_told_of_both_commands() {
    let segments = r#"segments = [{ kind = "step", to = "10 N", duration = "5 s" }]"#;
    let both = small().replace("mean = \"10 N\"\namplitude = \"5 N\"", segments);
    let place = Place::with("both.toml", &both);
    for command in ["sweep", "simulate"] {
        let told = place.refused(&format!("{command} both.toml"));
        for part in [
            "segments in [drive]",
            "beside a table [sweep]",
            "`contact-dma simulate ",
            "`contact-dma sweep ",
        ] {
            assert!(told.contains(part), "{told}");
        }
        assert!(!told.contains("unknown key"), "{told}");
    }
}

#[test]
fn a_mistake_in_a_flag_is_shown_in_the_flag() {
    let told = place().refused("sweep small.toml --set 'indenter.radius=5 N'");
    assert!(
        told.contains("--set indenter.radius=5 N") && told.contains("a length"),
        "{told}"
    );
}

#[test]
fn a_key_set_by_flag_changes_the_sweep() {
    let place = place();
    place.done("sweep small.toml --quiet --set 'indenter.radius=5 mm' --set 'sweep.angular_frequency=[\"0.01 rad/s\"]'");
    let resolved = place.text("reports/small/resolved.toml");
    assert!(resolved.contains("radius = \"0.005 m\""));
}

#[test]
fn an_unreadable_file_and_an_unwritable_folder_say_so() {
    let place = place();
    let told = place.refused("sweep /no/such/file.toml");
    assert!(told.contains("/no/such/file.toml"), "{told}");
    // A file where the folder should be: unwritable even for root.
    let run = place.run("sweep small.toml --out small.toml/out").ended(1);
    assert!(run.stderr.contains("small.toml/out"), "{run:?}");
    assert!(run.stderr.contains("cannot create the folder"), "{run:?}");
}

#[test]
fn results_of_another_sweep_are_replaced_only_when_asked() {
    let place = place();
    let sweep = "sweep small.toml --quiet --no-figures";
    let other = format!("{sweep} --set sweep.angular_frequency=[0.01]");
    place.done(sweep);
    let table = || place.bytes("reports/small/sweep.csv");
    let before = table();
    assert!(place.refused(&other).contains("--force"));
    assert_eq!(table(), before);
    place.done(sweep);
    assert_eq!(table(), before);
    place.done(&format!("{other} --force"));
    assert_ne!(table(), before);
    let records = fs::read_dir(place.path("reports/small/records")).unwrap();
    assert_eq!(
        records.count(),
        1,
        "records of the other sweep are still there"
    );
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
    assert!(!place.has("reports/small/loops/2.csv") && place.has("reports/small/loops/1.csv"));
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
    assert!(!place.has("reports/small/energy-loss.svg"));
}

#[test]
fn an_interrupted_sweep_keeps_what_is_finished() {
    // One quick case and slow ones: with one thread the dearest (highest frequency) comes first, so that order is forced
    // by cost, not by luck.
    let range = "{ from = \"1e-4 rad/s\", to = \"2e-4 rad/s\", points = 400 }";
    let slow = small()
        .replace(FREQUENCIES, range)
        .replace("steps = 50", "steps = 2000");
    let place = Place::with("slow.toml", &slow);
    let out = place.path("out");
    let child = Process::new(assert_cmd::cargo::cargo_bin("contact-dma"))
        .current_dir(place.path(""))
        .args(["sweep", "slow.toml", "--threads", "1", "--out", "out"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let started = Instant::now();
    while segments::count(&out) < 2 {
        assert!(
            started.elapsed() < Duration::from_secs(60),
            "no case was finished"
        );
        std::thread::sleep(Duration::from_millis(5));
    }
    let kill = Process::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    // Drains the pipes, so that the child cannot block on them.
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    let stdout = String::from_utf8(output.stdout).unwrap();
    assert!(stdout.contains("Interrupted"), "{stdout}");
    let rows = place.table("out/sweep.csv").len();
    assert_eq!(rows, segments::count(&out));
    assert!(rows < 400);
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
    let told = place.refused("material show pmmma");
    assert!(told.contains("did you mean \"pmma\""), "{told}");
}

#[test]
fn a_material_is_drawn_into_a_folder() {
    let place = Place::new();
    place.done("material show pmma --out out");
    for name in [
        "moduli.svg",
        "moduli.png",
        "moduli.csv",
        "relaxation.svg",
        "relaxation@2x.png",
    ] {
        assert!(place.has(&format!("out/{name}")), "{name}");
    }
    // Figure 1 of the paper: from 2491.44 MPa down to 1973.05 at 1000 s.
    let curve = place.table("out/relaxation.csv").rows;
    let number = |cell: &String| cell.parse::<f64>().unwrap();
    let (first, last) = (&curve[0], &curve[curve.len() - 1]);
    assert_eq!(number(&last[0]), 1000.0);
    assert!((number(&first[1]) / 2491.4388e6 - 1.0).abs() < 1e-9);
    assert!((number(&last[1]) / 1973.05e6 - 1.0).abs() < 5e-6);
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
        let ended = command
            .args(arguments)
            .stdout(full.unwrap())
            .output()
            .unwrap();
        assert_eq!(ended.status.code(), Some(1), "{arguments:?}");
        assert!(String::from_utf8_lossy(&ended.stderr).contains("No space left"));
    }
    place.done("sweep --help").says(&["Examples:", "--set"]);
    for shell in ["bash", "zsh", "fish"] {
        place
            .done(&format!("completions {shell}"))
            .says(&["contact-dma"]);
    }
    place.refused("sweep");
    place.refused("sweep x.toml --threads 0");
}

#[test]
fn a_sweep_file_may_come_from_standard_input() {
    let creep = "Time [min];D [1/MPa];Creep compliance [1/MPa]\n0,1;1;1,0e0\n1;2;1,1\n10;3;1,5\n100;4;1,6\n";
    let place = Place::with("creep.csv", creep);
    let table = "[material]\npoisson_ratio = 0.4\n[material.table]\nfile = \"creep.csv\"\nquantity = \"creep\"\nmodulus = \"shear\"";
    let text = small().replace("[material]\nlibrary = \"pmma\"", table);
    let run = |line: &str, text: &str| place.run_on(line, text);
    run("plan -", &text)
        .ended(0)
        .says(&["3 cases on 100 springs"]);
    run("material show -", &text).ended(0);
    run("sweep - --quiet --no-figures", &text).ended(0);
    assert!(place.has("reports/stdin/sweep.csv"));
    run("sweep - --quiet --out there", &small()).ended(0);
    assert!(place.has("there/energy-loss.svg"));
    let told = run("sweep -", &small().replace("radius", "raduis"))
        .ended(2)
        .stderr;
    assert!(
        told.contains("--> standard input:") && told.contains("`radius`"),
        "{told}"
    );
    let told = run("simulate -", &small()).ended(2).stderr;
    assert!(told.contains("a sweep"), "{told}");
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
    for name in ["index.html", "energy-loss.svg", "loops.csv"] {
        assert!(
            !place.has(&format!("source/{name}")),
            "{name} is of an earlier run"
        );
    }
    let table = place.path("source/sweep.csv");
    let modified = || fs::metadata(&table).unwrap().modified().unwrap();
    let (before, written) = (names("source"), modified());
    let report = "report source --quiet --out drawn";
    place.done(&format!("{report} --set 'figures.formats=[\"svg\"]'"));
    assert_eq!((names("source"), modified()), (before, written));
    assert!(place.has("drawn/index.html") && place.has("drawn/energy-loss.svg"));
    assert!(!place.has("drawn/energy-loss.png") && !place.has("drawn/records"));
    let is_same = || place.bytes("drawn/sweep.csv") == place.bytes("source/sweep.csv");
    assert!(is_same());
    let resolved = place.text("drawn/resolved.toml");
    assert!(resolved.contains("formats = [\"svg\"]"), "{resolved}");
    // Of another sweep nothing is replaced unasked.
    let other = "sweep small.toml --quiet --no-figures --out drawn --set cycle.steps=40";
    place.refused(other);
    place.done(&format!("{other} --force"));
    assert!(place.refused(report).contains("--force"));
    place.done(&format!("{report} --force"));
    assert!(is_same());
}

#[test]
fn a_file_in_place_of_a_folder_is_told_before_anything_is_computed() {
    let place = place();
    for command in [
        "sweep small.toml",
        "simulate small.toml",
        "report x",
        "merge x",
        "compare x y",
        "reproduce",
        "material show pmma",
    ] {
        let told = place.refused(&format!("{command} --out small.toml"));
        assert!(told.contains("this is a file; name a folder"), "{told}");
    }
}

#[test]
fn a_narrow_terminal_gets_narrow_tables() {
    let place = place();
    for (line, columns) in [
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
            assert!(
                line.chars().count() <= columns || is_one_word,
                "{line}\n{text}"
            );
        }
        assert!(
            line.starts_with("material") || text.contains("left out in"),
            "{text}"
        );
    }
}

#[test]
fn a_large_number_is_printed_with_an_exponent() {
    let text = place()
        .done("plan small.toml --set 'drive.mean=1e30 N'")
        .stdout;
    assert!(
        text.contains("1e30") && !words(&text).contains("000000000"),
        "{text}"
    );
}
