//! The records of a sweep: which cases have one, and where it stands, in a log of this process or of another one, or in memory.
//!
//! A folder has one log per process that ever worked in it; how a record stands in it, see [`super::entry`]. Records in memory are a log
//! that is no file: they can be handed to another process, and put into a folder.

use std::collections::HashMap;
use std::fs;
use std::io::{self, Cursor};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::entry::{self, Heading, Key, Origin, Purpose};
use super::log::{self, LogWriter, Met};
use super::provenance::BUILD;
use super::{Store, StoreError, VERSION, files};
use crate::sweep::plan::Case;
use crate::sweep::record::CaseRecord;

/// What is said of bytes that are no record.
const NOT_USED: &str = "(their checksum does not match): what stood there is not used";
const NO_END: &str = "(a record without its end): they are not used";

/// Where a record stands, behind a heading of this length (bytes).
#[derive(Debug, Clone)]
struct Place {
    origin: Origin,
    heading: usize,
    content: Content,
}

#[derive(Debug, Clone)]
enum Content {
    Memory(Arc<[u8]>),
    Log {
        log: Arc<Path>,
        at: u64,
        length: usize,
    },
}

impl Content {
    /// The log that it stands in; nowhere in memory.
    fn path(&self) -> PathBuf {
        match self {
            Self::Memory(_) => PathBuf::new(),
            Self::Log { log, .. } => log.to_path_buf(),
        }
    }
}

/// What there is of a case.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Kept {
    /// Of this version of the program.
    pub record: Option<Box<CaseRecord>>,
    /// Where one stands that is not to be used, and why: it is damaged, or of another version, or of another build of this one, whose
    /// numbers may be others.
    pub refusal: Option<String>,
}

impl Kept {
    /// The record, where it is one of this build.
    pub fn intact(self) -> Option<CaseRecord> {
        self.record
            .filter(|_| self.refusal.is_none())
            .map(|record| *record)
    }
}

/// What is said of a record of another build.
const OF_ANOTHER_BUILD: &str = concat!(
    "it was written by another build of version ",
    env!("CARGO_PKG_VERSION"),
    " of the program"
);

/// The records of one sweep, in its folder or in memory alone.
#[derive(Debug, Default)]
pub struct Records(Mutex<State>);

#[derive(Debug, Default)]
struct State {
    /// The folder of the logs; `None` in memory.
    folder: Option<PathBuf>,
    /// Of records in memory it is not asked: they never were another sweep's.
    sweep_hash: String,
    /// Whether records of a newer program may be replaced.
    force: bool,
    places: HashMap<Key, Place>,
    /// Logs of the folder, and how far each has been read.
    read: HashMap<Arc<Path>, u64>,
    has_looked: bool,
    /// What was met that is no record of this sweep, and why.
    unread: Vec<String>,
    own: Option<LogWriter>,
}

impl Records {
    pub(super) fn in_folder(folder: &Path, sweep_hash: &str, force: bool) -> Self {
        Self(Mutex::new(State {
            folder: Some(folder.join(files::RECORDS)),
            sweep_hash: sweep_hash.to_owned(),
            force,
            ..State::default()
        }))
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        // What a panicking thread has left half done is read from the files again, at worst.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// With what the folder holds, which is read once.
    fn state(&self) -> Result<MutexGuard<'_, State>, StoreError> {
        let mut state = self.lock();
        if !state.has_looked {
            state.look()?;
        }
        Ok(state)
    }

    /// Reads what other processes have appended since the folder was last looked at; what was met that is no record of this sweep.
    ///
    /// # Errors
    /// [`StoreError::Read`] with the path.
    pub fn look(&self) -> Result<Vec<String>, StoreError> {
        let mut state = self.lock();
        state.look()?;
        Ok(std::mem::take(&mut state.unread))
    }

    /// Whether there are any of this sweep.
    pub(super) fn is_empty(&self) -> bool {
        self.state().map_or(true, |state| state.places.is_empty())
    }

