//! Colours that stay apart for colour-blind readers and in a grey print.

use serde::{Deserialize, Serialize};

/// A colour: a place in the palette, a step of an ordered ramp, or an explicit value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Color {
    /// For families without an order. Counts on from the start after seven.
    Palette(usize),
    /// For families with an order (frequency, temperature): step `step` of `of`, dark to light.
    Ramp { step: usize, of: usize },
    /// Red, green, blue.
    Rgb(u8, u8, u8),
}

impl From<usize> for Color {
    fn from(place: usize) -> Self {
        Self::Palette(place)
    }
}

/// The hues of Okabe and Ito, "Color Universal Design" (2008): blue, vermillion, green, purple, amber, sky blue, black.
/// Their lightness is moved apart so that any two differ by at least 19 of 255 grey levels, and so that protanopes and
/// deuteranopes see them further apart than the originals.
const PALETTE: [[u8; 3]; 7] = [
    [0x00, 0x4F, 0xBD],
    [0xD1, 0x69, 0x2B],
    [0x00, 0xA3, 0x78],
    [0x8A, 0x3A, 0x80],
    [0xE6, 0xBA, 0x00],
    [0x56, 0xB4, 0xE9],
    [0x00, 0x00, 0x00],
];

/// From indigo by blue and teal to amber. Lightness rises evenly, hue goes from blue to yellow, the direction in which
/// all common kinds of colour blindness still tell colours apart; paler ends are left out because they vanish on white.
const RAMP: [[u8; 3]; 4] = [
    [0x2B, 0x1B, 0x6B],
    [0x0F, 0x6A, 0xB0],
    [0x1F, 0xA0, 0x8A],
    [0xF0, 0xA2, 0x1E],
];

impl Color {
    /// Of a curve in a family with an order, which may be one curve alone: then the first of the palette.
    pub fn of_family(step: usize, of: usize) -> Self {
        match of {
            1 => Self::Palette(0),
            _ => Self::Ramp { step, of },
        }
    }

    /// The grey that is as light in a print in black and white.
    pub fn in_grey(self) -> Self {
        let [red, green, blue] = self.rgb().map(f64::from);
        let luma = (0.299 * red + 0.587 * green + 0.114 * blue).round() as u8;
        Self::Rgb(luma, luma, luma)
    }

    /// Red, green, blue.
    pub fn rgb(self) -> [u8; 3] {
        match self {
            Self::Palette(place) => PALETTE[place % PALETTE.len()],
            Self::Ramp { step, of } => along(&RAMP, step, of),
            Self::Rgb(red, green, blue) => [red, green, blue],
        }
    }
}

/// Step `step` of `of` along colours that are mixed in between.
pub(super) fn along<const N: usize>(colors: &[[u8; 3]; N], step: usize, of: usize) -> [u8; 3] {
    let last = of.saturating_sub(1).max(1);
    let place = step.min(last) as f64 / last as f64 * (N - 1) as f64;
    let lower = (place as usize).min(N - 2);
    let part = place - lower as f64;
    std::array::from_fn(|channel| {
        let [from, to] = [lower, lower + 1].map(|k| f64::from(colors[k][channel]));
        (from + (to - from) * part).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Luma of ITU-R BT.601, what a grey print shows.
    fn grey(color: Color) -> f64 {
        let [red, green, blue] = color.rgb().map(f64::from);
        0.299 * red + 0.587 * green + 0.114 * blue
    }

    #[test]
    fn any_two_palette_colours_differ_in_grey() {
        for first in 0..PALETTE.len() {
            for second in 0..first {
                let difference = (grey(Color::Palette(first)) - grey(Color::Palette(second))).abs();
                // 19 of 255 is four times the just noticeable difference of about 2 % on paper.
                assert!(
                    difference >= 19.0,
                    "{first} and {second} differ by {difference}"
                );
            }
        }
    }

    /// CIELAB coordinates as a dichromat sees the colour: the matrix (of linear RGB) is that of Machado, Oliveira and
    /// Fernandes 2009 at full severity.
    fn seen(color: Color, matrix: [[f64; 3]; 3]) -> [f64; 3] {
        let linear = color.rgb().map(|channel| {
            let value = f64::from(channel) / 255.0;
            if value <= 0.04045 {
                value / 12.92
            } else {
                ((value + 0.055) / 1.055).powf(2.4)
            }
        });
        let apply =
            |row: [f64; 3], rgb: [f64; 3]| row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2];
        let rgb = matrix.map(|row| apply(row, linear).clamp(0.0, 1.0));
        let root = |value: f64| {
            if value > 0.008856 {
                value.cbrt()
            } else {
                7.787 * value + 16.0 / 116.0
            }
        };
        let x = root(apply([0.4124, 0.3576, 0.1805], rgb) / 0.95047);
        let y = root(apply([0.2126, 0.7152, 0.0722], rgb));
        let z = root(apply([0.0193, 0.1192, 0.9505], rgb) / 1.08883);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    #[test]
    fn any_two_palette_colours_stay_apart_for_the_colour_blind() {
        const PROTANOPE: [[f64; 3]; 3] = [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ];
        const DEUTERANOPE: [[f64; 3]; 3] = [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ];
        for matrix in [PROTANOPE, DEUTERANOPE] {
            for first in 0..PALETTE.len() {
                for second in 0..first {
                    let (a, b) = (
                        seen(Color::Palette(first), matrix),
                        seen(Color::Palette(second), matrix),
                    );
                    let apart = a
                        .iter()
                        .zip(b)
                        .map(|(a, b)| (a - b).powi(2))
                        .sum::<f64>()
                        .sqrt();
                    // The original palette reaches 17.8; a difference of 2 is just seen side by side.
                    assert!(apart > 25.0, "{first} and {second} are {apart} apart");
                }
            }
        }
    }

    #[test]
    fn no_colour_vanishes_on_white() {
        for place in 0..PALETTE.len() {
            assert!(grey(Color::Palette(place)) < 190.0, "{place}");
        }
    }

    #[test]
    fn a_ramp_gets_lighter_with_every_step() {
        for of in 2..=12 {
            for step in 1..of {
                // Six steps must be as far apart as two entries of the palette; twelve still half as far.
                let least = if of <= 6 { 19.0 } else { 8.0 };
                let rise =
                    grey(Color::Ramp { step, of }) - grey(Color::Ramp { step: step - 1, of });
                assert!(rise > least, "step {step} of {of} rises by {rise}");
            }
        }
    }

    #[test]
    fn a_ramp_of_one_and_a_step_beyond_the_end_are_colours_too() {
        assert_eq!(Color::Ramp { step: 0, of: 1 }.rgb(), RAMP[0]);
        assert_eq!(Color::Ramp { step: 0, of: 0 }.rgb(), RAMP[0]);
        assert_eq!(Color::Ramp { step: 9, of: 3 }.rgb(), RAMP[3]);
    }
}
