//! Materials of a bulk modulus, constant or relaxing: the contact compliance against its limits and a numerical inversion of its transform, losses
//! against correspondence, moduli read back from loops.

use std::f64::consts::PI;

use contact_dma::material::compressibility::Compressibility;
use contact_dma::prelude::*;
use contact_dma::sweep::record::CaseResult;
use num_complex::Complex;

/// Shear series of a polymer through its transition (Pa, s), and bulk moduli (Pa).
const EQUILIBRIUM_PA: f64 = 2e6;
const BRANCHES: [(f64, f64); 4] = [(5e8, 1e-3), (4e8, 0.1), (5e7, 3.0), (4e6, 100.0)];
const BULK_PA: f64 = 3e9;

fn series() -> Relaxation {
    let branch = |(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s };
    Relaxation::new(EQUILIBRIUM_PA, BRANCHES.map(branch).to_vec()).unwrap()
}

fn constant(bulk_pa: f64) -> Compressibility {
    Compressibility::constant_bulk_modulus(bulk_pa).unwrap()
}

fn shear(bulk_pa: f64) -> Material {
    Material::from_relaxation(series(), ModulusKind::Shear, constant(bulk_pa)).unwrap()
}

/// Bulk branches (Pa, s): one at a time of the shear series, one between two of them, one slower than all.
const BULK_BRANCHES: [(f64, f64); 3] = [(2e9, 0.1), (8e8, 1.0), (5e8, 300.0)];

fn relaxing() -> Material {
    let branch = |(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s };
    let bulk = Relaxation::new(BULK_PA, BULK_BRANCHES.map(branch).to_vec()).unwrap();
    let bulk = Compressibility::BulkModulus(bulk);
    Material::from_relaxation(series(), ModulusKind::Shear, bulk).unwrap()
}

/// s K(s) of the relaxing one, at any complex s.
fn bulk_pa(s: Complex<f64>) -> Complex<f64> {
    let branches = BULK_BRANCHES.map(|(k, tau)| k * s * tau / (1.0 + s * tau));
    branches.into_iter().fold(BULK_PA.into(), |sum, k| sum + k)
}

/// s G(s) of the series, at any complex s.
fn modulus_pa(s: Complex<f64>) -> Complex<f64> {
    let branches = BRANCHES.map(|(g, tau)| g * s * tau / (1.0 + s * tau));
    branches
        .into_iter()
        .fold(EQUILIBRIUM_PA.into(), |sum, g| sum + g)
}

/// f(t) from its transform, by the fixed Talbot contour (J. Abate and P. P. Valko, Int. J. Numer. Meth. Engng 60 (2004) 979).
fn inverted(transform: impl Fn(Complex<f64>) -> Complex<f64>, time_s: f64) -> f64 {
    const POINTS: usize = 24;
    let r = 2.0 * POINTS as f64 / (5.0 * time_s);
    let first = 0.5 * (transform(r.into()) * (r * time_s).exp()).re;
    let rest = (1..POINTS).map(|k| {
        let theta = k as f64 * PI / POINTS as f64;
        let cotangent = 1.0 / theta.tan();
        let s = Complex::new(r * theta * cotangent, r * theta);
        let sigma = theta + (theta * cotangent - 1.0) * cotangent;
        ((s * time_s).exp() * transform(s) * Complex::new(1.0, sigma)).re
    });
    r / POINTS as f64 * (first + rest.sum::<f64>())
}

#[test]
fn the_contact_compliance_is_the_inverse_of_its_transform() {
    let compliance = shear(BULK_PA).contact_compliance().unwrap();
    let transform = |s: Complex<f64>| {
        let shear = modulus_pa(s);
        let nu = (3.0 * BULK_PA - 2.0 * shear) / (2.0 * (3.0 * BULK_PA + shear));
        (1.0 - nu) / (2.0 * shear) / s
    };
    for k in 0..20 {
        let time_s = 10_f64.powf(-5.0 + 0.5 * f64::from(k));
        let difference = compliance.compliance(time_s) / inverted(transform, time_s) - 1.0;
        assert!(difference.abs() < 1e-8, "{time_s:e}: {difference:e}");
    }
}

