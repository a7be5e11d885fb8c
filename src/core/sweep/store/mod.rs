//! The folder of a sweep: which sweep it belongs to, and files that are written atomically.
//!
//! A folder has one plan, its `resolved.toml`. Of several processes that begin at once one publishes it; shards of the same
//! sweep compute beside one another, and any other is refused. Whoever works in the folder shares its lock, and only the one that
//! holds it alone replaces a plan (`--force`) or removes what killed processes have left. Machines that do not see
//! one another's locks are safe all the same: a plan is compared before every file takes its name, so that a process whose folder
//! was replaced stops, and a record names its plan and is never read under another.
//!
//! The program replaces and removes only what it has written itself, which `run.json` lists: see [`manifest`].

pub mod checkpoint_file;
pub mod difference;
pub mod entry;
mod error;
pub mod files;
pub(crate) mod folder_lock;
mod listing;
pub mod log;
pub mod manifest;
pub mod merge;
pub mod provenance;
pub mod records;

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};
use std::time::SystemTime;

use tempfile::NamedTempFile;

pub use error::{Remedy, StoreError};

use crate::sweep::plan::resolved::{hash, identity};
use crate::sweep::store::files::Place;
use crate::sweep::store::folder_lock::{FolderLock, Others};
use crate::sweep::store::manifest::{Kind, Manifest, Target};
use crate::sweep::store::records::Records;

/// A folder that holds the results of one sweep.
#[derive(Debug, Clone)]
pub struct Store {
    pub(crate) folder: PathBuf,
    pub(crate) sweep_hash: String,
    manifest: Arc<Manifest>,
    records: Arc<Records>,
    /// Of a process that computes: see [`Self::claim`].
    claim: Arc<OnceLock<FolderLock>>,
    /// When the resolved file was written that was last found to be of this sweep, and its length.
    checked: Arc<Mutex<Option<(SystemTime, u64)>>>,
}

/// Where the records of a sweep are: in its folder, or in memory.
pub trait Archive: Sync {
    fn records(&self) -> &Records;

    /// The folder; `None` in memory.
    fn store(&self) -> Option<&Store> {
        None
    }
}

impl Archive for Records {
    fn records(&self) -> &Records {
        self
    }
}

impl Archive for Store {
    fn records(&self) -> &Records {
        &self.records
    }

    fn store(&self) -> Option<&Store> {
        Some(self)
    }
}

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The resolved sweep file inside the folder.
pub const RESOLVED: &str = "resolved.toml";

/// How many changed lines of a resolved sweep a message shows.
const LINES_SHOWN: usize = 12;
/// How the names of files begin that have not taken their own name yet: with the machine, so that none removes those of another,
/// of whose locks it may not know.
static TEMPORARY: LazyLock<String> = LazyLock::new(|| {
    let mut host = provenance::host().unwrap_or_default();
    host.retain(|c| c.is_ascii_alphanumeric() || "-.".contains(c));
    format!(".contact-dma-{host}~")
});

impl Store {
    /// Opens (or creates) a folder for a sweep whose resolved text is given, and proves that it can be written.
    ///
    /// # Errors
    /// [`StoreError::OtherSweep`] where the folder holds another sweep's results and `force` is not given,
    /// [`StoreError::InUse`] where it is given and another process is at work there; [`StoreError::Foreign`] where the folder
    /// holds files of others.
    pub fn open(folder: &Path, resolved: &str, force: bool) -> Result<Self, StoreError> {
        Self::open_reading(folder, resolved, force, &[])
    }

    /// As [`Store::open`], for a sweep that is made of these files, of which none may be replaced.
    ///
    /// # Errors
    /// As [`Store::open`]; [`StoreError::ReplacesInput`].
    pub fn open_reading(
        folder: &Path,
        resolved: &str,
        force: bool,
        reads: &[PathBuf],
    ) -> Result<Self, StoreError> {
        let target = Target {
            folder,
            kind: Kind::of_plan(resolved),
            force,
            reads,
        };
        let (manifest, others, is_other_kind) =
            target.take(Some(resolved), &files::is_in_the_way)?;
        let store = Self::of(folder, resolved, manifest, force);
        if force {
            if others == Others::AtWork {
                return Err(in_use(folder));
            }
            store.replace(resolved, is_other_kind)?;
        }
        store.manifest.lock.share();
        if others == Others::AtWork {
            // A command that has filled the folder meanwhile.
            target.look(Some(resolved), &files::is_in_the_way)?;
        }
        store.publish(resolved)?;
        Ok(store)
    }

