//! Exact interconversion of the relaxation modulus and the creep compliance.
//!
//! The two are one material: `s D(s) = 1/(s E(s))` in the Laplace domain (N. W. Tschoegl, *The
//! Phenomenological Theory of Linear Viscoelastic Behavior*, Springer 1989, chapters 2 and 8;
//! S. W. Park and R. A. Schapery, International Journal of Solids and Structures 36 (1999) 1653,
//! who fit by least squares what is solved exactly here). With `theta = -1/s`, a time,
//!
//! ```text
//!     s E(s)         =  g_inf + sum g_i tau_i/(tau_i - theta)
//!     -s D(s)/theta  =  1/eta + D_0/(0 - theta) + sum D_j/(lambda_j - theta)
//! ```
//!
//! are the same kind of function, `f(theta) = c + sum w_i/(p_i - theta)` with positive weights and
//! `c >= 0`: it rises from minus to plus infinity between consecutive poles, so exactly one zero
//! lies in each gap, and one above the last pole if `c > 0`. The zeros of the first are the
//! retardation times, those of the second the relaxation times.
//!
//! This is the secular equation of the symmetric eigenvalue problem, and what is known to be
//! stable there is done here: a zero is stored as its distance from the nearer pole, so that it
//! may come as close as it likes without cancellation, and the amplitudes follow from products of
//! differences of poles and zeros (K. Löwner's formula, as M. Gu and S. C. Eisenstat use it, SIAM
//! Journal on Matrix Analysis and Applications 15 (1994) 1266), which make the result the exact
//! reciprocal of a model whose times differ from the given ones only by rounding.

use super::creep::{Creep, CreepBranch};
use super::error::{MaterialError, in_range};
use super::relaxation::{Relaxation, RelaxationBranch};
use super::spectrum::Branch;

/// Retardation times and compliances of a generalised Maxwell model.
///
/// `n` branches give `n` Kelvin elements for a solid, `n - 1` and a viscosity for a fluid. An
/// element whose compliance underflows (a branch some 300 decades weaker than the rest) is left out.
///
/// # Errors
/// [`MaterialError::OutOfRange`] if a time or a compliance is beyond the range of a double.
pub(super) fn relaxation_to_creep(relaxation: &Relaxation) -> Result<Creep, MaterialError> {
    const WHAT: &str = "the creep compliance of this relaxation modulus";
    let instantaneous_pa = relaxation.instantaneous_modulus();
    let times: Vec<f64> = relaxation
        .branches()
        .iter()
        .map(|branch| branch.time_s)
        .collect();
    let weights = relaxation
        .branches()
        .iter()
        .map(|branch| branch.modulus_pa / instantaneous_pa * branch.time_s)
        .collect();
    let equilibrium = relaxation.equilibrium_modulus();
    let secular = Secular {
        constant: normal_or_zero(WHAT, equilibrium, equilibrium / instantaneous_pa)?,
        poles: times,
        weights,
    };
    let branches = secular.branches(WHAT, Secular::compliance_share, instantaneous_pa)?;
    let branches = branches.into_iter().map(|branch| CreepBranch {
        compliance_per_pa: branch.strength,
        time_s: branch.time_s,
    });
    Creep::new(
        1.0 / instantaneous_pa,
        branches.collect(),
        relaxation.viscosity_pa_s(),
    )
}

