//! Drawing in px on plotters' SVG backend.
//!
//! Plotters' coordinates are whole numbers, which would put kinks into curves; so the canvas is sixteen times the size
//! of the picture, and only the size written into the SVG is the real one.

use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, Drawable, PathElement, PointCollection, Polygon, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontTransform, IntoFont, RGBAColor, ShapeStyle, TextStyle};

use super::geometry::{Point, Rect};
use super::{ChartError, Color, Size, text};

/// Units of the canvas per px.
const FINE: f64 = 16.0;

/// Which point of a text's baseline is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Horizontally, or upwards as along the y axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    Level,
    Upwards,
}

pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

impl<'a> Canvas<'a> {
    /// A canvas that writes into `svg`.
    pub(super) fn new(svg: &'a mut String, size: Size) -> Self {
        Self {
            area: SVGBackend::with_string(svg, fine_size(size)).into_drawing_area(),
        }
    }

    /// A line through the points.
    pub(super) fn line(
        &self,
        points: &[Point],
        width: f64,
        color: Color,
    ) -> Result<(), ChartError> {
        let mut path: Vec<(i32, i32)> = points.iter().map(|&point| fine(point)).collect();
        path.dedup();
        if path.len() < 2 {
            return Ok(());
        }
        self.put(&PathElement::new(path, stroke(color, width)))
    }

    /// A filled polygon.
    pub(super) fn polygon(
        &self,
        corners: &[Point],
        color: Color,
        opacity: f64,
    ) -> Result<(), ChartError> {
        let corners: Vec<(i32, i32)> = corners.iter().map(|&point| fine(point)).collect();
        self.put(&Polygon::new(corners, rgba(color, opacity).filled()))
    }

    /// A filled box.
    pub(super) fn rect(&self, rect: &Rect, color: Color, opacity: f64) -> Result<(), ChartError> {
        let Rect {
            left,
            top,
            right,
            bottom,
        } = *rect;
        self.polygon(
            &[(left, top), (right, top), (right, bottom), (left, bottom)],
            color,
            opacity,
        )
    }

    /// A filled disc.
    pub(super) fn disc(&self, center: Point, radius: f64, color: Color) -> Result<(), ChartError> {
        self.put(&Circle::new(
            fine(center),
            fine_length(radius),
            rgba(color, 1.0).filled(),
        ))
    }

    /// A circle.
    pub(super) fn circle(
        &self,
        center: Point,
        radius: f64,
        width: f64,
        color: Color,
    ) -> Result<(), ChartError> {
        self.put(&Circle::new(
            fine(center),
            fine_length(radius),
            stroke(color, width),
        ))
    }

    /// A line of text; `at` is on its baseline.
    pub(super) fn text(
        &self,
        text: &str,
        at: Point,
        size: f64,
        color: Color,
        (anchor, direction): (Anchor, Direction),
    ) -> Result<(), ChartError> {
        // The backend hangs text 0.76 em below the point given, and divides the size by 1.24.
        let hang = 0.76 * size;
        let (at, transform) = match direction {
            Direction::Level => ((at.0, at.1 - hang), FontTransform::None),
            Direction::Upwards => ((at.0 - hang, at.1), FontTransform::Rotate270),
        };
        let horizontal = match anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let font = (text::FAMILY, 1.24 * size * FINE)
            .into_font()
            .transform(transform);
        let color = rgba(color, 1.0);
        let style = TextStyle::from(font)
            .color(&color)
            .pos(Pos::new(horizontal, VPos::Top));
        self.put(&Text::new(text.to_owned(), fine(at), style))
    }

    /// Completes the SVG.
    pub(super) fn finish(self) -> Result<(), ChartError> {
        self.area.present().map_err(|error| ChartError::Draw {
            reason: error.to_string(),
        })
    }

    fn put<E>(&self, element: &E) -> Result<(), ChartError>
    where
        E: Drawable<SVGBackend<'a>>,
        for<'b> &'b E: PointCollection<'b, (i32, i32)>,
    {
        self.area.draw(element).map_err(|error| ChartError::Draw {
            reason: error.to_string(),
        })
    }
}

/// The SVG with its real size; round corners, which the backend cannot ask for, are said once at the root.
pub(super) fn at_real_size(svg: &str, size: Size) -> Result<String, ChartError> {
    let (width, height) = fine_size(size);
    let coarse = format!(r#"<svg width="{width}" height="{height}" "#);
    let rest = svg.strip_prefix(&coarse).ok_or_else(|| ChartError::Draw {
        reason: format!("the SVG does not start with {coarse:?} as that of plotters 0.3 does"),
    })?;
    let Size {
        width_px,
        height_px,
    } = size;
    Ok(format!(
        r#"<svg width="{width_px}" height="{height_px}" stroke-linejoin="round" {rest}"#
    ))
}

fn fine_size(size: Size) -> (u32, u32) {
    (size.width_px * FINE as u32, size.height_px * FINE as u32)
}

fn fine((x, y): Point) -> (i32, i32) {
    ((x * FINE).round() as i32, (y * FINE).round() as i32)
}

fn fine_length(length: f64) -> i32 {
    (length * FINE).round() as i32
}

fn rgba(color: Color, opacity: f64) -> RGBAColor {
    let [red, green, blue] = color.rgb();
    RGBAColor(red, green, blue, opacity)
}

fn stroke(color: Color, width: f64) -> ShapeStyle {
    rgba(color, 1.0).stroke_width(fine_length(width).max(1) as u32)
}
