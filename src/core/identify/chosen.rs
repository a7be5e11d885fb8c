//! Laws beside series: fitted on the linearised contact with the factors of the exact model, which are taken about the law that is chosen
//! until they stand still.

use nalgebra::DVector;

use super::identified::{Compared, Identified};
use super::laws::{FittedLaw, Laws, Numbers, OfLaw, fitted};
use super::model::Model;
use super::noise::Knowledge;
use super::selection::Linearised;
use super::series::Point;
use super::{IdentifyError, IdentifyPlan};
use crate::material::Relaxation;
use crate::material::law::{Form, Law, Solid};
use crate::numerics::levenberg_marquardt::Problem as _;

/// How often the factors are taken, and the change that is none.
const ROUNDS: usize = 12;
const SETTLED: f64 = 1e-3;

/// A law with unknowns to begin with.
type Start = (Form, Vec<Vec<f64>>);

/// What a choice between laws leads to.
enum Choice {
    /// The series that was found before.
    Series(Laws),
    /// Another law, with its series, the numbers computed with it and the factors of their bands.
    Law(Laws, Relaxation, Vec<f64>, Vec<f64>),
    /// A law whose contact cannot be computed, or changes with every refinement of it.
    Lost(Form),
}

/// What was found with the laws that were asked for beside its series; where another law is more likely than the series, that law in its
/// place.
pub(super) fn with_laws(
    model: &Model<'_>,
    linearised: &mut Linearised<'_>,
    mut found: Identified,
) -> Result<Identified, IdentifyError> {
    let plan = linearised.plan;
    let numbers = Numbers {
        count: plan.measurements.data().len(),
        is_noise_known: found.knowledge != Knowledge::None,
        times_s: linearised.times_s().0,
    };
    let mut starts = starts(plan, &found, &numbers);
    let computed = found.computed();
    while !starts.is_empty() {
        linearised.take_factors(&found.point, &computed, 1.0);
        match chosen(model, linearised, &found, &numbers, &starts)? {
            Choice::Series(laws) => {
                found.laws = Some(laws);
                return Ok(found);
            }
            Choice::Law(laws, series, exact, factors) => {
                return Ok(found.by_law(laws, series, &exact, &factors));
            }
            Choice::Lost(form) => starts.retain(|(own, _)| *own != form),
        }
    }
    Err(IdentifyError::NoFit(
        "no law that was asked for has a contact that can be computed; leave `law` out for a series",
    ))
}

/// The law that is most likely, with factors about it that stand still.
fn chosen(
    model: &Model<'_>,
    linearised: &mut Linearised<'_>,
    found: &Identified,
    numbers: &Numbers,
    starts: &[Start],
) -> Result<Choice, IdentifyError> {
    let (_, end_s) = linearised.times_s();
    let mut last = None;
    for _ in 0..ROUNDS {
        let residuals = |solid: &Solid| linearised.of_solid(solid, None);
        let laws = fitted(starts, numbers, &residuals);
        let laws = laws.ok_or(IdentifyError::NoFit("no law could be tried"))?;
        let form = laws.best().form;
        if is_series(form) && form.branches == found.relaxation.branches().len() {
            return Ok(Choice::Series(laws));
        }
        let problem = OfLaw {
            form,
            times_s: numbers.times_s,
            residuals: &residuals,
        };
        let derivatives = problem.derivatives(&laws.best().unknowns);
        let Some((derivatives, series)) = derivatives.zip(laws.series()) else {
            return Ok(Choice::Lost(form));
        };
        let point = Point::of(&series, end_s);
        let series = point.relaxation()?;
        let exact = match model.numbers_where_found(&series) {
            Err(IdentifyError::NoCycle { .. } | IdentifyError::NoHistory(_)) => {
                return Ok(Choice::Lost(form));
            }
            exact => exact?,
        };
        let change = linearised.take_factors(&point, &exact, 1.0);
        if change < SETTLED && last == Some(form) {
            let factor = |row: DVector<f64>| laws.best().factor(&row, laws.half_width);
            let rows = derivatives.row_iter().zip(&linearised.noise.relative);
            let factors = rows
                .map(|(row, error)| factor(row.transpose() * *error))
                .collect();
            let exact: Option<Vec<f64>> = exact.into_iter().collect();
            return Ok(match exact {
                Some(exact) => Choice::Law(laws, series, exact, factors),
                None => Choice::Lost(form),
            });
        }
        last = Some(form);
    }
    Ok(last.map_or(Choice::Lost(starts[0].0), Choice::Lost))
}

/// Whether a form is one of those that the search for series has found.
fn is_series(form: Form) -> bool {
    matches!(form.law, Law::Series | Law::StandardSolid)
}

/// The laws that were asked for: of series the one that the data ask for, others from where a fit begins.
fn starts(plan: &IdentifyPlan, found: &Identified, numbers: &Numbers) -> Vec<Start> {
    let branches = found.relaxation.branches().len();
    let forms = plan.laws.iter().flatten().copied();
    let forms = forms.filter(|form| form.law != Law::Series || form.branches == branches);
    let modulus_pa =
        (found.point).complex_modulus((1.0 / numbers.times_s.0 / numbers.times_s.1).sqrt());
    let start = |form: Form| {
        let starts = match is_series(form) {
            false => form.starts(modulus_pa.norm(), numbers.times_s),
            true => {
                let mut candidates = found.candidates.iter();
                let own = candidates.find(|c| c.branches == form.branches && !c.has_close_times)?;
                vec![own.point.0.clone()]
            }
        };
        Some((form, starts))
    };
    forms.filter_map(start).collect()
}

impl Identified {
    /// The same by a law in place of the series: with its series, the numbers computed with it and the factors of their bands.
    fn by_law(mut self, laws: Laws, series: Relaxation, exact: &[f64], factors: &[f64]) -> Self {
        let all = self.compared.iter().zip(exact).zip(factors);
        let compared = all.map(|((compared, computed), factor)| Compared {
            computed: *computed,
            factor: *factor,
            ..*compared
        });
        self.compared = compared.collect();
        self.relaxation = series;
        self.degrees_of_freedom = laws.degrees_of_freedom;
        self.reduced_chi_squared = laws.reduced_chi_squared;
        self.inflation = laws.inflation;
        self.unknowns.clear();
        self.correlations.clear();
        self.undetermined.clear();
        self.singular_values.clear();
        self.is_by_law = true;
        self.laws = Some(laws);
        self
    }

    /// The law in place of the series that the data ask for; `None` where the material is that.
    pub fn law(&self) -> Option<&FittedLaw> {
        let laws = self.laws.as_ref().filter(|_| self.is_by_law)?;
        Some(laws.best())
    }
}
