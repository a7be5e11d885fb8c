//! The guides in src/guide: what they tell the reader to save is saved, what they tell him to run is run, in the order in which they
//! tell it. Their Rust code is tested as documentation.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// Something a guide tells its reader to do.
enum Step {
    Save {
        name: String,
        text: String,
    },
    Shell(String),
    Python(String),
    /// A part of an input file.
    Fragment(String),
    /// What the program prints.
    Shown(String),
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src/guide")
}

/// The name in the last "Save as `name`" of some prose.
fn saved_name(prose: &str) -> Option<String> {
    let (_, rest) = prose.rsplit_once("ave as `")?;
    Some(rest.split('`').next().unwrap().to_owned())
}

fn steps(guide: &str) -> Vec<Step> {
    let text = fs::read_to_string(folder().join(format!("{guide}.md"))).unwrap();
    let mut steps = Vec::new();
    let mut parts = text.split("```");
    let mut prose = parts.next().unwrap().to_owned();
    while let Some(block) = parts.next() {
        let (language, body) = block.split_once('\n').unwrap();
        let (name, text) = (saved_name(&prose), body.to_owned());
        steps.extend(match (language, name) {
            ("toml" | "csv", Some(name)) => Some(Step::Save { name, text }),
            ("toml", None) => Some(Step::Fragment(text)),
            ("sh", _) => Some(Step::Shell(text)),
            ("python", _) => Some(Step::Python(text)),
            ("text", _) => Some(Step::Shown(text)),
            ("" | "console" | "latex", _) => None,
            (other, _) => panic!("{guide}: a block of {other}"),
        });
        prose = parts.next().expect("a block is not closed").to_owned();
    }
    steps
}

/// Runs a command in a folder, with the program on the path; what it prints, once it has succeeded.
fn run(folder: &TempDir, command: &mut Command) -> String {
    let program = assert_cmd::cargo::cargo_bin("contact-dma");
    let path = std::env::var("PATH").unwrap_or_default();
    let path = format!("{}:{path}", program.parent().unwrap().display());
    let Output {
        status,
        stdout,
        stderr,
    } = command
        .current_dir(folder.path())
        .env("PATH", path)
        .env_remove("CONTACT_DMA_THREADS")
        .output()
        .unwrap();
    let stderr = String::from_utf8_lossy(&stderr);
    assert!(status.success(), "{command:?}\n{stderr}");
    String::from_utf8(stdout).unwrap()
}

/// Does what a guide says; everything that was printed.
fn follow(guide: &str) -> String {
    let folder = TempDir::new().unwrap();
    let has_python = Command::new("python3").arg("--version").output().is_ok();
    let mut printed = String::new();
    for step in steps(guide) {
        match step {
            Step::Save { name, text } => fs::write(folder.path().join(name), text).unwrap(),
            Step::Shell(text) => {
                printed += &run(&folder, Command::new("sh").args(["-e", "-c", &text]));
            }
            Step::Python(text) if has_python => {
                printed += &run(&folder, Command::new("python3").args(["-c", &text]));
            }
            Step::Fragment(text) => assert!(text.parse::<toml::Table>().is_ok(), "{text}"),
            Step::Python(_) | Step::Shown(_) => {}
        }
    }
    assert!(!printed.is_empty());
    printed
}

#[test]
fn the_first_sweep_prints_what_its_guide_shows() {
    let printed = follow("first_sweep");
    let shown = steps("first_sweep")
        .into_iter()
        .find_map(|step| match step {
            Step::Shown(text) => Some(text),
            _ => None,
        });
    assert!(printed.contains(&shown.unwrap()), "{printed}");
}

#[test]
fn own_material() {
    follow("own_material");
}

#[test]
fn own_indenter() {
    follow("own_indenter");
}

#[test]
fn own_loading() {
    follow("own_loading");
}

#[test]
fn cluster() {
    follow("cluster");
}

#[test]
fn results() {
    follow("results");
}

#[test]
fn validity() {
    follow("validity");
}

#[test]
fn every_guide_is_followed_here_and_named_in_the_readme() {
    let source = fs::read_to_string(file!()).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    let mut guides = 0;
    for entry in fs::read_dir(folder()).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if let Some(guide) = name.strip_suffix(".md") {
            guides += 1;
            assert!(source.contains(&format!("follow(\"{guide}\")")), "{guide}");
            assert!(readme.contains(&format!("(src/guide/{name})")), "{guide}");
        }
    }
    assert_eq!(guides, 7);
}
