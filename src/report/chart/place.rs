//! Where the labels of marks go: near them, inside the frame, and clear of all that is drawn and of one another.
//!
//! Every label has its possible places, cheapest first, that keep clear of data, rings and the legend. A search with backtracking takes
//! one of each, so that labels and leaders keep clear of one another, and of all such choices the cheapest. A label that has no
//! place is a number there, which the caption explains; where even a number has no place, the mark stands alone.

use super::curves::Obstacles;
use super::geometry::{Point, Rect, between, cross, distance};
use super::layout::{Layout, Widths};
use super::look::*;
use super::text::{fitted_px, width_em};
use super::titles::LEAST_SHARE_OF_SIZE;
use super::{Chart, Mark, MarkPlace};

/// A mark's label in its place.
#[derive(Clone, Debug)]
pub(super) struct PlacedLabel {
    /// The place of the mark in `chart.marks`.
    pub(super) mark: usize,
    /// The text with a little air around it.
    pub(super) rect: Rect,
    /// The label, or a number in its place.
    pub(super) text: String,
    pub(super) number: Option<usize>,
    pub(super) text_px: f64,
    /// From the ring to the label.
    pub(super) leader: Option<(Point, Point)>,
}

/// Around the text of a label, in px.
pub(super) const AIR: f64 = 4.0;
/// Between a label and what it keeps clear of.
const CLEAR: f64 = 3.0;
/// A leader this short (px) says nothing that the place of the label does not.
const SHORT_LEADER: f64 = 3.0;
/// Possible places of a label that the search looks at, and combinations that it looks at before it takes the best so far.
const MOST_PLACES: usize = 80;
const MOST_COMBINATIONS: usize = 100_000;
/// What a number costs against a label, and a mark that stands alone against a number: more than any place.
const NUMBERED: f64 = 1e4;
const ALONE: f64 = 1e6;

/// The labels of all marks that have one, as far as they have a place; the numbers begin with `first_number` at the highest mark.
pub(super) fn labels(
    chart: &Chart,
    layout: &Layout,
    widths: &Widths,
    obstacles: &Obstacles,
    first_number: usize,
) -> Vec<PlacedLabel> {
    let has_label = |(_, mark): &(usize, &Mark)| !mark.label.is_empty();
    let marks = chart.marks.iter().enumerate().filter(has_label);
    let mut wanted: Vec<(usize, &Mark)> = marks.collect();
    if wanted.is_empty() {
        return Vec::new();
    }
    let last_number = first_number + wanted.len() - 1;
    let number_em = width_em(&last_number.to_string(), &chart.typeface);
    let places = |(place, mark): &(usize, &Mark)| {
        let label_em = widths.marks.get(*place).copied().unwrap_or(0.0);
        possible_places(mark.place, layout, obstacles, [label_em, number_em])
    };
    let mut possible: Vec<Vec<Place>> = wanted.iter().map(places).collect();
    // Those with the least choice first: what they cannot do is found early.
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by_key(|&k| possible[k].len());
    wanted = order.iter().map(|&k| wanted[k]).collect();
    possible = order
        .iter()
        .map(|&k| std::mem::take(&mut possible[k]))
        .collect();
    let chosen = Search::best(&possible);
    let placed = wanted.iter().zip(chosen);
    let placed = placed.filter_map(|((mark, of), place)| {
        let place = place?;
        Some(PlacedLabel {
            mark: *mark,
            rect: place.rect,
            text: of.label.clone(),
            number: place.is_number.then_some(0),
            text_px: place.text_px,
            leader: place.leader,
        })
    });
    let mut placed: Vec<PlacedLabel> = placed.collect();
    number(&mut placed, chart, layout, first_number);
    placed
}

/// Numbers from the highest mark down.
fn number(placed: &mut [PlacedLabel], chart: &Chart, layout: &Layout, first_number: usize) {
    let height_px = |label: &PlacedLabel| match chart.marks[label.mark].place {
        MarkPlace::Point { y, .. } | MarkPlace::Horizontal { y } => layout.y.px(y),
        MarkPlace::Vertical { .. } => f64::INFINITY,
    };
    placed.sort_by(|a, b| {
        height_px(a)
            .total_cmp(&height_px(b))
            .then(a.mark.cmp(&b.mark))
    });
    let numbered = placed.iter_mut().filter(|label| label.number.is_some());
    for (label, number) in numbered.zip(first_number..) {
        (label.number, label.text) = (Some(number), number.to_string());
    }
}

