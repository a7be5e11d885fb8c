//! Drawing in px by plotters, into the shapes of a [`Drawing`](super::Drawing).
//!
//! Coordinates of plotters are whole numbers, which would put kinks into curves; so its canvas is sixteen times the size of the
//! picture. What it draws goes to a backend of our own, which collects shapes. Texts go there directly: they are placed by their
//! measured width, which plotters would guess.

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
use resvg::tiny_skia::PathBuilder;

use super::drawing::{FINE, Paint, Shape};
use super::geometry::{Point, Rect};
use super::{ChartError, Color, Size, text};

/// What one chart is drawn on. What cannot be drawn is reported by [`Canvas::finish`].
pub(super) struct Canvas {
    area: DrawingArea<Collector, Shift>,
    shapes: Shapes,
    failed: Option<ChartError>,
}

/// Shapes in the order in which they were drawn.
type Shapes = Rc<RefCell<Vec<Shape>>>;

impl Canvas {
    /// A canvas of this size.
    pub(super) fn new(size: Size) -> Self {
        let shapes = Shapes::default();
        let backend = Collector {
            shapes: Rc::clone(&shapes),
            size: (size.width_px * FINE as u32, size.height_px * FINE as u32),
        };
        Self {
            area: backend.into_drawing_area(),
            shapes,
            failed: None,
        }
    }

    /// A line through the points.
    pub(super) fn line(&mut self, points: &[Point], width: f64, color: Color) {
        let mut path: Vec<BackendCoord> = points.iter().map(|&point| fine_point(point)).collect();
        path.dedup();
        if path.len() > 1 {
            self.put(&PathElement::new(path, stroke(color, width)));
        }
    }

    /// A filled polygon.
    pub(super) fn polygon(&mut self, corners: &[Point], color: Color, opacity: f64) {
        let corners: Vec<BackendCoord> = corners.iter().map(|&point| fine_point(point)).collect();
        self.put(&Polygon::new(corners, rgba(color, opacity).filled()));
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
        let style = rgba(color, 1.0).filled();
        self.put(&Circle::new(fine_point(center), fine(radius), style));
    }

    /// A circle.
    pub(super) fn circle(&mut self, center: Point, radius: f64, width: f64, color: Color) {
        let style = stroke(color, width);
        self.put(&Circle::new(fine_point(center), fine(radius), style));
    }

    /// A line of text; `at` is on its baseline.
    pub(super) fn text(&mut self, text: &str, (x, y): Point, size: f64, anchor: Anchor) {
        // Texts are placed by their upper edge.
        let hang = text::HANG_EM * size;
        let at = match anchor {
            Anchor::Start | Anchor::Middle | Anchor::End => (x, y - hang),
            Anchor::Upwards => (x - hang, y),
        };
        match text::laid_out(text, fine_point(at), size * FINE, anchor) {
            Ok(laid_out) => (self.shapes.borrow_mut()).extend(laid_out.and_then(Shape::of_text)),
            Err(error) => {
                self.failed.get_or_insert(error);
            }
        }
    }

    /// Adds a shape finer than sixteenths of a px: its outline (px), and how it is painted.
    pub(super) fn path(&mut self, paint: Paint, outline: impl FnOnce(&mut Pen)) {
        let mut pen = Pen(PathBuilder::new());
        outline(&mut pen);
        add(&self.shapes, pen.0, paint);
    }

    /// All shapes in the order in which they were drawn.
    ///
    /// # Errors
    /// [`ChartError::Svg`] or [`ChartError::Draw`] for the first that could not be drawn.
    pub(super) fn finish(self) -> Result<Vec<Shape>, ChartError> {
        self.failed.map_or_else(|| Ok(self.shapes.take()), Err)
    }

    fn put<E>(&mut self, element: &E)
    where
        E: Drawable<Collector>,
        for<'b> &'b E: PointCollection<'b, BackendCoord>,
    {
        if let Err(error) = self.area.draw(element) {
            self.failed.get_or_insert(ChartError::Draw {
                reason: error.to_string(),
            });
        }
    }
}

/// What of a line of text is at its place: its start, its middle or its end; upwards, as along the y axis, its middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
    Upwards,
}

/// Draws the outline of one shape, in px of the chart.
pub(super) struct Pen(PathBuilder);

impl Pen {
    pub(super) fn segment(&mut self, from: Point, to: Point) {
        lines(&mut self.0, [from, to].map(rounded).map(single));
    }

    pub(super) fn rect(&mut self, rect: &Rect) {
        lines(&mut self.0, rect.corners().map(rounded).map(single));
        self.0.close();
    }

    pub(super) fn circle(&mut self, center: Point, radius: f64) {
        circle(&mut self.0, rounded(center), rounded((radius, 0.0)).0);
    }
}

/// In sixteenths, and to a hundredth of a px, far below what can be seen.
fn rounded((x, y): Point) -> Point {
    let rounded = |px: f64| FINE * ((100.0 * px).round() / 100.0);
    (rounded(x), rounded(y))
}

/// In single precision.
fn single((x, y): (impl Into<f64>, impl Into<f64>)) -> (f32, f32) {
    (x.into() as f32, y.into() as f32)
}

/// Four cubic curves that keep to a circle within 0.03 % of its radius.
fn circle(builder: &mut PathBuilder, (x, y): (f64, f64), radius: f64) {
    let quarter = 4.0 / 3.0 * (std::f64::consts::SQRT_2 - 1.0) * radius;
    builder.move_to((x + radius) as f32, y as f32);
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
        builder.cubic_to(first.0, first.1, second.0, second.1, end.0, end.1);
    }
    builder.close();
}

fn lines(builder: &mut PathBuilder, points: impl IntoIterator<Item = (f32, f32)>) {
    for (place, (x, y)) in points.into_iter().enumerate() {
        match place {
            0 => builder.move_to(x, y),
            _ => builder.line_to(x, y),
        }
    }
}

/// What plotters draws on: every path becomes a shape.
struct Collector {
    shapes: Shapes,
    size: (u32, u32),
}

fn add(shapes: &Shapes, outline: PathBuilder, paint: Paint) {
    let shape = outline.finish().map(|path| Shape::new(path, paint));
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
        width: f64::from(style.stroke_width()),
        round_ends: false,
    }
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
        let mut outline = PathBuilder::new();
        lines(&mut outline, path.into_iter().map(single));
        add(&self.shapes, outline, stroked(style));
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        let mut outline = PathBuilder::new();
        lines(&mut outline, corners.into_iter().map(single));
        outline.close();
        add(&self.shapes, outline, filled(style));
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let mut outline = PathBuilder::new();
        circle(&mut outline, (x.into(), y.into()), radius.into());
        let paint = if fill { filled(style) } else { stroked(style) };
        add(&self.shapes, outline, paint);
        Ok(())
    }
}

/// In sixteenths of a px.
fn fine_point((x, y): Point) -> BackendCoord {
    (fine(x), fine(y))
}

/// A length (px) in sixteenths.
fn fine(px: f64) -> i32 {
    (px * FINE).round() as i32
}

fn rgba(color: Color, opacity: f64) -> RGBAColor {
    let [red, green, blue] = color.rgb();
    RGBAColor(red, green, blue, opacity)
}

fn stroke(color: Color, width: f64) -> ShapeStyle {
    plotters::style::Color::stroke_width(&rgba(color, 1.0), fine(width).max(1) as u32)
}
