//! Two results compared: the peak that moved is found, what was not compared is said, and nothing compared is no agreement.

use std::path::Path;
use std::process::Output;

use tempfile::TempDir;

use super::program::program;

/// Sweeps PMMA, with its slower relaxation time as given (s), around its largest peak.
fn swept(folder: &Path, name: &str, time_s: f64) {
    swept_with(folder, name, time_s, &[]);
}

fn swept_with(folder: &Path, name: &str, time_s: f64, more: &[&str]) {
    let text = format!(
        r#"title = "peak"
indenter = {{ shape = "sphere", radius = "10 mm" }}
drive = {{ mean = "10 N", amplitude = "5 N" }}
sweep.angular_frequency = ["5e-3 rad/s", "8e-3 rad/s", "1.2e-2 rad/s"]
cycle = {{ steps = 50, error_bars = false }}
solver.springs = 50
[material]
poisson_ratio = 0.38
[material.relaxation]
modulus = "longitudinal"
equilibrium = "1973 MPa"
branches = [{{ modulus = "254.776 MPa", time = "8.93 s" }}, {{ modulus = "263.6628 MPa", time = "{time_s} s" }}]
"#
    );
    let file = folder.join(format!("{name}.toml"));
    std::fs::write(&file, text).unwrap();
    let mut command = program();
    command.args(["sweep", "--quiet", "--no-figures"]);
    command.args(more).arg("--out");
    command.arg(folder.join(name)).arg(file).assert().success();
}

/// Exit code and what was printed.
fn compared(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let mut command = program();
    command.current_dir(folder).arg("compare").args(arguments);
    let Output { status, stdout, .. } = command.output().unwrap();
    (status.code().unwrap(), String::from_utf8(stdout).unwrap())
}

#[test]
fn a_peak_that_moved_is_found_whatever_is_allowed_of_the_columns() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    // The slower time alone makes the largest peak: it moves by nearly as much.
    for (name, time_s) in [("a", 117.96), ("moved", 118.5), ("hardly", 117.961)] {
        swept(folder, name, time_s);
    }
    let loose = ["--relative", "1"];
    let with = |new: &str, more: &[&str]| {
        let arguments: Vec<&str> = (["a", new].iter().chain(&loose).chain(more))
            .copied()
            .collect();
        compared(folder, &arguments)
    };
    assert_eq!(with("moved", &[]).0, 0);
    for tolerance in ["angular_frequency_rad_per_s=1e-3", "frequency_hz=1e-3"] {
        let (code, text) = with("moved", &["--tolerance", tolerance]);
        assert_eq!(code, 4, "{text}");
        assert!(
            text.contains("moved by -0.") && text.contains(": differs"),
            "{text}"
        );
        assert_eq!(with("hardly", &["--tolerance", tolerance]).0, 0);
    }
    // The columns of the two differ by 1e-5; the peaks alone decide.
    let peaks = |new: &str, more: &[&str]| {
        let arguments: Vec<&str> = (["a", new].iter().chain(more)).copied().collect();
        compared(folder, &arguments)
    };
    assert_eq!(peaks("hardly", &[]).0, 4);
    for (new, tolerance, code) in [
        ("hardly", "1e-3", 0),
        ("moved", "1e-3", 4),
        ("moved", "1e-2", 0),
    ] {
        let (found, text) = peaks(new, &["--peaks", tolerance]);
        assert_eq!(found, code, "{new} {tolerance}: {text}");
    }
    assert_eq!(peaks("hardly", &["--peaks"]).0, 0);
    // A column with a tolerance of its own is judged too.
    let column = ["--peaks", "1e-3", "--tolerance", "energy_loss_j=1e-9"];
    assert_eq!(peaks("hardly", &column).0, 4);
}

