//! What makes a contact besides material, shape and drive, in files without axes: what the indenter is made of, a layer, adhesion.

use super::adhesion_block::{self, Attraction};
use super::document::block;
use super::document::reader::TableReader;
use super::{indenter_block, keys, solver_block};
use crate::drive::Control;
use crate::indenter::Indenter;
use crate::material::Material;
use crate::sweep::plan::adhesion::AdhesionPlan;
use crate::sweep::plan::layer::LayerPlan;

/// The blocks as read.
pub(super) struct Bodies<'a> {
    /// Of the indenter, where it is not rigid.
    pub(super) indenter_material: Option<Material>,
    pub(super) layer: Option<LayerPlan>,
    /// What attracts the indenter, where anything does.
    pub(super) attraction: Option<Attraction<'a>>,
}

/// Reads the blocks; `None` where a problem was reported.
pub(super) fn read<'a>(root: &mut TableReader<'a>) -> Option<Bodies<'a>> {
    let indenter_material = indenter_block::material(root);
    let layer = root.table_or(&keys::LAYER, None, |t| block::read(t, None).map(Some));
    let has_indenter_material = indenter_material.as_ref().is_some_and(Option::is_some);
    solver_block::refuse_second_body(root, has_indenter_material);
    let attraction = adhesion_block::read(root);
    Some(Bodies {
        indenter_material: indenter_material?.map(|body| body.value),
        layer: layer?,
        attraction: attraction?,
    })
}

impl Bodies<'_> {
    pub(super) fn adhesion(&self) -> Option<AdhesionPlan> {
        self.attraction
            .as_ref()
            .map(|attraction| attraction.adhesion)
    }

    /// Its pull-off load (N) of an indenter under such a control, 0 without one; `None` where a problem was reported.
    pub(super) fn pull_off_n(
        &self,
        indenter: Option<&dyn Indenter>,
        control: Control,
    ) -> Option<f64> {
        match &self.attraction {
            Some(attraction) => attraction.pull_off_n(indenter?, control),
            None => Some(0.0),
        }
    }
}
