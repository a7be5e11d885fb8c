//! How the figures of a sweep or scenario are to look: the `[figures]` table. It is kept with the resolved file and is no part
//! of its hash: figures drawn in another way are of the same sweep.

use std::borrow::Cow;
use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::quantity::Dimension::{AngularFrequency, Energy, Length};
use crate::quantity::FrequencyUnit;
use crate::quantity::block::{Block as _, Field};
use crate::quantity::key::{Entries, Kind, Limits, Number, number, quantity, words_of};
use crate::quantity::setting::{Setting, Table, Value};
use crate::{block_with_defaults, words};

/// Sides, text and resolutions beyond these are a slip of the pen rather than a wish.
const SIDE: Number = quantity(Length)
    .such_as("\"85 mm\"")
    .within(Limits::between(0.02, 1.0).or_else("a figure one column wide has \"85 mm\""));
const FONT_SIZE: Limits = Limits::between(4.0, 36.0)
    .or_else("write a number of points without a unit, such as `font_size = 8`");
const DPI: RangeInclusive<usize> = 30..=2400;
const FORMATS: Entries = Entries {
    repeats: false,
    ..Entries::of(
        1..=Format::WORDS.len(),
        "write at least one of \"svg\", \"png\", \"pdf\" and \"eps\", or leave it out",
    )
};
/// More loops, or curves, than this cannot be told apart.
const MOST_LOOPS: usize = 8;
const CURVE: Limits = Limits::between(1.0, 1e6).or_else("curves are counted from 1");
const CURVES: Entries = Entries {
    repeats: false,
    ..Entries::of(
        1..=MOST_LOOPS,
        "a figure shows 1 to 8 curves; leave it out and some are chosen",
    )
};

block_with_defaults! {
    /// Appearance of figures; does not affect results, and all of it is optional.
    pub struct FigurePlan in "figures" {
        /// Frequencies whose loops are drawn (the nearest cases); left out: chosen automatically. Hz is accepted too.
        loops_rad_per_s: Vec<f64> = Vec::new() => "loops",
            Kind::Numbers(quantity(AngularFrequency), Entries::of(1..=MOST_LOOPS, "a figure shows 1 to 8 loops; leave it out and some are chosen")), chosen;
        /// Numbers of the curves in figures that show several, in the order in which `sweep.csv` has them; left out: some, evenly spread.
        curves: Vec<f64> = Vec::new() => "curves", Kind::Numbers(number("1").within(CURVE), CURVES);
        /// Ends of the axis in figures over frequency; left out: those of the sweep. Hz is accepted too.
        frequency_range_rad_per_s: Vec<f64> = Vec::new() => "frequency_range",
            Kind::Numbers(quantity(AngularFrequency).above_zero(), Entries::two("write both ends, such as `[\"1e-3 rad/s\", \"1 rad/s\"]`"));
        /// Ends of the axis of the energy loss; left out: chosen from the losses.
        energy_loss_range_j: Vec<f64> = Vec::new() => "energy_loss_range",
            Kind::Numbers(quantity(Energy).not_negative(), Entries::two("write both ends, such as `[\"0 J\", \"4 uJ\"]`"));
        /// Unit of frequencies in figures, tables and text; left out: that used in `[sweep]`.
        frequency_unit: FrequencyUnit = FrequencyUnit::RadPerS => "frequency_unit", Kind::Word(FrequencyUnit::WORDS), chosen;
        /// Width and text for one (85 mm) or two (180 mm) columns of a journal, in place of `width`.
        column: Option<Column> = None => "column", Kind::Word(Column::WORDS);
        /// Width on paper.
        width_m: Option<f64> = None => "width", Kind::Number(SIDE);
        /// Height on paper; left out: chosen from the contents.
        height_m: Option<f64> = None => "height", Kind::Number(SIDE);
        /// Size (pt) of ticks and legends; titles of axes are an eighth larger.
        font_size_pt: Option<f64> = None => "font_size", Kind::Number(number("8").within(FONT_SIZE));
        /// Typeface: DejaVu Sans, Arimo (the widths of Arial), Tinos (the widths of Times), or that of a file. Letters that it lacks are
        /// those of DejaVu Sans.
        font: FontChoice = FontChoice::Dejavu => "font", Kind::Either(&Kind::Word(&FontChoice::WORDS), &Kind::Text, ": the path of a .ttf or .otf file");
        /// Greys in place of colours, with line styles and markers that tell curves apart.
        colors: Colors = Colors::Color => "colors", Kind::Word(Colors::WORDS);
        /// File formats; left out: SVG and PNG. PDFs contain text as text, for LaTeX; an EPS has outlines of letters, and no transparency.
        formats: Cow<'static, [Format]> = Cow::Borrowed(&[Format::Svg, Format::Png]) => "formats", Kind::Words(Format::WORDS, FORMATS), chosen;
        /// Letters of an SVG: outlines, which look the same everywhere, or text, which can be edited and needs the typeface where it is shown.
        svg_text: SvgText = SvgText::Outlines => "svg_text", Kind::Word(SvgText::WORDS);
        /// Pixels of a PNG per inch on paper; left out: 300 if a size is given, otherwise one and two pixels per px of the drawing.
        dpi: Option<usize> = None => "dpi", Kind::Integer(DPI);
        /// SI units, or units of the elastic contact.
        axes: AxisUnits = AxisUnits::Si => "axes", Kind::Word(AxisUnits::WORDS), chosen;
        /// `true`: what a figure shows stands above its frame; `false`: nothing does; left out: which curve it shows, where there are others.
        titles: Option<bool> = None => "titles", Kind::Flag;
    }
}

