//! A heat map: values on a grid of cells as colours, with a colour bar. Lengths along both axes are to one scale.
//!
//! Thousands of cells as single shapes would make a picture of megabytes, in which seams show between the shapes. So cells of
//! one colour side by side are one box, all boxes of a colour are one path, and edges are not smoothed. Frame, ticks and
//! texts are drawn as in any chart.

use std::fmt::Write;

use super::canvas::{Anchor, Canvas, Direction, at_real_size};
use super::check::check;
use super::color_map::{LEVELS, color, level};
use super::draw::{axes, texts};
use super::geometry::Rect;
use super::layout::{Layout, Reserve, Widths, crisp, lay_out, ranges};
use super::look::*;
use super::render::finished;
use super::scale::AxisMap;
use super::text::{ASCENT_EM, CAPITAL_EM, DESCENT_EM, widths_em};
use super::ticks::{self, Ticks};
use super::{Axis, Chart, ChartError, Scale, Series};

/// Values on a grid of equal cells.
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
    pub columns: usize,
    pub rows: usize,
    /// Row by row, x fastest, the row of least y first; `None` leaves a cell blank.
    pub values: Vec<Option<f64>>,
    /// Quantity and unit, beside the colour bar.
    pub value_label: String,
    /// The values at the two ends of the colour bar; `None`: from zero or the least value to the largest.
    pub value_range: Option<(f64, f64)>,
    /// Width of the picture at scale 1; its height follows from the shape of the grid.
    pub width_px: u32,
}

/// More cells per side than this are not seen in a picture: blocks of cells are averaged.
const MOST_CELLS: usize = 256;
/// From the frame to the colour bar, and its width.
const BAR_GAP: f64 = 22.0;
const BAR_WIDTH: f64 = 20.0;

