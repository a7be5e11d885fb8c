//! A text as lines of cells, of which any may be a header, a row of units, a row of numbers or none of these: what instruments write.
//! Comments are lines too; a number may be marked as missing.

use std::ops::Range;
use std::sync::Arc;

use super::rows::{DecimalSigns, line_at, plain_number};
use super::text::{self, DELIMITERS};
use crate::input::diagnostic::{Diagnostics, Location, Problems, Source};

/// How instruments write that a number is missing, in lower case.
pub(super) const MISSING: [&str; 12] = [
    "", "-", "--", "---", "n/a", "na", "n.a.", "nan", "#n/a", "-nan", "none", "null",
];

/// The text of an instrument's file, and how many of its bytes were no UTF-8.
///
/// # Errors
/// No text.
pub(crate) fn source(name: &str, bytes: &[u8]) -> Result<(Arc<Source>, usize), Diagnostics> {
    let (text, stray) = text::decode_instrument(name, bytes)?;
    Ok((Source::file(name, text), stray))
}

/// A text cut into lines of cells by one delimiter.
pub(crate) struct Grid {
    source: Arc<Source>,
    delimiter: char,
    /// Whether several blanks, not one, separate the cells of a header, so that names may hold blanks.
    wide: bool,
    /// Where the lines begin that hold anything.
    starts: Vec<usize>,
}

/// What stands in a cell where a number belongs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Cell {
    Number(f64),
    Missing,
    /// Why it is none.
    Bad(&'static str),
}

impl Grid {
    /// Every way to cut a text, that which hides the others first.
    pub(crate) fn every(source: &Arc<Source>) -> impl Iterator<Item = Self> {
        let wide = Self {
            wide: true,
            ..Self::new(source, ' ')
        };
        let single = DELIMITERS.map(|(delimiter, _)| Self::new(source, delimiter));
        single.into_iter().chain([wide])
    }

    /// Cuts a text. Quotation marks hide delimiters, and do not hide line ends.
    pub(crate) fn new(source: &Arc<Source>, delimiter: char) -> Self {
        let (mut starts, mut position) = (Vec::new(), 0);
        for line in source.text().split_inclusive('\n') {
            // Delimiters alone hold nothing.
            if !line
                .trim_matches(|c: char| c.is_whitespace() || ",;|\"".contains(c))
                .is_empty()
            {
                starts.push(position);
            }
            position += line.len();
        }
        let source = Arc::clone(source);
        Self {
            source,
            delimiter,
            wide: false,
            starts,
        }
    }

    pub(crate) fn delimiter(&self) -> char {
        self.delimiter
    }

    /// Lines that hold anything.
    pub(crate) fn len(&self) -> usize {
        self.starts.len()
    }

    /// The whole text as a place.
    pub(crate) fn whole(&self) -> Location {
        Location::whole(&self.source)
    }

    /// The text of a line, empty behind the last one.
    pub(crate) fn text(&self, line: usize) -> &str {
        let start = self.starts.get(line).copied().unwrap_or(usize::MAX);
        let rest = self.source.text().get(start..).unwrap_or_default();
        rest.split('\n').next().unwrap_or_default().trim_end()
    }

    /// A line as a place.
    pub(crate) fn place(&self, line: usize) -> Location {
        match self.starts.get(line) {
            Some(start) => line_at(&self.source, *start),
            None => self.whole(),
        }
    }

    /// Whether the line begins with `#`.
    pub(crate) fn is_comment(&self, line: usize) -> bool {
        self.text(line).trim_start().starts_with('#')
    }

