//! Loss modulus against storage modulus: each relaxation is an arc (K. S. Cole and R. H. Cole, J. Chem. Phys. 9 (1941) 341, for
//! permittivities).

use super::Figure;
use super::equivalent::{Diagram, Equivalent};
use super::units::Units;
use crate::report::chart::Axis;
use crate::report::number::largest;

/// The figure: loops as symbols, the material as a line.
pub fn figure(equivalent: &Equivalent<'_>, units: &Units) -> Figure {
    let moduli = || equivalent.own_beyond.iter().map(|(_, modulus)| modulus);
    let (to_storage, storage) = units.modulus(largest(moduli().map(|m| m.re)));
    let (to_loss, loss) = units.modulus(largest(moduli().map(|m| m.im)));
    let diagram = Diagram {
        name: "cole-cole",
        shows: "Loss modulus E″ over storage modulus E′ (Cole–Cole diagram)",
        x: Axis::linear(format!("storage modulus E′ / {storage}")),
        y: Axis::linear(format!("loss modulus E″ / {loss}")),
        own: &equivalent.own_beyond,
        place: &|_, modulus| Some((to_storage * modulus.re, to_loss * modulus.im)),
        numbers: |modulus| [modulus.re, modulus.im],
        columns: ["storage_modulus_pa", "loss_modulus_pa"],
    };
    diagram.figure(equivalent, units.frequency_unit())
}
