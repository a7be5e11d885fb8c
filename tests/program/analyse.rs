//! `contact-dma analyse`: records of measured loops in, the table of a sweep out.

#[path = "../../examples/measured_loops.rs"]
#[allow(dead_code)]
mod example;

use crate::prelude::*;
use std::f64::consts::{PI, TAU};

/// A record of a sinusoidal load and an approach that lags, with a deterministic noise, a thousandth of the amplitudes.
pub struct Loop {
    hz: f64,
    lag: f64,
    cycles: f64,
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

    fn loss_j(&self) -> f64 {
        PI * 5.0 * 2e-6 * self.lag.sin()
    }

    pub fn text(&self) -> String {
        record(&self.rows())
    }
}

/// A table of time (s), load (mN) and depth (nm) from the rows of a loop.
fn record(rows: &[[f64; 3]]) -> String {
    let row = |[t, w, d]: &[f64; 3]| format!("{t:e},{:e},{:e}\n", 1e3 * w, 1e9 * d);
    let rows: String = rows.iter().map(row).collect();
    format!("Time (s),Load (mN),Depth (nm)\n{rows}")
}

const THREE: &str = "analyse loop-0.csv loop-1.csv loop-2.csv";

/// Loops of three frequencies.
pub fn loops() -> [Loop; 3] {
    [(5.0, 0.2), (0.5, 0.1), (50.0, 0.3)].map(|(hz, lag)| Loop {
        hz,
        lag,
        cycles: 12.4,
    })
}

/// Records of these, in files that [`THREE`] names.
fn three() -> (Place, [Loop; 3]) {
    let place = Place::new();
    let loops = loops();
    for (k, one) in loops.iter().enumerate() {
        place.put(&format!("loop-{k}.csv"), one.text());
    }
    (place, loops)
}

/// A loop of 1 Hz.
fn one_hertz() -> Loop {
    Loop {
        hz: 1.0,
        lag: 0.2,
        cycles: 22.0,
    }
}

#[test]
fn records_become_the_rows_of_a_sweep_by_ascending_frequency() {
    let (place, mut loops) = three();
    place.done(&format!("{THREE} --out out")).fits_eighty();
    loops.sort_by(|a, b| a.hz.total_cmp(&b.hz));
    let table = place.table("out/sweep.csv");
    for (k, one) in loops.iter().enumerate() {
        let [hz, lag] = table.row(k, ["frequency_hz", "phase_lag_rad"]);
        let [loss, error] = table.row(k, ["energy_loss_j", "energy_loss_error_j"]);
        near!(hz, one.hz, 1e-4);
        below!((loss - one.loss_j()).abs(), error.max(1e-4 * one.loss_j()));
        below!(error, 2e-3 * one.loss_j());
        below!((lag - one.lag).abs(), 3e-4);
        let samples = place.table(&format!("out/cases/loops/{k}.csv"));
        assert_eq!(samples.numbers("load_n").len(), 201);
        assert_eq!(place.table(&format!("out/cases/cycles/{k}.csv")).len(), 12);
    }
    assert_eq!(table.cells("status"), ["converged"; 3]);
    assert_eq!(place.json("out/summary.json")["cases"]["converged"], 3);
}

#[test]
fn results_do_not_depend_on_threads_and_those_of_an_earlier_analysis_do_not_stay() {
    let (place, _) = three();
    for (threads, out) in [(1, "one"), (4, "four")] {
        let run = place.done(&format!("{THREE} --threads {threads} --quiet --out {out}"));
        assert_eq!(run.stdout, "");
    }
    for file in [
        "sweep.csv",
        "records/analysis.json",
        "cases/loops/2.csv",
        "summary.json",
    ] {
        place.are_same(&["one", "four"], file);
    }
    place.done("analyse loop-0.csv --threads 2 --quiet --out four");
    assert!(place.has("four/cases/loops/0.csv") && !place.has("four/cases/loops/1.csv"));
}

#[test]
fn a_frequency_that_is_given_is_taken_and_one_that_is_another_is_told() {
    let (place, _) = three();
    let run = |frequency: &str| {
        let line = format!("analyse loop-0.csv --frequency '{frequency}' --out out");
        place.run(&line)
    };
    run("5 Hz").ended(0);
    assert_eq!(place.table("out/sweep.csv").numbers("frequency_hz"), [5.0]);
    let code = run("5.02 Hz").code;
    assert!(code == 0 || code == 3, "{code}");
    assert!(place.table("out/sweep.csv").cells("warnings")[0].contains("other-frequency"));
}

