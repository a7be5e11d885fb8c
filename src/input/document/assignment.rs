//! `--set KEY=VALUE`: finding key and value in the text of the flag, and putting them into the tree.

use std::ops::Range;
use std::sync::Arc;

use toml::de::DeValue;

use super::syntax;
use super::tree::{Entry, Node, Table, Value};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Source};

/// What stands before the argument in the text of the flag.
pub(super) const PREFIX: &str = "--set ";

/// Deepest key accepted; sweep files have three levels.
const MAX_DEPTH: usize = 16;

/// Applies the flag whose text is `source`.
pub(super) fn apply(root: &mut Table, source: &Arc<Source>) -> Result<(), Diagnostics> {
    let text = source.text();
    let Some(equals) = text.find('=') else {
        let place = Location::new(source, PREFIX.len()..text.len());
        return Err(Diagnostic::at(&place, "`--set` needs a key and a value")
            .because("no `=` in here")
            .help("write `--set KEY=VALUE`, such as `--set cycle.steps=200`")
            .into());
    };
    let keys = keys(source, PREFIX.len()..equals)?;
    let node = value(source, trimmed(text, equals + 1..text.len()))?;
    insert(root, &keys, node)?;
    Ok(())
}

/// The words of a dotted key, each with its place.
fn keys(source: &Arc<Source>, span: Range<usize>) -> Result<Vec<Location>, Diagnostic> {
    let mut keys = Vec::new();
    let mut start = span.start;
    for word in source.text()[span.clone()].split('.') {
        let place = trimmed(source.text(), start..start + word.len());
        start += word.len() + 1;
        let location = Location::new(source, place);
        let is_key =
            |character: char| character.is_ascii_alphanumeric() || "_-".contains(character);
        if location.text().is_empty() || !location.text().chars().all(is_key) {
            return Err(
                Diagnostic::at(&location, "`--set` needs a dotted key before `=`")
                    .because("expected letters, digits, `_` or `-`")
                    .help("write `--set KEY=VALUE`, such as `--set cycle.steps=200`"),
            );
        }
        keys.push(location);
    }
    if keys.len() > MAX_DEPTH {
        let place = Location::new(source, span);
        let message = format!("the key has more than {MAX_DEPTH} levels");
        return Err(Diagnostic::at(&place, message));
    }
    Ok(keys)
}

/// The value, which is a string where it is not TOML and does not set out to be.
fn value(source: &Arc<Source>, span: Range<usize>) -> Result<Node, Diagnostic> {
    let location = Location::new(source, span.clone());
    let text = location.text();
    let value = match DeValue::parse(text) {
        // Bare dates are titles and names here: no key of a sweep file is a date.
        Ok(value) if !value.get_ref().is_datetime() => {
            Node::from_toml(value.span(), value.into_inner(), source, span.start).value
        }
        Err(_) if text.is_empty() => {
            return Err(Diagnostic::at(&location, "a value is missing")
                .because("expected a value here")
                .help("for an empty text write `\"\"`"));
        }
        Err(error) if text.starts_with(['"', '\'', '[', '{']) => {
            return Err(syntax::explain_value(source, &error, span.start));
        }
        _ => Value::Text(text.to_owned()),
    };
    Ok(Node { value, location })
}

/// Puts `node` under `keys`, replacing what is there.
fn insert(root: &mut Table, keys: &[Location], node: Node) -> Result<(), Diagnostic> {
    let Some((last, parents)) = keys.split_last() else {
        return Ok(());
    };
    check_parents(root, parents)?;
    let mut table = root;
    for key in parents {
        let entry = table
            .entries
            .entry(key.text().to_owned())
            .or_insert_with(|| Entry {
                key: key.clone(),
                node: Node {
                    value: Value::Table(Table::default()),
                    location: key.clone(),
                },
            });
        match &mut entry.node.value {
            Value::Table(inner) => table = inner,
            _ => return Ok(()),
        }
    }
    let entry = Entry {
        key: last.clone(),
        node,
    };
    table.entries.insert(last.text().to_owned(), entry);
    Ok(())
}

/// Refuses a key below something that is not a table, before anything is changed.
fn check_parents(root: &Table, parents: &[Location]) -> Result<(), Diagnostic> {
    let mut table = root;
    let mut path = String::new();
    for key in parents {
        let Some(entry) = table.entries.get(key.text()) else {
            return Ok(());
        };
        if !path.is_empty() {
            path.push('.');
        }
        path.push_str(key.text());
        match &entry.node.value {
            Value::Table(inner) => table = inner,
            _ => {
                let found = entry.node.describe();
                let message = format!("`{path}` is {found}, with no keys below it");
                return Err(Diagnostic::at(key, message)
                    .because("a key below this was to be set")
                    .label(&entry.node.location, format!("{found} is given here"))
                    .help(format!("set it whole: `--set {path}=VALUE`")));
            }
        }
    }
    Ok(())
}

/// A span without the spaces at its ends.
fn trimmed(text: &str, span: Range<usize>) -> Range<usize> {
    let inner = &text[span.clone()];
    let start = span.start + (inner.len() - inner.trim_start().len());
    start..start + inner.trim().len()
}

#[cfg(test)]
mod tests {
    use crate::input::diagnostic::{Problems, Styling};
    use crate::input::document::Document;
    use crate::input::document::reader::by_name::ByName;
    use crate::quantity::Dimension;

    const FILE: &str = "[drive]\nmean = \"10 N\"\n[sweep]\nfrequency = [1, 2]\n";

    fn document() -> Document {
        Document::parse("sweep.toml", FILE).expect("it is TOML")
    }

    /// What `--set` with this argument is refused with.
    fn refusal(argument: &str) -> String {
        match document().set(argument) {
            Ok(()) => "accepted".to_owned(),
            Err(diagnostics) => diagnostics.render(Styling::Plain),
        }
    }

