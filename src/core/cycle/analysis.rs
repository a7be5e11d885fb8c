//! What a hysteresis loop says: energy loss by two routes, phase lag, harmonics, equivalent complex modulus.

use contact_dma_transforms::Precision as _;
use std::f64::consts::{PI, TAU};

use num_complex::Complex;

/// Why a loop cannot be analysed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LoopError {
    #[error(
        "a loop needs at least {needed} samples per period to show its harmonics; this one has {samples}"
    )]
    TooFewSamples { samples: usize, needed: usize },
    #[error("load and approach have {loads} and {approaches} samples; they must have as many")]
    Lengths { loads: usize, approaches: usize },
    #[error("sample {index} of the {signal} is {value}, not a finite number")]
    NotFinite {
        signal: &'static str,
        index: usize,
        value: f64,
    },
    #[error("the {signal} does not oscillate: a phase and a modulus are undefined")]
    Constant { signal: &'static str },
    #[error("the transform of the loop failed: {0}")]
    Transform(String),
}

/// A cycle of load and approach as means and harmonics, the first first: harmonic n of a signal is |a_n| sin(n omega t + arg a_n).
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Harmonics {
    pub load_mean_n: f64,
    pub approach_mean_m: f64,
    pub load_n: Vec<Complex<f64>>,
    pub approach_m: Vec<Complex<f64>>,
}

/// Amplitude and phase of one harmonic: value sin(n omega t + phase).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Harmonic {
    pub load_amplitude_n: f64,
    pub load_phase_rad: f64,
    pub approach_amplitude_m: f64,
    pub approach_phase_rad: f64,
}

/// A loop's numbers.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LoopAnalysis {
    /// Energy loss per cycle (J): pi * sum of n W_n delta_n sin(phase of W_n less phase of delta_n).
    pub energy_loss_j: f64,
    /// The same from the polygon through the samples (J), which is low by (N / 2 pi) sin(2 pi / N) for a smooth loop.
    pub polygon_loss_j: f64,
    /// Lag of the approach behind the load, first harmonic (rad).
    pub phase_lag_rad: f64,
    /// Mean load (N) and mean approach (m) over the cycle.
    pub load_mean_n: f64,
    pub approach_mean_m: f64,
    /// Harmonics 1 to 5, as far as the samples resolve them.
    pub harmonics: Vec<Harmonic>,
}

/// Number of harmonics reported.
const HARMONICS: usize = 5;

/// Analyses one period, N + 1 uniform samples of load (N) and approach (m), both ends included.
///
/// The two end samples stand for one instant of the period and are averaged.
///
/// # Errors
/// [`LoopError`] for loops that are too short, not finite or constant.
pub fn analyse(load_n: &[f64], approach_m: &[f64]) -> Result<LoopAnalysis, LoopError> {
    check(load_n, approach_m)?;
    let cycle = Harmonics::of(load_n, approach_m)?;
    for (signal, values, harmonics) in [
        ("load", load_n, &cycle.load_n),
        ("approach", approach_m, &cycle.approach_m),
    ] {
        let scale = values.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
        // A first harmonic at the level of rounding carries no phase.
        if harmonics[0].norm() <= 1e-13 * scale {
            return Err(LoopError::Constant { signal });
        }
    }
    let harmonic = |(w, d): (&Complex<f64>, &Complex<f64>)| Harmonic {
        load_amplitude_n: w.norm(),
        load_phase_rad: w.arg(),
        approach_amplitude_m: d.norm(),
        approach_phase_rad: d.arg(),
    };
    let pairs = cycle.load_n.iter().zip(&cycle.approach_m);
    Ok(LoopAnalysis {
        energy_loss_j: cycle.energy_loss_j(),
        polygon_loss_j: polygon_area(load_n, approach_m),
        phase_lag_rad: cycle.phase_lag_rad(),
        load_mean_n: cycle.load_mean_n,
        approach_mean_m: cycle.approach_mean_m,
        harmonics: pairs.take(HARMONICS).map(harmonic).collect(),
    })
}

/// Analyses one period of a cycle that does not close, N + 1 uniform samples, both ends included: the straight line through its two
/// ends is taken off each signal, so that means stay and a steady drift is no part of the loss, the phase or the harmonics.
///
/// # Errors
/// As [`analyse`].
pub fn analyse_open(load_n: &[f64], approach_m: &[f64]) -> Result<LoopAnalysis, LoopError> {
    check(load_n, approach_m)?;
    analyse(&closed(load_n), &closed(approach_m))
}

