//! Rigid indenters as gap functions: the undeformed gap g(x, y) between indenter and half-space, zero where they first touch.
//!
//! An indenter knows its geometry and nothing of contact, but for two facts of its own shape: which springs of the method of
//! dimensionality reduction stand for it (the transformed gap G), and how large an elastic contact it makes, which sizes the
//! computational domain.
//!
//! ```
//! # extern crate contact_dma_core as contact_dma;
//! use contact_dma::indenter::{Indenter, IndenterError, Sphere};
//!
//! let sphere = Sphere::new(0.01)?; // radius, m
//! assert_eq!(sphere.gap_m(0.0, 0.0), 0.0);
//! assert!((sphere.gap_m(3e-4, 4e-4) - 1.25e-5).abs() < 1e-20);
//! # Ok::<(), IndenterError>(())
//! ```

pub mod asperities;
mod cone;
mod ellipsoid;
mod flat_punch;
pub mod height_map;
mod power_law;
mod profile;
mod reach;
mod rough;
pub mod shifted;
mod sphere;

pub use asperities::{Asperities, Asperity};
pub use cone::{Cone, ConeKeys};
pub use ellipsoid::Ellipsoid;
pub use flat_punch::FlatPunch;
pub use height_map::{HeightMap, MapEdge, MapQuantity};
pub use power_law::{PowerLaw, PowerLawKeys};
pub use profile::Profile;
pub use reach::radius_under_approach_m;
pub use rough::Roughness;
pub use shifted::Shifted;
pub use sphere::Sphere;

use crate::keys;
use crate::quantity::Dimension;
use crate::quantity::block::Block;
use crate::quantity::key::{Kind, quantity};
pub use crate::quantity::setting::{Setting, Value};

/// What a length must be.
const LENGTH: Kind = Kind::Number(quantity(Dimension::Length).above_zero());

/// What to write in place of more or fewer numbers than a place on the surface takes.
pub const POSITION: &str = "write one for x and one for y: [\"1 um\", \"0 um\"]";

keys! {
    /// Data file; its path is relative to this file, in a flag to the working folder.
    FILE = "file", Kind::Text;
    /// SHA-256 of the data file, in hexadecimal, to make sure that it has not changed.
    SHA256 = "sha256", Kind::Text, optional;
}

/// The settings of a data file: its absolute path, so that it can be read again from anywhere, and the SHA-256 of its bytes.
pub fn data_file(file: &str, sha256: &str) -> Vec<Setting> {
    [(FILE, file), (SHA256, sha256)]
        .map(|(key, value)| Setting::new(key.name, value))
        .into()
}

/// The part of the surface that the half-space engine covers with cells: a rectangle centred on the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Domain {
    /// A rectangle that just holds the elastic contact, and that may be enlarged.
    Around {
        /// Along x and y.
        half_widths_m: (f64, f64),
        /// Side of a cell along x over that along y which resolves the contact equally well in both directions.
        cell_aspect_ratio: f64,
        /// Half widths (m) along x and y beyond which the shape is not known, where there are such.
        limit_m: Option<(f64, f64)>,
    },
    /// One cell for every point at which the shape is known, which cannot be enlarged.
    Cells {
        /// Along x and y.
        cells: (usize, usize),
        spacing_m: (f64, f64),
    },
}

impl Domain {
    /// A rectangle of these half widths, of square cells.
    fn around(half_widths_m: (f64, f64)) -> Self {
        Self::Around {
            half_widths_m,
            cell_aspect_ratio: 1.0,
            limit_m: None,
        }
    }
}

/// The sharp rim of a face: a circle at which indenter and contact end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rim {
    pub center_x_m: f64,
    pub center_y_m: f64,
    pub radius_m: f64,
}

