//! The `[material.table]` block: measured data, from a CSV file or written out.
//!
//! ```text
//! file = "creep.csv"                    columns time_s and creep_compliance_per_pa or relaxation_modulus_pa, and other units
//! times, values = [...], [...]          in place of a file
//! quantity = "creep" | "relaxation"
//! modulus = "shear" | "longitudinal"
//! evaluation = "fit" | "direct"         a series fitted to the samples, or the samples themselves (single histories)
//! flow = true | false                   whether the series is that of a fluid; absent: as the data say
//! ```

use std::path::Path;

use super::diagnostic::Problems;
use super::document::{Located, TableReader};
use super::material_block::KINDS;
use super::table_file;
use super::table_source::{TABLE_SOURCES, TableSource};
use crate::material::fit::{self, Fit, FitError};
use crate::material::tabulated::{TableColumn, Tabulated};
use crate::material::{MaterialFunction, ModulusKind};
use crate::quantity::Dimension;

/// What a command does where a file asks for the direct hereditary sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DirectSum {
    /// It takes the samples as they are.
    Taken,
    /// It cannot do without a series.
    Refused,
    /// It looks at the series that would be fitted.
    Fitted,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Evaluation {
    Fit,
    Direct,
}

const EVALUATIONS: [(&str, Evaluation); 2] =
    [("fit", Evaluation::Fit), ("direct", Evaluation::Direct)];

/// The material of a table, but for its Poisson ratio.
pub(crate) enum TableMaterial {
    /// As a series, with the report of the fit.
    Fitted(Box<Fit>),
    /// As it is.
    Direct(Tabulated),
}

/// Reads the block; files are looked for in `folder`. `None` where a problem was reported.
pub(crate) fn read(
    table: &mut TableReader<'_>,
    folder: &Path,
    direct_sum: DirectSum,
    problems: &Problems,
) -> Option<TableMaterial> {
    let source = table.one_of(&TABLE_SOURCES);
    let face = table.choice_of("quantity", &table_file::QUANTITIES);
    let kind = table.choice_of("modulus", &KINDS);
    let evaluation = table.choice_of_or("evaluation", &EVALUATIONS, Evaluation::Fit);
    if let Some(asked) = &evaluation
        && asked.value == Evaluation::Direct
        && direct_sum == DirectSum::Refused
    {
        problems
            .at(asked, "a sweep cannot take the samples of a table directly")
            .because("the stabilised cycle is found from the memory variables of a series (Prony form)")
            .help(
                "write evaluation = \"fit\" (the misfit is told with the results), or follow one history with \
                 `contact-dma simulate`",
            );
        return None;
    }
    let flow = table.has("flow").then(|| table.boolean("flow"));
    let (face, kind) = (face.map(|f| f.value), kind.map(|k| k.value));
    if source.is_none() {
        // In its place beside `times`, which was reported.
        table.has("values");
    }
    let data = match source?.1 {
        TableSource::File => from_file(table, folder, face, kind, problems),
        TableSource::WrittenOut => written_out(table, face, kind, problems),
    };
    let (data, evaluation) = (data?, evaluation?.value);
    // A problem with the key was reported.
    let flow = match flow {
        Some(flow) => Some(flow?),
        None => None,
    };
    if evaluation == Evaluation::Direct && direct_sum == DirectSum::Taken {
        if let Some(flow) = flow {
            problems
                .at(
                    &flow,
                    "samples taken directly are neither a fluid nor a solid",
                )
                .because("a setting of the fit")
                .help("leave out `flow`, or write evaluation = \"fit\"");
            return None;
        }
        return Some(TableMaterial::Direct(data.value));
    }
    match fit::fit(&data.value, flow.as_ref().map(|flow| flow.value)) {
        Ok(fit) => Some(TableMaterial::Fitted(Box::new(fit))),
        Err(error @ FitError::NoFlow) => {
            let place = flow.as_ref().map_or(&data.location, |flow| &flow.location);
            problems
                .at(place, error.to_string())
                .help("write flow = false, or leave it out");
            None
        }
        Err(error) => {
            problems.at(&data, error.to_string());
            None
        }
    }
}

fn from_file(
    table: &mut TableReader<'_>,
    folder: &Path,
    face: Option<MaterialFunction>,
    kind: Option<ModulusKind>,
    problems: &Problems,
) -> Option<Located<Tabulated>> {
    let file = table.string("file");
    let (file, face, kind) = (file?, face?, kind?);
    let path = file.path_from(folder);
    let bytes = match table_file::load(&path) {
        Ok(bytes) => bytes,
        Err(error) => {
            problems
                .at(&file, format!("cannot read `{}`: {error}", path.display()))
                .help(file.path_rule());
            return None;
        }
    };
    match table_file::parse(&path.display().to_string(), &bytes, face, kind) {
        Ok(data) => Some(file.map(|_| data)),
        Err(refused) => {
            problems.extend(refused);
            None
        }
    }
}

/// Samples in the file itself: `times` and `values`, as a resolved scenario has them.
fn written_out(
    table: &mut TableReader<'_>,
    face: Option<MaterialFunction>,
    kind: Option<ModulusKind>,
    problems: &Problems,
) -> Option<Located<Tabulated>> {
    let times = table.quantities("times", Dimension::Time);
    let Some(face) = face else {
        // Without the quantity it is not known what the values are; the key is in its place all the same.
        table.has("values");
        return None;
    };
    let dimension = match face {
        MaterialFunction::Creep => Dimension::Compliance,
        MaterialFunction::Relaxation => Dimension::Stress,
    };
    let values = table.quantities("values", dimension);
    let (times, values, kind) = (times?, values?, kind?);
    let plain = |list: &[Located<f64>]| list.iter().map(|v| v.value).collect();
    match Tabulated::new(face, kind, plain(&times.value), plain(&values.value)) {
        Ok(data) => Some(times.map(|_| data)),
        Err(error) => {
            let place = error.place().and_then(|(row, column)| {
                let list = match column {
                    TableColumn::Time => &times,
                    TableColumn::Value => &values,
                };
                list.value.get(row - 1).map(|entry| &entry.location)
            });
            problems.at(place.unwrap_or(&values.location), error.to_string());
            None
        }
    }
}
