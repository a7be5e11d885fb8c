//! The bias of the small-amplitude formula, computed with the exact model and taken out.
//!
//! The formula holds the contact radius fixed while the load oscillates. What that costs depends on the amplitude, on how much
//! stiffer the material is at this frequency than at rest, and on its loss. So a solid is sought that gives the measured loop: one
//! branch at the frequency, which carries the loss, a slow one between rest and the frequency, and an equilibrium modulus that
//! gives the mean approach (the mean load where the approach is driven). Its exact stabilised cycle is read by the same formula, its
//! own modulus is known, and the ratio of the two is the bias. A loop at one frequency does not say how its solid behaves at others,
//! and the bias depends on it a little: what other splits of the modulus change is added to the interval.

use std::sync::Arc;

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::moduli::{Contact, Radius, radius_of_geometry};
use super::statistics::{Estimate, NORMAL};
use crate::cycle::Harmonics;
use crate::drive::{Control, HarmonicDrive};
use crate::indenter::Indenter;
use crate::material::{Material, MaterialError, ModulusKind, Relaxation, RelaxationBranch};
use crate::sweep::Sweep;
use crate::sweep::plan::SweepPlan;

/// Moduli without the bias of the formula.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Unbiased {
    pub storage_modulus_pa: Estimate,
    pub loss_modulus_pa: Estimate,
    /// What the formula gives over what is there: below 1 where it is low.
    pub storage_bias: f64,
    pub loss_bias: f64,
}

/// Steps and springs of the model: the bias is then right to a few parts in ten thousand.
const STEPS: usize = 128;
const SPRINGS: usize = 128;
/// Rounds of the search.
const ROUNDS: usize = 25;
/// Relative change at which it ends.
const SETTLED: f64 = 1e-5;
/// Smallest product of frequency and time of the branch that carries the loss, and the product of the slow one.
const LEAST: f64 = 0.02;
const SLOW: f64 = 300.0;

/// A solid that is sought.
#[derive(Debug, Clone, Copy)]
struct Solid {
    storage_pa: f64,
    loss_pa: f64,
    equilibrium_pa: f64,
    /// Largest product of frequency and time of the branch that carries the loss: the loss falls with frequency where it is large, and
    /// rises where it is small.
    fast: f64,
}

/// The largest product by which the bias is taken out.
const FAST: f64 = 1.0;
/// What else the spectrum may be, at its two ends: a single branch, as far as its loss allows; and a loss that rises with frequency. For
/// random solids of one, two and five branches the bias is no further from the one by [`FAST`] than that by one of these.
const OTHERS: [f64; 2] = [f64::INFINITY, 0.05];

/// What the formula reads from the exact cycle of a solid.
struct Reading {
    /// Storage and loss modulus (Pa).
    read: [f64; 2],
    /// What the drive does not prescribe.
    mean: f64,
    /// What the formula gives over what is there: of the storage and of the loss modulus.
    bias: [f64; 2],
}

/// Why the bias is not known, as a part of a sentence.
type Failure = Box<dyn std::error::Error>;

/// The moduli that the formula read from a cycle, without its bias.
///
/// # Errors
/// Why the bias is not known, as a part of a sentence.
pub(super) fn unbiased(
    contact: &Contact,
    cycle: &Harmonics,
    angular: f64,
    (storage, loss): (Estimate, Estimate),
) -> Result<Unbiased, Failure> {
    let model = Model::new(contact, cycle, angular)?;
    if loss.value <= 0.0 || storage.value <= 0.0 {
        return Err("no passive solid has these moduli".into());
    }
    let measured = [storage.value, loss.value];
    let first = Solid {
        storage_pa: storage.value,
        loss_pa: loss.value,
        equilibrium_pa: storage.value,
        fast: FAST,
    };
    let solid = model.solid(measured, first)?;
    let bias = model.read(&solid, STEPS, SPRINGS)?.bias;
    // What coarser steps and springs change is more than what these leave.
    let coarser = model.read(&solid, STEPS / 2, SPRINGS / 2)?.bias;
    // Another spectrum with the same modulus and the same mean has another bias. One that gives no such loop is none to be considered.
    let others = OTHERS.into_iter().filter_map(|fast| {
        let other = model.solid(measured, Solid { fast, ..solid }).ok()?;
        Some(model.read(&other, STEPS, SPRINGS).ok()?.bias)
    });
    let biases: Vec<[f64; 2]> = others.chain([coarser]).collect();
    let without = |which: usize, estimate: Estimate| {
        let changes = biases
            .iter()
            .map(|other| (other[which] / bias[which] - 1.0).abs());
        over(estimate, bias[which], changes.fold(0.0, f64::max))
    };
    Ok(Unbiased {
        storage_modulus_pa: without(0, storage),
        loss_modulus_pa: without(1, loss),
        storage_bias: bias[0],
        loss_bias: bias[1],
    })
}

