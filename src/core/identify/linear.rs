//! The linearised contact: what every number of a cycle is, about, from E*(omega) and the equilibrium modulus alone.
//!
//! A small oscillation about a relaxed contact of radius a_0: under load control `delta_1 = W_A |C*| / (2 a_0)` and the loss
//! `pi W_A delta_1 sin phi`, under approach control `W_1 = 2 a_0 delta_A / |C*|`, with C* = (1 - nu^2)/E* and phi its angle.
//! The contact is that of a load W on a compliance C with the product W C; its radius goes with the power m of that, which a
//! sphere has as 1/3, a cone 1/2, a flat punch 0. Numbers at the ends of the cycle are those of `W_0 C_inf +- W_A |C*|`.
//!
//! Each number is good to a factor of about one for any amplitude, and its changes with the material to some per cent. That
//! is what it is for: the factor comes from the exact model.

use num_complex::Complex;

use crate::drive::{Control, HarmonicDrive};
use crate::identify::IdentifyPlan;
use crate::identify::data::Number;
use crate::indenter::Indenter;
use crate::material::{Compressibility, Creep};

/// The smallest part of the mean that an oscillation leaves.
const LEAST: f64 = 1e-3;

/// The contact compliance (1/Pa) at rest of an indenter that is not rigid.
pub(super) fn at_rest(indenter: Option<&Creep>) -> f64 {
    let at_rest = indenter.and_then(Creep::equilibrium_compliance);
    at_rest.unwrap_or(0.0)
}

/// The radius of a contact as a power of the product W C of load and compliance, about one such product.
#[derive(Debug, Clone, Copy)]
pub(super) struct PowerContact {
    /// Logarithms of the radius (m) and of the product (m^2) that it belongs to, and the power.
    ln_radius: f64,
    ln_product: f64,
    power: f64,
}

/// The power of x that a function goes with about some x.
fn power(function: impl Fn(f64) -> f64, x: f64) -> f64 {
    let power = (function(1.1 * x) / function(x)).ln() / 1.1_f64.ln();
    if power.is_finite() { power } else { 0.0 }
}

impl PowerContact {
    pub(super) fn new(indenter: &dyn Indenter, load_n: f64, compliance_per_pa: f64) -> Self {
        let radius_m = |load_n| indenter.elastic_half_width_m(load_n, compliance_per_pa);
        Self {
            ln_radius: radius_m(load_n).max(f64::MIN_POSITIVE).ln(),
            ln_product: (load_n * compliance_per_pa).ln(),
            power: power(radius_m, load_n).clamp(0.0, 0.9),
        }
    }

    /// Of one radius (m) whatever the load.
    fn of_radius(radius_m: f64) -> Self {
        Self {
            ln_radius: radius_m.max(f64::MIN_POSITIVE).ln(),
            ln_product: 0.0,
            power: 0.0,
        }
    }

    /// The radius (m) of this product (m^2).
    fn radius_m(&self, product: f64) -> f64 {
        (self.ln_radius + self.power * (product.ln() - self.ln_product)).exp()
    }

    /// The approach (m) of this product (m^2); 0 where there is no load.
    pub(super) fn approach_m(&self, product: f64) -> f64 {
        match product > 0.0 {
            true => product / (2.0 * self.radius_m(product) * (1.0 - self.power)),
            false => 0.0,
        }
    }
}

/// The product W C (m^2) of an elastic contact under this approach (m), which is exact where its radius is a power of the approach; 0
/// above the surface.
pub(super) fn product_m2(indenter: &dyn Indenter, approach_m: f64) -> f64 {
    let radius_m = |approach_m| indenter.half_widths_under_approach_m(approach_m).0;
    match approach_m > 0.0 {
        true => 2.0 * radius_m(approach_m) * approach_m / (1.0 + power(radius_m, approach_m)),
        false => 0.0,
    }
}

/// A cycle's contact about some equilibrium modulus.
#[derive(Debug, Clone, Copy)]
pub(super) struct LinearCycle<'a> {
    control: Control,
    pub(super) angular_frequency_rad_per_s: f64,
    mean: f64,
    amplitude: f64,
    compressibility: &'a Compressibility,
    /// Contact compliance (1/Pa) of an indenter that is not rigid: at the frequency, and at rest.
    indenter_material: (Complex<f64>, f64),
    contact: PowerContact,
}

impl<'a> LinearCycle<'a> {
    /// About a contact of this compliance (1/Pa) at rest, under an indenter that is rigid or has a contact compliance of its own.
    pub(super) fn new(
        plan: &'a IdentifyPlan,
        indenter_material: Option<&Creep>,
        compliance_per_pa: f64,
        angular_frequency_rad_per_s: f64,
        drive: &HarmonicDrive,
    ) -> Self {
        let at_frequency = |creep: &Creep| creep.complex_compliance(angular_frequency_rad_per_s);
        let attraction = drive.pull_off_n();
        let mean = (drive.mean() + attraction).max(0.5 * (drive.maximum() + attraction));
        let indenter = plan.contact.indenter.as_ref();
        Self {
            control: drive.control(),
            angular_frequency_rad_per_s,
            mean,
            amplitude: drive.amplitude(),
            compressibility: &plan.contact.material.compressibility,
            indenter_material: (
                indenter_material.map_or(0.0.into(), at_frequency),
                at_rest(indenter_material),
            ),
            contact: match drive.control() {
                Control::Load => PowerContact::new(indenter, mean, compliance_per_pa),
                Control::Approach => {
                    PowerContact::of_radius(indenter.half_widths_under_approach_m(mean).0)
                }
            },
        }
    }

