//! The numbers of a sweep as its page carries them: the table to the last digit, cycles and fields as fine as they are drawn.

use serde::Serialize;

use super::cases_table::{self, ShownColumn};
use super::compact::{all_rounded, picked, picked_optional, rounded, spread};
use super::surface_data::{Fineness, PressureData, WorkData, share};
use crate::cycle::Loop;
use crate::drive::Control;
use crate::material::{Material, MaterialFunction};
use crate::quantity::{Dimension, FrequencyUnit, ZERO_CELSIUS_K};
use crate::report::figure::curve::Abscissa;
use crate::report::figure::moduli::ModulusPoint;
use crate::report::figure::quantity::Quantity;
use crate::report::material::MaterialReport;
use crate::report::quantities::{Column, all_of_cases};
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
    /// What the curves are over: the frequency, or, where there is but one, the first axis of numbers.
    over: VariedData,
    peaks: &'a [Peak],
    branches: usize,
    /// Of every curve; empty where they have different ones.
    retardation_times_s: Vec<f64>,
    /// What else varies, in which a curve differs from another.
    varied: Vec<VariedData>,
    drive_unit: &'static str,
    node_name: &'static str,
    material: MaterialData,
    /// The cycles that the page holds.
    cases: Vec<CaseData>,
    /// The columns of the table of cases, where it is read page by page.
    table: Vec<ShownColumn>,
}

/// A column of `sweep.csv` that varies, and how it is told: what its axis is called, what stands before a value, and its unit.
#[derive(Serialize)]
pub(super) struct VariedData {
    column: String,
    label: String,
    pub(super) name: String,
    unit: &'static str,
    /// Where the zero of that unit lies (SI), and the factor from SI to it.
    zero: f64,
    factor: f64,
    /// Whether its cells are names.
    named: bool,
}

impl VariedData {
    fn of(varied: &Varied, control: Control) -> Self {
        let (unit, zero, factor) = match varied.dimension {
            Some(Dimension::Temperature) => ("°C", ZERO_CELSIUS_K, 1.0),
            Some(Dimension::Angle) => ("°", 0.0, 1_f64.to_degrees()),
            Some(dimension) => (dimension.si_unit(), 0.0, 1.0),
            None => ("", 0.0, 1.0),
        };
        Self {
            column: varied.column(),
            label: Quantity::varied(varied, control).words.into_owned(),
            name: varied.name(),
            unit,
            zero,
            factor,
            named: varied.is_whole(),
        }
    }

    fn frequency(unit: FrequencyUnit) -> Self {
        Self {
            column: FrequencyUnit::RadPerS.column().to_owned(),
            label: format!("{} {}", unit.quantity(), unit.symbol()),
            name: unit.symbol().to_string(),
            unit: unit.name(),
            zero: 0.0,
            factor: unit.of(1.0),
            named: false,
        }
    }

    /// What the curves of a sweep are over, and what else varies.
    pub(super) fn of_sweep(plan: &SweepPlan) -> (Self, Vec<Self>) {
        let axes = plan.axes.as_ref().map_or(&[][..], |axes| &axes.over);
        let control = plan.base.drive.control();
        let mut varied: Vec<Self> = axes.iter().map(|axis| Self::of(axis, control)).collect();
        let over = match Abscissa::of(plan) {
            Abscissa::Frequency => Self::frequency(plan.figures.frequency_unit),
            Abscissa::Axis(axis) => varied.remove(axis),
        };
        (over, varied)
    }
}

/// What an axis of frequencies is called.
#[derive(Serialize)]
pub(super) struct FrequencyData {
    label: String,
    quantity: &'static str,
    name: char,
    unit: &'static str,
}

impl FrequencyData {
    pub(super) fn of(unit: FrequencyUnit) -> Self {
        Self {
            label: format!("{} {}", unit.quantity(), unit.symbol()),
            quantity: unit.quantity(),
            name: unit.symbol(),
            unit: unit.name(),
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
        let (over, varied) = VariedData::of_sweep(plan);
        Self {
            kind: "sweep",
            csv,
            quantities: all_of_cases(plan.is_attracted())
                .filter_map(quantity)
                .collect(),
            over,
            peaks: &outcome.peaks,
            branches: outcome.branches(),
            retardation_times_s: all_rounded(&outcome.retardation_times_s()),
            varied,
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
