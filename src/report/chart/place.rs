//! Where the label of a mark goes: near it, inside the frame, and clear of curves, legend and other labels.

use super::curves::Obstacles;
use super::geometry::{Point, Rect, between, cross, distance};
use super::layout::{Layout, Widths};
use super::look::*;
use super::text::fitted_px;
use super::{Chart, MarkPlace};

/// A mark's label in its place.
#[derive(Clone, Debug)]
pub(super) struct PlacedLabel {
    /// The place of the mark in `chart.marks`.
    pub(super) mark: usize,
    /// The text with a little air around it.
    pub(super) rect: Rect,
    pub(super) text_px: f64,
    /// From the ring to the label.
    pub(super) leader: Option<(Point, Point)>,
}

/// Around the text of a label, in px.
pub(super) const AIR: f64 = 4.0;
/// Between a label and what it keeps clear of.
const CLEAR: f64 = 3.0;

/// Places the labels of all marks, those of points first because they have the least choice.
pub(super) fn labels(
    chart: &Chart,
    layout: &Layout,
    widths: &Widths,
    mut obstacles: Obstacles,
) -> Vec<PlacedLabel> {
    let marks = chart.marks.iter().enumerate();
    let mut order: Vec<_> = marks.filter(|(_, mark)| !mark.label.is_empty()).collect();
    order.sort_by_key(|(_, mark)| !matches!(mark.place, MarkPlace::Point { .. }));
    let inner = layout.frame.grown(-AIR);
    let mut placed = Vec::new();
    for (place, mark) in order {
        let width_em = widths.marks.get(place).copied().unwrap_or(0.0);
        let room = inner.width() - 2.0 * AIR;
        let text_px = fitted_px(MARK_TEXT, width_em, room);
        let size = (width_em * text_px + 2.0 * AIR, 1.15 * text_px + AIR);
        let candidates = match mark.place {
            MarkPlace::Point { x, y } => about_point(layout.px((x, y)), size),
            MarkPlace::Vertical { x } => {
                let (x, top) = (layout.x.px(x), inner.top + 4.0);
                along(inner.height() - size.1, 12.0, size, |down| {
                    [x + 4.0, x - 4.0 - size.0].map(|left| (left, top + down))
                })
            }
            MarkPlace::Horizontal { y } => {
                let (y, right) = (layout.y.px(y), inner.right - 4.0 - size.0);
                along(inner.width() - size.0, 16.0, size, |back| {
                    [y - 3.5 - size.1, y + 3.5].map(|top| (right - back, top))
                })
            }
        };
        let Some(best) = best(candidates, &inner, &obstacles) else {
            continue;
        };
        obstacles.boxes.push(best.rect);
        obstacles.segments.extend(best.leader);
        placed.push(PlacedLabel {
            mark: place,
            rect: best.rect,
            text_px,
            leader: best.leader,
        });
    }
    placed
}

/// A possible place, and what speaks against it before anything else is looked at.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    rect: Rect,
    anchor: Option<Point>,
    leader: Option<(Point, Point)>,
    cost: f64,
}

impl Candidate {
    fn at(corner: Point, (width, height): (f64, f64), cost: f64) -> Self {
        Self {
            rect: Rect::at(corner.0, corner.1, width, height),
            anchor: None,
            leader: None,
            cost,
        }
    }
}

fn about_point(center: Point, (width, height): (f64, f64)) -> Vec<Candidate> {
    let mut all = Vec::new();
    for reach in [
        18.0, 26.0, 36.0, 50.0, 68.0, 90.0, 120.0, 160.0, 210.0, 270.0,
    ] {
        for step in 0..24 {
            let angle = f64::from(step) * std::f64::consts::TAU / 24.0;
            let (sin, cos) = angle.sin_cos();
            // The box lies beyond a circle of radius `reach`, seen from its middle or its near corner.
            let middle = (
                center.0 + cos * (reach + width / 2.0),
                center.1 - sin * (reach + height / 2.0),
            );
            // Above is where a peak's label is looked for, the right where one reads on.
            let bias = 5.0 * (1.0 - sin) + 2.0 * (1.0 - cos);
            let corner = (middle.0 - width / 2.0, middle.1 - height / 2.0);
            all.push(Candidate {
                anchor: Some(center),
                ..Candidate::at(corner, (width, height), 0.35 * reach + bias)
            });
        }
    }
    all
}

/// Places on both sides of a line, step by step along it: the first of each step is the better one.
fn along(
    length: f64,
    step_px: f64,
    size: (f64, f64),
    at: impl Fn(f64) -> [Point; 2],
) -> Vec<Candidate> {
    let steps = (length / step_px).max(0.0) as usize;
    let of_step = |step: usize| {
        let (corners, cost) = (at(step_px * step as f64), 0.5 * step as f64);
        let sides = corners.into_iter().zip([0.0, 1.0]);
        sides.map(move |(corner, bias)| Candidate::at(corner, size, cost + bias))
    };
    (0..=steps).flat_map(of_step).collect()
}

/// The candidate with the least against it, moved into the frame where it stuck out.
fn best(candidates: Vec<Candidate>, inner: &Rect, obstacles: &Obstacles) -> Option<Candidate> {
    let mut best: Option<Candidate> = None;
    for mut candidate in candidates {
        let moved = candidate.rect.moved_into(inner);
        candidate.cost += 0.3
            * distance(
                (moved.left, moved.top),
                (candidate.rect.left, candidate.rect.top),
            );
        candidate.rect = moved;
        if let Some(center) = candidate.anchor {
            candidate.leader = leader(center, &moved);
            if candidate.leader.is_none() {
                candidate.cost += 300.0; // it would cover its own ring
            }
        }
        let beaten = |cost: f64| best.as_ref().is_some_and(|best| best.cost <= cost);
        if beaten(candidate.cost) {
            continue;
        }
        candidate.cost += 4.0 * obstacles.covered(&moved.grown(CLEAR));
        if beaten(candidate.cost) {
            continue;
        }
        candidate.cost += candidate
            .leader
            .map_or(0.0, |leader| crossed(leader, obstacles));
        if !beaten(candidate.cost) {
            best = Some(candidate);
        }
    }
    best
}

/// From the ring to the nearest point of the label; `None` where the label would cover the ring.
fn leader(center: Point, rect: &Rect) -> Option<(Point, Point)> {
    let end = rect.nearest(center);
    let length = distance(center, end);
    (length > MARK_RING + 2.0).then(|| (between(center, end, MARK_RING / length), end))
}

fn crossed(leader: (Point, Point), obstacles: &Obstacles) -> f64 {
    let lines = obstacles
        .segments
        .iter()
        .filter(|&&segment| cross(leader, segment))
        .count();
    let boxes = obstacles
        .boxes
        .iter()
        .filter(|rect| rect.clip(leader.0, leader.1).is_some())
        .count();
    let near = |point: &Point| {
        let length = distance(leader.0, leader.1);
        let along = ((point.0 - leader.0.0) * (leader.1.0 - leader.0.0)
            + (point.1 - leader.0.1) * (leader.1.1 - leader.0.1))
            / length;
        (0.0..=length).contains(&along)
            && distance(*point, between(leader.0, leader.1, along / length)) < MARKER_RADIUS + 2.0
    };
    let points = obstacles.points.iter().filter(|point| near(point)).count();
    30.0 * (lines + points) as f64 + 500.0 * boxes as f64
}
