//! Phase angle against the magnitude of the complex modulus: free of the frequency, so that errors of a time scale do not show
//! and others do (M. van Gurp and J. Palmen, Rheol. Bull. 67 (1998) 5).

use num_complex::Complex;

use super::equivalent::{self, Equivalent};
use super::units::Units;
use super::{Figure, axis};
use crate::report::chart::{Axis, Chart, Series};
use crate::report::number::range;

/// Magnitudes that vary by more than this have a logarithmic axis.
const WIDE: f64 = 5.0;

/// The figure: loops as symbols, the material as a line.
pub fn figure(equivalent: &Equivalent<'_>, units: &Units) -> Figure {
    let loops = || {
        let loops = equivalent.loops.iter();
        loops.map(|at| Complex::new(at.storage_pa, at.loss_pa))
    };
    let own = || equivalent.own_beyond.iter().map(|(_, modulus)| *modulus);
    let norms = range(own().chain(loops()).map(Complex::norm));
    let (factor, unit) = units.modulus(norms.1);
    let point = |modulus: Complex<f64>| {
        let [norm, angle_deg] = polar(modulus);
        (norm > 0.0).then_some((factor * norm, angle_deg))
    };
    let label = format!("magnitude of the complex modulus |E*| / {unit}");
    let mut chart = Chart::new(axis(norms, WIDE, label), Axis::linear("phase angle δ / °"))
        .series(Series::line(own().map(point)).label("material"))
        .series(
            equivalent::symbols(loops().map(point))
                .label("from the loops")
                .color(1),
        );
    chart.title.clone_from(&equivalent.title);
    Figure {
        name: "van-gurp-palmen",
        picture: chart.into(),
        caption: equivalent.caption(
            "Phase angle δ over magnitude of the complex modulus |E*| (van Gurp–Palmen diagram)",
        ),
        data: equivalent::pairs(
            equivalent,
            &equivalent.own_beyond,
            ["complex_modulus_pa", "phase_angle_deg"],
            polar,
            units,
        ),
    }
}

/// Magnitude (Pa) and phase angle (degrees).
fn polar(modulus: Complex<f64>) -> [f64; 2] {
    [modulus.norm(), modulus.arg().to_degrees()]
}
