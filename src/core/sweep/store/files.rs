//! The layout of a folder of results: the one place that knows which folder a file stands in.
//!
//! At the top are the page, the tables of everything, the summary and what was asked; pictures with their captions and data are in
//! `figures/`, files of single cases and instants in `cases/`, and what the program keeps for itself in `records/`. What the program
//! has written is listed, see [`super::manifest`]. Names count where there is no list, and for what would be in the way of a
//! computation. Folders of versions that laid them out otherwise are described in [`older`].

pub mod older;

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use super::RESOLVED;
use super::listing::{RUN, files_of};

const FIGURES: &str = "figures";
const CASES: &str = "cases";
/// The folder of what the program keeps for itself.
pub(super) const RECORDS: &str = "records";
/// The folder in it of the checkpoints.
const CHECKPOINTS: &str = "checkpoints";

/// The page.
pub const PAGE: &str = "index.html";
/// What is kept of figures and of measured loops.
const KEPT: [&str; 2] = ["figures.json", "analysis.json"];
/// The cycles of all cases in one file.
const ARCHIVE: &str = "cycles.npz";
/// Tables at the top of which a computation knows only later whether it writes them.
const TABLES: [&str; 7] = [
    RUN,
    RESOLVED,
    PAGE,
    "sweep.csv",
    "history.csv",
    "cycles.csv",
    "summary.json",
];

/// The endings of a picture in every form.
pub const PICTURES: [&str; 5] = [".svg", ".pdf", ".eps", ".png", "@2x.png"];
/// The ending of a caption.
pub const CAPTION: &str = ".caption.txt";
/// The ending of the data behind a figure.
pub const DATA: &str = ".csv";

/// What files of single cases and instants hold; those of each kind have a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OfCase {
    Loops,
    Pressures,
    Work,
    Cycles,
    Profiles,
    Fields,
}

impl OfCase {
    const ALL: [Self; 6] = [
        Self::Loops,
        Self::Pressures,
        Self::Work,
        Self::Cycles,
        Self::Profiles,
        Self::Fields,
    ];

    fn folder(self) -> &'static str {
        match self {
            Self::Loops => "loops",
            Self::Pressures => "pressures",
            Self::Work => "work",
            Self::Cycles => "cycles",
            Self::Profiles => "profiles",
            Self::Fields => "fields",
        }
    }

    /// Whether it is the name of one of these folders.
    fn is_folder(name: &str) -> bool {
        Self::ALL.iter().any(|kind| kind.folder() == name)
    }
}

/// Where a file stands in a folder of results; written out, its name in the folder, with `/` on every system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place<'a> {
    /// At the top.
    Top(&'a str),
    /// A file of the figure of this name: its ending.
    Figure(&'a str, &'a str),
    /// A file of one case or instant.
    Case(OfCase, &'a str),
    /// The cycles of all cases in one file.
    Archive,
    /// What the program keeps for itself.
    Record(&'a str),
    Checkpoint(&'a str),
}

impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Top(name) => f.write_str(name),
            Self::Figure(name, ending) => write!(f, "{FIGURES}/{name}{ending}"),
            Self::Case(kind, name) => write!(f, "{CASES}/{}/{name}", kind.folder()),
            Self::Archive => write!(f, "{CASES}/{ARCHIVE}"),
            Self::Record(name) => write!(f, "{RECORDS}/{name}"),
            Self::Checkpoint(name) => write!(f, "{RECORDS}/{CHECKPOINTS}/{name}"),
        }
    }
}

impl From<Place<'_>> for String {
    fn from(place: Place<'_>) -> Self {
        place.to_string()
    }
}

/// The files that the program has written into a folder, by their places, wherever its version has put them.
#[derive(Debug, Clone, Default)]
pub struct Found {
    folder: PathBuf,
    /// By places in the present layout: names in the folder.
    names: BTreeMap<String, String>,
}

impl Found {
    /// Those of a folder. In one that cannot be read none are found; whoever then reads a file is told why.
    pub fn of(folder: &Path) -> Self {
        let files = files_of(folder).unwrap_or_default();
        let (former, present): (Vec<_>, Vec<_>) = files
            .into_iter()
            .map(|name| (older::present_name(&name), name))
            .partition(|(present, name)| present != name);
        Self {
            folder: folder.to_path_buf(),
            // What a later version has written stands for what an earlier one has left.
            names: former.into_iter().chain(present).collect(),
        }
    }

    /// The name of a file in the folder; that of its place where it is not there.
    pub fn name(&self, place: Place<'_>) -> String {
        let place = place.to_string();
        self.names.get(&place).cloned().unwrap_or(place)
    }

    /// The path of a file; that of its place where it is not there.
    pub fn path(&self, place: Place<'_>) -> PathBuf {
        self.folder.join(self.name(place))
    }

    /// Every file: its name in the present layout, and its path.
    pub fn all(&self) -> impl Iterator<Item = (&str, PathBuf)> {
        let path = |name: &String| self.folder.join(name);
        self.names
            .iter()
            .map(move |(place, name)| (&**place, path(name)))
    }
}

/// Names of the files that a result which was made of arrays has of these: height maps and profiles, which its plan names.
const OF_ARRAYS: [(&str, &str); 2] = [("height-map", ".npy"), ("profile", ".csv")];

/// The file of an array, a map or a table, behind so many others.
pub fn of_array(is_map: bool, before: usize) -> String {
    let [map, profile] = OF_ARRAYS;
    let (stem, ending) = if is_map { map } else { profile };
    match before {
        0 => format!("{stem}{ending}"),
        before => format!("{stem}-{}{ending}", before + 1),
    }
}

