//! Data files of indenters: height maps (a matrix of numbers, columns x_m, y_m, z_m, or `.npy`) and profiles (columns r_m,
//! gap_m), with errors that name file, line and column.
//!
//! Text may be separated by commas, semicolons, tabs or blanks; lines that begin with `#` are passed over. Lengths are in metres.
//! The rows of a matrix follow one another in the direction of y, its columns in that of x.

mod npy;
mod points;

use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Largest data file read, bytes: a map of 4096 x 4096 points with 30 characters each.
pub const MAX_BYTES: u64 = 512_000_000;

/// Columns of a height map given point by point.
const MAP_COLUMNS: [&str; 3] = ["x_m", "y_m", "z_m"];
/// Columns of a profile.
const PROFILE_COLUMNS: [&str; 2] = ["r_m", "gap_m"];

/// Where in a data file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line of text, counted from 1.
    Line(u64),
    /// A cell in a line of text, both counted from 1.
    Cell { line: u64, column: usize },
    /// An entry of an array, both counted from 1.
    Entry { row: usize, column: usize },
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line(line) => write!(formatter, ", line {line}"),
            Self::Cell { line, column } => write!(formatter, ", line {line}, column {column}"),
            Self::Entry { row, column } => write!(formatter, ", row {row}, column {column}"),
        }
    }
}

/// What is wrong with a data file, and where.
#[derive(Debug, thiserror::Error)]
#[error("`{file}`{place}: {problem}")]
pub struct FieldFileError {
    /// The file as the user knows it.
    pub file: String,
    pub place: Place,
    pub problem: FieldProblem,
}

/// What may be wrong with a data file.
#[derive(Debug, thiserror::Error)]
pub enum FieldProblem {
    #[error("cannot be read: {0}")]
    Read(io::Error),
    #[error("is larger than {} MB", MAX_BYTES / 1_000_000)]
    TooLarge,
    #[error("is not UTF-8 text")]
    NotUtf8,
    #[error("holds no numbers")]
    Empty,
    #[error("there is no column `{column}` among {}", quoted(found))]
    MissingColumn {
        column: &'static str,
        found: Vec<String>,
    },
    #[error("`{text}` is not a number")]
    BadNumber { text: String },
    #[error("a hole: {0}")]
    Hole(String),
    #[error("{found} cells, where line {first_line} has {expected}")]
    Ragged {
        found: usize,
        expected: usize,
        first_line: u64,
    },
    #[error(
        "the points do not form a grid: {points} points have {columns} different x and {rows} different y"
    )]
    NotAGrid {
        points: usize,
        columns: usize,
        rows: usize,
    },
    #[error(
        "the points are not evenly spaced along {axis}: {at_m:e} m is off the grid by {share:.0} % of the spacing"
    )]
    Uneven {
        axis: &'static str,
        at_m: f64,
        share: f64,
    },
    #[error("the same point as on line {first_line}")]
    SamePoint { first_line: u64 },
    #[error("the radius {radius_m:e} m does not exceed the one before, {previous_m:e} m")]
    RadiusNotIncreasing { radius_m: f64, previous_m: f64 },
    #[error("the profile begins at r = {radius_m:e} m and not on the axis")]
    StartsOffAxis { radius_m: f64 },
    #[error("a profile needs at least 2 points, and this one has 1")]
    OnePoint,
    #[error("is no .npy file that can be read: {0}")]
    NpyHeader(&'static str),
    #[error("holds numbers of the type {found}, where '<f8' or '<f4' is needed")]
    NpyType { found: String },
    #[error("holds an array of shape {shape}, where two dimensions are needed")]
    NpyShape { shape: String },
    #[error("holds {found} bytes of numbers, where its shape needs {expected}")]
    NpyLength { found: usize, expected: usize },
}

fn quoted(names: &[String]) -> String {
    let shown: Vec<String> = names.iter().take(8).map(|n| format!("`{n}`")).collect();
    let more = if names.len() > 8 { ", ..." } else { "" };
    format!("{}{more}", shown.join(", "))
}

impl FieldFileError {
    fn new(file: &str, place: Place, problem: FieldProblem) -> Self {
        Self {
            file: file.to_owned(),
            place,
            problem,
        }
    }