impl Column {
    /// Width on paper (m).
    pub fn width_m(self) -> f64 {
        match self {
            Self::One => 0.085,
            Self::Two => 0.180,
        }
    }
}

words! {
    /// Columns of a journal.
    pub enum Column {
        One = "one",
        Two = "two",
    }
}

words! {
    /// A form in which pictures are written.
    pub enum Format {
        Svg = "svg",
        Png = "png",
        /// Of the same size as the SVG; its text is text.
        Pdf = "pdf",
        /// Of the same size too; its text is outlines.
        Eps = "eps",
    }
}

words! {
    /// What curves, areas and maps are drawn in.
    pub enum Colors {
        Color = "color",
        /// For a print in black and white.
        Grey = "grey",
    }
}

words! {
    /// What the letters of an SVG are.
    pub enum SvgText {
        Outlines = "outlines",
        Text = "text",
    }
}

/// What the texts of figures are set in.
#[derive(Debug, Clone, PartialEq)]
pub enum FontChoice {
    Dejavu,
    Sans,
    Serif,
    /// The font of a file. The bytes are those that were read; a plan that was only parsed has none.
    File {
        path: String,
        bytes: Arc<Vec<u8>>,
    },
}

impl FontChoice {
    /// Those without a file, as files name them.
    pub const NAMED: [(&'static str, Self); 3] = [
        ("dejavu", Self::Dejavu),
        ("sans", Self::Sans),
        ("serif", Self::Serif),
    ];
    pub const WORDS: [&'static str; 3] = words_of(&Self::NAMED);
}

impl Field for FontChoice {
    fn written(&self, _: &Kind) -> Option<Value> {
        Some(match self {
            Self::File { path, .. } => path.clone().into(),
            named => {
                let mut all = Self::NAMED.into_iter();
                all.find(|(_, choice)| choice == named)?.0.into()
            }
        })
    }

    fn of(value: Value) -> Option<Self> {
        let text = String::of(value)?;
        let named = Self::NAMED.into_iter().find(|(word, _)| *word == text);
        Some(match named {
            Some((_, choice)) => choice,
            None => Self::File {
                path: text,
                bytes: Arc::default(),
            },
        })
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

impl FigurePlan {
    /// The table at the end of a resolved file: what differs from the default, nothing where nothing does.
    pub fn text(&self) -> String {
        let default: Vec<Setting> = Self::DEFAULT.settings().collect();
        let asked = self.settings().filter(|own| !default.contains(own));
        let table = Table::new(Self::NAME).and(asked).unless_empty();
        table.map_or(String::new(), |table| table.toml())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn everything() -> FigurePlan {
        FigurePlan {
            loops_rad_per_s: vec![1e-3, 0.1],
            curves: vec![1.0, 3.0],
            frequency_range_rad_per_s: vec![1e-3, 1.0],
            energy_loss_range_j: vec![0.0, 4e-6],
            column: None,
            width_m: Some(0.085),
            height_m: Some(0.06),
            font_size_pt: Some(7.0),
            formats: Cow::Borrowed(&[Format::Png, Format::Pdf]),
            dpi: Some(600),
            font: FontChoice::Serif,
            colors: Colors::Grey,
            svg_text: SvgText::Text,
            axes: AxisUnits::Normalised,
            frequency_unit: FrequencyUnit::Hz,
            titles: Some(false),
        }
    }

    #[test]
    fn a_table_is_written_line_by_line() {
        assert_eq!(FigurePlan::default().text(), "");
        let sweep = "title = \"a\"\n\n[solver]\ncells = 3\n";
        let whole = format!("{sweep}\n{}", everything().text());
        assert_eq!(
            &whole[sweep.len()..],
            "\n[figures]\nloops = [\"0.001 rad/s\", \"0.1 rad/s\"]\ncurves = [1.0, 3.0]\n\
             frequency_range = [\"0.001 rad/s\", \"1 rad/s\"]\nenergy_loss_range = [\"0 J\", \"4e-6 J\"]\nfrequency_unit = \"Hz\"\nwidth = \"0.085 m\"\nheight = \"0.06 m\"\nfont_size = 7.0\n\
             font = \"serif\"\ncolors = \"grey\"\nformats = [\"png\", \"pdf\"]\nsvg_text = \"text\"\ndpi = 600\naxes = \"normalised\"\ntitles = false\n"
        );
    }
}
