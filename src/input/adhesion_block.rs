//! The `[adhesion]` block: an indenter that the surface attracts.

use super::diagnostic::{Location, Problems};
use super::document::block;
use super::document::reader::TableReader;
use super::keys;
use crate::drive::{Control, DriveError, HarmonicDrive};
use crate::indenter::Indenter;
use crate::sweep::plan::adhesion::{AdhesionModel, AdhesionPlan};

/// What attracts an indenter: the block, and where it stands.
pub(super) struct Attraction<'a> {
    pub(super) adhesion: AdhesionPlan,
    place: Location,
    problems: &'a Problems,
}

/// Reads the block, where there is one; `None` where a problem was reported.
pub(super) fn read<'a>(root: &mut TableReader<'a>) -> Option<Option<Attraction<'a>>> {
    let (place, problems) = (root.key_location(&keys::ADHESION), root.problems());
    root.table_or(&keys::ADHESION, None, |table| {
        let adhesion = block::read(table, None)?;
        Some(Some(Attraction {
            adhesion,
            place: place?,
            problems,
        }))
    })
}

impl Attraction<'_> {
    /// The pull-off load (N) of an indenter under such a control; `None` where a problem was reported.
    pub(super) fn pull_off_n(&self, indenter: &dyn Indenter, control: Control) -> Option<f64> {
        let (place, problems) = (&self.place, self.problems);
        let model = self.adhesion.model;
        if control == Control::Approach && model == AdhesionModel::Dmt {
            problems
                .at(place, "the model \"dmt\" goes with a prescribed load only")
                .because("its attraction does not depend on the approach")
                .help("write `control = \"load\"` in [drive], or leave out `model`");
            return None;
        }
        let pull_off_n = self.adhesion.pull_off_n(indenter);
        if pull_off_n.is_none() {
            let (of, help) = match model {
                AdhesionModel::Maugis => ("a body of revolution", "leave out [adhesion]"),
                AdhesionModel::Dmt | AdhesionModel::Jkr => ("a sphere", "leave out `model`"),
            };
            problems
                .at(
                    place,
                    format!("the model \"{}\" is of {of} only", model.name()),
                )
                .because(format!("and the indenter is a {}", indenter.shape()))
                .help(help);
        }
        pull_off_n
    }

    /// The drive of an indenter that is attracted; `None` where a problem was reported.
    pub(super) fn drive(
        &self,
        indenter: &dyn Indenter,
        drive: &HarmonicDrive,
    ) -> Option<HarmonicDrive> {
        let pull_off_n = self.pull_off_n(indenter, drive.control())?;
        let refused = |error: DriveError| {
            let help = "raise the mean or lower the amplitude of [drive]; the sphere comes off at -2 pi work radius";
            self.problems.at(&self.place, error.to_string()).help(help);
        };
        drive.attracted_by(pull_off_n).map_err(refused).ok()
    }
}
