//! A sweep as it will be run, every default filled in. [`check`] has the ranges of its values.

pub mod body_material;
pub mod check;
pub mod instant_tolerance;
pub mod resolved;
pub mod scenario;

use std::sync::Arc;

use crate::drive::{DriveError, HarmonicDrive};
use crate::history::TimeRule;
use crate::indenter::Indenter;
use crate::material::Material;
use crate::sweep::figures::figure_plan::FigurePlan;

/// Everything a sweep needs to know. Two equal plans give equal results, bit for bit.
#[derive(Debug, Clone)]
pub struct SweepPlan {
    pub title: String,
    pub material: Material,
    pub indenter: Arc<dyn Indenter>,
    pub drive: HarmonicDrive,
    /// The second axis of the sweep, where there is one: every frequency is then solved under each of these drives.
    pub axis: Option<DriveAxis>,
    /// Ascending, in rad/s.
    pub angular_frequencies_rad_per_s: Vec<f64>,
    /// Whether frequencies are added where these do not resolve the curve of the loss.
    pub refine: bool,
    pub cycle: CyclePlan,
    pub solver: SolverPlan,
    /// How the figures look; no part of the results.
    pub figures: FigurePlan,
}

/// Drives that differ in one of their numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveAxis {
    pub varied: Varied,
    /// In the order of the varied number, ascending; the first, with the frequencies, makes the first cases.
    pub drives: Vec<HarmonicDrive>,
}

/// What differs between the drives of a [`DriveAxis`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Varied {
    Amplitude,
    Mean,
}

impl Varied {
    /// The key of `[drive]`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Amplitude => "amplitude",
            Self::Mean => "mean",
        }
    }

    /// The drive with another varied number (N or m).
    ///
    /// # Errors
    /// As [`HarmonicDrive::new`].
    pub fn drive(self, drive: &HarmonicDrive, value: f64) -> Result<HarmonicDrive, DriveError> {
        let (mean, amplitude) = match self {
            Self::Amplitude => (drive.mean(), value),
            Self::Mean => (value, drive.amplitude()),
        };
        let (phase_rad, hold_s) = (drive.phase_rad(), drive.hold_s());
        HarmonicDrive::new(drive.control(), mean, amplitude, phase_rad, hold_s)
    }

    /// The varied number of a drive, in the unit of its control.
    pub fn value(self, drive: &HarmonicDrive) -> f64 {
        match self {
            Self::Amplitude => drive.amplitude(),
            Self::Mean => drive.mean(),
        }
    }
}

/// One frequency under one drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Case {
    /// Position in the sweep, from 0: drive after drive, and ascending frequency within each.
    pub index: usize,
    pub angular_frequency_rad_per_s: f64,
    pub drive: HarmonicDrive,
}

impl SweepPlan {
    /// A sweep without frequencies and title, everything else at its default.
    pub fn new(material: Material, indenter: Arc<dyn Indenter>, drive: HarmonicDrive) -> Self {
        Self {
            title: String::new(),
            material,
            solver: SolverPlan::of_indenter(indenter.as_ref()),
            indenter,
            drive,
            axis: None,
            angular_frequencies_rad_per_s: Vec::new(),
            refine: false,
            cycle: CyclePlan::default(),
            figures: FigurePlan::default(),
        }
    }

    /// The drives: one, but for a sweep of two axes.
    pub fn drives(&self) -> &[HarmonicDrive] {
        match &self.axis {
            Some(axis) => &axis.drives,
            None => std::slice::from_ref(&self.drive),
        }
    }

    /// Every case, in order.
    pub fn cases(&self) -> Vec<Case> {
        let omegas = &self.angular_frequencies_rad_per_s;
        let pairs = self
            .drives()
            .iter()
            .flat_map(|drive| omegas.iter().map(move |omega| (*drive, *omega)));
        pairs
            .enumerate()
            .map(|(index, (drive, angular_frequency_rad_per_s))| Case {
                index,
                angular_frequency_rad_per_s,
                drive,
            })
            .collect()
    }
}

/// How a cycle is resolved and when it counts as stabilised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclePlan {
    /// Time steps per cycle; where an accuracy is asked for, at least.
    pub steps: usize,
    /// How the stabilised cycle is reached.
    pub method: Method,
    /// Largest allowed estimated distance to the stabilised cycle: of the memory relative to the pressure, and of the loop to a
    /// closed one relative to its area.
    pub tolerance: f64,
    /// Cycles of marching after which a frequency counts as not converged.
    pub max_cycles: usize,
    /// Whether every result is to be computed on coarser resolutions too, which gives its error.
    pub error_bars: bool,
    /// Largest allowed error of the loss, relative: steps and nodes are then chosen to reach it.
    pub accuracy: Option<f64>,
}

