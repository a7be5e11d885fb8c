//! Data files that can be used with reservations, which are said, and those that are refused by what their numbers are. What is wrong
//! with them as tables: tests/refused.

use crate::prelude::*;
use contact_dma::input::dynamic;
use contact_dma::material::ModulusKind;

#[test]
fn a_fit_to_noisy_gappy_or_short_data_says_what_it_did_and_impossible_data_are_refused() {
    let creep = pmma_material();
    let value = |time_s: f64| creep.creep().compliance(time_s);
    let times = log_spaced(0.1, 1e3, 41);
    let rows = |change: &dyn Fn(usize, f64) -> f64| -> Vec<(f64, f64)> {
        let rows = times.iter().enumerate();
        rows.map(|(i, &t)| (t, value(t) * change(i, t))).collect()
    };
    let clean = rows(&|_, _| 1.0);
    let is_apart = |(t, _): &(f64, f64)| *t < 1.0 || *t > 50.0;
    let gappy: Vec<_> = clean.iter().copied().filter(is_apart).collect();
    let short: Vec<_> = (5..=15)
        .map(|t| (f64::from(t), value(f64::from(t))))
        .collect();
    let falling: Vec<_> = times.iter().map(|&t| (t, 1.0 / value(t) * 1e-19)).collect();
    // Every other sample 0.6 % too high or too low: the data fall here and there. And one dropped by a hand's breadth: no noise.
    let noisy = rows(&|i, _| if i % 2 == 0 { 1.006 } else { 0.994 });
    let dropped = rows(&|i, _| if i >= 30 { 0.6 } else { 1.0 });
    let negative = rows(&|i, _| if i == 5 { -1.0 } else { 1.0 });
    let noise = "wrong side of an earlier one|taken for noise|Misfit relative to the data: 0.6";
    let guessed = "Warning: no sample between|decades|are guessed";
    let little = "Warning: the data cover 0.48 decades of time only|the data begin at 5 s";
    for (rows, code, parts) in [
        (clean.clone(), 0, ""),
        (noisy, 0, noise),
        (dropped, 2, "falls by|row 31"),
        (gappy, 0, guessed),
        (short, 0, little),
        (clean[..3].to_vec(), 2, "too few samples, 3"),
        // Falling all the way: no passive material.
        (falling, 2, "falls by|which no passive material does"),
        (negative, 2, "greater than zero"),
    ] {
        let rows: String = rows.iter().map(|(t, v)| format!("{t},{v}\n")).collect();
        let table = format!("time_s,creep_compliance_per_pa\n{rows}");
        let place = Place::with("data.csv", &table);
        let fit =
            "material fit data.csv --quantity creep --modulus longitudinal --poisson-ratio 0.38";
        let run = place.run(fit).ended(code);
        let said = words(&(run.stdout + &run.stderr));
        says(&said, &parts.split('|').collect::<Vec<_>>());
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
    below!((first - 223.24).abs(), 0.01);
    below!((last - 373.1).abs(), 0.2);
    says(&file.notes.join("\n"), &["210 points in 21 isotherms"]);
}
