//! Synthetic measurements for tests: times as a laboratory spaces them, and noise that is the same in every run.

pub(super) use crate::numerics::random::Noise;

/// Times from `from` to `to`, both met, this many per decade.
pub(super) fn log_spaced(from: f64, to: f64, per_decade: usize) -> Vec<f64> {
    let count = ((to / from).log10() * per_decade as f64).round() as usize;
    (0..=count)
        .map(|i| from * 10_f64.powf(i as f64 / per_decade as f64))
        .collect()
}

impl Noise {
    /// Between two positive values, its logarithm uniform.
    pub(super) fn log_uniform(&mut self, from: f64, to: f64) -> f64 {
        from * (to / from).powf(self.uniform())
    }
}
