//! Records of finished cases: on disk, sealed, and read again where they are whole and of the same sweep and program; or in memory, see [`super::memory`].

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::sweep::plan::{AxisValues, Case};
use crate::sweep::record::CaseRecord;
pub use crate::sweep::store::memory::MemoryArchive;
use crate::sweep::store::packed_record;
use crate::sweep::store::records::{Key, Origin, Place, Unread};
use crate::sweep::store::{Store, StoreError};

/// Where the records of a sweep's cases are kept.
#[derive(Debug, Clone, Copy)]
pub enum Archive<'a> {
    Folder(&'a Store),
    Memory(&'a MemoryArchive),
}

impl<'a> From<&'a Store> for Archive<'a> {
    fn from(store: &'a Store) -> Self {
        Self::Folder(store)
    }
}

impl<'a> From<&'a MemoryArchive> for Archive<'a> {
    fn from(memory: &'a MemoryArchive) -> Self {
        Self::Memory(memory)
    }
}

impl<'a> Archive<'a> {
    /// The folder, of an archive that has one.
    pub fn store(self) -> Option<&'a Store> {
        match self {
            Self::Folder(store) => Some(store),
            Self::Memory(_) => None,
        }
    }

    /// As [`Store::save_case`].
    ///
    /// # Errors
    /// [`StoreError`] with the path, of a folder.
    pub fn save_case(
        self,
        purpose: Purpose,
        case: &Case,
        record: &CaseRecord,
    ) -> Result<(), StoreError> {
        match self {
            Self::Folder(store) => return store.save_case(purpose, case, record),
            Self::Memory(memory) => {
                memory
                    .records()
                    .insert(Key::of(purpose, case), record.clone());
            }
        }
        Ok(())
    }

    /// As [`Store::sync`]; of nothing in memory.
    ///
    /// # Errors
    /// As [`Store::sync`].
    pub(in crate::sweep) fn sync(self) -> Result<(), StoreError> {
        self.store().map_or(Ok(()), Store::sync)
    }

    /// As [`Store::load_case`], with the cycle where that is asked for; of a record in memory with it in any case.
    ///
    /// # Errors
    /// [`StoreError`] with the path, of a folder.
    pub(in crate::sweep) fn load_case(
        self,
        purpose: Purpose,
        case: &Case,
        with_cycle: bool,
    ) -> Result<Kept, StoreError> {
        match self {
            Self::Folder(store) => store.load(purpose, case, with_cycle),
            Self::Memory(memory) => Ok(match memory.records().get(&Key::of(purpose, case)) {
                Some(record) => Kept::Intact(Box::new(CaseRecord {
                    index: case.index,
                    ..record.clone()
                })),
                None => Kept::Absent,
            }),
        }
    }
}

impl Key {
    pub(in crate::sweep) fn of(purpose: Purpose, case: &Case) -> Self {
        let (drive, omega) = (&case.condition.drive, case.angular_frequency_rad_per_s);
        let drive = [drive.mean(), drive.amplitude()];
        Self::new(purpose, drive, omega, case.condition.values)
    }

    /// The case of the sweep whose record this is.
    fn of_record(record: &CaseRecord) -> Self {
        let drive = [record.drive_mean, record.drive_amplitude];
        let omega = record.angular_frequency_rad_per_s;
        Self::new(Purpose::Sweep, drive, omega, record.varied)
    }

    fn new(purpose: Purpose, drive: [f64; 2], omega: f64, varied: AxisValues) -> Self {
        let numbers = drive.into_iter().chain([omega]);
        let numbers = numbers.chain(varied.all().iter().copied());
        Self {
            purpose,
            bits: numbers.map(f64::to_bits).collect(),
        }
    }

    /// The name of a case in the folder, without its ending: the same in every process that solves it.
    pub(in crate::sweep) fn name(purpose: Purpose, case: &Case) -> String {
        match purpose {
            Purpose::Sweep => format!("{:04}", case.index),
            Purpose::Peak => {
                let bits = Self::of(purpose, case).bits.into_iter();
                let names: Vec<String> = bits.map(|bits| format!("{bits:016x}")).collect();
                names.join("-")
            }
        }
    }
}

/// What a case was solved for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Purpose {
    /// A case of the sweep.
    Sweep,
    /// The loss at a frequency between those of the sweep, to locate a peak.
    Peak,
}