/// A possible place of a label, and what speaks against it.
#[derive(Clone, Copy, Debug)]
struct Place {
    rect: Rect,
    text_px: f64,
    leader: Option<(Point, Point)>,
    is_number: bool,
    cost: f64,
}

impl Place {
    /// Whether two labels keep off one another, with their leaders.
    fn suits(&self, other: &Self) -> bool {
        let runs_through = |leader: Option<(Point, Point)>, rect: &Rect| {
            leader.is_some_and(|(from, to)| rect.grown(1.0).clip(from, to).is_some())
        };
        let leaders = self.leader.zip(other.leader);
        !self.rect.grown(CLEAR).overlaps(&other.rect)
            && !runs_through(self.leader, &other.rect)
            && !runs_through(other.leader, &self.rect)
            && !leaders.is_some_and(|(one, other)| cross(one, other))
    }
}

/// The places where a label or its number covers nothing, the cheapest first; these are their widths at size 1.
fn possible_places(
    mark: MarkPlace,
    layout: &Layout,
    obstacles: &Obstacles,
    widths_em: [f64; 2],
) -> Vec<Place> {
    let inner = layout.frame.grown(-AIR);
    let mut all = Vec::new();
    for (width_em, is_number) in widths_em.into_iter().zip([false, true]) {
        let text_px = fitted_px(MARK_TEXT, width_em, inner.width() - 2.0 * AIR);
        let size = (width_em * text_px + 2.0 * AIR, 1.15 * text_px + AIR);
        if text_px < LEAST_SHARE_OF_SIZE * MARK_TEXT || size.1 > inner.height() {
            continue;
        }
        let mut corners = match mark {
            MarkPlace::Point { x, y } => about_point(layout.px((x, y)), size),
            MarkPlace::Vertical { x } => beside_vertical(layout.x.px(x), &inner, size),
            MarkPlace::Horizontal { y } => beside_horizontal(layout.y.px(y), &inner, size),
        };
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        let ring = match mark {
            MarkPlace::Point { x, y } => Some(layout.px((x, y))),
            MarkPlace::Vertical { .. } | MarkPlace::Horizontal { .. } => None,
        };
        let places = |(corner, cost): (Point, f64)| {
            let asked = Rect::at(corner.0, corner.1, size.0, size.1);
            let rect = asked.moved_into(&inner);
            let moved = distance((rect.left, rect.top), (asked.left, asked.top));
            let of_number = if is_number { NUMBERED } else { 0.0 };
            let place = Place {
                rect,
                text_px,
                leader: None,
                is_number,
                cost: cost + 0.3 * moved + of_number,
            };
            match ring {
                _ if !obstacles.spare(&rect.grown(CLEAR)) => Vec::new(),
                None => vec![place],
                Some(ring) => with_leaders(place, ring, obstacles),
            }
        };
        let of_corners = corners.into_iter().map(places);
        let there = of_corners.filter(|places| !places.is_empty());
        all.extend(there.take(MOST_PLACES).flatten());
    }
    all.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    all
}

/// Upper left corners of boxes about a point, with what speaks against each.
fn about_point(center: Point, (width, height): (f64, f64)) -> Vec<(Point, f64)> {
    const REACHES: [f64; 11] = [
        13.0, 18.0, 26.0, 36.0, 50.0, 68.0, 90.0, 120.0, 160.0, 210.0, 270.0,
    ];
    let mut all = Vec::new();
    for reach in REACHES {
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
            all.push((corner, 0.35 * reach + bias));
        }
    }
    all
}

/// Upper left corners of boxes on both sides of an upright line, from the top.
fn beside_vertical(x: f64, inner: &Rect, (width, height): (f64, f64)) -> Vec<(Point, f64)> {
    along(inner.height() - height, 12.0, |down| {
        [x + 4.0, x - 4.0 - width].map(|left| (left, inner.top + 4.0 + down))
    })
}

