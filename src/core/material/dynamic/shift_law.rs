//! Laws of the shift factors over temperature: Williams-Landel-Ferry and Arrhenius.

use std::f64::consts::LN_10;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix2, Vector2};

use crate::numerics::roots::golden_section;

/// `log10 a_T = -c1 (T - Tr) / (c2 + T - Tr)` (M. L. Williams, R. F. Landel, J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wlf {
    pub reference_temperature_k: f64,
    pub c1: f64,
    pub c2_k: f64,
    /// Standard errors of both.
    pub c1_error: f64,
    pub c2_error_k: f64,
}

/// `ln a_T = (Ea / R) (1/T - 1/Tr)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrhenius {
    pub reference_temperature_k: f64,
    pub activation_energy_j_per_mol: f64,
    pub activation_energy_error_j_per_mol: f64,
}

/// A law that shift factors were fitted with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShiftLaw {
    Wlf(Wlf),
    Arrhenius(Arrhenius),
}

/// Gas constant (J/(mol K)), exact since 2019.
pub const GAS_CONSTANT: f64 = 8.314_462_618;

impl Wlf {
    /// As files and flags call it.
    pub const NAME: &str = "wlf";

    /// Shift factor, where the law has one: above `Tr - c2`.
    pub fn log10_a_t(&self, temperature_k: f64) -> Option<f64> {
        let above = temperature_k - self.reference_temperature_k;
        let denominator = self.c2_k + above;
        (denominator > 0.0).then(|| -self.c1 * above / denominator)
    }

    /// The same law with this reference temperature: `c1' = c1 c2 / (c2 + T - Tr)`, `c2' = c2 + T - Tr`; `None` at and below `Tr - c2`.
    /// Errors of c1 are scaled with it, as if it were independent of c2.
    pub fn referred_to(&self, temperature_k: f64) -> Option<Self> {
        let c2_k = self.c2_k + temperature_k - self.reference_temperature_k;
        let scale = self.c2_k / c2_k;
        (c2_k > 0.0).then_some(Self {
            reference_temperature_k: temperature_k,
            c1: self.c1 * scale,
            c2_k,
            c1_error: self.c1_error * scale,
            c2_error_k: self.c2_error_k,
        })
    }
}

impl From<Arrhenius> for Wlf {
    /// Exact: Arrhenius is `c1 = Ea / (R Tr ln 10)`, `c2 = Tr`.
    fn from(law: Arrhenius) -> Self {
        let per_energy = 1.0 / (GAS_CONSTANT * law.reference_temperature_k * LN_10);
        Self {
            reference_temperature_k: law.reference_temperature_k,
            c1: law.activation_energy_j_per_mol * per_energy,
            c2_k: law.reference_temperature_k,
            c1_error: law.activation_energy_error_j_per_mol * per_energy,
            c2_error_k: 0.0,
        }
    }
}

impl From<ShiftLaw> for Wlf {
    fn from(law: ShiftLaw) -> Self {
        match law {
            ShiftLaw::Wlf(law) => law,
            ShiftLaw::Arrhenius(law) => law.into(),
        }
    }
}

impl Arrhenius {
    /// As files and flags call it.
    pub const NAME: &str = "arrhenius";

    /// Shift factor.
    pub fn log10_a_t(&self, temperature_k: f64) -> f64 {
        let difference = 1.0 / temperature_k - 1.0 / self.reference_temperature_k;
        self.activation_energy_j_per_mol / GAS_CONSTANT * difference / LN_10
    }
}

impl ShiftLaw {
    /// Shift factor, where the law has one.
    pub fn log10_a_t(&self, temperature_k: f64) -> Option<f64> {
        match self {
            ShiftLaw::Wlf(law) => law.log10_a_t(temperature_k),
            ShiftLaw::Arrhenius(law) => Some(law.log10_a_t(temperature_k)),
        }
    }
}

/// Which law a hyperbola is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Wlf,
    Arrhenius,
}

