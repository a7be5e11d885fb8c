//! From measurements to a material: the search on the linearised contact, the refinement on the exact one, and what is
//! known of the result.

use std::sync::atomic::AtomicBool;

use nalgebra::{DMatrix, DVector};

use crate::identify::candidate::{Candidate, candidates, choose, leave_out_outlier};
use crate::identify::data::Number;
use crate::identify::least_squares::{Ending, Problem, Solution, minimise};
use crate::identify::model::Model;
use crate::identify::noise::Knowledge;
use crate::identify::selection::{Linearised, residuals};
use crate::identify::series::{Point, name};
use crate::identify::uncertainty::{Directions, moduli};
use crate::identify::{IdentifyError, IdentifyPlan, MOST_BRANCHES, UNDETERMINED};
use crate::material::Relaxation;
use crate::sweep::plan::EngineKind;

/// Step of an unknown for derivatives of the exact model: wide beside what springs and steps leave of roughness in it.
const STEP: f64 = 0.02;

/// Which part of a change of the factors is made, at first and where that did not lead to a solid.
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];

/// Which part of the noise of a number the error of the resolution may be.
const SEEN: f64 = 0.1;

/// How often the factors between the exact and the linearised model are taken, and the change that is none.
const ROUNDS: usize = 8;
const SETTLED: f64 = 1e-3;

const EXACTLY: Ending = Ending {
    iterations: 12,
    enough: 1e-4,
};

/// Misfit (root mean square of relative differences) from which data contradict one another, and how many times their errors it
/// must be.
const CONTRADICTION: f64 = 0.15;
const TIMES_ERRORS: f64 = 5.0;

/// The largest exponent of a confidence factor that is written as a number.
const WIDEST: f64 = 60.0;

/// An unknown with its 95 % interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// `g_inf`, `g_1`, `tau_1` and so on.
    pub name: String,
    /// Pa or s.
    pub value: f64,
    /// The interval goes from `value / factor` to `value * factor`.
    pub factor: f64,
    /// Whether the factor is below [`UNDETERMINED`].
    pub is_determined: bool,
}

/// A combination of the unknowns that the data leave open: the product of the powers of its parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Undetermined {
    /// By what factor it may be off, at 95 %.
    pub factor: f64,
    /// Unknowns and their powers, the largest first.
    pub parts: Vec<(String, f64)>,
}

/// Storage and loss modulus (Pa) at one frequency, with their 95 % bands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModulusBand {
    pub storage_pa: f64,
    pub loss_pa: f64,
    /// The bands go from the modulus over this factor to the modulus times it.
    pub storage_factor: f64,
    pub loss_factor: f64,
}

/// A number as measured and as computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compared {
    /// Angular frequency (rad/s) of the cycle, or time (s) of the instant of a history.
    pub place: f64,
    /// Its row in the table, from 1 below the header.
    pub row: usize,
    pub number: Number,
    pub measured: f64,
    /// Standard deviation: as given, or estimated.
    pub error: f64,
    pub computed: f64,
    /// Factor of the 95 % band of the computed number.
    pub factor: f64,
}

/// What was found.
#[derive(Debug, Clone)]
pub struct Identified {
    pub relaxation: Relaxation,
    pub unknowns: Vec<Unknown>,
    /// Between the unknowns, row by row.
    pub correlations: Vec<Vec<f64>>,
    pub singular_values: Vec<f64>,
    pub undetermined: Vec<Undetermined>,
    /// Every number of branches tried, fewest first.
    pub candidates: Vec<Candidate>,
    pub compared: Vec<Compared>,
    /// Which of these is an outlier: all others are met without it, and it does not count in the fit.
    pub left_out: Option<usize>,
    /// What was known of the errors of the data.
    pub knowledge: Knowledge,
    pub degrees_of_freedom: usize,
    /// Sum of squares over degrees of freedom, with errors as given; where none is given, one by definition.
    pub reduced_chi_squared: f64,
    /// By what factor all intervals are wider than the errors of the data say: 1, or where the series misses the data by more than
    /// chance the root of the reduced chi squared.
    pub inflation: f64,
    /// Lowest and highest angular frequency of the data.
    pub window_rad_per_s: (f64, f64),
    point: Point,
    directions: Directions,
    half_width: f64,
    /// The series on the linearised contact, with which the candidates are compared.
    linearised: Point,
}

