//! The picture as SVG, a file or an element of a page.

use std::fmt::Write as _;

use tiny_skia::{Path, PathSegment, Point};

use super::drawing::{Drawing, Paint, Shape, Text};
use super::text::{Anchor, parts};

/// How numbers are written: how many units a px is, and how many steps a unit has.
#[derive(Clone, Copy)]
struct Steps {
    per_px: f64,
    per_unit: f64,
}

/// In files to a hundredth of a px, far below what can be seen; on pages in whole sixteenths of a px, just below.
const OF_FILE: Steps = Steps {
    per_px: 1.0,
    per_unit: 100.0,
};
const OF_PAGE: Steps = Steps {
    per_px: 16.0,
    per_unit: 1.0,
};

impl Drawing {
    /// The picture as SVG that needs no font, since its letters are outlines, and refers to no other file.
    pub fn to_svg(&self) -> String {
        self.svg(XMLNS, OF_FILE, false)
    }

    /// The same with letters as text, which can be edited, and which is shown in the typeface where that is there.
    pub fn to_svg_with_text(&self) -> String {
        self.svg(XMLNS, OF_FILE, true)
    }

    /// The picture as an element of an HTML page.
    pub fn to_page_element(&self) -> String {
        self.svg("", OF_PAGE, false)
    }

    fn svg(&self, namespace: &str, steps: Steps, has_text: bool) -> String {
        let mut svg = format!("<svg {}{namespace} role=\"img\">", self.dimensions(steps));
        // Program, version and a hexadecimal hash: nothing that XML would have to escape.
        if let Some(stamp) = self.stamp() {
            svg += &format!("<metadata>{stamp}</metadata>");
        }
        svg += &format!("\n <title>{}</title>", escaped(&self.title));
        if let Some(description) = &self.description {
            svg += &format!("\n <desc>{}</desc>", escaped(description));
        }
        let families = match has_text {
            true => format!(" font-family=\"{}\"", self.families),
            false => String::new(),
        };
        svg += &format!("\n<g stroke-linejoin=\"round\"{families}>\n");
        for group in self.shapes.chunk_by(|a, b| a.paint == b.paint) {
            let attributes = group.first().map(|shape| attributes(&shape.paint, steps));
            let one = |shape: &Shape| match &shape.text {
                Some(text) if has_text => of_text(text),
                _ => of_path(shape, steps),
            };
            let shapes: String = group.iter().map(one).collect();
            svg += &format!("<g {}>{shapes}</g>\n", attributes.unwrap_or_default());
        }
        svg + "</g>\n</svg>\n"
    }

    /// Width, height and view box.
    fn dimensions(&self, steps: Steps) -> String {
        let extent = self.extent();
        let unit = |mm: f64| rounded(mm / extent.px_mm * steps.per_px);
        let view = format!("0 0 {} {}", unit(extent.width_mm), unit(extent.height_mm));
        let (width, height) = match self.paper {
            None => (
                self.size.width_px.to_string(),
                self.size.height_px.to_string(),
            ),
            Some(paper) => (
                format!("{}mm", rounded(paper.width_mm)),
                format!("{}mm", rounded(paper.height_mm)),
            ),
        };
        format!("width=\"{width}\" height=\"{height}\" viewBox=\"{view}\"")
    }
}

const XMLNS: &str = " xmlns=\"http://www.w3.org/2000/svg\"";

/// Four places are far below what can be printed.
fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// Attributes that a group carries for many paths.
fn attributes(paint: &Paint, steps: Steps) -> String {
    let hex = |[red, green, blue]: [u8; 3]| format!("#{red:02x}{green:02x}{blue:02x}");
    match *paint {
        Paint::Fill { color, crisp, .. } => {
            let edges = match crisp {
                true => " shape-rendering=\"crispEdges\"",
                false => "",
            };
            format!("fill=\"{}\"{edges}", hex(color))
        }
        Paint::Stroke {
            color,
            width,
            round_ends,
        } => {
            let ends = match round_ends {
                true => " stroke-linecap=\"round\"",
                false => "",
            };
            let width = rounded(width * steps.per_px);
            let color = hex(color);
            format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\"{ends}")
        }
    }
}

/// A path with the attribute that its group cannot carry: shapes of one group that overlap would show through one another.
fn of_path(shape: &Shape, steps: Steps) -> String {
    let opacity = match shape.paint {
        Paint::Fill { opacity, .. } if opacity != 1.0 => format!(" opacity=\"{opacity}\""),
        Paint::Fill { .. } | Paint::Stroke { .. } => String::new(),
    };
    format!("<path{opacity} d=\"{}\"/>", data(&shape.path, steps))
}

/// A label as text, its subscripts smaller and lower.
fn of_text(text: &Text) -> String {
    let (x, y) = (rounded(text.at.0), rounded(text.at.1));
    let (anchor, turned) = match text.anchor {
        Anchor::Start => ("start", String::new()),
        Anchor::Middle => ("middle", String::new()),
        Anchor::End => ("end", String::new()),
        Anchor::Upwards => ("middle", format!(" transform=\"rotate(-90 {x} {y})\"")),
    };
    let mut spans = String::new();
    let mut dropped = 0.0;
    for part in parts(&text.label) {
        let (size, drop) = part.size_and_drop_em();
        let (size, drop) = (f64::from(size) * text.size, f64::from(drop) * text.size);
        let (down, size, inner) = (rounded(drop - dropped), rounded(size), escaped(&part.text));
        spans += &match down == 0.0 {
            true => inner,
            false => format!("<tspan dy=\"{down}\" font-size=\"{size}\">{inner}</tspan>"),
        };
        dropped = drop;
    }
    let size = rounded(text.size);
    format!(
        "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\"{turned}>{spans}</text>"
    )
}

/// Path data with coordinates relative to the point before, in whole steps.
fn data(path: &Path, steps: Steps) -> String {
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
    steps: Steps,
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
        let per_px = self.steps.per_px * self.steps.per_unit;
        let step = |value: f32| (f64::from(value) * per_px).round() as i64;
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
        let _ = write!(self.text, "{}", steps as f64 / self.steps.per_unit);
    }
}

/// The text with what XML reserves written as entities.
fn escaped(text: &str) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::drawing::tests::drawn;
    use tiny_skia::PathBuilder;

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
        assert_eq!(
            data(&path, OF_FILE),
            "m10 20l0.4 10.6 1.6-10.6zm-9-19c4 4 5 5 3 3"
        );
        assert_eq!(
            data(&path, OF_PAGE),
            "m160 320l6 170 26-170zm-144-304c64 64 80 80 48 48"
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
    fn a_description_follows_the_title_and_both_are_plain_text() {
        let svg = drawn().described("a < b").to_svg();
        assert!(svg.contains("<title>y against a_T ω / rad·s⁻¹</title>\n <desc>a &lt; b</desc>"));
    }

    #[test]
    fn letters_are_text_where_that_is_asked_for_and_subscripts_are_lowered() {
        let svg = drawn().to_svg_with_text();
        assert!(svg.contains("font-family=\"'DejaVu Sans', Verdana, sans-serif\""));
        let label = ">a<tspan dy=\"2.88\" font-size=\"12.6\">T</tspan><tspan dy=\"-2.88\" font-size=\"18\"> ω / rad·s⁻¹</tspan></text>";
        assert!(svg.contains(label), "{svg}");
        assert!(svg.contains("transform=\"rotate(-90 "));
    }
}
