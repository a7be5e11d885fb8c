//! Force curves: tables of time, force and indentation, and the files of instruments.

mod exported;
mod igor;
mod jpk;
mod table;

use super::data_file::workbook;
use super::diagnostic::Diagnostics;
use crate::force_curve::ForceCurve;
use crate::force_curve::resolved::Probe;

/// The curves in the bytes of a file that messages call `name`.
///
/// # Errors
/// What is wrong with a table, at its place; a file of an instrument that is broken, or lacks what makes a force or an indentation.
pub(super) fn parse(
    name: &str,
    bytes: &[u8],
    probe: &Probe,
) -> Result<Vec<ForceCurve>, Diagnostics> {
    let mut curves = recorded(name, bytes, probe)?;
    for curve in &mut curves {
        curve.take_response_back(probe);
    }
    Ok(curves)
}

/// The same as the channels have it.
fn recorded(name: &str, bytes: &[u8], probe: &Probe) -> Result<Vec<ForceCurve>, Diagnostics> {
    if let Some(archive) = jpk::archive(bytes) {
        return Ok(jpk::parse(name, archive, probe)?);
    }
    if igor::is_wave(bytes) {
        return Ok(vec![igor::parse(name, bytes, probe)?]);
    }
    if workbook::is_workbook(bytes) {
        return exported::of_workbook(name, bytes, probe);
    }
    match exported::as_table(bytes) {
        Some(text) => table::parse(name, text.as_bytes(), probe),
        None => table::parse(name, bytes, probe),
    }
}

/// What a curve of a file is called.
fn stem(name: &str) -> String {
    let stem = std::path::Path::new(name).file_stem();
    stem.map_or_else(|| name.to_owned(), |stem| stem.display().to_string())
}

/// A curve of what an instrument measures: its time (s), how far its probe was moved towards the specimen, and how far the cantilever bent
/// (m), of this spring constant.
fn of_cantilever(
    name: String,
    [time_s, travel_m, deflection_m]: [Vec<f64>; 3],
    spring_n_per_m: f64,
    probe: &Probe,
) -> ForceCurve {
    let gives_m = probe.frame_compliance_m_per_n * spring_n_per_m;
    let mut curve = ForceCurve {
        name,
        ..ForceCurve::default()
    };
    let mut travelled_m = Vec::with_capacity(travel_m.len());
    for ((t, travel), bent) in time_s.into_iter().zip(travel_m).zip(deflection_m) {
        if !(t.is_finite() && travel.is_finite() && bent.is_finite()) {
            continue;
        }
        curve.time_s.push(t);
        curve.force_n.push(spring_n_per_m * bent);
        curve.indentation_m.push(travel - (1.0 + gives_m) * bent);
        travelled_m.push(travel);
    }
    curve.travel_m = Some(travelled_m);
    curve
}