/// Finds the material.
///
/// # Errors
/// [`IdentifyError`]: too few numbers, cycles that are not found, numbers that no solid has together.
pub fn identify(plan: &IdentifyPlan, interrupt: &AtomicBool) -> Result<Identified, IdentifyError> {
    let most = most_branches(plan)?;
    let mut model = Model::new(plan, interrupt);
    let mut linearised = Linearised::new(plan)?;
    let mut first = None;
    // Far from the solution the factors may overshoot: what was not found is sought again with smaller changes of them. On cells, whose
    // cycles take a second each, that would be many minutes.
    let attempts = match plan.contact.solver.engine {
        EngineKind::Axisymmetric => PARTS.len(),
        _ => 1,
    };
    for (attempt, part) in PARTS.into_iter().take(attempts).enumerate() {
        if attempt > 0 {
            linearised.start_over(&model)?;
        }
        let mut found = tried(&model, &mut linearised, (most, part));
        if let (true, Ok(near)) = (attempt > 0, &found) {
            // What was found by another way round may be near the solution only: once more with the factors there.
            let misfit = near.misfit();
            let again = (model.numbers_where_found(&near.relaxation)).and_then(|exact| {
                linearised.take_factors(&near.point, &exact, 1.0);
                tried(&model, &mut linearised, (most, part))
            });
            if again.as_ref().is_ok_and(|again| again.misfit() <= misfit) {
                found = again;
            }
        }
        match found {
            Err(
                error @ (IdentifyError::Contradiction { .. }
                | IdentifyError::NoFit(_)
                | IdentifyError::NoCycle { .. }
                | IdentifyError::NoHistory(_)),
            ) => first = first.or(Some(error)),
            Err(error) => return Err(error),
            Ok(found) => return at_full_resolution(&mut model, &linearised, found),
        }
    }
    Err(first.unwrap_or(IdentifyError::NoFit("nothing was tried")))
}

/// A search on the linearised contact, and what comes of it on the exact model.
fn tried(
    model: &Model<'_>,
    linearised: &mut Linearised<'_>,
    (most, part): (usize, f64),
) -> Result<Identified, IdentifyError> {
    let (candidates, chosen) = on_linearised(model, linearised, (most, part))?;
    let start = candidates[chosen].point.clone();
    let from = start.clone();
    let found = on_exact(model, linearised, (candidates, start), &from)?;
    refuse_contradiction(linearised.plan, &found)?;
    Ok(found)
}

/// The same without the error of the model's own resolution, where that is seen beside the noise.
fn at_full_resolution(
    model: &mut Model<'_>,
    linearised: &Linearised<'_>,
    found: Identified,
) -> Result<Identified, IdentifyError> {
    let noise = linearised.noise.relative.iter().copied();
    let noise = noise.fold(f64::INFINITY, f64::min);
    match model.learn_corrections(&found.relaxation) {
        Ok(size) if size > SEEN * noise => {}
        Err(IdentifyError::Interrupted) => return Err(IdentifyError::Interrupted),
        _ => return Ok(found),
    }
    let of_candidates = (found.candidates.clone(), found.linearised.clone());
    match on_exact(model, linearised, of_candidates, &found.point) {
        Err(IdentifyError::Interrupted) => Err(IdentifyError::Interrupted),
        // What was found holds without the correction too.
        Err(_) => Ok(found),
        corrected => corrected,
    }
}

