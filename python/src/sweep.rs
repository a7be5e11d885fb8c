//! Frequency sweeps.

use std::collections::BTreeSet;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex};

use contact_dma::input::diagnostic::Tables;
use contact_dma::input::document::Document;
use contact_dma::input::given::Given;
use contact_dma::input::sweep_file;
use contact_dma::report::{self, cycles, figure, quantities, summary, sweep_tables};
use contact_dma::sweep::case::Setup;
use contact_dma::sweep::plan::resolved::{hash, resolved_text};
use contact_dma::sweep::plan::{SweepPlan, Varied};
use contact_dma::sweep::record::{self, CaseRecord, RecordedCycle};
use contact_dma::sweep::search;
use contact_dma::sweep::search::run::{self, Mode, Outcome, Progress};
use contact_dma::sweep::share::shard::Shard;
use contact_dma::sweep::store::provenance::Stopwatch;
use contact_dma::sweep::store::{Archive, Store, checkpoint_file, merge, records};
use numpy::PyArray1;
use pyo3::exceptions::{PyIndexError, PyKeyboardInterrupt};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple, PyType};

use crate::figure::Figure;
use crate::folder::{self, Format};
use crate::record::{
    AxisValue, Cycle, Items, Line, Peak, PressureLine, PressureProfile, Status, Warning,
};
use crate::source::{Origin, Packed, Source, reduced};
use crate::wait::{self, Job};
use crate::{arrays, failure};

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
#[pyclass(frozen, subclass, module = "contact_dma._contact_dma")]
pub struct Sweep {
    plan: SweepPlan,
    outcome: Outcome,
    records: Records,
    /// What the plan names as files and has in memory.
    tables: Tables,
    clock: Stopwatch,
    threads: usize,
    notes: Vec<String>,
}

/// Counts the cases that are done, and keeps what is met on the way.
struct Count {
    job: Job,
    notes: Mutex<Vec<String>>,
}

impl Progress for Count {
    fn case_finished(&self, _: &CaseRecord) {
        self.job.done.fetch_add(1, Ordering::Relaxed);
    }

    fn locating_peaks(&self, _: usize) {}

    fn cases_found(&self, done: usize, _: usize) {
        self.job.done.fetch_add(done, Ordering::Relaxed);
    }

    fn notice(&self, what: &str) {
        if let Ok(mut notes) = self.notes.lock() {
            notes.push(what.to_owned());
        }
    }
}

#[pymethods]
impl Sweep {
    #[new]
    #[pyo3(signature = (origin: "object", threads = None, progress = None, records = None))]
    fn new(
        py: Python<'_>,
        origin: Origin<'_>,
        threads: Option<NonZeroUsize>,
        progress: Option<Bound<'_, PyAny>>,
        records: Option<&[u8]>,
    ) -> PyResult<Self> {
        let (document, given, records, tables, is_solved, threads) = match origin {
            Origin::Call(mut source) => {
                let (given, tables) = (source.given(), source.tables());
                // What other processes have solved of it.
                let records = in_memory(records.unwrap_or_default())?;
                let document = source.document(&tables)?;
                (document, given, records, tables, true, threads)
            }
            Origin::Packed(packed) => {
                let (document, tables) = packed.document(py, "the pickled sweep")?;
                let records = in_memory(packed.3.as_bytes(py))?;
                let threads = NonZeroUsize::new(packed.4);
                (document, Given::default(), records, tables, false, threads)
            }
            Origin::Folder(folder) => {
                let (store, document) = folder::document(&folder)?;
                let (records, threads) = (Records::Folder(store), Some(NonZeroUsize::MIN));
                let none = Tables::new();
                (document, Given::default(), records, none, false, threads)
            }
        };
        let made = (records, tables);
        let how = (is_solved, threads);
        swept(py, (&document, &given), made, how, progress.as_ref())
    }