    /// Appends the record of a finished case.
    ///
    /// # Errors
    /// [`StoreError`] with the path.
    pub fn insert(
        &self,
        purpose: Purpose,
        case: &Case,
        record: &CaseRecord,
    ) -> Result<(), StoreError> {
        // The cycle at a peak is drawn nowhere.
        let encoded = entry::encoded(record, purpose == Purpose::Sweep);
        let mut state = self.lock();
        let encoded = encoded.map_err(|reason| state.not_encoded(reason))?;
        state.append(Key::of(purpose, case), &encoded)
    }

    /// Brings all records appended to the disk.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path, where the disk turns out to be full for one.
    pub fn sync(&self) -> Result<(), StoreError> {
        let state = self.lock();
        let Some(writer) = &state.own else {
            return Ok(());
        };
        writer.finish().map_err(|source| StoreError::Write {
            path: writer.path().to_path_buf(),
            source,
        })
    }

    fn place(&self, key: &Key) -> Result<Option<Place>, StoreError> {
        Ok(self.state()?.places.get(key).cloned())
    }

    /// The record at a place, without its heading.
    fn content(place: &Place) -> Result<Vec<u8>, StoreError> {
        let mut content = match &place.content {
            Content::Memory(content) => content.to_vec(),
            Content::Log { log, at, length } => {
                log::content(log, *at, *length).map_err(|source| StoreError::Read {
                    path: log.to_path_buf(),
                    source,
                })?
            }
        };
        Ok(content.split_off(place.heading))
    }

    /// The record of a case, where there is a usable one, with its cycle where that is asked for.
    ///
    /// # Errors
    /// [`StoreError`] where the record cannot be read, or was written by a newer program and may not be replaced.
    pub fn load(
        &self,
        purpose: Purpose,
        case: &Case,
        with_cycle: bool,
    ) -> Result<Kept, StoreError> {
        let Some(place) = self.place(&Key::of(purpose, case))? else {
            return Ok(Kept::default());
        };
        let path = place.content.path();
        let because = |reason: &str| Some(format!("{}: {reason}", path.display()));
        let unusable = |reason: &str| {
            Ok(Kept {
                record: None,
                refusal: because(reason),
            })
        };
        let refusal = match &place.origin {
            Origin::Newer(version) if !self.lock().force => {
                let version = version.clone();
                return Err(StoreError::NewerProgram { path, version });
            }
            Origin::Newer(version) => return unusable(&written_by(version, "newer")),
            Origin::Older(version) => return unusable(&written_by(version, "older")),
            Origin::AnotherBuild => because(OF_ANOTHER_BUILD),
            Origin::ThisBuild => None,
        };
        let content = Self::content(&place)?;
        let Some((mut record, cycle)) = entry::numbers(&content) else {
            return unusable(&format!("the record of case {} is damaged", case.index));
        };
        let same_frequency = record.angular_frequency_rad_per_s.to_bits()
            == case.angular_frequency_rad_per_s.to_bits();
        if !same_frequency || !record.is_of(&case.condition) {
            return unusable("a record in it belongs to another sweep");
        }
        record.index = case.index;
        if with_cycle {
            entry::add_cycle(&mut record, cycle);
        }
        let record = Some(Box::new(record));
        Ok(Kept { record, refusal })
    }

    /// Gives a record of the sweep its cycle, where there is one.
    ///
    /// # Errors
    /// [`StoreError::Read`] with the path.
    pub fn load_cycle(&self, record: &mut CaseRecord) -> Result<(), StoreError> {
        if let Some(place) = self.place(&Key::of_record(record))? {
            let content = Self::content(&place)?;
            if let Some((_, cycle)) = entry::numbers(&content) {
                entry::add_cycle(record, cycle);
            }
        }
        Ok(())
    }

