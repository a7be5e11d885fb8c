//! Materials of a bulk modulus, constant or relaxing: the contact compliance against its limits and a numerical inversion of its transform, losses
//! against correspondence, moduli read back from loops.

use crate::prelude::*;

/// Shear series of a polymer through its transition (Pa, s), and bulk moduli (Pa).
const EQUILIBRIUM_PA: f64 = 2e6;
const BRANCHES: [(f64, f64); 4] = [(5e8, 1e-3), (4e8, 0.1), (5e7, 3.0), (4e6, 100.0)];
const BULK_PA: f64 = 3e9;

fn shear_series() -> Relaxation {
    series(EQUILIBRIUM_PA, &BRANCHES)
}

fn of_shear(known: impl Into<Compressibility>) -> Material {
    Material::from_relaxation(shear_series(), ModulusKind::Shear, known).unwrap()
}

fn constant(bulk_pa: f64) -> Compressibility {
    Compressibility::constant_bulk_modulus(bulk_pa).unwrap()
}

fn shear(bulk_pa: f64) -> Material {
    of_shear(constant(bulk_pa))
}

/// Bulk branches (Pa, s): one at a time of the shear series, one between two of them, one slower than all.
const BULK_BRANCHES: [(f64, f64); 3] = [(2e9, 0.1), (8e8, 1.0), (5e8, 300.0)];

fn relaxing() -> Material {
    of_shear(Compressibility::BulkModulus(series(
        BULK_PA,
        &BULK_BRANCHES,
    )))
}

/// The equilibrium modulus and the branches of a series at any complex s, times s.
fn at(equilibrium_pa: f64, branches: &[(f64, f64)], s: Complex<f64>) -> Complex<f64> {
    let branches = branches
        .iter()
        .map(|(g, tau)| g * s * tau / (1.0 + s * tau));
    branches.fold(equilibrium_pa.into(), |sum, g| sum + g)
}

/// s K(s) of the relaxing one.
fn bulk_pa(s: Complex<f64>) -> Complex<f64> {
    at(BULK_PA, &BULK_BRANCHES, s)
}

/// s G(s) of the series.
fn modulus_pa(s: Complex<f64>) -> Complex<f64> {
    at(EQUILIBRIUM_PA, &BRANCHES, s)
}

fn poisson_ratio(bulk_pa: Complex<f64>, shear_pa: Complex<f64>) -> Complex<f64> {
    (3.0 * bulk_pa - 2.0 * shear_pa) / (2.0 * (3.0 * bulk_pa + shear_pa))
}

