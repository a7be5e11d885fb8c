//! An elastic layer on a base in place of the half-space, without friction under the indenter.
//!
//! A pressure that is a wave of wave number k bends the surface of a layer of thickness h into the same wave, smaller than that of
//! a half-space of the same material by the softening S(kh). With x = kh, for a layer bonded to the base (G. Carbone and L. Mangialardi,
//! J. Mech. Phys. Solids 56 (2008) 684), and for one that slides on it without friction (K. L. Johnson, Contact Mechanics (1985),
//! section 5.8), each on a rigid base, and for one bonded to a half-space that yields (T. C. O'Sullivan and R. B. King, J. Tribology 110
//! (1988) 235; mu the shear modulus of the layer over that of the base, nu' the Poisson ratio of the base, theta = exp(-2x)):
//!
//! ```text
//! bonded        S(x) = [(3 - 4 nu) sinh 2x - 2x] / [5 + 2x^2 - 4 nu (3 - 2 nu) + (3 - 4 nu) cosh 2x]
//! frictionless  S(x) = (cosh 2x - 1) / (sinh 2x + 2x)
//! base yields   S(x) = [1 + 4 kappa x theta - lambda kappa theta^2] / [1 - (lambda + kappa + 4 kappa x^2) theta + lambda kappa theta^2]
//!               lambda = 1 - 4 (1 - nu) / [1 + mu (3 - 4 nu')],   kappa = (mu - 1) / (mu + 3 - 4 nu)
//! ```
//!
//! A point load P then moves the surface at the distance r by `C P / (pi h) [1/s + phi(s)]`, s = r/h, where the first term is that of the
//! half-space and the second, without singularity, what the base takes away:
//!
//! ```text
//! phi(s) = integral from 0 to infinity of (S(x) - 1) J0(x s) dx = (2/pi) integral from 0 to pi/2 of kappa(s sin t) dt
//! kappa(z) = integral from 0 to infinity of (S(x) - 1) cos(x z) dx
//! ```
//!
//! S - 1 decays like x^2 exp(-2x), so that phi is analytic but for a singularity at s = 2i and its like farther off: it is
//! tabulated once by Chebyshev polynomials. On a rigid base both terms together decay exponentially, with signs that change where the
//! surface rises beside the load; beyond `REACH` they are less than rounding, and taken as nothing. Where the base yields, S(0) is the
//! compliance of the base over that of the layer, and far from the load what is left are powers, from those of S of even order:
//!
//! ```text
//! 1/s + phi(s) = S_0 / s - S_2 / s^3 + 9 S_4 / s^5 - 225 S_6 / s^7 + ...,   S(x) = S_0 + S_1 x + S_2 x^2 + ...
//! ```

use std::f64::consts::{FRAC_PI_2, PI};

use serde::{Deserialize, Serialize};

use crate::words;

use super::love::{GAUSS_8, quadrature, rectangle_displacement_m, rule_at};

words! {
    /// How a layer lies on its rigid base.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Base {
        /// The layer cannot move along the base.
        Bonded = "bonded",
        /// The layer slides along the base, and cannot leave it.
        Frictionless = "frictionless",
    }
}

/// A base that yields: a half-space that relaxes in proportion to the layer on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YieldingBase {
    /// Its shear modulus over that of the layer, from [`YieldingBase::SOFTEST`] to [`YieldingBase::STIFFEST`].
    pub modulus_ratio: f64,
    /// Above -1 and at most 0.5.
    pub poisson_ratio: f64,
}

impl YieldingBase {
    /// Below, the base is seen through the layer over tens of thousands of thicknesses.
    pub const SOFTEST: f64 = 0.01;
    /// Above, the base is as good as rigid.
    pub const STIFFEST: f64 = 1e6;
}

/// An elastic layer on a base, without end to all sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Positive and finite, m.
    pub thickness_m: f64,
    pub base: Base,
    /// What the base is made of, where it is not rigid; the layer is then bonded to it.
    pub yielding: Option<YieldingBase>,
    /// Above -1 and at most 0.5. Of a layer that slides on its base nothing depends on it but the contact compliance.
    pub poisson_ratio: f64,
}

