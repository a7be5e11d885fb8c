//! The picture as EPS for journals: PostScript of level 3, letters as outlines. PostScript knows no transparency: tints are mixed with the
//! white of the paper.

use std::fmt::Write as _;
use std::slice;

use tiny_skia::{Path, PathSegment, Point};

use super::drawing::{Drawing, POINTS_PER_MM, PROGRAM, Paint, Shape};

/// Short names of operators; coordinates are in px from the upper left corner, as the matrix that `setup` sets has them.
const PROLOG: &str = "/m{moveto}bind def/l{lineto}bind def/c{curveto}bind def/h{closepath}bind def\n\
    /f{fill}bind def/s{stroke}bind def/g{setgray}bind def/rg{setrgbcolor}bind def\n\
    /w{setlinewidth}bind def/j{setlinecap}bind def\n";

impl Drawing {
    /// The picture as EPS, which needs no font.
    pub fn to_eps(&self) -> String {
        let extent = self.extent();
        let points = |mm: f64| mm * POINTS_PER_MM;
        let (width, height) = (points(extent.width_mm), points(extent.height_mm));
        let program = self.stamp().unwrap_or_else(|| PROGRAM.to_owned());
        let mut eps = format!(
            "%!PS-Adobe-3.0 EPSF-3.0\n%%Creator: {program}\n%%Title: {}\n%%LanguageLevel: 3\n\
             %%BoundingBox: 0 0 {} {}\n%%HiResBoundingBox: 0 0 {width:.4} {height:.4}\n%%EndComments\n\
             %%BeginProlog\n/contact-dma 20 dict def contact-dma begin\n{PROLOG}end\n%%EndProlog\n\
             contact-dma begin gsave\n",
            ascii(&self.title),
            width.ceil(),
            height.ceil(),
        );
        let scale = points(extent.px_mm);
        // Writing to a String cannot fail.
        let _ = writeln!(
            eps,
            "[{scale:.6} 0 0 -{scale:.6} 0 {height:.4}] concat 1 setlinejoin"
        );
        let mut before = None;
        for shape in &self.shapes {
            if before.replace(shape.paint) != Some(shape.paint) {
                eps += &setting(&shape.paint);
            }
            eps += &path(shape);
        }
        eps + "grestore end\n%%EOF\n"
    }
}

/// A line of a comment, in which characters beyond ASCII have no meaning that readers agree upon.
fn ascii(text: &str) -> String {
    let shown = |c: char| match c {
        ' '..='~' => c,
        _ => '?',
    };
    // A line has at most 255 characters.
    text.chars().take(200).map(shown).collect()
}

/// Colour and stroke.
fn setting(paint: &Paint) -> String {
    let (color, opacity) = match *paint {
        Paint::Fill { color, opacity, .. } => (color, opacity),
        Paint::Stroke { color, .. } => (color, 1.0),
    };
    let part = |channel: u8| 1.0 - opacity * (1.0 - f64::from(channel) / 255.0);
    let [red, green, blue] = color.map(part);
    // Greys are told as greys, so that a printer mixes no inks for them.
    let color = match red == green && green == blue {
        true => format!("{red:.4} g"),
        false => format!("{red:.4} {green:.4} {blue:.4} rg"),
    };
    match *paint {
        Paint::Fill { .. } => format!("{color}\n"),
        Paint::Stroke {
            width, round_ends, ..
        } => format!("{color} {width:.4} w {} j\n", u8::from(round_ends)),
    }
}

/// The outline of a shape, painted.
fn path(shape: &Shape) -> String {
    let mut text = outline(&shape.path);
    text.push_str(match shape.paint {
        Paint::Fill { .. } => "f\n",
        Paint::Stroke { .. } => "s\n",
    });
    text
}

fn outline(path: &Path) -> String {
    let mut text = String::new();
    for segment in without_quadratic_curves(path) {
        let (points, operator): (&[Point], _) = match &segment {
            PathSegment::MoveTo(to) => (slice::from_ref(to), "m"),
            PathSegment::LineTo(to) => (slice::from_ref(to), "l"),
            PathSegment::QuadTo(..) => continue,
            PathSegment::CubicTo(a, b, to) => (&[*a, *b, *to], "c"),
            PathSegment::Close => (&[], "h"),
        };
        for point in points {
            for value in [point.x, point.y] {
                // To a hundredth of a px, far below what can be seen.
                let _ = write!(text, "{} ", f64::from((100.0 * value).round()) / 100.0);
            }
        }
        text.push_str(operator);
        text.push('\n');
    }
    text
}

