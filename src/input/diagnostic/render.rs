//! Lays a diagnostic out in the manner of rustc, for 80 columns.

use std::ops::Range;

use annotate_snippets::{
    AnnotationKind, Group, Level, Origin, Renderer, Snippet, normalize_untrusted_str,
};

use super::{Diagnostic, Label, Source};

/// Columns laid out for.
const WIDTH: usize = 80;

/// Columns before the text of a help line or note (`   = help: `), at three-digit line numbers.
const MESSAGE_INDENT: usize = 12;

/// Columns left for a line of the source beside its number, at three-digit line numbers.
const SOURCE_WIDTH: usize = WIDTH - 6;

/// Characters of a message that are shown: keys and quantities of the file are repeated in it.
const MAX_TEXT: usize = 1000;

/// Lines of a help or note that are shown.
const MAX_LINES: usize = 20;

/// Columns that a tab fills when a line is shown.
const TAB: usize = 4;

/// Whether text carries terminal colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Styling {
    /// No escape codes: files, logs, tests.
    Plain,
    /// ANSI escape codes, for a stream that strips them where they do not belong.
    Colour,
}

/// One diagnostic as text, ending with a line end.
pub(super) fn render(diagnostic: &Diagnostic, styling: Styling) -> String {
    let renderer = match styling {
        Styling::Plain => Renderer::plain(),
        Styling::Colour => Renderer::styled(),
    };
    let title = Level::ERROR.primary_title(defused(&diagnostic.message));
    let mut group = Group::with_title(title);
    let mut notes = Vec::new();
    for (source, labels) in by_source(&diagnostic.labels) {
        group = show_source(group, source, &labels, &mut notes);
    }
    notes.extend(diagnostic.notes.iter().map(String::as_str));
    for note in notes.into_iter().filter(|note| !note.is_empty()) {
        group = group.element(Level::NOTE.message(wrap(note)));
    }
    for help in &diagnostic.help {
        group = group.element(Level::HELP.message(wrap(help)));
    }
    let mut text = renderer.term_width(SOURCE_WIDTH).render(&[group]);
    text.push('\n');
    text
}

/// Labels grouped by source, in order of first mention, so that the primary one leads.
fn by_source(labels: &[Label]) -> Vec<(&Source, Vec<&Label>)> {
    let mut groups: Vec<(&Source, Vec<&Label>)> = Vec::new();
    for label in labels {
        let source = label.location.source();
        match groups
            .iter_mut()
            .find(|(known, _)| std::ptr::eq(*known, source))
        {
            Some((_, members)) => members.push(label),
            None => groups.push((source, vec![label])),
        }
    }
    groups
}

/// Adds the labelled lines of one source. Text that does not fit beside its underline goes to `notes`.
fn show_source<'a>(
    group: Group<'a>,
    source: &'a Source,
    labels: &[&'a Label],
    notes: &mut Vec<&'a str>,
) -> Group<'a> {
    let text = source.text();
    let (placed, placeless): (Vec<&Label>, Vec<&Label>) =
        labels.iter().partition(|label| !label.location.is_whole());
    notes.extend(placeless.iter().map(|label| label.text.as_str()));
    let spans: Vec<Range<usize>> = placed
        .iter()
        .filter_map(|label| Some(clip(text, label.location.span.as_ref()?)))
        .collect();
    let (Some(first), Some(last)) = (
        spans.iter().map(|span| span.start).min(),
        spans.iter().map(|span| span.end).max(),
    ) else {
        return group.element(Origin::path(defused(source.name())));
    };
    // Only the lines from the first label to the last are handed over: the file may be long.
    let window = line_start(text, first)..line_end(text, last);
    let line_number = 1 + text[..window.start].matches('\n').count();
    let row = source.row(line_number);
    let mut snippet = Snippet::source(&text[window.clone()])
        .line_start(line_number)
        .line_numbering(!source.is_flag() && row.is_none())
        .path(defused(row.as_deref().unwrap_or(source.name())));
    for (label, span) in placed.into_iter().zip(spans) {
        let kind = match label.is_primary {
            true => AnnotationKind::Primary,
            false => AnnotationKind::Context,
        };
        let annotation = kind.span(span.start - window.start..span.end - window.start);
        snippet = snippet.annotation(if label.text.is_empty() {
            annotation
        } else if label_fits(&label.text, text, &span) {
            annotation.label(defused(&label.text))
        } else {
            notes.push(&label.text);
            annotation
        });
    }
    group.element(snippet)
}

/// A span cut to its first line and to whole characters. The end of the file is shown behind its last word.
fn clip(text: &str, span: &Range<usize>) -> Range<usize> {
    let end_of_words = text.trim_end().len();
    let mut start = span.start;
    if start >= text.len() {
        start = end_of_words;
    }
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    let mut end = span.end.clamp(start, text.len());
    while !text.is_char_boundary(end) {
        end += 1;
    }
    let end_of_line = line_end(text, start);
    start..end.min(end_of_line).max(start)
}

