//! A file to which records are appended, each sealed on its own, so that what is torn or altered is known and costs nothing else.
//!
//! A frame is a mark of eight bytes, the length of the content (four bytes, little endian), the SHA-256 of length and content, and the
//! content. A reader that meets anything else goes on at the next mark.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use sha2::{Digest, Sha256};

const MARK: &[u8; 8] = b"\xc7dma\r\n\x1a\x01";
const HASH_BYTES: usize = 32;
const HEAD_BYTES: usize = MARK.len() + 4 + HASH_BYTES;
/// Appended records reach the disk at least this often; a process that is killed loses none of them, a machine that loses its power
/// those of this time.
const SYNC: Duration = Duration::from_secs(1);
/// Bytes read at once.
const CHUNK: usize = 1 << 20;

/// A file open for appending, which no other process appends to.
#[derive(Debug)]
pub struct SegmentWriter {
    path: PathBuf,
    file: File,
    length: u64,
    synced: Instant,
}

impl SegmentWriter {
    /// Creates a file in a folder that is there.
    ///
    /// # Errors
    /// Of the file system, and where there is a file of this name.
    pub fn create(path: &Path) -> io::Result<Self> {
        let file = OpenOptions::new()
            .append(true)
            .create_new(true)
            .open(path)?;
        Ok(Self {
            path: path.to_path_buf(),
            file,
            length: 0,
            synced: Instant::now(),
        })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends a record; where its content then begins. What cannot be written whole is taken back.
    ///
    /// # Errors
    /// Of the file system.
    pub fn append(&mut self, content: &[u8]) -> io::Result<u64> {
        let frame = sealed(content)?;
        if let Err(error) = self.file.write_all(&frame) {
            // Should this fail too, the next reader finds a torn frame.
            let _ = self.file.set_len(self.length);
            return Err(error);
        }
        let content_at = self.length + HEAD_BYTES as u64;
        self.length += frame.len() as u64;
        if self.synced.elapsed() >= SYNC {
            self.file.sync_data()?;
            self.synced = Instant::now();
        }
        Ok(content_at)
    }

    /// Where the file ends.
    pub fn length(&self) -> u64 {
        self.length
    }
}

impl Drop for SegmentWriter {
    fn drop(&mut self) {
        // Records are in the system's hands by now, which most often is enough.
        let _ = self.file.sync_data();
    }
}

/// The frame of a record.
///
/// # Errors
/// Of a record above 4 GB.
pub fn sealed(content: &[u8]) -> io::Result<Vec<u8>> {
    let length = u32::try_from(content.len())
        .map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "a record above 4 GB"))?;
    let mut frame = Vec::with_capacity(HEAD_BYTES + content.len());
    frame.extend_from_slice(MARK);
    frame.extend_from_slice(&length.to_le_bytes());
    frame.extend_from_slice(&hash(length, content));
    frame.extend_from_slice(content);
    Ok(frame)
}

/// What a reader meets in a file.
#[derive(Debug, PartialEq, Eq)]
pub enum Met<'a> {
    /// The content of a record, and where it begins.
    Record { at: u64, content: &'a [u8] },
    /// Bytes from one place to another that are no record.
    Damaged { from: u64, to: u64 },
}

/// Reads a file from a place on and says what it meets; where the last record ends, which is where another reading goes on. Bytes behind
/// that may be a record that is being written, or was when its process was killed.
///
/// # Errors
/// Of the file system.
pub fn read(path: &Path, from: u64, mut meet: impl FnMut(Met<'_>)) -> io::Result<u64> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(from))?;
    // What was read and not understood yet, of which the first byte stands here in the file.
    let (mut window, mut start) = (Vec::new(), from);
    let mut damaged: Option<u64> = None;
    let mut ended = false;
    let mut whole_to = from;
    loop {
        let mut at = 0;
        loop {
            let place = start + at as u64;
            match frame(&window[at..]) {
                Frame::Whole(length) => {
                    if let Some(from) = damaged.take() {
                        meet(Met::Damaged { from, to: place });
                    }
                    let content = &window[at + HEAD_BYTES..at + HEAD_BYTES + length];
                    let at_byte = place + HEAD_BYTES as u64;
                    meet(Met::Record {
                        at: at_byte,
                        content,
                    });
                    at += HEAD_BYTES + length;
                    whole_to = start + at as u64;
                }
                Frame::Other => {
                    damaged.get_or_insert(place);
                    at += 1 + next_mark(&window[at + 1..]);
                }
                Frame::Short if ended && at < window.len() => {
                    // A length that lies looks like the end: a record may follow.
                    damaged.get_or_insert(place);
                    at += 1 + next_mark(&window[at + 1..]);
                }
                Frame::Short => break,
            }
        }
        window.drain(..at);
        start += at as u64;
        if ended {
            return Ok(whole_to);
        }
        let before = window.len();
        // A long record is read in as many steps as doubling takes.
        let more = CHUNK.max(before) as u64;
        (&mut file).take(more).read_to_end(&mut window)?;
        ended = window.len() == before;
    }
}

/// The content at a place that [`read`] or [`SegmentWriter::append`] has named.
///
/// # Errors
/// Of the file system.
pub fn content(path: &Path, at: u64, length: usize) -> io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(at))?;
    let mut content = vec![0; length];
    file.read_exact(&mut content)?;
    Ok(content)
}

