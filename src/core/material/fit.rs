//! A series of exponentials through tabulated data, no strength negative, with its misfit and what had to be assumed.
//!
//! Creep compliance: `D_0 + sum D_j (1 - exp(-t/lambda_j)) [+ t/eta]`; relaxation modulus: `g_inf + sum g_i exp(-t/tau_i)`.
//! Non-negative strengths are what makes a series passive. They are found by non-negative least squares on times
//! log-spaced over the data (M. Baumgaertel and H. H. Winter, Rheologica Acta 28 (1989) 511, say why the grid alone gives more
//! branches than the data hold), with residuals relative to the data. Then neighbouring branches are merged, the times are refined
//! together with the strengths, and branches are taken away as long as the criterion of C. L. Mallows (Technometrics 15 (1973)
//! 661) says so: the sum of squares in units of the variance of the noise, and [`PRICE`] for every parameter. The noise is what
//! the best non-negative spectrum leaves, ten times per decade, but no less than the rounding of the values as they were
//! written ([`Tabulated::rounding`]), and no less than 0.01 %: smaller misfits count as none.
//!
//! # Solid or fluid
//!
//! A table ends, and a branch that is slow enough is a flow as long as it lasts. A solid is assumed where the data do not
//! resolve the difference; who knows better says so. Sums of squares below are in units of the variance of the noise, and
//! belong to the best spectrum up to the last time of the table, so that no number of branches enters.
//!
//! - A creep compliance flows where a flow term lowers the sum of squares by more than [`PRICE`], the price of a parameter,
//!   and no solid with few branches scores better or leaves nothing to explain. Tried on 500 seeded solids and
//!   fluids (1 to 8 branches, three to six decades, 0.1 to 3 % of noise, three digits): two solids were taken for fluids, none
//!   of the 316 that have retarded by a third of the last time; of fluids that flow by 10 to 60 % of the last compliance and
//!   have retarded a decade before the end, 17 of 181 were taken for solids, all but one with a flow below 21 times the noise.
//! - A relaxation modulus is that of a fluid where the sum of squares is worse by no more than [`ALLOWED`] without an
//!   equilibrium modulus, and by more than [`PRICE`] where [`LEFT`] of the last value is held for it.
//!
//! # What the data leave open
//!
//! - Branch times lie between the first positive time of the table (a fifth of it, where there is a sample at time zero) and
//!   twice its last time. What happens before the first sample counts as instantaneous, and the value at time zero is an
//!   extrapolation by the branches that are there: reported, and a warning where it exceeds one per cent.
//! - The [alternatives](Fit::alternatives) are other series that fit about as well, by no more than [`ALLOWED`] in the sum of
//!   squares (two standard deviations): with the lowest and the highest equilibrium value, and the lowest and the highest loss
//!   at one over the last time, where the material may go on to change for a decade after the last sample; and with the lowest
//!   and the highest value at time zero, where it may have changed from half the time of the first sample on. All within a
//!   factor of ten of the fit's own value.
//! - Among them are [`SAMPLES`] bootstrap samples, which say what the noise of the data does within their times (a parametric
//!   bootstrap: B. Efron and R. J. Tibshirani, *An Introduction to the Bootstrap*, Chapman and Hall 1993, section 6.5): the best spectrum
//!   of any number of branches is measured again at the times of the table, with the noise of its samples, and a spectrum is fitted
//!   again, its times on a grid of its own, so that what the few branches of the fit smooth away shows as a difference. The largest of
//!   their differences from the fit, in any one number, is an interval of `n/(n + 1)` of all cases, 96 %: the truth is as likely as each of
//!   them to be the one that is farthest off.
//!
//! Where there are more than forty samples per decade they are averaged in groups of a fortieth decade, which weigh as the mean
//! of that many samples, but of no more than a hundred: what all of them have in common does not average out. So a table with
//! equal time steps is not fitted in its last decade alone. The misfit reported is that of the samples as given.

#[cfg(test)]
mod noisy;
mod report;
mod search;

use rayon::prelude::*;

use super::spectrum::Series;
use super::tabulated::Tabulated;
use super::{
    Compressibility, Creep, CreepBranch, Material, MaterialError, MaterialFunction, Origin,
    Relaxation, RelaxationBranch,
};
use crate::numerics::nnls::NnlsError;
use crate::numerics::order::upper_median;
use crate::numerics::random::Noise;
use report::FAR_FROM_EQUILIBRIUM;
pub use report::{FitRemark, FitReport, Misfit};
use search::{Open, Search};

/// What a parameter must lower the sum of squares by, in units of the variance of the noise (H. Akaike, IEEE Transactions on
/// Automatic Control 19 (1974) 716).
pub const PRICE: f64 = 2.0;

