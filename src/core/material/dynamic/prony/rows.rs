//! The least squares problem of a series through storage and loss modulus: rows in units of the noise, columns per branch time.

use nalgebra::DVector;

use super::PronyFit;
use crate::material::dynamic::DynamicPoint;
use crate::material::harmonic::Debye;
use crate::material::spectrum::{Branch, Linear, Series};
use crate::numerics::grid;
use crate::numerics::nnls::NnlsError;

/// Least relative noise: smaller misfits count as none, however clean the data are.
pub(super) const NOTICEABLE: f64 = 1e-4;

/// Times per decade of the spectrum that says what the data determine, and most times in any grid.
pub(super) const SPECTRUM: f64 = 10.0;
const MOST_TIMES: usize = 600;

/// Degrees of freedom that the noise of both moduli together lends to each of them, so that a few points of one that are met
/// exactly do not count as free of noise.
const LENT: f64 = 2.0;

/// Largest correction of the size of a point by the spectrum.
const CORRECTION: f64 = 3.0;

/// Storage and loss modulus of one point, or anything else that both have.
pub(super) type Both = [f64; 2];

/// Which moduli take part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Part {
    Storage,
    Loss,
    Both,
}

/// Whether every point has errors, by which it can be weighted.
pub(in crate::material::dynamic) fn errors_known<'a>(
    mut points: impl Iterator<Item = &'a DynamicPoint>,
) -> bool {
    let usable = |error: f64| error.is_finite() && error > 0.0;
    points.all(|p| matches!(p.errors_pa, Some((a, b)) if usable(a) && usable(b)))
}

/// Points in units of a reference modulus, and their noise.
#[derive(Debug, Clone)]
pub(in crate::material::dynamic) struct Rows {
    pub(super) omegas: Vec<f64>,
    pub(super) values: Vec<Both>,
    /// Standard deviations, in the same units.
    pub(super) deviations: Vec<Both>,
    /// The part of them that does not depend on the fit: relative errors as the file gives them, or one.
    relative: Vec<Both>,
    /// What those are multiplied by: relative noise, or how much larger it is than the file says.
    pub(super) noise: Both,
    /// Pa.
    pub(super) reference_pa: f64,
    pub(super) part: Part,
}

impl Rows {
    /// The rows of points, their noise not known yet: as large for both moduli.
    pub(super) fn new(points: &[DynamicPoint]) -> Self {
        let logarithms = points.iter().map(|p| p.storage_modulus_pa.ln());
        let reference_pa = (logarithms.sum::<f64>() / points.len().max(1) as f64).exp();
        let value = |p: &DynamicPoint| {
            [p.storage_modulus_pa, p.loss_modulus_pa].map(|modulus_pa| modulus_pa / reference_pa)
        };
        let errors_known = errors_known(points.iter());
        let relative = |p: &DynamicPoint| match p.errors_pa {
            Some((storage, loss)) if errors_known => {
                [storage / p.storage_modulus_pa, loss / p.loss_modulus_pa]
            }
            _ => [1.0; 2],
        };
        let mut rows = Self {
            omegas: points
                .iter()
                .map(|p| p.angular_frequency_rad_per_s)
                .collect(),
            values: points.iter().map(value).collect(),
            deviations: Vec::new(),
            relative: points.iter().map(relative).collect(),
            noise: [1.0; 2],
            reference_pa,
            part: Part::Both,
        };
        rows.set_deviations(&rows.values.clone());
        rows
    }

    /// The rows of points that are much like those of a fit, with its noise.
    pub(super) fn like(points: &[DynamicPoint], fit: &PronyFit) -> Self {
        let mut rows = Self::new(points);
        let sizes = rows.omegas.iter().map(|&omega| {
            let modulus = fit.relaxation.complex_modulus(omega) / rows.reference_pa;
            [modulus.re, modulus.im]
        });
        let sizes: Vec<Both> = sizes.collect();
        rows.noise = fit.noise.into();
        rows.set_deviations(&sizes);
        rows
    }

    /// Both moduli at the lowest frequency; nothing where there are no points.
    pub(super) fn lowest(&self) -> Both {
        let both = self.omegas.iter().zip(&self.values);
        let lowest = both.min_by(|left, right| left.0.total_cmp(right.0));
        lowest.map_or([0.0; 2], |(_, values)| *values)
    }

