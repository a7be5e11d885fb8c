//! The page of measured loops: what was found, figures, the table, the setup.

use maud::{Markup, html};

use super::frame::Input;
use super::question::list;
use super::{Pictures, plain, scroll};
use crate::measured::{Estimate, Quantity};
use crate::quantity::Dimension;
use crate::report::ReportError;
use crate::report::figure::Figure;
use crate::report::measured::{Analysis, MeasuredRow, text};
use crate::report::number::{four_digits, with_error};
use crate::sweep::plan::resolved;

/// The page; the pictures of the figures have gone by.
///
/// # Errors
/// [`ReportError`] naming the part that could not be made.
pub fn page(
    analysis: &Analysis,
    figures: &[Figure],
    pictures: &Pictures,
) -> Result<String, ReportError> {
    let rows = &analysis.rows;
    let mut lines = match &rows[..] {
        [row] => row.measured.as_ref().map(text::record).unwrap_or_default(),
        many => vec![format!("{} records of measured loops.", many.len())],
    };
    lines.extend(rows.iter().flat_map(told));
    let content = html! {
        (list(&lines))
        (pictures.whole(figures))
        h3 { "Loss, phase and moduli" }
        p { "The number after ± is half the width of the 95 % interval; E′ and E″ are without the bias of the small-amplitude formula where the setup \
             gives the shape." }
        (scroll("Records", table(rows)))
    };
    let setup = analysis.setup.iter();
    let input = Input {
        hashes: (setup.clone())
            .map(|setup| ("exactly this setup", resolved::hash(setup)))
            .collect(),
        files: setup.map(|text| ("setup.toml", &text[..])).collect(),
        text: "The setup of instrument and contact.",
    };
    let asked = "energy loss, phase and moduli from measured loops".to_owned();
    let title = (&analysis.title[..], asked);
    plain::page("measured", title, ("The loops", content), input)
}

/// What is to be known of a record, its file before it.
fn told(row: &MeasuredRow) -> impl Iterator<Item = String> {
    let findings = row.measured.iter().flat_map(|m| &m.findings);
    let findings = findings.map(|finding| finding.to_string());
    let all = findings.chain(row.reason.clone());
    all.map(|what| format!("{}: {what}.", row.file))
}

fn table(rows: &[MeasuredRow]) -> Markup {
    let cell = |mean: Option<Estimate>, dimension: Dimension| match mean {
        Some(mean) => with_error(mean.value, mean.error, dimension),
        None => "–".to_owned(),
    };
    let has_moduli = (rows.iter()).any(|row| row.mean(Quantity::LossModulus).is_some());
    let moduli = |row: &MeasuredRow| {
        let unbiased = row.measured.as_ref().and_then(|m| m.unbiased);
        let storage = unbiased.map(|u| u.storage_modulus_pa);
        let loss = unbiased.map(|u| u.loss_modulus_pa);
        [
            storage.or_else(|| row.mean(Quantity::StorageModulus)),
            loss.or_else(|| row.mean(Quantity::LossModulus)),
        ]
    };
    let cells = rows.iter().map(|row| {
        let measured = row.measured.as_ref();
        let hz = measured.map_or("–".to_owned(), |m| four_digits(m.frequency.hz));
        let loss = cell(row.mean(Quantity::EnergyLoss), Dimension::Energy);
        let mut cells = vec![row.file.clone(), hz, loss, text::phase(row)];
        if has_moduli {
            cells.extend(moduli(row).map(|modulus| cell(modulus, Dimension::Stress)));
        }
        let cycles = measured.map_or(0, |m| m.used.len());
        cells.extend([cycles.to_string(), row.status().name().to_owned()]);
        cells
    });
    let mut headings = vec!["file", "f / Hz", "loss per cycle", "phase lag"];
    if has_moduli {
        headings.extend(["E′", "E″"]);
    }
    headings.extend(["cycles", "status"]);
    plain::table(&headings, cells)
}
