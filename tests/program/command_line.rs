//! The program as a user meets it: output, messages, exit codes, files.

#![cfg(feature = "cli")]

use crate::program::{program, write};
use crate::segments;
use std::fs;
use std::path::Path;
use std::process::{Command as Process, Stdio};
use std::time::{Duration, Instant};

use predicates::prelude::*;
use predicates::str::contains;
use tempfile::TempDir;

/// A sweep of three frequencies that takes a moment.
const SMALL: &str = r#"title = "small"

[material]
library = "pmma"

[indenter]
shape = "sphere"
radius = "10 mm"

[drive]
mean = "10 N"
amplitude = "5 N"

[sweep]
angular_frequency = ["0.004 rad/s", "0.008 rad/s", "0.02 rad/s"]

[cycle]
steps = 50

[solver]
springs = 100
"#;

#[test]
fn a_sweep_prints_its_table_and_leaves_every_file() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", SMALL);
    program()
        .current_dir(folder.path())
        .args(["sweep", &file])
        .assert()
        .success()
        .stdout(contains("loss / cycle").and(contains("converged")))
        .stdout(contains("Peak: ").and(contains("at ω = (8.4")))
        .stdout(contains("Results in reports/small"));
    let out = folder.path().join("reports/small");
    for name in [
        "sweep.csv",
        "summary.json",
        "resolved.toml",
        "energy-loss.csv",
        "energy-loss.svg",
        "energy-loss.png",
        "energy-loss@2x.png",
        "loops.csv",
        "loops.svg",
        "loops.png",
        "loops@2x.png",
        "loops/0.csv",
        "loops/2.csv",
        "pressures/1.csv",
        "work/1.csv",
        "cycles.npz",
    ] {
        assert!(out.join(name).is_file(), "{name} is missing");
    }
    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    let rows: Vec<_> = csv::Reader::from_reader(table.as_bytes())
        .into_deserialize::<std::collections::HashMap<String, String>>()
        .map(|row| row.unwrap())
        .collect();
    assert_eq!(rows.len(), 3);
    assert_eq!(rows[1]["status"], "converged");
    let loss: f64 = rows[1]["energy_loss_j"].parse().unwrap();
    let error: f64 = rows[1]["energy_loss_error_j"].parse().unwrap();
    assert!(error > 0.0 && error < 0.01 * loss);
    assert!((loss / 3.5e-6 - 1.0).abs() < 0.01);
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    let peak = &summary["peaks"][0];
    let omega = peak["angular_frequency_rad_per_s"].as_f64().unwrap();
    assert!((omega / 0.00844 - 1.0).abs() < 2e-3);
    assert_eq!(summary["cases"]["converged"], 3);
}

#[test]
fn the_printed_table_fits_eighty_columns() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", SMALL);
    let output = program()
        .current_dir(folder.path())
        .args(["sweep", &file])
        .output()
        .unwrap();
    let show = program()
        .args(["material", "show", "pmma"])
        .output()
        .unwrap();
    for text in [output.stdout, show.stdout] {
        for line in String::from_utf8(text).unwrap().lines() {
            assert!(line.chars().count() <= 80, "{line}");
        }
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", SMALL);
    let results: Vec<Vec<u8>> = ["1", "2", "3"]
        .into_iter()
        .map(|threads| {
            let out = folder.path().join(threads);
            program()
                .args(["sweep", &file, "--quiet", "--threads", threads, "--out"])
                .arg(&out)
                .assert()
                .success()
                .stdout("")
                .stderr("");
            [
                fs::read(out.join("sweep.csv")).unwrap(),
                fs::read(out.join("summary.json")).unwrap(),
                fs::read(out.join("energy-loss.png")).unwrap(),
            ]
            .concat()
        })
        .collect();
    assert_eq!(results[0], results[1]);
    assert_eq!(results[0], results[2]);
}

