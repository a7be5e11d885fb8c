//! One curve of a family: what is computed for it, and what is read of that.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::exact::{Exact, Problem};
use super::number::short;
use super::run::{By, ByEngine, Outcome, Run, at_frequency, unfit};
use super::spec::{Family, Frequencies, Of};
use super::table::{Quantity, Row, at, row};
use super::{Plans, ReproductionError, Result};
use crate::sweep::search::peak::{refine, vertex};

pub(super) struct Curve<'a> {
    pub family: &'a Family,
    /// Which of the family.
    pub index: usize,
    /// The time of a profile, or the frequency of a cycle.
    pub at: Option<f64>,
    pub label: &'a str,
    pub problem: Problem<'a>,
    /// Of the surfaces of a computation.
    surface: usize,
    /// Each with its angular frequency (rad/s) where it has one.
    pub runs: ByEngine<Vec<(f64, Run)>>,
    /// Of these runs, once they are computed.
    pub outcomes: ByEngine<Vec<Arc<Outcome>>>,
}

/// The curves of a family, in the order of their times or frequencies.
pub(super) fn curves<'a>(family: &'a Family, plans: &'a Plans) -> Result<Vec<Curve<'a>>> {
    let listed = |listed: &[Frequencies]| -> Result<Vec<f64>> {
        let omegas = listed.iter().map(|one| match one {
            Frequencies::File(name) => Ok(plans.sweep(name)?.angular_frequencies_rad_per_s.clone()),
            Frequencies::Omega(omega) => Ok(vec![*omega]),
        });
        Ok(omegas.collect::<Result<Vec<_>>>()?.concat())
    };
    let (sweep, scenario) = (plans.sweep(&family.file), plans.scenario(&family.file));
    let omegas = match &sweep {
        Ok(plan) if family.frequencies.is_empty() => plan.angular_frequencies_rad_per_s.clone(),
        _ => in_order(listed(&family.frequencies)?),
    };
    let size = if family.of == Of::Spectrum {
        omegas.len()
    } else {
        1
    };
    let none = omegas.is_empty().then_some(&[][..]);
    let groups = omegas.chunks(size.max(1)).chain(none);
    let times_s = match scenario {
        Ok(plan) if family.of == Of::Surface => &plan.output.profiles_at_s[..],
        _ => &[],
    };
    let quarters = family.quarters.iter().map(|quarter| *quarter as usize);
    let mut surfaces: Vec<usize> = quarters.chain(0..times_s.len()).collect();
    surfaces.extend(surfaces.is_empty().then_some(0));
    let mut curves = Vec::new();
    for compared in groups {
        let more = in_order([compared, &listed(&family.more)?].concat());
        for &surface in &surfaces {
            let run = |by| match by {
                By::Refined if !family.compares_refined() => Ok(Vec::new()),
                By::Springs => runs(family, plans, by, &more),
                _ => runs(family, plans, by, compared),
            };
            let f = compared.first().filter(|_| family.of != Of::Spectrum);
            curves.push(Curve {
                problem: Problem::new(&family.file, plans)?,
                runs: [run(By::Refined)?, run(By::Springs)?, run(By::Cells)?],
                outcomes: Default::default(),
                label: in_turn(&family.labels, curves.len()),
                index: curves.len(),
                at: f.map(|omega| omega / TAU).or(times_s.get(surface).copied()),
                family,
                surface,
            });
        }
    }
    Ok(curves)
}

/// What has to be computed by one engine, at each angular frequency (rad/s) if there are any.
fn runs(family: &Family, plans: &Plans, by: By, omegas: &[f64]) -> Result<Vec<(f64, Run)>> {
    if let Ok(plan) = plans.sweep(&family.file) {
        let run = |omega: &f64| (*omega, Run::cycle(plan, by, *omega));
        return Ok(omegas.iter().map(run).collect());
    }
    let plan = plans.scenario(&family.file)?;
    let at_each = omegas.iter().map(|omega| {
        let plan = at_frequency(plan, *omega, family.side)?;
        Ok((*omega, Run::history(&plan, by)))
    });
    match omegas.is_empty() {
        true => Ok(vec![(0.0, Run::history(plan, by))]),
        false => at_each.collect(),
    }
}

