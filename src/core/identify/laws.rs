//! Laws of a few parameters between which numbers choose: each with its weight and its intervals, and the band of the moduli that holds what
//! all of them say.
//!
//! The law is chosen by the criterion of G. Schwarz (Ann. Statist. 6 (1978) 461), which finds the true one among few; in the band a law
//! counts by its weight of Akaike, with the correction for few data, which leaves more to laws of more parameters (K. P. Burnham and D. R.
//! Anderson, *Model Selection and Multimodel Inference*, Springer 2002).

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use crate::identify::noise::is_missed;
use crate::identify::uncertainty::{Directions, gradients};
use crate::identify::{ModulusBand, UNDETERMINED};
use crate::material::Relaxation;
use crate::material::law::{Form, Scale, Solid};
use crate::measured::statistics::{NORMAL, student};
use crate::numerics::levenberg_marquardt::{
    Ending, Problem, Solution, central_difference, minimise,
};

/// The widest that an unknown may go: a modulus of nothing, an exponent of nearly zero or one.
const WIDEST_LOGARITHM: f64 = 80.0;
const WIDEST_ODDS: f64 = 5.3;

/// The weight from which another law explains the numbers as well.
const NEARLY: f64 = 0.05;

/// Step of an unknown for derivatives.
const STEP: f64 = 1e-3;

/// A number with the interval that holds it in 95 cases of 100.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

impl Estimate {
    /// A value with the same to both sides.
    pub(crate) fn around(value: f64, half: f64) -> Self {
        Self {
            value,
            low: value - half,
            high: value + half,
        }
    }

    /// What rises with the number.
    pub(crate) fn of(self, rising: impl Fn(f64) -> f64) -> Self {
        Self {
            value: rising(self.value),
            low: rising(self.low),
            high: rising(self.high),
        }
    }
}

/// A law as it fits the numbers best.
#[derive(Debug, Clone)]
pub struct FittedLaw {
    pub form: Form,
    /// In the order of [`Form::parameters`].
    pub parameters: Vec<Estimate>,
    /// Sum of squares of the residuals in their standard deviations.
    pub chi_squared: f64,
    /// The criterion of Schwarz.
    pub schwarz: f64,
    /// How likely it is among all that were tried.
    pub weight: f64,
    /// The weight of Akaike, by which it counts in the band of the moduli.
    pub(crate) akaike_weight: f64,
    /// Those of the law, and what is unknown beside it.
    pub(crate) unknowns: Vec<f64>,
    directions: Directions,
    /// Half of the interval of every unknown.
    pub(crate) halves: Vec<f64>,
}

/// What numbers with their noise drawn anew give.
#[derive(Debug, Clone)]
pub struct Drawn {
    pub form: Form,
    pub(crate) values: Vec<f64>,
    /// The series that stands for the law over the times of the numbers, and a decade beyond.
    pub series: Relaxation,
}

impl Drawn {
    /// E* (Pa) at an angular frequency (rad/s).
    pub fn complex_modulus_pa(&self, angular_frequency_rad_per_s: f64) -> Option<Complex<f64>> {
        (self.form).complex_modulus_pa(&self.values, angular_frequency_rad_per_s)
    }
}

/// Laws that were fitted to the same numbers.
#[derive(Debug, Clone)]
pub struct Laws {
    /// The best first.
    pub all: Vec<FittedLaw>,
    pub degrees_of_freedom: usize,
    /// Of the best law; one where the noise is what it leaves.
    pub reduced_chi_squared: f64,
    /// By what factor all intervals are wider than the noise says, because the best law misses the numbers.
    pub inflation: f64,
    /// Half the width of the interval of 95 %, in standard deviations.
    pub(crate) half_width: f64,
    /// The times (s) that a series stands for a law over.
    times_s: (f64, f64),
}

