//! What must hold of any input, whatever its bytes: one function for each kind that the program reads. Random tests and the
//! fuzzer (tests/fuzz) try them on bytes that nobody meant. Each says whether the input was accepted.

#![allow(dead_code)] // Each user has its own part.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use contact_dma::engine::EngineKind;
use contact_dma::input::diagnostic::{Diagnostics, Styling};
use contact_dma::input::document::Document;
use contact_dma::input::dynamic::{self, DynamicFormat};
use contact_dma::input::{field_file, scenario_file, sweep_file};
use contact_dma::material::ModulusKind;
use contact_dma::quantity::{self, Dimension};
use contact_dma::report::work_line::WorkLine;
use contact_dma::report::{machine, page, quantities, table};
use contact_dma::simulation::Simulation;
use contact_dma::simulation::checkpoint::HistoryCheckpoint;
use contact_dma::simulation::scenario;
use contact_dma::sweep::case::Setup;
use contact_dma::sweep::case::checkpoint::Checkpoints;
use contact_dma::sweep::plan::Case;
use contact_dma::sweep::plan::resolved::resolved_text;
use contact_dma::sweep::search::run::Outcome;
use contact_dma::sweep::store::Store;
use contact_dma::sweep::store::entry::{self, Purpose};
use contact_dma::sweep::store::log;
use sha2::{Digest, Sha256};
use tempfile::TempDir;

/// A refusal says something, and can be shown.
fn refused<T>(result: Result<T, Diagnostics>) -> Option<T> {
    result
        .inspect_err(|why| assert!(!why.render(Styling::Plain).is_empty()))
        .ok()
}

/// A file of text is refused, or means what its resolved form says.
fn resolves_to_itself<P>(
    bytes: &[u8],
    plan: impl Fn(&Document) -> Result<P, Diagnostics>,
    resolved: impl Fn(&P) -> String,
) -> Option<P> {
    let document = refused(Document::from_bytes("fuzz.toml", bytes))?;
    let accepted = refused(plan(&document))?;
    let text = resolved(&accepted);
    let again = Document::parse("resolved.toml", &text).unwrap();
    assert_eq!(resolved(&plan(&again).ok().unwrap()), text);
    Some(accepted)
}

/// A sweep file. Physics that cannot be is refused before anything is solved; large grids would only take time.
pub fn sweep_file(bytes: &[u8]) -> bool {
    let plan = resolves_to_itself(bytes, sweep_file::plan, resolved_text);
    if let Some(plan) = &plan
        && plan.solver.engine == EngineKind::Axisymmetric
        && plan.conditions().len() < 50
    {
        let setup = Setup::new(plan.clone());
        let _ = setup.inspect_err(|why| assert!(!why.to_string().is_empty()));
    }
    plan.is_some()
}

/// The same of a file of one drive history.
pub fn scenario_file(bytes: &[u8]) -> bool {
    let plan = resolves_to_itself(bytes, scenario_file::plan, scenario::resolved_text);
    if let Some(plan) = &plan
        && plan.solver.engine == EngineKind::Axisymmetric
    {
        let simulation = Simulation::new(plan.clone());
        let _ = simulation.inspect_err(|why| assert!(!why.to_string().is_empty()));
    }
    plan.is_some()
}

/// A quantity is finite or refused.
pub fn quantity(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let mut accepted = false;
    use Dimension::{Angle, AngularFrequency, Compliance, Force, Length, Stress, Time};
    for dimension in [
        Length,
        Stress,
        AngularFrequency,
        Time,
        Force,
        Compliance,
        Angle,
    ] {
        match quantity::parse(&text, dimension) {
            Ok(value) => {
                assert!(value.is_finite(), "{text}");
                accepted = true;
                let written = quantity::format_si(value, dimension);
                let again = quantity::parse(&written, dimension).unwrap();
                assert_eq!(again.to_bits(), value.to_bits(), "{text}: {written}");
            }
            Err(why) => assert!(!why.to_string().is_empty()),
        }
    }
    accepted
}

