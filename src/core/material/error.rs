//! What can be wrong with a material, and what to write instead.

use thiserror::Error;

/// A material that cannot be built, converted or put into contact.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MaterialError {
    /// A parameter outside the range in which the model means something.
    #[error("{parameter} is {value:?}: it must be {requirement}")]
    Parameter {
        /// What the number is, for example `modulus of branch 2 (Pa)`.
        parameter: String,
        /// The number given.
        value: f64,
        /// The range that is allowed.
        requirement: &'static str,
    },

    /// Neither an equilibrium modulus nor a branch.
    #[error(
        "the relaxation modulus is zero at all times: give an equilibrium modulus, or at least one branch with a modulus and a time"
    )]
    NoStiffness,

    /// Neither an instantaneous compliance, nor a branch, nor a viscosity.
    #[error(
        "the creep compliance is zero at all times: give an instantaneous compliance, a viscosity, or at least one branch with a compliance and a time"
    )]
    NoCompliance,

    /// The relaxation modulus is no ordinary function of time.
    #[error(
        "a relaxation modulus was asked for, but the material has no instantaneous compliance (Kelvin-Voigt): its stress after a unit step of strain begins with a Dirac impulse; use the creep compliance, or give it an instantaneous spring (Zener solid)"
    )]
    NoRelaxationModulus,

    /// The contact problem has no bounded pressure.
    #[error(
        "the material has no instantaneous compliance (Kelvin-Voigt), so its contact pressure is singular at first touch; give it an instantaneous spring (Zener solid)"
    )]
    SingularContactPressure,

    /// No shear compliance goes with both.
    #[error(
        "a bulk modulus of {bulk_pa:e} Pa is too small for these moduli in tension: it must be above a ninth of the instantaneous Young's modulus, {least_pa:e} Pa"
    )]
    SmallBulkModulus { bulk_pa: f64, least_pa: f64 },

    /// No shear compliance need go with both.
    #[error(
        "a bulk modulus that relaxes goes with shear moduli or compliances, not with those of a test in tension"
    )]
    BulkRelaxationInTension,

    /// What needs a Poisson ratio that does not depend on time.
    #[error(
        "{what} needs a Poisson ratio that does not depend on time, and that of a material with a bulk modulus does"
    )]
    NoPoissonRatio {
        /// With its article.
        what: &'static str,
    },

    /// The result is beyond the range of a double.
    #[error(
        "{what} leaves the range of double precision numbers: check the units of moduli, compliances and times"
    )]
    OutOfRange {
        /// What was being computed.
        what: &'static str,
    },
}

/// Accepts a finite, strictly positive number.
pub(super) fn positive(parameter: impl Into<String>, value: f64) -> Result<f64, MaterialError> {
    if value.is_finite() && value > 0.0 {
        return Ok(value);
    }
    Err(refused(parameter, value, "finite and greater than zero"))
}

/// Accepts a finite number that is zero or greater.
pub(super) fn non_negative(parameter: impl Into<String>, value: f64) -> Result<f64, MaterialError> {
    if value.is_finite() && value >= 0.0 {
        // Minus zero compares equal to zero; keep only plus zero.
        return Ok(value.abs());
    }
    Err(refused(parameter, value, "finite and not negative"))
}

/// Branches by ascending time, those of equal times added together, of positive strengths and times; `of` gives both. What they are in
/// messages: strength, unit, function.
pub(super) fn checked_branches<B>(
    mut branches: Vec<B>,
    of: fn(&B) -> (f64, f64),
    add: fn(&mut B, f64),
    [strength, unit, function]: [&str; 3],
) -> Result<Vec<B>, MaterialError> {
    for (index, branch) in branches.iter().enumerate() {
        let (name, (value, time_s)) = (format!("{function} branch {}", index + 1), of(branch));
        positive(format!("{strength} of {name} ({unit})"), value)?;
        positive(format!("time of {name} (s)"), time_s)?;
    }
    branches.sort_by(|left, right| of(left).1.total_cmp(&of(right).1));
    branches.dedup_by(|next, kept| {
        let (strength, time_s) = of(next);
        let same = time_s == of(kept).1;
        if same {
            add(kept, strength);
        }
        same
    });
    Ok(branches)
}

/// A parameter that does not meet its requirement.
pub(super) fn refused(
    parameter: impl Into<String>,
    value: f64,
    requirement: &'static str,
) -> MaterialError {
    MaterialError::Parameter {
        parameter: parameter.into(),
        value,
        requirement,
    }
}

/// Accepts a computed number that is still finite.
pub(super) fn in_range(what: &'static str, value: f64) -> Result<f64, MaterialError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(MaterialError::OutOfRange { what })
    }
}
