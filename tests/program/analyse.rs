//! `contact-dma analyse`: records of measured loops in, the table of a sweep out.

#![cfg(feature = "cli")]

#[path = "../../examples/measured_loops.rs"]
#[allow(dead_code)]
mod example;

use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use tempfile::TempDir;

/// A record of a sinusoidal load and an approach that lags, with a deterministic noise, a thousandth of the amplitudes.
pub(crate) struct Loop {
    pub(crate) hz: f64,
    pub(crate) lag: f64,
    pub(crate) cycles: f64,
}

impl Loop {
    fn rows(&self) -> Vec<[f64; 3]> {
        let noise = |i: f64, k: f64| (12.9 * (i + k).powf(1.7)).sin();
        let points = 90.7;
        (0..(self.cycles * points) as usize)
            .map(|i| {
                let i = i as f64;
                let angle = TAU * i / points + 0.7;
                let load = 10.0 + 5.0 * (angle.sin() + 1e-3 * noise(i, 1.0));
                let approach =
                    1e-6 * (40.0 + 2.0 * ((angle - self.lag).sin() + 1e-3 * noise(i, 5e4)));
                [i / (points * self.hz), load, approach]
            })
            .collect()
    }

    pub(crate) fn loss_j(&self) -> f64 {
        PI * 5.0 * 2e-6 * self.lag.sin()
    }

    fn write(&self, path: &Path) {
        let rows = self.rows();
        let rows = rows
            .iter()
            .map(|[t, w, d]| format!("{t:e},{:e},{:e}\n", 1e3 * w, 1e9 * d));
        let text = format!(
            "Time (s),Load (mN),Depth (nm)\n{}",
            rows.collect::<String>()
        );
        fs::write(path, text).unwrap();
    }
}

fn program() -> Command {
    Command::cargo_bin("contact-dma").unwrap()
}

/// Cells of a table under their names, row by row.
fn cells(path: &Path, column: &str) -> Vec<String> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let place = reader
        .headers()
        .unwrap()
        .iter()
        .position(|name| name == column);
    let place = place.unwrap_or_else(|| panic!("no {column}"));
    reader
        .records()
        .map(|row| row.unwrap()[place].to_owned())
        .collect()
}

fn numbers(path: &Path, column: &str) -> Vec<f64> {
    cells(path, column)
        .iter()
        .map(|cell| cell.parse().unwrap())
        .collect()
}

fn three(folder: &TempDir) -> ([Loop; 3], Vec<PathBuf>) {
    let of = |hz, lag| Loop {
        hz,
        lag,
        cycles: 12.4,
    };
    let loops = [of(5.0, 0.2), of(0.5, 0.1), of(50.0, 0.3)];
    let files: Vec<PathBuf> = (0..3)
        .map(|k| folder.path().join(format!("loop-{k}.csv")))
        .collect();
    for (one, file) in loops.iter().zip(&files) {
        one.write(file);
    }
    (loops, files)
}

#[test]
fn records_become_the_rows_of_a_sweep_by_ascending_frequency() {
    let folder = TempDir::new().unwrap();
    let (mut loops, files) = three(&folder);
    let out = folder.path().join("measured");
    let printed = program()
        .arg("analyse")
        .args(&files)
        .arg("--out")
        .arg(&out)
        .assert()
        .success();
    let printed = String::from_utf8(printed.get_output().stdout.clone()).unwrap();
    assert!(
        printed
            .lines()
            .all(|line| line.chars().count() <= 80 || line.contains("Results in"))
    );
    loops.sort_by(|a, b| a.hz.total_cmp(&b.hz));
    let table = out.join("sweep.csv");
    let (hz, loss) = (
        numbers(&table, "frequency_hz"),
        numbers(&table, "energy_loss_j"),
    );
    let (error, lag) = (
        numbers(&table, "energy_loss_error_j"),
        numbers(&table, "phase_lag_rad"),
    );
    for (k, one) in loops.iter().enumerate() {
        assert!((hz[k] / one.hz - 1.0).abs() < 1e-4, "{}", hz[k]);
        assert!((loss[k] - one.loss_j()).abs() < error[k].max(1e-4 * one.loss_j()));
        assert!(error[k] < 2e-3 * one.loss_j());
        assert!((lag[k] - one.lag).abs() < 3e-4);
        let samples = numbers(&out.join(format!("loops/{k}.csv")), "load_n");
        assert_eq!(samples.len(), 201);
        assert_eq!(
            cells(&out.join(format!("cycles/{k}.csv")), "cycle").len(),
            12
        );
    }
    assert_eq!(cells(&table, "status"), ["converged"; 3]);
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["cases"]["converged"], 3);
}

