//! Laws from measured cycles and histories: whether bands hold E' and E'', and whether the law is the one that the numbers were made with.
//!
//! `SOLIDS=30 cargo test --release --test physics identified_laws -- --nocapture` makes as many solids of each law as asked for.

use crate::identified::*;
use crate::prelude::*;
use contact_dma::identify::data::Number;
use contact_dma::identify::resolved::forms;
use contact_dma::identify::{Driven, IdentifyPlan};
use contact_dma::material::law::{Form, Law};

/// A law with random parameters that show within the times.
fn any(law: Law, random: &mut Random, (shortest_s, longest_s): (f64, f64)) -> (Form, Vec<f64>) {
    let form = Form { law, branches: 2 };
    let modulus_pa = random.power_of_ten(4.0, 9.0);
    let equilibrium_pa = modulus_pa * random.power_of_ten(-1.0, 0.3);
    let time_s = |low: f64, high: f64, random: &mut Random| {
        let part = low + (high - low) * random.unit();
        shortest_s * (longest_s / shortest_s).powf(part)
    };
    let exponent = 0.15 + 0.6 * random.unit();
    let values = match law {
        Law::StandardSolid => vec![equilibrium_pa, modulus_pa, time_s(0.2, 0.8, random)],
        Law::FractionalZener | Law::Kww => {
            vec![
                equilibrium_pa,
                modulus_pa,
                time_s(0.3, 0.7, random),
                exponent,
            ]
        }
        Law::PowerLaw | Law::FractionalMaxwell => panic!("a fluid has no cycle"),
        Law::KelvinVoigt => vec![equilibrium_pa, modulus_pa, exponent],
        Law::Series => {
            let branches = [time_s(0.1, 0.4, random), time_s(0.6, 0.9, random)];
            let parts = [modulus_pa, modulus_pa * random.power_of_ten(-0.7, 0.3)];
            let branches = parts.into_iter().zip(branches);
            let branches = branches.flat_map(|(modulus, time)| [modulus, time]);
            [equilibrium_pa].into_iter().chain(branches).collect()
        }
    };
    (form, values)
}

struct Count {
    inside: usize,
    points: usize,
    told: usize,
    rightly: usize,
    chosen: usize,
    solids: usize,
}

fn check(law: Law, drive: HarmonicDrive, numbers: &[Number], random: &mut Random) -> Count {
    let omegas: Vec<f64> = log_spaced(0.1, 1e3, 13);
    let times_s = (1e-3, 10.0);
    let indenter: Arc<dyn Indenter> = Arc::new(Sphere::new(2e-3).unwrap());
    let mut count = Count {
        inside: 0,
        points: 0,
        told: 0,
        rightly: 0,
        chosen: 0,
        solids: 0,
    };
    for _ in 0..from_environment("SOLIDS", 2) {
        let (form, values) = any(law, random, times_s);
        let truth = form.series_within(&values, (1e-5, 1e3)).unwrap();
        let material = Material::from_relaxation(truth, ModulusKind::Longitudinal, 0.45).unwrap();
        let mut sweep = SweepPlan::new(material, indenter.clone(), drive);
        sweep.cycle.error_bars = false;
        sweep.cycle.steps = 200;
        let measured = of_cycles(sweep, &omegas, numbers, Noise::of(0.01, true), random);
        let mut plan = IdentifyPlan::new(0.45, indenter.clone(), Driven::Cycles(drive), measured);
        let all = forms(&["auto".to_owned()], None, 6).into_iter();
        plan.laws = Some(all.filter(|form| form.is_solid()).collect());
        let found = match found(&plan) {
            Ok(found) => found,
            Err(error) => panic!("{form:?} {values:?}: {error}"),
        };
        let laws = found.laws.as_ref().unwrap();
        let mut inside = 0;
        for omega in &omegas {
            let (exact, band) = (
                form.complex_modulus_pa(&values, *omega).unwrap(),
                found.band(*omega),
            );
            let within =
                |own: f64, exact: f64, factor: f64| (own / exact).ln().abs() <= factor.ln();
            inside += usize::from(within(band.storage_pa, exact.re, band.storage_factor));
            inside += usize::from(within(band.loss_pa, exact.im, band.loss_factor));
        }
        let best = laws.best().form;
        let is_right = best.law == law && (law != Law::Series || best.branches == form.branches);
        let is_told = laws.others().next().is_none();
        println!(
            "{} {values:?}: {} {}, {inside} of {}, chi squared {:.2}",
            law.name(),
            best.in_words(),
            if is_told { "told" } else { "not told" },
            2 * omegas.len(),
            laws.reduced_chi_squared
        );
        count.inside += inside;
        count.points += 2 * omegas.len();
        count.told += usize::from(is_told);
        count.rightly += usize::from(is_told && is_right);
        count.chosen += usize::from(is_right);
        count.solids += 1;
    }
    println!(
        "{} under {}: {} of {} inside, chosen {} of {}, told {}, rightly {}",
        law.name(),
        drive.control().name(),
        count.inside,
        count.points,
        count.chosen,
        count.solids,
        count.told,
        count.rightly
    );
    count
}

#[test]
fn laws_of_cycles_are_found_and_their_bands_hold_the_moduli() {
    let random = &mut Random(from_environment("SEED", 5));
    let (mut inside, mut points, mut told, mut rightly) = (0, 0, 0, 0);
    let solids = Law::NAMES.iter().map(|(_, law)| *law);
    for law in solids.filter(|law| {
        (Form {
            law: *law,
            branches: 1,
        })
        .is_solid()
    }) {
        let approach = HarmonicDrive::approach(1e-5, 2e-7).unwrap();
        let load = HarmonicDrive::load(0.2, 0.1).unwrap();
        let counts = [
            check(
                law,
                approach,
                &[Number::PhaseLag, Number::LoadAmplitude],
                random,
            ),
            check(
                law,
                load,
                &[Number::PhaseLag, Number::ApproachAmplitude],
                random,
            ),
        ];
        for count in counts {
            inside += count.inside;
            points += count.points;
            told += count.told;
            rightly += count.rightly;
        }
    }
    println!("{inside} of {points} inside; told {told}, rightly {rightly}");
    assert!(inside as f64 >= 0.9 * points as f64, "{inside} of {points}");
    assert!(rightly as f64 >= 0.9 * told as f64, "{rightly} of {told}");
}
