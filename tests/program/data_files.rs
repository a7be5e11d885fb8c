//! Data files that can be used with reservations, which are said, and those that are refused by what their numbers are. What is wrong
//! with them as tables: tests/refused.

#![cfg(feature = "cli")]

use crate::common::pmma_material;
use crate::program::{Place, words};
use std::path::Path;

use contact_dma::input::dynamic;
use contact_dma::material::ModulusKind;

#[test]
fn a_fit_to_noisy_gappy_or_short_data_says_what_it_did_and_impossible_data_are_refused() {
    let creep = pmma_material();
    let value = |time_s: f64| creep.creep().compliance(time_s);
    let times: Vec<f64> = (0..=40)
        .map(|i| 0.1 * 10_f64.powf(f64::from(i) / 10.0))
        .collect();
    let rows = |change: &dyn Fn(usize, f64) -> f64| -> Vec<(f64, f64)> {
        let rows = times.iter().enumerate();
        rows.map(|(i, &t)| (t, value(t) * change(i, t))).collect()
    };
    let clean = rows(&|_, _| 1.0);
    let is_apart = |(t, _): &(f64, f64)| *t < 1.0 || *t > 50.0;
    let gappy: Vec<_> = clean.iter().copied().filter(is_apart).collect();
    let short = (0..=10).map(|i| 5.0 + f64::from(i));
    let short: Vec<_> = short.map(|t| (t, value(t))).collect();
    let falling: Vec<_> = times.iter().map(|&t| (t, 1.0 / value(t) * 1e-19)).collect();
    for (rows, code, parts) in [
        (clean.clone(), 0, &[][..]),
        // Every other sample 0.6 % too high or too low: the data fall here and there.
        (
            rows(&|i, _| if i % 2 == 0 { 1.006 } else { 0.994 }),
            0,
            &[
                "wrong side of an earlier one",
                "taken for noise",
                "Misfit relative to the data: 0.6",
            ],
        ),
        // One dropped by a hand's breadth: no noise.
        (
            rows(&|i, _| if i >= 30 { 0.6 } else { 1.0 }),
            2,
            &["falls by", "row 31"],
        ),
        (
            gappy,
            0,
            &["Warning: no sample between", "decades", "are guessed"],
        ),
        (
            short,
            0,
            &[
                "Warning: the data cover 0.48 decades of time only",
                "the data begin at 5 s",
            ],
        ),
        (clean[..3].to_vec(), 2, &["too few samples, 3"]),
        // Falling all the way, and negative: no passive material.
        (falling, 2, &["falls by", "which no passive material does"]),
        (
            rows(&|i, _| if i == 5 { -1.0 } else { 1.0 }),
            2,
            &["greater than zero"],
        ),
    ] {
        let rows: String = rows.iter().map(|(t, v)| format!("{t},{v}\n")).collect();
        let table = format!("time_s,creep_compliance_per_pa\n{rows}");
        let place = Place::with("data.csv", &table);
        let fit =
            "material fit data.csv --quantity creep --modulus longitudinal --poisson-ratio 0.38";
        let run = place.run(fit).ended(code);
        let said = words(&(run.stdout + &run.stderr));
        for part in parts {
            assert!(said.contains(part), "{part:?} is missing in:\n{said}");
        }
        assert!(!parts.is_empty() || !said.contains("Warning"), "{said}");
    }
}

#[test]
fn the_measured_isotherms_of_pyvisco_are_read_from_their_file() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/pyvisco-freq-user-raw.csv");
    let file = dynamic::read(&[path], None, ModulusKind::Longitudinal).unwrap();
    assert_eq!(file.format.name(), "pyvisco");
    let isotherms = file.data.isotherms();
    assert_eq!(isotherms.len(), 21);
    assert!(isotherms.iter().all(|isotherm| isotherm.points.len() == 10));
    let [first, last] = [0, 20].map(|place: usize| isotherms[place].temperature_k.unwrap());
    assert!(
        (first - 223.24).abs() < 0.01 && (last - 373.1).abs() < 0.2,
        "{first} {last}"
    );
    let notes = file.notes.join("\n");
    assert!(notes.contains("210 points in 21 isotherms"), "{notes}");
}
