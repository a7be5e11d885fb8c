//! The search on the linearised contact: series of every number of branches.

use nalgebra::{DMatrix, DVector};

use crate::drive::Control;
use crate::identify::data::{Datum, Measurements};
use crate::identify::history::LinearHistory;
use crate::identify::linear::{LinearCycle, at_rest};
use crate::identify::model::Model;
use crate::identify::noise::Noise;
use crate::identify::series::{Limits, Point};
use crate::identify::{IdentifyError, IdentifyPlan};
use crate::material::law::Solid;
use crate::numerics::levenberg_marquardt::{
    Ending, Problem, Solution, central_difference, minimise,
};

/// Step of an unknown for the derivatives of the linearised contact, which is smooth.
const STEP: f64 = 1e-5;

/// By what factor times may lie beyond one over the angular frequencies of the data: a branch there shows as a slope.
const BEYOND: f64 = 100.0;

/// Equilibrium moduli (Pa) at which a search begins: from gels to ceramics, per decade.
const LOWEST_PA: f64 = 1.0;
const LEVELS: (i32, f64) = (39, 3.0);

/// How many of the best starts are refined closely.
const KEPT: usize = 4;

/// Ratios of the branch to the equilibrium modulus, and places of its time within its limits, at which a search begins.
const RATIOS: [f64; 5] = [0.1, 1.0, 10.0, 100.0, 1000.0];
const PLACES: usize = 9;

const ROUGHLY: Ending = Ending {
    iterations: 12,
    enough: 1e-3,
};
pub(super) const CLOSELY: Ending = Ending {
    iterations: 80,
    enough: 1e-7,
};

/// The linearised contact with a factor for each number.
pub(super) struct Linearised<'a> {
    pub(super) plan: &'a IdentifyPlan,
    cycles: Vec<LinearCycle<'a>>,
    history: Option<LinearHistory<'a>>,
    pub(super) ln_factors: Vec<f64>,
    pub(super) noise: Noise,
    pub(super) limits: Limits,
}