#[test]
fn a_record_without_a_loop_is_named_and_one_that_cannot_be_read_stops_before_anything_is_written() {
    let (place, _) = three();
    let rows: String = (0..100).map(|i| format!("{i},1,{}\n", i % 3)).collect();
    place.put("flat.csv", format!("time_s,load_n,depth_nm\n{rows}"));
    let analyse = "analyse loop-0.csv flat.csv --out out";
    place.run(analyse).ended(3);
    let table = place.table("out/sweep.csv");
    assert_eq!(table.cells("status"), ["converged", "failed"]);
    assert!(table.cells("message")[1].contains("load is the same in all samples"));
    fs::remove_dir_all(place.path("out")).unwrap();
    place.put("flat.csv", "time_s,load,depth_nm\n1,2,3\n");
    says(&place.refused(analyse), &["flat.csv:1:8", "no unit"]);
    assert!(!place.has("out"));
}

/// The records of the repository.
fn records() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/measured-loops")
}

#[test]
fn the_records_of_the_repository_are_what_their_program_writes_and_give_back_their_loss() {
    let place = Place::new();
    let mut run = "analyse --out out".to_owned();
    let mut losses = Vec::new();
    for (seed, hz) in (1..).zip(example::FREQUENCIES_HZ) {
        let (text, loss_j) = example::record(hz, seed).unwrap();
        let file = records().join(format!("{hz}-hz.csv"));
        let kept = fs::read_to_string(&file).unwrap();
        assert_eq!(kept, text, "cargo run --example measured_loops");
        run += &format!(" '{}'", file.display());
        losses.push(loss_j);
    }
    place.done(&run);
    let table = place.table("out/sweep.csv");
    for (k, loss_j) in losses.into_iter().enumerate() {
        let [found, error] = table.row(k, ["energy_loss_j", "energy_loss_error_j"]);
        // Four intervals of 95 %, of which one in twenty may miss a little.
        below!((found - loss_j).abs(), 1.5 * error, "{k}");
        below!(error, 0.03 * loss_j, "{k}");
    }
    assert_eq!(table.cells("drift"), ["linear"; 4]);
}

#[test]
fn a_setup_gives_moduli() {
    let sphere = "[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n";
    let setup = format!("[contact]\npoisson_ratio = 0.38\n{sphere}");
    let place = Place::with("setup.toml", &setup);
    let record = records().join("0.0013-hz.csv");
    let analyse = format!("analyse '{}' --setup setup.toml", record.display());
    let run = place.done(&format!("{analyse} --out out")).fits_eighty();
    run.says(&["without bias"]);
    let table = place.table("out/sweep.csv");
    // What the record was made of.
    let own = pmma_material();
    let own = own.relaxation().unwrap().complex_modulus(TAU * 1.3e-3);
    for (kind, truth) in [("storage", own.re), ("loss", own.im)] {
        let [value, error] = ["modulus_pa", "modulus_error_pa"]
            .map(|column| table.number(0, &format!("corrected_{kind}_{column}")));
        // The interval, and a part in a hundred for the solid that stands for PMMA.
        below!((value - truth).abs(), error + 0.01 * truth, "{kind}");
    }
    assert!(table.number(0, "loss_modulus_bias") < -0.03);
}

#[test]
fn a_folder_of_an_analysis_is_drawn_again_and_no_folder_of_a_sweep_is_overwritten() {
    let (place, _) = three();
    let table = "index,angular_frequency_rad_per_s,energy_loss_j\n0,6.0,1e-6\n1,7.0,1.5e-6\n";
    place.put("computed/sweep.csv", table);
    place.done(&format!("{THREE} --against computed --out out --quiet"));
    for file in "figures/loops.svg figures/energy-loss.png figures/cycles.svg index.html figures/loops.caption.txt".split(' ') {
        assert!(place.bytes(&format!("out/{file}")).len() > 50, "{file}");
    }
    // What was drawn beside the measured ones is drawn again, with nothing but the folder.
    fs::remove_dir_all(place.path("computed")).unwrap();
    let read =
        || ["out/figures/loops.svg", "out/figures/energy-loss.svg"].map(|file| place.text(file));
    let before = read();
    let kept = "\"angular_rad_per_s\":7.0";
    says(&place.text("out/records/analysis.json"), &[kept]);
    fs::remove_file(place.path("out/figures/loops.svg")).unwrap();
    place.done("report out --quiet");
    assert_eq!(read(), before);
    place.put("computed/sweep.csv", table);
    // A plan that is no one's is a file of somebody else; see also folders.rs.
    place.put("sweep/resolved.toml", "");
    let told = place.refused(&format!("{THREE} --against computed --out sweep --quiet"));
    says(&told, &["has not written"]);
}