/// A height map holds finite heights in full rows or is refused.
pub fn height_map(bytes: &[u8]) -> bool {
    match field_file::field("map", bytes) {
        Ok(field) => {
            assert_eq!(field.values_m.len(), field.cells_x * field.cells_y);
            assert!(field.values_m.iter().all(|value| value.is_finite()));
            true
        }
        Err(why) => {
            assert!(why.to_string().contains("map"), "{why}");
            false
        }
    }
}

/// A file of dynamic data holds positive numbers or is refused, whatever format it is taken for. The first byte chooses that: 0 leaves
/// it to be found, others name one, and those above 127 a table of shift factors.
pub fn dynamic_file(bytes: &[u8]) -> bool {
    let Some((first, content)) = bytes.split_first() else {
        return false;
    };
    if *first > 127 {
        let pairs = refused(dynamic::shift_factors_from_bytes("shift", content));
        let pairs = pairs.unwrap_or_default();
        for (kelvin, log) in &pairs {
            assert!(*kelvin > 0.0 && kelvin.is_finite() && log.is_finite());
        }
        return !pairs.is_empty();
    }
    let format = usize::from(*first)
        .checked_sub(1)
        .and_then(|place| DynamicFormat::NAMES.get(place % DynamicFormat::NAMES.len()));
    let format = format.map(|(_, format)| *format);
    // The crate that reads workbooks panics on some, which is caught, but not under the fuzzer.
    let is_workbook = content.starts_with(b"PK") || content.starts_with(b"\xd0\xcf");
    if is_workbook || format == Some(DynamicFormat::Eplexor) {
        return false;
    }
    let mut accepted = false;
    for kind in [ModulusKind::Longitudinal, ModulusKind::Shear] {
        if let Some(file) = refused(dynamic::from_bytes("dma", content, format, kind)) {
            assert!(!file.notes.is_empty());
            assert!(format.is_none_or(|format| format == file.format));
            for point in file.data.points() {
                let values = [
                    point.angular_frequency_rad_per_s,
                    point.storage_modulus_pa,
                    point.loss_modulus_pa,
                ];
                assert!(values.iter().all(|value| *value > 0.0 && value.is_finite()));
            }
            accepted = true;
        }
    }
    accepted
}

/// A profile holds finite numbers or is refused.
pub fn profile(bytes: &[u8]) -> bool {
    match field_file::profile("profile", bytes) {
        Ok(points) => {
            let mut numbers = points.iter().flat_map(|(r, gap)| [r, gap]);
            assert!(numbers.all(|number| number.is_finite()));
            true
        }
        Err(why) => {
            assert!(!why.to_string().is_empty());
            false
        }
    }
}

/// Tables that sweeps and scenarios name, which therefore lie in a folder.
pub struct Tables {
    folder: TempDir,
}

/// A table and what it is taken for.
#[derive(Debug, Clone, Copy)]
pub enum Table {
    Creep,
    Relaxation,
    /// Creep that is taken as it is.
    DirectCreep,
    Load,
    Profile,
}

impl Table {
    fn naming(self) -> String {
        let measured = |quantity: &str, evaluation: &str| {
            format!(
                "[material]\npoisson_ratio = 0.4\n[material.table]\nfile = \"table.csv\"\nquantity = \"{quantity}\"\n\
                 modulus = \"shear\"\nevaluation = \"{evaluation}\"\n"
            )
        };
        let material = match self {
            Self::Creep => measured("creep", "fit"),
            Self::Relaxation => measured("relaxation", "fit"),
            Self::DirectCreep => measured("creep", "direct"),
            Self::Load | Self::Profile => "[material]\nlibrary = \"pmma\"\n".to_owned(),
        };
        let indenter = match self {
            Self::Profile => "shape = \"profile\"\nfile = \"table.csv\"",
            _ => "shape = \"sphere\"\nradius = \"1 mm\"",
        };
        let segment = match self {
            Self::Load => "kind = \"table\", file = \"table.csv\"",
            _ => "kind = \"step\", to = 1.0, duration = 1.0",
        };
        format!(
            "title = \"t\"\n{material}[indenter]\n{indenter}\n[drive]\nsegments = [{{ {segment} }}]\n"
        )
    }
}

