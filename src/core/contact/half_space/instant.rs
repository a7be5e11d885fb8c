//! What an instant on cells is given, and when it counts as solved: shared by the engines of this module.

use std::f64::consts::PI;

use crate::contact::sums;
use crate::numerics::roots::bisect;
use crate::numerics::threads::in_pieces;

/// When the iteration stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverSettings {
    /// Largest allowed pressure-weighted mean |gap| inside the contact, and largest penetration outside, both relative to
    /// the pressure-weighted mean displacement that the instant's own pressure causes (or to a lower bound of it). Where that
    /// displacement is tiny beside what earlier pressures have left (a load about to vanish), rounding of the latter is allowed
    /// on top.
    pub tolerance: f64,
    /// Iterations after which an instant counts as not converged.
    pub max_iterations: usize,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            max_iterations: 2000,
        }
    }
}

/// What the drive imposes, in the engine's terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Imposed {
    /// Sum of the cells' pressures (Pa).
    PressureSum(f64),
    ApproachM(f64),
}

impl Imposed {
    pub(super) fn target_sum(self) -> Option<f64> {
        match self {
            Self::PressureSum(sum) => Some(sum),
            Self::ApproachM(_) => None,
        }
    }

    pub(super) fn approach_m(self) -> Option<f64> {
        match self {
            Self::PressureSum(_) => None,
            Self::ApproachM(approach_m) => Some(approach_m),
        }
    }
}

/// Rounding of a convolution and of the gaps made from it, as a part of the largest displacement: some units in the last
/// place.
pub(super) const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// A cell under pressure may stand off by this many times what the tolerance allows on average, no more: a tiny pressure hardly
/// weighs in the average, wherever it is, but it says that there is contact. Cells at the edge settle last and are that far off.
pub(super) const STANDING_OFF: f64 = 30.0;

/// The starting pressure: the guess made non-negative and scaled to the load, or, without a guess, the load spread evenly
/// over the indenter.
pub(super) fn start(target_sum: Option<f64>, gap_m: &[f64], pressure: &mut [f64]) {
    let cells = pressure.len();
    in_pieces(cells, (&mut *pressure, gap_m), |_, (pressure, gap_m)| {
        for (p, gap) in pressure.iter_mut().zip(gap_m) {
            *p = if gap.is_finite() { p.max(0.0) } else { 0.0 };
        }
    });
    let Some(target) = target_sum else { return };
    let sum = sums::sum(pressure);
    if sum > 0.0 {
        let scale = target / sum;
        in_pieces(cells, pressure, |_, pressure| {
            pressure.iter_mut().for_each(|p| *p *= scale);
        });
        return;
    }
    let count = gap_m.iter().filter(|g| g.is_finite()).count().max(1);
    let value = target / count as f64;
    for (p, gap) in pressure.iter_mut().zip(gap_m) {
        *p = if gap.is_finite() { value } else { 0.0 };
    }
}

/// A first guess of a pressure: Hertz' root of the depth below the edge of the contact, over the cells whose gap is less than that at the
/// edge. A load W on the area A lowers the edge of a disc by 3/8 C W sqrt(pi / A), half of the approach. `cell_m` is the root of the
/// area that a cell stands for; nothing is guessed where the approach leaves the gap open.
pub(super) fn hertz_guess(
    imposed: Imposed,
    gap_m: &[f64],
    compliance_per_pa: f64,
    cell_m: f64,
    pressure: &mut [f64],
) {
    let lowest_m = sums::least(gap_m);
    let cells_below = |edge_m: f64| gap_m.iter().filter(|gap| **gap < edge_m).count() as f64;
    // Depth of the edge under a pressure whose sum over the cells is 1 Pa, times the root of their number.
    let depth_m_per_pa = 0.375 * PI.sqrt() * compliance_per_pa * cell_m;
    let (edge_m, sum) = match imposed {
        Imposed::ApproachM(approach_m) => {
            let edge_m = 0.5 * (lowest_m + approach_m);
            let depth_m = (edge_m - lowest_m).max(0.0);
            (
                edge_m,
                depth_m * cells_below(edge_m).sqrt() / depth_m_per_pa,
            )
        }
        Imposed::PressureSum(sum) => {
            let depth_m = depth_m_per_pa * sum;
            let is_too_shallow =
                |edge_m: f64| (edge_m - lowest_m) * cells_below(edge_m).sqrt() < depth_m;
            let (_, edge_m) = bisect(lowest_m, lowest_m + depth_m, 20, is_too_shallow);
            (edge_m, sum)
        }
    };
    for (p, gap) in pressure.iter_mut().zip(gap_m) {
        *p = (edge_m - gap).max(0.0).sqrt();
    }
    let guessed = sums::sum(pressure);
    if guessed > 0.0 {
        pressure.iter_mut().for_each(|p| *p *= sum / guessed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::half_space::grid::Grid;
    use crate::reference::elastic::Hertz;

    #[test]
    fn under_a_sphere_the_guess_is_hertz_pressure_under_load_and_approach() {
        let hertz = Hertz {
            radius_m: 0.01,
            load_n: 10.0,
            compliance_per_pa: 4e-10,
        };
        let grid = Grid::square(128, hertz.contact_radius_m() / 50.0).unwrap();
        let places = (0..grid.cells()).map(|cell| grid.center(cell));
        let radii: Vec<f64> = places.map(|(x_m, y_m)| x_m.hypot(y_m)).collect();
        let gap_m: Vec<f64> = radii.iter().map(|r_m| 0.5 * r_m * r_m / 0.01).collect();
        let area_m2 = grid.cell_area_m2();
        let drives = [
            Imposed::PressureSum(hertz.load_n / area_m2),
            Imposed::ApproachM(hertz.approach_m()),
        ];
        for imposed in drives {
            let mut pressure = vec![0.0; grid.cells()];
            hertz_guess(
                imposed,
                &gap_m,
                hertz.compliance_per_pa,
                area_m2.sqrt(),
                &mut pressure,
            );
            let offs = radii.iter().zip(&pressure);
            let offs = offs.map(|(r_m, p)| (p - hertz.pressure_pa(*r_m)).abs());
            // The number of cells in a disc is that of its area to a part of a thousandth; the edge falls like a root.
            let worst = offs.fold(0.0, f64::max) / hertz.peak_pressure_pa();
            assert!(worst < 0.1, "{imposed:?}: {worst}");
            let load_n = area_m2 * sums::sum(&pressure);
            assert!((load_n / hertz.load_n - 1.0).abs() < 0.01, "{load_n}");
        }
    }

    #[test]
    fn nothing_is_guessed_of_an_indenter_that_stays_clear() {
        let mut pressure = [0.0; 3];
        hertz_guess(
            Imposed::ApproachM(0.5),
            &[2.0, 1.0, f64::INFINITY],
            1.0,
            1.0,
            &mut pressure,
        );
        assert_eq!(pressure, [0.0; 3]);
    }
}
