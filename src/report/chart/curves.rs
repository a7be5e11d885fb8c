//! Where the data lie in the frame: every series in px, cut to the frame, for drawing and for keeping clear of.

use super::geometry::{Point, Rect, distance};
use super::layout::{Layout, Marked};
use super::look::{MARKER_EDGE, MARKER_RADIUS, MARKER_SPACING};
use super::stroke::{clip, thinned};
use super::{Chart, Series};

/// One series in px.
#[derive(Debug, Default)]
pub(super) struct Curve {
    /// The line, in as many parts as gaps and the frame cut it into.
    pub(super) parts: Vec<Vec<Point>>,
    /// The points that carry a marker; without markers, the points that have no neighbour to be joined with.
    pub(super) points: Vec<Point>,
    /// The filled area.
    pub(super) fills: Vec<Vec<Point>>,
    pub(super) error_bars: Vec<ErrorBar>,
}

/// An error bar in px; an end without a cap lies beyond the frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct ErrorBar {
    pub(super) x: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
    pub(super) caps: [bool; 2],
}

/// All series of the chart in px.
pub(super) fn curves(chart: &Chart, layout: &Layout) -> Vec<Curve> {
    chart
        .series
        .iter()
        .map(|series| curve(series, layout))
        .collect()
}

fn curve(series: &Series, layout: &Layout) -> Curve {
    let frame = &layout.frame;
    // A point on the frame must not be lost to rounding.
    let reach = frame.grown(0.01);
    let mut curve = Curve::default();
    for run in series.points.split(Option::is_none) {
        let line: Vec<Point> = run
            .iter()
            .flatten()
            .map(|&point| layout.px(point))
            .collect();
        if series.line.is_some() && series.curve.is_none() {
            curve.parts.extend(clip(&line, &reach));
        }
        // A point alone has no line.
        if series.marker.is_none() && series.line.is_some() && line.len() == 1 {
            let there = line.iter().copied().filter(|&point| reach.contains(point));
            curve.points.extend(there);
        }
        if series.closed {
            curve.fills.push(frame.clip_polygon(&line));
        }
        if let (Some(base), Some(first), Some(last)) = (series.area_to, line.first(), line.last()) {
            let base = layout.y.px(base);
            let outline: Vec<Point> = line
                .iter()
                .copied()
                .chain([(last.0, base), (first.0, base)])
                .collect();
            curve.fills.push(frame.clip_polygon(&outline));
        }
    }
    for run in series.curve.iter().flat_map(|c| c.split(Option::is_none)) {
        let line: Vec<Point> = run.iter().flatten().map(|&at| layout.px(at)).collect();
        curve.parts.extend(clip(&line, &reach));
    }
    let marked = match series.spaced {
        true => &spaced(&series.points, layout),
        false => &series.points,
    };
    if series.marker.is_some() {
        let markers = marked.iter().flatten().map(|&point| layout.px(point));
        curve
            .points
            .extend(markers.filter(|&point| reach.contains(point)));
    }
    if let Some(errors) = &series.error {
        let bars = marked
            .iter()
            .zip(errors)
            .filter_map(|(point, error)| {
                let ((x, y), error) = ((*point)?, (*error)?);
                error_bar(x, y, error, layout)
            })
            .filter(|bar| series.marker.is_none() || !hidden(bar));
        curve.error_bars.extend(bars);
    }
    curve
}

/// The points without those that stand too near to the one before.
fn spaced(points: &[Option<(f64, f64)>], layout: &Layout) -> Vec<Option<(f64, f64)>> {
    let mut before = None;
    let kept = |point: &Option<(f64, f64)>| {
        let at = layout.px((*point)?);
        if before.is_some_and(|before| distance(before, at) < MARKER_SPACING) {
            return None;
        }
        before = Some(at);
        *point
    };
    points.iter().map(kept).collect()
}

/// Whether a marker covers the bar: then its caps would stick out as stumps that say nothing.
fn hidden(bar: &ErrorBar) -> bool {
    bar.bottom - bar.top <= 2.0 * (MARKER_RADIUS + MARKER_EDGE)
}