/// Where S - 1 is less than rounding.
const LONGEST: f64 = 24.0;
/// Distance, in thicknesses, beyond which a load does not move the surface on a rigid base: displacements fall like exp(-0.76 s) where
/// they fall slowest, on a bonded layer of Poisson ratio 0.5.
const REACH: f64 = 48.0;
/// Powers of s that are left beyond it where the base yields.
const POWERS: usize = 9;

impl Layer {
    /// S(x) at the wave number x = kh >= 0: on a rigid base it rises from 0 to 1.
    pub fn softening(&self, x: f64) -> f64 {
        if x > LONGEST {
            return 1.0;
        }
        if let Some(welded) = self.welded() {
            return welded.softening(x);
        }
        let twice = 2.0 * x;
        match self.base {
            Base::Bonded => {
                let nu = self.poisson_ratio;
                let less = (2.0 - 4.0 * nu) * twice.sinh() + sinh_less_linear(twice);
                less / (self.constant() + twice * x + (3.0 - 4.0 * nu) * twice.cosh())
            }
            Base::Frictionless if x == 0.0 => 0.0,
            Base::Frictionless => 2.0 * x.sinh().powi(2) / (twice.sinh() + twice),
        }
    }

    /// 5 - 4 nu (3 - 2 nu).
    fn constant(&self) -> f64 {
        5.0 - 4.0 * self.poisson_ratio * (3.0 - 2.0 * self.poisson_ratio)
    }

    /// S(x) - 1, without cancellation, x > 0.
    pub fn softening_less_one(&self, x: f64) -> f64 {
        if let Some(welded) = self.welded() {
            return welded.softening_less_one(x);
        }
        let small = (-2.0 * x).exp();
        match self.base {
            Base::Bonded => {
                let branch = 3.0 - 4.0 * self.poisson_ratio;
                let above = branch * small + self.constant() + 2.0 * x + 2.0 * x * x;
                let below =
                    (self.constant() + 2.0 * x * x) * small + 0.5 * branch * (1.0 + small * small);
                -above * small / below
            }
            Base::Frictionless => {
                let above = 2.0 * x - (-2.0 * x).exp_m1();
                -above * small / (-0.5 * (-4.0 * x).exp_m1() + 2.0 * x * small)
            }
        }
    }
}

impl Layer {
    fn welded(&self) -> Option<Welded> {
        let base = self.yielding?;
        let mu = base.modulus_ratio.recip();
        let own = 4.0 * (1.0 - self.poisson_ratio);
        let across = 1.0 + mu * (3.0 - 4.0 * base.poisson_ratio);
        Some(Welded {
            lambda: 1.0 - own / across,
            kappa: (mu - 1.0) / (mu + own - 1.0),
            one_less_lambda: own / across,
            one_less_kappa: own / (mu + own - 1.0),
        })
    }
}

/// Mismatch of a layer and the base that it is bonded to: both 0 of equal materials.
#[derive(Debug, Clone, Copy)]
struct Welded {
    lambda: f64,
    kappa: f64,
    one_less_lambda: f64,
    one_less_kappa: f64,
}

impl Welded {
    fn softening(&self, x: f64) -> f64 {
        let Self { lambda, kappa, .. } = *self;
        let small = (-2.0 * x).exp();
        if x > 1.0 {
            let above = 1.0 + (4.0 * x - lambda * small) * kappa * small;
            return above / self.below(x);
        }
        // Without the terms that cancel where the waves are long: 1 - theta^2 = 2 theta sinh 2x.
        let product = self.one_less_lambda + lambda * self.one_less_kappa;
        let twice = 2.0 * x;
        let rise = (1.0 + lambda) * twice.sinh() - sinh_less_linear(twice);
        (product + 2.0 * kappa * small * rise) / self.below(x)
    }

    fn softening_less_one(&self, x: f64) -> f64 {
        let Self { lambda, kappa, .. } = *self;
        let small = (-2.0 * x).exp();
        // lambda + kappa - 2 lambda kappa theta, which cancels on a soft base where the waves are long.
        let mismatch = lambda * self.one_less_kappa + kappa * self.one_less_lambda
            - 2.0 * lambda * kappa * (-2.0 * x).exp_m1();
        (4.0 * kappa * x * (1.0 + x) + mismatch) * small / self.below(x)
    }

