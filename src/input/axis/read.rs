//! Reading the axes over a block: the list or the range of each of its numbers, and the list of blocks in its place.

use std::borrow::Cow;

use super::keys::{AxisNumber, AxisOf};
use super::{Axis, Path};
use crate::input::diagnostic::{Location, Problems};
use crate::input::document::Located;
use crate::input::document::kind::{Asked, Spot};
use crate::input::document::reader::{TableReader, in_backticks, join};
use crate::input::document::similar::similar;
use crate::input::document::tree::{Entry, Node, Value};
use crate::input::keys::drive::RANGE;
use crate::input::keys::material::{LIBRARY, NAME};
use crate::input::points::MOST_POINTS;
use crate::quantity::Dimension;
use crate::quantity::block::{Field, Word};
use crate::quantity::key::{Entries, Key, Kind};
use crate::sweep::plan::{Block, Varied};

/// Characters of a name; more do not fit into a legend.
const NAME_LENGTH: usize = 60;

/// The axes of `[sweep]` over the block of a key, given in the dimension that the drive controls where that counts; in pairs their
/// values keep the order in which they are given. `None` where a problem was reported.
pub(in crate::input) fn read(
    sweep: &mut TableReader<'_>,
    key: &Key,
    controlled: Dimension,
    pairs: bool,
) -> Option<Vec<Axis>> {
    let Kind::Axes(of) = &key.kind else {
        return Some(Vec::new());
    };
    let known = Block::ALL.iter().find(|(name, _)| *name == key.name);
    let reading = Reading {
        block: known.map(|(_, block)| *block)?,
        numbers: AxisOf(of).numbers(controlled),
        may_be_listed: of.listed.is_some(),
        kind: &key.kind,
        pairs,
        problems: sweep.problems(),
    };
    let mut axes = Vec::new();
    for (key, entry) in sweep.with_quoted(key.name) {
        reading.add(Path::default().and(key, &entry.key), entry, &mut axes)?;
    }
    // Whole blocks first, then by their keys, in quotes or not.
    axes.sort_by(|a, b| a.varied.key.cmp(&b.varied.key));
    let is_listed = axes.iter().any(|axis| axis.varied.is_whole());
    let nested = axes.iter().find(|axis| axis.varied.is_nested());
    match nested.filter(|_| is_listed) {
        Some(nested) => reading.within_listed(nested),
        None => Some(axes),
    }
}

struct Reading<'a> {
    block: Block,
    may_be_listed: bool,
    kind: &'a Kind,
    numbers: Vec<AxisNumber>,
    pairs: bool,
    problems: &'a Problems,
}