#[test]
fn the_resolved_sweep_is_a_sweep_file_with_the_same_results() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", SMALL);
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    let sweep = |file: &Path, out: &Path| {
        let mut command = program();
        command
            .arg("sweep")
            .arg(file)
            .args(["--quiet", "--no-figures", "--out"])
            .arg(out);
        command.assert().success();
    };
    sweep(Path::new(&file), &first);
    sweep(&first.join("resolved.toml"), &second);
    for name in ["resolved.toml", "sweep.csv", "summary.json"] {
        let read = |folder: &Path| fs::read_to_string(folder.join(name)).unwrap();
        assert_eq!(read(&first), read(&second));
    }
}

/// A fractional material over four decades; the keys of its model alone are left to say.
fn fractional(model: &str) -> String {
    format!(
        "poisson_ratio = 0.4\n[material.fractional]\nmodulus = \"longitudinal\"\nstiffness = \"1 GPa\"\ntime = \"1 s\"\n\
         exponent = 0.5\nband = [\"1e-3 rad/s\", \"10 rad/s\"]\nmodel = {model}\n"
    )
}

#[test]
fn a_fractional_material_becomes_a_series_that_the_resolved_file_holds() {
    let folder = TempDir::new().unwrap();
    let block = fractional("\"zener\"\nequilibrium = \"1 MPa\"");
    let text = SMALL.replace("library = \"pmma\"", &block);
    let file = write(&folder, "zener.toml", &text);
    let out = folder.path().join("out");
    let sweep = ["sweep", &file, "--no-figures", "--out"];
    let printed = program().args(sweep).arg(&out).assert().success();
    let within = "fractional Zener model as a series of";
    printed.stdout(contains(within));
    let resolved = fs::read_to_string(out.join("resolved.toml")).unwrap();
    let measured =
        "measured = [\"0.1 s\", \"1000 s\"]\n\n[material.relaxation]\nmodulus = \"longitudinal\"";
    assert!(resolved.contains(measured), "{resolved}");
    // The modulus at rest is the model's own.
    assert!(
        resolved.contains("equilibrium = \"1000000 Pa\""),
        "{resolved}"
    );
    let show = ["material", "show", &file];
    program()
        .args(show)
        .assert()
        .success()
        .stdout(contains(within));
    let json = program().args(show).args(["--format", "json"]).assert();
    let json: serde_json::Value = serde_json::from_slice(&json.get_output().stdout).unwrap();
    for error in ["error", "loss_error"] {
        let error = json["approximation"][error].as_f64().unwrap();
        assert!(error > 0.0 && error < 1e-3, "{json}");
    }
    // The error of the loss, of which the series has its part, is that of the resolved file too.
    let table = |out: &Path| fs::read_to_string(out.join("sweep.csv")).unwrap();
    let again = folder.path().join("again");
    let resolved = out.join("resolved.toml");
    let sweep = ["sweep", resolved.to_str().unwrap(), "--no-figures", "--out"];
    program().args(sweep).arg(&again).assert().success();
    assert_eq!(table(&again), table(&out));
    // As the classical solid of one branch where the exponent is one.
    let classical = text.replace("exponent = 0.5", "exponent = 1.0");
    let classical = write(&folder, "classical.toml", &classical);
    let out = folder.path().join("classical");
    let plan = ["sweep", &classical, "--no-figures", "--out"];
    program().args(plan).arg(&out).assert().success();
    let resolved = fs::read_to_string(out.join("resolved.toml")).unwrap();
    let branch = "branches = [\n    { modulus = \"1000000000 Pa\", time = \"1 s\" },\n]";
    assert!(resolved.contains(branch), "{resolved}");
}

#[test]
fn segments_beside_a_sweep_are_told_of_both_commands() {
    let folder = TempDir::new().unwrap();
    let segments = r#"segments = [{ kind = "step", to = "10 N", duration = "5 s" }]"#;
    let both = SMALL.replace("mean = \"10 N\"\namplitude = \"5 N\"", segments);
    let file = write(&folder, "both.toml", &both);
    for command in ["sweep", "simulate"] {
        program()
            .args([command, &file])
            .assert()
            .code(2)
            .stdout("")
            .stderr(contains("segments in [drive]").and(contains("beside a table [sweep]")))
            .stderr(contains("`contact-dma simulate ").and(contains("`contact-dma sweep ")))
            .stderr(contains("unknown key").not());
    }
}