impl Tables {
    pub fn new() -> Self {
        Self {
            folder: TempDir::new().unwrap(),
        }
    }

    /// As [`Tables::check`]; the first byte says what the table is taken for.
    pub fn check_any(&self, bytes: &[u8]) -> bool {
        let Some((first, table)) = bytes.split_first() else {
            return false;
        };
        use Table::{Creep, DirectCreep, Load, Profile, Relaxation};
        let all = [Creep, Relaxation, DirectCreep, Load, Profile];
        self.check(all[usize::from(*first) % all.len()], table)
    }

    /// A table becomes a material, a drive or an indenter, or is refused.
    pub fn check(&self, table: Table, bytes: &[u8]) -> bool {
        let folder = self.folder.path();
        fs::write(folder.join("table.csv"), bytes).unwrap();
        let name = folder.join("naming.toml").display().to_string();
        let document = Document::parse(&name, &table.naming()).unwrap();
        let document = document.in_folder(folder);
        let Some(plan) = refused(scenario_file::plan(&document)) else {
            return false;
        };
        let text = scenario::resolved_text(&plan);
        assert!(scenario_file(text.as_bytes()), "{text}");
        true
    }
}

/// A sweep of two cases in a folder, each solved within milliseconds.
pub struct Folder {
    folder: TempDir,
    setup: Setup,
    store: Store,
    case: Case,
}

const TINY: &str = include_str!("../inputs/tiny.toml");

