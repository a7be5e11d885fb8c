//! Points, boxes and segments in px, y downwards.

/// `(x, y)` in px at scale 1.
pub(super) type Point = (f64, f64);

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Rect {
    pub(super) fn at(left: f64, top: f64, width: f64, height: f64) -> Self {
        Self {
            left,
            top,
            right: left + width,
            bottom: top + height,
        }
    }

    /// Clockwise from the upper left.
    pub(super) fn corners(&self) -> [Point; 4] {
        let (left, top, right, bottom) = (self.left, self.top, self.right, self.bottom);
        [(left, top), (right, top), (right, bottom), (left, bottom)]
    }

    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// Grown by `by` on every side; shrunk where `by` is negative.
    pub(super) fn grown(&self, by: f64) -> Self {
        Self {
            left: self.left - by,
            top: self.top - by,
            right: self.right + by,
            bottom: self.bottom + by,
        }
    }

    pub(super) fn contains(&self, (x, y): Point) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    /// Whether the other box is within this one.
    pub(super) fn holds(&self, other: &Rect) -> bool {
        self.contains((other.left, other.top)) && self.contains((other.right, other.bottom))
    }

    pub(super) fn overlaps(&self, other: &Rect) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    /// The smallest box that holds both.
    pub(super) fn united(&self, other: &Rect) -> Self {
        Self {
            left: self.left.min(other.left),
            top: self.top.min(other.top),
            right: self.right.max(other.right),
            bottom: self.bottom.max(other.bottom),
        }
    }

    /// The point of the box nearest to `point`.
    pub(super) fn nearest(&self, (x, y): Point) -> Point {
        (
            x.max(self.left).min(self.right),
            y.max(self.top).min(self.bottom),
        )
    }

    /// The same box moved by the least that brings it inside `outer`; a box too large keeps to the left and the top.
    pub(super) fn moved_into(&self, outer: &Rect) -> Self {
        let left = self.left.min(outer.right - self.width()).max(outer.left);
        let top = self.top.min(outer.bottom - self.height()).max(outer.top);
        Self::at(left, top, self.width(), self.height())
    }

    /// The part of the segment inside the box, as fractions of its length (Liang and Barsky 1984). `None`: no part.
    pub(super) fn clip(&self, from: Point, to: Point) -> Option<(f64, f64)> {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let edges = [
            (-dx, from.0 - self.left),
            (dx, self.right - from.0),
            (-dy, from.1 - self.top),
            (dy, self.bottom - from.1),
        ];
        for (slope, distance) in edges {
            if slope == 0.0 {
                if distance < 0.0 {
                    return None;
                }
            } else if slope < 0.0 {
                enter = enter.max(distance / slope);
            } else {
                leave = leave.min(distance / slope);
            }
        }
        (enter <= leave).then_some((enter, leave))
    }

    /// The part of a polygon inside the box (Sutherland and Hodgman 1974).
    pub(super) fn clip_polygon(&self, corners: &[Point]) -> Vec<Point> {
        // How far inside each of the four edges a point lies.
        let depths: [&dyn Fn(Point) -> f64; 4] = [
            &|(x, _)| x - self.left,
            &|(x, _)| self.right - x,
            &|(_, y)| y - self.top,
            &|(_, y)| self.bottom - y,
        ];
        let mut kept = corners.to_vec();
        for depth in depths {
            let Some(&last) = kept.last() else { break };
            let mut from = last;
            let mut next = Vec::with_capacity(kept.len() + 2);
            for to in kept {
                let (before, after) = (depth(from), depth(to));
                if (before < 0.0) != (after < 0.0) {
                    next.push(between(from, to, before / (before - after)));
                }
                if after >= 0.0 {
                    next.push(to);
                }
                from = to;
            }
            kept = next;
        }
        kept
    }
}

pub(super) fn between(from: Point, to: Point, part: f64) -> Point {
    (
        from.0 + (to.0 - from.0) * part,
        from.1 + (to.1 - from.1) * part,
    )
}

pub(super) fn distance(from: Point, to: Point) -> f64 {
    (to.0 - from.0).hypot(to.1 - from.1)
}

/// From a point to the nearest of a segment.
pub(super) fn distance_to_segment(point: Point, (from, to): (Point, Point)) -> f64 {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let along = (point.0 - from.0) * dx + (point.1 - from.1) * dy;
    let part = along / (dx * dx + dy * dy).max(f64::MIN_POSITIVE);
    distance(point, between(from, to, part.clamp(0.0, 1.0)))
}

/// Whether the two segments cross.
pub(super) fn cross(a: (Point, Point), b: (Point, Point)) -> bool {
    let side = |p: Point, q: Point, r: Point| (q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0);
    side(a.0, a.1, b.0) * side(a.0, a.1, b.1) < 0.0
        && side(b.0, b.1, a.0) * side(b.0, b.1, a.1) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Rect = Rect {
        left: 0.0,
        top: 0.0,
        right: 1.0,
        bottom: 1.0,
    };

    #[test]
    fn a_segment_through_the_box_is_cut_at_both_edges() {
        assert_eq!(UNIT.clip((-1.0, 0.5), (3.0, 0.5)), Some((0.25, 0.5)));
    }

    #[test]
    fn a_segment_beside_the_box_has_no_part_inside() {
        assert_eq!(UNIT.clip((-1.0, 2.0), (3.0, 2.0)), None);
        assert_eq!(UNIT.clip((2.0, 0.5), (3.0, 0.5)), None);
        // Its bounding box overlaps the unit box, the segment itself passes the corner.
        assert_eq!(UNIT.clip((-1.0, 0.5), (0.5, 2.0)), None);
    }

    #[test]
    fn a_box_is_moved_no_further_than_needed() {
        let moved = Rect::at(0.9, -0.3, 0.2, 0.2).moved_into(&UNIT);
        let expected = Rect::at(0.8, 0.0, 0.2, 0.2);
        assert!(moved.grown(1e-12).contains((expected.left, expected.top))); // rounding of 1 - 0.2
        assert!(expected.grown(1e-12).contains((moved.right, moved.bottom)));
        assert_eq!(
            Rect::at(0.1, 0.1, 0.2, 0.2).moved_into(&UNIT),
            Rect::at(0.1, 0.1, 0.2, 0.2)
        );
    }

    #[test]
    fn a_polygon_is_cut_to_the_box() {
        let diamond = [(0.5, -0.5), (1.5, 0.5), (0.5, 1.5), (-0.5, 0.5)];
        // Its edges pass the corners of the box, so the whole box is left.
        let cut = UNIT.clip_polygon(&diamond);
        let area: f64 = cut
            .iter()
            .zip(cut.iter().cycle().skip(1))
            .map(|(a, b)| a.0 * b.1 - b.0 * a.1)
            .sum::<f64>()
            / 2.0;
        assert!((area.abs() - 1.0).abs() < 1e-12); // rounding
        assert!(
            UNIT.clip_polygon(&[(2.0, 2.0), (3.0, 2.0), (3.0, 3.0)])
                .is_empty()
        );
    }

    #[test]
    fn crossing_segments_are_told_from_apart_ones() {
        assert!(cross(((0.0, 0.0), (1.0, 1.0)), ((0.0, 1.0), (1.0, 0.0))));
        assert!(!cross(((0.0, 0.0), (1.0, 1.0)), ((2.0, 1.0), (3.0, 0.0))));
    }
}
