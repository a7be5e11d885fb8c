//! `edge = "periodic"` in the files: a patch of a rough surface that repeats itself, and what is refused.

use crate::prelude::*;

const SWEEP: &str = include_str!("../inputs/rough.toml");

const ONE: &str = "angular_frequency = [\"0.01 rad/s\"]";

#[test]
fn a_patch_that_repeats_itself_is_pressed_beyond_what_its_edge_would_allow() {
    let place = Place::new();
    let table = place.swept(SWEEP);
    let resolved = place.text("out/resolved.toml");
    assert!(resolved.contains("edge = \"periodic\""));
    assert_eq!(place.swept(&resolved), table);
    // 24 MPa on average: the contact of a single patch reaches its edge.
    place.put("single.toml", SWEEP.replace("\nedge = \"periodic\"", ""));
    place.run("sweep single.toml").ended(3);
}

#[test]
fn a_mean_pressure_is_the_load_over_the_area_of_a_period() {
    let place = Place::new();
    let load = "mean = \"0.1 N\"\namplitude = \"0.05 N\"";
    // A patch of 64 by 64 um.
    let area_m2 = (32.0 * 2e-6) * (32.0 * 2e-6);
    let [mean, amplitude] = [0.1 / area_m2, 0.05 / area_m2];
    let pressure = format!("control = \"pressure\"\nmean = {mean:?}\namplitude = {amplitude:?}");
    let loss_j = |text: &str| place.swept(text).number(0, "energy_loss_j");
    // The loads are a rounding apart, and what is within the tolerance of the instants depends on the rounding.
    let exactly = format!("{SWEEP}\n[solver]\ntolerance = 1e-11\n");
    let by_load = loss_j(&exactly);
    let by_pressure = loss_j(&exactly.replace(load, &pressure));
    near!(by_pressure, by_load, 1e-9);
    // The resolved file tells the load, and is the same sweep again.
    let resolved = place.text("out/resolved.toml");
    says(&resolved, &["control = \"load\""]);
    assert_eq!(loss_j(&resolved), by_pressure);
    // As an axis too.
    let axis = format!("{ONE}\ndrive.mean = [\"20 MPa\", \"30 MPa\"]");
    let over = place.swept(&SWEEP.replace(load, &pressure).replace(ONE, &axis));
    near!(over.number(0, "drive_mean"), 20e6 * area_m2, 1e-12);
}

#[test]
fn every_kind_of_segment_may_be_a_mean_pressure() {
    let area_m2 = (32.0 * 2e-6) * (32.0 * 2e-6);
    let place = Place::new();
    let of = |control: &str, one: f64| {
        let unit = if control == "load" { "N" } else { "Pa" };
        let (head, _) = SWEEP.split_once("[drive]").unwrap();
        let history = format!(
            "{head}[drive]\ncontrol = \"{control}\"\n\
             segments = [\n{{ kind = \"ramp\", to = \"{one:?} {unit}\", duration = \"1 s\" }},\n\
             {{ kind = \"step\", to = \"{:?} {unit}\", duration = \"1 s\" }},\n\
             {{ kind = \"sine\", mean = {one:?}, amplitude = {:?}, frequency = 1, cycles = 1 }},\n\
             {{ kind = \"polynomial\", coefficients = [{one:?}, {:?}], duration = \"1 s\" }},\n\
             {{ kind = \"table\", times = [0, 1], values = [{one:?}, {:?}] }}]\n\
             [time]\nstep = \"0.1 s\"\n[output]\nerror_bars = false\n",
            0.5 * one,
            0.2 * one,
            0.1 * one,
            0.7 * one,
        );
        place.put("history.toml", &history);
        place.done(&format!("simulate history.toml --quiet --out {control}"));
        let resolved = place.text(&format!("{control}/resolved.toml"));
        assert!(resolved.contains("control = \"load\""));
        let table = place.table(&format!("{control}/history.csv"));
        let approach = table.found("approach_m").into_iter().flatten();
        approach.collect::<Vec<f64>>()
    };
    let (by_load, by_pressure) = (of("load", 0.1), of("pressure", 0.1 / area_m2));
    assert!(by_load.len() == by_pressure.len() && by_load.len() > 40);
    for (load, pressure) in by_load.iter().zip(&by_pressure) {
        // Rounding of the loads, through the tolerance of an instant.
        below!((load - pressure).abs(), 1e-6 * load.abs() + 1e-15);
    }
}
