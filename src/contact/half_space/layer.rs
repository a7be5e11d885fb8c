//! An elastic layer on a rigid base in place of the half-space, without friction under the indenter.
//!
//! A pressure that is a wave of wave number k bends the surface of a layer of thickness h into the same wave, smaller than that of
//! a half-space of the same material by the softening S(kh). With x = kh, for a layer bonded to the base (G. Carbone and L. Mangialardi,
//! J. Mech. Phys. Solids 56 (2008) 684), and for one that slides on it without friction (K. L. Johnson, Contact Mechanics (1985),
//! section 5.8):
//!
//! ```text
//! bonded        S(x) = [(3 - 4 nu) sinh 2x - 2x] / [5 + 2x^2 - 4 nu (3 - 2 nu) + (3 - 4 nu) cosh 2x]
//! frictionless  S(x) = (cosh 2x - 1) / (sinh 2x + 2x)
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
//! tabulated once by Chebyshev polynomials. Both terms together decay exponentially, with signs that change where the surface rises
//! beside the load; beyond [`REACH`] they are less than rounding, and taken as nothing.

use std::f64::consts::{FRAC_PI_2, PI};

use serde::{Deserialize, Serialize};

use super::influence::{GAUSS_8, quadrature, rectangle_displacement_m, rule_at};

/// How a layer lies on its rigid base.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Base {
    /// The layer cannot move along the base.
    Bonded,
    /// The layer slides along the base, and cannot leave it.
    Frictionless,
}

impl Base {
    /// The name as written in a sweep file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bonded => "bonded",
            Self::Frictionless => "frictionless",
        }
    }
}

/// An elastic layer on a rigid base, without end to all sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Positive and finite, m.
    pub thickness_m: f64,
    pub base: Base,
    /// Above -1 and at most 0.5. Of a layer that slides on its base nothing depends on it but the contact compliance.
    pub poisson_ratio: f64,
}

/// Where S - 1 is less than rounding.
const LONGEST: f64 = 24.0;
/// Distance, in thicknesses, beyond which a load does not move the surface: displacements fall like exp(-0.76 s) where they fall
/// slowest, on a bonded layer of Poisson ratio 0.5.
const REACH: f64 = 48.0;

impl Layer {
    /// S(x) at the wave number x = kh >= 0: rises from 0 to 1.
    pub fn softening(&self, x: f64) -> f64 {
        if x > LONGEST {
            return 1.0;
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

/// A function of a variable from 0 to [`REACH`] by Chebyshev polynomials on panels of equal width.
#[derive(Debug, Clone)]
struct Panels(Vec<[f64; NODES]>);

/// Panels of half a thickness, four times as far from the nearest singularity as they are long: 16^-14 is left of it.
const PANELS: usize = 2 * REACH as usize;
const NODES: usize = 15;

impl Panels {
    fn of(function: impl Fn(f64) -> f64) -> Self {
        let angle = |node: usize| PI * (node as f64 + 0.5) / NODES as f64;
        let panel = |panel: usize| {
            let values: [f64; NODES] = std::array::from_fn(|node| {
                function((panel as f64 + 0.5 + 0.5 * angle(node).cos()) / 2.0)
            });
            std::array::from_fn(|order| {
                let sum: f64 = (0..NODES)
                    .map(|node| values[node] * (order as f64 * angle(node)).cos())
                    .sum();
                let weight = if order == 0 { 1.0 } else { 2.0 };
                weight * sum / NODES as f64
            })
        };
        Self((0..PANELS).map(panel).collect())
    }

    /// The function at a place not beyond [`REACH`].
    fn at(&self, place: f64) -> f64 {
        let scaled = 2.0 * place;
        let panel = (scaled as usize).min(PANELS - 1);
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
}

impl LayerInfluence {
    /// Tabulates; a tenth of a second.
    pub fn new(layer: Layer) -> Self {
        let waves = waves(&layer);
        let kappa = Panels::of(|z| {
            let terms = waves.iter();
            terms.map(|(x, value)| value * (x * z).cos()).sum()
        });
        let rest = Panels::of(|s| {
            // The integrand is periodic and even about both ends: midpoints converge exponentially, once they resolve it.
            let count = 32 + 8 * s.ceil() as usize;
            let angle = |k: usize| FRAC_PI_2 * (k as f64 + 0.5) / count as f64;
            let sum: f64 = (0..count).map(|k| kappa.at(s * angle(k).sin())).sum();
            sum / count as f64
        });
        Self { layer, rest }
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
        if near >= REACH {
            return 0.0;
        }
        let longest = 2.0 * a.max(b);
        if let Some(rule) = rule_at(near.hypot(SINGULAR) / longest) {
            let rest = |squared: f64| match squared < REACH * REACH {
                true => self.rest.at(squared.sqrt()),
                // What is left of both terms there is nothing.
                false => -squared.sqrt().recip(),
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

/// Wave numbers x, and S(x) - 1 times the weight of a quadrature over them, for integrands that oscillate up to `cos(REACH x)`.
fn waves(layer: &Layer) -> Vec<(f64, f64)> {
    /// The fastest integrand turns by 2.25 rad within each, of which 8 points leave 1e-18.
    const PIECES: usize = 512;
    let half = 0.5 * LONGEST / PIECES as f64;
    let piece = |piece: usize| {
        let middle = (2 * piece + 1) as f64 * half;
        let node = move |&(node, weight): &(f64, f64)| {
            [-node, node].map(|node| (middle + half * node, half * weight))
        };
        GAUSS_8.iter().flat_map(node)
    };
    let nodes = (0..PIECES).flat_map(piece);
    nodes
        .map(|(x, weight)| (x, weight * layer.softening_less_one(x)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn influence(base: Base, poisson_ratio: f64, thickness_m: f64) -> LayerInfluence {
        LayerInfluence::new(Layer {
            thickness_m,
            base,
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
}
