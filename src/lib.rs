//! `contact-dma`: dynamic mechanical analysis by contact.
//!
//! An indenter is pressed into a linear viscoelastic half-space under a load that oscillates about a mean. This crate computes the
//! stabilised cycle at many load frequencies and what it dissipates: energy loss per cycle, hysteresis loops, phase, harmonics,
//! equivalent storage and loss modulus. It implements S. Spinu, *Viscoelastic Contact Simulation under Harmonic Cyclic Load*, Advances in
//! Tribology 2018, 9432894, and extends it with an exact axisymmetric engine beside the half-space engine of the paper, second-order time
//! steps, and a stabilisation criterion based on the estimated distance to the stabilised cycle rather than on the last change.
//!
//! # Model
//!
//! At every instant t, with initial gap g, surface displacement u, approach delta, pressure p, load W:
//!
//! ```text
//! h = g + u - delta,   p >= 0,  h >= 0,  p h = 0,   W = integral of p dA
//! u(x,y,t) = integral over area of q / (pi r),       q(x,y,t) = integral from 0 to t of C(t-s) dp(x,y,s)
//! ```
//!
//! Frictionless, quasi-static, small slopes; adhesion only of small, stiff spheres ([`sweep::plan::adhesion`]); a constant Poisson
//! ratio, or a bulk modulus, constant or relaxing ([`material::compressibility`]). C(t) is the contact compliance: with a constant Poisson ratio
//! (1 - nu^2) D(t) of the longitudinal creep compliance D, or (1 - nu) J(t)/2 of the shear creep compliance J.
//!
//! # Conventions
//!
//! SI units in every `f64`, named in the identifier where it crosses a boundary (`radius_m`). Pressure is positive in
//! compression, displacement and approach are positive into the body. The energy loss is the closed integral of W d(delta),
//! positive where the approach lags behind the load. An undefined value is `None` and an empty cell, never 0 or NaN.
//!
//! # From values
//!
//! ```
//! use contact_dma::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let pmma = library::find("pmma").ok_or("not in the library")?.material()?;
//! let drive = HarmonicDrive::load(10.0, 5.0)?; // N
//! let sweep = Sweep::new(pmma, Sphere::new(0.01)?, drive).steps(24)?.springs(48)?; // coarse
//! let outcome = sweep.frequencies_hz([3e-4, 6e-4, 1.2e-3, 2.4e-3, 4.8e-3])?.solve()?;
//! for peak in &outcome.peaks {
//!     println!("{:e} J at {:e} rad/s", peak.energy_loss_j, peak.angular_frequency_rad_per_s);
//! }
//! # assert_eq!(outcome.peaks.len(), 1);
//! # Ok(())
//! # }
//! ```
//!
//! See [`Sweep`](sweep::Sweep) for all options and `examples/` for programs. Nothing is written to disk.
//!
//! # Map
//!
//! A module may use those above it, never those below; a test enforces this. Down to [`identify`] they are a package of their own,
//! `contact-dma-core` in `src/core`, which is built without anything that reads files or draws.
//!
//! | module | what it knows |
//! |---|---|
//! | [`numerics`] | grids, roots, extremes, polynomials, medians, least squares; nothing of the field |
//! | [`quantity`] | quantities with units |
//! | [`material`] | relaxation modulus, creep compliance, complex modulus; models, conversion, library |
//! | [`indenter`] | gap functions |
//! | [`drive`] | load or approach against time, time steps; nothing of contact |
//! | [`contact`] | one instant of contact, by two engines; a gap field and a compliance number, nothing else |
//! | [`history`] | viscoelastic memory and time marching |
//! | [`cycle`] | signals of one cycle, measured or computed |
//! | [`steady`] | the stabilised cycle found directly |
//! | [`adhesive`] | contacts of bodies of revolution that attract one another, on springs whose edges move within a step |
//! | [`mod@reference`] | closed forms and slow independent solvers; of the production modules only `reproduction` uses it |
//! | [`engine`] | engines for an indenter, on a domain that holds the contact |
//! | [`sweep`] | plans, cases in parallel, records on disk, peaks |
//! | [`simulation`] | one drive history from its beginning to its end |
//! | [`measured`] | measured loops: frequency, drift, cycles, corrections, moduli; uses the exact model for the bias of the small-amplitude formula |
//! | [`identify`] | a material from measured cycles: the sweep as a forward model |
//! | [`force_curve`] | a law of a material from force over indentation, with its contact point |
//! | [`figures`] | size of figures on paper, their typefaces, units of normalised axes |
//! | [`input`] | sweep, scenario and identification files, and the data files they name, to plans |
//! | `citation` | what to cite for what a result used |
//! | [`report`] | tables and figures, from records alone |
//! | [`reproduction`] | the base paper, figure by figure; knows `reference` too, to draw closed forms and compare with them |
//! | `repository` | what the repository repeats of tables and commands |
//! | [`cli`] | flags to plans, outcomes to text and exit codes |
//! | [`guide`] | how to use the program; text only |
//!
//! [`report`] and [`reproduction`] need the feature `report`, [`cli`] the feature `cli`; both are on by default. The feature `tables`
//! builds the part of [`report`] that makes columns and tables, without figures and their dependencies. With `default-features = false`
//! only the modules above them are built, without these dependencies.
//!
//! Material, indenter, drive, contact and cycle do not know one another. Results do not depend on the number of threads,
//! bit for bit.

#![forbid(unsafe_code)]

#[doc(inline)]
pub use contact_dma_core::{
    adhesive, contact, cycle, drive, engine, force_curve, history, identify, indenter, material,
    measured, numerics, prelude, quantity, reference, simulation, steady, sweep,
};

#[cfg(feature = "cli")]
mod citation;
#[cfg(feature = "cli")]
pub mod cli;
pub mod figures;
pub mod guide;
// Some of it is used by the command line alone.
#[cfg_attr(not(feature = "cli"), allow(dead_code))]
pub mod input;
// Some of it is used by figures and pages alone.
#[cfg(feature = "tables")]
#[cfg_attr(not(feature = "report"), allow(dead_code, unused_imports))]
pub mod report;
#[cfg(feature = "cli")]
mod repository;
#[cfg(feature = "report")]
pub mod reproduction;
