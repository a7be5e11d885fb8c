//! What a sweep survives, and how parts of one come together: every end result is that of an undisturbed run, bit for bit.

#![cfg(feature = "cli")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command as Process, Stdio};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use crate::kills::{
    Random, assert_same, leave_half_a_file, newest, results, set_clock_back_and_forth, signal,
    wait_for,
};
use crate::program::{program, write};
use crate::segments::{self, Stored};
use predicates::prelude::*;
use predicates::str::contains;
use tempfile::TempDir;

/// Sixty cases of a few milliseconds.
const CHEAP: &str = r#"title = "cheap"
[material]
library = "pmma"
[indenter]
shape = "sphere"
radius = "10 mm"
[drive]
mean = "10 N"
amplitude = "5 N"
[sweep]
angular_frequency = { from = "1e-3 rad/s", to = "1 rad/s", points = 60 }
[cycle]
steps = 40
[solver]
springs = 64
"#;

/// One case that marches through thousands of cycles.
const LONG: &str = r#"title = "long"
[material]
library = "pmma"
[indenter]
shape = "sphere"
radius = "10 mm"
[drive]
mean = "10 N"
amplitude = "5 N"
[sweep]
angular_frequency = ["20 rad/s"]
[cycle]
steps = 200
method = "march"
tolerance = 1e-9
max_cycles = 100000
[solver]
springs = 160
"#;

/// A sweep that nothing disturbs.
fn undisturbed(text: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "whole.toml", text);
    sweep(&file, &folder.path().join("whole"), &["--quiet"])
        .success()
        .stderr("");
    folder
}

/// [`CHEAP`] and [`LONG`] undisturbed, computed once for all tests.
static WHOLE: [LazyLock<TempDir>; 2] = [
    LazyLock::new(|| undisturbed(CHEAP)),
    LazyLock::new(|| undisturbed(LONG)),
];

fn whole_cheap() -> PathBuf {
    WHOLE[0].path().join("whole")
}

fn whole_long() -> PathBuf {
    WHOLE[1].path().join("whole")
}

/// A copy of [`whole_cheap`] in a folder, to be damaged.
fn copy_of_cheap(folder: &TempDir) -> PathBuf {
    let out = folder.path().join("out");
    let mut copying = Process::new("cp");
    copying.arg("-r").arg(whole_cheap()).arg(&out);
    assert!(copying.status().unwrap().success());
    out
}

fn start(file: &str, out: &Path, more: &[&str]) -> Child {
    crate::kills::start(&[&["sweep", file], more].concat(), out)
}

fn sweep(file: &str, out: &Path, more: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = program();
    command.args(["sweep", file, "--out"]).arg(out).args(more);
    command.assert()
}

#[test]
fn finished_cases_are_read_and_damaged_ones_named_and_computed_again() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let (whole, out) = (whole_cheap(), copy_of_cheap(&folder));
    let mut records = segments::read(&out);
    // Number 30 of the cases is torn, as if its process had been killed: the end of its own segment.
    let torn = records.remove(30);
    records.drain(10..20);
    segments::replace(&out, &[torn]);
    let path = out.join("records/torn.segment");
    fs::rename(segments::one(&out), &path).unwrap();
    let bytes = fs::read(&path).unwrap();
    let places = segments::replace(&out, &records);
    fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let mut flipped = fs::read(segments::one(&out)).unwrap();
    let (from, to) = places[20];
    flipped[from + 200] ^= 4;
    fs::write(segments::one(&out), flipped).unwrap();
    let named = format!("one.segment: bytes {from} to {to} are damaged or torn");
    fs::remove_file(out.join("sweep.csv")).unwrap();
    sweep(&file, &out, &["--threads", "1"])
        .success()
        .stderr(contains("48 of 60 cases were already done"))
        .stderr(contains(named))
        .stderr(contains("torn.segment: its last").and(contains("without its end")));
    assert_same(&out, &whole);
    sweep(&file, &out, &[])
        .success()
        .stderr(contains("60 of 60 cases were already done"));
    assert_same(&out, &whole);
}

