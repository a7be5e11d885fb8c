//! Force curves of Asylum Research: waves of Igor Pro (`.ibw`), version 5, of a column for every channel and a note that has the settings.
//!
//! The layout is that of WaveMetrics' Technical Note 003: a header of 64 bytes with the lengths of what follows, one of 320 bytes, the
//! numbers column by column, formula, note, units, and the labels of the columns, 32 bytes each.

use super::{of_cantilever, stem};
use crate::force_curve::ForceCurve;
use crate::force_curve::resolved::Probe;
use crate::input::diagnostic::Diagnostic;

const HEADERS: usize = 384;
const LABEL: usize = 32;

/// Whether the bytes are a wave of version 5.
pub(super) fn is_wave(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x05\0") && bytes.len() > HEADERS
}

/// The curve of a wave that messages call `name`.
///
/// # Errors
/// Another kind of wave, one that ends too soon, or without what makes a force and an indentation.
pub(super) fn parse(name: &str, bytes: &[u8], probe: &Probe) -> Result<ForceCurve, Diagnostic> {
    let refused =
        |why: &str, help: &str| Diagnostic::new(format!("`{name}`: {why}")).help(help.to_owned());
    const EXPORT: &str = "open it in Igor Pro and export time, force and indentation as text";
    let wave = Wave::of(bytes).ok_or_else(|| refused("a wave that is not understood", EXPORT))?;
    let channel = |names: [&str; 2]| names.into_iter().find_map(|name| wave.column(name));
    let deflection_m = channel(["Defl", "Deflection"])
        .ok_or_else(|| refused("a wave without a deflection", EXPORT))?;
    let travel_m = channel(["ZSnsr", "Raw"])
        .ok_or_else(|| refused("a wave without a position of the piezo", EXPORT))?;
    let spring = probe
        .spring_constant_n_per_m
        .or(wave.setting("SpringConstant"));
    let spring = spring.filter(|spring| *spring > 0.0).ok_or_else(|| {
        let help = "add `[instrument]` with `spring_constant = \"0.1 N/m\"`";
        refused("a wave without a spring constant", help)
    })?;
    let step_s = wave.step_s.filter(|step| *step > 0.0);
    let step_s = step_s.ok_or_else(|| refused("a wave without a time step", EXPORT))?;
    let time_s = (0..deflection_m.len()).map(|k| step_s * k as f64).collect();
    Ok(of_cantilever(
        stem(name),
        [time_s, travel_m, deflection_m],
        spring,
        probe,
    ))
}

/// The parts of a wave.
struct Wave {
    rows: usize,
    numbers: Vec<f64>,
    labels: Vec<String>,
    note: String,
    /// Between rows, where they are times.
    step_s: Option<f64>,
}

impl Wave {
    fn of(bytes: &[u8]) -> Option<Self> {
        let integer = |at: usize| {
            let word = bytes.get(at..at + 4)?.try_into().ok()?;
            usize::try_from(i32::from_le_bytes(word)).ok()
        };
        let (formula, note, units) = (integer(8)?, integer(12)?, integer(16)?);
        let of_units: usize = (0..4).map(|k| integer(20 + 4 * k)).sum::<Option<usize>>()?;
        let of_labels = [integer(36)?, integer(40)?];
        let (rows, columns) = (integer(64 + 68)?, integer(64 + 72)?.max(1));
        let count = rows.checked_mul(columns)?;
        let step = f64::from_le_bytes(bytes.get(64 + 84..64 + 92)?.try_into().ok()?);
        let (numbers, end): (Vec<f64>, usize) = match bytes.get(64 + 16..64 + 18)? {
            [2, 0] => {
                let end = HEADERS.checked_add(count.checked_mul(4)?)?;
                let words = bytes.get(HEADERS..end)?.as_chunks::<4>().0.iter();
                (
                    words
                        .map(|word| f64::from(f32::from_le_bytes(*word)))
                        .collect(),
                    end,
                )
            }
            [4, 0] => {
                let end = HEADERS.checked_add(count.checked_mul(8)?)?;
                let words = bytes.get(HEADERS..end)?.as_chunks::<8>().0.iter();
                (words.map(|word| f64::from_le_bytes(*word)).collect(), end)
            }
            _ => return None,
        };
        let note_at = end.checked_add(formula)?;
        let note_end = note_at.checked_add(note)?;
        let labels_at = note_end.checked_add(units)?.checked_add(of_units)?;
        let labels_at = labels_at.checked_add(of_labels[0])?;
        let labels = bytes.get(labels_at..labels_at.checked_add(of_labels[1])?)?;
        // The first label is of all columns together.
        let labels = labels.chunks(LABEL).skip(1).map(|label| {
            let end = label
                .iter()
                .position(|byte| *byte == 0)
                .unwrap_or(label.len());
            String::from_utf8_lossy(&label[..end]).into_owned()
        });
        Some(Self {
            rows,
            numbers,
            labels: labels.collect(),
            note: String::from_utf8_lossy(bytes.get(note_at..note_end)?).into_owned(),
            step_s: bytes
                .get(64 + 152..64 + 154)
                .filter(|unit| *unit == b"s\0")
                .map(|_| step),
        })
    }

    fn column(&self, name: &str) -> Option<Vec<f64>> {
        let place = self.labels.iter().position(|label| label == name)?;
        Some(
            self.numbers
                .get(place * self.rows..(place + 1) * self.rows)?
                .to_vec(),
        )
    }

    fn setting(&self, name: &str) -> Option<f64> {
        let lines = self.note.split(['\r', '\n']);
        let pairs = lines.filter_map(|line| line.split_once(':'));
        let found = pairs.into_iter().find(|(key, _)| *key == name)?;
        found.1.trim().parse().ok()
    }
}
