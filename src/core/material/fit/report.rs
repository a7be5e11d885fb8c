//! What is reported of a fit: how good it is, what was assumed, and what the data leave open.

use std::fmt;

use crate::material::tabulated::{TableWarning, name, seconds};
use crate::material::{MaterialFunction, ModulusKind};
use crate::quantity::{Dimension, format_human};

/// Shares of extrapolation to time zero and to equilibrium that are worth a warning.
const FAR_FROM_INSTANTANEOUS: f64 = 0.01;
pub(super) const FAR_FROM_EQUILIBRIUM: f64 = 0.05;

/// Difference between series and samples, relative to the samples.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Misfit {
    /// Root mean square.
    pub rms: f64,
    /// Largest magnitude, and the time (s) at which it occurs.
    pub largest: f64,
    pub largest_at_s: f64,
}

/// What was fitted, how well, and what was assumed.
#[derive(Debug, Clone, PartialEq)]
pub struct FitReport {
    pub function: MaterialFunction,
    pub kind: ModulusKind,
    pub samples: usize,
    /// Groups of samples that were fitted; as many as samples where these are sparse.
    pub groups: usize,
    /// First and last time of the table (s).
    pub first_s: f64,
    pub last_s: f64,
    /// First positive and last time (s).
    pub window_s: (f64, f64),
    pub branches: usize,
    pub misfit: Misfit,
    pub remarks: Vec<FitRemark>,
}

/// Something to know about a fit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitRemark {
    /// About the samples themselves.
    #[error(transparent)]
    Table(TableWarning),
    /// The data begin at `first_s`: the value at time zero (1/Pa or Pa) is an extrapolation by this share.
    #[error(
        "the data begin at {}: the instantaneous {} of {} is assumed, {} from the first value of the fit; anything faster is taken for instantaneous; {}",
        seconds(*first_s), name(*function), five_digits(*function, *value), percent(*share), range(*function, *allowed)
    )]
    Instantaneous {
        function: MaterialFunction,
        first_s: f64,
        value: f64,
        share: f64,
        /// The lowest and the highest value of series that fit about as well.
        allowed: (f64, f64),
    },
    /// The creep compliance of the fit begins at zero.
    #[error(
        "the fit has no instantaneous compliance, so it cannot go into contact: the data, which begin at {}, show none",
        seconds(*first_s)
    )]
    InstantaneouslyRigid { first_s: f64 },
    /// The series goes on after the last sample, by this share of its value there.
    #[error(
        "the data end at {} before the {} comes to rest: its equilibrium is assumed, {} from the last value of the fit; {}",
        seconds(*last_s), name(*function), percent(*share), range(*function, *allowed)
    )]
    Equilibrium {
        function: MaterialFunction,
        last_s: f64,
        share: f64,
        /// The lowest and the highest equilibrium value (1/Pa or Pa) of series that fit about as well.
        allowed: (f64, f64),
    },
    /// The data ask for a viscous flow term; the misfits (rms) without and with it.
    #[error(
        "the data ask for a viscous flow of {}: the misfit is {} rms with it and {} without; the material is a fluid (flow = false asks for a solid)",
        format_human(*viscosity_pa_s, Dimension::Viscosity, 4), percent(*rms_with), percent(*rms_without)
    )]
    Flow {
        viscosity_pa_s: f64,
        rms_without: f64,
        rms_with: f64,
    },
    /// They do not.
    #[error("no viscous flow is assumed: it would {}", gain(*rms_without, *rms_with))]
    NoFlow { rms_without: f64, rms_with: f64 },
    /// A relaxation modulus that falls to nothing.
    #[error(
        "the relaxation modulus of the fit falls to nothing: the material is a fluid, and has no stabilised cycle in contact (flow = false asks for a solid)"
    )]
    NoEquilibrium,
}

impl FitRemark {
    /// Whether this limits what the fit can be used for, rather than telling how it was made.
    pub fn is_warning(&self) -> bool {
        match self {
            Self::Instantaneous { share, .. } => *share > FAR_FROM_INSTANTANEOUS,
            Self::NoFlow { .. } => false,
            Self::Table(warning) => warning.is_warning(),
            _ => true,
        }
    }
}

/// A creep compliance or relaxation modulus in five digits.
fn five_digits(function: MaterialFunction, value: f64) -> String {
    match function {
        MaterialFunction::Creep => format_human(value, Dimension::Compliance, 5),
        MaterialFunction::Relaxation => format_human(value, Dimension::Stress, 5),
    }
}

/// What a value at an end of time may be.
fn range(function: MaterialFunction, (lowest, highest): (f64, f64)) -> String {
    let (lowest, highest) = (
        five_digits(function, lowest),
        five_digits(function, highest),
    );
    format!("the data allow {lowest} to {highest}")
}

/// A share as a person reads it: per cent, or a power of ten where that would be nothing.
pub(super) fn percent(value: f64) -> String {
    if value >= 1e-5 {
        let decimals = (1 - (100.0 * value).log10().floor() as i32).max(0) as usize;
        format!("{:.decimals$} %", 100.0 * value)
    } else if value > 0.0 {
        format!("{value:.0e}")
    } else {
        "0 %".to_owned()
    }
}

impl fmt::Display for FitReport {
    /// Lines to be printed, without a line end after the last.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = self.kind.name();
        let plural = if self.branches == 1 { "" } else { "es" };
        write!(
            formatter,
            "Fit of {} branch{plural} to the {kind} {}, {} samples from {} to {}",
            self.branches,
            name(self.function),
            self.samples,
            seconds(self.first_s),
            seconds(self.last_s),
        )?;
        if self.groups < self.samples {
            write!(formatter, " averaged to {} groups", self.groups)?;
        }
        write!(
            formatter,
            "\nMisfit relative to the data: {} rms, {} at most (at t = {})",
            percent(self.misfit.rms),
            percent(self.misfit.largest),
            seconds(self.misfit.largest_at_s)
        )?;
        for remark in &self.remarks {
            let rank = if remark.is_warning() {
                "Warning"
            } else {
                "Note"
            };
            write!(formatter, "\n{rank}: {remark}")?;
        }
        Ok(())
    }
}

/// By what a flow would lower the misfit. The digits that are printed are what counts.
fn gain(rms_without: f64, rms_with: f64) -> String {
    if rms_with < 0.95 * rms_without {
        let (without, with) = (percent(rms_without), percent(rms_with));
        return format!("lower the misfit from {without} rms to {with} only");
    }
    "not lower the misfit".to_owned()
}
