//! The creep compliance as a generalised Kelvin (Voigt) model.
//!
//! ```text
//!                  |-- 1/D_1 --|     |-- 1/D_2 --|
//!     --- 1/D_0 ---|           |-----|           |--- ... --- [eta] ---
//!                  |-[lambda_1]-|    |-[lambda_2]-|
//! ```
//!
//! `D(t) = D_0 + sum D_j (1 - exp(-t/lambda_j)) + t/eta`; J. D. Ferry, *Viscoelastic Properties of
//! Polymers*, 3rd edition, Wiley 1980, chapters 1 and 3; N. W. Tschoegl, *The Phenomenological
//! Theory of Linear Viscoelastic Behavior*, Springer 1989, chapter 3.

use num_complex::Complex;
use serde::Serialize;

use super::conversion;
use super::error::{MaterialError, checked_branches, in_range, non_negative, positive};
use super::harmonic::{Debye, reciprocal};
use super::relaxation::{NO_BRANCH, Relaxation};
use crate::block;
use crate::quantity::Dimension::{Compliance, Time};
use crate::quantity::key::{Kind, quantity};

block! {
    /// A branch.
    #[derive(Copy, Serialize)]
    pub struct CreepBranch in "branches" {
        /// Creep compliance of the branch.
        compliance_per_pa: f64 => "compliance", Kind::Number(quantity(Compliance).above_zero().or_else(NO_BRANCH));
        /// Relaxation time, or retardation time of a creep series.
        time_s: f64 => "time", Kind::Number(quantity(Time).above_zero().or_else(NO_BRANCH));
    }
}

/// A creep compliance `D(t) = D_0 + sum D_j (1 - exp(-t/lambda_j)) + t/eta`, in 1/Pa.
///
/// The type serves for longitudinal, shear and contact compliances alike; who holds it says which.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Creep {
    instantaneous_per_pa: f64,
    branches: Vec<CreepBranch>,
    viscosity_pa_s: Option<f64>,
}

impl Creep {
    /// A generalised Kelvin model; branches may come in any order, and equal times are merged.
    ///
    /// `viscosity_pa_s` is that of the dashpot in series, `None` for a solid.
    ///
    /// # Errors
    /// A parameter that is not finite; a branch compliance, time or viscosity that is not
    /// positive; a negative instantaneous compliance; a compliance that is zero at all times; a
    /// sum that overflows.
    pub fn new(
        instantaneous_per_pa: f64,
        branches: Vec<CreepBranch>,
        viscosity_pa_s: Option<f64>,
    ) -> Result<Self, MaterialError> {
        let instantaneous_per_pa =
            non_negative("instantaneous compliance (1/Pa)", instantaneous_per_pa)?;
        let branches = checked_branches(
            branches,
            |branch| (branch.compliance_per_pa, branch.time_s),
            |branch, more| branch.compliance_per_pa += more,
            ["compliance", "1/Pa", "creep"],
        )?;
        if let Some(viscosity) = viscosity_pa_s {
            positive("viscosity (Pa s)", viscosity)?;
        }
        let creep = Creep {
            instantaneous_per_pa,
            branches,
            viscosity_pa_s,
        };
        let retarded = creep.retarded_compliance();
        in_range("the sum of the compliances", retarded)?;
        if retarded == 0.0 && viscosity_pa_s.is_none() {
            return Err(MaterialError::NoCompliance);
        }
        Ok(creep)
    }

    /// Instantaneous (glassy) compliance `D_0 = D(0)`, in 1/Pa.
    pub fn instantaneous_compliance(&self) -> f64 {
        self.instantaneous_per_pa
    }

    /// The Kelvin elements, by ascending time, no two times equal.
    pub fn branches(&self) -> &[CreepBranch] {
        &self.branches
    }

    /// Viscosity `eta` of the dashpot in series, in Pa s; `None` for a solid.
    pub fn viscosity_pa_s(&self) -> Option<f64> {
        self.viscosity_pa_s
    }

    /// True if the strain grows without bound under a constant stress.
    pub fn is_fluid(&self) -> bool {
        self.viscosity_pa_s.is_some()
    }

    /// True if nothing yields at the first instant, as in the Kelvin-Voigt solid: such a material
    /// has no relaxation modulus, and its contact pressure is singular.
    pub fn is_instantaneously_rigid(&self) -> bool {
        self.instantaneous_per_pa == 0.0
    }

    /// Equilibrium compliance `D_0 + sum D_j`, in 1/Pa; `None` for a fluid, which never comes to rest.
    pub fn equilibrium_compliance(&self) -> Option<f64> {
        (!self.is_fluid()).then(|| self.retarded_compliance())
    }

