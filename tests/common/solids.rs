//! Random solids and the contacts they are tried in: the same on every machine.

use std::sync::Arc;

use contact_dma::indenter::Indenter;
use contact_dma::material::Material;

use super::random::Random;
use super::{cone, material_of, punch, series, sphere};

/// A solid through its glass transition: 1 to 12 branches over up to 12 decades, modulus ratio 1.6 to 10,000.
pub fn solid(random: &mut Random) -> Material {
    solid_of_ratio(random, 4.0)
}

/// The same, with a modulus ratio of up to this power of ten.
pub fn solid_of_ratio(random: &mut Random, decades_of_ratio: f64) -> Material {
    let count = random.count(1, 12);
    let ratio = random.power_of_ten(0.2, decades_of_ratio);
    let decades = random.between(0.0, 12.0);
    let first = random.between(-6.0, 2.0);
    let weights: Vec<f64> = (0..count).map(|_| random.power_of_ten(-1.5, 0.0)).collect();
    let sum: f64 = weights.iter().sum();
    let branches = weights.iter().map(|weight| {
        let time_s = 10_f64.powf(first + decades * random.unit());
        (1e6 * (ratio - 1.0) * weight / sum, time_s)
    });
    let branches: Vec<_> = branches.collect();
    material_of(series(1e6, &branches), 0.45)
}

/// So many branches of as much, `decades` apart but for a part of a decade, whose moduli add up to `ratio` times the modulus at rest.
pub fn spread_solid(
    random: &mut Random,
    count: usize,
    (equilibrium_pa, ratio): (f64, f64),
    (decades, part): (f64, f64),
) -> Material {
    let modulus_pa = equilibrium_pa * ratio / count as f64;
    let time = |i: usize, random: &mut Random| decades * (i as f64 + random.between(-part, part));
    let branches: Vec<_> = (0..count)
        .map(|i| (modulus_pa, 10_f64.powf(time(i, random))))
        .collect();
    material_of(series(equilibrium_pa, &branches), 0.4)
}

/// Nine angular frequencies about the spectrum of a solid, from a tenth of its slowest retardation to ten times its fastest
/// relaxation rate.
pub fn frequencies(material: &Material) -> Vec<f64> {
    let slowest = material.creep().branches().last().unwrap().time_s;
    let times = material.relaxation().unwrap().branches().iter();
    let fastest = times.map(|b| b.time_s).fold(f64::INFINITY, f64::min);
    super::log_spaced(0.1 / slowest, 10.0 / fastest, 9)
}

pub fn shape(random: &mut Random) -> Arc<dyn Indenter> {
    match random.count(0, 2) {
        0 => sphere(0.01),
        1 => cone(1.2),
        _ => punch(1e-3),
    }
}