#[test]
fn a_changed_sweep_is_refused_with_what_changed() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let out = folder.path().join("out");
    let few = ["--quiet", "--set", "sweep.angular_frequency=[0.01]"];
    sweep(&file, &out, &few).success();
    let before = results(&out);
    sweep(
        &file,
        &out,
        &[&few[..], &["--set", "cycle.steps=48"]].concat(),
    )
    .code(2)
    .stderr(contains("- steps = 40").and(contains("+ steps = 48")))
    .stderr(contains("radius").not());
    assert_eq!(results(&out), before);
    let steps = ["--set", "cycle.steps=48", "--force"];
    sweep(&file, &out, &[&few[..], &steps].concat()).success();
}

#[test]
fn a_record_of_a_newer_program_is_not_replaced_unless_told_to() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let out = folder.path().join("out");
    let one = ["--quiet", "--set", "sweep.angular_frequency=[0.01]"];
    sweep(&file, &out, &one).success();
    let whole = results(&out);
    let mut records = segments::read(&out);
    assert_eq!(
        records[0].heading.program_version,
        env!("CARGO_PKG_VERSION")
    );
    records[0].heading.program_version = "1000.0.0".to_owned();
    segments::replace(&out, &records);
    sweep(&file, &out, &one)
        .code(2)
        .stderr(contains("1000.0.0").and(contains("--force")));
    assert_eq!(segments::read(&out), records);
    sweep(&file, &out, &[&one[..], &["--force"]].concat()).success();
    let own: Vec<_> = segments::read(&out)
        .into_iter()
        .filter(|r| *r != records[0])
        .collect();
    segments::replace(&out, &own);
    assert_eq!(results(&out), whole);
}

#[test]
fn records_of_another_build_are_computed_again_by_a_sweep_and_shown_by_a_report() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let (whole, out) = (whole_cheap(), copy_of_cheap(&folder));
    let mut records = segments::read(&out);
    records[5].heading.build = "0123456789abcdef".to_owned();
    segments::replace(&out, &records);
    let report = || {
        let mut command = program();
        command.arg("report").arg(&out).assert()
    };
    report().success().stderr(
        contains("one.segment: it was written by another build").and(contains("as they are")),
    );
    assert_eq!(segments::read(&out), records);
    // One result is that of one build.
    let merged = folder.path().join("merged");
    program()
        .arg("merge")
        .arg(&out)
        .arg("--out")
        .arg(&merged)
        .assert()
        .code(1)
        .stderr(contains("one.segment: it was written by another build"))
        .stderr(contains("1 of 60 cases are in none of the parts"));
    sweep(&file, &out, &[])
        .success()
        .stderr(contains("59 of 60 cases were already done"))
        .stderr(contains("one.segment: it was written by another build").and(contains("again")));
    let own: Vec<_> = segments::read(&out)
        .into_iter()
        .filter(|r| *r != records[5])
        .collect();
    segments::replace(&out, &own);
    assert_same(&out, &whole);
}

/// Ten kills; `CONTACT_DMA_KILLS=100 cargo test --test interruption survival` for more.
#[test]
fn kills_at_any_moment_lose_nothing() {
    let kills: usize = std::env::var("CONTACT_DMA_KILLS")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(10);
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let whole = folder.path().join("whole");
    let started = Instant::now();
    sweep(&file, &whole, &["--quiet"]).success();
    let span = started.elapsed();
    let mut random = Random(20_260_801);
    let (mut killed, mut same, mut round) = (0, 0, 0);
    while killed < kills {
        let out = folder.path().join(format!("out-{round}"));
        round += 1;
        // Several kills on one folder, until a run comes to its end before its kill.
        loop {
            let mut child = start(&file, &out, &[]);
            std::thread::sleep(span.mul_f64(random.unit()));
            let was_running = child.try_wait().unwrap().is_none();
            if was_running {
                signal(&child, "-KILL");
                killed += 1;
            }
            assert!(was_running || child.wait().unwrap().success());
            child.wait().unwrap();
            if !was_running || killed >= kills {
                break;
            }
        }
        sweep(&file, &out, &["--quiet"]).success();
        assert_same(&out, &whole);
        same += 1;
        fs::remove_dir_all(&out).unwrap();
    }
    println!("{killed} kills in {round} folders, {same} of {round} ended as if undisturbed");
}

