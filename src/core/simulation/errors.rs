//! Error columns of a history: the same history with fewer steps and on fewer nodes tells, row by row, how wrong each may be.
//!
//! As in [`error_bars`](crate::sweep::record::error_bars), steps and nodes are coarsened apart, twice each, and their errors add up.
//! Levels leave steps out, so that their rows are rows of the history; those between take the difference of the rows around
//! them. As time goes by, a difference passes through zero where its sign changes, while the edge of contact wanders from node to
//! node for one, and says nothing of the error there. So every row takes the largest difference of the rows around it that no
//! jump of the drive parts from it; the work, whose difference stays where it was for as long as nothing more is done, the largest of
//! all rows before.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use crate::drive::Fineness;
use crate::engine::{EngineKind, SolverPlan};
use crate::simulation::HistoryRow;
use crate::sweep::record::error_bars::{Pair, ROUNDING, Refinements, SAFETY};

/// Estimated errors of a row, absolute; `None` where the value is undefined or the estimate is missing.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct RowErrors {
    pub load_n: Option<f64>,
    pub approach_m: Option<f64>,
    pub contact_radius_m: Option<f64>,
    pub peak_pressure_pa: Option<f64>,
    pub work_j: Option<f64>,
}

/// What tells the errors of a history, which is the first of the resolutions.
pub(super) struct Plan {
    /// How fine the steps are, and springs, or cells along the longer side.
    pub(super) resolutions: Vec<(Fineness, usize)>,
    /// In steps, and in nodes, by places among the resolutions.
    refinements: [Refinements<usize>; 2],
    node_orders: [(f64, f64); 5],
}

/// Nodes of each level over those of the next finer one. By measurement (300 random histories on springs, 3 seeds): of 0.5, 0.62,
/// 0.7 and 0.77 the one with the most rows inside, 99.4 % and more of every column. Where the contact rests, its edge stays at one
/// place between two nodes for good, and two levels may share that place: at 0.62 a tenth of the loads were outside.
const NODES: f64 = 0.7;

/// Fewer tell nothing.
const LEAST_NODES: usize = 6;

/// The nodes of the plan, and those of the two coarser levels; `None` where they are too few.
pub(super) fn coarser_nodes(solver: &SolverPlan) -> Option<[usize; 3]> {
    // An even number of cells keeps the symmetry of a quarter.
    let step = match solver.engine {
        EngineKind::Axisymmetric => 1,
        EngineKind::HalfSpace => 2,
    };
    let nodes = solver.nodes();
    let part = |part: f64| (part * nodes as f64 / step as f64).round() as usize * step;
    let [fewer, least] = [part(NODES), part(NODES * NODES)];
    (LEAST_NODES <= least && least < fewer && fewer < nodes).then_some([nodes, fewer, least])
}

/// Rows before and after a row that lend it their differences.
const AROUND: usize = 8;

/// A value of a row.
type Value = fn(&HistoryRow) -> Option<f64>;

/// In the order of [`RowErrors`].
const VALUES: [Value; 5] = [
    |row| Some(row.load_n),
    |row| row.approach_m,
    |row| Some(row.contact_radius_m),
    |row| row.peak_pressure_pa,
    |row| row.work_j,
];

/// Which of them adds up over time.
const WORK: usize = 4;

/// The lowest and the highest order that are believed: in the steps, and in the nodes for each value. Load, approach and
/// work of cells are off by the edge of contact between two of them, where the pressure goes with the square root of the distance.
const STEP_ORDERS: (f64, f64) = (1.0, 2.0);
const SPRING_ORDERS: [(f64, f64); 5] = [(1.0, 2.0), (1.0, 2.0), (0.3, 1.0), (0.3, 1.0), (1.0, 2.0)];
const CELL_ORDERS: [(f64, f64); 5] = [(1.0, 1.5), (1.0, 1.5), (0.3, 1.0), (0.3, 1.0), (1.0, 1.5)];

/// What a resolution came to: its rows, and the row of the history that each is.
pub(super) struct Followed<'a> {
    pub(super) rows: &'a [HistoryRow],
    pub(super) in_full: &'a [Option<usize>],
}

