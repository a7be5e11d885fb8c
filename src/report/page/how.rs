//! How the numbers were obtained: engine, resolution, cycles, errors, energy balance, and every message.

use maud::Markup;

use super::question::{Facts, list};
use crate::engine::{EngineKind, SolverPlan};
use crate::history::TimeRule;
use crate::report::words::{self, case, nodes_name, range};
use crate::sweep::plan::SweepPlan;
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::record::{CaseRecord, Status};
use crate::sweep::search::run::Outcome;

/// The section of a sweep.
pub(super) fn sweep(plan: &SweepPlan, outcome: &Outcome) -> Markup {
    let mut facts = Facts::default();
    let records = &outcome.records;
    let planned = plan.cases().len();
    facts.add(
        "cases",
        format!(
            "{} planned, {} converged, {} not converged, {} failed",
            planned.max(records.len()),
            outcome.count(Status::Converged),
            outcome.count(Status::NotConverged),
            outcome.count(Status::Failed)
        ),
    );
    let integer = |value: fn(&CaseRecord) -> f64| range(records.iter().map(value), 0);
    let known = |value: fn(&CaseRecord) -> Option<f64>| range(records.iter().filter_map(value), 2);
    let nodes = integer(|r| r.nodes as f64);
    engine(&mut facts, &plan.solver, &plan.base.contact, &nodes);
    let (method, tolerance) = (plan.cycle.method.name(), plan.cycle.tolerance);
    match plan.cycle.at_cycle {
        Some(number) => facts.add("cycle", format!("number {number} after the hold, as it is")),
        None => facts.add(
            "stabilised cycle",
            format!("method {method}, tolerance {tolerance:e}"),
        ),
    }
    facts.add("time steps per cycle", integer(|r| r.steps as f64));
    facts.add("cycles solved per case", integer(|r| r.cycles as f64));
    // What is less than rounding says nothing.
    facts.add(
        "distance to the stabilised cycle, or rounding where that is more",
        known(|r| Some(r.steady_distance?.max(f64::EPSILON))),
    );
    facts.add(
        "estimated error of the loss, relative",
        known(|r| Some((r.energy_loss_error_j()? / r.energy_loss_j()?).abs())),
    );
    let of_material =
        |r: &CaseRecord| Some((r.energy_loss_material_error_j()? / r.energy_loss_j()?).abs());
    if records.iter().any(|r| of_material(r).is_some()) {
        let (range, replicas) = (known(of_material), words::replicas(plan));
        facts.add(
            "uncertainty of the loss from the material, relative",
            format!("{range} (95 %, {replicas} bootstrap samples)"),
        );
    }
    facts.add(
        "error of the energy balance (dissipated by branches / area of loop − 1)",
        known(|r| r.result.as_ref()?.energy_imbalance().map(f64::abs)),
    );
    if let Some(accuracy) = plan.cycle.accuracy {
        facts.add("accuracy asked for", format!("{accuracy:e}"));
    }
    let message = |r: &CaseRecord| {
        let case = case(plan.figures.frequency_unit, r.angular_frequency_rad_per_s);
        Some(format!("{case}: {}", r.message.as_ref()?))
    };
    match records.iter().any(|r| r.message.is_some()) {
        true => facts.add("messages", list(records.iter().filter_map(message))),
        false => facts.add("messages", "none"),
    }
    facts.html()
}

/// Adds which engine solved a contact, and on how many nodes: those of a map, or so many.
pub(super) fn engine<M>(
    facts: &mut Facts,
    solver: &SolverPlan,
    contact: &ContactPlan<M>,
    nodes: &str,
) {
    let engine = match solver.engine {
        EngineKind::Axisymmetric => {
            "axisymmetric: independent springs (method of dimensionality reduction), exact for convex bodies of revolution"
        }
        EngineKind::HalfSpace => {
            "half-space: cells of uniform pressure, Love's influence coefficients, FFT convolution, conjugate gradients"
        }
    };
    facts.add("engine", engine);
    let rule = match solver.time_rule {
        TimeRule::Linear => "linear between time steps, second order",
        TimeRule::Constant => "constant over a time step, first order",
    };
    facts.add("time rule", rule);
    match contact.indenter.own_cells() {
        Some((x, y)) => facts.add("cells of the map", format!("{x} × {y}")),
        None => facts.add(nodes_name(solver.engine), nodes),
    }
}
