//! What was found of a curve: its laws with their weights and intervals, and the moduli with their bands.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::fit::CurveError;
use super::problem::{EXACTLY, Fitted, OfForm};
use super::record::Points;
use super::touch::Nuisance;
use crate::identify::laws::{Drawn, Estimate, FittedLaw, Laws, Numbers, Tried, beyond};
use crate::material::law::Form;
use crate::numerics::levenberg_marquardt::{Solution, minimise_along_valleys};
use crate::numerics::random::Noise;

/// What was found of a curve.
#[derive(Debug, Clone)]
pub struct CurveFit {
    pub laws: Laws,
    /// The indentation at which the contact begins, as the curve counts it.
    pub contact_point_m: Estimate,
    /// Work of adhesion (J/m^2) and range (m), as many as were sought.
    pub attraction: Vec<Estimate>,
    pub nuisances: Vec<(Nuisance, Estimate)>,
    /// Angular frequencies (rad/s) about which the curve says something: one over its contact time, and over its finest.
    pub window_rad_per_s: (f64, f64),
    pub points: Points,
    /// The force (N) of the best law at these, with what the instrument adds.
    pub computed_n: Vec<f64>,
    /// Standard deviation (N) of each point.
    pub error_n: Vec<f64>,
    /// Whether the retraction pulls, and is left out.
    pub is_pulled: bool,
    /// What is found where the noise falls otherwise, with its contact point (m), each alike in probability; empty where none was asked for.
    pub ensemble: Vec<(Drawn, f64)>,
}

/// A law and its least squares solution.
pub(super) type Solved = (Form, Solution<Vec<f64>>);

impl Fitted<'_> {
    /// All solutions as what is known of the curve; whose contact lasts so long (s), of which the finest time tells anything.
    pub(super) fn judged(
        &self,
        found: &[Solved],
        (finest_s, whole_s): (f64, f64),
    ) -> Result<CurveFit, CurveError> {
        let nuisances = self.nuisances.iter().map(|nuisance| self.column(*nuisance));
        let nuisances: Vec<DVector<f64>> = nuisances.collect();
        let lengths: Vec<f64> = nuisances.iter().map(DVector::norm).collect();
        let tried = found.iter().filter_map(|(form, solution)| {
            let problem = OfForm {
                fitted: self,
                form: *form,
                is_near: true,
            };
            let mut columns = problem.columns(&solution.unknowns)?;
            let of_length_one = nuisances.iter().zip(&lengths);
            columns.extend(of_length_one.map(|(column, length)| column / *length));
            Some(Tried {
                form: *form,
                unknowns: solution.unknowns.clone(),
                squares: solution.squares(),
                derivatives: DMatrix::from_columns(&columns),
                in_common: self.in_common(*form, &solution.unknowns)?,
            })
        });
        let numbers = Numbers {
            count: self.sigma_n.len(),
            is_noise_known: true,
            times_s: self.times_s,
        };
        let laws = Laws::of(&tried.collect::<Vec<_>>(), &numbers).ok_or(CurveError::NoLaw)?;
        let best = laws.best();
        let sought = self.plan.attraction.count();
        // With what the laws say otherwise: the contact point, and what is sought of the attraction.
        let beside_law = |behind: usize| {
            let unknown = |law: &FittedLaw| law.unknowns[law.unknowns.len() - 1 - sought + behind];
            let own = unknown(best);
            let among = laws.all.iter();
            let among = among.map(|law| law.akaike_weight * (unknown(law) - own).powi(2));
            let spread = laws.half_width * among.sum::<f64>().sqrt();
            let half = best.halves[best.unknowns.len() - 1 - sought + behind];
            Estimate::around(own, half.hypot(spread))
        };
        let beside = &best.halves[best.unknowns.len()..];
        let off = self.off(best.form, &best.unknowns, true);
        let added = off.and_then(|off| self.added(&nuisances, &off));
        let added = added.ok_or(CurveError::NoLaw)?;
        let halves = beside
            .iter()
            .zip(&lengths)
            .map(|(half, length)| half / length);
        let estimates =
            (added.iter().zip(halves)).map(|(value, half)| Estimate::around(*value, half));
        let computed_n = self.computed_n(best, &added).ok_or(CurveError::NoLaw)?;
        Ok(CurveFit {
            contact_point_m: beside_law(0).of(|part| part * self.scale_m),
            attraction: (1..=sought).map(|k| beside_law(k).of(f64::exp)).collect(),
            nuisances: self.nuisances.iter().copied().zip(estimates).collect(),
            window_rad_per_s: (1.0 / whole_s, 1.0 / finest_s),
            computed_n,
            points: self.points.clone(),
            error_n: self.sigma_n.clone(),
            is_pulled: false,
            ensemble: Vec::new(),
            laws,
        })
    }

    /// What the uncertainties of spring constant and radius change in the residuals, at one standard deviation.
    fn in_common(&self, form: Form, unknowns: &[f64]) -> Option<Vec<f64>> {
        let scale = (self.plan.probe).scale_uncertainty(self.plan.contact.indenter.as_ref());
        if scale == 0.0 {
            return Some(Vec::new());
        }
        let response = self.response(form, unknowns, true)?;
        let all = response.iter().zip(&self.sigma_n);
        Some(
            all.map(|(force_n, sigma_n)| scale * force_n / sigma_n)
                .collect(),
        )
    }

    /// A parametric bootstrap (B. Efron, R. J. Tibshirani, *An Introduction to the Bootstrap*, Chapman & Hall 1993, section 6.5): the computed
    /// curve with noise as the best law leaves it, to which a law is fitted, each as often as its weight in the band says.
    pub(super) fn ensemble(&self, found: &CurveFit, samples: usize) -> Vec<(Drawn, f64)> {
        const SEED: u64 = 1;
        let draw = |number: usize| {
            let mut random = Noise::stream(SEED, number as u64);
            let law = found.laws.drawn(random.uniform());
            let mut points = self.points.clone();
            let computed = found.computed_n.iter().zip(&self.sigma_n);
            for (force_n, (computed_n, sigma_n)) in points.force_n.iter_mut().zip(computed) {
                *force_n = computed_n + found.laws.inflation * sigma_n * random.normal();
            }
            let fitted = self.with_points(&points);
            let problem = OfForm {
                fitted: &fitted,
                form: law.form,
                is_near: true,
            };
            let unknowns = minimise_along_valleys(&problem, &law.unknowns, EXACTLY)?.unknowns;
            let (of_law, contact_part, _) = self.parts(&unknowns)?;
            let values = law.form.values(of_law);
            let drawn = Drawn {
                form: law.form,
                series: law.form.series_within(&values, beyond(self.times_s))?,
                values,
            };
            Some((drawn, contact_part * self.scale_m))
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

    fn computed_n(&self, law: &FittedLaw, added: &[f64]) -> Option<Vec<f64>> {
        let mut force_n = self.response(law.form, &law.unknowns, true)?;
        for (nuisance, size) in self.nuisances.iter().zip(added) {
            let column = self.column(*nuisance);
            let added = column.iter().zip(&self.sigma_n);
            for (force_n, (added, sigma_n)) in force_n.iter_mut().zip(added) {
                *force_n += added * sigma_n * size;
            }
        }
        Some(force_n)
    }
}
