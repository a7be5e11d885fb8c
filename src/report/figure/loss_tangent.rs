//! Loss tangent over angular frequency: a ratio, from which the contact radius of the indentation formula drops out.

use num_complex::Complex;

use super::Figure;
use super::equivalent::{self, Equivalent};
use super::units::Units;
use crate::report::chart::{Axis, Chart, Series};

/// The figure: loops as symbols, the material as a line.
pub fn figure(equivalent: &Equivalent<'_>, units: &Units) -> Figure {
    let to_omega = units.frequency().0;
    let own = equivalent.own.iter();
    let own = own.map(|(omega, modulus)| (to_omega * omega, tangent(*modulus)));
    let loops = equivalent.loops.iter();
    let loops = loops.map(|at| (to_omega * at.omega(), at.loss_pa / at.storage_pa));
    let mut chart = Chart::new(
        Axis::log(units.frequency_title()),
        Axis::linear("loss tangent tan δ = E″/E′"),
    )
    .series(Series::line(own).label("material"))
    .series(equivalent::symbols(loops).label("from the loops").color(1));
    chart.title.clone_from(&equivalent.title);
    let shows = format!("Loss tangent E″/E′ over {}", units.frequency_words());
    Figure {
        name: "loss-tangent",
        picture: chart.into(),
        caption: equivalent.caption(&shows),
        data: equivalent::pairs(
            equivalent,
            &equivalent.own,
            ["loss_tangent", "phase_angle_deg"],
            |modulus| [tangent(modulus), modulus.arg().to_degrees()],
            units,
        ),
    }
}

fn tangent(modulus: Complex<f64>) -> f64 {
    modulus.im / modulus.re
}