/// The samples without the line through first and last, which is zero in the middle.
fn closed(samples: &[f64]) -> Vec<f64> {
    let steps = samples.len().saturating_sub(1).max(1) as f64;
    let change = samples
        .first()
        .zip(samples.last())
        .map_or(0.0, |(a, b)| b - a);
    let flat = |(i, value): (usize, &f64)| value - change * (i as f64 / steps - 0.5);
    samples.iter().enumerate().map(flat).collect()
}

impl Harmonics {
    /// All harmonics of the samples of one period, both ends included, below the one of Nyquist.
    fn of(load_n: &[f64], approach_m: &[f64]) -> Result<Self, LoopError> {
        let (mut load, mut approach) = (spectrum(load_n)?, spectrum(approach_m)?);
        Ok(Self {
            load_mean_n: load.remove(0).re,
            approach_mean_m: approach.remove(0).re,
            load_n: load,
            approach_m: approach,
        })
    }

    /// Energy (J) that the cycle dissipates: the sum over all harmonics that both signals have.
    pub fn energy_loss_j(&self) -> f64 {
        // sin(phase of W - phase of delta) |W| |delta| = Im(W conj(delta)).
        let pairs = self.load_n.iter().zip(&self.approach_m).enumerate();
        pairs
            .map(|(n, (w, d))| PI * (n + 1) as f64 * (w * d.conj()).im)
            .sum()
    }

    /// Lag (rad) of the approach behind the load, first harmonic; 0 where one of them has none.
    pub fn phase_lag_rad(&self) -> f64 {
        let first = self.load_n.first().zip(self.approach_m.first());
        first.map_or(0.0, |(w, d)| (w * d.conj()).arg())
    }

    /// Load (N) and approach (m) over a period in this many uniform steps, both ends included.
    pub fn sampled(&self, steps: usize) -> (Vec<f64>, Vec<f64>) {
        let at = |mean: f64, harmonics: &[Complex<f64>], k: usize| {
            let angle = TAU * (k % steps) as f64 / steps as f64;
            let waves = harmonics.iter().enumerate();
            mean + waves
                .map(|(n, a)| (a * Complex::cis((n + 1) as f64 * angle)).im)
                .sum::<f64>()
        };
        let signal = |mean, harmonics| (0..=steps).map(|k| at(mean, harmonics, k)).collect();
        (
            signal(self.load_mean_n, &self.load_n),
            signal(self.approach_mean_m, &self.approach_m),
        )
    }
}

impl LoopAnalysis {
    /// What rounding of the samples may leave in the energy loss (J): some units in the last place of the largest approach, over
    /// the amplitude of the load, and likewise with the two exchanged.
    pub fn rounding_j(&self) -> f64 {
        let Some(first) = self.harmonics.first() else {
            return 0.0;
        };
        let approach_m = self.approach_mean_m.abs() + first.approach_amplitude_m;
        let load_n = self.load_mean_n.abs() + first.load_amplitude_n;
        let products = first.load_amplitude_n * approach_m + first.approach_amplitude_m * load_n;
        4.0 * f64::EPSILON * PI * products
    }

    /// The same loop with an energy loss (J) known from elsewhere, and the phase lag that belongs to it: of a load or an approach that
    /// is sinusoidal only the first harmonic of the other dissipates.
    #[must_use]
    pub fn of_energy_loss(mut self, energy_loss_j: f64) -> Self {
        if let Some(first) = self.harmonics.first() {
            let whole_j = PI * first.load_amplitude_n * first.approach_amplitude_m;
            self.phase_lag_rad = (energy_loss_j / whole_j).clamp(-1.0, 1.0).asin();
        }
        self.energy_loss_j = energy_loss_j;
        self
    }

