//! The `[figures]` block of sweep and scenario files: how figures are to look.

use super::diagnostic::Problems;
use super::document::reader::TableReader;
use super::document::{Located, plain};
use super::keys::settings::{
    AXES, COLUMN, FONT_SIZE_PT, FORMATS, FREQUENCY_UNIT, HEIGHT, LOOPS, RESOLUTION, TITLES, WIDTH,
};
use crate::figures::paper;
use crate::quantity::{Dimension, FrequencyUnit, format_human};
use crate::sweep::plan::figures::{AxisUnits, FigurePlan, Format};

/// Less room than this (in px of the drawing, whose text is 16 px) is no figure; more pixels than this no computer shows.
const LEAST_WIDTH_PX: f64 = 320.0;
const LEAST_HEIGHT_PX: f64 = 240.0;
const MOST_PIXELS: f64 = 16_000.0;

/// Reads the block of a sweep file; `None` where a problem was reported. `frequencies_rad_per_s` are those of the sweep,
/// ascending, given in this unit.
pub(crate) fn of_sweep(
    mut table: TableReader<'_>,
    (frequencies_rad_per_s, given_in): (Option<&[f64]>, FrequencyUnit),
) -> Option<Figures> {
    let loops = loops(&mut table, frequencies_rad_per_s);
    let unit = table.value(&FREQUENCY_UNIT);
    let figures = read(table);
    let (loops_rad_per_s, unit, mut figures) = (loops?, unit?, figures?);
    figures.plan.loops_rad_per_s = loops_rad_per_s;
    figures.plan.frequency_unit = unit.unwrap_or(given_in);
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
pub(crate) fn read(mut table: TableReader<'_>) -> Option<Figures> {
    let problems = table.problems();
    let default = FigurePlan::default();
    let width = match table.has(&WIDTH) && table.has(&COLUMN) {
        true => table.one_of(&[(&WIDTH, ()), (&COLUMN, ())]).map(|()| None),
        false if table.has(&COLUMN) => table.read(&COLUMN),
        false => table.read(&WIDTH),
    };
    let height = table.read(&HEIGHT);
    let font_size_pt = table.value(&FONT_SIZE_PT);
    let formats = table.value(&FORMATS);
    let (dpi, axes) = (table.read(&RESOLUTION), table.read(&AXES));
    let titles = table.value(&TITLES);
    table.finish();
    let (width, height, dpi, axes) = (width?, height?, dpi?, axes?);
    let value = |located: &Option<Located<f64>>| located.as_ref().map(|located| located.value);
    let plan = FigurePlan {
        loops_rad_per_s: Vec::new(),
        width_m: value(&width),
        height_m: value(&height),
        font_size_pt: font_size_pt?,
        formats: formats?.map_or(default.formats, plain),
        dpi: dpi.as_ref().map(|dpi| dpi.value),
        axes: axes.as_ref().map_or(default.axes, |axes| axes.value),
        frequency_unit: default.frequency_unit,
        titles: titles?.unwrap_or(default.titles),
    };
    let fits = fits(&plan, [&width, &height], dpi.as_ref(), problems);
    fits.then_some(Figures { plan, axes })
}

/// Whether a figure of this size has room for its text, and a PNG of it a sensible number of pixels.
fn fits(
    plan: &FigurePlan,
    [width, height]: [&Option<Located<f64>>; 2],
    dpi: Option<&Located<usize>>,
    problems: &Problems,
) -> bool {
    let Some(paper) = paper::paper_size(plan) else {
        return true;
    };
    let height_m = paper.height_m;
    let longest_m = height_m.map_or(paper.width_m, |height_m| height_m.max(paper.width_m));
    let pixels = longest_m / 0.0254 * paper::resolution(plan).unwrap_or_default() as f64;
    let mut fine = true;
    if pixels > MOST_PIXELS && plan.formats.contains(&Format::Png) {
        let most = (MOST_PIXELS * 0.0254 / longest_m).floor();
        let message = format!("a PNG would be {pixels:.0} pixels long");
        let help = format!("at this size write a `dpi` of at most {most}");
        if let Some(dpi) = dpi {
            problems.at(dpi, message).because("too many").help(help);
        } else if let Some(side) = width.as_ref().or(height.as_ref()) {
            problems.at(side, message).because("too large").help(help);
        }
        fine = false;
    }
    let sides = [
        (width, Some(paper.width_m), LEAST_WIDTH_PX),
        (height, height_m, LEAST_HEIGHT_PX),
    ];
    for (side, length_m, least_px) in sides {
        let least_m = least_px * paper.px_m;
        let is_small = length_m.is_some_and(|length_m| length_m < least_m);
        if let Some(side) = side.as_ref().filter(|_| is_small) {
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

/// The frequencies (rad/s) whose loops are drawn, each within the sweep.
fn loops(table: &mut TableReader<'_>, frequencies_rad_per_s: Option<&[f64]>) -> Option<Vec<f64>> {
    let Some(list) = table.read(&LOOPS)? else {
        return Some(Vec::new());
    };
    // Where the frequencies are wrong, that has been reported.
    let ends = frequencies_rad_per_s.and_then(|all| Some((*all.first()?, *all.last()?)));
    let (first, last) = ends?;
    let mut fine = true;
    // Ends that are written are met; those of frequencies in Hz, to rounding.
    let within = (first * (1.0 - 1e-9))..=(last * (1.0 + 1e-9));
    for loop_ in list.value.iter().filter(|w| !within.contains(&w.value)) {
        let human = |omega| format_human(omega, Dimension::AngularFrequency, 4);
        (table.problems())
            .at(loop_, "this frequency is outside the sweep")
            .because(format!(
                "the sweep runs from {} to {}",
                human(first),
                human(last)
            ))
            .help("choose one within it, or widen the sweep");
        fine = false;
    }
    fine.then(|| plain(list.value))
}
