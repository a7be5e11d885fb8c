//! Where a picture comes from, written into the picture: `<metadata>` of an SVG, `tEXt` of a PNG, a comment in a PDF.

use std::borrow::Cow;

/// Says which program made a file from which sweep. The same for the same results: no time, no place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stamp {
    sweep_hash: String,
}

const PROGRAM: &str = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));

/// Signature, and the header chunk that comes first in every PNG.
const PNG_SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
const PNG_HEAD_BYTES: usize = 33;
/// What opens the last lines of every PDF.
const PDF_END: &[u8] = b"startxref";

impl Stamp {
    /// The stamp of a sweep's pictures.
    pub fn of(sweep_hash: &str) -> Self {
        Self {
            sweep_hash: sweep_hash.to_owned(),
        }
    }

    /// A file's bytes with the stamp in them; what is no picture stays as it is.
    pub fn on<'a>(&self, name: &str, bytes: &'a [u8]) -> Cow<'a, [u8]> {
        let stamped = if name.ends_with(".svg") {
            self.on_svg(bytes)
        } else if name.ends_with(".png") {
            self.on_png(bytes)
        } else if name.ends_with(".pdf") {
            self.on_pdf(bytes)
        } else {
            None
        };
        stamped.map_or(Cow::Borrowed(bytes), Cow::Owned)
    }

    fn on_svg(&self, bytes: &[u8]) -> Option<Vec<u8>> {
        let root = bytes.windows(4).position(|tag| tag == b"<svg")?;
        let end = root + bytes[root..].iter().position(|byte| *byte == b'>')? + 1;
        let (head, rest) = bytes.split_at(end);
        // Program, version and a hexadecimal hash: nothing that XML would have to escape.
        let metadata = format!(
            "<metadata>{PROGRAM}, sweep sha256 {}</metadata>",
            self.sweep_hash
        );
        Some([head, metadata.as_bytes(), rest].concat())
    }

    fn on_png(&self, bytes: &[u8]) -> Option<Vec<u8>> {
        let (head, rest) = bytes.split_at_checked(PNG_HEAD_BYTES)?;
        if !head.starts_with(PNG_SIGNATURE) {
            return None;
        }
        let software = text_chunk("Software", PROGRAM);
        let source = text_chunk("Source", &format!("sweep sha256 {}", self.sweep_hash));
        Some([head, &software, &source, rest].concat())
    }

    /// Behind the trailer, where no offset of the file counts past it.
    fn on_pdf(&self, bytes: &[u8]) -> Option<Vec<u8>> {
        let end = bytes
            .windows(PDF_END.len())
            .rposition(|word| word == PDF_END)?;
        let (objects, end) = bytes.split_at(end);
        let comment = format!("% {PROGRAM}, sweep sha256 {}\n", self.sweep_hash);
        Some([objects, comment.as_bytes(), end].concat())
    }
}

/// A `tEXt` chunk: length, type, keyword, zero, text, CRC.
fn text_chunk(keyword: &str, text: &str) -> Vec<u8> {
    let data = [b"tEXt", keyword.as_bytes(), b"\0", text.as_bytes()].concat();
    let length = u32::try_from(data.len() - 4).unwrap_or(0);
    let crc = crc32(&data);
    [&length.to_be_bytes()[..], &data, &crc.to_be_bytes()].concat()
}

/// The CRC of the PNG specification, annex D, bit by bit: the texts are short.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32| match crc & 1 {
        1 => 0xedb8_8320 ^ (crc >> 1),
        _ => crc >> 1,
    };
    let all = bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| step(crc))
    });
    !all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crc_is_that_of_the_specification() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
        assert_eq!(crc32(b"IEND"), 0xae42_6082);
    }

    #[test]
    fn a_stamped_png_is_still_read_and_says_where_it_comes_from() {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&[1, 2, 3]).unwrap();
        writer.finish().unwrap();
        let stamped = Stamp::of("abc").on("a.png", &bytes).into_owned();
        let decoder = png::Decoder::new(std::io::Cursor::new(&stamped));
        let reader = decoder.read_info().unwrap();
        let texts = &reader.info().uncompressed_latin1_text;
        assert_eq!(texts[0].text, PROGRAM);
        assert_eq!(texts[1].text, "sweep sha256 abc");
    }

    #[test]
    fn a_stamped_svg_has_metadata_first_and_other_files_stay_as_they_are() {
        let stamp = Stamp::of("abc");
        let svg = stamp.on("a.svg", b"<svg width=\"1\"><title>t</title></svg>");
        let text = String::from_utf8(svg.into_owned()).unwrap();
        assert!(text.starts_with("<svg width=\"1\"><metadata>contact-dma "));
        assert!(text.ends_with("sweep sha256 abc</metadata><title>t</title></svg>"));
        let pdf = stamp.on("a.pdf", b"%PDF-1.7\ntrailer\nstartxref\n9\n%%EOF");
        let text = String::from_utf8(pdf.into_owned()).unwrap();
        assert!(
            text.starts_with("%PDF-1.7\ntrailer\n% contact-dma "),
            "{text}"
        );
        assert!(
            text.ends_with("sweep sha256 abc\nstartxref\n9\n%%EOF"),
            "{text}"
        );
        for (name, bytes) in [
            ("a.csv", &b"a,b"[..]),
            ("a.png", b"short"),
            ("a.svg", b""),
            ("a.pdf", b""),
        ] {
            assert_eq!(stamp.on(name, bytes), bytes);
        }
    }
}
