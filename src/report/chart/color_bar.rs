//! The colour bar of a heat map: the scale of its colours, right of the frame.

use super::canvas::{Anchor, Canvas, Direction};
use super::geometry::Rect;
use super::heat_map::HeatMap;
use super::layout::crisp;
use super::look::*;
use super::scale::AxisMap;
use super::text::{ASCENT_EM, CAPITAL_EM, DESCENT_EM, widths_em};
use super::ticks::{self, Ticks};
use super::{ChartError, Scale};

/// From the frame to the colour bar, and its width.
const BAR_GAP: f64 = 22.0;
const BAR_WIDTH: f64 = 20.0;

/// The colour bar, right of the frame.
pub(super) struct Bar {
    scale: Scale,
    low: f64,
    high: f64,
    pub(super) ticks: Ticks,
    widest_label: f64,
    label_em: f64,
}

impl Bar {
    pub(super) fn new(map: &HeatMap, (low, high): (f64, f64)) -> Result<Self, ChartError> {
        let scale = map.value_scale;
        // Along a bar of unit length; the frame's height is not known yet.
        let unit = AxisMap {
            scale,
            low,
            high,
            from_px: 0.0,
            to_px: 1.0,
        };
        let ticks = ticks::choose(scale, low, high, |ticks| {
            let apart = |pair: &[ticks::Tick]| unit.px(pair[1].value) - unit.px(pair[0].value);
            ticks.windows(2).all(|pair| apart(pair) >= 1.0 / 9.0)
        });
        let widths = widths_em(ticks.major.iter().map(|tick| tick.label.as_str()))?;
        let label_em = widths_em([map.value_label.as_str()])?;
        Ok(Self {
            scale,
            low,
            high,
            widest_label: TICK_TEXT * widths.into_iter().fold(0.0, f64::max),
            label_em: label_em.first().copied().unwrap_or(0.0),
            ticks,
        })
    }

    pub(super) fn total_width(&self) -> f64 {
        let label = LABEL_TEXT * (ASCENT_EM + DESCENT_EM) + LABEL_GAP;
        BAR_GAP + BAR_WIDTH + MAJOR_TICK + TICK_GAP + self.widest_label + label
    }

    pub(super) fn rect(&self, frame: &Rect) -> Rect {
        Rect {
            left: crisp(frame.right + BAR_GAP),
            right: crisp(frame.right + BAR_GAP + BAR_WIDTH),
            ..*frame
        }
    }

    pub(super) fn along(&self, frame: &Rect) -> AxisMap {
        AxisMap {
            scale: self.scale,
            low: self.low,
            high: self.high,
            from_px: frame.bottom,
            to_px: frame.top,
        }
    }

    pub(super) fn draw(
        &self,
        (map, height_px): (&HeatMap, f64),
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
        // A label too long for the frame may be as long as the picture; beyond that it is set smaller rather than cut off.
        let room = frame.bottom - frame.top + LABEL_TEXT;
        let (room, middle) = match self.label_em * LABEL_TEXT <= room {
            true => (room, (frame.top + frame.bottom) / 2.0),
            false => (height_px - 2.0 * MARGIN, height_px / 2.0),
        };
        let size = LABEL_TEXT.min(room / self.label_em.max(1e-9));
        let beside = right + MAJOR_TICK + TICK_GAP + self.widest_label + LABEL_GAP;
        let at = (beside + LABEL_TEXT * ASCENT_EM, middle);
        let upwards = (Anchor::Middle, Direction::Upwards);
        canvas.text(&map.value_label, at, size, TEXT, upwards)
    }
}
