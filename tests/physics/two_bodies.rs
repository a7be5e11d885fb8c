//! An indenter that yields: two equal bodies against one of twice the compliance, steel on a solid against the compliance written out,
//! and what each body dissipates.

use crate::prelude::*;

const OMEGA_HZ: f64 = 1.3e-3;

fn record(material: Material, indenter: impl Indenter + 'static, hz: f64) -> CaseRecord {
    let drive = HarmonicDrive::load(10.0, 5.0).unwrap();
    let sweep = Sweep::new(material, indenter, drive).springs(100).unwrap();
    sweep.steps(100).unwrap().case_at_hz(hz).unwrap()
}

#[test]
fn an_elastic_indenter_adds_its_compliance_and_dissipates_nothing() {
    let steel = library::find("steel").unwrap().material().unwrap();
    let own = pmma_material().contact_compliance().unwrap();
    let at_once_per_pa = own.instantaneous_compliance() + (1.0 - 0.3 * 0.3) / 210e9;
    let added = Creep::new(at_once_per_pa, own.branches().to_vec(), None);
    // With a Poisson ratio of zero C is D.
    let written_out = Material::from_creep(added.unwrap(), ModulusKind::Longitudinal, 0.0).unwrap();
    let pair = record(pmma_material().against(steel), ball(0.01), OMEGA_HZ);
    let other = record(written_out, ball(0.01), OMEGA_HZ);
    let [pair_j, other_j] = [&pair, &other].map(|record| record.energy_loss_j().unwrap());
    near!(pair_j, other_j, 1e-9);
    let result = pair.result.unwrap();
    assert_eq!(result.dissipated_in_indenter_j(), Some(0.0));
    // By Hertz the approach goes with C^(2/3). C of PMMA lies between 0.34 and 0.44 per GPa over the cycle, that of steel is
    // 0.00433: 1.0 to 1.3 % more, of which two thirds.
    let rigid = record(pmma_material(), ball(0.01), OMEGA_HZ)
        .result
        .unwrap();
    let deeper = result.approach_m.maximum / rigid.approach_m.maximum - 1.0;
    assert!((0.0060..0.0090).contains(&deeper), "{deeper}");
}

#[test]
fn a_punch_that_yields_tells_the_moduli_of_the_solid_alone() {
    let polymer = solid(1e9, &[(2e9, 40.0)], 0.35);
    let hz = 0.02;
    let exact = zener_material().longitudinal_complex_modulus(TAU * hz);
    let punch = FlatPunch::new(1e-3).unwrap();
    let result = result_of(record(zener_material().against(polymer), punch, hz));
    // The error of 100 steps of a second-order rule.
    near!(result.storage_modulus_pa.unwrap(), exact.re, 1e-3);
    near!(result.loss_modulus_pa.unwrap(), exact.im, 3e-3);
    // Both bodies dissipate, and what they dissipate is the loop.
    let part = result.dissipated_in_indenter_j().unwrap() / result.dissipated_j();
    assert!((0.01..0.9).contains(&part), "{part}");
    assert!(result.energy_imbalance().unwrap().abs() < 1e-3);
}

#[test]
fn a_history_knows_the_indenter_too() {
    let steel = library::find("steel").unwrap().material().unwrap();
    let approach = |material: Material| {
        let drive = SegmentedDrive::new(Control::Load, vec![step(10.0, 100.0)]).unwrap();
        let outcome = simulated(ScenarioPlan::new(material, sphere(0.01), drive));
        outcome.rows.last().unwrap().approach_m.unwrap()
    };
    let pair = pmma_material().against(steel);
    // Lee and Radok: delta^(3/2) is in proportion to C(t) under a constant load.
    let ratio = |material: &Material| material.contact_compliance().unwrap().compliance(100.0);
    let expected = (ratio(&pair) / ratio(&pmma_material())).powf(2.0 / 3.0);
    near!(approach(pair) / approach(pmma_material()), expected, 1e-5);
}
