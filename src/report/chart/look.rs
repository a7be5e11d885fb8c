//! The look of every chart in one place: sizes in px at scale 1, and the greys of what is not data.

use super::palette::Color;

pub(super) const TICK_TEXT: f64 = 16.0;
pub(super) const LABEL_TEXT: f64 = 18.0;
pub(super) const LEGEND_TEXT: f64 = 16.0;
pub(super) const MARK_TEXT: f64 = 16.0;
pub(super) const CONTOUR_TEXT: f64 = 14.0;
pub(super) const TITLE_TEXT: f64 = 19.0;

/// Free space between the outermost ink and the edge of the picture.
pub(super) const MARGIN: f64 = 12.0;
/// From a tick to its label, and from the widest label to the axis label.
pub(super) const TICK_GAP: f64 = 6.0;
pub(super) const LABEL_GAP: f64 = 12.0;

pub(super) const MAJOR_TICK: f64 = 6.5;
pub(super) const MINOR_TICK: f64 = 3.5;

pub(super) const FRAME_STROKE: f64 = 1.25;
pub(super) const MAJOR_GRID_STROKE: f64 = 1.0;
pub(super) const MINOR_GRID_STROKE: f64 = 0.75;
pub(super) const LINE_STROKE: f64 = 2.0;
pub(super) const ERROR_STROKE: f64 = 1.3;
pub(super) const ERROR_CAP: f64 = 4.0;
pub(super) const MARK_STROKE: f64 = 1.3;
pub(super) const LEADER_STROKE: f64 = 1.0;

pub(super) const MARKER_RADIUS: f64 = 4.4;
/// White edge that parts a marker from the line below it.
pub(super) const MARKER_EDGE: f64 = 1.3;
/// From one marker to the next, where a line is to be seen between them: two dashes of it.
pub(super) const MARKER_SPACING: f64 = 32.0;
pub(super) const MARK_RING: f64 = 9.0;

pub(super) const LEGEND_SAMPLE: f64 = 36.0;
pub(super) const LEGEND_GAP: f64 = 9.0;
pub(super) const LEGEND_PADDING: f64 = 9.0;
pub(super) const LEGEND_ROW: f64 = 23.0;
pub(super) const LEGEND_INSET: f64 = 8.0;

/// A filled area is this much of its colour, the rest is what lies below.
pub(super) const FILL_OPACITY: f64 = 0.16;

pub(super) const TEXT: Color = Color::Rgb(0x1A, 0x1A, 0x1A);
pub(super) const INK: Color = Color::Rgb(0x40, 0x40, 0x40);
pub(super) const FRAME: Color = Color::Rgb(0x26, 0x26, 0x26);
pub(super) const MAJOR_GRID: Color = Color::Rgb(0xD8, 0xD8, 0xD8);
pub(super) const MINOR_GRID: Color = Color::Rgb(0xEE, 0xEE, 0xEE);
pub(super) const WHITE: Color = Color::Rgb(0xFF, 0xFF, 0xFF);
