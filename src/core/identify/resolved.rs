//! The resolved identification: every default written out, as a file that gives the same plan again.

use crate::identify::{ApproachZero, Driven, IdentifyPlan, MOST_BRANCHES, SoughtAttraction};
use crate::keys;
use crate::quantity::block::Block as _;
use crate::quantity::key::Kind;
use crate::quantity::setting::{Table, Value, document};
use crate::sweep::plan::resolved::{compressibility, indenter_material_text};

keys! {
    /// A table with columns of `sweep.csv`, with error columns if known, or a folder that holds `sweep.csv`. For a history: `time_s` and
    /// `approach_m`, or `load_n` under a prescribed approach.
    DATA = "data", Kind::Text;
    /// Branches of the series: a number, or `auto` (the default): as many as the data require.
    IDENTIFY_BRANCHES = "branches", Kind::Either(&Kind::AUTO, &Kind::Integer(1..=MOST_BRANCHES), ""), optional;
    /// What smallest, largest and mean approaches of cycles are counted from; left out: unknown in a table of `analyse`, from first contact
    /// in any other. Where it is unknown they are not data, and the mean of a prescribed approach is that of `[drive]`.
    APPROACH_ZERO = "approach_zero", Kind::Word(ApproachZero::WORDS), optional;
    /// What of the attraction is sought beside the material, from the values in `[adhesion]` on.
    ATTRACTION = "attraction", Kind::Word(SoughtAttraction::WORDS), or SoughtAttraction::Known;
}

/// How many branches, in a resolved file.
pub(crate) fn branches_setting(branches: Option<usize>) -> Value {
    branches.map_or("auto".into(), Value::from)
}

/// The plan as the text of an identification file.
pub fn resolved_text(plan: &IdentifyPlan) -> String {
    let known = &plan.contact.material;
    let contact =
        (plan.contact).blocks(known.indenter_material.as_ref().map(indenter_material_text));
    let material = Table::new("material").and(compressibility(&known.compressibility));
    let drive = match &plan.drive {
        Driven::Cycles(drive) => drive.table(),
        Driven::History(drive) => drive.table(),
    };
    let identify = Table::new("identify")
        .and(DATA.setting(plan.data.clone()))
        .and(IDENTIFY_BRANCHES.setting(branches_setting(plan.branches)))
        .and(APPROACH_ZERO.setting(plan.approach_zero));
    let identify = match plan.attraction {
        SoughtAttraction::Known => identify,
        sought => identify.and(ATTRACTION.setting(sought)),
    };
    let solver = plan.solver.table_for(plan.contact.indenter.as_ref());
    let blocks = [
        material.toml(),
        contact.layer,
        contact.indenter,
        drive.toml(),
        contact.adhesion,
        identify.toml(),
        plan.cycle.table().toml(),
        solver.toml(),
    ];
    document(&plan.title, blocks)
}
