//! The folder of a sweep: which sweep it belongs to, and every file written whole or not at all.

use std::fs::{self, Permissions};
use std::io::{self, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use crate::sweep::checkpoint_file;
use crate::sweep::difference;
use crate::sweep::figure_plan::without_figures;
use crate::sweep::files;
use crate::sweep::resolved::hash;
use crate::sweep::scenario;

/// Why the folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    #[error("cannot create the folder {path}: {source}")]
    Create { path: PathBuf, source: io::Error },
    #[error("cannot write {path}: {source}")]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot read {path}: {source}")]
    Read { path: PathBuf, source: io::Error },
    #[error("cannot encode {path}: {reason}")]
    Encode { path: PathBuf, reason: String },
    #[error(
        "{path} holds results of a different sweep or scenario; choose another folder with --out, or replace them with --force\n\
         {difference}"
    )]
    OtherSweep { path: PathBuf, difference: String },
    #[error(
        "{path} was written by version {version} of the program, newer than this one ({}): use that version, choose another \
         folder with --out, or compute again with --force",
        env!("CARGO_PKG_VERSION")
    )]
    NewerProgram { path: PathBuf, version: String },
    #[error("{path} is no folder of a sweep: {reason}")]
    NoSweep { path: PathBuf, reason: String },
}

/// A folder that holds the results of one sweep.
#[derive(Debug, Clone)]
pub struct Store {
    pub(super) folder: PathBuf,
    pub(super) sweep_hash: String,
    /// Whether records of a newer program may be replaced.
    pub(super) force: bool,
}

/// The resolved sweep file inside the folder.
pub const RESOLVED: &str = "resolved.toml";

/// What a sweep leaves in its folder besides single files: folders with one file per case.
const CASE_FOLDERS: [&str; 6] = [
    "records",
    "loops",
    "pressures",
    "work",
    "peaks",
    "checkpoints",
];
/// How many changed lines of a resolved sweep a message shows.
const LINES_SHOWN: usize = 12;
/// How the names of files begin that have not taken their own name yet.
const TEMPORARY: &str = ".contact-dma-";
/// The same of a scenario: folders with one file per requested time.
const SURFACE_FOLDERS: [&str; 2] = ["profiles", "fields"];

impl Store {
    /// Opens (or creates) a folder for a sweep whose resolved text and hash are given, and proves that it can be written.
    ///
    /// # Errors
    /// [`StoreError::OtherSweep`] where the folder holds another sweep's results and `force` is not given.
    pub fn open(
        folder: &Path,
        resolved: &str,
        sweep_hash: &str,
        force: bool,
    ) -> Result<Self, StoreError> {
        fs::create_dir_all(folder).map_err(|source| StoreError::Create {
            path: folder.to_path_buf(),
            source,
        })?;
        let store = Self {
            folder: folder.to_path_buf(),
            sweep_hash: sweep_hash.to_owned(),
            force,
        };
        let path = folder.join(RESOLVED);
        match fs::read(&path) {
            Ok(existing) if is_same(&existing, resolved) => {}
            Ok(existing) if !force => {
                let existing = String::from_utf8_lossy(&existing);
                let (existing, resolved) = (without_figures(&existing), without_figures(resolved));
                return Err(StoreError::OtherSweep {
                    path: folder.to_path_buf(),
                    difference: difference::lines(existing, resolved, LINES_SHOWN),
                });
            }
            Ok(_) => store.clear()?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(source) => return Err(StoreError::Read { path, source }),
        }
        store.sweep_out();
        store.write(RESOLVED, resolved.as_bytes())?;
        Ok(store)
    }

    /// Opens a folder in which a sweep has been computed; the resolved sweep is returned with it.
    ///
    /// # Errors
    /// [`StoreError`] where the folder holds none.
    pub fn reopen(folder: &Path) -> Result<(Self, String), StoreError> {
        let path = folder.join(RESOLVED);
        let resolved = match fs::read_to_string(&path) {
            Ok(resolved) => resolved,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Err(StoreError::NoSweep {
                    path: folder.to_path_buf(),
                    reason: format!("it has no {RESOLVED}"),
                });
            }
            Err(source) => return Err(StoreError::Read { path, source }),
        };
        let store = Self {
            folder: folder.to_path_buf(),
            sweep_hash: hash(&resolved),
            force: false,
        };
        Ok((store, resolved))
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Hash of the resolved sweep.
    pub fn sweep_hash(&self) -> &str {
        &self.sweep_hash
    }

