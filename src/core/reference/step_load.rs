//! Sphere under a load put on at once and held, then taken off at once: pressure, and the dent that is left.
//!
//! While the contact radius does not decrease, a^3(t) = (3/4) R W C(t) (E. H. Lee and J. R. M. Radok, J. Appl. Mech. 27 (1960)
//! 438), and the relaxation modulus Psi, the counterpart of C, turns the history of any function F(a(t), r) that is linear in
//! an elastic answer into the viscoelastic one:
//!
//! ```text
//! P[F](t) = Psi(0) F(t) + integral from 0 to t of Psi'(t-s) F(s) ds
//! pressure         p(r) = (2 / (pi R)) P[sqrt(a^2 - r^2)]        (S. Spinu, Advances in Tribology 2018, (2) and (6))
//! line force       f(x) = (1 / R) P[a^2 - x^2]                   (method of dimensionality reduction)
//! displacement     u(r) = (2 / pi) integral from 0 to r of q(x) / sqrt(r^2 - x^2) dx
//! ```
//!
//! with q(x) = (a^2 - x^2)/R inside the contact under load. Taking the load off takes C(0) f(x) off q at once; what is left
//! stays in a body whose creep is a dashpot's alone, and decays like exp(-t/lambda) in one with a single retardation time.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use super::elastic::Hertz;
use super::transient::step_load_contact_radius_m;
use crate::material::{Creep, MaterialError, Relaxation};
use crate::numerics::roots::{ALL_DIGITS, bisect};

/// A sphere of this radius (m) under this load (N) from time 0 on.
#[derive(Debug, Clone)]
pub struct StepLoad {
    radius_m: f64,
    load_n: f64,
    contact_compliance: Creep,
    contact_modulus: Relaxation,
}

/// Intervals of Simpson's rule. The integrands are smooth in the variables chosen: 1e-9 of the result.
const INTERVALS: usize = 200;

impl StepLoad {
    /// The load case.
    ///
    /// # Errors
    /// [`MaterialError`] where the compliance has no relaxation modulus that a double can hold.
    pub fn new(
        radius_m: f64,
        load_n: f64,
        contact_compliance: Creep,
    ) -> Result<Self, MaterialError> {
        Ok(Self {
            radius_m,
            load_n,
            contact_modulus: contact_compliance.to_relaxation()?,
            contact_compliance,
        })
    }

    /// Contact radius (m).
    pub fn contact_radius_m(&self, time_s: f64) -> f64 {
        let compliance = &self.contact_compliance;
        step_load_contact_radius_m(self.radius_m, self.load_n, compliance, time_s)
    }

    /// Pressure (Pa) at a distance from the axis.
    pub fn pressure_pa(&self, r_m: f64, time_s: f64) -> f64 {
        let root = |s: f64| {
            let a = self.contact_radius_m(s);
            ((a - r_m) * (a + r_m)).max(0.0).sqrt()
        };
        FRAC_2_PI / self.radius_m * self.relaxed(r_m, time_s, &root)
    }

    /// Surface displacement (m) under load: that of the Hertz contact of the same radius.
    pub fn displacement_m(&self, r_m: f64, time_s: f64) -> f64 {
        let hertz = Hertz {
            radius_m: self.radius_m,
            load_n: self.load_n,
            compliance_per_pa: self.contact_compliance.compliance(time_s),
        };
        hertz.displacement_m(r_m)
    }

    /// Surface displacement (m) a time after the load, held for `held_s`, was taken off. `None` for a body with more than one
    /// retardation time, or with one and a dashpot.
    pub fn displacement_after_unloading_m(
        &self,
        r_m: f64,
        held_s: f64,
        since_s: f64,
    ) -> Option<f64> {
        let creep = &self.contact_compliance;
        let left = match (creep.branches(), creep.viscosity_pa_s()) {
            ([], Some(_)) => 1.0,
            ([branch], None) => (-since_s / branch.time_s).exp(),
            _ => return None,
        };
        let a = self.contact_radius_m(held_s);
        let shortening = |x_m: f64| {
            let before = (a - x_m) * (a + x_m) / self.radius_m;
            before - creep.instantaneous_compliance() * self.line_force(x_m, held_s)
        };
        // x = r sin(theta) takes the root away.
        let last = if r_m > a { (a / r_m).asin() } else { FRAC_PI_2 };
        let integral = simpson(0.0, last, &|theta| shortening(r_m * theta.sin()));
        Some(FRAC_2_PI * left * integral)
    }

