//! Reading a table key by key: typed values, and a report of everything that is wrong.

use std::ops::RangeInclusive;

use super::Located;
use super::kind::{Array, Boolean, Choice, Integer, Kind, Number, Quantity, Spot, Text};
use super::similar::similar;
use super::tree::{Entry, Node, Table, Value};
use crate::input::diagnostic::{Diagnostic, Location, Problems, Reported};
use crate::quantity::Dimension;

/// What a key holds, for keys that may be written in more than one way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A string.
    Text,
    /// An integer or a float.
    Number,
    /// `true` or `false`.
    Boolean,
    /// A date or time, which no key of a sweep file takes.
    DateTime,
    /// An array, inline or `[[...]]`.
    Array,
    /// A table, inline or `[...]`.
    Table,
}

/// Reads one table. Keys asked for are remembered; [`TableReader::finish`] reports the others.
#[derive(Debug)]
#[must_use = "a table that is not read and finished hides its mistakes"]
pub struct TableReader<'a> {
    table: &'a Table,
    /// The header, or the file for the top of it.
    location: Location,
    /// Full dotted key, empty at the top of the file.
    path: String,
    problems: &'a Problems,
    asked: Vec<String>,
    missing: Vec<Missing<'a>>,
}

/// A report of absent keys: taken back when an unknown key turns out to be one of them, misspelt.
#[derive(Debug)]
struct Missing<'a> {
    keys: Vec<String>,
    reported: Reported<'a>,
}

impl AsRef<Location> for TableReader<'_> {
    fn as_ref(&self) -> &Location {
        &self.location
    }
}

/// Looking around.
impl<'a> TableReader<'a> {
    pub(super) fn new(
        table: &'a Table,
        location: Location,
        path: String,
        problems: &'a Problems,
    ) -> Self {
        Self {
            table,
            location,
            path,
            problems,
            asked: Vec::new(),
            missing: Vec::new(),
        }
    }

    /// Full dotted key of this table, empty at the top of the file.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Whether `key` is present, with a right value or a wrong one. Counts as asking for it.
    pub fn has(&mut self, key: &str) -> bool {
        self.find(key).is_some()
    }

    /// What `key` holds, `None` when it is absent. Counts as asking for it.
    pub fn form(&mut self, key: &str) -> Option<Form> {
        Some(match self.find(key)?.node.value {
            Value::Text(_) => Form::Text,
            Value::Integer(_) | Value::Float(_) => Form::Number,
            Value::Boolean(_) => Form::Boolean,
            Value::DateTime => Form::DateTime,
            Value::Array(_) => Form::Array,
            Value::Table(_) => Form::Table,
        })
    }

    /// Where `key` itself is written, `None` when it is absent. Counts as asking for it.
    pub fn key_location(&mut self, key: &str) -> Option<Location> {
        self.find(key).map(|entry| entry.key.clone())
    }