    /// Creep compliance `D(t)`, in 1/Pa, at `time_s` after a unit step of stress; zero before it.
    pub fn compliance(&self, time_s: f64) -> f64 {
        if time_s < 0.0 {
            return 0.0;
        }
        let retarded: f64 = self
            .branches
            .iter()
            .map(|branch| -branch.compliance_per_pa * (-time_s / branch.time_s).exp_m1())
            .sum();
        let flow = self
            .viscosity_pa_s
            .map_or(0.0, |viscosity| time_s / viscosity);
        self.instantaneous_per_pa + retarded + flow
    }

    /// Complex compliance `D*(omega) = D' - i D''`, in 1/Pa (Ferry 1980, chapter 3), with
    /// `x_j = omega lambda_j`:
    /// `D' = D_0 + sum D_j/(1 + x_j^2)`, `D'' = sum D_j x_j/(1 + x_j^2) + 1/(omega eta)`.
    ///
    /// The imaginary part of the returned number is therefore `-D''`, never positive. Both parts
    /// are accurate to rounding at any frequency; at zero frequency a fluid has infinite `D''`.
    pub fn complex_compliance(&self, angular_frequency_rad_per_s: f64) -> Complex<f64> {
        let flow = self.flow_loss(angular_frequency_rad_per_s);
        let start = Complex::new(self.instantaneous_per_pa, -flow);
        self.branches.iter().fold(start, |sum, branch| {
            let debye = Debye::at(angular_frequency_rad_per_s * branch.time_s);
            sum + Complex::new(debye.relaxed, -debye.loss) * branch.compliance_per_pa
        })
    }

    /// Derivative of [`complex_compliance`](Self::complex_compliance) with respect to `ln omega`.
    pub(super) fn complex_compliance_slope(
        &self,
        angular_frequency_rad_per_s: f64,
    ) -> Complex<f64> {
        let flow = self.flow_loss(angular_frequency_rad_per_s);
        self.branches
            .iter()
            .fold(Complex::new(0.0, flow), |sum, branch| {
                let debye = Debye::at(angular_frequency_rad_per_s * branch.time_s);
                sum - Complex::new(debye.frozen_slope(), debye.loss_slope())
                    * branch.compliance_per_pa
            })
    }

    /// Complex modulus `E*(omega) = 1/D* = E' + i E''`, in Pa.
    ///
    /// At infinite frequency it is infinite for a material that is instantaneously rigid.
    pub fn complex_modulus(&self, angular_frequency_rad_per_s: f64) -> Complex<f64> {
        reciprocal(self.complex_compliance(angular_frequency_rad_per_s))
    }

    /// The same model with every compliance multiplied by `factor` (and the viscosity divided by
    /// it), for example 1 - nu^2 to go from the longitudinal to the contact compliance.
    ///
    /// # Errors
    /// A factor that is not positive and finite, or takes a compliance out of range.
    pub fn scaled(&self, factor: f64) -> Result<Self, MaterialError> {
        positive("factor on the creep compliance", factor)?;
        let mut branches = self.branches.clone();
        for branch in &mut branches {
            branch.compliance_per_pa *= factor;
        }
        let viscosity_pa_s = self.viscosity_pa_s.map(|viscosity| viscosity / factor);
        Creep::new(self.instantaneous_per_pa * factor, branches, viscosity_pa_s)
    }

    /// Two compliances under the same stress: their sum.
    ///
    /// # Errors
    /// A compliance beyond the range of a double.
    pub fn beside(&self, other: &Self) -> Result<Self, MaterialError> {
        let branches = self.branches.iter().chain(&other.branches).copied();
        // Fluidities add up.
        let fluidity = [self, other].map(|creep| creep.viscosity_pa_s.map_or(0.0, f64::recip));
        let fluidity = fluidity[0] + fluidity[1];
        Creep::new(
            self.instantaneous_per_pa + other.instantaneous_per_pa,
            branches.collect(),
            (fluidity > 0.0).then(|| fluidity.recip()),
        )
    }

    /// The relaxation modulus of the same material, exactly, from the zeros of
    /// the transformed series; nothing is fitted.
    ///
    /// # Errors
    /// [`MaterialError::NoRelaxationModulus`] without an instantaneous compliance; a relaxation
    /// time or modulus beyond the range of a double.
    pub fn to_relaxation(&self) -> Result<Relaxation, MaterialError> {
        conversion::creep_to_relaxation(self)
    }

    /// `D_0 + sum D_j`, whether or not the material flows beyond it.
    pub(super) fn retarded_compliance(&self) -> f64 {
        let retarded: f64 = self
            .branches
            .iter()
            .map(|branch| branch.compliance_per_pa)
            .sum();
        self.instantaneous_per_pa + retarded
    }