#[test]
fn a_quiet_command_still_says_what_has_no_result_and_why() {
    let place = Place::with("empty.csv", "Time (s),Load (mN),Depth (nm)\n");
    place.put("good.csv", one_hertz().text());
    let run = |rest: &str, code: i32| {
        let run = place.run(&format!("analyse {rest} --quiet --out out"));
        assert_eq!(run.stdout, "");
        run.ended(code).stderr
    };
    let few = "empty.csv: failed: 0 samples are too few";
    says(&run("empty.csv", 3), &[few]);
    // The frequency was given, and is not asked for.
    let said = run("good.csv --frequency '10 Hz'", 3);
    says(&said, &["good.csv: failed: no oscillation of 10 Hz"]);
    assert!(!said.contains("give the frequency"), "{said}");
    assert_eq!(run("good.csv", 0), "");
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps/pmma.toml");
    let run = place.run(&format!(
        "sweep '{example}' --quiet --no-figures --set cycle.method=march --set cycle.max_cycles=2 \
         --set 'sweep.frequency=[\"1 mHz\"]' --set sweep.refine=false --out sweep"
    ));
    assert_eq!(run.stdout, "");
    says(&run.ended(3).stderr, &["not-converged"]);
}

#[test]
fn the_type_of_a_value_in_json_is_that_of_its_column() {
    let place = Place::with("1e3", &one_hertz().text());
    let found = place.done("analyse 1e3 --format json --out out").json();
    let row = &found["rows"][0];
    assert_eq!(row["file"], "1e3");
    assert_eq!(row["cycles"], 22);
    assert!(row["cycles"].is_u64() && row["points_per_cycle"].is_f64());
    assert!(row["peak_pressure_max_pa"].is_null());
}

#[test]
fn a_time_that_is_wrong_is_named_at_once() {
    let mut rows = one_hertz().rows();
    let last = rows.len();
    rows[last - 1][0] = 3e7;
    let place = Place::with("late.csv", &record(&rows));
    let since = std::time::Instant::now();
    let said = place.ends("analyse late.csv --frequency '1 Hz' --quiet --out out", 3);
    let samples = format!("between samples {} and {last} the time leaps", last - 1);
    says(&said, &[&samples]);
    assert!(since.elapsed().as_secs() < 20, "{:?}", since.elapsed());
}

#[test]
fn a_record_whose_time_descends_is_put_in_order() {
    let mut rows = one_hertz().rows();
    rows.reverse();
    let place = Place::with("backwards.csv", &record(&rows));
    let descend = ["the times descend from the first sample to the last"];
    place.done("analyse backwards.csv --out out").says(&descend);
    let loss = place.table("out/sweep.csv").number(0, "energy_loss_j");
    near!(loss, one_hertz().loss_j(), 2e-3);
}

#[test]
fn interrupted_it_ends_at_once_and_writes_nothing() {
    use std::process::{Command, Stdio};
    let folder = TempDir::new().unwrap();
    let (pipe, out) = (folder.path().join("pipe"), folder.path().join("out"));
    let made = Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let mut analyse = Command::new(assert_cmd::cargo::cargo_bin("contact-dma"));
    analyse.arg("analyse").arg(&pipe).arg("--out").arg(&out);
    let mut child = analyse.stderr(Stdio::null()).spawn().unwrap();
    // Opens once the program reads, which then waits for the record.
    let writer = fs::OpenOptions::new().write(true).open(&pipe).unwrap();
    let pid = child.id().to_string();
    let sent = Command::new("kill").args(["-INT", &pid]).status();
    assert!(sent.unwrap().success());
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