#[test]
fn a_long_case_goes_on_from_its_checkpoint_and_ends_with_the_same_bits() {
    let folder = TempDir::new().unwrap();
    let searched = LONG
        .replace("method = \"march\"\ntolerance = 1e-9", "tolerance = 1e-12")
        .replace("steps = 200", "steps = 100000");
    let cells = LONG
        .replace("20 rad/s", "2 rad/s")
        .replace("steps = 200", "steps = 48")
        .replace("springs = 160", "engine = \"half-space\"\ncells = 32");
    let ways = [("march", LONG), ("search", &searched), ("cells", &cells)];
    for (name, text) in ways {
        let file = write(&folder, "long.toml", text);
        let whole = match name {
            "march" => whole_long(),
            _ => {
                let whole = folder.path().join(format!("{name}-whole"));
                sweep(&file, &whole, &["--quiet"]).success();
                whole
            }
        };
        let out = folder.path().join(format!("{name}-out"));
        let often = ["--checkpoint-every", "0", "--threads", "1"];
        let case = out.join("checkpoints/0000");
        for (round, how) in ["-KILL", "-TERM"].into_iter().enumerate() {
            let mut child = start(&file, &out, &often);
            let before = newest(&case);
            wait_for("no checkpoint was written", || newest(&case) > before);
            std::thread::sleep(Duration::from_millis(30));
            signal(&child, how);
            let status = child.wait().unwrap();
            assert!(
                how == "-KILL" || status.code() == Some(130),
                "{name} {round}"
            );
            assert_eq!(segments::count(&out), 0, "{name}: too quick");
        }
        sweep(&file, &out, &["--quiet"]).success();
        assert!(!out.join("checkpoints").exists());
        assert_same(&out, &whole);
    }
}

/// A clock that was wrong when files were written, or has been set since: times of files, in the far past and in the future,
/// decide nothing.
#[test]
fn a_clock_that_jumps_between_interruption_and_resumption_changes_nothing() {
    let folder = TempDir::new().unwrap();
    for (name, text, whole, what) in [
        ("cheap", CHEAP, whole_cheap(), "records"),
        ("long", LONG, whole_long(), "checkpoints/0000"),
    ] {
        let file = write(&folder, "clock.toml", text);
        let out = folder.path().join(format!("{name}-out"));
        let mut child = start(&file, &out, &["--checkpoint-every", "0", "--threads", "1"]);
        wait_for("nothing was written", || newest(&out.join(what)).is_some());
        signal(&child, "-TERM");
        assert_eq!(child.wait().unwrap().code(), Some(130));
        // What a killed process leaves is swept out, however old or young it claims to be.
        let left_over = leave_half_a_file(&out);
        set_clock_back_and_forth(&out);
        let kept = segments::count(&out);
        sweep(&file, &out, &[])
            .success()
            .stderr(contains(format!("{kept} of 60 cases were already done")).or(contains("1/1")))
            .stderr(contains("damaged").not());
        assert!(!left_over.exists());
        assert_same(&out, &whole);
        let run: serde_json::Value =
            serde_json::from_slice(&fs::read(out.join("run.json")).unwrap()).unwrap();
        let wall_s = run["wall_time_s"].as_f64().unwrap();
        assert!((0.0..600.0).contains(&wall_s), "{wall_s}");
    }
}

/// Intervals are taken from a clock that cannot jump: the other one is asked in one place, for the stamps of run.json.
#[test]
fn the_time_of_day_is_asked_for_stamps_alone() {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src")];
    let mut asking = Vec::new();
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                let words = [
                    "SystemTime",
                    "UNIX_EPOCH",
                    ".modified()",
                    ".created()",
                    ".accessed()",
                ];
                if words.iter().any(|word| text.contains(word)) {
                    asking.push(path.file_name().unwrap().to_owned());
                }
            }
        }
    }
    asking.sort();
    // The other asks when a plan was written, to see whether it is still the one that was read.
    assert_eq!(asking, ["mod.rs", "provenance.rs"]);
}

#[test]
fn a_damaged_checkpoint_is_passed_over() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "long.toml", LONG);
    let (whole, out) = (whole_long(), folder.path().join("out"));
    let mut child = start(&file, &out, &["--checkpoint-every", "0"]);
    let path = out.join("checkpoints/0000/00.finished");
    wait_for("no checkpoint was written", || path.exists());
    signal(&child, "-KILL");
    child.wait().unwrap();
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&path, bytes).unwrap();
    sweep(&file, &out, &["--quiet"]).success();
    assert_same(&out, &whole);
}

