//! Columns of two results in full, case beside case, to be drawn.

use super::result::Row;
use super::{ComparisonError, CurvePoint, Place, SweepTable};
use crate::report::quantities;

/// One column: the value of every case of either result, in the order of [`super::Comparison::curve`].
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    pub name: String,
    pub baseline: Vec<Option<f64>>,
    pub new: Vec<Option<f64>>,
    /// Sum of the two error bars, for columns that have them.
    pub error: Vec<Option<f64>>,
}

/// A case and its rows.
type Case<'a> = (Place, Option<&'a Row>, Option<&'a Row>);

/// These columns of both results.
///
/// # Errors
/// [`ComparisonError`] where a cell is no number.
pub fn columns<'a>(
    baseline: &SweepTable,
    new: &SweepTable,
    names: impl Iterator<Item = &'a str>,
) -> Result<Vec<Column>, ComparisonError> {
    let cases = cases(baseline, new);
    names
        .map(|name| column(&cases, baseline, new, name))
        .collect()
}

/// The curves of the energy loss.
pub(super) fn curve(
    baseline: &SweepTable,
    new: &SweepTable,
) -> Result<Vec<CurvePoint>, ComparisonError> {
    let cases = cases(baseline, new);
    let loss = column(&cases, baseline, new, "energy_loss_j")?;
    let values = loss.baseline.iter().zip(&loss.new).zip(&loss.error);
    let points = cases.iter().zip(values);
    Ok(points
        .map(|((place, _, _), ((a, b), error))| CurvePoint {
            place: *place,
            baseline_j: *a,
            new_j: *b,
            error_j: *error,
        })
        .collect())
}

/// Every case of either result, by drive and frequency.
fn cases<'a>(baseline: &'a SweepTable, new: &'a SweepTable) -> Vec<Case<'a>> {
    let old = baseline.rows.iter();
    let old = old.map(|row| (row.place, Some(row), new.row(row.place, baseline)));
    let added = new
        .rows
        .iter()
        .filter(|r| baseline.row(r.place, new).is_none());
    let mut cases: Vec<Case> = old
        .chain(added.map(|row| (row.place, None, Some(row))))
        .collect();
    let key = |place: &Place| {
        (
            place.varied,
            place.drive_mean,
            place.drive_amplitude,
            place.angular_frequency_rad_per_s,
        )
    };
    cases.sort_by(|(a, ..), (b, ..)| {
        key(a)
            .partial_cmp(&key(b))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    cases
}

fn column(
    cases: &[Case<'_>],
    baseline: &SweepTable,
    new: &SweepTable,
    name: &str,
) -> Result<Column, ComparisonError> {
    let bar = quantities::of_name(name).and_then(|column| column.error_name());
    let number = |table: &SweepTable, row: Option<&Row>, column: &str| match row {
        Some(row) => table.number(row, column),
        None => Ok(None),
    };
    let mut found = Column {
        name: name.to_owned(),
        baseline: Vec::with_capacity(cases.len()),
        new: Vec::with_capacity(cases.len()),
        error: Vec::with_capacity(cases.len()),
    };
    for (_, a, b) in cases {
        found.baseline.push(number(baseline, *a, name)?);
        found.new.push(number(new, *b, name)?);
        let errors = match &bar {
            Some(error) => number(baseline, *a, error)?.zip(number(new, *b, error)?),
            None => None,
        };
        found.error.push(errors.map(|(a, b)| a + b));
    }
    Ok(found)
}
