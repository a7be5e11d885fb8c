//! Contour lines of values on a grid: marching squares between the centres of the cells (W. E. Lorensen and H. E. Cline,
//! Computer Graphics 21(4) (1987) 163, in two dimensions).

use std::collections::BTreeMap;

use super::geometry::Point;

/// The lines on which the values reach `level`, each from end to end, in units of cells as of [`segments`].
pub(super) fn lines(values: &[Option<f64>], columns: usize, level: f64) -> Vec<Vec<Point>> {
    let segments = segments(values, columns, level);
    // Two squares find the point on the side between them to rounding.
    let key = |(x, y): Point| [x, y].map(|of| (1e6 * of).round() as i64);
    let mut at: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    for (place, (from, to)) in segments.iter().enumerate() {
        for end in [from, to] {
            at.entry(key(*end)).or_default().push(place);
        }
    }
    let mut is_used = vec![false; segments.len()];
    let mut go_on = |line: &mut Vec<Point>| {
        while let Some(&last) = line.last() {
            let next = at.get(&key(last)).into_iter().flatten();
            let Some(&next) = next.into_iter().find(|&&next| !is_used[next]) else {
                break;
            };
            is_used[next] = true;
            let (from, to) = segments[next];
            line.push(if key(from) == key(last) { to } else { from });
        }
    };
    let mut lines = Vec::new();
    for (from, _) in &segments {
        // Both ways from the middle of an open line; once around a closed one.
        let (mut back, mut line) = (vec![*from], vec![*from]);
        go_on(&mut line);
        go_on(&mut back);
        back.reverse();
        back.pop();
        back.extend(line);
        if back.len() > 1 {
            lines.push(back);
        }
    }
    lines
}

/// Segments of the line on which the values reach `level`, in units of cells: the centre of the first cell is (0.5, 0.5).
/// `values` are row by row, x fastest; nothing is drawn beside a blank.
fn segments(values: &[Option<f64>], columns: usize, level: f64) -> Vec<(Point, Point)> {
    let mut found = Vec::new();
    let rows = values.len() / columns.max(1);
    for row in 0..rows.saturating_sub(1) {
        for column in 0..columns.saturating_sub(1) {
            let at = |dx: usize, dy: usize| values[(row + dy) * columns + column + dx];
            if let [Some(a), Some(b), Some(c), Some(d)] = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)] {
                let origin = (column as f64 + 0.5, row as f64 + 0.5);
                in_square([a, b, c, d], level, origin, &mut found);
            }
        }
    }
    found
}

/// Corners in the order around a square of unit side.
const CORNERS: [Point; 4] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];

fn in_square(values: [f64; 4], level: f64, origin: Point, found: &mut Vec<(Point, Point)>) {
    let mut crossings: [Option<Point>; 4] = [None; 4];
    for (side, crossing) in crossings.iter_mut().enumerate() {
        let next = (side + 1) % 4;
        let (from, to) = (values[side] - level, values[next] - level);
        if (from < 0.0) != (to < 0.0) {
            let part = from / (from - to);
            let (start, end) = (CORNERS[side], CORNERS[next]);
            *crossing = Some((
                origin.0 + start.0 + part * (end.0 - start.0),
                origin.1 + start.1 + part * (end.1 - start.1),
            ));
        }
    }
    match crossings {
        [Some(a), Some(b), Some(c), Some(d)] => {
            // A saddle: the mean says which corners are connected.
            let mean = values.iter().sum::<f64>() / 4.0;
            if (mean < level) == (values[0] < level) {
                found.extend([(a, b), (c, d)]);
            } else {
                found.extend([(d, a), (b, c)]);
            }
        }
        _ => {
            let mut ends = crossings.into_iter().flatten();
            found.extend(ends.next().zip(ends.next()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(columns: usize, rows: usize, value: impl Fn(f64, f64) -> f64) -> Vec<Option<f64>> {
        (0..columns * rows)
            .map(|i| {
                let (x, y) = ((i % columns) as f64 + 0.5, (i / columns) as f64 + 0.5);
                Some(value(x, y))
            })
            .collect()
    }

    #[test]
    fn the_contour_of_a_cone_is_a_circle() {
        let values = grid(60, 60, |x, y| (x - 30.0).hypot(y - 30.0));
        let lines = segments(&values, 60, 20.0);
        let length: f64 = lines
            .iter()
            .map(|(a, b)| (a.0 - b.0).hypot(a.1 - b.1))
            .sum();
        // Chords of at most sqrt(2) in a circle of radius 20 are short by (1.4/20)^2/24.
        assert!(
            (length / (40.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3,
            "{length}"
        );
        for (x, y) in lines.iter().flat_map(|(a, b)| [*a, *b]) {
            // Linear between cells: short of the circle by at most 1/(8 * 20).
            assert!(((x - 30.0).hypot(y - 30.0) - 20.0).abs() < 7e-3);
        }
    }

    #[test]
    fn segments_are_joined_to_whole_lines() {
        let cone = grid(60, 60, |x, y| (x - 30.0).hypot(y - 30.0));
        let closed = lines(&cone, 60, 20.0);
        assert_eq!(closed.len(), 1);
        assert_eq!(closed[0].len(), segments(&cone, 60, 20.0).len() + 1);
        let (first, last) = (closed[0][0], closed[0][closed[0].len() - 1]);
        assert!((first.0 - last.0).hypot(first.1 - last.1) < 1e-6);
        // Two valleys in which the level is reached twice each.
        let wave = grid(40, 5, |x, _| (x * 0.35).sin());
        let open = lines(&wave, 40, 0.31);
        assert!(
            open.len() >= 4 && open.iter().all(|line| line.len() == 5),
            "{open:?}"
        );
    }

    #[test]
    fn a_saddle_has_two_lines_that_do_not_cross() {
        let lines = segments(&[Some(1.0), Some(0.0), Some(0.0), Some(1.0)], 2, 0.4);
        assert_eq!(lines.len(), 2);
        let middle = |line: &(Point, Point)| 0.5 * (line.0.0 + line.1.0);
        // The two high corners are connected: each line cuts off a low one, at the right and at the left.
        assert!((middle(&lines[0]) - 1.0).abs() > 0.1 && (middle(&lines[1]) - 1.0).abs() > 0.1);
    }

    #[test]
    fn nothing_is_drawn_beside_a_blank() {
        let mut values = grid(3, 3, |x, _| x);
        values[4] = None;
        assert!(segments(&values, 3, 1.0).is_empty());
        assert!(segments(&[], 0, 1.0).is_empty());
    }
}
