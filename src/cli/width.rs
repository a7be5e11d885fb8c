//! Text for a terminal that is narrower than the text: paragraphs are broken, tables lose columns, and say so.

use std::io::IsTerminal;

use crate::report::words::wrapped;

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
        let lines: Vec<&str> = block.lines().collect();
        let widest = lines.iter().map(|line| line.chars().count()).max();
        if widest.is_none_or(|widest| widest <= columns) {
            fitted.push_str(block);
            continue;
        }
        match gutters(&lines) {
            gutters if gutters.is_empty() => lines.iter().for_each(|line| {
                let indent: String = line.chars().take_while(|c| *c == ' ').collect();
                match line.trim().is_empty() {
                    true => fitted.push('\n'),
                    false => {
                        fitted.push_str(&wrapped(line, columns, &indent, &format!("{indent}  ")))
                    }
                }
            }),
            gutters => fitted.push_str(&narrower(&lines, &gutters, columns)),
        }
    }
    fitted
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

/// A table without the columns that do not fit, from the right.
fn narrower(lines: &[&str], gutters: &[usize], columns: usize) -> String {
    let cut = |line: &str, at: usize| -> String {
        let left: String = line.chars().take(at).collect();
        left.trim_end().to_owned()
    };
    let fits = |at: &&usize| {
        lines
            .iter()
            .all(|line| cut(line, **at).chars().count() <= columns)
    };
    let at = gutters
        .iter()
        .rev()
        .find(fits)
        .or(gutters.first())
        .copied()
        .unwrap_or(columns);
    let left_out: Vec<String> = lines.first().map_or_else(Vec::new, |head| {
        let rest: String = head.chars().skip(at).collect();
        rest.split("  ")
            .map(str::trim)
            .filter(|name| !name.is_empty())
            .map(str::to_owned)
            .collect()
    });
    let mut table: String = lines.iter().map(|line| cut(line, at) + "\n").collect();
    let end = table.trim_end().len();
    let blank = table.split_off(end.min(table.len()));
    let told = format!("left out in {columns} columns: {}", left_out.join(", "));
    table + "\n" + &wrapped(&told, columns, "  ", "  ") + blank.get(1..).unwrap_or("")
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = " omega   loss / cycle     status\n  0.01   3.5090 uJ        converged\n 12.30   1 uJ ± 2         failed\n\n";

    #[test]
    fn a_table_loses_columns_from_the_right_and_says_which() {
        assert_eq!(fitted(TABLE, 80), TABLE);
        assert_eq!(
            fitted(TABLE, 26),
            " omega   loss / cycle\n  0.01   3.5090 uJ\n 12.30   1 uJ ± 2\n  left out in 26 columns:\n  status\n\n"
        );
        let narrow = fitted(TABLE, 20);
        assert!(narrow.starts_with(" omega\n  0.01\n 12.30\n"), "{narrow}");
        let words = narrow.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.ends_with("left out in 20 columns: loss / cycle, status"));
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
