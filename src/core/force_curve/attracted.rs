//! The force of a contact over a prescribed indentation where the surfaces attract one another: the attracted springs, in the steps of the
//! curve.

use std::f64::consts::FRAC_PI_4;
use std::ops::Range;
use std::sync::Arc;

use super::springs::radius_m;
use crate::adhesive::{Body, Springs, StepWeights};
use crate::contact::{ContactError, Prescribed};
use crate::indenter::Indenter;
use crate::material::Creep;
use crate::sweep::plan::adhesion::AdhesionPlan;

/// Springs over the contact at the deepest indentation and parts of a step between two points, on the way to a solution.
const ON_THE_WAY: (f64, usize) = (150.0, 3);

/// At the solution: least and most springs, whose zone of attraction has so many.
const FEWEST: f64 = 300.0;
const MOST: f64 = 800.0;
const IN_ZONE: f64 = 6.0;

/// Parts of a step there: where an edge crosses more than its zone in one, the force depends on rounding.
const PARTS: usize = 4;

/// How far a row reaches, in radii of the contact without attraction: at first, and by which ratio farther as long as the contact reaches its end.
const ROOM: f64 = 1.5;
const LONGER: f64 = 1.4;
const MOST_ROOM: f64 = 100.0;

/// The row of springs under an indenter.
#[derive(Debug, Clone)]
pub(super) struct Attracted {
    indenter: Arc<dyn Indenter>,
    /// Radius (m) of the contact without attraction at the deepest indentation, and springs over it.
    pressed_m: f64,
    springs: f64,
    parts: usize,
    /// The part of the path that was seen to be in contact: before and behind it there is no force.
    contact: Range<usize>,
}

impl Attracted {
    /// Rows for the way to a solution and for the solution, of contacts down to a depth of a body that is at most so compliant (1/Pa);
    /// `None` of a shape or a model without attracted springs.
    pub(super) fn new(
        indenter: &Arc<dyn Indenter>,
        adhesion: &AdhesionPlan,
        (deepest_m, compliance_per_pa): (f64, f64),
        contact: &Range<usize>,
    ) -> Option<[Self; 2]> {
        let attraction = adhesion.attraction(indenter.as_ref(), compliance_per_pa)?;
        let pressed_m = radius_m(indenter.axisymmetric()?, deepest_m);
        // The zone of a crack of D. S. Dugdale (J. Mech. Phys. Solids 8 (1960) 100).
        let zone_m = FRAC_PI_4 * attraction.range_m / (compliance_per_pa * attraction.stress_pa);
        let near = (IN_ZONE * pressed_m / zone_m).clamp(FEWEST, MOST);
        let of = |(springs, parts): (f64, usize)| Self {
            indenter: Arc::clone(indenter),
            pressed_m,
            springs,
            parts,
            contact: contact.clone(),
        };
        Some([ON_THE_WAY, (near, PARTS)].map(of))
    }

    /// The force (N) at every point of a contact of this compliance; `None` where it could not be followed.
    pub(super) fn response(
        &self,
        creep: &Creep,
        adhesion: &AdhesionPlan,
        path: (&[f64], &[f64]),
    ) -> Option<Vec<f64>> {
        let whole_s = path.0.last()? - path.0.first()?;
        let body = Body::new(creep, whole_s).ok()?;
        let attraction = adhesion.attraction(self.indenter.as_ref(), creep.compliance(whole_s))?;
        let profile = self.indenter.axisymmetric()?;
        let mut room = ROOM;
        loop {
            let places = 0..=(self.springs * room) as usize;
            let places = places.map(|k| self.pressed_m * k as f64 / self.springs);
            let springs = Springs::new(&body, profile, attraction, places.collect());
            match self.follow(springs, &body, attraction.range_m, path) {
                Err(ContactError::ReachedEdge { .. }) if room < MOST_ROOM => room *= LONGER,
                ended => return ended.ok(),
            }
        }
    }

    fn follow(
        &self,
        mut springs: Springs<'_>,
        body: &Body,
        range_m: f64,
        (time_s, indentation_m): (&[f64], &[f64]),
    ) -> Result<Vec<f64>, ContactError> {
        let mut force_n = vec![0.0; time_s.len()];
        let mut weights = StepWeights::new(body, 0.0);
        let mut before: Option<usize> = None;
        for point in 0..self.contact.end {
            if before.is_none() && indentation_m[point] <= -range_m {
                continue;
            }
            let last = before.unwrap_or(point.saturating_sub(1));
            let step_s = (time_s[point] - time_s[last]) / self.parts as f64;
            if (weights.step_s() - step_s).abs() > 1e-9 * step_s {
                weights = StepWeights::new(body, step_s);
            }
            for part in 1..=self.parts {
                let moved_m = indentation_m[point] - indentation_m[last];
                let depth_m = indentation_m[last] + moved_m * part as f64 / self.parts as f64;
                springs.step(&weights, Prescribed::ApproachM(depth_m))?;
            }
            if point >= self.contact.start {
                force_n[point] = springs.edges().load_n;
            }
            before = Some(point);
        }
        Ok(force_n)
    }
}
