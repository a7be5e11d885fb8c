//! Steps of a test, as TRIOS and RheoCompass export them: which of them are frequency sweeps, and what is said of the others.

use super::Reading;
use super::block::{self, Block, Measured};
use crate::input::data_file::grid::Grid;
use crate::input::data_file::units;
use crate::input::diagnostic::{Diagnostic, Diagnostics};

/// Frequencies closer than this are one.
const SAME_FREQUENCY: f64 = 1.001;

/// What to do where a file is not of the format that was asked for.
pub(super) const LEAVE_OUT: &str = "leave the format out, to have it found";

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
        let name = step.name.as_deref().unwrap_or("without a name");
        if is_derived(name) {
            reading.note(format!(
                "step `{name}` passed over: computed from the others"
            ));
            continue;
        }
        if let Some(what) = block::lacking(&block::names(&step.section.header)) {
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

/// Steps that open with a line `[step]`: perhaps a name, then names, perhaps units, rows; each ends at the next line in brackets.
pub(super) fn bracketed(grid: &Grid) -> Vec<Block<'_>> {
    let is_mark = |line: &usize| is_bracketed(grid.text(*line));
    let is_step = |line: &usize| {
        grid.text(*line)
            .trim_matches([',', '\t', ' ', '"'])
            .eq_ignore_ascii_case("[step]")
    };
    let mut steps = Vec::new();
    for start in (0..grid.len()).filter(is_step) {
        let end = (start + 1..grid.len()).find(is_mark).unwrap_or(grid.len());
        let header = (start + 1..end.min(start + 5)).find(|line| {
            let cells = grid.line(*line);
            let known = block::names(&cells).iter().flatten().count();
            known > 0 && cells.len() > 1
        });
        let last = header.unwrap_or(start + 2);
        let name = (start + 1 < last && start + 1 < end).then(|| {
            grid.text(start + 1)
                .trim_matches([',', '\t', ' ', '"'])
                .to_owned()
        });
        let mut step = Block::new(grid, header.unwrap_or(start + 1), end).by_instrument();
        step.temperature_k = name.as_deref().and_then(temperature_in);
        step.name = name;
        steps.push(step);
    }
    steps
}

fn is_bracketed(line: &str) -> bool {
    let line = line.trim_matches([',', '\t', ' ', '"', ';']);
    line.starts_with('[') && line.ends_with(']') && !line[1..].contains('[')
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
