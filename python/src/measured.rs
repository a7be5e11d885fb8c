//! Measured loops, and materials identified from measured cycles.

use std::f64::consts::TAU;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use contact_dma::force_curve::{Kept, fit_all};
use contact_dma::identify::{IdentifyError, curves, identify};
use contact_dma::input::diagnostic::Diagnostics;
use contact_dma::input::document::Document;
use contact_dma::input::identify_file::Asked;
use contact_dma::input::{identify_file, loop_file, setup_file};
use contact_dma::measured::{Options, Signal};
use contact_dma::quantity::{Dimension, parse};
use contact_dma::report::force_curve::CurvesReport;
use contact_dma::report::identified::Identification;
use contact_dma::report::identify::IdentifyReport;
use contact_dma::report::kept_figures::{KEPT, KeptFigures};
use contact_dma::report::measured::{Analysis, MeasuredRow, columns, files, ordered};
use contact_dma::report::{ReportError, figure};
use contact_dma::sweep::plan::figures::FigurePlan;
use contact_dma::sweep::search::run::{pool, useful_threads};
use contact_dma::sweep::store::manifest::{Kind, Target};
use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple, PyType};
use rayon::prelude::*;

use crate::figure::Figure;
use crate::record::{Items, MeasuredCycle, Status, Warning};
use crate::source::{Source, reduced};
use crate::wait::{self, Job};
use crate::{arrays, failure};

/// A record of load and approach: of a file, or columns in memory with their name.
enum RecordSource {
    File(PathBuf),
    Columns(String, [Vec<f64>; 3]),
}

/// Files with their bytes.
pub type Files<'py> = Vec<(String, Bound<'py, PyBytes>)>;

/// What measured loops say.
#[pyclass(frozen, subclass, module = "contact_dma._contact_dma")]
pub struct Loops(Analysis);

/// Records, what is known of all of them, and how they are read; or an analysis as the program keeps it.
#[derive(FromPyObject)]
enum LoopsOrigin<'py> {
    Kept(Bound<'py, PyBytes>),
    #[pyo3(transparent)]
    Records(Vec<Bound<'py, PyAny>>),
}

#[pymethods]
impl Loops {
    /// Of records, of which a frequency (Hz) and a setup, by name and text, may be known; or of the bytes of a ``records/analysis.json``.
    #[new]
    #[pyo3(signature = (origin: "object", frequency_hz = None, setup = (String::new(), None), threads = None))]
    fn new(
        py: Python<'_>,
        origin: LoopsOrigin<'_>,
        frequency_hz: Option<f64>,
        setup: (String, Option<String>),
        threads: Option<NonZeroUsize>,
    ) -> PyResult<Self> {
        match origin {
            LoopsOrigin::Records(records) => analysed(py, &records, frequency_hz, setup, threads),
            LoopsOrigin::Kept(everything) => {
                let analysis = serde_json::from_slice(everything.as_bytes());
                analysis.map(Self).map_err(|error| {
                    failure::of_value(format!(
                        "analysis.json is none that this version of the program wrote: {error}"
                    ))
                })
            }
        }
    }

    fn _all_columns<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        arrays::columns(py, &columns::of_records(), &self.0.rows)
    }

    /// How every record ended, and why it has no result.
    #[getter]
    fn status(&self, py: Python<'_>) -> PyResult<Items<Status>> {
        let status = |row: &MeasuredRow| Status {
            name: row.status().name().to_owned(),
            reason: row.reason.clone(),
        };
        Items::new(py, self.0.rows.iter().map(status))
    }

    /// For every record, what is to be known of it.
    #[getter]
    fn findings(&self, py: Python<'_>) -> PyResult<Items<Items<Warning>>> {
        let of =
            |row: &MeasuredRow| Items::new(py, row.findings().map(|f| Warning::of(f.code(), f)));
        let all = self.0.rows.iter().map(of);
        Items::new(py, all.collect::<PyResult<Vec<_>>>()?)
    }

    /// The mean cycle of every record.
    #[getter]
    fn cycles(&self, py: Python<'_>) -> PyResult<Items<MeasuredCycle>> {
        let cycle = |row: &MeasuredRow| {
            let line = |values: Vec<f64>| values.into_pyarray(py).unbind();
            let samples = row.samples().unwrap_or_default();
            MeasuredCycle {
                time: line(samples.time_s),
                load: line(samples.load_n),
                approach: line(samples.approach_m),
            }
        };
        Items::new(py, self.0.rows.iter().map(cycle))
    }

    fn _figures(&self) -> Vec<Figure> {
        Figure::all(figure::measured::figures(&self.0), &FigurePlan::default())
    }

    fn _summary(&self) -> PyResult<Vec<u8>> {
        let files = files(&self.0).map_err(failure::of_run)?;
        let summary = files.into_iter().find(|(name, _)| *name == "summary.json");
        Ok(summary.map(|(_, summary)| summary).unwrap_or_default())
    }

    /// Writes what ``contact-dma analyse`` writes; ``contact-dma report FOLDER`` draws figures and page from it.
    ///
    /// Args:
    ///     folder: a new or empty folder, or one of an analysis.
    ///     overwrite: whether another result there is replaced; files of others stay.
    #[pyo3(signature = (folder, *, overwrite = false))]
    fn save(&self, py: Python<'_>, folder: PathBuf, overwrite: bool) -> PyResult<()> {
        let files = files(&self.0).map_err(failure::of_run)?;
        let files = with_figures(files, KeptFigures::of_loops(&self.0))?;
        write_files(py, &folder, Kind::Analysis, files, overwrite)
    }

    /// Its title.
    #[getter]
    fn title(&self) -> &str {
        &self.0.title
    }

    #[pyo3(signature = () -> "tuple[Any, tuple[Any, ...]]")]
    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
        let everything = serde_json::to_vec(&slf.get().0).map_err(failure::of_run)?;
        reduced(slf.as_any(), PyBytes::new(slf.py(), &everything))
    }
}