    /// What to do about it.
    pub fn help(&self) -> &'static str {
        match &self.problem {
            FieldProblem::Read(_) => "check the path",
            FieldProblem::TooLarge => "save the map as .npy, or with fewer points",
            FieldProblem::NotUtf8 => "save it as UTF-8 text; a NumPy file begins with its own mark",
            FieldProblem::Empty => "give one line of numbers per row of the map, or per point",
            FieldProblem::MissingColumn { .. } => {
                "the first line names the columns: r_m,gap_m for a profile, x_m,y_m,z_m for the points of a map"
            }
            FieldProblem::BadNumber { .. } => {
                "write numbers with a decimal point, in metres; a matrix has no header, columns are named x_m,y_m,z_m"
            }
            FieldProblem::Hole(_) => {
                "fill holes before (by interpolation, say): the contact may reach them"
            }
            FieldProblem::Ragged { .. } => "give every line as many cells",
            FieldProblem::NotAGrid { .. } | FieldProblem::Uneven { .. } => {
                "interpolate the points onto a regular grid before"
            }
            FieldProblem::SamePoint { .. } => "give every point once",
            FieldProblem::RadiusNotIncreasing { .. } => {
                "sort the points by radius and keep one of each"
            }
            FieldProblem::StartsOffAxis { .. } => "give the point at r = 0 too",
            FieldProblem::OnePoint => "give the points from the axis outwards, one per line",
            FieldProblem::NpyHeader(_) => "write it with numpy.save(\"map.npy\", heights_m)",
            FieldProblem::NpyType { .. } => {
                "write it with numpy.save(\"map.npy\", heights_m.astype(\"<f8\"))"
            }
            FieldProblem::NpyShape { .. } => "save a matrix, one row per y and one column per x",
            FieldProblem::NpyLength { .. } => "the file is not whole: write it again",
        }
    }
}

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

/// The bytes of a data file; `name` is what messages call it.
///
/// # Errors
/// [`FieldFileError`] where it cannot be read or has more than [`MAX_BYTES`].
pub fn read_bytes(path: &Path, name: &str) -> Result<Vec<u8>, FieldFileError> {
    let read = || {
        let mut bytes = Vec::new();
        File::open(path)?
            .take(MAX_BYTES + 1)
            .read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let bytes =
        read().map_err(|e| FieldFileError::new(name, Place::File, FieldProblem::Read(e)))?;
    if bytes.len() as u64 > MAX_BYTES {
        let problem = FieldProblem::TooLarge;
        return Err(FieldFileError::new(name, Place::File, problem));
    }
    Ok(bytes)
}

/// A height map from the bytes of a file: `.npy` by its mark, otherwise text.
///
/// # Errors
/// [`FieldFileError`]: holes, bad numbers, ragged rows, points that form no grid, arrays of another type or shape.
pub fn field(name: &str, bytes: &[u8]) -> Result<Field, FieldFileError> {
    if bytes.starts_with(npy::MAGIC) {
        return npy::read(bytes)
            .map_err(|(place, problem)| FieldFileError::new(name, place, problem));
    }
    let table = table(name, bytes, &MAP_COLUMNS, false)?;
    if table.named {
        return points::field(&table.values, &table.lines)
            .map_err(|(place, problem)| FieldFileError::new(name, place, problem));
    }
    Ok(Field {
        cells_x: table.columns,
        cells_y: table.lines.len(),
        values_m: table.values,
        spacing_m: None,
    })
}

/// A profile, as pairs of radius and gap (m), from the bytes of a file.
///
/// # Errors
/// [`FieldFileError`]: missing columns, bad numbers, radii that do not begin at 0 and increase.
pub fn profile(name: &str, bytes: &[u8]) -> Result<Vec<(f64, f64)>, FieldFileError> {
    let table = table(name, bytes, &PROFILE_COLUMNS, true)?;
    let mut points: Vec<(f64, f64)> = Vec::with_capacity(table.lines.len());
    for (pair, &line) in table.values.chunks_exact(2).zip(&table.lines) {
        let radius_m = pair[0];
        let problem = match points.last() {
            None if radius_m != 0.0 => FieldProblem::StartsOffAxis { radius_m },
            Some(&(previous_m, _)) if radius_m <= previous_m => FieldProblem::RadiusNotIncreasing {
                radius_m,
                previous_m,
            },
            _ => {
                points.push((radius_m, pair[1]));
                continue;
            }
        };
        return Err(FieldFileError::new(name, Place::Line(line), problem));
    }
    if points.len() < 2 {
        let problem = FieldProblem::OnePoint;
        return Err(FieldFileError::new(name, Place::File, problem));
    }
    Ok(points)
}

/// Numbers of a text, row by row.
struct Table {
    /// Whether the first line named the columns; the values are then those columns in the order asked for.
    named: bool,
    columns: usize,
    values: Vec<f64>,
    /// The line of every row.
    lines: Vec<u64>,
}

/// Reads a text as the columns asked for, or, where `must_be_named` is not set and none of them is named, as a matrix.
fn table(
    name: &str,
    bytes: &[u8],
    wanted: &[&'static str],
    must_be_named: bool,
) -> Result<Table, FieldFileError> {
    let fail = |place, problem| FieldFileError::new(name, place, problem);
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let before = bytes.get(..error.valid_up_to()).unwrap_or_default();
        let line = before.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
        fail(Place::Line(line), FieldProblem::NotUtf8)
    })?;
    let lines = text.lines().zip(1_u64..);
    let mut rows =
        lines.filter(|(text, _)| !text.trim().is_empty() && !text.trim_start().starts_with('#'));
    let Some((first, first_line)) = rows.next() else {
        return Err(fail(Place::File, FieldProblem::Empty));
    };
    let separator = separator(first);
    let header: Vec<&str> = cells(first, separator).collect();
    let mut table = Table {
        named: must_be_named || header.iter().any(|cell| wanted.contains(cell)),
        columns: header.len(),
        values: Vec::new(),
        lines: Vec::new(),
    };
    let picked = match table.named {
        true => pick(&header, wanted).map_err(|p| fail(Place::Line(first_line), p))?,
        false => (0..header.len()).collect(),
    };
    if !table.named {
        append(&header, first_line, &picked, &mut table).map_err(|(at, p)| fail(at, p))?;
    }
    let mut row: Vec<&str> = Vec::new();
    for (text, line) in rows {
        row.clear();
        row.extend(cells(text, separator));
        if row.len() != table.columns {
            let problem = FieldProblem::Ragged {
                found: row.len(),
                expected: table.columns,
                first_line,
            };
            return Err(fail(Place::Line(line), problem));
        }
        append(&row, line, &picked, &mut table).map_err(|(at, p)| fail(at, p))?;
    }
    if table.lines.is_empty() {
        return Err(fail(Place::File, FieldProblem::Empty));
    }
    Ok(table)
}

