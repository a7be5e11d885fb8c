//! What was found of a curve: its laws with their weights and intervals, and the moduli with their bands.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;
use rayon::prelude::*;

use super::fit::CurveError;
use super::problem::{EXACTLY, Fitted, OfForm, WIDEST_LOGARITHM};
use super::record::Points;
use super::touch::Nuisance;
use crate::identify::noise::is_missed;
use crate::identify::uncertainty::Directions;
use crate::identify::{ModulusBand, UNDETERMINED};
use crate::material::Relaxation;
use crate::material::law::Form;
use crate::measured::statistics::{NORMAL, student};
use crate::numerics::levenberg_marquardt::{Solution, minimise};
use crate::numerics::random::Noise;

/// A number with the interval that holds it in 95 cases of 100.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

/// A law as it fits a curve best.
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
    akaike_weight: f64,
    unknowns: Vec<f64>,
    contact_point_m: f64,
    directions: Directions,
    half_width: f64,
}

/// What a curve with its noise drawn anew gives.
#[derive(Debug, Clone)]
pub struct Drawn {
    pub form: Form,
    values: Vec<f64>,
    pub contact_point_m: f64,
    /// The series that stands for the law over the times of the curve, and a decade beyond.
    pub series: Relaxation,
}

impl Drawn {
    /// E* (Pa) at an angular frequency (rad/s).
    pub fn complex_modulus_pa(&self, angular_frequency_rad_per_s: f64) -> Option<Complex<f64>> {
        (self.form).complex_modulus_pa(&self.values, angular_frequency_rad_per_s)
    }
}

/// What was found of a curve.
#[derive(Debug, Clone)]
pub struct CurveFit {
    /// The best first.
    pub laws: Vec<FittedLaw>,
    /// The indentation at which the contact begins, as the curve counts it.
    pub contact_point_m: Estimate,
    pub nuisances: Vec<(Nuisance, Estimate)>,
    pub degrees_of_freedom: usize,
    pub reduced_chi_squared: f64,
    /// By what factor all intervals are wider than the noise says, because the best law misses the curve.
    pub inflation: f64,
    /// Angular frequencies (rad/s) about which the curve says something: one over its contact time, and over its finest.
    pub window_rad_per_s: (f64, f64),
    pub points: Points,
    /// The force (N) of the best law at these, with what the instrument adds.
    pub computed_n: Vec<f64>,
    /// Standard deviation (N) of each point.
    pub error_n: Vec<f64>,
    /// Whether the retraction pulls, and is left out.
    pub is_pulled: bool,
    /// What is found where the noise falls otherwise, each alike in probability; empty where none was asked for.
    pub ensemble: Vec<Drawn>,
    times_s: (f64, f64),
}

/// A law and its least squares solution.
pub(super) type Solved = (Form, Solution<Vec<f64>>);

/// A law, and behind it the contact point (m) and what the instrument adds.
type Judged = (FittedLaw, Vec<Estimate>);

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

/// A value with the same to both sides.
fn around(value: f64, half: f64) -> Estimate {
    Estimate {
        value,
        low: value - half,
        high: value + half,
    }
}

/// How residuals scatter, by the best law.
struct Scatter {
    degrees_of_freedom: usize,
    reduced_chi_squared: f64,
    inflation: f64,
    /// Of the interval of 95 %, in standard deviations.
    half_width: f64,
}

impl Scatter {
    fn new(squares: f64, degrees_of_freedom: usize) -> Self {
        let reduced_chi_squared = squares / degrees_of_freedom.max(1) as f64;
        let (inflation, half_width) = match is_missed(reduced_chi_squared, degrees_of_freedom) {
            true => (
                reduced_chi_squared.sqrt(),
                student(degrees_of_freedom as f64),
            ),
            false => (1.0, NORMAL),
        };
        Self {
            degrees_of_freedom,
            reduced_chi_squared,
            inflation,
            half_width,
        }
    }
}

