//! A finished picture: shapes in px, in the order in which they lie on one another, with what is said of them. SVG, PNG, PDF, EPS and
//! the part of a page are all written from it, so that none has to be read again.

use std::collections::BTreeSet;

use tiny_skia::{Path, Transform};

use super::layers::Counts;
use super::look::TEXT;
use super::notes::Notes;
use super::text::{Anchor, Line};
use super::{Color, Size};
use crate::figures::font::Typeface;

pub(super) const PROGRAM: &str = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));
/// Points of a page, of which an inch has 72.
pub(super) const POINTS_PER_MM: f64 = 72.0 / 25.4;
/// A px where no size on paper is asked for: CSS and SVG have 96 of them to an inch.
const PX_MM: f64 = 25.4 / 96.0;

/// A picture, which [`Chart::draw`](super::Chart::draw) or [`stack`](super::stack) made.
#[derive(Clone, Debug)]
pub struct Drawing {
    pub(super) size: Size,
    pub(super) paper: Option<Paper>,
    pub(super) title: String,
    pub(super) description: Option<String>,
    /// Which sweep it shows.
    pub(super) sweep_hash: Option<String>,
    /// For those whose letters are text, families as a style sheet names them.
    pub(super) families: String,
    pub(super) shapes: Vec<Shape>,
    /// Where (px) each chart begins, and how many of its shapes are of which layer, from back to front.
    pub(super) layers: Vec<(u32, Counts)>,
    pub(super) notes: Notes,
}

/// The size of a picture on paper, and the length of each px of its drawing there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paper {
    pub(super) width_mm: f64,
    pub(super) height_mm: f64,
    pub(super) px_mm: f64,
}

/// A path in px, which is the outline of a text if there is one.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) path: Path,
    pub(super) paint: Paint,
    pub(super) text: Option<Box<Text>>,
}

/// A label where it stands.
#[derive(Clone, Debug)]
pub(super) struct Text {
    pub(super) label: String,
    pub(super) line: Line,
    /// From the line to px.
    pub(super) placed: Transform,
    /// What of it is where (px), and its size (px).
    pub(super) anchor: Anchor,
    pub(super) at: (f64, f64),
    pub(super) size: f64,
}

/// How a path is painted; lengths are in px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    Fill {
        color: [u8; 3],
        opacity: f64,
        /// Edges are not smoothed.
        crisp: bool,
    },
    Stroke {
        color: [u8; 3],
        width: f64,
        round_ends: bool,
    },
}

impl Shape {
    pub(super) fn new(path: Path, paint: Paint) -> Self {
        Self {
            path,
            paint,
            text: None,
        }
    }

    /// A label at this place of its baseline, of this size; `None` for one without ink.
    pub(super) fn of_text(
        label: &str,
        typeface: &Typeface,
        (at, size, anchor): ((f64, f64), f64, Anchor),
    ) -> Option<Self> {
        let line = Line::of(label, typeface);
        let placed = line.placed(at, size, anchor);
        let path = line.outline(placed)?;
        let label = label.to_owned();
        let text = Text {
            label,
            line,
            placed,
            anchor,
            at,
            size,
        };
        Some(Self {
            text: Some(Box::new(text)),
            ..Self::new(path, Paint::fill(TEXT, 1.0))
        })
    }

    /// The same so far (px) down.
    pub(super) fn moved_down(self, px: f64) -> Option<Self> {
        let down = Transform::from_translate(0.0, px as f32);
        let text = self.text.map(|text| {
            Box::new(Text {
                placed: text.placed.post_concat(down),
                at: (text.at.0, text.at.1 + px),
                ..*text
            })
        });
        let path = self.path.transform(down)?;
        Some(Self { path, text, ..self })
    }
}

impl Paint {
    /// An area with smooth edges.
    pub(super) fn fill(color: Color, opacity: f64) -> Self {
        Self::Fill {
            color: color.rgb(),
            opacity,
            crisp: false,
        }
    }

    pub(super) fn color_mut(&mut self) -> &mut [u8; 3] {
        match self {
            Self::Fill { color, .. } | Self::Stroke { color, .. } => color,
        }
    }
}

impl Drawing {
    /// Characters that no font has, in whose places boxes are drawn.
    pub fn missing_letters(&self) -> BTreeSet<char> {
        let texts = self.shapes.iter().filter_map(|shape| shape.text.as_ref());
        texts.flat_map(|text| text.line.missing()).collect()
    }

