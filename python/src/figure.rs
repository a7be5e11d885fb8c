//! Figures that the program draws of a result.

use std::path::{Path, PathBuf};

use contact_dma::report::caption::Setting;
use contact_dma::report::chart::{ChartError, Drawing};
use contact_dma::report::figure::{self, Picture};
use contact_dma::report::kept_figures::KeptFigures;
use contact_dma::sweep::plan::figures::{FigurePlan, SvgText};
use contact_dma::sweep::store::write_atomically;
use pyo3::prelude::*;

use crate::failure;

/// A figure as the program draws it; a notebook shows it.
#[pyclass(frozen, module = "contact_dma")]
pub struct Figure {
    /// The name of its files, such as ``"energy-loss"``.
    #[pyo3(get)]
    name: String,
    picture: Picture,
    caption: String,
    plan: FigurePlan,
}

#[pymethods]
impl Figure {
    /// Writes it as its ending says: ``.svg``, ``.pdf``, ``.eps`` or ``.png``.
    ///
    /// Args:
    ///     file: is replaced where it is there.
    fn save(&self, py: Python<'_>, file: PathBuf) -> PyResult<()> {
        let ending = file.extension().and_then(|ending| ending.to_str());
        let bytes = py.detach(|| {
            let drawing = self.drawing()?;
            Ok(match ending {
                Some("svg") => Some(match self.plan.svg_text {
                    SvgText::Outlines => drawing.to_svg().into_bytes(),
                    SvgText::Text => drawing.to_svg_with_text().into_bytes(),
                }),
                Some("pdf") => Some(drawing.to_pdf()?),
                Some("eps") => Some(drawing.to_eps().into_bytes()),
                Some("png") => Some(drawing.to_png_at(self.plan.dpi.unwrap_or(DPI))?),
                _ => None,
            })
        });
        let bytes = bytes.map_err(|error: ChartError| failure::of_run(error))?;
        let bytes = bytes.ok_or_else(|| {
            let name = file.display();
            failure::of_value(format!(
                "{name} is no name of a picture: end it with .svg, .pdf, .eps or .png"
            ))
        })?;
        write(&file, &bytes)
    }

    fn _repr_html_(&self) -> Option<String> {
        Some(self.drawing().ok()?.to_page_element())
    }

    fn __repr__(&self) -> String {
        format!("<Figure {}>", self.name)
    }
}

/// Pixels per inch on paper, where none are asked for.
const DPI: usize = 300;

fn write(file: &Path, bytes: &[u8]) -> PyResult<()> {
    write_atomically(file, bytes).map_err(|error| failure::of_store(&error))
}

impl Figure {
    fn drawing(&self) -> Result<Drawing, ChartError> {
        self.picture.as_asked(&self.plan, &self.caption)
    }

    /// Figures to be drawn as asked.
    pub fn all(figures: impl IntoIterator<Item = figure::Figure>, plan: &FigurePlan) -> Vec<Self> {
        let figures = figures.into_iter();
        let named = figures.map(|figure| Self {
            name: figure.name.to_string(),
            caption: figure.caption.text(&Setting::default()),
            picture: figure.picture,
            plan: plan.clone(),
        });
        named.collect()
    }
}

/// The figures that a folder of the program keeps in its ``records/figures.json``.
#[pyfunction]
pub fn kept_figures(file: &[u8]) -> PyResult<Vec<Figure>> {
    let kept = KeptFigures::read(file).map_err(failure::of_value)?;
    let figures = kept.into_pictures().map(|(name, picture)| Figure {
        name,
        picture,
        caption: String::new(),
        plan: FigurePlan::default(),
    });
    Ok(figures.collect())
}
