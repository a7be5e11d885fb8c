//! Programs that are started to be killed, and folders that must come out the same.

#![allow(dead_code)] // Each test file uses its own part.

use crate::segments;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command as Process, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// The files that must not depend on how a run came to its end.
pub fn results(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = every_file(folder);
    files.retain(|(path, _)| {
        let name = path.file_name().unwrap().to_str().unwrap();
        // The lock file lists what was written last, where other processes were at work at the end.
        !name.starts_with("run")
            && !path.starts_with("records")
            && !name.starts_with(".contact-dma.")
    });
    // Records lie in segments in the order in which they were finished, and some of them twice.
    let mut records = segments::read(folder);
    records.dedup();
    let records = records.into_iter().enumerate();
    files.extend(records.map(|(k, stored)| {
        let heading = format!("{:?}", stored.heading).into_bytes();
        let name = PathBuf::from(format!("records, number {k}"));
        (name, [heading, stored.record].concat())
    }));
    files
}

fn every_file(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_path_buf();
                files.push((name, fs::read(&path).unwrap()));
            }
        }
    }
    files.sort();
    files
}

pub fn assert_same(found: &Path, expected: &Path) {
    let (found, expected) = (results(found), results(expected));
    let names = |files: &[(PathBuf, Vec<u8>)]| -> Vec<PathBuf> {
        files.iter().map(|(name, _)| name.clone()).collect()
    };
    assert_eq!(names(&found), names(&expected));
    for ((name, a), (_, b)) in found.iter().zip(&expected) {
        assert!(a == b, "{} differs", name.display());
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

/// Starts the program with these arguments and an output folder.
pub fn start(arguments: &[&str], out: &Path) -> Child {
    Process::new(assert_cmd::cargo::cargo_bin("contact-dma"))
        .args(arguments)
        .args(["--quiet", "--out"])
        .arg(out)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

pub fn signal(child: &Child, name: &str) {
    let sent = Process::new("kill")
        .args([name, &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
}

pub fn wait_for(what: &str, ready: impl Fn() -> bool) {
    let started = Instant::now();
    while !ready() {
        assert!(started.elapsed() < Duration::from_secs(120), "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Numbers that look random and are the same in every run (S. Vigna's SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// When the newest checkpoint was written.
pub fn newest(folder: &Path) -> Option<SystemTime> {
    let entries = fs::read_dir(folder).ok()?.flatten();
    let times = entries.filter_map(|entry| entry.metadata().ok()?.modified().ok());
    times.max()
}

/// Gives every file of a folder a time of its own: some from before 1970, some from the next century.
pub fn set_clock_back_and_forth(folder: &Path) {
    const CENTURY: Duration = Duration::from_secs(100 * 365 * 86_400);
    let early = SystemTime::UNIX_EPOCH - CENTURY / 2;
    let late = SystemTime::UNIX_EPOCH + 2 * CENTURY;
    for (k, (name, _)) in every_file(folder).into_iter().enumerate() {
        let time = if k % 2 == 0 { late } else { early };
        let file = fs::File::options().write(true).open(folder.join(name));
        file.unwrap().set_modified(time).unwrap();
    }
}
