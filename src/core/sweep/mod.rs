//! Frequency sweeps: what to compute, cases in parallel, records on disk, peak search.
//!
//! [`Sweep`] is the way in from values, with examples; a plan read from a file goes into a [`case::Setup`] and to
//! [`search::run`], as the command line does it.
//!
//! # The way of a case from plan to table
//!
//! ```text
//! plan::SweepPlan ──────── cases(): a frequency under a condition (values, contact, drive)
//!       │
//! search::compute ──────── the next case without a record, on the next free thread
//!       │
//! case::Setup::run_for ─── the solid of its material, engines on its domain
//!       │
//! case::levels ─────────── its cycle at the resolution asked for, and at coarser ones for the error bars
//!       │
//! case::stabilise ──────── one level: searched for or marched to, recorded sample by sample
//!       │
//! record::CaseRecord ───── made once, of what the levels came to and took
//!       │
//! store::records ───────── into the map of records, and to the end of the log of this process
//!       │
//! search::run::Outcome ─── all records in order, and the peaks: what tables and figures are made of
//! ```
//!
//! A folder uses those above it in this table; a test holds it to that.
//!
//! | folder | what it knows |
//! |---|---|
//! | [`plan`] | what to compute: a sweep with every default filled in, as values and as text; ranges of values |
//! | [`record`] | what a case came to, its error bars, and what is said of it |
//! | [`store`] | where results are kept: memory, or a folder of files whole or not at all, and where they come from |
//! | [`case`] | one case: the stabilised cycle on several resolutions |
//! | [`share`] | what cases cost, and how they are shared out |
//! | [`search`] | all cases in parallel, frequencies added where the curve asks for them and peaks; [`Sweep`] |

pub mod case;
pub mod plan;
pub mod record;
pub mod search;
pub mod share;
pub mod store;

pub use search::builder::{Sweep, SweepError};
