//! What the fitted series misses of each point, and the band of its replicas.

use crate::material::dynamic::replicas::{self, SIMULTANEOUS_DEVIATIONS};

use super::{LOSS, Part, STORAGE, caption, frequencies, frequency, frequency_title, unit};
use crate::report::chart::{Axis, Chart, Color, Series};
use crate::report::dynamic::{Band, DynamicReport};
use crate::report::figure::Figure;
use crate::report::table::{cells, csv};

/// The figure.
pub(super) fn figure(report: &DynamicReport<'_>) -> Figure {
    let symbol = report.symbol();
    let points = report.points();
    let residuals = || points.iter().zip(&report.made.fit.residuals);
    let measured = |part: Part, value: fn(&(f64, f64)) -> f64| {
        let places = residuals().map(|(p, r)| (frequency(report, p), 100.0 * value(r)));
        Series::scatter(places)
            .marker(part.marker)
            .color(part.color)
            .label(part.label(report))
    };
    let (lowest, highest) = report.made.fit.window_rad_per_s;
    let mut chart = Chart::new(
        Axis::log(frequency_title(report)),
        Axis::linear("difference fit − data / % of the data"),
    )
    .series(
        Series::line([lowest, highest].map(|omega| (unit(report).of(omega), 0.0)))
            .color(Color::Rgb(0x40, 0x40, 0x40)),
    )
    .series(measured(STORAGE, |r| r.0))
    .series(measured(LOSS, |r| r.1));
    let mut caption = caption(
        report,
        &format!("Relative difference of the fitted series from the data, {symbol}′ and {symbol}″"),
    );
    let samples = report.made.replicas.len();
    if Band::of(report.made, lowest, replicas::band).is_some() {
        chart.series.extend(bands(report));
        caption = caption.say(format!(
            "Shaded: simultaneous 95 % bands of the curves: {SIMULTANEOUS_DEVIATIONS} times the root mean square difference that \
             {samples} bootstrap samples make, series fitted to the same data with other noise."
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

/// The bands of both moduli, in per cent of the fit.
fn bands(report: &DynamicReport<'_>) -> [Series; 2] {
    let [mut storage, mut loss] = [Vec::new(), Vec::new()];
    for omega in frequencies(report) {
        let own = report.relaxation().complex_modulus(omega);
        let Some(band) = Band::of(report.made, omega, replicas::band) else {
            continue;
        };
        let relative = |half_pa: f64, own_pa: f64| {
            let half = 100.0 * half_pa / own_pa;
            half.is_finite()
                .then_some((unit(report).of(omega), -half, half))
        };
        storage.extend(relative(band.storage_pa, own.re));
        loss.extend(relative(band.loss_pa, own.im));
    }
    let [storage, loss] = [storage, loss].map(Series::band);
    [
        loss.color(1).label("band of the loss modulus"),
        storage.label("band of the storage modulus"),
    ]
}