#[test]
fn a_mistake_in_a_flag_is_shown_in_the_flag() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", SMALL);
    program()
        .args(["sweep", &file, "--set", "indenter.radius=5 N"])
        .assert()
        .code(2)
        .stderr(contains("--set indenter.radius=5 N").and(contains("a length")));
}

#[test]
fn a_key_set_by_flag_changes_the_sweep() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", SMALL);
    program()
        .current_dir(folder.path())
        .args(["sweep", &file, "--quiet", "--set", "indenter.radius=5 mm"])
        .args(["--set", "sweep.angular_frequency=[\"0.01 rad/s\"]"])
        .assert()
        .success();
    let resolved = fs::read_to_string(folder.path().join("reports/small/resolved.toml")).unwrap();
    assert!(resolved.contains("radius = \"0.005 m\""));
}

#[test]
fn an_unreadable_file_and_an_unwritable_folder_say_so() {
    let folder = TempDir::new().unwrap();
    program()
        .args(["sweep", "/no/such/file.toml"])
        .assert()
        .code(2)
        .stderr(contains("/no/such/file.toml"));
    let file = write(&folder, "small.toml", SMALL);
    // A file where the folder should be: unwritable even for root.
    program()
        .args(["sweep", &file, "--out"])
        .arg(folder.path().join("small.toml/out"))
        .assert()
        .code(1)
        .stderr(contains("small.toml/out").and(contains("cannot create the folder")));
}

#[test]
fn results_of_another_sweep_are_replaced_only_when_asked() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", SMALL);
    let sweep = |flags: &[&str]| {
        let mut command = program();
        command
            .current_dir(folder.path())
            .args(["sweep", &file, "--quiet", "--no-figures"]);
        command.args(flags).assert()
    };
    sweep(&[]).success();
    let table = folder.path().join("reports/small/sweep.csv");
    let before = fs::read(&table).unwrap();
    let other = ["--set", "sweep.angular_frequency=[0.01]"];
    sweep(&other).code(2).stderr(contains("--force"));
    assert_eq!(fs::read(&table).unwrap(), before);
    sweep(&[]).success();
    assert_eq!(fs::read(&table).unwrap(), before);
    sweep(&[&other[..], &["--force"]].concat()).success();
    assert_ne!(fs::read(&table).unwrap(), before);
    let records = fs::read_dir(folder.path().join("reports/small/records")).unwrap();
    assert_eq!(
        records.count(),
        1,
        "records of the other sweep are still there"
    );
}

#[test]
fn a_case_that_does_not_converge_has_no_loss_and_does_not_stop_the_others() {
    let folder = TempDir::new().unwrap();
    let file = write(
        &folder,
        "small.toml",
        &SMALL.replace(
            "steps = 50",
            "steps = 50\nmethod = \"march\"\nmax_cycles = 4",
        ),
    );
    program()
        .current_dir(folder.path())
        .args([
            "sweep",
            &file,
            "--set",
            "sweep.angular_frequency=[0.002, 0.004, 1.0]",
        ])
        .assert()
        .code(3)
        .stdout(contains("not-converged").and(contains("estimated distance")));
    let out = folder.path().join("reports/small");
    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    let last = table.lines().last().unwrap();
    assert!(last.starts_with("1e0,") && last.contains(",,"), "{last}");
    assert!(last.contains("not-converged"));
    assert!(!out.join("loops/2.csv").exists());
    assert!(out.join("loops/1.csv").exists());
}