    fn mean_after(argument: &str) -> Option<f64> {
        let mut document = document();
        document.set(argument).expect("it can be set");
        let problems = Problems::new();
        let mut drive = ByName(document.root(&problems)).table("drive")?;
        Some(drive.quantity("mean", Dimension::Force)?.value)
    }

    #[test]
    fn a_quantity_may_be_set_with_inner_quotes_or_without() {
        for argument in [
            "drive.mean=12 N",
            "drive.mean=\"12 N\"",
            "drive.mean='12 N'",
            " drive . mean = 12 N ",
            "drive.mean=12",
            "drive={mean=\"12 N\"}",
        ] {
            assert_eq!(mean_after(argument), Some(12.0), "{argument}");
        }
    }

    #[test]
    fn tables_on_the_way_are_made_and_whole_tables_replace_what_was_there() {
        let mut document = document();
        for argument in [
            "a.b.c=1_000",
            "sweep={frequency={from=\"1 Hz\", points=3}}",
            "title=2024-01-01",
            "d=x=y",
        ] {
            document.set(argument).expect("it can be set");
        }
        let problems = Problems::new();
        let mut root = ByName(document.root(&problems));
        let mut b = root
            .table("a")
            .and_then(|mut a| a.table("b"))
            .expect("made");
        assert_eq!(b.number("c").map(|found| found.value), Some(1000.0));
        let mut frequency = root
            .table("sweep")
            .and_then(|mut sweep| sweep.table("frequency"))
            .expect("replaced");
        let from = frequency.quantity("from", Dimension::Frequency);
        assert_eq!(from.map(|found| found.value), Some(1.0));
        let title = root.string("title").map(|found| found.value);
        assert_eq!(title.as_deref(), Some("2024-01-01"));
        let text = root.string("d").map(|found| found.value);
        assert_eq!(text.as_deref(), Some("x=y"));
        assert!(problems.is_empty());
    }

    #[test]
    fn the_last_of_two_flags_counts() {
        let mut document = document();
        document.set("drive.mean=1 N").expect("it can be set");
        document.set("drive.mean=2 N").expect("it can be set");
        let problems = Problems::new();
        let mean = ByName(document.root(&problems))
            .table("drive")
            .and_then(|mut drive| drive.quantity("mean", Dimension::Force));
        assert_eq!(mean.map(|found| found.value), Some(2.0));
    }

    #[test]
    fn a_flag_without_a_key_or_a_value_is_refused() {
        insta::assert_snapshot!(refusal("cycle.steps"), @r#"
        error: `--set` needs a key and a value
        --> command line:1:7
         |
         | --set cycle.steps
         |       ^^^^^^^^^^^ no `=` in here
         |
         = help: write `--set KEY=VALUE`, such as `--set cycle.steps=200`
        "#);
        insta::assert_snapshot!(refusal("cycle..steps=3"), @r#"
        error: `--set` needs a dotted key before `=`
        --> command line:1:13
         |
         | --set cycle..steps=3
         |             ^ expected letters, digits, `_` or `-`
         |
         = help: write `--set KEY=VALUE`, such as `--set cycle.steps=200`
        "#);
        insta::assert_snapshot!(refusal("cycle.steps="), @r#"
        error: a value is missing
        --> command line:1:19
         |
         | --set cycle.steps=
         |                   ^ expected a value here
         |
         = help: for an empty text write `""`
        "#);
    }

    #[test]
    fn a_key_below_a_value_is_refused_and_shows_the_value() {
        insta::assert_snapshot!(refusal("drive.mean.value=3"), @r#"
        error: `drive.mean` is a string, with no keys below it
         --> command line:1:13
          |
          | --set drive.mean.value=3
          |             ^^^^ a key below this was to be set
          |
         ::: sweep.toml:2:8
          |
        2 | mean = "10 N"
          |        ------ a string is given here
          |
          = help: set it whole: `--set drive.mean=VALUE`
        "#);
        insta::assert_snapshot!(refusal("sweep.frequency.from=3"), @r#"
        error: `sweep.frequency` is an array, with no keys below it
         --> command line:1:13
          |
          | --set sweep.frequency.from=3
          |             ^^^^^^^^^ a key below this was to be set
          |
         ::: sweep.toml:4:13
          |
        4 | frequency = [1, 2]
          |             ------ an array is given here
          |
          = help: set it whole: `--set sweep.frequency=VALUE`
        "#);
    }

    #[test]
    fn a_value_that_opens_as_toml_must_be_toml() {
        insta::assert_snapshot!(refusal("sweep.frequency={from=1 Hz, to=2}"), @r#"
        error: text must be in quotes
        --> command line:1:29
         |
         | --set sweep.frequency={from=1 Hz, to=2}
         |                             ^^^^ not a number, a boolean or quoted text
         |
         = help: write `"1 Hz"`
        "#);
        insta::assert_snapshot!(refusal("title=\"open"), @r#"
        error: invalid TOML: invalid basic string
        --> command line:1:18
         |
         | --set title="open
         |                  ^ expected `"`
        "#);
    }

    #[test]
    fn a_refused_flag_leaves_the_document_as_it_was() {
        let mut document = document();
        assert!(document.set("drive.mean.value=3").is_err());
        assert!(document.set("new.table.x=[").is_err());
        let problems = Problems::new();
        let mut root = ByName(document.root(&problems));
        assert!(!root.has("new"));
    }

    #[test]
    fn a_key_of_endless_depth_is_refused() {
        let argument = format!("{}=1", vec!["a"; 100_000].join("."));
        assert!(refusal(&argument).contains("more than 16 levels"));
    }
}
