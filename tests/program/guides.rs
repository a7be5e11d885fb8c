//! The guides in src/guide: what they tell the reader to save is saved, what they tell him to run is run, in the order in which they
//! tell it. Commands for a cluster meet an `sbatch` that runs its jobs at once, and pictures in LaTeX must be there in the size that
//! the text gives them. Rust code is tested as documentation.

use crate::prelude::*;
use std::process::Command;

/// Something a guide tells its reader to do.
enum Step {
    Save(String, String),
    Shell(String),
    /// Commands for a cluster, each behind a `$`.
    Console(Vec<String>),
    Python(String),
    Latex(String),
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
            ("toml" | "csv", Some(name)) => Some(Step::Save(name, text)),
            ("toml", None) => Some(Step::Fragment(text)),
            ("sh", _) => Some(Step::Shell(text)),
            ("python", _) => Some(Step::Python(text)),
            ("text", _) => Some(Step::Shown(text)),
            ("console", _) => {
                let lines = text.lines().filter_map(|line| line.strip_prefix("$ "));
                Some(Step::Console(lines.map(str::to_owned).collect()))
            }
            ("latex", _) => Some(Step::Latex(text)),
            // Rust is tested as documentation, a workflow of a code host is only shown.
            ("" | "yaml", _) => None,
            (other, _) => panic!("{guide}: a block of {other}"),
        });
        prose = parts.next().expect("a block is not closed").to_owned();
    }
    steps
}

/// Runs a command in a folder, with the program on the path; what it prints, once it has succeeded.
fn run(folder: &TempDir, command: &mut Command) -> String {
    let program = assert_cmd::cargo::cargo_bin("contact-dma");
    let path = std::env::var_os("PATH").unwrap_or_default();
    let own = [
        folder.path().join("bin"),
        program.parent().unwrap().to_owned(),
    ];
    let path = std::env::join_paths(own.into_iter().chain(std::env::split_paths(&path))).unwrap();
    let output = command
        .current_dir(folder.path())
        .env("PATH", path)
        .env("SCRATCH", folder.path())
        .env_remove("CONTACT_DMA_THREADS")
        .output()
        .unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}\n{stderr}");
    String::from_utf8(output.stdout).unwrap()
}

/// The inputs and scripts of the repository, where the guides have them.
fn lend_sweeps(folder: &TempDir) {
    let sweeps = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps");
    let mut link = Command::new("ln");
    run(folder, link.arg("-s").arg(sweeps).arg("sweeps"));
}

/// In place of Slurm a command that runs every task of an array, one after another.
fn lend_a_cluster(folder: &TempDir) {
    let sbatch = include_str!("../inputs/sbatch");
    let bin = folder.path().join("bin");
    fs::create_dir(&bin).unwrap();
    fs::write(bin.join("sbatch"), sbatch).unwrap();
    run(folder, Command::new("chmod").args(["+x", "bin/sbatch"]));
}

/// Whether what a piece of LaTeX takes from files is in them: pictures of the width that it gives them, columns of tables.
fn check_latex(folder: &TempDir, text: &str) {
    let mut taken = 0;
    for command in text.split("\\includegraphics[width=").skip(1) {
        let (width, rest) = command.split_once("]{").unwrap();
        let file = rest.split('}').next().unwrap();
        let bytes = fs::read(folder.path().join(file)).unwrap_or_else(|_| panic!("no {file}"));
        let pdf = String::from_utf8_lossy(&bytes);
        let sides = pdf.split("/MediaBox[0 0 ").nth(1).unwrap();
        let wide: f64 = sides.split(' ').next().unwrap().parse().unwrap();
        let asked: f64 = width.strip_suffix("mm").unwrap().parse().unwrap();
        // Points of 1/72 inch, written to single precision.
        below!((wide / 72.0 * 25.4 - asked).abs(), 1e-3, "{file}");
        taken += 1;
    }
    for command in text.split("\\addplot table [").skip(1) {
        let (keys, rest) = command.split_once("] {").unwrap();
        let file = rest.split('}').next().unwrap();
        let table = fs::read_to_string(folder.path().join(file));
        let table = table.unwrap_or_else(|_| panic!("no {file}"));
        let columns: Vec<&str> = table.lines().next().unwrap().split(',').collect();
        for (axis, column) in keys.split(", ").filter_map(|key| key.split_once('=')) {
            let is_there = axis == "col sep" || columns.contains(&column);
            assert!(is_there, "{file}: {column}");
        }
        taken += 1;
    }
    assert!(taken > 0, "a block of LaTeX that takes nothing: {text}");
}

