//! What a sweep leaves in its folder: tables, figures and the page.

use super::ReportError;
use super::caption::Setting;
use super::figure;
use super::figure::press::Press;
use super::figure::units::Units;
use super::page;
use super::page::Pictures;
use super::sweep_tables;
use crate::sweep::plan::SweepPlan;
use crate::sweep::plan::figures::AxisUnits;
use crate::sweep::search::run::Outcome;
use crate::sweep::store::Store;
use crate::sweep::store::files::{PAGE, Place};

/// Reads the cycles of the cases that figures and page show, where the outcome does not hold them already.
///
/// # Errors
/// [`ReportError`] where the folder cannot be read.
pub fn load_drawn_cycles(
    store: &Store,
    plan: &SweepPlan,
    outcome: &mut Outcome,
) -> Result<(), ReportError> {
    if plan.is_small() {
        return Ok(());
    }
    let mut shown = figure::of_sweep::drawn(plan, outcome)?;
    shown.extend(page::shown(plan, outcome)?);
    for record in &mut outcome.records {
        if shown.contains(&record.index) {
            store.records().load_cycle(record)?;
        }
    }
    Ok(())
}

/// Writes everything a sweep leaves behind: table, loops, pressures, work, summary, figures with their data. What an earlier run has
/// left beyond that is removed. Returns what was left out and why.
///
/// # Errors
/// [`ReportError`] naming the file that could not be made.
pub fn write_sweep(
    store: &Store,
    plan: &SweepPlan,
    outcome: &Outcome,
) -> Result<Vec<String>, ReportError> {
    // Files of single cases are many and small: while one thread waits for the disk, another draws.
    let (tables, left_out) = rayon::join(
        || tables(store, plan, outcome),
        || figures_of_sweep(store, plan, outcome),
    );
    tables?;
    let left_out = left_out?;
    store.remove_stale()?;
    Ok(left_out)
}

/// As [`write_sweep`], without figures and page; those of an earlier run, which may show less, are removed.
///
/// # Errors
/// As [`write_sweep`].
pub fn write_tables_of_sweep(
    store: &Store,
    plan: &SweepPlan,
    outcome: &Outcome,
) -> Result<Vec<String>, ReportError> {
    tables(store, plan, outcome)?;
    store.remove_stale()?;
    Ok(Vec::new())
}

/// Every table; of single cases, those that are drawn.
fn tables(store: &Store, plan: &SweepPlan, outcome: &Outcome) -> Result<(), ReportError> {
    let drawn = match plan.is_small() {
        true => None,
        false => Some(figure::of_sweep::drawn(plan, outcome)?),
    };
    sweep_tables::write(store, plan, outcome, drawn.as_ref())
}

fn figures_of_sweep(
    store: &Store,
    plan: &SweepPlan,
    outcome: &Outcome,
) -> Result<Vec<String>, ReportError> {
    let (figures, mut left_out) = figure::of_sweep::figures(plan, outcome)?;
    let units = Units::of_sweep(plan)?.sentence();
    let pictures = Pictures::of_sweep(store.sweep_hash());
    let press = Press {
        plan: &plan.figures,
        write: &|place, bytes| store.write(place, bytes),
        pictures: &pictures,
    };
    press.figures(&figures, &Setting::of_sweep(plan, outcome, units))?;
    if plan.figures.axes != AxisUnits::Si {
        picture_in_si(plan, outcome, &pictures)?;
    }
    left_out.extend(pictures.not_drawn());
    let page = page::sweep(plan, outcome, &pictures, store.sweep_hash())?;
    store.write(Place::Top(PAGE), page.as_bytes())?;
    Ok(left_out)
}

/// The page shows SI units throughout, since its own script draws in them: gives it its figures in these.
fn picture_in_si(
    plan: &SweepPlan,
    outcome: &Outcome,
    pictures: &Pictures,
) -> Result<(), ReportError> {
    let mut in_si = plan.clone();
    in_si.figures.axes = AxisUnits::Si;
    let (figures, _) = figure::of_sweep::figures(&in_si, outcome)?;
    for figure in figures.iter().filter(|f| page::FIGURES.contains(&&*f.name)) {
        match figure.picture.draw() {
            Ok(drawing) => pictures.show_instead(&figure.name, &drawing),
            Err(error) => pictures.insert_failure(&figure.name, &error),
        }
    }
    Ok(())
}
