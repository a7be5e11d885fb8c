//! Where frame, ticks and labels go, from the measured sizes of all text.

use super::canvas::{Direction, HPos};
use super::check::{empty, mark_name};
use super::geometry::{Point, Rect};
use super::look::*;
use super::scale::{AxisMap, Room, range};
use super::text::{ASCENT_EM, DESCENT_EM, widths_em};
use super::ticks::{self, Tick, Ticks};
use super::{AxisName, Chart, ChartError, Mark, MarkPlace, Scale, Series};

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
}

pub(super) struct PlacedText {
    pub(super) text: String,
    pub(super) at: Point,
    pub(super) size: f64,
    pub(super) hold: (HPos, Direction),
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
    pub(super) fn measure(chart: &Chart) -> Result<Self, ChartError> {
        let title = chart.title.as_deref().unwrap_or("");
        let series = chart
            .series
            .iter()
            .map(|series| series.label.as_deref().unwrap_or(""));
        let marks = chart
            .marks
            .iter()
            .map(|mark| mark.label.as_deref().unwrap_or(""));
        let texts = [title, &chart.x.label, &chart.y.label]
            .into_iter()
            .chain(series)
            .chain(marks);
        let mut widths = widths_em(texts)?.into_iter();
        let mut next = || widths.next().unwrap_or(0.0);
        let (title, x_label, y_label) = (next(), next(), next());
        let series = chart.series.iter().map(|_| next()).collect();
        Ok(Self {
            title,
            x_label,
            y_label,
            series,
            marks: widths.collect(),
        })
    }
}

/// The ranges of both axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ranges {
    x: (f64, f64),
    y: (f64, f64),
}

impl Widths {
    /// The height (px) of a picture in which the label of y has its full size.
    pub(super) fn height_of_y_label_px(&self) -> f64 {
        self.y_label * LABEL_TEXT + 2.0 * MARGIN
    }
}

/// The least frame that is still a chart, in px.
const LEAST_FRAME: f64 = 60.0;
/// No canvas is larger than this, so that sixteenths of a px stay whole numbers of 32 bits with room to spare.
const LARGEST: u32 = 32_768;