    /// Appends every record of this build that others of the same sweep have and these have not. `differs` is called for those that both
    /// have and that are not the same; the first stays.
    ///
    /// # Errors
    /// [`StoreError`] with the path.
    pub(crate) fn take_from(
        &self,
        others: &Self,
        differs: &dyn Fn(&CaseRecord),
    ) -> Result<(), StoreError> {
        let is_own = |place: &Place| place.origin == Origin::ThisBuild;
        let mut places: Vec<_> = others.state()?.places.clone().into_iter().collect();
        places.sort_by(|(a, _), (b, _)| a.cmp(b));
        for (key, place) in places.into_iter().filter(|(_, place)| is_own(place)) {
            let record = Self::content(&place)?;
            match self.place(&key)?.filter(is_own) {
                None => self.lock().append(key, &record)?,
                Some(known) if Self::content(&known)? == record => {}
                Some(_) => {
                    if let Some((record, _)) = entry::numbers(&record) {
                        differs(&record);
                    }
                }
            }
        }
        self.sync()
    }

    /// Puts every record into the folder of the same sweep, but those of cases that have one there.
    ///
    /// # Errors
    /// [`StoreError`] with the path.
    pub fn put_into(&self, store: &Store) -> Result<(), StoreError> {
        store.check_plan()?;
        store.records.take_from(self, &|_| {})
    }

    /// Records in memory, for another process of the same build.
    pub fn to_bytes(&self) -> Vec<u8> {
        let state = self.lock();
        let mut places: Vec<_> = state.places.iter().collect();
        places.sort_by_key(|(key, _)| *key);
        let framed = places
            .into_iter()
            .filter_map(|(_, place)| match &place.content {
                Content::Memory(content) => log::framed(content).ok(),
                Content::Log { .. } => None,
            });
        framed.flatten().collect()
    }

    /// The records of [`Self::to_bytes`]; `None` of anything else.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let (mut state, mut are_own) = (State::default(), true);
        let meet = |met: Met<'_>| {
            are_own &= matches!(met, Met::Record { content, .. }
                if state.meet(content, Content::Memory(content.into())).is_ok());
        };
        let end = log::read_from(&mut Cursor::new(bytes), 0, meet).ok()?;
        (are_own && end == bytes.len() as u64).then(|| Self(Mutex::new(state)))
    }
}

impl State {
    fn not_encoded(&self, reason: String) -> StoreError {
        let path = self.folder.clone().unwrap_or_default();
        StoreError::Encode { path, reason }
    }

    /// Appends a record of this build. The folder of the logs is there once something was written.
    fn append(&mut self, key: Key, record: &[u8]) -> Result<(), StoreError> {
        let heading = Heading {
            program_version: VERSION,
            build: BUILD,
            sweep_hash: &self.sweep_hash,
            key,
        };
        let encoded = postcard::to_stdvec(&heading);
        let mut content = encoded.map_err(|error| self.not_encoded(error.to_string()))?;
        let (key, heading) = (heading.key, content.len());
        content.extend_from_slice(record);
        let framed = log::framed(&content);
        let framed = framed.map_err(|error| self.not_encoded(error.to_string()))?;
        let content = match &self.folder {
            None => Content::Memory(content.into()),
            Some(folder) => {
                let writer = match self.own.take() {
                    Some(writer) => writer,
                    None => LogWriter::in_folder(folder)?,
                };
                let writer = self.own.insert(writer);
                let log = Arc::clone(writer.path());
                if let Err(source) = writer.append(&framed) {
                    let path = log.to_path_buf();
                    return Err(StoreError::Write { path, source });
                }
                self.read.insert(Arc::clone(&log), writer.length());
                let length = content.len();
                let at = writer.length() - length as u64;
                Content::Log { log, at, length }
            }
        };
        let place = Place {
            origin: Origin::ThisBuild,
            heading,
            content,
        };
        self.places.insert(key, place);
        Ok(())
    }

