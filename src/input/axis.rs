//! The axes of a sweep besides the frequency: any number of `[material]`, `[layer]`, `[indenter]` or `[drive]`, by its key, as a list or
//! a range; and materials or indenters in the place of one another, as a list of blocks with names. Each is a list of assignments.

mod keys;
mod read;

use std::collections::HashMap;

use super::assignment::Path;
use super::diagnostic::{Diagnostic, Location};
use super::document::Located;
use super::document::tree::{Node, Table, Value};
use crate::sweep::plan::{AxisValue, Varied};
pub(crate) use keys::AxisOf;
pub(super) use read::read;

/// One axis: values that take the place of one another at a path of the document.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    pub(super) varied: Varied,
    path: Path,
    /// The key in `[sweep]`.
    pub(super) key: Location,
    /// Numbers in SI units, ascending but in pairs; or blocks.
    values: Vec<Located<Value>>,
}

/// Whether a list of blocks stands in place of one in `[sweep]`.
pub(super) fn has_list(sweep: Option<&Table>, block: &str) -> bool {
    let list = sweep.and_then(|sweep| sweep.entries.get(block));
    list.is_some_and(|list| matches!(list.node.value, Value::Array(_)))
}

impl Axis {
    /// How many values it has.
    pub(super) fn count(&self) -> usize {
        self.values.len()
    }

    /// The value at this place among them.
    pub(super) fn value(&self, at: usize) -> AxisValue {
        match self.values.get(at).map(|value| &value.value) {
            Some(Value::Float(Ok(number))) => AxisValue::Number(*number),
            _ => AxisValue::Block(at),
        }
    }

    /// All values, where they are numbers.
    pub(super) fn numbers(&self) -> Option<Located<Vec<f64>>> {
        let first = self.values.first()?;
        let numbers = (0..self.count()).map(|at| self.value(at).number());
        Some(Located {
            value: numbers.collect::<Option<_>>()?,
            path: first.path.clone(),
            location: first.location.clone(),
        })
    }

    /// Of every value the place of the first that is equal to it.
    pub(super) fn first_places(&self) -> Vec<usize> {
        let mut known = HashMap::new();
        let first = |at| match self.value(at) {
            // Zero has two signs.
            AxisValue::Number(number) => *known.entry((number + 0.0).to_bits()).or_insert(at),
            AxisValue::Block(_) => at,
        };
        (0..self.count()).map(first).collect()
    }

    /// Puts the values in this order, in which blocks are then counted.
    pub(super) fn reorder(&mut self, order: &[usize]) {
        self.values = order.iter().map(|&at| self.values[at].clone()).collect();
        if self.varied.is_whole() {
            let names = order.iter().map(|&at| self.varied.names[at].clone());
            self.varied = Varied::blocks(self.varied.block, names);
        }
    }

    /// Whether a document has what varies.
    pub(super) fn is_in(&self, root: &Table) -> bool {
        self.path.find(root).is_some()
    }

    /// What messages call the block at this place among the values; `None` where numbers vary.
    pub(super) fn block_path(&self, at: usize) -> Option<&str> {
        let block = self.values.get(at).filter(|_| self.varied.is_whole())?;
        Some(&block.path)
    }

    /// Assigns the value at this place among all; what is wrong with it is reported at the axis.
    ///
    /// # Errors
    /// A number in a table or a list that the document does not have.
    pub(super) fn assign(&self, at: usize, root: &mut Table) -> Result<(), Diagnostic> {
        let Some(Located {
            value, location, ..
        }) = self.values.get(at).cloned()
        else {
            return Ok(());
        };
        if self.varied.is_nested() && !self.is_in(root) {
            let (name, key) = (self.varied.block.name(), &self.varied.key);
            return Err(Diagnostic::at(&self.key, format!("[{name}] has no `{key}`"))
                .because("varies what the block does not have")
                .help(format!("write the number into [{name}], or another key here; items of lists are counted from 0")));
        }
        self.path.set(root, Node { value, location })
    }
}