/// Upper left corners of boxes above and below a level line, from the right.
fn beside_horizontal(y: f64, inner: &Rect, (width, height): (f64, f64)) -> Vec<(Point, f64)> {
    along(inner.width() - width, 16.0, |back| {
        [y - 3.5 - height, y + 3.5].map(|top| (inner.right - 4.0 - width - back, top))
    })
}

/// Places on both sides of a line, step by step along it: the first of each step is the better one.
fn along(length: f64, step_px: f64, at: impl Fn(f64) -> [Point; 2]) -> Vec<(Point, f64)> {
    let steps = (length / step_px).max(0.0) as usize;
    let of_step = |step: usize| {
        let (corners, cost) = (at(step_px * step as f64), 0.5 * step as f64);
        let sides = corners.into_iter().zip([0.0, 1.0]);
        sides.map(move |(corner, bias)| (corner, cost + bias))
    };
    (0..=steps).flat_map(of_step).collect()
}

/// A place with each leader that runs clear: to the nearest point of the label, or to another one of the edge that faces the ring.
fn with_leaders(place: Place, ring: Point, obstacles: &Obstacles) -> Vec<Place> {
    let rect = place.rect;
    let nearest = rect.nearest(ring);
    let mut ends = vec![nearest];
    if nearest.1 != ring.1 {
        let along = |part: f64| (rect.left + part * rect.width(), nearest.1);
        ends.extend([0.1, 0.3, 0.5, 0.7, 0.9].map(along));
    }
    let way = distance(ring, nearest);
    let with = |end: Point| {
        let length = distance(ring, end).max(MARK_RING);
        let leader = (between(ring, end, MARK_RING / length), end);
        let segments = obstacles.segments.iter();
        let crossed = segments.filter(|&&segment| cross(leader, segment)).count();
        let seen = (length - MARK_RING > SHORT_LEADER).then_some(leader);
        obstacles.let_through(leader, ring).then_some(Place {
            leader: seen,
            cost: place.cost + 0.5 * (length - way) + 30.0 * crossed as f64,
            ..place
        })
    };
    ends.into_iter().filter_map(with).collect()
}

/// Depth first, cheapest places first; branches that cannot beat the best so far are left out.
struct Search<'a> {
    possible: &'a [Vec<Place>],
    /// The least that the labels from each on can cost.
    least: Vec<f64>,
    combinations: usize,
    best: (f64, Vec<Option<Place>>),
}

impl<'a> Search<'a> {
    /// A place for each, or none.
    fn best(possible: &'a [Vec<Place>]) -> Vec<Option<Place>> {
        let mut least = vec![0.0];
        for places in possible.iter().rev() {
            let cheapest = places.first().map_or(ALONE, |place| place.cost);
            least.push(least[least.len() - 1] + cheapest);
        }
        least.reverse();
        let mut search = Self {
            possible,
            least,
            combinations: 0,
            best: (f64::INFINITY, vec![None; possible.len()]),
        };
        search.go_on(0.0, &mut Vec::new());
        search.best.1
    }

