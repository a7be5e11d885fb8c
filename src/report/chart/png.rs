//! The picture as PNG. The same chart gives the same bytes on every machine.

use std::sync::{Mutex, PoisonError};

use tiny_skia::{FillRule, LineCap, LineJoin, Paint as Brush, Pixmap, Stroke, Transform};

use super::ChartError;
use super::drawing::{Drawing, PROGRAM, Paint, Shape};
use crate::figures::paper::MANY_PIXELS;

/// Pixels per mm at scale 1, 96 to an inch.
const PIXELS_PER_MM: f64 = 96.0 / 25.4;
const LARGEST_PIXELS: f64 = 32_768.0;
const NO_PICTURE: &str = "the picture would have no pixel, or more than 32768 on a side";

/// Held while a picture of [`MANY_PIXELS`] is drawn.
static ONE_LARGE: Mutex<()> = Mutex::new(());

impl Drawing {
    /// The picture as PNG on white; at `scale` 1 one pixel per px, at 2 two in each direction.
    ///
    /// # Errors
    /// [`ChartError`] where the scale gives no picture.
    pub fn to_png(&self, scale: f32) -> Result<Vec<u8>, ChartError> {
        self.png(f64::from(scale), None)
    }

    /// The picture as PNG on white, so many pixels to an inch of its size on paper, which the PNG says.
    ///
    /// # Errors
    /// As [`Drawing::to_png`].
    pub fn to_png_at(&self, dpi: usize) -> Result<Vec<u8>, ChartError> {
        let pixels_per_metre = (dpi as f64 / 0.0254).round() as u32;
        self.png(dpi as f64 / 96.0, Some(pixels_per_metre))
    }

    fn png(&self, scale: f64, pixels_per_metre: Option<u32>) -> Result<Vec<u8>, ChartError> {
        let (width, height) = self.size_in_pixels(scale)?;
        let is_large = u64::from(width) * u64::from(height) > MANY_PIXELS;
        // Until it is encoded, which takes as much memory again.
        let _alone = is_large.then(|| ONE_LARGE.lock().unwrap_or_else(PoisonError::into_inner));
        let refused = || at_scale(scale, NO_PICTURE);
        let pixmap = Pixmap::new(width, height).ok_or_else(refused)?;
        self.encode(self.painted(pixmap), pixels_per_metre)
            .map_err(|error| ChartError::internal("write the PNG of", error))
    }

    /// Width and height.
    fn size_in_pixels(&self, scale: f64) -> Result<(u32, u32), ChartError> {
        let refused = |reason| at_scale(scale, reason);
        if !(scale.is_finite() && scale > 0.0) {
            return Err(refused("give a finite number above zero, such as 1 or 2"));
        }
        let extent = self.extent();
        let sides = [extent.width_mm, extent.height_mm];
        let [width, height] = sides.map(|mm| (mm * PIXELS_PER_MM * scale).round());
        match width.max(height) <= LARGEST_PIXELS {
            true => Ok((width as u32, height as u32)),
            false => Err(refused(NO_PICTURE)),
        }
    }

    /// Every shape in pixels, on white.
    fn painted(&self, mut pixmap: Pixmap) -> Pixmap {
        pixmap.fill(tiny_skia::Color::WHITE);
        // The picture fills its whole pixels even where the scale does not give a whole number.
        let extent = self.extent();
        let (width, height) = (f64::from(pixmap.width()), f64::from(pixmap.height()));
        let stretch = Transform::from_scale(
            (width * extent.px_mm / extent.width_mm) as f32,
            (height * extent.px_mm / extent.height_mm) as f32,
        );
        for shape in &self.shapes {
            paint(shape, stretch, &mut pixmap);
        }
        pixmap
    }

    /// The pixels as PNG without transparency: the picture stands on white. Fast compression takes a tenth of the time of the
    /// thorough one, which used to be most of the time of a whole sweep.
    fn encode(
        &self,
        picture: Pixmap,
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

/// Paints one shape over those before it.
fn paint(shape: &Shape, stretch: Transform, pixmap: &mut Pixmap) {
    let brush = |[red, green, blue]: [u8; 3], opacity: f64, anti_alias| {
        let mut brush = Brush {
            anti_alias,
            ..Brush::default()
        };
        brush.set_color_rgba8(red, green, blue, (255.0 * opacity).round() as u8);
        brush
    };
    match shape.paint {
        Paint::Fill {
            color,
            opacity,
            crisp,
        } => {
            let brush = brush(color, opacity, !crisp);
            pixmap.fill_path(&shape.path, &brush, FillRule::Winding, stretch, None);
        }
        Paint::Stroke {
            color,
            width,
            round_ends,
        } => {
            let stroke = Stroke {
                width: width as f32,
                line_cap: match round_ends {
                    true => LineCap::Round,
                    false => LineCap::Butt,
                },
                line_join: LineJoin::Round,
                ..Stroke::default()
            };
            let brush = brush(color, 1.0, true);
            pixmap.stroke_path(&shape.path, &brush, &stroke, stretch, None);
        }
    }
}

fn at_scale(scale: f64, reason: &str) -> ChartError {
    ChartError::item(format!("pixels at scale {scale}"), reason)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, Chart, LegendPlace, LineStyle, Mark, Marker, Series};
    use resvg::usvg;

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

    fn tree(svg: &str) -> usvg::Tree {
        let mut options = usvg::Options::default();
        let font = include_bytes!("../fonts/DejaVuSans.ttf");
        options.fontdb_mut().load_font_data(font.to_vec());
        usvg::Tree::from_str(svg, &options).unwrap()
    }

    /// An independent program draws the SVG as we draw the shapes, with letters as outlines and as text.
    #[test]
    fn svg_and_png_show_the_same_picture() {
        let drawing = everything().title("ΔW_A against a_{T}ω").draw().unwrap();
        let (width, height) = drawing.size_in_pixels(2.0).unwrap();
        let own = drawing.painted(Pixmap::new(width, height).unwrap());
        for (svg, mean, ink) in [
            (drawing.to_svg(), 0.05, 0.002),
            (drawing.to_svg_with_text(), 0.2, 0.01),
        ] {
            let mut other = Pixmap::new(own.width(), own.height()).unwrap();
            other.fill(tiny_skia::Color::WHITE);
            resvg::render(
                &tree(&svg),
                Transform::from_scale(2.0, 2.0),
                &mut other.as_mut(),
            );
            let apart = own.data().iter().zip(other.data());
            let apart: Vec<u8> = apart.map(|(own, other)| own.abs_diff(*other)).collect();
            let count = apart.len() as f64;
            let mean_apart = apart.iter().map(|&v| f64::from(v)).sum::<f64>() / count;
            let seen = apart.iter().filter(|&&v| v > 32).count() as f64 / count;
            assert!(mean_apart < mean && seen < ink, "{mean_apart} {seen}");
        }
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
                matches!(drawing.to_png(scale), Err(ChartError::Item { .. })),
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
            let ink = tree(&chart.draw().unwrap().to_svg())
                .root()
                .abs_stroke_bounding_box();
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
