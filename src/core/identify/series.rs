//! A Prony series as a point: the logarithms of the equilibrium modulus, then of modulus and time of every branch.

use num_complex::Complex;

use crate::identify::CLOSEST;
use crate::material::{MaterialError, Relaxation, RelaxationBranch};

/// How strongly times are kept apart, in standard deviations for a factor of e; and how far that yields to data.
const STIFFNESS: f64 = 100.0;
const YIELDING: f64 = 0.1;

/// Logarithms (Pa, s): of the equilibrium modulus, and of modulus and time of branches.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Point(pub(super) Vec<f64>);

impl From<Vec<f64>> for Point {
    fn from(logarithms: Vec<f64>) -> Self {
        Self(logarithms)
    }
}

impl AsRef<[f64]> for Point {
    fn as_ref(&self) -> &[f64] {
        &self.0
    }
}

/// How far unknowns may go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    /// Of logarithms of moduli (Pa) and of times (s).
    pub(super) moduli: (f64, f64),
    pub(super) times: (f64, f64),
}

impl Limits {
    /// Nearest allowed value of an unknown.
    pub(super) fn clamp(&self, place: usize, value: f64) -> f64 {
        let (low, high) = match is_time(place) {
            true => self.times,
            false => self.moduli,
        };
        value.clamp(low, high)
    }
}

/// Whether the unknown in this place is a time.
pub(super) fn is_time(place: usize) -> bool {
    place > 0 && place.is_multiple_of(2)
}

/// "g_inf", "g_1", "tau_1".
pub(super) fn name(place: usize) -> String {
    match (place, is_time(place)) {
        (0, _) => "g_inf".to_owned(),
        (_, true) => format!("tau_{}", place / 2),
        (_, false) => format!("g_{}", place.div_ceil(2)),
    }
}

impl Point {
    /// The same with one unknown moved.
    pub(super) fn moved(&self, place: usize, step: f64) -> Self {
        let mut moved = self.clone();
        moved.0[place] += step;
        moved
    }

    /// Modulus and time of every branch.
    fn pairs(&self) -> std::slice::ChunksExact<'_, f64> {
        self.0.get(1..).unwrap_or_default().chunks_exact(2)
    }

    pub(super) fn branches(&self) -> usize {
        self.0.len() / 2
    }

    pub(super) fn equilibrium_pa(&self) -> f64 {
        self.0.first().map_or(0.0, |ln| ln.exp())
    }

    /// The complex modulus (Pa).
    pub(super) fn complex_modulus(&self, angular_frequency_rad_per_s: f64) -> Complex<f64> {
        let ln_omega = angular_frequency_rad_per_s.ln();
        let start = Complex::new(self.equilibrium_pa(), 0.0);
        self.pairs().fold(start, |sum, branch| {
            let x = (ln_omega + branch[1]).exp();
            let frozen = match x > 1.0 {
                true => 1.0 / (1.0 + 1.0 / (x * x)),
                false => x * x * (1.0 / (1.0 + x * x)),
            };
            let loss = 1.0 / (x + 1.0 / x);
            sum + Complex::new(frozen, loss) * branch[0].exp()
        })
    }

    /// The same with one branch more, shortest time first.
    pub(super) fn with(&self, ln_modulus: f64, ln_time: f64) -> Self {
        let mut point = self.clone();
        point.0.extend([ln_modulus, ln_time]);
        point.sorted()
    }

    /// Branches in the order of their times.
    pub(super) fn sorted(mut self) -> Self {
        let mut branches: Vec<[f64; 2]> = self.pairs().map(|b| [b[0], b[1]]).collect();
        branches.sort_by(|a, b| a[1].total_cmp(&b[1]));
        self.0.truncate(1);
        self.0.extend(branches.into_iter().flatten());
        self
    }

    /// Gaps between the logarithms of neighbouring times.
    fn gaps(&self) -> Vec<f64> {
        let mut times: Vec<f64> = self.pairs().map(|branch| branch[1]).collect();
        times.sort_by(f64::total_cmp);
        times.windows(2).map(|pair| pair[1] - pair[0]).collect()
    }

    /// Whether two times are one.
    pub(super) fn has_close_times(&self) -> bool {
        self.gaps().iter().any(|gap| *gap < CLOSEST.ln() - YIELDING)
    }

    /// Residuals that keep times apart: nothing where they are, and one in every gap between neighbours.
    pub(super) fn kept_apart(&self) -> Vec<f64> {
        let lack = |gap: f64| (CLOSEST.ln() - gap).max(0.0);
        let gaps = self.gaps().into_iter();
        gaps.map(|gap| STIFFNESS * lack(gap)).collect()
    }

    /// A series; where nothing later than some time (s) matters, with a spring in place of what relaxes much later.
    pub(super) fn of(series: &Relaxation, longest_s: Option<f64>) -> Self {
        const LATE: f64 = 1e4;
        let latest_s = longest_s.map_or(f64::INFINITY, |longest_s| LATE * longest_s);
        let is_late = |branch: &&RelaxationBranch| branch.time_s > latest_s;
        let branches = series.branches().iter();
        let springs = branches.clone().filter(is_late).map(|b| b.modulus_pa);
        let equilibrium_pa = series.equilibrium_modulus() + springs.sum::<f64>();
        let others = branches.filter(|branch| !is_late(branch));
        let others = others.flat_map(|b| [b.modulus_pa.ln(), b.time_s.ln()]);
        let equilibrium = equilibrium_pa.max(f64::MIN_POSITIVE).ln();
        Self([equilibrium].into_iter().chain(others).collect())
    }

    /// Moduli (Pa) and times (s) of the branches.
    pub(super) fn branches_pa_s(&self) -> Vec<(f64, f64)> {
        self.pairs().map(|b| (b[0].exp(), b[1].exp())).collect()
    }

    pub(super) fn relaxation(&self) -> Result<Relaxation, MaterialError> {
        let branches = self.branches_pa_s().into_iter();
        let branches = branches.map(|(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s });
        Relaxation::new(self.equilibrium_pa(), branches.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_the_series_that_it_stands_for() {
        let point =
            Point(vec![1e6_f64.ln(), 3e8_f64.ln(), 10_f64.ln()]).with(5e7_f64.ln(), 1e-3_f64.ln());
        let series = point.relaxation().unwrap();
        assert_eq!(point.branches(), 2);
        assert!((series.branches()[0].time_s / 1e-3 - 1.0).abs() < 1e-12);
        for omega in [1e-8, 0.1, 30.0, 1e12] {
            let difference = point.complex_modulus(omega) - series.complex_modulus(omega);
            assert!(difference.norm() < 1e-12 * series.complex_modulus(omega).norm());
        }
        assert!(!point.has_close_times() && point.with(1.0, 11_f64.ln()).has_close_times());
        assert_eq!([0, 1, 2, 3].map(name), ["g_inf", "g_1", "tau_1", "g_2"]);
    }
}
