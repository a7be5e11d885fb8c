//! Errors of TOML's own grammar, in the words of somebody who writes sweep files.

use std::ops::Range;
use std::sync::Arc;

use toml::de::Error;
use toml_parser::lexer::Token;
use toml_parser::parser::{
    Event, EventKind, EventReceiver, RecursionGuard, parse_document, parse_value,
};
use toml_parser::{ErrorSink, Span};

use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, MAX_SHOWN, Source};

/// Bytes of a value up to which it is repeated in quotes as help.
const MAX_MENDED: usize = 60;

/// Tables and arrays within one another that `toml` follows.
const MAX_DEPTH: u32 = 80;

/// Quotation marks of text processors, which TOML does not know.
pub(in crate::input) const CURLY: [char; 8] = ['“', '”', '„', '‟', '‘', '’', '«', '»'];

/// What other languages write where there is no value.
const NO_VALUE: [&str; 5] = ["none", "null", "nil", "na", "undefined"];

/// A text as the grammar of TOML cuts it, whatever is wrong with it.
struct Pieces(Vec<Event>);

/// What stands at the place of an error.
#[derive(Clone, Copy, PartialEq)]
enum At {
    /// A key in itself right, which is there already.
    Key,
    /// A value left out.
    NoValue,
    /// A value that is a bare word.
    Word,
    Other,
}

/// An array or inline table around a place.
struct Container {
    is_array: bool,
    /// Whether it is closed nowhere, so that what follows is read wrongly.
    is_left_open: bool,
}

impl Pieces {
    fn of(text: &str, parse: fn(&[Token], &mut dyn EventReceiver, &mut dyn ErrorSink)) -> Self {
        let tokens = toml_parser::Source::new(text).lex().into_vec();
        let mut events = Vec::new();
        let mut receiver = RecursionGuard::new(&mut events, MAX_DEPTH);
        parse(&tokens, &mut receiver, &mut ());
        Self(events)
    }

    fn at(&self, span: &Range<usize>, written: &str) -> At {
        let first = (self.0).partition_point(|event| event.span().start() < span.start);
        let here = self.0.iter().skip(first);
        let mut here = here.take_while(|event| event.span().start() == span.start);
        let is_whole = |of: Span| of.end() == span.end;
        let is_sign = |c: char| c.is_ascii_digit() || "+-_.:".contains(c);
        let bare = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
        match here.find_map(|event| is_whole(event.span()).then_some(event.kind())) {
            Some(EventKind::SimpleKey) if written.starts_with(['"', '\'']) => At::Key,
            Some(EventKind::SimpleKey) if written.chars().all(bare) => At::Key,
            Some(EventKind::Scalar) if written.is_empty() => At::NoValue,
            Some(EventKind::Scalar) => match written.to_ascii_lowercase().as_str() {
                "true" | "false" => At::Other,
                number if number.chars().all(is_sign) => At::Other,
                _ => At::Word,
            },
            _ => At::Other,
        }
    }

    /// The innermost array or inline table around a place.
    fn around(&self, position: usize) -> Option<Container> {
        let mut open: Vec<&Event> = Vec::new();
        for event in &self.0 {
            match event.kind() {
                EventKind::ArrayOpen | EventKind::InlineTableOpen => open.push(event),
                EventKind::ArrayClose | EventKind::InlineTableClose => {
                    let opened = open.pop()?;
                    if opened.span().start() < position && event.span().end() >= position {
                        return Some(Container {
                            is_array: opened.kind() == EventKind::ArrayOpen,
                            is_left_open: event.span().is_empty(),
                        });
                    }
                }
                _ => {}
            }
        }
        None
    }
}

/// Every error that stands for itself: one for a line, none that only follow from an earlier one.
pub(super) fn explain_all(source: &Arc<Source>, errors: &[Error]) -> Diagnostics {
    let text = source.text();
    let pieces = Pieces::of(text, parse_document);
    let mut errors: Vec<(&Error, Range<usize>)> = (errors.iter())
        .map(|error| (error, error.span().unwrap_or_default()))
        .collect();
    errors.sort_by_key(|(_, span)| span.start);
    let mut told = Vec::new();
    let mut omitted = 0;
    let mut line = 0..0;
    let mut told_line = None;
    let mut in_repeated_table = false;
    for (error, span) in errors {
        if told.is_empty() || span.start > line.end {
            line = line_around(text, span.start);
        }
        let at = pieces.at(&span, text.get(span.clone()).unwrap_or_default());
        let is_header = text[line.clone()].trim_start().starts_with('[');
        if is_header || at != At::Key {
            in_repeated_table = is_header && at == At::Key;
        }
        // Keys written again below a header written again follow from the header.
        if told_line == Some(line.end) || (in_repeated_table && !is_header) {
            continue;
        }
        told_line = Some(line.end);
        // Explaining looks through the file, which would take long for a great many errors.
        if told.len() >= MAX_SHOWN {
            omitted += 1;
            continue;
        }
        told.push(explain(source, error, &pieces, 0));
        let around = pieces.around(span.start);
        if at == At::Other && around.is_some_and(|around| around.is_left_open) {
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
    let value = source.text().get(offset..).unwrap_or_default();
    let pieces = Pieces::of(value, parse_value);
    explain(source, error, &pieces, offset)
}

/// One error of the text that begins at `offset`, and of which these are the pieces.
fn explain(source: &Arc<Source>, error: &Error, pieces: &Pieces, offset: usize) -> Diagnostic {
    let (what, expected) = match error.message().split_once(", expected ") {
        Some((what, "nothing")) => (what, None),
        Some((what, expected)) => (what, Some(expected)),
        None => (error.message(), None),
    };
    let what = format!("invalid TOML: {what}");
    // Keys that are too deep are at no place.
    let Some(own) = error.span() else {
        return Diagnostic::at(&Location::whole(source), what);
    };
    let (text, span) = (source.text(), own.start + offset..own.end + offset);
    let place = Location::new(source, span.clone());
    let written = place.text();
    match pieces.at(&own, written) {
        At::Key => return given_twice(source, &place, &span),
        At::NoValue => {
            return Diagnostic::at(&place, "a value is missing").because("expected a value here");
        }
        At::Word if NO_VALUE.contains(&written.to_ascii_lowercase().as_str()) => {
            return Diagnostic::at(&place, format!("`{written}` is no value"))
                .because("TOML has no empty value")
                .help("leave the key out where it has no value");
        }
        At::Word => return unquoted(text, &place, &span),
        At::Other => {}
    }
    let problem = Diagnostic::at(&place, what);
    let problem = match expected {
        Some(expected) => problem.because(format!("expected {expected}")),
        None => problem,
    };
    let line = line_around(text, span.start);
    let before = text.get(line.start..span.start).unwrap_or_default();
    let opens_line = line.start > 0 && before.trim().is_empty();
    if let Some(mended) = decimal_comma(&text[line]) {
        return problem.help(format!("write `{mended}`"));
    }
    match pieces.around(own.start) {
        Some(around) if around.is_array && opens_line => {
            problem.help("close the array that was opened above with `]`, or add a comma")
        }
        _ => problem,
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
fn decimal_comma(line: &str) -> Option<String> {
    let (key, value) = line.split_once('=')?;
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
    let (before, after) = text.split_at(text.floor_char_boundary(position));
    let start = before.rfind('\n').map_or(0, |found| found + 1);
    start
        ..after
            .find('\n')
            .map_or(text.len(), |length| before.len() + length)
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
