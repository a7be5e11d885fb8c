//! Drawing in px by plotters, into the shapes of a [`Drawing`](super::Drawing).
//!
//! plotters draws on whole numbers, which would put kinks into curves; so its canvas is finer than px, and what it draws becomes px
//! again in the backend below, which collects shapes. Texts and shapes of many pieces are added directly: plotters would guess the
//! width of a text, and has no shape of several outlines.

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, Drawable, PathElement, PointCollection, Polygon};
use plotters::style::{Color as _, RGBAColor, ShapeStyle};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, DrawingBackend, DrawingErrorKind,
};
use tiny_skia::PathBuilder;

use super::drawing::{Paint, Shape};
use super::geometry::{Point, Rect};
use super::text::Anchor;
use super::{Chart, ChartError, Color};
use crate::figures::font::Typeface;

/// Units of plotters per px.
const UNITS: f64 = 1024.0;

/// What one chart is drawn on. What cannot be drawn is reported by [`Canvas::finish`].
pub(super) struct Canvas {
    area: DrawingArea<Collector, Shift>,
    shapes: Shapes,
    typeface: Typeface,
    failed: Option<ChartError>,
}

/// Shapes in the order in which they were drawn.
type Shapes = Rc<RefCell<Vec<Shape>>>;

impl Canvas {
    /// A canvas of the size and in the typeface of this chart.
    pub(super) fn new(chart: &Chart) -> Self {
        let shapes = Shapes::default();
        let side = |px: u32| px.saturating_mul(UNITS as u32);
        let backend = Collector {
            shapes: Rc::clone(&shapes),
            size: (side(chart.size.width_px), side(chart.size.height_px)),
        };
        Self {
            area: backend.into_drawing_area(),
            shapes,
            typeface: chart.typeface.clone(),
            failed: None,
        }
    }

    /// A line through the points.
    pub(super) fn line(&mut self, points: &[Point], width: f64, color: Color) {
        let mut path = in_units(points);
        path.dedup();
        if path.len() > 1 {
            self.put(&PathElement::new(path, stroke(color, width)));
        }
    }

    /// A filled polygon.
    pub(super) fn polygon(&mut self, corners: &[Point], color: Color, opacity: f64) {
        self.put(&Polygon::new(
            in_units(corners),
            rgba(color, opacity).filled(),
        ));
    }

    /// A filled box.
    pub(super) fn rect(&mut self, rect: &Rect, color: Color, opacity: f64) {
        self.polygon(&rect.corners(), color, opacity);
    }

    /// The edge of a box.
    pub(super) fn outline(&mut self, rect: &Rect, width: f64, color: Color) {
        let corners = rect.corners();
        self.line(&[&corners[..], &corners[..1]].concat(), width, color);
    }

    /// A filled disc.
    pub(super) fn disc(&mut self, center: Point, radius: f64, color: Color) {
        self.round(center, radius, rgba(color, 1.0).filled());
    }

    /// A circle.
    pub(super) fn circle(&mut self, center: Point, radius: f64, width: f64, color: Color) {
        self.round(center, radius, stroke(color, width));
    }

    fn round(&mut self, center: Point, radius: f64, style: ShapeStyle) {
        self.put(&Circle::new(unit_point(center), units(radius), style));
    }

    /// A line of text; `at` is on its baseline.
    pub(super) fn text(&mut self, label: &str, at: Point, size: f64, anchor: Anchor) {
        let shape = Shape::of_text(label, &self.typeface, (at, size, anchor));
        self.shapes.borrow_mut().extend(shape);
    }

    /// Adds a shape of many pieces: its outline (px), and how it is painted.
    pub(super) fn path(&mut self, paint: Paint, outline: impl FnOnce(&mut Pen)) {
        let mut pen = Pen::default();
        outline(&mut pen);
        add(&self.shapes, pen, paint);
    }

    /// All shapes in the order in which they were drawn.
    ///
    /// # Errors
    /// [`ChartError::Internal`] for the first that could not be drawn.
    pub(super) fn finish(self) -> Result<Vec<Shape>, ChartError> {
        self.failed.map_or_else(|| Ok(self.shapes.take()), Err)
    }

