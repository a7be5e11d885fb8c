//! Why a folder cannot be used, and what to do about it.

use std::io;
use std::path::PathBuf;

use super::RESOLVED;
use super::listing::Kind;

/// Why the folder cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    #[error("cannot create the folder {path}: {source}")]
    Create { path: PathBuf, source: io::Error },
    #[error("cannot write {path}: {source}")]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot read {path}: {source}")]
    Read { path: PathBuf, source: io::Error },
    #[error("cannot encode {path}: {reason}")]
    Encode { path: PathBuf, reason: String },
    #[error("{path} {}\n{difference}", of_other(*.at_work))]
    OtherSweep {
        path: PathBuf,
        /// Whether a process is at work there.
        at_work: bool,
        difference: String,
    },
    #[error("{path} holds {}, and this command writes {}", holds.text(), writes.text())]
    OtherKind {
        path: PathBuf,
        holds: Kind,
        writes: Kind,
    },
    #[error("{path} holds files that contact-dma has not written, such as {file}")]
    Foreign { path: PathBuf, file: String },
    #[error("{path} was not written by contact-dma, and a file of this name would replace it")]
    ForeignFile { path: PathBuf },
    #[error("{written} would be written over {read}, which is read")]
    ReplacesInput { read: PathBuf, written: PathBuf },
    #[error("{path} is in use: {running} runs there, and what runs is not replaced")]
    InUse { path: PathBuf, running: String },
    #[error(
        "{path} is in use: the same sweep is computed there, and only shards of a sweep share a folder"
    )]
    Computed { path: PathBuf },
    #[error(
        "{path} was taken from this run: its {RESOLVED} was replaced or removed meanwhile, so nothing more is written there"
    )]
    TakenOver { path: PathBuf },
    #[error(
        "{path} was written by version {version} of the program, newer than this one ({})",
        env!("CARGO_PKG_VERSION")
    )]
    NewerProgram { path: PathBuf, version: String },
    #[error("{path} is no folder of a sweep: {reason}")]
    NoSweep { path: PathBuf, reason: String },
}

/// What cures a [`StoreError`] of a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Remedy {
    /// Nothing but another folder.
    OtherFolder,
    /// Another folder, or waiting.
    OtherFolderOrWait,
    /// Another folder, waiting, or shards.
    OtherFolderOrShards,
    /// Another folder, or to replace what is there.
    OtherFolderOrForce,
    /// Another folder, or to write beside what is there.
    OtherFolderOrAdd,
}

impl StoreError {
    /// Whether the folder must not be used for this, which is bad input; anything else that stops a run is not.
    pub fn is_of_input(&self) -> bool {
        let is_taken = matches!(self, Self::TakenOver { .. });
        matches!(self, Self::NoSweep { .. }) || self.remedy().is_some() && !is_taken
    }

    /// The message, with what to do in the words of whoever asks, before the lines that differ.
    pub fn advised(&self, words: impl Fn(Remedy) -> &'static str) -> String {
        let text = self.to_string();
        let Some(remedy) = self.remedy().map(words) else {
            return text;
        };
        match text.split_once('\n') {
            Some((first, rest)) => format!("{first}; {remedy}\n{rest}"),
            None => format!("{text}; {remedy}"),
        }
    }

    /// What to do, where the folder is at fault.
    pub fn remedy(&self) -> Option<Remedy> {
        Some(match self {
            Self::OtherSweep { at_work: true, .. } | Self::InUse { .. } => {
                Remedy::OtherFolderOrWait
            }
            Self::Computed { .. } => Remedy::OtherFolderOrShards,
            Self::OtherSweep { .. } | Self::OtherKind { .. } | Self::NewerProgram { .. } => {
                Remedy::OtherFolderOrForce
            }
            Self::Foreign { .. } => Remedy::OtherFolderOrAdd,
            Self::ForeignFile { .. } | Self::ReplacesInput { .. } | Self::TakenOver { .. } => {
                Remedy::OtherFolder
            }
            _ => return None,
        })
    }
}

/// What is said of a folder that holds another sweep.
fn of_other(at_work: bool) -> &'static str {
    match at_work {
        true => "is in use: a different sweep or scenario runs there",
        false => "holds results of a different sweep or scenario",
    }
}
