//! Reading a table key by key: typed values, and a report of everything that is wrong.

use std::path::Path;

use super::Located;
use super::kind::{Asked, Describe, Spot};
use super::similar::similar;
use super::tree::{Entry, Node, Table, Value};
use crate::input::diagnostic::{Diagnostic, Location, Problems, Reported};
use crate::quantity::block::Field;
use crate::quantity::key::{Key, Kind};
use crate::quantity::{Dimension, setting};

/// Reads one table. Keys asked for are remembered; [`TableReader::finish`] reports the others.
#[derive(Debug)]
#[must_use = "a table that is not read and finished hides its mistakes"]
pub(crate) struct TableReader<'a> {
    table: &'a Table,
    /// The header, or the file for the top of it.
    location: Location,
    /// Full dotted key, empty at the top of the file.
    path: String,
    /// Where paths to files start from.
    folder: &'a Path,
    problems: &'a Problems,
    /// Of numbers that may have several.
    dimension: Option<Dimension>,
    asked: Vec<String>,
    /// Reports of absent keys: taken back when an unknown key turns out to be one of them, misspelt.
    missing: Vec<(Vec<String>, Reported<'a>)>,
}

impl AsRef<Location> for TableReader<'_> {
    fn as_ref(&self) -> &Location {
        &self.location
    }
}

/// Looking around.
impl<'a> TableReader<'a> {
    pub(crate) fn new(
        table: &'a Table,
        location: Location,
        path: String,
        problems: &'a Problems,
    ) -> Self {
        Self {
            table,
            location,
            path,
            folder: Path::new(""),
            problems,
            dimension: None,
            asked: Vec::new(),
            missing: Vec::new(),
        }
    }

    /// The same, in whose document paths to files start from this folder.
    pub(crate) fn in_folder(self, folder: &'a Path) -> Self {
        Self { folder, ..self }
    }

    /// Reads from now on numbers that may have several dimensions as such of this one, in tables below too.
    pub(crate) fn choose(&mut self, dimension: Dimension) {
        self.dimension = Some(dimension);
    }

    /// Where paths to files start from.
    pub(crate) fn folder(&self) -> &'a Path {
        self.folder
    }

    /// Where problems are reported.
    pub(crate) fn problems(&self) -> &'a Problems {
        self.problems
    }

    /// Whether a key is present, with a right value or a wrong one. Counts as asking for it.
    pub(crate) fn has(&mut self, key: &Key) -> bool {
        self.find(key.name).is_some()
    }

    /// Where a key itself is written, `None` when it is absent. Counts as asking for it.
    pub(crate) fn key_location(&mut self, key: &Key) -> Option<Location> {
        self.place_of(key.name)
    }

    /// The same of a key of this name.
    pub(crate) fn place_of(&mut self, key: &str) -> Option<Location> {
        self.find(key).map(|entry| entry.key.clone())
    }

    /// Where the value under a key of this name is written.
    pub(crate) fn value_place(&mut self, key: &str) -> Option<Location> {
        self.find(key).map(|entry| entry.node.location.clone())
    }

    /// Where the items of a list are written; of a single value in its place, where that is.
    pub(crate) fn places_in(&mut self, key: &str) -> Vec<Location> {
        match self.find(key).map(|entry| &entry.node) {
            None => Vec::new(),
            Some(Node {
                value: Value::Array(items),
                ..
            }) => items.iter().map(|item| item.location.clone()).collect(),
            Some(node) => vec![node.location.clone()],
        }
    }

    /// What stands under a key, and then under those in quotes that lead below it, `material` and `"material.temperature"`. Counts as
    /// asking for them.
    pub(in crate::input) fn with_quoted(&mut self, key: &str) -> Vec<(&'a str, &'a Entry)> {
        let below = |found: &str| {
            found
                .strip_prefix(key)
                .is_some_and(|rest| rest.starts_with('.'))
        };
        let all = self.table.entries.iter();
        let all = all.filter(|(found, _)| *found == key || below(found));
        let all: Vec<_> = all.map(|(found, entry)| (found.as_str(), entry)).collect();
        // The key itself may be there.
        self.find(key);
        for (found, _) in &all {
            self.find(found);
        }
        all
    }

    /// The value that belongs to the one of these keys that is present. None, or more than one, is a problem, and reported.
    pub(crate) fn one_of<T: Copy>(&mut self, choices: &[(&Key, T)]) -> Option<T> {
        let present: Vec<(&str, T, &Entry)> = choices
            .iter()
            .filter_map(|(key, value)| Some((key.name, *value, self.find(key.name)?)))
            .collect();
        match present.as_slice() {
            [(_, value, _)] => Some(*value),
            [] => {
                let keys: Vec<&str> = choices.iter().map(|(key, _)| key.name).collect();
                let message = match self.path.as_str() {
                    "" => format!("missing one of {}", in_backticks(&keys)),
                    path => format!("`{path}` needs one of {}", in_backticks(&keys)),
                };
                let problem = Diagnostic::at(&self.location, message).help("add one of them");
                self.report_missing(&keys, problem);
                None
            }
            [(_, _, entry), others @ ..] => {
                let given: Vec<&str> = present.iter().map(|(key, ..)| *key).collect();
                let message = format!("only one of {} may be given", in_backticks(&given));
                let problem = Diagnostic::at(&entry.key, message).because("one of them");
                let problem = others.iter().fold(problem, |problem, (_, _, entry)| {
                    problem.label(&entry.key, "another")
                });
                self.problems.push(problem.help("remove all but one"));
                None
            }
        }
    }

    /// Reports every key that was not asked for. Call it when all keys of the table were.
    pub(crate) fn finish(mut self) {
        // Keys in quotes that lead below others are none that a message lists.
        let asked = self.asked.iter().map(String::as_str);
        let asked: Vec<&str> = asked.filter(|key| !key.contains('.')).collect();
        for (key, entry) in &self.table.entries {
            if self.asked.contains(key) {
                continue;
            }
            // Of a path in quotes it may be the first word that is wrong.
            let word = key.split('.').next().filter(|word| !asked.contains(word));
            let (key, meant) = match word.and_then(|word| Some((word, similar(word, &asked)?))) {
                Some((word, meant)) => (word, Some(meant)),
                None => (key.as_str(), similar(key, &asked)),
            };
            self.problems.push(self.unknown(key, entry, meant, &asked));
            let is_meant = |absent: &String| meant == Some(absent);
            let mut missing = self.missing.iter();
            if let Some(index) = missing.position(|(keys, _)| keys.iter().any(is_meant)) {
                self.missing.swap_remove(index).1.retract();
            }
        }
    }

    /// A key nobody asked for, where perhaps `meant` was meant.
    fn unknown(&self, key: &str, entry: &Entry, meant: Option<&str>, asked: &[&str]) -> Diagnostic {
        let path = join(&self.path, key);
        let problem = Diagnostic::at(&entry.key, format!("unknown key `{path}`"));
        let Some(meant) = meant else {
            let help = match asked {
                [] => "remove it: no key is allowed here".to_owned(),
                [..] => format!("keys allowed here: {}", in_backticks(asked)),
            };
            return problem.because("not a key of this table").help(help);
        };
        match self.table.entries.get(meant) {
            Some(given) => problem
                .because(format!("similar to `{meant}`"))
                .label(&given.key, format!("`{meant}` is given here"))
                .help(format!(
                    "remove `{key}`, or `{meant}` and write that in its place"
                )),
            None => problem
                .because(format!("did you mean `{meant}`?"))
                .help(format!("write `{meant}` instead of `{key}`")),
        }
    }

    /// Looks `key` up, and remembers that it may be here.
    fn find(&mut self, key: &str) -> Option<&'a Entry> {
        if !self.asked.iter().any(|asked| asked == key) {
            self.asked.push(key.to_owned());
        }
        self.table.entries.get(key)
    }

    /// What stands under a key as it was parsed. Counts as asking for it.
    pub(crate) fn node(&mut self, key: &Key) -> Option<&'a Node> {
        self.find(key.name).map(|entry| &entry.node)
    }

    fn report_missing(&mut self, keys: &[&str], problem: Diagnostic) {
        let keys = keys.iter().map(|key| (*key).to_owned()).collect();
        self.missing.push((keys, self.problems.push(problem)));
    }
}

