//! From the bytes of a data file to lines of cells: encodings, line ends, comments, delimiters, quotation marks.

use std::ops::Range;

use crate::input::diagnostic::Diagnostic;
use crate::input::document::not_utf8;
use crate::input::file_kind;

/// Delimiters in the order in which one hides another, each with its name. A blank stands for any run of white space.
pub(super) const DELIMITERS: [(char, &str); 5] = [
    (';', "semicolons"),
    ('\t', "tabs"),
    (',', "commas"),
    ('|', "vertical bars"),
    (' ', "blanks"),
];

/// The text of a file: UTF-8, or UTF-16 in either byte order; without a byte order mark, lines ended by `\n` or `\r\n`.
pub(super) fn decode(name: &str, bytes: &[u8]) -> Result<String, Diagnostic> {
    file_kind::refuse_binary(name, bytes)?;
    let text = match bytes {
        [0xff, 0xfe, rest @ ..] => utf_16(name, rest, u16::from_le_bytes)?,
        [0xfe, 0xff, rest @ ..] => utf_16(name, rest, u16::from_be_bytes)?,
        // Latin letters of UTF-16 without its mark.
        [letter, 0, ..] if *letter > 0 => utf_16(name, bytes, u16::from_le_bytes)?,
        [0, letter, ..] if *letter > 0 => utf_16(name, bytes, u16::from_be_bytes)?,
        _ => {
            let text = std::str::from_utf8(bytes)
                .map_err(|error| not_utf8(name, bytes, error.valid_up_to()))?;
            text.trim_start_matches('\u{feff}').to_owned()
        }
    };
    Ok(match text.contains('\n') {
        true => text,
        false => text.replace('\r', "\n"),
    })
}

/// The text of a file that an instrument wrote, and the number of bytes that are no UTF-8: those are taken as letters of Latin-1, one
/// by one, so that a stray byte does not change how the others are read.
pub(super) fn decode_instrument(name: &str, bytes: &[u8]) -> Result<(String, usize), Diagnostic> {
    file_kind::refuse_binary(name, bytes)?;
    let is_utf_16 = matches!(bytes, [0xff, 0xfe, ..] | [0xfe, 0xff, ..])
        || matches!(bytes, [a, b, ..] if (*a == 0) != (*b == 0));
    if is_utf_16 || std::str::from_utf8(bytes).is_ok() {
        return Ok((decode(name, bytes)?, 0));
    }
    let (mut text, mut stray) = (String::with_capacity(bytes.len()), 0);
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().copied().map(char::from));
        stray += chunk.invalid().len();
    }
    Ok((decode(name, text.as_bytes())?, stray))
}

fn utf_16(name: &str, bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, Diagnostic> {
    let units = bytes
        .chunks(2)
        // A last half of a unit becomes a surrogate without its partner, which no text has.
        .map(|pair| <[u8; 2]>::try_from(pair).map_or(0xd800, unit));
    char::decode_utf16(units)
        .collect::<Result<_, _>>()
        .map_err(|_| {
            Diagnostic::new(format!("`{name}` is not the UTF-16 text that it begins as"))
                .help("save it again, best as UTF-8")
        })
}

/// Goes through the lines of a text that are neither empty nor comments.
#[derive(Clone)]
pub(super) struct Lines<'a> {
    pub(super) text: &'a str,
    pub(super) position: usize,
}

impl Lines<'_> {
    /// Where the next line begins, passing over empty ones and comments.
    pub(super) fn start(&mut self) -> Option<usize> {
        while let Some(rest) = self
            .text
            .get(self.position..)
            .filter(|rest| !rest.is_empty())
        {
            let line = rest.split('\n').next().unwrap_or_default();
            if !matches!(line.trim_start().bytes().next(), None | Some(b'#')) {
                return Some(self.position);
            }
            self.position += line.len() + 1;
        }
        None
    }

    /// The cells of the next line, without the blanks and quotation marks around them, and where the line begins. Between quotation
    /// marks delimiters and line ends are text.
    pub(super) fn cells(
        &mut self,
        delimiter: char,
        cells: &mut Vec<Range<usize>>,
    ) -> Option<usize> {
        let start = self.start()?;
        self.position = cells_from(self.text, start, delimiter, cells);
        Some(start)
    }
}

/// Cuts the line that begins at `start` into cells; where the next one begins.
pub(super) fn cells_from(
    text: &str,
    start: usize,
    delimiter: char,
    cells: &mut Vec<Range<usize>>,
) -> usize {
    cells.clear();
    let bytes = text.as_bytes();
    let byte = |at: usize| bytes.get(at).copied().unwrap_or(b'\n');
    let is_blank = |byte: u8| matches!(byte, b' ' | b'\t' | b'\r') && char::from(byte) != delimiter;
    let after_blanks = |from: usize| (from..).find(|at| !is_blank(byte(*at))).unwrap_or(from);
    let ends = |byte: u8| {
        byte == b'\n' || char::from(byte) == delimiter || (delimiter == ' ' && byte == b'\t')
    };
    let mut at = start;
    loop {
        if delimiter == ' ' {
            // Any number of blanks is one delimiter, and none at the ends of a line.
            at = (at..)
                .find(|at| !matches!(byte(*at), b' ' | b'\t' | b'\r'))
                .unwrap_or(at);
            if byte(at) == b'\n' && !cells.is_empty() {
                return (at + 1).min(text.len());
            }
        } else {
            at = after_blanks(at);
        }
        let quoted = (byte(at) == b'"').then(|| closing(bytes, at + 1)).flatten();
        let quoted = quoted.filter(|close| ends(byte(after_blanks(close + 1))));
        let (cell, end) = match quoted {
            Some(close) => (at + 1..close, after_blanks(close + 1)),
            None => {
                let end = (at..).find(|at| ends(byte(*at))).unwrap_or(at);
                (at..end.min(text.len()), end)
            }
        };
        let inside = &text[cell.clone()];
        let from = cell.start + (inside.len() - inside.trim_start().len());
        cells.push(from..from + inside.trim().len());
        if byte(end) == b'\n' {
            return (end + 1).min(text.len());
        }
        at = end + 1;
    }
}

/// The quotation mark that closes a cell; two of them stand for one within it.
fn closing(bytes: &[u8], from: usize) -> Option<usize> {
    let mut at = from;
    loop {
        at += bytes.get(at..)?.iter().position(|byte| *byte == b'"')?;
        if bytes.get(at + 1) != Some(&b'"') {
            return Some(at);
        }
        at += 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(text: &str, delimiter: char) -> Vec<Vec<&str>> {
        let (mut lines, mut cells, mut rows) =
            (Lines { text, position: 0 }, Vec::new(), Vec::new());
        while lines.cells(delimiter, &mut cells).is_some() {
            rows.push(cells.iter().map(|cell| &text[cell.clone()]).collect());
        }
        rows
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
    fn every_encoding_gives_the_same_text() {
        let text = "time [µs]\n1\n";
        let units: Vec<u16> = text.encode_utf16().collect();
        let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        for bytes in [
            text.as_bytes().to_vec(),
            [b"\xef\xbb\xbf", text.as_bytes()].concat(),
            [b"\xff\xfe", little.as_slice()].concat(),
            [b"\xfe\xff", big.as_slice()].concat(),
            little.clone(),
            big,
        ] {
            assert_eq!(decode("a", &bytes).unwrap(), text);
        }
        assert_eq!(decode("a", b"x\ry\r").unwrap(), "x\ny\n");
        assert!(decode("a", &little[..little.len() - 1]).is_err());
        assert!(decode("a", b"\xff\xfe\x00\xd8").is_err());
    }
}
