//! What a sweep survives, and how parts of one come together: every end result is that of an undisturbed run, bit for bit.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command as Process, Stdio};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use crate::kills::{
    assert_same, damage, kill_at_any_moment, leave_half_a_file, newest, results,
    set_clock_back_and_forth, signal, stopped, wait_for,
};
use crate::program::{Place, Run, below, says};
use crate::segments::{self, Stored};

/// Sixty cases of a few milliseconds.
const CHEAP: &str = include_str!("../inputs/cheap.toml");

/// One case that marches through thousands of cycles.
const LONG: &str = include_str!("../inputs/long.toml");

/// A folder with a sweep file.
fn of(text: &str) -> Place {
    Place::with("sweep.toml", text)
}

/// A sweep that nothing disturbs.
fn undisturbed(text: &str) -> Place {
    let place = of(text);
    let run = place.done("sweep sweep.toml --quiet --out whole");
    assert_eq!(run.stderr, "");
    place
}

/// [`CHEAP`] and [`LONG`] undisturbed, computed once for all tests.
static WHOLE: [LazyLock<Place>; 2] = [
    LazyLock::new(|| undisturbed(CHEAP)),
    LazyLock::new(|| undisturbed(LONG)),
];

fn whole_cheap() -> PathBuf {
    WHOLE[0].path("whole")
}

fn whole_long() -> PathBuf {
    WHOLE[1].path("whole")
}

fn copy(from: &Path, to: &Path) {
    let copied = Process::new("cp").arg("-r").args([from, to]).status();
    assert!(copied.unwrap().success());
}

/// A copy of [`whole_cheap`] in `out`, to be damaged.
fn copy_of_cheap() -> (Place, PathBuf) {
    let place = of(CHEAP);
    let out = place.path("out");
    copy(&whole_cheap(), &out);
    (place, out)
}

/// Starts the sweep of a folder, into `out`.
fn start(place: &Place, more: &[&str]) -> Child {
    let file = place.path("sweep.toml");
    let arguments = [&["sweep", file.to_str().unwrap()], more].concat();
    crate::kills::start(&arguments, &place.path("out"))
}

/// Runs the sweep of a folder, into `out`.
fn sweep(place: &Place, more: &str) -> Run {
    place.run(&format!("sweep sweep.toml --out out {more}"))
}

#[test]
fn finished_cases_are_read_and_damaged_ones_named_and_computed_again() {
    let (place, out) = copy_of_cheap();
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
    let again = sweep(&place, "--threads 1").ended(0).stderr;
    says(&again, &["48 of 60 cases were already done", &named]);
    says(&again, &["torn.segment: its last", "without its end"]);
    assert_same(&out, &whole_cheap());
    let again = sweep(&place, "").ended(0).stderr;
    says(&again, &["60 of 60 cases were already done"]);
    assert_same(&out, &whole_cheap());
}

#[test]
fn a_record_of_a_newer_program_is_not_replaced_unless_told_to() {
    let place = of(CHEAP);
    let out = place.path("out");
    let one = "--quiet --set sweep.angular_frequency=[0.01]";
    sweep(&place, one).ended(0);
    let whole = results(&out);
    let mut records = segments::read(&out);
    let version = &records[0].heading.program_version;
    assert_eq!(version, env!("CARGO_PKG_VERSION"));
    records[0].heading.program_version = "1000.0.0".to_owned();
    segments::replace(&out, &records);
    let newer = sweep(&place, one).ended(2).stderr;
    says(&newer, &["1000.0.0", "--force"]);
    assert_eq!(segments::read(&out), records);
    sweep(&place, &format!("{one} --force")).ended(0);
    let mut own = segments::read(&out);
    own.retain(|record| *record != records[0]);
    segments::replace(&out, &own);
    assert_eq!(results(&out), whole);
}

#[test]
fn records_of_another_build_are_computed_again_by_a_sweep_and_shown_by_a_report() {
    let (place, out) = copy_of_cheap();
    let mut records = segments::read(&out);
    records[5].heading.build = "0123456789abcdef".to_owned();
    segments::replace(&out, &records);
    let of_another = "one.segment: it was written by another build";
    let report = place.done("report out").stderr;
    says(&report, &[of_another, "as they are"]);
    assert_eq!(segments::read(&out), records);
    // One result is that of one build.
    let merge = place.ends("merge out --out merged", 1);
    let missing = "1 of 60 cases are in none of the parts";
    says(&merge, &[of_another, missing]);
    let again = sweep(&place, "").ended(0).stderr;
    let done = "59 of 60 cases were already done";
    says(&again, &[done, of_another, "again"]);
    let mut own = segments::read(&out);
    own.retain(|record| *record != records[5]);
    segments::replace(&out, &own);
    assert_same(&out, &whole_cheap());
}