    fn _all_columns<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let unit = self.plan.figures.frequency_unit;
        let branches = self.outcome.branches();
        let columns = quantities::of_cases(
            (branches, self.plan.is_attracted()),
            unit,
            self.plan.axes.as_ref(),
        );
        arrays::columns(py, &columns, &self.outcome.records)
    }

    /// How every case ended, and why it has no result.
    #[getter]
    fn status(&self, py: Python<'_>) -> PyResult<Items<Status>> {
        let of = |record: &CaseRecord| Status {
            name: record.status.name().to_owned(),
            reason: record.message.as_deref().map(failure::in_python),
        };
        Items::new(py, self.outcome.records.iter().map(of))
    }

    /// For every case, what lies outside the model or was not estimated.
    #[getter]
    fn warnings(&self, py: Python<'_>) -> PyResult<Items<Items<Warning>>> {
        let of = |record: &CaseRecord| {
            let warnings = record.warnings.iter();
            Items::new(py, warnings.map(|w| Warning::of(w.code(), w)))
        };
        let all = self.outcome.records.iter().map(of);
        Items::new(py, all.collect::<PyResult<Vec<_>>>()?)
    }

    /// Local maxima of the loss over frequency, largest first.
    #[getter]
    fn peaks(&self, py: Python<'_>) -> PyResult<Items<Peak>> {
        let peaks = self.outcome.peaks.iter().map(|peak| self.peak(py, peak));
        Items::new(py, peaks.collect::<PyResult<Vec<_>>>()?)
    }

    /// Peaks that could not be located, with the reason.
    #[getter]
    fn peak_problems(&self, py: Python<'_>) -> PyResult<Items<String>> {
        Items::new(py, self.outcome.peak_problems.iter().cloned())
    }

    /// What was met on the way, such as a damaged record.
    #[getter]
    fn notes(&self, py: Python<'_>) -> PyResult<Items<String>> {
        Items::new(py, self.notes.iter().cloned())
    }

    /// Its title.
    #[getter]
    fn title(&self) -> &str {
        &self.plan.title
    }

    /// The sweep as the text of a sweep file, every default filled in.
    #[getter]
    fn resolved(&self) -> String {
        resolved_text(&self.plan)
    }

    fn _figures(&self) -> PyResult<Vec<Figure>> {
        let (plan, mut outcome) = (&self.plan, self.outcome.clone());
        let loaded = match &self.records {
            Records::Memory(_) => Ok(()),
            Records::Folder(store) => report::load_drawn_cycles(store, plan, &mut outcome),
        };
        let figures = loaded.and_then(|()| figure::of_sweep::figures(plan, &outcome));
        let (figures, _) = figures.map_err(|error| failure::of_report(&error))?;
        Ok(Figure::all(figures, &plan.figures))
    }

    fn _summary(&self) -> PyResult<Vec<u8>> {
        let hash = hash(&resolved_text(&self.plan));
        let summary = summary::summary(&self.plan, &self.outcome, &hash);
        summary.map_err(|error| failure::of_report(&error))
    }

    #[getter]
    fn _cases(&self) -> usize {
        self.outcome.records.len()
    }

    fn _cycle(slf: &Bound<'_, Self>, index: usize) -> PyResult<Cycle> {
        let (py, this) = (slf.py(), slf.get());
        let record = this.record(index)?;
        let angular_frequency = record.angular_frequency_rad_per_s;
        if let Some(cycle) = record.result.as_ref().and_then(|result| result.cycle()) {
            let line = |values: &[f64]| arrays::line(slf.as_any(), values).unbind();
            return this.cycle(py, angular_frequency, cycle, &line);
        }
        let line = |values: &[f64]| PyArray1::from_slice(py, values).unbind();
        let read = this.read_cycle(record)?.unwrap_or_default();
        this.cycle(py, angular_frequency, &read, &line)
    }

    /// Writes what ``contact-dma sweep`` writes: records, ``sweep.csv``, loops, pressures, work, ``cases/cycles.npz``, ``summary.json``,
    /// ``resolved.toml``, ``run.json``; a map of an array as ``records/height-map.npy``.
    ///
    /// Figures and page are drawn from these by ``contact-dma report FOLDER``, and `read` reads them again.
    ///
    /// Args:
    ///     folder: is made where it is not there.
    ///     overwrite: whether another sweep's results there are replaced.
    #[pyo3(signature = (folder, *, overwrite = false))]
    fn save(&self, py: Python<'_>, folder: PathBuf, overwrite: bool) -> PyResult<()> {
        py.detach(|| self.write(&folder, overwrite))
    }

    #[pyo3(signature = () -> "tuple[Any, tuple[Any, ...]]")]
    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), slf.get());
        match &this.records {
            Records::Memory(memory) => {
                let (resolved, bytes) = (resolved_text(&this.plan), memory.to_bytes());
                let packed = Packed::of(py, resolved, &this.tables, &bytes, this.threads);
                reduced(slf.as_any(), packed)
            }
            Records::Folder(store) => reduced(slf.as_any(), store.folder()),
        }
    }
}

