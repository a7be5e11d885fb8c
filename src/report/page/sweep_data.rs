//! The numbers of a sweep as its page carries them: the table to the last digit, cycles and fields as fine as they are drawn.

use serde::Serialize;

use super::compact::{all_rounded, coarse, picked, picked_optional, rounded, spread};
use super::how::nodes_name;
use crate::material::{Material, ModulusKind};
use crate::report::figure::moduli::ModulusPoint;
use crate::report::material::MaterialReport;
use crate::sweep::peak::Peak;
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::{CaseRecord, CaseResult, SurfaceLoss};
use crate::sweep::run::Outcome;

/// Everything the script of the page knows.
#[derive(Serialize)]
pub(super) struct SweepData<'a> {
    kind: &'static str,
    /// `sweep.csv`.
    csv: &'a str,
    peaks: &'a [Peak],
    retardation_times_s: Vec<f64>,
    /// What the second axis varies, where there is one.
    varied: Option<&'static str>,
    drive_unit: &'static str,
    node_name: &'static str,
    material: MaterialData,
    cases: Vec<CaseData>,
}

/// Moduli over frequency.
#[derive(Serialize)]
pub(super) struct MaterialData {
    symbol: char,
    angular_frequency_rad_per_s: Vec<f64>,
    storage_modulus_pa: Vec<f64>,
    loss_modulus_pa: Vec<f64>,
}

/// The cycle of one converged case.
#[derive(Serialize)]
struct CaseData {
    index: usize,
    time_s: Vec<f64>,
    load_n: Vec<f64>,
    approach_m: Vec<f64>,
    contact_radius_m: Vec<f64>,
    peak_pressure_pa: Vec<Option<f64>>,
    /// Amplitudes of load (N) and approach (m), first harmonic first.
    harmonics: Vec<[f64; 2]>,
    surface: SurfaceData,
}

#[derive(Serialize)]
#[serde(untagged)]
enum SurfaceData {
    Radial {
        radius_m: Vec<f64>,
        density_j_per_m2: Vec<Option<f64>>,
    },
    Cells {
        first_x_m: f64,
        first_y_m: f64,
        spacing_x_m: f64,
        spacing_y_m: f64,
        cells_x: usize,
        values: Vec<Option<f64>>,
    },
}

/// Points of a loop, of a profile, and cells along a side of a map.
struct Fineness {
    points: usize,
    radii: usize,
    cells: usize,
}

impl Fineness {
    /// As fine as can be seen up to a hundred cases; coarser beyond, so that the page stays light.
    fn of(cases: usize) -> Self {
        let share = |most: usize, least: usize| (100 * most / cases.max(100)).max(least);
        Self {
            points: share(100, 32),
            radii: share(80, 24),
            cells: share(40, 12),
        }
    }
}

impl<'a> SweepData<'a> {
    /// The data of a sweep whose table is `csv`.
    pub(super) fn new(plan: &SweepPlan, outcome: &'a Outcome, csv: &'a str) -> Self {
        let fineness = Fineness::of(outcome.records.len());
        let cases = outcome.records.iter();
        Self {
            kind: "sweep",
            csv,
            peaks: &outcome.peaks,
            retardation_times_s: all_rounded(&outcome.retardation_times_s()),
            varied: plan.axis.as_ref().map(|axis| axis.varied.name()),
            drive_unit: plan.drive.control().unit(),
            node_name: nodes_name(plan.solver.engine),
            material: MaterialData::of(&plan.material),
            cases: cases
                .filter_map(|r| Some(case(r, r.result.as_ref()?, &fineness)))
                .collect(),
        }
    }
}

impl MaterialData {
    /// Ten points a decade.
    pub(super) fn of(material: &Material) -> Self {
        let points = MaterialReport::new(material).moduli(10);
        let numbers =
            |value: fn(&ModulusPoint) -> f64| points.iter().map(value).map(rounded).collect();
        Self {
            symbol: match material.kind() {
                ModulusKind::Longitudinal => 'E',
                ModulusKind::Shear => 'G',
            },
            angular_frequency_rad_per_s: numbers(|p| p.angular_frequency_rad_per_s),
            storage_modulus_pa: numbers(|p| p.storage_modulus_pa),
            loss_modulus_pa: numbers(|p| p.loss_modulus_pa),
        }
    }
}

fn case(record: &CaseRecord, result: &CaseResult, fineness: &Fineness) -> CaseData {
    let samples = &result.samples;
    let places = spread(samples.time_s.len(), fineness.points);
    let harmonics = result.analysis.harmonics.iter();
    CaseData {
        index: record.index,
        time_s: picked(&samples.time_s, &places),
        load_n: picked(&samples.load_n, &places),
        approach_m: picked(&samples.approach_m, &places),
        contact_radius_m: picked(&samples.contact_radius_m, &places),
        peak_pressure_pa: picked_optional(&samples.peak_pressure_pa, &places),
        harmonics: harmonics
            .map(|h| [rounded(h.load_amplitude_n), rounded(h.approach_amplitude_m)])
            .collect(),
        surface: surface(&result.surface_loss, fineness),
    }
}

fn surface(loss: &SurfaceLoss, fineness: &Fineness) -> SurfaceData {
    match loss {
        SurfaceLoss::Radial {
            radius_m,
            density_j_per_m2,
        } => {
            let places = spread(radius_m.len(), fineness.radii);
            SurfaceData::Radial {
                radius_m: picked(radius_m, &places),
                density_j_per_m2: picked_optional(density_j_per_m2, &places),
            }
        }
        SurfaceLoss::Cells {
            first_x_m,
            first_y_m,
            spacing_x_m,
            spacing_y_m,
            cells_x,
            density_j_per_m2,
        } => {
            let value = |i: usize| density_j_per_m2.get(i).map(|v| f64::from(*v));
            let field = coarse(*cells_x, density_j_per_m2.len(), value, fineness.cells);
            let factor = field.factor as f64;
            // The centre of a coarse cell lies between those of the cells in it.
            let shift = 0.5 * (factor - 1.0);
            SurfaceData::Cells {
                first_x_m: rounded(first_x_m + shift * spacing_x_m),
                first_y_m: rounded(first_y_m + shift * spacing_y_m),
                spacing_x_m: rounded(factor * spacing_x_m),
                spacing_y_m: rounded(factor * spacing_y_m),
                cells_x: field.cells_x,
                values: field.values,
            }
        }
    }
}
