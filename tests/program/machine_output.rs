//! What other programs read: JSON on standard output and nothing else, and no colours where no person looks.

#![cfg(feature = "cli")]

use crate::program::{pmma_sweep, program, write};
use serde_json::Value;
use tempfile::TempDir;

const THREE: &str = r#"[sweep]
angular_frequency = ["0.004 rad/s", "0.008 rad/s", "0.02 rad/s"]
"#;

#[test]
fn json_holds_the_summary_and_every_column_of_every_case() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "small.toml", &pmma_sweep(THREE));
    let out = folder.path().join("out");
    for quiet in [None, Some("--quiet")] {
        let mut command = program();
        command
            .args(["sweep", &file, "--format", "json", "--out"])
            .arg(&out)
            .args(quiet);
        let assert = command.assert().success();
        let printed: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
        let summary = std::fs::read(out.join("summary.json")).unwrap();
        assert_eq!(
            printed["summary"],
            serde_json::from_slice::<Value>(&summary).unwrap()
        );
        let mut table = csv::Reader::from_path(out.join("sweep.csv")).unwrap();
        let columns = table.headers().unwrap().clone();
        let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
        let cases = printed["cases"].as_array().unwrap();
        assert_eq!(cases.len(), rows.len());
        for (case, row) in cases.iter().zip(&rows) {
            assert_eq!(case.as_object().unwrap().len(), columns.len());
            for (column, cell) in columns.iter().zip(row) {
                match &case[column] {
                    Value::Null => assert_eq!(cell, ""),
                    Value::String(text) => assert_eq!(text, cell),
                    // Bit for bit.
                    number => assert_eq!(number.as_f64().unwrap(), cell.parse::<f64>().unwrap()),
                }
            }
        }
    }
}

/// Runs the program in a folder and reads what it prints as JSON; exit codes may be those of a command that did its work.
fn json(folder: &TempDir, arguments: &[&str]) -> Value {
    let output = program()
        .current_dir(folder.path())
        .args(arguments)
        .args(["--format", "json"])
        .env("COLUMNS", "40")
        .output()
        .unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {stderr}");
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(value.is_object());
    value
}

#[test]
fn every_command_that_finds_something_prints_it_as_one_object() {
    let folder = TempDir::new().unwrap();
    let file = &write(&folder, "small.toml", &pmma_sweep(THREE));
    let plan = json(&folder, &["plan", file]);
    assert_eq!(plan["cases"].as_array().unwrap().len(), 3);
    assert_eq!(plan["cases"][1]["angular_frequency_rad_per_s"], 0.008);
    assert!(plan["time_on_one_thread_s"].as_f64().unwrap() > 0.0 && plan["cells"].is_null());
    assert_eq!(
        json(&folder, &["sweep", file, "--dry-run"])["springs"],
        plan["springs"]
    );
    let sweep = json(&folder, &["sweep", file, "--no-figures", "--out", "a"]);
    assert_eq!(json(&folder, &["report", "a"]), sweep);
    for (shard, out) in [("1/2", "b"), ("2/2", "c")] {
        let part = json(&folder, &["sweep", file, "--shard", shard, "--out", out]);
        assert_eq!(part["shard"], shard);
        assert_eq!(part["cases_done"], part["cases_of_shard"]);
    }
    assert_eq!(json(&folder, &["merge", "b", "c", "--out", "d"]), sweep);
    let comparison = json(&folder, &["compare", "a", "d"]);
    assert_eq!(
        (&comparison["differs"], &comparison["compared"]),
        (&false.into(), &3.into())
    );
    let columns = comparison["columns"].as_array().unwrap();
    let loss = columns
        .iter()
        .find(|c| c["name"] == "energy_loss_j")
        .unwrap();
    assert!(loss["largest"].is_null());
    let scenario = pmma_sweep("").replace(
        "mean = \"10 N\"\namplitude = \"5 N\"",
        "segments = [{ kind = \"ramp\", to = 1, duration = 1 }]",
    );
    let scenario = &write(
        &folder,
        "ramp.toml",
        &format!("{scenario}[solver]\nsprings = 50\n"),
    );
    let dry = json(&folder, &["simulate", scenario, "--dry-run"]);
    let history = json(&folder, &["simulate", scenario, "--no-figures"]);
    let rows = history["history"].as_array().unwrap();
    assert_eq!(rows.len(), dry["time_steps"].as_u64().unwrap() as usize);
    assert_eq!(rows.last().unwrap()["load_n"], 1.0);
    assert_eq!(history["summary"]["title"], "PMMA under a sphere");
    assert!(!folder.path().join("reports/ramp/index.html").exists());
}

