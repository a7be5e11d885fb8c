//! Two results of a sweep against each other: case by case, column by column, peak by peak.
//!
//! Cases are matched by drive and frequency; where one result was measured, by the nearest frequency within a hundredth. Two values are the same where they differ by at most `absolute` + `relative`
//! times the larger of them. Where two cases were solved on different steps or nodes, values that differ by no more than the
//! sum of their error bars count as the same too, and columns without bars are not judged; on the same steps and nodes, where
//! the errors are the same, bars excuse nothing, but differences within them are reported as such.

mod columns;
mod result;
mod source;
pub(in crate::report) mod text;

pub use result::{ComparisonError, SweepTable};
pub use source::{Opened, RunFacts, Source, computed};

use columns::Beside;

use crate::quantity::FrequencyUnit;
use crate::report::table::Cell;
use crate::sweep::plan::{AxisValue, AxisValues};
use crate::sweep::search::peak::Peak;

/// How much two values may differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerances {
    pub relative: f64,
    pub absolute: f64,
    /// Relative tolerances of single columns, which are then compared even where they otherwise would not be. That of the frequency
    /// is for the frequencies of the peaks.
    pub columns: Vec<(String, f64)>,
    /// Where given, the verdict is on the peaks, within this relative tolerance of frequency and loss, and on the columns that
    /// have a tolerance of their own.
    pub peaks: Option<f64>,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self {
            relative: 1e-6,
            absolute: 0.0,
            columns: Vec::new(),
            peaks: None,
        }
    }
}

impl Tolerances {
    /// The relative tolerance that a column has of its own.
    fn own(&self, column: &str) -> Option<f64> {
        let own = self.columns.iter().find(|(name, _)| name == column);
        own.map(|(_, relative)| *relative)
    }

    /// The tolerance that was asked for the frequencies of the peaks, in whichever words.
    fn of_peak_frequency(&self) -> Option<f64> {
        let columns = [FrequencyUnit::RadPerS, FrequencyUnit::Hz].map(FrequencyUnit::column);
        let own = || columns.iter().find_map(|column| self.own(column));
        self.peaks.or_else(own)
    }
}

/// Which case: what else axes vary, mean and amplitude of the drive, angular frequency (rad/s).
#[derive(Debug, Clone, Copy, Default, PartialEq, PartialOrd, serde::Serialize)]
pub struct Place {
    #[serde(skip_serializing_if = "AxisValues::is_empty")]
    pub varied: AxisValues,
    pub drive_mean: f64,
    pub drive_amplitude: f64,
    pub angular_frequency_rad_per_s: f64,
}

/// What the comparison found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Comparison {
    /// Cases in both results.
    pub compared: usize,
    /// Cases of the baseline that the new result lacks, and the other way round.
    pub missing: Vec<Place>,
    pub added: Vec<Place>,
    /// Columns that only the baseline has, and only the new result has.
    pub missing_columns: Vec<String>,
    pub added_columns: Vec<String>,
    /// Cases that ended differently: the statuses.
    pub statuses: Vec<(Place, String, String)>,
    pub columns: Vec<ColumnComparison>,
    pub peaks: Vec<PeakComparison>,
    /// Why no peak was compared, where none was.
    pub peaks_not_compared: Option<String>,
    /// The curves of the energy loss.
    pub curve: Vec<CurvePoint>,
    /// Whether one of the two was measured: then cases without a counterpart are no difference.
    pub measured: bool,
    /// What the blocks of lists are called whose places a case has, axis by axis; none of an axis over a number.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub names: Vec<Vec<String>>,
    /// In which the baseline has its frequencies first.
    #[serde(skip)]
    pub unit: FrequencyUnit,
    /// Whether a tolerance was asked for the peaks, and whether they alone decide.
    #[serde(skip)]
    wants_peaks: bool,
    #[serde(skip)]
    only_peaks: bool,
}

