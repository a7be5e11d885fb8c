//! From the bytes of a data file to lines of cells: encodings, line ends, comments, delimiters, quotation marks.

use std::ops::Range;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE};

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
    let (text, stray) = decode_instrument(name, bytes)?;
    match std::str::from_utf8(bytes) {
        Err(error) if stray > 0 => Err(not_utf8(name, bytes, error.valid_up_to())),
        _ => Ok(text),
    }
}

/// The text of a file that an instrument wrote, and the number of bytes that are no UTF-8: those are taken as letters of Latin-1, one
/// by one, so that a stray byte does not change how the others are read.
pub(super) fn decode_instrument(name: &str, bytes: &[u8]) -> Result<(String, usize), Diagnostic> {
    file_kind::refuse_binary(name, bytes)?;
    let marked = Encoding::for_bom(bytes).map(|(encoding, _)| encoding);
    let encoding = match bytes {
        // Latin letters of UTF-16 without its mark.
        [letter, 0, ..] if *letter > 0 => UTF_16LE,
        [0, letter, ..] if *letter > 0 => UTF_16BE,
        _ => marked.unwrap_or(UTF_8),
    };
    let (text, stray) = match encoding == UTF_8 {
        true => latin_1_where_no_utf_8(bytes),
        false => {
            let (text, is_broken) = encoding.decode_with_bom_removal(bytes);
            if is_broken {
                let message = format!("`{name}` is not the UTF-16 text that it begins as");
                return Err(Diagnostic::new(message).help("save it again, best as UTF-8"));
            }
            (text.into_owned(), 0)
        }
    };
    let text = text.trim_start_matches('\u{feff}');
    Ok(match text.contains('\n') {
        true => (text.to_owned(), stray),
        false => (text.replace('\r', "\n"), stray),
    })
}

fn latin_1_where_no_utf_8(bytes: &[u8]) -> (String, usize) {
    let (mut text, mut stray) = (String::with_capacity(bytes.len()), 0);
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().copied().map(char::from));
        stray += chunk.invalid().len();
    }
    (text, stray)
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
