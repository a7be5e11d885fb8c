//! Text for people: paragraphs and tables, which are laid out for the columns of a terminal when they are printed.

use std::fmt;

/// The columns that text is written for.
pub const USUAL: usize = 80;

/// Lines, paragraphs and tables, one below the other.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Text(Vec<Part>);

#[derive(Debug, Clone, PartialEq)]
enum Part {
    /// Stays as it is, unless the terminal is narrower.
    Line(String),
    /// Words in lines of at most [`USUAL`] columns: what stands before the first line, and before the others.
    Paragraph(String, &'static str, &'static str),
    Table(Table),
    /// Lines for another program, which are never broken.
    Verbatim(String),
}

impl Text {
    /// A line, which is broken only where the terminal is narrower.
    pub fn line(&mut self, line: impl Into<String>) {
        self.0.push(Part::Line(line.into()));
    }

    /// An empty line.
    pub fn blank(&mut self) {
        self.line("");
    }

    /// A paragraph, all lines but the first set in by two.
    pub fn paragraph(&mut self, words: impl Into<String>) {
        self.indented(words, "", "  ");
    }

    /// A paragraph with `first` before its first line and `next` before the others.
    pub fn indented(&mut self, words: impl Into<String>, first: &'static str, next: &'static str) {
        self.0.push(Part::Paragraph(words.into(), first, next));
    }

    /// Lines for another program, which are never broken.
    pub fn verbatim(&mut self, lines: &str) {
        self.0.push(Part::Verbatim(lines.to_owned()));
    }

    /// Puts another text below.
    pub fn append(&mut self, below: impl Into<Self>) {
        self.0.extend(below.into().0);
    }

    /// Puts another text below an empty line, where there is any.
    pub fn append_apart(&mut self, below: Self) {
        if !below.is_empty() {
            self.blank();
            self.append(below);
        }
    }

    /// Its lines as comments of TOML.
    pub fn as_comments(&self) -> String {
        let text = self.to_string();
        text.lines().map(|line| format!("# {line}\n")).collect()
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The text in lines of at most so many columns, as far as its words allow; without a number, as wide as it was written.
    pub fn in_columns(&self, columns: Option<usize>) -> String {
        let widest = columns.unwrap_or(usize::MAX);
        let laid_out = |part: &Part| match part {
            Part::Line(line) => broken(line, widest),
            Part::Paragraph(words, first, next) => wrapped(words, widest.min(USUAL), first, next),
            Part::Table(table) => table.in_columns(widest),
            Part::Verbatim(lines) => lines.clone(),
        };
        self.0.iter().map(laid_out).collect()
    }
}

/// As wide as it was written.
impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.in_columns(None))
    }
}

/// Each line by itself.
impl<S: AsRef<str>> From<S> for Text {
    fn from(lines: S) -> Self {
        let lines = lines.as_ref().lines();
        Self(lines.map(|line| Part::Line(line.to_owned())).collect())
    }
}

/// A table alone; nothing where it has no rows.
impl From<Table> for Text {
    fn from(table: Table) -> Self {
        let table = (!table.rows.is_empty()).then_some(Part::Table(table));
        Self(table.into_iter().collect())
    }
}

/// Each item is a paragraph.
impl<S: Into<String>> FromIterator<S> for Text {
    fn from_iter<I: IntoIterator<Item = S>>(paragraphs: I) -> Self {
        let mut text = Self::default();
        paragraphs
            .into_iter()
            .for_each(|words| text.paragraph(words));
        text
    }
}

/// A line as it is where it has room; else broken between words, what follows set in by two more.
fn broken(line: &str, columns: usize) -> String {
    if line.chars().count() <= columns {
        return format!("{line}\n");
    }
    let first: String = line.chars().take_while(|c| *c == ' ').collect();
    wrapped(line, columns, &first, &format!("{first}  "))
}

/// A paragraph in lines of at most so many columns, as far as its words allow; `first` stands before the first line, `next` before
/// the others.
fn wrapped(text: &str, columns: usize, first: &str, next: &str) -> String {
    let mut lines = vec![first.to_owned()];
    let mut is_empty = true;
    for word in text.split_whitespace() {
        let line = lines.last().map_or(0, |line| line.chars().count());
        if !is_empty && line + 1 + word.chars().count() > columns {
            lines.push(next.to_owned());
            is_empty = true;
        }
        if let Some(line) = lines.last_mut() {
            if !is_empty {
                line.push(' ');
            }
            line.push_str(word);
            is_empty = false;
        }
    }
    lines.join("\n") + "\n"
}