    /// Writes a file of the folder whole or not at all: into a temporary file beside it, which then takes its name.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path.
    pub fn write(&self, name: impl AsRef<Path>, bytes: &[u8]) -> Result<(), StoreError> {
        write_atomically(&self.folder.join(name), bytes)
    }

    /// Removes the checkpoints of all cases.
    pub(super) fn remove_checkpoints(&self) {
        // There are none, most often.
        let _ = fs::remove_dir_all(self.folder.join(checkpoint_file::FOLDER));
    }

    /// Removes what a process that was killed has left half-written. A process that is still writing there writes again.
    fn sweep_out(&self) {
        let folders = CASE_FOLDERS.iter().chain(&SURFACE_FOLDERS);
        let folders = folders.map(|name| self.folder.join(name));
        for folder in std::iter::once(self.folder.clone()).chain(folders) {
            let Ok(entries) = fs::read_dir(folder) else {
                continue;
            };
            for entry in entries.flatten() {
                if entry.file_name().to_string_lossy().starts_with(TEMPORARY) {
                    // Gone already, or not ours to remove: no reason to stop.
                    let _ = fs::remove_file(entry.path());
                }
            }
        }
    }

    /// Removes what an earlier sweep left, before another takes the folder.
    fn clear(&self) -> Result<(), StoreError> {
        let failed = |path: PathBuf| move |source| StoreError::Write { path, source };
        for folder in CASE_FOLDERS.into_iter().chain(SURFACE_FOLDERS) {
            let path = self.folder.join(folder);
            if path.is_dir() {
                fs::remove_dir_all(&path).map_err(failed(path.clone()))?;
            }
        }
        let of_scenarios = scenario::FIGURES.into_iter().flat_map(files::of_figure);
        for name in files::of_sweep().chain(of_scenarios) {
            self.remove(&name)?;
        }
        Ok(())
    }

    /// Removes a file of the folder, where there is one.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path.
    pub fn remove(&self, name: &str) -> Result<(), StoreError> {
        let path = self.folder.join(name);
        match fs::remove_file(&path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => {
                Err(StoreError::Write { path, source })
            }
            _ => Ok(()),
        }
    }
}

/// Whether a folder's resolved file is of the same sweep, however its figures look.
fn is_same(existing: &[u8], resolved: &str) -> bool {
    let existing = std::str::from_utf8(existing).map(without_figures);
    existing == Ok(without_figures(resolved))
}

/// Writes a file whole or not at all, creating its folder where needed. The umask decides its permissions.
///
/// # Errors
/// [`StoreError`] with the path.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(|source| StoreError::Create {
        path: folder.to_path_buf(),
        source,
    })?;
    let failed = |source| StoreError::Write {
        path: path.to_path_buf(),
        source,
    };
    for _ in 0..ATTEMPTS {
        match write_once(folder, path, bytes) {
            Err(error) if was_swept_out(&error) && folder.is_dir() => {}
            ended => return ended.map_err(failed),
        }
    }
    write_once(folder, path, bytes).map_err(failed)
}

/// How often a file is written anew whose unfinished form another process took for a left-over.
const ATTEMPTS: usize = 20;

fn write_once(folder: &Path, path: &Path, bytes: &[u8]) -> io::Result<()> {
    // tempfile's own default is readable by the owner alone.
    let mut file = tempfile::Builder::new()
        .prefix(TEMPORARY)
        .permissions(Permissions::from_mode(0o666))
        .tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    file.persist(path)?;
    Ok(())
}

/// Whether the temporary file is gone: by its name, or on a network file system by its handle.
fn was_swept_out(error: &io::Error) -> bool {
    const STALE_FILE_HANDLE: i32 = 116;
    error.kind() == io::ErrorKind::NotFound || error.raw_os_error() == Some(STALE_FILE_HANDLE)
}
