//! The relaxation modulus as a generalised Maxwell (Wiechert) model: a Prony series.
//!
//! ```text
//!        |---- g_inf --------------|
//!     ---|---- g_1 ---- [tau_1] ---|---      g_i: spring, [tau_i]: dashpot g_i * tau_i
//!        |---- g_2 ---- [tau_2] ---|
//! ```
//!
//! `E(t) = g_inf + sum g_i exp(-t/tau_i)`; J. D. Ferry, *Viscoelastic Properties of Polymers*,
//! 3rd edition, Wiley 1980, chapters 1 and 3; N. W. Tschoegl, *The Phenomenological Theory of
//! Linear Viscoelastic Behavior*, Springer 1989, chapter 3.

use num_complex::Complex;
use serde::Serialize;

use super::conversion;
use super::creep::Creep;
use super::error::{MaterialError, checked_branches, in_range, non_negative, positive};
use super::harmonic::{Debye, reciprocal};
use crate::block;
use crate::quantity::Dimension::{Stress, Time};
use crate::quantity::key::{Kind, quantity};

/// What to write where a branch has no strength or no time.
pub(super) const NO_BRANCH: &str = "write a positive number, or leave the branch out";

block! {
    /// A branch.
    #[derive(Copy, Serialize)]
    pub struct RelaxationBranch in "branches" {
        /// Modulus of the branch.
        modulus_pa: f64 => "modulus", Kind::Number(quantity(Stress).above_zero().or_else(NO_BRANCH));
        /// Relaxation time, or retardation time of a creep series.
        time_s: f64 => "time", Kind::Number(quantity(Time).above_zero().or_else(NO_BRANCH));
    }
}

/// A relaxation modulus `E(t) = g_inf + sum g_i exp(-t/tau_i)`, in Pa.
///
/// Whether it is a longitudinal or a shear modulus is said by the
/// [`Material`](super::Material) that holds it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Relaxation {
    equilibrium_pa: f64,
    branches: Vec<RelaxationBranch>,
}

impl Relaxation {
    /// A Prony series; branches may come in any order, and equal times are merged.
    ///
    /// # Errors
    /// A modulus or time that is not finite; a branch modulus or a time that is not positive; a
    /// negative equilibrium modulus; a modulus that is zero at all times; a sum that overflows.
    pub fn new(
        equilibrium_pa: f64,
        branches: Vec<RelaxationBranch>,
    ) -> Result<Self, MaterialError> {
        let equilibrium_pa = non_negative("equilibrium modulus (Pa)", equilibrium_pa)?;
        let branches = checked_branches(
            branches,
            |branch| (branch.modulus_pa, branch.time_s),
            |branch, more| branch.modulus_pa += more,
            ["modulus", "Pa", "relaxation"],
        )?;
        let relaxation = Relaxation {
            equilibrium_pa,
            branches,
        };
        let instantaneous = relaxation.instantaneous_modulus();
        in_range("the instantaneous modulus", instantaneous)?;
        if instantaneous == 0.0 {
            return Err(MaterialError::NoStiffness);
        }
        Ok(relaxation)
    }

    /// Equilibrium (rubbery, long-term) modulus `g_inf`, in Pa; zero for a fluid.
    pub fn equilibrium_modulus(&self) -> f64 {
        self.equilibrium_pa
    }

    /// The Maxwell elements, by ascending time, no two times equal.
    pub fn branches(&self) -> &[RelaxationBranch] {
        &self.branches
    }

    /// Instantaneous (glassy) modulus `E(0) = g_inf + sum g_i`, in Pa.
    pub fn instantaneous_modulus(&self) -> f64 {
        self.equilibrium_pa
            + self
                .branches
                .iter()
                .map(|branch| branch.modulus_pa)
                .sum::<f64>()
    }

    /// True if the stress relaxes to nothing under a constant strain.
    pub fn is_fluid(&self) -> bool {
        self.equilibrium_pa == 0.0
    }

    /// Steady-flow viscosity of a fluid, `eta = sum g_i tau_i`, in Pa s; `None` for a solid.
    pub fn viscosity_pa_s(&self) -> Option<f64> {
        self.is_fluid().then(|| {
            self.branches
                .iter()
                .map(|branch| branch.modulus_pa * branch.time_s)
                .sum()
        })
    }

    /// Relaxation modulus `E(t)`, in Pa, at `time_s` after a unit step of strain; zero before it.
    pub fn modulus(&self, time_s: f64) -> f64 {
        if time_s < 0.0 {
            return 0.0;
        }
        let transient: f64 = self
            .branches
            .iter()
            .map(|branch| branch.modulus_pa * (-time_s / branch.time_s).exp())
            .sum();
        self.equilibrium_pa + transient
    }

    /// Complex modulus `E*(omega) = E' + i E''`, in Pa (Ferry 1980, chapter 3):
    /// `E' = g_inf + sum g_i x_i^2/(1 + x_i^2)`, `E'' = sum g_i x_i/(1 + x_i^2)`, `x_i = omega tau_i`.
    ///
    /// Both parts are accurate to rounding at any frequency, zero and infinity included.
    pub fn complex_modulus(&self, angular_frequency_rad_per_s: f64) -> Complex<f64> {
        self.branches
            .iter()
            .fold(Complex::new(self.equilibrium_pa, 0.0), |sum, branch| {
                let debye = Debye::at(angular_frequency_rad_per_s * branch.time_s);
                sum + Complex::new(debye.frozen, debye.loss) * branch.modulus_pa
            })
    }