/// A law and its least squares solution.
pub(crate) struct Tried {
    pub(crate) form: Form,
    /// Those of the law first.
    pub(crate) unknowns: Vec<f64>,
    pub(crate) squares: f64,
    /// A column for each unknown, in standard deviations of the numbers.
    pub(crate) derivatives: DMatrix<f64>,
    /// What an error of one standard deviation that all numbers have in common changes in the residuals; nothing where there is none.
    pub(crate) in_common: Vec<f64>,
}

/// What is to be met, and over which times.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Numbers {
    pub(crate) count: usize,
    /// Whether the standard deviations of the numbers are known, or only their ratios.
    pub(crate) is_noise_known: bool,
    pub(crate) times_s: (f64, f64),
}

/// Of two criteria the weights exp(-c/2), which sum to one.
fn weights_of(criteria: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut weights = vec![[0.0; 2]; criteria.len()];
    for which in 0..2 {
        let all = criteria.iter().map(|c| c[which]);
        let least = all.clone().fold(f64::INFINITY, f64::min);
        let likely: Vec<f64> = all.map(|c| (-0.5 * (c - least)).exp()).collect();
        let sum: f64 = likely.iter().sum();
        for (weights, one) in weights.iter_mut().zip(likely) {
            weights[which] = one / sum;
        }
    }
    weights
}

impl Numbers {
    /// The criteria of Schwarz and of Akaike; where no law meets the numbers, or where it is not known, their noise is what the best leaves.
    fn criteria(&self, tried: &[Tried]) -> Vec<[f64; 2]> {
        let numbers = self.count as f64;
        let all = || (tried.iter()).map(|tried| (tried.unknowns() as f64, tried.squares));
        let reduced = all().map(|(unknowns, squares)| squares / (numbers - unknowns).max(1.0));
        let least = if self.is_noise_known { 1.0 } else { 1e-12 };
        let noise = reduced.fold(f64::INFINITY, f64::min).max(least);
        let criteria = all().map(|(unknowns, squares)| {
            let left = (numbers - unknowns - 1.0).max(1.0);
            let few = 2.0 * unknowns * (unknowns + 1.0) / left;
            [
                squares / noise + unknowns * numbers.ln(),
                squares / noise + 2.0 * unknowns + few,
            ]
        });
        criteria.collect()
    }
}

impl Tried {
    fn unknowns(&self) -> usize {
        self.derivatives.ncols()
    }
}

impl Laws {
    /// Weighs laws, of which there is at least one.
    pub(crate) fn of(tried: &[Tried], numbers: &Numbers) -> Option<Self> {
        let criteria = numbers.criteria(tried);
        let best = (0..tried.len()).min_by(|a, b| criteria[*a][0].total_cmp(&criteria[*b][0]))?;
        let degrees_of_freedom = numbers.count.saturating_sub(tried[best].unknowns());
        let reduced = tried[best].squares / degrees_of_freedom.max(1) as f64;
        let wide = student(degrees_of_freedom as f64);
        // The standard deviation of the residuals, and how much wider than the noise all intervals are.
        let (deviation, inflation, half_width) = match numbers.is_noise_known {
            false => (reduced.sqrt(), 1.0, wide),
            true if is_missed(reduced, degrees_of_freedom) => {
                (reduced.sqrt(), reduced.sqrt(), wide)
            }
            true => (1.0, 1.0, NORMAL),
        };
        let all = tried.iter().zip(&criteria).zip(weights_of(&criteria));
        let all = all.filter_map(|((tried, criteria), weights)| {
            let mut directions = Directions::new(&tried.derivatives, deviation)?;
            if !tried.in_common.is_empty() {
                // What is included is half an interval.
                let changes = tried.in_common.iter().map(|change| half_width * change);
                let changes: Vec<f64> = changes.collect();
                directions.include(&tried.derivatives, &changes, half_width);
            }
            Some(tried.law(directions, half_width, (criteria[0], weights)))
        });
        let mut all: Vec<FittedLaw> = all.collect();
        all.sort_by(|a, b| a.schwarz.total_cmp(&b.schwarz));
        (!all.is_empty()).then_some(Self {
            all,
            degrees_of_freedom,
            reduced_chi_squared: if numbers.is_noise_known { reduced } else { 1.0 },
            inflation,
            half_width,
            times_s: numbers.times_s,
        })
    }