/// A column of a [`Table`]: its heading, of one line or several, and its least width.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    heading: String,
    width: usize,
    is_right: bool,
    leaves: Leaves,
}

/// When a column is left out where the terminal is too narrow for all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Leaves {
    Never,
    /// Those on the right before those on the left.
    InTurn,
    First,
}

impl Column {
    fn new(heading: String, width: usize, is_right: bool) -> Self {
        let leaves = Leaves::InTurn;
        Self {
            heading,
            width,
            is_right,
            leaves,
        }
    }

    /// A column of words.
    pub fn left(heading: impl Into<String>, width: usize) -> Self {
        Self::new(heading.into(), width, false)
    }

    /// A column of numbers.
    pub fn right(heading: impl Into<String>, width: usize) -> Self {
        Self::new(heading.into(), width, true)
    }

    /// The same, shown in the narrowest terminal too: it tells rows apart, or says how they ended.
    pub fn stays(mut self) -> Self {
        self.leaves = Leaves::Never;
        self
    }

    /// The same, which a narrow terminal leaves out before all others.
    pub fn leaves_first(mut self) -> Self {
        self.leaves = Leaves::First;
        self
    }

    fn padded(&self, cell: &str) -> String {
        match self.is_right {
            true => format!("{cell:>0$}", self.width),
            false => format!("{cell:<0$}", self.width),
        }
    }
}

/// A table with aligned columns, of which a narrow terminal leaves some out, and says which. The first column stays.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    columns: Vec<Column>,
    /// Blanks between two columns.
    gap: usize,
    rows: Vec<Row>,
}

#[derive(Debug, Clone, PartialEq)]
enum Row {
    Cells(Vec<String>),
    /// What is to be said of the row above.
    Remark(String),
}

impl Table {
    /// A table without rows, with so many blanks between two columns.
    pub fn new(gap: usize, columns: impl IntoIterator<Item = Column>) -> Self {
        let mut table = Self {
            columns: columns.into_iter().collect(),
            gap,
            rows: Vec::new(),
        };
        for column in &mut table.columns {
            let lines = column.heading.lines().map(|line| line.chars().count());
            column.width = lines.chain([column.width]).fold(0, usize::max);
        }
        table
    }

