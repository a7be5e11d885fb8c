//! The cases of a sweep as curves over frequency: one, or one per value of a second axis; and which of many are shown.

use super::units::Units;
use crate::report::table::Cell;
use crate::sweep::plan::{Axes, AxisValues, Block, Condition, SweepPlan, Varied};
use crate::sweep::record::{CaseRecord, CaseResult};
use crate::sweep::search::run::Outcome;

/// The cases under one condition, in ascending frequency.
pub struct Curve<'a> {
    pub condition: Condition,
    /// What tells it from other curves; `None` where it is the only one.
    pub label: Option<String>,
    /// The same for a caption.
    pub sentence: Option<String>,
    pub records: Vec<&'a CaseRecord>,
}

/// The curves of a sweep, in the order of its conditions, labelled in these units; those without any case are left out.
pub fn curves<'a>(plan: &SweepPlan, outcome: &'a Outcome, units: &Units) -> Vec<Curve<'a>> {
    // Records stand curve after curve, in the order of the conditions.
    let mut rest = outcome.records.iter().peekable();
    let conditions = plan.conditions();
    let curves = conditions.iter().map(|condition| Curve {
        records: std::iter::from_fn(|| rest.next_if(|record| record.is_of(condition))).collect(),
        ..empty(plan, condition, units)
    });
    curves.filter(|curve| !curve.records.is_empty()).collect()
}

/// The curve under a condition, without its cases.
fn empty<'a>(plan: &SweepPlan, condition: &Condition, units: &Units) -> Curve<'a> {
    let over = plan.axes.as_ref().map_or(&[][..], |axes| &axes.over);
    let parts: Vec<(Varied, String)> = (over.iter().zip(condition.values.all()))
        .map(|(varied, value)| {
            let value = units.varied_value(varied, *value);
            let words = match varied.is_whole() {
                true => value,
                false => format!("{} {value}", varied.name()),
            };
            (varied.clone(), words)
        })
        .collect();
    let words: Vec<&str> = parts.iter().map(|(_, words)| words.as_str()).collect();
    let label = (!words.is_empty()).then(|| words.join(", "));
    let sentences = parts.iter().map(|(varied, words)| {
        let of = match varied.block {
            Block::Drive => "Drive",
            Block::Indenter => "Indenter",
            Block::Layer => "Layer",
            Block::Material => "Material",
        };
        format!("{of}: {words}.")
    });
    let sentence = (!words.is_empty()).then(|| sentences.collect::<Vec<_>>().join(" "));
    Curve {
        condition: condition.clone(),
        label,
        sentence,
        records: Vec::new(),
    }
}

/// Columns that tell the cases of a sweep apart but for their frequency.
pub fn place_columns(axes: Option<&Axes>) -> Vec<String> {
    let own = axes.into_iter().flat_map(Axes::own_columns);
    let drive = ["drive_mean", "drive_amplitude"].map(str::to_owned);
    own.map(|(_, varied)| varied.column())
        .chain(drive)
        .collect()
}

/// Their cells: the varied numbers, mean and amplitude.
pub fn place_cells(axes: Option<&Axes>, varied: AxisValues, drive: [f64; 2]) -> Vec<Cell> {
    let own = axes.into_iter().flat_map(Axes::own_columns);
    let own = own.map(|(axis, of)| Cell::of_axis(of, varied.get(axis)));
    own.chain(drive.map(Cell::from)).collect()
}

/// The same of a case.
pub fn place_of(axes: Option<&Axes>, record: &CaseRecord) -> Vec<Cell> {
    let drive = [record.drive_mean, record.drive_amplitude];
    place_cells(axes, record.varied, drive)
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
