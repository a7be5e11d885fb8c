//! The command line: flags and files to plans, outcomes to text and exit codes. The only room that knows flags.
//!
//! Its parts from top to bottom, each of which may use those above it: interruption; how a command ends; what is printed; flags that
//! several commands have; files that are read and folders that are written; the commands, one a file; all commands. A test holds them
//! to that.
//!
//! Exit codes: 0 done; 1 could not run; 2 bad usage or bad input; 3 done, but some cases did not converge; 4 results differ (`compare`);
//! 130 interrupted.

mod analyse;
mod cite;
mod commands;
mod compare;
mod documents;
mod failure;
mod flags;
mod folders;
mod identify;
mod interruption;
mod man;
mod material;
mod material_export;
mod material_fit;
mod material_fit_dynamic;
mod material_show;
mod meant_for;
mod memory;
mod merge;
mod output;
mod plan;
mod progress;
mod renew;
mod report;
mod reproduce;
mod schema;
mod simulate;
mod sweep;

use std::ffi::OsString;
use std::io;

use clap::Parser;
use clap::error::{ContextKind, ContextValue};

use commands::Arguments;
use failure::Failure;
use output::failed;

use crate::input::dynamic::{DynamicFormat, silence_caught_panics};

/// Runs the program with these arguments, the first being its name; its exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    silence_caught_panics();
    if let Err(error) = interruption::listen() {
        return failed(Failure::run(format!("cannot listen for Ctrl-C: {error}")));
    }
    match Arguments::try_parse_from(arguments) {
        Ok(arguments) => match arguments.run() {
            Ok(ended) => ended.exit_code(),
            Err(failure) => failed(failure),
        },
        // Help and version come this way too, with exit code 0. A closed pipe is no reason to fail.
        Err(mut error) => {
            advise_on_format(&mut error);
            match error.print() {
                Err(why) if why.kind() != io::ErrorKind::BrokenPipe => {
                    failed(Failure::run(format!("cannot write the help: {why}")))
                }
                _ => u8::try_from(error.exit_code()).unwrap_or(2),
            }
        }
    }
}

/// Where `--format` names a format of data that are read: the flag that is meant.
fn advise_on_format(error: &mut clap::Error) {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => text.as_str(),
        _ => "",
    };
    let (flag, value) = (
        text(ContextKind::InvalidArg),
        text(ContextKind::InvalidValue),
    );
    if flag.starts_with("--format ") && DynamicFormat::WORDS.contains(&value) {
        let advice = format!("the format of data is named by '--data-format {value}'");
        let advice = ContextValue::StyledStrs(vec![advice.into()]);
        error.insert(ContextKind::Suggested, advice);
    }
}
