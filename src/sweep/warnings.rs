//! What lies outside the model, or was not estimated: of a case, of a sweep, of a history. The limits are those of
//! [`crate::guide::validity`], and this file is where the program has them.
//!
//! # Slope and strain
//!
//! Small strains and small slopes are one question for indenters: with s the slope of the indenter within the contact, the
//! representative strain is 0.2 s, which is 0.2 a/R for a sphere and 0.2 cot(alpha) for a cone (K. L. Johnson, Contact
//! Mechanics, 1985, section 6.3, after D. Tabor, 1951). A convex body of revolution is steepest at the edge of contact, where its
//! slope follows from the transformed gap G,
//!
//! ```text
//! g(r) = (2/pi) * integral from 0 to pi/2 of G(r sin(t)) dt          s = g'(a)
//! ```
//!
//! A body with a rim, such as a flat punch, presses its rim in by the whole approach: s is at least delta/a there, which
//! has the mean pressure of a sphere with 1.5 s. On cells s is the slope that 95 % of the contact area stay below, from
//! differences between cells that are both in contact: one bad point of a map, or the wall of a punch, does not count.
//!
//! Heating, adhesion and inertia are not judged: the program knows neither conductivity nor surface energy nor density.

use std::f64::consts::FRAC_PI_2;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::contact::half_space::grid::Grid;
use crate::drive::{Segment, SegmentedDrive};
use crate::indenter::{Axisymmetric, Indenter};
use crate::quantity::{Dimension, format_human};
use crate::sweep::body_material::BodyMaterial;
use crate::sweep::domain;
use crate::sweep::plan::{EngineKind, SweepPlan};
use crate::sweep::record::{CaseRecord, CaseResult, CellLoss, SurfaceLoss};
use crate::sweep::scenario::ScenarioPlan;
use crate::sweep::simulate::{HistoryRow, SimulationOutcome};

/// Slope of an indenter up to which slopes are small: a/R of a sphere, 11 degrees of a cone.
pub const LARGEST_SLOPE: f64 = 0.2;
/// Strain up to which a glassy polymer is linear, and the modulus |E*| (Pa) from which a material counts as glassy. Softer ones
/// are linear further than slopes are small: [`LARGEST_SLOPE`] is a strain of 4 %.
pub const LARGEST_GLASSY_STRAIN: f64 = 0.01;
pub const GLASSY_MODULUS_PA: f64 = 1e9;
/// Representative strain over slope.
const STRAIN_PER_SLOPE: f64 = 0.2;
/// Share of the contact area, on cells, that a slope is not below.
const STEEPEST_SHARE: f64 = 0.05;
/// Rounding of what is compared with a limit.
const ROUNDING: f64 = 1e-9;

/// One thing to be said of a case or of a history.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "code", rename_all = "kebab-case")]
pub enum Warning {
    /// The frequency is below one over the longest time in which the material was measured.
    BelowMeasured {
        angular_frequency_rad_per_s: f64,
        last_measured_s: f64,
    },
    /// The frequency is above one over the shortest.
    AboveMeasured {
        angular_frequency_rad_per_s: f64,
        first_measured_s: f64,
    },
    /// Something in a history takes no longer than this time (s), 0 for a jump, and the material was measured later only.
    ShorterThanMeasured { time_s: f64, first_measured_s: f64 },
    /// A history lasts longer than the material was measured.
    LongerThanMeasured { time_s: f64, last_measured_s: f64 },
    /// The representative strain is beyond what a glassy material takes linearly.
    LargeStrain { strain: f64 },
    /// The indenter's slope within the contact is not small.
    SteepSlope { slope: f64, contact_radius_m: f64 },
    /// Error bars were wanted, and there are none.
    NoErrorBars { because: NoErrorBars },
}

/// Why there are no error bars.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoErrorBars {
    /// The indenter is a map, with one cell on every point.
    OwnCells,
    /// There is no coarser resolution, or it has no result.
    NoCoarserResult,
}

