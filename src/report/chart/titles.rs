//! Texts broken into lines where their side is too short for them.

use super::text::{ASCENT_EM, DESCENT_EM, width_em};
use crate::figures::font::Typeface;

/// A text is set no smaller than this share of its size, but for a word that no line holds.
pub(super) const LEAST_SHARE_OF_SIZE: f64 = 0.85;
/// From one line to the next.
pub(super) const PITCH_EM: f64 = 1.2;

/// A text and its width at size 1.
#[derive(Clone, Debug)]
pub(super) struct Phrase {
    text: String,
    pub(super) width_em: f64,
    typeface: Typeface,
}

/// A text in lines.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines {
    pub(super) lines: Vec<String>,
    pub(super) size_px: f64,
    /// The width of the longest line at size 1.
    pub(super) widest_em: f64,
}

impl Lines {
    /// The height (px) of all lines, 0 without one.
    pub(super) fn height_px(&self) -> f64 {
        match self.lines.len() {
            0 => 0.0,
            lines => self.size_px * (ASCENT_EM + DESCENT_EM + PITCH_EM * (lines - 1) as f64),
        }
    }
}

impl Phrase {
    pub(super) fn measure(text: &str, typeface: &Typeface) -> Self {
        Self {
            text: text.to_owned(),
            width_em: width_em(text, typeface),
            typeface: typeface.clone(),
        }
    }

    /// The text in as few lines, at most this many, as `room_px` takes at `size_px` or a little less.
    pub(super) fn within(&self, size_px: f64, room_px: f64, most: usize) -> Lines {
        if self.text.is_empty() {
            return Lines::default();
        }
        let one = Lines {
            lines: vec![self.text.clone()],
            size_px,
            widest_em: self.width_em,
        };
        let least_px = LEAST_SHARE_OF_SIZE * size_px;
        let mut best = one;
        if best.widest_em * least_px > room_px {
            let words = words(&self.text, &self.typeface);
            let mut count = 1;
            while best.widest_em * least_px > room_px && count < most.min(words.len()) {
                count += 1;
                (best.lines, best.widest_em) = broken(&words, count);
            }
        }
        best.size_px = size_px.min(room_px.max(1.0) / best.widest_em.max(1e-9));
        best
    }
}

/// A space of the font.
const SPACE_EM: f64 = 0.32;

/// What a line may end with, and its width. A slash keeps the symbol before it and the unit after it together.
fn words(text: &str, typeface: &Typeface) -> Vec<(String, f64)> {
    let mut joined: Vec<String> = Vec::new();
    let mut is_open = false;
    for word in text.split(' ') {
        let is_slash = word == "/";
        match joined.last_mut() {
            Some(last) if is_open || is_slash => {
                last.push(' ');
                last.push_str(word);
            }
            _ => joined.push(word.to_owned()),
        }
        is_open = is_slash;
    }
    let measured = joined.into_iter().map(|word| {
        let width = width_em(&word, typeface);
        (word, width)
    });
    measured.collect()
}

/// Words in at most `count` lines, the longest of which is as short as it can be; with its width.
fn broken(words: &[(String, f64)], count: usize) -> (Vec<String>, f64) {
    let filled = |most_em: f64| {
        let mut lines: Vec<(String, f64)> = Vec::new();
        for (word, width) in words {
            match lines.last_mut() {
                Some((line, length)) if *length + SPACE_EM + width <= most_em => {
                    *line = format!("{line} {word}");
                    *length += SPACE_EM + width;
                }
                _ => lines.push((word.clone(), *width)),
            }
        }
        lines
    };
    let (mut short, mut long) = (0.0, words.iter().map(|(_, width)| width + SPACE_EM).sum());
    // Halving the interval sixteen times finds the length to less than a hundredth of a letter.
    for _ in 0..16 {
        let middle = 0.5 * (short + long);
        match filled(middle).len() <= count {
            true => long = middle,
            false => short = middle,
        }
    }
    let lines = filled(long);
    let widest = lines
        .iter()
        .fold(0.0_f64, |most, (_, width)| most.max(*width));
    (lines.into_iter().map(|(line, _)| line).collect(), widest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_too_long_for_its_side_has_lines_of_about_one_length_and_keeps_its_unit_whole() {
        let typeface = Typeface::default();
        let phrase = Phrase::measure(
            "work per cycle and area of the contact w / J·m⁻²",
            &typeface,
        );
        let full = phrase.width_em * 18.0;
        let lines = |room: f64, most: usize| phrase.within(18.0, room, most);
        assert_eq!(lines(full, 2).lines.len(), 1);
        // A little too long: a little smaller.
        let smaller = lines(0.9 * full, 2);
        assert_eq!(smaller.lines.len(), 1);
        assert!((smaller.size_px - 0.9 * 18.0).abs() < 1e-9);
        let two = lines(0.6 * full, 2);
        assert_eq!(
            two.lines,
            ["work per cycle and area", "of the contact w / J·m⁻²"]
        );
        assert_eq!(two.size_px, 18.0);
        let four = lines(0.3 * full, 9);
        assert!(four.lines.len() > 2 && four.size_px >= LEAST_SHARE_OF_SIZE * 18.0);
        assert!(
            four.lines
                .iter()
                .all(|line| !line.ends_with('/') && !line.starts_with('/'))
        );
        // Where no more lines are allowed, smaller rather than cut.
        assert!(lines(0.1 * full, 2).size_px < 6.0);
        assert!(
            Phrase::measure("", &typeface)
                .within(18.0, 10.0, 2)
                .lines
                .is_empty()
        );
    }
}