/// Why a shape is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IndenterError {
    #[error("the indenter's {what} is {value_m} m; it must be a positive, finite length")]
    Length { what: &'static str, value_m: f64 },
    #[error(
        "the cone's half angle is {half_angle_rad} rad; it must lie between 0 and pi/2 (90 deg), both excluded"
    )]
    HalfAngle { half_angle_rad: f64 },
    #[error(
        "the power law's exponent is {exponent}; it must lie between 1 (a cone) and {}, both included",
        power_law::MAX_EXPONENT
    )]
    Exponent { exponent: f64 },
    #[error("the {what} is {value_m} m; it must be a finite length")]
    Position { what: &'static str, value_m: f64 },
    #[error("there are no asperities; give at least one")]
    NoAsperities,
    #[error("the profile has {points} points; give at least 2, the first on the axis")]
    TooFewPoints { points: usize },
    #[error("the profile begins at r = {radius_m:e} m; it must begin on the axis, at r = 0")]
    ProfileStart { radius_m: f64 },
    #[error(
        "point {point} of the profile is (r, gap) = ({radius_m:e} m, {gap_m:e} m): radii must increase, and both must be finite"
    )]
    ProfilePoint {
        /// Counted from 1.
        point: usize,
        radius_m: f64,
        gap_m: f64,
    },
    #[error(
        "the map has {cells_x} x {cells_y} points; it needs at least {} in each direction and at most {} in all",
        height_map::MIN_CELLS,
        height_map::MAX_CELLS
    )]
    MapSize { cells_x: usize, cells_y: usize },
    #[error("the map has {found} values where {expected} are needed")]
    MapLength { found: usize, expected: usize },
    #[error("the map has a hole: its value at column {column}, row {row} is {value}")]
    MapHole {
        /// Both counted from 1.
        column: usize,
        row: usize,
        value: f64,
    },
    #[error(
        "a rough sphere does not repeat itself: leave out sphere_radius, or edge = \"periodic\""
    )]
    PeriodicSphere,
    #[error("the Hurst exponent is {hurst}; it must lie between 0 and 1, both included")]
    Hurst { hurst: f64 },
    #[error("the rough surface has {cells} cells per side; give from {} to {}", rough::CELLS.start(), rough::CELLS.end())]
    RoughCells { cells: usize },
    #[error(
        "the wavelengths of the rough surface must obey 2 spacing <= cut-off < roll-off <= side, but they are \
         2 x {spacing_m:e} m, {cut_off_m:e} m, {roll_off_m:e} m, {side_m:e} m"
    )]
    Wavelengths {
        spacing_m: f64,
        cut_off_m: f64,
        roll_off_m: f64,
        side_m: f64,
    },
}

impl IndenterError {
    /// The key of the number that it is about, where that is one which a file may have as it is.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::HalfAngle { .. } => Some("half_angle"),
            Self::Exponent { .. } => Some("exponent"),
            Self::Hurst { .. } => Some("hurst_exponent"),
            _ => None,
        }
    }
}

/// A rigid indenter, pressed along its axis into the half-space.
pub trait Indenter: std::fmt::Debug + Send + Sync {
    /// The name of the shape as written in a sweep file.
    fn shape(&self) -> &'static str;

    /// The settings that make the shape.
    fn parameters(&self) -> Vec<Setting>;

    /// Gap g(x, y) in metres before deformation, 0 at the lowest point; infinite where the indenter ends.
    fn gap_m(&self, x_m: f64, y_m: f64) -> f64;

    /// The shape that this one is made of, where there is one: it answers whatever this one does not answer itself.
    fn made_of(&self) -> Option<&dyn Indenter> {
        None
    }

