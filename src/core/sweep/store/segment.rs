//! A file to which records are appended, each sealed on its own, so that what is torn or altered is known and costs nothing else.
//!
//! A frame is a mark of eight bytes, the length of the content (four bytes, little endian), the SHA-256 of length and content, and the
//! content. A reader that meets anything else goes on at the next mark.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use sha2::{Digest, Sha256};

const MARK: &[u8; 8] = b"\xc7dma\r\n\x1a\x01";
const HASH_BYTES: usize = 32;
const HEAD_BYTES: usize = MARK.len() + 4 + HASH_BYTES;
/// Appended records reach the disk within this time; a process that is killed loses none of them, a machine that loses its power
/// those of this time.
const SYNC: Duration = Duration::from_secs(1);
/// Bytes read at once.
const CHUNK: usize = 1 << 20;

/// A file open for appending, which no other process appends to.
#[derive(Debug)]
pub struct SegmentWriter {
    path: PathBuf,
    length: u64,
    disk: Arc<Disk>,
}

/// A file, and what of it is on the disk.
#[derive(Debug)]
struct Disk {
    file: File,
    written: AtomicU64,
    synced: AtomicU64,
    /// Whether a thread is about to bring it there.
    awaited: AtomicBool,
}

impl Disk {
    fn sync(&self) -> io::Result<()> {
        self.awaited.store(false, Ordering::SeqCst);
        let written = self.written.load(Ordering::SeqCst);
        self.file.sync_data()?;
        self.synced.fetch_max(written, Ordering::SeqCst);
        Ok(())
    }
}

impl SegmentWriter {
    /// Creates a file in a folder that is there.
    ///
    /// # Errors
    /// Of the file system, and where there is a file of this name.
    pub fn create(path: &Path) -> io::Result<Self> {
        let mut options = OpenOptions::new();
        let file = options.append(true).create_new(true).open(path)?;
        Ok(Self::of(path, file))
    }

    fn of(path: &Path, file: File) -> Self {
        Self {
            path: path.to_path_buf(),
            length: 0,
            disk: Arc::new(Disk {
                file,
                written: AtomicU64::new(0),
                synced: AtomicU64::new(0),
                awaited: AtomicBool::new(false),
            }),
        }
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
        let mut file = &self.disk.file;
        if let Err(error) = file.write_all(&frame) {
            // Should this fail too, the next reader finds a torn frame.
            let _ = file.set_len(self.length);
            return Err(error);
        }
        let content_at = self.length + HEAD_BYTES as u64;
        self.length += frame.len() as u64;
        self.disk.written.store(self.length, Ordering::SeqCst);
        self.sync_soon()?;
        Ok(content_at)
    }

    /// Brings what was appended to the disk within a second, be the next record hours away.
    fn sync_soon(&self) -> io::Result<()> {
        if self.disk.awaited.swap(true, Ordering::SeqCst) {
            return Ok(());
        }
        let disk = Arc::clone(&self.disk);
        let timer = std::thread::Builder::new().spawn(move || {
            std::thread::sleep(SYNC);
            // Where it fails, the bytes stay behind what is synced, and `finish` fails too.
            let _ = disk.sync();
        });
        match timer {
            Ok(_) => Ok(()),
            Err(_) => self.disk.sync(),
        }
    }

    /// Brings all that was appended to the disk, where it is not there yet.
    ///
    /// # Errors
    /// Of the file system, of a disk that turns out to be full for one.
    pub fn finish(&self) -> io::Result<()> {
        match self.disk.synced.load(Ordering::SeqCst) < self.length {
            true => self.disk.sync(),
            false => Ok(()),
        }
    }

    /// Where the file ends.
    pub fn length(&self) -> u64 {
        self.length
    }
}

impl Drop for SegmentWriter {
    fn drop(&mut self) {
        // Whoever wants to know of an error calls `finish` before.
        let _ = self.finish();
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

/// Whether a file is one of records.
pub(super) fn is_one(path: &Path) -> bool {
    let mut mark = [0; MARK.len()];
    File::open(path).is_ok_and(|mut file| file.read_exact(&mut mark).is_ok()) && mark == *MARK
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

/// The content at a place that [`read`] or [`SegmentWriter::append`] has named, checked again.
///
/// # Errors
/// Of the file system, and where the bytes there are no longer what they were.
pub fn content(path: &Path, at: u64, length: usize) -> io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(at.saturating_sub(HEAD_BYTES as u64)))?;
    let mut bytes = vec![0; HEAD_BYTES + length];
    file.read_exact(&mut bytes)?;
    match frame(&bytes) {
        Frame::Whole(found) if found == length => Ok(bytes.split_off(HEAD_BYTES)),
        _ => Err(io::Error::new(
            io::ErrorKind::InvalidData,
            "a record in it has changed since it was first read; run the command again, and the record counts as damaged",
        )),
    }
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
    fn records_reach_the_disk_within_a_second_though_no_other_follows() {
        let folder = tempfile::tempdir().unwrap();
        let mut writer = SegmentWriter::create(&folder.path().join("a.segment")).unwrap();
        // The second of two that end together, too.
        writer.append(b"first").unwrap();
        writer.append(b"second").unwrap();
        let begun = std::time::Instant::now();
        let synced = || writer.disk.synced.load(Ordering::SeqCst);
        while synced() < writer.length() {
            // A disk may be slow.
            assert!(begun.elapsed() < 20 * SYNC, "{} bytes", synced());
            std::thread::sleep(SYNC / 20);
        }
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn what_cannot_be_brought_to_the_disk_is_an_error_in_the_end() {
        // It takes everything and cannot be synchronised.
        let path = Path::new("/dev/null");
        let file = OpenOptions::new().write(true).open(path).unwrap();
        let mut writer = SegmentWriter::of(path, file);
        assert!(writer.finish().is_ok());
        writer.append(b"first").unwrap();
        assert!(writer.finish().is_err());
    }

    #[test]
    fn content_that_has_changed_since_it_was_found_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.segment");
        let whole = write(&path);
        let at = whole.len() - 100;
        for byte in [at - HEAD_BYTES, at - 1, at, whole.len() - 1] {
            let mut changed = whole.clone();
            changed[byte] ^= 0x41;
            std::fs::write(&path, &changed).unwrap();
            assert!(content(&path, at as u64, 100).is_err(), "byte {byte}");
        }
    }

    #[test]
    fn a_name_is_taken_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.segment");
        write(&path);
        assert!(SegmentWriter::create(&path).is_err());
    }
}
