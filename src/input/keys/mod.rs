//! Every key of the input files, once: what it is called, what may stand under it, what counts without it, what it means and
//! which others it excludes. Reading, JSON Schema, the reference in the guides and the words of the fuzzers come from here.

pub(crate) mod drive;
pub(super) mod fractional;
pub(crate) mod identify;
pub(crate) mod material;
pub(super) mod settings;
pub(super) mod setup;

use super::document::kind::{Table, Text};
use super::document::row::{Optional, Required, Row, Rows, rows, table};
use contact_dma_core::words;

words! {
    /// The kinds of input files.
    pub enum FileKind {
        /// A frequency sweep.
        Sweep = "sweep",
        /// One drive history.
        Scenario = "scenario",
        /// A material from measured cycles.
        Identify = "identify",
        /// Instrument and contact of measured loops.
        Setup = "setup",
    }
}

impl FileKind {
    /// The keys of such a file.
    pub(crate) fn rows(self) -> &'static Rows {
        match self {
            Self::Sweep => &SWEEP_FILE,
            Self::Scenario => &SCENARIO_FILE,
            Self::Identify => &identify::IDENTIFY_FILE,
            Self::Setup => &setup::SETUP_FILE,
        }
    }
}

rows! { SWEEP_KEYS:
    /// Title of figures, tables and the page.
    TITLE: Row<Text, Required> = "title", Text, Required;
    /// Material of the half-space.
    MATERIAL: Row<Table, Required> = "material", Table(&material::MATERIAL), Required;
    /// The body is a layer on a base instead of a half-space.
    LAYER: Row<Table, Optional> = "layer", Table(&settings::LAYER), Optional;
    /// The indenter.
    INDENTER: Row<Table, Required> = "indenter", Table(&super::indenter_block::INDENTER), Required;
    /// The load or the approach: an oscillation about a mean.
    DRIVE: Row<Table, Required> = "drive", Table(&drive::HARMONIC), Required;
    /// Adhesion of a sphere under a prescribed load.
    ADHESION: Row<Table, Optional> = "adhesion", Table(&settings::ADHESION), Optional;
    /// The frequencies, and optional further axes.
    SWEEP: Row<Table, Required> = "sweep", Table(&drive::SWEEP), Required;
    /// Resolution of a cycle, and when it counts as stabilised.
    CYCLE: Row<Table, Optional> = "cycle", Table(&settings::CYCLE), Optional;
    /// Contact engine and its resolution.
    SOLVER: Row<Table, Optional> = "solver", Table(&settings::SOLVER), Optional;
    /// Appearance of figures; does not affect results.
    FIGURES: Row<Table, Optional> = "figures", Table(&settings::SWEEP_FIGURES), Optional;
}

pub(super) static SWEEP_FILE: Rows =
    table(" A frequency sweep, for `contact-dma sweep`.", SWEEP_KEYS);

rows! { _:
    /// The layer, where an axis needs one.
    NEEDED_LAYER: Row<Table, Required> = "layer", Table(&settings::LAYER), Required;
}

rows! { _:
    /// The load or the approach: a history of segments.
    HISTORY: Row<Table, Required> = "drive", Table(&super::segments_block::HISTORY), Required;
    /// Time steps.
    TIME: Row<Table, Optional> = "time", Table(&settings::TIME), Optional;
    /// What is written in addition to the history.
    OUTPUT: Row<Table, Optional> = "output", Table(&settings::OUTPUT), Optional;
    /// Appearance of figures; does not affect results.
    SCENARIO_FIGURES: Row<Table, Optional> = "figures", Table(&settings::FIGURES), Optional;
}

static SCENARIO_FILE: Rows = table(
    " One drive history, for `contact-dma simulate`.",
    &[
        &TITLE,
        &MATERIAL,
        &LAYER,
        &INDENTER,
        &ADHESION,
        &HISTORY,
        &TIME,
        &OUTPUT,
        &SOLVER,
        &SCENARIO_FIGURES,
    ],
);

/// The keys of the table that a dotted path names, `drive.segments[0]`: one answer for each kind of file that has it.
pub(super) fn tables_at(path: &str) -> Vec<&'static Rows> {
    let mut tables: Vec<_> = FileKind::NAMES
        .iter()
        .map(|(_, kind)| kind.rows())
        .collect();
    for key in path.split('.').filter(|key| !key.is_empty()) {
        let key = key.split('[').next().unwrap_or(key);
        let below = tables.iter().flat_map(|rows| rows.all());
        let below = below.filter(|row| row.name() == key);
        tables = below.filter_map(|row| row.kind().rows()).collect();
    }
    tables
}

/// Everything that is a word of the input files: keys, and what may stand under those that take a word. Sorted.
pub fn words() -> Vec<&'static str> {
    let mut words = Vec::new();
    for (_, kind) in FileKind::NAMES {
        kind.rows().visit("", &mut |_, row| {
            words.push(row.name());
            words.extend(row.kind().words());
        });
    }
    words.sort_unstable();
    words.dedup();
    words
}

/// The dotted path of every key of a kind of file that no table stands under, without the places in lists. Sorted.
pub fn paths(kind: FileKind) -> Vec<String> {
    let mut paths = Vec::new();
    kind.rows()
        .visit("", &mut |path, row| match row.kind().axes() {
            Some(axes) => paths.extend(axes.references().keys().map(|key| format!("{path}.{key}"))),
            None if row.kind().rows().is_none() => paths.push(path.to_owned()),
            None => {}
        });
    paths.sort_unstable();
    paths.dedup();
    paths
}
