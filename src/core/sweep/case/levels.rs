//! A case at its resolution, and at coarser ones that tell its errors: in steps on the same nodes, and on fewer nodes.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

use crate::adhesive::Layout;
use crate::adhesive::cycle::State;
use crate::contact::{ContactError, Engine};
use crate::engine::MAX_GROWTHS;
use crate::engine::{EngineKind, instant_tolerance};
use crate::history::{Work, order_of_steps};
use crate::sweep::case::edge_layer::EdgeLayer;
use crate::sweep::case::lift_off;
use crate::sweep::case::stabilise::{CaseError, Contact, InSteps, Stabilised, Wanted, start_of};
use crate::sweep::case::{Resolution, Setup, SetupError};
use crate::sweep::record::CaseResult;
use crate::sweep::record::error_bars::{Edge, ErrorBars, InNodes, Pair, Quantity, Refinements};

/// Fewest steps and nodes that a coarser resolution may have: below, a cycle has no shape, and its error says nothing.
const FEWEST_STEPS: usize = 8;
const FEWEST_NODES: usize = 12;

/// The highest order in the steps that is believed of an edge which moves through attracted springs.
const ORDER_ATTRACTED: f64 = 1.5;

/// A case under way, and what it has taken so far.
pub(super) struct Levels<'a> {
    pub setup: &'a Setup,
    pub contact: Contact<'a>,
    pub effort: &'a mut Effort,
    /// Where the edges of an attracted contact go, and what its springs remembered last: other numbers of springs begin there.
    pub attracted: RefCell<Option<(Layout, State)>>,
    /// Memories of cycles found where an accuracy is asked for, by nodes and by how often their domain was enlarged: more steps begin
    /// there.
    pub found: RefCell<BTreeMap<(usize, usize), Vec<f64>>>,
}

/// What a case has taken so far, whatever becomes of it.
pub(super) struct Effort {
    /// The resolution of its result.
    pub at: Resolution,
    /// Half width (m) of the domain last tried for it, and how often that was enlarged.
    pub domain_half_width_m: f64,
    pub domain_enlarged: usize,
    /// Coarser levels included.
    pub work: Work,
}

impl Effort {
    /// Nothing solved yet at this resolution.
    pub fn at(at: Resolution) -> Self {
        Self {
            at,
            domain_half_width_m: 0.0,
            domain_enlarged: 0,
            work: Work::default(),
        }
    }
}

/// Stabilised cycles on one number of nodes: in the most steps, and in fewer.
pub(super) struct Level {
    nodes: usize,
    steps: usize,
    finest: Stabilised,
    coarser: Vec<(usize, Stabilised)>,
}

