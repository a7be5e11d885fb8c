//! Fonts of a PDF: what is used of each is embedded, with what its glyphs stand for, by which a reader searches and copies.

use std::collections::BTreeMap;
use std::sync::Arc;

use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Filter, Finish as _, Name, Pdf, Rect, Ref, Str};
use skrifa::instance::{LocationRef, Size};
use skrifa::string::StringId;
use skrifa::{FontRef, GlyphId, MetadataProvider as _, Tag};
use subsetter::GlyphRemapper;

use super::ChartError;
use super::drawing::Text;
use super::pdf::compressed;
use super::text::Run;
use crate::figures::font::Font;

/// Lengths of a font in a PDF are thousandths of its size.
const UNITS: f32 = 1000.0;
/// How characters are told: two bytes each, which are the number of the glyph.
const ENCODING: Name<'_> = Name(b"Identity-H");
const SYSTEM: SystemInfo<'_> = SystemInfo {
    registry: Str(b"Adobe"),
    ordering: Str(b"Identity"),
    supplement: 0,
};
/// The width of upright stems, which every description of a font has to name and no reader needs where the font is embedded.
const STEM: f32 = 80.0;

/// The fonts of a document, in the order in which they are used first.
pub(super) struct Fonts(Vec<EmbeddedFont>);

/// What is used of a font.
pub(super) struct EmbeddedFont {
    /// What the page calls it.
    pub(super) name: String,
    font: Arc<Font>,
    /// From the glyphs of the font to those of the file.
    numbers: GlyphRemapper,
    /// The font file of these glyphs alone; `None` where the font can only be drawn as outlines.
    file: Option<Vec<u8>>,
    /// By its number in the file, what each glyph stands for.
    letters: BTreeMap<u16, String>,
}

/// The objects of a font.
pub(super) struct FontRefs {
    pub(super) font: Ref,
    glyphs: Ref,
    descriptor: Ref,
    file: Ref,
    letters: Ref,
}

impl FontRefs {
    /// The next free ones.
    pub(super) fn next(free: &mut Ref) -> Self {
        Self {
            font: free.bump(),
            glyphs: free.bump(),
            descriptor: free.bump(),
            file: free.bump(),
            letters: free.bump(),
        }
    }
}

impl Fonts {
    /// Those of these texts.
    pub(super) fn of<'a>(texts: impl Iterator<Item = &'a Text>) -> Self {
        let mut fonts = Self(Vec::new());
        for run in texts.flat_map(|text| &text.line.runs) {
            fonts.add(run);
        }
        for font in &mut fonts.0 {
            font.file = subsetter::subset((*font.font.bytes).as_ref(), 0, &font.numbers).ok();
        }
        fonts
    }

    fn add(&mut self, run: &Run) {
        let known = self
            .0
            .iter()
            .position(|font| Arc::ptr_eq(&font.font, &run.font));
        let place = known.unwrap_or(self.0.len());
        if known.is_none() {
            self.0.push(EmbeddedFont {
                name: format!("F{place}"),
                font: Arc::clone(&run.font),
                numbers: GlyphRemapper::new(),
                file: None,
                letters: BTreeMap::new(),
            });
        }
        let Some(font) = self.0.get_mut(place) else {
            return;
        };
        let mut before = None;
        for glyph in &run.glyphs {
            let number = font.numbers.remap(glyph.id as u16);
            // Of the glyphs that stand for a text together, the first has it.
            if before.replace(&glyph.range) != Some(&glyph.range)
                && let Some(text) = run.text.get(glyph.range.clone())
            {
                font.letters
                    .entry(number)
                    .or_insert_with(|| text.to_owned());
            }
        }
    }

    /// The font of a run, if a reader can show it.
    pub(super) fn of_run(&self, run: &Run) -> Option<&EmbeddedFont> {
        self.iter().find(|font| Arc::ptr_eq(&font.font, &run.font))
    }

    /// Those that are embedded.
    pub(super) fn iter(&self) -> impl Iterator<Item = &EmbeddedFont> {
        self.0.iter().filter(|font| font.file.is_some())
    }
}

impl EmbeddedFont {
    /// What tells a glyph of the font, and its width in thousandths of the size.
    pub(super) fn code_and_width(&self, glyph: u32) -> (u16, f32) {
        let code = self.numbers.get(glyph as u16).unwrap_or_default();
        (code, self.width(glyph))
    }

    fn width(&self, glyph: u32) -> f32 {
        let tables = self.font.tables();
        let metrics =
            tables.map(|tables| tables.glyph_metrics(Size::unscaled(), LocationRef::default()));
        let width = metrics.and_then(|metrics| metrics.advance_width(GlyphId::new(glyph)));
        width.unwrap_or_default() * self.thousandths()
    }

    fn thousandths(&self) -> f32 {
        UNITS / self.font.units_per_em
    }