    /// Opens a folder in which a sweep has been computed, to draw its results again; the resolved sweep is returned with it.
    ///
    /// # Errors
    /// [`StoreError`] where the folder holds none.
    pub fn reopen(folder: &Path) -> Result<(Self, String), StoreError> {
        // A folder of something else is left as it is, without a lock.
        read_plan(folder)?;
        let lock = FolderLock::of(folder);
        let is_alone = lock.try_exclusive() == Others::Absent;
        let resolved = read_plan(folder)?;
        let listed = listing::look(folder, Some(&resolved))?;
        let manifest = Manifest::new(folder, Kind::of_plan(&resolved), lock, listed.files);
        if is_alone {
            manifest.remove_temporaries();
        }
        manifest.lock.share();
        manifest.begin()?;
        Ok((Self::of(folder, &resolved, manifest, false), resolved))
    }

    /// As [`Store::reopen`], where nothing is to be written into the folder.
    ///
    /// # Errors
    /// As [`Store::reopen`].
    pub fn reopen_to_read(folder: &Path) -> Result<(Self, String), StoreError> {
        let resolved = read_plan(folder)?;
        let (kind, lock) = (Kind::of_plan(&resolved), FolderLock::none());
        let manifest = Manifest::new(folder, kind, lock, BTreeSet::new());
        Ok((Self::of(folder, &resolved, manifest, false), resolved))
    }

    fn of(folder: &Path, resolved: &str, manifest: Manifest, force: bool) -> Self {
        let sweep_hash = hash(resolved);
        Self {
            folder: folder.to_path_buf(),
            records: Arc::new(Records::in_folder(folder, &sweep_hash, force)),
            claim: Arc::default(),
            sweep_hash,
            checked: Arc::default(),
            manifest: Arc::new(manifest),
        }
    }

    /// Replaces another sweep's plan and results, where there are any.
    fn replace(&self, resolved: &str, is_other_kind: bool) -> Result<(), StoreError> {
        let is_other = match self.plan()? {
            Some(existing) => !self.is_own(&existing, resolved),
            None => is_other_kind,
        };
        if is_other {
            // Killed between the two, it leaves the plan of what is gone, never results of another.
            self.manifest.begin()?;
            self.manifest.clear()?;
            self.manifest.record(RESOLVED)?;
            write_atomically(&self.folder.join(RESOLVED), resolved.as_bytes())?;
        }
        Ok(())
    }

    /// The resolved file as it is, damaged or not.
    fn plan(&self) -> Result<Option<String>, StoreError> {
        let path = self.folder.join(RESOLVED);
        match fs::read(&path) {
            Ok(bytes) => Ok(Some(String::from_utf8_lossy(&bytes).into_owned())),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(source) => Err(StoreError::Read { path, source }),
        }
    }

    /// Whether a plan is that of this sweep, with whatever figures and places of data, or was until it was damaged: it has no records,
    /// and this sweep has.
    fn is_own(&self, existing: &str, resolved: &str) -> bool {
        let has_records = |plan: &str| listing::has_records(&self.folder, plan);
        let is_same = identity(existing) == identity(resolved);
        is_same || has_records(resolved) && !has_records(existing)
    }

