//! An instant on the whole grid, whatever the elastic operator: conjugate gradients with contact-set updates (I. A. Polonsky and
//! L. M. Keer, Wear 231 (1999) 206; the approach-controlled variant without mean-gap correction and load rescaling is that of
//! S. Spinu, Advances in Tribology 2018, 9432894, figure 2).
//!
//! The iteration minimises the complementary energy over p >= 0. While no cell enters or leaves the contact, the displacement
//! follows the pressure by the product already computed for the search direction, so that an iteration costs one convolution;
//! where the contact changes, it costs two.

use std::sync::atomic::AtomicBool;

use super::active_set::Work;
use super::convolution::{ConvolutionError, Scratch};
use super::instant::{Imposed, ROUNDING, STANDING_OFF, SolverSettings, start};
use super::passes;
use crate::contact::{ContactError, go_on};

/// The elastic operator B of a surface in cells: writes the displacement (m per 1/Pa) of every cell by these pressures (Pa).
pub(super) type Operator<'a> =
    dyn Fn(&[f64], &mut [f64], &mut Scratch) -> Result<(), ConvolutionError> + 'a;

/// Fields of the whole grid.
pub(super) struct PolonskyKeer {
    scratch: Scratch,
    /// g + B H: the gap under no pressure, before the approach is taken off.
    free_gap_m: Vec<f64>,
    /// B p, without the compliance.
    displacement: Vec<f64>,
    /// B t.
    response: Vec<f64>,
    direction: Vec<f64>,
    /// What rounding leaves in a gap (m).
    noise_m: f64,
    /// Convolutions computed so far.
    convolutions: usize,
}

/// What does not change during an instant.
pub(super) struct InstantProblem<'a> {
    pub(super) operator: &'a Operator<'a>,
    /// The displacement (m) of which the tolerance is a part; `None` while nothing is in contact.
    pub(super) reference_m: fn(&Residual) -> Option<f64>,
    pub(super) settings: SolverSettings,
    pub(super) gap_m: &'a [f64],
    pub(super) compliance: f64,
    pub(super) imposed: Imposed,
    /// Set from outside to end the instant.
    pub(super) interrupt: Option<&'a AtomicBool>,
}

/// The state of the iteration between two passes.
struct IterationState {
    previous_squared_gap: f64,
    /// Whether the next direction may be conjugate to the last.
    conjugate: bool,
    /// Whether the displacement is a fresh convolution rather than carried along by recursion.
    exact: bool,
}

impl PolonskyKeer {
    fn new(cells: usize) -> Self {
        Self {
            scratch: Scratch::default(),
            free_gap_m: vec![0.0; cells],
            displacement: vec![0.0; cells],
            response: vec![0.0; cells],
            direction: vec![0.0; cells],
            noise_m: 0.0,
            convolutions: 0,
        }
    }

    /// Solves what another way has left, from the pressure given; counts the convolutions. Returns the residual at the end and all
    /// iterations; `None` where no pressure at all is the solution. `safeguard` is made when it is first needed.
    pub(super) fn take_over(
        safeguard: &mut Option<Box<Self>>,
        given: &InstantProblem<'_>,
        history: &[f64],
        pressure: &mut [f64],
        work: &mut Work,
    ) -> Result<Option<(Residual, usize)>, ContactError> {
        let new = || Box::new(Self::new(given.gap_m.len()));
        let safeguard = safeguard.get_or_insert_with(new);
        safeguard.convolutions = 0;
        let solved = safeguard.solve(given, history, pressure, work.steps);
        work.convolutions += safeguard.convolutions;
        solved
    }

    fn solve(
        &mut self,
        given: &InstantProblem<'_>,
        history: &[f64],
        pressure: &mut [f64],
        taken: usize,
    ) -> Result<Option<(Residual, usize)>, ContactError> {
        self.prepare_free_gap(given, history)?;
        // Where the free surface is clear of the indenter, no pressure is the solution, whatever the guess.
        if let Imposed::ApproachM(approach_m) = given.imposed
            && self.free_gap_m.iter().all(|&free| free >= approach_m)
        {
            return Ok(None);
        }
        self.iterate(given, pressure, taken).map(Some)
    }