#[test]
fn results_do_not_depend_on_threads_and_those_of_an_earlier_analysis_do_not_stay() {
    let folder = TempDir::new().unwrap();
    let (_, files) = three(&folder);
    let run = |threads: &str, name: &str, files: &[PathBuf]| {
        let out = folder.path().join(name);
        let mut command = program();
        command.args(["analyse", "--threads", threads]).args(files);
        command
            .arg("--out")
            .arg(&out)
            .arg("--quiet")
            .assert()
            .success()
            .stdout("");
        out
    };
    let (one, four) = (run("1", "one", &files), run("4", "four", &files));
    for file in ["sweep.csv", "analysis.json", "loops/2.csv", "summary.json"] {
        assert_eq!(
            fs::read(one.join(file)).unwrap(),
            fs::read(four.join(file)).unwrap(),
            "{file}"
        );
    }
    run("2", "four", &files[..1]);
    assert!(four.join("loops/0.csv").exists() && !four.join("loops/1.csv").exists());
}

#[test]
fn a_frequency_that_is_given_is_taken_and_one_that_is_another_is_told() {
    let folder = TempDir::new().unwrap();
    let (_, files) = three(&folder);
    let run = |frequency: &str| {
        let out = folder.path().join("given");
        let mut command = program();
        command
            .arg("analyse")
            .arg(&files[0])
            .args(["--frequency", frequency])
            .arg("--out");
        let output = command.arg(&out).output().unwrap();
        (output, out)
    };
    let (output, out) = run("5 Hz");
    assert!(output.status.success());
    assert_eq!(numbers(&out.join("sweep.csv"), "frequency_hz"), [5.0]);
    let (output, out) = run("5.02 Hz");
    assert!(
        output
            .status
            .code()
            .is_some_and(|code| code == 0 || code == 3)
    );
    assert!(cells(&out.join("sweep.csv"), "warnings")[0].contains("other-frequency"));
    let (output, _) = run("ten");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_record_without_a_loop_is_named_and_one_that_cannot_be_read_stops_before_anything_is_written() {
    let folder = TempDir::new().unwrap();
    let (_, files) = three(&folder);
    let flat = folder.path().join("flat.csv");
    let rows: String = (0..100).map(|i| format!("{i},1,{}\n", i % 3)).collect();
    fs::write(&flat, format!("time_s,load_n,depth_nm\n{rows}")).unwrap();
    let out = folder.path().join("out");
    let analyse = |second: &Path| {
        let mut command = program();
        command
            .arg("analyse")
            .arg(&files[0])
            .arg(second)
            .arg("--out")
            .arg(&out)
            .output()
            .unwrap()
    };
    let output = analyse(&flat);
    assert_eq!(output.status.code(), Some(3));
    assert_eq!(
        cells(&out.join("sweep.csv"), "status"),
        ["converged", "failed"]
    );
    assert!(
        cells(&out.join("sweep.csv"), "message")[1].contains("load is the same in all samples")
    );
    fs::remove_dir_all(&out).unwrap();
    fs::write(&flat, "time_s,load,depth_nm\n1,2,3\n").unwrap();
    let output = analyse(&flat);
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(
        told.contains("flat.csv:1:8") && told.contains("no unit"),
        "{told}"
    );
    assert!(!out.exists());
}

#[test]
fn the_records_of_the_repository_are_what_their_program_writes_and_give_back_their_loss() {
    let folder = TempDir::new().unwrap();
    let records = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/measured-loops");
    let mut files = Vec::new();
    let mut losses = Vec::new();
    for (seed, hz) in (1..).zip(example::FREQUENCIES_HZ) {
        let (text, loss_j) = example::record(hz, seed).unwrap();
        let file = records.join(format!("{hz}-hz.csv"));
        assert_eq!(
            fs::read_to_string(&file).unwrap(),
            text,
            "cargo run --example measured_loops"
        );
        files.push(file);
        losses.push(loss_j);
    }
    let out = folder.path().join("out");
    program()
        .arg("analyse")
        .args(&files)
        .arg("--out")
        .arg(&out)
        .assert()
        .success();
    let table = out.join("sweep.csv");
    let (found, errors) = (
        numbers(&table, "energy_loss_j"),
        numbers(&table, "energy_loss_error_j"),
    );
    for (k, loss_j) in losses.iter().enumerate() {
        // Four intervals of 95 %, of which one in twenty may miss a little.
        assert!(
            (found[k] - loss_j).abs() < 1.5 * errors[k],
            "{} {loss_j} {}",
            found[k],
            errors[k]
        );
        assert!(errors[k] < 0.03 * loss_j);
    }
    assert_eq!(cells(&table, "drift"), ["linear"; 4]);
}

#[test]
fn a_setup_gives_moduli() {
    let folder = TempDir::new().unwrap();
    let record = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/measured-loops/0.0013-hz.csv");
    let setup = folder.path().join("setup.toml");
    let out = folder.path().join("out");
    let run = |text: &str| {
        fs::write(&setup, text).unwrap();
        let mut command = program();
        command
            .arg("analyse")
            .arg(&record)
            .arg("--setup")
            .arg(&setup)
            .arg("--out")
            .arg(&out);
        command.output().unwrap()
    };
    let sphere = "[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n";
    let output = run(&format!("[contact]\npoisson_ratio = 0.38\n{sphere}"));
    assert!(output.status.success());
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(printed.contains("without bias"), "{printed}");
    assert!(
        printed
            .lines()
            .all(|line| line.chars().count() <= 80 || line.contains("Results in"))
    );
    let table = out.join("sweep.csv");
    // What the record was made of.
    let pmma = contact_dma::material::library::find("pmma")
        .unwrap()
        .material()
        .unwrap();
    let own = pmma.relaxation().unwrap().complex_modulus(TAU * 1.3e-3);
    for (column, error, truth) in [
        (
            "corrected_storage_modulus_pa",
            "corrected_storage_modulus_error_pa",
            own.re,
        ),
        (
            "corrected_loss_modulus_pa",
            "corrected_loss_modulus_error_pa",
            own.im,
        ),
    ] {
        let (value, error) = (numbers(&table, column)[0], numbers(&table, error)[0]);
        // The interval, and a part in a hundred for the solid that stands for PMMA.
        assert!(
            (value - truth).abs() < error + 0.01 * truth,
            "{column}: {value:e} {truth:e} {error:e}"
        );
    }
    assert!(numbers(&table, "loss_modulus_bias")[0] < -0.03);
}

#[test]
fn a_folder_of_an_analysis_is_drawn_again_and_no_folder_of_a_sweep_is_overwritten() {
    let folder = TempDir::new().unwrap();
    let (_, files) = three(&folder);
    let out = folder.path().join("out");
    let computed = folder.path().join("computed");
    fs::create_dir_all(&computed).unwrap();
    let table = "index,angular_frequency_rad_per_s,energy_loss_j\n0,6.0,1e-6\n1,7.0,1.5e-6\n";
    fs::write(computed.join("sweep.csv"), table).unwrap();
    let analyse = |out: &Path| {
        let mut command = program();
        command
            .arg("analyse")
            .args(&files)
            .arg("--against")
            .arg(&computed)
            .arg("--out")
            .arg(out)
            .arg("--quiet")
            .output()
            .unwrap()
    };
    assert!(analyse(&out).status.success());
    for file in [
        "loops.svg",
        "energy-loss.png",
        "cycles.svg",
        "index.html",
        "loops.caption.txt",
    ] {
        assert!(
            out.join(file).metadata().is_ok_and(|file| file.len() > 50),
            "{file}"
        );
    }
    // What was drawn beside the measured ones is drawn again, with nothing but the folder.
    fs::remove_dir_all(&computed).unwrap();
    let read = || ["loops.svg", "energy-loss.svg"].map(|file| fs::read(out.join(file)).unwrap());
    let before = read();
    let kept = fs::read_to_string(out.join("analysis.json")).unwrap();
    assert!(kept.contains("\"angular_rad_per_s\":7.0"), "{kept}");
    fs::remove_file(out.join("loops.svg")).unwrap();
    program()
        .arg("report")
        .arg(&out)
        .arg("--quiet")
        .assert()
        .success();
    assert_eq!(read(), before);
    fs::create_dir_all(&computed).unwrap();
    fs::write(computed.join("sweep.csv"), table).unwrap();
    // A plan that is no one's is a file of somebody else; see also folders.rs.
    let of_sweep = folder.path().join("sweep");
    fs::create_dir(&of_sweep).unwrap();
    fs::write(of_sweep.join("resolved.toml"), "").unwrap();
    let output = analyse(&of_sweep);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("has not written")
    );
}