/// One column over all cases in both results.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
pub struct ColumnComparison {
    pub name: String,
    /// Largest difference relative to the larger value, and where; `None` where nothing differs.
    pub largest: Option<(f64, Place)>,
    /// Cases beyond the tolerance, and how many of these lie within the error bars.
    pub beyond: usize,
    pub within_bars: usize,
    /// Cases in which one of the two has no value.
    pub absent: usize,
    /// Cases beyond the tolerance that are not judged: they were solved on other steps or nodes, and the column has no error bars.
    pub not_judged: usize,
    /// Cases that count as different.
    pub different: usize,
    /// Whether the differences are absolute: of quantities that are ratios themselves.
    #[serde(skip)]
    pub is_absolute: bool,
    /// Whether the column has a tolerance of its own.
    #[serde(skip)]
    has_own_tolerance: bool,
    /// The values of every case of either result, in the order of [`Comparison::curve`].
    #[serde(skip)]
    pub baseline: Vec<Option<f64>>,
    #[serde(skip)]
    pub new: Vec<Option<f64>>,
    /// Sum of the two error bars, for columns that have them.
    #[serde(skip)]
    pub error: Vec<Option<f64>>,
}

/// A peak of the baseline and the nearest of the new result, or one that stands alone.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PeakComparison {
    pub baseline: Option<Peak>,
    pub new: Option<Peak>,
    pub differs: bool,
}

/// The loss of a case in both results.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct CurvePoint {
    pub place: Place,
    pub baseline_j: Option<f64>,
    pub new_j: Option<f64>,
    /// Sum of the two error bars.
    pub error_j: Option<f64>,
}

/// Ratio of frequencies beyond which two peaks are not the same one.
const SAME_PEAK: f64 = 1.3;

impl Comparison {
    /// Compares two results.
    ///
    /// # Errors
    /// [`ComparisonError`] where a cell is no number, or a column with a tolerance of its own does not exist.
    pub fn of(
        baseline: &SweepTable,
        new: &SweepTable,
        tolerances: &Tolerances,
    ) -> Result<Self, ComparisonError> {
        let beside = Beside::new(baseline, new);
        let (shared, single): (Vec<String>, Vec<String>) = (beside.compared_columns(tolerances)?)
            .into_iter()
            .partition(|name| baseline.has(name) && new.has(name));
        let (mut missing_columns, added_columns): (Vec<String>, Vec<String>) =
            single.into_iter().partition(|name| baseline.has(name));
        if beside.measured {
            // No loop tells which branch dissipates.
            missing_columns.clear();
        }
        let columns = shared.into_iter();
        let columns = columns.map(|name| beside.column(name, tolerances));
        let pairs =
            || (beside.cases.iter()).filter_map(|(place, [a, b])| Some((*place, (*a)?, (*b)?)));
        let statuses = pairs().map(|(place, a, b)| {
            let [a, b] = [baseline.text(a, "status"), new.text(b, "status")];
            (place, a.to_owned(), b.to_owned())
        });
        let has_names = new.names.iter().any(|names| !names.is_empty());
        let peaks = peaks(baseline, new, tolerances);
        Ok(Self {
            compared: pairs().count(),
            missing: beside.without(1),
            added: beside.without(0),
            missing_columns,
            added_columns,
            statuses: statuses.filter(|(_, a, b)| a != b).collect(),
            columns: columns.collect::<Result<_, _>>()?,
            peaks_not_compared: match &peaks {
                Ok(_) => None,
                Err(reason) => Some(reason.clone()),
            },
            peaks: peaks.unwrap_or_default(),
            curve: beside.curve()?,
            measured: beside.measured,
            names: new.names.iter().filter(|_| has_names).cloned().collect(),
            unit: baseline.unit(),
            wants_peaks: tolerances.of_peak_frequency().is_some(),
            only_peaks: tolerances.peaks.is_some(),
        })
    }

    /// What axes vary of a case: numbers in SI units, or the names of blocks.
    fn varied(&self, place: &Place) -> Vec<Cell> {
        let values = place.varied.all().iter().enumerate();
        let cell = |(axis, value): (usize, &AxisValue)| match value {
            AxisValue::Number(number) => Cell::from(*number),
            AxisValue::Block(place) => match self.names.get(axis).and_then(|all| all.get(*place)) {
                Some(name) => name.clone().into(),
                None => Cell::Absent,
            },
        };
        values.map(cell).collect()
    }

