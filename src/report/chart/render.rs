//! The finished picture: SVG whose text is outlines, and PNG made from that SVG.
//!
//! Nothing depends on the machine: the only font is the embedded one, and the same chart gives the same bytes.

use resvg::{tiny_skia, usvg};

use super::check::subject;
use super::draw::draw;
use super::paper;
use super::text::{escaped, options};
use super::{Chart, ChartError, Size};

/// The chart as SVG that needs no font and refers to no other file.
///
/// # Errors
/// [`ChartError`] where the chart has no point, or a value, text or range that cannot be drawn.
pub fn to_svg(chart: &Chart) -> Result<String, ChartError> {
    to_svg_with(chart, Letters::Outlines)
}

/// What the letters of a picture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Letters {
    /// Shapes: the picture looks the same everywhere.
    Outlines,
    /// Text in the embedded font, on its way into a file that brings the font along.
    Text,
}

/// The chart as SVG with its letters as outlines or as text.
///
/// # Errors
/// As [`to_svg`].
pub fn to_svg_with(chart: &Chart, letters: Letters) -> Result<String, ChartError> {
    finished(&draw(chart, 0.0)?, chart.size, &subject(chart), letters)
}

/// A drawing of this size under a title.
pub(super) fn finished(
    drawn: &str,
    size: Size,
    title: &str,
    letters: Letters,
) -> Result<String, ChartError> {
    let tree = usvg::Tree::from_str(drawn, &options())?;
    let written = tree.to_string(&usvg::WriteOptions {
        preserve_text: letters == Letters::Text,
        // Coordinates are in sixteenths of a px: two places are far below what can be seen.
        coordinates_precision: 2,
        indent: usvg::Indent::Spaces(1),
        ..usvg::WriteOptions::default()
    });
    headed(&written, size, title)
}

/// The SVG from [`to_svg`] as PNG on white; at `scale` 1 one pixel per px, at 2 two in each direction.
///
/// # Errors
/// [`ChartError`] where the text is no SVG or the scale gives no picture.
pub fn to_png(svg: &str, scale: f32) -> Result<Vec<u8>, ChartError> {
    png(svg, scale, None)
}

/// The SVG as PNG on white, so many pixels to an inch of its size on paper, which the PNG says.
///
/// # Errors
/// As [`to_png`].
pub fn to_png_at(svg: &str, dpi: usize) -> Result<Vec<u8>, ChartError> {
    png(svg, paper::scale(dpi), Some(paper::pixels_per_metre(dpi)))
}

fn png(svg: &str, scale: f32, pixels_per_metre: Option<u32>) -> Result<Vec<u8>, ChartError> {
    if !(scale.is_finite() && scale > 0.0) {
        return Err(ChartError::PixelScale {
            scale,
            reason: "give a finite number above zero, such as 1 or 2",
        });
    }
    let tree = usvg::Tree::from_str(svg, &options())?;
    let size = tree.size();
    let pixels = |length: f32| (length * scale).round() as u32;
    let (width, height) = (pixels(size.width()), pixels(size.height()));
    let mut picture = Some((width, height))
        .filter(|(width, height)| *width.max(height) <= LARGEST_PIXELS)
        .and_then(|(width, height)| tiny_skia::Pixmap::new(width, height))
        .ok_or(ChartError::PixelScale {
            scale,
            reason: "the picture would have no pixel, or more than 32768 on a side",
        })?;
    picture.fill(tiny_skia::Color::WHITE);
    // The picture fills its whole pixels even where the scale does not give a whole number.
    let stretch = tiny_skia::Transform::from_scale(
        width as f32 / size.width(),
        height as f32 / size.height(),
    );
    resvg::render(&tree, stretch, &mut picture.as_mut());
    encode(&picture, pixels_per_metre).map_err(|error| ChartError::Encode {
        reason: error.to_string(),
    })
}

/// The pixels as PNG without transparency: the picture stands on white. Fast compression takes a tenth of the time of the
/// thorough one, which used to be most of the time of a whole sweep.
fn encode(
    picture: &tiny_skia::Pixmap,
    pixels_per_metre: Option<u32>,
) -> Result<Vec<u8>, png::EncodingError> {
    let opaque: Vec<u8> = picture
        .pixels()
        .iter()
        .flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()])
        .collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_pixel_dims(pixels_per_metre.map(|count| png::PixelDimensions {
        xppu: count,
        yppu: count,
        unit: png::Unit::Meter,
    }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&opaque)?;
    writer.finish()?;
    Ok(bytes)
}

const LARGEST_PIXELS: u32 = 32_768;