    /// The denominator of S.
    fn below(&self, x: f64) -> f64 {
        let Self { lambda, kappa, .. } = *self;
        let small = (-2.0 * x).exp();
        if x > 1.0 {
            return 1.0 - (lambda + kappa + 4.0 * kappa * x * x - lambda * kappa * small) * small;
        }
        // (1 - lambda theta) (1 - kappa theta) - 4 kappa x^2 theta, with (1 - theta)^2 = 4 theta sinh^2 x.
        let (lambdas, kappas) = (self.one_less_lambda, self.one_less_kappa);
        let rise = -(-2.0 * x).exp_m1();
        let bend = lambda * sinh_less_linear(x) * (x.sinh() + x) - lambdas * x * x;
        lambdas * kappas + (lambdas * kappa + kappas * lambda) * rise + 4.0 * kappa * small * bend
    }

    /// S_0, S_2, S_4, ...: what S is where the waves are long.
    fn even_powers(&self) -> [f64; POWERS] {
        const ORDERS: usize = 2 * POWERS - 1;
        let Self { lambda, kappa, .. } = *self;
        let exponential = |rate: f64| {
            let mut term = 1.0;
            std::array::from_fn::<f64, ORDERS, _>(|n| {
                term *= if n == 0 { 1.0 } else { rate / n as f64 };
                term
            })
        };
        let (small, squared) = (exponential(-2.0), exponential(-4.0));
        let at = |series: &[f64; ORDERS], n: usize, lower: usize| match n.checked_sub(lower) {
            Some(n) => series[n],
            None => 0.0,
        };
        let below = |n: usize| match n {
            0 => self.one_less_lambda * self.one_less_kappa,
            _ => {
                lambda * kappa * squared[n]
                    - (lambda + kappa) * small[n]
                    - 4.0 * kappa * at(&small, n, 2)
            }
        };
        let above = |n: usize| match n {
            0 => self.one_less_lambda + lambda * self.one_less_kappa,
            _ => 4.0 * kappa * at(&small, n, 1) - lambda * kappa * squared[n],
        };
        let mut series = [0.0; ORDERS];
        for n in 0..ORDERS {
            let known: f64 = (1..=n).map(|j| below(j) * series[n - j]).sum();
            series[n] = (above(n) - known) / below(0);
        }
        std::array::from_fn(|m| series[2 * m])
    }
}

/// What is left of the displacement far from a load.
#[derive(Debug, Clone, Copy)]
struct Far {
    /// Distance in thicknesses from which it holds.
    reach: f64,
    /// Of s^-1, s^-3, s^-5, ...; none on a rigid base.
    coefficients: [f64; POWERS],
}

impl Far {
    fn of(layer: &Layer) -> Self {
        /// Of the displacement on the softer of the two bodies, beyond the reach.
        const ROUNDING: f64 = 1e-12;
        let Some(welded) = layer.welded() else {
            return Self {
                reach: REACH,
                coefficients: [0.0; POWERS],
            };
        };
        let powers = welded.even_powers();
        let mut factor = 1.0;
        let coefficients = std::array::from_fn(|m| {
            let odd = 2.0 * m as f64 - 1.0;
            factor *= if m == 0 { 1.0 } else { -odd * odd };
            factor * powers[m]
        });
        let last = coefficients[POWERS - 1].abs() / coefficients[0].max(1.0);
        // Where the last power is rounding; where the base is stiff, the exponential decay decides.
        let reach = (last / ROUNDING).powf(0.5 / (POWERS - 1) as f64);
        Self {
            reach: reach.max(REACH).ceil(),
            coefficients,
        }
    }

    /// 1/s + phi(s).
    fn at(&self, s: f64) -> f64 {
        let square = (s * s).recip();
        let coefficients = self.coefficients.iter().rev();
        coefficients.fold(0.0, |sum, coefficient| sum * square + coefficient) / s
    }

    fn is_nothing(&self) -> bool {
        self.coefficients[0] == 0.0
    }
}