/// Where the line that holds `position` begins.
fn line_start(text: &str, position: usize) -> usize {
    text[..position].rfind('\n').map_or(0, |found| found + 1)
}

/// Where the line that holds `position` ends, before its line end.
fn line_end(text: &str, position: usize) -> usize {
    let length = text[position..].find('\n').unwrap_or(text.len() - position);
    position
        + text[position..position + length]
            .trim_end_matches('\r')
            .len()
}

/// Whether a label fits beside the underline of `span`.
fn label_fits(label: &str, text: &str, span: &Range<usize>) -> bool {
    let columns = |part: &str| -> usize {
        part.chars()
            .map(|character| if character == '\t' { TAB } else { 1 })
            .sum()
    };
    let line = line_start(text, span.start)..line_end(text, span.start);
    let before = if columns(&text[line.clone()]) > SOURCE_WIDTH {
        // A long line is cut so that the underline stands near the middle.
        SOURCE_WIDTH / 2
    } else {
        columns(&text[line.start..span.start])
    };
    let underline = columns(&text[span.clone()]).max(1);
    before + underline + 1 + columns(label) <= SOURCE_WIDTH
}

/// Text on one line, of bounded length, without the control characters by which a file could steer the
/// terminal.
fn defused(text: &str) -> String {
    let mut short: String = text.chars().take(MAX_TEXT).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    normalize_untrusted_str(&short.replace(['\r', '\n'], " "))
}

