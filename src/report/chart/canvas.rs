//! Drawing in px by plotters, into the shapes of a [`Drawing`](super::Drawing).
//!
//! Plotters' coordinates are whole numbers, which would put kinks into curves; so its canvas is sixteen times the size of the
//! picture. What it draws goes to a backend of our own, which collects paths and texts.

use std::cell::RefCell;
use std::rc::Rc;

use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, Drawable, PathElement, PointCollection, Polygon, Text};
pub(super) use plotters::style::text_anchor::HPos;
use plotters::style::text_anchor::{Pos, VPos};
use plotters::style::{Color as _, FontTransform, IntoFont, RGBAColor, ShapeStyle, TextStyle};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
};
use resvg::tiny_skia::PathBuilder;

use super::drawing::{FINE, Paint, Shape};
use super::geometry::{Point, Rect};
use super::{ChartError, Color, Size, text};

/// Horizontally, or upwards as along the y axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    Level,
    Upwards,
}

/// What one chart is drawn on. What cannot be drawn is reported by [`Canvas::finish`].
pub(super) struct Canvas {
    area: DrawingArea<Collector, Shift>,
    shapes: Rc<RefCell<Vec<Shape>>>,
    failed: RefCell<Option<ChartError>>,
}

impl Canvas {
    /// A canvas of this size.
    pub(super) fn new(size: Size) -> Self {
        let shapes = Rc::new(RefCell::new(Vec::new()));
        let fine = |px: u32| px * FINE as u32;
        let backend = Collector {
            shapes: Rc::clone(&shapes),
            size: (fine(size.width_px), fine(size.height_px)),
        };
        Self {
            area: backend.into_drawing_area(),
            shapes,
            failed: RefCell::new(None),
        }
    }

    /// A line through the points.
    pub(super) fn line(&self, points: &[Point], width: f64, color: Color) {
        let mut path: Vec<BackendCoord> = points.iter().map(|&point| fine(point)).collect();
        path.dedup();
        if path.len() > 1 {
            self.put(&PathElement::new(path, stroke(color, width)));
        }
    }

    /// A filled polygon.
    pub(super) fn polygon(&self, corners: &[Point], color: Color, opacity: f64) {
        let corners: Vec<BackendCoord> = corners.iter().map(|&point| fine(point)).collect();
        self.put(&Polygon::new(corners, rgba(color, opacity).filled()));
    }

    /// A filled box.
    pub(super) fn rect(&self, rect: &Rect, color: Color, opacity: f64) {
        self.polygon(&rect.corners(), color, opacity);
    }

    /// The edge of a box.
    pub(super) fn outline(&self, rect: &Rect, width: f64, color: Color) {
        let corners = rect.corners();
        self.line(&[&corners[..], &corners[..1]].concat(), width, color);
    }

    /// A filled disc.
    pub(super) fn disc(&self, center: Point, radius: f64, color: Color) {
        let style = rgba(color, 1.0).filled();
        self.put(&Circle::new(fine(center), fine_length(radius), style));
    }

    /// A circle.
    pub(super) fn circle(&self, center: Point, radius: f64, width: f64, color: Color) {
        let style = stroke(color, width);
        self.put(&Circle::new(fine(center), fine_length(radius), style));
    }

    /// A line of text; `at` is on its baseline.
    pub(super) fn text(
        &self,
        text: &str,
        at: Point,
        size: f64,
        (anchor, direction): (HPos, Direction),
    ) {
        // Plotters places texts by their upper edge.
        let hang = text::HANG_EM * size;
        let (at, transform) = match direction {
            Direction::Level => ((at.0, at.1 - hang), FontTransform::None),
            Direction::Upwards => ((at.0 - hang, at.1), FontTransform::Rotate270),
        };
        let font = (text::FAMILY, size * FINE).into_font();
        let ink = rgba(super::look::TEXT, 1.0);
        let style = TextStyle::from(font.transform(transform))
            .color(&ink)
            .pos(Pos::new(anchor, VPos::Top));
        self.put(&Text::new(text.to_owned(), fine(at), style));
    }