impl Plan {
    /// `can_be_coarser`: whether there are steps to leave out; otherwise they are halved instead.
    pub(super) fn new(can_be_coarser: bool, engine: EngineKind, nodes: [usize; 3]) -> Self {
        let [all, fewer, least] = nodes;
        let full = Fineness::FULL;
        let pair = |finer, coarser, ratio| Pair {
            finer,
            coarser,
            ratio,
        };
        let in_nodes = |places: [usize; 3]| Refinements {
            first: pair(places[0], places[1], all as f64 / fewer as f64),
            second: Some(pair(places[1], places[2], fewer as f64 / least as f64)),
        };
        let (resolutions, refinements) = if can_be_coarser {
            let (half, quarter) = (Fineness::EveryNth(2), Fineness::EveryNth(4));
            let resolutions = vec![
                (full, all),
                (half, all),
                (quarter, all),
                (half, fewer),
                (half, least),
            ];
            let in_steps = Refinements {
                first: pair(0, 1, 2.0),
                second: Some(pair(1, 2, 2.0)),
            };
            // What nodes do to half the steps is what they do to all of them, at half the cost.
            (resolutions, [in_steps, in_nodes([1, 3, 4])])
        } else {
            let resolutions = vec![
                (full, all),
                (Fineness::Split(2), all),
                (full, fewer),
                (full, least),
            ];
            // The history is the coarser of the two. At the lowest order its error is twice the difference, as that of the finer one of a
            // pair with this ratio.
            let in_steps = Refinements {
                first: pair(1, 0, 1.5),
                second: None,
            };
            (resolutions, [in_steps, in_nodes([0, 2, 3])])
        };
        Self {
            resolutions,
            refinements,
            node_orders: match engine {
                EngineKind::Axisymmetric => SPRING_ORDERS,
                EngineKind::HalfSpace => CELL_ORDERS,
            },
        }
    }

    /// The error of a value of the history, from the difference that each pair of levels makes to it; `None` without those of the finer
    /// pairs.
    fn error(
        &self,
        value: f64,
        node_orders: (f64, f64),
        difference: impl Fn(&Pair<usize>) -> Option<f64>,
    ) -> Option<f64> {
        let of = |refinement: &Refinements<usize>, orders| {
            let second = refinement.second.as_ref().and_then(&difference);
            Some(refinement.error(difference(&refinement.first)?, second, orders))
        };
        let [in_steps, in_nodes] = &self.refinements;
        let (steps, nodes) = (of(in_steps, STEP_ORDERS)?, of(in_nodes, node_orders)?);
        Some(SAFETY * (steps + nodes) + ROUNDING * value.abs())
    }

    /// The error of a number that the history gives as a whole, from what every resolution gives for it; `None` where one of them has
    /// none.
    pub(super) fn error_of_whole(&self, values: &[Option<f64>]) -> Option<f64> {
        let at = |level: usize| values.get(level).copied().flatten();
        self.error(at(0)?, self.node_orders[1], |pair| {
            Some((at(pair.finer)? - at(pair.coarser)?).abs())
        })
    }