    /// Storage and loss modulus (Pa) that instrumented indentation reads from the first harmonic, with contact radius a_0:
    /// E'/(1 - nu^2) = W_1 cos(phase lag) / (2 a_0 delta_1), E'' with the sine
    /// (G. Huang, B. Wang, H. Lu, Mech. Time-Depend. Mater. 8 (2004) 345, with 2 sqrt(R delta_0) for 2 a_0).
    ///
    /// `None` where there is no contact radius or no first harmonic to divide by.
    pub fn equivalent_moduli_pa(
        &self,
        contact_radius_m: f64,
        poisson_ratio: f64,
    ) -> Option<(f64, f64)> {
        let first = self.harmonics.first()?;
        let stiffness = first.load_amplitude_n / first.approach_amplitude_m;
        let modulus = (1.0 - poisson_ratio * poisson_ratio) * stiffness / (2.0 * contact_radius_m);
        let (sine, cosine) = self.phase_lag_rad.sin_cos();
        (modulus.is_finite() && contact_radius_m > 0.0)
            .then_some((modulus * cosine, modulus * sine))
    }

    /// Amplitude of harmonic `n` of the approach relative to the first.
    pub fn approach_harmonic(&self, n: usize) -> Option<f64> {
        let first = self.harmonics.first()?.approach_amplitude_m;
        let this = self.harmonics.get(n.checked_sub(1)?)?.approach_amplitude_m;
        (first > 0.0).then(|| this / first)
    }
}

fn check(load_n: &[f64], approach_m: &[f64]) -> Result<(), LoopError> {
    if load_n.len() != approach_m.len() {
        return Err(LoopError::Lengths {
            loads: load_n.len(),
            approaches: approach_m.len(),
        });
    }
    // The third harmonic needs more than two samples per oscillation.
    let needed = 8;
    let samples = load_n.len().saturating_sub(1);
    if samples < needed {
        return Err(LoopError::TooFewSamples { samples, needed });
    }
    for (signal, values) in [("load", load_n), ("approach", approach_m)] {
        if let Some(index) = values.iter().position(|v| !v.is_finite()) {
            return Err(LoopError::NotFinite {
                signal,
                index,
                value: values[index],
            });
        }
    }
    Ok(())
}

/// Complex amplitudes a_n such that the signal is a_0 + sum |a_n| sin(n omega t + arg a_n), below the Nyquist harmonic.
fn spectrum(samples: &[f64]) -> Result<Vec<Complex<f64>>, LoopError> {
    let n = samples.len() - 1;
    let mut periodic = samples[..n].to_vec();
    periodic[0] = 0.5 * (samples[0] + samples[n]);
    let transform = f64::real_forward(n);
    let mut output = transform.make_output_vec();
    transform
        .process(&mut periodic, &mut output)
        .map_err(|error| LoopError::Transform(error.to_string()))?;
    output.truncate(n.div_ceil(2));
    for (k, value) in output.iter_mut().enumerate() {
        // cos(n omega t) = sin(n omega t + pi/2): a factor i.
        *value *= if k == 0 {
            Complex::new(1.0 / n as f64, 0.0)
        } else {
            Complex::new(0.0, 2.0 / n as f64)
        };
    }
    Ok(output)
}

/// Integral of W d(delta) along the samples by the trapezium rule.
pub(crate) fn work_along(load_n: &[f64], approach_m: &[f64]) -> f64 {
    let edges = load_n.windows(2).zip(approach_m.windows(2));
    edges
        .map(|(w, d)| 0.5 * (w[0] + w[1]) * (d[1] - d[0]))
        .sum()
}

/// The closed integral.
pub(super) fn polygon_area(load_n: &[f64], approach_m: &[f64]) -> f64 {
    let open = work_along(load_n, approach_m);
    // What is left between last and first sample closes the polygon.
    let (first, last) = (0, load_n.len() - 1);
    open + 0.5 * (load_n[last] + load_n[first]) * (approach_m[first] - approach_m[last])
}