    /// Adds a shape finer than plotters' coordinates: its outline (px), and how it is painted.
    pub(super) fn path(&self, paint: Paint, outline: impl FnOnce(&mut Pen)) {
        let mut pen = Pen(PathBuilder::new());
        outline(&mut pen);
        let shape = pen.0.finish().map(|path| Shape::new(path, paint));
        self.shapes.borrow_mut().extend(shape);
    }

    /// All shapes in the order in which they were drawn.
    ///
    /// # Errors
    /// [`ChartError::Draw`] for the first that could not be drawn.
    pub(super) fn finish(self) -> Result<Vec<Shape>, ChartError> {
        match self.failed.into_inner() {
            Some(error) => Err(error),
            None => Ok(self.shapes.take()),
        }
    }

    fn put<E>(&self, element: &E)
    where
        E: Drawable<Collector>,
        for<'b> &'b E: PointCollection<'b, BackendCoord>,
    {
        if let Err(error) = self.area.draw(element) {
            self.failed.borrow_mut().get_or_insert(ChartError::Draw {
                reason: error.to_string(),
            });
        }
    }
}

/// Draws the outline of one shape, in px of the chart.
pub(super) struct Pen(PathBuilder);

impl Pen {
    pub(super) fn segment(&mut self, from: Point, to: Point) {
        self.lines(&[from, to]);
    }

    pub(super) fn rect(&mut self, rect: &Rect) {
        self.lines(&rect.corners());
        self.0.close();
    }

    pub(super) fn circle(&mut self, center: Point, radius: f64) {
        let center = (rounded(center.0), rounded(center.1));
        circle(&mut self.0, center, rounded(radius));
    }

    fn lines(&mut self, points: &[Point]) {
        for (place, &(x, y)) in points.iter().enumerate() {
            let (x, y) = (rounded(x) as f32, rounded(y) as f32);
            match place {
                0 => self.0.move_to(x, y),
                _ => self.0.line_to(x, y),
            }
        }
    }
}

/// In sixteenths, and to a hundredth of a px, far below what can be seen.
fn rounded(px: f64) -> f64 {
    FINE * ((100.0 * px).round() / 100.0)
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

/// What plotters draws on: every path and text becomes a shape.
struct Collector {
    shapes: Rc<RefCell<Vec<Shape>>>,
    size: (u32, u32),
}

type Drawn = Result<(), DrawingErrorKind<ChartError>>;

impl Collector {
    fn add(&self, builder: PathBuilder, paint: Paint) -> Drawn {
        let shape = builder.finish().map(|path| Shape::new(path, paint));
        self.shapes.borrow_mut().extend(shape);
        Ok(())
    }
}

fn polyline(points: impl IntoIterator<Item = BackendCoord>) -> PathBuilder {
    let mut builder = PathBuilder::new();
    for (x, y) in points {
        match builder.is_empty() {
            true => builder.move_to(x as f32, y as f32),
            false => builder.line_to(x as f32, y as f32),
        }
    }
    builder
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

impl DrawingBackend for Collector {
    type ErrorType = ChartError;

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
        self.add(polyline(path), stroked(style))
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        let mut builder = polyline(corners);
        builder.close();
        self.add(builder, filled(style))
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let mut builder = PathBuilder::new();
        circle(&mut builder, (x.into(), y.into()), radius.into());
        self.add(builder, if fill { filled(style) } else { stroked(style) })
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        (x, y): BackendCoord,
    ) -> Drawn {
        let anchor = match style.anchor().h_pos {
            HPos::Left => "start",
            HPos::Center => "middle",
            HPos::Right => "end",
        };
        let degrees = match style.transform() {
            FontTransform::None => 0,
            FontTransform::Rotate90 => 90,
            FontTransform::Rotate180 => 180,
            FontTransform::Rotate270 => 270,
        };
        let laid_out = text::laid_out(text, (x, y), style.size(), (anchor, degrees))
            .map_err(DrawingErrorKind::DrawingError)?;
        let shape = laid_out.and_then(|text| Shape::of_text(text, style.color().rgb.into()));
        self.shapes.borrow_mut().extend(shape);
        Ok(())
    }
}

fn fine((x, y): Point) -> BackendCoord {
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
    plotters::style::Color::stroke_width(&rgba(color, 1.0), fine_length(width).max(1) as u32)
}
