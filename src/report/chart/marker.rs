//! The shapes that stand on data points, with a white edge that parts them from what is below.

use super::canvas::Canvas;
use super::geometry::Point;
use super::look::{MARKER_EDGE, MARKER_RADIUS, WHITE};
use super::{Color, Marker};

/// Draws one marker. The sizes are balanced so that all shapes carry about the same weight.
pub(super) fn draw(canvas: &mut Canvas, marker: Marker, at: Point, color: Color) {
    let radius = MARKER_RADIUS;
    match marker {
        Marker::Disc => {
            canvas.disc(at, radius + MARKER_EDGE, WHITE);
            canvas.disc(at, radius, color);
        }
        Marker::Ring => {
            canvas.disc(at, radius + MARKER_EDGE, WHITE);
            canvas.circle(at, radius - 0.4, 1.7, color);
        }
        Marker::Square => polygon(canvas, at, radius * 1.28, &regular::<4>(45.0), color),
        Marker::Diamond => polygon(canvas, at, radius * 1.4, &regular::<4>(0.0), color),
        Marker::Triangle => {
            // The centre of mass is on the point, so that the shape does not seem to sit too high.
            polygon(canvas, at, radius * 1.45, &regular::<3>(-90.0), color);
        }
        Marker::Cross => {
            for (width, color) in [(2.0 + 2.0 * MARKER_EDGE, WHITE), (2.0, color)] {
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

fn polygon(canvas: &mut Canvas, at: Point, radius: f64, shape: &[Point], color: Color) {
    // An edge of even width needs a radius that grows by width / cos(π/n).
    let edge = MARKER_EDGE / (std::f64::consts::PI / shape.len() as f64).cos();
    for (radius, color) in [(radius + edge, WHITE), (radius, color)] {
        let corners: Vec<Point> = shape
            .iter()
            .map(|(x, y)| (at.0 + x * radius, at.1 + y * radius))
            .collect();
        canvas.polygon(&corners, color, 1.0);
    }
}
