//! The part of a field that has ever carried pressure: the only part that memory has to follow.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// From the first node that was ever loaded to the last.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Loaded(Range<usize>);

impl Loaded {
    /// Takes in every node of a field that is not zero.
    pub(super) fn extend(&mut self, field: &[f64]) {
        if self.0.is_empty() {
            self.0 = match first(field) {
                Some(first) => first..end(field),
                None => 0..0,
            };
            return;
        }
        let Range { start, end: known } = self.0.clone();
        let before = field.get(..start).and_then(first);
        let after = field.get(known..).map_or(0, end);
        self.0 = before.unwrap_or(start)..known + after;
    }

    /// The nodes.
    pub(super) fn range(&self) -> Range<usize> {
        self.0.clone()
    }
}

/// Values looked at together: comparing them all is faster than stopping at the first.
const BLOCK: usize = 64;

fn any(block: &[f64]) -> bool {
    // All bits but the sign.
    block.iter().fold(0, |bits, value| bits | value.to_bits()) << 1 != 0
}

/// The first value that is not zero.
fn first(field: &[f64]) -> Option<usize> {
    let block = field.chunks(BLOCK).position(any)?;
    let rest = &field[block * BLOCK..];
    Some(block * BLOCK + rest.iter().position(|&value| value != 0.0)?)
}

/// One beyond the last value that is not zero; 0 where there is none.
fn end(field: &[f64]) -> usize {
    let Some(block) = field.chunks(BLOCK).rposition(any) else {
        return 0;
    };
    let until = &field[..field.len().min((block + 1) * BLOCK)];
    until
        .iter()
        .rposition(|&value| value != 0.0)
        .map_or(0, |at| at + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_loaded_node_is_taken_in_and_none_is_lost() {
        let mut field = vec![0.0; 300];
        let mut loaded = Loaded::default();
        loaded.extend(&field);
        assert!(loaded.range().is_empty());
        for (node, expected) in [
            (130, 130..131),
            (200, 130..201),
            (131, 130..201),
            (3, 3..201),
            (299, 3..300),
            (0, 0..300),
        ] {
            field.fill(0.0);
            field[node] = -1e-300;
            loaded.extend(&field);
            assert_eq!(loaded.range(), expected);
        }
    }
}
