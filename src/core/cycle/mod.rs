//! One cycle as signals: loop area, phase, harmonics, equivalent moduli, extrema, and how far it is from the stabilised cycle.
//!
//! Knows sampled signals only, so that a measured loop is analysed by the same code as a computed one. Conventions: a loop
//! holds N + 1 uniform samples of one period, both ends included; the energy loss is the closed integral of W d(delta),
//! positive where the approach lags behind the load.
//!
//! ```
//! use std::f64::consts::{PI, TAU};
//!
//! # extern crate contact_dma_core as contact_dma;
//! use contact_dma::cycle::{LoopError, analyse};
//!
//! let angles = (0..=100).map(|i| TAU * f64::from(i) / 100.0);
//! let load_n: Vec<f64> = angles.clone().map(|a| 10.0 + 5.0 * a.sin()).collect();
//! let approach_m: Vec<f64> = angles.map(|a| 1e-5 + 2e-6 * (a - 0.1).sin()).collect();
//! let analysis = analyse(&load_n, &approach_m)?;
//! assert!((analysis.phase_lag_rad - 0.1).abs() < 1e-12);
//! // An ellipse: pi times both amplitudes and the sine of the lag.
//! assert!((analysis.energy_loss_j / (PI * 5.0 * 2e-6 * 0.1_f64.sin()) - 1.0).abs() < 1e-12);
//! # Ok::<(), LoopError>(())
//! ```

mod analysis;
mod stabilisation;

pub(crate) use analysis::work_along;
pub use analysis::{Harmonic, Harmonics, LoopAnalysis, LoopError, analyse, analyse_open};
pub use stabilisation::closure_error;

/// One cycle of a contact, sampled uniformly, first and last sample one period apart.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Loop {
    /// Time since the cycle began (s).
    pub time_s: Vec<f64>,
    /// Normal load W (N).
    pub load_n: Vec<f64>,
    /// Approach delta (m).
    pub approach_m: Vec<f64>,
    /// Contact radius (m).
    pub contact_radius_m: Vec<f64>,
    /// Peak pressure (Pa), `None` where it is unbounded.
    pub peak_pressure_pa: Vec<Option<f64>>,
}

/// Smallest and largest value of a signal.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Extrema {
    pub minimum: f64,
    pub maximum: f64,
}

impl Extrema {
    /// Extrema of the uniform samples of a smooth and closed cycle, each refined by the parabola through the extreme sample and its
    /// neighbours, since the true extremum lies between samples. `None` for an empty signal.
    pub fn of(samples: &[f64]) -> Option<Self> {
        let (extrema, _) = Smoothness::THROUGHOUT.extrema(samples)?;
        Some(extrema)
    }
}

/// Where the signals of a cycle are smooth, so that a parabola through three samples tells what lies between them.
#[derive(Debug, Clone, Copy)]
pub struct Smoothness<'a> {
    /// Whether the cycle ends where it began.
    pub is_closed: bool,
    /// The load (N) at each sample, where the signals have kinks at which it leaves zero and comes back to it.
    pub kinks_of_load_n: Option<&'a [f64]>,
}

