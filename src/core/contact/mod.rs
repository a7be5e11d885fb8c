//! One instant of contact: given the gap field, the displacement that history left, one compliance number and the drive's
//! value, find pressure and approach.
//!
//! With u = B (A p + H) the displacement of the surface, at every node
//!
//! ```text
//! h = g + B (A p + H) - delta,   p >= 0,  h >= 0,  p h = 0
//! ```
//!
//! where p is the unknown, A (1/Pa) the compliance that multiplies it, H the part of the hereditary integral that earlier
//! times fixed, B the elastic operator and delta the approach. Either the load W or delta is prescribed. Two engines:
//!
//! * [`axisymmetric`]: independent springs (method of dimensionality reduction), exact for convex bodies of revolution;
//!   B = 1 and the "pressure" of a node is the line force f of its spring in N/m;
//! * [`half_space`]: rectangular cells of uniform pressure on the half-space, for any shape.
//!
//! Neither knows what material, indenter or drive the numbers came from.
//!
//! ```
//! # extern crate contact_dma_core as contact_dma;
//! use contact_dma::contact::axisymmetric::{Axisymmetric, Edge};
//! use contact_dma::contact::{ContactError, Engine, Instant, Prescribed};
//!
//! // Springs under a sphere of 10 mm, whose transformed gap is x^2 / R.
//! let width_m = 3e-6;
//! let gaps_m = (0..200).map(|i| ((f64::from(i) + 0.5) * width_m).powi(2) / 0.01);
//! let mut engine = Axisymmetric::new(width_m, gaps_m.collect(), Edge::Open, true);
//! let mut pressure = vec![0.0; engine.nodes()];
//! let instant = Instant {
//!     history: &vec![0.0; engine.nodes()],
//!     compliance_per_pa: 1e-9,
//!     prescribed: Prescribed::LoadN(10.0),
//! };
//! let solution = engine.solve(&instant, &mut pressure)?;
//! // Hertz: W = 4/3 E* R^(1/2) delta^(3/2).
//! let hertz_m = (10.0 * 1e-9 * 0.75 / 0.1_f64).powf(2.0 / 3.0);
//! assert!((solution.approach_m / hertz_m - 1.0).abs() < 1e-3);
//! # Ok::<(), ContactError>(())
//! ```

pub mod axisymmetric;
pub mod half_space;
pub mod statistics;
pub(crate) mod sums;
pub mod surface;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use half_space::grid::Grid;
use surface::{CellSurface, PressureLine, Response, Surface};

/// The quantity that the drive imposes at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Prescribed {
    /// Normal load W (N), not negative.
    LoadN(f64),
    /// Rigid-body approach delta (m).
    ApproachM(f64),
}

/// What is known before an instant is solved.
#[derive(Debug, Clone, Copy)]
pub struct Instant<'a> {
    /// H per node: the hereditary part in 1/Pa times the unit of the engine's nodal pressure.
    pub history: &'a [f64],
    /// A in 1/Pa: the instantaneous compliance, plus what the time rule adds to it.
    pub compliance_per_pa: f64,
    /// What the drive asks for.
    pub prescribed: Prescribed,
}

/// What an instant came to. The nodal pressures are in the slice handed to [`Engine::solve`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Solution {
    /// Normal load W (N).
    pub load_n: f64,
    /// Approach delta (m). Under zero load: the approach at which the indenter just touches the surface.
    pub approach_m: f64,
    /// Radius of the circle whose area is the contact area (m).
    pub contact_radius_m: f64,
    /// Iterations the solver took.
    pub iterations: usize,
    /// Convolutions with the elastic operator that took; 0 from an engine without one.
    pub convolutions: usize,
}

/// Why an instant could not be solved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ContactError {
    #[error(
        "the contact reached the edge of the computational domain (half width {half_width_m:.3e} m)"
    )]
    ReachedEdge { half_width_m: f64 },
    #[error(
        "the contact solver stopped after {iterations} iterations at a residual of {residual:e}, above its tolerance {tolerance:e}"
    )]
    NotConverged {
        iterations: usize,
        residual: f64,
        tolerance: f64,
    },
    #[error("interrupted")]
    Interrupted,
    #[error("a load of {load_n:e} N pulls the surfaces apart: no contact bears it")]
    PulledOff { load_n: f64 },
    #[error(
        "the indenter comes no farther than an approach of {approach_m:.3e} m, at which the surfaces do not attract one another: their gap \
         is above the range, {range_m:.3e} m"
    )]
    NeverAttracted { approach_m: f64, range_m: f64 },
    #[error("{reason}")]
    Operator { reason: String },
    #[error("the prescribed {what} is {value}: it must be finite{also}")]
    Drive {
        what: &'static str,
        value: f64,
        also: &'static str,
    },
}

/// A solver for one instant of contact. State carried between instants may only speed up the next one: the answer is a
/// function of gap and [`Instant`] alone, to the solver's tolerance.
pub trait Engine: Send {
    /// Number of nodes: the length of every nodal slice.
    fn nodes(&self) -> usize {
        self.gap_m().len()
    }

    /// The initial gap g of every node (m).
    fn gap_m(&self) -> &[f64];

    /// Whether a starting guess nearer to the answer saves this engine work.
    fn starts_from_guess(&self) -> bool {
        false
    }

    /// Solves one instant. `pressure` holds the starting guess and receives the answer.
    ///
    /// # Errors
    /// [`ContactError`]; `pressure` is then meaningless.
    fn solve(
        &mut self,
        instant: &Instant<'_>,
        pressure: &mut [f64],
    ) -> Result<Solution, ContactError>;