    /// The dashpot's part `1/(omega eta)` of `D''`.
    fn flow_loss(&self, angular_frequency_rad_per_s: f64) -> f64 {
        self.viscosity_pa_s.map_or(0.0, |viscosity| {
            1.0 / viscosity / angular_frequency_rad_per_s
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn branch(compliance_per_pa: f64, time_s: f64) -> CreepBranch {
        CreepBranch {
            compliance_per_pa,
            time_s,
        }
    }

    #[test]
    fn creep_begins_with_a_straight_line_that_is_not_lost_to_rounding() {
        let creep = Creep::new(0.0, vec![branch(1.0, 1.0)], None).unwrap();
        // 1 - exp(-t) = t (1 - t/2 + ...): at t = 1e-12 the series is exact to 1e-24.
        assert_relative_eq!(
            creep.compliance(1e-12),
            1e-12 * (1.0 - 0.5e-12),
            max_relative = 1e-15
        );
        assert_eq!(creep.compliance(f64::INFINITY), 1.0);
        assert_eq!(creep.compliance(-1.0), 0.0);
    }

    #[test]
    fn a_fluid_never_comes_to_rest() {
        let fluid = Creep::new(1.0, vec![branch(2.0, 3.0)], Some(4.0)).unwrap();
        assert_eq!(fluid.equilibrium_compliance(), None);
        assert_relative_eq!(
            fluid.compliance(3.0),
            1.0 + 2.0 * (1.0 - (-1f64).exp()) + 0.75,
            max_relative = 1e-15 // a few roundings
        );
        assert_eq!(fluid.complex_compliance(0.0).im, f64::NEG_INFINITY);
        assert_eq!(fluid.complex_modulus(0.0), Complex::new(0.0, 0.0));
        let solid = Creep::new(1.0, vec![branch(2.0, 3.0)], None).unwrap();
        assert_eq!(solid.equilibrium_compliance(), Some(3.0));
        assert_eq!(solid.complex_compliance(0.0), Complex::new(3.0, 0.0));
        assert_eq!(
            solid.complex_compliance(f64::INFINITY),
            Complex::new(1.0, 0.0)
        );
    }

    #[test]
    fn the_loss_compliance_is_minus_the_imaginary_part() {
        let creep = Creep::new(1.0, vec![branch(2.0, 0.5)], Some(10.0)).unwrap();
        let compliance = creep.complex_compliance(2.0); // x = 1
        assert_relative_eq!(compliance.re, 1.0 + 1.0, max_relative = 1e-15);
        assert_relative_eq!(compliance.im, -(1.0 + 0.05), max_relative = 1e-15);
        assert!(creep.complex_modulus(2.0).im > 0.0);
    }

    #[test]
    fn the_slope_is_the_derivative_by_the_logarithm_of_frequency() {
        let creep = Creep::new(1.0, vec![branch(2.0, 0.5), branch(1.0, 40.0)], Some(10.0)).unwrap();
        for omega in [1e-3, 0.03, 0.7, 5.0, 200.0] {
            let step = 1e-5f64;
            let forward = creep.complex_compliance(omega * step.exp());
            let backward = creep.complex_compliance(omega * (-step).exp());
            let difference = (forward - backward) / (2.0 * step);
            let slope = creep.complex_compliance_slope(omega);
            // A central difference is good to step^2 + eps/step, about 1e-10 of |D*|.
            assert!((difference - slope).norm() <= 1e-9 * forward.norm());
        }
    }

    #[test]
    fn scaling_multiplies_every_compliance_and_divides_the_viscosity() {
        let creep = Creep::new(1.0, vec![branch(2.0, 3.0)], Some(4.0)).unwrap();
        let doubled = creep.scaled(2.0).unwrap();
        assert_eq!(
            doubled,
            Creep::new(2.0, vec![branch(4.0, 3.0)], Some(2.0)).unwrap()
        );
        assert!(creep.scaled(0.0).is_err());
        assert!(creep.scaled(f64::NAN).is_err());
        assert!(creep.scaled(1e308).is_err()); // 2e308 is no double
    }

    #[test]
    fn a_rigid_first_instant_is_allowed_but_has_no_relaxation_modulus() {
        let voigt = Creep::new(0.0, vec![branch(1.0, 1.0)], None).unwrap();
        assert!(voigt.is_instantaneously_rigid());
        assert_eq!(
            voigt.to_relaxation(),
            Err(MaterialError::NoRelaxationModulus)
        );
        assert!(
            voigt
                .to_relaxation()
                .unwrap_err()
                .to_string()
                .contains("Dirac impulse")
        );
    }

    #[test]
    fn impossible_parameters_are_refused_by_name() {
        let message = |instantaneous, branches, viscosity| {
            Creep::new(instantaneous, branches, viscosity)
                .unwrap_err()
                .to_string()
        };
        assert!(message(-1.0, vec![], None).contains("instantaneous compliance"));
        assert!(
            message(1.0, vec![branch(-1.0, 1.0)], None).contains("compliance of creep branch 1")
        );
        assert!(message(1.0, vec![branch(1.0, f64::NAN)], None).contains("time of creep branch 1"));
        assert!(message(1.0, vec![], Some(0.0)).contains("viscosity"));
        assert_eq!(
            Creep::new(0.0, vec![], None),
            Err(MaterialError::NoCompliance)
        );
        assert!(Creep::new(0.0, vec![], Some(1.0)).is_ok());
    }
}
