//! The resolved identification: every default written out, as a file that gives the same plan again.

use crate::identify::{ApproachZero, Driven, IdentifyPlan, MOST_BRANCHES, SoughtAttraction};
use crate::keys;
use crate::material::dynamic::MOST_REPLICAS;
use crate::material::law::{Form, Law};
use crate::quantity::block::Block as _;
use crate::quantity::key::{Entries, Kind};
use crate::quantity::setting::{Table, Value, document};
use crate::sweep::plan::resolved::{compressibility, indenter_material_text};

/// Laws by their names, and the word for all of them.
pub const LAWS: &[&str] = &[
    "auto",
    Law::PowerLaw.name(),
    Law::StandardSolid.name(),
    Law::FractionalZener.name(),
    Law::FractionalMaxwell.name(),
    Law::KelvinVoigt.name(),
    Law::Kww.name(),
    Law::Series.name(),
];

const LAW_ENTRIES: Entries = Entries {
    repeats: false,
    ..Entries::of(1..=LAWS.len(), "write one law, or a list of several")
};

keys! {
    /// A table with columns of `sweep.csv`, with error columns if known, or a folder that holds `sweep.csv`. For a history: `time_s` and
    /// `approach_m`, or `load_n` under a prescribed approach.
    DATA = "data", Kind::Text;
    /// Branches of the series: a number, or `auto` (the default): as many as the data require.
    IDENTIFY_BRANCHES = "branches", Kind::Either(&Kind::AUTO, &Kind::Integer(1..=MOST_BRANCHES), ""), optional;
    /// Laws between which the data choose: `auto` for all, a name, or a list of names. Left out: all of force curves, and series of cycles
    /// and histories.
    LAW = "law", Kind::Words(LAWS, LAW_ENTRIES), optional;
    /// How often the material is found again with the noise drawn anew. Of cycles, a history or a single curve these are replicas of the material, from which a sweep
    /// has a band about its loss.
    SAMPLES = "samples", Kind::Integer(0..=MOST_REPLICAS), or 0_usize;
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

/// The laws of these names, all where there are none, and a series of so many branches.
pub fn forms(laws: &[String], branches: Option<usize>, most: usize) -> Vec<Form> {
    let all = laws.is_empty() || laws.iter().any(|law| law == "auto");
    let (fewest, most) = match (branches, all) {
        (Some(asked), _) => (asked, asked.min(MOST_BRANCHES)),
        (None, true) => (2, most),
        (None, false) => (1, most),
    };
    let mut forms: Vec<Form> = (Form::all(1).into_iter())
        .filter(|form| all || laws.iter().any(|law| law == form.law.name()))
        .collect();
    if all || laws.iter().any(|law| law == Law::Series.name()) {
        forms.extend(Form::series(fewest, most));
    }
    forms
}

/// The names of laws, each once.
fn names(forms: &[Form]) -> Vec<String> {
    let mut names: Vec<String> = (forms.iter())
        .map(|form| form.law.name().to_owned())
        .collect();
    names.dedup();
    names
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
        .and(LAW.setting(plan.laws.as_deref().map(names)))
        .and(SAMPLES.setting(plan.samples))
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
