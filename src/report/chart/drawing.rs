//! A finished picture: shapes in the order in which they lie on one another, with what is said of them. SVG, PNG, PDF and the
//! part of a page are all written from it, so that none has to be read again.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use resvg::tiny_skia::{Path, PathSegment, Point};
use resvg::usvg;

use super::look::TEXT;
use super::text::{escaped, outline};
use super::{Color, Size};

/// Coordinates of shapes are in such parts of a px.
pub(super) const FINE: f64 = 16.0;
pub(super) const PROGRAM: &str = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));

/// A picture, which [`Chart::draw`](super::Chart::draw) or [`stack`](super::stack) made.
#[derive(Clone, Debug)]
pub struct Drawing {
    pub(super) size: Size,
    pub(super) paper: Option<Paper>,
    pub(super) title: String,
    pub(super) description: Option<String>,
    /// Which sweep it shows.
    pub(super) sweep_hash: Option<String>,
    /// The shapes of each chart, and how far (px) below the top of the picture it begins.
    pub(super) charts: Vec<(u32, Vec<Shape>)>,
}

/// The size of a picture on paper, and the length of each px of its drawing there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paper {
    pub(super) width_mm: f64,
    pub(super) height_mm: f64,
    pub(super) px_mm: f64,
}

/// A path in sixteenths of a px; a text has the text that its path outlines, which may be turned by quarters.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) path: Path,
    pub(super) paint: Paint,
    pub(super) text: Option<Box<usvg::Text>>,
}

/// How a path is painted; lengths are in sixteenths of a px.
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

    /// `None` for a text without ink.
    pub(super) fn of_text(text: Box<usvg::Text>) -> Option<Self> {
        Some(Self {
            path: outline(&text)?,
            paint: Paint::fill(TEXT, 1.0),
            text: Some(text),
        })
    }

    /// How a text is turned: by quarters, about a whole number of sixteenths, so that every entry is a whole number.
    pub(super) fn turned(&self) -> usvg::Transform {
        let turned = self.text.as_ref().map(|text| text.abs_transform());
        let t = turned.unwrap_or_default();
        let [sx, ky, kx, sy, tx, ty] = [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f32::round);
        usvg::Transform::from_row(sx, ky, kx, sy, tx, ty)
    }

    /// The path as SVG, with the attributes that its group cannot carry.
    fn svg(&self, steps: f32) -> String {
        let opacity = match self.paint {
            Paint::Fill { opacity, .. } if opacity != 1.0 => format!(" opacity=\"{opacity}\""),
            Paint::Fill { .. } | Paint::Stroke { .. } => String::new(),
        };
        let t = self.turned();
        let turned = match t.is_identity() {
            true => String::new(),
            false => {
                let (a, b, c, d, e, f) = (t.sx, t.ky, t.kx, t.sy, t.tx, t.ty);
                format!(" transform=\"matrix({a} {b} {c} {d} {e} {f})\"")
            }
        };
        format!("<path{opacity}{turned} d=\"{}\"/>", data(&self.path, steps))
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

    /// Attributes of SVG that a group may carry for many paths.
    fn attributes(&self) -> String {
        let hex = |[red, green, blue]: [u8; 3]| format!("#{red:02x}{green:02x}{blue:02x}");
        match *self {
            Self::Fill { color, crisp, .. } => {
                let edges = if crisp {
                    " shape-rendering=\"crispEdges\""
                } else {
                    ""
                };
                format!("fill=\"{}\"{edges}", hex(color))
            }
            Self::Stroke {
                color,
                width,
                round_ends,
            } => {
                let ends = if round_ends {
                    " stroke-linecap=\"round\""
                } else {
                    ""
                };
                format!(
                    "fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\"{ends}",
                    hex(color)
                )
            }
        }
    }
}

/// Steps per sixteenth of a px to which coordinates are written: in files far below what can be seen, on pages just below.
const FILE_STEPS: f32 = 100.0;
const PAGE_STEPS: f32 = 1.0;

