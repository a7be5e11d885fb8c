//! What one case came to: the record that is stored, and from which tables and figures are made without solving again.

pub mod attracted;
pub mod error_bars;
pub mod material_error;
mod quantity;
pub(crate) mod slope;
pub mod warning;

use serde::{Deserialize, Serialize};

use crate::contact::surface::PressureLine;
use crate::cycle::{ContactDuty, Extrema, Loop, LoopAnalysis};
use crate::drive::Control;
use crate::history::Work;
use crate::sweep::plan::{AxisValues, Condition, Method};
use crate::sweep::record::attracted::{Attracted, AttractedCycle};
use crate::sweep::record::error_bars::{ErrorBars, Quantity};
use crate::sweep::record::warning::Warning;

/// How a case ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// The stabilised cycle was reached within the tolerance.
    Converged,
    /// The cycle asked for by its number, on the way to the stabilised one.
    Transient,
    /// The cycle was not stabilised, or not to the accuracy asked for, before the limits were met: there is no result.
    NotConverged,
    /// An instant could not be solved: there is no result.
    Failed,
}

impl Status {
    /// Whether there is a result.
    pub fn has_result(self) -> bool {
        matches!(self, Self::Converged | Self::Transient)
    }

    /// The name used in every output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::Transient => "transient",
            Self::NotConverged => "not-converged",
            Self::Failed => "failed",
        }
    }
}

/// One frequency's record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseRecord {
    /// Position in the sweep, from 0, in ascending frequency.
    pub index: usize,
    pub angular_frequency_rad_per_s: f64,
    /// The numbers (SI units) that other axes than the frequency vary.
    pub varied: AxisValues,
    /// Mean and amplitude of the drive (N or m).
    pub drive_mean: f64,
    pub drive_amplitude: f64,
    pub status: Status,
    /// Why there is no result, or what else a reader should know.
    pub message: Option<String>,
    /// What lies outside the model, or was not estimated.
    pub warnings: Vec<Warning>,
    /// How the cycle was reached in the end.
    pub method: Method,
    /// Time steps per cycle, and springs or cells, of the result.
    pub steps: usize,
    pub nodes: usize,
    /// Cycles solved at this resolution, the recorded one included.
    pub cycles: usize,
    /// Estimated distance of the recorded cycle to the stabilised one.
    pub steady_distance: Option<f64>,
    /// Half width of the computational domain (m) and how often it had to be enlarged.
    pub domain_half_width_m: f64,
    pub domain_enlarged: usize,
    /// What the case cost, coarser resolutions too.
    pub work: Work,
    /// Only for a converged or transient case.
    pub result: Option<CaseResult>,
}

/// The stabilised cycle of one frequency.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseResult {
    pub analysis: LoopAnalysis,
    /// E' and E'' (Pa) that indentation reads from the loop; `None` where the indenter leaves the surface.
    pub storage_modulus_pa: Option<f64>,
    pub loss_modulus_pa: Option<f64>,
    pub approach_m: Extrema,
    pub contact_radius_m: Extrema,
    pub contact_duty: ContactDuty,
    pub attraction: Attracted,
    /// `None` where the indenter's shape makes the pressure unbounded.
    pub peak_pressure_pa: Option<Extrema>,
    /// Errors of the numbers above; `None` where they were not asked for or could not be estimated.
    pub errors: Option<ErrorBars>,
    /// The loss (J) with each replica of the material in its place; `None` where no stabilised cycle was found with it.
    pub replica_losses_j: Vec<Option<f64>>,
    /// Energy (J) that each branch of the creep compliance dissipates over the cycle, shortest retardation time first; empty for a
    /// transient cycle.
    pub branches: Vec<BranchLoss>,
    /// The cycle itself and its surface; empty where only the numbers are held.
    pub cycle: RecordedCycle,
}

/// A cycle sample by sample, and what it does to the surface. It takes ten times as much memory as the numbers of a case, and large
/// sweeps hold it only of the cases that are drawn.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RecordedCycle {
    pub samples: Loop,
    /// The pressure over the contact at the quarters of the drive's oscillation.
    pub pressures: Vec<PressureProfile>,
    /// Where the energy goes in.
    pub surface_loss: SurfaceLoss,
}

