//! The page of a comparison: the verdict, both curves and their difference, columns, peaks, cases, where both come from.

use std::fmt::Write;

use serde::Serialize;

use super::compact::rounded;
use super::frame::{Frame, Input, InputFile, PLOT};
use super::html::{escaped, filled, json_for_script};
use super::pictures::Pictures;
use super::sweep_data::FrequencyData;
use crate::quantity::{Dimension, FrequencyUnit};
use crate::report::ReportError;
use crate::report::comparison::text::{peak_words, words};
use crate::report::comparison::{
    Column, ColumnComparison, Comparison, PeakComparison, Place, Source, SweepTable, Tolerances,
};
use crate::report::number::{at_frequency, cell, scientific, with_error};
use crate::report::quantities;
use crate::sweep::search::peak::Peak;
use crate::sweep::store::difference;

const MAIN: &str = include_str!("comparison.html");
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
    let verdict = match comparison.differs() {
        true => "The results differ.",
        false => "The results are the same within the tolerances.",
    };
    let figure = compared.pictures.inline("comparison");
    let main = filled(
        MAIN,
        &[
            ("verdict", verdict),
            ("reasons", &reasons(comparison)),
            ("tolerances", &escaped(&tolerances(compared.tolerances))),
            (
                "figure",
                &figure.unwrap_or_else(|| {
                    "<p>No case has a loss in both results: there is nothing to draw.</p>"
                        .to_owned()
                }),
            ),
            ("columns", &columns(comparison)),
            ("peaks", &peaks(comparison.unit, &comparison.peaks)),
            ("cases", &cases(comparison)),
            ("sources", &sources(compared)),
            ("asked", &asked(old, new)),
        ],
    )?;
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
        main,
        input: Input {
            hashes: hashes.collect(),
            files: files.collect(),
            text: "The sweep files of both results, with every default written out. \
                   <code>contact-dma sweep resolved.toml</code> gives each again.",
        },
        data: json_for_script(&data(compared, &String::from_utf8_lossy(&csv)))?,
        script: &[PLOT, SCRIPT],
    };
    frame.page()
}

fn data<'a>(compared: &Compared<'a>, csv: &'a str) -> Data<'a> {
    let unit = compared.comparison.unit;
    let places = || compared.comparison.curve.iter().map(|point| point.place);
    let drive = |place: Place| format!("{} ± {}", place.drive_mean, place.drive_amplitude);
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
fn reasons(comparison: &Comparison) -> String {
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
        return format!("<p>{} cases are in both.</p>", comparison.compared);
    }
    format!("<div class=\"problems\">\n{}</div>", list(&lines))
}

