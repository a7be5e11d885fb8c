//! The layer at the edge of a growing contact, where steps and nodes may be too coarse for the pressure.
//!
//! Where the edge advances at a rate v, the surface within l = v tau of it has been in contact for less than a relaxation time tau of
//! the body, and answers with the modulus that relaxes in tau. A spring at a distance xi from the edge carries, of one branch of the
//! relaxation modulus R of the contact (the inverse of its creep compliance), f = G'(a) R_k l_k (1 - exp(-xi/l_k)), and by the
//! transform of the axisymmetric engine this adds a pressure of at most
//!
//! ```text
//! p_k = (2/pi) D G'(a) R_k sqrt(l_k / (2 a)),      D = 0.541, the maximum of Dawson's integral
//! ```
//!
//! at a distance of 0.85 l_k. The layer is thin and the pressure in it may yet be the largest there is: R_k may be ten thousand times
//! the modulus of the rest. Steps longer than tau see the force that the layer holds, spread over what the edge advances in a step
//! instead of over l_k; its pressure is then too small by the root of the quotient of the two, or less. The smaller of both bounds
//! belongs in the error of the largest pressure. The first supposes a surface that has recovered where the edge comes: it is too
//! large where the surface is still bent from the last cycle.

use crate::indenter::{Axisymmetric, Indenter};
use crate::material::{Relaxation, RelaxationBranch};
use crate::sweep::record::CaseResult;

/// The maximum of Dawson's integral.
const DAWSON: f64 = 0.541_044;

/// The layer is not where the pressure is largest as long as what it holds is below this part of the pressure elsewhere, and it
/// certainly may be from the second part on.
const PART_OF_PEAK: (f64, f64) = (0.4, 0.8);

/// An instant of a recorded course.
#[derive(Debug, Clone, Copy)]
struct Instant {
    time_s: f64,
    contact_radius_m: f64,
    peak_pressure_pa: f64,
}

/// The edge of an indenter on a body.
pub(crate) struct EdgeLayer<'a> {
    body: &'a dyn Axisymmetric,
    branches: &'a [RelaxationBranch],
}

impl<'a> EdgeLayer<'a> {
    /// On a body whose contact relaxes like this, with moduli that are the inverse of its contact compliance (Pa). `None` where the
    /// indenter is not one of revolution.
    pub fn new(indenter: &'a dyn Indenter, relaxation: &'a Relaxation) -> Option<Self> {
        let branches = relaxation.branches();
        Some(Self {
            body: indenter.axisymmetric()?,
            branches,
        })
    }

    /// By how much (Pa) the largest pressure of a recorded cycle may be larger than it seems.
    pub fn higher_peak_pa(&self, result: &CaseResult) -> f64 {
        let samples = &result.cycle.samples;
        let times_and_radii = samples.time_s.iter().zip(&samples.contact_radius_m);
        let course: Vec<Instant> = times_and_radii
            .zip(&samples.peak_pressure_pa)
            .filter_map(|((&time_s, &contact_radius_m), peak_pressure_pa)| {
                Some(Instant {
                    time_s,
                    contact_radius_m,
                    peak_pressure_pa: (*peak_pressure_pa)?,
                })
            })
            .collect();
        let pressures_pa = course.iter().map(|instant| instant.peak_pressure_pa);
        let seen_pa = pressures_pa.fold(0.0, f64::max);
        let steps = course.windows(2);
        let possible_pa =
            steps.map(|step| step[1].peak_pressure_pa + self.excess_pa(step[0], step[1]));
        possible_pa.fold(seen_pa, f64::max) - seen_pa
    }

    /// By how much (Pa) the peak pressure may be larger than it seems, for what the layer holds beyond the time from an instant to the
    /// next.
    fn excess_pa(&self, before: Instant, now: Instant) -> f64 {
        let step_s = now.time_s - before.time_s;
        let advance_m = now.contact_radius_m - before.contact_radius_m;
        match advance_m > 0.0 && step_s > 0.0 {
            true => self.excess_of_step_pa(now, advance_m, step_s),
            false => 0.0,
        }
    }

    fn excess_of_step_pa(&self, now: Instant, advance_m: f64, step_s: f64) -> f64 {
        let radius_m = now.contact_radius_m;
        let slope = self.slope(radius_m - advance_m, radius_m);
        let (mut held, mut unseen) = (0.0, 0.0);
        let (mut force, mut steeper) = (0.0, 0.0);
        for branch in self.branches {
            let steps = step_s / branch.time_s;
            let layer_m = (advance_m / steps).min(radius_m);
            let part = std::f64::consts::FRAC_2_PI * DAWSON * (0.5 * layer_m / radius_m).sqrt();
            let pressure_pa = part * slope * branch.modulus_pa;
            held += pressure_pa;
            unseen += pressure_pa * steps.min(1.0);
            if steps > 1.0 {
                force += branch.modulus_pa / steps;
                steeper += branch.modulus_pa / steps * steps.sqrt();
            }
        }
        if force == 0.0 {
            return 0.0;
        }
        let (none, all) = PART_OF_PEAK;
        let part = (held / now.peak_pressure_pa - none) / (all - none);
        let of_body_pa = unseen * part.clamp(0.0, 1.0);
        of_body_pa.min(now.peak_pressure_pa * (steeper / force - 1.0))
    }

    /// Slope of the transformed gap between two radii (m).
    fn slope(&self, from_m: f64, to_m: f64) -> f64 {
        let gap_m = |x_m| self.body.transformed_gap_m(x_m);
        (gap_m(to_m) - gap_m(from_m)) / (to_m - from_m)
    }
}
