//! What is printed: results as text for people or as JSON for programs, warnings, and why a command failed.

use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::Path;

use clap::ValueEnum;
use serde_json::Value;

use super::failure::{Ended, Failure};
use crate::input::diagnostic::Styling;
use crate::report::text::Text;

/// What a command prints at its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum OutputFormat {
    /// Tables and sentences, to be read
    Text,
    /// For other programs
    Json,
}

/// Prints what a command has found: as one object for programs, as text for people, or nothing where it is to be quiet.
pub(super) fn tell(
    format: OutputFormat,
    quiet: bool,
    found: impl FnOnce() -> Result<Value, Failure>,
    text: impl FnOnce() -> Result<Text, Failure>,
) -> Result<Ended, Failure> {
    match format {
        OutputFormat::Json => print_json(&found()?),
        OutputFormat::Text if quiet => Ok(Ended::Done),
        OutputFormat::Text => print(&text()?),
    }
}

/// Prints for people, no wider than their terminal.
pub(super) fn print(text: &Text) -> Result<Ended, Failure> {
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
pub(super) fn write_out(text: &str) -> Result<Ended, Failure> {
    let mut out = anstream::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::run(format!("cannot print: {error}")))
        }
        _ => Ok(Ended::Done),
    }
}

/// Prints one object; an absent value is null.
pub(super) fn print_json(value: &Value) -> Result<Ended, Failure> {
    let text = serde_json::to_string_pretty(value).map_err(Failure::run)?;
    write_out(&(text + "\n"))
}

/// A JSON file that was written.
pub(super) fn read_json(path: &Path) -> Result<Value, Failure> {
    let failed = |why: String| Failure::run(format!("cannot read {}: {why}", path.display()));
    let bytes = fs::read(path).map_err(|error| failed(error.to_string()))?;
    serde_json::from_slice(&bytes).map_err(|error| failed(error.to_string()))
}

/// Prints a failure; returns its exit code.
pub(super) fn failed(failure: Failure) -> u8 {
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
    code
}

fn error_line(message: &str) -> io::Result<()> {
    writeln!(anstream::stderr(), "error: {}", printable(message))
}

/// Prints a warning to standard error, where that can be written to.
pub(super) fn warn(message: &str) {
    let _ = writeln!(anstream::stderr(), "warning: {}", printable(message));
}

/// The text without control characters, by which a title or a name from a file could command the terminal.
fn printable(text: &str) -> String {
    let is_command = |c: char| c.is_control() && c != '\n' && c != '\t';
    text.replace(is_command, "\u{fffd}")
}

/// Says on standard error what has no result, where a command that is to be quiet prints nothing else.
pub(super) fn say_quietly(quiet: bool, failures: impl FnOnce() -> Text) {
    if quiet {
        // Where even standard error is closed, the exit code is all that is left to say.
        let _ = write!(anstream::stderr(), "{}", failures());
    }
}
