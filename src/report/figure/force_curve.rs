//! Figures of force curves: force over indentation and over time with the law that was found, its moduli, and many curves side by side.

use super::identify::moduli_of;
use super::plot::Plot;
use super::quantity::{MODULUS, Quantity, Spread, TIME};
use super::trace::{Point, Trace};
use super::units::{Measure, Units};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::{Mark, Marker};
use crate::report::figure::Figure;
use crate::report::force_curve::{CurvesReport, Found, bands};

const FORCE: Quantity = Quantity::new("force_n", "force F", Measure::Of(Dimension::Force));
const INDENTATION: Quantity = Quantity::new(
    "indentation_m",
    "indentation as measured",
    Measure::Of(Dimension::Length),
);
const MISSED: Quantity = Quantity::new("missed", "difference / noise", Measure::Number);
const CURVE: Quantity = Quantity::new("curve", "curve", Measure::Number).spread(Spread::Whole);

/// All of them.
pub fn figures(report: &CurvesReport<'_>) -> Vec<Figure> {
    match report.single() {
        Some(found) => vec![
            over_indentation(&found),
            over_time(&found),
            moduli_of(
                &bands(found.fit),
                found.fit.window_rad_per_s,
                report.moduli(),
            ),
        ],
        None => many(report).into_iter().collect(),
    }
}

/// Measured and computed forces over something.
fn both<'a>(fit: &'a crate::force_curve::CurveFit, over: &'a [f64]) -> [Trace; 2] {
    let measured = over.iter().copied().zip(fit.points.force_n.iter().copied());
    let computed = over.iter().copied().zip(fit.computed_n.iter().copied());
    [
        Trace::symbols(measured)
            .marker(Marker::Disc)
            .color(1)
            .label("measured"),
        Trace::line(computed).label("law"),
    ]
}

fn over_indentation(Found { fit, .. }: &Found<'_>) -> Figure {
    let plot = Plot::new(INDENTATION, FORCE)
        .traces(both(fit, &fit.points.indentation_m))
        .marks([Mark::vertical(fit.contact_point_m.value, "first contact")]);
    let caption = Caption::new(format!(
        "Force over indentation, and the force of the law that was found ({})",
        fit.law().form.in_words()
    ))
    .say("Means of samples; dashed: where the contact begins.");
    Figure::of("force-curve", &[plot], caption, &Units::default()).without_data()
}

fn over_time(Found { fit, .. }: &Found<'_>) -> Figure {
    let missed = (0..fit.computed_n.len()).map(|k| {
        let off = fit.points.force_n[k] - fit.computed_n[k];
        Point::new(fit.points.time_s[k], off / fit.error_n[k])
    });
    let time = TIME.spread(Spread::Linear);
    let frames = [
        Plot::new(time.clone(), FORCE).traces(both(fit, &fit.points.time_s)),
        Plot::new(time, MISSED)
            .traces([Trace::symbols(missed).marker(Marker::Disc).color(1)])
            .marks([Mark::horizontal(0.0, "")]),
    ];
    let caption = Caption::new("Force over time, and what the law misses of it")
        .say("Below: measured less computed force over the standard deviation of each point.");
    Figure::of("force-over-time", &frames, caption, &Units::default()).without_data()
}

/// The storage modulus of every curve in the middle of its window.
fn many(report: &CurvesReport<'_>) -> Option<Figure> {
    let points: Vec<Point> = (report.plan.curves.iter().zip(report.fits).enumerate())
        .filter_map(|(place, (_, fit))| {
            let fit = fit.as_ref().ok()?;
            let (low, high) = fit.window_rad_per_s;
            let band = fit.band((low * high).sqrt())?;
            let error = band.storage_pa * (band.storage_factor - 1.0).min(4.0);
            Some(Point::new((place + 1) as f64, band.storage_pa).error(error))
        })
        .collect();
    if points.is_empty() {
        return None;
    }
    let plot = Plot::new(
        CURVE,
        MODULUS
            .called("storage modulus E\u{2032}")
            .spread(Spread::OfValues),
    )
    .traces([Trace::symbols(points)]);
    let caption = Caption::new("Storage modulus of every curve, in the middle of the frequencies that it says something about")
        .say("Bars: 95 % bands. Curves are numbered in the order of `curves.csv`.");
    Some(Figure::of("moduli-of-curves", &[plot], caption, &Units::default()).without_data())
}
