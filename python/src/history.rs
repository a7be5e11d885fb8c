//! Single drive histories.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use contact_dma::contact::surface::Surface;
use contact_dma::input::document::Document;
use contact_dma::input::given::Given;
use contact_dma::input::scenario_file;
use contact_dma::report::profile_lines;
use contact_dma::report::quantities::{Moment, of_cycles, of_moments};
use contact_dma::report::scenario_tables;
use contact_dma::simulation::cycles::HistoryCycle;
use contact_dma::simulation::errors::RowErrors;
use contact_dma::simulation::outside_model;
use contact_dma::simulation::scenario::{ScenarioPlan, resolved_text};
use contact_dma::simulation::{
    HistoryRow, Simulation, SimulationEnd, SimulationOutcome, SurfaceRecord,
};
use contact_dma::sweep::store::Store;
use contact_dma::sweep::store::provenance::{BUILD, Circumstances, Stopwatch};
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::exceptions::{PyIndexError, PyKeyboardInterrupt};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use serde::{Deserialize, Serialize};

use crate::folder::MapFile;
use crate::shape::Shape;
use crate::source::Source;
use crate::wait::{self, Counter, Watch};
use crate::{arrays, blocks, failure};

/// A history and what it came to.
#[pyclass(frozen, module = "contact_dma._contact_dma")]
pub struct History {
    plan: ScenarioPlan,
    outcome: SimulationOutcome,
    /// The indenter, of a plan whose text does not say all of it.
    shape: Option<Py<Shape>>,
}

/// An outcome for another process of the same build.
#[derive(Serialize, Deserialize)]
struct Packed {
    rows: Vec<HistoryRow>,
    profiles: Vec<SurfaceRecord>,
    fields: Vec<SurfaceRecord>,
    cycles: Vec<HistoryCycle>,
    /// Load, approach, radius, pressure.
    errors: Vec<[Option<f64>; 4]>,
    errors_missing: Option<String>,
    domain_half_width_m: f64,
    domain_enlarged: usize,
    iterations: u64,
    failed: Option<String>,
}

/// A line of a profile: along what, positions, pressures, displacements, gaps.
type Line<'py> = (
    &'static str,
    (Values<'py>, Values<'py>, Values<'py>, Values<'py>),
);

type Values<'py> = Bound<'py, PyArray1<f64>>;

/// Instant of a surface: time, load, approach, contact radius.
type Instant = (f64, f64, f64, f64);

/// A field: its instant, spacing along x and y, pressure, displacement, gap.
type Field<'py> = (
    Instant,
    (f64, f64),
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Option<Bound<'py, PyArray2<f64>>>,
);