fn list(lines: &[String]) -> String {
    let items: String = lines
        .iter()
        .map(|line| format!("<li>{}</li>\n", escaped(line)))
        .collect();
    format!("<ul>\n{items}</ul>\n")
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

fn columns(comparison: &Comparison) -> String {
    let unit = comparison.unit;
    let at = format!("!at {} / {}", unit.symbol(), unit.name());
    let mut html = table(&[
        "column",
        "!largest difference, relative",
        &at,
        "!cases beyond the tolerance",
        "!of these within the bars",
        "!without a value in one",
        "finding",
    ]);
    for column in &comparison.columns {
        let (share, omega) = column.largest.map_or((None, None), |(share, place)| {
            (
                Some(share),
                Some(unit.of(place.angular_frequency_rad_per_s)),
            )
        });
        let found = match column.different {
            _ if comparison.compared == 0 => "<td class=\"text\">not compared</td>",
            0 => "<td class=\"text\">the same</td>",
            _ => "<td class=\"text\"><strong>differs</strong></td>",
        };
        // Writing to a String cannot fail.
        let _ = writeln!(
            html,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>{found}</tr>",
            escaped(&column.name),
            share.map_or("none".to_owned(), |share| scientific(share, 2)),
            cell(omega),
            column.beyond,
            column.within_bars,
            column.absent
        );
    }
    html + "</tbody>\n</table>"
}

/// The head of a table; headings of numbers begin with `!`.
fn table(headings: &[&str]) -> String {
    let heads: String = headings
        .iter()
        .map(|heading| match heading.strip_prefix('!') {
            Some(number) => format!("<th scope=\"col\">{number}</th>"),
            None => format!("<th scope=\"col\" class=\"text\">{heading}</th>"),
        })
        .collect();
    format!("<table class=\"tight\">\n<thead><tr>{heads}</tr></thead>\n<tbody>\n")
}

fn peaks(unit: FrequencyUnit, peaks: &[PeakComparison]) -> String {
    if peaks.is_empty() {
        return "<p>None to compare: one of the two has no summary.json with peaks, or neither has a peak.</p>".to_owned();
    }
    let symbol = unit.symbol();
    let mut html = table(&[
        &format!("baseline, at {symbol}"),
        &format!("new, at {symbol}"),
        "!moved by / %",
        "baseline, loss",
        "new, loss",
        "!changed by / %",
        "finding",
    ]);
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
    for pair in peaks {
        let text = |peak: &Option<Peak>, of: &dyn Fn(&Peak) -> String| {
            peak.as_ref().map_or("none".to_owned(), of)
        };
        let percent = |of: fn(&Peak) -> f64| {
            let both = pair.baseline.as_ref().zip(pair.new.as_ref());
            both.map_or("–".to_owned(), |(a, b)| {
                scientific(100.0 * (of(b) / of(a) - 1.0), 2)
            })
        };
        let _ = writeln!(
            html,
            "<tr><th scope=\"row\">{}</th><td class=\"text\">{}</td><td>{}</td><td class=\"text\">{}</td>\
             <td class=\"text\">{}</td><td>{}</td><td class=\"text\">{}</td></tr>",
            escaped(&text(&pair.baseline, &omega)),
            escaped(&text(&pair.new, &omega)),
            percent(|peak| peak.angular_frequency_rad_per_s),
            escaped(&text(&pair.baseline, &loss)),
            escaped(&text(&pair.new, &loss)),
            percent(|peak| peak.energy_loss_j),
            if pair.differs {
                "<strong>differs</strong>"
            } else {
                "the same"
            }
        );
    }
    format!(
        "<section class=\"scroll\" tabindex=\"0\" aria-label=\"Peaks, may be scrolled\">\n{html}</tbody>\n</table>\n</section>"
    )
}

fn cases(comparison: &Comparison) -> String {
    let mut html = format!(
        "<p>{} cases are in both results.</p>\n",
        comparison.compared
    );
    let mut add = |what: &str, lines: Vec<String>| {
        if lines.is_empty() {
            return;
        }
        let _ = writeln!(html, "<h3>{what}: {}</h3>", lines.len());
        let mut shown: Vec<String> = lines.iter().take(CASES).cloned().collect();
        if lines.len() > CASES {
            shown.push(format!("and {} more", lines.len() - CASES));
        }
        html.push_str(&list(&shown));
    };
    let places = |places: &[Place]| {
        places
            .iter()
            .map(|place| words(comparison.unit, place))
            .collect::<Vec<_>>()
    };
    add("Missing in the new result", places(&comparison.missing));
    add("Only in the new result", places(&comparison.added));
    let statuses = comparison.statuses.iter();
    let statuses = statuses
        .map(|(place, a, b)| format!("{}: {a} before, {b} now", words(comparison.unit, place)));
    add("Of another status", statuses.collect());
    add(
        "Columns missing in the new result",
        comparison.missing_columns.clone(),
    );
    add(
        "Columns only in the new result",
        comparison.added_columns.clone(),
    );
    html
}

fn sources(compared: &Compared<'_>) -> String {
    let mut html = table(&["", "baseline", "new"]).replace(
        "<th scope=\"col\" class=\"text\"></th>",
        "<td class=\"text\"></td>",
    );
    let mut row = |name: &str, values: [String; 2]| {
        let values =
            values.map(|value| format!("<td class=\"text wide\">{}</td>", escaped(&value)));
        let _ = writeln!(
            html,
            "<tr><th scope=\"row\">{name}</th>{}</tr>",
            values.concat()
        );
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
    html + "</tbody>\n</table>"
}

/// Whether both were asked the same.
fn asked(old: &Source, new: &Source) -> String {
    let (Some(old), Some(new)) = (&old.resolved, &new.resolved) else {
        return "<p>What was asked cannot be compared: one of the two has no resolved.toml.</p>"
            .to_owned();
    };
    if old == new {
        return "<p>Both were asked the same, to the last letter.</p>".to_owned();
    }
    format!(
        "<h3>Lines in which the questions differ: − baseline, + new</h3>\n\
         <pre tabindex=\"0\" aria-label=\"Lines in which the questions differ\"><code>{}</code></pre>",
        escaped(&difference::lines(old, new, LINES))
    )
}
