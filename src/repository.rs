//! What the repository repeats of the tables of keys and columns and of the commands: schemas, references, lists in README and guides,
//! words of the fuzzer, signatures of the Python package.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::json;

use crate::citation;
use crate::input::keys::{self, FileKind};
use crate::input::{key_reference, python_calls, schema};
use crate::report::quantities::{ATTRACTED, CYCLES, HISTORY, SWEEP, reference};

/// What stands in a file of the repository.
enum Part {
    Whole(String),
    /// Between two marks.
    Between(String, String, String),
}

/// The files of a repository that are not what they should be, with what should be in them; `commands` is the table of commands.
///
/// # Errors
/// A file that cannot be read, or that lacks the marks between which something generated stands.
pub(crate) fn stale(repository: &Path, commands: &str) -> Result<BTreeMap<String, String>, String> {
    let mut files: BTreeMap<String, (String, String)> = BTreeMap::new();
    for (name, part) in parts(commands) {
        if !files.contains_key(&name) {
            let path = repository.join(&name);
            let text = match (fs::read_to_string(&path), &part) {
                (Ok(text), _) => text,
                (Err(_), Part::Whole(_)) if repository.join("sweeps/schema").is_dir() => {
                    String::new()
                }
                (Err(error), _) => {
                    return Err(format!(
                        "cannot read {}: {error}; give the folder of the repository",
                        path.display()
                    ));
                }
            };
            files.insert(name.clone(), (text.clone(), text));
        }
        if let Some((_, text)) = files.get_mut(&name) {
            *text = match part {
                Part::Whole(whole) => whole,
                Part::Between(begin, end, inner) => between(text, (&begin, &end), &inner)
                    .ok_or_else(|| format!("{name} has no `{begin}` with `{end}` behind it"))?,
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
fn parts(commands: &str) -> Vec<(String, Part)> {
    let schema = |(name, kind)| {
        (
            format!("sweeps/schema/{name}.json"),
            Part::Whole(schema::text(kind)),
        )
    };
    let kinds = FileKind::NAMES.iter().copied();
    let mut parts: Vec<(String, Part)> = kinds.map(schema).collect();
    let stubs = Part::Whole(python_calls::stubs());
    parts.push(("python/contact_dma/_calls.pyi".to_owned(), stubs));
    let words = keys::words().into_iter();
    let words: String = words.map(|word| format!("\"{word}\"\n")).collect();
    let words = Part::Between(
        "# Keys and their words.\n".to_owned(),
        "# End.".to_owned(),
        words.replace('µ', "\\xc2\\xb5"),
    );
    parts.push(("tests/fuzz/words.txt".to_owned(), words));
    parts.extend(publication());
    let mut marked = |file: &str, name: &str, text: String| {
        let marks = ["begin", "end"].map(|side| format!("<!-- {name}: {side} -->"));
        let [begin, end] = marks;
        parts.push((file.to_owned(), Part::Between(begin, end, text)));
    };
    marked("README.md", "commands", block(commands));
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
    marked(
        "src/guide/python.md",
        "shapes",
        names("indenter", &python_calls::class),
    );
    let constructors = python_calls::constructors().into_iter();
    let constructors: Vec<String> = constructors.map(|name| format!("`{name}`")).collect();
    marked("src/guide/python.md", "forms", constructors.join(", "));
    marked(
        "src/guide/input_files.md",
        "keys",
        block(&key_reference::markdown()),
    );
    for (name, columns) in [
        ("sweep.csv", reference(SWEEP)),
        ("sweep.csv with an attraction", reference(ATTRACTED)),
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

/// What says how the program is cited and found, of what the package says of itself.
fn publication() -> [(String, Part); 3] {
    let (version, url) = (env!("CARGO_PKG_VERSION"), env!("CARGO_PKG_REPOSITORY"));
    let (authors, about) = (env!("CARGO_PKG_AUTHORS"), env!("CARGO_PKG_DESCRIPTION"));
    let licences: Vec<&str> = env!("CARGO_PKG_LICENSE").split(" OR ").collect();
    let paper = citation::implemented();
    let of_paper = |name: &str| paper.field(name).unwrap_or_default();
    let (given, family) = of_paper("author").rsplit_once(' ').unwrap_or_default();
    let (title, journal, doi) = (of_paper("title"), of_paper("journal"), of_paper("doi"));
    let (volume, year) = (of_paper("volume"), of_paper("year"));
    let cff = format!(
        "\
cff-version: 1.2.0
type: software
title: contact-dma
version: {version}
abstract: >-
  {about}
message: Please cite the program, and what `contact-dma cite FOLDER` prints for a folder of results.
authors:
  - name: {authors}
license: [{licences}]
repository-code: {url}
references:
  - type: article
    authors:
      - given-names: {given}
        family-names: {family}
    title: {title}
    journal: {journal}
    volume: {volume}
    year: {year}
    doi: {doi}
",
        licences = licences.join(", "),
    );
    let codemeta = json!({
        "@context": "https://doi.org/10.5063/schema/codemeta-2.0", "@type": "SoftwareSourceCode", "name": "contact-dma",
        "version": version, "description": about, "codeRepository": url, "programmingLanguage": ["Rust", "Python"],
        "author": [{ "@type": "Organization", "name": authors }],
        "license": licences.iter().map(|name| format!("https://spdx.org/licenses/{name}")).collect::<Vec<_>>(),
        "referencePublication": format!("https://doi.org/{doi}"),
    });
    let urls = Part::Between(
        "[project.urls]\n# Written by `contact-dma renew`.\n".to_owned(),
        "# End.".to_owned(),
        format!("Homepage = \"{url}\"\nChangelog = \"{url}/blob/main/CHANGELOG.md\"\n"),
    );
    [
        ("CITATION.cff".to_owned(), Part::Whole(cff)),
        (
            "codemeta.json".to_owned(),
            Part::Whole(format!("{codemeta:#}\n")),
        ),
        ("python/pyproject.toml".to_owned(), urls),
    ]
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
