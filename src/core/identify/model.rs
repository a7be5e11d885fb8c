//! The exact model: stabilised cycles of a series, by the engine that a sweep has, or its history, by the one of a simulation.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::engine::EngineKind;
use crate::identify::data::{Datum, Number};
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
    corrections: Vec<f64>,
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

    /// The same for each of several series, whose cycles are solved side by side.
    pub(super) fn numbers_of_each(
        &self,
        all: &[Relaxation],
    ) -> Result<Vec<Vec<f64>>, IdentifyError> {
        if let Driven::History(drive) = &self.plan.drive {
            let numbers = |series| history::numbers(self.plan, drive, series, self.interrupt);
            let corrected = |series| {
                let numbers = numbers(series)?.into_iter().enumerate();
                let corrected = numbers.map(|(place, number)| number * self.correction(place));
                Ok(corrected.collect())
            };
            return all.par_iter().map(corrected).collect();
        }
        let setups: Vec<Setup> = all
            .iter()
            .map(|series| self.setup(series))
            .collect::<Result<_, _>>()?;
        let cycles: Vec<&[Datum]> = self.plan.measurements.places().collect();
        let of_each =
            (setups.par_iter()).flat_map(|setup| cycles.par_iter().map(move |data| (setup, data)));
        let solved: Vec<Option<CaseResult>> = of_each
            .map(|(setup, data)| Ok(Some(self.cycle(setup, &data[0])?)))
            .collect::<Result<_, IdentifyError>>()?;
        let each = solved.chunks(cycles.len());
        each.map(|of_series| {
            let numbers = self.of_cycles(of_series).into_iter();
            let data = self.plan.measurements.data();
            let defined = numbers
                .zip(data)
                .map(|(number, datum)| number.ok_or_else(|| datum.undefined()));
            defined.collect()
        })
        .collect()
    }

    /// The computed numbers of a series on the way to the one that is sought: `None` of a cycle that is not found.
    pub(super) fn numbers_where_found(
        &self,
        series: &Relaxation,
    ) -> Result<Vec<Option<f64>>, IdentifyError> {
        if let Driven::History(_) = &self.plan.drive {
            let numbers = self.numbers(series)?.into_iter();
            return Ok(numbers.map(Some).collect());
        }
        let setup = self.setup(series)?;
        let cycles: Vec<&[Datum]> = self.plan.measurements.places().collect();
        let solved = cycles.par_iter().map(|data| self.cycle(&setup, &data[0]));
        let solved: Vec<_> = solved.collect();
        let is_lost = |cycle: &Result<_, _>| matches!(cycle, Err(IdentifyError::NoCycle { .. }));
        let lost = solved.iter().filter(|cycle| is_lost(cycle)).count();
        let found = solved.into_iter().map(|cycle| match cycle {
            // Of a few it is no matter; where most are lost nothing is learnt.
            Err(IdentifyError::NoCycle { .. }) if 2 * lost <= cycles.len() => Ok(None),
            other => other.map(Some),
        });
        Ok(self.of_cycles(&found.collect::<Result<Vec<_>, _>>()?))
    }

    /// The corrected number of every datum; `None` where its cycle has none or was not found.
    fn of_cycles(&self, cycles: &[Option<CaseResult>]) -> Vec<Option<f64>> {
        let places = self.plan.measurements.places().zip(cycles);
        let data = places.flat_map(|(data, cycle)| data.iter().map(move |datum| (datum, cycle)));
        let numbers = data.enumerate().map(|(place, (datum, cycle))| {
            let cycle = cycle.as_ref()?;
            let first = cycle.analysis.harmonics.first();
            let number = match datum.number {
                Number::OfCycle(quantity) => quantity.of(cycle)?,
                Number::ApproachAmplitude => first?.approach_amplitude_m,
                Number::LoadAmplitude => first?.load_amplitude_n,
                Number::Approach | Number::Load => return None,
            };
            Some(number * self.correction(place))
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
