//! The isotherms as they were measured: storage modulus above, loss modulus below.

use super::{LOSS, Part, STORAGE, caption, coloured, temperatures, units};
use crate::material::dynamic::DynamicPoint;
use crate::report::chart::{LineStyle, Marker};
use crate::report::dynamic::DynamicReport;
use crate::report::figure::Figure;
use crate::report::figure::plot::Plot;
use crate::report::figure::quantity::{
    LOSS_MODULUS, Quantity, STORAGE_MODULUS, Spread, TEMPERATURE,
};

/// The figure; `None` where there is one isotherm.
pub(super) fn figure(report: &DynamicReport<'_>) -> Option<Figure> {
    let scale = temperatures(report)?;
    let (symbol, units) = (report.symbol(), units(report));
    let points: Vec<DynamicPoint> = report.data.points().copied().collect();
    let frame = |quantity: Quantity, part: Part| {
        let symbols = coloured(report, &points, Marker::Disc, |point| part.point(point));
        let lines = symbols
            .into_iter()
            .map(|trace| trace.style(LineStyle::Solid));
        let plot = Plot::new(
            Quantity::frequency(&units),
            quantity.spread(Spread::Log).called(part.label(report)),
        );
        Plot {
            color_scale: Some(scale.clone()),
            ..plot.family(TEMPERATURE).traces(lines).height(430)
        }
    };
    let frames = [frame(STORAGE_MODULUS, STORAGE), frame(LOSS_MODULUS, LOSS)];
    let caption = caption(
        report,
        &format!(
            "Storage modulus {symbol}′ and loss modulus {symbol}″ as measured, over {}",
            units.frequency_words()
        ),
    );
    Some(Figure::of("isotherms", &frames, caption, &units))
}
