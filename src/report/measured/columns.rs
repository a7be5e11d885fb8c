//! The columns of `sweep.csv` of measured loops: all those of a sweep, empty where a measurement says nothing, and some of its own.
//! An error is half the width of the interval of 95 %.

use super::MeasuredRow;
use crate::measured::drift::DriftModel;
use crate::measured::{Finding, Quantity};
use crate::quantity::Dimension;
use crate::report::quantities::{self, Column, Named, SWEEP};
use crate::report::table::Cell;

type Of = Column<MeasuredRow>;

/// Value and error of a mean.
macro_rules! mean {
    ($quantity:ident, $meaning:literal) => {
        Of::new(
            Quantity::$quantity.column(),
            |r| r.mean(Quantity::$quantity).map(|mean| mean.value).into(),
            $meaning,
        )
        .with_error(|r| r.mean(Quantity::$quantity)?.error)
    };
}

use Dimension::{Angle, Energy, Force, Frequency, Length, Stress};

/// Those that a measurement fills.
#[rustfmt::skip]
pub static MEASURED: &[Of] = &[
    Of::new("angular_frequency_rad_per_s", |r| r.angular_rad_per_s().into(), "angular frequency ω")
        .called("angular frequency", Some(Dimension::AngularFrequency)),
    Of::new("frequency_hz", |r| r.measured.as_ref().map(|m| m.frequency.hz).into(),
        "frequency, found by least squares or as given")
        .called("frequency", Some(Frequency)),
    Of::new("drive_mean", |r| r.mean(Quantity::LoadMean).map(|m| m.value).into(), "mean load (N)"),
    Of::new("drive_amplitude", |r| r.mean(Quantity::LoadAmplitude).map(|m| m.value).into(),
        "amplitude of the first harmonic of the load (N)"),
    mean!(EnergyLoss, "energy loss per cycle, from the harmonics of both signals").called("energy loss per cycle", Some(Energy)),
    mean!(PhaseLag, "lag of the approach behind the load, first harmonics").called("phase lag of the approach", Some(Angle)),
    mean!(StorageModulus,
        "(1 − ν²) W₁ cos(phase lag)/(2 a₀ δ₁), as a sweep has it; the bias of this formula is in it")
        .called("storage modulus from the loop", Some(Stress)),
    mean!(LossModulus, "the same with the sine").called("loss modulus from the loop", Some(Stress)),
    mean!(ApproachMin, "smallest approach of the mean cycle, drift taken off").called("smallest approach", Some(Length)),
    mean!(ApproachMax, "the largest").called("largest approach", Some(Length)),
    mean!(Harmonic2, "second harmonic of the approach over the first"),
    mean!(Harmonic3, "third harmonic of the approach over the first"),
    mean!(Harmonic4, "the fourth"),
    mean!(Harmonic5, "the fifth"),
    Of::new("index", |r| r.index.into(), "the number in the names of its loop and its cycles"),
    Of::new("method", |_| "measured".into(), "measured"),
    Of::new("cycles", |r| r.measured.as_ref().map(|m| m.used.len()).into(), "cycles that count in the means"),
    Of::new("warnings", |r| codes(r).into(), "what was found, as codes with blanks between them"),
    Of::new("status", |r| r.status().name().into(),
        "converged; not-converged where the loop changes to the end, and there is no mean; failed where there is no loop"),
    Of::new("message", |r| r.reason.clone().into(), "why there is no loop"),
];

