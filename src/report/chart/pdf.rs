//! The finished picture as PDF: one page of the size that the picture has on paper, lines as lines, and text as text that can be
//! searched and copied where the SVG was asked for with its letters as [`Letters::Text`](super::Letters::Text).
//!
//! krilla writes the PDF, and embeds of the font what is used. Its own reader of SVG is bound to an older usvg than that of the
//! PNG and brings readers of pictures along; what these pictures are made of, flat colours and lines, is quickly walked.

use std::sync::OnceLock;

use krilla::color::{luma, rgb};
use krilla::geom::{Path, PathBuilder, Point, Transform};
use krilla::metadata::Metadata;
use krilla::num::NormalizedF32;
use krilla::page::PageSettings;
use krilla::paint::{Fill, FillRule, LineCap, LineJoin, Paint, Stroke, StrokeDash};
use krilla::surface::Surface;
use krilla::text::{Font, GlyphId, KrillaGlyph};
use krilla::{Document, color};
use resvg::tiny_skia::PathSegment;
use resvg::usvg::{self, roxmltree};

use super::ChartError;
use super::text::{FONT, options};

/// PDF counts in points, 72 to an inch, SVG in px, 96 to an inch.
const POINTS_PER_PX: f32 = 0.75;
/// A box meant to have crisp edges, such as a cell of a map, is drawn so much (px) wider: viewers soften every edge, and between
/// two boxes that only touch the paper would shine through.
const SEAM: f32 = 0.5;

/// The SVG of [`super::to_svg`] and its like as PDF. The same picture gives the same bytes: there is no date in it. Title and
/// description of the SVG are those of the document.
///
/// # Errors
/// [`ChartError::Svg`] where the text is no SVG, [`ChartError::Pdf`] where it has what no chart has, such as a gradient.
pub fn to_pdf(svg: &str) -> Result<Vec<u8>, ChartError> {
    let xml = roxmltree::Document::parse(svg).map_err(usvg::Error::ParsingFailed)?;
    let tree = usvg::Tree::from_xmltree(&xml, &options())?;
    let points = |px: f32| px * POINTS_PER_PX;
    let page = PageSettings::from_wh(points(tree.size().width()), points(tree.size().height()))
        .ok_or_else(|| failed("the picture has no size"))?;
    let mut document = Document::new();
    let mut sheet = document.start_page_with(page);
    let mut surface = sheet.surface();
    surface.push_transform(&Transform::from_scale(POINTS_PER_PX, POINTS_PER_PX));
    let drawn = group(tree.root(), &mut surface);
    surface.pop();
    surface.finish();
    sheet.finish();
    drawn?;
    document.set_metadata(words(&xml));
    document.finish().map_err(failed)
}

fn failed(reason: impl ToString) -> ChartError {
    ChartError::Pdf {
        reason: reason.to_string(),
    }
}

/// What the picture says of itself.
fn words(xml: &roxmltree::Document<'_>) -> Metadata {
    let text = |name: &str| {
        let mut parts = xml.root_element().children();
        let part = parts.find(|node| node.tag_name().name() == name);
        part.and_then(|node| node.text())
            .unwrap_or_default()
            .to_owned()
    };
    Metadata::new()
        .title(text("title"))
        .description(text("desc"))
        .creator(env!("CARGO_PKG_NAME").to_owned())
}

fn group(group: &usvg::Group, surface: &mut Surface<'_>) -> Result<(), ChartError> {
    let plain = group.clip_path().is_none()
        && group.mask().is_none()
        && group.filters().is_empty()
        && group.blend_mode() == usvg::BlendMode::Normal;
    if !plain {
        return Err(failed("it has a mask, a filter or a clipped part"));
    }
    surface.push_transform(&transform(group.transform()));
    let opacity = group.opacity();
    let translucent = opacity != usvg::Opacity::ONE;
    if translucent {
        surface.push_opacity(part(opacity));
        surface.push_isolated();
    }
    let drawn = group.children().iter().try_for_each(|node| match node {
        usvg::Node::Group(group) => self::group(group, surface),
        usvg::Node::Path(path) => outline(path, surface),
        usvg::Node::Text(text) => lines_of_text(text, surface),
        usvg::Node::Image(_) => Err(failed("it holds another picture")),
    });
    if translucent {
        surface.pop();
        surface.pop();
    }
    surface.pop();
    drawn
}

fn outline(path: &usvg::Path, surface: &mut Surface<'_>) -> Result<(), ChartError> {
    let mut stroke = path.stroke().map(self::stroke).transpose()?;
    let fill = path.fill().map(self::fill).transpose()?;
    if let (None, Some(fill), usvg::ShapeRendering::CrispEdges) =
        (&stroke, &fill, path.rendering_mode())
    {
        stroke = Some(Stroke {
            paint: fill.paint.clone(),
            width: SEAM,
            opacity: fill.opacity,
            ..Stroke::default()
        });
    }
    if path.is_visible()
        && (fill.is_some() || stroke.is_some())
        && let Some(shape) = shape(path)
    {
        surface.set_fill(fill);
        surface.set_stroke(stroke);
        surface.draw_path(&shape);
    }
    Ok(())
}

