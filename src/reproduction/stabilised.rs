//! Stabilised cycles of one engine, with the surface at the quarters of the cycle.
//!
//! On many cells a cycle is dear. Its memory is therefore found on half as many per side, carried over, and one cycle
//! marched: what the coarse memory was wrong by is a part of the discretisation error, and decays in that cycle.

use std::f64::consts::TAU;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{ReproductionError, Result};
use crate::contact::surface::Surface;
use crate::contact::{Engine, Prescribed};
use crate::cycle::Loop;
use crate::engine::EngineKind;
use crate::engine::prescribed;
use crate::history::March;
use crate::steady::{self, SteadySettings};
use crate::sweep::case::{Setup, sample};
use crate::sweep::plan::{Case, SweepPlan};
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

/// The stabilised cycle as a sweep computes it; with `finer` above 1 by so many times the time steps, and twice the springs.
pub(super) fn by_sweep(
    plan: &SweepPlan,
    omega: f64,
    finer: usize,
    interrupt: &AtomicBool,
) -> Result<CaseResult> {
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
        condition: plan.base.clone(),
    };
    let record = Setup::new(plan)?.run(&case, interrupt);
    let record = record.ok_or(ReproductionError::Interrupted)?;
    let message = record.message.unwrap_or_default();
    let unfit = || ReproductionError::Unfit(format!("{omega} rad/s: {message}"));
    record.result.ok_or_else(unfit)
}

/// The stabilised cycle of one engine, with its surfaces.
pub(super) fn stabilised(
    plan: &SweepPlan,
    omega: f64,
    engine: EngineKind,
    steps: usize,
    interrupt: &AtomicBool,
) -> Result<Stabilised> {
    let mut plan = plan.clone();
    plan.solver.engine = engine;
    let cycle = Cycle {
        setup: Setup::new(plan)?,
        omega,
        steps,
        interrupt,
    };
    let solver = &cycle.setup.plan().solver;
    let condition = &cycle.setup.plan().base;
    let engines = cycle.setup.engines(condition, solver.nodes())?;
    let mut fine = engines.engine(0)?;
    let (start, width_m) = match engine {
        EngineKind::Axisymmetric => (cycle.search(fine.as_mut())?, engines.half_width_m()),
        EngineKind::HalfSpace => {
            let half = cycle.setup.engines(condition, solver.nodes() / 2)?;
            let mut coarse = half.engine(0)?;
            let memory = cycle.search(coarse.as_mut())?;
            // Full grid or one symmetry quadrant: both have as many cells either way.
            let start = doubled(&memory, coarse.nodes().isqrt());
            (start, 2.0 * engines.half_width_m())
        }
    };
    let (samples, surfaces) = cycle.recorded(fine.as_mut(), &start)?;
    Ok(Stabilised {
        samples,
        surfaces,
        spacing_m: width_m / solver.nodes() as f64,
    })
}

/// One cycle of a sweep's drive, on whatever engine.
struct Cycle<'a> {
    setup: Setup,
    omega: f64,
    steps: usize,
    interrupt: &'a AtomicBool,
}

impl Cycle<'_> {
    /// What is prescribed at a fraction of the cycle.
    fn prescribed(&self, fraction: f64) -> Prescribed {
        let drive = &self.setup.plan().base.drive;
        prescribed(drive.control(), drive.value(fraction))
    }

    fn march<'e>(&self, engine: &'e mut dyn Engine) -> Result<March<'e>> {
        let plan = self.setup.plan();
        let compliance = plan.base.contact.material.contact_compliance()?;
        Ok(March::new(engine, compliance, plan.solver.time_rule))
    }

    fn is_interrupted(&self) -> bool {
        self.interrupt.load(Ordering::Relaxed)
    }

    /// The memory at the start of the stabilised cycle.
    fn search(&self, engine: &mut dyn Engine) -> Result<Vec<f64>> {
        const SETTINGS: SteadySettings = SteadySettings {
            tolerance: 3e-5,
            max_cycles: 40,
        };
        let mut march = self.march(engine)?;
        let drive = &self.setup.plan().base.drive;
        let cycle = steady::Cycle {
            drive: &|fraction| self.prescribed(fraction),
            mean: prescribed(drive.control(), drive.mean()),
            period_s: TAU / self.omega,
            steps: self.steps,
        };
        let stop = || self.is_interrupted();
        let found = steady::find(&mut march, &cycle, None, SETTINGS, &stop)?;
        if stop() {
            return Err(ReproductionError::Interrupted);
        }
        if !found.converged {
            return Err(ReproductionError::Unfit(format!(
                "{} rad/s: no stabilised cycle after {} cycles",
                self.omega, found.cycles
            )));
        }
        Ok(march.memory().variables().to_vec())
    }

    /// One cycle from this memory: its loop, and the surfaces at its quarters.
    fn recorded(&self, engine: &mut dyn Engine, memory: &[f64]) -> Result<(Loop, Vec<Surface>)> {
        let mut march = self.march(engine)?;
        march.recall(memory);
        let stages = march.stages(TAU / self.omega / self.steps as f64);
        let (mut samples, mut surfaces) = (Loop::default(), Vec::new());
        for step in 0..=self.steps {
            if self.is_interrupted() {
                return Err(ReproductionError::Interrupted);
            }
            let fraction = |end: f64| (step as f64 - 1.0 + end) / self.steps as f64;
            match step {
                0 => march.jump(self.prescribed(0.0)).map(drop)?,
                _ => march.step_in_stages(&stages, |end| self.prescribed(fraction(end)))?,
            }
            let time_s = fraction(1.0) * TAU / self.omega;
            sample(&mut march, &mut samples, time_s, true)?;
            let is_quarter = [1, 2, 3]
                .map(|quarter| quarter * self.steps)
                .contains(&(4 * step));
            if is_quarter && let Some(surface) = march.surface()? {
                surfaces.push(surface);
            }
        }
        Ok((samples, surfaces))
    }
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
