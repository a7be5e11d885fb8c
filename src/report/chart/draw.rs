//! Draws charts: what lies below, data, marks, axes, texts, in this order from back to front.

use std::borrow::Cow;

use super::canvas::Canvas;
use super::check::{check, subject};
use super::color_bar::Bar;
use super::curves::{Curve, ErrorBar, Obstacles, curves};
use super::drawing::{Drawing, Shape};
use super::geometry::{Point, Rect};
use super::layout::{Layout, Marked, Reserve, Widths, crisp, lay_out, ranges};
use super::legend::{Legend, Outside};
use super::look::*;
use super::place::{self, AIR, PlacedLabel};
use super::stroke::dashes;
use super::text::{Anchor, CAPITAL_EM, DESCENT_EM};
use super::{Chart, ChartError, Color, LegendPlace, LineStyle, Series, Size, heat_map, marker};

/// Everything in its place.
pub(super) struct Arrangement {
    pub(super) layout: Layout,
    pub(super) curves: Vec<Curve>,
    pub(super) legend: Option<Legend>,
    pub(super) labels: Vec<PlacedLabel>,
    /// The colours of a map.
    pub(super) bar: Option<Bar>,
}

impl Chart {
    /// The finished picture.
    ///
    /// # Errors
    /// [`ChartError`] where the chart has no point, or a value, text or range that cannot be drawn.
    pub fn draw(&self) -> Result<Drawing, ChartError> {
        stack(std::slice::from_ref(self))
    }
}

/// The charts as one picture, one above another, the first at the top: quantities of one history, each on its own axis. Leave the x
/// label of all but the last empty, and the frames, which are in line, move together.
///
/// # Errors
/// [`ChartError::EmptyStack`] without a chart; otherwise as [`Chart::draw`].
pub fn stack(charts: &[Chart]) -> Result<Drawing, ChartError> {
    let charts = charts.iter().map(heat_map::to_scale);
    let charts: Vec<Cow<'_, Chart>> = charts.collect::<Result<_, _>>()?;
    let mut left = 0.0_f64;
    if charts.len() > 1 {
        for chart in &charts {
            left = left.max(arrange(chart)?.layout.frame.left);
        }
    }
    let width_px = charts.iter().map(|chart| chart.size.width_px).max();
    let mut size = Size {
        width_px: width_px.ok_or(ChartError::EmptyStack)?,
        height_px: 0,
    };
    let mut drawn = Vec::new();
    for chart in &charts {
        let top = f64::from(size.height_px);
        let shapes = shapes(chart, left)?.into_iter();
        drawn.extend(shapes.filter_map(|shape| shape.moved_down(top)));
        size.height_px += chart.size.height_px;
    }
    let titles: Vec<String> = charts.iter().map(|chart| subject(chart)).collect();
    Ok(Drawing {
        size,
        paper: None,
        title: titles.join("; "),
        description: None,
        sweep_hash: None,
        families: charts
            .first()
            .map_or_else(String::new, |chart| chart.typeface.families()),
        shapes: drawn,
    })
}

/// The shapes of a chart whose frame begins no further left than `left`.
fn shapes(chart: &Chart, left: f64) -> Result<Vec<Shape>, ChartError> {
    let arrangement = arrange_beside(chart, left)?;
    let mut canvas = Canvas::new(chart);
    paint(chart, &arrangement, &mut canvas);
    canvas.finish()
}

/// Decides where everything goes.
pub(super) fn arrange(chart: &Chart) -> Result<Arrangement, ChartError> {
    arrange_beside(chart, 0.0)
}