/// Refines a candidate, which was found on the linearised contact at `start`, on the exact model.
fn on_exact(
    model: &Model<'_>,
    linearised: &Linearised<'_>,
    (candidates, start): (Vec<Candidate>, Point),
    from: &Point,
) -> Result<Identified, IdentifyError> {
    let exact = Exact { model, linearised };
    let found = minimise(&exact, from, EXACTLY);
    let found = found.ok_or(IdentifyError::NoFit("the exact model failed at the start"))?;
    let derivatives = exact.derivatives(&found.unknowns);
    let derivatives = derivatives.ok_or(IdentifyError::NoFit(
        "the exact model has no derivatives there",
    ))?;
    judged(linearised, (candidates, start), found, &derivatives)
}

/// How many branches the number of data allows.
fn most_branches(plan: &IdentifyPlan) -> Result<usize, IdentifyError> {
    let numbers = plan.measurements.data().len();
    // As many unknowns, and one number over.
    let needed = |branches: usize| 2 * branches + 2;
    let asked = plan.branches.unwrap_or(1);
    if numbers < needed(asked) {
        return Err(IdentifyError::TooFew {
            numbers,
            branches: asked,
            needed: needed(asked),
        });
    }
    let allowed = (1..=MOST_BRANCHES)
        .rev()
        .find(|most| needed(*most) <= numbers);
    Ok(plan.branches.or(allowed).unwrap_or(1))
}

/// Searches with factors from the exact model until they stand still; which candidate the data ask for.
fn on_linearised(
    model: &Model<'_>,
    linearised: &mut Linearised<'_>,
    (most, part): (usize, f64),
) -> Result<(Vec<Candidate>, usize), IdentifyError> {
    let plan = linearised.plan;
    let mut known: Vec<Point> = Vec::new();
    let mut last = None;
    for round in 0..ROUNDS {
        known = linearised.search(&known, most);
        let candidates = candidates(linearised, &known);
        let chosen = match plan.branches {
            Some(asked) => asked.min(candidates.len()).saturating_sub(1),
            None => choose(&candidates),
        };
        let point = known.get(chosen);
        let point = point.ok_or(IdentifyError::NoFit("no start could be tried"))?;
        let exact = model.numbers_where_found(&point.relaxation()?);
        let exact = exact.map_err(|error| explained(linearised, point, error))?;
        let change = linearised.take_factors(point, &exact, part);
        let is_settled = change < SETTLED && last == Some(chosen);
        // Of a series that is pulled by an outlier nothing is left as it is: once more without that.
        let is_last = round + 1 == ROUNDS
            || is_settled && !leave_out_outlier(linearised, &candidates, chosen);
        if is_last {
            return Ok((candidates, chosen));
        }
        last = Some(chosen);
        // With the factors of the exact model, what is left is noise; of a series with branches to spare, less than that.
        let relative = linearised.relative(point);
        let noise = &mut linearised.noise;
        noise.estimate(&plan.measurements, &relative, point.0.len());
    }
    Err(IdentifyError::NoFit("no round was tried"))
}

/// The exact model as a least squares problem.
struct Exact<'a> {
    model: &'a Model<'a>,
    linearised: &'a Linearised<'a>,
}

impl Exact<'_> {
    fn scaled(&self, numbers: &[f64], point: &Point) -> Option<DVector<f64>> {
        let data = self.linearised.plan.measurements.data().iter();
        let all = data.zip(numbers).zip(&self.linearised.noise.relative);
        let scaled = all.map(|((datum, number), error)| {
            let number = number.max(1e-6 * datum.value);
            (number / datum.value).ln() / error
        });
        residuals(scaled, point)
    }
}