/// By how much that sum may be higher for a series that fits about as well.
pub const ALLOWED: f64 = 4.0;

/// Share of the last relaxation modulus that is an equilibrium modulus worth having.
pub const LEFT: f64 = 0.2;

/// Relative misfit that counts as none, however many digits the data have.
const NOTICEABLE: f64 = 1e-4;

/// Branch times in units of the first positive time (without and with a sample at time zero) and of the last.
const SHORTEST: (f64, f64) = (1.0, 0.2);
const LONGEST: f64 = 2.0;

/// The same for the alternatives: what may have changed before the data begin, and may change after they end.
const BEFORE: f64 = 0.5;
const AFTER: f64 = 10.0;

/// Ratio to the fit's own value beyond which no alternative is looked for.
const WIDEST: f64 = 10.0;

/// Bootstrap samples among the alternatives.
pub const SAMPLES: usize = 24;

/// Of their random numbers.
const SEED: u64 = 1;

/// Why no fit was made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    #[error("the table cannot be fitted: {0}")]
    LeastSquares(#[from] NnlsError),
    #[error("the fit is no material: {0}")]
    Material(#[from] MaterialError),
    #[error("the creep compliance does not flow: no series fits the better for a viscosity")]
    NoFlow,
}

/// A series fitted to a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    series: FittedSeries,
    alternatives: Vec<FittedSeries>,
    report: FitReport,
}

/// The series, of the function and kind of the table.
#[derive(Debug, Clone, PartialEq)]
pub enum FittedSeries {
    Creep(Creep),
    Relaxation(Relaxation),
}

/// Fits a series to a table: that of a fluid or of a solid as `flow` says, and as the data say where it does not.
///
/// # Errors
/// [`FitError`]: least squares that do not end, strengths beyond the range of a double, or a flow that is asked for and not
/// in the data.
pub fn fit(table: &Tabulated, flow: Option<bool>) -> Result<Fit, FitError> {
    let groups = table.groups();
    let reference = upper_median(groups.values.iter().copied()).unwrap_or(1.0);
    let mut problem = Problem {
        table,
        values: groups.values.iter().map(|v| v / reference).collect(),
        weights: groups.weights(),
        noise: NOTICEABLE.max(table.rounding()),
        reference,
    };
    let most = problem.search(table.function() == MaterialFunction::Creep, LONGEST);
    problem.noise = most.residual()?.max(problem.noise);
    let candidates = problem.candidates()?;
    let is_fluid = match flow {
        Some(flow) => flow,
        None => problem.is_fluid(&candidates)?,
    };
    let function = table.function();
    if is_fluid && function == MaterialFunction::Creep && candidates.fluid.flow_per_s == 0.0 {
        return Err(FitError::NoFlow);
    }
    let mut remarks: Vec<_> = table
        .warnings()
        .iter()
        .cloned()
        .map(FitRemark::Table)
        .collect();
    if function == MaterialFunction::Creep {
        remarks.push(problem.flow_remark(&candidates, is_fluid));
    }
    let series = match is_fluid {
        true => candidates.fluid,
        false => candidates.solid,
    };
    let ends = problem.variants(&series, is_fluid)?;
    remarks.extend(problem.extrapolations(&series, &ends));
    let in_si = |series: &Series| in_si(function, series, reference);
    let fitted = in_si(&series)?;
    let samples = problem.samples(&series, is_fluid)?;
    let ends = ends.iter().map(|end| &end.series);
    let alternatives: Result<_, _> = ends.chain(&samples).map(in_si).collect();
    let report = FitReport {
        function,
        kind: table.kind(),
        samples: table.times_s().len(),
        groups: groups.values.len(),
        first_s: table.times_s()[0],
        last_s: table.curve().last_time_s(),
        window_s: table.window_s(),
        branches: series.branches.len(),
        misfit: misfit(table, &fitted),
        remarks,
    };
    Ok(Fit {
        series: fitted,
        alternatives: alternatives?,
        report,
    })
}

/// A table in units of one of its values.
struct Problem<'a> {
    table: &'a Tabulated,
    values: Vec<f64>,
    weights: Vec<f64>,
    noise: f64,
    reference: f64,
}

/// The best series of a solid and of a fluid.
struct Candidates {
    solid: Series,
    fluid: Series,
}

/// A series that fits about as well, and what is different in it.
struct Variant {
    open: Open,
    series: Series,
}

