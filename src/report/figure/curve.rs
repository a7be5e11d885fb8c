//! The cases of a sweep as curves over frequency or over another axis, one for each value of the others; and which of many are shown.

use std::collections::BTreeMap;

use super::plot::Plot;
use super::quantity::{ENERGY_LOSS, Quantity};
use super::units::Units;
use crate::report::ReportError;
use crate::report::chart::literal;
use crate::sweep::plan::{AxisValue, Block, Condition, SweepPlan, Varied};
use crate::sweep::record::{CaseRecord, CaseResult};
use crate::sweep::search::peak::Peak;
use crate::sweep::search::run::Outcome;

/// The cases under one condition, in ascending frequency.
pub struct Curve<'a> {
    pub condition: Condition,
    /// What tells it from other curves, as a label of a chart; `None` where it is the only one.
    pub label: Option<String>,
    /// The same for a caption.
    pub sentence: Option<String>,
    /// Its value of [`SweepCurves::family`] (SI).
    pub member: Option<f64>,
    pub records: Vec<&'a CaseRecord>,
}

/// What a value of an axis is called in a legend, and in a caption.
fn words_of(varied: &Varied, value: AxisValue, units: &Units) -> [String; 2] {
    let value = units.varied_value(varied, value);
    let said = match varied.is_whole() {
        true => value,
        false => format!("{} {value}", varied.name()),
    };
    let of = match varied.block {
        Block::Drive => "Drive",
        Block::Indenter => "Indenter",
        Block::Layer => "Layer",
        Block::Material => "Material",
    };
    let sentence = format!("{of}: {said}.");
    // A label is typeset, and names are not: `poly_2` stays as it is.
    [literal(&said), sentence]
}

/// What a curve is called that has these values, and the same for a caption; nothing of no value.
fn called<'v>(
    values: impl Iterator<Item = (&'v Varied, AxisValue)>,
    units: &Units,
) -> [Option<String>; 2] {
    let words = values.map(|(varied, value)| words_of(varied, value, units));
    let (labels, sentences): (Vec<String>, Vec<String>) =
        words.map(|[label, sentence]| (label, sentence)).unzip();
    let joined = |words: Vec<String>, by: &str| (!words.is_empty()).then(|| words.join(by));
    [joined(labels, ", "), joined(sentences, " ")]
}

/// The curves of a sweep over frequency, in the order of its conditions, labelled in these units; those without any case are left out.
pub fn curves<'a>(plan: &SweepPlan, outcome: &'a Outcome, units: &Units) -> Vec<Curve<'a>> {
    let over = plan.axes.as_ref().map_or(&[][..], |axes| &axes.over);
    // Records stand curve after curve, in the order of the conditions.
    let mut rest = outcome.records.iter().peekable();
    let conditions = plan.conditions();
    let curves = conditions.iter().map(|condition| {
        let values = over.iter().zip(condition.values.all().iter().copied());
        let [label, sentence] = called(values, units);
        Curve {
            label,
            sentence,
            records: std::iter::from_fn(|| rest.next_if(|record| record.is_of(condition)))
                .collect(),
            member: condition.number(),
            condition: condition.clone(),
        }
    });
    curves.filter(|curve| !curve.records.is_empty()).collect()
}

