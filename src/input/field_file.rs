//! Data files of indenters: height maps (a matrix of numbers, columns x_m, y_m, z_m, or `.npy`) and profiles (columns r_m,
//! gap_m), as `DataFile` reads them; columns may have other units of length.
//!
//! The rows of a matrix follow one another in the direction of y, its columns in that of x.

pub(super) mod npy;
mod points;

use super::data_file::{Column, DataFile, Holes, MAX_BYTES, plain_matrix};
use super::diagnostic::{Diagnostic, Diagnostics};
use crate::quantity::Dimension;

/// Columns of a height map given point by point.
const MAP_COLUMNS: [Column; 3] = [
    Column::new(&["x"], Dimension::Length, "coordinates x"),
    Column::new(&["y"], Dimension::Length, "coordinates y"),
    Column::new(&["z"], Dimension::Length, "heights"),
];
/// Columns of a profile.
const PROFILE_COLUMNS: [Column; 2] = [
    Column::new(&["r"], Dimension::Length, "radii"),
    Column::new(&["gap"], Dimension::Length, "gaps"),
];

/// What to do about a cell without a number.
const HOLE: &str = "fill holes before (by interpolation, say): the contact may reach them";

/// The values of a height map as read.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Points along x, that is per row.
    pub cells_x: usize,
    /// Points along y, that is the number of rows.
    pub cells_y: usize,
    /// Row by row, in the order of ascending y.
    pub values_m: Vec<f64>,
    /// Spacing along x and y, where the file gives it.
    pub spacing_m: Option<(f64, f64)>,
}

/// A height map from the bytes of a file: `.npy` by its mark, otherwise text.
///
/// # Errors
/// Holes, bad numbers, ragged rows, points that form no grid, arrays of another type or shape.
pub fn field(name: &str, bytes: &[u8]) -> Result<Field, Diagnostics> {
    if bytes.starts_with(npy::MAGIC) {
        return npy::read(name, bytes).map_err(Diagnostics::from);
    }
    let matrix = |cells_x, values: Vec<f64>| Field {
        cells_x,
        cells_y: values.len() / cells_x,
        values_m: values,
        spacing_m: None,
    };
    if bytes.len() <= MAX_BYTES
        && let Some((cells_x, values)) = plain_matrix(bytes)
    {
        return Ok(matrix(cells_x, values));
    }
    let file = DataFile::from_bytes(name, bytes)?;
    if file.has_any(&MAP_COLUMNS) {
        let table = file.columns(&MAP_COLUMNS, Holes::Refused, HOLE)?;
        return points::field(&file, &table).map_err(Diagnostics::from);
    }
    let table = file.matrix(HOLE)?;
    Ok(matrix(table.width(), table.values))
}