impl Drawing {
    /// Characters that the font does not have, in whose places it draws boxes.
    pub fn missing_letters(&self) -> BTreeSet<char> {
        let shapes = self.charts.iter().flat_map(|(_, shapes)| shapes);
        let texts = shapes.filter_map(|shape| shape.text.as_ref());
        let spans = texts.flat_map(|text| text.layouted());
        let glyphs = spans.flat_map(|span| &span.positioned_glyphs);
        // The first glyph of every font stands for those that it lacks.
        let missing = glyphs.filter(|glyph| glyph.id.0 == 0);
        missing.flat_map(|glyph| glyph.text.chars()).collect()
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

    /// The picture with the sweep it shows: `<metadata>` of an SVG, `tEXt` of a PNG, a comment in a PDF.
    #[must_use]
    pub fn stamped(mut self, sweep_hash: Option<&str>) -> Self {
        self.sweep_hash = sweep_hash.map(str::to_owned);
        self
    }

    /// The picture as SVG that needs no font, since its letters are outlines, and refers to no other file.
    pub fn to_svg(&self) -> String {
        self.svg(" xmlns=\"http://www.w3.org/2000/svg\"", FILE_STEPS)
    }

    /// The picture as an element of an HTML page.
    pub fn to_page_element(&self) -> String {
        self.svg("", PAGE_STEPS)
    }

    fn svg(&self, namespace: &str, steps: f32) -> String {
        let mut svg = format!("<svg {}{namespace} role=\"img\">", self.dimensions());
        // Program, version and a hexadecimal hash: nothing that XML would have to escape.
        if let Some(hash) = &self.sweep_hash {
            svg += &format!("<metadata>{PROGRAM}, sweep sha256 {hash}</metadata>");
        }
        svg += &format!("\n <title>{}</title>", escaped(&self.title));
        if let Some(description) = &self.description {
            svg += &format!("\n <desc>{}</desc>", escaped(description));
        }
        for (top_px, shapes) in &self.charts {
            let scale = FINE.recip();
            svg += &format!(
                "\n<g transform=\"translate(0 {top_px}) scale({scale})\" stroke-linejoin=\"round\">\n"
            );
            for group in shapes.chunk_by(|a, b| a.paint == b.paint) {
                let attributes = group.first().map(|shape| shape.paint.attributes());
                let paths: String = group.iter().map(|shape| shape.svg(steps)).collect();
                svg += &format!("<g {}>{paths}</g>\n", attributes.unwrap_or_default());
            }
            svg += "</g>";
        }
        svg + "\n</svg>\n"
    }

    /// Width, height and view box.
    fn dimensions(&self) -> String {
        let Size {
            width_px,
            height_px,
        } = self.size;
        // Four places are far below what can be printed.
        let rounded = |value: f64| (value * 1e4).round() / 1e4;
        match &self.paper {
            None => format!(
                "width=\"{width_px}\" height=\"{height_px}\" viewBox=\"0 0 {width_px} {height_px}\""
            ),
            Some(paper) => format!(
                "width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {} {}\"",
                rounded(paper.width_mm),
                rounded(paper.height_mm),
                rounded(paper.width_mm / paper.px_mm),
                rounded(paper.height_mm / paper.px_mm)
            ),
        }
    }
}

/// Path data with coordinates relative to the point before, in steps of 1/`steps`.
fn data(path: &Path, steps: f32) -> String {
    let mut pen = Pen {
        text: String::new(),
        steps,
        at: [0; 2],
        last: ' ',
    };
    let mut start = [0; 2];
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(to) => {
                pen.go('m', &[to]);
                start = pen.at;
            }
            PathSegment::LineTo(to) => pen.go('l', &[to]),
            PathSegment::QuadTo(by, to) => pen.go('q', &[by, to]),
            PathSegment::CubicTo(a, b, to) => pen.go('c', &[a, b, to]),
            PathSegment::Close => {
                pen.go('z', &[]);
                pen.at = start;
            }
        }
    }
    pen.text
}

