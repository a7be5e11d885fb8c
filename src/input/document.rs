//! Sweep and scenario files: TOML in which every key and value knows where it was written.
//!
//! A [`Document`] is parsed from a file and changed by `--set KEY=VALUE` flags. It is then read through
//! `TableReader`s, which turn values into typed ones and report to [`Problems`] instead of stopping at the
//! first mistake. What a key may hold is in its declaration ([`Key`](crate::quantity::key::Key)). Three rules keep reading code short:
//!
//! - `None` from a reader method means that a problem was reported. Of a key that may be left out, the answer within is `None` too.
//! - A value comes as [`Located`], so that a check made later can still point at it.
//! - `TableReader::finish`, called once all keys were asked for, reports the keys nobody asked for. Do not
//!   call it where a wrong value leaves open which keys belong to the table.

pub(crate) mod block;
pub(crate) mod kind;
pub(crate) mod reader;
pub(crate) mod schema;
pub(super) mod similar;
pub(super) mod syntax;
pub(crate) mod tree;

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::diagnostic::{Diagnostic, Diagnostics, Location, Problems, Source, Tables};
use super::file_kind;
use tree::Table;

use reader::TableReader;

/// Largest file read, bytes. Sweep files have a few kilobytes; tables of data belong in files of their own.
pub const MAX_BYTES: usize = 10_000_000;

/// A value, with the place where it was written.
#[derive(Clone, Debug)]
pub struct Located<T> {
    /// The value; quantities are in SI units.
    pub value: T,
    /// Full dotted key, `drive.mean`, for messages.
    pub path: String,
    /// The value in the file or flag; where the value is a default, the header of its table.
    pub location: Location,
}

impl<T> Located<T> {
    /// The same place with another value.
    pub fn map<U>(self, convert: impl FnOnce(T) -> U) -> Located<U> {
        Located {
            value: convert(self.value),
            path: self.path,
            location: self.location,
        }
    }
}

impl Located<String> {
    /// The file that this value names: from `folder`, where the document lies; for a value set by a flag, from the working
    /// folder, as for any path on a command line. What is not beside a link to a document is looked for beside the document.
    pub fn path_from(&self, folder: &Path) -> PathBuf {
        let source = self.location.source();
        if source.is_flag() {
            return PathBuf::from(&self.value);
        }
        let beside = folder.join(&self.value);
        let target = || {
            let document = std::fs::canonicalize(source.name()).ok()?;
            let file = document.parent()?.join(&self.value);
            file.exists().then_some(file)
        };
        match beside.exists() {
            true => beside,
            false => target().unwrap_or(beside),
        }
    }

    /// The same as an absolute path, by which the file can be named anywhere, or the name of a table in memory; `None` where it is not
    /// UTF-8.
    pub(super) fn absolute_from(&self, folder: &Path) -> Option<String> {
        if self.location.source().table(&self.value).is_some() {
            return Some(self.value.clone());
        }
        let path = std::path::absolute(self.path_from(folder)).ok()?;
        path.to_str().map(str::to_owned)
    }

    /// Where [`Located::path_from`] starts from, for messages.
    pub fn path_rule(&self) -> &'static str {
        match self.location.source().is_flag() {
            true => "a path in a flag starts from the working folder",
            false => "the path starts from the folder of the file it is written in",
        }
    }
}

impl<T> AsRef<Location> for Located<T> {
    fn as_ref(&self) -> &Location {
        &self.location
    }
}

/// A parsed file, with the flags set on it.
#[derive(Debug)]
pub struct Document {
    source: Arc<Source>,
    pub(super) root: Table,
    /// Where paths in the file start from.
    folder: PathBuf,
    /// Flags applied so far; orders their problems.
    pub(super) flags: usize,
}

impl Document {
    /// Opens and parses a file.
    ///
    /// # Errors
    /// The file cannot be read, has more than [`MAX_BYTES`], or is refused by [`Document::from_bytes`].
    pub fn read(path: &Path) -> Result<Self, Diagnostics> {
        let name = path.display().to_string();
        let bytes = read_limited(path, MAX_BYTES).map_err(|error| cannot_read(&name, &error))?;
        let document = Self::from_bytes(&name, &bytes)?;
        Ok(document.in_folder(path.parent().unwrap_or(Path::new(""))))
    }

    /// The same document, in which paths start from this folder.
    pub fn in_folder(mut self, folder: &Path) -> Self {
        self.folder = folder.to_path_buf();
        self
    }

