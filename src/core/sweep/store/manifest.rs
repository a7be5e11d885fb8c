//! Which files of a folder the program has written: these alone it replaces or removes.
//!
//! `run.json` lists them when a command has ended. Until then each name is appended to the lock file before the file takes it, so that
//! a killed process leaves no file that is not listed. A folder that is not empty and has no list is somebody else's: it is
//! refused, or, where that is forced, files are added to it, and none of its own is touched. Folders of versions that
//! wrote no list are known by their summary, or by records of their plan, and their files by their names.

use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;

use super::folder_lock::{FolderLock, LOCK, LOCKS, Others};
use super::listing::{
    Found, KIND_MARK, Listed, PROGRAM, journal_of, look, named_like_results, names_in,
};
pub use super::listing::{Kind, RUN, kind_of};
use super::{RESOLVED, StoreError, TEMPORARY, files, provenance};

/// What a command is to do in a folder.
#[derive(Debug, Clone, Copy)]
pub struct Target<'a> {
    pub folder: &'a Path,
    pub kind: Kind,
    /// Whether another result is replaced, and files are added to a folder that is somebody else's.
    pub force: bool,
    /// The files that the command reads, of which none is written over.
    pub reads: &'a [PathBuf],
}

impl Target<'_> {
    /// Whether the command may write into the folder; for a long computation, to be asked before it. Writes nothing.
    ///
    /// # Errors
    /// [`StoreError`] why not.
    pub fn check(&self) -> Result<(), StoreError> {
        self.look(None).map(drop)
    }

    /// What the folder holds, where the command may write into it.
    pub(super) fn look(&self, resolved: Option<&str>) -> Result<Listed, StoreError> {
        let path = self.folder.to_path_buf();
        let whole = |read: &&PathBuf| {
            read.is_dir() && names_in(self.folder, read).iter().any(String::is_empty)
        };
        if let Some(read) = self.reads.iter().find(whole) {
            let (read, written) = (read.clone(), path);
            return Err(StoreError::ReplacesInput { read, written });
        }
        match look(self.folder, resolved)? {
            Found::Nothing => Ok(Listed::default()),
            Found::Foreign(file) if !self.force => Err(StoreError::Foreign { path, file }),
            Found::Foreign(file) => match self.obstacle(file) {
                Some(path) => Err(StoreError::ForeignFile { path }),
                None => Ok(Listed::default()),
            },
            Found::Listed(listed) => match listed.kind {
                Some(holds) if !holds.shares_a_folder_with(self.kind) && !self.force => {
                    let writes = self.kind;
                    Err(StoreError::OtherKind {
                        path,
                        holds,
                        writes,
                    })
                }
                _ => Ok(listed),
            },
        }
    }

    /// A file of a folder of somebody else, of which this is the first file, that is in the way whatever the command comes to.
    fn obstacle(&self, first: String) -> Option<PathBuf> {
        let file = match self.has_plan() {
            _ if first == LOCK => Some(first),
            true => named_like_results(self.folder).pop_first(),
            false => None,
        };
        Some(self.folder.join(file?))
    }

    /// Of a sweep or scenario not all names are known before the computation: any that it may use is an obstacle.
    fn has_plan(&self) -> bool {
        self.kind.shares_a_folder_with(Kind::Sweep)
    }

    /// Whether one of these files would replace one that the command reads.
    fn check_reads(
        &self,
        is_written: impl Fn(&str) -> bool,
    ) -> Result<BTreeSet<String>, StoreError> {
        let mut names = BTreeSet::new();
        for read in self.reads {
            for name in names_in(self.folder, read) {
                if is_written(&name) {
                    return Err(StoreError::ReplacesInput {
                        read: read.clone(),
                        written: self.folder.join(name),
                    });
                }
                names.insert(name);
            }
        }
        Ok(names)
    }

    /// As [`Self::check`], of a sweep or scenario, whose own plan may be what it reads. What the folder holds, and the names in it
    /// of what is read.
    pub(super) fn check_plan(
        &self,
        resolved: &str,
    ) -> Result<(Listed, BTreeSet<String>), StoreError> {
        let has_own_plan = look(self.folder, Some(resolved))?
            .files()
            .contains(RESOLVED);
        let reads =
            self.check_reads(|name| files::is_result(name) && !(name == RESOLVED && has_own_plan))?;
        Ok((self.look(Some(resolved))?, reads))
    }

    /// Fills the folder with these files, by their names, and removes those that an earlier run of the kind has left beyond them.
    ///
    /// # Errors
    /// [`StoreError`]. What is refused is refused before anything is written.
    pub fn write(&self, written: Vec<(String, Vec<u8>)>) -> Result<(), StoreError> {
        let is_written = |name: &str| name == RUN || written.iter().any(|(own, _)| own == name);
        let reads = self.check_reads(is_written)?;
        let foreign = |listed: &Listed| {
            let names = written.iter().map(|(name, _)| &name[..]).chain([RUN]);
            let mut names = names.filter(|name| !listed.files.contains(*name));
            let file = names.find(|name| self.folder.join(name).symlink_metadata().is_ok());
            match file.map(|name| self.folder.join(name)) {
                Some(path) => Err(StoreError::ForeignFile { path }),
                None => Ok(()),
            }
        };
        foreign(&self.look(None)?)?;
        super::create_folder(self.folder)?;
        let lock = FolderLock::of(self.folder);
        if lock.try_exclusive() == Others::AtWork {
            return Err(super::in_use(self.folder));
        }
        let found = self.look(None)?;
        let is_other = found.kind.is_some_and(|kind| kind != self.kind);
        let manifest = Manifest::new(self.folder, self.kind, lock, found.files).reading(reads);
        manifest.remove_temporaries();
        manifest.begin()?;
        if is_other {
            manifest.clear()?;
        }
        for (name, bytes) in &written {
            manifest.record(name)?;
            super::write_atomically(&self.folder.join(name), bytes)?;
        }
        manifest.remove_stale()?;
        manifest.close(RUN, |files| {
            let run = Signed {
                program: PROGRAM,
                program_version: super::VERSION,
                build: provenance::BUILD,
                commit: provenance::COMMIT,
                kind: self.kind,
                files,
            };
            let bytes = provenance::json(&self.folder.join(RUN), &run)?;
            super::write_atomically(&self.folder.join(RUN), &bytes)
        })
    }
}

