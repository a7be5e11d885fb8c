//! What a folder holds: files that the program has written, listed or known by their names, or files of others.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::folder_lock::{LOCK, LOCKS};
use super::records::Records;
use super::{RESOLVED, StoreError, files, log};
use crate::sweep::plan::resolved::hash;

/// The list, and where the results come from.
pub const RUN: &str = "run.json";

/// What was found; it names the program, as the list does.
const SUMMARY: &str = "summary.json";

/// As files name the program.
pub(super) const PROGRAM: &str = "contact-dma";

/// How the names of all files begin that the program keeps for itself.
const PRIVATE: &str = ".contact-dma";

/// How the line of the lock file begins that names the kind of the folder.
pub(super) const KIND_MARK: char = '=';

/// What a folder holds: a folder belongs to one command, or to those that work on the same result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    Sweep,
    Scenario,
    Analysis,
    Identification,
    Material,
    MaterialFit,
    Comparison,
    Reproduction,
}

impl Kind {
    /// What messages call it.
    pub fn text(self) -> &'static str {
        match self {
            Self::Sweep => "a sweep",
            Self::Scenario => "a scenario",
            Self::Analysis => "an analysis of measured loops",
            Self::Identification => "an identification",
            Self::Material => "the figures of a material",
            Self::MaterialFit => "a material fit",
            Self::Comparison => "a comparison",
            Self::Reproduction => "the figures of the base paper",
        }
    }

    /// That of a resolved file.
    pub(super) fn of_plan(resolved: &str) -> Self {
        let has = |table: &str| resolved.lines().any(|line| line == table);
        match (has("[identify]"), has("[sweep]")) {
            (true, _) => Self::Identification,
            (_, true) => Self::Sweep,
            _ => Self::Scenario,
        }
    }

    /// Sweeps and scenarios are distinguished by their plans.
    pub(super) fn shares_a_folder_with(self, other: Self) -> bool {
        let has_plan = |kind| matches!(kind, Self::Sweep | Self::Scenario);
        self == other || has_plan(self) && has_plan(other)
    }
}

/// What stands in a folder.
#[derive(Debug, Default, Clone, PartialEq)]
pub(super) struct Listed {
    pub kind: Option<Kind>,
    /// The files that the program has written.
    pub files: BTreeSet<String>,
    /// Where it has written none: the first file of others.
    pub foreign: Option<String>,
}

/// As far as it is read from `run.json`.
#[derive(Deserialize)]
struct Run {
    program: String,
    kind: Option<Kind>,
    files: Option<BTreeSet<String>>,
}

/// Looks at a folder without changing anything. `resolved` is the plan of the command, where it has one.
///
/// # Errors
/// [`StoreError::Read`] with the path; [`StoreError::ForeignFile`] where the lock file is none.
pub(super) fn look(folder: &Path, resolved: Option<&str>) -> Result<Listed, StoreError> {
    let failed = |source| StoreError::Read {
        path: folder.to_path_buf(),
        source,
    };
    let entries = match fs::read_dir(folder) {
        // A file in the place of a folder above is met when the folder is created.
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return Ok(Listed::default());
        }
        entries => entries.map_err(failed)?,
    };
    let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    let names: io::Result<BTreeSet<String>> = entries.map(|entry| entry.map(name)).collect();
    let names = names.map_err(failed)?;
    let journal = fs::read(folder.join(LOCK)).unwrap_or_default();
    let journal = String::from_utf8_lossy(&journal);
    if !journal.trim_start().is_empty() && !journal.trim_start().starts_with(KIND_MARK) {
        let path = folder.join(LOCK);
        return Err(StoreError::ForeignFile { path });
    }
    let mut listed = journal_of(&journal);
    let mut is_listed = !listed.files.is_empty();
    let mut is_of_program = false;
    let signed = [RUN, SUMMARY].map(str::to_owned).into_iter();
    for name in signed.chain(files::runs_of_shards(folder)) {
        let Some(run) = run_of(&folder.join(&name)) else {
            continue;
        };
        is_of_program = true;
        // The summary of a fit names files too: those that were read.
        let files = run.files.filter(|_| name != SUMMARY);
        is_listed |= files.is_some();
        listed.kind = listed.kind.or(run.kind);
        let files = files.into_iter().flatten();
        listed.files.extend(files.filter(|name| is_inside(name)));
    }
    if is_listed {
        // Logs are known by their content.
        let logs = format!("{}/", files::RECORDS);
        listed.files.extend(files_in(folder, &logs, &|name| {
            log::is_one(&folder.join(name))
        }));
    } else if is_of_program || has_plan(folder, resolved) {
        // Without a list the files are known by their names.
        let plan = fs::read_to_string(folder.join(RESOLVED)).ok();
        listed.kind = plan.map(|plan| Kind::of_plan(&plan)).or(listed.kind);
        listed.files = files_in(folder, "", &|name| files::is_result(folder, name)).collect();
    } else {
        listed.kind = None;
        listed.foreign = names.into_iter().find(|name| !name.starts_with(PRIVATE));
    }
    Ok(listed)
}

