//! The shapes that stand on data points, with a white edge that parts them from what is below.

use super::canvas::Canvas;
use super::geometry::Point;
use super::look::{MARKER_RADIUS, WHITE};
use super::{Color, Marker};

/// Draws one marker with a white edge of this width (px), which may be 0. The sizes are balanced so that all shapes carry about the
/// same weight.
pub(super) fn draw(canvas: &mut Canvas, marker: Marker, at: Point, color: Color, edge: f64) {
    let radius = MARKER_RADIUS;
    match marker {
        Marker::Disc => {
            if edge > 0.0 {
                canvas.disc(at, radius + edge, WHITE);
            }
            canvas.disc(at, radius, color);
        }
        Marker::Ring => {
            canvas.disc(at, radius + edge, WHITE);
            canvas.circle(at, radius - 0.4, 1.7, color);
        }
        Marker::Square => polygon(
            canvas,
            at,
            radius * 1.28,
            (&regular::<4>(45.0), edge),
            color,
        ),
        Marker::Diamond => polygon(canvas, at, radius * 1.4, (&regular::<4>(0.0), edge), color),
        Marker::Triangle => {
            // The centre of mass is on the point, so that the shape does not seem to sit too high.
            polygon(
                canvas,
                at,
                radius * 1.45,
                (&regular::<3>(-90.0), edge),
                color,
            );
        }
        Marker::Cross => {
            let strokes = [(2.0 + 2.0 * edge, WHITE), (2.0, color)];
            for (width, color) in strokes.into_iter().skip(usize::from(edge == 0.0)) {
                for (dx, dy) in [(1.0, 1.0), (1.0, -1.0)] {
                    // The white is longer too, so that the ends are edged as the sides are.
                    let arm = 0.85 * radius + (width - 2.0) / 3.0;
                    let ends = [
                        (at.0 - dx * arm, at.1 - dy * arm),
                        (at.0 + dx * arm, at.1 + dy * arm),
                    ];
                    canvas.line(&ends, width, color);
                }
            }
        }
    }
}

/// The corners of a regular polygon on the unit circle, the first at `start_degrees`.
fn regular<const N: usize>(start_degrees: f64) -> [Point; N] {
    std::array::from_fn(|corner| {
        let angle = (start_degrees + 360.0 * corner as f64 / N as f64).to_radians();
        (angle.cos(), angle.sin())
    })
}

fn polygon(
    canvas: &mut Canvas,
    at: Point,
    radius: f64,
    (shape, edge): (&[Point], f64),
    color: Color,
) {
    // An edge of even width needs a radius that grows by width / cos(π/n).
    let edge = edge / (std::f64::consts::PI / shape.len() as f64).cos();
    let rims = [(radius + edge, WHITE), (radius, color)];
    for (radius, color) in rims.into_iter().skip(usize::from(edge == 0.0)) {
        let corners: Vec<Point> = shape
            .iter()
            .map(|(x, y)| (at.0 + x * radius, at.1 + y * radius))
            .collect();
        canvas.polygon(&corners, color, 1.0);
    }
}