/// The `run.json` of a command that computes no cases.
#[derive(Serialize)]
struct Signed<'a> {
    program: &'a str,
    program_version: &'a str,
    build: &'a str,
    commit: Option<&'a str>,
    kind: Kind,
    files: &'a BTreeSet<String>,
}

/// The list of a folder in which this process works.
#[derive(Debug)]
pub(super) struct Manifest {
    folder: PathBuf,
    kind: Kind,
    pub(super) lock: FolderLock,
    /// Names of files in the folder that are read.
    reads: BTreeSet<String>,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    listed: BTreeSet<String>,
    /// By this process.
    written: BTreeSet<String>,
}

impl Manifest {
    pub(super) fn new(
        folder: &Path,
        kind: Kind,
        lock: FolderLock,
        listed: BTreeSet<String>,
    ) -> Self {
        let state = State {
            listed,
            written: BTreeSet::new(),
        };
        Self {
            folder: folder.to_path_buf(),
            kind,
            lock,
            reads: BTreeSet::new(),
            state: Mutex::new(state),
        }
    }

    /// The same, where these files of the folder are read, and stay.
    pub(super) fn reading(self, reads: BTreeSet<String>) -> Self {
        Self { reads, ..self }
    }

    /// What the folder holds.
    pub(super) fn kind(&self) -> Kind {
        self.kind
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // A name that was inserted is listed, whatever came after.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn append(&self, names: &[&str]) -> Result<(), StoreError> {
        // Whatever the end of the file, which a killed process may have left within a name.
        let text = format!("\n{}\n", names.join("\n"));
        self.lock.append(&text).map_err(|source| StoreError::Write {
            path: self.folder.join(LOCK),
            source,
        })
    }

    /// Takes the folder: its kind and what is known of its files are in the lock file from here on.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path.
    pub(super) fn begin(&self) -> Result<(), StoreError> {
        let journal = journal_of(&self.lock.content());
        let kind = format!("{KIND_MARK}{}", self.kind.name());
        let state = self.state();
        let mut names: Vec<&str> = match journal.kind == Some(self.kind) {
            true => Vec::new(),
            false => vec![&kind],
        };
        names.extend(state.listed.difference(&journal.files).map(String::as_str));
        match names.is_empty() {
            true => Ok(()),
            false => self.append(&names),
        }
    }

