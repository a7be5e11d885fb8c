//! The picture as PDF: one page of the size that the picture has on paper, lines as lines, and text as text that can be searched
//! and copied. krilla writes the PDF, and embeds of the font what is used.

use std::sync::OnceLock;

use krilla::Document;
use krilla::color::{Color, luma, rgb};
use krilla::geom::{PathBuilder, Point, Transform};
use krilla::metadata::Metadata;
use krilla::num::NormalizedF32;
use krilla::page::PageSettings;
use krilla::paint::{Fill, LineCap, LineJoin, Stroke};
use krilla::surface::Surface;
use krilla::text::{Font, GlyphId, KrillaGlyph};
use resvg::tiny_skia::{Path, PathSegment};
use resvg::usvg;

use super::ChartError;
use super::drawing::{Drawing, FINE, PROGRAM, Paint, Shape};
use super::text::FONT;

/// PDF counts in points, 72 to an inch, SVG in px, 96 to an inch.
const POINTS_PER_PX: f64 = 0.75;
const POINTS_PER_MM: f64 = 72.0 / 25.4;
/// A shape with crisp edges, such as a cell of a map, is drawn so much wider (sixteenths of a px): viewers soften every edge, and
/// between two boxes that only touch the paper would shine through.
const SEAM: f32 = 8.0;
/// What opens the last lines of every PDF.
const PDF_END: &[u8] = b"startxref";

impl Drawing {
    /// The picture as PDF. The same picture gives the same bytes: there is no date in it. Title and description are those of the
    /// document.
    ///
    /// # Errors
    /// [`ChartError::Pdf`] where krilla refuses it.
    pub fn to_pdf(&self) -> Result<Vec<u8>, ChartError> {
        let (width_px, height_px) = (self.size.width_px, self.size.height_px);
        let (width, height, points_per_px) = match &self.paper {
            None => (
                f64::from(width_px) * POINTS_PER_PX,
                f64::from(height_px) * POINTS_PER_PX,
                POINTS_PER_PX,
            ),
            Some(paper) => (
                paper.width_mm * POINTS_PER_MM,
                paper.height_mm * POINTS_PER_MM,
                paper.px_mm * POINTS_PER_MM,
            ),
        };
        let page = PageSettings::from_wh(width as f32, height as f32)
            .ok_or_else(|| failed("the picture has no size"))?;
        let mut document = Document::new();
        let mut sheet = document.start_page_with(page);
        let mut surface = sheet.surface();
        let scale = (points_per_px / FINE) as f32;
        let drawn = self.charts.iter().try_for_each(|(top_px, shapes)| {
            let top = f64::from(*top_px) * points_per_px;
            let placed = Transform::from_row(scale, 0.0, 0.0, scale, 0.0, top as f32);
            surface.push_transform(&placed);
            let drawn = shapes
                .iter()
                .try_for_each(|shape| draw(shape, &mut surface));
            surface.pop();
            drawn
        });
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
        if let (Some(hash), Some(end)) = (&self.sweep_hash, end) {
            let comment = format!("% {PROGRAM}, sweep sha256 {hash}\n");
            bytes.splice(end..end, comment.into_bytes());
        }
        bytes
    }
}

fn failed(reason: impl ToString) -> ChartError {
    ChartError::Pdf {
        reason: reason.to_string(),
    }
}

fn draw(shape: &Shape, surface: &mut Surface<'_>) -> Result<(), ChartError> {
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
        return lines_of_text(text, shape.turned(), fill, surface);
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

/// Every run of text as one line of glyphs, each where usvg put it.
fn lines_of_text(
    text: &usvg::Text,
    turned: usvg::Transform,
    fill: &Fill,
    surface: &mut Surface<'_>,
) -> Result<(), ChartError> {
    let font = font()?;
    for span in text.layouted().iter().filter(|span| span.visible) {
        let size = span.font_size.get();
        // Without the scale from units of the font, which the size stands for.
        let to_size =
            usvg::Transform::from_scale(font.units_per_em() / size, font.units_per_em() / size);
        let placed: Vec<usvg::Transform> = span
            .positioned_glyphs
            .iter()
            .map(|glyph| glyph.transform().pre_concat(to_size))
            .collect();
        let Some((first, back)) = placed
            .first()
            .and_then(|first| Some((*first, first.invert()?)))
        else {
            continue;
        };
        // Along the line and below it, in units of the size.
        let places: Vec<(f32, f32)> = placed
            .iter()
            .map(|at| back.pre_concat(*at))
            .map(|at| (at.tx / size, at.ty / size))
            .collect();
        let (mut letters, mut glyphs) = (String::new(), Vec::new());
        for (k, glyph) in span.positioned_glyphs.iter().enumerate() {
            let from = letters.len();
            letters.push_str(&glyph.text);
            let (x, y) = places.get(k).copied().unwrap_or_default();
            let next = places.get(k + 1).map_or(x, |next| next.0);
            let id = GlyphId::new(glyph.id.0);
            let range = from..letters.len();
            glyphs.push(KrillaGlyph::new(id, next - x, 0.0, -y, 0.0, range, None));
        }
        surface.push_transform(&transform(turned.pre_concat(first)));
        surface.set_fill(Some(fill.clone()));
        surface.set_stroke(None);
        surface.draw_glyphs(
            Point::from_xy(0.0, 0.0),
            &glyphs,
            font.clone(),
            &letters,
            size,
            false,
        );
        surface.pop();
    }
    Ok(())
}

/// The embedded font, the only one that texts are laid out in.
fn font() -> Result<&'static Font, ChartError> {
    static READ: OnceLock<Option<Font>> = OnceLock::new();
    let read = READ.get_or_init(|| Font::new(FONT.into(), 0));
    read.as_ref()
        .ok_or_else(|| failed("its font cannot be read"))
}

fn transform(t: usvg::Transform) -> Transform {
    Transform::from_row(t.sx, t.ky, t.kx, t.sy, t.tx, t.ty)
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