impl RecordedCycle {
    /// Whether there is one.
    pub fn is_held(&self) -> bool {
        !self.samples.time_s.is_empty()
    }

    /// Rounds positions and values of the profiles to single precision, as large sweeps keep them: seven digits are more than a grid
    /// resolves, and half the bytes.
    pub fn round_profiles(&mut self) {
        let single = |value: &mut f64| *value = f64::from(*value as f32);
        for line in self.pressures.iter_mut().flat_map(|p| &mut p.lines) {
            line.position_m.iter_mut().for_each(single);
            line.pressure_pa.iter_mut().flatten().for_each(single);
        }
        if let SurfaceLoss::Radial {
            radius_m,
            density_j_per_m2,
        } = &mut self.surface_loss
        {
            radius_m.iter_mut().for_each(single);
            density_j_per_m2.iter_mut().flatten().for_each(single);
        }
    }
}

/// What one branch dissipates over a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BranchLoss {
    pub retardation_time_s: f64,
    pub energy_loss_j: f64,
    /// The part of it (0 to 1) that is dissipated in the indenter; `None` where that is rigid.
    pub indenter_share: Option<f64>,
}

/// Density over the surface (J/m2) of the work that the indenter does on it over a cycle, the integral of p d(delta): its
/// integral over the surface is the energy loss.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum SurfaceLoss {
    /// Along a radius, axis first; `None` where it is unbounded, at an apex.
    Radial {
        radius_m: Vec<f64>,
        density_j_per_m2: Vec<Option<f64>>,
    },
    Cells(CellLoss),
}

impl Default for SurfaceLoss {
    /// That of nothing.
    fn default() -> Self {
        Self::Radial {
            radius_m: Vec::new(),
            density_j_per_m2: Vec::new(),
        }
    }
}

/// The same at the centres of cells, row by row, of the smallest rectangle that holds all contact of the cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellLoss {
    /// Centre of the first cell, and spacing (m).
    pub first_x_m: f64,
    pub first_y_m: f64,
    pub spacing_x_m: f64,
    pub spacing_y_m: f64,
    pub cells_x: usize,
    /// Single precision: seven digits are more than the grid resolves.
    pub density_j_per_m2: Vec<f32>,
}

/// An instant of the cycle, by what the drive does there. At the two that have the mean, all that differs is what the body
/// remembers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quarter {
    Greatest,
    MeanFalling,
    Least,
    MeanRising,
}

/// The contact pressure at one instant of the stabilised cycle: at the time step nearest to a quarter of the oscillation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PressureProfile {
    pub quarter: Quarter,
    /// Since the start of the cycle.
    pub time_s: f64,
    pub load_n: f64,
    pub approach_m: f64,
    pub contact_radius_m: f64,
    /// Along the radius, or along x and along y through the centre of the cells.
    pub lines: Vec<PressureLine>,
}

impl Quarter {
    /// In the order in which the drive passes them.
    pub const ALL: [Self; 4] = [
        Self::Greatest,
        Self::MeanFalling,
        Self::Least,
        Self::MeanRising,
    ];

    /// The name in every output: "greatest load".
    pub fn name(self, control: Control) -> String {
        let value = control.name();
        match self {
            Self::Greatest => format!("greatest {value}"),
            Self::MeanFalling => format!("mean {value} falling"),
            Self::Least => format!("least {value}"),
            Self::MeanRising => format!("mean {value} rising"),
        }
    }
}

impl CaseRecord {
    /// Energy loss per cycle (J) of a converged case.
    pub fn energy_loss_j(&self) -> Option<f64> {
        self.result.as_ref().map(|r| r.analysis.energy_loss_j)
    }

    /// Its estimated error (J).
    pub fn energy_loss_error_j(&self) -> Option<f64> {
        use crate::sweep::record::error_bars::Quantity::EnergyLoss;
        self.result.as_ref()?.errors.as_ref()?.of(EnergyLoss)
    }

    /// The error (J, 95 %, of this loss on its own) that comes from the noise of the data which the material was fitted to, where it
    /// has replicas: no part of [`Self::energy_loss_error_j`].
    pub fn energy_loss_material_error_j(&self) -> Option<f64> {
        let result = self.result.as_ref()?;
        material_error::from_replicas(result.analysis.energy_loss_j, &result.replica_losses_j)
    }

