//! Storage and loss modulus over the reduced frequency, with the series fitted to them.

use super::{LOSS, Part, STORAGE, caption, frequencies, frequency, frequency_title};
use crate::material::dynamic::replicas;
use crate::report::chart::{Axis, Chart, Series};
use crate::report::dynamic::{Band, DynamicReport};
use crate::report::figure::Figure;
use crate::report::number::{largest, prefix, scientific};
use crate::report::table::{cells, csv};

/// The figure; its data are the curve, since the points are in `master.csv`.
pub(super) fn figure(report: &DynamicReport<'_>) -> Figure {
    let points = report.points();
    let symbol = report.symbol();
    let (factor, unit) = prefix(largest(points.iter().map(|p| p.storage_modulus_pa)));
    let curve = |part: Part| part.curve(report, factor, "fit").color(part.color);
    let measured = |part: Part| {
        let places = points
            .iter()
            .map(|p| (frequency(report, p), factor * (part.of_point)(p)));
        Series::scatter(places)
            .spaced()
            .marker(part.marker)
            .color(part.color)
            .label(part.label(report))
    };
    let chart = Chart::new(
        Axis::log(frequency_title(report)),
        Axis::log(format!("modulus / {unit}Pa")),
    )
    .all_series([STORAGE, LOSS].map(curve))
    .all_series([STORAGE, LOSS].map(measured));
    let branches = report.relaxation().branches().len();
    let percent = |share: f64| scientific(100.0 * share, 2);
    let fit = &report.made.fit;
    Figure {
        name: "fit",
        picture: chart.into(),
        caption: caption(
            report,
            &format!("Storage modulus {symbol}′ and loss modulus {symbol}″, data and the series fitted to them"),
        )
        .say(format!(
            "{branches} branches; misfit relative to the data {} % rms of {symbol}′ and {} % rms of {symbol}″.",
            percent(fit.storage_rms),
            percent(fit.loss_rms)
        ))
        .say("Symbols that would touch are left out; all points are in the figure of the residuals."),
        data: data(report),
    }
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