#[test]
fn a_narrow_terminal_still_says_which_case_has_no_result() {
    let folder = TempDir::new().unwrap();
    let march = "steps = 50\nmethod = \"march\"\nmax_cycles = 4";
    let file = write(&folder, "small.toml", &SMALL.replace("steps = 50", march));
    let set = "sweep.angular_frequency=[0.002, 0.004, 1.0]";
    for (columns, left_out) in [
        (80, ""),
        (60, "left out in 60 columns: phase / deg, cycles"),
        (40, "left out in 40 columns: loss / cycle,"),
    ] {
        let mut run = program();
        run.current_dir(folder.path())
            .env("COLUMNS", columns.to_string());
        let run = run.args(["sweep", &file, "--set", set, "--no-figures"]);
        let output = run.assert().code(3).get_output().stdout.clone();
        let text = String::from_utf8(output).unwrap();
        let table: Vec<&str> = text.split("\n\n").nth(1).unwrap().lines().collect();
        assert!(table[0].ends_with("status"), "{text}");
        assert!(table[1].ends_with("converged") && table[1].trim().starts_with("2.000e-3"));
        assert!(table[3].ends_with("not-converged") && table[3].trim().starts_with("1.000"));
        assert!(text.contains(left_out), "{text}");
        assert_eq!(text.contains("left out"), columns < 80);
    }
}

#[test]
fn a_sweep_in_which_nothing_converges_still_ends_cleanly() {
    let folder = TempDir::new().unwrap();
    let file = write(
        &folder,
        "small.toml",
        &SMALL.replace("steps = 50", "max_cycles = 1\ntolerance = 1e-12"),
    );
    program()
        .current_dir(folder.path())
        .args(["sweep", &file])
        .assert()
        .code(3)
        .stdout(contains("no case converged"));
    assert!(folder.path().join("reports/small/summary.json").exists());
    assert!(!folder.path().join("reports/small/energy-loss.svg").exists());
}

#[test]
fn an_interrupted_sweep_keeps_what_is_finished() {
    let folder = TempDir::new().unwrap();
    // One quick case and slow ones: with one thread the dearest (highest frequency) comes first, so that order is forced
    // by cost, not by luck.
    let slow = SMALL
        .replace(
            "[\"0.004 rad/s\", \"0.008 rad/s\", \"0.02 rad/s\"]",
            "{ from = \"1e-4 rad/s\", to = \"2e-4 rad/s\", points = 400 }",
        )
        .replace("steps = 50", "steps = 2000");
    let file = write(&folder, "slow.toml", &slow);
    let out = folder.path().join("out");
    let mut child = Process::new(assert_cmd::cargo::cargo_bin("contact-dma"))
        .args(["sweep", &file, "--threads", "1", "--out"])
        .arg(&out)
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
    let sent = Process::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(sent.success());
    // Drain the pipes, so that the child cannot block on them.
    let output = {
        let _ = child.try_wait();
        child.wait_with_output().unwrap()
    };
    assert_eq!(output.status.code(), Some(130));
    let stdout = String::from_utf8(output.stdout).unwrap();
    assert!(stdout.contains("Interrupted"), "{stdout}");
    let finished = segments::count(&out);
    let rows = fs::read_to_string(out.join("sweep.csv"))
        .unwrap()
        .lines()
        .count()
        - 1;
    assert_eq!(rows, finished);
    assert!(rows < 400);
}

#[test]
fn materials_are_listed_and_shown() {
    program()
        .args(["material", "list"])
        .assert()
        .success()
        .stdout(contains("pmma").and(contains("Narasimhan")));
    // Equation (10) of the paper.
    program()
        .args(["material", "show", "PMMA"])
        .assert()
        .success()
        .stdout(
            contains("Φ(t) = 6.9944e-4")
                .and(contains("- 6.1742e-5 exp(-0.100641 t)"))
                .and(contains("- 8.3804e-5 exp(-0.00746991 t)"))
                .and(contains("E(0) = 2491.44 MPa")),
        );
    program()
        .args(["material", "show", "pmmma"])
        .assert()
        .code(2)
        .stderr(contains("did you mean \"pmma\""));
}

