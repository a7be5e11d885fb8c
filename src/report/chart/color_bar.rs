//! The colour bar of a heat map, or of series coloured by a quantity: the scale of the colours, right of the frame.

use std::sync::Arc;

use super::canvas::Canvas;
use super::color_map::{self, LEVELS};
use super::geometry::Rect;
use super::heat_map::HeatMap;
use super::layout::{crisp, tick_widths};
use super::look::*;
use super::scale::AxisMap;
use super::text::{ASCENT_EM, Anchor, CAPITAL_EM, DESCENT_EM, width_em};
use super::ticks::{self, Ticks};
use super::{Chart, ChartError, Color, ColorScale, Scale, color_scale};
use crate::report::number::largest;

/// From the frame to the colour bar, and its width.
const BAR_GAP: f64 = 22.0;
const BAR_WIDTH: f64 = 20.0;

/// The range of the colours and the bar that explains them.
pub(super) struct Bar {
    /// `None` where series have the colours.
    pub(super) map: Option<Arc<HeatMap>>,
    label: String,
    scale: Scale,
    /// The values at the two ends.
    pub(super) range: (f64, f64),
    pub(super) ticks: Ticks,
    widest_label: f64,
    label_em: f64,
}

impl Bar {
    /// The bar of the chart's map, else of its colour scale.
    ///
    /// # Errors
    /// [`ChartError`] where the values of the map cannot be drawn.
    pub(super) fn of(chart: &Chart) -> Result<Option<Self>, ChartError> {
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
            return Err(ChartError::Map {
                map: name.clone(),
                reason: "the first end of the value range must be below the second",
            });
        }
        // Along a bar of unit length; the frame's height is not known yet.
        let unit = AxisMap::new(scale, range, (0.0, 1.0));
        let ticks = ticks::choose(scale, low, high, |ticks| {
            let apart = |pair: &[ticks::Tick]| unit.px(pair[1].value) - unit.px(pair[0].value);
            ticks.windows(2).all(|pair| apart(pair) >= 1.0 / 9.0)
        });
        Ok(Some(Self {
            map,
            label: label.clone(),
            scale,
            range,
            widest_label: largest(tick_widths(chart, &ticks)),
            label_em: width_em(label, &chart.typeface),
            ticks,
        }))
    }

    pub(super) fn total_width(&self) -> f64 {
        let label = LABEL_TEXT * (ASCENT_EM + DESCENT_EM) + LABEL_GAP;
        BAR_GAP + BAR_WIDTH + MAJOR_TICK + TICK_GAP + self.widest_label + label
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

    /// The sides of the frame that a chart leaves open, outline, ticks and labels of the bar.
    pub(super) fn draw(&self, frame: &Rect, height_px: f64, canvas: &mut Canvas) {
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
        let level = Anchor::Start;
        for tick in &self.ticks.major {
            let at = (
                right + MAJOR_TICK + TICK_GAP,
                along.px(tick.value) + CAPITAL_EM / 2.0 * TICK_TEXT,
            );
            canvas.text(&tick.label, at, TICK_TEXT, level);
        }
        // A label too long for the frame may be as long as the picture; beyond that it is set smaller rather than cut off.
        let room = frame.height() + LABEL_TEXT;
        let (room, middle) = match self.label_em * LABEL_TEXT <= room {
            true => (room, (frame.top + frame.bottom) / 2.0),
            false => (height_px - 2.0 * MARGIN, height_px / 2.0),
        };
        let size = LABEL_TEXT.min(room / self.label_em.max(1e-9));
        let beside = right + MAJOR_TICK + TICK_GAP + self.widest_label + LABEL_GAP;
        let at = (beside + LABEL_TEXT * ASCENT_EM, middle);
        let upwards = Anchor::Upwards;
        canvas.text(&self.label, at, size, upwards);
    }
}
