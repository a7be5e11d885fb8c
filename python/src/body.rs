//! Materials.

use std::sync::Arc;

use contact_dma::input::given::{self, DynamicFit};
use contact_dma::material::export::{self, Program};
use contact_dma::material::fit::FitRemark;
use contact_dma::material::{Material, MaterialError, ModulusKind};
use contact_dma::report::dynamic::{DynamicReport, Source};
use contact_dma::simulation::body_material::BodyMaterial;
use contact_dma::sweep::plan::resolved::material_text;
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::measured::{Files, bytes};
use crate::source::{Held, document};
use crate::{arrays, failure, wait};

/// A material that was read from its block of a sweep file.
#[pyclass(frozen, subclass, module = "contact_dma._contact_dma")]
pub struct Body {
    material: BodyMaterial,
    /// A block that gives the same material again.
    text: String,
    /// What was made of dynamic data, of a material of such.
    dynamic: Option<Arc<DynamicFit>>,
}

/// What is known of a fit: its report, one fact a line; notes; warnings; and files: name and bytes.
type Fit<'py> = (Vec<String>, Vec<String>, Vec<String>, Files<'py>);

/// Equilibrium modulus, moduli and times of a generalised Maxwell solid.
type Prony<'py> = (f64, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

#[pymethods]
impl Body {
    #[new]
    #[pyo3(signature = (name, text, tables = Vec::new()))]
    fn new(py: Python<'_>, name: String, text: String, tables: Held) -> PyResult<Self> {
        let block = text.clone();
        let read = wait::run_unheard(py, move |_| {
            let document = document(&name, &block, tables)?;
            given::material_with_fit(&document)
        })?;
        let (material, dynamic) = read.map_err(|found| failure::of_input(&found))?;
        let text = match material.series() {
            // A fit needs not be made again.
            Some(series) => material_text(series),
            None => text,
        };
        Ok(Self {
            material,
            text,
            dynamic,
        })
    }

    /// The material as a ``[material]`` block of a sweep file that gives the same material again, bit for bit.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// Whether it is a series, which sweeps take, and not samples as they are.
    #[getter]
    fn _is_series(&self) -> bool {
        self.material.series().is_some()
    }

