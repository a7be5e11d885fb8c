//! What the tests of identification share: measurements made of computed cycles and histories, and solids that were found against
//! those that were sought.

use crate::prelude::*;
use contact_dma::identify::data::{Datum, Measurements, Number, Reading};
use contact_dma::identify::{Identified, IdentifyError, IdentifyPlan, identify};
use contact_dma::simulation::between::values_at;

/// How well something is measured: relative noise, and whether the data say so.
#[derive(Clone, Copy)]
pub struct Noise {
    pub relative: f64,
    pub with_errors: bool,
}

pub const EXACT: Noise = Noise {
    relative: 0.0,
    with_errors: false,
};

impl Noise {
    pub fn of(relative: f64, with_errors: bool) -> Self {
        Self {
            relative,
            with_errors,
        }
    }

    fn on(self, exact: f64, random: &mut Random) -> (f64, Option<f64>) {
        let value = exact * (1.0 + self.relative * random.normal());
        (value, self.with_errors.then_some(self.relative * exact))
    }
}

/// These numbers of computed cycles.
pub fn of_cycles(
    sweep: SweepPlan,
    omegas: &[f64],
    numbers: &[Number],
    noise: Noise,
    random: &mut Random,
) -> Measurements {
    let drive = sweep.base.drive;
    let sweep = Sweep::from(sweep).angular_frequencies_rad_per_s(omegas.to_vec());
    let records = sweep.unwrap().solve().unwrap().records;
    let mut data = Vec::new();
    for (row, record) in (1..).zip(&records) {
        for &number in numbers {
            let exact = number.of(record.result.as_ref().unwrap()).unwrap();
            let (value, error) = noise.on(exact, random);
            data.push(Datum {
                place: record.angular_frequency_rad_per_s,
                drive: Some(drive),
                row,
                number,
                value,
                error,
            });
        }
    }
    Measurements::new(data).unwrap()
}

/// Approaches of a computed history under a load, or loads under an approach.
pub fn of_history(
    mut scenario: ScenarioPlan,
    times_s: &[f64],
    noise: Noise,
    random: &mut Random,
) -> Measurements {
    scenario.output.error_bars = false;
    let drive = scenario.drive.clone();
    let value: fn(&HistoryRow) -> Option<f64> = match drive.control() {
        Control::Load => |row| row.approach_m,
        Control::Approach => |row| Some(row.load_n),
    };
    let exact = values_at(&drive, &simulated(scenario).rows, times_s, value);
    let rows = times_s.iter().zip(exact).enumerate();
    let reading = |(row, (time_s, exact)): (usize, (&f64, Option<f64>))| {
        let (value, error) = noise.on(exact.unwrap(), random);
        Reading {
            row: row + 1,
            time_s: *time_s,
            value,
            error,
        }
    };
    let readings: Vec<Reading> = rows.map(reading).collect();
    Measurements::of_history(&drive, &readings).unwrap()
}

pub fn found(plan: &IdentifyPlan) -> Result<Identified, IdentifyError> {
    identify(plan, &AtomicBool::new(false))
}

/// The largest relative error of E* at these angular frequencies.
pub fn off_by(truth: &Relaxation, found: &Identified, omegas: &[f64]) -> f64 {
    let off = omegas.iter().map(|omega| {
        let exact = truth.complex_modulus(*omega);
        (found.relaxation.complex_modulus(*omega) - exact).norm() / exact.norm()
    });
    largest(off)
}

/// Points of E' and E'' inside their bands, and of how many.
pub fn inside(truth: &Relaxation, found: &Identified, omegas: &[f64]) -> (usize, usize) {
    let mut inside = 0;
    for omega in omegas {
        let (exact, band) = (truth.complex_modulus(*omega), found.band(*omega));
        let within = |own: f64, exact: f64, factor: f64| (own / exact).ln().abs() <= factor.ln();
        inside += usize::from(within(band.storage_pa, exact.re, band.storage_factor));
        inside += usize::from(within(band.loss_pa, exact.im, band.loss_factor));
    }
    (inside, 2 * omegas.len())
}

/// A series with branches at these powers of ten (s), each of a power of ten within `parts` of the equilibrium modulus.
pub fn series_at(random: &mut Random, times: Vec<f64>, parts: (f64, f64)) -> Relaxation {
    let equilibrium_pa = random.power_of_ten(5.0, 9.0);
    let branches = times.into_iter().map(|time| {
        let modulus_pa = equilibrium_pa * random.power_of_ten(parts.0, parts.1);
        (modulus_pa, 10_f64.powf(time))
    });
    series(equilibrium_pa, &branches.collect::<Vec<_>>())
}
