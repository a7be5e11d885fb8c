//! The peak of each curve over the second axis of a sweep: its loss above, its frequency below. A curve that is highest at an end
//! of the sweep has none.

use super::curve::{place_cells, place_columns};
use super::moduli_error::WIDE;
use super::units::Units;
use super::{Drawn, Figure, Picture, axis};
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Marker, Series};
use crate::report::number::{largest, range};
use crate::report::table::{Cell, cells, csv_leading};
use crate::sweep::plan::{Axes, SweepPlan};
use crate::sweep::search::peak::Peak;
use crate::sweep::search::run::Outcome;

/// Losses that vary by more than this are drawn on a logarithmic axis.
const WIDE_LOSSES: f64 = 20.0;

/// The figure.
pub fn figure(plan: &SweepPlan, outcome: &Outcome, over: &Axes, units: &Units) -> Drawn {
    let highest = over
        .conditions
        .iter()
        .filter_map(|condition| Some((condition.value()?, outcome.highest_peak(condition))));
    let highest: Vec<(f64, Option<&Peak>)> = highest.collect();
    let found = || highest.iter().filter_map(|(_, peak)| *peak);
    if found().count() < 2 {
        return Drawn::left_out("no figure of the peaks: fewer than two curves have a peak");
    }
    let unit = &units.varied(&over.varied(), largest(highest.iter().map(|at| at.0.abs())));
    let x_axis = |label: String| axis(range(highest.iter().map(|at| at.0)), WIDE, label);
    let (factor, energy) = units.energy(largest(found().map(|peak| peak.energy_loss_j)));
    let to_omega = units.frequency().0;
    let points = |value: &dyn Fn(&Peak) -> f64| {
        let points = highest.iter();
        let points = points.map(|(at, peak)| Some((unit.of(*at), value((*peak)?))));
        points.collect::<Vec<_>>()
    };
    let errors = |error: &dyn Fn(&Peak) -> Option<f64>| {
        let errors = highest.iter().map(|(_, peak)| error((*peak)?));
        errors.collect::<Vec<_>>()
    };
    let losses = points(&|peak| factor * peak.energy_loss_j);
    let loss_errors = errors(&|peak| Some(factor * peak.energy_loss_error_j?));
    let frequencies = points(&|peak| to_omega * peak.angular_frequency_rad_per_s);
    let place_errors =
        errors(&|peak| Some(to_omega * peak.angular_frequency_uncertainty_rad_per_s));
    let of_losses = range(found().map(|peak| factor * peak.energy_loss_j));
    let loss_axis = axis(
        of_losses,
        WIDE_LOSSES,
        format!("largest loss per cycle / {energy}"),
    );
    let loss = Chart::new(x_axis(String::new()), loss_axis)
        .all_series([Series::line(losses)
            .marker(Marker::Disc)
            .error_bars(loss_errors)])
        .size(800, 360);
    let title = unit.title(&over.varied(), plan.drive.control());
    let frequency = Chart::new(x_axis(title), Axis::log(units.frequency_title()))
        .all_series([Series::line(frequencies)
            .marker(Marker::Disc)
            .error_bars(place_errors)])
        .size(800, 380);
    Drawn::Figure(Figure {
        name: "peaks",
        picture: Picture::Stack(vec![loss, frequency]),
        caption: caption(outcome, over, highest.len() - found().count()),
        data: data(plan, outcome, over, units),
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

fn data(plan: &SweepPlan, outcome: &Outcome, over: &Axes, units: &Units) -> Vec<u8> {
    let mut columns = place_columns(Some(over));
    let numbers = [
        "angular_frequency_rad_per_s",
        "angular_frequency_uncertainty_rad_per_s",
        "energy_loss_j",
        "energy_loss_error_j",
        "energy_loss_material_error_j",
    ];
    columns.extend(numbers.map(str::to_owned));
    let of_condition = |condition| outcome.peaks.iter().filter(move |p| p.is_of(condition));
    let rows = over.conditions.iter().flat_map(of_condition).map(|peak| {
        let drive = [
            peak.drive_mean.unwrap_or(plan.drive.mean()),
            peak.drive_amplitude.unwrap_or(plan.drive.amplitude()),
        ];
        let numbers: [Cell; 5] = cells![
            peak.angular_frequency_rad_per_s,
            peak.angular_frequency_uncertainty_rad_per_s,
            peak.energy_loss_j,
            peak.energy_loss_error_j,
            peak.energy_loss_material_error_j,
        ];
        let mut row = place_cells(Some(over), peak.varied, drive);
        row.extend(numbers);
        row
    });
    csv_leading(units.frequency_unit(), &columns, rows)
}