    /// Makes this sweep the plan of the folder, unless it is, or another one is.
    fn publish(&self, resolved: &str) -> Result<(), StoreError> {
        let path = self.folder.join(RESOLVED);
        if self.plan()?.is_none() {
            self.manifest.begin()?;
            self.manifest.record(RESOLVED)?;
            create_atomically(&path, resolved.as_bytes())?;
        }
        let existing = self.plan()?.unwrap_or_default();
        if !self.is_own(&existing, resolved) {
            self.manifest.lock.release();
            let at_work = self.manifest.lock.try_exclusive() == Others::AtWork;
            let (existing, resolved) = (identity(&existing), identity(resolved));
            return Err(StoreError::OtherSweep {
                path: self.folder.clone(),
                at_work,
                difference: difference::lines(&existing, &resolved, LINES_SHOWN),
            });
        }
        self.manifest.begin()?;
        if existing != resolved {
            self.manifest.record(RESOLVED)?;
            write_atomically(&path, resolved.as_bytes())?;
        }
        Ok(())
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The records in it.
    pub fn records(&self) -> &Records {
        &self.records
    }

    /// Takes the folder for computing, until the store is dropped: alone, or together with others that compute other cases.
    ///
    /// # Errors
    /// [`StoreError::Computed`] where another process has it.
    pub(crate) fn claim(&self, alone: bool) -> Result<(), StoreError> {
        if self.claim.get().is_some() {
            return Ok(());
        }
        let lock = FolderLock::to_compute(&self.folder);
        let others = match alone {
            true => lock.try_exclusive(),
            false => lock.try_shared(),
        };
        if others == Others::AtWork {
            return Err(StoreError::Computed {
                path: self.folder.clone(),
            });
        }
        self.claim.get_or_init(|| lock);
        Ok(())
    }

    /// Hash of the resolved sweep.
    pub fn sweep_hash(&self) -> &str {
        &self.sweep_hash
    }

    /// Writes a file of the folder atomically: into a temporary file beside it, which is then renamed.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path; [`StoreError::TakenOver`] where the folder is of another sweep by now.
    pub fn write(&self, place: Place<'_>, bytes: &[u8]) -> Result<(), StoreError> {
        self.write_with(place, |file| file.write_all(bytes))
    }

    /// The same, of a file that is written bit by bit.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub fn write_with(
        &self,
        place: Place<'_>,
        write: impl FnOnce(&mut fs::File) -> io::Result<()>,
    ) -> Result<(), StoreError> {
        let name = place.to_string();
        self.manifest.record(&name)?;
        let path = self.folder.join(name);
        let file = temporary(&path, write)?;
        self.check_plan()?;
        rename(file, &path)
    }

    /// Whether the folder is of this sweep still. The plan is read again only where its file is another one than was last read.
    pub(crate) fn check_plan(&self) -> Result<(), StoreError> {
        // What takes the file's place after this is seen at the next look.
        let found = fs::metadata(self.folder.join(RESOLVED));
        let found = found
            .and_then(|file| Ok((file.modified()?, file.len())))
            .ok();
        let mut checked = self.checked.lock().unwrap_or_else(PoisonError::into_inner);
        if found.is_some() && *checked == found {
            return Ok(());
        }
        match read_plan(&self.folder) {
            Ok(resolved) if hash(&resolved) == self.sweep_hash => {
                *checked = found;
                Ok(())
            }
            Ok(_) | Err(StoreError::NoSweep { .. }) => Err(StoreError::TakenOver {
                path: self.folder.clone(),
            }),
            Err(error) => Err(error),
        }
    }

    /// Removes checkpoints: those of a case by its name, or all.
    pub(crate) fn remove_checkpoints(&self, case: &str) {
        for folder in files::checkpoints_of(case) {
            // Left behind, they cost nothing but their place.
            let _ = self.manifest.remove_below(&folder, case.is_empty());
        }
    }

    /// Removes what an earlier run has written and this one has not: it showed more, or something else. Records stay.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path.
    pub fn remove_stale(&self) -> Result<(), StoreError> {
        self.check_plan()?;
        self.manifest.remove_stale()
    }
}

/// A name with `/` between its parts on every system.
fn name_of(name: &Path) -> String {
    let parts = name.iter().map(|part| part.to_string_lossy());
    parts.collect::<Vec<_>>().join("/")
}

/// Another process is at work in the folder.
fn in_use(folder: &Path) -> StoreError {
    let title = || {
        let plan: toml::Table = read_plan(folder).ok()?.parse().ok()?;
        Some(plan.get("title")?.to_string())
    };
    StoreError::InUse {
        path: folder.to_path_buf(),
        running: title().unwrap_or_else(|| "another command".to_owned()),
    }
}

/// The resolved sweep of a folder.
fn read_plan(folder: &Path) -> Result<String, StoreError> {
    let path = folder.join(RESOLVED);
    fs::read_to_string(&path).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => StoreError::NoSweep {
            path: folder.to_path_buf(),
            reason: format!("it has no {RESOLVED}"),
        },
        _ => StoreError::Read { path, source },
    })
}

/// Writes a file atomically and creates its folder where needed. The umask decides its permissions.
///
/// # Errors
/// [`StoreError`] with the path.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    rename(temporary(path, |file| file.write_all(bytes))?, path)
}

/// The same, unless there is a file of that name: of several that try at once one does.
fn create_atomically(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    let file = temporary(path, |file| file.write_all(bytes))?;
    match file.persist_noclobber(path) {
        // A file system with neither renames that replace nothing nor hard links: of two that begin there within this moment, the
        // one that is replaced finds so at its next write.
        Err(_) if !path.exists() => write_atomically(path, bytes),
        _ => Ok(()),
    }
}

fn create_folder(folder: &Path) -> Result<(), StoreError> {
    fs::create_dir_all(folder).map_err(|source| StoreError::Create {
        path: folder.to_path_buf(),
        source,
    })
}

