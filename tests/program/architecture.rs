//! The map of modules in the crate documentation, enforced: a module uses those above it, never those below.

use std::fs;
use std::path::{Path, PathBuf};

/// Modules from top to bottom: those of the package in `src/core`, then those of the program.
const MODULES: [&str; 26] = [
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
    "adhesive",
    "reference",
    "engine",
    "sweep",
    "simulation",
    "measured",
    "identify",
    "force_curve",
    "figures",
    "input",
    "citation",
    "report",
    "reproduction",
    "repository",
    "cli",
    "guide",
];

/// Folders of the module `sweep` from top to bottom.
const SWEEP: [&str; 6] = ["plan", "record", "store", "case", "share", "search"];

/// Parts of the module `report` from top to bottom.
const REPORT: [&str; 42] = [
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
    "laws",
    "fit",
    "dynamic",
    "measured",
    "identify",
    "force_curve",
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
    "identified",
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

/// The source files below a folder: the path of each in it, the first part of that path without its ending, and the production code.
fn files_of(folder: &str) -> Vec<(PathBuf, String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let file = |path: PathBuf| {
        let inside = path.strip_prefix(&folder).unwrap().to_path_buf();
        let first = inside.components().next().unwrap().as_os_str();
        let name = first.to_str().unwrap().trim_end_matches(".rs").to_owned();
        (inside, name, production(&fs::read_to_string(path).unwrap()))
    };
    let files: Vec<_> = sources(&folder).into_iter().map(file).collect();
    assert!(files.len() > 20, "the sources were not found");
    files
}

/// The place of a part on a map.
fn place(map: &[&str], part: &str) -> usize {
    let place = map.iter().position(|known| *known == part);
    place.unwrap_or_else(|| panic!("{part} is not on the map"))
}

#[track_caller]
fn assert_above(map: &[&str], (file, own): (&Path, &str), used: &[&str]) {
    for part in used {
        let is_above = place(map, part) <= place(map, own);
        assert!(
            is_above,
            "{} uses {part}, which is below it",
            file.display()
        );
    }
}

/// Every source file of a module, and the modules that it names as `crate::module`.
fn modules() -> Vec<(String, PathBuf, Vec<&'static str>)> {
    let mut files = files_of("src");
    files.retain(|(file, ..)| !file.starts_with("core"));
    files.extend(files_of("src/core"));
    files.retain(|(_, name, _)| !["build", "lib", "main"].contains(&name.as_str()));
    let module = |(file, name, code): (PathBuf, String, String)| {
        (name, file, used(&code, "crate::", &MODULES))
    };
    files.into_iter().map(module).collect()
}

#[test]
fn a_module_uses_only_modules_above_it() {
    for (module, file, used) in modules() {
        assert_above(&MODULES, (&file, &module), &used);
    }
}

#[test]
fn a_folder_of_the_sweep_uses_only_folders_above_it() {
    for (file, folder, code) in files_of("src/core/sweep") {
        if file != Path::new("mod.rs") {
            assert!(!code.contains("sweep::{"), "{}", file.display());
            let used = used(&code, "crate::sweep::", &SWEEP);
            assert_above(&SWEEP, (&file, &folder), &used);
        }
    }
}

#[test]
fn a_part_of_the_report_uses_only_parts_above_it() {
    for (file, name, code) in files_of("src/report") {
        let mut parts = used(&code, "crate::report::", &REPORT);
        if file.components().count() == 1 && name != "mod" {
            assert!(!code.contains("use super::{"), "{}", file.display());
            parts.extend(used(&code, "super::", &REPORT));
        }
        assert!(!code.contains("report::{"), "{}", file.display());
        // Pictures that are being written are kept for the page.
        let is_press = file == Path::new("figure/press.rs");
        parts.retain(|part| !(is_press && *part == "page"));
        assert_above(&REPORT, (&file, &name), &parts);
    }
}

#[test]
fn a_part_of_the_command_line_uses_only_parts_above_it() {
    let files = files_of("src/cli");
    let names: Vec<&str> = files.iter().map(|(_, name, _)| name.as_str()).collect();
    let mut commands = names.clone();
    commands.retain(|name| !SHARED.contains(name) && !ALL_COMMANDS.contains(name));
    let map = [&SHARED[..], &commands, &ALL_COMMANDS].concat();
    assert_eq!(map.len(), names.len(), "a part is missing");
    let mut between = Vec::new();
    for (file, name, code) in &files {
        let mut parts = used(code, "super::", &names);
        for list in code.split("super::{").skip(1) {
            let list = list.split(';').next().unwrap();
            parts.extend(used(&format!(" {list}").replace(",", " "), " ", &names));
        }
        let is_command = commands.contains(&name.as_str());
        let of_commands = |part: &&str| is_command && commands.contains(part);
        let (others, above): (Vec<&str>, Vec<_>) = parts.into_iter().partition(of_commands);
        assert_above(&map, (file, name), &above);
        between.push((name.as_str(), others));
    }
    // What uses none of those that are left is in no circle with them.
    let mut before = usize::MAX;
    while between.len() < before {
        before = between.len();
        let left: Vec<&str> = between.iter().map(|(name, _)| *name).collect();
        between.retain(|(_, others)| others.iter().any(|o| left.contains(o)));
    }
    assert!(between.is_empty(), "in a circle: {between:?}");
}

#[test]
fn material_indenter_drive_contact_and_cycle_do_not_know_one_another() {
    for (module, file, used) in modules() {
        if STRANGERS.contains(&module.as_str()) {
            for name in used {
                let stranger = STRANGERS.contains(&name) && name != module;
                assert!(!stranger, "{} uses {name}", file.display());
            }
        }
    }
}

#[test]
fn no_production_code_rests_on_the_reference_solutions() {
    for (module, file, used) in modules() {
        // The reproduction of the base paper draws closed forms as lines and compares with them.
        let own = ["reference", "reproduction"].contains(&module.as_str());
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
    for (file, _, code) in files_of("src") {
        // The last two are modules of tests in files of their own.
        let apart = ["core/build.rs", "tests.rs", "noisy.rs"];
        let is_apart = apart.iter().any(|apart| file.ends_with(apart));
        // With and without an e before, and a line's end.
        let prints = |line: &&str| line.contains("println!(") || line.contains("print!(");
        let printed = code.lines().find(prints);
        assert!(
            is_apart || printed.is_none(),
            "{}: {printed:?}",
            file.display()
        );
    }
}

#[test]
fn only_the_command_line_knows_flags() {
    for (file, _, code) in files_of("src") {
        let may = file.starts_with("cli");
        assert!(may || !code.contains("clap"), "{}", file.display());
    }
}
