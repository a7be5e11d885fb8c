//! Synthetic measurements for tests: times as a laboratory spaces them, and noise that is the same in every run.

/// Times from `from` to `to`, both met, this many per decade.
pub(super) fn log_spaced(from: f64, to: f64, per_decade: usize) -> Vec<f64> {
    let count = ((to / from).log10() * per_decade as f64).round() as usize;
    (0..=count)
        .map(|i| from * 10_f64.powf(i as f64 / per_decade as f64))
        .collect()
}

/// Normal deviates from a seed: splitmix64 (G. L. Steele, D. Lea and C. H. Flood 2014) and the transform of Box and Muller.
pub(super) struct Noise(pub(super) u64);

impl Noise {
    /// From zero to one.
    pub(super) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Between two positive values, its logarithm uniform.
    pub(super) fn log_uniform(&mut self, from: f64, to: f64) -> f64 {
        from * (to / from).powf(self.uniform())
    }

    /// Mean zero, variance one.
    pub(super) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
