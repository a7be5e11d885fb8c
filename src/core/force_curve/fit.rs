//! The laws fitted to a curve, and what is known of them.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::record::{ForceCurve, Points};
use super::springs::Springs;
use crate::engine::body_of_revolution;
use crate::identify::ModulusBand;
use crate::identify::noise::is_missed;
use crate::identify::uncertainty::Directions;
use crate::indenter::{Axisymmetric, Indenter};
use crate::material::law::{Form, Scale};
use crate::material::{Compressibility, Material, ModulusKind, Relaxation};
use crate::measured::statistics::{NORMAL, student};
use crate::numerics::levenberg_marquardt::{Ending, Problem, Solution, minimise};

/// What is known before a curve is fitted.
#[derive(Debug, Clone)]
pub struct CurvePlan {
    pub indenter: Arc<dyn Indenter>,
    pub compressibility: Compressibility,
    /// What the indenter is made of, where it is not rigid.
    pub indenter_material: Option<Material>,
    /// The laws that are tried.
    pub forms: Vec<Form>,
}

/// A number with the interval that holds it in 95 cases of 100.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

/// What the instrument adds to the force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nuisance {
    /// N.
    Offset,
    /// N/s.
    Drift,
    /// N s/m.
    Drag,
}

impl Nuisance {
    /// With its unit, as tables call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Offset => "force_offset_n",
            Self::Drift => "force_drift_n_per_s",
            Self::Drag => "drag_n_s_per_m",
        }
    }
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
    values: Vec<f64>,
    contact_point_m: f64,
    directions: Directions,
    half_width: f64,
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
    times_s: (f64, f64),
}

/// Why a curve was not fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    #[error("the curve has {0} samples, and at least {FEWEST} are needed")]
    TooFew(usize),
    #[error("the indentation does not change: there is no approach")]
    Still,
    #[error("{0}")]
    Shape(String),
    #[error(
        "no contact was found: the force does not rise with the indentation; are force and indentation positive into the specimen?"
    )]
    NoContact,
    #[error("the contact has {0} points, and at least {FEWEST_POINTS} are needed")]
    ShortContact(usize),
    #[error("none of the laws could be fitted")]
    NoLaw,
    #[error("interrupted")]
    Interrupted,
}

const FEWEST: usize = 16;
const FEWEST_POINTS: usize = 8;

/// By how much deeper than expected a contact may become during a fit.
const DEEPER: f64 = 1.3;

/// Points before contact that tell what the instrument adds.
const FEWEST_BEFORE: usize = 4;

const EXACTLY: Ending = Ending {
    iterations: 30,
    enough: 1e-5,
};

/// The widest that an unknown may go: a modulus of nothing, an exponent of nearly zero or one.
const WIDEST_LOGARITHM: f64 = 80.0;
const WIDEST_ODDS: f64 = 7.0;

/// Steps of unknowns for derivatives; that of the contact point is a part of the indentation.
const STEP: f64 = 0.01;
const STEP_OF_CONTACT: f64 = 2e-3;

/// The same on the way to the solution, to one side alone.
const FORWARD: f64 = 1e-3;

/// By how many times a start may be farther from the curve than the best and be followed too.
const NEARLY: f64 = 1.5;

impl CurvePlan {
    /// The relaxation modulus of the contact of a body of this series; `None` where the pair has none.
    fn contact(&self, series: &Relaxation) -> Option<Relaxation> {
        let kind = ModulusKind::Longitudinal;
        match (&self.indenter_material, self.compressibility.poisson_ratio()) {
            (None, Some(nu)) => series.scaled(1.0 / (1.0 - nu * nu)).ok(),
            (indenter, _) => {
                let body = Material::from_relaxation(
                    series.clone(),
                    kind,
                    self.compressibility.clone(),
                )
                .ok()?;
                let pair = match indenter {
                    Some(indenter) => body.against(indenter.clone()),
                    None => body,
                };
                pair.contact_compliance().ok()?.to_relaxation().ok()
            }
        }
    }
}

/// Where a curve begins to be a contact, as an elastic body would have it.
struct Touch {
    contact_point_m: f64,
    modulus_pa: f64,
    /// Points before it.
    before: usize,
}