fn shape(path: &usvg::Path) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for segment in path.data().segments() {
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
fn lines_of_text(text: &usvg::Text, surface: &mut Surface<'_>) -> Result<(), ChartError> {
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
        surface.push_transform(&transform(first));
        surface.set_fill(span.fill.as_ref().map(fill).transpose()?);
        surface.set_stroke(span.stroke.as_ref().map(stroke).transpose()?);
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

fn fill(fill: &usvg::Fill) -> Result<Fill, ChartError> {
    Ok(Fill {
        paint: paint(fill.paint())?,
        opacity: part(fill.opacity()),
        rule: match fill.rule() {
            usvg::FillRule::NonZero => FillRule::NonZero,
            usvg::FillRule::EvenOdd => FillRule::EvenOdd,
        },
    })
}

fn stroke(stroke: &usvg::Stroke) -> Result<Stroke, ChartError> {
    Ok(Stroke {
        paint: paint(stroke.paint())?,
        width: stroke.width().get(),
        miter_limit: stroke.miterlimit().get(),
        line_cap: match stroke.linecap() {
            usvg::LineCap::Butt => LineCap::Butt,
            usvg::LineCap::Round => LineCap::Round,
            usvg::LineCap::Square => LineCap::Square,
        },
        line_join: match stroke.linejoin() {
            usvg::LineJoin::Round => LineJoin::Round,
            usvg::LineJoin::Bevel => LineJoin::Bevel,
            usvg::LineJoin::Miter | usvg::LineJoin::MiterClip => LineJoin::Miter,
        },
        opacity: part(stroke.opacity()),
        dash: stroke.dasharray().map(|lengths| StrokeDash {
            array: lengths.to_vec(),
            offset: stroke.dashoffset(),
        }),
    })
}

/// A flat colour; greys are told as greys, so that a printer mixes no inks for them.
fn paint(paint: &usvg::Paint) -> Result<Paint, ChartError> {
    let usvg::Paint::Color(usvg::Color { red, green, blue }) = *paint else {
        return Err(failed("it has a gradient or a pattern"));
    };
    Ok(match red == green && green == blue {
        true => color::Color::from(luma::Color::new(red)).into(),
        false => color::Color::from(rgb::Color::new(red, green, blue)).into(),
    })
}

fn part(opacity: usvg::Opacity) -> NormalizedF32 {
    NormalizedF32::new(opacity.get()).unwrap_or(NormalizedF32::ONE)
}

fn transform(transform: usvg::Transform) -> Transform {
    let usvg::Transform {
        sx,
        ky,
        kx,
        sy,
        tx,
        ty,
    } = transform;
    Transform::from_row(sx, ky, kx, sy, tx, ty)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{
        Axis, Chart, Letters, Series, described, on_paper, to_svg, to_svg_with,
    };

    fn chart() -> Chart {
        let line = Series::line([(0.0, 0.0), (1.0, 1.0)]).fill_to(0.0);
        Chart::new(
            Axis::linear("angular frequency ω / rad·s⁻¹"),
            Axis::linear("E″ / GPa"),
        )
        .series(line.label("PMMA"))
        .size(481, 361)
    }

    fn pdf(letters: Letters) -> String {
        let svg = to_svg_with(&chart(), letters).unwrap();
        let svg = on_paper(&svg, 85.0, Some(63.75), 0.176_388_9).unwrap();
        let bytes = to_pdf(&described(&svg, "A line < a curve")).unwrap();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    #[test]
    fn the_page_has_the_millimetres_of_the_picture() {
        let text = pdf(Letters::Text);
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
    fn text_has_its_font_and_outlines_need_none() {
        let text = pdf(Letters::Text);
        assert!(text.contains("DejaVuSans") && text.contains("/ToUnicode"));
        assert!(!pdf(Letters::Outlines).contains("/Font<<"));
        assert!(text.contains("/Title") && text.contains("/Subject"));
    }

    #[test]
    fn the_same_picture_gives_the_same_bytes_without_a_date() {
        let text = pdf(Letters::Text);
        assert_eq!(text, pdf(Letters::Text));
        assert!(!text.contains("Date"));
    }

    #[test]
    fn what_no_chart_has_is_refused_and_no_svg_too() {
        let gradient = r##"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><linearGradient id="g"><stop offset="0" stop-color="red"/><stop offset="1" stop-color="blue"/></linearGradient><rect width="9" height="9" fill="url(#g)"/></svg>"##;
        let error = to_pdf(gradient).unwrap_err().to_string();
        assert!(error.contains("gradient"), "{error}");
        assert!(matches!(to_pdf("no svg"), Err(ChartError::Svg(_))));
        // Outlines of the same chart are fine.
        assert!(to_pdf(&to_svg(&chart()).unwrap()).is_ok());
    }
}
