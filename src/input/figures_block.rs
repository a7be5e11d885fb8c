//! The `[figures]` block of sweep and scenario files: how figures are to look.

use super::diagnostic::Problems;
use super::document::{Located, TableReader};
use crate::quantity::{Dimension, FrequencyUnit, format_human};
use crate::sweep::figures::figure_plan::{AxisUnits, COLUMNS, FigurePlan, Format};

/// Sides (m), text (pt) and resolutions beyond these are a slip of the pen rather than a wish.
const SIDE_M: std::ops::RangeInclusive<f64> = 0.02..=1.0;
const FONT_SIZE_PT: std::ops::RangeInclusive<f64> = 4.0..=36.0;
const DPI: std::ops::RangeInclusive<usize> = 30..=2400;
/// Less room than this (in px of the drawing, whose text is 16 px) is no figure; more pixels than this no computer shows.
const LEAST_WIDTH_PX: f64 = 320.0;
const LEAST_HEIGHT_PX: f64 = 240.0;
const MOST_PIXELS: f64 = 16_000.0;
/// More loops than this cannot be told apart.
const MOST_LOOPS: usize = 8;

/// Reads the block of a sweep file; `None` where a problem was reported. `frequencies_rad_per_s` are those of the sweep,
/// ascending, given in this unit.
pub(crate) fn of_sweep(
    mut table: TableReader<'_>,
    (frequencies_rad_per_s, given_in): (Option<&[f64]>, FrequencyUnit),
    problems: &Problems,
) -> Option<Figures> {
    let loops = loops(&mut table, frequencies_rad_per_s, problems);
    let unit = table.choice_of_or("frequency_unit", &FrequencyUnit::NAMES, given_in);
    let figures = read(table, problems);
    let (loops_rad_per_s, unit, mut figures) = (loops?, unit?, figures?);
    figures.plan.loops_rad_per_s = loops_rad_per_s;
    figures.plan.frequency_unit = unit.value;
    Some(figures)
}

/// What the block holds.
#[derive(Clone, Default)]
pub(crate) struct Figures {
    pub(crate) plan: FigurePlan,
    axes: Option<Located<AxisUnits>>,
}

impl Figures {
    /// Those of a sweep without the block, whose frequencies are given in this unit.
    pub(crate) fn of_unit(frequency_unit: FrequencyUnit) -> Self {
        let mut figures = Self::default();
        figures.plan.frequency_unit = frequency_unit;
        figures
    }

    /// Refuses normalised axes where there is nothing to normalise by.
    pub(crate) fn checked<E: std::fmt::Display>(
        self,
        scale: impl FnOnce() -> Result<(), E>,
        problems: &Problems,
    ) -> Option<FigurePlan> {
        if let Some(axes) = self.axes.filter(|axes| axes.value == AxisUnits::Normalised)
            && let Err(why) = scale()
        {
            problems
                .at(&axes, "these figures cannot be normalised")
                .because(why.to_string())
                .help("write `axes = \"si\"`, or leave it out");
            return None;
        }
        Some(self.plan)
    }
}

/// Reads the keys that sweeps and scenarios share; `None` where a problem was reported.
pub(crate) fn read(mut table: TableReader<'_>, problems: &Problems) -> Option<Figures> {
    let default = FigurePlan::default();
    let width = width(&mut table, problems);
    let height = side(&mut table, "height", problems);
    let font_size = font_size(&mut table, problems);
    let formats = formats(&mut table, problems);
    let dpi = match table.has("dpi") {
        true => table.optional_positive_integer("dpi", DPI).map(Some),
        false => Some(None),
    };
    let axes = match table.has("axes") {
        true => table.choice_of("axes", &AxisUnits::NAMES).map(Some),
        false => Some(None),
    };
    let titles = table.boolean_or("titles", default.titles);
    table.finish();
    let (width, height, font_size, dpi, axes) = (width?, height?, font_size?, dpi?, axes?);
    let value = |located: &Option<Located<f64>>| located.as_ref().map(|located| located.value);
    let plan = FigurePlan {
        loops_rad_per_s: Vec::new(),
        width_m: value(&width),
        height_m: value(&height),
        font_size_pt: value(&font_size),
        formats: formats?,
        dpi: dpi.as_ref().map(|dpi| dpi.value),
        axes: axes.as_ref().map_or(default.axes, |axes| axes.value),
        frequency_unit: default.frequency_unit,
        titles: titles?.value,
    };
    let asked = Asked { width, height, dpi };
    asked
        .fits(&plan, problems)
        .then_some(Figures { plan, axes })
}

/// What a problem with the size can point at.
struct Asked {
    width: Option<Located<f64>>,
    height: Option<Located<f64>>,
    dpi: Option<Located<usize>>,
}

