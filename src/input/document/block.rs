//! Reading of the blocks that are declared as structs, their problems told with places.

use super::reader::TableReader;
use crate::quantity::block::{Block, Reported, Source};
use crate::quantity::key::{Key, Kind};
use crate::quantity::setting::Value;

/// Reads a block to its end, with the values of `given` where the table has none; `None` where a problem was reported.
pub(crate) fn read<B: Block>(mut table: TableReader<'_>, given: Option<&B>) -> Option<B> {
    let block = read_from(&mut table, given);
    table.finish();
    block
}

/// The same of a table that has other keys besides.
pub(crate) fn read_from<B: Block>(table: &mut TableReader<'_>, given: Option<&B>) -> Option<B> {
    let block = B::read(table, given)?;
    let Some(conflict) = block.conflict() else {
        return Some(block);
    };
    let place = table.place_of(conflict.key);
    let place = place.unwrap_or_else(|| table.as_ref().clone());
    let report = table.problems().at(&place, conflict.what);
    let report = match conflict.because {
        None => report,
        Some(because) => report.because(because),
    };
    report.help(conflict.help);
    None
}

impl Source for TableReader<'_> {
    fn value(&mut self, key: &'static Key) -> Result<Option<Value>, Reported> {
        // A table in place of a word is read by itself.
        if let Kind::Either(_, Kind::Table(_), _) = key.kind
            && self.parsed(key).is_some()
        {
            return Ok(None);
        }
        let found = self.under(key).ok_or(Reported)?;
        Ok(found.map(|located| located.value))
    }

    fn report_absent(&mut self, key: &'static Key) {
        Self::report_absent(self, key);
    }
}
