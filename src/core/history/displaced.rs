//! What the state of a march displaces, carried along with it.
//!
//! The operator B is linear, and so is what a step does to the memory: B m_j of every branch follows from B p of every instant by the
//! weights that make m_j of p. One convolution an instant then gives the displacement by the hereditary integral and by every branch.

use super::hereditary::Hereditary;
use super::memory::Memory;
use super::rule::StepWeights;
use crate::contact::{ContactError, Engine, sums};

/// Displacements (m) in a body of the compliance 1, per node.
#[derive(Debug, Clone)]
pub(super) struct Displaced {
    /// By the pressure.
    pub(super) of_pressure: Vec<f64>,
    /// By the memory variables.
    pub(super) memory: Memory,
    work: Vec<f64>,
}

impl Displaced {
    /// Of this pressure and memory; and the convolutions that took.
    pub(super) fn new(
        engine: &mut dyn Engine,
        pressure: &[f64],
        memory: &Memory,
    ) -> Result<(Self, usize), ContactError> {
        let mut displaced = Self {
            of_pressure: vec![0.0; pressure.len()],
            memory: Memory::new(memory.compliance().clone(), pressure.len()),
            work: vec![0.0; pressure.len()],
        };
        let mut convolutions = engine.elastic_displacement(pressure, &mut displaced.of_pressure)?;
        for (field, displacement) in memory.each().zip(displaced.memory.each_mut()) {
            convolutions += engine.elastic_displacement(field, displacement)?;
        }
        Ok((displaced, convolutions))
    }

    /// Follows the march through a step to this pressure; returns the convolutions that took.
    pub(super) fn follow(
        &mut self,
        engine: &mut dyn Engine,
        step: &StepWeights,
        pressure: &[f64],
    ) -> Result<usize, ContactError> {
        self.memory.predict(step, &self.of_pressure, &mut self.work);
        let convolutions = engine.elastic_displacement(pressure, &mut self.of_pressure)?;
        self.memory.commit(step, &self.of_pressure);
        Ok(convolutions)
    }

    /// By the hereditary integral (m).
    pub(super) fn of_hereditary_m(&self) -> Vec<f64> {
        self.memory.hereditary(&self.of_pressure)
    }

    /// By what the pressure exceeds the memory of this branch.
    pub(super) fn of_deviation(&mut self, branch: usize) -> &[f64] {
        self.work.copy_from_slice(&self.of_pressure);
        if let Some(displaced) = self.memory.each().nth(branch) {
            sums::add_scaled(&mut self.work, -1.0, displaced);
        }
        &self.work
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::contact::Prescribed;
    use crate::contact::half_space::convolution::Convolution;
    use crate::contact::half_space::grid::Grid;
    use crate::contact::half_space::{HalfSpace, SolverSettings};
    use crate::history::{March, TimeRule};
    use crate::material::{Creep, CreepBranch};

    #[test]
    fn what_is_carried_along_is_what_the_operator_makes_of_the_memory() {
        let branch = |compliance_per_pa, time_s| CreepBranch {
            compliance_per_pa,
            time_s,
        };
        // Steps of the second are taken in two stages.
        let plain = Creep::new(1e-9, vec![branch(1e-9, 0.5), branch(2e-9, 3.0)], None).unwrap();
        let rings = Creep::new(1e-9, vec![branch(4e-7, 0.5)], Some(1e9)).unwrap();
        let grid = Grid::square(16, 2e-5).unwrap();
        let places = (0..grid.cells()).map(|cell| grid.center(cell));
        let gap_m: Vec<f64> = places.map(|(x, y)| (x * x + y * y) / 0.02).collect();
        for (compliance, rule) in [
            (plain.clone(), TimeRule::Linear),
            (plain, TimeRule::Constant),
            (rings, TimeRule::Linear),
        ] {
            let operator = Arc::new(Convolution::new(grid).unwrap());
            let mut engine =
                HalfSpace::new(operator, gap_m.clone(), true, SolverSettings::default());
            let mut march = March::new(&mut engine, compliance, rule);
            let drive = |time: f64| Prescribed::ApproachM(2e-7 * (1.5 + time.sin()));
            march.jump(drive(0.0)).unwrap();
            let stages = march.stages(0.4);
            let mut dissipation = march.dissipation(0.4).unwrap();
            for step in 0..12 {
                let time = |end: f64| 0.4 * (f64::from(step) + end);
                march
                    .step_dissipating(&stages, |end| drive(time(end)), &mut dissipation)
                    .unwrap();
            }
            let hereditary: Vec<f64> = march.hereditary().collect();
            let mut other = HalfSpace::new(
                Arc::new(Convolution::new(grid).unwrap()),
                gap_m.clone(),
                true,
                SolverSettings::default(),
            );
            let mut expected = vec![0.0; hereditary.len()];
            other
                .elastic_displacement(&hereditary, &mut expected)
                .unwrap();
            let found = dissipation.displaced.of_hereditary_m();
            let largest = expected.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            let offs = expected.iter().zip(&found).map(|(a, b)| (a - b).abs());
            let off = offs.fold(0.0, f64::max) / largest;
            assert!(largest > 1e-8 && off < 1e-13, "{largest} {off}");
        }
    }
}