/// Ten kills; `CONTACT_DMA_KILLS=100 cargo test --test interruption survival` for more.
#[test]
fn kills_at_any_moment_lose_nothing() {
    let place = of(CHEAP);
    let started = Instant::now();
    place.done("sweep sweep.toml --quiet --out whole");
    let end = || {
        sweep(&place, "--quiet").ended(0);
        assert_same(&place.path("out"), &place.path("whole"));
        fs::remove_dir_all(place.path("out")).unwrap();
    };
    kill_at_any_moment(started.elapsed(), 20_260_801, || start(&place, &[]), end);
}

#[test]
fn a_long_case_goes_on_from_its_checkpoint_and_ends_with_the_same_bits() {
    let searched = LONG
        .replace("method = \"march\"\ntolerance = 1e-9", "tolerance = 1e-12")
        .replace("steps = 200", "steps = 100000");
    let cells = LONG
        .replace("10 rad/s", "0.6 rad/s")
        .replace("steps = 200", "steps = 48")
        .replace("springs = 160", "engine = \"half-space\"\ncells = 32");
    let ways = [("march", LONG), ("search", &searched), ("cells", &cells)];
    for (name, text) in ways {
        let place = of(text);
        let whole = match name {
            "march" => whole_long(),
            _ => {
                place.done("sweep sweep.toml --quiet --out whole");
                place.path("whole")
            }
        };
        let out = place.path("out");
        let case = out.join("records/checkpoints/0000");
        for how in ["-KILL", "-TERM"] {
            let often = ["--checkpoint-every", "0", "--threads", "1"];
            let child = start(&place, &often);
            let before = newest(&case);
            wait_for("no checkpoint was written", || newest(&case) > before);
            std::thread::sleep(Duration::from_millis(30));
            stopped(child, how);
            assert_eq!(segments::count(&out), 0, "{name}: too quick");
        }
        sweep(&place, "--quiet").ended(0);
        assert!(!out.join("records/checkpoints").exists());
        assert_same(&out, &whole);
    }
}

/// A clock that was wrong when files were written, or has been set since: times of files, in the far past and in the future,
/// decide nothing.
#[test]
fn a_clock_that_jumps_between_interruption_and_resumption_changes_nothing() {
    for (text, whole, what) in [
        (CHEAP, whole_cheap(), "records"),
        (LONG, whole_long(), "records/checkpoints/0000"),
    ] {
        let place = of(text);
        let out = place.path("out");
        let child = start(&place, &["--checkpoint-every", "0", "--threads", "1"]);
        wait_for("nothing was written", || newest(&out.join(what)).is_some());
        stopped(child, "-TERM");
        // What a killed process leaves is swept out, however old or young it claims to be.
        let left_over = leave_half_a_file(&out);
        set_clock_back_and_forth(&out);
        let kept = segments::count(&out);
        let said = sweep(&place, "").ended(0).stderr;
        let found = format!("{kept} of 60 cases were already done");
        assert!(said.contains(&found) || said.contains("1/1"), "{said}");
        assert!(!said.contains("damaged"), "{said}");
        assert!(!left_over.exists());
        assert_same(&out, &whole);
        let run = place.json("out/run.json");
        let wall_s = run["wall_time_s"].as_f64().unwrap();
        assert!((0.0..600.0).contains(&wall_s), "{wall_s}");
    }
}

/// Intervals are taken from a clock that cannot jump: the other one is asked in one place, for the stamps of run.json.
#[test]
fn the_time_of_day_is_asked_for_stamps_alone() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let words = "SystemTime UNIX_EPOCH .modified() .created() .accessed()";
    let asks = |path: &PathBuf| {
        let text = fs::read_to_string(path).unwrap();
        words.split(' ').any(|word| text.contains(word))
    };
    let asking = below(&src, "rs").into_iter().filter(asks);
    let asking = asking.map(|path| path.file_name().unwrap().to_owned());
    let mut asking: Vec<_> = asking.collect();
    asking.sort();
    // The other asks when a plan was written, to see whether it is still the one that was read.
    assert_eq!(asking, ["mod.rs", "provenance.rs"]);
}

