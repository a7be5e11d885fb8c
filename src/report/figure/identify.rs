//! Figures of a material identified from measured cycles or a history: data and model, residuals, and the moduli with their bands.

use crate::identify::data::Number;
use crate::identify::{Compared, ModulusBand};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Color, LineStyle, Mark, Marker, Scale, Series};
use crate::report::figure::{Figure, Picture, axis};
use crate::report::identify::IdentifyReport;
use crate::report::identify::tables;
use crate::report::measured;
use crate::report::number::{largest, prefix, range};
use crate::report::quantities;

/// Values that differ by more than this factor stand on a logarithmic axis.
const WIDE: f64 = 5.0;

const OMEGA: &str = "angular frequency ω / rad·s⁻¹";

/// All of them.
pub fn figures(report: &IdentifyReport<'_>) -> Vec<Figure> {
    vec![moduli(report), data(report), residuals(report)]
}

/// The numbers of one column, in ascending frequency or time.
fn of<'a>(report: &'a IdentifyReport<'_>, number: Number) -> Vec<&'a Compared> {
    let all = report.found.compared.iter();
    let mut own: Vec<&Compared> = all.filter(|c| c.number == number).collect();
    own.sort_by(|a, b| a.place.total_cmp(&b.place));
    own
}

/// The axis of the places: frequencies, or times.
fn places(report: &IdentifyReport<'_>) -> Axis {
    match report.plan.measurements.is_history() {
        true => Axis::log("time t / s"),
        false => Axis::log(OMEGA),
    }
}

/// What was measured, in the words of its column, and its dimension.
fn words(number: Number) -> (&'static str, Option<Dimension>) {
    let name = number.column();
    let of_sweep = quantities::of_name(name).map(|c| (c.heading, c.dimension));
    let mut of_analysis = measured::columns::OWN.iter();
    let of_analysis = of_analysis.find(|c| c.name == name);
    let mut of_history = quantities::HISTORY.iter();
    let of_history = of_history.find(|c| c.name == name);
    let known = of_sweep
        .or_else(|| of_analysis.map(|c| (c.heading, c.dimension)))
        .or_else(|| of_history.map(|c| (c.heading, c.dimension)));
    known.unwrap_or((name, None))
}

/// What an axis is headed with, and the factor from SI.
fn heading(number: Number, numbers: &[&Compared]) -> (String, f64) {
    let (name, dimension) = words(number);
    match dimension {
        Some(Dimension::Angle) => (format!("{name} / °"), 180.0 / std::f64::consts::PI),
        Some(dimension) => {
            let (factor, unit) = prefix(largest(numbers.iter().map(|c| c.measured)));
            (format!("{name} / {unit}{}", dimension.si_unit()), factor)
        }
        None => (name.to_owned(), 1.0),
    }
}

/// One frame for each column: what was measured, and what the model makes of it.
fn data(report: &IdentifyReport<'_>) -> Figure {
    let numbers = report.plan.measurements.numbers();
    let frames = numbers.iter().enumerate();
    let (charts, left_out): (Vec<Chart>, Vec<usize>) = frames
        .map(|(place, number)| frame(report, *number, place == 0))
        .unzip();
    let left_out: usize = left_out.into_iter().sum();
    let caption = Caption::new(match report.plan.measurements.is_history() {
        true => "Measured history, and the history computed with the identified material",
        false => "Measured cycles, and the cycles computed with the identified material",
    })
    .say("Bars: standard errors of the data. Shaded: 95 % band of the model.");
    Figure {
        name: "data-and-model",
        picture: Picture(charts),
        caption: match left_out {
            0 => caption,
            n => caption.say(format!(
                "The model is at or below zero at {n} points, which a logarithmic axis does not show."
            )),
        },
        data: tables::fit(report),
    }
}

/// The frame of one column, and how many points of the model its axis cannot show.
fn frame(report: &IdentifyReport<'_>, number: Number, is_first: bool) -> (Chart, usize) {
    let numbers = of(report, number);
    let (label, factor) = heading(number, &numbers);
    let y = axis(range(numbers.iter().map(|c| c.measured)), WIDE, label);
    let is_shown = |value: f64| y.scale == Scale::Linear || value > 0.0;
    let mut left_out = 0;
    let mut shown = |point: (f64, f64)| {
        let is_shown = is_shown(point.1);
        left_out += usize::from(!is_shown);
        is_shown.then_some(point)
    };
    let named = |series: Series, label: &str| match is_first {
        true => series.label(label),
        false => series,
    };
    let measured = numbers.iter().map(|c| (c.place, factor * c.measured));
    let measured = Series::scatter(measured)
        .error_bars(numbers.iter().map(|c| factor * c.error))
        .color(1);
    let curve = report.curves.iter().find(|curve| curve.number == number);
    let (band, model) = match curve {
        Some(curve) => {
            let points = curve.points.iter().map(|(x, v)| (*x, factor * v));
            let band = points.clone().filter_map(|(x, v)| {
                let open = open_at(&numbers, x);
                is_shown(v / open).then_some((x, v / open, v * open))
            });
            (
                Some(Series::band(band)),
                Series::line(points.map(&mut shown)),
            )
        }
        None => {
            let computed = numbers.iter().map(|c| (c.place, factor * c.computed));
            let computed = Series::scatter(computed.map(&mut shown));
            (None, computed.marker(Marker::Square))
        }
    };
    let chart = Chart::new(places(report), y)
        .all_series(band)
        .series(named(model, "model"))
        .series(named(measured, "measured"));
    (chart, left_out)
}