impl Sweep {
    /// What varies besides the frequency.
    fn over(&self) -> impl Iterator<Item = &Varied> {
        self.plan.axes.iter().flat_map(|axes| &axes.over)
    }

    fn peak(&self, py: Python<'_>, peak: &search::peak::Peak) -> PyResult<Peak> {
        let varied = self.over().zip(peak.varied.all());
        let varied = varied.map(|(varied, value)| match varied.block_name(*value) {
            Some(name) => AxisValue::Name(name.to_owned()),
            None => AxisValue::Number(value.as_number()),
        });
        Ok(Peak {
            angular_frequency: peak.angular_frequency_rad_per_s,
            energy_loss: peak.energy_loss_j,
            angular_frequency_uncertainty: peak.angular_frequency_uncertainty_rad_per_s,
            energy_loss_error: peak.energy_loss_error_j,
            varied: Items::new(py, varied)?,
            drive_mean: peak.drive_mean,
            drive_amplitude: peak.drive_amplitude,
            varied_columns: Items::new(py, self.over().map(Varied::column))?,
        })
    }

    fn cycle(
        &self,
        py: Python<'_>,
        angular_frequency: f64,
        cycle: &RecordedCycle,
        line: &dyn Fn(&[f64]) -> Line,
    ) -> PyResult<Cycle> {
        let samples = &cycle.samples;
        let profiles = cycle
            .pressures
            .iter()
            .map(|profile| self.profile(py, profile));
        Ok(Cycle {
            angular_frequency,
            time: line(&samples.time_s),
            load: line(&samples.load_n),
            approach: line(&samples.approach_m),
            contact_radius: line(&samples.contact_radius_m),
            peak_pressure: arrays::nullable(py, samples.peak_pressure_pa.iter().copied()),
            profiles: Items::new(py, profiles.collect::<PyResult<Vec<_>>>()?)?,
        })
    }

    fn profile(
        &self,
        py: Python<'_>,
        profile: &record::PressureProfile,
    ) -> PyResult<PressureProfile> {
        let lines = profile.lines.iter().map(|line| PressureLine {
            along: line.along.symbol().to_owned(),
            position: PyArray1::from_slice(py, &line.position_m).unbind(),
            pressure: arrays::nullable(py, line.pressure_pa.iter().copied()),
        });
        Ok(PressureProfile {
            instant: profile.quarter.name(self.plan.base.drive.control()),
            time: profile.time_s,
            load: profile.load_n,
            approach: profile.approach_m,
            contact_radius: profile.contact_radius_m,
            lines: Items::new(py, lines)?,
        })
    }

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

    fn write(&self, folder: &Path, force: bool) -> PyResult<()> {
        let format = Format {
            resolved: resolved_text,
            read: sweep_file::plan,
        };
        let (store, plan) = format.open(&self.plan, &self.tables, (folder, force))?;
        let stored = |error| failure::of_store(&error);
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
        let (solver, cases) = (&plan.solver, Some(self.outcome.records.len()));
        let tolerance = Some(plan.cycle.tolerance);
        folder::sign(
            &store,
            &self.clock,
            (solver, tolerance),
            (self.threads, cases),
        )
    }
}