/// The laws of a curve.
///
/// # Errors
/// [`CurveError`].
pub fn fit(
    plan: &CurvePlan,
    curve: &ForceCurve,
    interrupt: &AtomicBool,
) -> Result<CurveFit, CurveError> {
    let count = curve.time_s.len();
    if count < FEWEST {
        return Err(CurveError::TooFew(count));
    }
    let profile = body_of_revolution(plan.indenter.as_ref())
        .map_err(|error| CurveError::Shape(error.to_string()))?;
    let points = curve.points();
    let touch = touch(profile, &points)?;
    let deepest_m = largest(&points.indentation_m) - touch.contact_point_m;
    let springs = Springs::new(profile, DEEPER * deepest_m);
    let (first, last) = contact_times(&points, touch.contact_point_m);
    let in_contact = (points.indentation_m.iter())
        .filter(|d| **d > touch.contact_point_m)
        .count();
    if in_contact < FEWEST_POINTS {
        return Err(CurveError::ShortContact(in_contact));
    }
    let steps = points.time_s.windows(2).map(|t| t[1] - t[0]);
    let finest_s = steps
        .filter(|step| *step > 0.0)
        .fold(f64::INFINITY, f64::min);
    let whole_s = last - first;
    let mut fitted = Fitted {
        plan,
        points: &points,
        springs: &springs,
        times_s: (finest_s, points.time_s[points.time_s.len() - 1] - points.time_s[0]),
        scale_m: deepest_m,
        sigma_n: Vec::new(),
        nuisances: nuisances(&points, touch.before),
        basis: Vec::new(),
        interrupt,
    };
    fitted.weigh();
    let window_s = (whole_s / 50.0, whole_s);
    let nu = plan.compressibility.poisson_ratio().unwrap_or(0.5);
    let modulus_pa = touch.modulus_pa * (1.0 - nu * nu);
    let began = (modulus_pa, window_s, touch.contact_point_m);
    let forms = plan.forms.par_iter();
    let found: Vec<(Form, Solution<Vec<f64>>)> = forms
        .filter_map(|form| Some((*form, fitted.best(*form, began)?)))
        .collect();
    if interrupt.load(Ordering::Relaxed) {
        return Err(CurveError::Interrupted);
    }
    fitted.judged(found, (whole_s, window_s))
}

/// Weights exp(-c/2) of criteria, which sum to one.
fn weights_of(criteria: impl Iterator<Item = f64>) -> Vec<f64> {
    let criteria: Vec<f64> = criteria.collect();
    let least = criteria.iter().copied().fold(f64::INFINITY, f64::min);
    let likely: Vec<f64> = criteria.iter().map(|c| (-0.5 * (c - least)).exp()).collect();
    let all: f64 = likely.iter().sum();
    likely.into_iter().map(|one| one / all).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b))
}

/// First and last time (s) at which points are deeper than the contact point.
fn contact_times(points: &Points, contact_point_m: f64) -> (f64, f64) {
    let is_in = |d: &f64| *d > contact_point_m;
    let first = points.indentation_m.iter().position(is_in).unwrap_or(0);
    let last = points.indentation_m.iter().rposition(is_in).unwrap_or(0);
    (points.time_s[first], points.time_s[last])
}

/// Tries every point of the first approach as that of first contact, with a force that is constant before it and elastic from it on.
fn touch(profile: &dyn Axisymmetric, points: &Points) -> Result<Touch, CurveError> {
    let (least_m, deepest_m) = (
        points.indentation_m.iter().copied().fold(f64::INFINITY, f64::min),
        largest(&points.indentation_m),
    );
    if !(deepest_m > least_m) {
        return Err(CurveError::Still);
    }
    let springs = Springs::new(profile, 1.0001 * (deepest_m - least_m));
    // The approach ends where most of the depth has been reached for the first time.
    let is_deep = |d: &f64| *d >= deepest_m - 0.02 * (deepest_m - least_m);
    let end = points.indentation_m.iter().position(is_deep).unwrap_or(0);
    let mut best: Option<(f64, Touch)> = None;
    for start in 0..end.saturating_sub(3) {
        let contact_point_m = points.indentation_m[start];
        // An offset, where something tells it.
        let has_offset = start >= FEWEST_BEFORE;
        let mut sums = [0.0; 6];
        for k in 0..=end {
            let shape = springs.elastic_m2(points.indentation_m[k] - contact_point_m);
            let (w, force) = (points.samples[k], points.force_n[k]);
            for (sum, term) in sums.iter_mut().zip([
                1.0,
                shape,
                shape * shape,
                force,
                force * shape,
                force * force,
            ]) {
                *sum += w * term;
            }
        }
        let [n, s, ss, f, fs, ff] = sums;
        let (modulus_pa, left) = match has_offset {
            true => {
                let modulus_pa = (n * fs - s * f) / (n * ss - s * s);
                let offset = (f - modulus_pa * s) / n;
                (modulus_pa, ff - modulus_pa * fs - offset * f)
            }
            false => (fs / ss, ff - fs * fs / ss),
        };
        if modulus_pa > 0.0 && best.as_ref().is_none_or(|(least, _)| left < *least) {
            let touch = Touch {
                contact_point_m,
                modulus_pa,
                before: start,
            };
            best = Some((left, touch));
        }
    }
    best.map(|(_, touch)| touch).ok_or(CurveError::NoContact)
}

