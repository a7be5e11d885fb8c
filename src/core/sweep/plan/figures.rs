//! How the figures of a sweep or scenario are to look: the `[figures]` table. It is kept with the resolved file and is no part
//! of its hash: figures drawn in another way are of the same sweep.

use crate::quantity::setting::{Table, Value};
use crate::quantity::{Dimension, FrequencyUnit};
use crate::words;

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

words! {
    /// A form in which pictures are written.
    pub enum Format {
        Svg = "svg",
        Png = "png",
        /// Of the same size as the SVG; its text is text.
        Pdf = "pdf",
    }
}

words! {
    /// What the axes of figures are in.
    pub enum AxisUnits {
        Si = "si",
        /// Units of the elastic contact that the same indenter makes on a body as stiff as this one is at once.
        Normalised = "normalised",
    }
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
    /// The table at the end of a resolved file: what differs from the default, nothing where nothing does.
    pub fn text(&self) -> String {
        let default = Self::default();
        let length = |value_m: f64| Value::Quantity(value_m, Dimension::Length);
        let loops = (!self.loops_rad_per_s.is_empty())
            .then(|| Value::Quantities(self.loops_rad_per_s.clone(), Dimension::AngularFrequency));
        let named = |format: &Format| Format::NAMES.iter().find(|(_, other)| other == format);
        let formats = self.formats.iter().filter_map(named);
        let formats = Value::Texts(formats.map(|(name, _)| (*name).to_owned()).collect());
        let is_normalised = self.axes == AxisUnits::Normalised;
        let is_in_hz = self.frequency_unit == FrequencyUnit::Hz;
        let table = Table::new("figures")
            .with_some("loops", loops)
            .with_some("width", self.width_m.map(length))
            .with_some("height", self.height_m.map(length))
            .with_some("font_size", self.font_size_pt)
            .with_some(
                "formats",
                (self.formats != default.formats).then_some(formats),
            )
            .with_some("dpi", self.dpi)
            .with_some("axes", is_normalised.then_some("normalised"))
            .with_some("frequency_unit", is_in_hz.then_some("Hz"))
            .with_some("titles", (!self.titles).then_some(false));
        table
            .unless_empty()
            .map_or(String::new(), |table| table.toml())
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
        let whole = format!("{sweep}\n{}", everything().text());
        assert_eq!(
            &whole[sweep.len()..],
            "\n[figures]\nloops = [\"0.001 rad/s\", \"0.1 rad/s\"]\nwidth = \"0.085 m\"\nheight = \"0.06 m\"\nfont_size = 7.0\n\
             formats = [\"png\", \"pdf\"]\ndpi = 600\naxes = \"normalised\"\nfrequency_unit = \"Hz\"\ntitles = false\n"
        );
    }
}
