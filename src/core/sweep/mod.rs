//! Frequency sweeps: what to compute, cases in parallel, records on disk, peak search; and single drive histories.
//!
//! [`Sweep`] is the way in from values, with examples; a plan read from a file goes into a [`case::Setup`] and to
//! [`search::run`], as the command line does it, and a history into a [`history::Simulation`].
//!
//! A folder uses those above it in this table; a test holds it to that.
//!
//! | folder | what it knows |
//! |---|---|
//! | [`figures`] | how figures look |
//! | [`plan`] | what to compute: sweeps and scenarios with every default filled in, as values and as text; ranges of values |
//! | [`record`] | what a case came to, its error bars, and what is said of it |
//! | [`engine`] | engines on a domain that holds the contact |
//! | [`store`] | where results are kept: memory, or a folder of files whole or not at all, and where they come from |
//! | [`case`] | one case: the stabilised cycle on several resolutions |
//! | [`mod@history`] | one drive history from its beginning to its end |
//! | [`scales`] | units of the elastic contact for figures |
//! | [`share`] | what cases cost, and how they are shared out |
//! | [`search`] | all cases in parallel, frequencies added where the curve asks for them and peaks; [`Sweep`] |

pub mod case;
pub mod engine;
pub mod figures;
pub mod history;
pub mod plan;
pub mod record;
pub mod scales;
pub mod search;
pub mod share;
pub mod store;

pub use search::builder::{Sweep, SweepError};
