//! Measured numbers of cycles or of a history, and what makes them useless.

use crate::drive::{Control, HarmonicDrive, SegmentedDrive};
use crate::identify::{IdentifyError, column};
use crate::quantity::{Dimension, format_human};
use crate::sweep::record::error_bars::Quantity;

/// What was measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    /// Of a stabilised cycle.
    OfCycle(Quantity),
    /// Amplitude of the first harmonic of a cycle, of the approach (m) or of the load (N).
    ApproachAmplitude,
    LoadAmplitude,
    /// At an instant of a history.
    Approach,
    Load,
}

impl Number {
    /// Its column, as in `sweep.csv` or `history.csv`.
    pub fn column(self) -> &'static str {
        match self {
            Self::OfCycle(quantity) => column(quantity),
            Self::ApproachAmplitude => "approach_amplitude_m",
            Self::LoadAmplitude => "load_amplitude_n",
            Self::Approach => "approach_m",
            Self::Load => "load_n",
        }
    }
}

/// One instant of a measured history: the mean of the rows about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    pub time_s: f64,
    /// The first of its rows, from 1.
    pub row: usize,
}

/// One row of a measured history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// From 1.
    pub row: usize,
    /// Since first touch.
    pub time_s: f64,
    /// Approach (m) or load (N), whichever was not prescribed.
    pub value: f64,
    /// Standard deviation, where it is known.
    pub error: Option<f64>,
}

/// Rows of a history that follow one another within this part of the time since the drive's last joint are one instant, their mean:
/// what an instrument takes a thousand times a second says no more about a time of minutes.
const ONE_INSTANT: f64 = 0.05;

/// One measured cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredCycle {
    pub angular_frequency_rad_per_s: f64,
    /// The drive it was measured under.
    pub drive: HarmonicDrive,
    /// The row of the table, from 1.
    pub row: usize,
}

/// One number of a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    /// Which of the cycles, or of the instants.
    pub place: usize,
    pub number: Number,
    /// In SI units.
    pub value: f64,
    /// Standard deviation, where it is known.
    pub error: Option<f64>,
}

/// What became of the columns of a table, by their headings.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TableColumns {
    /// Those that hold frequencies, times, drives, data and errors.
    pub read: Vec<String>,
    /// Quantities that are no data beside those that were read, and why.
    pub set_aside: Vec<(String, &'static str)>,
    /// All others.
    pub unread: Vec<String>,
    /// Rows of a history that were passed over, since a number is missing.
    pub rows_passed_over: usize,
}

/// All that was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurements {
    /// What the numbers belong to: cycles, or instants of a history.
    cycles: Vec<MeasuredCycle>,
    instants: Vec<Instant>,
    data: Vec<Datum>,
    /// What was left out, and why.
    notes: Vec<String>,
}

/// Errors below this part of a value are raised to it: the forward model itself is no better.
pub const LEAST_ERROR: f64 = 1e-3;

/// Angular frequencies (rad/s), or one over times (1/s), of measurements: thirty decades, over which times of branches are tried.
const RANGE_PER_S: (f64, f64) = (1e-15, 1e15);

/// A column that varies by less than this over all frequencies is flat, whatever its errors.
const LEAST_SPREAD: f64 = 0.01;

impl Measurements {
    /// Measured numbers; those that a measurement cannot tell from nothing are left out, which the notes say.
    ///
    /// # Errors
    /// [`IdentifyError`]: numbers that no solid can have, all at one frequency, or none that varies.
    pub fn new(cycles: Vec<MeasuredCycle>, all: Vec<Datum>) -> Result<Self, IdentifyError> {
        Self::checked(cycles, Vec::new(), all)
    }