/// A whole file beside the one whose name it is to take, in a folder that is created where needed.
fn temporary(
    path: &Path,
    write_content: impl FnOnce(&mut fs::File) -> io::Result<()>,
) -> Result<NamedTempFile, StoreError> {
    let folder = path.parent().unwrap_or(Path::new("."));
    create_folder(folder)?;
    let write = || {
        let mut builder = tempfile::Builder::new();
        builder.prefix(TEMPORARY.as_str());
        // tempfile's own default is readable by the owner alone. Elsewhere a file has the permissions of its folder.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut file = builder.tempfile_in(folder)?;
        write_content(file.as_file_mut())?;
        file.as_file().sync_all()?;
        Ok(file)
    };
    write().map_err(|source| StoreError::Write {
        path: path.to_path_buf(),
        source,
    })
}

/// Gives a temporary file its name.
fn rename(file: NamedTempFile, path: &Path) -> Result<(), StoreError> {
    let persisted = file.persist(path);
    persisted.map(drop).map_err(|error| StoreError::Write {
        path: path.to_path_buf(),
        source: error.error,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAN: &str = "title = \"one\"\nsteps = 8\n";
    const OTHER: &str = "title = \"other\"\nsteps = 16\n";

    #[test]
    fn a_file_half_written_is_removed_when_nobody_of_its_machine_can_be_writing_it() {
        let folder = tempfile::TempDir::new().unwrap();
        let at_work = Store::open(folder.path(), PLAN, false).unwrap();
        let name = |of: &str| folder.path().join(format!("{of}half"));
        let (own, foreign) = (name(TEMPORARY.as_str()), name(".contact-dma-elsewhere~"));
        for path in [&own, &foreign] {
            fs::write(path, "").unwrap();
        }
        drop(Store::open(folder.path(), PLAN, false).unwrap());
        assert!(own.exists());
        drop(at_work);
        drop(Store::open(folder.path(), PLAN, false).unwrap());
        assert!(!own.exists() && foreign.exists());
    }

    #[test]
    fn a_plan_at_work_is_replaced_by_nobody_and_one_at_rest_when_forced() {
        let folder = tempfile::TempDir::new().unwrap();
        let at_work = Store::open(folder.path(), PLAN, false).unwrap();
        for name in ["0000.json", "run-1-of-2.json"] {
            at_work.write(Place::Record(name), b"{}").unwrap();
        }
        for plan in [PLAN, OTHER] {
            let refused = Store::open(folder.path(), plan, true).unwrap_err();
            assert!(matches!(&refused, StoreError::InUse { running, .. } if running == "\"one\""));
        }
        let refused = Store::open(folder.path(), OTHER, false).unwrap_err();
        assert!(matches!(
            refused,
            StoreError::OtherSweep { at_work: true, .. }
        ));
        drop(at_work);
        assert!(folder.path().join("records/0000.json").exists());
        let refused = Store::open(folder.path(), OTHER, false).unwrap_err();
        assert!(matches!(
            refused,
            StoreError::OtherSweep { at_work: false, .. }
        ));
        Store::open(folder.path(), OTHER, true).unwrap();
        assert!(!folder.path().join("records").exists());
        assert_eq!(read_plan(folder.path()).unwrap(), OTHER);
    }

    /// As a machine does whose locks are not seen here.
    #[test]
    fn a_run_whose_plan_was_replaced_or_removed_writes_nothing_more() {
        let folder = tempfile::TempDir::new().unwrap();
        let store = Store::open(folder.path(), PLAN, false).unwrap();
        let refused = || {
            let written = store.write(Place::Record("0000.json"), b"{}");
            matches!(written, Err(StoreError::TakenOver { .. }))
        };
        write_atomically(&folder.path().join(RESOLVED), OTHER.as_bytes()).unwrap();
        assert!(refused());
        fs::remove_file(folder.path().join(RESOLVED)).unwrap();
        assert!(refused());
        let mut records = fs::read_dir(folder.path().join("records")).unwrap();
        assert!(records.next().is_none());
    }

    #[test]
    fn a_name_is_taken_once() {
        let folder = tempfile::TempDir::new().unwrap();
        let path = folder.path().join(RESOLVED);
        create_atomically(&path, PLAN.as_bytes()).unwrap();
        create_atomically(&path, OTHER.as_bytes()).unwrap();
        assert_eq!(read_plan(folder.path()).unwrap(), PLAN);
    }
}
