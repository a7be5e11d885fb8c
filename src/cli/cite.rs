//! `contact-dma cite`: what to cite for a folder of results.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::documents::read_bytes;
use super::failure::{Ended, Failure};
use super::output::{OutputFormat, tell, write_out};
use crate::citation::{Citation, MadeBy, citations, used};
use crate::report::text::Text;
use crate::sweep::store::manifest::{RUN, files_of, kind_of};
use crate::sweep::store::provenance::{BUILD, COMMIT};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma cite
  contact-dma cite reports/pmma
  contact-dma cite reports/pmma --bibtex > references.bib")]
pub(super) struct CiteFlags {
    /// Folder of a result; without one, what is to be cited of any
    #[arg(value_name = "DIR")]
    folder: Option<PathBuf>,
    /// Print entries of BibTeX
    #[arg(long)]
    bibtex: bool,
}

/// The largest file that is read.
const MAX_BYTES: usize = 100_000_000;

/// Runs the command.
pub(super) fn run(flags: &CiteFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let citations = match &flags.folder {
        Some(folder) => of_folder(folder)?,
        None => citations(
            &MadeBy::of(&json!({ "build": BUILD, "commit": COMMIT })),
            &used(None, &[]),
        ),
    };
    if flags.bibtex && format == OutputFormat::Text {
        let entries: Vec<String> = citations.iter().map(|c| c.work.bibtex()).collect();
        return write_out(&entries.join("\n"));
    }
    let found = || {
        let all: Vec<Value> = citations.iter().map(Citation::to_json).collect();
        Ok(json!({ "citations": all }))
    };
    tell(format, false, found, || Ok(text(&citations)))
}

fn of_folder(folder: &Path) -> Result<Vec<Citation>, Failure> {
    let Some(kind) = kind_of(folder)? else {
        return Err(Failure::Input(format!(
            "{} holds no result of this program: name a folder that one of its commands has written",
            folder.display()
        )));
    };
    let mut tables = Vec::new();
    for name in files_of(folder)?
        .iter()
        .filter(|name| name.ends_with(".toml"))
    {
        let bytes = read_bytes(&folder.join(name), MAX_BYTES)?;
        // A file that somebody has edited since then tells nothing.
        tables.extend(String::from_utf8_lossy(&bytes).parse::<toml::Table>());
    }
    let of_run = |name: &str| {
        let bytes = read_bytes(&folder.join(name), MAX_BYTES).ok()?;
        serde_json::from_slice::<Value>(&bytes).ok()
    };
    let run = of_run(RUN).unwrap_or_default();
    Ok(citations(&MadeBy::of(&run), &used(Some(kind), &tables)))
}

/// One below the other, what each is for above those that are for the same.
fn text(citations: &[Citation]) -> Text {
    let mut text = Text::default();
    let mut before = "";
    for citation in citations {
        if citation.is_for != before {
            if !before.is_empty() {
                text.blank();
            }
            text.line(format!("For {}:", citation.is_for));
        }
        before = &citation.is_for;
        text.indented(citation.work.prose(), "  ", "    ");
    }
    text
}
