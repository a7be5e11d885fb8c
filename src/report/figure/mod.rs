//! Figures, one file each: a chart, its caption and the data behind it. [`press`] writes them in the forms asked for.

pub mod cole_cole;
pub mod comparison;
pub mod curve;
pub mod cycle_losses;
pub mod dissipation;
pub mod dissipation_map;
pub mod dissipation_profile;
pub mod drive_map;
pub mod dynamic;
pub mod energy_loss;
pub mod equivalent;
pub mod fit;
pub mod harmonic_map;
pub mod history;
pub mod identify;
pub mod line;
pub mod loops;
pub mod loss_map;
pub mod loss_tangent;
pub mod measured;
pub mod moduli;
pub mod moduli_error;
pub mod of_sweep;
pub mod peaks_over_axis;
pub mod press;
pub mod pressure_map;
pub mod profiles;
pub mod relaxation;
pub mod units;
pub mod van_gurp_palmen;

use super::caption::Caption;
use super::chart::{self, Chart, ChartError, Drawing, HeatMap};

/// A picture, the name of its files, what is to be said of it, and its data as CSV.
pub struct Figure {
    pub name: &'static str,
    pub picture: Picture,
    pub caption: Caption,
    /// Empty where another file holds them.
    pub data: Vec<u8>,
}

/// What a figure shows.
#[derive(Clone)]
pub enum Picture {
    Chart(Box<Chart>),
    /// Charts one above another.
    Stack(Vec<Chart>),
}

impl From<Chart> for Picture {
    fn from(chart: Chart) -> Self {
        Self::Chart(Box::new(chart))
    }
}

impl From<HeatMap> for Picture {
    fn from(map: HeatMap) -> Self {
        Self::from(Chart::from(map))
    }
}

impl Picture {
    pub(super) fn draw(&self) -> Result<Drawing, ChartError> {
        match self {
            Self::Chart(chart) => chart.draw(),
            Self::Stack(charts) => chart::stack(charts),
        }
    }
}

/// A figure, or why there is none: an empty frame says less than a sentence.
pub enum Drawn {
    Figure(Figure),
    LeftOut(String),
}

/// An axis of values between these two: logarithmic where they are positive and more than `wide` times apart.
fn axis((least, largest): (f64, f64), wide: f64, label: impl Into<String>) -> chart::Axis {
    match least > 0.0 && largest > wide * least {
        true => chart::Axis::log(label),
        false => chart::Axis::linear(label),
    }
}

impl Drawn {
    fn left_out(why: &str) -> Self {
        Self::LeftOut(why.to_owned())
    }
}