/// What the instrument may add that the curve can tell.
fn nuisances(points: &Points, before: usize) -> Vec<Nuisance> {
    let mut all = Vec::new();
    if before >= FEWEST_BEFORE {
        all.extend([Nuisance::Offset, Nuisance::Drift]);
        let fastest = points.speed_m_per_s.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
        let approach = points.speed_m_per_s[..before].iter().sum::<f64>() / before as f64;
        let is_other = |v: &&f64| (**v - approach).abs() > 0.3 * fastest;
        if points.speed_m_per_s.iter().filter(is_other).count() >= FEWEST_BEFORE {
            all.push(Nuisance::Drag);
        }
    }
    all
}

/// A curve as a least squares problem for any law.
struct Fitted<'a> {
    plan: &'a CurvePlan,
    points: &'a Points,
    springs: &'a Springs,
    /// The finest and the whole time (s) of the curve.
    times_s: (f64, f64),
    /// The unknown contact point is a part of this.
    scale_m: f64,
    sigma_n: Vec<f64>,
    nuisances: Vec<Nuisance>,
    /// What the instrument adds, orthogonal and of length one, in standard deviations of the points.
    basis: Vec<DVector<f64>>,
    interrupt: &'a AtomicBool,
}

/// The same for one.
struct OfForm<'a> {
    fitted: &'a Fitted<'a>,
    form: Form,
}

