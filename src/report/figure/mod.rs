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

use serde::{Deserialize, Serialize};

use super::caption::Caption;
use super::chart::{self, Axis, Chart, ChartError, Drawing, Scale};

/// A picture, the name of its files, what is to be said of it, and its data as CSV.
pub struct Figure {
    pub name: &'static str,
    pub picture: Picture,
    pub caption: Caption,
    /// Empty where another file holds them.
    pub data: Vec<u8>,
}

/// What a figure shows: a chart, or charts one above another.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Picture(pub Vec<Chart>);

impl From<Chart> for Picture {
    fn from(chart: Chart) -> Self {
        Self(vec![chart])
    }
}

impl Picture {
    /// Lays it out.
    ///
    /// # Errors
    /// [`ChartError`] why it cannot be drawn.
    pub fn draw(&self) -> Result<Drawing, ChartError> {
        chart::stack(&self.0)
    }
}

/// A figure, or why there is none: an empty frame says less than a sentence.
pub type Drawn = Result<Figure, &'static str>;

/// The scale of values between these two: logarithmic where they are positive and more than `wide` times apart.
fn scale((least, largest): (f64, f64), wide: f64) -> Scale {
    match least > 0.0 && largest > wide * least {
        true => Scale::Log,
        false => Scale::Linear,
    }
}

/// An axis of values between these two, on their [`scale`].
fn axis(range: (f64, f64), wide: f64, label: impl Into<String>) -> Axis {
    Axis {
        scale: scale(range, wide),
        ..Axis::linear(label)
    }
}
