//! Phase angle over the magnitude of the complex modulus: free of the frequency, so that isotherms of a thermorheologically simple
//! material lie on one curve before any shift (M. van Gurp and J. Palmen, Rheol. Bull. 67 (1998) 5).

use num_complex::Complex;

use super::{caption, coloured, frequencies, temperatures};
use crate::material::dynamic::DynamicPoint;
use crate::report::chart::{Axis, Chart, Color, Marker, Series};
use crate::report::dynamic::DynamicReport;
use crate::report::dynamic::tables::celsius;
use crate::report::figure::{Figure, axis};
use crate::report::number::{prefix, range, scientific};
use crate::report::table::{cells, csv};

/// Magnitudes that vary by more than this have a logarithmic axis.
const WIDE: f64 = 5.0;

/// The figure, of the points as measured.
pub(super) fn figure(report: &DynamicReport<'_>) -> Figure {
    let symbol = report.symbol();
    let points: Vec<DynamicPoint> = report.data.points().copied().collect();
    let norms = range(points.iter().map(|p| polar(p)[0]));
    let (factor, unit) = prefix(norms.1);
    let symbols = coloured(report, &points, Marker::Disc, |point| {
        let [norm, angle_deg] = polar(point);
        (norm > 0.0).then_some((factor * norm, angle_deg))
    });
    let series = frequencies(report).into_iter().map(|omega| {
        let modulus = report.relaxation().complex_modulus(omega);
        let norm = factor * modulus.norm();
        (norm > 0.0).then_some((norm, modulus.arg().to_degrees()))
    });
    let series = Series::line(series).color(Color::Rgb(0x1A, 0x1A, 0x1A));
    let label = format!("magnitude of the complex modulus |{symbol}*| / {unit}Pa");
    let mut chart = Chart::new(axis(norms, WIDE, label), Axis::linear("phase angle δ / °"))
        .all_series(symbols)
        .series(series.label("series"));
    chart.color_scale = temperatures(report);
    let simplicity = report.made.master.as_ref().and_then(|m| m.simplicity);
    let rows = points.iter().map(|point| {
        let [norm, angle_deg] = polar(point);
        cells![
            point.temperature_k.map(celsius),
            point.angular_frequency_rad_per_s,
            norm,
            angle_deg,
        ]
    });
    let columns = [
        "temperature_c",
        "angular_frequency_rad_per_s",
        "complex_modulus_pa",
        "phase_angle_deg",
    ];
    Figure {
        name: "van-gurp-palmen",
        picture: chart.into(),
        caption: caption(
            report,
            &format!("Phase angle δ over magnitude of the complex modulus |{symbol}*| as measured (van Gurp–Palmen diagram)"),
        )
        .say_all(simplicity.map(|simplicity| {
            format!(
                "Distance of the isotherms from one curve: {} times the noise.",
                scientific(simplicity, 2)
            )
        })),
        data: csv(&columns, rows),
    }
}

/// Magnitude (Pa) and phase angle (degrees).
fn polar(point: &DynamicPoint) -> [f64; 2] {
    let modulus = Complex::new(point.storage_modulus_pa, point.loss_modulus_pa);
    [modulus.norm(), modulus.arg().to_degrees()]
}
