//! The layout of folders of earlier versions: figures, their captions and data at the top, and beside them the folders of cases,
//! checkpoints and what the program keeps for itself. They are read, and drawn anew in the present layout.
//!
//! The names here are those of files that exist. None is ever added: whatever is written today is listed.

use super::{ARCHIVE, CAPTION, CHECKPOINTS, DATA, KEPT, OfCase, PICTURES, Place, TABLES};
use super::{is_checkpoint, is_numbered, is_of_array, is_run_of_shard};

/// Every figure that a sweep may have had.
const FIGURES: [&str; 22] = [
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
const MORE_FIGURES: [&str; 5] = [
    "history",
    "cycle-losses",
    "profiles",
    "pressure-map",
    "cycles",
];
/// Tables of other commands.
const MORE_TABLES: [&str; 3] = ["material.toml", "prony.csv", "fit.csv"];

/// The name that a file has in the present layout.
pub(super) fn present_name(name: &str) -> String {
    let Some((folder, file)) = name.split_once('/') else {
        return at_the_top(name).to_string();
    };
    let mut kinds = OfCase::ALL.into_iter();
    let place = match kinds.find(|kind| kind.folder() == folder) {
        Some(kind) => Place::Case(kind, file),
        None if folder == CHECKPOINTS => Place::Checkpoint(file),
        None => Place::Top(name),
    };
    place.to_string()
}

/// The place of a file that was at the top.
fn at_the_top(name: &str) -> Place<'_> {
    let is_of_sweep = |stem: &&str| FIGURES.contains(stem);
    if let Some(figure) = name.strip_suffix(DATA).filter(is_of_sweep) {
        return Place::Figure(figure, DATA);
    }
    // The longer ending first: `@2x.png` ends in `.png`.
    let endings = [CAPTION].into_iter().chain(PICTURES.into_iter().rev());
    for ending in endings {
        if let Some(figure) = name.strip_suffix(ending) {
            return Place::Figure(figure, ending);
        }
    }
    match name {
        ARCHIVE => Place::Archive,
        name if KEPT.contains(&name) || is_run_of_shard(name) || is_of_array(name) => {
            Place::Record(name)
        }
        name => Place::Top(name),
    }
}

/// Whether a folder within the folder of a result had files of it.
pub(super) fn is_folder_of_results(name: &str) -> bool {
    OfCase::is_folder(name) || name.split('/').next() == Some(CHECKPOINTS)
}

/// Whether a result may have had a file of this name.
pub(super) fn is_result(name: &str) -> bool {
    let Some((folder, file)) = name.split_once('/') else {
        let tables = TABLES.iter().chain(&MORE_TABLES).chain(&KEPT);
        let mut tables = tables.chain([&ARCHIVE]);
        return tables.any(|table| *table == name) || is_run_of_shard(name) || is_of_figure(name);
    };
    match folder {
        CHECKPOINTS => is_checkpoint(file),
        folder => OfCase::is_folder(folder) && is_numbered(file),
    }
}

/// Whether a figure had files of this name: data, caption, picture.
fn is_of_figure(name: &str) -> bool {
    let endings = [DATA, CAPTION].into_iter().chain(PICTURES);
    let mut stems = endings.filter_map(|ending| name.strip_suffix(ending));
    stems.any(|stem| FIGURES.contains(&stem) || MORE_FIGURES.contains(&stem))
}

/// Whether a file is not made anew with tables and figures.
pub(super) fn is_kept(name: &str) -> bool {
    let is_of_checkpoint = name.split('/').next() == Some(CHECKPOINTS);
    is_of_checkpoint || is_run_of_shard(name) || is_of_array(name)
}

#[cfg(test)]
mod tests {
    use super::present_name;

    #[test]
    fn every_file_of_a_former_layout_has_its_place_and_those_of_the_present_one_keep_theirs() {
        for (former, present) in [
            ("sweep.csv", "sweep.csv"),
            ("cycles.csv", "cycles.csv"),
            ("fit.csv", "fit.csv"),
            ("moduli.csv", "figures/moduli.csv"),
            ("energy-loss@2x.png", "figures/energy-loss@2x.png"),
            ("loops.caption.txt", "figures/loops.caption.txt"),
            ("loops/0.csv", "cases/loops/0.csv"),
            ("fields/0-gap_m.npy", "cases/fields/0-gap_m.npy"),
            ("cycles.npz", "cases/cycles.npz"),
            ("analysis.json", "records/analysis.json"),
            ("run-1-of-2.json", "records/run-1-of-2.json"),
            (
                "checkpoints/0000/00.finished",
                "records/checkpoints/0000/00.finished",
            ),
            ("records/one.segment", "records/one.segment"),
        ] {
            assert_eq!(present_name(former), present);
            assert_eq!(present_name(present), present);
        }
    }
}
