//! The library as a program uses it: sweeps from values and in memory, and the programs in `examples/`.

#[path = "../../examples/one_frequency.rs"]
mod one_frequency;
#[path = "../../examples/one_history.rs"]
mod one_history;
#[path = "../../examples/sweep_with_peaks.rs"]
mod sweep_with_peaks;

use crate::common::pmma_material as pmma;
use crate::prelude::*;
use std::num::NonZeroUsize;

use contact_dma::prelude::*;
use contact_dma::simulation::HistoryRow;
use contact_dma::sweep::record::Status;
use contact_dma::sweep::search::run::{self, Mode};
use contact_dma::sweep::store::Store;
use contact_dma::sweep::store::records::Records;

fn sweep() -> Sweep {
    let drive = HarmonicDrive::load(10.0, 5.0).unwrap();
    let sweep = Sweep::new(pmma(), Sphere::new(0.01).unwrap(), drive);
    sweep.steps(32).unwrap().springs(32).unwrap()
}

#[test]
fn a_sweep_from_values_in_memory_is_that_of_a_file_in_a_folder_to_the_last_bit() {
    let folder = tempfile::TempDir::new().unwrap();
    let plan = plans::sweep(include_str!("../inputs/refined.toml"));
    let store = Store::open(folder.path(), &resolved_text(&plan), false).unwrap();
    let setup = Setup::new(plan).unwrap();
    let never = AtomicBool::new(false);
    let of_file = run::run(&setup, &store, Mode::on_threads(2), &never, &()).unwrap();
    assert!(of_file.records.len() > 8, "nothing was refined");
    assert!(!of_file.peaks.is_empty());

    let built = sweep().refined().title("PMMA under a sphere");
    let built = built.angular_frequencies_rad_per_s([0.1, 1e-3, 2e-2, 5e-3]);
    let built = built.unwrap().amplitudes([2.0, 8.0]).unwrap();
    let text = resolved_text(&built.clone().into_plan());
    assert_eq!(text, resolved_text(setup.plan()));
    let of_values = built.threads(NonZeroUsize::MIN).solve().unwrap();
    assert_eq!(of_values, of_file);
}

#[test]
fn an_archive_in_memory_keeps_what_was_solved() {
    let plan = sweep().frequencies_hz([1e-3, 1e-2]).unwrap().into_plan();
    let (setup, archive) = (Setup::new(plan).unwrap(), Records::default());
    let stopped = AtomicBool::new(true);
    let nothing = run::run(&setup, &archive, Mode::on_threads(1), &stopped, &()).unwrap();
    assert!(nothing.interrupted && nothing.records.is_empty());
    let never = AtomicBool::new(false);
    let outcome = run::run(&setup, &archive, Mode::on_threads(2), &never, &()).unwrap();
    assert_eq!(outcome.records.len(), 2);
    let again = run::run(&setup, &archive, Mode::Read, &never, &()).unwrap();
    assert_eq!(again, outcome);
}

#[test]
fn values_that_cannot_be_are_refused_where_they_are_given() {
    for hz in [&[][..], &[-1.0], &[0.0], &[f64::NAN], &[1.0, 1.0]] {
        assert!(sweep().frequencies_hz(hz.to_vec()).is_err(), "{hz:?}");
    }
    assert!(sweep().steps(0).is_err());
    assert!(sweep().springs(0).is_err());
    assert!(sweep().cells(100_000).is_err());
    assert!(sweep().accuracy(0.0).is_err());
    // Amplitudes are above zero and ascend; an axis is not empty.
    for amplitudes in [vec![-1.0], vec![4.0, 2.0], vec![]] {
        assert!(sweep().amplitudes(amplitudes).is_err());
    }
    assert!(sweep().case_at_hz(-1.0).is_err());
    let refused = sweep().solve().unwrap_err().to_string();
    says(&refused, &["no frequency"]);
    // Plans have public fields, and are checked too.
    let mut plan = sweep().frequencies_hz([1.0]).unwrap().into_plan();
    plan.cycle.steps = 0;
    let refused = Setup::new(plan.clone()).err().unwrap().to_string();
    says(&refused, &["cycle.steps = 0"]);
    plan.cycle.steps = 8;
    let record = run_case(&plan, -1.0);
    assert_eq!(record.status, Status::Failed);
    assert!(record.message.unwrap().contains("-1 rad/s"));
}

#[test]
fn a_history_with_values_that_cannot_be_is_refused() {
    let ramp = Segment::Ramp {
        to: 1.0,
        duration_s: 1.0,
    };
    let drive = SegmentedDrive::new(Control::Load, vec![ramp]).unwrap();
    let plan = ScenarioPlan::new(pmma(), Arc::new(Sphere::new(0.01).unwrap()), drive);
    for step_s in [0.0, -1.0, f64::NAN] {
        let wrong = with(plan.clone(), |plan| plan.step_s = Some(step_s));
        assert!(Simulation::new(wrong).is_err(), "{step_s}");
    }
    let coarse = with(plan.clone(), |plan| plan.solver.springs = 1);
    assert!(Simulation::new(coarse).is_err());
    assert!(Simulation::new(plan).is_ok());
}

#[test]
fn the_example_of_one_frequency_gives_the_loss_of_the_paper_with_a_small_error() {
    let (loss_j, error_j) = one_frequency::loss(1.3e-3).unwrap();
    // The peak of the paper's figure 11 lies near: 3.5e-6 J at 8.4e-3 rad/s.
    assert!((3.4e-6..3.6e-6).contains(&loss_j), "{loss_j}");
    assert!(error_j < 1e-3 * loss_j, "{error_j}");
    one_frequency::main().unwrap();
}

#[test]
fn the_example_of_a_sweep_finds_the_peak_and_writes_a_row_per_frequency() {
    let outcome = sweep_with_peaks::outcome().unwrap();
    let [peak] = outcome.peaks[..] else {
        panic!("{:?}", outcome.peaks)
    };
    assert!((0.1..1.0).contains(&peak.angular_frequency_rad_per_s));
    let mut table = Vec::new();
    sweep_with_peaks::write_csv(&outcome, &mut table).unwrap();
    let table = String::from_utf8(table).unwrap();
    assert_eq!(table.lines().count(), 1 + 17);
    sweep_with_peaks::main().unwrap();
    let mut cells = table.lines().flat_map(|row| row.split(','));
    assert!(cells.all(|cell| !cell.is_empty()));
}

#[test]
fn the_example_of_a_history_creeps_under_load_and_recovers_without() {
    let rows = one_history::outcome().unwrap().rows;
    let is_at = |row: &&HistoryRow, time_s: f64| (row.time_s - time_s).abs() < 1e-9;
    let at = |time_s| rows.iter().find(|row| is_at(row, time_s)).unwrap();
    assert!(at(101.0).approach_m > at(1.0).approach_m);
    assert_eq!(at(202.0).contact_radius_m, 0.0);
    assert_eq!(at(202.0).approach_m, None);
    one_history::main().unwrap();
}
