//! The names of results in a folder. What the program has written is listed, see [`super::manifest`]; by their names are known
//! the files of versions that wrote no list, and those that would be in the way of a computation.

use super::listing::RUN;
use super::{RESOLVED, checkpoint_file, records};

/// Every figure a sweep may have; which of them it has depends on its axes, its material and its results.
pub const FIGURES: &[&str] = &[
    "energy-loss",
    "loops",
    "dissipation",
    "dissipation-profile",
    "dissipation-map",
    "moduli",
    "cole-cole",
    "van-gurp-palmen",
    "loss-tangent",
    "loss-map",
    "harmonic-2-map",
    "moduli-error",
    "peaks",
    "energy-loss-2",
    "loss-map-2",
    "peaks-2",
    "energy-loss-3",
    "loss-map-3",
    "peaks-3",
    "energy-loss-4",
    "loss-map-4",
    "peaks-4",
];
/// Those of scenarios and of measured loops besides.
const MORE_FIGURES: &[&str] = &[
    "history",
    "cycle-losses",
    "profiles",
    "pressure-map",
    "cycles",
];

/// Everything else at the top.
const TABLES: &[&str] = &[
    RUN,
    RESOLVED,
    "sweep.csv",
    "summary.json",
    "cycles.npz",
    "index.html",
    "analysis.json",
    "material.toml",
    "prony.csv",
    "fit.csv",
];

/// Folders with files by number: of cases, and of instants asked for.
pub(super) const NUMBERED: [&str; 6] =
    ["loops", "pressures", "work", "cycles", "profiles", "fields"];

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

/// The endings of a picture in every form.
pub const PICTURES: [&str; 5] = [".svg", ".pdf", ".eps", ".png", "@2x.png"];
/// The ending of a caption.
pub const CAPTION: &str = ".caption.txt";

/// Whether a figure has files of this name: data, caption, picture.
fn is_of_figure(name: &str) -> bool {
    let endings = [".csv", CAPTION].into_iter().chain(PICTURES);
    let mut stems = endings.filter_map(|ending| name.strip_suffix(ending));
    stems.any(|stem| FIGURES.contains(&stem) || MORE_FIGURES.contains(&stem))
}

/// Whether a name is that of `run.json` of a shard.
pub(super) fn is_run_of_shard(name: &str) -> bool {
    name.starts_with("run-") && name.ends_with(".json")
}

/// Whether a folder within the folder of a result has files of it.
pub(super) fn is_folder_of_results(name: &str) -> bool {
    let (folder, below) = name.split_once('/').unwrap_or((name, ""));
    let has_files = NUMBERED.contains(&folder) || folder == records::FOLDER;
    folder == checkpoint_file::FOLDER || has_files && below.is_empty()
}

/// Whether a result may have a file of this name.
pub fn is_result(name: &str) -> bool {
    let Some((folder, file)) = name.split_once('/') else {
        return TABLES.contains(&name) || is_run_of_shard(name) || is_of_figure(name);
    };
    match folder {
        checkpoint_file::FOLDER => file == "history" || file.ends_with(".finished"),
        records::FOLDER => file.ends_with(".segment"),
        folder => {
            let is_numbered = file.starts_with(|c: char| c.is_ascii_digit()) || file == "index.csv";
            NUMBERED.contains(&folder) && is_numbered
        }
    }
}

/// Whether a file is made anew of records and plan whenever tables and figures are.
pub(super) fn is_drawn_again(name: &str) -> bool {
    let first = name.split('/').next().unwrap_or_default();
    let kept = [records::FOLDER, checkpoint_file::FOLDER, RUN, RESOLVED];
    !(kept.contains(&first) || is_run_of_shard(name) || is_of_array(name))
}
