//! Errors of TOML's own grammar, in the words of somebody who writes sweep files.

use std::ops::Range;
use std::sync::Arc;

use toml::de::Error;

use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, MAX_SHOWN, Source};

/// Bytes of a value up to which it is repeated in quotes as help.
const MAX_MENDED: usize = 60;

/// What `toml` says of a key that is already there.
const DUPLICATE: &str = "duplicate key";

/// What `toml` says of a value that is a bare word, or of none at all.
const UNQUOTED: &str = "string values must be quoted";

/// What `toml` says of a bare word that begins like `nan` or `inf`.
const NO_FLOAT: &str = "invalid float";

/// Quotation marks of text processors, which TOML does not know.
pub(in crate::input) const CURLY: [char; 8] = ['“', '”', '„', '‟', '‘', '’', '«', '»'];

/// What other languages write where there is no value.
const NO_VALUE: [&str; 5] = ["none", "null", "nil", "na", "undefined"];

/// One error of `toml`, as far as it is needed here.
struct Fault<'a> {
    description: &'a str,
    expected: Option<&'a str>,
    /// Absent for the error that keys are too deep.
    span: Option<Range<usize>>,
}

impl Fault<'_> {
    fn start(&self) -> usize {
        self.span.as_ref().map_or(0, |span| span.start)
    }
}

/// Every error that stands for itself: one for a line, none that only follow from an earlier one.
pub(super) fn explain_all(source: &Arc<Source>, errors: &[Error]) -> Diagnostics {
    let text = source.text();
    let mut faults: Vec<Fault> = errors.iter().map(|error| fault(error, 0)).collect();
    faults.sort_by_key(Fault::start);
    let mut told = Vec::new();
    let mut omitted = 0;
    let mut line = 0..0;
    let mut told_line = None;
    let mut in_repeated_table = false;
    for fault in &faults {
        if told.is_empty() || fault.start() > line.end {
            line = line_around(text, fault.start());
        }
        let is_header = text[line.clone()].trim_start().starts_with('[');
        let is_duplicate = fault.description == DUPLICATE;
        if is_header || !is_duplicate {
            in_repeated_table = is_header && is_duplicate;
        }
        // Keys written again below a header written again follow from the header.
        if told_line == Some(line.end) || (in_repeated_table && !is_header) {
            continue;
        }
        told_line = Some(line.end);
        // Explaining looks through the file, which would take long for a great many errors.
        if told.len() < MAX_SHOWN {
            told.push(explain(source, fault));
        } else {
            omitted += 1;
        }
        if leads_astray(fault) {
            break;
        }
    }
    Diagnostics::with_omitted(told, omitted)
}

/// The error of a value that begins at `offset` of `source`.
pub(in crate::input) fn explain_value(
    source: &Arc<Source>,
    error: &Error,
    offset: usize,
) -> Diagnostic {
    explain(source, &fault(error, offset))
}

fn fault(error: &Error, offset: usize) -> Fault<'_> {
    let (description, expected) = match error.message().split_once(", expected ") {
        Some((description, "nothing")) => (description, None),
        Some((description, expected)) => (description, Some(expected)),
        None => (error.message(), None),
    };
    Fault {
        description,
        expected,
        span: error
            .span()
            .map(|span| span.start + offset..span.end + offset),
    }
}

/// Whether what follows is read wrongly because of this error: an array or string left open.
fn leads_astray(fault: &Fault<'_>) -> bool {
    ["array", "inline table", "multi-line"]
        .iter()
        .any(|word| fault.description.contains(word))
}

fn explain(source: &Arc<Source>, fault: &Fault<'_>) -> Diagnostic {
    let Some(span) = fault.span.clone() else {
        let message = format!("invalid TOML: {}", fault.description);
        return Diagnostic::at(&Location::whole(source), message);
    };
    let place = Location::new(source, span.clone());
    let written = place.text();
    match fault.description {
        DUPLICATE => given_twice(source, &place, &span),
        UNQUOTED | "invalid literal string" if written.is_empty() => {
            Diagnostic::at(&place, "a value is missing").because("expected a value here")
        }
        UNQUOTED | NO_FLOAT if NO_VALUE.contains(&written.to_ascii_lowercase().as_str()) => {
            Diagnostic::at(&place, format!("`{written}` is no value"))
                .because("TOML has no empty value")
                .help("leave the key out where it has no value")
        }
        UNQUOTED => unquoted(source.text(), &place, &span),
        NO_FLOAT if written.starts_with(char::is_alphabetic) => {
            unquoted(source.text(), &place, &span)
        }
        _ => other(source.text(), fault, &place, &span),
    }
}