/// How the stabilised cycle is reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Method {
    /// Searched: see [`crate::steady`].
    Direct,
    /// Waited for, cycle after cycle.
    March,
}

impl Method {
    /// The name as written in a sweep file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Direct => "direct",
            Self::March => "march",
        }
    }
}

/// Which engine, and how fine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverPlan {
    pub engine: EngineKind,
    pub time_rule: TimeRule,
    /// Axisymmetric engine: springs over the domain.
    pub springs: usize,
    /// Half-space engine: cells along the longer side of the domain; those of the indenter where it is a map.
    pub cells: usize,
    /// Half-space engine: tolerance of one instant, see [`crate::contact::half_space::SolverSettings`]; where none is given, what
    /// the loss asks for, see [`crate::sweep::plan::instant_tolerance`].
    pub tolerance: Option<f64>,
}

/// The two contact engines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum EngineKind {
    Axisymmetric,
    HalfSpace,
}

impl EngineKind {
    /// The name as written in a sweep file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Axisymmetric => "axisymmetric",
            Self::HalfSpace => "half-space",
        }
    }
}

impl SolverPlan {
    /// Everything at its default: springs where the indenter allows them, cells elsewhere.
    pub fn of_indenter(indenter: &dyn Indenter) -> Self {
        let engine = match indenter.axisymmetric() {
            Some(_) => EngineKind::Axisymmetric,
            None => EngineKind::HalfSpace,
        };
        Self {
            engine,
            ..Self::default()
        }
    }

    /// Nodes along the contact's radius (springs) or the domain's longer side (cells), whichever the engine has.
    pub fn nodes(&self) -> usize {
        match self.engine {
            EngineKind::Axisymmetric => self.springs,
            EngineKind::HalfSpace => self.cells,
        }
    }

    /// The same with the cells that an indenter brings, where it brings any.
    #[must_use]
    pub fn on_own_cells(self, indenter: &dyn Indenter) -> Self {
        match indenter.own_cells() {
            Some((cells_x, cells_y)) => Self {
                cells: cells_x.max(cells_y),
                ..self
            },
            None => self,
        }
    }

    /// The same engine with another number of them.
    #[must_use]
    pub fn with_nodes(self, nodes: usize) -> Self {
        match self.engine {
            EngineKind::Axisymmetric => Self {
                springs: nodes,
                ..self
            },
            EngineKind::HalfSpace => Self {
                cells: nodes,
                ..self
            },
        }
    }
}

impl CyclePlan {
    /// What counts where nothing is asked for.
    pub const DEFAULT: Self = Self {
        steps: 200,
        method: Method::Direct,
        tolerance: 1e-4,
        max_cycles: 1000,
        error_bars: true,
        accuracy: None,
    };
}

impl Default for CyclePlan {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl SolverPlan {
    /// What counts where nothing is asked for.
    pub const DEFAULT: Self = Self {
        engine: EngineKind::Axisymmetric,
        time_rule: TimeRule::Linear,
        springs: 400,
        cells: 128,
        tolerance: None,
    };
}

impl Default for SolverPlan {
    fn default() -> Self {
        Self::DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indenter::{HeightMap, MapEdge, MapQuantity, Shifted, Sphere};

    #[test]
    fn the_cells_of_a_map_are_those_of_the_plan_whatever_was_asked_for() {
        let heights = (0..200 * 150).map(|i| 1e-9 * f64::from(i % 7)).collect();
        let map = HeightMap::new(
            (200, 150),
            (1e-6, 1e-6),
            heights,
            MapQuantity::Gap,
            MapEdge::Unknown,
        )
        .unwrap();
        let map: Arc<dyn Indenter> = Arc::new(map);
        let sphere: Arc<dyn Indenter> = Arc::new(Sphere::new(0.01).unwrap());
        let moved = |inner: &Arc<dyn Indenter>| Shifted::new(Arc::clone(inner), 1e-6, 0.0).unwrap();
        let cells = |indenter: &dyn Indenter| SolverPlan::default().on_own_cells(indenter).cells;
        assert_eq!([cells(map.as_ref()), cells(&moved(&map))], [200, 200]);
        assert_eq!([cells(sphere.as_ref()), cells(&moved(&sphere))], [128, 128]);
    }
}
