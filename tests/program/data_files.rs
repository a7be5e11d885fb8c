//! Data files that cannot be used, or only with reservations, through the program: drive tables, height maps, profiles and tables
//! of measured compliance. Each message names file and place and says what to do.

#![cfg(feature = "cli")]

use crate::program::{program, write};
use std::path::Path;

use contact_dma::input::dynamic;
use contact_dma::material::{ModulusKind, library};
use tempfile::TempDir;

/// `material fit` of a creep compliance; exit code, and what was printed, on one line.
fn fit(rows: &[(f64, f64)]) -> (Option<i32>, String) {
    let folder = TempDir::new().unwrap();
    let rows: String = rows.iter().map(|(t, v)| format!("{t},{v}\n")).collect();
    write(
        &folder,
        "data.csv",
        &format!("time_s,creep_compliance_per_pa\n{rows}"),
    );
    let output = program()
        .current_dir(folder.path())
        .args(["material", "fit", "data.csv", "--quantity", "creep"])
        .args(["--modulus", "longitudinal", "--poisson-ratio", "0.38"])
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].concat();
    let text = String::from_utf8(text).unwrap();
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    (output.status.code(), words)
}

#[test]
fn a_fit_to_noisy_gappy_or_short_data_says_what_it_did_and_impossible_data_are_refused() {
    let creep = library::find("pmma").unwrap().material().unwrap();
    let value = |time_s: f64| creep.creep().compliance(time_s);
    let times: Vec<f64> = (0..=40)
        .map(|i| 0.1 * 10_f64.powf(f64::from(i) / 10.0))
        .collect();
    let rows = |change: &dyn Fn(usize, f64) -> f64| -> Vec<(f64, f64)> {
        let rows = times.iter().enumerate();
        rows.map(|(i, &t)| (t, value(t) * change(i, t))).collect()
    };
    let clean = rows(&|_, _| 1.0);
    let (code, text) = fit(&clean);
    assert_eq!(code, Some(0), "{text}");
    assert!(!text.contains("Warning"), "{text}");

    // Every other sample 0.6 % too high or too low: the data fall here and there.
    let (code, text) = fit(&rows(&|i, _| if i % 2 == 0 { 1.006 } else { 0.994 }));
    assert_eq!(code, Some(0), "{text}");
    for part in [
        "wrong side of an earlier one",
        "taken for noise",
        "Misfit relative to the data: 0.6",
    ] {
        assert!(text.contains(part), "{part:?} is missing in:\n{text}");
    }
    // One dropped by a hand's breadth: no noise.
    let (code, text) = fit(&rows(&|i, _| if i >= 30 { 0.6 } else { 1.0 }));
    assert_eq!(code, Some(2), "{text}");
    assert!(
        text.contains("falls by") && text.contains("row 31"),
        "{text}"
    );

    let gappy: Vec<_> = clean
        .iter()
        .copied()
        .filter(|(t, _)| *t < 1.0 || *t > 50.0)
        .collect();
    let (code, text) = fit(&gappy);
    assert_eq!(code, Some(0), "{text}");
    for part in ["Warning: no sample between", "decades", "are guessed"] {
        assert!(text.contains(part), "{part:?} is missing in:\n{text}");
    }

    let short: Vec<_> = (0..=10)
        .map(|i| 5.0 + f64::from(i))
        .map(|t| (t, value(t)))
        .collect();
    let (code, text) = fit(&short);
    assert_eq!(code, Some(0), "{text}");
    for part in [
        "Warning: the data cover 0.48 decades of time only",
        "the data begin at 5 s",
    ] {
        assert!(text.contains(part), "{part:?} is missing in:\n{text}");
    }
    let (code, text) = fit(&clean[..3]);
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("too few samples, 3"), "{text}");

    // Falling all the way, negative, twice the same time: no passive material, no table.
    let falling: Vec<_> = times.iter().map(|&t| (t, 1.0 / value(t) * 1e-19)).collect();
    let (code, text) = fit(&falling);
    assert_eq!(code, Some(2), "{text}");
    assert!(
        text.contains("no passive material") || text.contains("falls"),
        "{text}"
    );
    let (code, text) = fit(&rows(&|i, _| if i == 5 { -1.0 } else { 1.0 }));
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("greater than zero"), "{text}");
}

#[test]
fn the_measured_isotherms_of_pyvisco_are_read_from_their_file() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/pyvisco-freq-user-raw.csv");
    let file = dynamic::read(&[path], None, ModulusKind::Longitudinal).unwrap();
    assert_eq!(file.format.name(), "pyvisco");
    let isotherms = file.data.isotherms();
    assert_eq!(isotherms.len(), 21);
    assert!(isotherms.iter().all(|isotherm| isotherm.points.len() == 10));
    let temperatures: Vec<f64> = isotherms
        .iter()
        .filter_map(|isotherm| isotherm.temperature_k)
        .collect();
    assert!(
        (temperatures[0] - 223.24).abs() < 0.01 && (temperatures[20] - 373.1).abs() < 0.2,
        "{temperatures:?}"
    );
    assert!(
        file.notes
            .iter()
            .any(|note| note.contains("210 points in 21 isotherms")),
        "{:?}",
        file.notes
    );
}
