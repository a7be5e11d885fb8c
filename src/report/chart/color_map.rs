//! A colour map for heat maps: equal steps of the value look like equal steps, in colour, in grey and to the colour-blind.

use super::{Color, palette};

/// Nine steps through viridis (S. van der Walt and N. Smith, 2015, for matplotlib; released under CC0), dark to light.
const VIRIDIS: [[u8; 3]; 10] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x28, 0x78],
    [0x3E, 0x49, 0x89],
    [0x31, 0x68, 0x8E],
    [0x26, 0x82, 0x8E],
    [0x1F, 0x9E, 0x89],
    [0x35, 0xB7, 0x79],
    [0x6E, 0xCE, 0x58],
    [0xB5, 0xDE, 0x2B],
    [0xFD, 0xE7, 0x25],
];

/// Colours told apart in a picture.
pub(super) const LEVELS: usize = 256;

/// The level of a value between the two ends of the map; values beyond an end take its colour.
pub(super) fn level(value: f64, (low, high): (f64, f64)) -> usize {
    let part = ((value - low) / (high - low)).clamp(0.0, 1.0);
    // The casts saturate; the last level is reached by the largest value alone.
    ((part * LEVELS as f64) as usize).min(LEVELS - 1)
}

/// The colour of a level.
pub(super) fn color(level: usize) -> Color {
    let [red, green, blue] = palette::along(&VIRIDIS, level, LEVELS);
    Color::Rgb(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lightness L* of CIELAB.
    fn lightness(level: usize) -> f64 {
        let linear = color(level).rgb().map(|channel| {
            let value = f64::from(channel) / 255.0;
            if value <= 0.04045 {
                value / 12.92
            } else {
                ((value + 0.055) / 1.055).powf(2.4)
            }
        });
        let luminance = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
        if luminance > 0.008856 {
            116.0 * luminance.cbrt() - 16.0
        } else {
            903.3 * luminance
        }
    }

    #[test]
    fn lightness_rises_evenly_with_the_value() {
        let (first, last) = (lightness(0), lightness(LEVELS - 1));
        assert!(first < 20.0 && last > 85.0);
        for level in 1..LEVELS {
            // Rounding to whole channel values moves L* by a few tenths.
            assert!(lightness(level) > lightness(level - 1) - 0.3);
            let even = first + (last - first) * level as f64 / (LEVELS - 1) as f64;
            // A viewer tells about 2.3 units of L* apart side by side.
            assert!((lightness(level) - even).abs() < 2.3, "{level}");
        }
    }

    #[test]
    fn values_beyond_the_ends_take_the_colours_of_the_ends() {
        assert_eq!(level(-1.0, (0.0, 2.0)), 0);
        assert_eq!(level(3.0, (0.0, 2.0)), LEVELS - 1);
        assert_eq!(level(1.0, (0.0, 2.0)), LEVELS / 2);
    }
}