/// The factor of the band at a frequency, between those of the data on both sides.
fn open_at(numbers: &[&Compared], omega: f64) -> f64 {
    let after = numbers.partition_point(|c| c.place < omega);
    let below = numbers.get(after.saturating_sub(1));
    match (below, numbers.get(after)) {
        (Some(below), Some(above)) => {
            let (from, to) = (below.place, above.place);
            let share = if to > from {
                (omega / from).ln() / (to / from).ln()
            } else {
                0.0
            };
            below.factor.powf(1.0 - share) * above.factor.powf(share)
        }
        (Some(one), None) | (None, Some(one)) => one.factor,
        (None, None) => 1.0,
    }
}

/// What the model misses, in per cent of the data.
fn residuals(report: &IdentifyReport<'_>) -> Figure {
    const MARKERS: [Marker; 2] = [Marker::Disc, Marker::Square];
    let (lowest, highest) = range(report.found.compared.iter().map(|c| c.place));
    let mut chart = Chart::new(
        places(report),
        Axis::linear("difference model − data / % of the data"),
    )
    .series(Series::line([(lowest, 0.0), (highest, 0.0)]).color(Color::Rgb(0x40, 0x40, 0x40)));
    let measured = report.plan.measurements.numbers();
    for (place, number) in measured.into_iter().enumerate() {
        let numbers = of(report, number);
        let off = |c: &&Compared| (c.place, 100.0 * (c.computed / c.measured - 1.0));
        let series = Series::scatter(numbers.iter().map(off))
            .error_bars(numbers.iter().map(|c| 100.0 * c.error / c.measured))
            .marker(MARKERS[place % MARKERS.len()])
            .color(place)
            .label(words(number).0);
        chart = chart.series(series);
    }
    Figure {
        name: "residuals",
        picture: chart.into(),
        caption: Caption::new("Difference of the computed numbers from the measured ones")
            .say("Bars: standard errors of the data."),
        data: Vec::new(),
    }
}

/// A modulus, and the factor of its band.
type Banded = (fn(&ModulusBand) -> f64, fn(&ModulusBand) -> f64);

const STORAGE: Banded = (|band| band.storage_pa, |band| band.storage_factor);
const LOSS: Banded = (|band| band.loss_pa, |band| band.loss_factor);

/// Storage and loss modulus with their bands, and below them how wide these are in per cent of the moduli.
fn moduli(report: &IdentifyReport<'_>) -> Figure {
    let omegas = tables::frequencies(report).into_iter();
    let bands: Vec<_> = omegas
        .map(|omega| (omega, report.found.band(omega)))
        .collect();
    let (factor, unit) = prefix(largest(bands.iter().map(|(_, b)| b.storage_pa)));
    let line = |(value, _): Banded| {
        Series::line(bands.iter().map(|(omega, b)| (*omega, factor * value(b))))
    };
    let shaded = |(value, open): Banded| {
        Series::band(bands.iter().map(|(omega, b)| {
            // What is not determined fills the frame, not the axis.
            let open = open(b).min(WIDE);
            (*omega, factor * value(b) / open, factor * value(b) * open)
        }))
    };
    let half_width = |(_, open): Banded| {
        let points = bands
            .iter()
            .map(|(omega, b)| (*omega, 100.0 * (open(b).min(WIDE) - 1.0)));
        Series::line(points.filter(|(_, open)| *open > 0.0))
    };
    let (lowest, highest) = report.found.window_rad_per_s;
    let (low, high) = range(bands.iter().map(|(omega, _)| *omega));
    let chart = Chart::new(
        Axis::log(OMEGA).range(low, high),
        Axis::log(format!("modulus / {unit}Pa")),
    )
    .series(shaded(STORAGE).color(0))
    .series(shaded(LOSS).color(1))
    .series(line(STORAGE).label("storage modulus E′"))
    .series(dashed(line(LOSS)).label("loss modulus E″"))
    .mark(Mark::vertical(lowest, "first measured"))
    .mark(Mark::vertical(highest, "last measured"));
    let open = Chart::new(
        Axis::log(OMEGA),
        Axis::linear("half width of the 95 % band / %"),
    )
    .series(half_width(STORAGE))
    .series(dashed(half_width(LOSS)))
    .mark(Mark::vertical(lowest, ""))
    .mark(Mark::vertical(highest, ""));
    Figure {
        name: "moduli",
        picture: Picture(vec![chart, open]),
        caption: Caption::new("Storage modulus E′ and loss modulus E″ of the identified material, and how well they are known")
            .say("Shaded: 95 % bands, drawn up to a factor of five. Below: half widths of the bands.")
            .say("Dashed: first and last measured frequency, beyond which the series is an extrapolation."),
        data: tables::moduli(report),
    }
}

fn dashed(series: Series) -> Series {
    series.color(1).style(LineStyle::Dashed)
}