/// The cells of a line, without blanks and quotation marks around them. Blanks may align columns, where they separate.
fn cells(line: &str, separator: char) -> impl Iterator<Item = &str> {
    let blank = separator == ' ';
    line.split(separator)
        .map(str::trim)
        .filter(move |cell| !(blank && cell.is_empty()))
        .map(|cell| {
            let inside = cell.strip_prefix('"').and_then(|c| c.strip_suffix('"'));
            inside.unwrap_or(cell).trim()
        })
}

/// What separates the cells of this line.
fn separator(line: &str) -> char {
    let candidates = [';', '\t', ','];
    let found = candidates.into_iter().find(|&c| line.trim().contains(c));
    found.unwrap_or(' ')
}

/// Positions of the columns asked for.
fn pick(header: &[&str], wanted: &[&'static str]) -> Result<Vec<usize>, FieldProblem> {
    let position = |&column: &&'static str| {
        let found = header.iter().position(|cell| *cell == column);
        found.ok_or_else(|| FieldProblem::MissingColumn {
            column,
            found: header.iter().map(|&cell| cell.to_owned()).collect(),
        })
    };
    wanted.iter().map(position).collect()
}

/// Appends the numbers of the cells picked from a line.
fn append(
    row: &[&str],
    line: u64,
    picked: &[usize],
    table: &mut Table,
) -> Result<(), (Place, FieldProblem)> {
    for &index in picked {
        let column = index + 1;
        let text = row.get(index).copied().unwrap_or_default();
        let value = number(text).map_err(|problem| (Place::Cell { line, column }, problem))?;
        table.values.push(value);
    }
    table.lines.push(line);
    Ok(())
}

