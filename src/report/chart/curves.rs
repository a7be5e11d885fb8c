//! Where the data lie in the frame: every series in px, cut to the frame, for drawing and for keeping clear of.

use super::geometry::{Point, Rect, distance, distance_to_segment};
use super::layout::{Layout, Marked};
use super::look::{ERROR_CAP, MARK_RING, MARK_STROKE, MARKER_EDGE, MARKER_RADIUS, MARKER_SPACING};
use super::stroke::{clip, thinned};
use super::{Chart, Series};

/// One series in px.
#[derive(Debug, Default)]
pub(super) struct Curve {
    /// The line, in as many parts as gaps and the frame cut it into.
    pub(super) parts: Vec<Vec<Point>>,
    /// The points that carry a marker; without markers, the points that have no neighbour to be joined with.
    pub(super) points: Vec<Point>,
    /// The width of the white edge of its markers: none where they crowd, which would hide what they stand on.
    pub(super) edge: f64,
    /// Whether markers of a line were left out, because they crowd.
    pub(super) is_thinned: bool,
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
    let crowds = series.marker.is_some() && crowds(&series.points, layout);
    let spacing = match (series.spaced, crowds && series.line.is_some()) {
        (true, _) => MARKER_SPACING,
        (false, true) => THINNED_SPACING,
        (false, false) => 0.0,
    };
    let marked = spaced(&series.points, spacing, layout);
    curve.edge = if crowds && spacing == 0.0 {
        0.0
    } else {
        MARKER_EDGE
    };
    if series.marker.is_some() {
        let is_there = |point: &Option<_>| point.is_some();
        let [all, some] =
            [&series.points, &marked].map(|of| of.iter().filter(|p| is_there(p)).count());
        curve.is_thinned = series.line.is_some() && some < all;
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

/// Markers nearer to one another than this crowd: 1.3 times their size.
const CROWDED: f64 = 1.3 * 2.0 * MARKER_RADIUS;
/// From one marker of a line that crowded to the next: as much of the line is seen between them.
const THINNED_SPACING: f64 = 4.0 * MARKER_RADIUS;

/// Whether more than a quarter of the markers stand too near to the one before.
fn crowds(points: &[Option<(f64, f64)>], layout: &Layout) -> bool {
    let pairs = points
        .windows(2)
        .filter_map(|pair| Some((pair[0]?, pair[1]?)));
    let apart = pairs.map(|(from, to)| distance(layout.px(from), layout.px(to)));
    let (near, all) = apart.fold((0, 0), |(near, all), apart| {
        (near + usize::from(apart < CROWDED), all + 1)
    });
    4 * near > all
}

/// The points without those that stand nearer than this (px) to the one before that is kept.
fn spaced(points: &[Option<(f64, f64)>], spacing: f64, layout: &Layout) -> Vec<Option<(f64, f64)>> {
    let mut before = None;
    let kept = |point: &Option<(f64, f64)>| {
        let at = layout.px((*point)?);
        if before.is_some_and(|before| distance(before, at) < spacing) {
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

/// What a legend or a label must not cover.
#[derive(Debug, Default)]
pub(super) struct Obstacles {
    pub(super) segments: Vec<(Point, Point)>,
    /// Markers.
    pub(super) points: Vec<Point>,
    /// Rings of marks and of maps, by their middles.
    pub(super) rings: Vec<Point>,
    /// Outlines of areas.
    areas: Vec<Vec<Point>>,
    pub(super) boxes: Vec<Rect>,
}

/// Detail finer than this, in px, does not matter for what covers what.
const COARSE: f64 = 1.5;
/// What a marker and a ring take up about their middles.
const MARKER_REACH: f64 = 1.45 * MARKER_RADIUS + MARKER_EDGE;
const RING_REACH: f64 = MARK_RING + MARK_STROKE / 2.0;

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
            all.areas.extend(curve.fills.iter().cloned());
            all.points.extend(&curve.points);
            for ErrorBar { x, top, bottom, .. } in &curve.error_bars {
                let cap = |y: f64| ((x - ERROR_CAP, y), (x + ERROR_CAP, y));
                let upright = ((*x, *top), (*x, *bottom));
                all.segments.extend([upright, cap(*top), cap(*bottom)]);
            }
        }
        for mark in &chart.marks {
            match layout.marked(mark.place) {
                Marked::Point(point) => all.rings.push(point),
                Marked::Line(from, to) => all.segments.push((from, to)),
            }
        }
        if let Some(map) = &chart.map {
            all.rings
                .extend(map.rings.iter().map(|&ring| layout.px(ring)));
        }
        all
    }

    /// Whether nothing at all lies in the box.
    pub(super) fn spare(&self, rect: &Rect) -> bool {
        let is_off = |point: &Point, reach: f64| distance(rect.nearest(*point), *point) >= reach;
        let corner = (rect.left, rect.top);
        self.boxes.iter().all(|other| !other.overlaps(rect))
            && self.rings.iter().all(|point| is_off(point, RING_REACH))
            && self.points.iter().all(|point| is_off(point, MARKER_REACH))
            && self.segments.iter().all(|&(from, to)| rect.clip(from, to).is_none())
            // No edge runs through the box: it is in the area or beside it as a whole.
            && !self.areas.iter().any(|area| is_inside(corner, area))
    }

    /// Whether a leader runs clear of markers, of boxes and of rings but that from which it comes.
    pub(super) fn let_through(&self, leader: (Point, Point), ring: Point) -> bool {
        let is_off = |point: &Point, reach: f64| distance_to_segment(*point, leader) >= reach;
        let mut others = self.rings.iter().filter(|other| **other != ring);
        others.all(|other| is_off(other, RING_REACH))
            && self.points.iter().all(|point| is_off(point, MARKER_REACH))
            && self
                .boxes
                .iter()
                .all(|rect| rect.grown(2.0).clip(leader.0, leader.1).is_none())
    }
}

/// Whether a point is within a closed outline: whether a ray from it to the right crosses the outline an odd number of times.
fn is_inside((x, y): Point, outline: &[Point]) -> bool {
    let next = outline.iter().cycle().skip(1);
    let crossed = outline.iter().zip(next).filter(|((x1, y1), (x2, y2))| {
        (*y1 <= y) != (*y2 <= y) && x < x1 + (y - y1) / (y2 - y1) * (x2 - x1)
    });
    crossed.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::arrange::arrange;
    use crate::report::chart::{Axis, Chart, Marker};

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
        // Symbols that crowd have no white edge: it would hide those before.
        assert_eq!((curves[0].edge, curves[1].edge), (0.0, MARKER_EDGE));
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

    #[test]
    fn symbols_of_a_line_that_crowd_are_thinned_and_the_line_goes_through_all_points() {
        let curve = |count: u32| {
            let points = (0..=count).map(|k| (f64::from(k), 0.0));
            let series = Series::line(points).marker(Marker::Disc);
            let chart = Chart::new(Axis::linear("x"), Axis::linear("y")).series(series);
            let is_said = chart.draw().unwrap().is_thinned();
            (arrange(&chart).unwrap().curves.remove(0), is_said)
        };
        let (sparse, is_said) = curve(40);
        assert_eq!(
            (sparse.points.len(), sparse.is_thinned, is_said),
            (41, false, false)
        );
        let (dense, is_said) = curve(120);
        assert!(dense.is_thinned && is_said && dense.points.len() < 61);
        assert_eq!(dense.parts[0].len(), 121);
        let near = dense
            .points
            .windows(2)
            .map(|pair| distance(pair[0], pair[1]));
        assert!(near.fold(f64::INFINITY, f64::min) >= THINNED_SPACING);
    }
}
