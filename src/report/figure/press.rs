//! Pictures written as the `[figures]` table asks for: size, forms, resolution; each with its caption.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::{Figure, Picture};
use crate::figures::font::Typeface;
use crate::figures::paper::{self, Form, PaperSize};
use crate::report::ReportError;
use crate::report::caption::Setting;
use crate::report::chart::{self, Chart, ChartError, Color, Drawing, LegendPlace, LineStyle};
use crate::report::page::Pictures;
use crate::sweep::plan::figures::{Colors, FigurePlan, SvgText};
use crate::sweep::store::StoreError;
use crate::sweep::store::files::{CAPTION, DATA, Place};

/// Writes one file: its place, its bytes.
pub type WriteFile<'a> = dyn Fn(Place<'_>, &[u8]) -> Result<(), StoreError> + Sync + 'a;

/// Files that are made before any of them is written.
#[derive(Debug, Default)]
pub struct Files(Mutex<BTreeMap<String, Vec<u8>>>);

impl Files {
    /// These, by their names.
    pub fn of<N: Into<String>>(files: impl IntoIterator<Item = (N, Vec<u8>)>) -> Self {
        let files = files.into_iter();
        Self(Mutex::new(
            files.map(|(name, bytes)| (name.into(), bytes)).collect(),
        ))
    }

    /// Adds a file.
    pub fn insert(&self, name: impl Into<String>, bytes: impl Into<Vec<u8>>) {
        let mut files = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        files.insert(name.into(), bytes.into());
    }

    /// All of them, by their names.
    pub fn into_vec(self) -> Vec<(String, Vec<u8>)> {
        let files = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        files.into_iter().collect()
    }
}

/// What makes files of figures.
pub struct Press<'a> {
    pub plan: &'a FigurePlan,
    pub write: &'a WriteFile<'a>,
    /// Sees every picture, in whatever forms it is written.
    pub pictures: &'a Pictures,
}

impl Press<'_> {
    /// Renders all figures in parallel and writes every file: pictures, captions, data.
    ///
    /// # Errors
    /// [`ReportError`] naming the figure.
    pub fn figures(&self, figures: &[Figure], setting: &Setting) -> Result<(), ReportError> {
        figures.par_iter().try_for_each(|figure| {
            let name = &*figure.name;
            if !figure.data.is_empty() {
                self.put(name, DATA, &figure.data)?;
            }
            self.picture(name, name, &figure.picture, &figure.caption.text(setting))
        })
    }

    /// Writes one picture and its caption. `file` is the name without its ending, `figure` what errors call it. One that cannot be
    /// drawn ends nothing: why is kept with the pictures ([`Pictures::not_drawn`]).
    ///
    /// # Errors
    /// [`ReportError`] naming the file that cannot be written.
    pub fn picture(
        &self,
        file: &str,
        figure: &str,
        picture: &Picture,
        caption: &str,
    ) -> Result<(), ReportError> {
        match self.picture_in(
            &paper::pictures(self.plan),
            (file, figure),
            picture,
            caption,
        ) {
            Err(ReportError::Chart { source, .. }) => {
                self.pictures.insert_failure(file, &source);
                Ok(())
            }
            written => written,
        }
    }

    /// As [`Press::picture`], in these of the forms that the plan asks for, where all must be drawn.
    ///
    /// # Errors
    /// As [`Press::picture`], and [`ReportError::Chart`] where the picture cannot be drawn.
    pub fn picture_in(
        &self,
        forms: &[(&str, Form)],
        (file, figure): (&str, &str),
        picture: &Picture,
        caption: &str,
    ) -> Result<(), ReportError> {
        let failed = |source| ReportError::Chart {
            name: figure.to_owned(),
            source,
        };
        let drawing = picture.as_asked(self.plan, caption).map_err(failed)?;
        let caption = &*drawing.captioned(caption);
        let drawing = drawing
            .described(caption)
            .stamped(self.pictures.sweep_hash());
        self.pictures.insert(file, caption, &drawing);
        self.put(file, CAPTION, format!("{caption}\n").as_bytes())?;
        forms.par_iter().try_for_each(|(ending, form)| {
            let bytes = match *form {
                Form::Svg(SvgText::Outlines) => Ok(drawing.to_svg().into_bytes()),
                Form::Svg(SvgText::Text) => Ok(drawing.to_svg_with_text().into_bytes()),
                Form::Pdf => drawing.to_pdf(),
                Form::Eps => Ok(drawing.to_eps().into_bytes()),
                Form::PngOfDpi(dpi) => drawing.to_png_at(dpi),
                Form::PngOfScale(scale) => drawing.to_png(scale),
            };
            Ok(self.put(file, ending, &bytes.map_err(failed)?)?)
        })
    }

    /// Writes one file of a figure.
    ///
    /// # Errors
    /// [`StoreError`].
    pub fn put(&self, figure: &str, ending: &str, bytes: &[u8]) -> Result<(), StoreError> {
        (self.write)(Place::Figure(figure, ending), bytes)?;
        self.pictures.wrote(figure, ending);
        Ok(())
    }
}