impl Warning {
    /// A short name, for tables and programs.
    pub fn code(&self) -> &'static str {
        match self {
            Self::BelowMeasured { .. } => "below-measured",
            Self::AboveMeasured { .. } => "above-measured",
            Self::ShorterThanMeasured { .. } => "shorter-than-measured",
            Self::LongerThanMeasured { .. } => "longer-than-measured",
            Self::LargeStrain { .. } => "large-strain",
            Self::SteepSlope { .. } => "steep-slope",
            Self::NoErrorBars { .. } => "no-error-bars",
        }
    }

    /// Among warnings of one kind, the one that says it for all of them has most of this.
    fn extent(&self) -> f64 {
        match *self {
            Self::BelowMeasured {
                angular_frequency_rad_per_s,
                ..
            } => -angular_frequency_rad_per_s,
            Self::AboveMeasured {
                angular_frequency_rad_per_s,
                ..
            } => angular_frequency_rad_per_s,
            Self::ShorterThanMeasured { time_s, .. } => -time_s,
            Self::LongerThanMeasured { time_s, .. } => time_s,
            Self::LargeStrain { strain } => strain,
            Self::SteepSlope { slope, .. } => slope,
            Self::NoErrorBars { .. } => 0.0,
        }
    }
}

/// One line.
impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let time = |time_s| format_human(time_s, Dimension::Time, 3);
        let frequency = |time_s: f64| format_human(time_s.recip(), Dimension::AngularFrequency, 3);
        match *self {
            Self::BelowMeasured {
                last_measured_s, ..
            } => write!(
                f,
                "the material was measured up to {}: below {} it is an extrapolation",
                time(last_measured_s),
                frequency(last_measured_s)
            ),
            Self::AboveMeasured {
                first_measured_s, ..
            } => write!(
                f,
                "the material was measured from {} on: above {} it is an extrapolation",
                time(first_measured_s),
                frequency(first_measured_s)
            ),
            Self::ShorterThanMeasured {
                time_s,
                first_measured_s,
            } => {
                let first = time(first_measured_s);
                match time_s {
                    0.0 => write!(
                        f,
                        "the material was measured from {first} on: up to then after a jump of the drive it is an extrapolation"
                    ),
                    _ => write!(
                        f,
                        "the material was measured from {first} on, and the drive changes within {}: there it is an extrapolation",
                        time(time_s)
                    ),
                }
            }
            Self::LongerThanMeasured {
                time_s,
                last_measured_s,
            } => write!(
                f,
                "the material was measured up to {}, and the history lasts {}: beyond, it is an extrapolation",
                time(last_measured_s),
                time(time_s)
            ),
            Self::LargeStrain { strain } => write!(
                f,
                "strains up to {} %: a glassy material is linear up to about {} %",
                two_digits(100.0 * strain),
                100.0 * LARGEST_GLASSY_STRAIN
            ),
            Self::SteepSlope {
                slope,
                contact_radius_m,
            } => write!(
                f,
                "slopes of the indenter in the contact (a/R of a sphere) up to {} at a contact radius of {}: the model takes them \
                 as small, up to about {LARGEST_SLOPE}",
                two_digits(slope),
                format_human(contact_radius_m, Dimension::Length, 3)
            ),
            Self::NoErrorBars {
                because: NoErrorBars::OwnCells,
            } => f.write_str(
                "no error bars: a map is solved on its own cells, and there are no coarser ones to compare with",
            ),
            Self::NoErrorBars {
                because: NoErrorBars::NoCoarserResult,
            } => f.write_str("no error bars: there is no coarser result to compare with"),
        }
    }
}

/// Two significant digits of a positive number, all of a large one before its point.
fn two_digits(value: f64) -> String {
    let decimals = (1.0 - value.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.decimals$}")
}

/// A kind of warning over the cases of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OverCases {
    pub code: &'static str,
    /// What is to be said, of the case it is truest of.
    pub message: String,
    /// Cases it is to be said of, and the range of their frequencies.
    pub cases: usize,
    pub lowest_angular_frequency_rad_per_s: f64,
    pub highest_angular_frequency_rad_per_s: f64,
    #[serde(skip)]
    of: usize,
}