    /// The same of one history under a drive, from its rows in the order of time. Rows that are one instant are averaged, which the
    /// notes say.
    ///
    /// # Errors
    /// As [`Measurements::new`].
    pub fn of_history(drive: &SegmentedDrive, rows: &[Reading]) -> Result<Self, IdentifyError> {
        let number = match drive.control() {
            Control::Load => Number::Approach,
            Control::Approach => Number::Load,
        };
        let joints: Vec<f64> = drive.joints().iter().map(|joint| joint.time_s).collect();
        let instant_of = |row: &Reading| {
            let joint = joints.partition_point(|joint| *joint <= row.time_s);
            let since_s = row.time_s - joints.get(joint.saturating_sub(1)).unwrap_or(&0.0);
            // At the joint itself nothing is later.
            (
                joint,
                (since_s.max(f64::MIN_POSITIVE).ln() / ONE_INSTANT.ln_1p()).floor(),
            )
        };
        let (mut instants, mut data) = (Vec::new(), Vec::new());
        // An instant at first touch says nothing: whatever the body is, nothing has happened yet.
        let rows: Vec<&Reading> = rows.iter().filter(|row| row.time_s > 0.0).collect();
        for same in rows.chunk_by(|a, b| instant_of(a) == instant_of(b)) {
            let count = same.len() as f64;
            let mean =
                |value: fn(&Reading) -> f64| same.iter().map(|row| value(row)).sum::<f64>() / count;
            let squares: Option<f64> = same.iter().map(|row| row.error.map(|e| e * e)).sum();
            data.push(Datum {
                place: instants.len(),
                number,
                value: mean(|row| row.value),
                error: squares.map(|squares| squares.sqrt() / count),
            });
            instants.push(Instant {
                time_s: mean(|row| row.time_s),
                row: same.first().map_or(0, |row| row.row),
            });
        }
        let (read, kept) = (rows.len(), instants.len());
        let averaged =
            (kept < read).then(|| format!("{read} rows are averaged to {kept} instants"));
        let mut measured = Self::checked(Vec::new(), instants, data)?;
        measured.notes.splice(0..0, averaged);
        Ok(measured)
    }

    fn checked(
        cycles: Vec<MeasuredCycle>,
        instants: Vec<Instant>,
        all: Vec<Datum>,
    ) -> Result<Self, IdentifyError> {
        let mut measured = Self {
            cycles,
            instants,
            ..Self::unchecked(Vec::new(), Vec::new())
        };
        for datum in all {
            let row = measured.row_of(&datum);
            match usable(&datum, row)? {
                None => measured.data.push(datum),
                Some(why) => measured.notes.push(format!(
                    "row {row}: {} left out, {why}",
                    datum.number.column()
                )),
            }
        }
        measured.check()?;
        Ok(measured)
    }

    /// What is no measurement but a list of what is to be computed.
    pub(super) fn unchecked(cycles: Vec<MeasuredCycle>, data: Vec<Datum>) -> Self {
        Self {
            cycles,
            instants: Vec::new(),
            data,
            notes: Vec::new(),
        }
    }

    /// The cycles; none of a history.
    pub fn cycles(&self) -> &[MeasuredCycle] {
        &self.cycles
    }

    /// Whether the numbers are those of a history.
    pub fn is_history(&self) -> bool {
        !self.instants.is_empty()
    }

    /// How many cycles or instants there are.
    pub fn places(&self) -> usize {
        self.cycles.len() + self.instants.len()
    }

    pub fn data(&self) -> &[Datum] {
        &self.data
    }

    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// What was measured, in the order of the table.
    pub fn numbers(&self) -> Vec<Number> {
        let measured = |n: &Number| self.data.iter().any(|datum| datum.number == *n);
        let of_cycle = Quantity::ALL.into_iter().map(Number::OfCycle);
        let all = of_cycle.chain([
            Number::ApproachAmplitude,
            Number::LoadAmplitude,
            Number::Approach,
            Number::Load,
        ]);
        all.filter(measured).collect()
    }

    /// The angular frequency (rad/s) of a datum's cycle, or the time (s) of its instant.
    pub(super) fn place_of(&self, datum: &Datum) -> f64 {
        let cycle = self.cycles.get(datum.place);
        let instant = self.instants.get(datum.place);
        cycle
            .map(|cycle| cycle.angular_frequency_rad_per_s)
            .or(instant.map(|instant| instant.time_s))
            .unwrap_or(f64::NAN)
    }

    /// The row of a datum in the table, from 1 below the header; of a history the first of the rows that are one instant.
    pub fn row_of(&self, datum: &Datum) -> usize {
        let of_cycle = self.cycles.get(datum.place).map(|cycle| cycle.row);
        let of_instant = self.instants.get(datum.place).map(|instant| instant.row);
        of_cycle.or(of_instant).unwrap_or(0)
    }

    /// The angular frequency (rad/s) that a datum speaks of: that of its cycle, or one over its time.
    pub fn angular_frequency(&self, datum: &Datum) -> f64 {
        match self.is_history() {
            true => 1.0 / self.place_of(datum),
            false => self.place_of(datum),
        }
    }

    /// The time (s) of a datum: of its instant, or one over the angular frequency of its cycle.
    pub fn time_s(&self, datum: &Datum) -> f64 {
        match self.is_history() {
            true => self.place_of(datum),
            false => 1.0 / self.place_of(datum),
        }
    }

