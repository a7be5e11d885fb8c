//! Figures of a material identified from measured cycles or a history: data and model, residuals, and the moduli with their bands.

use super::plot::Plot;
use super::quantity::{self, MODULUS, Quantity, RESIDUAL, Spread, TIME, scale};
use super::trace::{Point, Trace};
use super::units::{Measure, Units};
use crate::identify::data::Number;
use crate::identify::{Compared, ModulusBand};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::{LineStyle, Mark, Marker, Scale};
use crate::report::figure::Figure;
use crate::report::identify::IdentifyReport;
use crate::report::identify::tables;
use crate::report::measured;
use crate::report::number::range;
use crate::report::quantities;

/// The factor up to which bands are drawn.
const WIDE: f64 = 5.0;

const HALF_WIDTH: Quantity = Quantity::new(
    "half_width",
    "half width of the 95 % band",
    Measure::Percent,
);

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

/// What the data are over: frequencies, or times.
fn places(report: &IdentifyReport<'_>) -> Quantity {
    match report.plan.measurements.is_history() {
        true => TIME.spread(Spread::Log),
        false => Quantity::frequency(&Units::default()),
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

/// One frame for each column: what was measured, and what the model makes of it.
fn data(report: &IdentifyReport<'_>) -> Figure {
    let numbers = report.plan.measurements.numbers();
    let frames = numbers.into_iter().map(|number| frame(report, number));
    let frames: Vec<Plot> = frames.collect();
    let caption = Caption::new(match report.plan.measurements.is_history() {
        true => "Measured history, and the history computed with the identified material",
        false => "Measured cycles, and the cycles computed with the identified material",
    })
    .say("Bars: standard errors of the data. Shaded: 95 % band of the model.");
    let caption = match frames.iter().map(Plot::without_place).sum() {
        0 => caption,
        n => caption.say(format!(
            "The model is at or below zero at {n} points, which a logarithmic axis does not show."
        )),
    };
    Figure::of("data-and-model", &frames, caption, &Units::default()).with_data(tables::fit(report))
}

/// The frame of one column.
fn frame(report: &IdentifyReport<'_>, number: Number) -> Plot {
    let numbers = of(report, number);
    let (name, dimension) = words(number);
    let measure = dimension.map_or(Measure::Number, Measure::Of);
    // What the model makes of them, which may be zero, does not decide on the axis.
    let spread = match scale(range(numbers.iter().map(|c| c.measured)), quantity::WIDE) {
        Scale::Log => Spread::Log,
        Scale::Linear => Spread::Linear,
    };
    let quantity = Quantity::new("value", name, measure).spread(spread);
    let measured = numbers
        .iter()
        .map(|c| Point::new(c.place, c.measured).error(c.error));
    let measured = Trace::symbols(measured).color(1).label("measured");
    let curve = report.curves.iter().find(|curve| curve.number == number);
    let model = match curve {
        Some(curve) => Trace::line(curve.points.iter().map(|(x, value)| {
            let open = open_at(&numbers, *x);
            Point::new(*x, *value).band(Some((value / open, value * open)))
        })),
        None => {
            Trace::symbols(numbers.iter().map(|c| (c.place, c.computed))).marker(Marker::Square)
        }
    };
    Plot::new(places(report), quantity).traces([model.label("model"), measured])
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

/// What the model misses, relative to the data.
fn residuals(report: &IdentifyReport<'_>) -> Figure {
    const MARKERS: [Marker; 2] = [Marker::Disc, Marker::Square];
    let (lowest, highest) = range(report.found.compared.iter().map(|c| c.place));
    let measured = report.plan.measurements.numbers().into_iter().enumerate();
    let traces = measured.map(|(place, number)| {
        let numbers = of(report, number).into_iter();
        let points = numbers.map(|c| {
            Point::new(c.place, c.computed / c.measured - 1.0).error((c.error / c.measured).abs())
        });
        Trace::symbols(points)
            .marker(MARKERS[place % MARKERS.len()])
            .color(place)
            .label(words(number).0)
    });
    let plot = Plot::new(places(report), RESIDUAL)
        .traces([Trace::guide([(lowest, 0.0), (highest, 0.0)])])
        .traces(traces);
    let caption = Caption::new("Difference of the computed numbers from the measured ones")
        .say("Bars: standard errors of the data.");
    Figure::of("residuals", &[plot], caption, &Units::default()).without_data()
}

/// A modulus, and the factor of its band.
type Banded = (fn(&ModulusBand) -> f64, fn(&ModulusBand) -> f64);

const STORAGE: Banded = (|band| band.storage_pa, |band| band.storage_factor);
const LOSS: Banded = (|band| band.loss_pa, |band| band.loss_factor);

/// Storage and loss modulus with their bands, and below them how wide these are relative to the moduli.
fn moduli(report: &IdentifyReport<'_>) -> Figure {
    let omegas = tables::frequencies(report).into_iter();
    let bands = omegas.map(|omega| (omega, report.found.band(omega)));
    let bands: Vec<_> = bands.collect();
    moduli_of(
        &bands,
        report.found.window_rad_per_s,
        tables::moduli(report),
    )
}

/// The same of bands over angular frequencies (rad/s) within a window and beyond it, with their table.
pub(super) fn moduli_of(
    bands: &[(f64, ModulusBand)],
    (first, last): (f64, f64),
    data: Vec<u8>,
) -> Figure {
    let line = |(value, open): Banded| {
        Trace::line(bands.iter().map(|(omega, b)| {
            // What is not determined fills the frame, not the axis.
            let (value, open) = (value(b), open(b).min(WIDE));
            Point::new(*omega, value).band(Some((value / open, value * open)))
        }))
    };
    let half_width = |(_, open): Banded| {
        let points = bands
            .iter()
            .map(|(omega, b)| (*omega, open(b).min(WIDE) - 1.0));
        Trace::line(points.filter(|(_, half)| *half > 0.0))
    };
    let (low, high) = range(bands.iter().map(|(omega, _)| *omega));
    let frame = |y: Quantity, [storage, loss]: [Trace; 2], [of_first, of_last]: [&str; 2]| {
        Plot::new(Quantity::frequency(&Units::default()), y)
            .traces([
                storage.label("storage modulus E′"),
                loss.label("loss modulus E″")
                    .color(1)
                    .style(LineStyle::Dashed),
            ])
            .marks([
                Mark::vertical(first, of_first),
                Mark::vertical(last, of_last),
            ])
            .x_ends(low, high)
    };
    let frames = [
        frame(
            MODULUS,
            [line(STORAGE), line(LOSS)],
            ["first measured", "last measured"],
        ),
        frame(HALF_WIDTH, [half_width(STORAGE), half_width(LOSS)], [""; 2]),
    ];
    let caption = Caption::new("Storage modulus E′ and loss modulus E″ of the identified material, and how well they are known")
        .say("Shaded: 95 % bands, drawn up to a factor of five. Below: half widths of the bands.")
        .say("Dashed: first and last measured frequency, beyond which they are an extrapolation.");
    Figure::of("moduli", &frames, caption, &Units::default()).with_data(data)
}
