//! The resolution at which the error of a case's loss stays below what is asked for, at the least cost.

use crate::engine::EngineKind;
use crate::sweep::case::Resolution;
use crate::sweep::case::levels::Levels;
use crate::sweep::case::stabilise::{CaseError, Stabilised};
use crate::sweep::record::error_bars::{Bar, Quantity};
use crate::sweep::record::{CaseRecord, CaseResult};

impl Levels<'_> {
    /// Chooses steps, no fewer than the plan's, and nodes such that the error of the loss stays below `accuracy` of it, at the least
    /// cost. On the cells of a map, of which there are no coarser ones, an error is not known: the result is that of the plan's
    /// steps, and says so.
    pub(super) fn within_accuracy(&mut self, accuracy: f64) -> Result<Stabilised, CaseError> {
        /// Each refinement is predicted from the last one's error; where an error falls more slowly than predicted, it takes more.
        const ROUNDS: usize = 8;
        self.contact.cycle.error_bars = true;
        if self.has_own_cells()? {
            return self.at_resolution();
        }
        // The nodes where it begins, and the steps and nodes beyond which an accuracy counts as out of reach.
        let (nodes, finest) = match self.engine() {
            EngineKind::Axisymmetric => (64, (20_000, 6_400)),
            EngineKind::HalfSpace => (64, (4_000, 1_024)),
        };
        self.effort.at.nodes = nodes;
        let finest = (finest.0.max(self.effort.at.steps), finest.1);
        let (mut last, mut failure) = (None, None);
        for _ in 0..ROUNDS {
            let found = match self.at_resolution() {
                Ok(solved) => Some(solved),
                Err(error) if error.may_be_of_the_resolution() => {
                    failure = Some(error.to_string());
                    None
                }
                Err(error) => return Err(error),
            };
            let loss_and_bar = found
                .as_ref()
                .and_then(|found| loss_and_bar(found.result.as_ref()?));
            if let Some(found) = &found {
                failure = found.message.clone().filter(|_| loss_and_bar.is_none());
            }
            last = found.or(last);
            let at = self.effort.at;
            let (steps, nodes) = match loss_and_bar {
                // No result, or no error of it.
                None => (2 * at.steps, 2 * at.nodes),
                Some((loss_j, bar)) => {
                    let allowed_j = accuracy * loss_j.abs();
                    if bar.total() <= allowed_j
                        && let Some(reached) = last.take()
                    {
                        return Ok(reached);
                    }
                    if bar.material > allowed_j {
                        failure =
                            Some(self.open_by_material(bar.material / loss_j.abs(), accuracy));
                        break;
                    }
                    // Half of what is allowed for each, of which material and distance to the stabilised cycle take their part from
                    // both.
                    let left_j = allowed_j - bar.steady - bar.material;
                    let share_j = (0.5 * left_j).max(0.1 * allowed_j);
                    (
                        finer(at.steps, bar.steps, share_j),
                        finer(at.nodes, bar.nodes, share_j),
                    )
                }
            };
            if steps > finest.0 || nodes > finest.1 {
                break;
            }
            self.effort.at = Resolution { steps, nodes };
        }
        Ok(self.out_of_reach(last, failure, accuracy))
    }

    /// What becomes of a case whose last solution, if there is any, has not the accuracy asked for: it has no result.
    fn out_of_reach(
        &self,
        last: Option<Stabilised>,
        failure: Option<String>,
        accuracy: f64,
    ) -> Stabilised {
        let Resolution { steps, nodes } = self.effort.at;
        let mut last = last.unwrap_or_else(|| Stabilised::none(self.contact.cycle.method));
        let reached = last.result.take().as_ref().and_then(loss_and_bar);
        let reached = reached.map_or(f64::INFINITY, |(loss_j, bar)| (bar.total() / loss_j).abs());
        let why = failure.unwrap_or_else(|| {
            format!(
                "the error of the loss is {reached:.1e} of it at {steps} steps and {nodes} nodes, above the accuracy {accuracy:.1e}"
            )
        });
        last.message = Some(why);
        last
    }

    /// Why no resolution reaches the accuracy: the material alone leaves this share of the loss open.
    fn open_by_material(&self, share: f64, accuracy: f64) -> String {
        let advice = match self
            .contact
            .condition
            .contact
            .material
            .origin
            .approximation
            .as_ref()
        {
            Some(_) => "; write a smaller `accuracy` in [material.fractional]",
            None => "",
        };
        format!(
            "the material alone leaves {share:.1e} of the loss open, above the accuracy {accuracy:.1e}, at any number of steps and nodes{advice}"
        )
    }
}

/// The resolution at which a case is predicted to have this accuracy, from its record on a coarser one; that one where it has it already,
/// `None` where it has no result.
pub(crate) fn next_resolution(record: &CaseRecord, accuracy: f64) -> Option<Resolution> {
    let (loss_j, bar) = loss_and_bar(record.result.as_ref()?)?;
    let share_j = 0.5 * accuracy * loss_j.abs();
    Some(Resolution {
        steps: finer(record.steps, bar.steps, share_j),
        nodes: finer(record.nodes, bar.nodes, share_j),
    })
}

/// The loss (J) of a result and its bar, where it has both.
fn loss_and_bar(result: &CaseResult) -> Option<(f64, Bar)> {
    let bar = result.errors.as_ref()?.bar(Quantity::EnergyLoss)?;
    Some((result.analysis.energy_loss_j, bar))
}

/// Nodes or steps that bring an error of second order down to what is allowed, with a little to spare; divisible by four, as
/// coarser ones are halves and quarters.
fn finer(now: usize, error: f64, allowed: f64) -> usize {
    const SPARE: f64 = 1.1;
    /// One prediction is not trusted further than this.
    const LARGEST: f64 = 8.0;
    let factor = SPARE * (error / allowed).sqrt();
    if factor <= 1.0 {
        return now;
    }
    4 * (now as f64 * factor.min(LARGEST) / 4.0).ceil() as usize
}
