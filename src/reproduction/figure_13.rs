//! Figure 13: the energy loss of PMMA over frequency, as the area of the stabilised loop; and beside it the work from first
//! touch to the second maximum of the load, which has the shape that the paper shows.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use super::by_engine::{By, simulate};
use super::claim::Value;
use super::cycles::{STEPS_ON_CELLS, peak};
use super::look::{SPRINGS, cells_label};
use super::number::datum;
use super::stabilised::{by_sweep, stabilised};
use super::{Claim, Figure, Measure, Plans, ReproductionError, Stated};
use crate::drive::{Segment, SegmentedDrive};
use crate::report::chart::{Axis, Chart, LegendPlace, LineStyle, Mark, Marker, Series};
use crate::report::table::Table;
use crate::sweep::plan::scenario::ScenarioPlan;
use crate::sweep::plan::{EngineKind, SweepPlan};
use crate::sweep::search::peak as search;

/// Where the paper has its maximum, and what it shows at the highest frequency (rad/s).
const PAPER_PEAK: f64 = 0.0031;
const HIGHEST: f64 = 0.3;
/// About where the two curves have their maxima (rad/s).
const LOOP_PEAK: f64 = 0.00844;
const WORK_PEAK: f64 = 0.0041;

/// Frequencies (rad/s) of the closed loop on cells: the paper's maximum, three about the first maximum of the loss, its second
/// maximum, and the end of the range.
const LOOPS_ON_CELLS: [f64; 6] = [PAPER_PEAK, 0.007_673, LOOP_PEAK, 0.009_284, 0.0757, HIGHEST];
/// Of the work from first touch: three about its maximum, and others.
const WORK_ON_CELLS: [f64; 6] = [0.001, 0.003_417, WORK_PEAK, 0.004_92, 0.03, HIGHEST];
const WORK_ON_SPRINGS: [f64; 36] = [
    0.000_2, 0.000_5, 0.000_75, 0.001, 0.0015, 0.002, 0.0025, 0.003_417, WORK_PEAK, 0.004_92,
    0.0055, 0.0065, 0.0075, 0.009, 0.011, 0.0135, 0.017, 0.02, 0.0245, 0.03, 0.0375, 0.045, 0.055,
    0.065, 0.08, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2, 0.22, 0.24, 0.26, 0.28, HIGHEST,
];

type Points = Vec<(f64, f64)>;

/// One curve by both engines, absolute (J).
struct Curve {
    springs: Points,
    refined: Points,
    cells: Points,
}

/// The figure.
pub(super) fn figures(
    plans: &Plans,
    interrupt: &AtomicBool,
) -> Result<Vec<Figure>, ReproductionError> {
    let plan = plans.sweep("figure-13")?;
    let scenario = plans.scenario("figure-13-first-touch")?;
    let loops = loops(plan, interrupt)?;
    let work = work(scenario, interrupt)?;
    let largest = largest(plan, &loops, interrupt)?;
    let most = peak(about(&work.refined, WORK_PEAK)?);
    let closed = normalised(&loops, largest.1);
    let touched = normalised(&work, most.1);
    let mut table = Table::new(
        "figure-13.csv",
        &[
            "quantity",
            "source",
            "angular_frequency_rad_per_s",
            "energy_j",
            "share_of_largest",
        ],
    )?;
    for (quantity, absolute, shares) in [
        ("stabilised loop", &loops, &closed),
        ("work from first touch", &work, &touched),
    ] {
        for (source, absolute, shares) in [
            ("axisymmetric", &absolute.springs, &shares.springs),
            ("half-space", &absolute.cells, &shares.cells),
        ] {
            for ((omega, energy), (_, share)) in absolute.iter().zip(shares) {
                // Joules are far from 1: to five digits, whatever their size.
                let energy = format!("{energy:.4e}");
                let [omega, share] = [*omega, *share].map(datum);
                table.row(&[quantity.to_owned(), source.to_owned(), omega, energy, share])?;
            }
        }
    }
    Ok(vec![Figure {
        number: 13,
        caption: CAPTION.to_owned(),
        panels: panels(&closed, &touched, plan.solver.cells, scenario.solver.cells),
        data: table.finish()?,
        claims: claims(&loops, &work, largest, most)?,
        statements: Vec::new(),
    }])
}