#[test]
fn a_material_is_drawn_into_a_folder() {
    let folder = TempDir::new().unwrap();
    program()
        .args(["material", "show", "pmma", "--out"])
        .arg(folder.path())
        .assert()
        .success();
    for name in [
        "moduli.svg",
        "moduli.png",
        "moduli.csv",
        "relaxation.svg",
        "relaxation@2x.png",
    ] {
        assert!(folder.path().join(name).is_file(), "{name}");
    }
    // Figure 1 of the paper: from 2491.44 MPa down to 1973.05 at 1000 s.
    let curve = fs::read_to_string(folder.path().join("relaxation.csv")).unwrap();
    let rows: Vec<Vec<f64>> = curve
        .lines()
        .skip(1)
        .map(|l| l.split(',').map(|c| c.parse().unwrap()).collect())
        .collect();
    let (first, last) = (&rows[0], &rows[rows.len() - 1]);
    assert_eq!(last[0], 1000.0);
    assert!((first[1] / 2491.4388e6 - 1.0).abs() < 1e-9);
    assert!((last[1] / 1973.05e6 - 1.0).abs() < 5e-6);
}

#[test]
fn a_material_that_is_refused_for_contact_can_still_be_looked_at() {
    let folder = TempDir::new().unwrap();
    let file = write(
        &folder,
        "kelvin.toml",
        "[material]\npoisson_ratio = 0.4\n[material.kelvin_voigt]\nspring = \"1 MPa\"\ntime = \"2 s\"\n",
    );
    program()
        .args(["material", "show", &file, "--out"])
        .arg(folder.path().join("figures"))
        .assert()
        .success()
        .stdout(contains("none: without an instantaneous compliance"));
}

#[test]
fn help_has_examples_and_completions_are_made() {
    #[cfg(target_os = "linux")]
    for arguments in [&["--help"][..], &["material", "list"]] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full");
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("contact-dma"));
        let ended = command
            .args(arguments)
            .stdout(full.unwrap())
            .output()
            .unwrap();
        assert_eq!(ended.status.code(), Some(1), "{arguments:?}");
        assert!(contains("No space left").eval(&String::from_utf8_lossy(&ended.stderr)));
    }
    program()
        .args(["sweep", "--help"])
        .assert()
        .success()
        .stdout(contains("Examples:").and(contains("--set")));
    for shell in ["bash", "zsh", "fish"] {
        program()
            .args(["completions", shell])
            .assert()
            .success()
            .stdout(contains("contact-dma"));
    }
    program().args(["sweep"]).assert().code(2);
    program()
        .args(["sweep", "x.toml", "--threads", "0"])
        .assert()
        .code(2);
}

#[test]
fn a_sweep_file_may_come_from_standard_input() {
    let folder = TempDir::new().unwrap();
    write(&folder, "creep.csv", CREEP);
    let table = "[material]\npoisson_ratio = 0.4\n[material.table]\nfile = \"creep.csv\"\nquantity = \"creep\"\nmodulus = \"shear\"";
    let text = SMALL.replace("[material]\nlibrary = \"pmma\"", table);
    let run = |arguments: &[&str], text: &str| {
        let mut command = program();
        command.current_dir(folder.path()).args(arguments);
        command.write_stdin(text).assert()
    };
    run(&["plan", "-"], &text)
        .success()
        .stdout(contains("3 cases on 100 springs"));
    run(&["material", "show", "-"], &text).success();
    run(&["sweep", "-", "--quiet", "--no-figures"], &text).success();
    assert!(folder.path().join("reports/stdin/sweep.csv").is_file());
    run(&["sweep", "-", "--quiet", "--out", "there"], SMALL).success();
    assert!(folder.path().join("there/energy-loss.svg").is_file());
    run(&["sweep", "-"], &SMALL.replace("radius", "raduis"))
        .code(2)
        .stderr(contains("--> standard input:").and(contains("`radius`")));
    run(&["simulate", "-"], SMALL)
        .code(2)
        .stderr(contains("a sweep"));
}

const CREEP: &str =
    "Time [min];D [1/MPa];Creep compliance [1/MPa]\n0,1;1;1,0e0\n1;2;1,1\n10;3;1,5\n100;4;1,6\n";