/// One of the words for each curve.
pub(super) fn in_turn(words: &[String], index: usize) -> &str {
    let word = words.get(index % words.len().max(1));
    word.map_or("", String::as_str)
}

/// Sorted, each once.
fn in_order(mut omegas: Vec<f64>) -> Vec<f64> {
    omegas.sort_by(f64::total_cmp);
    omegas.dedup_by(|a, b| (*a / *b - 1.0).abs() < 1e-9);
    omegas
}

impl Curve<'_> {
    /// What one engine gives, in the paper's units; nothing where it was not computed.
    pub fn rows(&self, of: Of, by: By) -> Vec<Row> {
        let outcomes = &self.outcomes[by as usize];
        match of {
            Of::Surface => self.surface(self.surface, by),
            Of::Time => {
                let first = outcomes.first().map(|outcome| outcome.instants.clone());
                self.normalised(first.unwrap_or_default())
            }
            Of::Cycle | Of::Spectrum => {
                let pairs = self.runs[by as usize].iter().zip(outcomes);
                let numbers = pairs.map(|((value, _), outcome)| {
                    let (omega, f) = (Quantity::AngularFrequency, Quantity::Frequency);
                    let place = [(omega, *value), (f, value / TAU)];
                    outcome.numbers.clone().into_iter().chain(place).collect()
                });
                self.normalised(numbers.collect())
            }
        }
    }

    /// One of the surfaces of its first computation.
    pub fn surface(&self, place: usize, by: By) -> Vec<Row> {
        let first = self.outcomes[by as usize].first();
        let surface = first.and_then(|outcome| outcome.surfaces.get(place));
        self.normalised(surface.cloned().unwrap_or_default())
    }

    fn normalised(&self, mut rows: Vec<Row>) -> Vec<Row> {
        for (quantity, value) in rows.iter_mut().flatten() {
            *value /= self.problem.unit(*quantity);
        }
        rows
    }

    /// Those of the rows that are shown.
    pub fn shown(&self, mut rows: Vec<Row>) -> Vec<Row> {
        let Some([from, to]) = self.family.shown else {
            return rows;
        };
        let is_within = |x: &f64| (from - 1e-9..=to).contains(x);
        rows.retain(|row| row.get(&self.family.x).is_none_or(is_within));
        rows
    }

    /// A closed form at x, in the paper's units.
    pub fn closed_form(&self, exact: Exact, x: f64) -> Option<f64> {
        exact.value(&self.problem, self.at.unwrap_or_default(), x)
    }

    /// Contact radius under a step load.
    pub fn edge(&self) -> Option<f64> {
        self.closed_form(Exact::StepLoadRadius, self.at?)
    }

    /// The exact rows that are drawn; where no places are given, those of the springs.
    pub fn exact_rows(&self) -> Vec<Row> {
        let family = self.family;
        let Some(exact) = family.exact.filter(|exact| *exact != Exact::Refined) else {
            return match family.draws_refined {
                true => self.rows(family.of, By::Refined),
                false => Vec::new(),
            };
        };
        let xs: Vec<f64> = match family.sampled {
            Some((from, to, parts)) => {
                let to = self.edge().filter(|_| to.is_infinite()).unwrap_or(to);
                let place = |k: usize| from + (to - from) * k as f64 / parts as f64;
                (0..=parts).map(place).collect()
            }
            None => {
                let springs = self.rows(family.of, By::Springs);
                let x = |row: &Row| row.get(&family.x).copied();
                springs.iter().filter_map(x).collect()
            }
        };
        let y = |x| self.closed_form(exact, x);
        let rows = xs.into_iter();
        rows.map(|x| row([(family.x, Some(x)), (family.y, y(x))]))
            .collect()
    }

    /// Cells per side.
    pub fn side(&self) -> usize {
        let on_cells = self.runs[By::Cells as usize].first();
        on_cells.map_or(0, |(_, run)| run.solver().cells)
    }

    /// Side of a cell in Hertz radii.
    pub fn cell(&self) -> f64 {
        let on_cells = self.outcomes[By::Cells as usize].first();
        let half_width_m = on_cells.map_or(0.0, |outcome| outcome.half_width_m);
        2.0 * half_width_m / self.side() as f64 / self.problem.unit(Quantity::Radius)
    }

    /// A text of the file with its placeholders filled in.
    pub fn filled(&self, text: &str) -> String {
        let text = text.replace("{label}", self.label);
        let text = text.replace("{at}", &self.at.map(short).unwrap_or_default());
        let text = text.replace("{side}", &self.side().to_string());
        let text = text.replace("{half_cell}", &format!("{:.4}", 0.5 * self.cell()));
        let text = text.replace("{springs}", SPRINGS);
        text.replace("{cells}", &cells_label(self.side()))
    }

    /// Place and value of the maximum over frequency, by each engine.
    pub fn peak(&self, interrupt: &AtomicBool) -> Result<ByEngine<(f64, f64)>> {
        let family = self.family;
        let places = family.peak.ok_or_else(|| unfit("the curve has no peak"))?;
        let through = |by| {
            let rows = self.rows(family.of, by);
            let y = |x| at(&rows, [family.x, family.y], x);
            match places.map(|x| Some((x, y(x)?))) {
                [Some(low), Some(middle), Some(high)] => Ok([low, middle, high]),
                _ => Err(unfit("a point about the maximum is missing")),
            }
        };
        let [exact, springs, cells] = By::ALL.map(|by| parabola(through(by)?));
        let mut peaks = [exact?, springs?, cells?];
        let springs = &self.runs[By::Springs as usize];
        if let (true, Some((_, Run::Cycle(plan)))) = (family.search, springs.first()) {
            let bracket = through(By::Refined)?;
            let loss_j = |omega: &f64| {
                let outcome = Run::cycle(plan, By::Springs, *omega).compute(interrupt)?;
                Ok((outcome.numbers[&Quantity::Energy], None))
            };
            let losses_j = |omegas: &[f64]| omegas.iter().map(loss_j).collect();
            let found = refine::<ReproductionError>(&bracket, &losses_j)?;
            // The loss is flat about its maximum: the refined one nearest to it is as large.
            peaks[0] = (found.angular_frequency_rad_per_s, bracket[1].1);
        }
        Ok(peaks)
    }
}

pub(super) const SPRINGS: &str = "axisymmetric engine";

/// The half-space engine with this many cells per side.
pub(super) fn cells_label(side: usize) -> String {
    format!("half-space engine, {side} × {side} cells")
}

/// Maximum of the parabola in ln x through three points that are equally spaced there: (x, y).
fn parabola(points: [(f64, f64); 3]) -> Result<(f64, f64)> {
    let [(low, _), (middle, _), (high, _)] = points;
    let width = 0.5 * (high / low).ln();
    let found = vertex(&[-width, 0.0, width], &points.map(|p| p.1));
    let (shift, y) = found.ok_or_else(|| unfit(format!("no maximum at {middle}")))?;
    Ok((middle * shift.exp(), y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_in_the_logarithm_has_its_maximum_found() {
        let y = |x: f64| 3.0 - 2.0 * (x / 0.7).ln().powi(2);
        let found = parabola([0.5, 0.6, 0.72].map(|x: f64| (x, y(x)))).unwrap();
        assert!((found.0 - 0.7).abs() < 1e-12 && (found.1 - 3.0).abs() < 1e-12);
    }
}
