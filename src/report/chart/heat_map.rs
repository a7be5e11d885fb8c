//! A heat map: values on a grid of cells as colours, with a colour bar. Over a surface, lengths along both axes are to one
//! scale; elsewhere axes and colours may be logarithmic, with contour lines at the labels of the colour bar.
//!
//! Thousands of cells as single shapes would make a picture of megabytes, in which seams show between the shapes. So cells of
//! one colour side by side are one box, all boxes of a colour are one path, and edges are not smoothed. Frame, ticks and
//! texts are drawn as in any chart.

use std::fmt::Write;

use super::canvas::{Canvas, at_real_size};
use super::check::check;
use super::color_bar::Bar;
use super::color_map::{LEVELS, color, level};
use super::contour;
use super::draw::{axes, texts};
use super::geometry::{Point, Rect};
use super::layout::{Layout, Reserve, Widths, lay_out, ranges};
use super::look::*;
use super::render::{Letters, finished};
use super::scale::AxisMap;
use super::ticks::Ticks;
use super::turned::discs;
use super::{Axis, Chart, ChartError, Color, Scale, Series};

/// The shape of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapShape {
    /// Lengths along y are to the scale of those along x.
    ToScale,
    /// To scale too, a square about the origin: the values are one row, from there to the edge, and turned about it.
    Turned,
    /// The picture is this high.
    HeightPx(u32),
}

/// Values on a grid of cells that are equal on the scales of the axes.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    /// Drawn above the frame.
    pub title: Option<String>,
    /// Labels of the axes, with their units.
    pub x_label: String,
    pub y_label: String,
    /// Where the grid begins and ends along x and y, in the units of the labels.
    pub x_range: (f64, f64),
    pub y_range: (f64, f64),
    pub x_scale: Scale,
    pub y_scale: Scale,
    pub columns: usize,
    pub rows: usize,
    /// Row by row, x fastest, the row of least y first; `None` leaves a cell blank.
    pub values: Vec<Option<f64>>,
    /// Quantity and unit, beside the colour bar.
    pub value_label: String,
    /// The values at the two ends of the colour bar; `None`: from zero or the least value to the largest.
    pub value_range: Option<(f64, f64)>,
    pub value_scale: Scale,
    /// Whether lines are drawn where the values are those labelled at the colour bar.
    pub contours: bool,
    /// Where something was computed, if the cells between are interpolated: drawn as dots.
    pub points: Vec<(f64, f64)>,
    /// What is pointed out: drawn as rings.
    pub rings: Vec<(f64, f64)>,
    /// Width of the picture at scale 1.
    pub width_px: u32,
    pub shape: MapShape,
}

/// More cells per side than this are not seen in a picture: blocks of cells are averaged.
const MOST_CELLS: usize = 256;

/// The map as SVG that needs no font and refers to no other file.
///
/// # Errors
/// [`ChartError`]: a wrong number of values, none at all, one that is not finite, ranges or texts that cannot be drawn.
pub fn heat_map_to_svg(map: &HeatMap, letters: Letters) -> Result<String, ChartError> {
    let range = map.checked_range()?;
    let chart = map.chart();
    check(&chart)?;
    let bar = Bar::new(map, range)?;
    let (chart, layout) = shaped(map, chart, &bar)?;
    let bar_map = bar.along(&layout.frame);
    let mut svg = String::new();
    let canvas = Canvas::new(&mut svg, chart.size);
    axes(&layout, &canvas)?;
    let Rect {
        left,
        top,
        right,
        bottom,
    } = layout.frame;
    canvas.line(
        &[(left, top), (right, top), (right, bottom)],
        FRAME_STROKE,
        FRAME,
    )?;
    let height_px = f64::from(chart.size.height_px);
    bar.draw((map, height_px), &layout.frame, &bar_map, &canvas)?;
    dots(map, &layout, range, &canvas)?;
    texts(&layout, &canvas)?;
    canvas.finish()?;
    let title = map.title.clone();
    let title = title.unwrap_or_else(|| format!("{} over the surface", map.value_label));
    let svg = finished(
        &at_real_size(&svg, chart.size)?,
        chart.size,
        &title,
        letters,
    )?;
    // Below all ink: right behind the title.
    let (head, ink) = svg.split_once("</title>").ok_or_else(|| ChartError::Draw {
        reason: "the picture has no title".to_owned(),
    })?;
    let (discs, cells) = match map.shape {
        MapShape::Turned => (discs(map, &layout, range), String::new()),
        MapShape::ToScale | MapShape::HeightPx(_) => (String::new(), cells(map, &layout, range)),
    };
    let colours = cells + &strips(&bar.rect(&layout.frame));
    let lines = contours(map, &layout, range, &bar.ticks);
    Ok(format!(
        "{head}</title>\n{discs} <g shape-rendering=\"crispEdges\">\n{colours} </g>\n{lines}{ink}"
    ))
}