/// Values and tables below.
impl<'a> TableReader<'a> {
    /// What stands under a key, or counts without it, with its place; `None` where a problem was reported.
    pub(crate) fn read<T: Field>(&mut self, key: &Key) -> Option<Located<T>> {
        if let Some(found) = self.read_if(key)? {
            return Some(found);
        }
        let value = key.default().and_then(T::of).or_else(T::absent);
        if value.is_none() {
            self.report_absent(key);
        }
        Some(self.in_place_of(key.name, value?))
    }

    /// The same without its place.
    pub(crate) fn value<T: Field>(&mut self, key: &Key) -> Option<T> {
        self.read(key).map(|located| located.value)
    }

    /// What the word under a key stands for in a table, where there is one; `None` where a problem was reported.
    pub(crate) fn chosen<T: Clone>(&mut self, key: &Key, table: &[(&str, T)]) -> Option<Option<T>> {
        let word: Option<String> = self.value(key)?;
        let found = word.and_then(|word| table.iter().find(|(known, _)| *known == word));
        Some(found.map(|(_, chosen)| chosen.clone()))
    }

    /// What stands under a key, where it is there, with its place; `None` where that is wrong, which is reported.
    pub(crate) fn read_if<T: Field>(&mut self, key: &Key) -> Option<Option<Located<T>>> {
        match self.under(key)? {
            None => Some(None),
            Some(Located {
                value,
                path,
                location,
            }) => {
                let value = T::of(value)?;
                Some(Some(Located {
                    value,
                    path,
                    location,
                }))
            }
        }
    }

    /// The same as it is written in a file.
    pub(super) fn under(&mut self, key: &Key) -> Option<Option<Located<setting::Value>>> {
        let Some(entry) = self.find(key.name) else {
            return Some(None);
        };
        let path = join(&self.path, key.name);
        let spot = Spot {
            path: &path,
            key: Some(key.name),
        };
        let chosen = self.dimension.map(|dimension| key.kind.of(dimension));
        let asked = Asked {
            kind: chosen.as_ref().unwrap_or(&key.kind),
            node: &entry.node,
            spot: &spot,
        };
        match asked.read() {
            Ok(value) => Some(Some(spot.located(value, &entry.node))),
            Err(diagnostics) => {
                self.problems.extend(diagnostics);
                None
            }
        }
    }

