//! Any solid, any frequency, whose indenter leaves the surface for a part of every cycle: none is without a result, and what bars say
//! holds, of contacts as short as a step too.
//!
//! `SOLIDS=300 CELL_SOLIDS=60 SEED=1 TIMES=8 EVERY=4 cargo test --test physics lift_off -- --nocapture` tries as many as asked for, and
//! compares every fourth with a run that many times finer; without these a few are tried, and every tenth compared.

use crate::common::bars::{self, Judged, bar_over_error};
use crate::common::solids::solid_of_ratio;
use crate::prelude::*;

/// One branch whose relaxation makes a solid this many times softer.
fn zener(ratio: f64, time_s: f64) -> Material {
    solid(1e6, &[(1e6 * (ratio - 1.0), time_s)], 0.4)
}

/// A sweep of this drive, everything else at its default.
fn driven(
    material: Material,
    shape: Arc<dyn Indenter>,
    control: Control,
    (mean, amplitude): (f64, f64),
    phase_rad: f64,
) -> SweepPlan {
    let drive = HarmonicDrive::new(control, mean, amplitude, phase_rad, 0.0).unwrap();
    with(sweep_plan(material, shape, 1.0, 0.5), |plan| {
        plan.base.drive = drive
    })
}

/// Spheres and cones on solids of a modulus ratio of 10 to 10,000; load or approach have a mean of -0.5 to 0.95 of the amplitude, in
/// half of the cases of less than a tenth.
fn lifted_plan(random: &mut Random) -> SweepPlan {
    let material = match random.count(0, 2) {
        0 => {
            let ratio = random.power_of_ten(1.0, 4.0);
            zener(ratio, random.power_of_ten(-3.0, 3.0))
        }
        _ => solid_of_ratio(random, 4.0),
    };
    let shape = match random.count(0, 2) {
        0 => cone(1.2),
        _ => sphere(0.01),
    };
    let (control, amplitude) = match random.count(0, 2) {
        0 => (Control::Approach, random.power_of_ten(-6.0, -4.5)),
        _ => (Control::Load, random.power_of_ten(-1.0, 1.0)),
    };
    let part = match random.count(0, 1) {
        0 => random.between(-0.5, 0.95),
        _ => random.between(-0.1, 0.1),
    };
    // In half of them the contact begins and ends anywhere among the steps.
    let phase_rad = random.between(-TAU, TAU).max(0.0);
    let drive = (part * amplitude, amplitude);
    driven(material, shape, control, drive, phase_rad)
}

/// Eight angular frequencies over ten decades about the middle of the retardation times.
fn ten_decades(material: &Material) -> Vec<f64> {
    let branches = material.creep().branches();
    let logarithms = branches.iter().map(|branch| branch.time_s.ln());
    let middle_s = (logarithms.sum::<f64>() / branches.len() as f64).exp();
    let powers = (0..8).map(|k| -5.0 + 10.0 * f64::from(k) / 7.0);
    powers.map(|power| 10_f64.powf(power) / middle_s).collect()
}

fn lifted_cases(solids: u64, seed: u64) -> Vec<(SweepPlan, f64)> {
    let mut random = Random(seed);
    let of_solid = |_| {
        let plan = lifted_plan(&mut random);
        let omegas = ten_decades(&plan.base.contact.material);
        omegas
            .into_iter()
            .map(move |omega| (plan.clone(), omega))
            .collect::<Vec<_>>()
    };
    (0..solids).flat_map(of_solid).collect()
}

fn described(plan: &SweepPlan, omega: f64) -> String {
    let drive = &plan.base.drive;
    let (mean, amplitude) = (drive.mean(), drive.amplitude());
    let material = &plan.base.contact.material;
    format!(
        "{omega:e} rad/s, {:?} {mean} +- {amplitude}, {}, {:?}",
        drive.control(),
        plan.base.contact.indenter.shape(),
        material.relaxation()
    )
}

/// A case, and its bars over its errors where it was compared.
struct Tried {
    record: CaseRecord,
    judged: Judged,
}

