//! Tabulated materials taken as they are: the direct hereditary sum through the program, beside the fitted series.

use crate::prelude::*;

/// Creep compliance of PMMA, twenty samples per decade from 0.1 s to 1000 s, off by up to 0.5 % either way.
fn creep_csv() -> String {
    let material = pmma_material();
    let row = |i: i32| {
        let time_s = 0.1 * 10_f64.powf(f64::from(i) / 20.0);
        // Fractional parts of multiples of the golden ratio: even, and without order.
        let noise = 5e-3 * (2.0 * (f64::from(i) * 0.618_033_988_749_895).fract() - 1.0);
        let value = material.creep().compliance(time_s) * (1.0 + noise);
        format!("{time_s},{value:.5e}\n")
    };
    let rows: String = (0..=80).map(row).collect();
    format!("time_s,creep_compliance_per_pa\n{rows}")
}

/// A step, an unloading to zero, and a sine: the contact opens and is met again.
const SCENARIO: &str = include_str!("../inputs/tabulated.toml");

fn place() -> Place {
    let place = Place::with("scenario.toml", SCENARIO);
    place.put("creep.csv", creep_csv());
    place
}

/// Runs `simulate`; what it printed.
fn simulate(place: &Place, file: &str, out: &str, flags: &str) -> String {
    let run = format!("simulate {file} --out {out} {flags}");
    place.done(&run).stdout
}

/// (time, approach, contact radius) at every instant in contact.
fn history(place: &Place, out: &str) -> Vec<[f64; 3]> {
    let table = place.table(&format!("{out}/history.csv"));
    let columns = ["time_s", "approach_m", "contact_radius_m"].map(|name| table.found(name));
    let rows = (0..table.len()).filter(|row| columns[1][*row].is_some());
    rows.map(|row| columns.each_ref().map(|column| column[row].unwrap()))
        .collect()
}

/// The largest misfit, relative to the data, in what was printed.
fn reported_misfit(printed: &str) -> f64 {
    let printed = words(printed);
    let (_, misfit) = printed.split_once("Misfit relative to the data").unwrap();
    let (before, _) = misfit.split_once("% at most").unwrap();
    let percent = before.split_whitespace().last().unwrap();
    0.01 * percent.parse::<f64>().unwrap()
}

const DIRECT: &str = "--set material.table.evaluation=direct";

#[test]
fn fit_and_direct_sum_agree_within_what_fit_and_interpolation_leave_open() {
    let place = place();
    let step = "--set 'time.step=1 s'";
    let fitted = simulate(&place, "scenario.toml", "fit", step);
    let run = format!("simulate scenario.toml --out direct {step} {DIRECT}");
    let run = place.done(&run).fits_eighty();
    run.says(&["No fit: 81 samples", "by the direct hereditary sum"]);
    let misfit = reported_misfit(&fitted);
    let integral =
        |out: &str| place.json(&format!("{out}/summary.json"))["hereditary_integral"].take();
    assert_eq!(integral("fit"), "fitted series");
    assert_eq!(integral("direct"), "direct sum");
    let (a, b) = (history(&place, "fit"), history(&place, "direct"));
    assert_eq!(a.len(), b.len());
    let apart = |k: usize, end_s: f64| {
        let pairs = a.iter().zip(&b).filter(|(a, _)| a[0] <= end_s);
        largest(pairs.map(|(a, b)| (a[k] - b[k]).abs())) / largest(a.iter().map(|row| row[k]))
    };
    let (held, whole, radius) = (apart(1, 100.0), apart(1, 400.0), apart(2, 400.0));
    // Under the first load the approach goes with the power 2/3 of the compliance. A load taken off adds its own share of the
    // misfit to that of the load put on. The radius goes with 1/3.
    below!(held, misfit);
    below!(radius, misfit);
    below!(whole, 2.0 * misfit);
    // They are not the same computation.
    assert!(held > 0.01 * misfit, "{held:e}");
}

#[test]
fn the_resolved_scenario_shows_the_samples_and_gives_the_same_history_again_without_the_table() {
    let place = place();
    simulate(&place, "scenario.toml", "first", DIRECT);
    fs::remove_file(place.path("creep.csv")).unwrap();
    let samples = "evaluation = \"direct\"\ntimes = [0.1, ";
    says(&place.text("first/resolved.toml"), &[samples]);
    simulate(&place, "first/resolved.toml", "second", "");
    for name in ["resolved.toml", "history.csv", "summary.json"] {
        place.are_same(&["first", "second"], name);
    }
    // The same samples, fitted.
    let fit = DIRECT.replace("direct", "fit");
    let fitted = simulate(&place, "first/resolved.toml", "third", &fit);
    says(&fitted, &["Fit of 2 branches"]);
}

#[test]
fn steps_chosen_by_the_program_are_as_good_with_samples_as_steps_that_are_four_times_shorter() {
    let place = place();
    simulate(&place, "scenario.toml", "chosen", DIRECT);
    let short = format!("{DIRECT} --set 'time.step=0.25 s'");
    simulate(&place, "scenario.toml", "short", &short);
    let (chosen, short) = (history(&place, "chosen"), history(&place, "short"));
    let largest = largest(short.iter().map(|row| row[1]));
    let mut compared = 0;
    for row in &chosen {
        if let Some(other) = short.iter().rfind(|other| (other[0] - row[0]).abs() < 1e-9) {
            below!((row[1] - other[1]).abs() / largest, 2e-4, "{row:?}");
            compared += 1;
        }
    }
    assert!(compared > 5, "{compared}");
}

#[test]
fn the_half_space_engine_takes_samples_too() {
    let place = place();
    let segments = "[{ kind = \"step\", to = 10, duration = 100 }, { kind = \"ramp\", to = 2, duration = 20 }]";
    let short = format!("{DIRECT} --set 'drive.segments={segments}' --set 'time.step=5 s'");
    simulate(&place, "scenario.toml", "springs", &short);
    let cells = format!("{short} --set solver.engine=half-space --set solver.cells=32");
    simulate(&place, "scenario.toml", "cells", &cells);
    let (a, b) = (history(&place, "springs"), history(&place, "cells"));
    for (a, b) in a.iter().zip(&b) {
        // 32 cells across: the engines are this far apart on a series as well.
        near!(a[1], b[1], 1e-3, "{a:?}");
    }
}

/// That the sweep refuses the samples themselves: tests/refused.
#[test]
fn a_sweep_that_cannot_take_samples_directly_shows_the_fit_and_takes_that() {
    let place = place();
    let head = SCENARIO.split("[drive]").next().unwrap();
    let head = head.replace("modulus =", "evaluation = \"direct\"\nmodulus =");
    let rest = "[drive]\nmean = 10\namplitude = 5\n[sweep]\nangular_frequency = [0.01]\n[cycle]\nsteps = 20\n";
    place.put("sweep.toml", format!("{head}{rest}"));
    let shown = place.done("material show sweep.toml");
    shown.says(&["Misfit relative to the data"]);
    place.done("sweep sweep.toml --set material.table.evaluation=fit");
}
