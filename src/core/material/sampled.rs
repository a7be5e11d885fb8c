//! A material known by its samples alone, without a series: for the direct hereditary sum.

use super::MaterialError;
use super::interpolant::Interpolant;
use super::tabulated::Tabulated;

/// Samples of a creep compliance or relaxation modulus, with a Poisson ratio that does not depend on time.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    name: Option<String>,
    poisson_ratio: f64,
    table: Tabulated,
    compliance: Interpolant,
}

impl Sampled {
    /// A material that is what the table says.
    ///
    /// # Errors
    /// As [`Tabulated::contact_compliance`].
    pub fn new(table: Tabulated, poisson_ratio: f64) -> Result<Self, MaterialError> {
        Ok(Self {
            name: None,
            poisson_ratio,
            compliance: table.contact_compliance(poisson_ratio)?,
            table,
        })
    }

    /// The same material under a name.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self {
            name: Some(name.into()),
            ..self
        }
    }

    /// The name, if it has one.
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// Poisson ratio, constant in time.
    pub fn poisson_ratio(&self) -> f64 {
        self.poisson_ratio
    }

    /// The samples.
    pub fn table(&self) -> &Tabulated {
        &self.table
    }

    /// The contact compliance C(t), in 1/Pa: through the samples between the first and the last of them, and held outside.
    pub fn contact_compliance(&self) -> &Interpolant {
        &self.compliance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{MaterialFunction, ModulusKind};

    #[test]
    fn its_contact_compliance_is_that_of_the_table_at_its_poisson_ratio() {
        let (times, values) = (vec![0.0, 1.0, 10.0, 100.0], vec![1e-9, 2e-9, 3e-9, 4e-9]);
        let table =
            Tabulated::new(MaterialFunction::Creep, ModulusKind::Shear, times, values).unwrap();
        let material = Sampled::new(table.clone(), 0.25).unwrap().named("gel");
        assert_eq!(material.name(), Some("gel"));
        // (1 - nu) J / 2
        assert_eq!(material.contact_compliance().value(10.0), 0.375 * 3e-9);
        assert!(Sampled::new(table, 0.6).is_err());
    }
}
