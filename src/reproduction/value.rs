//! Numbers read from curves, as claims.

use std::sync::atomic::{AtomicBool, Ordering};

use super::claim::{Claim, Source, Verdict};
use super::curve::Curve;
use super::exact::Exact;
use super::run::{By, ByEngine, Run, nodal_pressures_pa, unfit};
use super::spec::{ClaimSpec, Value};
use super::table::{Quantity, Row, at, points};
use super::{ReproductionError, Result};
use crate::contact::Prescribed;
use crate::engine::{EngineBuilder, LargestContact};
use crate::history::March;
use crate::sweep::record::Quarter;
use crate::sweep::search::peak::vertex;

/// The claims of curves, family by family.
pub(super) fn claims(curves: &[Curve<'_>], interrupt: &AtomicBool) -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for family in curves.chunk_by(|a, b| std::ptr::eq(a.family, b.family)) {
        for curve in family {
            let is_last = curve.index + 1 == family.len();
            let specs = curve.family.claims.iter();
            for spec in specs.filter(|spec| curve.index >= spec.from && (is_last || !spec.closing))
            {
                claims.push(Reading::new(spec, curve).claim(family, interrupt)?);
            }
        }
    }
    Ok(claims)
}

type Values = ByEngine<Option<f64>>;
type Point = (f64, f64);

/// What is claimed of one curve.
struct Reading<'a> {
    spec: &'a ClaimSpec,
    curve: &'a Curve<'a>,
    axes: [Quantity; 2],
    exact: Option<Exact>,
    rows: ByEngine<Vec<Row>>,
}

impl<'a> Reading<'a> {
    fn new(spec: &'a ClaimSpec, curve: &'a Curve<'a>) -> Self {
        let family = curve.family;
        let of = spec.of.unwrap_or(family.of);
        Self {
            axes: [spec.x.unwrap_or(family.x), spec.y.unwrap_or(family.y)],
            exact: spec.exact.or(family.exact),
            rows: By::ALL.map(|by| curve.rows(of, by)),
            spec,
            curve,
        }
    }