/// Whether a file is one of these.
fn is_of_array(name: &str) -> bool {
    OF_ARRAYS.iter().any(|(stem, ending)| {
        let number = name
            .strip_prefix(stem)
            .and_then(|rest| rest.strip_suffix(ending));
        number.is_some_and(|number| number.is_empty() || number.starts_with('-'))
    })
}

/// Whether a name is that of `run.json` of a shard.
fn is_run_of_shard(name: &str) -> bool {
    name.starts_with("run-") && name.ends_with(".json")
}

/// Names in a folder of the files that name the program besides the two at its top: those of shards.
pub(super) fn runs_of_shards(folder: &Path) -> Vec<String> {
    let below = |prefix: &str| {
        let entries = std::fs::read_dir(folder.join(prefix));
        let names = entries.into_iter().flatten().flatten();
        let names = names.filter_map(|entry| entry.file_name().into_string().ok());
        let runs = names.filter(|name| is_run_of_shard(name));
        runs.map(|name| format!("{prefix}{name}")).collect()
    };
    let all: [Vec<String>; 2] = [below(&format!("{RECORDS}/")), below("")];
    all.concat()
}

/// The folders in which a killed process may leave a half-written file, unless a list names others.
pub(super) fn folders() -> impl Iterator<Item = String> {
    let cases = OfCase::ALL
        .iter()
        .map(|kind| format!("{CASES}/{}", kind.folder()));
    ["", FIGURES, CASES, RECORDS]
        .into_iter()
        .map(str::to_owned)
        .chain(cases)
}

/// The folders of checkpoints, of all or of a case, in every version.
pub(super) fn checkpoints_of(case: &str) -> [PathBuf; 2] {
    let below = Path::new(CHECKPOINTS).join(case);
    [Path::new(RECORDS).join(&below), below]
}

/// Whether a folder within the folder of a result has files of it.
pub(super) fn is_folder_of_results(name: &str) -> bool {
    let (folder, below) = name.split_once('/').unwrap_or((name, ""));
    let is_here = match folder {
        FIGURES => below.is_empty(),
        CASES => below.is_empty() || OfCase::is_folder(below),
        RECORDS => below.is_empty() || below.split('/').next() == Some(CHECKPOINTS),
        _ => false,
    };
    is_here || older::is_folder_of_results(name)
}

/// Whether a file of this name would be in the way of a computation, which may come to write it. Of figures it is not known
/// beforehand: where one of them has the name of somebody's file, that is said when it is written.
pub(super) fn is_in_the_way(name: &str) -> bool {
    let Some((folder, below)) = name.split_once('/') else {
        return TABLES.contains(&name);
    };
    match (folder, below.split_once('/')) {
        (CASES, None) => below == ARCHIVE,
        (CASES, Some((kind, file))) => OfCase::is_folder(kind) && is_numbered(file),
        (RECORDS, None) => {
            let is_log = below.ends_with(".segment");
            is_log || KEPT.contains(&below) || is_run_of_shard(below) || is_of_array(below)
        }
        (RECORDS, Some((CHECKPOINTS, file))) => is_checkpoint(file),
        _ => false,
    }
}

fn is_numbered(file: &str) -> bool {
    file.starts_with(|c: char| c.is_ascii_digit()) || file == "index.csv"
}

fn is_checkpoint(file: &str) -> bool {
    file == "history" || file.ends_with(".finished")
}

/// Whether a file of a folder without a list is one of a result. A figure is known by its caption.
pub(super) fn is_result(folder: &Path, name: &str) -> bool {
    let is_of_figure = || {
        let figure = name.strip_prefix(FIGURES)?.strip_prefix('/')?;
        let endings = [CAPTION, DATA].into_iter().chain(PICTURES);
        let mut stems = endings.filter_map(|ending| figure.strip_suffix(ending));
        let caption = |stem: &str| folder.join(Place::Figure(stem, CAPTION).to_string());
        Some(stems.any(|stem| caption(stem).is_file()))
    };
    is_in_the_way(name) || older::is_result(name) || is_of_figure() == Some(true)
}

/// Whether a file is made anew of records and plan whenever tables and figures are.
pub(super) fn is_drawn_again(name: &str) -> bool {
    let is_kept = name.split('/').next() == Some(RECORDS) || [RUN, RESOLVED].contains(&name);
    !is_kept && !older::is_kept(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_is_known_as_one_of_a_result_and_no_file_of_somebody_else() {
        let folder = tempfile::TempDir::new().unwrap();
        let caption = folder.path().join("figures/energy-loss.caption.txt");
        std::fs::create_dir(folder.path().join(FIGURES)).unwrap();
        std::fs::write(caption, "").unwrap();
        let is_result = |place: Place<'_>| is_result(folder.path(), &place.to_string());
        for place in [
            Place::Top("sweep.csv"),
            Place::Figure("energy-loss", "@2x.png"),
            Place::Figure("energy-loss", DATA),
            Place::Case(OfCase::Fields, "0-pressure_pa.npy"),
            Place::Case(OfCase::Profiles, "index.csv"),
            Place::Archive,
            Place::Record("host-1-0.segment"),
            Place::Record("run-1-of-2.json"),
            Place::Record("height-map-2.npy"),
            Place::Checkpoint("history"),
            Place::Checkpoint("0000/00.finished"),
        ] {
            assert!(is_result(place), "{place}");
        }
        for place in [
            Place::Top("notes.txt"),
            Place::Figure("mine", ".svg"),
            Place::Case(OfCase::Loops, "raw.csv"),
            Place::Record("mine.sqlite"),
            Place::Checkpoint("model.pt"),
        ] {
            assert!(!is_result(place), "{place}");
        }
    }
}