    /// Complex compliance `D*(omega) = 1/E* = D' - i D''`, in 1/Pa; infinite for a fluid at rest.
    pub fn complex_compliance(&self, angular_frequency_rad_per_s: f64) -> Complex<f64> {
        reciprocal(self.complex_modulus(angular_frequency_rad_per_s))
    }

    /// The same model with every modulus multiplied by `factor`, for example 2 (1 + nu) to go
    /// from shear to longitudinal at constant Poisson ratio.
    ///
    /// # Errors
    /// A factor that is not positive and finite, or takes a modulus out of range.
    pub fn scaled(&self, factor: f64) -> Result<Self, MaterialError> {
        positive("factor on the relaxation modulus", factor)?;
        let mut branches = self.branches.clone();
        for branch in &mut branches {
            branch.modulus_pa *= factor;
        }
        Relaxation::new(self.equilibrium_pa * factor, branches)
    }

    /// The creep compliance of the same material, exactly, from the zeros of
    /// the transformed series; nothing is fitted.
    ///
    /// # Errors
    /// A retardation time or compliance beyond the range of a double.
    pub fn to_creep(&self) -> Result<Creep, MaterialError> {
        conversion::relaxation_to_creep(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn branch(modulus_pa: f64, time_s: f64) -> RelaxationBranch {
        RelaxationBranch { modulus_pa, time_s }
    }

    #[test]
    fn branches_are_sorted_and_equal_times_merged() {
        let relaxation = Relaxation::new(
            1.0,
            vec![branch(2.0, 30.0), branch(3.0, 4.0), branch(5.0, 30.0)],
        )
        .unwrap();
        assert_eq!(
            relaxation.branches(),
            &[branch(3.0, 4.0), branch(7.0, 30.0)]
        );
        assert_eq!(relaxation.instantaneous_modulus(), 11.0);
        assert_eq!(relaxation.modulus(0.0), 11.0);
        assert_eq!(relaxation.modulus(f64::INFINITY), 1.0);
        assert_eq!(relaxation.modulus(-1.0), 0.0);
    }

    #[test]
    fn a_maxwell_element_has_its_closed_form_modulus_at_any_frequency() {
        let (modulus_pa, time_s) = (3.0e9, 8.93);
        let relaxation = Relaxation::new(0.0, vec![branch(modulus_pa, time_s)]).unwrap();
        for exponent in -12..=12 {
            let x = 10f64.powi(exponent);
            let modulus = relaxation.complex_modulus(x / time_s);
            // Closed form with a few roundings in x and in each quotient.
            assert_relative_eq!(
                modulus.re,
                modulus_pa * x * x / (1.0 + x * x),
                max_relative = 2e-15
            );
            assert_relative_eq!(
                modulus.im,
                modulus_pa * x / (1.0 + x * x),
                max_relative = 2e-15
            );
        }
        assert_eq!(relaxation.complex_modulus(0.0), Complex::new(0.0, 0.0));
        assert_eq!(
            relaxation.complex_modulus(f64::INFINITY),
            Complex::new(modulus_pa, 0.0)
        );
        // omega tau = 1e300 and 1e-300: the loss keeps its value, nothing overflows.
        let extreme = Relaxation::new(0.0, vec![branch(1.0, 1e150)]).unwrap();
        assert_relative_eq!(
            extreme.complex_modulus(1e150).im,
            1e-300,
            max_relative = 1e-15
        );
        let extreme = Relaxation::new(0.0, vec![branch(1.0, 1e-150)]).unwrap();
        assert_relative_eq!(
            extreme.complex_modulus(1e-150).im,
            1e-300,
            max_relative = 1e-15
        );
    }

    #[test]
    fn a_fluid_has_a_viscosity_and_a_solid_has_none() {
        let fluid = Relaxation::new(0.0, vec![branch(2.0, 3.0), branch(5.0, 7.0)]).unwrap();
        assert_eq!(fluid.viscosity_pa_s(), Some(41.0));
        let solid = Relaxation::new(1.0, vec![branch(2.0, 3.0)]).unwrap();
        assert_eq!(solid.viscosity_pa_s(), None);
    }

    #[test]
    fn impossible_parameters_are_refused_by_name() {
        let message = |equilibrium, branches| {
            Relaxation::new(equilibrium, branches)
                .unwrap_err()
                .to_string()
        };
        assert!(message(-1.0, vec![]).contains("equilibrium modulus (Pa) is -1.0"));
        assert!(message(f64::NAN, vec![]).contains("equilibrium modulus"));
        assert!(message(1.0, vec![branch(1.0, 1.0), branch(0.0, 1.0)]).contains("branch 2"));
        assert!(message(1.0, vec![branch(1.0, -1.0)]).contains("time of relaxation branch 1"));
        assert!(message(1.0, vec![branch(f64::INFINITY, 1.0)]).contains("finite"));
        assert_eq!(
            Relaxation::new(0.0, vec![]),
            Err(MaterialError::NoStiffness)
        );
        assert!(message(1e308, vec![branch(1e308, 1.0)]).contains("range"));
    }
}
