//! Assignments: a value in place of what stands at a path of the document. `--set KEY=VALUE` is one, and an axis of a sweep is one for
//! each of its values.
//!
//! Items of lists have numbers from 0: `asperities.1.radius`, or `asperities[1].radius` as messages say it; the number behind the
//! last one adds an item. `--set KEY=` removes a key. A key of a flag that takes the place of others in the file removes those.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use toml::de::DeValue;

use super::diagnostic::{Diagnostic, Diagnostics, Location, Source};
use super::document::Document;
use super::document::reader::{in_backticks, join};
use super::document::syntax;
use super::document::tree::{Entry, Node, Table, Value};
use super::keys::tables_at;

/// What stands before the argument in the text of the flag.
const PREFIX: &str = "--set ";

/// Deepest key accepted; sweep files have three levels.
const MAX_DEPTH: usize = 16;

/// The keys of tables, and the numbers of items of lists, that lead to a value of a document.
#[derive(Debug, Clone, Default)]
pub(super) struct Path(Vec<Step>);

/// One of them, and where it is written.
#[derive(Debug, Clone)]
struct Step {
    word: String,
    place: Location,
}

impl Step {
    /// The number of an item, if it is one.
    fn number(&self) -> Option<usize> {
        self.word.parse().ok()
    }
}

/// As messages write it: `material.isotherm[0].temperature`.
impl fmt::Display for Path {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.text(|number| format!("[{number}]")))
    }
}

impl Path {
    /// The same with the words of a dotted key behind it, all written at this place. A key that is not made of words is one.
    pub(super) fn and(&self, key: &str, place: &Location) -> Self {
        let words = match words_of(key) {
            Ok(words) if words.len() <= MAX_DEPTH => words.into_iter().map(|w| &key[w]).collect(),
            _ => vec![key],
        };
        let words = words.into_iter().map(|word| Step {
            word: word.to_owned(),
            place: place.clone(),
        });
        Self(self.0.iter().cloned().chain(words).collect())
    }

    /// The path without the numbers of items: `material.isotherm[].temperature`.
    pub(super) fn general(&self) -> String {
        self.text(|_| "[]".to_owned())
    }

    fn text(&self, item: fn(usize) -> String) -> String {
        self.0
            .iter()
            .fold(String::new(), |text, step| match step.number() {
                Some(number) => text + &item(number),
                None => join(&text, &step.word),
            })
    }

    /// What stands there, if something does.
    pub(super) fn find<'a>(&self, root: &'a Table) -> Option<&'a Node> {
        let (first, below) = self.0.split_first()?;
        let start = &root.entries.get(&first.word)?.node;
        below
            .iter()
            .try_fold(start, |node, step| match &node.value {
                Value::Table(table) => Some(&table.entries.get(&step.word)?.node),
                Value::Array(items) => items.get(step.number()?),
                _ => None,
            })
    }

    /// Puts a value in place of what stands there. Tables on the way are made when missing.
    ///
    /// # Errors
    /// Something on the way that is neither table nor list.
    pub(super) fn set(&self, root: &mut Table, value: Node) -> Result<(), Diagnostic> {
        let change = Change {
            new: Some(value),
            excludes: false,
        };
        change.in_table(root, "", &self.0)
    }
}

impl Document {
    /// Applies the argument of a `--set` flag, `cycle.steps=200`: a dotted key, and a TOML value.
    ///
    /// What is not TOML counts as a string, so `drive.mean=10 N` needs no inner quotes; but what opens with a
    /// quote, bracket or brace must be TOML. Tables on the way to the key are made when missing; a value that
    /// is there is replaced whole. Items of lists have numbers from 0 (`asperities.1.radius`); without a value the
    /// key is removed. Keys of the file that the new one excludes, as a cone excludes a radius, are removed too.
    /// Problems with the value found later point into the flag.
    ///
    /// # Errors
    /// No `=`, a key that is not dotted words, a value that opens as TOML but is not, a key below
    /// something that is neither table nor list, nothing to remove. The document is then unchanged.
    pub fn set(&mut self, argument: &str) -> Result<(), Diagnostics> {
        let source = Source::flag(format!("{PREFIX}{argument}"), self.flags);
        self.flags = self.flags.saturating_add(1);
        let (path, new) = flag(&source)?;
        // A refused flag leaves everything as it was.
        let mut changed = self.root.clone();
        let excludes = new.is_some();
        Change { new, excludes }.in_table(&mut changed, "", &path.0)?;
        self.root = changed;
        Ok(())
    }
}