impl Reading<'_> {
    /// Adds the axis of a key, or those of the keys of the table that is given there: `zener = { time = [...] }` is
    /// `zener.time = [...]`.
    fn add(&self, path: Path, entry: &Entry, to: &mut Vec<Axis>) -> Option<()> {
        let general = path.general();
        let (key, is_block) = (self.within(&general), general == self.block.name());
        let is_below = |number: &AxisNumber| {
            let below = number.key.strip_prefix(key);
            is_block || below.is_some_and(|below| below.starts_with(['.', '[']))
        };
        let number = self.numbers.iter().find(|number| number.key == key);
        let axis = match (number, &entry.node.value) {
            (Some(number), _) => self.over_number(number, path, entry)?,
            (None, Value::Table(table)) if self.numbers.iter().any(is_below) => {
                if table.entries.is_empty() {
                    let help = format!("write the key of [{}] that varies", self.block.name());
                    return self.empty(&path, entry, help);
                }
                let mut inner = table.entries.iter();
                return inner.try_for_each(|(k, e)| self.add(path.and(k, &e.key), e, to));
            }
            (None, Value::Array(items)) if is_block && self.may_be_listed => {
                self.over_blocks(items, path, entry)?
            }
            (None, _) if is_block => return self.no_table(&entry.node),
            (None, _) => return self.no_number(&path, entry),
        };
        if to.iter().any(|other| other.varied.key == axis.varied.key) {
            let key = axis.path;
            (self
                .problems
                .at(&axis.key, format!("`sweep.{key}` is given twice")))
            .help("keep one of them");
            return None;
        }
        to.push(axis);
        Some(())
    }

    /// The part of a key that is within the block.
    fn within<'k>(&self, key: &'k str) -> &'k str {
        let within = key.strip_prefix(self.block.name()).unwrap_or(key);
        within.strip_prefix('.').unwrap_or(within)
    }

    fn over_number(&self, number: &AxisNumber, path: Path, entry: &Entry) -> Option<Axis> {
        let AxisNumber { row, scalar, .. } = number;
        let (key, node) = (path.to_string(), &entry.node);
        let spot = Spot {
            path: &join("sweep", &key),
            key: Some(row.name),
        };
        let kind = &match (&node.value, self.pairs) {
            (Value::Array(_), true) => Kind::Numbers(*scalar, Entries::of(1..=MOST_POINTS, "")),
            _ => Kind::Points(*scalar, &RANGE),
        };
        let spot = &spot;
        let points = Asked { kind, node, spot }.read();
        let points = points.map_err(|found| self.problems.extend(found)).ok()?;
        let points = Vec::of(points).unwrap_or_default();
        let value = |point| spot.located(Value::Float(Ok(point)), node);
        let name = match number.is_nested() {
            true => Cow::Owned(self.within(&key).to_owned()),
            false => Cow::Borrowed(row.name),
        };
        Some(Axis {
            varied: Varied::number(self.block, name, scalar.dimension),
            values: points.into_iter().map(value).collect(),
            key: entry.key.clone(),
            path,
        })
    }

    /// The axis that a list of blocks is, each with a name of its own.
    fn over_blocks(&self, items: &[Node], path: Path, entry: &Entry) -> Option<Axis> {
        let (problems, block) = (self.problems, self.block.name());
        let named = items.iter().enumerate();
        let named = named.map(|(k, item)| self.named(item, format!("sweep.{path}[{k}]")));
        // All are read, so that all problems are reported.
        let named: Vec<Option<(String, Located<Value>)>> = named.collect();
        let mut is_whole = named.iter().all(Option::is_some);
        let (names, values): (Vec<_>, Vec<_>) = named.into_iter().flatten().unzip();
        for (k, (name, value)) in names.iter().zip(&values).enumerate() {
            let Some(other) = names[..k].iter().position(|known| known == name) else {
                continue;
            };
            let message = format!("two blocks of `sweep.{path}` are called `{name}`");
            (problems.at(value, message))
                .label(&values[other], "the other one")
                .help(format!("give every {block} a `name` of its own"));
            is_whole = false;
        }
        if items.is_empty() {
            let help = format!("write a `[[sweep.{block}]]` for each {block}");
            return self.empty(&path, entry, help);
        }
        is_whole.then(|| Axis {
            varied: Varied::blocks(self.block, names),
            // A header opens each item of the list.
            key: entry.node.location.clone(),
            path,
            values,
        })
    }

    /// A block of a list with its name: what stands under `name`, else the material of the library that it is.
    fn named(&self, item: &Node, path: String) -> Option<(String, Located<Value>)> {
        let Node { value, location } = item;
        let Value::Table(table) = value else {
            return self.no_block(item, &path);
        };
        let mut reader = TableReader::new(table, location.clone(), path.clone(), self.problems);
        let given = reader.read_if::<String>(&NAME)?;
        let name = match &given {
            Some(given) => given.value.clone(),
            None if reader.has(&LIBRARY) => reader.value::<String>(&LIBRARY)?.trim().to_lowercase(),
            None => {
                let help = "tables and figures call it by that: name = \"...\"";
                let message = format!("`{path}` needs a `name`");
                self.problems.at(location, message).help(help);
                return None;
            }
        };
        let place = given.map_or(location.clone(), |given| given.location);
        self.check_name(&name, &path, &place)?;
        let mut table = table.clone();
        match self.block {
            Block::Material => {
                let node = Node {
                    value: Value::Text(name.clone()),
                    location: place.clone(),
                };
                let entry = Entry { key: place, node };
                table.entries.insert(NAME.name.to_owned(), entry);
            }
            _ => drop(table.entries.remove(NAME.name)),
        }
        let block = Located {
            value: Value::Table(table),
            path,
            location: location.clone(),
        };
        Some((name, block))
    }
}

