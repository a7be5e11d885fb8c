//! `contact-dma schema`: the JSON Schema of input files.

use clap::Args;
use clap::builder::TypedValueParser;

use super::failure::{Ended, Failure};
use super::flags::named;
use super::output::write_out;
use crate::input::keys::FileKind;
use crate::input::schema;

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  contact-dma schema --kind sweep > sweep.json

Editors that know TOML complete and check a file whose first lines hold

  #:schema sweep.json")]
pub(super) struct SchemaFlags {
    /// Of which files
    #[arg(long, value_name = "KIND", default_value = "sweep", value_parser = kinds())]
    kind: FileKind,
}

fn kinds() -> impl TypedValueParser<Value = FileKind> {
    let kinds = FileKind::NAMES.iter();
    named(kinds.map(|(name, kind)| (*kind, *name, "")))
}

pub(super) fn run(flags: &SchemaFlags) -> Result<Ended, Failure> {
    write_out(&schema::text(flags.kind))
}
