//! The radius by which a loop is read as a modulus: how stiff the contact is, whatever its shape.
//!
//! For a contact that stays as it is, W = 2 a delta / C of a round punch holds with the tangent radius in place of a
//! ([`crate::contact::Engine::tangent_radius_m`]), which costs a linear problem. The mean over the cycle is that of the contact
//! radius, times by how much the tangent radius exceeds it at a few instants.

use crate::contact::ContactError;
use crate::history::March;

/// Instants of a cycle at which the tangent radius is computed.
const INSTANTS: usize = 8;

/// Tangent and contact radius of one cycle, taken as its steps go by.
pub(crate) struct TangentRadius {
    every: usize,
    tangent_m: f64,
    contact_m: f64,
    failed: bool,
}

impl TangentRadius {
    /// Nothing taken yet of a cycle in this many steps.
    pub(crate) fn new(steps: usize) -> Self {
        Self {
            every: steps.div_ceil(INSTANTS).max(1),
            tangent_m: 0.0,
            contact_m: 0.0,
            failed: false,
        }
    }

    /// Takes in the instant at the end of a step.
    pub(crate) fn see(&mut self, march: &mut March<'_>, step: usize) -> Result<(), ContactError> {
        if !step.is_multiple_of(self.every) {
            return Ok(());
        }
        match march.tangent_radius_m() {
            Ok(tangent_m) => {
                self.tangent_m += tangent_m.unwrap_or(0.0);
                self.contact_m += march.solution().map_or(0.0, |s| s.contact_radius_m);
            }
            Err(ContactError::NotConverged { .. }) => self.failed = true,
            Err(other) => return Err(other),
        }
        Ok(())
    }

    /// The mean over the cycle (m), from that of the contact radius; `None` where there is no contact, or one whose stiffness
    /// could not be computed.
    pub(crate) fn mean_m(&self, mean_contact_radius_m: f64) -> Option<f64> {
        let is_known = !self.failed && self.contact_m > 0.0;
        is_known.then(|| mean_contact_radius_m * (self.tangent_m / self.contact_m))
    }
}