/// Angle of sample `i` of `n` on the period.
#[cfg(test)]
fn angle(i: usize, n: usize) -> f64 {
    TAU * i as f64 / n as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ellipse(n: usize, lag: f64, load_phase: f64) -> (Vec<f64>, Vec<f64>) {
        let w = |i| 10.0 + 5.0 * (angle(i, n) + load_phase).sin();
        let d = |i| 1e-5 + 2e-6 * (angle(i, n) + load_phase - lag).sin();
        ((0..=n).map(w).collect(), (0..=n).map(d).collect())
    }

    #[test]
    fn an_ellipse_has_the_area_pi_w_delta_sin_phase_at_any_sampling_and_phase() {
        let exact = PI * 5.0 * 2e-6 * 0.3_f64.sin();
        for n in [8, 9, 25, 100, 101] {
            for phase in [0.0, 1.0, -2.5] {
                let (w, d) = ellipse(n, 0.3, phase);
                let analysis = analyse(&w, &d).unwrap();
                // Sums of n roundings.
                assert!((analysis.energy_loss_j / exact - 1.0).abs() < 1e-12);
                assert!((analysis.phase_lag_rad - 0.3).abs() < 1e-12);
                assert!((analysis.load_mean_n - 10.0).abs() < 1e-13);
                let low =
                    n as f64 / std::f64::consts::TAU * (std::f64::consts::TAU / n as f64).sin();
                assert!((analysis.polygon_loss_j / (exact * low) - 1.0).abs() < 1e-12);
                assert!(analysis.approach_harmonic(2).unwrap() < 1e-13);
            }
        }
    }

    #[test]
    fn harmonics_are_told_apart_and_only_common_ones_dissipate() {
        let n = 64;
        let w: Vec<f64> = (0..=n).map(|i| 3.0 + angle(i, n).sin()).collect();
        let d: Vec<f64> = (0..=n)
            .map(|i| {
                let t = angle(i, n);
                (t - 0.1).sin() + 0.25 * (2.0 * t + 0.7).sin() + 0.125 * (3.0 * t).cos()
            })
            .collect();
        let analysis = analyse(&w, &d).unwrap();
        assert!((analysis.energy_loss_j / (PI * 0.1_f64.sin()) - 1.0).abs() < 1e-12);
        assert!((analysis.approach_harmonic(2).unwrap() - 0.25).abs() < 1e-13);
        assert!((analysis.approach_harmonic(3).unwrap() - 0.125).abs() < 1e-13);
        assert!((analysis.harmonics[1].approach_phase_rad - 0.7).abs() < 1e-12);
    }

    #[test]
    fn a_steady_drift_is_no_part_of_an_open_cycle() {
        for phase in [0.0, 1.0, -2.5] {
            let (mut w, mut d) = ellipse(64, 0.3, phase);
            let closed = analyse(&w, &d).unwrap();
            for i in 0..=64 {
                w[i] += 3.0 * (i as f64 / 64.0 - 0.5);
                d[i] -= 4e-6 * (i as f64 / 64.0 - 0.5);
            }
            let open = analyse_open(&w, &d).unwrap();
            assert!((open.energy_loss_j / closed.energy_loss_j - 1.0).abs() < 1e-12);
            assert!((open.phase_lag_rad - 0.3).abs() < 1e-12);
            assert!((open.load_mean_n - 10.0).abs() < 1e-12);
            assert!((open.polygon_loss_j / closed.polygon_loss_j - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_loop_run_backwards_gives_back_the_energy() {
        let (mut w, mut d) = ellipse(50, 0.2, 0.0);
        let forward = analyse(&w, &d).unwrap();
        w.reverse();
        d.reverse();
        let backward = analyse(&w, &d).unwrap();
        assert!((forward.energy_loss_j + backward.energy_loss_j).abs() < 1e-18);
        assert!((forward.polygon_loss_j + backward.polygon_loss_j).abs() < 1e-18);
    }

    #[test]
    fn equivalent_moduli_of_a_spring_and_a_dashpot() {
        let (w, d) = ellipse(100, 0.0, 0.0);
        let (storage, loss) = analyse(&w, &d)
            .unwrap()
            .equivalent_moduli_pa(1e-4, 0.5)
            .unwrap();
        assert!((storage / (0.75 * 5.0 / (2e-6 * 2e-4)) - 1.0).abs() < 1e-12);
        assert!((loss / storage).abs() < 1e-12);
        assert_eq!(
            analyse(&w, &d).unwrap().equivalent_moduli_pa(0.0, 0.5),
            None
        );
    }

    #[test]
    fn loops_without_meaning_are_refused() {
        let (w, d) = ellipse(100, 0.1, 0.0);
        assert!(matches!(
            analyse(&w[..5], &d[..5]),
            Err(LoopError::TooFewSamples { .. })
        ));
        assert!(matches!(
            analyse(&w, &d[1..]),
            Err(LoopError::Lengths { .. })
        ));
        assert!(matches!(
            analyse(&w, &vec![1.0; 101]),
            Err(LoopError::Constant { signal: "approach" })
        ));
        let mut broken = d.clone();
        broken[7] = f64::NAN;
        assert!(matches!(
            analyse(&w, &broken),
            Err(LoopError::NotFinite { index: 7, .. })
        ));
    }
}
