//! The legend: its entries in a column or in rows, and a place for it that covers no data.

use super::curves::Obstacles;
use super::geometry::{Point, Rect};
use super::layout::{Layout, Reserve, Widths, crisp};
use super::look::*;
use super::text::fitted_px;
use super::{Chart, LegendPlace, Series};

/// A legend, in its place or with its upper left corner at the origin.
#[derive(Debug)]
pub(super) struct Legend {
    pub(super) rect: Rect,
    pub(super) text_px: f64,
    /// Inside the frame it stands on white with an outline, outside on nothing.
    pub(super) framed: bool,
    /// For each entry the series it stands for and the left end of its sample, at half the height of the row.
    pub(super) entries: Vec<(usize, Point)>,
}

impl Legend {
    /// All labelled series in one column at most `room` px wide; `None` where no series has a label.
    pub(super) fn column(chart: &Chart, widths: &Widths, room: f64) -> Option<Self> {
        Self::grid(chart, widths, room, 1)
    }

    /// All labelled series in as many columns as `room` px hold.
    pub(super) fn rows(chart: &Chart, widths: &Widths, room: f64) -> Option<Self> {
        let most = labelled(chart).count();
        let grid = |columns: usize| Self::grid(chart, widths, room, columns);
        // The widest that keeps the text at its full size; one column sets it smaller if it must.
        let is_full = |grid: Self| grid.text_px == LEGEND_TEXT;
        let full = (1..=most)
            .rev()
            .find(|&columns| grid(columns).is_some_and(is_full));
        // A long column gives way to two with text a little smaller.
        if full.unwrap_or(1) == 1 && most >= LONG_COLUMN {
            let smaller = grid(2).filter(|g| g.text_px >= LEAST_SHARE_OF_TEXT * LEGEND_TEXT);
            if smaller.is_some() {
                return smaller;
            }
        }
        grid(full.unwrap_or(1))
    }

    fn grid(chart: &Chart, widths: &Widths, room: f64, columns: usize) -> Option<Self> {
        let width = |series: usize| widths.series.get(series).copied().unwrap_or(0.0);
        let entries: Vec<usize> = labelled(chart).collect();
        let widest = entries
            .iter()
            .map(|&series| width(series))
            .reduce(f64::max)?;
        // Rows are filled evenly: five entries in at most four columns make three and two.
        let rows = entries.len().div_ceil(columns);
        let columns = entries.len().div_ceil(rows);
        let gaps =
            columns as f64 * (LEGEND_SAMPLE + LEGEND_GAP) + (columns - 1) as f64 * COLUMN_GAP;
        let text_room = (room - 2.0 * LEGEND_PADDING - gaps) / columns as f64;
        let text_px = fitted_px(LEGEND_TEXT, widest, text_room).max(1.0);
        let pitch = LEGEND_SAMPLE + LEGEND_GAP + widest * text_px + COLUMN_GAP;
        let at = |place: usize| {
            let (column, row) = (place % columns, place / columns);
            (
                LEGEND_PADDING + column as f64 * pitch,
                LEGEND_PADDING / 2.0 + (row as f64 + 0.5) * LEGEND_ROW,
            )
        };
        let width = (columns as f64 * pitch - COLUMN_GAP + 2.0 * LEGEND_PADDING).ceil();
        let height = (rows as f64 * LEGEND_ROW + LEGEND_PADDING).ceil();
        let entries = entries.into_iter().enumerate();
        Some(Self {
            rect: Rect::at(0.0, 0.0, width, height),
            text_px,
            framed: true,
            entries: entries.map(|(place, series)| (series, at(place))).collect(),
        })
    }

    /// Moved from the origin.
    fn at(mut self, (left, top): Point) -> Self {
        let (left, top) = (crisp(left), crisp(top));
        self.rect = Rect::at(left, top, self.rect.width(), self.rect.height());
        for (_, (x, y)) in &mut self.entries {
            (*x, *y) = (left + *x, top + *y);
        }
        self
    }

