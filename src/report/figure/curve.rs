//! The cases of a sweep as curves over frequency: one, or one per value of a second axis; and which of many are shown.

use super::units::Units;
use crate::report::ReportError;
use crate::report::table::{Cell, csv_leading};
use crate::sweep::plan::{Axes, AxisValues, Block, Condition, SweepPlan};
use crate::sweep::record::{CaseRecord, CaseResult};
use crate::sweep::search::peak::Peak;
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
    let over = plan.axes.as_ref().map_or(&[][..], |axes| &axes.over);
    // Records stand curve after curve, in the order of the conditions.
    let mut rest = outcome.records.iter().peekable();
    let conditions = plan.conditions();
    let curves = conditions.iter().map(|condition| {
        let (mut words, mut sentences) = (Vec::new(), Vec::new());
        for (varied, value) in over.iter().zip(condition.values.all()) {
            let value = units.varied_value(varied, *value);
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
            sentences.push(format!("{of}: {said}."));
            words.push(said);
        }
        Curve {
            label: (!words.is_empty()).then(|| words.join(", ")),
            sentence: (!words.is_empty()).then(|| sentences.join(" ")),
            records: std::iter::from_fn(|| rest.next_if(|record| record.is_of(condition)))
                .collect(),
            condition: condition.clone(),
        }
    });
    curves.filter(|curve| !curve.records.is_empty()).collect()
}

/// A sweep as its figures show it.
pub struct SweepCurves<'a> {
    pub plan: &'a SweepPlan,
    pub outcome: &'a Outcome,
    pub units: Units,
    pub curves: Vec<Curve<'a>>,
}

impl<'a> SweepCurves<'a> {
    /// The curves in the units that the sweep asks for.
    ///
    /// # Errors
    /// [`ReportError::Scale`] where normalised axes are asked for and there is nothing to normalise by.
    pub fn of(plan: &'a SweepPlan, outcome: &'a Outcome) -> Result<Self, ReportError> {
        let units = Units::of_sweep(plan)?;
        Ok(Self {
            curves: curves(plan, outcome, &units),
            plan,
            outcome,
            units,
        })
    }

    /// All cases, curve by curve.
    pub fn records(&self) -> impl Iterator<Item = &'a CaseRecord> {
        self.curves.iter().flat_map(|curve| &curve.records).copied()
    }

    /// The values of the second axis, one for each curve.
    pub fn values(&self) -> impl DoubleEndedIterator<Item = f64> {
        let curves = self.curves.iter();
        curves.filter_map(|curve| curve.condition.number())
    }

    /// A table of cases or peaks: these columns, then where they are in the sweep, then these numbers.
    pub fn table<R: IntoIterator<Item = Cell>>(
        &self,
        first: &[&str],
        numbers: &[&str],
        rows: impl IntoIterator<Item = (Vec<Cell>, R)>,
    ) -> Vec<u8> {
        let own = self.plan.axes.iter().flat_map(Axes::own_columns);
        let own: Vec<String> = own.map(|(_, varied)| varied.column()).collect();
        let place = own.iter().map(String::as_str);
        let place = place.chain(["drive_mean", "drive_amplitude"]);
        let columns = first.iter().copied().chain(place);
        let columns: Vec<&str> = columns.chain(numbers.iter().copied()).collect();
        let rows = rows.into_iter().map(|(mut row, numbers)| {
            row.extend(numbers);
            row
        });
        csv_leading(self.units.frequency_unit(), &columns, rows)
    }

    /// Where a case is in the sweep, as the cells of a table: the varied numbers, mean and amplitude.
    pub fn place_of(&self, record: &CaseRecord) -> Vec<Cell> {
        self.place(record.varied, [record.drive_mean, record.drive_amplitude])
    }

    /// The same of a peak.
    pub fn place_of_peak(&self, peak: &Peak) -> Vec<Cell> {
        let drive = &self.plan.base.drive;
        let mean = peak.drive_mean.unwrap_or(drive.mean());
        let amplitude = peak.drive_amplitude.unwrap_or(drive.amplitude());
        self.place(peak.varied, [mean, amplitude])
    }

    fn place(&self, varied: AxisValues, drive: [f64; 2]) -> Vec<Cell> {
        let own = self.plan.axes.iter().flat_map(Axes::own_columns);
        let own = own.map(|(axis, of)| Cell::of_axis(of, varied.get(axis)));
        own.chain(drive.map(Cell::from)).collect()
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