impl HeatMap {
    fn subject(&self) -> String {
        self.title
            .clone()
            .unwrap_or_else(|| self.value_label.clone())
    }

    /// The values at the ends of the colour bar.
    fn checked_range(&self) -> Result<(f64, f64), ChartError> {
        let (columns, rows) = (self.columns, self.rows);
        if columns.checked_mul(rows) != Some(self.values.len()) {
            return Err(ChartError::CellCount {
                map: self.subject(),
                found: self.values.len(),
                columns,
                rows,
            });
        }
        let mut extent: Option<(f64, f64)> = None;
        for value in self.values.iter().flatten() {
            if !value.is_finite() {
                return Err(ChartError::NotFinite {
                    item: format!("the map of {}", self.subject()),
                    quantity: "value",
                    value: *value,
                });
            }
            let (low, high) = extent.unwrap_or((*value, *value));
            extent = Some((low.min(*value), high.max(*value)));
        }
        let Some((least, largest)) = extent else {
            return Err(ChartError::Map {
                map: self.subject(),
                reason: "every cell is blank",
            });
        };
        if self.value_scale == Scale::Log && self.value_range.map_or(least, |r| r.0) <= 0.0 {
            return Err(ChartError::Map {
                map: self.subject(),
                reason: "colours on a logarithmic scale begin above zero",
            });
        }
        let from = match self.value_scale {
            Scale::Linear => least.min(0.0),
            Scale::Log => least,
        };
        let (low, high) = self.value_range.unwrap_or((from, largest));
        if low < high && (high - low).is_finite() {
            return Ok((low, high));
        }
        if self.value_range.is_none() && low == high {
            // One value everywhere, and none above zero: some room about it.
            let room = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
            return Ok((low - room, high + room));
        }
        Err(ChartError::Map {
            map: self.subject(),
            reason: "the first end of the value range must be below the second",
        })
    }

    /// The level of a value's colour.
    pub(super) fn level(&self, value: f64, (low, high): (f64, f64)) -> usize {
        match self.value_scale {
            Scale::Linear => level(value, (low, high)),
            Scale::Log => level(value.log10(), (low.log10(), high.log10())),
        }
    }

    /// A chart with the axes of the map; what it shows is not drawn.
    fn chart(&self) -> Chart {
        let corners = [
            (self.x_range.0, self.y_range.0),
            (self.x_range.1, self.y_range.1),
        ];
        let axis = |label: &str, (low, high), scale| Axis {
            scale,
            ..Axis::linear(label).range(low, high)
        };
        let chart = Chart::new(
            axis(&self.x_label, self.x_range, self.x_scale),
            axis(&self.y_label, self.y_range, self.y_scale),
        )
        .series(Series::line(corners))
        .legend(None)
        .size(self.width_px, self.width_px);
        match &self.title {
            Some(title) => chart.title(title.clone()),
            None => chart,
        }
    }
}

