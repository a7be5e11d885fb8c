//! What a file is that is not the text which was expected, by its first bytes or by the names in its archive: for messages alone.

use std::io::Cursor;

use super::diagnostic::Diagnostic;

/// First bytes, what a file is that begins with them, and how its data come into a text file.
const BEGINNINGS: [(&[u8], &str, &str); 12] = [
    (
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "a workbook of an older Excel (.xls), or another file of Microsoft Office",
        SAVE_SHEET,
    ),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file", EXPORT),
    (
        b"\x93NUMPY",
        "a NumPy array (.npy)",
        "write it as text: numpy.savetxt",
    ),
    (
        b"MATLAB 5.0 MAT-file",
        "a MATLAB file (.mat)",
        "write it as text: writematrix",
    ),
    (b"SQLite format 3\0", "an SQLite database", EXPORT),
    (b"%PDF-", "a PDF document", EXPORT),
    (
        b"\x1f\x8b",
        "a file compressed by gzip",
        "decompress it: gunzip",
    ),
    (b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive", UNPACK),
    (b"\\*File list", "a file of a Bruker NanoScope", EXPORT),
    (
        b"\\*Force file list",
        "a force curve of a Bruker NanoScope",
        EXPORT,
    ),
    (b"\x05\0\x01", "a wave of Igor Pro (.ibw)", AS_CURVE),
    (b"PAR1", "a Parquet file", EXPORT),
];

/// A name in a ZIP archive, and the same of archives that have it.
const IN_ARCHIVE: [(&str, &str, &str); 4] = [
    ("xl/workbook.xml", "an Excel workbook (.xlsx)", SAVE_SHEET),
    (
        "header.properties",
        "a force curve or map of JPK instruments",
        AS_CURVE,
    ),
    ("word/document.xml", "a Word document (.docx)", EXPORT),
    ("content.xml", "an OpenDocument file", SAVE_SHEET),
];

const SAVE_SHEET: &str = "save the sheet of the data as CSV";
const EXPORT: &str = "export the data as text or CSV from the program that wrote it";
const AS_CURVE: &str =
    "name it in an identification file, `[identify]` with `curve`: `identify` reads force curves";
const UNPACK: &str = "unpack it, and name the file in it";

/// Refuses bytes that are a known kind of file other than text, saying what they are.
///
/// # Errors
/// Such a file.
pub(super) fn refuse_binary(name: &str, bytes: &[u8]) -> Result<(), Diagnostic> {
    match of(bytes) {
        Some((what, help)) => {
            Err(Diagnostic::new(format!("`{name}` is {what}, not a text file")).help(help))
        }
        None => Ok(()),
    }
}

/// What the bytes are, and what to do with such a file; `None`: nothing that is known.
pub(super) fn of(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    if bytes.starts_with(b"PK\x03\x04") {
        let archive = zip::ZipArchive::new(Cursor::new(bytes)).ok();
        let has = |name: &str| {
            archive
                .as_ref()
                .is_some_and(|a| a.index_for_name(name).is_some())
        };
        let known = IN_ARCHIVE.iter().find(|(name, ..)| has(name));
        return Some(known.map_or(("a ZIP archive", UNPACK), |(_, what, help)| (what, help)));
    }
    let known = BEGINNINGS
        .iter()
        .find(|(first, ..)| bytes.starts_with(first));
    known.map(|(_, what, help)| (*what, *help))
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;
    use crate::input::diagnostic::{Diagnostics, Styling};

    fn archive(name: &str) -> Vec<u8> {
        let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
        let options = zip::write::SimpleFileOptions::default();
        archive.start_file(name, options).unwrap();
        archive.write_all(b"x").unwrap();
        archive.finish().unwrap().into_inner()
    }

    #[test]
    fn a_file_that_is_no_text_is_called_what_it_is() {
        for (bytes, said) in [
            (archive("xl/workbook.xml"), "an Excel workbook"),
            (archive("header.properties"), "JPK"),
            (archive("notes.txt"), "a ZIP archive"),
            (b"PK\x03\x04 broken".to_vec(), "a ZIP archive"),
            (b"\x89HDF\r\n\x1a\n\0".to_vec(), "HDF5"),
            (b"\x05\0\x01\x02".to_vec(), "Igor"),
        ] {
            let refused = refuse_binary("a.dat", &bytes).unwrap_err();
            let text = Diagnostics::from(refused).render(Styling::Plain);
            assert!(text.contains(said) && text.contains("help"), "{text}");
        }
        assert!(refuse_binary("a.csv", b"time_s,load_n\n1,2\n").is_ok());
    }
}
