//! The contour lines of a map in px, with the value of each in a gap of its line.

use super::Chart;
use super::Color;
use super::contour;
use super::curves::Obstacles;
use super::geometry::{Point, Rect, between, distance};
use super::heat_map;
use super::layout::Layout;
use super::look::CONTOUR_TEXT;
use super::text::width_em;
use super::ticks;
use crate::report::number::range;

/// The lines of one value, and the labels of all.
#[derive(Debug, Default)]
pub(super) struct Contours {
    pub(super) lines: Vec<(Color, Vec<Vec<Point>>)>,
    pub(super) labels: Vec<ContourLabel>,
}

/// A value in a gap of its line.
#[derive(Debug)]
pub(super) struct ContourLabel {
    pub(super) rect: Rect,
    pub(super) text: String,
}

/// A line shorter than this many widths of its label has none: little of it would be left.
const LEAST_WIDTHS: f64 = 3.0;
/// Where along a line its label is looked for: in the middle first.
const PARTS: [f64; 9] = [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9];
/// Between a label and what it keeps clear of (px).
const CLEAR: f64 = 2.0;

impl Contours {
    /// Those of the map that the layout has, as far as it has one; labels keep clear of the obstacles.
    pub(super) fn of(chart: &Chart, layout: &Layout, obstacles: &Obstacles) -> Self {
        let bar = layout.bar.as_ref();
        let Some((bar, map)) = bar.and_then(|bar| Some((bar, bar.map.as_ref()?))) else {
            return Self::default();
        };
        if !map.contours {
            return Self::default();
        }
        // On the scale of the colours the values are closer to linear between the cells.
        let scaled = |value| map.value_scale.linearised(value);
        let values: Vec<Option<f64>> = map.values.iter().map(|v| v.map(scaled)).collect();
        let data = range(map.values.iter().flatten().copied());
        let named = ticks::of_contours(map.value_scale, bar.range, data, &bar.ticks.major);
        let px = |(x, y): Point| {
            let x = heat_map::along(&layout.x, x, map.columns);
            (x, heat_map::along(&layout.y, y, map.rows))
        };
        let lines = named.iter().map(|tick| {
            let lines = contour::lines(&values, map.columns, scaled(tick.value)).into_iter();
            lines
                .map(|line| line.into_iter().map(px).collect())
                .collect()
        });
        let mut lines: Vec<Vec<Vec<Point>>> = lines.collect();
        let mut labels: Vec<ContourLabel> = Vec::new();
        for (of_value, tick) in named.iter().enumerate() {
            let size = (
                width_em(&tick.label, &chart.typeface) * CONTOUR_TEXT + 4.0,
                1.15 * CONTOUR_TEXT,
            );
            let mut cut = Vec::new();
            for line in 0..lines[of_value].len() {
                let whole = lines[of_value][line].clone();
                let free = |rect: &Rect| {
                    let clear = rect.grown(CLEAR);
                    let others = lines.iter().enumerate().flat_map(|(value, of)| {
                        of.iter().enumerate().map(move |(k, l)| ((value, k), l))
                    });
                    let mut others = others.filter(|(place, _)| *place != (of_value, line));
                    layout.frame.grown(-CLEAR).holds(&clear)
                        && obstacles.spare(&clear)
                        && labels.iter().all(|label| !label.rect.overlaps(&clear))
                        && others.all(|(_, other)| !runs_through(other, &clear))
                };
                match place(&whole, size, free) {
                    Some(rect) => {
                        cut.extend(without(&whole, &rect));
                        let text = tick.label.clone();
                        labels.push(ContourLabel { rect, text });
                    }
                    None => cut.push(whole),
                }
            }
            lines[of_value] = cut;
        }
        let color = |value| heat_map::contrast(map.level(value, bar.range));
        let colors = named.iter().map(|tick| color(tick.value));
        Self {
            lines: colors.zip(lines).collect(),
            labels,
        }
    }
}

