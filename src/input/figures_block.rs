//! The `[figures]` block of sweep and scenario files: how figures are to look.

use std::path::Path;
use std::sync::Arc;

use super::data_file;
use super::diagnostic::{Location, Problems};
use super::document::reader::TableReader;
use super::document::{Located, block};
#[cfg(feature = "report")]
use crate::figures::font::{Font, FontBytes};
use crate::figures::paper;
use crate::quantity::block::{Block, Reported, Source};
use crate::quantity::key::{Key, alternatives};
use crate::quantity::rows::{List, Others, Rows};
use crate::quantity::setting::Value;
use crate::quantity::{Dimension, FrequencyUnit, format_human};
use crate::sweep::plan::figures::{AxisUnits, FigurePlan, FontChoice, Format};

/// The keys of figures of a sweep, of which the first are of no use to a history.
const KEYS: &[Key] = FigurePlan::KEYS;
const OF_FREQUENCIES: usize = 5;

pub(super) static OF_SWEEP: Rows = of_keys(&[KEYS]);
pub(super) static OF_SCENARIO: Rows = of_keys(&[KEYS.split_at(OF_FREQUENCIES).1]);

const fn of_keys(keys: List) -> Rows {
    Rows {
        means: FigurePlan::MEANS,
        keys,
        others: Others::AtMostOne(&["width", "column"]),
    }
}

/// Less room than this (in px of the drawing, whose text is 16 px) is no figure; more pixels than this no computer shows.
const LEAST_WIDTH_PX: f64 = 225.0;
const LEAST_HEIGHT_PX: f64 = 240.0;
const MOST_PIXELS: f64 = 16_000.0;

/// What the block holds.
#[derive(Clone, Default)]
pub(crate) struct Figures {
    pub(crate) plan: FigurePlan,
    axes: Option<Location>,
}

/// Reads the block of a sweep file; `None` where a problem was reported. `frequencies_rad_per_s` are those of the sweep,
/// ascending, given in this unit.
pub(crate) fn of_sweep(
    mut table: TableReader<'_>,
    (frequencies_rad_per_s, given_in): (Option<&[f64]>, FrequencyUnit),
) -> Option<Figures> {
    let plan = block::read_from(&mut table, Some(&Figures::of_unit(given_in).plan));
    let loops = plan
        .as_ref()
        .map_or(&[][..], |plan: &FigurePlan| &plan.loops_rad_per_s);
    let loops = check_loops(&mut table, loops, frequencies_rad_per_s);
    checked(table, plan).filter(|_| loops.is_some())
}

/// Reads the block of a scenario file; `None` where a problem was reported.
pub(crate) fn read(table: TableReader<'_>) -> Option<Figures> {
    let mut table = OfScenario(table);
    let plan = FigurePlan::read(&mut table, None);
    checked(table.0, plan)
}

/// A block that has no keys of frequencies.
struct OfScenario<'a>(TableReader<'a>);

impl Source for OfScenario<'_> {
    fn value(&mut self, key: &'static Key) -> Result<Option<Value>, Reported> {
        match KEYS[..OF_FREQUENCIES].iter().any(|other| other.is(key)) {
            true => Ok(None),
            false => Source::value(&mut self.0, key),
        }
    }

    fn report_absent(&mut self, key: &'static Key) {
        self.0.report_absent(key);
    }
}

impl Figures {
    /// Those of a sweep without the block, whose frequencies are given in this unit.
    pub(crate) fn of_unit(frequency_unit: FrequencyUnit) -> Self {
        let plan = FigurePlan {
            frequency_unit,
            ..FigurePlan::DEFAULT
        };
        Self { plan, axes: None }
    }

