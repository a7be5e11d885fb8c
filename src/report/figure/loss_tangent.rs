//! Loss tangent over angular frequency: a ratio, from which the contact radius of the indentation formula drops out.

use num_complex::Complex;

use super::Figure;
use super::equivalent::{self, Equivalent};
use crate::report::ReportError;
use crate::report::chart::{Axis, Chart, Series};

/// The figure: loops as symbols, the material as a line.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(equivalent: &Equivalent<'_>) -> Result<Figure, ReportError> {
    let own = equivalent.own.iter();
    let own = own.map(|(omega, modulus)| (*omega, tangent(*modulus)));
    let loops = equivalent.loops.iter();
    let loops = loops.map(|at| (at.omega(), at.loss_pa / at.storage_pa));
    let mut chart = Chart::new(
        Axis::log("angular frequency ω / rad·s⁻¹"),
        Axis::linear("loss tangent tan δ = E″/E′"),
    )
    .series(Series::line(own).label("material"))
    .series(Series::scatter(loops).label("from the loops").color(1));
    chart.title.clone_from(&equivalent.title);
    Ok(Figure {
        name: "loss-tangent",
        picture: chart.into(),
        data: equivalent::pairs(
            "loss-tangent.csv",
            equivalent,
            &equivalent.own,
            ["loss_tangent", "phase_angle_deg"],
            |modulus| [tangent(modulus), modulus.arg().to_degrees()],
        )?,
    })
}

fn tangent(modulus: Complex<f64>) -> f64 {
    modulus.im / modulus.re
}