impl Fitted<'_> {
    /// All solutions as what is known of the curve; whose contact lasts so long (s), of which the finest time tells anything.
    pub(super) fn judged(
        &self,
        found: &[Solved],
        (finest_s, whole_s): (f64, f64),
    ) -> Result<CurveFit, CurveError> {
        let criteria = self.criteria(found);
        let best = (0..found.len()).min_by(|a, b| criteria[*a][0].total_cmp(&criteria[*b][0]));
        let best = &found[best.ok_or(CurveError::NoLaw)?];
        let free = self.sigma_n.len().saturating_sub(self.unknowns(best.0));
        let scatter = Scatter::new(best.1.squares(), free);
        let all = found.iter().zip(&criteria).zip(weights_of(&criteria));
        let laws = all.filter_map(|((one, criteria), weights)| {
            self.law(one, (criteria[0], weights), &scatter)
        });
        let mut laws: Vec<Judged> = laws.collect();
        laws.sort_by(|a, b| a.0.schwarz.total_cmp(&b.0.schwarz));
        let (first, added) = laws.first().ok_or(CurveError::NoLaw)?;
        let (own, added) = added.split_first().ok_or(CurveError::NoLaw)?;
        let computed_n = self.computed_n(first, added).ok_or(CurveError::NoLaw)?;
        let among = laws
            .iter()
            .map(|(law, _)| law.akaike_weight * (law.contact_point_m - own.value).powi(2));
        let spread = scatter.half_width * among.sum::<f64>().sqrt();
        let nuisances = self.nuisances.iter().copied().zip(added.to_vec());
        Ok(CurveFit {
            contact_point_m: around(own.value, (own.high - own.value).hypot(spread)),
            nuisances: nuisances.collect(),
            degrees_of_freedom: scatter.degrees_of_freedom,
            reduced_chi_squared: scatter.reduced_chi_squared,
            inflation: scatter.inflation,
            window_rad_per_s: (1.0 / whole_s, 1.0 / finest_s),
            computed_n,
            points: self.points.clone(),
            error_n: self.sigma_n.clone(),
            is_pulled: false,
            ensemble: Vec::new(),
            times_s: self.times_s,
            laws: laws.into_iter().map(|(law, _)| law).collect(),
        })
    }

    fn unknowns(&self, form: Form) -> usize {
        form.scales().count() + 1 + self.nuisances.len()
    }

    /// The criteria of Schwarz and of Akaike, the latter with the correction for few data; where no law meets the curve, its noise is what
    /// the best leaves.
    fn criteria(&self, found: &[Solved]) -> Vec<[f64; 2]> {
        let numbers = self.sigma_n.len() as f64;
        let all = || {
            let all = found.iter();
            all.map(|(form, solution)| (self.unknowns(*form) as f64, solution.squares()))
        };
        let reduced = all().map(|(unknowns, squares)| squares / (numbers - unknowns).max(1.0));
        let noise = reduced.fold(f64::INFINITY, f64::min).max(1.0);
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

    /// A law with its intervals, and behind it contact point and nuisances with theirs.
    fn law(
        &self,
        (form, solution): &Solved,
        (schwarz, [weight, akaike_weight]): (f64, [f64; 2]),
        scatter: &Scatter,
    ) -> Option<Judged> {
        let problem = OfForm {
            fitted: self,
            form: *form,
            is_near: true,
        };
        let unknowns = &solution.unknowns;
        let mut columns = problem.columns(unknowns)?;
        let nuisances = self.nuisances.iter().map(|nuisance| self.column(*nuisance));
        let nuisances: Vec<DVector<f64>> = nuisances.collect();
        let lengths: Vec<f64> = nuisances.iter().map(DVector::norm).collect();
        let of_length_one = nuisances.iter().zip(&lengths);
        columns.extend(of_length_one.map(|(column, length)| column / *length));
        let directions = Directions::new(&DMatrix::from_columns(&columns), scatter.inflation)?;
        let covariance = directions.covariance();
        let half = |k: usize| scatter.half_width * covariance[(k, k)].sqrt();
        let count = unknowns.len() - 1;
        let all = form.scales().zip(unknowns).enumerate();
        let parameters = all.map(|(k, (scale, unknown))| {
            let at = |off: f64| scale.value(unknown + off);
            let half = half(k).min(WIDEST_LOGARITHM);
            Estimate {
                value: at(0.0),
                low: at(-half),
                high: at(half),
            }
        });
        let contact_point_m = unknowns[count] * self.scale_m;
        let mut beside = vec![around(contact_point_m, half(count) * self.scale_m)];
        let added = self.added(&nuisances, &self.off(*form, unknowns)?)?;
        let added = added.iter().zip(&lengths).enumerate();
        beside
            .extend(added.map(|(k, (value, length))| around(*value, half(count + 1 + k) / length)));
        let law = FittedLaw {
            form: *form,
            parameters: parameters.collect(),
            chi_squared: solution.squares(),
            schwarz,
            weight,
            akaike_weight,
            unknowns: unknowns[..count].to_vec(),
            contact_point_m,
            directions,
            half_width: scatter.half_width,
        };
        Some((law, beside))
    }

    /// A parametric bootstrap (B. Efron, R. J. Tibshirani, *An Introduction to the Bootstrap*, Chapman & Hall 1993, section 6.5): the computed
    /// curve with noise as the best law leaves it, to which a law is fitted, each as often as its weight in the band says.
    pub(super) fn ensemble(&self, found: &CurveFit, samples: usize) -> Vec<Drawn> {
        const SEED: u64 = 1;
        let draw = |number: usize| {
            let mut random = Noise::stream(SEED, number as u64);
            let law = found.drawn_law(random.uniform());
            let mut points = self.points.clone();
            let computed = found.computed_n.iter().zip(&self.sigma_n);
            for (force_n, (computed_n, sigma_n)) in points.force_n.iter_mut().zip(computed) {
                *force_n = computed_n + found.inflation * sigma_n * random.normal();
            }
            let fitted = self.with_points(&points);
            let problem = OfForm {
                fitted: &fitted,
                form: law.form,
                is_near: true,
            };
            let unknowns = minimise(&problem, &self.unknowns_of(law), EXACTLY)?.unknowns;
            let (contact_part, unknowns) = unknowns.split_last()?;
            let values = law.form.values(unknowns);
            Some(Drawn {
                form: law.form,
                series: law.form.series_within(&values, beyond(self.times_s))?,
                values,
                contact_point_m: contact_part * self.scale_m,
            })
        };
        (0..samples).into_par_iter().filter_map(draw).collect()
    }

    /// How much of each nuisance there is: what is linear follows from the residuals without it.
    fn added(&self, nuisances: &[DVector<f64>], off: &DVector<f64>) -> Option<Vec<f64>> {
        if nuisances.is_empty() {
            return Some(Vec::new());
        }
        let columns = DMatrix::from_columns(nuisances);
        let added = columns.svd(true, true).solve(&-off, 1e-14).ok()?;
        Some(added.iter().copied().collect())
    }

    /// Of a law and its contact point.
    fn unknowns_of(&self, law: &FittedLaw) -> Vec<f64> {
        let contact_part = law.contact_point_m / self.scale_m;
        law.unknowns.iter().copied().chain([contact_part]).collect()
    }

    fn computed_n(&self, law: &FittedLaw, added: &[Estimate]) -> Option<Vec<f64>> {
        let mut force_n = self.response(law.form, &self.unknowns_of(law))?;
        for (nuisance, estimate) in self.nuisances.iter().zip(added) {
            let column = self.column(*nuisance);
            let added = column.iter().zip(&self.sigma_n);
            for (force_n, (added, sigma_n)) in force_n.iter_mut().zip(added) {
                *force_n += added * sigma_n * estimate.value;
            }
        }
        Some(force_n)
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
        const STEP: f64 = 1e-3;
        let own = self.ln_moduli(&self.unknowns, omega)?;
        let count = self.unknowns.len();
        let mut gradients = [DVector::zeros(count), DVector::zeros(count)];
        for k in 0..count {
            let at = |off: f64| {
                let mut moved = self.unknowns.clone();
                moved[k] += off;
                self.ln_moduli(&moved, omega)
            };
            let (above, below) = (at(STEP)?, at(-STEP)?);
            for (part, gradient) in gradients.iter_mut().enumerate() {
                gradient[k] = (above[part] - below[part]) / (2.0 * STEP);
            }
        }
        let [of_storage, of_loss] = gradients.map(|gradient| self.directions.variance(&gradient));
        Some([(own[0], of_storage), (own[1], of_loss)])
    }
}

