//! A heat map, the layer of a chart below everything else: values on a grid of cells as colours, with a colour bar. Over a
//! surface, lengths along both axes are to one scale; elsewhere axes and colours may be logarithmic, with contour lines at the
//! labels of the colour bar.
//!
//! Thousands of cells as single shapes would make a picture of megabytes, in which seams show between the shapes. So cells of
//! one colour side by side are one box, all boxes of a colour are one path, and edges are not smoothed.

use std::borrow::Cow;
use std::sync::Arc;

use super::canvas::Canvas;
use super::color_bar::Bar;
use super::color_map::{LEVELS, color, level};
use super::contour;
use super::draw::arrange;
use super::drawing::{FINE, Paint};
use super::geometry::{Point, Rect};
use super::layout::Layout;
use super::look::*;
use super::scale::AxisMap;
use super::{Axis, Chart, ChartError, Color, Scale};

/// The shape of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MapShape {
    /// Lengths along y are to the scale of those along x.
    #[default]
    ToScale,
    /// To scale too, a square about the origin: the values are one row, from there to the edge, and turned about it.
    Turned,
    /// The picture is this high.
    HeightPx(u32),
}

/// Values on a grid of cells that are equal on the scales of the axes.
#[derive(Clone, Debug, Default, PartialEq)]
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

impl From<HeatMap> for Chart {
    /// The chart whose axes are those of the grid.
    fn from(map: HeatMap) -> Self {
        let axis = |label: &str, (low, high), scale| Axis {
            scale,
            ..Axis::linear(label).range(low, high)
        };
        let chart = Self::new(
            axis(&map.x_label, map.x_range, map.x_scale),
            axis(&map.y_label, map.y_range, map.y_scale),
        );
        let width_px = map.width_px;
        let height_px = match map.shape {
            MapShape::HeightPx(height_px) => height_px,
            MapShape::ToScale | MapShape::Turned => width_px,
        };
        Self {
            title: map.title.clone(),
            legend: None,
            map: Some(Arc::new(map)),
            ..chart
        }
        .size(width_px, height_px)
    }
}

/// The chart; where it is a map to scale, so high that lengths along y are to the scale of those along x.
pub(super) fn to_scale(chart: &Chart) -> Result<Cow<'_, Chart>, ChartError> {
    let Some(map) = chart.map.as_deref().filter(|map| map.is_to_scale()) else {
        return Ok(Cow::Borrowed(chart));
    };
    // Far from too low to be laid out.
    let square = chart.clone().size(chart.size.width_px, chart.size.width_px);
    let frame = arrange(&square)?.layout.frame;
    let shape = (map.y_range.1 - map.y_range.0) / (map.x_range.1 - map.x_range.0);
    let around = f64::from(square.size.height_px) - frame.height();
    let height = around + frame.width() * shape;
    Ok(Cow::Owned(
        square.size(chart.size.width_px, height.round().max(1.0) as u32),
    ))
}

impl HeatMap {
    /// Whether the map decides on the height of its chart.
    pub fn is_to_scale(&self) -> bool {
        match self.shape {
            MapShape::ToScale | MapShape::Turned => true,
            MapShape::HeightPx(_) => false,
        }
    }

    fn subject(&self) -> String {
        self.title
            .clone()
            .unwrap_or_else(|| self.value_label.clone())
    }

    /// The values at the ends of the colour bar.
    pub(super) fn checked_range(&self) -> Result<(f64, f64), ChartError> {
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
}

/// Everything below the ink: cells or discs, the colours of the bar, contour lines.
pub(super) fn colors(bar: &Bar, layout: &Layout, canvas: &Canvas) {
    if let Some(map) = &bar.map {
        match map.shape {
            MapShape::Turned => discs(map, bar, layout, canvas),
            MapShape::ToScale | MapShape::HeightPx(_) => {
                let mut boxes = Boxes::new();
                cells(map, bar, layout, &mut boxes);
                boxes.draw(bar, canvas);
            }
        }
    }
    let mut boxes = Boxes::new();
    bar.strips(&layout.frame, &mut boxes);
    boxes.draw(bar, canvas);
    if let Some(map) = &bar.map
        && map.contours
        && map.shape != MapShape::Turned
    {
        contours(map, bar, layout, canvas);
    }
}

/// Boxes by the level of their colour.
pub(super) struct Boxes(Vec<Vec<Rect>>);

impl Boxes {
    fn new() -> Self {
        Self(vec![Vec::new(); LEVELS])
    }

    pub(super) fn add(&mut self, level: usize, rect: Rect) {
        self.0[level].push(rect);
    }