/// The curves of a sweep over one of its axes: one for each frequency and each value of the other axes that has two cases or more.
fn curves_over<'a>(
    plan: &SweepPlan,
    outcome: &'a Outcome,
    axis: usize,
    units: &Units,
) -> Vec<Curve<'a>> {
    let over = plan.axes.as_ref().map_or(&[][..], |axes| &axes.over);
    // Of pairs the numbers vary together: the others are where the axis is.
    let is_paired = plan.axes.as_ref().is_some_and(|axes| axes.pairs);
    let others = |record: &CaseRecord| {
        let values = record.varied.all().iter().copied().enumerate();
        let others = values.filter(|(other, _)| *other != axis && !is_paired);
        others.map(|(_, value)| value).collect::<Vec<_>>()
    };
    let mut groups: BTreeMap<(u64, Vec<u64>), Vec<&CaseRecord>> = BTreeMap::new();
    for record in &outcome.records {
        // Of frequencies, which are above zero, the bits have the order of the numbers.
        let omega = record.angular_frequency_rad_per_s.to_bits();
        let values = others(record).into_iter().map(|v| v.as_number().to_bits());
        groups
            .entry((omega, values.collect()))
            .or_default()
            .push(record);
    }
    let has_one_frequency = plan.angular_frequencies_rad_per_s.len() == 1;
    let conditions = plan.conditions();
    let curve = |mut records: Vec<&'a CaseRecord>| {
        let value = |record: &CaseRecord| record.varied.get(axis).map_or(0.0, AxisValue::as_number);
        records.sort_by(|a, b| value(a).total_cmp(&value(b)));
        let first = *records.first()?;
        let varied = over.iter().enumerate();
        let varied = varied.filter(|(other, _)| *other != axis && !is_paired);
        let values = varied.map(|(_, varied)| varied).zip(others(first));
        let [label, sentence] = called(values, units);
        let omega = first.angular_frequency_rad_per_s;
        let at = units.frequency_label(omega);
        let is_labelled = !has_one_frequency || label.is_none();
        let at = is_labelled.then_some(at);
        let label: Vec<String> = at.into_iter().chain(label).collect();
        Some(Curve {
            member: match has_one_frequency && over.len() == 2 {
                true => others(first).first().and_then(|value| value.number()),
                false => Some(omega),
            },
            label: Some(label.join(", ")),
            sentence,
            condition: conditions.iter().find(|c| first.is_of(c))?.clone(),
            records,
        })
    };
    let groups = groups.into_values().filter(|records| records.len() > 1);
    groups.filter_map(curve).collect()
}

/// What curves are drawn over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Abscissa {
    Frequency,
    /// The axis at this place, which varies a number.
    Axis(usize),
}

impl Abscissa {
    /// The frequency; where a sweep has but one, its first axis of numbers.
    pub fn of(plan: &SweepPlan) -> Self {
        let over = plan.axes.as_ref().map_or(&[][..], |axes| &axes.over);
        let is_numbers = |varied: &Varied| !varied.is_whole();
        match (
            plan.angular_frequencies_rad_per_s.len(),
            over.iter().position(is_numbers),
        ) {
            (1, Some(axis)) => Self::Axis(axis),
            _ => Self::Frequency,
        }
    }
}

/// A sweep as its figures show it: as curves over one quantity.
pub struct SweepCurves<'a> {
    pub plan: &'a SweepPlan,
    pub outcome: &'a Outcome,
    pub units: Units,
    pub over: Abscissa,
    /// What the curves are drawn over.
    pub x: Quantity,
    /// Of which number each curve has another, where it is one.
    pub family: Option<Quantity>,
    pub curves: Vec<Curve<'a>>,
}

impl<'a> SweepCurves<'a> {
    /// The curves in the units that the sweep asks for.
    ///
    /// # Errors
    /// [`ReportError::Scale`] where normalised axes are asked for and there is nothing to normalise by.
    pub fn of(
        plan: &'a SweepPlan,
        outcome: &'a Outcome,
        over: Abscissa,
    ) -> Result<Self, ReportError> {
        let units = Units::of_sweep(plan)?;
        let control = plan.base.drive.control();
        let axes = plan.axes.as_ref().map_or(&[][..], |axes| &axes.over);
        let varied = |axis: usize| axes.get(axis).map(|of| Quantity::varied(of, control));
        let is_one_frequency = plan.angular_frequencies_rad_per_s.len() == 1;
        // Of curves that differ in several numbers, none tells which they are.
        let (x, family, curves) = match over {
            Abscissa::Frequency => {
                let is_number = axes.first().filter(|of| !of.is_whole() && axes.len() == 1);
                let family = is_number.and_then(|_| varied(0));
                (None, family, curves(plan, outcome, &units))
            }
            Abscissa::Axis(axis) => {
                let mut others = (0..axes.len()).filter(|other| *other != axis);
                let family = match (others.next(), others.next(), is_one_frequency) {
                    (None, _, _) => Some(Quantity::frequency(&units)),
                    (Some(other), None, true) if !axes[other].is_whole() => varied(other),
                    _ => None,
                };
                (
                    varied(axis),
                    family,
                    curves_over(plan, outcome, axis, &units),
                )
            }
        };
        Ok(Self {
            x: x.unwrap_or_else(|| Quantity::frequency(&units)),
            family,
            curves,
            over,
            plan,
            outcome,
            units,
        })
    }