impl Fitted<'_> {
    /// Takes the standard deviations of the points, and what is linear in them.
    fn weigh(&mut self) {
        let sigma = self.points.samples.iter();
        self.sigma_n = sigma.map(|n| self.points.noise_n / n.sqrt()).collect();
        for nuisance in self.nuisances.clone() {
            let mut column = self.column(nuisance);
            for other in &self.basis {
                column -= other * other.dot(&column);
            }
            let length = column.norm();
            self.basis.push(column / length);
        }
    }

    /// What one of a nuisance adds to the force of every point, in its standard deviations.
    fn column(&self, nuisance: Nuisance) -> DVector<f64> {
        let points = self.points;
        let of = |k: usize| match nuisance {
            Nuisance::Offset => 1.0,
            Nuisance::Drift => points.time_s[k] - points.time_s[0],
            Nuisance::Drag => points.speed_m_per_s[k],
        };
        let all = (0..points.time_s.len()).map(|k| of(k) / self.sigma_n[k]);
        DVector::from_iterator(points.time_s.len(), all)
    }

    fn response(&self, form: Form, unknowns: &[f64]) -> Option<Vec<f64>> {
        let (contact_part, unknowns) = unknowns.split_last()?;
        let series = form.series_within(&form.values(unknowns), self.times_s)?;
        let contact = self.plan.contact(&series)?;
        let contact_point_m = contact_part * self.scale_m;
        let depths = self.points.indentation_m.iter();
        let depths: Vec<f64> = depths.map(|d| d - contact_point_m).collect();
        self.springs.response(&contact, &self.points.time_s, &depths)
    }

    /// Computed less measured forces in their standard deviations.
    fn off(&self, form: Form, unknowns: &[f64]) -> Option<DVector<f64>> {
        if self.interrupt.load(Ordering::Relaxed) {
            return None;
        }
        let response = self.response(form, unknowns)?;
        let all = response.iter().zip(&self.points.force_n);
        let off = all
            .zip(&self.sigma_n)
            .map(|((computed, measured), sigma)| (computed - measured) / sigma);
        Some(DVector::from_iterator(self.sigma_n.len(), off))
    }

    fn projected(&self, mut residuals: DVector<f64>) -> DVector<f64> {
        for column in &self.basis {
            let along = column.dot(&residuals);
            residuals -= column * along;
        }
        residuals
    }

    /// The least squares solution of a law, from the best of its starts on.
    fn best(
        &self,
        form: Form,
        (modulus_pa, window_s, contact_point_m): (f64, (f64, f64), f64),
    ) -> Option<Solution<Vec<f64>>> {
        let problem = OfForm { fitted: self, form };
        let mut starts: Vec<(f64, Vec<f64>)> = form
            .starts(modulus_pa, window_s)
            .into_iter()
            .filter_map(|mut start| {
                start.push(contact_point_m / self.scale_m);
                self.scaled(form, start)
            })
            .collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let nearly = NEARLY * starts.first()?.0;
        let all = starts.iter().take(2).filter(|(left, _)| *left <= nearly);
        let found = all.filter_map(|(_, start)| minimise(&problem, start, EXACTLY));
        found.min_by(|a, b| a.squares().total_cmp(&b.squares()))
    }

    /// A start with all its moduli multiplied so that it comes nearest to the curve, and the sum of squares that are left.
    fn scaled(&self, form: Form, mut start: Vec<f64>) -> Option<(f64, Vec<f64>)> {
        let response = self.response(form, &start)?;
        let weighed = |force: &[f64]| {
            let all = force.iter().zip(&self.sigma_n).map(|(f, s)| f / s);
            self.projected(DVector::from_iterator(self.sigma_n.len(), all))
        };
        let (computed, measured) = (weighed(&response), weighed(&self.points.force_n));
        let factor = computed.dot(&measured) / computed.norm_squared();
        let left = (computed * factor - measured).norm_squared();
        for (unknown, parameter) in start.iter_mut().zip(form.parameters()) {
            if parameter.scale == Scale::Logarithm(crate::quantity::Dimension::Stress) {
                *unknown += factor.max(1e-3).ln();
            }
        }
        Some((left, start))
    }

    /// All solutions as what is known of the curve.
    fn judged(
        &self,
        found: Vec<(Form, Solution<Vec<f64>>)>,
        (whole_s, (finest_s, _)): (f64, (f64, f64)),
    ) -> Result<CurveFit, CurveError> {
        let numbers = self.sigma_n.len();
        let nuisances = self.nuisances.len();
        let unknowns = |form: Form| form.parameters().len() + 1 + nuisances;
        let least = |(form, solution): &(Form, Solution<Vec<f64>>)| {
            solution.squares() / (numbers.saturating_sub(unknowns(*form))).max(1) as f64
        };
        let reduced = found.iter().map(least).fold(f64::INFINITY, f64::min);
        let schwarz = |(form, solution): &(Form, Solution<Vec<f64>>)| {
            let squares = solution.squares() / reduced.max(1.0);
            squares + unknowns(*form) as f64 * (numbers as f64).ln()
        };
        let best = found.iter().min_by(|a, b| schwarz(a).total_cmp(&schwarz(b)));
        let best = best.ok_or(CurveError::NoLaw)?;
        let degrees_of_freedom = numbers.saturating_sub(unknowns(best.0));
        let reduced_chi_squared = best.1.squares() / degrees_of_freedom.max(1) as f64;
        let is_missed = is_missed(reduced_chi_squared, degrees_of_freedom);
        let (inflation, half_width) = match is_missed {
            true => (
                reduced_chi_squared.sqrt(),
                student(degrees_of_freedom as f64),
            ),
            false => (1.0, NORMAL),
        };
        // Akaike's criterion has two in place of the logarithm, with the correction for few data.
        let akaike = |one: &(Form, Solution<Vec<f64>>)| {
            let k = unknowns(one.0) as f64;
            let n = numbers as f64;
            let squares = one.1.squares() / reduced.max(1.0);
            squares + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0).max(1.0)
        };
        let weights = weights_of(found.iter().map(schwarz));
        let akaike_weights = weights_of(found.iter().map(akaike));
        let all = found.iter().zip(weights.into_iter().zip(akaike_weights));
        let laws = all.map(|(one, weights)| {
            self.law(one, (schwarz(one), weights), (inflation, half_width))
        });
        let laws: Vec<Option<(FittedLaw, Vec<Estimate>)>> = laws.collect();
        let mut laws: Vec<(FittedLaw, Vec<Estimate>)> = laws.into_iter().flatten().collect();
        laws.sort_by(|a, b| a.0.schwarz.total_cmp(&b.0.schwarz));
        let (first, added) = laws.first().ok_or(CurveError::NoLaw)?;
        let own = added[0];
        let computed_n = self.computed_n(first, &added[1..]).ok_or(CurveError::NoLaw)?;
        let among = laws.iter().map(|(law, _)| {
            law.akaike_weight * (law.contact_point_m - own.value).powi(2)
        });
        let spread = half_width * among.sum::<f64>().sqrt();
        let half = (own.high - own.value).hypot(spread);
        let contact_point_m = Estimate {
            low: own.value - half,
            high: own.value + half,
            ..own
        };
        let nuisances = self.nuisances.iter().copied().zip(added[1..].to_vec());
        Ok(CurveFit {
            contact_point_m,
            nuisances: nuisances.collect(),
            degrees_of_freedom,
            reduced_chi_squared,
            inflation,
            window_rad_per_s: (1.0 / whole_s, 1.0 / finest_s),
            computed_n,
            points: self.points.clone(),
            error_n: self.sigma_n.clone(),
            times_s: self.times_s,
            laws: laws.into_iter().map(|(law, _)| law).collect(),
        })
    }

    /// A law with its intervals, and behind it contact point and nuisances with theirs.
    fn law(
        &self,
        (form, solution): &(Form, Solution<Vec<f64>>),
        (schwarz, (weight, akaike_weight)): (f64, (f64, f64)),
        (inflation, half_width): (f64, f64),
    ) -> Option<(FittedLaw, Vec<Estimate>)> {
        let problem = OfForm {
            fitted: self,
            form: *form,
        };
        let unknowns = &solution.unknowns;
        let mut columns = problem.columns(unknowns)?;
        let nuisances: Vec<DVector<f64>> = (self.nuisances.iter())
            .map(|nuisance| self.column(*nuisance))
            .collect();
        let lengths: Vec<f64> = nuisances.iter().map(DVector::norm).collect();
        columns.extend(nuisances.iter().zip(&lengths).map(|(column, length)| column / *length));
        let matrix = DMatrix::from_columns(&columns);
        let directions = Directions::new(&matrix, inflation)?;
        let covariance = directions.covariance();
        let half = |k: usize| half_width * covariance[(k, k)].sqrt();
        let count = unknowns.len() - 1;
        let parameters = form.parameters();
        let all = parameters.iter().zip(unknowns).enumerate();
        let parameters = all.map(|(k, (parameter, unknown))| {
            let at = |off: f64| parameter.scale.value(unknown + off);
            let half = half(k).min(WIDEST_LOGARITHM);
            Estimate {
                value: at(0.0),
                low: at(-half),
                high: at(half),
            }
        });
        let around = |value: f64, half: f64| Estimate {
            value,
            low: value - half,
            high: value + half,
        };
        let contact_point_m = unknowns[count] * self.scale_m;
        // What is linear follows from the residuals without it.
        let off = self.off(*form, unknowns)?;
        let of_nuisances = DMatrix::from_columns(&nuisances);
        let added = match nuisances.is_empty() {
            true => DVector::zeros(0),
            false => of_nuisances.svd(true, true).solve(&-off, 1e-14).ok()?,
        };
        let mut beside = vec![around(contact_point_m, half(count) * self.scale_m)];
        let added = added.iter().zip(&lengths).enumerate();
        beside.extend(added.map(|(k, (value, length))| around(*value, half(count + 1 + k) / length)));
        let law = FittedLaw {
            form: *form,
            parameters: parameters.collect(),
            chi_squared: solution.squares(),
            schwarz,
            weight,
            akaike_weight,
            values: form.values(&unknowns[..count]),
            unknowns: unknowns[..count].to_vec(),
            contact_point_m,
            directions,
            half_width,
        };
        Some((law, beside))
    }

    fn computed_n(&self, law: &FittedLaw, added: &[Estimate]) -> Option<Vec<f64>> {
        let mut unknowns = law.unknowns.clone();
        unknowns.push(law.contact_point_m / self.scale_m);
        let response = self.response(law.form, &unknowns)?;
        let columns = self.nuisances.iter().zip(added);
        let columns: Vec<DVector<f64>> = columns
            .map(|(nuisance, estimate)| self.column(*nuisance) * estimate.value)
            .collect();
        let all = response.iter().enumerate();
        Some(
            all.map(|(k, force)| {
                force + columns.iter().map(|c| c[k] * self.sigma_n[k]).sum::<f64>()
            })
            .collect(),
        )
    }
}

