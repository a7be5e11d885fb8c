//! What presses on what: what the plans of a sweep, of a history and of an identification have in common.

use std::sync::Arc;

use crate::engine::{EngineError, EngineKind, body_of_revolution};
use crate::indenter::Indenter;
use crate::quantity::block::Block as _;
use crate::quantity::setting::Table;
use crate::sweep::plan::adhesion::{AdhesionModel, AdhesionPlan};
use crate::sweep::plan::check::PlanError;
use crate::sweep::plan::layer::LayerPlan;
use crate::sweep::plan::resolved;

/// A contact of bodies of which so much is known as `M` says: a [`crate::material::Material`] of a sweep, a
/// [`crate::simulation::body_material::BodyMaterial`] of a history, [`crate::identify::Sought`] of an identification.
#[derive(Debug, Clone)]
pub struct ContactPlan<M> {
    pub material: M,
    /// The layer that the body is, where it is no half-space.
    pub layer: Option<LayerPlan>,
    pub indenter: Arc<dyn Indenter>,
    /// Attraction outside the contact, where there is any; the drive then knows the pull-off load.
    pub adhesion: Option<AdhesionPlan>,
}

impl<M> ContactPlan<M> {
    /// The contact with a half-space, without attraction.
    pub fn new(material: M, indenter: Arc<dyn Indenter>) -> Self {
        Self {
            material,
            layer: None,
            indenter,
            adhesion: None,
        }
    }

    /// Whether an attraction moves the edge of the contact.
    pub fn is_attracted(&self) -> bool {
        self.adhesion
            .is_some_and(|adhesion| adhesion.model != AdhesionModel::Dmt)
    }

    /// The same contact of another material.
    pub fn with_material<N>(&self, material: N) -> ContactPlan<N> {
        ContactPlan {
            material,
            layer: self.layer,
            indenter: Arc::clone(&self.indenter),
            adhesion: self.adhesion,
        }
    }

    /// Checks every value that is not checked where it is made.
    pub(crate) fn check(&self) -> Result<(), PlanError> {
        if let Some(layer) = self.layer {
            layer.check()?;
        }
        if let Some(adhesion) = self.adhesion {
            adhesion.check()?;
        }
        Ok(())
    }

    /// Checks that an attraction moves the edge of a contact which an engine can follow.
    pub(crate) fn check_attraction(&self, engine: EngineKind) -> Result<(), EngineError> {
        if !self.is_attracted() {
            return Ok(());
        }
        if engine == EngineKind::HalfSpace {
            return Err(EngineError::AttractedCells);
        }
        match body_of_revolution(self.indenter.as_ref())?.contact_limit_m() {
            Some(_) => Err(EngineError::AttractedRim {
                shape: self.indenter.shape(),
            }),
            None => Ok(()),
        }
    }

    /// The blocks of a resolved file, but for the material's, where this is the one of what the indenter is made of.
    pub(crate) fn blocks(&self, indenter_material: Option<String>) -> ContactBlocks {
        // By name, so that what is added to a contact and not written here, and so not hashed, does not compile.
        let Self {
            material: _,
            layer,
            indenter,
            adhesion,
        } = self;
        let block = Table::new("indenter").and(resolved::shape(indenter.as_ref()));
        let below = indenter_material.map(|block| format!("\n{block}"));
        ContactBlocks {
            layer: layer.map_or(String::new(), |layer| layer.table().toml()),
            indenter: block.toml() + &below.unwrap_or_default(),
            adhesion: adhesion.map_or(String::new(), |adhesion| adhesion.table().toml()),
        }
    }
}

/// Blocks of a resolved file; empty where a contact has none.
pub(crate) struct ContactBlocks {
    pub(crate) layer: String,
    pub(crate) indenter: String,
    pub(crate) adhesion: String,
}