    /// Deviations proportional to these moduli.
    fn set_deviations(&mut self, sizes: &[Both]) {
        let size = |size: f64, value: f64| size.clamp(value / CORRECTION, value * CORRECTION);
        let rows = sizes.iter().zip(&self.values).zip(&self.relative);
        let deviations = rows.map(|((sizes, values), relative)| {
            let part = |part| self.noise[part] * relative[part] * size(sizes[part], values[part]);
            [0, 1].map(part)
        });
        self.deviations = deviations.collect();
    }

    /// The same with the noise that is left of the best spectrum, relative to this spectrum: relative to the data themselves,
    /// values that happen to be low would weigh the more.
    pub(super) fn with_noise_from(&self, spectrum: &Series) -> Self {
        let mut rows = self.clone();
        let fitted: Vec<Both> = self.omegas.iter().map(|&w| moduli(spectrum, w)).collect();
        rows.noise = [1.0; 2];
        rows.set_deviations(&fitted);
        rows.noise = rows.noise_beside(spectrum, self.leverage(spectrum));
        rows.set_deviations(&fitted);
        rows
    }

    /// Each modulus has the degrees of freedom that the spectrum leaves it: its points less their leverage in the least squares
    /// problem of the moduli in use, of which the loss modulus takes the most.
    fn noise_beside(&self, spectrum: &Series, leverage: Both) -> Both {
        let squares = self.squares(spectrum);
        let points = self.omegas.len() as f64;
        let free = |leverage: f64| (points - leverage).max(1.0);
        let pooled = (squares[0] + squares[1]) / free(leverage[0] + leverage[1] - points);
        [0, 1].map(|part| {
            let variance = (squares[part] + LENT * pooled) / (free(leverage[part]) + LENT);
            variance.sqrt().max(self.least_noise())
        })
    }

    /// Traces of the parts of the projection on the columns in use that belong to storage and loss modulus.
    fn leverage(&self, spectrum: &Series) -> Both {
        let linear = self.linear(spectrum.constant > 0.0);
        let matrix = linear.matrix(&spectrum.times_s());
        if matrix.ncols() == 0 || matrix.ncols() > matrix.nrows() {
            return [0.0; 2];
        }
        let orthonormal = matrix.qr().q();
        let points = self.omegas.len();
        [0, points].map(|first| orthonormal.rows(first, points).norm_squared())
    }

    /// The same with the noise that spectra of storage and loss modulus alone leave; `None` where one of them has fewer degrees
    /// of freedom than this left.
    pub(super) fn with_noise_of_each(&self, alone: &[Series; 2], fewest: usize) -> Option<Self> {
        let mut rows = self.clone();
        let size = |omega: &f64| [0, 1].map(|part| moduli(&alone[part], *omega)[part]);
        let sizes: Vec<Both> = self.omegas.iter().map(size).collect();
        rows.set_deviations(&sizes);
        for (part, spectrum) in alone.iter().enumerate() {
            let free = self.omegas.len().checked_sub(spectrum.strengths())?;
            if free < fewest {
                return None;
            }
            let variance = rows.squares(spectrum)[part] / free as f64;
            rows.noise[part] = variance.sqrt().max(self.least_noise());
        }
        rows.set_deviations(&sizes);
        Some(rows)
    }

    /// The least noise that is reckoned with, as a multiple of the relative errors.
    fn least_noise(&self) -> f64 {
        let least = self.relative.iter().map(|r| r[0].min(r[1]));
        NOTICEABLE / least.fold(f64::INFINITY, f64::min)
    }

    /// The same with one modulus alone.
    pub(super) fn only(&self, part: Part) -> Self {
        Self {
            part,
            ..self.clone()
        }
    }

    /// Number of values that take part.
    pub(super) fn count(&self) -> usize {
        match self.part {
            Part::Both => 2 * self.omegas.len(),
            Part::Storage | Part::Loss => self.omegas.len(),
        }
    }

    /// Lowest and highest angular frequency.
    pub(super) fn window(&self) -> (f64, f64) {
        let least = self.omegas.iter().copied().fold(f64::INFINITY, f64::min);
        (least, self.omegas.iter().copied().fold(0.0, f64::max))
    }