/// Lays the chart out as high as asked for, or so high that lengths along y are to the scale of those along x.
fn shaped(map: &HeatMap, chart: Chart, bar: &Bar) -> Result<(Chart, Layout), ChartError> {
    let reserve = Reserve {
        right: bar.total_width(),
        ..Reserve::default()
    };
    let laid = |chart: &Chart| lay_out(chart, &ranges(chart)?, &Widths::measure(chart)?, reserve);
    if let MapShape::HeightPx(height) = map.shape {
        let chart = chart.size(map.width_px, height);
        let layout = laid(&chart)?;
        return Ok((chart, layout));
    }
    let layout = laid(&chart)?;
    let shape = (map.y_range.1 - map.y_range.0) / (map.x_range.1 - map.x_range.0);
    let around = f64::from(chart.size.height_px) - layout.frame.height();
    let height = around + layout.frame.width() * shape;
    let chart = chart.size(map.width_px, height.round().max(1.0) as u32);
    let layout = laid(&chart)?;
    Ok((chart, layout))
}

/// One path per colour: its boxes, given in px.
struct Paths {
    boxes: Vec<String>,
}

impl Paths {
    fn new() -> Self {
        Self {
            boxes: vec![String::new(); LEVELS],
        }
    }

    fn add(&mut self, level: usize, rect: &Rect) {
        let Rect {
            left,
            top,
            right,
            bottom,
        } = rect;
        // Writing to a String cannot fail.
        let _ = write!(
            self.boxes[level],
            "M{left:.2} {top:.2}H{right:.2}V{bottom:.2}H{left:.2}Z"
        );
    }

    fn finish(self) -> String {
        let mut text = String::new();
        for (level, boxes) in self.boxes.iter().enumerate() {
            if !boxes.is_empty() {
                let [red, green, blue] = color(level).rgb();
                let _ = writeln!(
                    text,
                    "  <path fill=\"#{red:02x}{green:02x}{blue:02x}\" d=\"{boxes}\"/>"
                );
            }
        }
        text
    }
}

/// The cells, those of one colour side by side as one box.
fn cells(map: &HeatMap, layout: &Layout, range: (f64, f64)) -> String {
    let block = map.columns.max(map.rows).div_ceil(MOST_CELLS).max(1);
    let (columns, rows) = (map.columns.div_ceil(block), map.rows.div_ceil(block));
    let x = |column: usize| {
        along(
            &layout.x,
            (column * block).min(map.columns) as f64,
            map.columns,
        )
    };
    let y = |row: usize| along(&layout.y, (row * block).min(map.rows) as f64, map.rows);
    let mut paths = Paths::new();
    for row in 0..rows {
        let at = |column| {
            let value = block_mean(map, block, column, row)?;
            Some(map.level(value, range))
        };
        let mut column = 0;
        while column < columns {
            let here = at(column);
            let first = column;
            while column < columns && at(column) == here {
                column += 1;
            }
            if let Some(level) = here {
                let rect = Rect {
                    left: x(first),
                    right: x(column),
                    top: y(row + 1),
                    bottom: y(row),
                };
                paths.add(level, &rect);
            }
        }
    }
    paths.finish()
}

/// So many of `count` cells along an axis, in px.
fn along(axis: &AxisMap, cells: f64, count: usize) -> f64 {
    axis.from_px + (axis.to_px - axis.from_px) * cells / count as f64
}

/// What stands out against a colour of the map.
fn contrast(level: usize) -> Color {
    if level < 5 * LEVELS / 8 { WHITE } else { FRAME }
}

/// The contour lines, one path for each labelled value.
fn contours(map: &HeatMap, layout: &Layout, range: (f64, f64), ticks: &Ticks) -> String {
    let mut text = String::new();
    if !map.contours || map.shape == MapShape::Turned {
        return text;
    }
    // On the scale of the colours the values are closer to linear between the cells.
    let scaled = |value: f64| match map.value_scale {
        Scale::Linear => value,
        Scale::Log => value.log10(),
    };
    let values: Vec<Option<f64>> = map.values.iter().map(|v| v.map(scaled)).collect();
    let px = |(x, y): Point| {
        let x = along(&layout.x, x, map.columns);
        (x, along(&layout.y, y, map.rows))
    };
    for tick in &ticks.major {
        let segments = contour::segments(&values, map.columns, scaled(tick.value));
        if segments.is_empty() {
            continue;
        }
        let [red, green, blue] = contrast(map.level(tick.value, range)).rgb();
        let _ = write!(
            text,
            " <path fill=\"none\" stroke=\"#{red:02x}{green:02x}{blue:02x}\" stroke-width=\"{MARK_STROKE}\" stroke-linecap=\"round\" d=\""
        );
        for (from, to) in segments {
            let (from, to) = (px(from), px(to));
            let _ = write!(text, "M{:.2} {:.2}L{:.2} {:.2}", from.0, from.1, to.0, to.1);
        }
        text.push_str("\"/>\n");
    }
    text
}