/// What the folder holds of a case.
#[derive(Debug, Clone, PartialEq)]
pub enum Kept {
    Intact(Box<CaseRecord>),
    Absent,
    /// There is a record of this version of the program, but of another build, whose numbers may be others.
    OfAnotherBuild {
        path: PathBuf,
        record: Box<CaseRecord>,
    },
    /// There is a record, but it cannot be used.
    Unusable {
        path: PathBuf,
        reason: String,
    },
}

impl Kept {
    /// Why a record is not used, and where it stands.
    pub(in crate::sweep) fn refusal(&self) -> Option<String> {
        let (path, reason) = match self {
            Self::Intact(_) | Self::Absent => return None,
            Self::OfAnotherBuild { path, .. } => (path, OF_ANOTHER_BUILD),
            Self::Unusable { path, reason } => (path, reason.as_str()),
        };
        Some(format!("{}: {reason}", path.display()))
    }
}

/// What is said of a record of another build.
const OF_ANOTHER_BUILD: &str = concat!(
    "it was written by another build of version ",
    env!("CARGO_PKG_VERSION"),
    " of the program"
);

impl Store {
    /// Looks which records are there now, of other processes too; what was met that is none of this sweep's.
    ///
    /// # Errors
    /// [`StoreError::Read`] with the path.
    pub fn look(&self) -> Result<Vec<Unread>, StoreError> {
        self.records.look()?;
        Ok(self.records.unread())
    }

    /// Brings every record stored by this process to the disk.
    ///
    /// # Errors
    /// [`StoreError::Write`] with the path, where the disk turns out to be full for one.
    pub fn sync(&self) -> Result<(), StoreError> {
        self.records.sync()
    }

    /// Stores the record of a finished case.
    ///
    /// # Errors
    /// [`StoreError`] with the path.
    pub fn save_case(
        &self,
        purpose: Purpose,
        case: &Case,
        record: &CaseRecord,
    ) -> Result<(), StoreError> {
        self.check_plan()?;
        self.append(Key::of(purpose, case), record)
    }

    /// Appends a record of this case.
    pub(super) fn append(&self, key: Key, record: &CaseRecord) -> Result<(), StoreError> {
        let record = match key.purpose {
            Purpose::Sweep => packed_record::pack(record),
            // Its cycle is drawn nowhere.
            Purpose::Peak => packed_record::pack(&record.without_cycle()),
        };
        let record = record.map_err(|reason| StoreError::Encode {
            path: self.folder().to_path_buf(),
            reason,
        })?;
        self.records.append(key, &record)
    }

    /// The numbers of a case's record, where there is a usable one; its cycle is not read: see [`Self::load_cycle`].
    ///
    /// # Errors
    /// [`StoreError`] where the record cannot be read, or was written by a newer program and may not be replaced.
    pub fn load_case(&self, purpose: Purpose, case: &Case) -> Result<Kept, StoreError> {
        self.load(purpose, case, false)
    }

    fn load(&self, purpose: Purpose, case: &Case, with_cycle: bool) -> Result<Kept, StoreError> {
        let Some(place) = self.records.place(&Key::of(purpose, case))? else {
            return Ok(Kept::Absent);
        };
        let path = place.segment.to_path_buf();
        let unusable = |reason: String| Kept::Unusable {
            path: path.clone(),
            reason,
        };
        let of_version = |version: &str, age: &str| {
            unusable(format!(
                "it was written by version {version} of the program, {age} than this one"
            ))
        };
        match &place.origin {
            Origin::Newer(version) if !self.force => {
                let version = version.clone();
                return Err(StoreError::NewerProgram { path, version });
            }
            Origin::Newer(version) => return Ok(of_version(version, "newer")),
            Origin::Older(version) => return Ok(of_version(version, "older")),
            Origin::ThisBuild | Origin::AnotherBuild => {}
        }
        let content = self.records.read(&place)?;
        let Some(mut record) = packed_record::numbers(&content) else {
            let case = case.index;
            return Ok(unusable(format!("the record of case {case} is damaged")));
        };
        let same_frequency = record.angular_frequency_rad_per_s.to_bits()
            == case.angular_frequency_rad_per_s.to_bits();
        if !same_frequency || !record.is_of(&case.condition) {
            return Ok(unusable(
                "a record in it belongs to another sweep".to_owned(),
            ));
        }
        record.index = case.index;
        if with_cycle {
            packed_record::add_cycle(&mut record, &content);
        }
        let record = Box::new(record);
        Ok(match place.origin {
            Origin::ThisBuild => Kept::Intact(record),
            _ => Kept::OfAnotherBuild { path, record },
        })
    }