    /// Whether the results differ by more than the tolerances allow, or nothing was there to be compared. Columns that only the new
    /// result has do not count.
    pub fn differs(&self) -> bool {
        let is_judged = |column: &&ColumnComparison| !self.only_peaks || column.has_own_tolerance;
        let peaks = (self.wants_peaks && self.peaks_not_compared.is_some())
            || self.peaks.iter().any(|peak| peak.differs);
        let mut columns = self.columns.iter().filter(is_judged);
        peaks || columns.any(|column| column.different > 0) || !(self.only_peaks || self.is_whole())
    }

    /// The finding in one sentence.
    pub fn verdict(&self) -> &'static str {
        match self.differs() {
            true if self.wants_peaks && self.peaks_not_compared.is_some() => {
                "No peak was compared, though a tolerance for peaks was given."
            }
            true if self.compared == 0 => {
                "The results differ: nothing was compared, no case is in both."
            }
            true => "The results differ.",
            false if self.only_peaks => "The peaks are the same within the tolerances.",
            false => "The results are the same within the tolerances.",
        }
    }

    /// Whether there are cases in both results and none in one alone, with the same columns and statuses.
    fn is_whole(&self) -> bool {
        let none_alone = self.missing.is_empty() && self.added.is_empty();
        self.compared > 0
            && (self.measured || none_alone)
            && self.missing_columns.is_empty()
            && self.statuses.is_empty()
    }
}

/// Peaks of both, each matched with the nearest of the same drive; or why there are none to compare.
fn peaks(
    baseline: &SweepTable,
    new: &SweepTable,
    tolerances: &Tolerances,
) -> Result<Vec<PeakComparison>, String> {
    let (old, mut left) = (baseline.peaks()?, new.peaks()?.to_vec());
    if old.is_empty() && left.is_empty() {
        return Err("neither result has a peak".to_owned());
    }
    let distance = |a: &Peak, b: &Peak| {
        let ratio = a.angular_frequency_rad_per_s / b.angular_frequency_rad_per_s;
        ratio.ln().abs()
    };
    let drive = |p: &Peak| (p.varied, p.drive_mean, p.drive_amplitude);
    let mut found = Vec::new();
    for peak in old {
        let nearest = (0..left.len())
            .filter(|&i| drive(&left[i]) == drive(peak))
            .filter(|&i| distance(&left[i], peak) < SAME_PEAK.ln())
            .min_by(|&i, &j| distance(&left[i], peak).total_cmp(&distance(&left[j], peak)));
        let matched = nearest.map(|i| left.remove(i));
        found.push(PeakComparison {
            differs: matched.is_none_or(|new| peak_differs(peak, &new, tolerances)),
            baseline: Some(*peak),
            new: matched,
        });
    }
    found.extend(left.into_iter().map(|peak| PeakComparison {
        baseline: None,
        new: Some(peak),
        differs: true,
    }));
    Ok(found)
}

