//! Measured numbers of cycles or of a history, and what makes them useless.

use crate::drive::{Control, HarmonicDrive, SegmentedDrive};
use crate::identify::IdentifyError;
use crate::measured::Quantity as OfLoop;
use crate::quantity::Dimension::{Angle, Energy, Force, Length, Stress};
use crate::quantity::{Dimension, format_human};
use crate::sweep::record::CaseResult;
use crate::sweep::record::error_bars::Quantity;

/// What is known of a number that can be measured.
#[derive(Debug)]
struct NumberRow {
    column: &'static str,
    dimension: Dimension,
    /// Its value in a computed cycle; none of a number of a history.
    value: fn(&CaseResult) -> Option<f64>,
    /// Whether it goes with the moduli under a prescribed approach, as all loads do.
    is_load: bool,
}

macro_rules! numbers {
    (
        of_case { $($case:ident: $case_dimension:ident, is_load: $case_is_load:literal;)* }
        others {
            $($(#[$means:meta])* $other:ident: $dimension:ident, is_load: $is_load:literal, $column:expr, $value:expr;)*
        }
    ) => {
        /// What can be measured, and a material be identified from.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Number {
            $($case,)*
            $($(#[$means])* $other,)*
        }

        impl Number {
            /// All of them, in the order of the tables.
            const ALL: [Self; ROWS.len()] = [$(Self::$case,)* $(Self::$other),*];
        }

        static ROWS: [NumberRow; [$(stringify!($case),)* $(stringify!($other)),*].len()] = [
            $(NumberRow {
                column: Quantity::$case.column(),
                dimension: $case_dimension,
                value: |cycle| Quantity::$case.of(cycle),
                is_load: $case_is_load,
            },)*
            $(NumberRow {
                column: $column,
                dimension: $dimension,
                value: $value,
                is_load: $is_load,
            },)*
        ];
    };
}

#[rustfmt::skip]
numbers! {
    of_case {
        EnergyLoss: Energy, is_load: true;
        PhaseLag: Angle, is_load: false;
        StorageModulus: Stress, is_load: true;
        LossModulus: Stress, is_load: true;
        ApproachMin: Length, is_load: false;
        ApproachMax: Length, is_load: false;
        ContactRadiusMin: Length, is_load: false;
        ContactRadiusMax: Length, is_load: false;
        PeakPressureMin: Stress, is_load: true;
        PeakPressureMax: Stress, is_load: true;
    }
    others {
        /// Of the first harmonic of a cycle.
        ApproachAmplitude: Length, is_load: false, OfLoop::ApproachAmplitude.column(),
            |cycle| Some(cycle.analysis.harmonics.first()?.approach_amplitude_m);
        /// Of the first harmonic of a cycle.
        LoadAmplitude: Force, is_load: true, OfLoop::LoadAmplitude.column(),
            |cycle| Some(cycle.analysis.harmonics.first()?.load_amplitude_n);
        /// At an instant of a history.
        Approach: Length, is_load: false, "approach_m", |_| None;
        /// At an instant of a history.
        Load: Force, is_load: true, "load_n", |_| None;
    }
}

impl Number {
    const fn row(self) -> &'static NumberRow {
        &ROWS[self as usize]
    }

    /// Its column, as in `sweep.csv`, `cycles.csv` or `history.csv`.
    pub const fn column(self) -> &'static str {
        self.row().column
    }

    pub const fn dimension(self) -> Dimension {
        self.row().dimension
    }

    /// Its value in a computed cycle, where it has one.
    pub fn of(self, cycle: &CaseResult) -> Option<f64> {
        (self.row().value)(cycle)
    }

    /// Whether it goes with the moduli under a prescribed approach.
    pub(super) fn is_load(self) -> bool {
        self.row().is_load
    }
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

/// One number of a cycle, or of an instant of a history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    /// Angular frequency (rad/s) of the cycle, or time (s) of the instant.
    pub place: f64,
    /// The drive that the cycle was measured under; `None` of an instant, whose history has one.
    pub drive: Option<HarmonicDrive>,
    /// The row of the table, from 1 below the header; of an instant the first of its rows.
    pub row: usize,
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

impl Datum {
    /// The angular frequency (rad/s) that it speaks of: that of its cycle, or one over its time.
    pub fn angular_frequency(&self) -> f64 {
        match self.drive {
            Some(_) => self.place,
            None => 1.0 / self.place,
        }
    }

    /// The time (s) that it speaks of: of its instant, or one over the angular frequency of its cycle.
    pub fn time_s(&self) -> f64 {
        match self.drive {
            Some(_) => 1.0 / self.place,
            None => self.place,
        }
    }

    /// Where it is, for messages: "3 rad/s" or "20 s".
    pub fn place_in_words(&self) -> String {
        let dimension = match self.drive {
            Some(_) => Dimension::AngularFrequency,
            None => Dimension::Time,
        };
        format_human(self.place, dimension, 4)
    }

    /// That the model has no such number.
    pub(super) fn undefined(&self) -> IdentifyError {
        IdentifyError::Undefined {
            place: self.place_in_words(),
            column: self.number.column(),
        }
    }
}

impl Measurements {
    /// Measured numbers of cycles, those of one cycle one after another; those that a measurement cannot tell from nothing are left out, which the notes say.
    ///
    /// # Errors
    /// [`IdentifyError`]: numbers that no solid can have, all at one frequency, or none that varies.
    pub fn new(all: Vec<Datum>) -> Result<Self, IdentifyError> {
        let mut measured = Self::unchecked(Vec::new());
        for datum in all {
            match usable(&datum)? {
                None => measured.data.push(datum),
                Some(why) => measured.notes.push(format!(
                    "row {}: {} left out, {why}",
                    datum.row,
                    datum.number.column()
                )),
            }
        }
        measured.check()?;
        Ok(measured)
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
        let mut data = Vec::new();
        // An instant at first touch says nothing: whatever the body is, nothing has happened yet.
        let rows: Vec<&Reading> = rows.iter().filter(|row| row.time_s > 0.0).collect();
        for same in rows.chunk_by(|a, b| instant_of(a) == instant_of(b)) {
            let count = same.len() as f64;
            let mean =
                |value: fn(&Reading) -> f64| same.iter().map(|row| value(row)).sum::<f64>() / count;
            let squares: Option<f64> = same.iter().map(|row| row.error.map(|e| e * e)).sum();
            data.push(Datum {
                place: mean(|row| row.time_s),
                drive: None,
                row: same.first().map_or(0, |row| row.row),
                number,
                value: mean(|row| row.value),
                error: squares.map(|squares| squares.sqrt() / count),
            });
        }
        let (read, kept) = (rows.len(), data.len());
        let averaged =
            (kept < read).then(|| format!("{read} rows are averaged to {kept} instants"));
        let mut measured = Self::new(data)?;
        measured.notes.splice(0..0, averaged);
        Ok(measured)
    }

    /// What is no measurement but a list of what is to be computed.
    pub(super) fn unchecked(data: Vec<Datum>) -> Self {
        Self {
            data,
            notes: Vec::new(),
        }
    }

    /// Whether the numbers are those of a history.
    pub fn is_history(&self) -> bool {
        self.data.iter().any(|datum| datum.drive.is_none())
    }

    /// The numbers of every cycle, or of every instant.
    pub fn places(&self) -> impl Iterator<Item = &[Datum]> {
        self.data.chunk_by(|a, b| a.row == b.row)
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
        Number::ALL.into_iter().filter(measured).collect()
    }

    /// Lowest and highest angular frequency (rad/s).
    pub fn window_rad_per_s(&self) -> (f64, f64) {
        let omegas = self.data.iter().map(Datum::angular_frequency);
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
        let is_outside = |datum: &&Datum| !(low..=high).contains(&datum.angular_frequency());
        if let Some(datum) = self.data.iter().find(is_outside) {
            let (what, unit) = match self.is_history() {
                true => ("time", "s"),
                false => ("angular frequency", "rad/s"),
            };
            return Err(IdentifyError::OutOfRange {
                row: datum.row,
                what,
                value: datum.place,
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
fn usable(datum: &Datum) -> Result<Option<&'static str>, IdentifyError> {
    let refused = |why| {
        Err(IdentifyError::Impossible {
            column: datum.number.column(),
            row: datum.row,
            value: datum.value,
            why,
        })
    };
    let error = datum.error.unwrap_or(0.0);
    if datum.value.is_finite() && datum.value > 0.0 {
        let too_late = datum.number == Number::PhaseLag
            && datum.value - 3.0 * error >= std::f64::consts::FRAC_PI_2;
        if too_late {
            return refused(
                "a solid lags by less than a quarter of a cycle, pi/2; is the column in degrees?",
            );
        }
        return Ok((error >= datum.value).then_some("its error is as large as itself"));
    }
    let is_negative =
        datum.value + 3.0 * error < 0.0 || (datum.error.is_none() && datum.value < 0.0);
    match datum.number {
        Number::EnergyLoss | Number::PhaseLag | Number::LossModulus if is_negative => refused(
            "a passive material dissipates, and its approach lags behind the load; exchange the sign, or leave the cell empty \
             where it was not measured",
        ),
        Number::StorageModulus => refused("a modulus is positive"),
        Number::EnergyLoss
        | Number::PhaseLag
        | Number::LossModulus
        | Number::ApproachMin
        | Number::ApproachMax
        | Number::ContactRadiusMin
        | Number::ContactRadiusMax
        | Number::PeakPressureMin
        | Number::PeakPressureMax
        | Number::ApproachAmplitude
        | Number::LoadAmplitude
        | Number::Approach
        | Number::Load => Ok(Some("it is not above zero")),
    }
}
