//! How exactly the instants of a cycle are solved: as exactly as the cycle is near the stabilised one.

use super::SteadySettings;
use crate::history::March;

/// Tolerances of a search. The one that was given serves the stabilised cycle; instants of a cycle still far from it may be as much looser
/// as leaves in it a small part of the distance expected of it.
pub(super) struct Instants {
    /// `None` of an engine that solves exactly.
    given: Option<f64>,
    /// Distance at which the search ends.
    of_cycle: f64,
    /// That expected of the next cycle.
    expected: f64,
    /// Cycles to come that may be less exact.
    quick_cycles: usize,
}

impl Instants {
    /// Distances of the first cycle of a search, smaller than were seen: from rest, and from the same cycle in other steps.
    const FROM_REST: f64 = 0.1;
    const FROM_OTHER_STEPS: f64 = 1e-3;
    /// What a cycle leaves of the distance of the one before, at the least.
    const PROGRESS: f64 = 0.01;
    /// By how many times what is expected a cycle may be off. Guesses from the cycle before may be within the tolerance as they are, all on
    /// one side of the solution: then a loop does not close, however often it is gone round.
    const TOO_SLOW: f64 = 10.0;
    /// Where the instants leave a hundredth of the distance, since the tolerance given leaves a tenth of that of the stabilised cycle
    /// ([`crate::engine::instant_tolerance::SHARE`]). With three times as much searches took a cycle more, with a third more iterations.
    const SHARE: f64 = 0.1;
    /// The loosest: what is looser sees an edge elsewhere.
    const LOOSEST: f64 = 1e-4;
    /// Cycles whose instants may be looser, and whose guesses come from the cycle before. A search that takes more is one that the last
    /// digits lead astray, of cells that come and go from cycle to cycle.
    const QUICK_CYCLES: usize = 5;
    /// By how much looser the instants may be of a cycle that ends the search.
    const AT_THE_END: f64 = 3.0;
    /// The distance expected of a cycle that is likely to end the search, over that at which it ends: most leave less than expected.
    const NEAR_THE_END: f64 = 3.0;

    /// Before the first cycle of a search from rest, or from a start.
    pub(super) fn new(march: &March<'_>, has_start: bool, settings: SteadySettings) -> Self {
        Self {
            given: march.tolerance(),
            of_cycle: settings.tolerance,
            expected: match (settings.is_quick, has_start) {
                (false, _) => 0.0,
                (true, true) => Self::FROM_OTHER_STEPS,
                (true, false) => Self::FROM_REST,
            },
            quick_cycles: if settings.is_quick {
                Self::QUICK_CYCLES
            } else {
                0
            },
        }
    }

    /// By how much looser than given the instants of the next cycle are.
    fn looser(&self) -> f64 {
        let looser = (Self::SHARE * self.expected / self.of_cycle).max(1.0);
        self.given
            .map_or(1.0, |given| looser.min((Self::LOOSEST / given).max(1.0)))
    }

    /// Before a cycle of so many instants behind its first; whether it is likely to be the last, and solved so that it may be. Of more instants
    /// than the march keeps none is: to record beside the search would take as much memory again.
    pub(super) fn begin_cycle(&self, march: &mut March<'_>, instants: usize) -> bool {
        let Some(given) = self.given else {
            return false;
        };
        march.tolerate(self.looser() * given);
        if self.quick_cycles == 0 {
            march.forget_last_cycle();
            return false;
        }
        march.begin_like_the_last(instants);
        let is_near =
            march.knows_last_cycle() && self.expected <= Self::NEAR_THE_END * self.of_cycle;
        if is_near {
            march.tighten_for_good_guesses();
        }
        is_near
    }

    /// Whether the distance of the cycle just solved is what it seems.
    pub(super) fn are_tight(&self) -> bool {
        self.looser() <= Self::AT_THE_END
    }

    /// After a cycle of this distance that does not end the search.
    pub(super) fn after(&mut self, distance: f64) {
        let has_slowed = self.are_tight() && distance > Self::TOO_SLOW * self.expected;
        self.quick_cycles = match has_slowed {
            true => 0,
            false => self.quick_cycles.saturating_sub(1),
        };
        self.expected = match self.quick_cycles > 0 {
            true => Self::PROGRESS * distance,
            false => 0.0,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_are_the_looser_the_farther_a_cycle_is_and_as_given_at_the_end() {
        let mut instants = Instants {
            given: Some(1e-8),
            of_cycle: 1e-4,
            expected: Instants::FROM_REST,
            quick_cycles: Instants::QUICK_CYCLES,
        };
        assert!((instants.looser() - 100.0).abs() < 1e-9 && !instants.are_tight());
        instants.after(0.5);
        assert!((instants.looser() - 5.0).abs() < 1e-9 && !instants.are_tight());
        for near in [1e-2, 1e-9] {
            instants.after(near);
            assert!((instants.looser() - 1.0).abs() < 1e-9 && instants.are_tight());
        }
        // Once progress slows, the rest is done with care.
        instants.after(1e-2);
        instants.after(2e-3);
        assert_eq!((instants.quick_cycles, instants.expected), (0, 0.0));
        // Nothing is looser than the loosest, but for what was given so.
        for (given, looser) in [(1e-5, 10.0), (1e-3, 1.0)] {
            instants.given = Some(given);
            instants.expected = f64::INFINITY;
            assert!((instants.looser() - looser).abs() < 1e-9);
        }
        // Springs are solved exactly: there is nothing to be tightened.
        instants.given = None;
        assert!(instants.are_tight());
    }
}
