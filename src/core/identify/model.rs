//! The exact model: stabilised cycles of a series, by the engine that a sweep has, or its history, by the one of a simulation.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::engine::EngineKind;
use crate::identify::data::Datum;
use crate::identify::identified::CellError;
use crate::identify::{Driven, IdentifyError, IdentifyPlan, history};
use crate::material::{MaterialError, Relaxation};
use crate::sweep::case::Setup;
use crate::sweep::plan::{Case, Condition, CyclePlan, SweepPlan};
use crate::sweep::record::CaseResult;

/// Numbers of the cycles of a plan's measurements, for any series.
pub(super) struct Model<'a> {
    plan: &'a IdentifyPlan,
    interrupt: &'a AtomicBool,
    /// What every number is multiplied by for the error of its resolution; none before that is known.
    pub(super) corrections: Vec<f64>,
}

impl<'a> Model<'a> {
    pub(super) fn new(plan: &'a IdentifyPlan, interrupt: &'a AtomicBool) -> Self {
        Self {
            plan,
            interrupt,
            corrections: Vec::new(),
        }
    }

    /// Learns at a series what twice the time steps and springs or cells change, and corrects all numbers by it from then on: the
    /// largest relative correction. Time rule and springs are of second order where the contact is smooth, so that what is left falls
    /// fourfold. Cells are of first order at a rim, and the edge of a contact lies between two of them at random: what is left may be
    /// as large as the correction ([`Model::cell_error`]). `None` where nothing is learnt: of histories on springs, whose steps are
    /// chosen by the solid, and of maps, which have a cell on every point.
    pub(super) fn learn_corrections(
        &mut self,
        series: &Relaxation,
    ) -> Result<Option<f64>, IdentifyError> {
        let contact = &self.plan.contact;
        let has_nothing_finer = match self.plan.solver.engine {
            EngineKind::Axisymmetric => self.plan.drive.history().is_some(),
            EngineKind::HalfSpace => contact.indenter.own_cells().is_some(),
        };
        if has_nothing_finer {
            return Ok(None);
        }
        self.corrections.clear();
        let mut finer = self.plan.clone();
        finer.cycle.steps *= 2;
        finer.solver.springs *= 2;
        finer.solver.cells *= 2;
        let finer = Model::new(&finer, self.interrupt).numbers_where_found(series)?;
        let own = self.numbers_where_found(series)?;
        let ratio = |(fine, own): (Option<f64>, Option<f64>)| {
            let ratio = fine.zip(own).map(|(fine, own)| fine / own);
            ratio.filter(|ratio| *ratio > 0.5 && *ratio < 2.0)
        };
        let ratios = finer.into_iter().zip(own).map(ratio);
        self.corrections = ratios.map(|ratio| ratio.unwrap_or(1.0)).collect();
        Ok(Some(self.largest_correction()))
    }

    fn largest_correction(&self) -> f64 {
        let sizes = self.ln_corrections().map(f64::abs);
        sizes.fold(0.0, f64::max)
    }

    /// Logarithms of the corrections; nothing before they are learnt.
    pub(super) fn ln_corrections(&self) -> impl Iterator<Item = f64> {
        self.corrections.iter().map(|ratio| ratio.ln())
    }

    /// What is known of the error of the cells; `None` on springs.
    pub(super) fn cell_error(&self) -> Option<CellError> {
        match (self.plan.solver.engine, self.corrections.is_empty()) {
            (EngineKind::Axisymmetric, _) => None,
            (EngineKind::HalfSpace, true) => Some(CellError::Unknown),
            (EngineKind::HalfSpace, false) => Some(CellError::Included(self.largest_correction())),
        }
    }

    /// The computed number of every datum, in their order.
    pub(super) fn numbers(&self, series: &Relaxation) -> Result<Vec<f64>, IdentifyError> {
        let mut all = self.numbers_of_each(std::slice::from_ref(series))?;
        all.pop().ok_or(IdentifyError::NoFit("there is no series"))
    }

    /// The same for each of several series.
    pub(super) fn numbers_of_each(
        &self,
        all: &[Relaxation],
    ) -> Result<Vec<Vec<f64>>, IdentifyError> {
        let data = self.plan.measurements.data();
        let defined = |numbers: Vec<Option<f64>>| {
            let numbers = numbers.into_iter().zip(data);
            let numbers = numbers.map(|(number, datum)| number.ok_or_else(|| datum.undefined()));
            numbers.collect()
        };
        let each = self.solved(all, false)?.into_iter();
        each.map(defined).collect()
    }

    /// The computed numbers of a series on the way to the one that is sought: `None` of a cycle that is not found.
    pub(super) fn numbers_where_found(
        &self,
        series: &Relaxation,
    ) -> Result<Vec<Option<f64>>, IdentifyError> {
        let mut all = self.solved(std::slice::from_ref(series), true)?;
        all.pop().ok_or(IdentifyError::NoFit("there is no series"))
    }