/// sinh x - x, to rounding also where x is small.
fn sinh_less_linear(x: f64) -> f64 {
    if x > 1.0 {
        return x.sinh() - x;
    }
    let square = x * x;
    // x^3/3! (1 + x^2/(4 5) (1 + x^2/(6 7) (...))).
    let series = (2..=9).rev().fold(1.0, |inner, k| {
        let k = f64::from(2 * k);
        1.0 + square / (k * (k + 1.0)) * inner
    });
    x * square / 6.0 * series
}

/// A function of a variable z >= 0 by Chebyshev polynomials of u = asinh(z/2) on panels of equal width: the nearest singularities, at
/// z = 2i and its like, are those of u at a distance of pi/2, however far out the panel.
#[derive(Debug, Clone)]
struct Panels(Vec<[f64; NODES]>);

/// 16^-14 is left of a function on panels an eighth of the distance of its singularity to either side.
const PANEL: f64 = 0.4;
const NODES: usize = 15;

impl Panels {
    /// From 0 to the reach, from what there is of the function up to the end of each panel.
    fn of<F: Fn(f64) -> f64>(reach: f64, up_to: impl Fn(f64) -> F) -> Self {
        let angle = |node: usize| PI * (node as f64 + 0.5) / NODES as f64;
        let place = |u: f64| 2.0 * (PANEL * u).sinh();
        let panel = |panel: usize| {
            let function = up_to(place(panel as f64 + 1.0));
            let values: [f64; NODES] = std::array::from_fn(|node| {
                function(place(panel as f64 + 0.5 + 0.5 * angle(node).cos()))
            });
            std::array::from_fn(|order| {
                let sum: f64 = (0..NODES)
                    .map(|node| values[node] * (order as f64 * angle(node)).cos())
                    .sum();
                let weight = if order == 0 { 1.0 } else { 2.0 };
                weight * sum / NODES as f64
            })
        };
        let panels = ((0.5 * reach).asinh() / PANEL).ceil();
        Self((0..panels as usize).map(panel).collect())
    }

    /// The function at a place not beyond the reach.
    fn at(&self, place: f64) -> f64 {
        let scaled = (0.5 * place).asinh() / PANEL;
        let panel = (scaled as usize).min(self.0.len() - 1);
        let x = 2.0 * (scaled - panel as f64) - 1.0;
        // Clenshaw's recurrence.
        let coefficients = &self.0[panel];
        let (mut one, mut two) = (0.0, 0.0);
        for coefficient in coefficients[1..].iter().rev() {
            (one, two) = (2.0 * x * one - two + coefficient, one);
        }
        x * one - two + coefficients[0]
    }
}

/// The influence of loads on the surface of one layer, tabulated.
#[derive(Debug, Clone)]
pub struct LayerInfluence {
    layer: Layer,
    /// phi(s).
    rest: Panels,
    far: Far,
}

impl LayerInfluence {
    /// Tabulates; a hundredth of a second, and one where a stiff layer lies on a soft base.
    pub fn new(layer: Layer) -> Self {
        let far = Far::of(&layer);
        let kappa = Panels::of(far.reach, |farthest| {
            let waves = waves(&layer, farthest);
            move |z| {
                let terms = waves.iter();
                terms.map(|(x, value)| value * (x * z).cos()).sum()
            }
        });
        let rest = Panels::of(far.reach, |_| {
            |s: f64| {
                // The integrand is periodic and even about both ends: midpoints converge exponentially, once they resolve it.
                let count = 32 + 8 * s.ceil() as usize;
                let angle = |k: usize| FRAC_PI_2 * (k as f64 + 0.5) / count as f64;
                let sum: f64 = (0..count).map(|k| kappa.at(s * angle(k).sin())).sum();
                sum / count as f64
            }
        });
        Self { layer, rest, far }
    }

    /// The layer.
    pub fn layer(&self) -> &Layer {
        &self.layer
    }

    /// As [`rectangle_displacement_m`], on the layer.
    pub fn rectangle_displacement_m(
        &self,
        x_m: f64,
        y_m: f64,
        half_x_m: f64,
        half_y_m: f64,
    ) -> f64 {
        let thickness_m = self.layer.thickness_m;
        let [x, y, a, b] =
            [x_m.abs(), y_m.abs(), half_x_m, half_y_m].map(|side| side / thickness_m);
        thickness_m * self.over((x, y), (a, b))
    }

