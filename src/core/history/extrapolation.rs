//! A guess of the next pressure from the last three: nothing but work depends on it.

use serde::{Deserialize, Serialize};

use crate::numerics::threads::in_pieces;

/// Pressures of the last instants, and the steps between them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Extrapolation {
    /// The pressures one and two instants before the last.
    before: [Vec<f64>; 2],
    /// How many of them belong to the present course of the drive.
    known: usize,
    /// The step (s) that led to the last pressure, and the one before it.
    steps_s: [f64; 2],
}

/// Steps that are longer than the last by more than this factor are not extrapolated over: nothing is known of such times.
const LARGEST_GROWTH: f64 = 2.0;

impl Extrapolation {
    /// Turns the last pressure into a guess of the next, `step_s` seconds later. A step of no length is a jump of the drive,
    /// after which a new course begins. Cells out of contact stay so: when they enter is not known from their pressure.
    pub(crate) fn guess(&mut self, step_s: f64, pressure: &mut [f64]) {
        if step_s <= 0.0 {
            self.forget();
            return;
        }
        let weights = self.weights(step_s);
        let [one, two] = &mut self.before;
        std::mem::swap(one, two);
        one.resize(pressure.len(), 0.0);
        two.resize(pressure.len(), 0.0);
        // `one` is now the older of the two, and makes room for the last pressure once it has been used.
        let fields = (&mut *pressure, &mut one[..], &two[..]);
        in_pieces(fields.0.len(), fields, |_, (pressure, one, two)| {
            for ((p, older), old) in pressure.iter_mut().zip(one).zip(two) {
                let last = *p;
                let guess = weights[0] * last + weights[1] * old + weights[2] * *older;
                *p = if last > 0.0 { guess.max(0.0) } else { last };
                *older = last;
            }
        });
        self.known = (self.known + 1).min(2);
        self.steps_s = [step_s, self.steps_s[0]];
    }

    /// Whether it can look back on this number of nodes.
    pub(super) fn fits(&self, nodes: usize) -> bool {
        let mut before = self.before.iter();
        before.all(|pressure| [0, nodes].contains(&pressure.len())) && self.known <= 2
    }

    /// The past says nothing of what comes.
    pub(super) fn forget(&mut self) {
        self.known = 0;
    }

    /// Weights of the last pressure, the one before and the one before that (Newton's interpolation through the three).
    fn weights(&self, step_s: f64) -> [f64; 3] {
        let [last_s, older_s] = self.steps_s;
        if self.known == 0 || step_s > LARGEST_GROWTH * last_s {
            return [1.0, 0.0, 0.0];
        }
        let linear = step_s / last_s;
        if self.known == 1 || step_s > LARGEST_GROWTH * older_s {
            return [1.0 + linear, -linear, 0.0];
        }
        let quadratic = step_s * (step_s + last_s) / (last_s + older_s);
        [
            1.0 + linear + quadratic / last_s,
            -linear - quadratic / last_s - quadratic / older_s,
            quadratic / older_s,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Guesses at the ends of these steps of a course whose pressure is `p(t)`.
    fn guesses(steps_s: &[f64], p: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut extrapolation = Extrapolation::default();
        let (mut time_s, mut pressure) = (0.0, [p(0.0), 0.0]);
        let follow = |&step_s: &f64| {
            extrapolation.guess(step_s, &mut pressure);
            let guess = pressure[0];
            assert_eq!(pressure[1], 0.0);
            time_s += step_s;
            pressure[0] = p(time_s);
            guess
        };
        steps_s.iter().map(follow).collect()
    }

    #[test]
    fn a_quadratic_course_is_foreseen_from_the_third_step_on() {
        let steps_s = [0.5, 0.5, 0.8, 1.0, 0.3, 0.4];
        let p = |t: f64| 3.0 + 2.0 * t + 0.7 * t * t;
        let found = guesses(&steps_s, p);
        let mut time_s = 0.0;
        for (k, (guess, step_s)) in found.iter().zip(steps_s).enumerate() {
            time_s += step_s;
            // A few roundings of values of order ten.
            let foreseen = (guess - p(time_s)).abs() < 1e-13;
            assert_eq!(foreseen, k >= 2, "{k}");
        }
        let straight = guesses(&steps_s, |t| 3.0 + 2.0 * t);
        assert!((straight[1] - 5.0).abs() < 1e-14);
    }

    #[test]
    fn a_jump_begins_a_new_course_and_a_pressure_never_turns_negative() {
        let found = guesses(&[1.0, 1.0, 0.0, 1.0, 1.0], |t| 4.0 - t);
        assert_eq!(found, [4.0, 2.0, 2.0, 2.0, 0.0]);
        let falling = guesses(&[1.0; 3], |t| 1.0 / (1.0 + 10.0 * t));
        assert!(falling.iter().all(|p| *p >= 0.0));
        // A step four times as long as the last is not foreseen.
        assert_eq!(guesses(&[1.0, 4.0], |t| 4.0 + t)[1], 5.0);
    }
}