/// Those that a sweep does not have.
#[rustfmt::skip]
pub static OWN: &[Of] = &[
    Of::new("file", |r| r.file.as_str().into(), "the file"),
    Of::new("frequency_error_hz", |r| {
        let error = r.measured.as_ref().and_then(|m| m.frequency.standard_error_hz);
        error.map(|error| 1.96 * error).into()
    }, "half the width of the interval of 95 %; empty where the frequency was given").called("error of the frequency", Some(Frequency)),
    Of::new("energy_loss_standard_error_j", |r| standard(r, Quantity::EnergyLoss), "standard error of the mean loss: one standard deviation")
        .called("standard error of the loss", Some(Energy)),
    Of::new("phase_lag_standard_error_rad", |r| standard(r, Quantity::PhaseLag), "standard error of the mean phase lag")
        .called("standard error of the phase lag", Some(Angle)),
    mean!(LoadMean, "mean load").called("mean load", Some(Force)),
    mean!(LoadAmplitude, "amplitude of its first harmonic").called("amplitude of the load", Some(Force)),
    Of::new("load_amplitude_standard_error_n", |r| standard(r, Quantity::LoadAmplitude), "its standard error")
        .called("standard error of the amplitude of the load", Some(Force)),
    mean!(ApproachMean, "mean approach, drift taken off").called("mean approach", Some(Length)),
    mean!(ApproachAmplitude, "amplitude of its first harmonic").called("amplitude of the approach", Some(Length)),
    Of::new("approach_amplitude_standard_error_m", |r| standard(r, Quantity::ApproachAmplitude), "its standard error")
        .called("standard error of the amplitude of the approach", Some(Length)),
    mean!(ContactRadius, "contact radius a₀ of the moduli").called("contact radius", Some(Length)),
    Of::new("corrected_storage_modulus_pa", |r| r.unbiased().map(|u| u.storage_modulus_pa.value).into(),
        "storage modulus without the bias of the formula, which the exact model gives; empty without an indenter in the setup")
        .called("storage modulus without bias", Some(Stress)).with_error(|r| r.unbiased()?.storage_modulus_pa.error),
    Of::new("corrected_loss_modulus_pa", |r| r.unbiased().map(|u| u.loss_modulus_pa.value).into(), "the loss modulus likewise")
        .called("loss modulus without bias", Some(Stress)).with_error(|r| r.unbiased()?.loss_modulus_pa.error),
    Of::new("storage_modulus_bias", |r| r.unbiased().map(|u| u.storage_bias - 1.0).into(), "by which part the formula is too high, too low where negative"),
    Of::new("loss_modulus_bias", |r| r.unbiased().map(|u| u.loss_bias - 1.0).into(), "the same of the loss modulus"),
    mean!(HarmonicPhase2,
        "phase of the second harmonic of the approach from the instant at which the first harmonic of the load rises through its mean")
        .called("phase of the second harmonic", Some(Angle)),
    mean!(HarmonicPhase3, "of the third").called("phase of the third harmonic", Some(Angle)),
    mean!(HarmonicPhase4, "of the fourth").called("phase of the fourth harmonic", Some(Angle)),
    mean!(HarmonicPhase5, "of the fifth").called("phase of the fifth harmonic", Some(Angle)),
    Of::new("cycles_measured", |r| r.measured.as_ref().map(|m| m.cycles.len()).into(), "whole cycles of the record"),
    Of::new("first_stabilised_cycle", |r| r.measured.as_ref().and_then(|m| m.first_stabilised).into(),
        "the cycle from which on nothing changes, from 1; empty where something changes to the end"),
    Of::new("points_per_cycle", |r| r.measured.as_ref().map(|m| m.points_per_cycle).into(), "samples in a cycle"),
    Of::new("drift", |r| r.measured.as_ref().map(|m| drift(m.drifts[1].model)).into(), "what was told apart from the approach as drift"),
    Of::new("drift_change_m", |r| r.measured.as_ref().map(|m| m.drifts[1].change).into(), "its change over the record")
        .called("drift over the record", Some(Length)),
];

fn standard(row: &MeasuredRow, quantity: Quantity) -> Cell {
    row.mean(quantity)
        .and_then(|mean| mean.standard_error)
        .into()
}

fn codes(row: &MeasuredRow) -> String {
    let mut codes: Vec<&str> = row.findings().map(Finding::code).collect();
    codes.dedup();
    codes.join(" ")
}

/// A drift in words: `polynomial of degree 2`.
pub fn drift(model: DriftModel) -> String {
    match model {
        DriftModel::None => "none".to_owned(),
        DriftModel::Polynomial { degree: 1 } => "linear".to_owned(),
        DriftModel::Polynomial { degree } => format!("polynomial of degree {degree}"),
        DriftModel::Exponential { time_s } => format!("exponential, {time_s:.3e} s"),
        DriftModel::ExponentialAndLine { time_s } => {
            format!("linear and exponential, {time_s:.3e} s")
        }
    }
}

/// `sweep.csv`: the columns of a sweep with Hz first, then those of measurements.
pub fn sweep(rows: &[MeasuredRow]) -> Vec<u8> {
    quantities::named(&of_records(), rows)
}

/// The columns of that table.
pub fn of_records() -> Vec<Named<MeasuredRow>> {
    let of_sweep = SWEEP.iter().filter(|column| !column.name.contains("{}"));
    let mut named: Vec<Named<MeasuredRow>> = Vec::new();
    let absent = |name: String| Named {
        name,
        cell: Box::new(|_: &MeasuredRow| Cell::Absent),
    };
    for column in of_sweep {
        let own = MEASURED.iter().find(|own| own.name == column.name);
        match own {
            Some(own) => named.extend(own.named(0)),
            None => named.push(absent(column.name.to_owned())),
        }
        let error = own.and_then(Column::named_error);
        named.extend(error.or_else(|| column.error_name().map(absent)));
    }
    if let Some(hz) = named
        .iter()
        .position(|column| column.name == "frequency_hz")
    {
        named[..=hz].rotate_right(1);
    }
    for column in OWN {
        named.extend(column.named(0).into_iter().chain(column.named_error()));
    }
    named
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_of_a_sweep_is_there_once_under_its_name() {
        let table = String::from_utf8(sweep(&[])).unwrap();
        let names: Vec<&str> = table.trim_end().split(',').collect();
        let mut sorted = names.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!(sorted.len(), names.len());
        for column in SWEEP.iter().filter(|column| !column.name.contains("{}")) {
            assert!(names.contains(&column.name), "{}", column.name);
            if let Some(error) = column.error_name() {
                assert!(names.contains(&error.as_str()), "{error}");
            }
        }
        assert_eq!(names[0], "frequency_hz");
        for own in MEASURED {
            assert!(
                SWEEP.iter().any(|column| column.name == own.name),
                "{}",
                own.name
            );
        }
        // `material_...` and the like would be taken for a second axis.
        assert!(!OWN.iter().any(|own| own.name.starts_with("drive_")));
    }
}
