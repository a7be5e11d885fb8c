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
    if Band::of(report.made, lowest).is_some() {
        chart.series.extend(bands(report));
        caption = caption.say(format!(
            "Lines: the band of {replicas} replicas of the series, which carry the noise of the data."
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
        let band = Band::of(report.made, omega);
        let relative =
            |half: Option<f64>, own: f64| Some(100.0 * half? / own).filter(|r| r.is_finite());
        let of_storage = relative(band.map(|band| band.storage_pa), own.re);
        let of_loss = relative(band.map(|band| band.loss_pa), own.im);
        for (end, sign) in [-1.0, 1.0].into_iter().enumerate() {
            storage[end].push(of_storage.map(|half| (omega, sign * half)));
            loss[end].push(of_loss.map(|half| (omega, sign * half)));
        }
    }
    let storage = storage.map(Series::line);
    let loss = loss.map(|ends| Series::line(ends).color(1).style(LineStyle::Dashed));
    storage.into_iter().chain(loss).collect()
}
