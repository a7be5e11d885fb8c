//! A material from measured cycles: the sweep as a forward model.
//!
//! Measured are numbers of stabilised cycles at several load frequencies: energy loss, phase lag, largest approach, contact
//! radius, whatever a sweep computes. Sought is the solid, a Prony series, whose computed cycles have the same numbers.
//!
//! Or measured is a history: approach under a load that steps, ramps and rests, or load under such an approach. Its solid is found
//! in the same way, with `history` in place of the linearised cycles and a simulation in place of the sweep.
//!
//! # How
//!
//! The unknowns are the logarithms of the equilibrium modulus and of the moduli and times of the branches; the residuals are
//! the logarithms of computed over measured numbers, divided by the relative errors of the measured ones.
//!
//! 1. The linearised contact (`linear`) gives every number from E*(omega) and the equilibrium modulus at once. Branches are
//!    added one by one, each tried at many times (`selection`), and all are refined together by the method of Levenberg and
//!    Marquardt ([`crate::numerics::levenberg_marquardt`]).
//! 2. The exact model (`model`) is solved for the best series. Its ratio to the linearised one is a factor for each number,
//!    which changes little with the material: with the factors the search is repeated until they stand still.
//! 3. The series is refined on the exact model itself, with its own derivatives.
//! 4. Where that ends far from the data, which contacts that open in every cycle may do, the search starts again with the factors of the
//!    series of one branch that fits best by the exact model, and with smaller changes of them.
//! 5. The numbers are corrected by what twice the steps and springs or cells change at the solution, and the series is refined
//!    once more, where that is seen beside the noise. On cells the intervals include this change.
//!
//! # Which law
//!
//! Where laws are asked for ([`laws`]), the factors of the exact model about the series serve every law; they are then taken about the law
//! that is most likely, until they stand still.
//!
//! # How many branches
//!
//! Every number of branches is fitted. One more is taken where both the criterion of Akaike with the correction for few data
//! (C. M. Hurvich and C.-L. Tsai, Biometrika 76 (1989) 297) and that of G. Schwarz (Ann. Statist. 6 (1978) 461) fall, by four, which is odds of seven to one. A time
//! that does not exist is searched over several decades, which finds more in noise than a fixed one would: either criterion
//! alone takes it too often, the first with many data and the second with few. Two times closer than a factor of three are
//! one: times are kept that far apart.
//!
//! Where the errors are given and the series misses the data, the datum that it misses by the most is tried without: if all others are
//! then met, by this number of branches or fewer, that datum is an outlier, which is named and does not count in the fit.
//!
//! # How certain
//!
//! The covariance is that of the linearised least squares at the solution, on the exact model. Where the data have errors,
//! these are taken as standard deviations; where the series misses the data by more than these allow, all intervals are wider by the
//! root of chi squared per degree of freedom (R. T. Birge, Phys. Rev. 40 (1932) 207). Where there are none, the noise is what the residuals say, and the band is wider by the
//! quantile of Student's distribution. Which number of branches is right is uncertain too: the band of E* holds the series of
//! other numbers as well, each by its Akaike weight (K. P. Burnham and D. R. Anderson, *Model Selection and Multimodel
//! Inference*, Springer 2002, section 4.3). Combinations of the unknowns along which they may move by more than a factor of two
//! are named as not determined: singular vectors of the matrix of derivatives.

mod adhesion;
mod candidate;
mod chosen;
mod curve;
pub mod data;
mod ensemble;
mod fit;
mod history;
mod identified;
pub mod laws;
mod linear;
pub mod material_laws;
mod model;
pub(crate) mod noise;
pub mod resolved;
mod selection;
mod series;
pub(crate) mod uncertainty;

pub use candidate::Candidate;
pub use curve::{Curve, curves};
pub use fit::identify;
pub use identified::{CellError, Compared, Identified, ModulusBand, Undetermined, Unknown};
pub use noise::Knowledge;

use std::sync::Arc;

use crate::drive::{HarmonicDrive, SegmentedDrive};
use crate::engine::SolverPlan;
use crate::identify::data::{Measurements, TableColumns};
use crate::indenter::Indenter;
use crate::material::law::Form;
use crate::material::{
    Compressibility, Material, MaterialError, ModulusKind, Relaxation, branches_in_words,
};
use crate::sweep::case::SetupError;
use crate::sweep::plan::CyclePlan;
use crate::sweep::plan::adhesion::AdhesionPlan;
use crate::sweep::plan::contact::ContactPlan;
use crate::words;