/// As [`arrange`], with a frame that begins no further left than `left`.
fn arrange_beside(chart: &Chart, left: f64) -> Result<Arrangement, ChartError> {
    check(chart)?;
    let bar = Bar::of(chart)?;
    let of_bar = bar.as_ref().map_or(0.0, Bar::total_width);
    let beside = |reserve: Reserve| Reserve {
        left,
        right: reserve.right + of_bar,
        ..reserve
    };
    let widths = Widths::measure(chart);
    let ranges = ranges(chart)?;
    let plain = lay_out(chart, &ranges, &widths, beside(Reserve::default()))?;
    let inside = |layout: Layout, legend: Option<Legend>| {
        let curves = curves(chart, &layout);
        (layout, curves, legend)
    };
    let outside = |legend: Legend, side: Outside| {
        let layout = lay_out(chart, &ranges, &widths, beside(legend.reserve(side)))?;
        let legend = legend.outside(&layout, side);
        Ok::<_, ChartError>(inside(layout, Some(legend)))
    };
    let column = Legend::column(chart, &widths, plain.frame.width());
    let width = f64::from(chart.size.width_px) - 2.0 * MARGIN;
    let rows = Legend::rows(chart, &widths, width);
    let (layout, curves, legend) = match (chart.legend, column, rows) {
        (Some(LegendPlace::Right), Some(column), _) if column.leaves_room_beside(&plain) => {
            outside(column, Outside::Right)?
        }
        (Some(LegendPlace::Right | LegendPlace::Above), _, Some(rows)) => {
            outside(rows, Outside::Above)?
        }
        (Some(LegendPlace::Auto), Some(column), Some(rows)) => {
            let curves = curves(chart, &plain);
            match column.where_free(&plain, &Obstacles::of(chart, &plain, &curves)) {
                Ok(legend) => (plain, curves, Some(legend)),
                Err(column) if column.suits_right(&plain) => outside(column, Outside::Right)?,
                Err(_) => outside(rows, Outside::Above)?,
            }
        }
        (Some(corner), Some(column), _) => {
            let legend = column.in_corner(&plain, corner);
            inside(plain, Some(legend))
        }
        _ => inside(plain, None),
    };
    let mut obstacles = Obstacles::of(chart, &layout, &curves);
    obstacles
        .boxes
        .extend(legend.as_ref().map(|legend| legend.rect));
    let labels = place::labels(chart, &layout, &widths, obstacles);
    Ok(Arrangement {
        layout,
        curves,
        legend,
        labels,
        bar,
    })
}

