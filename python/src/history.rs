//! Single drive histories.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use contact_dma::contact::surface::{CellSurface, Surface};
use contact_dma::input::scenario_file;
use contact_dma::report::profile_lines;
use contact_dma::report::quantities::{Moment, of_cycles, of_moments};
use contact_dma::report::scenario_tables;
use contact_dma::simulation::outside_model;
use contact_dma::simulation::scenario::{ScenarioPlan, resolved_text};
use contact_dma::simulation::{Simulation, SimulationEnd, SimulationOutcome, SurfaceRecord};
use contact_dma::sweep::store::Store;
use contact_dma::sweep::store::provenance::{Circumstances, Stopwatch};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};

use crate::folder::MapFile;
use crate::record::{Field, Items, SurfaceLine, SurfaceProfile, Warning};
use crate::shape::Shape;
use crate::source::{Origin, Packed, Source, reduced};
use crate::wait::{self, Counter, Watch};
use crate::{arrays, failure};

/// A history and what it came to.
#[pyclass(frozen, module = "contact_dma._contact_dma")]
pub struct History {
    plan: ScenarioPlan,
    outcome: SimulationOutcome,
    /// The indenter, of a plan whose text does not say all of it.
    shape: Option<Py<Shape>>,
}

#[pymethods]
impl History {
    #[new]
    #[pyo3(signature = (origin: "object", threads = None, progress = None))]
    fn new(
        py: Python<'_>,
        origin: Origin<'_>,
        threads: Option<NonZeroUsize>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let packed = match origin {
            Origin::Call(source) => return simulated(py, &source, threads, progress.as_ref()),
            Origin::Packed(packed) => packed,
            Origin::Folder(_) => {
                return Err(failure::of_value("histories are read by contact_dma.read"));
            }
        };
        let (document, given) = packed.document("the pickled history")?;
        let plan = scenario_file::plan_with(&document, &given);
        let outcome = postcard::from_bytes(packed.3.as_bytes(py));
        Ok(Self {
            plan: plan.map_err(|found| failure::of_input(&found))?,
            outcome: outcome.map_err(|_| failure::of_other_build())?,
            shape: packed.2,
        })
    }

    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let moments: Vec<Moment> = Moment::all(&self.outcome).collect();
        arrays::columns(py, &of_moments(), &moments)
    }

    fn cycles<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        arrays::columns(py, &of_cycles(), &self.outcome.cycles)
    }

    #[getter]
    fn title(&self) -> &str {
        &self.plan.title
    }

    #[getter]
    fn resolved(&self) -> String {
        resolved_text(&self.plan)
    }

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

    #[getter]
    fn warnings(&self, py: Python<'_>) -> PyResult<Items<Warning>> {
        let warnings = outside_model::warnings(&self.plan, &self.outcome);
        Items::new(py, warnings.into_iter().map(|w| Warning::of(w.code(), w)))
    }

    #[getter]
    fn profiles(&self, py: Python<'_>) -> PyResult<Items<SurfaceProfile>> {
        let profiles = self.outcome.profiles.iter().map(|record| {
            let lines = profile_lines::lines(record).into_iter();
            let lines = lines.map(|(along, points)| {
                let of = |value: fn(&profile_lines::ProfilePoint) -> Option<f64>| {
                    arrays::nullable(py, points.iter().map(value))
                };
                SurfaceLine {
                    along: along.to_owned(),
                    position: of(|point| Some(point.position_m)),
                    pressure: of(|point| point.pressure_pa),
                    displacement: of(|point| Some(point.displacement_m)),
                    gap: of(|point| point.gap_m),
                }
            });
            let row = &record.row;
            Ok(SurfaceProfile {
                time: row.time_s,
                load: row.load_n,
                approach: row.approach_m.unwrap_or(f64::NAN),
                contact_radius: row.contact_radius_m,
                lines: Items::new(py, lines)?,
            })
        });
        Items::new(py, profiles.collect::<PyResult<Vec<_>>>()?)
    }

    /// Nothing is copied.
    #[getter]
    fn fields(slf: &Bound<'_, Self>) -> PyResult<Items<Field>> {
        let fields = slf.get().outcome.fields.iter().filter_map(|record| {
            let Surface::Cells(cells) = &record.surface else {
                return None;
            };
            Some(field(slf.as_any(), record, cells))
        });
        Items::new(slf.py(), fields.collect::<PyResult<Vec<_>>>()?)
    }

    fn save(&self, py: Python<'_>, folder: PathBuf, overwrite: bool) -> PyResult<()> {
        py.detach(|| {
            let mut plan = self.plan.clone();
            let map = self.shape.as_ref().and_then(|shape| shape.get().map());
            let map = map.map(|map| MapFile::of(map, &folder)).transpose()?;
            if let Some(map) = &map {
                plan.contact.indenter = Arc::clone(&map.indenter);
            }
            let stored = |error| failure::of_store(&error);
            let store = Store::open(&folder, &resolved_text(&plan), overwrite).map_err(stored)?;
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
    ) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), slf.get());
        let outcome = postcard::to_stdvec(&this.outcome).map_err(failure::of_run)?;
        let resolved = resolved_text(&this.plan);
        let packed = Packed::of(py, resolved, this.shape.as_ref(), &outcome, 1);
        reduced(slf.as_any(), packed)
    }
}

/// A field of a result, which holds its arrays.
fn field(
    result: &Bound<'_, PyAny>,
    record: &SurfaceRecord,
    cells: &CellSurface,
) -> PyResult<Field> {
    let (grid, row) = (&cells.grid, &record.row);
    let shape = (grid.cells_y(), grid.cells_x());
    let array = |values: &[f64]| {
        let array = arrays::matrix(result, values, shape);
        let array = array.ok_or_else(|| failure::of_run("a field has another size than its grid"));
        array.map(Bound::unbind)
    };
    Ok(Field {
        time: row.time_s,
        load: row.load_n,
        approach: row.approach_m.unwrap_or(f64::NAN),
        contact_radius: row.contact_radius_m,
        spacing: (grid.spacing_x_m(), grid.spacing_y_m()),
        pressure: array(&cells.pressure_pa)?,
        displacement: array(&cells.displacement_m)?,
        gap: record.gap_m.as_deref().map(array).transpose()?,
    })
}

/// Follows a drive history.
fn simulated(
    py: Python<'_>,
    source: &Source<'_>,
    threads: Option<NonZeroUsize>,
    progress: Option<&Bound<'_, PyAny>>,
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
        callback: progress,
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
