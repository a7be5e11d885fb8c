//! The map of modules in the crate documentation, enforced: a module uses those above it, never those below.

use std::fs;
use std::path::{Path, PathBuf};

/// Modules from top to bottom: those of the package in `src/core`, then those of the program.
const MODULES: [&str; 23] = [
    "transforms",
    "numerics",
    "quantity",
    "material",
    "indenter",
    "drive",
    "contact",
    "history",
    "cycle",
    "steady",
    "reference",
    "engine",
    "sweep",
    "simulation",
    "measured",
    "identify",
    "figures",
    "input",
    "report",
    "reproduction",
    "repository",
    "cli",
    "guide",
];

/// Folders of the module `sweep` from top to bottom.
const SWEEP: [&str; 6] = ["plan", "record", "store", "case", "share", "search"];

/// Parts of the module `report` from top to bottom.
const REPORT: [&str; 39] = [
    "number",
    "words",
    "text",
    "warnings",
    "peaks",
    "rigid_indenter",
    "work_line",
    "profile_lines",
    "table",
    "quantities",
    "table_reader",
    "fit",
    "dynamic",
    "measured",
    "identify",
    "samples",
    "caption",
    "comparison",
    "npy",
    "cycles",
    "vti",
    "stamp",
    "chart",
    "figure",
    "material",
    "page",
    "kept_figures",
    "summary",
    "sweep_tables",
    "scenario_tables",
    "scenario_folder",
    "machine",
    "terminal",
    "forecast",
    "terminal_simulation",
    "scenario",
    "sweep_files",
    "fonts",
    "mod",
];

/// Parts of the command line that its commands share, from top to bottom. The commands stand below them, and may use one another, but
/// not in a circle.
const SHARED: [&str; 9] = [
    "interruption",
    "failure",
    "output",
    "flags",
    "documents",
    "progress",
    "folders",
    "memory",
    "meant_for",
];
/// Below all commands.
const ALL_COMMANDS: [&str; 2] = ["commands", "mod"];

/// Modules that do not know one another, although one stands above the other.
const STRANGERS: [&str; 5] = ["material", "indenter", "drive", "contact", "cycle"];

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found
}

/// Production code: what stands before the unit tests, without comments.
fn production(text: &str) -> String {
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or("");
    let lines = code.lines().filter(|l| !l.trim_start().starts_with("//"));
    lines.collect::<Vec<_>>().join("\n")
}

/// Modules named as `crate::module` in the code.
fn modules_used(code: &str) -> Vec<&'static str> {
    used(code, "crate::", &MODULES)
}

/// Those of these names that the code has behind this prefix.
fn used<'a>(code: &str, prefix: &str, names: &[&'a str]) -> Vec<&'a str> {
    let named = |name: &&&str| {
        code.match_indices(&format!("{prefix}{name}"))
            .any(|(at, found)| {
                let next = code[at + found.len()..].chars().next();
                !next.is_some_and(|c| c.is_alphanumeric() || c == '_')
            })
    };
    names.iter().filter(named).copied().collect()
}

fn modules() -> Vec<(usize, PathBuf, Vec<&'static str>)> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let core = src.join("core");
    let mut all = Vec::new();
    for path in sources(&src) {
        let inside = path.strip_prefix(&core).or(path.strip_prefix(&src));
        let inside = inside.unwrap();
        let first = inside.components().next().unwrap().as_os_str();
        let name = first.to_str().unwrap().trim_end_matches(".rs");
        if let Some(module) = MODULES.iter().position(|r| *r == name) {
            let code = production(&fs::read_to_string(&path).unwrap());
            all.push((module, inside.to_path_buf(), modules_used(&code)));
        } else {
            assert!(
                ["build", "lib", "main"].contains(&name),
                "{name} is not on the map"
            );
        }
    }
    assert!(all.len() > 40, "the sources were not found");
    all
}

#[test]
fn a_module_uses_only_modules_above_it() {
    for (module, file, used) in modules() {
        for name in used {
            let other = MODULES.iter().position(|r| *r == name).unwrap();
            assert!(
                other <= module,
                "{} uses {name}, which is below it",
                file.display()
            );
        }
    }
}

#[test]
fn a_folder_of_the_sweep_uses_only_folders_above_it() {
    let sweep = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/core/sweep");
    let mut seen = 0;
    for path in sources(&sweep) {
        let inside = path.strip_prefix(&sweep).unwrap();
        let folder = inside.components().next().unwrap().as_os_str();
        let Some(own) = SWEEP.iter().position(|name| *name == folder) else {
            assert_eq!(inside, Path::new("mod.rs"), "not on the map");
            continue;
        };
        seen += 1;
        let code = production(&fs::read_to_string(&path).unwrap());
        assert!(!code.contains("sweep::{"), "{}", inside.display());
        for name in used(&code, "crate::sweep::", &SWEEP) {
            let other = SWEEP.iter().position(|folder| *folder == name).unwrap();
            assert!(
                other <= own,
                "{} uses {name}, which is below it",
                inside.display()
            );
        }
    }
    assert!(seen > 20, "the sources were not found");
}

