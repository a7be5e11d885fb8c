//! What other programs read: JSON on standard output and nothing else, and no colours where no person looks.

#[path = "common/program.rs"]
mod program;

use program::{pmma_sweep, program, write};
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
