//! How a command ends: done, or why not; with the exit code of each.

use std::fmt::Display;

use super::interruption;
use crate::input::diagnostic::Diagnostics;
use crate::report::ReportError;
use crate::report::comparison::ComparisonError;
use crate::sweep::search::run::RunError;
use crate::sweep::store::{Remedy, StoreError};

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ended {
    Done,
    SomeCasesWithoutResult,
    Interrupted,
    Differs,
}

impl Ended {
    /// What the program tells the one who started it.
    pub(super) fn exit_code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::SomeCasesWithoutResult => 3,
            Self::Differs => 4,
            Self::Interrupted => interruption::EXIT_CODE,
        }
    }
}

/// Why a command did not run to its end.
pub(super) enum Failure {
    /// Something outside the input stopped it: exit code 1.
    Run(String),
    /// The input is wrong: exit code 2.
    Input(String),
    /// The input is wrong at known places: exit code 2.
    Document(Diagnostics),
}

impl Failure {
    pub(super) fn run(error: impl Display) -> Self {
        Self::Run(error.to_string())
    }

    pub(super) fn input(error: impl Display) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<Diagnostics> for Failure {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Document(diagnostics)
    }
}

impl From<StoreError> for Failure {
    /// A folder whose contents must not be used is an input that is wrong; anything else that stops a run is not.
    fn from(error: StoreError) -> Self {
        let text = error.advised(advice);
        match error.is_of_input() {
            true => Self::Input(text),
            false => Self::Run(text),
        }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Store(error) => error.into(),
            threads => Self::run(threads),
        }
    }
}

impl From<ReportError> for Failure {
    fn from(error: ReportError) -> Self {
        match error {
            ReportError::Store(error) => error.into(),
            other => Self::run(other),
        }
    }
}

impl From<ComparisonError> for Failure {
    fn from(error: ComparisonError) -> Self {
        Self::input(error)
    }
}

/// What to do about a folder, in the words of this command line.
fn advice(remedy: Remedy) -> &'static str {
    match remedy {
        Remedy::OtherFolder => "choose another folder with --out",
        Remedy::OtherFolderOrWait => {
            "choose another folder with --out, or wait until it has ended (--force does not replace what runs)"
        }
        Remedy::OtherFolderOrShards => {
            "choose another folder with --out, wait until it has ended, or run its parts with --shard 1/2 and --shard 2/2"
        }
        Remedy::OtherFolderOrForce => {
            "choose another folder with --out, or replace them with --force"
        }
        Remedy::OtherFolderOrAdd => {
            "choose another folder with --out, or add to this one with --force, which leaves every file that is there as it is"
        }
    }
}
