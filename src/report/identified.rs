//! What an identification leaves, whatever it was of: files, figures and page, the summary, and the lines for people.

use serde_json::Value;

use super::ReportError;
use super::force_curve::{self, CurvesReport};
use super::identify::{IdentifyReport, summary};
use super::kept_figures::KeptFigures;
use super::text::Text;
use crate::material::MaterialError;

/// Everything that is written and said of an identification.
pub struct Identification {
    /// Every file of the folder but figures and page.
    pub files: Vec<(String, Vec<u8>)>,
    /// The figures, and why others could not be drawn.
    pub figures: (KeptFigures, Vec<String>),
    pub summary: Value,
    pub text: Text,
    /// Curves that were not fitted.
    pub missing: usize,
}

/// Why one cannot be told.
#[derive(Debug, thiserror::Error)]
pub enum IdentificationError {
    #[error(transparent)]
    Material(#[from] MaterialError),
    #[error(transparent)]
    Report(#[from] ReportError),
}

impl Identification {
    /// Of cycles or a history.
    ///
    /// # Errors
    /// A series that is no material; a page that could not be made.
    pub fn of_series(report: &IdentifyReport<'_>) -> Result<Self, IdentificationError> {
        let block = report.block()?;
        let mut summary = summary::summary(report);
        let files = report.files(&summary, &block);
        summary["material_toml"] = block.as_str().into();
        let mut text = report.text();
        text.append_apart(report.unknowns().into());
        Ok(Self {
            figures: KeptFigures::of_identification(report, &block)?,
            files,
            summary,
            text,
            missing: 0,
        })
    }

    /// Of force curves.
    ///
    /// # Errors
    /// A page that could not be made.
    pub fn of_curves(report: &CurvesReport<'_>) -> Result<Self, IdentificationError> {
        let block = report.block();
        let mut summary = force_curve::summary::summary(report);
        let files = report.files(&summary, block.as_deref());
        summary["material_toml"] = block.as_deref().into();
        let mut text = report.text();
        if let Some(parameters) = report.parameters() {
            text.append_apart(parameters.into());
        }
        Ok(Self {
            figures: KeptFigures::of_curves(report, block.as_deref())?,
            files,
            summary,
            text,
            missing: report.missing().len(),
        })
    }
}