    /// The room to keep free outside the frame.
    pub(super) fn reserve(&self, side: Outside) -> Reserve {
        let (right, top) = match side {
            Outside::Right => (self.rect.width(), 0.0),
            Outside::Above => (0.0, self.rect.height()),
        };
        Reserve {
            right,
            top,
            left: 0.0,
        }
    }

    /// The legend outside the frame of a layout that reserved the room.
    pub(super) fn outside(self, layout: &Layout, side: Outside) -> Self {
        let (frame, own) = (&layout.frame, &self.rect);
        let place = match side {
            Outside::Right => (frame.right + MARGIN / 2.0, frame.top - LEGEND_PADDING / 2.0),
            Outside::Above => {
                let centered = (frame.left + frame.right - own.width()) / 2.0;
                let left = centered.min(frame.right - own.width()).max(MARGIN);
                (left, frame.top - own.height() - 1.0)
            }
        };
        Self {
            framed: false,
            ..self.at(place)
        }
    }

    /// Places inside the frame: the four corners, from the upper right by rows, then the middles of the sides.
    fn places(&self, layout: &Layout) -> [Point; 8] {
        let inner = layout.frame.grown(-LEGEND_INSET);
        let (left, top) = (inner.left, inner.top);
        let (right, bottom) = (
            inner.right - self.rect.width(),
            inner.bottom - self.rect.height(),
        );
        let (middle_x, middle_y) = ((left + right) / 2.0, (top + bottom) / 2.0);
        [
            (right, top),
            (left, top),
            (right, bottom),
            (left, bottom),
            (right, middle_y),
            (left, middle_y),
            (middle_x, top),
            (middle_x, bottom),
        ]
    }

    /// The legend in the given corner, whatever it covers.
    pub(super) fn in_corner(self, layout: &Layout, corner: LegendPlace) -> Self {
        let [top_right, top_left, bottom_right, bottom_left, ..] = self.places(layout);
        self.at(match corner {
            LegendPlace::TopLeft => top_left,
            LegendPlace::BottomRight => bottom_right,
            LegendPlace::BottomLeft => bottom_left,
            LegendPlace::TopRight | LegendPlace::Auto | LegendPlace::Right | LegendPlace::Above => {
                top_right
            }
        })
    }

    /// The legend inside the frame where it covers nothing: in a corner, else at the middle of a side.
    /// Gives the legend back where there is no such place.
    pub(super) fn where_free(self, layout: &Layout, obstacles: &Obstacles) -> Result<Self, Self> {
        let inner = layout.frame.grown(-LEGEND_INSET);
        let (width, height) = (self.rect.width(), self.rect.height());
        if width > 0.75 * inner.width() || height > 0.75 * inner.height() {
            return Err(self);
        }
        let free =
            |&(left, top): &Point| obstacles.spare(&Rect::at(left, top, width, height).grown(3.0));
        match self.places(layout).into_iter().find(free) {
            Some(place) => Ok(self.at(place)),
            None => Err(self),
        }
    }

    /// Whether the frame of a layout without it stays wide enough with it at the right.
    pub(super) fn leaves_room_beside(&self, layout: &Layout) -> bool {
        layout.frame.width() - self.rect.width() >= LEAST_FRAME_BESIDE
    }

    /// Whether it reads better in a column beside the frame than in rows above it.
    pub(super) fn suits_right(&self, layout: &Layout) -> bool {
        self.rect.width() <= 0.27 * layout.frame.width()
            && self.rect.height() <= layout.frame.height()
    }
}

/// A place outside the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outside {
    Right,
    Above,
}

/// Entries from which one column above the frame is long, and how much smaller their text may be to make two.
const LONG_COLUMN: usize = 5;
const LEAST_SHARE_OF_TEXT: f64 = 0.85;
/// The least width of a frame beside which a legend goes.
const LEAST_FRAME_BESIDE: f64 = 240.0;
/// Between the columns of a legend in rows.
const COLUMN_GAP: f64 = 26.0;

fn labelled(chart: &Chart) -> impl Iterator<Item = usize> {
    let has_label = |series: &Series| series.label.as_ref().is_some_and(|l| !l.is_empty());
    let places = 0..chart.series.len();
    places.filter(move |&place| has_label(&chart.series[place]))
}