#[test]
fn tables_alone_are_written_where_no_figures_are_asked_for_and_drawn_elsewhere_later() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", SMALL);
    let source = folder.path().join("source");
    let run = |arguments: &[&str]| {
        let mut command = program();
        command.current_dir(folder.path()).args(arguments);
        command.assert()
    };
    let names = |folder: &Path| {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let sweep = ["sweep", &file, "--quiet", "--out", "source"];
    run(&sweep).success();
    assert!(source.join("index.html").is_file());
    run(&[&sweep[..], &["--no-figures"]].concat()).success();
    for name in ["index.html", "energy-loss.svg", "loops.csv"] {
        assert!(!source.join(name).exists(), "{name} is of an earlier run");
    }
    assert!(source.join("sweep.csv").is_file());
    let modified = |name: &str| fs::metadata(source.join(name)).unwrap().modified().unwrap();
    let (before, written) = (names(&source), modified("sweep.csv"));
    run(&[
        "report",
        "source",
        "--quiet",
        "--out",
        "drawn",
        "--set",
        "figures.formats=['svg']",
    ])
    .success();
    assert_eq!((names(&source), modified("sweep.csv")), (before, written));
    let drawn = folder.path().join("drawn");
    assert!(drawn.join("index.html").is_file() && drawn.join("energy-loss.svg").is_file());
    assert!(!drawn.join("energy-loss.png").exists() && !drawn.join("records").exists());
    let table = |folder: &Path| fs::read(folder.join("sweep.csv")).unwrap();
    assert_eq!(table(&drawn), table(&source));
    let resolved = fs::read_to_string(drawn.join("resolved.toml")).unwrap();
    assert!(resolved.contains("formats = [\"svg\"]"), "{resolved}");
    // Of another sweep nothing is replaced unasked.
    let other = [
        "sweep",
        &file,
        "--quiet",
        "--no-figures",
        "--out",
        "drawn",
        "--set",
        "cycle.steps=40",
    ];
    run(&other).code(2);
    run(&[&other[..], &["--force"]].concat()).success();
    run(&["report", "source", "--quiet", "--out", "drawn"])
        .code(2)
        .stderr(contains("--force"));
    run(&["report", "source", "--quiet", "--out", "drawn", "--force"]).success();
    assert_eq!(table(&drawn), table(&source));
}

#[test]
fn a_file_in_place_of_a_folder_is_told_before_anything_is_computed() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", SMALL);
    for arguments in [
        &["sweep", &file][..],
        &["simulate", &file],
        &["report", "x"],
        &["merge", "x"],
        &["compare", "x", "y"],
        &["reproduce"],
        &["material", "show", "pmma"],
    ] {
        program()
            .args(arguments)
            .args(["--out", &file])
            .assert()
            .code(2)
            .stderr(contains("this is a file; name a folder"));
    }
}

#[test]
fn a_narrow_terminal_gets_narrow_tables() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", SMALL);
    for (arguments, columns) in [
        (&["sweep", &file, "--no-figures"][..], 50),
        (&["plan", &file], 60),
        (&["material", "show", "pmma"], 60),
        (&["material", "list"], 40),
    ] {
        let output = program()
            .current_dir(folder.path())
            .env("COLUMNS", columns.to_string())
            .args(arguments)
            .output()
            .unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success() && !text.is_empty());
        for line in text.lines() {
            // A word that is longer stays whole.
            let is_one_word = line.trim().split(' ').count() == 1;
            assert!(
                line.chars().count() <= columns || is_one_word,
                "{line}\n{text}"
            );
        }
        if arguments[0] != "material" {
            assert!(text.contains("left out in"), "{text}");
        }
    }
}

#[test]
fn a_large_number_is_printed_with_an_exponent() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", SMALL);
    program()
        .args(["plan", &file, "--set", "drive.mean=1e30 N"])
        .assert()
        .success()
        .stdout(contains("1e30").and(contains("000000000").not()));
}
