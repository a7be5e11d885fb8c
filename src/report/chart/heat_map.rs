//! A heat map, the layer of a chart below everything else: values on a grid of cells as colours, with a colour bar. Over a
//! surface, lengths along both axes are to one scale; elsewhere axes and colours may be logarithmic, with contour lines at the
//! labels of the colour bar.
//!
//! Thousands of cells as single shapes would make a picture of megabytes, in which seams show between the shapes. So cells of
//! one colour side by side are one box, all boxes of a colour are one path, and edges are not smoothed.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::arrange::arrange;
use super::canvas::Canvas;
use super::color_bar::Bar;
use super::color_map::{LEVELS, color, level};
use super::contour_labels::Contours;
use super::drawing::Paint;
use super::geometry::{Point, Rect};
use super::layout::Layout;
use super::look::*;
use super::scale::AxisMap;
use super::{Chart, ChartError, Color, Scale};
use crate::report::number::range;

/// The shape of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum MapShape {
    /// Lengths along y are to the scale of those along x.
    #[default]
    ToScale,
    /// To scale too, a square about the origin: the values are one row, from there to the edge, and turned about it.
    Turned,
    /// The picture is as high as its chart says.
    Stretched,
}

/// Values on a grid of cells that are equal on the scales of the axes, whose given ranges are those of the grid.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatMap {
    pub columns: usize,
    pub rows: usize,
    /// Row by row, x fastest, the row of least y first; `None` leaves a cell blank.
    pub values: Vec<Option<f64>>,
    /// Quantity and unit, beside the colour bar.
    pub value_label: String,
    /// The values at the two ends of the colour bar; `None`: from zero or the least value to the largest.
    pub value_range: Option<(f64, f64)>,
    pub value_scale: Scale,
    /// Whether lines are drawn where the values are those labelled at the colour bar, or, where that makes fewer than three, at values
    /// between; each line has its value in a gap.
    pub contours: bool,
    /// Where something was computed, if the cells between are interpolated: drawn as dots, as far as [`HeatMap::has_dots`].
    pub points: Vec<(f64, f64)>,
    /// What is pointed out: drawn as rings.
    pub rings: Vec<(f64, f64)>,
    pub shape: MapShape,
}

/// More cells per side than this are not seen in a picture: blocks of cells are averaged.
const MOST_CELLS: usize = 256;

/// The chart; where it is a map to scale, so high that lengths along y are to the scale of those along x.
pub(super) fn to_scale(chart: &Chart) -> Result<Cow<'_, Chart>, ChartError> {
    let is_to_scale = |map: &HeatMap| map.is_to_scale();
    if !chart.map.as_deref().is_some_and(is_to_scale) {
        return Ok(Cow::Borrowed(chart));
    }
    // A height changes the ticks, and with them the room that labels leave for the frame.
    const ROUNDS: usize = 12;
    let mut sized = chart.clone().size(chart.size.width_px, chart.size.width_px);
    for _ in 0..ROUNDS {
        let Layout { frame, x, y, .. } = arrange(&sized)?.layout;
        let shape = (y.high - y.low) / (x.high - x.low);
        let more = (frame.width() * shape - frame.height()).round();
        if more == 0.0 {
            break;
        }
        let height_px = f64::from(sized.size.height_px) + more;
        sized = sized.size(chart.size.width_px, height_px.max(1.0) as u32);
    }
    Ok(Cow::Owned(sized))
}

impl HeatMap {
    /// More dots than these would hide the colours: none is drawn.
    pub const MOST_DOTS: usize = 200;

    /// Whether the points are drawn as dots.
    pub fn has_dots(&self) -> bool {
        (1..=Self::MOST_DOTS).contains(&self.points.len())
    }

    /// Whether the map decides on the height of its chart.
    pub fn is_to_scale(&self) -> bool {
        self.shape != MapShape::Stretched
    }

    /// The values at the ends of the colour bar of the map, which errors call `name`.
    pub(super) fn checked_range(&self, name: &str) -> Result<(f64, f64), ChartError> {
        let refuse = |reason: &str| Err(ChartError::item(format!("the map of {name}"), reason));
        let (columns, rows) = (self.columns, self.rows);
        if columns.checked_mul(rows) != Some(self.values.len()) {
            let found = self.values.len();
            return refuse(&format!(
                "there are {found} values for {columns} columns and {rows} rows; give one per cell, None where there is none"
            ));
        }
        let values = || self.values.iter().flatten().copied();
        if let Some(value) = values().find(|value| !value.is_finite()) {
            return refuse(&format!(
                "a value is {value}, which is not a finite number; where a value is absent, leave it out (None)"
            ));
        }
        let (least, largest) = range(values());
        if least > largest {
            return refuse("every cell is blank");
        }
        if self.value_scale == Scale::Log && self.value_range.map_or(least, |r| r.0) <= 0.0 {
            return refuse("colours on a logarithmic scale begin above zero");
        }
        let from = match self.value_scale {
            Scale::Linear => least.min(0.0),
            Scale::Log => least,
        };
        Ok(match self.value_range {
            Some(range) => range,
            // One value everywhere, and none above zero: some room about it.
            None if from == largest => {
                let room = if from == 0.0 { 1.0 } else { 0.1 * from.abs() };
                (from - room, largest + room)
            }
            None => (from, largest),
        })
    }