/// What the program has written into a folder; `None` where it has written nothing there.
///
/// # Errors
/// [`StoreError::Read`] with the path.
pub fn kind_of(folder: &Path) -> Result<Option<Kind>, StoreError> {
    Ok(look(folder, None)?.kind)
}

/// The files that the program has written into a folder and that are there.
///
/// # Errors
/// As [`kind_of`].
pub fn files_of(folder: &Path) -> Result<BTreeSet<String>, StoreError> {
    let mut files = look(folder, None)?.files;
    files.retain(|name| !LOCKS.contains(&&**name) && folder.join(name).is_file());
    Ok(files)
}

fn run_of(path: &Path) -> Option<Run> {
    let run: Run = serde_json::from_slice(&fs::read(path).ok()?).ok()?;
    (run.program == PROGRAM).then_some(run)
}

/// The names and the kind in a lock file.
pub(super) fn journal_of(text: &str) -> Listed {
    let mut listed = Listed::default();
    for line in text.lines() {
        match line.strip_prefix(KIND_MARK) {
            Some(kind) => listed.kind = serde_json::from_str(kind).ok(),
            None if is_inside(line) => drop(listed.files.insert(line.to_owned())),
            None => {}
        }
    }
    listed
}

/// Whether a name stays in its folder.
fn is_inside(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    !name.is_empty() && parts.all(|part| matches!(part, Component::Normal(_)))
}

/// Whether the folder, which has no list, holds a plan of the program: that of this command, or one of which there are records.
fn has_plan(folder: &Path, resolved: Option<&str>) -> bool {
    let plan = fs::read(folder.join(RESOLVED)).unwrap_or_default();
    let plan = String::from_utf8_lossy(&plan);
    let is_own = |resolved: &str| hash(resolved) == hash(&plan) || has_records(folder, resolved);
    resolved.is_some_and(is_own) || !plan.is_empty() && has_records(folder, &plan)
}

/// Whether there are whole records of a plan.
pub(super) fn has_records(folder: &Path, resolved: &str) -> bool {
    !Records::in_folder(folder, &hash(resolved), false).is_empty()
}

/// The files of these names in a folder and in those within it that results have, whoever wrote them; `below` this name in it.
pub(super) fn files_in(
    folder: &Path,
    below: &str,
    is_named: &dyn Fn(&str) -> bool,
) -> impl Iterator<Item = String> {
    let mut found = BTreeSet::new();
    let mut folders = vec![below.to_owned()];
    while let Some(below) = folders.pop() {
        let entries = fs::read_dir(folder.join(&below));
        for entry in entries.into_iter().flatten().flatten() {
            let Ok(name) = entry.file_name().into_string() else {
                continue;
            };
            let name = format!("{below}{name}");
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            if is_folder && files::is_folder_of_results(&name) {
                folders.push(format!("{name}/"));
            } else if !is_folder && is_named(&name) {
                found.insert(name);
            }
        }
    }
    found.into_iter()
}

/// The names that a file has as one of this folder, where it lies there.
pub(super) fn names_in(folder: &Path, file: &Path) -> Vec<String> {
    let Ok(folder) = folder.canonicalize() else {
        return Vec::new();
    };
    let parent = file.parent().filter(|parent| *parent != Path::new(""));
    let parent = parent.unwrap_or(Path::new(".")).canonicalize().ok();
    // Where a link leads, and where it stands itself.
    let link = parent
        .zip(file.file_name())
        .map(|(parent, name)| parent.join(name));
    let paths = file.canonicalize().ok().into_iter().chain(link);
    let name = |path: PathBuf| {
        let below = path.strip_prefix(&folder).ok()?;
        Some(super::name_of(below))
    };
    paths.filter_map(name).collect()
}