    /// The cells of a line, of a comment those behind its mark.
    pub(crate) fn line(&self, line: usize) -> Line<'_> {
        let (text, mut cells) = (self.source.text(), Vec::new());
        if let Some(start) = self.starts.get(line) {
            let marks = self
                .text(line)
                .find(|c: char| c != '#' && !c.is_whitespace());
            let skipped = if self.is_comment(line) {
                marks.unwrap_or(0)
            } else {
                0
            };
            let end = start + self.text(line).len();
            text::cells_from(
                text.get(..end).unwrap_or(text),
                start + skipped,
                self.delimiter,
                &mut cells,
            );
        }
        Line {
            source: &self.source,
            delimiter: self.delimiter,
            cells,
        }
    }

    /// The cells of a line that may hold names: where blanks separate cells, a unit in brackets belongs to the name before it.
    pub(crate) fn header(&self, line: usize) -> Line<'_> {
        let mut cut = self.line(line);
        if self.delimiter != ' ' {
            return cut;
        }
        let text = self.source.text();
        let joined = |before: &Range<usize>, next: &Range<usize>| {
            let between = text.get(before.end..next.start).unwrap_or_default();
            let cell = text.get(next.clone()).unwrap_or_default();
            let is_unit = cell.starts_with(['[', '(']) && cell.ends_with([']', ')']);
            is_unit || (self.wide && between == " ")
        };
        let is_units = cut.text(0).starts_with('[');
        let mut cells: Vec<Range<usize>> = Vec::new();
        for next in cut.cells.drain(..) {
            match cells
                .last_mut()
                .filter(|before| !is_units && joined(before, &next))
            {
                Some(before) => before.end = next.end,
                None => cells.push(next),
            }
        }
        cut.cells = cells;
        cut
    }

    /// Reads the numbers of these lines. Where one of them has both a point and a comma, `1,234.5` or `1.234,5`, or one of them twice,
    /// the other groups thousands in all; else commas that may separate decimals or thousands are refused.
    pub(crate) fn numbers(&self, mut lines: Range<usize>) -> Numbers<'_> {
        let grouped = |line: usize| self.line(line).texts().find_map(grouping_sign);
        Numbers {
            grid: self,
            grouping: lines.find_map(grouped),
            signs: DecimalSigns::default(),
        }
    }
}

/// The cells of a line.
pub(crate) struct Line<'a> {
    source: &'a Arc<Source>,
    delimiter: char,
    cells: Vec<Range<usize>>,
}

impl<'a> Line<'a> {
    pub(crate) fn len(&self) -> usize {
        self.cells.len()
    }

    /// The text of a cell, empty behind the last one.
    pub(crate) fn text(&self, cell: usize) -> &'a str {
        let span = self.cells.get(cell).cloned().unwrap_or(0..0);
        self.source.text().get(span).unwrap_or_default()
    }

    pub(crate) fn texts(&self) -> impl Iterator<Item = &'a str> + '_ {
        (0..self.len()).map(|cell| self.text(cell))
    }

    /// A cell as a place; behind the last one, the end of the line.
    pub(crate) fn place(&self, cell: usize) -> Location {
        let end = self.cells.last().map_or(0, |span| span.end);
        let span = self.cells.get(cell).cloned().unwrap_or(end..end);
        Location::new(self.source, span)
    }

    /// What stands in a cell, if it is a number.
    pub(crate) fn is_number(&self, cell: usize) -> bool {
        number(self.text(cell), self.delimiter).is_some_and(f64::is_finite)
    }

    /// The same line without its first cells.
    pub(crate) fn without(mut self, cells: usize) -> Self {
        self.cells.drain(..cells.min(self.cells.len()));
        self
    }
}

/// Reads cells as numbers, and remembers how they separate decimals.
pub(crate) struct Numbers<'a> {
    grid: &'a Grid,
    /// The sign that groups thousands, where one does.
    grouping: Option<char>,
    signs: DecimalSigns,
}

impl Numbers<'_> {
    pub(crate) fn read(&mut self, line: &Line<'_>, cell: usize) -> Cell {
        let text = line.text(cell);
        if MISSING.contains(&text.to_lowercase().as_str()) {
            return Cell::Missing;
        }
        if let Some(sign) = self.grouping {
            return grouped_number(text, sign);
        }
        match number(text, line.delimiter) {
            None => Cell::Bad("not a number"),
            Some(number) if !number.is_finite() => Cell::Bad("not a finite number"),
            Some(number) => {
                if let Some(span) = line.cells.get(cell)
                    && (line.delimiter != ',' || text.contains(','))
                {
                    self.signs.see(text, span);
                }
                Cell::Number(number)
            }
        }
    }

    /// Reports commas that may separate decimals or thousands.
    pub(crate) fn check(&self, problems: &Problems) {
        self.signs.check(&self.grid.source, problems);
    }
}

/// The sign that groups thousands, where a number tells.
pub(super) fn grouping_sign(text: &str) -> Option<char> {
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
pub(super) fn grouped_number(text: &str, sign: char) -> Cell {
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

/// A number; between quotation marks a comma may stand for its point even where commas separate cells.
fn number(text: &str, delimiter: char) -> Option<f64> {
    let minus;
    let text = match text.strip_prefix('\u{2212}') {
        Some(rest) => {
            minus = format!("-{rest}");
            &minus
        }
        None => text,
    };
    plain_number(text, if delimiter == ',' { ';' } else { delimiter })
}