    /// Sums of squares of both moduli, in units of the variance of the noise.
    pub(super) fn squares(&self, series: &Series) -> Both {
        let mut sums = [0.0; 2];
        for (index, &omega) in self.omegas.iter().enumerate() {
            let (moduli, values) = (moduli(series, omega), self.values[index]);
            let deviations = self.deviations[index];
            for part in 0..2 {
                sums[part] += ((moduli[part] - values[part]) / deviations[part]).powi(2);
            }
        }
        sums
    }

    /// The sum over the moduli that take part.
    pub(super) fn chi_squared(&self, series: &Series) -> f64 {
        let [storage, loss] = self.squares(series);
        match self.part {
            Part::Both => storage + loss,
            Part::Storage => storage,
            Part::Loss => loss,
        }
    }

    /// Times evenly spaced in their logarithm, this many per decade, the limits among them.
    pub(super) fn grid((shortest, longest): (f64, f64), per_decade: f64) -> Vec<f64> {
        grid::logarithmic(shortest, longest, per_decade, MOST_TIMES)
    }

    /// A first guess of a series of this many branches, evenly spaced: each has the loss modulus next to one over its time.
    pub(super) fn guess(&self, branches: usize, limits_s: (f64, f64), constant: f64) -> Series {
        let loss = |time_s: f64| {
            let distance = |omega: f64| (omega * time_s).ln().abs();
            let both = self.omegas.iter().zip(&self.values);
            let nearest = both.min_by(|l, r| distance(*l.0).total_cmp(&distance(*r.0)));
            nearest.map_or(0.0, |(_, values)| values[1])
        };
        // In the middle of as many equal parts.
        let times = grid::in_steps(limits_s.0, limits_s.1, 2 * branches);
        let branch = |&time_s: &f64| Branch {
            strength: loss(time_s),
            time_s,
        };
        Series {
            constant,
            branches: times.iter().skip(1).step_by(2).map(branch).collect(),
            flow_per_s: 0.0,
        }
    }

    /// The linear problem of the moduli that take part, those of storage first; with an equilibrium modulus where one is allowed.
    pub(in crate::material::dynamic) fn linear(&self, has_constant: bool) -> Linear<'_> {
        let parts = match self.part {
            Part::Both => 0..2,
            Part::Storage => 0..1,
            Part::Loss => 1..2,
        };
        let rows = parts.flat_map(|part| (0..self.omegas.len()).map(move |point| (point, part)));
        let rows: Vec<(usize, usize)> = rows.collect();
        let deviations = rows
            .iter()
            .map(|&(point, part)| self.deviations[point][part]);
        let scales: Vec<f64> = deviations.map(f64::recip).collect();
        let scaled = |value: &dyn Fn(usize, usize) -> f64| {
            let values = rows.iter().zip(&scales);
            let values = values.map(|(&(point, part), scale)| value(point, part) * scale);
            DVector::from_iterator(rows.len(), values)
        };
        Linear {
            values: scaled(&|point, part| self.values[point][part]),
            constant: scaled(&|_, part| if part == 0 { 1.0 } else { 0.0 }),
            flow: None,
            has_constant,
            scales,
            basis: Box::new(move |row, time_s| {
                let (point, part) = rows[row];
                let debye = Debye::at(self.omegas[point] * time_s);
                match part {
                    0 => [debye.frozen, debye.frozen_slope()],
                    _ => [debye.loss, debye.loss_slope()],
                }
            }),
        }
    }

    /// The best moduli at these times, none negative; with an equilibrium modulus where one is allowed, and `held` as part of
    /// it in any case.
    pub(in crate::material::dynamic) fn strengths(
        &self,
        times_s: &[f64],
        (free, held): (bool, f64),
    ) -> Result<Series, NnlsError> {
        self.linear(free).strengths(times_s, held)
    }
}

/// Storage and loss modulus of a series.
fn moduli(series: &Series, omega: f64) -> Both {
    let start = [series.constant, 0.0];
    series
        .branches
        .iter()
        .fold(start, |[storage, loss], branch| {
            let (modulus, debye) = (branch.strength, Debye::at(omega * branch.time_s));
            [
                storage + modulus * debye.frozen,
                loss + modulus * debye.loss,
            ]
        })
}