/// Text without quotes, or within quotes that are none.
fn unquoted(text: &str, place: &Location, span: &Range<usize>) -> Diagnostic {
    let because = match place.text().starts_with(CURLY) {
        true => "curly quotes, which TOML does not read as quotes",
        false => "not a number, a boolean or quoted text",
    };
    let problem = Diagnostic::at(place, "text must be in quotes").because(because);
    match quoted_assignment(text, span, place.text()) {
        Some(mended) => problem.help(format!("write `{mended}`")),
        None => problem,
    }
}

/// An error told in the words of `toml`, with help where it has a usual cause.
fn other(text: &str, fault: &Fault<'_>, place: &Location, span: &Range<usize>) -> Diagnostic {
    let mut problem = Diagnostic::at(place, format!("invalid TOML: {}", fault.description));
    if let Some(expected) = fault.expected {
        problem = problem.because(format!("expected {expected}"));
    }
    let line_start = line_around(text, span.start).start;
    let opens_line = text
        .get(line_start..span.start)
        .is_some_and(|before| before.trim().is_empty());
    if let Some(mended) = decimal_comma(text, span) {
        problem.help(format!("write `{mended}`"))
    } else if fault.description.contains("array") && opens_line && line_start > 0 {
        problem.help("close the array that was opened above with `]`, or add a comma")
    } else {
        problem
    }
}

fn given_twice(source: &Arc<Source>, place: &Location, span: &Range<usize>) -> Diagnostic {
    let message = format!("`{}` is given twice", place.text().trim());
    let problem = Diagnostic::at(place, message).because("the second time");
    match earlier(source.text(), span) {
        Some(first) => problem.label(&Location::new(source, first), "the first time"),
        None => problem,
    }
    .help("keep one of the two")
}

/// `key = "value"`, in straight quotes, when `value` is all there is behind the key, else `"value"`. `None` for a value that
/// quotes alone do not mend.
fn quoted_assignment(text: &str, span: &Range<usize>, value: &str) -> Option<String> {
    let spoils = |character: char| "\"'\\`".contains(character) || character.is_control();
    if value.len() > MAX_MENDED || value.contains(spoils) {
        return None;
    }
    let line = &text[line_around(text, span.start)];
    let inside = value.trim_matches(CURLY);
    Some(match line.split_once('=') {
        Some((key, rest)) if before_comment(rest) == value => {
            format!("{} = \"{inside}\"", key.trim())
        }
        _ => format!("\"{inside}\""),
    })
}

/// The line with a decimal point, when it is `key = 1,5`.
fn decimal_comma(text: &str, span: &Range<usize>) -> Option<String> {
    let (key, value) = text[line_around(text, span.start)].split_once('=')?;
    let (whole, fraction) = value.trim().split_once(',')?;
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let whole_digits = whole.trim_start_matches(['+', '-']);
    (digits(whole_digits) && digits(fraction))
        .then(|| format!("{} = {whole}.{fraction}", key.trim()))
}

/// Where the duplicate at `span` was first written: the same header, or the same key in the same table.
fn earlier(text: &str, span: &Range<usize>) -> Option<Range<usize>> {
    let line = line_around(text, span.start);
    let written = text.get(span.clone())?;
    let wanted = text[line.clone()].trim();
    let mut found = None;
    let mut start = 0;
    for candidate in text[..line.start].split_inclusive('\n') {
        let trimmed = candidate.trim();
        let indent = candidate.len() - candidate.trim_start().len();
        if wanted.starts_with('[') {
            if before_comment(trimmed) == before_comment(wanted) {
                let within = span.start.checked_sub(line.start)?;
                return Some(start + within..start + within + written.len())
                    .filter(|range| text.get(range.clone()) == Some(written));
            }
        } else if trimmed.starts_with('[') {
            // Another table begins; what came before is not in this one.
            found = None;
        } else if found.is_none() && key(trimmed) == written && key(wanted) == written {
            found = Some(start + indent..start + indent + written.len());
        }
        start += candidate.len();
    }
    found
}

