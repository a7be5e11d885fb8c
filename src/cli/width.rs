//! Text for a terminal that is narrower than the text: paragraphs are broken, tables lose columns, and say so.

use std::io::IsTerminal;

use crate::report::terminal::{ALWAYS_SHOWN, LEAVES_FIRST};
use crate::report::words::{USUAL, wrapped};

/// Narrower than this nothing can be read.
const NARROWEST: usize = 20;

/// The columns of the terminal: `COLUMNS` where it is set, else those of standard output; `None` where that is no terminal.
pub(super) fn of_terminal() -> Option<usize> {
    let set = std::env::var("COLUMNS").ok();
    let set = set.and_then(|columns| columns.trim().parse::<usize>().ok());
    let stdout = std::io::stdout();
    let real = || terminal_size::terminal_size_of(&stdout).map(|(width, _)| usize::from(width.0));
    set.or_else(|| stdout.is_terminal().then(real).flatten())
        .map(|columns| columns.max(NARROWEST))
}

/// The text in lines of at most so many columns, as far as its words allow.
pub(super) fn fitted(text: &str, columns: usize) -> String {
    let mut fitted = String::new();
    for block in text.split_inclusive("\n\n") {
        let (body, end) = block.split_at(block.trim_end_matches('\n').len());
        let lines: Vec<&str> = body.lines().collect();
        if lines.iter().all(|line| line.chars().count() <= columns) {
            fitted.push_str(block);
            continue;
        }
        // A sentence below a table is no row of it.
        let is_row = |line: &&&str| line.trim().contains("  ");
        let rows = match lines.iter().take_while(is_row).count() {
            0 => lines.len(),
            rows => rows,
        };
        let (table, below) = lines.split_at(rows);
        let gutters = gutters(table);
        let sentences = match gutters.is_empty() {
            true => &lines,
            false => {
                fitted.push_str(&narrower(table, &gutters, columns));
                below
            }
        };
        for line in joined(sentences) {
            let first = " ".repeat(indent(&line));
            let next = format!("{first}  ");
            fitted.push_str(&wrapped(&line, columns, &first, &next));
        }
        fitted.push_str(end.get(1..).unwrap_or(""));
    }
    fitted
}

fn indent(line: &str) -> usize {
    line.chars().take_while(|c| *c == ' ').count()
}

/// Lines as they were before they were broken at the usual width: one that is set in, as far as the line before or further, goes on
/// where that ended, if its first word had no room there.
fn joined(lines: &[&str]) -> Vec<String> {
    let mut whole: Vec<String> = Vec::new();
    let mut before = 0;
    for line in lines {
        let word = line.split_whitespace().next().unwrap_or_default();
        let had_no_room = before + 1 + word.chars().count() > USUAL;
        match whole.last_mut() {
            Some(last) if had_no_room && indent(line) >= indent(last).max(2) => {
                last.push(' ');
                last.push_str(line.trim_start());
            }
            _ => whole.push((*line).to_owned()),
        }
        before = line.chars().count();
    }
    whole
}

/// Where the columns of a table begin: behind at least two blanks in every line. A block of one line is no table.
fn gutters(lines: &[&str]) -> Vec<usize> {
    let rows: Vec<Vec<char>> = lines.iter().map(|line| line.chars().collect()).collect();
    let filled = rows.iter().filter(|row| !row.is_empty()).count();
    let widest = rows.iter().map(Vec::len).max().unwrap_or(0);
    let is_blank = |at: usize| rows.iter().all(|row| row.get(at).is_none_or(|c| *c == ' '));
    let begins = |at: &usize| *at > 2 && !is_blank(*at) && is_blank(at - 1) && is_blank(at - 2);
    match filled {
        0 | 1 => Vec::new(),
        _ => (0..widest).filter(begins).collect(),
    }
}