/// Both laws in one form: `log10 a_T = -a x / (1 + b x)`, `x = T - T0`. WLF has `a = c1/c2`, `b = 1/c2`; Arrhenius is the
/// hyperbola with `b = 1/T0`, and so a WLF law with `c2 = T0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hyperbola {
    pub(super) form: Form,
    pub(super) origin_k: f64,
    pub(super) a: f64,
    pub(super) b: f64,
}

impl Hyperbola {
    pub(super) fn arrhenius(origin_k: f64, a: f64) -> Self {
        Self {
            form: Form::Arrhenius,
            origin_k,
            a,
            b: 1.0 / origin_k,
        }
    }

    /// Unknowns of the law: `a`, and `b` where it is not given by the form.
    pub(super) fn unknowns(&self) -> Vec<f64> {
        match self.form {
            Form::Wlf => vec![self.a, self.b],
            Form::Arrhenius => vec![self.a],
        }
    }

    /// The law with other unknowns.
    pub(super) fn with(&self, unknowns: &[f64]) -> Self {
        match (self.form, unknowns) {
            (Form::Wlf, &[a, b]) => Self { a, b, ..*self },
            (_, unknowns) => Self {
                a: unknowns.first().copied().unwrap_or(self.a),
                ..*self
            },
        }
    }

    pub(super) fn log10_a_t(&self, temperature_k: f64) -> Option<f64> {
        let x = temperature_k - self.origin_k;
        let denominator = 1.0 + self.b * x;
        (denominator > 0.0).then(|| -self.a * x / denominator)
    }

    /// Derivatives by the unknowns: a row for each temperature.
    pub(super) fn derivatives(&self, temperatures_k: &[f64]) -> DMatrix<f64> {
        DMatrix::from_fn(temperatures_k.len(), self.unknowns().len(), |i, j| {
            let x = temperatures_k[i] - self.origin_k;
            let denominator = 1.0 + self.b * x;
            match j {
                0 => -x / denominator,
                _ => self.a * (x / denominator).powi(2),
            }
        })
    }
}

/// A law through shift factors.
#[derive(Debug, Clone)]
pub(super) struct LawFit {
    pub(super) hyperbola: Hyperbola,
    /// Of the unknowns; scaled by the misfit where it is beyond the errors of the factors.
    pub(super) covariance: DMatrix<f64>,
    /// Sum of squares of what is left of the factors, in their errors.
    pub(super) squares: f64,
    /// Factors less unknowns.
    pub(super) freedom: usize,
}

impl LawFit {
    /// Whether the factors lie further from the law than four standard deviations of chance.
    pub(super) fn fails(&self) -> bool {
        let freedom = self.freedom as f64;
        self.freedom > 0 && self.squares > freedom + 4.0 * (2.0 * freedom).sqrt()
    }

    /// The law of Arrhenius at a reference temperature, its error from the covariance of the unknowns: `a = Ea / (ln 10 R T0^2)`.
    pub(super) fn arrhenius(&self, reference_temperature_k: f64) -> Arrhenius {
        let unit = LN_10 * GAS_CONSTANT * self.hyperbola.origin_k.powi(2);
        Arrhenius {
            reference_temperature_k,
            activation_energy_j_per_mol: unit * self.hyperbola.a,
            activation_energy_error_j_per_mol: unit * self.covariance[(0, 0)].max(0.0).sqrt(),
        }
    }