fn before_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or_default().trim()
}

fn key(line: &str) -> &str {
    line.split('=').next().unwrap_or_default().trim()
}

/// The line that holds `position`, without its line end.
fn line_around(text: &str, position: usize) -> Range<usize> {
    let position = position.min(text.len());
    let bytes = text.as_bytes();
    let is_end = |byte: &u8| *byte == b'\n';
    let start = bytes[..position]
        .iter()
        .rposition(is_end)
        .map_or(0, |found| found + 1);
    let length = bytes[position..].iter().position(is_end);
    start..length.map_or(text.len(), |length| position + length)
}

#[cfg(test)]
mod tests {
    use crate::input::diagnostic::Styling;
    use crate::input::document::Document;

    fn refusal(text: &str) -> String {
        match Document::parse("sweep.toml", text) {
            Ok(_) => "accepted".to_owned(),
            Err(diagnostics) => diagnostics.render(Styling::Plain),
        }
    }

    #[test]
    fn a_quantity_without_quotes_gets_its_line_with_quotes() {
        insta::assert_snapshot!(refusal("[drive]\nmean = 10 µN\ncontrol = load\n"), @r#"
        error: text must be in quotes
         --> sweep.toml:2:8
          |
        2 | mean = 10 µN
          |        ^^^^^ not a number, a boolean or quoted text
          |
          = help: write `mean = "10 µN"`

        error: text must be in quotes
         --> sweep.toml:3:11
          |
        3 | control = load
          |           ^^^^ not a number, a boolean or quoted text
          |
          = help: write `control = "load"`
        "#);
    }

    #[test]
    fn curly_quotes_are_mended_to_straight_ones() {
        insta::assert_snapshot!(refusal("mean = “10 N”\ncontrol = ‘load’ # x\n"), @r#"
        error: text must be in quotes
         --> sweep.toml:1:8
          |
        1 | mean = “10 N”
          |        ^^^^^^ curly quotes, which TOML does not read as quotes
          |
          = help: write `mean = "10 N"`

        error: text must be in quotes
         --> sweep.toml:2:11
          |
        2 | control = ‘load’ # x
          |           ^^^^^^ curly quotes, which TOML does not read as quotes
          |
          = help: write `control = "load"`
        "#);
    }

    #[test]
    fn the_empty_value_of_another_language_is_no_nan() {
        insta::assert_snapshot!(refusal("hold = None\nphase = null\nname = nylon\n"), @r#"
        error: `None` is no value
         --> sweep.toml:1:8
          |
        1 | hold = None
          |        ^^^^ TOML has no empty value
          |
          = help: leave the key out where it has no value

        error: `null` is no value
         --> sweep.toml:2:9
          |
        2 | phase = null
          |         ^^^^ TOML has no empty value
          |
          = help: leave the key out where it has no value

        error: text must be in quotes
         --> sweep.toml:3:8
          |
        3 | name = nylon
          |        ^^^^^ not a number, a boolean or quoted text
          |
          = help: write `name = "nylon"`
        "#);
    }

    #[test]
    fn a_missing_value_is_called_that() {
        insta::assert_snapshot!(refusal("[drive]\nmean =\nx = { from = 1, to = }\n"), @r#"
        error: a value is missing
         --> sweep.toml:2:7
          |
        2 | mean =
          |       ^ expected a value here

        error: a value is missing
         --> sweep.toml:3:22
          |
        3 | x = { from = 1, to = }
          |                      ^ expected a value here
        "#);
    }

    #[test]
    fn a_key_given_twice_is_shown_at_both_places() {
        insta::assert_snapshot!(refusal("[a]\nmean = 1\n[b]\nmean = 1\nmean = 2\n"), @r#"
        error: `mean` is given twice
         --> sweep.toml:5:1
          |
        4 | mean = 1
          | ---- the first time
        5 | mean = 2
          | ^^^^ the second time
          |
          = help: keep one of the two
        "#);
        insta::assert_snapshot!(refusal("x = { y = 1, y = 2 }\n"), @r#"
        error: `y` is given twice
         --> sweep.toml:1:14
          |
        1 | x = { y = 1, y = 2 }
          |              ^ the second time
          |
          = help: keep one of the two
        "#);
    }

    #[test]
    fn a_table_given_twice_is_one_problem() {
        let text = "[drive] # first\nmean = 1\nx = 2\n[drive]\nmean = 2\nx = 3\n";
        insta::assert_snapshot!(refusal(text), @r#"
        error: `drive` is given twice
         --> sweep.toml:4:2
          |
        1 | [drive] # first
          |  ----- the first time
        ...
        4 | [drive]
          |  ^^^^^ the second time
          |
          = help: keep one of the two
        "#);
    }

    #[test]
    fn an_open_string_header_or_key_is_shown_at_its_end() {
        insta::assert_snapshot!(refusal("[drive\nmean = \"10 N\nhold\n"), @r#"
        error: invalid TOML: unclosed table
         --> sweep.toml:1:7
          |
        1 | [drive
          |       ^ expected `]`

        error: invalid TOML: key with no value
         --> sweep.toml:3:5
          |
        3 | hold
          |     ^ expected `=`
        "#);
    }

    #[test]
    fn an_open_array_does_not_drag_the_rest_of_the_file_along() {
        insta::assert_snapshot!(refusal("a = [1, 2\nb = 3\n[c]\nd = 4\n"), @r#"
        error: invalid TOML: missing comma between array elements
         --> sweep.toml:2:1
          |
        2 | b = 3
          | ^ expected `,`
          |
          = help: close the array that was opened above with `]`, or add a comma
        "#);
    }

    #[test]
    fn a_decimal_comma_gets_a_point() {
        insta::assert_snapshot!(refusal("x = 1,5\r\n"), @r#"
        error: invalid TOML: unexpected key or value
         --> sweep.toml:1:6
          |
        1 | x = 1,5
          |      ^ expected newline, `#`
          |
          = help: write `x = 1.5`
        "#);
    }

    #[test]
    fn windows_line_ends_a_byte_order_mark_and_tabs_keep_line_and_column() {
        insta::assert_snapshot!(refusal("\u{feff}# µ\r\n\tb = c # d\r\n"), @r#"
        error: text must be in quotes
         --> sweep.toml:2:6
          |
        2 |     b = c # d
          |         ^ not a number, a boolean or quoted text
          |
          = help: write `b = "c"`
        "#);
        assert_eq!(
            refusal("\u{feff}a = 1\r\n\r\n[b]\r\nc = \"x\"\r\n"),
            "accepted"
        );
    }

    #[test]
    fn keys_too_deep_for_the_parser_are_refused() {
        let text = format!("[{}]\n", vec!["a"; 200].join("."));
        insta::assert_snapshot!(refusal(&text), @r#"
        error: invalid TOML: recursion limit
        --> sweep.toml
        "#);
        let text = format!("a = {}\n", "[".repeat(200));
        assert!(refusal(&text).starts_with("error: invalid TOML: "));
    }

    #[test]
    fn of_very_many_errors_the_first_are_explained_and_all_are_counted() {
        let text = "a = 1\n".repeat(10_001);
        let refusal = refusal(&text);
        assert!(refusal.ends_with("error: 10000 problems found; the first 20 are shown\n"));
    }

    #[test]
    fn other_errors_keep_the_words_of_toml() {
        insta::assert_snapshot!(refusal("x = 012\ny = 1.\n"), @r#"
        error: invalid TOML: unexpected leading zero
         --> sweep.toml:1:5
          |
        1 | x = 012
          |     ^

        error: invalid TOML: invalid fraction
         --> sweep.toml:2:7
          |
        2 | y = 1.
          |       ^ expected digits
        "#);
    }
}