    /// The same in thicknesses. Rectangles that are long beside the distance over which the displacement changes are parted: as a
    /// whole, the half-space's part and what the base takes away would cancel.
    fn over(&self, (x, y): (f64, f64), (a, b): (f64, f64)) -> f64 {
        /// Distance of the singularity from the real axis.
        const SINGULAR: f64 = 2.0;
        let near = (x.abs() - a).max(0.0).hypot((y.abs() - b).max(0.0));
        if near >= self.far.reach && self.far.is_nothing() {
            return 0.0;
        }
        let longest = 2.0 * a.max(b);
        if let Some(rule) = rule_at(near.hypot(SINGULAR) / longest) {
            let reach = self.far.reach;
            let rest = |squared: f64| {
                let s = squared.sqrt();
                match s < reach {
                    true => self.rest.at(s),
                    false => self.far.at(s) - s.recip(),
                }
            };
            let rest = quadrature((x, y), (a, b), rule, rest);
            return rectangle_displacement_m(x, y, a, b) + rest / PI;
        }
        let half = |side: f64, other: f64| match side > 0.5 * other {
            true => (0.5 * side, vec![-0.5 * side, 0.5 * side]),
            false => (side, vec![0.0]),
        };
        let ((half_a, along_x), (half_b, along_y)) = (half(a, b), half(b, a));
        let parts = along_y.iter().flat_map(|dy| {
            let part = move |dx: &f64| self.over((x + dx, y + dy), (half_a, half_b));
            along_x.iter().map(part)
        });
        parts.sum()
    }
}

/// Wave numbers x = kh, and S(x) - 1 times the weight of a quadrature over them, for integrands that oscillate up to `cos(farthest x)`.
pub(crate) fn waves(layer: &Layer, farthest: f64) -> Vec<(f64, f64)> {
    /// What the fastest integrand turns by (rad) within each piece, of which 8 points leave 1e-18.
    const TURN: f64 = 2.25;
    let widest = (TURN / farthest).min(0.1);
    // On a soft base S falls within a wave number of about the stiffness of the base.
    let first = layer.softening(0.0).max(1.0).recip();
    let mut waves = Vec::new();
    let mut from = 0.0;
    while from < LONGEST {
        let half = 0.5 * widest.min(0.25 * (from + first));
        for &(node, weight) in &GAUSS_8 {
            for node in [-node, node] {
                let x = from + half * (1.0 + node);
                waves.push((x, half * weight * layer.softening_less_one(x)));
            }
        }
        from += 2.0 * half;
    }
    waves
}

#[cfg(test)]
mod tests {
    use super::*;

    fn influence(base: Base, poisson_ratio: f64, thickness_m: f64) -> LayerInfluence {
        LayerInfluence::new(Layer {
            thickness_m,
            base,
            yielding: None,
            poisson_ratio,
        })
    }

    const KINDS: [(Base, f64); 6] = [
        (Base::Bonded, -0.5),
        (Base::Bonded, 0.0),
        (Base::Bonded, 0.3),
        (Base::Bonded, 0.45),
        (Base::Bonded, 0.5),
        (Base::Frictionless, 0.3),
    ];

    #[test]
    fn the_softening_rises_from_nothing_to_one_and_both_forms_of_it_agree() {
        for (base, poisson_ratio) in KINDS {
            let layer = *influence(base, poisson_ratio, 1e-3).layer();
            let mut before = 0.0;
            for k in -60..=15 {
                let x = 10_f64.powf(0.1 * f64::from(k));
                let (softening, less_one) = (layer.softening(x), layer.softening_less_one(x));
                assert!(
                    (softening - 1.0 - less_one).abs() < 4.0 * f64::EPSILON,
                    "{base:?} {x}"
                );
                assert!(
                    softening > before || softening == 1.0,
                    "{base:?} {poisson_ratio} {x}"
                );
                before = softening;
            }
            assert!(layer.softening(0.0) == 0.0 && before == 1.0);
            // Long waves: plane strain h/E* where the layer slides, h/M where it is bonded, 2 x^3/3 where it has no volume to lose.
            let (x, nu) = (1e-4, poisson_ratio);
            let limit = match base {
                Base::Frictionless => 0.5 * x,
                Base::Bonded if nu == 0.5 => 2.0 / 3.0 * x * x * x,
                Base::Bonded => 0.5 * x * (1.0 - 2.0 * nu) / ((1.0 - nu) * (1.0 - nu)),
            };
            // The next term is x^2 of it, ten times that next to 0.5.
            assert!(
                (layer.softening(x) / limit - 1.0).abs() < 1e-6,
                "{base:?} {nu}"
            );
        }
    }