    /// The largest contact pressure (Pa); `None` where the indenter's shape makes it unbounded. 0 out of contact.
    ///
    /// # Errors
    /// [`ContactError`] where the pressure cannot be computed.
    fn peak_pressure_pa(
        &mut self,
        pressure: &[f64],
        solution: &Solution,
    ) -> Result<Option<f64>, ContactError>;

    /// Radius (m) of the round flat punch that is as stiff as the contact while its shape does not change: for a contact of any
    /// shape what the radius is for a disc, 0 out of contact. Also the convolutions that took.
    ///
    /// # Errors
    /// [`ContactError`] where the stiffness cannot be computed.
    fn tangent_radius_m(
        &mut self,
        _pressure: &[f64],
        solution: &Solution,
    ) -> Result<(f64, usize), ContactError> {
        Ok((solution.contact_radius_m, 0))
    }

    /// The contact pressure (Pa) along lines through the origin: from the axis to the edge of the contact, or along x and along y
    /// over all cells.
    fn pressure_lines(&self, pressure: &[f64], solution: &Solution) -> Vec<PressureLine>;

    /// Gives the engine a flag that ends an instant under way with [`ContactError::Interrupted`]; engines whose instants are
    /// short need none.
    fn interrupted_by(&mut self, _flag: Arc<AtomicBool>) {}

    /// The tolerance of an instant; `None` of engines that solve exactly.
    fn tolerance(&self) -> Option<f64> {
        None
    }

    /// Gives the engine another one, where it has any.
    fn tolerate(&mut self, _tolerance: f64) {}

    /// Makes the engine what it was after the instant that came to `last`: what it carries from one instant to the next, which
    /// may only speed up the next, is then the same, and so is every bit and count of what follows.
    fn resume_from(&mut self, _last: &Solution) {}

    /// B p: the displacement per node that this nodal pressure makes, per unit of compliance. Returns the number of
    /// convolutions it took.
    ///
    /// # Errors
    /// [`ContactError::Operator`], for slices of the wrong length alone.
    fn elastic_displacement(
        &mut self,
        pressure: &[f64],
        displacement: &mut [f64],
    ) -> Result<usize, ContactError>;

    /// What the nodal pressure of a node is multiplied by to give its part of the load.
    fn load_per_nodal_pressure(&self, node: usize) -> f64;

    /// The energy of nodal pressures over nodal displacements: the sum of their products, each times
    /// [`Engine::load_per_nodal_pressure`].
    fn work(&self, pressure: &[f64], displacement: &[f64]) -> f64 {
        let products = pressure.iter().zip(displacement).enumerate();
        products
            .map(|(node, (p, u))| self.load_per_nodal_pressure(node) * p * u)
            .sum()
    }

    /// The density over the surface of what adds up over the nodes like a pressure; nothing of it lies beyond `radius_m`.
    ///
    /// # Errors
    /// As [`Engine::surface`].
    fn surface_density(&mut self, nodal: &[f64], radius_m: f64) -> Result<Surface, ContactError> {
        self.surface(&Response {
            pressure: nodal,
            history: &vec![0.0; nodal.len()],
            compliance_per_pa: 0.0,
            contact_radius_m: radius_m,
        })
    }

    /// Pressure and displacement of the surface, inside and outside the contact.
    ///
    /// # Errors
    /// [`ContactError::Operator`], for slices of the wrong length alone.
    fn surface(&mut self, response: &Response<'_>) -> Result<Surface, ContactError>;

    /// The same over cells: the engine's own, or, of an engine that has none, those of `grid`.
    ///
    /// # Errors
    /// As [`Engine::surface`].
    fn field(&mut self, response: &Response<'_>, _grid: &Grid) -> Result<Surface, ContactError> {
        self.surface(response)
    }
}

impl Prescribed {
    /// Refuses loads and approaches that no contact can have.
    fn check(self) -> Result<Self, ContactError> {
        match self {
            Self::LoadN(value) if !(value.is_finite() && value >= 0.0) => {
                Err(ContactError::Drive {
                    what: "load",
                    value,
                    also: " and not negative, because a contact without adhesion cannot carry a pull",
                })
            }
            Self::ApproachM(value) if !value.is_finite() => Err(ContactError::Drive {
                what: "approach",
                value,
                also: "",
            }),
            fine => Ok(fine),
        }
    }
}

/// [`ContactError::Interrupted`] where a flag asks to end an instant.
fn go_on(interrupt: Option<&AtomicBool>) -> Result<(), ContactError> {
    match interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
        true => Err(ContactError::Interrupted),
        false => Ok(()),
    }
}

/// [`Engine::surface`] of an engine whose nodes are the cells of a grid.
fn surface_of_cells(
    engine: &mut impl Engine,
    grid: &Grid,
    response: &Response<'_>,
) -> Result<Surface, ContactError> {
    let nodes = response.pressure.iter().zip(response.history);
    let hereditary = nodes.map(|(p, h)| response.compliance_per_pa * p + h);
    let mut displacement_m = vec![0.0; response.pressure.len()];
    engine.elastic_displacement(&hereditary.collect::<Vec<f64>>(), &mut displacement_m)?;
    Ok(Surface::Cells(CellSurface {
        grid: grid.whole(),
        pressure_pa: grid.unfolded(response.pressure),
        displacement_m: grid.unfolded(&displacement_m),
    }))
}
