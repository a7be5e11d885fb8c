//! Workbooks for tests: the least that `.xlsx` (zip of XML, ECMA-376) and `.xls` (BIFF8 in a compound file, MS-XLS and MS-CFB) need.

/// A sheet: its name and its rows. Cells that read as numbers are numbers.
pub(super) type Sheet<'a> = (&'a str, Vec<Vec<&'a str>>);

/// A workbook `.xlsx`.
pub(super) fn xlsx(sheets: &[Sheet<'_>]) -> Vec<u8> {
    let escaped = |text: &str| {
        text.replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('"', "&quot;")
    };
    let relation = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let spreadsheet = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let package = "http://schemas.openxmlformats.org/package/2006";
    let numbered = || {
        sheets
            .iter()
            .enumerate()
            .map(|(place, sheet)| (place + 1, sheet))
    };
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
    let mut files = vec![
        (
            "[Content_Types].xml".to_owned(),
            format!("<Types xmlns=\"{package}/content-types\"/>"),
        ),
        (
            "_rels/.rels".to_owned(),
            format!(
                "<Relationships xmlns=\"{package}/relationships\"><Relationship Id=\"r1\" Type=\"{relation}/officeDocument\" \
                 Target=\"xl/workbook.xml\"/></Relationships>"
            ),
        ),
        (
            "xl/workbook.xml".to_owned(),
            format!(
                "<workbook xmlns=\"{spreadsheet}\" xmlns:r=\"{relation}\"><sheets>{list}</sheets></workbook>"
            ),
        ),
        (
            "xl/_rels/workbook.xml.rels".to_owned(),
            format!("<Relationships xmlns=\"{package}/relationships\">{relations}</Relationships>"),
        ),
    ];
    for (id, (_, rows)) in numbered() {
        let mut text = format!("<worksheet xmlns=\"{spreadsheet}\"><sheetData>");
        for (row, cells) in rows.iter().enumerate() {
            text += &format!("<row r=\"{}\">", row + 1);
            for (column, cell) in cells
                .iter()
                .enumerate()
                .filter(|(_, cell)| !cell.is_empty())
            {
                let place = format!(
                    "{}{}",
                    char::from(b'A' + u8::try_from(column).unwrap()),
                    row + 1
                );
                text += &match cell.parse::<f64>() {
                    Ok(number) => format!("<c r=\"{place}\"><v>{number}</v></c>"),
                    Err(_) => format!(
                        "<c r=\"{place}\" t=\"inlineStr\"><is><t>{}</t></is></c>",
                        escaped(cell)
                    ),
                };
            }
            text += "</row>";
        }
        files.push((
            format!("xl/worksheets/sheet{id}.xml"),
            text + "</sheetData></worksheet>",
        ));
    }
    zip(&files)
}

/// A zip archive of files that are stored as they are.
fn zip(files: &[(String, String)]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, text) in files {
        let start = u32::try_from(bytes.len()).unwrap();
        let (size, length) = (
            u32::try_from(text.len()).unwrap(),
            u16::try_from(name.len()).unwrap(),
        );
        let mut head = vec![20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0x50];
        head.extend(crc_32(text.as_bytes()).to_le_bytes());
        head.extend([size.to_le_bytes(), size.to_le_bytes()].concat());
        head.extend([length.to_le_bytes(), [0, 0]].concat());
        bytes.extend(
            [
                b"PK\x03\x04",
                head.as_slice(),
                name.as_bytes(),
                text.as_bytes(),
            ]
            .concat(),
        );
        directory.extend(
            [
                b"PK\x01\x02\x14\x00",
                head.as_slice(),
                &[0; 10],
                &start.to_le_bytes(),
                name.as_bytes(),
            ]
            .concat(),
        );
    }
    let count = u16::try_from(files.len()).unwrap().to_le_bytes();
    let (at, length) = (
        u32::try_from(bytes.len()).unwrap(),
        u32::try_from(directory.len()).unwrap(),
    );
    bytes.extend(directory);
    bytes.extend(
        [
            b"PK\x05\x06\0\0\0\0".as_slice(),
            &count,
            &count,
            &length.to_le_bytes(),
            &at.to_le_bytes(),
            &[0, 0],
        ]
        .concat(),
    );
    bytes
}

fn crc_32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| {
            (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg())
        })
    })
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
    compound_file(&[head, entries, end, bodies].concat())
}

/// A compound file with the one stream `Workbook`, in sectors of 512 bytes: the table of sectors, the directory, the stream.
fn compound_file(stream: &[u8]) -> Vec<u8> {
    const SECTOR: usize = 512;
    let last = 0xffff_fffe_u32;
    // Shorter streams are kept elsewhere.
    let mut stream = stream.to_vec();
    stream.resize(stream.len().max(4096).div_ceil(SECTOR) * SECTOR, 0);
    let sectors = u32::try_from(stream.len() / SECTOR).unwrap();
    assert!(
        sectors + 2 <= 128,
        "one sector of the table is enough for tests"
    );
    let mut table: Vec<u32> = vec![0xffff_fffd, last];
    table.extend((3..sectors + 2).chain([last]));
    table.resize(128, u32::MAX);
    let mut header = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1".to_vec();
    header.extend([0; 16]);
    header.extend([0x3e, 0, 3, 0, 0xfe, 0xff, 9, 0, 6, 0, 0, 0, 0, 0, 0, 0]);
    header.extend(
        [0, 1, 1, 0, 4096, last, 0, last, 0, 0]
            .iter()
            .flat_map(|n: &u32| n.to_le_bytes()),
    );
    header.resize(SECTOR, 0xff);
    let directory = |name: &str, kind: u8, child: u32, start: u32, size: u32| {
        let mut entry: Vec<u8> = name.encode_utf16().flat_map(u16::to_le_bytes).collect();
        entry.resize(64, 0);
        entry.extend(u16::try_from(2 * name.len() + 2).unwrap().to_le_bytes());
        entry.extend([kind, 1]);
        entry.extend(
            [u32::MAX, u32::MAX, child]
                .iter()
                .flat_map(|n| n.to_le_bytes()),
        );
        entry.resize(116, 0);
        entry.extend([start, size, 0].iter().flat_map(|n| n.to_le_bytes()));
        entry
    };
    let size = u32::try_from(stream.len()).unwrap();
    let mut entries = [
        directory("Root Entry", 5, 1, last, 0),
        directory("Workbook", 2, u32::MAX, 2, size),
    ]
    .concat();
    entries.resize(SECTOR, 0);
    let table: Vec<u8> = table.iter().flat_map(|n| n.to_le_bytes()).collect();
    [header, table, entries, stream].concat()
}
