//! The command line: flags and files to plans, outcomes to text and exit codes. The only room that knows flags.
//!
//! Exit codes: 0 done; 1 could not run; 2 bad usage or bad input; 3 done, but some cases did not converge; 4 results differ (`compare`);
//! 130 interrupted.

mod analyse;
mod arguments;
mod compare;
mod identify;
mod interruption;
mod json;
mod material;
mod material_export;
mod material_fit;
mod material_fit_dynamic;
mod meant_for;
mod memory;
mod plan;
mod progress;
mod renew;
mod reproduce;
mod schema;
mod simulate;
mod stored;
mod sweep;

use std::ffi::{OsStr, OsString};
use std::fmt::Display;
use std::io::{self, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{CommandFactory, Parser};
use serde_json::Value;

use arguments::{Arguments, Command, OutputFormat};

use crate::input::diagnostic::{Diagnostics, Styling};
use crate::input::document::{self, Document};
use crate::input::dynamic::silence_caught_panics;
use crate::report::ReportError;
use crate::report::comparison::ComparisonError;
use crate::report::text::Text;
use crate::sweep::search::run::RunError;
use crate::sweep::store::{Remedy, Store, StoreError};

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ended {
    Done,
    SomeCasesWithoutResult,
    Interrupted,
    Differs,
}

/// Why a command did not run to its end.
enum Failure {
    /// Something outside the input stopped it: exit code 1.
    Run(String),
    /// The input is wrong: exit code 2.
    Input(String),
    /// The input is wrong at known places: exit code 2.
    Document(Diagnostics),
}

impl Failure {
    fn run(error: impl Display) -> Self {
        Self::Run(error.to_string())
    }

    fn input(error: impl Display) -> Self {
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

/// Runs the program with these arguments, the first being its name.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    silence_caught_panics();
    if let Err(error) = interruption::listen() {
        return report(Failure::run(format!("cannot listen for Ctrl-C: {error}")));
    }
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version come this way too, with exit code 0. A closed pipe is no reason to fail.
            return match error.print() {
                Err(why) if why.kind() != io::ErrorKind::BrokenPipe => {
                    report(Failure::run(format!("cannot write the help: {why}")))
                }
                _ => ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2)),
            };
        }
    };
    let (format, data_format) = (arguments.output_format(), arguments.data_format());
    let ended = match arguments.command {
        Command::Sweep(flags) => sweep::run(&flags, format),
        Command::Plan(flags) => plan::run(&flags, format),
        Command::Merge(flags) => stored::merge(&flags, format),
        Command::Report(flags) => stored::report(&flags, format),
        Command::Analyse(flags) => analyse::run(&flags, format),
        Command::Compare(flags) => compare::run(&flags, format),
        Command::Simulate(flags) => simulate::run(&flags, format),
        Command::Identify(flags) => identify::run(&flags, format),
        Command::Reproduce(flags) => reproduce::run(&flags, format),
        Command::Schema(flags) => schema::run(&flags),
        Command::Renew(flags) => renew::run(&flags),
        Command::Material(command) => material::run(&command, format, data_format),
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut shown_commands(), "contact-dma", &mut text);
            write_out(&String::from_utf8_lossy(&text))
        }
    };
    match ended {
        Ok(Ended::Done) => ExitCode::SUCCESS,
        Ok(Ended::SomeCasesWithoutResult) => ExitCode::from(3),
        Ok(Ended::Differs) => ExitCode::from(4),
        Ok(Ended::Interrupted) => ExitCode::from(interruption::EXIT_CODE),
        Err(failure) => report(failure),
    }
}

/// The command line without what the help hides.
fn shown_commands() -> clap::Command {
    let all = Arguments::command();
    let shown = all.get_subcommands().filter(|inner| !inner.is_hide_set());
    clap::Command::new("contact-dma")
        .version(env!("CARGO_PKG_VERSION"))
        .args(all.get_arguments().cloned())
        .subcommands(shown.cloned())
}

/// Prints a failure; returns its exit code.
fn report(failure: Failure) -> ExitCode {
    let (code, printed) = match failure {
        Failure::Run(message) => (1, error_line(&message)),
        Failure::Input(message) => (2, error_line(&message)),
        Failure::Document(diagnostics) => {
            // Stripped of its colours where standard error is no terminal, or `NO_COLOR` is set.
            let text = diagnostics.render(Styling::Colour);
            (2, write!(anstream::stderr(), "{text}"))
        }
    };
    // Where even standard error is closed, the exit code is all that is left to say.
    let _ = printed;
    ExitCode::from(code)
}