    /// The table under a key, inline or under a header.
    pub(crate) fn table(&mut self, key: &Key) -> Option<TableReader<'a>> {
        match self.has(key) {
            true => self.below(key.name),
            false => {
                self.report_absent(key);
                None
            }
        }
    }

    /// The table under a key as it was parsed, where there is one. Counts as asking for it.
    pub(crate) fn parsed(&mut self, key: &Key) -> Option<&'a Table> {
        self.find(key.name)?;
        self.table.table(key.name)
    }

    /// A document that has of this one such a table alone; `None` where it has none, which is reported.
    pub(in crate::input) fn alone(&mut self, key: &Key) -> Option<Table> {
        let is_table = self.table(key).is_some();
        let entry = self.find(key.name).filter(|_| is_table)?;
        let entries = [(key.name.to_owned(), entry.clone())].into();
        Some(Table { entries })
    }

    /// What a table that may be left out holds, or what counts without it.
    pub(crate) fn table_or<T>(
        &mut self,
        key: &Key,
        default: T,
        read: impl FnOnce(TableReader<'a>) -> Option<T>,
    ) -> Option<T> {
        match self.has(key) {
            true => self.below(key.name).and_then(read),
            false => Some(default),
        }
    }

    /// What a table under a key of this name holds, where there is one.
    pub(crate) fn table_if<T>(
        &mut self,
        key: &str,
        read: impl FnOnce(TableReader<'a>) -> Option<T>,
    ) -> Option<Option<T>> {
        match self.table.table(key) {
            Some(_) => self.below(key).and_then(read).map(Some),
            None => Some(None),
        }
    }

    /// The table `key`, which is there.
    fn below(&mut self, key: &str) -> Option<TableReader<'a>> {
        let node = &self.find(key)?.node;
        let path = join(&self.path, key);
        let header = header(&path);
        let help = format!("write `{header}` on a line of its own, with its keys below");
        self.as_table(node, path, &help)
    }

    /// A reader of what stands here, which must be a table.
    fn as_table(&self, node: &'a Node, path: String, help: &str) -> Option<TableReader<'a>> {
        if let Value::Table(table) = &node.value {
            return Some(Self {
                folder: self.folder,
                dimension: self.dimension,
                ..Self::new(table, node.location.clone(), path, self.problems)
            });
        }
        self.problems
            .at(&node.location, format!("`{path}` must be a table"))
            .because(format!("found {}", node.describe()))
            .help(help);
        None
    }

    /// What the tables in an array hold: `[[key]]`, or an inline array of inline tables. May be none. All are read, so that all
    /// problems are reported.
    pub(crate) fn tables<T>(
        &mut self,
        key: &Key,
        mut read: impl FnMut(TableReader<'a>) -> Option<T>,
    ) -> Option<Located<Vec<T>>> {
        let Some(node) = self.node(key) else {
            if key.is_required() {
                self.report_absent(key);
                return None;
            }
            return Some(self.in_place_of(key.name, Vec::new()));
        };
        let (name, path) = (key.name, join(&self.path, key.name));
        let Value::Array(items) = &node.value else {
            self.problems
                .at(
                    &node.location,
                    format!("`{path}` must be an array of tables"),
                )
                .because(format!("found {}", node.describe()))
                .help(array_of_tables(&path, name));
            return None;
        };
        if let Kind::Tables(_, most, instead) = key.kind
            && items.len() > most
        {
            let message = format!("{} {name} are too many", items.len());
            self.problems
                .at(&node.location, message)
                .help(format!("give at most {most}{instead}"));
            return None;
        }
        let readers = items.iter().enumerate().map(|(index, item)| {
            self.as_table(item, format!("{path}[{index}]"), "write `{ key = value }`")
        });
        let read: Vec<Option<T>> = readers.map(|reader| reader.and_then(&mut read)).collect();
        Some(Located {
            value: read.into_iter().collect::<Option<_>>()?,
            path,
            location: node.location.clone(),
        })
    }

    /// Reports a key that must be there and is not.
    pub(crate) fn report_absent(&mut self, key: &Key) {
        let path = join(&self.path, key.name);
        let missing = |what: String| Diagnostic::at(&self.location, format!("missing {what}"));
        let problem = missing(format!("key `{path}`"));
        let example = format!("`{} = {}`", key.name, key.kind.example());
        let problem = match &key.kind {
            Kind::Table(_) => {
                let header = header(&path);
                missing(format!("table `{header}`")).help(format!(
                    "add `{header}` on a line of its own, with its keys below"
                ))
            }
            Kind::Tables(..) => problem.help(array_of_tables(&path, key.name)),
            _ if self.location.is_whole() => {
                problem.help(format!("add {example} above the first table"))
            }
            kind => problem
                .because(format!("needs `{}`, {}", key.name, kind.expected()))
                .help(format!("add {example}")),
        };
        self.report_missing(&[key.name], problem);
    }

    /// A value that counts because the key is absent: its place is the table.
    pub(in crate::input) fn in_place_of<T>(&self, key: &str, value: T) -> Located<T> {
        Located {
            value,
            path: join(&self.path, key),
            location: self.location.clone(),
        }
    }
}

/// The dotted key of `key` in the table `path`.
pub(in crate::input) fn join(path: &str, key: &str) -> String {
    match path {
        "" => key.to_owned(),
        path => format!("{path}.{key}"),
    }
}

/// How a table is begun: `[drive]`; an item of an array has no header of its own.
fn header(path: &str) -> String {
    if path.contains('[') {
        path.to_owned()
    } else {
        format!("[{path}]")
    }
}

/// How an array of tables is written; within an item of an array there are no headers.
fn array_of_tables(path: &str, key: &str) -> String {
    let inline = format!("`{key} = [{{ ... }}]`");
    if path.contains('[') {
        format!("write {inline}, with one table for each item")
    } else {
        format!("write {inline}, or begin each item with `[[{path}]]`")
    }
}

pub(in crate::input) fn in_backticks(keys: &[&str]) -> String {
    let quoted: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
    quoted.join(", ")
}

/// Reading in tests, by names in place of rows.
#[cfg(test)]
pub(in crate::input) mod by_name {
    use super::{Located, TableReader};
    use crate::quantity::Dimension;
    use crate::quantity::block::Field;
    use crate::quantity::key::{Key, Kind, Presence, number, quantity};
    use crate::quantity::rows::{Rows, table};
    use crate::quantity::setting::Value;

    pub(in crate::input) static NOTHING: Rows = table("", &[]);

    pub(in crate::input) const fn key(name: &'static str, kind: Kind, presence: Presence) -> Key {
        Key {
            name,
            kind,
            presence,
            means: "",
        }
    }

    pub(in crate::input) const fn below(name: &'static str) -> Key {
        key(name, Kind::Table(&NOTHING), Presence::Required)
    }

    pub(in crate::input) const fn items(name: &'static str, presence: Presence) -> Key {
        key(name, Kind::Tables(&NOTHING, 2, ", or a table"), presence)
    }

    /// What stands under a key, whatever it is.
    pub(in crate::input) fn look(table: &mut TableReader<'_>, key: &Key) -> Option<Value> {
        match table.under(key)? {
            Some(found) => Some(found.value),
            None => key.default().or_else(|| {
                if key.is_required() {
                    table.report_absent(key);
                }
                None
            }),
        }
    }

    pub(in crate::input) struct ByName<'a>(pub(in crate::input) TableReader<'a>);

    #[allow(dead_code)] // Each test has its own part.
    impl<'a> ByName<'a> {
        pub(in crate::input) fn has(&mut self, name: &'static str) -> bool {
            self.0.has(&below(name))
        }

        pub(in crate::input) fn table(&mut self, name: &'static str) -> Option<Self> {
            self.0.table(&below(name)).map(Self)
        }

        pub(in crate::input) fn tables(
            &mut self,
            name: &'static str,
        ) -> Option<Located<Vec<Self>>> {
            self.0
                .tables(&items(name, Presence::Required), |item| Some(Self(item)))
        }

        pub(in crate::input) fn quantity(
            &mut self,
            name: &'static str,
            dimension: Dimension,
        ) -> Option<Located<f64>> {
            self.read(name, Kind::Number(quantity(dimension)))
        }

        pub(in crate::input) fn number(&mut self, name: &'static str) -> Option<Located<f64>> {
            self.read(name, Kind::Number(number("1.0")))
        }

        pub(in crate::input) fn string(&mut self, name: &'static str) -> Option<Located<String>> {
            self.read(name, Kind::Text)
        }

        fn read<T: Field>(&mut self, name: &'static str, kind: Kind) -> Option<Located<T>> {
            self.0.read(&key(name, kind, Presence::Required))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::by_name::{NOTHING, below, items, key, look};
    use crate::input::diagnostic::{Problems, Styling};
    use crate::input::document::reader::TableReader;
    use crate::input::document::{Document, Located};
    use crate::quantity::Dimension::{Angle, Force, Frequency, Stress, Time};
    use crate::quantity::key::Presence::{Optional, Or, Required};
    use crate::quantity::key::{Entries, Key, Kind, number, quantity};

    const CONTROLS: Kind = Kind::Word(&["load", "approach"]);

    /// What is reported when `read` reads `text` with `flags` set.
    fn report_with(text: &str, flags: &[&str], read: impl FnOnce(TableReader<'_>)) -> String {
        let mut document = Document::parse("sweep.toml", text).expect("the text is TOML");
        for flag in flags {
            document.set(flag).expect("the flag can be set");
        }
        let problems = Problems::new();
        read(document.root(&problems));
        match problems.into_result(Some(())) {
            Ok(()) => "no problem".to_owned(),
            Err(diagnostics) => diagnostics.render(Styling::Plain),
        }
    }

    fn report(text: &str, read: impl FnOnce(TableReader<'_>)) -> String {
        report_with(text, &[], read)
    }

    /// Reads every kind of key that a sweep file has.
    fn read_sweep(mut root: TableReader<'_>) {
        let _ = look(&mut root, &key("title", Kind::Text, Optional));
        if let Some(mut drive) = root.table(&below("drive")) {
            let _ = look(&mut drive, &key("control", CONTROLS, Required));
            let _ = look(
                &mut drive,
                &key("mean", Kind::Number(quantity(Force)), Required),
            );
            let _ = look(
                &mut drive,
                &key("amplitude", Kind::Number(quantity(Force)), Required),
            );
            let _ = look(
                &mut drive,
                &key(
                    "phase",
                    Kind::Number(quantity(Angle)),
                    Or(|| Some(0.0.into())),
                ),
            );
            drive.finish();
        }
        let cycle = key("cycle", Kind::Table(&NOTHING), Optional);
        let _ = root.table_or(&cycle, (), |mut cycle| {
            let _ = look(
                &mut cycle,
                &key(
                    "steps",
                    Kind::Integer(8..=10_000),
                    Or(|| Some(100_usize.into())),
                ),
            );
            let _ = look(
                &mut cycle,
                &key(
                    "tolerance",
                    Kind::Number(number("1e-4")),
                    Or(|| Some(1e-4.into())),
                ),
            );
            let _ = look(
                &mut cycle,
                &key("keep_history", Kind::Flag, Or(|| Some(false.into()))),
            );
            cycle.finish();
            None
        });
        root.finish();
    }

    const DRIVE: &str = "[drive]\ncontrol = \"load\"\nmean = \"10 N\"\namplitude = \"5 N\"\n";

    #[test]
    fn a_correct_file_is_read_without_a_word() {
        assert_eq!(report(DRIVE, read_sweep), "no problem");
    }

    #[test]
    fn an_unknown_key_gets_the_key_that_was_probably_meant() {
        let text = format!("{DRIVE}phse = 0.1\n[cycle]\nStep = 200\n");
        insta::assert_snapshot!(report(&text, read_sweep), @r#"
        error: unknown key `drive.phse`
         --> sweep.toml:5:1
          |
        5 | phse = 0.1
          | ^^^^ did you mean `phase`?
          |
          = help: write `phase` instead of `phse`

        error: unknown key `cycle.Step`
         --> sweep.toml:7:1
          |
        7 | Step = 200
          | ^^^^ did you mean `steps`?
          |
          = help: write `steps` instead of `Step`
        "#);
    }

    #[test]
    fn an_unknown_key_like_no_other_gets_the_list_of_keys() {
        let text = format!("{DRIVE}temperature = 300\n");
        insta::assert_snapshot!(report(&text, read_sweep), @r#"
        error: unknown key `drive.temperature`
         --> sweep.toml:5:1
          |
        5 | temperature = 300
          | ^^^^^^^^^^^ not a key of this table
          |
          = help: keys allowed here: `control`, `mean`, `amplitude`, `phase`
        "#);
    }

    #[test]
    fn an_unknown_table_is_shown_at_its_header() {
        let text = format!("{DRIVE}[sovler]\ncells = 3\n[cylce]\nsteps = 3\n");
        insta::assert_snapshot!(report(&text, read_sweep), @r#"
        error: unknown key `sovler`
         --> sweep.toml:5:2
          |
        5 | [sovler]
          |  ^^^^^^ not a key of this table
          |
          = help: keys allowed here: `title`, `drive`, `cycle`

        error: unknown key `cylce`
         --> sweep.toml:7:2
          |
        7 | [cylce]
          |  ^^^^^ did you mean `cycle`?
          |
          = help: write `cycle` instead of `cylce`
        "#);
    }

    #[test]
    fn a_key_like_one_that_is_already_given_is_shown_beside_it() {
        let text = format!("{DRIVE}amplitudes = \"6 N\"\n");
        insta::assert_snapshot!(report(&text, read_sweep), @r#"
        error: unknown key `drive.amplitudes`
         --> sweep.toml:5:1
          |
        4 | amplitude = "5 N"
          | --------- `amplitude` is given here
        5 | amplitudes = "6 N"
          | ^^^^^^^^^^ similar to `amplitude`
          |
          = help: remove `amplitudes`, or `amplitude` and write that in its place
        "#);
    }

    #[test]
    fn a_missing_key_is_shown_at_the_header_with_an_example() {
        let text = "title = \"x\"\n\n[drive]\ncontrol = \"load\"\namplitude = \"5 N\"\n";
        insta::assert_snapshot!(report(text, read_sweep), @r#"
        error: missing key `drive.mean`
         --> sweep.toml:3:1
          |
        3 | [drive]
          | ^^^^^^^ needs `mean`, a force
          |
          = help: add `mean = "10 N"`
        "#);
    }

    #[test]
    fn a_misspelt_required_key_is_one_problem_and_not_two() {
        let text = DRIVE.replace("mean", "maen");
        insta::assert_snapshot!(report(&text, read_sweep), @r#"
        error: unknown key `drive.maen`
         --> sweep.toml:3:1
          |
        3 | maen = "10 N"
          | ^^^^ did you mean `mean`?
          |
          = help: write `mean` instead of `maen`
        "#);
    }

    #[test]
    fn a_missing_key_below_several_tables_is_named_in_full() {
        let text = "[material]\npoisson_ratio = 0.38\n[material.relaxation.branches]\n";
        let text = report(text, |mut root| {
            let mut material = root.table(&below("material")).expect("it is there");
            let _ = look(
                &mut material,
                &key("poisson_ratio", Kind::Number(number("0.4")), Required),
            );
            let mut relaxation = material.table(&below("relaxation")).expect("it is there");
            let mut branches = relaxation.table(&below("branches")).expect("it is there");
            let _ = look(
                &mut relaxation,
                &key("equilibrium", Kind::Number(quantity(Stress)), Required),
            );
            let _ = look(
                &mut branches,
                &key(
                    "times",
                    Kind::Numbers(quantity(Time), Entries::ANY),
                    Required,
                ),
            );
            let _ = material.table(&below("creep"));
        });
        insta::assert_snapshot!(text, @r#"
        error: missing table `[material.creep]`
         --> sweep.toml:1:1
          |
        1 | [material]
          | ^^^^^^^^^^
          |
          = help: add `[material.creep]` on a line of its own, with its keys below

        error: missing key `material.relaxation.branches.times`
         --> sweep.toml:3:1
          |
        3 | [material.relaxation.branches]
          | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ needs `times`, an array, each item a time
          |
          = help: add `times = ["8.93 s"]`

        error: missing key `material.relaxation.equilibrium`
         --> sweep.toml:3:11
          |
        3 | [material.relaxation.branches]
          |           ^^^^^^^^^^ needs `equilibrium`, a stress or modulus
          |
          = help: add `equilibrium = "1973 MPa"`
        "#);
    }

    #[test]
    fn a_missing_key_of_the_top_belongs_above_the_first_table() {
        let text = report("[drive]\n", |mut root| {
            let _ = look(&mut root, &key("title", Kind::Text, Required));
        });
        insta::assert_snapshot!(text, @r#"
        error: missing key `title`
        --> sweep.toml
         = help: add `title = "..."` above the first table
        "#);
    }

    #[test]
    fn an_empty_file_lacks_its_tables() {
        insta::assert_snapshot!(report("", read_sweep), @r#"
        error: missing table `[drive]`
        --> sweep.toml
         = help: add `[drive]` on a line of its own, with its keys below
        "#);
    }

    #[test]
    fn a_wrong_type_names_what_was_found_and_what_is_expected() {
        let text = r#"title = 12
[drive]
control = 1
mean = true
amplitude = 1979-05-27
[cycle]
steps = "200"
tolerance = "1e-4"
keep_history = "yes"
"#;
        insta::assert_snapshot!(report(text, read_sweep), @r#"
        error: `title` must be a string
         --> sweep.toml:1:9
          |
        1 | title = 12
          |         ^^ found an integer
          |
          = help: write it in quotes: `title = "12"`

        error: `drive.control` must be "load" or "approach"
         --> sweep.toml:3:11
          |
        3 | control = 1
          |           ^ found an integer
          |
          = help: write "load" or "approach", such as `control = "load"`

        error: `drive.mean` must be a force
         --> sweep.toml:4:8
          |
        4 | mean = true
          |        ^^^^ found a boolean
          |
          = help: write a quantity with its unit, such as `mean = "10 N"`

        error: `drive.amplitude` must be a force
         --> sweep.toml:5:13
          |
        5 | amplitude = 1979-05-27
          |             ^^^^^^^^^^ found a date or time
          |
          = help: write a quantity with its unit, such as `amplitude = "10 N"`

        error: `cycle.steps` must be an integer from 8 to 10000
         --> sweep.toml:7:9
          |
        7 | steps = "200"
          |         ^^^^^ found a string
          |
          = help: write `steps = 200`

        error: `cycle.tolerance` must be a number
         --> sweep.toml:8:13
          |
        8 | tolerance = "1e-4"
          |             ^^^^^^ found a string
          |
          = help: write it without quotes: `tolerance = 0.0001`

        error: `cycle.keep_history` must be `true` or `false`
         --> sweep.toml:9:16
          |
        9 | keep_history = "yes"
          |                ^^^^^ found a string
          |
          = help: write `keep_history = true`
        "#);
    }

    #[test]
    fn a_value_in_the_place_of_a_table_is_refused() {
        insta::assert_snapshot!(report("drive = 3\ncycle = [1]\n", read_sweep), @r#"
        error: `drive` must be a table
         --> sweep.toml:1:9
          |
        1 | drive = 3
          |         ^ found an integer
          |
          = help: write `[drive]` on a line of its own, with its keys below

        error: `cycle` must be a table
         --> sweep.toml:2:9
          |
        2 | cycle = [1]
          |         ^^^ found an array
          |
          = help: write `[cycle]` on a line of its own, with its keys below
        "#);
    }

    #[test]
    fn a_wrong_unit_is_said_in_the_words_of_the_quantity() {
        let text = DRIVE.replace("10 N", "10 mm").replace("5 N", "5 bananas");
        insta::assert_snapshot!(report(&text, read_sweep), @r#"
        error: `drive.mean` must be a force
         --> sweep.toml:3:8
          |
        3 | mean = "10 mm"
          |        ^^^^^^^
          |
          = note: '10 mm' is a length, a force is expected, for example "10 N"
          = help: write a quantity with its unit, such as `mean = "10 N"`

        error: `drive.amplitude` must be a force
         --> sweep.toml:4:13
          |
        4 | amplitude = "5 bananas"
          |             ^^^^^^^^^^^
          |
          = note: '5 bananas' has the unknown unit 'bananas'; a force is written for
                  example "10 N"
          = help: write a quantity with its unit, such as `amplitude = "10 N"`
        "#);
    }

    #[test]
    fn numbers_that_cannot_be_computed_with_are_refused() {
        let text = r#"[drive]
control = "load"
mean = nan
amplitude = 1e400
phase = -inf
[cycle]
steps = 99999999999999999999
tolerance = 1e-400
"#;
        insta::assert_snapshot!(report(text, read_sweep), @r#"
        error: `drive.mean` must be a force
         --> sweep.toml:3:8
          |
        3 | mean = nan
          |        ^^^ `nan` is not a number
          |
          = help: write a force, such as `mean = "10 N"`

        error: `drive.amplitude` must be a force
         --> sweep.toml:4:13
          |
        4 | amplitude = 1e400
          |             ^^^^^ beyond the largest number, 1.8e308
          |
          = help: check the exponent; write a force, such as `amplitude = "10 N"`

        error: `drive.phase` must be an angle
         --> sweep.toml:5:9
          |
        5 | phase = -inf
          |         ^^^^ not finite
          |
          = help: write an angle, such as `phase = "90 deg"`

        error: `cycle.steps` must be an integer from 8 to 10000
         --> sweep.toml:7:9
          |
        7 | steps = 99999999999999999999
          |         ^^^^^^^^^^^^^^^^^^^^ out of this range
          |
          = help: write an integer from 8 to 10000, such as `steps = 100`

        error: `cycle.tolerance` must be a number
         --> sweep.toml:8:13
          |
        8 | tolerance = 1e-400
          |             ^^^^^^ below the smallest number, 4.9e-324
          |
          = help: check the exponent, or write `0.0`; write a number, such as
                  `tolerance = 1e-4`
        "#);
    }

    #[test]
    fn a_wrong_choice_gets_a_suggestion_or_the_list() {
        let text = DRIVE.replace("load", "laod");
        insta::assert_snapshot!(report(&text, read_sweep), @r#"
        error: `drive.control` must be "load" or "approach"
         --> sweep.toml:2:11
          |
        2 | control = "laod"
          |           ^^^^^^ did you mean "load"?
          |
          = help: write `control = "load"`
        "#);
        let text = DRIVE.replace("load", "velocity");
        insta::assert_snapshot!(report(&text, read_sweep), @r#"
        error: `drive.control` must be "load" or "approach"
         --> sweep.toml:2:11
          |
        2 | control = "velocity"
          |           ^^^^^^^^^^ "velocity" is none of these
          |
          = help: write, for example, `control = "load"`
        "#);
    }

    #[test]
    fn an_integer_out_of_range_or_written_as_a_float_is_refused() {
        let text = format!("{DRIVE}[cycle]\nsteps = 0\n");
        insta::assert_snapshot!(report(&text, read_sweep), @r#"
        error: `cycle.steps` must be an integer from 8 to 10000
         --> sweep.toml:6:9
          |
        6 | steps = 0
          |         ^ out of this range
          |
          = help: write an integer from 8 to 10000, such as `steps = 100`
        "#);
        let text = format!("{DRIVE}[cycle]\nsteps = 2e2\n");
        insta::assert_snapshot!(report(&text, read_sweep), @r#"
        error: `cycle.steps` must be an integer from 8 to 10000
         --> sweep.toml:6:9
          |
        6 | steps = 2e2
          |         ^^^ found a float
          |
          = help: write `steps = 200`
        "#);
    }

    #[test]
    fn a_wrong_value_from_a_flag_is_shown_in_the_flag() {
        let flags = ["cycle.steps=abc", "drive.mean = 10 mm", "cycle.stesp=3"];
        insta::assert_snapshot!(report_with(DRIVE, &flags, read_sweep), @r#"
        error: `cycle.steps` must be an integer from 8 to 10000
        --> command line:1:19
         |
         | --set cycle.steps=abc
         |                   ^^^ found a string
         |
         = help: write an integer from 8 to 10000, such as `--set cycle.steps=100`

        error: `drive.mean` must be a force
        --> command line:1:20
         |
         | --set drive.mean = 10 mm
         |                    ^^^^^
         |
         = note: '10 mm' is a length, a force is expected, for example "10 N"
         = help: write a quantity with its unit, such as `--set 'drive.mean=10 N'`

        error: unknown key `cycle.stesp`
        --> command line:1:13
         |
         | --set cycle.stesp=3
         |             ^^^^^ similar to `steps`
         |
        ::: command line:1:13
         |
         | --set cycle.steps=abc
         |             ----- `steps` is given here
         |
         = help: remove `stesp`, or `steps` and write that in its place
        "#);
    }

    #[test]
    fn help_for_a_flag_is_itself_a_flag() {
        let flags = ["title=12", "drive.control=laod", "cycle.keep_history=no"];
        insta::assert_snapshot!(report_with(DRIVE, &flags, read_sweep), @r#"
        error: `title` must be a string
        --> command line:1:13
         |
         | --set title=12
         |             ^^ found an integer
         |
         = help: write `--set 'title="12"'`

        error: `drive.control` must be "load" or "approach"
        --> command line:1:21
         |
         | --set drive.control=laod
         |                     ^^^^ did you mean "load"?
         |
         = help: write `--set drive.control=load`

        error: `cycle.keep_history` must be `true` or `false`
        --> command line:1:26
         |
         | --set cycle.keep_history=no
         |                          ^^ found a string
         |
         = help: write `--set cycle.keep_history=false`
        "#);
    }

    #[test]
    fn an_array_of_tables_may_be_written_both_ways_and_each_item_has_its_place() {
        let read = |mut root: TableReader<'_>| {
            let mut drive = root.table(&below("drive")).expect("it is there");
            let read = drive.tables(&items("segments", Required), |mut segment| {
                let _ = look(
                    &mut segment,
                    &key("to", Kind::Number(quantity(Force)), Required),
                );
                let _ = look(
                    &mut segment,
                    &key("duration", Kind::Number(quantity(Time)), Required),
                );
                segment.finish();
                Some(())
            });
            assert_eq!(read.expect("they are tables").value.len(), 2);
        };
        let inline =
            "[drive]\nsegments = [\n  { to = 1, duration = 2 },\n  { to = 3, time = 4 },\n]\n";
        insta::assert_snapshot!(report(inline, read), @r#"
        error: missing key `drive.segments[1].duration`
         --> sweep.toml:4:3
          |
        4 |   { to = 3, time = 4 },
          |   ^^^^^^^^^^^^^^^^^^^^ needs `duration`, a time
          |
          = help: add `duration = "8.93 s"`

        error: unknown key `drive.segments[1].time`
         --> sweep.toml:4:13
          |
        4 |   { to = 3, time = 4 },
          |             ^^^^ not a key of this table
          |
          = help: keys allowed here: `to`, `duration`
        "#);
        let headers =
            "[[drive.segments]]\nto = 1\nduration = 2\n[[drive.segments]]\nto = 3\ntime = 4\n";
        insta::assert_snapshot!(report(headers, read), @r#"
        error: missing key `drive.segments[1].duration`
         --> sweep.toml:4:1
          |
        4 | [[drive.segments]]
          | ^^^^^^^^^^^^^^^^^^ needs `duration`, a time
          |
          = help: add `duration = "8.93 s"`

        error: unknown key `drive.segments[1].time`
         --> sweep.toml:6:1
          |
        6 | time = 4
          | ^^^^ not a key of this table
          |
          = help: keys allowed here: `to`, `duration`
        "#);
    }

    #[test]
    fn an_array_of_other_things_than_tables_is_refused() {
        let text = report("a = [{}, 3]\nb = {}\n", |mut root| {
            for wrong in ["a", "b", "c"] {
                assert!(root.tables(&items(wrong, Required), |_| Some(())).is_none());
            }
            let absent = root.tables(&items("d", Optional), |_| Some(()));
            assert_eq!(absent.map(|absent| absent.value), Some(Vec::new()));
        });
        insta::assert_snapshot!(text, @r#"
        error: missing key `c`
        --> sweep.toml
         = help: write `c = [{ ... }]`, or begin each item with `[[c]]`

        error: `a[1]` must be a table
         --> sweep.toml:1:10
          |
        1 | a = [{}, 3]
          |          ^ found an integer
          |
          = help: write `{ key = value }`

        error: `b` must be an array of tables
         --> sweep.toml:2:5
          |
        2 | b = {}
          |     ^^ found a table
          |
          = help: write `b = [{ ... }]`, or begin each item with `[[b]]`
        "#);
    }

    #[test]
    fn every_bad_item_of_an_array_is_reported() {
        let text = "f = [\"1 Hz\", \"2 N\", 3, true]\ng = true\nh = [1, \"2\"]\n";
        let text = report(text, |mut root| {
            for wrong in ["f", "g"] {
                let row = key(
                    wrong,
                    Kind::Numbers(quantity(Frequency), Entries::ANY),
                    Required,
                );
                assert!(look(&mut root, &row).is_none());
            }
            let numbers = key("h", Kind::Numbers(number("2.0"), Entries::ANY), Required);
            assert!(look(&mut root, &numbers).is_none());
        });
        insta::assert_snapshot!(text, @r#"
        error: `f[1]` must be a frequency
         --> sweep.toml:1:14
          |
        1 | f = ["1 Hz", "2 N", 3, true]
          |              ^^^^^
          |
          = note: '2 N' is a force, a frequency is expected, for example "10 Hz"
          = help: write a quantity with its unit, such as `"10 Hz"`

        error: `f[3]` must be a frequency
         --> sweep.toml:1:24
          |
        1 | f = ["1 Hz", "2 N", 3, true]
          |                        ^^^^ found a boolean
          |
          = help: write a quantity with its unit, such as `"10 Hz"`

        error: `g` must be an array, each item a frequency
         --> sweep.toml:2:5
          |
        2 | g = true
          |     ^^^^ found a boolean
          |
          = help: write an array, each item a frequency, such as `g = ["10 Hz"]`

        error: `h[1]` must be a number
         --> sweep.toml:3:9
          |
        3 | h = [1, "2"]
          |         ^^^ found a string
          |
          = help: write it without quotes: `2.0`
        "#);
    }

    #[test]
    fn one_of_several_keys_must_be_given_and_only_one() {
        let words = ["library", "relaxation", "creep"];
        let words: [Key; 3] = words.map(|name| key(name, Kind::Text, Required));
        let read = |mut root: TableReader<'_>| {
            let mut material = root.table(&below("material")).expect("it is there");
            let keys = words.each_ref().map(|key| (key, ()));
            assert_eq!(material.one_of(&keys), None);
            material.finish();
        };
        insta::assert_snapshot!(report("[material]\n", read), @r#"
        error: `material` needs one of `library`, `relaxation`, `creep`
         --> sweep.toml:1:1
          |
        1 | [material]
          | ^^^^^^^^^^
          |
          = help: add one of them
        "#);
        insta::assert_snapshot!(report("[material]\nlibary = \"pmma\"\n", read), @r#"
        error: unknown key `material.libary`
         --> sweep.toml:2:1
          |
        2 | libary = "pmma"
          | ^^^^^^ did you mean `library`?
          |
          = help: write `library` instead of `libary`
        "#);
        let both = "[material]\nlibrary = \"pmma\"\n[material.creep]\n";
        insta::assert_snapshot!(report(both, read), @r#"
        error: only one of `library`, `creep` may be given
         --> sweep.toml:2:1
          |
        2 | library = "pmma"
          | ^^^^^^^ one of them
        3 | [material.creep]
          |           ----- another
          |
          = help: remove all but one
        "#);
    }

    #[test]
    fn defaults_and_absent_keys_are_no_problem() {
        let document = Document::parse("sweep.toml", "a = 1\nt = {}\n").expect("it is TOML");
        let problems = Problems::new();
        let mut root = document.root(&problems);
        let [absent, present] = [number("1.0"); 2].map(Kind::Number);
        assert_eq!(
            root.value(&key("b", absent, Or(|| Some(2.5.into())))),
            Some(2.5)
        );
        assert_eq!(
            root.value(&key("a", present, Or(|| Some(2.5.into())))),
            Some(1.0)
        );
        let choice = key("c", Kind::Word(&["x", "y"]), Or(|| Some("y".into())));
        assert_eq!(root.value(&choice), Some("y".to_owned()));
        let absent: Option<Option<f64>> =
            root.value(&key("d", Kind::Number(quantity(Time)), Optional));
        assert_eq!(absent, Some(None));
        assert!(root.has(&below("t")) && !root.has(&choice));
        root.finish();
        assert!(problems.is_empty());
    }

    #[test]
    fn problems_found_later_point_at_the_value() {
        let text = report(DRIVE, |mut root| {
            let problems = root.problems;
            let mut drive = root.table(&below("drive")).expect("it is there");
            let force = |name| key(name, Kind::Number(quantity(Force)), Required);
            let mean: Located<f64> = drive.read(&force("mean")).expect("right");
            let amplitude: Located<f64> = drive.read(&force("amplitude")).expect("right");
            assert_eq!(amplitude.path, "drive.amplitude");
            problems
                .at(&amplitude, "the load becomes negative within a cycle")
                .because("larger than the mean")
                .label(&mean, "the mean")
                .help("choose an amplitude of at most 4 N");
        });
        insta::assert_snapshot!(text, @r#"
        error: the load becomes negative within a cycle
         --> sweep.toml:4:13
          |
        3 | mean = "10 N"
          |        ------ the mean
        4 | amplitude = "5 N"
          |             ^^^^^ larger than the mean
          |
          = help: choose an amplitude of at most 4 N
        "#);
    }

    #[test]
    fn problems_are_told_in_the_order_of_the_file_and_then_of_the_flags() {
        let text =
            "[cycle]\nsteps = 0\n[drive]\ncontrol = \"load\"\nmean = 1\namplitude = 2\nx = 1\n";
        let text = report_with(text, &["cycle.tolerance=a", "cycle.zzz=b"], read_sweep);
        let places: Vec<&str> = text.lines().filter(|line| line.contains("-->")).collect();
        assert_eq!(
            places,
            [
                " --> sweep.toml:2:9",
                " --> sweep.toml:7:1",
                "--> command line:1:23",
                "--> command line:1:13",
            ]
        );
    }

    #[test]
    fn numbers_beyond_their_limits_are_refused_with_what_to_write() {
        use crate::quantity::Dimension::Length;
        use crate::quantity::key::Limits;
        use std::ops::Bound;
        let text = "a = \"0 N\"\nb = -1\nc = \"2 m\"\nd = 0.6\ne = [1, 1]\nf = []\ng = [\"1 s\"]\n";
        let text = report(text, |mut root| {
            assert!(
                look(
                    &mut root,
                    &key("a", Kind::Number(quantity(Force).above_zero()), Required)
                )
                .is_none()
            );
            let hold = Kind::Number(quantity(Time).not_negative().or_else("leave it out"));
            assert!(look(&mut root, &key("b", hold, Required)).is_none());
            let width = Kind::Number(quantity(Length).within(Limits::between(0.02, 1.0)));
            assert!(look(&mut root, &key("c", width, Optional)).is_none());
            let ratio = Limits::new(Bound::Excluded(-1.0), Bound::Included(0.5));
            assert!(
                look(
                    &mut root,
                    &key(
                        "d",
                        Kind::Number(number("0.4").within(ratio)),
                        Or(|| Some(0.4.into()))
                    )
                )
                .is_none()
            );
            let once = |instead| {
                let entries = Entries {
                    repeats: false,
                    ..Entries::of(1..=3, instead)
                };
                Kind::Numbers(number("1.0"), entries)
            };
            assert!(look(&mut root, &key("e", once(""), Required)).is_none());
            assert!(look(&mut root, &key("f", once("leave it out"), Required)).is_none());
            root.finish();
        });
        insta::assert_snapshot!(text, @r#"
        error: `a` must be above zero
         --> sweep.toml:1:5
          |
        1 | a = "0 N"
          |     ^^^^^
          |
          = help: write a force above zero, such as `a = "10 N"`

        error: `b` cannot be negative
         --> sweep.toml:2:5
          |
        2 | b = -1
          |     ^^
          |
          = help: leave it out

        error: `c` must lie between 20 mm and 1 m
         --> sweep.toml:3:5
          |
        3 | c = "2 m"
          |     ^^^^^
          |
          = help: write a length from 20 mm to 1 m, such as `c = "10 mm"`

        error: `d` must be above -1 and at most 0.5
         --> sweep.toml:4:5
          |
        4 | d = 0.6
          |     ^^^
          |
          = help: write a number above -1 and at most 0.5, such as `d = 0.4`

        error: `e[1]` is listed twice
         --> sweep.toml:5:9
          |
        5 | e = [1, 1]
          |      -  ^
          |      |
          |      the other one
          |
          = help: write every entry once

        error: `f` has 0 entries, where 1 to 3 are allowed
         --> sweep.toml:6:5
          |
        6 | f = []
          |     ^^
          |
          = help: leave it out

        error: unknown key `g`
         --> sweep.toml:7:1
          |
        7 | g = ["1 s"]
          | ^ not a key of this table
          |
          = help: keys allowed here: `a`, `b`, `c`, `d`, `e`, `f`
        "#);
    }

    #[test]
    fn a_single_value_is_a_list_of_one_and_hertz_are_understood_as_angular_frequencies() {
        use crate::quantity::Dimension::AngularFrequency;
        let text = report(
            "f = \"45 Hz\"\nw = [\"1 Hz\", 2, \"3 rad/s\"]\n",
            |mut root| {
                let frequency = key(
                    "f",
                    Kind::Numbers(quantity(Frequency), Entries::ANY),
                    Required,
                );
                assert_eq!(root.value(&frequency), Some(vec![45.0]));
                let angular = key(
                    "w",
                    Kind::Numbers(quantity(AngularFrequency), Entries::ANY),
                    Required,
                );
                let values = root.value(&angular);
                assert_eq!(values, Some(vec![std::f64::consts::TAU, 2.0, 3.0]));
            },
        );
        assert_eq!(text, "no problem");
    }
}
