//! The page of measured loops: what was found, figures, the table, the setup.

use maud::{Markup, html};

use super::Pictures;
use super::frame::{Frame, Input, InputFile};
use super::html::json_for_script;
use super::plain::{Data, SCRIPT, shown};
use super::question::list;
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
    let main = html! {
        section aria-labelledby="answer" class="answer" {
            h2 id="answer" { "The loops" }
            (list(&lines))
            @for figure in figures { (shown(figure, pictures)) }
            h3 { "Loss, phase and moduli" }
            p { "After ± stands half the interval of 95 %; E′ and E″ are without the bias of the small-amplitude formula where the setup \
                 gives the shape." }
            section class="scroll" tabindex="0" aria-label="Records, may be scrolled" { (table(rows)) }
        }
    };
    let setup = analysis.setup.as_deref();
    let frame = Frame {
        title: &analysis.title,
        asked: "energy loss, phase and moduli from measured loops".to_owned(),
        main,
        input: Input {
            hashes: setup
                .map(|setup| ("exactly this setup", resolved::hash(setup)))
                .into_iter()
                .collect(),
            files: setup
                .map(|text| InputFile {
                    name: "setup.toml",
                    text,
                })
                .into_iter()
                .collect(),
            text: "The setup of instrument and contact.",
        },
        script: &[SCRIPT],
        data: json_for_script(&Data { kind: "measured" })?,
    };
    Ok(frame.page())
}

/// What is to be known of a record, its file before it.
fn told(row: &MeasuredRow) -> Vec<String> {
    let findings = row.measured.iter().flat_map(|m| &m.findings);
    let findings = findings.map(|finding| format!("{}: {finding}.", row.file));
    let reason = row
        .reason
        .iter()
        .map(|reason| format!("{}: {reason}.", row.file));
    findings.chain(reason).collect()
}

fn table(rows: &[MeasuredRow]) -> Markup {
    let cell = |mean: Option<Estimate>, dimension: Dimension| match mean {
        Some(mean) => with_error(mean.value, mean.error, dimension),
        None => "–".to_owned(),
    };
    let modulus = |row: &MeasuredRow, is_loss: bool| {
        let unbiased = row.measured.as_ref().and_then(|m| m.unbiased);
        let unbiased = unbiased.map(|u| {
            if is_loss {
                u.loss_modulus_pa
            } else {
                u.storage_modulus_pa
            }
        });
        let of_formula = if is_loss {
            Quantity::LossModulus
        } else {
            Quantity::StorageModulus
        };
        cell(unbiased.or_else(|| row.mean(of_formula)), Dimension::Stress)
    };
    let has_moduli = rows
        .iter()
        .any(|row| row.mean(Quantity::LossModulus).is_some());
    let hz = |row: &MeasuredRow| {
        row.measured
            .as_ref()
            .map_or("–".to_owned(), |m| four_digits(m.frequency.hz))
    };
    html! {
        table {
            thead { tr {
                th { "file" } th { "f / Hz" } th { "loss per cycle" } th { "phase lag" }
                @if has_moduli { th { "E′" } th { "E″" } }
                th { "cycles" } th { "status" }
            } }
            tbody {
                @for row in rows {
                    tr {
                        td { (row.file) }
                        td { (hz(row)) }
                        td { (cell(row.mean(Quantity::EnergyLoss), Dimension::Energy)) }
                        td { (text::phase(row)) }
                        @if has_moduli { td { (modulus(row, false)) } td { (modulus(row, true)) } }
                        td { (row.measured.as_ref().map_or(0, |m| m.used.len())) }
                        td { (row.status().name()) }
                    }
                }
            }
        }
    }
}
