//! The records in a folder: which segments there are, where in them each record stands, and the segment this process appends to.

use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::archive::Purpose;
use super::provenance::{self, BUILD};
use super::segment::{self, Met, SegmentWriter};
use super::{StoreError, VERSION, create_folder};

/// The folder of the segments, and the ending of their names.
pub const FOLDER: &str = "records";
pub const ENDING: &str = "segment";

/// What is said of bytes that are no record.
const NOT_USED: &str = "(their checksum does not match): what stood there is not used";
const NO_END: &str = "(a record without its end): they are not used";

/// Where other processes may be at work, their segments are looked at again after this time.
const LOOK_AGAIN: Duration = Duration::from_millis(500);

/// Which case a record is of: what it was solved for, and its numbers bit for bit.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub(in crate::sweep) struct Key {
    pub purpose: Purpose,
    /// Mean, amplitude, frequency, and what else varies.
    pub bits: Vec<u64>,
}

/// How the content of a record begins, in every version of the program.
#[derive(Debug, Serialize, Deserialize)]
struct Heading<'a> {
    program_version: &'a str,
    build: &'a str,
    sweep_hash: &'a str,
    key: Key,
}

/// Whose record it is.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::sweep) enum Origin {
    ThisBuild,
    AnotherBuild,
    Older(String),
    Newer(String),
}

/// Where a record stands.
#[derive(Debug, Clone)]
pub(in crate::sweep) struct Place {
    pub segment: Arc<Path>,
    pub origin: Origin,
    /// The content of its frame, and how much of that is the heading (bytes).
    at: u64,
    length: usize,
    heading: usize,
}

/// Something in the folder that is no record of this sweep.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unread {
    pub path: PathBuf,
    pub reason: String,
}

/// All that is known of the records of a folder.
#[derive(Debug)]
pub(in crate::sweep) struct Records(Mutex<State>);

#[derive(Debug, Default)]
struct State {
    folder: PathBuf,
    sweep_hash: String,
    /// Segments, and how far each has been read.
    read: HashMap<PathBuf, (Arc<Path>, u64)>,
    places: HashMap<Key, Place>,
    unread: Vec<Unread>,
    looked: Option<Instant>,
    own: Option<SegmentWriter>,
}

impl Records {
    pub(in crate::sweep) fn of(folder: &Path, sweep_hash: &str) -> Self {
        Self(Mutex::new(State {
            folder: folder.join(FOLDER),
            sweep_hash: sweep_hash.to_owned(),
            ..State::default()
        }))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // What a panicking thread has left half done is read from the files again, at worst.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Looks at the folder again, now.
    ///
    /// # Errors
    /// [`StoreError::Read`] with the path.
    pub(in crate::sweep) fn look(&self) -> Result<(), StoreError> {
        self.state().look()
    }

    /// Where the record of a case stands, be it of another process that has appended it a moment ago.
    ///
    /// # Errors
    /// As [`Self::look`].
    pub(in crate::sweep) fn place(&self, key: &Key) -> Result<Option<Place>, StoreError> {
        let mut state = self.state();
        if !state.places.contains_key(key)
            && state.looked.is_none_or(|at| at.elapsed() >= LOOK_AGAIN)
        {
            state.look()?;
        }
        Ok(state.places.get(key).cloned())
    }

    /// All that has been found, in the order of the keys.
    pub(in crate::sweep) fn places(&self) -> Vec<(Key, Place)> {
        let places = self.state();
        let places = places.places.iter();
        let mut all: Vec<_> = places.map(|(k, p)| (k.clone(), p.clone())).collect();
        all.sort_by(|a, b| a.0.cmp(&b.0));
        all
    }

    /// What was met that is no record of this sweep, since it was last asked for.
    pub(in crate::sweep) fn unread(&self) -> Vec<Unread> {
        std::mem::take(&mut self.state().unread)
    }

    /// The record at a place, without its heading.
    ///
    /// # Errors
    /// [`StoreError::Read`] with the path, also where it is no longer what was found there.
    pub(in crate::sweep) fn read(&self, place: &Place) -> Result<Vec<u8>, StoreError> {
        let content = segment::content(&place.segment, place.at, place.length);
        let mut content = content.map_err(|source| StoreError::Read {
            path: place.segment.to_path_buf(),
            source,
        })?;
        Ok(content.split_off(place.heading))
    }

    /// Brings all records appended to the disk.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path.
    pub(in crate::sweep) fn sync(&self) -> Result<(), StoreError> {
        let state = self.state();
        let Some(writer) = &state.own else {
            return Ok(());
        };
        writer.finish().map_err(|source| StoreError::Write {
            path: writer.path().to_path_buf(),
            source,
        })
    }

    /// Appends a record of this build. The folder of the segments is there once something was written.
    ///
    /// # Errors
    /// [`StoreError`] with the path.
    pub(in crate::sweep) fn append(&self, key: Key, record: &[u8]) -> Result<(), StoreError> {
        let mut state = self.state();
        let heading = Heading {
            program_version: VERSION,
            build: BUILD,
            sweep_hash: &state.sweep_hash,
            key,
        };
        let mut content = postcard::to_stdvec(&heading).map_err(|error| StoreError::Encode {
            path: state.folder.clone(),
            reason: error.to_string(),
        })?;
        let (key, heading) = (heading.key, content.len());
        content.extend_from_slice(record);
        let writer = match state.own.take() {
            Some(writer) => writer,
            None => new_segment(&state.folder)?,
        };
        let writer = state.own.insert(writer);
        let path = writer.path().to_path_buf();
        let at = match writer.append(&content) {
            Ok(at) => at,
            Err(source) => return Err(StoreError::Write { path, source }),
        };
        let length = writer.length();
        let read = state.read.entry(path);
        let (segment, read_to) = read.or_insert_with_key(|path| (path.as_path().into(), 0));
        *read_to = length;
        let place = Place {
            segment: Arc::clone(segment),
            origin: Origin::ThisBuild,
            at,
            length: content.len(),
            heading,
        };
        state.places.insert(key, place);
        Ok(())
    }
}

impl State {
    fn look(&mut self) -> Result<(), StoreError> {
        let first = self.looked.is_none();
        self.looked = Some(Instant::now());
        let failed = |path: &Path| {
            let path = path.to_path_buf();
            move |source| StoreError::Read { path, source }
        };
        let folder = self.folder.clone();
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            Err(source) => return Err(failed(&folder)(source)),
        };
        let mut paths = Vec::new();
        for entry in entries {
            let path = entry.map_err(failed(&folder))?.path();
            match path.extension().is_some_and(|ending| ending == ENDING) {
                true => paths.push(path),
                false if first => self.unread.extend(other_file(path)),
                false => {}
            }
        }
        // Whatever the order in which a system lists them.
        paths.sort();
        for path in paths {
            self.look_at(&path).map_err(failed(&path))?;
        }
        Ok(())
    }

