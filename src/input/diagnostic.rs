//! Error messages that show where they come from: the file, the line, a caret below the words that are
//! wrong, and what to write instead.
//!
//! A [`Diagnostic`] is one problem. [`Problems`] collects them while a file is read, so that all are told
//! in one go. [`Diagnostics`] is the finished, sorted list: an error type, and what is printed.
//!
//! ```
//! use contact_dma::input::diagnostic::{Diagnostic, Location, Problems, Source, Styling};
//!
//! let source = Source::file("sweep.toml", "[drive]\nmean = \"-10 N\"\n");
//! let problems = Problems::new();
//! problems
//!     .at(&Location::new(&source, 15..22), "`drive.mean` must be positive")
//!     .because("pulls the indenter off")
//!     .help("write `mean = \"10 N\"`");
//! let refused = problems.into_result(Some(())).unwrap_err();
//! assert_eq!(
//!     refused.render(Styling::Plain),
//!     "\
//! error: `drive.mean` must be positive
//!  --> sweep.toml:2:8
//!   |
//! 2 | mean = \"-10 N\"
//!   |        ^^^^^^^ pulls the indenter off
//!   |
//!   = help: write `mean = \"10 N\"`
//! "
//! );
//! ```

mod render;

use std::cell::RefCell;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

pub use render::Styling;

/// Diagnostics shown at once; a reader mends the first ones and runs again.
pub(super) const MAX_SHOWN: usize = 20;

/// Diagnostics kept for sorting. Bounds the memory a hostile file can ask for; the rest is only counted.
const MAX_KEPT: usize = 1000;

/// A text that problems can point into: a file, a table that a program holds, or a flag of the command line.
pub struct Source {
    name: String,
    text: String,
    /// Files come before flags, flags in the order given.
    rank: usize,
    tables: Tables,
}

/// Data that a document may name as files, by name and bytes.
pub type Tables = Vec<(String, Arc<[u8]>)>;

/// How the name of a table in memory begins, which was an argument of a call: its places are rows.
const ARGUMENT: &str = "argument";

impl Source {
    /// The text of a file, under the name by which the user knows it.
    pub fn file(name: impl Into<String>, text: impl Into<String>) -> Arc<Self> {
        Self::with_tables(name, text, Vec::new())
    }

    /// The same, of a file that names these tables as if they were files.
    pub fn with_tables(
        name: impl Into<String>,
        text: impl Into<String>,
        tables: Tables,
    ) -> Arc<Self> {
        Arc::new(Self {
            name: name.into(),
            text: text.into(),
            rank: 0,
            tables,
        })
    }

    /// The text of a command-line flag as typed, `--set cycle.steps=200`; `ordinal` counts flags from zero.
    pub fn flag(text: impl Into<String>, ordinal: usize) -> Arc<Self> {
        Arc::new(Self {
            name: "command line".to_owned(),
            text: text.into(),
            rank: ordinal.saturating_add(1),
            tables: Vec::new(),
        })
    }

    /// The name shown after the arrow.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether this is a flag, which has no line number worth showing.
    pub fn is_flag(&self) -> bool {
        self.rank > 0
    }

    /// The bytes of a table that was given under this name, in place of a file.
    pub(super) fn table(&self, name: &str) -> Option<&[u8]> {
        let mut tables = self.tables.iter();
        tables.find_map(|(known, bytes)| (known == name).then_some(&**bytes))
    }

    /// What messages call a line, by its number from 1, of a table in memory; `None` of a file.
    fn row(&self, line: usize) -> Option<String> {
        let is_table = self.name.starts_with(ARGUMENT);
        is_table.then(|| match line {
            1 => format!("{}, the names of its columns", self.name),
            line => format!("{}, row {}", self.name, line - 1),
        })
    }
}

impl fmt::Debug for Source {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "Source({:?}, {} bytes)",
            self.name,
            self.text.len()
        )
    }
}

/// A place in a source: a range of bytes, or the source as a whole.
#[derive(Clone)]
pub struct Location {
    source: Arc<Source>,
    span: Option<Range<usize>>,
}

impl Location {
    /// The bytes `span` of `source`. A span outside the text is clipped when it is shown.
    pub fn new(source: &Arc<Source>, span: Range<usize>) -> Self {
        Self {
            source: Arc::clone(source),
            span: Some(span),
        }
    }

