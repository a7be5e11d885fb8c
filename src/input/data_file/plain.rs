//! The short way to read what most large matrices are: lines of plain numbers, separated by one sign.

use super::text::DELIMITERS;

/// Numbers row by row, and how many are in a row. `None` of all that takes a closer look: other encodings, quotation marks, decimal
/// commas, cells without a number, rows of different length; what is wrong there is told by who takes it.
pub(crate) fn matrix(bytes: &[u8]) -> Option<(usize, Vec<f64>)> {
    let text = std::str::from_utf8(bytes).ok()?;
    let is_row = |line: &&str| !matches!(line.trim_start().bytes().next(), None | Some(b'#'));
    let mut rows = text.lines().filter(is_row);
    let first = rows.clone().next()?;
    let mut signs = DELIMITERS.iter().map(|(sign, _)| *sign);
    let mut found = signs
        .by_ref()
        .filter(|sign| *sign != ' ' && first.contains(*sign));
    let (sign, other) = (found.next(), found.next());
    let columns = match sign {
        Some(sign) => first.split(sign).count(),
        None => blank_cells(first).count(),
    };
    if other.is_some() || columns < 2 {
        return None;
    }
    let mut values = Vec::with_capacity(columns * rows.clone().count());
    let is_read = rows.all(|row| {
        let before = values.len();
        let is_plain = match sign {
            Some(sign) => append(row.split(sign), &mut values),
            None => append(blank_cells(row), &mut values),
        };
        is_plain && values.len() == before + columns
    });
    is_read.then_some((columns, values))
}

fn blank_cells(row: &str) -> impl Iterator<Item = &str> {
    row.split([' ', '\t']).filter(|cell| !cell.is_empty())
}

/// Appends cells as numbers, as long as they are plain ones.
fn append<'a>(mut cells: impl Iterator<Item = &'a str>, values: &mut Vec<f64>) -> bool {
    cells.all(|cell| match cell.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => {
            values.push(value);
            true
        }
        _ => false,
    })
}