    #[test]
    fn a_wide_patch_sinks_by_the_compression_of_the_layer_and_a_small_one_as_on_the_half_space() {
        for (base, nu) in KINDS {
            let thickness_m = 1e-3;
            let layer = influence(base, nu, thickness_m);
            // Beyond REACH on all sides nothing of the edge is left.
            let wide_m = 50.0 * thickness_m;
            let found_m = layer.rectangle_displacement_m(0.0, 0.0, wide_m, 1.2 * wide_m);
            let per_thickness = match base {
                Base::Frictionless => 1.0,
                Base::Bonded => (1.0 - 2.0 * nu) / ((1.0 - nu) * (1.0 - nu)),
            };
            // Sums of some thousand parts of about one thickness.
            let error = found_m / thickness_m - per_thickness;
            assert!(error.abs() < 1e-12, "{base:?} {nu} {error:e}");
            let small_m = 1e-9 * thickness_m;
            let on_layer = layer.rectangle_displacement_m(small_m, 0.0, small_m, small_m);
            let on_half_space = rectangle_displacement_m(small_m, 0.0, small_m, small_m);
            // The base takes away about the side over the thickness.
            assert!((on_layer / on_half_space - 1.0).abs() < 5e-9);
        }
    }

    #[test]
    fn a_rectangle_is_the_sum_of_its_parts_however_large_it_is_beside_the_thickness() {
        for (base, nu) in KINDS {
            let layer = influence(base, nu, 1e-3);
            for side_m in [1e-5, 1e-4, 7e-4, 3e-3, 2e-2, 1.0] {
                for (x, y) in [(0.0, 0.0), (1.0, 0.0), (2.0, 3.0), (17.0, 5.0)] {
                    let (x_m, y_m, half_m) = (x * side_m, y * side_m, 0.5 * side_m);
                    let whole_m = layer.rectangle_displacement_m(x_m, y_m, half_m, half_m);
                    let parts = (0..9).map(|part| {
                        let third = side_m / 3.0;
                        let at = |k: usize| (k as f64 - 1.0) * third;
                        let (dx, dy) = (at(part % 3), at(part / 3));
                        layer.rectangle_displacement_m(x_m + dx, y_m + dy, third / 2.0, third / 2.0)
                    });
                    let parts_m: f64 = parts.sum();
                    let own_m = layer
                        .rectangle_displacement_m(0.0, 0.0, half_m, half_m)
                        .abs();
                    let error = (whole_m - parts_m).abs() / own_m.max(1e-3 * side_m.min(1e-3));
                    assert!(error < 1e-11, "{base:?} {nu} {side_m} {x} {error:e}");
                }
            }
        }
    }

    #[test]
    fn beside_a_load_the_surface_of_a_layer_rises_and_far_from_it_does_not_move() {
        let layer = influence(Base::Bonded, 0.5, 1e-3);
        let at = |x_m: f64| layer.rectangle_displacement_m(x_m, 0.0, 5e-5, 5e-5);
        assert!(at(0.0) > 0.0 && at(2e-3) < 0.0);
        assert_eq!(at(0.06), 0.0);
        // What is cut off there is rounding of what is nearer.
        assert!(at(0.0478).abs() < 1e-15 * at(0.0));
    }

    fn on_yielding(modulus_ratio: f64, [own, of_base]: [f64; 2]) -> Layer {
        Layer {
            thickness_m: 1e-3,
            base: Base::Bonded,
            yielding: Some(YieldingBase {
                modulus_ratio,
                poisson_ratio: of_base,
            }),
            poisson_ratio: own,
        }
    }

    const RATIOS: [f64; 7] = [0.01, 0.06, 0.3, 1.0, 3.0, 100.0, 1e6];

