//! How the figures of a sweep or scenario are to look: the `[figures]` table. It is kept with the resolved file and is no part
//! of its hash: figures drawn in another way are of the same sweep.

use crate::quantity::{Dimension, FrequencyUnit, format_si};

/// What the `[figures]` table asks for. Where it asks for nothing, figures are 800 px wide with text of 16 px (211.7 mm and 12 pt
/// on a screen of 96 dpi), as SVG and as PNG of one and of two pixels per px; PDF is there to be asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct FigurePlan {
    /// Frequencies (rad/s) whose cycles are drawn; empty: chosen from the sweep.
    pub loops_rad_per_s: Vec<f64>,
    /// Width and height on paper (m).
    pub width_m: Option<f64>,
    pub height_m: Option<f64>,
    /// Size (pt) of the text at ticks, in legends and at marks; titles of axes are an eighth larger.
    pub font_size_pt: Option<f64>,
    /// At least one, each once.
    pub formats: Vec<Format>,
    /// Pixels of a PNG per inch on paper.
    pub dpi: Option<usize>,
    pub axes: AxisUnits,
    /// The unit in which frequencies are reported, by tables and text too.
    pub frequency_unit: FrequencyUnit,
    /// Whether pictures that have a title above the frame show it.
    pub titles: bool,
}

/// A form in which pictures are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    Svg,
    Png,
    /// Of the same size as the SVG; its text is text.
    Pdf,
}

/// How one picture is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form {
    Svg,
    Pdf,
    /// With this many pixels per inch on paper.
    PngOfDpi(usize),
    /// With this many pixels per px.
    PngOfScale(f32),
}

/// What the axes of figures are in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxisUnits {
    Si,
    /// Units of the elastic contact: see [`crate::sweep::scales::elastic::ElasticScale`].
    Normalised,
}

