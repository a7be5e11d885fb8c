//! A case at its resolution, and at coarser ones that tell its errors: in steps on the same nodes, and on fewer nodes.

use std::sync::Arc;

use crate::contact::{ContactError, Engine};
use crate::history::{Work, order_of_steps};
use crate::sweep::case::edge_layer::EdgeLayer;
use crate::sweep::case::lift_off;
use crate::sweep::case::stabilise::{CaseError, Contact, Stabilised, Wanted};
use crate::sweep::case::{Setup, SetupError};
use crate::sweep::engine::MAX_GROWTHS;
use crate::sweep::plan::{EngineKind, instant_tolerance};
use crate::sweep::record::error_bars::{Edge, ErrorBars, InNodes, Ladder, Pair, Quantity};
use crate::sweep::record::{CaseRecord, CaseResult, Status};

/// Fewest steps and nodes that a coarser resolution may have: below, a cycle has no shape, and its error says nothing.
const FEWEST_STEPS: usize = 8;
const FEWEST_NODES: usize = 12;

/// A case under way, and its record so far.
pub(super) struct Levels<'a> {
    pub setup: &'a Setup,
    pub contact: Contact<'a>,
    pub record: &'a mut CaseRecord,
}

/// Results on one number of nodes, by the number of steps: the finest last.
pub(super) struct Solved {
    nodes: usize,
    cycles: Vec<(usize, Stabilised)>,
}