    /// Refuses normalised axes where there is nothing to normalise by.
    pub(crate) fn checked<E: std::fmt::Display>(
        self,
        scale: impl FnOnce() -> Result<(), E>,
        problems: &Problems,
    ) -> Option<FigurePlan> {
        if let (AxisUnits::Normalised, Some(axes)) = (self.plan.axes, self.axes)
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

/// What was read of the block, where the size of the figures is right; all keys were asked for.
fn checked(mut table: TableReader<'_>, plan: Option<FigurePlan>) -> Option<Figures> {
    let problems = table.problems();
    let widths = KEYS.iter().rev();
    let widths = widths.filter(|key| ["width", "column"].contains(&key.name));
    let widths: Vec<(&Key, ())> = widths.map(|key| (key, ())).collect();
    let is_one = !widths.iter().all(|(key, ())| table.has(key)) || table.one_of(&widths).is_some();
    let [width, column, height] = ["width", "column", "height"].map(|key| table.value_place(key));
    let [frequency_range, energy_loss_range] =
        ["frequency_range", "energy_loss_range"].map(|key| table.value_place(key));
    let [dpi, axes, font] = ["dpi", "axes", "font"].map(|key| table.value_place(key));
    let folder = table.folder();
    table.finish();
    let mut plan = plan.filter(|_| is_one)?;
    if let (FontChoice::File { path, .. }, Some(location)) = (&plan.font, font) {
        let file = Located {
            value: path.clone(),
            path: format!("{}.font", FigurePlan::NAME),
            location,
        };
        plan.font = font_of_file(&file, folder, problems)?;
    }
    // A resolved file has the width that it is.
    if let Some(column) = plan.column.take() {
        plan.width_m = Some(column.width_m());
    }
    let ranges = [
        (
            "frequency_range",
            &plan.frequency_range_rad_per_s,
            frequency_range,
        ),
        (
            "energy_loss_range",
            &plan.energy_loss_range_j,
            energy_loss_range,
        ),
    ];
    let mut is_fine = true;
    for (key, range, place) in ranges {
        let (is_reversed, location) = (range.is_sorted_by(|a, b| a >= b), place);
        if let Some(location) = location.filter(|_| is_reversed) {
            problems
                .at(
                    &location,
                    format!("`{key}` has its ends the wrong way round"),
                )
                .help("write the lower end first");
            is_fine = false;
        }
    }
    let sides = [width.or(column), height];
    is_fine.then_some(())?;
    fits(&plan, &sides, dpi.as_ref(), problems).then_some(Figures { plan, axes })
}

/// The font of a file, whose path is kept from the root; `None` where a problem was reported.
fn font_of_file(file: &Located<String>, folder: &Path, problems: &Problems) -> Option<FontChoice> {
    let words = alternatives(&FontChoice::WORDS);
    let help = format!("write {words}, or the path of a .ttf or .otf file");
    let ending = Path::new(&file.value).extension().unwrap_or_default();
    if !["ttf", "otf"]
        .iter()
        .any(|known| ending.eq_ignore_ascii_case(known))
    {
        problems
            .at(file, "there is no such typeface of figures")
            .help(&*help);
        return None;
    }
    let (name, bytes) = data_file::named(file, folder, problems)?;
    let bytes = Arc::new(bytes);
    #[cfg(feature = "report")]
    if let Err(error) = Font::new(Arc::clone(&bytes) as FontBytes) {
        let message = format!("figures cannot be set in `{name}`: {error}");
        problems.at(file, message).help(help);
        return None;
    }
    let Some(path) = file.absolute_from(folder) else {
        let message = format!("the path of `{name}` is not UTF-8, and cannot be written down");
        problems.at(file, message).help("rename the folder");
        return None;
    };
    Some(FontChoice::File { path, bytes })
}

/// Whether a figure of this size has room for its text, and a PNG of it a sensible number of pixels.
fn fits(
    plan: &FigurePlan,
    [width, height]: &[Option<Location>; 2],
    dpi: Option<&Location>,
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

/// Whether the frequencies (rad/s) whose loops are drawn are within the sweep.
fn check_loops(
    table: &mut TableReader<'_>,
    loops_rad_per_s: &[f64],
    frequencies_rad_per_s: Option<&[f64]>,
) -> Option<()> {
    if loops_rad_per_s.is_empty() {
        return Some(());
    }
    // Where the frequencies are wrong, that has been reported.
    let ends = frequencies_rad_per_s.and_then(|all| Some((*all.first()?, *all.last()?)));
    let (first, last) = ends?;
    let mut fine = true;
    // Ends that are written are met; those of frequencies in Hz, to rounding.
    let within = (first * (1.0 - 1e-9))..=(last * (1.0 + 1e-9));
    let places = table.places_in("loops");
    let placed = loops_rad_per_s.iter().zip(&places);
    for (_, place) in placed.filter(|(omega, _)| !within.contains(*omega)) {
        let human = |omega| format_human(omega, Dimension::AngularFrequency, 4);
        (table.problems())
            .at(place, "this frequency is outside the sweep")
            .because(format!(
                "the sweep runs from {} to {}",
                human(first),
                human(last)
            ))
            .help("choose one within it, or widen the sweep");
        fine = false;
    }
    fine.then_some(())
}
