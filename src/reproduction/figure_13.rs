//! Figure 13: the energy loss of PMMA over frequency, as the area of the stabilised loop; and beside it the work from first
//! touch to the second maximum of the load, which has the shape that the paper shows.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use super::by_engine::{By, ByEngine, at_frequency, simulate};
use super::curves::{SPRINGS, about, cells_label, peak};
use super::cycles::STEPS_ON_CELLS;
use super::number::Data;
use super::stabilised::{by_sweep, stabilised};
use super::{Claim, Figure, Measure, Plans, ReproductionError, Result, Source};
use crate::cycle;
use crate::engine::EngineKind;
use crate::report::chart::{Axis, Chart, LegendPlace, LineStyle, Mark, Marker, Series};
use crate::report::table::cells;
use crate::simulation::scenario::ScenarioPlan;
use crate::sweep::plan::SweepPlan;
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

/// A curve over angular frequency (rad/s), absolute (J), and its maximum. Exact is what is refined.
struct Curve {
    energy_j: ByEngine<Points>,
    largest: ByEngine<(f64, f64)>,
}

/// The figure.
pub(super) fn figures(plans: &Plans, interrupt: &AtomicBool) -> Result<Vec<Figure>> {
    let plan = plans.sweep("figure-13")?;
    let scenario = plans.scenario("figure-13-first-touch")?;
    let loops = loops(plan, interrupt)?;
    let work = work(scenario, interrupt)?;
    let [closed, touched] = [&loops, &work].map(Curve::shares);
    let mut data = Data::new(&[
        "quantity",
        "source",
        "angular_frequency_rad_per_s",
        "energy_j",
        "share_of_largest",
    ]);
    for (quantity, curve) in [
        ("stabilised loop", &loops),
        ("work from first touch", &work),
    ] {
        let (_, largest_j) = curve.largest.exact;
        for (source, energies) in [
            ("axisymmetric", &curve.energy_j.axisymmetric),
            ("half-space", &curve.energy_j.half_space),
        ] {
            for (omega, energy_j) in energies {
                // Joules are far from 1: to five digits, whatever their size.
                let (energy, share) = (format!("{energy_j:.4e}"), energy_j / largest_j);
                data.row(cells![quantity, source, *omega, energy, share]);
            }
        }
    }
    let [cells, cells_of_work] = [&plan.solver, &scenario.solver].map(|s| s.cells);
    let panels = panels([
        ("stabilised loop", &closed, cells, Marker::Ring),
        (
            "work from first touch",
            &touched,
            cells_of_work,
            Marker::Square,
        ),
    ]);
    let claims = [claims_of_loops(&loops), claims_of_work(&work)].concat();
    Ok(vec![Figure::new(13, CAPTION, panels, data, claims)])
}

const CAPTION: &str = "PMMA under a sphere, W = W₀ + W_A sin ωt with W₀ = 2 W_A after 500 s at W₀; each curve relative to its \
    largest value. Above: the area of the stabilised loop, which is the energy loss per cycle, and the work from first touch \
    through carrier step and hold to the second maximum of the load. Below: the same on the paper's axis.";

/// A curve at these frequencies, every point on a thread of its own.
fn points(omegas: &[f64], energy_j: impl Fn(f64) -> Result<f64> + Sync) -> Result<Points> {
    let omegas = omegas.par_iter().with_max_len(1);
    omegas.map(|&omega| Ok((omega, energy_j(omega)?))).collect()
}

/// The stabilised loops.
fn loops(plan: &SweepPlan, interrupt: &AtomicBool) -> Result<Curve> {
    let loss = |omega, finer| {
        let result = by_sweep(plan, omega, finer, interrupt)?;
        Ok(result.analysis.energy_loss_j)
    };
    let mut omegas = plan.angular_frequencies_rad_per_s.clone();
    omegas.extend(LOOPS_ON_CELLS);
    omegas.sort_by(f64::total_cmp);
    omegas.dedup();
    let on_cells = |omega| {
        let engine = EngineKind::HalfSpace;
        let samples = stabilised(plan, omega, engine, STEPS_ON_CELLS, interrupt)?.samples;
        Ok(cycle::analyse(&samples.load_n, &samples.approach_m)?.energy_loss_j)
    };
    let cells = points(&LOOPS_ON_CELLS, on_cells)?;
    let springs = points(&omegas, |omega| loss(omega, 1))?;
    let refined = points(&LOOPS_ON_CELLS, |omega| loss(omega, 4))?;
    let bracket = about(&refined, LOOP_PEAK)?;
    let losses = |omegas: &[f64]| {
        let losses = omegas.iter().map(|&omega| Ok((loss(omega, 1)?, None)));
        losses.collect()
    };
    let found = search::refine::<ReproductionError>(&bracket, &losses)?;
    let mut curve = Curve::new(ByEngine::of(refined, [springs, cells]), LOOP_PEAK)?;
    // The loss is flat about its maximum: the refined one nearest to it is as large.
    curve.largest.exact = (found.angular_frequency_rad_per_s, bracket[1].1);
    Ok(curve)
}