impl Smoothness<'_> {
    /// Of a cycle without a kink or an end.
    pub const THROUGHOUT: Self = Self {
        is_closed: true,
        kinks_of_load_n: None,
    };

    /// Extrema of the samples of a signal, and by how much the true ones may lie beyond these: where a signal is not smooth an extremum
    /// is the sample itself. `None` for an empty signal.
    pub fn extrema(&self, samples: &[f64]) -> Option<(Extrema, Extrema)> {
        let index_of = |better: fn(&f64, &f64) -> bool| {
            let best = samples.iter().enumerate();
            best.reduce(|best, next| if better(next.1, best.1) { next } else { best })
        };
        let (least, _) = index_of(|a, b| a < b)?;
        let (greatest, _) = index_of(|a, b| a > b)?;
        let at = |i: usize, rest: &dyn Fn(usize) -> f64| match self.is_smooth(samples.len(), i) {
            true => (refined(samples, i), 0.0),
            false => (samples[i], rest(i)),
        };
        let (minimum, below) = at(least, &|i| self.rest_below(samples, i));
        let (maximum, above) = at(greatest, &|i| {
            self.largest_step(samples, i, 1, false).unwrap_or(0.0)
        });
        let (extrema, rest) = ((minimum, maximum), (below, above));
        let [extrema, rest] =
            [extrema, rest].map(|(minimum, maximum)| Extrema { minimum, maximum });
        Some((extrema, rest))
    }

    /// By how much the amplitude of a harmonic of a signal may be wrong because kinks lie between its samples.
    ///
    /// A slope that jumps by s leaves up to s h^2/12 in the sum of a period's samples times the step h (Euler and Maclaurin), and an
    /// amplitude is twice that sum over the period. The second differences at both ends of the step of a kink add up to s h.
    pub fn harmonic_error(&self, samples: &[f64]) -> f64 {
        let Some(load_n) = self.kinks_of_load_n else {
            return 0.0;
        };
        let n = samples.len().saturating_sub(1).max(1);
        let second =
            |i: usize| samples[(i + n - 1) % n] - 2.0 * samples[i % n] + samples[(i + 1) % n];
        let is_kink = |i: &usize| (load_n[*i] > 0.0) != (load_n[(i + 1) % n] > 0.0);
        let jumps = (0..n)
            .filter(is_kink)
            .map(|i| (second(i) + second(i + 1)).abs());
        jumps.sum::<f64>() / (6.0 * n as f64)
    }

    /// Whether a signal is smooth from the sample before `i` to the one after it.
    fn is_smooth(&self, samples: usize, i: usize) -> bool {
        let n = samples.saturating_sub(1).max(1);
        if !self.is_closed && (i == 0 || i == n) {
            return false;
        }
        self.kinks_of_load_n.is_none_or(|load_n| {
            let touches = [i + n - 1, i, i + 1].map(|i| load_n[i % n] > 0.0);
            touches[0] == touches[1] && touches[1] == touches[2]
        })
    }

    /// By how much a signal may fall below its least sample `i`. Out of contact the surface recovers ever more slowly until it is
    /// touched again: by no more than in the last whole step before.
    fn rest_below(&self, samples: &[f64], i: usize) -> f64 {
        let free = self.largest_step(samples, i, 2, true);
        free.or_else(|| self.largest_step(samples, i, 1, false))
            .unwrap_or(0.0)
    }

    /// The largest difference between neighbours of at most `reach` steps from `i`, of those out of contact alone or of all. `None` where
    /// there is none, as beyond the end of an open cycle, which is itself the extremum.
    fn largest_step(
        &self,
        samples: &[f64],
        i: usize,
        reach: usize,
        only_free: bool,
    ) -> Option<f64> {
        let load_n = self.kinks_of_load_n?;
        let n = samples.len().saturating_sub(1).max(1);
        let is_free = |i: usize| load_n[i] <= 0.0;
        let starts = (0..2 * reach).map(|k| (i + reach * n + k - reach) % n);
        let steps = starts.map(|start| (start, start + 1));
        let steps = steps.filter(|(a, b)| !only_free || (is_free(*a) && is_free(*b)));
        let differences = steps.map(|(a, b)| (samples[b] - samples[a]).abs());
        differences.reduce(f64::max)
    }
}

/// The part of a cycle in which the indenter touches the surface.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContactDuty {
    pub part: f64,
    /// By how much it may be wrong: contact that comes or goes between two samples is taken to do so halfway.
    pub error: f64,
}

impl ContactDuty {
    /// Touching all the time.
    pub const WHOLE: Self = Self {
        part: 1.0,
        error: 0.0,
    };

    /// Steps of a cycle in contact.
    pub fn steps(self, of_cycle: usize) -> f64 {
        self.part * of_cycle as f64
    }

    /// Of uniform samples of the load of one period, both ends included; `None` without a whole step.
    pub fn of(load_n: &[f64]) -> Option<Self> {
        let steps = load_n.len().checked_sub(1).filter(|steps| *steps > 0)? as f64;
        let (mut touching, mut crossings) = (0.0, 0.0);
        for step in load_n.windows(2) {
            let ends = step.iter().filter(|load| **load > 0.0).count();
            touching += 0.5 * ends as f64;
            crossings += f64::from(u8::from(ends == 1));
        }
        Some(Self {
            part: touching / steps,
            error: 0.5 * crossings / steps,
        })
    }
}