/// What is to be said of these cases: one entry per kind, in the order in which kinds first occur.
pub fn over_cases(records: &[CaseRecord]) -> Vec<OverCases> {
    let mut kinds: Vec<(Warning, OverCases)> = Vec::new();
    for record in records {
        let omega = record.angular_frequency_rad_per_s;
        for warning in &record.warnings {
            let known = (kinds.iter_mut()).find(|(_, over)| over.code == warning.code());
            match known {
                Some((worst, over)) => {
                    if warning.extent() > worst.extent() {
                        *worst = *warning;
                    }
                    over.cases += 1;
                    let (low, high) = (
                        &mut over.lowest_angular_frequency_rad_per_s,
                        &mut over.highest_angular_frequency_rad_per_s,
                    );
                    (*low, *high) = (low.min(omega), high.max(omega));
                }
                None => kinds.push((
                    *warning,
                    OverCases {
                        code: warning.code(),
                        message: String::new(),
                        cases: 1,
                        lowest_angular_frequency_rad_per_s: omega,
                        highest_angular_frequency_rad_per_s: omega,
                        of: records.len(),
                    },
                )),
            }
        }
    }
    let said = |(worst, over): (Warning, OverCases)| OverCases {
        message: worst.to_string(),
        ..over
    };
    kinds.into_iter().map(said).collect()
}

/// One line: the message, and of which cases.
impl fmt::Display for OverCases {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (low, high) = (
            self.lowest_angular_frequency_rad_per_s,
            self.highest_angular_frequency_rad_per_s,
        );
        let omega = |value| format_human(value, Dimension::AngularFrequency, 4);
        f.write_str(&self.message)?;
        match (self.cases == self.of, low == high) {
            (true, true) => Ok(()),
            (true, false) => f.write_str(" (all cases)"),
            (false, true) => write!(
                f,
                " ({} of {} cases, ω = {})",
                self.cases,
                self.of,
                omega(low)
            ),
            (false, false) => write!(
                f,
                " ({} of {} cases, ω = {} to {})",
                self.cases,
                self.of,
                omega(low),
                omega(high)
            ),
        }
    }
}

/// What is to be said of a case, once it is solved.
pub(super) fn of_case(
    plan: &SweepPlan,
    record: &CaseRecord,
    error_bars_wanted: bool,
) -> Vec<Warning> {
    let omega = record.angular_frequency_rad_per_s;
    let window = plan.material.measured_window_s();
    let mut warnings: Vec<Warning> = of_frequency(window, omega).into_iter().collect();
    let Some(result) = &record.result else {
        return warnings;
    };
    let slope = slope_of_case(plan.indenter.as_ref(), result);
    let modulus_pa = plan.material.longitudinal_complex_modulus(omega).norm();
    let radius_m = result.contact_radius_m.maximum;
    warnings.extend(of_slope(slope, radius_m, modulus_pa));
    if error_bars_wanted && result.errors.is_none() {
        let own =
            plan.solver.engine == EngineKind::HalfSpace && plan.indenter.own_cells().is_some();
        warnings.push(Warning::NoErrorBars {
            because: match own {
                true => NoErrorBars::OwnCells,
                false => NoErrorBars::NoCoarserResult,
            },
        });
    }
    warnings
}

/// What is to be said of a history, as far as it came.
pub fn of_history(plan: &ScenarioPlan, outcome: &SimulationOutcome) -> Vec<Warning> {
    let window = measured_window_s(&plan.material);
    let mut warnings = of_times(window, &plan.drive);
    let wider = |a, b| {
        let (a, b): (&HistoryRow, &HistoryRow) = (a, b);
        match b.contact_radius_m > a.contact_radius_m {
            true => b,
            false => a,
        }
    };
    if let Some(widest) = outcome.rows.iter().reduce(wider)
        && let Some(modulus_pa) = creep_modulus_pa(&plan.material, widest.time_s)
    {
        let slope = slope_of_history(plan, outcome, widest);
        warnings.extend(of_slope(slope, widest.contact_radius_m, modulus_pa));
    }
    warnings
}

/// A frequency against the times (s) in which the material was measured.
fn of_frequency(window_s: Option<(f64, f64)>, omega: f64) -> Option<Warning> {
    let (first_measured_s, last_measured_s) = window_s?;
    if omega * last_measured_s < 1.0 - ROUNDING {
        return Some(Warning::BelowMeasured {
            angular_frequency_rad_per_s: omega,
            last_measured_s,
        });
    }
    (omega * first_measured_s > 1.0 + ROUNDING).then_some(Warning::AboveMeasured {
        angular_frequency_rad_per_s: omega,
        first_measured_s,
    })
}