#[pymethods]
impl History {
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let moments: Vec<Moment> = Moment::all(&self.outcome).collect();
        arrays::columns(py, &of_moments(), &moments)
    }

    /// The cycles of sine segments, one row each.
    fn cycles<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        arrays::columns(py, &of_cycles(), &self.outcome.cycles)
    }

    #[getter]
    fn title(&self) -> &str {
        &self.plan.title
    }

    /// The scenario as the text of its file, every default filled in.
    #[getter]
    fn resolved(&self) -> String {
        resolved_text(&self.plan)
    }

    /// Why the history ended before its time.
    #[getter]
    fn failure(&self) -> Option<&str> {
        match &self.outcome.ended {
            SimulationEnd::Failed(message) => Some(message),
            SimulationEnd::Done | SimulationEnd::Interrupted => None,
        }
    }

    #[getter]
    fn errors_missing(&self) -> Option<&str> {
        self.outcome.errors_missing.as_deref()
    }

    /// What lies outside the model: code and sentence.
    fn warnings(&self) -> Vec<(&'static str, String)> {
        let warnings = outside_model::warnings(&self.plan, &self.outcome);
        let warnings = warnings.into_iter();
        warnings.map(|w| (w.code(), w.to_string())).collect()
    }

    #[getter]
    fn profile_count(&self) -> usize {
        self.outcome.profiles.len()
    }

    #[getter]
    fn field_count(&self) -> usize {
        self.outcome.fields.len()
    }

    fn profile<'py>(&self, py: Python<'py>, index: usize) -> PyResult<(Instant, Vec<Line<'py>>)> {
        let record = at(&self.outcome.profiles, index)?;
        let lines = profile_lines::lines(record).into_iter();
        let line = |(along, points): (&'static str, Vec<profile_lines::ProfilePoint>)| {
            let of = |value: fn(&profile_lines::ProfilePoint) -> Option<f64>| {
                arrays::numbers(points.iter().map(value)).into_pyarray(py)
            };
            let columns = (
                of(|point| Some(point.position_m)),
                of(|point| point.pressure_pa),
                of(|point| Some(point.displacement_m)),
                of(|point| point.gap_m),
            );
            (along, columns)
        };
        Ok((instant(&record.row), lines.map(line).collect()))
    }

    /// A field of this result, whose arrays are not copied.
    fn field<'py>(slf: &Bound<'py, Self>, index: usize) -> PyResult<Field<'py>> {
        let record = at(&slf.get().outcome.fields, index)?;
        let Surface::Cells(cells) = &record.surface else {
            return Err(PyIndexError::new_err("there is no such field"));
        };
        let grid = &cells.grid;
        let shape = (grid.cells_y(), grid.cells_x());
        let array = |values: &[f64]| {
            let array = arrays::matrix(slf.as_any(), values, shape);
            array.ok_or_else(|| failure::of_run("a field has another size than its grid"))
        };
        let gap = record.gap_m.as_deref().map(array).transpose()?;
        Ok((
            instant(&record.row),
            (grid.spacing_x_m(), grid.spacing_y_m()),
            array(&cells.pressure_pa)?,
            array(&cells.displacement_m)?,
            gap,
        ))
    }

    /// Writes what the program writes, but for figures and page.
    fn save(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<()> {
        py.detach(|| {
            let mut plan = self.plan.clone();
            let map = self.shape.as_ref().and_then(|shape| shape.get().map());
            let map = map.map(|map| MapFile::of(map, &folder)).transpose()?;
            if let Some(map) = &map {
                plan.contact.indenter = Arc::clone(&map.indenter);
            }
            let stored = |error| failure::of_store(&error);
            let store = Store::open(&folder, &resolved_text(&plan), force).map_err(stored)?;
            if let Some(map) = &map {
                map.write(&store).map_err(stored)?;
            }
            let profiles = scenario_tables::profiles(&self.outcome);
            let written = scenario_tables::write(&store, &plan, (&self.outcome, &profiles));
            written.map_err(|error| failure::of_report(&error))?;
            store.remove_stale().map_err(stored)?;
            let circumstances = Circumstances {
                command: "python",
                threads: 1,
                shard: None,
                cases_computed: None,
                cases_found: None,
                interrupted: false,
            };
            let signed = Stopwatch::start().write(&store, &plan.solver, None, &circumstances);
            signed.map_err(stored)
        })
    }

    #[pyo3(signature = () -> "tuple[Any, tuple[Any, ...]]")]
    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), slf.get());
        let module = py.import("contact_dma._contact_dma")?;
        let packed = postcard::to_stdvec(&this.packed()).map_err(failure::of_run)?;
        let arguments = (
            BUILD,
            resolved_text(&this.plan),
            this.shape.as_ref(),
            PyBytes::new(py, &packed),
        );
        Ok((
            module.getattr("restore_history")?,
            arguments.into_pyobject(py)?,
        ))
    }
}

impl History {
    fn packed(&self) -> Packed {
        let outcome = &self.outcome;
        let errors = outcome.errors.iter().map(|e| {
            [
                e.load_n,
                e.approach_m,
                e.contact_radius_m,
                e.peak_pressure_pa,
            ]
        });
        Packed {
            rows: outcome.rows.clone(),
            profiles: outcome.profiles.clone(),
            fields: outcome.fields.clone(),
            cycles: outcome.cycles.clone(),
            errors: errors.collect(),
            errors_missing: outcome.errors_missing.clone(),
            domain_half_width_m: outcome.domain_half_width_m,
            domain_enlarged: outcome.domain_enlarged,
            iterations: outcome.iterations,
            failed: self.failure().map(str::to_owned),
        }
    }
}