/// Path and value of the flag whose text is `source`; no value where it removes a key.
fn flag(source: &Arc<Source>) -> Result<(Path, Option<Node>), Diagnostics> {
    let text = source.text();
    let Some(equals) = text.find('=') else {
        let place = Location::new(source, PREFIX.len()..text.len());
        return Err(Diagnostic::at(&place, "`--set` needs a key and a value")
            .because("no `=` in here")
            .help("write `--set KEY=VALUE`, such as `--set cycle.steps=200`")
            .into());
    };
    let key = Location::new(source, PREFIX.len()..equals);
    let word = |word: Range<usize>| {
        Location::new(source, PREFIX.len() + word.start..PREFIX.len() + word.end)
    };
    let words = words_of(key.text()).map_err(|unfit| {
        Diagnostic::at(&word(unfit), "`--set` needs a dotted key before `=`")
            .because("expected letters, digits, `_` or `-`")
            .help("write `--set KEY=VALUE`, such as `--set cycle.steps=200`")
    })?;
    if words.len() > MAX_DEPTH {
        let message = format!("the key has more than {MAX_DEPTH} levels");
        return Err(Diagnostic::at(&key, message).into());
    }
    let steps = words.into_iter().map(|found| Step {
        word: key.text()[found.clone()].to_owned(),
        place: word(found),
    });
    let value = value(source, trimmed(text, equals + 1..text.len()))?;
    Ok((Path(steps.collect()), value))
}

/// The words of a dotted key, or where the first thing stands that is none.
fn words_of(key: &str) -> Result<Vec<Range<usize>>, Range<usize>> {
    let mut words = Vec::new();
    let mut start = 0;
    for word in key.split(['.', '[']) {
        let opened = start > 0 && key.as_bytes()[start - 1] == b'[';
        let place = trimmed(key, start..start + word.len());
        start += word.len() + 1;
        let closed = opened && key[place.clone()].ends_with(']');
        let place = place.start..place.end - usize::from(closed);
        let is_key =
            |character: char| character.is_ascii_alphanumeric() || "_-".contains(character);
        let is_word = !place.is_empty() && key[place.clone()].chars().all(is_key);
        if !is_word || opened != closed {
            return Err(place);
        }
        words.push(place);
    }
    Ok(words)
}

/// The value, which is a string where it is not TOML and does not set out to be; `None` where there is none, to remove the key.
fn value(source: &Arc<Source>, span: Range<usize>) -> Result<Option<Node>, Diagnostic> {
    let location = Location::new(source, span.clone());
    let text = location.text();
    let value = match DeValue::parse(text) {
        // Bare dates are titles and names here: no key of a sweep file is a date.
        Ok(value) if !value.get_ref().is_datetime() => {
            Node::from_toml(value.span(), value.into_inner(), source, span.start).value
        }
        Err(_) if text.is_empty() => return Ok(None),
        Err(_) if text.starts_with(syntax::CURLY) => {
            let inside = text.trim_matches(syntax::CURLY);
            return Err(Diagnostic::at(&location, "curly quotes enclose no text")
                .because("taken for a part of the text")
                .help(format!("write `{inside}`, in straight quotes or in none")));
        }
        Err(error) if text.starts_with(['"', '\'', '[', '{']) => {
            return Err(syntax::explain_value(source, &error, span.start));
        }
        _ => Value::Text(text.to_owned()),
    };
    Ok(Some(Node { value, location }))
}

/// A value on its way to its place, or the removal of what stands there.
struct Change {
    new: Option<Node>,
    /// Whether what the file says under keys that exclude those on the way gives way.
    excludes: bool,
}

