//! The rough surface: random, isotropic and self-affine, made by its power spectrum from a seed; on its own or on a sphere.
//!
//! With the wave number q in units of 2 pi / side, the power spectral density of the heights is
//!
//! ```text
//! C(q) = C0                        for 0 < q <= side / roll-off wavelength
//! C(q) = C0 (q / q_roll)^(-2 - 2H) up to q = side / cut-off wavelength, and 0 beyond
//! ```
//!
//! (B. N. J. Persson et al., J. Phys.: Condens. Matter 17 (2005) R1; T. D. B. Jacobs, T. Junge and L. Pastewka, Surf. Topogr.:
//! Metrol. Prop. 5 (2017) 013001). Every Fourier coefficient is a complex Gaussian number of variance C(q), and all are then
//! scaled together so that the root mean square of the heights over the period is the one asked for. The surface is periodic
//! with the side of the map.
//!
//! The number of a wave vector comes from a hash (the finaliser of SplitMix64, G. L. Steele et al., OOPSLA 2014) of the seed
//! and that wave vector alone, and phases count from the centre of the map. The surface is therefore a function of the plane:
//! with side, spectrum and seed kept, more cells sample the same function more finely. Transforms use scalar arithmetic in
//! a fixed order, so that the same seed gives the same surface bit for bit, whatever vector units the processor has.

use std::ops::RangeInclusive;

use num_complex::Complex;

use super::{HeightMap, IndenterError, LENGTH, MapEdge, MapQuantity, in_range};
use crate::block;
use crate::quantity::block::Block as _;
use crate::quantity::key::{Kind, number};

/// Cells per side.
pub(super) const CELLS: RangeInclusive<usize> = 8..=4096;

block! {
    /// A random self-affine surface.
    #[derive(Copy)]
    pub struct Roughness in "rough" {
        /// Points per side.
        cells: usize => "cells", Kind::Integer(CELLS);
        /// Distance between points.
        spacing_m: f64 => "spacing", LENGTH;
        /// Hurst exponent of the self-affine spectrum.
        hurst_exponent: f64 => "hurst_exponent", Kind::Number(number("0.8"));
        /// Root mean square height.
        rms_height_m: f64 => "rms_height", LENGTH;
        /// Shortest wavelength.
        cut_off_wavelength_m: f64 => "cut_off_wavelength", LENGTH;
        /// Seed of the random phases: the same seed gives the same surface.
        seed: u64 => "seed", Kind::Integer(0..=i64::MAX as usize);
        /// What lies outside the map: unknown, so the contact must stay within; nothing (`rim`); or periodic repetitions of the map
        /// (`periodic`), under a prescribed load.
        edge: MapEdge = MapEdge::Unknown => "edge", Kind::Word(MapEdge::WORDS);
        /// Wavelength above which the spectrum is flat; left out: no such limit.
        roll_off_wavelength_m: Option<f64> = None => "roll_off_wavelength", LENGTH;
        /// Radius of a sphere under the roughness; left out: the surface is nominally flat.
        sphere_radius_m: Option<f64> = None => "sphere_radius", LENGTH;
    }
}

impl Roughness {
    /// The rigid indenter with this surface; positive heights point towards the half-space, and the least gap counts as 0.
    ///
    /// # Errors
    /// [`IndenterError`] for lengths that are none, a Hurst exponent outside 0 to 1, a number of cells outside 8 to 4096, and
    /// wavelengths that do not obey 2 spacing <= cut-off < roll-off <= side.
    pub fn map(&self) -> Result<HeightMap, IndenterError> {
        check(self)?;
        let (n, spacing_m) = (self.cells, self.spacing_m);
        let mut heights_m = heights_m(self);
        if let Some(radius_m) = self.sphere_radius_m {
            let at = |i: usize| (i as f64 - 0.5 * (n as f64 - 1.0)) * spacing_m;
            for (index, height) in heights_m.iter_mut().enumerate() {
                let (x_m, y_m) = (at(index % n), at(index / n));
                *height -= (x_m * x_m + y_m * y_m) / (2.0 * radius_m);
            }
        }
        let (spacing_m, heights) = ((spacing_m, spacing_m), MapQuantity::Height);
        let map = HeightMap::new((n, n), spacing_m, heights_m, heights, self.edge)?;
        Ok(map.made_from(Self::NAME, self.settings().collect()))
    }
}

fn check(roughness: &Roughness) -> Result<(), IndenterError> {
    let cells = roughness.cells;
    if !CELLS.contains(&cells) {
        return Err(IndenterError::RoughCells { cells });
    }
    let Roughness {
        spacing_m,
        cut_off_wavelength_m: cut_off_m,
        ..
    } = in_range(*roughness)?;
    if roughness.sphere_radius_m.is_some() && roughness.edge == MapEdge::Periodic {
        return Err(IndenterError::PeriodicSphere);
    }
    let hurst = roughness.hurst_exponent;
    if !(0.0..=1.0).contains(&hurst) {
        return Err(IndenterError::Hurst { hurst });
    }
    let side_m = cells as f64 * spacing_m;
    let roll_off_m = roughness.roll_off_wavelength_m.unwrap_or(side_m);
    // Lengths written in decimal, such as two spacings, come a rounding too small.
    const ROUNDING: f64 = 1.0 + 1e-9;
    let in_order = 2.0 * spacing_m <= cut_off_m * ROUNDING
        && cut_off_m < roll_off_m
        && roll_off_m <= side_m * ROUNDING;
    if !in_order {
        return Err(IndenterError::Wavelengths {
            spacing_m,
            cut_off_m,
            roll_off_m,
            side_m,
        });
    }
    Ok(())
}

