//! The reference of keys in the guides: one table for every table of the input files.

use std::fmt::Write;

use super::document::kind::json_of;
use super::keys::{self, FileKind};
use crate::quantity::key::Key;
use crate::quantity::rows::{Branch, Others, Rows};

/// The reference, as Markdown.
pub fn markdown() -> String {
    let mut text = String::new();
    let mut known = Vec::new();
    for (name, kind) in FileKind::NAMES {
        let heading = match kind {
            FileKind::Sweep | FileKind::Scenario | FileKind::Setup => {
                format!("The file of a {name}")
            }
            FileKind::Identify => "The file of an identification".to_owned(),
        };
        section(kind.rows(), &heading, "", &mut known, &mut text);
    }
    text
}

/// The ways to fill the table at a dotted path, such as `drive.segments`: the word or the key that decides for each, and what it means.
pub fn ways(path: &str) -> Vec<(&'static str, &'static str)> {
    let mut ways: Vec<(&str, &str)> = Vec::new();
    let mut tables = keys::tables_at(path).into_iter().map(Rows::branches);
    for branch in tables.find(|ways| !ways.is_empty()).unwrap_or_default() {
        let way = match branch.decided_by.first() {
            Some((_, Some(word))) => (*word, branch.means.trim()),
            Some((key, None)) => (*key, branch.keys.first().map_or("", |key| key.means())),
            None => continue,
        };
        if !ways.iter().any(|(word, _)| *word == way.0) {
            ways.push(way);
        }
    }
    ways
}

/// A table and those below it; what was written before is not written again.
fn section(
    rows: &'static Rows,
    heading: &str,
    path: &str,
    known: &mut Vec<&'static Rows>,
    text: &mut String,
) {
    if known.iter().any(|known| known.is(rows)) {
        return;
    }
    known.push(rows);
    // Writing to a String cannot fail.
    let _ = write!(text, "### {heading}\n\n{}\n\n", about(rows));
    list(&rows.own(), text);
    let branches = rows.branches();
    for branch in &branches {
        let _ = write!(text, "{}\n\n", introduction(branch));
        list(&branch.keys, text);
    }
    for key in rows.all() {
        if let Some(below) = key.kind.rows() {
            let path = match path {
                "" => key.name.to_owned(),
                path => format!("{path}.{}", key.name),
            };
            section(below, &format!("`{path}`"), &path, known, text);
        }
    }
}

/// What a table is about, and the keys of which it takes one.
fn about(rows: &Rows) -> String {
    let means = rows.means.trim();
    let Others::OneListAnd(lists) = rows.others else {
        return means.to_owned();
    };
    let firsts = lists.iter().filter_map(|(list, _)| list.first()?.first());
    let names: Vec<String> = firsts.map(|key| format!("`{}`", key.name)).collect();
    match &names[..] {
        [others @ .., last] => {
            let others = others.join(", ");
            format!("{means}: exactly one of {others} and {last}.")
        }
        [] => means.to_owned(),
    }
}

/// What decides for a way to fill a table.
fn introduction(branch: &Branch) -> String {
    let decided = branch.decided_by.iter().map(|(key, word)| match word {
        Some(word) => format!("`{key} = \"{word}\"`"),
        None => format!("`{key}`"),
    });
    let decided = decided.collect::<Vec<_>>().join(" and ");
    match branch.means.trim() {
        "" => format!("With {decided}:"),
        means => format!("With {decided}: {means}"),
    }
}

fn list(keys: &[&Key], text: &mut String) {
    if keys.is_empty() {
        return;
    }
    text.push_str("| key | value | default | meaning |\n|---|---|---|---|\n");
    for key in keys {
        let absent = match key.default() {
            Some(default) => format!("`{}`", json_of(&default)),
            None if key.is_required() => "required".to_owned(),
            None => String::new(),
        };
        let (name, value) = (key.name, key.kind.expected());
        let _ = writeln!(text, "| `{name}` | {value} | {absent} | {} |", key.means());
    }
    text.push('\n');
}