#[test]
fn a_part_of_the_report_uses_only_parts_above_it() {
    let report = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/report");
    let mut seen = 0;
    for path in sources(&report) {
        let inside = path.strip_prefix(&report).unwrap();
        let first = inside.components().next().unwrap().as_os_str();
        let name = first.to_str().unwrap().trim_end_matches(".rs");
        let own = REPORT.iter().position(|part| *part == name);
        let own = own.unwrap_or_else(|| panic!("{} is not on the map", inside.display()));
        seen += 1;
        let code = production(&fs::read_to_string(&path).unwrap());
        let mut parts = used(&code, "crate::report::", &REPORT);
        let is_a_whole_part = inside.components().count() == 1;
        if is_a_whole_part && name != "mod" {
            assert!(!code.contains("use super::{"), "{}", inside.display());
            parts.extend(used(&code, "super::", &REPORT));
        }
        assert!(!code.contains("report::{"), "{}", inside.display());
        for part in parts {
            let other = REPORT.iter().position(|p| *p == part).unwrap();
            // Pictures that are being written are kept for the page.
            let kept = inside == Path::new("figure/press.rs") && part == "page";
            assert!(
                other <= own || kept,
                "{} uses {part}, which is below it",
                inside.display()
            );
        }
    }
    assert!(seen > 60, "the sources were not found");
}

#[test]
fn a_part_of_the_command_line_uses_only_parts_above_it() {
    let cli = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/cli");
    let files = sources(&cli);
    let stem = |path: &PathBuf| path.file_stem().unwrap().to_str().unwrap().to_owned();
    let stems: Vec<String> = files.iter().map(stem).collect();
    let names: Vec<&str> = stems.iter().map(String::as_str).collect();
    let on_map = || SHARED.iter().chain(&ALL_COMMANDS);
    assert!(
        on_map().all(|part| names.contains(part)),
        "a part is missing"
    );
    let place = |name: &str| match on_map().position(|part| *part == name) {
        Some(place) if place < SHARED.len() => place,
        Some(place) => place + 1,
        None => SHARED.len(),
    };
    let mut commands = Vec::new();
    for (path, name) in files.iter().zip(&names) {
        let code = production(&fs::read_to_string(path).unwrap());
        let mut parts = used(&code, "super::", &names);
        for list in code.split("super::{").skip(1) {
            let list = list.split(';').next().unwrap();
            parts.extend(used(&format!(" {list}").replace(",", " "), " ", &names));
        }
        for part in &parts {
            let is_above = place(part) <= place(name);
            assert!(is_above, "{name} uses {part}, which is below it");
        }
        if place(name) == SHARED.len() {
            commands.push((name, parts));
        }
    }
    // What uses none of those that are left is in no circle with them.
    let mut before = usize::MAX;
    while commands.len() < before {
        before = commands.len();
        let left: Vec<&str> = commands.iter().map(|(name, _)| **name).collect();
        commands.retain(|(_, parts)| parts.iter().any(|part| left.contains(part)));
    }
    assert!(commands.is_empty(), "in a circle: {commands:?}");
}

#[test]
fn material_indenter_drive_contact_and_cycle_do_not_know_one_another() {
    for (module, file, used) in modules() {
        if STRANGERS.contains(&MODULES[module]) {
            for name in used {
                let stranger = STRANGERS.contains(&name) && name != MODULES[module];
                assert!(!stranger, "{} uses {name}", file.display());
            }
        }
    }
}

#[test]
fn no_production_code_rests_on_the_reference_solutions() {
    for (module, file, used) in modules() {
        // The reproduction of the base paper draws closed forms as lines and compares with them.
        let own = ["reference", "reproduction"].contains(&MODULES[module]);
        assert!(own || !used.contains(&"reference"), "{}", file.display());
    }
}

#[test]
fn every_source_file_opens_by_saying_what_it_is_for() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for path in sources(&src) {
        let text = fs::read_to_string(&path).unwrap();
        let first = text.lines().next().unwrap_or("");
        assert!(first.starts_with("//! "), "{}", path.display());
        assert!(first.len() > 20, "{}", path.display());
    }
}

#[test]
fn nothing_is_printed_by_macros_that_panic_where_nobody_can_hear() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for path in sources(&src) {
        // The last two are modules of tests in files of their own.
        let apart = ["core/build.rs", "tests.rs", "noisy.rs"];
        if apart.iter().any(|file| path.ends_with(file)) {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = production(&text);
        for line in code.lines() {
            // With and without an e before, and a line's end.
            let prints = line.contains("println!(") || line.contains("print!(");
            assert!(!prints, "{}: {line}", path.display());
        }
    }
}

#[test]
fn only_the_command_line_knows_flags() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for path in sources(&src) {
        let code = production(&fs::read_to_string(&path).unwrap());
        let inside = path.strip_prefix(&src).unwrap();
        if !inside.starts_with("cli") {
            assert!(!code.contains("clap"), "{}", inside.display());
        }
    }
}
