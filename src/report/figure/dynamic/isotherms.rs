//! The isotherms as they were measured: storage modulus above, loss modulus below.

use super::{caption, coloured, temperatures};
use crate::material::dynamic::DynamicPoint;
use crate::report::chart::{Axis, Chart, LineStyle, Marker, Series};
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
    let panel = |x_label: &str, y_label: String, value: fn(&DynamicPoint) -> f64| {
        let (factor, unit) = prefix(largest(points.iter().map(value)));
        let series = coloured(report, &points, Marker::Disc, |p| {
            Some((p.angular_frequency_rad_per_s, factor * value(p)))
        });
        let lines = series.into_iter().map(|series| Series {
            line: Some(LineStyle::Solid),
            ..series
        });
        let axes = (
            Axis::log(x_label),
            Axis::log(format!("{y_label} / {unit}Pa")),
        );
        Chart::new(axes.0, axes.1)
            .all_series(lines)
            .color_scale(scale.clone())
            .size(800, 430)
    };
    let panels = vec![
        panel("", format!("storage modulus {symbol}′"), |p| {
            p.storage_modulus_pa
        }),
        panel(
            "angular frequency ω / rad·s⁻¹",
            format!("loss modulus {symbol}″"),
            |p| p.loss_modulus_pa,
        ),
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
                "Storage modulus {symbol}′ and loss modulus {symbol}″ as measured, over angular frequency ω"
            ),
        ),
        data: csv(&columns, rows),
    })
}
