//! The peak of each curve over the second axis of a sweep: its loss above, its frequency below. A curve that is highest at an end
//! of the sweep has none.

use super::curve::SweepCurves;
use super::moduli_error::WIDE;
use super::{Drawn, Figure, Picture, axis};
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Marker, Series};
use crate::report::number::{largest, range};
use crate::report::table::cells;
use crate::sweep::plan::Axes;
use crate::sweep::search::peak::Peak;
use crate::sweep::search::run::Outcome;

/// Losses that vary by more than this are drawn on a logarithmic axis.
const WIDE_LOSSES: f64 = 20.0;

/// The figure.
pub fn figure(sweep: &SweepCurves<'_>, over: &Axes) -> Drawn {
    let (outcome, units) = (sweep.outcome, &sweep.units);
    let highest = over
        .conditions
        .iter()
        .filter_map(|condition| Some((condition.number()?, outcome.highest_peak(condition))));
    let highest: Vec<(f64, Option<&Peak>)> = highest.collect();
    let found = || highest.iter().filter_map(|(_, peak)| *peak);
    if found().count() < 2 {
        return Err("no figure of the peaks: fewer than two curves have a peak");
    }
    let unit = &units.varied(&over.varied(), largest(highest.iter().map(|at| at.0.abs())));
    let x_axis = |label: String| axis(range(highest.iter().map(|at| at.0)), WIDE, label);
    let (factor, energy) = units.energy(largest(found().map(|peak| peak.energy_loss_j)));
    let to_omega = units.frequency().0;
    // A number of each peak, and its error.
    let series = |number: &dyn Fn(&Peak) -> (f64, Option<f64>)| {
        let points = highest
            .iter()
            .map(|(at, peak)| Some((unit.of(*at), number((*peak)?).0)));
        let errors = highest.iter().map(|(_, peak)| number((*peak)?).1);
        Series::line(points).marker(Marker::Disc).error_bars(errors)
    };
    let loss_axis = axis(
        range(found().map(|peak| factor * peak.energy_loss_j)),
        WIDE_LOSSES,
        format!("largest loss per cycle / {energy}"),
    );
    let loss = Chart::new(x_axis(String::new()), loss_axis)
        .series(series(&|peak| {
            let error = peak.energy_loss_error_j.map(|error| factor * error);
            (factor * peak.energy_loss_j, error)
        }))
        .size(800, 360);
    let title = unit.title(&over.varied(), sweep.plan.base.drive.control());
    let frequency = Chart::new(x_axis(title), Axis::log(units.frequency_title()))
        .series(series(&|peak| {
            let error = to_omega * peak.angular_frequency_uncertainty_rad_per_s;
            (to_omega * peak.angular_frequency_rad_per_s, Some(error))
        }))
        .size(800, 380);
    Ok(Figure {
        name: "peaks",
        picture: Picture(vec![loss, frequency]),
        caption: caption(outcome, over, highest.len() - found().count()),
        data: data(sweep, over),
    })
}

fn caption(outcome: &Outcome, over: &Axes, without: usize) -> Caption {
    let words = over.varied().words();
    let caption = Caption::new(format!(
        "Largest energy loss per cycle over frequency, against the {words}: its value above, its frequency below"
    ));
    let absent = (without > 0).then(|| {
        format!(
            "{without} of {} curves are highest at an end of the sweep and have no point here.",
            over.conditions.len()
        )
    });
    let lower = outcome.peaks.len() + without > over.conditions.len();
    let lower = lower.then(|| "The data hold lower peaks too.".to_owned());
    caption.say_all(absent.into_iter().chain(lower))
}

fn data(sweep: &SweepCurves<'_>, over: &Axes) -> Vec<u8> {
    let numbers = [
        "angular_frequency_rad_per_s",
        "angular_frequency_uncertainty_rad_per_s",
        "energy_loss_j",
        "energy_loss_error_j",
        "energy_loss_material_error_j",
    ];
    let peaks = &sweep.outcome.peaks;
    let of_condition = |condition| peaks.iter().filter(move |peak| peak.is_of(condition));
    let rows = over.conditions.iter().flat_map(of_condition).map(|peak| {
        let numbers = cells![
            peak.angular_frequency_rad_per_s,
            peak.angular_frequency_uncertainty_rad_per_s,
            peak.energy_loss_j,
            peak.energy_loss_error_j,
            peak.energy_loss_material_error_j,
        ];
        (sweep.place_of_peak(peak), numbers)
    });
    sweep.table(&[], &numbers, rows)
}
