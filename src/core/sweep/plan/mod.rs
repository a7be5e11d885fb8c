//! A sweep as it will be run, every default filled in. [`check`] has the ranges of its values.

pub mod adhesion;
pub mod axes;
pub mod check;
pub mod contact;
pub mod figures;
pub mod layer;
mod material_text;
pub mod resolved;
pub mod setup;

pub use axes::{Axes, AxisValue, AxisValues, Block, Varied};

use std::sync::Arc;

use crate::drive::HarmonicDrive;
use crate::engine::{SolverPlan, TOLERANCE};
use crate::indenter::Indenter;
use crate::material::Material;
use crate::quantity::block::Conflict;
use crate::quantity::key::{Kind, Limits, tolerance};
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::plan::figures::FigurePlan;
use crate::{block_with_defaults, keys, words};

/// Cases of a small sweep, at most.
pub const SMALL: usize = 200;

keys! {
    /// Whether frequencies are added where the given ones do not resolve the loss curve.
    REFINE = "refine", Kind::Flag, or false;
}

/// Everything a sweep needs to know. Two equal plans give equal results, bit for bit.
#[derive(Debug, Clone)]
pub struct SweepPlan {
    pub title: String,
    /// The contact and the drive as they are given. Where axes vary them, this is what their conditions have in common.
    pub base: Condition,
    /// Other axes than the frequency, where there are any: every frequency is then solved under each of their conditions.
    pub axes: Option<Axes>,
    pub solver: SolverPlan,
    /// Ascending, in rad/s.
    pub angular_frequencies_rad_per_s: Vec<f64>,
    /// Whether frequencies are added where these do not resolve the curve of the loss.
    pub refine: bool,
    pub cycle: CyclePlan,
    /// How the figures look; no part of the results.
    pub figures: FigurePlan,
}

/// What all cases of a curve over frequency have in common.
#[derive(Debug, Clone)]
pub struct Condition {
    /// The varied numbers; none in a sweep over frequency alone.
    pub values: AxisValues,
    pub contact: ContactPlan<Arc<Material>>,
    pub drive: HarmonicDrive,
}

/// One frequency under one condition.
#[derive(Debug, Clone)]
pub struct Case {
    /// Position in the sweep, from 0: condition after condition, and ascending frequency within each.
    pub index: usize,
    pub angular_frequency_rad_per_s: f64,
    pub condition: Condition,
}

impl SweepPlan {
    /// A sweep without frequencies and title, everything else at its default.
    pub fn new(material: Material, indenter: Arc<dyn Indenter>, drive: HarmonicDrive) -> Self {
        let solver = SolverPlan::of(indenter.as_ref(), false);
        Self::of(
            ContactPlan::new(Arc::new(material), indenter),
            solver,
            drive,
        )
    }

    /// The same of a contact that is known, solved like this.
    pub fn of(
        contact: ContactPlan<Arc<Material>>,
        solver: SolverPlan,
        drive: HarmonicDrive,
    ) -> Self {
        Self {
            title: String::new(),
            solver,
            base: Condition {
                values: AxisValues::default(),
                contact,
                drive,
            },
            axes: None,
            angular_frequencies_rad_per_s: Vec::new(),
            refine: false,
            cycle: CyclePlan::default(),
            figures: FigurePlan::default(),
        }
    }

    /// The conditions: one, but for a sweep with other axes than the frequency.
    pub fn conditions(&self) -> &[Condition] {
        let of_axes = self.axes.as_ref().map(|axes| &axes.conditions[..]);
        of_axes.unwrap_or(std::slice::from_ref(&self.base))
    }

    /// The blocks of a list, each by its name and in the first condition that has it; without a list what the plan has itself.
    pub fn each_of(&self, block: Block) -> Vec<(Option<&str>, &Condition)> {
        let listed = (self.axes.as_ref()).and_then(|axes| Some((axes, axes.whole(block)?)));
        let Some((axes, (axis, varied))) = listed else {
            return vec![(None, &self.base)];
        };
        let names = varied.names.iter().enumerate();
        let first = names.filter_map(|(place, name)| {
            let mut conditions = axes.conditions.iter();
            let first = conditions.find(|c| c.values.get(axis) == Some(AxisValue::Block(place)));
            Some((Some(name.as_str()), first?))
        });
        first.collect()
    }