impl Linearised<'_> {
    /// # Errors
    /// [`IdentifyError`] where the data of a history lie outside its drive.
    pub(super) fn new(plan: &IdentifyPlan) -> Result<Linearised<'_>, IdentifyError> {
        let history = plan.drive.history().map(|drive| {
            let outside = "the data lie outside the drive, or there are more than can be followed";
            LinearHistory::new(plan, drive).ok_or(IdentifyError::NoFit(outside))
        });
        let measured = &plan.measurements;
        let (lowest, highest) = measured.window_rad_per_s();
        Ok(Linearised {
            plan,
            history: history.transpose()?,
            cycles: Vec::new(),
            ln_factors: vec![0.0; measured.data().len()],
            noise: Noise::new(measured),
            limits: Limits {
                moduli: (-10.0, 40.0),
                times: ((1.0 / (BEYOND * highest)).ln(), (BEYOND / lowest).ln()),
            },
        })
    }

    fn measured(&self) -> &Measurements {
        &self.plan.measurements
    }

    /// Linearises about a contact with this equilibrium modulus (Pa).
    pub(super) fn about(&mut self, equilibrium_pa: f64) {
        let plan = self.plan;
        let known = &plan.contact.material;
        let indenter = known.indenter_material.as_ref();
        let indenter = indenter.and_then(|material| material.contact_compliance().ok());
        let own = known.compressibility.contact_modulus(equilibrium_pa.into());
        let compliance_per_pa = own.re.recip() + at_rest(indenter.as_ref());
        if let Some(history) = &mut self.history {
            history.about(compliance_per_pa);
        }
        let cycles = plan.measurements.places().filter_map(|data| {
            let (omega, drive) = (data[0].place, data[0].drive?);
            let indenter = indenter.as_ref();
            Some(LinearCycle::new(
                plan,
                indenter,
                compliance_per_pa,
                omega,
                &drive,
            ))
        });
        self.cycles = cycles.collect();
    }

    /// Logarithms of all numbers without their factors.
    pub(super) fn ln_numbers(&self, point: &Point) -> Vec<f64> {
        let ln = |number: f64| number.max(f64::MIN_POSITIVE).ln();
        let data = self.measured().data();
        if let Some(history) = &self.history {
            let numbers = history.numbers(point);
            let numbers = numbers.unwrap_or_else(|| vec![f64::NAN; data.len()]);
            return numbers.into_iter().map(ln).collect();
        }
        let equilibrium_pa = point.equilibrium_pa();
        let cycles = self.cycles.iter().zip(self.measured().places());
        let numbers = cycles.flat_map(|(cycle, data)| {
            let modulus = point.complex_modulus(cycle.angular_frequency_rad_per_s);
            let number = move |datum: &Datum| cycle.number(datum.number, equilibrium_pa, modulus);
            data.iter().map(number)
        });
        numbers.map(ln).collect()
    }

    /// Logarithms of computed over measured numbers.
    pub(super) fn relative(&self, point: &Point) -> Vec<f64> {
        let numbers = self.ln_numbers(point).into_iter().zip(&self.ln_factors);
        let all = self.measured().data().iter().zip(numbers);
        all.map(|(datum, (ln, factor))| ln + factor - datum.value.ln())
            .collect()
    }

    /// The times (s) that the data tell of, and behind them the time after which nothing matters: a history ends before what relaxes later, a
    /// cycle settles when all has relaxed.
    pub(super) fn times_s(&self) -> ((f64, f64), Option<f64>) {
        let (lowest, highest) = self.measured().window_rad_per_s();
        let times_s = (1.0 / highest, 1.0 / lowest);
        (times_s, self.measured().is_history().then_some(times_s.1))
    }

    /// Logarithms of computed over measured numbers of a solid, less a shift where there is one, each in its standard deviation.
    pub(super) fn of_solid(&self, solid: &Solid, shift: Option<&[f64]>) -> Option<DVector<f64>> {
        let (times_s, end_s) = self.times_s();
        let point = Point::of(&solid.clone().series_within(times_s)?, end_s);
        let mut off = DVector::from_vec(self.relative(&point));
        if let Some(shift) = shift {
            off -= DVector::from_column_slice(shift);
        }
        Some(off.component_div(&DVector::from_column_slice(&self.noise.relative)))
    }

    /// Residuals from logarithms of computed over measured numbers, each in its standard deviation, and those that keep the times of a
    /// series apart; `None` where one is not finite.
    pub(super) fn weighed(
        &self,
        relative: impl Iterator<Item = f64>,
        point: &Point,
    ) -> Option<DVector<f64>> {
        let of_data = relative
            .zip(&self.noise.relative)
            .map(|(r, error)| r / error);
        let residuals = DVector::from_vec(of_data.chain(point.kept_apart()).collect());
        residuals.iter().all(|r| r.is_finite()).then_some(residuals)
    }

    /// Takes the factors from the exact numbers of a series, as far as they were found; `part` of the way to them. The largest change.
    pub(super) fn take_factors(&mut self, point: &Point, exact: &[Option<f64>], part: f64) -> f64 {
        self.about(point.equilibrium_pa());
        let linear = self.ln_numbers(point);
        let mut largest = 0.0_f64;
        for ((factor, linear), exact) in self.ln_factors.iter_mut().zip(linear).zip(exact) {
            let Some(exact) = exact else { continue };
            let change = exact.max(f64::MIN_POSITIVE).ln() - linear - *factor;
            largest = largest.max(change.abs());
            *factor += part * change;
        }
        largest
    }

    /// Where a search begins when nothing is known: the best of a grid of series of one branch.
    fn first(&mut self) -> Vec<Point> {
        let mut all: Vec<(f64, Point)> = self.grid().into_iter().flatten().collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let best = all.into_iter().take(2 * KEPT);
        best.map(|(_, point)| point).collect()
    }

    /// A grid of series of one branch, and how well they fit: for every ratio and time of the branch those of all equilibrium moduli.
    fn grid(&mut self) -> Vec<Vec<(f64, Point)>> {
        let (low, high) = self.limits.times;
        let (count, per_decade) = LEVELS;
        let mut all = vec![Vec::new(); RATIOS.len() * PLACES];
        for level in 0..=count {
            let equilibrium_pa = LOWEST_PA * 10_f64.powf(f64::from(level) / per_decade);
            self.about(equilibrium_pa);
            for (k, own) in all.iter_mut().enumerate() {
                let (ratio, place) = (RATIOS[k / PLACES], (k % PLACES + 1) as f64);
                let time = low + (high - low) * place / (PLACES + 1) as f64;
                let moduli = [equilibrium_pa, ratio * equilibrium_pa].map(f64::ln);
                let point = Point(vec![moduli[0], moduli[1], time]);
                if let Some(residuals) = self.residuals(&point) {
                    own.push((residuals.norm_squared(), point));
                }
            }
        }
        all
    }

    /// The factors of the one-branch series of the grid that fits best by the exact model, for contacts that are nothing like
    /// linear.
    ///
    /// # Errors
    /// As those of the model, but for cycles that are not found.
    pub(super) fn start_over(&mut self, model: &Model<'_>) -> Result<(), IdentifyError> {
        self.ln_factors.fill(0.0);
        let mut best: Option<(f64, Point, Vec<Option<f64>>)> = None;
        for own in self.grid() {
            let Some((_, point)) = own.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)) else {
                continue;
            };
            let exact = match model.numbers_where_found(&point.relaxation()?) {
                Err(IdentifyError::NoCycle { .. } | IdentifyError::NoHistory(_)) => continue,
                exact => exact?,
            };
            let squares = self.mean_square(&exact);
            if best.as_ref().is_none_or(|(least, ..)| squares < *least) {
                best = Some((squares, point, exact));
            }
        }
        if let Some((_, point, exact)) = best {
            self.take_factors(&point, &exact, 1.0);
        }
        Ok(())
    }

    /// The mean square of the logarithms of computed over measured numbers, of those that were found. Under a prescribed approach all
    /// loads go with the moduli and factors do not: loads that are off by one factor are met.
    fn mean_square(&self, exact: &[Option<f64>]) -> f64 {
        let is_free = self.plan.drive.control() == Control::Approach;
        let data = self.measured().data().iter().zip(exact);
        let offs = data.filter_map(|(datum, exact)| {
            let off = ((*exact)? / datum.value).ln();
            Some((off, is_free && datum.number.is_load()))
        });
        let (free, bound): (Vec<_>, Vec<_>) = offs.partition(|(_, is_free)| *is_free);
        let known: Vec<f64> = free
            .iter()
            .map(|(off, _)| *off)
            .filter(|off| off.is_finite())
            .collect();
        let common = known.iter().sum::<f64>() / known.len().max(1) as f64;
        let free = free.iter().map(|(off, _)| off - common);
        let offs = free.chain(bound.iter().map(|(off, _)| *off));
        // A millionth, nothing, and what is below zero are all as far off.
        let squares: Vec<f64> = offs.map(|off| off.max(1e-6_f64.ln()).powi(2)).collect();
        squares.iter().sum::<f64>() / squares.len().max(1) as f64
    }

    /// The best series of 1 to `most` branches, from `known` ones on where there are any.
    pub(super) fn search(&mut self, known: &[Point], most: usize) -> Vec<Point> {
        let mut starts = match known.first() {
            Some(first) => vec![first.clone()],
            None => self.first(),
        };
        let mut found: Vec<Point> = Vec::new();
        for branches in 1..=most {
            starts.extend(known.get(branches - 1).cloned());
            // About where the last search ended: the radius is then that of its own contact.
            if known.is_empty()
                && let Some(start) = starts.first()
            {
                self.about(start.equilibrium_pa());
            }
            let Some(best) = self.best_of(&starts) else {
                break;
            };
            starts = self.with_one_more(&best);
            found.push(best);
        }
        found
    }

    /// The best of several starts: all roughly, the better ones closely.
    fn best_of(&self, starts: &[Point]) -> Option<Point> {
        let rough = starts
            .iter()
            .filter_map(|start| minimise(self, start, ROUGHLY));
        let mut rough: Vec<Solution<Point>> = rough.collect();
        rough.sort_by(|a, b| a.squares().total_cmp(&b.squares()));
        let close = rough.iter().take(KEPT);
        let close = close.filter_map(|start| minimise(self, &start.unknowns, CLOSELY));
        let best = close.min_by(|a, b| a.squares().total_cmp(&b.squares()))?;
        Some(best.unknowns.sorted())
    }

    /// A series with one branch more, at each of several times.
    fn with_one_more(&self, point: &Point) -> Vec<Point> {
        let (low, high) = self.limits.times;
        let decades = (high - low) / std::f64::consts::LN_10;
        let count = (decades * 2.0).round().max(1.0);
        let places = (0..=count as usize).map(|k| low + (high - low) * k as f64 / count);
        let strength = |ln_time: f64| (0.2 * point.complex_modulus((-ln_time).exp()).norm()).ln();
        places
            .map(|ln_time| point.with(strength(ln_time), ln_time))
            .collect()
    }
}

impl Problem for Linearised<'_> {
    type Unknowns = Point;

    fn residuals(&self, point: &Point) -> Option<DVector<f64>> {
        self.weighed(self.relative(point).into_iter(), point)
    }

    fn derivatives(&self, point: &Point) -> Option<DMatrix<f64>> {
        let residuals = |moved| self.residuals(&Point(moved));
        let column = |place: usize| central_difference(&point.0, place, STEP, &residuals);
        let columns: Option<Vec<_>> = (0..point.0.len()).map(column).collect();
        Some(DMatrix::from_columns(&columns?))
    }

    fn clamp(&self, place: usize, value: f64) -> f64 {
        self.limits.clamp(place, value)
    }
}
