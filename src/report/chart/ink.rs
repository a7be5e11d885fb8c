//! What of a finished picture covers what it must not: measured on the shapes that are drawn, letters as they are outlined.

use std::fmt;

use tiny_skia::PathSegment;

use super::drawing::{Drawing, Paint, Shape};
use super::geometry::{Point, Rect, between, cross, distance_to_segment};
use super::layers::Layer;
use super::look::{MARK_RING, WHITE};

/// Two items of a picture of which one covers the other, or one that sticks out of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlap {
    /// The place in the picture of the chart that has them.
    pub chart: usize,
    pub item: String,
    /// `None`: the edge of the picture.
    pub other: Option<String>,
}

impl fmt::Display for Overlap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { item, other, .. } = self;
        match other {
            Some(other) => write!(f, "{item} and {other} overlap"),
            None => write!(f, "{item} is not whole in the picture"),
        }
    }
}

impl Drawing {
    /// Texts that cover one another, data, rings or leaders, or leave the picture; leaders that cross one another, rings or symbols;
    /// legends that cover data. Rings may lie over data and one another: both are where they are.
    pub fn overlaps(&self) -> Vec<Overlap> {
        let mut found = Vec::new();
        let mut shapes = &self.shapes[..];
        for (chart, (top, layers)) in self.layers.iter().enumerate() {
            let count = layers.iter().map(|(_, count)| count).sum::<usize>();
            let (own, rest) = shapes.split_at(count.min(shapes.len()));
            shapes = rest;
            let pieces = pieces(own, layers);
            let next = self.layers.get(chart + 1);
            let bottom = next.map_or(self.size.height_px, |(top, _)| *top);
            let picture = Rect {
                left: 0.0,
                top: f64::from(*top),
                right: f64::from(self.size.width_px),
                bottom: f64::from(bottom),
            };
            let mut add = |item: &Piece, other: Option<&Piece>| {
                found.push(Overlap {
                    chart,
                    item: item.name.clone(),
                    other: other.map(|other| other.name.clone()),
                });
            };
            for (place, piece) in pieces.iter().enumerate() {
                let [upper, lower] = [
                    (piece.bounds.left, piece.bounds.top),
                    (piece.bounds.right, piece.bounds.bottom),
                ];
                if piece.is_text() && !(picture.contains(upper) && picture.contains(lower)) {
                    add(piece, None);
                }
                for other in &pieces[..place] {
                    if piece.overlaps(other) {
                        add(piece, Some(other));
                    }
                }
            }
        }
        found
    }
}

/// Something drawn that may cover something else.
struct Piece {
    layer: Layer,
    name: String,
    bounds: Rect,
    /// Its edge, or its line.
    outline: Vec<(Point, Point)>,
    /// Half the width of its stroke.
    reach: f64,
}

impl Piece {
    fn of(layer: Layer, shape: &Shape) -> Option<Self> {
        let path = &shape.path;
        let bounds = path.bounds();
        let [left, top, right, bottom] =
            [bounds.left(), bounds.top(), bounds.right(), bounds.bottom()].map(f64::from);
        let reach = match shape.paint {
            Paint::Fill { .. } => 0.0,
            Paint::Stroke { width, .. } => width / 2.0,
        };
        let name = match &shape.text {
            Some(text) => format!("{layer:?} {:?}", text.label),
            None => format!("{layer:?}"),
        };
        // Of a text the box is enough.
        let outline = if shape.text.is_some() {
            Vec::new()
        } else {
            outline(path)
        };
        Some(Self {
            layer,
            name,
            bounds: Rect {
                left,
                top,
                right,
                bottom,
            },
            outline,
            reach,
        })
    }

    fn is_text(&self) -> bool {
        matches!(
            self.layer,
            Layer::Legend
                | Layer::MarkLabel
                | Layer::ContourLabel
                | Layer::TickLabel
                | Layer::Title
        )
    }

    fn overlaps(&self, other: &Self) -> bool {
        match (self.is_text(), other.is_text()) {
            (true, true) => self.bounds.overlaps(&other.bounds),
            (true, false) => self.covers(other),
            (false, true) => other.covers(self),
            (false, false) => self.crosses(other) || other.crosses(self),
        }
    }

