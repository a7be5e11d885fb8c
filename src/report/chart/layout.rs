//! Where frame, ticks and labels go, from the measured sizes of all text.

use super::check::{empty, mark_name};
use super::geometry::{Point, Rect};
use super::look::*;
use super::scale::{AxisMap, Room, range};
use super::text::{ASCENT_EM, Anchor, DESCENT_EM, fitted_px, width_em};
use super::ticks::{self, Tick, Ticks};
use super::{AxisName, Chart, ChartError, Mark, MarkPlace, Scale, Series};
use crate::report::number;

/// The frame with its axes, and the texts around it.
pub(super) struct Layout {
    pub(super) frame: Rect,
    pub(super) x: AxisMap,
    pub(super) y: AxisMap,
    pub(super) x_ticks: Ticks,
    pub(super) y_ticks: Ticks,
    /// Title and axis labels.
    pub(super) texts: Vec<PlacedText>,
}

impl Layout {
    pub(super) fn px(&self, (x, y): Point) -> Point {
        (self.x.px(x), self.y.px(y))
    }

    /// A mark in px.
    pub(super) fn marked(&self, place: MarkPlace) -> Marked {
        let frame = &self.frame;
        match place {
            MarkPlace::Point { x, y } => Marked::Point(self.px((x, y))),
            MarkPlace::Vertical { x } => {
                let x = self.x.px(x);
                Marked::Line((x, frame.bottom), (x, frame.top))
            }
            MarkPlace::Horizontal { y } => {
                let y = self.y.px(y);
                Marked::Line((frame.left, y), (frame.right, y))
            }
        }
    }
}

pub(super) struct PlacedText {
    pub(super) text: String,
    pub(super) at: Point,
    pub(super) size: f64,
    pub(super) anchor: Anchor,
}

/// A mark in px: a point, or a line across the frame.
pub(super) enum Marked {
    Point(Point),
    Line(Point, Point),
}

/// Room kept free outside the frame, for a legend above or at the right, or to line frames up.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reserve {
    pub(super) top: f64,
    pub(super) right: f64,
    /// The frame begins no further left than this.
    pub(super) left: f64,
}

/// The widths at size 1 of the texts that do not depend on the layout.
#[derive(Debug)]
pub(super) struct Widths {
    title: f64,
    x_label: f64,
    y_label: f64,
    /// One per series; 0 without a label.
    pub(super) series: Vec<f64>,
    /// One per mark; 0 without a label.
    pub(super) marks: Vec<f64>,
}

impl Widths {
    pub(super) fn measure(chart: &Chart) -> Self {
        let of = |text: Option<&str>| width_em(text.unwrap_or(""), &chart.typeface);
        let series = chart.series.iter();
        let marks = chart.marks.iter();
        Self {
            title: of(chart.title.as_deref()),
            x_label: of(Some(&chart.x.label)),
            y_label: of(Some(&chart.y.label)),
            series: series.map(|s| of(s.label.as_deref())).collect(),
            marks: marks.map(|m| of(Some(&m.label))).collect(),
        }
    }

    /// The height (px) of a picture in which the label of y has its full size.
    pub(super) fn height_of_y_label_px(&self) -> f64 {
        self.y_label * LABEL_TEXT + 2.0 * MARGIN
    }
}

/// The ranges of both axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ranges {
    x: (f64, f64),
    y: (f64, f64),
}

/// The least frame that is still a chart, in px.
const LEAST_FRAME: f64 = 60.0;
/// No canvas is larger than this, so that the units of plotters stay whole numbers of 32 bits with room to spare.
const LARGEST: u32 = 32_768;