#[test]
fn the_poisson_ratio_goes_from_the_glass_to_the_rubber_as_its_transform_does() {
    let material = shear(BULK_PA);
    let elastic = |g: f64| (3.0 * BULK_PA - 2.0 * g) / (2.0 * (3.0 * BULK_PA + g));
    let at = |time_s| material.poisson_ratio_at(time_s).unwrap();
    let glass = EQUILIBRIUM_PA + BRANCHES.iter().map(|(g, _)| g).sum::<f64>();
    assert!((at(0.0) - elastic(glass)).abs() < 1e-14);
    assert!((at(f64::INFINITY) - elastic(EQUILIBRIUM_PA)).abs() < 1e-14);
    let transform = |s: Complex<f64>| {
        let shear = modulus_pa(s);
        (3.0 * BULK_PA - 2.0 * shear) / (2.0 * (3.0 * BULK_PA + shear)) / s
    };
    for time_s in [1e-4, 1e-2, 1.0, 50.0] {
        assert!((at(time_s) - inverted(transform, time_s)).abs() < 1e-8);
    }
    assert_eq!(material.poisson_ratio(), None);
}

#[test]
fn the_limits_are_those_of_an_incompressible_and_of_an_elastic_body() {
    // K to infinity: nu to 1/2, and C to J/4, but for G/K.
    let incompressible = Material::from_relaxation(series(), ModulusKind::Shear, 0.5).unwrap();
    let (limit, near) = (
        incompressible.contact_compliance(),
        shear(1e26).contact_compliance(),
    );
    let (limit, near) = (limit.unwrap(), near.unwrap());
    for time_s in [0.0, 1e-3, 1.0, 1e4] {
        let ratio = near.compliance(time_s) / limit.compliance(time_s);
        assert!((ratio - 1.0).abs() < 1e-14, "{time_s}: {ratio}");
    }
    for omega in [0.0, 1e-2, 1e3] {
        let ratio = shear(1e26).longitudinal_complex_modulus(omega)
            / incompressible.longitudinal_complex_modulus(omega);
        assert!((ratio - 1.0).norm() < 1e-14);
    }
    // Without branches the constant Poisson ratio is that of the two moduli.
    let bulk = constant(BULK_PA);
    let elastic = Relaxation::new(1e9, vec![]).unwrap();
    let nu = (3.0 * BULK_PA - 2e9) / (2.0 * (3.0 * BULK_PA + 1e9));
    let with = |lateral| {
        let made = Material::from_relaxation(elastic.clone(), ModulusKind::Shear, lateral);
        let compliance = made.unwrap().contact_compliance().unwrap();
        compliance.instantaneous_compliance()
    };
    assert!((with(bulk) / with(nu.into()) - 1.0).abs() < 1e-15);
}

#[test]
fn moduli_in_tension_are_the_same_solid() {
    let shear = shear(BULK_PA);
    let tension = shear
        .relaxation_as(ModulusKind::Longitudinal)
        .unwrap()
        .unwrap();
    let bulk = constant(BULK_PA);
    let again =
        Material::from_relaxation(tension.clone(), ModulusKind::Longitudinal, bulk).unwrap();
    for omega in [0.0, 1e-3, 0.5, 20.0, 1e5] {
        let [a, b] = [&shear, &again].map(|m| m.contact_complex_modulus(omega));
        assert!((a / b - 1.0).norm() < 1e-11, "{omega}: {a} {b}");
        let [a, b] = [&shear, &again].map(|m| m.longitudinal_complex_modulus(omega));
        let young = tension.complex_modulus(omega);
        assert!((a / young - 1.0).norm() < 1e-11 && (b / young - 1.0).norm() < 1e-11);
    }
    // E(0) = 9K would need an infinite shear modulus.
    let least_pa = tension.instantaneous_modulus() / 9.0;
    let with = |bulk_pa| {
        let tension = tension.clone();
        Material::from_relaxation(tension, ModulusKind::Longitudinal, constant(bulk_pa))
    };
    assert!(with(1.001 * least_pa).is_ok());
    let refused = with(0.999 * least_pa).unwrap_err().to_string();
    assert!(refused.contains("too small"), "{refused}");
    for bulk_pa in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let made = Compressibility::constant_bulk_modulus(bulk_pa);
        assert!(made.is_err(), "{bulk_pa}");
    }
}

