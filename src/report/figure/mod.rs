//! Figures, one file each: a chart, its caption and the data behind it. [`press`] writes them in the forms asked for.

mod at_times;
mod attracted;
pub mod comparison;
pub mod curve;
pub mod cycle_losses;
pub mod dissipation;
pub mod dissipation_map;
pub mod dissipation_profile;
pub mod distributions;
pub mod drive_map;
pub mod dynamic;
pub mod energy_loss;
pub mod equivalent;
pub mod fit;
pub mod force_curve;
pub mod harmonic_map;
pub mod history;
pub mod identify;
pub mod line;
pub mod loops;
pub mod loss_map;
pub mod measured;
pub mod moduli;
pub mod moduli_error;
pub mod of_sweep;
pub mod peaks_over_axis;
pub mod plot;
mod points_table;
pub mod press;
pub mod pressure_map;
pub mod profiles;
pub mod quantity;
pub mod relaxation;
mod smooth;
pub mod trace;
pub mod units;

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use self::plot::Plot;
use self::units::Units;
use super::caption::Caption;
use super::chart::{self, Chart, ChartError, Drawing};

/// A picture, the name of its files, what is to be said of it, and its data as CSV.
pub struct Figure {
    pub name: Cow<'static, str>,
    pub picture: Picture,
    pub caption: Caption,
    /// Empty where another file holds them.
    pub data: Vec<u8>,
}

impl Figure {
    /// Frames one above another, in these units; their points are the data.
    pub fn of(
        name: impl Into<Cow<'static, str>>,
        plots: &[Plot],
        caption: Caption,
        units: &Units,
    ) -> Self {
        Self {
            name: name.into(),
            picture: Picture(plot::charts(plots, units)),
            caption: caption.say_all(plot::lines_in_words(plots).map(str::to_owned)),
            data: points_table::table(plots, units.frequency_unit()),
        }
    }

    /// The same where another file holds the data.
    #[must_use]
    pub fn without_data(self) -> Self {
        self.with_data(Vec::new())
    }

    /// The same with another table.
    #[must_use]
    pub fn with_data(self, data: Vec<u8>) -> Self {
        Self { data, ..self }
    }
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
