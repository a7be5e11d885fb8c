//! A chart described as plain data: axes, series, marks and a legend.
//!
//! A figure says what is to be seen; where the ticks, the legend and the labels go is decided here. The caller passes
//! data already scaled to the unit named in the axis label. [`Chart::draw`] gives the finished picture as a [`Drawing`], which
//! writes itself as SVG, in pixels, as a page of a PDF, as EPS or as an element of HTML.
//!
//! Labels are text in which an underscore sets a subscript: `a_T`, `E_{inst}`; [`literal`] keeps a name as it is.
//!
//! Plotters draws lines, polygons and circles. Layout, ticks, legend and texts are our own, because its coordinates are whole numbers
//! (so it draws in parts of a px), because it moves what lies outside to the edge in place of cutting it there (so lines are cut
//! to the frame before), and because it guesses the width of a text from its bytes (so texts are measured as they are set).
//!
//! ```
//! use contact_dma::report::chart::{Axis, Chart, Mark, Marker, Series};
//!
//! let losses = [(1e-3, 0.4), (1e-2, 1.7), (1e-1, 0.6)];
//! let chart = Chart::new(Axis::log("angular frequency ω / rad·s⁻¹"), Axis::linear("energy loss W / µJ"))
//!     .series(Series::line(losses).marker(Marker::Disc))
//!     .mark(Mark::point(1e-2, 1.7, "ω = 10⁻² rad/s"));
//! let drawing = chart.draw()?;
//! let (svg, png) = (drawing.to_svg(), drawing.to_png(2.0)?);
//! # Ok::<(), contact_dma::report::chart::ChartError>(())
//! ```

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::figures::font::Typeface;

mod arrange;
mod canvas;
mod check;
mod color_bar;
mod color_map;
mod color_scale;
mod contour;
mod contour_labels;
mod curves;
mod draw;
mod drawing;
mod eps;
mod error;
mod fitting;
mod geometry;
mod grey;
mod heat_map;
mod ink;
mod layers;
mod layout;
mod legend;
mod look;
mod marker;
mod notes;
mod palette;
mod pdf;
mod pdf_font;
mod place;
mod png;
mod scale;
mod shared;
mod stroke;
mod svg;
mod text;
mod ticks;
mod titles;

pub use color_scale::ColorScale;
pub use draw::stack;
pub use drawing::Drawing;
pub use error::ChartError;
pub use fitting::{fits, fitting_height_px};
pub use heat_map::{HeatMap, MapShape};
pub use ink::Overlap;
pub use palette::Color;
pub use text::{literal, plain};

/// A chart: what is drawn against which axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chart {
    /// Drawn above the frame; a figure in a paper has its title in the caption instead.
    pub title: Option<String>,
    pub x: Axis,
    pub y: Axis,
    /// Drawn below everything else, in place of a grid.
    #[serde(
        serialize_with = "shared::serialize",
        deserialize_with = "shared::deserialize"
    )]
    pub map: Option<Arc<HeatMap>>,
    /// What the colours of the series stand for, drawn as a bar right of the frame; a map has a bar of its own.
    pub color_scale: Option<ColorScale>,
    /// Drawn in this order, later ones on top.
    pub series: Vec<Series>,
    pub marks: Vec<Mark>,
    /// `None`: no legend. A legend lists the series that have a label.
    pub legend: Option<LegendPlace>,
    pub size: Size,
    /// What its texts are set in; kept figures are drawn in the one asked for.
    #[serde(skip)]
    pub typeface: Typeface,
}

impl Chart {
    /// An empty chart of the default size with an automatically placed legend.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self {
            title: None,
            x,
            y,
            map: None,
            color_scale: None,
            series: Vec::new(),
            marks: Vec::new(),
            legend: Some(LegendPlace::Auto),
            size: Size::default(),
            typeface: Typeface::default(),
        }
    }

    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = Some(title.into());
        self
    }

    /// The same where there may be none.
    #[must_use]
    pub fn maybe_title(self, title: Option<String>) -> Self {
        Self { title, ..self }
    }

    /// Adds one series.
    #[must_use]
    pub fn series(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Adds several series.
    #[must_use]
    pub fn all_series(mut self, series: impl IntoIterator<Item = Series>) -> Self {
        self.series.extend(series);
        self
    }

    /// Adds one mark.
    #[must_use]
    pub fn mark(mut self, mark: Mark) -> Self {
        self.marks.push(mark);
        self
    }

    /// Adds several marks; an `Option<Mark>` serves as well.
    #[must_use]
    pub fn all_marks(mut self, marks: impl IntoIterator<Item = Mark>) -> Self {
        self.marks.extend(marks);
        self
    }

    /// Lays a map below everything else, the ranges of whose grid the axes have; it has no legend.
    #[must_use]
    pub fn map(mut self, map: HeatMap) -> Self {
        self.map = Some(Arc::new(map));
        self.legend = None;
        self
    }

    /// Adds the bar that explains colours taken from [`ColorScale::color`].
    #[must_use]
    pub fn color_scale(mut self, scale: ColorScale) -> Self {
        self.color_scale = Some(scale);
        self
    }

    /// Fixes where the legend goes, or with `None` leaves it out.
    #[must_use]
    pub fn legend(mut self, place: impl Into<Option<LegendPlace>>) -> Self {
        self.legend = place.into();
        self
    }

    #[must_use]
    pub fn size(mut self, width_px: u32, height_px: u32) -> Self {
        self.size = Size {
            width_px,
            height_px,
        };
        self
    }
}