    /// Reads what is new in the folder; nothing in memory.
    fn look(&mut self) -> Result<(), StoreError> {
        self.has_looked = true;
        let Some(folder) = self.folder.clone() else {
            return Ok(());
        };
        let failed = |path: &Path| {
            let path = path.to_path_buf();
            move |source| StoreError::Read { path, source }
        };
        let entries = match fs::read_dir(&folder) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            entries => entries.map_err(failed(&folder))?,
        };
        let mut paths = Vec::new();
        for entry in entries {
            let path = entry.map_err(failed(&folder))?.path();
            if path.extension().is_some_and(|ending| ending == log::ENDING) {
                paths.push(path);
            }
        }
        // Whatever the order in which a system lists them.
        paths.sort();
        for path in paths {
            self.look_at(&path).map_err(failed(&path))?;
        }
        Ok(())
    }

    /// Reads what a log has grown by.
    fn look_at(&mut self, path: &Path) -> io::Result<()> {
        let known = self.read.get_key_value(path);
        let is_first = known.is_none();
        let (log, from) = known.map_or((Arc::from(path), 0), |(log, to)| (Arc::clone(log), *to));
        let length = fs::metadata(path)?.len();
        if length <= from {
            return Ok(());
        }
        let mut reasons = Vec::new();
        let to = log::read(path, from, |met| match met {
            Met::Damaged { from, to } => reasons.push(format!(
                "bytes {from} to {to} are damaged or torn {NOT_USED}"
            )),
            Met::Record { at, content } => {
                let (log, length) = (Arc::clone(&log), content.len());
                let at = Content::Log { log, at, length };
                reasons.extend(self.meet(content, at).err());
            }
        })?;
        // A process that is killed leaves such an end, and one at work for a moment too: it is reported once.
        if to < length && is_first {
            let torn = length - to;
            reasons.push(format!(
                "its last {torn} bytes are damaged or torn {NO_END}"
            ));
        }
        let unread = reasons
            .iter()
            .map(|reason| format!("{}: {reason}", path.display()));
        self.unread.extend(unread);
        self.read.insert(log, to);
        Ok(())
    }

    /// Takes in where a whole record stands; why it is not used where it is of something else.
    fn meet(&mut self, bytes: &[u8], content: Content) -> Result<(), String> {
        let heading = postcard::take_from_bytes::<Heading<'_>>(bytes);
        let (heading, record) = heading.map_err(|_| "a record in it has no heading".to_owned())?;
        if heading.sweep_hash != self.sweep_hash {
            return Err("a record in it belongs to another sweep".to_owned());
        }
        let place = Place {
            origin: Origin::of(heading.program_version, heading.build),
            heading: bytes.len() - record.len(),
            content,
        };
        // Of several records of a case the one of this build counts, and of several of these the first.
        match self.places.get(&heading.key) {
            Some(known) if known.origin <= place.origin => {}
            _ => drop(self.places.insert(heading.key, place)),
        }
        Ok(())
    }
}

