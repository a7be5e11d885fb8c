//! The cells of a contact, as runs along the rows of a window: a field on them is stored without gaps.

use std::ops::Range;

/// Runs of cells in ascending order.
#[derive(Debug, Default)]
pub(super) struct Spans {
    runs: Vec<Range<usize>>,
    cells: usize,
}

impl Spans {
    pub(super) fn clear(&mut self) {
        self.runs.clear();
        self.cells = 0;
    }

    /// Adds a cell beyond all cells so far.
    pub(super) fn push(&mut self, cell: usize) {
        self.cells += 1;
        match self.runs.last_mut() {
            Some(run) if run.end == cell => run.end += 1,
            _ => self.runs.push(cell..cell + 1),
        }
    }

    /// Number of cells.
    pub(super) fn cells(&self) -> usize {
        self.cells
    }

    /// Rows of `cells_x` cells from the first to the last that has a cell.
    pub(super) fn rows(&self, cells_x: usize) -> Range<usize> {
        let first = self.runs.first().map_or(0, |run| run.start / cells_x);
        let last = self.runs.last().map_or(0, |run| run.end.div_ceil(cells_x));
        first..last
    }

    /// Every run: its cells in the window, and in a field stored without gaps.
    pub(super) fn runs(&self) -> impl Iterator<Item = (Range<usize>, Range<usize>)> + '_ {
        let mut at = 0;
        self.runs.iter().map(move |run| {
            let start = at;
            at += run.len();
            (run.clone(), start..at)
        })
    }

    /// The cells of a window of `cells` that are in no run.
    pub(super) fn others(&self, cells: usize) -> impl Iterator<Item = Range<usize>> + '_ {
        let starts = std::iter::once(0).chain(self.runs.iter().map(|run| run.end));
        let ends = self.runs.iter().map(|run| run.start);
        starts
            .zip(ends.chain(std::iter::once(cells)))
            .map(|(start, end)| start..end)
    }

    /// Writes a field stored without gaps into the window; other cells stay as they are.
    pub(super) fn scatter(&self, values: &[f64], window: &mut [f64]) {
        for (run, at) in self.runs() {
            window[run].copy_from_slice(&values[at]);
        }
    }

    /// The reverse.
    pub(super) fn gather(&self, window: &[f64], values: &mut [f64]) {
        for (run, at) in self.runs() {
            values[at].copy_from_slice(&window[run]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_and_the_rest_make_up_the_window() {
        let chosen = [0, 1, 4, 5, 6, 11];
        let mut spans = Spans::default();
        chosen.iter().for_each(|&cell| spans.push(cell));
        assert_eq!((spans.cells(), spans.rows(4)), (6, 0..3));
        let inside: Vec<usize> = spans.runs().flat_map(|(run, _)| run).collect();
        assert_eq!(inside, chosen);
        let outside: Vec<usize> = spans.others(12).flatten().collect();
        assert_eq!(outside, [2, 3, 7, 8, 9, 10]);
        let mut window = [0.0; 12];
        spans.scatter(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], &mut window);
        assert_eq!((window[6], window[7], window[11]), (5.0, 0.0, 6.0));
        let mut back = [0.0; 6];
        spans.gather(&window, &mut back);
        assert_eq!(back, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }

    #[test]
    fn without_cells_all_is_outside() {
        let spans = Spans::default();
        assert_eq!(spans.others(5).flatten().count(), 5);
        assert_eq!(spans.rows(3), 0..0);
    }
}
