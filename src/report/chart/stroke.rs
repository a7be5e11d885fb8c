//! Lines cut to the frame and into dashes.

use super::LineStyle;
use super::geometry::{Point, Rect, between, distance};

/// The parts of a line inside `frame`, in order.
pub(super) fn clip(line: &[Point], frame: &Rect) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    for pair in line.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let Some((enter, leave)) = frame.clip(from, to) else {
            continue;
        };
        let (start, end) = (between(from, to, enter), between(from, to, leave));
        match parts.last_mut() {
            Some(part) if enter == 0.0 && part.last() == Some(&from) => part.push(end),
            _ => parts.push(vec![start, end]),
        }
        // A segment that ends inside must hand on its very end point, or the next one would not find it.
        if leave == 1.0
            && let Some(last) = parts.last_mut().and_then(|part| part.last_mut())
        {
            *last = to;
        }
    }
    parts
}

/// Lengths of stroke and gap in turn, in px; empty for a solid line.
fn pattern(style: LineStyle) -> &'static [f64] {
    match style {
        LineStyle::Solid => &[],
        LineStyle::Dashed => &[9.0, 5.0],
        LineStyle::DashDot => &[10.0, 3.8, 2.2, 3.8],
        LineStyle::Dotted => &[2.0, 3.2],
    }
}

/// The strokes of a line; the pattern runs on around the corners.
pub(super) fn dashes(line: &[Point], style: LineStyle) -> Vec<Vec<Point>> {
    let pattern = pattern(style);
    let (Some(&first_length), Some(&start)) = (pattern.first(), line.first()) else {
        return vec![line.to_vec()];
    };
    let mut strokes = Vec::new();
    let (mut place, mut left) = (0, first_length);
    let mut stroke = vec![start];
    for pair in line.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        let mut length = distance(from, to);
        while length > left {
            let cut = between(from, to, left / length);
            if place % 2 == 0 {
                stroke.push(cut);
                strokes.push(std::mem::take(&mut stroke));
            } else {
                stroke = vec![cut];
            }
            (from, length) = (cut, length - left);
            place = (place + 1) % pattern.len();
            left = pattern[place];
        }
        left -= length;
        if place % 2 == 0 {
            stroke.push(to);
        }
    }
    if stroke.len() > 1 {
        strokes.push(stroke);
    }
    strokes
}

/// The line without points that are less than `step` px from the one before, for tests of what lies where.
pub(super) fn thinned(line: &[Point], step: f64) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for (place, &point) in line.iter().enumerate() {
        let near = kept
            .last()
            .is_some_and(|&last| distance(last, point) < step);
        if !near || place + 1 == line.len() {
            kept.push(point);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = Rect {
        left: 0.0,
        top: 0.0,
        right: 10.0,
        bottom: 10.0,
    };

    #[test]
    fn a_line_inside_the_frame_is_kept_as_it_is() {
        let line = [(1.0, 1.0), (3.0, 7.0), (9.0, 2.0)];
        assert_eq!(clip(&line, &FRAME), [line.to_vec()]);
    }

    #[test]
    fn a_line_that_leaves_and_returns_comes_in_two_parts() {
        let line = [(1.0, 5.0), (5.0, 15.0), (9.0, 5.0)];
        assert_eq!(
            clip(&line, &FRAME),
            [vec![(1.0, 5.0), (3.0, 10.0)], vec![(7.0, 10.0), (9.0, 5.0)]]
        );
    }

    #[test]
    fn a_line_far_outside_disappears() {
        assert!(clip(&[(20.0, 1.0), (1e12, 1e12)], &FRAME).is_empty());
    }

    #[test]
    fn dashes_add_up_to_their_share_of_the_length() {
        let line: Vec<Point> = (0..=1400).map(|k| (f64::from(k) * 0.1, 0.0)).collect();
        let strokes = dashes(&line, LineStyle::Dashed);
        let inked: f64 = strokes
            .iter()
            .flat_map(|s| s.windows(2))
            .map(|p| distance(p[0], p[1]))
            .sum();
        assert_eq!(strokes.len(), 10);
        assert!((inked - 90.0).abs() < 1e-9); // ten strokes of 9 px in 140 px; rounding
    }

    #[test]
    fn a_solid_line_is_one_stroke() {
        let line = [(0.0, 0.0), (100.0, 0.0)];
        assert_eq!(dashes(&line, LineStyle::Solid), [line.to_vec()]);
    }

    #[test]
    fn thinning_keeps_both_ends() {
        let line: Vec<Point> = (0..=100).map(|k| (f64::from(k) * 0.1, 0.0)).collect();
        let kept = thinned(&line, 1.0);
        assert_eq!((kept.first(), kept.last()), (line.first(), line.last()));
        assert!(kept.len() < 15);
    }
}