    /// Lists a file that is about to be written.
    ///
    /// # Errors
    /// [`StoreError::ForeignFile`] where there is one of this name that the program has not written.
    pub(super) fn record(&self, name: &str) -> Result<(), StoreError> {
        let mut state = self.state();
        if !state.listed.contains(name) {
            let path = self.folder.join(name);
            if path.symlink_metadata().is_ok() {
                // Another process of the same result may have written it meanwhile.
                self.look_again(&mut state)?;
                if !state.listed.contains(name) {
                    return Err(StoreError::ForeignFile { path });
                }
            } else {
                self.append(&[name])?;
                state.listed.insert(name.to_owned());
            }
        }
        state.written.insert(name.to_owned());
        Ok(())
    }

    fn look_again(&self, state: &mut State) -> Result<(), StoreError> {
        if let Found::Listed(listed) = look(&self.folder, None)? {
            state.listed.extend(listed.files);
        }
        Ok(())
    }

    /// Removes the files that an earlier run has left and this one has not written: tables and figures, never records.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path.
    pub(super) fn remove_stale(&self) -> Result<(), StoreError> {
        let mut state = self.state();
        self.look_again(&mut state)?;
        let left = state.listed.difference(&state.written);
        self.remove(left.filter(|name| files::is_drawn_again(name)))
    }

    /// Removes every file, before another result takes the folder.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path.
    pub(super) fn clear(&self) -> Result<(), StoreError> {
        let listed = std::mem::take(&mut self.state().listed);
        self.remove(listed.iter())
    }

    /// Removes the files of a folder in the folder.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path.
    pub(super) fn remove_below(&self, below: &Path) -> Result<(), StoreError> {
        if !self.folder.join(below).exists() {
            return Ok(());
        }
        let mut state = self.state();
        let is_below = |name: &&String| Path::new(name).starts_with(below);
        // Of a single case another process seldom knows more.
        if below.components().count() == 1 || !state.listed.iter().any(|name| is_below(&name)) {
            self.look_again(&mut state)?;
        }
        self.remove(state.listed.iter().filter(is_below))
    }

    /// Removes these files, and the folders that are empty then.
    fn remove<'a>(&self, names: impl Iterator<Item = &'a String>) -> Result<(), StoreError> {
        let mut folders = BTreeSet::new();
        let stays = |name: &str| LOCKS.contains(&name) || self.reads.contains(name);
        for name in names.filter(|name| !stays(name)) {
            let path = self.folder.join(name);
            match fs::remove_file(&path) {
                Err(source) if source.kind() != ErrorKind::NotFound => {
                    return Err(StoreError::Write { path, source });
                }
                _ => {}
            }
            folders.extend(Path::new(name).ancestors().skip(1));
        }
        folders.remove(Path::new(""));
        // Those within others first; what holds a file of somebody else stays.
        for folder in folders.iter().rev() {
            let _ = fs::remove_dir(self.folder.join(folder));
        }
        Ok(())
    }

    /// Removes what killed processes of this machine have left half-written; for the one that holds the lock alone.
    pub(super) fn remove_temporaries(&self) {
        let state = self.state();
        let parents = (state.listed.iter()).filter_map(|name| Path::new(name).parent());
        let folders = [""].iter().chain(&files::NUMBERED).map(Path::new);
        let folders: BTreeSet<&Path> = folders.chain(parents).collect();
        let entries = folders
            .iter()
            .flat_map(|folder| fs::read_dir(self.folder.join(folder)));
        for entry in entries.flatten().flatten() {
            if entry
                .file_name()
                .to_string_lossy()
                .starts_with(TEMPORARY.as_str())
            {
                // Gone already, or not ours to remove: no reason to stop.
                let _ = fs::remove_file(entry.path());
            }
        }
    }

    /// Writes the list into the file of this name, by a function of all files that are there, and empties the lock file where nobody
    /// else is at work.
    ///
    /// # Errors
    /// [`StoreError`] of the function.
    pub(super) fn close(
        &self,
        name: &str,
        write: impl FnOnce(&BTreeSet<String>) -> Result<(), StoreError>,
    ) -> Result<(), StoreError> {
        self.record(name)?;
        let is_alone = self.lock.try_exclusive() == Others::Absent;
        if !is_alone {
            // What was asked for in vain took the shared lock away. Without it another process may find itself alone, empty the
            // lock file, and have its list replaced by one that was made before.
            self.lock.share();
        }
        let mut state = self.state();
        self.look_again(&mut state)?;
        let is_there = |file: &&str| *file == name || self.folder.join(file).exists();
        let known = state.listed.iter().map(String::as_str).chain(LOCKS);
        let files: BTreeSet<String> = known.filter(is_there).map(str::to_owned).collect();
        drop(state);
        let written = write(&files);
        if is_alone && written.is_ok() {
            self.lock.empty();
        }
        self.lock.share();
        written
    }
}