impl Change {
    /// Carries it out where these steps lead from the table that is called `path`.
    fn in_table(self, table: &mut Table, path: &str, steps: &[Step]) -> Result<(), Diagnostic> {
        let Some((step, below)) = steps.split_first() else {
            return Ok(());
        };
        let name = step.word.as_str();
        // The same path, or one that goes on from it, may be given as one key in quotes.
        let quoted = |key: &String, whole: bool| {
            let words = quoted_words(key);
            let is_there = words.len() == steps.len() || (!whole && words.len() > steps.len());
            is_there
                && words
                    .iter()
                    .zip(steps)
                    .all(|(word, step)| *word == step.word)
        };
        if let Some(word) = table.entries.keys().find(|key| quoted(key, true)) {
            let (word, place) = (word.clone(), step.place.clone());
            return self.in_table(table, path, &[Step { word, place }]);
        }
        let given = table.entries.len();
        table.entries.retain(|key, _| !quoted(key, false));
        if self.new.is_none() && table.entries.len() < given && !table.entries.contains_key(name) {
            return Ok(());
        }
        let full = join(path, name);
        if self.new.is_none() && !table.entries.contains_key(name) {
            let given: Vec<&str> = table.entries.keys().map(String::as_str).collect();
            let problem = Diagnostic::at(&step.place, format!("`{full}` is not set"))
                .because("nothing to remove");
            return Err(match given.as_slice() {
                [] => problem,
                _ => problem.help(format!("set here: {}", in_backticks(&given))),
            });
        }
        let excludes = self.excludes;
        let entry = |node| Entry {
            key: step.place.clone(),
            node,
        };
        match (below, self.new) {
            ([], None) => drop(table.entries.remove(name)),
            ([], Some(node)) => drop(table.entries.insert(name.to_owned(), entry(node))),
            (_, new) => {
                let empty = || entry(Node::empty_table(&step.place));
                let entry = table.entries.entry(name.to_owned()).or_insert_with(empty);
                Self { new, excludes }.in_node(&mut entry.node, &full, below)?;
            }
        }
        if excludes {
            remove_excluded(table, path, name);
        }
        Ok(())
    }

    /// The same from a node that is called `path`.
    fn in_node(self, node: &mut Node, path: &str, steps: &[Step]) -> Result<(), Diagnostic> {
        let Some((step, below)) = steps.split_first() else {
            return Ok(());
        };
        let (found, place) = (node.describe(), node.location.clone());
        let refused = |message: String, because: &str, label: String| {
            Diagnostic::at(&step.place, message)
                .because(because)
                .label(&place, label)
                .help(format!("set it whole: `--set {path}=VALUE`"))
        };
        let items = match &mut node.value {
            Value::Table(table) => return self.in_table(table, path, steps),
            Value::Array(items) => items,
            _ => {
                return Err(refused(
                    format!("`{path}` is {found}, with no keys below it"),
                    "a key below this was to be set",
                    format!("{found} is given here"),
                ));
            }
        };
        let most = items.len() + usize::from(self.new.is_some());
        let Some(number) = step.number().filter(|number| *number < most) else {
            let message = format!("`{path}` is an array of {}", items.len());
            let because = "expected the number of an item, from 0";
            return Err(refused(message, because, "the array".to_owned()));
        };
        if number == items.len() {
            items.push(Node::empty_table(&step.place));
        }
        match (below, self.new) {
            ([], None) => drop(items.remove(number)),
            ([], Some(node)) => items[number] = node,
            (_, new) => {
                let excludes = self.excludes;
                let item = format!("{path}[{number}]");
                Self { new, excludes }.in_node(&mut items[number], &item, below)?;
            }
        }
        Ok(())
    }
}

/// The words of a key in quotes that is a path, such as `"material.temperature"`; none of any other key.
fn quoted_words(key: &str) -> Vec<&str> {
    let words = key.contains(['.', '[']).then(|| words_of(key).ok());
    let words = words.flatten().into_iter().flatten();
    words.map(|word| &key[word]).collect()
}