/// The parts of a path, each quadratic curve as the cubic one that is the same: PostScript and PDF have no others.
pub(super) fn without_quadratic_curves(path: &Path) -> impl Iterator<Item = PathSegment> {
    let mut at = Point::zero();
    path.segments().map(move |segment| {
        let from = at;
        at = match segment {
            PathSegment::MoveTo(to)
            | PathSegment::LineTo(to)
            | PathSegment::QuadTo(_, to)
            | PathSegment::CubicTo(_, _, to) => to,
            // A path that goes on after it begins with a move.
            PathSegment::Close => at,
        };
        let PathSegment::QuadTo(by, to) = segment else {
            return segment;
        };
        let towards = |end: Point| {
            let part = |from: f32, by: f32| from + 2.0 / 3.0 * (by - from);
            Point::from_xy(part(end.x, by.x), part(end.y, by.y))
        };
        PathSegment::CubicTo(towards(from), towards(to), to)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::drawing::tests::drawn;

    /// Reads the EPS as far as it goes: the box, and the points that operators name, in points of the page.
    fn read(eps: &str) -> ([f64; 4], Vec<(f64, f64)>) {
        let comment = |name: &str| {
            let line = eps.lines().find_map(|line| line.strip_prefix(name));
            line.unwrap()
                .split_whitespace()
                .map(|n| n.parse().unwrap())
                .collect::<Vec<f64>>()
        };
        let sides: [f64; 4] = comment("%%HiResBoundingBox:").try_into().unwrap();
        let (_, body) = eps
            .split_once("%%EndProlog\ncontact-dma begin gsave\n")
            .unwrap();
        let (matrix, body) = body
            .trim_start_matches('[')
            .split_once("] concat 1 setlinejoin\n")
            .unwrap();
        let matrix: Vec<f64> = matrix.split(' ').map(|n| n.parse().unwrap()).collect();
        let (mut stack, mut points, mut is_open) = (Vec::new(), Vec::new(), false);
        for word in body
            .strip_suffix("grestore end\n%%EOF\n")
            .unwrap()
            .split_whitespace()
        {
            let takes = match word {
                "m" | "l" => 2,
                "c" => 6,
                "g" | "w" | "j" => 1,
                "rg" => 3,
                "h" | "f" | "s" => 0,
                number => {
                    stack.push(number.parse::<f64>().unwrap());
                    continue;
                }
            };
            assert_eq!(stack.len(), takes, "{word}");
            if matches!(word, "m" | "l" | "c") {
                assert!(is_open || word == "m");
                is_open = true;
                let at =
                    |xy: &[f64]| (matrix[0] * xy[0] + matrix[4], matrix[3] * xy[1] + matrix[5]);
                points.extend(stack.chunks(2).map(at));
            }
            is_open &= !matches!(word, "f" | "s");
            stack.clear();
        }
        assert!(stack.is_empty() && !is_open);
        (sides, points)
    }

    #[test]
    fn the_box_is_the_size_on_paper_and_all_ink_is_inside() {
        let eps = drawn().on_paper(85.0, Some(63.75), 0.176_388_9).to_eps();
        assert!(eps.starts_with("%!PS-Adobe-3.0 EPSF-3.0\n") && eps.is_ascii());
        assert!(eps.contains("\n%%BoundingBox: 0 0 241 181\n"));
        let (sides, points) = read(&eps);
        assert!((sides[2] - 85.0 / 25.4 * 72.0).abs() < 1e-4);
        assert!((sides[3] - 63.75 / 25.4 * 72.0).abs() < 1e-4);
        let is_inside = |&(x, y): &(f64, f64)| x > 0.0 && x < sides[2] && y > 0.0 && y < sides[3];
        assert!(points.iter().all(is_inside));
        // The curve rises from the lower left to the upper right: the picture is not upside down.
        let ends = points
            .windows(2)
            .find(|pair| (pair[1].0 - pair[0].0) > 0.5 * sides[2] && pair[1].1 != pair[0].1);
        assert!(ends.unwrap()[1].1 > ends.unwrap()[0].1);
    }

    #[test]
    fn tints_are_mixed_with_white_and_greys_are_greys() {
        let half = |color| Paint::Fill {
            color,
            opacity: 0.5,
            crisp: false,
        };
        assert_eq!(setting(&half([255, 0, 0])), "1.0000 0.5000 0.5000 rg\n");
        assert_eq!(setting(&half([0, 0, 0])), "0.5000 g\n");
    }
}
