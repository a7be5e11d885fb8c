//! Random solids and the contacts they are tried in: the same on every machine.

use std::sync::Arc;

use contact_dma::indenter::{Cone, FlatPunch, Indenter, Sphere};
use contact_dma::material::{Material, ModulusKind, Relaxation, RelaxationBranch};

/// SplitMix64 (G. L. Steele, D. Lea and C. H. Flood, OOPSLA 2014): the same numbers on every machine.
pub struct Random(pub u64);

impl Random {
    /// Uniform between 0 and 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn power_of_ten(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.between(low, high))
    }

    /// Mean zero, variance one: the sum of twelve uniform deviates, whose tails end at six.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }

    /// A whole number from `low` to `high`.
    pub fn count(&mut self, low: usize, high: usize) -> usize {
        low + (self.unit() * (high - low + 1) as f64) as usize
    }
}

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
    let branches = weights
        .iter()
        .map(|weight| RelaxationBranch {
            modulus_pa: 1e6 * (ratio - 1.0) * weight / sum,
            time_s: 10_f64.powf(first + decades * random.unit()),
        })
        .collect();
    let relaxation = Relaxation::new(1e6, branches).unwrap();
    Material::from_relaxation(relaxation, ModulusKind::Longitudinal, 0.45).unwrap()
}

/// Nine angular frequencies about the spectrum of a solid, from a tenth of its slowest retardation to ten times its fastest
/// relaxation rate.
pub fn frequencies(material: &Material) -> Vec<f64> {
    let slowest = material.creep().branches().last().unwrap().time_s;
    let relaxation = material.relaxation().unwrap();
    let fastest = relaxation
        .branches()
        .iter()
        .map(|b| b.time_s)
        .fold(f64::INFINITY, f64::min);
    let (low, high) = ((0.1 / slowest).ln(), (10.0 / fastest).ln());
    (0..9)
        .map(|k| (low + (high - low) * f64::from(k) / 8.0).exp())
        .collect()
}

pub fn shape(random: &mut Random) -> Arc<dyn Indenter> {
    match random.count(0, 2) {
        0 => Arc::new(Sphere::new(0.01).unwrap()),
        1 => Arc::new(Cone::new(1.2).unwrap()),
        _ => Arc::new(FlatPunch::new(1e-3).unwrap()),
    }
}
