//! Texts of charts: subscripts, measuring and laying out.
//!
//! In a label an underscore before a letter or before braces sets a subscript: `a_T`, `E_{inst}`. A backslash keeps an underscore as it
//! is, which [`literal`] does for names that a user gave.

use std::ops::Range;
use std::sync::Arc;

use harfrust::{Direction, UnicodeBuffer};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{GlyphId, MetadataProvider as _};
use tiny_skia::{Path, PathBuilder, Point, Transform};
use unicode_bidi::{BidiInfo, Level};

use crate::figures::font::{Font, Typeface};

/// Height of a capital or a figure, as a fraction of the text size. This and the two below are those of DejaVu Sans; other families
/// differ by less than a px.
pub(super) const CAPITAL_EM: f64 = 0.729;
/// Height above and depth below the baseline of what the labels are made of, as fractions of the text size.
pub(super) const ASCENT_EM: f64 = 0.80;
pub(super) const DESCENT_EM: f64 = 0.24;

/// Size of a subscript, and how far below the baseline it stands, as fractions of the text size.
const SUBSCRIPT_EM: f32 = 0.7;
const SUBSCRIPT_DROP_EM: f32 = 0.16;

/// A part of a label: as it is read, and whether it is a subscript.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Part {
    pub(super) text: String,
    pub(super) is_subscript: bool,
}

impl Part {
    /// Its size as a fraction of the size of the text, and how far (in that size) it stands below the baseline.
    pub(super) fn size_and_drop_em(&self) -> (f32, f32) {
        match self.is_subscript {
            true => (SUBSCRIPT_EM, SUBSCRIPT_DROP_EM),
            false => (1.0, 0.0),
        }
    }
}

/// The parts of a label.
pub(super) fn parts(label: &str) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let mut rest = label;
    while let Some(first) = rest.chars().next() {
        let after = rest.split_at(first.len_utf8()).1;
        let next = after.chars().next();
        let (text, is_subscript, left) = match (first, next) {
            ('\\', Some('_' | '\\')) => {
                let (kept, left) = after.split_at(1);
                (kept, false, left)
            }
            ('_', Some('{')) if after.contains('}') => {
                let (inner, left) = after.split_once('}').unwrap_or((after, ""));
                (inner.trim_start_matches('{'), true, left)
            }
            ('_', Some(letter)) if letter.is_alphanumeric() => {
                let (letter, left) = after.split_at(letter.len_utf8());
                (letter, true, left)
            }
            _ => (rest.split_at(first.len_utf8()).0, false, after),
        };
        match parts.last_mut() {
            Some(last) if last.is_subscript == is_subscript => last.text.push_str(text),
            _ => parts.push(Part {
                text: text.to_owned(),
                is_subscript,
            }),
        }
        rest = left;
    }
    parts
}

/// A label as plain text, as it is written where nothing can be lowered: `a_T`.
pub fn plain(label: &str) -> String {
    let as_written = |part: Part| match part.is_subscript {
        true => format!("_{}", part.text),
        false => part.text,
    };
    parts(label).into_iter().map(as_written).collect()
}

/// A name that a user gave, as a label that shows it letter by letter.
pub fn literal(name: &str) -> String {
    name.replace('\\', "\\\\").replace('_', "\\_")
}

/// What of a line of text is at its place: its start, its middle or its end; upwards, as along the y axis, its middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
    Upwards,
}

/// A label with its glyphs in their places; lengths are fractions of its size.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) runs: Vec<Run>,
    pub(super) width_em: f32,
}

/// Glyphs of one font and size.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub(super) font: Arc<Font>,
    pub(super) size_em: f32,
    pub(super) text: String,
    pub(super) glyphs: Vec<Glyph>,
}

/// A glyph right of the start of the line and below its baseline.
#[derive(Clone, Debug)]
pub(super) struct Glyph {
    pub(super) id: u32,
    pub(super) x_em: f32,
    pub(super) y_em: f32,
    /// The bytes of the text that it stands for.
    pub(super) range: Range<usize>,
}

