//! A sweep that adds frequencies where its own do not resolve the curve, and a sweep of two axes.

use crate::prelude::*;

/// Six points over five decades.
const RUN: &str = "sweep few.toml --quiet --no-figures --out out";

/// The sweep's table after a run with a key changed.
fn table(set: &str) -> Table {
    let place = Place::lent("few.toml");
    place.done(&format!("{RUN} {set}"));
    place.table("out/sweep.csv")
}

#[test]
fn frequencies_are_added_about_the_peaks_and_stand_in_their_order() {
    assert_eq!(table("").len(), 6);
    let refined = table("--set sweep.refine=true");
    let omega = refined.numbers("angular_frequency_rad_per_s");
    assert!(omega.is_sorted_by(|a, b| a < b));
    // The spectrum of PMMA lies between 1e-3 and 1 rad/s: there, and not at the ends, points are added.
    let added = omega.iter().filter(|omega| (1e-3..1.0).contains(*omega));
    let added = added.count();
    assert!(added >= 8, "{added} points inside");
    assert!(refined.len() < 40, "{} points", refined.len());
    // Both peaks and the valley between them, which six points do not show, are there.
    let losses = refined.numbers("energy_loss_j");
    let peaks = losses.windows(3).filter(|w| w[1] > w[0] && w[1] > w[2]);
    assert_eq!(peaks.count(), 2, "{losses:?}");
}

#[test]
fn a_second_run_finds_the_frequencies_that_the_first_has_added() {
    let place = Place::lent("few.toml");
    let run = || {
        place.done(&format!("{RUN} --set sweep.refine=true"));
        let run = place.json("out/run.json");
        ["cases_computed", "cases_found"].map(|key| run[key].as_u64().unwrap())
    };
    let [computed, found] = run();
    assert!(computed > 6 && found == 0, "{computed} {found}");
    assert_eq!(run(), [0, computed]);
}
