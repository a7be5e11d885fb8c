//! The numbers of a sweep as its page carries them: the table to the last digit, cycles and fields as fine as they are drawn.

use serde::Serialize;

use super::cases_table::{self, ShownColumn};
use super::compact::{all_rounded, picked, picked_optional, rounded, spread};
use super::surface_data::{Fineness, PressureData, WorkData, share};
use crate::cycle::Loop;
use crate::material::{Material, MaterialFunction};
use crate::quantity::{Dimension, FrequencyUnit, ZERO_CELSIUS_K};
use crate::report::figure::moduli::ModulusPoint;
use crate::report::material::MaterialReport;
use crate::report::quantities::{Column, SWEEP};
use crate::report::words::nodes_name;
use crate::report::work_line::WorkLine;
use crate::sweep::plan::{SweepPlan, Varied};
use crate::sweep::record::{CaseRecord, CaseResult};
use crate::sweep::search::peak::Peak;
use crate::sweep::search::run::Outcome;

/// Everything the script of the page knows.
#[derive(Serialize)]
pub(super) struct SweepData<'a> {
    kind: &'static str,
    /// `sweep.csv`.
    csv: &'a str,
    /// What has a curve.
    quantities: Vec<QuantityData>,
    frequency: FrequencyData,
    peaks: &'a [Peak],
    branches: usize,
    /// Of every curve; empty where they have different ones.
    retardation_times_s: Vec<f64>,
    /// What other axes than the frequency vary.
    varied: Vec<VariedData>,
    drive_unit: &'static str,
    node_name: &'static str,
    material: MaterialData,
    /// The cycles that the page holds.
    cases: Vec<CaseData>,
    /// The columns of the table of cases, where it is read page by page.
    table: Vec<ShownColumn>,
}

/// The column of what an axis varies, and the unit in which it is told, of which zero lies at so many SI units.
#[derive(Serialize)]
struct VariedData {
    column: String,
    unit: &'static str,
    zero: f64,
    /// From the SI unit to the one that is told.
    factor: f64,
    /// Whether its cells are names.
    named: bool,
}

impl VariedData {
    fn of(varied: &Varied) -> Self {
        let (unit, zero, factor) = match varied.dimension {
            Some(Dimension::Temperature) => ("°C", ZERO_CELSIUS_K, 1.0),
            Some(Dimension::Angle) => ("°", 0.0, 1_f64.to_degrees()),
            Some(dimension) => (dimension.si_unit(), 0.0, 1.0),
            None => ("", 0.0, 1.0),
        };
        Self {
            column: varied.column(),
            unit,
            zero,
            factor,
            named: varied.is_whole(),
        }
    }
}

/// What the axis of frequencies is called, its column in `sweep.csv`, and the factor to it from rad/s.
#[derive(Serialize)]
pub(super) struct FrequencyData {
    label: String,
    quantity: &'static str,
    name: char,
    unit: &'static str,
    column: &'static str,
    factor: f64,
}

impl FrequencyData {
    pub(super) fn of(unit: FrequencyUnit) -> Self {
        Self {
            label: format!("{} {}", unit.quantity(), unit.symbol()),
            quantity: unit.quantity(),
            name: unit.symbol(),
            unit: unit.name(),
            column: unit.column(),
            factor: unit.of(1.0),
        }
    }
}

/// Moduli over frequency.
#[derive(Serialize)]
pub(super) struct MaterialData {
    symbol: char,
    frequency: FrequencyData,
    /// In the unit of [`MaterialData::frequency`].
    frequencies: Vec<f64>,
    storage_modulus_pa: Vec<f64>,
    loss_modulus_pa: Vec<f64>,
}

/// The cycle of one converged case.
#[derive(Serialize)]
struct CaseData {
    index: usize,
    #[serde(flatten)]
    samples: Loop,
    /// Amplitudes of load (N) and approach (m), first harmonic first.
    harmonics: Vec<[f64; 2]>,
    pressure: PressureData,
    work: WorkData,
}

