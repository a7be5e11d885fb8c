//! Rigid indenters as gap functions: the undeformed gap g(x, y) between indenter and half-space, zero where they first touch.
//!
//! An indenter knows its geometry and nothing of contact, but for two facts of its own shape: which springs of the method of
//! dimensionality reduction stand for it (the transformed gap G), and how large an elastic contact it makes, which sizes the
//! computational domain.

mod cone;
mod flat_punch;
mod sphere;

pub use cone::Cone;
pub use flat_punch::FlatPunch;
pub use sphere::Sphere;

use crate::quantity::Dimension;

/// One number of a shape, as a sweep file names it, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    pub key: &'static str,
    pub value: f64,
    pub dimension: Dimension,
}

/// Why a shape is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum IndenterError {
    #[error("the indenter's {what} is {value_m} m; it must be a positive, finite length")]
    Length { what: &'static str, value_m: f64 },
    #[error(
        "the cone's half angle is {half_angle_rad} rad; it must lie between 0 and pi/2 (90 deg), both excluded"
    )]
    HalfAngle { half_angle_rad: f64 },
}

/// A rigid indenter, pressed along its axis into the half-space.
pub trait Indenter: std::fmt::Debug + Send + Sync {
    /// The name of the shape as written in a sweep file.
    fn shape(&self) -> &'static str;

    /// The numbers that make the shape.
    fn parameters(&self) -> Vec<Parameter>;

    /// Gap g(x, y) in metres before deformation, 0 at the lowest point; infinite where the indenter ends.
    fn gap_m(&self, x_m: f64, y_m: f64) -> f64;

    /// The shape as a convex body of revolution about the origin, where it is one.
    fn axisymmetric(&self) -> Option<&dyn Axisymmetric>;

    /// Half the side of the square that just holds the elastic contact under this load (N) and contact compliance (1/Pa).
    fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64;
}

/// A convex indenter of revolution, as the method of dimensionality reduction sees it
/// (V. L. Popov and M. Heß, Method of Dimensionality Reduction in Contact Mechanics and Friction, 2015).
pub trait Axisymmetric {
    /// Transformed gap G(x) = x * integral from 0 to x of g'(r) / sqrt(x^2 - r^2) dr, in metres, x >= 0.
    fn transformed_gap_m(&self, x_m: f64) -> f64;

    /// The radius at which the indenter ends and the contact with it, where the shape has one.
    fn contact_limit_m(&self) -> Option<f64>;

    /// Whether the contact pressure is finite everywhere; an apex or a sharp edge makes it unbounded.
    fn has_bounded_pressure(&self) -> bool;
}

/// A length that must be positive and finite.
fn positive_length(what: &'static str, value_m: f64) -> Result<f64, IndenterError> {
    if value_m.is_finite() && value_m > 0.0 {
        Ok(value_m)
    } else {
        Err(IndenterError::Length { what, value_m })
    }
}