const CAPTION: &str = "PMMA under a sphere, W = W₀ + W_A sin ωt with W₀ = 2 W_A after 500 s at W₀; each curve relative to its \
    largest value. Above: the area of the stabilised loop, which is the energy loss per cycle, and the work from first touch \
    through carrier step and hold to the second maximum of the load. Below: the same on the paper's axis.";

/// The stabilised loops.
fn loops(plan: &SweepPlan, interrupt: &AtomicBool) -> Result<Curve, ReproductionError> {
    let by_springs = |omegas: &[f64], finer: usize| -> Result<Points, ReproductionError> {
        let losses = omegas.par_iter().with_max_len(1).map(|&omega| {
            let result = by_sweep(plan, omega, finer, interrupt)?;
            Ok((omega, result.analysis.energy_loss_j))
        });
        losses.collect()
    };
    let mut omegas = plan.angular_frequencies_rad_per_s.clone();
    omegas.extend(LOOPS_ON_CELLS);
    omegas.sort_by(f64::total_cmp);
    omegas.dedup();
    let cells = LOOPS_ON_CELLS.par_iter().with_max_len(1).map(|&omega| {
        let cycle = stabilised(
            plan,
            omega,
            EngineKind::HalfSpace,
            STEPS_ON_CELLS,
            interrupt,
        )?;
        Ok((omega, cycle.energy_loss_j()?))
    });
    Ok(Curve {
        cells: cells.collect::<Result<_, ReproductionError>>()?,
        springs: by_springs(&omegas, 1)?,
        refined: by_springs(&LOOPS_ON_CELLS, 4)?,
    })
}

/// Where the loss is largest over frequency, and how large it is there, refined: (rad/s, J).
fn largest(
    plan: &SweepPlan,
    loops: &Curve,
    interrupt: &AtomicBool,
) -> Result<(f64, f64), ReproductionError> {
    let bracket = about(&loops.refined, LOOP_PEAK)?;
    let losses = |omegas: &[f64]| {
        let losses = omegas
            .iter()
            .map(|&omega| by_sweep(plan, omega, 1, interrupt));
        losses
            .map(|result| Ok((result?.analysis.energy_loss_j, None)))
            .collect()
    };
    let found = search::refine::<ReproductionError>(&bracket, &losses)?;
    // The loss is flat about its maximum: the refined one nearest to it is as large.
    Ok((found.angular_frequency_rad_per_s, bracket[1].1))
}

/// A point and its neighbours.
fn about(points: &Points, omega: f64) -> Result<[(f64, f64); 3], ReproductionError> {
    let near = |point: &(f64, f64)| (point.0 / omega - 1.0).abs() < 1e-9;
    let place = points.iter().position(near);
    let neighbours = place.and_then(|k| {
        let before = points.get(k.checked_sub(1)?)?;
        Some([*before, *points.get(k)?, *points.get(k + 1)?])
    });
    neighbours.ok_or_else(|| ReproductionError::Unfit(format!("{omega} rad/s was not computed")))
}

/// The work from first touch to the second maximum of the load.
fn work(scenario: &ScenarioPlan, interrupt: &AtomicBool) -> Result<Curve, ReproductionError> {
    let by = |by: By, omegas: &[f64]| -> Result<Points, ReproductionError> {
        let works = omegas.par_iter().with_max_len(1).map(|&omega| {
            let outcome = simulate(&at_frequency(scenario, omega)?, by, interrupt)?;
            let points: Vec<(f64, f64)> = outcome
                .rows
                .iter()
                .filter_map(|row| Some((row.load_n, row.approach_m?)))
                .collect();
            let work_j = integral(&points).ok_or_else(|| {
                ReproductionError::Unfit(format!("{omega} rad/s: the history has no approach"))
            })?;
            Ok((omega, work_j))
        });
        works.collect()
    };
    Ok(Curve {
        cells: by(By::Cells, &WORK_ON_CELLS)?,
        springs: by(By::Springs, &WORK_ON_SPRINGS)?,
        refined: by(By::RefinedSprings, &WORK_ON_CELLS)?,
    })
}