/// Heights (m) of the roughness alone, row by row.
fn heights_m(roughness: &Roughness) -> Vec<f64> {
    let n = roughness.cells;
    let side_m = n as f64 * roughness.spacing_m;
    let roll_off = roughness
        .roll_off_wavelength_m
        .map_or(1.0, |length_m| side_m / length_m);
    // The rounding that the check allows must not lose the shortest waves.
    let cut_off = side_m / roughness.cut_off_wavelength_m * (1.0 + 1e-9);
    let amplitude = |kx: i64, ky: i64| {
        let q = (kx as f64).hypot(ky as f64);
        if q > cut_off {
            0.0
        } else {
            (q / roll_off)
                .max(1.0)
                .powf(-1.0 - roughness.hurst_exponent)
        }
    };
    // Waves of two cells are left out: a grid does not tell their phase.
    let most = (cut_off.floor() as i64).min((n as i64 - 1) / 2);
    let mut spectrum = vec![Complex::new(0.0, 0.0); n * n];
    let mut power = 0.0;
    for ky in 0..=most {
        for kx in -most..=most {
            if ky == 0 && kx <= 0 {
                continue;
            }
            let wave = amplitude(kx, ky) * gaussian(roughness.seed, kx, ky);
            power += 2.0 * wave.norm_sqr();
            // Cell 0 lies (n - 1)/2 cells from the centre, where the phase is counted from.
            let turns = -0.5 * (kx + ky) as f64 * (n as f64 - 1.0) / n as f64;
            let there = wave * Complex::from_polar(1.0, std::f64::consts::TAU * turns.fract());
            spectrum[place(kx, ky, n)] = there;
            spectrum[place(-kx, -ky, n)] = there.conj();
        }
    }
    transform(&mut spectrum, n);
    let scale = if power > 0.0 {
        roughness.rms_height_m / power.sqrt()
    } else {
        0.0
    };
    spectrum.iter().map(|z| scale * z.re).collect()
}

/// Where a wave vector stands in the spectrum.
fn place(kx: i64, ky: i64, n: usize) -> usize {
    let index = |k: i64| k.rem_euclid(n as i64) as usize;
    index(ky) * n + index(kx)
}

/// The inverse transform along both directions, without a factor. The result is transposed and transposed back.
fn transform(values: &mut [Complex<f64>], n: usize) {
    let plan = contact_dma_transforms::complex_inverse_anywhere(n);
    for _ in 0..2 {
        plan.process(values);
        for row in 0..n {
            for column in row + 1..n {
                values.swap(row * n + column, column * n + row);
            }
        }
    }
}

/// The finaliser of SplitMix64: every bit of the argument changes half the bits of the result.
fn mix(value: u64) -> u64 {
    let value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    value ^ (value >> 31)
}

/// A complex Gaussian number of variance 1 that belongs to a seed and a wave vector (G. E. P. Box and M. E. Muller, 1958).
fn gaussian(seed: u64, kx: i64, ky: i64) -> Complex<f64> {
    const STEP: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut state = mix(seed.wrapping_add(STEP));
    for k in [kx, ky] {
        state = mix(state.wrapping_add(STEP) ^ k.cast_unsigned());
    }
    // 53 bits, in (0, 1].
    let mut uniform = || {
        state = state.wrapping_add(STEP);
        ((mix(state) >> 11) + 1) as f64 / (1_u64 << 53) as f64
    };
    let radius = (-uniform().ln()).sqrt();
    Complex::from_polar(radius, std::f64::consts::TAU * uniform())
}

#[cfg(test)]
mod tests {
    use super::super::Indenter;
    use super::*;

    fn roughness(cells: usize) -> Roughness {
        Roughness {
            cells,
            spacing_m: 1e-5 / cells as f64,
            hurst_exponent: 0.8,
            rms_height_m: 2e-8,
            roll_off_wavelength_m: Some(4e-6),
            cut_off_wavelength_m: 5e-7,
            seed: 42,
            sphere_radius_m: None,
            edge: MapEdge::Unknown,
        }
    }

    fn rms_and_mean(values: &[f64]) -> (f64, f64) {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count;
        (square.sqrt(), mean)
    }

    #[test]
    fn the_same_seed_gives_the_same_surface_and_another_seed_another() {
        let one = roughness(64).map().unwrap();
        assert_eq!(one, roughness(64).map().unwrap());
        let other = Roughness {
            seed: 43,
            ..roughness(64)
        };
        let other = heights_m(&other);
        let product: f64 = heights_m(&roughness(64))
            .iter()
            .zip(&other)
            .map(|(a, b)| a * b)
            .sum();
        // Independent fields of some 20^2 strong waves: the correlation is of the order of 1/sqrt(2 * 20).
        assert!((product / (64.0 * 64.0 * 4e-16)).abs() < 0.5);
    }

