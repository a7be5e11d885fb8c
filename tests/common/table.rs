//! Tables as files of results have them.

#![allow(dead_code)] // Each test file uses its own part.

/// A table as files of results have it.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    pub columns: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub fn of(text: &str) -> Self {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let cells = |row: &csv::StringRecord| row.iter().map(str::to_owned).collect();
        Self {
            columns: cells(reader.headers().unwrap()),
            rows: reader.records().map(|row| cells(&row.unwrap())).collect(),
        }
    }

    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// The texts of a column.
    #[track_caller]
    pub fn cells(&self, column: &str) -> Vec<&str> {
        let place = self.columns.iter().position(|name| name == column);
        let place = place.unwrap_or_else(|| panic!("no {column} in {:?}", self.columns));
        self.rows.iter().map(|row| row[place].as_str()).collect()
    }

    /// The numbers of a column that has one in each row.
    #[track_caller]
    pub fn numbers(&self, column: &str) -> Vec<f64> {
        let cells = self.cells(column).into_iter();
        cells.map(|cell| cell.parse().unwrap()).collect()
    }

    /// The numbers of a column, in an empty cell none.
    #[track_caller]
    pub fn found(&self, column: &str) -> Vec<Option<f64>> {
        let cells = self.cells(column).into_iter();
        cells.map(|cell| cell.parse().ok()).collect()
    }

    /// The numbers of a row in these columns.
    #[track_caller]
    pub fn row<const N: usize>(&self, row: usize, columns: [&str; N]) -> [f64; N] {
        columns.map(|column| self.number(row, column))
    }

    #[track_caller]
    pub fn number(&self, row: usize, column: &str) -> f64 {
        self.cells(column)[row].parse().unwrap()
    }
}
