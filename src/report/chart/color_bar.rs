//! The colour bar of a heat map, or of series coloured by a quantity: the scale of the colours, right of the frame.

use std::sync::Arc;

use super::canvas::Canvas;
use super::color_map::{self, LEVELS};
use super::geometry::Rect;
use super::heat_map::HeatMap;
use super::layout::{PlacedText, block, centered, crisp, tick_widths, upright_title, upwards};
use super::look::*;
use super::scale::AxisMap;
use super::text::{Anchor, CAPITAL_EM};
use super::ticks::{self, Ticks};
use super::titles::{Lines, Phrase};
use super::{Chart, ChartError, Color, ColorScale, Scale, color_scale};
use crate::report::number::largest;

/// From the frame to the colour bar, and its width.
const BAR_GAP: f64 = 22.0;
const BAR_WIDTH: f64 = 20.0;

/// The range of the colours and the bar that explains them.
pub(super) struct Bar {
    /// `None` where series have the colours.
    pub(super) map: Option<Arc<HeatMap>>,
    /// Quantity and unit, upwards beside the bar.
    pub(super) title: Lines,
    /// Between which heights (px) it stands.
    title_ends: (f64, f64),
    scale: Scale,
    /// The values at the two ends.
    pub(super) range: (f64, f64),
    pub(super) ticks: Ticks,
    widest_label: f64,
}

impl Bar {
    /// The bar of the chart's map, else of its colour scale, beside a frame with these ends; its title has these.
    ///
    /// # Errors
    /// [`ChartError`] where the values of the map cannot be drawn.
    pub(super) fn of(
        chart: &Chart,
        (top, bottom): (f64, f64),
        title_ends: (f64, f64),
    ) -> Result<Option<Self>, ChartError> {
        let (map, name, label, scale, range) = match (&chart.map, &chart.color_scale) {
            (Some(map), _) => {
                let label = &map.value_label;
                let name = chart.title.as_ref().unwrap_or(label);
                let range = map.checked_range(name)?;
                (Some(Arc::clone(map)), name, label, map.value_scale, range)
            }
            (None, Some(ColorScale { label, range })) => {
                (None, label, label, Scale::Linear, *range)
            }
            (None, None) => return Ok(None),
        };
        let (low, high) = range;
        if low >= high || !(high - low).is_finite() {
            return Err(ChartError::item(
                format!("the map of {name}"),
                "the first end of the value range must be below the second",
            ));
        }
        let along = AxisMap::new(scale, range, (bottom, top));
        let least = ((bottom - top) / 9.0).max(1.6 * TICK_TEXT);
        let ticks = ticks::choose(scale, low, high, |ticks| {
            let apart = |pair: &[ticks::Tick]| along.px(pair[0].value) - along.px(pair[1].value);
            ticks.windows(2).all(|pair| apart(pair) >= least)
        });
        Ok(Some(Self {
            map,
            title: upright_title(
                &Phrase::measure(label, &chart.typeface),
                title_ends.1 - title_ends.0,
            ),
            title_ends,
            scale,
            range,
            widest_label: largest(tick_widths(chart, &ticks)),
            ticks,
        }))
    }

    pub(super) fn total_width(&self) -> f64 {
        BAR_GAP + BAR_WIDTH + MAJOR_TICK + TICK_GAP + self.widest_label + block(&self.title)
    }

    /// The colour of a level.
    pub(super) fn color(&self, level: usize) -> Color {
        match self.map {
            Some(_) => color_map::color(level),
            None => color_scale::color(level),
        }
    }

    fn rect(&self, frame: &Rect) -> Rect {
        Rect {
            left: crisp(frame.right + BAR_GAP),
            right: crisp(frame.right + BAR_GAP + BAR_WIDTH),
            ..*frame
        }
    }

    /// A box for each level of the colours.
    pub(super) fn strips(&self, frame: &Rect) -> impl Iterator<Item = (usize, Rect)> {
        let bar = self.rect(frame);
        let y = move |level: usize| bar.bottom - bar.height() * level as f64 / LEVELS as f64;
        (0..LEVELS).map(move |level| {
            let (top, bottom) = (y(level + 1), y(level));
            (level, Rect { top, bottom, ..bar })
        })
    }

    /// The sides of the frame that a chart leaves open, outline and ticks of the bar.
    pub(super) fn draw(&self, frame: &Rect, canvas: &mut Canvas) {
        let [top_left, top_right, bottom_right, _] = frame.corners();
        canvas.line(&[top_left, top_right, bottom_right], FRAME_STROKE, FRAME);
        let bar = self.rect(frame);
        let right = bar.right;
        canvas.outline(&bar, FRAME_STROKE, FRAME);
        let along = AxisMap::new(self.scale, self.range, (frame.bottom, frame.top));
        for (value, length) in self.ticks.lengths() {
            let y = crisp(along.px(value));
            canvas.line(&[(right, y), (right + length, y)], FRAME_STROKE, FRAME);
        }
    }

    pub(super) fn tick_labels(&self, frame: &Rect, canvas: &mut Canvas) {
        let right = self.rect(frame).right;
        let along = AxisMap::new(self.scale, self.range, (frame.bottom, frame.top));
        let level = Anchor::Start;
        for tick in &self.ticks.major {
            let at = (
                right + MAJOR_TICK + TICK_GAP,
                along.px(tick.value) + CAPITAL_EM / 2.0 * TICK_TEXT,
            );
            canvas.text(&tick.label, at, TICK_TEXT, level);
        }
    }

    /// The lines of the title along the bar.
    pub(super) fn title(&self, frame: &Rect) -> impl Iterator<Item = PlacedText> {
        let beside = self.rect(frame).right + MAJOR_TICK + TICK_GAP + self.widest_label;
        let middle = (frame.top + frame.bottom) / 2.0;
        let middle = centered(&self.title, middle, self.title_ends);
        upwards(&self.title, middle, beside + LABEL_GAP)
    }
}