    /// The source as a whole: for what is absent from it, and so has no line.
    pub fn whole(source: &Arc<Source>) -> Self {
        Self {
            source: Arc::clone(source),
            span: None,
        }
    }

    /// The source pointed into.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Whether this is a source as a whole.
    pub fn is_whole(&self) -> bool {
        self.span.is_none()
    }

    /// The text at this place, empty for a whole source or a span outside the text.
    pub fn text(&self) -> &str {
        let span = self.span.clone().unwrap_or(0..0);
        self.source.text.get(span).unwrap_or("")
    }

    /// The file and the line, as messages show them: `dma.txt:12`.
    pub fn line(&self) -> String {
        let start = self.span.as_ref().map(|span| span.start);
        match start.and_then(|start| self.source.text.get(..start)) {
            Some(before) => {
                let line = before.matches('\n').count() + 1;
                let row = self.source.row(line);
                row.unwrap_or_else(|| format!("{}:{line}", self.source.name))
            }
            None => self.source.name.clone(),
        }
    }

    /// Order in which places are reported: files, then flags; by position within each.
    fn order(&self) -> (usize, &str, Option<usize>) {
        let start = self.span.as_ref().map(|span| span.start);
        (self.source.rank, &self.source.name, start)
    }
}

impl fmt::Debug for Location {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}[{:?}]", self.source.name, self.span)
    }
}

impl AsRef<Location> for Location {
    fn as_ref(&self) -> &Location {
        self
    }
}

/// A place with what is to be said about it.
#[derive(Clone, Debug)]
struct Label {
    location: Location,
    text: String,
    is_primary: bool,
}

/// One problem: what is wrong, where, and what to write instead.
///
/// Say what was expected and found in the message, in one line without a full stop; quote keys and code in
/// backticks. The first place is the primary one, underlined with carets; further ones get dashes.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    message: String,
    labels: Vec<Label>,
    help: Vec<String>,
    notes: Vec<String>,
}

impl Diagnostic {
    /// A problem of no particular place, such as a file that cannot be opened.
    pub fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            labels: Vec::new(),
            help: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// A problem at `place`.
    pub fn at(place: &impl AsRef<Location>, message: impl Into<String>) -> Self {
        // The first label is the primary one.
        Self::new(message).label(place, "")
    }

    /// Says something right at the primary place.
    #[must_use]
    pub fn because(mut self, text: impl Into<String>) -> Self {
        if let Some(primary) = self.labels.first_mut() {
            primary.text = text.into();
        }
        self
    }

    /// Shows a further place, in the same source or another.
    #[must_use]
    pub fn label(mut self, place: &impl AsRef<Location>, text: impl Into<String>) -> Self {
        self.labels.push(Label {
            location: place.as_ref().clone(),
            text: text.into(),
            is_primary: self.labels.is_empty(),
        });
        self
    }

    /// Says what to write instead.
    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help.push(text.into());
        self
    }

    /// Adds background.
    #[must_use]
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// What is wrong, without the place.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The primary place.
    pub fn location(&self) -> Option<&Location> {
        self.labels.first().map(|label| &label.location)
    }

    fn order(&self) -> Option<(usize, &str, Option<usize>)> {
        self.location().map(Location::order)
    }
}

/// Every problem found, sorted by position. Displays as the plain rendering.
#[derive(Debug, thiserror::Error)]
#[error("{}", self.render(Styling::Plain).trim_end())]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    /// Found, but not kept.
    omitted: usize,
}

impl Diagnostics {
    /// Sorts `list` by position; of two with the same message at the same place one is kept.
    pub fn new(list: Vec<Diagnostic>) -> Self {
        Self::with_omitted(list, 0)
    }

    /// As [`Diagnostics::new`], with the number of problems that were found but are not in `list`.
    pub(super) fn with_omitted(mut list: Vec<Diagnostic>, omitted: usize) -> Self {
        list.sort_by(|left, right| left.order().cmp(&right.order()));
        list.dedup_by(|left, right| left.message == right.message && left.order() == right.order());
        Self { list, omitted }
    }

    /// The same, the first of them with a further place.
    #[must_use]
    pub(super) fn label_first(mut self, place: &impl AsRef<Location>, text: &str) -> Self {
        if let Some(first) = self.list.first_mut() {
            *first = first.clone().label(place, text);
        }
        self
    }

    /// How many problems were found.
    pub fn count(&self) -> usize {
        self.list.len() + self.omitted
    }