    /// The law that is most likely.
    pub fn best(&self) -> &FittedLaw {
        &self.all[0]
    }

    /// Laws that explain the numbers as well as the best.
    pub fn others(&self) -> impl Iterator<Item = &FittedLaw> {
        self.all.iter().skip(1).filter(|law| law.weight > NEARLY)
    }

    /// The law at a share of the sum of all weights.
    pub(crate) fn drawn(&self, share: f64) -> &FittedLaw {
        let mut left = share;
        let law = self.all.iter().find(|law| {
            left -= law.akaike_weight;
            left < 0.0
        });
        law.unwrap_or(self.best())
    }

    /// The moduli at an angular frequency (rad/s), with bands in which the other laws are by their weights; outside the window they are
    /// extrapolations.
    pub fn band(&self, angular_frequency_rad_per_s: f64) -> Option<ModulusBand> {
        let omega = angular_frequency_rad_per_s;
        let own = self.best().moduli(omega)?;
        let open = (UNDETERMINED.ln() / self.half_width).powi(2);
        let mut variances = own.map(|(_, variance)| variance);
        let others = self.all.iter().skip(1);
        for other in others.filter(|law| law.akaike_weight > 1e-4) {
            let theirs = other.moduli(omega)?;
            for part in 0..2 {
                let apart = theirs[part].0 - own[part].0;
                // A law that leaves a modulus open says nothing of it.
                let wider = (theirs[part].1 - own[part].1).clamp(0.0, open);
                variances[part] += other.akaike_weight * (apart * apart + wider);
            }
        }
        let ln_moduli = own.map(|(ln, _)| ln);
        Some(ModulusBand::of(ln_moduli, variances, self.half_width))
    }

    /// The series that stands for the best law over the times of the numbers, and a decade beyond.
    pub fn series(&self) -> Option<Relaxation> {
        let law = self.best();
        let values = law.form.values(&law.unknowns);
        law.form.series_within(&values, beyond(self.times_s))
    }
}

/// Times and a decade beyond.
pub(crate) fn beyond((shortest_s, longest_s): (f64, f64)) -> (f64, f64) {
    (0.1 * shortest_s, 10.0 * longest_s)
}

impl Tried {
    fn law(
        &self,
        directions: Directions,
        half_width: f64,
        (schwarz, [weight, akaike_weight]): (f64, [f64; 2]),
    ) -> FittedLaw {
        let covariance = directions.covariance();
        let halves = (0..self.unknowns()).map(|k| half_width * covariance[(k, k)].sqrt());
        let halves: Vec<f64> = halves.collect();
        let all = self.form.scales().zip(&self.unknowns).zip(&halves);
        let parameters = all.map(|((scale, unknown), half)| {
            let at = |off: f64| scale.value(unknown + off);
            let half = half.min(WIDEST_LOGARITHM);
            Estimate {
                value: at(0.0),
                low: at(-half),
                high: at(half),
            }
        });
        FittedLaw {
            form: self.form,
            parameters: parameters.collect(),
            chi_squared: self.squares,
            schwarz,
            weight,
            akaike_weight,
            unknowns: self.unknowns.clone(),
            directions,
            halves,
        }
    }
}

impl FittedLaw {
    /// Logarithms of storage and loss modulus (Pa).
    fn ln_moduli(&self, unknowns: &[f64], omega: f64) -> Option<[f64; 2]> {
        let modulus = self
            .form
            .complex_modulus_pa(&self.form.values(unknowns), omega)?;
        Some([modulus.re, modulus.im].map(|part| part.max(f64::MIN_POSITIVE).ln()))
    }