/// The width of a label at size 1, kerned as it will be drawn.
pub(super) fn width_em(label: &str, typeface: &Typeface) -> f64 {
    f64::from(Line::of(label, typeface).width_em)
}

/// The size of a text of this width at size 1: this one, or less where the room (px) takes it.
pub(super) fn fitted_px(size: f64, width_em: f64, room: f64) -> f64 {
    match width_em * size > room {
        true => room / width_em,
        false => size,
    }
}

impl Line {
    /// Lays a label out.
    pub(super) fn of(label: &str, typeface: &Typeface) -> Self {
        let mut line = Self {
            runs: Vec::new(),
            width_em: 0.0,
        };
        for part in parts(label) {
            for (text, is_right_to_left) in directed(&part.text) {
                let mut pieces = of_one_font(text, typeface);
                if is_right_to_left {
                    pieces.reverse();
                }
                for (font, text) in pieces {
                    line.add(font, text, is_right_to_left, part.size_and_drop_em());
                }
            }
        }
        line
    }

    /// Adds a text of one font and one direction.
    fn add(
        &mut self,
        font: Arc<Font>,
        text: &str,
        is_right_to_left: bool,
        (size_em, drop_em): (f32, f32),
    ) {
        let mut buffer = UnicodeBuffer::new();
        buffer.push_str(text);
        buffer.set_direction(match is_right_to_left {
            true => Direction::RightToLeft,
            false => Direction::LeftToRight,
        });
        buffer.guess_segment_properties();
        let Some(shaped) = font.shaped(buffer) else {
            return;
        };
        let infos = shaped.glyph_infos();
        let starts = infos.iter().map(|info| info.cluster as usize);
        let end_of = |start| starts.clone().filter(|&next| next > start).min();
        let to_em = |units: i32| units as f32 * size_em / font.units_per_em;
        let mut glyphs = Vec::new();
        for (info, place) in infos.iter().zip(shaped.glyph_positions()) {
            let start = info.cluster as usize;
            glyphs.push(Glyph {
                id: info.glyph_id,
                x_em: self.width_em + to_em(place.x_offset),
                y_em: drop_em - to_em(place.y_offset),
                range: start..end_of(start).unwrap_or(text.len()),
            });
            self.width_em += to_em(place.x_advance);
        }
        self.runs.push(Run {
            font,
            size_em,
            text: text.to_owned(),
            glyphs,
        });
    }

    /// The transform from the line, its baseline from the origin to the right, to px: with its anchor at a place, at a size (px).
    pub(super) fn placed(&self, (x, y): (f64, f64), size: f64, anchor: Anchor) -> Transform {
        let (x, y, size) = (x as f32, y as f32, size as f32);
        let (before, turned) = match anchor {
            Anchor::Start => (0.0, false),
            Anchor::Middle => (0.5, false),
            Anchor::End => (1.0, false),
            Anchor::Upwards => (0.5, true),
        };
        let placed = match turned {
            true => Transform::from_row(0.0, -size, size, 0.0, x, y),
            false => Transform::from_row(size, 0.0, 0.0, size, x, y),
        };
        placed.pre_translate(-before * self.width_em, 0.0)
    }

    /// The letters as one path; `None` where none has ink.
    pub(super) fn outline(&self, placed: Transform) -> Option<Path> {
        let mut builder = PathBuilder::new();
        for run in &self.runs {
            let Some(tables) = run.font.tables() else {
                continue;
            };
            let outlines = tables.outline_glyphs();
            let scale = run.size_em / run.font.units_per_em;
            for glyph in &run.glyphs {
                let mut pen = GlyphPen {
                    builder: &mut builder,
                    // Above the baseline of a font y grows, in px it falls.
                    placed: placed
                        .pre_translate(glyph.x_em, glyph.y_em)
                        .pre_scale(scale, -scale),
                };
                let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
                if let Some(outline) = outlines.get(GlyphId::new(glyph.id)) {
                    // A broken outline of a font from a file is left out, as a letter without ink is.
                    let _ = outline.draw(settings, &mut pen);
                }
            }
        }
        builder.finish()
    }