fn tried(
    index: usize,
    (plan, omega): &(SweepPlan, f64),
    finer: &impl Fn(&SweepPlan) -> SweepPlan,
) -> Tried {
    let every = from_environment("EVERY", 10) as usize;
    let with_bars = index % every == 3 % every;
    let mut plan = plan.clone();
    plan.cycle.error_bars = with_bars;
    let record = run_case(&plan, *omega);
    let exact = with_bars.then(|| run_case(&finer(&plan), *omega).result);
    let pair = record.result.as_ref().zip(exact.flatten());
    let steps = |found: &CaseResult| found.contact_duty.steps(record.steps);
    let what = described(&plan, *omega);
    let judged = match pair {
        Some((found, exact)) => {
            let what = format!("{:.1} steps in contact, {what}", steps(found));
            Judged::new(found, &exact, what)
        }
        None => Judged {
            ratios: Vec::new(),
            what,
        },
    };
    Tried { record, judged }
}

/// Runs all; none may be without a result, and of those asked to have bars 95 % lie inside them, of all but the loss all but one
/// at least.
fn check_all(
    name: &str,
    cases: &[(SweepPlan, f64)],
    finer: impl Fn(&SweepPlan) -> SweepPlan + Sync,
) {
    let tried = (cases.par_iter().enumerate()).map(|(index, case)| tried(index, case, &finer));
    let all: Vec<Tried> = tried.collect();
    let mut failed = 0;
    for Tried { record, judged } in &all {
        if record.result.is_none() {
            println!("FAILED {:?}: {}", record.message, judged.what);
            failed += 1;
        }
    }
    let marched = all.iter().filter(|t| t.record.method == Method::March);
    let marched = marched.count();
    let cycles = all.iter().map(|tried| tried.record.cycles);
    println!(
        "{name}: {} cases, {failed} without a result, {marched} marched, cycles {:?} at most, {:.1} on average",
        all.len(),
        cycles.clone().max(),
        cycles.sum::<usize>() as f64 / all.len() as f64
    );
    let always = |quantity| f64::from(u8::from(quantity != Quantity::EnergyLoss));
    let allowed = |quantity, of: f64| (0.05 * of).max(always(quantity));
    let judged: Vec<Judged> = all.into_iter().map(|tried| tried.judged).collect();
    bars::check(name, &judged, allowed, f64::INFINITY);
    assert!(failed == 0, "{failed} of {} cases", cases.len());
    assert!(marched == 0, "{marched} cases were not found directly");
}

#[test]
fn on_springs_every_cycle_that_lifts_off_is_found_directly() {
    let cases = lifted_cases(from_environment("SOLIDS", 12), from_environment("SEED", 34));
    let times = from_environment("TIMES", 4) as usize;
    check_all("springs", &cases, |plan| {
        with(plan.clone(), |finer| {
            (finer.cycle.error_bars, finer.cycle.tolerance) = (false, 1e-6);
            finer.cycle.steps *= times;
            finer.solver.springs *= times.min(4);
        })
    });
}

#[test]
fn on_cells_every_cycle_that_lifts_off_is_found_directly() {
    let seed = from_environment("SEED", 34) + 1;
    let mut coarse = lifted_cases(from_environment("CELL_SOLIDS", 2), seed);
    for (plan, _) in &mut coarse {
        *plan = on_cells(plan.clone(), 32, 48);
    }
    // Against springs, which are as good as exact beside so few cells.
    check_all("cells", &coarse, |plan| {
        with(plan.clone(), |springs| {
            (springs.cycle, springs.solver) = (CyclePlan::DEFAULT, SolverPlan::default());
            (springs.cycle.steps, springs.cycle.error_bars) = (400, false);
        })
    });
}

/// Of the cases above by their seed and number, those of cells that come and go between one cycle and the next: what the acceleration
/// has learned of some of them leads it in circles, in which a march ends too.
const COME_AND_GO: [(u64, &[usize]); 2] = [(2, &[172, 173, 174, 175]), (6, &[582, 739, 1788])];

