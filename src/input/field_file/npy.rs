//! Matrices of floats in NumPy's `.npy` format, versions 1 to 3 (NumPy Enhancement Proposal 1, and the documentation of
//! `numpy.lib.format`): a mark, the length of the header, the header as a Python dictionary, then the bare numbers.

use super::Field;
use crate::input::diagnostic::{Diagnostic, Location, Source};

/// What the file begins with.
pub(in crate::input) const MAGIC: &[u8] = b"\x93NUMPY";

/// Bytes of a number, and how they are read.
type Float = (usize, fn(&[u8]) -> f64);

fn float(descriptor: &str) -> Option<Float> {
    match descriptor {
        "'<f4'" => Some((4, |bytes| f32::from_le_bytes(sized(bytes)).into())),
        "'<f8'" => Some((8, |bytes| f64::from_le_bytes(sized(bytes)))),
        "'>f4'" => Some((4, |bytes| f32::from_be_bytes(sized(bytes)).into())),
        "'>f8'" => Some((8, |bytes| f64::from_be_bytes(sized(bytes)))),
        _ => None,
    }
}

/// As many bytes as [`Float`] says.
fn sized<const N: usize>(bytes: &[u8]) -> [u8; N] {
    bytes.try_into().unwrap_or([0; N])
}

/// A matrix, row by row.
pub(in crate::input) struct Matrix {
    pub(in crate::input) columns: usize,
    pub(in crate::input) rows: usize,
    pub(in crate::input) values: Vec<f64>,
}

/// What a reader of a file without one is told to write.
pub(in crate::input) struct Wanted {
    /// The call of NumPy that writes it.
    pub(in crate::input) call: &'static str,
    /// What rows and columns are.
    pub(in crate::input) layout: &'static str,
}

const MAP: Wanted = Wanted {
    call: "numpy.save(\"map.npy\", heights_m.astype(\"<f8\"))",
    layout: "save a matrix, one row per y and one column per x",
};

/// The map in a whole file, which messages call `name`.
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<Field, Diagnostic> {
    let matrix = matrix(name, bytes, &MAP)?;
    if let Some(at) = matrix.values.iter().position(|z| !z.is_finite()) {
        let (row, column) = (at / matrix.columns + 1, at % matrix.columns + 1);
        let message = format!(
            "a hole: the entry in row {row}, column {column} is {}",
            matrix.values[at]
        );
        let place = Location::whole(&Source::file(name, ""));
        return Err(Diagnostic::at(&place, message).help(super::HOLE));
    }
    Ok(Field {
        cells_x: matrix.columns,
        cells_y: matrix.rows,
        values_m: matrix.values,
        spacing_m: None,
    })
}

/// The matrix in a whole file, which messages call `name`; numbers as they are.
pub(in crate::input) fn matrix(
    name: &str,
    bytes: &[u8],
    wanted: &Wanted,
) -> Result<Matrix, Diagnostic> {
    let fail = |message: String, help: &str| {
        let place = Location::whole(&Source::file(name, ""));
        Diagnostic::at(&place, message).help(help)
    };
    let unreadable = |why: &str| {
        let message = format!("no .npy file that can be read: {why}");
        fail(message, &format!("write it with {}", wanted.call))
    };
    let (header, data) = split(bytes).ok_or_else(|| unreadable("it ends within its header"))?;
    let entry =
        |key| entry(header, key).ok_or_else(|| unreadable(&format!("no '{key}' in its header")));
    let (descriptor, order, shape) = (entry("descr")?, entry("fortran_order")?, entry("shape")?);
    let (width, decode) = float(descriptor).ok_or_else(|| {
        let found: String = descriptor.chars().take(40).collect();
        let message = format!("numbers of the type {found}, where '<f8' or '<f4' is needed");
        fail(message, &format!("write it with {}", wanted.call))
    })?;
    let (cells_y, cells_x) = two_lengths(shape).ok_or_else(|| {
        let shape: String = shape.chars().take(40).collect();
        let message = format!("an array of shape {shape}, where two dimensions are needed");
        fail(message, wanted.layout)
    })?;
    let expected = cells_x.saturating_mul(cells_y).saturating_mul(width);
    if data.len() != expected {
        let found = data.len();
        let message = format!("{found} bytes of numbers, where the shape needs {expected}");
        return Err(fail(message, "the file is not whole: write it again"));
    }
    if expected == 0 {
        return Err(fail("the file holds no numbers".to_owned(), wanted.layout));
    }
    let stored = data.chunks_exact(width).map(decode);
    let values: Vec<f64> = if order == "True" {
        // Columns first.
        let stored: Vec<f64> = stored.collect();
        let place = |index: usize| index % cells_x * cells_y + index / cells_x;
        (0..stored.len())
            .map(|index| stored[place(index)])
            .collect()
    } else {
        stored.collect()
    };
    Ok(Matrix {
        columns: cells_x,
        rows: cells_y,
        values,
    })
}

/// Header and data.
fn split(bytes: &[u8]) -> Option<(&str, &[u8])> {
    let width = if *bytes.get(MAGIC.len())? == 1 { 2 } else { 4 };
    let (length, rest) = bytes.get(MAGIC.len() + 2..)?.split_at_checked(width)?;
    let digits = length.iter().rev();
    let length = digits.fold(0, |above, byte| (above << 8) + usize::from(*byte));
    let (header, data) = rest.split_at_checked(length)?;
    Some((std::str::from_utf8(header).ok()?, data))
}

