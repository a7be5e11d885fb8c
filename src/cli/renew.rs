//! `contact-dma renew`, for those who change the program: what the repository repeats of the tables of keys and columns and of the
//! commands is written anew from them. Hidden from the help, since it is of no use outside the repository.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use clap::{ArgAction, Args};

use super::failure::{Ended, Failure};
use super::output::print;
use crate::input::keys::{self, FileKind};
use crate::input::{key_reference, schema};
use crate::report::quantities::{CYCLES, HISTORY, SWEEP, reference};

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
const STUBS: &str = "The stubs of the Python package are python/stubs.sh's, which wants maturin.\n";

/// Runs the command; `program` is the command line, with all commands that the help shows.
pub(super) fn run(flags: &RenewFlags, program: &clap::Command) -> Result<Ended, Failure> {
    let stale = stale(&flags.repository, program)?;
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

/// What stands in a file of the repository.
enum Part {
    Whole(String),
    /// Between two marks.
    Between(String, String, String),
}

/// The files of a repository that are not what they should be, with what should be in them.
fn stale(repository: &Path, program: &clap::Command) -> Result<BTreeMap<String, String>, Failure> {
    let mut files: BTreeMap<String, (String, String)> = BTreeMap::new();
    for (name, part) in parts(program) {
        if !files.contains_key(&name) {
            let path = repository.join(&name);
            let text = match (fs::read_to_string(&path), &part) {
                (Ok(text), _) => text,
                (Err(_), Part::Whole(_)) if repository.join("sweeps/schema").is_dir() => {
                    String::new()
                }
                (Err(error), _) => {
                    return Err(Failure::Run(format!(
                        "cannot read {}: {error}; give the folder of the repository",
                        path.display()
                    )));
                }
            };
            files.insert(name.clone(), (text.clone(), text));
        }
        if let Some((_, text)) = files.get_mut(&name) {
            *text = match part {
                Part::Whole(whole) => whole,
                Part::Between(begin, end, inner) => between(text, (&begin, &end), &inner)
                    .ok_or_else(|| {
                        Failure::Run(format!("{name} has no `{begin}` with `{end}` behind it"))
                    })?,
            };
        }
    }
    let changed = files.into_iter().filter(|(_, (old, new))| old != new);
    Ok(changed.map(|(name, (_, new))| (name, new)).collect())
}

/// A text with another content between two marks.
fn between(text: &str, (begin, end): (&str, &str), content: &str) -> Option<String> {
    let (head, rest) = text.split_once(begin)?;
    let (_, tail) = rest.split_once(end)?;
    Some(format!("{head}{begin}{content}{end}{tail}"))
}

/// Everything generated, by the file that it is in.
fn parts(program: &clap::Command) -> Vec<(String, Part)> {
    let schema = |(name, kind)| {
        (
            format!("sweeps/schema/{name}.json"),
            Part::Whole(schema::text(kind)),
        )
    };
    let kinds = FileKind::NAMES.iter().copied();
    let mut parts: Vec<(String, Part)> = kinds.map(schema).collect();
    let words = keys::words().into_iter();
    let words: String = words.map(|word| format!("\"{word}\"\n")).collect();
    let words = Part::Between(
        "# Keys and their words.\n".to_owned(),
        "# End.".to_owned(),
        words.replace('µ', "\\xc2\\xb5"),
    );
    parts.push(("tests/fuzz/words.txt".to_owned(), words));
    let mut marked = |file: &str, name: &str, text: String| {
        let marks = ["begin", "end"].map(|side| format!("<!-- {name}: {side} -->"));
        let [begin, end] = marks;
        parts.push((file.to_owned(), Part::Between(begin, end, text)));
    };
    marked("README.md", "commands", block(&commands(program)));
    for (name, path, guide) in [
        ("materials", "material", "src/guide/own_material.md"),
        ("shapes", "indenter", "src/guide/own_indenter.md"),
        ("segments", "drive.segments", "src/guide/own_loading.md"),
    ] {
        marked(guide, name, block(&meanings(path)));
    }
    marked(
        "README.md",
        "shapes",
        names("indenter", &|word| word.to_owned()),
    );
    marked("src/guide/python.md", "shapes", names("indenter", &class));
    marked(
        "src/guide/input_files.md",
        "keys",
        block(&key_reference::markdown()),
    );
    for (name, columns) in [
        ("sweep.csv", reference(SWEEP)),
        ("history.csv", reference(HISTORY)),
        ("cycles.csv", reference(CYCLES)),
    ] {
        marked(
            "src/guide/results.md",
            &format!("columns of {name}"),
            block(&columns),
        );
    }
    parts
}

/// Paragraphs of their own between two marks.
fn block(text: &str) -> String {
    format!("\n\n{}\n\n", text.trim())
}

/// The ways to fill a table as a list in a sentence.
fn names(path: &str, name: &dyn Fn(&str) -> String) -> String {
    let ways = key_reference::ways(path).into_iter();
    let names = ways.map(|(word, _)| format!("`{}`", name(word)));
    names.collect::<Vec<_>>().join(", ")
}

/// The ways to fill a table and what each means, as a table.
fn meanings(path: &str) -> String {
    let ways = key_reference::ways(path).into_iter();
    let rows = ways.map(|(word, means)| format!("| `{word}` | {means} |\n"));
    format!("| | |\n|---|---|\n{}", rows.collect::<String>())
}

/// The Python class of a shape: `FlatPunch` of `flat-punch`.
fn class(shape: &str) -> String {
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    shape.split('-').map(capital).collect()
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
