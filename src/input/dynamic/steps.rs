//! Steps of a test, as TRIOS and RheoCompass export them: which of them are frequency sweeps, and what is said of the others.

use super::Reading;
use super::block::{self, Block, Measured};
use crate::input::data_file::grid::Grid;
use crate::input::data_file::units;
use crate::input::diagnostic::{Diagnostic, Diagnostics};

/// Frequencies closer than this are one.
const SAME_FREQUENCY: f64 = 1.001;

/// Reads the steps that hold dynamic data. What an instrument's software computed from others, and what varies strain, time or
/// temperature at one frequency where other steps vary the frequency, is passed over.
///
/// # Errors
/// No step at all, for which `none` gives the reason and what to do; none that holds dynamic data; or what [`Block::read`] refuses.
pub(super) fn read(
    grid: &Grid,
    steps: &[Block<'_>],
    [none, help]: [&str; 2],
    reading: &mut Reading,
) -> Result<(), Diagnostics> {
    if steps.is_empty() {
        return Err(Diagnostic::at(&grid.place(0), none).help(help).into());
    }
    let (mut sweeps, mut others) = (Vec::new(), Vec::new());
    for step in steps {
        let name = step.called();
        if is_derived(name) {
            reading.note(format!(
                "step `{name}` passed over: computed from the others"
            ));
            continue;
        }
        if let Some([what, _]) = block::lacking(&block::names(&step.section.header)) {
            reading.note(format!("step `{name}` passed over: no column of {what}"));
            continue;
        }
        let content = step.read(reading.kind)?;
        match is_sweep(&content.points) {
            true => sweeps.push((name, step, content)),
            false => others.push((name, step, content)),
        }
    }
    if !sweeps.is_empty() {
        for (name, _, _) in others.drain(..) {
            reading.note(format!(
                "step `{name}` passed over: it does not vary the frequency"
            ));
        }
    }
    if sweeps.is_empty() && others.is_empty() {
        return Err(Diagnostic::at(&grid.place(0), "no step with storage and loss modulus over frequency")
            .help("export the columns Angular frequency, Storage modulus, Loss modulus and Temperature of the frequency sweeps")
            .into());
    }
    for (_, step, content) in sweeps.into_iter().chain(others) {
        reading.add_content(step, content)?;
    }
    Ok(())
}

/// Whether software computed a step of this name from others.
pub(super) fn is_derived(name: &str) -> bool {
    let lower = name.trim().to_lowercase();
    lower.starts_with("tts")
        || ["shift factor", "master curve", "mastercurve"]
            .iter()
            .any(|word| lower.contains(word))
}

fn is_sweep(points: &[Measured]) -> bool {
    let all = points
        .iter()
        .map(|measured| measured.point.angular_frequency_rad_per_s);
    let (least, most) = all.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), value| {
        (a.min(value), b.max(value))
    });
    most > SAME_FREQUENCY * least
}

/// The temperature in the name of a step (K): `Frequency sweep (150.0 °C)`.
pub(super) fn temperature_in(name: &str) -> Option<f64> {
    let (before, _) = name.split_once("°C").or_else(|| name.split_once(" C)"))?;
    units::kelvin(before.trim_end().rsplit(['(', ' ', '@', '=', '_']).next()?)
}

/// Whether a line opens a step.
pub(super) fn is_step(line: &str) -> bool {
    line.eq_ignore_ascii_case("[step]")
}

/// The text of a line that has only one cell.
pub(super) fn cell(line: &str) -> &str {
    line.trim_matches([',', '\t', ' ', '"', ';', '\r'])
}

/// Steps that open with a line `[step]`: perhaps a name, then names, perhaps units, rows; each ends at the next line in brackets.
pub(super) fn bracketed(grid: &Grid) -> Vec<Block<'_>> {
    let is_mark = |line: &usize| is_bracketed(cell(grid.text(*line)));
    let is_header = |line: &usize| {
        let cells = grid.line(*line);
        cells.len() > 1 && block::names(&cells).iter().any(Option::is_some)
    };
    let step = |start: usize| {
        let end = (start + 1..grid.len()).find(is_mark).unwrap_or(grid.len());
        let header = (start + 1..end.min(start + 5)).find(is_header);
        let has_name = start + 1 < header.unwrap_or(start + 2) && start + 1 < end;
        let name = has_name.then(|| cell(grid.text(start + 1)));
        Block::new(grid, header.unwrap_or(start + 1), end).of_step(name)
    };
    let starts = (0..grid.len()).filter(|line| is_step(cell(grid.text(*line))));
    starts.map(step).collect()
}

fn is_bracketed(line: &str) -> bool {
    line.starts_with('[') && line.ends_with(']') && !line[1..].contains('[')
}

/// Steps that open with a line `[Step]`, whose lines have labels: `Step name TAB Frequency sweep (150.0 °C)`, `Number of points TAB 17`,
/// `Variables TAB ...`, `Units TAB ...`, rows `Data point TAB ...`.
pub(super) fn labelled<'a>(grid: &'a Grid, reading: &mut Reading) -> Vec<Block<'a>> {
    let starts = (0..grid.len()).filter(|line| is_step(grid.text(*line).trim()));
    starts
        .filter_map(|start| labelled_step(grid, start, reading))
        .collect()
}

fn labelled_step<'a>(grid: &'a Grid, start: usize, reading: &mut Reading) -> Option<Block<'a>> {
    let mut below = start + 1..grid.len();
    let end = below.find(|line| grid.text(*line).starts_with('['));
    let end = end.unwrap_or(grid.len());
    let has = |line: usize, label: &str| grid.line(line).text(0).eq_ignore_ascii_case(label);
    let find = |label: &str| (start + 1..end).find(|line| has(*line, label));
    let text = |label: &str| Some(grid.line(find(label)?).text(1));
    let mut step = Block::new(grid, find("Variables")?, end).of_step(text("Step name"));
    let rows = find("Data point").unwrap_or(end);
    let last = (rows..end).find(|line| !has(*line, "Data point"));
    step.section.rows = rows..last.unwrap_or(end);
    step.section.units = find("Units").map(|line| grid.line(line));
    let (announced, there) = (text("Number of points"), step.section.rows.len());
    if let Some(announced) = announced.and_then(|count| count.parse::<usize>().ok())
        && announced != there
    {
        reading.note(format!(
            "step `{}`: {announced} points are announced, and {there} are there",
            step.called()
        ));
    }
    Some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn temperatures_are_found_in_names() {
        for (name, kelvin) in [
            ("Frequency sweep (150.0 °C)", Some(423.15)),
            ("Frequency sweep (-50,0 °C) - 3", Some(223.15)),
            ("FS 20°C", Some(293.15)),
            ("Frequency sweep - 2", None),
            ("ramp to °C", None),
            ("(-400 °C)", None),
        ] {
            let found = temperature_in(name);
            assert_eq!(found.is_some(), kelvin.is_some(), "{name}");
            assert!(
                (found.unwrap_or(0.0) - kelvin.unwrap_or(0.0)).abs() < 1e-9,
                "{name}: {found:?}"
            );
        }
    }
}
