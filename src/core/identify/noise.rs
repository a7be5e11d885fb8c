//! How exactly every number was measured: as the data say, or as the residuals do.

use nalgebra::DVector;

use crate::identify::data::{LEAST_ERROR, Measurements, Number};
use crate::measured::statistics::{NORMAL, student};

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

/// By what the error of a datum that is left out is multiplied: it then counts for nothing, and what is computed in its place is known.
const LEFT_OUT: f64 = 1e3;

/// How residuals scatter.
pub(super) struct Scatter {
    /// Sum of squares over degrees of freedom; of errors that were estimated, one.
    pub(super) reduced_chi_squared: f64,
    /// Standard deviation of the residuals, by which intervals are made: known where errors are known and the series meets the data.
    pub(super) deviation: f64,
    /// That of the errors of the data, which stay as they were given.
    pub(super) of_data: f64,
    /// Half the width of the interval of 95 %, in standard deviations.
    pub(super) half_width: f64,
}

/// Whether chi squared per degree of freedom is larger than chance makes it, by three of its standard deviations.
pub(crate) fn is_missed(reduced_chi_squared: f64, degrees_of_freedom: usize) -> bool {
    let deviation = (2.0 / degrees_of_freedom.max(1) as f64).sqrt();
    reduced_chi_squared > 1.0 + 3.0 * deviation
}

/// Relative standard deviations of the data.
#[derive(Debug, Clone)]
pub(super) struct Noise {
    /// As a fit weighs them.
    pub(super) relative: Vec<f64>,
    pub(super) knowledge: Knowledge,
    /// The datum that does not count.
    left_out: Option<usize>,
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
            left_out: None,
            knowledge: match known {
                0 => Knowledge::None,
                all if all == measured.data().len() => Knowledge::All,
                _ => Knowledge::Some,
            },
        }
    }

    /// Lets this datum alone not count, or none.
    pub(super) fn leave_out(&mut self, place: Option<usize>) {
        if let Some(before) = std::mem::replace(&mut self.left_out, place) {
            self.relative[before] /= LEFT_OUT;
        }
        if let Some(place) = place {
            self.relative[place] *= LEFT_OUT;
        }
    }

    pub(super) fn left_out(&self) -> Option<usize> {
        self.left_out
    }

    /// The relative standard deviation of a datum, whether it counts or not.
    pub(super) fn own(&self, place: usize) -> f64 {
        match self.left_out == Some(place) {
            true => self.relative[place] / LEFT_OUT,
            false => self.relative[place],
        }
    }

    /// How residuals scatter that are left with this number of degrees of freedom. A datum that is left out counts with its own error.
    pub(super) fn scatter(&self, residuals: &DVector<f64>, degrees_of_freedom: usize) -> Scatter {
        let left_out = self.left_out.map_or(0.0, |place| {
            (residuals[place] * self.relative[place] / self.own(place)).powi(2)
        });
        let squares = residuals.norm_squared() + left_out;
        let own = (squares / degrees_of_freedom.max(1) as f64).sqrt();
        let wide = student(degrees_of_freedom as f64);
        let (deviation, of_data, half_width) = match self.knowledge {
            Knowledge::None => {
                let estimated = own.max(self.least_scale());
                (estimated, estimated, wide)
            }
            _ if is_missed(own * own, degrees_of_freedom) => (own, 1.0, wide),
            _ => (1.0, 1.0, NORMAL),
        };
        Scatter {
            reduced_chi_squared: (own / of_data).powi(2),
            deviation,
            of_data,
            half_width,
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
