//! Frequency sweeps.

use std::collections::BTreeSet;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use contact_dma::input::document::Document;
use contact_dma::input::given::Given;
use contact_dma::input::sweep_file;
use contact_dma::report::{cycles, quantities, summary, sweep_tables};
use contact_dma::sweep::case::Setup;
use contact_dma::sweep::plan::resolved::{hash, resolved_text};
use contact_dma::sweep::plan::{Case, SweepPlan};
use contact_dma::sweep::record::{CaseRecord, RecordedCycle};
use contact_dma::sweep::search::peak::Peak;
use contact_dma::sweep::search::run::{self, Mode, Outcome, Progress};
use contact_dma::sweep::store::provenance::{BUILD, Circumstances, Stopwatch};
use contact_dma::sweep::store::{Archive, RESOLVED, Store, merge, records};
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::{PyIndexError, PyKeyboardInterrupt};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

use crate::folder::MapFile;
use crate::shape::Shape;
use crate::source::Source;
use crate::wait::{self, Counter, Watch};
use crate::{arrays, blocks, failure};

/// Where the records of a result are.
enum Records {
    Memory(records::Records),
    Folder(Store),
}

impl Records {
    fn archive(&self) -> &dyn Archive {
        match self {
            Self::Memory(memory) => memory,
            Self::Folder(store) => store,
        }
    }
}

/// A sweep and what it came to.
#[pyclass(frozen, module = "contact_dma._contact_dma")]
pub struct Sweep {
    plan: SweepPlan,
    outcome: Outcome,
    records: Records,
    /// The indenter, of a plan whose text does not say all of it.
    shape: Option<Py<Shape>>,
    clock: Stopwatch,
    threads: usize,
    notes: Vec<String>,
}

/// Counts the cases that are done.
struct Count<'a> {
    counter: &'a Counter,
    notes: &'a std::sync::Mutex<Vec<String>>,
}

impl Progress for Count<'_> {
    fn case_finished(&self, _: &CaseRecord) {
        self.counter.done.fetch_add(1, Ordering::Relaxed);
    }

    fn locating_peaks(&self, _: usize) {}

    fn cases_found(&self, done: usize, _: usize) {
        self.counter.done.fetch_add(done, Ordering::Relaxed);
    }

    fn notice(&self, what: &str) {
        if let Ok(mut notes) = self.notes.lock() {
            notes.push(what.to_owned());
        }
    }
}

/// Samples of a cycle: time, load, approach, contact radius, peak pressure.
type Samples<'py> = (Line<'py>, Line<'py>, Line<'py>, Line<'py>, Line<'py>);

type Line<'py> = Bound<'py, PyArray1<f64>>;

/// A pressure profile: instant, time, load, approach, contact radius; and lines: along what, positions, pressures.
type Profile<'py> = (
    String,
    (f64, f64, f64, f64),
    Vec<(&'static str, Line<'py>, Line<'py>)>,
);