/// Over one axis the summary has the number itself, where over several it has a list.
#[test]
fn a_peak_that_moved_is_found_over_one_further_axis_and_over_two() {
    let folder = TempDir::new().unwrap();
    for axes in [
        &["sweep.drive.amplitude=[2, 5]"][..],
        &["sweep.drive.amplitude=[2, 5]", "sweep.drive.mean=[10, 11]"],
    ] {
        let set: Vec<&str> = axes.iter().flat_map(|axis| ["--set", axis]).collect();
        for (name, time_s) in [("one", 117.96), ("other", 110.0)] {
            let name = format!("{name}-{}", axes.len());
            swept_with(folder.path(), &name, time_s, &set);
        }
        let names = ["one", "other"].map(|name| format!("{name}-{}", axes.len()));
        let [one, other] = names.each_ref().map(String::as_str);
        let (code, text) = compared(folder.path(), &[one, one]);
        assert_eq!(code, 0, "{text}");
        let (code, text) = compared(folder.path(), &[one, other, "--peaks"]);
        assert_eq!(code, 4, "{text}");
        // One peak for each combination, every one of which moved.
        let moved = text.lines().filter(|line| line.contains("moved by +8."));
        assert_eq!(moved.count(), 1 << axes.len(), "{text}");
    }
}

#[test]
fn what_was_not_compared_is_said_and_nothing_compared_is_no_agreement() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    swept(folder, "a", 117.96);
    let (code, text) = compared(folder, &["a/sweep.csv", "a/sweep.csv"]);
    assert_eq!(code, 0);
    assert!(
        text.contains("peaks: not compared, a/sweep.csv was given without its summary.json"),
        "{text}"
    );
    let (code, text) = compared(folder, &["a/sweep.csv", "a/sweep.csv", "--peaks", "1e-3"]);
    assert_eq!(code, 4);
    assert!(text.contains("No peak was compared"), "{text}");
    // Tables without a row, and without a row in common.
    let table = std::fs::read_to_string(folder.join("a/sweep.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    for (name, lines) in [("head", &rows[..1]), ("one", &rows[..2])] {
        std::fs::write(folder.join(format!("{name}.csv")), lines.join("\n")).unwrap();
    }
    let others = [rows[0], rows[3]].join("\n");
    std::fs::write(folder.join("other.csv"), others).unwrap();
    for pair in [["head.csv", "head.csv"], ["one.csv", "other.csv"]] {
        let (code, text) = compared(folder, &pair);
        assert_eq!(code, 4, "{pair:?}");
        assert!(
            text.contains("nothing was compared, no case is in both."),
            "{text}"
        );
    }
    let (code, text) = compared(folder, &["a", "a"]);
    assert_eq!(code, 0);
    assert!(
        !text.contains("not compared") && text.contains("peak at"),
        "{text}"
    );
}

#[test]
fn columns_that_other_steps_leave_unjudged_are_counted() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    swept(folder, "a", 117.96);
    let table = std::fs::read_to_string(folder.join("a/sweep.csv")).unwrap();
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let heads = reader.headers().unwrap().clone();
    let column = |name: &str| heads.iter().position(|head| head == name).unwrap();
    let (steps, duty) = (column("steps"), column("branch_1_loss_j"));
    let mut writer = csv::Writer::from_path(folder.join("b.csv")).unwrap();
    writer.write_record(&heads).unwrap();
    for row in reader.records() {
        let cells = row.unwrap();
        let changed = cells.iter().enumerate().map(|(k, cell)| match k {
            k if k == steps => "60".to_owned(),
            k if k == duty => format!("{:e}", 1.01 * cell.parse::<f64>().unwrap()),
            _ => cell.to_owned(),
        });
        writer.write_record(changed.collect::<Vec<_>>()).unwrap();
    }
    writer.flush().unwrap();
    let (code, text) = compared(folder, &["a/sweep.csv", "b.csv"]);
    assert_eq!(code, 0, "{text}");
    assert!(
        text.contains("3 not judged: other steps or nodes, no error bars"),
        "{text}"
    );
}