/// An estimate without its bias, which is uncertain by a part of it: that widens the interval as a whole.
fn over(estimate: Estimate, bias: f64, uncertain: f64) -> Estimate {
    let value = estimate.value / bias;
    let of_bias = uncertain * value.abs();
    let standard = |error: f64| (error / bias).hypot(of_bias / NORMAL);
    Estimate {
        value,
        standard_error: estimate.standard_error.map(standard),
        error: estimate.error.map(|error| error / bias + of_bias),
    }
}

/// The exact model of a measured cycle.
struct Model<'a> {
    contact: &'a Contact,
    indenter: &'a Arc<dyn Indenter>,
    drive: HarmonicDrive,
    /// Mean of the signal that is not driven.
    mean: f64,
    angular: f64,
}

impl<'a> Model<'a> {
    fn new(contact: &'a Contact, cycle: &Harmonics, angular: f64) -> Result<Self, Failure> {
        let indenter = contact.indenter.as_ref();
        let indenter = indenter.ok_or("the setup has no [indenter]")?;
        if indenter.axisymmetric().is_none() {
            return Err("the shape is no convex body of revolution".into());
        }
        let amplitude =
            |harmonics: &[Complex<f64>], n: usize| harmonics.get(n).map_or(0.0, |a| a.norm());
        let second = |harmonics| amplitude(harmonics, 1) / amplitude(harmonics, 0);
        let (mean_n, mean_m) = (cycle.load_mean_n, cycle.approach_mean_m);
        let (load_n, approach_m) = (amplitude(&cycle.load_n, 0), amplitude(&cycle.approach_m, 0));
        // The signal that is more of a sine is the driven one.
        let is_load = second(&cycle.load_n) <= second(&cycle.approach_m);
        if is_load && load_n > mean_n {
            return Err("the load becomes a pull in a part of the cycle".into());
        }
        let (drive, mean) = match is_load {
            true => (HarmonicDrive::load(mean_n, load_n), mean_m),
            false => {
                let control = Control::Approach;
                let drive = HarmonicDrive::new(control, mean_m, approach_m, 0.0, 0.0);
                (drive, mean_n)
            }
        };
        Ok(Self {
            contact,
            indenter,
            drive: drive?,
            mean,
            angular,
        })
    }

    /// The factor by which the equilibrium modulus is to grow for the mean to become the measured one, about.
    fn softness(&self, mean: f64) -> f64 {
        match self.drive.control() {
            // As under a sphere; other shapes take a round or two more.
            Control::Load => (mean / self.mean).powf(1.5),
            Control::Approach => self.mean / mean,
        }
    }