#[pymethods]
impl Sweep {
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let unit = self.plan.figures.frequency_unit;
        let branches = self.outcome.branches();
        let columns = quantities::of_cases(branches, unit, self.plan.axes.as_ref());
        arrays::columns(py, &columns, &self.outcome.records)
    }

    /// How every case ended, and why it has no result or what else is to be known of it.
    fn status(&self) -> Vec<(&'static str, Option<String>)> {
        let records = self.outcome.records.iter();
        let of = |record: &CaseRecord| record.status.name();
        let message = |record: &CaseRecord| record.message.as_deref().map(failure::in_python);
        records.map(|r| (of(r), message(r))).collect()
    }

    /// The warnings of every case: code and sentence.
    fn warnings(&self) -> Vec<Vec<(&'static str, String)>> {
        let records = self.outcome.records.iter();
        let of = |record: &CaseRecord| {
            let warnings = record.warnings.iter();
            warnings.map(|w| (w.code(), w.to_string())).collect()
        };
        records.map(of).collect()
    }

    fn peaks(&self) -> Vec<PeakNumbers> {
        (self.outcome.peaks.iter())
            .map(|one| peak(&self.plan, one))
            .collect()
    }

    #[getter]
    fn peak_problems(&self) -> Vec<String> {
        self.outcome.peak_problems.clone()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    #[getter]
    fn title(&self) -> &str {
        &self.plan.title
    }

    #[getter]
    fn control(&self) -> &'static str {
        self.plan.base.drive.control().name()
    }

    /// The sweep as the text of a sweep file, every default filled in.
    #[getter]
    fn resolved(&self) -> String {
        resolved_text(&self.plan)
    }

    /// What is written to summary.json.
    fn summary(&self) -> PyResult<Vec<u8>> {
        let hash = hash(&resolved_text(&self.plan));
        let summary = summary::summary(&self.plan, &self.outcome, &hash);
        summary.map_err(|error| failure::of_report(&error))
    }

    fn __len__(&self) -> usize {
        self.outcome.records.len()
    }

    fn cycle<'py>(slf: &Bound<'py, Self>, index: usize) -> PyResult<Option<Samples<'py>>> {
        let py = slf.py();
        let record = slf.get().record(index)?;
        if let Some(cycle) = record.result.as_ref().and_then(|result| result.cycle()) {
            let samples = &cycle.samples;
            let line = |values: &[f64]| arrays::line(slf.as_any(), values);
            return Ok(Some((
                line(&samples.time_s),
                line(&samples.load_n),
                line(&samples.approach_m),
                line(&samples.contact_radius_m),
                pressures(py, &samples.peak_pressure_pa),
            )));
        }
        Ok(slf.get().read_cycle(record)?.map(|cycle| {
            let samples = cycle.samples;
            (
                samples.time_s.into_pyarray(py),
                samples.load_n.into_pyarray(py),
                samples.approach_m.into_pyarray(py),
                samples.contact_radius_m.into_pyarray(py),
                pressures(py, &samples.peak_pressure_pa),
            )
        }))
    }

    fn profiles<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Vec<Profile<'py>>> {
        let record = self.record(index)?;
        let read;
        let held = record.result.as_ref().and_then(|result| result.cycle());
        let cycle = match held {
            Some(cycle) => Some(cycle),
            None => {
                read = self.read_cycle(record)?;
                read.as_ref()
            }
        };
        let control = self.plan.base.drive.control();
        let profiles = cycle.into_iter().flat_map(|cycle| &cycle.pressures);
        let profile = |profile: &contact_dma::sweep::record::PressureProfile| {
            let lines = profile.lines.iter().map(|line| {
                let position = line.position_m.clone().into_pyarray(py);
                (
                    line.along.symbol(),
                    position,
                    pressures(py, &line.pressure_pa),
                )
            });
            let instant = (
                profile.time_s,
                profile.load_n,
                profile.approach_m,
                profile.contact_radius_m,
            );
            (profile.quarter.name(control), instant, lines.collect())
        };
        Ok(profiles.map(profile).collect())
    }

    /// Writes what the program writes, but for figures and page.
    fn save(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<()> {
        py.detach(|| self.write(&folder, force))
    }

    #[pyo3(signature = () -> "tuple[Any, tuple[Any, ...]]")]
    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), slf.get());
        let module = py.import("contact_dma._contact_dma")?;
        match &this.records {
            Records::Memory(memory) => {
                let bytes = memory.to_bytes();
                let arguments = (
                    BUILD,
                    resolved_text(&this.plan),
                    this.shape.as_ref(),
                    PyBytes::new(py, &bytes),
                    this.threads,
                );
                Ok((
                    module.getattr("restore_sweep")?,
                    arguments.into_pyobject(py)?,
                ))
            }
            Records::Folder(store) => {
                let arguments = (store.folder(),).into_pyobject(py)?;
                Ok((module.getattr("read_sweep")?, arguments))
            }
        }
    }
}

impl Sweep {
    fn record(&self, index: usize) -> PyResult<&CaseRecord> {
        let record = self.outcome.records.get(index);
        record.ok_or_else(|| PyIndexError::new_err("there is no such case"))
    }

