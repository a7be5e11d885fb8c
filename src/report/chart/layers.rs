//! The layers of a chart, from back to front, and what is drawn in each.

use super::arrange::Arrangement;
use super::canvas::Canvas;
use super::contour_labels::ContourLabel;
use super::curves::{Curve, ErrorBar};
use super::geometry::{Point, Rect};
use super::layout::{Layout, Marked, crisp};
use super::legend::Legend;
use super::look::*;
use super::place::{AIR, PlacedLabel};
use super::stroke::dashes;
use super::text::{Anchor, CAPITAL_EM, DESCENT_EM};
use super::titles::PITCH_EM;
use super::{Chart, Color, LineStyle, Series, heat_map, marker};

/// How many shapes each layer has, from back to front.
pub(super) type Counts = Vec<(Layer, usize)>;

/// What is drawn together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layer {
    /// The grid, or the colours of a map.
    Ground,
    /// Contour lines of a map.
    Contour,
    /// Areas and bands of series.
    Fill,
    /// Lines across the frame that point something out.
    MarkLine,
    /// Lines of series.
    Line,
    /// The frame, its ticks and those of the colour bar.
    Axes,
    /// Where a map was computed.
    Dot,
    ErrorBar,
    Marker,
    /// Above the data, so that it is seen where symbols are dense.
    Ring,
    Legend,
    Leader,
    MarkLabel,
    ContourLabel,
    TickLabel,
    /// The title and those of the axes and the colour bar.
    Title,
}

impl Layer {
    /// From back to front.
    pub(super) const ALL: [Self; 16] = [
        Self::Ground,
        Self::Contour,
        Self::Fill,
        Self::MarkLine,
        Self::Line,
        Self::Axes,
        Self::Dot,
        Self::ErrorBar,
        Self::Marker,
        Self::Ring,
        Self::Legend,
        Self::Leader,
        Self::MarkLabel,
        Self::ContourLabel,
        Self::TickLabel,
        Self::Title,
    ];
}

/// Draws one layer.
pub(super) fn paint(layer: Layer, chart: &Chart, arrangement: &Arrangement, canvas: &mut Canvas) {
    let Arrangement {
        layout,
        curves,
        legend,
        labels,
        contours,
    } = arrangement;
    let bar = layout.bar.as_ref();
    let all = || chart.series.iter().zip(curves);
    match layer {
        Layer::Ground => {
            if chart.map.is_none() {
                grid(layout, canvas);
            }
            if let Some(bar) = bar {
                heat_map::colors(bar, layout, canvas);
            }
        }
        Layer::Contour => heat_map::contour_lines(contours, canvas),
        Layer::Fill => all().for_each(|(series, curve)| fills(series, curve, canvas)),
        Layer::MarkLine => mark_lines(chart, layout, canvas),
        Layer::Line => all().for_each(|(series, curve)| line(series, &curve.parts, canvas)),
        Layer::Axes => {
            axes(layout, canvas);
            if let Some(bar) = bar {
                bar.draw(&layout.frame, canvas);
            }
        }
        Layer::Dot => {
            if let Some(bar) = bar {
                heat_map::dots(bar, layout, canvas);
            }
        }
        Layer::ErrorBar => {
            for (series, bars) in all().map(|(series, curve)| (series, &curve.error_bars)) {
                bars.iter()
                    .for_each(|bar| error_bar(bar, series.color, canvas));
            }
        }
        Layer::Marker => all().for_each(|(series, curve)| markers(series, curve, canvas)),
        Layer::Ring => {
            if let Some(bar) = bar {
                heat_map::rings(bar, layout, canvas);
            }
            mark_rings(chart, layout, canvas);
        }
        Layer::ContourLabel => contour_labels(&contours.labels, canvas),
        Layer::Legend => {
            if let Some(legend) = legend {
                draw_legend(chart, curves, legend, canvas);
            }
        }
        Layer::Leader => leaders(chart, labels, canvas),
        Layer::MarkLabel => labels.iter().for_each(|label| mark_label(label, canvas)),
        Layer::TickLabel => {
            tick_labels(layout, canvas);
            if let Some(bar) = bar {
                bar.tick_labels(&layout.frame, canvas);
            }
        }
        Layer::Title => {
            for text in &layout.texts {
                canvas.text(&text.text, text.at, text.size, text.anchor);
            }
        }
    }
}