/// Times of two branches closer than this factor are one time.
pub const CLOSEST: f64 = 3.0;

/// Most branches tried, and most that may be asked for.
pub const MOST_BRANCHES: usize = 6;

/// An unknown whose 95 % interval is wider than this factor to either side is not determined.
pub const UNDETERMINED: f64 = 2.0;

words! {
    /// What smallest, largest and mean approaches of measured cycles are counted from.
    pub enum ApproachZero {
        FirstContact = "first-contact",
        /// They are no data then, since all have the same unknown in them.
        Unknown = "unknown",
    }
}

words! {
    /// What of the attraction of the surfaces is sought beside the material, from the values of `[adhesion]` on.
    pub enum SoughtAttraction {
        Known = "known",
        Work = "work",
        WorkAndRange = "work-and-range",
    }
}

impl SoughtAttraction {
    /// How many numbers of it are unknown.
    pub(crate) const fn count(self) -> usize {
        match self {
            Self::Known => 0,
            Self::Work => 1,
            Self::WorkAndRange => 2,
        }
    }

    /// Logarithms of what is sought (J/m^2, m), of an attraction as it is expected.
    pub(crate) fn logarithms(self, expected: Option<&AdhesionPlan>) -> Vec<f64> {
        let all = expected.map_or([0.0; 2], AdhesionPlan::logarithms);
        all[..self.count()].to_vec()
    }
}

/// Everything that an identification needs to know.
#[derive(Debug, Clone)]
pub struct IdentifyPlan {
    pub title: String,
    pub contact: ContactPlan<Sought>,
    pub solver: SolverPlan,
    pub drive: Driven,
    /// How many branches; `None` lets the data choose.
    pub branches: Option<usize>,
    /// Laws between which the data choose; `None` for series alone.
    pub laws: Option<Vec<Form>>,
    /// How often the material is found again with the noise drawn anew.
    pub samples: usize,
    pub measurements: Measurements,
    /// The file that they come from, as the plan names it.
    pub data: String,
    /// What the approaches of that file are counted from, where it was asked for.
    pub approach_zero: Option<ApproachZero>,
    pub attraction: SoughtAttraction,
    /// What became of its columns.
    pub columns: TableColumns,
    pub cycle: CyclePlan,
}

/// What is known of the bodies before anything is identified.
#[derive(Debug, Clone)]
pub struct Sought {
    /// A Poisson ratio, or a bulk modulus that is constant in time.
    pub compressibility: Compressibility,
    /// What the indenter is made of, where it is not rigid.
    pub indenter_material: Option<Material>,
}

/// What drove the contact.
#[derive(Debug, Clone, PartialEq)]
pub enum Driven {
    /// An oscillation: that of the rows that have none of their own.
    Cycles(HarmonicDrive),
    /// One history, from first touch.
    History(SegmentedDrive),
}

impl IdentifyPlan {
    /// How the cycles of the forward model are resolved where nothing is asked for: its error, below 0.1 % in loss and phase, is
    /// far below the noise of a measurement, and derivatives are smooth.
    pub const CYCLE: CyclePlan = CyclePlan {
        steps: 64,
        tolerance: 1e-6,
        max_cycles: 200,
        error_bars: false,
        ..CyclePlan::DEFAULT
    };
    pub const SPRINGS: usize = 64;
    pub const CELLS: usize = 32;

    /// A rigid indenter on a half-space of this Poisson ratio or bulk modulus, everything else at its default: as many branches as
    /// the data ask for.
    pub fn new(
        compressibility: impl Into<Compressibility>,
        indenter: Arc<dyn Indenter>,
        drive: Driven,
        measurements: Measurements,
    ) -> Self {
        let material = Sought {
            compressibility: compressibility.into(),
            indenter_material: None,
        };
        Self {
            title: String::new(),
            solver: Self::solver(indenter.as_ref(), false),
            contact: ContactPlan::new(material, indenter),
            drive,
            branches: None,
            laws: None,
            samples: 0,
            measurements,
            data: String::new(),
            approach_zero: None,
            attraction: SoughtAttraction::Known,
            columns: TableColumns::default(),
            cycle: Self::CYCLE,
        }
    }

    /// Logarithms of what is sought of the attraction (J/m^2, m), as the plan has it.
    pub(crate) fn sought_attraction(&self) -> Vec<f64> {
        self.attraction.logarithms(self.contact.adhesion.as_ref())
    }