#[test]
fn materials_are_printed_as_objects_too() {
    let folder = TempDir::new().unwrap();
    let list = json(&folder, &["material", "list"]);
    let names = list["materials"].as_array().unwrap();
    assert!(names.iter().any(|material| material["name"] == "pmma"));
    let shown = json(&folder, &["material", "show", "pmma"]);
    assert_eq!(shown["relaxation"]["equilibrium_pa"], 1.973e9);
    assert!(shown["peaks"]["loss_modulus"][0]["value"].as_f64().unwrap() > 1e7);
    assert!(shown["fit"].is_null());
    let branches = shown["creep"]["branches"].as_array().unwrap();
    let first = shown["creep"]["instantaneous_per_pa"].as_f64().unwrap();
    let rows = (0..40).map(|k| {
        let time_s = 10_f64.powf(f64::from(k) / 10.0 - 1.0);
        let creep = branches.iter().map(|branch| {
            let of = |key: &str| branch[key].as_f64().unwrap();
            of("compliance_per_pa") * -(-time_s / of("time_s")).exp_m1()
        });
        format!("{time_s},{}\n", first + creep.sum::<f64>())
    });
    let table = format!(
        "time_s,creep_compliance_per_pa\n{}",
        rows.collect::<String>()
    );
    write(&folder, "creep.csv", &table);
    let arguments =
        "material fit creep.csv --quantity creep --modulus longitudinal --poisson-ratio 0.38";
    let fit = json(&folder, &arguments.split(' ').collect::<Vec<_>>());
    assert_eq!(fit["fit"]["samples"], 40);
    assert!(fit["fit"]["relative_misfit"]["rms"].as_f64().unwrap() < 1e-3);
    let block = fit["material_toml"].as_str().unwrap();
    assert!(block.contains("[material.creep]"), "{block}");
}

/// What a sweep of PMMA around its peak leaves in this folder, and what it prints; frequencies as given.
fn swept(folder: &TempDir, name: &str, frequencies: &str) -> (std::path::PathBuf, String) {
    let file = write(folder, &format!("{name}.toml"), &pmma_sweep(frequencies));
    let out = folder.path().join(name);
    let mut command = program();
    let run = command.args(["sweep", &file, "--quiet", "--out"]).arg(&out);
    let run = run.env("COLUMNS", "200").assert().success();
    let printed = String::from_utf8(run.get_output().stdout.clone()).unwrap();
    (out, printed)
}

#[test]
fn the_unit_of_the_frequencies_asked_for_comes_first_in_every_output() {
    let folder = TempDir::new().unwrap();
    let hz = "[sweep]\nfrequency = [\"0.001 Hz\", \"0.0013 Hz\", \"0.003 Hz\"]\n";
    let (in_hz, _) = swept(&folder, "hz", hz);
    let read = |out: &std::path::Path, name: &str| {
        std::fs::read_to_string(out.join(name)).unwrap_or_else(|why| panic!("{name}: {why}"))
    };
    let table = read(&in_hz, "sweep.csv");
    let mut rows = table.lines();
    let columns = rows.next().unwrap();
    assert!(columns.starts_with("frequency_hz,angular_frequency_rad_per_s,drive_mean,"));
    assert!(rows.next().unwrap().starts_with("1e-3,6.283"), "{table}");
    for name in ["energy-loss", "loops", "dissipation", "moduli", "cole-cole"] {
        let data = read(&in_hz, &format!("{name}.csv"));
        let columns = data.lines().next().unwrap();
        assert!(
            columns.contains("frequency_hz,angular_frequency_rad_per_s"),
            "{columns}"
        );
    }
    let caption = read(&in_hz, "energy-loss.caption.txt");
    assert!(caption.contains("over frequency f: "), "{caption}");
    assert!(
        caption.contains("at f = (1.3") && caption.contains(" × 10⁻³ Hz"),
        "{caption}"
    );
    assert!(!caption.contains("rad/s"), "{caption}");
    let page = read(&in_hz, "index.html");
    assert!(page.contains("<th scope=\"col\" data-column=\"frequency_hz\">f / Hz</th>"));
    assert!(!page.contains("rad/s</strong>") && page.contains("Hz</strong>"));
    // The file with every default keeps the unit, and is the same sweep as in rad/s.
    let resolved = read(&in_hz, "resolved.toml");
    assert!(resolved.contains("frequency_unit = \"Hz\""), "{resolved}");
    let angular = resolved.replace("frequency_unit = \"Hz\"", "");
    let angular_file = write(&folder, "angular.toml", &angular);
    let resumed = program()
        .args(["sweep", &angular_file, "--quiet", "--out"])
        .arg(&in_hz)
        .assert()
        .success();
    let said = String::from_utf8_lossy(&resumed.get_output().stderr).into_owned();
    let table = read(&in_hz, "sweep.csv");
    assert!(
        table.starts_with("angular_frequency_rad_per_s,frequency_hz,"),
        "{said}{table}"
    );
    let mut report = program();
    let report = report.args(["report", "--quiet", "--set", "figures.frequency_unit=Hz"]);
    report.arg(&in_hz).assert().success();
    assert!(read(&in_hz, "sweep.csv").starts_with("frequency_hz,"));
}

#[test]
fn nothing_that_is_piped_or_asked_to_be_plain_is_coloured() {
    let folder = TempDir::new().unwrap();
    let good = write(&folder, "small.toml", &pmma_sweep(THREE));
    let bad = write(
        &folder,
        "bad.toml",
        &pmma_sweep(THREE).replace("radius", "raduis"),
    );
    for file in [good, bad] {
        for no_color in [None, Some("1")] {
            let mut command = program();
            command
                .args(["sweep", &file, "--out"])
                .arg(folder.path().join("out"));
            command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
            command.envs(no_color.map(|value| ("NO_COLOR", value)));
            let output = command.output().unwrap();
            assert!(!output.stdout.contains(&0x1b) && !output.stderr.contains(&0x1b));
        }
    }
}