impl Folder {
    /// `method` is "direct" or "march".
    pub fn new(method: &str) -> Self {
        let folder = TempDir::new().unwrap();
        let text = TINY.replace(
            "[cycle]",
            &format!("[cycle]\nmethod = \"{method}\"\ntolerance = 1e-4"),
        );
        let document = Document::parse("tiny.toml", &text).unwrap();
        let plan = sweep_file::plan(&document).ok().unwrap();
        let setup = Setup::new(plan).unwrap();
        let resolved = resolved_text(setup.plan());
        let store = Store::open(folder.path(), &resolved, false).unwrap();
        let case = setup.plan().cases()[0].clone();
        Self {
            folder,
            setup,
            store,
            case,
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The outcome of a folder that holds this segment.
    fn load(&self, segment: &[u8]) -> Option<Outcome> {
        let _ = fs::remove_dir_all(self.path("records"));
        fs::create_dir(self.path("records")).unwrap();
        fs::write(self.path("records/any.segment"), segment).unwrap();
        let (store, _) = Store::reopen_to_read(self.folder.path()).unwrap();
        let kept = store.records().load(Purpose::Sweep, &self.case, true);
        kept.ok()?.intact().map(|record| Outcome {
            records: vec![record],
            peaks: Vec::new(),
            peak_problems: Vec::new(),
            missing: 0,
            interrupted: true,
        })
    }
}

/// Records, as they are and with a right checksum about them.
pub struct Records {
    folder: Folder,
    /// The segment of one whole record, and where its content begins and what is packed in it.
    whole: Vec<u8>,
    content: Vec<u8>,
    packed: usize,
}

impl Records {
    pub fn new() -> Self {
        let folder = Folder::new("direct");
        let record = folder.setup.run(&folder.case, &AtomicBool::new(false));
        let record = record.unwrap();
        assert!(record.result.is_some(), "{:?}", record.message);
        let saved = (folder.store.records()).insert(Purpose::Sweep, &folder.case, &record);
        saved.unwrap();
        let mut segments = fs::read_dir(folder.path("records")).unwrap();
        let path = segments.next().unwrap().unwrap().path();
        let whole = fs::read(&path).unwrap();
        let mut content = Vec::new();
        let meet = |met: log::Met<'_>| {
            if let log::Met::Record { content: of, .. } = met {
                content = of.to_vec();
            }
        };
        log::read(&path, 0, meet).unwrap();
        let packed = content.len() - entry::encoded(&record, true).unwrap().len();
        Self {
            folder,
            whole,
            content,
            packed,
        }
    }

    /// The bytes of a segment of one record.
    pub fn whole(&self) -> &[u8] {
        &self.whole
    }

    /// What is packed in a whole record.
    pub fn whole_packed(&self) -> &[u8] {
        &self.content[self.packed..]
    }

    /// Whatever is packed under a right checksum is refused, or makes tables and a page.
    pub fn packed(&self, packed: &[u8]) -> bool {
        let content = [&self.content[..self.packed], packed].concat();
        let outcome = self.folder.load(&log::framed(&content).unwrap());
        outcome.is_some_and(|outcome| self.is_told(&outcome))
    }

    fn is_told(&self, outcome: &Outcome) -> bool {
        let (plan, hash) = (self.folder.setup.plan(), self.folder.store.sweep_hash());
        let (branches, axes) = (outcome.retardation_times_s().len(), plan.axes.as_ref());
        let unit = plan.figures.frequency_unit;
        let _ = quantities::sweep(
            &outcome.records,
            (branches, plan.is_attracted()),
            unit,
            axes,
        );
        for result in outcome.records.iter().filter_map(|r| r.result.as_ref()) {
            let _ = table::samples(&result.cycle.samples);
            let _ = table::pressures(&result.cycle.pressures, plan.base.drive.control());
            let indenter = plan.base.contact.indenter.as_ref();
            let line = WorkLine::of(&result.cycle.surface_loss, indenter);
            let _ = table::work(&line);
        }
        let _ = machine::sweep(plan, outcome, hash);
        let _ = page::sweep(plan, outcome, &page::Pictures::default(), hash);
        true
    }

    /// Bytes of a segment hold the whole record or none.
    pub fn bytes(&self, bytes: &[u8]) -> bool {
        let taken = self.folder.load(bytes).is_some();
        let frame = self.whole.as_slice();
        assert!(!taken || bytes.windows(frame.len()).any(|part| part == frame));
        taken
    }
}

/// Checkpoints of a case, with a right checksum about anything.
pub struct CheckpointFiles {
    folder: Folder,
    /// Names of the files and how each begins.
    heads: Vec<(PathBuf, Vec<u8>)>,
}

/// Bytes by which a checkpoint says what it is and what it belongs to.
const CHECKPOINT_HEAD: usize = 32;

fn between_head_and_sum(checkpoint: &[u8]) -> Vec<u8> {
    checkpoint[CHECKPOINT_HEAD..checkpoint.len() - 32].to_vec()
}

fn with_sum(head: &[u8], content: &[u8]) -> Vec<u8> {
    let bytes = [head, content].concat();
    [&bytes[..], &Sha256::digest(&bytes)].concat()
}

impl CheckpointFiles {
    /// `method` is "direct" or "march".
    pub fn new(method: &str) -> Self {
        let folder = Folder::new(method);
        let mut files = Self {
            folder,
            heads: Vec::new(),
        };
        files.run();
        files.heads = files.wholes();
        assert!(!files.heads.is_empty(), "no checkpoint was written");
        files
            .heads
            .iter_mut()
            .for_each(|(_, bytes)| bytes.truncate(CHECKPOINT_HEAD));
        files
    }

    fn run(&self) -> bool {
        let Folder {
            setup, store, case, ..
        } = &self.folder;
        let checkpoints = Checkpoints::of(store, Purpose::Sweep, case, Duration::ZERO);
        let record = setup.run_from(&checkpoints, case, &AtomicBool::new(false));
        record.is_some()
    }