/// Removes what the file says under keys that the one just set excludes. What a flag says stays, and is told to be too much.
fn remove_excluded(table: &mut Table, path: &str, set: &str) {
    let word = |key: &str| match table.entries.get(key).map(|entry| &entry.node.value) {
        Some(Value::Text(word)) => Some(word.as_str()),
        _ => None,
    };
    let rows = tables_at(path).into_iter();
    let excluded: Vec<&str> = rows.flat_map(|rows| rows.excluded_by(set, &word)).collect();
    let was_given =
        |name: &str, entry: &Entry| excluded.contains(&name) && !entry.key.source().is_flag();
    table.entries.retain(|name, entry| !was_given(name, entry));
}

/// A span without the spaces at its ends.
fn trimmed(text: &str, span: Range<usize>) -> Range<usize> {
    let inner = &text[span.clone()];
    let start = span.start + (inner.len() - inner.trim_start().len());
    start..start + inner.trim().len()
}

#[cfg(test)]
mod tests {
    use super::{Table, Value};
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
        insta::assert_snapshot!(refusal("drive.mean=“10 N”"), @r#"
        error: curly quotes enclose no text
        --> command line:1:18
         |
         | --set drive.mean=“10 N”
         |                  ^^^^^^ taken for a part of the text
         |
         = help: write `10 N`, in straight quotes or in none
        "#);
    }