/// A peak is located no better than its uncertainty says, whatever the tolerance.
fn peak_differs(a: &Peak, b: &Peak, tolerances: &Tolerances) -> bool {
    let omegas = [a, b].map(|p| p.angular_frequency_rad_per_s);
    let located = [a, b].map(|p| p.angular_frequency_uncertainty_rad_per_s);
    let losses = [a, b].map(|p| p.energy_loss_j);
    let relative = tolerances.of_peak_frequency();
    let relative = relative.unwrap_or(tolerances.relative);
    let allowed = relative * omegas[0].max(omegas[1]) + located[0] + located[1];
    let relative = tolerances.own("energy_loss_j").or(tolerances.peaks);
    let relative = relative.unwrap_or(tolerances.relative);
    let bars_j = match a.energy_loss_error_j.zip(b.energy_loss_error_j) {
        // Equal bars are those of equal discretisations, whose errors are equal too.
        Some((a, b)) if (a - b).abs() > 1e-3 * a.max(b) => a + b,
        _ => 0.0,
    };
    let allowed_j = tolerances.absolute + relative * losses[0].abs().max(losses[1].abs()) + bars_j;
    (omegas[0] - omegas[1]).abs() > allowed || (losses[0] - losses[1]).abs() > allowed_j
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "angular_frequency_rad_per_s,drive_mean,drive_amplitude,energy_loss_j,energy_loss_error_j,harmonic_2,steps,nodes,status\n";

    fn table(rows: &[(f64, f64, usize)]) -> SweepTable {
        let rows: String = rows
            .iter()
            .map(|(omega, loss, steps)| {
                format!("{omega},10,5,{loss},1e-3,1e-9,{steps},400,converged\n")
            })
            .collect();
        SweepTable::parse("t.csv", format!("{HEAD}{rows}").as_bytes(), None).unwrap()
    }

    fn compare(a: &SweepTable, b: &SweepTable) -> Comparison {
        Comparison::of(a, b, &Tolerances::default()).unwrap()
    }

    #[test]
    fn a_result_is_the_same_as_itself_and_a_missing_case_is_named() {
        let all = table(&[(1.0, 2.0, 200), (2.0, 3.0, 200)]);
        assert!(!compare(&all, &all).differs());
        let one = table(&[(1.0, 2.0, 200)]);
        let found = compare(&all, &one);
        assert!(found.differs());
        assert_eq!(found.missing[0].angular_frequency_rad_per_s, 2.0);
        assert!(
            found.text().to_string().contains("missing"),
            "{}",
            found.text()
        );
        assert_eq!(compare(&one, &all).added.len(), 1);
    }

    #[test]
    fn bars_excuse_a_difference_between_discretisations_but_not_on_the_same_one() {
        let coarse = table(&[(1.0, 2.0, 200)]);
        let same = compare(&coarse, &table(&[(1.0, 2.0015, 200)]));
        assert!(same.differs());
        assert_eq!(
            (same.columns[0].beyond, same.columns[0].within_bars),
            (1, 1)
        );
        assert!(!compare(&coarse, &table(&[(1.0, 2.0015, 400)])).differs());
        assert!(compare(&coarse, &table(&[(1.0, 2.0025, 400)])).differs());
    }

    #[test]
    fn tolerances_may_be_given_for_a_column() {
        let (a, b) = (table(&[(1.0, 2.0, 200)]), table(&[(1.0, 2.001, 200)]));
        let with = |column: &str| Tolerances {
            columns: vec![(column.to_owned(), 1e-2)],
            ..Tolerances::default()
        };
        assert!(
            !Comparison::of(&a, &b, &with("energy_loss_j"))
                .unwrap()
                .differs()
        );
        assert!(Comparison::of(&a, &b, &with("steps")).unwrap().differs());
        assert!(Comparison::of(&a, &b, &with("energy")).is_err());
    }

    #[test]
    fn a_peak_that_moved_by_more_than_its_uncertainty_differs() {
        let with_peak = |omega: f64| {
            let summary = format!(
                "{{\"peaks\":[{{\"angular_frequency_rad_per_s\":{omega},\"energy_loss_j\":3.0,\
                 \"angular_frequency_uncertainty_rad_per_s\":1e-4,\"energy_loss_error_j\":null}}]}}"
            );
            let rows = format!("{HEAD}1,10,5,2,1e-3,0,200,400,converged\n");
            SweepTable::parse("t.csv", rows.as_bytes(), Some(summary.as_bytes())).unwrap()
        };
        assert!(!compare(&with_peak(1.0), &with_peak(1.000_15)).differs());
        assert!(compare(&with_peak(1.0), &with_peak(1.003)).differs());
        let far = compare(&with_peak(1.0), &with_peak(2.0));
        assert_eq!(far.peaks.len(), 2);
        assert!(far.peaks.iter().all(|peak| peak.differs));
    }

    #[test]
    fn a_value_that_is_gone_differs_and_nonsense_is_refused_with_its_line() {
        let a = table(&[(1.0, 2.0, 200)]);
        let row = format!("{HEAD}1,10,5,,,0,200,400,converged\n");
        let gone = SweepTable::parse("t.csv", row.as_bytes(), None).unwrap();
        let found = compare(&a, &gone);
        assert_eq!((found.columns[0].absent, found.differs()), (1, true));
        let row = format!("{HEAD}1,10,5,many,,0,200,400,converged\n");
        let nonsense = SweepTable::parse("t.csv", row.as_bytes(), None).unwrap();
        let error = Comparison::of(&a, &nonsense, &Tolerances::default()).unwrap_err();
        assert!(error.to_string().contains("line 2") && error.to_string().contains("many"));
    }
}
