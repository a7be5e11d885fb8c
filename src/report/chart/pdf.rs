//! The picture as PDF: one page of the size that the picture has on paper, lines as lines, and text as text that can be searched
//! and copied.

use std::collections::BTreeMap;
use std::io::Write as _;

use flate2::{Compression, write::ZlibEncoder};
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish as _, Name, Pdf, Rect, Ref, Settings, Str, TextStr};
use tiny_skia::{Path, PathSegment};

use super::ChartError;
use super::drawing::{Drawing, POINTS_PER_MM, Paint, Shape, Text};
use super::eps::without_quadratic_curves;
use super::pdf_font::{FontRefs, Fonts};

/// A shape with crisp edges, such as a cell of a map, is drawn so much wider (px): viewers soften every edge, and between two boxes that
/// only touch the paper would shine through.
const SEAM: f32 = 0.5;
/// What opens the last lines of every PDF.
const PDF_END: &[u8] = b"startxref";

/// Nobody reads the objects of a picture.
const COMPACT: Settings = Settings { pretty: false };

const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const CONTENT: Ref = Ref::new(4);
const INFO: Ref = Ref::new(5);
/// The first of those whose number depends on the picture.
const FREE: Ref = Ref::new(6);

impl Drawing {
    /// The picture as PDF. The same picture gives the same bytes: there is no date in it. Title and description are those of the
    /// document.
    ///
    /// # Errors
    /// [`ChartError::Internal`] where the page cannot be compressed.
    pub fn to_pdf(&self) -> Result<Vec<u8>, ChartError> {
        let extent = self.extent();
        let points = |mm: f64| (mm * POINTS_PER_MM) as f32;
        let (width, height) = (points(extent.width_mm), points(extent.height_mm));
        let mut page = Page::new(Fonts::of(
            self.shapes.iter().filter_map(|s| s.text.as_deref()),
        ));
        // From px, of which the first row is on top, to points.
        let scale = points(extent.px_mm);
        page.content
            .transform([scale, 0.0, 0.0, -scale, 0.0, height]);
        page.content.set_line_join(LineJoinStyle::RoundJoin);
        for shape in &self.shapes {
            page.draw(shape);
        }
        let Page {
            content,
            fonts,
            opacities,
        } = page;

        let mut pdf = Pdf::with_settings(COMPACT);
        pdf.catalog(CATALOG).pages(PAGES);
        pdf.pages(PAGES).kids([PAGE]).count(1);
        let content = compressed(&content.finish())?;
        pdf.stream(CONTENT, &content).filter(Filter::FlateDecode);
        let mut free = FREE;
        let refs: Vec<FontRefs> = fonts.iter().map(|_| FontRefs::next(&mut free)).collect();
        let mut sheet = pdf.page(PAGE);
        sheet.parent(PAGES).contents(CONTENT);
        sheet.media_box(Rect::new(0.0, 0.0, width, height));
        let mut resources = sheet.resources();
        let mut named = resources.fonts();
        for (font, refs) in fonts.iter().zip(&refs) {
            named.pair(Name(font.name.as_bytes()), refs.font);
        }
        named.finish();
        let mut states = resources.ext_g_states();
        for (&percent, name) in &opacities {
            let mut state = states
                .insert(Name(name.as_bytes()))
                .start::<pdf_writer::writers::ExtGraphicsState<'_>>();
            state.non_stroking_alpha(percent as f32 / 1000.0);
        }
        states.finish();
        resources.finish();
        sheet.finish();
        for (font, refs) in fonts.iter().zip(&refs) {
            font.write(&mut pdf, refs)?;
        }
        let mut info = pdf.document_info(INFO);
        info.title(TextStr(&self.title));
        info.subject(TextStr(self.description.as_deref().unwrap_or_default()));
        info.creator(TextStr(env!("CARGO_PKG_NAME")));
        info.finish();
        Ok(self.stamp_pdf(pdf.finish()))
    }

    /// The comment goes behind the trailer, where no offset of the file counts past it.
    fn stamp_pdf(&self, mut bytes: Vec<u8>) -> Vec<u8> {
        let end = bytes.windows(PDF_END.len()).rposition(|w| w == PDF_END);
        if let (Some(stamp), Some(end)) = (self.stamp(), end) {
            let comment = format!("% {stamp}\n");
            bytes.splice(end..end, comment.into_bytes());
        }
        bytes
    }
}

/// A stream as the filter FlateDecode reads it.
pub(super) fn compressed(bytes: &[u8]) -> Result<Vec<u8>, ChartError> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    written.map_err(|error| ChartError::internal("write the PDF of", error))
}

/// What is drawn so far, and what it uses by name: fonts, and the opacities that are not 1, in thousandths.
struct Page {
    content: Content,
    fonts: Fonts,
    opacities: BTreeMap<u32, String>,
}

impl Page {
    fn new(fonts: Fonts) -> Self {
        Self {
            content: Content::with_settings(COMPACT),
            fonts,
            opacities: BTreeMap::new(),
        }
    }

