//! An indenter that yields: two equal bodies against one of twice the compliance, steel on a solid against the compliance written out,
//! and what each body dissipates.

use contact_dma::prelude::*;

use crate::common::{pmma_material, zener_material};

const OMEGA_HZ: f64 = 1.3e-3;

fn sphere() -> Sphere {
    Sphere::new(0.01).unwrap()
}

fn record(material: Material, indenter: impl Indenter + 'static, hz: f64) -> CaseRecord {
    let drive = HarmonicDrive::load(10.0, 5.0).unwrap();
    let sweep = Sweep::new(material, indenter, drive).springs(100).unwrap();
    sweep.steps(100).unwrap().case_at_hz(hz).unwrap()
}

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a / b - 1.0).abs() < tolerance, "{a:e} {b:e}");
}

#[test]
fn two_equal_bodies_are_one_of_twice_the_compliance() {
    let pair = record(pmma_material().against(pmma_material()), sphere(), OMEGA_HZ);
    let halved = pmma_material().relaxation().unwrap().scaled(0.5).unwrap();
    let soft = Material::from_relaxation(halved, ModulusKind::Longitudinal, 0.38).unwrap();
    let soft = record(soft, sphere(), OMEGA_HZ);
    let (pair, soft) = (pair.result.unwrap(), soft.result.unwrap());
    // The same problem up to rounding, and a search that ends by a tolerance far above that.
    close(
        pair.analysis.energy_loss_j,
        soft.analysis.energy_loss_j,
        1e-9,
    );
    close(pair.approach_m.maximum, soft.approach_m.maximum, 1e-10);
    close(
        pair.contact_radius_m.maximum,
        soft.contact_radius_m.maximum,
        1e-10,
    );
    close(
        pair.peak_pressure_pa.unwrap().maximum,
        soft.peak_pressure_pa.unwrap().maximum,
        1e-10,
    );
    // Each takes its half.
    close(
        pair.dissipated_in_indenter_j().unwrap(),
        0.5 * pair.dissipated_j(),
        1e-12,
    );
    assert_eq!(soft.dissipated_in_indenter_j(), None);
}

#[test]
fn an_elastic_indenter_adds_its_compliance_and_dissipates_nothing() {
    let steel = library::find("steel").unwrap().material().unwrap();
    let own = pmma_material().contact_compliance().unwrap();
    let added = Creep::new(
        own.instantaneous_compliance() + (1.0 - 0.3 * 0.3) / 210e9,
        own.branches().to_vec(),
        None,
    );
    // With a Poisson ratio of zero C is D.
    let written_out = Material::from_creep(added.unwrap(), ModulusKind::Longitudinal, 0.0).unwrap();
    let pair = record(pmma_material().against(steel), sphere(), OMEGA_HZ);
    let other = record(written_out, sphere(), OMEGA_HZ);
    close(
        pair.energy_loss_j().unwrap(),
        other.energy_loss_j().unwrap(),
        1e-9,
    );
    let result = pair.result.unwrap();
    assert_eq!(result.dissipated_in_indenter_j(), Some(0.0));
    // 1.3 % of the compliance.
    let rigid = record(pmma_material(), sphere(), OMEGA_HZ).result.unwrap();
    let deeper = result.approach_m.maximum / rigid.approach_m.maximum - 1.0;
    assert!((0.003..0.02).contains(&deeper), "{deeper}");
}

#[test]
fn a_punch_that_yields_tells_the_moduli_of_the_solid_alone() {
    let branch = RelaxationBranch {
        modulus_pa: 2e9,
        time_s: 40.0,
    };
    let relaxation = Relaxation::new(1e9, vec![branch]).unwrap();
    let polymer = Material::from_relaxation(relaxation, ModulusKind::Longitudinal, 0.35).unwrap();
    let hz = 0.02;
    let exact = zener_material().longitudinal_complex_modulus(std::f64::consts::TAU * hz);
    let punch = FlatPunch::new(1e-3).unwrap();
    let result = record(zener_material().against(polymer), punch, hz)
        .result
        .unwrap();
    // The error of 100 steps of a second-order rule.
    close(result.storage_modulus_pa.unwrap(), exact.re, 1e-3);
    close(result.loss_modulus_pa.unwrap(), exact.im, 3e-3);
    // Both bodies dissipate, and what they dissipate is the loop.
    let of_indenter = result.dissipated_in_indenter_j().unwrap();
    assert!(
        of_indenter > 0.01 * result.dissipated_j() && of_indenter < 0.9 * result.dissipated_j()
    );
    assert!(result.energy_imbalance().unwrap().abs() < 1e-3);
}

#[test]
fn a_history_knows_the_indenter_too() {
    let steel = library::find("steel").unwrap().material().unwrap();
    let drive = SegmentedDrive::new(
        Control::Load,
        vec![Segment::Step {
            to: 10.0,
            duration_s: 100.0,
        }],
    );
    let approach = |material: Material| {
        let plan = ScenarioPlan::new(
            material,
            std::sync::Arc::new(sphere()),
            drive.clone().unwrap(),
        );
        let outcome = Simulation::new(plan).unwrap();
        let outcome = outcome.run(&std::sync::atomic::AtomicBool::new(false), &|_, _| {});
        outcome.rows.last().unwrap().approach_m.unwrap()
    };
    let pair = pmma_material().against(steel);
    // Lee and Radok: delta^(3/2) is in proportion to C(t) under a constant load.
    let ratio = |material: &Material| material.contact_compliance().unwrap().compliance(100.0);
    let expected = (ratio(&pair) / ratio(&pmma_material())).powf(2.0 / 3.0);
    close(approach(pair) / approach(pmma_material()), expected, 1e-5);
}
