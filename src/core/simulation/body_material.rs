//! What the half-space of a single history is made of, and with it how its past is kept: a series, by a recursion, or samples,
//! by the direct sum over all that came before.

use crate::material::interpolant::Interpolant;
use crate::material::keys::{NAME, POISSON_RATIO};
use crate::material::sampled::Sampled;
use crate::material::tabulated::keys::{
    EVALUATION, Evaluation, QUANTITY, TABLE_MODULUS, TIMES, VALUES,
};
use crate::material::{Creep, Material, MaterialError};
use crate::quantity::setting::{Setting, Table};
use crate::sweep::plan::resolved;

/// The material of a history.
#[derive(Debug, Clone, PartialEq)]
pub enum BodyMaterial {
    /// A series; the cost of a step does not grow with their number.
    Series(Material),
    /// Samples as they are; the cost of N steps is of order N^2.
    Samples(Sampled),
}

impl From<Material> for BodyMaterial {
    fn from(material: Material) -> Self {
        Self::Series(material)
    }
}

impl From<Sampled> for BodyMaterial {
    fn from(material: Sampled) -> Self {
        Self::Samples(material)
    }
}

/// A contact compliance C(t) as a march takes it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Compliance {
    Series(Creep),
    Samples(Interpolant),
}

impl Compliance {
    /// The largest value (1/Pa) from the beginning to `end_s`: the last, since neither falls.
    pub(super) fn largest_per_pa(&self, end_s: f64) -> f64 {
        match self {
            Self::Series(creep) => creep.compliance(end_s),
            Self::Samples(curve) => curve.value(end_s),
        }
    }
}

impl BodyMaterial {
    /// The material as a series, where it is one.
    pub fn series(&self) -> Option<&Material> {
        match self {
            Self::Series(material) => Some(material),
            Self::Samples(_) => None,
        }
    }

    /// What the indenter is made of, where it is not rigid.
    pub fn indenter_material(&self) -> Option<&Material> {
        self.series()?.indenter_material()
    }

    /// Its Poisson ratio, where it is constant in time.
    pub fn poisson_ratio(&self) -> Option<f64> {
        match self {
            Self::Series(material) => material.poisson_ratio(),
            Self::Samples(sampled) => Some(sampled.poisson_ratio()),
        }
    }

    /// The same material under a name.
    pub fn named(self, name: impl Into<String>) -> Self {
        match self {
            Self::Series(material) => material.named(name).into(),
            Self::Samples(material) => material.named(name).into(),
        }
    }

    /// The same material, known to have been measured between these times (s); samples say that themselves.
    pub fn measured(mut self, window_s: (f64, f64)) -> Self {
        if let Self::Series(material) = &mut self {
            material.origin.measured_window_s = Some(window_s);
        }
        self
    }

    /// First and last time (s) at which the material was observed, where that is known.
    pub fn measured_window_s(&self) -> Option<(f64, f64)> {
        match self {
            Self::Series(material) => material.origin.measured_window_s,
            Self::Samples(sampled) => Some(sampled.table().window_s()),
        }
    }

    /// The contact compliance C(t).
    ///
    /// # Errors
    /// As [`Material::contact_compliance`].
    pub(super) fn compliance(&self) -> Result<Compliance, MaterialError> {
        Ok(match self {
            Self::Series(material) => Compliance::Series(material.contact_compliance()?),
            Self::Samples(sampled) => Compliance::Samples(sampled.contact_compliance().clone()),
        })
    }

    /// Refuses materials that cannot make a contact.
    ///
    /// # Errors
    /// As [`Material::contact_compliance`].
    pub fn check_contact(&self) -> Result<(), MaterialError> {
        self.compliance().map(drop)
    }

    /// The shortest time (s) on which the body answers: retardation under a load, relaxation under an approach, or that of the
    /// first sample. `None` for an elastic body.
    pub(super) fn shortest_time_s(&self) -> Option<f64> {
        match self {
            Self::Series(material) => {
                let retardation = material.creep().branches().iter().map(|b| b.time_s);
                let relaxation = material.relaxation().into_iter();
                let relaxation = relaxation.flat_map(|r| r.branches().iter().map(|b| b.time_s));
                retardation.chain(relaxation).min_by(f64::total_cmp)
            }
            Self::Samples(sampled) => sampled.contact_compliance().shortest_time_s(),
        }
    }

    /// The blocks of a scenario file that give the same material again; samples are written out.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Series(material) => resolved::material_text(material),
            Self::Samples(sampled) => samples_text(sampled),
        }
    }
}

fn samples_text(sampled: &Sampled) -> String {
    let table = sampled.table();
    let samples = Table::new("table")
        .and(QUANTITY.setting(table.function()))
        .and(TABLE_MODULUS.setting(table.kind()))
        .and(EVALUATION.setting(Evaluation::Direct))
        .and(TIMES.setting(table.times_s().to_vec()).map(Setting::bare))
        .and(VALUES.setting(table.values().to_vec()).map(Setting::bare));
    let material = Table::new("material")
        .and(NAME.setting(sampled.name().map(str::to_owned)))
        .and(POISSON_RATIO.setting(sampled.poisson_ratio()));
    material.above([samples]).toml()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::tabulated::Tabulated;
    use crate::material::{MaterialFunction, ModulusKind};

    #[test]
    fn the_compliance_of_noisy_samples_never_falls() {
        let times = vec![1.0, 10.0, 100.0, 1000.0];
        let values = vec![1e-9, 2e-9, 1.99e-9, 3e-9];
        let table =
            Tabulated::new(MaterialFunction::Creep, ModulusKind::Shear, times, values).unwrap();
        let body = BodyMaterial::from(Sampled::new(table, 0.5).unwrap());
        let compliance = body.compliance().unwrap();
        // C = J/4.
        // Where a sample falls below the one before, both are their mean: 1.995e-9. A mean and a product.
        assert!((compliance.largest_per_pa(100.0) / (0.25 * 1.995e-9) - 1.0).abs() < 1e-15);
        assert_eq!(compliance.largest_per_pa(0.1), 0.25 * 1e-9);
        assert_eq!(compliance.largest_per_pa(1e4), 0.25 * 3e-9);
        assert_eq!(body.shortest_time_s(), Some(1.0));
    }
}