    fn draw(&mut self, shape: &Shape) {
        match shape.paint {
            Paint::Fill {
                color,
                opacity,
                crisp,
            } => {
                self.set_fill(color);
                if let Some(text) = &shape.text
                    && self.draw_text(text)
                {
                    return;
                }
                let thousandths = (opacity * 1000.0).round() as u32;
                if thousandths < 1000 {
                    let name = format!("A{thousandths}");
                    self.content.save_state();
                    self.content.set_parameters(Name(name.as_bytes()));
                    self.opacities.insert(thousandths, name);
                }
                if crisp {
                    self.set_stroke(color, SEAM, LineCapStyle::ButtCap);
                }
                self.add_path(&shape.path);
                match crisp {
                    true => self.content.fill_nonzero_and_stroke(),
                    false => self.content.fill_nonzero(),
                };
                if thousandths < 1000 {
                    self.content.restore_state();
                }
            }
            Paint::Stroke {
                color,
                width,
                round_ends,
            } => {
                let cap = match round_ends {
                    true => LineCapStyle::RoundCap,
                    false => LineCapStyle::ButtCap,
                };
                self.set_stroke(color, width as f32, cap);
                self.add_path(&shape.path);
                self.content.stroke();
            }
        }
    }

    /// Greys are told as greys, so that a printer mixes no inks for them.
    fn set_fill(&mut self, color: [u8; 3]) {
        let [red, green, blue] = color.map(|part| f32::from(part) / 255.0);
        match red == green && green == blue {
            true => self.content.set_fill_gray(red),
            false => self.content.set_fill_rgb(red, green, blue),
        };
    }

    fn set_stroke(&mut self, color: [u8; 3], width: f32, cap: LineCapStyle) {
        let [red, green, blue] = color.map(|part| f32::from(part) / 255.0);
        match red == green && green == blue {
            true => self.content.set_stroke_gray(red),
            false => self.content.set_stroke_rgb(red, green, blue),
        };
        self.content.set_line_width(width).set_line_cap(cap);
    }

    fn add_path(&mut self, path: &Path) {
        let content = &mut self.content;
        for segment in without_quadratic_curves(path) {
            match segment {
                PathSegment::MoveTo(to) => content.move_to(to.x, to.y),
                PathSegment::LineTo(to) => content.line_to(to.x, to.y),
                PathSegment::QuadTo(..) => content,
                PathSegment::CubicTo(a, b, to) => content.cubic_to(a.x, a.y, b.x, b.y, to.x, to.y),
                PathSegment::Close => content.close_path(),
            };
        }
    }

    /// Every run of text as glyphs in their places; false where one of its fonts can only be drawn as outlines.
    fn draw_text(&mut self, text: &Text) -> bool {
        let runs = &text.line.runs;
        let Some(fonts) = runs
            .iter()
            .map(|run| self.fonts.of_run(run))
            .collect::<Option<Vec<_>>>()
        else {
            return false;
        };
        let content = &mut self.content;
        content.begin_text();
        for (run, font) in runs.iter().zip(fonts) {
            content.set_font(Name(font.name.as_bytes()), 1.0);
            for level in run.glyphs.chunk_by(|a, b| a.y_em == b.y_em) {
                let Some(first) = level.first() else { continue };
                // The y axis of glyphs points up.
                let t = text
                    .placed
                    .pre_translate(first.x_em, first.y_em)
                    .pre_scale(run.size_em, -run.size_em);
                content.set_text_matrix([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty]);
                let mut shown = content.show_positioned();
                let mut items = shown.items();
                let mut codes: Vec<u8> = Vec::new();
                let mut at = first.x_em / run.size_em * 1000.0;
                for glyph in level {
                    let place = glyph.x_em / run.size_em * 1000.0;
                    // Thousandths of the size; less than that nobody sees.
                    if (at - place).abs() > 0.5 {
                        items.show(Str(&codes)).adjust(at - place);
                        codes.clear();
                        at = place;
                    }
                    let (code, width) = font.code_and_width(glyph.id);
                    codes.extend(code.to_be_bytes());
                    at += width;
                }
                items.show(Str(&codes));
            }
        }
        content.end_text();
        true
    }
}

#[cfg(test)]
mod tests {
    use crate::report::chart::{Axis, Chart, Series};

    fn chart() -> Chart {
        let line = Series::line([(0.0, 0.0), (1.0, 1.0)]).area_to(0.0);
        Chart::new(
            Axis::linear("angular frequency ω / rad·s⁻¹"),
            Axis::linear("E″ / GPa"),
        )
        .series(line.label("PMMA"))
        .size(481, 361)
    }

    fn pdf() -> String {
        let drawing = chart().draw().unwrap();
        let drawing = drawing.on_paper(85.0, Some(63.75), 0.176_388_9);
        let bytes = drawing.described("A line < a curve").to_pdf().unwrap();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    #[test]
    fn the_page_has_the_millimetres_of_the_picture() {
        let text = pdf();
        assert!(text.starts_with("%PDF-1.") && text.trim_end().ends_with("%%EOF"));
        assert_eq!(text.matches("/Type/Page/").count(), 1);
        let sides = text
            .split("/MediaBox[")
            .nth(1)
            .unwrap()
            .split(']')
            .next()
            .unwrap();
        let sides: Vec<f64> = sides.split(' ').map(|side| side.parse().unwrap()).collect();
        let points = |mm: f64| mm / 25.4 * 72.0;
        // Points are written to single precision.
        assert!((sides[2] - points(85.0)).abs() < 1e-3, "{sides:?}");
        assert!((sides[3] - points(63.75)).abs() < 1e-3, "{sides:?}");
    }

    #[test]
    fn text_has_its_font_and_the_document_its_words() {
        let text = pdf();
        assert!(text.contains("DejaVuSans") && text.contains("/ToUnicode"));
        assert!(text.contains("/Title") && text.contains("/Subject"));
    }

    #[test]
    fn the_same_picture_gives_the_same_bytes_without_a_date() {
        let text = pdf();
        assert_eq!(text, pdf());
        assert!(!text.contains("Date"));
    }
}