fn grid(layout: &Layout, canvas: &mut Canvas) {
    let frame = &layout.frame;
    let upright = |value: f64| [frame.top, frame.bottom].map(|y| (crisp(layout.x.px(value)), y));
    let level = |value: f64| [frame.left, frame.right].map(|x| (x, crisp(layout.y.px(value))));
    let (x, y) = (&layout.x_ticks, &layout.y_ticks);
    let minor = x.minor.iter().map(|&value| upright(value));
    for line in minor.chain(y.minor.iter().map(|&value| level(value))) {
        canvas.line(&line, MINOR_GRID_STROKE, MINOR_GRID);
    }
    let major = x.major.iter().map(|tick| upright(tick.value));
    for line in major.chain(y.major.iter().map(|tick| level(tick.value))) {
        canvas.line(&line, MAJOR_GRID_STROKE, MAJOR_GRID);
    }
    let [top_left, top_right, bottom_right, _] = frame.corners();
    canvas.line(
        &[top_left, top_right, bottom_right],
        MAJOR_GRID_STROKE,
        MAJOR_GRID,
    );
}

/// The left and lower side of the frame, and the ticks.
fn axes(layout: &Layout, canvas: &mut Canvas) {
    let frame = &layout.frame;
    for (value, length) in layout.x_ticks.lengths() {
        let x = crisp(layout.x.px(value));
        let ends = [(x, frame.bottom), (x, frame.bottom + length)];
        canvas.line(&ends, FRAME_STROKE, FRAME);
    }
    for (value, length) in layout.y_ticks.lengths() {
        let y = crisp(layout.y.px(value));
        let ends = [(frame.left - length, y), (frame.left, y)];
        canvas.line(&ends, FRAME_STROKE, FRAME);
    }
    let [top_left, _, bottom_right, bottom_left] = frame.corners();
    canvas.line(&[top_left, bottom_left, bottom_right], FRAME_STROKE, FRAME);
}

fn tick_labels(layout: &Layout, canvas: &mut Canvas) {
    let frame = &layout.frame;
    let below = frame.bottom + MAJOR_TICK + TICK_GAP + CAPITAL_EM * TICK_TEXT;
    for tick in &layout.x_ticks.major {
        let at = (layout.x.px(tick.value), below);
        canvas.text(&tick.label, at, TICK_TEXT, Anchor::Middle);
    }
    let beside = frame.left - MAJOR_TICK - TICK_GAP;
    for tick in &layout.y_ticks.major {
        let at = (
            beside,
            layout.y.px(tick.value) + CAPITAL_EM / 2.0 * TICK_TEXT,
        );
        canvas.text(&tick.label, at, TICK_TEXT, Anchor::End);
    }
}

fn fills(series: &Series, curve: &Curve, canvas: &mut Canvas) {
    for fill in &curve.fills {
        canvas.polygon(fill, series.color, opacity(series));
    }
}

fn line(series: &Series, parts: &[Vec<Point>], canvas: &mut Canvas) {
    let Some(style) = series.line else {
        return;
    };
    for part in parts {
        for stroke in dashes(part, style) {
            canvas.line(&stroke, LINE_STROKE, series.color);
        }
    }
}

fn markers(series: &Series, curve: &Curve, canvas: &mut Canvas) {
    for &point in &curve.points {
        match series.marker {
            Some(shape) => marker::draw(canvas, shape, point, series.color, curve.edge),
            // A point without neighbours would leave no trace of a line.
            None => canvas.disc(point, 1.2 * LINE_STROKE, series.color),
        }
    }
}

fn error_bar(bar: &ErrorBar, color: Color, canvas: &mut Canvas) {
    canvas.line(
        &[(bar.x, bar.top), (bar.x, bar.bottom)],
        ERROR_STROKE,
        color,
    );
    for (y, cap) in [(bar.top, bar.caps[0]), (bar.bottom, bar.caps[1])] {
        if cap {
            canvas.line(
                &[(bar.x - ERROR_CAP, y), (bar.x + ERROR_CAP, y)],
                ERROR_STROKE,
                color,
            );
        }
    }
}

