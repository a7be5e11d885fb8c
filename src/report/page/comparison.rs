//! The page of a comparison: the verdict, both curves and their difference, columns, peaks, cases, where both come from.

use maud::{Markup, html};
use serde::Serialize;

use super::compact::rounded;
use super::frame::{Frame, Input, InputFile, PLOT};
use super::html::json_for_script;
use super::pictures::Pictures;
use super::question::list;
use super::sweep_data::FrequencyData;
use super::{copying, still};
use crate::quantity::{Dimension, FrequencyUnit};
use crate::report::ReportError;
use crate::report::comparison::text::peak_words;
use crate::report::comparison::{
    Column, ColumnComparison, Comparison, PeakComparison, Place, Source, SweepTable, Tolerances,
};
use crate::report::number::{at_frequency, cell, scientific, with_error};
use crate::report::quantities;
use crate::report::table::Cell;
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
    /// The columns to be drawn.
    pub columns: &'a [Column],
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
    let Compared {
        comparison,
        sources: [old, new],
        ..
    } = compared;
    let csv = comparison.table();
    let named = [("baseline/resolved.toml", old), ("new/resolved.toml", new)];
    let files = named.iter().filter_map(|(name, source)| {
        let text = source.resolved.as_deref()?;
        Some(InputFile { name, text })
    });
    let hashes = [("the baseline", old), ("the new result", new)];
    let hashes = hashes
        .iter()
        .filter_map(|(what, source)| Some((*what, source.run.sweep_hash.clone()?)));
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
        data: json_for_script(&data(compared, &String::from_utf8_lossy(&csv)))?,
        script: &[PLOT, SCRIPT],
    };
    Ok(frame.page())
}

fn sections(compared: &Compared<'_>) -> Markup {
    let Compared {
        comparison,
        sources: [old, new],
        ..
    } = compared;
    let verdict = match comparison.differs() {
        true => "The results differ.",
        false => "The results are the same within the tolerances.",
    };
    html! {
        section aria-labelledby="answer" class="answer" {
            h2 id="answer" { "Whether they are the same" }
            p class="peaks" { strong { (verdict) } }
            (reasons(comparison))
            p class="asked" { (tolerances(compared.tolerances)) }
        }
        (curves(comparison.unit, compared.pictures))
        section aria-labelledby="columns-heading" {
            h2 id="columns-heading" { "Column by column" }
            section class="scroll" tabindex="0" aria-label="Columns, may be scrolled" {
                (columns(comparison))
            }
            (copying("Copy the curve as CSV", "Download comparison.csv"))
        }
        section aria-labelledby="peaks-heading" {
            h2 id="peaks-heading" { "Peaks" }
            (peaks(comparison.unit, &comparison.peaks))
        }
        section aria-labelledby="cases-heading" {
            h2 id="cases-heading" { "Cases" }
            (cases(comparison))
        }
        section aria-labelledby="sources-heading" {
            h2 id="sources-heading" { "Where both come from" }
            section class="scroll" tabindex="0" aria-label="Sources, may be scrolled" {
                (sources(compared))
            }
            (asked(old, new))
        }
    }
}

fn curves(unit: FrequencyUnit, pictures: &Pictures) -> Markup {
    html! {
        section aria-labelledby="curves-heading" {
            h2 id="curves-heading" { "Both curves, and their difference" }
            div class="live controls" role="group" aria-label="Curves" {
                label { "Curve of " select id="quantity" {} }
                label id="drive-choice" hidden { "drive " select id="drive" {} }
                label { input type="checkbox" id="log-x" checked; " log " (unit.symbol()) }
                label { input type="checkbox" id="log-y"; " log values" }
            }
            div id="curve" class="live plot tall" {}
            div id="difference" class="live plot" {}
            p class="live hint" id="bars" {}
            (still(
                pictures,
                "comparison",
                "No case has a loss in both results: there is nothing to draw.",
            ))
        }
    }
}

