//! Cells as numbers: the words for a missing one, decimal commas, thousands in groups.

use std::ops::Range;
use std::sync::Arc;

use super::grid::Line;
use crate::input::diagnostic::{Location, Problems, Source};

/// What says that a number is missing, in lower case: in files of every kind.
const MISSING: [&str; 12] = [
    "", "-", "--", "---", "n/a", "na", "n.a.", "nan", "#n/a", "-nan", "none", "null",
];

/// What stands in a cell where a number belongs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Cell {
    Number(f64),
    Missing,
    /// Why it is none.
    Bad(&'static str),
}

/// Whether a cell says that there is no number.
pub(super) fn is_hole(cell: &str) -> bool {
    MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// Why a cell that is a hole is no number.
pub(super) fn why_missing(cell: &str) -> &'static str {
    match cell {
        "" => "empty",
        _ if cell.parse::<f64>().is_ok() => "not a finite number",
        _ => "marked as missing",
    }
}

/// A number with a decimal point; or with a decimal comma, where commas do not separate cells or quotation marks enclose this one.
pub(super) fn number(cell: &str) -> Option<f64> {
    let rewritten = || cell.replacen(',', ".", 1).replacen('\u{2212}', "-", 1);
    cell.parse().ok().or_else(|| rewritten().parse().ok())
}

/// Reads cells as numbers, and remembers how they separate decimals.
#[derive(Debug, Default)]
pub(super) struct Numbers {
    /// The sign that groups thousands, where one does.
    grouping: Option<char>,
    /// The first number with a decimal point, where a comma could stand for it.
    point: Option<Range<usize>>,
    /// The first number with a comma.
    comma: Option<Range<usize>>,
    /// Whether some comma separates no thousands.
    is_decimal: bool,
}

impl Numbers {
    /// Reads numbers of which these are some. Where one of them has both a point and a comma, `1,234.5` or `1.234,5`, or one of them
    /// twice, the other groups thousands in all; else commas that may separate decimals or thousands are refused.
    pub(super) fn like<'a>(mut cells: impl Iterator<Item = &'a str>) -> Self {
        Self {
            grouping: cells.find_map(grouping_sign),
            ..Self::default()
        }
    }

    pub(super) fn read(&mut self, line: &Line<'_>, cell: usize) -> Cell {
        let text = line.text(cell);
        if is_hole(text) {
            return Cell::Missing;
        }
        if let Some(sign) = self.grouping {
            return grouped_number(text, sign);
        }
        match number(text) {
            None => Cell::Bad("not a number"),
            Some(number) if !number.is_finite() => Cell::Bad("not a finite number"),
            Some(number) => {
                self.see(text, &line.span(cell));
                Cell::Number(number)
            }
        }
    }

    fn see(&mut self, cell: &str, span: &Range<usize>) {
        if self.point.is_none() && cell.contains('.') {
            self.point = Some(span.clone());
        }
        if !self.is_decimal && cell.contains(',') {
            self.comma.get_or_insert_with(|| span.clone());
            // `1,234` could be an integer with its thousands apart.
            let digits = cell.trim_start_matches(['+', '-']);
            self.is_decimal = digits.starts_with('0') || !are_groups(digits, ',');
        }
    }

    /// Reports commas where they do not separate decimals everywhere.
    pub(super) fn check(&self, source: &Arc<Source>, problems: &Problems) {
        let Some(comma) = &self.comma else {
            return;
        };
        let comma = Location::new(source, comma.clone());
        if let Some(point) = &self.point {
            problems
                .at(&comma, "a decimal comma in a file with decimal points")
                .label(&Location::new(source, point.clone()), "a decimal point")
                .help("write decimal points, and nothing between thousands");
        } else if !self.is_decimal {
            let [point, none] = [".", ""].map(|sign| comma.text().replace(',', sign));
            problems
                .at(&comma, "this comma may separate decimals or thousands")
                .help(format!("write `{point}` or `{none}`"));
        }
    }
}

/// The sign that groups thousands, where a number tells.
fn grouping_sign(text: &str) -> Option<char> {
    let digits = text.trim_start_matches(['-', '+', '\u{2212}']);
    let is_numeric = digits.starts_with(|c: char| c.is_ascii_digit())
        && digits
            .chars()
            .all(|c| c.is_ascii_digit() || ".,eE+-".contains(c));
    if !is_numeric {
        return None;
    }
    [(',', '.'), ('.', ',')]
        .into_iter()
        .find_map(|(sign, decimal)| {
            let (whole, has_decimals) = match digits.split_once(decimal) {
                Some((whole, _)) => (whole, true),
                None => (digits, false),
            };
            let groups = whole.matches(sign).count();
            let is_told = groups > 1 || (groups == 1 && has_decimals);
            (is_told && are_groups(whole, sign)).then_some(sign)
        })
}

/// Whether a number is of digits in groups of three.
fn are_groups(whole: &str, sign: char) -> bool {
    let mut groups = whole.split(sign);
    let is_digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let first = groups.next().unwrap_or_default();
    (1..=3).contains(&first.len())
        && is_digits(first)
        && groups.all(|group| group.len() == 3 && is_digits(group))
}

/// A number whose thousands may be grouped by this sign.
fn grouped_number(text: &str, sign: char) -> Cell {
    let decimal = if sign == ',' { '.' } else { ',' };
    let whole = text.split([decimal, 'e', 'E']).next().unwrap_or_default();
    let digits = whole.trim_start_matches(['-', '+']);
    if digits.contains(sign) && !are_groups(digits, sign) {
        return Cell::Bad("not a number where thousands are grouped");
    }
    let plain: String = text
        .chars()
        .filter(|c| *c != sign)
        .map(|c| if c == decimal { '.' } else { c })
        .collect();
    match plain.parse::<f64>() {
        Ok(number) if number.is_finite() => Cell::Number(number),
        Ok(_) => Cell::Bad("not a finite number"),
        Err(_) => Cell::Bad("not a number"),
    }
}
