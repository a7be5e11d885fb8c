//! The loss of a case with each replica of its material: what the noise of the data, carried through the fit, makes of it.
//!
//! A loss is wanted to within the scatter of the replicas alone, a few per cent of it, and the error of a coarse cycle is nearly the same
//! for every one of them. So the replicas and the material itself are solved on the same few steps and nodes, and the loss with a
//! replica is that of the case times the ratio of the two.

use crate::engine::EngineKind;
use crate::sweep::case::Resolution;
use crate::sweep::case::levels::Levels;
use crate::sweep::case::stabilise::{CaseError, Contact, Wanted};
use crate::sweep::plan::{CyclePlan, Method};

impl Levels<'_> {
    /// The losses (J) with the replicas of the material of a case that lost this much, and what a reader should know of them.
    pub(super) fn replica_losses_j(
        &mut self,
        loss_j: f64,
    ) -> Result<(Vec<Option<f64>>, Option<String>), CaseError> {
        let replicas = &self.contact.solid.replicas;
        if replicas.is_empty() {
            return Ok((Vec::new(), None));
        }
        let contact = Contact {
            cycle: CyclePlan {
                method: match self.contact.cycle.at_cycle {
                    Some(_) => Method::March,
                    None => Method::Direct,
                },
                ..self.contact.cycle
            },
            // Checkpoints are of the case itself.
            checkpoints: None,
            wanted: Wanted::Loss,
            ..self.contact
        };
        let at = self.coarse_for_replicas();
        let mut coarse_j = |compliance| -> Result<Option<f64>, CaseError> {
            let contact = Contact {
                compliance,
                ..contact
            };
            let solved = self.coarser(&contact, at.nodes, &[], at.steps)?;
            Ok(solved.and_then(|level| level.loss_j()))
        };
        let own_j = coarse_j(contact.compliance)?.filter(|own_j| *own_j > 0.0);
        let mut losses_j = Vec::with_capacity(replicas.len());
        for replica in replicas {
            let with_replica = match (own_j, replica) {
                (Some(_), Some(compliance)) => coarse_j(compliance)?,
                _ => None,
            };
            let ratio = with_replica.zip(own_j).map(|(other, own)| other / own);
            losses_j.push(ratio.map(|ratio| ratio * loss_j));
        }
        let missing = losses_j.iter().filter(|loss| loss.is_none()).count();
        let note = (missing > 0).then(|| {
            format!(
                "the error of the material leaves out {missing} of its {} replicas: no stabilised cycle was found with them",
                replicas.len()
            )
        });
        Ok((losses_j, note))
    }

    /// Steps and nodes on which the replicas are solved. A map has its own cells and no others.
    fn coarse_for_replicas(&self) -> Resolution {
        let plan = self.setup.plan();
        let solver = &plan.solver;
        let nodes = match (solver.engine, plan.base.contact.indenter.own_cells()) {
            (EngineKind::Axisymmetric, _) => 48,
            (EngineKind::HalfSpace, None) => 32,
            (EngineKind::HalfSpace, Some(_)) => usize::MAX,
        };
        Resolution {
            steps: plan.cycle.steps.min(48),
            nodes: solver.nodes().min(nodes),
        }
    }
}