/// A table without the columns that do not fit, the least important left out first, and a line that says which. The first column,
/// and what else tells rows apart or how they ended, stays.
fn narrower(lines: &[&str], gutters: &[usize], columns: usize) -> String {
    let ends = gutters.iter().copied().chain([usize::MAX]);
    let all: Vec<(usize, usize)> = [0].iter().chain(gutters).copied().zip(ends).collect();
    let cell = |line: &str, (start, end): (usize, usize)| -> String {
        line.chars().skip(start).take(end - start).collect()
    };
    let row = |line: &str, shown: &[(usize, usize)]| {
        let cells: String = shown.iter().map(|column| cell(line, *column)).collect();
        cells.trim_end().to_owned()
    };
    // Two columns may be one where a heading stands above the gutter.
    let names = |column: &(usize, usize)| -> Vec<String> {
        let head = lines.iter().find(|line| !line.is_empty());
        let heading = head.map(|head| cell(head, *column)).unwrap_or_default();
        let names = heading.split("  ").map(str::trim);
        let names = names.filter(|name| !name.is_empty());
        names.map(str::to_owned).collect()
    };
    let is_among = |column: &(usize, usize), known: &[&str]| {
        names(column).iter().any(|name| known.contains(&&name[..]))
    };
    let mut leaving = all.get(1..).unwrap_or_default().to_vec();
    leaving.retain(|column| !is_among(column, &ALWAYS_SHOWN));
    // The last of these leaves first.
    leaving.sort_by_key(|column| is_among(column, &LEAVES_FIRST));
    let mut shown = all.clone();
    let fits = |shown: &[(usize, usize)]| {
        let mut widths = lines.iter().map(|line| row(line, shown).chars().count());
        widths.all(|width| width <= columns)
    };
    while !fits(&shown)
        && let Some(least) = leaving.pop()
    {
        shown.retain(|column| *column != least);
    }
    let table: String = lines.iter().map(|line| row(line, &shown) + "\n").collect();
    let left_out = all.iter().filter(|column| !shown.contains(column));
    let left_out: Vec<String> = left_out.flat_map(names).collect();
    if left_out.is_empty() {
        return table;
    }
    let told = format!("left out in {columns} columns: {}", left_out.join(", "));
    table + &wrapped(&told, columns, "  ", "  ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = " omega   loss / cycle     status\n  0.01   3.5090 uJ        converged\n 12.30   1 uJ ± 2         failed\n\n";

    #[test]
    fn a_table_loses_its_least_important_columns_and_says_which_but_never_how_a_row_ended() {
        assert_eq!(fitted(TABLE, 80), TABLE);
        let narrow = " omega   status\n  0.01   converged\n 12.30   failed\n";
        let told = "  left out in 26 columns:\n  loss / cycle\n\n";
        assert_eq!(fitted(TABLE, 26), format!("{narrow}{told}"));
        assert!(fitted(TABLE, 20).starts_with(narrow));
        // What cannot be left out stays, however narrow the terminal is.
        assert!(fitted(TABLE, 10).starts_with(narrow));
    }

    #[test]
    fn columns_leave_by_their_importance_and_sentences_below_a_table_stay_whole() {
        let table = " case   omega   cycles     about   memory\n    0   0.001       12     1.2 s   3.0 MB\n    1   0.002        9     1.1 s   3.0 MB\nAs long as it takes on this machine.\n";
        let narrow = |columns| fitted(table, columns);
        let shown = |columns| narrow(columns).lines().next().unwrap().to_owned();
        assert_eq!(shown(38), " case   omega   cycles     about");
        assert_eq!(shown(30), " case   omega   about");
        assert_eq!(shown(20), " case   omega");
        let sentence = "  left out in 38 columns: memory\nAs long as it takes on this machine.\n";
        assert!(narrow(38).ends_with(sentence), "{}", narrow(38));
    }

    #[test]
    fn what_was_broken_at_the_usual_width_is_broken_once() {
        let warnings =
            ["warning: ", "note: "].map(|kind| kind.to_owned() + &"a few words ".repeat(15));
        let usual: String = warnings
            .iter()
            .map(|line| wrapped(line, USUAL, "", "  "))
            .collect();
        let narrow: String = warnings
            .iter()
            .map(|line| wrapped(line, 60, "", "  "))
            .collect();
        assert!(usual.lines().count() > 4);
        assert_eq!(fitted(&usual, USUAL), usual);
        assert_eq!(fitted(&usual, 60), narrow);
    }

    #[test]
    fn a_paragraph_is_broken_between_its_words() {
        let text = "A title\n\nPeak: 3.5 uJ at 8.4e-3 rad/s\n  next line\n";
        assert_eq!(fitted(text, 80), text);
        assert_eq!(
            fitted(text, 20),
            "A title\n\nPeak: 3.5 uJ at\n  8.4e-3 rad/s\n  next line\n"
        );
    }
}
