//! The page of a comparison: the verdict, both curves and their difference, columns, peaks, cases, where both come from.

use maud::{Markup, Render, html};
use serde::Serialize;

use super::compact::rounded;
use super::frame::{Frame, Input, PLOT};
use super::pictures::Pictures;
use super::question::list;
use super::sweep_data::FrequencyData;
use super::{copying, scroll, section};
use crate::quantity::{Dimension, FrequencyUnit};
use crate::report::ReportError;
use crate::report::comparison::text::peak_words;
use crate::report::comparison::{
    ColumnComparison, Comparison, Place, Source, SweepTable, Tolerances,
};
use crate::report::number::{at_frequency, cell, scientific, with_error};
use crate::report::quantities::{self, Compared::Absolutely};
use crate::sweep::search::peak::Peak;
use crate::sweep::store::difference;

const SCRIPT: &str = include_str!("comparison.js");
/// Columns named beside the verdict, lines by which two questions differ, and cases of a list, that are shown.
const COLUMNS: usize = 3;
const LINES: usize = 40;
const CASES: usize = 100;

/// What is known of a comparison.
pub struct Compared<'a> {
    pub comparison: &'a Comparison,
    pub tolerances: &'a Tolerances,
    pub baseline: &'a SweepTable,
    pub new: &'a SweepTable,
    /// Of baseline and new result.
    pub sources: [&'a Source; 2],
    /// The figures that have gone by.
    pub pictures: &'a Pictures,
}

#[derive(Serialize)]
struct Data<'a> {
    kind: &'static str,
    /// `comparison.csv`.
    csv: &'a str,
    frequency: FrequencyData,
    /// In the unit of [`Data::frequency`].
    frequencies: Vec<f64>,
    /// In words, case by case.
    drives: Vec<String>,
    columns: Vec<ColumnData<'a>>,
}

#[derive(Serialize)]
struct ColumnData<'a> {
    name: &'a str,
    heading: String,
    unit: &'static str,
    /// From SI to the unit.
    factor: f64,
    /// Whether values are relative already, so that their differences are.
    is_relative: bool,
    baseline: &'a [Option<f64>],
    new: &'a [Option<f64>],
    error: Vec<Option<f64>>,
}

/// The page.
///
/// # Errors
/// [`ReportError`] naming the part that could not be made.
pub fn page(compared: &Compared<'_>) -> Result<String, ReportError> {
    let [old, new] = compared.sources;
    let named = [("baseline/resolved.toml", old), ("new/resolved.toml", new)];
    let files = named.into_iter();
    let files = files.filter_map(|(name, source)| Some((name, source.resolved.as_deref()?)));
    let hashes = [("the baseline", old), ("the new result", new)].into_iter();
    let hashes = hashes.filter_map(|(what, s)| Some((what, s.run.sweep_hash.clone()?)));
    let frame = Frame {
        title: "Comparison of two results",
        asked: format!("Baseline {}, new {}", old.name, new.name),
        main: sections(compared),
        input: Input {
            hashes: hashes.collect(),
            files: files.collect(),
            text: "The sweep files of both results, with every default written out. \
                   <code>contact-dma sweep resolved.toml</code> gives each again.",
        },
        script: &[PLOT, SCRIPT],
    };
    let csv = compared.comparison.table();
    frame.page(&data(compared, &String::from_utf8_lossy(&csv)))
}

fn sections(compared: &Compared<'_>) -> Markup {
    let comparison = compared.comparison;
    let [old, new] = compared.sources;
    html! {
        section aria-labelledby="answer" class="answer" {
            h2 id="answer" { "Whether they are the same" }
            p class="peaks" { strong { (comparison.verdict()) } }
            (reasons(comparison))
            p class="asked" { (tolerances(compared.tolerances)) }
        }
        (curves(comparison.unit, compared.pictures))
        (compared.pictures.gallery(&["comparison"]))
        (section("columns-heading", "Column by column", html! {
            (scroll("Columns", columns(comparison)))
            (copying("Copy the curve as CSV", "Download comparison.csv"))
        }))
        (section("peaks-heading", "Peaks", peaks(comparison)))
        (section("cases-heading", "Cases", cases(comparison)))
        (section("sources-heading", "Where both come from", html! {
            (scroll("Sources", sources(compared)))
            (asked(old, new))
        }))
    }
}