/// Contact compliance and Poisson ratio at twenty times are the inverses of their transforms.
fn assert_inverse(material: &Material, nu: impl Fn(Complex<f64>) -> Complex<f64>) {
    let compliance = material.contact_compliance().unwrap();
    let transform = |s: Complex<f64>| (1.0 - nu(s)) / (2.0 * modulus_pa(s)) / s;
    for k in 0..20 {
        let time_s = 10_f64.powf(-5.0 + 0.5 * f64::from(k));
        let exact_per_pa = inverted(transform, time_s);
        let found_per_pa = compliance.compliance(time_s);
        near!(found_per_pa, exact_per_pa, 1e-8, "{time_s:e}");
        let found = material.poisson_ratio_at(time_s).unwrap();
        let off = found - inverted(|s| nu(s) / s, time_s);
        below!(off.abs(), 1e-8, "{time_s:e}");
    }
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
fn contact_compliance_and_poisson_ratio_are_the_inverses_of_their_transforms() {
    let material = shear(BULK_PA);
    assert_inverse(&material, |s| poisson_ratio(BULK_PA.into(), modulus_pa(s)));
    // From the glass to the rubber.
    let elastic = |g: f64| poisson_ratio(BULK_PA.into(), g.into()).re;
    let at = |time_s| material.poisson_ratio_at(time_s).unwrap();
    let glass = EQUILIBRIUM_PA + BRANCHES.iter().map(|(g, _)| g).sum::<f64>();
    below!((at(0.0) - elastic(glass)).abs(), 1e-14);
    below!((at(f64::INFINITY) - elastic(EQUILIBRIUM_PA)).abs(), 1e-14);
    assert_eq!(material.poisson_ratio(), None);
}

#[test]
fn the_limits_are_those_of_an_incompressible_and_of_an_elastic_body() {
    // K to infinity: nu to 1/2, and C to J/4, but for G/K.
    let bodies = [of_shear(0.5), shear(1e26)];
    for time_s in [0.0, 1e-3, 1.0, 1e4] {
        let of = |body: &Material| body.contact_compliance().unwrap().compliance(time_s);
        near!(of(&bodies[1]), of(&bodies[0]), 1e-14, "{time_s}");
    }
    for omega in [0.0, 1e-2, 1e3] {
        let [a, b] = bodies
            .each_ref()
            .map(|body| body.longitudinal_complex_modulus(omega));
        below!((b / a - 1.0).norm(), 1e-14);
    }
    // Without branches the constant Poisson ratio is that of the two moduli.
    let bulk = constant(BULK_PA);
    let nu = (3.0 * BULK_PA - 2e9) / (2.0 * (3.0 * BULK_PA + 1e9));
    let with = |known: Compressibility| {
        let made = Material::from_relaxation(series(1e9, &[]), ModulusKind::Shear, known);
        let compliance = made.unwrap().contact_compliance().unwrap();
        compliance.instantaneous_compliance()
    };
    near!(with(bulk), with(nu.into()), 1e-15);
}

#[test]
fn moduli_in_tension_are_the_same_solid() {
    let shear = shear(BULK_PA);
    let tension = shear.relaxation_as(ModulusKind::Longitudinal);
    let tension = tension.unwrap().unwrap();
    let again = material_of(tension.clone(), constant(BULK_PA));
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
    assert_inverse(&material, |s| poisson_ratio(bulk_pa(s), modulus_pa(s)));
    for omega in [1e-3, 0.7, 40.0, 1e5] {
        let s = Complex::new(0.0, omega);
        let (g, k) = (modulus_pa(s), bulk_pa(s));
        let young = 9.0 * k * g / (3.0 * k + g);
        let contact = 2.0 * g / (1.0 - poisson_ratio(k, g));
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
    let bulk = Compressibility::BulkModulus(shear_series().scaled(ratio).unwrap());
    let material = of_shear(bulk.clone());
    let [own, plain] = [&material, &of_shear(nu)].map(|m| m.contact_compliance().unwrap());
    for time_s in [0.0, 1e-3, 0.2, 5.0, 1e4] {
        near!(own.compliance(time_s), plain.compliance(time_s), 1e-12);
        let found = material.poisson_ratio_at(time_s).unwrap();
        below!((found - nu).abs(), 1e-12);
    }
    let tension = Material::from_relaxation(shear_series(), ModulusKind::Longitudinal, bulk);
    let refused = tension.unwrap_err().to_string();
    assert!(refused.contains("goes with shear moduli"), "{refused}");
}

#[test]
fn losses_and_moduli_of_loops_are_those_of_correspondence() {
    let material = shear(BULK_PA);
    let compliance = material.contact_compliance().unwrap();
    for omega in [1e-2, 3.0, 1e3] {
        let own = material.longitudinal_complex_modulus(omega);
        let of = |indenter, amplitude_n| {
            let plan = sweep_plan(shear(BULK_PA), indenter, 1.0, amplitude_n);
            result(&with_bars(plan), omega)
        };
        // A punch is linear at any amplitude, a sphere at small ones.
        let (punch, sphere) = (of(punch(1e-3), 0.5), of(sphere(0.01), 1e-3));
        let (_, exact_j) = harmonic((1.0, 0.5), omega, &compliance).flat_punch(1e-3);
        below!((punch.loss_j() - exact_j).abs(), punch.bar_j());
        for result in [punch, sphere] {
            let (storage, loss) = (result.storage_modulus_pa, result.loss_modulus_pa);
            let read = Complex::new(storage.unwrap(), loss.unwrap());
            // 200 steps of a second-order rule.
            below!((read / own - 1.0).norm(), 2e-3, "{omega}: {read} {own}");
        }
    }
}