    /// The problems, by position.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.list.iter()
    }

    /// The first 20 problems as text, laid out for 80 columns; ends with a line end.
    pub fn render(&self, styling: Styling) -> String {
        let shown = &self.list[..self.list.len().min(MAX_SHOWN)];
        let mut texts: Vec<String> = shown
            .iter()
            .map(|diagnostic| render::render(diagnostic, styling))
            .collect();
        if self.count() > shown.len() {
            let total = format!(
                "{} problems found; the first {} are shown",
                self.count(),
                shown.len()
            );
            texts.push(render::render(&Diagnostic::new(total), styling));
        }
        texts.join("\n")
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::new(vec![diagnostic])
    }
}

/// Collects problems while a file is read and checked. Shared by reference between all who find some.
#[derive(Debug, Default)]
pub struct Problems {
    found: RefCell<Found>,
}

#[derive(Debug, Default)]
struct Found {
    /// A retracted problem leaves `None`, so that numbers handed out stay valid.
    list: Vec<Option<Diagnostic>>,
    omitted: usize,
}

impl Problems {
    /// No problem yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Reports a problem at the place of a value; the answer takes help, notes and further places.
    pub fn at(&self, place: &impl AsRef<Location>, message: impl Into<String>) -> Reported<'_> {
        self.push(Diagnostic::at(place, message))
    }

    /// Reports a problem; the answer takes help, notes and further places.
    pub fn push(&self, diagnostic: Diagnostic) -> Reported<'_> {
        let mut found = self.found.borrow_mut();
        let index = found.list.len();
        if index < MAX_KEPT {
            found.list.push(Some(diagnostic));
        } else {
            found.omitted += 1;
        }
        Reported {
            problems: self,
            index,
        }
    }

    /// What was made, or `None` where its refusal is reported at this place.
    pub fn accept<T>(
        &self,
        place: &impl AsRef<Location>,
        made: Result<T, impl fmt::Display>,
    ) -> Option<T> {
        made.map_err(|error| self.at(place, error.to_string())).ok()
    }

    /// Takes over problems collected elsewhere.
    pub fn extend(&self, diagnostics: Diagnostics) {
        for diagnostic in diagnostics.list {
            self.push(diagnostic);
        }
        self.found.borrow_mut().omitted += diagnostics.omitted;
    }

    /// Whether nothing was reported so far.
    pub fn is_empty(&self) -> bool {
        let found = self.found.borrow();
        found.omitted == 0 && found.list.iter().all(Option::is_none)
    }

    /// The value, if there was no problem; otherwise every problem.
    ///
    /// # Errors
    /// The problems reported. A missing value that nobody explained is itself reported.
    pub fn into_result<T>(self, value: Option<T>) -> Result<T, Diagnostics> {
        let found = self.found.into_inner();
        let list: Vec<Diagnostic> = found.list.into_iter().flatten().collect();
        match value {
            Some(value) if list.is_empty() && found.omitted == 0 => Ok(value),
            None if list.is_empty() && found.omitted == 0 => Err(Diagnostic::new(
                "the input was refused, but no reason was recorded",
            )
            .note("this is a mistake of the program: please report it with the input")
            .into()),
            _ => Err(Diagnostics::with_omitted(list, found.omitted)),
        }
    }
}

/// A problem just reported, to which more can be added.
#[derive(Debug)]
pub struct Reported<'a> {
    problems: &'a Problems,
    index: usize,
}

impl Reported<'_> {
    /// Says something right at the primary place.
    pub fn because(self, text: impl Into<String>) -> Self {
        self.change(|diagnostic| diagnostic.because(text))
    }

    /// Shows a further place, in the same source or another.
    pub fn label(self, place: &impl AsRef<Location>, text: impl Into<String>) -> Self {
        self.change(|diagnostic| diagnostic.label(place, text))
    }

    /// Says what to write instead.
    pub fn help(self, text: impl Into<String>) -> Self {
        self.change(|diagnostic| diagnostic.help(text))
    }

    /// Takes the report back, because a better one says the same.
    pub fn retract(self) {
        if let Some(slot) = self.problems.found.borrow_mut().list.get_mut(self.index) {
            *slot = None;
        }
    }

    fn change(self, add: impl FnOnce(Diagnostic) -> Diagnostic) -> Self {
        let mut found = self.problems.found.borrow_mut();
        if let Some(slot) = found.list.get_mut(self.index) {
            *slot = slot.take().map(add);
        }
        drop(found);
        self
    }
}