fn mark_lines(chart: &Chart, layout: &Layout, canvas: &mut Canvas) {
    for mark in &chart.marks {
        if let Marked::Line(from, to) = layout.marked(mark.place) {
            for stroke in dashes(&[from, to], LineStyle::Dashed) {
                canvas.line(&stroke, MARK_STROKE, mark.color);
            }
        }
    }
}

fn mark_rings(chart: &Chart, layout: &Layout, canvas: &mut Canvas) {
    for mark in &chart.marks {
        if let Marked::Point(point) = layout.marked(mark.place) {
            canvas.circle(point, MARK_RING, MARK_STROKE, mark.color);
        }
    }
}

fn leaders(chart: &Chart, labels: &[PlacedLabel], canvas: &mut Canvas) {
    for label in labels {
        if let (Some(mark), Some((from, to))) = (chart.marks.get(label.mark), label.leader) {
            canvas.line(&[from, to], LEADER_STROKE, mark.color);
        }
    }
}

fn mark_label(label: &PlacedLabel, canvas: &mut Canvas) {
    // The grid must not run through the text.
    canvas.rect(&label.rect.grown(-1.0), WHITE, 1.0);
    let middle = (label.rect.top + label.rect.bottom) / 2.0;
    let baseline = middle + (CAPITAL_EM - DESCENT_EM * 0.35) / 2.0 * label.text_px;
    let at = (label.rect.left + AIR, baseline);
    canvas.text(&label.text, at, label.text_px, Anchor::Start);
}

fn contour_labels(labels: &[ContourLabel], canvas: &mut Canvas) {
    for label in labels {
        // Letters are dark, and so are the colours of low values.
        canvas.rect(&label.rect, WHITE, 0.8);
        let middle = (label.rect.left + label.rect.right) / 2.0;
        let baseline = (label.rect.top + label.rect.bottom) / 2.0 + CAPITAL_EM / 2.0 * CONTOUR_TEXT;
        canvas.text(
            &label.text,
            (middle, baseline),
            CONTOUR_TEXT,
            Anchor::Middle,
        );
    }
}

fn draw_legend(chart: &Chart, curves: &[Curve], legend: &Legend, canvas: &mut Canvas) {
    if legend.framed {
        canvas.rect(&legend.rect, WHITE, 1.0);
        canvas.outline(&legend.rect, MAJOR_GRID_STROKE, MAJOR_GRID);
    }
    for entry in &legend.entries {
        let (place, at) = (entry.series, entry.at);
        let Some(series) = chart.series.get(place) else {
            continue;
        };
        let end = (at.0 + LEGEND_SAMPLE, at.1);
        let middle = (at.0 + LEGEND_SAMPLE / 2.0, at.1);
        if series.is_filled() {
            let height = 0.5 * LEGEND_ROW;
            let swatch = Rect::at(at.0, at.1 - height / 2.0, LEGEND_SAMPLE, height);
            canvas.rect(&swatch, series.color, opacity(series));
        }
        line(series, &[vec![at, end]], canvas);
        // Bars that all hide behind their markers are not explained either.
        let has_bars = |curve: &Curve| !curve.error_bars.is_empty();
        if curves.get(place).is_some_and(has_bars) {
            let bar = ErrorBar {
                x: middle.0,
                top: at.1 - 8.0,
                bottom: at.1 + 8.0,
                caps: [true, true],
            };
            error_bar(&bar, series.color, canvas);
        }
        if let Some(shape) = series.marker {
            marker::draw(canvas, shape, middle, series.color, MARKER_EDGE);
        }
        let first = at.1 + CAPITAL_EM / 2.0 * legend.text_px;
        for (place, line) in entry.lines.iter().enumerate() {
            let baseline = first + place as f64 * PITCH_EM * legend.text_px;
            let at = (end.0 + LEGEND_GAP, baseline);
            canvas.text(line, at, legend.text_px, Anchor::Start);
        }
    }
}

/// How much of its colour an area has.
fn opacity(series: &Series) -> f64 {
    if series.area_to.is_some() {
        1.0
    } else {
        FILL_OPACITY
    }
}
