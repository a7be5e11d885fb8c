//! The same problem in other units of stress, length and time: the same answer, by the same amount of work.

use std::sync::Arc;

use crate::common::{relative, run_case, sweep_plan};
use contact_dma::engine::EngineKind;
use contact_dma::indenter::Sphere;
use contact_dma::material::{Material, ModulusKind, Relaxation, RelaxationBranch};
use contact_dma::sweep::record::{CaseRecord, Status};

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
    Units {
        name: "m, Pa, s",
        stress: 1.0,
        length: 1.0,
        time: 1.0,
        exact: true,
    },
    Units {
        name: "mm, MPa, s",
        stress: 1e-6,
        length: 1e3,
        time: 1.0,
        exact: false,
    },
    Units {
        name: "um, MPa, ms",
        stress: 1e-6,
        length: 1e6,
        time: 1e3,
        exact: false,
    },
    Units {
        name: "nm, GPa, h",
        stress: 1e-9,
        length: 1e9,
        time: 1.0 / 3600.0,
        exact: false,
    },
    Units {
        name: "inch, psi, min",
        stress: 1.450_377_377e-4,
        length: 39.370_078_74,
        time: 1.0 / 60.0,
        exact: false,
    },
    Units {
        name: "powers of two",
        stress: 1.0 / 1048576.0,
        length: 1024.0,
        time: 0.125,
        exact: true,
    },
    Units {
        name: "none at all",
        stress: 3e-40,
        length: 7e30,
        time: 1e-25,
        exact: false,
    },
];

/// PMMA under a sphere of 10 mm at 10 +- 9 N.
fn case(units: &Units, engine: EngineKind) -> CaseRecord {
    let branch = |modulus_pa: f64, time_s: f64| RelaxationBranch {
        modulus_pa: modulus_pa * units.stress,
        time_s: time_s * units.time,
    };
    let branches = vec![branch(254.776e6, 8.93), branch(263.6628e6, 117.96)];
    let relaxation = Relaxation::new(1973e6 * units.stress, branches).unwrap();
    let material = Material::from_relaxation(relaxation, ModulusKind::Longitudinal, 0.38).unwrap();
    let sphere = Arc::new(Sphere::new(0.01 * units.length).unwrap());
    let force = units.stress * units.length * units.length;
    let mut plan = sweep_plan(material, sphere, 10.0 * force, 9.0 * force);
    plan.solver.engine = engine;
    plan.solver.cells = 24;
    plan.solver.tolerance = Some(1e-10);
    plan.cycle.steps = 60;
    run_case(&plan, 0.02 / units.time)
}

/// Everything a record holds that has a unit, in SI units.
fn quantities(record: &CaseRecord, units: &Units) -> Vec<(&'static str, f64)> {
    let result = record.result.as_ref().unwrap();
    let pressure = result.peak_pressure_pa.unwrap();
    let energy = units.stress * units.length.powi(3);
    vec![
        ("loss", result.analysis.energy_loss_j / energy),
        ("phase", result.analysis.phase_lag_rad),
        (
            "second harmonic",
            result.analysis.approach_harmonic(2).unwrap(),
        ),
        ("largest approach", result.approach_m.maximum / units.length),
        (
            "smallest approach",
            result.approach_m.minimum / units.length,
        ),
        (
            "largest radius",
            result.contact_radius_m.maximum / units.length,
        ),
        (
            "smallest radius",
            result.contact_radius_m.minimum / units.length,
        ),
        ("largest pressure", pressure.maximum / units.stress),
        (
            "storage modulus",
            result.storage_modulus_pa.unwrap() / units.stress,
        ),
        (
            "loss modulus",
            result.loss_modulus_pa.unwrap() / units.stress,
        ),
        ("domain", record.domain_half_width_m / units.length),
    ]
}

/// Holds the answers in all systems against those in SI; the iterations may differ by this share.
fn compare(engine: EngineKind, tolerance: f64, iterations: f64) {
    let si = case(&SYSTEMS[0], engine);
    assert_eq!(si.status, Status::Converged);
    for units in &SYSTEMS[1..] {
        let other = case(units, engine);
        let name = units.name;
        assert_eq!(
            other.status,
            Status::Converged,
            "{name}: {:?}",
            other.message
        );
        let pairs = quantities(&si, &SYSTEMS[0])
            .into_iter()
            .zip(quantities(&other, units));
        let mut largest = 0.0_f64;
        for ((quantity, expected), (_, value)) in pairs {
            let error = relative(value, expected);
            assert!(error.abs() < tolerance, "{name}: {quantity} {error:e}");
            largest = largest.max(error.abs());
        }
        let work = relative(other.work.iterations as f64, si.work.iterations as f64);
        println!("{engine:?}, {name}: {largest:.1e}, work {work:+.1e}");
        assert!(
            work.abs() <= iterations,
            "{name}: {} not {}",
            other.work.iterations,
            si.work.iterations
        );
        assert_eq!(
            (other.cycles, other.domain_enlarged),
            (si.cycles, si.domain_enlarged)
        );
        if units.exact {
            assert_eq!(
                (largest, other.work.iterations),
                (0.0, si.work.iterations),
                "{name}"
            );
        }
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