    fn claim(&self, family: &[Curve<'_>], interrupt: &AtomicBool) -> Result<Claim> {
        let Self { spec, curve, .. } = *self;
        let cell = if spec.in_cells { curve.cell() } else { 1.0 };
        let mut values = match spec.value {
            None => [None; 3],
            Some(value) => self.read(value, family, interrupt)?,
        };
        let source = self.source();
        let exact = spec.exact_at.and_then(|x| self.exact_at(x));
        let zero = (source == Source::Difference).then_some(0.0);
        values[0] = zero.or(spec.known).or(exact).or(values[0]);
        let times = spec.times.unwrap_or(1.0);
        Ok(Claim {
            quantity: curve.filled(&spec.quantity),
            source,
            values: values.map(|value| value.map(|value| times * value)),
            unit: spec.unit.clone(),
            tolerances: [spec.tolerance[0], spec.tolerance[1] * cell],
            paper: String::new(),
            stated: Verdict::NotStated,
            note: curve.filled(&spec.note),
        })
    }

    fn source(&self) -> Source {
        match self.spec.value {
            Some(Value::LargestError | Value::LastCycleDiffers(_)) => Source::Difference,
            Some(Value::EnginesDiffer | Value::DrivenBack) => Source::Difference,
            Some(Value::CyclesToWithin(_) | Value::Maxima) => Source::Count,
            _ if self.spec.known.is_some() => Source::ClosedForm,
            _ if self.exact == Some(Exact::Refined) => Source::Refined,
            _ => Source::ClosedForm,
        }
    }

    fn read(&self, value: Value, family: &[Curve<'_>], interrupt: &AtomicBool) -> Result<Values> {
        let quotient = |a: Values, b: Values| std::array::from_fn(|k| Some(a[k]? / b[k]?));
        let peak = || self.curve.peak(interrupt);
        Ok(match value {
            Value::At(x) => self.at(x),
            Value::Here => self.at(self.curve.at.unwrap_or_default()),
            Value::Difference([a, b]) => {
                let (a, b) = (self.at(a), self.at(b));
                std::array::from_fn(|k| Some(a[k]? - b[k]?))
            }
            Value::AtAxisOverCurve(other) => {
                let curve = family.get(other);
                let curve = curve.ok_or_else(|| unfit(format!("there is no curve {other}")))?;
                quotient(self.at(0.0), Reading::new(self.spec, curve).at(0.0))
            }
            Value::Peak => peak()?.map(|(x, y)| Some(if self.spec.place { x } else { y })),
            Value::ShareAt(x) => quotient(self.at(x), peak()?.map(|(_, y)| Some(y))),
            Value::EnginesDiffer => [None, None, self.engines_differ()],
            Value::DrivenBack => {
                let by = |by| self.driven_back(by, interrupt);
                [None, by(By::Springs)?, by(By::Cells)?]
            }
            value => By::ALL.map(|by| self.of_signal(value, by)),
        })
    }

    fn exact_at(&self, x: f64) -> Option<f64> {
        match self.exact? {
            Exact::Refined => at(&self.rows[By::Refined as usize], self.axes, x),
            closed => self.curve.closed_form(closed, x),
        }
    }

    fn at(&self, x: f64) -> Values {
        let [_, springs, cells] = self.rows.each_ref().map(|rows| at(rows, self.axes, x));
        [self.exact_at(x), springs, cells]
    }

    /// What is read of all points by one engine; `None` of none.
    fn of_signal(&self, value: Value, by: By) -> Option<f64> {
        let rows = &self.rows[by as usize];
        let signal = points(rows, self.axes);
        let duration = signal.last()?.0;
        let ys: Vec<f64> = signal.iter().map(|point| point.1).collect();
        match value {
            Value::Largest(between, reach) | Value::Smallest(between, reach) => {
                let sign = if matches!(value, Value::Largest(..)) {
                    1.0
                } else {
                    -1.0
                };
                let (x, y) = extremum(&signal, between, sign, reach[by as usize])?;
                Some(if self.spec.place {
                    x - self.spec.after
                } else {
                    y
                })
            }
            Value::CyclesToWithin(part) => {
                let cycles = (duration * self.curve.at?).round() as usize;
                let largest = ys.iter().copied().fold(0.0, f64::max);
                let is_near = |k: &usize| distance(&ys, cycles, [*k, cycles - 1]) <= part * largest;
                (0..cycles).find(is_near).map(|k| (k + 1) as f64)
            }
            Value::Maxima => {
                let maxima = ys.windows(3).filter(|y| y[1] > y[0] && y[1] >= y[2]);
                Some(maxima.count() as f64)
            }
            Value::LastCycleDiffers(cycles) => {
                Some(distance(&ys, cycles, [cycles - 1, cycles - 2]))
            }
            Value::LargestError => {
                let rows = self.curve.shown(rows.clone());
                let aside = self.spec.edge_cells.map(|cells| cells * self.curve.cell());
                let aside = aside.zip(self.curve.edge());
                let is_away = |x: f64| aside.is_none_or(|(aside, edge)| (x - edge).abs() > aside);
                let every = self
                    .spec
                    .points
                    .map_or(1, |count| rows.len() / count.max(1));
                let rows = rows.iter().step_by(every.max(1));
                largest_error(rows, self.axes, is_away, |x| self.exact_at(x))
            }
            _ => None,
        }
    }

    /// Over the contact away from its edge, at the quarters at which there is one.
    fn engines_differ(&self) -> Option<f64> {
        let axes = [Quantity::Radius, Quantity::Pressure];
        let aside = self.spec.edge_cells? * self.curve.cell();
        let quarters = [Quarter::MeanRising, Quarter::Greatest, Quarter::MeanFalling];
        let differences = quarters.map(|quarter| {
            let engines = [By::Springs, By::Cells];
            let [springs, cells] = engines.map(|by| self.curve.surface(quarter as usize, by));
            let loaded = points(&springs, axes).into_iter().filter(|(_, p)| *p > 0.0);
            let edge = loaded.map(|(radius, _)| radius).fold(0.0, f64::max);
            let is_away = |radius: f64| (radius - edge).abs() > aside;
            // Springs stand where there is contact at some instant: beyond them nothing presses.
            let reach = *springs.last()?.get(&axes[0])?;
            let inside = |radius| at(&springs, axes, radius);
            let expected = |radius| (radius > reach).then_some(0.0).or_else(|| inside(radius));
            largest_error(cells.iter(), axes, is_away, expected)
        });
        largest(differences.into_iter())
    }

    /// The approach of the history imposed at its times, on an engine with the same nodes.
    fn driven_back(&self, by: By, interrupt: &AtomicBool) -> Result<Option<f64>> {
        let Curve { runs, outcomes, .. } = self.curve;
        let (runs, outcomes) = (&runs[by as usize][..], &outcomes[by as usize][..]);
        let ([(_, Run::History(plan))], [history]) = (runs, outcomes) else {
            return Err(unfit("a history alone can be driven back"));
        };
        let times_s = &plan.output.profiles_at_s;
        let compliance = self.curve.problem.contact_compliance.clone();
        let largest_contact = LargestContact {
            control: plan.drive.control(),
            maximum: plan.drive.maximum(),
            compliance_per_pa: compliance.compliance(plan.drive.duration_s()),
        };
        let indenter = plan.contact.indenter.clone();
        let engines = EngineBuilder::new(indenter, plan.solver, largest_contact)?;
        let mut engine = engines.engine(0)?;
        let mut march = March::new(engine.as_mut(), compliance, plan.solver.time_rule);
        let (mut time_s, mut from_m, mut differences) = (0.0, 0.0, Vec::new());
        for (next_s, to_m) in points(&history.instants, [Quantity::Time, Quantity::Approach]) {
            if interrupt.load(Ordering::Relaxed) {
                return Err(ReproductionError::Interrupted);
            }
            let stages = march.stages(next_s - time_s);
            let approach_m = |end: f64| from_m + end * (to_m - from_m);
            march.step_in_stages(&stages, |end| Prescribed::ApproachM(approach_m(end)))?;
            (time_s, from_m) = (next_s, to_m);
            let place = times_s.iter().position(|at_s| *at_s == next_s);
            if let Some(expected) = place.and_then(|place| history.pressures_pa.get(place)) {
                let pressures = march.surface()?.map(|surface| nodal_pressures_pa(&surface));
                differences.push(pressures.and_then(|found| difference(&found, expected)));
            }
        }
        Ok(largest(differences.into_iter()))
    }
}

/// Largest difference over the same nodes, as a part of the peak; `None` where the nodes differ.
fn difference(a: &[f64], b: &[f64]) -> Option<f64> {
    let peak = b.iter().copied().fold(0.0, f64::max);
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    (a.len() == b.len()).then(|| differences.fold(0.0, f64::max) / peak)
}

/// Largest difference of the rows from the expected value, at the places that count.
fn largest_error<'r>(
    rows: impl Iterator<Item = &'r Row>,
    [x, y]: [Quantity; 2],
    counts: impl Fn(f64) -> bool,
    expected: impl Fn(f64) -> Option<f64>,
) -> Option<f64> {
    let places = rows.filter_map(|row| Some((*row.get(&x)?, row.get(&y))));
    let meant = places.filter(|(x, _)| counts(*x));
    largest(meant.map(|(x, y)| Some((y? - expected(x)?).abs())))
}

/// The largest of these; `None` where there are none, or one is undefined.
fn largest(mut values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let first = values.next()??;
    values.try_fold(first, |largest, next| Some(largest.max(next?)))
}

/// Largest difference between two of this many cycles of a signal, counted from 0.
fn distance(signal: &[f64], cycles: usize, [a, b]: [usize; 2]) -> f64 {
    let steps = signal.len().saturating_sub(1) / cycles.max(1);
    let cycle = |k: usize| signal.iter().skip(k * steps).take(steps + 1);
    let differences = cycle(a).zip(cycle(b)).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}

/// The largest sample of a signal between two times, or with a negative sign the smallest: when, from a parabola through samples
/// `reach` apart, and its value.
fn extremum(signal: &[Point], [from, to]: [f64; 2], sign: f64, reach: usize) -> Option<Point> {
    let places = (0..signal.len()).filter(|&k| signal[k].0 > from && signal[k].0 < to);
    let height = |k: usize| sign * signal[k].1;
    let best = places.max_by(|&a, &b| height(a).total_cmp(&height(b)))?;
    let about = [best.checked_sub(reach)?, best, best + reach];
    signal.get(best + reach)?;
    let (time, _) = vertex(&about.map(|k| signal[k].0), &about.map(height))?;
    Some((time, signal[best].1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_extremum_lies_between_samples_and_within_its_part() {
        let wave = |k: i32| (f64::from(k), (0.5 * f64::from(k) - 0.1).sin());
        let signal: Vec<(f64, f64)> = (0..20).map(wave).collect();
        let found = |sign| extremum(&signal, [5.0, 17.0], sign, 1);
        let (largest, smallest) = (found(1.0).unwrap(), found(-1.0).unwrap());
        let turn = std::f64::consts::TAU + std::f64::consts::FRAC_PI_2;
        assert!((largest.0 - 2.0 * (turn + 0.1)).abs() < 0.02, "{largest:?}");
        assert_eq!(largest.1, signal[16].1);
        assert!(smallest.0 > 9.0 && smallest.0 < 10.0 && smallest.1 < -0.9);
        assert_eq!(extremum(&signal, [17.5, 30.0], 1.0, 5), None);
    }

    #[test]
    fn the_largest_of_what_is_undefined_is_undefined() {
        assert_eq!(
            largest([Some(1.0), Some(3.0), Some(2.0)].into_iter()),
            Some(3.0)
        );
        assert_eq!(largest([Some(3.0), None].into_iter()), None);
        assert_eq!(largest(std::iter::empty()), None);
    }

    #[test]
    fn cycles_of_a_signal_are_compared_sample_by_sample() {
        // Three cycles of two steps: 4 at first, then 1 off, then the last.
        let signal = [0.0, 4.0, 0.0, 1.0, 0.5, 0.0, 0.0];
        assert_eq!(distance(&signal, 3, [0, 2]), 4.0);
        assert_eq!(distance(&signal, 3, [1, 2]), 1.0);
        assert_eq!(distance(&signal, 3, [2, 2]), 0.0);
    }
}