fn curves(unit: FrequencyUnit, pictures: &Pictures) -> Markup {
    let content = html! {
        div class="live controls" role="group" aria-label="Curves" {
            label { "Curve of " select id="quantity" {} }
            label id="drive-choice" hidden { "drive " select id="drive" {} }
            label { input type="checkbox" id="log-x" checked; " log " (unit.symbol()) }
            label { input type="checkbox" id="log-y"; " log values" }
        }
        div id="curve" class="live plot tall" {}
        div id="difference" class="live plot" {}
        p class="live hint" id="bars" {}
        (pictures.still("comparison", "No case has a loss in both results: there is nothing to draw."))
    };
    section(
        "curves-heading",
        "Both curves, and their difference",
        content,
    )
}

fn data<'a>(compared: &Compared<'a>, csv: &'a str) -> Data<'a> {
    let comparison = compared.comparison;
    let unit = comparison.unit;
    let places = || comparison.curve.iter().map(|point| &point.place);
    let frequencies = places().map(|p| unit.of(p.angular_frequency_rad_per_s));
    let drives = places().map(|place| {
        let varied = comparison.varied_words(place, "");
        format!("{varied}{} ± {}", place.drive_mean, place.drive_amplitude)
    });
    Data {
        kind: "comparison",
        csv,
        frequency: FrequencyData::of(unit),
        frequencies: frequencies.collect(),
        drives: drives.collect(),
        columns: comparison.columns.iter().map(ColumnData::of).collect(),
    }
}

impl<'a> ColumnData<'a> {
    fn of(column: &'a ColumnComparison) -> Self {
        let known = quantities::of_name(&column.name);
        // A branch, and what another version wrote, by its name.
        let heading = known.filter(|known| known.name == column.name);
        let (unit, factor) = known.map_or(("", 1.0), |known| known.unit());
        Self {
            name: &column.name,
            heading: (heading.map_or(&column.name[..], |known| known.heading)).replace('_', " "),
            unit,
            factor,
            is_relative: known.is_some_and(|c| c.compared == Some(Absolutely)),
            baseline: &column.baseline,
            new: &column.new,
            error: column.error.iter().map(|e| e.map(rounded)).collect(),
        }
    }
}

/// What makes the results differ; nothing where they do not.
fn reasons(comparison: &Comparison) -> Markup {
    let mut lines = Vec::new();
    for (n, what) in [
        (comparison.missing.len(), "missing in the new result"),
        (comparison.added.len(), "only in the new result"),
        (comparison.statuses.len(), "of another status"),
    ] {
        match n {
            0 => {}
            1 => lines.push(format!("1 case is {what}")),
            n => lines.push(format!("{n} cases are {what}")),
        }
    }
    if !comparison.missing_columns.is_empty() {
        let names = comparison.missing_columns.join(", ");
        lines.push(format!("columns missing in the new result: {names}"));
    }
    let different = comparison.columns.iter().filter(|c| c.different > 0);
    for column in different.clone().take(COLUMNS) {
        let largest = column.largest.map(|(share, place)| {
            let at = at_frequency(comparison.unit, place.angular_frequency_rad_per_s, 4);
            let share = scientific(share, 2);
            format!(", at most by {share} (relative) at {at}")
        });
        lines.push(format!(
            "{} differs in {} of {} cases{}",
            column.name,
            column.different,
            comparison.compared,
            largest.unwrap_or_default()
        ));
    }
    match different.count().saturating_sub(COLUMNS) {
        0 => {}
        more => lines.push(format!("{more} more columns differ: see below")),
    }
    if let Some(reason) = &comparison.peaks_not_compared {
        lines.push(format!("peaks are not compared: {reason}"));
    }
    let peaks = comparison.peaks.iter().filter(|peak| peak.differs);
    lines.extend(peaks.map(|peak| peak_words(comparison.unit, peak)));
    if lines.is_empty() {
        return html! { p { (comparison.compared) " cases are in both." } };
    }
    html! { div class="problems" { (list(&lines)) } }
}

