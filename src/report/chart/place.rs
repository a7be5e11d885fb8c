//! Where the label of a mark goes: near it, inside the frame, and clear of curves, legend and other labels.

use super::curves::Obstacles;
use super::geometry::{Point, Rect, between, cross, distance};
use super::layout::{Layout, Widths};
use super::look::*;
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
    let is_point = |place: usize| matches!(chart.marks[place].place, MarkPlace::Point { .. });
    let mut order: Vec<usize> = (0..chart.marks.len())
        .filter(|&place| {
            chart.marks[place]
                .label
                .as_ref()
                .is_some_and(|label| !label.is_empty())
        })
        .collect();
    order.sort_by_key(|&place| !is_point(place));
    let inner = layout.frame.grown(-AIR);
    let mut placed = Vec::new();
    for place in order {
        let width_em = widths.marks.get(place).copied().unwrap_or(0.0);
        let room = inner.width() - 2.0 * AIR;
        let text_px = if width_em * MARK_TEXT > room {
            room / width_em
        } else {
            MARK_TEXT
        };
        let size = (width_em * text_px + 2.0 * AIR, 1.15 * text_px + AIR);
        let candidates = match chart.marks[place].place {
            MarkPlace::Point { x, y } => about_point(layout.px((x, y)), size),
            MarkPlace::Vertical { x } => along_vertical(layout.x.px(x), &inner, size),
            MarkPlace::Horizontal { y } => along_horizontal(layout.y.px(y), &inner, size),
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

fn along_vertical(x: f64, inner: &Rect, (width, height): (f64, f64)) -> Vec<Candidate> {
    let mut all = Vec::new();
    let rows = ((inner.height() - height) / 12.0).max(0.0) as usize;
    for row in 0..=rows {
        let top = inner.top + 4.0 + 12.0 * row as f64;
        for (left, bias) in [(x + 4.0, 0.0), (x - 4.0 - width, 1.0)] {
            let cost = 0.5 * row as f64 + bias;
            all.push(Candidate::at((left, top), (width, height), cost));
        }
    }
    all
}

fn along_horizontal(y: f64, inner: &Rect, (width, height): (f64, f64)) -> Vec<Candidate> {
    let mut all = Vec::new();
    let columns = ((inner.width() - width) / 16.0).max(0.0) as usize;
    for column in 0..=columns {
        let left = inner.right - 4.0 - width - 16.0 * column as f64;
        for (top, bias) in [(y - 3.5 - height, 0.0), (y + 3.5, 1.0)] {
            let cost = 0.5 * column as f64 + bias;
            all.push(Candidate::at((left, top), (width, height), cost));
        }
    }
    all
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