    fn prepare_free_gap(
        &mut self,
        given: &InstantProblem<'_>,
        history: &[f64],
    ) -> Result<(), ContactError> {
        let displace = |q: &[f64], u: &mut [f64]| (given.operator)(q, u, &mut self.scratch);
        let noise_m = lift_free_gap(history, given.gap_m, &mut self.free_gap_m, displace)?;
        self.convolutions += usize::from(noise_m.is_some());
        self.noise_m = noise_m.unwrap_or(0.0);
        Ok(())
    }

    fn refresh_displacement(
        &mut self,
        operator: &Operator<'_>,
        pressure: &[f64],
    ) -> Result<(), ContactError> {
        operator(pressure, &mut self.displacement, &mut self.scratch)?;
        self.convolutions += 1;
        Ok(())
    }

    /// Conjugate direction t = gap + beta t inside the contact, 0 outside; returns the sum of gap * t.
    fn update_direction(
        &mut self,
        compliance: f64,
        residual: &Residual,
        beta: f64,
        pressure: &[f64],
    ) -> f64 {
        let mut product = 0.0;
        let fields = self.free_gap_m.iter().zip(&self.displacement);
        for ((t, &p), (&free, &u)) in self.direction.iter_mut().zip(pressure).zip(fields) {
            *t = if p > 0.0 {
                let gap = free + compliance * u - residual.approach_m;
                let next = gap + beta * *t;
                product += gap * next;
                next
            } else {
                0.0
            };
        }
        product
    }

    /// The direction of the cells that penetrate without carrying pressure; returns the sum of gap * t.
    fn penetrating_direction(
        &mut self,
        compliance: f64,
        residual: &Residual,
        pressure: &[f64],
    ) -> f64 {
        let mut product = 0.0;
        let fields = self.free_gap_m.iter().zip(&self.displacement);
        for ((t, &p), (&free, &u)) in self.direction.iter_mut().zip(pressure).zip(fields) {
            *t = if p > 0.0 {
                0.0
            } else {
                (free + compliance * u - residual.approach_m).min(0.0)
            };
            product += *t * *t;
        }
        product
    }

    /// Step length along the direction: sum(gap t) / sum(r t), with r = A B t less, under load control, its mean over the
    /// contact. `None` where there is no curvature.
    fn step_length(
        &mut self,
        given: &InstantProblem<'_>,
        product: f64,
        load_controlled: bool,
        pressure: &[f64],
    ) -> Result<Option<f64>, ContactError> {
        (given.operator)(&self.direction, &mut self.response, &mut self.scratch)?;
        self.convolutions += 1;
        let (mut sum, mut weighted, mut total, mut cells) = (0.0, 0.0, 0.0, 0usize);
        for ((&t, &r), &p) in self.direction.iter().zip(&self.response).zip(pressure) {
            weighted += r * t;
            if p > 0.0 {
                sum += r;
                total += t;
                cells += 1;
            }
        }
        let mean = if load_controlled {
            sum / cells.max(1) as f64
        } else {
            0.0
        };
        let curvature = given.compliance * (weighted - mean * total);
        Ok((curvature > 0.0).then(|| product / curvature))
    }

    /// p <- p - step t, clipped at 0; penetrating cells outside join the contact. Returns whether any joined, whether any left.
    fn move_pressure(
        &mut self,
        compliance: f64,
        approach_m: f64,
        step: f64,
        pressure: &mut [f64],
    ) -> (bool, bool) {
        let (mut joined, mut left) = (false, false);
        let fields = self.free_gap_m.iter().zip(&self.displacement);
        for ((p, &t), (&free, &u)) in pressure.iter_mut().zip(&self.direction).zip(fields) {
            if *p > 0.0 {
                *p -= step * t;
                if *p <= 0.0 {
                    *p = 0.0;
                    left = true;
                }
            } else {
                let gap = free + compliance * u - approach_m;
                if gap < 0.0 {
                    *p = -step * gap;
                    joined = true;
                }
            }
        }
        (joined, left)
    }