fn tolerances(tolerances: &Tolerances) -> String {
    let own: String = tolerances
        .columns
        .iter()
        .map(|(column, relative)| format!("; {column} {}", scientific(*relative, 3)))
        .collect();
    if let Some(relative) = tolerances.peaks {
        return format!(
            "The peaks decide: their frequencies and losses may differ by {} (relative){own}.",
            scientific(relative, 3)
        );
    }
    format!(
        "Values may differ by {} (relative to the larger) plus {} (absolute, in SI units){own}. Values that were solved on \
         different steps or nodes may also differ by the sum of their error bars.",
        scientific(tolerances.relative, 3),
        scientific(tolerances.absolute, 3)
    )
}

fn columns(comparison: &Comparison) -> Markup {
    let unit = comparison.unit;
    let at = format!("!at {} / {}", unit.symbol(), unit.name());
    let headings = [
        "column",
        "!largest difference, relative to the larger",
        &at,
        "!cases beyond the tolerance",
        "!of these within error bars",
        "!without a value in one",
        "finding",
    ];
    let rows = comparison.columns.iter().map(|column| {
        let share = column.largest.map(|(share, _)| scientific(share, 2));
        let place = column.largest.map(|(_, place)| place);
        let found = match column.different {
            _ if comparison.compared == 0 => html! { "not compared" },
            different => finding(different > 0),
        };
        vec![
            column.name.render(),
            share.as_deref().unwrap_or("none").render(),
            cell(place.map(|place| unit.of(place.angular_frequency_rad_per_s))).render(),
            column.beyond.render(),
            column.within_bars.render(),
            column.absent.render(),
            found,
        ]
    });
    table(&headings, rows)
}

fn finding(differs: bool) -> Markup {
    match differs {
        true => html! { strong { "differs" } },
        false => html! { "the same" },
    }
}

/// A table whose rows begin with their names; headings of numbers begin with `!`.
fn table(headings: &[&str], rows: impl Iterator<Item = Vec<Markup>>) -> Markup {
    let columns = || {
        headings
            .iter()
            .map(|heading| (heading.strip_prefix('!'), heading))
    };
    html! {
        table class="tight" {
            thead {
                tr {
                    @for (number, heading) in columns() {
                        @if let Some(number) = number { th scope="col" { (number) } }
                        @else { th scope="col" class="text" { (heading) } }
                    }
                }
            }
            tbody {
                @for row in rows {
                    tr {
                        @for (k, ((number, _), cell)) in columns().zip(row).enumerate() {
                            @if k == 0 { th scope="row" { (cell) } }
                            @else if number.is_some() { td { (cell) } }
                            @else { td class="text" { (cell) } }
                        }
                    }
                }
            }
        }
    }
}

fn peaks(comparison: &Comparison) -> Markup {
    let (unit, peaks) = (comparison.unit, &comparison.peaks);
    if let Some(reason) = &comparison.peaks_not_compared {
        return html! { p { "Not compared: " (reason) "." } };
    }
    let symbol = unit.symbol();
    let headings = [
        &format!("baseline, at {symbol}"),
        &format!("new, at {symbol}"),
        "!moved by / %",
        "baseline, loss",
        "new, loss",
        "!changed by / %",
        "finding",
    ];
    let omega = |peak: &Peak| {
        with_error(
            unit.of(peak.angular_frequency_rad_per_s),
            Some(unit.of(peak.angular_frequency_uncertainty_rad_per_s)),
            unit.dimension(),
        )
    };
    let loss = |peak: &Peak| {
        let error = peak.energy_loss_error_j;
        with_error(peak.energy_loss_j, error, Dimension::Energy)
    };
    let rows = peaks.iter().map(|pair| {
        let text = |peak: &Option<Peak>, of: &dyn Fn(&Peak) -> String| {
            peak.as_ref().map_or("none".to_owned(), of)
        };
        let percent = |of: fn(&Peak) -> f64| {
            let both = pair.baseline.as_ref().zip(pair.new.as_ref());
            both.map_or("–".to_owned(), |(a, b)| {
                scientific(100.0 * (of(b) / of(a) - 1.0), 2)
            })
        };
        vec![
            text(&pair.baseline, &omega).render(),
            text(&pair.new, &omega).render(),
            percent(|peak| peak.angular_frequency_rad_per_s).render(),
            text(&pair.baseline, &loss).render(),
            text(&pair.new, &loss).render(),
            percent(|peak| peak.energy_loss_j).render(),
            finding(pair.differs),
        ]
    });
    scroll("Peaks", table(&headings, rows))
}

