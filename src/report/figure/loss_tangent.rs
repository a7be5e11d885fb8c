//! Loss tangent over angular frequency: a ratio, from which the contact radius of the indentation formula drops out.

use num_complex::Complex;

use super::Figure;
use super::equivalent::{Diagram, Equivalent};
use super::units::Units;
use crate::report::chart::Axis;

/// The figure: loops as symbols, the material as a line.
pub fn figure(equivalent: &Equivalent<'_>, units: &Units) -> Figure {
    let to_omega = units.frequency().0;
    let diagram = Diagram {
        name: "loss-tangent",
        shows: &format!("Loss tangent E″/E′ over {}", units.frequency_words()),
        x: Axis::log(units.frequency_title()),
        y: Axis::linear("loss tangent tan δ = E″/E′"),
        own: &equivalent.own,
        place: &|omega, modulus| Some((to_omega * omega, tangent(modulus))),
        numbers: |modulus| [tangent(modulus), modulus.arg().to_degrees()],
        columns: ["loss_tangent", "phase_angle_deg"],
    };
    diagram.figure(equivalent, units.frequency_unit())
}

fn tangent(modulus: Complex<f64>) -> f64 {
    modulus.im / modulus.re
}