    /// The WLF law at a reference temperature, its errors from the covariance of the unknowns; `None` where its pole is not below that.
    /// c2 grows by what the reference temperature does, and c1 c2 stays: with `D = 1/b`, `c2 = D + x`, `c1 = a D^2 / c2`.
    pub(super) fn wlf(&self, reference_temperature_k: f64) -> Option<Wlf> {
        let Hyperbola { origin_k, a, b, .. } = self.hyperbola;
        let distance = 1.0 / b;
        let c2_k = distance + reference_temperature_k - origin_k;
        if !(b > 0.0 && c2_k > 0.0 && c2_k.is_finite()) {
            return None;
        }
        let c1 = a * distance * distance / c2_k;
        let by_b = -distance * distance;
        let c1_by = Vector2::new(
            distance * distance / c2_k,
            by_b * (2.0 * c1 / distance - c1 / c2_k),
        );
        let c2_by = Vector2::new(0.0, by_b);
        let covariance = Matrix2::from_fn(|i, j| self.covariance[(i, j)]);
        let error = |by: Vector2<f64>| by.dot(&(covariance * by)).max(0.0).sqrt();
        Some(Wlf {
            reference_temperature_k,
            c1,
            c2_k,
            c1_error: error(c1_by),
            c2_error_k: error(c2_by),
        })
    }
}

/// Both laws through the same factors, where there are.
#[derive(Debug, Default)]
pub(super) struct Laws {
    pub(super) wlf: Option<LawFit>,
    pub(super) arrhenius: Option<LawFit>,
}

impl Laws {
    pub(super) fn of(&self, form: Form) -> Option<&LawFit> {
        match form {
            Form::Wlf => self.wlf.as_ref(),
            Form::Arrhenius => self.arrhenius.as_ref(),
        }
    }

    /// The law that the data prefer: WLF to Arrhenius, which is a WLF law with one constant given, by the criterion of Schwarz (1978),
    /// where the sum of squares is less by more than the logarithm of the number of measured values. Where WLF itself leaves more than
    /// the errors of the factors, they are scaled up first.
    pub(super) fn preferred(&self, values: usize) -> Option<Form> {
        match (&self.wlf, &self.arrhenius) {
            (Some(wlf), Some(arrhenius)) => {
                let scale = (wlf.squares / wlf.freedom.max(1) as f64).max(1.0);
                let excess = (arrhenius.squares - wlf.squares) / scale;
                let is_wlf = excess > (values.max(3) as f64).ln();
                Some(if is_wlf { Form::Wlf } else { Form::Arrhenius })
            }
            (wlf, None) => wlf.as_ref().map(|_| Form::Wlf),
            (None, _) => Some(Form::Arrhenius),
        }
    }
}

/// Factors at temperatures other than that of the origin, where the factor is zero without error.
pub(super) struct Factors<'a> {
    pub(super) origin_k: f64,
    pub(super) temperatures_k: &'a [f64],
    pub(super) log10_a_t: &'a [f64],
    pub(super) covariance: &'a DMatrix<f64>,
}

