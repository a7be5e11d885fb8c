//! The program as the tests run it, and files for it.

#![allow(dead_code)] // Each test file uses its own part.

mod table;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

pub use table::Table;

/// The program, without what the surroundings might ask of it.
pub fn program() -> Command {
    let mut command = Command::cargo_bin("contact-dma").unwrap();
    command.env_remove("CONTACT_DMA_THREADS");
    command.env_remove("COLUMNS");
    command
}

/// For tests that look at no PNG, which takes longer to make than everything else of a small run.
pub const SVG: &str = "--set figures.formats=[\"svg\"]";

/// Writes a file into a folder, or a folder of that; its path.
pub fn write(folder: impl AsRef<Path>, name: &str, text: &str) -> String {
    let path = folder.as_ref().join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// A sweep file: PMMA under a sphere of 10 mm, 10 N with 5 N about it, and the rest as given, from `[sweep]` on.
pub fn pmma_sweep(rest: &str) -> String {
    include_str!("../inputs/pmma.toml").to_owned() + rest
}

/// Every file below a folder with its bytes.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let file = |path: PathBuf| {
        let name = path.strip_prefix(folder).unwrap().to_str().unwrap();
        (name.to_owned(), fs::read(&path).unwrap())
    };
    below(folder, "").into_iter().map(file).collect()
}

/// The paths of all files below a folder that end like this, or in any way.
pub fn below(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let found = paths.flat_map(|path| match path.is_dir() {
        true => below(&path, extension),
        false => vec![path],
    });
    let is_asked = |path: &PathBuf| path.extension().is_some_and(|own| own == extension);
    let mut found: Vec<_> = found
        .filter(|path| extension.is_empty() || is_asked(path))
        .collect();
    found.sort();
    found
}

/// The folder of a test, in which the program runs.
pub struct Place(pub TempDir);

impl Place {
    pub fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    /// A new one with this file.
    pub fn with(name: &str, text: &str) -> Self {
        let place = Self::new();
        place.put(name, text);
        place
    }

    /// A new one with these files of tests/inputs.
    pub fn lent(names: &str) -> Self {
        let place = Self::new();
        place.lend(names);
        place
    }

    /// Copies files of tests/inputs.
    pub fn lend(&self, names: &str) {
        let inputs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs");
        for name in names.split(' ') {
            self.put(name, fs::read(inputs.join(name)).unwrap());
        }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file, and the folder that it lies in.
    pub fn put(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    pub fn has(&self, name: &str) -> bool {
        self.path(name).exists()
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|why| panic!("{name}: {why}"))
    }

    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).unwrap()
    }

    pub fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.bytes(name)).unwrap()
    }

    /// Every file below a folder with its bytes.
    pub fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        files(&self.path(folder))
    }

    pub fn table(&self, name: &str) -> Table {
        Table::of(&self.text(name))
    }

    /// A command line here, as [`program`]; what stands between single quotes is one argument.
    fn command(&self, line: &str) -> Command {
        let quoted = line.split('\'').enumerate();
        let arguments = quoted.flat_map(|(k, part)| match k % 2 {
            0 => part.split_whitespace().collect(),
            _ => vec![part],
        });
        let mut command = program();
        command.current_dir(self.0.path()).args(arguments);
        command
    }

    /// Runs a command line in these surroundings.
    pub fn run_in(&self, line: &str, surroundings: &[(&str, &str)]) -> Run {
        let surroundings = surroundings.iter().copied();
        Run::of(self.command(line).envs(surroundings))
    }

    /// Runs a command line in a folder of this one.
    pub fn run_at(&self, folder: &str, line: &str) -> Run {
        Run::of(self.command(line).current_dir(self.path(folder)))
    }

    /// Runs a command line with this on standard input.
    pub fn run_on(&self, line: &str, input: &str) -> Run {
        Run::of(self.command(line).write_stdin(input))
    }

    pub fn run(&self, line: &str) -> Run {
        self.run_in(line, &[])
    }

    /// Runs a command that does its work.
    #[track_caller]
    pub fn done(&self, line: &str) -> Run {
        self.run(line).ended(0)
    }

    /// Runs a command that ends like this: what it says on standard error.
    #[track_caller]
    pub fn ends(&self, line: &str, code: i32) -> String {
        self.run(line).ended(code).stderr
    }

    /// All of these are there.
    #[track_caller]
    pub fn has_all(&self, folder: &str, names: &str) {
        for name in names.split_whitespace() {
            assert!(self.has(&format!("{folder}/{name}")), "{folder}/{name}");
        }
    }

    /// The same file in several folders, byte for byte.
    #[track_caller]
    pub fn are_same(&self, folders: &[&str], name: &str) {
        let first = self.bytes(&format!("{}/{name}", folders[0]));
        for folder in &folders[1..] {
            let is_same = self.bytes(&format!("{folder}/{name}")) == first;
            assert!(is_same, "{folder}/{name}");
        }
    }

    /// Runs a command that refuses its input: what it says on standard error, on one line.
    #[track_caller]
    pub fn refused(&self, line: &str) -> String {
        let run = self.run(line).ended(2);
        assert_eq!(run.stdout, "", "{line}");
        words(&run.stderr)
    }

    /// Sweeps a file of this text without figures; its table. What is resolved is in out/resolved.toml.
    #[track_caller]
    pub fn swept(&self, text: &str) -> Table {
        self.put("sweep.toml", text);
        self.done("sweep sweep.toml --quiet --force --no-figures --out out");
        self.table("out/sweep.csv")
    }
}

/// What a command has said.
#[derive(Debug)]
pub struct Run {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Run {
    fn of(command: &mut Command) -> Self {
        let output = command.output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Self {
            code: output.status.code().unwrap(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }

    #[track_caller]
    pub fn ended(self, code: i32) -> Self {
        assert_eq!(self.code, code, "{}{}", self.stdout, self.stderr);
        self
    }

    /// All of this stands on standard output, wherever lines end there.
    #[track_caller]
    pub fn says(self, parts: &[&str]) -> Self {
        says(&words(&self.stdout), parts);
        self
    }

    /// No line of standard output is longer.
    #[track_caller]
    pub fn fits_eighty(self) -> Self {
        let is_narrow = |line: &str| line.chars().count() <= 80 || line.contains("Results in");
        assert!(self.stdout.lines().all(is_narrow), "{}", self.stdout);
        self
    }

    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap()
    }
}

/// The shape of an array in a file of NumPy, and its doubles.
pub fn npy(bytes: &[u8]) -> (Vec<usize>, Vec<f64>) {
    assert!(bytes.starts_with(b"\x93NUMPY\x01\x00"));
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (header, doubles) = bytes[10..].split_at(length);
    let header = std::str::from_utf8(header).unwrap();
    let (_, shape) = header.split_once("'shape': (").unwrap();
    let (shape, _) = shape.split_once(')').unwrap();
    let sides = shape.split(',').filter_map(|side| side.trim().parse().ok());
    let doubles = doubles.chunks_exact(8);
    let doubles = doubles.map(|double| f64::from_le_bytes(double.try_into().unwrap()));
    (sides.collect(), doubles.collect())
}

/// All of this stands in a text.
#[track_caller]
pub fn says(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part} is not in:\n{text}");
    }
}

/// A text on one line.
pub fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