    /// Adds a row, with a cell for each column.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        let cells: Vec<String> = cells.into_iter().collect();
        for (column, cell) in self.columns.iter_mut().zip(&cells) {
            column.width = column.width.max(cell.chars().count());
        }
        self.rows.push(Row::Cells(cells));
    }

    /// Adds a line below the last row.
    pub fn remark(&mut self, line: String) {
        self.rows.push(Row::Remark(line));
    }

    fn in_columns(&self, widest: usize) -> String {
        let shown = self.shown(widest);
        let line = |cells: &mut dyn Iterator<Item = &str>| {
            let cells = self.columns.iter().zip(cells).zip(&shown);
            let cells = cells.filter(|(_, is_shown)| **is_shown);
            let cells = cells.map(|((column, cell), _)| column.padded(cell));
            let line = cells.collect::<Vec<_>>().join(&" ".repeat(self.gap));
            match line.trim_end() {
                "" => String::new(),
                line => format!("{line}\n"),
            }
        };
        let headings = self.columns.iter().map(|column| &column.heading);
        let lines = headings.clone().map(|heading| heading.lines().count());
        let heads = (0..lines.fold(0, usize::max))
            .map(|at| line(&mut headings.clone().map(|h| h.lines().nth(at).unwrap_or(""))));
        let rows = self.rows.iter().map(|row| match row {
            Row::Cells(cells) => line(&mut cells.iter().map(String::as_str)),
            Row::Remark(remark) => broken(remark, widest),
        });
        let table: String = heads.chain(rows).collect();
        let left_out = headings.zip(&shown).filter(|(_, is_shown)| !**is_shown);
        let left_out = left_out.map(|(heading, _)| heading.trim().replace('\n', " "));
        match &left_out.collect::<Vec<_>>()[..] {
            [] => table,
            names => {
                let told = format!("left out in {widest} columns: {}", names.join(", "));
                table + &wrapped(&told, widest, "  ", "  ")
            }
        }
    }

    /// Whether each of the columns is shown in so much room.
    fn shown(&self, widest: usize) -> Vec<bool> {
        let columns = self.columns.iter();
        let mut room = columns.map(|column| column.width + self.gap).sum::<usize>();
        let mut leaving: Vec<(usize, &Column)> = self.columns.iter().enumerate().skip(1).collect();
        leaving.retain(|(_, column)| column.leaves != Leaves::Never);
        // The last of these leaves first.
        leaving.sort_by_key(|(_, column)| column.leaves);
        let mut shown = vec![true; self.columns.len()];
        while room > widest.saturating_add(self.gap)
            && let Some((at, column)) = leaving.pop()
        {
            room -= column.width + self.gap;
            shown[at] = false;
        }
        shown
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted(text: &Text, columns: usize) -> String {
        text.in_columns(Some(columns))
    }

    #[test]
    fn paragraphs_are_wrapped_between_words() {
        assert_eq!(wrapped("a bb  ccc d", 6, "", " "), "a bb\n ccc d\n");
        assert_eq!(
            wrapped("longer than that", 4, "- ", "  "),
            "- longer\n  than\n  that\n"
        );
        assert_eq!(wrapped("", 9, "    ", ""), "    \n");
    }

    #[test]
    fn a_table_loses_its_least_important_columns_and_says_which_but_never_how_a_row_ended() {
        let mut table = Table::new(
            3,
            [
                Column::right("omega", 6),
                Column::left("loss / cycle", 13),
                Column::left("status", 0).stays(),
            ],
        );
        table.row(["0.01", "3.5090 uJ", "converged"].map(str::to_owned));
        table.row(["12.30", "1 uJ ± 2", "failed"].map(str::to_owned));
        let mut text = Text::default();
        text.append(table);
        let whole = " omega   loss / cycle    status\n  0.01   3.5090 uJ       converged\n 12.30   1 uJ ± 2        failed\n";
        assert_eq!(text.to_string(), whole);
        assert_eq!(fitted(&text, 80), whole);
        let narrow = " omega   status\n  0.01   converged\n 12.30   failed\n";
        let told = "  left out in 26 columns:\n  loss / cycle\n";
        assert_eq!(fitted(&text, 26), format!("{narrow}{told}"));
        assert!(fitted(&text, 20).starts_with(narrow));
        // What cannot be left out stays, however narrow the terminal is.
        assert!(fitted(&text, 10).starts_with(narrow));
    }

    #[test]
    fn columns_leave_by_their_importance_and_sentences_below_a_table_stay_whole() {
        let mut table = Table::new(
            3,
            [
                Column::right("case", 5),
                Column::right("omega", 5),
                Column::right("cycles", 6).leaves_first(),
                Column::right("about", 7),
                Column::left("memory", 6).leaves_first(),
            ],
        );
        table.row(["0", "0.001", "12", "1.2 s", "3.0 MB"].map(str::to_owned));
        let mut text = Text::default();
        text.append(table);
        text.line("As long as it takes on this machine.");
        let shown = |columns| fitted(&text, columns).lines().next().unwrap().to_owned();
        assert_eq!(shown(38), " case   omega   cycles     about");
        assert_eq!(shown(30), " case   omega     about");
        assert_eq!(shown(20), " case   omega");
        let sentence = "  left out in 38 columns: memory\nAs long as it takes on this machine.\n";
        assert!(fitted(&text, 38).ends_with(sentence));
    }

    #[test]
    fn a_wide_cell_widens_its_column_and_a_heading_may_have_two_lines() {
        let columns = [Column::left("name", 4), Column::right("largest\nof all", 0)];
        let mut table = Table::new(1, columns);
        table.row(["long name", "1"].map(str::to_owned));
        table.remark("  a remark".to_owned());
        let mut text = Text::default();
        text.append(table);
        let expected = "name      largest\n           of all\nlong name       1\n  a remark\n";
        assert_eq!(text.to_string(), expected);
        let narrow =
            "name\nlong name\n  a remark\n  left out\n  in 12\n  columns:\n  largest of\n  all\n";
        assert_eq!(fitted(&text, 12), narrow);
    }

    #[test]
    fn a_line_is_broken_only_where_it_has_no_room_and_a_paragraph_at_the_usual_width_too() {
        let long = "a few words ".repeat(15);
        let mut text = Text::from("A title\n\nPeak: 3.5 uJ at 8.4e-3 rad/s\n  next  line\n");
        text.line(long.trim());
        assert_eq!(text.in_columns(None).lines().count(), 5);
        let narrow =
            "A title\n\nPeak: 3.5 uJ at\n  8.4e-3 rad/s\n  next  line\na few words a few\n";
        assert!(fitted(&text, 20).starts_with(narrow));
        let text: Text = [long].into_iter().collect();
        assert_eq!(text.to_string(), fitted(&text, 200));
        assert_eq!(text.to_string().lines().count(), 3);
        assert!(fitted(&text, 60).lines().all(|line| line.len() <= 60));
    }
}