    fn put<E>(&mut self, element: &E)
    where
        E: Drawable<Collector>,
        for<'b> &'b E: PointCollection<'b, BackendCoord>,
    {
        if let Err(error) = self.area.draw(element) {
            (self.failed).get_or_insert_with(|| ChartError::internal("draw", error));
        }
    }
}

/// Draws the outline of one shape, in px of the chart.
#[derive(Default)]
pub(super) struct Pen(PathBuilder);

impl Pen {
    pub(super) fn segment(&mut self, from: Point, to: Point) {
        self.lines([from, to]);
    }

    pub(super) fn rect(&mut self, rect: &Rect) {
        self.lines(rect.corners());
        self.0.close();
    }

    /// Four cubic curves that keep to a circle within 0.03 % of its radius.
    pub(super) fn circle(&mut self, (x, y): Point, radius: f64) {
        let quarter = 4.0 / 3.0 * (std::f64::consts::SQRT_2 - 1.0) * radius;
        self.lines([(x + radius, y)]);
        // From each of the four points on, the direction of the next.
        for (along, towards) in [
            ((1.0, 0.0), (0.0, 1.0)),
            ((0.0, 1.0), (-1.0, 0.0)),
            ((-1.0, 0.0), (0.0, -1.0)),
            ((0.0, -1.0), (1.0, 0.0)),
        ] {
            let at = |a: f64, t: f64| {
                let (right, down) = (a * along.0 + t * towards.0, a * along.1 + t * towards.1);
                ((x + right) as f32, (y + down) as f32)
            };
            let (first, second, end) = (at(radius, quarter), at(quarter, radius), at(0.0, radius));
            (self.0).cubic_to(first.0, first.1, second.0, second.1, end.0, end.1);
        }
        self.0.close();
    }

    fn lines(&mut self, points: impl IntoIterator<Item = Point>) {
        for (place, (x, y)) in points.into_iter().enumerate() {
            match place {
                0 => self.0.move_to(x as f32, y as f32),
                _ => self.0.line_to(x as f32, y as f32),
            }
        }
    }
}

/// What plotters draws on: every path becomes a shape.
struct Collector {
    shapes: Shapes,
    size: (u32, u32),
}

fn add(shapes: &Shapes, outline: Pen, paint: Paint) {
    let shape = outline.0.finish().map(|path| Shape::new(path, paint));
    shapes.borrow_mut().extend(shape);
}

fn filled(style: &impl BackendStyle) -> Paint {
    let BackendColor { rgb, alpha } = style.color();
    Paint::Fill {
        color: rgb.into(),
        opacity: alpha,
        crisp: false,
    }
}

fn stroked(style: &impl BackendStyle) -> Paint {
    Paint::Stroke {
        color: style.color().rgb.into(),
        width: f64::from(style.stroke_width()) / UNITS,
        round_ends: false,
    }
}

/// Units of plotters in px.
fn px((x, y): BackendCoord) -> Point {
    (f64::from(x) / UNITS, f64::from(y) / UNITS)
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

impl DrawingBackend for Collector {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Drawn {
        self.fill_polygon([(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)], &color)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let mut outline = Pen::default();
        outline.lines(path.into_iter().map(px));
        add(&self.shapes, outline, stroked(style));
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        let mut outline = Pen::default();
        outline.lines(corners.into_iter().map(px));
        outline.0.close();
        add(&self.shapes, outline, filled(style));
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        center: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let mut outline = Pen::default();
        outline.circle(px(center), f64::from(radius) / UNITS);
        let paint = if fill { filled(style) } else { stroked(style) };
        add(&self.shapes, outline, paint);
        Ok(())
    }
}

/// A length (px) in units of plotters.
fn units(px: f64) -> i32 {
    (px * UNITS).round() as i32
}

fn unit_point((x, y): Point) -> BackendCoord {
    (units(x), units(y))
}

fn in_units(points: &[Point]) -> Vec<BackendCoord> {
    points.iter().copied().map(unit_point).collect()
}

fn rgba(color: Color, opacity: f64) -> RGBAColor {
    let [red, green, blue] = color.rgb();
    RGBAColor(red, green, blue, opacity)
}

fn stroke(color: Color, width: f64) -> ShapeStyle {
    plotters::style::Color::stroke_width(&rgba(color, 1.0), units(width).max(1) as u32)
}
