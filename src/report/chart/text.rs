//! The embedded font: loading it and measuring text set in it.

use std::fmt::Write as _;
use std::sync::{Arc, OnceLock};

use resvg::usvg::{self, fontdb};

use super::ChartError;

/// DejaVu Sans, whose licence lies beside it: it has ω, δ, τ, ′, superscripts and subscripts, and stays the same
/// whatever fonts a system has.
pub(super) static FONT: &[u8] = include_bytes!("../fonts/DejaVuSans.ttf");

pub(super) const FAMILY: &str = "DejaVu Sans";

/// Height of a capital or a figure, as a fraction of the text size.
pub(super) const CAPITAL_EM: f64 = 0.729;
/// Height above and depth below the baseline of what the labels are made of, as fractions of the text size.
pub(super) const ASCENT_EM: f64 = 0.80;
pub(super) const DESCENT_EM: f64 = 0.24;

/// How SVG is read: with the embedded font and no other.
pub(super) fn options() -> usvg::Options<'static> {
    static FONTS: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    let fonts = FONTS.get_or_init(|| {
        let mut fonts = fontdb::Database::new();
        fonts.load_font_source(fontdb::Source::Binary(Arc::new(FONT)));
        Arc::new(fonts)
    });
    usvg::Options {
        font_family: FAMILY.to_owned(),
        fontdb: Arc::clone(fonts),
        ..usvg::Options::default()
    }
}

/// The widths of the texts at size 1, kerned as they will be drawn.
pub(super) fn widths_em<'a>(
    texts: impl IntoIterator<Item = &'a str>,
) -> Result<Vec<f64>, ChartError> {
    /// Large, so that rounding to the font's own units does not matter.
    const SIZE: f64 = 1000.0;
    let mut svg = String::from(r#"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9">"#);
    let mut widths = Vec::new();
    for text in texts {
        let place = widths.len();
        // Writing to a String does not fail.
        let _ = write!(
            svg,
            r#"<text id="{place}" y="0" font-size="{SIZE}">{}</text>"#,
            escaped(text)
        );
        widths.push(0.0);
    }
    svg.push_str("</svg>");
    let tree = usvg::Tree::from_str(&svg, &options())?;
    for node in tree.root().children() {
        let place = node.id().parse::<usize>().ok();
        if let Some(width) = place.and_then(|place| widths.get_mut(place)) {
            *width = f64::from(node.bounding_box().width()) / SIZE;
        }
    }
    Ok(widths)
}

/// The text with what XML reserves written as entities.
pub(super) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '&' => safe.push_str("&amp;"),
            '"' => safe.push_str("&quot;"),
            other => safe.push(other),
        }
    }
    safe
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

    #[test]
    fn widths_follow_the_metrics_of_the_font() {
        let widths = widths_em(["0", "00", "⁻", ""]).unwrap();
        // The figure's advance in DejaVu Sans 2.37 is 1303 of 2048 units.
        assert!((widths[0] - 1303.0 / 2048.0).abs() < 1e-3, "{widths:?}");
        assert!((widths[1] - 2606.0 / 2048.0).abs() < 1e-3, "{widths:?}");
        assert!(widths[2] > 0.3, "{widths:?}");
        assert_eq!(widths[3], 0.0);
    }

    #[test]
    fn reserved_characters_are_measured_as_themselves() {
        let widths = widths_em(["a<b&c", "a", "<", "b", "&", "c"]).unwrap();
        let apart: f64 = widths[1..].iter().sum();
        // Kerning between the letters moves them by less than a tenth of a letter.
        assert!((widths[0] - apart).abs() < 0.06, "{widths:?}");
    }

    #[test]
    fn the_font_has_every_character_the_figures_use() {
        // A character the font lacks comes out as its empty box, all of which have the same width.
        let used = "ωδτ⁻⁰¹²³⁴⁵⁶⁷⁸⁹₀₁₂₃″′°·×µ−η∞≈√πνσε∆";
        let outlines = |c: char| {
            let svg = format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><text y="5">{c}</text></svg>"#
            );
            let tree = usvg::Tree::from_str(&svg, &options()).unwrap();
            let written = tree.to_string(&usvg::WriteOptions::default());
            written.split(" d=\"").nth(1).map(str::to_owned)
        };
        let missing = outlines('\u{4E2D}');
        for c in used.chars() {
            assert!(outlines(c).is_some(), "{c} has no outline");
            assert_ne!(outlines(c), missing, "{c} is missing");
        }
    }
}