    /// The shape as a convex body of revolution about its own axis, where it is one.
    fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
        self.made_of()?.axisymmetric()
    }

    /// Why there is no [`Indenter::axisymmetric`], to follow "the SHAPE".
    fn not_axisymmetric_because(&self) -> String {
        match self.made_of() {
            Some(shape) => shape.not_axisymmetric_because(),
            None => "is not a body of revolution".to_owned(),
        }
    }

    /// The rim at which the shape ends, where it has one.
    fn rim(&self) -> Option<Rim> {
        match self.made_of() {
            Some(shape) => shape.rim(),
            None => Some(Rim {
                center_x_m: 0.0,
                center_y_m: 0.0,
                radius_m: self.axisymmetric()?.contact_limit_m()?,
            }),
        }
    }

    /// Whether the shape is one of revolution about the origin, convex or not, as far as a few gaps within this radius (m) tell.
    fn is_of_revolution_within(&self, radius_m: f64) -> bool {
        /// Around the axis, at angles that share no symmetry.
        const ANGLES: usize = 7;
        const RADII: usize = 16;
        /// Of the largest gap there: what rounding may make of equal ones.
        const ROUNDING: f64 = 1e-9;
        let at = |k: usize| radius_m * k as f64 / RADII as f64;
        let on_x = |k: usize| self.gap_m(at(k), 0.0);
        let gaps = (1..=RADII).map(on_x).filter(|gap_m| gap_m.is_finite());
        let slack_m = ROUNDING * gaps.fold(0.0_f64, |a, gap_m| a.max(gap_m.abs()));
        (1..=RADII).all(|k| {
            let gap_m = on_x(k);
            (1..=ANGLES).all(|turn| {
                let (sine, cosine) = (turn as f64).sin_cos();
                let other_m = self.gap_m(at(k) * cosine, at(k) * sine);
                other_m == gap_m || (other_m - gap_m).abs() <= slack_m
            })
        })
    }

    /// Radius (m) of a spherical tip, where the shape is one.
    fn tip_radius_m(&self) -> Option<f64> {
        self.made_of()?.tip_radius_m()
    }

    /// Half the side of the square that just holds the elastic contact under this load (N) and contact compliance (1/Pa).
    ///
    /// Of a body of revolution this is the radius of the contact, exactly: elastic scales of figures are made of it, and the linearised model
    /// of an identification takes its slope over the load.
    fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64;

    /// Where the half-space engine puts its cells under this load (N) and contact compliance (1/Pa).
    fn domain(&self, load_n: f64, compliance_per_pa: f64) -> Domain {
        match self.made_of() {
            Some(shape) => shape.domain(load_n, compliance_per_pa),
            None => {
                let half_width_m = self.elastic_half_width_m(load_n, compliance_per_pa);
                Domain::around((half_width_m, half_width_m))
            }
        }
    }

    /// Whether the shape repeats itself without end, and [`Indenter::own_cells`] are one period of it.
    fn is_periodic(&self) -> bool {
        self.made_of().is_some_and(|shape| shape.is_periodic())
    }

    /// Area (m^2) of one period of a shape that repeats itself.
    fn period_area_m2(&self) -> Option<f64> {
        match self.domain(1.0, 1.0) {
            Domain::Cells { cells, spacing_m } if self.is_periodic() => {
                Some((cells.0 as f64 * spacing_m.0) * (cells.1 as f64 * spacing_m.1))
            }
            _ => None,
        }
    }

    /// Points along x and y at which the shape is known, where it is a map: the half-space engine has a cell on each of them.
    fn own_cells(&self) -> Option<(usize, usize)> {
        self.made_of()?.own_cells()
    }

    /// Half widths (m) along x and y of the rectangle about the origin that holds the contact under any approach up to this one
    /// (m).
    ///
    /// Unless a shape knows better: of a convex body of revolution its contact held for ever; of any other a square beyond which
    /// the gap is not below the approach, as far as lengths in steps of 9 % and 64 points along a side tell.
    fn half_widths_under_approach_m(&self, approach_m: f64) -> (f64, f64) {
        let half_width_m = match self.axisymmetric() {
            Some(body) => radius_under_approach_m(body, approach_m),
            None => reach::square_below_m(self, approach_m),
        };
        (half_width_m, half_width_m)
    }

    /// Whether an infinite gap means that the data end there and not the indenter, so that contact beside it is in doubt.
    fn ends_in_data(&self) -> bool {
        self.made_of().is_some_and(|shape| shape.ends_in_data())
    }

    /// Whether the contact pressure is finite everywhere; an apex or a sharp edge makes it unbounded.
    fn pressure_is_bounded(&self) -> bool {
        match self.made_of() {
            Some(shape) => shape.pressure_is_bounded(),
            None => (self.axisymmetric()).is_none_or(|body| body.has_bounded_pressure()),
        }
    }
}

/// A convex indenter of revolution, as the method of dimensionality reduction sees it
/// (V. L. Popov and M. Heß, Method of Dimensionality Reduction in Contact Mechanics and Friction, 2015).
pub trait Axisymmetric {
    /// Transformed gap G(x) = x * integral from 0 to x of g'(r) / sqrt(x^2 - r^2) dr, in metres, x >= 0.
    fn transformed_gap_m(&self, x_m: f64) -> f64;

    /// The radius at which the indenter ends and the contact with it, where the shape has one.
    fn contact_limit_m(&self) -> Option<f64> {
        None
    }

    /// The radius beyond which the shape is not known, where there is one; contact that reaches it is in doubt.
    fn known_radius_m(&self) -> Option<f64> {
        None
    }

    /// Whether the contact pressure is finite everywhere; an apex or a sharp edge makes it unbounded.
    fn has_bounded_pressure(&self) -> bool;

    /// Radii (m) at which the shape has an apex (0) or a sharp edge, and the pressure of a contact around them is unbounded; the
    /// rim of a shape that ends is none of them. An apex, unless a shape knows better.
    fn singular_radii_m(&self) -> Vec<f64> {
        match self.has_bounded_pressure() || self.contact_limit_m().is_some() {
            true => Vec::new(),
            false => vec![0.0],
        }
    }
}

/// The block of a shape, where its lengths are in the ranges of their keys.
///
/// # Errors
/// [`IndenterError::Length`] with the first that is not.
pub fn in_range<B: Block>(block: B) -> Result<B, IndenterError> {
    for (key, value) in B::KEYS.iter().zip(block.values()) {
        let number = value.as_ref().and_then(Value::number);
        if let (Some(value), Some(value_m)) = (value, number)
            && !key.kind.has(&value)
        {
            let what = key.name;
            return Err(IndenterError::Length { what, value_m });
        }
    }
    Ok(block)
}

/// A length that must be positive and finite.
fn positive_length(what: &'static str, value_m: f64) -> Result<f64, IndenterError> {
    if value_m.is_finite() && value_m > 0.0 {
        Ok(value_m)
    } else {
        Err(IndenterError::Length { what, value_m })
    }
}

/// A coordinate or height, which may have either sign.
fn finite_position(what: &'static str, value_m: f64) -> Result<f64, IndenterError> {
    if value_m.is_finite() {
        Ok(value_m)
    } else {
        Err(IndenterError::Position { what, value_m })
    }
}
