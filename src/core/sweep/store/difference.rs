//! What differs between two resolved sweeps, line by line.

/// Pairs of lines beyond which the longest common subsequence is not sought, and lines are paired by their place instead.
const MOST_PAIRS: usize = 4_000_000;

/// Lines of `old` that are not in `new` behind `-`, and lines of `new` that are not in `old` behind `+`; after `most` lines
/// the rest is counted.
pub fn lines(old: &str, new: &str, most: usize) -> String {
    let (old, new): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
    let same = |(a, b): &(&&str, &&str)| a == b;
    let head = old.iter().zip(&new).take_while(same).count();
    let tails = old[head..].iter().rev().zip(new[head..].iter().rev());
    let tail = tails.take_while(same).count();
    let changed = changes(&old[head..old.len() - tail], &new[head..new.len() - tail]);
    let mut text: String = changed
        .iter()
        .take(most)
        .map(|(sign, line)| format!("  {sign} {line}\n"))
        .collect();
    if changed.len() > most {
        let more = changed.len() - most;
        text.push_str(&format!("  and {more} more lines\n"));
    }
    text
}

fn changes<'a>(old: &[&'a str], new: &[&'a str]) -> Vec<(char, &'a str)> {
    let (rows, columns) = (old.len(), new.len());
    if rows.saturating_mul(columns) > MOST_PAIRS {
        let removed = old.iter().map(|line| ('-', *line));
        return removed.chain(new.iter().map(|line| ('+', *line))).collect();
    }
    // Lengths of the longest common subsequence of the ends from (i, j) on.
    let mut common = vec![vec![0_u32; columns + 1]; rows + 1];
    for i in (0..rows).rev() {
        for j in (0..columns).rev() {
            common[i][j] = if old[i] == new[j] {
                common[i + 1][j + 1] + 1
            } else {
                common[i + 1][j].max(common[i][j + 1])
            };
        }
    }
    let (mut i, mut j, mut found) = (0, 0, Vec::new());
    while i < rows || j < columns {
        if i < rows && j < columns && old[i] == new[j] {
            (i, j) = (i + 1, j + 1);
        } else if j == columns || (i < rows && common[i + 1][j] >= common[i][j + 1]) {
            found.push(('-', old[i]));
            i += 1;
        } else {
            found.push(('+', new[j]));
            j += 1;
        }
    }
    found
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