    /// Gives a record of the sweep its cycle, where there is one in the folder.
    ///
    /// # Errors
    /// [`StoreError::Read`] with the path.
    pub fn load_cycle(&self, record: &mut CaseRecord) -> Result<(), StoreError> {
        let Some(place) = self.records.place(&Key::of_record(record))? else {
            return Ok(());
        };
        packed_record::add_cycle(record, &self.records.read(&place)?);
        Ok(())
    }

    /// Appends every record of this build that another folder of the same sweep has and this one has not. `differs` hears of those
    /// that both have and that are not the same; the first stays.
    ///
    /// # Errors
    /// [`StoreError`] with the path.
    pub(in crate::sweep) fn take_from(
        &self,
        other: &Self,
        differs: &dyn Fn(&CaseRecord),
    ) -> Result<(), StoreError> {
        self.check_plan()?;
        let is_own = |place: &Place| place.origin == Origin::ThisBuild;
        let places = other.records.places().into_iter();
        for (key, place) in places.filter(|(_, place)| is_own(place)) {
            let record = other.records.read(&place)?;
            match self.records.place(&key)?.filter(is_own) {
                None => self.records.append(key, &record)?,
                Some(own) if self.records.read(&own)? == record => {}
                Some(_) => {
                    if let Some(record) = packed_record::numbers(&record) {
                        differs(&record);
                    }
                }
            }
        }
        self.sync()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cycle::Loop;
    use crate::sweep::plan::{self, Method};
    use crate::sweep::record::{RecordedCycle, Status};
    use crate::sweep::store::segment::{self, Met};

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
        let intact = || Kept::Intact(Box::new(record(&case)));
        for purpose in [Purpose::Sweep, Purpose::Peak] {
            let another = open(&folder);
            assert_eq!(another.load_case(purpose, &case).unwrap(), Kept::Absent);
            store.save_case(purpose, &case, &record(&case)).unwrap();
            assert_eq!(store.load_case(purpose, &case).unwrap(), intact());
            another.look().unwrap();
            assert_eq!(another.load_case(purpose, &case).unwrap(), intact());
        }
        let other = Case {
            angular_frequency_rad_per_s: 0.3,
            ..case.clone()
        };
        let kept = store.load_case(Purpose::Sweep, &other).unwrap();
        assert_eq!(kept, Kept::Absent);
    }