/// A box of this size about a point of the line, where it is free.
fn place(line: &[Point], size: (f64, f64), free: impl Fn(&Rect) -> bool) -> Option<Rect> {
    let lengths = line.windows(2).map(|pair| distance(pair[0], pair[1]));
    let length: f64 = lengths.sum();
    if length < LEAST_WIDTHS * size.0 {
        return None;
    }
    let boxes = PARTS.into_iter().map(|part| {
        let (x, y) = point_at(line, part * length);
        Rect::at(x - size.0 / 2.0, y - size.1 / 2.0, size.0, size.1)
    });
    boxes.into_iter().find(free)
}

/// The point of a line this far (px) from its beginning.
fn point_at(line: &[Point], mut way: f64) -> Point {
    for pair in line.windows(2) {
        let length = distance(pair[0], pair[1]);
        if way <= length {
            return between(pair[0], pair[1], way / length.max(1e-9));
        }
        way -= length;
    }
    line.last().copied().unwrap_or_default()
}

fn runs_through(line: &[Point], rect: &Rect) -> bool {
    line.windows(2)
        .any(|pair| rect.clip(pair[0], pair[1]).is_some())
}

/// The parts of a line outside a box.
fn without(line: &[Point], rect: &Rect) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = vec![line.first().copied().into_iter().collect()];
    for pair in line.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let mut reach = |point: Point| {
            parts
                .last_mut()
                .into_iter()
                .for_each(|part| part.push(point))
        };
        match rect.clip(from, to) {
            None => reach(to),
            Some((enter, leave)) => {
                reach(between(from, to, enter));
                parts.push(vec![between(from, to, leave), to]);
            }
        }
    }
    parts.retain(|part| {
        part.windows(2)
            .any(|pair| pair[0] != pair[1] && !rect.contains(between(pair[0], pair[1], 0.5)))
    });
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::arrange::arrange;
    use crate::report::chart::{Axis, Chart, HeatMap, MapShape};

    #[test]
    fn every_long_line_has_its_value_in_a_gap_and_labels_keep_off_one_another_and_rings() {
        let (columns, rows) = (64, 48);
        let at = |k: usize, n: usize| (k as f64 + 0.5) / n as f64;
        let value = |i: usize| Some(2.0 * at(i % columns, columns) + at(i / columns, rows));
        let map = HeatMap {
            columns,
            rows,
            values: (0..columns * rows).map(value).collect(),
            value_label: "value".to_owned(),
            contours: true,
            rings: vec![(0.25, 0.5)],
            shape: MapShape::Stretched,
            ..HeatMap::default()
        };
        let axis = |label| Axis::linear(label).range(0.0, 1.0);
        let chart = Chart::new(axis("x"), axis("y")).map(map);
        let arrangement = arrange(&chart).unwrap();
        let labels = &arrangement.contours.labels;
        assert!(labels.len() >= 3, "{labels:?}");
        for (place, label) in labels.iter().enumerate() {
            assert!(arrangement.layout.frame.holds(&label.rect));
            assert!(
                labels[..place]
                    .iter()
                    .all(|other| !other.rect.overlaps(&label.rect))
            );
            let lines = arrangement
                .contours
                .lines
                .iter()
                .flat_map(|(_, lines)| lines);
            assert!(
                lines
                    .clone()
                    .all(|line| !runs_through(line, &label.rect.grown(-0.1)))
            );
            // The value that stands there is that of the map there.
            let (x, y) = (
                label.rect.left + label.rect.right,
                label.rect.top + label.rect.bottom,
            );
            let frame = &arrangement.layout.frame;
            let part = (
                (x / 2.0 - frame.left) / frame.width(),
                (frame.bottom - y / 2.0) / frame.height(),
            );
            let there = 2.0 * part.0 + part.1;
            assert!(
                (there - label.text.parse::<f64>().unwrap()).abs() < 0.01,
                "{there} {label:?}"
            );
        }
        assert_eq!(chart.draw().unwrap().overlaps(), []);
    }
}
