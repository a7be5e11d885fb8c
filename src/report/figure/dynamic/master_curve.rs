//! The isotherms on one curve, each point in the colour of the temperature at which it was measured.

use super::{
    LOSS, Part, STORAGE, caption, coloured, frequency, legend_of_marker, temperatures, units,
};
use crate::report::chart::Color;
use crate::report::dynamic::DynamicReport;
use crate::report::figure::Figure;
use crate::report::figure::plot::Plot;
use crate::report::figure::quantity::MODULUS;

/// The figure; its data are `master.csv`. `None` without a master curve.
pub(super) fn figure(report: &DynamicReport<'_>) -> Option<Figure> {
    let master = report.made.master.as_ref()?;
    let symbol = report.symbol();
    let symbols = |part: Part| {
        coloured(report, &master.points, part.marker, |point| {
            part.point(point)
        })
    };
    let legend = |part: Part| legend_of_marker(part.label(report), part.marker);
    let curve = |part: Part| part.curve(report).color(Color::Rgb(0x1A, 0x1A, 0x1A));
    let plot = Plot {
        color_scale: temperatures(report),
        ..Plot::new(frequency(report), MODULUS)
            .traces([STORAGE, LOSS].map(symbols).concat())
            .traces([STORAGE, LOSS].map(legend))
            .traces([STORAGE, LOSS].map(curve))
    };
    let caption = caption(
        report,
        &format!(
            "Master curve of storage modulus {symbol}′ and loss modulus {symbol}″, coloured by temperature"
        ),
    );
    Some(Figure::of("master-curve", &[plot], caption, &units(report)).without_data())
}
