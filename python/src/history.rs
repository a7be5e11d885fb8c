//! Single drive histories.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use contact_dma::contact::surface::{CellSurface, Surface};
use contact_dma::input::diagnostic::Tables;
use contact_dma::input::scenario_file;
use contact_dma::report::figure::pressure_map;
use contact_dma::report::figure::units::Units;
use contact_dma::report::profile_lines::{Profile, ProfilePoint};
use contact_dma::report::quantities::{Moment, of_cycles, of_moments};
use contact_dma::report::{self, scenario_folder, scenario_tables};
use contact_dma::simulation::outside_model;
use contact_dma::simulation::scenario::{ScenarioPlan, resolved_text};
use contact_dma::simulation::{Simulation, SimulationEnd, SimulationOutcome, SurfaceRecord};
use contact_dma::sweep::plan::resolved::hash;
use contact_dma::sweep::store::provenance::Stopwatch;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};

use crate::figure::Figure;
use crate::folder::{self, Format};
use crate::record::{Field, Items, SurfaceLine, SurfaceProfile, Warning};
use crate::source::{Origin, Packed, Source, reduced};
use crate::wait::{self, Job};
use crate::{arrays, failure};

/// What a drive history came to.
#[pyclass(frozen, subclass, module = "contact_dma._contact_dma")]
pub struct History {
    plan: ScenarioPlan,
    made: scenario_tables::History,
    /// What the plan names as files and has in memory.
    tables: Tables,
    /// Where it was read.
    folder: Option<PathBuf>,
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
            Origin::Call(source) => return simulated(py, source, threads, progress.as_ref()),
            Origin::Folder(folder) => return py.detach(|| read(folder)),
            Origin::Packed(packed) => packed,
        };
        let (document, tables) = packed.document(py, "the pickled history")?;
        let plan = scenario_file::plan(&document);
        let outcome: Result<SimulationOutcome, _> = postcard::from_bytes(packed.3.as_bytes(py));
        Ok(Self {
            plan: plan.map_err(|found| failure::of_input(&found))?,
            made: outcome.map_err(|_| failure::of_other_build())?.into(),
            tables,
            folder: None,
        })
    }

    fn _all_columns<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let moments: Vec<Moment> = Moment::all(&self.made.outcome).collect();
        arrays::columns(py, &of_moments(), &moments)
    }

    fn _summary(&self) -> PyResult<Vec<u8>> {
        let hash = hash(&self.resolved());
        let summary = scenario_tables::summary(&self.plan, &self.made.outcome, &hash);
        summary.map_err(|error| failure::of_report(&error))
    }

    fn _cycles<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        arrays::columns(py, &of_cycles(), &self.made.outcome.cycles)
    }

    fn _figures(&self) -> PyResult<Vec<Figure>> {
        let units = Units::of_scenario(&self.plan).map_err(|error| failure::of_report(&error))?;
        let (mut figures, _) = report::scenario::lines(&self.plan, &self.made, &units);
        if let Ok(maps) = pressure_map::figures(&self.made.outcome.fields, &units) {
            figures.extend(maps);
        }
        Ok(Figure::all(figures, &self.plan.figures))
    }

    /// Its title.
    #[getter]
    fn title(&self) -> &str {
        &self.plan.title
    }

    /// The scenario as the text of its file, every default filled in.
    #[getter]
    fn resolved(&self) -> String {
        resolved_text(&self.plan)
    }

    /// Why the history ended before its time; None where it did not. What came before is in the columns.
    #[getter]
    fn failure(&self) -> Option<&str> {
        match &self.made.outcome.ended {
            SimulationEnd::Failed(message) => Some(message),
            SimulationEnd::Interrupted => Some("interrupted"),
            SimulationEnd::Done => None,
        }
    }

    /// Why there are no errors although they were asked for.
    #[getter]
    fn errors_missing(&self) -> Option<&str> {
        self.made.outcome.errors_missing.as_deref()
    }

    /// What lies outside the model.
    #[getter]
    fn warnings(&self, py: Python<'_>) -> PyResult<Items<Warning>> {
        let warnings = outside_model::warnings(&self.plan, &self.made.outcome);
        Items::new(py, warnings.into_iter().map(|w| Warning::of(w.code(), w)))
    }

    /// The surface along lines at the times of ``profiles_at``.
    #[getter]
    fn profiles(&self, py: Python<'_>) -> PyResult<Items<SurfaceProfile>> {
        let profiles = self.made.profiles.iter().map(|Profile { row, lines, .. }| {
            let lines = lines.iter().map(|(along, points)| {
                let of = |value: fn(&ProfilePoint) -> Option<f64>| {
                    arrays::nullable(py, points.iter().map(value))
                };
                SurfaceLine {
                    along: along.clone(),
                    position: of(|point| Some(point.position_m)),
                    pressure: of(|point| point.pressure_pa),
                    displacement: of(|point| Some(point.displacement_m)),
                    gap: of(|point| point.gap_m),
                }
            });
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

    /// Whole fields at the times of ``fields_at``; their arrays are views that cannot be written to.
    #[getter]
    fn fields(slf: &Bound<'_, Self>) -> PyResult<Items<Field>> {
        let fields = slf.get().made.outcome.fields.iter().filter_map(|record| {
            let Surface::Cells(cells) = &record.surface else {
                return None;
            };
            Some(field(slf.as_any(), record, cells))
        });
        Items::new(slf.py(), fields.collect::<PyResult<Vec<_>>>()?)
    }

    /// Writes the tables that ``contact-dma simulate --no-figures`` writes: ``history.csv``, profiles, fields, ``summary.json``,
    /// ``resolved.toml``. ``contact-dma report FOLDER`` draws figures and page from them.
    ///
    /// Args:
    ///     folder: is made where it is not there.
    ///     overwrite: whether another result there is replaced.
    #[pyo3(signature = (folder, *, overwrite = false))]
    fn save(&self, py: Python<'_>, folder: PathBuf, overwrite: bool) -> PyResult<()> {
        py.detach(|| {
            let format = Format {
                resolved: resolved_text,
                read: scenario_file::plan,
            };
            let (store, plan) = format.open(&self.plan, &self.tables, (&folder, overwrite))?;
            let written = report::scenario::write_tables(&store, &plan, &self.made);
            written.map_err(|error| failure::of_report(&error))?;
            let clock = Stopwatch::start();
            folder::sign(&store, &clock, (&plan.solver, None), (1, None))
        })
    }

    #[pyo3(signature = () -> "tuple[Any, tuple[Any, ...]]")]
    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), slf.get());
        if let Some(folder) = &this.folder {
            return reduced(slf.as_any(), folder);
        }
        let outcome = postcard::to_stdvec(&this.made.outcome).map_err(failure::of_run)?;
        let resolved = resolved_text(&this.plan);
        let packed = Packed::of(py, resolved, &this.tables, &outcome, 1);
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

/// The history in a folder of the program.
fn read(folder: PathBuf) -> PyResult<History> {
    let document = folder::document(&folder)?.1;
    let plan = scenario_file::plan(&document).map_err(|found| failure::of_input(&found))?;
    let simulation = Simulation::new(plan).map_err(failure::of_value)?;
    let made = scenario_folder::read(&folder, &simulation);
    Ok(History {
        made: made.map_err(|found| failure::of_input(&found))?,
        plan: simulation.plan().clone(),
        tables: Tables::new(),
        folder: Some(folder),
    })
}

/// Follows a drive history.
fn simulated(
    py: Python<'_>,
    mut source: Source<'_>,
    threads: Option<NonZeroUsize>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<History> {
    let (given, tables) = (source.given(), source.tables());
    let document = source.document(&tables)?;
    let plan = scenario_file::plan_with(&document, &given);
    let plan = plan.map_err(|found| failure::of_input(&found))?;
    let simulation = Simulation::new(plan).map_err(failure::of_value)?;
    let job = Job::of(simulation.moments());
    let simulation = simulation.interrupted_by(Arc::clone(&job.interrupt));
    let outcome = wait::run_on_threads(py, threads, (&job, progress), || {
        let told = |done: usize, _: usize| job.done.store(done, Ordering::Relaxed);
        simulation.run(&job.interrupt, &told)
    })?;
    if outcome.ended == SimulationEnd::Interrupted {
        return Err(PyKeyboardInterrupt::new_err("interrupted"));
    }
    Ok(History {
        plan: simulation.plan().clone(),
        made: outcome.into(),
        tables,
        folder: None,
    })
}