/// Breaks text at spaces to fit beside `= help:`, never within `backticks`; escape codes are defused.
fn wrap(text: &str) -> String {
    let mut lines = Vec::new();
    for paragraph in text.lines().take(MAX_LINES) {
        let paragraph = defused(paragraph);
        let mut line = String::new();
        for word in words(&paragraph) {
            let width = line.chars().count() + 1 + word.chars().count();
            if !line.is_empty() && width > WIDTH - MESSAGE_INDENT {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.push(line);
    }
    lines.join("\n")
}

/// The words of a text, where code in backticks is one word.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let mut in_code = false;
    text.split(move |character| {
        if character == '`' {
            in_code = !in_code;
        }
        character == ' ' && !in_code
    })
    .filter(|word| !word.is_empty())
}

#[cfg(test)]
mod tests {
    use super::super::{Diagnostic, Diagnostics, Location, Source, Styling};
    use super::wrap;

    fn plain(diagnostic: Diagnostic) -> String {
        Diagnostics::from(diagnostic).render(Styling::Plain)
    }

    #[test]
    fn two_places_of_one_file_are_shown_together() {
        let source = Source::file(
            "sweep.toml",
            "mean = \"10 N\"\n\n\n\namplitude = \"12 N\"\n",
        );
        let diagnostic = Diagnostic::at(&Location::new(&source, 29..35), "the contact opens")
            .because("larger than the mean")
            .label(&Location::new(&source, 7..13), "the mean");
        insta::assert_snapshot!(plain(diagnostic), @r#"
        error: the contact opens
         --> sweep.toml:5:13
          |
        1 | mean = "10 N"
          |        ------ the mean
        ...
        5 | amplitude = "12 N"
          |             ^^^^^^ larger than the mean
        "#);
    }

    #[test]
    fn a_flag_and_a_file_are_shown_one_below_the_other() {
        let file = Source::file("sweep.toml", "mean = \"10 N\"\n");
        let flag = Source::flag("--set drive.amplitude=12 N", 0);
        let diagnostic = Diagnostic::at(&Location::new(&flag, 22..26), "the contact opens")
            .because("larger than the mean")
            .label(&Location::new(&file, 7..13), "the mean")
            .help("write `--set \"drive.amplitude=5 N\"`");
        insta::assert_snapshot!(plain(diagnostic), @r#"
        error: the contact opens
         --> command line:1:23
          |
          | --set drive.amplitude=12 N
          |                       ^^^^ larger than the mean
          |
         ::: sweep.toml:1:8
          |
        1 | mean = "10 N"
          |        ------ the mean
          |
          = help: write `--set "drive.amplitude=5 N"`
        "#);
    }

    #[test]
    fn a_place_without_a_line_shows_the_file_only() {
        let source = Source::file("sweep.toml", "");
        let diagnostic = Diagnostic::at(&Location::whole(&source), "missing table `[drive]`")
            .because("needed by every sweep")
            .help("add it");
        insta::assert_snapshot!(plain(diagnostic), @r#"
        error: missing table `[drive]`
        --> sweep.toml
         = note: needed by every sweep
         = help: add it
        "#);
    }

    #[test]
    fn tabs_carriage_returns_and_wide_characters_keep_the_caret_below_its_word() {
        let text = "# µ\r\n\tlength_µ =\t\"10 µm 中\"\r\nnext = 1\r\n";
        let source = Source::file("sweep.toml", text);
        let start = text.find("µm").unwrap_or_default();
        let end = start + "µm".len();
        let diagnostic = Diagnostic::at(&Location::new(&source, start..end), "not a time")
            .because("a length")
            .label(&Location::new(&source, end + 1..end + 4), "wide");
        insta::assert_snapshot!(plain(diagnostic), @r#"
        error: not a time
         --> sweep.toml:2:17
          |
        2 |     length_µ =    "10 µm 中"
          |                       ^^ -- wide
          |                       |
          |                       a length
        "#);
    }

    #[test]
    fn a_span_over_several_lines_is_cut_to_the_first() {
        let source = Source::file("sweep.toml", "x = [\r\n 1,\r\n 2 ]\r\n");
        let diagnostic = Diagnostic::at(&Location::new(&source, 4..16), "too short").because("two");
        insta::assert_snapshot!(plain(diagnostic), @r#"
    error: too short
     --> sweep.toml:1:5
      |
    1 | x = [
      |     ^ two
    "#);
    }

    #[test]
    fn the_end_of_the_file_is_shown_behind_its_last_word() {
        let source = Source::file("sweep.toml", "x = [1,\n\n\n");
        let diagnostic =
            Diagnostic::at(&Location::new(&source, 10..10), "unclosed").because("here");
        insta::assert_snapshot!(plain(diagnostic), @r#"
    error: unclosed
     --> sweep.toml:1:8
      |
    1 | x = [1,
      |        ^ here
    "#);
    }

    #[test]
    fn a_label_that_does_not_fit_becomes_a_note() {
        let source = Source::file(
            "sweep.toml",
            "some_long_key_of_a_table = \"10 bananas of some kind\"",
        );
        let diagnostic = Diagnostic::at(&Location::new(&source, 27..52), "not a length")
            .because("`bananas of some kind` is not a known unit; the lengths known are m, mm, µm and nm")
            .help("write a length");
        insta::assert_snapshot!(plain(diagnostic), @r#"
        error: not a length
         --> sweep.toml:1:28
          |
        1 | some_long_key_of_a_table = "10 bananas of some kind"
          |                            ^^^^^^^^^^^^^^^^^^^^^^^^^
          |
          = note: `bananas of some kind` is not a known unit; the lengths known are m,
                  mm, µm and nm
          = help: write a length
        "#);
    }

    #[test]
    fn a_very_long_line_is_cut_around_the_caret() {
        let text = format!("x = [{} nan, {}]", "1.0, ".repeat(200), "2.0, ".repeat(200));
        let at = text.find("nan").unwrap_or_default();
        let source = Source::file("sweep.toml", text);
        let diagnostic = Diagnostic::at(&Location::new(&source, at..at + 3), "no").because("here");
        insta::assert_snapshot!(plain(diagnostic), @r#"
        error: no
         --> sweep.toml:1:1007
          |
        1 | ..., 1.0, 1.0, 1.0, 1.0, 1.0,  nan, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2...
          |                                ^^^ here
        "#);
    }

    #[test]
    fn terminal_escape_codes_of_a_file_are_defused() {
        let source = Source::file("sweep\u{1b}[31m.toml", "x = \"\u{1b}[31m\"");
        let diagnostic = Diagnostic::at(&Location::new(&source, 4..10), "bad \u{1b}[31m")
            .because("\u{1b}[31m")
            .note("\u{1b}[31m")
            .help("\u{1b}[31m");
        assert!(!plain(diagnostic).contains('\u{1b}'));
    }

    #[test]
    fn a_message_that_repeats_a_huge_key_stays_readable() {
        let diagnostic = Diagnostic::new("k".repeat(1_000_000)).help("k".repeat(1_000_000));
        assert!(plain(diagnostic).len() < 3000);
    }

    #[test]
    fn colour_adds_escape_codes_and_changes_no_letter() {
        let source = Source::file("sweep.toml", "x = 1\n");
        let diagnostics = Diagnostics::from(
            Diagnostic::at(&Location::new(&source, 4..5), "no")
                .because("here")
                .help("write 2"),
        );
        let colour = diagnostics.render(Styling::Colour);
        assert!(colour.contains('\u{1b}'));
        let stripped = anstream::adapter::strip_str(&colour).to_string();
        assert_eq!(stripped, diagnostics.render(Styling::Plain));
    }

    #[test]
    fn at_most_twenty_problems_are_shown_and_all_are_counted() {
        let source = Source::file("sweep.toml", "x = 1\n".repeat(30));
        let list = (0..30)
            .rev()
            .map(|line| Diagnostic::at(&Location::new(&source, 6 * line..6 * line + 1), "no"))
            .collect();
        let text = Diagnostics::new(list).render(Styling::Plain);
        assert_eq!(text.matches("error: no\n").count(), 20);
        assert!(text.contains("sweep.toml:20:1") && !text.contains("sweep.toml:21:1"));
        assert!(text.ends_with("error: 30 problems found; the first 20 are shown\n"));
    }

    #[test]
    fn wrapping_keeps_code_in_one_piece() {
        let text = format!("{} `mean = \"10 N\"` or so", "words ".repeat(10).trim_end());
        assert_eq!(
            wrap(&text),
            format!(
                "{}\n`mean = \"10 N\"` or so",
                "words ".repeat(10).trim_end()
            )
        );
    }
}
