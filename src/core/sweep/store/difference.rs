//! What differs between two resolved sweeps, line by line.

use std::cmp::Reverse;
use std::collections::HashMap;

/// Lines of `old` that are not in `new` behind `-`, and lines of `new` that are not in `old` behind `+`; after `most` lines
/// the rest is counted.
pub fn lines(old: &str, new: &str, most: usize) -> String {
    let removed = beyond(old, new).map(|(place, line)| (place, Reverse('-'), line));
    let added = beyond(new, old).map(|(place, line)| (place, Reverse('+'), line));
    let mut changed: Vec<_> = removed.chain(added).collect();
    changed.sort_unstable();
    let shown = changed.iter().take(most);
    let mut text: String = shown
        .map(|(_, Reverse(sign), line)| format!("  {sign} {line}\n"))
        .collect();
    if changed.len() > most {
        let more = changed.len() - most;
        text.push_str(&format!("  and {more} more lines\n"));
    }
    text
}

/// The lines of a text that another one has not, or not as often, and where they stand.
fn beyond<'a>(text: &'a str, other: &'a str) -> impl Iterator<Item = (usize, &'a str)> {
    let mut left: HashMap<_, usize> = HashMap::new();
    for line in in_tables(other) {
        *left.entry(line).or_default() += 1;
    }
    let lines = in_tables(text).enumerate();
    lines.filter_map(move |(place, line)| match left.get_mut(&line) {
        Some(left) if *left > 0 => {
            *left -= 1;
            None
        }
        _ => Some((place, line.1)),
    })
}

/// Every line behind the header of its table: the same line of another table is another one.
fn in_tables(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.lines().scan("", |table, line| {
        if line.starts_with('[') {
            *table = line;
        }
        Some((*table, line))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_differs_is_shown() {
        assert_eq!(lines("a\nb\nc\nd\n", "a\nB\nc\nd\n", 9), "  - b\n  + B\n");
        assert_eq!(lines("a\nb\nc\n", "a\nc\nd\n", 9), "  - b\n  + d\n");
        assert_eq!(lines("a\n", "a\n", 9), "");
        assert_eq!(lines("", "a\n", 9), "  + a\n");
        let swapped = lines("[a]\nx = 1\n[b]\nx = 2\n", "[a]\nx = 2\n[b]\nx = 1\n", 9);
        assert_eq!(swapped, "  - x = 1\n  + x = 2\n  - x = 2\n  + x = 1\n");
    }

    #[test]
    fn a_long_difference_is_cut_and_the_rest_counted() {
        let new: String = (0..5000).map(|i| format!("{i}\n")).collect();
        let old: String = (0..5000).map(|i| format!("{}\n", i + 10_000)).collect();
        let text = lines(&old, &new, 3);
        assert_eq!(text.lines().count(), 4);
        assert!(text.ends_with("and 9997 more lines\n"), "{text}");
    }
}