#[test]
fn a_termination_is_heard_within_an_instant_of_the_finest_grid() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let out = folder.path().join("out");
    let cells = ["--set", "solver.engine=\"half-space\"", "--set"];
    let cells = [&cells[..], &["solver.cells=256"]].concat();
    let mut child = start(&file, &out, &cells);
    wait_for("the sweep did not start", || {
        out.join("resolved.toml").exists()
    });
    std::thread::sleep(Duration::from_secs(2));
    let sent = Instant::now();
    signal(&child, "-TERM");
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(
        sent.elapsed() < Duration::from_secs(2),
        "{:?}",
        sent.elapsed()
    );
}

/// Of more than 200 cases only those that figures choose have files of their own, and a partial report chooses others.
#[test]
fn the_files_of_a_partial_report_of_a_large_sweep_do_not_outlast_it() {
    let folder = TempDir::new().unwrap();
    let many = CHEAP.replace("points = 60", "points = 240") + "[figures]\nformats = [\"svg\"]\n";
    let file = write(&folder, "many.toml", &many);
    let (whole, out) = (folder.path().join("whole"), folder.path().join("out"));
    sweep(&file, &whole, &["--quiet"]).success();
    let mut child = start(&file, &out, &["--threads", "1"]);
    wait_for("no record was written", || out.join("records").exists());
    signal(&child, "-INT");
    if child.wait().unwrap().code() == Some(130) {
        let chosen = |out: &Path| fs::read_dir(out.join("loops")).unwrap().count();
        assert!(chosen(&out) > 0 && out.join("run.json").exists());
    }
    // A file of the user stays.
    fs::write(out.join("work/notes.txt"), "mine").unwrap();
    sweep(&file, &out, &["--quiet"]).success();
    assert_eq!(fs::read(out.join("work/notes.txt")).unwrap(), b"mine");
    fs::remove_file(out.join("work/notes.txt")).unwrap();
    assert_same(&out, &whole);
}

#[test]
fn a_second_interrupt_ends_the_program_at_once_and_the_next_run_goes_on() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let (whole, out) = (whole_cheap(), folder.path().join("out"));
    let mut child = start(&file, &out, &["--threads", "1"]);
    wait_for("no case was finished", || segments::count(&out) > 2);
    signal(&child, "-INT");
    signal(&child, "-INT");
    assert_eq!(child.wait().unwrap().code(), Some(130));
    sweep(&file, &out, &["--quiet"]).success();
    assert_same(&out, &whole);
}

#[test]
fn a_second_process_that_computes_the_same_sweep_is_refused_and_the_first_goes_on() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let (whole, out) = (whole_cheap(), folder.path().join("out"));
    let mut first = start(&file, &out, &["--threads", "1"]);
    wait_for("no case was finished", || segments::count(&out) > 2);
    for more in [&[][..], &["--shard", "1/2"]] {
        sweep(&file, &out, more)
            .code(2)
            .stderr(contains("the same sweep is computed there").and(contains("--shard 1/2")));
    }
    assert_eq!(first.wait().unwrap().code(), Some(0));
    sweep(&file, &out, &["--quiet"]).success();
    assert_same(&out, &whole);
}

/// A file system of so many bytes, where this may be mounted; taken away at the end.
struct Small(PathBuf);

impl Small {
    fn mount(path: &Path, options: &str) -> Option<Self> {
        fs::create_dir_all(path).unwrap();
        let mounted = Process::new("mount")
            .args(["-t", "tmpfs", "-o", options, "none"])
            .arg(path)
            .stderr(Stdio::null())
            .status();
        mounted
            .is_ok_and(|status| status.success())
            .then(|| Self(path.to_path_buf()))
    }
}

impl Drop for Small {
    fn drop(&mut self) {
        let _ = Process::new("umount").arg(&self.0).status();
    }
}

#[test]
fn a_full_disk_is_told_and_what_was_whole_before_stays_whole() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let out = folder.path().join("out");
    let Some(disk) = Small::mount(&out, "size=200k") else {
        println!("skipped: no small file system can be mounted here");
        return;
    };
    sweep(&file, &out, &["--quiet"])
        .code(1)
        .stderr(contains("cannot write").and(contains("No space left")));
    let records = segments::count(&out);
    assert!(records > 0);
    let mut copying = Process::new("cp");
    copying.arg("-r").arg(&out).arg(folder.path().join("kept"));
    assert!(copying.status().unwrap().success());
    drop(disk);
    // What was taken back has left no torn end.
    let freed = folder.path().join("freed");
    fs::rename(folder.path().join("kept"), &freed).unwrap();
    sweep(&file, &freed, &[])
        .success()
        .stderr(contains(format!("{records} of 60 cases were already done")))
        .stderr(contains("torn").not());
    assert_same(&freed, &whole_cheap());
}

