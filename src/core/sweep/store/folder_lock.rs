//! The lock of a result folder: shared by the processes at work in it, exclusive for the one that removes what is there.
//!
//! The system releases it when its process ends, however it ends: a killed process leaves no folder locked. A network file
//! system may have no locks, or keep them to each machine. Work then goes on without, and the plan in the folder protects the
//! results: it is published exclusively, compared before every write, and named by every record; see [`crate::sweep::store`].
//!
//! While commands work in the folder the file also holds the names of the files that they write, see [`super::manifest`].

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::Path;

/// The file that is locked. It stays: were it removed, two processes could hold locks on two files of this name.
pub(super) const LOCK: &str = ".contact-dma.lock";
/// The same of the processes that compute cases there: one, or shards.
const LOCK_TO_COMPUTE: &str = ".contact-dma.compute.lock";
/// Every file that is locked.
pub(super) const LOCKS: [&str; 2] = [LOCK, LOCK_TO_COMPUTE];

/// Who else is at work in a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Others {
    Absent,
    AtWork,
    /// The file system has no locks.
    Unknown,
}

/// The lock of a folder as this process has it; released when it is dropped.
#[derive(Debug)]
pub(crate) struct FolderLock {
    /// `None` where the file can neither be created nor opened.
    file: Option<File>,
    /// Not where it is another user's.
    is_writable: bool,
}

impl FolderLock {
    /// The lock of a folder, not taken yet.
    pub(crate) fn of(folder: &Path) -> Self {
        Self::on(&folder.join(LOCK))
    }

    /// That of the processes that compute cases in it, which is exclusive but for shards.
    pub(crate) fn to_compute(folder: &Path) -> Self {
        Self::on(&folder.join(LOCK_TO_COMPUTE))
    }

    fn on(path: &Path) -> Self {
        // Through a link, names would be written into a file that is somebody else's.
        if fs::symlink_metadata(path).is_ok_and(|file| !file.is_file()) {
            return Self::none();
        }
        // NFS asks for a file open for writing to lock it exclusively.
        let file = File::options()
            .read(true)
            .append(true)
            .create(true)
            .open(path);
        let is_writable = file.is_ok();
        // Another user's, in a folder of several.
        let file = file.or_else(|_| File::open(path)).ok();
        Self { file, is_writable }
    }

    /// A lock that protects nothing, for folders that are only read.
    pub(crate) fn none() -> Self {
        Self {
            file: None,
            is_writable: false,
        }
    }

    /// What the file holds; nothing where it is absent.
    pub(super) fn content(&self) -> String {
        let mut text = Vec::new();
        if let Some(mut file) = self.file.as_ref() {
            // A file that cannot be read lists nothing: what is in the folder then stays as it is.
            let _ = file.rewind().and_then(|()| file.read_to_end(&mut text));
        }
        String::from_utf8_lossy(&text).into_owned()
    }

    /// Appends text in one write, so that what several processes append does not mix.
    ///
    /// # Errors
    /// Of the file system. To a file that may only be read nothing is appended.
    pub(super) fn append(&self, text: &str) -> io::Result<()> {
        match self.file.as_ref() {
            Some(mut file) if self.is_writable => file.write_all(text.as_bytes()),
            _ => Ok(()),
        }
    }

    /// Empties the file, for the one that holds the lock exclusively.
    pub(super) fn empty(&self) {
        if let Some(file) = &self.file {
            // Names that stay listed are those of files that were written.
            let _ = file.set_len(0);
        }
    }

    /// Takes the lock exclusively where nobody else has it.
    pub(crate) fn try_exclusive(&self) -> Others {
        self.taken(File::try_lock)
    }

    /// Takes the lock together with others where nobody has it exclusively.
    pub(crate) fn try_shared(&self) -> Others {
        self.taken(File::try_lock_shared)
    }

    fn taken(&self, lock: fn(&File) -> Result<(), TryLockError>) -> Others {
        match self.file.as_ref().map(lock) {
            Some(Ok(())) => Others::Absent,
            Some(Err(TryLockError::WouldBlock)) => Others::AtWork,
            Some(Err(TryLockError::Error(_))) | None => Others::Unknown,
        }
    }

    /// Exchanges an exclusive lock, or none, for a shared one, after waiting for one that clears the folder. Others may come
    /// between the two: what was found in the folder before must be checked again.
    pub(crate) fn share(&self) {
        let Some(file) = &self.file else { return };
        self.release();
        // Any other error: the file system has no locks.
        while file
            .lock_shared()
            .is_err_and(|error| error.kind() == ErrorKind::Interrupted)
        {}
    }

    /// Gives the lock back.
    pub(crate) fn release(&self) {
        if let Some(file) = &self.file {
            // Where there are no locks, none is held.
            let _ = file.unlock();
        }
    }
}

/// The lock goes with the open file, of which a program started meanwhile by another thread has a copy until it runs: closing
/// ours would leave the folder locked until then.
impl Drop for FolderLock {
    fn drop(&mut self) {
        self.release();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lock_is_shared_by_many_or_held_by_one_and_dropping_it_releases_it() {
        let folder = tempfile::TempDir::new().unwrap();
        let [one, two, three] = [(); 3].map(|()| FolderLock::of(folder.path()));
        assert_eq!(one.try_exclusive(), Others::Absent);
        assert_eq!(two.try_exclusive(), Others::AtWork);
        one.share();
        two.share();
        assert_eq!(three.try_exclusive(), Others::AtWork);
        drop(one);
        assert_eq!(three.try_exclusive(), Others::AtWork);
        drop(two);
        assert_eq!(three.try_exclusive(), Others::Absent);
    }

    #[test]
    fn a_lock_is_released_though_a_program_that_is_being_started_has_a_copy_of_its_file() {
        let folder = tempfile::TempDir::new().unwrap();
        let [one, two] = [(); 2].map(|()| FolderLock::of(folder.path()));
        one.share();
        let _copy = one.file.as_ref().unwrap().try_clone().unwrap();
        drop(one);
        assert_eq!(two.try_exclusive(), Others::Absent);
    }

    #[test]
    fn where_there_can_be_no_lock_nobody_is_said_to_be_absent_or_at_work() {
        let folder = tempfile::TempDir::new().unwrap();
        let nowhere = FolderLock::of(&folder.path().join("nowhere"));
        nowhere.share();
        assert_eq!(nowhere.try_exclusive(), Others::Unknown);
    }
}