/// Vertex of the parabola through sample `i` and its neighbours on a closed loop whose last sample repeats the first.
fn refined(samples: &[f64], i: usize) -> f64 {
    let n = samples.len().saturating_sub(1);
    let here = samples[i];
    if n < 3 {
        return here;
    }
    let (before, after) = (samples[(i + n - 1) % n], samples[(i + 1) % n]);
    let curvature = before - 2.0 * here + after;
    let slope = 0.5 * (after - before);
    // At an extreme sample the vertex lies within half a step; elsewhere (a kink, a flat top) the sample itself stands.
    if curvature != 0.0 && (slope / curvature).abs() <= 0.5 {
        here - 0.5 * slope * slope / curvature
    } else {
        here
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extrema_between_samples_are_found_to_fourth_order_in_the_step() {
        let error = |n: usize| {
            let samples: Vec<f64> = (0..=n)
                .map(|i| (std::f64::consts::TAU * (i as f64 + 0.3) / n as f64).sin())
                .collect();
            let extrema = Extrema::of(&samples).unwrap();
            (extrema.maximum - 1.0)
                .abs()
                .max((extrema.minimum + 1.0).abs())
        };
        let order = (error(64) / error(128)).log2();
        assert!((order - 4.0).abs() < 0.1, "order {order}");
    }

    #[test]
    fn no_parabola_is_laid_through_a_kink_or_across_the_seam_of_an_open_cycle() {
        // A surface that recovers while the load is zero, and is touched again between two samples.
        let (steps, touch) = (40, 0.8137);
        for phase in [0.0, 0.13, 0.29, 0.5, 0.81] {
            let load = |t: f64| {
                if t > touch {
                    (t - touch) * 10.0
                } else {
                    (0.3 - t).max(0.0)
                }
            };
            let signal = |t: f64| match t > touch {
                true => (-touch / 0.4_f64).exp() + 3.0 * (t - touch),
                false => (-t / 0.4).exp(),
            };
            let at = |i: usize| (i as f64 / steps as f64 + phase).fract();
            let load_n: Vec<f64> = (0..=steps).map(|i| load(at(i))).collect();
            let samples: Vec<f64> = (0..=steps).map(|i| signal(at(i))).collect();
            let smooth = Smoothness {
                is_closed: true,
                kinks_of_load_n: Some(&load_n),
            };
            let (extrema, rest) = smooth.extrema(&samples).unwrap();
            let least = samples.iter().copied().fold(f64::INFINITY, f64::min);
            assert_eq!(extrema.minimum, least);
            let exact = signal(touch);
            assert!(
                (least - rest.minimum..=least).contains(&exact),
                "{phase}: {exact} {least} {rest:?}"
            );
            assert!(rest.minimum < 0.05 * extrema.maximum);
        }
        // A drift: both extrema are ends, and an end is exact.
        let drift: Vec<f64> = (0..=steps)
            .map(|i| (i as f64 / steps as f64).powi(2))
            .collect();
        let open = Smoothness {
            is_closed: false,
            kinks_of_load_n: None,
        };
        let (extrema, rest) = open.extrema(&drift).unwrap();
        assert_eq!((extrema.minimum, extrema.maximum), (0.0, 1.0));
        assert_eq!((rest.minimum, rest.maximum), (0.0, 0.0));
    }

    #[test]
    fn what_samples_miss_of_a_harmonic_of_a_kinked_signal_lies_within_its_error() {
        // A sine that is cut off at zero: a0 + a1 sin + ..., by Fourier's integrals in many steps.
        let amplitudes = |steps: usize, phase: f64| {
            let load = |i: usize| (0.2 + (angle(i, steps) + phase).sin()).max(0.0);
            let load_n: Vec<f64> = (0..=steps).map(load).collect();
            let approach_m: Vec<f64> = load_n.iter().map(|load| load.powf(0.8)).collect();
            let smooth = Smoothness {
                is_closed: true,
                kinks_of_load_n: Some(&load_n),
            };
            let error = smooth.harmonic_error(&load_n);
            let analysis = analyse(&load_n, &approach_m).unwrap();
            let amplitudes = [0, 1, 2].map(|n| analysis.harmonics[n].load_amplitude_n);
            (amplitudes, error)
        };
        let (exact, _) = amplitudes(6000, 0.0);
        let mut largest = 0.0_f64;
        for k in 0..30 {
            let (found, error) = amplitudes(60, 0.007 * f64::from(k));
            for (found, exact) in found.into_iter().zip(exact) {
                let off = (found - exact).abs();
                assert!(off < 1.05 * error, "{k}: {off} {error}");
                largest = largest.max(off / error);
            }
        }
        assert!(largest > 0.5, "{largest}");
    }

    #[test]
    fn contact_that_comes_and_goes_between_samples_lasts_so_long_but_for_half_a_step_each() {
        let steps = 50;
        for cut in [-0.9, -0.3, 0.0, 0.21, 0.77] {
            let load = |i: usize| ((angle(i, steps)).sin() - cut).max(0.0);
            let duty = ContactDuty::of(&(0..=steps).map(load).collect::<Vec<_>>()).unwrap();
            let exact = 0.5 - f64::asin(cut) / std::f64::consts::PI;
            assert_eq!(duty.error, 1.0 / steps as f64);
            assert!((duty.part - exact).abs() <= duty.error, "{duty:?} {exact}");
        }
        assert_eq!(ContactDuty::of(&[1.0; 9]), Some(ContactDuty::WHOLE));
        assert_eq!(ContactDuty::of(&[1.0]), None);
    }

    fn angle(i: usize, n: usize) -> f64 {
        std::f64::consts::TAU * i as f64 / n as f64
    }

    #[test]
    fn extrema_at_the_seam_of_the_loop_look_across_it() {
        let samples: Vec<f64> = (0..=100)
            .map(|i| (std::f64::consts::TAU * (i as f64 / 100.0 + 0.003)).cos())
            .collect();
        let extrema = Extrema::of(&samples).unwrap();
        assert!((extrema.maximum - 1.0).abs() < 1e-6);
        assert_eq!(Extrema::of(&[]), None);
    }
}