#[test]
fn folders_that_cannot_be_written_or_are_not_there_are_named() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let out = folder.path().join("out");
    match Small::mount(&out, "size=200k,ro") {
        Some(_disk) => {
            sweep(&file, &out, &["--quiet"])
                .code(1)
                .stderr(contains("out/resolved.toml").and(contains("Read-only")));
        }
        None => println!("skipped: no read-only file system can be mounted here"),
    }
    // A file where the folder of records should be.
    let blocked = folder.path().join("blocked");
    fs::create_dir(&blocked).unwrap();
    fs::write(blocked.join("records"), "").unwrap();
    sweep(&file, &blocked, &["--quiet", "--force"])
        .code(1)
        .stderr(contains("blocked/records"));
    let nowhere = folder.path().join("nowhere");
    program()
        .arg("report")
        .arg(&nowhere)
        .assert()
        .code(2)
        .stderr(contains("nowhere").and(contains("resolved.toml")));
    program()
        .arg("merge")
        .arg(&nowhere)
        .arg("--out")
        .arg(&out)
        .assert()
        .code(2)
        .stderr(contains("nowhere"));
}

#[test]
fn shards_in_folders_of_their_own_merge_to_the_result_of_one_process() {
    let folder = TempDir::new().unwrap();
    let refined = CHEAP
        .replace("points = 60", "points = 12")
        .replace("[cycle]", "refine = true\n[cycle]");
    let file = write(&folder, "cheap.toml", &refined);
    let whole = folder.path().join("whole");
    sweep(&file, &whole, &["--quiet"]).success();
    let part = |k: usize| folder.path().join(format!("part-{k}"));
    for k in 1..=3 {
        let shard = format!("{k}/3");
        sweep(&file, &part(k), &["--shard", &shard])
            .success()
            .stdout(contains("4 of 4 cases are done").and(contains("merge")));
        assert!(part(k).join(format!("run-{k}-of-3.json")).exists());
    }
    let out = folder.path().join("out");
    let merge = |parts: &[usize]| {
        let mut command = program();
        command.arg("merge").args(parts.iter().map(|k| part(*k)));
        command.arg("--out").arg(&out).arg("--quiet").assert()
    };
    merge(&[1, 3])
        .code(1)
        .stderr(contains("4 of 12 cases are in none of the parts"))
        .stderr(contains("case 1: ω = "));
    merge(&[1, 2, 3]).success();
    assert_same(&out, &whole);
    sweep(
        &file,
        &part(4),
        &["--quiet", "--shard", "1/3", "--set", "cycle.steps=48"],
    )
    .success();
    merge(&[1, 2, 4])
        .code(2)
        .stderr(contains("another sweep").and(contains("+ steps = 48")));
}

#[test]
fn shards_in_one_folder_end_with_the_result_of_one_process() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let (whole, out) = (whole_cheap(), folder.path().join("out"));
    sweep(&file, &out, &["--quiet", "--shard", "2/3"]).success();
    // The same shard twice, and the two others, all at once.
    let shards = ["1/3", "2/3", "3/3", "3/3"];
    let children: Vec<Child> = shards
        .into_iter()
        .map(|shard| start(&file, &out, &["--shard", shard, "--threads", "1"]))
        .collect();
    for mut child in children {
        assert_eq!(child.wait().unwrap().code(), Some(0));
    }
    assert_same(&out, &whole);
    sweep(&file, &out, &["--shard", "4/3"])
        .code(2)
        .stderr(contains("2/8"));
}