fn error_line(message: &str) -> io::Result<()> {
    writeln!(anstream::stderr(), "error: {}", printable(message))
}

/// Prints a warning to standard error, where that can be written to.
fn warn(message: &str) {
    let _ = writeln!(anstream::stderr(), "warning: {}", printable(message));
}

/// The text without control characters, by which a title or a name from a file could command the terminal.
fn printable(text: &str) -> String {
    let is_command = |c: char| c.is_control() && c != '\n' && c != '\t';
    text.replace(is_command, "\u{fffd}")
}

/// Says on standard error what has no result, where a command that is to be quiet prints nothing else.
fn say_quietly(quiet: bool, failures: impl FnOnce() -> Text) {
    if quiet {
        // Where even standard error is closed, the exit code is all that is left to say.
        let _ = write!(anstream::stderr(), "{}", failures());
    }
}

/// The name of standard input in the place of a file.
const STANDARD_INPUT: &str = "-";

/// A file, or standard input, from which paths start in the working folder.
fn read_document(file: &Path) -> Result<Document, Failure> {
    if file != Path::new(STANDARD_INPUT) {
        return Ok(Document::read(file)?);
    }
    let mut bytes = Vec::new();
    let limit = document::MAX_BYTES as u64 + 1;
    let read = io::stdin().lock().take(limit).read_to_end(&mut bytes);
    read.map_err(|error| Failure::run(format!("cannot read standard input: {error}")))?;
    Ok(Document::from_bytes("standard input", &bytes)?)
}

/// A file as changed by the `--set` flags.
fn open_document(file: &Path, assignments: &[String]) -> Result<Document, Failure> {
    let mut document = read_document(file)?;
    for assignment in assignments {
        document.set(assignment)?;
    }
    Ok(document)
}

/// The folder for the results of a file where none is asked for: reports/<name of the file>; of standard input, reports/stdin.
fn default_folder(file: &Path) -> PathBuf {
    let stem = match file == Path::new(STANDARD_INPUT) {
        true => OsStr::new("stdin"),
        false => file.file_stem().unwrap_or_default(),
    };
    Path::new("reports").join(stem)
}

/// The folder for the results of a file: the one asked for, or the default one.
fn open_store(
    (file, document): (&Path, &Document),
    (out, force): (Option<&Path>, bool),
    resolved: &str,
) -> Result<Store, Failure> {
    let default = default_folder(file);
    let out = out.unwrap_or(&default);
    let _opening = progress::opening(out);
    Ok(Store::open_reading(
        out,
        resolved,
        force,
        &document.files(),
    )?)
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

/// Prints what a command has found: as one object for programs, as text for people, or nothing where it is to be quiet.
fn tell(
    format: OutputFormat,
    quiet: bool,
    found: impl FnOnce() -> Result<Value, Failure>,
    text: impl FnOnce() -> Text,
) -> Result<Ended, Failure> {
    match format {
        OutputFormat::Json => json::print(&found()?),
        OutputFormat::Text if quiet => Ok(Ended::Done),
        OutputFormat::Text => print(&text()),
    }
}

/// Prints for people, no wider than their terminal.
fn print(text: &Text) -> Result<Ended, Failure> {
    write_out(&printable(&text.in_columns(columns_of_terminal())))
}

/// The columns of the terminal: `COLUMNS` where it is set, else those of standard output; `None` where that is no terminal.
fn columns_of_terminal() -> Option<usize> {
    /// Narrower than this nothing can be read.
    const NARROWEST: usize = 20;
    let set = std::env::var("COLUMNS").ok();
    let set = set.and_then(|columns| columns.trim().parse::<usize>().ok());
    let stdout = io::stdout();
    let real = || terminal_size::terminal_size_of(&stdout).map(|(width, _)| usize::from(width.0));
    set.or_else(|| stdout.is_terminal().then(real).flatten())
        .map(|columns| columns.max(NARROWEST))
}

/// Prints to standard output as it is. A reader that has seen enough (`| head`) is no error.
fn write_out(text: &str) -> Result<Ended, Failure> {
    let mut out = anstream::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::run(format!("cannot print: {error}")))
        }
        _ => Ok(Ended::Done),
    }
}