/// A profile, as pairs of radius and gap (m), from the bytes of a file.
///
/// # Errors
/// Missing columns, bad numbers, radii that do not begin at 0 and increase.
pub fn profile(name: &str, bytes: &[u8]) -> Result<Vec<(f64, f64)>, Diagnostics> {
    let file = DataFile::from_bytes(name, bytes)?;
    let table = file.columns(&PROFILE_COLUMNS, Holes::Refused, HOLE)?;
    let (radii_m, gaps_m) = (table.column(0), table.column(1));
    match radii_m.as_slice() {
        [] => return Err(file.no_numbers("give one point per line").into()),
        [first, ..] if *first != 0.0 => {
            let message = format!("the profile begins at r = {first:e} m and not on the axis");
            let problem = Diagnostic::at(&table.cell(0, 0), message);
            return Err(problem.help("give the point at r = 0 too").into());
        }
        [_] => {
            let message = "a profile needs at least 2 points, and this one has 1";
            return Err(Diagnostic::at(&table.whole(), message)
                .help("give the points from the axis outwards, one per line")
                .into());
        }
        _ => {}
    }
    if let Some(row) = (1..radii_m.len()).find(|row| radii_m[*row] <= radii_m[row - 1]) {
        let message = format!(
            "the radius {:e} m does not exceed the one before, {:e} m",
            radii_m[row],
            radii_m[row - 1]
        );
        return Err(Diagnostic::at(&table.cell(row, 0), message)
            .help("sort the points by radius and keep one of each")
            .into());
    }
    Ok(radii_m.into_iter().zip(gaps_m).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Refused, here and with these words.
    #[track_caller]
    fn refused<T: std::fmt::Debug>(made: Result<T, Diagnostics>, expected: &[&str]) {
        let text = made.unwrap_err().to_string();
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in expected {
            assert!(words.contains(part), "{part:?} is missing in:\n{text}");
        }
    }

    #[test]
    fn a_matrix_is_read_whatever_separates_its_cells() {
        let expected = Field {
            cells_x: 3,
            cells_y: 2,
            values_m: vec![1.0, -2.0, 3e-9, 4.0, 5.5, 6.0],
            spacing_m: None,
        };
        for text in [
            "1,-2,3e-9\n4,5.5,6\n",
            "# height in m\n1; -2; 3e-9\r\n4; 5.5; 6",
            "1;-2;3e-9\n4;5,5;6",
            "1\t-2\t3e-9\n\n4\t5.5\t6\n",
            "1.000e0  -2 3e-9\n   4   5.5    6\n",
            "1,000  -2,0 3e-9\n   4   5,5    6\n",
            "\u{feff}1,-2,3e-9\n4,\"5.5\",6\n",
        ] {
            assert_eq!(field("map.csv", text.as_bytes()).unwrap(), expected);
        }
    }

    #[test]
    fn a_map_with_something_wrong_is_refused_by_line_and_column() {
        for (text, expected) in [
            (
                "1,2,3\n4,five,6\n",
                [
                    "map.csv:2:3",
                    "a cell of column 2 must be a number",
                    "not a number",
                ],
            ),
            (
                "1 2  3\n4   5 x\n",
                ["map.csv:2:7", "column 3", "not a number"],
            ),
            ("1,2,3\n4,,6\n", ["map.csv:2:3", "empty", "fill holes"]),
            (
                "1,2,NaN\n4,5,6\n",
                ["map.csv:1:5", "not a finite number", "fill holes"],
            ),
            (
                "1,2,3\n4,5,inf\n",
                ["map.csv:2:5", "not a finite number", "fill holes"],
            ),
            (
                "1,2,3\n4,5,6\n7,8\n",
                ["map.csv:3:1", "a row of 2 cells", "a table of 3 columns"],
            ),
            (
                "1;2,5\n3;4.5\n",
                ["map.csv:1:3", "a decimal comma", "a decimal point"],
            ),
            (
                "1;2,500\n3;4\n",
                [
                    "map.csv:1:3",
                    "may separate decimals or thousands",
                    "`2.500` or `2500`",
                ],
            ),
            (
                "",
                ["map.csv", "holds no numbers", "one line of numbers per row"],
            ),
            ("# nothing\n\n", ["map.csv", "holds no numbers", ""]),
            ("x_m,y_m,z_m\n", ["map.csv", "holds no numbers", ""]),
            (
                "x_m,z_m\n1,2\n",
                [
                    "map.csv:1:1",
                    "no column `y_m`",
                    "2 columns, separated by commas",
                ],
            ),
            (
                "x,y,z\n1,2,3\n",
                ["map.csv:1:1", "has no unit", "such as `x [mm]`"],
            ),
        ] {
            refused(field("map.csv", text.as_bytes()), &expected);
        }
        refused(
            field("map.csv", b"1,2\n3,\xb5\n"),
            &["map.csv:2:3", "not UTF-8", "as UTF-8"],
        );
    }

    #[test]
    fn a_profile_is_read_from_its_columns_in_any_order() {
        let expected = vec![(0.0, 0.0), (1e-6, 1e-9), (2e-6, 5e-9)];
        for text in [
            "gap_m, note, r_m\n0, tip, 0\n1e-9, -, 1e-6\n5e-9, -, 2e-6\n",
            "r_um;gap (nm)\n0;0\n1;1\n2;5\n",
        ] {
            let found = profile("tip.csv", text.as_bytes()).unwrap();
            for ((r_m, gap_m), (expected_r_m, expected_gap_m)) in found.iter().zip(&expected) {
                // One product.
                assert!((r_m - expected_r_m).abs() <= 1e-15 * expected_r_m);
                assert!((gap_m - expected_gap_m).abs() <= 1e-15 * expected_gap_m);
            }
            assert_eq!(found.len(), 3);
        }
    }

    #[test]
    fn profiles_with_something_wrong_are_refused_by_line_and_column() {
        for (text, expected) in [
            (
                "0,0\n1,1\n",
                ["tip.csv:1:1", "no column `r_m`", "line of column names"],
            ),
            (
                "r_m,gap_m\n0,0\n2e-6,1e-9\n1e-6,2e-9\n",
                [
                    "tip.csv:4:1",
                    "the radius 1e-6 m does not exceed the one before, 2e-6 m",
                    "sort",
                ],
            ),
            (
                "r_m,gap_m\n1e-6,0\n2e-6,1e-9\n",
                [
                    "tip.csv:2:1",
                    "the profile begins at r = 1e-6 m and not on the axis",
                    "r = 0",
                ],
            ),
            (
                "r_m,gap_m\n0,0\n1e-6,\n",
                ["tip.csv:3:6", "empty", "fill holes"],
            ),
            (
                "r_m,gap_m\n0,0\n",
                ["tip.csv", "at least 2 points, and this one has 1", ""],
            ),
            ("r_m,gap_m\n", ["tip.csv", "holds no numbers", ""]),
        ] {
            refused(profile("tip.csv", text.as_bytes()), &expected);
        }
    }
}
