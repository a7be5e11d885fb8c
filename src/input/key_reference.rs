//! The reference of keys in the guides: one table for every table of the input files.

use std::fmt::Write;

use super::document::row::{AnyRow, Branch, Rows};
use super::keys::{self, FileKind};

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
            Some((key, None)) => (*key, branch.keys.first().map_or("", |row| row.means())),
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
    known: &mut Vec<*const Rows>,
    text: &mut String,
) {
    if known.contains(&std::ptr::from_ref(rows)) {
        return;
    }
    known.push(rows);
    // Writing to a String cannot fail.
    let _ = write!(text, "### {heading}\n\n{}\n\n", rows.means.trim());
    list(&rows.own(), text);
    let branches = rows.branches();
    for branch in &branches {
        let _ = write!(text, "{}\n\n", introduction(branch));
        list(&branch.keys, text);
    }
    for row in rows.all() {
        if let Some(below) = row.kind().rows() {
            let path = match path {
                "" => row.name().to_owned(),
                path => format!("{path}.{}", row.name()),
            };
            section(below, &format!("`{path}`"), &path, known, text);
        }
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

fn list(rows: &[&dyn AnyRow], text: &mut String) {
    if rows.is_empty() {
        return;
    }
    text.push_str("| key | value | default | meaning |\n|---|---|---|---|\n");
    for row in rows {
        let absent = match row.default() {
            Some(default) => format!("`{default}`"),
            None if row.is_required() => "required".to_owned(),
            None => String::new(),
        };
        let (name, value) = (row.name(), row.kind().expected());
        let _ = writeln!(text, "| `{name}` | {value} | {absent} | {} |", row.means());
    }
    text.push('\n');
}