    /// Characters that no font has: the first glyph of every font stands for those that it lacks.
    pub(super) fn missing(&self) -> impl Iterator<Item = char> {
        let of_run = |run: &Run| {
            let missing = run.glyphs.iter().filter(|glyph| glyph.id == 0);
            let texts = missing.filter_map(|glyph| run.text.get(glyph.range.clone()));
            texts.flat_map(str::chars).collect::<Vec<_>>()
        };
        self.runs.iter().flat_map(of_run)
    }
}

/// The pieces of a text that run in one direction, from left to right as they stand, and whether each is read from right to left.
fn directed(text: &str) -> Vec<(&str, bool)> {
    let bidi = BidiInfo::new(text, Some(Level::ltr()));
    let mut pieces = Vec::new();
    for paragraph in &bidi.paragraphs {
        let (levels, runs) = bidi.visual_runs(paragraph, paragraph.range.clone());
        let of_run = |run: Range<usize>| {
            let is_right_to_left = levels.get(run.start)?.is_rtl();
            Some((text.get(run)?, is_right_to_left))
        };
        pieces.extend(runs.into_iter().filter_map(of_run));
    }
    pieces
}

/// The pieces of a text that one font has, in the order in which they are read.
fn of_one_font<'a>(text: &'a str, typeface: &Typeface) -> Vec<(Arc<Font>, &'a str)> {
    let mut pieces: Vec<(Arc<Font>, Range<usize>)> = Vec::new();
    for (start, character) in text.char_indices() {
        let end = start + character.len_utf8();
        let Some(font) = typeface.font_of(character) else {
            continue;
        };
        match pieces.last_mut() {
            Some((last, range)) if Arc::ptr_eq(last, font) => range.end = end,
            _ => pieces.push((Arc::clone(font), start..end)),
        }
    }
    let pieces = pieces.into_iter();
    let pieces = pieces.filter_map(|(font, range)| Some((font, text.get(range)?)));
    pieces.collect()
}

/// Draws outlines of a font where a transform puts them.
struct GlyphPen<'a> {
    builder: &'a mut PathBuilder,
    placed: Transform,
}

impl GlyphPen<'_> {
    fn at(&self, x: f32, y: f32) -> Point {
        let mut point = Point::from_xy(x, y);
        self.placed.map_point(&mut point);
        point
    }
}

impl OutlinePen for GlyphPen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        let to = self.at(x, y);
        self.builder.move_to(to.x, to.y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = self.at(x, y);
        self.builder.line_to(to.x, to.y);
    }

    fn quad_to(&mut self, by_x: f32, by_y: f32, x: f32, y: f32) {
        let (by, to) = (self.at(by_x, by_y), self.at(x, y));
        self.builder.quad_to(by.x, by.y, to.x, to.y);
    }

    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        let (a, b, to) = (self.at(ax, ay), self.at(bx, by), self.at(x, y));
        self.builder.cubic_to(a.x, a.y, b.x, b.y, to.x, to.y);
    }

    fn close(&mut self) {
        self.builder.close();
    }
}

