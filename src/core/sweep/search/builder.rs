//! A sweep from values: material, indenter, drive and frequencies in, records and peaks out, without a file.

use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::drive::{Control, HarmonicDrive};
use crate::engine::{EngineKind, SolverPlan};
use crate::indenter::Indenter;
use crate::material::Material;
use crate::quantity::block::Block as _;
use crate::sweep::case::{Setup, SetupError};
use crate::sweep::plan::adhesion::{AdhesionModel, AdhesionPlan};
use crate::sweep::plan::check::PlanError;
use crate::sweep::plan::{Axes, Case, Method, SweepPlan, Varied};
use crate::sweep::record::CaseRecord;
use crate::sweep::search::run::{self, Mode, Outcome, RunError};
use crate::sweep::store::records::Records;

/// A sweep under construction. Every method that takes a value checks it.
///
/// The energy loss of PMMA under a sphere at one frequency, with its error:
///
/// ```
/// # extern crate contact_dma_core as contact_dma;
/// use contact_dma::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let drive = HarmonicDrive::load(10.0, 5.0)?; // N
/// let pmma = library::find("pmma").ok_or("not in the library")?.material()?;
/// let sweep = Sweep::new(pmma, Sphere::new(0.01)?, drive);
/// let record = sweep.steps(48)?.springs(48)?.case_at_hz(1e-3)?;
/// if let (Some(loss_j), Some(error_j)) = (record.energy_loss_j(), record.energy_loss_error_j()) {
///     println!("{loss_j:.4e} J, to within {error_j:.1e} J");
/// }
/// # assert!(record.energy_loss_error_j().is_some_and(|error_j| error_j > 0.0));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Sweep {
    plan: SweepPlan,
    threads: Option<NonZeroUsize>,
    interrupt: Arc<AtomicBool>,
}

/// Why a sweep has no outcome.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error("interrupted")]
    Interrupted,
}

impl Sweep {
    /// A sweep that has no frequencies yet, and everything else at its default: the axisymmetric engine for bodies of revolution,
    /// the half-space engine for other indenters, error bars, a thread per processor.
    pub fn new(
        material: Material,
        indenter: impl Indenter + 'static,
        drive: HarmonicDrive,
    ) -> Self {
        SweepPlan::new(material, Arc::new(indenter), drive).into()
    }

    /// The load frequencies (Hz), in any order.
    ///
    /// # Errors
    /// [`PlanError`]: there are none, one is not positive and finite, one is given twice.
    pub fn frequencies_hz(self, hz: impl IntoIterator<Item = f64>) -> Result<Self, PlanError> {
        let angular = hz.into_iter().map(|hz| std::f64::consts::TAU * hz);
        self.angular_frequencies_rad_per_s(angular)
    }

    /// The same in rad/s.
    ///
    /// # Errors
    /// As [`Self::frequencies_hz`].
    pub fn angular_frequencies_rad_per_s(
        mut self,
        angular: impl IntoIterator<Item = f64>,
    ) -> Result<Self, PlanError> {
        let mut omegas: Vec<f64> = angular.into_iter().collect();
        omegas.sort_by(f64::total_cmp);
        self.plan.angular_frequencies_rad_per_s = omegas;
        self.plan.check().map(|()| self)
    }

    /// A second axis: every frequency under each of these amplitudes (N or m), ascending, about the mean of the drive.
    ///
    /// # Errors
    /// [`SetupError`]: an amplitude that the drive cannot have, none, or amplitudes that do not ascend.
    pub fn amplitudes(self, amplitudes: impl IntoIterator<Item = f64>) -> Result<Self, SetupError> {
        let varied = Varied::amplitude(self.plan.base.drive.control());
        self.varied(varied, amplitudes)
    }

    /// The same for means (N or m) with the amplitude of the drive.
    ///
    /// # Errors
    /// As [`Self::amplitudes`].
    pub fn means(self, means: impl IntoIterator<Item = f64>) -> Result<Self, SetupError> {
        let varied = Varied::mean(self.plan.base.drive.control());
        self.varied(varied, means)
    }

    fn varied(
        self,
        varied: Varied,
        values: impl IntoIterator<Item = f64>,
    ) -> Result<Self, SetupError> {
        let axes = Axes::of_drive(&self.plan, varied, values)?;
        Ok(self.with(|plan| plan.axes = Some(axes))?)
    }

    /// Time steps per cycle; where an accuracy is asked for, at least.
    ///
    /// # Errors
    /// [`PlanError`] where the number is below 8 or above a million.
    pub fn steps(self, steps: usize) -> Result<Self, PlanError> {
        self.with(|plan| plan.cycle.steps = steps)
    }