impl Factors<'_> {
    /// WLF, where there are two factors at least beside the origin and they bend as the law does, and Arrhenius.
    pub(super) fn laws(&self) -> Laws {
        let Some(factor) = self.covariance.clone().cholesky() else {
            return Laws::default();
        };
        let arrhenius = self
            .amplitude(1.0 / self.origin_k, &factor)
            .and_then(|(a, _)| self.fitted(Hyperbola::arrhenius(self.origin_k, a), &factor));
        let wlf = self.hyperbola(&factor).filter(|wlf| wlf.b > 0.0);
        let wlf = wlf.and_then(|hyperbola| self.fitted(hyperbola, &factor));
        Laws { wlf, arrhenius }
    }

    /// The best `a` for this `b`, and its sum of squares.
    fn amplitude(&self, b: f64, factor: &Cholesky<f64, Dyn>) -> Option<(f64, f64)> {
        let shape = self.temperatures_k.iter().map(|t| {
            let x = t - self.origin_k;
            -x / (1.0 + b * x)
        });
        let shape = DVector::from_iterator(self.temperatures_k.len(), shape);
        let factors = DVector::from_row_slice(self.log10_a_t);
        let weighted = factor.solve(&shape);
        let a = weighted.dot(&factors) / weighted.dot(&shape);
        let left = &factors - shape * a;
        let squares = left.dot(&factor.solve(&left));
        (a.is_finite() && squares.is_finite()).then_some((a, squares))
    }

    /// The best hyperbola whose pole is outside the temperatures: a search over the place of the pole, in which the temperatures
    /// are from -1 to 1 and the pole is at -1/u.
    fn hyperbola(&self, factor: &Cholesky<f64, Dyn>) -> Option<Hyperbola> {
        if self.temperatures_k.len() < 2 {
            return None;
        }
        let all = self.temperatures_k.iter().copied().chain([self.origin_k]);
        let lowest = all.clone().fold(f64::INFINITY, f64::min);
        let highest = all.fold(f64::NEG_INFINITY, f64::max);
        let half = 0.5 * (highest - lowest);
        let origin = (self.origin_k - 0.5 * (lowest + highest)) / half;
        let b = |u: f64| u / (half * (1.0 + u * origin));
        let squares = |u: f64| {
            self.amplitude(b(u), factor)
                .map_or(f64::INFINITY, |found| found.1)
        };
        let step = 2.0 * NEAREST_POLE / SEARCHED as f64;
        let tried = (0..=SEARCHED).map(|i| -NEAREST_POLE + step * i as f64);
        let start = tried.min_by(|&u, &v| squares(u).total_cmp(&squares(v)))?;
        let (from, to) = (
            (start - step).max(-NEAREST_POLE),
            (start + step).min(NEAREST_POLE),
        );
        let b = b(golden_section(from, to, squares));
        let (a, _) = self.amplitude(b, factor)?;
        Some(Hyperbola {
            form: Form::Wlf,
            origin_k: self.origin_k,
            a,
            b,
        })
    }

    fn fitted(&self, hyperbola: Hyperbola, factor: &Cholesky<f64, Dyn>) -> Option<LawFit> {
        let by = hyperbola.derivatives(self.temperatures_k);
        let left = self.temperatures_k.iter().zip(self.log10_a_t);
        let left: Option<Vec<f64>> = left
            .map(|(&t, s)| Some(s - hyperbola.log10_a_t(t)?))
            .collect();
        let left = DVector::from_vec(left?);
        let squares = left.dot(&factor.solve(&left));
        let freedom = self.temperatures_k.len().saturating_sub(by.ncols());
        let scale = (squares / freedom.max(1) as f64).max(1.0);
        let covariance = by.tr_mul(&factor.solve(&by)).cholesky()?.inverse() * scale;
        Some(LawFit {
            hyperbola,
            covariance,
            squares,
            freedom,
        })
    }
}

/// In the search for the pole: nearest place to the temperatures, as a share of their half width, and places.
const NEAREST_POLE: f64 = 0.995;
const SEARCHED: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_says_the_same_whatever_it_refers_to() {
        let wlf = Wlf {
            reference_temperature_k: 298.15,
            c1: 8.86,
            c2_k: 101.6,
            c1_error: 0.1,
            c2_error_k: 1.0,
        };
        let other = wlf.referred_to(320.0).unwrap();
        let shift = wlf.log10_a_t(320.0).unwrap();
        for temperature in [260.0, 320.0, 400.0] {
            let direct = wlf.log10_a_t(temperature).unwrap() - shift;
            let referred = other.log10_a_t(temperature).unwrap();
            // Differences of numbers of the order of ten.
            assert!((direct - referred).abs() < 1e-13, "{direct}, {referred}");
        }
        assert_eq!(wlf.referred_to(196.0), None);
    }

    #[test]
    fn arrhenius_is_a_law_of_wlf() {
        let arrhenius = Arrhenius {
            reference_temperature_k: 300.0,
            activation_energy_j_per_mol: 1.2e5,
            activation_energy_error_j_per_mol: 1e3,
        };
        let wlf = Wlf::from(ShiftLaw::Arrhenius(arrhenius));
        for temperature in [250.0, 300.0, 410.0] {
            let difference = wlf.log10_a_t(temperature).unwrap() - arrhenius.log10_a_t(temperature);
            assert!(difference.abs() < 1e-13, "{difference}");
        }
    }
}