/// The times of a drive against those in which the material was measured.
fn of_times(window_s: Option<(f64, f64)>, drive: &SegmentedDrive) -> Vec<Warning> {
    let Some((first_measured_s, last_measured_s)) = window_s else {
        return Vec::new();
    };
    let (shortest_s, time_s) = (shortest_s(drive), drive.duration_s());
    let shorter = (shortest_s < first_measured_s * (1.0 - ROUNDING)).then_some(
        Warning::ShorterThanMeasured {
            time_s: shortest_s,
            first_measured_s,
        },
    );
    let longer =
        (time_s > last_measured_s * (1.0 + ROUNDING)).then_some(Warning::LongerThanMeasured {
            time_s,
            last_measured_s,
        });
    shorter.into_iter().chain(longer).collect()
}

/// The shortest time (s) within which a drive changes: 0 where it jumps.
fn shortest_s(drive: &SegmentedDrive) -> f64 {
    let jumps = (drive.joints().iter()).any(|joint| {
        joint
            .after
            .is_some_and(|after| after != joint.before.unwrap_or(0.0))
    });
    if jumps {
        return 0.0;
    }
    let of_segment = |segment: &Segment| match segment {
        Segment::Step { duration_s, .. }
        | Segment::Ramp { duration_s, .. }
        | Segment::Polynomial { duration_s, .. } => *duration_s,
        Segment::Sine {
            angular_frequency_rad_per_s,
            ..
        } => angular_frequency_rad_per_s.recip(),
        Segment::Table { times_s, .. } => times_s.last().copied().unwrap_or(f64::INFINITY),
    };
    let times_s = drive.segments().iter().map(of_segment);
    times_s.fold(f64::INFINITY, f64::min)
}

/// First and last time (s) at which the material of a history was measured, where that is known.
fn measured_window_s(material: &BodyMaterial) -> Option<(f64, f64)> {
    match material {
        BodyMaterial::Series(material) => material.measured_window_s(),
        BodyMaterial::Samples(sampled) => {
            let times_s = sampled.table().times_s();
            Some((*times_s.first()?, *times_s.last()?))
        }
    }
}

/// One over the longitudinal creep compliance (Pa) after this time.
fn creep_modulus_pa(material: &BodyMaterial, time_s: f64) -> Option<f64> {
    let poisson_ratio = match material {
        BodyMaterial::Series(material) => material.poisson_ratio(),
        BodyMaterial::Samples(sampled) => sampled.poisson_ratio(),
    };
    let contact_per_pa = material.compliance().ok()?.largest_per_pa(time_s);
    Some((1.0 - poisson_ratio * poisson_ratio) / contact_per_pa)
}

/// A slope within the contact, and the strain that goes with it in a material of this modulus.
fn of_slope(slope: Option<f64>, contact_radius_m: f64, modulus_pa: f64) -> Vec<Warning> {
    // A record holds finite numbers.
    let Some(slope) = slope.filter(|slope| slope.is_finite()) else {
        return Vec::new();
    };
    let strain = STRAIN_PER_SLOPE * slope;
    let largest_strain = LARGEST_GLASSY_STRAIN * (1.0 + ROUNDING);
    let large = modulus_pa >= GLASSY_MODULUS_PA && strain > largest_strain;
    let large = large.then_some(Warning::LargeStrain { strain });
    let steep = (slope > LARGEST_SLOPE * (1.0 + ROUNDING)).then_some(Warning::SteepSlope {
        slope,
        contact_radius_m,
    });
    large.into_iter().chain(steep).collect()
}

/// Slope within the largest contact of a cycle.
fn slope_of_case(indenter: &dyn Indenter, result: &CaseResult) -> Option<f64> {
    let (radius_m, approach_m) = (result.contact_radius_m.maximum, result.approach_m.maximum);
    match (indenter.axisymmetric(), &result.surface_loss) {
        (Some(body), _) => slope_of_body(body, radius_m, approach_m),
        (None, SurfaceLoss::Cells(loss)) => Patch::of_work(indenter, loss).steepest(),
        (None, SurfaceLoss::Radial { .. }) => None,
    }
}