/// Path data being written.
struct Pen {
    text: String,
    steps: f32,
    at: [i64; 2],
    last: char,
}

impl Pen {
    fn go(&mut self, command: char, points: &[Point]) {
        // The same command again needs no letter; after a move it would be a line.
        if command != self.last || command == 'm' {
            self.text.push(command);
        }
        self.last = command;
        let step = |value: f32| (value * self.steps).round() as i64;
        let points: Vec<[i64; 2]> = points.iter().map(|to| [step(to.x), step(to.y)]).collect();
        for point in &points {
            for (to, from) in point.iter().zip(self.at) {
                self.number(to - from);
            }
        }
        self.at = points.last().copied().unwrap_or(self.at);
    }

    /// A number after what is there: a sign parts two numbers as a space does.
    fn number(&mut self, steps: i64) {
        if steps >= 0 && self.text.ends_with(|c: char| c.is_ascii_digit()) {
            self.text.push(' ');
        }
        // Writing to a String cannot fail.
        let _ = write!(self.text, "{}", steps as f64 / f64::from(self.steps));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, Chart, Series};
    use resvg::tiny_skia::PathBuilder;

    fn drawn() -> Drawing {
        let chart = Chart::new(Axis::linear("x"), Axis::linear("y"));
        let line = Series::line([(0.0, 0.0), (1.0, 1.0)]);
        chart.series(line).size(481, 361).draw().unwrap()
    }

    #[test]
    fn path_data_are_relative_and_rounded_to_steps() {
        let mut builder = PathBuilder::new();
        builder.move_to(10.0, 20.0);
        builder.line_to(10.4, 30.6);
        builder.line_to(12.0, 20.0);
        builder.close();
        builder.move_to(1.0, 1.0);
        builder.cubic_to(5.0, 5.0, 6.0, 6.0, 4.0, 4.0);
        let path = builder.finish().unwrap();
        assert_eq!(data(&path, 1.0), "m10 20l0 11 2-11zm-9-19c4 4 5 5 3 3");
        assert_eq!(
            data(&path, 100.0),
            "m10 20l0.4 10.6 1.6-10.6zm-9-19c4 4 5 5 3 3"
        );
    }

    #[test]
    fn the_root_has_millimetres_and_the_drawing_its_px() {
        let svg = drawn().on_paper(85.0, Some(63.75), 0.176_388_9).to_svg();
        let head = svg.split_once('>').unwrap().0;
        assert!(head.contains("width=\"85mm\" height=\"63.75mm\""), "{head}");
        assert!(head.contains("viewBox=\"0 0 481.8897 361.4173\""), "{head}");
        assert_eq!(head.matches("viewBox").count(), 1);
        assert_eq!(
            svg.split_once('>').unwrap().1,
            drawn().to_svg().split_once('>').unwrap().1
        );
        // Without a height, as drawn: 361 px of 0.2 mm.
        let svg = drawn().on_paper(96.2, None, 0.2).to_svg();
        assert!(svg.contains("height=\"72.2mm\""));
    }

    #[test]
    fn a_png_has_the_pixels_of_its_millimetres_and_says_so() {
        let drawing = drawn().on_paper(85.0, Some(63.75), 0.176_388_9);
        let png = drawing.to_png_at(300).unwrap();
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
    fn a_description_follows_the_title_and_metadata_come_first() {
        let svg = drawn().described("a < b").stamped(Some("abc")).to_svg();
        assert!(svg.contains("</title>\n <desc>a &lt; b</desc>"));
        let (head, rest) = svg.split_once("><metadata>contact-dma ").unwrap();
        assert!(!head.contains('>'));
        assert!(
            rest.split_once("sweep sha256 abc</metadata>\n <title>")
                .is_some()
        );
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
    }
}