    /// Adds what a reader needs of the font.
    pub(super) fn write(&self, pdf: &mut Pdf, refs: &FontRefs) -> Result<(), ChartError> {
        let (Some(tables), Some(file)) = (self.font.tables(), &self.file) else {
            return Ok(());
        };
        // Outlines of PostScript are embedded without the tables around them.
        let inner = FontRef::new(file).ok();
        let postscript = inner
            .as_ref()
            .and_then(|font| font.table_data(Tag::new(b"CFF ")));
        let name = self.subset_name(&tables);
        let name = Name(name.as_bytes());

        let mut whole = pdf.type0_font(refs.font);
        whole.base_font(name).encoding_predefined(ENCODING);
        whole.descendant_font(refs.glyphs).to_unicode(refs.letters);
        whole.finish();

        let mut glyphs = pdf.cid_font(refs.glyphs);
        glyphs
            .base_font(name)
            .system_info(SYSTEM)
            .font_descriptor(refs.descriptor);
        match postscript.is_some() {
            true => glyphs.subtype(CidFontType::Type0),
            false => glyphs
                .subtype(CidFontType::Type2)
                .cid_to_gid_map_predefined(Name(b"Identity")),
        };
        let widths = self
            .numbers
            .remapped_gids()
            .map(|glyph| self.width(glyph.into()));
        glyphs.widths().consecutive(0, widths);
        glyphs.finish();

        self.describe(pdf, (refs, name), &tables, postscript.is_some());
        match &postscript {
            Some(outlines) => {
                let stream = compressed(outlines.as_bytes())?;
                let mut written = pdf.stream(refs.file, &stream);
                written.filter(Filter::FlateDecode);
                written.pair(Name(b"Subtype"), Name(b"CIDFontType0C"));
            }
            None => {
                let stream = compressed(file)?;
                let mut written = pdf.stream(refs.file, &stream);
                written.filter(Filter::FlateDecode);
                written.pair(
                    Name(b"Length1"),
                    i32::try_from(file.len()).unwrap_or(i32::MAX),
                );
            }
        }
        let mut letters = UnicodeCmap::new(Name(b"Letters"), SYSTEM);
        for (&number, text) in &self.letters {
            letters.pair_with_multiple(number, text.chars());
        }
        pdf.cmap(refs.letters, &letters.finish());
        Ok(())
    }

    fn describe(
        &self,
        pdf: &mut Pdf,
        (refs, name): (&FontRefs, Name<'_>),
        tables: &FontRef<'_>,
        is_postscript: bool,
    ) {
        let metrics = tables.metrics(Size::unscaled(), LocationRef::default());
        let scale = self.thousandths();
        let bounds = metrics.bounds.unwrap_or_default();
        let mut descriptor = pdf.font_descriptor(refs.descriptor);
        descriptor.name(name).flags(FontFlags::SYMBOLIC);
        descriptor.bbox(Rect::new(
            bounds.x_min * scale,
            bounds.y_min * scale,
            bounds.x_max * scale,
            bounds.y_max * scale,
        ));
        descriptor.italic_angle(metrics.italic_angle);
        descriptor
            .ascent(metrics.ascent * scale)
            .descent(metrics.descent * scale);
        descriptor
            .cap_height(metrics.cap_height.unwrap_or(metrics.ascent) * scale)
            .stem_v(STEM);
        match is_postscript {
            true => descriptor.font_file3(refs.file),
            false => descriptor.font_file2(refs.file),
        };
    }

    /// The name of the font behind six letters, by which readers tell parts of the same font from one another.
    fn subset_name(&self, tables: &FontRef<'_>) -> String {
        let name = tables
            .localized_strings(StringId::POSTSCRIPT_NAME)
            .english_or_first();
        let name = name.map_or_else(|| self.font.family.clone(), |name| name.chars().collect());
        let name: String = name.chars().filter(char::is_ascii_graphic).collect();
        let numbers = self.numbers.remapped_gids();
        let mix = |hash: u32, number| hash.wrapping_mul(31).wrapping_add(u32::from(number));
        let mut hash = numbers.fold(0, mix);
        let tag = std::iter::repeat_with(|| {
            let letter = b'A' + (hash % 26) as u8;
            hash /= 26;
            char::from(letter)
        });
        tag.take(6).chain(['+']).chain(name.chars()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::font::Typeface;
    use crate::report::chart::drawing::Shape;
    use crate::report::chart::drawing::tests::drawn;
    use crate::report::chart::text::Anchor;

    #[test]
    fn a_reader_finds_every_letter_and_glyphs_as_wide_as_they_were_laid_out() {
        let place = ((0.0, 0.0), 10.0, Anchor::Start);
        let labels = ["E″/GPa, a_T ω", "20148"].map(|label| {
            let shape = Shape::of_text(label, &Typeface::default(), place).unwrap();
            shape.text.unwrap()
        });
        let fonts = Fonts::of(labels.iter().map(|label| &**label));
        for run in labels.iter().flat_map(|label| &label.line.runs) {
            let font = fonts.of_run(run).unwrap();
            let codes = run
                .glyphs
                .iter()
                .map(|glyph| font.code_and_width(glyph.id).0);
            let read: String = codes.map(|code| &*font.letters[&code]).collect();
            assert_eq!(read, run.text);
        }
        // Figures are not kerned.
        let figures = &labels[1].line.runs[0];
        let font = fonts.of_run(figures).unwrap();
        for pair in figures.glyphs.windows(2) {
            let width = font.code_and_width(pair[0].id).1 / UNITS;
            assert!((pair[1].x_em - pair[0].x_em - width).abs() < 1e-4);
        }
    }

    #[test]
    fn of_a_font_only_what_is_used_is_embedded() {
        let drawing = drawn();
        let fonts = Fonts::of(drawing.shapes.iter().filter_map(|s| s.text.as_deref()));
        let font = fonts.iter().next().unwrap();
        let (whole, part) = (
            (*font.font.bytes).as_ref().len(),
            font.file.as_ref().unwrap().len(),
        );
        assert!(part < whole / 10, "{part} of {whole} bytes");
    }
}