/// Dots and rings, in what stands out against the cells below them.
fn dots(
    map: &HeatMap,
    layout: &Layout,
    range: (f64, f64),
    canvas: &Canvas<'_>,
) -> Result<(), ChartError> {
    const DOT: f64 = 1.6;
    let frame = &layout.frame;
    let below = |(x, y): Point| {
        let part =
            |value: f64, count: usize| ((value * count as f64) as usize).min(count.max(1) - 1);
        let column = part((x - frame.left) / frame.width(), map.columns);
        let row = part((frame.bottom - y) / frame.height(), map.rows);
        let value = map
            .values
            .get(row * map.columns + column)
            .copied()
            .flatten();
        value.map_or(FRAME, |value| contrast(map.level(value, range)))
    };
    for at in map.points.iter().map(|&point| layout.px(point)) {
        canvas.disc(at, DOT, below(at))?;
    }
    for at in map.rings.iter().map(|&point| layout.px(point)) {
        canvas.circle(at, 0.6 * MARK_RING, MARK_STROKE, below(at))?;
    }
    Ok(())
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

/// The colours of the bar.
fn strips(bar: &Rect) -> String {
    let mut paths = Paths::new();
    let y = |level: usize| bar.bottom - bar.height() * level as f64 / LEVELS as f64;
    for level in 0..LEVELS {
        let rect = Rect {
            top: y(level + 1),
            bottom: y(level),
            ..*bar
        };
        paths.add(level, &rect);
    }
    paths.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::to_png;

    fn dome(columns: usize, rows: usize) -> HeatMap {
        let at = |i: usize, n: usize| 2.0 * (i as f64 + 0.5) / n as f64 - 1.0;
        let value = |cell: usize| {
            let (x, y) = (at(cell % columns, columns), at(cell / columns, rows));
            let inside = 0.8 - x * x - y * y;
            (inside > 0.0).then(|| 50.0 * inside.sqrt())
        };
        HeatMap {
            title: None,
            x_label: "x / µm".to_owned(),
            y_label: "y / µm".to_owned(),
            x_range: (-400.0, 400.0),
            y_range: (-200.0, 200.0),
            x_scale: Scale::Linear,
            y_scale: Scale::Linear,
            columns,
            rows,
            values: (0..columns * rows).map(value).collect(),
            value_label: "pressure p / MPa".to_owned(),
            value_range: None,
            value_scale: Scale::Linear,
            contours: false,
            points: Vec::new(),
            rings: Vec::new(),
            width_px: 800,
            shape: MapShape::ToScale,
        }
    }

    #[test]
    fn lengths_are_to_one_scale_along_both_axes() {
        let map = dome(20, 10);
        let range = map.checked_range().unwrap();
        let bar = Bar::new(&map, range).unwrap();
        let (_, layout) = shaped(&map, map.chart(), &bar).unwrap();
        let ratio = layout.frame.width() / layout.frame.height();
        // Whole pixels: one in 300.
        assert!((ratio - 2.0).abs() < 0.01, "{ratio}");
    }

    #[test]
    fn the_picture_is_small_and_has_neither_text_nor_references() {
        let svg = heat_map_to_svg(&dome(128, 128), Letters::Outlines).unwrap();
        assert!(svg.len() < 500_000, "{}", svg.len());
        for unwanted in ["<text", "href", "url(", "<image"] {
            assert!(!svg.contains(unwanted), "{unwanted}");
        }
        assert!(svg.contains("<title>pressure p / MPa over the surface</title>"));
        assert!(to_png(&svg, 1.0).unwrap().starts_with(b"\x89PNG"));
        // A large grid is averaged over blocks, not drawn cell by cell.
        assert!(
            heat_map_to_svg(&dome(1024, 1024), Letters::Outlines)
                .unwrap()
                .len()
                < 2_000_000
        );
    }

    #[test]
    fn every_painted_cell_has_the_colour_of_its_value() {
        let mut map = dome(2, 1);
        map.values = vec![Some(0.0), Some(8.0)];
        map.value_range = Some((0.0, 8.0));
        let range = map.checked_range().unwrap();
        let (_, layout) = shaped(&map, map.chart(), &Bar::new(&map, range).unwrap()).unwrap();
        let painted = cells(&map, &layout, range);
        assert_eq!(painted.matches("<path").count(), 2);
        assert!(painted.contains("#440154") && painted.contains("#fde725"));
        map.values[0] = None;
        assert_eq!(cells(&map, &layout, range).matches("<path").count(), 1);
    }

    #[test]
    fn a_turned_profile_is_discs_one_per_colour_and_blank_within_is_paper() {
        let mut map = dome(5, 1);
        map.y_range = map.x_range;
        map.shape = MapShape::Turned;
        map.value_range = Some((0.0, 8.0));
        map.values = vec![None, Some(8.0), Some(8.0), Some(0.0), None];
        let range = map.checked_range().unwrap();
        let (_, layout) = shaped(&map, map.chart(), &Bar::new(&map, range).unwrap()).unwrap();
        let drawn = discs(&map, &layout, range);
        let fills: Vec<&str> = drawn
            .split("fill=\"")
            .skip(1)
            .map(|part| &part[..7])
            .collect();
        assert_eq!(fills, ["#440154", "#fde725", "#ffffff"]);
        let outermost = format!("r=\"{:.2}\"", 0.4 * layout.frame.width());
        assert!(
            drawn.lines().next().unwrap().contains(&outermost),
            "{drawn}"
        );
        assert!(
            heat_map_to_svg(&map, Letters::Outlines)
                .unwrap()
                .contains(&drawn)
        );
    }

    #[test]
    fn on_logarithmic_scales_equal_ratios_are_equal_steps_of_place_and_colour() {
        let mut map = dome(3, 1);
        (map.x_range, map.x_scale) = ((1e-2, 1e4), Scale::Log);
        (map.values, map.value_scale) = (vec![Some(1.0), Some(10.0), Some(100.0)], Scale::Log);
        (map.shape, map.contours) = (MapShape::HeightPx(500), true);
        map.points = vec![(10.0, 0.0)];
        let range = map.checked_range().unwrap();
        assert_eq!(range, (1.0, 100.0));
        assert_eq!(map.level(10.0, range), LEVELS / 2);
        let bar = Bar::new(&map, range).unwrap();
        let (chart, layout) = shaped(&map, map.chart(), &bar).unwrap();
        assert_eq!(chart.size.height_px, 500);
        let middle = 0.5 * (layout.frame.left + layout.frame.right);
        assert!((layout.x.px(10.0) - middle).abs() < 1e-9); // rounding
        assert!(heat_map_to_svg(&map, Letters::Outlines).is_ok());
        map.values[1] = Some(0.0);
        assert!(matches!(
            heat_map_to_svg(&map, Letters::Outlines),
            Err(ChartError::Map { .. })
        ));
    }

    #[test]
    fn maps_that_cannot_be_drawn_are_refused() {
        let mut short = dome(3, 3);
        short.values.pop();
        assert!(matches!(
            heat_map_to_svg(&short, Letters::Outlines),
            Err(ChartError::CellCount { found: 8, .. })
        ));
        let mut nan = dome(3, 3);
        nan.values[4] = Some(f64::NAN);
        assert!(matches!(
            heat_map_to_svg(&nan, Letters::Outlines),
            Err(ChartError::NotFinite { .. })
        ));
        let mut blank = dome(3, 3);
        blank.values.fill(None);
        assert!(matches!(
            heat_map_to_svg(&blank, Letters::Outlines),
            Err(ChartError::Map { .. })
        ));
        let mut upside_down = dome(3, 3);
        upside_down.value_range = Some((1.0, 0.0));
        assert!(matches!(
            heat_map_to_svg(&upside_down, Letters::Outlines),
            Err(ChartError::Map { .. })
        ));
    }
}
