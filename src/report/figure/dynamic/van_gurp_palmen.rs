//! Phase angle over the magnitude of the complex modulus: free of the frequency, so that isotherms of a thermorheologically simple
//! material lie on one curve before any shift (M. van Gurp and J. Palmen, Rheol. Bull. 67 (1998) 5).

use num_complex::Complex;

use super::{caption, coloured, frequencies, temperatures, units};
use crate::material::dynamic::DynamicPoint;
use crate::report::chart::{Color, Marker};
use crate::report::dynamic::DynamicReport;
use crate::report::figure::Figure;
use crate::report::figure::plot::Plot;
use crate::report::figure::quantity::{COMPLEX_MODULUS, PHASE_ANGLE, TEMPERATURE};
use crate::report::figure::trace::{Point, Trace};
use crate::report::number::scientific;

/// The figure, of the points as measured.
pub(super) fn figure(report: &DynamicReport<'_>) -> Figure {
    let symbol = report.symbol();
    let points: Vec<DynamicPoint> = report.data.points().copied().collect();
    let place = |modulus: Complex<f64>| Point::new(modulus.norm(), modulus.arg());
    let symbols = coloured(report, &points, Marker::Disc, |point| {
        place(Complex::new(
            point.storage_modulus_pa,
            point.loss_modulus_pa,
        ))
    });
    let series = frequencies(report).into_iter();
    let series = series.map(|omega| place(report.relaxation().complex_modulus(omega)));
    let series = Trace::line(series).color(Color::Rgb(0x1A, 0x1A, 0x1A));
    let words = format!("magnitude of the complex modulus |{symbol}*|");
    let plot = Plot {
        color_scale: temperatures(report),
        ..Plot::new(COMPLEX_MODULUS.called(words), PHASE_ANGLE)
            .family(TEMPERATURE)
            .traces(symbols)
            .traces([series.label("series")])
    };
    let simplicity = report.made.master.as_ref().and_then(|m| m.simplicity);
    let caption = caption(
        report,
        &format!("Phase angle φ over magnitude of the complex modulus |{symbol}*| as measured (van Gurp–Palmen diagram)"),
    )
    .say_all(simplicity.map(|simplicity| {
        format!(
            "Distance of the isotherms from one curve: {} times the noise.",
            scientific(simplicity, 2)
        )
    }));
    Figure::of("van-gurp-palmen", &[plot], caption, &units(report))
}