    #[test]
    fn a_solved_case_comes_back_with_its_cycle_and_a_peak_without() {
        let plan = crate::sweep::plan::SweepPlan::new(
            crate::material::library::find("pmma")
                .unwrap()
                .material()
                .unwrap(),
            plan::tests::condition().indenter,
            plan::tests::condition().drive,
        );
        let mut plan = plan;
        plan.angular_frequencies_rad_per_s = vec![0.1 + 0.2];
        (plan.cycle.steps, plan.contact.solver.springs) = (32, 40);
        let setup = crate::sweep::case::Setup::new(plan).unwrap();
        let case = Case {
            condition: setup.plan().condition(),
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
            store.save_case(purpose, &case, &solved).unwrap();
            let Kept::Intact(mut found) = store.load_case(purpose, &case).unwrap() else {
                panic!("no record");
            };
            assert_eq!(*found, solved.without_cycle());
            store.load_cycle(&mut found).unwrap();
            assert_eq!(*found, expected);
        }
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
                .save_case(Purpose::Sweep, case, &record(case))
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
            let unread = store.look().unwrap();
            assert_eq!(unread.len(), 1, "byte {byte}");
            assert!(unread[0].reason.contains("damaged or torn"), "{unread:?}");
            let kept = [&first, &second].map(|case| store.load_case(Purpose::Sweep, case).unwrap());
            assert!(matches!(kept, [Kept::Intact(_), Kept::Absent]), "{byte}");
        }
    }

    #[test]
    fn the_torn_end_of_a_segment_without_any_whole_record_is_told_once() {
        let folder = tempfile::TempDir::new().unwrap();
        let (store, case) = (open(&folder), case());
        let saved = store.save_case(Purpose::Sweep, &case, &record(&case));
        saved.unwrap();
        drop(store);
        let path = segment_of(&folder);
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, &whole[..whole.len() - 1]).unwrap();
        let store = open(&folder);
        let told = [(); 3].map(|()| store.look().unwrap().len());
        assert_eq!(told, [1, 0, 0]);
        // The process that was writing it comes to the end of its record.
        std::fs::write(&path, &whole).unwrap();
        assert!(store.look().unwrap().is_empty());
        let kept = store.load_case(Purpose::Sweep, &case).unwrap();
        assert!(matches!(kept, Kept::Intact(_)));
    }

    #[test]
    fn records_of_other_versions_are_not_used_and_what_is_no_segment_is_named() {
        let case = case();
        // The heading of a record begins with the version and the build.
        let with = |from: &str, to: &str| {
            let folder = tempfile::TempDir::new().unwrap();
            let store = open(&folder);
            let saved = store.save_case(Purpose::Sweep, &case, &record(&case));
            saved.unwrap();
            let path = segment_of(&folder);
            let mut content = Vec::new();
            let meet = |met: Met<'_>| {
                if let Met::Record { content: of, .. } = met {
                    content = of.to_vec();
                }
            };
            segment::read(&path, 0, meet).unwrap();
            let at = content
                .windows(from.len())
                .position(|part| part == from.as_bytes());
            assert_eq!(from.len(), to.len());
            let at = at.unwrap();
            content[at..at + from.len()].copy_from_slice(to.as_bytes());
            std::fs::write(&path, segment::sealed(&content).unwrap()).unwrap();
            folder
        };
        let build = crate::sweep::store::provenance::BUILD;
        let folder = with(build, &"0".repeat(build.len()));
        let kept = open(&folder).load_case(Purpose::Sweep, &case).unwrap();
        assert!(
            matches!(kept, Kept::OfAnotherBuild { record: found, .. } if *found == record(&case))
        );
        let version = env!("CARGO_PKG_VERSION");
        let older = with(version, &version.replace(|c: char| c.is_ascii_digit(), "0"));
        let kept = open(&older).load_case(Purpose::Sweep, &case).unwrap();
        assert!(matches!(kept, Kept::Unusable { reason, .. } if reason.contains("older")));
        let newer = with(version, &version.replace(|c: char| c.is_ascii_digit(), "9"));
        let store = open(&newer);
        let refused = store.load_case(Purpose::Sweep, &case);
        assert!(matches!(refused, Err(StoreError::NewerProgram { .. })));
        let forced = Store {
            force: true,
            ..store.clone()
        };
        let kept = forced.load_case(Purpose::Sweep, &case).unwrap();
        assert!(matches!(kept, Kept::Unusable { .. }));
        forced
            .save_case(Purpose::Sweep, &case, &record(&case))
            .unwrap();
        let kept = open(&newer).load_case(Purpose::Sweep, &case).unwrap();
        assert!(matches!(kept, Kept::Intact(_)));
        std::fs::write(newer.path().join("records/0000.json"), "{}").unwrap();
        let unread = open(&newer).look().unwrap();
        assert!(unread[0].reason.contains("earlier version"), "{unread:?}");
    }

    #[test]
    fn a_cycle_takes_four_bytes_a_number() {
        let samples = |k: i32| (std::f64::consts::TAU * f64::from(k) / 200.0).sin();
        let column = |scale: f64| {
            (0..=200)
                .map(|k| scale * (2.0 + samples(k)))
                .collect::<Vec<_>>()
        };
        let cycle = RecordedCycle {
            samples: Loop {
                time_s: (0..=200).map(|k| 0.1 * f64::from(k)).collect(),
                load_n: column(3.0),
                approach_m: column(1e-5),
                contact_radius_m: column(3e-4),
                peak_pressure_pa: column(5e7).into_iter().map(Some).collect(),
            },
            ..RecordedCycle::default()
        };
        let case = case();
        let mut with = record(&case);
        let solved = serde_json::json!({
            "analysis": {
                "energy_loss_j": 1.0, "polygon_loss_j": 1.0, "phase_lag_rad": 0.1, "load_mean_n": 1.0,
                "approach_mean_m": 1.0, "harmonics": []
            },
            "storage_modulus_pa": null, "loss_modulus_pa": null,
            "approach_m": {"minimum": 0.0, "maximum": 1.0},
            "contact_radius_m": {"minimum": 0.0, "maximum": 1.0},
            "contact_duty": {"part": 1.0, "error": 0.0},
            "peak_pressure_pa": null, "errors": null, "branches": []
        });
        with.result = Some(serde_json::from_value(solved).unwrap());
        let without = packed_record::pack(&with).unwrap().len();
        if let Some(result) = &mut with.result {
            result.cycle = cycle;
        }
        let bytes = packed_record::pack(&with).unwrap().len() - without;
        assert!(bytes < 5 * 201 * 4, "{bytes}");
    }
}