impl Levels<'_> {
    pub fn engine(&self) -> EngineKind {
        self.setup.plan.solver.engine
    }

    /// Solves at the resolution of the case, and at coarser ones where error bars are wanted.
    pub fn at_resolution(&mut self) -> Result<Stabilised, CaseError> {
        let Resolution { steps: fine, nodes } = self.effort.at;
        let bars = self.contact.cycle.error_bars && self.can_be_coarsened()?;
        // From coarse to fine: each number of steps starts the next from its memory.
        let steps = match (bars, self.engine()) {
            (false, _) => &[][..],
            (true, EngineKind::Axisymmetric) => &[fine / 4, fine / 2],
            (true, EngineKind::HalfSpace) => &[fine / 2],
        };
        let mut domain = (0.0, 0);
        let solved = self.solve(&self.contact, nodes, (steps, fine), &mut domain);
        (self.effort.domain_half_width_m, self.effort.domain_enlarged) = domain;
        let mut level = solved?;
        self.effort.work += level.work();
        let (errors, note) = match bars && level.finest.result.is_some() {
            true => self.error_bars(&mut level)?,
            false => (None, None),
        };
        let mut finest = level.finest;
        if let Some(result) = &mut finest.result {
            result.errors = errors;
        }
        finest.message = finest.message.or(note);
        Ok(finest)
    }

    /// Error bars of the result of a case, from what is coarser in steps on the same nodes and coarser in nodes at the same steps, and what a
    /// reader should know of them. Where a coarser resolution does not stabilise, one between it and the result takes its place; the
    /// order of the error is then not seen, and the lowest believed is taken. No bars where that fails too.
    fn error_bars(
        &mut self,
        all: &mut Level,
    ) -> Result<(Option<ErrorBars>, Option<String>), CaseError> {
        let contact = self.contact;
        let none = || {
            let why = "no error bars: no coarser resolution stabilised, or the contact is shorter than two time steps";
            Ok((None, Some(why.to_owned())))
        };
        let Resolution { steps, nodes } = self.effort.at;
        let between = |fine: usize| 4 * (3 * fine / 16).max(1);
        let mut middle = steps / 2;
        if all.result(middle).is_none() {
            middle = between(steps);
            let more = self.coarser(&contact, nodes, &[], middle)?;
            all.coarser.extend(more.map(|more| (middle, more.finest)));
        }
        if all.result(middle).is_none() {
            return none();
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
            EngineKind::HalfSpace if middle == steps / 2 => &[steps / 4][..],
            _ => &[],
        };
        let has_result = |level: &Level| level.finest.result.is_some();
        let on_half = self.coarser(&contact, half, on_half, middle)?;
        let on_half = match on_half.filter(has_result) {
            Some(level) => level,
            None => match self.coarser(&contact, between(nodes), &[], middle)? {
                Some(level) => level,
                None => return none(),
            },
        };
        let on_quarter = match quarter >= FEWEST_NODES && on_half.nodes == half {
            true => self.coarser(&contact, quarter, &[], middle)?,
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
            let other = self.coarser(&with_other, on_half.nodes, &[], middle)?;
            others.push(other.and_then(|other| other.finest.result));
        }
        let missing = others.iter().filter(|other| other.is_none()).count();
        let materials = others.len();
        let note = (missing > 0).then(|| {
            format!(
                "the error bars leave out {missing} of the {materials} materials that fit the data as well: no stabilised cycle was found \
                 with them"
            )
        });
        match self.bars(middle, [all, &on_half], on_quarter.as_ref(), &others) {
            Some(bars) => Ok((Some(bars), note)),
            None => none().map(|(bars, why)| (bars, note.or(why))),
        }
    }

    /// Error bars from results on all, half and a quarter of the nodes, in a middle number of steps, and from those of other materials on
    /// half of them. `None` where one of the first two has no result, or the contact is too short.
    fn bars(
        &self,
        middle: usize,
        [all, half]: [&Level; 2],
        quarter: Option<&Level>,
        others: &[Option<CaseResult>],
    ) -> Option<ErrorBars> {
        let (contact, at) = (&self.contact, self.effort.at);
        let result = all.result(at.steps)?;
        let (on_all, on_half) = (all.result(middle)?, half.result(middle)?);
        let pair = |finer, coarser, fine: usize, coarse: usize| Pair {
            finer,
            coarser,
            ratio: fine as f64 / coarse as f64,
        };
        // Where the fewest steps were not taken on all nodes, they were on half of them.
        let coarsest = at.steps / 4;
        let second = [all, half].into_iter().find_map(|on| {
            let (finer, coarser) = (on.result(middle)?, on.result(coarsest)?);
            Some(pair(finer, coarser, middle, coarsest))
        });
        let in_steps = Refinements {
            first: pair(result, on_all, at.steps, middle),
            second: second.filter(|_| middle == at.steps / 2),
        };
        let on_quarter = quarter.and_then(|on| Some((on.result(middle)?, on.nodes)));
        let in_nodes = Refinements {
            first: pair(on_all, on_half, all.nodes, half.nodes),
            second: on_quarter.map(|(result, nodes)| pair(on_half, result, half.nodes, nodes)),
        };
        let others = others.iter().flatten();
        let others: Vec<_> = others.map(|other| (on_half, other)).collect();
        // How far a cycle is from the stabilised one is an error of that one alone.
        let of_stabilised = contact.cycle.at_cycle.is_none();
        let distance = all.finest.distance.filter(|_| of_stabilised);
        let distance = distance.unwrap_or(0.0);
        let of_instants = instant_tolerance::SHARE * contact.cycle.tolerance;
        let attraction = contact.attraction();
        let (distance, believed) = match self.engine() {
            EngineKind::Axisymmetric if attraction.is_some() => {
                // A search that stands still is off by a few of its last changes.
                (3.0 * distance, InNodes::ATTRACTED)
            }
            EngineKind::Axisymmetric => (distance, InNodes::SPRINGS),
            EngineKind::HalfSpace => {
                let cell_m = 2.0 * self.effort.domain_half_width_m / at.nodes as f64;
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
        let order_in_steps = match attraction {
            Some(_) => ORDER_ATTRACTED,
            None => order_of_steps(&contact.solid.compliance),
        };
        let bars = ErrorBars::estimate(
            result,
            (&in_steps, order_in_steps),
            (&in_nodes, believed),
            distance,
            &others,
        );
        if let Some(cycle) = result.attracted() {
            return Some(cycle.widened(bars));
        }
        let drive = &contact.condition.drive;
        let bars = lift_off::widened(bars, (result, at.steps), drive, of_stabilised)?;
        let indenter = contact.condition.contact.indenter.as_ref();
        let relaxation = contact.solid.relaxation.as_ref();
        let layer = relaxation.and_then(|relaxation| EdgeLayer::new(indenter, relaxation));
        Some(match layer {
            Some(layer) => bars.wider(Quantity::PeakPressureMax, layer.higher_peak_pa(result)),
            None => bars,
        })
    }

    /// A coarser level, in the most steps and in fewer; `None` where it fails.
    pub fn coarser(
        &mut self,
        contact: &Contact<'_>,
        nodes: usize,
        fewer: &[usize],
        steps: usize,
    ) -> Result<Option<Level>, CaseError> {
        let contact = Contact {
            wanted: contact.wanted.min(Wanted::Numbers),
            ..*contact
        };
        match self.solve(&contact, nodes, (fewer, steps), &mut (0.0, 0)) {
            Err(CaseError::Contact(ContactError::Interrupted)) => {
                Err(ContactError::Interrupted.into())
            }
            Err(_) => Ok(None),
            Ok(level) => {
                self.effort.work += level.work();
                Ok(Some(level))
            }
        }
    }

    /// Whether a coarser resolution exists and means the same contact: an indenter on its own cells has no coarser one.
    fn can_be_coarsened(&self) -> Result<bool, SetupError> {
        Ok(self.effort.at.steps / 4 >= FEWEST_STEPS
            && self.effort.at.nodes / 2 >= FEWEST_NODES
            && !self.has_own_cells()?)
    }

    /// Whether the cells are those of the indenter.
    pub fn has_own_cells(&self) -> Result<bool, SetupError> {
        let engines = (self.setup).engines(self.contact.condition, self.effort.at.nodes)?;
        Ok(engines.has_cells_of_its_own())
    }

    /// The case on this number of nodes, in the most steps and before that in fewer, every one started from the memory of the last, on ever
    /// larger domains as long as the contact reaches the edge. Only the most steps have to succeed. `domain` becomes the half width (m)
    /// last tried, and how often it was enlarged.
    fn solve(
        &self,
        contact: &Contact<'_>,
        nodes: usize,
        (fewer, steps): (&[usize], usize),
        domain: &mut (f64, usize),
    ) -> Result<Level, CaseError> {
        let is_own = std::ptr::eq(contact.compliance, &raw const contact.solid.compliance);
        if let Some(attraction) = contact.attraction() {
            let before = is_own.then(|| self.attracted.take()).flatten();
            let (level, left) = contact.attracted(attraction, nodes, (fewer, steps), before)?;
            if is_own {
                self.attracted.replace(left);
            }
            return Ok(level);
        }
        let engines = self.setup.engines_of_case(contact, nodes)?;
        let mut growths = 0;
        loop {
            let mut engine = engines.engine(growths)?;
            *domain = (engines.enlarged_half_width_m(growths).0, growths);
            let known = || self.found.borrow_mut().remove(&(nodes, growths));
            let before = is_own.then(known).flatten();
            match self.on_engine(contact, engine.as_mut(), (fewer, steps), before.as_deref()) {
                Err(error @ CaseError::Contact(ContactError::ReachedEdge { .. })) => {
                    match engines.not_enlarged(growths) {
                        Some(why) => return Err(why.into()),
                        None if growths < MAX_GROWTHS => growths += 1,
                        None => return Err(error),
                    }
                }
                ended => {
                    let (coarser, finest) = ended?;
                    if is_own && contact.cycle.accuracy.is_some() && finest.result.is_some() {
                        let memory = finest.memory.clone();
                        self.found.borrow_mut().insert((nodes, growths), memory);
                    }
                    return Ok(Level::new(nodes, (steps, finest), coarser));
                }
            }
        }
    }

    /// The same on one engine, whose instants are solved more tightly where that alone finds the cycle.
    fn on_engine(
        &self,
        contact: &Contact<'_>,
        engine: &mut dyn Engine,
        (fewer, steps): (&[usize], usize),
        before: Option<&[f64]>,
    ) -> Result<InSteps, CaseError> {
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
            match contact.by_search_alone(engine, (fewer, steps), before) {
                Ok(Some(found)) => return Ok(found),
                Ok(None) => engine.tolerate(tighter),
                // No tolerance of the cycle's will do: it is marched as it is.
                Err(CaseError::Contact(ContactError::NotConverged { .. })) => {}
                Err(error) => return Err(error),
            }
        }
        let coarser = contact.in_fewer_steps(engine, fewer, before)?;
        let finest = contact.stabilise(engine, steps, start_of(&coarser, before))?;
        Ok((coarser, finest))
    }
}

impl Level {
    /// Cycles on this many nodes, that in the most steps and those in fewer.
    pub(super) fn new(
        nodes: usize,
        (steps, finest): (usize, Stabilised),
        coarser: Vec<(usize, Stabilised)>,
    ) -> Self {
        Self {
            nodes,
            steps,
            finest,
            coarser,
        }
    }

    /// The result in this number of steps.
    fn result(&self, steps: usize) -> Option<&CaseResult> {
        if steps == self.steps {
            return self.finest.result.as_ref();
        }
        let (_, cycle) = self.coarser.iter().find(|(count, _)| *count == steps)?;
        cycle.result.as_ref()
    }

    /// The loss (J) in the most steps.
    pub fn loss_j(&self) -> Option<f64> {
        let result = self.finest.result.as_ref()?;
        Some(result.analysis.energy_loss_j)
    }

    fn work(&self) -> Work {
        let coarser = self.coarser.iter().map(|(_, cycle)| cycle.work);
        let mut work = self.finest.work;
        coarser.for_each(|of_cycle| work += of_cycle);
        work
    }
}