    /// One pass: direction, step, projection, load. False where the direction has no curvature, and nothing moved.
    fn advance(
        &mut self,
        given: &InstantProblem<'_>,
        residual: &Residual,
        state: &mut IterationState,
        pressure: &mut [f64],
    ) -> Result<bool, ContactError> {
        let compliance = given.compliance;
        let target_sum = given.imposed.target_sum();
        let beta = if state.conjugate {
            residual.squared_gap / state.previous_squared_gap
        } else {
            0.0
        };
        let mut product = self.update_direction(compliance, residual, beta, pressure);
        state.previous_squared_gap = residual.squared_gap;
        let mut step = self.step_length(given, product, target_sum.is_some(), pressure)?;
        if step.is_none() && residual.penetration_m > 0.0 {
            // Nothing is in contact, or the contact is settled (a single cell that carries the load always is) while others
            // penetrate: these show the way.
            product = self.penetrating_direction(compliance, residual, pressure);
            step = self.step_length(given, product, false, pressure)?;
        }
        let Some(step) = step else {
            return Ok(false);
        };
        let (joined, left) = self.move_pressure(compliance, residual.approach_m, step, pressure);
        let scale = rescale(target_sum, pressure);
        if joined || left {
            self.refresh_displacement(given.operator, pressure)?;
        } else {
            for (u, r) in self.displacement.iter_mut().zip(&self.response) {
                *u = scale * (*u - step * r);
            }
        }
        state.exact = joined || left;
        state.conjugate = !joined;
        Ok(true)
    }

    /// Gap sums; the approach is prescribed or, under load control, found here.
    fn residual(&self, given: &InstantProblem<'_>, pressure: &[f64]) -> Residual {
        let compliance = given.compliance;
        let cells = || {
            let fields = self.free_gap_m.iter().zip(&self.displacement);
            pressure.iter().zip(fields)
        };
        let mut total = Residual::default();
        let mut lifted_sum = 0.0;
        for (&p, (free, u)) in cells() {
            if p > 0.0 {
                let elastic = compliance * u;
                total.cells += 1;
                lifted_sum += free + elastic;
                total.work += p * elastic;
                total.lifted += p * (free + elastic);
                total.pressure_sum += p;
            }
        }
        let prescribed_m = given.imposed.approach_m();
        total.approach_m = prescribed_m.unwrap_or(lifted_sum / total.cells.max(1) as f64);
        let mut lowest = 0.0_f64;
        let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
        for (&p, (free, u)) in cells() {
            let elastic = compliance * u;
            (least, largest) = (least.min(elastic), largest.max(elastic));
            let gap = free + elastic - total.approach_m;
            if p > 0.0 {
                total.squared_gap += gap * gap;
                total.misfit += p * gap.abs();
                total.standing_off_m = total.standing_off_m.max(gap);
            } else {
                lowest = lowest.min(gap);
            }
        }
        total.penetration_m = -lowest;
        total.elastic_range_m = largest - least;
        total
    }

    /// The iteration. Returns the residual at the end and the iterations taken.
    fn iterate(
        &mut self,
        given: &InstantProblem<'_>,
        pressure: &mut [f64],
        taken: usize,
    ) -> Result<(Residual, usize), ContactError> {
        let operator = given.operator;
        start(given.imposed.target_sum(), given.gap_m, pressure);
        self.refresh_displacement(operator, pressure)?;
        self.direction.fill(0.0);
        let mut state = IterationState {
            previous_squared_gap: 1.0,
            conjugate: false,
            exact: true,
        };
        let tolerance = given.settings.tolerance;
        let (mut relative, mut iterations) = (f64::INFINITY, taken);
        for iteration in taken..given.settings.max_iterations {
            go_on(given.interrupt)?;
            let residual = self.residual(given, pressure);
            if residual.cells == 0 && given.imposed.target_sum().is_some() {
                // A step has emptied the contact, which has a load to carry: begin again.
                start(given.imposed.target_sum(), given.gap_m, pressure);
                self.refresh_displacement(operator, pressure)?;
                (state.exact, state.conjugate) = (true, false);
                continue;
            }
            let noise_m = self.noise_m + ROUNDING * residual.approach_m.abs();
            relative = residual.relative((given.reference_m)(&residual), tolerance, noise_m);
            if relative <= tolerance {
                if state.exact {
                    return Ok((residual, iteration));
                }
                // Rounding piles up in a displacement carried along by recursion: judge a fresh one.
                self.refresh_displacement(operator, pressure)?;
                state.exact = true;
                continue;
            }
            iterations = iteration + 1;
            if !self.advance(given, &residual, &mut state, pressure)? {
                break;
            }
        }
        Err(ContactError::NotConverged {
            iterations,
            residual: relative,
            tolerance,
        })
    }
}