/// Integral of W d(delta) from first touch. The jump follows Hertz' curve W ~ delta^(3/2), whose work is two fifths of load
/// times approach. `None` of no points.
fn integral(points: &[(f64, f64)]) -> Option<f64> {
    let jump = points.first().map(|(w, d)| 0.4 * w * d)?;
    let parts = points.windows(2).map(|pair| {
        let [(w0, d0), (w1, d1)] = [pair[0], pair[1]];
        0.5 * (w0 + w1) * (d1 - d0)
    });
    Some(jump + parts.sum::<f64>())
}

/// The scenario with another frequency in its sine.
fn at_frequency(scenario: &ScenarioPlan, omega: f64) -> Result<ScenarioPlan, ReproductionError> {
    let segments = scenario.drive.segments().iter().cloned();
    let segments = segments.map(|mut segment| {
        if let Segment::Sine {
            angular_frequency_rad_per_s,
            ..
        } = &mut segment
        {
            *angular_frequency_rad_per_s = omega;
        }
        segment
    });
    let drive = SegmentedDrive::new(scenario.drive.control(), segments.collect());
    Ok(ScenarioPlan {
        drive: drive.map_err(|error| ReproductionError::Unfit(error.to_string()))?,
        ..scenario.clone()
    })
}

fn normalised(curve: &Curve, largest_j: f64) -> Curve {
    let shares = |points: &Points| points.iter().map(|(w, e)| (*w, e / largest_j)).collect();
    Curve {
        springs: shares(&curve.springs),
        refined: shares(&curve.refined),
        cells: shares(&curve.cells),
    }
}

fn panels(closed: &Curve, touched: &Curve, cells: usize, cells_work: usize) -> Vec<Chart> {
    let panel = |y: Axis, height_px: u32| {
        let line = |points: &Points, place: usize| {
            Series::line(points.clone())
                .color(place)
                .style(LineStyle::nth(place))
        };
        let symbols = |points: &Points, place: usize, marker| {
            Series::scatter(points.clone()).color(place).marker(marker)
        };
        Chart::new(
            Axis::linear("angular frequency ω / rad·s⁻¹").range(0.0, HIGHEST),
            y,
        )
        .series(line(&closed.springs, 0).label(format!("stabilised loop, {SPRINGS}")))
        .series(
            symbols(&closed.cells, 0, Marker::Ring)
                .label(format!("stabilised loop, {}", cells_label(cells))),
        )
        .series(line(&touched.springs, 1).label(format!("work from first touch, {SPRINGS}")))
        .series(symbols(&touched.cells, 1, Marker::Square).label(format!(
            "work from first touch, {}",
            cells_label(cells_work)
        )))
        .mark(Mark::vertical(
            PAPER_PEAK,
            "0.0031 rad/s: maximum in the paper",
        ))
        .size(800, height_px)
    };
    vec![
        panel(Axis::linear("share of the largest").range(0.0, 1.05), 560)
            .legend(LegendPlace::Above),
        panel(Axis::linear("share of the largest").range(0.9, 1.01), 440).legend(None),
    ]
}