impl Format {
    /// All, as sweep files name them.
    pub const NAMES: [(&'static str, Self); 3] =
        [("svg", Self::Svg), ("png", Self::Png), ("pdf", Self::Pdf)];
}

impl AxisUnits {
    /// All, as sweep files name them.
    pub const NAMES: [(&'static str, Self); 2] =
        [("si", Self::Si), ("normalised", Self::Normalised)];
}

/// Widths (m) of a figure in one and in two columns of a journal, as sweep files name them.
pub const COLUMNS: [(&str, f64); 2] = [("one", 0.085), ("two", 0.180)];

/// Text size (pt) where a size is asked for but none of the text.
const FONT_SIZE_PT: f64 = 8.0;
/// Resolution (pixels per inch) of a PNG whose size on paper is asked for.
const DPI: usize = 300;
/// A px of a figure of which nothing is asked, on paper (m), and its text (px).
const PX_M: f64 = 0.0254 / 96.0;
const WIDTH_PX: f64 = 800.0;
const TEXT_PX: f64 = 16.0;
const POINT_M: f64 = 0.0254 / 72.0;

/// Pictures of more pixels are drawn one after another, on however many threads.
pub const MANY_PIXELS: u64 = 1 << 24;
/// Memory (bytes) that drawing a picture takes, per pixel: its colours with transparency and without.
const PIXEL_BYTES: f64 = 7.0;
/// Height of a figure over its width, where none is given.
const HEIGHT: f64 = 0.75;

/// A figure on paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperSize {
    pub width_m: f64,
    /// `None`: as the figure asks for.
    pub height_m: Option<f64>,
    /// Length (m) of one px of the drawing: its text of 16 px has the size asked for.
    pub px_m: f64,
}

impl Default for FigurePlan {
    fn default() -> Self {
        Self {
            loops_rad_per_s: Vec::new(),
            width_m: None,
            height_m: None,
            font_size_pt: None,
            formats: vec![Format::Svg, Format::Png],
            dpi: None,
            axes: AxisUnits::Si,
            frequency_unit: FrequencyUnit::RadPerS,
            titles: true,
        }
    }
}

impl FigurePlan {
    /// The size on paper, where any of it is asked for.
    pub fn paper(&self) -> Option<PaperSize> {
        if self.width_m.is_none() && self.height_m.is_none() && self.font_size_pt.is_none() {
            return None;
        }
        let font_size_pt = self.font_size_pt.unwrap_or(FONT_SIZE_PT);
        Some(PaperSize {
            width_m: self.width_m.unwrap_or(WIDTH_PX * PX_M),
            height_m: self.height_m,
            px_m: font_size_pt * POINT_M / TEXT_PX,
        })
    }

    /// Resolution (pixels per inch) of a single PNG; `None` for the two of figures of which nothing is asked.
    pub fn resolution(&self) -> Option<usize> {
        let of_paper = self.paper().map(|_| DPI);
        self.dpi.or(of_paper)
    }

    /// Memory (bytes) that drawing pictures takes on this number of threads.
    pub fn drawing_bytes(&self, threads: usize) -> u64 {
        let (paper, pictures) = (self.paper(), self.pictures());
        let width_m = paper.map_or(WIDTH_PX * PX_M, |paper| paper.width_m);
        let height_m = paper.and_then(|paper| paper.height_m);
        let area_m2 = width_m * height_m.unwrap_or(HEIGHT * width_m);
        let pixels = |form: &Form| match form {
            Form::Svg | Form::Pdf => 0.0,
            Form::PngOfDpi(dpi) => area_m2 * (*dpi as f64 / 0.0254).powi(2),
            Form::PngOfScale(scale) => area_m2 * (f64::from(*scale) / PX_M).powi(2),
        };
        let largest = pictures
            .iter()
            .map(|(_, form)| pixels(form))
            .fold(0.0, f64::max);
        let at_once = match largest > MANY_PIXELS as f64 {
            true => 1,
            false => threads,
        };
        (PIXEL_BYTES * largest) as u64 * at_once as u64
    }

    /// The pictures of a figure: the ending of each, and how it is drawn.
    pub fn pictures(&self) -> Vec<(&'static str, Form)> {
        let of_format = |format: &Format| match (format, self.resolution()) {
            (Format::Svg, _) => vec![(".svg", Form::Svg)],
            (Format::Pdf, _) => vec![(".pdf", Form::Pdf)],
            (Format::Png, Some(dpi)) => vec![(".png", Form::PngOfDpi(dpi))],
            (Format::Png, None) => vec![
                (".png", Form::PngOfScale(1.0)),
                ("@2x.png", Form::PngOfScale(2.0)),
            ],
        };
        self.formats.iter().flat_map(of_format).collect()
    }

    /// The table as it stands at the end of a resolved file: what differs from the default, nothing where nothing does.
    pub fn text(&self) -> String {
        let default = Self::default();
        let list =
            |items: Vec<String>| (!items.is_empty()).then(|| format!("[{}]", items.join(", ")));
        let length = |value: f64| format!("\"{}\"", format_si(value, Dimension::Length));
        let omega = |w: &f64| format!("\"{}\"", format_si(*w, Dimension::AngularFrequency));
        let named = |format: &Format| {
            let (name, _) = Format::NAMES.iter().find(|(_, f)| f == format)?;
            Some(format!("\"{name}\""))
        };
        let formats = self
            .formats
            .iter()
            .filter(|_| self.formats != default.formats);
        let other = |is_other: bool, value: &str| is_other.then(|| value.to_owned());
        let lines = [
            (
                "loops",
                list(self.loops_rad_per_s.iter().map(omega).collect()),
            ),
            ("width", self.width_m.map(length)),
            ("height", self.height_m.map(length)),
            (
                "font_size",
                self.font_size_pt.map(|size| format!("{size:?}")),
            ),
            ("formats", list(formats.filter_map(named).collect())),
            ("dpi", self.dpi.map(|dpi| dpi.to_string())),
            (
                "axes",
                other(self.axes == AxisUnits::Normalised, "\"normalised\""),
            ),
            (
                "frequency_unit",
                other(self.frequency_unit == FrequencyUnit::Hz, "\"Hz\""),
            ),
            ("titles", other(!self.titles, "false")),
        ];
        let line = |(key, value): (&str, Option<String>)| Some(format!("{key} = {}\n", value?));
        let lines: String = lines.into_iter().filter_map(line).collect();
        match lines.is_empty() {
            true => lines,
            false => format!("\n[figures]\n{lines}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn everything() -> FigurePlan {
        FigurePlan {
            loops_rad_per_s: vec![1e-3, 0.1],
            width_m: Some(0.085),
            height_m: Some(0.06),
            font_size_pt: Some(7.0),
            formats: vec![Format::Png, Format::Pdf],
            dpi: Some(600),
            axes: AxisUnits::Normalised,
            frequency_unit: FrequencyUnit::Hz,
            titles: false,
        }
    }

    #[test]
    fn a_table_is_written_line_by_line() {
        assert_eq!(FigurePlan::default().text(), "");
        let sweep = "title = \"a\"\n\n[solver]\ncells = 3\n";
        let whole = format!("{sweep}{}", everything().text());
        assert_eq!(
            &whole[sweep.len()..],
            "\n[figures]\nloops = [\"0.001 rad/s\", \"0.1 rad/s\"]\nwidth = \"0.085 m\"\nheight = \"0.06 m\"\nfont_size = 7.0\n\
             formats = [\"png\", \"pdf\"]\ndpi = 600\naxes = \"normalised\"\nfrequency_unit = \"Hz\"\ntitles = false\n"
        );
    }

    #[test]
    fn text_of_the_drawing_has_the_size_asked_for() {
        assert_eq!(FigurePlan::default().paper(), None);
        let paper = everything().paper().unwrap();
        // 16 px are 7 pt.
        assert!((16.0 * paper.px_m / POINT_M - 7.0).abs() < 1e-12);
        let only_text = FigurePlan {
            font_size_pt: Some(12.0),
            ..FigurePlan::default()
        };
        let paper = only_text.paper().unwrap();
        // As without the table: 800 px.
        assert!((paper.width_m / paper.px_m - 800.0).abs() < 1e-9);
    }

    #[test]
    fn two_resolutions_are_for_figures_of_which_nothing_is_asked() {
        let endings = |plan: &FigurePlan| -> Vec<&str> {
            let pictures = plan.pictures().into_iter();
            pictures.map(|(ending, _)| ending).collect()
        };
        let default = FigurePlan::default();
        assert_eq!(endings(&default), [".svg", ".png", "@2x.png"]);
        assert_eq!(endings(&everything()), [".png", ".pdf"]);
        assert_eq!(everything().resolution(), Some(600));
        let column = FigurePlan {
            width_m: Some(0.085),
            ..FigurePlan::default()
        };
        assert_eq!(column.resolution(), Some(300));
    }
}