    /// The checkpoints that lie there now.
    fn wholes(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let folder = self.folder.path("records/checkpoints/0000");
        let paths = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
        let files = paths.map(|path| (path.clone(), fs::read(path).unwrap()));
        let mut files: Vec<_> = files.collect();
        files.sort();
        files
    }

    /// How many files there are, and what each holds between its head and its checksum.
    pub fn contents(&self) -> Vec<Vec<u8>> {
        self.run();
        let wholes = self.wholes().into_iter();
        wholes
            .map(|(_, bytes)| between_head_and_sum(&bytes))
            .collect()
    }

    /// A case goes on from a checkpoint of any content, or from its beginning, and ends.
    pub fn check(&self, file: usize, content: &[u8]) -> bool {
        let (path, head) = &self.heads[file % self.heads.len()];
        self.remove_others(path);
        fs::write(path, with_sum(head, content)).unwrap();
        self.run()
    }

    fn remove_others(&self, but: &Path) {
        for (path, _) in self.heads.iter().filter(|(path, _)| path != but) {
            let _ = fs::remove_file(path);
        }
    }
}

/// As [`CheckpointFiles::check`], of the direct or the marched case; the first byte says of which, and which file.
pub fn check_any_checkpoint(files: &[CheckpointFiles; 2], bytes: &[u8]) -> bool {
    let Some((first, content)) = bytes.split_first() else {
        return false;
    };
    let (method, file) = (usize::from(*first) % 2, usize::from(*first) / 2);
    files[method].check(file, content)
}

/// A short history of springs and one of cells, with a right checksum about any checkpoint.
pub struct Histories {
    folder: TempDir,
    simulations: Vec<Simulation>,
}

const HISTORY: &str = include_str!("../inputs/tiny-history.toml");

impl Histories {
    pub fn new() -> Self {
        let solvers = [
            "field_cells = 8\n[solver]\nsprings = 16\n",
            "[solver]\nengine = \"half-space\"\ncells = 8\n",
        ];
        let simulation = |solver: &str| {
            let text = format!("{HISTORY}{solver}");
            let document = Document::parse("history.toml", &text).unwrap();
            Simulation::new(scenario_file::plan(&document).ok().unwrap()).unwrap()
        };
        Self {
            folder: TempDir::new().unwrap(),
            simulations: solvers.map(simulation).into(),
        }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("records/checkpoints/history")
    }

    /// Goes on from what lies there, for so many steps.
    fn run(&self, which: usize, steps: usize) -> bool {
        let simulation = &self.simulations[which];
        let resolved = scenario::resolved_text(simulation.plan());
        let store = Store::open(self.folder.path(), &resolved, true).unwrap();
        let checkpoint = HistoryCheckpoint::of(&store, Duration::ZERO);
        let state = checkpoint.find().ok().flatten();
        let accepted = state.is_some();
        let interrupt = AtomicBool::new(false);
        let _ = simulation.run_from(state, Some(&checkpoint), &interrupt, &|done, _| {
            interrupt.store(done >= steps, Ordering::Relaxed);
        });
        accepted
    }

    /// What a checkpoint holds between its head and its checksum after four steps, of springs or cells.
    pub fn content(&self, which: usize) -> Vec<u8> {
        let _ = fs::remove_file(self.path());
        self.run(which, 4);
        between_head_and_sum(&fs::read(self.path()).unwrap())
    }

    /// A history goes on from a checkpoint of any content, or from its beginning, and ends. The last [`Histories::content`]
    /// must have been of the same one.
    pub fn check(&self, which: usize, content: &[u8]) -> bool {
        let head = &fs::read(self.path()).unwrap()[..CHECKPOINT_HEAD];
        fs::write(self.path(), with_sum(head, content)).unwrap();
        self.run(which, usize::MAX)
    }
}
