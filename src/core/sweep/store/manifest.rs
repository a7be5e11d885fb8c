//! Which files of a folder the program has written: these alone it replaces or removes.
//!
//! `run.json` lists them when a command has ended. Until then each name is appended to the lock file before the file takes it, so that
//! a killed process leaves no file that is not listed. A folder that is not empty and has no list belongs to others: it is
//! refused, or, where that is forced, files are added to it, and none of its own is touched. Folders of versions that
//! wrote no list are known by their summary, or by records of their plan, and their files by their names.

use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;

use super::folder_lock::{FolderLock, LOCK, LOCKS, Others};
use super::listing::{KIND_MARK, Listed, PROGRAM, files_in, journal_of, look, names_in};
pub use super::listing::{Kind, RUN, files_of, kind_of};
use super::{RESOLVED, StoreError, TEMPORARY, files, provenance};

/// What a command is to do in a folder.
#[derive(Debug, Clone, Copy)]
pub struct Target<'a> {
    pub folder: &'a Path,
    pub kind: Kind,
    /// Whether another result is replaced, and files are added to a folder with files of others.
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
        self.look(None, &|_| false).map(drop)
    }

    /// What the folder holds, and the names in it of what is read, where the command may write files of these names into it.
    /// `resolved`: the plan of a sweep or scenario, which may be what it reads.
    pub(super) fn look(
        &self,
        resolved: Option<&str>,
        is_written: &dyn Fn(&str) -> bool,
    ) -> Result<(Listed, BTreeSet<String>), StoreError> {
        let path = self.folder.to_path_buf();
        let mut listed = look(self.folder, resolved)?;
        let mut reads = BTreeSet::new();
        for read in self.reads {
            for name in names_in(self.folder, read) {
                let is_own_plan =
                    resolved.is_some() && name == RESOLVED && listed.files.contains(RESOLVED);
                let written = match &*name {
                    "" if read.is_dir() => path,
                    name if is_written(name) && !is_own_plan => path.join(name),
                    _ => {
                        reads.insert(name);
                        continue;
                    }
                };
                let read = read.clone();
                return Err(StoreError::ReplacesInput { read, written });
            }
        }
        let foreign = listed.foreign.take();
        match (&foreign, listed.kind) {
            (Some(file), _) if !self.force => {
                let file = file.clone();
                return Err(StoreError::Foreign { path, file });
            }
            (_, Some(holds)) if !holds.shares_a_folder_with(self.kind) && !self.force => {
                let writes = self.kind;
                return Err(StoreError::OtherKind {
                    path,
                    holds,
                    writes,
                });
            }
            _ => {}
        }
        // A sweep or scenario uses some of the names that it may use. In its own folder files with the other names are no obstacle.
        if foreign.is_some() || resolved.is_none() {
            let mut obstacles = files_in(self.folder, "", is_written);
            if let Some(name) = obstacles.find(|name| !listed.files.contains(name)) {
                let path = path.join(name);
                return Err(StoreError::ForeignFile { path });
            }
        }
        Ok((listed, reads))
    }

    /// Locks the folder, which is created where needed, and makes its list; who else is at work there, and whether it holds results of
    /// another kind. What is refused is refused before anything is written.
    pub(super) fn take(
        &self,
        resolved: Option<&str>,
        is_written: &dyn Fn(&str) -> bool,
    ) -> Result<(Manifest, Others, bool), StoreError> {
        self.look(resolved, is_written)?;
        super::create_folder(self.folder)?;
        let lock = FolderLock::of(self.folder);
        let others = lock.try_exclusive();
        let (found, reads) = self.look(resolved, is_written)?;
        let is_other_kind = found.kind.is_some_and(|kind| kind != self.kind);
        let manifest = Manifest {
            reads,
            ..Manifest::new(self.folder, self.kind, lock, found.files)
        };
        if others == Others::Absent {
            manifest.remove_temporaries();
        }
        Ok((manifest, others, is_other_kind))
    }

    /// Fills the folder with these files, by their names, and removes those that an earlier run of the kind has left beyond them.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn write(&self, written: Vec<(String, Vec<u8>)>) -> Result<(), StoreError> {
        let is_written = |name: &str| name == RUN || written.iter().any(|(own, _)| own == name);
        let (manifest, others, is_other_kind) = self.take(None, &is_written)?;
        if others == Others::AtWork {
            return Err(super::in_use(self.folder));
        }
        manifest.begin()?;
        if is_other_kind {
            manifest.clear()?;
        }
        for (name, bytes) in &written {
            manifest.record(name)?;
            super::write_atomically(&self.folder.join(name), bytes)?;
        }
        manifest.remove_stale()?;
        manifest.sign(RUN, None::<&()>)
    }
}

