//! Instants on cells are solved as exactly as the loss asks for, whatever the material: against instants solved to rounding.

use std::sync::Arc;

use crate::common::{on_cells, run_case, sweep_plan};
use contact_dma::engine::SolverPlan;
use contact_dma::engine::instant_tolerance::SHARE;
use contact_dma::indenter::{Cone, Ellipsoid, Indenter, Sphere};
use contact_dma::material::{Material, ModulusKind, Relaxation, RelaxationBranch};
use contact_dma::sweep::plan::SweepPlan;
use contact_dma::sweep::record::CaseRecord;
use contact_dma::sweep::record::error_bars::Quantity;

/// A solid of 1 GPa at once and `ratio` times less at rest, with a relaxation time of 1 s.
fn solid(ratio: f64, poisson_ratio: f64) -> Material {
    let equilibrium_pa = 1e9 / ratio;
    let branch = RelaxationBranch {
        modulus_pa: 1e9 - equilibrium_pa,
        time_s: 1.0,
    };
    let relaxation = Relaxation::new(equilibrium_pa, vec![branch]).unwrap();
    Material::from_relaxation(relaxation, ModulusKind::Longitudinal, poisson_ratio).unwrap()
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
        ("sphere", Arc::new(Sphere::new(0.01).unwrap())),
        ("cone", Arc::new(Cone::new(1.4).unwrap())),
        ("ellipsoid", Arc::new(Ellipsoid::new(0.02, 0.005).unwrap())),
    ];
    for ratio in [1.3_f64, 1e2, 1e4, 1e5] {
        let material = solid(ratio, 0.45);
        let mut largest = (0.0, 0.0);
        for (name, shape) in &shapes {
            for share in [1e-3, 0.1, 1.0] {
                // About the retardation time, the geometric mean of both times, and the relaxation time.
                for power in [-1.1, -0.5, 0.05] {
                    let omega = ratio.powf(power);
                    let plan = sweep_plan(material.clone(), Arc::clone(shape), 10.0, 10.0 * share);
                    let plan = on_cells(plan, 24, 32);
                    let found = run_case(&plan, omega);
                    let what = format!("{ratio:e} {name} {share} {omega:e}");
                    let Some(loss_j) = found.energy_loss_j() else {
                        panic!("{what}: {:?}", found.message);
                    };
                    let reference = reference(&plan, omega).unwrap_or_else(|| panic!("{what}"));
                    let exact_j = reference.energy_loss_j().unwrap();
                    let error = (loss_j / exact_j - 1.0).abs();
                    let distance = |record: &CaseRecord| record.steady_distance.unwrap();
                    let allowed =
                        SHARE * plan.cycle.tolerance + distance(&found) + distance(&reference);
                    largest = if error / allowed > largest.0 {
                        (error / allowed, error)
                    } else {
                        largest
                    };
                    assert!(error <= allowed, "{what}: {error:e} above {allowed:e}");
                }
            }
        }
        let (share, error) = largest;
        println!("{ratio:e}: at worst {share:.2} of what is allowed, {error:.1e} of the loss");
    }
}

/// A case that needs a tighter tolerance than its loss alone asks for.
#[test]
fn a_modulus_that_changes_by_a_million_has_its_cycle_on_cells() {
    let sphere = Arc::new(Sphere::new(0.01).unwrap());
    let plan = on_cells(sweep_plan(solid(1e6, 0.45), sphere, 10.0, 1.0), 64, 200);
    let cells = run_case(&plan, 10.0);
    let cells_j = cells
        .energy_loss_j()
        .unwrap_or_else(|| panic!("{:?}", cells.message));
    let mut springs = plan.clone();
    springs.solver = SolverPlan::default();
    let springs_j = run_case(&springs, 10.0).energy_loss_j().unwrap();
    // The error of the cells, second order in 1/29 of the radius.
    assert!(
        (cells_j / springs_j - 1.0).abs() < 2e-3,
        "{cells_j:e} {springs_j:e}"
    );
}

#[test]
fn bars_count_in_what_the_instants_leave() {
    let sphere = Arc::new(Sphere::new(0.01).unwrap());
    let mut plan = on_cells(sweep_plan(solid(1e2, 0.45), sphere, 10.0, 5.0), 32, 32);
    plan.cycle.error_bars = true;
    let found = run_case(&plan, 0.1);
    let result = found.result.unwrap();
    let bar = result.errors.unwrap().bar(Quantity::EnergyLoss).unwrap();
    let loss_j = result.analysis.energy_loss_j;
    let least = SHARE * plan.cycle.tolerance + found.steady_distance.unwrap();
    assert!(bar.steady >= 0.999 * least * loss_j);
}