impl Levels<'_> {
    pub fn engine(&self) -> EngineKind {
        self.setup.plan.solver.engine
    }

    /// Solves at the record's own resolution, and at coarser ones where error bars are wanted.
    pub fn at_resolution(&mut self) -> Result<(), CaseError> {
        let (fine, nodes) = (self.record.steps, self.record.nodes);
        let bars = self.contact.cycle.error_bars && self.can_be_coarsened()?;
        // From coarse to fine: each number of steps starts the next from its memory.
        let steps = match (bars, self.engine()) {
            (false, _) => vec![fine],
            (true, EngineKind::Axisymmetric) => vec![fine / 4, fine / 2, fine],
            (true, EngineKind::HalfSpace) => vec![fine / 2, fine],
        };
        let mut domain = (0.0, 0);
        let solved = self.solve(&self.contact, nodes, &steps, &mut domain);
        (self.record.domain_half_width_m, self.record.domain_enlarged) = domain;
        let mut solved = solved?;
        self.record.take(&mut solved, self.contact.cycle.at_cycle);
        if self.record.result.is_none() || !bars {
            return Ok(());
        }
        let errors = self.error_bars(&mut solved)?;
        if errors.is_none() {
            self.note(|| "no error bars: no coarser resolution stabilised, or the contact is shorter than two time steps".to_owned());
        }
        if let Some(result) = &mut self.record.result {
            result.errors = errors;
        }
        Ok(())
    }

    /// Adds what a reader should know, where nothing else is said.
    pub fn note(&mut self, message: impl FnOnce() -> String) {
        self.record.message.get_or_insert_with(message);
    }

    /// Error bars of a record's result, from what is coarser in steps on the same nodes and coarser in nodes at the same steps.
    /// Where a coarser resolution does not stabilise, one between it and the result takes its place; the order of the error is then
    /// not seen, and the lowest believed is taken. `None` where that fails too.
    fn error_bars(&mut self, solved: &mut Solved) -> Result<Option<ErrorBars>, CaseError> {
        let contact = self.contact;
        let (steps, nodes) = (self.record.steps, self.record.nodes);
        let between = |fine: usize| 4 * (3 * fine / 16).max(1);
        let mut middle = steps / 2;
        if solved.result(middle).is_none() {
            middle = between(steps);
            let more = self.coarser(&contact, nodes, &[middle])?;
            solved.cycles.extend(more.cycles);
        }
        if solved.result(middle).is_none() {
            return Ok(None);
        }
        // On cells, ratios that put the edge of the contact elsewhere between two of them each time; springs end where the edge
        // turns, whatever their number.
        let [half, quarter] = match self.engine() {
            EngineKind::Axisymmetric => [nodes / 2, nodes / 4],
            EngineKind::HalfSpace => [5 * nodes / 9, 3 * nodes / 10],
        };
        // As many steps as the difference between the two needs, and those that tell the order in the steps where the full number
        // of nodes is too dear for it.
        let on_half = match self.engine() {
            EngineKind::HalfSpace if middle == steps / 2 => &[steps / 4, middle][..],
            _ => &[middle],
        };
        let mut on_half = self.coarser(&contact, half, on_half)?;
        if on_half.result(middle).is_none() {
            on_half = self.coarser(&contact, between(nodes), &[middle])?;
        }
        let on_quarter = match quarter >= FEWEST_NODES && on_half.nodes == half {
            true => Some(self.coarser(&contact, quarter, &[middle])?),
            false => None,
        };
        let mut others = Vec::new();
        let omega = contact.angular_frequency_rad_per_s;
        let control = contact.condition.drive.control();
        for compliance in contact.solid.farthest_alternatives(omega, control) {
            let with_other = Contact {
                compliance,
                // Checkpoints are of the material itself.
                checkpoints: None,
                ..contact
            };
            others.push(self.coarser(&with_other, on_half.nodes, &[middle])?);
        }
        let missing = others.iter().filter(|other| other.result(middle).is_none());
        let (missing, all) = (missing.count(), others.len());
        if missing > 0 {
            self.note(|| {
                format!(
                    "the error bars leave out {missing} of the {all} materials that fit the data as well: no stabilised cycle was found with them"
                )
            });
        }
        Ok(self.bars(middle, [solved, &on_half], on_quarter.as_ref(), &others))
    }

    /// Error bars of the record's result, from results on all, half and a quarter of its nodes, in a middle number of steps, and from
    /// those of other materials on half of them. `None` where one of the first two has no result, or the contact is too short.
    fn bars(
        &self,
        middle: usize,
        [all, half]: [&Solved; 2],
        quarter: Option<&Solved>,
        others: &[Solved],
    ) -> Option<ErrorBars> {
        let (contact, record) = (&self.contact, &self.record);
        let result = record.result.as_ref()?;
        let (on_all, on_half) = (all.result(middle)?, half.result(middle)?);
        let pair = |finer, coarser, fine: usize, coarse: usize| Pair {
            finer,
            coarser,
            ratio: fine as f64 / coarse as f64,
        };
        // Where the fewest steps were not taken on all nodes, they were on half of them.
        let coarsest = record.steps / 4;
        let second = [all, half].into_iter().find_map(|on| {
            let (finer, coarser) = (on.result(middle)?, on.result(coarsest)?);
            Some(pair(finer, coarser, middle, coarsest))
        });
        let in_steps = Ladder {
            first: pair(result, on_all, record.steps, middle),
            second: second.filter(|_| middle == record.steps / 2),
        };
        let on_quarter = quarter.and_then(|on| Some((on.result(middle)?, on.nodes)));
        let in_nodes = Ladder {
            first: pair(on_all, on_half, all.nodes, half.nodes),
            second: on_quarter.map(|(result, nodes)| pair(on_half, result, half.nodes, nodes)),
        };
        let others = others.iter().filter_map(|other| other.result(middle));
        let others: Vec<_> = others.map(|other| (on_half, other)).collect();
        // How far a cycle is from the stabilised one is an error of that one alone.
        let of_stabilised = contact.cycle.at_cycle.is_none();
        let distance = record.steady_distance.filter(|_| of_stabilised);
        let distance = distance.unwrap_or(0.0);
        let of_instants = instant_tolerance::SHARE * contact.cycle.tolerance;
        let (distance, believed) = match self.engine() {
            EngineKind::Axisymmetric => (distance, InNodes::SPRINGS),
            EngineKind::HalfSpace => {
                let cell_m = 2.0 * record.domain_half_width_m / record.nodes as f64;
                let condition = contact.condition;
                let (indenter, on_layer) = (
                    condition.contact.indenter.as_ref(),
                    condition.contact.layer.is_some(),
                );
                let radius_m = result.contact_radius_m.maximum;
                let edge = Edge::of(indenter, on_layer, radius_m, cell_m);
                (distance + of_instants, InNodes::cells(cell_m, edge))
            }
        };
        let bars = ErrorBars::estimate(
            result,
            (&in_steps, order_of_steps(&contact.solid.compliance)),
            (&in_nodes, believed),
            distance,
            &others,
        );
        let drive = &contact.condition.drive;
        let bars = lift_off::widened(bars, (result, record.steps), drive, of_stabilised)?;
        let indenter = contact.condition.contact.indenter.as_ref();
        let relaxation = contact.solid.relaxation.as_ref();
        let layer = relaxation.and_then(|relaxation| EdgeLayer::new(indenter, relaxation));
        Some(match layer {
            Some(layer) => bars.wider(Quantity::PeakPressureMax, layer.higher_peak_pa(result)),
            None => bars,
        })
    }

    /// A coarser resolution, whose work the record counts; without a result where it fails.
    pub fn coarser(
        &mut self,
        contact: &Contact<'_>,
        nodes: usize,
        steps: &[usize],
    ) -> Result<Solved, CaseError> {
        let contact = Contact {
            wanted: contact.wanted.min(Wanted::Numbers),
            ..*contact
        };
        let solved = match self.solve(&contact, nodes, steps, &mut (0.0, 0)) {
            Err(CaseError::Contact(ContactError::Interrupted)) => {
                return Err(ContactError::Interrupted.into());
            }
            Err(_) => Solved {
                nodes,
                cycles: Vec::new(),
            },
            Ok(solved) => solved,
        };
        self.record.work += solved.work();
        Ok(solved)
    }

    /// Whether a coarser resolution exists and means the same contact: an indenter on its own cells has no coarser one.
    fn can_be_coarsened(&self) -> Result<bool, SetupError> {
        Ok(self.record.steps / 4 >= FEWEST_STEPS
            && self.record.nodes / 2 >= FEWEST_NODES
            && !self.has_own_cells()?)
    }

    /// Whether the cells are those of the indenter.
    pub fn has_own_cells(&self) -> Result<bool, SetupError> {
        let engines = (self.setup).engines(self.contact.condition, self.record.nodes)?;
        Ok(engines.has_cells_of_its_own())
    }

    /// The case on so many nodes, in each of the numbers of steps, every one started from the memory of the last, on ever larger
    /// domains as long as the contact reaches the edge. Only the last number of steps has to succeed. `domain` is told the half width (m)
    /// last tried, and how often it was enlarged.
    fn solve(
        &self,
        contact: &Contact<'_>,
        nodes: usize,
        steps: &[usize],
        domain: &mut (f64, usize),
    ) -> Result<Solved, CaseError> {
        let engines = self.setup.engines_of_case(contact, nodes)?;
        let mut growths = 0;
        loop {
            let mut engine = engines.engine(growths)?;
            *domain = (engines.enlarged_half_width_m(growths).0, growths);
            match self.on_engine(contact, engine.as_mut(), steps) {
                Err(error @ CaseError::Contact(ContactError::ReachedEdge { .. })) => {
                    match engines.not_enlarged(growths) {
                        Some(why) => return Err(why.into()),
                        None if growths < MAX_GROWTHS => growths += 1,
                        None => return Err(error),
                    }
                }
                ended => return ended.map(|cycles| Solved { nodes, cycles }),
            }
        }
    }

    /// The same on one engine, whose instants are solved more tightly where that alone finds the cycle.
    fn on_engine(
        &self,
        contact: &Contact<'_>,
        engine: &mut dyn Engine,
        steps: &[usize],
    ) -> Result<Vec<(usize, Stabilised)>, CaseError> {
        if let Some(flag) = &self.setup.interrupt {
            engine.interrupted_by(Arc::clone(flag));
        }
        let needed = self.setup.instant_tolerance(
            &contact.solid.compliance,
            &contact.condition.drive,
            contact.angular_frequency_rad_per_s,
            contact.cycle.tolerance,
        );
        engine.tolerate(needed);
        if self.engine() == EngineKind::HalfSpace
            && self.setup.plan.solver.tolerance.is_none()
            && let Some(tighter) = instant_tolerance::tighter(needed)
        {
            match contact.searching_alone().in_steps(engine, steps) {
                Ok(found)
                    if found.len() == steps.len()
                        && found.iter().all(|(_, cycle)| cycle.result.is_some()) =>
                {
                    return Ok(found);
                }
                Ok(_) => engine.tolerate(tighter),
                // No tolerance of the cycle's will do: it is marched as it is.
                Err(CaseError::Contact(ContactError::NotConverged { .. })) => {}
                Err(error) => return Err(error),
            }
        }
        contact.in_steps(engine, steps)
    }
}

impl Solved {
    /// The result in so many steps.
    pub fn result(&self, steps: usize) -> Option<&CaseResult> {
        let (_, cycle) = self.cycles.iter().find(|(s, _)| *s == steps)?;
        cycle.result.as_ref()
    }

    fn work(&self) -> Work {
        let mut work = Work::default();
        for (_, cycle) in &self.cycles {
            work += cycle.work;
        }
        work
    }
}

impl CaseRecord {
    /// Takes over what was found in the most steps; leaves the coarser results where they are.
    fn take(&mut self, solved: &mut Solved, at_cycle: Option<usize>) {
        self.work = solved.work();
        let Some((_, finest)) = solved.cycles.last_mut() else {
            return;
        };
        self.method = finest.method;
        self.cycles = finest.cycles;
        self.steady_distance = finest.distance;
        self.message = finest.message.take();
        self.result = finest.result.take();
        self.status = match (&self.result, at_cycle) {
            (Some(_), None) => Status::Converged,
            (Some(_), Some(_)) => Status::Transient,
            (None, _) => Status::NotConverged,
        };
    }
}
