//! The isotherms as they were measured: storage modulus above, loss modulus below.

use super::{
    LOSS, Part, STORAGE, caption, coloured, frequency, measured_frequency_title, temperatures, unit,
};
use crate::material::dynamic::DynamicPoint;
use crate::report::chart::{Axis, Chart, LineStyle, Marker};
use crate::report::dynamic::DynamicReport;
use crate::report::dynamic::tables::celsius;
use crate::report::figure::{Figure, Picture};
use crate::report::number::{largest, prefix};
use crate::report::table::{cells, csv};

/// The figure; `None` where there is one isotherm.
pub(super) fn figure(report: &DynamicReport<'_>) -> Option<Figure> {
    let scale = temperatures(report)?;
    let symbol = report.symbol();
    let points: Vec<DynamicPoint> = report.data.points().copied().collect();
    let panel = |x_label: &str, part: Part| {
        let (factor, unit) = prefix(largest(points.iter().map(part.of_point)));
        let series = coloured(report, &points, Marker::Disc, |p| {
            Some((frequency(report, p), factor * (part.of_point)(p)))
        });
        let lines = series
            .into_iter()
            .map(|series| series.style(LineStyle::Solid));
        let y_label = format!("{} / {unit}Pa", part.label(report));
        Chart::new(Axis::log(x_label), Axis::log(y_label))
            .all_series(lines)
            .color_scale(scale.clone())
            .size(800, 430)
    };
    let unit = unit(report);
    let words = format!("{} {}", unit.quantity(), unit.symbol());
    let panels = vec![
        panel("", STORAGE),
        panel(measured_frequency_title(report), LOSS),
    ];
    let rows = points.iter().map(|point| {
        cells![
            point.temperature_k.map(celsius),
            point.angular_frequency_rad_per_s,
            point.storage_modulus_pa,
            point.loss_modulus_pa,
        ]
    });
    let columns = [
        "temperature_c",
        "angular_frequency_rad_per_s",
        "storage_modulus_pa",
        "loss_modulus_pa",
    ];
    Some(Figure {
        name: "isotherms",
        picture: Picture(panels),
        caption: caption(
            report,
            &format!(
                "Storage modulus {symbol}′ and loss modulus {symbol}″ as measured, over {words}"
            ),
        ),
        data: csv(&columns, rows),
    })
}