impl Problem for Exact<'_> {
    fn residuals(&self, point: &Point) -> Option<DVector<f64>> {
        let series = point.relaxation().ok()?;
        self.scaled(&self.model.numbers(&series).ok()?, point)
    }

    fn derivatives(&self, point: &Point) -> Option<DMatrix<f64>> {
        let moved = (0..point.0.len()).flat_map(|k| [STEP, -STEP].map(|step| point.moved(k, step)));
        let moved: Vec<Point> = moved.collect();
        let series: Option<Vec<Relaxation>> = moved.iter().map(|p| p.relaxation().ok()).collect();
        let numbers = self.model.numbers_of_each(&series?).ok()?;
        let scaled = numbers.iter().zip(&moved);
        let scaled = scaled.map(|(numbers, point)| self.scaled(numbers, point));
        let columns: Vec<DVector<f64>> = (scaled.collect::<Option<Vec<_>>>()?)
            .chunks_exact(2)
            .map(|pair| (&pair[0] - &pair[1]) / (2.0 * STEP))
            .collect();
        Some(DMatrix::from_columns(&columns))
    }

    fn clamp(&self, place: usize, value: f64) -> f64 {
        self.linearised.limits.clamp(place, value)
    }
}

/// The result with all that is known of it.
fn judged(
    linearised: &Linearised<'_>,
    (candidates, start): (Vec<Candidate>, Point),
    found: Solution,
    derivatives: &DMatrix<f64>,
) -> Result<Identified, IdentifyError> {
    let measured = &linearised.plan.measurements;
    let point = found.unknowns.clone();
    let degrees_of_freedom = measured.data().len().saturating_sub(point.0.len());
    let noise = &linearised.noise;
    let scatter = noise.scatter(&found.residuals, degrees_of_freedom);
    let half_width = scatter.half_width;
    let directions = Directions::new(derivatives, scatter.deviation);
    let directions = directions.ok_or(IdentifyError::NoFit("its derivatives are not finite"))?;
    let covariance = directions.covariance();
    let deviation = |k: usize| covariance[(k, k)].sqrt();
    let factor = |deviation: f64| (half_width * deviation).min(WIDEST).exp();
    let unknowns = point.0.iter().enumerate().map(|(k, ln)| Unknown {
        name: name(k),
        value: ln.exp(),
        factor: factor(deviation(k)),
        is_determined: factor(deviation(k)) < UNDETERMINED,
    });
    let count = point.0.len();
    let correlation = |i: usize, j: usize| covariance[(i, j)] / (deviation(i) * deviation(j));
    let compared = measured.data().iter().enumerate().map(|(k, datum)| {
        let error = linearised.noise.relative[k];
        // A row of derivatives is in standard deviations of its datum.
        let gradient = derivatives.row(k).transpose() * error;
        Compared {
            place: measured.place_of(datum),
            row: measured.row_of(datum),
            number: datum.number,
            measured: datum.value,
            error: noise.own(k) * scatter.of_data * datum.value,
            computed: datum.value * (found.residuals[k] * error).exp(),
            factor: factor(directions.variance(&gradient).sqrt()),
        }
    });
    Ok(Identified {
        left_out: noise.left_out(),
        relaxation: point.relaxation()?,
        unknowns: unknowns.collect(),
        correlations: (0..count)
            .map(|i| (0..count).map(|j| correlation(i, j)).collect())
            .collect(),
        singular_values: directions.singular_values.clone(),
        undetermined: undetermined(&directions, half_width),
        candidates,
        compared: compared.collect(),
        knowledge: noise.knowledge,
        degrees_of_freedom,
        reduced_chi_squared: scatter.reduced_chi_squared,
        inflation: scatter.deviation / scatter.of_data,
        window_rad_per_s: measured.window_rad_per_s(),
        point,
        directions,
        half_width,
        linearised: start,
    })
}

/// Directions along which the unknowns may move by more than the factor that counts as determined.
fn undetermined(directions: &Directions, half_width: f64) -> Vec<Undetermined> {
    let all = directions.deviations.iter().enumerate();
    let open = all.filter(|(_, deviation)| half_width * **deviation > UNDETERMINED.ln());
    open.map(|(place, deviation)| {
        let row = directions.vectors.row(place);
        let larger = |a: f64, v: &f64| if v.abs() > a.abs() { *v } else { a };
        let largest = row.iter().fold(0.0, larger);
        // The largest power is one; what hardly takes part is left out.
        let powers = row.iter().enumerate().map(|(k, v)| (name(k), v / largest));
        let mut parts: Vec<(String, f64)> = powers.filter(|(_, power)| power.abs() > 0.2).collect();
        parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        Undetermined {
            factor: (half_width * deviation).min(WIDEST).exp(),
            parts,
        }
    })
    .collect()
}

