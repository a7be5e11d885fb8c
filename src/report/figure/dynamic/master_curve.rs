//! The isotherms on one curve, each point in the colour of the temperature at which it was measured.

use super::{
    MARKERS, caption, coloured, frequencies, frequency_title, legend_of_marker, temperatures,
};
use crate::report::chart::{Axis, Chart, Color, LineStyle, Series};
use crate::report::dynamic::DynamicReport;
use crate::report::figure::Figure;
use crate::report::number::{largest, prefix};

/// The figure; its data are `master.csv`. `None` without a master curve.
pub(super) fn figure(report: &DynamicReport<'_>) -> Option<Figure> {
    let master = report.made.master.as_ref()?;
    let symbol = report.symbol();
    let points = &master.points;
    let (factor, unit) = prefix(largest(points.iter().map(|p| p.storage_modulus_pa)));
    let storage = coloured(report, points, MARKERS[0], |p| {
        Some((p.angular_frequency_rad_per_s, factor * p.storage_modulus_pa))
    });
    let loss = coloured(report, points, MARKERS[1], |p| {
        Some((p.angular_frequency_rad_per_s, factor * p.loss_modulus_pa))
    });
    let line = |part: fn((f64, f64)) -> f64| {
        let points = frequencies(report).into_iter().map(|omega| {
            let modulus = report.relaxation().complex_modulus(omega);
            let value = factor * part((modulus.re, modulus.im));
            (value > 0.0).then_some((omega, value))
        });
        Series::line(points.collect::<Vec<_>>()).color(Color::Rgb(0x1A, 0x1A, 0x1A))
    };
    let mut chart = Chart::new(
        Axis::log(frequency_title(report)),
        Axis::log(format!("modulus / {unit}Pa")),
    )
    .all_series(storage)
    .all_series(loss)
    .series(legend_of_marker(
        format!("storage modulus {symbol}′"),
        MARKERS[0],
    ))
    .series(legend_of_marker(
        format!("loss modulus {symbol}″"),
        MARKERS[1],
    ))
    .series(line(|m| m.0).label(format!("series {symbol}′")))
    .series(
        line(|m| m.1)
            .label(format!("series {symbol}″"))
            .style(LineStyle::Dashed),
    );
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
