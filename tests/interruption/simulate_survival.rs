//! What a single history survives: it goes on from its checkpoint, and ends as if undisturbed, bit for bit.

use std::fs;
use std::path::Path;
use std::process::Child;
use std::time::{Duration, Instant, SystemTime};

use crate::kills::{
    assert_same, damage, kill_at_any_moment, leave_half_a_file, newest, results,
    set_clock_back_and_forth, stopped, wait_for,
};
use crate::program::{Place, Run, says};

/// Contact on cells that opens and closes, jumps, and is asked for surfaces early and late.
const CELLS: &str = include_str!("../inputs/opens-and-closes.toml");

/// A fluid, whose flow is remembered too, on springs.
const FLUID: &str = include_str!("../inputs/fluid.toml");

/// The whole past, summed at every step.
const DIRECT: &str = include_str!("../inputs/direct-sum.toml");

/// A folder with a history.
fn of(text: &str) -> Place {
    Place::with("history.toml", text)
}

/// Follows the history of a folder, into `out`.
fn simulate(place: &Place, more: &str) -> Run {
    place.run(&format!("simulate history.toml --out out {more}"))
}

/// Starts that.
fn start(place: &Place, more: &[&str]) -> Child {
    let file = place.path("history.toml");
    let arguments = [&["simulate", file.to_str().unwrap()], more].concat();
    crate::kills::start(&arguments, &place.path("out"))
}

const OFTEN: [&str; 2] = ["--checkpoint-every", "0"];

/// Waits until there is a checkpoint of another time than this, be it a wrong one, then a little longer.
fn wait_for_progress(folder: &Path, before: Option<SystemTime>) {
    let is_new = || newest(folder).is_some_and(|time| Some(time) != before);
    wait_for("no checkpoint was written", is_new);
    std::thread::sleep(Duration::from_millis(30));
}

#[test]
fn a_history_goes_on_from_its_checkpoint_and_ends_with_the_same_bits() {
    for (name, text) in [("cells", CELLS), ("fluid", FLUID), ("direct", DIRECT)] {
        let place = of(text);
        let run = place.done("simulate history.toml --quiet --out whole");
        assert_eq!(run.stderr, "");
        assert!(!place.has("whole/records/checkpoints"));
        let out = place.path("out");
        let checkpoints = out.join("records/checkpoints");
        for how in ["-KILL", "-TERM", "-KILL"] {
            let child = start(&place, &OFTEN);
            wait_for_progress(&checkpoints, newest(&checkpoints));
            stopped(child, how);
            assert!(checkpoints.join("history").exists(), "{name}: too quick");
            set_clock_back_and_forth(&out);
        }
        let said = simulate(&place, "").ended(0).stderr;
        assert!(said.contains("steps were already done"), "{said}");
        assert!(!said.contains(" 0 of"), "{said}");
        assert!(!checkpoints.exists());
        assert_same(&out, &place.path("whole"));
    }
}

/// Ten kills; `CONTACT_DMA_KILLS=100 cargo test --test interruption simulate_survival` for more.
#[test]
fn kills_at_any_moment_lose_nothing() {
    let place = of(CELLS);
    let started = Instant::now();
    place.done("simulate history.toml --quiet --out whole");
    let end = || {
        simulate(&place, "--quiet").ended(0);
        assert_same(&place.path("out"), &place.path("whole"));
        fs::remove_dir_all(place.path("out")).unwrap();
    };
    kill_at_any_moment(started.elapsed(), 20_261_121, || start(&place, &OFTEN), end);
}

#[test]
fn a_termination_is_heard_within_a_long_instant_and_leaves_a_checkpoint() {
    let place = of(CELLS);
    let fine = "solver.tolerance=1e-13";
    let child = start(&place, &["--set", "solver.cells=512", "--set", fine]);
    let plan = place.path("out/resolved.toml");
    wait_for("the history did not start", || plan.exists());
    std::thread::sleep(Duration::from_secs(4));
    let took = stopped(child, "-TERM");
    assert!(took < Duration::from_secs(2), "{took:?}");
    assert!(place.has("out/records/checkpoints/history"));
}

#[test]
fn a_damaged_checkpoint_is_named_and_not_used() {
    let place = of(FLUID);
    let out = place.path("out");
    place.done("simulate history.toml --quiet --out whole");
    let child = start(&place, &OFTEN);
    let path = out.join("records/checkpoints/history");
    wait_for("no checkpoint was written", || path.exists());
    stopped(child, "-KILL");
    damage(&path);
    // What was being written when the process was killed is swept out of every folder.
    for name in ["cases/profiles", "cases/fields"] {
        leave_half_a_file(&out.join(name));
    }
    let said = simulate(&place, "").ended(0).stderr;
    let damaged = "records/checkpoints/history: it is damaged or torn";
    says(&said, &[damaged, "from its beginning"]);
    assert_same(&out, &place.path("whole"));
}

#[test]
fn a_changed_scenario_is_refused_and_its_checkpoint_stays() {
    let place = of(FLUID);
    let out = place.path("out");
    let child = start(&place, &OFTEN);
    wait_for_progress(&out.join("records/checkpoints"), None);
    stopped(child, "-TERM");
    let before = results(&out);
    let changed = "--set 'time.step=\"0.3 s\"'";
    let refused = simulate(&place, changed).ended(2).stderr;
    says(&refused, &["- step = \"0.1 s\"", "+ step = \"0.3 s\""]);
    assert_eq!(results(&out), before);
    let forced = simulate(&place, &format!("{changed} --force")).ended(0);
    assert_eq!(forced.stderr, "");
}