/// Slope within the widest contact of a history. Of a shape that is no body of revolution the contact is taken as that lowest part
/// of it which has the area of the contact.
fn slope_of_history(
    plan: &ScenarioPlan,
    outcome: &SimulationOutcome,
    widest: &HistoryRow,
) -> Option<f64> {
    /// Cells along the longer side of the domain, where the shape has none of its own.
    const CELLS: usize = 128;
    let indenter = plan.indenter.as_ref();
    if let Some(body) = indenter.axisymmetric() {
        let approach_m = outcome.rows.iter().filter_map(|row| row.approach_m);
        let approach_m = approach_m.fold(0.0, f64::max);
        return slope_of_body(body, widest.contact_radius_m, approach_m);
    }
    let load_n = outcome.rows.iter().fold(0.0, |a, row| row.load_n.max(a));
    let compliance = plan.material.compliance().ok()?;
    let compliance_per_pa = compliance.largest_per_pa(plan.drive.duration_s());
    let grid = domain::grid(&indenter.domain(load_n, compliance_per_pa), CELLS, 0).ok()?;
    Patch::lowest(indenter, &grid, widest.contact_area_m2()).steepest()
}

/// Slope of a convex body of revolution at the edge of contact, or what a rim amounts to.
fn slope_of_body(body: &dyn Axisymmetric, radius_m: f64, approach_m: f64) -> Option<f64> {
    /// Points of the quadrature, and the part of the radius over which the gap is differentiated.
    const POINTS: usize = 64;
    const STEP: f64 = 1e-3;
    if radius_m <= 0.0 {
        return None;
    }
    let sine = |k: usize| (FRAC_PI_2 * (k as f64 + 0.5) / POINTS as f64).sin();
    let gap_m = |r_m: f64| {
        let sum: f64 = (0..POINTS)
            .map(|k| body.transformed_gap_m(r_m * sine(k)))
            .sum();
        sum / POINTS as f64
    };
    let inner_m = radius_m * (1.0 - STEP);
    let slope = (gap_m(radius_m) - gap_m(inner_m)) / (radius_m - inner_m);
    let rim = body.contact_limit_m().map(|limit_m| approach_m / limit_m);
    Some(slope.max(rim.unwrap_or(0.0)))
}

/// A rectangle of cells with the gap (m) of those in contact.
struct Patch {
    cells_x: usize,
    spacing_m: [f64; 2],
    gap_m: Vec<Option<f64>>,
}

impl Patch {
    /// The cells that a cycle was in contact with, which are those it did work on.
    fn of_work(indenter: &dyn Indenter, loss: &CellLoss) -> Self {
        let gap_m = |(cell, density): (usize, &f32)| {
            let (column, row) = (cell % loss.cells_x, cell / loss.cells_x);
            let x_m = loss.first_x_m + column as f64 * loss.spacing_x_m;
            let y_m = loss.first_y_m + row as f64 * loss.spacing_y_m;
            (*density != 0.0).then(|| indenter.gap_m(x_m, y_m))
        };
        Self {
            cells_x: loss.cells_x,
            spacing_m: [loss.spacing_x_m, loss.spacing_y_m],
            gap_m: loss
                .density_j_per_m2
                .iter()
                .enumerate()
                .map(gap_m)
                .collect(),
        }
    }

    /// The cells of least gap that together have this area (m2).
    fn lowest(indenter: &dyn Indenter, grid: &Grid, area_m2: f64) -> Self {
        let gaps_m = domain::gaps_m(indenter, grid);
        let mut order: Vec<usize> = (0..gaps_m.len()).collect();
        let cell_m2 = grid.spacing_x_m() * grid.spacing_y_m();
        let count = (area_m2 / cell_m2).round() as usize;
        if count < order.len() {
            order.select_nth_unstable_by(count, |a, b| gaps_m[*a].total_cmp(&gaps_m[*b]));
        }
        let mut gap_m = vec![None; gaps_m.len()];
        for cell in order.into_iter().take(count) {
            gap_m[cell] = Some(gaps_m[cell]);
        }
        Self {
            cells_x: grid.cells_x(),
            spacing_m: [grid.spacing_x_m(), grid.spacing_y_m()],
            gap_m,
        }
    }

    /// The slope that all but a small share of the contact stay below; `None` where no two cells in contact are neighbours.
    fn steepest(&self) -> Option<f64> {
        let mut slopes: Vec<f64> = (0..self.gap_m.len())
            .filter_map(|c| self.slope(c))
            .collect();
        slopes.sort_by(f64::total_cmp);
        let last = slopes.len().checked_sub(1)?;
        let at = ((1.0 - STEEPEST_SHARE) * last as f64).round() as usize;
        slopes.get(at).copied()
    }