/// Lays the chart out with `reserve` kept free for a legend.
pub(super) fn lay_out(
    chart: &Chart,
    ranges: &Ranges,
    widths: &Widths,
    reserve: Reserve,
) -> Result<Layout, ChartError> {
    let (width, height) = (
        f64::from(chart.size.width_px),
        f64::from(chart.size.height_px),
    );
    let title_height = if chart.title.is_some() {
        TITLE_TEXT * (ASCENT_EM + DESCENT_EM) + LABEL_GAP
    } else {
        0.0
    };
    let top = crisp(MARGIN + title_height + reserve.top);
    let below_ticks = MAJOR_TICK + TICK_GAP + TICK_TEXT * ASCENT_EM;
    let label_height = if chart.x.label.is_empty() {
        0.0
    } else {
        LABEL_TEXT * (ASCENT_EM + DESCENT_EM) + LABEL_GAP
    };
    let bottom = crisp(height - MARGIN - label_height - below_ticks);
    checked_size(chart, bottom - top)?;

    let y = AxisMap {
        scale: chart.y.scale,
        low: ranges.y.0,
        high: ranges.y.1,
        from_px: bottom,
        to_px: top,
    };
    let y_ticks = ticks::choose(y.scale, y.low, y.high, |ticks| room_for_heights(&y, ticks));
    let widest = tick_widths(&y_ticks)?.into_iter().fold(0.0, f64::max);
    let beside_frame =
        MARGIN + LABEL_TEXT * (ASCENT_EM + DESCENT_EM) + LABEL_GAP + widest + TICK_GAP + MAJOR_TICK;
    let left = crisp(beside_frame.max(reserve.left));

    let mut right = crisp(width - MARGIN - reserve.right);
    checked_size(chart, right - left)?;
    let mut x = AxisMap {
        scale: chart.x.scale,
        low: ranges.x.0,
        high: ranges.x.1,
        from_px: left,
        to_px: right,
    };
    let x_ticks = ticks::choose(x.scale, x.low, x.high, |ticks| room_for_widths(&x, ticks));
    if let (Some(last), Some(label_width)) = (x_ticks.major.last(), tick_widths(&x_ticks)?.last()) {
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

fn tick_widths(ticks: &Ticks) -> Result<Vec<f64>, ChartError> {
    let widths = widths_em(ticks.major.iter().map(|tick| tick.label.as_str()))?;
    Ok(widths.into_iter().map(|width| width * TICK_TEXT).collect())
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
    let placed = |text: &String, size: f64, width_em: f64, side: (f64, f64), ends: (f64, f64)| {
        let room = ends.1 - ends.0;
        let size = if width_em * size > room {
            room / width_em
        } else {
            size
        };
        let half = width_em * size / 2.0;
        let middle = (side.0 + side.1) / 2.0;
        let middle = middle.min(ends.1 - half).max(ends.0 + half);
        (text.clone(), size, middle)
    };
    let across = ((frame.left, frame.right), (MARGIN, frame.right));
    // A legend above may begin as far left as the label of y stands.
    let y_from = if reserve.top > 0.0 { frame.top } else { MARGIN };
    let upwards = ((frame.top, frame.bottom), (y_from, height - MARGIN));
    let level = |(text, size, x): (String, f64, f64), y: f64| PlacedText {
        text,
        at: (x, y),
        size,
        hold: (HPos::Center, Direction::Level),
    };
    let (x, y) = (&chart.x.label, &chart.y.label);
    let x = placed(x, LABEL_TEXT, widths.x_label, across.0, across.1);
    let (text, size, center) = placed(y, LABEL_TEXT, widths.y_label, upwards.0, upwards.1);
    let y = PlacedText {
        text,
        at: (MARGIN + LABEL_TEXT * ASCENT_EM, center),
        size,
        hold: (HPos::Center, Direction::Upwards),
    };
    let title = chart.title.as_ref().map(|title| {
        let placed = placed(title, TITLE_TEXT, widths.title, across.0, across.1);
        level(placed, MARGIN + TITLE_TEXT * ASCENT_EM)
    });
    let x = level(x, height - MARGIN - LABEL_TEXT * DESCENT_EM);
    [x, y].into_iter().chain(title).collect()
}

/// The ranges of both axes: those given, otherwise from the data and marks.
pub(super) fn ranges(chart: &Chart) -> Result<Ranges, ChartError> {
    let (xs, ys) = extents(chart)?;
    let side = if chart.series.iter().all(is_plain_function) {
        0.0
    } else {
        0.025
    };
    // A labelled peak needs room for its label above it.
    let labelled_point =
        |mark: &Mark| mark.label.is_some() && matches!(mark.place, MarkPlace::Point { .. });
    let above = if chart.marks.iter().any(labelled_point) {
        0.12
    } else {
        0.05
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
        x: range(&chart.x, AxisName::X, xs.least, xs.greatest, x_room)?,
        y: range(&chart.y, AxisName::Y, ys.least, ys.greatest, y_room)?,
    };
    check_marks_inside(chart, &ranges)?;
    Ok(ranges)
}

/// What the data with their error bars and areas, and the marks, take up in x and in y.
fn extents(chart: &Chart) -> Result<(Extent, Extent), ChartError> {
    let within = |range: Option<(f64, f64)>, value: f64| {
        range.is_none_or(|(low, high)| (low..=high).contains(&value))
    };
    let (mut xs, mut ys) = (Extent::default(), Extent::default());
    for series in &chart.series {
        for (place, point) in series.points.iter().enumerate() {
            // What a given range leaves out must not widen the other axis.
            let shown =
                |(x, y): &(f64, f64)| within(chart.x.range, *x) && within(chart.y.range, *y);
            let Some((x, y)) = point.filter(shown) else {
                continue;
            };
            xs.add(x);
            ys.add(y);
            let error = series
                .error
                .as_ref()
                .and_then(|errors| *errors.get(place)?)
                .unwrap_or(0.0);
            ys.add(y + error);
            if chart.y.scale == Scale::Linear || y > error {
                ys.add(y - error);
            }
            series.fill_to.iter().for_each(|&base| ys.add(base));
        }
    }
    if xs.least > xs.greatest && chart.map.is_none() {
        return Err(empty(chart));
    }
    for mark in &chart.marks {
        match mark.place {
            MarkPlace::Point { x, y } => {
                xs.add(x);
                ys.add(y);
            }
            MarkPlace::Vertical { x } => xs.add(x),
            MarkPlace::Horizontal { y } => ys.add(y),
        }
    }
    Ok((xs, ys))
}

/// A line y(x) without markers: it may run from edge to edge of the frame.
fn is_plain_function(series: &Series) -> bool {
    let mut xs = series.points.iter().flatten().map(|point| point.0);
    series.marker.is_none()
        && series.error.is_none()
        && series.points.len() > 1
        && xs.by_ref().is_sorted()
}

#[derive(Clone, Copy, Debug)]
struct Extent {
    least: f64,
    greatest: f64,
}

impl Default for Extent {
    fn default() -> Self {
        Self {
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
        }
    }
}

impl Extent {
    fn add(&mut self, value: f64) {
        self.least = self.least.min(value);
        self.greatest = self.greatest.max(value);
    }
}

fn check_marks_inside(chart: &Chart, ranges: &Ranges) -> Result<(), ChartError> {
    for mark in &chart.marks {
        let (x, y) = match mark.place {
            MarkPlace::Point { x, y } => (Some(x), Some(y)),
            MarkPlace::Vertical { x } => (Some(x), None),
            MarkPlace::Horizontal { y } => (None, Some(y)),
        };
        for (value, (low, high), axis) in [(x, ranges.x, AxisName::X), (y, ranges.y, AxisName::Y)] {
            if let Some(value) = value.filter(|value| !(low..=high).contains(value)) {
                return Err(ChartError::MarkOutside {
                    mark: mark_name(mark),
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