    /// The solid, split in its way, of whose exact cycle the formula reads these moduli (Pa) and whose mean is the measured one.
    fn solid(&self, measured: [f64; 2], first: Solid) -> Result<Solid, Failure> {
        let mut solid = first;
        for _ in 0..ROUNDS {
            let read = self.read(&solid, STEPS, SPRINGS)?;
            let before = solid;
            solid.storage_pa *= measured[0] / read.read[0];
            solid.loss_pa *= measured[1] / read.read[1];
            let equilibrium_pa = before.equilibrium_pa * self.softness(read.mean);
            solid.equilibrium_pa = equilibrium_pa.min(solid.storage_pa);
            let changes = [
                solid.storage_pa / before.storage_pa,
                solid.loss_pa / before.loss_pa,
                solid.equilibrium_pa / before.equilibrium_pa,
            ];
            let change = changes
                .into_iter()
                .map(|c| c.ln().abs())
                .fold(0.0, f64::max);
            if change < SETTLED {
                return Ok(solid);
            }
            if !change.is_finite() {
                break;
            }
        }
        Err("no solid is found whose exact loop is the measured one".into())
    }

    /// What the formula reads from the exact cycle of a solid.
    fn read(&self, solid: &Solid, steps: usize, springs: usize) -> Result<Reading, Failure> {
        let relaxation = solid.relaxation(self.angular)?;
        let own = relaxation.complex_modulus(self.angular);
        let nu = self.contact.poisson_ratio;
        let material = Material::from_relaxation(relaxation, ModulusKind::Longitudinal, nu)?;
        let material = match &self.contact.indenter_material {
            Some(indenter) => material.against(indenter.clone()),
            None => material,
        };
        let plan = SweepPlan::new(material.clone(), self.indenter.clone(), self.drive);
        let sweep = Sweep::from(plan).without_error_bars();
        let sweep = sweep.steps(steps)?.springs(springs)?;
        let record = sweep.case_at_hz(self.angular / std::f64::consts::TAU)?;
        let result = record.result.ok_or("the exact cycle is not found")?;
        let analysis = &result.analysis;
        let radii_m = &result.cycle.samples.contact_radius_m;
        let moduli = self
            .radius_m(radii_m, analysis.approach_mean_m)
            .and_then(|radius_m| analysis.equivalent_moduli_pa(radius_m, nu))
            .map(|read| material.of_loop(read, self.angular));
        let (storage_pa, loss_pa) = moduli.ok_or("the exact cycle has no contact radius")?;
        Ok(Reading {
            read: [storage_pa, loss_pa],
            bias: [storage_pa / own.re, loss_pa / own.im],
            mean: match self.drive.control() {
                Control::Load => analysis.approach_mean_m,
                Control::Approach => analysis.load_mean_n,
            },
        })
    }

    /// The radius of an exact cycle by the rule that the measured one has it by; an area function stands for the geometry.
    fn radius_m(&self, radii_m: &[f64], approach_m: f64) -> Option<f64> {
        match self.contact.radius {
            Radius::Column => super::statistics::mean(radii_m.get(1..)?),
            Radius::Geometry | Radius::AreaFunction { .. } => {
                radius_of_geometry(self.indenter.axisymmetric()?, approach_m)
            }
        }
    }
}

impl Solid {
    /// A branch at the frequency with all of the loss, the rest of the stiffness slow.
    fn relaxation(&self, angular: f64) -> Result<Relaxation, MaterialError> {
        // Of q = omega tau: the branch adds E'' q to the storage modulus, no more than what the equilibrium leaves, and no more than
        // nine tenths where that is all.
        let left = (self.storage_pa - self.equilibrium_pa) / self.loss_pa;
        let most = if self.fast <= 1.0 { 0.5 } else { 0.9 };
        let q = (most * self.storage_pa / self.loss_pa)
            .min(self.fast)
            .min(left.max(LEAST));
        let fast_pa = self.loss_pa * (1.0 + q * q) / q;
        let rest_pa = self.storage_pa - self.loss_pa * q;
        let equilibrium_pa = self.equilibrium_pa.min(rest_pa);
        let branch = |modulus_pa: f64, q: f64| RelaxationBranch {
            modulus_pa,
            time_s: q / angular,
        };
        let mut branches = vec![branch(fast_pa, q)];
        let slow_pa = rest_pa - equilibrium_pa;
        if slow_pa > 1e-6 * rest_pa {
            branches.push(branch(slow_pa, SLOW));
        }
        Relaxation::new(equilibrium_pa, branches)
    }
}