fn cases(comparison: &Comparison) -> Markup {
    let words = |places: &[Place]| places.iter().map(|place| comparison.words(place)).collect();
    let statuses = comparison.statuses.iter();
    let statuses =
        statuses.map(|(place, a, b)| format!("{}: {a} before, {b} now", comparison.words(place)));
    let lists: [(&str, Vec<String>); 5] = [
        ("Missing in the new result", words(&comparison.missing)),
        ("Only in the new result", words(&comparison.added)),
        ("Of another status", statuses.collect()),
        (
            "Columns missing in the new result",
            comparison.missing_columns.clone(),
        ),
        (
            "Columns only in the new result",
            comparison.added_columns.clone(),
        ),
    ];
    html! {
        p { (comparison.compared) " cases are in both results." }
        @for (what, lines) in lists {
            @if !lines.is_empty() {
                @let more = lines.len().checked_sub(CASES).filter(|more| *more > 0);
                @let more = more.map(|more| format!("and {more} more"));
                h3 { (what) ": " (lines.len()) } (list(lines.into_iter().take(CASES).chain(more)))
            }
        }
    }
}

fn sources(compared: &Compared<'_>) -> Markup {
    let unknown = || "not told".to_owned();
    let of = |fact: fn(&Source) -> Option<String>| {
        (compared.sources).map(|source| fact(source).unwrap_or_else(unknown))
    };
    let tables = [compared.baseline, compared.new];
    let range = |column: &str| {
        tables.map(|table| match table.resolution(column) {
            None => unknown(),
            Some((low, high)) if low == high => format!("{low}"),
            Some((low, high)) => format!("{low} to {high}"),
        })
    };
    let rows = [
        ("result", of(|s| Some(s.name.clone()))),
        (
            "program",
            of(|s| Some(format!("contact-dma {}", s.run.program_version.as_ref()?))),
        ),
        ("commit", of(|s| s.run.commit.clone())),
        ("hash of the sweep", of(|s| s.run.sweep_hash.clone())),
        ("engine", of(|s| s.run.engine.clone())),
        (
            "tolerance of the cycle",
            of(|s| Some(format!("{:e}", s.run.cycle_tolerance?))),
        ),
        (
            "tolerance of an instant",
            of(|s| Some(format!("{:e}", s.run.solver_tolerance?))),
        ),
        ("cases", tables.map(|table| table.cases().to_string())),
        ("time steps per cycle", range("steps")),
        ("springs, or cells per side", range("nodes")),
    ];
    html! {
        table class="tight" {
            thead {
                tr {
                    td class="text" {}
                    th scope="col" class="text" { "baseline" }
                    th scope="col" class="text" { "new" }
                }
            }
            tbody {
                @for (name, values) in rows {
                    tr {
                        th scope="row" { (name) }
                        @for value in values { td class="text wide" { (value) } }
                    }
                }
            }
        }
    }
}

/// Whether both were asked the same.
fn asked(old: &Source, new: &Source) -> Markup {
    let (Some(old), Some(new)) = (&old.resolved, &new.resolved) else {
        return html! {
            p { "What was asked cannot be compared: one of the two has no resolved.toml." }
        };
    };
    if old == new {
        return html! { p { "Both were asked the same, to the last letter." } };
    }
    html! {
        h3 { "Lines in which the questions differ: − baseline, + new" }
        pre tabindex="0" aria-label="Lines in which the questions differ" {
            code { (difference::lines(old, new, LINES)) }
        }
    }
}