impl CurveFit {
    /// The law at a share of the sum of all weights.
    fn drawn_law(&self, share: f64) -> &FittedLaw {
        let mut left = share;
        let law = self.laws.iter().find(|law| {
            left -= law.akaike_weight;
            left < 0.0
        });
        law.unwrap_or(self.law())
    }

    /// The law that is most likely.
    pub fn law(&self) -> &FittedLaw {
        &self.laws[0]
    }

    /// The moduli at an angular frequency (rad/s), with bands in which the other laws are by their weights; outside the window they are
    /// extrapolations.
    pub fn band(&self, angular_frequency_rad_per_s: f64) -> Option<ModulusBand> {
        let omega = angular_frequency_rad_per_s;
        let own = self.law().moduli(omega)?;
        let half_width = self.law().half_width;
        let open = (UNDETERMINED.ln() / half_width).powi(2);
        let mut variances = own.map(|(_, variance)| variance);
        for other in self
            .laws
            .iter()
            .skip(1)
            .filter(|law| law.akaike_weight > 1e-4)
        {
            let theirs = other.moduli(omega)?;
            for part in 0..2 {
                let apart = theirs[part].0 - own[part].0;
                // A law that leaves a modulus open says nothing of it.
                let wider = (theirs[part].1 - own[part].1).clamp(0.0, open);
                variances[part] += other.akaike_weight * (apart * apart + wider);
            }
        }
        let ln_moduli = own.map(|(ln, _)| ln);
        Some(ModulusBand::of(ln_moduli, variances, half_width))
    }

    /// The series that stands for the best law over the times of the curve, and a decade beyond.
    pub fn series(&self) -> Option<Relaxation> {
        let law = self.law();
        let values = law.form.values(&law.unknowns);
        law.form.series_within(&values, beyond(self.times_s))
    }
}

/// Times of a curve and a decade beyond.
fn beyond((finest_s, whole_s): (f64, f64)) -> (f64, f64) {
    (0.1 * finest_s, 10.0 * whole_s)
}
