//! Every key of the input files, once: what it is called, what may stand under it, what counts without it, what it means and
//! which others it excludes. Reading, JSON Schema, the reference in the guides and the words of the fuzzers come from here.

pub(crate) mod drive;
pub(super) mod fractional;
pub(crate) mod identify;
pub(crate) mod material;
pub(super) mod setup;

use super::axis::AxisOf;
use super::scenario_file::TimePlan;
use super::{figures_block, indenter_block};
use crate::drive::harmonic::HARMONIC;
use crate::drive::segments;
use crate::engine::SolverPlan;
use crate::quantity::block::Block as _;
use crate::quantity::key::{Key, Kind};
use crate::quantity::rows::{Rows, table};
use crate::simulation::scenario::OutputPlan;
use crate::sweep::plan::CyclePlan;
use crate::sweep::plan::adhesion::AdhesionPlan;
use crate::sweep::plan::layer::LayerPlan;
use contact_dma_core::{keys, words};

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

keys! {
    /// Title of figures, tables and the page.
    TITLE = "title", Kind::Text;
    /// Material of the half-space.
    MATERIAL = "material", Kind::Table(&material::MATERIAL);
    /// The body is a layer on a base instead of a half-space.
    LAYER = "layer", Kind::Table(&LayerPlan::ROWS), optional;
    /// The layer, where an axis needs one.
    NEEDED_LAYER = "layer", Kind::Table(&LayerPlan::ROWS);
    /// The indenter.
    INDENTER = "indenter", Kind::Table(&indenter_block::INDENTER);
    /// The load or the approach: an oscillation about a mean.
    DRIVE = "drive", Kind::Table(&HARMONIC);
    /// Attraction of the surfaces; left out: none.
    ADHESION = "adhesion", Kind::Table(&AdhesionPlan::ROWS), optional;
    /// The frequencies, and optional further axes.
    SWEEP = "sweep", Kind::Table(&drive::SWEEP);
    /// Resolution of a cycle, and when it counts as stabilised.
    CYCLE = "cycle", Kind::Table(&CyclePlan::ROWS), optional;
    /// Contact engine and its resolution.
    SOLVER = "solver", Kind::Table(&SolverPlan::ROWS), optional;
    /// Appearance of figures; does not affect results.
    FIGURES = "figures", Kind::Table(&figures_block::OF_SWEEP), optional;
    /// The load or the approach: a history of segments.
    HISTORY = "drive", Kind::Table(&segments::HISTORY);
    /// Time steps.
    TIME = "time", Kind::Table(&TimePlan::ROWS), optional;
    /// What is written in addition to the history.
    OUTPUT = "output", Kind::Table(&OutputPlan::ROWS), optional;
    /// Appearance of figures; does not affect results.
    SCENARIO_FIGURES = "figures", Kind::Table(&figures_block::OF_SCENARIO), optional;
}

const SWEEP_KEYS: &[Key] = &[
    TITLE, MATERIAL, LAYER, INDENTER, DRIVE, ADHESION, SWEEP, CYCLE, SOLVER, FIGURES,
];
const SCENARIO_KEYS: &[Key] = &[
    TITLE,
    MATERIAL,
    LAYER,
    INDENTER,
    ADHESION,
    HISTORY,
    TIME,
    OUTPUT,
    SOLVER,
    SCENARIO_FIGURES,
];

pub(super) static SWEEP_FILE: Rows = table(
    " A frequency sweep, for `contact-dma sweep`.",
    &[SWEEP_KEYS],
);
static SCENARIO_FILE: Rows = table(
    " One drive history, for `contact-dma simulate`.",
    &[SCENARIO_KEYS],
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
        let below = below.filter(|known| known.name == key);
        tables = below.filter_map(|known| known.kind.rows()).collect();
    }
    tables
}

/// Everything that is a word of the input files: keys, and what may stand under those that take a word. Sorted.
pub fn words() -> Vec<&'static str> {
    let mut words = Vec::new();
    for (_, kind) in FileKind::NAMES {
        kind.rows().visit("", &mut |_, key| {
            words.push(key.name);
            words.extend(key.kind.words());
        });
    }
    words.sort_unstable();
    words.dedup();
    words
}

/// The dotted path of every key of a kind of file that no table stands under, without the places in lists. Sorted.
pub fn paths(kind: FileKind) -> Vec<String> {
    let mut paths = Vec::new();
    kind.rows().visit("", &mut |path, key| match &key.kind {
        Kind::Axes(axes) => {
            let references = AxisOf(axes).references(&format!("{path}."));
            paths.extend(references.into_iter().map(|(key, _)| key));
        }
        kind if kind.rows().is_none() => paths.push(path.to_owned()),
        _ => {}
    });
    paths.sort_unstable();
    paths.dedup();
    paths
}
