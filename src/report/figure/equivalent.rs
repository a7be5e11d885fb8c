//! The equivalent moduli of loops beside the material's own.

use num_complex::Complex;

use super::curve::SweepCurves;
use crate::material::Material;
use crate::report::number::{largest, scientific};
use crate::sweep::record::CaseRecord;
use crate::sweep::record::error_bars::Quantity;

/// What indentation reads from one loop, and what it stands for.
#[derive(Debug, Clone, Copy)]
pub struct LoopModulus<'a> {
    pub record: &'a CaseRecord,
    /// Read from the loop (Pa).
    pub modulus_pa: Complex<f64>,
    /// The material's longitudinal complex modulus (Pa).
    pub own_pa: Complex<f64>,
}

/// Frequency (rad/s) and complex modulus (Pa).
pub type Line = Vec<(f64, Complex<f64>)>;

/// The moduli of a material between two frequencies.
pub fn line(material: &Material, first: f64, last: f64) -> Line {
    let count = (30.0 * (last / first).log10()).ceil().clamp(100.0, 1000.0) as usize;
    (0..=count)
        .map(|k| first * (last / first).powf(k as f64 / count as f64))
        .map(|omega| (omega, material.longitudinal_complex_modulus(omega)))
        .collect()
}

/// The largest differences of storage and loss modulus from the material's, in percent of these.
pub fn largest_differences<'a, I>(loops: impl Fn() -> I) -> [String; 2]
where
    I: Iterator<Item = &'a LoopModulus<'a>>,
{
    let storage = largest(loops().map(|at| at.storage_difference().abs()));
    let losses = loops().filter_map(LoopModulus::loss_difference);
    [storage, largest(losses.map(f64::abs))].map(|share| scientific(100.0 * share, 3))
}

impl<'a> LoopModulus<'a> {
    /// Of a case whose loop has moduli.
    pub fn of(sweep: &SweepCurves<'_>, record: &'a CaseRecord) -> Option<Self> {
        let result = record.result.as_ref()?;
        let material = &sweep.condition(record)?.contact.material;
        Some(Self {
            record,
            modulus_pa: Complex::new(result.storage_modulus_pa?, result.loss_modulus_pa?),
            own_pa: material.longitudinal_complex_modulus(record.angular_frequency_rad_per_s),
        })
    }

    /// Estimated errors (Pa) of storage and loss modulus.
    pub fn errors_pa(&self) -> [Option<f64>; 2] {
        let result = self.record.result.as_ref();
        let errors = result.and_then(|result| result.errors.as_ref());
        let moduli = [Quantity::StorageModulus, Quantity::LossModulus];
        moduli.map(|modulus| errors?.of(modulus))
    }

    /// By how much the storage modulus of the loop differs from the material's, relative to it.
    pub fn storage_difference(&self) -> f64 {
        self.modulus_pa.re / self.own_pa.re - 1.0
    }

    /// The same of the loss modulus; `None` where the material has none.
    pub fn loss_difference(&self) -> Option<f64> {
        (self.own_pa.im > 0.0).then(|| self.modulus_pa.im / self.own_pa.im - 1.0)
    }
}