impl Problem<'_> {
    /// The search for series with branch times up to this multiple of the last time.
    fn search(&self, flow: bool, longest: f64) -> Search<'_> {
        let curve = self.table.curve();
        let knows_zero = self.table.times_s()[0] == 0.0;
        let shortest = if knows_zero { SHORTEST.1 } else { SHORTEST.0 };
        let first_s = curve.shortest_time_s().unwrap_or(1.0);
        Search {
            function: self.table.function(),
            times_s: &self.table.groups().times_s,
            values: &self.values,
            weights: &self.weights,
            limits_s: (shortest * first_s, longest * curve.last_time_s()),
            flow,
            noise: self.noise,
        }
    }

    fn candidates(&self) -> Result<Candidates, FitError> {
        let search = self.search(false, LONGEST);
        let mut solid = search.run(&[])?;
        let least = self.values.iter().copied().fold(f64::INFINITY, f64::min);
        if self.table.function() == MaterialFunction::Relaxation
            && solid.constant < NOTICEABLE * least
        {
            // Half of the largest equilibrium modulus that the data allow.
            let most = self.allowed(&search, &solid);
            let range = (NOTICEABLE * least, least);
            let times = solid.times_s();
            let highest = search.farthest(Open::Equilibrium, range, most, &times)?;
            let highest = highest.map_or(range.0, |series| series.constant);
            solid = search.with_open(Open::Equilibrium, 0.5 * highest, &times)?;
        }
        let fluid = self.search(true, 1.0).run(&solid.times_s())?;
        Ok(Candidates { solid, fluid })
    }

    /// Whether the data resolve a flow.
    fn is_fluid(&self, candidates: &Candidates) -> Result<bool, FitError> {
        let Candidates { solid, fluid } = candidates;
        let (resting, flowing) = (self.search(false, 1.0), self.search(true, 1.0));
        let creeps = self.table.function() == MaterialFunction::Creep;
        let explained = resting.misfit(solid) <= NOTICEABLE;
        if creeps && (explained || resting.score(solid) < flowing.score(fluid) - PRICE) {
            return Ok(false);
        }
        let rests = resting.chi_squared(&resting.spectrum(&solid.times_s())?);
        let flows = flowing.chi_squared(&flowing.spectrum(&fluid.times_s())?);
        if creeps {
            return Ok(rests - flows > PRICE);
        }
        let left = LEFT * self.values[self.values.len() - 1];
        let held = resting.with_open(Open::Equilibrium, left, &solid.times_s())?;
        Ok(flows - rests <= ALLOWED && resting.chi_squared(&held) - rests > PRICE)
    }

    fn flow_remark(&self, candidates: &Candidates, is_fluid: bool) -> FitRemark {
        let search = self.search(true, 1.0);
        let rms_without = search.misfit(&candidates.solid);
        let rms_with = search.misfit(&candidates.fluid);
        match is_fluid {
            true => FitRemark::Flow {
                viscosity_pa_s: 1.0 / (candidates.fluid.flow_per_s * self.reference),
                rms_without,
                rms_with,
            },
            false => FitRemark::NoFlow {
                rms_without,
                rms_with,
            },
        }
    }

    /// The largest sum of squares of a series that fits about as well as this one.
    fn allowed(&self, search: &Search<'_>, series: &Series) -> f64 {
        search.squares(series) + ALLOWED * self.noise * self.noise
    }

    /// The series that fit about as well and have the lowest and highest values at the ends of time.
    fn variants(&self, fit: &Series, is_fluid: bool) -> Result<Vec<Variant>, FitError> {
        let function = self.table.function();
        let later = self.search(is_fluid, AFTER);
        let mut earlier = self.search(is_fluid, LONGEST);
        earlier.limits_s.0 *= BEFORE;
        let most = self.allowed(&later, fit);
        let mut ends = Vec::new();
        let slowest = Open::Loss(1.0 / self.table.curve().last_time_s());
        for (open, search, applies) in [
            (Open::Equilibrium, &later, !is_fluid),
            (slowest, &later, true),
            (Open::Instantaneous, &earlier, self.table.times_s()[0] > 0.0),
        ] {
            let value = fit.open(function, open);
            // What has no instantaneous compliance cannot go into contact, and what differs from it does not fit.
            let rigid = fit.open(function, Open::Instantaneous) == 0.0;
            if !applies || rigid || value == 0.0 {
                continue;
            }
            for limit in [value / WIDEST, value * WIDEST] {
                let series = search.farthest(open, (value, limit), most, &fit.times_s())?;
                let differs = |series: &Series| {
                    (series.open(function, open) / value - 1.0).abs() > NOTICEABLE
                };
                let series = series.filter(differs);
                ends.extend(series.map(|series| Variant { open, series }));
            }
        }
        Ok(ends)
    }

    /// The bootstrap samples: spectra fitted to other noise.
    fn samples(&self, fit: &Series, is_fluid: bool) -> Result<Vec<Series>, FitError> {
        let search = self.search(is_fluid, if is_fluid { 1.0 } else { LONGEST });
        let spectrum = search.spectrum(&fit.times_s())?;
        let at_rest = |series: &Series| series.constant > 0.0;
        let sample = |number: usize| {
            let mut random = Noise::stream(SEED, number as u64);
            let points = search.times_s.iter().zip(&self.weights);
            let values = points.map(|(&time_s, weight)| {
                let noise = self.noise / weight * random.normal();
                spectrum.value(search.function, time_s) * noise.exp()
            });
            let values: Vec<f64> = values.collect();
            let again = Search {
                values: &values,
                ..search
            };
            again.spectrum_on(random.uniform())
        };
        let samples: Vec<Result<Series, _>> = (0..SAMPLES).into_par_iter().map(sample).collect();
        let samples = samples.into_iter().collect::<Result<Vec<_>, _>>()?;
        // Of a fit that rests, or answers at once, a sample that does not is none of the same kind.
        let same_kind = |sample: &Series| at_rest(sample) || !at_rest(fit);
        Ok(samples.into_iter().filter(same_kind).collect())
    }

    /// What the series says where there are no data.
    fn extrapolations(&self, series: &Series, ends: &[Variant]) -> Vec<FitRemark> {
        let function = self.table.function();
        let value = |time_s: f64| series.value(function, time_s);
        let range = |open: Open| {
            let others = ends.iter().filter(|other| other.open == open);
            let others = others.map(|other| other.series.open(function, open));
            let own = series.open(function, open);
            let both = others.fold((own, own), |(a, b), v| (a.min(v), b.max(v)));
            (both.0 * self.reference, both.1 * self.reference)
        };
        let mut remarks = Vec::new();
        let first_s = self.table.times_s()[0];
        if function == MaterialFunction::Creep && series.constant == 0.0 {
            remarks.push(FitRemark::InstantaneouslyRigid { first_s });
        } else if first_s > 0.0 {
            remarks.push(FitRemark::Instantaneous {
                function,
                first_s,
                value: value(0.0) * self.reference,
                share: (value(0.0) / value(first_s) - 1.0).abs(),
                allowed: range(Open::Instantaneous),
            });
        }
        let equilibrium = series.open(function, Open::Equilibrium);
        if function == MaterialFunction::Relaxation && equilibrium == 0.0 {
            remarks.push(FitRemark::NoEquilibrium);
        } else if series.flow_per_s == 0.0 {
            let last_s = self.table.curve().last_time_s();
            let share = (equilibrium / value(last_s) - 1.0).abs();
            if share > FAR_FROM_EQUILIBRIUM {
                remarks.push(FitRemark::Equilibrium {
                    function,
                    last_s,
                    share,
                    allowed: range(Open::Equilibrium),
                });
            }
        }
        remarks
    }
}