#[test]
fn cells_that_come_and_go_between_cycles_keep_none_from_being_found() {
    let cases = COME_AND_GO.into_iter().flat_map(|(seed, indices)| {
        indices.iter().map(move |&index| {
            let (plan, omega) = lifted_cases(index as u64 / 8 + 1, seed).swap_remove(index);
            (on_cells(plan, 32, 48), omega)
        })
    });
    cases
        .collect::<Vec<_>>()
        .par_iter()
        .for_each(|(plan, omega)| {
            let (record, what) = (run_case(plan, *omega), described(plan, *omega));
            assert!(record.result.is_some(), "{:?}: {what}", record.message);
            assert_eq!(record.method, Method::Direct, "{what}");
        });
}

#[test]
fn nothing_jumps_where_a_branch_no_longer_moves_within_the_period() {
    // T/lambda passes 1e-5 between the frequencies; the loss times the frequency hardly depends on it so far above the spectrum.
    let time_s = 100.0;
    let omegas = [0.8, 0.99, 1.01, 1.25].map(|part| part * TAU / (1e-5 * time_s));
    let drives = [
        (Control::Approach, (-2e-6, 3e-6)),
        (Control::Load, (-0.5, 1.0)),
        (Control::Load, (0.3, 1.0)),
    ];
    for (ratio, (control, drive)) in [1e2, 1e4].into_iter().flat_map(|r| drives.map(|d| (r, d))) {
        // The retardation time is longer than the relaxation time by the ratio.
        let material = zener(ratio, time_s / ratio);
        let mut plan = driven(material, sphere(0.01), control, drive, 0.0);
        (plan.cycle.steps, plan.cycle.tolerance) = (100, 1e-6);
        let products = omegas.map(|omega| omega * loss_j(&plan, omega));
        for product in products {
            near!(product, products[0], 1e-3, "{control:?} {drive:?} {ratio}");
        }
    }
}

/// Numbers of a cycle that feel where it is touched.
const AT_THE_TOUCH: [Quantity; 4] = [
    Quantity::EnergyLoss,
    Quantity::ApproachMin,
    Quantity::ApproachMax,
    Quantity::ContactRadiusMax,
];

/// Of these quantities those whose bar is smaller than its error.
fn outside<const N: usize>(
    found: &CaseResult,
    exact: &CaseResult,
    quantities: [Quantity; N],
) -> Vec<(Quantity, f64)> {
    let of = |quantity| Some((quantity, bar_over_error(found, exact, quantity)?));
    let ratios = quantities.into_iter().filter_map(of);
    ratios.filter(|(_, ratio)| *ratio < 1.0).collect()
}

/// With its bars and in many times the steps.
fn found_and_in_many_steps(plan: &SweepPlan, omega: f64, times: usize) -> [CaseRecord; 2] {
    let [mut found, mut exact] = [plan.clone(), plan.clone()];
    found.cycle.error_bars = true;
    exact.cycle.error_bars = false;
    exact.cycle.steps *= times;
    [found, exact].map(|plan| run_case(&plan, omega))
}

/// A solid of moderate relaxation under a sphere, and a frequency.
fn moderate(random: &mut Random, drive: (f64, f64)) -> (SweepPlan, f64) {
    let material = solid_of_ratio(random, 1.3);
    let slowest_s = material.creep().branches().last().unwrap().time_s;
    let omega = random.power_of_ten(-1.0, 1.5) / slowest_s;
    let phase_rad = random.between(0.0, TAU);
    let mut plan = driven(material, sphere(0.01), Control::Load, drive, phase_rad);
    plan.solver.springs = 60;
    (plan, omega)
}

#[test]
fn extremes_of_a_cycle_that_lifts_off_lie_inside_their_bars_and_on_its_samples() {
    let mut random = Random(57);
    let case = |_| {
        let amplitude_n = random.between(1.05, 5.0);
        moderate(&mut random, (1.0, amplitude_n))
    };
    let cases: Vec<_> = (0..40).map(case).collect();
    let outside: Vec<String> = cases
        .par_iter()
        .flat_map_iter(|(plan, omega)| {
            let [found, exact] =
                found_and_in_many_steps(plan, *omega, 16).map(|record| record.result.unwrap());
            let samples = &found.cycle.samples.approach_m;
            let least_m = samples.iter().copied().fold(f64::INFINITY, f64::min);
            let what = described(plan, *omega);
            assert!(found.approach_m.minimum >= least_m, "{what}");
            let outside = outside(&found, &exact, AT_THE_TOUCH).into_iter();
            outside.map(move |it| format!("{it:?}, {what}"))
        })
        .collect();
    println!("{} of 160 outside: {outside:#?}", outside.len());
    assert!(outside.len() <= 3);
}