fn paint(chart: &Chart, arrangement: &Arrangement, canvas: &mut Canvas) {
    let Arrangement {
        layout,
        curves,
        legend,
        labels,
        bar,
    } = arrangement;
    if chart.map.is_none() {
        grid(layout, canvas);
    }
    if let Some(bar) = bar {
        heat_map::colors(bar, layout, canvas);
    }
    for (series, curve) in chart.series.iter().zip(curves) {
        for fill in &curve.fills {
            canvas.polygon(fill, series.color, opacity(series));
        }
    }
    mark_lines(chart, layout, canvas);
    for (series, curve) in chart.series.iter().zip(curves) {
        line(series, &curve.parts, canvas);
    }
    axes(layout, canvas);
    if let Some(bar) = bar {
        bar.draw(&layout.frame, f64::from(chart.size.height_px), canvas);
        heat_map::dots(bar, layout, canvas);
    }
    // Below the markers, so that no ring hides a data point.
    mark_rings(chart, layout, canvas);
    for (series, curve) in chart.series.iter().zip(curves) {
        for bar in &curve.error_bars {
            error_bar(bar, series.color, canvas);
        }
        markers(series, &curve.points, canvas);
    }
    if let Some(legend) = legend {
        draw_legend(chart, curves, legend, canvas);
    }
    for label in labels {
        mark_label(chart, label, canvas);
    }
    // Title and axis labels.
    for text in &layout.texts {
        canvas.text(&text.text, text.at, text.size, text.anchor);
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

/// The left and lower side of the frame, the ticks and their labels.
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
    let [top_left, _, bottom_right, bottom_left] = frame.corners();
    canvas.line(&[top_left, bottom_left, bottom_right], FRAME_STROKE, FRAME);
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

fn markers(series: &Series, points: &[Point], canvas: &mut Canvas) {
    for &point in points {
        match series.marker {
            Some(shape) => marker::draw(canvas, shape, point, series.color),
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

fn mark_label(chart: &Chart, label: &PlacedLabel, canvas: &mut Canvas) {
    let Some(mark) = chart.marks.get(label.mark) else {
        return;
    };
    if let Some((from, to)) = label.leader {
        canvas.line(&[from, to], LEADER_STROKE, mark.color);
    }
    // The grid must not run through the text.
    canvas.rect(&label.rect.grown(-1.0), WHITE, 1.0);
    let middle = (label.rect.top + label.rect.bottom) / 2.0;
    let baseline = middle + (CAPITAL_EM - DESCENT_EM * 0.35) / 2.0 * label.text_px;
    let at = (label.rect.left + AIR, baseline);
    canvas.text(&mark.label, at, label.text_px, Anchor::Start);
}

fn draw_legend(chart: &Chart, curves: &[Curve], legend: &Legend, canvas: &mut Canvas) {
    if legend.framed {
        canvas.rect(&legend.rect, WHITE, 1.0);
        canvas.outline(&legend.rect, MAJOR_GRID_STROKE, MAJOR_GRID);
    }
    for &(place, at) in &legend.entries {
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
        if series.marker.is_some() {
            markers(series, &[middle], canvas);
        }
        let baseline = at.1 + CAPITAL_EM / 2.0 * legend.text_px;
        let text = series.label.as_deref().unwrap_or("");
        let hold = Anchor::Start;
        canvas.text(text, (end.0 + LEGEND_GAP, baseline), legend.text_px, hold);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, Mark, Marker};

    fn rising() -> Chart {
        let points = (0..=50).map(|k| (f64::from(k), f64::from(k).powi(2)));
        Chart::new(Axis::linear("x"), Axis::linear("y"))
            .series(Series::line(points).marker(Marker::Disc).label("rising"))
    }

    fn wild() -> Chart {
        let points = (0..=400).map(|k| (f64::from(k), (f64::from(k) * 0.9).sin()));
        Chart::new(Axis::linear("x"), Axis::linear("y")).series(Series::line(points).label("wild"))
    }

    fn peak(x_peak: f64, label: &str) -> Chart {
        let points = (0..=60).map(|k| {
            (
                f64::from(k),
                1.0 / (1.0 + (f64::from(k) - x_peak).powi(2) / 40.0),
            )
        });
        Chart::new(Axis::linear("x"), Axis::linear("y"))
            .series(Series::line(points).marker(Marker::Disc))
            .mark(Mark::point(x_peak, 1.0, label))
    }

    fn inside(outer: &Rect, inner: &Rect) -> bool {
        outer.contains((inner.left, inner.top)) && outer.contains((inner.right, inner.bottom))
    }

    #[test]
    fn a_legend_goes_where_no_data_are() {
        let Arrangement {
            layout,
            curves,
            legend,
            ..
        } = arrange(&rising()).unwrap();
        let legend = legend.unwrap();
        assert!(inside(&layout.frame, &legend.rect));
        assert!(
            curves[0]
                .points
                .iter()
                .all(|&point| !legend.rect.contains(point))
        );
        // The upper right corner, tried first, is taken by the curve.
        assert!(legend.rect.right < (layout.frame.left + layout.frame.right) / 2.0);
    }

    #[test]
    fn a_legend_without_a_free_place_goes_outside() {
        let Arrangement { layout, legend, .. } = arrange(&wild()).unwrap();
        assert!(!legend.unwrap().rect.overlaps(&layout.frame));
    }

    #[test]
    fn a_legend_goes_where_it_is_told() {
        let corner = |place: LegendPlace| {
            arrange(&rising().legend(place))
                .unwrap()
                .legend
                .unwrap()
                .rect
        };
        assert!(corner(LegendPlace::TopRight).left > corner(LegendPlace::TopLeft).right);
        assert!(corner(LegendPlace::BottomLeft).top > corner(LegendPlace::TopLeft).bottom);
        assert!(arrange(&rising().legend(None)).unwrap().legend.is_none());
    }

    #[test]
    fn the_label_of_a_peak_stays_in_the_frame_and_clear_of_ring_and_curve() {
        for x_peak in [0.0, 3.0, 30.0, 57.0, 60.0] {
            let chart = peak(x_peak, "ω = 8.44 × 10⁻³ rad/s");
            let Arrangement {
                layout,
                curves,
                labels,
                ..
            } = arrange(&chart).unwrap();
            let rect = labels[0].rect;
            assert!(inside(&layout.frame, &rect), "{x_peak}: {rect:?}");
            let ring = layout.px((x_peak, 1.0));
            assert!(
                super::super::geometry::distance(rect.nearest(ring), ring) > MARK_RING,
                "{x_peak}"
            );
            let obstacles = Obstacles::of(&chart, &layout, &curves);
            assert!(obstacles.spare(&rect), "{x_peak}: covers the curve");
        }
    }

    #[test]
    fn labels_of_neighbouring_peaks_do_not_overlap() {
        let chart = peak(30.0, "the first of two peaks").mark(Mark::point(
            31.0,
            0.97,
            "the second of two peaks",
        ));
        let labels = arrange(&chart).unwrap().labels;
        assert!(!labels[0].rect.overlaps(&labels[1].rect));
    }

    #[test]
    fn the_label_of_a_line_stays_in_the_frame_even_at_its_edge() {
        for x in [0.0, 1.0, 49.0, 50.0] {
            let chart = rising()
                .mark(Mark::vertical(x, "x at the edge"))
                .mark(Mark::horizontal(50.0 * x, "y at the edge"));
            let Arrangement { layout, labels, .. } = arrange(&chart).unwrap();
            assert_eq!(labels.len(), 2);
            assert!(
                labels
                    .iter()
                    .all(|label| inside(&layout.frame, &label.rect)),
                "{x}"
            );
        }
    }

    #[test]
    fn data_outside_a_given_range_are_cut_at_the_frame() {
        let mut chart = rising();
        chart.y = chart.y.range(100.0, 900.0);
        let Arrangement { layout, curves, .. } = arrange(&chart).unwrap();
        let reach = layout.frame.grown(0.02); // sixteenths of a px are finer still
        assert!(
            curves[0]
                .parts
                .iter()
                .flatten()
                .all(|&point| reach.contains(point))
        );
        assert_eq!(curves[0].points.len(), 21); // 10² ... 30²
    }

    #[test]
    fn an_absent_value_breaks_the_line() {
        let points = [
            Some((0.0, 0.0)),
            Some((1.0, 1.0)),
            None,
            Some((3.0, 2.0)),
            Some((4.0, 3.0)),
        ];
        let chart = Chart::new(Axis::linear("x"), Axis::linear("y")).series(Series::line(points));
        assert_eq!(arrange(&chart).unwrap().curves[0].parts.len(), 2);
    }

    #[test]
    fn an_error_bar_that_reaches_zero_on_a_log_axis_runs_out_of_the_frame() {
        let series = Series::scatter([(1.0, 1.0), (2.0, 10.0)]).error_bars([2.0, 1.0]);
        let chart = Chart::new(Axis::linear("x"), Axis::log("y")).series(series);
        let Arrangement { layout, curves, .. } = arrange(&chart).unwrap();
        let bars = &curves[0].error_bars;
        assert_eq!(
            (bars[0].caps, bars[0].bottom),
            ([true, false], layout.frame.bottom)
        );
        assert_eq!(bars[1].caps, [true, true]);
    }

    #[test]
    fn a_mark_outside_a_given_range_is_refused() {
        let mut chart = rising().mark(Mark::point(60.0, 1.0, "peak"));
        chart.x = chart.x.range(0.0, 50.0);
        let error = arrange(&chart).err().unwrap();
        assert!(matches!(error, ChartError::MarkOutside { .. }));
        assert!(
            error.to_string().contains("the mark 'peak': its x 60"),
            "{error}"
        );
    }

    #[test]
    fn data_that_a_given_range_leaves_out_altogether_are_refused() {
        let mut chart = rising();
        chart.x = chart.x.range(100.0, 200.0);
        assert!(matches!(arrange(&chart), Err(ChartError::Empty { .. })));
    }

    #[test]
    fn a_picture_too_small_or_too_large_is_refused() {
        for (width, height) in [
            (100, 600),
            (800, 90),
            (0, 0),
            (40_000, 600),
            (u32::MAX, u32::MAX),
        ] {
            let result = arrange(&rising().size(width, height));
            assert!(
                matches!(result, Err(ChartError::Size { .. })),
                "{width} {height}"
            );
        }
    }

    fn panel(x_label: &str, largest: f64) -> Chart {
        let points = (0..=10).map(|k| (f64::from(k), largest * f64::from(k)));
        Chart::new(Axis::linear(x_label), Axis::linear("load W / N"))
            .series(Series::line(points))
            .size(800, 260)
    }

    #[test]
    fn the_picture_is_as_high_as_its_charts_and_has_no_text() {
        let charts = [panel("", 1.0), panel("", 1e4), panel("time t / s", 0.1)];
        let drawing = stack(&charts).unwrap();
        let svg = drawing.to_svg();
        assert!(svg.starts_with(r#"<svg width="800" height="780""#));
        for unwanted in ["<text", "href", "url("] {
            assert!(!svg.contains(unwanted), "{unwanted}");
        }
        let png = drawing.to_png(1.0).unwrap();
        let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
        assert_eq!((number(16), number(20)), (800, 780));
    }

    #[test]
    fn the_frames_are_in_line_whatever_their_labels() {
        let (narrow, wide) = (panel("", 1.0), panel("", 123_456.0));
        let left = |chart: &Chart| arrange(chart).unwrap().layout.frame.left;
        assert!(left(&narrow) < left(&wide));
        // The wide chart is the same in company as alone; the narrow one makes room.
        let both = [wide, narrow];
        // Where each shape of a stack begins.
        let lefts = |charts: &[Chart]| {
            let shapes = stack(charts).unwrap().shapes.into_iter();
            let lefts = shapes.map(|shape| shape.path.bounds().left());
            lefts.collect::<Vec<_>>()
        };
        let (alone, stacked) = (lefts(&both[..1]), lefts(&both));
        let (first, second) = stacked.split_at(alone.len());
        assert_eq!(alone, first);
        assert_ne!(lefts(&both[1..]), second);
        assert!(matches!(stack(&[]), Err(ChartError::EmptyStack)));
    }
}
