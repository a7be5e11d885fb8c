//! Two results case beside case, and their columns held against each other.

use std::cmp::Ordering;

use super::result::Row;
use super::{ColumnComparison, ComparisonError, CurvePoint, Place, SweepTable, Tolerances};
use crate::quantity::FrequencyUnit;
use crate::report::quantities::{self, Compared};

/// Baseline and new result.
pub(super) struct Beside<'a> {
    tables: [&'a SweepTable; 2],
    /// Every case of either with its rows, by drive and frequency.
    pub(super) cases: Vec<(Place, [Option<&'a Row>; 2])>,
    /// Whether one of the two was measured.
    pub(super) measured: bool,
}

impl<'a> Beside<'a> {
    pub(super) fn new(baseline: &'a SweepTable, new: &'a SweepTable) -> Self {
        let old = baseline.rows.iter();
        let old = old.map(|row| (row.place, [Some(row), new.row(row.place, baseline)]));
        let added = new.rows.iter();
        let added = added.filter(|row| baseline.row(row.place, new).is_none());
        let added = added.map(|row| (row.place, [None, Some(row)]));
        let mut cases: Vec<_> = old.chain(added).collect();
        cases.sort_by(|(a, _), (b, _)| a.partial_cmp(b).unwrap_or(Ordering::Equal));
        Self {
            tables: [baseline, new],
            cases,
            measured: baseline.measured || new.measured,
        }
    }

    /// The cases that one of the two lacks.
    pub(super) fn without(&self, table: usize) -> Vec<Place> {
        let cases = self.cases.iter();
        let lacking = cases.filter(|(_, rows)| rows[table].is_none());
        lacking.map(|(place, _)| *place).collect()
    }

    /// Physical quantities; not how they came about, nor their error bars, nor differences of nearly equal numbers, nor what
    /// neither result has.
    pub(super) fn compared_columns(
        &self,
        tolerances: &Tolerances,
    ) -> Result<Vec<String>, ComparisonError> {
        let mut names: Vec<String> = Vec::new();
        for column in self.tables.iter().flat_map(|table| &table.columns) {
            let known = quantities::of_name(column);
            let is_compared = known.is_some_and(|column| column.compared.is_some());
            let has_numbers = || self.tables.iter().any(|table| table.has_numbers(column));
            if is_compared && !names.contains(column) && has_numbers() {
                names.push(column.clone());
            }
        }
        for (column, _) in &tolerances.columns {
            if !self.tables.iter().any(|table| table.has(column)) {
                return Err(ComparisonError::NoColumn {
                    column: column.clone(),
                });
            }
            let is_frequency =
                (FrequencyUnit::NAMES.iter()).any(|(_, unit)| unit.column() == column);
            if !names.contains(column) && !is_frequency {
                names.push(column.clone());
            }
        }
        Ok(names)
    }

    /// The numbers of a case under a column.
    fn numbers(
        &self,
        rows: &[Option<&Row>; 2],
        column: &str,
    ) -> Result<[Option<f64>; 2], ComparisonError> {
        let number = |k: usize| match rows[k] {
            Some(row) => self.tables[k].number(row, column),
            None => Ok(None),
        };
        Ok([number(0)?, number(1)?])
    }

    /// One column of both, and how far it differs.
    pub(super) fn column(
        &self,
        name: String,
        tolerances: &Tolerances,
    ) -> Result<ColumnComparison, ComparisonError> {
        let own = tolerances.own(&name);
        let relative = own.unwrap_or(tolerances.relative);
        let known = quantities::of_name(&name);
        let is_absolute = known.is_some_and(|c| c.compared == Some(Compared::Absolutely));
        let bar = known.and_then(|column| column.error_name());
        let mut found = ColumnComparison {
            name,
            is_absolute,
            has_own_tolerance: own.is_some(),
            ..ColumnComparison::default()
        };
        for (place, rows) in &self.cases {
            let [a, b] = self.numbers(rows, &found.name)?;
            let [error_a, error_b] = match &bar {
                Some(bar) => self.numbers(rows, bar)?,
                None => [None; 2],
            };
            let error = error_a.zip(error_b).map(|(a, b)| a + b);
            found.baseline.push(a);
            found.new.push(b);
            found.error.push(error);
            let [Some(old), Some(new)] = rows else {
                continue;
            };
            let (Some(a), Some(b)) = (a, b) else {
                // A measurement does not know everything.
                if a.is_some() != b.is_some() && !self.measured {
                    found.absent += 1;
                    found.different += 1;
                }
                continue;
            };
            let scale = if is_absolute {
                1.0
            } else {
                a.abs().max(b.abs())
            };
            let difference = (a - b).abs();
            let share = difference / scale;
            if difference > 0.0 && found.largest.is_none_or(|(largest, _)| share > largest) {
                found.largest = Some((share, *place));
            }
            let same_discretisation = !self.measured && self.has_same_discretisation(old, new);
            // Without an error bar nothing says how far two discretisations may be apart.
            let is_comparable = same_discretisation || bar.is_some() || own.is_some();
            if difference > tolerances.absolute + relative * scale {
                let within = error.is_some_and(|error| difference <= error);
                found.beyond += 1;
                found.within_bars += usize::from(within);
                found.not_judged += usize::from(!is_comparable);
                let is_different = is_comparable && (!within || same_discretisation);
                found.different += usize::from(is_different);
            }
        }
        Ok(found)
    }

    /// Whether steps and nodes are the same, as written.
    fn has_same_discretisation(&self, old: &Row, new: &Row) -> bool {
        let [baseline, of_new] = self.tables;
        let is_same = |column: &&str| baseline.text(old, column) == of_new.text(new, column);
        ["steps", "nodes"].iter().all(is_same)
    }

    /// The curves of the energy loss.
    pub(super) fn curve(&self) -> Result<Vec<CurvePoint>, ComparisonError> {
        let loss = self.column("energy_loss_j".to_owned(), &Tolerances::default())?;
        let point = |(k, (place, _)): (usize, &(Place, _))| CurvePoint {
            place: *place,
            baseline_j: loss.baseline[k],
            new_j: loss.new[k],
            error_j: loss.error[k],
        };
        Ok(self.cases.iter().enumerate().map(point).collect())
    }
}
