//! From records of an instrument to a material: `analyse`, then `identify` of its folder, against the solid that the records were made of.
//!
//! `RECORDS=100 cargo test --test program measured_material -- --nocapture` makes as many sets of records as asked for and prints what the
//! guide quotes; without it a few are made. The records drift, hum, and are sampled with jitter.

use crate::prelude::*;
use std::f64::consts::TAU;
use std::ops::Range;

use contact_dma::prelude::*;

const POISSON: f64 = 0.45;
const MEAN_N: f64 = 0.2;
const AMPLITUDE_N: f64 = 0.1;
const CYCLES: f64 = 8.3;
const POINTS: f64 = 60.0;

/// Noise of load and approach, in parts of their amplitudes.
const NOISE: f64 = 0.03;

fn frequencies_hz() -> Vec<f64> {
    log_spaced(0.01, 10_f64.powf(2.8), 9)
}

fn truth() -> Relaxation {
    let branches = [(150e6, 3e-3), (90e6, 0.1), (40e6, 4.0)];
    let branches = branches.map(|(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s });
    Relaxation::new(20e6, branches.to_vec()).unwrap()
}

/// Load (N) and approach (m) of the stabilised cycle at each frequency, evenly spaced, from the mean of the drive on.
fn cycles(drive: HarmonicDrive) -> Vec<[Vec<f64>; 2]> {
    let material = Material::from_relaxation(truth(), ModulusKind::Longitudinal, POISSON).unwrap();
    let sweep = Sweep::new(material, Sphere::new(2e-3).unwrap(), drive);
    let sweep = sweep.steps(240).unwrap().springs(240).unwrap();
    let sweep = sweep.without_error_bars();
    let each = frequencies_hz().into_iter().map(|hz| {
        let record = sweep.clone().case_at_hz(hz).unwrap();
        let samples = record.result.unwrap().cycle.samples;
        [samples.load_n, samples.approach_m]
    });
    each.collect()
}

/// The value of an even spaced closed cycle at an angle.
fn at(samples: &[f64], angle: f64) -> f64 {
    let place = (angle / TAU).rem_euclid(1.0) * (samples.len() - 1) as f64;
    let (before, part) = (place as usize, place.fract());
    samples[before] + part * (samples[before + 1] - samples[before])
}

/// Half of the range of a cycle.
fn swing(samples: &[f64]) -> f64 {
    let start = samples[0];
    let [up, down] = [1.0, -1.0].map(|sign| largest(samples.iter().map(|s| sign * (s - start))));
    0.5 * (up + down)
}

/// Hum of the mains on both signals in parts of their amplitudes, and its frequency (Hz).
const HUM: f64 = 0.02;
const MAINS_HZ: f64 = 50.0;

/// How far the instants of samples are off, in parts of their interval.
const JITTER: f64 = 0.05;

/// A record in the units of an instrument: of the approach neither the zero is known, nor does it stand still; both signals hum, and the
/// samples are not taken on time.
fn record(cycle: &[Vec<f64>; 2], hz: f64, random: &mut Random) -> String {
    let range_m = largest(cycle[1].iter().copied());
    let (start, offset_m) = (TAU * random.unit(), 0.5 * range_m * random.normal());
    let drift_m = 0.08 * range_m * random.normal();
    let swings = [0, 1].map(|of: usize| swing(&cycle[of]));
    let hum_starts = TAU * random.unit();
    let mut text = "Time (s),Load (mN),Depth (nm)\n".to_owned();
    let count = (CYCLES * POINTS) as usize;
    for k in 0..count {
        let (turns, along) = (k as f64 / POINTS, k as f64 / count as f64);
        let taken = turns + JITTER / POINTS * random.normal();
        let angle = TAU * taken + start;
        let hum = HUM * (TAU * MAINS_HZ * taken / hz + hum_starts).sin();
        let [load_n, approach_m] = [0, 1].map(|of: usize| {
            at(&cycle[of], angle) + hum * swings[of] + NOISE * swings[of] * random.normal()
        });
        let drifted_m = offset_m + drift_m * along * (1.5 - 0.5 * along);
        let values = [turns / hz, 1e3 * load_n, 1e9 * (approach_m + drifted_m)];
        text += &values.map(|value| format!("{value:e}")).join(",");
        text.push('\n');
    }
    text
}