fn in_si(
    function: MaterialFunction,
    series: &Series,
    reference: f64,
) -> Result<FittedSeries, MaterialError> {
    let branches = series.branches.iter();
    let constant = series.constant * reference;
    Ok(match function {
        MaterialFunction::Creep => {
            let branches = branches.map(|b| CreepBranch {
                compliance_per_pa: b.strength * reference,
                time_s: b.time_s,
            });
            let viscosity =
                (series.flow_per_s > 0.0).then(|| 1.0 / (series.flow_per_s * reference));
            FittedSeries::Creep(Creep::new(constant, branches.collect(), viscosity)?)
        }
        MaterialFunction::Relaxation => {
            let branches = branches.map(|b| RelaxationBranch {
                modulus_pa: b.strength * reference,
                time_s: b.time_s,
            });
            FittedSeries::Relaxation(Relaxation::new(constant, branches.collect())?)
        }
    })
}

fn misfit(table: &Tabulated, series: &FittedSeries) -> Misfit {
    let mut squares = 0.0;
    let mut misfit = Misfit {
        rms: 0.0,
        largest: 0.0,
        largest_at_s: table.times_s()[0],
    };
    for (&time_s, value) in table.times_s().iter().zip(table.values()) {
        let difference = (series.value(time_s) / value - 1.0).abs();
        squares += difference * difference;
        if difference > misfit.largest {
            misfit.largest = difference;
            misfit.largest_at_s = time_s;
        }
    }
    misfit.rms = (squares / table.times_s().len() as f64).sqrt();
    misfit
}