    /// The cycle of a case that is in the folder alone.
    fn read_cycle(&self, record: &CaseRecord) -> PyResult<Option<RecordedCycle>> {
        let Records::Folder(store) = &self.records else {
            return Ok(None);
        };
        let mut record = record.clone();
        let loaded = store.records().load_cycle(&mut record);
        loaded.map_err(|error| failure::of_store(&error))?;
        let cycle = record.result.map(|result| result.cycle);
        Ok(cycle.filter(RecordedCycle::is_held))
    }

    fn write(&self, folder: &std::path::Path, force: bool) -> PyResult<()> {
        let mut plan = self.plan.clone();
        let map = self.shape.as_ref().and_then(|shape| shape.get().map());
        let map = map.map(|map| MapFile::of(map, folder)).transpose()?;
        if let Some(map) = &map {
            plan.base.contact.indenter = Arc::clone(&map.indenter);
        }
        let stored = |error| failure::of_store(&error);
        let store = Store::open(folder, &resolved_text(&plan), force).map_err(stored)?;
        if let Some(map) = &map {
            map.write(&store).map_err(stored)?;
        }
        match &self.records {
            Records::Memory(memory) => memory.put_into(&store).map_err(stored)?,
            Records::Folder(from) => {
                let from = std::slice::from_ref(from);
                merge::gather(from, &store, &plan.cases(), &|_| {}).map_err(stored)?;
            }
        }
        // Of a large sweep figures choose the cases that have tables of their own.
        let none = BTreeSet::new();
        let only = (!plan.is_small()).then_some(&none);
        let written = sweep_tables::write(&store, &plan, &self.outcome, only);
        written.map_err(|error| failure::of_report(&error))?;
        if !plan.is_small() {
            cycles::write(&store, &store, &plan, &self.outcome).map_err(stored)?;
        }
        store.remove_stale().map_err(stored)?;
        let count = self.outcome.records.len();
        let circumstances = Circumstances {
            command: "python",
            threads: self.threads,
            shard: None,
            cases_computed: Some(count),
            cases_found: Some(0),
            interrupted: false,
        };
        let signed = self.clock.write(
            &store,
            &plan.solver,
            Some(plan.cycle.tolerance),
            &circumstances,
        );
        signed.map_err(stored)
    }
}

/// What is known of a peak.
type PeakNumbers = (
    f64,
    f64,
    f64,
    Option<f64>,
    Vec<PeakValue>,
    Option<f64>,
    Option<f64>,
);

/// What an axis has for a peak: a number in SI units, or the name of a block.
#[derive(IntoPyObject)]
enum PeakValue {
    Number(f64),
    Name(String),
}

fn peak(plan: &SweepPlan, peak: &Peak) -> PeakNumbers {
    let over = plan.axes.iter().flat_map(|axes| &axes.over);
    let varied = over.zip(peak.varied.all());
    (
        peak.angular_frequency_rad_per_s,
        peak.energy_loss_j,
        peak.angular_frequency_uncertainty_rad_per_s,
        peak.energy_loss_error_j,
        varied
            .map(|(varied, value)| match varied.block_name(*value) {
                Some(name) => PeakValue::Name(name.to_owned()),
                None => PeakValue::Number(value.as_number()),
            })
            .collect(),
        peak.drive_mean,
        peak.drive_amplitude,
    )
}

fn pressures<'py>(py: Python<'py>, values: &[Option<f64>]) -> Bound<'py, PyArray1<f64>> {
    arrays::numbers(values.iter().copied()).into_pyarray(py)
}