    /// Which one of these keys is present, and the value that belongs to it: `&[("file", Source::File), ...]`. None, or more than
    /// one, is a problem, and reported.
    pub fn one_of<T: Copy>(&mut self, choices: &[(&'static str, T)]) -> Option<(&'static str, T)> {
        let present: Vec<(&'static str, T, &Entry)> = choices
            .iter()
            .filter_map(|(key, value)| Some((*key, *value, self.find(key)?)))
            .collect();
        match present.as_slice() {
            [(key, value, _)] => Some((key, *value)),
            [] => {
                let keys: Vec<&str> = choices.iter().map(|(key, _)| *key).collect();
                let keys = keys.as_slice();
                let message = match self.path.as_str() {
                    "" => format!("missing one of {}", in_backticks(keys)),
                    path => format!("`{path}` needs one of {}", in_backticks(keys)),
                };
                let problem = Diagnostic::at(&self.location, message).help("add one of them");
                self.report_missing(keys, problem);
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
    pub fn finish(mut self) {
        let asked: Vec<&str> = self.asked.iter().map(String::as_str).collect();
        for (key, entry) in &self.table.entries {
            if asked.contains(&key.as_str()) {
                continue;
            }
            let meant = similar(key, &asked);
            self.problems.push(self.unknown(key, entry, meant, &asked));
            let explains =
                |missing: &Missing| missing.keys.iter().any(|absent| meant == Some(absent));
            if let Some(index) = self.missing.iter().position(explains) {
                self.missing.swap_remove(index).reported.retract();
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
                .help("keep one of them"),
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

    fn report_missing(&mut self, keys: &[&str], problem: Diagnostic) {
        let missing = Missing {
            keys: keys.iter().map(|key| (*key).to_owned()).collect(),
            reported: self.problems.push(problem),
        };
        self.missing.push(missing);
    }
}

/// Tables below this one.
impl<'a> TableReader<'a> {
    /// The table `key`, inline or under a header.
    pub fn table(&mut self, key: &str) -> Option<TableReader<'a>> {
        if self.has(key) {
            return self.optional_table(key);
        }
        let header = header(&join(&self.path, key));
        let problem = Diagnostic::at(&self.location, format!("missing table `{header}`")).help(
            format!("add `{header}` on a line of its own, with its keys below"),
        );
        self.report_missing(&[key], problem);
        None
    }

    /// The table `key`, where there is one.
    pub fn optional_table(&mut self, key: &str) -> Option<TableReader<'a>> {
        let node = &self.find(key)?.node;
        let path = join(&self.path, key);
        if let Value::Table(table) = &node.value {
            return Some(Self::new(table, node.location.clone(), path, self.problems));
        }
        self.problems
            .at(&node.location, format!("`{path}` must be a table"))
            .because(format!("found {}", node.describe()))
            .help(format!(
                "write `{}` on a line of its own, with its keys below",
                header(&path)
            ));
        None
    }

    /// The tables in the array `key`: `[[key]]`, or an inline array of inline tables. May be empty.
    pub fn tables(&mut self, key: &str) -> Option<Located<Vec<TableReader<'a>>>> {
        if self.has(key) {
            return self.optional_tables(key);
        }
        let path = join(&self.path, key);
        let problem = Diagnostic::at(&self.location, format!("missing key `{path}`"))
            .help(array_of_tables(&path, key));
        self.report_missing(&[key], problem);
        None
    }

    /// The tables in the array `key`, where there is one.
    pub fn optional_tables(&mut self, key: &str) -> Option<Located<Vec<TableReader<'a>>>> {
        let node = &self.find(key)?.node;
        let path = join(&self.path, key);
        let Value::Array(items) = &node.value else {
            self.problems
                .at(
                    &node.location,
                    format!("`{path}` must be an array of tables"),
                )
                .because(format!("found {}", node.describe()))
                .help(array_of_tables(&path, key));
            return None;
        };
        let readers: Vec<TableReader<'a>> = items
            .iter()
            .enumerate()
            .filter_map(|(index, item)| self.item(item, format!("{path}[{index}]")))
            .collect();
        (readers.len() == items.len()).then(|| Located {
            value: readers,
            path,
            location: node.location.clone(),
        })
    }

    /// A reader of one item of an array, which must be a table.
    fn item(&self, item: &'a Node, path: String) -> Option<TableReader<'a>> {
        if let Value::Table(table) = &item.value {
            return Some(Self::new(table, item.location.clone(), path, self.problems));
        }
        self.problems
            .at(&item.location, format!("`{path}` must be a table"))
            .because(format!("found {}", item.describe()))
            .help("write `{ key = value }`");
        None
    }
}

/// Values. Each method without `optional_` or `_or` reports a key that is absent.
impl TableReader<'_> {
    /// A quantity: a string with a unit, or a bare number in SI units. The value is in SI units.
    pub fn quantity(&mut self, key: &str, dimension: Dimension) -> Option<Located<f64>> {
        self.required(key, &Quantity(dimension))
    }

    /// A quantity that may be absent.
    pub fn optional_quantity(&mut self, key: &str, dimension: Dimension) -> Option<Located<f64>> {
        self.optional(key, &Quantity(dimension))
    }

    /// A quantity with a default, in SI units.
    pub fn quantity_or(
        &mut self,
        key: &str,
        dimension: Dimension,
        default_si: f64,
    ) -> Option<Located<f64>> {
        self.or(key, &Quantity(dimension), default_si)
    }

    /// An array of quantities, each located. May be empty.
    pub fn quantities(
        &mut self,
        key: &str,
        dimension: Dimension,
    ) -> Option<Located<Vec<Located<f64>>>> {
        self.required(key, &Array(Quantity(dimension)))
    }

    /// An array of quantities that may be absent.
    pub fn optional_quantities(
        &mut self,
        key: &str,
        dimension: Dimension,
    ) -> Option<Located<Vec<Located<f64>>>> {
        self.optional(key, &Array(Quantity(dimension)))
    }

    /// An array of bare numbers, each located. May be empty.
    pub fn numbers(&mut self, key: &str) -> Option<Located<Vec<Located<f64>>>> {
        self.required(key, &Array(Number))
    }

    /// A finite number, integer or float.
    pub fn number(&mut self, key: &str) -> Option<Located<f64>> {
        self.required(key, &Number)
    }

    /// A number that may be absent.
    pub fn optional_number(&mut self, key: &str) -> Option<Located<f64>> {
        self.optional(key, &Number)
    }

    /// A number with a default.
    pub fn number_or(&mut self, key: &str, default: f64) -> Option<Located<f64>> {
        self.or(key, &Number, default)
    }

    /// An integer within `range`; end it with `usize::MAX` for no upper bound.
    pub fn positive_integer(
        &mut self,
        key: &str,
        range: RangeInclusive<usize>,
    ) -> Option<Located<usize>> {
        self.required(key, &Integer(range))
    }

    /// An integer that may be absent.
    pub fn optional_positive_integer(
        &mut self,
        key: &str,
        range: RangeInclusive<usize>,
    ) -> Option<Located<usize>> {
        self.optional(key, &Integer(range))
    }

    /// An integer with a default.
    pub fn positive_integer_or(
        &mut self,
        key: &str,
        range: RangeInclusive<usize>,
        default: usize,
    ) -> Option<Located<usize>> {
        self.or(key, &Integer(range), default)
    }

    /// Any text.
    pub fn string(&mut self, key: &str) -> Option<Located<String>> {
        self.required(key, &Text)
    }

    /// Text that may be absent.
    pub fn optional_string(&mut self, key: &str) -> Option<Located<String>> {
        self.optional(key, &Text)
    }

    /// `true` or `false`.
    pub fn boolean(&mut self, key: &str) -> Option<Located<bool>> {
        self.required(key, &Boolean)
    }

    /// `true` or `false`, with a default.
    pub fn boolean_or(&mut self, key: &str, default: bool) -> Option<Located<bool>> {
        self.or(key, &Boolean, default)
    }

    /// The value that belongs to one of a few words: `&[("load", Control::Load), ...]`.
    pub fn choice_of<T: Copy>(&mut self, key: &str, choices: &[(&str, T)]) -> Option<Located<T>> {
        self.required(key, &Choice(choices))
    }

    /// The value that belongs to one of a few words, with a default.
    pub fn choice_of_or<T: Copy>(
        &mut self,
        key: &str,
        choices: &[(&str, T)],
        default: T,
    ) -> Option<Located<T>> {
        self.or(key, &Choice(choices), default)
    }

    /// An array of values that belong to a few words each, each located. May be empty.
    pub fn choices_of<T: Copy>(
        &mut self,
        key: &str,
        choices: &[(&str, T)],
    ) -> Option<Located<Vec<Located<T>>>> {
        self.required(key, &Array(Choice(choices)))
    }

    fn required<K: Kind>(&mut self, key: &str, kind: &K) -> Option<Located<K::Value>> {
        if let Some(entry) = self.find(key) {
            return self.convert(key, entry, kind);
        }
        let path = join(&self.path, key);
        let message = format!("missing key `{path}`");
        let example = format!("`{key} = {}`", kind.example());
        let problem = Diagnostic::at(&self.location, message);
        let problem = if self.location.is_whole() {
            problem.help(format!("add {example} above the first table"))
        } else {
            problem
                .because(format!("needs `{key}`, {}", kind.expected()))
                .help(format!("add {example}"))
        };
        self.report_missing(&[key], problem);
        None
    }

    fn optional<K: Kind>(&mut self, key: &str, kind: &K) -> Option<Located<K::Value>> {
        let entry = self.find(key)?;
        self.convert(key, entry, kind)
    }

    fn or<K: Kind>(&mut self, key: &str, kind: &K, default: K::Value) -> Option<Located<K::Value>> {
        match self.find(key) {
            Some(entry) => self.convert(key, entry, kind),
            None => Some(Located {
                value: default,
                path: join(&self.path, key),
                location: self.location.clone(),
            }),
        }
    }

    fn convert<K: Kind>(&self, key: &str, entry: &Entry, kind: &K) -> Option<Located<K::Value>> {
        let path = join(&self.path, key);
        let spot = Spot {
            path: &path,
            key: Some(key),
        };
        match kind.convert(&entry.node, &spot) {
            Ok(value) => Some(Located {
                value,
                path,
                location: entry.node.location.clone(),
            }),
            Err(diagnostics) => {
                self.problems.extend(diagnostics);
                None
            }
        }
    }
}

/// The dotted key of `key` in the table `path`.
pub(super) fn join(path: &str, key: &str) -> String {
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

fn in_backticks(keys: &[&str]) -> String {
    let quoted: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
    quoted.join(", ")
}

#[cfg(test)]
mod tests {
    use crate::input::diagnostic::{Problems, Styling};
    use crate::input::document::{Document, Form, TableReader};
    use crate::quantity::Dimension;

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
        let _ = root.optional_string("title");
        if let Some(mut drive) = root.table("drive") {
            let _ = drive.choice_of("control", &[("load", ()), ("approach", ())]);
            let _ = drive.quantity("mean", Dimension::Force);
            let _ = drive.quantity("amplitude", Dimension::Force);
            let _ = drive.quantity_or("phase", Dimension::Angle, 0.0);
            drive.finish();
        }
        if let Some(mut cycle) = root.optional_table("cycle") {
            let _ = cycle.positive_integer_or("steps", 8..=10_000, 100);
            let _ = cycle.number_or("tolerance", 1e-4);
            let _ = cycle.boolean_or("keep_history", false);
            cycle.finish();
        }
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
          = help: keep one of them
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
            let mut material = root.table("material").expect("it is there");
            let _ = material.number("poisson_ratio");
            let mut relaxation = material.table("relaxation").expect("it is there");
            let mut branches = relaxation.table("branches").expect("it is there");
            let _ = relaxation.quantity("equilibrium", Dimension::Stress);
            let _ = branches.quantities("times", Dimension::Time);
            let _ = material.table("creep");
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
            let _ = root.string("title");
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
         = help: keep one of them
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
            let mut drive = root.table("drive").expect("it is there");
            let segments = drive.tables("segments").expect("they are tables");
            assert_eq!(segments.value.len(), 2);
            for mut segment in segments.value {
                let _ = segment.quantity("to", Dimension::Force);
                let _ = segment.quantity("duration", Dimension::Time);
                segment.finish();
            }
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
            assert!(root.tables("a").is_none());
            assert!(root.tables("b").is_none());
            assert!(root.tables("c").is_none());
            assert!(root.optional_tables("d").is_none());
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
        let text = "f = [\"1 Hz\", \"2 N\", 3, true]\ng = 1\nh = [1, \"2\"]\n";
        let text = report(text, |mut root| {
            assert!(root.quantities("f", Dimension::Frequency).is_none());
            assert!(root.quantities("g", Dimension::Frequency).is_none());
            assert!(root.numbers("h").is_none());
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
        2 | g = 1
          |     ^ found an integer
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
        let keys = ["library", "relaxation", "creep"].map(|key| (key, ()));
        let read = |mut root: TableReader<'_>| {
            let mut material = root.table("material").expect("it is there");
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
        assert_eq!(root.number_or("b", 2.5).map(|found| found.value), Some(2.5));
        let choice = root.choice_of_or("c", &[("x", 1), ("y", 2)], 2);
        assert_eq!(choice.map(|found| found.value), Some(2));
        assert!(root.optional_quantity("d", Dimension::Time).is_none());
        assert!(root.has("a") && !root.has("b"));
        assert_eq!(root.form("a"), Some(Form::Number));
        assert_eq!(root.form("t"), Some(Form::Table));
        assert_eq!(root.form("z"), None);
        root.finish();
        assert!(problems.is_empty());
    }

    #[test]
    fn problems_found_later_point_at_the_value() {
        let text = report(DRIVE, |mut root| {
            let problems = root.problems;
            let mut drive = root.table("drive").expect("it is there");
            let mean = drive.quantity("mean", Dimension::Force).expect("right");
            let amplitude = drive
                .quantity("amplitude", Dimension::Force)
                .expect("right");
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
}