#[test]
fn a_damaged_checkpoint_is_passed_over() {
    let place = of(LONG);
    let child = start(&place, &["--checkpoint-every", "0"]);
    let path = place
        .path("out")
        .join("records/checkpoints/0000/00.finished");
    wait_for("no checkpoint was written", || path.exists());
    stopped(child, "-KILL");
    damage(&path);
    sweep(&place, "--quiet").ended(0);
    assert_same(&place.path("out"), &whole_long());
}

#[test]
fn a_termination_is_heard_within_an_instant_of_the_finest_grid() {
    let place = of(CHEAP);
    let out = place.path("out");
    let engine = "solver.engine=\"half-space\"";
    let child = start(&place, &["--set", engine, "--set", "solver.cells=256"]);
    let plan = out.join("resolved.toml");
    wait_for("the sweep did not start", || plan.exists());
    std::thread::sleep(Duration::from_secs(2));
    let waited = stopped(child, "-TERM");
    assert!(waited < Duration::from_secs(2), "{waited:?}");
}

/// Of more than 200 cases only those that figures choose have files of their own, and a partial report chooses others.
#[test]
fn the_files_of_a_partial_report_of_a_large_sweep_do_not_outlast_it() {
    let many = CHEAP.replace("points = 60", "points = 240") + "[figures]\nformats = [\"svg\"]\n";
    let place = of(&many);
    let out = place.path("out");
    place.done("sweep sweep.toml --quiet --out whole");
    let mut child = start(&place, &["--threads", "1"]);
    wait_for("no record was written", || {
        newest(&out.join("records")).is_some()
    });
    signal(&child, "-INT");
    if child.wait().unwrap().code() == Some(130) {
        let chosen = |out: &Path| fs::read_dir(out.join("cases/loops")).unwrap().count();
        assert!(chosen(&out) > 0 && out.join("run.json").exists());
    }
    // A file of the user stays.
    place.put("out/cases/work/notes.txt", "mine");
    sweep(&place, "--quiet").ended(0);
    assert_eq!(place.text("out/cases/work/notes.txt"), "mine");
    fs::remove_file(out.join("cases/work/notes.txt")).unwrap();
    assert_same(&out, &place.path("whole"));
}

#[test]
fn a_second_interrupt_ends_the_program_at_once_and_the_next_run_goes_on() {
    let place = of(CHEAP);
    let out = place.path("out");
    let child = start(&place, &["--threads", "1"]);
    wait_for("no case was finished", || segments::count(&out) > 2);
    signal(&child, "-INT");
    stopped(child, "-INT");
    sweep(&place, "--quiet").ended(0);
    assert_same(&out, &whole_cheap());
}