/// Whether XML can hold the text and a single line can show it.
pub(super) fn printable(text: &str) -> bool {
    !text
        .chars()
        .any(|c| c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::plan::figures::FontChoice;

    fn width(label: &str) -> f64 {
        width_em(label, &Typeface::default())
    }

    #[test]
    fn widths_follow_the_metrics_of_the_font() {
        let widths = ["0", "00", "⁻", ""].map(width);
        // The figure's advance in DejaVu Sans 2.37 is 1303 of 2048 units.
        assert!((widths[0] - 1303.0 / 2048.0).abs() < 1e-3, "{widths:?}");
        assert!((widths[1] - 2606.0 / 2048.0).abs() < 1e-3, "{widths:?}");
        assert!(widths[2] > 0.3, "{widths:?}");
        assert_eq!(widths[3], 0.0);
        // Arial and Times have figures of 1139 and 1024 units.
        for (choice, units) in [(FontChoice::Sans, 1139.0), (FontChoice::Serif, 1024.0)] {
            let width = width_em("0", &Typeface::of(&choice).unwrap());
            assert!((width - units / 2048.0).abs() < 1e-6, "{width}");
        }
    }

    #[test]
    fn a_pair_of_letters_is_kerned() {
        assert!(width("AV") < width("A") + width("V") - 0.03);
    }

    #[test]
    fn an_underscore_sets_a_subscript_but_for_names_that_a_user_gave() {
        let read = |label: &str| {
            let parts = parts(label).into_iter();
            let shown = parts.map(|part| match part.is_subscript {
                true => format!("[{}]", part.text),
                false => part.text,
            });
            shown.collect::<String>()
        };
        for (label, shown) in [
            ("a_T ω", "a[T] ω"),
            ("log₁₀ a_{T}", "log₁₀ a[T]"),
            ("E_{inst}/E_i′", "E[inst]/E[i]′"),
            ("a_", "a_"),
            ("a_ b __", "a_ b __"),
            ("a_{b", "a_{b"),
            ("\\_ \\\\ \\a", "_ \\ \\a"),
            ("_é", "[é]"),
        ] {
            assert_eq!(read(label), shown);
        }
        for name in ["PMMA_2", "a\\_b", "x_{y}", "\\", "_"] {
            assert_eq!(read(&literal(name)), name);
            assert_eq!(plain(&literal(name)), name);
        }
        assert_eq!(plain("a_T and E_{inst}"), "a_T and E_inst");
    }

    #[test]
    fn a_subscript_is_smaller_and_lower_and_measured_as_it_is_set() {
        let expected = width("a") + f64::from(SUBSCRIPT_EM) * width("T");
        assert!((width("a_T") - expected).abs() < 1e-6);
        let line = Line::of("a_T", &Typeface::default());
        let bounds = |line: &Line| line.outline(Transform::identity()).unwrap().bounds();
        let foot = bounds(&line).bottom();
        // Round letters reach a little below the baseline, a T does not.
        assert!((foot - SUBSCRIPT_DROP_EM).abs() < 1e-4, "{foot}");
    }

    #[test]
    fn letters_that_a_family_lacks_are_those_of_dejavu() {
        let sans = Typeface::of(&FontChoice::Sans).unwrap();
        let families = |text: &str| {
            let line = Line::of(text, &sans);
            let families = line.runs.iter().map(|run| run.font.family.clone());
            (
                families.collect::<Vec<_>>(),
                line.missing().collect::<String>(),
            )
        };
        assert_eq!(families("E″"), (vec!["Arimo".to_owned()], String::new()));
        let (both, missing) = families("a ∝ б");
        assert_eq!(both, ["Arimo", "DejaVu Sans", "Arimo", "DejaVu Sans"]);
        assert_eq!(missing, "");
        assert_eq!(families("a 中").1, "中");
    }

    #[test]
    fn what_is_read_from_right_to_left_stands_so() {
        let line = Line::of("a אב", &Typeface::default());
        let text: Vec<&str> = line.runs.iter().map(|run| &*run.text).collect();
        assert_eq!(text, ["a ", "אב"]);
        let glyphs = &line.runs[1].glyphs;
        assert!(glyphs[0].range.start > glyphs[1].range.start);
        assert!(glyphs[0].x_em < glyphs[1].x_em);
    }

    #[test]
    fn every_family_has_every_character_the_figures_use() {
        let used = "ωδτ⁻⁰¹²³⁴⁵⁶⁷⁸⁹₀₁₂₃″′°·×µ−η∞≈√πνσε∆";
        for (_, choice) in FontChoice::NAMED {
            let line = Line::of(used, &Typeface::of(&choice).unwrap());
            assert_eq!(line.missing().count(), 0, "{choice:?}");
            assert_eq!(line.runs.len(), 1, "{choice:?}");
        }
    }
}
