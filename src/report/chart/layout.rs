//! Where frame, ticks and labels go, from the measured sizes of all text.

use super::check::{empty, mark_name};
use super::color_bar::Bar;
use super::geometry::{Point, Rect};
use super::look::*;
use super::scale::{AxisMap, Room, range};
use super::text::{ASCENT_EM, Anchor, width_em};
use super::ticks::{self, Tick, Ticks};
use super::titles::{LEAST_SHARE_OF_SIZE, Lines, PITCH_EM, Phrase};
use super::{Chart, ChartError, Mark, MarkPlace, Scale, Series};
use crate::report::number;

/// The frame with its axes, and the texts around it.
pub(super) struct Layout {
    pub(super) frame: Rect,
    pub(super) x: AxisMap,
    pub(super) y: AxisMap,
    pub(super) x_ticks: Ticks,
    pub(super) y_ticks: Ticks,
    /// What the colours stand for.
    pub(super) bar: Option<Bar>,
    /// The lines of the titles: of the chart, of the axes and of the colour bar.
    pub(super) texts: Vec<PlacedText>,
    /// How much higher (px) the picture must be for the titles along its height to be read with ease.
    pub(super) missing_height_px: f64,
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

/// A line of text.
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

/// The texts that do not depend on the layout, measured.
#[derive(Debug)]
pub(super) struct Widths {
    title: Phrase,
    x_label: Phrase,
    y_label: Phrase,
    /// One per series; empty without a label.
    pub(super) series: Vec<Phrase>,
    /// One per mark, at size 1; 0 without a label.
    pub(super) marks: Vec<f64>,
}

impl Widths {
    pub(super) fn measure(chart: &Chart) -> Self {
        let of = |text: Option<&str>| Phrase::measure(text.unwrap_or(""), &chart.typeface);
        let series = chart.series.iter();
        let marks = chart.marks.iter();
        Self {
            title: of(chart.title.as_deref()),
            x_label: of(Some(&chart.x.label)),
            y_label: of(Some(&chart.y.label)),
            series: series.map(|s| of(s.label.as_deref())).collect(),
            marks: marks.map(|m| width_em(&m.label, &chart.typeface)).collect(),
        }
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

/// Lines of a title along the height, beyond which a picture should rather be higher; across there may be more.
const MOST_UPRIGHT_LINES: usize = 2;
const MOST_LEVEL_LINES: usize = 9;

/// Lays the chart out with `reserve` kept free for a legend.
pub(super) fn lay_out(
    chart: &Chart,
    ranges: &Ranges,
    widths: &Widths,
    reserve: Reserve,
) -> Result<Layout, ChartError> {
    let [width, height] = [chart.size.width_px, chart.size.height_px].map(f64::from);
    let titles = Titles::of(widths, (width, height), reserve);
    let (top, bottom) = titles.ends_of_frame(height);
    checked_size(chart, bottom - top)?;

    let y = AxisMap::new(chart.y.scale, ranges.y, (bottom, top));
    let y_ticks = ticks::choose(y.scale, y.low, y.high, |ticks| room_for_heights(&y, ticks));
    let widest = tick_widths(chart, &y_ticks).into_iter().fold(0.0, f64::max);
    let beside_frame = MARGIN + block(&titles.y) + widest + TICK_GAP + MAJOR_TICK;
    let left = crisp(beside_frame.max(reserve.left));

    let upright = (titles.upper, bottom + BELOW_TICKS);
    let bar = Bar::of(chart, (top, bottom), upright)?;
    let of_bar = bar.as_ref().map_or(0.0, Bar::total_width);
    let mut right = crisp(width - MARGIN - reserve.right - of_bar);
    checked_size(chart, right - left)?;
    let mut x = AxisMap::new(chart.x.scale, ranges.x, (left, right));
    let mut x_ticks = ticks::choose(x.scale, x.low, x.high, |ticks| room_for_widths(&x, ticks));
    if chart.x.whole {
        x_ticks = x_ticks.at_whole_numbers();
    }
    if !room_for_widths(&x, &x_ticks.major) {
        return Err(no_room(chart));
    }
    if let (Some(last), Some(label_width)) =
        (x_ticks.major.last(), tick_widths(chart, &x_ticks).last())
    {
        // The last label is centred on its tick and may reach beyond the frame.
        let free = width - reserve.right - of_bar - 0.5 * MARGIN;
        let over = x.px(last.value) + label_width / 2.0 - free;
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
    let mut texts = titles.placed(&frame, (width, height));
    let mut missing_height_px = missing(&titles.y, height - MARGIN - titles.upper);
    if let Some(bar) = &bar {
        texts.extend(bar.title(&frame));
        missing_height_px = missing_height_px.max(missing(&bar.title, upright.1 - upright.0));
    }
    Ok(Layout {
        frame,
        x,
        y,
        x_ticks,
        y_ticks,
        bar,
        texts,
        missing_height_px,
    })
}

/// What a title is short of (px) along its side.
fn missing(title: &Lines, room_px: f64) -> f64 {
    (title.widest_em * LEAST_SHARE_OF_SIZE * LABEL_TEXT - room_px).max(0.0)
}

/// The height (px) of a title with the gap that parts it from what it names; 0 without one.
pub(super) fn block(title: &Lines) -> f64 {
    match title.lines.is_empty() {
        true => 0.0,
        false => title.height_px() + LABEL_GAP,
    }
}

/// A title that runs upwards between these two ends (px).
pub(super) fn upright_title(label: &Phrase, room_px: f64) -> Lines {
    label.within(LABEL_TEXT, room_px, MOST_UPRIGHT_LINES)
}

/// From the frame to the lower edge of the labels of the ticks below it.
const BELOW_TICKS: f64 = MAJOR_TICK + TICK_GAP + TICK_TEXT * ASCENT_EM;

/// The titles of a chart and of its axes, in lines.
struct Titles {
    chart: Lines,
    x: Lines,
    y: Lines,
    /// Where (px) the picture begins below its title and a legend.
    upper: f64,
}

impl Titles {
    fn of(widths: &Widths, (width, height): (f64, f64), reserve: Reserve) -> Self {
        let across = width - 2.0 * MARGIN;
        let chart = widths.title.within(TITLE_TEXT, across, MOST_LEVEL_LINES);
        let upper = MARGIN + block(&chart) + reserve.top;
        let y = upright_title(&widths.y_label, height - MARGIN - upper);
        // The title of y has the corner.
        let x_room = across - block(&y);
        let x = widths.x_label.within(LABEL_TEXT, x_room, MOST_LEVEL_LINES);
        Self { chart, x, y, upper }
    }

    /// The upper and the lower end of the frame.
    fn ends_of_frame(&self, height: f64) -> (f64, f64) {
        let bottom = height - MARGIN - block(&self.x) - BELOW_TICKS;
        (crisp(self.upper), crisp(bottom))
    }

    fn placed(&self, frame: &Rect, (width, height): (f64, f64)) -> Vec<PlacedText> {
        let middle = (frame.left + frame.right) / 2.0;
        let title = centered(&self.chart, middle, (MARGIN, width - MARGIN));
        let x = centered(&self.x, middle, (MARGIN + block(&self.y), width - MARGIN));
        let y_middle = (frame.top + frame.bottom) / 2.0;
        let y = centered(&self.y, y_middle, (self.upper, height - MARGIN));
        let x_top = height - MARGIN - self.x.height_px();
        let title = level(&self.chart, title, MARGIN);
        let x = level(&self.x, x, x_top);
        title.chain(x).chain(upwards(&self.y, y, MARGIN)).collect()
    }
}

/// The middle of a title, as near to this one as its ends allow.
pub(super) fn centered(title: &Lines, middle: f64, (from, to): (f64, f64)) -> f64 {
    let half = title.widest_em * title.size_px / 2.0;
    middle.min(to - half).max(from + half)
}

/// The lines of a title about this middle, the first below `top`.
fn level(title: &Lines, middle: f64, top: f64) -> impl Iterator<Item = PlacedText> {
    baselines(title, top).map(move |(text, y, size)| PlacedText {
        text,
        at: (middle, y),
        size,
        anchor: Anchor::Middle,
    })
}

/// The lines of a title that runs upwards about this middle, the first right of `left`.
pub(super) fn upwards(title: &Lines, middle: f64, left: f64) -> impl Iterator<Item = PlacedText> {
    baselines(title, left).map(move |(text, x, size)| PlacedText {
        text,
        at: (x, middle),
        size,
        anchor: Anchor::Upwards,
    })
}

/// Each line with its baseline, from where the letters of the first begin, and its size.
fn baselines(title: &Lines, from: f64) -> impl Iterator<Item = (String, f64, f64)> {
    let size = title.size_px;
    let lines = title.lines.clone().into_iter().enumerate();
    lines.map(move |(place, line)| {
        let baseline = from + size * (ASCENT_EM + PITCH_EM * place as f64);
        (line, baseline, size)
    })
}

/// The nearest middle of a pixel, where a line one pixel wide is drawn sharp.
pub(super) fn crisp(px: f64) -> f64 {
    px.floor() + 0.5
}

fn checked_size(chart: &Chart, frame_length: f64) -> Result<(), ChartError> {
    if chart.size.width_px.max(chart.size.height_px) > LARGEST {
        return Err(refused(chart, "no side may be longer than 32768 px"));
    }
    match frame_length < LEAST_FRAME {
        true => Err(no_room(chart)),
        false => Ok(()),
    }
}

fn no_room(chart: &Chart) -> ChartError {
    refused(
        chart,
        "labels and legend leave no room for the plot; make it larger",
    )
}

fn refused(chart: &Chart, reason: &'static str) -> ChartError {
    ChartError::Size {
        width_px: chart.size.width_px,
        height_px: chart.size.height_px,
        reason,
    }
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

/// The ranges of both axes: those given, otherwise from the data and marks, with this share of the height of the data left free
/// above labelled peaks.
pub(super) fn ranges(chart: &Chart, head_room: f64) -> Result<Ranges, ChartError> {
    let [xs, ys] = extents(chart)?;
    let side = match chart.series.iter().all(is_plain_function) {
        true => 0.0,
        false => 0.025,
    };
    let above = match chart.marks.iter().any(Mark::is_labelled_point) {
        true => head_room,
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
        x: range(&chart.x, "x", xs, x_room)?,
        y: range(&chart.y, "y", ys, y_room)?,
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
        for (value, (low, high), axis) in [(x, ranges.x, "x"), (y, ranges.y, "y")] {
            if let Some(value) = value.filter(|value| !(low..=high).contains(value)) {
                let mark = mark_name(mark);
                return Err(ChartError::item(
                    mark,
                    format!(
                        "its {axis} {value} is outside the axis, {low} to {high}; widen the range or leave the mark out"
                    ),
                ));
            }
        }
    }
    Ok(())
}