fn data<'a>(compared: &Compared<'a>, csv: &'a str) -> Data<'a> {
    let unit = compared.comparison.unit;
    let places = || compared.comparison.curve.iter().map(|point| point.place);
    let drive = |place: Place| {
        let varied = compared.comparison.varied(&place).into_iter();
        let varied = varied.map(|value| match value {
            Cell::Number(number) => format!("{number}, "),
            name => format!("{}, ", name.text()),
        });
        let varied: String = varied.collect();
        format!("{varied}{} ± {}", place.drive_mean, place.drive_amplitude)
    };
    Data {
        kind: "comparison",
        csv,
        frequency: FrequencyData::of(unit),
        frequencies: places()
            .map(|p| unit.of(p.angular_frequency_rad_per_s))
            .collect(),
        drives: places().map(drive).collect(),
        columns: compared.columns.iter().map(ColumnData::of).collect(),
    }
}

impl<'a> ColumnData<'a> {
    fn of(column: &'a Column) -> Self {
        let known = quantities::of_name(&column.name);
        // A branch, and what another version wrote, by its name.
        let heading = known.filter(|known| known.name == column.name);
        let (unit, factor) = known.map_or(("", 1.0), |known| known.unit());
        Self {
            name: &column.name,
            heading: heading
                .map_or(column.name.as_str(), |known| known.heading)
                .replace('_', " "),
            unit,
            factor,
            is_relative: known
                .is_some_and(|known| known.compared == Some(quantities::Compared::Absolutely)),
            baseline: &column.baseline,
            new: &column.new,
            error: column.error.iter().map(|e| e.map(rounded)).collect(),
        }
    }
}

