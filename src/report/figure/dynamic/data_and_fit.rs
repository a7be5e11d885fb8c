//! Storage and loss modulus over the reduced frequency, with the series fitted to them.

use super::{LOSS, Part, STORAGE, caption, frequencies, frequency, units};
use crate::material::dynamic::replicas;
use crate::report::dynamic::{Band, DynamicReport};
use crate::report::figure::Figure;
use crate::report::figure::plot::Plot;
use crate::report::figure::quantity::MODULUS;
use crate::report::figure::trace::Trace;
use crate::report::number::scientific;
use crate::report::table::{cells, csv};

/// The figure; its data are the curve, since the points are in `master.csv`.
pub(super) fn figure(report: &DynamicReport<'_>) -> Figure {
    let points = report.points();
    let symbol = report.symbol();
    let curve = |part: Part| part.curve(report).color(part.color);
    let measured = |part: Part| {
        Trace::symbols(points.iter().map(|point| part.point(point)))
            .spaced()
            .marker(part.marker)
            .color(part.color)
            .label(part.called(report, "measured"))
    };
    let plot = Plot::new(frequency(report), MODULUS)
        .traces([STORAGE, LOSS].map(curve))
        .traces([STORAGE, LOSS].map(measured));
    let branches = report.relaxation().branches().len();
    let percent = |share: f64| scientific(100.0 * share, 2);
    let fit = &report.made.fit;
    let caption = caption(
        report,
        &format!("Storage modulus {symbol}′ and loss modulus {symbol}″, data and the series fitted to them"),
    )
    .say(format!(
        "{branches} branches; misfit relative to the data {} % rms of {symbol}′ and {} % rms of {symbol}″.",
        percent(fit.storage_rms),
        percent(fit.loss_rms)
    ))
    .say("Symbols that would touch are left out; all points are in the figure of the residuals.");
    Figure::of("fit", &[plot], caption, &units(report)).with_data(data(report))
}

fn data(report: &DynamicReport<'_>) -> Vec<u8> {
    let rows = frequencies(report).into_iter().map(|omega| {
        let modulus = report.relaxation().complex_modulus(omega);
        let band = Band::of(report.made, omega, replicas::error);
        cells![
            omega,
            modulus.re,
            modulus.im,
            band.map(|band| band.storage_pa),
            band.map(|band| band.loss_pa),
        ]
    });
    let columns = [
        "angular_frequency_rad_per_s",
        "storage_fit_pa",
        "loss_fit_pa",
        "storage_fit_material_error_pa",
        "loss_fit_material_error_pa",
    ];
    csv(&columns, rows)
}
