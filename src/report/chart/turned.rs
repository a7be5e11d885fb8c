//! The colours of a map that is a profile turned about an axis: discs, the larger ones below. Circles stay round at any size,
//! and take a twentieth of the room of cells.

use std::fmt::Write as _;

use super::color_map::color;
use super::heat_map::HeatMap;
use super::layout::Layout;
use super::look::WHITE;

/// One disc per change of colour, from the edge of the map inwards.
pub(super) fn discs(map: &HeatMap, layout: &Layout, range: (f64, f64)) -> String {
    let frame = &layout.frame;
    let (x, y) = (
        0.5 * (frame.left + frame.right),
        0.5 * (frame.top + frame.bottom),
    );
    let ring = 0.5 * frame.width() / map.values.len().max(1) as f64;
    let mut text = String::new();
    // Blank is what the paper is.
    let mut below = None;
    for (place, value) in map.values.iter().enumerate().rev() {
        let level = value.map(|value| map.level(value, range));
        if level == below {
            continue;
        }
        below = level;
        let radius = ring * (place + 1) as f64;
        let [red, green, blue] = level.map_or(WHITE, color).rgb();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            " <circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\" fill=\"#{red:02x}{green:02x}{blue:02x}\"/>"
        );
    }
    text
}
