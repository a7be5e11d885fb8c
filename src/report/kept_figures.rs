//! `figures.json`: the figures of a result as they are to be seen, of which they are drawn in another size or form, without what the
//! result was made of.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::ReportError;
use super::caption::Setting;
use super::figure::press::{Files, Press};
use super::figure::{self, Figure, Picture};
use super::force_curve::CurvesReport;
use super::identify::IdentifyReport;
use super::measured::Analysis;
use super::page::{self, Pictures};
use crate::sweep::plan::figures::FigurePlan;
use crate::sweep::store::files::{CAPTION, DATA, PAGE, PICTURES, Place};

/// The file.
pub const KEPT: Place<'_> = Place::Record("figures.json");

/// The figures of a result and its page.
#[derive(Debug, Serialize, Deserialize)]
pub struct KeptFigures {
    /// The `[figures]` table, empty where nothing is asked for.
    asked: String,
    figures: Vec<Kept>,
    /// With a mark in the place of each picture; empty where there is no page.
    page: String,
}

#[derive(Debug, Serialize, Deserialize)]
struct Kept {
    name: String,
    caption: String,
    /// CSV, empty where another file holds the data.
    data: String,
    picture: Picture,
}

/// Why a file holds no figures that can be drawn.
#[derive(Debug, thiserror::Error)]
pub enum KeptError {
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    #[error("the figure {0:?} has a name that is none of a file")]
    Name(String),
    #[error("the figure {0} is larger than any that the program draws")]
    Size(String),
}

impl KeptFigures {
    /// Those of measured loops, with a page where there are any. A figure that cannot be drawn is left out: why is returned.
    ///
    /// # Errors
    /// [`ReportError`] naming the page.
    pub fn of_loops(analysis: &Analysis) -> Result<(Self, Vec<String>), ReportError> {
        let figures = figure::measured::figures(analysis);
        Self::with_page(&figures, &Setting::default(), |pictures, _| {
            page::measured::page(analysis, &figures, pictures)
        })
    }

    /// The same of an identification, whose material has this block.
    ///
    /// # Errors
    /// [`ReportError`] naming the page.
    pub fn of_identification(
        report: &IdentifyReport<'_>,
        block: &str,
    ) -> Result<(Self, Vec<String>), ReportError> {
        let figures = figure::identify::figures(report);
        Self::with_page(&figures, &Setting::default(), |pictures, _| {
            page::identify::page(report, &figures, block, pictures)
        })
    }

    /// The same of laws of force curves, with the block of the material of a single one.
    ///
    /// # Errors
    /// [`ReportError`] naming the page.
    pub fn of_curves(
        report: &CurvesReport<'_>,
        block: Option<&str>,
    ) -> Result<(Self, Vec<String>), ReportError> {
        let figures = figure::force_curve::figures(report);
        Self::with_page(&figures, &Setting::default(), |pictures, _| {
            page::force_curve::page(report, &figures, block, pictures)
        })
    }

    /// These figures, and a page, which is made of the pictures and the name of the first one; without figures there is no page.
    ///
    /// # Errors
    /// [`ReportError`] naming the page.
    pub fn with_page(
        figures: &[Figure],
        setting: &Setting,
        page: impl FnOnce(&Pictures, &str) -> Result<String, ReportError>,
    ) -> Result<(Self, Vec<String>), ReportError> {
        Self::of(figures, setting, |pictures| match figures.first() {
            Some(first) => page(pictures, &first.name),
            None => Ok(String::new()),
        })
    }

