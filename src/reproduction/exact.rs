//! The problem behind a curve: its Hertz contact, in whose units everything is, and what is known exactly of it.

use std::f64::consts::TAU;

use serde::Deserialize;

use super::run::unfit;
use super::table::Quantity;
use super::{Plans, Result};
use crate::material::{Creep, Material};
use crate::reference::elastic::Hertz;
use crate::reference::steady::HarmonicContact;
use crate::reference::step_load::{StepLoad, maxwell_falling_ramp_cubed_radius};
use crate::reference::transient::maxwell_half_sine_cubed_radius;
use crate::sweep::plan::SweepPlan;

/// Exact values by their names in `figures.toml`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Exact {
    /// No closed form: the axisymmetric engine, refined.
    Refined,
    /// Over time (s), in MPa.
    RelaxationModulus,
    /// Of the shear creep function, in 1/MPa; of a branch, fastest first; its rate in 1/s.
    FinalCreepCompliance,
    CreepTerm,
    CreepRate,
    /// Under a load put on at once and held: the contact radius over time; pressure and displacement over the radius, the latter
    /// also after the load is taken off.
    StepLoadRadius,
    StepLoadPressure,
    StepLoadDisplacement,
    /// Contact radius of a Maxwell body under W0 (1 - t/2 tau) and under W0 sin(t/tau), over time.
    FallingRampRadius,
    HalfSineRadius,
    /// Of stabilised cycles, over frequency: the largest values, and by how much the maximum of the approach comes after that of
    /// the load (tau).
    HarmonicRadius,
    HarmonicApproach,
    HarmonicLag,
}

/// What a file asks for.
pub(super) struct Problem<'a> {
    material: &'a Material,
    pub contact_compliance: Creep,
    /// At the largest load and the instantaneous compliance. A flat punch has none: of it, nothing but loads is shown.
    hertz: Hertz,
    step_load: Option<StepLoad>,
    /// Relaxation modulus at 0; not a number of a body that has none.
    modulus_mpa: f64,
    /// When the first segment of a history ends (s).
    held_s: f64,
    /// Mean and amplitude (N) of a harmonic load.
    harmonic_n: [f64; 2],
}

const PER_MEGA: f64 = 1e-6;

impl<'a> Problem<'a> {
    pub fn new(file: &str, plans: &'a Plans) -> Result<Self> {
        let (material, indenter, load_n, held_s, harmonic_n);
        if let Ok(SweepPlan { base, .. }) = plans.sweep(file) {
            (material, indenter) = (&*base.contact.material, &base.contact.indenter);
            (load_n, held_s) = (base.drive.maximum(), f64::INFINITY);
            harmonic_n = [base.drive.mean(), base.drive.amplitude()];
        } else {
            let plan = plans.scenario(file)?;
            let series = plan.contact.material.series();
            material = series.ok_or_else(|| unfit("the scenario's material is no series"))?;
            (indenter, load_n) = (&plan.contact.indenter, plan.drive.maximum());
            held_s = plan.drive.start_s(1).unwrap_or(f64::INFINITY);
            harmonic_n = [0.0; 2];
        }
        let contact_compliance = material.contact_compliance()?;
        let body = indenter.axisymmetric();
        let body = body.ok_or_else(|| unfit("the figures need a body of revolution"))?;
        // Of a sphere G(x) = x^2 / R; at an x of 1 m the formula is as good as anywhere.
        let radius_m = body.transformed_gap_m(1.0).recip();
        Ok(Self {
            hertz: Hertz {
                radius_m,
                load_n,
                compliance_per_pa: contact_compliance.instantaneous_compliance(),
            },
            step_load: StepLoad::new(radius_m, load_n, contact_compliance.clone()).ok(),
            modulus_mpa: (material.relaxation()).map_or(f64::NAN, |r| PER_MEGA * r.modulus(0.0)),
            material,
            contact_compliance,
            held_s,
            harmonic_n,
        })
    }

    /// What a quantity in SI units is divided by.
    pub fn unit(&self, of: Quantity) -> f64 {
        match of {
            Quantity::Load => self.hertz.load_n,
            Quantity::Approach | Quantity::Displacement => self.hertz.approach_m(),
            Quantity::ContactRadius | Quantity::Radius => self.hertz.contact_radius_m(),
            Quantity::Pressure | Quantity::PeakPressure => self.hertz.peak_pressure_pa(),
            Quantity::Loss => self.hertz.load_n * self.hertz.approach_m(),
            Quantity::RelaxationModulus => self.modulus_mpa.recip(),
            // As they are computed: of times, tau is 1 s.
            _ => 1.0,
        }
    }
}

impl Exact {
    /// The closed form at this x, in the paper's units, and at this time (s) where it depends on one; `None` where it is undefined.
    pub fn value(self, of: &Problem<'_>, time_s: f64, x: f64) -> Option<f64> {
        let unit = |quantity| of.unit(quantity);
        let creep = || of.material.shear_creep_function().ok();
        let step_load = of.step_load.as_ref();
        let r_m = x * unit(Quantity::Radius);
        let omega = TAU * x;
        let harmonic = HarmonicContact {
            mean_n: of.harmonic_n[0],
            amplitude_n: of.harmonic_n[1],
            angular_frequency_rad_per_s: omega,
            contact_compliance: &of.contact_compliance,
        };
        let maxima = || harmonic.sphere_maxima(of.hertz.radius_m);
        Some(match self {
            Self::Refined => return None,
            Self::RelaxationModulus => PER_MEGA * of.material.relaxation()?.modulus(x),
            Self::FinalCreepCompliance => creep()?.equilibrium_compliance()? / PER_MEGA,
            Self::CreepTerm => creep()?.branches().get(x as usize)?.compliance_per_pa / PER_MEGA,
            Self::CreepRate => creep()?.branches().get(x as usize)?.time_s.recip(),
            Self::StepLoadRadius => step_load?.contact_radius_m(x) / unit(Quantity::Radius),
            Self::StepLoadPressure => {
                step_load?.pressure_pa(r_m, time_s) / unit(Quantity::Pressure)
            }
            Self::StepLoadDisplacement => {
                let displacement_m = match time_s - of.held_s {
                    since_s if since_s < 0.0 => step_load?.displacement_m(r_m, time_s),
                    since_s => {
                        step_load?.displacement_after_unloading_m(r_m, of.held_s, since_s)?
                    }
                };
                displacement_m / unit(Quantity::Displacement)
            }
            Self::FallingRampRadius => maxwell_falling_ramp_cubed_radius(x).cbrt(),
            Self::HalfSineRadius => maxwell_half_sine_cubed_radius(x).cbrt(),
            Self::HarmonicRadius => maxima()?.0 / unit(Quantity::ContactRadius),
            Self::HarmonicApproach => maxima()?.1 / unit(Quantity::Approach),
            Self::HarmonicLag => -of.contact_compliance.complex_compliance(omega).arg() / omega,
        })
    }
}