    /// Where paths in the document start from: the folder of the file, or the working folder for text from memory.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Parses the bytes of a file; a byte order mark is passed over.
    ///
    /// # Errors
    /// More than [`MAX_BYTES`], text that is not UTF-8, or anything [`Document::parse`] refuses.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, Diagnostics> {
        if bytes.len() > MAX_BYTES {
            return Err(too_long(name).into());
        }
        let text = std::str::from_utf8(bytes)
            .map_err(|error| not_utf8(name, bytes, error.valid_up_to()))?;
        Self::parse(name, text)
    }

    /// Parses TOML; `name` is what messages call the file.
    ///
    /// # Errors
    /// Text that is not TOML: one diagnostic for every line that is wrong in itself.
    pub fn parse(name: &str, text: &str) -> Result<Self, Diagnostics> {
        Self::with_tables(name, text, Vec::new())
    }

    /// The same of a text that names tables, given by name and bytes, where it would name data files. A name that begins with
    /// `argument` counts rows in messages.
    ///
    /// # Errors
    /// As [`Document::parse`].
    pub fn with_tables(name: &str, text: &str, tables: Tables) -> Result<Self, Diagnostics> {
        if text.len() > MAX_BYTES {
            return Err(too_long(name).into());
        }
        let source = Source::with_tables(name, text.trim_start_matches('\u{feff}'), tables);
        let (table, errors) = toml::de::DeTable::parse_recoverable(source.text());
        if errors.is_empty() {
            Ok(Self {
                root: Table::from_toml(table.into_inner(), &source, 0),
                source,
                folder: PathBuf::new(),
                flags: 0,
            })
        } else {
            Err(syntax::explain_all(&source, &errors))
        }
    }

    /// The files that there are by any name in the document, and the document itself: what a command that reads it must not write
    /// over. Of a folder the table in it that is read.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut named = vec![PathBuf::from(self.source.name())];
        self.root.for_each_text(&mut |text, location| {
            let located = Located {
                value: text.to_owned(),
                path: String::new(),
                location: location.clone(),
            };
            named.push(located.path_from(&self.folder));
        });
        let tables = named.iter().map(|path| path.join("sweep.csv"));
        let tables: Vec<PathBuf> = tables.collect();
        named.extend(tables);
        named.retain(|path| path.is_file());
        named
    }

    /// Starts reading at the top of the file.
    pub(crate) fn root<'a>(&'a self, problems: &'a Problems) -> TableReader<'a> {
        let location = Location::whole(&self.source);
        TableReader::new(&self.root, location, String::new(), problems).in_folder(&self.folder)
    }

    /// What is read of the whole file, which may have no other keys than those asked for.
    ///
    /// # Errors
    /// Every problem reported.
    pub(crate) fn read_whole<T>(
        &self,
        read: impl FnOnce(&mut TableReader<'_>) -> Option<T>,
    ) -> Result<T, Diagnostics> {
        let problems = Problems::new();
        let mut root = self.root(&problems);
        let value = read(&mut root);
        root.finish();
        problems.into_result(value)
    }

    /// The file as parsed, without the flags.
    pub fn source(&self) -> &Source {
        &self.source
    }
}

/// At most one byte more than is allowed, so that an endless file ends.
pub(crate) fn read_limited(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let limit = most as u64 + 1;
    File::open(path)?.take(limit).read_to_end(&mut bytes)?;
    Ok(bytes)
}

pub(super) fn cannot_read(name: &str, error: &io::Error) -> Diagnostic {
    let diagnostic = Diagnostic::new(format!("cannot read `{name}`: {error}"));
    match error.kind() {
        io::ErrorKind::NotFound => diagnostic.help("check the path, and the folder it starts from"),
        io::ErrorKind::IsADirectory => diagnostic.help("name a file in that folder"),
        _ => diagnostic,
    }
}

fn too_long(name: &str) -> Diagnostic {
    let megabytes = MAX_BYTES / 1_000_000;
    Diagnostic::new(format!("`{name}` is larger than {megabytes} MB"))
        .note("sweep and scenario files are TOML of a few kilobytes")
        .help("keep tables of data in a CSV file, and name that file in this one")
}