fn analysed(
    py: Python<'_>,
    records: &[Bound<'_, PyAny>],
    frequency_hz: Option<f64>,
    (name, text): (String, Option<String>),
    threads: Option<NonZeroUsize>,
) -> PyResult<Loops> {
    let records = records
        .iter()
        .map(record_source)
        .collect::<PyResult<Vec<_>>>()?;
    let given = match &text {
        None => setup_file::Setup::default(),
        Some(text) => Document::parse(&name, text)
            .and_then(|document| setup_file::setup(&document))
            .map_err(|found| failure::of_input(&found))?,
    };
    let options = Options {
        frequency_hz,
        ..given.options
    };
    let pool = pool(useful_threads(threads)).map_err(|error| failure::of_sweep(&error))?;
    // A record cannot be left half read: after Ctrl-C those at work go on to their ends unheard, and no other is begun.
    let rows = wait::run_unheard(py, move |interrupt| {
        let read = |record| match interrupt.load(Ordering::Relaxed) {
            true => Ok(None),
            false => row(record, &options).map(Some),
        };
        let rows: Result<Option<Vec<MeasuredRow>>, Diagnostics> =
            pool.install(|| records.into_par_iter().map(read).collect());
        rows.map(Option::unwrap_or_default)
    })?;
    let analysis = Analysis {
        title: given.title.unwrap_or_else(|| "Measured loops".to_owned()),
        setup: text,
        rows: ordered(rows.map_err(|found| failure::of_input(&found))?),
        computed: Vec::new(),
    };
    Ok(Loops(analysis))
}

fn record_source(record: &Bound<'_, PyAny>) -> PyResult<RecordSource> {
    match record.extract::<(String, [PyReadonlyArray1<'_, f64>; 3])>() {
        Ok((name, columns)) => {
            let columns = columns.map(|column| column.as_array().to_vec());
            Ok(RecordSource::Columns(name, columns))
        }
        Err(_) => record.extract::<PathBuf>().map(RecordSource::File),
    }
}

fn row(record: RecordSource, options: &Options) -> Result<MeasuredRow, Diagnostics> {
    let (file, signal) = match record {
        RecordSource::File(path) => (path.display().to_string(), loop_file::read(&path)?),
        RecordSource::Columns(name, [time_s, load_n, approach_m]) => (
            name,
            Signal {
                time_s,
                load_n,
                approach_m,
                contact_radius_m: None,
            },
        ),
    };
    Ok(MeasuredRow::of(file, &signal, options))
}

/// Files of a folder with that of its figures, which `contact-dma report` draws.
fn with_figures<N: Into<String>>(
    files: Vec<(N, Vec<u8>)>,
    kept: Result<(KeptFigures, Vec<String>), ReportError>,
) -> PyResult<Vec<(String, Vec<u8>)>> {
    let (mut kept, _) = kept.map_err(|error| failure::of_report(&error))?;
    let kept = kept.to_json(&FigurePlan::default());
    let files = files.into_iter().map(|(name, bytes)| (name.into(), bytes));
    let kept = (KEPT.to_string(), kept.map_err(failure::of_run)?);
    Ok(files.chain([kept]).collect())
}

pub fn bytes<N: Into<String>>(py: Python<'_>, files: Vec<(N, Vec<u8>)>) -> Files<'_> {
    let files = files.into_iter();
    files
        .map(|(name, bytes)| (name.into(), PyBytes::new(py, &bytes)))
        .collect()
}

/// A material from measured cycles: every file of its folder.
#[pyfunction]
#[pyo3(signature = (source: "object", threads))]
pub fn identify_material<'py>(
    py: Python<'py>,
    mut source: Source<'py>,
    threads: Option<NonZeroUsize>,
) -> PyResult<Files<'py>> {
    let (given, tables) = (source.given(), source.tables());
    let document = source.document(&tables)?;
    let asked = identify_file::plan(&document, &given);
    let asked = asked.map_err(|found| failure::of_input(&found))?;
    let job = Job::default();
    let made = wait::run_on_threads(py, threads, (&job, None), || match &asked {
        Asked::Driven(plan) => {
            let found = identify(plan, &job.interrupt)?;
            let curves = curves(plan, &found, &job.interrupt)?;
            Ok(Identification::of_series(&IdentifyReport {
                plan,
                found: &found,
                curves: &curves,
            }))
        }
        Asked::Curves(plan) => {
            let fits = fit_all(plan, &Kept::default(), &job.interrupt, &|| {})?;
            Ok(Identification::of_curves(&CurvesReport::new(plan, &fits)))
        }
    })?;
    let made = made.map_err(|error| match error {
        IdentifyError::Interrupted => PyKeyboardInterrupt::new_err("interrupted"),
        IdentifyError::NoCycle { .. } | IdentifyError::NoHistory(_) | IdentifyError::NoFit(_) => {
            failure::of_run(error)
        }
        error => PyValueError::new_err(error.to_string()),
    })?;
    let made = made.map_err(failure::of_run)?;
    let files = with_figures(made.files, Ok(made.figures))?;
    Ok(bytes(py, files))
}

/// A number with its unit, in the SI unit of the quantity that is expected. Frequencies in Hz and in rad/s are read as one another.
#[pyfunction]
pub fn quantity(text: &str, si_unit: &str) -> PyResult<f64> {
    let mut all = Dimension::ALL.into_iter();
    let expected = all.find(|d| d.si_unit() == si_unit);
    let expected = expected.ok_or_else(|| failure::of_value(format!("no unit \"{si_unit}\"")))?;
    let other = match expected {
        Dimension::Frequency => Some((Dimension::AngularFrequency, TAU.recip())),
        Dimension::AngularFrequency => Some((Dimension::Frequency, TAU)),
        _ => None,
    };
    parse(text, expected).or_else(|error| {
        let other = other.and_then(|(other, factor)| Some(parse(text, other).ok()? * factor));
        other.ok_or_else(|| failure::of_value(error))
    })
}

/// Fills the folder of an identification with files; `force` replaces what else is there.
#[pyfunction]
pub fn write_identification(
    py: Python<'_>,
    folder: PathBuf,
    files: Vec<(String, Vec<u8>)>,
    force: bool,
) -> PyResult<()> {
    write_files(py, &folder, Kind::Identification, files, force)
}

fn write_files(
    py: Python<'_>,
    folder: &Path,
    kind: Kind,
    files: Vec<(String, Vec<u8>)>,
    force: bool,
) -> PyResult<()> {
    let target = Target {
        folder,
        kind,
        force,
        reads: &[],
    };
    py.detach(|| target.write(files))
        .map_err(|error| failure::of_store(&error))
}
