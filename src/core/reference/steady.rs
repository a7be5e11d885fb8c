//! Exact facts about the stabilised cycle under W_0 + W_A sin(omega t). C* = C' - i C'' is the complex contact compliance.

use std::f64::consts::PI;

use crate::material::Creep;

/// Harmonic load on a contact, mean and amplitude in newtons.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HarmonicContact<'a> {
    pub mean_n: f64,
    pub amplitude_n: f64,
    pub angular_frequency_rad_per_s: f64,
    pub contact_compliance: &'a Creep,
}

impl HarmonicContact<'_> {
    /// (|C*|, C'') in 1/Pa.
    fn complex(&self) -> (f64, f64) {
        let value = self
            .contact_compliance
            .complex_compliance(self.angular_frequency_rad_per_s);
        (value.norm(), -value.im)
    }

    /// Flat punch of this radius, in contact throughout (correspondence principle): amplitude of the approach (m), energy
    /// loss per cycle (J). Exact.
    pub fn flat_punch(&self, radius_m: f64) -> (f64, f64) {
        let (modulus, loss) = self.complex();
        (
            self.amplitude_n * modulus / (2.0 * radius_m),
            PI * self.amplitude_n.powi(2) * loss / (2.0 * radius_m),
        )
    }

    /// Sphere, 0 < W_A <= W_0, solid: largest contact radius (m) and approach (m),
    /// a_max^3 = (3/4) R (W_0 C_inf + W_A |C*|), delta_max = a_max^2 / R. `None` for a fluid.
    pub fn sphere_maxima(&self, radius_m: f64) -> Option<(f64, f64)> {
        let relaxed = self.contact_compliance.equilibrium_compliance()?;
        let (modulus, _) = self.complex();
        let sum = self.mean_n * relaxed + self.amplitude_n * modulus;
        let a = (0.75 * radius_m * sum).cbrt();
        Some((a, a * a / radius_m))
    }

    /// Sphere: smallest contact radius (m), a_min^3 = (3/4) R (W_0 - W_A) C_inf, whatever the frequency.
    pub fn sphere_smallest_contact_radius_m(&self, radius_m: f64) -> Option<f64> {
        let relaxed = self.contact_compliance.equilibrium_compliance()?;
        Some((0.75 * radius_m * (self.mean_n - self.amplitude_n) * relaxed).cbrt())
    }

    /// Sphere, small amplitude: loss (J) = pi W_A^2 C'' / (2 a_0), a_0 the relaxed contact radius at the mean load.
    pub fn sphere_small_amplitude_loss_j(&self, radius_m: f64) -> Option<f64> {
        let relaxed = self.contact_compliance.equilibrium_compliance()?;
        let a0 = (0.75 * radius_m * self.mean_n * relaxed).cbrt();
        Some(PI * self.amplitude_n.powi(2) * self.complex().1 / (2.0 * a0))
    }
}
