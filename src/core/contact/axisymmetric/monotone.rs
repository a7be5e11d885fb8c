//! Spring forces as they are reported: never rising outwards.
//!
//! Under any drive the springs of a body whose transformed gap G grows outwards carry forces that do not rise outwards, so that
//! the pressure is nowhere negative and the contact is a disc. With two springs x1 < x2, c = G(x2) - G(x1) > 0 and D the
//! difference of their shortenings: both in contact, D = c; only the inner one, D <= c; both free, D is a mean of its past and so
//! at most c. Were the inner spring the first to leave, D >= c would be at least its whole past, and
//! f1 - f2 = E(0) D + integral of E'(t-s) D(s) ds >= 0 (E >= 0 and E' <= 0 for any passive body): the outer one has left too.
//!
//! Where steps are long beside the times in which the body relaxes, a spring that has just come into contact may be given a
//! force that is larger than that of its inner neighbour, by up to half of the largest force, since the rule of the time steps
//! does not know when within the step it was met. The next steps put it right, and the loss is not affected. What is reported of
//! an instant is the nearest row of forces that does not rise, in the least squares, which leaves the load as it is (isotonic
//! regression by pooling adjacent violators: M. Ayer, H. D. Brunk, G. M. Ewing, W. T. Reid, E. Silverman, Annals of
//! Mathematical Statistics 26 (1955) 641).

/// Space for the blocks of equal force.
#[derive(Debug, Clone, Default)]
pub(super) struct Monotone {
    force: Vec<f64>,
    /// Mean force, width, and number of springs of each block.
    blocks: Vec<(f64, f64, usize)>,
}

impl Monotone {
    /// The forces nearest to these that do not rise outwards, over springs of these widths.
    pub(super) fn of<'a>(&'a mut self, force: &'a [f64], width_m: &[f64]) -> &'a [f64] {
        if force.windows(2).all(|pair| pair[1] <= pair[0]) {
            return force;
        }
        self.blocks.clear();
        for (&value, &width_m) in force.iter().zip(width_m) {
            let mut block = (value, width_m, 1);
            while let Some(&(inner, inner_m, springs)) = self.blocks.last()
                && inner < block.0
            {
                let total_m = inner_m + block.1;
                let mean = (inner * inner_m + block.0 * block.1) / total_m;
                block = (mean, total_m, springs + block.2);
                self.blocks.pop();
            }
            self.blocks.push(block);
        }
        self.force.clear();
        for &(value, _, springs) in &self.blocks {
            self.force.extend(std::iter::repeat_n(value, springs));
        }
        &self.force
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_that_fall_stay_and_a_rise_is_levelled_without_changing_the_load() {
        let mut monotone = Monotone::default();
        let falling = [5.0, 3.0, 3.0, 0.5, 0.0];
        assert_eq!(monotone.of(&falling, &[1.0; 5]), falling);
        let rising = [5.0, 2.0, 4.0, 3.5, 0.0];
        let widths = [1.0, 1.0, 1.0, 2.0, 1.0];
        // 2 and 4 and twice 3.5: the mean of the three blocks is 3.25.
        assert_eq!(monotone.of(&rising, &widths), [5.0, 3.25, 3.25, 3.25, 0.0]);
        let load = |force: &[f64]| -> f64 { force.iter().zip(&widths).map(|(f, w)| f * w).sum() };
        let found = load(monotone.of(&rising, &widths));
        assert!((found - load(&rising)).abs() < 1e-14);
    }
}
