//! Figures of a material identified from measured cycles or a history: data and model, residuals, and the moduli with their bands.

use crate::identify::Compared;
use crate::identify::data::Number;
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Color, LineStyle, Mark, Marker, Series};
use crate::report::figure::{Figure, Picture};
use crate::report::identify::IdentifyReport;
use crate::report::identify::tables;
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
    match number {
        Number::OfCycle(_) => {
            let column = quantities::of_name(name);
            column.map_or((name, None), |c| (c.heading, c.dimension))
        }
        Number::Approach | Number::Load => {
            let column = quantities::HISTORY.iter().find(|c| c.name == name);
            column.map_or((name, None), |c| (c.heading, c.dimension))
        }
    }
}

/// What an axis is headed with, and the factor from SI.
fn axis(number: Number, numbers: &[&Compared]) -> (String, f64) {
    let (heading, dimension) = words(number);
    match dimension {
        Some(Dimension::Angle) => (format!("{heading} / °"), 180.0 / std::f64::consts::PI),
        Some(dimension) => {
            let (factor, unit) = prefix(largest(numbers.iter().map(|c| c.measured)));
            (format!("{heading} / {unit}{}", dimension.si_unit()), factor)
        }
        None => (heading.to_owned(), 1.0),
    }
}

/// One frame for each column: what was measured, and what the model makes of it.
fn data(report: &IdentifyReport<'_>) -> Figure {
    let numbers = report.plan.measurements.numbers();
    let frames = numbers.iter().enumerate();
    let charts = frames.map(|(place, number)| frame(report, *number, place == 0));
    Figure {
        name: "data-and-model",
        picture: Picture(charts.collect()),
        caption: Caption::new(match report.plan.measurements.is_history() {
            true => "Measured history, and the history computed with the identified material",
            false => "Measured cycles, and the cycles computed with the identified material",
        })
        .say("Bars: standard errors of the data. Shaded: 95 % band of the model."),
        data: tables::fit(report),
    }
}

fn frame(report: &IdentifyReport<'_>, number: Number, is_first: bool) -> Chart {
    let numbers = of(report, number);
    let (label, factor) = axis(number, &numbers);
    let (low, high) = range(numbers.iter().map(|c| c.measured));
    let y = match high > WIDE * low {
        true => Axis::log(label),
        false => Axis::linear(label),
    };
    let at = |value: fn(&Compared) -> f64| {
        let places = numbers.iter().map(|c| (c.place, factor * value(c)));
        places.collect::<Vec<_>>()
    };
    let named = |series: Series, label: &str| match is_first {
        true => series.label(label),
        false => series,
    };
    let bars = numbers.iter().map(|c| factor * c.error);
    let measured = Series::scatter(at(|c| c.measured))
        .error_bars(bars.collect::<Vec<_>>())
        .color(1);
    let chart = Chart::new(places(report), y);
    let curve = report.curves.iter().find(|curve| curve.number == number);
    let chart = match curve {
        Some(curve) => {
            let points = curve.points.iter().map(|(omega, v)| (*omega, factor * v));
            let band = curve.points.iter().map(|(omega, v)| {
                let open = open_at(&numbers, *omega);
                (*omega, factor * v / open, factor * v * open)
            });
            chart
                .series(Series::band(band.collect::<Vec<_>>()).color(0))
                .series(named(
                    Series::line(points.collect::<Vec<_>>()).color(0),
                    "model",
                ))
        }
        None => {
            let computed = Series::scatter(at(|c| c.computed)).marker(Marker::Square);
            chart.series(named(computed.color(0), "model"))
        }
    };
    chart.series(named(measured, "measured"))
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
        let places = numbers.iter().map(|c| {
            let off = 100.0 * (c.computed / c.measured - 1.0);
            (c.place, off)
        });
        let bars = numbers.iter().map(|c| 100.0 * c.error / c.measured);
        let (heading, _) = words(number);
        let series = Series::scatter(places.collect::<Vec<_>>())
            .error_bars(bars.collect::<Vec<_>>())
            .marker(MARKERS[place % MARKERS.len()])
            .color(place)
            .label(heading);
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

/// Storage and loss modulus with their bands.
fn moduli(report: &IdentifyReport<'_>) -> Figure {
    let omegas = tables::frequencies(report);
    let bands = omegas
        .iter()
        .map(|omega| (*omega, report.found.band(*omega)));
    let bands: Vec<_> = bands.collect();
    let (factor, unit) = prefix(largest(bands.iter().map(|(_, b)| b.storage_pa)));
    let line = |value: fn(&crate::identify::ModulusBand) -> f64| {
        Series::line(
            bands
                .iter()
                .map(|(omega, b)| (*omega, factor * value(b)))
                .collect::<Vec<_>>(),
        )
    };
    let shaded = |value: fn(&crate::identify::ModulusBand) -> (f64, f64)| {
        let band = bands.iter().map(|(omega, b)| {
            // What is not determined fills the frame, not the axis.
            let (own, open) = value(b);
            let open = open.min(WIDE);
            (*omega, factor * own / open, factor * own * open)
        });
        Series::band(band.collect::<Vec<_>>())
    };
    let (lowest, highest) = report.found.window_rad_per_s;
    let chart = Chart::new(over(&omegas), Axis::log(format!("modulus / {unit}Pa")))
        .series(shaded(|b| (b.storage_pa, b.storage_factor)).color(0))
        .series(shaded(|b| (b.loss_pa, b.loss_factor)).color(1))
        .series(line(|b| b.storage_pa).label("storage modulus E′"))
        .series(
            line(|b| b.loss_pa)
                .color(1)
                .style(LineStyle::Dashed)
                .label("loss modulus E″"),
        )
        .mark(Mark::vertical(lowest, "first measured"))
        .mark(Mark::vertical(highest, "last measured"));
    Figure {
        name: "moduli",
        picture: Picture(vec![chart, openness(report, &omegas)]),
        caption: Caption::new("Storage modulus E′ and loss modulus E″ of the identified material, and how well they are known")
            .say("Shaded: 95 % bands, drawn up to a factor of five. Below: half widths of the bands.")
            .say("Dashed: first and last measured frequency, beyond which the series is an extrapolation."),
        data: tables::moduli(report),
    }
}

/// The axis of all these frequencies.
fn over(omegas: &[f64]) -> Axis {
    let (low, high) = range(omegas.iter().copied());
    Axis::log(OMEGA).range(low, high)
}

/// Half widths of the bands, in per cent of the moduli.
fn openness(report: &IdentifyReport<'_>, omegas: &[f64]) -> Chart {
    let line = |value: fn(&crate::identify::ModulusBand) -> f64| {
        let points = omegas.iter().map(|omega| {
            let open = value(&report.found.band(*omega)).min(WIDE) - 1.0;
            (*omega, 100.0 * open)
        });
        Series::line(points.filter(|(_, open)| *open > 0.0).collect::<Vec<_>>())
    };
    let (lowest, highest) = report.found.window_rad_per_s;
    Chart::new(
        Axis::log(OMEGA),
        Axis::linear("half width of the 95 % band / %"),
    )
    .series(line(|b| b.storage_factor))
    .series(line(|b| b.loss_factor).color(1).style(LineStyle::Dashed))
    .mark(Mark::vertical(lowest, ""))
    .mark(Mark::vertical(highest, ""))
}
