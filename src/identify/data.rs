//! Measured numbers of cycles, and what makes them useless.

use crate::drive::HarmonicDrive;
use crate::identify::{IdentifyError, column};
use crate::sweep::record::error_bars::Quantity;

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
    /// Place among the cycles.
    pub cycle: usize,
    pub quantity: Quantity,
    /// In SI units.
    pub value: f64,
    /// Standard deviation, where it is known.
    pub error: Option<f64>,
}

/// All that was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurements {
    cycles: Vec<MeasuredCycle>,
    data: Vec<Datum>,
    /// What was left out, and why.
    notes: Vec<String>,
}

/// Errors below this part of a value are raised to it: the forward model itself is no better.
pub const LEAST_ERROR: f64 = 1e-3;

/// A column that varies by less than this over all frequencies is flat, whatever its errors.
const LEAST_SPREAD: f64 = 0.01;

impl Measurements {
    /// Measured numbers; those that a measurement cannot tell from nothing are left out, which the notes say.
    ///
    /// # Errors
    /// [`IdentifyError`]: numbers that no solid can have, all at one frequency, or none that varies.
    pub fn new(cycles: Vec<MeasuredCycle>, all: Vec<Datum>) -> Result<Self, IdentifyError> {
        let mut data = Vec::with_capacity(all.len());
        let mut notes = Vec::new();
        for datum in all {
            let row = cycles.get(datum.cycle).map_or(0, |cycle| cycle.row);
            match usable(&datum, row)? {
                None => data.push(datum),
                Some(why) => notes.push(format!(
                    "row {row}: {} left out, {why}",
                    column(datum.quantity)
                )),
            }
        }
        let measured = Self {
            cycles,
            data,
            notes,
        };
        measured.check()?;
        Ok(measured)
    }

    /// What is no measurement but a list of what is to be computed.
    pub(super) fn unchecked(cycles: Vec<MeasuredCycle>, data: Vec<Datum>) -> Self {
        Self {
            cycles,
            data,
            notes: Vec::new(),
        }
    }

    pub fn cycles(&self) -> &[MeasuredCycle] {
        &self.cycles
    }

    pub fn data(&self) -> &[Datum] {
        &self.data
    }

    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The quantities measured, in the order of the table.
    pub fn quantities(&self) -> Vec<Quantity> {
        let measured = |q: &Quantity| self.data.iter().any(|datum| datum.quantity == *q);
        Quantity::ALL.into_iter().filter(measured).collect()
    }

    /// Whether some numbers come with errors, and whether some come without.
    pub fn errors(&self) -> (bool, bool) {
        let with = self.data.iter().any(|datum| datum.error.is_some());
        let without = self.data.iter().any(|datum| datum.error.is_none());
        (with, without)
    }

    /// The angular frequency (rad/s) of a datum.
    pub fn angular_frequency(&self, datum: &Datum) -> f64 {
        self.cycles
            .get(datum.cycle)
            .map_or(f64::NAN, |cycle| cycle.angular_frequency_rad_per_s)
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
        let (lowest, highest) = self.window_rad_per_s();
        if highest <= lowest * (1.0 + 1e-9) {
            return Err(IdentifyError::OneFrequency);
        }
        let spreads: Vec<(f64, f64)> = self
            .quantities()
            .into_iter()
            .map(|q| self.spread(q))
            .collect();
        let varies = |(spread, error): &(f64, f64)| *spread > LEAST_SPREAD.max(4.0 * error);
        if spreads.iter().any(varies) {
            return Ok(());
        }
        let largest = spreads
            .iter()
            .fold(0.0_f64, |a, (spread, _)| a.max(*spread));
        Err(IdentifyError::Flat {
            spread_percent: format!("{:.2}", 100.0 * largest.exp_m1()),
        })
    }

    /// By how much a column varies under one drive, and its mean error; both relative.
    fn spread(&self, quantity: Quantity) -> (f64, f64) {
        let of = |datum: &&Datum| datum.quantity == quantity;
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
            column: column(datum.quantity),
            row,
            value: datum.value,
            why,
        })
    };
    let error = datum.error.unwrap_or(0.0);
    if datum.value.is_finite() && datum.value > 0.0 {
        let too_late = datum.quantity == Quantity::PhaseLag
            && datum.value - 3.0 * error >= std::f64::consts::FRAC_PI_2;
        if too_late {
            return refused(
                "a solid lags by less than a quarter of a cycle, pi/2; is the column in degrees?",
            );
        }
        return Ok((error >= datum.value).then_some("its error is as large as itself"));
    }
    match datum.quantity {
        Quantity::EnergyLoss | Quantity::PhaseLag | Quantity::LossModulus
            if datum.value + 3.0 * error < 0.0 || (datum.error.is_none() && datum.value < 0.0) =>
        {
            refused(
                "a passive material dissipates, and its approach lags behind the load; exchange the sign, or leave the cell empty \
                 where it was not measured",
            )
        }
        Quantity::StorageModulus => refused("a modulus is positive"),
        _ => Ok(Some("it is not above zero")),
    }
}