#[test]
fn a_bulk_modulus_that_relaxes_is_as_exact() {
    let material = relaxing();
    let compliance = material.contact_compliance().unwrap();
    let poisson_ratio = |s: Complex<f64>| {
        let (g, k) = (modulus_pa(s), bulk_pa(s));
        (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g))
    };
    let transform = |s: Complex<f64>| (1.0 - poisson_ratio(s)) / (2.0 * modulus_pa(s)) / s;
    for k in 0..20 {
        let time_s = 10_f64.powf(-5.0 + 0.5 * f64::from(k));
        let difference = compliance.compliance(time_s) / inverted(transform, time_s) - 1.0;
        assert!(difference.abs() < 1e-8, "{time_s:e}: {difference:e}");
        let nu = material.poisson_ratio_at(time_s).unwrap();
        let difference = nu - inverted(|s| poisson_ratio(s) / s, time_s);
        assert!(difference.abs() < 1e-8, "{time_s:e}: {difference:e}");
    }
    for omega in [1e-3, 0.7, 40.0, 1e5] {
        let s = Complex::new(0.0, omega);
        let (g, k) = (modulus_pa(s), bulk_pa(s));
        let young = 9.0 * k * g / (3.0 * k + g);
        let contact = 2.0 * g / (1.0 - poisson_ratio(s));
        let same = |a: Complex<f64>, b: Complex<f64>| (a / b - 1.0).norm() < 1e-13;
        assert!(same(material.longitudinal_complex_modulus(omega), young));
        assert!(same(material.contact_complex_modulus(omega), contact));
        // What a loop says: the formula with a Poisson ratio of 0 reads 1/C*.
        let (storage, loss) = material.of_loop((contact.re, contact.im), omega);
        assert!(same(Complex::new(storage, loss), young), "{omega}");
    }
}

#[test]
fn a_bulk_modulus_in_proportion_to_the_shear_modulus_leaves_the_poisson_ratio_constant() {
    // K/G = 2 (1 + nu)/(3 (1 - 2 nu)) at all times.
    let nu = 0.3;
    let ratio = 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
    let bulk = Compressibility::BulkModulus(series().scaled(ratio).unwrap());
    let material = Material::from_relaxation(series(), ModulusKind::Shear, bulk).unwrap();
    let plain = Material::from_relaxation(series(), ModulusKind::Shear, nu).unwrap();
    let [own, plain] = [&material, &plain].map(|m| m.contact_compliance().unwrap());
    for time_s in [0.0, 1e-3, 0.2, 5.0, 1e4] {
        let off = own.compliance(time_s) / plain.compliance(time_s) - 1.0;
        assert!(off.abs() < 1e-12, "{time_s}: {off:e}");
        assert!((material.poisson_ratio_at(time_s).unwrap() - nu).abs() < 1e-12);
    }
    let tension = Material::from_relaxation(
        series(),
        ModulusKind::Longitudinal,
        Compressibility::BulkModulus(series().scaled(ratio).unwrap()),
    );
    let refused = tension.unwrap_err().to_string();
    assert!(refused.contains("goes with shear moduli"), "{refused}");
}

fn solved(indenter: impl Indenter + 'static, amplitude_n: f64, omega: f64) -> CaseResult {
    let drive = HarmonicDrive::load(1.0, amplitude_n).unwrap();
    let sweep = Sweep::new(shear(BULK_PA), indenter, drive);
    let record = sweep.case_at_hz(omega / (2.0 * PI)).unwrap();
    record.result.unwrap()
}

#[test]
fn losses_and_moduli_of_loops_are_those_of_correspondence() {
    let material = shear(BULK_PA);
    let compliance = material.contact_compliance().unwrap();
    for omega in [1e-2, 3.0, 1e3] {
        let own = material.longitudinal_complex_modulus(omega);
        // A punch is linear at any amplitude.
        let radius_m = 1e-3;
        let punch = solved(FlatPunch::new(radius_m).unwrap(), 0.5, omega);
        let lossy = -compliance.complex_compliance(omega).im;
        let exact_j = PI * 0.25 * lossy / (2.0 * radius_m);
        let off = (punch.analysis.energy_loss_j / exact_j - 1.0).abs();
        let bar = punch.errors.as_ref().unwrap();
        let quantity = contact_dma::sweep::record::error_bars::Quantity::EnergyLoss;
        assert!(
            off < bar.of(quantity).unwrap() / exact_j,
            "{omega}: {off:e}"
        );
        // A sphere is at small amplitudes.
        let sphere = solved(Sphere::new(0.01).unwrap(), 1e-3, omega);
        for (result, tolerance) in [(punch, 2e-3), (sphere, 2e-3)] {
            let (storage, loss) = (result.storage_modulus_pa, result.loss_modulus_pa);
            let read = Complex::new(storage.unwrap(), loss.unwrap());
            // 200 steps of a second-order rule.
            assert!(
                (read / own - 1.0).norm() < tolerance,
                "{omega}: {read} {own}"
            );
        }
    }
}