    #[test]
    fn a_base_that_yields_is_the_layer_itself_where_equal_and_rigid_where_stiff() {
        for nu in [-0.5, 0.0, 0.3, 0.5] {
            let (equal, stiff) = (on_yielding(1.0, [nu, nu]), on_yielding(1e12, [nu, 0.3]));
            let rigid = *influence(Base::Bonded, nu, 1e-3).layer();
            for k in -20..=15 {
                let x = 10_f64.powf(0.1 * f64::from(k));
                assert!((equal.softening(x) - 1.0).abs() < 1e-15, "{nu} {x}");
                let off = stiff.softening(x) - rigid.softening(x);
                // The base takes a trillionth.
                assert!(off.abs() < 1e-11, "{nu} {x} {off:e}");
            }
        }
    }

    #[test]
    fn long_waves_see_the_base_alone_and_all_forms_of_the_softening_agree() {
        for ratio in RATIOS {
            for nus in [[0.0, 0.5], [0.3, 0.3], [0.5, 0.2]] {
                let layer = on_yielding(ratio, nus);
                let base = (1.0 - nus[1]) / (1.0 - nus[0]) / ratio;
                let off = layer.softening(0.0) - base;
                assert!(off.abs() < 1e-14 * base.max(1.0), "{ratio} {nus:?}");
                for k in -60..=13 {
                    let x = 10_f64.powf(0.1 * f64::from(k));
                    let (softening, less_one) = (layer.softening(x), layer.softening_less_one(x));
                    let off = softening - 1.0 - less_one;
                    // Rounding of terms of the size of the base's compliance.
                    assert!(
                        off.abs() < 1e-14 * base.max(1.0),
                        "{ratio} {nus:?} {x} {off:e}"
                    );
                    assert!(softening > 0.0);
                }
                // Both sides of where one form takes over from the other.
                let step = layer.softening(1.0) - layer.softening(1.0 + 1e-12);
                assert!(step.abs() < 1e-10 * layer.softening(1.0), "{ratio} {nus:?}");
            }
        }
    }

    #[test]
    fn far_from_a_load_the_powers_go_on_from_the_table() {
        for ratio in RATIOS {
            let influence = LayerInfluence::new(on_yielding(ratio, [0.4, 0.3]));
            let (far, reach) = (influence.far, influence.far.reach);
            for back in [1e-6, 1.0, 3.0] {
                let s = reach - back;
                let table = influence.rest.at(s) + s.recip();
                // The table holds phi, which is 1/s less: its rounding. And what the last power leaves a little nearer.
                let off = (table - far.at(s)) * s / far.coefficients[0].max(1.0);
                assert!(off.abs() < 1e-11, "{ratio} {back} {off:e}");
            }
            // Far beyond, the layer is not seen.
            let point = far.at(1e8) * 1e8 / far.coefficients[0];
            assert!((point - 1.0).abs() < 1e-9, "{ratio}");
        }
    }

    #[test]
    fn a_rectangle_on_a_yielding_base_is_the_sum_of_its_parts() {
        for ratio in [0.01, 0.5, 20.0] {
            let layer = LayerInfluence::new(on_yielding(ratio, [0.45, 0.3]));
            for side_m in [1e-4, 3e-3, 0.3] {
                for (x, y) in [(0.0, 0.0), (2.0, 3.0), (70.0, 5.0)] {
                    let (x_m, y_m, half_m) = (x * side_m, y * side_m, 0.5 * side_m);
                    let whole_m = layer.rectangle_displacement_m(x_m, y_m, half_m, half_m);
                    let part_m = |part: usize| {
                        let third = side_m / 3.0;
                        let at = |k: usize| (k as f64 - 1.0) * third;
                        let (dx, dy) = (at(part % 3), at(part / 3));
                        layer.rectangle_displacement_m(x_m + dx, y_m + dy, third / 2.0, third / 2.0)
                    };
                    let parts_m: f64 = (0..9).map(part_m).sum();
                    let error = (whole_m - parts_m).abs() / (side_m * ratio.recip().max(1.0));
                    assert!(error < 1e-11, "{ratio} {side_m} {x} {error:e}");
                }
            }
        }
    }
}
