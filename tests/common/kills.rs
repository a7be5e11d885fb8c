//! Programs that are started to be killed, and folders that must come out the same.

#![allow(dead_code)] // Each test file uses its own part.

use crate::program::files;
use crate::random::Random;
use crate::segments;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command as Process, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// The files that must not depend on how a run came to its end.
pub fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = files(folder);
    files.retain(|path, _| {
        let name = path.rsplit('/').next().unwrap();
        // The lock file lists what was written last, where other processes were at work at the end.
        let is_own = ["run", ".contact-dma."]
            .iter()
            .any(|own| name.starts_with(own));
        !is_own && !path.ends_with(".segment")
    });
    // Records lie in segments in the order in which they were finished, and some of them twice.
    let mut records = segments::read(folder);
    records.dedup();
    let records = records.into_iter().enumerate();
    files.extend(records.map(|(k, stored)| {
        let heading = format!("{:?}", stored.heading).into_bytes();
        let name = format!("records, number {k}");
        (name, [heading, stored.record].concat())
    }));
    files
}

#[track_caller]
pub fn assert_same(found: &Path, expected: &Path) {
    let (found, expected) = (results(found), results(expected));
    let names = |files: &BTreeMap<String, _>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&found), names(&expected));
    for (name, bytes) in &found {
        assert!(*bytes == expected[name], "{name} differs");
    }
}

/// Leaves what a process of this machine that is killed while it writes into this folder leaves; its path.
pub fn leave_half_a_file(folder: &Path) -> PathBuf {
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap();
    let path = folder.join(format!(".contact-dma-{}~left", host.trim()));
    fs::create_dir_all(folder).unwrap();
    fs::write(&path, "half").unwrap();
    path
}

/// Starts the program with these arguments and an output folder; what it says on standard error can be read.
pub fn start(arguments: &[&str], out: &Path) -> Child {
    Process::new(assert_cmd::cargo::cargo_bin("contact-dma"))
        .args(arguments)
        .args(["--quiet", "--out"])
        .arg(out)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

pub fn signal(child: &Child, name: &str) {
    let sent = Process::new("kill")
        .args([name, &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
}

/// Ends a run by a signal, which it hears unless it is killed by it; how long that takes.
#[track_caller]
pub fn stopped(mut child: Child, how: &str) -> Duration {
    let sent = Instant::now();
    signal(&child, how);
    let code = child.wait().unwrap().code();
    assert_eq!(code, (how != "-KILL").then_some(130), "{how}");
    sent.elapsed()
}

/// Changes a bit in the middle of a file.
pub fn damage(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(path, bytes).unwrap();
}

pub fn wait_for(what: &str, ready: impl Fn() -> bool) {
    let started = Instant::now();
    while !ready() {
        assert!(started.elapsed() < Duration::from_secs(120), "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Kills what `start` begins at any moment of a run, so many times in all: several kills on one folder, until a run comes to its end
/// before its kill; then `end` looks at the folder and clears it.
pub fn kill_at_any_moment(span: Duration, seed: u64, start: impl Fn() -> Child, end: impl Fn()) {
    let kills = std::env::var("CONTACT_DMA_KILLS").map_or(10, |text| text.parse().unwrap());
    let (mut random, mut killed) = (Random(seed), 0);
    while killed < kills {
        loop {
            let mut child = start();
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
        end();
    }
}

/// When the newest file of a folder was written.
pub fn newest(folder: &Path) -> Option<SystemTime> {
    let entries = fs::read_dir(folder).ok()?.flatten();
    let files = entries.filter_map(|entry| entry.metadata().ok().filter(fs::Metadata::is_file));
    let times = files.filter_map(|file| file.modified().ok());
    times.max()
}

/// Gives every file of a folder a time of its own: some from before 1970, some from the next century.
pub fn set_clock_back_and_forth(folder: &Path) {
    const CENTURY: Duration = Duration::from_secs(100 * 365 * 86_400);
    let early = SystemTime::UNIX_EPOCH - CENTURY / 2;
    let late = SystemTime::UNIX_EPOCH + 2 * CENTURY;
    for (k, name) in files(folder).into_keys().enumerate() {
        let time = if k % 2 == 0 { late } else { early };
        let file = fs::File::options().write(true).open(folder.join(name));
        file.unwrap().set_modified(time).unwrap();
    }
}
