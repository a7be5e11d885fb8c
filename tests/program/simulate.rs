//! Single drive histories: scenario files, closed forms, both controls, what is written and what is refused.

use crate::prelude::*;
use contact_dma::reference::transient::maxwell_half_sine_cubed_radius;
use contact_dma::simulation::{HistoryRow, SimulationOutcome};

/// Zener body of equal springs, C_0 = 2.5e-7 1/Pa and tau = 10 s, under a sphere of 10 mm.
const ZENER: &str = include_str!("../inputs/zener.toml");
const COMPLIANCE: f64 = 2.5e-7;
const TAU_S: f64 = 10.0;
const RADIUS_M: f64 = 0.01;

/// The same with a Maxwell body, C = C_0 (1 + t/tau).
fn maxwell() -> String {
    ZENER.replace(
        "[material.zener]\nspring = \"1 MPa\"\nkelvin_spring = \"1 MPa\"",
        "[material.maxwell]\nmodulus = \"1 MPa\"",
    )
}

fn drive(control: &str, segments: &str) -> String {
    format!("[drive]\ncontrol = \"{control}\"\nsegments = [{segments}]\n")
}

fn run(text: &str) -> SimulationOutcome {
    followed(&plans::history(text))
}

/// The rows of a history, and of one under a load of these segments.
fn rows(text: &str) -> Vec<HistoryRow> {
    run(text).rows
}

fn under_load(material: &str, segments: &str) -> Vec<HistoryRow> {
    rows(&format!("{material}{}", drive("load", segments)))
}

/// Zener: C(t), and its integral from 0 to t.
fn creep(t: f64) -> f64 {
    COMPLIANCE * (2.0 - (-t / TAU_S).exp())
}

fn integrated_creep(t: f64) -> f64 {
    COMPLIANCE * (2.0 * t + TAU_S * (-t / TAU_S).exp_m1())
}

/// a from (4/3) a^3 / R = integral of C dW.
fn contact_radius_m(integral: f64) -> f64 {
    hertz_radius_m(RADIUS_M, 1.0, integral)
}

#[test]
fn a_step_and_a_ramp_follow_lee_and_radok_at_every_time_step() {
    let step = "{ kind = \"step\", to = \"1 N\", duration = \"100 s\" }";
    for row in under_load(ZENER, step) {
        let a = contact_radius_m(creep(row.time_s));
        // The edge lies between a spring that remembers and one that does not: known to a part of their distance, a/390. The
        // approach rests on the sum of the forces, which knows no error of time: (1/400)^2 and less.
        near!(row.contact_radius_m, a, 1e-3, "{row:?}");
        near!(row.approach_m.unwrap(), a * a / RADIUS_M, 1e-5);
    }
    let ramp = "{ kind = \"ramp\", to = \"1 N\", duration = \"30 s\" }";
    let rows = under_load(ZENER, ramp);
    assert_eq!((rows[0].load_n, rows[0].approach_m), (0.0, Some(0.0)));
    for row in &rows {
        let a = contact_radius_m(integrated_creep(row.time_s) / 30.0);
        let largest = contact_radius_m(integrated_creep(30.0) / 30.0);
        // A contact of a few springs is known to their width; the largest has 392.
        assert!((row.contact_radius_m - a).abs() < 1e-3 * largest, "{row:?}");
        let approach_m = a * a / RADIUS_M;
        let largest_m = largest * largest / RADIUS_M;
        assert!((row.approach_m.unwrap() - approach_m).abs() < 1e-4 * largest_m);
    }
}

#[test]
fn half_a_sine_on_a_fluid_follows_ting_past_the_maximum() {
    let omega = 1.0 / TAU_S;
    let half = format!(
        "{{ kind = \"sine\", mean = 0, amplitude = \"1 N\", angular_frequency = {omega}, cycles = 0.5 }}"
    );
    let rows = under_load(&maxwell(), &half);
    let hertz_m = contact_radius_m(COMPLIANCE);
    for row in &rows {
        let exact = hertz_m * maxwell_half_sine_cubed_radius(row.time_s * omega).cbrt();
        // Known to a spring near the end, where the radius falls to zero like a root.
        let off_m = (row.contact_radius_m - exact).abs();
        below!(off_m, 3e-3 * hertz_m, "{row:?}");
    }
    // It begins and ends with a touch at zero load; the approach at the end is what the body has kept.
    let last = rows.last().unwrap();
    assert_eq!((rows[0].approach_m, last.load_n), (Some(0.0), 0.0));
    assert!(last.approach_m.unwrap() > 0.5 * hertz_m * hertz_m / RADIUS_M);
}

