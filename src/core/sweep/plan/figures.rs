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

/// What the axes of figures are in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxisUnits {
    Si,
    /// Units of the elastic contact that the same indenter makes on a body as stiff as this one is at once.
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
}