enum Frame {
    /// With so many bytes of content.
    Whole(usize),
    /// It may become one with more bytes.
    Short,
    Other,
}

fn frame(bytes: &[u8]) -> Frame {
    let mark = &MARK[..bytes.len().min(MARK.len())];
    if !bytes.starts_with(mark) {
        return Frame::Other;
    }
    let Some((head, rest)) = bytes.split_at_checked(HEAD_BYTES) else {
        return Frame::Short;
    };
    let (length, sum) = head[MARK.len()..].split_at(4);
    let length = u32::from_le_bytes([length[0], length[1], length[2], length[3]]);
    match rest.get(..length as usize) {
        None => Frame::Short,
        Some(content) if hash(length, content) == sum => Frame::Whole(content.len()),
        Some(_) => Frame::Other,
    }
}

fn hash(length: u32, content: &[u8]) -> [u8; HASH_BYTES] {
    let mut hash = Sha256::new();
    hash.update(length.to_le_bytes());
    hash.update(content);
    hash.finalize().into()
}

/// Bytes before the next mark, or before what may be the beginning of one.
fn next_mark(bytes: &[u8]) -> usize {
    let mut at = 0;
    while let Some(found) = bytes[at..].iter().position(|byte| *byte == MARK[0]) {
        at += found;
        let end = bytes.len().min(at + MARK.len());
        if MARK.starts_with(&bytes[at..end]) {
            return at;
        }
        at += 1;
    }
    bytes.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contents() -> Vec<Vec<u8>> {
        // One of them holds a mark.
        let with_mark = [b"before".as_slice(), MARK, b"behind"].concat();
        vec![b"first".to_vec(), with_mark, Vec::new(), vec![7; 100]]
    }

    fn write(path: &Path) -> Vec<u8> {
        let mut writer = SegmentWriter::create(path).unwrap();
        for content in contents() {
            let at = writer.append(&content).unwrap();
            assert_eq!(super::content(path, at, content.len()).unwrap(), content);
        }
        std::fs::read(path).unwrap()
    }

    /// Records and damage, and where reading went on to.
    fn met(path: &Path) -> (Vec<Vec<u8>>, Vec<(u64, u64)>, u64) {
        let (mut records, mut damage) = (Vec::new(), Vec::new());
        let end = read(path, 0, |met| match met {
            Met::Record { content, .. } => records.push(content.to_vec()),
            Met::Damaged { from, to } => damage.push((from, to)),
        });
        (records, damage, end.unwrap())
    }

    #[test]
    fn every_flipped_byte_costs_one_record_and_is_named_or_is_the_end() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.segment");
        let whole = write(&path);
        let (records, damage, end) = met(&path);
        assert_eq!((records, damage), (contents(), vec![]));
        assert_eq!(end, whole.len() as u64);
        let last = whole.len() - 100 - HEAD_BYTES;
        for byte in 0..whole.len() {
            let mut changed = whole.clone();
            changed[byte] ^= 0x41;
            std::fs::write(&path, &changed).unwrap();
            let (records, damage, end) = met(&path);
            assert_eq!(records.len(), 3, "byte {byte}");
            assert!(records.iter().all(|record| contents().contains(record)));
            match byte < last {
                true => assert_eq!(damage.len(), 1, "byte {byte}"),
                false => assert_eq!(end, last as u64, "byte {byte}"),
            }
        }
    }

    #[test]
    fn a_torn_end_is_left_for_a_later_reading() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.segment");
        let whole = write(&path);
        let last = whole.len() - 100 - HEAD_BYTES;
        for length in last..whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            let (records, damage, end) = met(&path);
            assert_eq!((records.len(), damage, end), (3, vec![], last as u64));
        }
        std::fs::write(&path, &whole).unwrap();
        let mut later = Vec::new();
        let end = read(&path, last as u64, |met| later.push(format!("{met:?}"))).unwrap();
        assert_eq!((later.len(), end), (1, whole.len() as u64));
    }

    #[test]
    fn a_name_is_taken_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.segment");
        write(&path);
        assert!(SegmentWriter::create(&path).is_err());
    }
}
