//! The same problem in other units of stress, length and time: the same answer, by the same amount of work.

use crate::prelude::*;

/// How many of a unit make one of SI.
struct Units {
    name: &'static str,
    stress: f64,
    length: f64,
    time: f64,
    /// Whether the change of units is exact in binary: then every bit must be the same.
    exact: bool,
}

/// The first is SI itself; all are coherent: force is stress times length squared, energy force times length.
const SYSTEMS: [Units; 7] = [
    units("m, Pa, s", [1.0, 1.0, 1.0], true),
    units("mm, MPa, s", [1e-6, 1e3, 1.0], false),
    units("um, MPa, ms", [1e-6, 1e6, 1e3], false),
    units("nm, GPa, h", [1e-9, 1e9, 1.0 / 3600.0], false),
    units(
        "inch, psi, min",
        [1.450_377_377e-4, 39.370_078_74, 1.0 / 60.0],
        false,
    ),
    units("powers of two", [1.0 / 1048576.0, 1024.0, 0.125], true),
    units("none at all", [3e-40, 7e30, 1e-25], false),
];

const fn units(name: &'static str, [stress, length, time]: [f64; 3], exact: bool) -> Units {
    Units {
        name,
        stress,
        length,
        time,
        exact,
    }
}

/// PMMA under a sphere of 10 mm at 10 +- 9 N.
fn case(units: &Units, engine: EngineKind) -> CaseRecord {
    let branch = |(modulus_pa, time_s)| (modulus_pa * units.stress, time_s * units.time);
    let branches = [(254.776e6, 8.93), (263.6628e6, 117.96)].map(branch);
    let material = solid(1973e6 * units.stress, &branches, 0.38);
    let force = units.stress * units.length * units.length;
    let sphere = sphere(0.01 * units.length);
    let mut plan = sweep_plan(material, sphere, 10.0 * force, 9.0 * force);
    (plan.solver.engine, plan.solver.cells) = (engine, 24);
    (plan.solver.tolerance, plan.cycle.steps) = (Some(1e-10), 60);
    run_case(&plan, 0.02 / units.time)
}

/// Everything a record holds that has a unit, in SI units.
fn quantities(record: &CaseRecord, units: &Units) -> Vec<(&'static str, f64)> {
    let result = record.result.as_ref().unwrap();
    let energy = units.stress * units.length.powi(3);
    let loop_ = &result.analysis;
    let (approach, radius) = (result.approach_m, result.contact_radius_m);
    let pressure = result.peak_pressure_pa.unwrap();
    let (storage, loss) = (result.storage_modulus_pa, result.loss_modulus_pa);
    vec![
        ("loss", loop_.energy_loss_j / energy),
        ("phase", loop_.phase_lag_rad),
        ("second harmonic", loop_.approach_harmonic(2).unwrap()),
        ("largest approach", approach.maximum / units.length),
        ("smallest approach", approach.minimum / units.length),
        ("largest radius", radius.maximum / units.length),
        ("smallest radius", radius.minimum / units.length),
        ("largest pressure", pressure.maximum / units.stress),
        ("storage modulus", storage.unwrap() / units.stress),
        ("loss modulus", loss.unwrap() / units.stress),
        ("domain", record.domain_half_width_m / units.length),
    ]
}

/// Holds the answers in all systems against those in SI; the iterations may differ by this share.
fn compare(engine: EngineKind, tolerance: f64, iterations: f64) {
    let si = case(&SYSTEMS[0], engine);
    assert_eq!(si.status, Status::Converged);
    for units in &SYSTEMS[1..] {
        let (other, name) = (case(units, engine), units.name);
        assert_eq!(other.status, Status::Converged, "{name}");
        let expected = quantities(&si, &SYSTEMS[0]).into_iter();
        let pairs = expected.zip(quantities(&other, units));
        for ((quantity, expected), (_, value)) in pairs {
            assert!(!units.exact || value == expected, "{name}: {quantity}");
            near!(value, expected, tolerance, "{name}: {quantity}");
        }
        let [found, own] = [&other, &si].map(|record| record.work.iterations as f64);
        let allowed = if units.exact { 0.0 } else { iterations };
        let off = relative(found, own).abs();
        assert!(off <= allowed, "{name}: {found} not {own}");
        assert_eq!(other.cycles, si.cycles);
        assert_eq!(other.domain_enlarged, si.domain_enlarged);
    }
}

#[test]
fn the_axisymmetric_engine_does_not_know_the_units() {
    // Roundings over a thousand instants: 5e-14 was seen. Newton's method ends exactly; the start that the search gives it
    // differs by rounding, which was seen to save one pass of 787.
    compare(EngineKind::Axisymmetric, 2e-13, 4e-3);
}

#[test]
fn the_half_space_engine_does_not_know_the_units() {
    // Solved to 1e-10, to which the answers agree. Rounding leads conjugate gradients along another way, now and then by one
    // iteration: one in a thousand was seen.
    compare(EngineKind::HalfSpace, 5e-10, 4e-3);
}
