//! What nearly every test of the program uses.

pub use std::collections::{BTreeMap, BTreeSet};
pub use std::fs;
pub use std::path::{Path, PathBuf};
pub use std::sync::Arc;
pub use std::sync::atomic::AtomicBool;

pub use contact_dma::input::document::Document;
pub use contact_dma::sweep::case::Setup;
pub use contact_dma::sweep::plan::SweepPlan;
pub use contact_dma::sweep::plan::resolved::resolved_text;
pub use contact_dma::sweep::record::{CaseRecord, CaseResult};
pub use serde_json::Value;
pub use tempfile::TempDir;

pub use crate::common::random::Random;
pub use crate::common::*;
pub(crate) use crate::plans;
pub use crate::program::*;
