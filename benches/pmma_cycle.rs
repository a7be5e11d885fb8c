//! The loop area of PMMA under a sphere, W = 10 N + 5 N sin(0.01 rad/s t), beside other programs: half-space engine, one thread,
//! the stabilised cycle found directly. Prints one JSON line, with the error against the springs at ten times the resolution.
//!
//!     cargo bench --bench pmma_cycle -- [CELLS] [STEPS] [constant] [whole]
//!
//! `constant` takes the first-order rule of the base paper and marches, as it does; `whole` moves the sphere off the axis, so that there
//! is no quarter to take.

mod common;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use common::{LOAD_N, RADIUS_M, numbers, peak_mib, timed};
use contact_dma::drive::HarmonicDrive;
use contact_dma::engine::EngineKind;
use contact_dma::history::TimeRule;
use contact_dma::indenter::{Indenter, Shifted, Sphere};
use contact_dma::material::library;
use contact_dma::sweep::case::Setup;
use contact_dma::sweep::plan::{Method, SweepPlan};
use contact_dma::sweep::record::CaseRecord;

const OMEGA_RAD_PER_S: f64 = 0.01;

/// The plan, whose cycle and solver are those of the half-space engine.
fn plan(cells: usize, steps: usize, constant: bool, whole: bool) -> SweepPlan {
    let entry = library::find("pmma").expect("in the library");
    let sphere: Arc<dyn Indenter> = Arc::new(Sphere::new(RADIUS_M).expect("a positive radius"));
    let sphere = match whole {
        true => Arc::new(Shifted::new(sphere, 1.37e-6, 7.1e-7).expect("a short way")),
        false => sphere,
    };
    let drive = HarmonicDrive::load(LOAD_N, 0.5 * LOAD_N).expect("a valid drive");
    let pmma = entry.material().expect("a tested entry");
    let mut plan = SweepPlan::new(pmma, sphere, drive);
    plan.angular_frequencies_rad_per_s = vec![OMEGA_RAD_PER_S];
    plan.cycle.steps = steps;
    plan.cycle.error_bars = false;
    if constant {
        plan.cycle.method = Method::March;
        plan.solver.time_rule = TimeRule::Constant;
    }
    plan.solver.engine = EngineKind::HalfSpace;
    plan.solver.cells = cells;
    plan
}

fn solved(plan: SweepPlan) -> CaseRecord {
    let setup = Setup::new(plan).expect("a valid plan");
    let case = &setup.plan().cases()[0];
    let interrupt = AtomicBool::new(false);
    setup.run(case, &interrupt).expect("not interrupted")
}

fn main() {
    let numbers = numbers();
    let cells = numbers.first().copied().unwrap_or(256);
    let steps = numbers.get(1).copied().unwrap_or(80);
    let is_given = |word: &str| std::env::args().any(|argument| argument == word);
    let (constant, whole) = (is_given("constant"), is_given("whole"));
    let (cpu_s, record) = timed(|| solved(plan(cells, steps, constant, whole)));
    let peak_mib = peak_mib();
    let mut exact = plan(0, 2000, false, false);
    (exact.solver.engine, exact.solver.springs) = (EngineKind::Axisymmetric, 4000);
    let exact_j = solved(exact).energy_loss_j().expect("converged");
    let loss_j = record.energy_loss_j().expect("converged");
    println!(
        "{{\"cells\": {cells}, \"steps\": {steps}, \"cpu_s\": {cpu_s:.3}, \"cycles\": {}, \"convolutions\": {}, \"convolutions_per_step\": {:.2}, \
         \"energy_loss_j\": {loss_j:.6e}, \"exact_loss_j\": {exact_j:.6e}, \"relative_loss_error\": {:.2e}, \"peak_mib\": {peak_mib:.1}}}",
        record.cycles,
        record.work.convolutions,
        record.work.convolutions as f64 / record.work.instants as f64,
        (loss_j / exact_j - 1.0).abs(),
    );
}