    /// The indenter under the condition of these values.
    pub fn indenter_under(&self, values: &AxisValues) -> &dyn Indenter {
        let mut conditions = self.conditions().iter();
        let condition = conditions.find(|condition| condition.values == *values);
        &*condition.unwrap_or(&self.base).contact.indenter
    }

    /// How many cases there are.
    pub fn count(&self) -> usize {
        self.conditions().len() * self.angular_frequencies_rad_per_s.len()
    }

    /// Whether an attraction moves the edge of the contact.
    pub fn is_attracted(&self) -> bool {
        self.base.contact.is_attracted()
    }

    /// Whether every case has tables of its own, and the cycles of all fit in the memory.
    pub fn is_small(&self) -> bool {
        self.count() <= SMALL
    }

    /// Every case, in order.
    pub fn cases(&self) -> Vec<Case> {
        let mut cases = Vec::with_capacity(self.count());
        for condition in self.conditions() {
            for angular_frequency_rad_per_s in &self.angular_frequencies_rad_per_s {
                cases.push(Case {
                    index: cases.len(),
                    angular_frequency_rad_per_s: *angular_frequency_rad_per_s,
                    condition: condition.clone(),
                });
            }
        }
        cases
    }
}

words! {
    /// How the stabilised cycle is reached.
    #[derive(serde::Serialize, serde::Deserialize)]
    #[serde(rename_all = "kebab-case")]
    #[non_exhaustive]
    pub enum Method {
        /// Searched: see [`crate::steady`].
        Direct = "direct",
        /// Waited for, cycle after cycle.
        March = "march",
    }
}

block_with_defaults! {
    /// Resolution of a cycle, and when it counts as stabilised.
    #[derive(Copy)]
    pub struct CyclePlan in "cycle" unless in_conflict {
        /// Time steps per cycle; with `accuracy`, the minimum.
        steps: usize = 200 => "steps", Kind::Integer(8..=1_000_000);
        /// `direct`: the stabilised cycle is solved for; `march`: cycles are computed one after another, after the hold, until it is reached.
        method: Method = Method::Direct => "method", Kind::Word(Method::WORDS);
        /// Largest distance to the stabilised cycle, for the memory and for the closure of the loop.
        tolerance: f64 = 1e-4 => "tolerance", Kind::Number(tolerance("1e-4").within(TOLERANCE));
        /// Number of marched cycles after which a frequency counts as not converged.
        max_cycles: usize = 1000 => "max_cycles", Kind::Integer(1..=100_000_000);
        /// With `method = "march"`: records this cycle after the hold, counted from 1, whether it is stabilised or not.
        at_cycle: Option<usize> = None => "at_cycle", Kind::Integer(1..=100_000_000);
        /// Whether every case is also solved with coarser steps and nodes to estimate its errors.
        error_bars: bool = true => "error_bars", Kind::Flag;
        /// Largest relative error of every loss: steps, and springs or cells, are chosen to reach it. Same as `--accuracy`. A sweep whose
        /// `steps` are left out begins at 100.
        accuracy: Option<f64> = None => "accuracy", Kind::Number(
            tolerance("1e-3").within(ACCURACY).or_else("for example accuracy = 1e-3, a thousandth of the loss")
        );
    }
}

/// Below 1, and above what the finest resolution could reach.
const ACCURACY: Limits = Limits::of(1e-8..1.0);

impl CyclePlan {
    /// What counts in the file of a sweep to an accuracy: most cases take no more steps than that to a thousandth.
    pub const TO_AN_ACCURACY: Self = Self {
        steps: 100,
        ..Self::DEFAULT
    };

    fn in_conflict(&self) -> Option<Conflict> {
        (self.at_cycle.is_some() && self.method == Method::Direct).then(|| Conflict {
            key: "at_cycle",
            what: "a cycle by its number needs `cycle.method = \"march\"`".to_owned(),
            because: Some("a direct search knows no cycles before the stabilised one"),
            help: "add `method = \"march\"`, and in `[drive]` perhaps a `hold` before the first cycle",
        })
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::drive::Control;
    use crate::indenter::Sphere;
    use crate::material::library;

    /// A sphere on PMMA under a load, of which no number varies.
    pub(crate) fn condition() -> Condition {
        let pmma = library::find("pmma").unwrap().material().unwrap();
        let drive = HarmonicDrive::new(Control::Load, 10.0, 5.0, 0.0, 0.0).unwrap();
        SweepPlan::new(pmma, Arc::new(Sphere::new(0.01).unwrap()), drive).base
    }
}