/// Relaxation times and moduli of a generalised Kelvin model.
///
/// `n` elements give `n` Maxwell branches and an equilibrium modulus for a solid, `n + 1` branches
/// for a fluid.
///
/// # Errors
/// [`MaterialError::NoRelaxationModulus`] without an instantaneous compliance;
/// [`MaterialError::OutOfRange`] if a time or a modulus is beyond the range of a double.
pub(super) fn creep_to_relaxation(creep: &Creep) -> Result<Relaxation, MaterialError> {
    const WHAT: &str = "the relaxation modulus of this creep compliance";
    if creep.is_instantaneously_rigid() {
        return Err(MaterialError::NoRelaxationModulus);
    }
    let instantaneous_per_pa = creep.instantaneous_compliance();
    let retarded = creep.branches();
    let poles = std::iter::once(0.0).chain(retarded.iter().map(|branch| branch.time_s));
    let weights = std::iter::once(1.0).chain(
        retarded
            .iter()
            .map(|branch| branch.compliance_per_pa / instantaneous_per_pa),
    );
    let fluidity = creep
        .viscosity_pa_s()
        .map_or(0.0, |viscosity| 1.0 / viscosity);
    let secular = Secular {
        constant: normal_or_zero(WHAT, fluidity, fluidity / instantaneous_per_pa)?,
        poles: poles.collect(),
        weights: weights.collect(),
    };
    let branches = secular.branches(WHAT, Secular::modulus_share, instantaneous_per_pa)?;
    let branches = branches.into_iter().map(|branch| RelaxationBranch {
        modulus_pa: branch.strength,
        time_s: branch.time_s,
    });
    let equilibrium_pa = creep
        .equilibrium_compliance()
        .map_or(0.0, |compliance| 1.0 / compliance);
    Relaxation::new(equilibrium_pa, branches.collect())
}

/// Accepts a ratio that is finite and has not underflown: only a zero numerator may give zero,
/// because the sign of the constant decides between solid and fluid.
fn normal_or_zero(what: &'static str, numerator: f64, ratio: f64) -> Result<f64, MaterialError> {
    if ratio.is_normal() || numerator == 0.0 {
        Ok(ratio)
    } else {
        Err(MaterialError::OutOfRange { what })
    }
}

/// `f(theta) = constant + sum weights_i/(poles_i - theta)`, poles ascending, weights not negative.
struct Secular {
    constant: f64,
    poles: Vec<f64>,
    weights: Vec<f64>,
}

/// The number `poles[anchor] + offset`, kept in two parts.
#[derive(Debug, Clone, Copy)]
struct Zero {
    anchor: usize,
    offset: f64,
}

impl Secular {
    /// A branch at every zero, its strength this share over the instantaneous value; none where that underflows.
    fn branches(
        &self,
        what: &'static str,
        share: fn(&Self, &[Zero], usize) -> f64,
        instantaneous: f64,
    ) -> Result<Vec<Branch>, MaterialError> {
        let zeros = self.zeros();
        let branch = |(index, zero): (usize, &Zero)| {
            Ok(Branch {
                strength: in_range(what, share(self, &zeros, index) / instantaneous)?,
                time_s: in_range(what, self.position(zero))?,
            })
        };
        let branches = zeros.iter().enumerate().map(branch);
        let mut branches = branches.collect::<Result<Vec<_>, _>>()?;
        branches.retain(|branch| branch.strength > 0.0);
        Ok(branches)
    }

    /// The zeros, ascending: one in each gap, and one above the last pole if the constant is positive.
    fn zeros(&self) -> Vec<Zero> {
        let gaps = self.poles.len().saturating_sub(1);
        let mut zeros: Vec<Zero> = (0..gaps).map(|lower| self.zero_in_gap(lower)).collect();
        if self.constant > 0.0 && !self.poles.is_empty() {
            zeros.push(self.zero_above(gaps));
        }
        zeros
    }

    /// The zero between `poles[lower]` and the next pole, measured from the nearer of the two.
    fn zero_in_gap(&self, lower: usize) -> Zero {
        let half = 0.5 * (self.poles[lower + 1] - self.poles[lower]);
        let rest = self.without_anchor(lower, half);
        if rest * half >= self.weights[lower] {
            // Without its own pole f rises with the offset, so w/rest(half) is a lower bound.
            let offset = self.distance(lower, 1.0, self.weights[lower] / rest, half);
            return Zero {
                anchor: lower,
                offset,
            };
        }
        let upper = lower + 1;
        let rest = -self.without_anchor(upper, -half);
        let offset = -self.distance(upper, -1.0, self.weights[upper] / rest, half);
        Zero {
            anchor: upper,
            offset,
        }
    }

    /// The zero above the last pole, of a positive constant.
    fn zero_above(&self, last: usize) -> Zero {
        // Between the zero without and the zero with all other poles moved onto the last one.
        let nearest = self.weights[last] / self.constant;
        let farthest = self.weights.iter().sum::<f64>() / self.constant;
        Zero {
            anchor: last,
            offset: self.distance(last, 1.0, nearest, farthest),
        }
    }

