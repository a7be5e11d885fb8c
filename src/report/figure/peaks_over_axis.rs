//! The peak of each curve over the second axis of a sweep: its loss above, its frequency below. A curve that is highest at an end
//! of the sweep has none.

use super::curve::SweepCurves;
use super::plot::Plot;
use super::quantity::{ENERGY_LOSS, Quantity, Spread};
use super::trace::{Point, Trace};
use super::{Drawn, Figure};
use crate::report::caption::Caption;
use crate::report::chart::Marker;
use crate::sweep::plan::Axes;
use crate::sweep::search::peak::Peak;

/// The figure.
pub fn figure(sweep: &SweepCurves<'_>, over: &Axes) -> Drawn {
    let outcome = sweep.outcome;
    let highest = over.conditions.iter();
    let highest = highest.filter_map(|c| Some((c.number()?, outcome.highest_peak(c))));
    let highest: Vec<(f64, Option<&Peak>)> = highest.collect();
    let found = highest.iter().filter(|(_, peak)| peak.is_some()).count();
    if found < 2 {
        return Err("no figure of the peaks: fewer than two curves have a peak");
    }
    let plot = |y: Quantity, point: &dyn Fn(f64, &Peak) -> Point| {
        let points = highest.iter().map(|(x, peak)| match peak {
            Some(peak) => point(*x, peak),
            None => Point::new(*x, None),
        });
        let x = Quantity::varied(&over.varied(), sweep.plan.base.drive.control());
        Plot::new(x, y.spread(Spread::OfValues))
            .traces([Trace::line(points).marker(Marker::Disc).smooth([])])
    };
    let loss = plot(ENERGY_LOSS.called("largest loss per cycle"), &|x, peak| {
        Point::new(x, peak.energy_loss_j).error(peak.energy_loss_error_j)
    });
    let frequency = plot(Quantity::frequency(&sweep.units), &|x, peak| {
        Point::new(x, peak.angular_frequency_rad_per_s)
            .error(peak.angular_frequency_uncertainty_rad_per_s)
    });
    let caption = caption(sweep, over, highest.len() - found);
    Ok(Figure::of(
        "peaks",
        &[loss, frequency],
        caption,
        &sweep.units,
    ))
}

fn caption(sweep: &SweepCurves<'_>, over: &Axes, without: usize) -> Caption {
    let (words, of) = (over.varied().words(), over.conditions.len());
    let absent = (without > 0).then(|| {
        format!(
            "{without} of {of} curves are highest at an end of the sweep and have no point here."
        )
    });
    let lower = sweep.outcome.peaks.len() + without > of;
    let lower = lower.then(|| "Lower peaks are in summary.json.".to_owned());
    Caption::new(format!(
        "Largest energy loss per cycle over frequency, against the {words}: its value above, its frequency below"
    ))
    .say_all(absent.into_iter().chain(lower))
}