/// Refuses what no solid explains.
fn refuse_contradiction(plan: &IdentifyPlan, found: &Identified) -> Result<(), IdentifyError> {
    let within =
        found.knowledge == Knowledge::All && found.reduced_chi_squared.sqrt() < TIMES_ERRORS;
    match contradiction(plan, found.relaxation.branches().len(), &found.missed()) {
        Some(error) if !within => Err(error),
        _ => Ok(()),
    }
}

/// A cycle that is not found, where the series is one that no data should lead to, is the data's fault.
fn explained(linearised: &Linearised<'_>, point: &Point, error: IdentifyError) -> IdentifyError {
    let (IdentifyError::NoCycle { .. } | IdentifyError::NoHistory(_)) = error else {
        return error;
    };
    let missed = linearised.relative(point);
    contradiction(linearised.plan, point.branches(), &missed).unwrap_or(error)
}

/// What is wrong with data that the best series misses by so much, as logarithms of computed over measured numbers; `None` where it
/// is not much.
fn contradiction(plan: &IdentifyPlan, branches: usize, missed: &[f64]) -> Option<IdentifyError> {
    let squares: f64 = missed.iter().map(|off| off * off).sum();
    let rms = (squares / missed.len() as f64).sqrt();
    if rms < CONTRADICTION {
        return None;
    }
    let measured = &plan.measurements;
    let data = measured.data().iter().zip(missed);
    let (datum, off) = data.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    Some(IdentifyError::Contradiction {
        branches,
        may_have_more: plan.branches.is_some_and(|asked| asked < MOST_BRANCHES),
        row: measured.row_of(datum),
        misfit_percent: format!("{:.0}", 100.0 * rms),
        place: measured.place_in_words(datum),
        column: datum.number.column(),
        times: format!("{:.2e}", off.exp()),
    })
}

impl Identified {
    /// The number that the series misses by the most of its errors, and by how many.
    pub fn worst(&self) -> Option<(&Compared, f64)> {
        let each = self.compared.iter();
        let off = |c: &Compared| (c.computed / c.measured).ln() * c.measured / c.error;
        each.map(|c| (c, off(c)))
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }

    /// Logarithms of computed over measured numbers.
    fn missed(&self) -> Vec<f64> {
        let compared = self.compared.iter();
        compared.map(|c| (c.computed / c.measured).ln()).collect()
    }

    /// The root mean square of relative differences between measured and computed numbers, times what more unknowns gain by chance.
    fn misfit(&self) -> f64 {
        let squares: f64 = self.missed().iter().map(|off| off * off).sum();
        (squares / self.degrees_of_freedom.max(1) as f64).sqrt()
    }

    /// The moduli at a frequency, with bands. Beyond the data they are an extrapolation.
    pub fn band(&self, angular_frequency_rad_per_s: f64) -> ModulusBand {
        let own = moduli(&self.point, angular_frequency_rad_per_s);
        let compared = moduli(&self.linearised, angular_frequency_rad_per_s);
        let mut variances = own
            .each_ref()
            .map(|(_, gradient)| self.directions.variance(gradient));
        let chosen = self.point.branches();
        let others = self.candidates.iter();
        for other in others.filter(|c| c.branches != chosen && c.weight > 0.0) {
            let theirs = moduli(&other.point, angular_frequency_rad_per_s);
            for part in 0..2 {
                let apart = theirs[part].0 - compared[part].0;
                variances[part] += other.weight * apart * apart;
            }
        }
        let factor = |variance: f64| (self.half_width * variance.sqrt()).min(WIDEST).exp();
        ModulusBand {
            storage_pa: own[0].0.exp(),
            loss_pa: own[1].0.exp(),
            storage_factor: factor(variances[0]),
            loss_factor: factor(variances[1]),
        }
    }
}