/// A table of time (s), load (mN) and depth (nm) from the rows of a loop.
fn write_rows(path: &Path, rows: &[[f64; 3]]) {
    let rows = rows
        .iter()
        .map(|[t, w, d]| format!("{t:e},{:e},{:e}\n", 1e3 * w, 1e9 * d));
    let rows: String = rows.collect();
    fs::write(path, format!("Time (s),Load (mN),Depth (nm)\n{rows}")).unwrap();
}

fn one_hertz() -> Loop {
    Loop {
        hz: 1.0,
        lag: 0.2,
        cycles: 22.0,
    }
}

#[test]
fn a_quiet_command_still_says_what_has_no_result_and_why() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("empty.csv"), "Time (s),Load (mN),Depth (nm)\n").unwrap();
    one_hertz().write(&at("good.csv"));
    let run = |file: &str, arguments: &[&str]| {
        let mut command = program();
        command.arg("analyse").arg(at(file)).args(arguments);
        let output = command.arg("--quiet").arg("--out").arg(at("out")).output();
        let output = output.unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stdout), "");
        let said = String::from_utf8(output.stderr).unwrap();
        (output.status.code(), said)
    };
    let (code, said) = run("empty.csv", &[]);
    assert_eq!(code, Some(3));
    assert!(
        said.contains("empty.csv: failed: 0 samples are too few"),
        "{said}"
    );
    // The frequency was given, and is not asked for.
    let (code, said) = run("good.csv", &["--frequency", "10 Hz"]);
    assert_eq!(code, Some(3));
    assert!(
        said.contains("good.csv: failed: no oscillation of 10 Hz"),
        "{said}"
    );
    assert!(!said.contains("give the frequency"), "{said}");
    assert_eq!(run("good.csv", &[]), (Some(0), String::new()));
    let mut command = program();
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps/pmma.toml");
    command.args(["sweep", example, "--quiet", "--no-figures"]);
    command.args(["--set", "cycle.method=march", "--set", "cycle.max_cycles=2"]);
    command.args([
        "--set",
        "sweep.frequency=[\"1 mHz\"]",
        "--set",
        "sweep.refine=false",
        "--out",
    ]);
    let output = command.arg(at("sweep")).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("not-converged"), "{said}");
    assert!(output.stdout.is_empty());
}