/// The map as SVG that needs no font and refers to no other file.
///
/// # Errors
/// [`ChartError`]: a wrong number of values, none at all, one that is not finite, ranges or texts that cannot be drawn.
pub fn heat_map_to_svg(map: &HeatMap) -> Result<String, ChartError> {
    let range = map.checked_range()?;
    let chart = map.chart();
    check(&chart)?;
    let bar = Bar::new(map, range)?;
    let (chart, layout) = to_scale(map, chart, &bar)?;
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
    bar.draw(map, &layout.frame, &bar_map, &canvas)?;
    texts(&layout, &canvas)?;
    canvas.finish()?;
    let title = map.title.clone();
    let title = title.unwrap_or_else(|| format!("{} over the surface", map.value_label));
    let svg = finished(&at_real_size(&svg, chart.size)?, chart.size, &title)?;
    // Below all ink: right behind the title.
    let (head, ink) = svg.split_once("</title>").ok_or_else(|| ChartError::Draw {
        reason: "the picture has no title".to_owned(),
    })?;
    let colours = cells(map, &layout, range) + &strips(&bar.rect(&layout.frame));
    Ok(format!(
        "{head}</title>\n <g shape-rendering=\"crispEdges\">\n{colours} </g>{ink}"
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
        let (low, high) = self.value_range.unwrap_or((least.min(0.0), largest));
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

    /// A chart with the axes of the map; what it shows is not drawn.
    fn chart(&self) -> Chart {
        let corners = [
            (self.x_range.0, self.y_range.0),
            (self.x_range.1, self.y_range.1),
        ];
        let axis = |label: &str, (low, high)| Axis::linear(label).range(low, high);
        let chart = Chart::new(
            axis(&self.x_label, self.x_range),
            axis(&self.y_label, self.y_range),
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

/// Lays the chart out so high that lengths along y are to the scale of those along x.
fn to_scale(map: &HeatMap, chart: Chart, bar: &Bar) -> Result<(Chart, Layout), ChartError> {
    let reserve = Reserve {
        right: bar.total_width(),
        ..Reserve::default()
    };
    let laid = |chart: &Chart| lay_out(chart, &ranges(chart)?, &Widths::measure(chart)?, reserve);
    let layout = laid(&chart)?;
    let shape = (map.y_range.1 - map.y_range.0) / (map.x_range.1 - map.x_range.0);
    let around = f64::from(chart.size.height_px) - layout.frame.height();
    let height = around + layout.frame.width() * shape;
    let chart = chart.size(map.width_px, height.round().max(1.0) as u32);
    let layout = laid(&chart)?;
    Ok((chart, layout))
}

/// The colour bar, right of the frame.
struct Bar {
    low: f64,
    high: f64,
    ticks: Ticks,
    widest_label: f64,
    label_em: f64,
}

impl Bar {
    fn new(map: &HeatMap, (low, high): (f64, f64)) -> Result<Self, ChartError> {
        // Labels every fortieth of a picture apart at least; the frame's height is not known yet.
        let apart = (high - low) / 9.0;
        let ticks = ticks::choose(Scale::Linear, low, high, |ticks| {
            ticks
                .windows(2)
                .all(|pair| pair[1].value - pair[0].value >= apart)
        });
        let widths = widths_em(ticks.major.iter().map(|tick| tick.label.as_str()))?;
        let label_em = widths_em([map.value_label.as_str()])?;
        Ok(Self {
            low,
            high,
            widest_label: TICK_TEXT * widths.into_iter().fold(0.0, f64::max),
            label_em: label_em.first().copied().unwrap_or(0.0),
            ticks,
        })
    }

    fn total_width(&self) -> f64 {
        let label = LABEL_TEXT * (ASCENT_EM + DESCENT_EM) + LABEL_GAP;
        BAR_GAP + BAR_WIDTH + MAJOR_TICK + TICK_GAP + self.widest_label + label
    }

    fn rect(&self, frame: &Rect) -> Rect {
        Rect {
            left: crisp(frame.right + BAR_GAP),
            right: crisp(frame.right + BAR_GAP + BAR_WIDTH),
            ..*frame
        }
    }

    fn along(&self, frame: &Rect) -> AxisMap {
        AxisMap {
            scale: Scale::Linear,
            low: self.low,
            high: self.high,
            from_px: frame.bottom,
            to_px: frame.top,
        }
    }

    fn draw(
        &self,
        map: &HeatMap,
        frame: &Rect,
        along: &AxisMap,
        canvas: &Canvas<'_>,
    ) -> Result<(), ChartError> {
        let Rect {
            left,
            top,
            right,
            bottom,
        } = self.rect(frame);
        let outline = [
            (left, top),
            (right, top),
            (right, bottom),
            (left, bottom),
            (left, top),
        ];
        canvas.line(&outline, FRAME_STROKE, FRAME)?;
        for &value in &self.ticks.minor {
            let y = crisp(along.px(value));
            canvas.line(&[(right, y), (right + MINOR_TICK, y)], FRAME_STROKE, FRAME)?;
        }
        let level = (Anchor::Start, Direction::Level);
        for tick in &self.ticks.major {
            let y = crisp(along.px(tick.value));
            canvas.line(&[(right, y), (right + MAJOR_TICK, y)], FRAME_STROKE, FRAME)?;
            let at = (
                right + MAJOR_TICK + TICK_GAP,
                along.px(tick.value) + CAPITAL_EM / 2.0 * TICK_TEXT,
            );
            canvas.text(&tick.label, at, TICK_TEXT, TEXT, level)?;
        }
        // A label too long for the picture is set smaller rather than cut off.
        let room = frame.bottom - frame.top + LABEL_TEXT;
        let size = LABEL_TEXT.min(room / self.label_em.max(1e-9));
        let beside = right + MAJOR_TICK + TICK_GAP + self.widest_label + LABEL_GAP;
        let at = (
            beside + LABEL_TEXT * ASCENT_EM,
            (frame.top + frame.bottom) / 2.0,
        );
        let upwards = (Anchor::Middle, Direction::Upwards);
        canvas.text(&map.value_label, at, size, TEXT, upwards)
    }
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
    let edge = |axis: &AxisMap, (low, high): (f64, f64), cell: usize, count: usize| {
        let part = (cell * block).min(count) as f64 / count as f64;
        axis.px(low + (high - low) * part)
    };
    let x = |column| edge(&layout.x, map.x_range, column, map.columns);
    let y = |row| edge(&layout.y, map.y_range, row, map.rows);
    let mut paths = Paths::new();
    for row in 0..rows {
        let at = |column| block_mean(map, block, column, row).map(|value| level(value, range));
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
            columns,
            rows,
            values: (0..columns * rows).map(value).collect(),
            value_label: "pressure p / MPa".to_owned(),
            value_range: None,
            width_px: 800,
        }
    }

    #[test]
    fn lengths_are_to_one_scale_along_both_axes() {
        let map = dome(20, 10);
        let range = map.checked_range().unwrap();
        let bar = Bar::new(&map, range).unwrap();
        let (_, layout) = to_scale(&map, map.chart(), &bar).unwrap();
        let ratio = layout.frame.width() / layout.frame.height();
        // Whole pixels: one in 300.
        assert!((ratio - 2.0).abs() < 0.01, "{ratio}");
    }

    #[test]
    fn the_picture_is_small_and_has_neither_text_nor_references() {
        let svg = heat_map_to_svg(&dome(128, 128)).unwrap();
        assert!(svg.len() < 500_000, "{}", svg.len());
        for unwanted in ["<text", "href", "url(", "<image"] {
            assert!(!svg.contains(unwanted), "{unwanted}");
        }
        assert!(svg.contains("<title>pressure p / MPa over the surface</title>"));
        assert!(to_png(&svg, 1.0).unwrap().starts_with(b"\x89PNG"));
        // A large grid is averaged over blocks, not drawn cell by cell.
        assert!(heat_map_to_svg(&dome(1024, 1024)).unwrap().len() < 2_000_000);
    }

    #[test]
    fn every_painted_cell_has_the_colour_of_its_value() {
        let mut map = dome(2, 1);
        map.values = vec![Some(0.0), Some(8.0)];
        map.value_range = Some((0.0, 8.0));
        let range = map.checked_range().unwrap();
        let (_, layout) = to_scale(&map, map.chart(), &Bar::new(&map, range).unwrap()).unwrap();
        let painted = cells(&map, &layout, range);
        assert_eq!(painted.matches("<path").count(), 2);
        assert!(painted.contains("#440154") && painted.contains("#fde725"));
        map.values[0] = None;
        assert_eq!(cells(&map, &layout, range).matches("<path").count(), 1);
    }

    #[test]
    fn maps_that_cannot_be_drawn_are_refused() {
        let mut short = dome(3, 3);
        short.values.pop();
        assert!(matches!(
            heat_map_to_svg(&short),
            Err(ChartError::CellCount { found: 8, .. })
        ));
        let mut nan = dome(3, 3);
        nan.values[4] = Some(f64::NAN);
        assert!(matches!(
            heat_map_to_svg(&nan),
            Err(ChartError::NotFinite { .. })
        ));
        let mut blank = dome(3, 3);
        blank.values.fill(None);
        assert!(matches!(
            heat_map_to_svg(&blank),
            Err(ChartError::Map { .. })
        ));
        let mut upside_down = dome(3, 3);
        upside_down.value_range = Some((1.0, 0.0));
        assert!(matches!(
            heat_map_to_svg(&upside_down),
            Err(ChartError::Map { .. })
        ));
    }
}
