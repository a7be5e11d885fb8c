//! What the fitted series misses of each point, and the band of its replicas.

use super::{MARKERS, caption, frequencies, frequency_title};
use crate::report::chart::{Axis, Chart, Color, LineStyle, Series};
use crate::report::dynamic::{Band, DynamicReport};
use crate::report::figure::Figure;
use crate::report::table::{cells, csv};

/// The figure.
pub(super) fn figure(report: &DynamicReport<'_>) -> Figure {
    let symbol = report.symbol();
    let points = report.points();
    let residuals = || points.iter().zip(&report.made.fit.residuals);
    let measured = |part: fn(&(f64, f64)) -> f64| {
        let places = residuals().map(|(p, r)| (p.angular_frequency_rad_per_s, 100.0 * part(r)));
        Series::scatter(places.collect::<Vec<_>>())
    };
    let (lowest, highest) = report.made.fit.window_rad_per_s;
    let mut chart = Chart::new(
        Axis::log(frequency_title(report)),
        Axis::linear("difference fit − data / % of the data"),
    )
    .series(Series::line([(lowest, 0.0), (highest, 0.0)]).color(Color::Rgb(0x40, 0x40, 0x40)))
    .series(
        measured(|r| r.0)
            .marker(MARKERS[0])
            .label(format!("storage modulus {symbol}′")),
    )
    .series(
        measured(|r| r.1)
            .marker(MARKERS[1])
            .color(1)
            .label(format!("loss modulus {symbol}″")),
    );
    let mut caption = caption(
        report,
        &format!("Relative difference of the fitted series from the data, {symbol}′ and {symbol}″"),
    );
    let replicas = report.made.replicas.len();
    if Band::of(&report.made.replicas, lowest).is_some() {
        chart.series.extend(bands(report));
        caption = caption.say(format!(
            "Lines: between them lie 95 % of {replicas} replicas of the series, which carry the noise of the data, relative to it."
        ));
    }
    let rows = residuals()
        .map(|(point, residual)| cells![point.angular_frequency_rad_per_s, residual.0, residual.1]);
    let columns = [
        "angular_frequency_rad_per_s",
        "storage_relative_difference",
        "loss_relative_difference",
    ];
    Figure {
        name: "fit-residual",
        picture: chart.into(),
        caption,
        data: csv(&columns, rows),
    }
}

/// Lower and upper ends of the bands of both moduli, in per cent of the fit.
fn bands(report: &DynamicReport<'_>) -> Vec<Series> {
    let [mut storage, mut loss] = [[Vec::new(), Vec::new()], [Vec::new(), Vec::new()]];
    for omega in frequencies(report) {
        let own = report.relaxation().complex_modulus(omega);
        let band = Band::of(&report.made.replicas, omega);
        let place = |end: Option<f64>, own: f64| {
            let relative = 100.0 * (end? / own - 1.0);
            (own > 0.0).then_some((omega, relative))
        };
        storage[0].push(place(band.map(|b| b.storage_pa.0), own.re));
        storage[1].push(place(band.map(|b| b.storage_pa.1), own.re));
        loss[0].push(place(band.map(|b| b.loss_pa.0), own.im));
        loss[1].push(place(band.map(|b| b.loss_pa.1), own.im));
    }
    let storage = storage.map(Series::line);
    let loss = loss.map(|ends| Series::line(ends).color(1).style(LineStyle::Dashed));
    storage.into_iter().chain(loss).collect()
}
