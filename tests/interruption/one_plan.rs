//! A folder has one plan: of different sweeps and scenarios that meet in it one goes on and the others are refused.

use std::collections::BTreeSet;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Output};

use crate::kills::{assert_same, signal, start, stopped, wait_for};
use crate::program::{Place, says};
use crate::segments;
use contact_dma::sweep::plan::resolved::hash;

/// Two hundred cases in place of three.
const MANY: &str = "--threads 1 --set sweep.angular_frequency={from=1e-3,to=1,points=200}";

/// Starts all of them and waits for their ends.
fn together(commands: &[Vec<&str>], out: &Path) -> Vec<Output> {
    let children: Vec<Child> = commands.iter().map(|c| start(c, out)).collect();
    let ends = children.into_iter().map(|child| child.wait_with_output());
    ends.map(Result::unwrap).collect()
}

/// A folder with two plans, of which the sweep is computed undisturbed in `whole`; the path of the sweep's file.
fn small() -> (Place, String) {
    let place = Place::lent("small.toml step.toml");
    place.done("sweep small.toml --quiet --out whole");
    let file = place.path("small.toml").to_str().unwrap().to_owned();
    (place, file)
}

/// The hashes that the plan, the records and the summary of a folder name; the number of records.
fn hashes(out: &Path) -> (BTreeSet<String>, usize) {
    let plan = fs::read_to_string(out.join("resolved.toml")).unwrap();
    let mut hashes = BTreeSet::from([hash(&plan)]);
    let records = segments::read(out);
    let of_records = records.iter().map(|stored| &stored.heading.sweep_hash);
    hashes.extend(of_records.cloned());
    if let Ok(summary) = fs::read(out.join("summary.json")) {
        let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
        let named = summary.get("sweep_hash").or(summary.get("scenario_hash"));
        hashes.insert(named.unwrap().as_str().unwrap().to_owned());
    }
    (hashes, records.len())
}

/// Who was refused says so, of this folder and for what to do; the others came to their end.
fn succeeded(ends: &[Output], out: &Path) -> Vec<bool> {
    let folder = out.file_name().unwrap().to_str().unwrap();
    let of = |end: &Output| match end.status.code() {
        Some(0) => true,
        Some(2) => {
            let text = String::from_utf8_lossy(&end.stderr);
            let is_told = text.contains(folder) && text.contains("another folder with --out");
            assert!(is_told && text.contains("\n  - ") && text.contains("\n  + "));
            false
        }
        other => panic!("{other:?}: {}", String::from_utf8_lossy(&end.stderr)),
    };
    ends.iter().map(of).collect()
}

#[test]
fn who_waits_for_the_lock_of_a_folder_says_so_and_goes_on_when_it_is_free() {
    let (place, file) = small();
    let out = place.path("whole");
    let lock = fs::File::open(out.join(".contact-dma.lock")).unwrap();
    lock.lock().unwrap();
    let mut child = start(&["sweep", &file], &out);
    let mut told = [0; 12];
    let stderr = child.stderr.as_mut().unwrap();
    stderr.read_exact(&mut told).unwrap();
    assert_eq!(&told, b"waiting for ");
    lock.unlock().unwrap();
    assert!(child.wait().unwrap().success());
}

#[test]
fn of_different_plans_that_begin_at_once_one_is_computed_and_the_others_are_refused() {
    let (place, file) = small();
    let scenario = place.path("step.toml");
    let scenario = scenario.to_str().unwrap();
    let commands = [
        vec!["sweep", &file],
        vec!["sweep", &file, "--set", "cycle.steps=32"],
        vec!["simulate", scenario],
    ];
    for round in 0..30 {
        let out = place.path(&format!("round-{round}"));
        let mut order = commands.clone();
        order.rotate_left(round % 3);
        let done = succeeded(&together(&order, &out), &out);
        assert_eq!(done.iter().filter(|done| **done).count(), 1, "{round}");
        assert_eq!(hashes(&out).0.len(), 1, "round {round}");
    }
}

#[test]
fn shards_of_one_sweep_share_a_folder_and_nothing_else_joins_them() {
    let (place, file) = small();
    let commands = [
        vec!["sweep", &file, "--shard", "1/2"],
        vec!["sweep", &file, "--set", "cycle.steps=32"],
        vec!["sweep", &file, "--shard", "2/2"],
    ];
    for round in 0..6 {
        let out = place.path(&format!("round-{round}"));
        let done = succeeded(&together(&commands, &out), &out);
        match done[..] {
            [true, false, true] => assert_same(&out, &place.path("whole")),
            [false, true, false] => {}
            _ => panic!("round {round}: {done:?}"),
        }
        assert_eq!(hashes(&out).0.len(), 1, "round {round}");
    }
}

