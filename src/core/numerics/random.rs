//! Random numbers that are the same in every run: of a seed, and of a number within it.

/// Deviates from a seed: splitmix64 (G. L. Steele, D. Lea and C. H. Flood 2014) and the transform of Box and Muller.
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    /// The stream of this number, among those of one seed: the same whatever became of the others.
    pub(crate) fn stream(seed: u64, number: u64) -> Self {
        Self(Self(seed).bits() ^ Self(!number).bits().rotate_left(32))
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From zero to one.
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Mean zero, variance one.
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
