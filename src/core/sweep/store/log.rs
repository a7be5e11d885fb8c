//! An append-only file of records. What is damaged or torn in it is reported, and costs nothing else.
//!
//! A record stands behind a mark of eight bytes, its length, and the CRC-32 of its content (four bytes each, little endian). A reader
//! that meets anything else goes on at the next mark.

use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::{StoreError, create_folder, provenance};

/// How the names of logs end.
pub const ENDING: &str = "segment";

/// Its last byte numbers the form of the records.
const MARK: &[u8; 8] = b"\xc7dma\r\n\x1a\x02";
const HEAD_BYTES: usize = MARK.len() + 8;
/// Appended records reach the disk within this time; a process that is killed loses none of them, a machine that loses its power
/// those of this time.
const SYNC: Duration = Duration::from_secs(1);
/// Bytes read at once.
const CHUNK: usize = 1 << 20;

/// A file open for appending, which no other process appends to.
#[derive(Debug)]
pub struct LogWriter {
    path: Arc<Path>,
    length: u64,
    disk: Arc<Disk>,
}

/// A file, and whether something of it is not on the disk yet.
#[derive(Debug)]
struct Disk {
    file: File,
    unsynced: Mutex<bool>,
}

impl Disk {
    fn unsynced(&self) -> MutexGuard<'_, bool> {
        self.unsynced.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn sync(&self) -> io::Result<()> {
        let mut unsynced = self.unsynced();
        if *unsynced {
            self.file.sync_data()?;
            *unsynced = false;
        }
        Ok(())
    }
}

impl LogWriter {
    /// Creates one that no other process has, in a folder that is created where needed.
    ///
    /// # Errors
    /// [`StoreError::Create`] with the path.
    pub fn in_folder(folder: &Path) -> Result<Self, StoreError> {
        create_folder(folder)?;
        let host: String = provenance::host().unwrap_or_default();
        let host = host.replace(|c: char| !c.is_ascii_alphanumeric() && c != '-', "");
        let process = std::process::id();
        let mut count = 0;
        loop {
            // Systems number their processes from the beginning again and again.
            let path = folder.join(format!("{host}-{process}-{count}.{ENDING}"));
            match Self::create(&path) {
                Ok(writer) => {
                    sync_names(folder);
                    return Ok(writer);
                }
                Err(error) if error.kind() == ErrorKind::AlreadyExists => count += 1,
                Err(source) => return Err(StoreError::Create { path, source }),
            }
        }
    }

    /// Creates a file in a folder that is there.
    ///
    /// # Errors
    /// Of the file system, and where there is a file of this name.
    pub fn create(path: &Path) -> io::Result<Self> {
        let mut options = OpenOptions::new();
        let file = options.append(true).create_new(true).open(path)?;
        Ok(Self::new(path, file))
    }

    fn new(path: &Path, file: File) -> Self {
        Self {
            path: path.into(),
            length: 0,
            disk: Arc::new(Disk {
                file,
                unsynced: Mutex::default(),
            }),
        }
    }

    /// The file.
    pub fn path(&self) -> &Arc<Path> {
        &self.path
    }

    /// Appends a record that is [`framed`]. What cannot be written whole is taken back.
    ///
    /// # Errors
    /// Of the file system.
    pub fn append(&mut self, framed: &[u8]) -> io::Result<()> {
        let mut file = &self.disk.file;
        if let Err(error) = file.write_all(framed) {
            // Should this fail too, the next reader finds a torn record.
            let _ = file.set_len(self.length);
            return Err(error);
        }
        self.length += framed.len() as u64;
        if std::mem::replace(&mut *self.disk.unsynced(), true) {
            return Ok(());
        }
        // Within a second, be the next record hours away.
        let disk = Arc::clone(&self.disk);
        let timer = std::thread::Builder::new().spawn(move || {
            std::thread::sleep(SYNC);
            // Where it fails, `finish` fails too.
            let _ = disk.sync();
        });
        timer.map(drop).or_else(|_| self.disk.sync())
    }

    /// Brings all that was appended to the disk, where it is not there yet.
    ///
    /// # Errors
    /// Of the file system, of a disk that turns out to be full for one.
    pub fn finish(&self) -> io::Result<()> {
        self.disk.sync()
    }

    /// Where the file ends.
    pub fn length(&self) -> u64 {
        self.length
    }
}

impl Drop for LogWriter {
    fn drop(&mut self) {
        // Whoever wants to know of an error calls `finish` before.
        let _ = self.finish();
    }
}

/// Brings the names of new files to the disk: a file that is there without its name is lost. Not every system can do so.
fn sync_names(folder: &Path) {
    for folder in [Some(folder), folder.parent()].into_iter().flatten() {
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
}

/// A record as it stands in a log.
///
/// # Errors
/// Of a record above 4 GB.
pub fn framed(content: &[u8]) -> io::Result<Vec<u8>> {
    let length = u32::try_from(content.len())
        .map_err(|_| io::Error::new(ErrorKind::InvalidData, "a record above 4 GB"))?;
    let head = [
        length.to_le_bytes(),
        checksum(length, content).to_le_bytes(),
    ];
    Ok([MARK, head.as_flattened(), content].concat())
}

/// Of the length too, so that an altered one is found.
fn checksum(length: u32, content: &[u8]) -> u32 {
    let mut sum = crc32fast::Hasher::new();
    sum.update(&length.to_le_bytes());
    sum.update(content);
    sum.finalize()
}

/// Whether a file is a log, in this form or in that of another version of the program.
pub(super) fn is_one(path: &Path) -> bool {
    let mut mark = [0; MARK.len()];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut mark));
    read.is_ok() && mark[..MARK.len() - 1] == MARK[..MARK.len() - 1]
}

