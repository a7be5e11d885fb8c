//! The body of a case: its contact compliance, and those of the bodies that the data leave possible beside it.

use crate::drive::Control;
use crate::material::{Creep, Material, Relaxation};
use crate::sweep::case::SetupError;

/// A material as a case takes it.
#[derive(Debug)]
pub(crate) struct Solid {
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

/// A number of a body at an angular frequency (rad/s) from which results of a cycle there follow.
type Response = fn(&Creep, f64) -> f64;

impl Solid {
    /// The alternatives that are farthest from the body in one of the numbers that a cycle at this angular frequency (rad/s) depends on:
    /// the loss at a small amplitude, how far the body yields within the cycle, at its mean, and at once. The largest of the differences
    /// that all alternatives make is made by one of these, and there may be many.
    pub fn farthest_alternatives(&self, omega: f64, control: Control) -> Vec<&Creep> {
        let loss: Response = match control {
            Control::Load => |creep, omega| -creep.complex_compliance(omega).im,
            Control::Approach => |creep, omega| creep.complex_compliance(omega).inv().im,
        };
        let responses: [Response; 4] = [
            loss,
            |creep, omega| creep.complex_compliance(omega).norm(),
            |creep, _| creep.equilibrium_compliance().unwrap_or(0.0),
            |creep, _| creep.instantaneous_compliance(),
        ];
        let mut farthest: Vec<usize> = Vec::new();
        for response in responses {
            let own = response(&self.compliance, omega);
            let off = |place: usize| (response(&self.alternatives[place], omega) - own).abs();
            let all = 0..self.alternatives.len();
            farthest.extend(all.max_by(|a, b| off(*a).total_cmp(&off(*b))));
        }
        farthest.sort_unstable();
        farthest.dedup();
        let places = farthest.into_iter();
        places.map(|place| &self.alternatives[place]).collect()
    }

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
        // The indenter's own differ from its material one at a time, as those of the body do.
        let indenter = material.indenter_material().into_iter();
        let indenters = indenter.flat_map(|indenter| &indenter.origin.alternatives);
        let with_other = |other: &Material| material.clone().against(other.clone());
        let mut alternatives = material.origin.alternatives.to_vec();
        alternatives.extend(indenters.map(with_other));
        let alternatives = solids(&alternatives)?.into_iter().flatten();
        Ok(Self {
            relaxed_per_pa: relaxed.ok_or(SetupError::Fluid)?,
            relaxation: compliance.to_relaxation().ok(),
            compliance,
            shares_of_indenter: material.shares_of_indenter()?,
            alternatives: alternatives.collect(),
            replicas: solids(&material.origin.replicas)?,
        })
    }
}