    /// The same with their variances.
    fn moduli(&self, omega: f64) -> Option<[(f64, f64); 2]> {
        let own = self.ln_moduli(&self.unknowns, omega)?;
        let count = self.form.scales().count();
        let gradients = gradients(&self.unknowns, count, STEP, &|moved| {
            self.ln_moduli(&moved, omega)
        })?;
        let [of_storage, of_loss] = gradients.map(|gradient| self.directions.variance(&gradient));
        Some([(own[0], of_storage), (own[1], of_loss)])
    }

    /// The factor of the interval of a number whose logarithm has this gradient, half so wide in standard deviations.
    pub(crate) fn factor(&self, gradient: &DVector<f64>, half_width: f64) -> f64 {
        let deviation = self.directions.variance(gradient).sqrt();
        (half_width * deviation).min(WIDEST_LOGARITHM).exp()
    }
}

/// The nearest value that an unknown of a law may have.
pub(crate) fn clamped(form: Form, place: usize, value: f64) -> f64 {
    match form.scales().nth(place) {
        Some(Scale::Odds) => value.clamp(-WIDEST_ODDS, WIDEST_ODDS),
        Some(Scale::Logarithm(_)) => value.clamp(-WIDEST_LOGARITHM, WIDEST_LOGARITHM),
        None => value,
    }
}

/// Residuals in the standard deviations of the numbers of a solid; `None` of one that cannot be tried.
pub(crate) type Residuals<'a> = &'a (dyn Fn(&Solid) -> Option<DVector<f64>> + Sync);

/// A law as a least squares problem.
pub(crate) struct OfLaw<'a> {
    pub(crate) form: Form,
    pub(crate) times_s: (f64, f64),
    pub(crate) residuals: Residuals<'a>,
}

impl Problem for OfLaw<'_> {
    type Unknowns = Vec<f64>;

    fn residuals(&self, unknowns: &Vec<f64>) -> Option<DVector<f64>> {
        let solid = self.form.solid(&self.form.values(unknowns), self.times_s)?;
        let residuals = (self.residuals)(&solid)?;
        residuals.iter().all(|r| r.is_finite()).then_some(residuals)
    }

    fn derivatives(&self, unknowns: &Vec<f64>) -> Option<DMatrix<f64>> {
        let column =
            |k: usize| central_difference(unknowns, k, STEP, &|moved| self.residuals(&moved));
        let columns: Option<Vec<DVector<f64>>> = (0..unknowns.len()).map(column).collect();
        Some(DMatrix::from_columns(&columns?))
    }

    fn clamp(&self, place: usize, value: f64) -> f64 {
        clamped(self.form, place, value)
    }
}

const ROUGHLY: Ending = Ending {
    iterations: 20,
    enough: 1e-3,
};
const CLOSELY: Ending = Ending {
    iterations: 80,
    enough: 1e-7,
};

/// Laws with unknowns to begin with, fitted to numbers.
pub(crate) fn fitted(
    forms: &[(Form, Vec<Vec<f64>>)],
    numbers: &Numbers,
    residuals: Residuals<'_>,
) -> Option<Laws> {
    use rayon::prelude::*;
    let all = forms.par_iter().filter_map(|(form, starts)| {
        let problem = OfLaw {
            form: *form,
            times_s: numbers.times_s,
            residuals,
        };
        // The two starts that are nearest: the others end where these do, or farther off.
        let left = |start| Some((problem.residuals(start)?.norm_squared(), start));
        let mut near: Vec<(f64, &Vec<f64>)> = starts.iter().filter_map(left).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let near = near.iter().take(2);
        let found = near.filter_map(|(_, start)| minimise(&problem, start, ROUGHLY));
        let found = found.min_by(|a, b| a.squares().total_cmp(&b.squares()))?;
        let found: Solution<Vec<f64>> = minimise(&problem, &found.unknowns, CLOSELY)?;
        Some(Tried {
            form: *form,
            squares: found.squares(),
            derivatives: problem.derivatives(&found.unknowns)?,
            unknowns: found.unknowns,
            in_common: Vec::new(),
        })
    });
    Laws::of(&all.collect::<Vec<Tried>>(), numbers)
}
