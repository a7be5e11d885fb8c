//! Stabilised cycles of one engine, with the surface at the quarters of the cycle, and cycles marched from rest.
//!
//! On many cells a cycle is dear. Its memory is therefore found on half as many per side, carried over, and one cycle
//! marched: what the coarse memory was wrong by is a part of the discretisation error, and decays in that cycle.

use std::f64::consts::TAU;
use std::sync::atomic::{AtomicBool, Ordering};

use super::ReproductionError;
use crate::contact::surface::Surface;
use crate::contact::{ContactError, Engine};
use crate::cycle::{self, Loop};
use crate::history::March;
use crate::steady::{self, SteadySettings};
use crate::sweep::case::{Setup, SetupError};
use crate::sweep::engine::{EngineBuilder, LargestContact, prescribed};
use crate::sweep::plan::{Case, EngineKind, SolverPlan, SweepPlan};
use crate::sweep::record::CaseResult;

/// A stabilised cycle with its surfaces.
#[derive(Debug, Clone)]
pub(super) struct Stabilised {
    pub(super) samples: Loop,
    /// At one, two and three quarters of the cycle.
    pub(super) surfaces: Vec<Surface>,
    /// Side of a cell, or width of a spring (m).
    pub(super) spacing_m: f64,
}

impl Stabilised {
    /// Area of the loop (J).
    pub(super) fn energy_loss_j(&self) -> Result<f64, ReproductionError> {
        let analysis = cycle::analyse(&self.samples.load_n, &self.samples.approach_m)?;
        Ok(analysis.energy_loss_j)
    }
}

/// The stabilised cycle as a sweep computes it; with `finer` above 1 by so many times the time steps, and twice the springs.
pub(super) fn by_sweep(
    plan: &SweepPlan,
    omega: f64,
    finer: usize,
    interrupt: &AtomicBool,
) -> Result<CaseResult, ReproductionError> {
    let mut plan = plan.clone();
    plan.solver.engine = EngineKind::Axisymmetric;
    plan.cycle.steps *= finer;
    if finer > 1 {
        plan.solver.springs *= 2;
        plan.cycle.tolerance *= 0.1;
    }
    plan.cycle.error_bars = false;
    let case = Case {
        index: 0,
        angular_frequency_rad_per_s: omega,
        drive: plan.drive,
    };
    let record = Setup::new(plan)?
        .run(&case, interrupt)
        .ok_or(ReproductionError::Interrupted)?;
    let message = record.message;
    record.result.ok_or_else(|| {
        ReproductionError::Unfit(format!("{omega} rad/s: {}", message.unwrap_or_default()))
    })
}

/// The stabilised cycle of one engine, with its surfaces.
pub(super) fn stabilised(
    plan: &SweepPlan,
    omega: f64,
    engine: EngineKind,
    steps: usize,
    interrupt: &AtomicBool,
) -> Result<Stabilised, ReproductionError> {
    let solver = SolverPlan {
        engine,
        ..plan.solver
    };
    let builder = builder(plan, solver)?;
    let mut fine = builder.engine(0)?;
    let start = match engine {
        EngineKind::Axisymmetric => search(plan, omega, fine.as_mut(), steps, interrupt)?,
        EngineKind::HalfSpace => {
            let side = solver.cells / 2;
            let coarse = SolverPlan {
                cells: side,
                ..solver
            };
            let mut engine = self::builder(plan, coarse)?.engine(0)?;
            let memory = search(plan, omega, engine.as_mut(), steps, interrupt)?;
            // Of the whole, or of a quarter: both have as many cells either way.
            doubled(&memory, engine.nodes().isqrt())
        }
    };
    let parts = match engine {
        EngineKind::Axisymmetric => solver.springs,
        EngineKind::HalfSpace => solver.cells,
    };
    let width_m = match engine {
        EngineKind::Axisymmetric => builder.half_width_m(),
        EngineKind::HalfSpace => 2.0 * builder.half_width_m(),
    };
    let compliance = plan.material.contact_compliance()?;
    let mut march = March::new(fine.as_mut(), compliance, solver.time_rule);
    march.recall(&start);
    let mut stabilised = Stabilised {
        samples: Loop::default(),
        surfaces: Vec::new(),
        spacing_m: width_m / parts as f64,
    };
    cycle(&mut march, plan, omega, steps, &mut stabilised, interrupt)?;
    Ok(stabilised)
}

/// So many cycles from rest, without the hold: by how much the approach of each differs from that of the last at most, as a
/// part of the largest.
pub(super) fn distances_from_rest(
    plan: &SweepPlan,
    solver: SolverPlan,
    omega: f64,
    steps: usize,
    cycles: usize,
    interrupt: &AtomicBool,
) -> Result<Vec<f64>, ReproductionError> {
    let mut engine = builder(plan, solver)?.engine(0)?;
    let compliance = plan.material.contact_compliance()?;
    let mut march = March::new(engine.as_mut(), compliance, solver.time_rule);
    let control = plan.drive.control();
    let share = 1.0 / steps as f64;
    let value = |step: f64| prescribed(control, plan.drive.value((step * share).fract()));
    let stages = march.stages(TAU / omega / steps as f64);
    let mut approaches_m = vec![march.jump(value(0.0))?.approach_m];
    for step in 1..=cycles * steps {
        if interrupt.load(Ordering::Relaxed) {
            return Err(ReproductionError::Interrupted);
        }
        march.step_in_stages(&stages, |end| value((step - 1) as f64 + end))?;
        approaches_m.extend(march.solution().map(|solution| solution.approach_m));
    }
    let largest_m = approaches_m.iter().copied().fold(0.0, f64::max);
    let last = approaches_m[(cycles - 1) * steps..].to_vec();
    let distance = |k: usize| {
        let cycle = approaches_m.iter().skip(k * steps).zip(&last);
        cycle.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest_m
    };
    Ok((0..cycles).map(distance).collect())
}

