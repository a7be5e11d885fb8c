//! The scale of a quantity that series are coloured by, as points of a master curve are by their temperature.

use serde::{Deserialize, Serialize};

use super::Color;
use super::color_map::{LEVELS, level};

/// Values from low to high, dark to light, and what they are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ColorScale {
    /// Quantity and unit, beside the bar.
    pub label: String,
    /// The values at the two ends of the bar.
    pub range: (f64, f64),
}

impl ColorScale {
    /// A scale over these values, some room about them where they are all the same; `None` where there is no value.
    pub fn over(label: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let (low, high) = crate::report::number::range(values);
        let room = if low < high { 0.0 } else { 1.0 };
        (low <= high).then(|| Self {
            label: label.into(),
            range: (low - room, high + room),
        })
    }

    /// The colour of a value.
    pub fn color(&self, value: f64) -> Color {
        color(level(value, self.range))
    }
}

/// The colour of a level: those of a ramp, none of which vanishes on white.
pub(super) fn color(level: usize) -> Color {
    Color::Ramp {
        step: level,
        of: LEVELS,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, Chart, Series};

    #[test]
    fn ends_of_the_values_have_the_ends_of_the_colours() {
        let scale = ColorScale::over("T / °C", [60.0, -40.0, 25.0]).unwrap();
        assert_eq!(scale.range, (-40.0, 60.0));
        assert_eq!(scale.color(-40.0).rgb(), color(0).rgb());
        assert_eq!(scale.color(60.0).rgb(), color(LEVELS - 1).rgb());
        assert_eq!(ColorScale::over("T / °C", []), None);
        let one = ColorScale::over("T / °C", [20.0]).unwrap();
        assert!(one.range.0 < one.range.1);
    }

    #[test]
    fn a_chart_with_a_scale_keeps_its_grid_and_has_room_for_the_bar() {
        let chart = || {
            Chart::new(Axis::linear("x"), Axis::linear("y"))
                .series(Series::scatter([(0.0, 1.0), (1.0, 2.0)]))
        };
        let scale = ColorScale::over("T / °C", [0.0, 50.0]).unwrap();
        let bare = chart().draw().unwrap().to_svg();
        let scaled = chart().color_scale(scale.clone()).draw().unwrap().to_svg();
        // A path for every level of the bar.
        assert!(scaled.matches("<path").count() > bare.matches("<path").count() + LEVELS / 2);
        let reversed = ColorScale {
            range: (1.0, 0.0),
            ..scale
        };
        assert!(chart().color_scale(reversed).draw().is_err());
    }
}