/// The text of one entry of the dictionary, up to the comma that ends it; commas in brackets are part of it.
fn entry<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let at = header.find(&format!("'{key}'"))?;
    let rest = header.get(at..)?.split_once(':')?.1.trim_start();
    let mut depth = 0_i32;
    for (index, character) in rest.char_indices() {
        match character {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            ',' | '}' if depth == 0 => return rest.get(..index).map(str::trim),
            _ => {}
        }
    }
    None
}

/// (rows, columns) of a Python tuple of two lengths.
fn two_lengths(shape: &str) -> Option<(usize, usize)> {
    let (rows, columns) = shape
        .strip_prefix('(')?
        .strip_suffix(')')?
        .split_once(',')?;
    let columns = columns.trim_end_matches([',', ' ']);
    Some((rows.trim().parse().ok()?, columns.trim().parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::super::field;
    use super::*;

    /// A file as numpy.save writes it: header padded with blanks to a multiple of 64 bytes and ended by a line end.
    fn file(version: u8, header: &str, data: &[u8]) -> Vec<u8> {
        let length_bytes = if version == 1 { 2 } else { 4 };
        let start = MAGIC.len() + 2 + length_bytes;
        let padded = (start + header.len() + 1).next_multiple_of(64) - start;
        let mut bytes = [MAGIC, &[version, 0]].concat();
        bytes.extend(&(padded as u32).to_le_bytes()[..length_bytes]);
        bytes.extend(format!("{header:<width$}\n", width = padded - 1).as_bytes());
        bytes.extend(data);
        bytes
    }

    fn header(descriptor: &str, order: &str, shape: &str) -> String {
        format!("{{'descr': {descriptor}, 'fortran_order': {order}, 'shape': {shape}, }}")
    }

    fn bytes_of(values: &[f64]) -> Vec<u8> {
        values.iter().flat_map(|v| v.to_le_bytes()).collect()
    }

    /// The message, of a file that is named.
    fn refused(bytes: &[u8]) -> String {
        let refused = field("map.npy", bytes).unwrap_err();
        assert!(refused.to_string().contains("--> map.npy"));
        refused.iter().next().unwrap().message().to_owned()
    }

    const VALUES: [f64; 6] = [1.0, 2.5, -3.0, 4.0, 0.1, 6e-9];

    #[test]
    fn every_version_order_and_width_gives_the_same_matrix() {
        let expected = Field {
            cells_x: 3,
            cells_y: 2,
            values_m: VALUES.to_vec(),
            spacing_m: None,
        };
        let plain = header("'<f8'", "False", "(2, 3)");
        for version in 1..=3 {
            let found = field("map.npy", &file(version, &plain, &bytes_of(&VALUES)));
            assert_eq!(found.unwrap(), expected);
        }
        let columns_first = [0, 3, 1, 4, 2, 5].map(|i| VALUES[i]);
        let fortran = file(
            1,
            &header("'<f8'", "True", "(2, 3)"),
            &bytes_of(&columns_first),
        );
        assert_eq!(field("map.npy", &fortran).unwrap(), expected);
        let big: Vec<u8> = VALUES.iter().flat_map(|v| v.to_be_bytes()).collect();
        let big = file(1, &header("'>f8'", "False", "(2, 3)"), &big);
        assert_eq!(field("map.npy", &big).unwrap(), expected);
        for (descriptor, data) in [
            ("'<f4'", VALUES.map(|v| (v as f32).to_le_bytes()).concat()),
            ("'>f4'", VALUES.map(|v| (v as f32).to_be_bytes()).concat()),
        ] {
            let single = file(1, &header(descriptor, "False", "(2, 3)"), &data);
            let found = field("map.npy", &single).unwrap();
            assert_eq!(found.values_m, VALUES.map(|v| f64::from(v as f32)));
        }
    }

    #[test]
    fn arrays_of_another_type_or_shape_are_refused() {
        let with = |descriptor, shape| file(1, &header(descriptor, "False", shape), &[0; 48]);
        assert_eq!(
            refused(&with("'<i4'", "(2, 3)")),
            "numbers of the type '<i4', where '<f8' or '<f4' is needed"
        );
        assert!(refused(&with("[('x', '<f8'), ('y', '<f8')]", "(2,)")).contains("('x', '<f8')"));
        for shape in ["(6,)", "()", "(1, 2, 3)", "(-2, 3)"] {
            assert_eq!(
                refused(&with("'<f8'", shape)),
                format!("an array of shape {shape}, where two dimensions are needed")
            );
        }
    }

    #[test]
    fn files_that_are_not_whole_are_refused() {
        let whole = file(1, &header("'<f8'", "False", "(2, 3)"), &bytes_of(&VALUES));
        assert_eq!(
            refused(&whole[..whole.len() - 1]),
            "47 bytes of numbers, where the shape needs 48"
        );
        for length in [6, 7, 9, 40] {
            assert!(refused(&whole[..length]).contains("ends within its header"));
        }
        let huge = header("'<f8'", "False", "(9999999999999, 9999999999999)");
        assert!(refused(&file(1, &huge, &[0; 48])).contains("48 bytes"));
        let none = file(1, &header("'<f8'", "False", "(0, 3)"), &[]);
        assert_eq!(refused(&none), "the file holds no numbers");
        assert!(refused(&file(1, "{'descr': '<f8', }", &[])).contains("no 'fortran_order'"));
    }

    #[test]
    fn a_hole_is_shown_by_row_and_column() {
        let mut values = VALUES;
        values[5] = f64::NAN;
        let holed = file(1, &header("'<f8'", "False", "(2, 3)"), &bytes_of(&values));
        assert_eq!(
            refused(&holed),
            "a hole: the entry in row 2, column 3 is NaN"
        );
    }
}