/// Lays the chart out with `reserve` kept free for a legend.
pub(super) fn lay_out(
    chart: &Chart,
    ranges: &Ranges,
    widths: &Widths,
    reserve: Reserve,
) -> Result<Layout, ChartError> {
    let [width, height] = [chart.size.width_px, chart.size.height_px].map(f64::from);
    let of_text = |is_there: bool, size: f64| match is_there {
        true => size * (ASCENT_EM + DESCENT_EM) + LABEL_GAP,
        false => 0.0,
    };
    let title_height = of_text(chart.title.is_some(), TITLE_TEXT);
    let top = crisp(MARGIN + title_height + reserve.top);
    let below_ticks = MAJOR_TICK + TICK_GAP + TICK_TEXT * ASCENT_EM;
    let label_height = of_text(!chart.x.label.is_empty(), LABEL_TEXT);
    let bottom = crisp(height - MARGIN - label_height - below_ticks);
    checked_size(chart, bottom - top)?;

    let y = AxisMap::new(chart.y.scale, ranges.y, (bottom, top));
    let y_ticks = ticks::choose(y.scale, y.low, y.high, |ticks| room_for_heights(&y, ticks));
    let widest = tick_widths(chart, &y_ticks).into_iter().fold(0.0, f64::max);
    let beside_frame =
        MARGIN + LABEL_TEXT * (ASCENT_EM + DESCENT_EM) + LABEL_GAP + widest + TICK_GAP + MAJOR_TICK;
    let left = crisp(beside_frame.max(reserve.left));

    let mut right = crisp(width - MARGIN - reserve.right);
    checked_size(chart, right - left)?;
    let mut x = AxisMap::new(chart.x.scale, ranges.x, (left, right));
    let x_ticks = ticks::choose(x.scale, x.low, x.high, |ticks| room_for_widths(&x, ticks));
    if let (Some(last), Some(label_width)) =
        (x_ticks.major.last(), tick_widths(chart, &x_ticks).last())
    {
        // The last label is centred on its tick and may reach beyond the frame.
        let over = x.px(last.value) + label_width / 2.0 - (width - reserve.right - 0.5 * MARGIN);
        right = crisp(right - over.max(0.0));
        x.to_px = right;
    }
    checked_size(chart, right - left)?;
    let frame = Rect {
        left,
        top,
        right,
        bottom,
    };
    Ok(Layout {
        frame,
        x,
        y,
        x_ticks,
        y_ticks,
        texts: texts(chart, widths, &frame, (height, reserve)),
    })
}

/// The nearest middle of a pixel, where a line one pixel wide is drawn sharp.
pub(super) fn crisp(px: f64) -> f64 {
    px.floor() + 0.5
}

fn checked_size(chart: &Chart, frame_length: f64) -> Result<(), ChartError> {
    let size = chart.size;
    let refuse = |reason| {
        Err(ChartError::Size {
            width_px: size.width_px,
            height_px: size.height_px,
            reason,
        })
    };
    if size.width_px.max(size.height_px) > LARGEST {
        return refuse("no side may be longer than 32768 px");
    }
    if frame_length < LEAST_FRAME {
        return refuse("labels and legend leave no room for the plot; make it larger");
    }
    Ok(())
}

/// The widths (px) of the labels.
pub(super) fn tick_widths(chart: &Chart, ticks: &Ticks) -> Vec<f64> {
    let width = |tick: &Tick| width_em(&tick.label, &chart.typeface) * TICK_TEXT;
    ticks.major.iter().map(width).collect()
}

/// An upper bound of a label's width, good enough to tell whether labels crowd: in DejaVu Sans figures take 0.64 em,
/// superscripts 0.4 em.
fn estimated_width(label: &str) -> f64 {
    let em = |c: char| match c {
        '0'..='9' => 0.64,
        '.' | ' ' | '\u{202F}' => 0.32,
        '−' | '×' => 0.84,
        _ => 0.45,
    };
    TICK_TEXT * label.chars().map(em).sum::<f64>()
}

fn room_for_widths(axis: &AxisMap, ticks: &[Tick]) -> bool {
    ticks.windows(2).all(|pair| {
        let apart = axis.px(pair[1].value) - axis.px(pair[0].value);
        let halves = (estimated_width(&pair[0].label) + estimated_width(&pair[1].label)) / 2.0;
        // A full figure's width and a half between labels, and never more labels than the eye wants.
        apart >= (halves + TICK_TEXT).max(3.2 * TICK_TEXT)
    })
}

fn room_for_heights(axis: &AxisMap, ticks: &[Tick]) -> bool {
    ticks
        .windows(2)
        .all(|pair| axis.px(pair[0].value) - axis.px(pair[1].value) >= 2.6 * TICK_TEXT)
}

