//! The folder of a sweep: which sweep it belongs to, and every file written whole or not at all.

use std::fs::{self, Permissions};
use std::io::{self, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::sweep::record::CaseRecord;

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
        "{path} holds results of a different sweep or scenario; choose another folder with --out, or replace them with --force"
    )]
    OtherSweep { path: PathBuf },
}

/// A folder that holds the results of one sweep.
#[derive(Debug, Clone)]
pub struct Store {
    folder: PathBuf,
    sweep_hash: String,
}

/// A record as stored, with what it takes to know that it belongs to the sweep.
#[derive(Serialize, Deserialize)]
struct Stored<'a> {
    program_version: &'a str,
    sweep_hash: &'a str,
    case: std::borrow::Cow<'a, CaseRecord>,
}

/// The resolved sweep file inside the folder.
pub const RESOLVED: &str = "resolved.toml";

/// What a sweep leaves in its folder besides single files: folders with one file per case.
const CASE_FOLDERS: [&str; 2] = ["records", "loops"];
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
        };
        let path = folder.join(RESOLVED);
        match fs::read(&path) {
            Ok(existing) if existing == resolved.as_bytes() => {}
            Ok(_) if !force => {
                return Err(StoreError::OtherSweep {
                    path: folder.to_path_buf(),
                });
            }
            Ok(_) => store.clear()?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(source) => return Err(StoreError::Read { path, source }),
        }
        store.write(RESOLVED, resolved.as_bytes())?;
        Ok(store)
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

    /// Stores the record of a finished case.
    ///
    /// # Errors
    /// [`StoreError`] with the path.
    pub fn save_case(&self, record: &CaseRecord) -> Result<(), StoreError> {
        let name = Path::new(CASE_FOLDERS[0]).join(format!("{:04}.json", record.index));
        let stored = Stored {
            program_version: env!("CARGO_PKG_VERSION"),
            sweep_hash: &self.sweep_hash,
            case: std::borrow::Cow::Borrowed(record),
        };
        let text = serde_json::to_vec(&stored).map_err(|error| StoreError::Encode {
            path: self.folder.join(&name),
            reason: error.to_string(),
        })?;
        self.write(name, &text)
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
        let of_scenarios = crate::sweep::scenario::RESULT_FILES.map(str::to_owned);
        for name in crate::sweep::files::of_sweep().chain(of_scenarios) {
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
    let write = || -> io::Result<()> {
        // tempfile's own default is readable by the owner alone.
        let mut file = tempfile::Builder::new()
            .permissions(Permissions::from_mode(0o666))
            .tempfile_in(folder)?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        file.persist(path)?;
        Ok(())
    };
    write().map_err(|source| StoreError::Write {
        path: path.to_path_buf(),
        source,
    })
}
