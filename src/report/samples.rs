//! What is said of samples that are taken as they are.

use super::text::Text;
use crate::material::MaterialFunction;
use crate::material::sampled::Sampled;
use crate::quantity::{Dimension, format_human};

/// That there was no fit, what is odd about the samples, and where a history of this length (s) leaves them.
pub fn text(sampled: &Sampled, duration_s: f64) -> Text {
    let table = sampled.table();
    let name = match table.function() {
        MaterialFunction::Creep => "creep compliance",
        MaterialFunction::Relaxation => "relaxation modulus",
    };
    let count = table.times_s().len();
    let mut lines = vec![format!(
        "No fit: {count} samples of the {name} taken as they are, by the direct hereditary sum"
    )];
    let warnings = table.warnings().iter();
    lines.extend(warnings.map(|warning| match warning.is_warning() {
        true => format!("Warning: {warning}"),
        false => format!("Note: {warning}"),
    }));
    let time = |time_s: f64| format_human(time_s, Dimension::Time, 4);
    if let Some(&first_s) = table.times_s().first().filter(|first_s| **first_s > 0.0) {
        let first = time(first_s);
        lines.push(format!(
            "Note: the data begin at {first}: the compliance keeps its first value before, so that anything faster is taken for \
             instantaneous"
        ));
    }
    if let Some(&last_s) = table
        .times_s()
        .last()
        .filter(|last_s| **last_s < duration_s)
    {
        let (last, end) = (time(last_s), time(duration_s));
        lines.push(format!(
            "Warning: the data end at {last} and the history at {end}: the compliance keeps its last value after"
        ));
    }
    lines.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::ModulusKind;
    use crate::material::tabulated::Tabulated;

    #[test]
    fn what_the_samples_do_not_cover_is_said() {
        let (times, values) = (vec![1.0, 10.0, 100.0, 1000.0], vec![1e-9, 2e-9, 3e-9, 4e-9]);
        let of = |times: Vec<f64>| {
            let kind = ModulusKind::Shear;
            let table =
                Tabulated::new(MaterialFunction::Creep, kind, times, values.clone()).unwrap();
            Sampled::new(table, 0.5).unwrap()
        };
        let covered = text(&of(vec![0.0, 10.0, 100.0, 1000.0]), 1000.0).to_string();
        assert_eq!(covered.matches('\n').count(), 2, "{covered}");
        assert!(covered.contains("4 samples of the creep compliance"));
        let longer = text(&of(times), 2000.0).to_string();
        for part in ["begin at 1", "Warning: the data end at 1000", "2000"] {
            assert!(longer.contains(part), "{part} is missing in:\n{longer}");
        }
        assert!(longer.lines().all(|line| line.chars().count() <= 80));
    }
}