/// Puts into the root what usvg leaves out: the view box, so that a page can scale the picture, and a title, which
/// browsers show and screen readers read.
fn headed(written: &str, size: Size, title: &str) -> Result<String, ChartError> {
    let body = written
        .strip_prefix("<svg ")
        .and_then(|rest| rest.split_once('>'))
        .ok_or_else(|| ChartError::Draw {
            reason: "usvg wrote no <svg> element".to_owned(),
        })?;
    let (attributes, content) = body;
    let view_box = format!(
        "viewBox=\"0 0 {} {}\" role=\"img\"",
        size.width_px, size.height_px
    );
    Ok(format!(
        "<svg {attributes} {view_box}>\n <title>{}</title>{content}",
        escaped(title)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, LegendPlace, LineStyle, Mark, Marker, Series};

    fn chart() -> Chart {
        let points = (0..41).map(|k| {
            let decade = -4.0 + 0.1 * f64::from(k);
            (10f64.powf(decade), 3.4 * (-(decade + 2.0).powi(2)).exp())
        });
        Chart::new(
            Axis::log("angular frequency ω / rad·s⁻¹"),
            Axis::linear("loss W / µJ"),
        )
        .series(
            Series::line(points)
                .marker(Marker::Disc)
                .label("PMMA, a < b & c"),
        )
        .mark(Mark::point(1e-2, 3.4, "ω = 10⁻² rad/s"))
    }

    /// Every kind of thing a chart may hold, at once.
    fn everything() -> Chart {
        let styles = (0..6).map(|k| {
            let points =
                (0..9).map(move |i| (i != 4).then(|| (f64::from(i) - 3.0, f64::from(i * (k + 1)))));
            Series::line(points)
                .style(LineStyle::nth(k as usize))
                .marker(Marker::nth(k as usize))
                .color(k as usize)
                .error_bars(vec![1.0; 9])
                .label(format!("series {k}"))
        });
        Chart::new(Axis::linear("approach δ / µm"), Axis::linear("load P / N"))
            .title("Title")
            .all_series(styles)
            .series(Series::line([(-3.0, -5.0), (5.0, 9.0)]).fill_to(0.0))
            .mark(Mark::vertical(4.9, "x₀ ≈ 4.9"))
            .mark(Mark::horizontal(53.0, "limit"))
            .mark(Mark::point(-3.0, 0.0, "start"))
    }

    fn dimensions(png: &[u8]) -> (u32, u32) {
        let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
        (number(16), number(20))
    }

    #[test]
    fn svg_has_no_text_and_refers_to_nothing_outside() {
        for chart in [chart(), everything()] {
            let svg = to_svg(&chart).unwrap();
            for unwanted in ["<text", "font-family", "href", "url(", "<image", "@import"] {
                assert!(!svg.contains(unwanted), "{unwanted}");
            }
            // The only address is the name of the format.
            assert_eq!(svg.matches("http").count(), 1);
        }
    }

    #[test]
    fn svg_has_the_real_size_a_view_box_and_a_title() {
        let svg = to_svg(&chart()).unwrap();
        assert!(svg.starts_with(r#"<svg width="800" height="600""#));
        assert!(svg.contains(r#"viewBox="0 0 800 600""#));
        assert!(svg.contains("<title>loss W / µJ against angular frequency ω / rad·s⁻¹</title>"));
    }

    #[test]
    fn the_same_chart_gives_the_same_bytes() {
        let (first, second) = (
            to_svg(&everything()).unwrap(),
            to_svg(&everything()).unwrap(),
        );
        assert_eq!(first, second);
        assert!(to_png(&first, 1.0).unwrap() == to_png(&second, 1.0).unwrap());
    }

    #[test]
    fn png_dimensions_are_exact() {
        let svg = to_svg(&chart().size(801, 599)).unwrap();
        assert_eq!(dimensions(&to_png(&svg, 1.0).unwrap()), (801, 599));
        assert_eq!(dimensions(&to_png(&svg, 2.0).unwrap()), (1602, 1198));
    }

    #[test]
    fn impossible_scales_are_refused() {
        let svg = to_svg(&chart()).unwrap();
        for scale in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-6, 1e6] {
            assert!(
                matches!(to_png(&svg, scale), Err(ChartError::PixelScale { .. })),
                "{scale}"
            );
        }
        assert!(matches!(to_png("no svg", 1.0), Err(ChartError::Svg(_))));
    }

    #[test]
    fn reserved_and_unicode_characters_are_drawn_as_outlines() {
        let titled = |title: &str| to_svg(&chart().title(title)).unwrap();
        let svg = titled("E′ < 5 & \"σ\" > 'τ'");
        assert!(svg.contains("<title>E′ &lt; 5 &amp; &quot;σ&quot; &gt; 'τ'</title>"));
        // The outline of every one of them adds to the picture.
        let length = |title: &str| titled(title).split("</title>").nth(1).unwrap().len();
        for c in ["<", "&", "σ", "′", "⁻"] {
            assert!(length(&format!("a{c}")) > length("a"), "{c}");
        }
    }

    #[test]
    fn no_ink_leaves_the_picture() {
        let long =
            "a label far too long for a chart of this size, which must not be cut off at its edge "
                .repeat(2);
        let mut unwieldy = chart().title(long.clone()).size(500, 400);
        unwieldy.y.label.clone_from(&long);
        unwieldy.x.label.clone_from(&long);
        unwieldy.marks[0].label = Some(long.clone());
        unwieldy.series[0].label = Some(long);
        let above = unwieldy.clone().legend(LegendPlace::Above);
        for chart in [
            chart(),
            everything(),
            unwieldy,
            above,
            everything().legend(LegendPlace::Right),
        ] {
            let svg = to_svg(&chart).unwrap();
            let tree = usvg::Tree::from_str(&svg, &options()).unwrap();
            let ink = tree.root().abs_stroke_bounding_box();
            let (width, height) = (chart.size.width_px as f32, chart.size.height_px as f32);
            assert!(ink.left() >= 0.0 && ink.top() >= 0.0, "{ink:?}");
            assert!(ink.right() <= width && ink.bottom() <= height, "{ink:?}");
        }
    }

    #[test]
    fn a_single_point_is_visible() {
        for series in [Series::line([(2.0, 3.0)]), Series::scatter([(2.0, 3.0)])] {
            for (x, y) in [
                (Axis::linear("x"), Axis::linear("y")),
                (Axis::log("x"), Axis::log("y")),
            ] {
                let svg = to_svg(&Chart::new(x, y).series(series.clone())).unwrap();
                let [red, green, blue] = series.color.rgb();
                assert!(svg.contains(&format!("#{red:02x}{green:02x}{blue:02x}")));
            }
        }
    }
}