    /// An indenter that the surface attracts: see [`crate::sweep::plan::adhesion`].
    ///
    /// # Errors
    /// A number that is not positive and finite, a shape or a control that the model does not know, a load at which a sphere of
    /// Derjaguin, Muller and Toporov comes off.
    pub fn attracted(self, adhesion: AdhesionPlan) -> Result<Self, SetupError> {
        adhesion.check().map_err(PlanError::from)?;
        let base = &self.plan.base;
        let pull_off_n = adhesion.pull_off_n(base.contact.indenter.as_ref());
        let is_known =
            |_: &f64| base.drive.control() == Control::Load || adhesion.model != AdhesionModel::Dmt;
        let pull_off_n = pull_off_n.filter(is_known);
        let pull_off_n = pull_off_n.ok_or(PlanError::AdhesionOfOther)?;
        let drive = self.plan.base.drive.attracted_by(pull_off_n)?;
        Ok(self.with(|plan| {
            (plan.base.drive, plan.base.contact.adhesion) = (drive, Some(adhesion));
        })?)
    }

    /// This cycle of a march, counted from 1 and after the hold of the drive, in place of the stabilised one.
    ///
    /// # Errors
    /// [`PlanError`] where there is no such cycle.
    pub fn at_cycle(self, number: usize) -> Result<Self, PlanError> {
        self.with(|plan| (plan.cycle.method, plan.cycle.at_cycle) = (Method::March, Some(number)))
    }

    /// The axisymmetric engine, on this number of springs.
    ///
    /// # Errors
    /// [`PlanError`] where the number is below 10 or above 10,000.
    pub fn springs(self, springs: usize) -> Result<Self, PlanError> {
        self.on(EngineKind::Axisymmetric, springs)
    }

    /// The half-space engine, on this number of cells along the longer side.
    ///
    /// # Errors
    /// [`PlanError`] where the number is below 8 or above 4096.
    pub fn cells(self, cells: usize) -> Result<Self, PlanError> {
        self.on(EngineKind::HalfSpace, cells)
    }

    /// Steps and nodes such that the error of every loss stays below this part of it.
    ///
    /// # Errors
    /// [`PlanError`] where the accuracy is below 1e-8, or not below 1.
    pub fn accuracy(self, accuracy: f64) -> Result<Self, PlanError> {
        self.with(|plan| plan.cycle.accuracy = Some(accuracy))
    }

    /// Adds frequencies where those given do not resolve the curve of the loss.
    #[must_use]
    pub fn refined(mut self) -> Self {
        self.plan.refine = true;
        self
    }

    /// Without error bars, at a third to a half of the cost.
    #[must_use]
    pub fn without_error_bars(mut self) -> Self {
        self.plan.cycle.error_bars = false;
        self
    }

    /// A title for tables and figures.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.plan.title = title.into();
        self
    }

    /// On this number of threads, at most what the processors have a use for. Results do not depend on it.
    #[must_use]
    pub fn threads(mut self, threads: NonZeroUsize) -> Self {
        self.threads = Some(threads);
        self
    }

    /// Stopped where this flag is set: [`Self::solve`] returns what is finished by then.
    #[must_use]
    pub fn interrupted_by(mut self, flag: Arc<AtomicBool>) -> Self {
        self.interrupt = flag;
        self
    }

    /// The plan, with public fields for all that has no method here.
    pub fn into_plan(self) -> SweepPlan {
        self.plan
    }

    /// Solves every case, adds frequencies where that was asked for, and locates the peaks; in memory.
    ///
    /// # Errors
    /// [`SweepError`]: values that make no contact, or threads that cannot be started. A case that does not converge is no error
    /// but a record without a result.
    pub fn solve(self) -> Result<Outcome, SweepError> {
        let setup = Setup::new(self.plan)?.interrupted_by(Arc::clone(&self.interrupt));
        let mode = Mode::on_threads(run::useful_threads(self.threads));
        let records = Records::default();
        Ok(run::run(&setup, &records, mode, &self.interrupt, &())?)
    }

    /// Solves the case at one frequency (Hz) under the drive itself, whatever frequencies and second axis were given.
    ///
    /// # Errors
    /// As [`Self::solve`], a frequency that is not positive and finite, and an interruption.
    pub fn case_at_hz(self, frequency_hz: f64) -> Result<CaseRecord, SweepError> {
        let sweep = self.frequencies_hz([frequency_hz]);
        let Self {
            plan, interrupt, ..
        } = sweep.map_err(SetupError::from)?;
        let setup = Setup::new(plan)?.interrupted_by(Arc::clone(&interrupt));
        let case = Case {
            index: 0,
            angular_frequency_rad_per_s: std::f64::consts::TAU * frequency_hz,
            condition: setup.plan().base.clone(),
        };
        setup.run(&case, &interrupt).ok_or(SweepError::Interrupted)
    }

    fn on(self, engine: EngineKind, nodes: usize) -> Result<Self, PlanError> {
        self.with(|plan| {
            let solver = &mut plan.solver;
            *solver = SolverPlan { engine, ..*solver }.with_nodes(nodes);
        })
    }

    /// The sweep with a change, where its values may be what they then are.
    fn with(mut self, change: impl FnOnce(&mut SweepPlan)) -> Result<Self, PlanError> {
        change(&mut self.plan);
        self.plan.check_values().map(|()| self)
    }
}

impl From<SweepPlan> for Sweep {
    /// A sweep of any plan; [`Self::solve`] checks it.
    fn from(plan: SweepPlan) -> Self {
        Self {
            plan,
            threads: None,
            interrupt: Arc::default(),
        }
    }
}