    /// Whether a text covers a part of something drawn.
    fn covers(&self, other: &Self) -> bool {
        let bounds = self.bounds.grown(other.reach);
        let is_solid = matches!(other.layer, Layer::Fill | Layer::Marker) && other.reach == 0.0;
        let (x, y) = (
            (bounds.left + bounds.right) / 2.0,
            (bounds.top + bounds.bottom) / 2.0,
        );
        let right_of = |&&((x1, y1), (x2, y2)): &&(Point, Point)| {
            (y1 <= y) != (y2 <= y) && x < x1 + (y - y1) / (y2 - y1) * (x2 - x1)
        };
        other
            .outline
            .iter()
            .any(|&(from, to)| bounds.clip(from, to).is_some())
            || (is_solid && other.outline.iter().filter(right_of).count() % 2 == 1)
    }

    /// Whether a leader crosses another one, a ring or a symbol.
    fn crosses(&self, other: &Self) -> bool {
        if self.layer != Layer::Leader {
            return false;
        }
        let bounds = &other.bounds;
        let center = (
            (bounds.left + bounds.right) / 2.0,
            (bounds.top + bounds.bottom) / 2.0,
        );
        let is_near = |reach: f64| {
            self.outline
                .iter()
                .any(|&leader| distance_to_segment(center, leader) < reach)
        };
        match other.layer {
            Layer::Leader => self
                .outline
                .iter()
                .any(|&a| other.outline.iter().any(|&b| cross(a, b))),
            // Its own ring is where it begins.
            Layer::Ring => is_near(MARK_RING - 0.5),
            Layer::Marker => is_near(bounds.width() / 2.0),
            _ => false,
        }
    }
}

/// The pieces of the layers of a chart. A legend is one of them, whatever it is made of.
fn pieces(mut shapes: &[Shape], layers: &[(Layer, usize)]) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::new();
    for &(layer, count) in layers {
        let (of_layer, rest) = shapes.split_at(count.min(shapes.len()));
        shapes = rest;
        if matches!(layer, Layer::Ground | Layer::Dot) {
            continue;
        }
        // The white below a symbol parts it from what it stands on; that below a label is part of the label.
        let is_edge = |shape: &&Shape| match layer {
            Layer::Marker => shape.paint == Paint::fill(WHITE, 1.0),
            Layer::MarkLabel | Layer::ContourLabel => shape.text.is_none(),
            _ => false,
        };
        let found = of_layer
            .iter()
            .filter(|shape| !is_edge(shape))
            .filter_map(|shape| Piece::of(layer, shape));
        match layer {
            Layer::Legend => pieces.extend(found.reduce(|all, next| Piece {
                bounds: all.bounds.united(&next.bounds),
                name: all.name,
                ..next
            })),
            _ => pieces.extend(found),
        }
    }
    pieces
}