#[test]
fn tables_and_figures_are_drawn_again_from_records_alone() {
    let folder = TempDir::new().unwrap();
    let (whole, out) = (whole_cheap(), copy_of_cheap(&folder));
    for name in [
        "sweep.csv",
        "summary.json",
        "energy-loss.svg",
        "loops@2x.png",
    ] {
        fs::remove_file(out.join(name)).unwrap();
    }
    fs::remove_dir_all(out.join("loops")).unwrap();
    let report = || {
        let mut command = program();
        command.arg("report").arg(&out).assert()
    };
    report().success().stdout(contains("Peak: "));
    assert_same(&out, &whole);
    // Without the losses that locate the peak everything else is drawn, and what the peak takes is said.
    let records = segments::read(&out);
    let (cases, peaks): (Vec<_>, Vec<_>) = records.into_iter().partition(Stored::is_of_sweep);
    assert!(!peaks.is_empty());
    segments::replace(&out, &cases);
    fs::remove_file(out.join("energy-loss.svg")).unwrap();
    let printed = report().success().get_output().stdout.clone();
    let printed = String::from_utf8(printed).unwrap();
    let words = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    for said in [
        "Peak not located: losses near ",
        " have no record in ",
        "`contact-dma sweep FILE --out ",
    ] {
        assert!(words.contains(said), "{printed}");
    }
    assert!(!words.contains("nterrupted"), "{printed}");
    assert!(out.join("energy-loss.svg").exists());
    let summary = fs::read_to_string(out.join("summary.json")).unwrap();
    assert!(summary.contains("\"interrupted\": false"), "{summary}");
    // A record that is gone leaves a gap; nothing is solved for it.
    let without: Vec<_> = cases
        .iter()
        .chain(&peaks)
        .filter(|r| **r != cases[5])
        .cloned()
        .collect();
    segments::replace(&out, &without);
    report().code(3).stdout(contains("59 of 60 cases are done"));
    assert_eq!(segments::read(&out), without);
}

#[test]
fn more_threads_than_any_machine_has_a_use_for_are_not_started() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let (few, many) = (folder.path().join("few"), folder.path().join("many"));
    sweep(&file, &few, &["--quiet", "--threads", "1"]).success();
    sweep(&file, &many, &["--quiet", "--threads", "100000"]).success();
    assert_same(&few, &many);
    let run = fs::read(many.join("run.json")).unwrap();
    let run: serde_json::Value = serde_json::from_slice(&run).unwrap();
    let processors = std::thread::available_parallelism().unwrap().get();
    assert_eq!(run["threads"], 4 * processors);
    let processor = run["processor"].as_str().unwrap();
    assert!(processor.starts_with(std::env::consts::ARCH), "{processor}");
}

#[test]
fn pictures_and_run_json_say_where_they_come_from() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let out = folder.path().join("out");
    sweep(&file, &out, &["--quiet", "--threads", "2"]).success();
    let json = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&fs::read(out.join(name)).unwrap()).unwrap()
    };
    let (run, summary) = (json("run.json"), json("summary.json"));
    let hash = summary["sweep_hash"].as_str().unwrap();
    assert_eq!(run["sweep_hash"], hash);
    assert_eq!(run["program_version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(run["build"], contact_dma::sweep::store::provenance::BUILD);
    assert_eq!(
        (&run["threads"], &run["cases_computed"]),
        (&2.into(), &60.into())
    );
    assert_eq!(run["engine"], "axisymmetric");
    for time in ["wall_time_s", "cpu_time_s"] {
        let time = run[time].as_f64().unwrap();
        assert!((0.0..600.0).contains(&time));
    }
    let started = run["started"].as_str().unwrap();
    assert!(started.ends_with('Z') && started.len() == 20, "{started}");
    let svg = fs::read_to_string(out.join("energy-loss.svg")).unwrap();
    let metadata = format!("sweep sha256 {hash}</metadata>");
    assert!(svg.contains(&metadata));
    let png = fs::read(out.join("loops@2x.png")).unwrap();
    let text = format!("Source\0sweep sha256 {hash}");
    assert!(
        png.windows(text.len())
            .any(|window| window == text.as_bytes())
    );
}

#[test]
fn a_plan_tells_cases_and_cost_and_computes_nothing() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "cheap.toml", CHEAP);
    let out = folder.path().join("out");
    let telling = || {
        contains("60 cases on 64 springs")
            .and(contains("Time: about"))
            .and(contains("Memory: about"))
            .and(contains("Shards: 1"))
    };
    program()
        .args(["plan", &file])
        .assert()
        .success()
        .stdout(telling());
    sweep(&file, &out, &["--dry-run"])
        .success()
        .stdout(telling());
    assert!(!out.exists());
}

