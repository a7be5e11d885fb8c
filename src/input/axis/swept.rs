//! What an axis of a sweep varies: a number of a block, or which one of a list of blocks; and how its values are put into the block.

use crate::input::diagnostic::{Diagnostic, Location, Problems};
use crate::input::document::Located;
use crate::input::document::tree::{Entry, Node, Table, Value};
use crate::sweep::plan::Varied;

/// The key under which the list of blocks stands where numbers vary beside it.
pub(super) const WHOLE: &str = "";

/// What the key varies.
#[derive(Debug, Clone)]
pub(crate) struct Swept {
    pub(in crate::input) varied: Varied,
    pub(in crate::input) key_location: Location,
    /// SI units, ascending but in pairs; of a list of blocks their places in it.
    pub(in crate::input) values: Located<Vec<f64>>,
    /// The blocks of a list.
    pub(super) blocks: Vec<Located<Table>>,
}

/// The table of axes that a list of blocks is, to which numbers may come.
pub(super) fn beside_numbers(list: &Node) -> Table {
    let entry = Entry {
        key: list.location.clone(),
        node: list.clone(),
    };
    Table {
        entries: [(WHOLE.to_owned(), entry)].into(),
    }
}

impl Swept {
    /// Whether the block has what varies.
    pub(in crate::input) fn is_in(&self, block: &Table) -> bool {
        at_key(&mut block.clone(), &self.varied.key, |_, _| {}).is_some()
    }

    /// The block of a list that a value is the place of; `None` where a number varies.
    pub(in crate::input) fn block(&self, value: f64) -> Option<&Located<Table>> {
        self.blocks.get(value as usize)
    }

    /// Puts values in this order, and blocks with them, which are then counted in it.
    pub(in crate::input) fn reorder(&mut self, order: &[usize]) {
        if self.varied.is_whole() {
            let names = order.iter().map(|&k| self.varied.names[k].clone());
            self.varied = Varied::blocks(self.varied.block, names);
            self.blocks = order.iter().map(|&k| self.blocks[k].clone()).collect();
        } else {
            let values = &mut self.values.value;
            *values = order.iter().map(|&k| values[k]).collect();
        }
    }

    /// The table of a block with this value (SI units) in place of its own; what is wrong with it is told at the axis.
    ///
    /// # Errors
    /// A number in a table or a list that the block does not have.
    pub(in crate::input) fn put_into(
        &self,
        block: &Table,
        value: f64,
    ) -> Result<Table, Diagnostic> {
        if let Some(listed) = self.block(value) {
            return Ok(listed.value.clone());
        }
        let mut table = block.clone();
        let entry = Entry {
            key: self.key_location.clone(),
            node: Node {
                value: Value::Float(Ok(value)),
                location: self.values.location.clone(),
            },
        };
        let key = &self.varied.key;
        let put = |table: &mut Table, key: &str| table.entries.insert(key.to_owned(), entry);
        let put = match self.varied.is_nested() {
            true => at_key(&mut table, key, put),
            false => Some(put(&mut table, key)),
        };
        let name = self.varied.block.name();
        let missing = || {
            Diagnostic::at(&self.key_location, format!("[{name}] has no `{key}`"))
                .because("varies what the block does not have")
                .help(format!("write the number into [{name}], or another key here; items of lists are counted from 0"))
        };
        put.map(|_| table).ok_or_else(missing)
    }
}

/// Whether a `[sweep]` block has a list of blocks in place of one.
pub(in crate::input) fn has_list(sweep: &Table, block: &str) -> bool {
    match sweep.entries.get(block).map(|entry| &entry.node.value) {
        Some(Value::Array(_)) => true,
        Some(Value::Table(table)) => table.entries.contains_key(WHOLE),
        _ => false,
    }
}

/// What `then` makes of the table that has the last part of a key, which is there.
fn at_key<T>(table: &mut Table, key: &str, then: impl FnOnce(&mut Table, &str) -> T) -> Option<T> {
    let Some((first, rest)) = key.split_once('.') else {
        return table.entries.contains_key(key).then(|| then(table, key));
    };
    let (name, place) = match first.split_once('[') {
        Some((name, place)) => (name, Some(place.strip_suffix(']')?.parse().ok()?)),
        None => (first, None::<usize>),
    };
    let value = &mut table.entries.get_mut(name)?.node.value;
    let below = match (value, place) {
        (Value::Array(items), Some(place)) => &mut items.get_mut(place)?.value,
        (_, Some(_)) => return None,
        (value, None) => value,
    };
    match below {
        Value::Table(below) => at_key(below, rest, then),
        _ => None,
    }
}

/// Takes the quotes off the keys of `[sweep]`: `"material.temperature" = [...]` is the same as `material.temperature = [...]`.
pub(in crate::input) fn unquote(root: &mut Table, problems: &Problems) {
    let Some(Value::Table(sweep)) = root
        .entries
        .get_mut("sweep")
        .map(|entry| &mut entry.node.value)
    else {
        return;
    };
    let quoted: Vec<String> = (sweep.entries.keys())
        .filter(|key| key.contains('.'))
        .cloned()
        .collect();
    for key in quoted {
        let (Some((block, inner)), Some(entry)) = (key.split_once('.'), sweep.entries.remove(&key))
        else {
            continue;
        };
        let below = sweep
            .entries
            .entry(block.to_owned())
            .or_insert_with(|| Entry {
                key: entry.key.clone(),
                node: Node::empty_table(&entry.key),
            });
        if let Value::Array(_) = &below.node.value {
            below.node.value = Value::Table(beside_numbers(&below.node));
        }
        match &mut below.node.value {
            Value::Table(table) if !table.entries.contains_key(inner) => {
                table.entries.insert(inner.to_owned(), entry);
            }
            _ => {
                problems
                    .at(&entry.key, format!("`sweep.{key}` is given twice"))
                    .help("keep one of them");
            }
        }
    }
}
