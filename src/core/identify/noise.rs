//! How exactly every number was measured: as the data say, or as the residuals do.

use crate::identify::data::{LEAST_ERROR, Measurements, Number};

/// The relative error of a number whose error is not known, until the residuals say better.
const FIRST: f64 = 0.01;

/// A column's noise is estimated on its own from this number of values and of degrees of freedom on.
const FEWEST_VALUES: usize = 6;
const FEWEST_FREE: usize = 5;

/// How far the noise of columns may differ: a column that is met by chance is not exact.
const LARGEST_RATIO: f64 = 10.0;

/// Columns whose noise differs by less than this factor have the same: a dozen residuals tell no more.
const SAME: f64 = 2.0;

/// What is known of the errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Knowledge {
    /// Every number has one.
    All,
    /// Some have.
    Some,
    /// None has one: they are what the residuals leave.
    None,
}

/// Relative standard deviations of the data.
#[derive(Debug, Clone)]
pub(super) struct Noise {
    pub(super) relative: Vec<f64>,
    pub(super) knowledge: Knowledge,
}

impl Noise {
    pub(super) fn new(measured: &Measurements) -> Self {
        let relative = measured.data().iter().map(|datum| match datum.error {
            Some(error) => (error / datum.value).max(LEAST_ERROR),
            None => FIRST,
        });
        let data = measured.data().iter();
        let known = data.filter(|datum| datum.error.is_some()).count();
        Self {
            relative: relative.collect(),
            knowledge: match known {
                0 => Knowledge::None,
                all if all == measured.data().len() => Knowledge::All,
                _ => Knowledge::Some,
            },
        }
    }

    /// The noise of columns without errors from relative residuals of a fit with this number of unknowns.
    pub(super) fn estimate(&mut self, measured: &Measurements, relative: &[f64], unknowns: usize) {
        let numbers = relative.len();
        if self.knowledge == Knowledge::All || numbers < unknowns + FEWEST_FREE {
            return;
        }
        let free = 1.0 - unknowns as f64 / numbers as f64;
        let of_data = |which: &dyn Fn(Number) -> bool| {
            let data = measured.data().iter().zip(relative);
            let own = data.filter(|(datum, _)| datum.error.is_none() && which(datum.number));
            let (count, squares) =
                own.fold((0, 0.0), |(count, sum), (_, r)| (count + 1, sum + r * r));
            (count, (squares / (free * f64::from(count.max(1)))).sqrt())
        };
        let (_, common) = of_data(&|_| true);
        for number in measured.numbers() {
            let (count, own) = of_data(&|other| other == number);
            let is_other = own > SAME * common || own < common / SAME;
            let own = match count as usize >= FEWEST_VALUES && is_other {
                true => own.clamp(common / LARGEST_RATIO, common * LARGEST_RATIO),
                false => common,
            };
            let data = measured.data().iter().zip(&mut self.relative);
            for (_, error) in data.filter(|(d, _)| d.number == number && d.error.is_none()) {
                *error = own.max(LEAST_ERROR);
            }
        }
    }

    /// Smallest factor on all errors that is believed: below it, numbers are met better than the forward model is exact.
    pub(super) fn least_scale(&self) -> f64 {
        let largest = self.relative.iter().fold(0.0_f64, |a, error| a.max(*error));
        LEAST_ERROR / largest
    }
}