    /// Distance of the zero from the pole `anchor` in the direction `sign`, bracketed by
    /// `low <= high`, by bisection to neighbouring doubles: geometric while the bracket spans more
    /// than a factor of two, so that forty decades cost seven steps more.
    fn distance(&self, anchor: usize, sign: f64, low: f64, high: f64) -> f64 {
        if self.weights[anchor] == 0.0 {
            // A weight that has underflown: the zero is at the pole, and the pole is gone.
            return 0.0;
        }
        let (mut low, mut high) = (low.min(high), high);
        loop {
            let middle = if high > 2.0 * low {
                low.sqrt() * high.sqrt()
            } else {
                low + 0.5 * (high - low)
            };
            // The negated form also ends a bracket that is not a number.
            if !(low < middle && middle < high) {
                return high;
            }
            let rest = sign * self.without_anchor(anchor, sign * middle);
            if rest * middle < self.weights[anchor] {
                low = middle;
            } else {
                high = middle;
            }
        }
    }

    /// `f` at `poles[anchor] + offset`, without the term of that pole.
    fn without_anchor(&self, anchor: usize, offset: f64) -> f64 {
        let origin = self.poles[anchor];
        let terms = self.poles.iter().zip(&self.weights).enumerate();
        let others = terms.filter(|(index, _)| *index != anchor);
        self.constant
            + others
                .map(|(_, (pole, weight))| weight / ((pole - origin) - offset))
                .sum::<f64>()
    }

    fn position(&self, zero: &Zero) -> f64 {
        self.poles[zero.anchor] + zero.offset
    }

    /// `poles[index] - zero`, without cancellation: the offset is at most half a gap.
    fn pole_minus(&self, index: usize, zero: &Zero) -> f64 {
        (self.poles[index] - self.poles[zero.anchor]) - zero.offset
    }

    /// `left - right` of two different zeros; from one pole their offsets have opposite signs.
    fn zero_minus(&self, left: &Zero, right: &Zero) -> f64 {
        (self.poles[left.anchor] - self.poles[right.anchor]) + (left.offset - right.offset)
    }

