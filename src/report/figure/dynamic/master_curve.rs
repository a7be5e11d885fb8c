//! The isotherms on one curve, each point in the colour of the temperature at which it was measured.

use super::{
    LOSS, Part, STORAGE, caption, coloured, frequency, frequency_title, legend_of_marker,
    temperatures,
};
use crate::report::chart::{Axis, Chart, Color};
use crate::report::dynamic::DynamicReport;
use crate::report::figure::Figure;
use crate::report::number::{largest, prefix};

/// The figure; its data are `master.csv`. `None` without a master curve.
pub(super) fn figure(report: &DynamicReport<'_>) -> Option<Figure> {
    let master = report.made.master.as_ref()?;
    let symbol = report.symbol();
    let points = &master.points;
    let (factor, unit) = prefix(largest(points.iter().map(|p| p.storage_modulus_pa)));
    let symbols = |part: Part| {
        coloured(report, points, part.marker, |p| {
            Some((frequency(report, p), factor * (part.of_point)(p)))
        })
    };
    let legend = |part: Part| legend_of_marker(part.label(report), part.marker);
    let curve = |part: Part| {
        part.curve(report, factor, "series")
            .color(Color::Rgb(0x1A, 0x1A, 0x1A))
    };
    let mut chart = Chart::new(
        Axis::log(frequency_title(report)),
        Axis::log(format!("modulus / {unit}Pa")),
    )
    .all_series([STORAGE, LOSS].map(symbols).concat())
    .all_series([STORAGE, LOSS].map(legend))
    .all_series([STORAGE, LOSS].map(curve));
    chart.color_scale = temperatures(report);
    Some(Figure {
        name: "master-curve",
        picture: chart.into(),
        caption: caption(
            report,
            &format!(
                "Master curve of storage modulus {symbol}′ and loss modulus {symbol}″, coloured by temperature"
            ),
        ),
        data: Vec::new(),
    })
}