/// What a reader meets in a log.
#[derive(Debug, PartialEq, Eq)]
pub enum Met<'a> {
    /// The content of a record, and where it begins.
    Record { at: u64, content: &'a [u8] },
    /// Bytes from one place to another that are no record.
    Damaged { from: u64, to: u64 },
}

/// Reads a log from a place on and says what it meets; where the last record ends, which is where another reading goes on. Bytes
/// behind that may be a record that is being written, or was when its process was killed.
///
/// # Errors
/// Of the file system.
pub fn read(path: &Path, from: u64, meet: impl FnMut(Met<'_>)) -> io::Result<u64> {
    let mut file = BufReader::with_capacity(CHUNK, File::open(path)?);
    file.seek(SeekFrom::Start(from))?;
    read_from(&mut file, from, meet)
}

/// The same of a log that is open at that place.
pub(super) fn read_from(
    log: &mut (impl BufRead + Seek),
    from: u64,
    mut meet: impl FnMut(Met<'_>),
) -> io::Result<u64> {
    let (mut at, mut whole_to) = (from, from);
    let mut damaged: Option<u64> = None;
    let mut content = Vec::new();
    loop {
        if next(log, &mut content)? {
            if let Some(from) = damaged.take() {
                meet(Met::Damaged { from, to: at });
            }
            at += HEAD_BYTES as u64;
            let content = content.as_slice();
            meet(Met::Record { at, content });
            at += content.len() as u64;
            whole_to = at;
        } else {
            damaged.get_or_insert(at);
            log.seek(SeekFrom::Start(at + 1))?;
            match next_mark(log, at + 1)? {
                Some(mark_at) => at = mark_at,
                None => return Ok(whole_to),
            }
        }
    }
}

/// The content of a record of this length that begins here, checked again.
///
/// # Errors
/// Of the file system, and where the bytes there are no longer what they were.
pub fn content(path: &Path, at: u64, length: usize) -> io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(at.saturating_sub(HEAD_BYTES as u64)))?;
    let mut content = Vec::with_capacity(length);
    match next(&mut file, &mut content)? {
        true if content.len() == length => Ok(content),
        _ => Err(io::Error::new(
            ErrorKind::InvalidData,
            "a record in it has changed since it was first read; run the command again, and the record counts as damaged",
        )),
    }
}

/// Reads the record that begins here into `content`; `false` where there is none, or not all of it.
fn next(log: &mut impl Read, content: &mut Vec<u8>) -> io::Result<bool> {
    let mut head = [0; HEAD_BYTES];
    match log.read_exact(&mut head) {
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(false),
        read => read?,
    }
    let Some([length, sum]) = head.strip_prefix(MARK).map(|rest| {
        let number = |from: usize| [rest[from], rest[from + 1], rest[from + 2], rest[from + 3]];
        [number(0), number(4)].map(u32::from_le_bytes)
    }) else {
        return Ok(false);
    };
    content.clear();
    // Of a length that was altered no more is taken than there is.
    log.take(length.into()).read_to_end(content)?;
    Ok(content.len() == length as usize && checksum(length, content) == sum)
}

/// Where the next mark begins, from this place on, at which the log is open; it is left open at that mark.
fn next_mark(log: &mut (impl BufRead + Seek), mut at: u64) -> io::Result<Option<u64>> {
    loop {
        at += log.skip_until(MARK[0])? as u64;
        let mut rest = [0; MARK.len() - 1];
        match log.read_exact(&mut rest) {
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(None),
            read => read?,
        }
        let is_mark = rest == MARK[1..];
        let back = if is_mark { MARK.len() } else { rest.len() };
        log.seek_relative(-(back as i64))?;
        if is_mark {
            return Ok(Some(at - 1));
        }
    }
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
        let mut writer = LogWriter::create(path).unwrap();
        for content in contents() {
            writer.append(&framed(&content).unwrap()).unwrap();
            let at = writer.length() - content.len() as u64;
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
        let mut writer = LogWriter::create(&folder.path().join("a.segment")).unwrap();
        // The second of two that end together, too.
        writer.append(&framed(b"first").unwrap()).unwrap();
        writer.append(&framed(b"second").unwrap()).unwrap();
        let begun = std::time::Instant::now();
        while *writer.disk.unsynced() {
            // A disk may be slow.
            assert!(begun.elapsed() < 20 * SYNC);
            std::thread::sleep(SYNC / 20);
        }
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn what_cannot_be_brought_to_the_disk_is_an_error_in_the_end() {
        // It takes everything and cannot be synchronised.
        let path = Path::new("/dev/null");
        let file = OpenOptions::new().write(true).open(path).unwrap();
        let mut writer = LogWriter::new(path, file);
        assert!(writer.finish().is_ok());
        writer.append(&framed(b"first").unwrap()).unwrap();
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
        assert!(LogWriter::create(&path).is_err());
    }
}