    /// Where a case stands on the abscissa (SI).
    pub fn place(&self, record: &CaseRecord) -> f64 {
        match self.over {
            Abscissa::Frequency => record.angular_frequency_rad_per_s,
            Abscissa::Axis(axis) => {
                let value = record.varied.get(axis);
                value.map_or(f64::NAN, AxisValue::as_number)
            }
        }
    }

    /// Those of the curves that are asked for; without any, at most `most`, evenly spread.
    pub fn shown(&self, most: usize) -> Vec<&Curve<'a>> {
        let asked = self.plan.figures.curves.iter();
        let mut places: Vec<usize> = asked.map(|number| *number as usize - 1).collect();
        places.retain(|place| *place < self.curves.len());
        if places.is_empty() || self.curves.len() == 1 {
            places = evenly(self.curves.len(), most);
        }
        let places = places.into_iter();
        places.filter_map(|k| self.curves.get(k)).collect()
    }

    /// A frame over the abscissa, whose ends may be asked for.
    pub fn plot(&self, y: Quantity) -> Plot {
        let ends = |range: &[f64]| range.first().copied().zip(range.last().copied());
        let asked = &self.plan.figures;
        let of_loss = y.column == ENERGY_LOSS.column;
        Plot {
            x_ends: match self.over {
                Abscissa::Frequency => ends(&asked.frequency_range_rad_per_s),
                Abscissa::Axis(_) => None,
            },
            y_ends: ends(&asked.energy_loss_range_j).filter(|_| of_loss),
            family: self.family.clone(),
            ..Plot::new(self.x.clone(), y)
        }
    }

    /// All cases, curve by curve.
    pub fn records(&self) -> impl Iterator<Item = &'a CaseRecord> {
        self.curves.iter().flat_map(|curve| &curve.records).copied()
    }

    /// The peaks on a curve; over other axes than the frequency there are none.
    pub fn peaks_of(&self, curve: &Curve<'_>) -> impl Iterator<Item = &'a Peak> {
        let peaks = match self.over {
            Abscissa::Frequency => &self.outcome.peaks[..],
            Abscissa::Axis(_) => &[],
        };
        peaks.iter().filter(|peak| peak.is_of(&curve.condition))
    }

    /// What is drawn over what, for a caption: `over angular frequency ω`; of several curves how many and of what.
    pub fn over_words(&self, shown: usize) -> String {
        let over = &self.x.words;
        match (&self.family, self.curves.len()) {
            (_, 0 | 1) => format!("over {over}"),
            (Some(family), _) => format!("over {over}, {shown} curves, one per {}", family.words),
            (None, _) => {
                let axes = self.plan.axes.as_ref().filter(|axes| axes.over.len() == 1);
                let of = axes.map(|axes| format!(", one per {}", axes.varied().words()));
                format!("over {over}, {shown} curves{}", of.unwrap_or_default())
            }
        }
    }

    /// What a case is called on its curve: its frequency, or its value of the axis.
    pub fn label_of(&self, record: &CaseRecord) -> String {
        match self.over {
            Abscissa::Frequency => {
                let omega = record.angular_frequency_rad_per_s;
                self.units.frequency_label(omega)
            }
            Abscissa::Axis(axis) => {
                let value = self.units.value(self.x.measure, self.place(record), 4);
                let axes = self.plan.axes.as_ref();
                match axes.and_then(|axes| axes.over.get(axis)) {
                    Some(varied) => format!("{} {value}", varied.name()),
                    None => value,
                }
            }
        }
    }

    /// Whether a figure of single cases shows those of one curve among several.
    pub fn is_of_one_curve(&self) -> bool {
        let axes = self.plan.axes.as_ref();
        !axes.is_some_and(|axes| axes.over.len() == 1 && axes.varied().is_whole())
    }

    /// The condition of a case.
    pub fn condition(&self, record: &CaseRecord) -> Option<&'a Condition> {
        self.plan.conditions().iter().find(|c| record.is_of(c))
    }
}