/// Does what a guide says; everything that was printed.
fn follow(guide: &str) -> String {
    let folder = TempDir::new().unwrap();
    lend_sweeps(&folder);
    let has_python = Command::new("python3").arg("--version").output().is_ok();
    let mut printed = String::new();
    for step in steps(guide) {
        match step {
            Step::Save(name, text) => fs::write(folder.path().join(name), text).unwrap(),
            Step::Shell(text) => {
                printed += &run(&folder, Command::new("sh").args(["-e", "-c", &text]));
            }
            Step::Console(lines) => {
                lend_a_cluster(&folder);
                for line in lines {
                    printed += &run(&folder, Command::new("sh").args(["-e", "-c", &line]));
                }
            }
            Step::Latex(text) => check_latex(&folder, &text),
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
    let mut shown = steps("first_sweep");
    shown.retain(|step| matches!(step, Step::Shown(_)));
    let [Step::Shown(text)] = &shown[..] else {
        panic!("not one block of output")
    };
    says(&printed, &[text]);
}

/// A test for each guide, which is followed and prints all of this.
macro_rules! guides {
    ($($name:ident: $parts:expr,)*) => {$(
        #[test]
        fn $name() {
            let printed = follow(stringify!($name));
            says(&printed, &$parts);
        }
    )*};
}

guides! {
    input_files: ["pmma"],
    figures: [],
    theory: ["Spinu"],
    validation: ["7 agree"],
    own_material: [],
    measured_material: ["found from the content", "21 isotherms", "Material and figures in"],
    identify: ["Series: 3 branches, chosen", "Errors as given", "The data have no errors"],
    measured_loop: ["Stabilised from cycle", "Drift of the approach: linear", "without bias", "the same within"],
    own_indenter: [],
    own_loading: [],
    cluster: ["array 7, merge 7"],
    results: [],
    validity: [],
}

/// The anchors that a code host and rustdoc make of headings.
fn anchors(page: &Path) -> Vec<String> {
    let text = fs::read_to_string(page).unwrap();
    let headings = text.lines().filter_map(|line| line.strip_prefix('#'));
    let anchor = |heading: &str| {
        let heading = heading.trim_start_matches('#').trim().to_lowercase();
        let kept = heading.replace(' ', "-");
        kept.replace(|c: char| !(c.is_alphanumeric() || "-_".contains(c)), "")
    };
    headings.map(anchor).collect()
}

/// Whoever reads a guide as a file follows the definitions at its end, whoever reads the documentation those of `links.txt`, which rustdoc
/// checks.
#[test]
fn links_between_guides_lead_somewhere_on_a_code_host_and_in_the_documentation() {
    fn definitions(text: &str) -> Vec<(&str, &str)> {
        let lines = text.lines().filter_map(|line| line.strip_prefix('['));
        lines.filter_map(|line| line.split_once("]: ")).collect()
    }
    let own = fs::read_to_string(folder().join("links.txt")).unwrap();
    let own = definitions(&own);
    let mut links = 0;
    for path in crate::program::below(&folder(), "md") {
        let text = fs::read_to_string(&path).unwrap();
        let name = path.display();
        for inline in ["](super::", "](crate::", ".md)"] {
            assert!(!text.contains(inline), "{name}: {inline}");
        }
        let defined = definitions(&text);
        for used in text.split("][").skip(1) {
            let label = used.split(']').next().unwrap();
            // Indices of Python are no links.
            if !label.chars().all(|c| c.is_alphabetic() || c == ' ') {
                continue;
            }
            let is_there = |all: &[(&str, &str)]| all.iter().any(|(other, _)| *other == label);
            assert!(is_there(&defined) && is_there(&own), "{name}: [{label}]");
            links += 1;
        }
        for (label, to) in defined {
            let (file, anchor) = to.split_once('#').unwrap_or((to, ""));
            let page = folder().join(file);
            assert!(page.exists(), "{name}: [{label}]");
            let is_there = anchor.is_empty() || anchors(&page).contains(&anchor.to_owned());
            assert!(is_there, "{name}: {to}");
        }
    }
    assert!(links > 0);
}

#[test]
fn every_guide_is_followed_here_and_named_in_the_readme() {
    let source = fs::read_to_string(file!()).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    let of_python = fs::read_to_string(root.join("python/tests/test_documents.py")).unwrap();
    for entry in fs::read_dir(folder()).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if let Some(guide) = name.strip_suffix(".md") {
            // That of the Python package is followed by the tests of that package.
            let is_followed = match guide {
                "python" => of_python.contains("src/guide/python.md"),
                "first_sweep" => source.contains("follow(\"first_sweep\")"),
                _ => source.contains(&format!("\n    {guide}: [")),
            };
            assert!(is_followed, "{guide}");
            assert!(readme.contains(&format!("(src/guide/{name})")), "{guide}");
        }
    }
    assert!(readme.len() <= 7000, "{}", readme.len());
}