    /// f(x) in N/m.
    fn line_force(&self, x_m: f64, time_s: f64) -> f64 {
        let parabola = |s: f64| {
            let a = self.contact_radius_m(s);
            ((a - x_m) * (a + x_m)).max(0.0)
        };
        self.relaxed(x_m, time_s, &parabola) / self.radius_m
    }

    /// P\[F\](t) of an F that is zero before the contact reaches `r_m`.
    fn relaxed(&self, r_m: f64, time_s: f64, f: &dyn Fn(f64) -> f64) -> f64 {
        let reached_s = self.reached_s(r_m, time_s);
        let span_s = time_s - reached_s;
        if self.contact_radius_m(time_s) <= r_m {
            return 0.0;
        }
        let rate = |age_s: f64| {
            let branches = self.contact_modulus.branches().iter();
            -branches
                .map(|b| b.modulus_pa / b.time_s * (-age_s / b.time_s).exp())
                .sum::<f64>()
        };
        // s = s_0 + (t - s_0) v^2: a root at s_0 becomes smooth.
        let past = simpson(0.0, 1.0, &|v| {
            let s = reached_s + span_s * v * v;
            2.0 * span_s * v * rate(time_s - s) * f(s)
        });
        self.contact_modulus.instantaneous_modulus() * f(time_s) + past
    }

    /// When the contact reaches a distance from the axis, at most `time_s`.
    fn reached_s(&self, r_m: f64, time_s: f64) -> f64 {
        if self.contact_radius_m(0.0) >= r_m {
            return 0.0;
        }
        bisect(0.0, time_s, ALL_DIGITS, |s| self.contact_radius_m(s) < r_m).1
    }
}

/// Integral by Simpson's rule.
fn simpson(from: f64, to: f64, f: &dyn Fn(f64) -> f64) -> f64 {
    let width = (to - from) / INTERVALS as f64;
    let weighted = |k: usize| {
        let weight = match k {
            0 | INTERVALS => 1.0,
            _ if k % 2 == 1 => 4.0,
            _ => 2.0,
        };
        weight * f(from + k as f64 * width)
    };
    (0..=INTERVALS).map(weighted).sum::<f64>() * width / 3.0
}

