//! What of a large sweep its page shows, so that the page stays small whatever the sweep: all curves or some of them, evenly spread,
//! all their cases or some, with the columns it draws in as many digits as can be read; and the cycles of a few cases of each.

use std::borrow::Cow;
use std::collections::BTreeSet;

use super::compact::digits;
use crate::report::ReportError;
use crate::report::figure::curve::{Curve, curves, evenly, largest, with_the_largest};
use crate::report::figure::of_sweep::cycles_of;
use crate::report::figure::units::Units;
use crate::report::quantities;
use crate::report::table::{Cell, csv};
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::CaseRecord;
use crate::sweep::search::peak::Peak;
use crate::sweep::search::run::Outcome;

/// Bytes of the table of cases, half as many again at most, and curves with cycles on the page.
const TABLE_BYTES: usize = 1_200_000;
const CURVES_WITH_CYCLES: usize = 12;
/// Digits of a value, and of an error or what else is only looked at.
const DIGITS: usize = 6;
const FEW_DIGITS: usize = 2;

/// The cases whose cycles the page of a large sweep shows.
///
/// # Errors
/// [`ReportError::Scale`] where figures are normalised by what does not exist.
pub fn shown(plan: &SweepPlan, outcome: &Outcome) -> Result<BTreeSet<usize>, ReportError> {
    let all = curves(plan, outcome, &Units::of_sweep(plan)?);
    Ok(shown_of(plan, &all))
}

fn shown_of(plan: &SweepPlan, all: &[Curve<'_>]) -> BTreeSet<usize> {
    let some = evenly(all.len(), CURVES_WITH_CYCLES).into_iter();
    let some = some.filter_map(|k| all.get(k)).chain(largest(all));
    let asked = &plan.figures.loops_rad_per_s;
    some.flat_map(|curve| cycles_of(curve, asked)).collect()
}

/// The outcome as the page shows it, and its table.
///
/// # Errors
/// As [`shown`].
pub(super) fn of_page<'a>(
    plan: &SweepPlan,
    outcome: &'a Outcome,
) -> Result<(Cow<'a, Outcome>, Vec<u8>), ReportError> {
    let (branches, unit) = (outcome.branches(), plan.figures.frequency_unit);
    if plan.is_small() {
        let table = quantities::sweep(
            &outcome.records,
            (branches, plan.is_attracted()),
            unit,
            plan.axes.as_ref(),
        );
        return Ok((Cow::Borrowed(outcome), table));
    }
    let all = curves(plan, outcome, &Units::of_sweep(plan)?);
    // Some cases that stand for all.
    let first = all.first().map_or(&[][..], |curve| &curve.records);
    let sample = &first[..first.len().min(50)];
    let per_row = small_table(plan, branches, sample).len() / sample.len().max(1);
    let rows = TABLE_BYTES / per_row.max(1);
    let per_curve = outcome.records.len().div_ceil(all.len().max(1));
    let most = (rows / per_curve.max(1)).max(2);
    let mut chosen: BTreeSet<usize> = evenly(all.len(), most).into_iter().collect();
    let with_cycles = shown_of(plan, &all);
    for (k, curve) in all.iter().enumerate() {
        if curve.records.iter().any(|r| with_cycles.contains(&r.index)) {
            chosen.insert(k);
        }
    }
    // Those with cycles may be more curves than the table has room for.
    let most = 3 * rows / (2 * chosen.len().max(1));
    let chosen: Vec<&Curve> = chosen.into_iter().filter_map(|k| all.get(k)).collect();
    let records = chosen.iter();
    let records = records.flat_map(|curve| of_curve(curve, most, &with_cycles));
    let records: Vec<&CaseRecord> = records.collect();
    let table = small_table(plan, branches, &records);
    let is_shown = |peak: &&Peak| chosen.iter().any(|curve| peak.is_of(&curve.condition));
    let thinned = Outcome {
        records: records.into_iter().cloned().collect(),
        peaks: outcome.peaks.iter().filter(is_shown).copied().collect(),
        peak_problems: outcome.peak_problems.clone(),
        interrupted: outcome.interrupted,
        missing: outcome.missing,
    };
    Ok((Cow::Owned(thinned), table))
}

/// So many cases of a curve or all, evenly spread, those of the largest loss and with cycles among them.
fn of_curve<'a>(
    curve: &Curve<'a>,
    most: usize,
    with_cycles: &BTreeSet<usize>,
) -> Vec<&'a CaseRecord> {
    let loss = |record: &CaseRecord| record.energy_loss_j().unwrap_or(f64::NEG_INFINITY);
    let losses: Vec<f64> = curve.records.iter().map(|record| loss(record)).collect();
    let kept: BTreeSet<usize> = with_the_largest(&losses, most).into_iter().collect();
    let records = curve.records.iter().enumerate();
    let kept =
        records.filter(|(k, record)| kept.contains(k) || with_cycles.contains(&record.index));
    kept.map(|(_, record)| *record).collect()
}

/// The table in few digits.
fn small_table(plan: &SweepPlan, branches: usize, records: &[&CaseRecord]) -> Vec<u8> {
    let unit = plan.figures.frequency_unit;
    let columns = quantities::of_cases((branches, plan.is_attracted()), unit, plan.axes.as_ref());
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    let rows = records.iter().map(|record| {
        let cells = columns.iter().map(|column| match (column.cell)(record) {
            Cell::Number(number) if is_looked_at(&column.name) => digits(number, FEW_DIGITS).into(),
            Cell::Number(number) => digits(number, DIGITS).into(),
            other => other,
        });
        cells.collect::<Vec<Cell>>()
    });
    csv(&names, rows)
}

/// Whether nobody computes with a column.
fn is_looked_at(name: &str) -> bool {
    name.contains("_error") || ["energy_imbalance", "steady_distance"].contains(&name)
}
