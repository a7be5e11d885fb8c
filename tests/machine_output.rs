//! What other programs read: JSON on standard output and nothing else, and no colours where no person looks.

#![cfg(feature = "cli")]

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
