//! How the figures tell closed forms from computed points: lines against symbols, one symbol per engine, one colour and line
//! style per member of a family.

use crate::report::chart::{Color, LineStyle, Marker, Series};

/// A place in a family of curves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Member {
    pub(super) step: usize,
    pub(super) of: usize,
}

impl Member {
    fn color(self) -> Color {
        Color::Ramp {
            step: self.step,
            of: self.of,
        }
    }

    /// A closed form, or the exact solution in its place.
    pub(super) fn line<P: Into<Option<(f64, f64)>>>(self, points: Vec<P>) -> Series {
        Series::line(points)
            .color(self.color())
            .style(LineStyle::nth(self.step))
    }

    /// Points computed by the axisymmetric engine.
    pub(super) fn springs<P: Into<Option<(f64, f64)>>>(self, points: Vec<P>) -> Series {
        Series::scatter(points)
            .color(self.color())
            .marker(Marker::Cross)
    }

    /// Points computed by the half-space engine.
    pub(super) fn cells<P: Into<Option<(f64, f64)>>>(self, points: Vec<P>) -> Series {
        Series::scatter(points)
            .color(self.color())
            .marker(Marker::Ring)
    }

    /// Both, named in the legend where this is the last of the family.
    pub(super) fn engines<P: Into<Option<(f64, f64)>>>(
        self,
        springs: Vec<P>,
        cells: Vec<P>,
        side: usize,
    ) -> [Series; 2] {
        let (springs, cells) = (self.springs(springs), self.cells(cells));
        if self.step + 1 == self.of {
            [springs.label(SPRINGS), cells.label(cells_label(side))]
        } else {
            [springs, cells]
        }
    }
}

pub(super) const SPRINGS: &str = "axisymmetric engine";

/// The half-space engine with so many cells per side.
pub(super) fn cells_label(side: usize) -> String {
    format!("half-space engine, {side} × {side} cells")
}

/// About so many of the points, evenly spread, the first and the last among them.
pub(super) fn spread<T: Copy>(points: &[T], count: usize) -> Vec<T> {
    let last = points.len().saturating_sub(1);
    if points.len() <= count {
        return points.to_vec();
    }
    let parts = count.saturating_sub(1).max(1);
    (0..=parts)
        .filter_map(|k| points.get(k * last / parts).copied())
        .collect()
}

/// `parts + 1` values from `from` to `to`.
pub(super) fn evenly(from: f64, to: f64, parts: usize) -> Vec<f64> {
    (0..=parts)
        .map(|k| from + (to - from) * k as f64 / parts as f64)
        .collect()
}
