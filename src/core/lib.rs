//! What `contact-dma` computes with: materials, contact, histories, cycles, sweeps and the records they leave. It reads no sweep
//! file and draws nothing; `contact-dma` does, has every module of this crate under the same name, and is the one to depend on.

#![forbid(unsafe_code)]

pub mod adhesive;
pub mod contact;
pub mod cycle;
pub mod drive;
pub mod engine;
pub mod force_curve;
pub mod history;
pub mod identify;
pub mod indenter;
pub mod material;
pub mod measured;
pub mod numerics;
pub mod quantity;
pub mod reference;
pub mod simulation;
pub mod steady;
pub mod sweep;

/// The most frequently used types: `use contact_dma::prelude::*`.
pub mod prelude {
    pub use crate::drive::{Control, HarmonicDrive, Segment, SegmentedDrive};
    pub use crate::indenter::*;
    pub use crate::material::{Creep, CreepBranch, Material, ModulusKind};
    pub use crate::material::{Relaxation, RelaxationBranch, library};
    pub use crate::simulation::Simulation;
    pub use crate::simulation::scenario::ScenarioPlan;
    pub use crate::sweep::record::CaseRecord;
    pub use crate::sweep::search::peak::Peak;
    pub use crate::sweep::search::run::Outcome;
    pub use crate::sweep::{Sweep, SweepError};
}
