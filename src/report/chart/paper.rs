//! A finished picture on paper: its size in millimetres, its resolution, and what it shows in words.

use super::ChartError;
use super::text::escaped;

/// CSS and SVG count so many px to an inch.
const PX_PER_INCH: f32 = 96.0;

/// The picture so wide, each px of its drawing `px_mm` long; so high as asked for, or as it was drawn.
///
/// # Errors
/// [`ChartError::Draw`] where the text is none of [`super::to_svg`] and its like.
pub fn on_paper(
    svg: &str,
    width_mm: f64,
    height_mm: Option<f64>,
    px_mm: f64,
) -> Result<String, ChartError> {
    let no_root = || ChartError::Draw {
        reason: "the picture has no size".to_owned(),
    };
    let (head, rest) = svg.split_once('>').ok_or_else(no_root)?;
    let attribute = |name: &str| {
        let opening = format!(" {name}=\"");
        let start = head.find(&opening)? + opening.len();
        let end = start + head.get(start..)?.find('"')?;
        Some((start - opening.len(), end + 1, head.get(start..end)?))
    };
    let (_, _, drawn_high) = attribute("height").ok_or_else(no_root)?;
    let drawn_high: f64 = drawn_high.parse().map_err(|_| no_root())?;
    let height_mm = height_mm.unwrap_or(drawn_high * px_mm);
    let mut cuts = Vec::new();
    for name in ["width", "height", "viewBox"] {
        let (from, to, _) = attribute(name).ok_or_else(no_root)?;
        cuts.push((from, to));
    }
    cuts.sort_unstable();
    let mut kept = String::new();
    let mut at = 0;
    for (from, to) in cuts {
        kept.push_str(head.get(at..from).unwrap_or_default());
        at = to;
    }
    kept.push_str(head.get(at..).unwrap_or_default());
    Ok(format!(
        "{kept} width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {} {}\">{rest}",
        rounded(width_mm),
        rounded(height_mm),
        rounded(width_mm / px_mm),
        rounded(height_mm / px_mm)
    ))
}

/// Four places are far below what can be printed.
fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// The picture with a description behind its title, which screen readers read.
pub fn described(svg: &str, description: &str) -> String {
    let description = escaped(description);
    svg.replacen(
        "</title>",
        &format!("</title>\n <desc>{description}</desc>"),
        1,
    )
}

/// The scale that gives so many pixels to an inch.
pub(super) fn scale(dpi: usize) -> f32 {
    dpi as f32 / PX_PER_INCH
}

/// Pixels per metre, which PNG counts in.
pub(super) fn pixels_per_metre(dpi: usize) -> u32 {
    (dpi as f64 / 0.0254).round() as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, Chart, Series, to_png_at, to_svg};

    fn drawn() -> String {
        let chart = Chart::new(Axis::linear("x"), Axis::linear("y"));
        let line = Series::line([(0.0, 0.0), (1.0, 1.0)]);
        to_svg(&chart.series(line).size(481, 361)).unwrap()
    }

    #[test]
    fn the_root_has_millimetres_and_the_drawing_its_px() {
        let svg = on_paper(&drawn(), 85.0, Some(63.75), 0.176_388_9).unwrap();
        let head = svg.split_once('>').unwrap().0;
        assert!(head.contains("width=\"85mm\" height=\"63.75mm\""), "{head}");
        assert!(head.contains("viewBox=\"0 0 481.8897 361.4173\""), "{head}");
        assert_eq!(head.matches("viewBox").count(), 1);
        assert_eq!(
            svg.split_once('>').unwrap().1,
            drawn().split_once('>').unwrap().1
        );
        // Without a height, as drawn: 361 px of 0.2 mm.
        let svg = on_paper(&drawn(), 96.2, None, 0.2).unwrap();
        assert!(svg.contains("height=\"72.2mm\""));
        assert!(on_paper("<svg></svg>", 85.0, None, 0.1).is_err());
    }

    #[test]
    fn a_png_has_the_pixels_of_its_millimetres_and_says_so() {
        let svg = on_paper(&drawn(), 85.0, Some(63.75), 0.176_388_9).unwrap();
        let png = to_png_at(&svg, 300).unwrap();
        let reader = png::Decoder::new(std::io::Cursor::new(&png))
            .read_info()
            .unwrap();
        let info = reader.info();
        // mm times dpi over 25.4: 1003.9 and 752.95.
        assert_eq!((info.width, info.height), (1004, 753));
        let size = info.pixel_dims.unwrap();
        assert_eq!((size.xppu, size.yppu), (11811, 11811));
    }

    #[test]
    fn a_description_follows_the_title() {
        let svg = described(&drawn(), "a < b");
        assert!(svg.contains("</title>\n <desc>a &lt; b</desc>"));
    }
}