    /// The same as the half width (J) of the band that holds the whole curve of losses at once.
    pub fn energy_loss_material_band_j(&self) -> Option<f64> {
        let result = self.result.as_ref()?;
        material_error::band(result.analysis.energy_loss_j, &result.replica_losses_j)
    }

    /// The same with its numbers alone.
    #[must_use]
    pub fn without_cycle(&self) -> Self {
        let mut numbers = self.clone();
        if let Some(result) = &mut numbers.result {
            result.cycle = RecordedCycle::default();
        }
        numbers
    }

    /// Whether the case ran under this condition.
    pub fn is_of(&self, condition: &Condition) -> bool {
        let drive = &condition.drive;
        self.varied == condition.values
            && self.drive_mean == drive.mean()
            && self.drive_amplitude == drive.amplitude()
    }

    /// Load frequency (Hz).
    pub fn frequency_hz(&self) -> f64 {
        self.angular_frequency_rad_per_s / std::f64::consts::TAU
    }
}

impl CaseResult {
    /// The cycle, where it is held.
    pub fn cycle(&self) -> Option<&RecordedCycle> {
        self.cycle.is_held().then_some(&self.cycle)
    }

    /// Why a result whose numbers are not all finite is none.
    pub(crate) const NOT_FINITE: &str = "the result is not made of finite numbers: load, lengths, moduli or frequency are so large or \
         small that what is computed of them leaves the range of floating-point numbers";

    /// Whether all its numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        let numbers = Quantity::ALL.into_iter().filter_map(|quantity| {
            let error = self.errors.as_ref().and_then(|errors| errors.of(quantity));
            Some(quantity.of(self)? + error.unwrap_or(0.0))
        });
        let analysis = &self.analysis;
        let means = [
            analysis.polygon_loss_j,
            analysis.load_mean_n,
            analysis.approach_mean_m,
            self.dissipated_j(),
        ];
        let samples = &self.cycle.samples;
        let signals = [&samples.time_s, &samples.load_n, &samples.approach_m];
        let samples = signals.into_iter().flatten().copied();
        (numbers.chain(means).chain(samples)).all(f64::is_finite)
    }

    /// What the cycle says besides of a contact whose edge an attraction moves.
    pub fn attracted(&self) -> Option<&AttractedCycle> {
        match &self.attraction {
            Attracted::Edge(cycle) => Some(cycle),
            Attracted::Nothing | Attracted::Constant { .. } => None,
        }
    }

    /// Tabor's parameter of a sphere that is attracted.
    pub fn tabor_parameter(&self) -> Option<f64> {
        match &self.attraction {
            Attracted::Nothing => None,
            Attracted::Constant { tabor_parameter } => Some(*tabor_parameter),
            Attracted::Edge(cycle) => cycle.tabor_parameter,
        }
    }

    /// Energy (J) dissipated by all branches.
    pub fn dissipated_j(&self) -> f64 {
        self.branches.iter().map(|b| b.energy_loss_j).sum()
    }

    /// What dissipates under the edge of a contact that an attraction moves (J): the loss without that of the bulk and of jumps.
    pub fn edge_loss_j(&self) -> Option<f64> {
        let attracted = self.attracted()?;
        let others_j = attracted.bulk_loss_j + attracted.jump_loss_j();
        Some(self.analysis.energy_loss_j - others_j)
    }

    /// Energy (J) dissipated in the indenter; `None` where that is rigid.
    pub fn dissipated_in_indenter_j(&self) -> Option<f64> {
        let part = |branch: &BranchLoss| Some(branch.indenter_share? * branch.energy_loss_j);
        let sum: Option<f64> = self.branches.iter().map(part).sum();
        sum.filter(|_| !self.branches.is_empty())
    }

    /// By how much the dissipation differs from the area of the loop, relative to it: zero but for discretisation.
    /// `None` for a loop without area.
    pub fn energy_imbalance(&self) -> Option<f64> {
        let loss = self.analysis.energy_loss_j;
        (loss != 0.0 && !self.branches.is_empty()).then(|| self.dissipated_j() / loss - 1.0)
    }
}