impl Asked {
    /// Whether a figure of this size has room for its text, and a PNG of it a sensible number of pixels.
    fn fits(&self, plan: &FigurePlan, problems: &Problems) -> bool {
        let Some(paper) = plan.paper() else {
            return true;
        };
        let longest_m = paper
            .height_m
            .map_or(paper.width_m, |height_m| height_m.max(paper.width_m));
        let dpi = plan.resolution().unwrap_or_default();
        let pixels = longest_m / 0.0254 * dpi as f64;
        let mut fine = true;
        if pixels > MOST_PIXELS && plan.formats.contains(&Format::Png) {
            let most = (MOST_PIXELS * 0.0254 / longest_m).floor();
            let message = format!("a PNG would be {pixels:.0} pixels long");
            let help = format!("at this size write a `dpi` of at most {most}");
            if let Some(dpi) = &self.dpi {
                problems.at(dpi, message).because("too many").help(help);
            } else if let Some(side) = self.width.as_ref().or(self.height.as_ref()) {
                problems.at(side, message).because("too large").help(help);
            }
            fine = false;
        }
        let sides = [
            (&self.width, paper.width_m, LEAST_WIDTH_PX),
            (
                &self.height,
                paper.height_m.unwrap_or(f64::INFINITY),
                LEAST_HEIGHT_PX,
            ),
        ];
        for (side, length_m, least_px) in sides {
            let least_m = least_px * paper.px_m;
            if let Some(side) = side.as_ref().filter(|_| length_m < least_m) {
                let least = format!("{:.0} mm", (1e3 * least_m).ceil());
                problems
                    .at(side, "a figure of this size has no room for its text")
                    .because(format!("with this text it takes {least}"))
                    .help(format!(
                        "write at least \"{least}\", or a smaller `font_size`"
                    ));
                fine = false;
            }
        }
        fine
    }
}

/// The width: a length, or that of a journal's columns.
fn width(table: &mut TableReader<'_>, problems: &Problems) -> Option<Option<Located<f64>>> {
    if table.has("column") && table.has("width") {
        table.one_of(&[("width", ()), ("column", ())])?;
    }
    if table.has("column") {
        return table.choice_of("column", &COLUMNS).map(Some);
    }
    side(table, "width", problems)
}

fn side(
    table: &mut TableReader<'_>,
    key: &str,
    problems: &Problems,
) -> Option<Option<Located<f64>>> {
    if !table.has(key) {
        return Some(None);
    }
    let side = table.optional_quantity(key, Dimension::Length)?;
    if SIDE_M.contains(&side.value) {
        return Some(Some(side));
    }
    problems
        .at(
            &side,
            format!("the {key} of a figure lies between 20 mm and 1 m"),
        )
        .help(format!("a figure one column wide has `{key} = \"85 mm\"`"));
    None
}

fn font_size(table: &mut TableReader<'_>, problems: &Problems) -> Option<Option<Located<f64>>> {
    if !table.has("font_size") {
        return Some(None);
    }
    let size = table.optional_number("font_size")?;
    if FONT_SIZE_PT.contains(&size.value) {
        return Some(Some(size));
    }
    problems
        .at(&size, "the text of a figure has 4 to 36 pt")
        .help("write a number of points without a unit, such as `font_size = 8`");
    None
}

fn formats(table: &mut TableReader<'_>, problems: &Problems) -> Option<Vec<Format>> {
    if !table.has("formats") {
        return Some(FigurePlan::default().formats);
    }
    let list = table.choices_of("formats", &Format::NAMES)?;
    if list.value.is_empty() {
        problems
            .at(&list, "figures in no format are none")
            .help("write `formats = [\"svg\", \"png\"]`, or leave it out");
        return None;
    }
    let mut formats: Vec<Format> = Vec::new();
    for format in list.value {
        if formats.contains(&format.value) {
            problems
                .at(&format, "this format is listed twice")
                .help("write every format once, as in `formats = [\"svg\", \"png\"]`");
            return None;
        }
        formats.push(format.value);
    }
    Some(formats)
}

/// The frequencies (rad/s) whose loops are drawn, each within the sweep.
fn loops(
    table: &mut TableReader<'_>,
    frequencies_rad_per_s: Option<&[f64]>,
    problems: &Problems,
) -> Option<Vec<f64>> {
    if !table.has("loops") {
        return Some(Vec::new());
    }
    let list = table.optional_quantities("loops", Dimension::AngularFrequency)?;
    if list.value.is_empty() || list.value.len() > MOST_LOOPS {
        problems
            .at(&list, format!("a figure shows 1 to {MOST_LOOPS} loops"))
            .help("write `loops = [\"0.01 rad/s\"]`, or leave it out: then some are chosen");
        return None;
    }
    // Where the frequencies are wrong, that has been reported.
    let ends = frequencies_rad_per_s.and_then(|all| Some((*all.first()?, *all.last()?)));
    let (first, last) = ends?;
    let mut fine = true;
    // Ends that are written are met; those of frequencies in Hz, to rounding.
    let within = (first * (1.0 - 1e-9))..=(last * (1.0 + 1e-9));
    for loop_ in list.value.iter().filter(|w| !within.contains(&w.value)) {
        let human = |omega| format_human(omega, Dimension::AngularFrequency, 4);
        problems
            .at(loop_, "this frequency is outside the sweep")
            .because(format!(
                "the sweep runs from {} to {}",
                human(first),
                human(last)
            ))
            .help("choose one within it, or widen the sweep");
        fine = false;
    }
    fine.then(|| list.value.into_iter().map(|w| w.value).collect())
}
