//! What is no result is not returned as one, and what is doubtful says so: numbers that are not finite, a loss below zero, the wrong
//! one of several peaks.

use crate::prelude::*;

#[test]
fn numbers_beyond_those_of_the_machine_are_a_failed_case_whose_record_can_be_read_again() {
    for (load_n, omega) in [(1e200, 1.0), (10.0, 1e-308)] {
        let mut plan = sweep_plan(pmma_material(), sphere(0.01), load_n, 0.5 * load_n);
        plan.cycle.error_bars = true;
        let record = run_case(&plan, omega);
        assert_eq!(record.status, Status::Failed, "{load_n:e} {omega:e}");
        assert!(record.result.is_none());
        let message = record.message.as_deref().unwrap();
        assert!(message.contains("not made of finite numbers"), "{message}");
        let stored = postcard::to_stdvec(&record).unwrap();
        assert_eq!(postcard::from_bytes::<CaseRecord>(&stored).unwrap(), record);
    }
    // Far away and yet within the range.
    let plan = sweep_plan(pmma_material(), sphere(0.01), 1e100, 5e99);
    assert_eq!(run_case(&plan, 1e-100).status, Status::Converged);
}

#[test]
fn a_loss_below_zero_is_told() {
    let plan = sweep_plan(pmma_material(), sphere(0.01), 10.0, 5.0);
    let codes =
        |record: &CaseRecord| -> Vec<&str> { record.warnings.iter().map(|w| w.code()).collect() };
    // So slow that next to nothing is lost, less than what few cells leave.
    let negative = (0..12).find_map(|k| {
        let record = run_case(&on_cells(plan.clone(), 12 + k, 33), 1e-9);
        record.energy_loss_j().filter(|loss| *loss < 0.0)?;
        Some(record)
    });
    let record = negative.expect("one of the coarse grids has a loss below zero");
    assert!(codes(&record).contains(&"negative-loss"), "{record:?}");
    let right = run_case(&plan, 1e-9);
    assert!(right.energy_loss_j().unwrap() > 0.0);
    assert!(!codes(&right).contains(&"negative-loss"));
}

#[test]
fn of_the_peaks_in_a_bracket_of_ten_decades_the_highest_is_found() {
    let drive = HarmonicDrive::load(10.0, 5.0).unwrap();
    let sweep = |omegas: Vec<f64>| {
        let sphere = ball(0.01);
        let sweep = Sweep::new(pmma_material(), sphere, drive);
        let sweep = sweep.springs(100).unwrap().steps(64).unwrap();
        let sweep = sweep.angular_frequencies_rad_per_s(omegas).unwrap();
        sweep.solve().unwrap().peaks
    };
    let wide = sweep(vec![1e-6, 1.0, 1e4]);
    let narrow = sweep(vec![4e-3, 8e-3, 16e-3]);
    let off = wide[0].angular_frequency_rad_per_s - narrow[0].angular_frequency_rad_per_s;
    let bars = wide[0].angular_frequency_uncertainty_rad_per_s
        + narrow[0].angular_frequency_uncertainty_rad_per_s;
    assert!(off.abs() <= bars, "{wide:?}\n{narrow:?}");
    assert!((wide[0].energy_loss_j / 3.509e-6 - 1.0).abs() < 2e-3);
}
