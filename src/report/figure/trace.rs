//! Curves and sets of symbols in SI units, as a frame of a figure shows them.

use crate::report::chart::{Color, LineStyle, Marker};
use crate::report::number::range;

/// A point of a curve, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    pub x: f64,
    /// `None` where there is no value: the line is broken.
    pub y: Option<f64>,
    /// Half the length of the error bar.
    pub error: Option<f64>,
    /// The two edges of a band.
    pub band: Option<(f64, f64)>,
    /// Its value of [`Plot::along`](super::plot::Plot::along).
    pub along: Option<f64>,
}

impl Point {
    pub fn new(x: f64, y: impl Into<Option<f64>>) -> Self {
        Self {
            x,
            y: y.into(),
            error: None,
            band: None,
            along: None,
        }
    }

    #[must_use]
    pub fn along(self, value: f64) -> Self {
        Self {
            along: Some(value),
            ..self
        }
    }

    #[must_use]
    pub fn error(self, error: impl Into<Option<f64>>) -> Self {
        Self {
            error: error.into(),
            ..self
        }
    }

    #[must_use]
    pub fn band(self, band: Option<(f64, f64)>) -> Self {
        Self { band, ..self }
    }
}

impl From<(f64, f64)> for Point {
    fn from((x, y): (f64, f64)) -> Self {
        Self::new(x, y)
    }
}

/// One curve or one set of symbols.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    pub points: Vec<Point>,
    /// The entry in the legend, and what tells it apart in the table.
    pub label: Option<String>,
    /// What the band is called in the legend.
    pub band_label: Option<String>,
    /// Its value of [`Plot::family`](super::plot::Plot::family).
    pub member: Option<f64>,
    pub line: Option<LineStyle>,
    pub marker: Option<Marker>,
    pub color: Color,
    /// Symbols that crowd are left out.
    pub spaced: bool,
    /// The line is smooth, through located extremes, where the points resolve it.
    pub smooth: Option<Vec<(f64, f64)>>,
    /// Fills the area down to this y.
    pub area_to: Option<f64>,
    /// Whether its points stand in the table.
    pub in_table: bool,
    /// Whether its label stands in the legend too, or what does in its place.
    pub in_legend: bool,
    pub legend: Option<String>,
}

impl Trace {
    /// A line through points.
    pub fn line<P: Into<Point>>(points: impl IntoIterator<Item = P>) -> Self {
        Self {
            points: points.into_iter().map(Into::into).collect(),
            label: None,
            band_label: None,
            member: None,
            line: Some(LineStyle::Solid),
            marker: None,
            color: Color::Palette(0),
            spaced: false,
            smooth: None,
            area_to: None,
            in_table: true,
            in_legend: true,
            legend: None,
        }
    }

    /// Symbols without a line.
    pub fn symbols<P: Into<Point>>(points: impl IntoIterator<Item = P>) -> Self {
        Self {
            line: None,
            marker: Some(Marker::Disc),
            ..Self::line(points)
        }
    }

    /// A line that helps to read the others, such as that of zero: not in the table.
    pub fn guide(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            in_table: false,
            color: Color::Rgb(0x40, 0x40, 0x40),
            ..Self::line(points)
        }
    }

    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = Some(label.into());
        self
    }

    #[must_use]
    pub fn maybe_label(self, label: Option<String>) -> Self {
        Self { label, ..self }
    }

    #[must_use]
    pub fn member(mut self, value: impl Into<Option<f64>>) -> Self {
        self.member = value.into();
        self
    }

    #[must_use]
    pub fn marker(mut self, marker: Marker) -> Self {
        self.marker = Some(marker);
        self
    }

    #[must_use]
    pub fn style(mut self, style: LineStyle) -> Self {
        self.line = Some(style);
        self
    }

    #[must_use]
    pub fn color(mut self, color: impl Into<Color>) -> Self {
        self.color = color.into();
        self
    }

    #[must_use]
    pub fn spaced(mut self) -> Self {
        self.spaced = true;
        self
    }

    /// The line is smooth where the points resolve it, and goes through these too, which were located between them.
    #[must_use]
    pub fn smooth(mut self, located: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.smooth = Some(located.into_iter().collect());
        self
    }

    /// Some of the curves of a family in the colours and with the symbols of their order.
    #[must_use]
    pub fn of_family(mut self, step: usize, of: usize) -> Self {
        self.color = Color::of_family(step, of);
        self.marker = self.marker.map(|_| Marker::nth(step));
        self
    }

    /// The largest y.
    pub(super) fn highest(&self) -> f64 {
        range(self.points.iter().filter_map(|point| point.y)).1
    }
}