    /// Slope in a cell, from those of its neighbours that are in contact too.
    fn slope(&self, cell: usize) -> Option<f64> {
        let here_m = self.gap_m.get(cell).copied().flatten()?;
        let column = cell % self.cells_x;
        let neighbour = |is_inside: bool, at: usize| match is_inside {
            true => self.gap_m.get(at).copied().flatten(),
            false => None,
        };
        let x = difference(
            neighbour(column > 0, cell.wrapping_sub(1)),
            here_m,
            neighbour(column + 1 < self.cells_x, cell + 1),
        );
        let y = difference(
            neighbour(cell >= self.cells_x, cell.wrapping_sub(self.cells_x)),
            here_m,
            neighbour(true, cell + self.cells_x),
        );
        let slope = |difference: Option<f64>, spacing_m: f64| difference.map(|d| d / spacing_m);
        let (x, y) = (slope(x, self.spacing_m[0]), slope(y, self.spacing_m[1]));
        match (x, y) {
            (None, None) => None,
            (x, y) => Some(x.unwrap_or(0.0).hypot(y.unwrap_or(0.0))),
        }
    }
}

/// Difference per cell, central where both neighbours are there.
fn difference(before: Option<f64>, here: f64, after: Option<f64>) -> Option<f64> {
    match (before, after) {
        (Some(before), Some(after)) => Some(0.5 * (after - before)),
        (Some(before), None) => Some(here - before),
        (None, Some(after)) => Some(after - here),
        (None, None) => None,
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::drive::Control;
    use crate::indenter::{
        Asperities, Asperity, Cone, Ellipsoid, FlatPunch, HeightMap, MapEdge, MapQuantity,
        PowerLaw, Shifted, Sphere,
    };

    const EVERY: [Warning; 8] = [
        Warning::BelowMeasured {
            angular_frequency_rad_per_s: 1e-4,
            last_measured_s: 1000.0,
        },
        Warning::AboveMeasured {
            angular_frequency_rad_per_s: 628.3,
            first_measured_s: 0.1,
        },
        Warning::ShorterThanMeasured {
            time_s: 0.0,
            first_measured_s: 0.1,
        },
        Warning::LongerThanMeasured {
            time_s: 2e3,
            last_measured_s: 1e3,
        },
        Warning::LargeStrain { strain: 0.0728 },
        Warning::SteepSlope {
            slope: 361.3,
            contact_radius_m: 3.613e-6,
        },
        Warning::NoErrorBars {
            because: NoErrorBars::OwnCells,
        },
        Warning::NoErrorBars {
            because: NoErrorBars::NoCoarserResult,
        },
    ];

    #[test]
    fn a_warning_is_stored_under_its_code_and_comes_back() {
        for warning in EVERY {
            let text = serde_json::to_string(&warning).unwrap();
            assert!(
                text.contains(&format!("\"code\":\"{}\"", warning.code())),
                "{text}"
            );
            assert_eq!(serde_json::from_str::<Warning>(&text).unwrap(), warning);
        }
    }

    #[test]
    fn a_warning_is_one_line_with_its_numbers() {
        let lines = EVERY.map(|warning| warning.to_string());
        assert!(
            lines
                .iter()
                .all(|line| !line.contains('\n') && line.len() < 200)
        );
        for (line, part) in lines.iter().zip([
            "measured up to 1000 s: below 1.00e-3 rad/s",
            "measured from 100 ms on: above 10.0 rad/s",
            "up to then after a jump",
            "lasts 2000 s",
            "strains up to 7.3 %: a glassy material is linear up to about 1 %",
            "up to 361 at a contact radius of 3.61 µm: the model takes them as small, up to about 0.2",
            "own cells",
            "no coarser result",
        ]) {
            assert!(line.contains(part), "{part:?} is missing in {line}");
        }
    }

    #[test]
    fn a_frequency_within_the_measured_times_is_not_warned_of() {
        let window = Some((0.1, 1000.0));
        // The ends themselves, with the rounding of one over them.
        for omega in [1e-3, 1.0, 10.0, 1.0 / 1000.0, 1.0 / 0.1] {
            assert_eq!(of_frequency(window, omega), None);
        }
        let code = |omega| of_frequency(window, omega).map(|warning| warning.code());
        assert_eq!(code(0.99e-3), Some("below-measured"));
        assert_eq!(code(10.1), Some("above-measured"));
        // A table that begins at 0 s tells of every high frequency.
        assert_eq!(of_frequency(Some((0.0, 1000.0)), 1e12), None);
        assert_eq!(of_frequency(None, 1e12), None);
    }

    #[test]
    fn a_drive_that_is_faster_or_longer_than_the_measurement_is_warned_of() {
        let ramp = |to, duration_s| Segment::Ramp { to, duration_s };
        let step = |to, duration_s| Segment::Step { to, duration_s };
        let codes = |segments: Vec<Segment>| -> Vec<&str> {
            let drive = SegmentedDrive::new(Control::Load, segments).unwrap();
            let warnings = of_times(Some((1.0, 100.0)), &drive);
            warnings.iter().map(Warning::code).collect()
        };
        assert!(codes(vec![ramp(1.0, 1.0), ramp(0.5, 99.0)]).is_empty());
        assert_eq!(codes(vec![step(1.0, 10.0)]), ["shorter-than-measured"]);
        // A step to the value that is held already is no jump.
        assert!(codes(vec![ramp(1.0, 2.0), step(1.0, 5.0)]).is_empty());
        assert_eq!(
            codes(vec![ramp(1.0, 0.5), ramp(0.5, 100.0)]),
            ["shorter-than-measured", "longer-than-measured"]
        );
        let sine = |angular_frequency_rad_per_s| Segment::Sine {
            mean: 1.0,
            amplitude: 0.5,
            angular_frequency_rad_per_s,
            phase_rad: 0.0,
            cycles: 2.0,
        };
        assert!(codes(vec![ramp(1.0, 2.0), sine(0.9)]).is_empty());
        assert_eq!(
            codes(vec![ramp(1.0, 2.0), sine(1.1)]),
            ["shorter-than-measured"]
        );
    }

    #[test]
    fn the_slope_at_the_edge_of_contact_is_that_of_the_shape() {
        let radius_m = 1e-3;
        let slope = |body: &dyn Indenter| {
            let body = body.axisymmetric().unwrap();
            slope_of_body(body, radius_m, 3e-5).unwrap()
        };
        let sphere = Arc::new(Sphere::new(0.01).unwrap());
        let shifted = Shifted::new(Arc::clone(&sphere) as _, 5e-3, 0.0).unwrap();
        let angle = 70_f64.to_radians();
        let power = PowerLaw::new(3.0, 1e-3, 1e-4).unwrap();
        // The gap is differentiated over a thousandth of the radius, inside of it: half of that times the exponent less one;
        // and the quadrature of a cone is good to 1/(24 n^2) of (pi/2)^2.
        for (slope, exact, tolerance) in [
            (slope(sphere.as_ref()), 0.1, 6e-4),
            (slope(&shifted), 0.1, 6e-4),
            (slope(&Cone::new(angle).unwrap()), angle.tan().recip(), 1e-4),
            (slope(&power), 0.3, 1.1e-3),
            (slope(&FlatPunch::new(2e-3).unwrap()), 0.015, 1e-12),
        ] {
            assert!((slope / exact - 1.0).abs() < tolerance, "{slope} {exact}");
        }
        let body = sphere.axisymmetric().unwrap();
        assert_eq!(slope_of_body(body, 0.0, 0.0), None);
    }

    /// The work of a cycle on cells within an ellipse of these half axes about a point.
    fn work(center_m: [f64; 2], axes_m: [f64; 2], cells: usize) -> CellLoss {
        let spacing = axes_m.map(|a| 2.0 * a / cells as f64);
        let at = |i: usize| (i as f64 + 0.5) / (0.5 * cells as f64) - 1.0;
        let inside = |cell: usize| at(cell % cells).hypot(at(cell / cells)) < 1.0;
        let density = (0..cells * cells).map(|cell| if inside(cell) { -1e-12 } else { 0.0 });
        CellLoss {
            first_x_m: center_m[0] - axes_m[0] + 0.5 * spacing[0],
            first_y_m: center_m[1] - axes_m[1] + 0.5 * spacing[1],
            spacing_x_m: spacing[0],
            spacing_y_m: spacing[1],
            cells_x: cells,
            density_j_per_m2: density.collect(),
        }
    }

    #[test]
    fn on_cells_the_slope_is_about_the_largest_within_the_contact() {
        let center_m = [3e-3, -1e-3];
        let sphere = Arc::new(Sphere::new(0.01).unwrap());
        let shifted = Shifted::new(sphere, center_m[0], center_m[1]).unwrap();
        let round = work(center_m, [1e-3, 1e-3], 40);
        let slope = Patch::of_work(&shifted, &round).steepest().unwrap();
        // 95 % of a disc lie within 0.975 of its radius; half a cell of 40 is 0.025 of it.
        assert!((slope / 0.1 - 0.975).abs() < 0.025, "{slope}");
        let flat = Ellipsoid::new(0.09, 0.01).unwrap();
        let oval = work([0.0; 2], [3e-3, 1e-3], 40);
        let slope = Patch::of_work(&flat, &oval).steepest().unwrap();
        // From 3 mm/90 mm to 1 mm/10 mm around the edge: near the latter end.
        assert!(slope > 0.085 && slope < 0.1, "{slope}");
        // One cell has no slope.
        assert_eq!(
            Patch::of_work(&shifted, &work([0.0; 2], [1e-3; 2], 1)).steepest(),
            None
        );
    }

    #[test]
    fn the_lowest_part_of_a_shape_is_where_its_asperities_are() {
        let asperity = |center_x_m, radius_m| Asperity {
            center_x_m,
            center_y_m: 0.0,
            radius_m,
            height_m: 0.0,
        };
        let pair = Asperities::new(vec![asperity(-1e-3, 1e-3), asperity(1e-3, 1e-3)]).unwrap();
        let grid = Grid::new(256, 128, 1e-5, 1e-5).unwrap();
        // Two spots of radius 0.1 mm, which is ten cells.
        let area_m2 = 2.0 * std::f64::consts::PI * 1e-8;
        let slope = Patch::lowest(&pair, &grid, area_m2).steepest().unwrap();
        assert!((slope / 0.1 - 0.95).abs() < 0.05, "{slope}");
    }

    #[test]
    fn the_wall_of_a_punch_and_what_is_beside_the_contact_have_no_slope() {
        let heights = (0..100).map(|i| match (i % 10, i / 10) {
            (2..=7, 2..=7) => 0.0,
            _ => -1e-3,
        });
        let map = HeightMap::new(
            (10, 10),
            (1e-5, 1e-5),
            heights.collect(),
            MapQuantity::Height,
            MapEdge::Rim,
        )
        .unwrap();
        let grid = Grid::new(10, 10, 1e-5, 1e-5).unwrap();
        let patch = Patch::lowest(&map, &grid, 36.0 * 1e-10);
        assert_eq!(patch.steepest(), Some(0.0));
    }

    #[test]
    fn strains_count_in_glassy_materials_and_slopes_in_all() {
        let codes = |slope, modulus_pa| -> Vec<&str> {
            let warnings = of_slope(Some(slope), 1e-3, modulus_pa);
            warnings.iter().map(Warning::code).collect()
        };
        assert!(codes(0.05, 3e9).is_empty());
        assert_eq!(codes(0.051, 3e9), ["large-strain"]);
        assert!(codes(0.2, 1e7).is_empty());
        assert_eq!(codes(0.201, 1e7), ["steep-slope"]);
        assert_eq!(codes(360.0, 3e9), ["large-strain", "steep-slope"]);
        assert!(codes(f64::INFINITY, 1e7).is_empty());
    }

    #[test]
    fn the_limits_are_those_of_the_guide() {
        let guide = include_str!("../guide/validity.md");
        for limit in [
            format!("≲ {} %", 100.0 * LARGEST_GLASSY_STRAIN),
            format!("≲ {LARGEST_SLOPE}"),
            format!("≥ {} GPa", GLASSY_MODULUS_PA / 1e9),
            format!("ε ≈ {STRAIN_PER_SLOPE} a/R"),
        ] {
            assert!(guide.contains(&limit), "{limit}");
        }
        for warning in EVERY {
            assert!(
                guide.contains(&format!("`{}`", warning.code())),
                "{warning}"
            );
        }
    }
}