impl OfForm<'_> {
    /// Derivatives of the residuals before anything is projected out.
    fn columns(&self, unknowns: &[f64]) -> Option<Vec<DVector<f64>>> {
        let last = unknowns.len() - 1;
        let column = |k: usize| {
            let step = if k == last { STEP_OF_CONTACT } else { STEP };
            let at = |off: f64| {
                let mut moved = unknowns.to_vec();
                moved[k] += off;
                self.fitted.off(self.form, &moved)
            };
            Some((at(step)? - at(-step)?) / (2.0 * step))
        };
        (0..unknowns.len()).map(column).collect()
    }
}

impl Problem for OfForm<'_> {
    type Unknowns = Vec<f64>;

    fn residuals(&self, unknowns: &Vec<f64>) -> Option<DVector<f64>> {
        let off = self.fitted.off(self.form, unknowns)?;
        Some(self.fitted.projected(off))
    }

    fn derivatives(&self, unknowns: &Vec<f64>) -> Option<DMatrix<f64>> {
        let here = self.fitted.off(self.form, unknowns)?;
        let column = |k: usize| {
            let mut moved = unknowns.clone();
            moved[k] += FORWARD;
            let off = self.fitted.off(self.form, &moved)? - &here;
            Some(self.fitted.projected(off / FORWARD))
        };
        let columns: Option<Vec<DVector<f64>>> = (0..unknowns.len()).map(column).collect();
        Some(DMatrix::from_columns(&columns?))
    }

    fn clamp(&self, place: usize, value: f64) -> f64 {
        let parameters = self.form.parameters();
        match parameters.get(place).map(|p| p.scale) {
            Some(Scale::Odds) => value.clamp(-WIDEST_ODDS, WIDEST_ODDS),
            Some(Scale::Logarithm(_)) => value.clamp(-WIDEST_LOGARITHM, WIDEST_LOGARITHM),
            None => value,
        }
    }
}