/// `run.json`, with what a command that computes cases has to say besides.
#[derive(Serialize)]
struct Signed<'a, T> {
    program: &'a str,
    program_version: &'a str,
    build: &'a str,
    commit: Option<&'a str>,
    #[serde(flatten)]
    more: Option<&'a T>,
    kind: Kind,
    /// Every file of the folder that the program has written.
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

    fn state(&self) -> MutexGuard<'_, State> {
        // A name that was inserted is listed, whatever came after.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The kind stands before all names: another process may have emptied the file.
    fn append(&self, names: &[&str]) -> Result<(), StoreError> {
        let kind = serde_json::to_string(&self.kind).unwrap_or_default();
        // A killed process may have left the end of the file within a name.
        let text = format!("\n{KIND_MARK}{kind}\n{}\n", names.join("\n"));
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
        let state = self.state();
        let names = state.listed.difference(&journal.files).map(String::as_str);
        let names: Vec<&str> = names.collect();
        match names.is_empty() && journal.kind == Some(self.kind) {
            true => Ok(()),
            false => self.append(&names),
        }
    }

    /// Lists a file that is about to be written.
    ///
    /// # Errors
    /// [`StoreError::ForeignFile`] where there is one of this name that the program has not written; [`StoreError::ReplacesInput`]
    /// where it is read.
    pub(super) fn record(&self, name: &str) -> Result<(), StoreError> {
        let path = self.folder.join(name);
        if name != RESOLVED && self.reads.contains(name) {
            let (read, written) = (path.clone(), path);
            return Err(StoreError::ReplacesInput { read, written });
        }
        let mut state = self.state();
        if !state.listed.contains(name) {
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
        state.listed.extend(look(&self.folder, None)?.files);
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

    /// Removes the files of a folder in the folder; `has_others`: those too that other processes have written there since.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path.
    pub(super) fn remove_below(&self, below: &Path, has_others: bool) -> Result<(), StoreError> {
        if !self.folder.join(below).exists() {
            return Ok(());
        }
        let mut state = self.state();
        let is_below = |name: &&String| Path::new(name).starts_with(below);
        // Of a single case another process seldom knows more.
        if has_others || !state.listed.iter().any(|name| is_below(&name)) {
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
        // Inner folders first; a folder that holds a file of others stays.
        for folder in folders.iter().rev() {
            let _ = fs::remove_dir(self.folder.join(folder));
        }
        Ok(())
    }

    /// Removes what killed processes of this machine have left half-written; for the one that holds the lock alone.
    pub(super) fn remove_temporaries(&self) {
        let state = self.state();
        let parents = (state.listed.iter()).filter_map(|name| Path::new(name).parent());
        let parents = parents.map(Path::to_path_buf);
        let folders = files::folders().map(PathBuf::from);
        let folders: BTreeSet<PathBuf> = folders.chain(parents).collect();
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

    /// Writes the list of all files that are there into the file of this name, with `more` beside it, and empties the lock file where
    /// nobody else is at work.
    ///
    /// # Errors
    /// [`StoreError`] with the path.
    pub(super) fn sign(&self, name: &str, more: Option<&impl Serialize>) -> Result<(), StoreError> {
        self.record(name)?;
        let is_alone = self.lock.try_exclusive() == Others::Absent;
        if !is_alone {
            // The failed attempt has released the shared lock. Without it another process may find itself alone, empty the
            // lock file, and have its list replaced by one that was made before.
            self.lock.share();
        }
        let mut state = self.state();
        self.look_again(&mut state)?;
        let is_there = |file: &&str| *file == name || self.folder.join(file).exists();
        let known = state.listed.iter().map(String::as_str).chain(LOCKS);
        let files: BTreeSet<String> = known.filter(is_there).map(str::to_owned).collect();
        drop(state);
        let run = Signed {
            program: PROGRAM,
            program_version: super::VERSION,
            build: provenance::BUILD,
            commit: provenance::COMMIT,
            more,
            kind: self.kind,
            files: &files,
        };
        let path = self.folder.join(name);
        let bytes = serde_json::to_vec_pretty(&run).map(|bytes| [&bytes[..], b"\n"].concat());
        let written = match bytes {
            Ok(bytes) => super::write_atomically(&path, &bytes),
            Err(error) => Err(StoreError::Encode {
                path,
                reason: error.to_string(),
            }),
        };
        if is_alone && written.is_ok() {
            self.lock.empty();
        }
        self.lock.share();
        written
    }
}
