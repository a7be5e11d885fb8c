//! The legend: its entries in a column or in rows, and a place for it that covers no data.

use super::curves::Obstacles;
use super::geometry::{Point, Rect};
use super::layout::{Layout, Reserve, Widths, crisp};
use super::look::*;
use super::titles::{LEAST_SHARE_OF_SIZE, Lines, PITCH_EM};
use super::{Chart, LegendPlace, Series};

/// A legend, in its place or with its upper left corner at the origin.
#[derive(Debug)]
pub(super) struct Legend {
    pub(super) rect: Rect,
    pub(super) text_px: f64,
    /// Inside the frame it stands on white with an outline, outside on nothing.
    pub(super) framed: bool,
    pub(super) entries: Vec<Entry>,
}

/// A series in the legend.
#[derive(Debug)]
pub(super) struct Entry {
    /// Its place in the chart.
    pub(super) series: usize,
    /// The left end of its sample, at half the height of its first line.
    pub(super) at: Point,
    pub(super) lines: Vec<String>,
}

impl Legend {
    /// All labelled series in one column at most `room` px wide, long labels in several lines; `None` where no series has a label.
    pub(super) fn column(chart: &Chart, widths: &Widths, room: f64) -> Option<Self> {
        Self::grid(chart, widths, room, 1)
    }

    /// All labelled series in as many columns as `room` px hold.
    pub(super) fn rows(chart: &Chart, widths: &Widths, room: f64) -> Option<Self> {
        let most = labelled(chart).count();
        // The most columns that keep the text at its full size, else two with text a little smaller.
        for columns in (2..=most).rev() {
            let grid = Self::grid(chart, widths, room, columns);
            let suits =
                |grid: &Self| grid.text_px == LEGEND_TEXT || (columns == 2 && most >= LONG_COLUMN);
            if let Some(grid) = grid.filter(suits) {
                return Some(grid);
            }
        }
        Self::grid(chart, widths, room, 1)
    }

    /// `None` too where the labels are too long to stand in several columns.
    fn grid(chart: &Chart, widths: &Widths, room: f64, columns: usize) -> Option<Self> {
        let series: Vec<usize> = labelled(chart).collect();
        // Rows are filled evenly: five entries in at most four columns make three and two.
        let rows = series.len().div_ceil(columns);
        let columns = series.len().div_ceil(rows.max(1));
        let gaps = columns as f64 * (LEGEND_SAMPLE + LEGEND_GAP)
            + columns.saturating_sub(1) as f64 * COLUMN_GAP;
        let text_room = (room - 2.0 * LEGEND_PADDING - gaps) / columns.max(1) as f64;
        let labels = || series.iter().filter_map(|&place| widths.series.get(place));
        let longest = labels().map(|label| label.width_em).fold(0.0, f64::max);
        let is_long = longest * LEAST_SHARE_OF_SIZE * LEGEND_TEXT > text_room;
        if series.is_empty() || (columns > 1 && is_long) {
            return None;
        }
        let lines = labels().map(|label| label.within(LEGEND_TEXT, text_room, MOST_LINES));
        let lines: Vec<Lines> = lines.collect();
        let text_px = lines.iter().map(|l| l.size_px).fold(LEGEND_TEXT, f64::min);
        let widest = lines.iter().map(|l| l.widest_em).fold(0.0, f64::max);
        let pitch = LEGEND_SAMPLE + LEGEND_GAP + widest * text_px + COLUMN_GAP;
        let width = (columns as f64 * pitch - COLUMN_GAP + 2.0 * LEGEND_PADDING).ceil();
        let mut top = LEGEND_PADDING / 2.0;
        let mut entries = Vec::new();
        for (row, of_row) in lines.chunks(columns).enumerate() {
            for (column, lines) in of_row.iter().enumerate() {
                let x = LEGEND_PADDING + column as f64 * pitch;
                entries.push(Entry {
                    series: series[row * columns + column],
                    at: (x, top + LEGEND_ROW / 2.0),
                    lines: lines.lines.clone(),
                });
            }
            let most = of_row.iter().map(|lines| lines.lines.len()).max();
            top += LEGEND_ROW + PITCH_EM * text_px * (most.unwrap_or(1) - 1) as f64;
        }
        Some(Self {
            rect: Rect::at(0.0, 0.0, width, (top + LEGEND_PADDING / 2.0).ceil()),
            text_px,
            framed: true,
            entries,
        })
    }

    /// Moved from the origin.
    fn at(mut self, (left, top): Point) -> Self {
        let (left, top) = (crisp(left), crisp(top));
        self.rect = Rect::at(left, top, self.rect.width(), self.rect.height());
        for Entry { at: (x, y), .. } in &mut self.entries {
            (*x, *y) = (left + *x, top + *y);
        }
        self
    }

    /// The room to keep free outside the frame.
    pub(super) fn reserve(&self, side: Outside) -> Reserve {
        let (right, top) = match side {
            Outside::Right => (self.rect.width(), 0.0),
            Outside::Above => (0.0, self.rect.height() + LEGEND_LIFT),
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
                (left, frame.top - own.height() - LEGEND_LIFT)
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

    /// Whether it can stand beside the frame: no colour bar is there, the frame of a layout without it stays wide enough, and it is
    /// no higher than the frame.
    pub(super) fn fits_beside(&self, layout: &Layout) -> bool {
        layout.bar.is_none()
            && layout.frame.width() - self.rect.width() >= LEAST_FRAME_BESIDE
            && self.rect.height() <= layout.frame.height()
    }

    /// Whether it reads better in a column beside the frame than in rows above it.
    pub(super) fn suits_right(&self, layout: &Layout) -> bool {
        self.rect.width() <= 0.27 * layout.frame.width() && self.fits_beside(layout)
    }
}

/// A place outside the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outside {
    Right,
    Above,
}

/// Entries from which one column above the frame is long: two with text a little smaller are better.
const LONG_COLUMN: usize = 5;
/// Lines of a label, beyond which it is set smaller.
const MOST_LINES: usize = 9;
/// From a legend above to the frame, so that it keeps clear of the uppermost label of the ticks.
const LEGEND_LIFT: f64 = 2.0;
/// The least width of a frame beside which a legend goes.
const LEAST_FRAME_BESIDE: f64 = 240.0;
/// Between the columns of a legend in rows.
const COLUMN_GAP: f64 = 26.0;

fn labelled(chart: &Chart) -> impl Iterator<Item = usize> {
    let has_label = |series: &Series| series.label.as_ref().is_some_and(|l| !l.is_empty());
    let places = 0..chart.series.len();
    places.filter(move |&place| has_label(&chart.series[place]))
}