    #[test]
    fn a_key_below_a_value_is_refused_and_shows_the_value() {
        insta::assert_snapshot!(refusal("drive.mean.value=3"), @r#"
        error: `drive.mean` is a string, with no keys below it
         --> command line:1:18
          |
          | --set drive.mean.value=3
          |                  ^^^^^ a key below this was to be set
          |
         ::: sweep.toml:2:8
          |
        2 | mean = "10 N"
          |        ------ a string is given here
          |
          = help: set it whole: `--set drive.mean=VALUE`
        "#);
        insta::assert_snapshot!(refusal("sweep.frequency.from=3"), @r#"
        error: `sweep.frequency` is an array of 2
         --> command line:1:23
          |
          | --set sweep.frequency.from=3
          |                       ^^^^ expected the number of an item, from 0
          |
         ::: sweep.toml:4:13
          |
        4 | frequency = [1, 2]
          |             ------ the array
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
        assert!(document.set("new.drive=1").is_ok() && document.set("new=").is_ok());
        assert!(document.set("drive.mean.value=3").is_err());
        assert!(document.set("new.item.0.x=").is_err());
        assert!(document.set("new.table.x=[").is_err());
        let problems = Problems::new();
        let mut root = ByName(document.root(&problems));
        assert!(!root.has("new"));
    }

    /// What is left of a file after flags, in the order of keys: `table.key` of everything that holds a value.
    fn keys_after(file: &str, flags: &[&str]) -> String {
        fn list(table: &super::Table, path: &str, keys: &mut Vec<String>) {
            for (name, entry) in &table.entries {
                let path = super::join(path, name);
                match &entry.node.value {
                    super::Value::Table(inner) => list(inner, &path, keys),
                    _ => keys.push(path),
                }
            }
        }
        let mut document = Document::parse("sweep.toml", file).expect("it is TOML");
        for flag in flags {
            document.set(flag).expect("it can be set");
        }
        let mut keys = Vec::new();
        list(&document.root, "", &mut keys);
        keys.join(" ")
    }

    #[test]
    fn a_key_that_excludes_others_of_the_file_takes_their_place() {
        for (file, flags, left) in [
            (
                "indenter = { shape = \"sphere\", radius = 1, offset = [0, 0] }",
                &["indenter.shape=cone", "indenter.half_angle=70 deg"][..],
                "indenter.half_angle indenter.offset indenter.shape",
            ),
            // A radius belongs to both; what is no key of any shape is told when the file is read.
            (
                "indenter = { shape = \"sphere\", radius = 1, x = 1 }",
                &["indenter.shape=flat-punch"],
                "indenter.radius indenter.shape indenter.x",
            ),
            // Of two flags neither gives way.
            (
                "indenter = { shape = \"sphere\" }",
                &["indenter.radius=1", "indenter.shape=cone"],
                "indenter.radius indenter.shape",
            ),
            (
                "sweep = { angular_frequency = { from = 1, to = 2 }, refine = true }",
                &["sweep.frequency=[1, 2]"],
                "sweep.frequency sweep.refine",
            ),
            (
                "material = { poisson_ratio = 0.4, relaxation = { equilibrium = 1 } }",
                &["material.library=pmma"],
                "material.library",
            ),
            (
                "material = { poisson_ratio = 0.4, relaxation = { equilibrium = 1 } }",
                &["material.zener.time=1 s", "material.poisson_ratio=0.3"],
                "material.poisson_ratio material.zener.time",
            ),
        ] {
            assert_eq!(keys_after(file, flags), left, "{flags:?}");
        }
    }

    #[test]
    fn an_item_of_a_list_is_set_added_and_removed_by_its_number() {
        const LIST: &str = "[[drive.segments]]\nkind = \"sine\"\nfrequency = 1\ncycles = 2\n\
                            [[drive.segments]]\nkind = \"step\"\nto = 1\n";
        fn segments(document: &Document) -> Vec<&Table> {
            let Value::Table(drive) = &document.root.entries["drive"].node.value else {
                panic!("a table");
            };
            let Value::Array(items) = &drive.entries["segments"].node.value else {
                panic!("an array");
            };
            let tables = items.iter().map(|item| match &item.value {
                Value::Table(table) => table,
                other => panic!("{}", other.describe()),
            });
            tables.collect()
        }
        let read = |flags: &[&str]| {
            let mut document = Document::parse("sweep.toml", LIST).expect("it is TOML");
            for flag in flags {
                document.set(flag).expect("it can be set");
            }
            let kinds = segments(&document).into_iter();
            let kinds = kinds.map(|table| match &table.entries["kind"].node.value {
                Value::Text(kind) => kind.clone(),
                other => panic!("{}", other.describe()),
            });
            kinds.collect::<Vec<_>>().join(" ")
        };
        for (flags, kinds) in [
            (&["drive.segments.1.kind=ramp"][..], "sine ramp"),
            (&["drive.segments[1].kind=ramp"], "sine ramp"),
            (&["drive.segments.0={kind=\"table\"}"], "table step"),
            (
                &["drive.segments.2.kind=ramp", "drive.segments[0]="],
                "step ramp",
            ),
        ] {
            assert_eq!(read(flags), kinds, "{flags:?}");
        }
        let mut document = Document::parse("sweep.toml", LIST).expect("it is TOML");
        for (flag, message) in [
            (
                "drive.segments.3.kind=ramp",
                "`drive.segments` is an array of 2",
            ),
            ("drive.segments.2=", "`drive.segments` is an array of 2"),
            (
                "drive.segments[x].kind=ramp",
                "`drive.segments` is an array of 2",
            ),
            ("drive.segments[0.kind=ramp", "needs a dotted key"),
            ("drive.segments.0].kind=ramp", "needs a dotted key"),
            ("drive.segments.0.to=", "`drive.segments[0].to` is not set"),
        ] {
            let refused = document.set(flag).unwrap_err().to_string();
            assert!(refused.contains(message), "{refused}");
        }
        // What is excluded within an item is the same as elsewhere.
        document
            .set("drive.segments.0.angular_frequency=1")
            .expect("it can be set");
        document
            .set("drive.segments.1.kind=sine")
            .expect("it can be set");
        let segments = segments(&document);
        let has = |segment: usize, key| segments[segment].entries.contains_key(key);
        assert!(has(0, "angular_frequency") && !has(0, "frequency") && has(0, "cycles"));
        assert!(!has(1, "to"));
    }

    #[test]
    fn what_is_not_set_cannot_be_removed() {
        insta::assert_snapshot!(refusal("drive.maen="), @r"
        error: `drive.maen` is not set
        --> command line:1:13
         |
         | --set drive.maen=
         |             ^^^^ nothing to remove
         |
         = help: set here: `mean`
        ");
        assert_eq!(keys_after(FILE, &["drive.mean="]), "sweep.frequency");
        assert_eq!(keys_after(FILE, &["sweep="]), "drive.mean");
    }

    #[test]
    fn a_key_of_endless_depth_is_refused() {
        let argument = format!("{}=1", vec!["a"; 100_000].join("."));
        assert!(refusal(&argument).contains("more than 16 levels"));
    }
}
