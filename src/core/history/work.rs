//! What a march costs, counted: nothing but the cost depends on it.

use std::ops::AddAssign;

use serde::{Deserialize, Serialize};

/// Work done since a count began.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Instants of contact solved: time steps, and jumps of the drive.
    pub instants: u64,
    /// Contact iterations over all of them.
    pub iterations: u64,
    /// Convolutions over all of them, of whatever size; none where the engine has no grid.
    pub convolutions: u64,
}

impl Work {
    /// Convolutions per instant on average; `None` before the first instant.
    pub fn convolutions_per_instant(self) -> Option<f64> {
        (self.instants > 0).then(|| self.convolutions as f64 / self.instants as f64)
    }
}

impl AddAssign for Work {
    fn add_assign(&mut self, more: Self) {
        self.instants += more.instants;
        self.iterations += more.iterations;
        self.convolutions += more.convolutions;
    }
}
