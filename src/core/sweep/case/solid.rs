//! The body of a case: its contact compliance, and those of the bodies that the data leave possible beside it.

use crate::material::{Creep, Material, Relaxation};
use crate::sweep::case::SetupError;

/// A material as a case takes it.
#[derive(Debug)]
pub(in crate::sweep) struct Solid {
    /// C(t).
    pub compliance: Creep,
    /// Its inverse, unless the body answers an instant with no finite modulus.
    pub relaxation: Option<Relaxation>,
    /// Which part of each branch of it is the indenter's, where that is not rigid.
    pub shares_of_indenter: Vec<Option<f64>>,
    /// C after an infinite time.
    pub relaxed_per_pa: f64,
    /// C(t) of the solids that the data leave possible beside the material.
    pub alternatives: Vec<Creep>,
    /// C(t) of the replicas of the material; `None` in the place of one that flows, and so has no stabilised cycle.
    pub replicas: Vec<Option<Creep>>,
}

impl Solid {
    /// The solid that a material is.
    ///
    /// # Errors
    /// [`SetupError::Fluid`] for a material that is none, [`SetupError::Material`] for one that cannot make a contact.
    pub fn new(material: &Material) -> Result<Self, SetupError> {
        let compliance = material.contact_compliance()?;
        let relaxed = compliance.equilibrium_compliance();
        let solids = |others: &[Material]| -> Result<Vec<Option<Creep>>, SetupError> {
            let solid = |other: &Material| {
                let creep = other.contact_compliance()?;
                Ok(creep.equilibrium_compliance().is_some().then_some(creep))
            };
            others.iter().map(solid).collect()
        };
        let alternatives = solids(material.alternatives())?.into_iter().flatten();
        Ok(Self {
            relaxed_per_pa: relaxed.ok_or(SetupError::Fluid)?,
            relaxation: compliance.to_relaxation().ok(),
            compliance,
            shares_of_indenter: material.shares_of_indenter()?,
            alternatives: alternatives.collect(),
            replicas: solids(material.replicas())?,
        })
    }
}