fn texts(
    chart: &Chart,
    widths: &Widths,
    frame: &Rect,
    (height, reserve): (f64, Reserve),
) -> Vec<PlacedText> {
    // About the middle of its side of the frame, but within these ends; too long for them, set smaller rather than cut off.
    let placed = |size: f64, width_em: f64, side: (f64, f64), ends: (f64, f64)| {
        let size = fitted_px(size, width_em, ends.1 - ends.0);
        let half = width_em * size / 2.0;
        let middle = (side.0 + side.1) / 2.0;
        (size, middle.min(ends.1 - half).max(ends.0 + half))
    };
    let level = |text: &String, size: f64, width_em: f64, y: f64| {
        let ends = (MARGIN, frame.right);
        let (size, x) = placed(size, width_em, (frame.left, frame.right), ends);
        PlacedText {
            text: text.clone(),
            at: (x, y),
            size,
            anchor: Anchor::Middle,
        }
    };
    // A legend above may begin as far left as the label of y stands.
    let y_from = if reserve.top > 0.0 { frame.top } else { MARGIN };
    let ends = (y_from, height - MARGIN);
    let (size, y) = placed(LABEL_TEXT, widths.y_label, (frame.top, frame.bottom), ends);
    let upwards = PlacedText {
        text: chart.y.label.clone(),
        at: (MARGIN + LABEL_TEXT * ASCENT_EM, y),
        size,
        anchor: Anchor::Upwards,
    };
    let below = height - MARGIN - LABEL_TEXT * DESCENT_EM;
    let across = level(&chart.x.label, LABEL_TEXT, widths.x_label, below);
    let above = MARGIN + TITLE_TEXT * ASCENT_EM;
    let title = chart.title.as_ref();
    let title = title.map(|title| level(title, TITLE_TEXT, widths.title, above));
    [across, upwards].into_iter().chain(title).collect()
}

/// The ranges of both axes: those given, otherwise from the data and marks.
pub(super) fn ranges(chart: &Chart) -> Result<Ranges, ChartError> {
    let [xs, ys] = extents(chart)?;
    let side = match chart.series.iter().all(is_plain_function) {
        true => 0.0,
        false => 0.025,
    };
    // A labelled peak needs room for its label above it.
    let labelled_point =
        |mark: &Mark| !mark.label.is_empty() && matches!(mark.place, MarkPlace::Point { .. });
    let above = match chart.marks.iter().any(labelled_point) {
        true => 0.12,
        false => 0.05,
    };
    let x_room = Room {
        below: side,
        above: side,
        reach_zero: 0.05,
    };
    let y_room = Room {
        below: 0.05,
        above,
        reach_zero: 0.3,
    };
    let ranges = Ranges {
        x: range(&chart.x, AxisName::X, xs, x_room)?,
        y: range(&chart.y, AxisName::Y, ys, y_room)?,
    };
    check_marks_inside(chart, &ranges)?;
    Ok(ranges)
}

/// What the data with their error bars and areas, and the marks, take up in x and in y.
fn extents(chart: &Chart) -> Result<[(f64, f64); 2], ChartError> {
    let within = |range: Option<(f64, f64)>, value: f64| {
        range.is_none_or(|(low, high)| (low..=high).contains(&value))
    };
    // What a given range leaves out must not widen the other axis.
    let shown = |(x, y): &(f64, f64)| within(chart.x.range, *x) && within(chart.y.range, *y);
    let (mut xs, mut ys) = (Vec::new(), Vec::new());
    for series in &chart.series {
        for (place, point) in series.points.iter().enumerate() {
            let Some((x, y)) = point.filter(shown) else {
                continue;
            };
            let errors = series.error.as_ref();
            let error = errors.and_then(|errors| *errors.get(place)?).unwrap_or(0.0);
            xs.push(x);
            ys.extend([y, y + error]);
            if chart.y.scale == Scale::Linear || y > error {
                ys.push(y - error);
            }
            ys.extend(series.area_to);
        }
    }
    if xs.is_empty() && chart.map.is_none() {
        return Err(empty(chart));
    }
    for mark in &chart.marks {
        let (x, y) = mark.place.coordinates();
        xs.extend(x);
        ys.extend(y);
    }
    Ok([xs, ys].map(number::range))
}

/// A line y(x) without markers: it may run from edge to edge of the frame.
fn is_plain_function(series: &Series) -> bool {
    let xs = series.points.iter().flatten().map(|point| point.0);
    let is_bare = series.marker.is_none() && series.error.is_none();
    is_bare && series.points.len() > 1 && xs.is_sorted()
}

fn check_marks_inside(chart: &Chart, ranges: &Ranges) -> Result<(), ChartError> {
    for mark in &chart.marks {
        let (x, y) = mark.place.coordinates();
        for (value, (low, high), axis) in [(x, ranges.x, AxisName::X), (y, ranges.y, AxisName::Y)] {
            if let Some(value) = value.filter(|value| !(low..=high).contains(value)) {
                let mark = mark_name(mark);
                return Err(ChartError::MarkOutside {
                    mark,
                    axis,
                    value,
                    low,
                    high,
                });
            }
        }
    }
    Ok(())
}
