//! What whole cases cost, counted and not timed: instants, iterations and convolutions of searches, error bars and all that is recorded.
//! A number that is new in the results must not make a case dearer unseen.

use std::sync::Arc;

use crate::common::{on_cells, pmma_material, run_case, sweep_plan};
use contact_dma::drive::{Control, HarmonicDrive};
use contact_dma::history::Work;
use contact_dma::indenter::{Cone, Ellipsoid, FlatPunch, Indenter, Sphere};
use contact_dma::sweep::plan::{Method, SweepPlan};

/// PMMA near its peak under 10 N and 5 N, in 64 steps on 100 springs.
fn on_springs(indenter: impl Indenter + 'static) -> SweepPlan {
    let mut plan = sweep_plan(pmma_material(), Arc::new(indenter), 10.0, 5.0);
    plan.cycle.steps = 64;
    plan.solver.springs = 100;
    plan
}

fn with(mut plan: SweepPlan, change: impl Fn(&mut SweepPlan)) -> SweepPlan {
    change(&mut plan);
    plan
}

fn with_bars(plan: SweepPlan) -> SweepPlan {
    with(plan, |plan| plan.cycle.error_bars = true)
}

#[test]
fn cases_cost_what_they_did() {
    let sphere = || on_springs(Sphere::new(0.01).unwrap());
    let on_32 = |plan| on_cells(plan, 32, 64);
    let drive = |mean, amplitude| HarmonicDrive::load(mean, amplitude).unwrap();
    let tapping = with(sphere(), |plan| plan.base.drive = drive(10.0, 15.0));
    let pressed = with(sphere(), |plan| {
        let drive = HarmonicDrive::new(Control::Approach, 40e-6, 10e-6, 0.0, 0.0);
        plan.base.drive = drive.unwrap();
    });
    let marched = with(sphere(), |plan| plan.cycle.method = Method::March);
    let cone = on_springs(Cone::new(1.4).unwrap());
    let punch = on_springs(FlatPunch::new(1e-3).unwrap());
    let ellipsoid = on_springs(Ellipsoid::new(0.01, 0.02).unwrap());
    let mut dearer = Vec::new();
    // Instants, iterations and convolutions seen; 5 % of room for the last digits of another machine.
    for (name, plan, seen) in [
        ("sphere", sphere(), [260, 749, 0]),
        ("sphere with bars", with_bars(sphere()), [657, 1898, 0]),
        ("cone with bars", with_bars(cone), [657, 1924, 0]),
        ("tapping sphere", tapping.clone(), [260, 593, 0]),
        ("prescribed approach", pressed.clone(), [195, 195, 0]),
        ("marched", marched, [258, 746, 0]),
        ("sphere on cells", on_32(sphere()), [260, 713, 1182]),
        (
            "sphere on cells with bars",
            with_bars(on_32(sphere())),
            [525, 1525, 2570],
        ),
        ("punch on cells", on_32(punch), [260, 110, 562]),
        ("ellipsoid on cells", on_32(ellipsoid), [260, 913, 1459]),
        ("tapping sphere on cells", on_32(tapping), [260, 643, 1174]),
        (
            "prescribed approach on cells",
            on_32(pressed),
            [195, 712, 1118],
        ),
    ] {
        let record = run_case(&plan, 0.01);
        assert!(record.result.is_some(), "{name}: {:?}", record.message);
        let Work {
            instants,
            iterations,
            convolutions,
        } = record.work;
        let found = [instants, iterations, convolutions];
        println!("{name}: {found:?}");
        let mut pairs = found.into_iter().zip(seen);
        if pairs.any(|(found, seen)| 20 * found > 21 * seen) {
            dearer.push((name, found, seen));
        }
    }
    assert!(dearer.is_empty(), "{dearer:#?}");
}