/// One axis: quantity and unit in words, how values become lengths, and optionally the range shown.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    pub label: String,
    pub scale: Scale,
    /// The values at the two ends of the axis, low then high. `None`: chosen from the data.
    pub range: Option<(f64, f64)>,
    /// Whether its values are counted: ticks stand at whole numbers alone.
    #[serde(default)]
    pub whole: bool,
}

impl Axis {
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            ..Self::default()
        }
    }

    pub fn log(label: impl Into<String>) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label)
        }
    }

    /// Fixes the values at the two ends of the axis. What lies outside is not drawn.
    #[must_use]
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }
}

/// How a value becomes a length along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Scale {
    #[default]
    Linear,
    /// Base ten; values must be above zero.
    Log,
}

impl Scale {
    /// A value as it goes linearly along the axis.
    pub fn linearised(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Log => value.log10(),
        }
    }

    /// The value of what goes linearly along the axis.
    pub fn value(self, linearised: f64) -> f64 {
        match self {
            Self::Linear => linearised,
            Self::Log => 10_f64.powf(linearised),
        }
    }
}

/// One curve or one set of points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// The entry in the legend; a series without a label has none.
    pub label: Option<String>,
    /// `(x, y)`; `None` breaks the line where a value is absent.
    pub points: Vec<Option<(f64, f64)>>,
    pub line: Option<LineStyle>,
    /// The line where it is not the polygon through the points: a smooth curve through them.
    #[serde(default)]
    pub curve: Option<Vec<Option<(f64, f64)>>>,
    pub marker: Option<Marker>,
    pub color: Color,
    /// Fills the area between the curve and this y with the full colour: see [`Series::area_to`].
    pub area_to: Option<f64>,
    /// Fills the area that the points enclose with a tint that shows what lies behind: a band, there along one edge and back along
    /// the other.
    pub closed: bool,
    /// Whether markers that crowd are left out: see [`Series::spaced`].
    pub spaced: bool,
    /// Symmetric error bars in units of y, one entry per entry of `points`.
    pub error: Option<Vec<Option<f64>>>,
}

impl Series {
    /// A solid line through the points, given as `(x, y)` or, where values may be absent, as `Option<(x, y)>`.
    pub fn line<P: Into<Option<(f64, f64)>>>(points: impl IntoIterator<Item = P>) -> Self {
        Self {
            label: None,
            points: points.into_iter().map(Into::into).collect(),
            line: Some(LineStyle::Solid),
            curve: None,
            marker: None,
            color: Color::Palette(0),
            area_to: None,
            closed: false,
            spaced: false,
            error: None,
        }
    }

    /// An area without a line between two values of y at each x, given as `(x, lower, upper)`, in a tint of its colour.
    pub fn band(points: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        let points: Vec<(f64, f64, f64)> = points.into_iter().collect();
        let lower = points.iter().map(|(x, lower, _)| (*x, *lower));
        let upper = points.iter().rev().map(|(x, _, upper)| (*x, *upper));
        Self {
            line: None,
            closed: true,
            ..Self::line(lower.chain(upper))
        }
    }

    /// Whether it has an area.
    pub(super) fn is_filled(&self) -> bool {
        self.closed || self.area_to.is_some()
    }

