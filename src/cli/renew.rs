//! `contact-dma renew`, for those who change the program: what the repository repeats of the tables of keys and columns and of the
//! commands is written anew from them. Hidden from the help, since it is of no use outside the repository.

use std::fs;
use std::path::PathBuf;

use clap::{ArgAction, Args};

use super::failure::{Ended, Failure};
use super::output::print;
use crate::repository;

#[derive(Debug, Args)]
pub(super) struct RenewFlags {
    /// Change nothing; name what is stale, with exit code 1
    #[arg(long)]
    check: bool,
    /// The folder of the repository
    #[arg(value_name = "FOLDER", default_value = ".")]
    repository: PathBuf,
}

/// The only generated file that takes more than this program.
const STUBS: &str = "The stubs of the compiled module of the Python package are python/stubs.sh's, which wants maturin.\n";

/// Runs the command; `program` is the command line, with all commands that the help shows.
pub(super) fn run(flags: &RenewFlags, program: &clap::Command) -> Result<Ended, Failure> {
    let stale = repository::stale(&flags.repository, &commands(program)).map_err(Failure::Run)?;
    let names: Vec<&str> = stale.keys().map(String::as_str).collect();
    if flags.check && !names.is_empty() {
        return Err(Failure::Run(format!(
            "stale: {}; `cargo run -- renew` in the repository writes {} anew",
            names.join(", "),
            if names.len() == 1 { "it" } else { "them" }
        )));
    }
    for (name, text) in &stale {
        let path = flags.repository.join(name);
        fs::write(&path, text)
            .map_err(|error| Failure::Run(format!("cannot write {}: {error}", path.display())))?;
    }
    match names.is_empty() {
        true => print(&format!("Nothing was stale. {STUBS}").into()),
        false => print(&format!("Renewed: {}. {STUBS}", names.join(", ")).into()),
    }
}

/// The commands and what each does, as a table.
fn commands(program: &clap::Command) -> String {
    let mut rows = String::new();
    for command in program.get_subcommands() {
        let below: Vec<_> = command.get_subcommands().collect();
        if below.is_empty() {
            rows.push_str(&command_row("", command));
        }
        for inner in below {
            rows.push_str(&command_row(&format!("{} ", command.get_name()), inner));
        }
    }
    format!("| command | |\n|---|---|\n{rows}")
}

fn command_row(group: &str, command: &clap::Command) -> String {
    let mut usage = format!("{group}{}", command.get_name());
    for argument in command.get_positionals() {
        for name in argument.get_value_names().unwrap_or_default() {
            usage.push(' ');
            usage.push_str(name);
            if matches!(argument.get_action(), ArgAction::Append) {
                usage.push_str("...");
            }
        }
    }
    let about = command.get_about().map(ToString::to_string);
    format!("| `{usage}` | {} |\n", about.unwrap_or_default())
}
