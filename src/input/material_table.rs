//! The `[material.table]` block: measured data, from a CSV file or written out.

use super::data_file;
use super::document::Located;
use super::document::reader::TableReader;
use super::table_file;
use crate::material::fit::{self, Fit, FitError};
use crate::material::tabulated::keys::{
    EVALUATION, Evaluation, FILE, FLOW, QUANTITY, TABLE_MODULUS, TIMES, VALUES,
};
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

/// The material of a table, but for its Poisson ratio.
pub(crate) enum TableMaterial {
    /// As a series, with the report of the fit.
    Fitted(Box<Fit>),
    /// As it is.
    Direct(Tabulated),
}

/// Reads the block. `None` where a problem was reported.
pub(crate) fn read(table: &mut TableReader<'_>, direct_sum: DirectSum) -> Option<TableMaterial> {
    let problems = table.problems();
    let source = table.one_of(&[(&FILE, true), (&TIMES, false)]);
    let (function, kind) = (table.value(&QUANTITY), table.value(&TABLE_MODULUS));
    let evaluation: Option<Located<Evaluation>> = table.read(&EVALUATION);
    let flow = table.read_if(&FLOW);
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
        // Nothing is wrong with it.
        table.has(&VALUES);
        return None;
    }
    if source.is_none() {
        // In its place beside `times`, which was reported.
        table.has(&VALUES);
    }
    let data = match source? {
        true => from_file(table, function, kind),
        false => written_out(table, function, kind),
    };
    // A problem with one of them was reported.
    let (data, evaluation, flow) = (data?, evaluation?.value, flow?);
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
        Err(error) => problems.accept(&data, Err(error)),
    }
}

fn from_file(
    table: &mut TableReader<'_>,
    function: Option<MaterialFunction>,
    kind: Option<ModulusKind>,
) -> Option<Located<Tabulated>> {
    let file: Option<Located<String>> = table.read(&FILE);
    let (file, function, kind) = (file?, function?, kind?);
    let parse = |name: &str, bytes: &[u8]| table_file::parse(name, bytes, function, kind);
    let data = data_file::made_of(&file, table.folder(), table.problems(), parse)?;
    Some(file.map(|_| data))
}

/// Samples in the file itself: `times` and `values`, as a resolved scenario has them.
fn written_out(
    table: &mut TableReader<'_>,
    function: Option<MaterialFunction>,
    kind: Option<ModulusKind>,
) -> Option<Located<Tabulated>> {
    let times: Option<Located<Vec<f64>>> = table.read(&TIMES);
    let Some(function) = function else {
        // Without the quantity it is not known what the values are; the key is in its place all the same.
        table.has(&VALUES);
        return None;
    };
    let dimension = match function {
        MaterialFunction::Creep => Dimension::Compliance,
        MaterialFunction::Relaxation => Dimension::Stress,
    };
    table.choose(dimension);
    let values: Option<Located<Vec<f64>>> = table.read(&VALUES);
    let (times, values, kind) = (times?, values?, kind?);
    match Tabulated::new(function, kind, times.value.clone(), values.value) {
        Ok(data) => Some(times.map(|_| data)),
        Err(error) => {
            let place = error.place().and_then(|(row, column)| {
                let list = match column {
                    TableColumn::Time => TIMES,
                    TableColumn::Value => VALUES,
                };
                table.places_in(list.name).into_iter().nth(row - 1)
            });
            let place = place.unwrap_or(values.location);
            table.problems().at(&place, error.to_string());
            None
        }
    }
}
