//! Plans of input files as the tests read them.

use std::sync::atomic::AtomicBool;

use contact_dma::input::diagnostic::Styling;
use contact_dma::input::document::Document;
use contact_dma::input::{scenario_file, sweep_file};
use contact_dma::simulation::Simulation;
use contact_dma::sweep::case::Setup;
use contact_dma::sweep::plan::SweepPlan;
use contact_dma::sweep::plan::resolved::resolved_text;
use contact_dma::sweep::record::{CaseRecord, CaseResult};

/// A sweep file with flags, or why it is refused.
pub fn try_sweep(text: &str, flags: &[&str]) -> Result<SweepPlan, String> {
    let mut document = Document::parse("sweep.toml", text).unwrap();
    for flag in flags {
        document.set(flag).unwrap();
    }
    of(&document)
}

pub fn of(document: &Document) -> Result<SweepPlan, String> {
    sweep_file::plan(document).map_err(|why| why.render(Styling::Plain))
}

#[track_caller]
pub fn sweep(text: &str) -> SweepPlan {
    try_sweep(text, &[]).unwrap_or_else(|why| panic!("{text}\n{why}"))
}

/// The plan of a resolved text, which must be that of the plan.
#[track_caller]
pub fn again(plan: &SweepPlan) -> SweepPlan {
    let text = resolved_text(plan);
    let again = sweep(&text);
    assert_eq!(resolved_text(&again), text);
    again
}

/// All cases of a sweep.
pub fn records(plan: SweepPlan) -> Vec<CaseRecord> {
    let setup = Setup::new(plan).unwrap();
    let cases = setup.plan().cases().into_iter();
    let record = |case| setup.run(&case, &AtomicBool::new(false)).unwrap();
    cases.map(record).collect()
}

/// Their results, with error bars.
pub fn results(plan: SweepPlan) -> Vec<CaseResult> {
    let results = records(plan).into_iter();
    let results = results.map(|record| record.result.unwrap());
    results
        .inspect(|result| assert!(result.errors.is_some()))
        .collect()
}

/// The history of a file.
#[track_caller]
pub fn history(text: &str) -> Simulation {
    let document = Document::parse("scenario.toml", text).unwrap();
    let plan = scenario_file::plan(&document).unwrap_or_else(|why| panic!("{text}\n{why}"));
    Simulation::new(plan).unwrap()
}