/// Records as another process of the same build has handed them over.
fn in_memory(bytes: &[u8]) -> PyResult<Records> {
    let memory = records::Records::from_bytes(bytes);
    Ok(Records::Memory(memory.ok_or_else(failure::of_other_build)?))
}

/// A sweep that other processes are to solve in shards, and the number of its cases.
#[pyfunction]
#[pyo3(signature = (source: "object") -> "tuple[object, int]")]
pub fn packed_sweep(py: Python<'_>, mut source: Source<'_>) -> PyResult<(Packed, usize)> {
    let (given, tables) = (source.given(), source.tables());
    let plan = sweep_file::plan_with(&source.document(&tables)?, &given);
    let plan = plan.map_err(|found| failure::of_input(&found))?;
    let cases = plan.cases().len();
    let packed = Packed::of(py, resolved_text(&plan), &tables, &[], 1);
    Ok((packed, cases))
}

/// The records of one of several shards of a sweep.
#[pyfunction]
#[pyo3(signature = (packed: "object", number, of, threads = None) -> "bytes")]
pub fn solve_shard<'py>(
    py: Python<'py>,
    packed: Packed,
    number: usize,
    of: usize,
    threads: Option<NonZeroUsize>,
) -> PyResult<Bound<'py, PyBytes>> {
    let shard = Shard::new(number, of).map_err(|error| failure::of_value(error.to_string()))?;
    let (document, _) = packed.document(py, "the sweep")?;
    let plan = sweep_file::plan(&document).map_err(|found| failure::of_input(&found))?;
    let setup = Setup::new(plan).map_err(failure::of_value)?;
    let count = Count {
        job: Job::of(0),
        notes: Mutex::default(),
    };
    let setup = setup.interrupted_by(Arc::clone(&count.job.interrupt));
    let memory = records::Records::default();
    let mode = Mode::Solve {
        threads: run::useful_threads(threads),
        checkpoint_every: checkpoint_file::EVERY,
        shard: Some(shard),
    };
    let made = wait::run(py, &count.job, None, || {
        run::run(&setup, &memory, mode, &count.job.interrupt, &count)
    })?;
    made.map_err(|error| failure::of_sweep(&error))?;
    Ok(PyBytes::new(py, &memory.to_bytes()))
}

/// Cases that are solved at once to locate a peak.
const PEAK_CASES: usize = 5;

/// Solves every case of a sweep and locates the peaks, or finds what the records say of both, without solving anything.
fn swept(
    py: Python<'_>,
    (document, given): (&Document, &Given),
    (records, tables): (Records, Tables),
    (is_solved, threads): (bool, Option<NonZeroUsize>),
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Sweep> {
    let clock = Stopwatch::start();
    let plan = sweep_file::plan_with(document, given);
    let plan = plan.map_err(|found| failure::of_input(&found))?;
    let setup = Setup::new(plan).map_err(failure::of_value)?;
    let cases = setup.plan().cases().len();
    let count = Count {
        job: Job::of(cases),
        notes: Mutex::default(),
    };
    let job = &count.job;
    let setup = setup.interrupted_by(Arc::clone(&job.interrupt));
    // More threads than cases have nothing to do until peaks are located, which takes a few for each.
    let threads = run::useful_threads(threads).min(cases.max(1) * PEAK_CASES);
    let mode = match is_solved {
        true => Mode::on_threads(threads),
        false => Mode::Read,
    };
    let made = wait::run(py, job, progress, || {
        run::run(&setup, records.archive(), mode, &job.interrupt, &count)
    })?;
    let outcome = made.map_err(|error| failure::of_sweep(&error))?;
    if is_solved && outcome.interrupted {
        return Err(PyKeyboardInterrupt::new_err("interrupted"));
    }
    Ok(Sweep {
        plan: setup.plan().clone(),
        outcome,
        records,
        tables,
        clock,
        threads,
        notes: count.notes.into_inner().unwrap_or_default(),
    })
}
