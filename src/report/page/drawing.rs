//! A drawing as a part of a page: the same picture in about a third of the bytes, with names that no other drawing has.

use std::fmt::Write;

/// The SVG of a chart, shortened, with every name in it beginning with `name`, so that two drawings do not share any.
pub fn inline_figure(svg: &str, name: &str) -> String {
    shortened(svg)
        .replace(" id=\"", &format!(" id=\"{name}-"))
        .replace("url(#", &format!("url(#{name}-"))
        .replace("href=\"#", &format!("href=\"#{name}-"))
        .replace(" xmlns=\"http://www.w3.org/2000/svg\"", "")
        .replace(" xmlns:xlink=\"http://www.w3.org/1999/xlink\"", "")
}

/// What charts are drawn in: sixteenths of a px. Anything finer is below what can be seen.
const SIXTEENTHS: &str = "matrix(0.0625 0 0 0.0625 ";

/// Paths with whole relative coordinates, their common attributes written once, lines without indentation.
fn shortened(svg: &str) -> String {
    // Coordinates in another unit stay what they are, to the two places that they are written with.
    let places = if svg.contains(SIXTEENTHS) { 1.0 } else { 100.0 };
    let mut short = String::with_capacity(svg.len() / 2);
    let mut group: Option<&str> = None;
    for line in svg.lines().map(str::trim) {
        let path = path_of(line);
        let attributes = path.map(|(attributes, _)| attributes);
        if group.is_some() && group != attributes {
            short.push_str("</g>");
            group = None;
        }
        match path {
            None => short.push_str(line),
            Some((attributes, d)) => {
                if group.is_none() {
                    // Writing to a String cannot fail.
                    let _ = write!(short, "<g {attributes}>");
                    group = Some(attributes);
                }
                let _ = write!(short, "<path d=\"{}\"/>", relative(d, places));
            }
        }
    }
    if group.is_some() {
        short.push_str("</g>");
    }
    short
}

/// Attributes and data of a path whose attributes a group may carry for it: inherited, and the same for one as for many.
fn path_of(line: &str) -> Option<(&str, &str)> {
    let inside = line.strip_prefix("<path ")?.strip_suffix("\"/>")?;
    let (attributes, d) = inside.split_once(" d=\"")?;
    let own = [
        "id=",
        "opacity=",
        "transform=",
        "clip-path=",
        "mask=",
        "filter=",
    ];
    let carried = !own
        .iter()
        .any(|own| attributes.starts_with(own) || attributes.contains(&format!(" {own}")));
    (carried && !d.contains('"')).then_some((attributes, d))
}

/// Path data with coordinates relative to the point before, in steps of 1/`places`; as it is where it holds anything but the
/// commands M, L, Q, C and Z.
fn relative(d: &str, places: f64) -> String {
    relative_data(d, places).unwrap_or_else(|| d.to_owned())
}

fn relative_data(d: &str, places: f64) -> Option<String> {
    let mut words = d.split_ascii_whitespace();
    let mut short = String::with_capacity(d.len() / 2);
    let (mut at, mut start) = ([0_i64; 2], [0_i64; 2]);
    let mut last = "";
    while let Some(command) = words.next() {
        let points = match command {
            "M" | "L" => 1,
            "Q" => 2,
            "C" => 3,
            "Z" => 0,
            _ => return None,
        };
        // The same command again needs no letter; after a move it would be a line.
        if command != last || command == "M" {
            short.push_str(&command.to_ascii_lowercase());
        }
        last = command;
        let mut point = at;
        for _ in 0..points {
            for axis in 0..2 {
                let value: f64 = words.next()?.parse().ok()?;
                point[axis] = (value * places).round() as i64;
                number(&mut short, point[axis] - at[axis], places);
            }
        }
        at = point;
        match command {
            "M" => start = at,
            "Z" => at = start,
            _ => {}
        }
    }
    Some(short)
}

/// A number after what is there: a sign parts two numbers as a space does.
fn number(text: &mut String, steps: i64, places: f64) {
    let value = steps as f64 / places;
    if steps >= 0 && text.ends_with(|c: char| c.is_ascii_digit()) {
        text.push(' ');
    }
    let _ = write!(text, "{value}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_in_sixteenths_become_whole_and_relative_and_share_their_attributes() {
        let svg = "<svg>\n <title>a b</title>\n <g transform=\"matrix(0.0625 0 0 0.0625 0 0)\">\n  \
                   <path fill=\"none\" stroke=\"#eee\" d=\"M 10 20 L 10.4 30.6 L 12 20 Z M 1 1 L 2 2\"/>\n  \
                   <path fill=\"none\" stroke=\"#eee\" d=\"M 0 0 Q 1 2 3 4 C 5 5 6 6 4 4\"/>\n  \
                   <path fill=\"#000\" d=\"M 0 0 L 5 0\"/>\n </g>\n</svg>\n";
        assert_eq!(
            shortened(svg),
            "<svg><title>a b</title><g transform=\"matrix(0.0625 0 0 0.0625 0 0)\"><g fill=\"none\" stroke=\"#eee\">\
             <path d=\"m10 20l0 11 2-11zm-9-19l1 1\"/><path d=\"m0 0q1 2 3 4c2 1 3 2 1 0\"/></g><g fill=\"#000\">\
             <path d=\"m0 0l5 0\"/></g></g></svg>"
        );
    }

    #[test]
    fn what_is_not_understood_and_what_a_group_would_change_stays() {
        let arc = "<path d=\"M 0 0 A 1 1 0 0 1 2 2\"/>";
        assert_eq!(shortened(arc), arc);
        for attribute in [
            "opacity=\"0.5\"",
            "id=\"a\"",
            "fill=\"red\" clip-path=\"url(#a)\"",
        ] {
            let path = format!("<path {attribute} d=\"M 0 0 L 1 1\"/>");
            assert_eq!(shortened(&path), path);
        }
    }

    #[test]
    fn coordinates_in_another_unit_keep_their_two_places() {
        let svg = "<path fill=\"red\" d=\"M 0.25 1 L 0.5 -1.25\"/>";
        assert_eq!(
            shortened(svg),
            "<g fill=\"red\"><path d=\"m0.25 1l0.25-2.25\"/></g>"
        );
    }

    #[test]
    fn names_begin_with_the_name_of_the_drawing() {
        let svg = "<rect id=\"a\" fill=\"url(#b)\"/>\n<use href=\"#a\"/>";
        assert_eq!(
            inline_figure(svg, "n"),
            "<rect id=\"n-a\" fill=\"url(#n-b)\"/><use href=\"#n-a\"/>"
        );
    }
}