#[test]
fn an_interrupted_sweep_says_so_and_has_a_table_of_what_is_finished() {
    let slow = CHEAP.replace("points = 60", "points = 400");
    let place = of(&slow.replace("steps = 40", "steps = 2000"));
    let out = place.path("out");
    let child = Process::new(assert_cmd::cargo::cargo_bin("contact-dma"))
        .current_dir(place.path(""))
        .args(["sweep", "sweep.toml", "--threads", "1", "--out", "out"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    wait_for("no case was finished", || segments::count(&out) > 1);
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    says(&String::from_utf8(output.stdout).unwrap(), &["Interrupted"]);
    let rows = place.table("out/sweep.csv").len();
    assert_eq!(rows, segments::count(&out));
    assert!(rows < 400);
}

#[test]
fn a_second_process_that_computes_the_same_sweep_is_refused_and_the_first_goes_on() {
    let place = of(CHEAP);
    let out = place.path("out");
    let mut first = start(&place, &["--threads", "1"]);
    wait_for("no case was finished", || segments::count(&out) > 2);
    for more in ["", "--shard 1/2"] {
        let refused = sweep(&place, more).ended(2).stderr;
        let parts = ["the same sweep is computed there", "--shard 1/2"];
        says(&refused, &parts);
    }
    assert_eq!(first.wait().unwrap().code(), Some(0));
    sweep(&place, "--quiet").ended(0);
    assert_same(&out, &whole_cheap());
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
    let place = of(CHEAP);
    let out = place.path("out");
    let Some(disk) = Small::mount(&out, "size=200k") else {
        println!("skipped: no small file system can be mounted here");
        return;
    };
    let full = sweep(&place, "--quiet").ended(1).stderr;
    says(&full, &["cannot write", "No space left"]);
    let records = segments::count(&out);
    assert!(records > 0);
    let kept = place.path("kept");
    copy(&out, &kept);
    drop(disk);
    fs::remove_dir(&out).unwrap();
    fs::rename(kept, &out).unwrap();
    // What was taken back has left no torn end.
    let again = sweep(&place, "").ended(0).stderr;
    let done = format!("{records} of 60 cases were already done");
    says(&again, &[&done]);
    assert!(!again.contains("torn"), "{again}");
    assert_same(&out, &whole_cheap());
}

#[test]
fn folders_that_cannot_be_written_or_are_not_there_are_named() {
    let place = of(CHEAP);
    let out = place.path("out");
    match Small::mount(&out, "size=200k,ro") {
        Some(_disk) => {
            let refused = sweep(&place, "--quiet").ended(1).stderr;
            says(&refused, &["out/resolved.toml", "Read-only"]);
        }
        None => println!("skipped: no read-only file system can be mounted here"),
    }
    // A file where the folder of records should be.
    place.put("blocked/records", "");
    let refused = place.ends("sweep sweep.toml --quiet --force --out blocked", 1);
    says(&refused, &["blocked/records"]);
}

#[test]
fn shards_in_folders_of_their_own_merge_to_the_result_of_one_process() {
    let refined = CHEAP.replace("points = 60", "points = 12");
    let place = of(&refined.replace("[cycle]", "refine = true\n[cycle]"));
    place.done("sweep sweep.toml --quiet --out whole");
    for k in 1..=3 {
        let part = place.done(&format!("sweep sweep.toml --shard {k}/3 --out part-{k}"));
        part.says(&["4 of 4 cases are done", "merge"]);
        assert!(place.has(&format!("part-{k}/records/run-{k}-of-3.json")));
    }
    let few = place.ends("merge part-1 part-3 --out out --quiet", 1);
    let missing = "4 of 12 cases are in none of the parts";
    says(&few, &[missing, "case 1: ω = "]);
    place.done("merge part-1 part-2 part-3 --out out --quiet");
    assert_same(&place.path("out"), &place.path("whole"));
    place.done("sweep sweep.toml --quiet --shard 1/3 --set cycle.steps=48 --out part-4");
    let other = place.ends("merge part-1 part-2 part-4 --out out --quiet", 2);
    says(&other, &["another sweep", "+ steps = 48"]);
}

#[test]
fn shards_in_one_folder_end_with_the_result_of_one_process() {
    let place = of(CHEAP);
    let out = place.path("out");
    sweep(&place, "--quiet --shard 2/3").ended(0);
    // The same shard twice, and the two others, all at once.
    let shards = ["1/3", "2/3", "3/3", "3/3"];
    let children = shards.map(|shard| start(&place, &["--shard", shard, "--threads", "1"]));
    for mut child in children {
        assert_eq!(child.wait().unwrap().code(), Some(0));
    }
    assert_same(&out, &whole_cheap());
}

#[test]
fn tables_and_figures_are_drawn_again_from_records_alone() {
    let (place, out) = copy_of_cheap();
    for name in "sweep.csv summary.json figures/energy-loss.svg figures/loops@2x.png".split(' ') {
        fs::remove_file(out.join(name)).unwrap();
    }
    fs::remove_dir_all(out.join("cases/loops")).unwrap();
    place.done("report out").says(&["Peak: "]);
    assert_same(&out, &whole_cheap());
    // Without the losses that locate the peak everything else is drawn, and what the peak takes is said.
    let records = segments::read(&out);
    let (cases, peaks): (Vec<_>, Vec<_>) = records.into_iter().partition(Stored::is_of_sweep);
    assert!(!peaks.is_empty());
    segments::replace(&out, &cases);
    fs::remove_file(out.join("figures/energy-loss.svg")).unwrap();
    let report = place.done("report out");
    assert!(!report.stdout.contains("nterrupted"), "{report:?}");
    let parts = ["Peak not located: losses near ", " have no record in "];
    report
        .says(&parts)
        .says(&["`contact-dma sweep FILE --out "]);
    assert!(out.join("figures/energy-loss.svg").exists());
    says(&place.text("out/summary.json"), &["\"interrupted\": false"]);
    // A record that is gone leaves a gap; nothing is solved for it.
    let without = [&cases[..5], &cases[6..], &peaks].concat();
    segments::replace(&out, &without);
    let report = place.run("report out").ended(3);
    report.says(&["59 of 60 cases are done"]);
    assert_eq!(segments::read(&out), without);
}

#[test]
fn more_threads_than_any_machine_has_a_use_for_are_not_started() {
    let place = of(CHEAP);
    place.done("sweep sweep.toml --quiet --threads 1 --out few");
    place.done("sweep sweep.toml --quiet --threads 100000 --out many");
    assert_same(&place.path("few"), &place.path("many"));
    let run = place.json("many/run.json");
    let processors = std::thread::available_parallelism().unwrap().get();
    assert_eq!(run["threads"], 4 * processors);
    let processor = run["processor"].as_str().unwrap();
    assert!(processor.starts_with(std::env::consts::ARCH), "{processor}");
}

#[test]
fn pictures_and_run_json_say_where_they_come_from() {
    let place = of(CHEAP);
    sweep(&place, "--quiet --threads 2").ended(0);
    let [run, summary] = ["run", "summary"].map(|name| place.json(&format!("out/{name}.json")));
    let hash = summary["sweep_hash"].as_str().unwrap();
    assert_eq!(run["sweep_hash"], hash);
    assert_eq!(run["program_version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(run["build"], contact_dma::sweep::store::provenance::BUILD);
    assert_eq!(run["threads"], 2);
    assert_eq!(run["cases_computed"], 60);
    assert_eq!(run["engine"], "axisymmetric");
    for time in ["wall_time_s", "cpu_time_s"] {
        let time = run[time].as_f64().unwrap();
        assert!((0.0..600.0).contains(&time));
    }
    let started = run["started"].as_str().unwrap();
    assert!(started.ends_with('Z') && started.len() == 20, "{started}");
    let svg = place.text("out/figures/energy-loss.svg");
    assert!(svg.contains(&format!("sweep sha256 {hash}</metadata>")));
    let png = place.bytes("out/figures/loops@2x.png");
    let text = format!("Source\0sweep sha256 {hash}");
    let mut windows = png.windows(text.len());
    assert!(windows.any(|window| window == text.as_bytes()));
}

#[test]
fn a_plan_tells_cases_and_cost_and_computes_nothing() {
    let place = of(CHEAP);
    for run in ["plan sweep.toml", "sweep sweep.toml --dry-run --out out"] {
        let cost = ["60 cases on 64 springs", "Time: about", "Memory: about"];
        place.done(run).says(&cost).says(&["Shards: 1"]);
    }
    assert!(!place.has("out"));
}

#[test]
fn a_sweep_that_was_moved_with_its_data_and_renamed_goes_on() {
    let place = Place::new();
    let put = |file: &str, data: &str| {
        let profile = format!("shape = \"profile\"\nfile = \"{data}\"");
        let text = CHEAP.replace("shape = \"sphere\"\nradius = \"10 mm\"", &profile);
        place.put(file, text.replace("points = 60", "points = 3"));
    };
    let found = |out: &str| {
        let run = place.json(&format!("{out}/run.json"));
        ["cases_computed", "cases_found"].map(|key| run[key].as_u64().unwrap())
    };
    let tip = "r_m,gap_m\n0,0\n1e-3,5e-5\n2e-3,2e-4\n4e-3,8e-4\n";
    place.put("here/tip.csv", tip);
    put("here/sweep.toml", "tip.csv");
    place.done("sweep here/sweep.toml --quiet --out here/out");
    assert_eq!(found("here/out"), [3, 0]);

    let rename = |from: &str, to: &str| fs::rename(place.path(from), place.path(to)).unwrap();
    rename("here", "there");
    rename("there/tip.csv", "there/point.csv");
    fs::remove_file(place.path("there/sweep.toml")).unwrap();
    put("there/other.toml", "point.csv");
    let other = "sweep there/other.toml --quiet --out there/out";
    place.done(other);
    assert_eq!(found("there/out"), [0, 3]);
    // The folder knows where the data lie now.
    place.done("report there/out");

    place.put("there/point.csv", tip.replace("8e-4", "9e-4"));
    assert!(place.refused(other).contains("sha256"));
}
