//! Flags that several commands have, and what their values are made of.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;
use clap::builder::{PathBufValueParser, PossibleValue, PossibleValuesParser, TypedValueParser};

use super::failure::Failure;
use crate::sweep::search::run::useful_threads;
use crate::sweep::store::manifest::{Kind, Target};

/// Of a command that computes what a file says.
#[derive(Debug, Args)]
pub(super) struct RunFlags {
    /// The file (TOML); - reads standard input, from which paths start in the working folder
    pub(super) file: PathBuf,
    /// Folder for the results [default: reports/<name of the file>]
    #[arg(long, value_name = "DIR", value_parser = folder())]
    pub(super) out: Option<PathBuf>,
    /// Change one key of the file, for example drive.amplitude='2 N' or indenter.asperities.0.radius='1 mm' (items of a list count
    /// from 0); KEY= removes a key; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
    /// Write only tables, without figures and page
    #[arg(long)]
    pub(super) no_figures: bool,
    #[command(flatten)]
    pub(super) work: WorkFlags,
}

/// Of a command that computes and writes a folder.
#[derive(Debug, Args)]
pub(super) struct WorkFlags {
    /// Number of threads [default: one per processor, at most four for each]; the results do not depend on it
    #[arg(long, value_name = "N", env = "CONTACT_DMA_THREADS", value_parser = threads)]
    threads: Option<NonZeroUsize>,
    /// Replace another result in the output folder, or one of a newer program, or add to a folder that has files of others, of which
    /// none is touched
    #[arg(long)]
    pub(super) force: bool,
    /// Print nothing but errors
    #[arg(long, short)]
    pub(super) quiet: bool,
}

impl WorkFlags {
    /// The number of threads asked for, or the usual one.
    pub(super) fn threads(&self) -> usize {
        useful_threads(self.threads)
    }
}

/// Of a command that writes a folder only where one is named.
#[derive(Debug, Args)]
pub(super) struct OutFlags {
    /// Folder for figures, their data and a page of everything
    #[arg(long, value_name = "DIR", value_parser = folder())]
    pub(super) out: Option<PathBuf>,
    /// Replace another result in the output folder, or add to a folder that has files of others, of which none is touched
    #[arg(long, requires = "out")]
    force: bool,
}

impl OutFlags {
    /// The folder, where one is named and may be written into.
    pub(super) fn target<'a>(
        &'a self,
        kind: Kind,
        reads: &'a [PathBuf],
    ) -> Result<Option<Target<'a>>, Failure> {
        let target = |folder: &'a PathBuf| Target {
            folder,
            kind,
            force: self.force,
            reads,
        };
        let target = self.out.as_ref().map(target);
        target.map_or(Ok(()), |target| target.check())?;
        Ok(target)
    }
}

/// A folder for results, which need not be there.
pub(super) fn folder() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match path.is_file() {
        true => Err("this is a file; name a folder, which is made where there is none"),
        false => Ok(path),
    })
}

/// A number of threads.
pub(super) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let number = text.trim().parse().ok();
    number
        .ok_or_else(|| format!("`{text}` is no number of threads: write a whole number from 1 on"))
}

/// One of these values, by its name and with its help.
pub(super) fn named<T: Copy + Send + Sync + 'static>(
    values: impl IntoIterator<Item = (T, &'static str, &'static str)>,
) -> impl TypedValueParser<Value = T> {
    let values: Vec<_> = values.into_iter().collect();
    let possible = values.iter().map(|(_, name, help)| {
        let value = PossibleValue::new(*name);
        match help.is_empty() {
            true => value,
            false => value.help(*help),
        }
    });
    PossibleValuesParser::new(possible).try_map(move |found| {
        let value = values.iter().find(|(_, name, _)| *name == found);
        value
            .map(|(value, ..)| *value)
            .ok_or("not one of the values")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_a_whole_number_from_one_on() {
        assert_eq!(threads(" 4 ").map(NonZeroUsize::get), Ok(4));
        for wrong in ["0", "-1", "1.5", "all", ""] {
            let message = threads(wrong).unwrap_err();
            assert!(message.contains("from 1 on"), "{message}");
        }
    }
}
