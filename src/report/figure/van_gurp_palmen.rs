//! Phase angle against the magnitude of the complex modulus: free of the frequency, so that errors of a time scale do not show
//! and others do (M. van Gurp and J. Palmen, Rheol. Bull. 67 (1998) 5).

use num_complex::Complex;

use super::Figure;
use super::equivalent::{self, Equivalent};
use super::units::Units;
use crate::report::ReportError;
use crate::report::chart::{Axis, Chart, Series};

/// Magnitudes that vary by more than this have a logarithmic axis.
const WIDE: f64 = 5.0;

/// The figure: loops as symbols, the material as a line.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(equivalent: &Equivalent<'_>, units: &Units) -> Result<Figure, ReportError> {
    let loops = || {
        let loops = equivalent.loops.iter();
        loops.map(|at| Complex::new(at.storage_pa, at.loss_pa))
    };
    let own = || equivalent.own_beyond.iter().map(|(_, modulus)| *modulus);
    let norms = || own().chain(loops()).map(Complex::norm);
    let (least, largest) = (
        norms().fold(f64::INFINITY, f64::min),
        norms().fold(0.0, f64::max),
    );
    let (factor, unit) = units.modulus(largest);
    let point = |modulus: Complex<f64>| {
        let [norm, angle_deg] = polar(modulus);
        (norm > 0.0).then_some((factor * norm, angle_deg))
    };
    let label = format!("magnitude of the complex modulus |E*| / {unit}");
    let x = if largest > WIDE * least && least > 0.0 {
        Axis::log(label)
    } else {
        Axis::linear(label)
    };
    let mut chart = Chart::new(x, Axis::linear("phase angle δ / °"))
        .series(Series::line(own().map(point)).label("material"))
        .series(
            equivalent::symbols(loops().map(point))
                .label("from the loops")
                .color(1),
        );
    chart.title.clone_from(&equivalent.title);
    Ok(Figure {
        name: "van-gurp-palmen",
        picture: chart.into(),
        caption: equivalent.caption(
            "Phase angle δ over magnitude of the complex modulus |E*| (van Gurp–Palmen diagram)",
        ),
        data: equivalent::pairs(
            "van-gurp-palmen.csv",
            equivalent,
            &equivalent.own_beyond,
            ["complex_modulus_pa", "phase_angle_deg"],
            polar,
        )?,
    })
}

/// Magnitude (Pa) and phase angle (degrees).
fn polar(modulus: Complex<f64>) -> [f64; 2] {
    [modulus.norm(), modulus.arg().to_degrees()]
}