#[test]
fn segments_meet_exactly_and_a_jump_is_two_states_at_one_time() {
    let segments = "{ kind = \"step\", to = \"1 N\", duration = \"5 s\" },
         { kind = \"step\", to = \"0.25 N\", duration = \"5 s\" },
         { kind = \"polynomial\", coefficients = [0.25, 0.05, 0.01], duration = \"3 s\" },
         { kind = \"sine\", mean = \"0.5 N\", amplitude = \"0.2 N\", frequency = \"0.5 Hz\", cycles = 2 },
         { kind = \"table\", times = [0, 1, 1, 2], values = [0.5, 0.7, 0.1, 0.1] }";
    let rows = under_load(ZENER, segments);
    let at = |time_s: f64| -> Vec<f64> {
        let found = rows.iter().filter(|r| (r.time_s - time_s).abs() < 1e-9);
        found.map(|r| (1e9 * r.load_n).round() / 1e9).collect()
    };
    assert_eq!(at(0.0), [1.0]);
    assert_eq!(at(5.0), [1.0, 0.25]);
    assert_eq!(at(10.0), [0.25]);
    // 0.25 + 0.15 + 0.09, then the sine's mean.
    assert_eq!(at(13.0), [0.49, 0.5]);
    assert_eq!(at(17.0), [0.5]);
    assert_eq!(at(18.0), [0.7, 0.1]);
    assert_eq!(at(19.0), [0.1]);
    // At the jump the surface springs back at once: all springs lose the same force (elastic, C_0).
    let mut pairs = rows.windows(2);
    let jump = pairs.find(|p| p[1].time_s == p[0].time_s).unwrap();
    assert!(jump[1].approach_m.unwrap() < jump[0].approach_m.unwrap());
    assert!(rows.windows(2).all(|p| p[1].time_s >= p[0].time_s));
}

#[test]
fn the_approach_is_undefined_out_of_contact_but_not_where_the_load_just_touches_zero() {
    let touching = "{ kind = \"sine\", mean = \"0.5 N\", amplitude = \"0.5 N\", frequency = \"0.1 Hz\", phase = \"-90 deg\", cycles = 2 }";
    let touching = under_load(ZENER, touching);
    assert!(touching.iter().all(|r| r.approach_m.is_some()));
    assert_eq!(touching.iter().filter(|r| r.load_n == 0.0).count(), 3);
    let resting = "{ kind = \"ramp\", to = \"1 N\", duration = \"5 s\" }, { kind = \"ramp\", to = 0, duration = \"5 s\" },
         { kind = \"step\", to = 0, duration = \"5 s\" }, { kind = \"ramp\", to = \"1 N\", duration = \"5 s\" }";
    let resting = under_load(ZENER, resting);
    for row in &resting[1..] {
        assert_eq!(row.approach_m.is_none(), row.load_n == 0.0, "{row:?}");
        assert_eq!(row.contact_radius_m == 0.0, row.load_n == 0.0);
        assert_eq!(row.peak_pressure_pa == Some(0.0), row.load_n == 0.0);
    }
    assert!(resting.iter().filter(|r| r.load_n == 0.0).count() > 10);
    // Met again, the surface is still dented: the same load goes deeper than the first time.
    let at_one = |row: &&HistoryRow| row.load_n == 1.0;
    let [first, last] = [resting.iter().find(at_one), resting.iter().rfind(at_one)]
        .map(|row| row.unwrap().approach_m.unwrap());
    assert!(last > 1.05 * first);
}

#[test]
fn a_retracted_indenter_carries_nothing_and_keeps_its_approach() {
    let segments = drive(
        "approach",
        "{ kind = \"step\", to = \"-20 um\", duration = \"1 s\" }, { kind = \"ramp\", to = \"100 um\", duration = \"5 s\" },
         { kind = \"step\", to = \"-1 mm\", duration = \"5 s\" }, { kind = \"step\", to = \"100 um\", duration = \"1 s\" }",
    );
    for solver in ["", "[solver]\nengine = \"half-space\"\ncells = 32\n"] {
        let rows = rows(&[ZENER, &segments, solver].concat());
        assert_eq!(rows[0].approach_m, Some(-20e-6));
        for row in &rows {
            let approach_m = row.approach_m.unwrap();
            if approach_m <= 0.0 {
                assert_eq!((row.load_n, row.contact_radius_m), (0.0, 0.0));
            }
        }
        let mut pairs = rows.windows(2);
        let jump = pairs.rfind(|p| p[0].time_s == p[1].time_s).unwrap();
        // Back at once to where it was: against a surface that has only partly recovered, less than on a fresh one.
        let fresh_n = 4.0 / 3.0 * (1e-4_f64 * RADIUS_M).powf(1.5) / RADIUS_M / COMPLIANCE;
        assert!(jump[1].load_n > 0.3 * fresh_n && jump[1].load_n < 0.99 * fresh_n);
    }
}

#[test]
fn halving_the_steps_chosen_by_a_factor_of_four_changes_little_and_of_second_order_where_given() {
    let segments = drive(
        "approach",
        "{ kind = \"sine\", mean = \"50 um\", amplitude = \"100 um\", angular_frequency = \"0.3 rad/s\", cycles = 1.5 }",
    );
    // Near the second crest.
    let output = "[output]\nprofiles_at = [\"26 s\"]\n[solver]\nsprings = 1000\n";
    let load_at_crest = |time: &str| {
        let outcome = run(&[ZENER, &segments, time, output].concat());
        outcome.profiles[0].row.load_n
    };
    let exact = load_at_crest("[time]\nstep = \"5 ms\"\n");
    near!(load_at_crest(""), exact, 1e-4);
    // The contact opens and closes between two steps, which does not spoil the order at the crest by much.
    let error = |step: &str| load_at_crest(&format!("[time]\nstep = \"{step}\"\n")) / exact - 1.0;
    let order = (error("0.4 s") / error("0.2 s")).abs().log2();
    assert!((1.5..2.6).contains(&order), "{order}");
}

#[test]
fn steps_far_longer_than_the_relaxation_time_follow_a_growing_contact() {
    // Glass to rubber 1000 to 1, relaxing in 1 s, and steps of 30 s while the contact grows.
    let material = ZENER.replace(
        "[material.zener]\nspring = \"1 MPa\"\nkelvin_spring = \"1 MPa\"\ntime = \"10 s\"",
        "[material.relaxation]\nmodulus = \"shear\"\nequilibrium = \"1 MPa\"\nbranches = [{ modulus = \"999 MPa\", time = \"1 s\" }]",
    );
    let slow = drive(
        "load",
        "{ kind = \"polynomial\", coefficients = [0.01, 1e-6], duration = \"5000 s\" }",
    );
    let outcome = run(&[&material, &slow, "[time]\nstep = \"30 s\"\n"].concat());
    // Lee and Radok with J from 1e-9 to 1e-6 1/Pa in a retardation time of 1000 s, and C = J/4.
    let spring_m = outcome.domain_half_width_m / 400.0;
    let rows = outcome.rows.iter().zip(&outcome.errors);
    for (row, errors) in rows.filter(|(row, _)| row.time_s > 300.0) {
        let left = (-row.time_s / 1000.0).exp();
        let (glassy, rubbery) = (1e-9, 1e-6);
        let creep = rubbery - (rubbery - glassy) * left;
        let integrated = rubbery * row.time_s - (rubbery - glassy) * 1000.0 * (1.0 - left);
        let exact = contact_radius_m(0.25 * (0.01 * creep + 1e-6 * integrated));
        // Steps thirty times the relaxation time leave the force of the spring just met too high or too low, so that the edge is
        // known to one spring (of the width at the end); and not worse than the row says.
        let off_m = (row.contact_radius_m - exact).abs();
        below!(off_m, spring_m, "{row:?}");
        below!(off_m, errors.contact_radius_m.unwrap(), "{row:?}");
    }
}

#[test]
fn the_domain_of_a_fluid_holds_its_contact_and_a_wrong_guess_is_mended() {
    let held = drive(
        "load",
        "{ kind = \"step\", to = \"1 N\", duration = \"1000 s\" }",
    );
    // A cell of 32 is a fifteenth of the radius; the area averages it. The springs are of second order in 1/400.
    let cells = "[solver]\nengine = \"half-space\"\ncells = 32\n";
    for (solver, tolerance) in [("", 2e-5), (cells, 0.03)] {
        let outcome = run(&[&maxwell(), &held, solver].concat());
        assert_eq!(outcome.domain_enlarged, 0);
        let last = outcome.rows.last().unwrap();
        let exact = contact_radius_m(COMPLIANCE * 101.0);
        near!(last.contact_radius_m, exact, tolerance, "{solver}");
    }
}

/// That springs refuse it with advice: tests/refused.
#[test]
fn an_indenter_whose_contact_is_a_ring_is_solved_on_the_half_space() {
    let ring = "r_m,gap_m\n0,2e-5\n1e-3,0\n2e-3,2e-5\n3e-3,8e-5\n5e-3,3.2e-4\n";
    let place = Place::with("ring.csv", ring);
    let text = ZENER.replace(
        "shape = \"sphere\"\nradius = \"10 mm\"",
        "shape = \"profile\"\nfile = \"ring.csv\"",
    ) + &drive(
        "load",
        "{ kind = \"step\", to = \"5 mN\", duration = \"5 s\" }",
    ) + "[output]\nprofiles_at = [\"5 s\"]\n";
    place.put("ring.toml", text);
    let run = "simulate ring.toml --set solver.cells=48 --out out";
    // Left to itself the program takes the half-space engine. The middle stays out of contact.
    place.done(run);
    let profile = place.table("out/cases/profiles/0.csv");
    let mut largest = (0.0, 0.0);
    for row in 0..profile.len() {
        let [x_m, pressure_pa, gap_m] =
            ["position_m", "pressure_pa", "gap_m"].map(|column| profile.number(row, column));
        if profile.cells("line")[row] != "x" {
            continue;
        }
        if x_m.abs() < 3e-4 {
            assert!(pressure_pa == 0.0 && gap_m > 1e-6, "{x_m}");
        }
        if pressure_pa > largest.1 {
            largest = (x_m.abs(), pressure_pa);
        }
    }
    assert!((0.8e-3..1.2e-3).contains(&largest.0), "{largest:?}");
}

#[test]
fn the_loss_of_a_flat_punch_under_an_imposed_approach_is_that_of_the_complex_modulus() {
    let material = ZENER.replace(
        "shape = \"sphere\"\nradius = \"10 mm\"",
        "shape = \"flat-punch\"\nradius = \"1 mm\"",
    );
    let rest = "[sweep]\nangular_frequency = [\"0.03 rad/s\", \"0.2 rad/s\", \"2 rad/s\"]\n\
                [cycle]\nsteps = 200\ntolerance = 1e-6\n[solver]\nsprings = 20\n";
    let place = Place::new();
    let text = |drive: &str| format!("{material}[drive]\n{drive}\n{rest}");
    let sweep = |drive: &str| place.swept(&text(drive));
    let approached = sweep("control = \"approach\"\nmean = \"10 um\"\namplitude = \"2 um\"");
    for row in 0..approached.len() {
        let omega = approached.number(row, "angular_frequency_rad_per_s");
        // The loads that make this approach, whose loss is that of the load.
        let contact = plans::sweep(&text("mean = 2\namplitude = 1")).base.contact;
        let compliance = contact.material.contact_compliance().unwrap();
        let under = |amplitude_n| harmonic((0.04, amplitude_n), omega, &compliance);
        let load_n = 2e-6 / under(1.0).flat_punch(1e-3).0;
        let loss_j = approached.number(row, "energy_loss_j");
        // Second order in 200 steps per cycle.
        near!(loss_j, under(load_n).flat_punch(1e-3).1, 2e-4, "{omega}");
        // Imposing the load amplitude that this approach takes dissipates the same.
        let loaded = sweep(&format!("mean = \"0.04 N\"\namplitude = \"{load_n} N\""));
        near!(loaded.number(row, "energy_loss_j"), loss_j, 4e-4, "{omega}");
    }
}

const SMALL: &str = include_str!("../inputs/step-ramp-sine.toml");

#[test]
fn a_scenario_prints_its_end_and_leaves_every_file() {
    let place = Place::with("small.toml", SMALL);
    let run = place.done("simulate small.toml").fits_eighty();
    let said = format!("{}{}", run.stdout, run.stderr);
    run.says(&[
        "Results in reports/small",
        "time steps",
        "± ",
        "Work of the indenter: ",
    ]);
    let read = |name: &str| place.text(&format!("reports/small/{name}"));
    let history = read("history.csv");
    assert!(history.starts_with(
        "time_s,load_n,approach_m,contact_radius_m,contact_area_m2,peak_pressure_pa,work_j,\
         load_error_n,approach_error_m,contact_radius_error_m,peak_pressure_error_pa,work_error_j\n0e0,1e1,"
    ));
    // Of some load that is prescribed, rounding; none of the rest is empty.
    let empty = |line: &str| line.split(',').any(str::is_empty);
    assert!(!history.lines().any(empty), "{history}");
    let profile = read("cases/profiles/1.csv");
    assert!(profile.starts_with("radius_m,pressure_pa,displacement_m,gap_m\n0e0,"));
    let index = read("cases/profiles/index.csv");
    assert!(index.lines().nth(2).unwrap().starts_with("1,2.5e1,2e0,"));
    let figures = "figures/history.svg figures/history@2x.png figures/profiles.svg figures/profiles.png figures/profiles.csv";
    place.has_all("reports/small", figures);
    // The figure of load against approach tells the work as the terminal does.
    let mut work = said
        .lines()
        .filter_map(|line| line.trim().strip_prefix("Work of the indenter: "));
    let work = work.next().unwrap().split(';').next().unwrap();
    let caption = read("figures/load-approach.caption.txt");
    let told = format!("the integral of W over δ along the path, is {work};");
    assert!(caption.contains(&told), "{caption} {told}");
    assert!(read("summary.json").contains("\"status\": \"done\""));
}

#[test]
fn a_folder_without_the_columns_of_the_work_is_drawn_again() {
    let place = Place::with("small.toml", SMALL);
    place.done("simulate small.toml --quiet --out old");
    let history = place.text("old/history.csv");
    let names: Vec<&str> = history.lines().next().unwrap().split(',').collect();
    let older = history.lines().map(|line| {
        let cells = line.split(',').zip(&names);
        let kept = cells.filter(|(_, name)| !name.starts_with("work_"));
        kept.map(|(cell, _)| cell).collect::<Vec<_>>().join(",") + "\n"
    });
    place.put("old/history.csv", older.collect::<String>());
    place.done("report old");
    // The history begins with a jump to a load, which rows do not tell.
    assert!(
        !place
            .text("old/index.html")
            .contains("work of the indenter")
    );
    let caption = place.text("old/figures/load-approach.caption.txt");
    assert!(!caption.contains("work of the indenter"), "{caption}");
}

#[test]
fn errors_are_left_out_where_nobody_asks_for_them_and_change_no_row() {
    let place = Place::with("small.toml", SMALL);
    let history = |out: &str, more: &str| {
        place.done(&format!("simulate small.toml --quiet --out {out} {more}"));
        let resolved = place.text(&format!("{out}/resolved.toml"));
        assert_eq!(resolved.contains("error_bars = false"), !more.is_empty());
        place.text(&format!("{out}/history.csv"))
    };
    let with = history("with", "");
    let without = history("flag", "--no-error-bars");
    assert_eq!(without, history("key", "--set output.error_bars=false"));
    for (with, without) in with.lines().zip(without.lines()).skip(1) {
        let values = without.strip_suffix(",,,,,").unwrap();
        assert!(with.starts_with(values) && !with.ends_with(','), "{with}");
    }
}

#[test]
fn the_resolved_scenario_is_a_scenario_file_with_the_same_results() {
    let place = Place::with("load.csv", "time_s,load_n\n0,2\n0.1,2.5\n0.1,3\n7,0\n");
    let table = "    { kind = \"table\", file = \"load.csv\" },\n    { kind = \"polynomial\", coefficients = [0, 0.3], duration = \"3 s\" },\n]";
    place.put(
        "small.toml",
        SMALL.replacen("\n]", &format!("\n{table}"), 1),
    );
    for (file, out) in [("small.toml", "first"), ("first/resolved.toml", "second")] {
        let run = place.done(&format!("simulate {file} --quiet --out {out}"));
        assert_eq!(run.stdout + &run.stderr, "");
    }
    for name in "resolved.toml history.csv summary.json cases/profiles/1.csv".split(' ') {
        place.are_same(&["first", "second"], name);
    }
}

#[test]
fn fields_are_arrays_for_numpy_and_images_for_paraview() {
    let place = Place::with("small.toml", SMALL);
    place.done(
        "simulate small.toml --quiet --set solver.engine=half-space --set solver.cells=24 \
         --set 'output.fields_at=[\"0 s\", \"20 s\"]' --out out",
    );
    let spacing = place
        .table("out/cases/fields/index.csv")
        .number(0, "spacing_x_m");
    for k in 0..2 {
        let (shape, values) = npy(&place.bytes(&format!("out/cases/fields/{k}-pressure_pa.npy")));
        assert_eq!(shape, [24, 24]);
        // The pressure carries the load, and is symmetric.
        assert!((values.iter().sum::<f64>() * spacing * spacing - 10.0).abs() < 1e-9);
        assert!((values[24 * 10 + 7] - values[24 * 13 + 16]).abs() < 1e-6 * values[24 * 12 + 12]);
        let image = place.bytes(&format!("out/cases/fields/{k}.vti"));
        assert!(image.starts_with(b"<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\""));
        assert!(place.has(&format!("out/cases/fields/{k}-gap_m.npy")));
    }
    place.has_all(
        "out",
        "figures/pressure-map.svg figures/pressure-map.png cases/fields/1-displacement_m.npy",
    );
    // What is said of the contact as a whole is that of the arrays, and the curves end in it.
    let index = place.table("out/cases/fields/index.csv");
    let (_, pressure) = npy(&place.bytes("out/cases/fields/1-pressure_pa.npy"));
    let (_, gap) = npy(&place.bytes("out/cases/fields/1-gap_m.npy"));
    let pressed: Vec<f64> = pressure.iter().filter(|p| **p > 0.0).copied().collect();
    let fraction = pressed.len() as f64 / pressure.len() as f64;
    let mean = pressed.iter().sum::<f64>() / pressed.len() as f64;
    let gaps = pressure.iter().zip(&gap).filter(|(p, _)| **p == 0.0);
    let mean_gap = gaps.map(|(_, gap)| gap).sum::<f64>() / gap.len() as f64;
    for (column, expected) in [
        ("contact_fraction", fraction),
        ("contact_patches", 1.0),
        ("largest_patch_m2", pressed.len() as f64 * spacing * spacing),
        ("mean_pressure_pa", mean),
        ("mean_gap_m", mean_gap),
    ] {
        // Sums in another order.
        let found = index.number(1, column);
        assert!(
            (found / expected - 1.0).abs() < 1e-12,
            "{column} {found} {expected}"
        );
    }
    let above = place.table("out/figures/pressure-distribution.csv");
    let most = pressed.iter().copied().fold(0.0, f64::max);
    let last = above.len() - 1;
    assert_eq!(above.number(0, "contact_share"), 1.0);
    assert!(
        above.number(last, "contact_share") == 0.0 && above.number(last, "pressure_pa") >= most
    );
    let gaps = place.table("out/figures/gap-distribution.csv");
    let first = (0..gaps.len()).rfind(|row| gaps.number(*row, "gap_m") == 0.0);
    let share = gaps.number(first.unwrap(), "surface_share");
    assert!(
        (share - (1.0 - fraction)).abs() < 1e-12,
        "{share} {fraction}"
    );
    let profile = place.text("out/cases/profiles/0.csv");
    assert!(profile.starts_with("line,position_m,pressure_pa,displacement_m,gap_m\nx,"));
    assert_eq!(profile.lines().filter(|l| l.starts_with("y,")).count(), 24);
}

#[test]
fn results_of_another_scenario_or_sweep_are_replaced_only_when_asked() {
    let place = Place::with("small.toml", SMALL);
    let run = "simulate small.toml --quiet";
    place.done(run);
    let before = place.bytes("reports/small/history.csv");
    let other = format!("{run} --set output.profiles_at=[]");
    assert!(place.refused(&other).contains("--force"));
    assert_eq!(place.bytes("reports/small/history.csv"), before);
    place.done(&format!("{other} --force"));
    assert!(
        !place.has("reports/small/cases/profiles")
            && !place.has("reports/small/figures/profiles.svg")
    );
}

#[test]
fn a_fluid_has_a_history() {
    let fluid = "poisson_ratio = 0.4\n[material.maxwell]\nmodulus = \"1 GPa\"\ntime = \"10 s\"";
    assert!(!rows(&SMALL.replace("library = \"pmma\"", fluid)).is_empty());
}

#[test]
fn an_approach_history_written_by_one_run_drives_the_next() {
    let place = Place::with("small.toml", SMALL);
    place.done("simulate small.toml --quiet --out out");
    let head = SMALL.split("[drive]").next().unwrap();
    let again = drive(
        "approach",
        "{ kind = \"table\", file = \"out/history.csv\" }",
    );
    let tail = "[time]\nstep = \"1 h\"\n[solver]\nsprings = 100\n";
    place.put("again.toml", format!("{head}{again}{tail}"));
    place.done("simulate again.toml --quiet --out second");
    let [first, second] =
        ["out", "second"].map(|out| place.table(&format!("{out}/history.csv")).numbers("load_n"));
    assert_eq!(first.len(), second.len());
    for (a, b) in first.iter().zip(&second) {
        // The domains, and with them the springs, differ by their sizing from load and from approach.
        assert!((a - b).abs() < 1e-4 * 10.0, "{a} {b}");
    }
}

#[test]
fn a_dry_run_tells_steps_and_memory_and_writes_nothing() {
    let segments = r#"{ kind = "step", to = "10 N", duration = "2 s" }"#;
    let solver = "[solver]\nengine = \"half-space\"\ncells = 1024\n[time]\nstep = \"0.5 s\"\n";
    let place = Place::with("dry.toml", &(maxwell() + &drive("load", segments) + solver));
    place.done("simulate dry.toml --dry-run --out out").says(&[
        "time steps on 1024 x 1024 cells (half-space engine)",
        "for the errors",
        "Memory: about",
        " MB",
    ]);
    assert!(!place.has("out"));
}

#[test]
fn a_history_for_which_no_machine_has_room_is_refused_before_it_begins() {
    // Four terabytes of fields.
    let times: Vec<String> = (0..10_000).map(|k| format!("\"{k} ms\"")).collect();
    let text = format!(
        "{ZENER}{}\n[solver]\nengine = \"half-space\"\ncells = 4096\n[output]\nfields_at = [{}]\n",
        drive(
            "load",
            "{ kind = \"step\", to = \"1 N\", duration = \"10 s\" }"
        ),
        times.join(", ")
    );
    let place = Place::with("large.toml", &text);
    let refused = place.refused("simulate large.toml --out large");
    for part in [
        "a case takes about",
        "of memory, and",
        "take fewer cells (solver.cells)",
    ] {
        assert!(refused.contains(part), "{refused}");
    }
    assert!(!place.path("large").exists());
}