#[test]
fn the_type_of_a_value_in_json_is_that_of_its_column() {
    let folder = TempDir::new().unwrap();
    one_hertz().write(&folder.path().join("1e3"));
    let mut command = program();
    command.current_dir(folder.path());
    let output = command
        .args(["analyse", "1e3", "--format", "json", "--out", "out"])
        .output();
    let output = output.unwrap();
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let row = &found["rows"][0];
    assert_eq!(row["file"], "1e3");
    assert_eq!(row["cycles"], 22);
    assert!(row["cycles"].is_u64() && row["points_per_cycle"].is_f64());
    assert!(row["peak_pressure_max_pa"].is_null());
}

#[test]
fn a_time_that_is_wrong_is_named_at_once() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("late.csv");
    let mut rows = one_hertz().rows();
    let last = rows.len();
    rows[last - 1][0] = 3e7;
    write_rows(&file, &rows);
    let since = std::time::Instant::now();
    let mut command = program();
    command
        .arg("analyse")
        .arg(&file)
        .args(["--frequency", "1 Hz", "--quiet", "--out"]);
    let output = command.arg(folder.path().join("out")).output().unwrap();
    assert_eq!(output.status.code(), Some(3));
    let said = String::from_utf8(output.stderr).unwrap();
    let samples = format!("between samples {} and {last} the time leaps", last - 1);
    assert!(said.contains(&samples), "{said}");
    assert!(since.elapsed().as_secs() < 20, "{:?}", since.elapsed());
}

#[test]
fn a_record_whose_time_descends_is_put_in_order() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("backwards.csv");
    let mut rows = one_hertz().rows();
    rows.reverse();
    write_rows(&file, &rows);
    let mut command = program();
    command.arg("analyse").arg(&file).arg("--out");
    let output = command.arg(folder.path().join("out")).output().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{printed}");
    let words = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains("the times descend from the first sample to the last"),
        "{printed}"
    );
    let loss = numbers(&folder.path().join("out/sweep.csv"), "energy_loss_j");
    assert!((loss[0] / one_hertz().loss_j() - 1.0).abs() < 2e-3);
}

#[test]
fn interrupted_it_ends_at_once_and_writes_nothing() {
    use std::process::{Command, Stdio};
    let folder = TempDir::new().unwrap();
    let (pipe, out) = (folder.path().join("pipe"), folder.path().join("out"));
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let mut child = Command::new(assert_cmd::cargo::cargo_bin("contact-dma"))
        .arg("analyse")
        .arg(&pipe)
        .arg("--out")
        .arg(&out)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // Opens once the program reads, which then waits for the record.
    let writer = fs::OpenOptions::new().write(true).open(&pipe).unwrap();
    let pid = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &pid])
            .status()
            .unwrap()
            .success()
    );
    let ended = (0..600).find_map(|_| {
        std::thread::sleep(std::time::Duration::from_millis(50));
        child.try_wait().unwrap()
    });
    drop(writer);
    let ended = ended.unwrap_or_else(|| {
        child.kill().unwrap();
        child.wait().unwrap()
    });
    assert_eq!(ended.code(), Some(130));
    assert!(!out.exists());
}