    /// Errors of every row of the history, the first of the resolutions.
    pub(super) fn errors(&self, followed: &[Followed<'_>]) -> Vec<RowErrors> {
        let Some(history) = followed.first() else {
            return Vec::new();
        };
        let stretches = stretches(history.rows);
        let columns = [0, 1, 2, 3, 4].map(|column| {
            let value = VALUES[column];
            let pairs = self.refinements.iter();
            let pairs =
                pairs.flat_map(|refinement| [Some(&refinement.first), refinement.second.as_ref()]);
            let known = pairs.flatten().map(|pair| {
                let levels = [followed.get(pair.finer), followed.get(pair.coarser)];
                let differences = differences(levels, value, history.rows.len());
                let spread = spread(&differences, &stretches);
                let told = if column == WORK {
                    so_far(spread)
                } else {
                    spread
                };
                ((pair.finer, pair.coarser), told)
            });
            let known: HashMap<_, _> = known.collect();
            let error = |(row, values): (usize, &HistoryRow)| {
                self.error(value(values)?, self.node_orders[column], |pair| {
                    known.get(&(pair.finer, pair.coarser))?[row]
                })
            };
            history
                .rows
                .iter()
                .enumerate()
                .map(error)
                .collect::<Vec<_>>()
        });
        let row = |row: usize| {
            let [
                load_n,
                approach_m,
                contact_radius_m,
                peak_pressure_pa,
                work_j,
            ] = columns.each_ref().map(|column| column[row]);
            RowErrors {
                load_n,
                approach_m,
                contact_radius_m,
                peak_pressure_pa,
                work_j,
            }
        };
        (0..history.rows.len()).map(row).collect()
    }
}

/// The difference of a value between two resolutions at each row of the history that is one of both.
fn differences(
    [finer, coarser]: [Option<&Followed<'_>>; 2],
    value: Value,
    rows: usize,
) -> Vec<Option<f64>> {
    let at = |followed: Option<&Followed<'_>>| {
        let mut values = vec![None; rows];
        let rows = followed.map(|followed| followed.rows.iter().zip(followed.in_full));
        for (row, place) in rows.into_iter().flatten() {
            if let Some(slot) = place.and_then(|place| values.get_mut(place)) {
                *slot = value(row);
            }
        }
        values
    };
    let pairs = at(finer).into_iter().zip(at(coarser));
    pairs.map(|(a, b)| Some((a? - b?).abs())).collect()
}

/// For each row the first of its stretch between two jumps, and the one beyond its last.
fn stretches(rows: &[HistoryRow]) -> Vec<(usize, usize)> {
    let is_jump = |a: &HistoryRow, b: &HistoryRow| a.time_s == b.time_s;
    let mut stretches = Vec::with_capacity(rows.len());
    for stretch in rows.chunk_by(|a, b| !is_jump(a, b)) {
        let first = stretches.len();
        stretches.extend(stretch.iter().map(|_| (first, first + stretch.len())));
    }
    stretches
}

/// The largest of what is known around each row; where nothing is known that near, of what is known next before and after, and
/// nothing beyond the end of a resolution that did not come as far.
fn spread(known: &[Option<f64>], stretches: &[(usize, usize)]) -> Vec<Option<f64>> {
    let at = |(row, &(first, end)): (usize, &(usize, usize))| {
        let near = row.saturating_sub(AROUND).max(first)..(row + AROUND + 1).min(end);
        let largest = known[near].iter().flatten().copied().reduce(f64::max);
        largest.or_else(|| {
            let before = known[first..row].iter().rev().flatten().next();
            let after = known[row..end].iter().flatten().next();
            before.zip(after).map(|(a, b)| a.max(*b))
        })
    };
    stretches.iter().enumerate().map(at).collect()
}

/// The largest of what is known up to each row.
fn so_far(known: Vec<Option<f64>>) -> Vec<Option<f64>> {
    let mut largest = 0.0_f64;
    let of = |known: Option<f64>| {
        largest = largest.max(known?);
        Some(largest)
    };
    known.into_iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(time_s: f64, contact_radius_m: f64) -> HistoryRow {
        HistoryRow {
            time_s,
            load_n: 1.0,
            approach_m: None,
            contact_radius_m,
            peak_pressure_pa: None,
            work_j: None,
        }
    }

    /// Errors of a history that is off by `steps` t h^2 on steps of h, and by `nodes` / n on n nodes.
    fn errors(steps: f64, nodes: f64) -> Vec<RowErrors> {
        let plan = Plan::new(true, EngineKind::Axisymmetric, [400, 200, 100]);
        let all: Vec<_> = (plan.resolutions.iter())
            .map(|(fineness, on)| {
                let Fineness::EveryNth(n) = *fineness else {
                    panic!("steps are left out")
                };
                let in_full: Vec<usize> = (0..=16).step_by(n).collect();
                let error = |t: f64| steps * t * (n * n) as f64 + nodes * 400.0 / *on as f64;
                let at = |&k: &usize| row(k as f64, 10.0 + error(k as f64));
                let rows: Vec<_> = in_full.iter().map(at).collect();
                (rows, in_full.into_iter().map(Some).collect::<Vec<_>>())
            })
            .collect();
        let followed = all.iter().map(|(rows, in_full)| Followed { rows, in_full });
        plan.errors(&followed.collect::<Vec<_>>())
    }

    #[test]
    fn errors_of_second_order_in_steps_and_of_first_in_nodes_are_told_up_to_the_safety_factor() {
        let found = errors(0.0, 1e-3);
        // Rounding of the value itself, 1e-12 of ten.
        let told = |row: &RowErrors| row.contact_radius_m.unwrap();
        assert!(
            found
                .iter()
                .all(|row| (told(row) / 1.5e-3 - 1.0).abs() < 1e-6)
        );
        // The largest around: at the last row, that of the row itself. Elsewhere the coarser difference may be that of a row nearer
        // by up to a quarter, and the order seem the lower for it.
        let found = errors(1e-4, 0.0);
        assert!((told(&found[16]) / (1.5 * 16e-4) - 1.0).abs() < 1e-6);
        let own = |row: usize| 1e-4 * row as f64;
        let around = |row: usize| own((row + AROUND).min(16));
        let bounds = |(row, errors)| (own(row)..2.1 * around(row)).contains(&told(errors));
        assert!(found.iter().enumerate().all(bounds), "{found:?}");
        assert!(found.iter().all(|row| row.approach_m.is_none()));
        assert_eq!(found[3].load_n, Some(1e-12));
    }

    #[test]
    fn rows_on_either_side_of_a_jump_do_not_share_their_errors() {
        let rows = [row(0.0, 1.0), row(1.0, 1.0), row(1.0, 1.0), row(2.0, 1.0)];
        let stretches = stretches(&rows);
        assert_eq!(stretches, [(0, 2), (0, 2), (2, 4), (2, 4)]);
        let known = [Some(1.0), None, None, Some(5.0)];
        let found = spread(&known, &stretches);
        assert_eq!(found, [Some(1.0), Some(1.0), Some(5.0), Some(5.0)]);
    }

    #[test]
    fn nothing_is_told_beyond_the_end_of_a_resolution_that_ended_early() {
        let mut known = [&[Some(2.0); 3][..], &[None; 30][..]].concat();
        assert_eq!(spread(&known, &[(0, 33); 33])[20], None);
        known[32] = Some(3.0);
        assert_eq!(spread(&known, &[(0, 33); 33])[20], Some(3.0));
    }
}