    /// The same plan with another attraction of these logarithms, as many as are sought.
    pub(crate) fn attracted_by(&self, logarithms: &[f64]) -> Self {
        let mut plan = self.clone();
        let adhesion = plan.contact.adhesion;
        plan.contact.adhesion = adhesion.map(|adhesion| adhesion.with_logarithms(logarithms));
        plan
    }

    /// The solver where nothing is asked for.
    pub fn solver(indenter: &dyn Indenter, on_layer: bool) -> SolverPlan {
        SolverPlan {
            springs: Self::SPRINGS,
            cells: Self::CELLS,
            ..SolverPlan::of(indenter, on_layer)
        }
    }

    /// The material of a series, in contact with the indenter.
    ///
    /// # Errors
    /// As [`Material::from_relaxation`].
    pub(crate) fn material(&self, series: &Relaxation) -> Result<Material, MaterialError> {
        let material = self.body(series)?;
        Ok(match &self.contact.material.indenter_material {
            Some(indenter) => material.against(indenter.clone()),
            None => material,
        })
    }

    /// The material that was found, known over the band measured.
    ///
    /// # Errors
    /// As [`Material::from_relaxation`].
    pub fn material_of(&self, found: &Identified) -> Result<Material, MaterialError> {
        let (lowest, highest) = found.window_rad_per_s;
        let mut body = self.body(&found.relaxation)?;
        body.origin.measured_window_s = Some((1.0 / highest, 1.0 / lowest));
        let drawn = found.ensemble.iter().map(|drawn| self.body(&drawn.series));
        body.origin.replicas = drawn.collect::<Result<_, _>>()?;
        Ok(body)
    }

    /// The material of a series by itself.
    ///
    /// # Errors
    /// As [`Material::from_relaxation`].
    fn body(&self, series: &Relaxation) -> Result<Material, MaterialError> {
        let kind = ModulusKind::Longitudinal;
        let known = self.contact.material.compressibility.clone();
        Material::from_relaxation(series.clone(), kind, known)
    }
}

/// Why no material was identified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IdentifyError {
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Material(#[from] MaterialError),
    #[error(
        "the measurements hold {numbers} numbers, and a series of {} takes at least {needed}",
        branches_in_words(*branches)
    )]
    TooFew {
        numbers: usize,
        branches: usize,
        needed: usize,
    },
    #[error(
        "the measurements are flat: no column varies by more than {spread_percent} %, which is no more than its \
         errors, so nothing says at what time the material relaxes; measure over more decades, or more exactly"
    )]
    Flat { spread_percent: String },
    #[error(
        "all measurements are at one time, and one tells no relaxation: give the approach or load over a time"
    )]
    OneInstant,
    #[error("the history was not followed: {0}")]
    NoHistory(String),
    #[error(
        "all measurements are at one frequency: the time of a relaxation cannot be told from one; measure at several"
    )]
    OneFrequency,
    #[error(
        "the {what} of row {row} is {value:e} {unit}, and one from {low:e} to {high:e} {unit} is needed; is its unit right? \
         Otherwise leave the row out"
    )]
    OutOfRange {
        row: usize,
        what: &'static str,
        value: f64,
        low: f64,
        high: f64,
        unit: &'static str,
    },
    #[error("the column {column} of row {row} is {value:e}: {why}")]
    Impossible {
        column: &'static str,
        row: usize,
        value: f64,
        why: &'static str,
    },
    #[error(
        "the best solid of {} misses the measurements by {misfit_percent} % (root mean square), most at {place} (row \
         {row}), where its {column} is {times} times the measured one: {few}the measurements contradict one another, the drive or \
         the indenter; check units, drive, indenter and columns",
        branches_in_words(*branches),
        few = if *.may_have_more { "the material may have more branches than `identify.branches` asks for, or " } else { "" }
    )]
    Contradiction {
        branches: usize,
        /// Whether the number of branches was asked for, and more can be.
        may_have_more: bool,
        row: usize,
        misfit_percent: String,
        place: String,
        column: &'static str,
        times: String,
    },
    #[error("the cycle at {angular_frequency_rad_per_s:e} rad/s was not found: {why}")]
    NoCycle {
        angular_frequency_rad_per_s: f64,
        why: String,
    },
    #[error(
        "there is no {column} at {place}: the indenter makes it unbounded, or the contact opens; leave these cells empty"
    )]
    Undefined { place: String, column: &'static str },
    #[error("no law was found of {curve}: {why}")]
    NoLaw { curve: String, why: String },
    #[error("no series could be fitted: {0}")]
    NoFit(&'static str),
    #[error("interrupted")]
    Interrupted,
}