/// Points at the first byte that is not UTF-8, and guesses the encoding.
pub(super) fn not_utf8(name: &str, bytes: &[u8], offset: usize) -> Diagnostic {
    if let Err(diagnostic) = file_kind::refuse_binary(name, bytes) {
        return diagnostic;
    }
    let message = format!("`{name}` is not UTF-8 text: stopped at byte {offset}");
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Diagnostic::new(message)
            .note("the file is UTF-16, as some Windows programs write it")
            .help("save it as UTF-8");
    }
    // Everything before the offset is kept as it is, so the offset holds in the mended text too.
    let mended = String::from_utf8_lossy(bytes);
    let stripped = mended.trim_start_matches('\u{feff}');
    let start = offset.saturating_sub(mended.len() - stripped.len());
    let source = Source::file(name, stripped);
    let place = Location::new(&source, start..start + 1);
    let byte = bytes.get(offset).copied().unwrap_or_default();
    // Latin-1 and Windows-1252 agree from 0xa0 on, where each byte is its own code point.
    let meant = match byte {
        0xa0.. => format!(", `{}` in Latin-1", char::from(byte)),
        _ => String::new(),
    };
    Diagnostic::at(&place, message)
        .because(format!("byte 0x{byte:02x}{meant}"))
        .help("save the file as UTF-8")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::input::diagnostic::Styling;
    use crate::input::document::reader::by_name::{NOTHING, below, items, key, look};
    use crate::quantity::Dimension;
    use crate::quantity::key::Presence::{Optional, Required};
    use crate::quantity::key::{Entries, Key, Kind, number, quantity};

    fn refusal(bytes: &[u8]) -> String {
        match Document::from_bytes("sweep.toml", bytes) {
            Ok(_) => "accepted".to_owned(),
            Err(diagnostics) => diagnostics.render(Styling::Plain),
        }
    }

    /// Mean and amplitude of the load, newtons.
    fn read_load(document: &Document) -> Result<(f64, f64), Diagnostics> {
        let problems = Problems::new();
        let mut root = document.root(&problems);
        let load = root.table(&below("drive")).and_then(|mut drive| {
            let force = Kind::Number(quantity(Dimension::Force));
            let mean = drive.read(&row("mean", force.clone()));
            let amplitude = drive.read(&row("amplitude", force));
            drive.finish();
            let (mean, amplitude): (Located<f64>, Located<f64>) = (mean?, amplitude?);
            if amplitude.value > mean.value {
                problems
                    .at(&amplitude, "the load becomes negative within a cycle")
                    .because("larger than the mean")
                    .label(&mean, "the mean")
                    .help("choose an amplitude of at most the mean");
            }
            Some((mean.value, amplitude.value))
        });
        root.finish();
        problems.into_result(load)
    }

    #[test]
    fn a_check_made_later_points_at_file_and_flag() {
        let text = "[drive]\nmean = \"10 N\"\namplitude = \"5 N\"\n";
        let mut document = Document::parse("sweep.toml", text).unwrap();
        assert_eq!(read_load(&document).unwrap(), (10.0, 5.0));
        document.set("drive.amplitude=12 N").unwrap();
        let refused = read_load(&document).unwrap_err();
        insta::assert_snapshot!(refused.render(Styling::Plain), @r#"
        error: the load becomes negative within a cycle
         --> command line:1:23
          |
          | --set drive.amplitude=12 N
          |                       ^^^^ larger than the mean
          |
         ::: sweep.toml:2:8
          |
        2 | mean = "10 N"
          |        ------ the mean
          |
          = help: choose an amplitude of at most the mean
        "#);
    }

    #[test]
    fn bytes_that_are_not_utf_8_are_shown_at_their_place() {
        insta::assert_snapshot!(refusal(b"\xef\xbb\xbfa = 1\nradius = \"10 \xb5m\"\n"), @r#"
        error: `sweep.toml` is not UTF-8 text: stopped at byte 22
         --> sweep.toml:2:14
          |
        2 | radius = "10 �m"
          |              ^ byte 0xb5, `µ` in Latin-1
          |
          = help: save the file as UTF-8
        "#);
    }

    #[test]
    fn utf_16_is_recognised() {
        insta::assert_snapshot!(refusal(b"\xff\xfea\x00"), @r#"
        error: `sweep.toml` is not UTF-8 text: stopped at byte 0
         |
         = note: the file is UTF-16, as some Windows programs write it
         = help: save it as UTF-8
        "#);
    }

    #[test]
    fn an_oversized_file_is_refused_and_one_at_the_limit_is_not() {
        let mut bytes = vec![b'\n'; MAX_BYTES];
        assert_eq!(refusal(&bytes), "accepted");
        bytes.push(b'\n');
        insta::assert_snapshot!(refusal(&bytes), @r#"
        error: `sweep.toml` is larger than 10 MB
         |
         = note: sweep and scenario files are TOML of a few kilobytes
         = help: keep tables of data in a CSV file, and name that file in this one
        "#);
    }

    #[test]
    fn a_file_that_cannot_be_opened_says_so() {
        let missing = Document::read(Path::new("no/such/sweep.toml")).unwrap_err();
        insta::assert_snapshot!(missing.render(Styling::Plain), @r#"
        error: cannot read `no/such/sweep.toml`: No such file or directory (os error 2)
         |
         = help: check the path, and the folder it starts from
        "#);
    }

    fn row(name: &'static str, kind: Kind) -> Key {
        key(name, kind, Required)
    }

    /// Reads every key of every table in every way, so that every message is made once.
    fn read_everything(mut reader: TableReader<'_>, keys: &[&'static str], depth: usize) {
        for &name in keys {
            for kind in [
                Kind::Number(quantity(Dimension::Force)),
                Kind::Number(number("1.0")),
                Kind::Integer(1..=10),
                Kind::Text,
                Kind::Flag,
                Kind::Word(&["load", "approach"]),
                Kind::Numbers(quantity(Dimension::Time), Entries::ANY),
            ] {
                let _ = look(&mut reader, &row(name, kind));
            }
            if depth < 3 {
                let below = key(name, Kind::Table(&NOTHING), Optional);
                let _ = reader.table_or(&below, (), |inner| {
                    read_everything(inner, keys, depth + 1);
                    None
                });
                let _ = reader.tables(&items(name, Optional), |inner| {
                    read_everything(inner, keys, depth + 1);
                    Some(())
                });
            }
        }
        let _ = reader.one_of(&[
            (&crate::input::keys::TITLE, ()),
            (&crate::input::keys::SWEEP, ()),
        ]);
        reader.finish();
    }

    fn report(document: &Document) -> String {
        let problems = Problems::new();
        let keys = ["a", "b", "mean", "a-b"];
        read_everything(document.root(&problems), &keys, 0);
        problems
            .into_result(Some(()))
            .map_or_else(|found| found.render(Styling::Plain), |()| String::new())
    }

    const PIECES: &[&str] = &[
        "a",
        "b",
        "mean",
        "=",
        " = ",
        ".",
        ",",
        "[",
        "]",
        "[[",
        "]]",
        "{",
        "}",
        "\"",
        "'",
        "\"\"\"",
        "'''",
        "\n",
        "\r\n",
        "\r",
        "\t",
        " ",
        "#",
        "1",
        "-5",
        "1e400",
        "1e-400",
        "nan",
        "inf",
        "0x",
        "true",
        "\"10 N\"",
        "\"10 µm\"",
        "µ",
        "中",
        "\\",
        "\\u00b5",
        "\u{0}",
        "\u{feff}",
        "1979-05-27",
        "[a]\n",
        "[a.b]\n",
        "[[b]]\n",
        "a = 1\n",
        "b = \"x\"\n",
        "a.b = 2\n",
        "mean = {a = 1}\n",
        "b = [{a = 1}, 2]\n",
    ];

    /// Text made of pieces of TOML, which gets further into the parser than arbitrary characters.
    fn toml_like() -> impl Strategy<Value = String> {
        prop::collection::vec(prop::sample::select(PIECES), 0..40)
            .prop_map(|pieces| pieces.concat())
    }

    proptest! {
        // Enough cases to meet each of the 48 pieces beside each other one.
        #![proptest_config(ProptestConfig::with_cases(3000))]

        #[test]
        fn any_text_is_read_or_refused_but_never_panics(
            text in prop_oneof![toml_like(), any::<String>()],
        ) {
            match Document::parse("sweep.toml", &text) {
                Ok(document) => { report(&document); }
                Err(diagnostics) => {
                    prop_assert!(diagnostics.count() > 0);
                    prop_assert!(diagnostics.render(Styling::Plain).contains("--> sweep.toml:"));
                }
            }
        }

        #[test]
        fn any_bytes_are_read_or_refused_but_never_panic(bytes in any::<Vec<u8>>()) {
            prop_assert!(!refusal(&bytes).is_empty());
        }

        #[test]
        fn any_flag_is_set_or_refused_but_never_panics(
            text in toml_like(),
            key in prop_oneof!["[ab]([.][ab]){0,3}", any::<String>()],
            value in prop_oneof![toml_like(), any::<String>()],
        ) {
            let mut document = match Document::parse("sweep.toml", &text) {
                Ok(document) => document,
                Err(_) => Document::parse("sweep.toml", "[a]\nb = 1\n").expect("it is TOML"),
            };
            match document.set(&format!("{key}={value}")) {
                Ok(()) => { report(&document); }
                Err(diagnostics) => {
                    prop_assert!(diagnostics.render(Styling::Plain).contains("--> command line:"));
                }
            }
        }
    }
}