    /// The level of a value's colour.
    pub(super) fn level(&self, value: f64, (low, high): (f64, f64)) -> usize {
        let scaled = |value| self.value_scale.linearised(value);
        level(scaled(value), (scaled(low), scaled(high)))
    }
}

/// Everything below the ink: cells or discs, and the colours of the bar.
pub(super) fn colors(bar: &Bar, layout: &Layout, canvas: &mut Canvas) {
    let map = bar.map.as_deref();
    match map {
        Some(map) if map.shape == MapShape::Turned => discs(map, bar, layout, canvas),
        Some(map) => boxes(cells(map, bar, layout), bar, canvas),
        None => {}
    }
    boxes(bar.strips(&layout.frame), bar, canvas);
}

/// Boxes, each with the level of its colour: one path per colour.
fn boxes(all: impl IntoIterator<Item = (usize, Rect)>, bar: &Bar, canvas: &mut Canvas) {
    let mut of_level = vec![Vec::new(); LEVELS];
    for (level, rect) in all {
        of_level[level].push(rect);
    }
    for (level, boxes) in of_level.iter().enumerate() {
        let paint = Paint::Fill {
            color: bar.color(level).rgb(),
            opacity: 1.0,
            crisp: true,
        };
        canvas.path(paint, |pen| boxes.iter().for_each(|rect| pen.rect(rect)));
    }
}

/// The cells, those of one colour side by side as one box, with the levels of their colours.
fn cells(map: &HeatMap, bar: &Bar, layout: &Layout) -> Vec<(usize, Rect)> {
    let mut boxes = Vec::new();
    let block = map.columns.max(map.rows).div_ceil(MOST_CELLS).max(1);
    let (columns, rows) = (map.columns.div_ceil(block), map.rows.div_ceil(block));
    let edge = |axis: &AxisMap, place: usize, count: usize| {
        along(axis, (place * block).min(count) as f64, count)
    };
    for row in 0..rows {
        let level = |column| Some(map.level(block_mean(map, block, column, row)?, bar.range));
        let levels: Vec<Option<usize>> = (0..columns).map(level).collect();
        let mut next = 0;
        for run in levels.chunk_by(|a, b| a == b) {
            let first = next;
            next += run.len();
            if let Some(level) = run[0] {
                let rect = Rect {
                    left: edge(&layout.x, first, map.columns),
                    right: edge(&layout.x, next, map.columns),
                    top: edge(&layout.y, row + 1, map.rows),
                    bottom: edge(&layout.y, row, map.rows),
                };
                boxes.push((level, rect));
            }
        }
    }
    boxes
}

/// A profile turned about an axis: one disc per change of colour, from the edge of the map inwards. Circles stay round at any size,
/// and take a twentieth of the room of cells.
fn discs(map: &HeatMap, bar: &Bar, layout: &Layout, canvas: &mut Canvas) {
    let frame = &layout.frame;
    let center = (
        0.5 * (frame.left + frame.right),
        0.5 * (frame.top + frame.bottom),
    );
    let ring = 0.5 * frame.width() / map.values.len().max(1) as f64;
    // Blank is what the paper is.
    let mut below = None;
    for (place, value) in map.values.iter().enumerate().rev() {
        let level = value.map(|value| map.level(value, bar.range));
        if level == below {
            continue;
        }
        below = level;
        let paint = Paint::fill(level.map_or(WHITE, color), 1.0);
        canvas.path(paint, |pen| pen.circle(center, ring * (place + 1) as f64));
    }
}

/// So many of `count` cells along an axis, in px.
pub(super) fn along(axis: &AxisMap, cells: f64, count: usize) -> f64 {
    axis.from_px + (axis.to_px - axis.from_px) * cells / count as f64
}

/// What stands out against a colour of the map.
pub(super) fn contrast(level: usize) -> Color {
    if level < 5 * LEVELS / 8 { WHITE } else { FRAME }
}

