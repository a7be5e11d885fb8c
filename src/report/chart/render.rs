//! The picture as PNG, made from its SVG.
//!
//! Nothing depends on the machine: the only font is the embedded one, and the same chart gives the same bytes.

use std::sync::{Mutex, PoisonError};

use resvg::{tiny_skia, usvg};

use super::ChartError;
use super::drawing::{Drawing, PROGRAM};
use super::text::options;
use crate::figures::paper::MANY_PIXELS;

/// CSS and SVG count so many px to an inch.
const PX_PER_INCH: f32 = 96.0;
const LARGEST_PIXELS: u32 = 32_768;
const NO_PICTURE: &str = "the picture would have no pixel, or more than 32768 on a side";

/// Held while a picture of [`MANY_PIXELS`] is drawn.
static ONE_LARGE: Mutex<()> = Mutex::new(());

impl Drawing {
    /// The picture as PNG on white; at `scale` 1 one pixel per px, at 2 two in each direction.
    ///
    /// # Errors
    /// [`ChartError`] where the scale gives no picture.
    pub fn to_png(&self, scale: f32) -> Result<Vec<u8>, ChartError> {
        self.png(scale, None)
    }

    /// The picture as PNG on white, so many pixels to an inch of its size on paper, which the PNG says.
    ///
    /// # Errors
    /// As [`Drawing::to_png`].
    pub fn to_png_at(&self, dpi: usize) -> Result<Vec<u8>, ChartError> {
        let pixels_per_metre = (dpi as f64 / 0.0254).round() as u32;
        self.png(dpi as f32 / PX_PER_INCH, Some(pixels_per_metre))
    }

    fn png(&self, scale: f32, pixels_per_metre: Option<u32>) -> Result<Vec<u8>, ChartError> {
        let tree = usvg::Tree::from_str(&self.to_svg(), &options())?;
        let size = size_in_pixels(&tree, scale)?;
        let is_large = u64::from(size.0) * u64::from(size.1) > MANY_PIXELS;
        let _alone = is_large.then(|| ONE_LARGE.lock().unwrap_or_else(PoisonError::into_inner));
        let picture = pixels(&tree, size, scale)?;
        self.encode(picture, pixels_per_metre)
            .map_err(|error| ChartError::Encode {
                reason: error.to_string(),
            })
    }

    /// The pixels as PNG without transparency: the picture stands on white. Fast compression takes a tenth of the time of the
    /// thorough one, which used to be most of the time of a whole sweep.
    fn encode(
        &self,
        picture: tiny_skia::Pixmap,
        pixels_per_metre: Option<u32>,
    ) -> Result<Vec<u8>, png::EncodingError> {
        let (width, height) = (picture.width(), picture.height());
        let mut opaque = vec![0; picture.pixels().len() * 3];
        let pixels = picture.data().as_chunks::<4>().0;
        for (rgb, rgba) in opaque.as_chunks_mut::<3>().0.iter_mut().zip(pixels) {
            *rgb = [rgba[0], rgba[1], rgba[2]];
        }
        // The encoder takes as much again.
        drop(picture);
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        encoder.set_pixel_dims(pixels_per_metre.map(|count| png::PixelDimensions {
            xppu: count,
            yppu: count,
            unit: png::Unit::Meter,
        }));
        if let Some(hash) = &self.sweep_hash {
            encoder.add_text_chunk("Software".to_owned(), PROGRAM.to_owned())?;
            encoder.add_text_chunk("Source".to_owned(), format!("sweep sha256 {hash}"))?;
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&opaque)?;
        writer.finish()?;
        Ok(bytes)
    }
}

/// Width and height.
fn size_in_pixels(tree: &usvg::Tree, scale: f32) -> Result<(u32, u32), ChartError> {
    let refused = |reason| ChartError::PixelScale { scale, reason };
    if !(scale.is_finite() && scale > 0.0) {
        return Err(refused("give a finite number above zero, such as 1 or 2"));
    }
    let pixels = |length: f32| (length * scale).round() as u32;
    let size = (pixels(tree.size().width()), pixels(tree.size().height()));
    match size.0.max(size.1) <= LARGEST_PIXELS {
        true => Ok(size),
        false => Err(refused(NO_PICTURE)),
    }
}

fn pixels(
    tree: &usvg::Tree,
    (width, height): (u32, u32),
    scale: f32,
) -> Result<tiny_skia::Pixmap, ChartError> {
    let mut picture = tiny_skia::Pixmap::new(width, height).ok_or(ChartError::PixelScale {
        scale,
        reason: NO_PICTURE,
    })?;
    picture.fill(tiny_skia::Color::WHITE);
    // The picture fills its whole pixels even where the scale does not give a whole number.
    let size = tree.size();
    let stretch = tiny_skia::Transform::from_scale(
        width as f32 / size.width(),
        height as f32 / size.height(),
    );
    resvg::render(tree, stretch, &mut picture.as_mut());
    Ok(picture)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, Chart, LegendPlace, LineStyle, Mark, Marker, Series};

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
            .series(Series::line([(-3.0, -5.0), (5.0, 9.0)]).area_to(0.0))
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
            let svg = chart.draw().unwrap().to_svg();
            for unwanted in ["<text", "font-family", "href", "url(", "<image", "@import"] {
                assert!(!svg.contains(unwanted), "{unwanted}");
            }
            // The only address is the name of the format.
            assert_eq!(svg.matches("http").count(), 1);
        }
    }

    #[test]
    fn svg_has_the_real_size_a_view_box_and_a_title() {
        let svg = chart().draw().unwrap().to_svg();
        assert!(svg.starts_with(r#"<svg width="800" height="600""#));
        assert!(svg.contains(r#"viewBox="0 0 800 600""#));
        assert!(svg.contains("<title>loss W / µJ against angular frequency ω / rad·s⁻¹</title>"));
    }

    #[test]
    fn the_same_chart_gives_the_same_bytes() {
        let (first, second) = (everything().draw().unwrap(), everything().draw().unwrap());
        assert_eq!(first.to_svg(), second.to_svg());
        assert!(first.to_png(1.0).unwrap() == second.to_png(1.0).unwrap());
    }

    #[test]
    fn png_dimensions_are_exact() {
        let drawing = chart().size(801, 599).draw().unwrap();
        assert_eq!(dimensions(&drawing.to_png(1.0).unwrap()), (801, 599));
        assert_eq!(dimensions(&drawing.to_png(2.0).unwrap()), (1602, 1198));
    }

    #[test]
    fn impossible_scales_are_refused() {
        let drawing = chart().draw().unwrap();
        for scale in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-6, 1e6] {
            assert!(
                matches!(drawing.to_png(scale), Err(ChartError::PixelScale { .. })),
                "{scale}"
            );
        }
    }

    #[test]
    fn reserved_and_unicode_characters_are_drawn_as_outlines() {
        let titled = |title: &str| chart().title(title).draw().unwrap().to_svg();
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
        unwieldy.marks[0].label.clone_from(&long);
        unwieldy.series[0].label = Some(long);
        let above = unwieldy.clone().legend(LegendPlace::Above);
        for chart in [
            chart(),
            everything(),
            unwieldy,
            above,
            everything().legend(LegendPlace::Right),
        ] {
            let svg = chart.draw().unwrap().to_svg();
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
                let svg = Chart::new(x, y)
                    .series(series.clone())
                    .draw()
                    .unwrap()
                    .to_svg();
                let [red, green, blue] = series.color.rgb();
                assert!(svg.contains(&format!("#{red:02x}{green:02x}{blue:02x}")));
            }
        }
    }
}