/// Solves every case of a sweep and locates the peaks.
#[pyfunction]
#[pyo3(signature = (source: "object", threads, progress))]
pub fn sweep(
    py: Python<'_>,
    source: Source<'_>,
    threads: Option<NonZeroUsize>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Sweep> {
    let clock = Stopwatch::start();
    let (document, given) = (source.document()?, source.given());
    let plan = sweep_file::plan_with(&document, &given);
    let plan = plan.map_err(|found| failure::of_input(&found))?;
    let interrupt = Arc::new(AtomicBool::new(false));
    let setup = Setup::new(plan).map_err(failure::of_value)?;
    let setup = setup.interrupted_by(Arc::clone(&interrupt));
    let memory = records::Records::default();
    let counter = Counter::default();
    let cases: Vec<Case> = setup.plan().cases();
    counter.total.store(cases.len(), Ordering::Relaxed);
    let watch = Watch {
        counter: &counter,
        callback: progress.as_ref(),
    };
    // More threads than cases have nothing to do until peaks are located, which takes a few for each.
    let threads = run::useful_threads(threads).min(cases.len().max(1) * PEAK_CASES);
    let notes = std::sync::Mutex::default();
    let made = wait::run(py, &interrupt, &watch, || {
        let count = Count {
            counter: &counter,
            notes: &notes,
        };
        run::run(
            &setup,
            &memory,
            Mode::on_threads(threads),
            &interrupt,
            &count,
        )
    })?;
    let outcome = made.map_err(|error| failure::of_sweep(&error))?;
    if outcome.interrupted {
        return Err(PyKeyboardInterrupt::new_err("interrupted"));
    }
    Ok(Sweep {
        plan: setup.plan().clone(),
        outcome,
        records: Records::Memory(memory),
        shape: source.map(),
        clock,
        threads,
        notes: notes.into_inner().unwrap_or_default(),
    })
}

/// Cases that are solved at once to locate a peak.
const PEAK_CASES: usize = 5;

/// A result of the records that [`Sweep::__reduce__`] has packed.
#[pyfunction]
pub fn restore_sweep(
    py: Python<'_>,
    build: &str,
    resolved: &str,
    shape: Option<Py<Shape>>,
    records: &[u8],
    threads: usize,
) -> PyResult<Sweep> {
    if build != BUILD {
        return Err(failure::of_other_build());
    }
    let given = Given {
        material: None,
        indenter: shape.as_ref().map(|shape| shape.get().indenter()),
    };
    let memory = records::Records::from_bytes(records).ok_or_else(failure::of_other_build)?;
    let text = match &shape {
        // The indenter is a value.
        Some(_) => blocks::without(resolved, "indenter")?,
        None => resolved.to_owned(),
    };
    let document = Document::parse("the pickled sweep", &text);
    let document = document.map_err(|found| failure::of_input(&found))?;
    collected(
        py,
        &document,
        &given,
        Records::Memory(memory),
        (shape, threads),
    )
}

/// The result in a folder of the program.
#[pyfunction]
pub fn read_sweep(py: Python<'_>, folder: PathBuf) -> PyResult<Sweep> {
    let opened = Store::reopen_to_read(&folder);
    let (store, resolved) = opened.map_err(|error| failure::of_store(&error))?;
    let name = folder.join(RESOLVED).display().to_string();
    let document = Document::parse(&name, &resolved).map_err(|found| failure::of_input(&found))?;
    let document = document.in_folder(&folder);
    let records = Records::Folder(store);
    collected(py, &document, &Given::default(), records, (None, 1))
}

/// What records say, without solving anything.
fn collected(
    py: Python<'_>,
    document: &Document,
    given: &Given,
    records: Records,
    (shape, threads): (Option<Py<Shape>>, usize),
) -> PyResult<Sweep> {
    let plan = sweep_file::plan_with(document, given);
    let plan = plan.map_err(|found| failure::of_input(&found))?;
    let setup = Setup::new(plan).map_err(failure::of_value)?;
    let counter = Counter::default();
    let notes = std::sync::Mutex::default();
    let count = Count {
        counter: &counter,
        notes: &notes,
    };
    let found =
        py.detach(|| run::run(&setup, records.archive(), Mode::Read, &false.into(), &count));
    let outcome = found.map_err(|error| failure::of_sweep(&error))?;
    Ok(Sweep {
        plan: setup.plan().clone(),
        outcome,
        records,
        shape,
        clock: Stopwatch::start(),
        threads,
        notes: notes.into_inner().unwrap_or_default(),
    })
}