/// (a/a_H)^3 of a Maxwell body under W_0 (1 - s/2), s = t/tau between 0 and 2, put on at once.
///
/// While the contact grows, up to s = 1, by Lee and Radok 1 + s/2 - s^2/4. Then the radius is that at the earlier s_1 with
/// exp(s) W(s) = exp(s_1) W(s_1) (T. C. T. Ting, J. Appl. Mech. 33 (1966) 845); and once exp(s) W(s) is below W_0, only what
/// was touched first is still in contact, relaxed by exp(-s): a^3 = exp(s) W(s).
pub fn maxwell_falling_ramp_cubed_radius(s: f64) -> f64 {
    let growing = |s: f64| 1.0 + 0.5 * s - 0.25 * s * s;
    let relaxed = |s: f64| s.exp() * (1.0 - 0.5 * s);
    if s <= 1.0 {
        return growing(s);
    }
    if relaxed(s) <= 1.0 {
        return relaxed(s).max(0.0);
    }
    let (low, high) = bisect(0.0, 1.0, ALL_DIGITS, |earlier| {
        relaxed(earlier) < relaxed(s)
    });
    growing(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::material::{Material, ModulusKind, classical};

    fn maxwell() -> StepLoad {
        let body = classical::maxwell(1e6, 1.0).unwrap();
        let material = Material::from_relaxation(body, ModulusKind::Shear, 0.5).unwrap();
        StepLoad::new(0.01, 0.01, material.contact_compliance().unwrap()).unwrap()
    }

    fn zener() -> StepLoad {
        let body = classical::zener(1e6, 1e6, 1.0).unwrap();
        let material = Material::from_creep(body, ModulusKind::Shear, 0.5).unwrap();
        StepLoad::new(0.01, 0.01, material.contact_compliance().unwrap()).unwrap()
    }

    /// The load that the pressure carries, as a part of the load: (2 pi / W) times the integral of p r dr.
    fn carried(load: &StepLoad, time_s: f64) -> f64 {
        let a = load.contact_radius_m(time_s);
        // r = a sqrt(1 - v^2) takes the root at the edge away.
        let moment = simpson(0.0, 1.0, &|v| {
            a * a * v * load.pressure_pa(a * (1.0 - v * v).max(0.0).sqrt(), time_s)
        });
        2.0 * PI * moment / load.load_n
    }

    #[test]
    fn the_pressure_begins_as_that_of_hertz_and_always_carries_the_load() {
        for load in [maxwell(), zener()] {
            let hertz = Hertz {
                radius_m: 0.01,
                load_n: 0.01,
                compliance_per_pa: load.contact_compliance.compliance(0.0),
            };
            let r = 0.4 * hertz.contact_radius_m();
            let first = load.pressure_pa(r, 0.0) / hertz.pressure_pa(r);
            assert!((first - 1.0).abs() < 1e-14, "{first}");
            for time_s in [0.0, 0.3, 2.0] {
                // The vertical tangent at the edge of the first contact costs Simpson's rule its order.
                assert!((carried(&load, time_s) - 1.0).abs() < 2e-4, "{time_s}");
            }
        }
    }

    #[test]
    fn the_pressure_under_the_axis_has_its_known_values() {
        // From an independent solver, to half a unit of the last digit.
        let maxwell = maxwell();
        let peak = maxwell.pressure_pa(0.0, 0.0);
        for (time_s, known) in [(0.5, 0.71915), (1.0, 0.52613), (2.0, 0.30629)] {
            let found = maxwell.pressure_pa(0.0, time_s) / peak;
            assert!((found - known).abs() < 5.1e-6, "{time_s}: {found}");
        }
        let zener = zener();
        for (time_s, known) in [(0.2, 0.8870), (0.5, 0.7772), (1.0, 0.6873), (5.0, 0.6300)] {
            let found = zener.pressure_pa(0.0, time_s) / peak;
            assert!((found - known).abs() < 5.1e-5, "{time_s}: {found}");
        }
    }

    #[test]
    fn unloading_at_once_takes_everything_back_and_later_less() {
        for load in [maxwell(), zener()] {
            let hertz_m = load.contact_radius_m(0.0);
            let after = |r: f64, held: f64, since: f64| {
                load.displacement_after_unloading_m(r, held, since).unwrap()
            };
            for r in [0.0, 0.5 * hertz_m, 2.0 * hertz_m] {
                let full = load.displacement_m(r, 2.0);
                assert!(after(r, 0.0, 0.0).abs() < 1e-12 * load.displacement_m(0.0, 0.0));
                assert!(after(r, 2.0, 0.0) > 0.0 && after(r, 2.0, 0.0) < full);
            }
            // Far away a dent is that of a point load: its creep without the instantaneous part.
            let r = 200.0 * hertz_m;
            let creep = &load.contact_compliance;
            let delayed = creep.compliance(2.0) - creep.instantaneous_compliance();
            let point = delayed * load.load_n / (PI * r);
            assert!((after(r, 2.0, 0.0) / point - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn a_falling_ramp_grows_to_a_maximum_and_falls_smoothly_to_zero() {
        assert_eq!(maxwell_falling_ramp_cubed_radius(1.0), 1.25);
        assert_eq!(maxwell_falling_ramp_cubed_radius(2.0), 0.0);
        let mut before = 1.25;
        for k in 1..=1000 {
            let now = maxwell_falling_ramp_cubed_radius(1.0 + f64::from(k) / 1000.0);
            // The radius falls throughout, and by steps of its slope, at most e at the end.
            assert!(now < before && before - now < 0.004, "{k}: {now}");
            before = now;
        }
    }
}