impl<'a> SweepData<'a> {
    /// The data of a sweep whose table is `csv`.
    pub(super) fn new(plan: &SweepPlan, outcome: &'a Outcome, csv: &'a str) -> Self {
        let results = outcome
            .records
            .iter()
            .filter_map(|r| Some((r, r.result.as_ref()?)));
        let held = results.filter(|(_, result)| result.cycle.is_held());
        let count = held.clone().count();
        Self {
            kind: "sweep",
            csv,
            quantities: SWEEP.iter().filter_map(quantity).collect(),
            frequency: FrequencyData::of(plan.figures.frequency_unit),
            peaks: &outcome.peaks,
            branches: outcome.branches(),
            retardation_times_s: all_rounded(&outcome.retardation_times_s()),
            varied: (plan.axes.iter().flat_map(|axes| &axes.over))
                .map(VariedData::of)
                .collect(),
            drive_unit: plan.base.drive.control().unit(),
            node_name: match plan.base.contact.indenter.own_cells() {
                Some(_) => "cells along the longer side of the map",
                None => nodes_name(plan.solver.engine),
            },
            material: MaterialData::over(&plan.base.contact.material, plan.figures.frequency_unit),
            table: match plan.is_small() {
                true => Vec::new(),
                false => cases_table::shown(plan, outcome),
            },
            cases: held
                .map(|(r, result)| case(plan, r, result, count))
                .collect(),
        }
    }
}

/// Column, column of its error, name, unit, factor from SI to it.
type QuantityData = (&'static str, String, &'static str, &'static str, f64);

fn quantity(column: &Column<CaseRecord>) -> Option<QuantityData> {
    let (unit, factor) = column.unit();
    let error = column.error_name()?;
    Some((column.name, error, column.heading, unit, factor))
}

impl MaterialData {
    /// Over angular frequency, ten points a decade.
    pub(super) fn of(material: &Material) -> Self {
        Self::over(material, FrequencyUnit::RadPerS)
    }

    /// The same over frequencies in this unit.
    fn over(material: &Material, unit: FrequencyUnit) -> Self {
        let points = MaterialReport::new(material).moduli(10);
        let numbers =
            |value: fn(&ModulusPoint) -> f64| points.iter().map(value).map(rounded).collect();
        Self {
            symbol: MaterialFunction::Relaxation.symbol(material.kind()),
            frequency: FrequencyData::of(unit),
            frequencies: points
                .iter()
                .map(|p| rounded(unit.of(p.angular_frequency_rad_per_s)))
                .collect(),
            storage_modulus_pa: numbers(|p| p.storage_modulus_pa),
            loss_modulus_pa: numbers(|p| p.loss_modulus_pa),
        }
    }
}

/// A case's part of a page of so many.
fn case(plan: &SweepPlan, record: &CaseRecord, result: &CaseResult, cases: usize) -> CaseData {
    let samples = &result.cycle.samples;
    let places = spread(samples.time_s.len(), share(cases, 100, 32));
    let fineness = Fineness::of(cases);
    let indenter = plan.indenter_under(&record.varied);
    let work = WorkLine::of(&result.cycle.surface_loss, indenter);
    let harmonics = result.analysis.harmonics.iter();
    CaseData {
        index: record.index,
        samples: Loop {
            time_s: picked(&samples.time_s, &places),
            load_n: picked(&samples.load_n, &places),
            approach_m: picked(&samples.approach_m, &places),
            contact_radius_m: picked(&samples.contact_radius_m, &places),
            peak_pressure_pa: picked_optional(&samples.peak_pressure_pa, &places),
        },
        harmonics: harmonics
            .map(|h| [rounded(h.load_amplitude_n), rounded(h.approach_amplitude_m)])
            .collect(),
        pressure: PressureData::of(
            &result.cycle.pressures,
            work.along,
            plan.base.drive.control(),
            &fineness,
        ),
        work: WorkData::of(&result.cycle.surface_loss, &work, &fineness),
    }
}