fn error_bar(x: f64, y: f64, error: f64, layout: &Layout) -> Option<ErrorBar> {
    let frame = &layout.frame;
    let x = layout.x.px(x);
    // On a log axis the lower end may be at or below zero: then the bar runs out of the frame.
    let bottom = layout.y.lowest_px(y - error);
    let top = layout.y.px(y + error);
    let inside =
        (frame.left..=frame.right).contains(&x) && top <= frame.bottom && bottom >= frame.top;
    inside.then(|| ErrorBar {
        x,
        top: top.max(frame.top),
        bottom: bottom.min(frame.bottom),
        caps: [top >= frame.top, bottom <= frame.bottom],
    })
}

/// What a legend or a label should not cover.
#[derive(Debug, Default)]
pub(super) struct Obstacles {
    pub(super) segments: Vec<(Point, Point)>,
    pub(super) points: Vec<Point>,
    pub(super) boxes: Vec<Rect>,
}

/// Detail finer than this, in px, does not matter for what covers what.
const COARSE: f64 = 1.5;

impl Obstacles {
    /// The curves and marks of a chart.
    pub(super) fn of(chart: &Chart, layout: &Layout, curves: &[Curve]) -> Self {
        let mut all = Self::default();
        for curve in curves {
            for line in curve.parts.iter().chain(&curve.fills) {
                let line = thinned(line, COARSE);
                all.segments
                    .extend(line.windows(2).map(|pair| (pair[0], pair[1])));
            }
            all.points.extend(&curve.points);
            let bars = curve
                .error_bars
                .iter()
                .map(|bar| ((bar.x, bar.top), (bar.x, bar.bottom)));
            all.segments.extend(bars);
        }
        for mark in &chart.marks {
            match layout.marked(mark.place) {
                Marked::Point(point) => all.points.push(point),
                Marked::Line(from, to) => all.segments.push((from, to)),
            }
        }
        all
    }

    /// Whether nothing at all lies in the box.
    pub(super) fn spare(&self, rect: &Rect) -> bool {
        let wide = rect.grown(MARKER_RADIUS + MARKER_EDGE);
        self.covered(rect) == 0.0 && !self.points.iter().any(|&point| wide.contains(point))
    }

    /// How much lies in the box: length of lines in px, a marker counting as much as the line it stands for.
    pub(super) fn covered(&self, rect: &Rect) -> f64 {
        let wide = rect.grown(MARKER_RADIUS + MARKER_EDGE);
        let lines: f64 = self
            .segments
            .iter()
            .map(|&(from, to)| length_inside(rect, from, to))
            .sum();
        let points = self
            .points
            .iter()
            .filter(|&&point| wide.contains(point))
            .count();
        let boxes = self
            .boxes
            .iter()
            .filter(|other| other.overlaps(rect))
            .count();
        lines + 10.0 * points as f64 + 500.0 * boxes as f64
    }
}

fn length_inside(rect: &Rect, from: Point, to: Point) -> f64 {
    let beside = (from.0 < rect.left && to.0 < rect.left)
        || (from.0 > rect.right && to.0 > rect.right)
        || (from.1 < rect.top && to.1 < rect.top)
        || (from.1 > rect.bottom && to.1 > rect.bottom);
    if beside {
        return 0.0;
    }
    match rect.clip(from, to) {
        // A line that only touches counts as a little, so that "nothing" means nothing.
        Some((enter, leave)) => ((leave - enter) * distance(from, to)).max(0.1),
        None => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::draw::arrange;
    use crate::report::chart::{Axis, Chart};

    #[test]
    fn spaced_markers_keep_off_one_another_and_take_their_error_bars_along() {
        let points: Vec<(f64, f64)> = (0..=200).map(|k| (f64::from(k), 0.0)).collect();
        let all = Series::scatter(points.clone()).error_bars(vec![1.0; 201]);
        let chart = Chart::new(Axis::linear("x"), Axis::linear("y"))
            .series(all.clone())
            .series(all.spaced());
        let curves = arrange(&chart).unwrap().curves;
        assert_eq!(
            (curves[0].points.len(), curves[0].error_bars.len()),
            (201, 201)
        );
        let kept = &curves[1];
        assert_eq!(kept.points[0], curves[0].points[0]);
        assert_eq!(kept.points.len(), kept.error_bars.len());
        // Points are some 3 px apart: the next that is far enough is hardly further.
        for pair in kept.points.windows(2) {
            let apart = distance(pair[0], pair[1]);
            assert!(
                (MARKER_SPACING..MARKER_SPACING + 4.0).contains(&apart),
                "{apart}"
            );
        }
    }
}
