//! One axis of a sweep over several: the sweep along it, the other axes at their values where the loss is largest.

use super::Figure;
use super::curve::{Abscissa, SweepCurves, curves, largest};
use super::units::Units;
use crate::report::ReportError;
use crate::report::number;
use crate::sweep::plan::{AxisValues, SweepPlan};
use crate::sweep::record::CaseRecord;
use crate::sweep::search::peak::Peak;
use crate::sweep::search::run::Outcome;

/// A sweep along one axis, and its results.
pub struct Line {
    pub plan: SweepPlan,
    pub outcome: Outcome,
    /// Where the other axes are held; `None` of pairs.
    pub sentence: Option<String>,
}

impl Line {
    /// Its curves.
    ///
    /// # Errors
    /// As [`SweepCurves::of`].
    pub fn curves(&self, over: Abscissa) -> Result<SweepCurves<'_>, ReportError> {
        SweepCurves::of(&self.plan, &self.outcome, over)
    }

    /// A figure along the axis, with where the others are held in its caption.
    pub fn say(&self, figure: Figure) -> Figure {
        Figure {
            caption: figure.caption.say_all(self.sentence.clone()),
            ..figure
        }
    }
}

/// The sweep along an axis; `None` where it has no such axis, or but one.
pub fn along(plan: &SweepPlan, outcome: &Outcome, axis: usize) -> Option<Line> {
    let axes = plan.axes.as_ref()?;
    if axes.over.len() < 2 || (axes.pairs && axis > 0) {
        return None;
    }
    let highest = curves(plan, outcome, &Units::default());
    let through = largest(&highest)?.condition.values;
    let is_on = |values: &AxisValues| axes.is_along(axis, values, &through);
    let record = |record: &CaseRecord| CaseRecord {
        varied: record.varied.alone(axis),
        ..record.clone()
    };
    let records = outcome.records.iter().filter(|r| is_on(&r.varied));
    let peaks = outcome.peaks.iter().filter(|peak| is_on(&peak.varied));
    let peak = |peak: &Peak| Peak {
        varied: peak.varied.alone(axis),
        ..*peak
    };
    let held = axes.over.iter().enumerate().filter(|(k, _)| *k != axis);
    let held = held.filter_map(|(k, varied)| {
        let value = number::varied(varied, through.get(k)?);
        Some(format!("{} {value}", varied.words()))
    });
    let held: Vec<String> = held.collect();
    Some(Line {
        plan: SweepPlan {
            axes: axes.along(axis, &through),
            ..plan.clone()
        },
        outcome: Outcome {
            records: records.map(record).collect(),
            peaks: peaks.map(peak).collect(),
            peak_problems: outcome.peak_problems.clone(),
            interrupted: outcome.interrupted,
            missing: outcome.missing,
        },
        sentence: (!axes.pairs).then(|| format!("Other axes at {}.", held.join(", "))),
    })
}