/// Stops a process until it gets the signal to go on, and waits until every thread of it has stopped.
fn stop(child: &Child) {
    signal(child, "-STOP");
    let threads = format!("/proc/{}/task", child.id());
    wait_for("the process did not stop", || {
        fs::read_dir(&threads).unwrap().all(|thread| {
            let stat = fs::read_to_string(thread.unwrap().path().join("stat"));
            stat.is_ok_and(|stat| stat.contains(") T "))
        })
    });
}

/// A sweep of [`MANY`] that has some of its records.
fn begun(file: &str, out: &Path) -> Child {
    let words = ["sweep", file].into_iter().chain(MANY.split(' '));
    let child = start(&words.collect::<Vec<_>>(), out);
    wait_for("no case was finished", || segments::count(out) > 2);
    child
}

#[test]
fn what_runs_is_neither_replaced_nor_joined_by_another_and_loses_nothing() {
    let (place, file) = small();
    let out = place.path("out");
    let running = begun(&file, &out);
    // However slow this machine, it does not end before it has been disturbed.
    stop(&running);
    let before = hashes(&out);
    let sweep = "sweep small.toml --quiet --out";
    let full = out.display();
    for line in [
        format!("{sweep} '{full}' --force"),
        format!("{sweep} '{full}' {MANY} --force"),
        format!("{sweep} '{full}'"),
        format!("merge '{full}' --force --out '{full}'"),
    ] {
        let told = place.ends(&line, 2);
        says(&told, &["/out is in use", "another folder with --out"]);
        let is_named = told.contains("PMMA under a sphere");
        // Unforced, what differs is told.
        let differs = told.contains("+ angular_frequency") || told.contains("-     \"0.001");
        let is_forced = line.contains("--force");
        assert!(if is_forced { is_named } else { differs }, "{told}");
    }
    assert_eq!(hashes(&out), before);
    signal(&running, "-CONT");
    let end = running.wait_with_output().unwrap();
    assert_eq!(end.status.code(), Some(0));
    // The peaks that were located have records too.
    let (plans, records) = hashes(&out);
    assert!(plans.len() == 1 && records >= 200, "{plans:?} {records}");
}

/// Machines that share a file system without locks, as far as one machine can be two: the lock is another file for each.
#[test]
fn a_run_that_is_replaced_where_locks_reach_nobody_stops_and_leaves_the_folder_to_the_other() {
    let (place, file) = small();
    let out = place.path("out");
    // One case that takes seconds: it is stopped while it computes, not while it writes its results. A checkpoint is due at every
    // moment, so that one would be written into the folder that is no longer its own.
    let set = "sweep.angular_frequency=[20] cycle.method=\"march\" cycle.steps=200 cycle.tolerance=1e-9 cycle.max_cycles=100000 \
               solver.springs=100";
    let set = set.split(' ').flat_map(|assignment| ["--set", assignment]);
    let long = ["sweep", &file, "--checkpoint-every", "0"];
    let long: Vec<&str> = long.into_iter().chain(set).collect();
    let replaced = start(&long, &out);
    let lock = out.join(".contact-dma.compute.lock");
    wait_for("the sweep did not start", || lock.exists());
    stop(&replaced);
    assert_eq!(segments::count(&out), 0, "too quick");
    for lock in [".contact-dma.lock", ".contact-dma.compute.lock"] {
        let lock = out.join(lock);
        let content = fs::read(&lock).unwrap();
        fs::remove_file(&lock).unwrap();
        fs::write(&lock, content).unwrap();
    }
    place.done("sweep small.toml --quiet --out out --force");
    signal(&replaced, "-CONT");
    let end = replaced.wait_with_output().unwrap();
    assert_eq!(end.status.code(), Some(1));
    let told = String::from_utf8_lossy(&end.stderr);
    says(&told, &["/out was taken from this run"]);
    assert_same(&out, &place.path("whole"));
}

#[test]
fn a_killed_process_leaves_its_folder_to_the_next_one_whatever_that_is() {
    let (place, file) = small();
    for (out, more, records) in [("out", MANY, 200), ("few", "--force", 2)] {
        let folder = place.path(out);
        let killed = begun(&file, &folder);
        stopped(killed, "-KILL");
        place.done(&format!("sweep small.toml --quiet --out {out} {more}"));
        let (plans, found) = hashes(&folder);
        assert!(plans.len() == 1 && found >= records, "{plans:?} {found}");
    }
    assert_same(&place.path("few"), &place.path("whole"));
}