    /// These figures, and the page that is made of their pictures, empty where there is none. A figure that cannot be drawn is left
    /// out: why is returned.
    ///
    /// # Errors
    /// [`ReportError`] naming the page.
    pub fn of(
        figures: &[Figure],
        setting: &Setting,
        page: impl FnOnce(&Pictures) -> Result<String, ReportError>,
    ) -> Result<(Self, Vec<String>), ReportError> {
        let (mut kept, mut left_out) = (Vec::new(), Vec::new());
        for figure in figures {
            match figure.picture.draw() {
                Ok(_) => kept.push(Kept {
                    name: figure.name.to_string(),
                    caption: figure.caption.text(setting),
                    data: String::from_utf8_lossy(&figure.data).into_owned(),
                    picture: figure.picture.clone(),
                }),
                Err(error) => left_out.push(format!("no figure {}: {error}", figure.name)),
            }
        }
        let marks = Pictures::marks(kept.iter().map(|figure| &*figure.name));
        let kept = Self {
            asked: String::new(),
            page: page(&marks)?,
            figures: kept,
        };
        Ok((kept, left_out))
    }

    /// Those of a file.
    ///
    /// # Errors
    /// [`KeptError`].
    pub fn read(bytes: &[u8]) -> Result<Self, KeptError> {
        /// More than any figure of the program has.
        const MOST_CHARTS: usize = 20;
        const MOST_PX: u32 = 20_000;
        let kept: Self = serde_json::from_slice(bytes)?;
        for Kept { name, picture, .. } in &kept.figures {
            let is_letter = |letter: u8| letter.is_ascii_alphanumeric() || letter == b'-';
            if name.is_empty() || name.len() > 100 || !name.bytes().all(is_letter) {
                return Err(KeptError::Name(name.clone()));
            }
            let charts = &picture.0;
            let sizes = charts.iter().map(|chart| chart.size);
            let mut sides = sizes.flat_map(|size| [size.width_px, size.height_px]);
            if charts.len() > MOST_CHARTS || sides.any(|side| side > MOST_PX) {
                return Err(KeptError::Size(name.clone()));
            }
        }
        Ok(kept)
    }

    /// The `[figures]` table as they were last drawn.
    pub fn asked(&self) -> &str {
        &self.asked
    }

    /// Whether a file of the folder, by its name in the present layout, is made by drawing them: the page, a picture, a caption, the
    /// data behind it.
    pub fn make(&self, file: &str) -> bool {
        let with_data = |figure: &Kept| {
            let data = Place::Figure(&figure.name, DATA).to_string();
            // In folders of earlier versions not every figure had another name than a table.
            !figure.data.is_empty() && (file == data || data.ends_with(&format!("/{file}")))
        };
        let is_picture = || {
            PICTURES
                .iter()
                .chain([&CAPTION])
                .any(|ending| file.ends_with(ending))
        };
        file == PAGE || is_picture() || self.figures.iter().any(with_data)
    }

    /// Their names.
    pub fn names(&self) -> Vec<&str> {
        self.figures.iter().map(|figure| &*figure.name).collect()
    }

    /// Their pictures, by name.
    pub fn into_pictures(self) -> impl Iterator<Item = (String, Picture)> {
        let figures = self.figures.into_iter();
        figures.map(|figure| (figure.name, figure.picture))
    }

    /// Files of the figures as asked: pictures, captions, data and the page. Returns what could not be drawn and why.
    ///
    /// # Errors
    /// [`ReportError`] naming the file that cannot be made.
    pub fn draw(&self, plan: &FigurePlan, files: &Files) -> Result<Vec<String>, ReportError> {
        let pictures = Pictures::default();
        let write = |place: Place<'_>, bytes: &[u8]| {
            files.insert(place, bytes);
            Ok(())
        };
        let press = Press {
            plan,
            write: &write,
            pictures: &pictures,
        };
        self.figures.par_iter().try_for_each(|figure| {
            if !figure.data.is_empty() {
                press.put(&figure.name, DATA, figure.data.as_bytes())?;
            }
            press.picture(&figure.name, "figure", &figure.picture, &figure.caption)
        })?;
        if !self.page.is_empty() {
            files.insert(PAGE, pictures.placed(&self.page, &self.names()));
        }
        Ok(pictures.not_drawn())
    }

    /// The file, which says that they are drawn as asked.
    ///
    /// # Errors
    /// What cannot be written as JSON.
    pub fn to_json(&mut self, plan: &FigurePlan) -> serde_json::Result<Vec<u8>> {
        self.asked = plan.text();
        serde_json::to_vec(self)
    }
}