/// The gap under the history alone, before the approach is taken off: g + B H (m). Returns what rounding leaves in it (m); `None` where
/// there is no history, and so nothing to displace.
pub(super) fn lift_free_gap(
    history: &[f64],
    gap_m: &[f64],
    free_gap_m: &mut [f64],
    displace: impl FnOnce(&[f64], &mut [f64]) -> Result<(), ConvolutionError>,
) -> Result<Option<f64>, ContactError> {
    if history.iter().all(|h| *h == 0.0) {
        passes::copy(gap_m, free_gap_m);
        return Ok(None);
    }
    displace(history, free_gap_m)?;
    let largest_m = passes::largest(free_gap_m);
    passes::add(free_gap_m, gap_m);
    Ok(Some(ROUNDING * largest_m))
}

/// Scales the pressure to the prescribed sum; returns the factor, 1 where nothing is prescribed.
fn rescale(target_sum: Option<f64>, pressure: &mut [f64]) -> f64 {
    let Some(target) = target_sum else { return 1.0 };
    let sum: f64 = pressure.iter().sum();
    if sum <= 0.0 {
        return 1.0;
    }
    let scale = target / sum;
    pressure.iter_mut().for_each(|p| *p *= scale);
    scale
}

/// How far a pressure is from the solution of an instant, gaps inside the contact and penetration outside: the sums over the
/// contact that one iteration needs.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Residual {
    cells: usize,
    /// The approach prescribed, or the mean over the contact of free gap + displacement (mean-gap correction).
    approach_m: f64,
    /// Sum of the squared gaps inside the contact (m^2).
    squared_gap: f64,
    /// Sums over the contact of p |gap|, of p u, of p (free gap + u), and of p.
    misfit: f64,
    work: f64,
    lifted: f64,
    pub(super) pressure_sum: f64,
    /// Largest displacement by the instant's own pressure less the least (m).
    elastic_range_m: f64,
    /// Deepest penetration outside the contact, as a positive number (m).
    penetration_m: f64,
    /// Highest gap under pressure, at least 0 (m).
    standing_off_m: f64,
}

impl Residual {
    /// The approach (m) under load control. Weighted by the pressure, the mean gap left by the iteration counts only in second
    /// order.
    pub(super) fn mean_approach_m(&self) -> f64 {
        self.lifted / self.pressure_sum
    }

    /// The displacement (m) that the pressure causes, weighted by it.
    pub(super) fn weighted_displacement_m(&self) -> Option<f64> {
        (self.work > 0.0).then(|| self.work / self.pressure_sum)
    }

    /// Without its mean, a displacement is as large as the distance (m) between its extremes.
    pub(super) fn displacement_range_m(&self) -> Option<f64> {
        Some(self.elastic_range_m)
    }

    /// What the tolerance bounds, gaps below `noise_m` counting as none; 0 out of contact, infinite where nothing is in
    /// contact yet but something penetrates.
    fn relative(&self, reference_m: Option<f64>, tolerance: f64, noise_m: f64) -> f64 {
        if self.penetration_m <= 0.0 && self.misfit == 0.0 {
            return 0.0;
        }
        let Some(reference_m) = reference_m else {
            return f64::INFINITY;
        };
        let reference_m = reference_m + noise_m / tolerance;
        let standing_off_m = self.standing_off_m / STANDING_OFF;
        (self.misfit / self.pressure_sum)
            .max(standing_off_m)
            .max(self.penetration_m)
            / reference_m
    }
}