/// The curve with the largest loss: what a figure that has room for one curve shows.
pub fn largest<'a, 'b>(curves: &'b [Curve<'a>]) -> Option<&'b Curve<'a>> {
    let largest = |curve: &Curve<'_>| {
        let losses = curve.records.iter().filter_map(|r| r.energy_loss_j());
        losses.fold(f64::NEG_INFINITY, f64::max)
    };
    // Of equals the first.
    let larger = |a: &&Curve<'_>, b: &&Curve<'_>| largest(a).total_cmp(&largest(b));
    curves.iter().rev().max_by(larger)
}

impl<'a> Curve<'a> {
    /// The cases that have a result.
    pub fn results(&self) -> Vec<(&'a CaseRecord, &'a CaseResult)> {
        let results = self.records.iter();
        results
            .filter_map(|record| Some((*record, record.result.as_ref()?)))
            .collect()
    }

    /// The one of the largest loss.
    pub fn largest_result(&self) -> Option<(&'a CaseRecord, &'a CaseResult)> {
        let loss = |(_, result): &(&CaseRecord, &CaseResult)| result.analysis.energy_loss_j;
        let results = self.results().into_iter();
        results.max_by(|a, b| loss(a).total_cmp(&loss(b)))
    }
}

/// The results nearest to these frequencies (rad/s), in their order and each once; without any, at most `most`, evenly spread,
/// the one of the largest loss among them.
pub fn chosen<'a>(
    results: &[(&'a CaseRecord, &'a CaseResult)],
    frequencies_rad_per_s: &[f64],
    most: usize,
) -> Vec<(&'a CaseRecord, &'a CaseResult)> {
    let places = match frequencies_rad_per_s {
        [] => {
            let losses = results.iter().map(|(_, r)| r.analysis.energy_loss_j);
            with_the_largest(&losses.collect::<Vec<f64>>(), most)
        }
        frequencies => {
            let omega = |place: usize| results[place].0.angular_frequency_rad_per_s;
            let off = |place: usize, wanted: f64| (omega(place) / wanted).ln().abs();
            let nearest = |wanted: &f64| {
                let by_distance =
                    |a: &usize, b: &usize| off(*a, *wanted).total_cmp(&off(*b, *wanted));
                (0..results.len()).min_by(by_distance)
            };
            let mut places: Vec<usize> = frequencies.iter().filter_map(nearest).collect();
            places.sort_unstable();
            places.dedup();
            places
        }
    };
    places
        .into_iter()
        .filter_map(|place| results.get(place).copied())
        .collect()
}

/// At most `most` of `count` places, evenly spread with both ends; rather some fewer than unevenly.
pub fn evenly(count: usize, most: usize) -> Vec<usize> {
    if count <= most || most < 2 {
        return (0..count.min(most)).collect();
    }
    let even = (most / 2 + 1..=most)
        .rev()
        .find(|n| (count - 1).is_multiple_of(n - 1));
    let chosen = even.unwrap_or(most);
    (0..chosen)
        .map(|k| k * (count - 1) / (chosen - 1))
        .collect()
}

/// The same, with the largest of the values in place of its nearest neighbour.
pub fn with_the_largest(values: &[f64], most: usize) -> Vec<usize> {
    let mut chosen = evenly(values.len(), most);
    let largest = (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b]));
    if let Some(largest) = largest
        && !chosen.contains(&largest)
        // The ends stay: they show the range.
        && let Some(nearest) =
            (1..chosen.len().saturating_sub(1)).min_by_key(|&k| chosen[k].abs_diff(largest))
    {
        chosen[nearest] = largest;
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chosen_span_the_sweep_and_hold_the_largest() {
        let losses: Vec<f64> = (0..41).map(|i| -f64::from(i - 19).powi(2)).collect();
        assert_eq!(with_the_largest(&losses, 5), [0, 10, 19, 30, 40]);
        assert_eq!(with_the_largest(&losses[..3], 5), [0, 1, 2]);
        assert_eq!(with_the_largest(&[], 5), Vec::<usize>::new());
        assert_eq!(evenly(9, 8), [0, 2, 4, 6, 8]);
        assert_eq!(evenly(10, 8), [0, 1, 2, 3, 5, 6, 7, 9]);
        assert_eq!(evenly(9, 1), [0]);
    }
}
