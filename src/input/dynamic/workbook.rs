//! Workbooks for tests: the least that `.xlsx` (zip of XML, ECMA-376) and `.xls` (BIFF8 in a compound file, MS-XLS and MS-CFB) need.

use std::io::{Cursor, Write as _};

use zip::write::SimpleFileOptions;

/// A sheet: its name and its rows. Cells that read as numbers are numbers.
pub(super) type Sheet<'a> = (&'a str, Vec<Vec<&'a str>>);

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

/// A workbook `.xlsx`.
pub(super) fn xlsx(sheets: &[Sheet<'_>]) -> Vec<u8> {
    let relation = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let spreadsheet = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let package = "http://schemas.openxmlformats.org/package/2006";
    let numbered = || (1..).zip(sheets);
    let list: String = numbered()
        .map(|(id, (name, _))| {
            format!(
                "<sheet name=\"{}\" sheetId=\"{id}\" r:id=\"r{id}\"/>",
                escaped(name)
            )
        })
        .collect();
    let relations: String = numbered()
        .map(|(id, _)| format!("<Relationship Id=\"r{id}\" Type=\"{relation}/worksheet\" Target=\"worksheets/sheet{id}.xml\"/>"))
        .collect();
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let mut add = |name: &str, text: &str| {
        let stored =
            SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
        archive.start_file(name, stored).unwrap();
        archive.write_all(text.as_bytes()).unwrap();
    };
    add(
        "[Content_Types].xml",
        &format!("<Types xmlns=\"{package}/content-types\"/>"),
    );
    add(
        "_rels/.rels",
        &format!(
            "<Relationships xmlns=\"{package}/relationships\"><Relationship Id=\"r1\" Type=\"{relation}/officeDocument\" \
             Target=\"xl/workbook.xml\"/></Relationships>"
        ),
    );
    add(
        "xl/workbook.xml",
        &format!(
            "<workbook xmlns=\"{spreadsheet}\" xmlns:r=\"{relation}\"><sheets>{list}</sheets></workbook>"
        ),
    );
    add(
        "xl/_rels/workbook.xml.rels",
        &format!("<Relationships xmlns=\"{package}/relationships\">{relations}</Relationships>"),
    );
    for (id, (_, rows)) in numbered() {
        let rows: String = (1..)
            .zip(rows)
            .map(|(row, cells)| xlsx_row(row, cells))
            .collect();
        add(
            &format!("xl/worksheets/sheet{id}.xml"),
            &format!(
                "<worksheet xmlns=\"{spreadsheet}\"><sheetData>{rows}</sheetData></worksheet>"
            ),
        );
    }
    archive.finish().unwrap().into_inner()
}

fn xlsx_row(row: usize, cells: &[&str]) -> String {
    let cell = |(column, cell): (char, &&str)| match cell.parse::<f64>() {
        Ok(number) => format!("<c r=\"{column}{row}\"><v>{number}</v></c>"),
        Err(_) => format!(
            "<c r=\"{column}{row}\" t=\"inlineStr\"><is><t>{}</t></is></c>",
            escaped(cell)
        ),
    };
    let cells = ('A'..).zip(cells).filter(|(_, cell)| !cell.is_empty());
    let cells: String = cells.map(cell).collect();
    format!("<row r=\"{row}\">{cells}</row>")
}

/// A workbook `.xls`.
pub(super) fn xls(sheets: &[Sheet<'_>]) -> Vec<u8> {
    let record = |kind: u16, data: &[u8]| {
        [
            &kind.to_le_bytes(),
            &u16::try_from(data.len()).unwrap().to_le_bytes(),
            data,
        ]
        .concat()
    };
    let begin = |what: u8| record(0x809, &[0, 6, what, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    let end = record(0x0a, &[]);
    let letters = |text: &str| {
        text.encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect::<Vec<u8>>()
    };
    let body = |rows: &[Vec<&str>]| {
        let mut sheet = begin(0x10);
        for (row, cells) in rows.iter().enumerate() {
            for (column, cell) in cells
                .iter()
                .enumerate()
                .filter(|(_, cell)| !cell.is_empty())
            {
                let place = [row, column, 0]
                    .map(|n| u16::try_from(n).unwrap().to_le_bytes())
                    .concat();
                let count = u16::try_from(cell.encode_utf16().count())
                    .unwrap()
                    .to_le_bytes();
                sheet.extend(match cell.parse::<f64>() {
                    Ok(number) => record(0x203, &[place, number.to_le_bytes().to_vec()].concat()),
                    Err(_) => record(
                        0x204,
                        &[place, count.to_vec(), vec![1], letters(cell)].concat(),
                    ),
                });
            }
        }
        [sheet, end.clone()].concat()
    };
    let entry = |name: &str, at: u32| {
        let count = u8::try_from(name.encode_utf16().count()).unwrap();
        record(
            0x85,
            &[
                at.to_le_bytes().to_vec(),
                vec![0, 0, count, 1],
                letters(name),
            ]
            .concat(),
        )
    };
    let head = begin(5);
    let globals = head.len()
        + end.len()
        + sheets
            .iter()
            .map(|(name, _)| entry(name, 0).len())
            .sum::<usize>();
    let (mut entries, mut bodies) = (Vec::new(), Vec::new());
    for (name, rows) in sheets {
        entries.extend(entry(name, u32::try_from(globals + bodies.len()).unwrap()));
        bodies.extend(body(rows));
    }
    compound_file([head, entries, end, bodies].concat())
}

/// A compound file with the one stream `Workbook`, in sectors of 512 bytes.
fn compound_file(mut stream: Vec<u8>) -> Vec<u8> {
    // Shorter streams are kept elsewhere.
    stream.resize(stream.len().max(4096), 0);
    let empty = Cursor::new(Vec::new());
    let mut file = cfb::CompoundFile::create_with_version(cfb::Version::V3, empty).unwrap();
    let mut workbook = file.create_stream("/Workbook").unwrap();
    workbook.write_all(&stream).unwrap();
    workbook.flush().unwrap();
    drop(workbook);
    file.into_inner().into_inner()
}
