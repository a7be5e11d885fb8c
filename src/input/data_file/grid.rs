//! A text as lines of cells, of which any may be a header, a row of units, a row of numbers or none of these.

use std::cmp::Reverse;
use std::ops::Range;
use std::sync::Arc;

use super::numbers;
use super::text::{self, DELIMITERS};
use crate::input::diagnostic::{Diagnostics, Location, Source};

/// Lines above the header at most.
pub(crate) const MOST_LINES_ABOVE: usize = 300;

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
    pub(super) source: Arc<Source>,
    delimiter: char,
    /// Whether several blanks, not one, separate the cells of a header, so that names may hold blanks.
    wide: bool,
    /// Whether an instrument wrote the text: blanks at the end of a line are no cells.
    by_instrument: bool,
    /// Where the lines begin that hold anything.
    starts: Vec<usize>,
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

    /// Of every way to cut a text that in which the first line that has a score, of those that may stand above a table, has the best, and
    /// that line; of equal ones the first.
    pub(crate) fn best<S: Ord>(
        source: &Arc<Source>,
        score: impl Fn(&Self, usize) -> Option<S>,
    ) -> Option<(Self, usize)> {
        let found = Self::every(source).filter_map(|grid| {
            let mut lines = 0..grid.len().min(MOST_LINES_ABOVE);
            let (score, line) = lines.find_map(|line| Some((score(&grid, line)?, line)))?;
            Some((Reverse(score), grid, line))
        });
        let best = found.min_by(|(a, _, _), (b, _, _)| a.cmp(b));
        best.map(|(_, grid, line)| (grid, line))
    }

    /// Cuts what an instrument wrote: comments are lines too, and lines of delimiters alone hold nothing.
    pub(crate) fn new(source: &Arc<Source>, delimiter: char) -> Self {
        let holds_nothing = |c: char| c.is_whitespace() || ",;|\"".contains(c);
        let is_line = |line: &str| !line.trim_matches(holds_nothing).is_empty();
        Self {
            by_instrument: true,
            ..Self::cut(source, delimiter, usize::MAX, is_line)
        }
    }

    /// Cuts at most so many lines of a table, in which empty lines and comments are none.
    pub(super) fn of_table(source: &Arc<Source>, delimiter: char, most: usize) -> Self {
        let is_line = |line: &str| !matches!(line.trim_start().bytes().next(), None | Some(b'#'));
        Self::cut(source, delimiter, most, is_line)
    }

    /// Quotation marks hide delimiters and line ends.
    fn cut(
        source: &Arc<Source>,
        delimiter: char,
        most: usize,
        is_line: impl Fn(&str) -> bool,
    ) -> Self {
        let (text, mut at) = (source.text(), 0);
        let (mut starts, mut cells) = (Vec::new(), Vec::new());
        while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty())
            && starts.len() < most
        {
            let line = rest.split('\n').next().unwrap_or_default();
            if is_line(line) {
                starts.push(at);
            }
            at = match is_line(line) && line.contains('"') && !is_comment(line) {
                true => text::cells_from(text, at, delimiter, &mut cells),
                false => at + line.len() + 1,
            };
        }
        Self {
            source: Arc::clone(source),
            delimiter,
            wide: false,
            by_instrument: false,
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

    /// Where a line begins; behind the last one, the end of the text.
    pub(super) fn start(&self, line: usize) -> usize {
        let end = self.source.text().len();
        self.starts.get(line).copied().unwrap_or(end)
    }

    /// The text of a line, empty behind the last one.
    pub(crate) fn text(&self, line: usize) -> &str {
        let rest = self.source.text().get(self.start(line)..);
        let first = rest.unwrap_or_default().split('\n').next();
        first.unwrap_or_default().trim_end()
    }

    /// A line as a place; the whole text behind the last one.
    pub(crate) fn place(&self, line: usize) -> Location {
        match line < self.len() {
            true => line_at(&self.source, self.start(line)),
            false => self.whole(),
        }
    }

    /// Whether the line begins with `#`.
    pub(crate) fn is_comment(&self, line: usize) -> bool {
        is_comment(self.text(line))
    }

    /// The cells of a line, of a comment those behind its mark.
    pub(crate) fn line(&self, line: usize) -> Line<'_> {
        let (text, start, next) = (self.source.text(), self.start(line), self.start(line + 1));
        let own = text.get(start..next).unwrap_or_default();
        let end = match self.by_instrument {
            true => start + own.trim_end().len(),
            false => next,
        };
        let is_mark = |c: char| c == '#' || c.is_whitespace();
        let skipped = match is_comment(own) {
            true => own.len() - own.trim_start_matches(is_mark).len(),
            false => 0,
        };
        Line::cut(&self.source, self.delimiter, start + skipped..end)
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
}

fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with('#')
}

/// The line that begins at `start`.
pub(super) fn line_at(source: &Arc<Source>, start: usize) -> Location {
    let rest = source.text().get(start..).unwrap_or_default();
    let line = rest.split('\n').next().unwrap_or_default();
    Location::new(source, start..start + line.trim_end().len())
}

/// The cells of a line.
pub(crate) struct Line<'a> {
    source: &'a Arc<Source>,
    cells: Vec<Range<usize>>,
}

impl<'a> Line<'a> {
    /// The cells of the first line of a part of a text.
    pub(super) fn cut(source: &'a Arc<Source>, delimiter: char, part: Range<usize>) -> Self {
        let mut cells = Vec::new();
        let text = source.text().get(..part.end).unwrap_or_default();
        if !part.is_empty() {
            text::cells_from(text, part.start, delimiter, &mut cells);
        }
        Self { source, cells }
    }

    pub(crate) fn len(&self) -> usize {
        self.cells.len()
    }

    /// Where the text of a cell stands, nowhere behind the last one.
    pub(super) fn span(&self, cell: usize) -> Range<usize> {
        self.cells.get(cell).cloned().unwrap_or_default()
    }

    /// The text of a cell, empty behind the last one.
    pub(crate) fn text(&self, cell: usize) -> &'a str {
        self.source.text().get(self.span(cell)).unwrap_or_default()
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
        numbers::number(self.text(cell)).is_some_and(f64::is_finite)
    }

    /// The same line without the empty cell that some instruments put before a row.
    pub(crate) fn aligned(mut self, columns: usize) -> Self {
        let is_shifted = self.len() == columns + 1 && self.text(0).is_empty();
        self.cells.drain(..usize::from(is_shifted));
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(text: &str, delimiter: char) -> Vec<Vec<String>> {
        let grid = Grid::of_table(&Source::file("a", text), delimiter, usize::MAX);
        let line = |line| grid.line(line).texts().map(str::to_owned).collect();
        (0..grid.len()).map(line).collect()
    }

    #[test]
    fn lines_are_cut_at_their_delimiter() {
        assert_eq!(
            cut("a , b,,c\r\n1,2,3,4", ','),
            [["a", "b", "", "c"], ["1", "2", "3", "4"]]
        );
        assert_eq!(cut("a\t\tb\n", '\t'), [["a", "", "b"]]);
        assert_eq!(
            cut("  a \t b  c \r\n d e f", ' '),
            [["a", "b", "c"], ["d", "e", "f"]]
        );
        assert_eq!(cut("# x\n\n  # y\n \t\n1;2\n#", ';'), [["1", "2"]]);
    }

    #[test]
    fn quotation_marks_hide_delimiters_and_line_ends() {
        assert_eq!(cut("a,\" b, \"\"c\" ,d\n", ','), [["a", "b, \"\"c", "d"]]);
        assert_eq!(cut("\"a\nb\",c\n1,2\n", ','), [["a\nb", "c"], ["1", "2"]]);
        // Marks that do not enclose a cell are text.
        assert_eq!(
            cut("5\",\"x\"y,\"z\n1,2,3\n", ','),
            [["5\"", "\"x\"y", "\"z"], ["1", "2", "3"]]
        );
    }

    #[test]
    fn comments_of_an_instrument_are_lines_and_delimiters_alone_are_none() {
        let grid = Grid::new(&Source::file("a", "# f,\"E\n,,;\n1,2\n"), ',');
        assert_eq!(grid.len(), 2);
        assert!(grid.is_comment(0) && !grid.is_comment(1));
        assert!(grid.line(0).texts().eq(["f", "\"E"]));
        assert!(grid.line(1).texts().eq(["1", "2"]));
        assert_eq!(grid.line(2).len(), 0);
    }
}