    /// On paper the picture is so wide, each px of it `px_mm` long; so high as asked for, or as it was drawn.
    #[must_use]
    pub fn on_paper(mut self, width_mm: f64, height_mm: Option<f64>, px_mm: f64) -> Self {
        self.paper = Some(Paper {
            width_mm,
            height_mm: height_mm.unwrap_or(f64::from(self.size.height_px) * px_mm),
            px_mm,
        });
        self
    }

    /// The picture with a description, which screen readers read.
    #[must_use]
    pub fn described(mut self, description: impl Into<String>) -> Self {
        self.description = Some(description.into());
        self
    }

    /// The picture with the sweep it shows: `<metadata>` of an SVG, `tEXt` of a PNG, a comment in a PDF or EPS.
    #[must_use]
    pub fn stamped(mut self, sweep_hash: Option<&str>) -> Self {
        self.sweep_hash = sweep_hash.map(str::to_owned);
        self
    }

    /// The picture as a print in black and white shows it: each colour as the grey that is as light.
    #[must_use]
    pub fn in_grey(mut self) -> Self {
        for shape in &mut self.shapes {
            let color = shape.paint.color_mut();
            let [red, green, blue] = *color;
            *color = Color::Rgb(red, green, blue).in_grey().rgb();
        }
        self
    }

    /// The program and the sweep, where that is known.
    pub(super) fn stamp(&self) -> Option<String> {
        let hash = self.sweep_hash.as_ref()?;
        Some(format!("{PROGRAM}, sweep sha256 {hash}"))
    }

    /// Width and height: on paper, where they may be a part of a px longer than what is drawn.
    pub(super) fn extent(&self) -> Paper {
        let side = |px: u32| f64::from(px) * PX_MM;
        self.paper.unwrap_or(Paper {
            width_mm: side(self.size.width_px),
            height_mm: side(self.size.height_px),
            px_mm: PX_MM,
        })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::report::chart::{Axis, Chart, Series};

    /// A line, and a label of x with a subscript.
    pub(in crate::report::chart) fn drawn() -> Drawing {
        let chart = Chart::new(Axis::linear("a_T ω / rad·s⁻¹"), Axis::linear("y"));
        let line = Series::line([(0.0, 0.0), (1.0, 1.0)]);
        chart.series(line).size(481, 361).draw().unwrap()
    }

    #[test]
    fn every_form_says_which_sweep_it_shows() {
        let drawing = drawn().stamped(Some("abc"));
        let png = drawing.to_png(1.0).unwrap();
        let decoder = png::Decoder::new(std::io::Cursor::new(&png));
        let reader = decoder.read_info().unwrap();
        let texts = &reader.info().uncompressed_latin1_text;
        assert_eq!(texts[0].text, PROGRAM);
        assert_eq!(texts[1].text, "sweep sha256 abc");
        let pdf = String::from_utf8_lossy(&drawing.to_pdf().unwrap()).into_owned();
        let (head, end) = pdf.split_once("sweep sha256 abc\nstartxref\n").unwrap();
        assert!(head.contains("\n% contact-dma ") && end.trim_end().ends_with("%%EOF"));
        let eps = drawing.to_eps();
        assert!(eps.lines().nth(1).unwrap().ends_with(", sweep sha256 abc"));
        let (head, rest) = drawing
            .to_svg()
            .split_once("><metadata>contact-dma ")
            .map(|(head, rest)| (head.to_owned(), rest.to_owned()))
            .unwrap();
        assert!(!head.contains('>'));
        assert!(rest.contains("sweep sha256 abc</metadata>\n <title>"));
    }

    #[test]
    fn in_grey_no_shape_has_a_colour_and_all_are_as_light_as_before() {
        let light = |drawing: &Drawing| {
            let shapes = drawing.shapes.iter();
            let colors = shapes.map(|shape| *shape.paint.clone().color_mut());
            colors.collect::<Vec<_>>()
        };
        let (before, after) = (light(&drawn()), light(&drawn().in_grey()));
        for ([red, green, blue], grey) in before.into_iter().zip(after) {
            assert!(grey[0] == grey[1] && grey[1] == grey[2]);
            let luma = 0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue);
            assert!((f64::from(grey[0]) - luma).abs() <= 0.5);
        }
    }
}
