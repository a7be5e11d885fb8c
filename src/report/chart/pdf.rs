//! The picture as PDF: one page of the size that the picture has on paper, lines as lines, and text as text that can be searched
//! and copied. krilla writes the PDF, and embeds of the font what is used.

use std::collections::HashMap;
use std::sync::Arc;

use krilla::Document;
use krilla::color::{Color, luma, rgb};
use krilla::geom::{PathBuilder, Point, Transform};
use krilla::metadata::Metadata;
use krilla::num::NormalizedF32;
use krilla::page::PageSettings;
use krilla::paint::{Fill, LineCap, LineJoin, Stroke};
use krilla::surface::Surface;
use krilla::text::{Font, GlyphId, KrillaGlyph};
use tiny_skia::{Path, PathSegment};

use super::ChartError;
use super::drawing::{Drawing, POINTS_PER_MM, Paint, Shape, Text};
use super::text::Run;

/// A shape with crisp edges, such as a cell of a map, is drawn so much wider (px): viewers soften every edge, and between two boxes that
/// only touch the paper would shine through.
const SEAM: f32 = 0.5;
/// What opens the last lines of every PDF.
const PDF_END: &[u8] = b"startxref";

impl Drawing {
    /// The picture as PDF. The same picture gives the same bytes: there is no date in it. Title and description are those of the
    /// document.
    ///
    /// # Errors
    /// [`ChartError::Internal`] where krilla refuses it.
    pub fn to_pdf(&self) -> Result<Vec<u8>, ChartError> {
        let extent = self.extent();
        let points = |mm: f64| (mm * POINTS_PER_MM) as f32;
        let page = PageSettings::from_wh(points(extent.width_mm), points(extent.height_mm))
            .ok_or_else(|| failed("the picture has no size"))?;
        let mut document = Document::new();
        let mut sheet = document.start_page_with(page);
        let mut surface = sheet.surface();
        let mut fonts = Fonts::default();
        let scale = points(extent.px_mm);
        surface.push_transform(&Transform::from_scale(scale, scale));
        let mut shapes = self.shapes.iter();
        let drawn = shapes.try_for_each(|shape| draw(shape, &mut fonts, &mut surface));
        surface.pop();
        surface.finish();
        sheet.finish();
        drawn?;
        let description = self.description.clone().unwrap_or_default();
        let metadata = Metadata::new()
            .title(self.title.clone())
            .description(description)
            .creator(env!("CARGO_PKG_NAME").to_owned());
        document.set_metadata(metadata);
        Ok(self.stamp_pdf(document.finish().map_err(failed)?))
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

fn failed(reason: impl ToString) -> ChartError {
    ChartError::internal("write the PDF of", reason)
}

/// The fonts that were used, by the place of their bytes.
type Fonts = HashMap<*const u8, Font>;

fn draw(shape: &Shape, fonts: &mut Fonts, surface: &mut Surface<'_>) -> Result<(), ChartError> {
    let (fill, stroke) = match shape.paint {
        Paint::Fill {
            color,
            opacity,
            crisp,
        } => {
            let fill = Fill {
                paint: flat(color).into(),
                opacity: NormalizedF32::new(opacity as f32).unwrap_or(NormalizedF32::ONE),
                ..Fill::default()
            };
            let seam = crisp.then(|| Stroke {
                paint: fill.paint.clone(),
                width: SEAM,
                ..Stroke::default()
            });
            (Some(fill), seam)
        }
        Paint::Stroke {
            color,
            width,
            round_ends,
        } => {
            let stroke = Stroke {
                paint: flat(color).into(),
                width: width as f32,
                line_join: LineJoin::Round,
                line_cap: match round_ends {
                    true => LineCap::Round,
                    false => LineCap::Butt,
                },
                ..Stroke::default()
            };
            (None, Some(stroke))
        }
    };
    if let (Some(text), Some(fill)) = (&shape.text, &fill) {
        return draw_text(text, fill, fonts, surface);
    }
    surface.set_fill(fill);
    surface.set_stroke(stroke);
    if let Some(path) = copied(&shape.path) {
        surface.draw_path(&path);
    }
    Ok(())
}

/// Greys are told as greys, so that a printer mixes no inks for them.
fn flat([red, green, blue]: [u8; 3]) -> Color {
    match red == green && green == blue {
        true => luma::Color::new(red).into(),
        false => rgb::Color::new(red, green, blue).into(),
    }
}

fn copied(path: &Path) -> Option<krilla::geom::Path> {
    let mut builder = PathBuilder::new();
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(to) => builder.move_to(to.x, to.y),
            PathSegment::LineTo(to) => builder.line_to(to.x, to.y),
            PathSegment::QuadTo(by, to) => builder.quad_to(by.x, by.y, to.x, to.y),
            PathSegment::CubicTo(a, b, to) => builder.cubic_to(a.x, a.y, b.x, b.y, to.x, to.y),
            PathSegment::Close => builder.close(),
        }
    }
    builder.finish()
}

/// Every run of text as one line of glyphs, each in its place.
fn draw_text(
    text: &Text,
    fill: &Fill,
    fonts: &mut Fonts,
    surface: &mut Surface<'_>,
) -> Result<(), ChartError> {
    let t = text.placed;
    surface.push_transform(&Transform::from_row(t.sx, t.ky, t.kx, t.sy, t.tx, t.ty));
    surface.set_fill(Some(fill.clone()));
    surface.set_stroke(None);
    for run in &text.line.runs {
        let font = font(run, fonts)?;
        let Some(first) = run.glyphs.first() else {
            continue;
        };
        let next = run.glyphs.iter().skip(1).map(|glyph| glyph.x_em);
        // Behind the last glyph comes none.
        let next = next.chain(run.glyphs.last().map(|glyph| glyph.x_em));
        let glyphs: Vec<KrillaGlyph> = run
            .glyphs
            .iter()
            .zip(next)
            .map(|(glyph, next)| {
                let advance = (next - glyph.x_em) / run.size_em;
                let above = (first.y_em - glyph.y_em) / run.size_em;
                let id = GlyphId::new(glyph.id);
                KrillaGlyph::new(id, advance, 0.0, above, 0.0, glyph.range.clone(), None)
            })
            .collect();
        let at = Point::from_xy(first.x_em, first.y_em);
        surface.draw_glyphs(at, &glyphs, font, &run.text, run.size_em, false);
    }
    surface.pop();
    Ok(())
}

/// The font of a run, read once for a document.
fn font(run: &Run, fonts: &mut Fonts) -> Result<Font, ChartError> {
    let bytes = Arc::clone(&run.font.bytes);
    let place = (*bytes).as_ref().as_ptr();
    if let Some(font) = fonts.get(&place) {
        return Ok(font.clone());
    }
    let font = Font::new(bytes.into(), 0).ok_or_else(|| failed("its font cannot be read"))?;
    fonts.insert(place, font.clone());
    Ok(font)
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