/// The contour lines, one path for each value.
pub(super) fn contour_lines(contours: &Contours, canvas: &mut Canvas) {
    for (color, lines) in &contours.lines {
        let paint = Paint::Stroke {
            color: color.rgb(),
            width: MARK_STROKE,
            round_ends: true,
        };
        canvas.path(paint, |pen| {
            for pair in lines.iter().flat_map(|line| line.windows(2)) {
                pen.segment(pair[0], pair[1]);
            }
        });
    }
}

/// What stands out against the colour below a point.
fn ink_at(map: &HeatMap, bar: &Bar, frame: &Rect, (x, y): Point) -> Color {
    let part = |value: f64, count: usize| ((value * count as f64) as usize).min(count.max(1) - 1);
    let column = part((x - frame.left) / frame.width(), map.columns);
    let row = part((frame.bottom - y) / frame.height(), map.rows);
    let value = map.values.get(row * map.columns + column);
    let value = value.copied().flatten();
    value.map_or(FRAME, |value| contrast(map.level(value, bar.range)))
}

/// Where something was computed.
pub(super) fn dots(bar: &Bar, layout: &Layout, canvas: &mut Canvas) {
    const DOT: f64 = 1.6;
    let Some(map) = bar.map.as_ref().filter(|map| map.has_dots()) else {
        return;
    };
    for at in map.points.iter().map(|&point| layout.px(point)) {
        canvas.disc(at, DOT, ink_at(map, bar, &layout.frame, at));
    }
}

/// What is pointed out.
pub(super) fn rings(bar: &Bar, layout: &Layout, canvas: &mut Canvas) {
    let Some(map) = &bar.map else {
        return;
    };
    for at in map.rings.iter().map(|&point| layout.px(point)) {
        let color = ink_at(map, bar, &layout.frame, at);
        canvas.circle(at, 0.6 * MARK_RING, MARK_STROKE, color);
    }
}