    /// The corrected numbers of each of several series, whose cycles are solved side by side. Of a series that `may_lose` cycles a few
    /// that are not found are no matter; where most are lost nothing is learnt.
    fn solved(
        &self,
        all: &[Relaxation],
        may_lose: bool,
    ) -> Result<Vec<Vec<Option<f64>>>, IdentifyError> {
        if let Driven::History(drive) = &self.plan.drive {
            let numbers = all.par_iter().map(|series| {
                let numbers = history::numbers(self.plan, drive, series, self.interrupt)?;
                let numbers = numbers.into_iter().enumerate();
                Ok(numbers
                    .map(|(place, number)| Some(number * self.correction(place)))
                    .collect())
            });
            return numbers.collect();
        }
        let setups = all.iter().map(|series| self.setup(series));
        let setups: Vec<Setup> = setups.collect::<Result<_, _>>()?;
        let cycles: Vec<&[Datum]> = self.plan.measurements.places().collect();
        let of_each =
            (setups.par_iter()).flat_map(|setup| cycles.par_iter().map(move |data| (setup, data)));
        let solved = of_each.map(|(setup, data)| self.cycle(setup, &data[0]));
        let solved: Vec<Result<CaseResult, IdentifyError>> = solved.collect();
        let each = solved.chunks(cycles.len()).map(|of_series| {
            let is_lost =
                |cycle: &&Result<_, _>| matches!(cycle, Err(IdentifyError::NoCycle { .. }));
            let lost = of_series.iter().filter(is_lost).count();
            let may_lose = may_lose && 2 * lost <= cycles.len();
            let found = of_series.iter().map(|cycle| match cycle {
                Err(IdentifyError::NoCycle { .. }) if may_lose => Ok(None),
                other => other.as_ref().map(Some).map_err(Clone::clone),
            });
            Ok(self.of_cycles(&found.collect::<Result<Vec<_>, _>>()?))
        });
        each.collect()
    }

    /// The corrected number of every datum; `None` where its cycle has none or was not found.
    fn of_cycles(&self, cycles: &[Option<&CaseResult>]) -> Vec<Option<f64>> {
        let places = self.plan.measurements.places().zip(cycles);
        let data = places.flat_map(|(data, cycle)| data.iter().map(move |datum| (datum, cycle)));
        let numbers = data.enumerate().map(|(place, (datum, cycle))| {
            let cycle = (*cycle)?;
            Some(datum.number.of(cycle)? * self.correction(place))
        });
        numbers.collect()
    }

    fn correction(&self, place: usize) -> f64 {
        self.corrections.get(place).copied().unwrap_or(1.0)
    }

    fn setup(&self, series: &Relaxation) -> Result<Setup, IdentifyError> {
        let measured = self.plan.measurements.data();
        let first = measured
            .iter()
            .find_map(|datum| Some((datum, datum.drive?)));
        let (first, drive) = first.ok_or(IdentifyError::NoFit("no cycle was measured"))?;
        // A trial that the bulk modulus does not allow.
        let material = self.plan.material(series).map_err(|error| match error {
            MaterialError::SmallBulkModulus { .. } => IdentifyError::NoCycle {
                angular_frequency_rad_per_s: first.place,
                why: error.to_string(),
            },
            error => error.into(),
        })?;
        let contact = self.plan.contact.with_material(Arc::new(material));
        let mut plan = SweepPlan::of(contact, self.plan.solver, drive);
        plan.cycle = self.plan.cycle;
        let omegas = measured.iter().map(|datum| datum.place);
        plan.angular_frequencies_rad_per_s = omegas.collect();
        plan.angular_frequencies_rad_per_s.sort_by(f64::total_cmp);
        plan.angular_frequencies_rad_per_s.dedup();
        Ok(Setup::new(plan)?)
    }

    /// The cycle that a number was measured of.
    fn cycle(&self, setup: &Setup, measured: &Datum) -> Result<CaseResult, IdentifyError> {
        let base = setup.plan().base.clone();
        let case = Case {
            index: 0,
            angular_frequency_rad_per_s: measured.place,
            condition: Condition {
                drive: measured.drive.unwrap_or(base.drive),
                ..base
            },
        };
        let mut record = setup.numbers(&case, self.interrupt);
        if record
            .as_ref()
            .is_some_and(|record| record.result.is_none())
        {
            // The cycles of bodies that relax strongly are not found as closely.
            let mut plan = setup.plan().clone();
            plan.cycle.tolerance = plan.cycle.tolerance.max(CyclePlan::DEFAULT.tolerance);
            record = Setup::new(plan)?.numbers(&case, self.interrupt);
        }
        let record = record.ok_or(IdentifyError::Interrupted)?;
        let (message, status) = (record.message, record.status);
        record.result.ok_or_else(|| IdentifyError::NoCycle {
            angular_frequency_rad_per_s: measured.place,
            why: message.unwrap_or_else(|| status.name().to_owned()),
        })
    }
}