    fn go_on(&mut self, cost: f64, chosen: &mut Vec<Option<Place>>) {
        let next = chosen.len();
        let Some(places) = self.possible.get(next) else {
            if cost < self.best.0 {
                self.best = (cost, chosen.clone());
            }
            return;
        };
        let all = places.iter().map(|place| (Some(*place), place.cost));
        for (place, of_place) in all.chain([(None, ALONE)]) {
            self.combinations += 1;
            let is_beaten = cost + of_place + self.least[next + 1] >= self.best.0;
            // The first way through is always followed to its end.
            let is_late = self.combinations > MOST_COMBINATIONS && self.best.0.is_finite();
            if is_beaten || is_late {
                return;
            }
            let suits = |other: &Place| place.is_none_or(|place: Place| place.suits(other));
            if chosen.iter().flatten().all(suits) {
                chosen.push(place);
                self.go_on(cost + of_place, chosen);
                chosen.pop();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, Drawing, Marker, Series};

    /// A curve of loss over six decades with peaks at these places (decades from the left) and of these heights, in px of this text
    /// (pt) on paper this wide (mm).
    fn drawn(peaks: &[(f64, f64)], width_mm: f64, pt: f64) -> Drawing {
        let loss = |x: f64| -> f64 {
            let of = |(place, height): &(f64, f64)| {
                let ratio = 10_f64.powf(x - place);
                height * 2.0 * ratio / (1.0 + ratio * ratio)
            };
            peaks.iter().map(of).sum()
        };
        let points = (0..37).map(|k| f64::from(k) / 6.0);
        let points = points.map(|x| (10_f64.powf(x - 5.0), loss(x)));
        let mark = |(place, height): &(f64, f64)| {
            Mark::point(
                10_f64.powf(place - 5.0),
                loss(*place),
                format!("ω = {height:.2} × 10⁻² rad/s"),
            )
        };
        let px = |mm: f64| (mm * 16.0 * 72.0 / 25.4 / pt) as u32;
        let title = "energy loss per cycle / µJ";
        Chart::new(
            Axis::log("angular frequency ω / rad·s⁻¹"),
            Axis::linear(title),
        )
        .series(Series::line(points).marker(Marker::Disc))
        .all_marks(peaks.iter().map(mark))
        .size(px(width_mm), px(0.75 * width_mm))
        .draw()
        .unwrap()
    }

    #[test]
    fn one_and_two_peaks_keep_their_labels_in_a_column_of_a_journal() {
        for (width_mm, pt) in [
            (84.0, 10.0),
            (84.0, 8.0),
            (75.0, 8.0),
            (90.0, 10.0),
            (174.0, 12.0),
        ] {
            for peaks in [
                &[(2.5, 1.0)][..],
                &[(2.5, 1.0), (3.6, 0.5)],
                &[(1.0, 0.4), (2.5, 1.0)],
            ] {
                let drawing = drawn(peaks, width_mm, pt);
                assert_eq!(
                    (drawing.numbered(), drawing.unlabelled()),
                    (vec![], &[][..]),
                    "{width_mm} {pt}"
                );
                assert_eq!(drawing.overlaps(), []);
            }
        }
    }

    #[test]
    fn peaks_without_room_for_labels_are_numbered_from_the_highest_down_and_listed() {
        let peaks = [(1.0, 0.5), (2.0, 0.8), (3.0, 1.2), (4.0, 0.9), (5.0, 0.7)];
        let drawing = drawn(&peaks, 75.0, 12.0);
        let numbered: Vec<String> = drawing
            .numbered()
            .into_iter()
            .map(|(_, label)| label)
            .collect();
        assert!(numbered.len() >= 3, "{numbered:?}");
        // "ω = 1.20 × ..." is above "ω = 0.90 × ..." as a text too.
        assert!(
            numbered.is_sorted_by(|upper, lower| upper > lower),
            "{numbered:?}"
        );
        let caption = drawing.captioned("Loss.");
        assert!(
            caption.starts_with("Loss. ") && caption.contains(" 1: ω = "),
            "{caption}"
        );
        // Every peak is found by its number or in the caption, or has its label.
        assert!(
            drawing
                .unlabelled()
                .iter()
                .all(|label| caption.contains(label))
        );
        assert_eq!(drawing.overlaps(), []);
        assert_eq!(drawing.to_svg(), drawn(&peaks, 75.0, 12.0).to_svg());
    }

    #[test]
    fn of_two_labels_that_want_one_place_the_search_finds_places_for_both() {
        let place = |left: f64, cost: f64| Place {
            rect: Rect::at(left, 0.0, 10.0, 10.0),
            text_px: 16.0,
            leader: None,
            is_number: false,
            cost,
        };
        // What is cheapest for the first would leave nothing for the second.
        let possible = [
            vec![place(0.0, 1.0), place(50.0, 2.0)],
            vec![place(5.0, 1.0)],
        ];
        let chosen = Search::best(&possible);
        let lefts: Vec<f64> = chosen
            .iter()
            .flatten()
            .map(|place| place.rect.left)
            .collect();
        assert_eq!(lefts, [50.0, 5.0]);
        // Without a place for both, the one that has the least to lose stands alone.
        assert_eq!(
            Search::best(&[possible[1].clone(), possible[1].clone()])
                .iter()
                .flatten()
                .count(),
            1
        );
        assert!(Search::best(&[vec![]])[0].is_none());
    }
}
