//! What the fitted series misses of each point, and the band of its replicas.

use crate::material::dynamic::replicas::{self, SIMULTANEOUS_DEVIATIONS};

use super::{LOSS, Part, STORAGE, caption, frequencies, frequency, units};
use crate::report::dynamic::{Band, DynamicReport};
use crate::report::figure::Figure;
use crate::report::figure::plot::Plot;
use crate::report::figure::quantity::RESIDUAL;
use crate::report::figure::trace::{Point, Trace};
use crate::report::table::{cells, csv};

/// The figure.
pub(super) fn figure(report: &DynamicReport<'_>) -> Figure {
    let symbol = report.symbol();
    let points = report.points();
    let residuals = || points.iter().zip(&report.made.fit.residuals);
    let measured = |part: Part, value: fn(&(f64, f64)) -> f64| {
        Trace::symbols(residuals().map(|(p, r)| (p.angular_frequency_rad_per_s, value(r))))
            .marker(part.marker)
            .color(part.color)
            .label(part.label(report))
    };
    let (lowest, highest) = report.made.fit.window_rad_per_s;
    let mut plot = Plot::new(frequency(report), RESIDUAL).traces([
        Trace::guide([(lowest, 0.0), (highest, 0.0)]),
        measured(STORAGE, |r| r.0),
        measured(LOSS, |r| r.1),
    ]);
    let mut caption = caption(
        report,
        &format!("Relative difference of the fitted series from the data, {symbol}′ and {symbol}″"),
    );
    let samples = report.made.replicas.len();
    if Band::of(report.made, lowest, replicas::band).is_some() {
        plot = plot.traces(bands(report));
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
    Figure::of("fit-residual", &[plot], caption, &units(report)).with_data(csv(&columns, rows))
}

/// The bands of both moduli, relative to the fit.
fn bands(report: &DynamicReport<'_>) -> [Trace; 2] {
    let [mut storage, mut loss] = [Vec::new(), Vec::new()];
    for omega in frequencies(report) {
        let own = report.relaxation().complex_modulus(omega);
        let Some(band) = Band::of(report.made, omega, replicas::band) else {
            continue;
        };
        let relative = |half_pa: f64, own_pa: f64| {
            let half = half_pa / own_pa;
            half.is_finite()
                .then(|| Point::new(omega, None).band(Some((-half, half))))
        };
        storage.extend(relative(band.storage_pa, own.re));
        loss.extend(relative(band.loss_pa, own.im));
    }
    let band = |points: Vec<Point>, label: &str| Trace {
        band_label: Some(label.to_owned()),
        ..Trace::line(points)
    };
    [
        band(loss, "band of the loss modulus").color(1),
        band(storage, "band of the storage modulus"),
    ]
}