/// A finite number.
fn number(text: &str) -> Result<f64, FieldProblem> {
    if text.is_empty() {
        return Err(FieldProblem::Hole("the cell is empty".to_owned()));
    }
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(FieldProblem::Hole(format!("the cell holds {text}"))),
        Err(_) => {
            let mut shown: String = text.chars().take(32).collect();
            if shown.len() < text.len() {
                shown.push('…');
            }
            Err(FieldProblem::BadNumber { text: shown })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        field("map.csv", text.as_bytes()).unwrap_err().to_string()
    }

    fn refused_profile(text: &str) -> String {
        profile("tip.csv", text.as_bytes()).unwrap_err().to_string()
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
            "1\t-2\t3e-9\n\n4\t5.5\t6\n",
            "1.000e0  -2 3e-9\n   4   5.5    6\n",
            "\u{feff}1,-2,3e-9\n4,\"5.5\",6\n",
        ] {
            assert_eq!(field("map.csv", text.as_bytes()).unwrap(), expected);
        }
    }

    #[test]
    fn cells_that_are_no_numbers_are_shown_by_line_and_column() {
        assert_eq!(
            refused("1,2,3\n4,five,6\n"),
            "`map.csv`, line 2, column 2: `five` is not a number"
        );
        assert_eq!(
            refused("# a\n\n1;2,5\n3;4\n"),
            "`map.csv`, line 3, column 2: `2,5` is not a number"
        );
        assert_eq!(
            refused("1 2  3\n4   5 x\n"),
            "`map.csv`, line 2, column 3: `x` is not a number"
        );
    }

    #[test]
    fn holes_are_shown_by_line_and_column() {
        assert_eq!(
            refused("1,2,3\n4,,6\n"),
            "`map.csv`, line 2, column 2: a hole: the cell is empty"
        );
        assert_eq!(
            refused("1,2,NaN\n4,5,6\n"),
            "`map.csv`, line 1, column 3: a hole: the cell holds NaN"
        );
        assert_eq!(
            refused("1,2,3\n4,5,inf\n"),
            "`map.csv`, line 2, column 3: a hole: the cell holds inf"
        );
    }

    #[test]
    fn ragged_rows_and_empty_files_are_refused() {
        assert_eq!(
            refused("1,2,3\n4,5,6\n7,8\n"),
            "`map.csv`, line 3: 2 cells, where line 1 has 3"
        );
        assert_eq!(refused(""), "`map.csv`: holds no numbers");
        assert_eq!(refused("# nothing\n\n"), "`map.csv`: holds no numbers");
        assert_eq!(refused("x_m,y_m,z_m\n"), "`map.csv`: holds no numbers");
    }

    #[test]
    fn text_that_is_not_utf_8_is_shown_by_its_line() {
        let error = field("map.csv", b"1,2\n3,\xb5\n").unwrap_err();
        assert_eq!(error.to_string(), "`map.csv`, line 2: is not UTF-8 text");
        assert!(error.help().contains("UTF-8"));
    }

    #[test]
    fn a_file_that_cannot_be_opened_says_so() {
        let error = read_bytes(Path::new("no/such/map.csv"), "map.csv").unwrap_err();
        let text = error.to_string();
        assert!(text.starts_with("`map.csv`: cannot be read: "), "{text}");
        assert!(error.help().contains("check the path"));
    }

    #[test]
    fn a_map_may_lack_no_column() {
        assert_eq!(
            refused("x_m,z_m\n1,2\n"),
            "`map.csv`, line 1: there is no column `y_m` among `x_m`, `z_m`"
        );
    }

    #[test]
    fn a_profile_is_read_from_its_columns_in_any_order() {
        let text = "gap_m, note, r_m\n0, tip, 0\n1e-9, -, 1e-6\n5e-9, -, 2e-6\n";
        let expected = vec![(0.0, 0.0), (1e-6, 1e-9), (2e-6, 5e-9)];
        assert_eq!(profile("tip.csv", text.as_bytes()).unwrap(), expected);
    }

    #[test]
    fn profiles_with_something_wrong_are_refused_by_line_and_column() {
        assert_eq!(
            refused_profile("0,0\n1,1\n"),
            "`tip.csv`, line 1: there is no column `r_m` among `0`, `0`"
        );
        assert_eq!(
            refused_profile("r_m,gap_m\n0,0\n2e-6,1e-9\n1e-6,2e-9\n"),
            "`tip.csv`, line 4: the radius 1e-6 m does not exceed the one before, 2e-6 m"
        );
        assert_eq!(
            refused_profile("r_m,gap_m\n1e-6,0\n2e-6,1e-9\n"),
            "`tip.csv`, line 2: the profile begins at r = 1e-6 m and not on the axis"
        );
        assert_eq!(
            refused_profile("r_m,gap_m\n0,0\n1e-6,\n"),
            "`tip.csv`, line 3, column 2: a hole: the cell is empty"
        );
        assert_eq!(
            refused_profile("r_m,gap_m\n0,0\n"),
            "`tip.csv`: a profile needs at least 2 points, and this one has 1"
        );
        assert_eq!(
            refused_profile("r_m,gap_m\n"),
            "`tip.csv`: holds no numbers"
        );
    }
}