fn builder(plan: &SweepPlan, solver: SolverPlan) -> Result<EngineBuilder, ReproductionError> {
    let compliance = plan.material.contact_compliance()?;
    let largest = LargestContact {
        control: plan.drive.control(),
        maximum: plan.drive.maximum(),
        compliance_per_pa: compliance
            .equilibrium_compliance()
            .ok_or(SetupError::Fluid)?,
    };
    Ok(EngineBuilder::new(plan.indenter.clone(), solver, largest)?)
}

/// The memory at the start of the stabilised cycle.
fn search(
    plan: &SweepPlan,
    omega: f64,
    engine: &mut dyn Engine,
    steps: usize,
    interrupt: &AtomicBool,
) -> Result<Vec<f64>, ReproductionError> {
    const SETTINGS: SteadySettings = SteadySettings {
        tolerance: 3e-5,
        max_cycles: 40,
    };
    let compliance = plan.material.contact_compliance()?;
    let mut march = March::new(engine, compliance, plan.solver.time_rule);
    let control = plan.drive.control();
    let drive = |fraction: f64| prescribed(control, plan.drive.value(fraction));
    let cycle = steady::Cycle {
        drive: &drive,
        mean: prescribed(control, plan.drive.mean()),
        period_s: TAU / omega,
        steps,
    };
    let stop = || interrupt.load(Ordering::Relaxed);
    let found = steady::find(&mut march, &cycle, None, SETTINGS, &stop)?;
    if stop() {
        return Err(ReproductionError::Interrupted);
    }
    if !found.converged {
        return Err(ReproductionError::Unfit(format!(
            "{omega} rad/s: no stabilised cycle after {} cycles",
            found.cycles
        )));
    }
    Ok(march.memory().variables().to_vec())
}

/// One cycle from the memory the march holds.
fn cycle(
    march: &mut March<'_>,
    plan: &SweepPlan,
    omega: f64,
    steps: usize,
    into: &mut Stabilised,
    interrupt: &AtomicBool,
) -> Result<(), ReproductionError> {
    let control = plan.drive.control();
    let stages = march.stages(TAU / omega / steps as f64);
    for step in 0..=steps {
        if interrupt.load(Ordering::Relaxed) {
            return Err(ReproductionError::Interrupted);
        }
        let fraction = step as f64 / steps as f64;
        let value = |at: f64| prescribed(control, plan.drive.value(at / steps as f64));
        match step {
            0 => march.jump(value(0.0)).map(drop)?,
            _ => march.step_in_stages(&stages, |end| value((step - 1) as f64 + end))?,
        }
        sample(march, &mut into.samples, fraction * TAU / omega)?;
        let is_quarter = [1, 2, 3].iter().any(|quarter| 4 * step == quarter * steps);
        if is_quarter && let Some(surface) = march.surface()? {
            into.surfaces.push(surface);
        }
    }
    Ok(())
}

fn sample(march: &mut March<'_>, samples: &mut Loop, time_s: f64) -> Result<(), ContactError> {
    march.observe(&mut |engine, pressure, solution| {
        samples.time_s.push(time_s);
        samples.load_n.push(solution.load_n);
        samples.approach_m.push(solution.approach_m);
        samples.contact_radius_m.push(solution.contact_radius_m);
        let peak = engine.peak_pressure_pa(pressure, solution)?;
        samples.peak_pressure_pa.push(peak);
        Ok(())
    })
}

/// Memory variables on a square of `side` cells carried over to one of twice as many, linearly between the centres. Beyond a
/// border the field goes on with the value beside it, which at the axes of a quarter is its mirror image.
fn doubled(memory: &[f64], side: usize) -> Vec<f64> {
    // The two coarse cells on either side of a fine centre: three quarters of the nearer, a quarter of the other.
    let neighbours = |fine: usize| {
        let near = fine / 2;
        let far = if fine.is_multiple_of(2) {
            near.saturating_sub(1)
        } else {
            (near + 1).min(side - 1)
        };
        [(near, 0.75), (far, 0.25)]
    };
    let fine = 2 * side;
    let mut doubled = Vec::with_capacity(4 * memory.len());
    for branch in memory.chunks_exact(side * side) {
        for y in 0..fine {
            for x in 0..fine {
                let mut sum = 0.0;
                for (row, weight_y) in neighbours(y) {
                    for (column, weight_x) in neighbours(x) {
                        sum += weight_y * weight_x * branch[row * side + column];
                    }
                }
                doubled.push(sum);
            }
        }
    }
    doubled
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_stays_a_plane_on_twice_as_many_cells() {
        let side = 8;
        // Positions in units of the domain.
        let at = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
        let plane = |x: usize, y: usize, n: usize| 2.0 + 3.0 * at(x, n) - at(y, n);
        let coarse: Vec<f64> = (0..side * side)
            .map(|cell| plane(cell % side, cell / side, side))
            .collect();
        let fine = doubled(&coarse, side);
        assert_eq!(fine.len(), 4 * coarse.len());
        for y in 1..2 * side - 1 {
            for x in 1..2 * side - 1 {
                let found = fine[y * 2 * side + x];
                assert!((found - plane(x, y, 2 * side)).abs() < 1e-14, "{x} {y}");
            }
        }
    }
}