#[test]
fn a_comparison_finds_a_shifted_peak_and_a_missing_case() {
    let folder = TempDir::new().unwrap();
    let baseline = whole_cheap();
    let compare = |new: &Path, more: &[&str]| {
        let mut command = program();
        command.arg("compare").arg(&baseline).arg(new).args(more);
        command.assert()
    };
    let drawn = folder.path().join("drawn");
    compare(&baseline, &["--out", drawn.to_str().unwrap()])
        .success()
        .stdout(contains("60 cases in both").and(contains("are the same")));
    for name in ["comparison.svg", "comparison.png", "comparison.csv"] {
        assert!(drawn.join(name).is_file(), "{name}");
    }
    // Only the files that a comparison reads, changed in one place.
    let planted = |name: &str, change: &dyn Fn(&str, String) -> String| {
        let new = folder.path().join(name);
        fs::create_dir(&new).unwrap();
        for file in ["sweep.csv", "summary.json"] {
            let text = fs::read_to_string(baseline.join(file)).unwrap();
            fs::write(new.join(file), change(file, text)).unwrap();
        }
        new
    };
    let shifted = planted("shifted", &|file, text| {
        if file == "sweep.csv" {
            return text;
        }
        let mut summary: serde_json::Value = serde_json::from_str(&text).unwrap();
        let omega = &mut summary["peaks"][0]["angular_frequency_rad_per_s"];
        *omega = (omega.as_f64().unwrap() * 1.003).into();
        summary.to_string()
    });
    compare(&shifted, &[])
        .code(4)
        .stdout(contains("moved by +0.3 %").and(contains("differ")));
    compare(&shifted, &["--relative", "1e-2"]).success();
    let missing = planted("missing", &|file, text| {
        if file != "sweep.csv" {
            return text;
        }
        let lines = text.lines().enumerate().filter(|(line, _)| *line != 7);
        lines.map(|(_, line)| format!("{line}\n")).collect()
    });
    compare(&missing, &[])
        .code(4)
        .stdout(contains("1 cases missing in the new result").and(contains("ω = 2.019e-3 rad/s")));
    compare(&missing.join("sweep.csv"), &[]).code(4);
    compare(Path::new("/no/such"), &[])
        .code(2)
        .stderr(contains("/no/such"));
    compare(&baseline, &["--relative", "-1"]).code(2);
    compare(&baseline, &["--tolerance", "nothing=1"])
        .code(2)
        .stderr(contains("no column nothing"));
}

#[test]
fn a_sweep_that_was_moved_with_its_data_and_renamed_goes_on() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    let sweep = |file: &str, data: &str| {
        let text = CHEAP
            .replace(
                "shape = \"sphere\"\nradius = \"10 mm\"",
                "shape = \"profile\"\nfile = \"DATA\"",
            )
            .replace("points = 60", "points = 3")
            .replace("DATA", data);
        fs::write(at(file), text).unwrap();
    };
    let run = |file: &str, out: &str| {
        let mut command = program();
        command
            .args(["sweep", "--quiet"])
            .arg(at(file))
            .arg("--out")
            .arg(at(out));
        command.assert()
    };
    let found = |out: &str| {
        let text = fs::read_to_string(at(out).join("run.json")).unwrap();
        let run: serde_json::Value = serde_json::from_str(&text).unwrap();
        (run["cases_computed"].as_u64(), run["cases_found"].as_u64())
    };
    fs::create_dir(at("here")).unwrap();
    let tip = "r_m,gap_m\n0,0\n1e-3,5e-5\n2e-3,2e-4\n4e-3,8e-4\n";
    fs::write(at("here/tip.csv"), tip).unwrap();
    sweep("here/sweep.toml", "tip.csv");
    run("here/sweep.toml", "here/out").success();
    assert_eq!(found("here/out"), (Some(3), Some(0)));

    fs::rename(at("here"), at("there")).unwrap();
    fs::rename(at("there/tip.csv"), at("there/point.csv")).unwrap();
    fs::remove_file(at("there/sweep.toml")).unwrap();
    sweep("there/other.toml", "point.csv");
    run("there/other.toml", "there/out").success();
    assert_eq!(found("there/out"), (Some(0), Some(3)));
    // The folder knows where the data lie now.
    program()
        .arg("report")
        .arg(at("there/out"))
        .assert()
        .success();

    fs::write(at("there/point.csv"), tip.replace("8e-4", "9e-4")).unwrap();
    run("there/other.toml", "there/out")
        .code(2)
        .stderr(contains("sha256"));
}