/// What is refused.
impl Reading<'_> {
    fn empty<T>(&self, path: &Path, entry: &Entry, help: String) -> Option<T> {
        let message = format!("`sweep.{path}` is empty");
        self.problems.at(&entry.node.location, message).help(help);
        None
    }

    /// Something in place of the table of axes.
    fn no_table<T>(&self, node: &Node) -> Option<T> {
        let block = self.block.name();
        let message = format!("`sweep.{block}` must be {}", self.kind.expected());
        (self.problems.at(&node.location, message))
            .because(format!("found {}", node.describe()))
            .help(format!("write `{block}.KEY = [...]`"));
        None
    }

    /// Something in place of a block of a list.
    fn no_block<T>(&self, item: &Node, path: &str) -> Option<T> {
        let message = format!("`{path}` must be a table");
        (self.problems.at(&item.location, message))
            .because(format!("found {}", item.describe()))
            .help(match (&item.value, self.block) {
                (Value::Text(name), Block::Material) => {
                    format!("write `{{ library = \"{name}\" }}`")
                }
                _ => "write the keys of the block in braces".to_owned(),
            });
        None
    }

    /// A name that legends and tables cannot show.
    fn check_name(&self, name: &str, path: &str, place: &Location) -> Option<()> {
        let is_formula = name.starts_with(['=', '+', '-', '@']);
        let has_blanks = name.trim() != name || name.contains(char::is_control);
        let is_long = name.chars().count() > NAME_LENGTH;
        if !(name.is_empty() || is_long || has_blanks || is_formula) {
            return Some(());
        }
        let report = self.problems.at(place, format!(
            "`{path}.name` must have 1 to {NAME_LENGTH} characters, no blanks at its ends, no line ends, and none of = + - @ at its beginning"
        ));
        if is_formula {
            report
                .because("a spreadsheet that opens the tables would take it for a formula")
                .help("begin the name with a letter or a digit");
        }
        None
    }

    /// A number in a table or list of blocks that may each have others.
    fn within_listed<T>(&self, nested: &Axis) -> Option<T> {
        let (block, key) = (self.block.name(), &nested.varied.key);
        let message = format!("`{block}.{key}` cannot be an axis beside a list of blocks");
        (self.problems.at(&nested.key, message))
            .because("a number within a table of the block")
            .help(format!(
                "write a `[[sweep.{block}]]` for each of its values"
            ));
        None
    }

    /// A key that no number stands under.
    fn no_number<T>(&self, path: &Path, entry: &Entry) -> Option<T> {
        let names: Vec<&str> = self.numbers.iter().map(|n| n.key.as_str()).collect();
        let block = self.block.name();
        let message = format!("`sweep.{path}` cannot be an axis");
        let report = self.problems.at(&entry.key, message);
        let report = report.because(format!("no key of [{block}] that takes one number"));
        let key = path.to_string();
        let key = self.within(&key);
        if let Some(meant) = similar(key, &names) {
            report.help(format!("write `{meant}` instead of `{key}`"));
            return None;
        }
        // What the other body may be made of is as long again as the rest.
        let is_own = |name: &&str| !name.starts_with("material.");
        let own: Vec<&str> = names.iter().copied().filter(is_own).collect();
        let others = match own.len() == names.len() {
            true => "",
            false => ", and those of its `material`",
        };
        let can = in_backticks(&own);
        report.help(format!("keys of [{block}] that can: {can}{others}"));
        None
    }
}