impl Picture {
    /// The picture in the size, typeface and colours asked for, with its title or without.
    ///
    /// # Errors
    /// As [`Chart::draw`].
    pub fn as_asked(&self, plan: &FigurePlan, caption: &str) -> Result<Drawing, ChartError> {
        let mut picture = self.clone();
        picture.entitle(plan.titles, caption);
        let typeface = Typeface::of(&plan.font)?;
        for chart in &mut picture.0 {
            chart.typeface = typeface.clone();
        }
        if plan.colors == Colors::Color {
            return picture.sized(plan);
        }
        let charts = std::mem::take(&mut picture.0).into_iter();
        picture.0 = charts.map(Chart::in_grey).collect();
        Ok(picture.sized(plan)?.in_grey())
    }

    /// Puts what a figure shows, as its caption begins, above its frame, or takes away what stands there; where neither is asked for, a
    /// chart says which curve it shows.
    fn entitle(&mut self, titles: Option<bool>, caption: &str) {
        match titles {
            None => {}
            Some(false) => self.0.iter_mut().for_each(|chart| chart.title = None),
            Some(true) => {
                let subject = subject_of(caption).to_owned();
                if let Some(first) = self.0.first_mut().filter(|_| !subject.is_empty()) {
                    first.title = Some(match &first.title {
                        None => subject,
                        Some(which) => format!("{subject}: {which}"),
                    });
                }
            }
        }
    }

    /// The picture in the size asked for, with the texts asked for or, where they leave no room for the plot, as large ones as do.
    fn sized(mut self, plan: &FigurePlan) -> Result<Drawing, ChartError> {
        /// Texts of each try to those of the one before, and of the last one to those asked for.
        const SMALLER: f64 = 0.95;
        const LEAST: f64 = 0.4;
        let Some(asked) = paper::paper_size(plan) else {
            return self.draw();
        };
        self.make_fit_for_paper();
        let mut paper = asked;
        loop {
            match self.clone().on_paper(&paper) {
                Err(ChartError::Size { .. }) if paper.px_m > LEAST * asked.px_m => {
                    paper.px_m *= SMALLER;
                }
                Ok(drawing) if paper.px_m < asked.px_m => {
                    return Ok(drawing.with_smaller_text(asked.text_pt(), paper.text_pt()));
                }
                drawn => return drawn,
            }
        }
    }

    fn on_paper(mut self, paper: &PaperSize) -> Result<Drawing, ChartError> {
        let height_mm = match self.resize(paper)? {
            true => paper.height_m.map(|height_m| 1e3 * height_m),
            false => None,
        };
        let drawing = self.draw()?;
        Ok(drawing.on_paper(1e3 * paper.width_m, height_mm, 1e3 * paper.px_m))
    }

    /// Gives the drawing the px of this size on paper; says whether it has the height asked for. A map to scale has its own, and
    /// what is too low for its labels and legends is drawn as high as they need.
    fn resize(&mut self, paper: &PaperSize) -> Result<bool, ChartError> {
        // Whole px within the paper; a rounding error must not cost one.
        let whole = |length_m: f64| (length_m / paper.px_m + 1e-6).floor() as u32;
        let width_px = whole(paper.width_m);
        let height_px = paper.height_m.map(whole);
        let charts = &mut self.0;
        if let [chart] = charts.as_mut_slice()
            && chart.map.as_ref().is_some_and(|map| map.is_to_scale())
        {
            chart.size.width_px = width_px;
            return Ok(false);
        }
        if let Some(height_px) = height_px {
            let high = charts.iter().map(|chart| chart.size.height_px).sum::<u32>();
            let ratio = f64::from(height_px) / f64::from(high.max(1));
            let given: Vec<Chart> = charts
                .iter()
                .map(|chart| resized(chart, width_px, ratio))
                .collect();
            let fit = given
                .iter()
                .map(chart::fits)
                .collect::<Result<Vec<_>, _>>()?;
            if !fit.contains(&false) {
                *charts = given;
                return Ok(true);
            }
        }
        let wide = charts.iter().map(|chart| chart.size.width_px).max();
        let ratio = f64::from(width_px) / f64::from(wide.unwrap_or(1).max(1));
        for chart in charts {
            *chart = resized(chart, width_px, ratio);
            chart.size.height_px = chart::fitting_height_px(chart)?;
        }
        Ok(false)
    }

    /// Paper may be printed in grey: curves of a family, which differ in colour alone on a screen, get strokes of their own. And a
    /// corner that a legend was given in a wide picture may hold data in a narrow one.
    fn make_fit_for_paper(&mut self) {
        for chart in &mut self.0 {
            if let Some(
                LegendPlace::TopRight
                | LegendPlace::TopLeft
                | LegendPlace::BottomRight
                | LegendPlace::BottomLeft,
            ) = chart.legend
            {
                chart.legend = Some(LegendPlace::Auto);
            }
        }
        for series in self.0.iter_mut().flat_map(|chart| &mut chart.series) {
            if let (Some(LineStyle::Solid), None, Color::Ramp { step, of }) =
                (series.line, series.marker, series.color)
                && of > 1
            {
                series.line = Some(LineStyle::nth(step));
            }
        }
    }
}