    /// Reads what a segment has grown by.
    fn look_at(&mut self, path: &Path) -> io::Result<()> {
        let known = self.read.get(path).cloned();
        let is_first = known.is_none();
        let (segment, from) = known.unwrap_or_else(|| (Arc::from(path), 0));
        let length = fs::metadata(path)?.len();
        if length <= from {
            return Ok(());
        }
        let mut unread = |reason: String| {
            let path = path.to_path_buf();
            self.unread.push(Unread { path, reason });
        };
        let to = segment::read(path, from, |met| match met {
            Met::Damaged { from, to } => unread(format!(
                "bytes {from} to {to} are damaged or torn {NOT_USED}"
            )),
            Met::Record { at, content } => {
                match place(&segment, at, content, &self.sweep_hash) {
                    // Of several records of a case the one of this build counts, and of several of these the first.
                    Ok((key, place)) => match self.places.get(&key) {
                        Some(known) if known.origin <= place.origin => {}
                        _ => drop(self.places.insert(key, place)),
                    },
                    Err(reason) => unread(reason),
                }
            }
        })?;
        // A process that is killed leaves such an end, and one at work for a moment too: it is told once.
        if to < length && is_first {
            let torn = length - to;
            unread(format!(
                "its last {torn} bytes are damaged or torn {NO_END}"
            ));
        }
        self.read.insert(path.to_path_buf(), (segment, to));
        Ok(())
    }
}

/// A segment that no other process has.
fn new_segment(folder: &Path) -> Result<SegmentWriter, StoreError> {
    create_folder(folder)?;
    let host: String = provenance::host().unwrap_or_default();
    let host = host.replace(|c: char| !c.is_ascii_alphanumeric() && c != '-', "");
    let process = std::process::id();
    let mut count = 0;
    loop {
        // Systems number their processes from the beginning again and again.
        let path = folder.join(format!("{host}-{process}-{count}.{ENDING}"));
        match SegmentWriter::create(&path) {
            Ok(writer) => {
                sync_names(folder);
                return Ok(writer);
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => count += 1,
            Err(source) => return Err(StoreError::Create { path, source }),
        }
    }
}

/// Brings the names of new files to the disk: a file that is there without its name is lost. Not every system can do so.
fn sync_names(folder: &Path) {
    for folder in [Some(folder), folder.parent()].into_iter().flatten() {
        let _ = fs::File::open(folder).and_then(|folder| folder.sync_all());
    }
}

/// The case and the place of a whole record; why it is not used where it is of something else.
fn place(
    segment: &Arc<Path>,
    at: u64,
    content: &[u8],
    sweep_hash: &str,
) -> Result<(Key, Place), String> {
    let heading = postcard::take_from_bytes::<Heading<'_>>(content);
    let (heading, record) = heading.map_err(|_| "a record in it has no heading".to_owned())?;
    let version = heading.program_version;
    let origin = match numbers(version).cmp(&numbers(VERSION)) {
        std::cmp::Ordering::Less => Origin::Older(version.to_owned()),
        std::cmp::Ordering::Greater => Origin::Newer(version.to_owned()),
        std::cmp::Ordering::Equal if heading.build == BUILD => Origin::ThisBuild,
        std::cmp::Ordering::Equal => Origin::AnotherBuild,
    };
    if heading.sweep_hash != sweep_hash {
        return Err("a record in it belongs to another sweep".to_owned());
    }
    let place = Place {
        segment: Arc::clone(segment),
        origin,
        at,
        length: content.len(),
        heading: content.len() - record.len(),
    };
    Ok((heading.key, place))
}

/// A file among the segments that is none; files half-written by earlier versions say nothing.
fn other_file(path: PathBuf) -> Option<Unread> {
    let is_record = path.extension().is_some_and(|ending| ending == "json");
    is_record.then(|| Unread {
        path,
        reason: "a record of an earlier version of the program, which kept one file per case: it is not used".to_owned(),
    })
}

/// The numbers of a version; what is no number counts as 0.
fn numbers(version: &str) -> Vec<u64> {
    let release = version.split(['-', '+']).next().unwrap_or_default();
    let parts = release.split('.');
    parts.map(|part| part.parse().unwrap_or(0)).collect()
}
