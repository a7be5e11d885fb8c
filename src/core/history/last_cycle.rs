//! A guess of the next pressure from the same instant of the cycle before: nothing but work depends on it.
//!
//! From one cycle of a search to the next pressures change little, and which nodes come into contact at an instant is known, which an
//! extrapolation in time cannot know.

/// Most memory (bytes) that the pressures of a cycle take; those of more nodes are not kept.
const MOST_BYTES: usize = 64 << 20;

/// Bytes that a cycle of this many steps keeps on so many nodes: its first instant, one for every step, and a difference.
pub(crate) fn kept_bytes(steps: usize, nodes: usize) -> usize {
    let bytes = (steps + 2) * nodes * size_of::<f32>();
    if bytes <= MOST_BYTES { bytes } else { 0 }
}

/// Pressures of a cycle; single precision does for a guess.
#[derive(Debug, Clone, Default)]
pub(super) struct LastCycle {
    /// At every instant, one after another.
    pressures: Vec<f32>,
    nodes: usize,
    /// Instants of this cycle that are solved.
    at: usize,
    /// How much higher the pressure of the last instant is than it was a cycle before.
    higher: Vec<f32>,
}

impl LastCycle {
    /// Begins a cycle, of which so many instants are behind.
    pub(super) fn begin(&mut self, nodes: usize, behind: usize) {
        self.nodes = nodes;
        self.at = behind;
        self.higher.clear();
        self.higher.resize(nodes, 0.0);
    }

    fn then(&self) -> Option<&[f32]> {
        let from = self.at * self.nodes;
        self.pressures.get(from..from + self.nodes)
    }

    /// Turns the last pressure into a guess of the next, as much higher than a cycle before as the last; false where the cycle before did
    /// not come to this instant.
    pub(super) fn guess(&self, pressure: &mut [f64]) -> bool {
        let Some(then) = self.then() else {
            return false;
        };
        for (p, (then, higher)) in pressure.iter_mut().zip(then.iter().zip(&self.higher)) {
            *p = match *then > 0.0 {
                true => f64::from((then + higher).max(0.0)),
                false => 0.0,
            };
        }
        true
    }

    /// Takes the pressure of an instant.
    pub(super) fn see(&mut self, pressure: &[f64]) {
        let (from, known) = (self.at * self.nodes, self.pressures.len());
        self.at += 1;
        if from == known {
            self.pressures.extend(pressure.iter().map(|p| *p as f32));
        } else if let Some(then) = self.pressures.get_mut(from..from + self.nodes) {
            let both = then.iter_mut().zip(&mut self.higher);
            for (p, (then, higher)) in pressure.iter().zip(both) {
                let now = *p as f32;
                *higher = now - *then;
                *then = now;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_pressure_is_that_of_the_cycle_before_and_as_much_higher_as_the_last() {
        let mut last = LastCycle::default();
        let before = [[0.0, 1.0], [2.0, 3.0], [4.0, 1.0]];
        last.begin(2, 0);
        for pressure in before {
            assert!(!last.guess(&mut [0.0; 2]));
            last.see(&pressure);
        }
        last.begin(2, 0);
        let guess = |last: &LastCycle| {
            let mut pressure = [9.0; 2];
            last.guess(&mut pressure).then_some(pressure)
        };
        // Nothing is known of how the cycle begins; then every node is half a unit higher, or two units lower.
        assert_eq!(guess(&last), Some([0.0, 1.0]));
        last.see(&[0.5, 1.5]);
        assert_eq!(guess(&last), Some([2.5, 3.5]));
        last.see(&[1.0, 1.0]);
        assert_eq!(guess(&last), Some([3.0, 0.0]));
        last.see(&[5.0, 0.0]);
        assert_eq!(guess(&last), None);
        // A cycle that goes on from the end of one begins behind its first instant, with what the last cycle had there.
        last.begin(2, 1);
        assert_eq!(guess(&last), Some([1.0, 1.0]));
    }

    #[test]
    fn what_is_kept_has_a_bound() {
        assert_eq!(kept_bytes(80, 100), 32_800);
        assert_eq!(kept_bytes(80, 1 << 20), 0);
    }
}