/// The mean over the values of a block of cells; `None` where all are blank.
fn block_mean(map: &HeatMap, block: usize, column: usize, row: usize) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for iy in row * block..((row + 1) * block).min(map.rows) {
        for ix in column * block..((column + 1) * block).min(map.columns) {
            if let Some(value) = map.values[iy * map.columns + ix] {
                sum += value;
                count += 1.0;
            }
        }
    }
    (count > 0.0).then(|| sum / count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::Axis;
    use crate::report::chart::arrange::Arrangement;
    use crate::report::chart::drawing::Shape;

    fn dome(columns: usize, rows: usize) -> HeatMap {
        let at = |i: usize, n: usize| 2.0 * (i as f64 + 0.5) / n as f64 - 1.0;
        let value = |cell: usize| {
            let (x, y) = (at(cell % columns, columns), at(cell / columns, rows));
            let inside = 0.8 - x * x - y * y;
            (inside > 0.0).then(|| 50.0 * inside.sqrt())
        };
        HeatMap {
            columns,
            rows,
            values: (0..columns * rows).map(value).collect(),
            value_label: "pressure p / MPa".to_owned(),
            ..HeatMap::default()
        }
    }

    fn chart(map: HeatMap) -> Chart {
        let x = Axis::linear("x / µm").range(-400.0, 400.0);
        let y = Axis::linear("y / µm").range(-200.0, 200.0);
        Chart::new(x, y).map(map)
    }

    fn laid_out(chart: &Chart) -> Arrangement {
        arrange(&to_scale(chart).unwrap()).unwrap()
    }

    fn svg(map: &HeatMap) -> String {
        chart(map.clone()).draw().unwrap().to_svg()
    }

    /// The colours of the shapes that one of the functions of this file draws.
    fn painted(chart: &Chart, draw: impl Fn(&Bar, &Layout, &mut Canvas)) -> Vec<String> {
        let layout = laid_out(chart).layout;
        let mut canvas = Canvas::new(chart);
        draw(layout.bar.as_ref().unwrap(), &layout, &mut canvas);
        let color = |shape: &Shape| match shape.paint {
            Paint::Fill { color, .. } | Paint::Stroke { color, .. } => color,
        };
        let shapes = canvas.finish().unwrap();
        let hex = |[red, green, blue]: [u8; 3]| format!("#{red:02x}{green:02x}{blue:02x}");
        shapes.iter().map(|shape| hex(color(shape))).collect()
    }

    #[test]
    fn lengths_are_to_one_scale_along_both_axes_at_any_size() {
        for width_px in (400..900).step_by(7) {
            for (x, y) in [
                (400.0, 200.0),
                (7.3, 7.3),
                (0.0301, 0.04),
                (1.0, 3.0),
                (333.0, 400.0),
            ] {
                let mut chart = chart(dome(20, 10)).size(width_px, 1).title("t = 10 s");
                chart.x = Axis::linear("x / µm").range(-x, x);
                chart.y = Axis::linear("y / µm").range(-y, y);
                let frame = laid_out(&chart).layout.frame;
                let wanted = frame.width() * y / x;
                assert!(
                    (frame.height() - wanted).abs() <= 1.0,
                    "{width_px} px: {frame:?} for {x} x {y}"
                );
            }
        }
    }

    #[test]
    fn the_picture_is_small_and_has_neither_text_nor_references() {
        let svg = svg(&dome(128, 128));
        assert!(svg.len() < 500_000, "{}", svg.len());
        for unwanted in ["<text", "href", "url(", "<image"] {
            assert!(!svg.contains(unwanted), "{unwanted}");
        }
        assert!(svg.contains("<title>pressure p / MPa over the surface</title>"));
        let drawing = chart(dome(128, 128)).draw().unwrap();
        assert!(drawing.to_png(1.0).unwrap().starts_with(b"\x89PNG"));
        // A large grid is averaged over blocks, not drawn cell by cell.
        let large = chart(dome(1024, 1024)).draw().unwrap();
        assert!(large.to_svg().len() < 2_000_000);
    }

    #[test]
    fn every_painted_cell_has_the_colour_of_its_value() {
        let mut map = dome(2, 1);
        map.values = vec![Some(0.0), Some(8.0)];
        map.value_range = Some((0.0, 8.0));
        let of_cells = |map: &HeatMap| {
            painted(&chart(map.clone()), |bar, layout, canvas| {
                boxes(cells(map, bar, layout), bar, canvas);
            })
        };
        assert_eq!(of_cells(&map), ["#440154", "#fde725"]);
        map.values[0] = None;
        assert_eq!(of_cells(&map), ["#fde725"]);
    }

    #[test]
    fn a_turned_profile_is_discs_one_per_colour_and_blank_within_is_paper() {
        let mut map = dome(5, 1);
        map.shape = MapShape::Turned;
        map.value_range = Some((0.0, 8.0));
        map.values = vec![None, Some(8.0), Some(8.0), Some(0.0), None];
        let turned =
            |bar: &Bar, layout: &Layout, canvas: &mut Canvas| discs(&map, bar, layout, canvas);
        let mut chart = chart(map.clone());
        chart.y.range = chart.x.range;
        assert_eq!(painted(&chart, turned), ["#440154", "#fde725", "#ffffff"]);
        let layout = laid_out(&chart).layout;
        let mut canvas = Canvas::new(&chart);
        discs(&map, layout.bar.as_ref().unwrap(), &layout, &mut canvas);
        let outermost = canvas.finish().unwrap()[0].path.bounds().width();
        let expected = 0.8 * layout.frame.width();
        // Single precision.
        assert!((f64::from(outermost) - expected).abs() < 1e-2);
        assert!(chart.draw().is_ok());
    }

    #[test]
    fn on_logarithmic_scales_equal_ratios_are_equal_steps_of_place_and_colour() {
        let mut map = dome(3, 1);
        (map.values, map.value_scale) = (vec![Some(1.0), Some(10.0), Some(100.0)], Scale::Log);
        (map.shape, map.contours) = (MapShape::Stretched, true);
        map.points = vec![(10.0, 0.0)];
        let range = map.checked_range("x").unwrap();
        assert_eq!(range, (1.0, 100.0));
        assert_eq!(map.level(10.0, range), LEVELS / 2);
        let chart = |map: &HeatMap| Chart {
            x: Axis::log("x / µm").range(1e-2, 1e4),
            ..chart(map.clone()).size(800, 500)
        };
        let chart_of_map = chart(&map);
        assert_eq!(to_scale(&chart_of_map).unwrap().size.height_px, 500);
        let layout = laid_out(&chart_of_map).layout;
        let middle = 0.5 * (layout.frame.left + layout.frame.right);
        assert!((layout.x.px(10.0) - middle).abs() < 1e-9); // rounding
        assert!(chart_of_map.draw().is_ok());
        map.values[1] = Some(0.0);
        refused(&map, "colours on a logarithmic scale begin above zero");
    }

    #[track_caller]
    fn refused(map: &HeatMap, why: &str) {
        let error = chart(map.clone()).draw().unwrap_err().to_string();
        assert!(error.contains(why), "{error}");
    }

    #[test]
    fn maps_that_cannot_be_drawn_are_refused() {
        let mut map = dome(3, 3);
        map.values.pop();
        refused(&map, "8 values for 3 columns and 3 rows");
        let mut map = dome(3, 3);
        map.values[4] = Some(f64::NAN);
        refused(&map, "a value is NaN");
        map.values.fill(None);
        refused(&map, "every cell is blank");
        let mut map = dome(3, 3);
        map.value_range = Some((1.0, 0.0));
        refused(
            &map,
            "the first end of the value range must be below the second",
        );
    }
}