/// What makes the results differ; nothing where they do not.
fn reasons(comparison: &Comparison) -> Markup {
    let mut lines = Vec::new();
    let mut count = |n: usize, what: &str| {
        if n > 0 {
            lines.push(format!(
                "{n} {} {what}",
                if n == 1 { "case is" } else { "cases are" }
            ));
        }
    };
    count(comparison.missing.len(), "missing in the new result");
    count(comparison.added.len(), "only in the new result");
    count(comparison.statuses.len(), "of another status");
    if !comparison.missing_columns.is_empty() {
        let names = comparison.missing_columns.join(", ");
        lines.push(format!("columns missing in the new result: {names}"));
    }
    let different: Vec<&ColumnComparison> = comparison
        .columns
        .iter()
        .filter(|column| column.different > 0)
        .collect();
    for column in different.iter().take(COLUMNS) {
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
    match different.len().saturating_sub(COLUMNS) {
        0 => {}
        more => lines.push(format!("{more} more columns differ: see below")),
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
    format!(
        "Allowed are a relative difference of {} and an absolute one of {}{own}. On other steps or nodes values within \
         the sum of both error bars are the same too.",
        scientific(tolerances.relative, 3),
        scientific(tolerances.absolute, 3)
    )
}

fn columns(comparison: &Comparison) -> Markup {
    let unit = comparison.unit;
    let at = format!("!at {} / {}", unit.symbol(), unit.name());
    let headings = [
        "column",
        "!largest difference, relative",
        &at,
        "!cases beyond the tolerance",
        "!of these within the bars",
        "!without a value in one",
        "finding",
    ];
    let rows = comparison.columns.iter().map(|column| {
        let (share, omega) = column.largest.map_or((None, None), |(share, place)| {
            (
                Some(share),
                Some(unit.of(place.angular_frequency_rad_per_s)),
            )
        });
        let found = match column.different {
            _ if comparison.compared == 0 => html! { "not compared" },
            different => finding(different > 0),
        };
        html! {
            tr {
                th scope="row" { (column.name) }
                td { (share.map_or("none".to_owned(), |share| scientific(share, 2))) }
                td { (cell(omega)) }
                td { (column.beyond) }
                td { (column.within_bars) }
                td { (column.absent) }
                td class="text" { (found) }
            }
        }
    });
    table(&headings, rows)
}

fn finding(differs: bool) -> Markup {
    match differs {
        true => html! { strong { "differs" } },
        false => html! { "the same" },
    }
}

/// A table; headings of numbers begin with `!`, and one without a word is no heading.
fn table(headings: &[&str], rows: impl Iterator<Item = Markup>) -> Markup {
    html! {
        table class="tight" {
            thead {
                tr {
                    @for heading in headings {
                        @if heading.is_empty() {
                            td class="text" {}
                        } @else if let Some(number) = heading.strip_prefix('!') {
                            th scope="col" { (number) }
                        } @else {
                            th scope="col" class="text" { (heading) }
                        }
                    }
                }
            }
            tbody { @for row in rows { (row) } }
        }
    }
}

fn peaks(unit: FrequencyUnit, peaks: &[PeakComparison]) -> Markup {
    if peaks.is_empty() {
        return html! {
            p { "None to compare: one of the two has no summary.json with peaks, or neither has a peak." }
        };
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
        html! {
            tr {
                th scope="row" { (text(&pair.baseline, &omega)) }
                td class="text" { (text(&pair.new, &omega)) }
                td { (percent(|peak| peak.angular_frequency_rad_per_s)) }
                td class="text" { (text(&pair.baseline, &loss)) }
                td class="text" { (text(&pair.new, &loss)) }
                td { (percent(|peak| peak.energy_loss_j)) }
                td class="text" { (finding(pair.differs)) }
            }
        }
    });
    html! {
        section class="scroll" tabindex="0" aria-label="Peaks, may be scrolled" { (table(&headings, rows)) }
    }
}

fn cases(comparison: &Comparison) -> Markup {
    let mut lists = Vec::new();
    let mut add = |what: &str, lines: Vec<String>| {
        if lines.is_empty() {
            return;
        }
        let mut shown: Vec<String> = lines.iter().take(CASES).cloned().collect();
        if lines.len() > CASES {
            shown.push(format!("and {} more", lines.len() - CASES));
        }
        lists.push(html! { h3 { (what) ": " (lines.len()) } (list(&shown)) });
    };
    let places = |places: &[Place]| {
        places
            .iter()
            .map(|place| comparison.words(place))
            .collect::<Vec<_>>()
    };
    add("Missing in the new result", places(&comparison.missing));
    add("Only in the new result", places(&comparison.added));
    let statuses = comparison.statuses.iter();
    let statuses =
        statuses.map(|(place, a, b)| format!("{}: {a} before, {b} now", comparison.words(place)));
    add("Of another status", statuses.collect());
    add(
        "Columns missing in the new result",
        comparison.missing_columns.clone(),
    );
    add(
        "Columns only in the new result",
        comparison.added_columns.clone(),
    );
    html! {
        p { (comparison.compared) " cases are in both results." }
        @for list in lists { (list) }
    }
}

fn sources(compared: &Compared<'_>) -> Markup {
    let mut rows = Vec::new();
    let mut row = |name: &str, values: [String; 2]| {
        rows.push(html! {
            tr {
                th scope="row" { (name) }
                @for value in values { td class="text wide" { (value) } }
            }
        });
    };
    let unknown = || "not told".to_owned();
    let of = |fact: fn(&Source) -> Option<String>| {
        compared
            .sources
            .map(|source| fact(source).unwrap_or_else(unknown))
    };
    row("result", of(|s| Some(s.name.clone())));
    row(
        "program",
        of(|s| Some(format!("contact-dma {}", s.run.program_version.as_ref()?))),
    );
    row("commit", of(|s| s.run.commit.clone()));
    row("hash of the sweep", of(|s| s.run.sweep_hash.clone()));
    row("engine", of(|s| s.run.engine.clone()));
    row(
        "tolerance of the cycle",
        of(|s| Some(format!("{:e}", s.run.cycle_tolerance?))),
    );
    row(
        "tolerance of an instant",
        of(|s| Some(format!("{:e}", s.run.solver_tolerance?))),
    );
    let tables = [compared.baseline, compared.new];
    row("cases", tables.map(|table| table.cases().to_string()));
    let range = |column: &str| {
        tables.map(|table| match table.resolution(column) {
            None => unknown(),
            Some((low, high)) if low == high => format!("{low}"),
            Some((low, high)) => format!("{low} to {high}"),
        })
    };
    row("time steps per cycle", range("steps"));
    row("springs, or cells per side", range("nodes"));
    table(&["", "baseline", "new"], rows.into_iter())
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