    /// Where a datum is, for messages: "3 rad/s" or "20 s".
    pub fn place_in_words(&self, datum: &Datum) -> String {
        let dimension = match self.is_history() {
            true => Dimension::Time,
            false => Dimension::AngularFrequency,
        };
        format_human(self.place_of(datum), dimension, 4)
    }

    /// That the model has no such number.
    pub(super) fn undefined(&self, datum: &Datum) -> IdentifyError {
        IdentifyError::Undefined {
            place: self.place_in_words(datum),
            column: datum.number.column(),
        }
    }

    /// Lowest and highest angular frequency (rad/s).
    pub fn window_rad_per_s(&self) -> (f64, f64) {
        let omegas = self.data.iter().map(|datum| self.angular_frequency(datum));
        omegas.fold((f64::INFINITY, 0.0), |(low, high), omega| {
            (low.min(omega), high.max(omega))
        })
    }

    fn check(&self) -> Result<(), IdentifyError> {
        if self.data.is_empty() {
            return Err(IdentifyError::TooFew {
                numbers: 0,
                branches: 1,
                needed: 4,
            });
        }
        let (low, high) = RANGE_PER_S;
        let is_outside = |datum: &&Datum| !(low..=high).contains(&self.angular_frequency(datum));
        if let Some(datum) = self.data.iter().find(is_outside) {
            let (what, unit) = match self.is_history() {
                true => ("time", "s"),
                false => ("angular frequency", "rad/s"),
            };
            let (row, value) = (self.row_of(datum), self.place_of(datum));
            return Err(IdentifyError::OutOfRange {
                row,
                what,
                value,
                low,
                high,
                unit,
            });
        }
        let (lowest, highest) = self.window_rad_per_s();
        if highest <= lowest * (1.0 + 1e-9) {
            return Err(match self.is_history() {
                true => IdentifyError::OneInstant,
                false => IdentifyError::OneFrequency,
            });
        }
        let mut largest = 0.0_f64;
        for number in self.numbers() {
            let (spread, error) = self.spread(number);
            if spread > LEAST_SPREAD.max(4.0 * error) {
                return Ok(());
            }
            largest = largest.max(spread);
        }
        Err(IdentifyError::Flat {
            spread_percent: format!("{:.2}", 100.0 * largest.exp_m1()),
        })
    }

    /// By how much a column varies under one drive, and its mean error; both relative.
    fn spread(&self, number: Number) -> (f64, f64) {
        let of = |datum: &&Datum| datum.number == number;
        let values = self.data.iter().filter(of).map(|datum| datum.value.ln());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), ln| {
            (low.min(ln), high.max(ln))
        });
        let errors = self.data.iter().filter(of);
        let errors = errors.filter_map(|datum| Some(datum.error? / datum.value));
        let (sum, count) = errors.fold((0.0, 0.0), |(sum, count), e| (sum + e, count + 1.0));
        (high - low, if count > 0.0 { sum / count } else { 0.0 })
    }
}

/// Why a number is left out; `None` where it is of use.
fn usable(datum: &Datum, row: usize) -> Result<Option<&'static str>, IdentifyError> {
    let refused = |why| {
        Err(IdentifyError::Impossible {
            column: datum.number.column(),
            row,
            value: datum.value,
            why,
        })
    };
    let error = datum.error.unwrap_or(0.0);
    if datum.value.is_finite() && datum.value > 0.0 {
        let too_late = datum.number == Number::OfCycle(Quantity::PhaseLag)
            && datum.value - 3.0 * error >= std::f64::consts::FRAC_PI_2;
        if too_late {
            return refused(
                "a solid lags by less than a quarter of a cycle, pi/2; is the column in degrees?",
            );
        }
        return Ok((error >= datum.value).then_some("its error is as large as itself"));
    }
    match datum.number {
        Number::OfCycle(Quantity::EnergyLoss | Quantity::PhaseLag | Quantity::LossModulus)
            if datum.value + 3.0 * error < 0.0 || (datum.error.is_none() && datum.value < 0.0) =>
        {
            refused(
                "a passive material dissipates, and its approach lags behind the load; exchange the sign, or leave the cell empty \
                 where it was not measured",
            )
        }
        Number::OfCycle(Quantity::StorageModulus) => refused("a modulus is positive"),
        _ => Ok(Some("it is not above zero")),
    }
}
