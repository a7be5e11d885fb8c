//! Loss modulus against storage modulus: each relaxation is an arc (K. S. Cole and R. H. Cole, J. Chem. Phys. 9 (1941) 341, for
//! permittivities).

use num_complex::Complex;

use super::Figure;
use super::equivalent::{self, Equivalent};
use super::units::Units;
use crate::report::chart::{Axis, Chart, Series};
use crate::report::number::largest;

/// The figure: loops as symbols, the material as a line.
pub fn figure(equivalent: &Equivalent<'_>, units: &Units) -> Figure {
    let moduli = || equivalent.own_beyond.iter().map(|(_, modulus)| modulus);
    let (to_storage, storage) = units.modulus(largest(moduli().map(|m| m.re)));
    let (to_loss, loss) = units.modulus(largest(moduli().map(|m| m.im)));
    let line = moduli().map(|m| (to_storage * m.re, to_loss * m.im));
    let loops = equivalent.loops.iter();
    let loops = loops.map(|at| (to_storage * at.storage_pa, to_loss * at.loss_pa));
    let mut chart = Chart::new(
        Axis::linear(format!("storage modulus E′ / {storage}")),
        Axis::linear(format!("loss modulus E″ / {loss}")),
    )
    .series(Series::line(line).label("material"))
    .series(equivalent::symbols(loops).label("from the loops").color(1));
    chart.title.clone_from(&equivalent.title);
    let pair = |modulus: Complex<f64>| [modulus.re, modulus.im];
    Figure {
        name: "cole-cole",
        picture: chart.into(),
        caption: equivalent.caption("Loss modulus E″ over storage modulus E′ (Cole–Cole diagram)"),
        data: equivalent::pairs(
            equivalent,
            &equivalent.own_beyond,
            ["storage_modulus_pa", "loss_modulus_pa"],
            pair,
            units,
        ),
    }
}
