//! Figures of force curves: force over indentation and over time with the law that was found, its moduli, and many curves side by side.

use super::identify::moduli_of;
use super::plot::Plot;
use super::quantity::{MODULUS, Quantity, Spread, TIME};
use super::trace::{Point, Trace};
use super::units::{Measure, Units};
use crate::force_curve::CurveFit;
use crate::numerics::order::median;
use crate::quantity::{Dimension, format_human};
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, HeatMap, Mark, Marker};
use crate::report::figure::Figure;
use crate::report::force_curve::{CurvesReport, Found, tables};
use crate::report::number::largest;

const FORCE: Quantity = Quantity::new("force_n", "force F", Measure::Of(Dimension::Force));
const INDENTATION: Quantity = Quantity::new(
    "indentation_m",
    "indentation as measured",
    Measure::Of(Dimension::Length),
);
const MISSED: Quantity = Quantity::new("missed", "difference / noise", Measure::Number);
const CURVE: Quantity = Quantity::new("curve", "curve", Measure::Number).spread(Spread::Whole);

/// Places that are closer than this part of the map are on one line.
const NEAR: f64 = 5e-3;

/// All of them.
pub fn figures(report: &CurvesReport<'_>) -> Vec<Figure> {
    match report.single() {
        Some(found) => vec![
            over_indentation(found),
            over_time(found),
            moduli_of(
                &found.bands,
                found.fit.window_rad_per_s,
                tables::moduli(report),
            ),
        ],
        None => many(report),
    }
}

/// Measured and computed forces over something.
fn both(fit: &CurveFit, over: &[f64]) -> [Trace; 2] {
    let measured = over.iter().copied().zip(fit.points.force_n.iter().copied());
    // Where points are left out the law is not drawn either.
    let computed = over.iter().zip(&fit.computed_n).enumerate();
    let computed = computed.flat_map(|(k, (x, force_n))| {
        let gap = fit.points.gaps.contains(&k).then(|| Point::new(*x, None));
        gap.into_iter().chain([Point::new(*x, *force_n)])
    });
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
        fit.laws.best().form.in_words()
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

/// E' (Pa) of every curve, at the frequency (rad/s) that is in the middle for most, and the factor of its band; `None` of a curve that was
/// not fitted.
fn storage_moduli(report: &CurvesReport<'_>) -> (f64, Vec<Option<(f64, f64)>>) {
    let middles: Vec<f64> = report.found().map(Found::middle).collect();
    let omega = median(&middles);
    let moduli = report.curves().iter().map(|(_, found)| {
        let band = found.as_ref().ok()?.fit.laws.band(omega)?;
        Some((band.storage_pa, band.storage_factor))
    });
    (omega, moduli.collect())
}

/// The storage modulus of every curve: in their order, and where they are a map over the specimen.
fn many(report: &CurvesReport<'_>) -> Vec<Figure> {
    let (omega, moduli) = storage_moduli(report);
    let known = moduli.iter().enumerate();
    let points = known.filter_map(|(place, modulus)| {
        let (pa, factor) = (*modulus)?;
        Some(Point::new((place + 1) as f64, pa).error(pa * (1.0 - 1.0 / factor)))
    });
    let points: Vec<Point> = points.collect();
    if points.is_empty() {
        return Vec::new();
    }
    let at = format!("at {}", format_human(omega, Dimension::AngularFrequency, 3));
    let quantity = MODULUS.called("storage modulus E\u{2032}");
    let plot = Plot::new(CURVE, quantity.clone().spread(Spread::OfValues))
        .traces([Trace::symbols(points)]);
    let caption = Caption::new(format!("Storage modulus E\u{2032} of every curve {at}"))
        .say("Bars: as far as the lower end of the 95 % band. Curves are numbered in the order of `curves.csv`.");
    let in_order = Figure::of("moduli-of-curves", &[plot], caption, &Units::default());
    let map = map(report, &moduli, &quantity).map(|chart| Figure {
        name: "modulus-map".into(),
        picture: chart.into(),
        caption: Caption::new(format!("Storage modulus E\u{2032} over the specimen {at}"))
            .say("Blank: curves that were not fitted."),
        data: Vec::new(),
    });
    [in_order.without_data()].into_iter().chain(map).collect()
}

/// The map, where the places of the curves are a grid.
fn map(
    report: &CurvesReport<'_>,
    moduli: &[Option<(f64, f64)>],
    quantity: &Quantity,
) -> Option<Chart> {
    let places = report.curves().iter().map(|(curve, _)| curve.place_m);
    let places: Vec<(f64, f64)> = places.collect::<Option<_>>()?;
    let (x_m, y_m) = (
        lines(places.iter().map(|p| p.0))?,
        lines(places.iter().map(|p| p.1))?,
    );
    let nearest = |lines: &[f64], value: f64| {
        let off = |k: &usize| (lines[*k] - value).abs();
        (0..lines.len()).min_by(|a, b| off(a).total_cmp(&off(b)))
    };
    let known = moduli.iter().flatten().map(|(pa, _)| *pa);
    let units = Units::default();
    let modulus = units.shown(quantity.measure, largest(known));
    let mut values = vec![None; x_m.len() * y_m.len()];
    for ((x, y), found) in places.iter().zip(moduli) {
        let cell = nearest(&y_m, *y)? * x_m.len() + nearest(&x_m, *x)?;
        values[cell] = found.map(|(pa, _)| modulus.of(pa));
    }
    let size_m = |lines: &[f64]| lines[lines.len() - 1] - lines[0];
    let length = units.shown(Measure::Length, size_m(&x_m).max(size_m(&y_m)));
    let axis = |name: &str, lines: &[f64]| {
        let half_m = 0.5 * (lines[1] - lines[0]);
        let (low_m, high_m) = (lines[0] - half_m, lines[lines.len() - 1] + half_m);
        Axis::linear(length.title(name)).range(length.of(low_m), length.of(high_m))
    };
    let chart = Chart::new(axis("x", &x_m), axis("y", &y_m));
    Some(chart.map(HeatMap {
        columns: x_m.len(),
        rows: y_m.len(),
        values,
        value_label: modulus.title(&quantity.words),
        ..HeatMap::default()
    }))
}

/// The lines of a grid that has points at these values: two at least, evenly spaced.
fn lines(values: impl Iterator<Item = f64>) -> Option<Vec<f64>> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let span = values.last()? - values.first()?;
    let least = values[0];
    let mut lines: Vec<f64> = Vec::new();
    for value in values {
        if lines.last().is_none_or(|last| value - last > NEAR * span) {
            lines.push(value);
        }
    }
    let count = lines.len();
    let even = |k: usize| least + span * k as f64 / (count - 1) as f64;
    let is_even = count > 1 && (0..count).all(|k| (lines[k] - even(k)).abs() < NEAR * span);
    is_even.then(|| (0..count).map(even).collect())
}