fn written_by(version: &str, age: &str) -> String {
    format!("it was written by version {version} of the program, {age} than this one")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::Sweep;
    use crate::sweep::case::Setup;
    use crate::sweep::plan::resolved::resolved_text;
    use crate::sweep::plan::{self, Method};
    use crate::sweep::record::Status;
    use crate::sweep::search::run::{self, Mode};

    const PLAN: &str = "title = \"a\"\n";

    fn case() -> Case {
        Case {
            index: 7,
            angular_frequency_rad_per_s: 0.1 + 0.2,
            condition: plan::tests::condition(),
        }
    }

    fn record(case: &Case) -> CaseRecord {
        CaseRecord {
            index: case.index,
            angular_frequency_rad_per_s: case.angular_frequency_rad_per_s,
            varied: case.condition.values,
            drive_mean: case.condition.drive.mean(),
            drive_amplitude: case.condition.drive.amplitude(),
            status: Status::NotConverged,
            message: Some("reached \"nothing\"".to_owned()),
            warnings: vec![
                crate::sweep::record::warning::Warning::LargeStrain { strain: 0.1 + 0.2 },
                crate::sweep::record::warning::Warning::NoErrorBars {
                    because: crate::sweep::record::warning::NoErrorBars::OwnCells,
                },
            ],
            method: Method::March,
            steps: 200,
            nodes: 400,
            cycles: 1000,
            steady_distance: Some(1.0 / 3.0),
            domain_half_width_m: 1e-3,
            domain_enlarged: 0,
            work: crate::history::Work {
                instants: 1_234,
                iterations: 12_345,
                convolutions: 0,
            },
            result: None,
        }
    }

    fn open(folder: &tempfile::TempDir) -> Store {
        Store::open(folder.path(), PLAN, false).unwrap()
    }

    /// The segment of a folder that has one.
    fn segment_of(folder: &tempfile::TempDir) -> PathBuf {
        let mut entries = std::fs::read_dir(folder.path().join("records")).unwrap();
        entries.next().unwrap().unwrap().path()
    }

    #[test]
    fn a_record_comes_back_bit_for_bit_in_every_process_and_only_for_its_own_case() {
        let folder = tempfile::TempDir::new().unwrap();
        let (store, case) = (open(&folder), case());
        let intact = || Some(record(&case));
        for purpose in [Purpose::Sweep, Purpose::Peak] {
            let another = open(&folder);
            assert_eq!(
                another.records().load(purpose, &case, false).unwrap(),
                Kept::default()
            );
            store
                .records()
                .insert(purpose, &case, &record(&case))
                .unwrap();
            assert_eq!(
                store
                    .records()
                    .load(purpose, &case, false)
                    .unwrap()
                    .intact(),
                intact()
            );
            another.records().look().unwrap();
            assert_eq!(
                another
                    .records()
                    .load(purpose, &case, false)
                    .unwrap()
                    .intact(),
                intact()
            );
        }
        let other = Case {
            angular_frequency_rad_per_s: 0.3,
            ..case.clone()
        };
        let kept = store.records().load(Purpose::Sweep, &other, false).unwrap();
        assert_eq!(kept, Kept::default());
    }

    #[test]
    fn a_solved_case_comes_back_with_its_cycle_and_a_peak_without() {
        let plan = crate::sweep::plan::SweepPlan::new(
            crate::material::library::find("pmma")
                .unwrap()
                .material()
                .unwrap(),
            plan::tests::condition().contact.indenter,
            plan::tests::condition().drive,
        );
        let mut plan = plan;
        plan.angular_frequencies_rad_per_s = vec![0.1 + 0.2];
        (plan.cycle.steps, plan.solver.springs) = (32, 40);
        let setup = crate::sweep::case::Setup::new(plan).unwrap();
        let case = Case {
            condition: setup.plan().base.clone(),
            ..case()
        };
        let interrupt = std::sync::atomic::AtomicBool::new(false);
        let solved = setup.run(&case, &interrupt).unwrap();
        assert!(solved.result.as_ref().unwrap().cycle.is_held());
        let folder = tempfile::TempDir::new().unwrap();
        let store = open(&folder);
        for (purpose, expected) in [
            (Purpose::Peak, solved.without_cycle()),
            (Purpose::Sweep, solved.clone()),
        ] {
            store.records().insert(purpose, &case, &solved).unwrap();
            let found = store.records().load(purpose, &case, false).unwrap();
            let mut found = found.intact().unwrap();
            assert_eq!(found, solved.without_cycle());
            store.records().load_cycle(&mut found).unwrap();
            assert_eq!(found, expected);
        }
    }

    /// A record of another build is read where its mark is of this form, whatever that build meant by its bytes.
    #[test]
    fn records_of_another_form_have_another_mark() {
        let case = case();
        let mut record = record(&case);
        let result = serde_json::json!({
            "analysis": {
                "energy_loss_j": 1.0, "polygon_loss_j": 1.0, "phase_lag_rad": 0.1, "load_mean_n": 1.0,
                "approach_mean_m": 1.0, "harmonics": []
            },
            "storage_modulus_pa": 1.0, "loss_modulus_pa": null,
            "approach_m": {"minimum": 0.0, "maximum": 1.0},
            "contact_radius_m": {"minimum": 0.0, "maximum": 1.0},
            "contact_duty": {"part": 1.0, "error": 0.0},
            "attraction": {"Constant": {"tabor_parameter": 2.0}}, "peak_pressure_pa": {"minimum": 0.0, "maximum": 1.0},
            "errors": {"bars": {"energy_loss": {"steps": 1.0, "nodes": 2.0, "steady": 3.0, "material": 4.0}}},
            "replica_losses_j": [1.0, null],
            "branches": [{"retardation_time_s": 1.0, "energy_loss_j": 1.0, "indenter_share": 0.5}],
            "cycle": {
                "samples": {
                    "time_s": [0.0, 1.0], "load_n": [1.0, 2.0], "approach_m": [1.0, 2.0],
                    "contact_radius_m": [1.0, 2.0], "peak_pressure_pa": [1.0, null]
                },
                "pressures": [{
                    "quarter": "mean-rising", "time_s": 0.0, "load_n": 1.0, "approach_m": 1.0, "contact_radius_m": 1.0,
                    "lines": [{"along": "radius", "position_m": [0.0], "pressure_pa": [null]}]
                }],
                "surface_loss": {"Radial": {"radius_m": [0.0], "density_j_per_m2": [1.0]}}
            }
        });
        record.result = Some(serde_json::from_value(result).unwrap());
        let sum = crc32fast::hash(&entry::encoded(&record, true).unwrap());
        // Where this fails, records have another form: write its sum here, and count the last byte of `log::MARK` up.
        assert_eq!(sum, 0xa2ed_b841, "{sum:#x}");
    }

    #[test]
    fn every_flipped_byte_of_a_record_is_named_and_the_record_before_it_stays() {
        let folder = tempfile::TempDir::new().unwrap();
        let (store, first) = (open(&folder), case());
        let second = Case {
            angular_frequency_rad_per_s: 0.5,
            ..first.clone()
        };
        for case in [&first, &second] {
            store
                .records()
                .insert(Purpose::Sweep, case, &record(case))
                .unwrap();
        }
        drop(store);
        let path = segment_of(&folder);
        let whole = std::fs::read(&path).unwrap();
        for byte in whole.len() / 2..whole.len() {
            let mut damaged = whole.clone();
            damaged[byte] ^= 0x20;
            std::fs::write(&path, damaged).unwrap();
            let store = open(&folder);
            let unread = store.records().look().unwrap();
            assert_eq!(unread.len(), 1, "byte {byte}");
            assert!(unread[0].contains("damaged or torn"), "{unread:?}");
            let kept = [&first, &second]
                .map(|case| store.records().load(Purpose::Sweep, case, false).unwrap());
            let [first, second] = kept;
            assert!(
                first.intact().is_some() && second == Kept::default(),
                "{byte}"
            );
        }
    }

    #[test]
    fn the_torn_end_of_a_segment_without_any_whole_record_is_told_once() {
        let folder = tempfile::TempDir::new().unwrap();
        let (store, case) = (open(&folder), case());
        let saved = store
            .records()
            .insert(Purpose::Sweep, &case, &record(&case));
        saved.unwrap();
        drop(store);
        let path = segment_of(&folder);
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, &whole[..whole.len() - 1]).unwrap();
        let store = open(&folder);
        let told = [(); 3].map(|()| store.records().look().unwrap().len());
        assert_eq!(told, [1, 0, 0]);
        // The process that was writing it comes to the end of its record.
        std::fs::write(&path, &whole).unwrap();
        assert!(store.records().look().unwrap().is_empty());
        let kept = store.records().load(Purpose::Sweep, &case, false).unwrap();
        assert!(kept.intact().is_some());
    }

    #[test]
    fn records_of_other_versions_are_not_used_and_what_is_no_segment_is_named() {
        let case = case();
        // The heading of a record begins with the version and the build.
        let with = |from: &str, to: &str| {
            let folder = tempfile::TempDir::new().unwrap();
            let store = open(&folder);
            let saved = store
                .records()
                .insert(Purpose::Sweep, &case, &record(&case));
            saved.unwrap();
            let path = segment_of(&folder);
            let mut content = Vec::new();
            let meet = |met: Met<'_>| {
                if let Met::Record { content: of, .. } = met {
                    content = of.to_vec();
                }
            };
            log::read(&path, 0, meet).unwrap();
            let at = content
                .windows(from.len())
                .position(|part| part == from.as_bytes());
            assert_eq!(from.len(), to.len());
            let at = at.unwrap();
            content[at..at + from.len()].copy_from_slice(to.as_bytes());
            std::fs::write(&path, log::framed(&content).unwrap()).unwrap();
            folder
        };
        let build = crate::sweep::store::provenance::BUILD;
        let folder = with(build, &"0".repeat(build.len()));
        let kept = open(&folder)
            .records()
            .load(Purpose::Sweep, &case, false)
            .unwrap();
        assert!(kept.refusal.unwrap().contains("another build"));
        assert_eq!(*kept.record.unwrap(), record(&case));
        let version = env!("CARGO_PKG_VERSION");
        let older = with(version, &version.replace(|c: char| c.is_ascii_digit(), "0"));
        let kept = open(&older)
            .records()
            .load(Purpose::Sweep, &case, false)
            .unwrap();
        assert!(kept.record.is_none() && kept.refusal.unwrap().contains("older"));
        let newer = with(version, &version.replace(|c: char| c.is_ascii_digit(), "9"));
        let store = open(&newer);
        let refused = store.records().load(Purpose::Sweep, &case, false);
        assert!(matches!(refused, Err(StoreError::NewerProgram { .. })));
        drop(store);
        let forced = Store::open(newer.path(), PLAN, true).unwrap();
        let kept = forced.records().load(Purpose::Sweep, &case, false).unwrap();
        assert!(kept.record.is_none() && kept.refusal.is_some());
        forced
            .records()
            .insert(Purpose::Sweep, &case, &record(&case))
            .unwrap();
        let kept = open(&newer)
            .records()
            .load(Purpose::Sweep, &case, false)
            .unwrap();
        assert!(kept.intact().is_some());
    }

    /// A sweep with a peak, and its records.
    fn solved() -> (Setup, Records) {
        let condition = plan::tests::condition();
        let material = condition.contact.material.as_ref().clone();
        let sphere = crate::indenter::Sphere::new(0.01).unwrap();
        let sweep = Sweep::new(material, sphere, condition.drive).title("a");
        let sweep = sweep.steps(16).unwrap().springs(16).unwrap();
        let sweep = sweep.frequencies_hz([1e-4, 1e-3, 1e-2]).unwrap();
        let setup = Setup::new(sweep.into_plan()).unwrap();
        let archive = Records::default();
        run::run(&setup, &archive, Mode::on_threads(1), &false.into(), &()).unwrap();
        (setup, archive)
    }

    #[test]
    fn records_that_were_moved_give_the_same_outcome_with_its_cycles_and_peaks() {
        let (setup, archive) = solved();
        let outcome = run::run(&setup, &archive, Mode::Read, &false.into(), &()).unwrap();
        assert!(outcome.records.iter().all(|r| r.result.is_some()));
        let moved = Records::from_bytes(&archive.to_bytes()).unwrap();
        assert_eq!(
            run::run(&setup, &moved, Mode::Read, &false.into(), &()).unwrap(),
            outcome
        );

        let folder = tempfile::TempDir::new().unwrap();
        let store = Store::open(folder.path(), &resolved_text(setup.plan()), false).unwrap();
        // The second time there is nothing left to do.
        for _ in 0..2 {
            archive.put_into(&store).unwrap();
            assert_eq!(
                run::run(&setup, &store, Mode::Read, &false.into(), &()).unwrap(),
                outcome
            );
        }
        let records = folder.path().join("records");
        let length =
            |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().metadata().unwrap().len();
        let once: u64 = std::fs::read_dir(&records).unwrap().map(length).sum();
        archive.put_into(&store).unwrap();
        assert_eq!(
            std::fs::read_dir(&records)
                .unwrap()
                .map(length)
                .sum::<u64>(),
            once
        );
    }

    #[test]
    fn bytes_of_anything_else_are_no_records() {
        let (_, archive) = solved();
        let bytes = archive.to_bytes();
        assert!(Records::from_bytes(&bytes[..bytes.len() - 1]).is_none());
        assert!(Records::from_bytes(b"records").is_none());
    }
}