/// The segments of a path, in px; curves as four chords.
fn outline(path: &tiny_skia::Path) -> Vec<(Point, Point)> {
    let px = |point: tiny_skia::Point| (f64::from(point.x), f64::from(point.y));
    let mut found = Vec::new();
    let (mut start, mut at) = ((0.0, 0.0), (0.0, 0.0));
    let mut go = |from: Point, to: Point| {
        found.push((from, to));
        to
    };
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(to) => {
                start = px(to);
                at = start;
            }
            PathSegment::LineTo(to) => at = go(at, px(to)),
            PathSegment::QuadTo(by, to) => {
                at = go(at, px(by));
                at = go(at, px(to));
            }
            PathSegment::CubicTo(a, b, to) => {
                let [first, second, last] = [a, b, to].map(px);
                let begin = at;
                for part in [0.25, 0.5, 0.75, 1.0] {
                    let [p, q, r] = [(begin, first), (first, second), (second, last)]
                        .map(|(from, to)| between(from, to, part));
                    at = go(at, between(between(p, q, part), between(q, r, part), part));
                }
            }
            PathSegment::Close => at = go(at, start),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use crate::report::chart::{Axis, Chart, Color, Mark, Marker, Series, fitting_height_px};

    const WIDTHS_MM: [f64; 11] = [
        60.0, 65.0, 70.0, 75.0, 84.0, 90.0, 100.0, 120.0, 150.0, 174.0, 180.0,
    ];
    const SIZES_PT: [f64; 6] = [6.0, 7.0, 8.0, 9.0, 10.0, 12.0];

    /// Numbers from 0 to 1 that are the same in every run (a linear congruential generator of D. E. Knuth).
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) as f64 / f64::from(1_u32 << 31)
        }
    }

    /// Curves of loss over three to nine decades, with the peaks of the first one marked, near to one another and at the ends too.
    fn losses(curves: usize, peaks: usize, seed: u64) -> Chart {
        let mut random = Random(seed);
        let decades = 3.0 + 6.0 * random.next();
        let places: Vec<f64> = (0..peaks).map(|_| decades * random.next()).collect();
        let heights: Vec<f64> = (0..peaks).map(|_| 0.3 + random.next()).collect();
        let loss = |x: f64, scale: f64| -> f64 {
            let of = |(place, height): (&f64, &f64)| {
                let ratio = 10_f64.powf(x - place);
                scale * height * 2.0 * ratio / (1.0 + ratio * ratio)
            };
            places.iter().zip(&heights).map(of).sum()
        };
        let long = seed % 2 == 1;
        let y = if long {
            "energy loss per cycle of the whole contact / µJ"
        } else {
            "energy loss per cycle / µJ"
        };
        let mut chart = Chart::new(Axis::log("angular frequency ω / rad·s⁻¹"), Axis::linear(y));
        if seed.is_multiple_of(3) {
            chart = chart.title(
                "PMMA under a rigid sphere, the curves of all the amplitudes that were computed",
            );
        }
        for curve in 0..curves {
            let scale = 1.0 / (1.0 + curve as f64 * (0.1 + 0.5 * random.next()));
            let count = 13 + (60.0 * random.next()) as usize;
            let points: Vec<(f64, f64)> = (0..count)
                .map(|k| decades * k as f64 / (count - 1) as f64)
                .map(|x| (10_f64.powf(x - 5.0), loss(x, scale)))
                .collect();
            let errors: Vec<f64> = points.iter().map(|(_, loss)| 0.02 * loss).collect();
            let mut series = Series::line(points)
                .marker(Marker::nth(curve))
                .color(Color::of_family(curve, curves))
                .error_bars(errors);
            if curves > 1 {
                series = series.label(match long {
                    true => format!(
                        "amplitude of the approach {}.5 nm, temperature 2{curve} °C",
                        10 * curve
                    ),
                    false => format!("{curve}.5 N"),
                });
            }
            chart = chart.series(series);
        }
        let marks = places.iter().map(|&place| {
            let omega = 10_f64.powf(place - 5.0);
            Mark::point(
                omega,
                loss(place, 1.0),
                format!("ω = {:.2} × 10⁻³ rad/s", 1e3 * omega),
            )
        });
        chart.all_marks(marks)
    }

    /// What overlaps, by the pair of kinds, over all sizes; and how many pictures could not be drawn.
    #[test]
    fn nothing_covers_anything_at_any_size() {
        let mut found = std::collections::BTreeMap::new();
        let (mut pictures, mut faulty, mut undrawn) = (0, 0, 0);
        let mut first = None;
        let sizes = WIDTHS_MM
            .into_iter()
            .flat_map(|mm| SIZES_PT.map(|pt| (mm, pt)));
        for (place, (width_mm, pt)) in sizes.enumerate() {
            let px = |mm: f64| (mm / (pt * 25.4 / 72.0 / 16.0)) as u32;
            for count in 1..=8 {
                let seed = (place * 8 + count) as u64;
                // What is several at this size is one at the next.
                let (curves, peaks) = match (place + count) % 2 {
                    0 => (1, count),
                    _ => (count, 1 + count % 3),
                };
                let chart = losses(curves, peaks, seed).size(px(width_mm), px(0.75 * width_mm));
                pictures += 1;
                let Ok(height_px) = fitting_height_px(&chart) else {
                    undrawn += 1;
                    continue;
                };
                let drawing = chart.size(px(width_mm), height_px).draw().unwrap();
                let overlaps = drawing.overlaps();
                faulty += usize::from(!overlaps.is_empty());
                for overlap in overlaps {
                    let kind = |name: &str| name.split(' ').next().unwrap_or("").to_owned();
                    let other = overlap.other.as_deref().unwrap_or("edge");
                    *found.entry((kind(&overlap.item), kind(other))).or_insert(0) += 1;
                    let what = format!("{curves} curves, {peaks} peaks, seed {seed}: {overlap}");
                    first.get_or_insert(format!("{width_mm} mm, {pt} pt, {what}"));
                }
            }
        }
        assert!(
            found.is_empty() && undrawn == 0,
            "{pictures} pictures, {faulty} faulty, {undrawn} undrawn: {found:#?}; {first:?}"
        );
    }
}