    #[test]
    fn the_generator_is_the_published_one() {
        // First output of SplitMix64 from the state 0, that is the finaliser of its step.
        assert_eq!(mix(0x9e37_79b9_7f4a_7c15), 0xe220_a839_7b1d_cdaf);
    }

    #[test]
    fn the_heights_have_the_root_mean_square_asked_for_and_no_mean() {
        for cells in [45, 64] {
            let (rms, mean) = rms_and_mean(&heights_m(&roughness(cells)));
            // Sums over some thousand cells, and transforms: rounding.
            assert!((rms / 2e-8 - 1.0).abs() < 1e-12, "{rms}");
            assert!(mean.abs() < 1e-13 * rms);
        }
    }

    #[test]
    fn more_cells_sample_the_same_surface_more_finely() {
        let (coarse, fine) = (heights_m(&roughness(50)), heights_m(&roughness(150)));
        for (index, height) in coarse.iter().enumerate() {
            // The middle one of three by three cells lies where the coarse cell does.
            let (x, y) = (3 * (index % 50) + 1, 3 * (index / 50) + 1);
            assert!((height - fine[y * 150 + x]).abs() < 1e-12 * 2e-8);
        }
    }

    #[test]
    fn the_spectrum_is_flat_then_falls_as_the_hurst_exponent_says_then_ends() {
        let n = 256;
        let settings = Roughness {
            roll_off_wavelength_m: Some(1e-6),
            cut_off_wavelength_m: 1e-7,
            ..roughness(n)
        };
        let mut spectrum: Vec<_> = heights_m(&settings)
            .iter()
            .map(|&h| Complex::new(h, 0.0))
            .collect();
        transform(&mut spectrum, n);
        let mean_power = |from: f64, to: f64| {
            let (mut sum, mut count) = (0.0, 0.0);
            for ky in -127_i64..=127 {
                for kx in -127_i64..=127 {
                    if (from..to).contains(&(kx as f64).hypot(ky as f64)) {
                        sum += spectrum[place(kx, ky, n)].norm_sqr();
                        count += 1.0;
                    }
                }
            }
            sum / count
        };
        // Rings of a thousand independent exponential numbers and more: means to 5 % or so.
        let flat = mean_power(5.0, 9.5);
        assert!((mean_power(0.5, 5.0) / flat - 1.0).abs() < 0.5);
        let (low, high) = (mean_power(19.0, 21.0), mean_power(76.0, 84.0));
        let hurst = -0.5 * (high / low).ln() / 4.0_f64.ln() - 1.0;
        assert!((hurst - 0.8).abs() < 0.1, "{hurst}");
        assert!(mean_power(101.0, 127.0) < 1e-25 * flat);
    }

    #[test]
    fn a_rough_sphere_is_a_sphere_and_roughness() {
        let on_sphere = Roughness {
            sphere_radius_m: Some(1e-4),
            ..roughness(40)
        };
        let (flat, sphere) = (roughness(40).map().unwrap(), on_sphere.map().unwrap());
        let difference =
            |x: f64, y: f64| sphere.gap_m(x, y) - flat.gap_m(x, y) - (x * x + y * y) / (2.0 * 1e-4);
        let h = 1e-5 / 40.0;
        let constant = difference(0.5 * h, 0.5 * h);
        for (x, y) in [(7.5, 2.5), (-10.5, 3.5), (12.5, -15.5)] {
            assert!((difference(x * h, y * h) - constant).abs() < 1e-20);
        }
        let lowest = sphere.gaps_m().iter().copied().fold(1.0, f64::min);
        assert_eq!(lowest, 0.0);
    }

    #[test]
    fn parameters_out_of_their_range_are_refused() {
        let refused = |change: fn(&mut Roughness)| {
            let mut settings = roughness(64);
            change(&mut settings);
            settings.map().unwrap_err().to_string()
        };
        assert!(refused(|r| r.hurst_exponent = 1.1).contains("Hurst"));
        assert!(refused(|r| r.cells = 7).contains("7 cells"));
        assert!(refused(|r| r.spacing_m = f64::NAN).contains("spacing"));
        assert!(refused(|r| r.rms_height_m = 0.0).contains("rms_height"));
        assert!(refused(|r| r.sphere_radius_m = Some(-1.0)).contains("sphere_radius"));
        for change in [
            (|r| r.cut_off_wavelength_m = 3e-7) as fn(&mut Roughness),
            |r| r.cut_off_wavelength_m = 4e-6,
            |r| r.roll_off_wavelength_m = Some(1.1e-5),
        ] {
            assert!(refused(change).contains("cut-off < roll-off"));
        }
        assert!(
            Roughness {
                cut_off_wavelength_m: 2e-5 / 64.0,
                ..roughness(64)
            }
            .map()
            .is_ok()
        );
    }
}
