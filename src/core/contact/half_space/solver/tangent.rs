//! How stiff a contact is while its shape does not change.
//!
//! Where the approach changes by so little that no cell enters or leaves the contact, the pressure changes like that under a
//! rigid flat punch of the contact's plan form, whatever made the contact. Its stiffness over that of the half-space is a
//! length, for a disc the diameter (I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47: W = 2 a delta / C).

use std::sync::Arc;

use super::super::instant::SolverSettings;
use super::HalfSpace;
use crate::contact::{ContactError, Engine, Instant, Prescribed};

/// The load of the punch is right to about this part of it, far below what the cells leave in it.
const TOLERANCE: f64 = 1e-6;

impl HalfSpace {
    /// Half the load that a flat punch on the cells under pressure takes per approach, at a compliance of one; and the
    /// convolutions that took.
    pub(super) fn punch_radius_m(
        &mut self,
        pressure: &[f64],
    ) -> Result<(f64, usize), ContactError> {
        let face = |&p: &f64| if p > 0.0 { 0.0 } else { f64::INFINITY };
        let settings = SolverSettings {
            tolerance: TOLERANCE,
            ..self.settings
        };
        let gap_m = pressure.iter().map(face).collect();
        let mut punch = Self::new(Arc::clone(&self.operator), gap_m, false, settings);
        punch.interrupt.clone_from(&self.interrupt);
        let history = vec![0.0; pressure.len()];
        let instant = Instant {
            history: &history,
            compliance_per_pa: 1.0,
            prescribed: Prescribed::ApproachM(1.0),
        };
        let mut under_punch = vec![0.0; pressure.len()];
        let solved = punch.solve(&instant, &mut under_punch);
        self.convolutions += punch.convolutions;
        let solution = solved?;
        Ok((0.5 * solution.load_n, solution.convolutions))
    }
}