impl FittedSeries {
    /// Creep compliance (1/Pa) or relaxation modulus (Pa) at a time.
    pub fn value(&self, time_s: f64) -> f64 {
        match self {
            Self::Creep(creep) => creep.compliance(time_s),
            Self::Relaxation(relaxation) => relaxation.modulus(time_s),
        }
    }
}

impl Fit {
    /// The series.
    pub fn series(&self) -> &FittedSeries {
        &self.series
    }

    /// As a relaxation; `None` where that cannot be computed.
    pub fn relaxation(&self) -> Option<Relaxation> {
        match &self.series {
            FittedSeries::Relaxation(series) => Some(series.clone()),
            FittedSeries::Creep(creep) => creep.to_relaxation().ok(),
        }
    }

    /// How well it fits, and what was assumed.
    pub fn report(&self) -> &FitReport {
        &self.report
    }

    /// Series that fit about as well and differ in what the data leave open: the values at the ends of time.
    pub fn alternatives(&self) -> &[FittedSeries] {
        &self.alternatives
    }

    /// The material of the series, which carries the report, the times of the data and the alternatives with it.
    ///
    /// # Errors
    /// A Poisson ratio outside -1 < nu <= 1/2, or a conversion beyond the range of a double.
    pub fn material(
        &self,
        compressibility: impl Into<Compressibility>,
    ) -> Result<Material, MaterialError> {
        let (kind, compressibility) = (self.report.kind, compressibility.into());
        let material = |series: &FittedSeries| match series {
            FittedSeries::Creep(creep) => {
                Material::from_creep(creep.clone(), kind, compressibility.clone())
            }
            FittedSeries::Relaxation(relaxation) => {
                Material::from_relaxation(relaxation.clone(), kind, compressibility.clone())
            }
        };
        let alternatives: Result<_, _> = self.alternatives.iter().map(material).collect();
        let mut made = material(&self.series)?;
        made.origin = Origin {
            fit: Some(self.report.clone()),
            measured_window_s: Some(self.report.window_s),
            alternatives: alternatives?,
            ..Origin::default()
        };
        Ok(made)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::ModulusKind;
    use crate::material::library;
    use crate::material::synthetic::{Noise, log_spaced};
    use crate::material::tabulated::TableWarning;

    fn pmma() -> Material {
        library::find("pmma").unwrap().material().unwrap()
    }

    fn fitted(function: MaterialFunction, times: Vec<f64>, value: impl FnMut(f64) -> f64) -> Fit {
        let values = times.iter().copied().map(value).collect();
        fit(
            &Tabulated::new(function, ModulusKind::Longitudinal, times, values).unwrap(),
            None,
        )
        .unwrap()
    }

    fn noisy(
        function: MaterialFunction,
        times: Vec<f64>,
        seed: u64,
        value: impl Fn(f64) -> f64,
    ) -> Fit {
        let mut noise = Noise(seed);
        fitted(function, times, |t| {
            value(t) * (1.0 + 0.01 * noise.normal())
        })
    }

    fn creep(fit: &Fit) -> &Creep {
        match fit.series() {
            FittedSeries::Creep(creep) => creep,
            other => panic!("{other:?}"),
        }
    }

    fn relaxation(fit: &Fit) -> &Relaxation {
        match fit.series() {
            FittedSeries::Relaxation(relaxation) => relaxation,
            other => panic!("{other:?}"),
        }
    }

    fn has(fit: &Fit, remark: impl Fn(&FitRemark) -> bool) -> bool {
        fit.report().remarks.iter().any(remark)
    }

    fn relative(found: f64, expected: f64) -> f64 {
        (found / expected - 1.0).abs()
    }

    #[test]
    fn clean_data_of_two_branches_give_back_these_two() {
        let material = pmma();
        for (from, per_decade) in [(0.1, 10), (0.1, 3), (1.0, 40), (0.01, 5)] {
            let times = || log_spaced(from, 1e3, per_decade);
            let fit = fitted(MaterialFunction::Creep, times(), |t| {
                material.creep().compliance(t)
            });
            let (found, exact) = (creep(&fit), material.creep());
            assert_eq!(found.branches().len(), 2, "{from} {per_decade}");
            // Gauss-Newton steps converge to rounding, which the condition of the problem amplifies a thousandfold.
            for (branch, exact) in found.branches().iter().zip(exact.branches()) {
                assert!(relative(branch.time_s, exact.time_s) < 1e-9);
                assert!(relative(branch.compliance_per_pa, exact.compliance_per_pa) < 1e-9);
            }
            assert!(fit.report().misfit.largest < 1e-12);
            assert!(has(&fit, |r| matches!(r, FitRemark::NoFlow { .. })));

            let exact = material.relaxation().unwrap();
            let fit = fitted(MaterialFunction::Relaxation, times(), |t| exact.modulus(t));
            let found = relaxation(&fit);
            assert_eq!(found.branches().len(), 2);
            assert!(relative(found.equilibrium_modulus(), exact.equilibrium_modulus()) < 1e-9);
            for (branch, exact) in found.branches().iter().zip(exact.branches()) {
                assert!(relative(branch.time_s, exact.time_s) < 1e-9);
            }
        }
    }

    #[test]
    fn noise_of_one_per_cent_leaves_a_misfit_of_one_per_cent_and_the_loss_peaks_in_place() {
        let material = pmma();
        let exact = material.loss_peaks(ModulusKind::Longitudinal).unwrap();
        let mut worst = 0.0_f64;
        for seed in 1..=6 {
            let modulus = |t: f64| material.relaxation().unwrap().modulus(t);
            let fit = noisy(
                MaterialFunction::Relaxation,
                log_spaced(0.1, 1e4, 40),
                seed,
                modulus,
            );
            let misfit = fit.report().misfit;
            // 201 samples: the sample deviation is known to 1/sqrt(402) = 5 %, five parameters take away 1 %.
            assert!((0.85e-2..1.15e-2).contains(&misfit.rms), "{}", misfit.rms);
            assert!(misfit.largest < 4.5e-2);
            assert_eq!(fit.report().branches, 2);
            assert!(has(&fit, |r| matches!(
                r,
                FitRemark::Table(TableWarning::Noise { .. })
            )));
            let peaks = fit.material(0.38).unwrap();
            let peaks = peaks.loss_peaks(ModulusKind::Longitudinal).unwrap();
            assert_eq!(peaks.loss_modulus.len(), 2);
            for (found, exact) in peaks.loss_modulus.iter().zip(&exact.loss_modulus) {
                worst = worst.max(relative(found.value, exact.value));
                println!(
                    "seed {seed}: {} {}",
                    relative(found.value, exact.value),
                    found.angular_frequency_rad_per_s / exact.angular_frequency_rad_per_s
                );
            }
        }
        assert!(worst < 0.10, "{worst}");
    }

    #[test]
    fn units_and_scales_do_not_matter() {
        let material = pmma();
        let base = noisy(MaterialFunction::Creep, log_spaced(0.1, 1e3, 10), 2, |t| {
            material.creep().compliance(t)
        });
        let times = log_spaced(0.1, 1e3, 10).iter().map(|t| 1e-12 * t).collect();
        let scaled = noisy(MaterialFunction::Creep, times, 2, |t| {
            1e20 * material.creep().compliance(1e12 * t)
        });
        let (base, scaled) = (creep(&base), creep(&scaled));
        assert_eq!(base.branches().len(), scaled.branches().len());
        for (a, b) in base.branches().iter().zip(scaled.branches()) {
            // Rounding of the data moves the optimum, and the iteration ends when the sum of squares stands still.
            assert!(relative(1e-12 * a.time_s, b.time_s) < 1e-4);
            assert!(relative(1e20 * a.compliance_per_pa, b.compliance_per_pa) < 1e-4);
        }
    }

    #[test]
    fn equal_time_steps_are_averaged_so_that_early_decades_count() {
        let material = pmma();
        let times: Vec<f64> = (1..=2000).map(f64::from).collect();
        let fit = noisy(MaterialFunction::Creep, times, 3, |t| {
            material.creep().compliance(t)
        });
        let report = fit.report();
        assert_eq!(report.samples, 2000);
        assert!(report.groups < 140, "{}", report.groups);
        // 2000 samples: known to 1.6 %.
        assert!((0.95e-2..1.05e-2).contains(&report.misfit.rms));
        for time_s in [1.0, 10.0, 100.0, 1000.0] {
            // One sample at 1 s carries its noise of 1 %; the others average.
            assert!(
                relative(
                    fit.series().value(time_s),
                    material.creep().compliance(time_s)
                ) < 1e-2
            );
        }
        assert!(report.to_string().contains("averaged to"));
    }

    #[test]
    fn a_gap_is_pointed_out_and_the_fit_is_good_where_there_are_data() {
        let material = pmma();
        let mut times = log_spaced(0.1, 1.0, 10);
        times.extend(log_spaced(50.0, 2e3, 10));
        let fit = noisy(MaterialFunction::Creep, times.clone(), 4, |t| {
            material.creep().compliance(t)
        });
        assert!(has(&fit, |r| matches!(
            r,
            FitRemark::Table(TableWarning::Gap { .. })
        )));
        for t in times {
            // Noise of 1 % over some ten samples for every parameter.
            assert!(relative(fit.series().value(t), material.creep().compliance(t)) < 1.5e-2);
        }
    }

    #[test]
    fn short_data_do_not_pretend_to_know_the_equilibrium() {
        let material = pmma();
        let fit = fitted(MaterialFunction::Creep, log_spaced(5.0, 40.0, 20), |t| {
            material.creep().compliance(t)
        });
        assert!(has(&fit, |r| matches!(
            r,
            FitRemark::Table(TableWarning::Short { .. })
        )));
        assert!(has(&fit, |r| matches!(r, FitRemark::Equilibrium { .. })));
        assert!(fit.report().misfit.largest < 1e-3);
        let relaxation = material.relaxation().unwrap();
        let fit = fitted(
            MaterialFunction::Relaxation,
            log_spaced(0.1, 100.0, 10),
            |t| relaxation.modulus(t),
        );
        let Some(FitRemark::Equilibrium { share, .. }) = fit.report().remarks.last() else {
            panic!("{}", fit.report())
        };
        // exp(-100/117.96) of the slow branch is still to come.
        let exact = 1.0 - relaxation.equilibrium_modulus() / relaxation.modulus(100.0);
        assert!((share - exact).abs() < 1e-9);
    }

    #[test]
    fn an_instantaneous_value_outside_the_data_is_never_assumed_silently() {
        let material = pmma();
        let compliance = |t| material.creep().compliance(t);
        let assumed = |fit: &Fit| {
            fit.report().remarks.iter().find_map(|r| match r {
                FitRemark::Instantaneous { share, .. } => Some((*share, r.is_warning())),
                _ => None,
            })
        };
        let early = fitted(
            MaterialFunction::Creep,
            log_spaced(0.1, 1e3, 10),
            compliance,
        );
        let (share, warning) = assumed(&early).unwrap();
        // 0.1 s of 9.9 s in the fast branch, and little in the slow one: 0.124 %.
        assert!(!warning && (share - 1.24e-3).abs() < 2e-5, "{share}");
        let late = fitted(
            MaterialFunction::Creep,
            log_spaced(30.0, 1e4, 10),
            compliance,
        );
        let (share, warning) = assumed(&late).unwrap();
        assert!(warning && share > 0.02, "{share}");
        assert!(late.report().to_string().contains("the data begin at 30 s"));
        // Nothing faster than the data: what was over before 30 s counts as instantaneous.
        assert!(
            creep(&late)
                .branches()
                .iter()
                .all(|b| b.time_s >= 30.0 * (1.0 - 1e-12))
        );
        let mut times = log_spaced(0.1, 1e3, 10);
        times.insert(0, 0.0);
        assert_eq!(
            assumed(&fitted(MaterialFunction::Creep, times, compliance)),
            None
        );
    }

    #[test]
    fn flow_is_kept_where_the_data_ask_for_it_and_only_there() {
        let fluid = |t: f64| 1e-9 * (1.0 + t / 30.0 + 0.5 * (1.0 - (-t / 2.0_f64).exp()));
        let clean = fitted(MaterialFunction::Creep, log_spaced(0.1, 1e3, 10), fluid);
        assert!(relative(creep(&clean).viscosity_pa_s().unwrap(), 30e9) < 1e-9);
        assert!(
            clean
                .report()
                .to_string()
                .contains("the material is a fluid")
        );
        let noisy_fluid = noisy(MaterialFunction::Creep, log_spaced(0.1, 1e3, 10), 1, fluid);
        // Eleven samples in the last decade, of 1 % each.
        assert!(relative(creep(&noisy_fluid).viscosity_pa_s().unwrap(), 30e9) < 2e-2);
        let material = pmma();
        for seed in 1..=5 {
            let solid = noisy(
                MaterialFunction::Creep,
                log_spaced(0.1, 200.0, 10),
                seed,
                |t| material.creep().compliance(t),
            );
            assert_eq!(creep(&solid).viscosity_pa_s(), None, "{}", solid.report());
        }
    }

    #[test]
    fn a_relaxation_modulus_that_falls_to_nothing_is_a_fluid() {
        let fit = fitted(
            MaterialFunction::Relaxation,
            log_spaced(0.1, 300.0, 10),
            |t| 1e6 * (-t / 30.0).exp() + 1e5 * (-t / 2.0).exp(),
        );
        assert!(relaxation(&fit).is_fluid());
        assert_eq!(fit.report().branches, 2);
        assert!(has(&fit, |r| *r == FitRemark::NoEquilibrium));
    }

    #[test]
    fn a_compliance_that_begins_with_nothing_cannot_go_into_contact_and_says_so() {
        let fit = fitted(MaterialFunction::Creep, log_spaced(0.01, 100.0, 10), |t| {
            1e-9 * -(-t).exp_m1()
        });
        assert!(
            has(&fit, |r| matches!(
                r,
                FitRemark::InstantaneouslyRigid { .. }
            )),
            "{}",
            fit.report()
        );
        assert!(fit.material(0.3).unwrap().contact_compliance().is_err());
    }

    #[test]
    fn a_table_can_be_asked_for_a_fluid_or_a_solid() {
        let flowing = |t: f64| 1e-9 * (1.0 + t / 30.0 + 0.5 * (1.0 - (-t / 2.0_f64).exp()));
        let times = log_spaced(0.1, 100.0, 10);
        let table = |value: &dyn Fn(f64) -> f64, function| {
            let values = times.iter().map(|&t| value(t)).collect();
            Tabulated::new(function, ModulusKind::Shear, times.clone(), values).unwrap()
        };
        let fluid = table(&flowing, MaterialFunction::Creep);
        let is_fluid = |table: &Tabulated, flow| {
            let material = fit(table, flow).unwrap().material(0.3).unwrap();
            material.creep().is_fluid()
        };
        assert!(is_fluid(&fluid, None) && is_fluid(&fluid, Some(true)));
        assert!(!is_fluid(&fluid, Some(false)));
        let relaxing = table(
            &|t| 1e6 * (-t / 5.0).exp() + 1e2,
            MaterialFunction::Relaxation,
        );
        assert!(is_fluid(&relaxing, Some(true)) && !is_fluid(&relaxing, Some(false)));
        let resting = table(
            &|t| 1e-9 * (2.0 - (-t / 2.0_f64).exp()),
            MaterialFunction::Creep,
        );
        assert!(!is_fluid(&resting, None));
        assert_eq!(
            fit(&table(&|_| 1e-9, MaterialFunction::Creep), Some(true)),
            Err(FitError::NoFlow)
        );
    }

    #[test]
    fn a_broad_spectrum_takes_few_branches_per_decade() {
        // Stretched exponential, W. Williams and D. C. Watts, Transactions of the Faraday Society 66 (1970) 80.
        let fit = fitted(
            MaterialFunction::Relaxation,
            log_spaced(1e-4, 1e4, 10),
            |t| 1e6 + 1e9 * (-(t / 10.0_f64).powf(0.4)).exp(),
        );
        // What counts as not noticeable, and twice that at the ends of the data.
        assert!(fit.report().misfit.rms < 2e-4, "{}", fit.report());
        assert!(fit.report().branches <= 16, "{}", fit.report());
        assert!(fit.report().branches >= 6);
    }

    #[test]
    fn an_elastic_solid_has_no_branch() {
        let fit = fitted(MaterialFunction::Creep, log_spaced(0.1, 1e3, 10), |_| 2e-9);
        assert_eq!(fit.report().branches, 0);
        assert!(relative(creep(&fit).instantaneous_compliance(), 2e-9) < 1e-14);
        let fit = noisy(MaterialFunction::Creep, log_spaced(0.1, 1e3, 10), 8, |_| {
            2e-9
        });
        assert_eq!(fit.report().branches, 0);
    }

    #[test]
    fn the_fewest_samples_give_at_most_one_branch() {
        let material = pmma();
        let fit = fitted(MaterialFunction::Creep, vec![0.0, 1.0, 10.0, 100.0], |t| {
            material.creep().compliance(t)
        });
        assert_eq!(fit.report().branches, 1);
        assert!(fit.report().misfit.largest < 1e-2);
    }

    #[test]
    fn the_material_carries_the_report() {
        let material = pmma();
        let fit = fitted(MaterialFunction::Creep, log_spaced(0.1, 1e3, 10), |t| {
            material.creep().compliance(t)
        });
        let built = fit.material(0.38).unwrap();
        assert_eq!(built.origin.fit.as_ref(), Some(fit.report()));
        assert_eq!(built.creep(), creep(&fit));
        assert!(fit.material(0.6).is_err());
        let text = fit.report().to_string();
        assert!(text.starts_with("Fit of 2 branches to the longitudinal creep compliance, 41 samples from 0.1 s to 1000 s"));
    }

    #[test]
    fn shares_are_written_as_people_read_them() {
        for (value, text) in [
            (0.0123, "1.2 %"),
            (0.25, "25 %"),
            (4.2e-4, "0.042 %"),
            (3e-15, "3e-15"),
            (0.0, "0 %"),
        ] {
            assert_eq!(report::percent(value), text);
        }
    }
}