/// Contacts of 0.6 to 9 of 200 steps on solids of moderate relaxation, anywhere among the steps.
fn short_contacts(count: u32) -> Vec<(f64, SweepPlan, f64)> {
    let mut random = Random(9);
    let of = |k: u32| {
        let steps_in_contact = 0.6 * 15_f64.powf(f64::from(k) / f64::from(count - 1));
        let mean_n = (PI * (steps_in_contact / 200.0 - 0.5)).sin();
        let (plan, omega) = moderate(&mut random, (mean_n, 1.0));
        (steps_in_contact, plan, omega)
    };
    (0..count).map(of).collect()
}

#[test]
fn a_contact_of_a_few_steps_is_warned_of_and_lies_inside_its_bars() {
    const OF_LOOP: [Quantity; 4] = [
        Quantity::EnergyLoss,
        Quantity::PhaseLag,
        Quantity::Harmonic2,
        Quantity::Harmonic3,
    ];
    let cases = short_contacts(from_environment("SHORT", 24) as u32);
    let outside: Vec<String> = cases
        .par_iter()
        .flat_map_iter(|(steps_in_contact, plan, omega)| {
            let [found, exact] = found_and_in_many_steps(plan, *omega, 64);
            // No step may fall into a contact shorter than one.
            let Some(result) = &found.result else {
                assert!(*steps_in_contact < 1.0, "{:?}", found.message);
                return Vec::new();
            };
            let codes = found.warnings.iter().map(|warning| warning.code());
            let codes: Vec<_> = codes.collect();
            let told = |code: &str| codes.contains(&code);
            assert!(told("short-contact"), "{steps_in_contact}: {codes:?}");
            // It is chance what so few see, and half or a quarter of the steps may see nothing.
            if result.errors.is_none() {
                let is_chance = told("no-error-bars") && *steps_in_contact < 4.0;
                assert!(is_chance, "{steps_in_contact}: {codes:?}");
                return Vec::new();
            }
            let outside = outside(result, &exact.result.unwrap(), OF_LOOP).into_iter();
            let outside = outside.map(|it| format!("{steps_in_contact} steps: {it:?}"));
            outside.collect()
        })
        .collect();
    println!("of {} cases outside: {outside:#?}", cases.len());
    assert!(outside.is_empty());
}

#[test]
fn an_open_cycle_has_its_extremes_on_its_own_samples() {
    let creep = classical::zener(65e6, 935e6, 8.4).unwrap();
    let material = Material::from_creep(creep, ModulusKind::Shear, 0.3).unwrap();
    for phase_rad in [0.0, 0.25 * TAU, 0.4 * TAU, 0.8 * TAU] {
        let drive = (1.0, 0.2);
        let (material, ball) = (material.clone(), sphere(0.01));
        let mut plan = driven(material, ball, Control::Load, drive, phase_rad);
        (plan.cycle.method, plan.cycle.at_cycle) = (Method::March, Some(1));
        let [found, exact] =
            found_and_in_many_steps(&plan, 6.67, 8).map(|record| record.result.unwrap());
        for quantity in [Quantity::ApproachMin, Quantity::ApproachMax] {
            let ratio = bar_over_error(&found, &exact, quantity).unwrap();
            assert!(ratio > 1.0, "{phase_rad}: {quantity:?} {ratio}");
        }
        let samples = &found.cycle.samples.approach_m;
        let last_m = samples.last().copied().unwrap();
        if samples.iter().all(|approach_m| *approach_m <= last_m) {
            assert_eq!(found.approach_m.maximum, last_m);
        }
    }
}