    /// Points that no line joins, drawn as discs unless another marker is chosen.
    pub fn scatter<P: Into<Option<(f64, f64)>>>(points: impl IntoIterator<Item = P>) -> Self {
        Self {
            line: None,
            marker: Some(Marker::Disc),
            ..Self::line(points)
        }
    }

    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = Some(label.into());
        self
    }

    #[must_use]
    pub fn style(mut self, style: LineStyle) -> Self {
        self.line = Some(style);
        self
    }

    #[must_use]
    pub fn marker(mut self, marker: Marker) -> Self {
        self.marker = Some(marker);
        self
    }

    /// A [`Color`], or a number for that place in the palette.
    #[must_use]
    pub fn color(mut self, color: impl Into<Color>) -> Self {
        self.color = color.into();
        self
    }

    /// An area in full colour between the points and this y, without a line. Later series lie on top: a stack is drawn from
    /// its total downwards.
    #[must_use]
    pub fn area_to(mut self, y: f64) -> Self {
        self.area_to = Some(y);
        self.line = None;
        self
    }

    /// Leaves out markers, and their error bars, that stand within a few marker widths of the one before, so that they do not hide
    /// a line they are compared with; a line of the series itself goes through all points.
    #[must_use]
    pub fn spaced(mut self) -> Self {
        self.spaced = true;
        self
    }

    /// One half-length per point, as `f64` or as `Option<f64>`.
    #[must_use]
    pub fn error_bars<E: Into<Option<f64>>>(mut self, error: impl IntoIterator<Item = E>) -> Self {
        self.error = Some(error.into_iter().map(Into::into).collect());
        self
    }
}

/// How a line is stroked. The four stay apart in grey.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LineStyle {
    Solid,
    Dashed,
    Dotted,
    DashDot,
}

impl LineStyle {
    /// The styles in turn, for a family of curves: 0 is solid, 4 is solid again.
    pub fn nth(index: usize) -> Self {
        [Self::Solid, Self::Dashed, Self::DashDot, Self::Dotted][index % 4]
    }
}

/// What stands on a data point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Marker {
    Disc,
    Ring,
    Square,
    Triangle,
    Diamond,
    Cross,
}

impl Marker {
    /// In a caption.
    pub fn name(self) -> &'static str {
        match self {
            Self::Disc => "discs",
            Self::Ring => "rings",
            Self::Square => "squares",
            Self::Triangle => "triangles",
            Self::Diamond => "diamonds",
            Self::Cross => "crosses",
        }
    }

    /// The markers in turn, for a family of curves: 0 is a disc, 6 is a disc again.
    pub fn nth(index: usize) -> Self {
        [
            Self::Disc,
            Self::Square,
            Self::Triangle,
            Self::Diamond,
            Self::Ring,
            Self::Cross,
        ][index % 6]
    }
}

/// Something pointed out in the chart. Its label is placed where it covers neither curves nor the legend.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mark {
    pub place: MarkPlace,
    /// May be empty.
    pub label: String,
    pub color: Color,
}

/// Where a [`Mark`] is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MarkPlace {
    /// A ring about a point, such as a peak, with a thin leader line to its label.
    Point { x: f64, y: f64 },
    /// A line over the whole height of the frame.
    Vertical { x: f64 },
    /// A line over the whole width of the frame.
    Horizontal { y: f64 },
}

impl MarkPlace {
    /// Its x and its y, as far as it has them.
    pub(in crate::report) fn coordinates(self) -> (Option<f64>, Option<f64>) {
        match self {
            Self::Point { x, y } => (Some(x), Some(y)),
            Self::Vertical { x } => (Some(x), None),
            Self::Horizontal { y } => (None, Some(y)),
        }
    }
}

impl Mark {
    pub fn point(x: f64, y: f64, label: impl Into<String>) -> Self {
        Self::new(MarkPlace::Point { x, y }, label)
    }

    pub fn vertical(x: f64, label: impl Into<String>) -> Self {
        Self::new(MarkPlace::Vertical { x }, label)
    }

    pub fn horizontal(y: f64, label: impl Into<String>) -> Self {
        Self::new(MarkPlace::Horizontal { y }, label)
    }

    /// Whether it is a ring with a label.
    fn is_labelled_point(&self) -> bool {
        !self.label.is_empty() && matches!(self.place, MarkPlace::Point { .. })
    }

    fn new(place: MarkPlace, label: impl Into<String>) -> Self {
        Self {
            place,
            label: label.into(),
            color: look::INK,
        }
    }

    /// A [`Color`], or a number for that place in the palette; a mark is dark grey otherwise.
    #[must_use]
    pub fn color(mut self, color: impl Into<Color>) -> Self {
        self.color = color.into();
        self
    }
}

/// Where the legend goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LegendPlace {
    /// A place inside the frame where it covers no data, otherwise outside.
    Auto,
    TopRight,
    TopLeft,
    BottomRight,
    BottomLeft,
    /// Outside, in a column to the right of the frame; above it where the frame would be too narrow.
    Right,
    /// Outside, in rows above the frame.
    Above,
}

/// The size of the picture at scale 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Size {
    pub width_px: u32,
    pub height_px: u32,
}

impl Default for Size {
    fn default() -> Self {
        Self {
            width_px: 800,
            height_px: 600,
        }
    }
}