    /// A number of the cycle, with the complex modulus (Pa) at its frequency; `NaN` of a number of a history.
    pub(super) fn number(&self, number: Number, equilibrium_pa: f64, modulus: Complex<f64>) -> f64 {
        let of_pair = self.of_pair(equilibrium_pa, modulus);
        let end = |sign| self.end_m2(sign, of_pair);
        match (number, self.control) {
            (Number::StorageModulus, _) => modulus.re,
            (Number::LossModulus, _) => modulus.im,
            (Number::PhaseLag, _) => of_pair.at_frequency.arg(),
            (Number::EnergyLoss, Control::Load) => {
                let (modulus, approach_m) = (of_pair.at_frequency, self.approach_m(of_pair));
                std::f64::consts::PI * self.amplitude * approach_m * modulus.im / modulus.norm()
            }
            (Number::EnergyLoss, Control::Approach) => {
                let per_m = 2.0 * std::f64::consts::PI * self.contact.radius_m(1.0);
                per_m * self.amplitude.powi(2) * of_pair.at_frequency.im
            }
            (Number::ApproachMin, Control::Load) => self.contact.approach_m(end(-1.0)),
            (Number::ApproachMax, Control::Load) => self.contact.approach_m(end(1.0)),
            (Number::ContactRadiusMin, Control::Load) => self.contact.radius_m(end(-1.0)),
            (Number::ContactRadiusMax, Control::Load) => self.contact.radius_m(end(1.0)),
            (Number::PeakPressureMin, _) => self.pressure(-1.0, of_pair),
            (Number::PeakPressureMax, _) => self.pressure(1.0, of_pair),
            (Number::ApproachAmplitude, Control::Load) => self.approach_m(of_pair),
            (Number::LoadAmplitude, Control::Approach) => {
                2.0 * self.contact.radius_m(1.0) * self.amplitude * of_pair.at_frequency.norm()
            }
            // Given by the drive.
            (Number::ApproachAmplitude, Control::Approach)
            | (Number::LoadAmplitude, Control::Load) => self.amplitude,
            (
                Number::ApproachMin
                | Number::ApproachMax
                | Number::ContactRadiusMin
                | Number::ContactRadiusMax,
                Control::Approach,
            ) => 1.0,
            (Number::Approach | Number::Load, _) => f64::NAN,
        }
    }

    /// The moduli of the contact of both bodies, as if the compliance of both were one's.
    fn of_pair(&self, equilibrium_pa: f64, modulus: Complex<f64>) -> Moduli {
        let (at_frequency, at_rest) = self.indenter_material;
        let of_contact = |tensile, indenter_material| {
            let own = self.compressibility.contact_modulus(tensile);
            own / (1.0 + own * indenter_material)
        };
        Moduli {
            at_frequency: of_contact(modulus, at_frequency),
            at_rest_pa: of_contact(equilibrium_pa.into(), at_rest.into()).re,
        }
    }

    /// Amplitude (m) of the approach under a prescribed load.
    fn approach_m(&self, moduli: Moduli) -> f64 {
        let radius_m = self.contact.radius_m(self.mean / moduli.at_rest_pa);
        self.amplitude / (2.0 * radius_m * moduli.at_frequency.norm())
    }

    /// The product (m^2) of load and compliance at an end of a cycle under a prescribed load.
    fn end_m2(&self, sign: f64, moduli: Moduli) -> f64 {
        let mean = self.mean / moduli.at_rest_pa;
        let swing = self.amplitude / moduli.at_frequency.norm();
        (mean + sign * swing).max(LEAST * mean)
    }

    /// A measure of the pressure at an end of the cycle.
    fn pressure(&self, sign: f64, moduli: Moduli) -> f64 {
        match self.control {
            Control::Load => {
                let load = (self.mean + sign * self.amplitude).max(LEAST * self.mean);
                load / self.contact.radius_m(self.end_m2(sign, moduli)).powi(2)
            }
            Control::Approach => {
                let mean = self.mean * moduli.at_rest_pa;
                (mean + sign * self.amplitude * moduli.at_frequency.norm()).max(LEAST * mean)
            }
        }
    }
}

/// Moduli (Pa) of a contact, at a frequency and at rest.
#[derive(Debug, Clone, Copy)]
struct Moduli {
    at_frequency: Complex<f64>,
    at_rest_pa: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indenter::{Cone, FlatPunch, Sphere};

    #[test]
    fn an_elastic_contact_is_that_of_hertz_sneddon_and_a_punch() {
        let sphere = Sphere::new(0.01).unwrap();
        // 4/3 sqrt(R) delta^(3/2).
        let hertz = 4.0 / 3.0 * (0.01_f64 * 1e-5_f64.powi(3)).sqrt();
        assert!((product_m2(&sphere, 1e-5) / hertz - 1.0).abs() < 2e-3);
        let contact = PowerContact::new(&sphere, 0.1, 10.0 * hertz);
        assert!((contact.approach_m(hertz) / 1e-5 - 1.0).abs() < 2e-3);
        let punch = FlatPunch::new(1e-3).unwrap();
        assert!((product_m2(&punch, 1e-5) / (2e-3 * 1e-5) - 1.0).abs() < 2e-3);
        let half_angle = 70_f64.to_radians();
        let cone = Cone::new(half_angle).unwrap();
        let sneddon = 2.0 / std::f64::consts::PI * half_angle.tan() * 1e-10;
        assert!((product_m2(&cone, 1e-5) / sneddon - 1.0).abs() < 3e-3);
        assert_eq!(product_m2(&cone, -1.0), 0.0);
    }
}
