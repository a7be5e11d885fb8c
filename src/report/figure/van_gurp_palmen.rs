//! Phase angle against the magnitude of the complex modulus: free of the frequency, so that errors of a time scale do not show
//! and others do (M. van Gurp and J. Palmen, Rheol. Bull. 67 (1998) 5).

use num_complex::Complex;

use super::equivalent::{Diagram, Equivalent};
use super::units::Units;
use super::{Figure, axis};
use crate::report::chart::Axis;
use crate::report::number::range;

/// Magnitudes that vary by more than this have a logarithmic axis.
const WIDE: f64 = 5.0;

/// The figure: loops as symbols, the material as a line.
pub fn figure(equivalent: &Equivalent<'_>, units: &Units) -> Figure {
    let loops = equivalent.loops.iter().map(|at| at.modulus().norm());
    let own = equivalent
        .own_beyond
        .iter()
        .map(|(_, modulus)| modulus.norm());
    let norms = range(own.chain(loops));
    let (factor, unit) = units.modulus(norms.1);
    let label = format!("magnitude of the complex modulus |E*| / {unit}");
    let diagram = Diagram {
        name: "van-gurp-palmen",
        shows: "Phase angle δ over magnitude of the complex modulus |E*| (van Gurp–Palmen diagram)",
        x: axis(norms, WIDE, label),
        y: Axis::linear("phase angle δ / °"),
        own: &equivalent.own_beyond,
        place: &|_, modulus| {
            let [norm, angle_deg] = polar(modulus);
            (norm > 0.0).then_some((factor * norm, angle_deg))
        },
        numbers: polar,
        columns: ["complex_modulus_pa", "phase_angle_deg"],
    };
    diagram.figure(equivalent, units.frequency_unit())
}

/// Magnitude (Pa) and phase angle (degrees).
fn polar(modulus: Complex<f64>) -> [f64; 2] {
    [modulus.norm(), modulus.arg().to_degrees()]
}