    /// How the series was fitted; `None` of a material that was not fitted to data.
    fn _fitted<'py>(&self, py: Python<'py>) -> Option<Fit<'py>> {
        if let Some(dynamic) = &self.dynamic {
            return Some(self.dynamic_fit(py, dynamic));
        }
        let report = self.material.series()?.origin.fit.as_ref()?;
        let (warnings, notes) = report.remarks.iter().partition(|r| r.is_warning());
        let sentences = |remarks: Vec<&FitRemark>| remarks.iter().map(|r| r.to_string()).collect();
        let summary = serde_json::json!({
            "relative_rms": report.misfit.rms,
            "largest_relative_misfit": report.misfit.largest,
            "largest_relative_misfit_at_s": report.misfit.largest_at_s,
            "branches": report.branches,
            "samples": report.samples,
        });
        let files = vec![("summary.json", summary.to_string().into_bytes())];
        let lines = report.to_string();
        let lines = lines.lines().map(str::to_owned).collect();
        Some((
            lines,
            sentences(notes),
            sentences(warnings),
            bytes(py, files),
        ))
    }

    /// Its name, where it has one.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.material.series()?.name()
    }

    /// Poisson ratio, where it is constant in time.
    #[getter]
    fn poisson_ratio(&self) -> Option<f64> {
        self.material.poisson_ratio()
    }

    /// Bulk modulus (Pa), where it is constant in time in place of the Poisson ratio.
    #[getter]
    fn bulk_modulus(&self) -> Option<f64> {
        self.material
            .series()?
            .compressibility()
            .constant_bulk_modulus_pa()
    }

    /// The temperature (K) that it is for, where the data know temperatures.
    #[getter]
    fn temperature(&self) -> Option<f64> {
        self.material.series()?.origin.temperature_k
    }

    /// Complex modulus E' + i E'' (Pa), or G' + i G''.
    ///
    /// Args:
    ///     angular_frequency: angular frequencies (rad/s), of any shape.
    ///     modulus: Young's or shear modulus.
    ///
    /// Returns:
    ///     complex numbers of the same shape.
    #[pyo3(signature = (angular_frequency: "ArrayLike", *, modulus: "ModulusKind" = "longitudinal") -> "complex")]
    fn complex_modulus<'py>(
        &self,
        angular_frequency: &Bound<'py, PyAny>,
        modulus: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (material, kind) = (self.series()?, kind(modulus)?);
        arrays::mapped(angular_frequency, "rad/s", |omega| match kind {
            ModulusKind::Longitudinal => material.longitudinal_complex_modulus(omega),
            ModulusKind::Shear => material.shear_complex_modulus(omega),
        })
    }

    /// Creep compliance D(t) (1/Pa), or J(t).
    ///
    /// Args:
    ///     time: times (s), of any shape.
    ///     modulus: ``"longitudinal"`` for D, ``"shear"`` for J.
    ///
    /// Returns:
    ///     numbers of the same shape.
    #[pyo3(signature = (time: "ArrayLike", *, modulus: "ModulusKind" = "longitudinal") -> "float")]
    fn creep_compliance<'py>(
        &self,
        time: &Bound<'py, PyAny>,
        modulus: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let creep = self.series()?.creep_as(kind(modulus)?);
        let creep = creep.map_err(failure::of_value)?;
        arrays::mapped(time, "s", |time| creep.compliance(time))
    }

    /// Relaxation modulus E(t) (Pa), or G(t).
    ///
    /// Args:
    ///     time: times (s), of any shape.
    ///     modulus: Young's or shear modulus.
    ///
    /// Returns:
    ///     numbers of the same shape.
    #[pyo3(signature = (time: "ArrayLike", *, modulus: "ModulusKind" = "longitudinal") -> "float")]
    fn relaxation_modulus<'py>(
        &self,
        time: &Bound<'py, PyAny>,
        modulus: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let relaxation = self.relaxation(modulus)?;
        arrays::mapped(time, "s", |time| relaxation.modulus(time))
    }

    /// The text that gives the material to a finite element program.
    ///
    /// Args:
    ///     program: ``"abaqus"``, ``"ansys"``, ``"ls-dyna"``, ``"comsol"``, or ``"csv"``.
    fn export(&self, program: &str) -> PyResult<String> {
        let known = Program::ALL.into_iter().find(|p| p.name() == program);
        let known = known.ok_or_else(|| {
            let names = Program::ALL.map(Program::name).join(", ");
            failure::of_value(format!("no program is \"{program}\": write one of {names}"))
        })?;
        let material = self.series()?;
        let made = export::export(material, material.origin.shift.as_ref(), known);
        Ok(made.map_err(failure::of_value)?.text)
    }

    fn _prony<'py>(&self, py: Python<'py>) -> PyResult<Prony<'py>> {
        let relaxation = self.relaxation("longitudinal")?;
        let branches = relaxation.branches();
        let moduli: Vec<f64> = branches.iter().map(|b| b.modulus_pa).collect();
        let times: Vec<f64> = branches.iter().map(|b| b.time_s).collect();
        let equilibrium = relaxation.equilibrium_modulus();
        Ok((equilibrium, moduli.into_pyarray(py), times.into_pyarray(py)))
    }
}

impl Body {
    /// The material as plans take it.
    pub fn material(&self) -> BodyMaterial {
        self.material.clone()
    }

    fn dynamic_fit<'py>(&self, py: Python<'py>, dynamic: &DynamicFit) -> Fit<'py> {
        let source = Source::of(dynamic.files.clone(), dynamic.format_named, &dynamic.file);
        let report = DynamicReport {
            source: &source,
            data: &dynamic.file.data,
            made: &dynamic.made,
            beside: None,
        };
        let files = report.files(&self.text, None);
        let notes = source.notes.clone();
        (report.lines(), notes, report.warnings(), bytes(py, files))
    }

    fn series(&self) -> PyResult<&Material> {
        self.material.series().ok_or_else(|| {
            PyValueError::new_err(
                "this material is samples taken as they are, which have no series; leave out evaluation=\"direct\" for a fit",
            )
        })
    }

    fn relaxation(&self, modulus: &str) -> PyResult<contact_dma::material::Relaxation> {
        let relaxation = self.series()?.relaxation_as(kind(modulus)?);
        let relaxation = relaxation.map_err(failure::of_value)?;
        relaxation.ok_or_else(|| failure::of_value(MaterialError::SingularContactPressure))
    }
}

fn kind(modulus: &str) -> PyResult<ModulusKind> {
    let kinds = [ModulusKind::Longitudinal, ModulusKind::Shear];
    let named = kinds.into_iter().find(|kind| kind.name() == modulus);
    named.ok_or_else(|| {
        failure::of_value(format!(
            "modulus is \"{modulus}\": write \"longitudinal\" or \"shear\""
        ))
    })
}
