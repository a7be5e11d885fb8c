//! What only a march on the memory of a series can do: energies added up along it, and going back to memories known from before.

use super::March;
use crate::contact::surface::Surface;
use crate::contact::{ContactError, Instant, Prescribed, Solution};
use crate::history::displaced::Displaced;
use crate::history::{Dissipation, NodalWork, Stage};

impl March<'_> {
    /// Begins to add up what is dissipated from the present instant on, in steps of `step_s`.
    ///
    /// # Errors
    /// As [`Engine::elastic_displacement`](crate::contact::Engine::elastic_displacement).
    pub fn dissipation(&mut self, step_s: f64) -> Result<Dissipation, ContactError> {
        let (displaced, convolutions) = Displaced::new(self.engine, &self.pressure, &self.memory)?;
        self.work.convolutions += convolutions as u64;
        Ok(Dissipation::new(displaced, step_s, self.rule))
    }

    /// A step as [`March::step_in_stages`] takes it, whose dissipation is added up.
    ///
    /// # Errors
    /// As [`March::step`].
    pub fn step_dissipating(
        &mut self,
        stages: &[Stage],
        drive: impl Fn(f64) -> Prescribed,
        dissipation: &mut Dissipation,
    ) -> Result<(), ContactError> {
        dissipation.begin(self.engine, &self.pressure, &self.memory);
        let (mut from, mut convolutions) = (0.0, 0);
        for stage in stages {
            dissipation.passes(from, &self.pressure);
            self.step(&stage.weights, stage.prescribed(&drive))?;
            let displaced = &mut dissipation.displaced;
            convolutions += displaced.follow(self.engine, &stage.weights, &self.pressure)?;
            from = stage.pressure_at;
        }
        dissipation.end(self.engine, &self.pressure);
        self.work.convolutions += convolutions as u64;
        Ok(())
    }

    /// Takes the present instant into the work at every node: at the beginning, then after every step whose dissipation was added up.
    ///
    /// # Errors
    /// As [`Engine::elastic_displacement`](crate::contact::Engine::elastic_displacement).
    pub fn add_work(
        &mut self,
        work: &mut NodalWork,
        dissipation: &Dissipation,
    ) -> Result<(), ContactError> {
        let Some(solution) = self.solution else {
            return Ok(());
        };
        let hereditary = self.hereditary().collect();
        let convolutions = work.see(
            self.engine,
            (solution.approach_m, &self.pressure),
            (hereditary, &self.memory),
            dissipation.displaced.of_hereditary_m(),
        )?;
        self.work.convolutions += convolutions as u64;
        Ok(())
    }

    /// The density over the surface of the work of a cycle; nothing of it lies beyond `radius_m`.
    ///
    /// # Errors
    /// As [`Engine::surface`](crate::contact::Engine::surface).
    pub fn work_density(
        &mut self,
        work: &NodalWork,
        radius_m: f64,
    ) -> Result<Surface, ContactError> {
        let nodal = work.of_loop(self.engine);
        self.engine.surface_density(&nodal, radius_m)
    }

    /// The state after this value was held for ever: every memory variable equals the pressure.
    ///
    /// # Errors
    /// As [`March::step`].
    pub fn relax(&mut self, prescribed: Prescribed) -> Result<Solution, ContactError> {
        self.reset_predictor();
        self.history.fill(0.0);
        let instant = Instant {
            history: &self.history,
            compliance_per_pa: self.memory.relaxed_compliance_per_pa(),
            prescribed,
        };
        let solution = self.engine.solve(&instant, &mut self.pressure)?;
        self.memory.fill_all_branches(&self.pressure);
        Ok(self.count(solution))
    }

    /// Goes back to memory variables known from before, branch-major as in
    /// [`Memory::variables`](crate::history::Memory::variables). The pressure stays as the guess for the next instant, which must be a
    /// jump.
    pub fn recall(&mut self, variables: &[f64]) {
        self.memory.recall(variables);
        self.reset_predictor();
    }

    /// Begins [`Memory::cycle_sums`](crate::history::Memory::cycle_sums) anew, of this branch, where one is given.
    pub fn begin_cycle(&mut self, branch: Option<usize>) {
        if let Some(branch) = branch {
            self.memory.begin_cycle(branch);
        }
    }

    /// As [`Engine::tolerance`](crate::contact::Engine::tolerance).
    pub(crate) fn tolerance(&self) -> Option<f64> {
        self.engine.tolerance()
    }

    /// As [`Engine::tolerate`](crate::contact::Engine::tolerate).
    pub(crate) fn tolerate(&mut self, tolerance: f64) {
        self.engine.tolerate(tolerance);
    }

    /// Does something that may change the tolerance of instants, and puts that back however it ends.
    pub(crate) fn keeping_tolerance<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        let given = self.tolerance();
        let done = work(self);
        if let Some(given) = given {
            self.tolerate(given);
        }
        done
    }

    /// Makes the tolerance so much tighter as instants need whose guesses come from the cycle before, where they do: guesses that good may
    /// be within what is given as they are, all on one side of the solution. What an iteration leaves is far below it.
    pub(crate) fn tighten_for_good_guesses(&mut self) {
        const OF_GOOD_GUESSES: f64 = 0.03;
        if self.knows_last_cycle()
            && let Some(given) = self.tolerance()
        {
            self.tolerate(OF_GOOD_GUESSES * given);
        }
    }

    /// Lets the next instant start from the last pressure alone.
    pub fn reset_predictor(&mut self) {
        if let Some(extrapolation) = &mut self.extrapolation {
            extrapolation.forget();
        }
    }
}