fn claims(
    loops: &Curve,
    work: &Curve,
    largest: (f64, f64),
    most: (f64, f64),
) -> Result<Vec<Claim>, ReproductionError> {
    let value = |points: &Points, omega: f64| {
        let near = |point: &&(f64, f64)| (point.0 / omega - 1.0).abs() < 1e-9;
        points.iter().find(near).map(|point| point.1)
    };
    let at = |curve: &Curve, omega: f64| -> [Option<f64>; 3] {
        [&curve.refined, &curve.springs, &curve.cells].map(|points| value(points, omega))
    };
    let claim = |quantity: &str, found: [Option<f64>; 3], accuracy: f64| {
        let [exact, springs, cells] = found;
        Claim {
            figure: 13,
            quantity: quantity.to_owned(),
            exact: Value::Refined(exact),
            axisymmetric: springs,
            half_space: cells,
            measure: Measure::relative(exact, accuracy, accuracy),
            stated: Stated::default(),
            note: String::new(),
        }
    };
    let maxima = |curve: &Curve, middle: f64| -> Result<[(f64, f64); 2], ReproductionError> {
        Ok([
            peak(about(&curve.springs, middle)?),
            peak(about(&curve.cells, middle)?),
        ])
    };
    let of_loops = maxima(loops, LOOP_PEAK)?;
    let of_work = maxima(work, WORK_PEAK)?;
    let pair = |exact: f64, found: [f64; 2]| [Some(exact), Some(found[0]), Some(found[1])];
    let shares = |found: [Option<f64>; 3], by: [f64; 3]| -> [Option<f64>; 3] {
        let [exact, springs, cells] = found;
        let share = |value: Option<f64>, by: f64| value.map(|value| value / by);
        [
            share(exact, by[0]),
            share(springs, by[1]),
            share(cells, by[2]),
        ]
    };
    let micro = |found: [Option<f64>; 3]| found.map(|value| value.map(|joule| 1e6 * joule));
    let loop_maxima = [largest.1, of_loops[0].1, of_loops[1].1];
    let work_maxima = [most.1, of_work[0].1, of_work[1].1];
    let closed_note =
        "the area of a closed loop vanishes with ω and with 1/ω: it has no asymptote above zero";
    let work_note =
        "the work from first touch holds the carrier step and the hold, which do not vanish";
    Ok(vec![
        Claim {
            note: "the maximum of the area of the stabilised loop".to_owned(),
            ..claim(
                "stabilised loop: ω of the largest loss / rad·s⁻¹",
                pair(largest.0, of_loops.map(|p| p.0)),
                0.02,
            )
        },
        Claim {
            ..claim(
                "stabilised loop: largest loss / µJ, W₀ = 10 N, R = 10 mm",
                micro(pair(largest.1, of_loops.map(|p| p.1))),
                2e-3,
            )
        },
        Claim {
            note: "PMMA has two relaxation times, and the loss a second maximum".to_owned(),
            ..claim(
                "stabilised loop: loss at the second maximum, 0.0757 rad/s / µJ",
                micro(at(loops, 0.0757)),
                2e-3,
            )
        },
        claim(
            "stabilised loop: loss at 0.0031 rad/s, share of the largest",
            shares(at(loops, PAPER_PEAK), loop_maxima),
            2e-3,
        ),
        Claim {
            note: closed_note.to_owned(),
            ..claim(
                "stabilised loop: loss at 0.3 rad/s, share of the largest",
                shares(at(loops, HIGHEST), loop_maxima),
                2e-3,
            )
        },
        Claim {
            note: "near the paper's maximum, not at it".to_owned(),
            ..claim(
                "work from first touch: ω of the largest / rad·s⁻¹",
                pair(most.0, of_work.map(|p| p.0)),
                0.03,
            )
        },
        Claim {
            note: work_note.to_owned(),
            ..claim(
                "work from first touch: at 0.3 rad/s, share of the largest",
                shares(at(work, HIGHEST), work_maxima),
                2e-3,
            )
        },
        Claim {
            ..claim(
                "work from first touch: at 0.001 rad/s, share of the largest",
                shares(at(work, 0.001), work_maxima),
                2e-3,
            )
        },
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_work_along_the_curve_of_hertz_is_two_fifths_of_load_times_approach() {
        let work_j = |points: &[(f64, f64)]| integral(points).unwrap();
        assert!((work_j(&[(10.0, 2e-6)]) - 8e-6).abs() < 1e-20);
        // Then held while the approach creeps.
        assert!((work_j(&[(10.0, 2e-6), (10.0, 3e-6)]) - 18e-6).abs() < 1e-20);
        assert_eq!(integral(&[]), None);
    }
}