impl Packed {
    fn outcome(self) -> SimulationOutcome {
        let errors = self.errors.into_iter();
        let errors =
            errors.map(
                |[load_n, approach_m, contact_radius_m, peak_pressure_pa]| RowErrors {
                    load_n,
                    approach_m,
                    contact_radius_m,
                    peak_pressure_pa,
                },
            );
        SimulationOutcome {
            rows: self.rows,
            profiles: self.profiles,
            fields: self.fields,
            cycles: self.cycles,
            errors: errors.collect(),
            errors_missing: self.errors_missing,
            domain_half_width_m: self.domain_half_width_m,
            domain_enlarged: self.domain_enlarged,
            iterations: self.iterations,
            ended: match self.failed {
                Some(message) => SimulationEnd::Failed(message),
                None => SimulationEnd::Done,
            },
        }
    }
}

fn at(records: &[SurfaceRecord], index: usize) -> PyResult<&SurfaceRecord> {
    let record = records.get(index);
    record.ok_or_else(|| PyIndexError::new_err("there is no such surface"))
}

fn instant(row: &HistoryRow) -> Instant {
    (
        row.time_s,
        row.load_n,
        row.approach_m.unwrap_or(f64::NAN),
        row.contact_radius_m,
    )
}

/// Follows a drive history.
#[pyfunction]
#[pyo3(signature = (source: "object", threads, progress))]
pub fn simulate(
    py: Python<'_>,
    source: Source<'_>,
    threads: Option<NonZeroUsize>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<History> {
    let (document, given) = (source.document()?, source.given());
    let plan = scenario_file::plan_with(&document, &given);
    let plan = plan.map_err(|found| failure::of_input(&found))?;
    let simulation = Simulation::new(plan).map_err(failure::of_value)?;
    let interrupt = Arc::new(AtomicBool::new(false));
    let simulation = simulation.interrupted_by(Arc::clone(&interrupt));
    let counter = Counter::default();
    let watch = Watch {
        counter: &counter,
        callback: progress.as_ref(),
    };
    counter.total.store(simulation.moments(), Ordering::Relaxed);
    let outcome = wait::run_on_threads(py, (threads, &interrupt), Some(&watch), || {
        let told = |done: usize, _: usize| counter.done.store(done, Ordering::Relaxed);
        simulation.run(&interrupt, &told)
    })?;
    if outcome.ended == SimulationEnd::Interrupted {
        return Err(PyKeyboardInterrupt::new_err("interrupted"));
    }
    Ok(History {
        plan: simulation.plan().clone(),
        outcome,
        shape: source.map(),
    })
}

/// The history that [`History::__reduce__`] has packed.
#[pyfunction]
pub fn restore_history(
    build: &str,
    resolved: &str,
    shape: Option<Py<Shape>>,
    packed: &[u8],
) -> PyResult<History> {
    let packed = postcard::from_bytes::<Packed>(packed);
    let (true, Ok(packed)) = (build == BUILD, packed) else {
        return Err(failure::of_other_build());
    };
    let given = Given {
        material: None,
        indenter: shape.as_ref().map(|shape| shape.get().indenter()),
    };
    let text = match &shape {
        Some(_) => blocks::without(resolved, "indenter")?,
        None => resolved.to_owned(),
    };
    let document = Document::parse("the pickled history", &text);
    let document = document.map_err(|found| failure::of_input(&found))?;
    let plan = scenario_file::plan_with(&document, &given);
    Ok(History {
        plan: plan.map_err(|found| failure::of_input(&found))?,
        outcome: packed.outcome(),
        shape,
    })
}