    /// `D_j E(0)` for the poles `tau_i` and zeros `lambda_j` of a relaxation modulus:
    /// `-prod_i (1 - lambda_j/tau_i) / prod_{l != j} (1 - lambda_j/lambda_l)`.
    ///
    /// Factors are taken in pairs of neighbours, so that no partial product leaves the range.
    fn compliance_share(&self, zeros: &[Zero], index: usize) -> f64 {
        let own = &zeros[index];
        let mut share = -self.pole_minus(index, own) / self.poles[index];
        for (other, pole) in self
            .poles
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != index)
        {
            let difference = self.pole_minus(other, own);
            share *= match zeros.get(other) {
                Some(zero) => {
                    difference / self.zero_minus(zero, own) * (self.position(zero) / pole)
                }
                None => difference / pole,
            };
        }
        share
    }

    /// `g_i D(0)` for the poles `0, lambda_j` and zeros `tau_i` of a creep compliance:
    /// `prod_j (1 - tau_i/lambda_j) / prod_{l != i} (1 - tau_i/tau_l)`, in pairs likewise.
    fn modulus_share(&self, zeros: &[Zero], index: usize) -> f64 {
        let own = &zeros[index];
        let mut share = match self.poles.get(index + 1) {
            Some(pole) => self.pole_minus(index + 1, own) / pole,
            None => 1.0,
        };
        for (other, zero) in zeros
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != index)
        {
            let difference = self.zero_minus(zero, own);
            share *= match self.poles.get(other + 1) {
                Some(pole) => {
                    self.pole_minus(other + 1, own) / difference * (self.position(zero) / pole)
                }
                None => self.position(zero) / difference,
            };
        }
        share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// The two functions of one material agree to the rounding of their sums: up to 31
    /// positive terms with a few roundings each. The largest difference seen is 6e-15.
    const FUNCTION_TOLERANCE: f64 = 5e-14;

    /// Splitmix64 (G. L. Steele, D. Lea and C. H. Flood, OOPSLA 2014): the same cases every time.
    struct Random(u64);

    impl Random {
        /// Uniform in 0 to 1.
        fn uniform(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        }

        /// Ten to a power uniform between `from` and `to`.
        fn decades(&mut self, from: f64, to: f64) -> f64 {
            10f64.powf(from + (to - from) * self.uniform())
        }

        /// Ascending times over twelve decades, consecutive ones at least `gap` apart (relative).
        fn times(&mut self, count: usize, gap: f64) -> Vec<f64> {
            let mut times: Vec<f64> = (0..count).map(|_| self.decades(-6.0, 6.0)).collect();
            times.sort_by(f64::total_cmp);
            times.dedup_by(|next, kept| *next < *kept * (1.0 + gap));
            times
        }

        /// A series of `count` branches whose moduli spread over `spread` decades.
        fn relaxation(&mut self, count: usize, gap: f64, spread: f64, solid: bool) -> Relaxation {
            let branches = self
                .times(count, gap)
                .into_iter()
                .map(|time_s| RelaxationBranch {
                    modulus_pa: 1e9 * self.decades(-spread, 0.0),
                    time_s,
                })
                .collect();
            let equilibrium = if solid {
                1e9 * self.decades(-spread, 0.0)
            } else {
                0.0
            };
            Relaxation::new(equilibrium, branches).unwrap()
        }

        /// The same for a generalised Kelvin model.
        fn creep(&mut self, count: usize, gap: f64, spread: f64, solid: bool) -> Creep {
            let branches = self
                .times(count, gap)
                .into_iter()
                .map(|time_s| CreepBranch {
                    compliance_per_pa: 1e-9 * self.decades(-spread, 0.0),
                    time_s,
                })
                .collect();
            let viscosity = (!solid).then(|| 1e9 * self.decades(-6.0, 6.0));
            Creep::new(1e-9 * self.decades(-spread, 0.0), branches, viscosity).unwrap()
        }
    }

    fn frequencies() -> impl Iterator<Item = f64> {
        (0..=64).map(|index| 10f64.powf(-8.0 + 0.25 * f64::from(index)))
    }

    fn relative_difference(left: f64, right: f64) -> f64 {
        if left == right {
            0.0
        } else {
            ((left - right) / right).abs()
        }
    }

    /// Both parts of the modulus from either face, and `E* D* = 1`, over sixteen decades.
    fn assert_one_material(relaxation: &Relaxation, creep: &Creep) {
        for omega in frequencies() {
            let modulus = relaxation.complex_modulus(omega);
            let same = creep.complex_modulus(omega);
            assert!(
                relative_difference(same.re, modulus.re) < FUNCTION_TOLERANCE,
                "E' at {omega}"
            );
            assert!(
                relative_difference(same.im, modulus.im) < FUNCTION_TOLERANCE,
                "E'' at {omega}"
            );
            let product = modulus * creep.complex_compliance(omega);
            assert!(
                (product - 1.0).norm() < FUNCTION_TOLERANCE,
                "E* D* at {omega}"
            );
        }
        let glassy = relaxation.instantaneous_modulus() * creep.compliance(0.0);
        assert_relative_eq!(glassy, 1.0, max_relative = FUNCTION_TOLERANCE);
        assert_eq!(relaxation.is_fluid(), creep.is_fluid());
        match (creep.equilibrium_compliance(), relaxation.viscosity_pa_s()) {
            (Some(compliance), None) => {
                let rubbery = relaxation.equilibrium_modulus() * compliance;
                assert_relative_eq!(rubbery, 1.0, max_relative = FUNCTION_TOLERANCE);
            }
            (None, Some(viscosity)) => {
                let same = creep.viscosity_pa_s().unwrap();
                assert_relative_eq!(same, viscosity, max_relative = FUNCTION_TOLERANCE);
            }
            other => panic!("neither solid nor fluid: {other:?}"),
        }
    }

    #[test]
    fn a_zener_solid_has_the_closed_form_relaxation() {
        // Spring 1/D0 in series with a Kelvin unit 1/D1, lambda: g_inf = 1/(D0 + D1),
        // tau = lambda D0/(D0 + D1), E(0) = 1/D0 (Tschoegl 1989, section 3.3).
        for (d0, d1) in [(1e-9, 1e-9), (1e-9, 3e-12), (1e-12, 4e-7)] {
            let lambda = 2.5;
            let branch = CreepBranch {
                compliance_per_pa: d1,
                time_s: lambda,
            };
            let relaxation = Creep::new(d0, vec![branch], None)
                .unwrap()
                .to_relaxation()
                .unwrap();
            let found = relaxation.branches()[0];
            // Closed forms and solver differ by a few roundings.
            assert_relative_eq!(
                relaxation.equilibrium_modulus(),
                1.0 / (d0 + d1),
                max_relative = 1e-15
            );
            assert_relative_eq!(found.time_s, lambda * d0 / (d0 + d1), max_relative = 1e-15);
            assert_relative_eq!(
                found.modulus_pa,
                d1 / (d0 * (d0 + d1)),
                max_relative = 2e-15
            );
        }
    }

    #[test]
    fn a_maxwell_fluid_has_a_spring_and_a_dashpot_and_nothing_else() {
        let branch = RelaxationBranch {
            modulus_pa: 3e9,
            time_s: 8.93,
        };
        let relaxation = Relaxation::new(0.0, vec![branch]).unwrap();
        let creep = relaxation.to_creep().unwrap();
        assert_eq!(
            creep,
            Creep::new(1.0 / 3e9, vec![], Some(3e9 * 8.93)).unwrap()
        );
        let back = creep.to_relaxation().unwrap();
        assert!(back.is_fluid());
        assert_relative_eq!(back.branches()[0].modulus_pa, 3e9, max_relative = 1e-15);
        assert_relative_eq!(back.branches()[0].time_s, 8.93, max_relative = 1e-15);
    }

    #[test]
    fn an_elastic_solid_stays_elastic() {
        let relaxation = Relaxation::new(4.0, vec![]).unwrap();
        let creep = relaxation.to_creep().unwrap();
        assert_eq!(creep, Creep::new(0.25, vec![], None).unwrap());
        assert_eq!(creep.to_relaxation().unwrap(), relaxation);
    }

    #[test]
    fn an_epoxy_of_24_branches_over_12_decades_matches_60_digit_arithmetic() {
        // Cured epoxy, S. L. Simon, G. B. McKenna and O. Sindt, Journal of Applied Polymer Science
        // 76 (2000) 495, as tabulated in github.com/ealopez/TappingMode_Simulations.
        const WEIGHTS: [f64; 24] = [
            0.0215, 0.0215, 0.0215, 0.0215, 0.0267, 0.0267, 0.0375, 0.0405, 0.0630, 0.0630, 0.1054,
            0.1160, 0.1160, 0.1653, 0.0561, 0.0561, 0.0199, 0.0119, 0.0055, 0.0028, 0.0008, 0.0002,
            0.0003, 0.0003,
        ];
        let time = |index: usize| {
            if index == 23 {
                1e5
            } else {
                10f64.powf(index as f64 / 2.0 - 7.0)
            }
        };
        let branches = WEIGHTS
            .iter()
            .enumerate()
            .map(|(index, weight)| RelaxationBranch {
                modulus_pa: (891e6 - 4.9e6) * weight,
                time_s: time(index),
            });
        let relaxation = Relaxation::new(4.9e6, branches.collect()).unwrap();
        let creep = relaxation.to_creep().unwrap();
        // Zeros and residues found with mpmath at 60 digits.
        for (index, lambda, compliance) in [
            (0, 1.021_545_739_235_912_3e-7, 2.384_344_298_468_399e-11),
            (7, 0.000_331_997_031_976_428_07, 6.566_276_024_860_533e-11),
            (13, 0.563_713_007_674_692_5, 1.603_685_972_804_268_1e-9),
            (20, 1_189.265_973_905_240_1, 3.826_248_757_547_717e-8),
            (22, 10_548.116_244_602_816, 1.066_573_700_500_558e-8),
            (23, 105_491.851_724_712_93, 1.074_785_447_070_120_3e-8),
        ] {
            let found = creep.branches()[index];
            // Input rounding (powers of ten, products) moves the exact answer by about 1e-15 and,
            // for compliances, by up to 1e-14 where a pole and a zero are 2 % apart.
            assert_relative_eq!(found.time_s, lambda, max_relative = 2e-15);
            assert_relative_eq!(found.compliance_per_pa, compliance, max_relative = 5e-14);
        }
        assert_one_material(&relaxation, &creep);
    }

    #[test]
    fn weak_and_nearly_equal_branches_keep_every_digit() {
        // A branch 12 decades below the rest, and two strong ones one part in 2^40 apart; zeros
        // and residues found with mpmath at 60 digits.
        let nearly = 1024.0 * (1.0 + 2f64.powi(-40));
        let branches = [(1e9, 1.0), (1e-3, 7.0), (2e9, 1024.0), (3e9, nearly)]
            .map(|(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s });
        let relaxation = Relaxation::new(1e9, branches.to_vec()).unwrap();
        let creep = relaxation.to_creep().unwrap();
        let expected = [
            (1.166_508_418_791_231_1, 2.376_433_098_361_534e-11),
            (7.000_000_000_001_193, 2.904_404_162_400_574e-23),
            (1_024.000_000_000_372_4, 3.970_466_940_249_911e-35),
            (6_144.833_491_584_567, 8.333_785_261_592_332e-10),
        ];
        for (found, (time_s, compliance)) in creep.branches().iter().zip(expected) {
            // The compliances are products of a dozen factors that carry no cancellation.
            assert_relative_eq!(found.time_s, time_s, max_relative = 1e-15);
            assert_relative_eq!(found.compliance_per_pa, compliance, max_relative = 5e-15);
        }
        assert_one_material(&relaxation, &creep);
    }

    #[test]
    fn retardation_times_interlace_relaxation_times() {
        let mut random = Random(11);
        for solid in [true, false] {
            let relaxation = random.relaxation(30, 0.0, 6.0, solid);
            let creep = relaxation.to_creep().unwrap();
            let times: Vec<f64> = relaxation
                .branches()
                .iter()
                .map(|branch| branch.time_s)
                .collect();
            assert_eq!(creep.branches().len(), times.len() - usize::from(!solid));
            for (index, branch) in creep.branches().iter().enumerate() {
                assert!(times[index] <= branch.time_s);
                assert!(
                    times
                        .get(index + 1)
                        .is_none_or(|next| branch.time_s <= *next)
                );
            }
        }
    }

    #[test]
    fn random_relaxation_moduli_are_the_same_material_as_their_creep_compliance() {
        let mut random = Random(1);
        for case in 0..600 {
            let spread = [0.0, 1.0, 6.0, 12.0][case % 4];
            let relaxation = random.relaxation(1 + case % 30, 0.0, spread, case % 3 > 0);
            assert_one_material(&relaxation, &relaxation.to_creep().unwrap());
        }
    }

    #[test]
    fn random_creep_compliances_are_the_same_material_as_their_relaxation_modulus() {
        let mut random = Random(2);
        for case in 0..600 {
            let spread = [0.0, 1.0, 6.0, 12.0][case % 4];
            let creep = random.creep(1 + case % 30, 0.0, spread, case % 3 > 0);
            assert_one_material(&creep.to_relaxation().unwrap(), &creep);
        }
    }

    // A round trip can only return what doubles hold. Two strong branches whose times differ by a
    // relative gap meet again with moduli uncertain by about eps/gap (seen: up to 5 eps/gap), so
    // 1e-10 asks for a gap above 1e-5; the tests take 1e-4. Weak branches are no such obstacle:
    // their compliance carries the information. Nearer times are tested through the functions.
    const IDENTIFIABLE_GAP: f64 = 1e-4;
    const ROUND_TRIP_TOLERANCE: f64 = 1e-10;

    #[test]
    fn relaxation_to_creep_and_back_returns_moduli_and_times() {
        let mut random = Random(3);
        for case in 0..600 {
            let spread = [0.0, 1.0, 6.0, 12.0][case % 4];
            let count = 1 + case % 30;
            let given = random.relaxation(count, IDENTIFIABLE_GAP, spread, case % 3 > 0);
            let back = given.to_creep().unwrap().to_relaxation().unwrap();
            assert_relative_eq!(
                back.equilibrium_modulus(),
                given.equilibrium_modulus(),
                max_relative = ROUND_TRIP_TOLERANCE
            );
            assert_eq!(back.branches().len(), given.branches().len());
            for (found, branch) in back.branches().iter().zip(given.branches()) {
                let modulus = relative_difference(found.modulus_pa, branch.modulus_pa);
                assert!(modulus < ROUND_TRIP_TOLERANCE, "modulus off by {modulus:e}");
                // Times are zeros, found to a few roundings whatever the gap.
                assert!(relative_difference(found.time_s, branch.time_s) < 1e-14);
            }
        }
    }

    #[test]
    fn creep_to_relaxation_and_back_returns_compliances_and_times() {
        let mut random = Random(4);
        for case in 0..600 {
            let spread = [0.0, 1.0, 6.0, 12.0][case % 4];
            let given = random.creep(1 + case % 30, IDENTIFIABLE_GAP, spread, case % 3 > 0);
            let back = given.to_relaxation().unwrap().to_creep().unwrap();
            let instantaneous = back.instantaneous_compliance();
            // Sums and reciprocals of positive numbers only.
            assert_relative_eq!(
                instantaneous,
                given.instantaneous_compliance(),
                max_relative = FUNCTION_TOLERANCE
            );
            assert_eq!(back.branches().len(), given.branches().len());
            for (found, branch) in back.branches().iter().zip(given.branches()) {
                let compliance =
                    relative_difference(found.compliance_per_pa, branch.compliance_per_pa);
                assert!(
                    compliance < ROUND_TRIP_TOLERANCE,
                    "compliance off by {compliance:e}"
                );
                assert!(relative_difference(found.time_s, branch.time_s) < 1e-14);
            }
            assert_eq!(back.is_fluid(), given.is_fluid());
            if let Some((found, viscosity)) = back.viscosity_pa_s().zip(given.viscosity_pa_s()) {
                assert_relative_eq!(found, viscosity, max_relative = FUNCTION_TOLERANCE);
            }
        }
    }

    #[test]
    fn nearly_equal_times_keep_their_functions_of_time_through_a_round_trip() {
        // Gaps down to one part in 2^50: branches cannot be distinguished, E(t) and D(t) can.
        let mut random = Random(5);
        for case in 0..200 {
            let mut branches = random.relaxation(15, 0.0, 3.0, true).branches().to_vec();
            let twins: Vec<RelaxationBranch> = branches
                .iter()
                .map(|branch| RelaxationBranch {
                    modulus_pa: 1e9 * random.decades(-3.0, 0.0),
                    time_s: branch.time_s * (1.0 + random.decades(-15.0, -4.0)),
                })
                .collect();
            branches.extend(twins);
            let equilibrium = if case % 2 == 0 { 1e8 } else { 0.0 };
            let given = Relaxation::new(equilibrium, branches).unwrap();
            let creep = given.to_creep().unwrap();
            let back = creep.to_relaxation().unwrap();
            let again = back.to_creep().unwrap();
            assert_one_material(&given, &creep);
            assert_one_material(&back, &creep);
            for exponent in -32..=32 {
                // A fluid's modulus dies as exp(-t/tau): what rounding of tau does to it grows
                // like t/tau, hence times up to ten of the longest only.
                let time_s = 10f64.powf(0.25 * f64::from(exponent)).min(1e7);
                let relaxation = relative_difference(back.modulus(time_s), given.modulus(time_s));
                assert!(relaxation < 1e-12, "E({time_s:e}) off by {relaxation:e}");
                let creeping =
                    relative_difference(again.compliance(time_s), creep.compliance(time_s));
                assert!(creeping < 1e-12, "D({time_s:e}) off by {creeping:e}");
            }
        }
    }

    /// `integral over 0 to t of exp(-(t - s)/tau) exp(-s/lambda)/lambda ds`.
    fn exponential_convolution(time_s: f64, tau: f64, lambda: f64) -> f64 {
        // The slower exponential is taken out, so that expm1 has a negative argument.
        let rate = (lambda - tau).abs() / lambda / tau;
        let slower = (-time_s / tau.max(lambda)).exp();
        if rate == 0.0 {
            return slower * time_s / lambda;
        }
        slower * -(-rate * time_s).exp_m1() / (rate * lambda)
    }

    #[test]
    fn the_convolution_of_relaxation_with_creep_is_one_at_all_times() {
        // integral of E(t - s) dD(s) = 1 (Ferry 1980, chapter 3), each term in closed form.
        let mut random = Random(6);
        for case in 0..100 {
            let relaxation = random.relaxation(1 + case % 30, 0.0, 4.0, case % 2 == 0);
            let creep = relaxation.to_creep().unwrap();
            for exponent in -16..=16 {
                let time_s = 10f64.powf(0.5 * f64::from(exponent));
                let mut total = relaxation.modulus(time_s) * creep.instantaneous_compliance();
                for element in creep.branches() {
                    let rest =
                        -(-time_s / element.time_s).exp_m1() * relaxation.equilibrium_modulus();
                    let transient: f64 = relaxation
                        .branches()
                        .iter()
                        .map(|branch| {
                            branch.modulus_pa
                                * exponential_convolution(time_s, branch.time_s, element.time_s)
                        })
                        .sum();
                    total += element.compliance_per_pa * (rest + transient);
                }
                if let Some(viscosity) = creep.viscosity_pa_s() {
                    let impulse: f64 = relaxation
                        .branches()
                        .iter()
                        .map(|branch| {
                            -branch.modulus_pa * branch.time_s * (-time_s / branch.time_s).exp_m1()
                        })
                        .sum();
                    total += impulse / viscosity;
                }
                // Nine hundred positive terms. Where tau and lambda nearly meet, the stored
                // lambda has lost eps/gap of their distance, but such a term is as small.
                assert!((total - 1.0).abs() < 1e-12, "{total} at {time_s:e} s");
            }
        }
    }

    #[test]
    fn the_result_does_not_depend_on_the_units() {
        let mut random = Random(8);
        let given = random.relaxation(12, 1e-3, 3.0, true);
        let reference = given.to_creep().unwrap();
        for (stress_unit, time_unit) in [(1e6, 3600.0), (1e-12, 1e-9), (1e140, 1e-140)] {
            let branches = given.branches().iter().map(|branch| RelaxationBranch {
                modulus_pa: branch.modulus_pa / stress_unit,
                time_s: branch.time_s / time_unit,
            });
            let equilibrium = given.equilibrium_modulus() / stress_unit;
            let creep = Relaxation::new(equilibrium, branches.collect())
                .unwrap()
                .to_creep()
                .unwrap();
            for (found, branch) in creep.branches().iter().zip(reference.branches()) {
                // Inputs rounded by the change of units move compliances by eps/gap at most.
                assert_relative_eq!(
                    found.time_s * time_unit,
                    branch.time_s,
                    max_relative = 1e-14
                );
                assert_relative_eq!(
                    found.compliance_per_pa / stress_unit,
                    branch.compliance_per_pa,
                    max_relative = 1e-12
                );
            }
        }
    }

    #[test]
    fn a_branch_too_weak_for_a_double_is_left_out() {
        let branches = [(1e9, 1.0), (1e-320, 10.0), (1e9, 100.0)]
            .map(|(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s });
        let relaxation = Relaxation::new(1e9, branches.to_vec()).unwrap();
        let creep = relaxation.to_creep().unwrap();
        assert_eq!(creep.branches().len(), 2);
        assert_one_material(&relaxation, &creep);
    }

    #[test]
    fn a_solid_is_never_mistaken_for_a_fluid() {
        // Equilibrium over glassy modulus underflows: refused, not converted as if it were zero.
        let branch = RelaxationBranch {
            modulus_pa: 1e200,
            time_s: 1.0,
        };
        let relaxation = Relaxation::new(1e-200, vec![branch]).unwrap();
        assert!(matches!(
            relaxation.to_creep(),
            Err(MaterialError::OutOfRange { .. })
        ));
        let creep = Creep::new(1e10, vec![], Some(1e300)).unwrap();
        assert!(matches!(
            creep.to_relaxation(),
            Err(MaterialError::OutOfRange { .. })
        ));
    }

    #[test]
    fn a_time_beyond_the_range_of_a_double_is_refused() {
        // lambda = tau (g_inf + g)/g_inf = 1e400 s.
        let branch = RelaxationBranch {
            modulus_pa: 1.0,
            time_s: 1e200,
        };
        let relaxation = Relaxation::new(1e-200, vec![branch]).unwrap();
        assert!(matches!(
            relaxation.to_creep(),
            Err(MaterialError::OutOfRange { .. })
        ));
    }
}
