//! Signals: every command ends at once with what is finished kept, unless whoever started it wants them ignored.

use std::path::Path;
use std::process::{Child, Command as Process, Stdio};
use std::time::Duration;

use crate::kills::{signal, stopped, wait_for};
use crate::program::{Place, pmma_sweep};
use crate::segments;

/// Sixty cases on so many cells along the longer side: of seconds each on 256.
fn on_cells(cells: usize) -> String {
    pmma_sweep(&format!(
        r#"[sweep]
angular_frequency = {{ from = "1e-3 rad/s", to = "1 rad/s", points = 60 }}
[solver]
engine = "half-space"
cells = {cells}
"#
    ))
}

/// The program as a shell starts it after these words.
fn after(words: &str, arguments: &[&str], folder: &Path) -> Child {
    Process::new("sh")
        .args(["-c", &format!("{words} exec \"$@\""), "sh"])
        .arg(assert_cmd::cargo::cargo_bin("contact-dma"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

#[test]
fn a_command_that_has_nothing_to_keep_ends_at_once() {
    let place = Place::new();
    // Whoever runs the tests may ignore them.
    let listening = match cfg!(target_os = "linux") {
        true => "set -- env --default-signal=HUP \"$@\";",
        false => "",
    };
    for line in ["plan -", "material show /dev/stdin", "sweep -"] {
        let arguments: &Vec<&str> = &line.split(' ').collect();
        for how in ["-TERM", "-INT", "-HUP"] {
            // It waits for an input that does not come.
            let child = after(listening, arguments, &place.path(""));
            std::thread::sleep(Duration::from_millis(300));
            let took = stopped(child, how);
            assert!(took < Duration::from_secs(2), "{arguments:?}");
        }
    }
}

#[test]
fn a_hangup_is_nothing_where_whoever_started_it_ignores_it() {
    let place = Place::with("cells.toml", &on_cells(128));
    let out = place.path("out");
    let sweep = ["sweep", "cells.toml", "--no-figures", "--out", "out"];
    let child = after("trap '' HUP;", &sweep, &place.path(""));
    wait_for("no case was finished", || segments::count(&out) > 0);
    signal(&child, "-HUP");
    let before = segments::count(&out);
    wait_for("it did not go on", || segments::count(&out) > before + 1);
    stopped(child, "-TERM");
}

#[test]
fn a_file_that_grows_beyond_its_limit_is_an_error_and_not_the_end() {
    let place = Place::with("cells.toml", &on_cells(16));
    let sweep = ["sweep", "cells.toml", "--quiet", "--out", "out"];
    // Blocks of 512 bytes.
    let child = after("ulimit -f 48;", &sweep, &place.path(""));
    let ended = child.wait_with_output().unwrap();
    let said = String::from_utf8(ended.stderr).unwrap();
    assert_eq!(ended.status.code(), Some(1), "{said}");
    assert!(said.contains("File too large"), "{said}");
    // With more room it goes on from what is there.
    let ended = after("", &sweep, &place.path("")).wait_with_output();
    assert_eq!(ended.unwrap().status.code(), Some(0));
    let run = place.text("out/run.json");
    assert!(!run.contains("\"cases_found\": 0,"), "{run}");
    // Tables have room, the archive of all cycles has not: it is as large as each of its arrays once more.
    let report = ["report", "out", "--no-figures", "--quiet"];
    let blocks = place.bytes("out/cases/cycles.npz").len() / 512 - 8;
    let child = after(&format!("ulimit -f {blocks};"), &report, &place.path(""));
    let ended = child.wait_with_output().unwrap();
    let said = String::from_utf8(ended.stderr).unwrap();
    assert_eq!(ended.status.code(), Some(1), "{said}");
    assert!(said.contains("cases/cycles.npz") && said.lines().count() < 4);
}
