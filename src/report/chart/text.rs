//! The embedded font: loading it, measuring text set in it and laying it out.

use std::sync::{Arc, OnceLock};

use resvg::tiny_skia::{Path, PathBuilder};
use resvg::usvg::{self, Node, fontdb};

use super::ChartError;
use super::canvas::Anchor;

/// DejaVu Sans, whose licence lies beside it: it has ω, δ, τ, ′, superscripts and subscripts, and stays the same
/// whatever fonts a system has.
pub(super) static FONT: &[u8] = include_bytes!("../fonts/DejaVuSans.ttf");

pub(super) const FAMILY: &str = "DejaVu Sans";

/// Height of a capital or a figure, as a fraction of the text size.
pub(super) const CAPITAL_EM: f64 = 0.729;
/// Height above and depth below the baseline of what the labels are made of, as fractions of the text size.
pub(super) const ASCENT_EM: f64 = 0.80;
pub(super) const DESCENT_EM: f64 = 0.24;

/// From the upper edge of a text, by which it is placed, to its baseline.
pub(super) const HANG_EM: f64 = 0.76;

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

/// The width of a text at size 1, kerned as it will be drawn.
pub(super) fn width_em(text: &str) -> Result<f64, ChartError> {
    /// Large, so that rounding to the font's own units does not matter.
    const SIZE: f64 = 1000.0;
    let laid_out = laid_out(text, (0, 0), SIZE, Anchor::Start)?;
    Ok(laid_out.map_or(0.0, |text| f64::from(text.bounding_box().width()) / SIZE))
}

/// The size of a text of this width at size 1: this one, or less where the room (px) takes it.
pub(super) fn fitted_px(size: f64, width_em: f64, room: f64) -> f64 {
    match width_em * size > room {
        true => room / width_em,
        false => size,
    }
}

/// The text with its letters in their places: at this size, its upper edge at `y`, its start, middle or end at `x`, then turned
/// about this point. `None`: no letter has ink.
pub(super) fn laid_out(
    text: &str,
    (x, y): (i32, i32),
    size: f64,
    anchor: Anchor,
) -> Result<Option<Box<usvg::Text>>, ChartError> {
    let (anchor, degrees) = match anchor {
        Anchor::Start => ("start", 0),
        Anchor::Middle => ("middle", 0),
        Anchor::End => ("end", 0),
        Anchor::Upwards => ("middle", 270),
    };
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"><text x=\"{x}\" y=\"{y}\" dy=\"{HANG_EM}em\" \
         text-anchor=\"{anchor}\" font-size=\"{size}\" transform=\"rotate({degrees}, {x}, {y})\">{}</text></svg>",
        escaped(text)
    );
    let tree = usvg::Tree::from_str(&svg, &options())?;
    Ok(first_text(tree.root()))
}

fn first_text(group: &usvg::Group) -> Option<Box<usvg::Text>> {
    group.children().iter().find_map(|node| match node {
        Node::Text(text) => Some(text.clone()),
        Node::Group(group) => first_text(group),
        Node::Path(_) | Node::Image(_) => None,
    })
}

/// The letters as one path, before the text is turned.
pub(super) fn outline(text: &usvg::Text) -> Option<Path> {
    fn add(group: &usvg::Group, builder: &mut PathBuilder) {
        for node in group.children() {
            match node {
                Node::Path(path) => builder.push_path(path.data()),
                Node::Group(group) => add(group, builder),
                Node::Text(_) | Node::Image(_) => {}
            }
        }
    }
    let mut builder = PathBuilder::new();
    add(text.flattened(), &mut builder);
    builder.finish()
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
        let widths = ["0", "00", "⁻", ""].map(|text| width_em(text).unwrap());
        // The figure's advance in DejaVu Sans 2.37 is 1303 of 2048 units.
        assert!((widths[0] - 1303.0 / 2048.0).abs() < 1e-3, "{widths:?}");
        assert!((widths[1] - 2606.0 / 2048.0).abs() < 1e-3, "{widths:?}");
        assert!(widths[2] > 0.3, "{widths:?}");
        assert_eq!(widths[3], 0.0);
    }

    #[test]
    fn reserved_characters_are_measured_as_themselves() {
        let widths = ["a<b&c", "a", "<", "b", "&", "c"].map(|text| width_em(text).unwrap());
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