/// What a caption says a figure shows: its words to the first colon, comma or full stop.
fn subject_of(caption: &str) -> &str {
    let ends = [": ", ", ", ". "].into_iter();
    let end = ends.filter_map(|end| caption.find(end)).min();
    let subject = end.and_then(|end| caption.get(..end));
    subject.unwrap_or(caption).trim_end_matches('.')
}

/// The chart so wide, its height in this ratio to what it was.
fn resized(chart: &Chart, width_px: u32, ratio: f64) -> Chart {
    let high = (f64::from(chart.size.height_px) * ratio).floor() as u32;
    chart.clone().size(width_px, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, HeatMap, MapShape, Marker, Series};

    fn chart() -> Chart {
        let line = |step: u8| {
            let points = [(0.0, 0.0), (1.0, 1.0 + f64::from(step))];
            Series::line(points).color(Color::Ramp {
                step: usize::from(step),
                of: 2,
            })
        };
        Chart::new(Axis::linear("x"), Axis::linear("y"))
            .title("title")
            .series(line(0))
            .series(line(1))
            .series(line(1).marker(Marker::Disc))
    }

    fn paper(height_m: Option<f64>) -> PaperSize {
        PaperSize {
            width_m: 0.08,
            height_m,
            px_m: 2e-4,
        }
    }

    #[test]
    fn heights_follow_the_width_or_are_what_is_given() {
        let sizes = |height_m: Option<f64>| {
            let mut stack = Picture(vec![
                chart().size(800, 600),
                chart().size(800, 300).title("b"),
            ]);
            let met = stack.resize(&paper(height_m)).unwrap();
            assert_eq!(met, height_m == Some(0.12));
            assert!(stack.draw().is_ok());
            let size = |chart: &Chart| (chart.size.width_px, chart.size.height_px);
            stack.0.iter().map(size).collect::<Vec<_>>()
        };
        // Half as high, the second frame has no room between its titles: it gets what they need.
        assert_eq!(sizes(None), [(400, 300), (400, 200)]);
        assert_eq!(sizes(Some(0.12)), [(400, 400), (400, 200)]);
        // Too low for labels: as high as they need.
        assert_eq!(sizes(Some(0.03)), sizes(None));
    }

    #[test]
    fn a_map_to_scale_keeps_its_shape_and_others_take_the_height() {
        let axis = |label| Axis::linear(label).range(0.0, 1.0);
        let map = |shape| HeatMap {
            columns: 1,
            rows: 1,
            values: vec![Some(1.0)],
            value_label: "value".to_owned(),
            shape,
            ..HeatMap::default()
        };
        let resized = |shape, height_m| {
            let mut picture = Picture::from(Chart::new(axis("x"), axis("y")).map(map(shape)));
            let met = picture.resize(&paper(height_m)).unwrap();
            let size = picture.0[0].size;
            (met, size.width_px, size.height_px)
        };
        let high = MapShape::Stretched;
        assert!(!resized(MapShape::ToScale, Some(0.0014)).0);
        assert_eq!(resized(high, None), (false, 400, 300));
        assert_eq!(resized(high, Some(0.04)), (true, 400, 200));
        // Too low for labels: as high as it needs.
        assert_eq!(resized(high, Some(0.01)), (false, 400, 300));
    }

    #[test]
    fn a_title_is_what_the_caption_begins_with_and_the_curve_that_is_shown() {
        let title = |titles, caption: &str| {
            let mut stack = Picture(vec![chart(), chart().title("b")]);
            stack.entitle(titles, caption);
            let titles = stack.0.into_iter().map(|chart| chart.title);
            titles.map(Option::unwrap_or_default).collect::<Vec<_>>()
        };
        let caption = "Shift factors a_T: over temperature T: rigid sphere.";
        assert_eq!(title(None, caption), ["title", "b"]);
        assert_eq!(title(Some(false), caption), ["", ""]);
        let subject = "Shift factors a_T: title";
        assert_eq!(title(Some(true), caption), [subject, "b"]);
        assert_eq!(title(Some(true), ""), ["title", "b"]);
        for (caption, expected) in [
            (
                "Energy loss per cycle, by branch: sphere.",
                "Energy loss per cycle",
            ),
            ("Loss at 0.5 Hz. More.", "Loss at 0.5 Hz"),
            ("Moduli.", "Moduli"),
        ] {
            assert_eq!(subject_of(caption), expected);
        }
    }

    #[test]
    fn on_paper_a_family_has_strokes_of_its_own_and_the_legend_looks_for_a_place() {
        let mut picture = Picture::from(chart().legend(LegendPlace::TopLeft));
        picture.make_fit_for_paper();
        let styles: Vec<_> = picture.0[0]
            .series
            .iter()
            .filter_map(|series| series.line)
            .collect();
        assert_eq!(
            styles,
            [LineStyle::Solid, LineStyle::Dashed, LineStyle::Solid]
        );
        assert_eq!(picture.0[0].legend, Some(LegendPlace::Auto));
    }
}