impl FittedLaw {
    /// Logarithms of storage and loss modulus (Pa).
    fn ln_moduli(&self, unknowns: &[f64], omega: f64) -> Option<[f64; 2]> {
        let modulus = self.form.complex_modulus_pa(&self.form.values(unknowns), omega)?;
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
    /// The law that is most likely.
    pub fn law(&self) -> &FittedLaw {
        &self.laws[0]
    }

    /// The moduli at an angular frequency (rad/s), with bands in which the other laws are by their weights; outside the window they are
    /// extrapolations.
    pub fn band(&self, angular_frequency_rad_per_s: f64) -> Option<ModulusBand> {
        let omega = angular_frequency_rad_per_s;
        let own = self.law().moduli(omega)?;
        let mut variances = own.map(|(_, variance)| variance);
        for other in self.laws.iter().skip(1).filter(|law| law.akaike_weight > 1e-4) {
            let theirs = other.moduli(omega)?;
            for part in 0..2 {
                let (apart, wider) = (
                    theirs[part].0 - own[part].0,
                    (theirs[part].1 - own[part].1).max(0.0),
                );
                variances[part] += other.akaike_weight * (apart * apart + wider);
            }
        }
        let half_width = self.law().half_width;
        let factor = |variance: f64| (half_width * variance.sqrt()).min(60.0).exp();
        Some(ModulusBand {
            storage_pa: own[0].0.exp(),
            loss_pa: own[1].0.exp(),
            storage_factor: factor(variances[0]),
            loss_factor: factor(variances[1]),
        })
    }

    /// The series that stands for the best law over the times of the curve, and a decade beyond.
    pub fn series(&self) -> Option<Relaxation> {
        let (finest_s, whole_s) = self.times_s;
        let law = self.law();
        law.form
            .series_within(&law.values, (0.1 * finest_s, 10.0 * whole_s))
    }
}