/// What the program makes of one set of records, under this drive.
fn identified(cycles: &[[Vec<f64>; 2]], drive: &str, random: &mut Random) -> serde_json::Value {
    let file = include_str!("../inputs/measured-solid.toml").replace("measured.csv", "measured");
    let (head, _) = file.split_once("mean = ").unwrap();
    let place = Place::with("solid.toml", &format!("{head}{drive}"));
    let mut analyse = "analyse --out measured --quiet --no-figures".to_owned();
    for (k, (cycle, hz)) in cycles.iter().zip(frequencies_hz()).enumerate() {
        place.put(&format!("loop-{k}.csv"), record(cycle, hz, random));
        analyse += &format!(" loop-{k}.csv");
    }
    // Of some hundred records one seems to change until its end, which noise does too: it has no mean, and its row no data.
    let code = place.run(&analyse).code;
    assert!(code == 0 || code == 3, "{code}");
    let identify = "identify solid.toml --format json --no-figures";
    place.done(identify).json()
}

/// How many of the values that were found lie in their bands, of how many, and the largest relative error of E*.
fn compared(found: &serde_json::Value) -> (u32, u32, f64) {
    let truth = truth();
    let (mut inside, mut all, mut worst) = (0, 0, 0.0_f64);
    for row in found["moduli"].as_array().unwrap() {
        let of = |name: &str| row[name].as_f64().unwrap();
        let exact = truth.complex_modulus(of("angular_frequency_rad_per_s"));
        for (name, exact) in [("storage", exact.re), ("loss", exact.im)] {
            let band = ["low", "high"].map(|end| of(&format!("{name}_modulus_{end}_pa")));
            inside += u32::from(band[0] <= exact && exact <= band[1]);
            all += 1;
        }
        let (storage, loss) = (of("storage_modulus_pa"), of("loss_modulus_pa"));
        worst = worst.max((storage - exact.re).hypot(loss - exact.im) / exact.norm());
    }
    (inside, all, worst)
}

fn data_of(found: &serde_json::Value) -> Vec<&str> {
    let columns = found["columns"].as_array().unwrap().iter();
    columns.map(|c| c["column"].as_str().unwrap()).collect()
}

/// What sets of records (this many where nothing else is asked for) under a drive give: columns that serve as data, and the mean of the
/// reduced chi squared.
fn check(
    few: u64,
    drive: HarmonicDrive,
    told: &str,
    first: u64,
    data: &str,
    chi_squared: Range<f64>,
) {
    let sets = from_environment("RECORDS", few);
    let cycles = cycles(drive);
    let (mut inside, mut all, mut worst, mut chi, mut branches) =
        (0_u32, 0_u32, 0.0_f64, 0.0, 0_u64);
    for seed in 0..sets {
        let found = identified(&cycles, told, &mut Random(first + 1_000_003 * seed));
        assert_eq!(data_of(&found).join(" "), data);
        assert_eq!(found["columns_not_understood"], serde_json::json!([]));
        let own_chi = found["reduced_chi_squared"].as_f64().unwrap();
        let own_branches = found["branches"].as_u64().unwrap();
        let (within, of, off) = compared(&found);
        println!(
            "{seed}: {own_branches} branches, chi squared {own_chi:.2}, {within} of {of} inside, off by {:.2} %",
            100.0 * off
        );
        (inside, all, branches) = (inside + within, all + of, branches + own_branches);
        (worst, chi) = (worst.max(off), chi + own_chi / sets as f64);
    }
    println!(
        "{inside} of {all} inside, off by {:.2} % at most, chi squared {chi:.2} on average, {branches} branches of {}",
        100.0 * worst,
        3 * sets
    );
    let share = f64::from(inside) / f64::from(all);
    assert!(share >= 0.85, "{inside} of {all}");
    below!(worst, 0.05);
    assert!(chi_squared.contains(&chi), "{chi}");
}

#[test]
fn records_with_noise_drift_and_an_unknown_zero_give_the_solid_within_its_bands() {
    let drive = HarmonicDrive::load(MEAN_N, AMPLITUDE_N).unwrap();
    let told = "mean = \"0.2 N\"\namplitude = \"0.1 N\"\n";
    let data = "phase_lag_rad approach_amplitude_m";
    check(4, drive, told, 7, data, 0.5..1.6);
}

#[test]
fn records_under_a_prescribed_approach_give_the_solid_though_their_mean_is_counted_from_nowhere() {
    let drive = HarmonicDrive::approach(3e-5, 1e-5).unwrap();
    let told = "control = \"approach\"\nmean = \"30 um\"\namplitude = \"10 um\"\n";
    let data = "phase_lag_rad load_amplitude_n";
    check(3, drive, told, 11, data, 0.3..1.6);
}