    /// One path per colour.
    fn draw(self, bar: &Bar, canvas: &Canvas) {
        for (level, boxes) in self.0.iter().enumerate() {
            let paint = Paint::Fill {
                color: bar.color(level).rgb(),
                opacity: 1.0,
                crisp: true,
            };
            canvas.path(paint, |pen| boxes.iter().for_each(|rect| pen.rect(rect)));
        }
    }
}

/// The cells, those of one colour side by side as one box.
fn cells(map: &HeatMap, bar: &Bar, layout: &Layout, boxes: &mut Boxes) {
    let block = map.columns.max(map.rows).div_ceil(MOST_CELLS).max(1);
    let (columns, rows) = (map.columns.div_ceil(block), map.rows.div_ceil(block));
    let edge = |axis: &AxisMap, place: usize, count: usize| {
        along(axis, (place * block).min(count) as f64, count)
    };
    for row in 0..rows {
        let at = |column| Some(map.level(block_mean(map, block, column, row)?, bar.range));
        let mut column = 0;
        while column < columns {
            let here = at(column);
            let first = column;
            while column < columns && at(column) == here {
                column += 1;
            }
            if let Some(level) = here {
                let rect = Rect {
                    left: edge(&layout.x, first, map.columns),
                    right: edge(&layout.x, column, map.columns),
                    top: edge(&layout.y, row + 1, map.rows),
                    bottom: edge(&layout.y, row, map.rows),
                };
                boxes.add(level, rect);
            }
        }
    }
}

/// A profile turned about an axis: one disc per change of colour, from the edge of the map inwards. Circles stay round at any size,
/// and take a twentieth of the room of cells.
fn discs(map: &HeatMap, bar: &Bar, layout: &Layout, canvas: &Canvas) {
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
        let paint = Paint::Fill {
            color: level.map_or(WHITE, color).rgb(),
            opacity: 1.0,
            crisp: false,
        };
        canvas.path(paint, |pen| pen.circle(center, ring * (place + 1) as f64));
    }
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
fn contours(map: &HeatMap, bar: &Bar, layout: &Layout, canvas: &Canvas) {
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
    for tick in &bar.ticks.major {
        let paint = Paint::Stroke {
            color: contrast(map.level(tick.value, bar.range)).rgb(),
            width: MARK_STROKE * FINE,
            round_ends: true,
        };
        let segments = contour::segments(&values, map.columns, scaled(tick.value));
        canvas.path(paint, |pen| {
            for (from, to) in segments {
                pen.segment(px(from), px(to));
            }
        });
    }
}

/// Dots and rings, in what stands out against the cells below them.
pub(super) fn dots(bar: &Bar, layout: &Layout, canvas: &Canvas) {
    const DOT: f64 = 1.6;
    let Some(map) = &bar.map else {
        return;
    };
    let frame = &layout.frame;
    let below = |(x, y): Point| {
        let part =
            |value: f64, count: usize| ((value * count as f64) as usize).min(count.max(1) - 1);
        let column = part((x - frame.left) / frame.width(), map.columns);
        let row = part((frame.bottom - y) / frame.height(), map.rows);
        let value = map.values.get(row * map.columns + column);
        let value = value.copied().flatten();
        value.map_or(FRAME, |value| contrast(map.level(value, bar.range)))
    };
    for at in map.points.iter().map(|&point| layout.px(point)) {
        canvas.disc(at, DOT, below(at));
    }
    for at in map.rings.iter().map(|&point| layout.px(point)) {
        canvas.circle(at, 0.6 * MARK_RING, MARK_STROKE, below(at));
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
    use crate::report::chart::Size;
    use crate::report::chart::draw::Arrangement;
    use crate::report::chart::drawing::Shape;

    fn dome(columns: usize, rows: usize) -> HeatMap {
        let at = |i: usize, n: usize| 2.0 * (i as f64 + 0.5) / n as f64 - 1.0;
        let value = |cell: usize| {
            let (x, y) = (at(cell % columns, columns), at(cell / columns, rows));
            let inside = 0.8 - x * x - y * y;
            (inside > 0.0).then(|| 50.0 * inside.sqrt())
        };
        HeatMap {
            x_label: "x / µm".to_owned(),
            y_label: "y / µm".to_owned(),
            x_range: (-400.0, 400.0),
            y_range: (-200.0, 200.0),
            columns,
            rows,
            values: (0..columns * rows).map(value).collect(),
            value_label: "pressure p / MPa".to_owned(),
            width_px: 800,
            ..HeatMap::default()
        }
    }

    fn laid_out(map: HeatMap) -> Arrangement {
        arrange(&to_scale(&Chart::from(map)).unwrap()).unwrap()
    }

    fn svg(map: &HeatMap) -> String {
        Chart::from(map.clone()).draw().unwrap().to_svg()
    }

    /// The colours of the shapes that one of the functions of this file draws.
    fn painted(map: &HeatMap, draw: impl Fn(&Bar, &Layout, &Canvas)) -> Vec<String> {
        let Arrangement { layout, bar, .. } = laid_out(map.clone());
        let canvas = Canvas::new(Size::default());
        draw(&bar.unwrap(), &layout, &canvas);
        let color = |shape: &Shape| match shape.paint {
            Paint::Fill { color, .. } | Paint::Stroke { color, .. } => color,
        };
        let shapes = canvas.finish().unwrap();
        let hex = |[red, green, blue]: [u8; 3]| format!("#{red:02x}{green:02x}{blue:02x}");
        shapes.iter().map(|shape| hex(color(shape))).collect()
    }

    #[test]
    fn lengths_are_to_one_scale_along_both_axes() {
        let frame = laid_out(dome(20, 10)).layout.frame;
        let ratio = frame.width() / frame.height();
        // Whole pixels: one in 300.
        assert!((ratio - 2.0).abs() < 0.01, "{ratio}");
    }

    #[test]
    fn the_picture_is_small_and_has_neither_text_nor_references() {
        let svg = svg(&dome(128, 128));
        assert!(svg.len() < 500_000, "{}", svg.len());
        for unwanted in ["<text", "href", "url(", "<image"] {
            assert!(!svg.contains(unwanted), "{unwanted}");
        }
        assert!(svg.contains("<title>pressure p / MPa over the surface</title>"));
        let drawing = Chart::from(dome(128, 128)).draw().unwrap();
        assert!(drawing.to_png(1.0).unwrap().starts_with(b"\x89PNG"));
        // A large grid is averaged over blocks, not drawn cell by cell.
        let large = Chart::from(dome(1024, 1024)).draw().unwrap();
        assert!(large.to_svg().len() < 2_000_000);
    }

    #[test]
    fn every_painted_cell_has_the_colour_of_its_value() {
        let mut map = dome(2, 1);
        map.values = vec![Some(0.0), Some(8.0)];
        map.value_range = Some((0.0, 8.0));
        let of_cells = |map: &HeatMap| {
            painted(map, |bar, layout, canvas| {
                let mut boxes = Boxes::new();
                cells(map, bar, layout, &mut boxes);
                boxes.draw(bar, canvas);
            })
        };
        assert_eq!(of_cells(&map), ["#440154", "#fde725"]);
        map.values[0] = None;
        assert_eq!(of_cells(&map), ["#fde725"]);
    }

    #[test]
    fn a_turned_profile_is_discs_one_per_colour_and_blank_within_is_paper() {
        let mut map = dome(5, 1);
        map.y_range = map.x_range;
        map.shape = MapShape::Turned;
        map.value_range = Some((0.0, 8.0));
        map.values = vec![None, Some(8.0), Some(8.0), Some(0.0), None];
        let turned = |bar: &Bar, layout: &Layout, canvas: &Canvas| discs(&map, bar, layout, canvas);
        assert_eq!(painted(&map, turned), ["#440154", "#fde725", "#ffffff"]);
        let Arrangement { layout, bar, .. } = laid_out(map.clone());
        let canvas = Canvas::new(Size::default());
        discs(&map, &bar.unwrap(), &layout, &canvas);
        let outermost = canvas.finish().unwrap()[0].path.bounds().width();
        let expected = 0.8 * layout.frame.width() * FINE;
        // Single precision.
        assert!((f64::from(outermost) - expected).abs() < 1e-2);
        assert!(Chart::from(map).draw().is_ok());
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
        assert_eq!(Chart::from(map.clone()).size.height_px, 500);
        let layout = laid_out(map.clone()).layout;
        let middle = 0.5 * (layout.frame.left + layout.frame.right);
        assert!((layout.x.px(10.0) - middle).abs() < 1e-9); // rounding
        assert!(Chart::from(map.clone()).draw().is_ok());
        map.values[1] = Some(0.0);
        assert!(matches!(
            Chart::from(map).draw(),
            Err(ChartError::Map { .. })
        ));
    }

    #[test]
    fn maps_that_cannot_be_drawn_are_refused() {
        let mut short = dome(3, 3);
        short.values.pop();
        assert!(matches!(
            Chart::from(short).draw(),
            Err(ChartError::CellCount { found: 8, .. })
        ));
        let mut nan = dome(3, 3);
        nan.values[4] = Some(f64::NAN);
        assert!(matches!(
            Chart::from(nan).draw(),
            Err(ChartError::NotFinite { .. })
        ));
        let mut blank = dome(3, 3);
        blank.values.fill(None);
        assert!(matches!(
            Chart::from(blank).draw(),
            Err(ChartError::Map { .. })
        ));
        let mut upside_down = dome(3, 3);
        upside_down.value_range = Some((1.0, 0.0));
        assert!(matches!(
            Chart::from(upside_down).draw(),
            Err(ChartError::Map { .. })
        ));
    }
}
