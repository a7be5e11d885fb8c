//! The `[adhesion]` block: a sphere that the surface attracts, under a prescribed load.

use super::diagnostic::{Location, Problems};
use super::document::reader::TableReader;
use super::keys::adhesion::{EQUILIBRIUM_DISTANCE, WORK};
use crate::drive::{Control, DriveError, HarmonicDrive};
use crate::indenter::Indenter;
use crate::sweep::plan::adhesion::AdhesionPlan;

/// Reads the block; `None` where a problem was reported.
pub(super) fn read(mut table: TableReader<'_>) -> Option<AdhesionPlan> {
    let (work, distance) = (table.value(&WORK), table.value(&EQUILIBRIUM_DISTANCE));
    table.finish();
    Some(AdhesionPlan {
        work_j_per_m2: work?,
        equilibrium_distance_m: distance?,
    })
}

/// The drive of an indenter that is attracted; `None` where a problem was reported.
pub(super) fn drive(
    adhesion: &AdhesionPlan,
    indenter: &dyn Indenter,
    drive: &HarmonicDrive,
    (place, problems): (&Location, &Problems),
) -> Option<HarmonicDrive> {
    if drive.control() == Control::Approach {
        problems
            .at(place, "adhesion goes with a prescribed load only")
            .because("the attraction of surfaces apart is not known")
            .help("write `control = \"load\"` in [drive], or leave out [adhesion]");
        return None;
    }
    let Some(pull_off_n) = adhesion.pull_off_n(indenter) else {
        problems
            .at(place, "adhesion is known of a sphere only")
            .because(format!("and the indenter is a {}", indenter.shape()))
            .help("write `shape = \"sphere\"` in [indenter], or leave out [adhesion]");
        return None;
    };
    let refused = |error: DriveError| {
        let help = "raise the mean or lower the amplitude of [drive]; the sphere comes off at -2 pi work radius";
        problems.at(place, error.to_string()).help(help);
    };
    drive.attracted_by(pull_off_n).map_err(refused).ok()
}