/// The work from first touch to the second maximum of the load.
fn work(scenario: &ScenarioPlan, interrupt: &AtomicBool) -> Result<Curve> {
    let by = |by: By, omegas: &[f64]| {
        points(omegas, |omega| {
            let outcome = simulate(&at_frequency(scenario, omega, None)?, by, interrupt)?;
            let rows = outcome.rows.iter();
            let signal = rows.filter_map(|row| Some((row.load_n, row.approach_m?)));
            let unfit = format!("{omega} rad/s: the history has no approach");
            integral(&signal.collect::<Vec<_>>()).ok_or(ReproductionError::Unfit(unfit))
        })
    };
    let springs = by(By::Springs, &WORK_ON_SPRINGS)?;
    let cells = by(By::Cells, &WORK_ON_CELLS)?;
    let refined = by(By::RefinedSprings, &WORK_ON_CELLS)?;
    Curve::new(ByEngine::of(refined, [springs, cells]), WORK_PEAK)
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

impl Curve {
    /// Its maximum is that of the parabola through the point at this frequency and its neighbours.
    fn new(energy_j: ByEngine<Points>, middle: f64) -> Result<Self> {
        let largest = energy_j.as_ref().map(|points| peak(about(points, middle)?));
        Ok(Self {
            largest: largest.all()?,
            energy_j,
        })
    }

    /// Relative to the largest exact value.
    fn shares(&self) -> ByEngine<Points> {
        let (_, largest_j) = self.largest.exact;
        let shares = |points: &Points| points.iter().map(|(w, e)| (*w, e / largest_j)).collect();
        self.energy_j.as_ref().map(shares)
    }

    /// At a frequency (J).
    fn at(&self, omega: f64) -> ByEngine<Option<f64>> {
        let near = |point: &&(f64, f64)| (point.0 / omega - 1.0).abs() < 1e-9;
        let value = |points: &Points| points.iter().find(near).map(|point| point.1);
        self.energy_j.as_ref().map(value)
    }

    /// The same relative to the largest of each.
    fn share_at(&self, omega: f64) -> ByEngine<Option<f64>> {
        let pairs = self.at(omega).zip(self.largest);
        pairs.map(|(value, (_, largest))| Some(value? / largest))
    }
}

/// A curve with its name, cells per side and symbol.
type Labelled<'a> = (&'a str, &'a ByEngine<Points>, usize, Marker);

fn panels(curves: [Labelled<'_>; 2]) -> Vec<Chart> {
    let panel = |(low, high): (f64, f64), height_px: u32| {
        let series = |(place, (what, points, cells, marker)): (usize, Labelled<'_>)| {
            let line = Series::line(points.axisymmetric.clone()).style(LineStyle::nth(place));
            let symbols = Series::scatter(points.half_space.clone()).marker(marker);
            [
                line.color(place).label(format!("{what}, {SPRINGS}")),
                symbols
                    .color(place)
                    .label(format!("{what}, {}", cells_label(cells))),
            ]
        };
        Chart::new(
            Axis::linear("angular frequency ω / rad·s⁻¹").range(0.0, HIGHEST),
            Axis::linear("share of the largest").range(low, high),
        )
        .all_series(curves.into_iter().enumerate().flat_map(series))
        .mark(Mark::vertical(
            PAPER_PEAK,
            "0.0031 rad/s: maximum in the paper",
        ))
        .size(800, height_px)
    };
    vec![
        panel((0.0, 1.05), 560).legend(LegendPlace::Above),
        panel((0.9, 1.01), 440).legend(None),
    ]
}

fn claim(quantity: &str, values: ByEngine<Option<f64>>, accuracy: f64) -> Claim {
    let measure = Measure::relative(accuracy, accuracy);
    Claim::new(quantity, Source::Refined, values, measure)
}

fn claims_of_loops(loops: &Curve) -> Vec<Claim> {
    let micro = |value: Option<f64>| value.map(|joule| 1e6 * joule);
    vec![
        claim(
            "stabilised loop: ω of the largest loss / rad·s⁻¹",
            loops.largest.map(|point| Some(point.0)),
            0.02,
        )
        .note("the maximum of the area of the stabilised loop"),
        claim(
            "stabilised loop: largest loss / µJ, W₀ = 10 N, R = 10 mm",
            loops.largest.map(|point| micro(Some(point.1))),
            2e-3,
        ),
        claim(
            "stabilised loop: loss at the second maximum, 0.0757 rad/s / µJ",
            loops.at(0.0757).map(micro),
            2e-3,
        )
        .note("PMMA has two relaxation times, and the loss a second maximum"),
        claim(
            "stabilised loop: loss at 0.0031 rad/s, share of the largest",
            loops.share_at(PAPER_PEAK),
            2e-3,
        ),
        claim(
            "stabilised loop: loss at 0.3 rad/s, share of the largest",
            loops.share_at(HIGHEST),
            2e-3,
        )
        .note("the area of a closed loop vanishes with ω and with 1/ω: it has no asymptote above zero"),
    ]
}

fn claims_of_work(work: &Curve) -> Vec<Claim> {
    vec![
        claim(
            "work from first touch: ω of the largest / rad·s⁻¹",
            work.largest.map(|point| Some(point.0)),
            0.03,
        )
        .note("near the paper's maximum, not at it"),
        claim(
            "work from first touch: at 0.3 rad/s, share of the largest",
            work.share_at(HIGHEST),
            2e-3,
        )
        .note("the work from first touch holds the carrier step and the hold, which do not vanish"),
        claim(
            "work from first touch: at 0.001 rad/s, share of the largest",
            work.share_at(0.001),
            2e-3,
        ),
    ]
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
