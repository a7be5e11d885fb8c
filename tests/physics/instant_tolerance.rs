//! Instants on cells are solved as exactly as the loss asks for, whatever the material: against instants solved to rounding.

use crate::prelude::*;
use contact_dma::engine::instant_tolerance::SHARE;

/// A solid of 1 GPa at once and `ratio` times less at rest, with a relaxation time of 1 s.
fn relaxing(ratio: f64) -> Material {
    solid(1e9 / ratio, &[(1e9 - 1e9 / ratio, 1.0)], 0.45)
}

/// The same case at tolerances far tighter than the program chooses: the tightest with which a search does not end in rounding.
fn reference(plan: &SweepPlan, omega: f64) -> Option<CaseRecord> {
    let tolerances = [1e-11, 1e-9];
    let pairs = tolerances.into_iter().flat_map(|t| [(t, 1e-2), (t, 1.0)]);
    let mut records = pairs.map(|(instant, cycle)| {
        let mut plan = plan.clone();
        plan.solver.tolerance = Some(instant);
        plan.cycle.tolerance *= cycle;
        run_case(&plan, omega)
    });
    records.find(|record| record.result.is_some())
}

/// The loss at the tolerances that the program chooses, against tighter ones.
#[test]
fn what_the_instants_leave_in_the_loss_is_a_tenth_of_the_cycles_tolerance() {
    let shapes: [(&str, Arc<dyn Indenter>); 3] = [
        ("sphere", sphere(0.01)),
        ("cone", cone(1.4)),
        ("ellipsoid", Arc::new(Ellipsoid::new(0.02, 0.005).unwrap())),
    ];
    for ratio in [1.3_f64, 1e2, 1e4, 1e5] {
        let material = relaxing(ratio);

        for (name, shape) in &shapes {
            for share in [1e-3, 0.1, 1.0] {
                // About the retardation time, the geometric mean of both times, and the relaxation time.
                for power in [-1.1, -0.5, 0.05] {
                    let omega = ratio.powf(power);
                    let plan = sweep_plan(material.clone(), Arc::clone(shape), 10.0, 10.0 * share);
                    let plan = on_cells(plan, 24, 32);
                    let found = run_case(&plan, omega);
                    let what = format!("{ratio:e} {name} {share} {omega:e}");
                    let reference = reference(&plan, omega).unwrap_or_else(|| panic!("{what}"));
                    let pair = [&found, &reference];
                    let [loss_j, exact_j] = pair.map(|record| record.energy_loss_j().unwrap());
                    let distances = pair.map(|record| record.steady_distance.unwrap());
                    let allowed = SHARE * plan.cycle.tolerance + distances[0] + distances[1];
                    let error = relative(loss_j, exact_j).abs();
                    assert!(error <= allowed, "{what}: {error:e} above {allowed:e}");
                }
            }
        }
    }
}

/// A case that needs a tighter tolerance than its loss alone asks for.
#[test]
fn a_modulus_that_changes_by_a_million_has_its_cycle_on_cells() {
    let plan = sweep_plan(relaxing(1e6), sphere(0.01), 10.0, 1.0);
    let cells = on_cells(plan, 64, 200);
    let springs = with(cells.clone(), |plan| plan.solver = SolverPlan::default());
    // The error of the cells, second order in 1/29 of the radius.
    near!(loss_j(&cells, 10.0), loss_j(&springs, 10.0), 2e-3);
}

#[test]
fn bars_count_in_what_the_instants_leave() {
    let plan = sweep_plan(relaxing(1e2), sphere(0.01), 10.0, 5.0);
    let plan = with_bars(on_cells(plan, 32, 32));
    let found = run_case(&plan, 0.1);
    let result = found.result.unwrap();
    let bar = result.errors.unwrap().bar(Quantity::EnergyLoss).unwrap();
    let loss_j = result.analysis.energy_loss_j;
    let least = SHARE * plan.cycle.tolerance + found.steady_distance.unwrap();
    assert!(bar.steady >= 0.999 * least * loss_j);
}
