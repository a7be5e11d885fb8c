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
use crate::identify::data::Number;
use crate::indenter::Indenter;
use crate::material::{Compressibility, Creep};
use crate::sweep::record::error_bars::Quantity;

/// The smallest part of the mean that an oscillation leaves.
const LEAST: f64 = 1e-3;

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
    /// Logarithms of the radius (m) and of the product of load and compliance (m^2) that it belongs to, and the power.
    ln_radius: f64,
    ln_product: f64,
    power: f64,
}

impl<'a> LinearCycle<'a> {
    pub(super) fn new(
        (angular_frequency_rad_per_s, drive): (f64, &HarmonicDrive),
        indenter: &dyn Indenter,
        (compressibility, indenter_material): (&'a Compressibility, Option<&Creep>),
        equilibrium_pa: f64,
    ) -> Self {
        let indenter_material = indenter_material.map_or((0.0.into(), 0.0), |creep| {
            let at_rest = creep.equilibrium_compliance().unwrap_or(0.0);
            (
                creep.complex_compliance(angular_frequency_rad_per_s),
                at_rest,
            )
        });
        let at_rest = compressibility.contact_modulus(equilibrium_pa.into()).re;
        let compliance = at_rest.recip() + indenter_material.1;
        let attraction = drive.pull_off_n();
        let mean = (drive.mean() + attraction).max(0.5 * (drive.maximum() + attraction));
        let (radius, product, power) = match drive.control() {
            Control::Load => {
                let at = |load| indenter.elastic_half_width_m(load, compliance);
                let (radius, wider) = (at(mean), at(1.1 * mean));
                let power = (wider / radius).ln() / 1.1_f64.ln();
                (radius, mean * compliance, power)
            }
            Control::Approach => (indenter.half_widths_under_approach_m(mean).0, 1.0, 0.0),
        };
        Self {
            control: drive.control(),
            angular_frequency_rad_per_s,
            mean,
            amplitude: drive.amplitude(),
            compressibility,
            indenter_material,
            ln_radius: radius.max(f64::MIN_POSITIVE).ln(),
            ln_product: product.ln(),
            power: match power.is_finite() {
                true => power.clamp(0.0, 0.9),
                false => 0.0,
            },
        }
    }

    /// A number of the cycle, with the complex modulus (Pa) at its frequency; `NaN` of a number of a history.
    pub(super) fn number(&self, number: Number, equilibrium_pa: f64, modulus: Complex<f64>) -> f64 {
        match number {
            Number::OfCycle(Quantity::StorageModulus) => modulus.re,
            Number::OfCycle(Quantity::LossModulus) => modulus.im,
            Number::OfCycle(Quantity::Harmonic2 | Quantity::Harmonic3) => 1.0,
            Number::Approach | Number::Load => f64::NAN,
            _ => self.of_pair(number, equilibrium_pa, modulus),
        }
    }

    /// The same of what depends on both bodies, as if the compliance of both were one's.
    fn of_pair(&self, number: Number, equilibrium_pa: f64, modulus: Complex<f64>) -> f64 {
        let (at_frequency, at_rest) = self.indenter_material;
        let of_contact = |tensile, indenter_material| {
            let own = self.compressibility.contact_modulus(tensile);
            own / (1.0 + own * indenter_material)
        };
        let modulus = of_contact(modulus, at_frequency);
        let equilibrium_pa = of_contact(equilibrium_pa.into(), at_rest.into()).re;
        match (number, self.control) {
            (Number::OfCycle(Quantity::PhaseLag), _) => modulus.arg(),
            (Number::OfCycle(quantity), Control::Load) => {
                self.under_load(quantity, equilibrium_pa, modulus)
            }
            (Number::OfCycle(quantity), Control::Approach) => {
                self.under_approach(quantity, equilibrium_pa, modulus)
            }
            (Number::ApproachAmplitude, Control::Load) => {
                self.approach_amplitude_m(equilibrium_pa, modulus)
            }
            (Number::LoadAmplitude, Control::Approach) => {
                2.0 * self.radius_m(1.0) * self.amplitude * modulus.norm()
            }
            // Given by the drive.
            _ => self.amplitude,
        }
    }

    /// Amplitude (m) of the approach under a prescribed load, of a contact of these moduli (Pa).
    fn approach_amplitude_m(&self, equilibrium_pa: f64, modulus: Complex<f64>) -> f64 {
        let radius_m = self.radius_m(self.mean / equilibrium_pa);
        self.amplitude / (2.0 * radius_m * modulus.norm())
    }

    /// The radius (m) of this product of load and compliance (m^2).
    fn radius_m(&self, product: f64) -> f64 {
        (self.ln_radius + self.power * (product.ln() - self.ln_product)).exp()
    }

    fn under_load(&self, quantity: Quantity, equilibrium_pa: f64, modulus: Complex<f64>) -> f64 {
        let size = modulus.norm();
        let mean = self.mean / equilibrium_pa;
        let swing = self.amplitude / size;
        let end = |sign: f64| (mean + sign * swing).max(LEAST * mean);
        let load = |sign: f64| (self.mean + sign * self.amplitude).max(LEAST * self.mean);
        let approach = |product: f64| product / (2.0 * self.radius_m(product) * (1.0 - self.power));
        let pressure = |sign: f64| load(sign) / self.radius_m(end(sign)).powi(2);
        match quantity {
            Quantity::EnergyLoss => {
                let approach_m = self.approach_amplitude_m(equilibrium_pa, modulus);
                std::f64::consts::PI * self.amplitude * approach_m * modulus.im / size
            }
            Quantity::ApproachMin => approach(end(-1.0)),
            Quantity::ApproachMax => approach(end(1.0)),
            Quantity::ContactRadiusMin => self.radius_m(end(-1.0)),
            Quantity::ContactRadiusMax => self.radius_m(end(1.0)),
            Quantity::PeakPressureMin => pressure(-1.0),
            _ => pressure(1.0),
        }
    }

    fn under_approach(
        &self,
        quantity: Quantity,
        equilibrium_pa: f64,
        modulus: Complex<f64>,
    ) -> f64 {
        let radius = self.radius_m(1.0);
        let force = |sign: f64| {
            let mean = self.mean * equilibrium_pa;
            (mean + sign * self.amplitude * modulus.norm()).max(LEAST * mean)
        };
        match quantity {
            Quantity::EnergyLoss => {
                2.0 * std::f64::consts::PI * radius * self.amplitude.powi(2) * modulus.im
            }
            Quantity::PeakPressureMin => force(-1.0),
            Quantity::PeakPressureMax => force(1.0),
            // Given by the drive.
            _ => 1.0,
        }
    }
}
