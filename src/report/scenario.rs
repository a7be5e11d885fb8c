//! What a scenario leaves in its folder: tables, figures and the page; of what was computed, or read from its folder.

use super::ReportError;
use crate::report::caption::Setting;
use crate::report::figure::press::Press;
use crate::report::figure::units::Units;
use crate::report::figure::{self, Figure};
use crate::report::page::{self, Pictures};
use crate::report::scenario_tables::{self, History};
use crate::simulation::scenario::ScenarioPlan;
use crate::sweep::plan::figures::AxisUnits;
use crate::sweep::store::Store;
use crate::sweep::store::files::{PAGE, Place};

/// Writes everything, as far as the simulation came. Returns what was left out and why.
///
/// # Errors
/// [`ReportError`] naming the file that could not be made.
pub fn write(
    store: &Store,
    plan: &ScenarioPlan,
    history: &History,
) -> Result<Vec<String>, ReportError> {
    let History { outcome, profiles } = history;
    scenario_tables::write(store, plan, (outcome, profiles))?;
    let pictures = Pictures::default();
    let mut left_out = figures(store, plan, history, &pictures)?;
    if plan.figures.axes != AxisUnits::Si
        && let Ok(history) = figure::history::figure(outcome, &Units::default())
    {
        // The page shows SI units throughout, since its own script draws in them.
        match history.picture.draw() {
            Ok(drawing) => pictures.show_instead("history", &drawing),
            Err(error) => pictures.insert_failure("history", &error),
        }
    }
    left_out.extend(pictures.not_drawn());
    let page = page::simulation(plan, (outcome, profiles), &pictures, store.sweep_hash())?;
    store.write(Place::Top(PAGE), page.as_bytes())?;
    store.remove_stale()?;
    Ok(left_out)
}

/// As [`write`](fn@write), without figures and page; those of an earlier run, which may show less, are removed.
///
/// # Errors
/// As [`write`](fn@write).
pub fn write_tables(
    store: &Store,
    plan: &ScenarioPlan,
    History { outcome, profiles }: &History,
) -> Result<Vec<String>, ReportError> {
    scenario_tables::write(store, plan, (outcome, profiles))?;
    store.remove_stale()?;
    Ok(Vec::new())
}

/// The figures but for the maps of fields, and what was left out and why.
pub fn lines(
    plan: &ScenarioPlan,
    History { outcome, profiles }: &History,
    units: &Units,
) -> (Vec<Figure>, Vec<String>) {
    let (mut figures, mut left_out) = (Vec::new(), Vec::new());
    for drawn in [
        figure::history::figure(outcome, units),
        figure::history::load_approach(plan, outcome, units),
    ] {
        match drawn {
            Ok(figure) => figures.push(figure),
            Err(why) => left_out.push(why.to_owned()),
        }
    }
    figures.extend(figure::cycle_losses::figure(outcome, units));
    let (profiles, not_drawn) = figure::profiles::figure(profiles, units);
    figures.extend(profiles);
    left_out.extend(not_drawn);
    figures.extend(figure::distributions::figures(&outcome.fields, units));
    (figures, left_out)
}

fn figures(
    store: &Store,
    plan: &ScenarioPlan,
    history: &History,
    pictures: &Pictures,
) -> Result<Vec<String>, ReportError> {
    let (outcome, units) = (&history.outcome, Units::of_scenario(plan)?);
    let setting = Setting::of_scenario(plan, outcome, units.sentence());
    let press = Press {
        plan: &plan.figures,
        write: &|place, bytes| store.write(place, bytes),
        pictures,
    };
    let (figures, mut left_out) = lines(plan, history, &units);
    press.figures(&figures, &setting)?;
    match figure::pressure_map::figures(&outcome.fields, &units) {
        Ok(mut maps) => maps.try_for_each(|map| press.figures(&[map], &setting))?,
        Err(why) => left_out.push(why.to_owned()),
    }
    Ok(left_out)
}
